//! Images as they are loaded: compact, linear, bottom row first.

/// A linear RGB image.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorImage {
    /// Texels a row.
    pub width: u32,
    /// Rows; row 0 is the bottom (v = 0).
    pub height: u32,
    /// Linear light: 65535 stands for `scale`.
    pub texels: Vec<[u16; 3]>,
    /// The brightest value that can be stored: 1 for ordinary pictures, more for HDR.
    pub scale: f32,
}

/// One number a texel, linear.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GrayImage {
    /// Texels a row.
    pub width: u32,
    /// Rows; row 0 is the bottom (v = 0).
    pub height: u32,
    /// 65535 stands for 1.
    pub texels: Vec<u16>,
}

/// A height map: 65535 lies on the polygon, 0 is deepest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeightImage {
    /// Texels a row.
    pub width: u32,
    /// Rows; row 0 is the bottom (v = 0).
    pub height: u32,
    /// Heights, white = high.
    pub texels: Vec<u16>,
}

/// A normal map in the texture frame: x along u, y along v (upwards), z off the surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NormalImage {
    /// Texels a row.
    pub width: u32,
    /// Rows; row 0 is the bottom (v = 0).
    pub height: u32,
    /// x, y, z from -1 (-32767) to 1 (32767); need not be of length one.
    pub texels: Vec<[i16; 3]>,
}

impl ColorImage {
    /// An image from a function of column and row (from the bottom) to linear RGB, each 0 to 1.
    pub fn from_fn(width: u32, height: u32, mut color: impl FnMut(u32, u32) -> [f32; 3]) -> Self {
        let pack = |c: [f32; 3]| c.map(|c| (c.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16);
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self { width, height, texels: texels.map(|(x, y)| pack(color(x, y))).collect(), scale: 1.0 }
    }
}

impl GrayImage {
    /// An image from a function of column and row (from the bottom) to a number, 0 to 1.
    pub fn from_fn(width: u32, height: u32, mut value: impl FnMut(u32, u32) -> f32) -> Self {
        let pack = |c: f32| (c.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16;
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self { width, height, texels: texels.map(|(x, y)| pack(value(x, y))).collect() }
    }
}

impl From<GrayImage> for HeightImage {
    fn from(GrayImage { width, height, texels }: GrayImage) -> Self {
        Self { width, height, texels }
    }
}

impl HeightImage {
    /// An image from a function of column and row (from the bottom) to a height, 0 (deepest) to 1
    /// (on the polygon).
    pub fn from_fn(width: u32, height: u32, h: impl FnMut(u32, u32) -> f32) -> Self {
        GrayImage::from_fn(width, height, h).into()
    }
}
