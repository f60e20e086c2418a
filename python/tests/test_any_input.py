"""Arrays of any shape, type and value are drawn or refused: never a crash, never a panic.

`python tests/test_any_input.py SECONDS` goes on for longer.
"""

import sys
import time

import numpy as np

import basrelief

TYPES = ["u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f2", "f4", "f8", "c8", "?", "U3", "O", "M8[s]"]
REFUSALS = (ValueError, TypeError, KeyError, MemoryError, OverflowError)


def number(random):
    special = [0, 1, -1, 0.5, 1e-30, 1e18, -1e18, 3e38, np.nan, np.inf, -np.inf, 1e-45, 1e6, 255]
    return float(random.choice(special)) if random.random() < 0.03 else float(random.normal())


def light(random):
    array = any_array(random, (4, 8, 3))
    return np.abs(array) if array.dtype.kind == "f" else array


def matrix(random):
    array = any_array(random, (4, 4))
    if random.random() < 0.7 and array.shape == (4, 4) and array.dtype.kind == "f":
        array = array * np.float32(0.3) + np.eye(4, dtype=array.dtype)
        array[3] = [0, 0, 0, 1]
    return array


def unit(random):
    return abs(number(random)) if random.random() < 0.05 else float(random.random())


def depth(random):
    return unit(random) * 0.2


def any_array(random, shape):
    """An array that is mostly of the shape asked for, of any type, values and strides."""
    if random.random() < 0.02:
        shape = tuple(int(n) for n in random.integers(0, 5, random.integers(0, 5)))
    kind = "f4" if random.random() < 0.93 else str(random.choice(TYPES))
    values = np.array([number(random) for _ in range(int(np.prod(shape)))], dtype=object)
    with np.errstate(all="ignore"):
        try:
            array = values.reshape(shape).astype(float).astype(kind)
        except (ValueError, TypeError, OverflowError):
            array = np.zeros(shape, dtype=kind)
    if array.ndim and random.random() < 0.2:
        array = array[::-1]
    return np.asfortranarray(array) if random.random() < 0.2 else array


def maybe(random, make):
    return make() if random.random() < 0.4 else None


def any_image(random, channels=None):
    size = tuple(int(n) for n in random.integers(1, 9, 2))
    channels = channels if channels is not None else [(), (3,), (4,)][random.integers(0, 3)]
    array = any_array(random, (*size, *channels))
    if random.random() < 0.5 and array.dtype.kind == "f":
        with np.errstate(all="ignore"):
            return (array * 99).astype("u1")
    return array


def any_mesh(random):
    num = int(random.integers(0, 8))
    faces = random.integers(0, max(num, 1), (int(random.integers(0, 6)), 3))
    material = maybe(random, lambda: basrelief.Material(
        albedo=maybe(random, lambda: any_image(random)),
        height=maybe(random, lambda: any_image(random, ())),
        normal=maybe(random, lambda: any_image(random, (3,))),
        occlusion_map=maybe(random, lambda: any_image(random, ())),
        relief_depth=depth(random),
        metallic=unit(random),
        base_color=maybe(random, lambda: any_array(random, (3,))),
    ))
    return basrelief.Mesh(
        any_array(random, (num, 3)),
        any_array(random, (2, 3)) if random.random() < 0.1 else faces,
        uv=maybe(random, lambda: any_array(random, (num, 2))),
        normals=maybe(random, lambda: any_array(random, (num, 3))),
        material=material,
    )


def draw(random):
    """Makes a scene of anything and draws it."""
    meshes = [any_mesh(random) for _ in range(random.integers(0, 3))]
    lights = [basrelief.Sun(any_array(random, (3,)), size=unit(random) * 10)] if random.random() < 0.5 else []
    if random.random() < 0.3:
        lights.append(basrelief.PointLight(any_array(random, (3,)), number(random)))
    sky = maybe(random, lambda: basrelief.Environment(light(random)))
    scene = basrelief.Scene(meshes, lights, sky)
    lens = {"orthographic": unit(random) * 9} if random.random() < 0.4 else {"fov": unit(random) * 150}
    camera = maybe(random, lambda: basrelief.Camera(
        any_array(random, (3,)), any_array(random, (3,)), near=abs(number(random)), **lens))
    name = str(random.choice(basrelief.FILTERS))
    options = {"samples": 2} if name in ("truth", "parallax") else {"far_field": False} if name == "horizon" else {}
    renderer = basrelief.Renderer(scene, filter=basrelief.Filter(name, **options), threads=1)
    size = tuple(int(n) for n in random.integers(1, 40, 2))
    layers = [str(name) for name in random.choice(basrelief.LAYERS, 3)]
    frame = renderer.render(camera, size, layers)
    assert all(array.shape[:2] == size[::-1] for array in frame.values())
    out = frame if random.random() < 0.5 else {name: any_array(random, frame[name].shape) for name in frame}
    if meshes:
        renderer.place({0: matrix(random)})
        renderer.render(camera, size, layers)
    renderer.render(camera, size, layers, out=out)


def filter_alone(random):
    surface = basrelief.Surface(any_image(random), maybe(random, lambda: any_image(random, ())), depth(random))
    places = [any_array(random, (5, 2)) for _ in range(3)]
    view = maybe(random, lambda: any_array(random, (5, 3)))
    name = str(random.choice(basrelief.FILTERS))
    options = {"samples": 2} if name in ("truth", "parallax") else {"far_field": False} if name == "horizon" else {}
    colors = surface.colors(*places, view, filter=basrelief.Filter(name, **options), threads=1)
    assert colors.shape[-1] == 3


def go_on(seconds, seed=0):
    """How often something was drawn, and how often refused."""
    drawn = refused = 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        random = np.random.default_rng(seed)
        try:
            (draw if seed % 3 else filter_alone)(random)
            drawn += 1
        except REFUSALS:
            refused += 1
        except BaseException:
            print(f"seed {seed}", file=sys.stderr)
            raise
        seed += 1
    return drawn, refused


def test_any_arrays():
    drawn, refused = go_on(8)
    assert drawn > 10 and refused > 10


if __name__ == "__main__":
    print("drawn and refused:", *go_on(float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0))
