//! Any command line: help, a refusal of one line, or options with which a small scene is drawn or refused. Reads and writes
//! no file.
#![no_main]

use arbitrary::Arbitrary;
use basrelief::invariants::frame_is_finite;
use basrelief::{Scene, Settings};
use basrelief_fuzz::{Number, floor, hold};
use clap::CommandFactory;
use cli::{Cli, Command, Ending};
use std::ffi::OsString;
use std::sync::LazyLock;

#[path = "../../src/cli/mod.rs"]
#[allow(
    dead_code,
    unused_imports,
    unreachable_pub,
    reason = "the program's own modules, of which the parser is called"
)]
mod cli;

#[derive(Arbitrary, Debug)]
enum Word<'a> {
    /// An option or a word that it takes, by number.
    Known(u8),
    Numbers([Number; 3], u8),
    Text(&'a str),
    Bytes(&'a [u8]),
}

/// All options, and all words that they take.
static KNOWN: LazyLock<Vec<String>> = LazyLock::new(|| {
    let command = Cli::command();
    let options = command.get_arguments().filter_map(|option| Some(format!("--{}", option.get_long()?)));
    let words = command.get_arguments().flat_map(|option| option.get_possible_values());
    let words = words.map(|value| value.get_name().to_owned());
    options.chain(words).chain(["compare", "inspect", "render", "study", "64x36"].map(str::to_owned)).collect()
});

fn argument(word: Word) -> OsString {
    match word {
        Word::Known(i) => KNOWN[usize::from(i) % KNOWN.len()].clone().into(),
        Word::Numbers(numbers, num) => {
            let numbers = numbers.map(|n| n.get().to_string());
            numbers[..1 + usize::from(num % 3)].join(",").into()
        }
        Word::Text(text) => text.into(),
        Word::Bytes(bytes) => os_string(bytes),
    }
}

#[cfg(unix)]
fn os_string(bytes: &[u8]) -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(bytes.to_vec())
}

#[cfg(not(unix))]
fn os_string(bytes: &[u8]) -> OsString {
    String::from_utf8_lossy(bytes).into_owned().into()
}

libfuzzer_sys::fuzz_target!(|words: Vec<Word>| {
    let arguments = std::iter::once("basrelief".into()).chain(words.into_iter().map(argument));
    let cli = match cli::parse(arguments) {
        Ok(cli) => cli,
        Err(Ending::Refused(text)) => {
            let line = cli::one_line(&text);
            assert!(!line.contains('\n') && !line.is_empty(), "not one line: {line}");
            return;
        }
        Err(Ending::Help(help)) => return assert!(!help.to_string().is_empty()),
    };
    let Command::Render(options) = cli.command.unwrap_or(Command::Render(cli.render)) else { return };
    let Ok(settings) = options.settings.settings(options.scene.has_lights()) else { return };
    let mut scene: Scene = floor();
    options.scene.set(&mut scene);
    let (width, height, samples) = (settings.width.min(16), settings.height.min(12), settings.samples.min(4));
    hold(frame_is_finite(scene, Settings { width, height, samples, region: None, ..settings }));
});
