//! The tables of one surface: for which directions there are any, and how they are built.

use super::encode::FarImage;
use super::source::Source;
use crate::light::{Gloss, SunlitTexels};
use crate::relief::directions::{
    Lengths, NUM_LENGTHS, SLOPES, diamond_angle, pseudo_exp, pseudo_log,
};
use crate::relief::seen::{View, seen_depth};
use crate::texture::{Surface, Wrap};
use std::sync::{Arc, OnceLock};

/// Texels of a table's finest level at the most: the larger the maps, the coarser the level that
/// tables begin on.
const MOST_TEXELS: usize = 128 * 128;

/// Fewest and most azimuths of a length, and most tables: more cost more time to build than they
/// gain.
const AZIMUTHS: [usize; 2] = [8, 120];
const MOST_TABLES: usize = 400;

/// The power of the length that azimuths grow with. Measured with 64 lines, hand-over on the floor:
/// 1.8 dB better than in proportion to the length; other scenes are best with 0.5 to 1.
const AZIMUTH_POWER: f32 = 0.7;

/// The same of highlights, which change with the azimuth at gentle views as much as at grazing ones:
/// eight azimuths there show as edges in a picture.
const AZIMUTH_POWER_OF_GLOSS: f32 = 0.3;

/// The slope from which azimuths grow no more: at the skyline a footprint is so long that it holds
/// what a finer direction would tell apart.
const STEEPEST: f32 = 20.0;

/// The number of a length that is grazing, but not the skyline's.
const GRAZING: usize = NUM_LENGTHS - 3;

/// Lengths, by their numbers, in which that difference is looked for: gentle, middle and grazing.
const PROBED_LENGTHS: [usize; 3] = [2, NUM_LENGTHS / 2, GRAZING];

/// And directions, as diamond angles: along u, and one that lies along no axis.
const PROBED_ANGLES: [f32; 2] = [0.0, 0.7];

/// Directions in which the depth of what is seen is looked for: along both axes, and between them.
const DEPTH_ANGLES: [f32; 4] = [0.0, 0.6, 1.0, 3.3];

/// Tables of the seen colour of one surface.
#[derive(Clone, Debug)]
pub(in crate::filter) struct FarField {
    /// The mip level of the tables' finest level.
    pub(super) first_level: usize,
    lengths: Lengths,
    /// Where each length's tables begin in `images`, and where the last's end.
    starts: Vec<usize>,
    /// The depth of the plane, 0 to 1, on which the tables have their places: what lies above or
    /// below it stands elsewhere in each of four neighbours, so it is the mean depth of what is seen
    /// at a grazing view. (Of the mean depth of all, most of which is hidden there, a blend of four
    /// is up to 6 dB worse.)
    pub(super) plane: f32,
    source: Source,
    /// Whether it shows highlights: between two azimuths these bend too much for a straight line.
    pub(super) is_bent: bool,
    /// By length, then azimuth: the longer the displacement, the more azimuths. Each is built when
    /// it is first asked for, since a frame asks for few of them.
    images: Vec<OnceLock<FarImage>>,
}

impl FarField {
    /// The tables within so many MiB, none of them built yet; `None` for a surface without relief, with edges that
    /// do not repeat, or too small to need tables. With `gloss` they hold its highlights, as the eye of
    /// each direction sees them.
    pub(in crate::filter) fn new(
        surface: &Surface,
        (gloss, sunlit): (Option<Gloss>, Arc<[SunlitTexels]>),
        mib: u32,
    ) -> Option<Self> {
        let num_texels = |level: &usize| surface.levels()[*level].size().iter().product::<usize>();
        let first_level =
            (0..surface.levels().len()).find(|level| num_texels(level) <= MOST_TEXELS)?;
        if surface.relief_depth() == 0.0 || surface.wrap() == Wrap::Clamp || first_level == 0 {
            return None;
        }
        let lengths = Lengths::new(surface);
        let is_bent = gloss.as_ref().is_some_and(Gloss::is_shiny);
        let power = if gloss.is_some() { AZIMUTH_POWER_OF_GLOSS } else { AZIMUTH_POWER };
        let plane = grazing_depth(surface, first_level, &lengths);
        let views = PROBED_LENGTHS.into_iter().flat_map(|length| {
            let displacement = move |angle| lengths.displacement(length, angle);
            PROBED_ANGLES.map(displacement).map(|displacement| View { displacement, plane })
        });
        let probes = (surface.levels()[first_level].size(), &*views.collect::<Vec<_>>());
        let mut far = Self {
            first_level,
            lengths,
            starts: table_starts(surface, first_level, (mib, power)),
            plane,
            source: Source::new(surface, (gloss, sunlit), probes),
            is_bent,
            images: Vec::new(),
        };
        far.images.resize_with(far.starts[NUM_LENGTHS], OnceLock::new);
        Some(far)
    }

    /// A table by its number. Building one waits for nothing but itself, so a thread that wants one
    /// which another builds waits for that alone.
    pub(super) fn image(&self, surface: &Surface, index: usize) -> &FarImage {
        self.images[index].get_or_init(|| {
            let length = self.starts.partition_point(|start| *start <= index) - 1;
            let displacement = self.displacement(length, index - self.starts[length]);
            let view = View { displacement, plane: self.plane };
            let size = surface.levels()[self.first_level].size();
            self.source.table(surface, size, view)
        })
    }

    fn num_azimuths(&self, length: usize) -> usize {
        self.starts[length + 1] - self.starts[length]
    }

    /// The displacement of a table, in base texels.
    fn displacement(&self, length: usize, azimuth: usize) -> [f32; 2] {
        self.lengths.displacement(length, 4.0 * azimuth as f32 / self.num_azimuths(length) as f32)
    }

    /// The tables around a displacement in base texels: of the two nearest lengths, the N nearest azimuths,
    /// and their shares, as `blend` gives them by the part of the way from the middle two's first to the other.
    pub(super) fn neighbours<const N: usize>(
        &self,
        displacement: [f32; 2],
        blend: impl Fn(f32) -> [f32; N],
    ) -> [[(usize, f32); N]; 2] {
        let length = self.lengths.place_of(displacement);
        // The place is bounded; from the last length the one before is the near one.
        let near = (length as usize).min(NUM_LENGTHS - 2);
        let along = length - near as f32;
        let [du, dv] = displacement;
        [(near, 1.0 - along), (near + 1, along)].map(|(length, of_all)| {
            let num = self.num_azimuths(length);
            let azimuth = diamond_angle(du, dv) * (num as f32 * 0.25);
            // Azimuths go around: after the last comes the first.
            let first = azimuth as usize + num + 1 - N / 2;
            let shares = blend(azimuth - azimuth.floor());
            std::array::from_fn(|i| (self.starts[length] + (first + i) % num, shares[i] * of_all))
        })
    }
}

/// The mean depth of what is seen at a grazing view.
fn grazing_depth(surface: &Surface, first_level: usize, lengths: &Lengths) -> f32 {
    let size = surface.levels()[first_level].size();
    let grazing = DEPTH_ANGLES.map(|angle| lengths.displacement(GRAZING, angle));
    seen_depth(surface, first_level.min(1), size, &grazing)
}

/// Where each length's tables begin: as many azimuths as the memory allows, in proportion to a power
/// of the length, since an error in azimuth moves what lies above or below the tables' plane across
/// the view by as much as it is long.
fn table_starts(surface: &Surface, first_level: usize, (mib, power): (u32, f32)) -> Vec<usize> {
    let words: usize =
        surface.levels()[first_level..].iter().map(|level| FarImage::num_words(level.size())).sum();
    let num = (mib as usize * (1 << 20) / (words * 4)).min(MOST_TABLES);
    let growth = pseudo_log(SLOPES[1] / SLOPES[0]);
    let most = pseudo_log(STEEPEST / SLOPES[0]);
    let azimuths = |scale: f32| {
        let ratio = |length: usize| {
            let log = growth * (length as f32 / (NUM_LENGTHS - 1) as f32);
            pseudo_exp(power * log.min(most))
        };
        // By fours, so that tables lie along both axes.
        let wanted = |length: usize| (ratio(length) * scale) as usize / 4 * 4;
        (0..NUM_LENGTHS)
            .map(|length| wanted(length).clamp(AZIMUTHS[0], AZIMUTHS[1]))
            .collect::<Vec<_>>()
    };
    // The greatest of these scales that fits: azimuths are whole, so there is nothing to solve for.
    let scales = (0..400).map(|i| 0.05 * i as f32).rev();
    let fitting = scales.map(azimuths).find(|azimuths| azimuths.iter().sum::<usize>() <= num);
    let fitting = fitting.unwrap_or_else(|| vec![4; NUM_LENGTHS]);
    let mut starts = vec![0];
    for num in fitting {
        starts.push(starts[starts.len() - 1] + num);
    }
    starts
}
