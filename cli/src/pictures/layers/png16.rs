//! A layer as a PNG file of 16 bits: names as they are, with 65535 where nothing is seen; normals
//! from -1 to 1 as 0 to 65535, with black where nothing is seen; albedo in sRGB.

use basrelief::Layer;
use basrelief::layers::Values;
use basrelief::texture::srgb_from_linear;

const FULL: f32 = 65535.0;

/// The file's bytes.
pub(super) fn encode(
    [width, height]: [u32; 2],
    layer: Layer,
    values: &Values,
) -> Result<Vec<u8>, String> {
    let samples = match values {
        Values::Ids(ids) => ids.iter().map(|id| id_sample(layer, *id)).collect::<Result<_, _>>()?,
        Values::Floats(values) if layer == Layer::Albedo => values
            .iter()
            .map(|value| (srgb_from_linear(value.clamp(0.0, 1.0)) * FULL + 0.5) as u16)
            .collect::<Vec<_>>(),
        Values::Floats(values) => values.chunks(3).flat_map(normal_samples).collect(),
    };
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.set_color(match layer.num_channels() {
        1 => png::ColorType::Grayscale,
        _ => png::ColorType::Rgb,
    });
    let bytes: Vec<u8> = samples.into_iter().flat_map(u16::to_be_bytes).collect();
    let write = |mut writer: png::Writer<_>| {
        writer.write_image_data(&bytes)?;
        writer.finish()
    };
    encoder.write_header().and_then(write).map_err(|e| e.to_string())?;
    Ok(file)
}

fn id_sample(layer: Layer, id: u32) -> Result<u16, String> {
    match id {
        u32::MAX => Ok(u16::MAX),
        // The greatest means that nothing is seen.
        id if id < u32::from(u16::MAX) => Ok(id as u16),
        id => Err(format!("{} {id} is too large for .png: use .exr or .npy", layer.name())),
    }
}

fn normal_samples(normal: &[f32]) -> [u16; 3] {
    if normal == [0.0; 3] {
        return [0; 3];
    }
    [0, 1, 2].map(|i| ((normal[i] * 0.5 + 0.5).clamp(0.0, 1.0) * FULL + 0.5) as u16)
}
