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

    /// Layers in which nothing is seen.
    pub(super) fn empty(layers: &[Layer], width: u32, height: u32) -> Self {
        let num_pixels = width as usize * height as usize;
        let mut all: Vec<(Layer, Values)> = Vec::new();
        for &layer in layers {
            if all.iter().any(|(kept, _)| *kept == layer) {
                continue;
            }
            let values = if layer.is_id() {
                Values::Ids(vec![u32::MAX; num_pixels])
            } else {
                Values::Floats(vec![layer.background(); num_pixels * layer.num_channels()])
            };
            all.push((layer, values));
        }
        Self { width, height, all }
    }

    /// The rows of each row of tiles.
    pub(super) fn bands(&mut self, settings: &Settings) -> Vec<Band<'_>> {
        let (grid, region) = (TileGrid::new(settings), settings.drawn());
        let row_of = |band: i32| {
            // The tiles may begin before the region, and end after it.
            let row = grid.area.min[1] + band * grid.tile_size;
            row.clamp(region.y as i32, (region.y + region.height) as i32)
        };
        let rows = |band: i32| (row_of(band + 1) - row_of(band)) as usize;
        let mut bands: Vec<Band> = (0..grid.num_tiles[1])
            .map(|band| Band {
                region: Region { y: row_of(band) as u32, height: rows(band) as u32, ..region },
                slots: Vec::with_capacity(self.all.len()),
            })
            .collect();
        for (layer, values) in &mut self.all {
            let row = region.width as usize * layer.num_channels();
            let mut left = match values {
                Values::Floats(values) => Slot::Floats(values),
                Values::Ids(values) => Slot::Ids(values),
            };
            for band in &mut bands {
                let (slot, rest) = left.split(band.region.height as usize * row);
                band.slots.push((*layer, slot));
                left = rest;
            }
        }
        bands
    }
}

/// A run of rows of all layers.
pub(super) struct Band<'a> {
    /// The pixels of the frame that it holds.
    pub(super) region: Region,
    pub(super) slots: Vec<(Layer, Slot<'a>)>,
}

/// A run of rows of a layer.
pub(super) enum Slot<'a> {
    Floats(&'a mut [f32]),
    Ids(&'a mut [u32]),
}

impl<'a> Slot<'a> {
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

impl Band<'_> {
    /// The number of a pixel of the frame in the band, if it is there.
    #[inline(always)]
    pub(super) fn index(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let Region { x: left, y: top, width, height } = self.region;
        // What lies before the first wraps to a large number.
        let (x, y) = ((x as u32).wrapping_sub(left), (y as u32).wrapping_sub(top));
        (x < width && y < height).then_some(y as usize * width as usize + x as usize)
    }
}
