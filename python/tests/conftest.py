"""Scenes that tests draw: small, made of arrays."""

import numpy as np
import pytest

import basrelief


def stones():
    """Heights and colours of round stones, (64, 64) and (64, 64, 3)."""
    y, x = np.mgrid[0:64, 0:64] / 16.0
    height = np.clip(1.2 - ((x % 1 - 0.5) ** 2 + (y % 1 - 0.5) ** 2) * 6, 0, 1)
    shade = 40 + 200 * height
    color = np.stack([shade, shade * 0.8, shade * 0.6], axis=-1)
    return height.astype(np.float32), color.astype(np.uint8)


def floor_and_body(offset=(0.0, 0.0, 0.0)):
    """A floor of stones with a tetrahedron over it, in the sun."""
    height, color = stones()
    rough = basrelief.Material(name="stones", albedo=color, height=height, relief_depth=0.1)
    red = basrelief.Material(name="red", base_color=(0.8, 0.1, 0.1))
    corners = np.array([[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], dtype=np.float32)
    floor = basrelief.Mesh(
        corners, [[0, 1, 2], [0, 2, 3]], uv=corners[:, [0, 2]] * [1, -1], material=rough, name="floor"
    )
    points = np.array([[0, 1.5, 0], [-1, 0.5, 1], [1, 0.5, 1], [0, 0.5, -1]], dtype=np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    body = basrelief.Mesh(points + np.float32(offset), faces, material=red, name="body")
    return basrelief.Scene(
        [floor, body],
        lights=[basrelief.Sun((1, 2, 1))],
        sky=basrelief.Sky(0.2),
        camera=basrelief.Camera((2, 2, 5), (0, 0.5, 0), fov=50),
    )


@pytest.fixture(scope="session")
def cobbles():
    return stones()


@pytest.fixture(scope="session")
def make_scene():
    return floor_and_body


@pytest.fixture(scope="session")
def scene():
    return floor_and_body()


@pytest.fixture(scope="session")
def cameras():
    turns = np.linspace(0, 2 * np.pi, 5, endpoint=False)
    return [basrelief.Camera((5 * np.sin(t), 2, 5 * np.cos(t)), (0, 0.5, 0)) for t in turns]


LAYERS = ["color", "depth", "normal", "object"]


def same(a, b):
    """Whether two frames are the same, bit by bit."""
    return a.keys() == b.keys() and all(
        a[name].dtype == b[name].dtype
        and a[name].shape == b[name].shape
        and a[name].tobytes() == b[name].tobytes()
        for name in a
    )
