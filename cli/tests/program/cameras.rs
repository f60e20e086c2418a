//! Cameras by intrinsics and pose.

use crate::folder::Folder;
use std::fs;

const SMALL: &str = "quad.obj -q --size 24x16 -f nearest";

#[test]
fn a_pose_is_an_eye_with_its_axes() {
    let folder = Folder::new();
    // A field of view of 90 degrees: half the height is as far as the frame's plane.
    folder.succeeds(&format!("{SMALL} --eye 0.5,0.25,3 --target 0.5,0.25,0 --fov 90 -o a.png"));
    let lens = "--intrinsics 8,8,12,8";
    let cv = "1,0,0,0.5,0,-1,0,0.25,0,0,-1,3,0,0,0,1";
    folder.succeeds(&format!("{SMALL} {lens} --pose {cv} --save-scene s.toml -o b.png"));
    let gl = "1,0,0,0.5,0,1,0,0.25,0,0,1,3,0,0,0,1";
    folder.succeeds(&format!("{SMALL} {lens} --pose {gl} --pose-axes opengl -o c.png"));
    folder.succeeds("s.toml -q -o d.png");
    let [a, b, c, d] =
        ["a.png", "b.png", "c.png", "d.png"].map(|name| fs::read(folder.path(name)).unwrap());
    assert!(a == b && b == c && c == d);
}

#[test]
fn what_is_no_camera_is_refused() {
    let folder = Folder::new();
    for (options, words) in [
        ("--intrinsics 1,2,3", "four numbers"),
        ("--intrinsics 0,2,3,4", "focal lengths"),
        ("--pose 1,2,3", "16 numbers"),
        ("--pose 2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "rotation"),
        ("--pose-axes opengl", "--pose"),
        ("--pose 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 --eye 0,0,1", "--eye"),
    ] {
        folder.refuses(&format!("{SMALL} {options}"), &[words]);
    }
}
