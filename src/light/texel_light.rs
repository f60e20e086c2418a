//! What light leaves on the texels of a relief: sums over its beams, each swept over the whole surface.

use super::beams::Beam;
use crate::relief::{LitParts, RowScratch};
use crate::simd::TexelLanes;
use crate::texture::{Level, Surface, unpack_normals};
use glam::Vec3;
use rayon::prelude::*;

/// What light leaves on a white surface, texel by texel.
#[derive(Debug)]
pub(super) struct TexelLight([Sums; 2]);

/// Where the edge of a sun's shadow lies, texel by texel; see [`LitParts::edges`].
#[derive(Debug)]
pub(super) struct ShadowEdges([Sums; 2]);

/// The light of a sun.
#[derive(Debug)]
pub(super) struct SunLight {
    pub(super) light: TexelLight,
    /// The mean direction of its beams, and all their light.
    pub(super) to_sun: Vec3,
    pub(super) intensity: Vec3,
    pub(super) edges: ShadowEdges,
}

impl TexelLight {
    /// Of a light's beams.
    pub(super) fn new(surface: &Surface, beams: &[Beam]) -> Self {
        Self(summed(surface, beams, true))
    }

    /// Linear RGB at a column and row.
    pub(super) fn at(&self, x: usize, y: usize) -> [f32; 3] {
        both(&self.0, x, y)
    }
}

impl SunLight {
    /// Of a sun's beams, if there are any.
    pub(super) fn new(surface: &Surface, beams: &[Beam]) -> Option<Self> {
        if beams.is_empty() {
            return None;
        }
        let (edges, light) = ShadowEdges::new(surface, beams);
        let share = 1.0 / intensity(beams);
        let to_sun = beams.iter().map(|b| b.to_light * (b.intensity.element_sum() * share)).sum();
        let intensity = beams.iter().map(|beam| beam.intensity).sum();
        Some(Self { light, to_sun, intensity, edges })
    }
}

impl ShadowEdges {
    /// The lowest height of an edge that is told from lower ones.
    pub(super) const LOWEST: f32 = -1.0;

    /// Those of a sun's beams, and its light: both are found by the same sweeps.
    pub(super) fn new(surface: &Surface, beams: &[Beam]) -> (Self, TexelLight) {
        let [mut edges, mut sums] = [0; 2].map(|_| Sums::pair(surface));
        let all = intensity(beams);
        for (beam, lit) in swept(surface, beams) {
            let share = beam.intensity.element_sum() / all;
            edges[usize::from(lit.is_turned)].add_edges(&lit, share);
            sums[usize::from(lit.is_turned)].add(surface.base(), beam, &lit, true);
        }
        (Self(edges), TexelLight(sums))
    }

    /// The middle of the edge and its width at a column and row: that of an even spread as wide as
    /// those of the beams.
    pub(super) fn at(&self, x: usize, y: usize) -> [f32; 2] {
        let [mean, square, least] = both(&self.0, x, y);
        let width = (12.0 * (square - mean * mean).max(0.0)).sqrt();
        [mean, width.max(least)]
    }
}

/// The light of all beams, all channels together.
fn intensity(beams: &[Beam]) -> f32 {
    beams.iter().fold(0.0, |sum, beam| sum + beam.intensity.element_sum())
}

/// The part of suns' light that reaches a surface's texels over its relief, by column and row.
pub(crate) fn lit_parts(
    surface: &Surface,
    beams: &[Beam],
) -> impl Fn(usize, usize) -> f32 + Sync + use<> {
    let all = intensity(beams);
    let share = |beam: &Beam| Vec3::splat(beam.intensity.element_sum() / all);
    let beams: Vec<_> = beams.iter().map(|b| Beam { intensity: share(b), ..*b }).collect();
    let sums = summed(surface, &beams, false);
    move |x, y| both(&sums, x, y)[0]
}

/// The light of beams at each texel, by its cosine to the texels' normals if wanted.
fn summed(surface: &Surface, beams: &[Beam], by_cosine: bool) -> [Sums; 2] {
    let mut sums = Sums::pair(surface);
    for (beam, lit) in swept(surface, beams) {
        sums[usize::from(lit.is_turned)].add(surface.base(), beam, &lit, by_cosine);
    }
    sums
}

/// Beams, each with what it reaches of the base level.
fn swept<'a>(
    surface: &'a Surface,
    beams: &'a [Beam],
) -> impl Iterator<Item = (&'a Beam, LitParts<'a>)> {
    beams.iter().map(|beam| {
        let displacement = beam.slope.map(|slope| slope * surface.relief_depth());
        (beam, LitParts::new(surface.base(), displacement, surface.relief_depth()))
    })
}

/// Three numbers of each texel, by rows along u or along v.
#[derive(Debug)]
struct Sums {
    width: usize,
    /// A row's, in whole vectors.
    lanes: Vec<[TexelLanes; 3]>,
}

/// The sums of both at a column and row.
fn both([along_u, along_v]: &[Sums; 2], x: usize, y: usize) -> [f32; 3] {
    let [a, b] = [along_u.at(x, y), along_v.at(y, x)];
    std::array::from_fn(|i| a[i] + b[i])
}

impl Sums {
    /// Those by rows along u and along v, to be added up.
    fn pair(surface: &Surface) -> [Self; 2] {
        let [width, height] = surface.base().size();
        [[width, height], [height, width]].map(|[width, height]| {
            let lanes = vec![[TexelLanes::ZERO; 3]; width.div_ceil(8) * height];
            Self { width, lanes }
        })
    }

    /// Adds a beam's light, by its cosine to the texels' normals if wanted.
    fn add(&mut self, level: &Level, beam: &Beam, lit: &LitParts, by_cosine: bool) {
        let rows = level.rows(lit.is_turned);
        let pitch = self.width.div_ceil(8);
        let [x, y, z] = beam.to_light.to_array();
        self.lanes.par_chunks_exact_mut(pitch).enumerate().for_each_init(
            Default::default,
            |(scratch, parts): &mut (RowScratch, Vec<f32>), (row, sums)| {
                lit.row(row, scratch, parts);
                for (i, (sums, parts)) in sums.iter_mut().zip(parts.chunks_exact(8)).enumerate() {
                    let cos = match rows.normals(i * 8, row) {
                        _ if !by_cosine => TexelLanes::ONE,
                        Some(words) => {
                            let [nx, ny, nz] = unpack_normals(words);
                            (nx * x + ny * y + nz * z).fast_max(TexelLanes::ZERO)
                        }
                        None => TexelLanes::splat(z),
                    };
                    let parts: [f32; 8] = parts.try_into().expect("eight");
                    let lit = cos * TexelLanes::new(parts);
                    for (sum, intensity) in sums.iter_mut().zip(beam.intensity.to_array()) {
                        *sum += lit * intensity;
                    }
                }
            },
        );
    }

    /// Adds a share of a shadow's edges: their heights, the squares of these, and their least widths.
    fn add_edges(&mut self, lit: &LitParts, share: f32) {
        let pitch = self.width.div_ceil(8);
        self.lanes.par_chunks_exact_mut(pitch).enumerate().for_each_init(
            Default::default,
            |(scratch, edges): &mut (RowScratch, Vec<_>), (row, sums)| {
                lit.edges(row, scratch, edges);
                for (sums, [height, least_width]) in sums.iter_mut().zip(edges) {
                    let height = height.fast_max(TexelLanes::splat(ShadowEdges::LOWEST));
                    sums[0] += height * share;
                    sums[1] += height * height * share;
                    sums[2] += *least_width * share;
                }
            },
        );
    }

    fn at(&self, x: usize, y: usize) -> [f32; 3] {
        self.lanes[y * self.width.div_ceil(8) + x / 8].map(|lanes| lanes.as_array()[x % 8])
    }
}
