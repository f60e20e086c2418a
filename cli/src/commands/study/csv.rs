//! The figures as a table for other programs.

use crate::commands::study::gather::Study;
use std::fmt::Write;

/// Comma-separated values with a row of names; an infinite ratio is `inf`.
pub(crate) fn table(study: &Study) -> String {
    let front = study.front(|outcome| outcome.psnr);
    let mut table = String::from(
        "filter,options,width,height,threads,frame_ms,psnr_db,ssim,flip,on_psnr_front\n",
    );
    for (i, outcome) in study.outcomes.iter().enumerate() {
        let basrelief::Settings { width, height, .. } = study.settings;
        let (name, options, threads) =
            (outcome.trial.name, &outcome.trial.options, study.machine.threads);
        let _ = writeln!(
            table,
            "\"{name}\",{options},{width},{height},{threads},{:.3},{:.4},{:.6},{:.6},{}",
            outcome.ms,
            outcome.psnr,
            outcome.ssim,
            outcome.flip,
            front.contains(&i)
        );
    }
    table
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_trial_has_a_row() {
        let table = super::table(&crate::commands::study::gather::tests::study(&[
            (10.0, 30.0),
            (20.0, f64::INFINITY),
        ]));
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(
            lines[1].starts_with("\"nearest\",--filter nearest,1280,720,")
                && lines[1].ends_with(",true")
        );
        assert!(lines[2].contains(",20.000,inf,0.9"), "{}", lines[2]);
    }
}
