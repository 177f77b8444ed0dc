# SPDX-License-Identifier: GPL-3.0-or-later
"""Live following while somebody changes the faces of the surface."""

import bmesh
import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from bakes import bake
from limit_surface import ids
from limit_surface.placing import live_kept
from limit_surface.reading import attributes
from live_scenes import check_hair, follow


def rebuilt(mesh: bpy.types.Mesh, faces: np.ndarray) -> None:
    """Gives the mesh these quads, and keeps all other edges."""
    edited = bmesh.new()
    edited.from_mesh(mesh)
    bmesh.ops.delete(edited, geom=list(edited.faces), context="FACES_ONLY")
    edited.verts.ensure_lookup_table()
    for number, face in enumerate(faces):
        edited.faces.new([edited.verts[i] for i in face]).index = number
    edited.faces.sort()  # they have taken the places of those that were deleted, in any order
    edited.to_mesh(mesh)
    edited.free()
    mesh.update_tag()
    bpy.context.view_layer.update()


def bumpy_grid() -> tuple[bpy.types.Object, np.ndarray]:
    ob = scenes.flat_grid(4)
    positions = attributes.read(ob.data, ids.POSITION)
    positions[:, 2] = np.sin(positions[:, 0]) * np.cos(2 * positions[:, 1])
    attributes.write(ob.data, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    return ob, attributes.read(ob.data, ids.CORNER_VERTEX).reshape(-1, 4)


def is_stale(ob: bpy.types.Object, hair: bpy.types.Object) -> bool:
    reason = f"The faces of {ob.name} have changed since {hair.name} was bound"
    return live_kept.trouble(hair) == reason and live_kept.remedy(hair) == ids.REBIND


def test_a_face_is_deleted_whose_edges_stay():
    ob, faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    edges = len(ob.data.edges)
    before = follow_truth.shown_strands(hair).copy()
    rebuilt(ob.data, np.delete(faces, 5, axis=0))
    assert len(ob.data.edges) == edges
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), before)
    assert is_stale(ob, hair)


def turned_over(ob: bpy.types.Object) -> None:
    rebuilt(ob.data, attributes.read(ob.data, ids.CORNER_VERTEX).reshape(-1, 4)[:, ::-1])


def in_other_order(ob: bpy.types.Object) -> None:
    rebuilt(ob.data, attributes.read(ob.data, ids.CORNER_VERTEX).reshape(-1, 4)[::-1])


def subdivided(ob: bpy.types.Object) -> None:
    edited = bmesh.new()
    edited.from_mesh(ob.data)
    bmesh.ops.subdivide_edges(edited, edges=list(edited.edges), cuts=1, use_grid_fill=True)
    edited.to_mesh(ob.data)
    edited.free()
    ob.data.update_tag()
    bpy.context.view_layer.update()


@pytest.mark.parametrize("edit", [turned_over, in_other_order, subdivided])
@pytest.mark.parametrize("has_capture", [True, False])
def test_faces_are_edited(edit, has_capture, tmp_path, capfd):
    ob, _faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    if not has_capture:
        ob.modifiers.remove(ob.modifiers[ids.CAPTURE_GROUP])
    before = follow_truth.shown_strands(hair).copy()
    edit(ob)
    for frame in (2, 3):
        bpy.context.scene.frame_set(frame)
        np.testing.assert_array_equal(follow_truth.shown_strands(hair), before)
        assert is_stale(ob, hair)
    assert bake(tmp_path, hair.name, frames="1-1", options=("--format", "npz")) == 3
    assert f"{ids.REBIND} puts it right" in capfd.readouterr().err
    with pytest.raises(RuntimeError, match="was bound before the faces of"):
        follow(hair)

    path = str(tmp_path / "edited.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    capfd.readouterr()
    bpy.ops.wm.open_mainfile(filepath=path)
    ob, hair = (bpy.data.objects[name] for name in ("Flat", "Limit Hair"))
    assert is_stale(ob, hair)
    assert f"Limit Surface: {live_kept.trouble(hair)}\n" in capfd.readouterr().out
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), before)

    scenes.activate(ob)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    assert live_kept.trouble(hair) == ""
    check_hair(ob, hair)


def first(ob: bpy.types.Object, name: str) -> bpy.types.Modifier:
    modifier = ob.modifiers.new(name, name.upper())
    ob.modifiers.move(ob.modifiers.find(modifier.name), 0)
    return modifier


@pytest.mark.parametrize("name", ["Decimate", "Triangulate"])
def test_a_modifier_is_added_that_replaces_faces(name):
    ob, _faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    before = follow_truth.shown_strands(hair).copy()
    modifier = first(ob, name)
    if name == "Decimate":
        modifier.ratio = 0.5
    bpy.context.view_layer.update()
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), before)
    assert is_stale(ob, hair)
    ob.modifiers.remove(modifier)
    bpy.context.view_layer.update()
    assert live_kept.trouble(hair) == ""
    check_hair(ob, hair)


def test_modifiers_may_deform_and_add_faces():
    ob, _faces = bumpy_grid()
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    first(ob, "Mirror").use_mirror_merge = False
    first(ob, "Smooth").factor = 0.3
    for is_of_earlier_version in (False, True):
        if is_of_earlier_version:
            del hair.data[ids.LIVE_SOURCE]
        bpy.context.scene.frame_set(bpy.context.scene.frame_current + 1)
        assert live_kept.trouble(hair) == ""
        check_hair(ob, hair)


def test_a_modifier_that_removes_faces_is_animated():
    ob, faces = bumpy_grid()
    removed = first(ob, "Build")
    removed.frame_start, removed.frame_duration = 1, 20
    bpy.context.scene.frame_set(30)
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    bpy.context.scene.frame_set(10)
    reason = live_kept.trouble(hair)
    assert "is not among" in reason  # nobody has edited anything, and all is well again later
    bpy.context.scene.frame_set(25)
    assert live_kept.trouble(hair) == ""
    check_hair(ob, hair)


def test_edited_faces_are_noticed_on_hair_that_an_earlier_version_has_bound():
    ob, _faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    del hair.data[ids.LIVE_SOURCE]
    turned_over(ob)
    assert is_stale(ob, hair)


def test_hair_that_is_combed_meanwhile_is_left_alone():
    ob, faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    turned_over(ob)
    combed = scenes.strands(hair) + [0, 0, 0.1]
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", combed)
    hair.data.update_tag()
    bpy.context.view_layer.update()
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=1e-6)
    assert is_stale(ob, hair)
    rebuilt(ob.data, faces)
    np.testing.assert_allclose(scenes.strands(hair), combed, atol=1e-6)
    check_hair(ob, hair)


def test_hair_follows_as_soon_as_its_faces_are_there_again():
    ob, faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    rebuilt(ob.data, faces[:8])
    assert is_stale(ob, hair)
    rebuilt(ob.data, faces)
    assert live_kept.trouble(hair) == ""
    check_hair(ob, hair)
