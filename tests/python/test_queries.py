"""All hits, masks, exclusions and filters: beside a brute force in double."""

import numpy
import pytest

import sheaf
from test_geometry import DIRECTIONS, FACES, ORIGINS, VERTICES, brute_force


@pytest.fixture(scope="module")
def all_t():
    return brute_force(VERTICES, FACES, ORIGINS, DIRECTIONS)


@pytest.fixture(scope="module")
def geometry():
    return sheaf.Geometry(VERTICES, FACES, dtype=numpy.float64)


def test_all_hits_are_those_of_a_brute_force(geometry, all_t):
    hits = geometry.all_hits(ORIGINS, DIRECTIONS)
    assert set(zip(hits.ray, hits.primitive)) == set(zip(*numpy.nonzero(numpy.isfinite(all_t))))
    numpy.testing.assert_allclose(hits.t, all_t[hits.ray, hits.primitive], rtol=1e-9)
    same_ray = hits.ray[1:] == hits.ray[:-1]
    assert (hits.t[1:] >= hits.t[:-1])[same_ray].all() and (numpy.diff(hits.ray) >= 0).all()
    place = ORIGINS[hits.ray] + hits.t[:, None] * DIRECTIONS[hits.ray]
    numpy.testing.assert_allclose(hits.point, place, atol=1e-9)
    count = numpy.isfinite(all_t).sum(1)
    assert (geometry.count_hits(ORIGINS, DIRECTIONS) == count).all()
    assert (hits.count == count).all() and count.max() > 3
    two = geometry.all_hits(ORIGINS, DIRECTIONS, max_hits=2)
    assert (two.count == numpy.minimum(count, 2)).all()
    first = two.first[:-1][count > 0].astype(int)
    assert (two.primitive[first] == geometry.closest(ORIGINS, DIRECTIONS).primitive[count > 0]).all()


def test_a_ball_is_entered_and_left():
    hits = sheaf.Geometry(spheres=[[0, 0, 4, 1]]).all_hits((0, 0, 0), [[0, 0, 1], [0, 1, 0]])
    assert hits.t.tolist() == [3, 5] and hits.u.tolist() == [0, 1] and hits.first.tolist() == [0, 2, 2]
    assert hits.point.tolist() == [[0, 0, 3], [0, 0, 5]]


def test_what_is_left_out(geometry, all_t):
    left = all_t.copy()
    nearest = all_t.argmin(1)
    left[numpy.arange(2000), nearest] = numpy.inf
    left[:, 7] = numpy.inf
    excluded = numpy.stack([nearest, numpy.full(2000, 7)], -1)
    hits = geometry.closest(ORIGINS, DIRECTIONS, excluded=excluded)
    assert (hits.hit == numpy.isfinite(left.min(1))).all()
    assert (hits.primitive[hits.hit] == left.argmin(1)[hits.hit]).all()
    assert (geometry.occluded(ORIGINS, DIRECTIONS, excluded=excluded) == hits.hit).all()

    asked = []

    def odd(candidates):
        asked.append(len(candidates.ray))
        assert (candidates.object == 0).all() and candidates.t.dtype == numpy.float64
        return (candidates.primitive + candidates.ray) % 2 == 1

    left = numpy.where(numpy.add.outer(numpy.arange(2000), numpy.arange(100)) % 2 == 1, all_t, numpy.inf)
    hits = geometry.closest(ORIGINS, DIRECTIONS, filter=odd)
    assert (hits.hit == numpy.isfinite(left.min(1))).all()
    assert (hits.primitive[hits.hit] == left.argmin(1)[hits.hit]).all()
    assert (geometry.occluded(ORIGINS, DIRECTIONS, filter=odd) == hits.hit).all()
    assert sum(asked) > 500


def test_masks():
    both = sheaf.Geometry(VERTICES, FACES, spheres=[[0, 0, 0, 1.5]])
    mask = numpy.arange(2000) % 4
    hits = both.closest(ORIGINS, DIRECTIONS, object_mask=[1, 2], ray_mask=mask)
    mesh = sheaf.Geometry(VERTICES, FACES).closest(ORIGINS, DIRECTIONS)
    assert not hits.hit[mask == 0].any()
    assert (hits.primitive[mask == 1] == mesh.primitive[mask == 1]).all()
    assert (hits.object[mask == 2][hits.hit[mask == 2]] == 1).all() and hits.hit[mask == 2].any()
    assert (hits.primitive[mask == 3] == both.closest(ORIGINS, DIRECTIONS).primitive[mask == 3]).all()
    one = both.closest(ORIGINS, DIRECTIONS, object_mask=[1, 2], ray_mask=1)
    assert (one.primitive == mesh.primitive).all()


def test_what_is_wrong_is_named(geometry):
    for options in (
        {"object_mask": [1, 2]},
        {"ray_mask": 1},
        {"object_mask": [1], "ray_mask": [1, 2]},
        {"excluded": [[1]]},
        {"filter": lambda candidates: True},
    ):
        with pytest.raises(sheaf.UsageError, match=list(options)[-1]):
            geometry.closest(ORIGINS, DIRECTIONS, **options)
    with pytest.raises(sheaf.UsageError, match="max_hits"):
        geometry.all_hits(ORIGINS, DIRECTIONS, max_hits=-1)

    def fails(candidates):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        geometry.closest(ORIGINS, DIRECTIONS, filter=fails)


def cube(half, center=(0, 0, 0)):
    corners = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]]
    return corners * half + center, numpy.array([*faces, [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])


def test_inside_and_crossings():
    geometry = sheaf.Geometry(*cube(1), spheres=[[5, 0, 0, 1]])
    points = numpy.random.default_rng(1).uniform(-2, 6, (3000, 3)).astype(numpy.float32)
    points[:500] = numpy.round(points[:500]) + numpy.float32(0.5) * (numpy.arange(500) % 2)[:, None]
    points = points[(abs(abs(points) - 1) > 1e-5).all(1)]
    in_cube = (abs(points) < 1).all(1)
    in_ball = ((points - [5, 0, 0]) ** 2).sum(1) < 1
    assert in_cube.any() and in_ball.any()
    assert (geometry.inside(points) == (in_cube | in_ball)).all()
    assert (geometry.inside(points, object_mask=[1, 2], point_mask=2) == in_ball).all()
    corner = geometry.count_crossings((0, 0, 0), numpy.array([[1, 1, 1], [1, 1, 0], [0, 1, 0]]))
    assert corner.tolist() == [1, 1, 1]
    assert geometry.count_hits((0, 0, 0), [[1, 1, 1]]).tolist() != [1]


def test_nearest():
    geometry = sheaf.Geometry(*cube(1), spheres=[[5, 0, 0, 1]], dtype=numpy.float64)
    points = numpy.random.default_rng(2).uniform(-2, 6, (3000, 3))
    out = numpy.maximum(abs(points) - 1, 0)
    of_cube = numpy.where((out == 0).all(1), (1 - abs(points)).min(1), numpy.linalg.norm(out, axis=1))
    of_ball = abs(numpy.linalg.norm(points - [5, 0, 0], axis=1) - 1)
    nearest = geometry.nearest(points, signed=True)
    numpy.testing.assert_allclose(abs(nearest.distance), numpy.minimum(of_cube, of_ball), atol=1e-14)
    assert ((nearest.distance < 0) == geometry.inside(points)).all()
    assert ((nearest.object == 1) == (of_ball < of_cube)).all()
    way = numpy.linalg.norm(nearest.point - points, axis=1)
    numpy.testing.assert_allclose(way, abs(nearest.distance), atol=1e-14)
    near = geometry.nearest(points, max_distance=0.5)
    far = numpy.minimum(of_cube, of_ball) > 0.5
    assert (near.primitive[far] == sheaf.NO_PRIMITIVE).all() and (near.distance[far] == 0.5).all()
    only = geometry.nearest(points, object_mask=[1, 2], point_mask=1)
    numpy.testing.assert_allclose(only.distance, of_cube, atol=1e-14)


def test_overlaps():
    geometry = sheaf.Geometry(VERTICES, FACES)
    some = numpy.random.default_rng(3).uniform(-3, 3, (200, 3)).astype(numpy.float32)
    balls = numpy.concatenate([some, numpy.full((200, 1), 0.4, numpy.float32)], 1)
    found = geometry.in_balls(balls)
    assert found.count.max() > 3 and (numpy.diff(found.region) >= 0).all()
    for i in range(0, 200, 9):
        mine = found.primitive[found.region == i]
        apart = [k for k in range(100) if sheaf.Geometry(VERTICES, FACES[[k]]).nearest(some[[i]]).distance[0] <= 0.4]
        assert mine.tolist() == apart
    boxes = geometry.in_boxes(some - 0.4, some + 0.4)
    around = geometry.in_boxes([-9, -9, -9], [9, 9, 9])
    assert around.primitive.tolist() == list(range(100))
    # Each box holds its ball.
    for i in range(200):
        assert set(found.primitive[found.region == i]) <= set(boxes.primitive[boxes.region == i])
    assert (boxes.count >= found.count).all()
    with pytest.raises(sheaf.UsageError, match="balls"):
        geometry.in_balls([[0, 0, 0]])
