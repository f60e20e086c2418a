//! Options that say what is drawn: files, camera, lights and background.

use super::choices::{self, one_of};
use super::settings::refusal;
use super::{Refusal, values};
use basrelief::scene::{self, HeightSense, LoadOptions, Loaded, NormalY};
use basrelief::texture::Wrap;
use basrelief::{Camera, Light, Scene};
use clap::Args;
use glam::Vec3;
use std::path::PathBuf;
use std::sync::LazyLock;

#[derive(Args)]
pub(crate) struct SceneOptions {
    /// OBJ file to draw, with its MTL files and images; without one, a built-in scene
    #[arg(value_name = "SCENE.obj")]
    obj: Option<PathBuf>,
    #[command(flatten)]
    maps: MapOptions,
    #[command(flatten)]
    limits: LimitOptions,
    #[command(flatten)]
    camera: CameraOptions,
    #[command(flatten)]
    lights: LightOptions,
}

#[derive(Args)]
#[command(next_help_heading = "Materials of SCENE.obj")]
struct MapOptions {
    /// Colour image for all materials, in place of their own
    #[arg(long, value_name = "FILE", requires = "obj")]
    albedo: Option<PathBuf>,
    /// Height image for all materials, in place of their own
    #[arg(long, value_name = "FILE", requires = "obj")]
    height: Option<PathBuf>,
    /// Normal map for all materials, in place of their own
    #[arg(long, value_name = "FILE", requires = "obj")]
    normal: Option<PathBuf>,
    /// Which end of the height images is high [default: white-high]
    #[arg(long, value_name = "END", value_parser = one_of(choices::HEIGHT_SENSES), requires = "obj")]
    height_sense: Option<HeightSense>,
    /// Depth of the relief in texture repeats, 0 to 1 [default: -bm of the MTL file, else 0.05]
    #[arg(long, value_name = "D", value_parser = values::unit, allow_hyphen_values = true, requires = "obj")]
    relief_depth: Option<f32>,
    /// Where the green of normal maps points [default: up]
    #[arg(long, value_name = "WAY", value_parser = one_of(choices::NORMAL_YS), requires = "obj")]
    normal_y: Option<NormalY>,
    /// What lies beyond a texture's edges [default: clamp where the MTL file says so, else repeat]
    #[arg(long, value_name = "HOW", value_parser = one_of(choices::WRAPS), requires = "obj")]
    wrap: Option<Wrap>,
    /// Let MTL files name images outside the folder of SCENE.obj
    #[arg(long, requires = "obj")]
    allow_outside: bool,
}

/// What a limit is where it is not given.
static DEFAULT: LazyLock<LoadOptions> = LazyLock::new(LoadOptions::default);

#[derive(Args)]
#[command(next_help_heading = "Limits for SCENE.obj, beyond which it is refused")]
struct LimitOptions {
    /// Most pixels of an image's side, 1 to 32768
    #[arg(long, value_name = "N", default_value_t = DEFAULT.max_image_side, requires = "obj",
          value_parser = clap::value_parser!(u32).range(1..=32768))]
    max_image_side: u32,
    /// Most memory of all images together in MiB while they are read, about 60 bytes a texel
    #[arg(long, value_name = "N", default_value_t = DEFAULT.max_image_mib, requires = "obj",
          value_parser = clap::value_parser!(u32).range(1..))]
    max_image_mib: u32,
    /// Most triangles, and most v, vt and vn lines each
    #[arg(long, value_name = "N", default_value_t = DEFAULT.max_triangles, requires = "obj")]
    max_triangles: u64,
    /// Most image files
    #[arg(long, value_name = "N", default_value_t = DEFAULT.max_textures, requires = "obj")]
    max_textures: u32,
}

#[derive(Args)]
#[command(next_help_heading = "Camera (what is not given frames the scene)")]
struct CameraOptions {
    /// Where the eye is, in the scene's units
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    eye: Option<Vec3>,
    /// The point in the middle of the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = values::vector, allow_hyphen_values = true)]
    target: Option<Vec3>,
    /// The direction that points upwards in the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = values::direction, allow_hyphen_values = true)]
    up: Option<Vec3>,
    /// Vertical field of view in degrees
    #[arg(long, value_name = "DEG", value_parser = values::field_of_view, allow_hyphen_values = true)]
    fov: Option<f32>,
    /// Distance from the eye before which nothing is drawn, in the scene's units
    #[arg(long, value_name = "D", value_parser = values::above_zero, allow_hyphen_values = true)]
    near: Option<f32>,
}

#[derive(Args)]
#[command(next_help_heading = "Light and background")]
struct LightOptions {
    /// Light from far away: the direction towards it, and its linear colour, 1,1,1 if not given; may be repeated; takes
    /// the place of the scene's own lights
    #[arg(long, value_name = "X,Y,Z[,R,G,B]", value_parser = values::sun, allow_hyphen_values = true)]
    sun: Vec<(Vec3, Vec3)>,
    /// Light from a point: its place, and its linear colour at a distance of 1; may be repeated
    #[arg(long, value_name = "X,Y,Z[,R,G,B]", value_parser = values::light, allow_hyphen_values = true)]
    point_light: Vec<(Vec3, Vec3)>,
    /// Light from everywhere, linear [default: the scene's own, 0.15 for SCENE.obj]
    #[arg(long, value_name = "R[,G,B]", value_parser = values::intensity, allow_hyphen_values = true)]
    ambient: Option<Vec3>,
    /// Colour where nothing is hit, sRGB: transparent, #rrggbb, R,G,B of 0 to 255 or a name such as skyblue
    /// [default: the scene's own, transparent for SCENE.obj]
    #[arg(long, value_name = "COLOUR", value_parser = values::color, allow_hyphen_values = true)]
    background: Option<[f32; 4]>,
}

impl SceneOptions {
    /// Whether a light is given.
    pub(crate) fn has_lights(&self) -> bool {
        let lights = &self.lights;
        !lights.sun.is_empty() || !lights.point_light.is_empty() || lights.ambient.is_some()
    }

    /// Reads or makes the scene and sets what the options say.
    pub(crate) fn load(&self, is_lit: bool) -> Result<Loaded, Refusal> {
        let mut loaded = match &self.obj {
            Some(obj) => scene::load(obj, &self.load_options(is_lit)).map_err(|e| refusal(&e))?,
            None => built_in(),
        };
        self.set(&mut loaded.scene);
        Ok(loaded)
    }

    /// Sets the camera, lights and background that are given.
    pub(crate) fn set(&self, scene: &mut Scene) {
        self.camera.place(&mut scene.camera);
        self.lights.set(scene);
    }

    fn load_options(&self, is_lit: bool) -> LoadOptions {
        let (maps, limits) = (&self.maps, &self.limits);
        LoadOptions {
            albedo: maps.albedo.clone(),
            height: maps.height.clone(),
            normal: maps.normal.clone(),
            height_sense: maps.height_sense.unwrap_or_default(),
            relief_depth: maps.relief_depth,
            normal_y: maps.normal_y.unwrap_or_default(),
            wrap: maps.wrap,
            keep_normals: is_lit,
            allow_outside: maps.allow_outside,
            max_image_side: limits.max_image_side,
            max_image_mib: limits.max_image_mib,
            max_triangles: limits.max_triangles,
            max_textures: limits.max_textures,
        }
    }
}

/// The scene that is drawn where no file is named.
fn built_in() -> Loaded {
    let choices = vec!["no SCENE.obj given: drawing the built-in scene".into()];
    Loaded { scene: scene::builtin(), choices, ..Loaded::default() }
}

impl CameraOptions {
    fn place(&self, camera: &mut Camera) {
        camera.eye = self.eye.unwrap_or(camera.eye);
        camera.target = self.target.unwrap_or(camera.target);
        camera.up = self.up.unwrap_or(camera.up);
        camera.fov_degrees = self.fov.unwrap_or(camera.fov_degrees);
        camera.near = self.near.unwrap_or(camera.near);
        let is_vertical = (camera.target - camera.eye).normalize_or_zero().cross(camera.up).length() < 1e-4;
        if is_vertical && self.up.is_none() {
            // Seen from straight above or below: what lies at the back is drawn at the top.
            camera.up = Vec3::NEG_Z;
        }
    }
}

impl LightOptions {
    /// Lights that are given take the place of the scene's own.
    fn set(&self, scene: &mut Scene) {
        let suns = self.sun.iter().map(|&(to_light, intensity)| Light::Directional { to_light, intensity });
        let points = self.point_light.iter().map(|&(position, intensity)| Light::Point { position, intensity });
        let given: Vec<Light> = suns.chain(points).collect();
        if !given.is_empty() {
            scene.lights = given;
        }
        scene.ambient = self.ambient.unwrap_or(scene.ambient);
        scene.background = self.background.unwrap_or(scene.background);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Only {
        #[command(flatten)]
        options: SceneOptions,
    }

    fn parse(line: &str) -> Result<SceneOptions, Refusal> {
        let only = Only::try_parse_from(std::iter::once("x").chain(line.split_whitespace()));
        only.map(|only| only.options).map_err(|e| e.to_string())
    }

    #[test]
    fn camera_keeps_what_is_not_given() {
        let mut camera = Camera::framing(Vec3::ZERO, Vec3::ONE);
        let framing = camera;
        parse("--eye -1,2,-3 --fov 30").unwrap().camera.place(&mut camera);
        assert_eq!(camera, Camera { eye: Vec3::new(-1.0, 2.0, -3.0), fov_degrees: 30.0, ..framing });
    }

    #[test]
    fn view_straight_down_needs_no_up() {
        let mut camera = Camera::default();
        parse("--eye 0,5,0").unwrap().camera.place(&mut camera);
        assert_eq!(camera.validate().ok(), Some(()));
    }

    #[test]
    fn lights_replace_the_scenes_own() {
        let own = Light::Point { position: Vec3::ONE, intensity: Vec3::ONE };
        let mut scene = Scene { lights: vec![own], ambient: Vec3::ONE, ..Scene::default() };
        parse("").unwrap().lights.set(&mut scene);
        assert!(scene.lights == [own] && scene.ambient == Vec3::ONE);
        let options = parse("--sun -1,2,3 --point-light 1,2,3,4,5,6 --sun 1,0,0 --ambient 0").unwrap();
        assert!(options.has_lights());
        options.lights.set(&mut scene);
        assert!(scene.lights.len() == 3 && scene.ambient == Vec3::ZERO);
    }

    #[test]
    fn no_options_are_the_defaults_of_the_library() {
        assert_eq!(parse("").unwrap().load_options(false), LoadOptions::default());
    }

    #[test]
    fn options_of_files_need_a_file() {
        for line in ["--height a.png", "--wrap clamp", "--allow-outside", "--relief-depth 0.1", "--max-textures 3"] {
            assert!(parse(line).err().unwrap().contains("SCENE.obj"), "{line}");
            assert!(parse(&format!("a.obj {line}")).is_ok(), "{line}");
        }
        assert!(parse("a.obj --relief-depth 1.5").is_err() && parse("a.obj --relief-depth nan").is_err());
    }
}
