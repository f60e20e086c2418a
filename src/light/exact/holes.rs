//! What is there of surfaces with holes, as triangles: for rays that ask for triangles alone.

use crate::scene::{CutOut, Mesh};
use glam::{Vec2, Vec3};

/// Texels along a side of a piece, and most pieces along a triangle's side.
const TEXELS: f32 = 3.0;
const MOST: u32 = 24;
/// Most pieces of a mesh before holes are left out.
const MOST_OF_MESH: usize = 1 << 20;

/// The pieces of a mesh's triangles that are there, each with the triangle's index: of those that cover
/// many texels, as many as there are of these.
pub(super) fn without(mesh: &Mesh, cut_out: &CutOut) -> Vec<([Vec3; 3], u32)> {
    let size = cut_out.opacity.size().map(|side| side as f32);
    // A triangle has n^2 pieces.
    let of_one = MOST_OF_MESH / mesh.triangles.len().max(1);
    let most = (1..=MOST).rev().find(|n| (n * n) as usize <= of_one).unwrap_or(1);
    let mut pieces = Vec::new();
    for (triangle, i) in mesh.triangles.iter().zip(0..) {
        let corners = triangle.map(|i| mesh.positions[i as usize]);
        let at = triangle.map(|i| mesh.tex_coords[i as usize]);
        let longest = (0..3)
            .map(|i| ((at[(i + 1) % 3] - at[i]) * Vec2::from(size)).length())
            .fold(0.0, f32::max);
        let num = ((longest / TEXELS).ceil() as u32).clamp(1, most);
        add_pieces((corners, at), num, cut_out, |piece| pieces.push((piece, i)));
    }
    pieces
}

/// Cuts a triangle into `num` rows of pieces, and adds those that are there.
fn add_pieces(
    (corners, at): ([Vec3; 3], [Vec2; 3]),
    num: u32,
    cut_out: &CutOut,
    mut add: impl FnMut([Vec3; 3]),
) {
    let share = 1.0 / num as f32;
    let place = |i: u32, j: u32| [i, j].map(|n| n as f32 * share);
    let point = |[b, c]: [f32; 2]| {
        corners[0] + (corners[1] - corners[0]) * b + (corners[2] - corners[0]) * c
    };
    let on_texture = |[b, c]: [f32; 2]| at[0] + (at[1] - at[0]) * b + (at[2] - at[0]) * c;
    let mut chance = 0.5_f32;
    let across = [at[1] - at[0], at[2] - at[0]].map(|side| (side * share).to_array());
    for i in 0..num {
        for j in 0..num - i {
            // One piece as the triangle lies, and, but at the last side, one turned over.
            let upright = [place(i, j), place(i + 1, j), place(i, j + 1)];
            let turned = [place(i + 1, j + 1), place(i, j + 1), place(i + 1, j)];
            let num_pieces = if i + j + 1 < num { 2 } else { 1 };
            for piece in [upright, turned].into_iter().take(num_pieces) {
                let middle = piece.iter().fold(Vec2::ZERO, |sum, p| sum + Vec2::from(*p)) / 3.0;
                chance = (chance + 0.618_034).fract();
                let place = on_texture(middle.to_array()).to_array();
                if cut_out.is_there(place, across, chance) {
                    add(piece.map(point));
                }
            }
        }
    }
}
