//! Files appear whole or not at all, whatever ends the program.

use crate::folder::{Folder, text};
use std::fs;
use std::process::Command;

/// The names of all files, sorted.
fn names(folder: &Folder) -> Vec<std::ffi::OsString> {
    folder.contents().into_iter().map(|(path, _)| path.file_name().unwrap().to_owned()).collect()
}

#[cfg(target_os = "linux")]
#[test]
fn full_disk_is_refused() {
    let folder = Folder::new();
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = folder.command("quad.obj --size 8x8 -q -o -").stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("stdout"));
}

/// A file that may not grow past a few kilobytes, like one on a full disk.
#[cfg(target_os = "linux")]
#[test]
fn disk_that_fills_up_leaves_the_old_file() {
    let folder = Folder::new();
    folder.put("out.bmp", "old");
    let program = env!("CARGO_BIN_EXE_basrelief");
    let script =
        format!("trap '' XFSZ; ulimit -f 8; exec {program} quad.obj --size 200x200 -q -o out.bmp");
    let mut command = Command::new("sh");
    // Where coverage is measured, its own file would not fit either.
    command
        .args(["-c", &script])
        .current_dir(folder.path("."))
        .env("LLVM_PROFILE_FILE", "/dev/null");
    let output = command.output().unwrap();
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(
        message.starts_with("basrelief: out.bmp: cannot be written: File too large"),
        "{message}"
    );
    assert!(!message.contains(".tmp") && message.lines().count() == 1, "{message}");
    assert_eq!(names(&folder), ["out.bmp", "quad.obj"]);
    assert_eq!(fs::read(folder.path("out.bmp")).unwrap(), b"old");
}

/// Runs two ways to overwrite `out.png` in turn, ended by `end` at `num` moments spread over a
/// whole run.
fn interrupt(folder: &Folder, num: u32, end: impl Fn(&mut std::process::Child)) {
    let lines = ["white", "navy"].map(|color| {
        format!("quad.obj --size 320x180 -q -f nearest -o out.png --background {color}")
    });
    let mut longest = std::time::Duration::ZERO;
    let whole = lines.each_ref().map(|line| {
        let start = std::time::Instant::now();
        folder.succeeds(line);
        longest = longest.max(start.elapsed());
        fs::read(folder.path("out.png")).unwrap()
    });
    for i in 0..num {
        let mut child = folder.command(&lines[i as usize % 2]).spawn().unwrap();
        std::thread::sleep(longest * i / num);
        end(&mut child);
        child.wait().unwrap();
        assert!(whole.contains(&fs::read(folder.path("out.png")).unwrap()), "moment {i} of {num}");
    }
}

/// The next run removes what the killed ones left.
#[test]
fn program_killed_at_100_moments_leaves_a_whole_image() {
    let folder = Folder::new();
    interrupt(&folder, 100, |child| child.kill().unwrap());
    folder.succeeds("quad.obj --size 8x8 -q -o out.png");
    assert_eq!(names(&folder), ["out.png", "quad.obj"]);
}

#[test]
fn interrupted_program_leaves_nothing_behind() {
    let folder = Folder::new();
    interrupt(&folder, 20, |child| {
        // It may have ended by itself.
        let _ = Command::new("kill").args(["-INT", &child.id().to_string()]).output();
    });
    assert_eq!(names(&folder), ["out.png", "quad.obj"]);
}
