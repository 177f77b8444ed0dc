# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that rigid bodies move are read as they are shown, or refused."""

import bpy
import numpy as np
import pytest
import rigid_scenes
import scenes
from limit_surface import ids
from limit_surface.errors import CageError
from limit_surface.reading import (
    attributes,
    cage,
    curve_lines,
    displayed_mesh,
    shown_stack,
    vertex_weights,
)


def depsgraph():
    return bpy.context.evaluated_depsgraph_get()


def moved_sheet(relation):
    ob = scenes.grid_with_holes()
    rigid_scenes.RELATIONS[relation](ob)
    rigid_scenes.play()
    return ob


def shown(ob):
    return ob.evaluated_get(depsgraph())


@pytest.mark.parametrize("relation", rigid_scenes.RELATIONS)
def test_the_cage_is_as_shown(relation):
    ob = moved_sheet(relation)
    expected = attributes.read(shown(ob).data, ids.POSITION), np.array(shown(ob).matrix_world)
    found = cage.read(ob, depsgraph())
    np.testing.assert_array_equal(found.mesh.positions, expected[0])
    np.testing.assert_array_equal(found.matrix, expected[1])
    assert min(found.world_positions()[:, 2].min(), found.matrix[2, 3] - rigid_scenes.HEIGHT) < -2


@pytest.mark.parametrize("kind", ["VIEWPORT", "RENDER", 1])
def test_the_displayed_mesh_is_as_shown(kind):
    ob = moved_sheet("hooked")
    subsurf = scenes.add_subsurf(ob)
    subsurf.levels = subsurf.render_levels = 1
    expected = attributes.read(shown(ob).data, ids.POSITION)
    found = displayed_mesh.read(ob, depsgraph(), cage.read(ob, depsgraph()), kind)
    np.testing.assert_array_equal(found.quads.vertices, expected)


def test_data_of_the_mesh_is_kept():
    ob = moved_sheet("hooked")
    scenes.add_subsurf(ob)
    scenes.add_uv_map(ob, lambda p: p[:, :2])
    ob.vertex_groups.new(name="Some").add([1, 2], 0.5, "REPLACE")
    ob.data.materials.append(bpy.data.materials.new("Cloth"))
    attributes.write(ob.data, "crease_edge", "FLOAT", "EDGE", np.full(len(ob.data.edges), 0.5))
    with (
        vertex_weights.kept(["Some"]) as keep,
        cage.opened(ob, depsgraph(), keep) as (found, mesh),
    ):
        weights = vertex_weights.read(mesh, 1)[0]
        assert [m.name for m in mesh.materials] == ["Cloth"]
    assert (np.flatnonzero(weights > 0) == [1, 2]).all()
    assert found.chosen_uv_map.name == "Flat"
    assert set(found.mesh.edge_sharpness[1]) == {2.5}


@pytest.mark.parametrize("relation", ["itself", "child"])
def test_reading_does_not_disturb_the_simulation(relation):
    ob = moved_sheet(relation)
    body = ob.parent or ob
    scene = bpy.context.scene
    bodies = list(scene.rigidbody_world.collection.objects)
    expected = []
    for frame in (21, 22, 20):
        scene.frame_set(frame)
        expected.append(np.array(shown(ob).matrix_world))
    contents = scenes.file_contents()
    for frame, matrix in zip((21, 22, 20), expected, strict=True):
        scene.frame_set(frame)
        cage.read(ob, depsgraph())
        np.testing.assert_array_equal(shown(ob).matrix_world, matrix)
        np.testing.assert_array_equal(body.matrix_world, shown(body).matrix_world)
    assert list(scene.rigidbody_world.collection.objects) == bodies
    assert scenes.file_contents() == contents
    rigid_scenes.play(24)  # the part that was not simulated before
    assert shown(ob).matrix_world.translation.z < expected[1][2, 3] - 0.5


def test_evaluated_modifiers_stay_enabled():
    ob = moved_sheet("hooked")
    scenes.add_subsurf(ob)
    before = [(m.show_viewport, m.show_render) for m in shown(ob).modifiers]
    cage.read(ob, depsgraph())
    assert [(m.show_viewport, m.show_render) for m in shown(ob).modifiers] == before
    assert len(shown(ob).data.vertices) > 2 * len(ob.data.vertices)


@pytest.mark.parametrize("relation", ["child", "hooked"])
def test_disabled_surfaces_are_refused(relation):
    ob = moved_sheet(relation)
    ob.hide_viewport = True
    contents = scenes.file_contents()
    with pytest.raises(CageError, match=r"Holes depends on .*\(Falling\).*: enable it, or turn"):
        cage.read(ob, depsgraph())
    assert scenes.file_contents() == contents


def test_disabled_bodies_are_read():
    """Blender simulates them nevertheless."""
    ob = scenes.grid_with_holes()
    rigid_scenes.itself(ob)
    ob.hide_viewport = True
    rigid_scenes.play()
    found = cage.read(ob, depsgraph())
    ob.hide_viewport = False
    bpy.context.view_layer.update()
    np.testing.assert_array_equal(found.matrix, shown(ob).matrix_world)
    assert found.matrix[2, 3] < rigid_scenes.HEIGHT - 2


def test_other_frames_are_refused():
    ob = moved_sheet("hooked")

    def go(_copy, scene):
        scene.frame_float = 10

    with (
        pytest.raises(CageError, match="its shape in frame 10 is needed: go to frame 10"),
        cage.opened(ob, depsgraph(), go),
    ):
        pass
    assert bpy.context.scene.frame_current == 20


def test_lines_of_curves_that_bodies_deform_are_refused():
    body = rigid_scenes.falling()
    bpy.ops.curve.primitive_bezier_curve_add()
    curve = bpy.context.active_object
    rigid_scenes.play()
    lowest = curve_lines.read(curve, depsgraph())[..., 2].min()
    hook = curve.modifiers.new("Hook", "HOOK")
    hook.object = body
    hook.vertex_indices_set([0])
    with pytest.raises(CageError, match=f"{curve.name} depends on"):
        curve_lines.read(curve, depsgraph())
    curve.parent = body  # now both move alike
    lines = curve_lines.read(curve, depsgraph())
    assert lines[..., 2].min() > lowest + 1


def test_other_bodies_make_no_difference(monkeypatch):
    """The private scene is enough then."""
    rigid_scenes.falling()
    ob = scenes.grid_with_holes()
    rigid_scenes.play()
    monkeypatch.delattr(shown_stack, "standing")
    assert len(cage.read(ob, depsgraph()).mesh.positions) == len(ob.data.vertices)
