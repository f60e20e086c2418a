//! Colours of the pictures of an inspected pixel, and what they show.

use crate::pictures::draw::Rgba;

pub(crate) const WHITE: Rgba = [255, 255, 255, 255];
pub(crate) const INK: Rgba = [32, 33, 36, 255];
pub(crate) const FAINT: Rgba = [120, 124, 130, 255];
/// Colours that the colour-blind tell apart (M. Okabe and K. Ito 2008).
pub(crate) const VISIBLE: Rgba = [0, 158, 115, 255];
pub(crate) const HIDDEN: Rgba = [213, 94, 0, 255];
pub(crate) const SKIPPED: Rgba = [240, 228, 66, 255];
pub(crate) const TWICE: Rgba = [148, 60, 160, 255];
pub(crate) const FLAT: Rgba = [0, 114, 178, 255];
pub(crate) const RELIEF: Rgba = [180, 30, 60, 255];
pub(crate) const RAY: Rgba = [20, 20, 20, 255];

/// What is drawn.
#[derive(Clone, Copy)]
pub(crate) struct Layers {
    /// The ellipse of formula (2), and that of (3).
    pub(crate) ellipses: [bool; 2],
    pub(crate) texels: bool,
    pub(crate) hidden: bool,
    pub(crate) skipped: bool,
    pub(crate) twice: bool,
    /// Rays from hidden texels to what covers them.
    pub(crate) rays: bool,
    pub(crate) horizon: bool,
}

impl Default for Layers {
    fn default() -> Self {
        Self {
            ellipses: [true; 2],
            texels: true,
            hidden: true,
            skipped: true,
            twice: true,
            rays: false,
            horizon: true,
        }
    }
}

impl Layers {
    /// What the paper's figure shows.
    pub(crate) fn of_figure(number: u32) -> Self {
        Self {
            ellipses: [number <= 3, number >= 3],
            texels: number >= 2,
            hidden: number >= 4,
            skipped: false,
            twice: number == 6,
            rays: number >= 5,
            horizon: number >= 4,
        }
    }
}
