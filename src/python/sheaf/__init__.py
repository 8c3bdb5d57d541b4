"""Sheaf: a SIMD ray tracer for CPUs, on the arrays of NumPy.

Trace rays of your own against triangles, spheres and disks::

    geometry = sheaf.Geometry(vertices, faces)
    hits = geometry.closest(origins, directions)
    hits.t, hits.primitive, hits.point, hits.normal

Render scene and model files::

    scene = sheaf.read_scene("model.glb")
    rgb = scene.render(width=640, height=480)
    sheaf.write_picture("model.png", rgb)

Lengths are in one unit of your choice, angles in degrees, colours linear RGB. Pictures have their
rows from the top. Results are the same bits on every processor. What goes wrong raises a subclass of
`sheaf.Error`. Anything may be called from several threads at once: the interpreter's lock is
released while rays are traced, trees are built and frames are rendered; leave the arrays alone
meanwhile.
"""

from ._arrays import INSIDE_BIT, NO_PRIMITIVE, Candidates
from ._geometry import Geometry
from ._hits import AllHits, Hits, Nearest, Overlaps
from ._instances import NO_INSTANCE, InstanceHits, Instances
from ._scene import Camera, Scene, parse_scene, read_picture, read_scene, write_picture
from ._sheaf import (
    Error,
    FileError,
    SceneError,
    StoppedError,
    UsageError,
    __version__,
    build_info,
    targets,
)

__all__ = [
    "INSIDE_BIT",
    "NO_INSTANCE",
    "NO_PRIMITIVE",
    "AllHits",
    "Camera",
    "Candidates",
    "Error",
    "FileError",
    "Geometry",
    "Hits",
    "InstanceHits",
    "Instances",
    "Nearest",
    "Overlaps",
    "Scene",
    "SceneError",
    "StoppedError",
    "UsageError",
    "__version__",
    "build_info",
    "parse_scene",
    "read_picture",
    "read_scene",
    "targets",
    "write_picture",
]
