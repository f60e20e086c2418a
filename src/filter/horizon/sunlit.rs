//! What a sun leaves on the segments between texels, seen from near: the edge of its shadow lies
//! where the relief rises out of it. See [`SunlitTexels`].

use super::lines::Step;
use super::show::{Part, Show};
use crate::light::{Sunlight, Sunlit, SunlitTexels};
use crate::simd::{BETWEEN_SCALE, LineLanes};
use crate::texture::{FULL_F32, Rows, Surface};

/// A sun over the lines of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct PatchSun<'a> {
    rows: &'a Rows,
    light: Sunlight,
}

impl<'a> PatchSun<'a> {
    /// Over lines along rows of the base level of a lit surface.
    pub(super) fn new(texels: &'a SunlitTexels, lit: &Surface, is_turned: bool) -> Self {
        Self { rows: texels.rows(is_turned), light: texels.light(lit) }
    }
}

/// The texels of a row of a step, by where it starts among the words of a surface and of
/// [`SunlitTexels`].
#[inline(always)]
fn row<const HALVES: bool>(
    rows: &Rows,
    step: &Step<'_, HALVES>,
    starts: [usize; 2],
) -> Sunlit<LineLanes> {
    let ([r, g, b, x, y, z], height) = step.values_at(starts[0]);
    let words =
        [0, 1].map(|plane| step.between.words_at(rows.words(), starts[1] + plane * rows.stride()));
    let height = height * (1.0 / (FULL_F32 * BETWEEN_SCALE));
    Sunlit::new([[r, g, b], [x, y, z]], height, |plane, first, most| {
        step.between.bits_of(words[plane], first, most) * (1.0 / (most as f32 * BETWEEN_SCALE))
    })
}

/// The texels of a step with the edges that rows of [`SunlitTexels`] say.
#[inline(always)]
pub(super) fn sunlit<const HALVES: bool>(
    rows: &Rows,
    step: &Step<'_, HALVES>,
) -> Sunlit<LineLanes> {
    let (near, far) = step.starts();
    let near = row(rows, step, near);
    match far {
        Some(far) => near.mix(&row(rows, step, far), LineLanes::HALF),
        None => near,
    }
}

/// No texels.
pub(super) const DARK: Sunlit<LineLanes> = Sunlit {
    albedo: [LineLanes::ZERO; 3],
    normal: [LineLanes::ZERO; 3],
    above: LineLanes::ZERO,
    width: LineLanes::ONE,
    share: LineLanes::ZERO,
    sky: [LineLanes::ZERO; 3],
};

impl Show<3> for PatchSun<'_> {
    type Values = Sunlit<LineLanes>;

    const NONE: Self::Values = DARK;

    #[inline(always)]
    fn others(&self) -> Option<&Rows> {
        Some(self.rows)
    }

    #[inline(always)]
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> Self::Values {
        sunlit(self.rows, step)
    }

    #[inline(always)]
    fn between(&self, [last, next]: [&Self::Values; 2], part: &Part) -> [LineLanes; 3] {
        // Lines that see nothing of a segment ask for places far beyond its ends.
        let middle = part.middle.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE);
        last.mix(next, middle).shown(&self.light)
    }
}
