# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers before the subdivision that are enabled in only one of viewport and renders: nodes are
bound to the faces of the viewport.
"""

import bpy
import pytest
import scenes
from follow_scenes import check_hair, deforming, look
from limit_surface import ids

DIFFERENT = "Cross has other faces or creases in renders than in the viewport"


def mirrored(**shown: bool) -> bpy.types.Object:
    ob = deforming("cross")
    mirror = ob.modifiers.new("Mirror", "MIRROR")
    mirror.use_axis = (False, False, True)
    ob.modifiers.move(len(ob.modifiers) - 1, 0)
    for name, value in shown.items():
        setattr(mirror, name, value)
    return ob


@pytest.mark.parametrize("hidden", ["show_viewport", "show_render"])
def test_new_hair_does_not_follow_and_says_why(hidden, capfd):
    hair = scenes.add_hair(mirrored(**{hidden: False}), per_side=1)
    assert ids.TILE not in hair.data.attributes
    said = capfd.readouterr().out
    assert "Warning: " in said
    assert f"do not follow the surface: {DIFFERENT}" in said


def test_following_by_nodes_is_refused_and_live_is_not():
    ob = mirrored(show_viewport=False)
    hair = scenes.add_hair(ob, per_side=1, follow="NONE")
    scenes.activate(hair)
    with pytest.raises(RuntimeError, match=f"{DIFFERENT}, because the modifier Mirror is"):
        bpy.ops.object.limit_follow(mode="NODES")
    assert bpy.ops.object.limit_follow(mode="LIVE") == {"FINISHED"}
    scenes.activate(ob)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}


def test_a_modifier_that_is_disabled_later_is_named(tmp_path, capfd):
    ob = mirrored()
    hair = scenes.add_hair(ob, per_side=1, follow="NODES")
    scenes.activate(ob)
    assert look(ob) == []
    ob.modifiers["Mirror"].show_render = False
    bpy.context.view_layer.update()
    check_hair(ob, hair)
    ((text, remedy),) = look(ob)
    assert text.startswith(DIFFERENT)
    assert not remedy
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    capfd.readouterr()
    bpy.ops.wm.open_mainfile(filepath=path)
    assert f"Limit Surface: {DIFFERENT}" in capfd.readouterr().out


def test_what_keeps_the_faces_is_no_trouble():
    ob = deforming("cross")
    ob.modifiers["Wave"].show_render = False
    split = ob.modifiers.new("Split", "EDGE_SPLIT")
    split.use_edge_angle = split.use_edge_sharp = split.show_render = False
    ob.modifiers.move(len(ob.modifiers) - 1, 0)
    hair = scenes.add_hair(ob, per_side=1)
    assert ids.TILE in hair.data.attributes
    assert look(ob) == []
