//! The command line of `basrelief bench`.

use crate::options::choices::{self, Choice, one_of};
use crate::options::values;
use basrelief::Filter;
use clap::Args;
use std::path::PathBuf;

/// A scene that is made at start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Standard {
    Floor,
    Wall,
    Torus,
    Triangles,
}

pub(crate) const SCENES: &[Choice<Standard>] = &[
    ("floor", Standard::Floor, "Cobbles to the horizon: two triangles"),
    ("wall", Standard::Wall, "Blocks at a grazing angle: two triangles"),
    ("torus", Standard::Torus, "A curved body of cobbles: 65536 triangles"),
    ("triangles", Standard::Triangles, "Hills without relief: a million triangles"),
];

#[derive(Args)]
pub(crate) struct BenchOptions {
    /// Scenes to draw, with commas between them [default: all]
    #[arg(long, alias = "scene", value_name = "NAMES", value_delimiter = ',', value_parser = one_of(SCENES))]
    pub(crate) scenes: Vec<Standard>,
    /// Filters to draw with, with commas between them [default: all but the truth]
    #[arg(short, long, alias = "filter", value_name = "NAMES", value_delimiter = ',', value_parser = one_of(choices::FILTERS))]
    pub(crate) filters: Vec<Filter>,
    /// Width and height in pixels of the frames that are timed
    #[arg(short, long, value_name = "WxH", default_value = "1280x720", value_parser = values::size, allow_hyphen_values = true)]
    pub(crate) size: [u32; 2],
    /// Rounds, 2 to 1000: in each every filter draws a frame to warm up and one that is timed; the
    /// middle time counts, and how far apart the times are tells the noise
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(2..=1000))]
    pub(crate) repeat: u32,
    /// Width and height in pixels of the pictures that are held against the truth
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = values::size, allow_hyphen_values = true)]
    pub(crate) truth_size: [u32; 2],
    /// Rays a pixel of the truth
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub(crate) truth_samples: u32,
    /// Threads to draw with; 0: as many processors as this process may use
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub(crate) threads: u32,
    /// Write the figures as one JSON object to FILE; - is stdout, in place of the table
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Compare with the run whose --json is FILE
    #[arg(long, value_name = "FILE")]
    pub(crate) against: Option<PathBuf>,
    /// Say nothing but the figures, warnings and errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
