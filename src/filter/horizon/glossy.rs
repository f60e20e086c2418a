//! Highlights of a patch: what each texel that its lines see shows of a sun, or of the sky.

use super::fit::{Fit, Linear};
use super::pixels::PixelOnLines;
use crate::light::{Gloss, openings_at};
use crate::simd::{BETWEEN_SCALE, Between, LineLanes};
use crate::texture::{FULL_F32, Rows};
use glam::Vec3;

/// A sun or the sky over a patch of a rough surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchGloss<'a> {
    gloss: &'a Gloss,
    /// What texels see of the sky, where that is reflected.
    pub(super) openings: Option<&'a Rows>,
    /// The `xi` and `q` around which numbers are linear.
    middle: [f32; 2],
    /// The way to the eye along u and along v for each length up: linear over a plane, as the way
    /// itself is.
    to_eye: [Linear; 2],
    /// Whether normals are single ones: those of the base level.
    is_base: bool,
}

/// Least height of the eye over the surface, as a share of its distance.
const LEAST_HEIGHT: f32 = 1e-3;

impl<'a> PatchGloss<'a> {
    /// Of pixels that lie so on the lines of a patch, swept along rows of a mip level, with unit
    /// directions to the eye.
    pub(super) fn new(
        gloss: &'a Gloss,
        to_eyes: &[Vec3],
        pixels: &[PixelOnLines],
        (level, is_turned): (usize, bool),
    ) -> Self {
        let openings = gloss.openings().map(|openings| openings.rows(level, is_turned));
        let fit = Fit::new(pixels);
        let to_eye = [0, 1].map(|i| {
            let along = |to_eye: &Vec3| to_eye[i] / to_eye.z.max(LEAST_HEIGHT);
            fit.linear(to_eyes.iter().map(along))
        });
        Self { gloss, openings, middle: fit.middle, to_eye, is_base: level == 0 }
    }

    /// What texels with such colours and normals show, seen at such lines and places, red, green and blue;
    /// their openings lie in a run of texels.
    #[inline(always)]
    pub(super) fn at(
        &self,
        [color, normal]: [[LineLanes; 3]; 2],
        [xi, p]: [LineLanes; 2],
        (start, between): (usize, &Between),
    ) -> [LineLanes; 3] {
        let [xi, p] = [xi - self.middle[0], p - self.middle[1]];
        let [u, v] = self.to_eye.map(|way| way.at(xi, p));
        let up = LineLanes::ONE / (u * u + v * v + 1.0).sqrt();
        let opening = match self.openings {
            Some(rows) => openings_at(rows, start, between),
            None => [LineLanes::ZERO; 3],
        };
        let full = FULL_F32 * BETWEEN_SCALE;
        self.gloss.shown((color, full), [normal, opening, [u * up, v * up, up]], self.is_base)
    }
}
