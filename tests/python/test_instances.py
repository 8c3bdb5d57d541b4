"""Geometries in many places: beside copies of their vertices."""

import numpy
import pytest

import sheaf
from test_geometry import DIRECTIONS, FACES, ORIGINS, VERTICES

RANDOM = numpy.random.default_rng(3)
MAPS = numpy.eye(3, 4) + 0.3 * RANDOM.uniform(-1, 1, (5, 3, 4))


def copies():
    vertices = [VERTICES @ m[:, :3].T + m[:, 3] for m in MAPS]
    faces = [FACES + i * len(VERTICES) for i in range(len(MAPS))]
    return numpy.concatenate(vertices), numpy.concatenate(faces)


def test_instances_are_hit_as_copies_are():
    mesh = sheaf.Geometry(VERTICES, FACES, dtype=numpy.float64)
    instances = sheaf.Instances(mesh, MAPS)
    hits = instances.closest(ORIGINS, DIRECTIONS)
    vertices, faces = copies()
    expected = sheaf.Geometry(vertices, faces, dtype=numpy.float64).closest(ORIGINS, DIRECTIONS)
    assert (hits.hit == expected.hit).all() and hits.hit.any() and not hits.hit.all()
    numpy.testing.assert_allclose(hits.t[hits.hit], expected.t[hits.hit], rtol=1e-9)
    number = hits.instance.astype(int) * len(FACES) + hits.primitive
    assert (number == expected.primitive)[hits.hit].mean() > 0.99
    assert (instances.occluded(ORIGINS, DIRECTIONS) == hits.hit).all()
    assert instances.statistics["instances"] == 5
    assert (instances.bounds[0] <= vertices.min(0)).all()
    # A ray does not hit what it starts on.
    again = instances.closest(
        ORIGINS, DIRECTIONS, source=hits.primitive, source_instance=hits.instance
    )
    same = (again.primitive == hits.primitive) & (again.instance == hits.instance)
    assert not same[hits.hit].any()


def test_several_geometries_and_whole_matrices():
    ball, plate = sheaf.Geometry(spheres=[[0, 0, 0, 1]]), sheaf.Geometry(disks=[[0, 0, 0, 1, 0, 0, 1]])
    maps = numpy.stack([numpy.eye(4), numpy.eye(4)])
    maps[0, :3, 3], maps[1, :3, 3] = (0, 0, 9), (5, 0, 9)
    instances = sheaf.Instances([ball, plate], maps, which=[0, 1])
    hits = instances.closest([[0, 0, 0], [5, 0, 0], [9, 9, 0]], (0, 0, 1))
    assert hits.t.tolist()[:2] == [8, 9]
    assert hits.instance.tolist() == [0, 1, sheaf.NO_INSTANCE]
    assert "2 instances" in repr(instances)


@pytest.mark.parametrize(
    "maps, part",
    [
        (numpy.zeros((3, 3)), "transforms: shape"),
        (numpy.zeros((1, 3, 4)), "place 0: its transform flattens it"),
        (numpy.ones((1, 4, 4)), "last row"),
    ],
)
def test_what_is_wrong_is_said(maps, part):
    with pytest.raises(sheaf.UsageError, match=part):
        sheaf.Instances(sheaf.Geometry(VERTICES, FACES), maps)
    with pytest.raises(sheaf.UsageError, match="geometry 3 of 1"):
        sheaf.Instances(sheaf.Geometry(VERTICES, FACES), MAPS[:1], which=[3])
