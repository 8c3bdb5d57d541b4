"""What queries return."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, NamedTuple, Optional, Tuple

import numpy
from numpy.typing import NDArray

from . import _sheaf
from ._arrays import NO_PRIMITIVE, Numbers


class Hits:
    """What N rays hit. Arrays of the geometry's type unless it says otherwise.

    `normal`, `point` and the others from there on are computed when the first of them is asked for,
    from the arrays of rays that `closest` was given, which must not have changed. All 0, and sources
    NO_PRIMITIVE, where a ray missed.
    """

    #: (N,): the distance in lengths of the direction; t_max where the ray missed.
    t: Numbers
    #: (N,) uint32: the primitive's number, through all objects; NO_PRIMITIVE where the ray missed.
    primitive: NDArray[numpy.uint32]
    #: (N,) uint32: the object's number; NO_PRIMITIVE where the ray missed.
    object: NDArray[numpy.uint32]
    #: (N,): where on the primitive: of a triangle the weight of its second vertex.
    u: Numbers
    #: (N,): likewise of its third vertex.
    v: Numbers

    def __init__(self, geometry: Any, rays: Any, target: str, arrays: Tuple[Numbers, ...]):
        self._geometry = geometry
        self._rays = rays
        self._target = target
        self._points: Optional[Dict[str, Numbers]] = None
        self.t, self.primitive, self.object, self.u, self.v = arrays

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"<sheaf.Hits: {int(self.hit.sum())} of {len(self)} rays hit>"

    @property
    def hit(self) -> NDArray[numpy.bool_]:
        """(N,) bool: whether the ray hit anything."""
        return numpy.asarray(self.primitive != NO_PRIMITIVE)

    def _point(self, name: str) -> Numbers:
        if self._points is None:
            found = (self.t, self.primitive, self.u, self.v)
            self._points = self._geometry.points(self._rays, found, self._target)
        return self._points[name]

    @property
    def point(self) -> Numbers:
        """(N, 3): the place on the surface, to a rounding."""
        return self._point("point")

    @property
    def normal(self) -> Numbers:
        """(N, 3): unit, of the vertices' normals where there are any, on the ray's side."""
        return self._point("normal")

    @property
    def face_normal(self) -> Numbers:
        """(N, 3): unit, of the surface itself, towards the ray."""
        return self._point("face_normal")

    @property
    def front(self) -> Numbers:
        """(N, 3): a little off the surface on the ray's side: where shadows and mirrors start."""
        return self._point("front")

    @property
    def back(self) -> Numbers:
        """(N, 3): a little off the surface on the other side: where what passes through starts."""
        return self._point("back")

    @property
    def front_source(self) -> NDArray[numpy.uint32]:
        """(N,) uint32: what `source` has to be for rays from `front`."""
        return self._point("front_source")

    @property
    def back_source(self) -> NDArray[numpy.uint32]:
        """(N,) uint32: what `source` has to be for rays from `back`."""
        return self._point("back_source")

    @property
    def side(self) -> NDArray[numpy.uint32]:
        """(N,) uint32: 0 where the ray came from outside (a triangle's side from which its vertices
        run counter-clockwise), 1 where it came from inside."""
        return self._point("side")


class AllHits(Hits):
    """All hits of rays, one ray's after the other's, each ray's in order: M of them.

    What `Hits` has for each ray, this has for each hit. A sphere is hit twice, where the ray enters it
    (u is 0) and where it leaves it (u is 1).
    """

    #: (M,): which ray hit there, by its place in the arrays that were given.
    ray: NDArray[numpy.intp]
    #: (N + 1,): ray i has the hits first[i] to first[i + 1].
    first: NDArray[numpy.uintp]

    def __init__(
        self,
        geometry: Any,
        vectors: Tuple[Numbers, Numbers],
        target: str,
        found: Tuple[Numbers, ...],
    ):
        super().__init__(geometry, None, target, found[1:])
        self._vectors = vectors
        self.first = found[0]
        counts = numpy.diff(self.first.astype(numpy.intp))
        self.ray = numpy.repeat(numpy.arange(len(counts)), counts)

    @property
    def count(self) -> NDArray[numpy.intp]:
        """(N,): how many hits of each ray there are here."""
        return numpy.diff(self.first.astype(numpy.intp))

    def __repr__(self) -> str:
        return f"<sheaf.AllHits: {len(self)} hits of {len(self.first) - 1} rays>"

    def _point(self, name: str) -> Numbers:
        if self._rays is None:
            kind = _sheaf.RaysFloat if self.t.dtype == numpy.float32 else _sheaf.RaysDouble
            starts, ways = (numpy.ascontiguousarray(array[self.ray]) for array in self._vectors)
            self._rays = kind(starts, ways, None)
        return super()._point(name)


class Nearest(NamedTuple):
    """The nearest points to N places."""

    #: (N,): how far away; max_distance where nothing is as near.
    distance: Numbers
    #: (N,) uint32: the primitive's number; NO_PRIMITIVE where nothing is as near.
    primitive: NDArray[numpy.uint32]
    #: (N,) uint32: the object's number, likewise.
    object: NDArray[numpy.uint32]
    #: (N, 3): the nearest point; else 0.
    point: Numbers


@dataclass(frozen=True, eq=False)
class Overlaps:
    """Which primitives meet N regions."""

    #: (N + 1,): region i has the primitives first[i] to first[i + 1].
    first: NDArray[numpy.uintp]
    #: (M,) uint32: the primitives, region by region, ascending in each.
    primitive: NDArray[numpy.uint32]

    @property
    def count(self) -> NDArray[numpy.intp]:
        """(N,): how many primitives meet each region."""
        return numpy.diff(self.first.astype(numpy.intp))

    @property
    def region(self) -> NDArray[numpy.intp]:
        """(M,): which region each primitive meets."""
        return numpy.repeat(numpy.arange(len(self.first) - 1), self.count)
