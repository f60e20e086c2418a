//! Many frames: which there are, which of them are drawn here, from where, and into which files.

use crate::options::camera_list::CameraList;
use crate::options::camera_path::{CameraPath, Places};
use crate::options::shard::Shard;
use crate::options::values::digits;
use crate::refusal::Refusal;
use basrelief::Camera;
use clap::Args;
use glam::{DVec3, Vec3};
use std::path::{Path, PathBuf};

#[derive(Args)]
#[command(next_help_heading = "Many frames")]
pub(crate) struct FramesOptions {
    /// Draw N frames of a camera that goes once around its target; frame 1 is the picture without
    /// this option
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), conflicts_with = "camera_path")]
    turntable: Option<u32>,
    /// Draw the frames of a camera that moves smoothly along the [[key]] entries of a TOML file:
    /// frame, and any of eye, target, up and fov (or orthographic)
    #[arg(long, value_name = "FILE")]
    camera_path: Option<PathBuf>,
    /// Draw a frame for each line of a file (-: stdin), an object of JSON with the keys eye, target,
    /// up, fov, intrinsics, pose, pose-axes and near
    #[arg(long, value_name = "FILE", conflicts_with_all = ["turntable", "camera_path"])]
    cameras: Option<PathBuf>,
    /// Draw only these frames of them: 7, 1-100, 1-100x3 (every third), or several with commas;
    /// those that do not exist are left out
    #[arg(long, value_name = "LIST", value_parser = FrameList::parse)]
    frames: Option<FrameList>,
    /// Leave out pictures whose file is there
    #[arg(long)]
    pub(crate) skip_existing: bool,
    /// Draw only the I-th of every N frames [default: as the Slurm array says that this task is in]
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    /// Completions of the Kubernetes Indexed Job that this pod is in: draw its share of the frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "shard")]
    shards: Option<u32>,
}

/// Ranges of frames: first, last and step.
#[derive(Clone, Debug, PartialEq)]
struct FrameList(Vec<[u32; 3]>);

impl FrameList {
    fn parse(text: &str) -> Result<Self, String> {
        let range = |part: &str| {
            let (range, step) = part.split_once('x').unwrap_or((part, "1"));
            let (first, last) = range.split_once('-').unwrap_or((range, range));
            let [first, last, step] = [first, last, step].map(|number| digits(number.trim()));
            let range = [first?, last?, step?];
            (range[0] <= range[1] && range[2] > 0).then_some(range)
        };
        let ranges: Option<Vec<_>> = text.split(',').map(range).collect();
        ranges.map(Self).ok_or_else(|| "is not a list of frames such as 7, 1-100 or 1-100x3".into())
    }

    fn has(&self, frame: u32) -> bool {
        self.0.iter().any(|&[first, last, step]| {
            (first..=last).contains(&frame) && (frame - first).is_multiple_of(step)
        })
    }
}

/// How the camera moves.
enum Motion {
    Still,
    Turntable(u32),
    Path(CameraPath),
    List(CameraList),
}

/// The pictures that this process draws.
pub(crate) struct Sequence {
    motion: Motion,
    /// Numbers of the frames; one without meaning for a still picture.
    numbers: Vec<u32>,
    output: PathBuf,
    /// How many of how many frames these are, and why.
    pub(crate) remark: Option<String>,
}

impl FramesOptions {
    /// The pictures that the options ask for; `output` is the file, or the pattern of file names.
    pub(crate) fn sequence(&self, output: Option<&Path>) -> Result<Sequence, Refusal> {
        let motion = match self {
            Self { turntable: Some(num), .. } => Motion::Turntable(*num),
            Self { camera_path: Some(path), .. } => Motion::Path(CameraPath::read(path)?),
            Self { cameras: Some(path), .. } => Motion::List(CameraList::read(path)?),
            _ => return self.still(output),
        };
        let output = output.unwrap_or(Path::new("frame_####.png"));
        if !file_name(output).contains('#') {
            return Err(format!(
                "--output {}: many frames need #### for the frame's number",
                output.display()
            )
            .into());
        }
        let [first, last] = match &motion {
            Motion::Path(path) => path.range(),
            Motion::Turntable(num) => [1, *num],
            Motion::List(list) => [1, list.num()],
            Motion::Still => [1, 1],
        };
        let is_asked = |frame: &u32| self.frames.as_ref().is_none_or(|list| list.has(*frame));
        let asked: Vec<u32> = (first..=last).filter(is_asked).collect();
        let num_asked = asked.len();
        let shard = match self.shard {
            Some(shard) => Some((shard, "--shard")),
            None => Shard::from_environment(self.shards, |name| std::env::var(name).ok())?,
        };
        let numbers = shard.map_or(asked.clone(), |(shard, _)| shard.pick(asked));
        let remark = shard.map(|(shard, by)| {
            format!("shard {shard} ({by}): {} of {num_asked} frames", numbers.len())
        });
        Ok(Sequence { motion, numbers, output: output.into(), remark })
    }

    fn still(&self, output: Option<&Path>) -> Result<Sequence, Refusal> {
        let given = [
            ("--frames", self.frames.is_some()),
            ("--shard", self.shard.is_some()),
            ("--shards", self.shards.is_some()),
        ];
        if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
            return Err(format!(
                "{option}: needs many frames, from --turntable, --camera-path or --cameras"
            )
            .into());
        }
        let output = output.unwrap_or(Path::new("basrelief.png")).into();
        Ok(Sequence { motion: Motion::Still, numbers: vec![1], output, remark: None })
    }
}

impl Sequence {
    /// Whether there are frames with numbers.
    pub(crate) fn is_numbered(&self) -> bool {
        !matches!(self.motion, Motion::Still)
    }

    /// Numbers and files of the pictures.
    pub(crate) fn pictures(&self) -> impl Iterator<Item = (u32, PathBuf)> {
        self.numbers.iter().map(|&number| (number, self.file(number)))
    }

    /// The pattern of the files' names.
    pub(crate) fn output(&self) -> &Path {
        &self.output
    }

    fn file(&self, number: u32) -> PathBuf {
        self.file_like(&self.output, number)
    }

    /// The file of a frame by a pattern of names.
    pub(crate) fn file_like(&self, pattern: &Path, number: u32) -> PathBuf {
        if self.is_numbered() {
            pattern.with_file_name(numbered(&file_name(pattern), number))
        } else {
            pattern.into()
        }
    }

    /// The cameras of the frames, from that of the scene.
    ///
    /// # Errors
    /// Says what of a camera path such a camera does not have.
    pub(crate) fn cameras(&self, start: Camera) -> Result<Cameras<'_>, Refusal> {
        Ok(match &self.motion {
            Motion::Still => Cameras::Still(start),
            Motion::Turntable(num) => Cameras::Turntable(start, *num),
            Motion::Path(path) => Cameras::Path(path.places(&start)?),
            Motion::List(list) => Cameras::List(start, list),
        })
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// `name` with its last run of `#` replaced by the number, at least as wide.
fn numbered(name: &str, number: u32) -> String {
    let Some(end) = name.rfind('#') else { return name.into() };
    let start = name[..end]
        .rfind(|c| c != '#')
        .map_or(0, |at| at + name[at..].chars().next().map_or(1, char::len_utf8));
    format!("{}{number:0width$}{}", &name[..start], &name[end + 1..], width = end + 1 - start)
}

/// Where the camera is in each frame.
pub(crate) enum Cameras<'a> {
    Still(Camera),
    Turntable(Camera, u32),
    Path(Places),
    List(Camera, &'a CameraList),
}

impl Cameras<'_> {
    pub(crate) fn camera(&self, number: u32) -> Camera {
        match self {
            Self::Still(camera) => *camera,
            Self::Turntable(camera, num) => turned(camera, number - 1, *num),
            Self::Path(places) => places.camera(number),
            Self::List(start, list) => list.camera(number, start),
        }
    }
}

/// The camera after `step` of `num` steps around its target, counterclockwise as seen from above
/// (Rodrigues' formula).
fn turned(camera: &Camera, step: u32, num: u32) -> Camera {
    if step == 0 {
        return *camera;
    }
    // The same digits on every machine, unlike the platform's functions.
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(step) / f64::from(num));
    let [eye, target, up] = [camera.eye, camera.target, camera.up].map(Vec3::as_dvec3);
    let (arm, axis): (DVec3, DVec3) = (eye - target, up.normalize());
    let arm = arm * cos + axis.cross(arm) * sin + axis * (axis.dot(arm) * (1.0 - cos));
    Camera { eye: (target + arm).as_vec3(), ..*camera }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_frames() {
        let list = FrameList::parse("1-10x3, 20,30-31").unwrap();
        let frames: Vec<u32> = (0..50).filter(|frame| list.has(*frame)).collect();
        assert_eq!(frames, [1, 4, 7, 10, 20, 30, 31]);
        for bad in ["", "1-", "-3", "5-1", "1-9x0", "1-9x", "a", "1,,2", "1 2"] {
            assert!(FrameList::parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_fill_the_pattern() {
        for (pattern, expected) in [
            ("frame_####.png", "frame_0007.png"),
            ("#.png", "7.png"),
            ("a#b##.png", "a#b07.png"),
            ("é###", "é007"),
            ("plain.png", "plain.png"),
        ] {
            assert_eq!(numbered(pattern, 7), expected);
        }
        assert_eq!(numbered("f##.png", 12345), "f12345.png");
    }

    #[test]
    fn turntable_goes_once_around() {
        let camera = Camera {
            eye: Vec3::new(1.0, 2.0, 5.0),
            target: Vec3::new(1.0, 1.0, 1.0),
            ..Camera::default()
        };
        let cameras = Cameras::Turntable(camera, 4);
        assert_eq!(cameras.camera(1), camera);
        let expected = [[5.0, 2.0, 1.0], [1.0, 2.0, -3.0], [-3.0, 2.0, 1.0]].map(Vec3::from);
        for (number, eye) in (2..).zip(expected) {
            let found = cameras.camera(number);
            assert!(
                (found.eye - eye).length() < 1e-6 && found.target == camera.target,
                "{number}: {found:?}"
            );
        }
    }
}
