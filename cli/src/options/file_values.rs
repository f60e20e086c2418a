//! Values of scene files and camera paths: read and written by serde, bounded as the options are.
//!
//! Each function reads one value that may be left out. Its error carries no place; the TOML reader
//! adds the line.

use crate::options::values::{self, Pose, check};
use basrelief::Light;
use glam::Vec3;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Functions for `deserialize_with`, each with the type that it reads and the check that the value
/// must pass.
macro_rules! checked {
    ($($name:ident: $type:ty, $check:expr;)*) => {
        $(pub(crate) fn $name<'de, D: Deserializer<'de>>(from: D) -> Result<Option<$type>, D::Error> {
            $check(<$type>::deserialize(from)?).map(Some).map_err(D::Error::custom)
        })*
    };
}

checked! {
    above_zero: f32, check::above_zero;
    crease_angle: f32, check::crease_angle;
    field_of_view: f32, check::field_of_view;
    intrinsics: [f32; 4], check::intrinsics;
    picture_height: f32, check::picture_height;
    pose: Pose, check::pose;
    turn: f32, check::turn;
    unit: f32, check::unit;
    direction: Vec3, check::direction;
    intensity: Vec3, check::intensity;
    vector: Vec3, check::vector;
}

/// A value that scene files hold as the option's text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spelt<T> {
    text: String,
    pub(crate) value: T,
}

/// What has a text as an option.
pub(crate) trait Spell: Sized {
    fn parse(text: &str) -> Result<Self, String>;
}

impl Spell for [u32; 2] {
    fn parse(text: &str) -> Result<Self, String> {
        values::size(text)
    }
}

impl Spell for basrelief::Region {
    fn parse(text: &str) -> Result<Self, String> {
        values::region(text)
    }
}

/// Linear RGB and opacity.
impl Spell for [f32; 4] {
    fn parse(text: &str) -> Result<Self, String> {
        values::color(text)
    }
}

impl<T: Spell> Spelt<T> {
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        T::parse(text).map(|value| Self { text: text.into(), value })
    }
}

impl<T> Serialize for Spelt<T> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        self.text.serialize(to)
    }
}

impl<'de, T: Spell> Deserialize<'de> for Spelt<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        Self::parse(&String::deserialize(from)?).map_err(D::Error::custom)
    }
}

/// Light from far away.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Sun {
    /// Towards the light.
    pub(crate) direction: Vec3,
    /// Linear RGB.
    #[serde(default = "white")]
    pub(crate) color: Vec3,
    /// Diameter in degrees.
    #[serde(default = "real_size")]
    pub(crate) size: f32,
}

/// Light from everywhere: one colour, or three in a column.
impl Spell for [Vec3; 3] {
    fn parse(text: &str) -> Result<Self, String> {
        values::sky(text)
    }
}

/// Light from a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PointLight {
    pub(crate) position: Vec3,
    /// Linear RGB at a distance of 1.
    #[serde(default = "white")]
    pub(crate) color: Vec3,
}

fn white() -> Vec3 {
    Vec3::ONE
}

fn real_size() -> f32 {
    Light::SUN_SIZE
}

impl Sun {
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        values::sun(text).map(|(direction, color, size)| Self { direction, color, size })
    }

    fn check(self) -> Result<Self, String> {
        check::direction(self.direction)?;
        check::sun_size(self.size)?;
        check::intensity(self.color).map(|_| self)
    }
}

impl PointLight {
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        values::light(text).map(|[position, color]| Self { position, color })
    }

    fn check(self) -> Result<Self, String> {
        check::vector(self.position)?;
        check::intensity(self.color).map(|_| self)
    }
}

pub(crate) fn suns<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Sun>, D::Error> {
    let suns = Vec::<Sun>::deserialize(from)?;
    suns.into_iter().map(Sun::check).collect::<Result<_, _>>().map_err(D::Error::custom)
}

pub(crate) fn point_lights<'de, D: Deserializer<'de>>(
    from: D,
) -> Result<Vec<PointLight>, D::Error> {
    let lights = Vec::<PointLight>::deserialize(from)?;
    lights.into_iter().map(PointLight::check).collect::<Result<_, _>>().map_err(D::Error::custom)
}
