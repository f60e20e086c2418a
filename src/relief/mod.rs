//! Where the eye meets the relief.
//!
//! Input: the view ray of a pixel in the texture frame, `ray = alpha dP/du + beta dP/dv - gamma W
//! N` with `W = sqrt(|dP/du x dP/dv|)`, the world length of a texture repeat. Output: the
//! *displacement* `D = s S`, how far the ray moves along the texture, in repeats, between the
//! polygon and the deepest relief, with the view slope `s = (alpha, beta) / gamma` and the relief
//! depth `S`; and the *hit* `q = b + t D` with the depth `t`, 0 to 1, at which the ray from the
//! base coordinate `b` first meets the relief. Lanes are pixels.

mod bent;
mod climb;
pub mod directions;
mod displacement;
mod height_cells;
mod height_field;
mod level_loss;
mod march;
mod maxima;
mod patch;
pub mod seen;
mod segment;
mod shadow;
mod walk;

pub use bent::{SEEN_DEPTH, are_at_outline, bent, bow, displacement_over};
pub use climb::Climb;
pub use displacement::{MAX_SLOPE, displacement, finite, stretch};
pub use height_cells::{CellRays, HeightCells};
pub use height_field::HeightField;
pub use level_loss::LevelLoss;
pub use march::{ViewRays, march, march_all};
pub use segment::{MOST_STEPS, ReliefPlace};
pub use shadow::{LitParts, RowScratch};
