//! How long frames take.

use basrelief::{DrawnPixel, Frame, Renderer, Stats};
use std::time::Instant;

/// What a frame took: milliseconds in all, and by stages.
pub(crate) type Took = (f64, Stats);

/// Draws once to warm up and then `repeat` times. The frame, and what each took, the fastest first.
pub(crate) fn draw_repeated<P: DrawnPixel>(
    renderer: &mut Renderer,
    repeat: u32,
) -> (Frame<P>, Vec<Took>) {
    let mut frame = Frame::<P>::default();
    draw_timed(renderer, &mut frame);
    let mut took: Vec<Took> = (0..repeat).map(|_| draw_timed(renderer, &mut frame)).collect();
    sort(&mut took);
    (frame, took)
}

/// Draws the renderer's frame in memory, that of `frame` where it has the size.
pub(crate) fn draw_timed<P: DrawnPixel>(renderer: &mut Renderer, frame: &mut Frame<P>) -> Took {
    let start = Instant::now();
    let stats = renderer.render_timed(frame, &|| milliseconds(start));
    (milliseconds(start), stats)
}

/// The fastest first.
pub(crate) fn sort(took: &mut [Took]) {
    took.sort_by(|a, b| a.0.total_cmp(&b.0));
}

/// The middle of what is sorted; of an even number, the first of the middle two.
pub(crate) fn middle<T: Clone + Default>(sorted: &[T]) -> T {
    sorted.get(sorted.len().saturating_sub(1) / 2).cloned().unwrap_or_default()
}

pub(crate) fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
