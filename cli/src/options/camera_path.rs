//! Camera paths: keyframes in TOML, and the smooth way between them.
//!
//! ```toml
//! [[key]]
//! frame = 1
//! eye = [0.0, 1.7, 6.0]
//! target = [0.0, 1.0, 0.0]
//! [[key]]
//! frame = 48            # what a key does not give stays as it was at the key before
//! eye = [4.0, 1.7, 4.0]
//! fov = 35.0
//! ```
//!
//! Between two keys every number runs along a cubic Hermite curve over the frames. Its slope at a
//! key is that of the parabola through the key and its neighbours, at the ends that of the line;
//! where two keys in a row are equal the camera rests, with slope 0. Only sums and products are
//! used, so that every machine finds the same cameras.

use crate::options::{file_values, scene_file};
use crate::refusal::Refusal;
use basrelief::Camera;
use glam::{DVec3, Vec3};
use serde::Deserialize;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PathFile {
    key: Vec<Key>,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Key {
    frame: u32,
    #[serde(default, deserialize_with = "file_values::vector")]
    eye: Option<Vec3>,
    #[serde(default, deserialize_with = "file_values::vector")]
    target: Option<Vec3>,
    #[serde(default, deserialize_with = "file_values::direction")]
    up: Option<Vec3>,
    #[serde(default, deserialize_with = "file_values::field_of_view")]
    fov: Option<f32>,
    #[serde(default, deserialize_with = "file_values::picture_height")]
    orthographic: Option<f32>,
}

/// Eye, target, up, and the field of view in the first component, or the picture's height where rays are
/// parallel.
type Place = [DVec3; 4];

/// Keyframes in order.
pub(crate) struct CameraPath {
    keys: Vec<Key>,
}

/// Most frames of a path.
const MAX_FRAMES: u32 = 1_000_000;

impl CameraPath {
    pub(crate) fn read(path: &Path) -> Result<Self, Refusal> {
        let PathFile { key: keys } = scene_file::parse(path, &scene_file::read_text(path)?)?;
        let refuse = |reason: String| Err(Refusal::file(path, reason));
        let [Some(first), Some(last)] = [keys.first(), keys.last()] else {
            return refuse("has no [[key]]".into());
        };
        if let Some(pair) = keys.windows(2).find(|pair| pair[0].frame >= pair[1].frame) {
            return refuse(format!(
                "the key of frame {} comes after that of {}",
                pair[1].frame, pair[0].frame
            ));
        }
        if last.frame - first.frame >= MAX_FRAMES {
            return refuse(format!(
                "frames {} to {} are more than {MAX_FRAMES}",
                first.frame, last.frame
            ));
        }
        Ok(Self { keys })
    }

    /// The first frame and the last.
    pub(crate) fn range(&self) -> [u32; 2] {
        [self.keys[0].frame, self.keys[self.keys.len() - 1].frame]
    }

    /// Where the camera is at the keys, from `start` on.
    ///
    /// # Errors
    /// Says which key gives what such a camera does not have.
    pub(crate) fn places(&self, start: &Camera) -> Result<Places, Refusal> {
        let is_parallel = start.orthographic.is_some();
        let opening = start.orthographic.unwrap_or(start.fov_degrees);
        let mut place =
            [start.eye, start.target, start.up, Vec3::new(opening, 0.0, 0.0)].map(Vec3::as_dvec3);
        for Key { frame, fov, orthographic, .. } in &self.keys {
            let (wrong, is_given) = match is_parallel {
                true => ("fov, but the camera is orthographic", fov.is_some()),
                false => ("orthographic, but the camera is not", orthographic.is_some()),
            };
            if is_given {
                return Err(format!("camera path: the key of frame {frame} gives {wrong}").into());
            }
        }
        let at_keys = self.keys.iter().map(|key| {
            let opening = key.fov.or(key.orthographic);
            let given = [key.eye, key.target, key.up, opening.map(|of| Vec3::new(of, 0.0, 0.0))];
            place
                .iter_mut()
                .zip(given)
                .for_each(|(old, new)| *old = new.map_or(*old, Vec3::as_dvec3));
            (f64::from(key.frame), place)
        });
        let keys: Vec<(f64, Place)> = at_keys.collect();
        let slopes = (0..keys.len()).map(|i| slope(&keys, i)).collect();
        Ok(Places { keys, slopes, start: *start })
    }
}

/// Keys with the slopes of the curves through them, per frame.
pub(crate) struct Places {
    keys: Vec<(f64, Place)>,
    slopes: Vec<Place>,
    /// What stays as it is.
    start: Camera,
}

impl Places {
    /// The camera of a frame within the path's range.
    pub(crate) fn camera(&self, frame: u32) -> Camera {
        let frame = f64::from(frame);
        let end =
            self.keys.partition_point(|key| key.0 < frame).clamp(1, self.keys.len().max(2) - 1);
        let [eye, target, up, opening] = match self.keys.get(end) {
            Some(_) => self.between(end - 1, frame),
            None => self.keys[0].1,
        };
        let [eye, target, up, opening] = [eye, target, up, opening].map(|v| v.as_vec3());
        let camera = Camera { eye, target, up, ..self.start };
        match self.start.orthographic {
            Some(_) => Camera { orthographic: Some(opening.x), ..camera },
            None => Camera { fov_degrees: opening.x, ..camera },
        }
    }

    /// The cubic Hermite curve from key `i` to the next.
    fn between(&self, i: usize, frame: f64) -> Place {
        let ((start, from), (end, to)) = (self.keys[i], self.keys[i + 1]);
        let length = end - start;
        let t = (frame - start) / length;
        let s = 1.0 - t;
        std::array::from_fn(|k| {
            let (leave, arrive) = (self.slopes[i][k] * length, self.slopes[i + 1][k] * length);
            // The weights of the two ends are 1 and 0 at a key, exactly.
            from[k] * (s * s * (1.0 + 2.0 * t))
                + to[k] * (t * t * (1.0 + 2.0 * s))
                + (leave * s - arrive * t) * (s * t)
        })
    }
}

/// How each number changes per frame at key `i`.
fn slope(keys: &[(f64, Place)], i: usize) -> Place {
    let step = |i: usize| {
        let ((start, from), (end, to)) = (keys[i], keys[i + 1]);
        (end - start, std::array::from_fn(|k| (to[k] - from[k]) / (end - start)))
    };
    let before: Option<(f64, Place)> = (i > 0).then(|| step(i - 1));
    let after: Option<(f64, Place)> = (i + 1 < keys.len()).then(|| step(i));
    let rests =
        |side: &Option<(f64, Place)>| side.is_some_and(|(_, slope)| slope == [DVec3::ZERO; 4]);
    match (before, after) {
        _ if rests(&before) || rests(&after) => [DVec3::ZERO; 4],
        (Some((a, before)), Some((b, after))) => {
            std::array::from_fn(|k| (before[k] * b + after[k] * a) / (a + b))
        }
        (Some((_, slope)), None) | (None, Some((_, slope))) => slope,
        (None, None) => [DVec3::ZERO; 4],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(text: &str) -> Result<CameraPath, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        CameraPath::read(file.path())
            .map_err(|e| e.to_string().replace(&file.path().display().to_string(), "path.toml"))
    }

    const KEYS: &str = "[[key]]\nframe = 1\neye = [0, 1, 4]\n[[key]]\nframe = 11\neye = [3, 1, 4]\nfov = 40\n\
                        [[key]]\nframe = 41\neye = [3, 2, 0]\n[[key]]\nframe = 50\n";

    #[test]
    fn path_goes_through_its_keys() {
        let start = Camera { near: 0.25, ..Camera::default() };
        let places = path(KEYS).unwrap().places(&start).unwrap();
        let eyes =
            [(1, [0.0, 1.0, 4.0], 60.0), (11, [3.0, 1.0, 4.0], 40.0), (41, [3.0, 2.0, 0.0], 40.0)];
        for (frame, eye, fov_degrees) in eyes {
            assert_eq!(
                places.camera(frame),
                Camera { eye: eye.into(), fov_degrees, ..start },
                "{frame}"
            );
        }
        // Keys in a row that are equal: the camera rests.
        assert!((41..=50).all(|frame| places.camera(frame) == places.camera(41)));
    }

    #[test]
    fn heights_of_parallel_rays_have_keys() {
        let start = Camera { orthographic: Some(2.0), ..Camera::default() };
        let keys = "[[key]]\nframe = 1\n[[key]]\nframe = 3\northographic = 4\n";
        let places = path(keys).unwrap().places(&start).unwrap();
        let heights = [1, 2, 3].map(|frame| places.camera(frame).orthographic);
        assert_eq!(heights, [2.0, 3.0, 4.0].map(Some));
        let refusal = path(KEYS).unwrap().places(&start).err().unwrap().to_string();
        assert!(refusal.contains("frame 11 gives fov"), "{refusal}");
        assert!(path(keys).unwrap().places(&Camera::default()).is_err());
    }

    #[test]
    fn path_is_smooth() {
        let places = path(KEYS).unwrap().places(&Camera::default()).unwrap();
        let eyes: Vec<Vec3> = (1..=50).map(|frame| places.camera(frame).eye).collect();
        let steps: Vec<Vec3> = eyes.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let jolt = steps.windows(2).map(|pair| (pair[1] - pair[0]).length()).fold(0.0, f32::max);
        let longest = steps.iter().map(|step| step.length()).fold(0.0, f32::max);
        // Straight lines between the keys would turn by the whole step at once.
        assert!(jolt < 0.35 * longest, "{jolt} of {longest}");
    }

    #[test]
    fn one_key_is_a_path() {
        let places = path("[[key]]\nframe = 7\neye = [1, 2, 3]\n")
            .unwrap()
            .places(&Camera::default())
            .unwrap();
        assert_eq!(places.camera(7).eye, Vec3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn mistakes_are_refused_with_their_line() {
        for (text, words) in [
            ("", "path.toml"),
            ("key = []", "no [[key]]"),
            ("[[key]]\nframe = 1\n[[key]]\nframe = 1\n", "frame 1 comes after"),
            ("[[key]]\nframe = 1\n[[key]]\nframe = 2000000\n", "more than"),
            ("[[key]]\nframe = 1\nfov = 0\n", "path.toml:3: fov"),
            ("[[key]]\nframe = 1\neye = [1, 2]\n", "path.toml:3: eye"),
            ("[[key]]\nframe = 1\n\ncolour = 3\n", "path.toml:4: unknown field `colour`"),
            ("[[key]]\nframe = -1\n", "path.toml:2: frame"),
        ] {
            let refusal = path(text).err().unwrap();
            assert!(refusal.contains(words), "{text}: {refusal}");
        }
    }
}
