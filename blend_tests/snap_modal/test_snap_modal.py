# SPDX-License-Identifier: GPL-3.0-or-later
"""view3d.limit_snap_modal without a window: at a location, and its refusals.

Mouse and keys are tested in blend_tests/gui.
"""

import bpy
import follow_scenes
import numpy as np
import pytest
import scenes

FACE, UV = 1, (0.25, 0.625)


@pytest.fixture
def target():
    ob = scenes.cross()
    ob.location, ob.rotation_euler, ob.scale = (1, -2, 0.5), (0.3, 0.2, -0.4), (1.5, 0.7, -1.2)
    bpy.context.view_layer.update()
    bpy.context.scene.limit_surface.target = ob
    return ob


def foot(target):
    """Returns the position and outward normal in the world, from the surface of the cage in world
    space.
    """
    evaluated = scenes.surface_without_addon(target).evaluate(FACE, [UV], derivatives=1)
    matrix = np.array(target.matrix_world, np.float64)
    normal = evaluated.normal[0] @ np.linalg.inv(matrix[:3, :3])
    return (
        scenes.transformed(matrix, evaluated.position)[0],
        normal / np.linalg.norm(normal),
    )


def drag(**properties):
    return bpy.ops.view3d.limit_snap_modal(**{"face": FACE, "uv": UV} | properties)


def pin(target):
    ob = bpy.data.objects.new("Pin", None)
    bpy.context.collection.objects.link(ob)
    ob.location, ob.rotation_euler, ob.scale = (5, 4, 3), (0.3, 1, 2), (1, 2, 0.5)
    ob.select_set(True)
    target.select_set(True)
    scenes.activate(target)
    bpy.context.view_layer.update()
    return ob


def test_object(target):
    ob = pin(target)
    position, normal = foot(target)
    assert drag(offset=0.25, align="NORMAL") == {"FINISHED"}
    bpy.context.view_layer.update()
    np.testing.assert_allclose(ob.matrix_world.translation, position + 0.25 * normal, atol=1e-6)
    np.testing.assert_allclose(ob.matrix_world.col[2][:3] / np.float64(0.5), normal, atol=1e-6)
    np.testing.assert_allclose(ob.scale, (1, 2, 0.5))


def test_vertex(target):
    triangle = scenes.add_mesh("Triangle", [(0, 0, 5), (1, 0, 5), (0, 1, 5)], [(0, 1, 2)])
    triangle.scale = (2, 1, 3)
    target.select_set(False)  # otherwise it would be edited as well
    bpy.context.view_layer.update()
    bpy.ops.object.mode_set(mode="EDIT")
    assert drag(element=1) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    position, _normal = foot(target)
    np.testing.assert_allclose(
        triangle.matrix_world @ triangle.data.vertices[1].co, position, atol=2e-6
    )
    assert tuple(triangle.data.vertices[0].co) == (0, 0, 5)


@pytest.mark.parametrize("hair_mode", ["ROOT", "STRAND", "BLEND"])
def test_strand(target, hair_mode):
    hair = scenes.add_hair(target, per_side=2, points=4)
    before = scenes.strands(hair)
    assert drag(element=3, hair=hair_mode) == {"FINISHED"}
    after = scenes.strands(hair)
    position, _normal = foot(target)
    np.testing.assert_allclose(
        hair.matrix_world @ hair.data.curves[3].points[0].position, position, atol=1e-6
    )
    moves = after[3] - before[3]
    share = {"ROOT": [1, 0, 0, 0], "STRAND": [1, 1, 1, 1], "BLEND": [1, 2 / 3, 1 / 3, 0]}[hair_mode]
    np.testing.assert_allclose(moves, np.outer(share, moves[0]), atol=1e-6)
    others = np.arange(len(before)) != 3
    np.testing.assert_array_equal(after[others], before[others])
    face, uv = scenes.locations(hair.data)
    assert face[3] == FACE
    np.testing.assert_array_equal(uv[3], UV)


@pytest.mark.parametrize("kind", ["VIEWPORT", "RENDER"])
def test_on_the_polygons_that_are_shown(target, kind):
    """At a corner of a face the polygons have the vertex of the subdivided mesh."""
    subsurf = scenes.add_subsurf(target)
    subsurf.levels, subsurf.render_levels = 1, 2
    ob = pin(target)
    assert drag(uv=(0, 0), target=kind) == {"FINISHED"}
    subsurf.levels = 1 if kind == "VIEWPORT" else 2
    bpy.context.view_layer.update()
    shown = target.evaluated_get(bpy.context.evaluated_depsgraph_get())
    vertex = shown.data.vertices[target.data.polygons[FACE].vertices[0]]
    place = ob.matrix_world.translation
    np.testing.assert_allclose(place, target.matrix_world @ vertex.co, atol=1e-6)
    limit = scenes.surface_without_addon(target).evaluate([FACE], [(0, 0)]).position
    on_limit = scenes.transformed(target.matrix_world, limit)[0]
    assert np.linalg.norm(np.array(place) - on_limit) > 1e-3


def test_a_target_that_comes_along(target):
    ob = pin(target)
    follow = target.constraints.new("COPY_LOCATION")
    follow.target, follow.use_offset = ob, True
    bpy.context.view_layer.update()
    refused("Pin cannot be put there, because Cross depends on it")


def refused(match, **properties):
    before = [tuple(ob.matrix_basis.translation) for ob in bpy.data.objects]
    with pytest.raises(RuntimeError, match=match):
        drag(**properties)
    assert [tuple(ob.matrix_basis.translation) for ob in bpy.data.objects] == before


def test_refusals(target):
    refused("Select one object to drag")
    ob = pin(target)
    refused("Dragging needs a window and a mouse", face=-1)
    refused("Error: Cross: face 1000 is not among", face=1000)
    ob.lock_location = (True, True, True)
    refused("Pin cannot be put there: the location or rotation is locked")
    ob.lock_location = (False, False, False)
    target.parent = ob
    bpy.context.view_layer.update()
    refused("Pin would move Cross with it")


def test_refusals_of_hair(target):
    hair = scenes.add_hair(target, per_side=1)
    refused("has no strand 7000", element=7000)
    bpy.context.scene.limit_surface.target = None
    hair.data.surface = None
    refused("Choose a target in the sidebar tab Limit", element=0)


def test_overridden_hair(target, tmp_path):
    """Blender does not save points that are written to it."""
    hair, _target = scenes.overridden(tmp_path, scenes.add_hair(target, per_side=1), target)
    scenes.activate(hair)
    refused("is a library override: Blender does not save", element=0)


def test_edited_mesh_is_no_target_of_itself(target):
    bpy.ops.object.mode_set(mode="EDIT")
    refused("cannot be dragged over itself", element=0)
    bpy.ops.object.mode_set(mode="OBJECT")


def test_without_a_window(target):
    pin(target)
    with pytest.raises(RuntimeError, match="Dragging needs a window and a mouse"):
        bpy.ops.view3d.limit_snap_modal("INVOKE_DEFAULT")


def test_nothing_is_left_in_the_file(target):
    ob = pin(target)
    before = scenes.file_contents()
    drag()
    assert scenes.file_contents() == before
    assert ob.name == "Pin"


def test_a_strand_that_follows_is_bound_at_its_new_place():
    ob = follow_scenes.deforming("grid with holes")
    hair = scenes.add_hair(ob, per_side=2, follow="NODES")
    bpy.context.scene.limit_surface.target = ob
    scenes.activate(hair)
    moved = bpy.ops.view3d.limit_snap_modal("EXEC_DEFAULT", element=3, face=1, uv=(0.3, 0.6))
    assert moved == {"FINISHED"}
    assert hair.data.attributes["limit_face"].data[3].value == 1
    for frame in (1, 30):
        bpy.context.scene.frame_set(frame)
        follow_scenes.check_hair(ob, hair)
