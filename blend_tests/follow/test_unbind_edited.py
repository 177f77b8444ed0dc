# SPDX-License-Identifier: GPL-3.0-or-later
"""Nothing is unbound while the surface cannot be read: places would be lost, and so would edits."""

from collections.abc import Callable

import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from children_scenes import add_children
from limit_surface import ids
from limit_surface.reading import attributes

MODES = ["NODES", "LIVE"]


@pytest.fixture
def ob() -> bpy.types.Object:
    made = scenes.grid_with_holes()
    scenes.add_subsurf(made)
    bpy.context.scene.tool_settings.lock_object_mode = False
    return made


def enter(mode: str, ob: bpy.types.Object) -> None:
    choose(ob)  # Blender enters Edit Mode with all that are selected
    bpy.ops.object.mode_set(mode=mode)


def edit(ob: bpy.types.Object) -> None:
    enter("EDIT", ob)


def edit_a_duplicate(ob: bpy.types.Object) -> None:
    twin = bpy.data.objects.new("Twin", ob.data)
    bpy.context.collection.objects.link(twin)
    enter("EDIT", twin)


def sculpt_with_dyntopo(ob: bpy.types.Object) -> None:
    enter("SCULPT", ob)
    bpy.ops.sculpt.dynamic_topology_toggle()


def hide_in_this_frame(ob: bpy.types.Object) -> None:
    ob.hide_viewport = True
    ob.keyframe_insert("hide_viewport")
    bpy.context.view_layer.update()


def stored(ob: bpy.types.Object) -> dict[str, object]:
    """Returns what an object stores: its modifiers, attributes and properties."""
    names = [name for name, _ in ob.data.attributes.items() if not name.startswith(".")]
    values = {name: attributes.read(ob.data, name).tobytes() for name in names}
    return values | {"modifiers": ob.modifiers.keys(), "properties": sorted(ob.data.keys())}


def choose(*things: bpy.types.Object) -> None:
    """Selects just these objects. In Edit Mode no operator could do that."""
    for ob in bpy.context.view_layer.objects:
        ob.select_set(ob in things)
    scenes.activate(things[-1])


def refused(*things: bpy.types.Object, match: str, shape: str = "SHOWN") -> None:
    choose(*things)
    before = [stored(thing) for thing in things]
    with pytest.raises(RuntimeError, match=match):
        bpy.ops.object.limit_unbind(shape=shape)
    assert [stored(thing) for thing in things] == before


@pytest.mark.parametrize("follow", MODES)
@pytest.mark.parametrize(
    ("begin", "match"),
    [
        (edit, "Holes is in Edit Mode: leave it first"),
        (edit_a_duplicate, "Holes is in Edit Mode: leave it first"),
        (sculpt_with_dyntopo, "Holes is in Sculpt Mode with Dyntopo: leave it first"),
        (hide_in_this_frame, "Holes is hidden in the viewport at this frame"),
    ],
)
def test_hair_keeps_its_places(
    ob: bpy.types.Object, begin: Callable[[bpy.types.Object], None], match: str, follow: str
):
    hair = scenes.add_hair(ob, follow=follow)
    begin(ob)
    refused(hair, match=match)


@pytest.mark.parametrize("follow", MODES)
def test_all_that_follows_the_surface_keeps_its_places(ob, follow):
    things = [scenes.add_hair(ob, follow=follow), scenes.add_points(ob, follow=follow)]
    before = [stored(thing) for thing in things]
    edit_a_duplicate(ob)
    choose(ob)  # nothing else is selected, so that all that follows it is unbound
    with pytest.raises(RuntimeError, match="Holes is in Edit Mode"):
        bpy.ops.object.limit_unbind()
    assert [stored(thing) for thing in things] == before


def test_live_children_stay(ob):
    children = add_children(scenes.add_hair(ob, follow="NODES"), mode="LIVE", count=20)
    edit(ob)
    refused(children, match="Holes is in Edit Mode")


def test_what_was_combed_meanwhile_is_not_lost(ob):
    """Its shape at rest is not known before the surface can be read again."""
    hair = scenes.add_hair(ob, follow="LIVE", points=4)
    edit(ob)
    combed = attributes.read(hair.data, ids.POSITION)
    combed[1::4] += 0.1
    attributes.write(hair.data, ids.POSITION, "FLOAT_VECTOR", "POINT", combed)
    hair.data.update_tag()
    bpy.context.view_layer.update()
    refused(hair, match="Holes is in Edit Mode", shape="REST")
    enter("OBJECT", ob)
    choose(hair)
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    np.testing.assert_allclose(attributes.read(hair.data, ids.POSITION), combed, atol=1e-5)


def test_at_rest_nodes_do_not_need_the_surface(ob):
    hair = scenes.add_hair(ob, follow="NODES")
    rest, faces = scenes.strands(hair), attributes.read(hair.data, ids.FACE)
    edit(ob)
    choose(hair)
    assert bpy.ops.object.limit_unbind(shape="REST") == {"FINISHED"}
    np.testing.assert_array_equal(follow_truth.shown_strands(hair), rest)
    np.testing.assert_array_equal(attributes.read(hair.data, ids.FACE), faces)


@pytest.mark.parametrize("operator", ["limit_hair_add", "limit_follow", "limit_rebind"])
def test_operators_that_read_the_surface_refuse_dyntopo(ob, operator):
    hair = scenes.add_hair(ob, follow="NODES")
    sculpt_with_dyntopo(ob)
    choose(hair)
    before = stored(hair)
    with pytest.raises(RuntimeError, match="Sculpt Mode with Dyntopo"):
        getattr(bpy.ops.object, operator)()
    assert stored(hair) == before
