//! Quality against time, as SVG whose colours the page sets.

use crate::commands::study::gather::{Outcome, Study};
use crate::refusal::Refusal;
use plotters::prelude::*;

const SIZE: (u32, u32) = (440, 370);
/// Colours that the page replaces: ink, grid, points, front.
const INK: RGBColor = RGBColor(17, 17, 17);
const GRID: RGBColor = RGBColor(221, 221, 221);
const POINT: RGBColor = RGBColor(1, 115, 178);
const FRONT: RGBColor = RGBColor(222, 143, 5);

/// What is drawn upwards.
pub(crate) struct Axis {
    pub(crate) title: &'static str,
    /// The number that is drawn.
    pub(crate) value: fn(&Outcome) -> f64,
    /// Whether less is better: then the axis is turned over, so that better is higher.
    pub(crate) is_falling: bool,
}

impl Axis {
    /// The trials that nothing beats.
    pub(crate) fn front(&self, study: &Study) -> Vec<usize> {
        let sign = if self.is_falling { -1.0 } else { 1.0 };
        study.front(|outcome| sign * (self.value)(outcome))
    }
}

/// A chart of a study, its points numbered from 1 as the trials are.
pub(crate) fn svg(study: &Study, axis: &Axis) -> Result<String, Refusal> {
    let mut svg = String::new();
    draw(study, axis, &mut svg).map_err(|e| format!("chart: {e}"))?;
    Ok(svg)
}

fn draw(study: &Study, axis: &Axis, svg: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let point = |outcome: &Outcome| (outcome.ms.max(0.01), (axis.value)(outcome));
    let points: Vec<(f64, f64)> = study.outcomes.iter().map(point).collect();
    let finite = || points.iter().filter(|(_, value)| value.is_finite());
    let [first, last] = bounds(finite().map(|p| p.0));
    let (left, right) = (first * 0.7, last * 1.6);
    let [low, high] = bounds(finite().map(|p| p.1));
    let margin = ((high - low) * 0.08).max(high.abs() * 1e-3).max(1e-6);
    let (low, high) = (low - margin, high + margin);
    let (bottom, top) = if axis.is_falling { (high, low) } else { (low, high) };
    let area = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    let mut chart = ChartBuilder::on(&area)
        .margin(10)
        .margin_right(24)
        .x_label_area_size(42)
        .y_label_area_size(58)
        .build_cartesian_2d(
            (left..right).log_scale().with_key_points(times(left, right)),
            bottom..top,
        )?;
    let text = ("sans-serif", 14).into_font().color(&INK);
    chart
        .configure_mesh()
        .x_desc("milliseconds a frame")
        .y_desc(axis.title)
        .x_label_formatter(&|ms| if *ms < 1.0 { format!("{ms:.2}") } else { format!("{ms:.0}") })
        .y_label_formatter(&|value| {
            if high < 1.5 { format!("{value:.2}") } else { format!("{value:.0}") }
        })
        .label_style(text.clone())
        .axis_style(INK)
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .draw()?;
    let front = axis.front(study);
    let line = front.iter().map(|&i| points[i]).filter(|p| p.1.is_finite());
    chart.draw_series(LineSeries::new(line, FRONT.stroke_width(2)))?;
    let shown: Vec<usize> = (0..points.len()).filter(|&i| points[i].1.is_finite()).collect();
    let places: Vec<(i32, i32)> = shown.iter().map(|&i| chart.backend_coord(&points[i])).collect();
    for ((&i, &place), offset) in shown.iter().zip(&places).zip(label_offsets(&places)) {
        let color = if front.contains(&i) { FRONT } else { POINT };
        area.draw(&Circle::new(place, 5, color.filled()))?;
        area.draw(&Text::new(
            (i + 1).to_string(),
            (place.0 + offset.0, place.1 + offset.1),
            text.clone(),
        ))?;
    }
    area.present()?;
    Ok(())
}

/// Where labels stand from their points, each where no point and no label before it is, if there is
/// such a place.
fn label_offsets(places: &[(i32, i32)]) -> Vec<(i32, i32)> {
    const SIZE: (i32, i32) = (16, 14);
    let near = [(7, -14), (7, 2), (-22, -14), (-22, 2), (-7, -22), (-7, 8)];
    // Farther out in the same directions where points are crowded.
    let offsets = || (1..=3).flat_map(|times| near.map(|(x, y)| (x * times, y * times)));
    let mut corners: Vec<(i32, i32)> = Vec::new();
    let choose = |&(x, y): &(i32, i32)| {
        let is_free = |&(dx, dy): &(i32, i32)| {
            let (left, top) = (x + dx, y + dy);
            let over_label =
                |c: &(i32, i32)| (left - c.0).abs() < SIZE.0 && (top - c.1).abs() < SIZE.1;
            let over_point = |p: &(i32, i32)| {
                (left - 5..left + SIZE.0 + 5).contains(&p.0)
                    && (top - 4..top + SIZE.1 + 4).contains(&p.1)
            };
            !corners.iter().any(over_label) && !places.iter().any(over_point)
        };
        let offset = offsets().find(is_free).unwrap_or(near[0]);
        corners.push((x + offset.0, y + offset.1));
        offset
    };
    places.iter().map(choose).collect()
}

/// Times that the axis names: 1, 2 and 5 of each power of ten between two.
fn times(left: f64, right: f64) -> Vec<f64> {
    let powers = (left.log10().floor() as i32..=right.log10().ceil() as i32)
        .map(|power| 10.0_f64.powi(power));
    let steps = powers.flat_map(|power| [power, 2.0 * power, 5.0 * power]);
    steps.filter(|ms| (left..=right).contains(ms)).collect()
}

/// Least and greatest, or 1 and 2 of nothing.
fn bounds(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = values.fold([f64::MAX, f64::MIN], |[low, high], v| [low.min(v), high.max(v)]);
    if low <= high { [low, high] } else { [1.0, 2.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finite_trials_are_numbered_points() {
        let study = crate::commands::study::gather::tests::study(&[
            (10.0, 30.0),
            (20.0, f64::INFINITY),
            (400.0, 50.0),
        ]);
        let axis = Axis { title: "PSNR", value: |outcome| outcome.psnr, is_falling: false };
        let svg = svg(&study, &axis).unwrap();
        assert_eq!(svg.matches("<circle").count(), 2, "{svg}");
        assert!(svg.contains("PSNR") && svg.starts_with("<svg"));
    }

    #[test]
    fn times_are_labelled_in_steps_of_about_two() {
        assert_eq!(times(0.6, 30.0), [1.0, 2.0, 5.0, 10.0, 20.0]);
        assert_eq!(times(70.0, 120.0), [100.0]);
    }

    #[test]
    fn labels_of_crowded_points_do_not_overlap() {
        let places = [(100, 100), (100, 101), (103, 98), (109, 92), (200, 100)];
        let offsets = label_offsets(&places);
        let corners: Vec<_> =
            places.iter().zip(&offsets).map(|(p, o)| (p.0 + o.0, p.1 + o.1)).collect();
        for (i, a) in corners.iter().enumerate() {
            assert!(
                corners[..i].iter().all(|b| (a.0 - b.0).abs() >= 16 || (a.1 - b.1).abs() >= 14),
                "{corners:?}"
            );
        }
        assert_eq!(offsets[4], (7, -14), "alone a label stands at the upper right");
    }

    #[test]
    fn equal_trials_are_a_chart_too() {
        let study = crate::commands::study::gather::tests::study(&[(10.0, 30.0), (10.0, 30.0)]);
        let axis = Axis { title: "FLIP", value: |outcome| outcome.flip, is_falling: true };
        assert!(svg(&study, &axis).unwrap().contains("</svg>"));
    }
}
