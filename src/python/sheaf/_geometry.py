"""Geometries and rays: what a user gives becomes arrays that the library reads in place."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple

import numpy
from numpy.typing import ArrayLike, DTypeLike, NDArray

from . import _sheaf
from ._sheaf import UsageError

#: In place of a primitive's or an object's number: none, the ray missed.
NO_PRIMITIVE: int = _sheaf.NO_PRIMITIVE
#: With a sphere's number as a ray's source: the ray runs inside the sphere.
INSIDE_BIT: int = _sheaf.INSIDE_BIT

# By the number that the extension has for them.
_COHERENCE = ("unknown", "common origin", "coherent", "incoherent")

_Numbers = NDArray[Any]
_Core = Any  # _sheaf.GeometryFloat or GeometryDouble, which have the same methods


def _table(name: str, values: ArrayLike, dtype: DTypeLike, columns: int) -> _Numbers:
    """An array of shape (N, columns) without gaps: `values` itself where it is one."""
    array = numpy.asarray(values)
    if array.ndim != 2 or array.shape[1] != columns:
        raise UsageError(f"{name}: shape {array.shape}, not (N, {columns})")
    return numpy.require(_numbers(name, array, dtype), requirements=("C", "ALIGNED"))


def _numbers(name: str, array: _Numbers, dtype: DTypeLike) -> _Numbers:
    if array.dtype.kind not in "fiub":
        raise UsageError(f"{name}: an array of {array.dtype}, not of numbers")
    # What a smaller type cannot hold becomes infinite, and is then an error or a miss.
    with numpy.errstate(over="ignore"):
        return array.astype(dtype, copy=False)


def _indices(name: str, values: ArrayLike) -> _Numbers:
    """Numbers that fit 32 bits; any that do not are an error here and not another number."""
    array = numpy.asarray(values)
    if array.dtype.kind not in "iu" and array.size > 0:
        raise UsageError(f"{name}: an array of {array.dtype}, not of whole numbers")
    if array.dtype != numpy.uint32:
        if array.size > 0 and not 0 <= int(array.min()) <= int(array.max()) < 2**32:
            raise UsageError(f"{name}: below 0 or 2^32 and above")
        array = array.astype(numpy.uint32)
    return array


def _is_usable(array: _Numbers, dtype: numpy.dtype[Any]) -> bool:
    """Whether the library can read rows of this array where they lie."""
    return (
        array.dtype == dtype
        and array.dtype.isnative
        and array.flags.aligned
        and array.strides[0] > 0
        and all(stride % dtype.itemsize == 0 for stride in array.strides)
    )


def _vectors(
    origins: ArrayLike, directions: ArrayLike, dtype: numpy.dtype[Any]
) -> Tuple[_Numbers, _Numbers]:
    """Both of shape (N, 3) and with rows equally far apart. One of shape (3,) stands for all rays."""
    arrays = []
    for name, values in (("origins", origins), ("directions", directions)):
        array = _numbers(name, numpy.asarray(values), dtype)
        if array.ndim not in (1, 2) or array.shape[-1] != 3:
            raise UsageError(f"{name}: shape {array.shape}, not (N, 3) or (3,)")
        arrays.append(array)
    rows = [len(array) for array in arrays if array.ndim == 2]
    count = rows[0] if rows else 1
    if any(row != count for row in rows):
        raise UsageError(f"origins have {rows[0]} rows, directions {rows[1]}")
    arrays = [numpy.broadcast_to(array, (count, 3)) for array in arrays]
    if not all(_is_usable(array, dtype) for array in arrays) or (
        arrays[0].strides[0] != arrays[1].strides[0]
    ):
        arrays = [numpy.array(array, dtype, order="C") for array in arrays]
    return arrays[0], arrays[1]


def _sources(values: Optional[ArrayLike], count: int, stride: int) -> Optional[_Numbers]:
    """The primitives that rays start on, as far apart as the rays are."""
    if values is None:
        return None
    array = _indices("source", values)
    if array.shape != (count,):
        raise UsageError(f"source: shape {array.shape}, not ({count},)")
    if count == 0 or array.strides[0] == stride and array.flags.aligned:
        return array
    wide = numpy.empty((count, stride // 4), numpy.uint32)
    wide[:, 0] = array
    return wide[:, 0]


def _limits(
    name: str, values: Optional[ArrayLike], count: int, dtype: DTypeLike
) -> Optional[_Numbers]:
    if values is None:
        return None
    array = _numbers(name, numpy.asarray(values), dtype)
    if array.shape not in ((), (count,)):
        raise UsageError(f"{name}: shape {array.shape}, not () or ({count},)")
    return numpy.require(array, requirements=("C", "ALIGNED"))


def _rules(
    geometry: "Geometry",
    count: int,
    object_mask: Optional[ArrayLike],
    ray_mask: Optional[ArrayLike],
    excluded: Optional[ArrayLike],
) -> Tuple[Any, ...]:
    """Masks and exclusions as the extension takes them."""
    objects = len(geometry.first_primitives) - 1
    of_objects = None if object_mask is None else _indices("object_mask", object_mask)
    if of_objects is not None and of_objects.shape != (objects,):
        raise UsageError(f"object_mask: shape {of_objects.shape}, not ({objects},)")
    of_rays = None if ray_mask is None else _indices("ray_mask", ray_mask)
    if of_rays is not None and of_rays.shape not in ((), (count,)):
        raise UsageError(f"ray_mask: shape {of_rays.shape}, not () or ({count},)")
    if of_rays is not None and of_objects is None:
        raise UsageError("ray_mask: there is no object_mask")
    one = int(of_rays) if of_rays is not None and of_rays.ndim == 0 else 2**32 - 1
    table = None
    if excluded is not None:
        table = _indices("excluded", excluded)
        if table.ndim not in (1, 2) or (table.ndim == 2 and len(table) != count):
            raise UsageError(f"excluded: shape {table.shape}, not ({count}, K) or (K,)")
        table = numpy.require(
            numpy.broadcast_to(table, (count, table.shape[-1])), requirements=("C", "ALIGNED")
        )
    return of_objects, None if of_rays is None or of_rays.ndim == 0 else of_rays, one, table


class Candidates(NamedTuple):
    """Hits that a filter is asked about, an element each of every array; those of a ray in order."""

    #: The ray's place among those of the call.
    ray: NDArray[numpy.uintp]
    t: _Numbers
    u: _Numbers
    v: _Numbers
    primitive: NDArray[numpy.uint32]
    object: NDArray[numpy.uint32]


#: Takes Candidates, returns a bool for each.
Filter = Callable[[Candidates], ArrayLike]


def _filter(function: Optional[Filter]) -> Optional[Callable[..., _Numbers]]:
    if function is None:
        return None
    known = function

    def ask(*arrays: _Numbers) -> _Numbers:
        answer = numpy.asarray(known(Candidates(*arrays)))
        if answer.shape != arrays[0].shape or answer.dtype != numpy.bool_:
            raise UsageError(
                f"filter: an answer of shape {answer.shape} and {answer.dtype}, not "
                f"{arrays[0].shape} and bool"
            )
        return numpy.ascontiguousarray(answer)

    return ask


class Hits:
    """What N rays hit. Arrays of the geometry's type unless it says otherwise.

    `normal`, `point` and the others from there on are computed when the first of them is asked for,
    from the arrays of rays that `closest` was given, which must not have changed. All 0, and sources
    NO_PRIMITIVE, where a ray missed.
    """

    #: (N,): the distance in lengths of the direction; t_max where the ray missed.
    t: _Numbers
    #: (N,) uint32: the primitive's number, through all objects; NO_PRIMITIVE where the ray missed.
    primitive: NDArray[numpy.uint32]
    #: (N,) uint32: the object's number; NO_PRIMITIVE where the ray missed.
    object: NDArray[numpy.uint32]
    #: (N,): where on the primitive: of a triangle the weight of its second vertex.
    u: _Numbers
    #: (N,): likewise of its third vertex.
    v: _Numbers

    def __init__(self, geometry: Any, rays: Any, target: str, arrays: Tuple[_Numbers, ...]):
        self._geometry = geometry
        self._rays = rays
        self._target = target
        self._points: Optional[Dict[str, _Numbers]] = None
        self.t, self.primitive, self.object, self.u, self.v = arrays

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"<sheaf.Hits: {int(self.hit.sum())} of {len(self)} rays hit>"

    @property
    def hit(self) -> NDArray[numpy.bool_]:
        """(N,) bool: whether the ray hit anything."""
        return numpy.asarray(self.primitive != NO_PRIMITIVE)

    def _point(self, name: str) -> _Numbers:
        if self._points is None:
            found = (self.t, self.primitive, self.u, self.v)
            self._points = self._geometry.points(self._rays, found, self._target)
        return self._points[name]

    @property
    def point(self) -> _Numbers:
        """(N, 3): the place on the surface, to a rounding."""
        return self._point("point")

    @property
    def normal(self) -> _Numbers:
        """(N, 3): unit, of the vertices' normals where there are any, on the ray's side."""
        return self._point("normal")

    @property
    def face_normal(self) -> _Numbers:
        """(N, 3): unit, of the surface itself, towards the ray."""
        return self._point("face_normal")

    @property
    def front(self) -> _Numbers:
        """(N, 3): a little off the surface on the ray's side: where shadows and mirrors start."""
        return self._point("front")

    @property
    def back(self) -> _Numbers:
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
        vectors: Tuple[_Numbers, _Numbers],
        target: str,
        found: Tuple[_Numbers, ...],
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

    def _point(self, name: str) -> _Numbers:
        if self._rays is None:
            kind = _sheaf.RaysFloat if self.t.dtype == numpy.float32 else _sheaf.RaysDouble
            starts, ways = (numpy.ascontiguousarray(array[self.ray]) for array in self._vectors)
            self._rays = kind(starts, ways, None)
        return super()._point(name)


class Geometry:
    """Triangles, spheres and disks, with a tree over them. It never changes.

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
        self._dtype = numpy.dtype(dtype)
        kinds: Dict[str, Any] = {"float32": _sheaf.GeometryFloat, "float64": _sheaf.GeometryDouble}
        if self._dtype.name not in kinds:
            raise UsageError(f"dtype: {self._dtype}, not float32 or float64")
        if not_finite not in ("refuse", "skip"):
            raise UsageError(f'not_finite: "{not_finite}", not "refuse" or "skip"')
        if threads < 0:
            raise UsageError("threads: below 0")
        objects: List[Tuple[Any, ...]] = []
        if vertices is not None or faces is not None:
            if vertices is None or faces is None:
                raise UsageError("vertices and faces: one without the other")
            mesh = _table("vertices", vertices, self._dtype, 3)
            ids = _indices("faces", faces)
            if ids.ndim != 2 or ids.shape[1] != 3:
                raise UsageError(f"faces: shape {ids.shape}, not (N, 3)")
            smooth = None if normals is None else _table("normals", normals, self._dtype, 3)
            objects.append(("triangles", mesh, numpy.require(ids, requirements=("C", "ALIGNED")), smooth))
        elif normals is not None:
            raise UsageError("normals: there are no vertices")
        if spheres is not None:
            objects.append(("spheres", _table("spheres", spheres, self._dtype, 4)))
        if disks is not None:
            objects.append(("disks", _table("disks", disks, self._dtype, 7)))
        self._core: _Core = kinds[self._dtype.name](objects, threads, not_finite)

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

    def _take(
        self,
        origins: ArrayLike,
        directions: ArrayLike,
        t_min: Optional[ArrayLike],
        t_max: Optional[ArrayLike],
        source: Optional[ArrayLike],
        kind: Tuple[str, str],
    ) -> Tuple[Any, Any]:
        starts, ways = _vectors(origins, directions, self._dtype)
        count = len(starts)
        coherence, target = kind
        if coherence not in _COHERENCE:
            raise UsageError(f'coherence: "{coherence}" is none of {", ".join(_COHERENCE)}')
        low = _limits("t_min", t_min, count, self._dtype)
        high = _limits("t_max", t_max, count, self._dtype)
        sources = _sources(source, count, starts.strides[0])
        is_float = self._dtype == numpy.float32
        rays = _sheaf.RaysFloat if is_float else _sheaf.RaysDouble
        options = _sheaf.OptionsFloat if is_float else _sheaf.OptionsDouble
        return (
            rays(starts, ways, sources),
            options(low, high, _COHERENCE.index(coherence), target),
        )

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
        count = len(_vectors(origins, directions, self._dtype)[0])
        rules = _rules(self, count, object_mask, ray_mask, excluded)
        found = self._core.ruled_closest(rays, options, rules, _filter(filter))
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
        count = len(_vectors(origins, directions, self._dtype)[0])
        rules = _rules(self, count, object_mask, ray_mask, excluded)
        found = self._core.ruled_occluded(rays, options, rules, _filter(filter))
        return numpy.asarray(found != 0)

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
        vectors = _vectors(origins, directions, self._dtype)
        rules = _rules(self, len(vectors[0]), object_mask, ray_mask, excluded)
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
        count = len(_vectors(origins, directions, self._dtype)[0])
        rules = _rules(self, count, object_mask, ray_mask, excluded)
        return numpy.asarray(self._core.count(rays, options, rules))

    def __repr__(self) -> str:
        return f"<sheaf.Geometry: {self.first_primitives[-1]} primitives, {self._dtype}>"
