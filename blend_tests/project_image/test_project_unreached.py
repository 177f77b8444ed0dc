# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of which nothing arrives on the surface: the message names the reasons that are possible
with the properties that were chosen.
"""

import math

import bpy
import numpy as np
import projection_truth as truth
import pytest
import scenes

NOTHING = "No part of the image Shown reaches the surface"


@pytest.fixture
def square():
    """A square that faces up, seen from below."""
    positions = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    ob = scenes.add_mesh("Square", positions, [(0, 1, 2, 3)])
    scenes.add_uv_map(ob, lambda at: at[:, :2])
    scenes.add_subsurf(ob).subdivision_type = "SIMPLE"
    truth.add_camera((0.5, 0.5, -3), (0.5, 0.5, 0))
    shown = bpy.data.images.new("Shown", 8, 8, alpha=True)
    shown.pixels.foreach_set(np.ones(8 * 8 * 4, np.float32))
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    empty.location, empty.empty_display_size = (9, 9, 9), 0.5
    bpy.context.view_layer.update()
    scenes.activate(ob)
    return ob


def message(**properties) -> str:
    before = scenes.file_contents()
    with pytest.raises(RuntimeError) as refusal:
        bpy.ops.object.limit_project_image(image="Shown", width=16, height=16, **properties)
    assert scenes.file_contents() == before
    return str(refusal.value).strip().removeprefix("Error: ")


STRAIGHT = math.pi / 2
AWAY, TURNED = "face away from the camera", "be turned away by more than Facing allows"
OUTSIDE, HIDDEN = "lie outside the camera's picture", "be hidden behind other parts of itself"


@pytest.mark.parametrize(
    ("properties", "reasons"),
    [
        ({}, f"{AWAY}, {TURNED}, {OUTSIDE} or {HIDDEN}"),
        ({"occlusion": False}, f"{AWAY}, {TURNED} or {OUTSIDE}"),
        ({"occlusion": False, "facing": (1, STRAIGHT)}, f"{AWAY} or {OUTSIDE}"),
        (
            {"occlusion": False, "facing": (1, STRAIGHT), "extension": "EXTEND"},
            f"{AWAY} or lie behind the camera or outside its clipping range",
        ),
    ],
)
def test_a_surface_seen_from_behind(square, properties, reasons):
    assert message(**properties) == f"{NOTHING}: the surface may {reasons}"


def test_a_camera_that_looks_elsewhere(square):
    bpy.context.scene.camera.location.x = 99
    bpy.context.view_layer.update()
    said = message(two_sided=True, occlusion=False, facing=(1, STRAIGHT))
    assert said == f"{NOTHING}: the surface may {OUTSIDE}"


def test_empties(square):
    open_wide = {"two_sided": True, "occlusion": False, "facing": (1, STRAIGHT)}
    planar = {"source": "PLANAR", "empty": "Empty", **open_wide}
    where = f"{NOTHING}: the surface may lie outside "
    assert message(**planar) == f"{where}the empty's rectangle"
    depths = {"use_depth": True, "depth": (1, 2)}
    assert message(**planar, **depths) == f"{where}the empty's rectangle or the depths"
    assert message(**planar, **depths, extension="REPEAT") == f"{where}the depths"
    assert message(source="BOX", empty="Empty") == f"{where}the empty's box"


def test_another_surface(square):
    other = square.copy()
    other.name, other.location = "Other", (0, 0, 5)
    bpy.context.collection.objects.link(other)
    bpy.context.view_layer.update()
    how = {"source": "NORMALS", "from_object": "Other"}
    missed = f"{NOTHING}: no normal of the surface meets Other"
    assert message(**how, max_distance=2) == f"{missed} within the chosen distance"
    assert message(**how, direction="INWARD") == f"{missed} in the chosen direction"
    both = f"{missed} in the chosen direction and within the chosen distance"
    assert message(**how, direction="INWARD", max_distance=2) == both
    other.location.x = 7
    bpy.context.view_layer.update()
    assert message(**how) == missed


def test_an_image_that_is_transparent_there(square):
    bpy.data.images["Shown"].pixels.foreach_set(np.zeros(8 * 8 * 4, np.float32))
    said = message(two_sided=True)
    assert said == "The image Shown is transparent where it falls on the surface"
