"""Frames around a model: python turntable.py MODEL OUT [FRAMES]

Writes OUT as an animated GIF or PNG, by its ending. One scene, one renderer; only the camera moves.
"""

import sys

import basrelief
import numpy as np
from PIL import Image


def around(camera, num):
    """Cameras on a circle about what the first one looks at, at the same height."""
    target = np.array(camera.target)
    x, y, z = np.array(camera.eye) - target
    for turn in np.arange(num) * 2 * np.pi / num:
        cos, sin = np.cos(turn), np.sin(turn)
        yield camera.replace(eye=target + [cos * x + sin * z, y, cos * z - sin * x])


def main(model, out, num="24"):
    scene = basrelief.load(model)
    scene = scene.replace(background=(1, 1, 1, 1))
    renderer = basrelief.Renderer(scene, filter="trilinear", tone="neutral")
    cameras = list(around(scene.camera, int(num)))
    frames = renderer.render(cameras, size=(320, 240))["color"]
    first, *rest = [Image.fromarray(frame[..., :3]) for frame in frames]
    first.save(out, save_all=True, append_images=rest, duration=1000 * 4 // len(frames), loop=0)
    print(f"{out}: {len(frames)} frames")


if __name__ == "__main__":
    main(*sys.argv[1:])
