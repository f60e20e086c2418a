//! MTL files, through tobj, to materials whose texture lines are taken apart.

mod lines;
mod texture_line;

use super::files::Folder;
use super::lines::{CleanLines, Place};
use crate::decode::{contain, open_regular};
use crate::error::{Error, Result};
use lines::{LineNumbers, MtlLines};
use std::collections::HashSet;
use std::io::{BufRead, BufReader, Read as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use texture_line::TextureLine;

/// Largest MTL file that is read in bytes, and most materials: real ones have a few hundred
/// kilobytes.
const MAX_MTL_BYTES: u64 = 16 << 20;
const MAX_MATERIALS: usize = 65536;

/// A texture that a material names, and where.
#[derive(Clone, Debug)]
pub(super) struct TextureRef {
    pub(super) texture: TextureLine,
    /// The keyword, such as `map_Kd`.
    pub(super) keyword: &'static str,
    pub(super) path: Arc<Path>,
    pub(super) line: usize,
}

impl TextureRef {
    pub(super) fn place(&self) -> Place<'_> {
        Place { path: &self.path, line: self.line }
    }
}

/// A material as its file has it.
#[derive(Clone, Debug, Default)]
pub(super) struct MtlMaterial {
    pub(super) name: String,
    pub(super) diffuse: Option<[f32; 3]>,
    pub(super) specular: Option<[f32; 3]>,
    pub(super) shininess: Option<f32>,
    /// `Pm`.
    pub(super) metallic: Option<f32>,
    /// `Pr`.
    pub(super) roughness: Option<f32>,
    /// `Ke`.
    pub(super) emissive: Option<[f32; 3]>,
    /// `d`: 1 is opaque.
    pub(super) opacity: Option<f32>,
    /// `map_d`.
    pub(super) opacity_map: Option<TextureRef>,
    /// `map_Kd`.
    pub(super) albedo: Option<TextureRef>,
    /// `disp`, `map_disp`.
    pub(super) height: Option<TextureRef>,
    /// `bump`, `map_bump`: a height map when the image is gray.
    pub(super) bump: Option<TextureRef>,
    /// `norm`, `map_Kn`.
    pub(super) normal: Option<TextureRef>,
    /// `map_Pm`, of metal.
    pub(super) metallic_map: Option<TextureRef>,
    /// `map_Pr`, of roughness.
    pub(super) roughness_map: Option<TextureRef>,
    /// `map_Ke`, of emission.
    pub(super) emissive_map: Option<TextureRef>,
}

/// All MTL files that an OBJ names.
pub(super) struct MtlFiles {
    obj: PathBuf,
    /// The line of the OBJ that was read last and names MTL files.
    pub(super) line: usize,
    folder: Folder,
    pub(super) materials: Vec<MtlMaterial>,
    pub(super) warnings: Vec<String>,
    pub(super) failure: Option<Error>,
    known: HashSet<String>,
    files: HashSet<PathBuf>,
}

impl MtlFiles {
    /// No materials yet, for the OBJ file `obj`.
    pub(super) fn new(obj: &Path, folder: &Folder) -> Self {
        let (materials, warnings) = (Vec::new(), Vec::new());
        let (obj, folder) = (obj.into(), folder.clone());
        Self {
            obj,
            line: 0,
            folder,
            materials,
            warnings,
            failure: None,
            known: HashSet::new(),
            files: HashSet::new(),
        }
    }

    /// Reads what an `mtllib` line names: one file with spaces in its name, or several. Failures
    /// are kept. tobj counts the materials that it is handed and finds them by name; what is in
    /// them it need not know.
    pub(super) fn read(&mut self, names: &Path) -> tobj::MTLLoadResult {
        let before = self.materials.len();
        let files = self.find(&names.to_string_lossy().replace('\\', "/"));
        if let Err(failure) =
            files.and_then(|files| files.iter().try_for_each(|file| self.read_file(file)))
        {
            self.failure.get_or_insert(failure);
            self.materials.truncate(before);
        }
        let names = self.materials[before..].iter().map(|material| material.name.clone());
        Ok((vec![tobj::Material::default(); names.len()], names.zip(0..).collect()))
    }

    /// The files behind the names, each as it is to be shown; those read before are left out.
    fn find(&mut self, names: &str) -> Result<Vec<PathBuf>> {
        let names = names.trim_matches('"');
        let resolve =
            |name: &str| self.folder.resolve(name, Place { path: &self.obj, line: self.line });
        if let Some(path) = resolve(names)? {
            return Ok(self
                .files
                .insert(path)
                .then(|| self.obj.with_file_name(names))
                .into_iter()
                .collect());
        }
        let mut found = Vec::new();
        for name in names.split_whitespace() {
            match resolve(name)? {
                Some(path) => {
                    found.extend(self.files.insert(path).then(|| self.obj.with_file_name(name)));
                }
                None if self.files.insert(name.into()) => {
                    let path = self.obj.with_file_name(name);
                    self.warnings
                        .push(format!("{}: no such file; plain colours are drawn", path.display()));
                }
                None => {}
            }
        }
        Ok(found)
    }

    fn read_file(&mut self, path: &Path) -> Result<()> {
        let file = open_regular(path)?;
        if file.metadata().is_ok_and(|data| data.len() > MAX_MTL_BYTES) {
            return Err(Error::file(
                path,
                format!("more than {} MiB are no material file", MAX_MTL_BYTES >> 20),
            ));
        }
        self.read_text(BufReader::new(file.take(MAX_MTL_BYTES)), path)
    }

    /// Reads the text of one MTL file.
    pub(super) fn read_text(&mut self, text: impl BufRead, path: &Path) -> Result<()> {
        let cleaner = MtlLines::default();
        let mut lines = CleanLines::new(text, path, cleaner);
        let read = contain(|| tobj::load_mtl_buf(&mut lines));
        if let Some(failure) = lines.failure.take() {
            return Err(failure);
        }
        let materials = match read {
            Some(Ok((materials, _))) => materials,
            Some(Err(error)) => return Err(lines.place().refuse(error)),
            None => return Err(lines.place().refuse("cannot be read")),
        };
        if self.materials.len() + materials.len() > MAX_MATERIALS {
            return Err(Error::file(path, format!("more than {MAX_MATERIALS} materials")));
        }
        self.warnings.append(&mut lines.cleaner.warnings);
        let shown: Arc<Path> = path.into();
        for (material, lines) in materials.iter().zip(&lines.cleaner.lines) {
            let material = self.take_apart(material, lines, &shown)?;
            self.known.insert(material.name.clone());
            self.materials.push(material);
        }
        Ok(())
    }

    fn take_apart(
        &mut self,
        from: &tobj::Material,
        lines: &LineNumbers,
        path: &Arc<Path>,
    ) -> Result<MtlMaterial> {
        let unknown = |key: &str| from.unknown_param.get(key);
        let number = |key: &str| unknown(key).and_then(|number| number.parse().ok());
        let mut texture = |keyword: &'static str, text: Option<&String>| {
            text.map(|text| {
                let line = lines.get(keyword).copied().unwrap_or_default();
                self.texture(keyword, text, Place { path, line }, path)
            })
            .transpose()
        };
        Ok(MtlMaterial {
            name: from.name.clone(),
            diffuse: from.diffuse,
            specular: from.specular,
            shininess: from.shininess,
            metallic: number("Pm"),
            roughness: number("Pr"),
            emissive: from.emissive,
            opacity: from.dissolve,
            opacity_map: texture("map_d", from.dissolve_texture.as_ref())?,
            albedo: texture("map_Kd", from.diffuse_texture.as_ref())?,
            height: texture("disp", unknown("disp"))?,
            bump: texture("map_Bump", from.normal_texture.as_ref())?,
            normal: texture("norm", unknown("norm"))?,
            metallic_map: texture("map_Pm", unknown("map_Pm"))?,
            roughness_map: texture("map_Pr", unknown("map_Pr"))?,
            emissive_map: texture("map_Ke", unknown("map_Ke"))?,
        })
    }

    fn texture(
        &mut self,
        keyword: &'static str,
        text: &str,
        at: Place<'_>,
        path: &Arc<Path>,
    ) -> Result<TextureRef> {
        let mut texture = TextureLine::parse(text).map_err(|reason| at.refuse(reason))?;
        let is_gray = ["disp", "map_Bump", "map_Pm", "map_Pr"].contains(&keyword);
        if !is_gray && texture.range != [0.0, 1.0] {
            texture.unsupported.push("-mm".into());
        }
        for option in &texture.unsupported {
            self.warnings
                .push(at.remark(format_args!("option {option} of {keyword} is not supported")));
        }
        Ok(TextureRef { texture, keyword, path: Arc::clone(path), line: at.line })
    }

    /// Warns, once a name, of a `usemtl` before any file has defined its material.
    pub(super) fn remark_unknown(&mut self, name: &str, at: Place<'_>) {
        let is_known = self.known.contains(name);
        if !is_known && !self.materials.is_empty() && self.known.insert(name.into()) {
            self.warnings.push(at.remark(format_args!(
                "material '{name}' is not defined before; plain colour is drawn"
            )));
        }
    }
}
