# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects whose own points are placed on a surface are not snapped by their origins."""

import bpy
import pytest
import scenes
from snap_truth import (
    Truth,
    add_object,
    refused_and_unchanged,
    snap,
    stretched,
    world_locations,
)

EXACT = 1e-6  # the error of single precision for objects some units away from the origin


def _points(follow):
    bpy.ops.object.limit_points_add(distribution="UNIFORM", count=9, follow=follow)


def _drawing(follow):
    place = {"name": "", "radius": 1.0, "is_closed": False}
    strokes = [
        place | {"face": 0, "uv": (0.2, 0.3), "is_first": True},
        place | {"face": 1, "uv": (0.5, 0.5), "is_first": False},
    ]
    bpy.ops.view3d.limit_draw(strokes=strokes, follow=follow)


def _limit_mesh(follow):
    bpy.ops.object.limit_mesh(follow=follow)


@pytest.mark.parametrize(
    ("make", "follow"),
    [
        *((_points, follow) for follow in ("NONE", "NODES", "LIVE")),
        *((_drawing, follow) for follow in ("NONE", "NODES")),
        (_limit_mesh, "NODES"),
    ],
)
def test_what_was_made_on_a_surface_is_not_torn_off_by_its_origin(make, follow, capfd):
    target = stretched(scenes.cross())
    scenes.activate(target)
    make(follow)
    made = bpy.context.active_object
    place = made.matrix_world.copy()
    made.select_set(True)
    refused_and_unchanged(target, made, "the object's own points are placed on a surface")
    thing = add_object((3, 4, 5))
    made.select_set(True)
    snap(target)
    assert made.matrix_world == place
    assert Truth(target).distances(world_locations([thing])).max() < EXACT
    assert "1 object could not be snapped: the object's own points" in capfd.readouterr().out
