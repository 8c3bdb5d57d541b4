"""Scenes, frames, pictures, and what stops a frame."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy
import pytest

import sheaf

ROOT = pathlib.Path(__file__).parents[2]
CRYSTAL_BALL = ROOT / "scenes" / "crystal-ball.json"


@pytest.fixture(scope="module")
def scene():
    return sheaf.read_scene(CRYSTAL_BALL)


def test_a_picture_is_that_of_the_command(scene, tmp_path):
    rgb = scene.render("near", width=64, height=48, samples=2)
    assert rgb.shape == (48, 64, 3) and rgb.dtype == numpy.float32
    path = tmp_path / "near.pfm"
    command = os.environ.get("SHEAF_COMMAND", "")
    if not os.path.exists(command):
        pytest.skip("the command is not built")
    subprocess.run(
        [command, "render", CRYSTAL_BALL, "--camera", "near", "--size", "64x48", "--spp", "2"]
        + ["-q", "-o", path],
        check=True,
    )
    assert sheaf.read_picture(path)["rgb"].tobytes() == rgb.tobytes()


def test_what_a_scene_tells(scene):
    assert scene.settings == {"width": 640, "height": 480, "samples": 1, "max_depth": 5}
    assert [camera.name for camera in scene.cameras][:2] == ["front", "left"] or scene.cameras
    assert all(camera.projection == "perspective" for camera in scene.cameras)
    assert scene.warnings == []


def test_cameras_by_name_number_and_value(scene):
    size = {"width": 24, "height": 18}
    for index, camera in enumerate(scene.cameras):
        expected = scene.render(index, **size)
        assert (scene.render(camera.name, **size) == expected).all()
        assert (scene.render(camera, **size) == expected).all()
    assert (scene.render(**size) == scene.render(0, **size)).all()
    around = sheaf.Camera((0, 0, 0), numpy.array([0, 0, -1]), projection="equirectangular")
    assert scene.render(around, **size).shape == (18, 24, 3)
    wide = sheaf.Camera((0, 0, 0), (0, 0, -1), projection="fisheye", lens=120)
    assert (scene.render(wide, **size) != scene.render(around, **size)).any()


def test_layers(scene):
    layers = scene.render_layers(["depth", "normal", "albedo", "id"], width=32, height=24)
    assert sorted(layers) == ["albedo", "depth", "id", "normal", "rgb"]
    assert layers["depth"].shape == layers["id"].shape == (24, 32)
    assert layers["normal"].shape == layers["albedo"].shape == (24, 32, 3)
    met = numpy.isfinite(layers["depth"])
    assert 0 < met.sum() < met.size
    assert ((layers["id"] > 0) == met).all()
    numpy.testing.assert_allclose(numpy.linalg.norm(layers["normal"], axis=2), met, atol=1e-5)
    assert (layers["rgb"] == scene.render(width=32, height=24)).all()
    # One layer alone keeps its numbers alive.
    depth = layers["depth"]
    expected = depth.copy()
    del layers
    assert (depth == expected).all()


def test_options_change_no_bit_or_the_right_ones(scene):
    size = {"width": 40, "height": 30}
    expected = scene.render(**size)
    for target in sheaf.targets():
        assert (scene.render(target=target, threads=2, **size) == expected).all()
    assert (scene.render(crop=(5, 6, 30, 20), **size) == expected[6:20, 5:30]).all()
    double = scene.render(precision="double", **size)
    assert (double != expected).any() and numpy.abs(double - expected).mean() < 1e-3
    assert (scene.render(max_depth=0, **size) != expected).any()
    statistics = scene.render_statistics(samples=3, **size)
    assert statistics["primary_rays"] == 3 * 40 * 30
    assert statistics["traced_rays"] > statistics["primary_rays"]


MISUSE = [
    ({"camera": "nobody"}, sheaf.UsageError, "nobody"),
    ({"camera": 99}, sheaf.UsageError, "99"),
    ({"camera": sheaf.Camera((0, 0, 0), (0, 0, -1), projection="x")}, sheaf.UsageError, "x"),
    ({"camera": sheaf.Camera((0, 0), (0, 0, -1))}, sheaf.UsageError, "three"),
    ({"camera": sheaf.Camera((0, 0, 0), (0, 0, 0))}, sheaf.SceneError, ""),
    ({"width": 0}, sheaf.UsageError, "width"),
    ({"height": 70000}, sheaf.UsageError, "height"),
    ({"width": 10**12}, sheaf.UsageError, "width"),
    ({"samples": "many"}, TypeError, ""),
    ({"max_depth": -1}, sheaf.UsageError, "max_depth"),
    ({"threads": -2}, sheaf.UsageError, "threads"),
    ({"crop": (0, 0, 0, 0)}, sheaf.UsageError, "crop"),
    ({"crop": (0, 0, 9999, 4)}, sheaf.UsageError, "crop"),
    ({"target": "mmx"}, sheaf.UsageError, "mmx"),
    ({"precision": "half"}, sheaf.UsageError, "half"),
    ({"precision": "fast", "target": "scalar"}, sheaf.UsageError, ""),
]


@pytest.mark.parametrize("options, error, message", MISUSE)
def test_misuse_raises(scene, options, error, message):
    with pytest.raises(error, match=message):
        scene.render(**{"width": 8, "height": 8, **options})


def test_files_that_are_wrong(tmp_path):
    with pytest.raises(sheaf.FileError, match="/nowhere/a.json") as caught:
        sheaf.read_scene("/nowhere/a.json")
    assert isinstance(caught.value, OSError)
    with pytest.raises(sheaf.SceneError, match="odd.json:1"):
        sheaf.parse_scene('{"objects": 7}', "odd.json")
    with pytest.raises(TypeError):
        sheaf.read_scene(b"a.json")
    with pytest.raises(sheaf.UsageError):
        sheaf.read_picture(tmp_path / "a.txt")
    with pytest.raises(TypeError, match="wdth"):
        sheaf.read_scene(CRYSTAL_BALL).render_layers([], wdth=3)
    with pytest.raises(sheaf.UsageError, match="no layer"):
        sheaf.read_scene(CRYSTAL_BALL).render_layers(["deep"], width=4, height=4)


def test_a_model_is_framed_and_lit(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    model = sheaf.read_scene(path, aspect=1)
    rgb = model.render(width=20, height=20)
    assert len(model.cameras) == 1 and rgb.max() > 0.01


def test_pictures_are_written_and_read(tmp_path):
    rgb = numpy.random.default_rng(1).uniform(0, 1, (5, 7, 3))
    for name, options, step in (
        ("a.pfm", {}, 1e-7),
        ("a.png", {}, 0.01),
        ("b.png", {"bits": 16}, 1e-4),
        ("c.png", {"bits": 16, "transfer": "linear"}, 1e-5),
    ):
        sheaf.write_picture(tmp_path / name, rgb, **options)
        back = sheaf.read_picture(tmp_path / name)["rgb"]
        numpy.testing.assert_allclose(back, rgb, atol=step)
    sheaf.write_picture(tmp_path / "d.png", rgb[::-1, :, ::-1], ev=-1, bits=16)
    back = sheaf.read_picture(tmp_path / "d.png")["rgb"]
    numpy.testing.assert_allclose(back, rgb[::-1, :, ::-1] / 2, atol=1e-4)
    for wrong, options in (
        (rgb[0], {}),
        (rgb.astype(complex), {}),
        (rgb, {"bits": 12}),
        (rgb, {"ev": 99}),
        (rgb, {"tone": "dark"}),
        (numpy.zeros((0, 4, 3)), {}),
    ):
        with pytest.raises(sheaf.UsageError):
            sheaf.write_picture(tmp_path / "e.png", wrong, **options)
    with pytest.raises(sheaf.FileError):
        sheaf.write_picture("/nowhere/a.png", rgb)
    assert not (tmp_path / "e.png").exists()


def test_progress_and_its_exceptions(scene):
    seen = []
    scene.render(width=320, height=240, samples=16, threads=1, progress=seen.append)
    assert seen == sorted(seen) and all(0 <= pixels <= 320 * 240 for pixels in seen)

    def give_up(pixels):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        scene.render(width=4000, height=4000, samples=64, progress=give_up)


def test_control_c_ends_a_frame(scene):
    def interrupt():
        time.sleep(0.2)
        os.kill(os.getpid(), signal.SIGINT)

    interrupter = threading.Thread(target=interrupt)
    interrupter.start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        scene.render(width=8000, height=8000, samples=1024)
    interrupter.join()
    assert time.monotonic() - begin < 60  # the frame would take an hour


def test_frames_side_by_side(scene):
    expected = scene.render(width=60, height=40)
    made = []
    threads = [
        threading.Thread(target=lambda: made.append(scene.render(width=60, height=40)))
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(made) == 4 and all((rgb == expected).all() for rgb in made)


def test_everything_public_is_documented():
    for name in sheaf.__all__:
        thing = getattr(sheaf, name)
        if not callable(thing):
            continue
        assert name in ("build_info", "targets") or thing.__doc__, name
        members = vars(thing).items() if isinstance(thing, type) else ()
        for member, value in members:
            if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                assert value.__doc__, f"{name}.{member}"
    assert sheaf.__version__ in sheaf.build_info()
    assert sys.version_info >= (3, 9)
