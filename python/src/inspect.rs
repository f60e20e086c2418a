//! What one pixel sees, as a dict.

use basrelief::Formulas;
use basrelief::inspect::{Corner, Cut, Ellipse, Inspection, Projected, Ray, Reading, Sets};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A dict of named values.
macro_rules! dict {
    ($py:expr, { $($name:literal: $value:expr),* $(,)? }) => {{
        let dict = PyDict::new($py);
        $(dict.set_item($name, $value)?;)*
        dict
    }};
}

type Dict<'py> = PyResult<Bound<'py, PyDict>>;

/// All numbers of an inspection.
pub(crate) fn dict<'py>(py: Python<'py>, seen: &Inspection) -> Dict<'py> {
    let Inspection { pixel, mesh, triangle, material, relief_depth, .. } = *seen;
    let Ray { base, displacement, hit_depth, hit } = seen.ray;
    let readings = PyDict::new(py);
    for reading in &seen.readings {
        let name = match reading.formulas {
            Formulas::Meant => "meant",
            Formulas::Printed => "printed",
        };
        readings.set_item(name, self::reading(py, reading)?)?;
    }
    Ok(dict!(py, {
        "pixel": pixel,
        "object": mesh,
        "triangle": triangle,
        "material": material,
        "relief_depth": relief_depth,
        "ray": dict!(py, {
            "base": base, "displacement": displacement, "hit_depth": hit_depth, "hit": hit,
        }),
        "readings": readings,
        "sets": sets(py, &seen.sets)?,
        "cut": cut(py, &seen.cut)?,
    }))
}

fn reading<'py>(py: Python<'py>, reading: &Reading) -> Dict<'py> {
    let corners = |corners: &[Corner; 2]| {
        let corner = |corner: &Corner| -> Dict<'py> {
            Ok(dict!(py, { "uv": corner.uv, "offset": corner.offset }))
        };
        corners.iter().map(corner).collect::<PyResult<Vec<_>>>()
    };
    Ok(dict!(py, {
        "row": corners(&reading.row)?,
        "column": corners(&reading.column)?,
        "flat": projected(py, &reading.flat)?,
        "relief": projected(py, &reading.relief)?,
    }))
}

fn projected<'py>(py: Python<'py>, projected: &Projected) -> Dict<'py> {
    let Projected { dx, dy, center, conic, widened, area, half_axes } = *projected;
    Ok(dict!(py, {
        "dx": dx,
        "dy": dy,
        "center": center,
        "conic": ellipse(py, conic)?,
        "widened": ellipse(py, widened)?,
        "area": area,
        "half_axes": half_axes,
    }))
}

fn ellipse(py: Python<'_>, Ellipse { a, b, c, f }: Ellipse) -> Dict<'_> {
    Ok(dict!(py, { "a": a, "b": b, "c": c, "f": f }))
}

/// Texels as an array of columns and rows.
fn texels<'py>(py: Python<'py>, texels: &[[i32; 2]]) -> PyResult<Bound<'py, PyArray2<i32>>> {
    PyArray1::from_slice(py, texels.as_flattened()).reshape([texels.len(), 2])
}

fn sets<'py>(py: Python<'py>, sets: &Sets) -> Dict<'py> {
    let [hidden, seen] = [0, 1].map(|i| sets.covered_by.iter().map(|pair| pair[i]).collect());
    let (hidden, seen): (Vec<_>, Vec<_>) = (hidden, seen);
    let (twice, counts): (Vec<_>, Vec<_>) = sets.counted_twice.iter().copied().unzip();
    Ok(dict!(py, {
        "level": sets.level,
        "texels_per_repeat": sets.texels_per_repeat,
        "ellipse": ellipse(py, sets.ellipse)?,
        "displacement": sets.displacement,
        "all": texels(py, &sets.all)?,
        "visible": texels(py, &sets.visible)?,
        "hidden": texels(py, &sets.hidden)?,
        "skipped": texels(py, &sets.skipped)?,
        "covered": texels(py, &hidden)?,
        "covered_by": texels(py, &seen)?,
        "counted_twice": texels(py, &twice)?,
        "counts": PyArray1::from_vec(py, counts),
    }))
}

fn cut<'py>(py: Python<'py>, cut: &Cut) -> Dict<'py> {
    let column = |of: fn(&basrelief::inspect::CutPoint) -> f64| {
        PyArray1::from_vec(py, cut.points.iter().map(of).collect())
    };
    let points: Vec<_> = cut.points.iter().map(|point| point.texel).collect();
    let [num_seen, num] = cut.num_seen();
    Ok(dict!(py, {
        "direction": cut.direction,
        "displacement": cut.displacement,
        "relief_depth": cut.relief_depth,
        "ellipse": cut.ellipse,
        "hit": cut.hit,
        "texel": texels(py, &points)?,
        "along": column(|point| point.along),
        "depth": column(|point| point.depth),
        "projected": column(|point| point.projected),
        "horizon": column(|point| point.horizon),
        "visible": column(|point| point.visible),
        "num_seen": num_seen,
        "num": num,
    }))
}
