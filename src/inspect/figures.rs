//! Where to look on the built-in scene to see the paper's figures.

use crate::scene::{self, Scene};
use crate::settings::{Derivatives, Filter, Settings, Visible};

/// One of the paper's figures, as a pixel of the built-in scene. The paper has two of number 2; the
/// first, the bare ellipse, is the outline of the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Figure {
    /// The paper's number, 1 to 6.
    pub number: u32,
    /// What is seen.
    pub title: &'static str,
    pixel: [u32; 2],
}

impl Figure {
    /// All figures, in order.
    pub const ALL: [Self; 6] = [
        Self {
            number: 1,
            title: "The view ray displaces the texture coordinates",
            pixel: [232, 280],
        },
        Self { number: 2, title: "Texels of a pixel without parallax", pixel: [232, 280] },
        Self { number: 3, title: "Texels of a pixel with parallax", pixel: [232, 280] },
        Self {
            number: 4,
            title: "Higher relief hides a part of the pixel's projection",
            pixel: [403, 320],
        },
        Self { number: 5, title: "Texels that must not count", pixel: [190, 320] },
        Self { number: 6, title: "Texels that could count twice", pixel: [190, 320] },
    ];

    /// The built-in scene.
    pub fn scene(&self) -> Scene {
        scene::builtin()
    }

    /// The settings of the figure.
    pub fn settings(&self) -> Settings {
        Settings {
            width: 640,
            height: 360,
            filter: Filter::Visible(Visible {
                derivatives: if self.number == 2 { Derivatives::Flat } else { Derivatives::Relief },
                // The letter: the full texture, and jumps of the relief are slopes.
                texel_budget: 0,
                max_stretch: 0.0,
                ..Visible::default()
            }),
            parallax: self.number != 2,
            ..Settings::default()
        }
    }

    /// Column and row of the pixel.
    pub fn pixel(&self) -> [u32; 2] {
        self.pixel
    }
}
