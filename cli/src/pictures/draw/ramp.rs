//! Numbers as colours.

/// A scale from 0 to 1 in colours whose lightness grows evenly, for the colour-blind too: stops of
/// the map Viridis (S. van der Walt and N. Smith 2015, public domain), or two colours that stand
/// for less and more.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ramp {
    /// Dark violet, blue, green, yellow.
    Viridis,
    /// Vermilion through pale grey to green: hidden to visible.
    Hidden,
}

const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [72, 40, 120],
    [62, 74, 137],
    [49, 104, 142],
    [38, 130, 142],
    [31, 158, 137],
    [53, 183, 121],
    [144, 215, 67],
    [253, 231, 37],
];

const HIDDEN: [[u8; 3]; 3] = [[213, 94, 0], [236, 232, 220], [0, 130, 95]];

impl Ramp {
    /// The colour at `t`, 0 to 1.
    pub(crate) fn at(self, t: f32) -> [u8; 3] {
        let stops: &[[u8; 3]] = match self {
            Self::Viridis => &VIRIDIS,
            Self::Hidden => &HIDDEN,
        };
        let place = t.clamp(0.0, 1.0) * (stops.len() - 1) as f32;
        let (low, part) = ((place as usize).min(stops.len() - 2), place - place.floor());
        let part = if place as usize > low { 1.0 } else { part };
        std::array::from_fn(|i| {
            let [a, b] = [stops[low][i], stops[low + 1][i]].map(f32::from);
            (a + (b - a) * part + 0.5) as u8
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_middles_are_the_stops() {
        assert_eq!(Ramp::Viridis.at(0.0), VIRIDIS[0]);
        assert_eq!(Ramp::Viridis.at(1.0), VIRIDIS[8]);
        assert_eq!(Ramp::Hidden.at(0.5), HIDDEN[1]);
        assert_eq!(Ramp::Hidden.at(2.0), HIDDEN[2]);
    }
}
