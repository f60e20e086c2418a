//! Patches: pixels that are swept together.
//!
//! A patch is planned first: its mip level, where its lines run, how they are cut. Pixels that one
//! patch cannot hold well are split in two, at last into single pixels. What is planned is then
//! swept, or only told to who asks for the levels.

use super::bow::mean_bow;
use super::grid::Profile;
use super::kernel::Totals;
use super::pixels::PixelOnLines;
use super::plan::{Extent, Plan, WIDEST, in_whole_groups};
use super::sweep_frame::{SweepFrame, means};
use crate::footprint::levels::{SweepExtent, for_sweep};
use crate::footprint::{Ellipses, Footprints};
use crate::light::{Curved, Gloss, Horizons, LocalLights, SunlitTexels};
use crate::relief::LevelLoss;
use crate::settings::Horizon;
use crate::simd::{PixelLanes, bits_mask};
use crate::texture::{Surface, Texel};
use glam::Vec3;

/// Most pixels of a patch.
pub(super) const MOST_PIXELS: usize = 256;

const _: () = assert!(MOST_PIXELS <= 1 << u8::BITS, "a pick is a byte");

/// Lines across the widest ellipse of a patch for each texel that the settings ask for, unless that
/// puts them farther apart than [`WIDEST`]; and the fewest. Fewer lines than texels serve, since a
/// line's colours are interpolated.
const LINES: [f32; 2] = [0.62, 5.0];

/// The same on the base level, where lines come closer until they are a texel apart: nothing finer
/// is left to pay for. 2.2 dB on the wall at 640x360, 4 on the floor at 1280x720.
const BASE_LINES: f32 = 1.1;

/// Most bins of a patch of several pixels: as many as fit the second cache with their 64 lines.
const MOST_BINS: f32 = 256.0;

/// How much longer the widest ellipse of a patch may be across than the narrowest, squared: the
/// narrowest decides how finely bins cut, the widest how many lines there are.
const MOST_RATIO: f32 = 2.25;

/// Patches of so few pixels are where displacements grow too fast for sweeps to be shared, at the
/// outlines of curved surfaces: one pixel in twelve of a torus, and half of all its rows. They take
/// a level as if they were so much wider, and lone pixels as if they were so much longer: a fifth
/// of the rows for 0.2 dB.
const FEW: usize = 3;
const FEW_WIDER: f32 = 2.0;
const LONE_LONGER: f32 = 3.0;

/// Buffers of sweeps, kept between them.
#[derive(Clone, Debug, Default)]
pub(super) struct PatchScratch {
    pub(super) unlit: Profile<3>,
    pub(super) lit: Profile<6>,
    picked: Vec<PixelLanes>,
    ellipses: Vec<Ellipses>,
    pub(super) pixels: Vec<PixelOnLines>,
    pub(super) totals: Vec<Totals>,
}

/// Pixels that are asked for. A pick is a pixel's vector times 8 plus its lane; picks ascend.
#[derive(Clone, Copy, Debug)]
pub(super) struct Picks<'a> {
    pub(super) picks: &'a [u8],
    /// One for each, where they are lit bin by bin.
    pub(super) lights: &'a [LocalLights],
    /// One for each, where highlights are asked for.
    pub(super) to_eyes: &'a [Vec3],
}

impl Picks<'_> {
    /// Those before a number of them, and the others.
    fn split_at(&self, middle: usize) -> [Self; 2] {
        fn halves<T>(all: &[T], middle: usize) -> [&[T]; 2] {
            all.split_at(if all.is_empty() { 0 } else { middle }).into()
        }
        let (picks, lights) = (halves(self.picks, middle), halves(self.lights, middle));
        let to_eyes = halves(self.to_eyes, middle);
        [0, 1].map(|i| Self { picks: picks[i], lights: lights[i], to_eyes: to_eyes[i] })
    }
}

/// Up to [`MOST_PIXELS`] pixels of one surface that may share sweeps. A pick is a pixel's vector
/// times 8 plus its lane; picks ascend.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patches<'a> {
    pub(super) surface: &'a Surface,
    /// Where a level loses too much of what hides; `None` under lights.
    pub(super) loss: Option<&'a LevelLoss>,
    /// The lights of the pixels and what hides them, where a curved surface is lit.
    pub(super) light: Option<(&'a Curved<'a>, &'a Horizons)>,
    /// What is reflected, where that is asked for.
    pub(super) gloss: Option<&'a Gloss>,
    /// How texels are seen from near under each sun that they are lit by for good.
    pub(super) sunlit: &'a [SunlitTexels],
    /// The pixels, eight a vector.
    pub(super) pixels: &'a [Footprints],
    /// How their displacements bow; empty where none does.
    pub(super) bows: &'a [[PixelLanes; 2]],
    /// Their ellipses in texels of the base level.
    pub(super) base: &'a [Ellipses],
    pub(super) horizon: &'a Horizon,
    /// Bins along the shortest ellipse: how finely the kernel is cut.
    pub(super) num_bins: f32,
    /// Lines across the widest, for each of [`LINES`].
    pub(super) num_lines: f32,
    pub(super) is_lit: bool,
    /// Whether what is swept shows light: sweeps are then a level finer than their footprints ask for.
    pub(super) shows_light: bool,
    /// Whether each pixel is swept by itself.
    pub(super) is_alone: bool,
}

impl<'a> Patches<'a> {
    /// The means of the picked pixels into `found`. With lights they hold diffuse light. Returns the
    /// number of rows swept, sixteen lines each.
    pub(super) fn means(
        &self,
        asked: Picks,
        scratch: &mut PatchScratch,
        found: &mut [Texel],
    ) -> u64 {
        if asked.picks.is_empty() {
            return 0;
        }
        if let Some(plan) = self.plan_together(asked.picks, scratch) {
            return self.sweep(&plan, asked, scratch, found);
        }
        // Halve what does not fit: at the end stand single pixels, which always do.
        let middle = asked.picks.len() / 2;
        let [before, after] = asked.split_at(middle);
        let (near, far) = found.split_at_mut(middle);
        self.means(before, scratch, near) + self.means(after, scratch, far)
    }

    /// The mip levels that [`Self::means`] sweeps the picked pixels on, one after the other.
    pub(super) fn levels(&self, picks: &[u8], scratch: &mut PatchScratch, levels: &mut Vec<usize>) {
        if picks.is_empty() {
            return;
        }
        if let Some(plan) = self.plan_together(picks, scratch) {
            levels.extend(picks.iter().map(|_| plan.level));
            return;
        }
        let (near, far) = picks.split_at(picks.len() / 2);
        self.levels(near, scratch, levels);
        self.levels(far, scratch, levels);
    }

    /// [`Self::plan`], unless several pixels are picked and each is wanted by itself.
    fn plan_together(&self, picks: &[u8], scratch: &mut PatchScratch) -> Option<Plan<'a>> {
        if self.is_alone && picks.len() > 1 { None } else { self.plan(picks, scratch) }
    }

    /// Plans the picked pixels as one patch, whose lines are left in the scratch; `None` where they
    /// do not fit into one.
    fn plan(&self, picks: &[u8], scratch: &mut PatchScratch) -> Option<Plan<'a>> {
        let PatchScratch { picked, ellipses, pixels: on_lines, .. } = scratch;
        // Picks ascend: only these vectors hold any.
        let first_vector = usize::from(picks[0] / 8);
        let vectors = first_vector..=usize::from(picks[picks.len() - 1] / 8);
        let (pixels, base) = (&self.pixels[vectors.clone()], &self.base[vectors.clone()]);
        masks(picks, first_vector, pixels.len(), picked);
        let middle = means(pixels, picked, picks.len());
        let level = self.choose_level(base, picked, picks.len(), middle[1])?;
        // Lay the lines.
        let [texels, base_texels] =
            [level, 0].map(|level| self.surface.levels()[level].texels_per_repeat());
        let [scale, scale_v] = [0, 1].map(|i| texels[i] / base_texels[i]);
        let blur = blur(level);
        // A coarse level's texels blur by themselves, so the ellipses are made narrower by as much.
        ellipses.clear();
        if scale == scale_v {
            ellipses.extend(base.iter().map(|base| base.scaled(scale).sharpened(blur)));
        } else {
            let most = self.horizon.max_anisotropy;
            ellipses.extend(pixels.iter().map(|p| Ellipses::new(p, texels, most).sharpened(blur)));
        }
        // Flat relief may be walked either way: along the longer side, so that fewer lines serve.
        let [a, c] =
            [ellipses[0].a, ellipses[0].c].map(|lanes| lanes.as_array()[usize::from(picks[0] % 8)]);
        let frame = SweepFrame::new(self.surface, level, middle, a < c);
        let bow = mean_bow(self.bows.get(vectors).unwrap_or_default(), picked, picks.len());
        let frame = frame.bowed(bow);
        // A lone pixel's displacement is the frame's own: there is no growth to fit.
        let frame = if picks.len() > 1 { frame.fit(pixels, ellipses, picked)? } else { frame };
        // Put the pixels on them.
        on_lines.clear();
        let mut left = picks;
        for (vector, (pixels, ellipses)) in (first_vector..).zip(pixels.iter().zip(ellipses)) {
            let lanes = frame.pixels_on_lines(pixels, ellipses);
            let num_here = left.iter().take_while(|pick| usize::from(**pick / 8) == vector).count();
            let (here, beyond) = left.split_at(num_here);
            on_lines.extend(here.iter().map(|pick| lanes.lane(usize::from(pick % 8))));
            left = beyond;
        }
        // Refuse what single sweeps would do with less work.
        let extent = Extent::of(on_lines, frame.depth);
        let depth = frame.greatest_depth(extent.xi);
        let num_rows = extent.q[1] * (1.0 + frame.growth.max(0.0)) + depth - extent.q[0];
        let step = extent.half_height * (2.0 / self.num_bins);
        let is_wasteful = num_rows * (extent.xi[1] - extent.xi[0]) > extent.area;
        let is_long = extent.q[1] - extent.q[0] > step * MOST_BINS;
        let is_torn = !frame.goes_one_way(extent.xi, extent.q);
        if picks.len() > 1 && (is_wasteful || is_long || is_torn) {
            return None;
        }
        // Set the lines so close that sixteen lie within two loads where they are farthest apart.
        let most_scale = frame.greatest_scale([extent.q[0] - 1.0, extent.q[0] + num_rows + 1.0])?;
        let num_lines = (LINES[0] * self.num_lines).max(LINES[1]);
        // Lines that are a texel apart see all that there is.
        let num_lines = if level == 0 {
            num_lines.max((2.0 * extent.half_width).min(BASE_LINES * self.num_lines))
        } else {
            num_lines
        };
        let spacing = (WIDEST / most_scale).min(extent.half_width * (2.0 / num_lines));
        let spacing = in_whole_groups(extent.xi[1] - extent.xi[0], spacing, WIDEST / most_scale);
        Some(Plan { level, frame, extent, most_scale, spacing, step })
    }

    /// What so many pixels sweep, as their level is to see it: what few of them sweep is larger for
    /// the price of a coarser one, unless each is wanted by itself.
    fn extent_of(&self, num: usize, [across, along]: [f32; 2], depth: f32) -> SweepExtent {
        let (wider, longer) = match num {
            1 if !self.is_alone => (FEW_WIDER, LONE_LONGER),
            2..=FEW => (FEW_WIDER, 1.0),
            _ => (1.0, 1.0),
        };
        let [along, depth] = [along, depth].map(|length| length * longer);
        SweepExtent { across: across * wider, along, depth, is_lit: self.shows_light }
    }

    /// The level of a patch, by the geometric mean of the widest and the narrowest footprint and by
    /// its mean displacement. `None` where footprints differ too much.
    fn choose_level(
        &self,
        base: &[Ellipses],
        picked: &[PixelLanes],
        num: usize,
        displacement: [f32; 2],
    ) -> Option<usize> {
        let [du, dv] = self.surface.base().in_texels(displacement);
        // Find the narrowest, the widest and the longest ellipse; lanes that are not picked take no
        // part, whatever they hold.
        let far = PixelLanes::splat(f32::MAX);
        let (mut least, mut most, mut long) = (far, PixelLanes::ZERO, PixelLanes::ZERO);
        for (ellipses, picked) in base.iter().zip(picked) {
            least = least.fast_min(picked.select(ellipses.short, far));
            most = most.fast_max(ellipses.short & *picked);
            long = long.fast_max(ellipses.long & *picked);
        }
        let least = least.to_array().into_iter().fold(f32::MAX, f32::min);
        let [most, long] =
            [most, long].map(|lanes| lanes.to_array().into_iter().fold(0.0, f32::max));
        if most > MOST_RATIO * least {
            return None;
        }
        // The axes are squares: a fourth root of their product is the geometric mean.
        let across = 2.0 * (most * least).sqrt().sqrt();
        let extent = self.extent_of(num, [across, 2.0 * long.sqrt()], du.abs().max(dv.abs()));
        let finer_by = |bias: usize| for_sweep(self.surface, &extent, self.horizon.lines << bias);
        let level = finer_by(0);
        // What light makes of a relief differs most between what is seen and what hides: a level that
        // mixes the two shows it. Baked, a floor under a sun at 30 degrees has 41.3 dB without.
        let least_bias = usize::from(self.shows_light);
        let bias = match self.loss {
            // Nothing is finer than the base level.
            Some(loss) if level > 0 => loss.bias(self.surface, [du, dv]).max(least_bias),
            Some(_) => 0,
            None => least_bias,
        };
        Some(if bias == 0 { level } else { finer_by(bias) })
    }
}

/// Four times the variance, in square texels of a level, by which its texels are wider than those
/// of the base level: each is the mean of a square, variance 1/12, and they are interpolated,
/// variance 1/6.
fn blur(level: usize) -> f32 {
    1.0 - 0.25_f32.powi(level as i32)
}

/// All bits of the lanes that are picked, for so many vectors from the first one on.
fn masks(picks: &[u8], first_vector: usize, num_vectors: usize, masks: &mut Vec<PixelLanes>) {
    let mut bits = [0_u8; MOST_PIXELS / 8];
    picks.iter().for_each(|pick| bits[usize::from(pick / 8)] |= 1 << (pick % 8));
    masks.clear();
    masks.extend(bits[first_vector..][..num_vectors].iter().map(|bits| bits_mask(*bits)));
}
