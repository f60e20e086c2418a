"""Types of basrelief. Shapes, dtypes and units stand in the docstrings: help(basrelief.Renderer)."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Literal, Union, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
SIMD_LEVEL: str
FILTERS: list[str]
LAYERS: list[str]
NOTHING: int

_Vector = Union[Sequence[float], NDArray[Any]]
_Color = Union[float, _Vector]
_Array = NDArray[Any]
_Wrap = Literal["repeat", "mirror", "clamp"]
_NormalY = Literal["up", "down"]
_FilterName = Literal[
    "horizon", "nearest", "bilinear", "trilinear", "ewa", "visible", "parallax", "truth"
]
_Size = tuple[int, int]

@final
class Camera:
    def __init__(
        self,
        eye: _Vector,
        target: _Vector,
        up: _Vector | None = None,
        fov: float | None = None,
        near: float = 0.01,
        *,
        orthographic: float | None = None,
    ) -> None: ...
    @staticmethod
    def from_intrinsics(
        fx: float,
        fy: float,
        cx: float,
        cy: float,
        pose: ArrayLike,
        convention: Literal["opencv", "opengl"] = "opencv",
        *,
        first_pixel: float = 0.5,
        near: float = 0.01,
    ) -> Camera: ...
    @staticmethod
    def framing(least: _Vector, most: _Vector, aspect: float = 1.0) -> Camera: ...
    def replace(
        self,
        *,
        eye: _Vector | None = None,
        target: _Vector | None = None,
        up: _Vector | None = None,
        fov: float | None = None,
        near: float | None = None,
        orthographic: float | None = None,
    ) -> Camera: ...
    @property
    def eye(self) -> tuple[float, float, float]: ...
    @property
    def target(self) -> tuple[float, float, float]: ...
    @property
    def up(self) -> tuple[float, float, float]: ...
    @property
    def fov(self) -> float: ...
    @property
    def near(self) -> float: ...
    @property
    def intrinsics(self) -> tuple[float, float, float, float] | None: ...
    @property
    def orthographic(self) -> float | None: ...

@final
class Sun:
    def __init__(
        self, direction: _Vector, color: _Color | None = None, size: float = 0.53
    ) -> None: ...

@final
class PointLight:
    def __init__(self, position: _Vector, color: _Color | None = None) -> None: ...

@final
class Sky:
    def __init__(
        self, top: _Color, horizon: _Color | None = None, ground: _Color | None = None
    ) -> None: ...

@final
class Environment:
    def __init__(self, image: ArrayLike, turn: float = 0.0) -> None: ...

@final
class Material:
    def __init__(
        self,
        *,
        name: str = "",
        base_color: _Color | None = None,
        metallic: float = 0.0,
        specular: float = 0.0,
        roughness: float = 1.0,
        emissive: _Color | None = None,
        albedo: _Array | None = None,
        height: _Array | None = None,
        relief_depth: float = 0.05,
        normal: _Array | None = None,
        normal_y: _NormalY = "up",
        metallic_map: _Array | None = None,
        roughness_map: _Array | None = None,
        occlusion_map: _Array | None = None,
        emissive_map: _Array | None = None,
        wrap: _Wrap = "repeat",
    ) -> None: ...
    @property
    def name(self) -> str: ...

@final
class Mesh:
    def __init__(
        self,
        vertices: ArrayLike,
        faces: ArrayLike,
        uv: ArrayLike | None = None,
        normals: ArrayLike | None = None,
        material: Material | None = None,
        name: str = "",
        colors: ArrayLike | None = None,
    ) -> None: ...
    @property
    def name(self) -> str: ...

@final
class Scene:
    def __init__(
        self,
        meshes: Sequence[Mesh],
        lights: Sequence[Sun | PointLight] | None = None,
        sky: Sky | Environment | None = None,
        background: Sequence[float] | None = None,
        camera: Camera | None = None,
    ) -> None: ...
    def framing(self, aspect: float = 1.0) -> Camera: ...
    def replace(
        self,
        *,
        lights: Sequence[Sun | PointLight] | None = None,
        sky: Sky | Environment | None = None,
        background: Sequence[float] | None = None,
        camera: Camera | None = None,
    ) -> Scene: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]] | None: ...
    @property
    def objects(self) -> list[str]: ...
    @property
    def materials(self) -> list[str]: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def choices(self) -> list[str]: ...

def builtin() -> Scene: ...
def load(
    path: str | PathLike[str],
    *,
    materials: Mapping[str, Mapping[str, Any]] | None = None,
    albedo: str | PathLike[str] = ...,
    height: str | PathLike[str] = ...,
    normal: str | PathLike[str] = ...,
    metallic_map: str | PathLike[str] = ...,
    roughness_map: str | PathLike[str] = ...,
    occlusion_map: str | PathLike[str] = ...,
    emissive_map: str | PathLike[str] = ...,
    relief_depth: float = ...,
    height_sense: Literal["white-high", "white-deep"] = ...,
    normal_y: _NormalY = ...,
    wrap: _Wrap = ...,
    base_color: _Color = ...,
    metallic: float = ...,
    specular: float = ...,
    roughness: float = ...,
    emissive: _Color = ...,
    aspect: float = 1.0,
    crease_angle: float = ...,
    allow_outside: bool = False,
    max_image_side: int = 32768,
    max_image_mib: int = 1024,
    max_triangles: int = 50_000_000,
    max_textures: int = 1024,
) -> Scene: ...

@final
class Filter:
    def __init__(
        self,
        name: _FilterName = "horizon",
        *,
        lines: int = ...,
        far_field: bool = ...,
        far_field_mib: int = ...,
        derivatives: Literal["flat", "relief"] = ...,
        formulas: Literal["meant", "printed"] = ...,
        visible: Literal["exact", "two-ended", "resolved"] = ...,
        texel_budget: int = ...,
        max_anisotropy: float = ...,
        max_stretch: float = ...,
        every_texel: bool = ...,
        cut: float = ...,
        texel_kernel: float = ...,
        samples: int = ...,
    ) -> None: ...

@final
class Renderer:
    def __init__(
        self,
        scene: Scene,
        *,
        filter: _FilterName | Filter | None = None,
        lighting: Literal["lit", "unlit"] | None = None,
        exposure: float = 0.0,
        tone: Literal["none", "neutral"] = "none",
        msaa: Literal[1, 4, 8] = 4,
        parallax: bool = True,
        silhouette: bool = True,
        cull: bool = False,
        tile_size: int = 32,
        threads: int | None = None,
    ) -> None: ...
    def render(
        self,
        camera: Camera | Iterable[Camera] | None = None,
        size: _Size | None = None,
        layers: str | Sequence[str] | None = None,
        *,
        out: dict[str, _Array] | None = None,
        region: tuple[int, int, int, int] | None = None,
    ) -> dict[str, _Array]: ...
    def frames(
        self,
        cameras: Iterable[Camera],
        size: _Size | None = None,
        layers: str | Sequence[str] | None = None,
        *,
        reuse: bool = False,
    ) -> Frames: ...
    def place(self, transforms: dict[str | int, ArrayLike]) -> None: ...
    def set_vertices(
        self, mesh: str | int, vertices: ArrayLike, normals: ArrayLike | None = None
    ) -> None: ...
    def inspect(
        self, pixel: tuple[int, int], camera: Camera | None = None, size: _Size | None = None
    ) -> dict[str, Any]: ...
    @property
    def threads(self) -> int: ...

@final
class Frames(Iterator[dict[str, _Array]]):
    def __iter__(self) -> Frames: ...
    def __next__(self) -> dict[str, _Array]: ...

@final
class Surface:
    def __init__(
        self,
        albedo: _Array | None = None,
        height: _Array | None = None,
        relief_depth: float = 0.05,
        *,
        normal: _Array | None = None,
        normal_y: _NormalY = "up",
        wrap: _Wrap = "repeat",
    ) -> None: ...
    def colors(
        self,
        uv: ArrayLike,
        dx: ArrayLike,
        dy: ArrayLike,
        view: ArrayLike | None = None,
        *,
        filter: _FilterName | Filter | None = None,
        threads: int | None = None,
    ) -> NDArray[np.float32]: ...
