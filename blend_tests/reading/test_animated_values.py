# SPDX-License-Identifier: GPL-3.0-or-later
"""Values that are animated and were changed without a key: Blender shows them until the frame
changes. Hair stands on what is shown, and the values stay.
"""

from collections.abc import Callable

import bpy
import live_scenes
import numpy as np
import pytest
import scenes
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.placing import live_surface
from limit_surface.reading import attributes, cage

FRAME = 12


def shape_key() -> tuple[bpy.types.Object, Callable[[], float], Callable[[float], None]]:
    ob = deforming("cross")
    block = ob.data.shape_keys.key_blocks["Bent"]
    return ob, lambda: block.value, lambda value: setattr(block, "value", value)


def bone() -> tuple[bpy.types.Object, Callable[[], float], Callable[[float], None]]:
    ob = live_scenes.with_armature("grid with holes")
    rotation = bpy.data.objects["Rig"].pose.bones["Left"].rotation_euler
    return ob, lambda: rotation[1], lambda value: rotation.__setitem__(1, value)


def modifier() -> tuple[bpy.types.Object, Callable[[], float], Callable[[float], None]]:
    ob = scenes.cross()
    bend = ob.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method = "BEND"
    for frame, angle in ((1, 0.0), (30, 0.5)):
        bend.angle = angle
        bend.keyframe_insert("angle", frame=frame)
    scenes.add_subsurf(ob)
    return ob, lambda: bend.angle, lambda value: setattr(bend, "angle", value)


def property_in_a_strip() -> tuple[bpy.types.Object, Callable[[], float], Callable[[float], None]]:
    """A custom property that drives a shape key, animated by a strip of the NLA."""
    ob = deforming("cross")
    ob.data.shape_keys.animation_data_clear()
    ob["bent"] = 0.0
    for frame, value in ((1, 0.0), (30, 1.0)):
        ob["bent"] = value
        ob.keyframe_insert('["bent"]', frame=frame)
    animation = ob.animation_data
    action, animation.action = animation.action, None
    animation.nla_tracks.new().strips.new("Strip", 1, action)
    driver = ob.data.shape_keys.key_blocks["Bent"].driver_add("value").driver
    variable = driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = ob, '["bent"]'
    driver.expression = "var"
    return ob, lambda: ob["bent"], lambda value: ob.__setitem__("bent", value)


@pytest.mark.parametrize("kind", [shape_key, bone, modifier, property_in_a_strip])
def test_hair_stands_on_what_is_shown(kind):
    ob, get, put = kind()
    bpy.context.scene.frame_set(FRAME)
    keyed = get()
    hair = scenes.add_hair(ob, follow="NONE")
    at_key = attributes.read(hair.data, ids.REST_ROOT)
    assert get() == keyed
    put(keyed + 0.4)
    ob.update_tag()
    bpy.context.view_layer.update()
    hair = scenes.add_hair(ob, follow="NONE")
    np.testing.assert_allclose(get(), keyed + 0.4, atol=1e-6)
    shown = scenes.surface_without_addon(ob).evaluate(*scenes.locations(hair.data)).position
    root = attributes.read(hair.data, ids.REST_ROOT)
    np.testing.assert_allclose(root, shown, atol=1e-5)
    assert np.abs(root - at_key).max() > 0.01


def test_a_look_at_another_frame_leaves_them():
    ob, get, put = shape_key()
    bpy.context.scene.frame_set(FRAME)
    put(0.9)
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    other = live_surface.surface_at(ob, depsgraph, 1.0).positions
    np.testing.assert_allclose(get(), 0.9, atol=1e-6)
    bpy.context.scene.frame_set(1)
    at_frame = cage.read(ob, bpy.context.evaluated_depsgraph_get()).mesh.positions
    np.testing.assert_allclose(other, at_frame, atol=1e-6)


def test_keyed_values_are_not_touched():
    """A frame later they are those of the curves."""
    ob, get, put = bone()
    bpy.context.scene.frame_set(FRAME)
    put(0.2)
    bpy.context.view_layer.update()
    cage.read(ob, bpy.context.evaluated_depsgraph_get())
    bpy.context.scene.frame_set(FRAME + 1)
    now = get()
    bpy.context.scene.frame_set(FRAME)
    bpy.context.scene.frame_set(FRAME + 1)
    assert get() == now
