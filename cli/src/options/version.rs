//! What `--version` says.

use basrelief::SIMD_LEVEL;
use std::sync::LazyLock;

/// Levels of [`SIMD_LEVEL`] from the least.
const LEVELS: &[&str] = &["scalar", "sse2", "sse4.1", "avx", "avx2", "avx2+fma", "avx512"];

/// The crate's version, the SIMD level built for, and whether the processor could do better.
pub(crate) fn text() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(|| {
        let version = format!("{} (built for {SIMD_LEVEL})", env!("CARGO_PKG_VERSION"));
        let advice = "build with RUSTFLAGS=\"-C target-cpu=native\" to use it";
        match better_level() {
            Some(better) => format!("{version}\nThis processor could do {better}: {advice}."),
            None => version,
        }
    });
    TEXT.as_str()
}

/// The best level of this processor where it is above the one built for.
fn better_level() -> Option<&'static str> {
    let rank = |level| LEVELS.iter().position(|known| *known == level);
    let best = best_level()?;
    (rank(best) > rank(SIMD_LEVEL)).then_some(best)
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn best_level() -> Option<&'static str> {
    use std::is_x86_feature_detected as has;
    Some(match () {
        () if has!("avx512f") => "avx512",
        () if has!("avx2") && has!("fma") => "avx2+fma",
        () if has!("avx2") => "avx2",
        () if has!("avx") => "avx",
        () if has!("sse4.1") => "sse4.1",
        () => "sse2",
    })
}

#[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
fn best_level() -> Option<&'static str> {
    None
}
