//! What `--threads` stands for.

use crate::refusal::Refusal;

/// A pool of `num` threads, or of as many as this process may use.
pub(crate) fn thread_pool(num: u32) -> Result<rayon::ThreadPool, Refusal> {
    let num = num_threads(num);
    rayon::ThreadPoolBuilder::new()
        .num_threads(num)
        .build()
        .map_err(|e| format!("--threads {num}: {e}").into())
}

/// How many threads `num` stands for.
pub(crate) fn num_threads(num: u32) -> usize {
    match num {
        // Heeds the affinity mask and the quota of a control group, rounded down.
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        _ => num as usize,
    }
}
