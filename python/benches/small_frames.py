"""What a small frame takes: python small_frames.py MODEL TEXTURE [FRAMES]

A thousand cameras around a model in one batch, 256x256, one thread: color, depth and object, beside
`cargo run --release --example many_frames -- FRAMES MODEL TEXTURE`, which does the same in Rust.
Prints the fastest of five rounds.
"""

import sys
import time

import basrelief
import numpy as np

SIZE = (256, 256)
LAYERS = ["color", "depth", "object"]


def around(camera, num):
    target = np.array(camera.target)
    x, y, z = np.array(camera.eye) - target
    for turn in np.arange(num) * 2 * np.pi / num:
        cos, sin = np.cos(turn), np.sin(turn)
        yield camera.replace(eye=target + [cos * x + sin * z, y, cos * z - sin * x])


def fastest(draw, num, rounds=5):
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        draw()
        times.append((time.perf_counter() - start) * 1000 / num)
    return min(times)


def main(model, texture, num="1000"):
    scene = basrelief.load(model, albedo=texture)
    cameras = list(around(scene.camera, int(num)))
    for lighting in ["unlit", "lit"]:
        renderer = basrelief.Renderer(scene, filter="trilinear", msaa=1, lighting=lighting, threads=1)
        out = renderer.render(cameras, SIZE, LAYERS)
        into = fastest(lambda: renderer.render(cameras, SIZE, LAYERS, out=out), len(cameras))
        new = fastest(lambda: renderer.render(cameras, SIZE, LAYERS), len(cameras))
        single = fastest(lambda: [renderer.render(c, SIZE, LAYERS) for c in cameras], len(cameras))
        print(
            f"{lighting}: {into:.3f} ms a frame into arrays of a batch before, {new:.3f} into new ones,"
            f" {single:.3f} frame by frame (SIMD {basrelief.SIMD_LEVEL})"
        )


if __name__ == "__main__":
    main(*sys.argv[1:])
