//! An earlier run, and how this one is beside it.

use super::report::{Against, Case, Report, spread};
use crate::refusal::Refusal;
use crate::timing::middle;
use std::path::Path;

/// An earlier run of the same frames.
pub(super) struct Earlier(Report);

impl Earlier {
    /// Reads a run of frames like those of `now`.
    pub(super) fn read(path: &Path, now: &Report) -> Result<Self, Refusal> {
        let refuse = |reason: String| Refusal::file(path, reason);
        let bytes = std::fs::read(path).map_err(|e| refuse(format!("cannot be read: {e}")))?;
        let mut then: Report = serde_json::from_slice(&bytes)
            .map_err(|e| refuse(format!("is not what bench --json writes: {e}")))?;
        for case in &mut then.cases {
            // Middle and spread are taken of the times, whatever the file says of them.
            case.times_ms.sort_by(f64::total_cmp);
            if case.times_ms.is_empty() || !case.times_ms.iter().all(|ms| *ms > 0.0) {
                let Case { scene, filter, .. } = case;
                return Err(refuse(format!("has no times of {filter} on {scene}")));
            }
        }
        let frames = |report: &Report| {
            let [width, height] = report.size;
            let threads = if report.threads == 1 { "thread" } else { "threads" };
            format!("{width}x{height} on {} {threads}", report.threads)
        };
        if frames(&then) != frames(now) {
            let (then, now) = (frames(&then), frames(now));
            return Err(refuse(format!(
                "is of frames of {then}, and these are of {now} (--size, --threads)"
            )));
        }
        Ok(Self(then))
    }

    /// What else than the program may be why times differ.
    pub(super) fn difference(&self, now: &Report) -> Option<String> {
        let machine = |report: &Report| format!("{}, {}", report.processor, report.simd);
        let (then, now) = (machine(&self.0), machine(now));
        (then != now).then(|| format!("the earlier run is of {then}; this one of {now}"))
    }

    /// Puts the earlier figures beside those of `cases`.
    pub(super) fn compare(&self, cases: &mut [Case]) {
        for case in cases {
            let is_same = |then: &&Case| then.scene == case.scene && then.filter == case.filter;
            case.against = self.0.cases.iter().find(is_same).map(|then| beside(case, then));
        }
    }
}

fn beside(now: &Case, then: &Case) -> Against {
    let frame_ms = middle(&then.times_ms);
    let ratio = now.frame_ms / frame_ms;
    // Frames of one run differ by noise alone.
    let noise = now.spread.max(spread(&then.times_ms));
    // Of two times the slower is compared with the faster, so that which is first does not matter.
    let is_within_noise = ratio.max(1.0 / ratio) - 1.0 <= noise;
    Against { frame_ms, ratio, noise, is_within_noise }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basrelief::Stats;

    fn case(times: &[f64]) -> Case {
        let took: Vec<_> = times.iter().map(|&ms| (ms, Stats::default())).collect();
        Case::new(["floor", "horizon"], &took, 40.0)
    }

    #[test]
    fn differences_beyond_the_spread_are_told() {
        let then = case(&[9.5, 10.0, 10.5]);
        for (times, ratio, is_within_noise) in [
            (&[10.0, 10.5, 10.6][..], 1.05, true),
            (&[12.0], 1.2, false),
            (&[8.0], 0.8, false),
            (&[12.0, 13.0, 17.0], 1.3, true),
        ] {
            let found = beside(&case(times), &then);
            assert!((found.ratio - ratio).abs() < 1e-9 && found.frame_ms == 10.0);
            assert_eq!(found.is_within_noise, is_within_noise, "{times:?}");
        }
    }
}
