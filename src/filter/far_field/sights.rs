//! What tables hold of lit and glossy surfaces: what shines on the segments between texels, and what
//! an eye in one direction sees of it.

use crate::light::{Gloss, Skyline, Sunlight, Sunlit, SunlitTexels};
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
        normal: [TexelLanes; 3],
        skyline: &Skyline<TexelLanes>,
    ) -> [TexelLanes; 3] {
        let (directions, is_base) = ([normal, self.to_eye], self.level == 0);
        self.gloss.shown((colors, FULL_F32), directions, skyline, (is_base, TexelLanes::ZERO))
    }
}

/// Colours, normals and skylines.
impl Sight for Glossy<'_> {
    type Values = ([[TexelLanes; 3]; 2], Skyline<TexelLanes>);

    fn read(&self, crossing: &Crossing) -> Self::Values {
        let skyline = self.gloss.skylines().map(|skylines| {
            let rows = skylines.rows(self.level, crossing.is_turned);
            let [a, b] = [0, 1].map(|plane| crossing.both(rows, plane));
            let [near, far] = [0, 1].map(|i| Skyline::unpack([a[i], b[i]]));
            near.mix(&far, crossing.part())
        });
        ([crossing.colors(), crossing.normals()], skyline.unwrap_or(Skyline::<TexelLanes>::FLAT))
    }

    fn between(&self, [near, far]: [&Self::Values; 2], part: TexelLanes) -> [TexelLanes; 3] {
        let mix = |a: TexelLanes, b: TexelLanes| a + (b - a) * part;
        let mix3 = |k: usize| std::array::from_fn(|i| mix(near.0[k][i], far.0[k][i]));
        self.shown(mix3(0), mix3(1), &near.1.mix(&far.1, part))
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
            Some(layer) => layer.shown(shown, place.normal, &Skyline::<TexelLanes>::FLAT),
        }
    }
}
