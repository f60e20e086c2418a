//! The hand-over from the rasterizer to relief and filter: two 2x2 quads with perspective-correct attributes.
//!
//! An attribute `a` of a triangle is `a(x, y) = (a/w)(x, y) / (1/w)(x, y)`, and both are linear on the screen.

use crate::simd::PixelLanes;

/// A linear function on the screen: `value = c[0] * x + c[1] * y + c[2]`, x to the right and y down, in pixels; the
/// centre of the first pixel lies at (0.5, 0.5).
pub type Plane = [f32; 3];

/// Everything that varies over one triangle.
#[derive(Clone, Debug, Default)]
pub struct AttributePlanes {
    /// 1 / w, where w is the distance along the view.
    pub inverse_w: Plane,
    /// Texture coordinates over w.
    pub uv: [Plane; 2],
    /// The ray from the eye in the texture frame over w: `(alpha, beta, gamma)` of
    /// `ray = alpha dP/du + beta dP/dv - gamma sqrt(|dP/du x dP/dv|) N`. Zero without texture coordinates.
    pub view: [Plane; 3],
    /// World-space attributes; only kept under `Lighting::Lit`.
    pub lit: Option<Box<LitPlanes>>,
}

/// World-space attributes of one triangle, over w.
#[derive(Clone, Debug, Default)]
pub struct LitPlanes {
    /// Position.
    pub position: [Plane; 3],
    /// Normal.
    pub normal: [Plane; 3],
    /// dP/du.
    pub tangent_u: [Plane; 3],
    /// dP/dv.
    pub tangent_v: [Plane; 3],
}

/// Two 2x2 quads of triangles of one material: eight pixel lanes, lane `4 * quad + 2 * dy + dx`.
#[derive(Debug)]
pub struct QuadPair<'a> {
    /// Index of the material of both triangles.
    pub material: usize,
    /// Column and row of each quad's upper left pixel.
    pub origin: [[i32; 2]; 2],
    /// How many samples of each pixel see the triangle; 0 for a helper lane.
    pub coverage: [u8; 8],
    /// The triangles of both quads.
    pub planes: [&'a AttributePlanes; 2],
    /// Texture coordinates at the pixel centres, in repeats.
    pub uv: [PixelLanes; 2],
    /// The ray from the eye in the texture frame at the pixel centres (see [`AttributePlanes::view`]).
    pub view: [PixelLanes; 3],
}
