//! Finds the line of an error that shows only after the whole OBJ file is read. Runs on failure
//! only.

use super::clean::ObjLines;
use crate::error::{Error, Result};
use crate::load::lines::{CleanLines, Source};
use crate::scene::{MAX_POSITION, MAX_REPEATS};

/// The first face with an index that its list does not have.
pub(super) fn bad_index(source: &dyn Source) -> Option<Error> {
    let num_in_file = {
        let mut lines = lines(source).ok()?;
        while lines.advance().ok()? {}
        [lines.cleaner.num_positions, lines.cleaner.num_tex_coords, lines.cleaner.num_normals]
    };
    // An index may look ahead within the file; only if none is beyond the end, one looked too far
    // ahead.
    first_beyond(source, Some(num_in_file)).or_else(|| first_beyond(source, None))
}

fn first_beyond(source: &dyn Source, num_in_file: Option<[u64; 3]>) -> Option<Error> {
    let mut found = None;
    let mut lines = lines(source).ok()?;
    while found.is_none() && lines.advance().ok()? {
        let cleaner = &lines.cleaner;
        let num = num_in_file.unwrap_or([
            cleaner.num_positions,
            cleaner.num_tex_coords,
            cleaner.num_normals,
        ]);
        let Some(face) = lines.text().lines().find_map(|line| line.strip_prefix("f ")) else {
            continue;
        };
        let beyond = face
            .split_ascii_whitespace()
            .flat_map(|corner| corner.split('/').zip(num))
            .find(|(index, num)| {
                index.parse::<i128>().is_ok_and(|i| i > i128::from(*num) || -i > i128::from(*num))
            });
        found = beyond.map(|(index, num)| {
            lines.place().refuse(format!("index {index} is out of range: {num} exist"))
        });
    }
    found
}

/// The first `v` whose position, or `vt` whose coordinates, are not finite or out of range.
pub(in crate::load) fn bad_number(source: &dyn Source) -> Option<Error> {
    let mut lines = lines(source).ok()?;
    while lines.advance().ok()? {
        let text = lines.text();
        let (keyword, rest) = text.split_once(' ').unwrap_or_default();
        let numbers: Vec<f32> =
            rest.split_ascii_whitespace().map(|n| n.parse().unwrap_or(f32::NAN)).collect();
        let is_good = match keyword {
            "v" => {
                let w = numbers.get(3).copied().unwrap_or(1.0);
                numbers.iter().take(3).all(|x| (x / w).abs() <= MAX_POSITION)
            }
            "vt" => numbers.iter().take(2).all(|x| x.abs() <= MAX_REPEATS),
            "vn" => numbers.iter().take(3).all(|x| x.is_finite()),
            _ => true,
        };
        if !is_good {
            return Some(
                lines.place().refuse(format!("'{}' is not finite or too large", text.trim())),
            );
        }
    }
    None
}

fn lines<'a>(
    source: &'a dyn Source,
) -> Result<CleanLines<Box<dyn std::io::BufRead + 'a>, ObjLines<'a>>> {
    Ok(CleanLines::new(source.reader()?, source.path(), ObjLines::new(u64::MAX, None)))
}
