# SPDX-License-Identifier: Apache-2.0
"""The example of docs/uv.md runs, and its picture is what the program draws."""

import importlib.util
import re
from pathlib import Path

import limitsurf as ls
import matplotlib.image
import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
BLOCK = 16  # pixels a side


@pytest.fixture(scope="module")
def program():
    spec = importlib.util.spec_from_file_location("uv_pictures", ROOT / "tools/uv_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def differences(one: np.ndarray, other: np.ndarray) -> tuple[float, float]:
    """Of all pixels, and of the worst block of them."""
    error = np.abs(one - other).mean(axis=2)
    rows, columns = (size // BLOCK for size in error.shape)
    blocks = error[: rows * BLOCK, : columns * BLOCK].reshape(rows, BLOCK, columns, BLOCK)
    return error.mean(), blocks.mean(axis=(1, 3)).max()


@pytest.fixture(scope="module")
def shown():
    return matplotlib.image.imread(ROOT / "docs/images/uv_locations.png")[..., :3]


def test_picture_is_up_to_date(program, shown):
    mean, worst = differences(program.picture(), shown)
    assert mean < 0.002
    assert worst < 0.04


class Sabotaged:
    """A map whose texels are not what they should be."""

    def __init__(self, uv_map, spoil):
        self.uv_map, self.spoil = uv_map, spoil
        self.evaluate = uv_map.evaluate

    def rasterize(self, *size, **options):
        texels = self.uv_map.rasterize(*size, **options)
        fields = {name: getattr(texels, name).copy() for name in texels.__slots__}
        self.spoil(fields)
        return ls.Texels(**fields)


def shifted(fields):
    fields["uv"][:] = np.roll(fields["uv"], 3, axis=0)


def without_overlaps(fields):
    fields["overlap"][:] = False


def unmirrored(fields):
    fields["flipped"][:] = False


def nearest_elsewhere(fields):
    outside = ~fields["inside"]
    fields["uv"][outside] = 0.5


@pytest.mark.parametrize("spoil", [shifted, without_overlaps, unmirrored, nearest_elsewhere])
def test_wrong_pictures_are_seen(program, shown, monkeypatch, spoil):
    uv_map, *rest = program.islands()
    monkeypatch.setattr(program, "islands", lambda: (Sabotaged(uv_map, spoil), *rest))
    mean, worst = differences(program.picture(), shown)
    assert mean > 0.002 or worst > 0.04


def test_example():
    side = np.arange(4.0)
    x, y = np.meshgrid(side, side)
    positions = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    first = (np.arange(3) + 4 * np.arange(3)[:, None]).ravel()
    faces = np.stack([first, first + 1, first + 5, first + 4], axis=1)
    known = {
        "np": np,
        "positions": positions,
        "faces": faces,
        "uvs": 0.05 + 0.3 * positions[:, :2],
        "uv_indices": faces.ravel(),
    }
    page = (ROOT / "docs/uv.md").read_text()
    for example in re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL):
        exec(example, known)
    image = known["image"]
    np.testing.assert_allclose(image[512, 100:900], np.tile([0.0, 0, 1], (800, 1)), atol=1e-12)
    assert not image[0].any()
    assert not image[:, 0].any()
    assert np.all(known["found"].face >= 0)
