//! Screen triangles to quads: edge functions and fill rule, bins, tiles, and quads with their
//! attributes.
//!
//! A frame is drawn in four steps. [`Bins`] lists each tile's triangles. A tile finds out what each
//! of its samples sees (edge functions, depth). The quads of 2x2 pixels that see a triangle are
//! listed, once for each triangle, sorted by material. Two by two they are shaded, and their
//! colours are added to the tile's pixels by the share of samples that see them. The background
//! fills what share is left.
//!
//! The picture does not depend on tile size or threads: coverage is exact, quads lie on even pixels
//! of the frame, every lane is computed alone, and a pixel's shares are summed by material and then
//! by triangle.

mod attributes;
mod behind;
mod bin;
mod block;
mod canvas;
mod centers;
mod contact;
mod draw;
mod edge;
mod gather;
mod grid;
mod overdraw;
mod pool;
mod quad;
mod scratch;
mod small;
mod tile;
mod together;

pub use behind::{Behind, Follow};
pub use bin::Bins;
pub use block::QuadBlock;
pub use centers::{CenterRow, CenterTile, Centers};
pub use draw::{Drawn, RasterStats, Rasterizer, Shade, draw};
pub use edge::{BLOCK, Edges, Rect, Row};
pub use grid::{SHADED_BLOCK, TileGrid};
pub use overdraw::hit_counts;
pub use pool::{Loan, Pool};
pub use quad::{AttributePlanes, LitLanes, LitPlanes, Plane, QuadPair};
