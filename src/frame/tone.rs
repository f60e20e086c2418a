//! Frames of light to pictures.

use super::Frame;
use super::develop::Development;
use crate::settings::Tone;
use rayon::prelude::*;

impl Frame {
    /// Brings linear light within the range of a picture, as frames of bytes are drawn.
    pub fn apply_tone(&mut self, tone: Tone) {
        let development = Development::of_tone(tone);
        if !development.is_none() {
            self.pixels.par_iter_mut().for_each(|pixel| *pixel = development.apply(*pixel));
        }
    }
}
