//! Lights as eight pixels of a curved surface see them.

use super::disc::spiral;
use super::sky_shares::{Layer, SkyShares};
use super::vectors::{Vectors, cross, dot, repeat_length};
use crate::relief::finite;
use crate::scene::Eye;
use crate::simd::PixelLanes;
use glam::Vec3;

/// The frame of a texture at eight pixels.
#[derive(Clone, Copy, Debug)]
pub struct FrameLanes {
    /// dP/du and dP/dv, in world units a repeat.
    tangents: [Vectors; 2],
    /// The unit axes, as [`unit_axes`](super::unit_axes), on the eye's side.
    pub axes: [Vectors; 3],
    /// Lanes that show the back.
    pub is_back: PixelLanes,
}

/// Light from one direction at eight pixels, as a texture sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Slant {
    /// Unit direction to the light: along u, along v, off the surface.
    pub to_light: Vectors,
    /// How high it comes in: see [`Horizons`](super::Horizons); below 0 from behind.
    pub height: PixelLanes,
    /// Where it comes from along the texture, in repeats, of any length.
    pub along: [PixelLanes; 2],
}

/// The ways from eight pixels to a point that shines.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ways {
    /// From the polygon: along u, along v and off the surface, in world units.
    pub to_light: Vectors,
    /// The same along u and v in repeats, and up in the texture's own lengths.
    pub along: Vectors,
    /// What both lose on the view ray's way from the polygon to the deepest relief.
    pub down: [Vectors; 2],
}

/// The lights on a curved surface. Colours are then lit, but for what is reflected.
#[derive(Clone, Copy, Debug)]
pub struct Curved<'a> {
    /// The suns.
    pub suns: &'a [CurvedSun],
    /// What of the sky gets to the lanes of each vector past all meshes, in the world's axes; nothing
    /// where the sky is not one of the lights.
    pub skies: &'a [[LinearSky; 8]],
    /// How each vector of pixels lies.
    pub frames: &'a [FrameLanes],
    /// How each sun shines on the first vector, on the second, and so on.
    pub slants: &'a [Slant],
    /// Points that shine: linear RGB at a distance of one world unit.
    pub points: &'a [Vec3],
    /// The ways to each of them from the first vector, from the second, and so on.
    pub ways: &'a [Ways],
    /// Of a glossy surface, what the eye makes of them.
    pub shine: Option<Shine<'a>>,
}

/// What a glossy surface shows.
#[derive(Clone, Copy, Debug)]
pub enum Sheen {
    /// What it reflects.
    Luster(Luster),
    /// Its diffuse layer, through what lies above.
    Layer(Layer),
}

/// How a surface reflects whose colours are what it does of light that comes straight.
#[derive(Clone, Copy, Debug)]
pub struct Luster {
    /// `a^2` of the roughness; `None` where texels have their own, in the
    /// [length](super::rough_length) of their normals.
    pub alpha_squared: Option<f32>,
    /// What it reflects of light along it, and the value of its greatest colour.
    pub grazing: f32,
    pub color_scale: f32,
    /// What it reflects of the sky.
    pub sky: SkyShares,
}

/// What that depends on beside the lights.
#[derive(Clone, Copy, Debug)]
pub struct Shine<'a> {
    /// What is shown.
    pub sheen: Sheen,
    /// Unit directions to the eye from each vector of pixels: along u, along v, off the surface.
    pub to_eyes: &'a [Vectors],
}

/// A sun on a curved surface.
#[derive(Clone, Copy, Debug)]
pub struct CurvedSun {
    /// Linear RGB; a white texel that faces 1 is white.
    pub intensity: Vec3,
    /// The tangent of half its size.
    pub radius: f32,
}

impl<'a> Curved<'a> {
    /// Whether what is reflected of lights is shown, and nothing else.
    pub(crate) fn is_shiny(&self) -> bool {
        matches!(self.shine, Some(Shine { sheen: Sheen::Luster(_), .. }))
    }

    /// How a sun shines on a vector of pixels.
    pub(crate) fn slant(&self, vector: usize, sun: usize) -> &'a Slant {
        &self.slants[vector * self.suns.len() + sun]
    }

    /// The ways from a vector of pixels to a point.
    pub(crate) fn ways(&self, vector: usize, point: usize) -> &'a Ways {
        &self.ways[vector * self.points.len() + point]
    }

    /// The sky at a picked pixel: vector times 8 plus lane.
    pub(crate) fn sky(&self, pick: u8) -> &'a LinearSky {
        &self.skies[usize::from(pick / 8)][usize::from(pick % 8)]
    }

    /// The normal at a picked pixel.
    pub(crate) fn normal(&self, pick: u8) -> Vec3 {
        let lanes = &self.frames[usize::from(pick / 8)].axes[2];
        Vec3::from(lanes.map(|c| c.as_array()[usize::from(pick % 8)]))
    }

    /// The mean axes of picked pixels: vector times 8 plus lane.
    pub(crate) fn mean_axes(&self, picks: &[u8]) -> [Vec3; 3] {
        let axes = picks.iter().map(|pick| {
            let lane = usize::from(pick % 8);
            self.frames[usize::from(pick / 8)]
                .axes
                .map(|axis| Vec3::from(axis.map(|c| c.as_array()[lane])))
        });
        axes.fold([Vec3::ZERO; 3], |sum, axes| std::array::from_fn(|i| sum[i] + axes[i]))
            .map(Vec3::normalize_or_zero)
    }

    /// Those of so many vectors from one on.
    pub(crate) fn part(&self, first: usize, num: usize) -> Self {
        let (suns, points) = (self.suns.len(), self.points.len());
        Self {
            frames: &self.frames[first..first + num],
            skies: self.skies.get(first..first + num).unwrap_or_default(),
            slants: &self.slants[first * suns..(first + num) * suns],
            ways: &self.ways[first * points..(first + num) * points],
            shine: self
                .shine
                .map(|shine| Shine { to_eyes: &shine.to_eyes[first..first + num], ..shine }),
            ..*self
        }
    }
}

/// What comes from the directions that a surface sees, as `constant + slopes . l` of a unit
/// direction `l`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinearSky {
    /// Linear RGB.
    pub constant: Vec3,
    /// The same, by axis.
    pub slopes: [Vec3; 3],
}

impl FrameLanes {
    /// At points with normals and tangents of any length, some seen from behind.
    pub fn new(normal: &Vectors, tangents: &[Vectors; 2], is_back: PixelLanes) -> Self {
        let normal = unit(normal).map(|c| is_back.select(-c, c));
        let [u, v] = tangents;
        let along = dot(u, &normal);
        let u = unit(&[0, 1, 2].map(|i| u[i] - normal[i] * along));
        let across = cross(&normal, &u);
        let is_turned = dot(&across, v).simd_lt(PixelLanes::ZERO);
        let across = across.map(|c| is_turned.select(-c, c));
        Self { tangents: *tangents, axes: [u, across, normal], is_back }
    }

    /// The ways from pixels at `position` to a point. Down to the deepest relief their view rays
    /// move so many repeats along the texture, and `relief_depth` down.
    pub fn ways(
        &self,
        position: &Vectors,
        light: Vec3,
        (moved, relief_depth): ([PixelLanes; 2], f32),
    ) -> Ways {
        let way = [0, 1, 2].map(|i| PixelLanes::splat(light[i]) - position[i]);
        let ([u, v], normal) = (self.tangents, self.axes[2]);
        let across = cross(&u, &v);
        let inverse = PixelLanes::ONE / dot(&normal, &across);
        let repeat = repeat_length(&across);
        let up = dot(&across, &way) / repeat * inverse;
        let along = [cross(&v, &normal), cross(&normal, &u)].map(|w| dot(&w, &way) * inverse);
        let down = repeat * -relief_depth;
        let ray = [0, 1, 2].map(|i| u[i] * moved[0] + v[i] * moved[1] + normal[i] * down);
        let in_texture = [moved[0], moved[1], PixelLanes::splat(-relief_depth)];
        Ways {
            to_light: self.axes.map(|axis| dot(&axis, &way)),
            along: [along[0], along[1], up].map(finite),
            down: [self.axes.map(|axis| dot(&axis, &ray)), in_texture],
        }
    }

    /// Unit directions to the eye from pixels at `position`: along u, along v, off the surface.
    pub fn to_eye(&self, position: &Vectors, eye: Eye) -> Vectors {
        let way = [0, 1, 2].map(|i| PixelLanes::splat(eye.place[i]) - position[i] * eye.share);
        let way = unit(&way);
        self.axes.map(|axis| dot(&axis, &way))
    }

    /// Light from a unit direction.
    pub fn slant(&self, direction: Vec3) -> Slant {
        let direction = direction.to_array().map(PixelLanes::splat);
        let ([u, v], normal) = (self.tangents, self.axes[2]);
        // Cramer's rule, as for views: to_light = alpha U + beta V + up s N.
        let across = cross(&u, &v);
        let volume = dot(&normal, &across);
        let up = dot(&across, &direction) / (repeat_length(&across) * volume);
        let along = [cross(&v, &normal), cross(&normal, &u)].map(|w| dot(&w, &direction) / volume);
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        Slant {
            to_light: self.axes.map(|axis| dot(&axis, &direction)),
            height: finite(up / (up.abs() + length)),
            along: along.map(finite),
        }
    }
}

impl LinearSky {
    /// The nearest to what comes from unit directions over the half space around a unit normal,
    /// weighed by the cosine to it.
    pub fn new(normal: Vec3, from: impl Fn(Vec3) -> Vec3) -> Self {
        /// Pairs of directions that lie opposite each other.
        const PAIRS: usize = 32;
        let [x, y] = <[Vec3; 2]>::from(normal.any_orthonormal_pair());
        let mut sums = [Vec3::ZERO; 4];
        for (turn, share) in spiral(PAIRS) {
            let [cos, sin] = turn.map(|c| c as f32 * (share as f32).sqrt());
            let up = (1.0 - share as f32).sqrt();
            for [cos, sin] in [[cos, sin], [-cos, -sin]] {
                let color = from(x * cos + y * sin + normal * up) * (0.5 / PAIRS as f32);
                let of = [1.0, cos, sin, up];
                sums.iter_mut().zip(of).for_each(|(sum, of)| *sum += color * of);
            }
        }
        // Means of products of the four over such directions: 1, 1/4, 1/4, 1/2, and 2/3 of 1 and up.
        let [all, of_x, of_y, up] = sums;
        let of_up = (up - all * (2.0 / 3.0)) * 18.0;
        let (of_x, of_y) = (of_x * 4.0, of_y * 4.0);
        let slopes = [0, 1, 2].map(|i| of_x * x[i] + of_y * y[i] + of_up * normal[i]);
        Self { constant: all - of_up * (2.0 / 3.0), slopes }
    }

    /// The sum of some by their shares.
    pub fn blend(terms: impl Iterator<Item = (Self, f32)>) -> Self {
        terms.fold(Self::default(), |sum, (sky, share)| Self {
            constant: sum.constant + sky.constant * share,
            slopes: [0, 1, 2].map(|i| sum.slopes[i] + sky.slopes[i] * share),
        })
    }

    /// The same in other axes.
    pub fn turned(&self, axes: [Vec3; 3]) -> Self {
        let [x, y, z] = self.slopes;
        let slopes = axes.map(|axis| x * axis.x + y * axis.y + z * axis.z);
        Self { constant: self.constant, slopes }
    }

    /// What it lights a white surface with a unit normal to.
    pub fn irradiance(&self, normal: Vec3) -> Vec3 {
        let [x, y, z] = self.slopes;
        self.constant + (x * normal.x + y * normal.y + z * normal.z) * (2.0 / 3.0)
    }
}

fn unit(v: &Vectors) -> Vectors {
    let length = dot(v, v).sqrt().max(PixelLanes::splat(1e-30));
    v.map(|c| c / length)
}
