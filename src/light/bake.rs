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
//! suns and skies.

use super::disc::{Disc, spiral};
use super::surface_point::unit_axes;
use crate::relief::{LitParts, MAX_SLOPE, RowScratch};
use crate::scene::{Light, Sky};
use crate::simd::TexelLanes;
use crate::texture::{Level, Normals, Surface, unpack_normals};
use glam::Vec3;
use rayon::prelude::*;

/// Directions that the sky is seen in, over the half space above a polygon: each stands for the
/// same share of what lights it.
const SKY_DIRECTIONS: usize = 128;

/// Points of a sun's disc for each half degree of its size, and the most of them. A shadow of the
/// real sun goes in so many steps from light to dark, each of which is as wide as what cuts it off
/// at the texels.
const SUN_POINTS: [f32; 2] = [16.0, 64.0];

/// The frame of a texture on a flat piece of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureFrame {
    /// dP/du and dP/dv, in world units a repeat.
    pub tangents: [Vec3; 2],
    /// Unit normal on the side that is seen.
    pub normal: Vec3,
}

/// Light from one direction, as a texture sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Unit direction to the light: along u, along v, off the surface.
    pub to_light: Vec3,
    /// Repeats that light moves along the texture for each repeat that it goes down.
    pub slope: [f32; 2],
    /// Linear RGB; a white texel that faces 1 is white.
    pub intensity: Vec3,
}

impl TextureFrame {
    /// A direction as the axes see it, u and v of unit length: what normals are held against.
    pub(super) fn local(&self, direction: Vec3) -> Vec3 {
        Vec3::from(unit_axes(self.tangents, self.normal).map(|axis| axis.dot(direction)))
    }

    /// Light from a unit direction; `None` from behind the surface.
    pub fn beam(&self, to_light: Vec3, intensity: Vec3) -> Option<Beam> {
        let [u, v] = self.tangents;
        // Cramer's rule, as for views: to_light = alpha U + beta V + up s N.
        let across = u.cross(v);
        let volume = self.normal.dot(across);
        let up = across.dot(to_light) / (across.length().sqrt() * volume);
        let local = self.local(to_light);
        if local.z <= 0.0 || intensity == Vec3::ZERO {
            return None;
        }
        let along = [v.cross(self.normal), self.normal.cross(u)].map(|w| w.dot(to_light) / volume);
        let slope = along.map(|along| -along / up.abs());
        let steepness = (slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
        // As views are, so that no walk is longer than what they walk.
        let scale = if steepness > MAX_SLOPE { MAX_SLOPE / steepness } else { 1.0 };
        let slope = slope.map(|slope| slope * scale);
        let is_finite = slope.iter().all(|slope| slope.is_finite());
        Some(Beam { to_light: local, slope: if is_finite { slope } else { [0.0; 2] }, intensity })
    }

    /// The beams of suns and a sky on a surface with this frame; points come from another direction at
    /// each place, and have none.
    pub fn beams(&self, lights: &[Light], sky: &Sky) -> Vec<Beam> {
        let mut beams = Vec::new();
        for light in lights {
            if let Light::Sun { to_light, intensity, angular_size } = *light {
                beams.extend(self.sun(to_light.normalize_or_zero(), intensity, angular_size));
            }
        }
        beams.extend(self.sky(sky));
        beams
    }

    /// Beams from points spread evenly over a sun's disc.
    fn sun(&self, to_sun: Vec3, intensity: Vec3, degrees: f32) -> Vec<Beam> {
        let [per_half, most] = SUN_POINTS;
        let num = (degrees * 2.0 * per_half).ceil().clamp(1.0, most) as usize;
        let points = Disc::new(to_sun, degrees).points(num);
        points.filter_map(|to_light| self.beam(to_light, intensity / num as f32)).collect()
    }

    /// Beams from all over the sky.
    fn sky(&self, sky: &Sky) -> Vec<Beam> {
        let beams =
            self.half_space().map(|(to_light, share)| (to_light, sky.radiance(to_light) * share));
        beams.filter_map(|(to_light, intensity)| self.beam(to_light, intensity)).collect()
    }

    /// Directions all over the half space above the surface, as dense as their cosine to it, each with
    /// the part of that space that it stands for, over pi: one that is `cos` off the normal stands for
    /// `1 / cos` of what a texel sees that faces it. They come in pairs that lie opposite each other, so
    /// that what a slope gains by one it loses by the other.
    fn half_space(&self) -> impl Iterator<Item = (Vec3, f32)> {
        let [x, y] = <[Vec3; 2]>::from(self.normal.any_orthonormal_pair());
        spiral(SKY_DIRECTIONS / 2).flat_map(move |(turn, share)| {
            let ([cos, sin], share) = (turn.map(|c| c as f32), share as f32);
            let up = (1.0 - share).sqrt();
            [[cos, sin], [-cos, -sin]].map(|[cos, sin]| {
                let direction = (x * cos + y * sin) * share.sqrt() + self.normal * up;
                (direction, 1.0 / (SKY_DIRECTIONS as f32 * up))
            })
        })
    }
}

/// The surface lit by beams of suns and of the sky; it needs no normals any more. `shares` gives the
/// part of each of the two that a texel shows, where it is not all.
pub fn baked(
    surface: &Surface,
    [suns, sky]: [&[Beam]; 2],
    shares: Option<&(dyn Fn(usize, usize) -> [f32; 2] + Sync)>,
) -> Surface {
    let Some(shares) = shares else {
        let [along_u, along_v] = summed(surface, &[suns, sky].concat(), true);
        return surface.with_colors(Normals::Dropped, |x, y, albedo| {
            std::array::from_fn(|c| albedo[c] * (along_u.at(x, y)[c] + along_v.at(y, x)[c]))
        });
    };
    let sums = [suns, sky].map(|beams| summed(surface, beams, true));
    surface.with_colors(Normals::Dropped, |x, y, albedo| {
        let of =
            |[along_u, along_v]: &[Sums; 2], c: usize| along_u.at(x, y)[c] + along_v.at(y, x)[c];
        let [of_suns, of_sky] = shares(x, y);
        std::array::from_fn(|c| albedo[c] * (of(&sums[0], c) * of_suns + of(&sums[1], c) * of_sky))
    })
}

/// The part of suns' light that reaches a surface's texels over its relief, by column and row.
pub(crate) fn lit_parts(
    surface: &Surface,
    beams: &[Beam],
) -> impl Fn(usize, usize) -> f32 + Sync + use<> {
    let all = beams.iter().fold(0.0, |sum, beam| sum + beam.intensity.element_sum());
    let share = |beam: &Beam| Vec3::splat(beam.intensity.element_sum() / all);
    let beams: Vec<_> = beams.iter().map(|b| Beam { intensity: share(b), ..*b }).collect();
    let [along_u, along_v] = summed(surface, &beams, false);
    move |x, y| along_u.at(x, y)[0] + along_v.at(y, x)[0]
}

/// The mean direction of what each texel sees of the half space above a flat piece of a surface,
/// `1/pi int V l dl`, texel by texel along u.
pub(super) fn openings(surface: &Surface, frame: &TextureFrame) -> Vec<[f32; 3]> {
    let beams = frame.half_space().filter_map(|(direction, share)| {
        let beam = frame.beam(direction, Vec3::ONE)?;
        Some(Beam { intensity: beam.to_light * share, ..beam })
    });
    let [along_u, along_v] = summed(surface, &beams.collect::<Vec<_>>(), false);
    let [width, height] = surface.base().size();
    let texel = |i: usize| {
        let [a, b] = [along_u.at(i % width, i / width), along_v.at(i / width, i % width)];
        std::array::from_fn(|c| a[c] + b[c])
    };
    (0..width * height).map(texel).collect()
}

/// The light of beams at each texel: by rows along u and along v, to be added up.
fn summed(surface: &Surface, beams: &[Beam], by_cosine: bool) -> [Sums; 2] {
    let level = surface.base();
    let [width, height] = level.size();
    let mut sums = [Sums::new([width, height]), Sums::new([height, width])];
    for beam in beams {
        let displacement = beam.slope.map(|slope| slope * surface.relief_depth());
        let lit = LitParts::new(level, displacement, surface.relief_depth());
        sums[usize::from(lit.is_turned)].add(level, beam, &lit, by_cosine);
    }
    sums
}

/// What lights a white surface at each texel, row by row.
struct Sums {
    width: usize,
    /// A row's reds, greens and blues, in whole vectors.
    lanes: Vec<[TexelLanes; 3]>,
}

impl Sums {
    fn new([width, height]: [usize; 2]) -> Self {
        let lanes = vec![[TexelLanes::ZERO; 3]; width.div_ceil(8) * height];
        Self { width, lanes }
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

    fn at(&self, x: usize, y: usize) -> [f32; 3] {
        self.lanes[y * self.width.div_ceil(8) + x / 8].map(|lanes| lanes.as_array()[x % 8])
    }
}
