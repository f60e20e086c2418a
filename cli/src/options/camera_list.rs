//! Cameras one by one: an object of JSON a line, with the keys of `[camera]` in scene files.
//!
//! ```json
//! {"eye": [0, 1.7, 6], "target": [0, 1, 0], "fov": 35}
//! {"pose": [[1, 0, 0, 0], [0, -1, 0, 1.7], [0, 0, -1, 6], [0, 0, 0, 1]], "intrinsics": [800, 800, 320, 240]}
//! ```
//!
//! The camera of line n is that of frame n. What a line leaves out is the scene's camera's.

use crate::options::camera::CameraOptions;
use crate::options::scene_file;
use crate::refusal::Refusal;
use basrelief::Camera;
use std::fs::File;
use std::io::{BufRead, BufReader, stdin};
use std::path::Path;

/// Most lines of a list.
const MAX_CAMERAS: usize = 1_000_000;

/// The cameras of a file, line by line.
pub(crate) struct CameraList(Vec<CameraOptions>);

impl CameraList {
    /// Reads a file; `-` is the standard input.
    pub(crate) fn read(path: &Path) -> Result<Self, Refusal> {
        if path == Path::new("-") {
            return Self::of(Path::new("stdin"), stdin().lock());
        }
        scene_file::length_of(path)?;
        let file = File::open(path).map_err(|e| Refusal::file(path, e))?;
        Self::of(path, BufReader::new(file))
    }

    fn of(path: &Path, text: impl BufRead) -> Result<Self, Refusal> {
        let mut cameras = Vec::new();
        for (line, number) in text.lines().zip(1..) {
            let refuse = |reason: String| format!("{}:{number}: {reason}", path.display());
            let line = line.map_err(|e| refuse(e.to_string()))?;
            if number > MAX_CAMERAS {
                return Err(refuse(format!("more than {MAX_CAMERAS} cameras")).into());
            }
            if line.trim().is_empty() {
                return Err(refuse("is empty; line n is the camera of frame n".into()).into());
            }
            let camera: CameraOptions =
                serde_json::from_str(&line).map_err(|e| refuse(without_line(&e)))?;
            camera.check().map_err(|reason| refuse(reason.into()))?;
            cameras.push(camera);
        }
        if cameras.is_empty() {
            return Err(Refusal::file(path, "has no camera"));
        }
        Ok(Self(cameras))
    }

    /// How many there are.
    pub(crate) fn num(&self) -> u32 {
        self.0.len() as u32
    }

    /// The camera of a frame, from 1 on.
    pub(crate) fn camera(&self, frame: u32, start: &Camera) -> Camera {
        self.0[frame as usize - 1].placed(start)
    }
}

/// What JSON's reader says, but for the line, which it counts from this one on.
fn without_line(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let [place, column] = [" at line 1 column ", " (column "];
    match text.split_once(place) {
        Some((reason, at)) => format!("{reason}{column}{at})"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn list(text: &str) -> Result<CameraList, String> {
        CameraList::of(Path::new("cameras.jsonl"), text.as_bytes()).map_err(|e| e.to_string())
    }

    #[test]
    fn a_line_is_a_frame() {
        let start = Camera { near: 0.25, ..Camera::default() };
        let pose = "[[1,0,0,4],[0,-1,0,5],[0,0,-1,6],[0,0,0,1]]";
        let text = format!(
            "{{\"eye\": [1, 2, 3]}}\n{{}}\n{{\"pose\": {pose}, \"intrinsics\": [8, 8, 12, 8]}}\n"
        );
        let cameras = list(&text).unwrap();
        assert_eq!(cameras.num(), 3);
        let eye = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(cameras.camera(1, &start), Camera { eye, ..start });
        assert_eq!(cameras.camera(2, &start), start);
        let posed = cameras.camera(3, &start);
        assert_eq!((posed.eye, posed.up, posed.near), (Vec3::new(4.0, 5.0, 6.0), Vec3::Y, 0.25));
        assert!(posed.intrinsics.is_some());
    }

    #[test]
    fn lenses_take_each_others_place() {
        let start = Camera { orthographic: Some(2.0), ..Camera::default() };
        let text = "{}\n{\"fov\": 20}\n{\"intrinsics\": [8, 8, 12, 8]}\n{\"orthographic\": 3}\n";
        let cameras = list(text).unwrap();
        let found = [1, 2, 3, 4].map(|frame| cameras.camera(frame, &start).orthographic);
        assert_eq!(found, [Some(2.0), None, None, Some(3.0)]);
        let posed = cameras.camera(3, &Camera::default());
        let parallel = cameras.camera(4, &posed);
        assert!(posed.intrinsics.is_some() && parallel.intrinsics.is_none());
        assert!(parallel.validate().is_ok());
    }

    #[test]
    fn mistakes_are_refused_with_their_line() {
        for (text, words) in [
            ("", "has no camera"),
            ("{}\n\n{}\n", "cameras.jsonl:2: is empty"),
            ("{}\n{\"fov\": 0}\n", "cameras.jsonl:2: must be"),
            ("{\"colour\": 1}\n", "cameras.jsonl:1: unknown field `colour`"),
            ("{\"eye\": [1, 2]}\n", "cameras.jsonl:1: invalid length 2"),
            ("{\"pose\": [[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}\n", "rotation"),
            ("{\"pose\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], \"up\": [0,1,0]}", "pose"),
            ("{\"pose-axes\": \"opencv\"}\n", "pose"),
            ("{\"orthographic\": 0}\n", "cameras.jsonl:1: must be within"),
            ("{\"orthographic\": 2, \"fov\": 3}\n", "takes the place of fov"),
            ("7\n", "cameras.jsonl:1: invalid type"),
        ] {
            let refusal = list(text).err().unwrap();
            assert!(refusal.contains(words), "{text}: {refusal}");
        }
    }
}
