"""A data set of pictures with depth and ids: python data_set.py OUT [FRAMES]

Boxes lie about on a floor and move from frame to frame. Each frame is a .npz with the picture, the
distance along the view, normals, the number of the object that a pixel sees, the camera and where
the boxes are. The same seed gives the same files, on any machine and with any number of threads.
"""

import sys
from pathlib import Path

import basrelief
import numpy as np

SIZE = (160, 120)
INTRINSICS = (140.0, 140.0, 80.0, 60.0)
NUM_BOXES = 4
LAYERS = ["color", "depth", "normal", "object"]


def box(name, color):
    """A cube of side 1 that stands on the ground, each side with vertices of its own."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (0, 1) for z in (-0.5, 0.5)])
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [[4 * i, 4 * i + j, 4 * i + j + 1] for i in range(6) for j in (1, 2)]
    material = basrelief.Material(name=name, base_color=color)
    return basrelief.Mesh(corners[sides].reshape(-1, 3), faces, material=material, name=name)


def scene(random):
    noise = random.integers(90, 200, (64, 64), dtype=np.uint8)
    ground = basrelief.Material(name="ground", albedo=noise)
    corners = np.array([[-6, 0, 6], [6, 0, 6], [6, 0, -6], [-6, 0, -6]])
    faces = [[0, 1, 2], [0, 2, 3]]
    floor = basrelief.Mesh(corners, faces, uv=corners[:, [0, 2]], material=ground, name="floor")
    boxes = [box(f"box-{i}", random.uniform(0.1, 0.9, 3)) for i in range(NUM_BOXES)]
    sun, sky = basrelief.Sun((1, 2, 0.5), color=0.8), basrelief.Sky((0.3, 0.35, 0.4))
    return basrelief.Scene([floor, *boxes], lights=[sun], sky=sky)


def placed(random):
    """A turn about up, and a place on the floor."""
    turn, (x, z) = random.uniform(0, 2 * np.pi), random.uniform(-2, 2, 2)
    cos, sin = np.cos(turn), np.sin(turn)
    return np.array([[cos, 0, sin, x], [0, 1, 0, 0], [-sin, 0, cos, z], [0, 0, 0, 1]])


def pose(random):
    """A camera above the floor that looks at its middle, in OpenCV's axes."""
    turn, height = random.uniform(0, 2 * np.pi), random.uniform(2, 4)
    eye = np.array([5 * np.sin(turn), height, 5 * np.cos(turn)])
    forward = -eye / np.linalg.norm(eye)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.stack([right, np.cross(forward, right), forward, eye], axis=1)
    return matrix


def frame(renderer, seed):
    """All of frame `seed`, which does not hang on the others."""
    random = np.random.default_rng(seed)
    places = {f"box-{i}": placed(random) for i in range(NUM_BOXES)}
    camera = pose(random)
    renderer.place(places)
    found = renderer.render(basrelief.Camera.from_intrinsics(*INTRINSICS, camera), SIZE, LAYERS)
    return {**found, "pose": camera, "places": np.stack(list(places.values()))}


def main(out, num="4"):
    Path(out).mkdir(parents=True, exist_ok=True)
    renderer = basrelief.Renderer(scene(np.random.default_rng(0)), filter="trilinear")
    for i in range(int(num)):
        numbers = frame(renderer, i)
        np.savez_compressed(Path(out) / f"{i:06}.npz", **numbers)
        seen = numbers["object"] != basrelief.NOTHING
        print(f"{i:06}.npz: {seen.mean():.0%} seen, nearest {numbers['depth'].min():.2f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
