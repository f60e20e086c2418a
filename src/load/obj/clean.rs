//! The lines of an OBJ file, put right where tobj stumbles over them.
//!
//! Lines and points are left out (tobj makes triangles of long `l` lines), comments behind numbers
//! are cut, colours behind positions are dropped, indices of 0 or before the first are refused, and
//! a model is split where its faces begin or cease to have texture coordinates or normals, since
//! tobj keeps no record of which vertex went without.

use crate::error::Result;
use crate::load::lines::{Clean, Place};
use crate::load::mtl::MtlFiles;
use std::cell::RefCell;
use std::fmt::Write as _;
use std::path::Path;

/// What the corners of a face name besides positions.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Corners {
    have_tex_coords: bool,
    have_normals: bool,
}

/// Cleans the lines of an OBJ file, see the module's head.
pub(super) struct ObjLines<'a> {
    max_triangles: u64,
    mtl: Option<&'a RefCell<MtlFiles>>,
    pub(super) num_positions: u64,
    pub(super) num_tex_coords: u64,
    pub(super) num_normals: u64,
    num_triangles: u64,
    /// The name after the last `o` or `g`.
    name: String,
    corners: Option<Corners>,
    first_with_tex_coords: usize,
    first_with_normals: usize,
}

impl<'a> ObjLines<'a> {
    pub(super) fn new(max_triangles: u64, mtl: Option<&'a RefCell<MtlFiles>>) -> Self {
        Self {
            max_triangles,
            mtl,
            num_positions: 0,
            num_tex_coords: 0,
            num_normals: 0,
            num_triangles: 0,
            name: String::new(),
            corners: None,
            first_with_tex_coords: 0,
            first_with_normals: 0,
        }
    }

    /// Faces may not name texture coordinates or normals in a file that has none; tobj lets that
    /// pass.
    pub(super) fn check_lists(&self, path: &Path) -> Result<()> {
        let place = |line| Place { path, line };
        if self.num_tex_coords == 0 && self.first_with_tex_coords > 0 {
            return Err(place(self.first_with_tex_coords)
                .refuse("names texture coordinates, and the file has none"));
        }
        if self.num_normals == 0 && self.first_with_normals > 0 {
            return Err(
                place(self.first_with_normals).refuse("names normals, and the file has none")
            );
        }
        Ok(())
    }

    /// Counts a `v`, `vt` or `vn`; as many are allowed as triangles, lest memory fills without one
    /// face.
    fn count(&mut self, keyword: &str, at: Place<'_>) -> Result<()> {
        let num = match keyword {
            "v" => &mut self.num_positions,
            "vt" => &mut self.num_tex_coords,
            _ => &mut self.num_normals,
        };
        *num += 1;
        if *num > self.max_triangles {
            return Err(at.refuse_limit(
                format!("more than {} vertices", self.max_triangles),
                "max_triangles",
            ));
        }
        Ok(())
    }

    fn face(&mut self, text: &str, at: Place<'_>, out: &mut String) -> Result<()> {
        let scan = self.scan(text).map_err(|reason| at.refuse(reason))?;
        if scan.num < 3 {
            return Ok(());
        }
        self.num_triangles += scan.num - 2;
        if self.num_triangles > self.max_triangles {
            return Err(at.refuse_limit(
                format!("more than {} triangles", self.max_triangles),
                "max_triangles",
            ));
        }
        let corners = self.note(&scan, at.line);
        if self.corners.replace(corners).is_some_and(|before| before != corners) {
            let _ = writeln!(out, "o {}", self.name);
        }
        if [scan.num_tex_coords, scan.num_normals].iter().all(|&num| num == 0 || num == scan.num) {
            out.push_str("f ");
            out.push_str(text);
            out.push('\n');
        } else {
            write_face(text, corners, out);
        }
        Ok(())
    }

    /// What all corners of a face name; keeps the first line that names it.
    fn note(&mut self, scan: &Scan, line: usize) -> Corners {
        let corners = Corners {
            have_tex_coords: scan.num_tex_coords == scan.num,
            have_normals: scan.num_normals == scan.num,
        };
        if corners.have_tex_coords && self.first_with_tex_coords == 0 {
            self.first_with_tex_coords = line;
        }
        if corners.have_normals && self.first_with_normals == 0 {
            self.first_with_normals = line;
        }
        corners
    }

    /// Counts corners and what they name; refuses 0 and what lies before the first of a list.
    fn scan(&self, text: &str) -> std::result::Result<Scan, String> {
        let mut scan = Scan::default();
        let is_end = |byte: &u8| *byte == b'/' || byte.is_ascii_whitespace();
        // Which number of a corner is read, and whether a byte of the corner and of the number were
        // seen.
        let (mut part, mut is_corner, mut is_number) = (0, false, false);
        for (at, byte) in text.bytes().enumerate() {
            if byte.is_ascii_whitespace() {
                (is_corner, is_number) = (false, false);
                continue;
            }
            if !is_corner {
                (is_corner, part) = (true, 0);
                scan.num += 1;
            }
            if byte == b'/' {
                (part, is_number) = (part + 1, false);
            } else if !is_number {
                is_number = true;
                if matches!(byte, b'0' | b'-') {
                    let len =
                        text.as_bytes()[at..].iter().position(&is_end).unwrap_or(text.len() - at);
                    let num = match part {
                        0 => self.num_positions,
                        1 => self.num_tex_coords,
                        _ => self.num_normals,
                    };
                    check_index(&text[at..at + len], num)?;
                }
                scan.num_tex_coords += u64::from(part == 1);
                scan.num_normals += u64::from(part == 2);
            }
        }
        Ok(scan)
    }
}

#[derive(Default)]
struct Scan {
    num: u64,
    num_tex_coords: u64,
    num_normals: u64,
}

fn check_index(index: &str, num: u64) -> std::result::Result<(), String> {
    match index.parse::<i64>() {
        Ok(0) => Err("index 0: indices count from 1, or back from -1".into()),
        Ok(i) if i < 0 && i.unsigned_abs() > num => {
            Err(format!("index {i} is out of range: only {num} so far"))
        }
        _ => Ok(()),
    }
}

/// Writes a face whose corners differ in what they name, with only what all of them name.
fn write_face(text: &str, corners: Corners, out: &mut String) {
    out.push('f');
    for corner in text.split_ascii_whitespace() {
        let mut indices = corner.split('/');
        let [v, vt, vn] = std::array::from_fn(|_| indices.next().unwrap_or_default());
        let _ = match (corners.have_tex_coords, corners.have_normals) {
            (true, true) => write!(out, " {v}/{vt}/{vn}"),
            (true, false) => write!(out, " {v}/{vt}"),
            (false, true) => write!(out, " {v}//{vn}"),
            (false, false) => write!(out, " {v}"),
        };
    }
    out.push('\n');
}

/// The text before the first `#`.
fn without_comment(text: &str) -> &str {
    if text.as_bytes().contains(&b'#') { text.split('#').next().unwrap_or_default() } else { text }
}

/// Writes a line of numbers; a position with a colour behind it loses the colour.
fn write_numbers(keyword: &str, numbers: &str, out: &mut String) {
    out.push_str(keyword);
    // Five numbers have four gaps at least.
    let num_spaces = numbers.bytes().filter(u8::is_ascii_whitespace).count();
    if keyword == "v" && num_spaces > 3 && numbers.split_ascii_whitespace().nth(4).is_some() {
        for number in numbers.split_ascii_whitespace().take(3) {
            out.push(' ');
            out.push_str(number);
        }
    } else {
        out.push(' ');
        out.push_str(numbers);
    }
    out.push('\n');
}

impl Clean for ObjLines<'_> {
    fn clean(&mut self, text: &str, at: Place<'_>, out: &mut String) -> Result<()> {
        let end = text.bytes().position(|byte| byte.is_ascii_whitespace()).unwrap_or(text.len());
        let (keyword, rest) = (&text[..end], text.get(end + 1..).unwrap_or_default());
        match keyword {
            "v" | "vt" | "vn" => {
                self.count(keyword, at)?;
                write_numbers(keyword, without_comment(rest), out);
            }
            "f" => self.face(without_comment(rest).trim(), at, out)?,
            "o" | "g" => {
                self.name = rest.trim().into();
                let _ = writeln!(out, "o {}", self.name);
            }
            "mtllib" => {
                if let Some(mtl) = self.mtl {
                    mtl.borrow_mut().line = at.line;
                }
                let _ = writeln!(out, "mtllib {}", rest.trim());
            }
            "usemtl" if !rest.trim().is_empty() => {
                if let Some(mtl) = self.mtl {
                    mtl.borrow_mut().remark_unknown(rest.trim(), at);
                }
                let _ = writeln!(out, "usemtl {}", rest.trim());
            }
            _ => {}
        }
        Ok(())
    }
}
