"""Geometries in many places."""

from __future__ import annotations

from typing import Any, Dict, NamedTuple, Optional, Sequence, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _sheaf
from ._arrays import indices_of, numbers_of, sources_of, vectors_of
from ._geometry import Geometry
from ._sheaf import UsageError

#: In place of an instance's number: none, the ray missed.
NO_INSTANCE: int = _sheaf.NO_INSTANCE


class InstanceHits(NamedTuple):
    """What rays hit, an element each of every array."""

    #: In lengths of the direction; t_max where the ray misses.
    t: NDArray[Any]
    #: uint32; NO_INSTANCE where the ray misses.
    instance: NDArray[numpy.uint32]
    #: uint32, numbered within the instance's geometry; NO_PRIMITIVE where the ray misses.
    primitive: NDArray[numpy.uint32]
    #: uint32, likewise.
    object: NDArray[numpy.uint32]
    #: Where on the primitive, as of `Hits`.
    u: NDArray[Any]
    v: NDArray[Any]

    @property
    def hit(self) -> NDArray[numpy.bool_]:
        """(N,) bool: whether each ray hit anything."""
        return numpy.asarray(self.instance != NO_INSTANCE)


class Instances:
    """Geometries, each of which is in memory once, in the places where they stand. Never changes.

    geometries: one Geometry, or several of one dtype. transforms: (I, 3, 4), (I, 4, 4) or one of
    them without I; to the world. Any that does not flatten. which: (I,) positions in geometries, 0
    for all by default.

    Raises UsageError with the number of the place that is wrong.
    """

    def __init__(
        self,
        geometries: Union[Geometry, Sequence[Geometry]],
        transforms: ArrayLike,
        which: Optional[ArrayLike] = None,
        *,
        threads: int = 0,
    ):
        kept = [geometries] if isinstance(geometries, Geometry) else list(geometries)
        if not kept or any(geometry.dtype != kept[0].dtype for geometry in kept):
            raise UsageError("geometries: none, or of several dtypes")
        if threads < 0:
            raise UsageError("threads: below 0")
        maps = numbers_of("transforms", numpy.asarray(transforms), numpy.float64)
        maps = maps[None] if maps.ndim == 2 else maps
        if maps.ndim != 3 or maps.shape[1:] not in ((3, 4), (4, 4)):
            raise UsageError(f"transforms: shape {maps.shape}, not (N, 3, 4) or (N, 4, 4)")
        if maps.shape[1] == 4 and not (maps[:, 3] == (0, 0, 0, 1)).all():
            raise UsageError("transforms: a last row that is not 0, 0, 0, 1")
        ids = numpy.zeros(len(maps), numpy.uint32) if which is None else indices_of("which", which)
        if ids.shape != (len(maps),):
            raise UsageError(f"which: shape {ids.shape}, not ({len(maps)},)")
        is_float = kept[0].dtype == numpy.float32
        kind: Any = _sheaf.InstancesFloat if is_float else _sheaf.InstancesDouble
        rows = numpy.require(maps[:, :3].reshape(-1, 12), requirements=("C", "ALIGNED"))
        self._geometries = kept
        self._core = kind([geometry._core for geometry in kept], rows, ids, threads)

    @property
    def statistics(self) -> Dict[str, int]:
        """Counts: instances, geometries; of the tree over them nodes and depth; bytes of memory,
        without the geometries."""
        counts: Dict[str, int] = self._core.statistics()
        return counts

    @property
    def bounds(self) -> NDArray[numpy.float32]:
        """(2, 3) float32: the lower and the upper corner of a box around everything."""
        return numpy.array(self._core.bounds(), numpy.float32)

    def closest(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        t_min: Optional[ArrayLike] = None,
        t_max: Optional[ArrayLike] = None,
        source: Optional[ArrayLike] = None,
        source_instance: Optional[ArrayLike] = None,
        target: str = "auto",
    ) -> InstanceHits:
        """The nearest hit of each ray; of equal t the lowest instance, then the lowest primitive.

        source, source_instance: (N,), the primitives that rays start on and their instances. Else
        as `Geometry.closest`.
        """
        rays, options = self._geometries[0]._take(
            origins, directions, t_min, t_max, source, ("unknown", target)
        )
        from_instances = self._sources(origins, directions, source_instance)
        return InstanceHits(*self._core.closest(rays, from_instances, options))

    def occluded(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        t_min: Optional[ArrayLike] = None,
        t_max: Optional[ArrayLike] = None,
        source: Optional[ArrayLike] = None,
        source_instance: Optional[ArrayLike] = None,
        target: str = "auto",
    ) -> NDArray[numpy.bool_]:
        """(N,) bool: whether each ray hits anything between t_min and t_max. Else as `closest`."""
        rays, options = self._geometries[0]._take(
            origins, directions, t_min, t_max, source, ("unknown", target)
        )
        from_instances = self._sources(origins, directions, source_instance)
        return numpy.asarray(self._core.occluded(rays, from_instances, options) != 0)

    def _sources(
        self, origins: ArrayLike, directions: ArrayLike, values: Optional[ArrayLike]
    ) -> Optional[NDArray[Any]]:
        if values is None:
            return None
        starts = vectors_of(origins, directions, self._geometries[0].dtype)[0]
        return sources_of(values, len(starts), starts.strides[0])

    def __repr__(self) -> str:
        return f"<sheaf.Instances: {self.statistics['instances']} instances>"
