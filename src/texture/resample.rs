//! Brings maps of different sizes to one: bilinear between texel centres, the identity where the
//! size is the same.

use super::rows::PackedTexel;
use super::wrap::wrap_index;
use super::{ColorImage, HeightImage, NormalImage, Wrap};
use rayon::prelude::*;

/// An image whose texels are up to three numbers from 0 to 65535.
pub(super) trait Texels: Sync {
    fn size(&self) -> [usize; 2];
    fn texel(&self, index: usize) -> [u32; 3];
}

impl Texels for ColorImage {
    fn size(&self) -> [usize; 2] {
        [self.width as usize, self.height as usize]
    }
    fn texel(&self, index: usize) -> [u32; 3] {
        self.texels[index].map(u32::from)
    }
}

impl Texels for HeightImage {
    fn size(&self) -> [usize; 2] {
        [self.width as usize, self.height as usize]
    }
    fn texel(&self, index: usize) -> [u32; 3] {
        [u32::from(self.texels[index]), 0, 0]
    }
}

impl Texels for NormalImage {
    fn size(&self) -> [usize; 2] {
        [self.width as usize, self.height as usize]
    }
    /// Components shifted by 32767.
    fn texel(&self, index: usize) -> [u32; 3] {
        self.texels[index].map(|c| (i32::from(c) + 32767).max(0) as u32)
    }
}

/// Two neighbours along an axis and how far the place lies towards the second.
struct Taps {
    near: usize,
    far: usize,
    towards_far: f32,
}

fn taps(wrap: Wrap, i: usize, num_to: usize, num_from: usize) -> Taps {
    let place = (i as f64 + 0.5) * num_from as f64 / num_to as f64 - 0.5;
    let floor = place.floor();
    let fold = |i: i32| {
        let n = num_from as i32;
        if wrap == Wrap::Mirror {
            (if i < 0 { -1 - i } else { i }).min(2 * n - 1 - i).max(0) as usize
        } else {
            wrap_index(wrap, i, num_from)
        }
    };
    Taps {
        near: fold(floor as i32),
        far: fold(floor as i32 + 1),
        towards_far: (place - floor) as f32,
    }
}

/// Calls `write` on every texel with the map's value there.
pub(super) fn fill<T: Texels>(
    texels: &mut [PackedTexel],
    [width, height]: [usize; 2],
    wrap: Wrap,
    from: &T,
    write: impl Fn(&mut PackedTexel, [u32; 3]) + Sync,
) {
    let [w, h] = from.size();
    let columns: Vec<Taps> = (0..width).map(|x| taps(wrap, x, width, w)).collect();
    texels.par_chunks_exact_mut(width).enumerate().for_each(|(y, row)| {
        let v = taps(wrap, y, height, h);
        for (texel, u) in row.iter_mut().zip(&columns) {
            let lerp = |a: u32, b: u32, t: f32| a as f32 + (b as f32 - a as f32) * t;
            let [a, b] = [u.near, u.far].map(|x| from.texel(v.near * w + x));
            let [c, d] = [u.near, u.far].map(|x| from.texel(v.far * w + x));
            write(
                texel,
                std::array::from_fn(|i| {
                    let (low, high) =
                        (lerp(a[i], b[i], u.towards_far), lerp(c[i], d[i], u.towards_far));
                    (low + (high - low) * v.towards_far + 0.5) as u32
                }),
            );
        }
    });
}
