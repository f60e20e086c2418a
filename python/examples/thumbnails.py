"""Thumbnails of all models in a folder: python thumbnails.py FOLDER OUT

One PNG each, lit, on a transparent ground. A model that cannot be read is named and left out.
"""

import sys
from pathlib import Path

import basrelief
from PIL import Image

SIZE = (256, 256)
ENDINGS = {".obj", ".glb", ".gltf"}


def thumbnail(path):
    scene = basrelief.load(path)
    renderer = basrelief.Renderer(scene, filter="trilinear", tone="neutral")
    return Image.fromarray(renderer.render(size=SIZE)["color"])


def main(folder, out):
    Path(out).mkdir(parents=True, exist_ok=True)
    for path in sorted(p for p in Path(folder).rglob("*") if p.suffix.lower() in ENDINGS):
        target = Path(out) / f"{path.stem}.png"
        try:
            thumbnail(path).save(target)
            print(target)
        except (OSError, ValueError) as error:
            print(f"left out: {error}", file=sys.stderr)


if __name__ == "__main__":
    main(*sys.argv[1:3])
