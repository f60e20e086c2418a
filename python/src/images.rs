//! Arrays to the images of a surface. Row 0 of an array is the top of the picture, as in files;
//! ours is the bottom, so rows are turned over.

use crate::arguments::{choice, mistyped, refused};
use basrelief::texture::{ColorImage, GrayImage, HeightImage, NormalImage, Wrap, linear_from_srgb};
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Most texels a side, as of files.
const MOST_SIDE: usize = 32768;

/// What lies beyond a texture's edges, by its word.
pub(crate) fn wrap(word: &str) -> PyResult<Wrap> {
    let choices = [("repeat", Wrap::Repeat), ("mirror", Wrap::Mirror), ("clamp", Wrap::Clamp)];
    choice("wrap", word, &choices)
}

/// The numbers of a picture, as they came.
enum Values {
    /// Bytes, of which 255 stands for 1.
    Bits8(Vec<u8>),
    /// Of which 65535 stands for 1.
    Bits16(Vec<u16>),
    Float(Vec<f32>),
}

/// A picture as an array gives it.
struct Picture {
    size: [usize; 2],
    num_channels: usize,
    values: Values,
}

impl Picture {
    /// Reads an array of shape (H, W) or (H, W, channels) of `uint8`, `uint16` or floats.
    fn new(arg: &Bound<'_, PyAny>, name: &str, channels: &[usize]) -> PyResult<Self> {
        let py = arg.py();
        let types = "must be a NumPy array of uint8, uint16 or floats";
        let array = arg.cast::<PyUntypedArray>().map_err(|_| mistyped(name, types))?;
        let (height, width, num_channels) = match *array.shape() {
            [height, width] => (height, width, 1),
            [height, width, num] => (height, width, num),
            _ => (0, 0, 0),
        };
        if !channels.contains(&num_channels) {
            let shape = array.shape();
            let reason = format!(
                "must be (H, W) or (H, W, channels) with {channels:?} channels, not {shape:?}"
            );
            return Err(refused(name, reason));
        }
        if ![width, height].iter().all(|side| (1..=MOST_SIDE).contains(side)) {
            let reason =
                format!("{width} x {height} texels are not within 1 to {MOST_SIDE} a side");
            return Err(refused(name, reason));
        }
        let dtype = array.dtype();
        let is = |code: &str| dtype.call_method1("__eq__", (code,))?.extract::<bool>();
        let contiguous = |of: &str| {
            let options = PyDict::new(py);
            options.set_item("order", "C")?;
            options.set_item("copy", false)?;
            array.call_method("astype", (of,), Some(&options))
        };
        let values = if is("uint8")? {
            Values::Bits8(contiguous("uint8")?.cast::<PyArrayDyn<u8>>()?.to_vec()?)
        } else if is("uint16")? {
            Values::Bits16(contiguous("uint16")?.cast::<PyArrayDyn<u16>>()?.to_vec()?)
        } else if dtype.getattr("kind")?.extract::<String>()? == "f" {
            Values::Float(contiguous("float32")?.cast::<PyArrayDyn<f32>>()?.to_vec()?)
        } else {
            return Err(mistyped(name, format!("{types}, not of {dtype}")));
        };
        Ok(Self { size: [width, height], num_channels, values })
    }

    /// The texels, bottom row first, each made of its channels, which are 0 to 1 but for floats.
    fn map<T>(&self, make: impl Fn(&[f32]) -> T) -> Vec<T> {
        match &self.values {
            Values::Bits8(values) => self.each(values, |v| f32::from(v) / 255.0, make),
            Values::Bits16(values) => self.each(values, |v| f32::from(v) / 65535.0, make),
            Values::Float(values) => self.each(values, |v| if v.is_nan() { 0.0 } else { v }, make),
        }
    }

    fn each<S: Copy, T>(
        &self,
        values: &[S],
        read: impl Fn(S) -> f32,
        make: impl Fn(&[f32]) -> T,
    ) -> Vec<T> {
        let rows = values.chunks_exact(self.size[0] * self.num_channels).rev();
        let texel = |values: &[S]| {
            let mut channels = [0.0; 4];
            channels.iter_mut().zip(values).for_each(|(to, from)| *to = read(*from));
            make(&channels[..self.num_channels])
        };
        rows.flat_map(|row| row.chunks_exact(self.num_channels)).map(texel).collect()
    }

    fn size(&self) -> [u32; 2] {
        self.size.map(|side| side as u32)
    }
}

/// The first three channels, or the only one thrice.
fn rgb(channels: &[f32]) -> [f32; 3] {
    match *channels {
        [r, g, b, ..] => [r, g, b],
        [gray, ..] => [gray; 3],
        [] => [0.0; 3],
    }
}

/// A number from 0 to 1 in 16 bits.
fn bits(unit: f32) -> u16 {
    (unit.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16
}

/// Colours: whole numbers are sRGB, floats linear light from 0 to 1e6, as of files.
pub(crate) fn color(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<ColorImage> {
    let picture = Picture::new(arg, name, &[1, 3, 4])?;
    let [width, height] = picture.size();
    if !matches!(picture.values, Values::Float(_)) {
        // A table, since pictures have more texels than values.
        let num = if matches!(picture.values, Values::Bits8(_)) { 256 } else { 65536 };
        let most = (num - 1) as f32;
        let table: Vec<u16> = (0..num).map(|i| bits(linear_from_srgb(i as f32 / most))).collect();
        let linear = |c: f32| table[(c * most + 0.5) as usize];
        let texels = picture.map(|channels| rgb(channels).map(linear));
        return Ok(ColorImage { width, height, texels, scale: 1.0 });
    }
    let light = picture.map(|channels| rgb(channels).map(|c| c.clamp(0.0, 1e6)));
    let brightest = light.as_flattened().iter().fold(0.0_f32, |most, c| most.max(*c));
    let scale = if brightest > 1e-6 { brightest } else { 1.0 };
    let texels = light.iter().map(|c| c.map(|c| bits(c / scale))).collect();
    Ok(ColorImage { width, height, texels, scale })
}

/// One number a texel, 0 to 1.
pub(crate) fn gray(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<GrayImage> {
    let picture = Picture::new(arg, name, &[1])?;
    let [width, height] = picture.size();
    Ok(GrayImage { width, height, texels: picture.map(|channels| bits(channels[0])) })
}

/// Heights, 0 to 1: 1 lies on the polygon.
pub(crate) fn height(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<HeightImage> {
    gray(arg, name).map(HeightImage::from)
}

/// Normals in the texture's frame: whole numbers from black to white and floats both stand for -1
/// to 1, floats as they are; green points up.
pub(crate) fn normal(arg: &Bound<'_, PyAny>, name: &str) -> PyResult<NormalImage> {
    let picture = Picture::new(arg, name, &[3, 4])?;
    let [width, height] = picture.size();
    let is_float = matches!(picture.values, Values::Float(_));
    let signed = |c: f32| {
        let c = if is_float { c } else { c * 2.0 - 1.0 };
        (c.clamp(-1.0, 1.0) * 32767.0).round() as i16
    };
    Ok(NormalImage { width, height, texels: picture.map(|channels| rgb(channels).map(signed)) })
}
