//! Frames in memory of the caller's, and meshes that move, are what new frames and scenes are.

use basrelief::layers::{PixelsMut, Values, ValuesMut};
use basrelief::texture::{ColorImage, HeightImage, Surface, SurfaceMaps};
use basrelief::{
    Camera, Frame, Layer, Light, Lighting, Material, Mesh, Region, Renderer, Scene, Settings,
};
use glam::{Vec2, Vec3};
use rayon::ThreadPoolBuilder;

/// A floor of ridges with a tetrahedron over it that is moved by `offset`, in the sun.
fn scene(offset: Vec3) -> Scene {
    let ridge = |x: u32| if x % 16 < 8 { 1.0 } else { 0.2 };
    let maps = SurfaceMaps {
        albedo: Some(ColorImage::from_fn(64, 64, |x, _| [ridge(x); 3])),
        height: Some(HeightImage::from_fn(64, 64, |x, _| ridge(x))),
        relief_depth: 0.1,
        ..SurfaceMaps::default()
    };
    let surface = Some(Surface::new(maps).expect("valid maps").into());
    let corners = [(-4.0, 4.0), (4.0, 4.0), (4.0, -4.0), (-4.0, -4.0)];
    let floor = Mesh::new(
        corners.map(|(x, z)| Vec3::new(x, 0.0, z)).to_vec(),
        corners.map(|(x, z)| Vec2::new(x, -z)).to_vec(),
        vec![],
        vec![[0, 1, 2], [0, 2, 3]],
    );
    let points = [[0.0, 1.5, 0.0], [-1.0, 0.5, 1.0], [1.0, 0.5, 1.0], [0.0, 0.5, -1.0]];
    let points = points.map(|p| Vec3::from(p) + offset).to_vec();
    let faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    let body = Mesh { material: 1, ..Mesh::new(points, vec![], vec![], faces) };
    Scene {
        meshes: vec![floor, body],
        materials: vec![Material { surface, ..Material::default() }, Material::default()],
        camera: Camera { eye: Vec3::new(2.0, 2.0, 5.0), ..Camera::default() },
        lights: vec![Light::sun(Vec3::new(1.0, 2.0, 1.0), Vec3::ONE)],
        ..Scene::default()
    }
}

fn settings(lighting: Lighting) -> Settings {
    Settings { width: 90, height: 60, lighting, ..Settings::default() }
}

fn renderer(offset: Vec3, lighting: Lighting) -> Renderer {
    Renderer::new(scene(offset), settings(lighting)).expect("a valid scene")
}

fn pictures(renderer: &mut Renderer) -> (Frame, Vec<f32>) {
    let layers = renderer.render_layers(&[Layer::Normal]);
    (renderer.render(), layers.floats(Layer::Normal).to_vec())
}

#[test]
fn memory_of_the_callers_holds_the_same() {
    let mut renderer = renderer(Vec3::ZERO, Lighting::Lit);
    for region in [None, Some(Region { x: 11, y: 7, width: 40, height: 30 })] {
        renderer.set_region(region).expect("a region of the frame");
        let frame = renderer.render();
        let mut pixels = vec![[7.0; 4]; frame.pixels.len()];
        renderer.render_to(&mut pixels);
        assert_eq!(frame.pixels, pixels);
        let layers = renderer.render_layers(&[Layer::Normal, Layer::Object]);
        let (mut normals, mut objects) = (vec![7.0; pixels.len() * 3], vec![7; pixels.len()]);
        renderer.render_layers_to(vec![
            (Layer::Object, ValuesMut::Ids(&mut objects)),
            (Layer::Normal, ValuesMut::Floats(&mut normals)),
        ]);
        assert_eq!(
            (layers.floats(Layer::Normal), layers.ids(Layer::Object)),
            (&*normals, &*objects)
        );
    }
}

#[test]
fn frames_of_cameras_come_one_by_one() {
    let mut renderer = renderer(Vec3::ZERO, Lighting::Unlit);
    let camera = renderer.scene().camera;
    let cameras =
        [2.0, 0.0, -1.0, f32::NAN].map(|x| Camera { eye: Vec3::new(x, 2.0, 5.0), ..camera });
    let mut asked = 0;
    let counted = cameras.iter().inspect(|_| asked += 1).copied();
    let first = renderer.frames::<[u8; 4]>(counted).next();
    assert!(matches!(first, Some(Ok(_))) && asked == 1);
    let frames: Vec<_> = renderer.frames(cameras).collect();
    assert_eq!(frames.iter().map(Result::is_ok).collect::<Vec<_>>(), [true, true, true, false]);
    for (camera, frame) in cameras.into_iter().zip(frames).take(3) {
        renderer.set_camera(camera).expect("a valid camera");
        assert!(renderer.render() == frame.expect("a frame"));
    }
}

#[test]
fn pictures_and_layers_together_are_those_of_each_alone() {
    let one = ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let layers = Layer::ALL;
    for (msaa, lighting) in [(1, Lighting::Lit), (1, Lighting::Unlit), (4, Lighting::Unlit)] {
        let settings = Settings { msaa, tile_size: 16, ..settings(lighting) };
        let mut renderer = Renderer::new(scene(Vec3::ZERO), settings).expect("a valid scene");
        for region in [None, Some(Region { x: 11, y: 7, width: 40, height: 30 })] {
            renderer.set_region(region).expect("a region of the frame");
            let frame = renderer.render();
            let alone = renderer.render_layers(&layers);
            for pool in [Some(&one), None] {
                let mut pixels = vec![[7.0; 4]; frame.pixels.len()];
                let mut found = alone.clone();
                let values = found.all.iter_mut().map(|(layer, values)| match values {
                    Values::Floats(values) => {
                        values.fill(7.0);
                        (*layer, ValuesMut::Floats(values))
                    }
                    Values::Ids(values) => {
                        values.fill(7);
                        (*layer, ValuesMut::Ids(values))
                    }
                });
                let (values, to) = (values.collect(), PixelsMut::Linear(&mut pixels));
                let draw = || renderer.render_with_layers_to(to, values);
                match pool {
                    Some(pool) => pool.install(draw),
                    None => draw(),
                }
                assert!(pixels == frame.pixels && found == alone, "{msaa} {lighting:?}");
            }
        }
    }
}

#[test]
#[should_panic(expected = "numbers of normal")]
fn memory_of_a_wrong_size_is_refused() {
    let mut normals = vec![0.0; 90 * 60];
    let layers = vec![(Layer::Normal, ValuesMut::Floats(&mut normals))];
    renderer(Vec3::ZERO, Lighting::Unlit).render_layers_to(layers);
}

#[test]
fn meshes_that_moved_are_drawn_where_they_are() {
    // Sums without rounding: the same vertices to the bit.
    let offset = Vec3::new(0.25, 0.5, -0.75);
    let [x, y, z] = offset.to_array();
    let matrix = [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]];
    for lighting in [Lighting::Unlit, Lighting::Lit] {
        let mut moving = renderer(Vec3::ZERO, lighting);
        let first = pictures(&mut moving);
        let mut body = Mesh::default();
        moving.scene().meshes[1].place(&matrix, &mut body).expect("a matrix that moves");
        let mut changes = [(1, body)];
        moving.exchange_meshes(&mut changes).expect("a valid mesh");
        let there = pictures(&mut moving);
        assert!(there == pictures(&mut renderer(offset, lighting)) && there != first);
        moving.exchange_meshes(&mut changes).expect("the mesh of before");
        assert!(pictures(&mut moving) == first);
    }
}

#[test]
fn what_cannot_be_exchanged_leaves_all_as_it_was() {
    let mut renderer = renderer(Vec3::ZERO, Lighting::Lit);
    let first = pictures(&mut renderer);
    let body = renderer.scene().meshes[1].clone();
    let mut bad = body.clone();
    bad.positions[0].x = f32::NAN;
    assert!(renderer.exchange_meshes(&mut [(0, body.clone()), (1, bad)]).is_err());
    assert!(renderer.exchange_meshes(&mut [(2, body.clone())]).is_err());
    assert!(pictures(&mut renderer) == first);
    let mut mirrored = Mesh::default();
    let mut matrix = [[0.0; 4]; 4];
    (0..4).for_each(|i| matrix[i][i] = if i == 2 { -1.0 } else { 1.0 });
    assert!(body.place(&matrix, &mut mirrored).is_err());
}
