//! World space to view space to the snapped screen.
//!
//! `x = fx (P - eye).right`, `y = -fy (P - eye).up`, `d = (P - eye).forward`; on the screen, in
//! pixels from the upper left corner, `(x / w + cx, y / w + cy)`; `(cx, cy)` is the optical axis. A
//! pinhole's `w` is the distance `d`, an orthographic camera's 1. Divided and snapped in f64: f32 would
//! lose sub-pixel bits beyond 32768 pixels, where guard-band vertices lie.
//!
//! Which of two surfaces is nearer tells their *nearness*, linear on the screen and larger where
//! nearer: `1 / d` of a pinhole, `-d` where rays are parallel.

use super::plane::Lens;
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
    /// `(x, y, d)`: pixels times world units, or pixels, and world units.
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
    /// How rays go through the frame.
    pub(crate) lens: Lens,
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
            lens: Lens {
                center: [cx, cy].map(f64::from),
                parallel: camera.orthographic.map(f64::from),
            },
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
        let [x, y, d] = self.axes.map(|axis| d[0] * axis.x + d[1] * axis.y + d[2] * axis.z);
        let w = if self.is_orthographic() { f32x8::ONE } else { d };
        // A power of two: the product is exact, so that the clipper, in f64, agrees on who is
        // inside.
        let guard = f32x8::splat(GUARD as f32);
        let bound = w * guard;
        let is_inside = d.simd_ge(f32x8::splat(self.near))
            & x.abs().simd_le(bound)
            & y.abs().simd_le(bound)
            & (d * guard).is_finite();
        let is_inside = crate::simd::mask(is_inside).to_array();
        let [x, y, d, w] = [x, y, d, w].map(f32x8::to_array);
        let wide = |lanes: [f32; 8]| f64x8::new(lanes.map(f64::from));
        let [center_x, center_y] = self.lens.center;
        let places = [(x, center_x), (y, center_y)].map(|(c, center)| {
            let screen =
                (wide(c) / wide(w)).fast_max(f64x8::splat(-GUARD)).fast_min(f64x8::splat(GUARD))
                    + center;
            (screen * SCALE + ROUNDED).to_array().map(|rounded| rounded.to_bits() as i32)
        });
        for (lane, (view, snapped)) in view.iter_mut().zip(snapped).enumerate() {
            *view = [x[lane], y[lane], d[lane]];
            *snapped =
                if is_inside[lane] != 0 { places.map(|place| place[lane]) } else { UNSNAPPED };
        }
    }

    /// Whether all rays are parallel to the view.
    pub fn is_orthographic(&self) -> bool {
        self.lens.parallel.is_some()
    }

    /// Where the ray through a place of the screen, in pixels, is at a distance along the view: to the
    /// right, down and forward, in world units (the axes of OpenCV's cameras).
    #[inline]
    pub fn place(&self, [x, y]: [f64; 2], distance: f64) -> DVec3 {
        let [across, down] = [x - self.lens.center[0], y - self.lens.center[1]];
        let at_one = DVec3::new(across / self.focal[0], down / self.focal[1], 1.0);
        match self.is_orthographic() {
            true => at_one.with_z(distance),
            false => at_one * distance,
        }
    }

    /// Where the ray through a place of the screen goes while it gets 1 farther along the view, in the
    /// axes of [`Self::place`].
    #[inline]
    pub fn ray(&self, place: [f64; 2]) -> DVec3 {
        if self.is_orthographic() { DVec3::Z } else { self.place(place, 1.0) }
    }

    /// The same in the world.
    #[inline]
    pub fn direction(&self, place: [f64; 2]) -> DVec3 {
        self.unit_axes * self.ray(place)
    }

    /// Where in the world the ray through a place of the screen begins: at the distance 0.
    #[inline]
    pub fn origin(&self, place: [f64; 2]) -> DVec3 {
        self.eye.as_dvec3() + self.unit_axes * self.place(place, 0.0)
    }

    /// How near what lies at a distance along the view is: see [`projection`](self).
    #[inline]
    pub fn nearness(&self, distance: f32) -> f32 {
        if self.is_orthographic() { -distance } else { 1.0 / distance }
    }

    /// The distance along the view of so near a surface, above 0.
    #[inline]
    pub fn distance(&self, nearness: f32x8) -> f32x8 {
        // At a floor's horizon 1 / d may round to 0 or below: far away, and yet not the background.
        let least = f32x8::splat(f32::MIN_POSITIVE);
        match self.is_orthographic() {
            true => (-nearness).fast_max(least),
            false => f32x8::ONE / nearness.fast_max(least),
        }
    }

    /// The distance along the view at which a ray has gone on from a surface at a distance by so many
    /// lengths of [`AttributePlanes::view`](crate::raster::AttributePlanes::view): its whole way from
    /// the eye, or where rays are parallel 1.
    #[inline]
    pub fn behind(&self, distance: f32x8, lengths: f32x8) -> f32x8 {
        // Never before the surface, by the rules of rounding.
        if self.is_orthographic() { distance + lengths } else { distance * (lengths + 1.0) }
    }

    /// How large a pixel is in the world, at most: at the eye, and more for each distance along the view.
    pub fn pixel_size(&self) -> [f64; 2] {
        let size = 1.0 / self.focal[0].min(self.focal[1]);
        if self.is_orthographic() { [size, 0.0] } else { [0.0, size] }
    }

    /// View space of a world position: x and y in pixels times world units, or in pixels, and the
    /// distance along the view.
    pub fn view(&self, position: Vec3) -> Vec3 {
        let ray = position - self.eye;
        Vec3::from(self.axes.map(|axis| axis.dot(ray)))
    }

    /// The world position of a place given in the axes of [`Self::place`].
    #[inline]
    pub fn world(&self, place: DVec3) -> Vec3 {
        (self.eye.as_dvec3() + self.unit_axes * place).as_vec3()
    }

    /// A world direction along the axes of [`Self::place`].
    #[inline]
    pub fn along_axes(&self, direction: Vec3) -> Vec3 {
        (self.unit_axes.transpose() * direction.as_dvec3()).as_vec3()
    }

    /// Eight world positions from the eye, world units.
    #[inline]
    pub(crate) fn as_seen(&self, position: [f64x8; 3]) -> [f64x8; 3] {
        std::array::from_fn(|i| position[i] - f64x8::splat(f64::from(self.eye[i])))
    }

    /// The rays to eight positions from the eye: the whole way, or where rays are parallel their
    /// direction.
    #[inline]
    pub(crate) fn rays(&self, from_eye: [f64x8; 3]) -> [f64x8; 3] {
        if self.is_orthographic() {
            let forward = self.unit_axes.z_axis.to_array();
            return forward.map(f64x8::splat);
        }
        from_eye
    }

    /// View space of eight positions from the eye, without the rounding of [`Projection::vertices`].
    #[inline]
    pub(crate) fn views(&self, from_eye: [f64x8; 3]) -> [f64x8; 3] {
        self.axes.map(|axis| {
            let [x, y, z] = [0, 1, 2].map(|i| f64x8::splat(f64::from(axis[i])) * from_eye[i]);
            x + y + z
        })
    }

    /// Snapped screen coordinates of a view-space point within the guard band, `d > 0`.
    #[inline]
    pub(super) fn snap(&self, [x, y, d]: [f64; 3]) -> [i32; 2] {
        let w = self.lens.w(d);
        let snap = |value: f64, center: f64| {
            let screen = (value / w).clamp(-GUARD, GUARD) + center;
            (screen * SCALE).round_ties_even() as i32
        };
        let [center_x, center_y] = self.lens.center;
        [snap(x, center_x), snap(y, center_y)]
    }
}
