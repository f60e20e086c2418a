//! How coarse a frame may be while things move, so that they move smoothly.

/// Frames are aimed to take no longer than this while moving, in milliseconds.
const AIM: f64 = 50.0;

/// Coarsest pixels, as a multiple of the screen's.
const COARSEST: u32 = 6;

/// Chooses the size of pixels from the time that frames took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pace {
    /// What a frame of full size takes, in milliseconds; 0 while it is not known.
    full_ms: f64,
}

impl Pace {
    /// Learns from a frame whose pixels were `scale` screen pixels wide.
    pub(crate) fn learn(&mut self, scale: u32, ms: f64) {
        let full_ms = ms * f64::from(scale * scale);
        // A frame costs more than its pixels: trust those near full size most.
        let share = if self.full_ms == 0.0 { 1.0 } else { 0.4 };
        self.full_ms += (full_ms - self.full_ms) * share;
    }

    /// Forgets: another filter takes another time.
    pub(crate) fn forget(&mut self) {
        self.full_ms = 0.0;
    }

    /// How wide pixels are while moving: the finest that are drawn in time.
    pub(crate) fn moving_scale(&self) -> u32 {
        if self.full_ms == 0.0 {
            return 2;
        }
        (1..COARSEST)
            .find(|&scale| self.full_ms / f64::from(scale * scale) <= AIM)
            .unwrap_or(COARSEST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_filters_move_in_coarse_pixels_and_fast_ones_in_fine() {
        for (full_ms, scale) in [(20.0, 1), (60.0, 2), (190.0, 2), (400.0, 3), (1e5, COARSEST)] {
            let mut pace = Pace::default();
            pace.learn(1, full_ms);
            assert_eq!(pace.moving_scale(), scale, "{full_ms} ms");
        }
    }

    #[test]
    fn it_settles_where_the_time_is_kept() {
        let mut pace = Pace::default();
        let mut ms = 0.0;
        for _ in 0..20 {
            let scale = pace.moving_scale();
            ms = 170.0 / f64::from(scale * scale) + 2.0;
            pace.learn(scale, ms);
        }
        assert!(ms <= AIM, "{ms}");
    }
}
