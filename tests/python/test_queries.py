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
