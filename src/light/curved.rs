//! Lights as eight pixels of a curved surface see them.

use super::disc::spiral;
use crate::scene::Sky;
use crate::simd::PixelLanes;
use glam::Vec3;

/// Three coordinates of eight pixels.
type Vectors = [PixelLanes; 3];

/// The frame of a texture at eight pixels.
#[derive(Clone, Copy, Debug)]
pub struct FrameLanes {
    /// dP/du and dP/dv, in world units a repeat.
    tangents: [Vectors; 2],
    /// The unit axes: along u, along v, and off the surface on the eye's side.
    pub axes: [Vectors; 3],
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

/// The lights on a curved surface. Colours are then lit, but for what is reflected.
#[derive(Clone, Copy, Debug)]
pub struct Curved<'a> {
    /// The suns.
    pub suns: &'a [CurvedSun],
    /// The sky, if it is one of them.
    pub sky: Option<&'a Sky>,
    /// How each vector of pixels lies.
    pub frames: &'a [FrameLanes],
    /// How each sun shines on the first vector, on the second, and so on.
    pub slants: &'a [Slant],
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
    /// How a sun shines on a vector of pixels.
    pub(crate) fn slant(&self, vector: usize, sun: usize) -> &'a Slant {
        &self.slants[vector * self.suns.len() + sun]
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
        let suns = self.suns.len();
        Self {
            frames: &self.frames[first..first + num],
            slants: &self.slants[first * suns..(first + num) * suns],
            ..*self
        }
    }
}

impl FrameLanes {
    /// At points with normals and tangents of any length, seen from `eye`.
    pub fn new(position: &Vectors, normal: &Vectors, tangents: &[Vectors; 2], eye: Vec3) -> Self {
        let to_eye = [0, 1, 2].map(|i| PixelLanes::splat(eye[i]) - position[i]);
        let is_behind = dot(normal, &to_eye).simd_lt(PixelLanes::ZERO);
        let normal = unit(normal).map(|c| is_behind.select(-c, c));
        let [u, v] = tangents.map(|t| {
            let along = dot(&t, &normal);
            unit(&[0, 1, 2].map(|i| t[i] - normal[i] * along))
        });
        Self { tangents: *tangents, axes: [u, v, normal] }
    }

    /// Light from a unit direction.
    pub fn slant(&self, direction: Vec3) -> Slant {
        let direction = direction.to_array().map(PixelLanes::splat);
        let ([u, v], normal) = (self.tangents, self.axes[2]);
        // Cramer's rule, as for views: to_light = alpha U + beta V + up s N.
        let across = cross(&u, &v);
        let volume = dot(&normal, &across);
        let up = dot(&across, &direction) / (dot(&across, &across).sqrt().sqrt() * volume);
        let along = [cross(&v, &normal), cross(&normal, &u)].map(|w| dot(&w, &direction) / volume);
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        Slant {
            to_light: self.axes.map(|axis| dot(&axis, &direction)),
            height: finite(up / (up.abs() + length)),
            along: along.map(finite),
        }
    }
}

fn finite(lanes: PixelLanes) -> PixelLanes {
    lanes.is_finite().select(lanes, PixelLanes::ZERO)
}

/// What a sky sends to a place whose unit axes are given, as `c0 + c.l` of a unit direction `l` in
/// them: the nearest of that form over the half space, weighed by the cosine.
pub fn linear_sky(sky: &Sky, axes: [Vec3; 3]) -> [Vec3; 4] {
    if let Sky::Color(color) = sky {
        return [*color, Vec3::ZERO, Vec3::ZERO, Vec3::ZERO];
    }
    const PAIRS: usize = 32;
    let mut sums = [Vec3::ZERO; 4];
    let [x_axis, y_axis] = <[Vec3; 2]>::from(axes[2].any_orthonormal_pair());
    for (turn, share) in spiral(PAIRS) {
        let [cos, sin] = turn.map(|c| c as f32);
        let share = share as f32;
        let up = (1.0 - share).sqrt();
        for sign in [1.0, -1.0] {
            let across = (x_axis * cos + y_axis * sin) * (share.sqrt() * sign);
            let direction = across + axes[2] * up;
            let color = sky.radiance(direction) * (0.5 / PAIRS as f32);
            let of = [1.0, axes[0].dot(across), axes[1].dot(across), up];
            sums.iter_mut().zip(of).for_each(|(sum, of)| *sum += color * of);
        }
    }
    // Means of products of the four over such directions: 1, 1/4, 1/4, 1/2, and 2/3 of 1 and up.
    let [all, x, y, up] = sums;
    let of_up = (up - all * (2.0 / 3.0)) * 18.0;
    [all - of_up * (2.0 / 3.0), x * 4.0, y * 4.0, of_up]
}

fn unit(v: &Vectors) -> Vectors {
    let length = dot(v, v).sqrt().max(PixelLanes::splat(1e-30));
    v.map(|c| c / length)
}

fn cross(a: &Vectors, b: &Vectors) -> Vectors {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: &Vectors, b: &Vectors) -> PixelLanes {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
