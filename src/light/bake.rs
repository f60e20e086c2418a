//! Light baked into a surface's colours.
//!
//! What a matte texel sends out does not depend on the eye: `a E`, its albedo times
//!
//! ```text
//! E = sum over beams of I max(0, n.l) V
//! ```
//!
//! with `V` the part of the texel that the beam reaches over the relief. So a lit picture is the
//! unlit one of another surface, whose colours are `a E`: every filter, near and far, serves as it
//! is, and where the eye and the light see the same texels they are told apart texel by texel. Mip
//! levels are those of the product; a mean of `V` alone would light what nobody sees.
//!
//! It takes one direction of each beam over the whole surface: for flat pieces of meshes, under
//! suns and skies. Where texels are larger than pixels, edges of shadows run between them: see
//! [`SunlitTexels`](super::SunlitTexels).

use super::beams::TextureFrame;
use super::sunlit::SunlitTexels;
use super::texel_light::{SunLight, TexelLight};
use crate::scene::{Light, Sky};
use crate::texture::{Normals, Surface};
use std::sync::Arc;

/// The shares of suns' light and of the sky's that a texel shows, by its column and row.
pub(super) type Shares<'a> = Option<&'a (dyn Fn(usize, usize) -> [f32; 2] + Sync)>;

/// The light of a scene on a flat piece of a surface, light by light.
pub struct BakedLight<'a> {
    surface: &'a Arc<Surface>,
    shares: Shares<'a>,
    /// `None` for what sends none there.
    sky: Option<TexelLight>,
    /// One for each of the scene's suns.
    suns: Vec<Option<SunLight>>,
}

/// Which light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// All that comes from suns and from the sky.
    All,
    /// The sky.
    Sky,
    /// One of the suns, by its number among the suns.
    Sun(usize),
}

impl<'a> BakedLight<'a> {
    /// The light of suns and a sky on a surface that lies in a frame.
    pub fn new(
        surface: &'a Arc<Surface>,
        frame: &TextureFrame,
        (lights, sky): (&[Light], &Sky),
        shares: Shares<'a>,
    ) -> Self {
        let suns = lights.iter().filter(|light| matches!(light, Light::Sun { .. }));
        let suns = suns.map(|sun| SunLight::new(surface, &frame.sun(sun))).collect();
        let beams = frame.sky(sky);
        let sky = (!beams.is_empty()).then(|| TexelLight::new(surface, &beams));
        Self { surface, shares, sky, suns }
    }

    /// The surface in some of the light; it needs no normals any more.
    pub fn surface(&self, part: Part) -> Surface {
        self.colored(part, Normals::Dropped)
    }

    /// The same with normals, for what is seen through what lies above it.
    pub fn layer(&self, part: Part) -> Surface {
        self.colored(part, Normals::Kept)
    }

    fn colored(&self, part: Part, normals: Normals) -> Surface {
        self.surface.with_colors(normals, |x, y, albedo| {
            let light = self.at(x, y, |of| part == Part::All || part == of);
            std::array::from_fn(|c| albedo[c] * light[c])
        })
    }

    /// The surface as it is seen from near under the sky and each of the scene's suns; `None` where that
    /// sends no light. None on a surface without relief.
    pub fn near(&self) -> Vec<Option<SunlitTexels>> {
        if self.surface.relief_depth() == 0.0 {
            return self.suns.iter().map(|_| None).collect();
        }
        let sky = |x, y| self.at(x, y, |part| part == Part::Sky);
        let share = |x, y| self.shares.map_or(1.0, |shares| shares(x, y)[0]);
        let near = |sun| SunlitTexels::new(self.surface.clone(), sun, sky, share);
        self.suns.iter().map(|sun| sun.as_ref().map(near)).collect()
    }

    /// What some of the light leaves on a white texel.
    fn at(&self, x: usize, y: usize, has: impl Fn(Part) -> bool) -> [f32; 3] {
        let [of_suns, of_sky] = self.shares.map_or([1.0; 2], |shares| shares(x, y));
        let mut sum = [0.0; 3];
        let mut add = |light: &TexelLight, share: f32| {
            sum.iter_mut().zip(light.at(x, y)).for_each(|(sum, c)| *sum += c * share);
        };
        for (number, sun) in self.suns.iter().enumerate() {
            if let Some(sun) = sun.as_ref().filter(|_| has(Part::Sun(number))) {
                add(&sun.light, of_suns);
            }
        }
        if let Some(sky) = self.sky.as_ref().filter(|_| has(Part::Sky)) {
            add(sky, of_sky);
        }
        sum
    }
}
