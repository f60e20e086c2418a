//! The fuzz targets without a fuzzer: their corpora with past findings, and 10,000 random or damaged inputs each.
#![allow(unused_attributes, unreachable_pub, reason = "the targets are modules here, and programs for the fuzzer")]

// The targets name these two crates; here both are this one.
extern crate self as basrelief_fuzz;
extern crate self as libfuzzer_sys;

mod common;
#[path = "../fuzz/src/lib.rs"]
mod input;

use common::Random;
use input::{Input, Number, floor, hold};
use std::fs;
use std::path::Path;

/// What the fuzzer's macro of the same name makes of a target: a function of bytes.
#[macro_export]
macro_rules! fuzz_target {
    (|$bytes:ident: &[u8]| $body:expr) => {
        pub fn run($bytes: &[u8]) {
            $body
        }
    };
    (|$input:ident: $kind:ty| $body:expr) => {
        pub fn run(bytes: &[u8]) {
            use arbitrary::{Arbitrary, Unstructured};
            let is_enough = bytes.len() >= <$kind as Arbitrary>::size_hint(0).0;
            let read = <$kind as Arbitrary>::arbitrary_take_rest(Unstructured::new(bytes));
            if let (true, Ok($input)) = (is_enough, read) {
                $body
            }
        }
    };
}

#[path = "../fuzz/fuzz_targets/command_line.rs"]
mod command_line;
#[path = "../fuzz/fuzz_targets/coverage.rs"]
mod coverage;
#[path = "../fuzz/fuzz_targets/footprint_ellipse.rs"]
mod footprint_ellipse;
#[path = "../fuzz/fuzz_targets/horizon.rs"]
mod horizon;
#[path = "../fuzz/fuzz_targets/load_image.rs"]
mod load_image;
#[path = "../fuzz/fuzz_targets/load_mtl.rs"]
mod load_mtl;
#[path = "../fuzz/fuzz_targets/load_obj.rs"]
mod load_obj;
#[path = "../fuzz/fuzz_targets/march.rs"]
mod march;
#[path = "../fuzz/fuzz_targets/render.rs"]
mod render;
#[path = "../fuzz/fuzz_targets/symmetry.rs"]
mod symmetry;
#[path = "../fuzz/fuzz_targets/visible_sets.rs"]
mod visible_sets;

/// The files of a target's corpus, by name.
fn corpus(target: &str) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let paths = fs::read_dir(&folder).expect("a corpus").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = paths.map(|path| (path.display().to_string(), fs::read(&path).expect("read"))).collect();
    files.sort();
    assert!(!files.is_empty(), "{} is empty", folder.display());
    files
}

/// Bytes of up to 512, or a seed with some of its bytes changed, cut out, said twice or taken from another seed.
fn damaged(random: &mut Random, seeds: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut below = |num: usize| (random.bits() % num.max(1) as u64) as usize;
    if below(3) == 0 {
        let num = below(512);
        return (0..num).map(|_| random.bits() as u8).collect();
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

/// Replays a target's corpus, then 10,000 inputs from a fixed seed; `BASRELIEF_CASES` says how many instead.
fn replay(target: &str, run: fn(&[u8])) {
    let seeds = corpus(target);
    let check = |what: &str, bytes: &[u8]| {
        let result = std::panic::catch_unwind(|| run(bytes));
        assert!(result.is_ok(), "{target} fails on {what}: {bytes:?}");
    };
    seeds.iter().for_each(|(path, bytes)| check(path, bytes));
    let num = std::env::var("BASRELIEF_CASES").ok().and_then(|num| num.parse().ok()).unwrap_or(10_000);
    let mut random = Random(2017);
    (0..num).for_each(|i| check(&format!("input {i}"), &damaged(&mut random, &seeds)));
}

macro_rules! replays {
    ($($target:ident)*) => {
        mod replays {
            $(#[test]
            fn $target() {
                super::replay(stringify!($target), super::$target::run);
            })*
        }
    };
}

replays!(command_line coverage footprint_ellipse horizon load_image load_mtl load_obj march render symmetry visible_sets);
