"""What a user gives becomes arrays that the library reads in place."""

from __future__ import annotations

from typing import Any, Callable, NamedTuple, Optional, Tuple

import numpy
from numpy.typing import ArrayLike, DTypeLike, NDArray

from . import _sheaf
from ._sheaf import UsageError

#: In place of a primitive's or an object's number: none, the ray missed.
NO_PRIMITIVE: int = _sheaf.NO_PRIMITIVE
#: With a sphere's number as a ray's source: the ray runs inside the sphere.
INSIDE_BIT: int = _sheaf.INSIDE_BIT

Numbers = NDArray[Any]


def table_of(name: str, values: ArrayLike, dtype: DTypeLike, columns: int) -> Numbers:
    """An array of shape (N, columns) without gaps: `values` itself where it is one."""
    array = numpy.asarray(values)
    if array.ndim != 2 or array.shape[1] != columns:
        raise UsageError(f"{name}: shape {array.shape}, not (N, {columns})")
    return numpy.require(numbers_of(name, array, dtype), requirements=("C", "ALIGNED"))


def numbers_of(name: str, array: Numbers, dtype: DTypeLike) -> Numbers:
    if array.dtype.kind not in "fiub":
        raise UsageError(f"{name}: an array of {array.dtype}, not of numbers")
    # What a smaller type cannot hold becomes infinite, and is then an error or a miss.
    with numpy.errstate(over="ignore"):
        return array.astype(dtype, copy=False)


def indices_of(name: str, values: ArrayLike) -> Numbers:
    """Numbers that fit 32 bits; any that do not are an error here and not another number."""
    array = numpy.asarray(values)
    if array.dtype.kind not in "iu" and array.size > 0:
        raise UsageError(f"{name}: an array of {array.dtype}, not of whole numbers")
    if array.dtype != numpy.uint32:
        if array.size > 0 and not 0 <= int(array.min()) <= int(array.max()) < 2**32:
            raise UsageError(f"{name}: below 0 or 2^32 and above")
        array = array.astype(numpy.uint32)
    return array


def _is_usable(array: Numbers, dtype: numpy.dtype[Any]) -> bool:
    """Whether the library can read rows of this array where they lie."""
    return (
        array.dtype == dtype
        and array.dtype.isnative
        and array.flags.aligned
        and array.strides[0] > 0
        and all(stride % dtype.itemsize == 0 for stride in array.strides)
    )


def vectors_of(
    origins: ArrayLike, directions: ArrayLike, dtype: numpy.dtype[Any]
) -> Tuple[Numbers, Numbers]:
    """Both of shape (N, 3) and with rows equally far apart. One of shape (3,) stands for all rays."""
    arrays = []
    for name, values in (("origins", origins), ("directions", directions)):
        array = numbers_of(name, numpy.asarray(values), dtype)
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


def sources_of(values: Optional[ArrayLike], count: int, stride: int) -> Optional[Numbers]:
    """The primitives that rays start on, as far apart as the rays are."""
    if values is None:
        return None
    array = indices_of("source", values)
    if array.shape != (count,):
        raise UsageError(f"source: shape {array.shape}, not ({count},)")
    if count == 0 or array.strides[0] == stride and array.flags.aligned:
        return array
    wide = numpy.empty((count, stride // 4), numpy.uint32)
    wide[:, 0] = array
    return wide[:, 0]


def limits_of(
    name: str, values: Optional[ArrayLike], count: int, dtype: DTypeLike
) -> Optional[Numbers]:
    if values is None:
        return None
    array = numbers_of(name, numpy.asarray(values), dtype)
    if array.shape not in ((), (count,)):
        raise UsageError(f"{name}: shape {array.shape}, not () or ({count},)")
    return numpy.require(array, requirements=("C", "ALIGNED"))


def rules_of(
    objects: int,
    count: int,
    object_mask: Optional[ArrayLike],
    ray_mask: Optional[ArrayLike],
    excluded: Optional[ArrayLike],
) -> Tuple[Any, ...]:
    """Masks and exclusions as the extension takes them."""
    of_objects = None if object_mask is None else indices_of("object_mask", object_mask)
    if of_objects is not None and of_objects.shape != (objects,):
        raise UsageError(f"object_mask: shape {of_objects.shape}, not ({objects},)")
    of_rays = None if ray_mask is None else indices_of("ray_mask", ray_mask)
    if of_rays is not None and of_rays.shape not in ((), (count,)):
        raise UsageError(f"ray_mask: shape {of_rays.shape}, not () or ({count},)")
    if of_rays is not None and of_objects is None:
        raise UsageError("ray_mask: there is no object_mask")
    one = int(of_rays) if of_rays is not None and of_rays.ndim == 0 else 2**32 - 1
    table = None
    if excluded is not None:
        table = indices_of("excluded", excluded)
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
    t: Numbers
    u: Numbers
    v: Numbers
    primitive: NDArray[numpy.uint32]
    object: NDArray[numpy.uint32]


#: Takes Candidates, returns a bool for each.
Filter = Callable[[Candidates], ArrayLike]


def filter_of(function: Optional[Filter]) -> Optional[Callable[..., Numbers]]:
    if function is None:
        return None
    known = function

    def ask(*arrays: Numbers) -> Numbers:
        answer = numpy.asarray(known(Candidates(*arrays)))
        if answer.shape != arrays[0].shape or answer.dtype != numpy.bool_:
            raise UsageError(
                f"filter: an answer of shape {answer.shape} and {answer.dtype}, not "
                f"{arrays[0].shape} and bool"
            )
        return numpy.ascontiguousarray(answer)

    return ask
