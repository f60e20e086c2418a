//! How frames are drawn.

use crate::arguments::{choice, exception, refused};
use crate::pickles::{Made, rebuilt};
use basrelief::{Derivatives, Formulas, Lighting, Settings, Tone, Visibility};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The filters by name, each with its default options.
pub(crate) const FILTERS: [(&str, basrelief::Filter); 8] = {
    let [nearest, bilinear, trilinear, ewa, visible, horizon, parallax, truth] =
        basrelief::Filter::ALL;
    [
        ("horizon", horizon),
        ("nearest", nearest),
        ("bilinear", bilinear),
        ("trilinear", trilinear),
        ("ewa", ewa),
        ("visible", visible),
        ("parallax", parallax),
        ("truth", truth),
    ]
};

/// Which texels make up a pixel's colour.
///
/// Filter(name="horizon", **options)
///
/// name: one of basrelief.FILTERS: "horizon" (the floating horizon), "visible" (the paper's
///     method), "ewa", "trilinear", "bilinear", "nearest", "parallax", "truth".
/// options, each of some filters: lines, far_field, far_field_mib (horizon), derivatives ("flat" or
///     "relief"), formulas ("meant" or "printed"), visible ("exact", "two-ended" or "resolved"),
///     texel_budget, max_anisotropy, max_stretch, every_texel, cut, texel_kernel, samples. They are
///     those of the program: docs/program.md says what each does.
#[pyclass(frozen, eq, module = "basrelief")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Filter(pub(crate) basrelief::Filter);

#[pymethods]
impl Filter {
    #[new]
    #[pyo3(signature = (name = "horizon", **options))]
    fn new(name: &str, options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut filter = choice("filter", name, &FILTERS)?;
        for (option, value) in options.into_iter().flatten() {
            let option: String = option.extract()?;
            if !set(&mut filter, &option, &value)? {
                let text = format!("the filter \"{name}\" has no option '{option}'");
                return Err(PyTypeError::new_err(text));
            }
        }
        filter.validate().map_err(exception)?;
        Ok(Self(filter))
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py>> {
        rebuilt::<Self>(py, (name(&self.0), options(py, self.0)?))
    }

    #[staticmethod]
    fn _rebuild(name: &str, options: &Bound<'_, PyDict>) -> PyResult<Self> {
        Self::new(name, Some(options))
    }

    fn __repr__(&self) -> String {
        format!("{:?}", self.0)
    }
}

const DERIVATIVES: [(&str, Derivatives); 2] =
    [("flat", Derivatives::Flat), ("relief", Derivatives::Relief)];
const FORMULAS: [(&str, Formulas); 2] =
    [("meant", Formulas::Meant), ("printed", Formulas::Printed)];
const VISIBILITIES: [(&str, Visibility); 3] = [
    ("exact", Visibility::Exact),
    ("two-ended", Visibility::TwoEnded),
    ("resolved", Visibility::Resolved),
];

fn name(filter: &basrelief::Filter) -> &'static str {
    let is_same = |other| std::mem::discriminant(filter) == std::mem::discriminant(other);
    FILTERS.iter().find(|(_, other)| is_same(other)).map_or("horizon", |(name, _)| name)
}

/// All options that a filter has, as a caller would give them.
fn options(py: Python<'_>, mut filter: basrelief::Filter) -> PyResult<Bound<'_, PyDict>> {
    fn word<T: PartialEq>(
        value: Option<&mut T>,
        choices: &[(&'static str, T)],
    ) -> Option<&'static str> {
        let value = value?;
        choices.iter().find(|(_, other)| other == value).map(|(word, _)| *word)
    }
    let of = filter.options_mut();
    let numbers = [
        ("lines", of.lines),
        ("far_field_mib", of.far_field_mib),
        ("texel_budget", of.texel_budget),
        ("samples", of.samples),
    ];
    let shares = [
        ("max_anisotropy", of.max_anisotropy),
        ("max_stretch", of.max_stretch),
        ("cut", of.cut),
        ("texel_kernel", of.texel_kernel),
    ];
    let switches = [("far_field", of.far_field), ("every_texel", of.every_texel)];
    let words = [
        ("derivatives", word(of.derivatives, &DERIVATIVES)),
        ("formulas", word(of.formulas, &FORMULAS)),
        ("visible", word(of.visibility, &VISIBILITIES)),
    ];
    let options = PyDict::new(py);
    for (name, value) in numbers {
        value.map_or(Ok(()), |value| options.set_item(name, *value))?;
    }
    for (name, value) in shares {
        value.map_or(Ok(()), |value| options.set_item(name, *value))?;
    }
    for (name, value) in switches {
        value.map_or(Ok(()), |value| options.set_item(name, *value))?;
    }
    for (name, value) in words {
        value.map_or(Ok(()), |value| options.set_item(name, value))?;
    }
    Ok(options)
}

/// Sets an option, if the filter has it.
fn set(filter: &mut basrelief::Filter, name: &str, value: &Bound<'_, PyAny>) -> PyResult<bool> {
    /// Puts a value in its place, if there is one.
    fn put<'py, T: for<'a> FromPyObject<'a, 'py>>(
        place: Option<&mut T>,
        name: &str,
        value: &Bound<'py, PyAny>,
    ) -> PyResult<bool> {
        let Some(place) = place else { return Ok(false) };
        *place = value.extract::<T>().map_err(|error| refused(name, error.into()))?;
        Ok(true)
    }
    fn word<T: Copy>(
        place: Option<&mut T>,
        name: &str,
        value: &Bound<'_, PyAny>,
        choices: &[(&str, T)],
    ) -> PyResult<bool> {
        let Some(place) = place else { return Ok(false) };
        let word: String = value.extract().map_err(|error: PyErr| refused(name, error))?;
        *place = choice(name, &word, choices)?;
        Ok(true)
    }
    let of = filter.options_mut();
    match name {
        "lines" => put(of.lines, name, value),
        "far_field" => put(of.far_field, name, value),
        "far_field_mib" => put(of.far_field_mib, name, value),
        "texel_budget" => put(of.texel_budget, name, value),
        "max_anisotropy" => put(of.max_anisotropy, name, value),
        "max_stretch" => put(of.max_stretch, name, value),
        "every_texel" => put(of.every_texel, name, value),
        "cut" => put(of.cut, name, value),
        "texel_kernel" => put(of.texel_kernel, name, value),
        "samples" => put(of.samples, name, value),
        "derivatives" => word(of.derivatives, name, value, &DERIVATIVES),
        "formulas" => word(of.formulas, name, value, &FORMULAS),
        "visible" => word(of.visibility, name, value, &VISIBILITIES),
        _ => Ok(false),
    }
}

/// A filter as the caller names it: a word, or a Filter.
pub(crate) fn filter(arg: Option<&Bound<'_, PyAny>>) -> PyResult<basrelief::Filter> {
    let Some(arg) = arg else { return Ok(basrelief::Filter::default()) };
    if let Ok(filter) = arg.cast::<Filter>() {
        return Ok(filter.get().0);
    }
    match arg.extract::<String>() {
        Ok(word) => choice("filter", &word, &FILTERS),
        Err(_) => Err(PyTypeError::new_err("filter: must be a name or a Filter")),
    }
}

/// The words of `lighting` and `tone` in settings.
pub(crate) fn light(settings: &mut Settings, lighting: &str, tone: &str) -> PyResult<()> {
    let lightings = [("lit", Lighting::Lit), ("unlit", Lighting::Unlit)];
    settings.lighting = choice("lighting", lighting, &lightings)?;
    settings.tone = choice("tone", tone, &[("none", Tone::None), ("neutral", Tone::Neutral)])?;
    Ok(())
}
