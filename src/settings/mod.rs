//! How a frame is drawn. Plain data: every field may be set alone, the rest comes from
//! [`Settings::default`].

mod filter;
mod options;

use crate::error::{Error, Result, within};

pub use filter::{
    Derivatives, Ewa, Filter, Formulas, Horizon, RECONSTRUCTION, Rays, Trilinear, Visibility,
    Visible,
};
pub use options::OptionsMut;

/// Whether lights are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lighting {
    /// The filtered albedo is the colour.
    Unlit,
    /// Lambert and Blinn-Phong from the scene's sky and lights.
    Lit,
}

/// How light is brought within the range of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Tone {
    /// What is brighter than 1 is cut.
    None,
    /// Khronos PBR Neutral: base colours keep their hue and saturation, highlights are compressed.
    Neutral,
}

/// A rectangle of a frame's pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Region {
    /// First column, 0 at the left.
    pub x: u32,
    /// First row, 0 at the top.
    pub y: u32,
    /// Columns, 1 or more.
    pub width: u32,
    /// Rows, 1 or more.
    pub height: u32,
}

impl Region {
    /// Whether it lies within a frame of `width` by `height` pixels and holds a pixel.
    pub fn is_within(&self, width: u32, height: u32) -> bool {
        let fits = |first: u32, num: u32, end: u32| {
            num > 0 && first.checked_add(num).is_some_and(|last| last <= end)
        };
        fits(self.x, self.width, width) && fits(self.y, self.height, height)
    }
}

/// How a frame is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Width of the frame in pixels, 1 to 32768; width times height of what is drawn is at most
    /// 2^28. Default: 1280.
    pub width: u32,
    /// Height of the frame in pixels, 1 to 32768. Default: 720.
    pub height: u32,
    /// The part of the frame that is drawn: the picture has its size, and the bytes that this part
    /// has in the whole frame. Default: `None`, all of it.
    pub region: Option<Region>,
    /// Which texels make up a pixel's colour, with what that filter can be told. Default:
    /// [`Filter::Horizon`].
    pub filter: Filter,
    /// Whether the view ray is traced to the relief; `false` draws the polygon's own texels.
    /// Default: `true`.
    pub parallax: bool,
    /// Whether a traced relief has an outline and a depth: rays may pass it where its mesh is
    /// curved, and meshes that meet it are cut by it; `false`: both by its polygons. Default: `true`.
    pub silhouette: bool,
    /// Whether lights are evaluated. Default: [`Lighting::Unlit`].
    pub lighting: Lighting,
    /// How many times the picture's light, the background's too, is doubled: -32 to 32. Default: 0.
    pub exposure: f32,
    /// How it is then brought within 0 to 1 where pixels are bytes; frames of linear light stay as
    /// they are ([`Frame::apply_tone`](crate::Frame::apply_tone)). Default: [`Tone::None`].
    pub tone: Tone,
    /// Whether triangles seen from behind (clockwise on the screen) are left out. Default: `false`.
    pub cull_back_faces: bool,
    /// Coverage and depth samples a pixel: 1, 4 or 8. Shading stays once per pixel and triangle.
    /// Default: 4.
    pub msaa: u32,
    /// Side of a tile in pixels: 8 (drawn as 16, the side of a block of shading), 16, 32, 64, 128
    /// or 256. The picture does not depend on it. Default: 32.
    pub tile_size: u32,
}

/// Most pixels of a frame: 4 GiB of linear pixels.
const MAX_PIXELS: u64 = 1 << 28;

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 1280,
            height: 720,
            region: None,
            filter: Filter::default(),
            parallax: true,
            silhouette: true,
            lighting: Lighting::Unlit,
            exposure: 0.0,
            tone: Tone::None,
            cull_back_faces: false,
            msaa: 4,
            tile_size: 32,
        }
    }
}

impl Settings {
    /// What is drawn: the region, or the whole frame.
    pub fn drawn(&self) -> Region {
        self.region.unwrap_or(Region { x: 0, y: 0, width: self.width, height: self.height })
    }

    /// Whether relief is traced and has outlines.
    pub(crate) fn has_outlines(&self) -> bool {
        self.parallax && self.silhouette
    }

    /// Checks every field against its range.
    ///
    /// # Errors
    /// Names the first field whose value is out of its range.
    pub fn validate(&self) -> Result<()> {
        within("width", self.width, 1, 32768)?;
        within("height", self.height, 1, 32768)?;
        if let Some(Region { x, y, width, height }) =
            self.region.filter(|r| !r.is_within(self.width, self.height))
        {
            let reason = format!(
                "{x},{y},{width},{height} is not a part of {}x{} pixels",
                self.width, self.height
            );
            return Err(Error::setting("region", reason));
        }
        let Region { width, height, .. } = self.drawn();
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            let name = if self.region.is_some() { "region" } else { "width" };
            return Err(Error::setting(
                name,
                format!("{width} x {height} is more than {MAX_PIXELS} pixels"),
            ));
        }
        within("exposure", self.exposure, -32.0, 32.0)?;
        if !matches!(self.msaa, 1 | 4 | 8) {
            return Err(Error::setting("msaa", format!("{} is not 1, 4 or 8", self.msaa)));
        }
        if !(self.tile_size.is_power_of_two() && (8..=256).contains(&self.tile_size)) {
            return Err(Error::setting(
                "tile_size",
                format!("{} is not 8, 16, 32, 64, 128 or 256", self.tile_size),
            ));
        }
        self.filter.validate()
    }
}
