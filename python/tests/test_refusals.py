"""What is wrong is an exception that names it, and never a crash."""

import numpy as np
import pytest

import basrelief

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def mesh(**changed):
    given = {"vertices": TRIANGLE, "faces": [[0, 1, 2]], **changed}
    return basrelief.Mesh(**given)


@pytest.mark.parametrize(
    "changed, kind, words",
    [
        ({"vertices": [[0, 0], [1, 0]]}, ValueError, "vertices: must be of shape (N, 3)"),
        ({"vertices": [["a", "b", "c"]]}, TypeError, "vertices: must be an array of numbers"),
        ({"vertices": [[0, 0, 0], [1]]}, ValueError, "vertices:"),
        ({"vertices": None}, TypeError, "vertices:"),
        ({"vertices": np.zeros((3, 3), dtype=complex)}, TypeError, "vertices:"),
        ({"faces": [[0, 1, 3]]}, ValueError, "faces: 3 is not the index"),
        ({"faces": [[0, 1, -1]]}, ValueError, "faces: -1"),
        ({"faces": [[0, 1, 2.0]]}, TypeError, "faces: must be an array of whole numbers"),
        ({"faces": np.array([[0, 1, 2**63]], dtype=np.uint64)}, ValueError, "faces:"),
        ({"uv": [[0, 0]]}, ValueError, "uv: has 1 rows for 3 vertices"),
        ({"normals": [[0, 0, 1]] * 2}, ValueError, "normals: has 2 rows"),
        ({"material": "brick"}, TypeError, "material"),
    ],
)
def test_meshes(changed, kind, words):
    with pytest.raises(kind) as caught:
        mesh(**changed)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    "changed, kind, words",
    [
        ({"albedo": np.zeros((4, 4, 2), dtype=np.uint8)}, ValueError, "albedo: must be (H, W)"),
        ({"albedo": np.zeros((0, 4, 3), dtype=np.uint8)}, ValueError, "albedo: 4 x 0 texels"),
        ({"albedo": [[1, 2]]}, TypeError, "albedo: must be a NumPy array"),
        ({"albedo": np.zeros((4, 4), dtype=np.int64)}, TypeError, "albedo: must be a NumPy array of uint8"),
        ({"height": np.zeros((4, 4, 3), dtype=np.uint8)}, ValueError, "height: "),
        ({"height": np.zeros((4, 4)), "relief_depth": 2}, ValueError, "relief"),
        ({"height": np.zeros((4, 4)), "relief_depth": float("nan")}, ValueError, "relief"),
        ({"normal": np.zeros((4, 4))}, ValueError, "normal: "),
        ({"wrap": "round"}, ValueError, 'wrap: "round" is not one of "repeat"'),
        ({"base_color": (1, 2)}, ValueError, "base_color: must be of shape (3)"),
    ],
)
def test_materials(changed, kind, words):
    with pytest.raises(kind) as caught:
        basrelief.Material(**changed)
    assert words in str(caught.value)


def test_scenes():
    for bad in [np.nan, np.inf, 1e30]:
        with pytest.raises(ValueError, match="mesh 0"):
            basrelief.Scene([mesh(vertices=np.full((3, 3), bad))])
    with pytest.raises(ValueError, match="material 0 .*metallic"):
        basrelief.Scene([mesh(material=basrelief.Material(metallic=2))])
    with pytest.raises(TypeError, match="lights: must be Sun or PointLight"):
        basrelief.Scene([mesh()], lights=[1])
    with pytest.raises(ValueError, match="light 0"):
        basrelief.Scene([mesh()], lights=[basrelief.Sun((0, 0, 0))])
    with pytest.raises(TypeError, match="sky"):
        basrelief.Scene([mesh()], sky="blue")
    # Nothing at all is a scene.
    frame = basrelief.Renderer(basrelief.Scene([])).render(size=(8, 4))
    assert not frame["color"].any()


def test_cameras():
    with pytest.raises(ValueError, match="eye: must be of shape"):
        basrelief.Camera((0, 0), (0, 0, 1))
    with pytest.raises(ValueError, match="eye and target must differ"):
        basrelief.Camera((0, 0, 0), (0, 0, 0))
    with pytest.raises(ValueError, match="field of view"):
        basrelief.Camera((0, 0, 0), (0, 0, 1), fov=180)
    plan = basrelief.Camera((0, 0, 0), (0, 0, 1), orthographic=2)
    for bad in [0, -1, 1e-10, 1e10, float("nan"), float("inf")]:
        for make in [lambda: basrelief.Camera((0, 0, 0), (0, 0, 1), orthographic=bad),
                     lambda: plan.replace(orthographic=bad)]:
            with pytest.raises(ValueError, match="orthographic picture's height"):
                make()
    with pytest.raises(ValueError, match="orthographic: takes the place of fov"):
        basrelief.Camera((0, 0, 0), (0, 0, 1), fov=60, orthographic=2)
    with pytest.raises(TypeError):
        basrelief.Camera((0, 0, 0), (0, 0, 1), orthographic="high")
    with pytest.raises(ValueError, match="pose"):
        basrelief.Camera.from_intrinsics(1, 1, 1, 1, np.zeros((4, 4)))
    with pytest.raises(ValueError, match='convention: "gl" is not one of "opencv", "opengl"'):
        basrelief.Camera.from_intrinsics(1, 1, 1, 1, np.eye(4), "gl")


def test_files(tmp_path):
    with pytest.raises(FileNotFoundError, match="missing.obj"):
        basrelief.load(tmp_path / "missing.obj")
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv x\n")
    with pytest.raises(ValueError, match="bad.obj:2"):
        basrelief.load(tmp_path / "bad.obj")
    (tmp_path / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(TypeError, match="no option 'colour'"):
        basrelief.load(tmp_path / "one.obj", colour=1)
    with pytest.raises(ValueError, match="relief_depth"):
        basrelief.load(tmp_path / "one.obj", relief_depth=7)
    with pytest.raises(ValueError, match="material brick"):
        basrelief.load(tmp_path / "one.obj", materials={"brick": {"roughness": 0.5}})


def test_renderers(scene):
    for changed, words in [
        ({"filter": "best"}, 'filter: "best" is not one of'),
        ({"msaa": 3}, "msaa"),
        ({"threads": 0}, "threads: 0 is not within"),
        ({"tile_size": 7}, "tile_size"),
        ({"lighting": "dim"}, "lighting"),
        ({"exposure": float("nan")}, "exposure"),
    ]:
        with pytest.raises(ValueError, match=words):
            basrelief.Renderer(scene, **changed)
    with pytest.raises(TypeError, match="has no option 'lines'"):
        basrelief.Filter("truth", lines=4)
    with pytest.raises(ValueError, match="lines"):
        basrelief.Filter("horizon", lines=1)


def test_frames(scene):
    renderer = basrelief.Renderer(scene)
    with pytest.raises(ValueError, match='layers: "colour" is not one of color'):
        renderer.render(size=(8, 8), layers="colour")
    for size in [(0, 8), (8, 40000), (32768, 32768)]:
        with pytest.raises(ValueError, match="width|height"):
            renderer.render(size=size)
    for size in [8, (8,), (8.5, 8), (-1, 8), "ab"]:
        with pytest.raises(TypeError, match="size"):
            renderer.render(size=size)
    with pytest.raises(TypeError, match="camera"):
        renderer.render([1], (8, 8))
    with pytest.raises(ValueError, match="region"):
        renderer.render(size=(8, 8), region=(4, 4, 8, 8))
    good = np.empty((8, 8, 4), dtype=np.uint8)
    locked = good.copy()
    locked.flags.writeable = False
    for out, kind, words in [
        ({}, ValueError, 'has no array "color"'),
        ({"color": good[:4]}, ValueError, "must be of shape"),
        ({"color": good.astype(float)}, TypeError, "must be a NumPy array of uint8"),
        ({"color": np.asfortranarray(good)}, ValueError, "C-contiguous"),
        ({"color": locked}, ValueError, "color"),
        ({"color": [1]}, TypeError, "NumPy array"),
    ]:
        with pytest.raises(kind) as caught:
            renderer.render(size=(8, 8), out=out)
        assert words in str(caught.value)
    both = np.empty((8, 8), dtype=np.uint32)
    with pytest.raises(ValueError, match="out"):
        renderer.render(size=(8, 8), layers=["object", "triangle"], out={"object": both, "triangle": both})


def test_placing(scene):
    renderer = basrelief.Renderer(scene)
    for transforms, kind, words in [
        ({"cow": np.eye(4)}, KeyError, "no mesh"),
        ({7: np.eye(4)}, ValueError, "mesh: 7"),
        ({0.5: np.eye(4)}, TypeError, "mesh"),
        ({0: np.eye(3)}, ValueError, "transforms: must be of shape"),
        ({0: np.zeros((4, 4))}, ValueError, "transform"),
        ({0: np.diag([1, 1, -1, 1])}, ValueError, "mirror"),
        ({0: np.full((4, 4), np.nan)}, ValueError, "finite"),
        ({0: np.diag([1e30, 1e30, 1e30, 1])}, ValueError, "mesh 0"),
        ({0: np.eye(4), "floor": np.eye(4)}, ValueError, "twice"),
    ]:
        with pytest.raises(kind) as caught:
            renderer.place(transforms)
        assert words in str(caught.value)
    with pytest.raises(ValueError, match="vertices: has 1 rows for 4"):
        renderer.set_vertices("body", [[0, 0, 0]])


def test_surfaces():
    surface = basrelief.Surface(np.ones((4, 4, 3), dtype=np.float32))
    one = np.zeros((1, 2))
    for args, words in [
        ((one, one[0], one), "dx: is of"),
        ((one, one, np.zeros((1, 3))), "dy: must be of shape"),
        ((one, one, one, np.zeros((1, 3))), "view: "),
        ((one * np.nan, one, one), "uv: must be finite"),
    ]:
        with pytest.raises(ValueError, match=words):
            surface.colors(*args)
