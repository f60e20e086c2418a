//! Runs the program as its users do: one test program for all, so that it is linked once.

mod bench;
mod cameras;
mod chromium;
mod command_line;
mod compare;
mod folder;
mod frames;
mod golden;
mod layers;
mod pictures;
mod refusals;
mod scene_file;
mod see;
mod study;
#[cfg(target_os = "linux")]
mod threads;
#[cfg(feature = "viewer")]
mod view;
#[cfg(unix)]
mod whole_files;
#[cfg(feature = "viewer")]
mod xvfb;
