//! Contains panics of decoders and parsers that we did not write: a hostile file must not end the
//! caller's process.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `work`; a panic inside becomes `None`. What is printed of it is up to the process's panic
/// hook.
pub(crate) fn contain<T>(work: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(work)).ok()
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_panic_becomes_none_and_the_next_work_runs() {
        assert_eq!(super::contain(|| -> i32 { panic!("contained") }), None);
        assert_eq!(super::contain(|| 3), Some(3));
    }
}
