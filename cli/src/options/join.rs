//! The command line of `basrelief join`.

use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub(crate) struct JoinOptions {
    /// Parts of one picture, in any order
    #[arg(value_name = "PART", required = true)]
    pub(crate) parts: Vec<PathBuf>,
    /// PNG file to write; - is stdout
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
}
