//! Cameras by intrinsics and pose: where the rays of pixels go.

mod common;

use basrelief::invariants::layers_agree;
use basrelief::texture::Wrap;
use basrelief::{
    Camera, Filter, Intrinsics, Layer, Material, Mesh, PoseAxes, Renderer, Scene, Settings,
};
use common::{floor_scene, rough_surface};
use glam::Vec3;

const SIZE: [u32; 2] = [75, 53];

fn settings() -> Settings {
    Settings { width: SIZE[0], height: SIZE[1], filter: Filter::Nearest, ..Settings::default() }
}

/// The centre of pixel `(x, y)` is at `(x + 0.5, y + 0.5)`: a quad of half a pixel around it is seen
/// there alone, and its place by the intrinsics is the layers'.
#[test]
fn a_quad_around_a_pixels_centre_is_that_pixel() {
    let intrinsics = Intrinsics { fx: 20.0, fy: 30.0, cx: 3.25, cy: 40.5 };
    let Intrinsics { fx, fy, cx, cy } = intrinsics;
    // Looking along x in the world, with the camera's right along -y there.
    let last = [0.0, 0.0, 0.0, 1.0];
    let cv = [[0.0, 0.0, 1.0, 5.0], [-1.0, 0.0, 0.0, 6.0], [0.0, -1.0, 0.0, 7.0], last];
    let [a, b, c, _] = cv.map(|[x, y, z, eye]| [x, -y, -z, eye]);
    let gl = [a, b, c, last];
    let place = |[x, y]: [f32; 2]| {
        let [x, y] = [(x - cx) / fx * 2.0, (y - cy) / fy * 2.0];
        Vec3::new(5.0 + 2.0, 6.0 - x, 7.0 - y)
    };
    let corners = [[-0.25, -0.25], [-0.25, 0.25], [0.25, 0.25], [0.25, -0.25]];
    for [x, y] in [[0, 0], [1, 0], [3, 2], [74, 52], [40, 17]] {
        let [u, v] = [x as f32 + 0.5, y as f32 + 0.5];
        let positions = corners.map(|[dx, dy]| place([u + dx, v + dy])).to_vec();
        for (pose, axes) in [(cv, PoseAxes::OpenCv), (gl, PoseAxes::OpenGl)] {
            let quad = vec![[0, 1, 2], [0, 2, 3]];
            let scene = Scene {
                meshes: vec![Mesh::new(positions.clone(), vec![], vec![], quad)],
                materials: vec![Material::default()],
                camera: Camera::from_pose(&pose, axes, intrinsics).expect("a pose"),
                ..Scene::default()
            };
            let mut renderer = Renderer::new(scene, settings()).expect("valid");
            let found = renderer.render_layers(&[Layer::Object, Layer::Position, Layer::Depth]);
            let objects = found.ids(Layer::Object);
            let seen: Vec<usize> = (0..objects.len()).filter(|&i| objects[i] == 0).collect();
            let pixel = (y * SIZE[0] + x) as usize;
            assert_eq!(seen, [pixel], "{x}, {y}");
            let at = Vec3::from_slice(&found.floats(Layer::Position)[3 * pixel..]);
            assert!(at.abs_diff_eq(place([u, v]), 1e-5), "{at} is not {}", place([u, v]));
            let depth = found.floats(Layer::Depth)[pixel];
            assert!((depth - 2.0).abs() < 1e-5, "{depth}");
        }
    }
}

/// Pixels that are not square, and an axis that is not in the middle or not in the frame at all.
#[test]
fn layers_agree_whatever_the_intrinsics() {
    for (fx, fy, cx, cy) in
        [(40.3, 55.1, 20.7, 31.2), (40.0, 40.0, -300.0, 26.5), (9.0, 90.0, 37.5, 65536.0)]
    {
        let mut scene = floor_scene(rough_surface(24, 16, Wrap::Repeat, 7), 0.5);
        scene.camera.intrinsics = Some(Intrinsics { fx, fy, cx, cy });
        layers_agree(scene, settings()).expect("agree");
    }
}

/// The intrinsics of a field of view draw the same bytes as that.
#[test]
fn a_field_of_view_has_its_intrinsics() {
    let scene = floor_scene(rough_surface(24, 16, Wrap::Repeat, 7), 0.5);
    let mut same = scene.clone();
    same.camera.intrinsics = Some(scene.camera.on_frame(SIZE[0], SIZE[1]));
    same.camera.fov_degrees = 17.0;
    let frames = [scene, same].map(|scene| basrelief::render(scene, settings()).expect("valid"));
    assert!(frames[0] == frames[1]);
}

#[test]
fn what_is_no_pose_is_refused() {
    let lens = Intrinsics { fx: 9.0, fy: 9.0, cx: 5.0, cy: 5.0 };
    let pose: [[f32; 4]; 4] = std::array::from_fn(|i| std::array::from_fn(|j| f32::from(i == j)));
    let made = |pose: &_, lens| Camera::from_pose(pose, PoseAxes::OpenCv, lens);
    assert!(made(&pose, lens).is_ok());
    let changes = [(0, 0, -1.0), (0, 0, 2.0), (1, 0, 0.5), (3, 3, 2.0), (2, 3, f32::NAN)];
    for (row, column, value) in changes {
        let mut bad = pose;
        bad[row][column] = value;
        assert!(made(&bad, lens).is_err(), "{bad:?}");
    }
    let (flat, far) = (Intrinsics { fx: 0.0, ..lens }, Intrinsics { cx: 1e6, ..lens });
    for bad in [flat, far, Intrinsics { cy: f32::NAN, ..lens }] {
        assert!(made(&pose, bad).is_err(), "{bad:?}");
    }
}
