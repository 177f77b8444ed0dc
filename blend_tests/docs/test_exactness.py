# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers behind the pictures of docs/accuracy.md, without rendering them."""

import numpy as np
import pytest
from figures.exactness import sheet, zoo
from figures.exactness.distances import compare
from PIL import Image
from processes import ROOT

PAGE = (ROOT / "docs/accuracy.md").read_text()


@pytest.mark.every(4)
@pytest.mark.parametrize("name", zoo.FEATURES)
def test_default_quality_is_off_and_the_best_is_not(name):
    feature = zoo.FEATURES[name]()
    compared = compare(zoo.add(feature), 6)
    default, best = compared.distance(3), compared.distance(10)
    assert 1e-3 < default.whole.max() < 0.1
    assert best.whole.max() < 1e-5
    np.testing.assert_allclose(np.hypot(default.along, default.across), default.whole, atol=1e-12)
    # The close-up shows a place where Blender's mesh differs.
    focus = compared.exact[zoo.nearest(compared.exact, feature.focus)]
    worst = compared.exact[default.whole > 0.5 * default.whole.max()]
    nearest = np.linalg.norm(worst - focus, axis=1).min()
    assert nearest < feature.extent / 2 * compared.mean_edge


@pytest.mark.parametrize("name", ["polygons", "uv"])
def test_parameter_lines_run_along_u_and_v(name):
    compared = compare(zoo.add(zoo.FEATURES[name]()), 4)
    lines = compared.parameter_lines(4)
    quads = np.count_nonzero(compared.cage.face_sizes == 4)
    parts = compared.surface.face_count - quads
    assert sum(len(some) for some in lines) == quads * 2 * 5 + parts * 2 * 3
    for some in lines:
        steps = np.diff(compared.exact[some], axis=1)
        assert (np.linalg.norm(steps, axis=2) < compared.mean_edge / 4).all()


def test_colours_darken_with_the_distance():
    brightness = sheet.shades(np.geomspace(sheet.LEAST, sheet.MOST, 50)) @ [0.3, 0.6, 0.1]
    assert (np.diff(brightness) < 0).all()
    assert (sheet.shades(np.array([0.0])) == sheet.shades(np.array([sheet.LEAST]))).all()


def test_sheet_holds_panels_scale_and_notes(tmp_path):
    part, output = tmp_path / "part.png", tmp_path / "sheet.png"
    Image.new("RGBA", (200, 170), (0, 90, 0, 255)).save(part)
    panels = [sheet.Panel(part, "One", (0.5, 0.4, 0.1)), sheet.Panel(part, "Other")]
    sheet.compose(panels, ["A note"], output)
    pixels = np.asarray(Image.open(output).convert("RGB")).astype(int)
    green = (np.abs(pixels - (0, 90, 0)) < 9).all(axis=2)
    assert 0.9 < np.count_nonzero(green) / (2 * 200 * 170) <= 1
    assert (pixels[0] == 255).all()  # the white background
    assert (pixels[-sheet.BOTTOM :].min(axis=2) < 100).any()


def test_page_shows_every_picture_and_its_row():
    for name, make in zoo.FEATURES.items():
        assert (ROOT / f"docs/images/exact_{name}.png").is_file()
        assert f"(images/exact_{name}.png)" in PAGE
        assert f"\n| {make().title} |" in PAGE
