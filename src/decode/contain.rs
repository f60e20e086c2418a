//! Contains panics of decoders and parsers that we did not write: a hostile file must not end the caller's process.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

thread_local! {
    static IS_CONTAINED: Cell<bool> = const { Cell::new(false) };
}

static HOOK: Once = Once::new();

/// Runs `work`; a panic inside becomes `None` and prints nothing. Other threads' panics are reported as before.
pub(crate) fn contain<T>(work: impl FnOnce() -> T) -> Option<T> {
    HOOK.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !IS_CONTAINED.get() {
                before(info);
            }
        }));
    });
    let was_contained = IS_CONTAINED.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(work)).ok();
    IS_CONTAINED.set(was_contained);
    result
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_panic_becomes_none_and_the_next_work_runs() {
        assert_eq!(super::contain(|| -> i32 { panic!("contained") }), None);
        assert_eq!(super::contain(|| 3), Some(3));
    }
}
