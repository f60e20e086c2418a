"""What goes to another process is there what it was here."""

import copy
import multiprocessing
import pickle

import numpy as np
import pytest
from conftest import LAYERS, same

import basrelief


def drawn(scene):
    return basrelief.Renderer(scene, threads=1).render(size=(64, 48), layers=LAYERS)


def send(thing):
    return pickle.loads(pickle.dumps(thing))


def of_arrays(cobbles):
    """A scene with all that arrays can say."""
    height, color = cobbles
    random = np.random.default_rng(0)
    stones = basrelief.Material(
        name="stones",
        base_color=(0.9, 0.8, 0.7),
        metallic=0.3,
        specular=0.6,
        roughness=0.4,
        emissive=0.05,
        albedo=color[::2],
        height=height.T,
        relief_depth=0.07,
        normal=random.integers(90, 160, (8, 8, 3), dtype=np.uint8),
        normal_y="down",
        metallic_map=random.random((4, 4), dtype=np.float32),
        roughness_map=color[..., 0],
        occlusion_map=height,
        emissive_map=random.random((5, 3, 3)),
        wrap="mirror",
    )
    corners = np.array([[-4, 0, 4], [4, 0, 4], [4, 0.5, -4], [-4, 0, -4]])
    faces, uv = [[0, 1, 2], [0, 2, 3]], corners[:, [0, 2]]
    floor = basrelief.Mesh(corners, faces, uv, None, stones, "floor", random.random((4, 3)))
    twin = basrelief.Mesh(corners + [0, 1, -5], faces, uv=uv, material=stones)
    bare = basrelief.Mesh(corners * 0.2 + [0, 1, 0], faces, name="bare")
    lights = [basrelief.Sun((1, 2, 0.1), color=(0.3, 0.2, 0.1), size=3), basrelief.PointLight((0, 1, 1), 0.7)]
    sky = basrelief.Environment(random.random((4, 8, 3)), turn=33.3)
    return basrelief.Scene([floor, twin, bare], lights, sky, (0.1, 0.2, 0.3, 0.4))


def test_scenes_of_arrays(cobbles):
    scene = of_arrays(cobbles)
    wanted = drawn(scene)
    assert len(np.unique(wanted["color"])) > 50
    for other in [send(scene), copy.deepcopy(scene), send(send(scene))]:
        assert same(drawn(other), wanted)
        assert (other.objects, other.materials, other.camera) == (scene.objects, scene.materials, scene.camera)
    gradient = scene.replace(sky=basrelief.Sky(0.1, (0.2, 0.3, 0.4), 0.5), camera=scene.camera.replace(fov=70))
    assert same(drawn(send(gradient)), drawn(gradient)) and not same(drawn(gradient), wanted)


def test_arrays_that_change_afterwards_change_nothing(cobbles):
    height, color = (array.copy() for array in cobbles)
    corners = np.array([[-4, 0, 4], [4, 0, 4], [0, 0, -4]], dtype=np.float32)
    material = basrelief.Material(albedo=color, height=height)
    scene = basrelief.Scene([basrelief.Mesh(corners, [[0, 1, 2]], uv=corners[:, :2], material=material)])
    wanted = drawn(scene)
    for array in [height, color, corners]:
        array[:] = 0
    assert same(drawn(send(scene)), wanted)


def test_scenes_of_files_are_read_again(tmp_path, monkeypatch, cobbles):
    Image = pytest.importorskip("PIL.Image")
    Image.fromarray(cobbles[1]).save(tmp_path / "color.png")
    lines = ["v -4 0 4", "v 4 0 4", "v 0 0 -4", "vt 0 0", "vt 4 0", "vt 2 4", "mtllib floor.mtl", "usemtl m", "f 1/1 2/2 3/3"]
    (tmp_path / "floor.mtl").write_text("newmtl m\n")
    (tmp_path / "floor.obj").write_text("\n".join(lines))
    monkeypatch.chdir(tmp_path)
    scene = basrelief.load("floor.obj", albedo="color.png", materials={"m": {"base_color": np.array([1, 0.5, 0.2])}})
    scene = scene.replace(lights=[basrelief.Sun((0, 1, 0))])
    wanted, sent = drawn(scene), pickle.dumps(scene)
    # A worker may be started in any folder.
    monkeypatch.chdir("/")
    assert same(drawn(pickle.loads(sent)), wanted)
    (tmp_path / "floor.obj").unlink()
    with pytest.raises(FileNotFoundError):
        pickle.loads(sent)


def test_the_built_in_scene():
    scene = basrelief.builtin().replace(background=(1, 0, 0, 1))
    other = send(scene)
    assert (repr(other), other.camera) == (repr(scene), scene.camera)


@pytest.mark.parametrize("name", basrelief.FILTERS)
def test_filters(name):
    assert send(basrelief.Filter(name)) == basrelief.Filter(name)


def test_options_of_filters():
    for name, options in [
        ("horizon", {"lines": 5, "far_field": False}),
        ("visible", {"visible": "two-ended", "formulas": "printed", "max_stretch": 1.7}),
        ("ewa", {"every_texel": True, "cut": 1.25}),
    ]:
        filter = basrelief.Filter(name, **options)
        assert send(filter) == filter != basrelief.Filter(name)


def test_a_spawned_process_draws_what_it_is_sent(scene):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert same(pool.apply_async(drawn, (scene,)).get(timeout=120), drawn(scene))


def test_renderers_stay():
    renderer = basrelief.Renderer(basrelief.Scene([]))
    with pytest.raises(TypeError, match="pickle"):
        pickle.dumps(renderer)
