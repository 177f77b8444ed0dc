# SPDX-License-Identifier: GPL-3.0-or-later
"""A checker, seen from the camera from which it was projected, is straight to within a texel. The
borders of its colors are measured along that camera's rays, on Blender's own mesh.
"""

import re

import bpy
import numpy as np
import projection_truth as truth
import pytest
import scenes
from figures import project_image as picture
from processes import ROOT

SQUARES, TEXELS = 8, 1024
REACH = 3.0  # texels to both sides of a line
STEPS = 41
LOW, HIGH = 0.2, 0.8


def checker(size=512):
    y, x = np.mgrid[:size, :size] * SQUARES // size
    values = np.where((x + y) % 2 == 1, HIGH, LOW)
    image = bpy.data.images.new("Checker", size, size, float_buffer=True, is_data=True)
    image.pixels.foreach_set(
        np.dstack([values] * 3 + [np.ones_like(values)]).astype(np.float32).ravel()
    )
    return image


def places_on_lines(axis, count):
    """Returns places on those sides of the squares that run along the other axis, away from
    corners.
    """
    along = (np.arange(count) + 0.5) / count
    along = along[np.abs(along * SQUARES - np.rint(along * SQUARES)) > 0.25]
    lines = np.arange(1, SQUARES) / SQUARES
    at = np.stack([np.repeat(lines, len(along)), np.tile(along, len(lines))], axis=1)
    return at if axis == 0 else at[:, ::-1]


def crossings(offset, values):
    """Returns where each row of values crosses the middle between both colors; NaN where it does
    not cross it exactly once.
    """
    above = values > (LOW + HIGH) / 2
    changes = above[:, 1:] != above[:, :-1]
    first = changes.argmax(axis=1)
    rows = np.arange(len(values))
    a, b = values[rows, first], values[rows, first + 1]
    share = ((LOW + HIGH) / 2 - a) / np.where(a == b, 1, b - a)
    found = offset[rows, first] + share * (offset[rows, first + 1] - offset[rows, first])
    whole = (np.abs(values[:, [0, -1]] - (LOW + HIGH) / 2) > 0.25).all(axis=1)
    return np.where((changes.sum(axis=1) == 1) & whole, found, np.nan)


def measure(mesh, camera, made, axis, count):
    """Returns the distances of the borders of colors from their lines, in texels."""
    values = truth.pixels(made)[:, :, 0]
    st = places_on_lines(axis, count)
    across = np.eye(2)[axis]
    size = (512, 512)
    step = 0.25 / TEXELS
    pair = [
        mesh.seen(*truth.camera_rays(camera, st + side * step * across, size)) for side in (-1, 1)
    ]
    per_image = np.linalg.norm(pair[1] - pair[0], axis=1) * TEXELS / (2 * step)
    good = np.isfinite(per_image) & (per_image > 0.2 * TEXELS)
    st, per_image = st[good], per_image[good]
    offset = np.linspace(-REACH, REACH, STEPS)
    moved = st[:, None] + (offset / per_image[:, None])[..., None] * across
    uv = mesh.seen(*truth.camera_rays(camera, moved.reshape(-1, 2), size))
    seen = np.isfinite(uv[:, 0]).reshape(-1, STEPS).all(axis=1)
    shown = truth.sampled(values[..., None], np.nan_to_num(uv))[:, 0].reshape(-1, STEPS)
    texels = np.broadcast_to(offset, shown.shape)
    return crossings(texels[seen], shown[seen])


@pytest.fixture
def projected():
    sheet, camera = picture.add_sheet(), picture.add_camera()
    checker()
    scenes.activate(sheet)
    bpy.ops.object.limit_project_image(
        image="Checker",
        camera=camera.name,
        target="Made",
        width=TEXELS,
        height=TEXELS,
        use_float=True,
    )
    subsurf = sheet.modifiers[0]
    subsurf.levels, subsurf.quality = 5, 10
    return truth.FineMesh(sheet), camera, bpy.data.images["Made"]


@pytest.mark.slow
def test_borders_are_straight_to_a_texel(projected):
    mesh, camera, made = projected
    off = np.concatenate([measure(mesh, camera, made, axis, 60) for axis in (0, 1)])
    assert len(off) > 200
    assert np.isfinite(off).mean() > 0.97  # except at the borders of hidden parts
    off = np.abs(off[np.isfinite(off)])
    page = (ROOT / "docs/project_image.md").read_text()
    mean, worst = re.search(r"on average (\S+) texels .*? at most (\S+) texels", page).groups()
    assert off.mean() < float(mean)
    assert off.max() < float(worst) < 1
