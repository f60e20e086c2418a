//! The floating horizon filter: the visible relief of a footprint in one sweep.
//!
//! A texel at `t` and depth `d` is seen over the base coordinate `t - d D`, with the displacement
//! `D` down to the deepest relief. Along a line in the direction of `D`, walked from its near end,
//! the eye sees the part of the relief where the projected place makes a new record, and nothing
//! else. So with the places `p_i` of the line's texels:
//!
//! ```text
//! M = entry of the line into the ellipse of formula (2)
//! for each texel i:  w_i = G(min(p_i, exit)) - G(M) if that is positive;  M = max(M, p_i);  stop when M >= exit
//! ```
//!
//! where `G` is the integral of the kernel `exp(-2 r^2)` along the line, so the weights of a line
//! sum to its share of the ellipse whatever the relief. The segment between two texels is linear:
//! its colour is taken at the middle of its visible part. (The floating horizon: a hidden-surface
//! algorithm for functions of two variables, here run inside a texture footprint; the weight is
//! exact where the classic algorithm draws lines.)
//!
//! Neighbouring pixels see the same texels, so a *patch* of them is swept once (`sweep`): rows
//! across the longer axis of the displacement, on a transposed copy of the texels where that is u,
//! and sixteen lines as lanes. What a line sees is kept bin by bin (`walk`), and each pixel weighs
//! the bins by its own Gaussian (`kernel`). `patch` plans which pixels are swept together,
//! `sweep_frame` how their lines run. What is far comes from tables (`far_field`).

mod bow;
mod fit;
mod glossy;
mod grid;
mod kernel;
mod lines;
mod lit;
mod near_light;
mod patch;
mod pixels;
mod place;
mod plan;
mod shine;
mod show;
mod sunlit;
mod sweep;
mod sweep_frame;
mod swept;
mod walk;

pub(crate) use place::lit_at;

use super::batch::{Batch, Filtered, LevelChoice, Work};
use super::far_field::FarField;
use super::prepared::Prepared;
use crate::footprint::{Ellipses, Footprints};
use crate::light::Gloss;
use crate::settings::Horizon;
use crate::simd::PixelLanes;
use crate::texture::{Surface, Texel};
use glam::Vec3;
use patch::{MOST_PIXELS, PatchScratch, Patches, Picks};

/// Vectors of pixels that may share a sweep.
const NUM_VECTORS: usize = MOST_PIXELS / 8;

/// Bins along an ellipse for a kernel that is exact to 1e-4.
const FINE_BINS: f32 = 256.0;

/// Bins along the shortest ellipse of a patch that serve a picture, for each texel that the
/// settings ask for across: unlit, lit for good, and lit, where lights are asked for each bin; and the
/// fewest.
const BINS: f32 = 0.375;
const BAKED_BINS: f32 = 0.6;
const LIT_BINS: f32 = 1.6;
const LEAST_BINS: f32 = 4.0;

/// Bins and lines of what is reflected of lights: lobes are sharper than shadows. Measured on metal of
/// roughness 0.3 near by, see the results of November 2026: as many as of what is lit have 35 dB, these
/// 39 in 1.2 of the time, twice as many 43. Curved surfaces have the bins alone: the lines have 0.6 dB
/// there, for half as much time again.
const SHINY_BINS: f32 = 1.2;
const SHINY_LINES: f32 = 2.8;

/// Lines of what is lit for good, as a share of those of what is not. Shadows have sharper edges than
/// albedo, and bins pay better than lines there: see the results of November 2026.
const BAKED_LINES: f32 = 0.7;

/// Buffers of the filter, kept between calls.
#[derive(Clone, Debug, Default)]
pub(super) struct HorizonScratch {
    patch: PatchScratch,
    /// The pixels' ellipses in texels of the base level.
    base: Vec<Ellipses>,
    /// How much of each pixel the tables give.
    shares: Vec<[f32; 8]>,
    /// Pixels that are swept: vector times 8 plus lane.
    near: Vec<u8>,
    near_eyes: Vec<Vec3>,
    found: Vec<Texel>,
}

/// The means of a batch's pixels: what is near is swept together, what is far comes from tables.
pub(super) fn colors(
    prepared: &Prepared,
    batch: &Batch,
    horizon: &Horizon,
    scratch: &mut HorizonScratch,
    out: &mut [Filtered],
) -> Work {
    let surface = prepared.surface();
    let is_curved = batch.curved.is_some();
    let far = far_field(prepared, horizon, batch.is_lit() || is_curved);
    let far = far.as_deref();
    let is_shiny = batch.curved.is_some_and(|curved| curved.is_shiny());
    let num_bins = if batch.is_alone {
        FINE_BINS
    } else {
        picture_bins(prepared, horizon, batch.is_lit(), is_shiny)
    };
    let (mut lights, mut to_eyes) = (batch.lights, batch.to_eyes.iter());
    let mut num_rows = 0;
    let chunks = batch.pixels.chunks(NUM_VECTORS).zip(out.chunks_mut(NUM_VECTORS));
    for (i, (pixels, out)) in chunks.enumerate() {
        let HorizonScratch { patch, base, shares, near, near_eyes, found } = scratch;
        base_ellipses(surface, pixels, horizon, base);
        share_out(surface, far, (pixels, base), horizon, (shares, near));
        // Sweep what is near.
        found.clear();
        found.resize(near.len(), Texel::default());
        // Lit frames have no tables: all covered pixels are near, and the next lights are theirs.
        let (of_these, others) = lights.split_at(if lights.is_empty() { 0 } else { near.len() });
        near_eyes.clear();
        let lanes = pixels.iter().zip(&*shares).flat_map(|(p, s)| p.covered().map(|i| s[i]));
        let seen_near = lanes.zip(&mut to_eyes).filter(|(share, _)| *share < 1.0);
        near_eyes.extend(seen_near.map(|(_, to_eye)| *to_eye));
        if let Some(gloss) = prepared.gloss().filter(|_| batch.to_eyes.is_empty()) {
            let displacement =
                |pick: &u8| pixels[usize::from(pick / 8)].lane(usize::from(pick % 8)).displacement;
            near_eyes.extend(near.iter().map(|pick| gloss.to_eye(displacement(pick))));
        }
        let curved = batch.curved.map(|curved| curved.part(i * NUM_VECTORS, pixels.len()));
        let light = curved
            .as_ref()
            .and_then(|curved| Some((curved, prepared.horizons(curved.shine.is_some())?)));
        let patches = Patches {
            is_alone: batch.is_alone,
            light,
            bows: batch.bows.get(NUM_VECTORS * i..).unwrap_or_default(),
            shows_light: batch.is_lit() || is_curved || prepared.is_lit(),
            ..patches(prepared, (pixels, base), horizon, num_bins, batch.is_lit())
        };
        let picks = Picks { picks: near, lights: of_these, to_eyes: near_eyes };
        num_rows += patches.means(picks, patch, found);
        lights = others;
        // Blend it with what the tables give.
        let mut swept = found.iter();
        for ((pixels, shares), out) in pixels.iter().zip(shares).zip(out) {
            for lane in pixels.covered() {
                let near = if shares[lane] < 1.0 { swept.next() } else { None };
                let far = far.filter(|_| shares[lane] > 0.0);
                let far =
                    far.map(|far| far.mean(surface, &pixels.lane(lane), horizon.max_anisotropy));
                match (near, far) {
                    (Some(near), Some(far)) => out.set(lane, &near.lerp(&far, shares[lane])),
                    (Some(near), None) => out.set(lane, near),
                    (None, far) => out.set(lane, &far.unwrap_or_default()),
                }
            }
        }
    }
    Work { num_tested: num_rows, num_averaged: 0 }
}

/// What [`colors`] reads for each pixel of a batch.
pub(super) fn levels(
    prepared: &Prepared,
    (pixels, is_lit): (&[Footprints], bool),
    horizon: &Horizon,
    scratch: &mut HorizonScratch,
) -> Vec<[LevelChoice; 8]> {
    let far = far_field(prepared, horizon, is_lit);
    let mut all = Vec::with_capacity(pixels.len());
    for pixels in pixels.chunks(NUM_VECTORS) {
        let HorizonScratch { patch, base, shares, near, .. } = scratch;
        base_ellipses(prepared.surface(), pixels, horizon, base);
        share_out(prepared.surface(), far.as_deref(), (pixels, base), horizon, (shares, near));
        let mut levels = Vec::with_capacity(near.len());
        let num_bins = picture_bins(prepared, horizon, is_lit, false);
        patches(prepared, (pixels, base), horizon, num_bins, is_lit).levels(
            near,
            patch,
            &mut levels,
        );
        let mut levels = levels.into_iter();
        all.extend(pixels.iter().zip(shares).map(|(pixels, shares)| {
            let mut choices = [LevelChoice::default(); 8];
            for lane in pixels.covered() {
                let level = if shares[lane] < 1.0 { levels.next() } else { None };
                choices[lane] =
                    LevelChoice { level: level.unwrap_or(0), blend: 0.0, far_share: shares[lane] };
            }
            choices
        }));
    }
    all
}

/// The tables, if they are wanted: they hold unlit colour.
fn far_field(
    prepared: &Prepared,
    horizon: &Horizon,
    is_lit: bool,
) -> Option<std::sync::Arc<FarField>> {
    if is_lit || !horizon.far_field { None } else { prepared.far_field(horizon.far_field_mib) }
}

/// The ellipses of pixels in texels of the base level, from which those on other levels are made.
fn base_ellipses(
    surface: &Surface,
    pixels: &[Footprints],
    horizon: &Horizon,
    base: &mut Vec<Ellipses>,
) {
    let texels = surface.base().texels_per_repeat();
    base.clear();
    base.extend(pixels.iter().map(|p| Ellipses::new(p, texels, horizon.max_anisotropy)));
}

/// How much of each pixel the tables give, and the pixels that they do not give wholly.
fn share_out(
    surface: &Surface,
    far: Option<&FarField>,
    (pixels, base): (&[Footprints], &[Ellipses]),
    horizon: &Horizon,
    (shares, near): (&mut Vec<[f32; 8]>, &mut Vec<u8>),
) {
    shares.clear();
    near.clear();
    for (vector, (pixels, base)) in pixels.iter().zip(base).enumerate() {
        let of_far = |far: &FarField| far.shares(surface, (pixels, base), horizon);
        let of_far = far.map_or(PixelLanes::ZERO, of_far).to_array();
        near.extend(
            pixels
                .covered()
                .filter(|lane| of_far[*lane] < 1.0)
                .map(|lane| (8 * vector + lane) as u8),
        );
        shares.push(of_far);
    }
}

/// Bins along the shortest ellipse of a patch that serve a picture.
fn picture_bins(prepared: &Prepared, horizon: &Horizon, is_lit: bool, is_shiny: bool) -> f32 {
    let bins = match is_lit {
        true => LIT_BINS,
        false if is_shiny || prepared.gloss().is_some_and(Gloss::is_shiny) => SHINY_BINS,
        false if prepared.is_lit() => BAKED_BINS,
        false => BINS,
    };
    (horizon.lines as f32 * bins).max(LEAST_BINS)
}

/// Lines of a picture as a share of those that the settings ask for.
fn lines_of(prepared: &Prepared) -> f32 {
    match prepared.gloss() {
        Some(gloss) if gloss.is_shiny() => SHINY_LINES,
        _ if prepared.is_lit() => BAKED_LINES,
        _ => 1.0,
    }
}

fn patches<'a>(
    prepared: &'a Prepared,
    (pixels, base): (&'a [Footprints], &'a [Ellipses]),
    horizon: &'a Horizon,
    num_bins: f32,
    is_lit: bool,
) -> Patches<'a> {
    let loss = if is_lit { None } else { prepared.level_loss() };
    let surface = prepared.surface();
    Patches {
        surface,
        loss,
        light: None,
        bows: &[],
        gloss: prepared.gloss(),
        sunlit: prepared.sunlit(),
        pixels,
        base,
        horizon,
        num_bins,
        num_lines: horizon.lines as f32 * lines_of(prepared),
        is_lit,
        shows_light: is_lit || prepared.is_lit(),
        is_alone: false,
    }
}
