//! Where the pixels of a pair are in the world, and where their rays to lights start.
//!
//! ```text
//!                 / / /       to points of a light
//!      ---------/-/-/-------  polygon
//!        ______p_p_p____      relief: each ray starts where its own view ray meets it
//! ```

use crate::light::{SmoothTriangle, Vectors, cross, dot, repeat_length};
use crate::raster::{LitLanes, QuadPair};
use crate::relief::{HeightField, displacement, march};
use crate::scene::Scene;
use crate::simd::{PixelLanes, set_bits};
use glam::Vec3;

/// Rays of a pixel to each sun; a square number.
pub(super) const RAYS: usize = 16;

/// Those of them that go first: to points near the disc's edge, from places of which each has a row and
/// a column of the pixel for itself.
pub(super) const FIRST: [usize; 4] = [2, 4, 11, 13];

/// Where the pixels of a pair are in the world.
pub(super) struct Places<'a> {
    /// Where the view rays of the pixels' centres meet the relief.
    pub(super) relief: Vectors,
    /// Where they pass the polygon.
    pub(super) polygon: Vectors,
    /// How far that point moves from a column of pixels to the next, and a row.
    steps: [Vectors; 2],
    /// The way from there into the relief, where there is one.
    descent: Option<Descent<'a>>,
    /// How far above a ray's start a triangle hides nothing that it passes from behind: its own
    /// polygon, or one that stands on it. See [`LightRay::reach`](crate::light::exact::LightRay).
    pub(super) reach: PixelLanes,
    /// Which of the pixels are covered.
    pub(super) covered: u8,
}

/// View rays on their way from the polygon into a relief.
struct Descent<'a> {
    field: &'a HeightField,
    /// Where they pass the polygon, in repeats, and how far that moves from a column of pixels to the
    /// next, and a row.
    uv: [PixelLanes; 2],
    uv_steps: [[PixelLanes; 2]; 2],
    /// How far they move along the texture down to the deepest relief, in repeats, and in the world.
    displacement: [PixelLanes; 2],
    way: Vectors,
}

impl Descent<'_> {
    /// From the polygon to where the rays so many pixels from the pixels' centres meet the relief.
    fn to_relief(&self, offset: [f32; 2]) -> Vectors {
        let uv = moved(&self.uv, &self.uv_steps, offset);
        let depth = march(self.field, &uv, &self.displacement);
        self.way.map(|axis| axis * depth)
    }
}

impl Places<'_> {
    /// Where a ray starts: the first ones where relief as deep as under the pixel's centre lies under
    /// their place, the others where their own view ray meets it, as within a pixel of the far field the
    /// relief goes up and down by more than the pixel is wide.
    pub(super) fn start(&self, ray: usize) -> Vectors {
        let offset = ray_offset(ray);
        let moved = |points| moved(points, &self.steps, offset);
        match &self.descent {
            Some(descent) if !FIRST.contains(&ray) => {
                let (polygon, way) = (moved(&self.polygon), descent.to_relief(offset));
                [0, 1, 2].map(|i| polygon[i] + way[i])
            }
            _ => moved(&self.relief),
        }
    }

    /// How far along an axis, from a point, the covered pixels lie down to the deepest relief.
    pub(super) fn range(&self, from: Vec3, axis: Vec3) -> [f32; 2] {
        let half = half_width(&self.steps, axis);
        let polygon = along(&self.polygon, axis) - axis.dot(from);
        let way = self.descent.as_ref().map_or(PixelLanes::ZERO, |down| along(&down.way, axis));
        let (least, most) = (way.fast_min(PixelLanes::ZERO), way.fast_max(PixelLanes::ZERO));
        range(self.covered, polygon + least - half, polygon + most + half)
    }
}

/// Half of what pixels span along an axis, by how far a point moves from one to the next.
pub(super) fn half_width(steps: &[Vectors; 2], axis: Vec3) -> PixelLanes {
    (along(&steps[0], axis).abs() + along(&steps[1], axis).abs()) * 0.5
}

/// How far a ray's start may lie from a triangle that it belongs to, without relief: within a pixel
/// its place is that of the plane that its centre lies in, which neighbours rise above.
pub(super) fn pixel_reach([column, row]: &[Vectors; 2]) -> PixelLanes {
    dot(column, column).sqrt() + dot(row, row).sqrt()
}

/// The least and the greatest of picked lanes.
pub(super) fn range(lanes: u8, least: PixelLanes, most: PixelLanes) -> [f32; 2] {
    let [least, most] = [least, most].map(PixelLanes::to_array);
    set_bits(lanes)
        .fold([f32::MAX, f32::MIN], |[a, b], lane| [a.min(least[lane]), b.max(most[lane])])
}

/// How far something moves from a column of pixels to the next, and a row.
pub(super) fn steps<const N: usize>(of: &[PixelLanes; N]) -> [[PixelLanes; N]; 2] {
    // Pixels of a quad: lanes 0 and 1 side by side, 0 and 2 one above the other.
    [1, 2].map(|by| {
        of.map(|axis| {
            let axis = axis.to_array();
            PixelLanes::new(std::array::from_fn(|lane| {
                axis[lane / 4 * 4 + by] - axis[lane / 4 * 4]
            }))
        })
    })
}

/// Something so many pixels from the pixels' centres, by its [`steps`].
fn moved<const N: usize>(
    of: &[PixelLanes; N],
    [column, row]: &[[PixelLanes; N]; 2],
    [x, y]: [f32; 2],
) -> [PixelLanes; N] {
    std::array::from_fn(|i| of[i] + column[i] * x + row[i] * y)
}

pub(super) fn places<'a>(
    (scene, pair): (&Scene, &QuadPair),
    field: Option<&'a HeightField>,
    lit: &LitLanes,
    normal: &Vectors,
) -> Places<'a> {
    let LitLanes { position, tangent_u, tangent_v, .. } = *lit;
    let steps_along = steps(&position);
    let all = Places {
        relief: position,
        polygon: position,
        reach: pixel_reach(&steps_along),
        steps: steps_along,
        descent: None,
        covered: pair.covered_bits(),
    };
    let Some(field) = field else {
        return Places { relief: smooth_places(scene, pair, lit), ..all };
    };
    let displacement = displacement(&pair.view(), field.relief_depth);
    let repeat = repeat_length(&cross(&tangent_u, &tangent_v));
    let down = repeat * field.relief_depth;
    let way = [0, 1, 2].map(|i| {
        tangent_u[i] * displacement[0] + tangent_v[i] * displacement[1] - down * normal[i]
    });
    let to_relief = march(field, &pair.uv, &displacement);
    let relief = [0, 1, 2].map(|i| position[i] + way[i] * to_relief);
    let descent =
        Some(Descent { field, uv: pair.uv, uv_steps: steps(&pair.uv), displacement, way });
    Places { relief, descent, reach: down * 2.0, ..all }
}

/// Where light meets the polygons of the pixels of a pair, without relief.
fn smooth_places(scene: &Scene, pair: &QuadPair, lit: &LitLanes) -> Vectors {
    let is_back = lit.is_back.to_bitmask();
    let mut places = lit.position;
    let triangles = pair.planes.map(|planes| SmoothTriangle::new(scene, planes.triangle));
    for lane in pair.covered() {
        let lift = triangles[lane / 4].lift(of_lane(&lit.position, lane), is_back >> lane & 1 == 1);
        (0..3).for_each(|c| places[c].as_mut_array()[lane] += lift[c]);
    }
    places
}

/// Where a ray starts in its pixel, in pixels from the middle: by rows and columns.
fn ray_offset(ray: usize) -> [f32; 2] {
    const SIDE: usize = 4;
    [ray % SIDE, ray / SIDE].map(|i| (i as f32 + 0.5) / SIDE as f32 - 0.5)
}

pub(super) fn of_lane(vectors: &Vectors, lane: usize) -> Vec3 {
    Vec3::from(vectors.map(|axis| axis.as_array()[lane]))
}

pub(super) fn along(v: &Vectors, axis: Vec3) -> PixelLanes {
    v[0] * axis.x + v[1] * axis.y + v[2] * axis.z
}
