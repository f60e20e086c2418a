//! Words of four bytes each for every texel of every mip level.

use crate::texture::{Rows, Wrap, box_taps};
use rayon::prelude::*;

/// Words of a surface's texels, level by level; bytes of coarser levels are means.
#[derive(Clone, Debug)]
pub(super) struct ByteLevels {
    /// Rows along u, and along v.
    levels: Vec<[Rows; 2]>,
}

impl ByteLevels {
    /// From those of the base level, row by row along u.
    pub(super) fn new<const N: usize>(
        mut texels: Vec<[u32; N]>,
        mut size: [usize; 2],
        wrap: Wrap,
    ) -> Self {
        let mut levels = Vec::new();
        loop {
            let rows = Rows::new(size[0], size[1], wrap, N, &texels);
            let turned = rows.turned();
            levels.push([rows, turned]);
            if size == [1, 1] {
                return Self { levels };
            }
            (size, texels) = halve(size, &texels);
        }
    }

    /// The words of a level row by row: along u, or along v where they are wanted turned.
    pub(super) fn rows(&self, level: usize, is_turned: bool) -> &Rows {
        &self.levels[level][usize::from(is_turned)]
    }
}

/// Half the size, each byte the mean over the area that it covers.
fn halve<const N: usize>([w, h]: [usize; 2], texels: &[[u32; N]]) -> ([usize; 2], Vec<[u32; N]>) {
    let to = [w, h].map(|n| (n / 2).max(1));
    let columns: Vec<_> = (0..to[0]).map(|x| box_taps(x, w, to[0])).collect();
    let mut halved = vec![[0; N]; to[0] * to[1]];
    halved.par_chunks_exact_mut(to[0]).enumerate().for_each(|(y, row)| {
        let rows = box_taps(y, h, to[1]);
        for (texel, columns) in row.iter_mut().zip(&columns) {
            let mut sums = [[0.0_f32; 4]; N];
            for &(j, wy) in &rows {
                for &(i, wx) in columns {
                    for (sums, word) in sums.iter_mut().zip(texels[j * w + i]) {
                        let bytes = word.to_le_bytes();
                        sums.iter_mut().zip(bytes).for_each(|(s, b)| *s += wx * wy * f32::from(b));
                    }
                }
            }
            *texel = sums.map(|sums| u32::from_le_bytes(sums.map(|sum| (sum + 0.5) as u8)));
        }
    });
    (to, halved)
}
