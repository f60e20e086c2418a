//! How many threads the program draws with when none are asked for.

use crate::folder::{Folder, json, skipped, text};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The threads of a small picture, drawn by a shell that runs `before` first.
fn num_threads(folder: &Folder, before: &str) -> u64 {
    let program = env!("CARGO_BIN_EXE_basrelief");
    let line = format!("{before} exec {program} quad.obj --size 32x18 -o a.png --quiet --stats -");
    let output =
        Command::new("sh").args(["-ec", &line]).current_dir(folder.path(".")).output().unwrap();
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    json(&output.stdout)["threads"].as_u64().unwrap()
}

/// A control group with a quota of processor time, removed when dropped.
struct Group(PathBuf);

impl Group {
    /// A group that may use `share` of a processor's time in each tenth of a second, where this
    /// process may make one.
    fn new(share: f64) -> Option<Self> {
        let name = format!("basrelief-test-{}", std::process::id());
        let quota = (share * 1e5) as u32;
        let make = |parent: &str, file: &str, content: String| {
            let group = Self(Path::new(parent).join(&name));
            fs::create_dir(&group.0).ok()?;
            let is_there = group.0.join(file).is_file();
            (is_there && fs::write(group.0.join(file), content).is_ok()).then_some(group)
        };
        // Version 1 gives the processor a tree of its own; in version 2 the root's groups may need
        // to be given it.
        let of_version_2 = || {
            // Refused where it is given already.
            let _ = fs::write("/sys/fs/cgroup/cgroup.subtree_control", "+cpu");
            make("/sys/fs/cgroup", "cpu.max", format!("{quota} 100000"))
        };
        make("/sys/fs/cgroup/cpu", "cpu.cfs_quota_us", quota.to_string()).or_else(of_version_2)
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        // Where it was not made there is nothing to remove.
        let _ = fs::remove_dir(&self.0);
    }
}

#[test]
fn quotas_of_control_groups_are_rounded_down() {
    let folder = Folder::new();
    for (share, most) in [(1.9, 1), (0.5, 1)] {
        let Some(group) = Group::new(share) else {
            return skipped("no control group can be made here");
        };
        let enter = format!("echo $$ > {}/cgroup.procs;", group.0.display());
        assert_eq!(num_threads(&folder, &enter), most, "{share} processors");
    }
}

#[test]
fn the_affinity_mask_is_heeded() {
    let folder = Folder::new();
    let program = env!("CARGO_BIN_EXE_basrelief");
    let mut command = Command::new("taskset");
    command.args(["-c", "0", program, "quad.obj", "-q", "--size", "8x8", "-o", "a.png", "--json"]);
    let Ok(output) = command.current_dir(folder.path(".")).output() else {
        return skipped("there is no taskset on this machine");
    };
    assert_eq!(json(&output.stdout)["threads"], 1, "{}", text(&output.stderr));
}
