//! The numbers of layers, and the bands that threads fill.

use super::layer::Layer;
use crate::raster::TileGrid;
use crate::settings::{Region, Settings};

/// Layers of a frame, or of a region of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// Pixels a row.
    pub width: u32,
    /// Rows; row 0 is the top.
    pub height: u32,
    /// Each layer that was asked for, once, in the order in which it was.
    pub all: Vec<(Layer, Values)>,
}

/// The numbers of a layer, row by row, [`Layer::num_channels`] a pixel.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Measures.
    Floats(Vec<f32>),
    /// Indices; [`u32::MAX`] where nothing is seen.
    Ids(Vec<u32>),
}

impl Layers {
    /// The numbers of a layer of measures, row by row, [`Layer::num_channels`] a pixel; none if it
    /// was not asked for or is one of ids.
    pub fn floats(&self, layer: Layer) -> &[f32] {
        match self.values(layer) {
            Some(Values::Floats(values)) => values,
            _ => &[],
        }
    }

    /// The indices of a layer of ids, row by row; none if it was not asked for or has no ids.
    pub fn ids(&self, layer: Layer) -> &[u32] {
        match self.values(layer) {
            Some(Values::Ids(values)) => values,
            _ => &[],
        }
    }

    fn values(&self, layer: Layer) -> Option<&Values> {
        self.all.iter().find_map(|(kept, values)| (*kept == layer).then_some(values))
    }

    /// Room for layers, which are yet to be written.
    pub(super) fn unwritten(layers: &[Layer], width: u32, height: u32) -> Self {
        let num_pixels = width as usize * height as usize;
        let mut all: Vec<(Layer, Values)> = Vec::new();
        for &layer in layers {
            if all.iter().any(|(kept, _)| *kept == layer) {
                continue;
            }
            let num = num_pixels * layer.num_channels();
            let is_id = layer.is_id();
            let values =
                if is_id { Values::Ids(vec![0; num]) } else { Values::Floats(vec![0.0; num]) };
            all.push((layer, values));
        }
        Self { width, height, all }
    }

    /// The numbers of each layer, to be written.
    pub(super) fn all_mut(&mut self) -> Vec<(Layer, ValuesMut<'_>)> {
        let all = self.all.iter_mut().map(|(layer, values)| match values {
            Values::Floats(values) => (*layer, ValuesMut::Floats(values)),
            Values::Ids(values) => (*layer, ValuesMut::Ids(values)),
        });
        all.collect()
    }
}

/// A run of rows of all layers.
pub(super) struct Band<'a> {
    /// The pixels of the frame that it holds.
    pub(super) region: Region,
    pub(super) slots: Vec<(Layer, ValuesMut<'a>)>,
}

/// The numbers of a layer, or of a run of its rows, in memory of the caller's: as [`Values`].
#[derive(Debug)]
pub enum ValuesMut<'a> {
    /// Measures.
    Floats(&'a mut [f32]),
    /// Indices.
    Ids(&'a mut [u32]),
}

/// The pixels of a picture in memory of the caller's, row by row from the top.
#[derive(Debug)]
pub enum PixelsMut<'a> {
    /// sRGB with straight opacity.
    Bytes(&'a mut [[u8; 4]]),
    /// Linear light times its opacity.
    Linear(&'a mut [[f32; 4]]),
}

impl ValuesMut<'_> {
    /// How many numbers there are.
    fn len(&self) -> usize {
        match self {
            Self::Floats(values) => values.len(),
            Self::Ids(values) => values.len(),
        }
    }

    /// Writes what a layer says of a pixel that sees nothing everywhere.
    fn clear(&mut self, layer: Layer) {
        match self {
            Self::Floats(values) => values.fill(layer.background()),
            Self::Ids(values) => values.fill(u32::MAX),
        }
    }

    fn split(self, at: usize) -> (Self, Self) {
        match self {
            Self::Floats(values) => {
                let (first, rest) = values.split_at_mut(at);
                (Self::Floats(first), Self::Floats(rest))
            }
            Self::Ids(values) => {
                let (first, rest) = values.split_at_mut(at);
                (Self::Ids(first), Self::Ids(rest))
            }
        }
    }
}

impl<'a> Band<'a> {
    /// The rows of each row of tiles, in which nothing is seen yet.
    ///
    /// # Panics
    /// If the numbers of a layer are not of its kind, or not as many as it has in the pixels drawn.
    pub(super) fn all(layers: Vec<(Layer, ValuesMut<'a>)>, settings: &Settings) -> Vec<Self> {
        let (grid, region) = (TileGrid::new(settings), settings.drawn());
        let row_of = |band: i32| {
            // The tiles may begin before the region, and end after it.
            let row = grid.area.min[1] + band * grid.tile_size;
            row.clamp(region.y as i32, (region.y + region.height) as i32)
        };
        let rows = |band: i32| (row_of(band + 1) - row_of(band)) as usize;
        let mut bands: Vec<Self> = (0..grid.num_tiles[1])
            .map(|band| Band {
                region: Region { y: row_of(band) as u32, height: rows(band) as u32, ..region },
                slots: Vec::with_capacity(layers.len()),
            })
            .collect();
        for (layer, mut values) in layers {
            let row = region.width as usize * layer.num_channels();
            let is_right = values.len() == row * region.height as usize
                && matches!(values, ValuesMut::Ids(_)) == layer.is_id();
            assert!(is_right, "numbers of {} must be those of its pixels", layer.name());
            values.clear(layer);
            for band in &mut bands {
                let (slot, rest) = values.split(band.region.height as usize * row);
                band.slots.push((layer, slot));
                values = rest;
            }
        }
        bands
    }

    /// The number of a pixel of the frame in the band, if it is there.
    #[inline(always)]
    pub(super) fn index(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let Region { x: left, y: top, width, height } = self.region;
        // What lies before the first wraps to a large number.
        let (x, y) = ((x as u32).wrapping_sub(left), (y as u32).wrapping_sub(top));
        (x < width && y < height).then_some(y as usize * width as usize + x as usize)
    }
}
