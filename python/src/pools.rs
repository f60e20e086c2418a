//! Threads, made at first use.
//!
//! A process that was forked has none of its parent's threads, so each process makes its own; and
//! nothing here waits for a lock that the parent may have held at that moment.

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::{Arc, Mutex, TryLockError};

use crate::arguments::refused;

/// Most threads that can be asked for.
const MOST_THREADS: usize = 1024;

/// A pool of so many threads, of one process.
struct Kept {
    process: u32,
    threads: usize,
    pool: Arc<ThreadPool>,
}

static POOLS: Mutex<Vec<Kept>> = Mutex::new(Vec::new());

/// Checks a number of threads; `None` is as many as the process may use.
pub(crate) fn threads(asked: Option<usize>) -> PyResult<usize> {
    match asked {
        None => Ok(std::thread::available_parallelism().map_or(1, usize::from)),
        Some(num) if (1..=MOST_THREADS).contains(&num) => Ok(num),
        Some(num) => Err(refused("threads", format!("{num} is not within 1 to {MOST_THREADS}"))),
    }
}

/// A pool of so many threads, kept for the next who asks.
pub(crate) fn pool(threads: usize) -> PyResult<Arc<ThreadPool>> {
    let process = std::process::id();
    let mut kept = match POOLS.try_lock() {
        Ok(kept) => kept,
        Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
        // Another thread makes one, or made one when the process was forked: one for this call.
        Err(TryLockError::WouldBlock) => return make(threads),
    };
    // The parent's threads are not there to be ended.
    let (own, parents) = std::mem::take(&mut *kept).into_iter().partition(|k| k.process == process);
    std::mem::forget::<Vec<Kept>>(parents);
    *kept = own;
    if let Some(found) = kept.iter().find(|kept| kept.threads == threads) {
        return Ok(found.pool.clone());
    }
    let pool = make(threads)?;
    kept.push(Kept { process, threads, pool: pool.clone() });
    Ok(pool)
}

fn make(threads: usize) -> PyResult<Arc<ThreadPool>> {
    let builder = ThreadPoolBuilder::new().num_threads(threads);
    let builder = builder.thread_name(|i| format!("basrelief-{i}"));
    builder.build().map(Arc::new).map_err(|error| refused("threads", error))
}

/// Runs `work` on a pool of as many threads as the process may use, without the interpreter's lock.
pub(crate) fn run<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    let pool = pool(threads(None)?)?;
    Ok(py.detach(|| pool.install(work)))
}
