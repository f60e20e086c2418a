//! World space to view space to the snapped screen.
//!
//! `x = fx (P - eye).right`, `y = -fy (P - eye).up`, `w = (P - eye).forward`; on the screen, in
//! pixels from the upper left corner, `(x / w + cx, y / w + cy)`; `(cx, cy)` is the optical axis. Divided and
//! snapped in f64: f32 would lose sub-pixel bits beyond 32768 pixels, where guard-band vertices
//! lie.

use crate::scene::{Camera, Intrinsics};
use crate::settings::Settings;
use crate::simd::{f32x8, f64x8};
use glam::{DMat3, DVec3, Vec3};

/// Fractional bits of snapped coordinates: 1/256 pixel, what GPUs use.
pub const SUBPIXEL_BITS: u32 = 8;
const SCALE: f64 = (1_u32 << SUBPIXEL_BITS) as f64;
/// Half the side of the guard band in pixels around the frame's middle. Frames are at most 32768
/// wide, so what is clipped there is out of sight, and products of snapped differences stay far
/// inside 64 bits.
pub(super) const GUARD: f64 = 65536.0;
/// Marks a vertex that must not be used without clipping: before the near plane, beyond the guard
/// band or not finite.
pub(super) const UNSNAPPED: [i32; 2] = [i32::MIN; 2];
/// Added to an f64 below 2^51, leaves it rounded to a whole number, ties to even, in the low bits.
const ROUNDED: f64 = 6_755_399_441_055_744.0;

/// Vertices in view space and on the screen.
#[derive(Clone, Debug, Default)]
pub(super) struct ScreenVertices {
    /// `(x, y, w)`: pixels times world units, and world units.
    pub(super) view: Vec<[f32; 3]>,
    /// Place on the screen in 1/256 pixel, or [`UNSNAPPED`].
    pub(super) snapped: Vec<[i32; 2]>,
}

/// A camera and a frame's size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projection {
    eye: Vec3,
    /// Right and down, in pixels, and forward.
    axes: [Vec3; 3],
    /// Pixels per unit of `x / w` and of `y / w`.
    focal: [f64; 2],
    /// Right, down and forward, each of length one.
    unit_axes: DMat3,
    /// The optical axis in pixels from the frame's upper left corner.
    pub center: [f64; 2],
    /// Distance along the view before which nothing is drawn, in world units.
    pub near: f32,
    /// Columns of the frame.
    pub width: u32,
    /// Rows of the frame.
    pub height: u32,
}

impl Projection {
    /// The projection of `camera` on the frame of `settings`.
    pub fn new(camera: &Camera, settings: &Settings) -> Self {
        let Intrinsics { fx, fy, cx, cy } = camera.on_frame(settings.width, settings.height);
        let [right, up, forward] = camera.axes();
        Self {
            eye: camera.eye,
            axes: [right * fx, up * -fy, forward],
            focal: [fx, fy].map(f64::from),
            unit_axes: DMat3::from_cols(right.as_dvec3(), -up.as_dvec3(), forward.as_dvec3()),
            center: [cx, cy].map(f64::from),
            near: camera.near,
            width: settings.width,
            height: settings.height,
        }
    }

    /// Up to eight vertices from their world positions.
    #[inline(always)]
    pub(super) fn vertices(
        &self,
        positions: &[Vec3],
        view: &mut [[f32; 3]],
        snapped: &mut [[i32; 2]],
    ) {
        let mut d = [[0.0_f32; 8]; 3];
        for (lane, position) in positions.iter().enumerate() {
            (d[0][lane], d[1][lane], d[2][lane]) = (position.x, position.y, position.z);
        }
        let d: [f32x8; 3] = std::array::from_fn(|i| f32x8::new(d[i]) - self.eye[i]);
        let [x, y, w] = self.axes.map(|axis| d[0] * axis.x + d[1] * axis.y + d[2] * axis.z);
        // A power of two: the product is exact, so that the clipper, in f64, agrees on who is
        // inside.
        let bound = w * GUARD as f32;
        let is_inside = w.simd_ge(f32x8::splat(self.near))
            & x.abs().simd_le(bound)
            & y.abs().simd_le(bound)
            & bound.is_finite();
        let is_inside = crate::simd::mask(is_inside).to_array();
        let [x, y, w] = [x, y, w].map(f32x8::to_array);
        let wide = |lanes: [f32; 8]| f64x8::new(lanes.map(f64::from));
        let places = [(x, self.center[0]), (y, self.center[1])].map(|(c, center)| {
            let screen =
                (wide(c) / wide(w)).fast_max(f64x8::splat(-GUARD)).fast_min(f64x8::splat(GUARD))
                    + center;
            (screen * SCALE + ROUNDED).to_array().map(|rounded| rounded.to_bits() as i32)
        });
        for (lane, (view, snapped)) in view.iter_mut().zip(snapped).enumerate() {
            *view = [x[lane], y[lane], w[lane]];
            *snapped =
                if is_inside[lane] != 0 { places.map(|place| place[lane]) } else { UNSNAPPED };
        }
    }

    /// Where the ray through a place of the screen, in pixels, is at the distance 1 along the view:
    /// to the right, down and forward, in world units (the axes of OpenCV's cameras).
    #[inline]
    pub fn ray(&self, [x, y]: [f64; 2]) -> DVec3 {
        let [across, down] = [x - self.center[0], y - self.center[1]];
        DVec3::new(across / self.focal[0], down / self.focal[1], 1.0)
    }

    /// The world direction of the ray through a place of the screen, at the distance 1 along the
    /// view.
    #[inline]
    pub fn direction(&self, place: [f64; 2]) -> DVec3 {
        self.unit_axes * self.ray(place)
    }

    /// View space of a world position: x and y in pixels times world units, and the distance along
    /// the view.
    pub fn view(&self, position: Vec3) -> Vec3 {
        let ray = position - self.eye;
        Vec3::from(self.axes.map(|axis| axis.dot(ray)))
    }

    /// The world position of a place given along the axes of [`Self::ray`].
    #[inline]
    pub fn world(&self, place: DVec3) -> Vec3 {
        (self.eye.as_dvec3() + self.unit_axes * place).as_vec3()
    }

    /// A world direction along the axes of [`Self::ray`].
    #[inline]
    pub fn along_axes(&self, direction: Vec3) -> Vec3 {
        (self.unit_axes.transpose() * direction.as_dvec3()).as_vec3()
    }

    /// The rays from the eye to eight world positions, world units.
    #[inline]
    pub(crate) fn rays(&self, position: [f64x8; 3]) -> [f64x8; 3] {
        std::array::from_fn(|i| position[i] - f64x8::splat(f64::from(self.eye[i])))
    }

    /// View space of eight rays from the eye, without the rounding of [`Projection::vertex`].
    #[inline]
    pub(crate) fn views_from_rays(&self, ray: [f64x8; 3]) -> [f64x8; 3] {
        self.axes.map(|axis| {
            let [x, y, z] = [0, 1, 2].map(|i| f64x8::splat(f64::from(axis[i])) * ray[i]);
            x + y + z
        })
    }

    /// Snapped screen coordinates of a view-space point within the guard band, `w > 0`.
    #[inline]
    pub(super) fn snap(&self, [x, y, w]: [f64; 3]) -> [i32; 2] {
        let snap = |value: f64, center: f64| {
            let screen = (value / w).clamp(-GUARD, GUARD) + center;
            (screen * SCALE).round_ties_even() as i32
        };
        [snap(x, self.center[0]), snap(y, self.center[1])]
    }
}
