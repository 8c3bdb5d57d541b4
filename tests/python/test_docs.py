"""The examples of docs/python.md run as they stand, one after another."""

import pathlib
import re
import shutil

import numpy

import sheaf

ROOT = pathlib.Path(__file__).parents[2]


def test_the_examples_run(tmp_path, monkeypatch):
    text = (ROOT / "docs" / "python.md").read_text()
    examples = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(examples) >= 4
    shutil.copy(ROOT / "scenes" / "crystal-ball.json", tmp_path)
    monkeypatch.chdir(tmp_path)
    names = {}
    for example in examples:
        exec(compile(example, "docs/python.md", "exec"), names)
    light = sheaf.read_picture(tmp_path / "rays.png")["rgb"]
    assert light.shape == (64, 64, 3)
    numpy.testing.assert_allclose(light[..., 0].ravel(), numpy.clip(names["light"], 0, 1), atol=0.01)
    assert (tmp_path / "near.png").exists()
