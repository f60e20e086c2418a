//! The texels of a level row by row, in an order made for sweeps.
//!
//! A row stores its words plane by plane, with an apron of [`APRON`] texels beyond its end and,
//! where the pattern does not repeat, before its beginning, so that any run of that many
//! neighbouring texels is one contiguous load per plane:
//!
//! ```text
//!           lead     width          APRON
//! plane 0 | .... | red, green  | ...............|
//! plane 1 | .... | blue, height| ...............|   stride words each, num_planes of them are one row
//! plane 2 | .... | normal      | ...............|
//! ```

use super::wrap::{Wrap, wrap_index, wrap_indices};
use crate::simd::{i32x16, u32x8, u32x16};
use rayon::prelude::*;
use std::sync::Arc;

/// Look-ups clamp texel coordinates to so far from the pattern's first, so that neighbours fit an
/// i32.
pub(crate) const FARTHEST: f32 = (1 << 30) as f32;

/// One texel as it is packed.
pub(crate) type PackedTexel = [u32; 3];

/// Texels that a row repeats beyond its ends: the widest run of lanes that is loaded at once.
pub(crate) const APRON: usize = 32;

/// The texels of one mip level, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    /// Texels a row before the pattern wraps.
    width: usize,
    /// Rows before the pattern wraps.
    height: usize,
    wrap: Wrap,
    num_planes: usize,
    /// Shared, so that height fields read the heights where they are.
    words: Arc<[u32]>,
}

/// Rows that are transposed at once: as many as a cache line of the source has words.
const BLOCK: usize = 16;

impl Rows {
    /// Rows of texels that are given row by row.
    pub(crate) fn new<const N: usize>(
        width: usize,
        height: usize,
        wrap: Wrap,
        num_planes: usize,
        texels: &[[u32; N]],
    ) -> Self {
        Self::filled([width, height], wrap, num_planes, 1, |y, plane, lines| {
            let texels = &texels[y * width..][..width];
            lines[0].iter_mut().zip(texels).for_each(|(word, texel)| *word = texel[plane]);
        })
    }

    /// The same texels with rows that run along columns.
    pub(crate) fn turned(&self) -> Self {
        Self::filled(
            [self.height, self.width],
            self.wrap,
            self.num_planes,
            BLOCK,
            |x, plane, columns| {
                let (first, stride) =
                    (self.lead() + plane * self.stride() + x, self.stride() * self.num_planes);
                for y in 0..self.height {
                    let words = &self.words[first + y * stride..];
                    columns.iter_mut().zip(words).for_each(|(column, word)| column[y] = *word);
                }
            },
        )
    }

    /// The same rows with every texel in one packed colour.
    pub(super) fn in_color(&self, [red, green, blue]: [u32; 3]) -> Self {
        let words = self.words.iter().enumerate().map(|(i, word)| {
            match i / self.stride() % self.num_planes {
                0 => red | green << 16,
                1 => blue | word & 0xffff_0000,
                _ => *word,
            }
        });
        Self { words: words.collect(), ..*self }
    }

    /// Rows that are written by `fill(y, plane, rows)`, up to `at_once` from row y on.
    fn filled(
        [width, height]: [usize; 2],
        wrap: Wrap,
        num_planes: usize,
        at_once: usize,
        fill: impl Fn(usize, usize, &mut [&mut [u32]]) + Sync,
    ) -> Self {
        let mut all = Self { width, height, wrap, num_planes, words: Arc::new([]) };
        let (lead, stride) = (all.lead(), all.stride());
        let mut words: Arc<[u32]> = std::iter::repeat_n(0, stride * num_planes * height).collect();
        let rows = Arc::get_mut(&mut words).expect("nobody shares it yet");
        let apron: Vec<_> = (0..lead).chain(lead + width..stride).collect();
        let apron =
            apron.into_iter().map(|i| (i, lead + wrap_index(wrap, i as i32 - lead as i32, width)));
        let apron: Vec<(usize, usize)> = apron.collect();
        rows.par_chunks_mut(stride * num_planes * at_once).enumerate().for_each(|(block, rows)| {
            for plane in 0..num_planes {
                let of_plane = rows.chunks_exact_mut(stride).skip(plane).step_by(num_planes);
                let mut lines: Vec<&mut [u32]> =
                    of_plane.map(|row| &mut row[lead..lead + width]).collect();
                fill(block * at_once, plane, &mut lines);
            }
            rows.chunks_exact_mut(stride)
                .for_each(|row| apron.iter().for_each(|&(to, from)| row[to] = row[from]));
        });
        all.words = words;
        all
    }

    /// What lies beyond the edges.
    pub(crate) fn wrap(&self) -> Wrap {
        self.wrap
    }

    /// Texels a row before the pattern wraps.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// Rows before the pattern wraps.
    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// The packed texel at a column and row of the endless pattern.
    pub(crate) fn packed(&self, x: i32, y: i32) -> PackedTexel {
        let x = wrap_index(self.wrap, x, self.width) + self.lead();
        let row = self.row(y);
        let stride = self.stride();
        std::array::from_fn(
            |plane| if plane < self.num_planes { row[plane * stride + x] } else { 0 },
        )
    }

    /// The packed texels of a stored row.
    pub(crate) fn texels(&self, y: usize) -> impl Iterator<Item = PackedTexel> {
        let row = &self.words[y * self.pitch()..][..self.pitch()];
        (self.lead()..self.lead() + self.width).map(move |x| {
            std::array::from_fn(|plane| {
                if plane < self.num_planes { row[plane * self.stride() + x] } else { 0 }
            })
        })
    }

    /// The normals of eight texels of a stored row, the first in column `x`; `None` without.
    pub(crate) fn normals(&self, x: usize, y: usize) -> Option<u32x8> {
        let start = y * self.pitch() + 2 * self.stride() + self.lead() + x;
        self.has_normals().then(|| Self::run(&self.words, start))
    }

    /// The words of a row of the endless pattern, all planes.
    #[inline(always)]
    pub(crate) fn row(&self, y: i32) -> &[u32] {
        let start = self.row_start(y);
        &self.words[start..start + self.pitch()]
    }

    /// Where a run of up to [`APRON`] texels that begins at column `x` of the endless pattern
    /// starts within a plane.
    #[inline(always)]
    pub(crate) fn run_start(&self, x: i32) -> usize {
        match self.wrap {
            Wrap::Clamp => (x.clamp(-(APRON as i32), self.width as i32) + APRON as i32) as usize,
            Wrap::Repeat | Wrap::Mirror => wrap_index(self.wrap, x, self.width),
        }
    }

    /// Words of a row, all planes.
    #[inline(always)]
    pub(crate) fn pitch(&self) -> usize {
        self.stride() * self.num_planes
    }

    /// Where the rows of the endless pattern from `first` on start among all words.
    #[inline(always)]
    pub(crate) fn row_starts(&self, first: i32) -> RowStarts<'_> {
        RowStarts { rows: self, row: first, start: self.row_start(first), pitch: self.pitch() }
    }

    /// Where a row of the endless pattern starts among all words.
    #[inline(always)]
    pub(crate) fn row_start(&self, y: i32) -> usize {
        wrap_index(self.wrap, y, self.height) * self.pitch()
    }

    /// Where the run of up to [`APRON`] texels that begins at a column and row of the endless
    /// pattern starts among all words.
    #[inline(always)]
    pub(crate) fn start_at(&self, x: i32, y: i32) -> usize {
        self.row_start(y) + self.run_start(x)
    }

    /// [`Self::start_at`] of sixteen columns and rows.
    #[inline(always)]
    pub(crate) fn starts_at(&self, x: i32x16, y: i32x16) -> [usize; 16] {
        let columns = match self.wrap {
            Wrap::Clamp => {
                let apron = i32x16::splat(APRON as i32);
                x.max(-apron).min(i32x16::splat(self.width as i32)) + apron
            }
            Wrap::Repeat | Wrap::Mirror => wrap_indices(self.wrap, x, self.width),
        };
        let rows = wrap_indices(self.wrap, y, self.height);
        let (columns, rows, pitch) = (columns.to_array(), rows.to_array(), self.pitch());
        std::array::from_fn(|i| rows[i] as usize * pitch + columns[i] as usize)
    }

    /// All words; see [`Self::start_at`].
    #[inline(always)]
    pub(crate) fn words(&self) -> &[u32] {
        &self.words
    }

    /// Texels of the apron before a row: a run never begins there where the pattern repeats.
    fn lead(&self) -> usize {
        if self.wrap == Wrap::Clamp { APRON } else { 0 }
    }

    /// Distance in words between the planes of a row.
    pub(crate) fn stride(&self) -> usize {
        self.lead() + self.width + APRON
    }

    /// Eight neighbouring words of a row, from `start`: [`Self::run_start`] plus a multiple of
    /// [`Self::stride`].
    #[inline(always)]
    pub(crate) fn run(row: &[u32], start: usize) -> u32x8 {
        let lanes: &[u32; 8] = row[start..start + 8].try_into().expect("a slice of eight");
        u32x8::new(*lanes)
    }

    /// [`Self::run`] of sixteen.
    #[inline(always)]
    pub(crate) fn long_run(words: &[u32], start: usize) -> u32x16 {
        let lanes: &[u32; 16] = words[start..start + 16].try_into().expect("a slice of sixteen");
        u32x16::new(*lanes)
    }

    /// Words of a texel.
    pub(crate) fn num_planes(&self) -> usize {
        self.num_planes
    }

    /// Whether texels have a third word, their normal.
    pub(crate) fn has_normals(&self) -> bool {
        self.num_planes == 3
    }

    /// The heights, 0 to [`FULL`](super::FULL), at a stored row's column and the one after it;
    /// columns of a clamped pattern begin at -1.
    #[inline(always)]
    pub(crate) fn two_heights(&self, x: i32, y: i32) -> [u32; 2] {
        let stride = self.stride();
        let at = (y as usize * self.num_planes + 1) * stride + (self.lead() as i32 + x) as usize;
        [self.words[at] >> 16, self.words[at + 1] >> 16]
    }

    /// Bytes that the rows take.
    pub(crate) fn num_bytes(&self) -> usize {
        self.words.len() * 4
    }
}

/// See [`Rows::row_starts`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowStarts<'a> {
    rows: &'a Rows,
    row: i32,
    start: usize,
    pitch: usize,
}

impl<'a> RowStarts<'a> {
    /// Whose rows they are.
    #[inline(always)]
    pub(crate) fn rows(&self) -> &'a Rows {
        self.rows
    }

    /// The next row.
    #[inline(always)]
    pub(crate) fn row(&self) -> i32 {
        self.row
    }

    /// Where the next row starts.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> usize {
        let start = self.start;
        self.row = self.row.wrapping_add(1);
        self.start = match self.rows.wrap {
            Wrap::Clamp => self.rows.row_start(self.row),
            // Begins again after the last one.
            Wrap::Repeat | Wrap::Mirror if start + self.pitch == self.rows.words.len() => 0,
            Wrap::Repeat | Wrap::Mirror => start + self.pitch,
        };
        start
    }
}
