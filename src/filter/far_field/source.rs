//! What tables are swept on, and what they hold.

use super::encode::FarImage;
use super::sights::{Glossy, InSun};
use crate::light::{Gloss, SunlitTexels};
use crate::relief::seen::{Colors, SeenImage, View, seen_image, square_difference};
use crate::texture::Surface;
use rayon::prelude::*;
use std::sync::Arc;

/// Greatest root-mean-square difference, of the surface's colour scale, that what tables are swept on may
/// make in what is seen. Measured: see [`LevelLoss`](crate::relief::LevelLoss).
const MOST_LOSS: f32 = 0.02;

/// The same as a share of what is seen, root-mean-square: in a low sun all but a few texels are dark.
/// Bricks under one 30 degrees high lose 0.18 on level 1 and show it as 9 dB next to the skyline.
const MOST_SHARE_LOST: f32 = 0.1;

/// Greatest share by which what is swept may be brighter or darker in the mean than light that is made between
/// texels: a floor under a sun 10 degrees high is 0.02 too bright with light that is kept at them, and shows it as
/// 2.4 dB next to the skyline.
const MOST_BRIGHTER: f64 = 0.015;

/// What the tables of a surface are swept on.
#[derive(Clone, Debug)]
pub(super) struct Source {
    swept: Swept,
    /// What the eye of each direction sees, where that is not the same for all: highlights, or what is seen
    /// through what lies above a diffuse layer.
    gloss: Option<Gloss>,
    /// How texels are lit by each sun from near.
    sunlit: Arc<[SunlitTexels]>,
}

/// Texels, and what lies between them.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Swept {
    /// The colours of a mip level.
    Level(usize),
    /// The base level in the light of each sun: edges of shadows run within segments.
    InSun,
}

impl Source {
    /// What takes the least work of what shows nearly all in probed views, in images of a size.
    pub(super) fn new(
        surface: &Surface,
        (gloss, sunlit): (Option<Gloss>, Arc<[SunlitTexels]>),
        (size, views): ([usize; 2], &[View]),
    ) -> Self {
        let on = |swept| Self { swept, gloss: gloss.clone(), sunlit: sunlit.clone() };
        // A level's mean normals would show other highlights.
        let is_shiny = gloss.as_ref().is_some_and(Gloss::is_shiny);
        let best = on(if sunlit.is_empty() { Swept::Level(0) } else { Swept::InSun });
        let mut others = Vec::new();
        if !is_shiny && surface.levels()[1].size() != size {
            others.push(on(Swept::Level(1)));
        }
        if best.swept == Swept::InSun {
            others.push(on(Swept::Level(0)));
        }
        if others.is_empty() {
            return best;
        }
        let of = |source: &Self| -> Vec<SeenImage> {
            views.par_iter().map(|view| source.seen(surface, size, *view)).collect()
        };
        let all = of(&best);
        let is_like = |all: &SeenImage, found: &SeenImage| {
            let loss = square_difference(all, found).sqrt();
            let seen = square_difference(all, &vec![[0.0; 3]; all.len()]).sqrt();
            let [light, other] = [all, found].map(brightness);
            let is_as_bright = (other - light).abs() <= MOST_BRIGHTER * light;
            loss < MOST_LOSS.min(MOST_SHARE_LOST * seen)
                && (best.swept != Swept::InSun || is_as_bright)
        };
        let shows_nearly_all =
            |source: &Self| all.iter().zip(of(source)).all(|(all, found)| is_like(all, &found));
        others.into_iter().find(shows_nearly_all).unwrap_or(best)
    }

    /// The table of a view.
    pub(super) fn table(&self, surface: &Surface, size: [usize; 2], view: View) -> FarImage {
        let seen = self.seen(surface, size, view);
        let brightest = if self.gloss.is_none() && self.swept != Swept::InSun {
            1.0
        } else {
            // Highlights are as bright as a surface is smooth.
            seen.iter().flatten().fold(f32::MIN_POSITIVE, |a, b| a.max(*b))
        };
        FarImage::new(size, seen, brightest)
    }

    fn seen(&self, surface: &Surface, size: [usize; 2], view: View) -> SeenImage {
        let glossy = |level: usize| {
            let texels = surface.base().texels_per_repeat();
            let displacement = [0, 1].map(|i| view.displacement[i] / texels[i]);
            let glossy = |gloss| Glossy::new(gloss, displacement, level);
            self.gloss.as_ref().map(glossy)
        };
        match self.swept {
            Swept::Level(level) => match glossy(level) {
                Some(glossy) => seen_image(surface, &glossy, level, size, view),
                None => seen_image(surface, &Colors, level, size, view),
            },
            Swept::InSun => {
                // Each adds what its sun and, with the first, the sky leave.
                let of_sun = |texels: &SunlitTexels| {
                    let sight = InSun::new(texels, surface, glossy(0));
                    seen_image(texels.surface(), &sight, 0, size, view)
                };
                self.sunlit.iter().map(of_sun).reduce(added).unwrap_or_default()
            }
        }
    }
}

/// The sum of all that an image shows.
fn brightness(image: &SeenImage) -> f64 {
    image.iter().flatten().map(|c| f64::from(*c)).sum()
}

/// The sums of two images.
fn added(mut sums: SeenImage, more: SeenImage) -> SeenImage {
    let channels = sums.iter_mut().flatten();
    channels.zip(more.iter().flatten()).for_each(|(sum, more)| *sum += more);
    sums
}
