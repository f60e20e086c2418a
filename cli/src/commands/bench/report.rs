//! The figures of a run, as they are written and read again.

use crate::machine::Machine;
use crate::options::bench::BenchOptions;
use crate::refusal::Refusal;
use crate::timing::{Took, middle};
use basrelief::SIMD_LEVEL;
use serde::{Deserialize, Serialize};

/// One JSON object. Times are in milliseconds.
#[derive(Serialize, Deserialize)]
pub(super) struct Report {
    pub(super) version: String,
    pub(super) simd: String,
    pub(super) processor: String,
    pub(super) system: String,
    pub(super) threads: usize,
    /// Width and height of the frames that are timed, and of those held against the truth.
    pub(super) size: [u32; 2],
    pub(super) truth_size: [u32; 2],
    pub(super) truth_samples: u32,
    pub(super) cases: Vec<Case>,
}

/// A filter on a scene.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Case {
    pub(super) scene: String,
    pub(super) filter: String,
    /// The middle time of a frame.
    pub(super) frame_ms: f64,
    /// All times, the fastest first.
    pub(super) times_ms: Vec<f64>,
    /// The slowest less the fastest, over the middle.
    pub(super) spread: f64,
    /// Pixels that see the scene, and triangles of it.
    pub(super) pixels: u64,
    pub(super) triangles: u64,
    /// Millions of them a second.
    pub(super) mpixel_s: f64,
    pub(super) mtri_s: f64,
    /// None where the pictures are equal.
    pub(super) psnr_db: Option<f64>,
    /// Beside the earlier run, if there is one that has the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) against: Option<Against>,
}

/// How a case is to that of an earlier run.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(super) struct Against {
    pub(super) frame_ms: f64,
    /// The time now over the time then.
    pub(super) ratio: f64,
    /// The larger spread of the two runs.
    pub(super) noise: f64,
    pub(super) is_within_noise: bool,
}

impl Report {
    /// A report without cases.
    pub(super) fn new(machine: Machine, options: &BenchOptions) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").into(),
            simd: SIMD_LEVEL.into(),
            processor: machine.processor,
            system: machine.system,
            threads: machine.threads,
            size: options.size,
            truth_size: options.truth_size,
            truth_samples: options.truth_samples,
            cases: Vec::new(),
        }
    }

    /// The object, on one line.
    pub(super) fn json(&self) -> Result<Vec<u8>, Refusal> {
        let mut json = serde_json::to_vec(self).map_err(|e| format!("--json: {e}"))?;
        json.push(b'\n');
        Ok(json)
    }
}

impl Case {
    /// What frames took, the fastest first.
    pub(super) fn new([scene, filter]: [&str; 2], took: &[Took], psnr_db: f64) -> Self {
        let (frame_ms, stats) = middle(took);
        let times_ms: Vec<f64> = took.iter().map(|(ms, _)| *ms).collect();
        let per_second = |num: u64| num as f64 / frame_ms / 1e3;
        Self {
            scene: scene.into(),
            filter: filter.into(),
            frame_ms,
            spread: spread(&times_ms),
            times_ms,
            pixels: stats.pixels_shaded,
            triangles: stats.triangles_in,
            mpixel_s: per_second(stats.pixels_shaded),
            mtri_s: per_second(stats.triangles_in),
            psnr_db: psnr_db.is_finite().then_some(psnr_db),
            against: None,
        }
    }
}

/// The slowest time less the fastest, over the middle.
pub(super) fn spread(sorted: &[f64]) -> f64 {
    match sorted {
        [fastest, .., slowest] => (slowest - fastest) / middle(sorted),
        _ => 0.0,
    }
}
