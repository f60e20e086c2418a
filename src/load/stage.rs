//! What loading is at, for those who wait.

use std::fmt;
use std::sync::Mutex;

/// What [`load_reporting`](super::load_reporting) is doing; as text, a line for the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadStage {
    /// The OBJ file and its MTL files are read.
    Model,
    /// Images are decoded.
    Images {
        /// Files that are decoded.
        done: usize,
        /// Files that there are.
        num: usize,
    },
    /// Texels are packed and mip levels built.
    Pyramids {
        /// Surfaces that are built.
        done: usize,
        /// Surfaces that there are.
        num: usize,
    },
}

impl fmt::Display for LoadStage {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Model => f.write_str("reading the model"),
            Self::Images { done, num } => write!(f, "decoding images ({done} of {num})"),
            Self::Pyramids { done, num } => write!(f, "building pyramids ({done} of {num})"),
        }
    }
}

/// Who is told of stages, from any thread.
pub(super) type Report<'a> = dyn Fn(LoadStage) + Sync + 'a;

/// Counts what is done, in any order, and reports each number once, in order.
pub(super) struct Counter<'a> {
    done: Mutex<usize>,
    num: usize,
    stage: fn(usize, usize) -> LoadStage,
    report: &'a Report<'a>,
}

impl<'a> Counter<'a> {
    /// Reports that none of `num` is done.
    pub(super) fn new(
        num: usize,
        stage: fn(usize, usize) -> LoadStage,
        report: &'a Report<'a>,
    ) -> Self {
        if num > 0 {
            report(stage(0, num));
        }
        Self { done: Mutex::new(0), num, stage, report }
    }

    /// Reports that one more is done.
    pub(super) fn add_one(&self) {
        // Held while it reports, so that the numbers stay in order; a reporter's panic does no harm
        // to a number.
        let mut done = self.done.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        *done += 1;
        (self.report)((self.stage)(*done, self.num));
    }
}
