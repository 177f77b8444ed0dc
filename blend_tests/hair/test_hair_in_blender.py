# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair in a Blender file: attachment, selection, undo, and large counts that need confirmation."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import scatter_operator
from limit_surface.reading import attributes
from scenes import add_hair, add_mesh, add_subsurf, add_uv_map, locations, strands


def flat(positions):
    return positions[:, :2] @ [[0.11, 0.02], [-0.03, 0.13]] + [0.4, 0.45]


@pytest.mark.parametrize("scene", ["grid with holes", "mixed polygons"])
def test_surface_uv_is_the_place_on_the_base_mesh_where_uvs_are_not_smoothed(scene):
    """On an affine map the UV of a place is the map of its position: on the bare mesh, of the
    bilinear position.
    """
    ob = scenes.SCENES[scene]()
    add_uv_map(ob, flat)
    add_subsurf(ob).uv_smooth = "NONE"
    hair = add_hair(ob)
    assert hair.data.surface_uv_map == "Flat"
    stored = attributes.read(hair.data, ids.SURFACE_UV)
    place = scenes.on_base_mesh(ob, *locations(hair.data))
    np.testing.assert_allclose(stored, flat(place), atol=1e-6)


def test_surface_uv_behind_a_modifier_that_makes_faces():
    ob = scenes.grid_with_holes()
    add_uv_map(ob, flat)
    mirror = ob.modifiers.new("Mirror", "MIRROR")
    mirror.use_mirror_u = True
    add_subsurf(ob)
    hair = add_hair(ob, per_side=2)
    uv = attributes.read(hair.data, ids.SURFACE_UV)
    assert len(uv) == 2 * len(ob.data.polygons) * 4
    assert (uv[len(uv) // 2 :].mean(axis=0)[0] < 0.5) != (uv[: len(uv) // 2].mean(axis=0)[0] < 0.5)


def test_blenders_own_snap_finds_the_attachment():
    ob = scenes.grid_with_holes()
    add_uv_map(ob, flat)
    hair = add_hair(ob)
    before = strands(hair)
    assert bpy.ops.curves.snap_curves_to_surface(attach_mode="DEFORM") == {"FINISHED"}
    moved = np.abs(strands(hair)[:, 0] - before[:, 0]).max()
    assert 0 < moved < 0.5  # the place on the base mesh


def test_without_uv_map_no_uv_is_stored():
    hair = add_hair(scenes.cross())
    assert hair.data.surface_uv_map == ""
    assert ids.SURFACE_UV not in hair.data.attributes


def test_a_uv_map_that_modifiers_drop_is_reported(capfd):
    ob = scenes.cross()
    add_uv_map(ob, flat)
    ob.modifiers.new("Remesh", "REMESH").mode = "BLOCKS"
    hair = add_hair(ob, per_side=1)
    assert "the modifiers remove the UV map Flat" in capfd.readouterr().out
    assert ids.SURFACE_UV not in hair.data.attributes


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_uv_map_that_is_not_finite_is_left_out_and_reported(capfd, value):
    ob = scenes.cross()
    add_uv_map(ob, flat)
    uv = attributes.read(ob.data, "Flat")
    uv[[3, 5], 0] = value
    attributes.write(ob.data, "Flat", "FLOAT2", "CORNER", uv)
    hair = add_hair(ob, per_side=1)
    expected = "UVs were not stored: the UV map Flat has coordinates that are not finite numbers"
    assert expected in capfd.readouterr().out
    assert hair.data.surface_uv_map == ""
    assert ids.SURFACE_UV not in hair.data.attributes


def test_nothing_else_appears_in_the_file():
    ob = scenes.cross()
    add_subsurf(ob)
    before = scenes.file_contents()
    hair = add_hair(ob)
    after = scenes.file_contents()
    assert after.pop("hair_curves") == [hair.data.name]
    assert set(after.pop("objects")) - set(before.pop("objects")) == {hair.name}
    del before["hair_curves"]
    assert after == before


def test_hair_becomes_active_and_alone_selected():
    ob, other = scenes.cross(), add_mesh("Other", [(0, 0, 0)], [])
    other.select_set(True)
    hair = add_hair(ob)
    assert bpy.context.active_object == hair
    assert bpy.context.selected_objects == [hair]


def test_excluded_active_collection():
    ob = scenes.cross()
    hidden = bpy.data.collections.new("Hidden")
    bpy.context.scene.collection.children.link(hidden)
    layer = bpy.context.view_layer.layer_collection.children["Hidden"]
    bpy.context.view_layer.active_layer_collection = layer
    layer.hide_viewport = True
    assert bpy.context.scene.collection in add_hair(ob).users_collection


def test_undo_and_redo():
    ob = scenes.cross()
    bpy.ops.ed.undo_push(message="before")
    name = add_hair(ob).name
    bpy.ops.ed.undo_push(message="after")
    expected = strands(bpy.data.objects[name])
    bpy.ops.ed.undo()
    assert name not in bpy.data.objects
    assert not bpy.data.hair_curves
    bpy.ops.ed.redo()
    hair = bpy.data.objects[name]
    np.testing.assert_array_equal(strands(hair), expected)
    surface = scenes.surface_without_addon(bpy.data.objects["Cross"])
    roots = surface.evaluate(*locations(hair.data)).position.astype(np.float32)
    np.testing.assert_array_equal(expected[:, 0], roots)


def test_adjusting_as_the_redo_panel_does():
    """The redo panel undoes the operator and runs it again with other properties."""
    scenes.cross()
    bpy.ops.ed.undo_push(message="before")
    for per_side in (2, 5):
        bpy.ops.object.limit_hair_add("EXEC_DEFAULT", per_side=per_side)
        bpy.ops.ed.undo_push(message="after")
        assert len(bpy.context.active_object.data.curves) == 5 * per_side**2
        assert len(bpy.data.objects) == 2
        bpy.ops.ed.undo()
        assert bpy.context.active_object.name == "Cross"


def test_report_has_the_counts(capfd):
    ob = scenes.cross()
    add_subsurf(ob, "PRESERVE_CORNERS")
    add_hair(ob)
    reported = capfd.readouterr().out
    assert "80 strands on 5 faces of Cross" in reported
    assert "boundary corners (Subdivision)" in reported


def test_faces_without_a_limit_surface_are_left_out_and_reported(capfd):
    """A face uses a vertex twice: this face and all that touch it have no limit surface."""
    ob = scenes.grid_with_holes()
    n = len(ob.data.vertices)
    positions = [vertex.co[:] for vertex in ob.data.vertices] + [(2.5, 2.5, 5)]
    faces = [polygon.vertices[:] for polygon in ob.data.polygons] + [(14, 15, n, 15)]
    hair = add_hair(add_mesh("Fin", positions, faces), per_side=2)
    reported = capfd.readouterr().out
    assert f"1 of {len(faces)} faces has no limit surface and was left out" in reported
    assert f"it uses vertex 15 twice (face {len(faces) - 1}; 1 in all)" in reported
    assert 0 < len(hair.data.curves) < 4 * len(faces)


def test_nothing_left_to_grow_on():
    add_mesh("Fold", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2, 1)])
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="No face has a limit surface.*uses vertex 1 twice"):
        bpy.ops.object.limit_hair_add()
    assert scenes.file_contents() == before


@pytest.mark.parametrize("properties", [{"per_side": 1000}, {"per_side": 500, "points": 200}])
def test_millions_need_consent(properties):
    scenes.cross()
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match=r"strands of .* GiB of memory.*allow_large"):
        bpy.ops.object.limit_hair_add(**properties)
    assert scenes.file_contents() == before


def test_consent_is_enough(monkeypatch):
    ob = scenes.cross()
    monkeypatch.setattr("limit_surface.tasks.request_size.LARGE_COUNT", 10)
    with pytest.raises(RuntimeError, match="80 strands"):
        bpy.ops.object.limit_hair_add(per_side=4)
    assert len(add_hair(ob, allow_large=True).data.curves) == 80
    scenes.activate(ob)
    with pytest.raises(RuntimeError, match="allow_large"):  # the setting holds for one call only
        bpy.ops.object.limit_hair_add(per_side=4)


def test_more_than_blender_can_count():
    scenes.cross()
    with pytest.raises(RuntimeError, match="2,147,483,647"):
        bpy.ops.object.limit_hair_add(per_side=10_000, points=100, allow_large=True)


def test_memory_that_runs_out(monkeypatch):
    scenes.cross()

    def exhausted(*_arguments):
        raise MemoryError

    monkeypatch.setattr("limit_surface.placing.roots.evaluate", exhausted)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="There is not enough memory"):
        bpy.ops.object.limit_hair_add()
    assert scenes.file_contents() == before


def test_large_counts_in_parts(monkeypatch):
    """Evaluation in parts, one after the other, changes no value."""
    ob = scenes.cross()
    whole = strands(add_hair(ob, random=0.3, tilt=(0.1, 0.2)))
    monkeypatch.setattr("limit_surface.placing.roots.PART", 7)
    np.testing.assert_array_equal(strands(add_hair(ob, random=0.3, tilt=(0.1, 0.2))), whole)


def test_poll_says_what_is_missing():
    with pytest.raises(RuntimeError, match="mesh object active"):
        bpy.ops.object.limit_hair_add()
    scenes.cross()
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(RuntimeError, match="Object Mode"):
        bpy.ops.object.limit_hair_add()
    bpy.ops.object.mode_set(mode="OBJECT")


@pytest.mark.parametrize("operator", ["limit_hair_add", "limit_points_add"])
def test_everything_has_a_tooltip(operator):
    kind = getattr(bpy.ops.object, operator).get_rna_type()
    assert kind.description
    own = [p for p in kind.properties if p.identifier != "rna_type"]
    assert len(own) >= 5
    for prop in own:
        assert prop.description, prop.identifier
        assert prop.name, prop.identifier
    assert issubclass(getattr(bpy.types, kind.identifier), scatter_operator.ScatterOperator)
