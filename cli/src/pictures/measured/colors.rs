//! What colour a number has.

use crate::pictures::draw::Ramp;
use basrelief::inspect::{Measured, View};
use basrelief::texture::srgb8_from_linear;

/// sRGB.
type Rgb = [u8; 3];

/// Where no surface is seen.
const NOTHING: Rgb = [24, 26, 30];
/// Colours for one, two, three and more triangles in a pixel.
const COUNTS: [Rgb; 4] = [[86, 120, 150], [240, 200, 60], [230, 120, 40], [200, 40, 60]];
/// Mip levels and binary logarithms of areas at the other end of the scale.
const MOST_LEVEL: f32 = 10.0;
const MOST_LOG_AREA: f32 = 20.0;

/// How a view's numbers become colours.
pub(crate) struct Scale {
    view: View,
    /// Binary logarithms of the least and greatest distance in the frame.
    distances: [f32; 2],
}

/// What the legend shows.
pub(crate) enum Key {
    /// A bar, and what stands at places of it, 0 to 1.
    Bar { ramp: Ramp, ticks: Vec<(f32, String)> },
    /// Areas of one colour.
    Areas(Vec<(Rgb, String)>),
}

impl Scale {
    pub(crate) fn new(measured: &Measured, view: View) -> Self {
        let logs = measured
            .pixels
            .iter()
            .flatten()
            .map(|[distance, ..]| distance.log2())
            .filter(|log| log.is_finite());
        let (low, high) =
            logs.fold((f32::MAX, f32::MIN), |(low, high), log| (low.min(log), high.max(log)));
        let distances = if low < high { [low, high] } else { [0.0, 1.0] };
        Self { view, distances }
    }

    pub(crate) fn title(&self) -> &'static str {
        match self.view {
            View::Coverage => "triangles that a pixel sees (darker: covered in part)",
            View::Mip => "mip level read (striped: tables of the far field)",
            View::Footprint => "texels of the full texture in the pixel's ellipse",
            View::Visible => "part of the ellipse's texels that is visible",
            View::Horizon => "part of the rows swept for a pixel that it sees",
            View::Depth => "distance along the view, in the scene's units",
            View::Normal => "normal of the relief in world space",
            View::Uv => "texture coordinates of the hit, within a repeat",
            View::Shadow => "part of what suns and points send that reaches the hit",
            View::Light => "what lights and sky light a white surface to at the hit",
            View::Occlusion => "part of the sky that nothing hides from the hit",
        }
    }

    pub(crate) fn key(&self) -> Key {
        let shares = || [0, 25, 50, 75, 100].map(|p| (p as f32 / 100.0, format!("{p}%"))).to_vec();
        let steps = |most: i32, text: &dyn Fn(i32) -> String| {
            (0..=most).map(|i| (i as f32 / most as f32, text(i))).collect::<Vec<_>>()
        };
        match self.view {
            View::Coverage => {
                let texts = ["one", "two", "three", "four or more"];
                let mut areas: Vec<_> = COUNTS.into_iter().zip(texts.map(str::to_owned)).collect();
                areas.push((NOTHING, "none".into()));
                Key::Areas(areas)
            }
            View::Mip => Key::Bar {
                ramp: Ramp::Viridis,
                ticks: steps(MOST_LEVEL as i32, &|i| i.to_string()),
            },
            View::Footprint => {
                let ticks = steps(MOST_LOG_AREA as i32 / 2, &|i| (1_u32 << (2 * i)).to_string());
                Key::Bar { ramp: Ramp::Viridis, ticks }
            }
            View::Visible | View::Horizon | View::Shadow | View::Occlusion => {
                Key::Bar { ramp: Ramp::Hidden, ticks: shares() }
            }
            View::Light => Key::Areas(
                [0.0, 0.25, 0.5, 0.75, 1.0]
                    .map(|light| {
                        let more = if light == 1.0 { " and more" } else { "" };
                        (of_light([light; 3]), format!("{light}{more}"))
                    })
                    .to_vec(),
            ),
            View::Depth => {
                let [low, high] = self.distances;
                let ticks = steps(4, &|i| distance((low + (high - low) * i as f32 / 4.0).exp2()));
                Key::Bar { ramp: Ramp::Viridis, ticks }
            }
            View::Normal => Key::Areas(
                [
                    ([1.0, 0.0, 0.0], "+x"),
                    ([0.0, 1.0, 0.0], "+y (up)"),
                    ([0.0, 0.0, 1.0], "+z"),
                    ([-1.0, 0.0, 0.0], "-x"),
                ]
                .map(|(normal, text)| (of_normal(normal), text.to_owned()))
                .to_vec(),
            ),
            View::Uv => Key::Areas(
                [
                    ([0.0, 0.0], "u 0, v 0"),
                    ([0.99, 0.0], "u 1"),
                    ([0.0, 0.99], "v 1"),
                    ([0.99, 0.99], "u 1, v 1"),
                ]
                .map(|(uv, text)| (of_uv(uv), text.to_owned()))
                .to_vec(),
            ),
        }
    }

    /// The colour of every pixel.
    pub(crate) fn colors(&self, measured: &Measured) -> Vec<Rgb> {
        let width = measured.width as usize;
        let color = |(i, value): (usize, &Option<[f32; 3]>)| match value {
            Some(value) => self.color(*value, [i % width, i / width]),
            None => NOTHING,
        };
        measured.pixels.iter().enumerate().map(color).collect()
    }

    fn color(&self, [a, b, c]: [f32; 3], [x, y]: [usize; 2]) -> Rgb {
        match self.view {
            View::Coverage => {
                let count = COUNTS[(a as usize).clamp(1, COUNTS.len()) - 1];
                mix(NOTHING, count, 0.3 + 0.7 * b)
            }
            View::Mip => {
                let level = Ramp::Viridis.at(a / MOST_LEVEL);
                let is_striped = b > 0.5 && (x + y) % 8 < 2;
                if is_striped { mix(level, [255; 3], 0.6) } else { level }
            }
            View::Footprint => Ramp::Viridis.at(a.max(1.0).log2() / MOST_LOG_AREA),
            View::Visible | View::Horizon | View::Shadow | View::Occlusion => Ramp::Hidden.at(a),
            View::Light => of_light([a, b, c]),
            View::Depth => {
                let [low, high] = self.distances;
                Ramp::Viridis.at((a.log2() - low) / (high - low))
            }
            View::Normal => of_normal([a, b, c]),
            View::Uv => of_uv([a, b]),
        }
    }
}

fn mix(from: Rgb, to: Rgb, part: f32) -> Rgb {
    std::array::from_fn(|i| {
        (f32::from(from[i]) * (1.0 - part) + f32::from(to[i]) * part + 0.5) as u8
    })
}

fn of_normal(normal: [f32; 3]) -> Rgb {
    normal.map(|c| ((c * 0.5 + 0.5) * 255.0 + 0.5) as u8)
}

/// As pictures show light.
fn of_light(light: [f32; 3]) -> Rgb {
    light.map(srgb8_from_linear)
}

/// Red grows with u and green with v in each repeat.
fn of_uv(uv: [f32; 2]) -> Rgb {
    let [u, v] = uv.map(|c| ((c - c.floor()) * 255.0) as u8);
    [u, v, 96]
}

fn distance(d: f32) -> String {
    if d >= 100.0 { format!("{d:.0}") } else { format!("{d:.2}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(values: &[Option<f32>]) -> Measured {
        let pixels = values.iter().map(|value| value.map(|v| [v, 1.0, 0.0])).collect();
        Measured { width: values.len() as u32, height: 1, pixels }
    }

    #[test]
    fn distances_fill_the_scale_and_nothing_is_dark() {
        let measured = measured(&[Some(2.0), None, Some(32.0)]);
        let scale = Scale::new(&measured, View::Depth);
        assert_eq!(
            scale.colors(&measured),
            [Ramp::Viridis.at(0.0), NOTHING, Ramp::Viridis.at(1.0)]
        );
        let Key::Bar { ticks, .. } = scale.key() else { panic!("a bar") };
        assert_eq!((ticks[0].1.as_str(), ticks[4].1.as_str()), ("2.00", "32.00"));
    }

    #[test]
    fn one_distance_alone_is_a_colour() {
        let measured = measured(&[Some(5.0), Some(5.0)]);
        assert_eq!(Scale::new(&measured, View::Depth).colors(&measured).len(), 2);
    }

    #[test]
    fn legends_show_the_colours_of_the_frame() {
        let frame = measured(&[Some(1.0), Some(7.0)]);
        let scale = Scale::new(&frame, View::Coverage);
        let Key::Areas(areas) = scale.key() else { panic!("areas") };
        assert_eq!(scale.colors(&frame), [areas[0].0, areas[3].0]);
    }
}
