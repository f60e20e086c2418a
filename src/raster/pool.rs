//! Buffers that tasks take and give back.

use std::ops::{Deref, DerefMut};
use std::sync::{Mutex, PoisonError};

/// As many buffers as tasks ever ran at once. They have grown to what is needed after the first
/// few.
#[derive(Debug)]
pub struct Pool<T>(Mutex<Vec<T>>);

/// A buffer on loan, given back when it is dropped.
pub struct Loan<'a, T> {
    pool: &'a Pool<T>,
    /// `None` only while it is given back.
    buffer: Option<T>,
}

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self(Mutex::new(Vec::new()))
    }
}

impl<T: Default> Pool<T> {
    /// A buffer that nobody uses, or a new one.
    pub fn take(&self) -> Loan<'_, T> {
        // The lock guards a pop or a push alone, so a task that panicked left the list whole. The
        // last buffer given back goes first: it is the likeliest to be in a cache.
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        Loan { pool: self, buffer: Some(kept.unwrap_or_default()) }
    }
}

impl<T> Deref for Loan<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.buffer.as_ref().expect("on loan")
    }
}

impl<T> DerefMut for Loan<'_, T> {
    fn deref_mut(&mut self) -> &mut T {
        self.buffer.as_mut().expect("on loan")
    }
}

impl<T> Drop for Loan<'_, T> {
    fn drop(&mut self) {
        self.pool.0.lock().unwrap_or_else(PoisonError::into_inner).extend(self.buffer.take());
    }
}
