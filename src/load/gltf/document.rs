//! A `.gltf` or `.glb` file and its buffers, in memory.

use super::uri;
use crate::decode::{contain, open_regular};
use crate::error::{Error, Result, one_line};
use crate::load::files::Folder;
use crate::load::options::LoadOptions;
use gltf::binary::Glb;
use gltf::json::{Root, Value, deserialize, serialize};
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Extensions that are read.
const SUPPORTED: [&str; 6] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// A result whose error is a reason, without the name of the file.
pub(super) type Reasoned<T> = std::result::Result<T, String>;

/// What a glTF file says, and the bytes that it points at.
pub(super) struct Document {
    /// The file as the user named it.
    pub(super) path: PathBuf,
    pub(super) root: Root,
    pub(super) buffers: Vec<Vec<u8>>,
    /// Most elements of an accessor.
    pub(super) most_elements: u64,
    pub(super) folder: Folder,
    pub(super) warnings: Vec<String>,
}

impl Document {
    /// Reads a file with its buffers.
    ///
    /// # Errors
    /// Names the file and what is wrong with it, or the limit that refuses it.
    pub(super) fn open(path: &Path, folder: Folder, options: &LoadOptions) -> Result<Self> {
        let most_bytes = most_bytes(options);
        let bytes = read_file(path, path, most_bytes)?;
        Self::from_bytes(bytes, path, folder, options)
    }

    /// [`Self::open`] of a file in memory.
    pub(super) fn from_bytes(
        bytes: Vec<u8>,
        path: &Path,
        folder: Folder,
        options: &LoadOptions,
    ) -> Result<Self> {
        let refuse = |reason: String| Error::file(path, reason);
        let parsed = contain(|| parse(&bytes)).unwrap_or_else(|| Err("cannot be read".into()));
        let (root, binary) = parsed.map_err(refuse)?;
        let mut document = Self {
            path: path.into(),
            root,
            buffers: Vec::new(),
            most_elements: options.max_triangles.saturating_mul(3),
            folder,
            warnings: Vec::new(),
        };
        document.check_extensions().map_err(refuse)?;
        document.read_buffers(binary, options)?;
        Ok(document)
    }

    /// Refuses extensions without which the file makes no sense, and remarks others.
    fn check_extensions(&mut self) -> Reasoned<()> {
        let is_unknown = |name: &&String| !SUPPORTED.contains(&name.as_str());
        if let Some(name) = self.root.extensions_required.iter().find(is_unknown) {
            return Err(format!(
                "needs the extension {}, which is not supported",
                name.escape_debug()
            ));
        }
        let mut unknown: Vec<_> = self.root.extensions_used.iter().filter(is_unknown).collect();
        unknown.sort();
        unknown.dedup();
        let warnings: Vec<_> = unknown
            .iter()
            .map(|name| format!("extension {name} is not supported; drawn without it"))
            .collect();
        warnings.into_iter().for_each(|warning| self.warn(warning));
        Ok(())
    }

    fn read_buffers(&mut self, mut binary: Option<Vec<u8>>, options: &LoadOptions) -> Result<()> {
        let mut left = most_bytes(options);
        for (i, buffer) in self.root.buffers.iter().enumerate() {
            let refuse = |reason: String| Error::file(&self.path, format!("buffer {i} {reason}"));
            let bytes = match &buffer.uri {
                Some(uri) => match uri::data(uri) {
                    Some(bytes) => bytes.map_err(|reason| refuse(reason.into()))?,
                    None => {
                        let name = uri::file_name(uri);
                        let found = self.folder.find(&name, &self.path);
                        let found = found.map_err(|refused| refused.of(&self.path, &name))?;
                        let found = found.ok_or_else(|| refuse(format!("'{name}' is missing")))?;
                        read_file(&found, &self.path.with_file_name(&name), left)?
                    }
                },
                None if i == 0 => {
                    binary.take().ok_or_else(|| refuse("has neither a file nor bytes".into()))?
                }
                None => return Err(refuse("has neither a file nor bytes".into())),
            };
            if (bytes.len() as u64) < buffer.byte_length.0 {
                return Err(refuse(format!(
                    "has {} bytes and should have {}",
                    bytes.len(),
                    buffer.byte_length.0
                )));
            }
            left = left.saturating_sub(bytes.len() as u64);
            self.buffers.push(bytes);
        }
        Ok(())
    }

    /// Keeps a one-line remark about the file.
    pub(super) fn warn(&mut self, text: impl std::fmt::Display) {
        let warning = format!("{}: {text}", self.path.display());
        self.warnings.push(one_line(&warning).into());
    }
}

/// Bytes of all buffers, which geometry and images within the limits do not reach.
fn most_bytes(options: &LoadOptions) -> u64 {
    // Of a triangle: three vertices of 200 bytes, and its indices.
    let geometry = options.max_triangles.saturating_mul(612);
    geometry.saturating_add(u64::from(options.max_image_mib) << 20)
}

/// The bytes of a regular file, which messages call `shown`.
fn read_file(path: &Path, shown: &Path, most: u64) -> Result<Vec<u8>> {
    let file = open_regular(path)?;
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(|e| Error::caused(shown, e))?;
    if bytes.len() as u64 > most {
        let reason = format!("larger than {} MiB", most >> 20);
        return Err(Error::limit(shown, reason, "max_triangles"));
    }
    Ok(bytes)
}

/// The JSON of a file, and the binary part if it has one.
fn parse(bytes: &[u8]) -> Reasoned<(Root, Option<Vec<u8>>)> {
    let (json, binary) = if bytes.starts_with(b"glTF") {
        let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
        if let Some(version) = word(4).filter(|version| *version != 2) {
            return Err(format!("is a GLB of version {version}; only 2 is supported"));
        }
        // The crate takes the header's own 12 bytes from the length of the whole unasked.
        if word(8).is_none_or(|length| length < 12) {
            return Err("is no whole GLB file".into());
        }
        let glb = Glb::from_slice(bytes).map_err(|e| format!("is no whole GLB file: {e}"))?;
        (glb.json.into_owned(), glb.bin.map(|bin| bin.into_owned()))
    } else {
        let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        (bytes[start..].to_vec(), None)
    };
    let root = root(&json)?;
    if !root.asset.version.starts_with("2.") {
        return Err(other_version(&root.asset.version));
    }
    Ok((root, binary))
}

/// What a file's JSON says; without its animations where they alone are of an unknown kind.
fn root(json: &[u8]) -> Reasoned<Root> {
    deserialize::from_slice(json).or_else(|error| {
        let reason = format!("is no valid glTF: {error}");
        let Ok(Value::Object(mut whole)) = deserialize::from_slice(json) else {
            return Err(reason);
        };
        let version = whole.get("asset").and_then(|asset| asset.get("version"));
        // Files of version 1 need not say so, and have objects where version 2 has lists.
        let version = version.map_or(Some("1"), Value::as_str).unwrap_or("2.");
        if !version.starts_with("2.") {
            return Err(other_version(version));
        }
        whole.remove("animations").ok_or(&reason)?;
        let json = serialize::to_vec(&whole).map_err(|_| &reason)?;
        deserialize::from_slice(&json).map_err(|_| reason)
    })
}

fn other_version(version: &str) -> String {
    format!("is glTF {}; only glTF 2 is supported", version.escape_debug())
}
