"""Pictures of meshes and relief on processors alone: NumPy arrays in and out.

    import basrelief

    scene = basrelief.load("model.obj")
    renderer = basrelief.Renderer(scene)
    frame = renderer.render(scene.camera, size=(640, 480), layers=["color", "depth", "object"])
    frame["color"]    # uint8 (480, 640, 4), sRGB
    frame["depth"]    # float32 (480, 640), along the view, infinity where nothing is seen

Pictures are the same, byte for byte, for any number of threads and on any machine. No driver, no
display. What each class takes says its help, such as help(basrelief.Material).
"""

from . import _builds

_native = _builds.load()

from basrelief._native import (  # noqa: E402 (the line above picks the build)
    FILTERS,
    LAYERS,
    SIMD_LEVEL,
    Camera,
    Environment,
    Filter,
    Frames,
    Material,
    Mesh,
    PointLight,
    Renderer,
    Scene,
    Sky,
    Sun,
    Surface,
    __version__,
    builtin,
    load,
)

NOTHING = 0xFFFF_FFFF
"""What the layers "object", "material" and "triangle" hold where nothing is seen."""

__all__ = [
    "FILTERS",
    "LAYERS",
    "NOTHING",
    "SIMD_LEVEL",
    "Camera",
    "Environment",
    "Filter",
    "Frames",
    "Material",
    "Mesh",
    "PointLight",
    "Renderer",
    "Scene",
    "Sky",
    "Sun",
    "Surface",
    "__version__",
    "builtin",
    "load",
]
