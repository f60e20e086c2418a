//! The finished picture: linear pixels, and their 8-bit sRGB encoding.

/// A picture in linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Pixels a row.
    pub width: u32,
    /// Rows; row 0 is the top.
    pub height: u32,
    /// Linear RGB, premultiplied by the fourth component, the opacity.
    pub pixels: Vec<[f32; 4]>,
}
