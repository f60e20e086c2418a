//! What tables hold of lit and glossy surfaces: what shines on the segments between texels, and what
//! an eye in one direction sees of it.

use crate::light::{Gloss, Sunlight, Sunlit, SunlitTexels, unpack_openings};
use crate::relief::seen::{Crossing, Sight};
use crate::simd::{TexelLanes, as_signed, u32x8};
use crate::texture::{FULL_F32, Surface};

/// Colours as an eye sees them through what lies above them, or in what they reflect.
pub(super) struct Glossy<'a> {
    gloss: &'a Gloss,
    to_eye: [TexelLanes; 3],
    /// The level that is swept.
    level: usize,
}

impl<'a> Glossy<'a> {
    /// To the eye of a displacement in repeats.
    pub(super) fn new(gloss: &'a Gloss, displacement: [f32; 2], level: usize) -> Self {
        let to_eye = gloss.to_eye(displacement);
        Self { gloss, to_eye: to_eye.to_array().map(TexelLanes::splat), level }
    }

    fn shown(
        &self,
        colors: [TexelLanes; 3],
        [normal, opening]: [[TexelLanes; 3]; 2],
    ) -> [TexelLanes; 3] {
        let directions = [normal, opening, self.to_eye];
        self.gloss.shown((colors, FULL_F32), directions, (self.level == 0, TexelLanes::ZERO))
    }
}

/// Colours, normals and openings.
impl Sight for Glossy<'_> {
    type Values = [[TexelLanes; 3]; 3];

    fn read(&self, crossing: &Crossing) -> Self::Values {
        let openings = self.gloss.openings().map(|openings| {
            let rows = openings.rows(self.level, crossing.is_turned);
            let [near, far] = crossing.both(rows, 0).map(unpack_openings);
            std::array::from_fn(|i| crossing.mix(near[i], far[i]))
        });
        [crossing.colors(), crossing.normals(), openings.unwrap_or([TexelLanes::ZERO; 3])]
    }

    fn between(&self, [near, far]: [&Self::Values; 2], part: TexelLanes) -> [TexelLanes; 3] {
        let mix = |k: usize| std::array::from_fn(|i| near[k][i] + (far[k][i] - near[k][i]) * part);
        self.shown(mix(0), [mix(1), mix(2)])
    }
}

/// A base level in the light of a sun and of the sky.
pub(super) struct InSun<'a> {
    texels: &'a SunlitTexels,
    light: Sunlight,
    /// What lies above it, if anything does.
    layer: Option<Glossy<'a>>,
}

impl<'a> InSun<'a> {
    /// In units of a lit surface's colours.
    pub(super) fn new(texels: &'a SunlitTexels, lit: &Surface, layer: Option<Glossy<'a>>) -> Self {
        Self { texels, light: texels.light(lit), layer }
    }
}

impl Sight for InSun<'_> {
    type Values = Sunlit<TexelLanes>;

    fn read(&self, crossing: &Crossing) -> Self::Values {
        let rows = self.texels.rows(crossing.is_turned);
        let words = [0, 1].map(|plane| crossing.both(rows, plane));
        let colors = [crossing.colors(), crossing.normals()];
        Sunlit::new(colors, crossing.height() * (1.0 / FULL_F32), |plane, first, most| {
            let [near, far] = words[plane]
                .map(|word| TexelLanes::from_i32x8(as_signed(word >> first & u32x8::splat(most))));
            crossing.mix(near, far) * (1.0 / most as f32)
        })
    }

    fn between(&self, [near, far]: [&Self::Values; 2], part: TexelLanes) -> [TexelLanes; 3] {
        let place = near.mix(far, part);
        let shown = place.shown(&self.light);
        match &self.layer {
            None => shown,
            Some(layer) => layer.shown(shown, [place.normal, [TexelLanes::ZERO; 3]]),
        }
    }
}
