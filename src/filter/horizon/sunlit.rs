//! What a sun leaves on the segments between texels, seen from near: the edge of its shadow lies
//! where the relief rises out of it. See [`SunlitTexels`].

use super::lines::Step;
use super::show::Show;
use crate::light::{SunlitLanes, SunlitTexels};
use crate::simd::{BETWEEN_SCALE, LineLanes};
use crate::texture::{FULL_F32, Rows, Surface};

/// Least length of a mean normal that is divided by.
const LEAST_LENGTH: f32 = 1e-3;

/// A sun over the lines of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchSun<'a> {
    texels: &'a SunlitTexels,
    rows: &'a Rows,
    /// What the sun and the brightest sky add to a colour, in units of the lit surface's.
    intensity: [f32; 3],
    brightest: f32,
}

/// Texels of a group of lines in the light of a sun, one of each.
#[derive(Clone, Copy)]
pub(super) struct Sunlit {
    albedo: [LineLanes; 3],
    normal: [LineLanes; 3],
    /// How high they lie above the middle of the shadow's edge, and how wide that is.
    above: LineLanes,
    width: LineLanes,
    /// The part of the sun's light that they show, and the light of the sky.
    share: LineLanes,
    sky: [LineLanes; 3],
}

impl<'a> PatchSun<'a> {
    /// Over lines along rows of the base level of a lit surface.
    pub(super) fn new(texels: &'a SunlitTexels, lit: &Surface, is_turned: bool) -> Self {
        let unit = texels.surface().color_scale() / lit.color_scale();
        let intensity = (texels.intensity * unit).to_array();
        let brightest = texels.brightest * unit;
        Self { texels, rows: texels.rows(is_turned), intensity, brightest }
    }

    /// The texels of a row of a step, by where it starts.
    #[inline(always)]
    fn row<const HALVES: bool>(&self, step: &Step<'_, HALVES>, starts: [usize; 2]) -> Sunlit {
        let ([r, g, b, x, y, z], height) = step.values_at(starts[0]);
        let SunlitLanes { edge: [middle, width], share, sky } =
            SunlitLanes::new(self.rows, starts[1], &step.between);
        let above = height * (1.0 / (FULL_F32 * BETWEEN_SCALE)) - middle;
        Sunlit { albedo: [r, g, b], normal: [x, y, z], above, width, share, sky }
    }
}

impl Sunlit {
    /// At a part of the way to the next.
    #[inline(always)]
    fn mix(&self, next: &Self, part: LineLanes) -> Self {
        let mix = |a: LineLanes, b: LineLanes| a + (b - a) * part;
        Self {
            albedo: std::array::from_fn(|i| mix(self.albedo[i], next.albedo[i])),
            normal: std::array::from_fn(|i| mix(self.normal[i], next.normal[i])),
            above: mix(self.above, next.above),
            width: mix(self.width, next.width),
            share: mix(self.share, next.share),
            sky: std::array::from_fn(|i| mix(self.sky[i], next.sky[i])),
        }
    }
}

impl Show<3> for PatchSun<'_> {
    type Values = Sunlit;

    const NONE: Sunlit = Sunlit {
        albedo: [LineLanes::ZERO; 3],
        normal: [LineLanes::ZERO; 3],
        above: LineLanes::ZERO,
        width: LineLanes::ONE,
        share: LineLanes::ZERO,
        sky: [LineLanes::ZERO; 3],
    };

    #[inline(always)]
    fn others(&self) -> Option<&Rows> {
        Some(self.rows)
    }

    #[inline(always)]
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> Sunlit {
        let (near, far) = step.starts();
        let row = self.row(step, near);
        match far {
            Some(far) => row.mix(&self.row(step, far), LineLanes::HALF),
            None => row,
        }
    }

    #[inline(always)]
    fn between(&self, [last, next]: [&Sunlit; 2], part: LineLanes) -> [LineLanes; 3] {
        // Lines that see nothing of a segment ask for places far beyond its ends.
        let part = part.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
        let Sunlit { albedo, normal: [x, y, z], above, width, share, sky } = last.mix(next, part);
        let to_sun = self.texels.to_sun;
        let cosine = (x * to_sun.x + y * to_sun.y + z * to_sun.z).fast_max(LineLanes::ZERO);
        let length = (x * x + y * y + z * z).sqrt().fast_max(LineLanes::splat(LEAST_LENGTH));
        let seen = (above / width + 0.5).fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
        let sun = cosine * seen * share / length;
        std::array::from_fn(|i| albedo[i] * (sky[i] * self.brightest + sun * self.intensity[i]))
    }
}
