# SPDX-License-Identifier: Apache-2.0
"""The Python example of docs/project_image.md runs, and its picture is the program's."""

import re
from pathlib import Path

import limitsurf as ls
import matplotlib.image
import numpy as np
import pytest
from figures import comparison
from figures import projection as program

ROOT = Path(__file__).parents[2]
BLOCK = 20  # pixels along each side


@pytest.mark.slow
def test_picture_is_up_to_date():
    shown = matplotlib.image.imread(ROOT / "docs/images/projection.png")[..., :3]
    mean, worst = comparison.of_plots(program.picture(), shown, BLOCK)
    assert mean < 0.004
    assert worst < 0.03


def test_wrong_pictures_are_seen(monkeypatch):
    shown = matplotlib.image.imread(ROOT / "docs/images/projection.png")[: program.PANEL, :, :3]
    project = ls.LimitSurface.project

    def through(surface, *args, **options):
        return project(surface, *args, **options | {"occlusion": False})

    monkeypatch.setattr(ls.LimitSurface, "project", through)
    drawn = program.side_by_side(program.top_row())
    assert comparison.of_plots(drawn, shown, BLOCK)[1] > 0.06


def test_example(sheet):
    positions, faces = sheet["positions"], sheet["faces"]
    # looks straight down on the square from (-2, -2) to (2, 2)
    camera = np.diag([0.5, 0.5, -0.1, 1.0])
    known = {
        **sheet,
        "uvs": positions[:, :2] / 3,
        "uv_indices": faces.ravel(),
        "camera_matrix": camera,
        "pixels": np.tile(np.float32([1, 0.5, 0, 1]), (8, 8, 1)),
        "texture": np.zeros((512, 512, 4), np.float32),
    }
    page = (ROOT / "docs/project_image.md").read_text().split("\n## In Python\n")[1]
    (example,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    exec(example, known)
    texture = known["texture"]
    np.testing.assert_allclose(texture[:330, :330], np.broadcast_to([1, 0.5, 0, 1], (330, 330, 4)))
    assert not texture[350:].any()
