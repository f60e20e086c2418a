//! `basrelief compare`: how far two images are apart.

use crate::commands::golden;
use crate::options::compare::CompareOptions;
use crate::output;
use crate::refusal::Refusal;
use basrelief::Error;
use basrelief::metrics::{self, Difference, Picture};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// One JSON object. Errors are 0 to 1; an infinite ratio is null.
#[derive(Serialize)]
struct Report {
    width: u32,
    height: u32,
    pixels_compared: u64,
    pixels_of_unequal_opacity: u64,
    is_equal: bool,
    psnr_db: Option<f64>,
    largest_error: f64,
    x: u32,
    y: u32,
    channel: &'static str,
    ssim: f64,
}

/// Compares the images that the options name.
pub(crate) fn run(options: &CompareOptions) -> Result<ExitCode, Refusal> {
    let paths = match (&options.golden, &options.b) {
        (Some(folder), _) => return golden::run(options, folder),
        (None, Some(b)) => [&options.a, b],
        (None, None) => return Err("B is missing".into()),
    };
    let format = options.heatmap.as_deref().map(output::image_format).transpose()?;
    let open = |path| Picture::open_within(path, options.max_pixels);
    let (a, b) = (open(paths[0])?, open(paths[1])?);
    let difference = metrics::compare(&a, &b).map_err(|e| refusal(paths, e))?;
    if let (Some(path), Some(format)) = (&options.heatmap, format) {
        let map = metrics::heat_map(&a, &b, options.heatmap_max).map_err(|e| refusal(paths, e))?;
        output::write(path, &map.encode(format)?)?;
    }
    let report = Report::new(&a, &difference);
    let text = if options.json { report.json()? } else { report.lines(options) };
    output::print(text.as_bytes())?;
    Ok(verdict(difference.psnr_db, options.min_psnr))
}

fn refusal([a, b]: [&PathBuf; 2], error: Error) -> Refusal {
    let reason = match error {
        Error::Picture { reason, .. } => reason,
        _ => error.to_string(),
    };
    format!("{} and {}: {reason}", a.display(), b.display()).into()
}

fn verdict(psnr_db: f64, bound: Option<f64>) -> ExitCode {
    match bound {
        Some(bound) if psnr_db < bound => {
            eprintln!("basrelief: PSNR {psnr_db:.2} dB is below --min-psnr {bound}");
            ExitCode::FAILURE
        }
        _ => ExitCode::SUCCESS,
    }
}

impl Report {
    fn new(a: &Picture, difference: &Difference) -> Self {
        let largest = difference.largest;
        Self {
            width: a.width(),
            height: a.height(),
            pixels_compared: difference.num_compared,
            pixels_of_unequal_opacity: difference.num_opacity_unequal,
            is_equal: difference.psnr_db.is_infinite() && difference.num_opacity_unequal == 0,
            psnr_db: difference.psnr_db.is_finite().then_some(difference.psnr_db),
            largest_error: largest.error,
            x: largest.x,
            y: largest.y,
            channel: ["red", "green", "blue"][largest.channel],
            ssim: difference.ssim,
        }
    }

    fn json(&self) -> Result<String, Refusal> {
        Ok(serde_json::to_string(self).map_err(|e| format!("--json: {e}"))? + "\n")
    }

    fn lines(&self, options: &CompareOptions) -> String {
        let num_pixels = u64::from(self.width) * u64::from(self.height);
        let mut lines = format!("pixels         {}x{}", self.width, self.height);
        if self.pixels_compared < num_pixels {
            lines += &format!(", {} of {num_pixels} opaque in both", self.pixels_compared);
        }
        if self.pixels_of_unequal_opacity > 0 {
            lines += &format!(", {} of unequal opacity", self.pixels_of_unequal_opacity);
        }
        lines += &match self.psnr_db {
            Some(psnr_db) => format!("\nPSNR           {psnr_db:.2} dB\n"),
            None => "\nPSNR           infinite: equal\n".into(),
        };
        let Self { largest_error, x, y, channel, .. } = self;
        let bytes = largest_error * 255.0;
        lines += &format!(
            "largest error  {largest_error:.4} ({bytes:.1} of 255) in {channel} at x {x}, y {y}\n"
        );
        lines += &format!("SSIM           {:.4}\n", self.ssim);
        if let Some(path) = &options.heatmap {
            lines += &format!("heat map       {}, 0 to {}\n", path.display(), options.heatmap_max);
        }
        lines
    }
}
