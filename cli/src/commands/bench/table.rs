//! The figures as a table for people.

use super::report::{Against, Case, Report};

/// A table for each scene, and what is measured on what.
pub(super) fn text(report: &Report) -> String {
    let Report { version, simd, processor, system, threads, .. } = report;
    let [width, height] = report.size;
    let [truth_width, truth_height] = report.truth_size;
    let threads = if *threads == 1 { "1 thread".into() } else { format!("{threads} threads") };
    let mut text = format!(
        "basrelief {version} ({simd}), {processor}, {system}\n\
         {width}x{height}, one sample a pixel, {threads}; PSNR at {truth_width}x{truth_height} against {} rays a pixel\n",
        report.truth_samples
    );
    for cases in report.cases.chunk_by(|a, b| a.scene == b.scene) {
        let Case { scene, pixels, triangles, .. } = &cases[0];
        text += &format!("\n{scene}: {triangles} triangles, {pixels} pixels\n");
        let is_compared = cases.iter().any(|case| case.against.is_some());
        let rows = rows(cases, is_compared);
        // What the noise says of a ratio stands last.
        let words = rows[0].len() - usize::from(is_compared);
        text += &aligned(&rows, words);
    }
    text
}

/// A row of names, and one for each case.
fn rows(cases: &[Case], is_compared: bool) -> Vec<Vec<String>> {
    // Where triangles are few, how many are drawn a second says nothing.
    let has_rate = cases[0].triangles > cases[0].pixels;
    let row = |first: [&str; 4], rate: &str, psnr: &str, against: [String; 3]| {
        let mut row: Vec<String> = first.map(Into::into).into();
        row.extend(has_rate.then(|| rate.into()));
        row.push(psnr.into());
        row.extend(against.into_iter().filter(|_| is_compared));
        row
    };
    let names = ["before", "ratio", "noise"].map(Into::into);
    let mut rows = vec![row(["filter", "ms", "spread", "Mpixel/s"], "Mtri/s", "PSNR, dB", names)];
    rows.extend(cases.iter().map(|case| {
        let (ms, spread) = (decimals(case.frame_ms), percent(case.spread));
        let psnr = case.psnr_db.map_or("equal".into(), |psnr| format!("{psnr:.1}"));
        let (pixels, rate) = (format!("{:.1}", case.mpixel_s), format!("{:.1}", case.mtri_s));
        row([&case.filter, &ms, &spread, &pixels], &rate, &psnr, compared(case.against))
    }));
    rows
}

/// The time before, the ratio, and what the noise says of it.
fn compared(against: Option<Against>) -> [String; 3] {
    let Some(Against { frame_ms, ratio, noise, is_within_noise }) = against else {
        return ["-", "-", "not measured before"].map(Into::into);
    };
    let verdict = match is_within_noise {
        true => "within noise",
        false if ratio < 1.0 => "faster",
        false => "slower",
    };
    [decimals(frame_ms), format!("{ratio:.2}"), format!("{}, {verdict}", percent(noise))]
}

/// Columns as wide as they need be. Words, which are in the first column and from `words` on, begin
/// at the left, numbers end at the right.
fn aligned(rows: &[Vec<String>], words: usize) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: Vec<usize> = (0..rows[0].len()).map(|column| width(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(i, (cell, &width))| {
            if i == 0 || i >= words {
                format!("   {cell:width$}")
            } else {
                format!("   {cell:>width$}")
            }
        });
        cells.collect::<String>().trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

/// Three figures.
fn decimals(ms: f64) -> String {
    match ms {
        ms if ms < 10.0 => format!("{ms:.2}"),
        ms if ms < 100.0 => format!("{ms:.1}"),
        ms => format!("{ms:.0}"),
    }
}

fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}
