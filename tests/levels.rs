//! What the inspector says that a filter reads, against what frames show.
//!
//! Every mip level has a colour of its own, so that a pixel of a frame tells which level it was
//! read from, and how two were blended. The number of texels that frames test tells whether the
//! sets that are shown are theirs.

mod common;

use basrelief::inspect::{self, Measured, View, measure};
use basrelief::texture::{HeightImage, Surface, SurfaceMaps};
use basrelief::{
    Ewa, Filter, Frame, Horizon, Light, Lighting, Rays, Renderer, Scene, Settings, Sky, Stats,
    Visible,
};
use common::{cobbles, floor_scene};
use glam::Vec3;
use std::collections::BTreeSet;

/// The colour of each level, as far apart as they can be.
const COLORS: [[f32; 3]; 9] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.2, 0.4, 0.8],
    [1.0, 1.0, 1.0],
    [0.0, 0.0, 0.0],
];

/// How far a frame may be from the colours of its levels: means of thousands of texels, and colours
/// in 15 bits.
const ROUNDING: f32 = 4e-5;

/// The same where tables have a share: their texels are colours in 10 and 11 bits.
const TABLE_ROUNDING: f32 = 1e-3;

/// A relief with noise from texel to texel, of which levels lose much.
fn stones() -> Surface {
    Surface::new(cobbles(256, 8)).expect("valid maps")
}

/// A relief of wide mounds, of which they lose nothing.
fn mounds() -> Surface {
    let arc = |c: u32| 1.0 - (((c % 64) as f32 + 0.5) / 32.0 - 1.0).powi(2);
    let heights = HeightImage::from_fn(256, 256, |x, y| 0.5 * (arc(x) + arc(y)));
    let maps = SurfaceMaps { height: Some(heights), relief_depth: 0.06, ..SurfaceMaps::default() };
    Surface::new(maps).expect("valid maps")
}

/// A floor to the horizon under white light from everywhere, which leaves colours as they are. With
/// a point light, if a dark one, light is not baked, which would mix the colours of levels anew.
fn floor(surface: Surface) -> Scene {
    let lights = vec![Light::Point { position: Vec3::Y, intensity: Vec3::ZERO }];
    Scene { sky: Sky::Color(Vec3::ONE), lights, ..floor_scene(surface, 0.15) }
}

fn settings(filter: Filter) -> Settings {
    Settings { width: 64, height: 48, msaa: 1, filter, ..Settings::default() }
}

fn draw(scene: &Scene, settings: &Settings) -> (Frame, Stats) {
    let mut frame = Frame::default();
    let mut renderer =
        Renderer::new(scene.clone(), settings.clone()).expect("a valid scene and settings");
    let stats = renderer.render_timed(&mut frame, &|| 0.0);
    (frame, stats)
}

fn measured(scene: &Scene, settings: &Settings, view: View) -> Measured {
    measure(scene, settings, view).expect("a valid scene and settings")
}

/// Every filter, and the options that choose levels in other ways.
fn filters() -> Vec<Filter> {
    let mut filters = Filter::ALL.to_vec();
    filters.extend([
        Filter::Ewa(Ewa { every_texel: true, ..Ewa::default() }),
        Filter::Ewa(Ewa { texel_budget: 0, ..Ewa::default() }),
        Filter::Visible(Visible { texel_budget: 32, ..Visible::default() }),
        Filter::Horizon(Horizon { lines: 6, far_field: false, ..Horizon::default() }),
        Filter::Horizon(Horizon { lines: 4, far_field_mib: 1, ..Horizon::default() }),
        Filter::Parallax(Rays { samples: 1 }),
    ]);
    filters
}

/// How many different levels a filter shows at least on the floor, apart from pixels that tables
/// have a share in, where levels lose nothing.
fn least_num_levels(filter: &Filter) -> usize {
    match filter {
        Filter::Nearest | Filter::Bilinear | Filter::Truth(_) => 1,
        Filter::Ewa(ewa) if ewa.texel_budget == 0 => 1,
        // Tables begin before the base level ends.
        Filter::Horizon(horizon) if horizon.far_field && horizon.lines >= 10 => 1,
        Filter::Horizon(_) => 2,
        Filter::Parallax(rays) if rays.samples > 1 => 2,
        Filter::Trilinear(_) | Filter::Ewa(_) | Filter::Visible(_) | Filter::Parallax(_) => 4,
    }
}

/// What the inspector tells of pixels: the levels of those that are read from levels alone, and how
/// many come from tables, too.
#[derive(Debug, Default)]
struct Told {
    levels: Vec<f32>,
    num_tables: usize,
}

impl Told {
    /// The levels, each once; of two that are blended the finer.
    fn different_levels(&self) -> BTreeSet<usize> {
        self.levels.iter().map(|level| *level as usize).collect()
    }

    fn num_blended(&self) -> usize {
        self.levels.iter().filter(|level| level.fract() > 0.0).count()
    }
}

/// The greatest difference of a pixel's channel from the blend of two colours.
fn error(pixel: &[f32; 4], [from, to]: [[f32; 3]; 2], share: f32) -> f32 {
    let of_channel = |c: usize| (pixel[c] - (from[c] + (to[c] - from[c]) * share)).abs();
    (0..3).map(of_channel).fold(0.0, f32::max)
}

/// Holds every pixel of a frame against the level and blend that the inspector names.
fn check(surface: &Surface, settings: &Settings) -> Told {
    let scene = floor(surface.with_level_colors(&COLORS));
    let (frame, _) = draw(&scene, settings);
    let mip = measured(&scene, settings, View::Mip);
    let mut told = Told::default();
    // Tables are made from one of the two finest levels.
    let mut table_errors = [0.0_f32; 2];
    for (i, (pixel, mip)) in frame.pixels.iter().zip(&mip.pixels).enumerate() {
        let Some([level, far_share, _]) = *mip else {
            assert_eq!(pixel[3], 0.0, "pixel {i} is drawn, and not measured");
            continue;
        };
        assert_eq!(pixel[3], 1.0, "pixel {i} is measured, and not drawn");
        let (fine, blend) = (level as usize, level.fract());
        let levels = [fine, (fine + 1).min(COLORS.len() - 1)].map(|level| COLORS[level]);
        if far_share > 0.0 {
            told.num_tables += 1;
            for (worst, table) in table_errors.iter_mut().zip(&COLORS) {
                *worst = worst.max(error(pixel, [levels[0], *table], far_share));
            }
        } else {
            let error = error(pixel, levels, blend);
            let what = format!("pixel {i}, level {level} by {:?}", settings.filter);
            assert!(error < ROUNDING, "{what}: {pixel:?}, {levels:?} expected, {error} apart");
            told.levels.push(level);
        }
    }
    let table_error = table_errors[0].min(table_errors[1]);
    assert!(table_error < TABLE_ROUNDING, "{table_errors:?} from the colours of tables");
    told
}

#[test]
fn frames_read_the_levels_that_are_named() {
    let (stones, mounds) = (stones(), mounds());
    let ways = [
        (Lighting::Unlit, &stones, false),
        (Lighting::Unlit, &mounds, true),
        (Lighting::Lit, &mounds, true),
    ];
    for filter in filters() {
        for (lighting, surface, keeps_all) in ways {
            // Their light is hidden by the relief, which leaves no colour as it is.
            let is_hidden = matches!(filter, Filter::Truth(_) | Filter::Horizon(_));
            if lighting == Lighting::Lit && is_hidden {
                continue;
            }
            let told = check(surface, &Settings { lighting, ..settings(filter) });
            let (levels, num_blended) = (told.different_levels(), told.num_blended());
            let (num, num_tables) = (told.levels.len(), told.num_tables);
            println!(
                "{filter:?} {lighting:?}: levels {levels:?} at {num} pixels, {num_tables} by tables"
            );
            let least = if keeps_all { least_num_levels(&filter) } else { 1 };
            assert!(levels.len() >= least, "{filter:?}: {levels:?}");
            assert!(num > 100, "{filter:?}: {num} pixels");
            let blends = matches!(filter, Filter::Trilinear(_) | Filter::Parallax(_));
            assert_eq!(num_blended > 100, blends, "{filter:?}: {num_blended} are blended");
            // Tables hold unlit colours.
            let has_tables = lighting == Lighting::Unlit
                && matches!(filter, Filter::Horizon(Horizon { far_field: true, .. }));
            assert_eq!(num_tables > 100, has_tables, "{filter:?}: {num_tables} by tables");
        }
    }
}

/// Without relief nothing is looked for, and no level loses anything.
#[test]
fn frames_without_relief_read_the_levels_that_are_named() {
    for filter in filters() {
        let told = check(&stones(), &Settings { parallax: false, ..settings(filter) });
        assert!(told.levels.len() > 1000 && told.num_tables == 0, "{filter:?}");
    }
}

#[test]
fn the_texels_shown_are_those_that_frames_test() {
    let scene = floor(stones());
    for texel_budget in [0, 256] {
        for max_stretch in [0.0, 4.0] {
            let visible = Visible { texel_budget, max_stretch, ..Visible::default() };
            let settings = settings(Filter::Visible(visible));
            let (_, stats) = draw(&scene, &settings);
            let shown = measured(&scene, &settings, View::Visible);
            let (mut num_tested, mut num_visible) = (0, 0);
            for [share, num, _] in shown.pixels.iter().flatten() {
                num_tested += *num as u64;
                num_visible += (f64::from(*share) * f64::from(*num)).round() as u64;
            }
            assert_eq!(num_tested, stats.texels_tested, "{visible:?}");
            assert_eq!(num_visible, stats.texels_visible, "{visible:?}");
            assert!(
                num_visible * 4 < num_tested * 3,
                "much is hidden: {num_visible} of {num_tested}"
            );
        }
    }
}

/// The rows of the cut through each pixel that sees the floor, as [`View::Horizon`] and the
/// inspector count them, and whether both look at the same level.
fn cuts(scene: &Scene, settings: &Settings) -> Vec<([f32; 2], [f32; 2], bool, f32)> {
    let horizon = measured(scene, settings, View::Horizon);
    let mip = measured(scene, settings, View::Mip);
    let places = (0..settings.height).flat_map(|y| (0..settings.width).map(move |x| [x, y]));
    let pixels = places.zip(horizon.pixels.iter().zip(&mip.pixels)).step_by(5);
    pixels
        .filter_map(|(place, (rows, mip))| {
            let ([share, num, _], [level, ..]) = ((*rows)?, (*mip)?);
            let seen = inspect::pixel(scene, settings, place).expect("the pixel sees the floor");
            let [num_seen, num_rows] = seen.cut.num_seen().map(|num| num as f32);
            let is_same = seen.sets.level as f32 == level;
            Some(([share, num], [num_seen / num_rows, num_rows], is_same, level))
        })
        .collect()
}

#[test]
fn the_cut_is_made_on_the_level_that_is_named() {
    let scene = floor(stones());
    // The inspector's cut is made on the level of the paper's sets: for the paper's filter that is
    // the one that is read.
    let paper = cuts(&scene, &settings(Filter::Visible(Visible::default())));
    assert!(paper.iter().all(|(shown, inspected, is_same, _)| *is_same && shown == inspected));
    let num_coarse = paper.iter().filter(|(.., level)| *level > 0.0).count();
    assert!(paper.len() > 200 && num_coarse > 100, "{num_coarse} of {}", paper.len());
    // The horizon's own level is another one here and there, and its rows are others.
    let horizon = Filter::Horizon(Horizon { far_field: false, ..Horizon::default() });
    let horizon = cuts(&scene, &settings(horizon));
    let (same, other): (Vec<_>, Vec<_>) =
        horizon.into_iter().partition(|(.., is_same, _)| *is_same);
    println!("horizon: {} on the level of the sets, {} on others", same.len(), other.len());
    assert!(same.iter().all(|(shown, inspected, ..)| shown == inspected));
    assert!(other.iter().all(|(shown, inspected, ..)| shown[1] != inspected[1]));
    assert!(same.len() > 20 && other.len() > 20, "{} and {}", same.len(), other.len());
}
