//! The one place that tells the filters apart.

use super::batch::{Batch, Filtered, LevelChoice, Work, each_covered};
use super::horizon::{self, HorizonScratch};
use super::prepared::Prepared;
use super::traits::Reads;
use super::visible::{self, TexelSet};
use super::{ewa, parallax, points, trilinear, truth};
use crate::footprint::{Footprint, Footprints, levels};
use crate::settings::{Filter, Rays};
use crate::texture::FULL_F32;

/// Buffers of the filters, kept between calls.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    horizon: HorizonScratch,
    set: TexelSet,
}

impl Filter {
    /// The means of a batch's covered pixels, into `out`, which has a vector for each of the
    /// batch's.
    ///
    /// A pixel of [`Self::Truth`], and of [`Self::Parallax`] with more than one ray, is the mean
    /// over [samples](super::Traits::samples) of it; each sample is a footprint of its own here.
    pub fn colors(
        &self,
        prepared: &Prepared,
        batch: &Batch,
        scratch: &mut Scratch,
        out: &mut [Filtered],
    ) -> Work {
        let surface = prepared.surface();
        match self {
            Self::Nearest => {
                each_covered(batch, out, |pixels, lane| {
                    points::nearest(surface.base(), pixels.lane(lane).hit)
                });
                Work::default()
            }
            Self::Bilinear => {
                each_covered(batch, out, |pixels, lane| {
                    points::bilinear(surface.base(), pixels.lane(lane).hit)
                });
                Work::default()
            }
            Self::Trilinear(_) => {
                trilinear::colors(surface, batch, out);
                Work::default()
            }
            Self::Ewa(ewa) => ewa::colors(surface, batch, ewa, out),
            Self::Visible(visible) => {
                visible::colors(surface, batch, visible, &mut scratch.set, out)
            }
            Self::Horizon(horizon) => {
                horizon::colors(prepared, batch, horizon, &mut scratch.horizon, out)
            }
            Self::Parallax(Rays { samples }) => {
                parallax::colors(prepared, batch, *samples, out);
                Work::default()
            }
            Self::Truth(_) => {
                each_covered(batch, out, |pixels, lane| {
                    truth::sample(surface, pixels.lane(lane).hit)
                });
                Work::default()
            }
        }
    }

    /// What [`Self::colors`] reads for each of a batch's pixels.
    pub fn levels(
        &self,
        prepared: &Prepared,
        pixels: &[Footprints],
        is_lit: bool,
        scratch: &mut Scratch,
    ) -> Vec<[LevelChoice; 8]> {
        let surface = prepared.surface();
        let last = surface.last_level();
        // Beyond the last level there is none to blend with.
        let blended = |(level, blend): (usize, f32)| LevelChoice {
            level: level.min(last),
            blend: if level >= last { 0.0 } else { blend },
            far_share: 0.0,
        };
        let of_level = |level| LevelChoice { level, ..LevelChoice::default() };
        let each = |of_lane: &dyn Fn(&Footprints, usize) -> LevelChoice| {
            pixels.iter().map(|pixels| std::array::from_fn(|lane| of_lane(pixels, lane))).collect()
        };
        match self {
            Self::Nearest | Self::Bilinear | Self::Truth(_) => each(&|_, _| of_level(0)),
            Self::Trilinear(_) => each(&|pixels, lane| {
                blended(levels::of_size(
                    levels::longest_sides(surface.base(), pixels).as_array()[lane],
                ))
            }),
            Self::Ewa(ewa) => {
                each(&|pixels, lane| of_level(ewa::level(surface, pixels, lane, ewa)))
            }
            Self::Visible(visible) => each(&|pixels, lane| {
                of_level(
                    levels::within_budget(
                        surface,
                        &pixels.lane(lane),
                        &visible::ellipse_rule(visible),
                    )
                    .0,
                )
            }),
            Self::Horizon(horizon) => {
                horizon::levels(prepared, (pixels, is_lit), horizon, &mut scratch.horizon)
            }
            Self::Parallax(Rays { samples }) => each(&|pixels, lane| {
                let sizes = levels::parallax_sizes(surface.base(), pixels, *samples);
                blended(levels::of_size(sizes.as_array()[lane]))
            }),
        }
    }

    /// [`Self::levels`] of one pixel by itself, unlit.
    pub fn level(&self, prepared: &Prepared, footprint: &Footprint) -> LevelChoice {
        self.levels(prepared, &[Footprints::splat(footprint)], false, &mut Scratch::default())[0][0]
    }
}

impl Prepared {
    /// Makes now what a filter would make when it is first asked for a colour.
    pub fn make_ready(&self, filter: &Filter, is_lit: bool) {
        self.field();
        match filter.traits().reads {
            Reads::TexelsAlone => {}
            Reads::Cells => drop(self.cells()),
            // Lights are asked for each texel, which neither serves.
            Reads::Seen { .. } if is_lit => {}
            Reads::Seen { far_field_mib } => {
                if let Some(loss) = self.level_loss() {
                    loss.measure_all(self.surface());
                }
                far_field_mib.map(|mib| self.far_field(mib));
            }
        }
    }

    /// The linear RGB, unlit, of pixels by a filter, each by itself: a colour does not depend on
    /// what else is given.
    pub fn colors(&self, filter: &Filter, footprints: &[Footprint]) -> Vec<[f32; 3]> {
        let pixels: Vec<_> = footprints.chunks(8).map(Footprints::pack).collect();
        let mut filtered = vec![Filtered::default(); pixels.len()];
        let batch = Batch { pixels: &pixels, is_alone: true, ..Batch::default() };
        filter.colors(self, &batch, &mut Scratch::default(), &mut filtered);
        let scale = self.surface().color_scale() / FULL_F32;
        (0..footprints.len())
            .map(|i| filtered[i / 8].lane(i % 8).color.map(|c| c * scale))
            .collect()
    }
}
