//! A layer as a NumPy array: rows, columns and, if there are several, numbers a pixel; little-endian
//! 32-bit floats, or whole numbers for names.

use basrelief::Layer;
use basrelief::layers::Values;
use npyz::{AutoSerialize, DType, Serialize, WriteOptions, WriterBuilder};

/// The file's bytes.
pub(super) fn encode(size: [u32; 2], layer: Layer, values: &Values) -> Result<Vec<u8>, String> {
    let [width, height] = size.map(u64::from);
    let shape = [height, width, layer.num_channels() as u64];
    let shape = if shape[2] == 1 { &shape[..2] } else { &shape[..] };
    match values {
        Values::Floats(values) => array("<f4", shape, values),
        Values::Ids(values) => array("<u4", shape, values),
    }
}

fn array<T: Serialize + AutoSerialize + Copy>(
    kind: &str,
    shape: &[u64],
    values: &[T],
) -> Result<Vec<u8>, String> {
    let mut file = Vec::new();
    // Not the machine's own order of bytes: files are the same on every machine.
    let kind = DType::Plain(kind.parse().map_err(|e| format!("{kind}: {e}"))?);
    let options = WriteOptions::new().dtype(kind).shape(shape).writer(&mut file);
    let mut writer = options.begin_nd().map_err(|e| e.to_string())?;
    writer.extend(values.iter().copied()).map_err(|e| e.to_string())?;
    writer.finish().map_err(|e| e.to_string())?;
    Ok(file)
}
