# SPDX-License-Identifier: GPL-3.0-or-later
"""Snapping as an operator: undo, adjusting afterwards, refusals, and the panels."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bmesh
import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from mathutils import Matrix
from snap_scenes import (
    BONES,
    add_cloud,
    add_curve,
    add_hair,
    choose_target,
    roots,
    world_strands,
    world_vertices,
)
from snap_truth import Truth, add_object, near, snap, stretched, world_locations

EXACT = 1e-6


def mesh_points(ob):
    return np.array([vertex.co for vertex in bmesh.from_edit_mesh(ob.data).verts])


def curve_points(ob):
    return np.array([point.co for point in ob.data.splines[0].bezier_points])


def lattice_points(ob):
    return np.array([point.co_deform for point in ob.data.points])


def bone_ends(ob):
    return np.array([(bone.head, bone.tail) for bone in ob.data.edit_bones])


def hair_points(ob):
    return attributes.read(ob.data, "position")


def add_lattice(target):
    return add_object(target.location, bpy.data.lattices.new("Lattice"), "Edited")


def add_armature(target):
    ob = add_object(target.location, bpy.data.armatures.new("Armature"), "Edited")
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    for name, (head, tail, _, _) in BONES.items():
        bone = ob.data.edit_bones.new(name)
        bone.head, bone.tail = head, tail
    bpy.ops.object.mode_set(mode="OBJECT")
    return ob


EDITED = {
    "mesh": (add_cloud, mesh_points),
    "curve": (lambda target: add_curve("BEZIER", near(target, 4, 0.2)), curve_points),
    "lattice": (add_lattice, lattice_points),
    "armature": (add_armature, bone_ends),
    "hair": (add_hair, hair_points),
}
SELECT_ALL = {
    "mesh": "mesh",
    "curve": "curve",
    "lattice": "lattice",
    "armature": "armature",
    "hair": "curves",
}


@pytest.mark.parametrize(
    ("kind", "mode"), [*((kind, "EDIT") for kind in EDITED), ("hair", "SCULPT_CURVES")]
)
def test_undo_redo_and_adjusting_in_edit_mode(kind, mode):
    """Blender runs an operator again with other properties in this way: it undoes it and calls it
    anew.
    """
    make, points = EDITED[kind]
    ob = make(choose_target(stretched(scenes.cross())))
    ob.name = "Edited"
    scenes.activate(ob)
    bpy.ops.ed.undo_push(message="object mode")
    bpy.ops.object.mode_set(mode=mode)
    getattr(bpy.ops, SELECT_ALL[kind]).select_all(action="SELECT")
    bpy.ops.ed.undo_push(message="before")
    edited = lambda: points(bpy.data.objects["Edited"])  # noqa: E731
    before, results = edited(), []
    for offset in (0.0, 0.3, 0.0):
        assert bpy.ops.object.limit_snap(offset=offset) == {"FINISHED"}
        results.append(edited())
        bpy.ops.ed.undo_push(message="after")
        bpy.ops.ed.undo()
        np.testing.assert_array_equal(edited(), before)
    bpy.ops.ed.redo()
    np.testing.assert_array_equal(edited(), results[2])
    np.testing.assert_array_equal(results[2], results[0])
    assert np.abs(results[1] - results[0]).max() > 0.1
    bpy.ops.object.mode_set(mode="OBJECT")


def test_undo_and_redo_in_object_mode():
    target = stretched(scenes.cross())
    hair = add_hair(target)
    things = [add_object(point) for point in near(target, 3, 0.3)]
    scenes.activate(target)
    bpy.ops.ed.undo_push(message="before")
    names = [thing.name for thing in things]

    def state():
        hair = bpy.data.objects["Hair"]
        return (
            world_locations([bpy.data.objects[name] for name in names]).tolist(),
            hair_points(hair).tolist(),
            sorted(hair.data.attributes.keys()),
            hair.data.surface and hair.data.surface.name,
        )

    before = state()
    assert hair.name == "Hair"
    snap(target, align="NORMAL")
    after = state()
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert state() == before
    bpy.ops.ed.redo()
    assert state() == after != before


def refused(match, **properties):
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_snap(**properties)


def test_needs_an_active_mesh_and_something_else():
    assert not bpy.ops.object.limit_snap.poll()
    refused("Select the objects to snap, and then the mesh as the active object")
    scenes.cross()
    refused("Select the objects to snap in addition to the active mesh")
    add_object((0, 0, 1))
    assert bpy.ops.object.limit_snap.poll()
    bpy.ops.object.mode_set(mode="VERTEX_PAINT")
    refused("Only available in Object Mode, in Edit Mode of")


def test_nothing_within_reach_changes_nothing():
    target = scenes.cross()
    things = [add_object((0, 0, 9)), add_object((0, 0, 8))]
    scenes.activate(target)
    before = scenes.file_contents()
    refused("2 objects could not be snapped: no surface was found within 1", max_distance=1)
    assert [thing.location.z for thing in things] == [9, 8]
    assert scenes.file_contents() == before


def test_a_target_without_faces():
    target = scenes.add_mesh("Wire", [(0, 0, 0), (1, 0, 0)], [], [(0, 1)])
    add_object((0, 0, 1))
    scenes.activate(target)
    refused("Wire has no faces")


def test_a_target_without_a_limit_surface():
    target = scenes.add_mesh("Fin", [(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1, 2, 1)])
    add_object((0, 0, 1))
    scenes.activate(target)
    refused("No face of Fin has a limit surface")


def test_a_flattened_target():
    target = scenes.cross()
    target.scale.z = 0
    thing = add_object((0, 0, 1))
    scenes.activate(target)
    bpy.context.view_layer.update()
    refused("has a scale of 0")
    assert tuple(thing.location) == (0, 0, 1)


def test_a_flattened_object_has_no_direction():
    target = scenes.cross()
    add_object((0, 0, 1)).scale = (1, 1, 0)
    scenes.activate(target)
    bpy.context.view_layer.update()
    refused("no normal or axis that gives the direction of the search", mode="NORMAL")
    refused("the object cannot be turned to the normal", align="NORMAL")


def test_a_flattened_edited_object():
    cloud = add_cloud(choose_target(scenes.cross()))
    cloud.scale.x = 0
    bpy.context.view_layer.update()
    scenes.activate(cloud)
    bpy.ops.object.mode_set(mode="EDIT")
    refused("has a scale of 0")
    bpy.ops.object.mode_set(mode="OBJECT")


def test_vertices_that_are_nowhere():
    cloud = add_cloud(choose_target(scenes.cross()))
    truth = Truth(bpy.data.objects["Cross"])
    cloud.data.vertices[3].co.x = np.nan
    scenes.activate(cloud)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.object.limit_snap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    found = np.delete(world_vertices(cloud), 3, axis=0)
    np.testing.assert_allclose(truth.distances(found), 0, atol=EXACT)


def test_properties_are_where_the_result_is_adjusted():
    target = scenes.cross()
    add_object((0, 0, 1))
    scenes.activate(target)
    operator = bpy.types.OBJECT_OT_limit_snap
    properties = {p.identifier for p in bpy.ops.object.limit_snap.get_rna_type().properties} - {
        "rna_type",
        "view_matrix",
        "view_is_perspective",
        "summary",
    }
    shown = set()
    for mode in ("NEAREST", "AXIS", "NORMAL"):
        layout = MagicMock()
        self = SimpleNamespace(layout=layout, mode=mode, use_facing=True, hair="ROOT", summary="x")
        operator.draw(self, bpy.context)
        calls = layout.prop.call_args_list + layout.row().prop.call_args_list
        shown |= {call.args[1] for call in calls}
    assert shown == properties


def test_the_view_is_the_3d_viewports():
    """The view is stored, so that adjusting the result still works after the viewport has
    turned.
    """
    turned = Matrix.Rotation(0.3, 4, "X") @ Matrix.Translation((1, 2, -20))
    region = SimpleNamespace(view_matrix=turned, is_perspective=True)
    operator = SimpleNamespace(view_matrix=Matrix.Diagonal((0,) * 4), view_is_perspective=False)
    view = bpy.types.OBJECT_OT_limit_snap._view(operator, SimpleNamespace(region_data=region))
    np.testing.assert_allclose(view.axes.T, turned.to_3x3(), atol=1e-6)
    np.testing.assert_allclose(view.eye, turned.inverted().translation, atol=1e-5)
    assert (operator.view_matrix, operator.view_is_perspective) == (turned, True)


def test_panel_chooses_the_target():
    target = scenes.cross()
    layout = MagicMock()
    bpy.types.VIEW3D_PT_limit_snap.draw(SimpleNamespace(layout=layout), bpy.context)
    layout.row().prop.assert_called_once_with(bpy.context.scene.limit_surface, "target")
    assert layout.row().active is False
    lines = [call.kwargs["text"] for call in layout.column().label.call_args_list]
    assert " ".join(lines) == f"In Object Mode, the target is the active mesh: {target.name}"
    assert ids.SNAP in [call.args[0] for call in layout.column().operator.call_args_list]


def test_the_target_is_saved_with_the_scene(tmp_path):
    choose_target(scenes.cross())
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "target.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "target.blend"))
    assert bpy.context.scene.limit_surface.target == bpy.data.objects["Cross"]


def test_a_target_that_is_gone_from_the_scene():
    """The object stays a target, because its surface does not depend on its visibility."""
    target = choose_target(stretched(scenes.cross()))
    truth = Truth(target)
    cloud = add_cloud(target)
    bpy.context.collection.objects.unlink(target)
    scenes.activate(cloud)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.object.limit_snap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_allclose(truth.distances(world_vertices(cloud)), 0, atol=EXACT)


def test_modifiers_before_the_subdivision_count(capfd):
    target = scenes.flat_grid(4)
    raised = target.modifiers.new("Raised", "DISPLACE")
    raised.strength, raised.mid_level, raised.direction = 0.5, 0, "Z"
    scenes.add_subsurf(target)
    target.modifiers.new("Later", "WAVE")
    things = [add_object(point) for point in near(target, 5, 0.2)]
    truth = Truth(target)
    snap(target)
    np.testing.assert_allclose(truth.distances(world_locations(things)), 0, atol=EXACT)
    np.testing.assert_allclose(world_locations(things)[:, 2], 0.5, atol=EXACT)
    assert "ignored after Subdivision: Later" in capfd.readouterr().out


def test_hair_keeps_its_roots_through_save_and_load(tmp_path):
    target = stretched(scenes.cross())
    hair = add_hair(target)
    snap(target)
    before = roots(world_strands(hair))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "hair.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "hair.blend"))
    hair = bpy.data.objects["Hair"]
    np.testing.assert_array_equal(roots(world_strands(hair)), before)
    assert hair.data.surface.name == "Cross"
