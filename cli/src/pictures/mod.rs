//! What is drawn: frames, and pictures of numbers.

pub(crate) mod draw;
pub(crate) mod inspection;
pub(crate) mod layers;
pub(crate) mod measured;
pub(crate) mod picture;
