//! What an inspected pixel sees, as a picture.

pub(crate) mod page;
pub(crate) mod palette;

mod cut;
mod texels;
