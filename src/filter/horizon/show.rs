//! What a sweep shows: what is read of the texels that lines see, and what the segments between two
//! of them show for it.

use super::lines::Step;
use super::lit::PatchLight;
use crate::simd::LineLanes;
use crate::texture::Rows;

/// What is shown, in channels: colour, then normal.
pub(super) trait Show<const CHANNELS: usize> {
    /// What is read of texels.
    type Values: Copy;

    /// Before anything is read.
    const NONE: Self::Values;

    /// What is read of texels beside their own words, if anything.
    fn others(&self) -> Option<&Rows>;

    /// Reads the texels of a step.
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> Self::Values;

    /// What is shown on a part of the way between two texels.
    fn between(&self, texels: [&Self::Values; 2], part: &Part) -> [LineLanes; CHANNELS];

    /// Sums, and so much more of that.
    #[inline(always)]
    fn added_to(
        &self,
        sums: [LineLanes; CHANNELS],
        texels: [&Self::Values; 2],
        part: &Part,
        length: LineLanes,
    ) -> [LineLanes; CHANNELS] {
        let shown = self.between(texels, part);
        std::array::from_fn(|i| sums[i] + shown[i] * length)
    }
}

/// A part of the way between two texels, 0 the last and 1 the next.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) middle: LineLanes,
    pub(super) length: LineLanes,
}

impl Part {
    /// Between the two: lines that see nothing of a segment ask for places far beyond its ends.
    #[inline(always)]
    pub(super) fn within(&self) -> Self {
        let [middle, length] = [self.middle, self.length]
            .map(|c| c.fast_max(LineLanes::ZERO).fast_min(LineLanes::ONE));
        Self { middle, length }
    }
}

/// What texels show by themselves.
pub(super) trait ShowTexels<const CHANNELS: usize> {
    /// See [`Show::others`].
    fn others(&self) -> Option<&Rows>;

    /// What the texels of a step show.
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> [LineLanes; CHANNELS];
}

/// Shows what texels show, and between them what lies between.
pub(super) struct Interpolated<T>(pub(super) T);

impl<const CHANNELS: usize, T: ShowTexels<CHANNELS>> Show<CHANNELS> for Interpolated<T> {
    type Values = [LineLanes; CHANNELS];

    const NONE: Self::Values = [LineLanes::ZERO; CHANNELS];

    #[inline(always)]
    fn others(&self) -> Option<&Rows> {
        self.0.others()
    }

    #[inline(always)]
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> Self::Values {
        self.0.read(step)
    }

    #[inline(always)]
    fn added_to(
        &self,
        mut sums: [LineLanes; CHANNELS],
        [last, next]: [&Self::Values; 2],
        part: &Part,
        length: LineLanes,
    ) -> [LineLanes; CHANNELS] {
        let of_next = length * part.middle;
        let of_last = length - of_next;
        (0..CHANNELS).for_each(|i| sums[i] = sums[i] + next[i] * of_next + last[i] * of_last);
        sums
    }

    #[inline(always)]
    fn between(&self, [last, next]: [&Self::Values; 2], part: &Part) -> [LineLanes; CHANNELS] {
        std::array::from_fn(|i| last[i] + (next[i] - last[i]) * part.middle)
    }
}

/// Colours, and normals where there are channels for them.
pub(super) struct Texels;

impl<const CHANNELS: usize> ShowTexels<CHANNELS> for Texels {
    #[inline(always)]
    fn others(&self) -> Option<&Rows> {
        None
    }

    #[inline(always)]
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> [LineLanes; CHANNELS] {
        step.values().0
    }
}

/// What lights shine on a curved surface, times its colours.
impl ShowTexels<3> for &PatchLight<'_> {
    #[inline(always)]
    fn others(&self) -> Option<&Rows> {
        Some(self.rows)
    }

    #[inline(always)]
    fn read<const HALVES: bool>(&self, step: &Step<'_, HALVES>) -> [LineLanes; 3] {
        let (colors, height) = step.values::<3>();
        let [xi, p] = step.seen_at();
        let shown = self.at(step.other(), &step.between, [xi, p, height], step.q());
        [0, 1, 2].map(|c| colors[c] * shown[c])
    }
}
