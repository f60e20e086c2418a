//! Where a pixel is sampled.
//!
//! Offsets from the pixel's upper left corner in 1/256 pixel. No two samples of a pixel share a row
//! or a column, so an edge near the horizontal or the vertical crosses them one by one: the rotated
//! grid for four, and the like for eight (the positions that GPUs use).

/// One sample: the centre.
const CENTER: [[i32; 2]; 1] = [[128, 128]];
/// Four samples, in sixteenths of a pixel from the centre: (-2, -6), (6, -2), (-6, 2), (2, 6).
const FOUR: [[i32; 2]; 4] = [[96, 32], [224, 96], [32, 160], [160, 224]];
/// Eight samples: (1, -3), (-1, 3), (5, 1), (-3, -5), (-5, 5), (-7, -1), (3, 7), (7, -7).
const EIGHT: [[i32; 2]; 8] =
    [[144, 80], [112, 176], [208, 144], [80, 48], [48, 208], [16, 112], [176, 240], [240, 16]];

/// The sample positions of a pixel for `num_samples` of 1, 4 or 8, in 1/256 pixel from its upper
/// left corner.
pub fn sample_offsets(num_samples: u32) -> &'static [[i32; 2]] {
    match num_samples {
        8 => &EIGHT,
        4 => &FOUR,
        _ => &CENTER,
    }
}

/// Least and largest offset of [`sample_offsets`], along both axes.
#[inline]
pub fn offset_bounds(num_samples: u32) -> [i32; 2] {
    match num_samples {
        8 => [16, 240],
        4 => [32, 224],
        _ => [128, 128],
    }
}
