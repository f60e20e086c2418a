//! Quality bars: each filter against supersampled truth on a small procedural floor. The goals are those on a large floor at
//! 640 x 360; here stands what this small one reaches.

mod common;

use basrelief::metrics::compare;
use basrelief::texture::Surface;
use basrelief::{Derivatives, Filter, Frame, Renderer, Scene, Settings, Visibility};
use common::{cobbles, floor_scene};
use std::sync::OnceLock;

fn settings(filter: Filter) -> Settings {
    Settings { width: 160, height: 90, filter, texel_budget: 0, samples: 256, far_field: false, ..Settings::default() }
}

fn floor() -> Scene {
    floor_scene(Surface::new(cobbles(128, 4)).expect("valid maps"), 0.5)
}

fn draw(settings: Settings) -> Frame {
    Renderer::new(floor(), settings).expect("a valid scene").render()
}

/// Decibels of a filter against 256 rays a pixel.
fn psnr(settings: Settings) -> f64 {
    static TRUTH: OnceLock<Frame> = OnceLock::new();
    let truth = TRUTH.get_or_init(|| draw(self::settings(Filter::Truth)));
    let psnr = compare(&(&draw(settings.clone())).into(), &truth.into()).expect("frames of one size").psnr_db;
    println!("{:?} {:?} {:?}: {psnr:.2} dB", settings.filter, settings.visibility, settings.derivatives);
    psnr
}

fn visible(visibility: Visibility) -> f64 {
    psnr(Settings { visibility, ..settings(Filter::Visible) })
}

#[test]
fn visible_texels_beat_all_texels() {
    let ewa = psnr(settings(Filter::Ewa));
    let exact = visible(Visibility::Exact);
    assert!(exact > ewa + 6.0, "{exact} dB is not 6 above {ewa}");
    // The goal on the large floor is 30 dB.
    assert!(exact > 27.0, "{exact} dB");
}

#[test]
fn two_ended_rows_come_close_to_rays_from_every_texel() {
    let (exact, two_ended) = (visible(Visibility::Exact), visible(Visibility::TwoEnded));
    assert!((exact - two_ended).abs() < 1.5, "{two_ended} dB, {exact} by rays");
}

#[test]
fn resolved_draws_what_exact_draws() {
    let [exact, resolved] = [Visibility::Exact, Visibility::Resolved]
        .map(|visibility| draw(Settings { visibility, ..settings(Filter::Visible) }));
    assert!(exact == resolved);
}

#[test]
fn horizon_beats_the_visible_texels() {
    let (exact, horizon) = (visible(Visibility::Exact), psnr(settings(Filter::Horizon)));
    // The goal on the large floor at 16 lines is 44 dB.
    assert!(horizon > exact + 8.0 && horizon > 40.0, "{horizon} dB, {exact} by the paper's method");
}

#[test]
fn many_rays_come_close_to_truth_and_few_do_not() {
    let [few, many] = [1, 16].map(|samples| psnr(Settings { samples, ..settings(Filter::Parallax) }));
    assert!(many > few + 6.0 && many > 30.0, "{few} and {many} dB");
    let flat = psnr(Settings { parallax: false, derivatives: Derivatives::Flat, ..settings(Filter::Ewa) });
    assert!(flat < 25.0, "without parallax {flat} dB");
}
