"""The program and the package draw the same bytes."""

import os
import subprocess

import numpy as np
import pytest
from PIL import Image

import basrelief

PROGRAM = os.environ.get("BASRELIEF_PROGRAM")
pytestmark = pytest.mark.skipif(PROGRAM is None, reason="BASRELIEF_PROGRAM does not name the program")

FLOOR = "mtllib floor.mtl\nusemtl stones\nv -4 0 4\nv 4 0 4\nv 4 0 -4\nv -4 0 -4\n" \
    "vt 0 0\nvt 8 0\nvt 8 8\nvt 0 8\nf 1/1 2/2 3/3 4/4\n"


def run(*args, cwd):
    subprocess.run([PROGRAM, *map(str, args)], cwd=cwd, check=True, capture_output=True)


@pytest.fixture
def floor(tmp_path, cobbles):
    height, color = cobbles
    Image.fromarray(color).save(tmp_path / "color.png")
    Image.fromarray((height * 255).astype(np.uint8)).save(tmp_path / "height.png")
    (tmp_path / "floor.obj").write_text(FLOOR)
    (tmp_path / "floor.mtl").write_text("newmtl stones\nmap_Kd color.png\ndisp height.png\n")
    return tmp_path


@pytest.mark.parametrize("lens", [{}, {"fov": 35}, {"orthographic": 3.5}])
def test_pictures_and_layers_of_files(floor, lens):
    options = ["--eye", "1,2,5", "--target", "0,0,0", "-s", "120x80", "--relief-depth", "0.08"]
    options += [word for name, value in lens.items() for word in (f"--{name}", value)]
    run("floor.obj", *options, "--lighting", "lit", "-o", "picture.png", cwd=floor)
    run("floor.obj", *options, *("--layer", "depth=depth.npy", "--layer", "normal=normal.npy"),
        *("--layer", "object=object.npy"), cwd=floor)
    scene = basrelief.load(floor / "floor.obj", relief_depth=0.08, aspect=1.5)
    camera = scene.camera.replace(eye=(1, 2, 5), target=(0, 0, 0), **lens)
    frame = basrelief.Renderer(scene).render(camera, (120, 80), ["color", "depth", "normal", "object"])
    assert np.array_equal(np.asarray(Image.open(floor / "picture.png").convert("RGBA")), frame["color"])
    for name in ["depth", "normal", "object"]:
        assert np.load(floor / f"{name}.npy").tobytes() == frame[name].tobytes(), name


def test_arrays_are_what_files_are(floor):
    scene = basrelief.load(floor / "floor.obj")
    color, height = (np.asarray(Image.open(floor / f"{name}.png")) for name in ["color", "height"])
    material = basrelief.Material(albedo=color, height=height)
    points = np.array([[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], dtype=float)
    uv = [[0, 0], [8, 0], [8, 8], [0, 8]]
    mesh = basrelief.Mesh(points, [[0, 1, 2], [0, 2, 3]], uv=uv, material=material)
    made = basrelief.Scene([mesh], camera=scene.camera)
    for filter in ["horizon", "trilinear"]:
        frames = [
            basrelief.Renderer(s, filter=filter, lighting="unlit").render(size=(90, 60), layers="color")
            for s in [scene, made]
        ]
        assert np.array_equal(frames[0]["color"], frames[1]["color"])


def test_the_built_in_scene(tmp_path):
    run("-s", "96x54", "-o", "street.png", cwd=tmp_path)
    renderer = basrelief.Renderer(basrelief.builtin(), tone="neutral")
    picture = np.asarray(Image.open(tmp_path / "street.png").convert("RGBA"))
    assert np.array_equal(picture, renderer.render(size=(96, 54))["color"])
