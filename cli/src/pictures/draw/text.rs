//! Text from glyphs that are compiled in.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster};

/// How large text is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Size {
    Small,
    Bold,
    Title,
}

/// Width and height in pixels of a letter of [`Size::Small`].
pub(crate) const CELL: [f32; 2] = [7.0, 16.0];

/// The glyphs of a text.
pub(crate) fn glyphs(text: &str, size: Size) -> impl Iterator<Item = RasterizedChar> + '_ {
    let (weight, height) = match size {
        Size::Small => (FontWeight::Regular, RasterHeight::Size16),
        Size::Bold => (FontWeight::Bold, RasterHeight::Size16),
        Size::Title => (FontWeight::Bold, RasterHeight::Size20),
    };
    text.chars().filter_map(move |c| {
        get_raster(c, weight, height).or_else(|| get_raster('?', weight, height))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_as_large_as_a_letter() {
        let letters: Vec<_> = glyphs("aW(\u{1F600}", Size::Small)
            .map(|g| [g.width() as f32, g.height() as f32])
            .collect();
        assert_eq!(letters, [CELL; 4]);
    }
}
