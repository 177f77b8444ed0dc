# SPDX-License-Identifier: GPL-3.0-or-later
"""Things on a mesh whose limit surface no modifier shows: users are told and offered a modifier."""

import math
from unittest.mock import MagicMock

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import subsurf_offer
from limit_surface.reading import attributes
from stand_ins import stand_in, window_context

# A corner of a cube of side 2 is at (1, 1, 1), its limit position at (1, 1, 1) / 2.
GAP = math.sqrt(3) / 2


def cube():
    bpy.ops.mesh.primitive_cube_add()
    return bpy.context.active_object


def reports(operator):
    return [(*call.args[0], call.args[1]) for call in operator.report.call_args_list]


def displayed_vertices(ob):
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return attributes.read(evaluated.data, ids.POSITION).astype(np.float64)


@pytest.mark.parametrize(("name", "noun"), [("hair", "strands"), ("points", "points")])
def test_scripts_are_told_and_nothing_is_added(name, noun):
    ob = cube()
    operator = stand_in(name, per_side=3)
    assert operator.execute(bpy.context) == {"FINISHED"}
    assert not ob.modifiers
    (*_others, last) = reports(operator)  # the one that the status bar shows
    assert last[0] == "WARNING"
    assert "Cube has no Subdivision Surface modifier" in last[1]
    assert f"up to {GAP:.3g} away" in last[1]
    assert f"the {noun} stand" in last[1]
    assert f"up to {GAP:.3g} away" in operator.summary


def test_the_distance_is_measured_in_the_world_and_where_something_stands():
    ob = cube()
    ob.scale = (2, 2, 2)
    far = [(10, 0, 0), (14, 0, 0), (14, 4, 0), (10, 4, 0)]
    mesh = bpy.data.meshes.new("Both")
    vertices = [v.co[:] for v in ob.data.vertices] + far
    faces = [p.vertices[:] for p in ob.data.polygons]
    mesh.from_pydata(vertices, [], [*faces, (8, 9, 10, 11)])
    ob.data = mesh
    mesh.attributes.new("mine", "BOOLEAN", "FACE").data.foreach_set("value", [True] * 6 + [False])
    bpy.context.view_layer.update()
    operator = stand_in("hair", per_side=3, faces="ATTRIBUTE", face_attribute="mine")
    operator.execute(bpy.context)
    assert f"up to {2 * GAP:.3g} away" in reports(operator)[-1][1]
    scenes.activate(ob)
    everywhere = stand_in("hair", per_side=3)
    everywhere.execute(bpy.context)
    assert f"up to {2 * GAP:.3g} away" not in reports(everywhere)[-1][1]


def test_of_many_vertices_some_are_measured(monkeypatch):
    cube()
    monkeypatch.setattr(subsurf_offer, "MOST_VERTICES", 3)
    operator = stand_in("hair", per_side=2)
    operator.execute(bpy.context)
    assert f"up to {GAP:.3g} away" in reports(operator)[-1][1]


@pytest.mark.parametrize("chosen", [{"add_subsurf": True}, {"target": "VIEWPORT"}])
def test_nobody_is_told_where_all_is_well(chosen):
    cube()
    operator = stand_in("hair", per_side=3, **chosen)
    operator.execute(bpy.context)
    assert [kind for kind, _ in reports(operator)] == ["INFO"]
    assert "away" not in operator.summary


def test_the_modifier_shows_the_surface_on_which_hair_stands():
    ob = cube()
    without = scenes.strands(scenes.add_hair(ob))
    hair = scenes.add_hair(ob, add_subsurf=True)
    np.testing.assert_array_equal(scenes.strands(hair), without)
    (subsurf,) = ob.modifiers
    assert (subsurf.type, subsurf.subdivision_type) == ("SUBSURF", "CATMULL_CLARK")
    assert (subsurf.use_limit_surface, subsurf.quality) == (True, 10)
    assert (subsurf.levels, subsurf.render_levels) == (3, 3)
    surface = scenes.surface_without_addon(ob)
    distance = surface.closest(displayed_vertices(ob)).distance
    assert len(distance) == 386
    assert distance.max() < 1e-6


def test_it_comes_after_the_other_modifiers():
    ob = cube()
    ob.modifiers.new("Array", "ARRAY").count = 2
    scenes.add_hair(ob, add_subsurf=True, follow="NONE")
    assert [m.type for m in ob.modifiers] == ["ARRAY", "SUBSURF"]


def test_a_mesh_that_has_a_modifier_gets_none():
    ob = cube()
    subsurf = scenes.add_subsurf(ob)
    subsurf.show_viewport = False
    scenes.add_hair(ob, add_subsurf=True)
    assert list(ob.modifiers) == [subsurf]
    assert (subsurf.levels, subsurf.show_viewport) == (1, False)


def test_very_many_faces_get_fewer_levels():
    scenes.flat_grid(200)
    ob = bpy.context.active_object
    scenes.add_points(ob, distribution="UNIFORM", count=10, add_subsurf=True)
    assert ob.modifiers[0].levels == 2
    assert len(displayed_vertices(ob)) < 1_000_000


def test_very_many_sides_get_a_low_quality(capfd):
    around = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    positions = [(np.cos(a), np.sin(a), 0.1 * np.cos(3 * a)) for a in around]
    ob = scenes.add_mesh("Disc", positions, [range(200)])
    scenes.add_points(ob, distribution="UNIFORM", count=10, add_subsurf=True)
    assert ob.modifiers[0].quality == 1
    assert "Warning: Quality is 1, because" in capfd.readouterr().out


def test_roots_on_the_displayed_mesh_lie_on_that_of_the_new_modifier():
    ob = cube()
    hair = scenes.add_hair(ob, add_subsurf=True, target="VIEWPORT")
    roots = scenes.strands(hair)[:, 0].astype(np.float64)
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    for root in roots[::7]:
        _found, nearest, _normal, _face = evaluated.closest_point_on_mesh(root.tolist())
        assert np.linalg.norm(root - nearest) < 1e-6


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_hair_that_gets_the_modifier_follows(follow):
    ob = cube()
    hair = scenes.add_hair(ob, add_subsurf=True, follow=follow)
    before = scenes.strands(hair.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    for vertex in ob.data.vertices:
        vertex.co.z += 1.5
    ob.data.update()
    bpy.context.view_layer.update()
    after = scenes.strands(hair.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    np.testing.assert_allclose(after - before, np.full_like(before, 0) + [0, 0, 1.5], atol=1e-5)


def test_refusals_leave_no_modifier():
    ob = cube()
    chosen = {"density_source": "VERTEX_GROUP", "vertex_group": "None", "add_subsurf": True}
    with pytest.raises(RuntimeError, match="vertex group"):
        bpy.ops.object.limit_hair_add(**chosen)
    assert not ob.modifiers


def test_a_linked_mesh_is_refused(tmp_path):
    cube().name = "Linked"
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (_there, here):
        here.objects = ["Linked"]
    (ob,) = here.objects
    bpy.context.collection.objects.link(ob)
    scenes.activate(ob)
    with pytest.raises(RuntimeError, match="Linked is linked from another file"):
        bpy.ops.object.limit_hair_add(add_subsurf=True)
    asked = stand_in("hair", per_side=2)
    assert asked.invoke(window_context(), None) == {"FINISHED"}  # there is nothing to offer
    assert "has no Subdivision Surface" in reports(asked)[-1][1]


def dialog(operator):
    """Invokes the operator and returns how it opens its dialog, or None."""
    context = window_context()
    operator.invoke(context, None)
    call = context.window_manager.invoke_props_dialog.call_args
    return call.kwargs if call else None


@pytest.mark.parametrize("name", ["hair", "points"])
def test_users_are_asked(name):
    ob = cube()
    before = scenes.file_contents()
    operator = stand_in(name, per_side=3)
    shown = dialog(operator)
    known = bpy.types.WindowManager.bl_rna.functions["invoke_props_dialog"].parameters.keys()
    assert set(shown) <= set(known)
    assert operator.add_subsurf
    assert scenes.file_contents() == before
    assert not ob.modifiers
    operator.layout = layout = MagicMock()
    operator.draw(window_context())
    text = " ".join(call.kwargs["text"] for call in layout.column().label.call_args_list)
    assert text.startswith("Cube has no Subdivision Surface modifier, so its limit surface is not")
    assert text.endswith("or to be inside the mesh.")
    assert [call.args[1] for call in layout.prop.call_args_list] == ["add_subsurf"]
    assert operator.execute(bpy.context) == {"FINISHED"}  # what OK does
    assert [m.type for m in ob.modifiers] == ["SUBSURF"]


def test_users_may_decline():
    ob = cube()
    operator = stand_in("hair", per_side=3)
    assert dialog(operator)
    operator.add_subsurf = False
    operator.execute(bpy.context)
    assert not ob.modifiers
    assert reports(operator)[-1][0] == "WARNING"


def test_the_same_dialog_asks_about_large_counts():
    cube()
    operator = stand_in("hair", per_side=1000)
    assert dialog(operator)
    assert operator.allow_large
    assert "inside the mesh. Make 6,000,000 strands of 5 points (" in operator._question


def test_users_are_not_asked_where_it_is_settled():
    ob = cube()
    for chosen in ({"add_subsurf": False}, {"target": "RENDER"}):
        scenes.activate(ob)
        assert dialog(stand_in("hair", per_side=2, **chosen)) is None
    scenes.add_subsurf(ob)
    scenes.activate(ob)
    assert dialog(stand_in("hair", per_side=2)) is None
