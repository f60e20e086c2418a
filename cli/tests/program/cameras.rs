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
fn a_list_has_a_camera_a_line() {
    let folder = Folder::new();
    let pose = "[[1,0,0,0.5],[0,-1,0,0.25],[0,0,-1,3],[0,0,0,1]]";
    let list = format!(
        "{{\"eye\": [0.5, 0.25, 3], \"target\": [0.5, 0.25, 0], \"fov\": 90}}\n\
         {{\"pose\": {pose}, \"intrinsics\": [8, 8, 12, 8]}}\n{{\"fov\": 20}}\n"
    );
    folder.put("list.jsonl", &list);
    folder.succeeds(&format!("{SMALL} --cameras list.jsonl -o l#.png --layer depth=d#.npy"));
    folder.succeeds(&format!("{SMALL} --fov 20 -o c.png --layer depth=c.npy"));
    let read = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(read("l1.png") == read("l2.png") && read("d1.npy") == read("d2.npy"));
    assert!(read("l3.png") == read("c.png") && read("d3.npy") == read("c.npy"));
    folder.put("bad.jsonl", "{}\n{\"eye\": 7}\n");
    folder.refuses(&format!("{SMALL} --cameras bad.jsonl -o b#.png"), &["bad.jsonl:2: "]);
    folder.refuses(&format!("{SMALL} --cameras none.jsonl"), &["none.jsonl: no such file"]);
}

#[test]
fn scene_files_hold_poses_and_options_take_their_place() {
    let folder = Folder::new();
    let view = "--eye 0.5,0.25,3 --target 0.5,0.25,0 --fov 90";
    folder.succeeds(&format!("{SMALL} {view} -o a.png"));
    let rows = "[[1, 0, 0, 0.5], [0, -1, 0, 0.25], [0, 0, -1, 3], [0, 0, 0, 1]]";
    let file = |pose: &str| format!("model = \"quad.obj\"\n[camera]\nfov = 90\n{pose}\n");
    folder.put("pose.toml", file(&format!("pose = {rows}")));
    folder.put("eye.toml", file("eye = [9, 9, 9]\ntarget = [0, 0, 0]"));
    folder.put("both.toml", file(&format!("pose = {rows}\neye = [9, 9, 9]")));
    let small = "-q --size 24x16 -f nearest";
    folder.succeeds(&format!("pose.toml {small} -o b.png"));
    let flat = "1,0,0,0.5,0,-1,0,0.25,0,0,-1,3,0,0,0,1";
    folder.succeeds(&format!("eye.toml {small} --pose {flat} -o c.png"));
    folder.succeeds(&format!("pose.toml {small} --eye 0.5,0.25,3 --target 0.5,0.25,0 -o d.png"));
    folder.refuses(&format!("both.toml {small}"), &["both.toml: a pose takes the place of eye"]);
    let [a, b, c, d] =
        ["a.png", "b.png", "c.png", "d.png"].map(|name| fs::read(folder.path(name)).unwrap());
    assert!(a == b && b == c && c == d);
}

#[test]
fn parallel_rays_take_the_place_of_others() {
    let folder = Folder::new();
    let view = "--eye 0.5,0.25,3 --target 0.5,0.25,0";
    folder.succeeds(&format!("{SMALL} {view} --orthographic 1 -o a.png --layer depth=a.npy"));
    // From another distance the same is seen.
    folder.succeeds(&format!(
        "{SMALL} --eye 0.5,0.25,9 --target 0.5,0.25,0 --orthographic 1 -o b.png"
    ));
    folder.put("fov.toml", "model = \"quad.obj\"\n[camera]\nfov = 20\n");
    let small = "-q --size 24x16 -f nearest";
    folder.succeeds(&format!("fov.toml {small} {view} --orthographic 1 -o c.png"));
    folder.put("parallel.toml", "model = \"quad.obj\"\n[camera]\northographic = 1\n");
    folder.succeeds(&format!("parallel.toml {small} {view} -o d.png"));
    folder.put("both.toml", "model = \"quad.obj\"\n[camera]\northographic = 1\nfov = 20\n");
    folder.refuses(&format!("both.toml {small}"), &["both.toml: orthographic takes the place"]);
    let read = |name: &str| fs::read(folder.path(name)).unwrap();
    let [a, b, c, d] = ["a.png", "b.png", "c.png", "d.png"].map(read);
    assert!(a == b && b == c && c == d);
    // And options take the place of the file's.
    folder.succeeds(&format!("parallel.toml {small} {view} --fov 20 -o e.png"));
    folder.succeeds(&format!("fov.toml {small} {view} -o f.png"));
    assert!(read("e.png") == read("f.png") && read("e.png") != a);
}

#[test]
fn what_is_no_camera_is_refused() {
    let folder = Folder::new();
    for (options, words) in [
        ("--intrinsics 1,2,3", "four numbers"),
        ("--intrinsics 0,2,3,4", "focal lengths"),
        ("--orthographic 0", "--orthographic"),
        ("--orthographic 2 --fov 30", "--fov"),
        ("--pose 1,2,3", "16 numbers"),
        ("--pose 2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "rotation"),
        ("--pose-axes opengl", "--pose"),
        ("--pose 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1 --eye 0,0,1", "--eye"),
    ] {
        folder.refuses(&format!("{SMALL} {options}"), &[words]);
    }
}
