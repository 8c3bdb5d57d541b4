"""Scenes, frames and pictures."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _sheaf
from ._sheaf import UsageError

_Path = Union[str, "os.PathLike[str]"]
_Picture = NDArray[numpy.float32]
_Point = Tuple[float, float, float]


def _path(path: _Path) -> str:
    text = os.fspath(path)
    if not isinstance(text, str):
        raise TypeError("a path is a str or os.PathLike[str]")
    return text


@dataclass(frozen=True)
class Camera:
    """An eye, and what it looks at.

    lens is the projection's number: "perspective", the full vertical angle in degrees, in (0, 180);
    "orthographic", the picture's height; "fisheye", the full angle across the picture's height, up
    to 360; "equirectangular" has none. None: 60 degrees, 2 or 180 degrees.
    """

    eye: _Point
    look_at: _Point
    up: _Point = (0.0, 1.0, 0.0)
    projection: str = "perspective"
    lens: Optional[float] = None
    name: str = ""


class Scene:
    """What a scene or model file describes. Made by `read_scene` or `parse_scene`; never changes."""

    def __init__(self, core: _sheaf.Scene):
        self._core = core
        self._cameras = [
            Camera(eye, look_at, up, projection, lens, name)
            for name, eye, look_at, up, projection, lens in (
                core.camera(i) for i in range(core.camera_count())
            )
        ]

    @property
    def cameras(self) -> List[Camera]:
        """The scene's cameras, in the order of the file."""
        return list(self._cameras)

    @property
    def settings(self) -> Dict[str, int]:
        """width, height, samples and max_depth: the picture that the file asks for."""
        return self._core.settings()

    @property
    def warnings(self) -> List[str]:
        """What was left out or replaced when the scene was read, a line each."""
        return self._core.warnings()

    def _camera(self, camera: Union[None, int, str, Camera]) -> Any:
        if isinstance(camera, Camera):
            points = [tuple(float(x) for x in p) for p in (camera.eye, camera.look_at, camera.up)]
            if any(len(point) != 3 for point in points):
                raise UsageError("camera: eye, look_at and up have three numbers each")
            return (camera.name, *points, camera.projection, camera.lens)
        if isinstance(camera, str):
            names = [known.name for known in self._cameras]
            if camera not in names:
                raise UsageError(f'camera: "{camera}" is none of {", ".join(names)}')
            return names.index(camera)
        index = 0 if camera is None else int(camera)
        if not 0 <= index < len(self._cameras):
            raise UsageError(f"camera: {index} of {len(self._cameras)}")
        return index

    def render(
        self,
        camera: Union[None, int, str, Camera] = None,
        *,
        width: Optional[int] = None,
        height: Optional[int] = None,
        samples: Optional[int] = None,
        max_depth: Optional[int] = None,
        crop: Optional[Tuple[int, int, int, int]] = None,
        precision: str = "strict",
        target: str = "auto",
        threads: int = 0,
        progress: Optional[Callable[[int], object]] = None,
    ) -> _Picture:
        """The picture as (height, width, 3) float32, linear light, rows from the top.

        camera: a name, a number or a Camera; by default the scene's first. width, height (pixels),
        samples (a pixel) and max_depth (of rays) are those of the scene's file unless given. crop:
        x0, y0, x1, y1 in pixels, that part alone. precision: "strict", "fast" or "double". target:
        "auto", or one of `targets()`. threads: at most so many; 0: one a core. progress is called
        some thirty times a second with the number of pixels that are done.

        Neither target (but in "fast") nor threads change a bit. Ctrl-C, and whatever progress
        raises, ends the frame within a moment and is raised here.

        Raises UsageError (a ValueError) where an option does not fit, SceneError (a ValueError) where
        the scene cannot be rendered.
        """
        return self.render_layers(
            (),
            camera,
            width=width,
            height=height,
            samples=samples,
            max_depth=max_depth,
            crop=crop,
            precision=precision,
            target=target,
            threads=threads,
            progress=progress,
        )["rgb"]

    def render_layers(
        self,
        layers: Sequence[str],
        camera: Union[None, int, str, Camera] = None,
        **options: Any,
    ) -> Dict[str, _Picture]:
        """The picture as "rgb", and each layer by its name. Arguments as of `render`.

        layers: of what a pixel's first sample met, any of "depth", (height, width): the distance from
        the ray's origin, infinite where it met nothing; "normal", (height, width, 3): unit, towards
        the ray; "albedo", (height, width, 3): the base colour; "id", (height, width): one more than
        the object's number; "heat", (height, width, 3): of the tile, microseconds a pixel, share of
        live lanes, rays a pixel. 0 where nothing was met.
        """
        return self._render(layers, camera, options)[0]

    def render_statistics(
        self, camera: Union[None, int, str, Camera] = None, **options: Any
    ) -> Dict[str, Any]:
        """Renders as `render` does, and returns what the frame took: primary_rays, shadow_rays,
        reflected_rays, refracted_rays, traced_rays, build_seconds, render_seconds, buffer_bytes and
        threads."""
        return self._render((), camera, options)[1]

    def _render(
        self, layers: Sequence[str], camera: Union[None, int, str, Camera], options: Dict[str, Any]
    ) -> Tuple[Dict[str, _Picture], Dict[str, Any]]:
        for name in options:
            if name not in _OPTIONS:
                raise TypeError(f'"{name}" is no option of render')
        for name in ("width", "height", "samples"):
            value = options.get(name)
            if value is not None and value < 1:  # 0 would be the scene's own
                raise UsageError(f"{name}: {value} is below 1")
        if options.get("max_depth") is not None and options["max_depth"] < 0:
            raise UsageError(f"max_depth: {options['max_depth']} is below 0")
        if options.get("crop") is not None and not any(options["crop"]):
            raise UsageError("crop: an empty rectangle")
        return self._core.render(self._camera(camera), {**options, "layers": list(layers)})


_OPTIONS = frozenset(
    "width height samples max_depth crop precision target threads progress".split()
)


def read_scene(
    path: _Path,
    *,
    aspect: Optional[float] = None,
    time: Optional[float] = None,
    allow_outside: bool = False,
) -> Scene:
    """Reads a scene (.json) or a model (.glb, .gltf, .obj, .ply, .nff).

    A model gets the camera and the lights that it lacks; aspect is the width over height that its
    camera frames it for. time: the moment of a model's animations, in seconds. allow_outside: the
    scene may name files outside of its folder.

    Raises FileError (an OSError) where a file cannot be read, SceneError (a ValueError) with file and
    place where it is malformed.
    """
    options = {"aspect": aspect, "time": time, "allow_outside": allow_outside}
    return Scene(_sheaf.Scene.read(_path(path), options))


def parse_scene(text: str, name: str = "scene.json") -> Scene:
    """Reads scene JSON from a string. `name` stands for the file in messages, and what the scene
    names lies relative to it. Raises SceneError where the text is malformed."""
    return Scene(_sheaf.Scene.parse(text, name))


def write_picture(
    path: _Path,
    rgb: ArrayLike,
    *,
    bits: int = 0,
    transfer: str = "srgb",
    ev: float = 0.0,
    tone: str = "linear",
) -> None:
    """Writes a .png, .pfm or .exr, which appears complete or not at all.

    rgb: (height, width, 3), linear light. bits a channel: 8 or 16 of a .png, 16 or 32 of an .exr;
    0: 8, or 32 of the others. Of a .png: light is multiplied by 2**ev, goes through the tone
    ("linear", or "filmic", which rolls off highlights) and the transfer ("srgb" or "linear").

    Raises UsageError (a ValueError) where the ending or an option does not fit, FileError (an
    OSError) where the file cannot be written.
    """
    for name, value, known in (
        ("transfer", transfer, ("srgb", "linear")),
        ("tone", tone, ("linear", "filmic")),
    ):
        if value not in known:
            raise UsageError(f'{name}: "{value}", not "{known[0]}" or "{known[1]}"')
    pixels = numpy.asarray(rgb)
    if pixels.ndim != 3 or pixels.shape[2] != 3 or pixels.size == 0:
        raise UsageError(f"rgb: shape {pixels.shape}, not (height, width, 3)")
    if pixels.dtype.kind not in "fiub":
        raise UsageError(f"rgb: an array of {pixels.dtype}, not of numbers")
    options = {"bits": bits, "ev": ev, "linear": transfer == "linear", "filmic": tone == "filmic"}
    pixels = numpy.require(pixels, numpy.float32, ("C", "ALIGNED"))
    _sheaf.write_picture(_path(path), pixels, options)


def read_picture(path: _Path) -> Dict[str, _Picture]:
    """Reads a .png, .pfm or .exr: "rgb", (height, width, 3) float32, and the layers that it has.

    Colours of a .png that says that they are sRGB become linear light; others are as they lie in the
    file, 0 to 1. Raises UsageError (a ValueError) for another ending, FileError (an OSError) for
    whatever is no such picture.
    """
    return _sheaf.read_picture(_path(path))
