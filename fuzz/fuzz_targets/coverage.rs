//! A closed fan of triangles, partly behind the eye, hits no pixel twice.
#![no_main]

use basrelief::invariants::fan_is_hit_once;
use basrelief_fuzz::hold;

libfuzzer_sys::fuzz_target!(|input: ([i16; 2], [(u8, u8); 8], [i8; 2], u8)| {
    let (center, ring, tilt, msaa) = input;
    // From 4 to four million pixels.
    let radius = |(size, digits): (u8, u8)| (1.0 + f32::from(digits) / 256.0) * (4_u32 << (size % 20)) as f32;
    let (center, tilt) = (center.map(|c| f32::from(c) / 1024.0), tilt.map(|t| f32::from(t) / 16.0));
    hold(fan_is_hit_once(center, &ring.map(radius), tilt, [1, 4, 8][usize::from(msaa % 3)]));
});
