//! Scene files: the options of a picture in TOML, to keep it and to repeat it.
//!
//! ```toml
//! model = "house.obj"             # left out: the built-in scene
//! crease-angle = 30.0             # --crease-angle
//! [all-materials]                 # --albedo, --height, --relief-depth and their like
//! relief-depth = 0.04
//! [material.brick]                # the same keys for the material of that name
//! height = "brick_height.png"
//! [camera]                        # --eye, --target, --up, --fov, --intrinsics, --orthographic,
//!                                 # --pose, --near
//! eye = [3.0, 2.0, 5.0]
//! [light]                         # --sky, --background, and lights
//! background = "skyblue"
//! [[light.sun]]
//! direction = [1.0, 2.0, 1.0]
//! [frame]                         # --size, --region, --msaa, --cull, --tile, --lighting, --exposure, --tone
//! size = "1920x1080"
//! [filter]                        # --filter and its options
//! lines = 16
//! [limits]                        # --allow-outside, --max-image-side and their like
//! ```
//!
//! Keys are the names of options, tables are the headings of the help. Files are named relative to
//! the scene file. An option on the command line overrides the key.

use crate::options::camera::CameraOptions;
use crate::options::file_values;
use crate::options::filter::FilterOptions;
use crate::options::scene::{LightOptions, LimitOptions, MapOptions, SceneOptions};
use crate::options::settings::{FrameOptions, SettingsOptions};
use crate::refusal::{Refusal, option_of};
use basrelief::{Camera, Error, Settings};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A scene file as it is spelt.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
struct SceneFile {
    model: Option<PathBuf>,
    #[serde(deserialize_with = "file_values::crease_angle")]
    crease_angle: Option<f32>,
    all_materials: MapOptions,
    material: BTreeMap<String, MapOptions>,
    camera: CameraOptions,
    light: LightOptions,
    frame: FrameOptions,
    filter: FilterOptions,
    limits: LimitOptions,
}

/// Puts what the scene file says, if `scene` names one, under what the options say.
pub(crate) fn read_into(
    scene: &mut SceneOptions,
    settings: &mut SettingsOptions,
) -> Result<(), Refusal> {
    let is_scene_file = |path: &Path| {
        path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
    };
    let Some(path) = scene.model.take_if(|path| is_scene_file(path)) else { return Ok(()) };
    let over = SceneFile::of(scene, settings).table()?;
    let mut file = SceneFile::read(&path)?;
    file.camera.check().map_err(|reason| Refusal::file(&path, reason))?;
    file.camera.make_way_for(&scene.camera);
    let mut table = file.table()?;
    overlay(&mut table, over);
    let merged: SceneFile = table.try_into().map_err(|e| Refusal::file(&path, e))?;
    (*scene, *settings) = merged.options();
    Ok(())
}

/// A scene file that draws the same picture again: what the options say, and all of the camera and
/// settings.
pub(crate) fn text(
    scene: &SceneOptions,
    settings: &Settings,
    camera: &Camera,
    path: &Path,
) -> Result<String, Refusal> {
    let mut file = SceneFile::of(scene, &settings.into());
    file.camera = camera.into();
    let folder = folder_of(path);
    let root = std::fs::canonicalize(folder).map_err(|e| Refusal::file(folder, e))?;
    file.each_path(|path| {
        if let Ok(real) = std::fs::canonicalize(&*path) {
            *path = real.strip_prefix(&root).map_or(real.clone(), Into::into);
        }
    });
    let mut table = file.table()?;
    table.retain(|_, value| value.as_table().is_none_or(|table| !table.is_empty()));
    table.iter_mut().for_each(|(_, value)| shorten(value));
    let text = toml::to_string(&table).map_err(|e| Refusal::file(path, e))?;
    Ok(format!(
        "# basrelief {}: `basrelief FILE.toml -o picture.png` draws it again.\n{text}",
        env!("CARGO_PKG_VERSION")
    ))
}

/// Gives numbers the fewest digits that are the same f32.
fn shorten(value: &mut Value) {
    match value {
        Value::Float(number) => *number = (*number as f32).to_string().parse().unwrap_or(*number),
        Value::Array(values) => values.iter_mut().for_each(shorten),
        Value::Table(table) => table.iter_mut().for_each(|(_, value)| shorten(value)),
        _ => {}
    }
}

/// Values of `over` in place of those of `under`, table by table.
fn overlay(under: &mut Table, over: Table) {
    for (key, value) in over {
        match (under.get_mut(&key), value) {
            (Some(Value::Table(under)), Value::Table(over)) => overlay(under, over),
            (_, value) => {
                under.insert(key, value);
            }
        }
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

impl SceneFile {
    fn of(scene: &SceneOptions, settings: &SettingsOptions) -> Self {
        let SceneOptions { model, crease_angle, all_materials, material, limits, camera, light } =
            scene.clone();
        let SettingsOptions { frame, filter } = settings.clone();
        Self { model, crease_angle, all_materials, material, camera, light, frame, filter, limits }
    }

    fn options(self) -> (SceneOptions, SettingsOptions) {
        let Self {
            model,
            crease_angle,
            all_materials,
            material,
            camera,
            light,
            frame,
            filter,
            limits,
        } = self;
        (
            SceneOptions { model, crease_angle, all_materials, material, limits, camera, light },
            SettingsOptions { frame, filter },
        )
    }

    fn table(&self) -> Result<Table, Refusal> {
        Table::try_from(self).map_err(|e| format!("scene file: {e}").into())
    }

    /// Reads a file whose every value is of its type and within its range.
    fn read(path: &Path) -> Result<Self, Refusal> {
        let text = read_text(path)?;
        let mut file: Self = parse(path, &text)?;
        let (_, settings) = file.clone().options();
        if let Err(Error::Setting { name, reason }) = settings.check() {
            let key = option_of(name).trim_start_matches('-').to_owned();
            return Err(at(path, line_of_key(&text, &key), &format!("{key}: {reason}")));
        }
        file.each_path(|named| *named = folder_of(path).join(&*named));
        Ok(file)
    }

    fn each_path(&mut self, mut change: impl FnMut(&mut PathBuf)) {
        let maps = self.material.values_mut().chain([&mut self.all_materials]);
        let maps = maps.flat_map(MapOptions::files_mut);
        maps.chain([&mut self.model, &mut self.light.environment]).flatten().for_each(&mut change);
    }
}

/// The text of a file of at most 16 MiB.
pub(crate) fn read_text(path: &Path) -> Result<String, Refusal> {
    if length_of(path)? > 1 << 24 {
        return Err(Refusal::file(path, "is larger than 16 MiB"));
    }
    std::fs::read_to_string(path).map_err(|e| Refusal::file(path, e))
}

/// How long a file is; refuses what is none.
pub(crate) fn length_of(path: &Path) -> Result<u64, Refusal> {
    match std::fs::metadata(path) {
        Ok(found) if !found.is_file() => Err(Refusal::file(path, "is not a file")),
        Ok(found) => Ok(found.len()),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            Err(Refusal::file(path, "no such file"))
        }
        Err(e) => Err(Refusal::file(path, e)),
    }
}

/// Reads TOML; a refusal names the file, the line and the key.
pub(crate) fn parse<T: for<'de> Deserialize<'de>>(path: &Path, text: &str) -> Result<T, Refusal> {
    toml::from_str(text).map_err(|error| {
        let line =
            error.span().map(|span| text[..span.start.min(text.len())].matches('\n').count() + 1);
        let message = error.message().lines().collect::<Vec<_>>().join("; ");
        let spelt = line.and_then(|line| text.lines().nth(line - 1)?.split_once('='));
        match spelt.map(|(key, _)| key.trim()).filter(|key| !message.contains(*key)) {
            Some(key) => at(path, line, &format!("{key}: {message}")),
            None => at(path, line, &message),
        }
    })
}

/// `FILE:LINE: reason`.
fn at(path: &Path, line: Option<usize>, reason: &str) -> Refusal {
    match line {
        Some(line) => format!("{}:{line}: {reason}", path.display()).into(),
        None => Refusal::file(path, reason),
    }
}

/// The line that gives a key of `[frame]` or `[filter]`.
fn line_of_key(text: &str, key: &str) -> Option<usize> {
    let document = toml::de::DeTable::parse(text).ok()?;
    let tables = ["frame", "filter"]
        .into_iter()
        .filter_map(|table| document.get_ref().get(table)?.get_ref().as_table());
    let span =
        tables.filter_map(|table| table.get_key_value(key)).map(|(key, _)| key.span()).next()?;
    Some(text[..span.start].matches('\n').count() + 1)
}
