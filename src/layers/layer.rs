//! What layers there are.

/// What is asked of each pixel. World space is the scene's; *camera axes* are those of OpenCV, x
/// to the right, y down and z forward along the view, from the eye.
///
/// Where nothing is seen, ids are [`u32::MAX`], depths and positions infinite and all others 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Layer {
    /// Distance along the view (along the camera's z, not along the ray) to the hit, in world
    /// units: above 0.
    Depth,
    /// World position of the hit.
    Position,
    /// Unit normal in world axes, on the side that the eye sees: of the texel at the hit, which a
    /// normal map or the slope of the height map bends, where a surface has such; else the mesh's.
    Normal,
    /// Texture coordinates of the hit in repeats, v upwards; 0 where a mesh has none.
    Uv,
    /// [`Self::Position`] in camera axes: its z is the [`Self::Depth`].
    CameraPosition,
    /// [`Self::Normal`] in camera axes.
    CameraNormal,
    /// [`Self::Depth`] of the polygon.
    PolygonDepth,
    /// [`Self::Position`] of the polygon.
    PolygonPosition,
    /// The mesh's unit normal in world axes, interpolated, on the side that the eye sees.
    PolygonNormal,
    /// [`Self::Uv`] of the polygon.
    PolygonUv,
    /// Colour of the full texture's texel at the hit times the material's base colour: linear red,
    /// green and blue, unlit. The mean over a pixel is what a frame draws unlit; this is one texel.
    Albedo,
    /// Index of the mesh in [`Scene::meshes`](crate::Scene::meshes).
    Object,
    /// Index of the material in [`Scene::materials`](crate::Scene::materials).
    Material,
    /// Index of the triangle in the mesh's [`triangles`](crate::Mesh::triangles).
    Triangle,
}

impl Layer {
    /// All of them.
    pub const ALL: [Self; 14] = [
        Self::Depth,
        Self::Position,
        Self::Normal,
        Self::Uv,
        Self::CameraPosition,
        Self::CameraNormal,
        Self::PolygonDepth,
        Self::PolygonPosition,
        Self::PolygonNormal,
        Self::PolygonUv,
        Self::Albedo,
        Self::Object,
        Self::Material,
        Self::Triangle,
    ];

    /// Its name in options and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Position => "position",
            Self::Normal => "normal",
            Self::Uv => "uv",
            Self::CameraPosition => "camera-position",
            Self::CameraNormal => "camera-normal",
            Self::PolygonDepth => "polygon-depth",
            Self::PolygonPosition => "polygon-position",
            Self::PolygonNormal => "polygon-normal",
            Self::PolygonUv => "polygon-uv",
            Self::Albedo => "albedo",
            Self::Object => "object",
            Self::Material => "material",
            Self::Triangle => "triangle",
        }
    }

    /// Numbers a pixel.
    pub fn num_channels(self) -> usize {
        match self {
            Self::Uv | Self::PolygonUv => 2,
            Self::Position
            | Self::Normal
            | Self::CameraPosition
            | Self::CameraNormal
            | Self::PolygonPosition
            | Self::PolygonNormal
            | Self::Albedo => 3,
            Self::Depth | Self::PolygonDepth | Self::Object | Self::Material | Self::Triangle => 1,
        }
    }

    /// Whether it names something by its index, and is no measure.
    pub fn is_id(self) -> bool {
        matches!(self, Self::Object | Self::Material | Self::Triangle)
    }

    /// What its numbers are where nothing is seen; ids are [`u32::MAX`] there.
    pub fn background(self) -> f32 {
        match self {
            Self::Depth
            | Self::Position
            | Self::CameraPosition
            | Self::PolygonDepth
            | Self::PolygonPosition => f32::INFINITY,
            _ => 0.0,
        }
    }

    /// Whether it is made of a triangle's attributes, or of where the relief is hit.
    pub(super) fn asks_for_quads(self, is_traced: bool) -> bool {
        match self {
            Self::Depth | Self::Position | Self::CameraPosition => is_traced,
            Self::PolygonDepth | Self::PolygonPosition => false,
            Self::Object | Self::Material | Self::Triangle => false,
            Self::Normal
            | Self::CameraNormal
            | Self::PolygonNormal
            | Self::Uv
            | Self::PolygonUv
            | Self::Albedo => true,
        }
    }

    /// Whether the relief decides it.
    pub(super) fn is_of_hit(self) -> bool {
        matches!(
            self,
            Self::Depth
                | Self::Position
                | Self::Normal
                | Self::Uv
                | Self::CameraPosition
                | Self::CameraNormal
                | Self::Albedo
        )
    }

    /// Whether it says where the hit is.
    pub(super) fn is_place(self) -> bool {
        matches!(self, Self::Depth | Self::Position | Self::CameraPosition)
    }

    pub(super) fn is_normal(self) -> bool {
        matches!(self, Self::Normal | Self::CameraNormal | Self::PolygonNormal)
    }
}
