//! Highlights of a patch: what each texel that its lines see shows of a sun.

use super::fit::{Fit, Linear};
use super::pixels::PixelOnLines;
use crate::light::{Gloss, Shine, lobes};
use crate::simd::{Lanes, LineLanes};

/// A sun over a patch of a rough surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchGloss {
    /// The `xi` and `q` around which numbers are linear.
    middle: [f32; 2],
    to_light: [f32; 3],
    /// The way to the eye along u and along v for each length up: linear over a plane, as the way
    /// itself is.
    to_eye: [Linear; 2],
    alpha_squared: Linear,
    /// Whether normals are single ones: those of the base level.
    is_base: bool,
}

/// Least height of the eye over the surface, as a share of its distance.
const LEAST_HEIGHT: f32 = 1e-3;

impl PatchGloss {
    /// Of pixels that lie so on the lines of a patch, swept on a mip level.
    pub(super) fn new(
        gloss: &Gloss,
        shines: &[Shine],
        pixels: &[PixelOnLines],
        level: usize,
    ) -> Self {
        let fit = Fit::new(pixels);
        let to_eye = [0, 1].map(|i| {
            let along = |shine: &Shine| shine.to_eye[i] / shine.to_eye.z.max(LEAST_HEIGHT);
            fit.linear(shines.iter().map(along))
        });
        let alpha_squared = fit.linear(shines.iter().map(|shine| shine.alpha_squared));
        let to_light = gloss.to_light.to_array();
        Self { middle: fit.middle, to_light, to_eye, alpha_squared, is_base: level == 0 }
    }

    /// What texels with such normals show, seen at such lines and places.
    #[inline(always)]
    pub(super) fn at(&self, normal: [LineLanes; 3], [xi, p]: [LineLanes; 2]) -> LineLanes {
        let [xi, p] = [xi - self.middle[0], p - self.middle[1]];
        let [u, v] = self.to_eye.map(|way| way.at(xi, p));
        let up = LineLanes::ONE / (u * u + v * v + 1.0).sqrt();
        let to_light = self.to_light.map(LineLanes::splat);
        let alpha_squared = self.alpha_squared.at(xi, p).at_least(0.0) + self.spread(normal);
        lobes(normal, [to_light, [u * up, v * up, up]], alpha_squared.at_most(1.0))
    }

    /// What means of normals add to `a^2`, by how much shorter than one they are.
    #[inline(always)]
    fn spread(&self, normal: [LineLanes; 3]) -> LineLanes {
        if self.is_base {
            return LineLanes::ZERO;
        }
        let square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
        let inverse = LineLanes::ONE / square.at_least(1e-6).sqrt();
        ((inverse - 1.0) * 2.0).at_least(0.0)
    }
}
