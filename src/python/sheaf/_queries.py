"""What a geometry is asked for besides nearest hits."""

from __future__ import annotations

from typing import Any, Optional, Tuple

import numpy
from numpy.typing import ArrayLike, NDArray

from . import _sheaf
from ._arrays import limits_of, rules_of, sources_of, table_of, vectors_of
from ._hits import AllHits, Nearest, Overlaps
from ._sheaf import UsageError

# By the number that the extension has for them.
COHERENCE = ("unknown", "common origin", "coherent", "incoherent")



class Queries:
    """The part of Geometry that holds these."""

    _core: Any  # _sheaf.GeometryFloat or GeometryDouble, which have the same methods
    _dtype: numpy.dtype[Any]

    def _take(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        t_min: Optional[ArrayLike],
        t_max: Optional[ArrayLike],
        source: Optional[ArrayLike],
        kind: Tuple[str, str],
    ) -> Tuple[Any, Any]:
        starts, ways = vectors_of(origins, directions, self._dtype)
        count = len(starts)
        coherence, target = kind
        if coherence not in COHERENCE:
            raise UsageError(f'coherence: "{coherence}" is none of {", ".join(COHERENCE)}')
        low = limits_of("t_min", t_min, count, self._dtype)
        high = limits_of("t_max", t_max, count, self._dtype)
        sources = sources_of(source, count, starts.strides[0])
        is_float = self._dtype == numpy.float32
        rays = _sheaf.RaysFloat if is_float else _sheaf.RaysDouble
        options = _sheaf.OptionsFloat if is_float else _sheaf.OptionsDouble
        return (
            rays(starts, ways, sources),
            options(low, high, COHERENCE.index(coherence), target),
        )

    def _ruled(
        self,
        count: int,
        object_mask: Optional[ArrayLike],
        ray_mask: Optional[ArrayLike],
        excluded: Optional[ArrayLike],
    ) -> Tuple[Any, ...]:
        """Masks and exclusions of `count` rays or points."""
        objects = len(self._core.first_primitives()) - 1
        return rules_of(objects, count, object_mask, ray_mask, excluded)

    def all_hits(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        *,
        max_hits: Optional[int] = None,
        t_min: Optional[ArrayLike] = None,
        t_max: Optional[ArrayLike] = None,
        source: Optional[ArrayLike] = None,
        object_mask: Optional[ArrayLike] = None,
        ray_mask: Optional[ArrayLike] = None,
        excluded: Optional[ArrayLike] = None,
        target: str = "auto",
    ) -> AllHits:
        """All hits of each ray, by t, of equal t the lowest primitive first: at most the nearest
        max_hits of each ray. A ray through an edge hits both triangles there. Else as `closest`."""
        if max_hits is not None and max_hits < 0:
            raise UsageError(f"max_hits: {max_hits} is below 0")
        rays, options = self._take(origins, directions, t_min, t_max, source, ("unknown", target))
        vectors = vectors_of(origins, directions, self._dtype)
        rules = self._ruled(len(vectors[0]), object_mask, ray_mask, excluded)
        most = 2**32 - 1 if max_hits is None else min(max_hits, 2**32 - 1)
        return AllHits(self._core, vectors, target, self._core.all(rays, options, rules, most))

    def count_hits(
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
        target: str = "auto",
    ) -> NDArray[numpy.uint32]:
        """(N,) uint32: how many hits each ray has. Else as `all_hits`."""
        rays, options = self._take(origins, directions, t_min, t_max, source, ("unknown", target))
        count = len(vectors_of(origins, directions, self._dtype)[0])
        rules = self._ruled(count, object_mask, ray_mask, excluded)
        return numpy.asarray(self._core.count(rays, options, rules))

    def count_crossings(
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
        target: str = "auto",
    ) -> NDArray[numpy.uint32]:
        """(N,) uint32: how often each ray passes through surfaces. An edge or a vertex that triangles
        share counts once where the ray passes through there, and an even number of times where it only
        touches, so that a ray from inside a closed mesh has an odd number. Else as `all_hits`."""
        rays, options = self._take(origins, directions, t_min, t_max, source, ("unknown", target))
        count = len(vectors_of(origins, directions, self._dtype)[0])
        rules = self._ruled(count, object_mask, ray_mask, excluded)
        return numpy.asarray(self._core.crossings(rays, options, rules))

    def inside(
        self,
        points: ArrayLike,
        *,
        object_mask: Optional[ArrayLike] = None,
        point_mask: Optional[ArrayLike] = None,
    ) -> NDArray[numpy.bool_]:
        """(N,) bool: whether each of (N, 3) points is inside an odd number of closed surfaces, meshes
        and spheres. object_mask, point_mask: which objects count, as object_mask and ray_mask of
        `closest`. Points within a few roundings of a surface are on either side."""
        table = table_of("points", points, self._dtype, 3)
        rules = self._ruled(len(table), object_mask, point_mask, None)
        return numpy.asarray(self._core.inside(table, rules) != 0)

    def nearest(
        self,
        points: ArrayLike,
        *,
        max_distance: Optional[ArrayLike] = None,
        signed: bool = False,
        object_mask: Optional[ArrayLike] = None,
        point_mask: Optional[ArrayLike] = None,
        excluded: Optional[ArrayLike] = None,
    ) -> Nearest:
        """The nearest point of any surface to each of (N, 3) points, of equal distance the lowest
        primitive. A sphere is its shell, from inside too.

        max_distance: a number or (N,), nothing beyond counts. signed: distances are below 0 for points
        that `inside` finds inside. The others as of `closest`, with points for rays. Computed in double.
        """
        table = table_of("points", points, self._dtype, 3)
        rules = self._ruled(len(table), object_mask, point_mask, excluded)
        most = limits_of("max_distance", max_distance, len(table), self._dtype)
        return Nearest(*self._core.nearest(table, most, signed, rules))

    def in_boxes(self, lower: ArrayLike, upper: ArrayLike) -> Overlaps:
        """The primitives that meet the boxes from `lower` to `upper`, (N, 3) each or (3,) for all.
        Primitives are surfaces: a box within a sphere does not meet it."""
        starts, ends = vectors_of(lower, upper, self._dtype)
        tables = (numpy.require(array, requirements=("C", "ALIGNED")) for array in (starts, ends))
        return Overlaps(*self._core.in_boxes(*tables))

    def in_balls(self, balls: ArrayLike) -> Overlaps:
        """The primitives whose nearest point is within balls, (N, 4): center and radius."""
        return Overlaps(*self._core.in_balls(table_of("balls", balls, self._dtype, 4)))
