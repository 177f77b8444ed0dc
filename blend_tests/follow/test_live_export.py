# SPDX-License-Identifier: GPL-3.0-or-later
"""What is stored with hair that follows live can be exported, and is read from older files."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live_attributes
from limit_surface.reading import attributes
from live_scenes import check_hair, deforming


def live_hair() -> tuple[bpy.types.Object, bpy.types.Object]:
    ob = deforming("cross")
    return ob, scenes.add_hair(ob, points=4, follow="LIVE")


def export(path: str, last: int) -> None:
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, last
    bpy.ops.wm.usd_export(filepath=path, export_animation=True, export_hair=True)


def test_usd_export_prints_no_warnings(tmp_path, capfd):
    live_hair()
    export(str(tmp_path / "hair.usda"), last=2)
    printed = "".join(capfd.readouterr())
    assert "USD export" in printed
    assert ids.LIVE_WRITTEN not in printed


def comb(hair: bpy.types.Object) -> np.ndarray:
    """Moves all points but the roots, and returns the points."""
    points = scenes.strands(hair).copy()
    points[:, 1:] += 0.05
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", points)
    hair.data.update_tag()
    bpy.context.view_layer.update()
    return points


def test_numbers_of_older_files_are_understood():
    ob, hair = live_hair()
    bpy.context.scene.frame_set(12)
    now = live_attributes.written(hair.data)
    hair.data[ids.LIVE_WRITTEN] = [now.frame, *now.matrix.ravel().tolist()]
    then = live_attributes.written(hair.data)
    assert then.frame == now.frame == 12
    np.testing.assert_array_equal(then.matrix, now.matrix)
    combed = comb(hair)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=1e-5)
    bpy.context.scene.frame_set(20)
    check_hair(ob, hair)
    bpy.context.scene.frame_set(12)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=1e-5)


@pytest.mark.parametrize("value", ["", "twelve", "1 2 3", [1.0, 2.0], 7])
def test_other_values_are_not_believed(value):
    _, hair = live_hair()
    hair.data[ids.LIVE_WRITTEN] = value
    assert live_attributes.written(hair.data) is None
