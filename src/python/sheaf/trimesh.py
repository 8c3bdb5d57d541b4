"""Sheaf in place of trimesh's own rays: `mesh.ray = sheaf.trimesh.RayMeshIntersector(mesh)`.

The methods, their arguments and results are those of `trimesh.ray.ray_triangle.RayMeshIntersector`.
Rays are traced in double, as trimesh does. trimesh itself is not needed: a mesh is anything that has
`vertices`, (V, 3), and `faces`, (F, 3).
"""

from __future__ import annotations

from typing import Any, Optional, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from ._geometry import Geometry

_Floats = NDArray[numpy.float64]
_Indices = NDArray[numpy.int64]
_Identified = Union[Tuple[_Indices, _Indices], Tuple[_Indices, _Indices, _Floats]]

# Hits of one ray that are nearer to each other than this part of their distance are one place: a ray
# through an edge meets both its triangles there, and counts once, as with trimesh.
_SAME_PLACE = 1e-12


class RayMeshIntersector:
    """Rays against a mesh. The tree is built once, of the mesh as it is now."""

    def __init__(self, geometry: Any, scale_to_box: bool = True):
        """scale_to_box is taken for trimesh's sake: Sheaf needs none."""
        del scale_to_box
        self.mesh = geometry
        self._geometry = Geometry(
            numpy.asarray(geometry.vertices), numpy.asarray(geometry.faces), dtype=numpy.float64
        )

    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        return_locations: bool = False,
        multiple_hits: bool = True,
        max_hits: Optional[int] = None,
        **kwargs: Any,
    ) -> _Identified:
        """(index_tri, index_ray), and with return_locations the places: arrays of length M, (M, 3).

        Hits of all rays, the nearest of all first, then the second ones and so on; without
        multiple_hits the nearest alone. max_hits: at most so many a ray.
        """
        del kwargs
        triangles, rays, places = self._hits(
            ray_origins, ray_directions, max_hits if multiple_hits else 1
        )
        return (triangles, rays, places) if return_locations else (triangles, rays)

    def intersects_location(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any
    ) -> Tuple[_Floats, _Indices, _Indices]:
        """(locations, index_ray, index_tri) of all hits: (M, 3), (M,), (M,). Else as intersects_id."""
        kwargs["return_locations"] = True
        triangles, rays, places = self.intersects_id(  # type: ignore[misc]
            ray_origins, ray_directions, **kwargs
        )
        return places, rays, triangles

    def intersects_first(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any
    ) -> _Indices:
        """(N,): the triangle that each ray meets first, -1 where it meets none."""
        del kwargs
        hits = self._geometry.closest(ray_origins, ray_directions)
        return numpy.where(hits.hit, hits.primitive.astype(numpy.int64), -1)

    def intersects_any(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, **kwargs: Any
    ) -> NDArray[numpy.bool_]:
        """(N,) bool: whether each ray meets any triangle."""
        del kwargs
        return self._geometry.occluded(ray_origins, ray_directions)

    def contains_points(self, points: ArrayLike) -> NDArray[numpy.bool_]:
        """(N,) bool: whether each point lies inside a closed mesh: a ray from there crosses it an odd
        number of times, edges and vertices counted exactly. What lies on the surface is on either
        side. Raises ValueError for a mesh that says that it is not closed.
        """
        if not getattr(self.mesh, "is_watertight", True):
            raise ValueError("the mesh is not closed: it has no inside")
        return self._geometry.inside(points)

    def _hits(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, most: Optional[int]
    ) -> Tuple[_Indices, _Indices, _Floats]:
        """The triangle, the ray and the place of each hit: first hits, then second ones, and so on."""
        if most == 1:
            nearest = self._geometry.closest(ray_origins, ray_directions)
            rays = numpy.nonzero(nearest.hit)[0]
            return nearest.primitive[rays].astype(numpy.int64), rays, nearest.point[rays]
        hits = self._geometry.all_hits(ray_origins, ray_directions)
        is_same = (hits.ray[1:] == hits.ray[:-1]) & (hits.t[1:] <= hits.t[:-1] * (1 + _SAME_PLACE))
        told = numpy.nonzero(numpy.concatenate([[True], ~is_same]))[0][: None if len(hits) else 0]
        # Which of its ray's hits each one is.
        rays = hits.ray[told]
        rank = numpy.arange(len(rays)) - numpy.searchsorted(rays, rays)
        order = numpy.argsort(rank, kind="stable")
        if most is not None:
            order = order[rank[order] < most]
        return (
            hits.primitive[told[order]].astype(numpy.int64),
            rays[order],
            numpy.ascontiguousarray(hits.point[told[order]]),
        )
