//! The floating horizon filter: the visible relief of a footprint in one sweep.
//!
//! A texel at `t` and depth `d` is seen over the base coordinate `t - d D`, with the displacement `D` down to the deepest
//! relief. Along a line in the direction of `D`, walked from its near end, the eye sees the part of the relief where the
//! projected place makes a new record, and nothing else. So with the places `p_i` of the line's texels:
//!
//! ```text
//! M = entry of the line into the ellipse of formula (2)
//! for each texel i:  w_i = G(min(p_i, exit)) - G(M) if that is positive;  M = max(M, p_i);  stop when M >= exit
//! ```
//!
//! where `G` is the integral of the kernel `exp(-2 r^2)` along the line, so the weights of a line sum to its share of the
//! ellipse whatever the relief. The segment between two texels is linear: its colour is taken at the middle of its
//! visible part. (The floating horizon: a hidden-surface algorithm for functions of two variables, here run inside a
//! texture footprint; the weight is exact where the classic algorithm draws lines.)
//!
//! Neighbouring pixels see the same texels, so a *patch* of them is swept once (`sweep`): rows across the longer axis of
//! the displacement, on a transposed copy of the texels where that is u, and sixteen lines as lanes. What a line sees is
//! kept bin by bin, and each pixel weighs the bins by its own Gaussian (`kernel`). Where a patch lies and how its
//! lines run says `frame`; pixels that no patch can hold well are split into smaller ones, at last into single pixels.

mod frame;
mod kernel;
mod pixels;
mod sweep;
mod walk;

pub use pixels::PixelFootprints;

use super::{FarField, Filtered, Footprint, isotropic};
use crate::settings::Settings;
use crate::shade::LocalLights;
use crate::simd::PixelLanes;
use crate::texture::Surface;
use frame::{Frame, means};
use kernel::{Kernel, Totals};
use pixels::Conics;
use sweep::{Grid, MOST_LINES, Profile};

/// Most rows of a pixel's sweep; a longer one takes a coarser level. Bounds the time of a pixel for any input.
pub const MAX_ROWS: f32 = 1024.0;

/// Most pixels of a patch.
pub const MOST_PIXELS: usize = 256;

/// Lines across the widest ellipse of a patch for each that the settings ask for, unless that puts them farther apart than
/// [`WIDEST`]; and the fewest. Fewer than texels serve, since a line's colours are interpolated.
const LINES: [f32; 2] = [0.65, 5.0];

/// Greatest distance between lines in texels: sixteen lines and their neighbours lie within 32 texels.
const WIDEST: f32 = 1.99;

/// Most bins of a patch of several pixels.
const MOST_BINS: f32 = 256.0;

/// How much longer the widest ellipse of a patch may be across than the narrowest, squared.
const MOST_RATIO: f32 = 2.25;

/// Bins along the ellipse where a single pixel is asked for.
const PIXEL_BINS: f32 = 256.0;

/// Bins along the shortest ellipse of a patch that serve a picture. Lights are asked for each bin, so they need more.
#[must_use]
pub fn picture_bins(settings: &Settings, is_lit: bool) -> f32 {
    (settings.lines as f32 * if is_lit { 1.6 } else { 0.5 }).max(5.0)
}

/// Buffers of sweeps, kept between them.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    unlit: Profile<3>,
    lit: Profile<6>,
    picked: Vec<PixelLanes>,
    conics: Vec<Conics>,
    kernels: Vec<Kernel>,
    totals: Vec<Totals>,
}

/// The mean of the visible texels of a footprint whose centre is the base coordinate, and the number of rows swept. `lights` are asked per visible texel.
#[must_use]
pub fn visible_mean(
    surface: &Surface,
    footprint: &Footprint,
    displacement: [f32; 2],
    settings: &Settings,
    lights: Option<&LocalLights>,
) -> (Filtered, u64) {
    let pixels = [PixelFootprints::splat(footprint, displacement)];
    let lights = lights.map(std::slice::from_ref).unwrap_or_default();
    let mut found = [Filtered::default()];
    let patches = Patches { surface, far: None, pixels: &pixels, settings, num_bins: PIXEL_BINS };
    let num_rows = patches.means(&[0], lights, &mut Scratch::default(), &mut found);
    (found[0], num_rows)
}

/// Up to [`MOST_PIXELS`] pixels of one surface that may share sweeps.
#[derive(Clone, Copy, Debug)]
pub struct Patches<'a> {
    /// Their texture.
    pub surface: &'a Surface,
    /// Tables that know where a level loses too much of what hides.
    pub far: Option<&'a FarField>,
    /// The pixels, eight a vector.
    pub pixels: &'a [PixelFootprints],
    /// Lines and anisotropy.
    pub settings: &'a Settings,
    /// Bins along the shortest ellipse: how finely the kernel is cut; see [`picture_bins`].
    pub num_bins: f32,
}

/// The extent of a patch: least and greatest `xi` and `q` of its ellipses, the greatest width and the least height.
#[derive(Clone, Copy, Debug)]
struct Extent {
    xi: [f32; 2],
    q: [f32; 2],
    half_width: f32,
    half_height: f32,
    /// Rows times lines of all pixels, each swept on its own.
    area: f32,
}

impl Patches<'_> {
    /// The means of the picked pixels (vector times 8 plus lane, ascending), into `found`. With `lights`, one a pick,
    /// they hold diffuse light. Returns the number of rows swept, sixteen lines each.
    pub fn means(&self, picks: &[u8], lights: &[LocalLights], scratch: &mut Scratch, found: &mut [Filtered]) -> u64 {
        if picks.is_empty() {
            return 0;
        }
        if let Some(num_rows) = self.patch(picks, lights, scratch, found) {
            return num_rows;
        }
        let middle = picks.len() / 2;
        let (near_lights, far_lights) = lights.split_at(if lights.is_empty() { 0 } else { middle });
        let (near, far) = found.split_at_mut(middle);
        self.means(&picks[..middle], near_lights, scratch, near)
            + self.means(&picks[middle..], far_lights, scratch, far)
    }

    /// The mip level that a picked pixel (vector times 8 plus lane) is swept on if it is swept by itself.
    #[must_use]
    pub fn level(&self, pick: u8, is_lit: bool) -> usize {
        let vector = usize::from(pick / 8);
        let mut picked = Vec::new();
        masks(&[pick], vector, 1, &mut picked);
        // One footprint is not larger than itself.
        self.choose_level(&self.pixels[vector..=vector], &picked, 1, is_lit).map_or(0, |(level, _)| level)
    }

    /// Sweeps the picked pixels as one patch; `None` where they do not fit into one.
    fn patch(
        &self,
        picks: &[u8],
        lights: &[LocalLights],
        scratch: &mut Scratch,
        found: &mut [Filtered],
    ) -> Option<u64> {
        let Scratch { unlit, lit, picked, conics, kernels, totals } = scratch;
        // Picks ascend: only these vectors hold any.
        let first_vector = usize::from(picks[0] / 8);
        let pixels = &self.pixels[first_vector..=usize::from(picks[picks.len() - 1] / 8)];
        masks(picks, first_vector, pixels.len(), picked);
        let picked = picked.as_slice();
        let (index, middle) = self.choose_level(pixels, picked, picks.len(), !lights.is_empty())?;
        let texels = self.surface.texels_per_repeat(index);
        conics.clear();
        let blur = blur(index);
        let conics_of = |pixels: &PixelFootprints| pixels.conics(texels, self.settings.max_anisotropy).sharpened(blur);
        conics.extend(pixels.iter().map(conics_of));
        let [a, c] = [conics[0].a, conics[0].c].map(|lanes| lanes.as_array()[usize::from(picks[0] % 8)]);
        let frame = Frame::new(self.surface, index, middle, a < c);
        let frame = if picks.len() > 1 { frame.fit(pixels, conics, picked)? } else { frame };
        kernels.clear();
        let mut left = picks;
        for (vector, (pixels, conics)) in (first_vector..).zip(pixels.iter().zip(conics)) {
            let lanes = frame.kernels(pixels, conics);
            let num_here = left.iter().take_while(|pick| usize::from(**pick / 8) == vector).count();
            let (here, beyond) = left.split_at(num_here);
            kernels.extend(here.iter().map(|pick| lanes.lane(usize::from(pick % 8))));
            left = beyond;
        }
        let extent = Extent::of(kernels, frame.depth);
        let depth = frame.greatest_depth(extent.xi);
        let num_rows = extent.q[1] * (1.0 + frame.growth.max(0.0)) + depth - extent.q[0];
        let step = extent.half_height * (2.0 / self.num_bins);
        let is_wasteful = num_rows * (extent.xi[1] - extent.xi[0]) > extent.area;
        if picks.len() > 1 && (is_wasteful || extent.q[1] - extent.q[0] > step * MOST_BINS) {
            return None;
        }
        let scale = frame.greatest_scale([extent.q[0] - 1.0, extent.q[0] + num_rows + 1.0])?;
        totals.clear();
        totals.resize(picks.len(), Totals::default());
        let num_lines = (LINES[0] * self.settings.lines as f32).max(LINES[1]);
        let spacing = (WIDEST / scale).min(extent.half_width * (2.0 / num_lines));
        let layout = Layout { frame: &frame, most_scale: scale, extent: &extent, spacing, step };
        let num_rows = if lights.is_empty() {
            layout.run(unlit, kernels, &[], totals)
        } else {
            layout.run(lit, kernels, lights, totals)
        };
        for ((found, totals), pick) in found.iter_mut().zip(totals).zip(picks) {
            // Number by number, so that whoever reads one does not wait for all.
            let mean = totals.mean(!lights.is_empty()).unwrap_or_else(|| {
                let pixels = &self.pixels[usize::from(pick / 8)];
                isotropic::bilinear(self.surface, index, pixels.footprint(usize::from(pick % 8)).center)
            });
            (found.color, found.normal) = (mean.color, mean.normal);
        }
        Some(num_rows)
    }

    /// The finest level on which the footprints, by the geometric mean of the widest and the narrowest, are at most so many
    /// texels across as `settings.lines` asks for, and their sweeps short enough; and the means of places and
    /// displacements. `None` where footprints differ too much.
    fn choose_level(
        &self,
        pixels: &[PixelFootprints],
        picked: &[PixelLanes],
        num: usize,
        is_lit: bool,
    ) -> Option<(usize, [[f32; 2]; 2])> {
        let surface = self.surface;
        let base = surface.texels_per_repeat(0);
        let means = means(pixels, picked, num);
        let [du, dv] = [means[1][0] * base[0], means[1][1] * base[1]];
        let (mut least, mut most, mut long) = (f32::MAX, 0.0_f32, 0.0_f32);
        for (pixels, picked) in pixels.iter().zip(picked) {
            let conics = pixels.conics(base, self.settings.max_anisotropy);
            let greatest = |lanes: PixelLanes| (lanes & *picked).to_array().into_iter().fold(0.0, f32::max);
            let far = PixelLanes::splat(f32::MAX) & !*picked;
            least = least.min((conics.short & *picked).fast_max(far).to_array().into_iter().fold(f32::MAX, f32::min));
            (most, long) = (most.max(greatest(conics.short)), long.max(greatest(conics.long)));
        }
        if most > MOST_RATIO * least {
            return None;
        }
        // Under lights no table helps where a level loses what hides behind fine ridges: take one level finer instead.
        let bias = if is_lit { 1 } else { self.far.map_or(0, |far| far.level_bias([du, dv])) };
        let (across, walk) = (2.0 * (most * least).sqrt().sqrt(), du.abs().max(dv.abs()));
        let widest = (self.settings.lines << bias) as f32;
        let fits = |level: &usize| {
            let texels = surface.texels_per_repeat(*level);
            let scale = (texels[0] / base[0]).max(texels[1] / base[1]);
            across * scale <= widest && (2.0 * long.sqrt() + walk) * scale <= MAX_ROWS
        };
        let last = surface.levels.len() - 1;
        Some(((0..last).find(fits).unwrap_or(last), means))
    }
}

/// Four times the variance, in square texels of a level, by which its texels are wider than those of the base level: each is
/// the mean of a square, variance 1/12, and they are interpolated, variance 1/6.
fn blur(level: usize) -> f32 {
    1.0 - 0.25_f32.powi(level as i32)
}

/// All bits of the lanes that are picked, for so many vectors from the first one on.
fn masks(picks: &[u8], first_vector: usize, num_vectors: usize, masks: &mut Vec<PixelLanes>) {
    masks.clear();
    let mut picks = picks.iter().map(|pick| usize::from(*pick)).peekable();
    masks.extend((first_vector..first_vector + num_vectors).map(|vector| {
        let mut bits = [0; 8];
        while let Some(pick) = picks.next_if(|pick| pick / 8 == vector) {
            bits[pick % 8] = u32::MAX;
        }
        PixelLanes::new(bits.map(f32::from_bits))
    }));
}

impl Extent {
    fn of(kernels: &[Kernel], depth: f32) -> Self {
        let mut extent = Self {
            xi: [f32::MAX, f32::MIN],
            q: [f32::MAX, f32::MIN],
            half_width: 0.0,
            half_height: f32::MAX,
            area: 0.0,
        };
        for kernel in kernels {
            let Kernel { xi, q, half_width, half_height, .. } = *kernel;
            extent.xi = [extent.xi[0].min(xi - half_width), extent.xi[1].max(xi + half_width)];
            extent.q = [extent.q[0].min(q - half_height), extent.q[1].max(q + half_height)];
            extent.half_width = extent.half_width.max(half_width);
            extent.half_height = extent.half_height.min(half_height);
            extent.area += 2.0 * half_width * (2.0 * half_height + depth);
        }
        extent
    }
}

/// How a patch is cut into grids of lines and rows.
struct Layout<'a> {
    frame: &'a Frame<'a>,
    most_scale: f32,
    extent: &'a Extent,
    spacing: f32,
    step: f32,
}

impl Layout<'_> {
    /// Sweeps all lines and adds what they see to the pixels. Returns the number of rows.
    fn run<const CHANNELS: usize>(
        &self,
        profile: &mut Profile<CHANNELS>,
        kernels: &[Kernel],
        lights: &[LocalLights],
        totals: &mut [Totals],
    ) -> u64 {
        let Extent { xi, q, .. } = *self.extent;
        let spacing = self.spacing;
        let num_lines = 2 * ((xi[1] - xi[0]) * (0.5 / spacing)).ceil() as usize;
        let first = (xi[0] + xi[1]) * 0.5 - spacing * (num_lines as f32 * 0.5 - 0.5);
        let num_bins = ((q[1] - q[0]) / self.step).ceil().max(1.0) as usize;
        let mut num_rows = 0;
        for line in (0..num_lines).step_by(MOST_LINES) {
            let grid = Grid {
                frame: self.frame,
                most_scale: self.most_scale,
                first: first + line as f32 * spacing,
                spacing,
                num_lines: (num_lines - line).min(MOST_LINES),
                begin: q[0],
                step: self.step,
                num_bins,
            };
            for (group, range) in grid.ranges(kernels).into_iter().enumerate() {
                if range[0] < range[1] {
                    num_rows += profile.sweep(&grid, group, range);
                }
            }
            for (i, (kernel, totals)) in kernels.iter().zip(totals.iter_mut()).enumerate() {
                totals.add(profile, &grid, kernel, lights.get(i));
            }
        }
        num_rows
    }
}
