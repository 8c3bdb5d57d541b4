"""Rays against triangles, spheres and disks: beside a brute force in double, as arrays lie in memory."""

import threading
import time

import numpy
import pytest

import sheaf

RANDOM = numpy.random.default_rng(5)
VERTICES = RANDOM.uniform(-3, 3, (300, 3)).astype(numpy.float32)
FACES = numpy.arange(300, dtype=numpy.uint32).reshape(100, 3)
ORIGINS = RANDOM.uniform(-4, 4, (2000, 3)).astype(numpy.float32)
DIRECTIONS = RANDOM.uniform(-1, 1, (2000, 3)).astype(numpy.float32)


def brute_force(vertices, faces, origins, directions):
    """t of every ray (rows) with every triangle (columns), infinite where they do not meet, by
    Moeller and Trumbore 1997 in double."""
    a, b, c = (vertices[faces[:, k]].astype(float) for k in range(3))
    o, d = origins[:, None].astype(float), directions[:, None].astype(float)
    p = numpy.cross(d, c - a)
    det = (p * (b - a)).sum(-1)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        u = ((o - a) * p).sum(-1) / det
        q = numpy.cross(o - a, b - a)
        v = (d * q).sum(-1) / det
        t = ((c - a) * q).sum(-1) / det
    return numpy.where((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0), t, numpy.inf)


@pytest.mark.parametrize("dtype, tolerance", [(numpy.float32, 1e-4), (numpy.float64, 1e-9)])
def test_closest_is_that_of_a_brute_force(dtype, tolerance):
    all_t = brute_force(VERTICES, FACES, ORIGINS, DIRECTIONS)
    expected = all_t.min(1)
    geometry = sheaf.Geometry(VERTICES, FACES, dtype=dtype)
    hits = geometry.closest(ORIGINS.astype(dtype), DIRECTIONS.astype(dtype))
    assert hits.t.dtype == dtype and len(hits) == 2000
    hit = numpy.isfinite(expected)
    assert 200 < hit.sum() < 1900
    assert (hits.hit == hit).mean() > 0.999  # at edges a rounding decides
    both = hits.hit & hit
    numpy.testing.assert_allclose(hits.t[both], expected[both], rtol=tolerance)
    assert (hits.primitive[both] == all_t.argmin(1)[both]).mean() > 0.999
    assert (hits.primitive[~hits.hit] == sheaf.NO_PRIMITIVE).all()
    expected_point = ORIGINS + expected[:, None] * DIRECTIONS.astype(float)
    numpy.testing.assert_allclose(hits.point[both], expected_point[both], atol=30 * tolerance)
    u, v = hits.u[both, None].astype(float), hits.v[both, None].astype(float)
    corners = VERTICES[FACES[hits.primitive[both]]].astype(float)
    place = (1 - u - v) * corners[:, 0] + u * corners[:, 1] + v * corners[:, 2]
    numpy.testing.assert_allclose(place, expected_point[both], atol=100 * tolerance)
    assert (geometry.occluded(ORIGINS, DIRECTIONS) == hits.hit).all()


def test_normals_face_the_ray_and_follow_the_vertices():
    flat = sheaf.Geometry(VERTICES, FACES).closest(ORIGINS, DIRECTIONS)
    hit = flat.hit
    edges = VERTICES[FACES].astype(float)
    normal = numpy.cross(edges[:, 1] - edges[:, 0], edges[:, 2] - edges[:, 0])
    normal /= numpy.linalg.norm(normal, axis=1)[:, None]
    of_hits = normal[flat.primitive[hit]]
    cosine = (of_hits * DIRECTIONS[hit]).sum(1)
    expected = numpy.where(cosine[:, None] > 0, -of_hits, of_hits)
    numpy.testing.assert_allclose(flat.face_normal[hit], expected, atol=1e-4)
    assert (flat.normal == flat.face_normal).all()
    assert (flat.side[hit] == (cosine > 0)).all()
    assert (flat.normal[~hit] == 0).all()
    smooth = sheaf.Geometry(VERTICES, FACES, normals=numpy.tile([0, 0, 2.0], (300, 1)))
    up = smooth.closest(ORIGINS, DIRECTIONS).normal[hit]
    numpy.testing.assert_allclose(numpy.abs(up[:, 2]), 1, atol=1e-5)


def test_spheres_disks_and_the_numbers_of_objects():
    geometry = sheaf.Geometry(
        [[-1, -1, -9], [1, -1, -9], [0, 1, -9]],
        [[0, 1, 2]],
        spheres=[[5, 0, -4, 0.5], [10, 0, -4, 1]],
        disks=[[15, 0, -3, 1, 0, 0, 1]],
    )
    assert geometry.first_primitives.tolist() == [0, 1, 3, 4]
    hits = geometry.closest([[x, 0, 0] for x in (0, 5, 10, 15, 20)], (0, 0, -1))
    assert hits.object.tolist() == [0, 1, 1, 2, sheaf.NO_PRIMITIVE]
    assert hits.primitive.tolist() == [0, 1, 2, 3, sheaf.NO_PRIMITIVE]
    assert hits.t[:4].tolist() == [9, 3.5, 3, 3]
    statistics = geometry.statistics
    assert (statistics["triangles"], statistics["spheres"], statistics["disks"]) == (1, 2, 1)
    assert statistics["objects"] == 3 and statistics["bytes"] > 100
    numpy.testing.assert_allclose(geometry.bounds, [[-1, -1, -9], [16, 1, -3]], atol=1e-4)
    assert repr(hits) == "<sheaf.Hits: 4 of 5 rays hit>"
    assert repr(geometry) == "<sheaf.Geometry: 4 primitives, float32>"


def test_where_rays_go_on():
    geometry = sheaf.Geometry(spheres=[[0, 0, -4, 1]])
    hits = geometry.closest((0, 0, 0), (0, 0.1, -1))
    again = geometry.closest(hits.front, hits.normal, source=hits.front_source)
    assert not again.hit.any()
    inside = geometry.closest(hits.back, (0, 0.1, -1), source=hits.back_source)
    assert inside.hit.all() and inside.side.tolist() == [1]
    assert not geometry.occluded(hits.front, hits.normal, source=hits.front_source).any()


def test_every_target_gives_the_same_bits():
    geometry = sheaf.Geometry(VERTICES, FACES)
    expected = geometry.closest(ORIGINS, DIRECTIONS)
    assert sheaf.targets()[-1] == "scalar" and len(sheaf.targets()) > 1
    for target in sheaf.targets():
        for coherence in ("unknown", "common origin", "coherent", "incoherent"):
            hits = geometry.closest(ORIGINS, DIRECTIONS, target=target, coherence=coherence)
            for name in ("t", "primitive", "object", "u", "v"):
                assert getattr(hits, name).tobytes() == getattr(expected, name).tobytes()
            assert hits.front.tobytes() == expected.front.tobytes()


def test_intervals():
    geometry = sheaf.Geometry(disks=[[0, 0, -z, 9, 0, 0, 1] for z in (1, 2, 3)])
    far = numpy.array([0.5, 1, 1.5, 9], numpy.float32)
    rays = (numpy.zeros((4, 3)), (0, 0, -1))
    assert geometry.closest(*rays, t_max=far).t.tolist() == [0.5, 1, 1, 1]
    assert geometry.occluded(*rays, t_max=far).tolist() == [False, True, True, True]
    assert geometry.closest(*rays, t_min=1.5).primitive.tolist() == [1] * 4
    assert geometry.closest(*rays, t_min=far * 2).t.tolist()[:3] == [1, 2, 3]


LAYOUTS = {
    "rows": lambda a: a.copy(),
    "columns": lambda a: numpy.asfortranarray(a),
    "part of a table": lambda a: numpy.hstack([a, numpy.full((len(a), 2), 7, a.dtype)])[:, :3],
    "every second": lambda a: numpy.repeat(a, 2, axis=0)[::2],
    "backwards": lambda a: a[::-1].copy()[::-1],
    "x, y, z reversed": lambda a: a[:, ::-1].copy()[:, ::-1],
    "other byte order": lambda a: a.astype(a.dtype.newbyteorder()),
    "doubles": lambda a: a.astype(numpy.float64),
    "lists": lambda a: a.tolist(),
    "unaligned": lambda a: numpy.frombuffer(b"x" + a.tobytes(), a.dtype, offset=1).reshape(a.shape),
    "read-only": lambda a: numpy.frombuffer(a.tobytes(), a.dtype).reshape(a.shape),
}


@pytest.mark.parametrize("starts", LAYOUTS)
@pytest.mark.parametrize("ways", ["rows", "columns", "part of a table", "backwards"])
def test_any_layout_gives_the_same_bits(starts, ways):
    geometry = sheaf.Geometry(VERTICES, FACES)
    expected = geometry.closest(ORIGINS, DIRECTIONS)
    source = numpy.where(expected.hit, expected.primitive, sheaf.NO_PRIMITIVE)
    beyond = geometry.closest(ORIGINS, DIRECTIONS, source=source)
    origins, directions = LAYOUTS[starts](ORIGINS), LAYOUTS[ways](DIRECTIONS)
    hits = geometry.closest(origins, directions)
    assert hits.t.tobytes() == expected.t.tobytes()
    assert hits.point.tobytes() == expected.point.tobytes()
    for ids in (source, source.astype(numpy.int64), numpy.repeat(source, 3)[::3]):
        again = geometry.closest(origins, directions, source=ids)
        assert again.primitive.tobytes() == beyond.primitive.tobytes()
    assert (beyond.primitive[expected.hit] != expected.primitive[expected.hit]).all()


def test_arrays_of_the_right_type_are_read_in_place():
    from sheaf import _arrays

    f32 = numpy.dtype(numpy.float32)
    for layout in ("rows", "columns", "part of a table", "every second", "read-only"):
        origins, directions = LAYOUTS[layout](ORIGINS), LAYOUTS[layout](DIRECTIONS)
        starts, ways = _arrays.vectors_of(origins, directions, f32)
        assert numpy.shares_memory(starts, origins) and numpy.shares_memory(ways, directions)
    assert numpy.shares_memory(_arrays.table_of("vertices", VERTICES, f32, 3), VERTICES)
    assert numpy.shares_memory(_arrays.indices_of("faces", FACES), FACES)


def test_no_rays_and_no_objects():
    nothing = numpy.zeros((0, 3), numpy.float32)
    hits = sheaf.Geometry(VERTICES, FACES).closest(nothing, nothing)
    assert len(hits) == 0 and hits.normal.shape == (0, 3)
    empty = sheaf.Geometry()
    assert not empty.occluded(ORIGINS, DIRECTIONS).any()
    assert empty.bounds[0, 0] > empty.bounds[1, 0]
    assert sheaf.Geometry(nothing, nothing.astype(int)).statistics["primitives"] == 0


def test_a_geometry_keeps_nothing_of_the_arrays():
    vertices, faces = VERTICES.copy(), FACES.copy()
    geometry = sheaf.Geometry(vertices, faces)
    expected = geometry.closest(ORIGINS, DIRECTIONS).t.copy()
    vertices[:], faces[:] = 0, 0
    del vertices, faces
    assert (geometry.closest(ORIGINS, DIRECTIONS).t == expected).all()
    # Hits keep rays and geometry alive until the points are asked for.
    hits = sheaf.Geometry(VERTICES, FACES).closest(ORIGINS.copy(), DIRECTIONS.copy())
    assert (hits.point == geometry.closest(ORIGINS, DIRECTIONS).point).all()


MISUSE = [
    (lambda: sheaf.Geometry(VERTICES), "one without the other"),
    (lambda: sheaf.Geometry(VERTICES[:, :2], FACES), r"vertices: shape \(300, 2\)"),
    (lambda: sheaf.Geometry(VERTICES, FACES[:, :2]), r"faces: shape \(100, 2\)"),
    (lambda: sheaf.Geometry(VERTICES, FACES + 1), "object 0"),
    (lambda: sheaf.Geometry(VERTICES, FACES.astype(int) - 1), "faces: below 0"),
    (lambda: sheaf.Geometry(VERTICES, FACES.astype(float)), "whole numbers"),
    (lambda: sheaf.Geometry(VERTICES, FACES, normals=VERTICES[1:]), "normals"),
    (lambda: sheaf.Geometry(VERTICES * numpy.nan, FACES), "object 0"),
    (lambda: sheaf.Geometry(spheres=[[0, 0, 0, -1]]), "radius"),
    (lambda: sheaf.Geometry(VERTICES, FACES, dtype=numpy.float16), "float16"),
    (lambda: sheaf.Geometry(VERTICES, FACES, threads=-1), "threads"),
    (lambda: sheaf.Geometry(VERTICES.astype(complex), FACES), "complex"),
    (lambda: sheaf.Geometry(VERTICES, FACES).closest(ORIGINS, DIRECTIONS[1:]), "2000 rows"),
    (lambda: sheaf.Geometry(VERTICES, FACES).closest(ORIGINS[:, :2], DIRECTIONS), "origins"),
    (lambda: sheaf.Geometry(VERTICES, FACES).closest(ORIGINS, [["a"] * 3] * 2000), "directions"),
    (lambda: sheaf.Geometry(VERTICES, FACES).closest(ORIGINS, DIRECTIONS, t_max=[1, 2]), "t_max"),
    (lambda: sheaf.Geometry(VERTICES, FACES).closest(ORIGINS, DIRECTIONS, source=[1]), "source"),
    (lambda: sheaf.Geometry(VERTICES, FACES).closest(ORIGINS, DIRECTIONS, target="mmx"), "mmx"),
    (lambda: sheaf.Geometry(VERTICES, FACES).closest(ORIGINS, DIRECTIONS, coherence="so"), "so"),
]


@pytest.mark.parametrize("call, message", MISUSE)
def test_misuse_raises(call, message):
    with pytest.raises(sheaf.UsageError, match=message) as caught:
        call()
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, sheaf.Error)


def test_what_is_not_finite():
    vertices = VERTICES.copy()
    vertices[4, 1] = numpy.inf
    geometry = sheaf.Geometry(vertices, FACES, not_finite="skip")
    assert geometry.statistics["skipped"] == 1
    directions = DIRECTIONS.copy()
    directions[::2] = numpy.nan
    assert not geometry.closest(ORIGINS, directions).hit[::2].any()
    assert not geometry.closest(ORIGINS, DIRECTIONS.astype(float) * 1e300).hit.any()


def test_other_threads_run_meanwhile():
    side = 300
    x, y = numpy.meshgrid(numpy.arange(side), numpy.arange(side))
    vertices = numpy.stack([x, y, numpy.sin(x * y)], -1).reshape(-1, 3)
    corner = (numpy.arange(side - 1)[:, None] * side + numpy.arange(side - 1)).ravel()
    faces = numpy.stack([corner, corner + 1, corner + side], -1)
    rays = RANDOM.uniform(0, side, (400_000, 3))
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.0005)

    counter = threading.Thread(target=count)
    counter.start()
    try:
        geometry = sheaf.Geometry(vertices, faces)
        origins = rays.astype(numpy.float32)
        directions = (rays[::-1] - side / 2).astype(numpy.float32)
        begin, before = time.monotonic(), counted[0]
        geometry.closest(origins, directions, target="scalar")
        seconds, ticks = time.monotonic() - begin, counted[0] - before
    finally:
        stop.set()
        counter.join()
    assert seconds > 0.02
    assert ticks > 3


@pytest.mark.parametrize("dtype", [numpy.float32, numpy.float64])
def test_an_update_has_the_hits_of_a_new_geometry(dtype):
    geometry = sheaf.Geometry(VERTICES, FACES, dtype=dtype)
    moved = VERTICES + RANDOM.uniform(-0.01, 0.01, VERTICES.shape).astype(numpy.float32)
    for faces, rebuilt in ((FACES, False), (FACES[:90], True)):
        assert geometry.update(moved, faces) is rebuilt
        fresh = sheaf.Geometry(moved, faces, dtype=dtype)
        rays = ORIGINS.astype(dtype), DIRECTIONS.astype(dtype)
        assert (geometry.closest(*rays).t == fresh.closest(*rays).t).all()
        assert (geometry.bounds == fresh.bounds).all()
    assert geometry.update(moved[::-1], faces, rebuild_ratio=numpy.inf) is False
    assert geometry.update(moved, faces, rebuild_ratio=0) is True
    with pytest.raises(sheaf.UsageError, match="vertex 300 of 300"):
        geometry.update(moved, [[0, 1, 300]])


@pytest.mark.parametrize("dtype", [numpy.float32, numpy.float64])
def test_a_saved_geometry_has_the_same_hits(dtype, tmp_path):
    geometry = sheaf.Geometry(VERTICES, FACES, dtype=dtype)
    path = tmp_path / "soup.sheaf"
    geometry.save(path)
    rays = ORIGINS.astype(dtype), DIRECTIONS.astype(dtype)
    for check in ("all", "header"):
        mapped = sheaf.Geometry.map(path, dtype=dtype, check=check)
        assert mapped.dtype == dtype
        assert (mapped.closest(*rays).t == geometry.closest(*rays).t).all()
        assert (mapped.inside(ORIGINS[:50]) == geometry.inside(ORIGINS[:50])).all()
    other = numpy.float64 if dtype == numpy.float32 else numpy.float32
    with pytest.raises(sheaf.FileError, match="soup.sheaf"):
        sheaf.Geometry.map(path, dtype=other)
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(sheaf.FileError, match="soup.sheaf"):
        sheaf.Geometry.map(str(path), dtype=dtype)
    with pytest.raises(sheaf.FileError, match="nowhere"):
        geometry.save(tmp_path / "nowhere" / "soup.sheaf")
    with pytest.raises(sheaf.UsageError, match='"some"'):
        sheaf.Geometry.map(path, check="some")
