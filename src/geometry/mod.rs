//! Model space to screen triangles: project, cull, clip, snap.
//!
//! In: a validated [`Scene`]. Out: [`ScreenTriangle`]s in the order of meshes and their triangles,
//! whatever the number of threads. View space is `(x, y, d)`: `d` is the distance along the view,
//! and `(x, y) / d`, or `(x, y)` where rays are parallel, lies on the screen, in pixels from the frame's
//! middle, x to the right and y down. There is no far plane.
//!
//! What is dropped: triangles that are not finite, seen from behind (if culled), outside the frame,
//! without area after snapping, or too small to hold a sample. What reaches beyond the near plane
//! or the guard band is clipped, and vertices on a shared edge come out the same for both of its
//! triangles. Corners are snapped to 1/256 pixel, so that coverage is a matter of integers.

mod clip;
mod cull;
mod plane;
mod projection;
mod samples;
mod setup;

pub(crate) use plane::BasisLanes;
pub use plane::{Lens, Plane, ScreenBasis};
pub use projection::{Projection, SUBPIXEL_BITS};
pub use samples::{offset_bounds, sample_offsets};

use crate::scene::Scene;
use crate::settings::Settings;
use projection::ScreenVertices;
use rayon::prelude::*;

/// Bits of a triangle's index that count within its chunk; a clipped triangle becomes at most six,
/// see [`CHUNK`].
const INDEX_BITS: u32 = 15;
/// Triangles of the scene that one task sets up: small enough to balance, large enough to hide a
/// task's cost, and at most `2^INDEX_BITS / 6`, so that indices fit even if every triangle is
/// clipped into six.
const CHUNK: usize = 4096;
/// Vertices that one task projects.
const VERTEX_CHUNK: usize = 8192;

/// A triangle, or a clipped piece of one, on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenTriangle {
    /// Corners in 1/256 pixel from the frame's upper left corner, clockwise as displayed.
    pub corners: [[i32; 2]; 3],
    /// The [nearness](Projection::nearness) on the screen; the same for all pieces of a triangle.
    pub depth: Plane,
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Index into the mesh's triangles.
    pub triangle: u32,
}

/// The triangles of a frame. Keeps its buffers from one [`Geometry::project`] to the next.
#[derive(Clone, Debug, Default)]
pub struct Geometry {
    projection: Projection,
    vertices: Vec<ScreenVertices>,
    chunks: Vec<Vec<ScreenTriangle>>,
}

/// The screen triangles of `scene`, in a fresh [`Geometry`].
pub fn project(scene: &Scene, settings: &Settings) -> Geometry {
    let mut geometry = Geometry::default();
    geometry.project(scene, settings);
    geometry
}

impl Geometry {
    /// Replaces the triangles by those of `scene`.
    pub fn project(&mut self, scene: &Scene, settings: &Settings) {
        self.projection = Projection::new(&scene.camera, settings);
        self.project_vertices(scene);
        let mut first_triangles = Vec::with_capacity(scene.meshes.len() + 1);
        let mut num = 0;
        for mesh in &scene.meshes {
            first_triangles.push(num);
            num += mesh.triangles.len();
        }
        first_triangles.push(num);
        self.chunks.resize_with(num.div_ceil(CHUNK), Vec::new);
        let setup = setup::Setup::new(&self.projection, settings);
        let vertices = &self.vertices;
        self.chunks.par_iter_mut().enumerate().for_each(|(chunk, triangles)| {
            triangles.clear();
            let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(num);
            let mut mesh = first_triangles.partition_point(|&first| first <= range.start) - 1;
            let mut start = range.start;
            while start < range.end {
                let end = range.end.min(first_triangles[mesh + 1]);
                let local = start - first_triangles[mesh]..end - first_triangles[mesh];
                setup.set_up(
                    mesh,
                    local,
                    &scene.meshes[mesh].triangles,
                    &vertices[mesh],
                    triangles,
                );
                (start, mesh) = (end, mesh + 1);
            }
        });
    }

    fn project_vertices(&mut self, scene: &Scene) {
        let projection = self.projection;
        self.vertices.resize_with(scene.meshes.len(), ScreenVertices::default);
        self.vertices.par_iter_mut().zip(&scene.meshes).for_each(|(vertices, mesh)| {
            vertices.view.resize(mesh.positions.len(), [0.0; 3]);
            vertices.snapped.resize(mesh.positions.len(), [0; 2]);
            let chunks = vertices
                .view
                .par_chunks_mut(VERTEX_CHUNK)
                .zip(vertices.snapped.par_chunks_mut(VERTEX_CHUNK));
            mesh.positions.par_chunks(VERTEX_CHUNK).zip(chunks).for_each(
                |(positions, (view, snapped))| {
                    let chunks = view.chunks_mut(8).zip(snapped.chunks_mut(8));
                    for (positions, (view, snapped)) in positions.chunks(8).zip(chunks) {
                        projection.vertices(positions, view, snapped);
                    }
                },
            );
        });
    }

    /// How the scene was projected.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// How many screen triangles there are.
    pub fn num_triangles(&self) -> usize {
        self.chunks.iter().map(Vec::len).sum()
    }

    /// All screen triangles in order.
    pub fn triangles(&self) -> impl Iterator<Item = &ScreenTriangle> {
        self.chunks.iter().flatten()
    }

    /// How many chunks the triangles lie in; each is in order, and chunk after chunk is.
    pub fn num_chunks(&self) -> usize {
        self.chunks.len()
    }

    /// The triangles of a chunk with their indices, which grow in order but not by one.
    pub fn chunk(&self, chunk: usize) -> impl ExactSizeIterator<Item = (u32, &ScreenTriangle)> {
        let first = (chunk as u32) << INDEX_BITS;
        self.chunks[chunk].iter().enumerate().map(move |(i, triangle)| (first | i as u32, triangle))
    }

    /// The triangle of an index that [`Geometry::chunk`] gave.
    #[inline]
    pub fn triangle(&self, index: u32) -> &ScreenTriangle {
        &self.chunks[(index >> INDEX_BITS) as usize][(index & ((1 << INDEX_BITS) - 1)) as usize]
    }
}
