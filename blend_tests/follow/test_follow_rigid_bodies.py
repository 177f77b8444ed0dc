# SPDX-License-Identifier: GPL-3.0-or-later
"""What follows a surface that rigid bodies move is bound and unbound where it is shown."""

import bpy
import numpy as np
import pytest
import rigid_scenes
import scenes
from limit_surface import ids
from limit_surface.attach import parenting
from limit_surface.reading import attributes

MOST = 1e-6  # by how much strands may move, in units of the sheet's faces


def hair_on_moved_sheet(relation, **properties):
    ob = scenes.grid_with_holes()
    rigid_scenes.RELATIONS[relation](ob)
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, per_side=2, **properties)
    rigid_scenes.play()
    return ob, hair


def shown_points(ob):
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return attributes.read(ob.evaluated_get(depsgraph).data, ids.POSITION).copy()


@pytest.mark.parametrize(
    ("relation", "method"), [("itself", "CLOSEST"), ("child", "CLOSEST"), ("hooked", "FACE")]
)
@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_binding_again_moves_nothing(relation, method, follow):
    ob, hair = hair_on_moved_sheet(relation, follow=follow)
    shown, face = shown_points(hair), attributes.read(hair.data, ids.FACE)
    scenes.activate(ob)
    assert bpy.ops.object.limit_rebind(method=method) == {"FINISHED"}
    np.testing.assert_array_equal(attributes.read(hair.data, ids.FACE), face)
    np.testing.assert_allclose(shown_points(hair), shown, atol=MOST)


@pytest.mark.parametrize("relation", ["itself", "child", "hooked"])
@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_unbinding_moves_nothing(relation, follow):
    _, hair = hair_on_moved_sheet(relation, follow=follow)
    shown = shown_points(hair)
    scenes.activate(hair)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    np.testing.assert_allclose(shown_points(hair), shown, atol=MOST)


def test_unbinding_from_a_disabled_surface_moves_nothing():
    """What follows the surface has it evaluated."""
    ob, hair = hair_on_moved_sheet("child", follow="NODES")
    ob.hide_viewport = True
    shown, face = shown_points(hair), attributes.read(hair.data, ids.FACE)
    scenes.activate(hair)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    np.testing.assert_allclose(shown_points(hair), shown, atol=MOST)
    np.testing.assert_array_equal(attributes.read(hair.data, ids.FACE), face)


def test_hair_from_elsewhere_stays_where_it_is():
    ob = scenes.grid_with_holes()
    rigid_scenes.itself(ob)
    scenes.add_subsurf(ob)
    rigid_scenes.play()
    matrix = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world.copy()
    data = bpy.data.hair_curves.new("Groom")
    data.add_curves([2])
    for point, height in zip(data.points, (0.1, 0.4), strict=True):
        point.position = matrix @ ob.data.vertices[0].co
        point.position.z += height
    hair = bpy.data.objects.new("Groom", data)
    bpy.context.collection.objects.link(hair)
    shown = shown_points(hair)
    scenes.activate(ob)
    hair.select_set(True)
    assert bpy.ops.object.limit_follow(mode="NODES") == {"FINISHED"}
    np.testing.assert_allclose(shown_points(hair), shown, atol=MOST)


@pytest.mark.parametrize("most", [1, parenting.MOST_PROBES])
def test_attached_objects_stay_where_they_are(most, monkeypatch):
    monkeypatch.setattr(parenting, "MOST_PROBES", most)
    ob = scenes.grid_with_holes()
    rigid_scenes.child(ob)
    scenes.add_subsurf(ob)
    rigid_scenes.play()
    buttons = [bpy.data.objects.new("Button", None) for _ in range(3)]
    for i, button in enumerate(buttons):
        bpy.context.collection.objects.link(button)
        button.location = (1 + i, 1, 1)
        button.select_set(True)
    scenes.activate(ob)
    assert bpy.ops.object.limit_attach() == {"FINISHED"}
    bpy.context.view_layer.update()
    for i, button in enumerate(buttons):
        np.testing.assert_allclose(button.matrix_world.translation, (1 + i, 1, 1), atol=1e-5)
