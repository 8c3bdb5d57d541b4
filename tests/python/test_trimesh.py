"""The stand-in for trimesh's rays: beside a brute force, and beside trimesh where it is installed."""

import types

import numpy
import pytest

from sheaf.trimesh import RayMeshIntersector
from test_geometry import brute_force

RANDOM = numpy.random.default_rng(9)


def sphere(rings=12):
    """A closed mesh whose triangles face outward."""
    vertices = [[0, 0, 1]]
    for i in range(1, rings):
        for j in range(2 * rings):
            a, b = numpy.pi * i / rings, numpy.pi * j / rings
            vertices.append([numpy.sin(a) * numpy.cos(b), numpy.sin(a) * numpy.sin(b), numpy.cos(a)])
    vertices.append([0, 0, -1])
    last, around, faces = len(vertices) - 1, 2 * rings, []
    for j in range(around):
        k = (j + 1) % around
        faces.append([0, 1 + j, 1 + k])
        for i in range(rings - 2):
            p, q = 1 + i * around, 1 + (i + 1) * around
            faces += [[p + j, q + j, q + k], [p + j, q + k, p + k]]
        tail = 1 + (rings - 2) * around
        faces.append([tail + j, last, tail + k])
    return types.SimpleNamespace(vertices=numpy.array(vertices), faces=numpy.array(faces))


@pytest.fixture(scope="module")
def mesh():
    """Two balls, one within the other, and one beside them."""
    ball = sphere()
    count = len(ball.vertices)
    return types.SimpleNamespace(
        vertices=numpy.vstack([ball.vertices, ball.vertices * 3, ball.vertices + [9, 0, 0]]),
        faces=numpy.vstack([ball.faces, ball.faces + count, ball.faces + 2 * count]),
    )


@pytest.fixture(scope="module")
def rays():
    origins = RANDOM.uniform(-5, 5, (500, 3))
    return origins, RANDOM.uniform(-4, 4, (500, 3)) - origins


def test_all_hits_are_those_of_a_brute_force(mesh, rays):
    all_t = brute_force(mesh.vertices, mesh.faces, *rays)
    expected = {(ray, tri) for ray, tri in zip(*numpy.nonzero(numpy.isfinite(all_t)))}
    tri, ray, place = RayMeshIntersector(mesh).intersects_id(*rays, return_locations=True)
    assert {(r, t) for r, t in zip(ray, tri)} == expected
    assert len(ray) == len(expected) > 500
    way = all_t[ray, tri][:, None]
    numpy.testing.assert_allclose(place, rays[0][ray] + way * rays[1][ray], atol=1e-9)
    # Of each ray the nearest comes first.
    for r in range(0, 500, 7):
        assert (numpy.diff(all_t[r, tri[ray == r]]) > 0).all()


def test_the_other_calls_agree_with_it(mesh, rays):
    intersector = RayMeshIntersector(mesh)
    tri, ray = intersector.intersects_id(*rays)
    places, ray_of_place, tri_of_place = intersector.intersects_location(*rays)
    assert (ray_of_place == ray).all() and (tri_of_place == tri).all()
    assert places.shape == (len(ray), 3)
    first = intersector.intersects_first(*rays)
    assert first.shape == (500,) and (first == -1).any()
    for r in range(500):
        hits = tri[ray == r]
        assert first[r] == (hits[0] if len(hits) else -1)
    assert (intersector.intersects_any(*rays) == (first != -1)).all()
    tri, ray = intersector.intersects_id(*rays, multiple_hits=False)
    assert (tri == first[first != -1]).all() and (ray == numpy.nonzero(first != -1)[0]).all()
    tri, ray = intersector.intersects_id(*rays, max_hits=2)
    assert numpy.bincount(ray).max() == 2


def test_no_hits(mesh):
    intersector = RayMeshIntersector(mesh)
    away = [[0, 0, 9.0]], [[0, 0, 1.0]]
    places, ray, tri = intersector.intersects_location(*away)
    assert places.shape == (0, 3) and ray.shape == tri.shape == (0,)
    assert intersector.intersects_first(*away).tolist() == [-1]


def test_a_ray_through_an_edge_hits_once():
    square = types.SimpleNamespace(
        vertices=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], faces=[[0, 1, 2], [0, 2, 3]]
    )
    at = numpy.linspace(0.01, 0.99, 99)
    origins = numpy.stack([at, at, numpy.ones(99)], -1)
    tri, ray = RayMeshIntersector(square).intersects_id(origins, [[0, 0, -1.0]] * 99)
    assert ray.tolist() == list(range(99))


def test_points_inside():
    ball = sphere()
    points = RANDOM.uniform(-1.2, 1.2, (2000, 3))
    edges = ball.vertices[ball.faces]
    normals = numpy.cross(edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0])
    inside = ((points[:, None] - edges[None, :, 0]) * normals).sum(-1).max(1) < 0  # it is convex
    assert 500 < inside.sum() < 1500
    assert (RayMeshIntersector(ball).contains_points(points) == inside).all()
    # Rays along x meet vertices and edges of this one, and its faces may show any way.
    ball.faces[::2] = ball.faces[::2, ::-1]
    middle = numpy.zeros((41, 3))
    middle[:, 0] = numpy.linspace(-2, 2, 41)
    assert (RayMeshIntersector(ball).contains_points(middle) == (abs(middle[:, 0]) < 0.999)).all()
    ball.is_watertight = False
    with pytest.raises(ValueError):
        RayMeshIntersector(ball).contains_points(points)


def test_beside_trimesh(rays):
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("rtree")
    mesh = trimesh.creation.icosphere(subdivisions=2, radius=3)
    theirs = trimesh.ray.ray_triangle.RayMeshIntersector(mesh)
    ours = RayMeshIntersector(mesh)
    found = [
        sorted(zip(*(index.tolist() for index in reversed(which.intersects_id(*rays)))))
        for which in (theirs, ours)
    ]
    assert found[0] == found[1]
    assert (theirs.intersects_first(*rays) == ours.intersects_first(*rays)).all()
    assert (theirs.intersects_any(*rays) == ours.intersects_any(*rays)).all()
    points = rays[0]
    assert (theirs.contains_points(points) == ours.contains_points(points)).all()
