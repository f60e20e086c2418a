//! The window of `basrelief view`.

pub(crate) mod state;
pub(crate) mod window;

mod orbit;
mod overlay;
mod pace;
mod worker;
