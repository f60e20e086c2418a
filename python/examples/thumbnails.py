"""Thumbnails of all models in a folder and the folders in it: python thumbnails.py FOLDER OUT

One PNG each, lit, on a transparent ground, in folders as the models'. A model that cannot be read is
named and left out; what of a model is not supported is named and left out of its picture.
"""

import sys
from pathlib import Path

import basrelief
import numpy as np
from PIL import Image

SIZE = (256, 256)
ENDINGS = {".obj", ".glb", ".gltf"}
# Degrees about up, from the front: two sides of things are seen, and their top.
TURN = 35


def turned(camera):
    """A camera that has gone around what it looks at."""
    target = np.array(camera.target)
    x, y, z = np.array(camera.eye) - target
    cos, sin = np.cos(np.radians(TURN)), np.sin(np.radians(TURN))
    # A little higher and farther, since a box is longer across than along its sides.
    eye = 1.15 * np.array([cos * x + sin * z, y + 0.25 * np.hypot(x, z), cos * z - sin * x])
    return camera.replace(eye=target + eye)


def thumbnail(scene):
    renderer = basrelief.Renderer(scene, filter="trilinear", tone="neutral")
    return Image.fromarray(renderer.render(turned(scene.camera), SIZE)["color"])


def main(folder, out):
    paths = sorted(p for p in Path(folder).rglob("*") if p.suffix.lower() in ENDINGS)
    for path in paths:
        # The whole name: a folder may have a model in several formats.
        target = Path(out) / path.relative_to(folder).parent / f"{path.name}.png"
        try:
            scene = basrelief.load(path)
        except (OSError, ValueError) as error:
            print(f"left out: {error}", file=sys.stderr)
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        thumbnail(scene).save(target)
        print(target, *scene.warnings, sep="\n    ")


if __name__ == "__main__":
    main(*sys.argv[1:3])
