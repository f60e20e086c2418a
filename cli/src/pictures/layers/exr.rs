//! Layers as channels of one EXR file: `depth.Z`, `normal.X` and their like, 32-bit floats, and
//! 32-bit whole numbers for names. A region of a frame lies where it does in the frame.

use basrelief::layers::Values;
use basrelief::{Layer, Settings};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, IntegerBounds,
    Layer as ExrLayer, LayerAttributes, SmallVec, Vec2, WritableImage,
};
use std::io::Cursor;

/// The file's bytes.
pub(super) fn encode<'a>(
    settings: &Settings,
    layers: impl Iterator<Item = (Layer, &'a Values)>,
) -> Result<Vec<u8>, String> {
    let mut channels = SmallVec::new();
    for (layer, values) in layers {
        for (i, suffix) in suffixes(layer).iter().enumerate() {
            let name = format!("{}.{suffix}", layer.name());
            channels.push(AnyChannel::new(name.as_str(), every(values, i, layer.num_channels())));
        }
    }
    let drawn = settings.drawn();
    let attributes = LayerAttributes {
        layer_position: Vec2(drawn.x as i32, drawn.y as i32),
        ..LayerAttributes::default()
    };
    let size = Vec2(drawn.width as usize, drawn.height as usize);
    let layer =
        ExrLayer::new(size, attributes, Encoding::FAST_LOSSLESS, AnyChannels::sort(channels));
    let whole = Vec2(settings.width as usize, settings.height as usize);
    let window = IntegerBounds::from_dimensions(whole);
    let image = Image::new(ImageAttributes::new(window), layer);
    let mut file = Cursor::new(Vec::new());
    image.write().to_buffered(&mut file).map_err(|e| e.to_string())?;
    Ok(file.into_inner())
}

/// What the channels of a layer are called.
fn suffixes(layer: Layer) -> &'static [&'static str] {
    match layer {
        Layer::Depth | Layer::PolygonDepth => &["Z"],
        Layer::Position
        | Layer::CameraPosition
        | Layer::PolygonPosition
        | Layer::Normal
        | Layer::CameraNormal
        | Layer::PolygonNormal => &["X", "Y", "Z"],
        Layer::Uv | Layer::PolygonUv => &["U", "V"],
        Layer::Albedo => &["R", "G", "B"],
        Layer::Object | Layer::Material | Layer::Triangle => &["id"],
    }
}

/// Every `step`-th number from `first` on.
fn every(values: &Values, first: usize, step: usize) -> FlatSamples {
    match values {
        Values::Floats(values) => {
            FlatSamples::F32(values.iter().skip(first).step_by(step).copied().collect())
        }
        Values::Ids(values) => {
            FlatSamples::U32(values.iter().skip(first).step_by(step).copied().collect())
        }
    }
}
