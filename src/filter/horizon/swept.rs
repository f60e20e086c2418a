//! Patches as they are swept: by what their surface shows.

use super::glossy::{Layered, PatchGloss};
use super::grid::Profile;
use super::kernel::Totals;
use super::lit::PatchLight;
use super::patch::{PatchScratch, Patches, Picks};
use super::pixels::PixelOnLines;
use super::plan::Plan;
use super::shine::{PatchLayer, PatchShine};
use super::show::{Interpolated, Show, Texels};
use super::sunlit::PatchSun;
use crate::filter::points;
use crate::light::{Sheen, Shine};
use crate::simd::BETWEEN_SCALE;
use crate::texture::Texel;

impl<'a> Patches<'a> {
    /// Sweeps a planned patch.
    pub(super) fn sweep(
        &self,
        plan: &Plan,
        Picks { picks, lights, to_eyes }: Picks,
        scratch: &mut PatchScratch,
        found: &mut [Texel],
    ) -> u64 {
        let PatchScratch { unlit, lit, pixels, totals, .. } = scratch;
        totals.clear();
        totals.resize(picks.len(), Totals::default());
        let is_turned = plan.frame.is_turned;
        let is_near = plan.is_near() && !self.sunlit.is_empty();
        let num_rows = if self.is_lit {
            plan.run::<6>(&Interpolated(Texels), lit, (pixels, lights), totals)
        } else if let Some((curved, horizons)) = self.light {
            let light =
                PatchLight::new(curved, horizons.rows(plan.level, is_turned), picks, pixels);
            if light.is_dark() {
                found.fill(Texel::default());
                return 0;
            }
            match &curved.shine {
                Some(Shine { sheen: Sheen::Luster(luster), to_eyes }) => {
                    let unit = (BETWEEN_SCALE, plan.level == 0);
                    let shine = PatchShine::new(&light, (luster, to_eyes), (picks, pixels), unit);
                    plan.run(&shine, unlit, (pixels, &[]), totals)
                }
                Some(Shine { sheen: Sheen::Layer(layer), to_eyes }) => {
                    let layer = PatchLayer::new(&light, (layer, to_eyes), (picks, pixels));
                    plan.run(&Interpolated(&layer), unlit, (pixels, &[]), totals)
                }
                None => plan.run(&Interpolated(&light), unlit, (pixels, &[]), totals),
            }
        } else if let Some(gloss) = self.gloss {
            let gloss = PatchGloss::new(gloss, to_eyes, pixels, (plan.level, is_turned));
            if is_near {
                let layered = |show| Layered { show, gloss };
                self.sweep_sunlit(plan, layered, (unlit, pixels), totals)
            } else {
                plan.run(&gloss, unlit, (pixels, &[]), totals)
            }
        } else if is_near {
            self.sweep_sunlit(plan, |sun| sun, (unlit, pixels), totals)
        } else {
            plan.run(&Interpolated(Texels), unlit, (pixels, &[]), totals)
        };
        for ((found, totals), pick) in found.iter_mut().zip(totals).zip(picks) {
            // Where no line meets the ellipse, the texels around the base place stand for it.
            let mean = totals.mean(self.is_lit).unwrap_or_else(|| {
                let pixel = self.pixels[usize::from(pick / 8)].lane(usize::from(pick % 8));
                points::bilinear(&self.surface.levels()[plan.level], pixel.base)
            });
            // Written one f32 at a time: a vector store followed by scalar loads would stall store
            // forwarding.
            (found.color, found.normal) = (mean.color, mean.normal);
        }
        num_rows
    }

    /// Sweeps a plan under each sun that texels are seen by from near.
    fn sweep_sunlit<S: Show<3>>(
        &self,
        plan: &Plan,
        show: impl Fn(PatchSun<'a>) -> S,
        (profile, pixels): (&mut Profile<3>, &[PixelOnLines]),
        totals: &mut [Totals],
    ) -> u64 {
        let mut num_rows = 0;
        for sunlit in self.sunlit {
            let sun = PatchSun::new(sunlit, self.surface, plan.frame.is_turned);
            let plan = plan.on(sunlit.surface().base());
            num_rows += plan.run(&show(sun), profile, (pixels, &[]), totals);
        }
        totals.iter_mut().for_each(|totals| totals.are_parts(self.sunlit.len()));
        num_rows
    }
}
