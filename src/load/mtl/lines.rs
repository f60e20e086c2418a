//! Cleans the lines of an MTL file for tobj.
//!
//! Keywords are read in any spelling of upper and lower case and handed to tobj in its own; what
//! tobj would panic at or refuse a whole file for (`Kd` with one number, an empty `map_Kd`) is put
//! right or refused with its line before.

use crate::error::Result;
use crate::load::lines::{Clean, Place};
use std::collections::HashMap;
use std::fmt::Write as _;

/// The line of each keyword of a material.
pub(super) type LineNumbers = HashMap<&'static str, usize>;

/// Cleans the lines of an MTL file, see the module's head.
#[derive(Default)]
pub(super) struct MtlLines {
    /// One map a material.
    pub(super) lines: Vec<LineNumbers>,
    pub(super) warnings: Vec<String>,
}

/// tobj's spelling of the keywords that matter here.
fn spelled(keyword: &str) -> Option<&'static str> {
    Some(match keyword.to_ascii_lowercase().as_str() {
        "newmtl" => "newmtl",
        "kd" => "Kd",
        "ks" => "Ks",
        "ns" => "Ns",
        "pm" => "Pm",
        "pr" => "Pr",
        "ke" => "Ke",
        "d" => "d",
        "map_kd" => "map_Kd",
        "map_d" => "map_d",
        "map_pm" => "map_Pm",
        "map_pr" => "map_Pr",
        "map_ke" => "map_Ke",
        "bump" | "map_bump" => "map_Bump",
        "disp" | "map_disp" => "disp",
        "norm" | "map_kn" => "norm",
        _ => return None,
    })
}

impl Clean for MtlLines {
    fn clean(&mut self, text: &str, at: Place<'_>, out: &mut String) -> Result<()> {
        let (word, rest) = text.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((text, ""));
        let Some(keyword) = spelled(word) else {
            return Ok(());
        };
        let rest = rest.trim();
        if keyword == "newmtl" {
            if rest.is_empty() {
                return Err(at.refuse("newmtl needs a name"));
            }
            self.lines.push(LineNumbers::new());
        }
        let Some(lines) = self.lines.last_mut() else {
            return Err(at.refuse(format!("{word} stands before the first newmtl")));
        };
        lines.insert(keyword, at.line);
        if rest.is_empty() {
            self.warnings.push(at.remark(format_args!("{word} names no file or value")));
        } else if matches!(keyword, "Kd" | "Ks" | "Ke")
            && (rest.starts_with("spectral") || rest.starts_with("xyz"))
        {
            self.warnings.push(at.remark(format_args!("{word} {rest} is not supported")));
        } else {
            let values =
                values(keyword, rest).map_err(|reason| at.refuse(format!("{word}: {reason}")))?;
            let _ = writeln!(out, "{keyword} {values}");
        }
        Ok(())
    }
}

/// What tobj shall read behind a keyword.
fn values(keyword: &str, text: &str) -> std::result::Result<String, String> {
    match keyword {
        "Kd" | "Ks" | "Ke" => color(text).map(|[r, g, b]| format!("{r} {g} {b}")),
        "Ns" | "Pm" | "Pr" => number(text).map(|number| number.to_string()),
        "d" => number(text.trim_start_matches("-halo").trim()).map(|number| number.to_string()),
        _ => Ok(text.into()),
    }
}

fn number(text: &str) -> std::result::Result<f32, String> {
    let word = text.split_whitespace().next().unwrap_or_default();
    match word.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("'{word}' is not a finite number")),
    }
}

/// Three numbers, or one for all three as the format allows.
fn color(text: &str) -> std::result::Result<[f32; 3], String> {
    let words = text.split('#').next().unwrap_or_default();
    let numbers =
        words.split_whitespace().take(3).map(number).collect::<std::result::Result<Vec<_>, _>>()?;
    match numbers[..] {
        [r, g, b] => Ok([r, g, b]),
        [r] => Ok([r; 3]),
        _ => Err("three numbers are needed".into()),
    }
}
