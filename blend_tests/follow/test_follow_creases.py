# SPDX-License-Identifier: GPL-3.0-or-later
"""Things that follow by nodes a surface whose creases change: they stand at rest until they are
bound again.
"""

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming, follow, look
from limit_surface import ids
from limit_surface.nodes import groups
from limit_surface.nodes.capture import crease_sum
from limit_surface.nodes.tiles import GUARDS_CREASES, TILES
from limit_surface.reading import attributes
from live_scenes import animate_creases

CREASES = {
    "edges": (ids.EDGE_CREASE, "EDGE"),
    "vertices": (ids.VERTEX_CREASE, "POINT"),
}


def crease(ob: bpy.types.Object, what: str, seed: int) -> None:
    """Gives a third of the edges or vertices creases."""
    name, domain = CREASES[what]
    count = len(ob.data.edges if domain == "EDGE" else ob.data.vertices)
    rng = np.random.default_rng(seed)
    values = np.where(rng.random(count) < 0.3, rng.random(count), 0).astype(np.float32)
    attributes.write(ob.data, name, "FLOAT", domain, values)
    ob.data.update_tag()


def is_at_rest(hair: bpy.types.Object) -> bool:
    difference = np.abs(follow_truth.shown_strands(hair) - scenes.strands(hair))
    return bool(difference.max() < 1e-6)


def table() -> bpy.types.Object:
    return bpy.data.objects[f"{ids.TILES_TABLE} of Holes"]


@pytest.mark.parametrize("what", CREASES)
def test_changed_creases_leave_things_at_rest_until_they_are_bound_again(what):
    ob = deforming("grid with holes")
    crease(ob, what, 1)
    before = attributes.read(ob.data, CREASES[what][0])
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)
    crease(ob, what, 2)
    bpy.context.view_layer.update()
    assert is_at_rest(hair)
    name, domain = CREASES[what]
    attributes.write(ob.data, name, "FLOAT", domain, before)
    ob.data.update_tag()
    bpy.context.view_layer.update()
    assert not is_at_rest(hair)
    check_hair(ob, hair)
    crease(ob, what, 2)
    scenes.activate(hair)
    assert bpy.ops.object.limit_rebind(method="FACE") == {"FINISHED"}
    assert not is_at_rest(hair)
    check_hair(ob, hair)


@pytest.mark.parametrize("what", CREASES)
def test_one_crease_that_changes_a_little_is_noticed(what):
    ob = deforming("grid with holes")
    crease(ob, what, 1)
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.context.scene.frame_set(30)
    name, domain = CREASES[what]
    creases = attributes.read(ob.data, name)
    at = np.argmax(creases)
    creases[at] -= 2e-7
    attributes.write(ob.data, name, "FLOAT", domain, creases)
    ob.data.update_tag()
    bpy.context.view_layer.update()
    assert is_at_rest(hair)


def test_creases_that_are_swapped_have_another_checksum():
    creases = np.array([0.25, 0.5, 0, 1], np.float32)
    assert crease_sum(creases) != crease_sum(creases[[1, 0, 2, 3]])
    assert crease_sum(creases) != crease_sum(creases[[2, 1, 0, 3]])
    assert crease_sum(np.zeros(3)) == crease_sum(np.zeros(5)) == 0


@pytest.mark.parametrize("value", [-0.5, 1.5, 3e7])
def test_creases_out_of_range_are_compared_as_nodes_compute_them(value):
    ob = deforming("grid with holes")
    values = np.zeros(len(ob.data.edges), np.float32)
    values[[3, 11]] = value, 0.3
    attributes.write(ob.data, ids.EDGE_CREASE, "FLOAT", "EDGE", values)
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.context.scene.frame_set(30)
    assert not is_at_rest(hair)


@pytest.mark.parametrize("why", ["creases are off", "simple", "another domain"])
def test_creases_without_influence_or_of_another_form_are_not_compared(why):
    ob = deforming("grid with holes")
    if why == "creases are off":
        ob.modifiers["Subdivision"].use_creases = False
    elif why == "simple":
        ob.modifiers["Subdivision"].subdivision_type = "SIMPLE"
    else:
        values = np.linspace(0, 0.7, len(ob.data.vertices))
        attributes.write(ob.data, ids.EDGE_CREASE, "FLOAT", "POINT", values)
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.context.scene.frame_set(30)
    assert not is_at_rest(hair)
    crease(ob, "vertices", 3)
    bpy.context.view_layer.update()
    assert not is_at_rest(hair)


def test_the_panel_says_that_things_are_at_rest():
    ob = deforming("grid with holes")
    scenes.add_hair(ob, follow="NODES")
    crease(ob, "edges", 1)
    bpy.context.view_layer.update()
    told = (
        "The creases or subdivision settings of Holes have changed since its tables were made. "
        "What follows Holes by nodes is at rest until you run Rebind to Limit Surface. If the "
        "creases are animated, use the mode Live"
    )
    assert look(ob) == [(told, ids.REBIND)]


@pytest.mark.skipif(
    not hasattr(bpy.types, "GeometryNodeWarning"), reason="Blender 4.2 has no warnings"
)
def test_the_modifier_warns():
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="NODES")
    modifier = hair.modifiers[ids.FOLLOW_HAIR_GROUP]
    bpy.context.view_layer.update()
    assert not modifier.node_warnings
    crease(ob, "edges", 1)
    bpy.context.view_layer.update()
    (warning,) = modifier.node_warnings
    assert "Creases that are animated need the mode Live" in warning.message


def test_animated_creases_move_things_in_the_frame_of_their_binding_alone():
    ob = scenes.grid_with_holes()
    animate_creases(ob)
    follow_truth.animate(ob)
    scenes.add_subsurf(ob)
    hair = scenes.add_hair(ob, follow="NONE")
    bpy.context.scene.frame_set(12)
    follow(hair)
    for frame in (1, 11, 13, 30):
        bpy.context.scene.frame_set(frame)
        assert is_at_rest(hair)
    bpy.context.scene.frame_set(12)
    assert not is_at_rest(hair)
    check_hair(ob, hair)


def test_tables_of_the_version_without_creases_work_and_are_brought_up_to_date():
    ob = deforming("grid with holes")
    crease(ob, "edges", 1)
    hair = scenes.add_hair(ob, follow="NODES")
    modifier = next(groups.modifiers(table(), ids.TILES_GROUP))
    older = modifier.node_group
    older[ids.GROUP_MARK] = f"{ids.TILES_GROUP} 1"
    for name in (GUARDS_CREASES, "Cage Edge Creases", "Cage Vertex Creases"):
        older.interface.remove(older.interface.items_tree[name])
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)
    crease(ob, "edges", 2)
    bpy.context.view_layer.update()
    assert not is_at_rest(hair)
    follow(scenes.add_points(ob, follow="NONE"))
    assert modifier.node_group != older
    assert TILES.matches(modifier.node_group)
    check_hair(ob, hair)
    crease(ob, "edges", 3)
    bpy.context.view_layer.update()
    assert is_at_rest(hair)
