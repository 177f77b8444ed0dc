# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair whose surface was deleted."""

import bpy
import pytest
import scenes
from particle_scenes import add_hair


def test_hair_whose_surface_was_deleted_gets_another_one():
    ob = scenes.cross()
    hair = add_hair(ob)
    bpy.data.objects.remove(ob)
    bpy.context.view_layer.update()
    scenes.activate(hair)
    advice = f"The surface of {hair.name} was deleted: select the hair and then another mesh, and "
    advice += "run Snap to Limit Surface"
    with pytest.raises(RuntimeError, match=advice):
        bpy.ops.object.limit_particles_from_hair()
    with pytest.raises(RuntimeError, match=advice):
        bpy.ops.object.limit_children_add()
    hair.select_set(True)
    scenes.activate(scenes.flat_grid(4))
    assert bpy.ops.object.limit_snap() == {"FINISHED"}
    scenes.activate(hair)
    assert bpy.ops.object.limit_particles_from_hair() == {"FINISHED"}
