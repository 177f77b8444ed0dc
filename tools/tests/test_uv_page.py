# SPDX-License-Identifier: Apache-2.0
"""The example of docs/uv.md runs, and its picture is what the program draws."""

import re
from pathlib import Path

import limitsurf as ls
import matplotlib.image
import numpy as np
import pytest
from figures import comparison
from figures import uv as program

ROOT = Path(__file__).parents[2]
BLOCK = 16  # pixels along each side


@pytest.fixture(scope="module")
def shown():
    return matplotlib.image.imread(ROOT / "docs/images/uv_locations.png")[..., :3]


def test_picture_is_up_to_date(shown):
    mean, worst = comparison.of_plots(program.picture(), shown, BLOCK)
    assert mean < 0.002
    assert worst < 0.04


class Sabotaged:
    """A map whose texels are deliberately wrong."""

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
def test_wrong_pictures_are_seen(shown, monkeypatch, spoil):
    uv_map, *rest = program.islands()
    monkeypatch.setattr(program, "islands", lambda: (Sabotaged(uv_map, spoil), *rest))
    mean, worst = comparison.of_plots(program.picture(), shown, BLOCK)
    assert mean > 0.002 or worst > 0.04


def test_example(sheet):
    positions, faces = sheet["positions"], sheet["faces"]
    known = {
        "np": np,
        **sheet,
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
