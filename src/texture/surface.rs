//! The texels of a material: colour, height and normals of one size, packed, with every mip level.

use super::level::{FULL, FULL_F32, Level, Texel, pack_normal, unpack_normal};
use super::rows::PackedTexel;
use super::wrap::Wrap;
use super::{ColorImage, HeightImage, NormalImage, pyramid, resample};
use crate::error::{Error, Result};
use rayon::prelude::*;

/// What a [`Surface`] is made from. Maps may differ in size; all are brought to the largest width
/// and height.
#[derive(Clone, Debug)]
pub struct SurfaceMaps {
    /// Colour; `None` is white.
    pub albedo: Option<ColorImage>,
    /// Height; `None` is flat.
    pub height: Option<HeightImage>,
    /// Normals for lighting; `None` takes them from the heights.
    pub normal: Option<NormalImage>,
    /// What lies beyond the edges. Default: repeat.
    pub wrap: Wrap,
    /// Depth of the deepest relief below the polygon in texture repeats, 0 to 1. Default: 0.05.
    pub relief_depth: f32,
    /// Whether normals are kept: needed for lighting, half as much memory again. Default: `true`.
    pub keep_normals: bool,
    /// Least texels along u and v: those of a [`Texture`](super::Texture) that light is to be baked
    /// with, texel by texel. Default: 1, 1.
    pub least_size: [u32; 2],
}

impl Default for SurfaceMaps {
    fn default() -> Self {
        Self {
            albedo: None,
            height: None,
            normal: None,
            wrap: Wrap::Repeat,
            relief_depth: 0.05,
            keep_normals: true,
            least_size: [1; 2],
        }
    }
}

/// The texels of a material: packed, with every mip level.
#[derive(Clone, Debug)]
pub struct Surface {
    levels: Vec<Level>,
    wrap: Wrap,
    relief_depth: f32,
    color_scale: f32,
}

/// What becomes of normals where colours change.
#[derive(Clone, Copy)]
pub(crate) enum Normals<'a> {
    /// There are none any more.
    Dropped,
    /// They stay.
    Kept,
    /// They get a length, 0 to 1, by the column and row of a texel.
    Scaled(&'a (dyn Fn(usize, usize) -> f32 + Sync)),
}

impl Surface {
    /// Packs the maps and builds the pyramid.
    ///
    /// # Errors
    /// Names a map whose size is zero, above 32768, or not that of its texels, or a depth out of
    /// range.
    pub fn new(maps: SurfaceMaps) -> Result<Self> {
        let [width, height] = common_size(&maps)?;
        let is_flat = maps.height.is_none() || maps.relief_depth == 0.0;
        let has_normals = maps.keep_normals && (maps.normal.is_some() || !is_flat);
        let SurfaceMaps { albedo, height: heights, normal, wrap, relief_depth, .. } = maps;
        let color_scale = albedo.as_ref().map_or(1.0, |image| image.scale);
        let mut texels =
            vec![[FULL | FULL << 16, FULL | FULL << 16, 0] as PackedTexel; width * height];
        if let Some(image) = albedo {
            resample::fill(&mut texels, [width, height], wrap, &image, |texel, color| {
                let [r, g, b] = color.map(stored);
                *texel = [r | g << 16, b | texel[1] & 0xffff_0000, texel[2]];
            });
        }
        if let Some(image) = heights.filter(|_| !is_flat) {
            resample::fill(&mut texels, [width, height], wrap, &image, |texel, [h, ..]| {
                texel[1] = texel[1] & 0xffff | stored(h) << 16;
            });
        }
        if let Some(image) = normal.filter(|_| has_normals) {
            resample::fill(&mut texels, [width, height], wrap, &image, |texel, n| {
                texel[2] = pack_normal(n.map(|c| (c as f32 - 32767.0) / 32767.0));
            });
        } else if has_normals {
            pyramid::normals_from_heights(&mut texels, [width, height], wrap, relief_depth);
        }
        let is_mirrored = wrap == Wrap::Mirror;
        let (texels, size) = if is_mirrored {
            pyramid::mirrored(texels, width, height)
        } else {
            (texels, [width, height])
        };
        let num_planes = if has_normals { 3 } else { 2 };
        Ok(Self {
            levels: pyramid::build(texels, size, wrap, num_planes),
            wrap,
            relief_depth: if is_flat { 0.0 } else { relief_depth },
            color_scale,
        })
    }

    /// The surface with one colour a mip level, to see in a frame which levels are read: every
    /// texel of level `i` in `colors[i]`, and of levels beyond the last colour in that one. Heights
    /// and normals stay. Colours are linear RGB from 0 to [`Self::color_scale`]; others are
    /// clamped.
    ///
    /// Every filter reads the levels that it reads of the surface itself; only the tables of
    /// [`Filter::Horizon`](crate::Filter::Horizon) may be made from another one.
    pub fn with_level_colors(&self, colors: &[[f32; 3]]) -> Self {
        let packed = |c: f32| (c / self.color_scale * FULL_F32 + 0.5).clamp(0.0, FULL_F32) as u32;
        let levels = self.levels.iter().enumerate().map(|(i, level)| {
            match colors.get(i).or(colors.last()) {
                Some(color) => level.in_color(color.map(packed)),
                None => level.clone(),
            }
        });
        Self { levels: levels.collect(), ..*self }
    }

    /// The surface with other colours on its base level, and their means on the levels above:
    /// `color` gives the linear RGB, 0 or more, of the texel at a column and row from what it was.
    /// Heights stay.
    pub(crate) fn with_colors(
        &self,
        normals: Normals,
        color: impl Fn(usize, usize, [f32; 3]) -> [f32; 3] + Sync,
    ) -> Self {
        let [width, height] = self.base().size();
        let rows = self.base().rows(false);
        let to_linear = self.color_scale / FULL_F32;
        let mut colors = vec![[0.0_f32; 3]; width * height];
        let brightest = colors.par_chunks_exact_mut(width).enumerate().map(|(y, colors)| {
            let texels = rows.texels(y);
            colors.iter_mut().zip(texels).enumerate().fold(0.0_f32, |most, (x, (to, [a, b, _]))| {
                let stored = [a & 0xffff, a >> 16, b & 0xffff];
                *to = color(x, y, stored.map(|c| c as f32 * to_linear));
                to.iter().fold(most, |most, c| most.max(*c))
            })
        });
        // Scaled to the brightest, so that a bright sun keeps its bits; a maximum is the same in
        // any order.
        let color_scale = brightest.reduce(|| 0.0, f32::max).max(f32::MIN_POSITIVE);
        let to_stored = FULL_F32 / color_scale;
        let num_planes = match normals {
            Normals::Scaled(_) => 3,
            Normals::Kept if self.has_normals() => 3,
            _ => 2,
        };
        let to_stored_normal = |word: u32, x: usize, y: usize| match normals {
            Normals::Kept if num_planes == 3 => word,
            Normals::Scaled(length) => {
                let normal = if self.has_normals() { unpack_normal(word) } else { Texel::UP };
                pack_normal(normal.map(|c| c * length(x, y)))
            }
            _ => 0,
        };
        let mut texels = vec![PackedTexel::default(); width * height];
        texels.par_chunks_exact_mut(width).enumerate().for_each(|(y, texels)| {
            let old = rows.texels(y).zip(&colors[y * width..]);
            for (x, (texel, ([_, b, normal], color))) in texels.iter_mut().zip(old).enumerate() {
                let [red, green, blue] = color.map(|c| ((c * to_stored + 0.5) as u32).min(FULL));
                let normal = to_stored_normal(normal, x, y);
                *texel = [red | green << 16, blue | b & 0xffff_0000, normal];
            }
        });
        // A mirrored pattern is stored with its mirror images, each lit as it lies.
        let levels = pyramid::build(texels, [width, height], self.wrap, num_planes);
        Self { levels, color_scale, ..*self }
    }

    /// Mip levels, the finest first; the last holds one texel.
    #[inline(always)]
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// The finest level.
    #[inline(always)]
    pub fn base(&self) -> &Level {
        &self.levels[0]
    }

    /// The number of the coarsest level.
    #[inline(always)]
    pub(crate) fn last_level(&self) -> usize {
        self.levels.len() - 1
    }

    /// What lies beyond the edges.
    pub fn wrap(&self) -> Wrap {
        self.wrap
    }

    /// Depth of the deepest relief below the polygon in texture repeats, 0 to 1; 0 where the
    /// surface is flat.
    pub fn relief_depth(&self) -> f32 {
        self.relief_depth
    }

    /// Mean depth of the relief, 0 to 1 of [`Self::relief_depth`].
    pub(crate) fn mean_depth(&self) -> f32 {
        1.0 - self.levels[self.last_level()].height_at(0, 0)
    }

    /// The brightest colour that a texel can hold; stored as [`FULL`].
    pub fn color_scale(&self) -> f32 {
        self.color_scale
    }

    /// Whether texels have normals of their own; without, the surface is flat to light.
    pub fn has_normals(&self) -> bool {
        self.levels[0].has_normals()
    }

    /// Bytes that the texels take.
    pub fn num_bytes(&self) -> usize {
        self.levels.iter().map(Level::num_bytes).sum()
    }
}

/// A number from 0 to 65535 as it is packed.
fn stored(c: u32) -> u32 {
    (c * FULL + 32767) / 65535
}

fn common_size(maps: &SurfaceMaps) -> Result<[usize; 2]> {
    let refuse = |reason: String| Err(Error::scene("surface", reason));
    if !(0.0..=1.0).contains(&maps.relief_depth) {
        return refuse(format!("relief depth {} is not within 0 to 1", maps.relief_depth));
    }
    if maps.albedo.as_ref().is_some_and(|image| !(image.scale > 0.0 && image.scale <= 1e6)) {
        return refuse("the albedo's scale must be above 0 and at most 1e6".into());
    }
    let sizes = [
        maps.albedo.as_ref().map(|m| ("albedo", m.width, m.height, m.texels.len())),
        maps.height.as_ref().map(|m| ("height", m.width, m.height, m.texels.len())),
        maps.normal.as_ref().map(|m| ("normal", m.width, m.height, m.texels.len())),
    ];
    if !maps.least_size.iter().all(|n| (1..=32768).contains(n)) {
        return refuse("its least size must be within 1 to 32768".into());
    }
    let mut common = maps.least_size.map(|n| n as usize);
    for (name, width, height, num_texels) in sizes.into_iter().flatten() {
        let (w, h) = (width as usize, height as usize);
        if !(1..=32768).contains(&w) || !(1..=32768).contains(&h) || w * h != num_texels {
            return refuse(format!("the {name} map says {w} x {h} texels and has {num_texels}"));
        }
        common = [common[0].max(w), common[1].max(h)];
    }
    Ok(common)
}
