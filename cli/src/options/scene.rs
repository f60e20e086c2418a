//! Options that say what is drawn: files, camera, lights and background.
//!
//! The tables of a scene file hold the same options under the same names: see `scene_file`.

use crate::options::camera::CameraOptions;
use crate::options::choices::{self, ON_OFF, one_of};
use crate::options::file_values::{self, PointLight, Spelt, Sun};
use crate::options::settings::Look;
use crate::options::values;
use crate::progress::Progress;
use crate::refusal::Refusal;
use basrelief::load::{
    self, HeightSense, LoadOptions, LoadStage, Loaded, MaterialOptions, NormalY,
};
use basrelief::texture::Wrap;
use basrelief::{Light, Scene, Settings, Sky, Tone, scene};
use clap::Args;
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Args, Clone, Debug, Default)]
pub(crate) struct SceneOptions {
    /// What to draw: an OBJ file with its MTL files and images, a glTF file (.gltf, .glb), or a scene
    /// file (TOML, see --save-scene), which other options override; without one, a built-in scene
    #[arg(value_name = "SCENE")]
    pub(crate) model: Option<PathBuf>,
    /// Where SCENE has no normals: faces that meet at more than this angle, 0 to 180 degrees, show
    /// an edge [default: 60, of glTF 0]
    #[arg(long, value_name = "DEG", value_parser = values::crease_angle, allow_hyphen_values = true, requires = "model")]
    pub(crate) crease_angle: Option<f32>,
    #[command(flatten)]
    pub(crate) all_materials: MapOptions,
    /// Options of single materials by name; only scene files give them.
    #[arg(skip)]
    pub(crate) material: BTreeMap<String, MapOptions>,
    #[command(flatten)]
    pub(crate) limits: LimitOptions,
    #[command(flatten)]
    pub(crate) camera: CameraOptions,
    #[command(flatten)]
    pub(crate) light: LightOptions,
}

#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[command(next_help_heading = "All materials of SCENE, in place of what its files say")]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct MapOptions {
    /// Colour image
    #[arg(long, value_name = "FILE", requires = "model")]
    pub(crate) albedo: Option<PathBuf>,
    /// Height image
    #[arg(long, value_name = "FILE", requires = "model")]
    pub(crate) height: Option<PathBuf>,
    /// Normal map
    #[arg(long, value_name = "FILE", requires = "model")]
    pub(crate) normal: Option<PathBuf>,
    /// Image of where surfaces are metal; --metallic multiplies it [default: the MTL file's]
    #[arg(long, value_name = "FILE", requires = "model")]
    pub(crate) metallic_map: Option<PathBuf>,
    /// Image of how rough surfaces are; --roughness multiplies it [default: the MTL file's]
    #[arg(long, value_name = "FILE", requires = "model")]
    pub(crate) roughness_map: Option<PathBuf>,
    /// Image of how much of the sky's light gets to places, over what the relief hides
    #[arg(long, value_name = "FILE", requires = "model")]
    pub(crate) occlusion_map: Option<PathBuf>,
    /// Image of the light that surfaces send out; --emissive multiplies it [default: the
    /// MTL file's]
    #[arg(long, value_name = "FILE", requires = "model")]
    pub(crate) emissive_map: Option<PathBuf>,
    /// Which end of the height images is high [default: white-high]
    #[arg(long, value_name = "END", value_parser = one_of(choices::HEIGHT_SENSES), requires = "model")]
    #[serde(with = "choices")]
    height_sense: Option<HeightSense>,
    /// Depth of the relief in texture repeats, 0 to 1 [default: -bm of the MTL file, else 0.05]
    #[arg(long, value_name = "D", value_parser = values::unit, allow_hyphen_values = true, requires = "model")]
    #[serde(deserialize_with = "file_values::unit")]
    relief_depth: Option<f32>,
    /// Where the green of normal maps points [default: up]
    #[arg(long, value_name = "WAY", value_parser = one_of(choices::NORMAL_YS), requires = "model")]
    #[serde(with = "choices")]
    normal_y: Option<NormalY>,
    /// What lies beyond a texture's edges [default: clamp where the MTL file says so, else repeat]
    #[arg(long, value_name = "HOW", value_parser = one_of(choices::WRAPS), requires = "model")]
    #[serde(with = "choices")]
    wrap: Option<Wrap>,
    /// Colour, linear, which multiplies the colour image [default: Kd of the MTL file, else 1]
    #[arg(long, value_name = "R[,G,B]", value_parser = values::intensity, allow_hyphen_values = true, requires = "model")]
    #[serde(deserialize_with = "file_values::intensity")]
    base_color: Option<Vec3>,
    /// 0 for a dielectric, 1 for a metal [default: 1 with an image of it, else Pm of the MTL file, else 0]
    #[arg(long, value_name = "M", value_parser = values::unit, allow_hyphen_values = true, requires = "model")]
    #[serde(deserialize_with = "file_values::unit")]
    metallic: Option<f32>,
    /// How strongly what is no metal reflects: 0 is matte, 1 as in glTF [default: 1 where the MTL
    /// file or --roughness says how rough it is, else 0]
    #[arg(long, value_name = "S", value_parser = values::unit, allow_hyphen_values = true, requires = "model")]
    #[serde(deserialize_with = "file_values::unit")]
    specular: Option<f32>,
    /// How rough surfaces are: 0 is a mirror, 1 has hardly a highlight [default: 1 with an image of
    /// it, else Pr of the MTL file, else that of Ns, else 1]
    #[arg(long, value_name = "R", value_parser = values::unit, allow_hyphen_values = true, requires = "model")]
    #[serde(deserialize_with = "file_values::unit")]
    roughness: Option<f32>,
    /// Light that surfaces send out, linear [default: Ke of the MTL file, else 0, or 1 with an image
    /// of it]
    #[arg(long, value_name = "R[,G,B]", value_parser = values::intensity, allow_hyphen_values = true, requires = "model")]
    #[serde(deserialize_with = "file_values::intensity")]
    emissive: Option<Vec3>,
    /// Whether surfaces have holes where the opacity of their images is low; off: they are solid
    /// [default: on]
    #[arg(long, value_name = "on|off", hide_possible_values = true, value_parser = one_of(ON_OFF), requires = "model")]
    cut_out: Option<bool>,
}

#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[command(next_help_heading = "Limits for SCENE, beyond which it is refused")]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct LimitOptions {
    /// Let MTL files name images outside the folder of the OBJ file
    #[arg(long, value_name = "on|off", num_args = 0..=1, require_equals = true, default_missing_value = "on",
          hide_possible_values = true, value_parser = one_of(ON_OFF), requires = "model")]
    allow_outside: Option<bool>,
    /// Most pixels of an image's side, 1 to 32768 [default: 32768]
    #[arg(long, value_name = "N", requires = "model", value_parser = clap::value_parser!(u32).range(1..=32768))]
    max_image_side: Option<u32>,
    /// Most memory of all images together in MiB while they are read, about 60 bytes a texel
    /// [default: 1024]
    #[arg(long, value_name = "N", requires = "model", value_parser = clap::value_parser!(u32).range(1..))]
    max_image_mib: Option<u32>,
    /// Most triangles, and most v, vt and vn lines each [default: 50000000]
    #[arg(long, value_name = "N", requires = "model")]
    max_triangles: Option<u64>,
    /// Most image files [default: 1024]
    #[arg(long, value_name = "N", requires = "model")]
    max_textures: Option<u32>,
}

#[derive(Args, Clone, Debug, Default, Serialize, Deserialize)]
#[command(next_help_heading = "Light and background")]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct LightOptions {
    /// Light from everywhere, linear: one colour R[,G,B], or three, blended by how far a direction
    /// goes up (+y) [default: the scene's own, 0.15 for an OBJ file]
    #[arg(long, value_name = "COLOUR|TOP/HORIZON/GROUND", value_parser = Spelt::<[Vec3; 3]>::parse, allow_hyphen_values = true)]
    sky: Option<Spelt<[Vec3; 3]>>,
    /// Light from everywhere: a picture of all directions, HDR or EXR, in place of --sky
    #[arg(long, value_name = "FILE", conflicts_with = "sky")]
    pub(crate) environment: Option<PathBuf>,
    /// How far that picture is turned to the left, about +y [default: 0]
    #[arg(long, value_name = "DEG", value_parser = values::turn, allow_hyphen_values = true, requires = "environment")]
    #[serde(deserialize_with = "file_values::turn")]
    environment_turn: Option<f32>,
    /// Colour where nothing is hit, sRGB: transparent, #rrggbb, R,G,B of 0 to 255 or a name such as
    /// skyblue [default: the scene's own, transparent for an OBJ file]
    #[arg(long, value_name = "COLOUR", value_parser = Spelt::<[f32; 4]>::parse, allow_hyphen_values = true)]
    background: Option<Spelt<[f32; 4]>>,
    /// Light from far away: the direction towards it, its linear colour, 1,1,1 if not given, and its
    /// diameter in degrees, 0.53 if not given; may be repeated; takes the place of the scene's own
    /// lights
    #[arg(long, value_name = "X,Y,Z[,R,G,B[,SIZE]]", value_parser = Sun::parse, allow_hyphen_values = true)]
    #[serde(deserialize_with = "file_values::suns", skip_serializing_if = "Vec::is_empty")]
    sun: Vec<Sun>,
    /// Light from a point: its place, and its linear colour at a distance of 1; may be repeated
    #[arg(long, value_name = "X,Y,Z[,R,G,B]", value_parser = PointLight::parse, allow_hyphen_values = true)]
    #[serde(deserialize_with = "file_values::point_lights", skip_serializing_if = "Vec::is_empty")]
    point_light: Vec<PointLight>,
}

impl SceneOptions {
    /// How a picture of the scene is where no option says so: the built-in scene and glTF, whose
    /// materials are made for it, are lit, others where a light is given.
    pub(crate) fn look(&self) -> Look {
        match &self.model {
            Some(model) if load::is_gltf(model) => Look { is_lit: true, tone: Tone::Neutral },
            None => Look { is_lit: true, tone: Tone::Neutral },
            Some(_) => Look { is_lit: self.has_lights(), ..Look::default() },
        }
    }

    /// [`Self::look`] of a study, which of the built-in scene compares what filters make of its
    /// colours, and has to draw the truth of it.
    pub(crate) fn look_of_study(&self) -> Look {
        Look { is_lit: self.has_lights(), ..Look::default() }
    }

    /// Whether a light is given.
    fn has_lights(&self) -> bool {
        let light = &self.light;
        !light.sun.is_empty()
            || !light.point_light.is_empty()
            || light.sky.is_some()
            || light.environment.is_some()
    }

    /// Reads or makes the scene and sets what the options say.
    pub(crate) fn load(
        &self,
        settings: &Settings,
        is_lit: bool,
        progress: &Progress,
    ) -> Result<Loaded, Refusal> {
        let report = |stage: LoadStage| progress.stage(stage.to_string());
        let mut loaded = match &self.model {
            Some(obj) => load::load_reporting(obj, &self.load_options(settings, is_lit), &report)?,
            None if self.has_maps() => {
                return Err("materials are given, but no model (OBJ file) that has them".into());
            }
            None => built_in(),
        };
        self.set(&mut loaded.scene);
        // Nothing asks for it without lighting, and it may be large.
        if let Some(path) = self.light.environment.as_ref().filter(|_| is_lit) {
            let turn = self.light.environment_turn.unwrap_or_default();
            let picture = load::environment(path, turn, &self.load_options(settings, is_lit))?;
            loaded.scene.sky = Sky::Environment(picture);
        }
        Ok(loaded)
    }

    /// Sets the camera, lights and background that are given.
    pub(crate) fn set(&self, scene: &mut Scene) {
        scene.camera = self.camera.placed(&scene.camera);
        self.light.set(scene);
    }

    fn has_maps(&self) -> bool {
        self.all_materials != MapOptions::default() || !self.material.is_empty()
    }

    /// The file that is drawn, if one is named.
    #[cfg(feature = "viewer")]
    pub(crate) fn path(&self) -> Option<PathBuf> {
        self.model.clone()
    }

    /// How that file is read.
    pub(crate) fn load_options(&self, settings: &Settings, is_lit: bool) -> LoadOptions {
        let (maps, limits) = (&self.all_materials, &self.limits);
        let default = LoadOptions::default();
        LoadOptions {
            all: maps.material(),
            materials: self
                .material
                .iter()
                .map(|(name, maps)| (name.clone(), maps.material()))
                .collect(),
            keep_normals: is_lit,
            aspect: settings.width as f32 / settings.height as f32,
            crease_angle: self.crease_angle,
            allow_outside: limits.allow_outside.unwrap_or(default.allow_outside),
            max_image_side: limits.max_image_side.unwrap_or(default.max_image_side),
            max_image_mib: limits.max_image_mib.unwrap_or(default.max_image_mib),
            max_triangles: limits.max_triangles.unwrap_or(default.max_triangles),
            max_textures: limits.max_textures.unwrap_or(default.max_textures),
        }
    }
}

impl MapOptions {
    /// The files that can be given.
    pub(crate) fn files_mut(&mut self) -> [&mut Option<PathBuf>; 7] {
        let Self { albedo, height, normal, metallic_map, roughness_map, .. } = self;
        let (occlusion, emissive) = (&mut self.occlusion_map, &mut self.emissive_map);
        [albedo, height, normal, metallic_map, roughness_map, occlusion, emissive]
    }

    fn material(&self) -> MaterialOptions {
        MaterialOptions {
            albedo: self.albedo.clone(),
            height: self.height.clone(),
            normal: self.normal.clone(),
            metallic_map: self.metallic_map.clone(),
            roughness_map: self.roughness_map.clone(),
            occlusion_map: self.occlusion_map.clone(),
            emissive_map: self.emissive_map.clone(),
            height_sense: self.height_sense,
            relief_depth: self.relief_depth,
            normal_y: self.normal_y,
            wrap: self.wrap,
            base_color: self.base_color,
            metallic: self.metallic,
            specular: self.specular,
            roughness: self.roughness,
            emissive: self.emissive,
            cut_out: self.cut_out,
        }
    }
}

/// The scene that is drawn where no file is named.
fn built_in() -> Loaded {
    let choices = vec!["no SCENE given: drawing the built-in scene".into()];
    Loaded { scene: scene::builtin(), choices, ..Loaded::default() }
}

impl LightOptions {
    /// Lights that are given take the place of the scene's own.
    fn set(&self, scene: &mut Scene) {
        let sun = |sun: &Sun| Light::Sun {
            to_light: sun.direction,
            intensity: sun.color,
            angular_size: sun.size,
        };
        let suns = self.sun.iter().map(sun);
        let point =
            |light: &PointLight| Light::Point { position: light.position, intensity: light.color };
        let points = self.point_light.iter().map(point);
        let given: Vec<Light> = suns.chain(points).collect();
        if !given.is_empty() {
            scene.lights = given;
        }
        if let Some(sky) = &self.sky {
            let [top, horizon, ground] = sky.value;
            let is_one = top == horizon && horizon == ground;
            scene.sky =
                if is_one { Sky::Color(top) } else { Sky::Gradient { top, horizon, ground } };
        }
        scene.background = self.background.as_ref().map_or(scene.background, |color| color.value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basrelief::Camera;
    use clap::Parser;

    #[derive(Parser)]
    struct Only {
        #[command(flatten)]
        options: SceneOptions,
    }

    fn parse(line: &str) -> Result<SceneOptions, Refusal> {
        let only = Only::try_parse_from(std::iter::once("x").chain(line.split_whitespace()));
        Ok(only.map_err(|e| e.to_string())?.options)
    }

    #[test]
    fn camera_keeps_what_is_not_given() {
        let mut camera = Camera::framing(Vec3::ZERO, Vec3::ONE, 1.0);
        let framing = camera;
        camera = parse("--eye -1,2,-3 --fov 30").unwrap().camera.placed(&camera);
        assert_eq!(
            camera,
            Camera { eye: Vec3::new(-1.0, 2.0, -3.0), fov_degrees: 30.0, ..framing }
        );
    }

    #[test]
    fn view_straight_down_needs_no_up() {
        let mut camera = Camera::default();
        camera = parse("--eye 0,5,0").unwrap().camera.placed(&camera);
        assert_eq!(camera.validate().ok(), Some(()));
    }

    #[test]
    fn lights_replace_the_scenes_own() {
        let own = Light::Point { position: Vec3::ONE, intensity: Vec3::ONE };
        let mut scene = Scene { lights: vec![own], sky: Sky::Color(Vec3::ONE), ..Scene::default() };
        parse("").unwrap().light.set(&mut scene);
        assert!(scene.lights == [own] && scene.sky == Sky::Color(Vec3::ONE));
        let options =
            parse("--sun -1,2,3 --point-light 1,2,3,4,5,6 --sun 1,0,0,1,1,1,2 --sky 0").unwrap();
        assert!(options.has_lights());
        options.light.set(&mut scene);
        assert!(scene.lights.len() == 3 && scene.sky == Sky::Color(Vec3::ZERO));
        let (to_light, intensity) = (Vec3::X, Vec3::ONE);
        assert_eq!(scene.lights[1], Light::Sun { to_light, intensity, angular_size: 2.0 });
        parse("--sky 1/0.5,0.4,0.3/0").unwrap().light.set(&mut scene);
        let (top, horizon) = (Vec3::ONE, Vec3::new(0.5, 0.4, 0.3));
        assert_eq!(scene.sky, Sky::Gradient { top, horizon, ground: Vec3::ZERO });
    }

    #[test]
    fn no_options_are_the_defaults_of_the_library() {
        let square = Settings { width: 5, height: 5, ..Settings::default() };
        assert_eq!(parse("").unwrap().load_options(&square, false), LoadOptions::default());
    }

    #[test]
    fn options_of_files_need_a_file() {
        for line in [
            "--height a.png",
            "--wrap clamp",
            "--allow-outside",
            "--relief-depth 0.1",
            "--max-textures 3",
            "--crease-angle 0",
        ] {
            assert!(parse(line).err().unwrap().to_string().contains("SCENE"), "{line}");
            assert!(parse(&format!("a.obj {line}")).is_ok(), "{line}");
        }
        assert!(
            parse("a.obj --relief-depth 1.5").is_err()
                && parse("a.obj --relief-depth nan").is_err()
        );
    }
}
