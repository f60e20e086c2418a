//! The figures of `--stats`.

use basrelief::{SIMD_LEVEL, Settings, Stats};
use serde::Serialize;
use std::path::Path;

use crate::options::choices::word;
use crate::refusal::Refusal;
use crate::timing::{self, Took};

/// One JSON object; of several pictures in a row where `--json` prints one a line. Times are in
/// milliseconds; those of a frame belong to the frame of the middle time.
#[derive(Serialize)]
pub(crate) struct Report {
    frame_ms: f64,
    load_ms: f64,
    geometry_ms: f64,
    raster_ms: f64,
    binning_ms: f64,
    coverage_ms: f64,
    attributes_ms: f64,
    shade_ms: f64,
    pixels_shaded: u64,
    quads_shaded: u64,
    triangles_in: u64,
    triangles_drawn: u64,
    texels_tested: u64,
    texels_visible: u64,
    threads: usize,
    simd: &'static str,
    version: &'static str,
    width: u32,
    height: u32,
    filter: &'static str,
    /// The picture's file, where the report is of one picture among others, and its number.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    frame: Option<u32>,
}

/// Adds what drawing another part of a picture took.
pub(crate) fn add(sum: &mut Stats, part: &Stats) {
    sum.geometry_ms += part.geometry_ms;
    sum.raster_ms += part.raster_ms;
    sum.binning_ms += part.binning_ms;
    sum.coverage_ms += part.coverage_ms;
    sum.attributes_ms += part.attributes_ms;
    sum.shade_ms += part.shade_ms;
    sum.pixels_shaded += part.pixels_shaded;
    sum.quads_shaded += part.quads_shaded;
    sum.texels_tested += part.texels_tested;
    sum.texels_visible += part.texels_visible;
    // Every part projects all triangles.
    (sum.triangles_in, sum.triangles_drawn) = (part.triangles_in, part.triangles_drawn);
}

impl Report {
    /// The figures of the frame of the middle time (of an even number, the faster of the middle
    /// two).
    pub(crate) fn new(
        mut frames: Vec<Took>,
        load_ms: f64,
        threads: usize,
        settings: &Settings,
    ) -> Self {
        timing::sort(&mut frames);
        let (frame_ms, stats) = timing::middle(&frames);
        Self {
            frame_ms,
            load_ms,
            geometry_ms: stats.geometry_ms,
            raster_ms: stats.raster_ms,
            binning_ms: stats.binning_ms,
            coverage_ms: stats.coverage_ms,
            attributes_ms: stats.attributes_ms,
            shade_ms: stats.shade_ms,
            pixels_shaded: stats.pixels_shaded,
            quads_shaded: stats.quads_shaded,
            triangles_in: stats.triangles_in,
            triangles_drawn: stats.triangles_drawn,
            texels_tested: stats.texels_tested,
            texels_visible: stats.texels_visible,
            threads,
            simd: SIMD_LEVEL,
            version: env!("CARGO_PKG_VERSION"),
            width: settings.drawn().width,
            height: settings.drawn().height,
            filter: word(&settings.filter),
            file: None,
            frame: None,
        }
    }

    /// The report of the picture in `file`, which may be one frame of many.
    pub(crate) fn of_picture(self, file: &Path, frame: Option<u32>) -> Self {
        Self { file: Some(file.display().to_string()), frame, ..self }
    }

    /// A line for people.
    pub(crate) fn line(&self) -> String {
        let Self { width, height, filter, frame_ms, load_ms, threads, .. } = self;
        let threads = if *threads == 1 { "1 thread".into() } else { format!("{threads} threads") };
        format!(
            "{width}x{height}, filter {filter}: {frame_ms:.1} ms on {threads}, after {load_ms:.0} ms of loading"
        )
    }

    /// The object, on one line.
    pub(crate) fn json(&self) -> Result<Vec<u8>, Refusal> {
        let mut json = serde_json::to_vec(self).map_err(|e| format!("--stats: {e}"))?;
        json.push(b'\n');
        Ok(json)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn middle_frame_is_reported() {
        let frame = |ms: f64| (ms, Stats { shade_ms: ms / 2.0, ..Stats::default() });
        for (times, expected) in
            [(&[3.0, 1.0, 2.0][..], 2.0), (&[4.0, 3.0, 1.0, 2.0], 2.0), (&[5.0], 5.0)]
        {
            let frames = times.iter().map(|&ms| frame(ms)).collect();
            let report = Report::new(frames, 1.0, 2, &Settings::default());
            assert_eq!((report.frame_ms, report.shade_ms), (expected, expected / 2.0));
        }
    }
}
