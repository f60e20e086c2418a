//! An OBJ file, through tobj, to models of triangles.

mod clean;
pub(super) mod locate;

use super::lines::{CleanLines, Place, Source};
use super::mtl::MtlFiles;
use crate::decode::contain;
use crate::error::{Error, Result};
use clean::ObjLines;
use std::cell::RefCell;

/// Reads all models; their `material_id` is an index into the materials of `mtl`.
///
/// # Errors
/// Names the line that is wrong, or the file when it has no faces.
pub(super) fn read(
    source: &dyn Source,
    max_triangles: u64,
    mtl: &RefCell<MtlFiles>,
) -> Result<Vec<tobj::Model>> {
    let cleaner = ObjLines::new(max_triangles, Some(mtl));
    let mut lines = CleanLines::new(source.reader()?, source.path(), cleaner);
    let options = tobj::LoadOptions {
        single_index: true,
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
    };
    let read =
        contain(|| tobj::load_obj_buf(&mut lines, &options, |names| mtl.borrow_mut().read(names)));
    if let Some(failure) = lines.failure.take().or_else(|| mtl.borrow_mut().failure.take()) {
        return Err(failure);
    }
    let models = match read {
        Some(Ok((models, _))) => models,
        Some(Err(error)) => return Err(refusal(error, lines.place(), source)),
        None => {
            return Err(
                locate::bad_index(source).unwrap_or_else(|| lines.place().refuse("cannot be read"))
            );
        }
    };
    lines.cleaner.check_lists(source.path())?;
    let models: Vec<_> =
        models.into_iter().filter(|model| !model.mesh.indices.is_empty()).collect();
    if models.is_empty() {
        return Err(Error::file(source.path(), "has no faces"));
    }
    Ok(models)
}

fn refusal(error: tobj::LoadError, place: Place<'_>, source: &dyn Source) -> Error {
    use tobj::LoadError as E;
    let reason = match error {
        E::PositionParseError => "'v' needs three numbers",
        E::ScalingByZeroError => "the fourth number of 'v' must not be 0",
        E::TexcoordParseError => "'vt' needs two numbers",
        E::NormalParseError => "'vn' needs three numbers",
        E::FaceParseError => "a face needs corners such as 1, 1/2, 1//3 or 1/2/3",
        E::FaceVertexOutOfBounds | E::FaceTexCoordOutOfBounds | E::FaceNormalOutOfBounds => {
            return locate::bad_index(source)
                .unwrap_or_else(|| Error::caused(source.path(), error));
        }
        _ => return place.refuse(error),
    };
    place.refuse(reason)
}
