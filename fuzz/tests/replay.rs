//! The fuzz targets without a fuzzer: their corpora with past findings, and 5,000 random or
//! damaged inputs each.

use fastrand::Rng;
use std::fs;
use std::path::Path;

/// The files of a target's corpus, by name.
fn corpus(target: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target);
    let paths =
        fs::read_dir(&folder).expect("a corpus").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> =
        paths.map(|path| (path.display().to_string(), fs::read(&path).expect("read"))).collect();
    files.sort();
    assert!(!files.is_empty(), "{} is empty", folder.display());
    files
}

/// Bytes of up to 512, or a seed with some of its bytes changed, cut out, said twice or taken from
/// another seed.
fn damaged(random: &mut Rng, seeds: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut below = |num: usize| random.usize(..num.max(1));
    if below(3) == 0 {
        let num = below(512);
        return (0..num).map(|_| random.u8(..)).collect();
    }
    let mut bytes = seeds[below(seeds.len())].1.clone();
    for _ in 0..1 + below(4) {
        let (at, num) = (below(bytes.len()), below(16));
        let end = bytes.len().min(at + num);
        match below(6) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => bytes.extend_from_within(at..end),
            3 => {
                let other = &seeds[below(seeds.len())].1;
                let from = below(other.len());
                bytes.splice(at..end, other[from..other.len().min(from + 64)].iter().copied());
            }
            4 => bytes[at..end].iter_mut().for_each(|byte| *byte = [0, 255, 128, 127][num % 4]),
            _ => bytes[at..end].iter_mut().take(2).for_each(|byte| *byte ^= 1 << (num % 8)),
        }
    }
    bytes
}

/// Inputs of a target that takes less than a millisecond each, and of one that takes some thirty.
const MANY: u32 = 5_000;
const FEW: u32 = 100;

/// Replays a target's corpus, then so many inputs from a fixed seed; `BASRELIEF_CASES` says how
/// many instead.
fn replay(num: u32, target: &str, run: fn(&[u8])) {
    let seeds = corpus(target);
    let check = |what: &str, bytes: &[u8]| {
        let result = std::panic::catch_unwind(|| run(bytes));
        assert!(result.is_ok(), "{target} fails on {what}: {bytes:?}");
    };
    seeds.iter().for_each(|(path, bytes)| check(path, bytes));
    let num = std::env::var("BASRELIEF_CASES").ok().and_then(|num| num.parse().ok()).unwrap_or(num);
    let mut random = Rng::with_seed(2017);
    (0..num).for_each(|i| check(&format!("input {i}"), &damaged(&mut random, &seeds)));
}

macro_rules! replays {
    ($($target:ident $num:ident;)*) => {
        mod replays {
            $(#[test]
            fn $target() {
                super::replay(super::$num, stringify!($target), basrelief_fuzz::$target);
            })*
        }
    };
}

replays! {
    command_line MANY;
    coverage MANY;
    footprint_ellipse MANY;
    horizon MANY;
    layers MANY;
    load_gltf MANY;
    outlines MANY;
    load_image MANY;
    load_mtl MANY;
    load_obj MANY;
    march MANY;
    parallax MANY;
    render MANY;
    symmetry MANY;
    tables FEW;
    visible_sets MANY;
}
