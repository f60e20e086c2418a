//! Starts the build of the program that fits the processor.
//!
//! SIMD lanes are chosen when the program is built: the same pictures take three times as long with
//! the instructions that every x86-64 processor has. So packages hold the program three times, built
//! for the levels of x86-64 that compilers agree on, and this in front of them:
//!
//! ```text
//! bin/basrelief                  this, built for every x86-64
//! lib/basrelief/basrelief-v2     SSE4.2, popcnt: any processor since 2009
//! lib/basrelief/basrelief-v3     AVX2, FMA, BMI: since 2013 to 2015
//! lib/basrelief/basrelief-v4     AVX-512 F, BW, CD, DQ, VL
//! ```
//!
//! `BASRELIEF_LEVEL=v2` (or `v3`, `v4`) asks for a build by name. All give the same bytes.
#![forbid(unsafe_code)]

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// What asks for a build by name.
const WISH: &str = "BASRELIEF_LEVEL";

/// The levels, best first, and whether this processor has all of each.
fn levels() -> [(&'static str, bool); 3] {
    let v2 = is_x86_feature_detected!("sse4.2")
        && is_x86_feature_detected!("ssse3")
        && is_x86_feature_detected!("popcnt")
        && is_x86_feature_detected!("cmpxchg16b");
    let v3 = v2
        && is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("f16c")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("movbe");
    let v4 = v3
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512cd")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl");
    [("v4", v4), ("v3", v3), ("v2", v2)]
}

/// The level to start, of `levels`: the one that is wished for, or the best that the processor has.
fn choose(
    levels: &[(&'static str, bool)],
    wish: Option<&OsString>,
) -> Result<&'static str, String> {
    let Some(wish) = wish else {
        let best = levels.iter().find(|(_, is_there)| *is_there);
        return best.map(|(name, _)| *name).ok_or_else(|| {
            "this processor lacks SSE4.2, which the packaged builds need; build from source".into()
        });
    };
    match levels.iter().find(|(name, _)| wish == name) {
        Some((name, true)) => Ok(name),
        Some((name, false)) => Err(format!("{WISH}={name}: this processor lacks it")),
        None => Err(format!("{WISH} must be v2, v3 or v4, not {}", wish.display())),
    }
}

/// Where the builds lie: `lib/basrelief` beside the folder of this program.
fn folder() -> Result<PathBuf, String> {
    let this = env::current_exe().and_then(|path| path.canonicalize());
    let this = this.map_err(|e| format!("cannot find the program's own folder: {e}"))?;
    let root = this.parent().and_then(Path::parent).unwrap_or(Path::new("/"));
    Ok(root.join("lib").join("basrelief"))
}

/// Becomes the chosen build; comes back only where that fails.
fn start() -> Result<ExitCode, String> {
    let level = choose(&levels(), env::var_os(WISH).as_ref())?;
    let program = folder()?.join(format!("basrelief-{level}"));
    let mut command = Command::new(&program);
    command.args(env::args_os().skip(1));
    become_program(command).map_err(|e| format!("{}: {e}", program.display()))
}

#[cfg(unix)]
fn become_program(mut command: Command) -> std::io::Result<ExitCode> {
    use std::os::unix::process::CommandExt;
    // Messages and help speak of the name that the user called.
    command.arg0("basrelief");
    Err(command.exec())
}

#[cfg(not(unix))]
fn become_program(mut command: Command) -> std::io::Result<ExitCode> {
    let code = command.status()?.code();
    Ok(ExitCode::from(code.and_then(|code| u8::try_from(code).ok()).unwrap_or(1)))
}

fn main() -> ExitCode {
    start().unwrap_or_else(|why| {
        eprintln!("error: {why}");
        ExitCode::from(2)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_level_there_is_or_the_one_asked_for() {
        let levels = [("v4", false), ("v3", true), ("v2", true)];
        let asked = |wish: &str| choose(&levels, Some(&wish.into()));
        assert_eq!(choose(&levels, None), Ok("v3"));
        assert_eq!(asked("v2"), Ok("v2"));
        assert!(asked("v4").is_err_and(|why| why.contains("lacks")));
        assert!(asked("avx").is_err_and(|why| why.contains("v2, v3 or v4, not avx")));
        assert!(choose(&[("v2", false)], None).is_err_and(|why| why.contains("SSE4.2")));
    }
}
