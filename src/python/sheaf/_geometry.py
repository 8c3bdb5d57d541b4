"""Triangles, spheres and disks, and rays against them."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Optional, Tuple, Union

import numpy
from numpy.typing import ArrayLike, DTypeLike, NDArray

from . import _sheaf
from ._arrays import Filter, filter_of, indices_of, table_of, vectors_of
from ._hits import Hits
from ._queries import Queries
from ._sheaf import UsageError


def _kind_of(dtype: DTypeLike) -> Tuple[numpy.dtype[Any], Any]:
    kinds: Dict[str, Any] = {"float32": _sheaf.GeometryFloat, "float64": _sheaf.GeometryDouble}
    named = numpy.dtype(dtype)
    if named.name not in kinds:
        raise UsageError(f"dtype: {named}, not float32 or float64")
    return named, kinds[named.name]


class Geometry(Queries):
    """Triangles, spheres and disks, with a tree over them. Only `update` changes it.

    vertices: (V, 3), finite. faces: (F, 3) whole numbers below V. normals: (V, 3), for `Hits.normal`.
    spheres: (S, 4), center and radius >= 0. disks: (D, 7), center, radius >= 0 and normal.

    What is given makes objects 0, 1 and 2 in this order; primitives are numbered through them. dtype
    float32 or float64 is what rays are traced in. Arrays of that type (faces: uint32) without gaps
    are read in place, others are converted; nothing of them is kept.

    threads: at most so many build; 0: one a core. not_finite: "refuse" raises where a number is not
    finite, "skip" leaves its primitive out.

    Raises UsageError (a ValueError) with the number of the object and the primitive that is wrong.
    """

    def __init__(
        self,
        vertices: Optional[ArrayLike] = None,
        faces: Optional[ArrayLike] = None,
        *,
        normals: Optional[ArrayLike] = None,
        spheres: Optional[ArrayLike] = None,
        disks: Optional[ArrayLike] = None,
        dtype: DTypeLike = numpy.float32,
        threads: int = 0,
        not_finite: str = "refuse",
    ):
        self._dtype, kind = _kind_of(dtype)
        objects = self._objects(vertices, faces, normals, spheres, disks, threads, not_finite)
        self._core = kind(objects, threads, not_finite)

    @classmethod
    def map(
        cls, path: Union[str, "os.PathLike[str]"], *, dtype: DTypeLike = numpy.float32, check: str = "all"
    ) -> "Geometry":
        """The geometry of a file that `save` wrote: the same hits, to the bit.

        The file is mapped read-only and its pages are shared with every process that maps it. It must
        not be written to meanwhile, but may be saved to again, renamed or removed.

        dtype: that of the geometry that was saved. check: "all" reads the whole file once and believes
        nothing of it, "header" looks at the header and the sizes alone, for files that are known to be
        sound. Raises FileError, with the path and what is wrong, where the file cannot be read,
        is damaged, of another version or of another dtype.
        """
        if check not in ("all", "header"):
            raise UsageError(f'check: "{check}", not "all" or "header"')
        self = cls.__new__(cls)
        self._dtype, kind = _kind_of(dtype)
        self._core = kind.map(os.fspath(path), check)
        return self

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the geometry with its tree to a file, for `map`. The old file or the whole new one is
        there, whatever happens. Such a file belongs to the version of Sheaf and the kind of machine.
        Raises FileError where it cannot be written."""
        self._core.save(os.fspath(path))

    def update(
        self,
        vertices: Optional[ArrayLike] = None,
        faces: Optional[ArrayLike] = None,
        *,
        normals: Optional[ArrayLike] = None,
        spheres: Optional[ArrayLike] = None,
        disks: Optional[ArrayLike] = None,
        threads: int = 0,
        not_finite: str = "refuse",
        rebuild_ratio: float = 1.5,
    ) -> bool:
        """Becomes what Geometry(...) of the same arguments is: the same hits, to the bit.

        Where primitives have moved and are otherwise as before, the tree is fitted to them in a part
        of the time of a build. Returns whether it was built anew instead, because other primitives
        came, or because it cost more than rebuild_ratio (0: always) times as much as the last that
        was built.

        No other thread may use the geometry meanwhile. Hits that were found before keep what they
        hold, but their points are not to be asked for afterwards. Raises UsageError as Geometry
        does; the geometry then is as it was.
        """
        objects = self._objects(vertices, faces, normals, spheres, disks, threads, not_finite)
        rebuilt: bool = self._core.update(objects, threads, not_finite, rebuild_ratio)
        return rebuilt

    def _objects(
        self,
        vertices: Optional[ArrayLike],
        faces: Optional[ArrayLike],
        normals: Optional[ArrayLike],
        spheres: Optional[ArrayLike],
        disks: Optional[ArrayLike],
        threads: int,
        not_finite: str,
    ) -> List[Tuple[Any, ...]]:
        if not_finite not in ("refuse", "skip"):
            raise UsageError(f'not_finite: "{not_finite}", not "refuse" or "skip"')
        if threads < 0:
            raise UsageError("threads: below 0")
        objects: List[Tuple[Any, ...]] = []
        if vertices is not None or faces is not None:
            if vertices is None or faces is None:
                raise UsageError("vertices and faces: one without the other")
            mesh = table_of("vertices", vertices, self._dtype, 3)
            ids = indices_of("faces", faces)
            if ids.ndim != 2 or ids.shape[1] != 3:
                raise UsageError(f"faces: shape {ids.shape}, not (N, 3)")
            smooth = None if normals is None else table_of("normals", normals, self._dtype, 3)
            objects.append(("triangles", mesh, numpy.require(ids, requirements=("C", "ALIGNED")), smooth))
        elif normals is not None:
            raise UsageError("normals: there are no vertices")
        if spheres is not None:
            objects.append(("spheres", table_of("spheres", spheres, self._dtype, 4)))
        if disks is not None:
            objects.append(("disks", table_of("disks", disks, self._dtype, 7)))
        return objects

    @property
    def dtype(self) -> numpy.dtype[Any]:
        """What rays are traced in: float32 or float64."""
        return self._dtype

    @property
    def statistics(self) -> Dict[str, int]:
        """Counts: objects, primitives, triangles, spheres, disks, never_hit, skipped; of the tree
        nodes, leaves and depth; bytes of memory. Walks the whole tree."""
        counts: Dict[str, int] = self._core.statistics()
        return counts

    @property
    def bounds(self) -> NDArray[numpy.float32]:
        """(2, 3) float32: the lower and the upper corner of the box around everything."""
        return numpy.array(self._core.bounds(), numpy.float32)

    @property
    def first_primitives(self) -> NDArray[numpy.uint32]:
        """(objects + 1,) uint32: the first primitive of each object, and the number of all."""
        return numpy.asarray(self._core.first_primitives())

    def closest(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        t_min: Optional[ArrayLike] = None,
        t_max: Optional[ArrayLike] = None,
        source: Optional[ArrayLike] = None,
        object_mask: Optional[ArrayLike] = None,
        ray_mask: Optional[ArrayLike] = None,
        excluded: Optional[ArrayLike] = None,
        filter: Optional[Filter] = None,
        coherence: str = "unknown",
        target: str = "auto",
    ) -> Hits:
        """The nearest hit of each ray; of equal t the lowest primitive.

        origins, directions: (N, 3), or (3,) for all rays; directions of any length but 0. A ray with
        a number that is not finite misses. Arrays of the geometry's type are read in place where
        their rows are equally far apart, like those of shape (N, 3) without gaps, or columns of
        larger tables; others are converted.

        t_min, t_max: a number or (N,): a hit counts where t_min <= t <= t_max; by default every hit
        in front. source: (N,) whole numbers, the primitives that rays start on and do not hit
        again, NO_PRIMITIVE for none (`Hits.front_source`).

        coherence: "unknown", "common origin", "coherent" or "incoherent": what is known of
        neighbouring rays, which may change the time. target: "auto", or one of `targets()`. Neither
        changes a bit of the result.

        These leave hits out; where none is given, nothing is slower. object_mask: a whole number of 32
        bits an object; a hit counts where it has a bit in common with ray_mask, a number or (N,), all
        bits by default. excluded: (N, K) or (K,), primitives that each ray or all do not hit. filter:
        a function of `Candidates`, hits of several rays at a time, that returns a bool for each.

        One call runs on one thread; call from several for more. Raises UsageError where a shape, a
        type or a name does not fit.
        """
        rays, options = self._take(
            origins, directions, t_min, t_max, source, (coherence, target)
        )
        if object_mask is None and ray_mask is None and excluded is None and filter is None:
            return Hits(self._core, rays, target, self._core.closest(rays, options))
        count = len(vectors_of(origins, directions, self._dtype)[0])
        rules = self._ruled(count, object_mask, ray_mask, excluded)
        found = self._core.ruled_closest(rays, options, rules, filter_of(filter))
        return Hits(self._core, rays, target, found)

    def occluded(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        t_min: Optional[ArrayLike] = None,
        t_max: Optional[ArrayLike] = None,
        source: Optional[ArrayLike] = None,
        object_mask: Optional[ArrayLike] = None,
        ray_mask: Optional[ArrayLike] = None,
        excluded: Optional[ArrayLike] = None,
        filter: Optional[Filter] = None,
        coherence: str = "unknown",
        target: str = "auto",
    ) -> NDArray[numpy.bool_]:
        """(N,) bool: whether each ray hits anything between t_min and t_max. Else as `closest`."""
        rays, options = self._take(
            origins, directions, t_min, t_max, source, (coherence, target)
        )
        if object_mask is None and ray_mask is None and excluded is None and filter is None:
            return numpy.asarray(self._core.occluded(rays, options) != 0)
        count = len(vectors_of(origins, directions, self._dtype)[0])
        rules = self._ruled(count, object_mask, ray_mask, excluded)
        found = self._core.ruled_occluded(rays, options, rules, filter_of(filter))
        return numpy.asarray(found != 0)

    def __repr__(self) -> str:
        return f"<sheaf.Geometry: {self.first_primitives[-1]} primitives, {self._dtype}>"
