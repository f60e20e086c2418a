//! The base level's heights and a pyramid of their maxima.
//!
//! A *cell* spans four neighbouring texel centres; the relief in it is the bilinear patch of their
//! heights. Cell `(i, j)` begins at the centre of texel `(i, j)`. A *node* of level k spans 2^k x
//! 2^k cells (less at the far edges) and stores the greatest height in them: a ray above it passes
//! the node without a hit. (Maximum mipmaps: Tevs, Ihrke, Seidel 2008.)

use crate::texture::{FULL_F32, Rows, Surface, Wrap};

/// Heights of a surface's base level, read where the surface has them, with maxima.
#[derive(Clone, Debug)]
pub struct HeightField {
    /// Texels along u and v before the pattern wraps.
    pub size: [i32; 2],
    /// Depth of the deepest relief in texture repeats.
    pub relief_depth: f32,
    /// Texels per texture repeat along u and v.
    pub texels_per_repeat: [f32; 2],
    /// One over `size`.
    pub inverse_size: [f32; 2],
    /// Whether the pattern ends at its edges instead of repeating.
    pub is_clamped: bool,
    base: Rows,
    nodes: Vec<NodeLevel>,
}

#[derive(Clone, Debug)]
struct NodeLevel {
    width: usize,
    maxima: Vec<u16>,
}

impl HeightField {
    /// The heights of a surface.
    pub fn new(surface: &Surface) -> Self {
        let base = surface.base();
        let [w, h] = base.size();
        let mut field = Self {
            size: [w as i32, h as i32],
            inverse_size: [1.0 / w as f32, 1.0 / h as f32],
            relief_depth: surface.relief_depth(),
            texels_per_repeat: base.texels_per_repeat(),
            is_clamped: surface.wrap() == Wrap::Clamp,
            base: base.rows(false).clone(),
            nodes: Vec::new(),
        };
        field.nodes = field.build_nodes();
        field
    }

    /// Levels of nodes, the first of one cell a node (not stored), the last of one node.
    pub fn num_levels(&self) -> i32 {
        self.nodes.len() as i32 + 1
    }

    /// The level that a ray of that many texels begins on: a node holds about a fourth of its way.
    pub fn first_level(&self, length: f32) -> i32 {
        // The exponent is the logarithm rounded down; a fourth is two levels less.
        let exponent = (length.max(1.0).to_bits() >> 23) as i32 - 127;
        (exponent - 2).clamp(0, self.num_levels() - 1)
    }

    /// The place of a cell in the stored pattern. Cells beyond the edges of a clamped pattern,
    /// where the relief is level across the edge, are -1 and the last.
    pub fn fold(&self, axis: usize, i: i32) -> i32 {
        if self.is_clamped {
            i.clamp(-1, self.size[axis] - 1)
        } else {
            i.rem_euclid(self.size[axis])
        }
    }

    /// The heights, 0 to [`FULL`](crate::texture::FULL), at the corners of a folded cell: (0,0),
    /// (1,0), (0,1), (1,1).
    pub fn corners(&self, x: i32, y: i32) -> [f32; 4] {
        // The row above the last is the last again or, where the pattern repeats, the first.
        let above = match y + 1 == self.size[1] {
            true if self.is_clamped => y,
            true => 0,
            false => y + 1,
        };
        let [[a, b], [c, d]] = [y.max(0), above].map(|y| self.base.two_heights(x, y));
        [a as f32, b as f32, c as f32, d as f32]
    }

    /// The greatest height, 0 to [`FULL`](crate::texture::FULL), in the node of level 1 or more
    /// that holds a folded cell.
    pub fn node_max(&self, level: i32, x: i32, y: i32) -> f32 {
        let nodes = &self.nodes[level as usize - 1];
        f32::from(
            nodes.maxima[(y.max(0) >> level) as usize * nodes.width + (x.max(0) >> level) as usize],
        )
    }

    /// The bilinear height, 0 to 1, at a place in texels (texel centres lie at halves).
    pub fn height_at(&self, u: f64, v: f64) -> f64 {
        let (x, y) = ((u - 0.5).floor(), (v - 0.5).floor());
        let (fx, fy) = (u - 0.5 - x, v - 0.5 - y);
        let [a, b, c, d] =
            self.corners(self.fold(0, x as i32), self.fold(1, y as i32)).map(f64::from);
        let (low, high) = (a + (b - a) * fx, c + (d - c) * fx);
        (low + (high - low) * fy) / f64::from(FULL_F32)
    }

    fn build_nodes(&self) -> Vec<NodeLevel> {
        let [w, h] = self.size.map(|n| n as usize);
        let max_of = |cells: [f32; 4]| cells.into_iter().fold(0.0, f32::max) as u16;
        // Find the greatest height of each cell, for the first level only: the march has the cells'
        // heights themselves.
        let mut cells = NodeLevel { width: w, maxima: vec![0; w * h] };
        for (i, cell) in cells.maxima.iter_mut().enumerate() {
            *cell = max_of(self.corners((i % w) as i32, (i / w) as i32));
        }
        let mut levels = Vec::new();
        let (mut size, mut finer) = ([w, h], cells);
        // Halve the sides, rounded up, until one node holds all.
        while size != [1, 1] {
            let coarser = size.map(|n| n.div_ceil(2));
            let mut maxima = vec![0; coarser[0] * coarser[1]];
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let node: &mut u16 = &mut maxima[(y / 2) * coarser[0] + x / 2];
                    *node = (*node).max(finer.maxima[y * size[0] + x]);
                }
            }
            finer = NodeLevel { width: coarser[0], maxima };
            levels.push(finer.clone());
            size = coarser;
        }
        levels
    }
}
