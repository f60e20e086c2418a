//! What the figures were measured on.

use sysinfo::{CpuRefreshKind, RefreshKind, System};

/// Processor, system and build.
pub(crate) struct Machine {
    pub(crate) processor: String,
    pub(crate) system: String,
    /// Threads that frames were drawn with.
    pub(crate) threads: usize,
}

impl Machine {
    /// This machine, with the threads of the current pool.
    pub(crate) fn here() -> Self {
        let system =
            System::new_with_specifics(RefreshKind::nothing().with_cpu(CpuRefreshKind::nothing()));
        let brand =
            system.cpus().first().map(|cpu| cpu.brand().trim().to_owned()).unwrap_or_default();
        let processor = if brand.is_empty() { std::env::consts::ARCH.to_owned() } else { brand };
        let system = System::long_os_version().unwrap_or_else(|| std::env::consts::OS.to_owned());
        Self { processor, system, threads: rayon::current_num_threads() }
    }
}
