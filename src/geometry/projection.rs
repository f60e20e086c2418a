//! World space to view space to the snapped screen.
//!
//! `x = focal (P - eye).right`, `y = -focal (P - eye).up`, `w = (P - eye).forward`; on the screen, in pixels from the
//! upper left corner, `(x / w + width / 2, y / w + height / 2)`. Divided and snapped in f64: f32 would lose sub-pixel
//! bits beyond 32768 pixels, where guard-band vertices lie.

use crate::scene::Camera;
use crate::settings::Settings;
use crate::simd::f64x8;
use glam::Vec3;

/// Fractional bits of snapped coordinates: 1/256 pixel, what GPUs use.
pub const SUBPIXEL_BITS: u32 = 8;
/// Half the side of the guard band in pixels around the frame's middle. Frames are at most 32768 wide, so what is
/// clipped there is out of sight, and products of snapped differences stay far inside 64 bits.
pub(super) const GUARD: f64 = 65536.0;
/// Marks a vertex that must not be used without clipping.
const UNSNAPPED: [i32; 2] = [i32::MIN; 2];

/// A vertex in view space and on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScreenVertex {
    /// `(x, y, w)`: pixels times world units, and world units.
    pub view: [f32; 3],
    snapped: [i32; 2],
}

impl ScreenVertex {
    /// Place on the screen in 1/256 pixel; `None` before the near plane, beyond the guard band or if not finite.
    #[must_use]
    #[inline]
    pub fn snapped(&self) -> Option<[i32; 2]> {
        (self.snapped != UNSNAPPED).then_some(self.snapped)
    }
}

/// A camera and a frame's size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projection {
    eye: Vec3,
    /// Right and down, in pixels, and forward.
    axes: [Vec3; 3],
    /// The frame's middle in pixels from its upper left corner.
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
    #[must_use]
    pub fn new(camera: &Camera, settings: &Settings) -> Self {
        let focal = camera.focal_pixels(settings.height);
        let [right, up, forward] = camera.axes();
        Self {
            eye: camera.eye,
            axes: [right * focal, up * -focal, forward],
            center: [f64::from(settings.width) * 0.5, f64::from(settings.height) * 0.5],
            near: camera.near,
            width: settings.width,
            height: settings.height,
        }
    }

    /// A vertex from its world position.
    #[must_use]
    #[inline]
    pub fn vertex(&self, position: Vec3) -> ScreenVertex {
        let d = position - self.eye;
        let view = self.axes.map(|axis| axis.x * d.x + axis.y * d.y + axis.z * d.z);
        let [x, y, w] = view;
        // A power of two: the product is exact, so that the clipper, in f64, agrees on who is inside.
        let bound = w * GUARD as f32;
        let is_inside = w >= self.near && x.abs() <= bound && y.abs() <= bound && bound.is_finite();
        let snapped = if is_inside { self.snap(view.map(f64::from)) } else { UNSNAPPED };
        ScreenVertex { view, snapped }
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
    #[must_use]
    #[inline]
    pub fn snap(&self, [x, y, w]: [f64; 3]) -> [i32; 2] {
        let scale = f64::from(1_u32 << SUBPIXEL_BITS);
        let snap = |value: f64, center: f64| {
            let screen = (value / w).clamp(-GUARD, GUARD) + center;
            (screen * scale).round_ties_even() as i32
        };
        [snap(x, self.center[0]), snap(y, self.center[1])]
    }
}
