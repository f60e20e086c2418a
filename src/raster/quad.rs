//! The hand-over from the rasterizer to relief and filter: two 2x2 quads with perspective-correct
//! attributes.
//!
//! An attribute `a` of a triangle is `a(x, y) = (a/w)(x, y) / (1/w)(x, y)`, and both are linear on
//! the screen. Every lane is `(c0 x + c1 y + c2) * (1 / inverse_w)`, whether its quad stands alone,
//! in a pair, or among eight places of a pixel, so its bits depend on the place and the triangle
//! only.

pub use crate::geometry::Plane;
use crate::simd::{PixelLanes, bits_mask, set_bits};

/// Everything that varies over one triangle.
#[derive(Clone, Debug, Default)]
pub struct AttributePlanes {
    /// 1 / w, where w is the distance along the view, or 1 where rays are parallel.
    pub inverse_w: Plane,
    /// The nearness of [`Projection`](crate::geometry::Projection::nearness).
    pub nearness: Plane,
    /// Texture coordinates over w.
    pub uv: [Plane; 2],
    /// The ray from the eye, or where rays are parallel their direction, in the texture frame over w: `(alpha, beta, gamma)` of `ray = alpha
    /// dP/du + beta dP/dv - gamma sqrt(|dP/du x dP/dv|) N`. `(0, 0, 1)` over w without texture
    /// coordinates.
    pub view: [Plane; 3],
    /// How a ray's way over the texture changes, per repeat along u and along v that it has moved; 0
    /// where the triangle is flat. First how much its gamma grows; then half of what moves it on along
    /// u, and along v, for each alpha and beta: the surface turns away from it, and there is the less
    /// of it the deeper the ray is.
    pub bend: [[f32; 2]; 3],
    /// The mesh's colours over w; `None` where it has none.
    pub tint: Option<Box<[Plane; 3]>>,
    /// World-space attributes; only kept under `Lighting::Lit`.
    pub lit: Option<Box<LitPlanes>>,
    /// The index of the mesh, and of the triangle in it.
    pub triangle: [u32; 2],
}

/// World-space attributes of one triangle, over w.
#[derive(Clone, Debug, Default)]
pub struct LitPlanes {
    /// Position.
    pub position: [Plane; 3],
    /// Normal.
    pub normal: [Plane; 3],
    /// dP/du; 0 without texture coordinates.
    pub tangent_u: [Plane; 3],
    /// dP/dv; 0 without texture coordinates.
    pub tangent_v: [Plane; 3],
    /// Whether the polygon is seen from behind, however its normals are smoothed.
    pub is_back: bool,
}

/// World-space attributes at eight pixels.
#[derive(Clone, Copy, Debug)]
pub struct LitLanes {
    /// Position.
    pub position: [PixelLanes; 3],
    /// Normal, interpolated and so not of unit length.
    pub normal: [PixelLanes; 3],
    /// dP/du; 0 without texture coordinates.
    pub tangent_u: [PixelLanes; 3],
    /// dP/dv; 0 without texture coordinates.
    pub tangent_v: [PixelLanes; 3],
    /// All bits of the lanes whose polygon is seen from behind.
    pub is_back: PixelLanes,
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
    /// What attributes at the pixel centres are multiplied with: the distance along the view, or 1
    /// where rays are parallel.
    pub w: PixelLanes,
    /// Texture coordinates at the pixel centres, in repeats.
    pub uv: [PixelLanes; 2],
}

impl AttributePlanes {
    /// Texture coordinates and the view in the texture frame at eight places of the screen, in
    /// pixels. Where the triangle's plane lies beyond its horizon they may be anything, infinite
    /// and NaN included.
    #[inline]
    pub fn at(&self, x: PixelLanes, y: PixelLanes) -> ([PixelLanes; 2], [PixelLanes; 3]) {
        let at = Places::<true> { x, y, planes: [self, self] };
        let w = at.w();
        (at.attributes(w, |planes| &planes.uv), at.attributes(w, |planes| &planes.view))
    }
}

impl<'a> QuadPair<'a> {
    /// Two quads with their attributes at the pixel centres.
    #[inline(always)]
    pub fn new(
        material: usize,
        origin: [[i32; 2]; 2],
        coverage: [u8; 8],
        planes: [&'a AttributePlanes; 2],
    ) -> Self {
        let [x, y] = centers(origin);
        // As most are where triangles are large.
        let (w, uv) = if std::ptr::eq(planes[0], planes[1]) {
            Places::<true> { x, y, planes }.coordinates()
        } else {
            Places::<false> { x, y, planes }.coordinates()
        };
        Self { material, origin, coverage, planes, w, uv }
    }

    /// The ray from the eye in the texture frame at the pixel centres (see
    /// [`AttributePlanes::view`]).
    #[inline(always)]
    pub fn view(&self) -> [PixelLanes; 3] {
        let [x, y] = self.centers();
        Places::<false> { x, y, planes: self.planes }.attributes(self.w, |planes| &planes.view)
    }

    /// [`AttributePlanes::bend`] of the pixels' triangles; `None` where both are flat.
    #[inline(always)]
    pub fn bend(&self) -> Option<[[PixelLanes; 2]; 3]> {
        let [a, b] = self.planes.map(|planes| planes.bend);
        let is_flat = a == [[0.0; 2]; 3] && b == [[0.0; 2]; 3];
        (!is_flat).then(|| [0, 1, 2].map(|row| [0, 1].map(|i| halves(a[row][i], b[row][i]))))
    }

    /// A bit for each lane whose pixel sees the triangle.
    #[inline(always)]
    pub fn covered_bits(&self) -> u8 {
        // A byte is at most 8, so nothing is carried to the next one: its highest bit says whether
        // it is above 0.
        let is_covered = (u64::from_le_bytes([0x7f; 8]) + u64::from_le_bytes(self.coverage))
            & u64::from_le_bytes([0x80; 8]);
        // Bit 8 i + 7 of the product's factor moves to bit 56 + i: one set bit of the other, 49 - 7
        // i, for each byte.
        (is_covered.wrapping_mul(0x0002_0408_1020_4081) >> 56) as u8
    }

    /// The lanes whose pixels see the triangle, in order.
    #[inline(always)]
    pub fn covered(&self) -> impl Iterator<Item = usize> + use<> {
        set_bits(self.covered_bits())
    }

    /// Column and row of a lane's pixel.
    pub fn pixel(&self, lane: usize) -> [i32; 2] {
        let [x, y] = self.origin[lane / 4];
        [x + (lane as i32 & 1), y + (lane as i32 >> 1 & 1)]
    }

    /// The pixel centres on the screen, in pixels: x, y.
    #[inline]
    pub fn centers(&self) -> [PixelLanes; 2] {
        centers(self.origin)
    }

    /// The meshes' colours at the pixel centres; `None` where neither has any.
    pub fn tint(&self) -> Option<[PixelLanes; 3]> {
        let [a, b] = self.planes.map(|planes| planes.tint.as_deref());
        if a.is_none() && b.is_none() {
            return None;
        }
        // White is w over w.
        let [a, b] = self
            .planes
            .map(|planes| planes.tint.as_deref().copied().unwrap_or([planes.inverse_w; 3]));
        let [x, y] = self.centers();
        let places = Places::<false> { x, y, planes: self.planes };
        Some(std::array::from_fn(|i| places.value([a[i], b[i]]) * self.w))
    }

    /// World-space attributes at the pixel centres; `None` unless lit.
    #[inline]
    pub fn lit(&self) -> Option<LitLanes> {
        let [x, y] = self.centers();
        Places::<false> { x, y, planes: self.planes }.lit(self.w)
    }
}

#[inline(always)]
fn centers(origin: [[i32; 2]; 2]) -> [PixelLanes; 2] {
    // Exact: frames are at most 32768 pixels wide, and f32 has halves far beyond that.
    let [[x0, y0], [x1, y1]] = origin.map(|quad| quad.map(|v| v as f32));
    let dx = PixelLanes::new([0.5, 1.5, 0.5, 1.5, 0.5, 1.5, 0.5, 1.5]);
    let dy = PixelLanes::new([0.5, 0.5, 1.5, 1.5, 0.5, 0.5, 1.5, 1.5]);
    [halves(x0, x1) + dx, halves(y0, y1) + dy]
}

/// One value for the lanes of the first quad, one for the second.
#[inline(always)]
fn halves(a: f32, b: f32) -> PixelLanes {
    PixelLanes::new([a, a, a, a, b, b, b, b])
}

/// Eight places on the screen, four on each of two triangles, which may be one.
struct Places<'a, const IS_ONE: bool> {
    x: PixelLanes,
    y: PixelLanes,
    planes: [&'a AttributePlanes; 2],
}

impl<const IS_ONE: bool> Places<'_, IS_ONE> {
    #[inline(always)]
    fn coordinates(&self) -> (PixelLanes, [PixelLanes; 2]) {
        let w = self.w();
        (w, self.attributes(w, |planes| &planes.uv))
    }

    #[inline(always)]
    fn value(&self, [a, b]: [Plane; 2]) -> PixelLanes {
        // Coefficients of one triangle are broadcast, which is quicker. The arithmetic after is the
        // same either way, and so are its bits.
        let [c0, c1, c2] =
            [0, 1, 2].map(|i| if IS_ONE { PixelLanes::splat(a[i]) } else { halves(a[i], b[i]) });
        c0 * self.x + c1 * self.y + c2
    }

    #[inline(always)]
    fn w(&self) -> PixelLanes {
        // A true division: estimates of reciprocals differ between processors.
        PixelLanes::ONE / self.value(self.planes.map(|planes| planes.inverse_w))
    }

    #[inline(always)]
    fn attributes<const N: usize>(
        &self,
        w: PixelLanes,
        planes: impl Fn(&AttributePlanes) -> &[Plane; N],
    ) -> [PixelLanes; N] {
        let [a, b] = self.planes.map(planes);
        // Divided once, in `w`; each attribute takes a product.
        std::array::from_fn(|i| self.value([a[i], b[i]]) * w)
    }

    #[inline]
    fn lit(&self, w: PixelLanes) -> Option<LitLanes> {
        let lit = [self.planes[0].lit.as_deref()?, self.planes[1].lit.as_deref()?];
        let vector = |planes: fn(&LitPlanes) -> &[Plane; 3]| {
            let [a, b] = lit.map(planes);
            std::array::from_fn(|i| self.value([a[i], b[i]]) * w)
        };
        Some(LitLanes {
            position: vector(|lit| &lit.position),
            normal: vector(|lit| &lit.normal),
            tangent_u: vector(|lit| &lit.tangent_u),
            tangent_v: vector(|lit| &lit.tangent_v),
            is_back: {
                let [a, b] = lit.map(|lit| if lit.is_back { 0xf } else { 0 });
                bits_mask(a | b << 4)
            },
        })
    }
}
