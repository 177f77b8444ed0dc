# SPDX-License-Identifier: GPL-3.0-or-later
"""Library overrides of surfaces and of what follows them: nothing is written that Blender does not
save.
"""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.nodes import groups
from limit_surface.nodes.follow import TILES
from limit_surface.placing import proxy
from limit_surface.placing.followers import modifier_of
from override_scenes import check_frames, followed, override, reopen, save_collection

CAPTURE = ids.CAPTURE_GROUP


def select(*chosen: bpy.types.Object) -> None:
    """Selects objects, and makes the first one active."""
    bpy.ops.object.select_all(action="DESELECT")
    for ob in chosen:
        ob.select_set(True)
    scenes.activate(chosen[0])


def stack(ob: bpy.types.Object) -> list[str]:
    return [modifier.name for modifier in ob.modifiers]


def polygon_count(ob: bpy.types.Object) -> int:
    return len(ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.polygons)


def test_a_library_override_follows_in_its_own_pose(tmp_path):
    ob, hair = override(save_collection(tmp_path))
    ob.modifiers["Wave"].height = 0.7
    check_frames(ob, hair)
    check_frames(*reopen(tmp_path))


def test_new_hair_on_an_overridden_surface_leaves_overridden_tables_alone(tmp_path):
    ob, hair = override(save_collection(tmp_path))
    table = groups.get_input(modifier_of(hair), TILES)
    assert table.override_library
    assert table.data.library
    rows = len(table.data.vertices)
    layers = bpy.context.view_layer.layer_collection.children
    layer = next(layer for layer in layers if layer.collection.override_library)
    assert ob.name in layer.collection.objects
    bpy.context.view_layer.active_layer_collection = layer
    new = scenes.add_points(ob, follow="NODES")
    own = groups.get_input(modifier_of(new), TILES)
    assert own != table
    assert own.data.library is None
    assert len(table.data.vertices) == rows
    check_frames(ob, hair)


def test_overridden_hair_stays_bound_as_its_own_file_says(tmp_path):
    """Nothing that is written to its points takes effect, so it must keep the tables to which their
    tiles belong. Few strands use other numbers of tiles than the new points do.
    """
    ob, hair = override(save_collection(tmp_path, distribution="UNIFORM", count=12))
    new = scenes.add_points(ob, distribution="UNIFORM", count=20, follow="NODES")
    check_frames(ob, hair)
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.scene.collection.objects.link(empty)
    select(ob, empty)
    assert bpy.ops.object.limit_attach() == {"FINISHED"}
    check_frames(ob, hair)
    for operator in (bpy.ops.object.limit_unbind, bpy.ops.object.limit_rebind):
        select(hair)
        with pytest.raises(RuntimeError, match="Limit Hair is a library override"):
            operator()
    for thing in (new, bpy.data.objects["Limit Carrier of Holes"]):
        select(thing)
        assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    check_frames(ob, hair)
    check_frames(*reopen(tmp_path))


REFUSED: dict[str, dict[str, object]] = {
    "limit_unbind": {},
    "limit_rebind": {},
    "limit_follow": {"mode": "LIVE"},
}


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
@pytest.mark.parametrize("operator", REFUSED)
@pytest.mark.parametrize("which", ["surface", "hair"])
def test_overrides_are_neither_bound_nor_unbound(which, operator, follow, tmp_path):
    ob, hair = override(save_collection(tmp_path, follow=follow))
    chosen, before = ob if which == "surface" else hair, scenes.file_contents()
    stacks, polygons = (stack(ob), stack(hair)), polygon_count(ob)
    select(chosen)
    with pytest.raises(RuntimeError, match="Limit Hair is a library override, and Blender"):
        getattr(bpy.ops.object, operator)(**REFUSED[operator])
    assert scenes.file_contents() == before
    ob, hair = reopen(tmp_path)
    assert (stack(ob), stack(hair)) == stacks
    assert polygon_count(ob) == polygons
    check_frames(ob, hair)


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
@pytest.mark.parametrize("which", ["surface", "hair"])
def test_limit_capture_of_a_library_stays(which, follow, tmp_path):
    """Blender would bring it back when the file is opened, and put a second subdivision before
    it.
    """
    ob, theirs = override(save_collection(tmp_path))
    bpy.data.objects.remove(theirs)
    before, polygons = stack(ob), polygon_count(ob)
    assert before == ["Wave", CAPTURE, "Subdivision"]
    own = scenes.add_hair(ob, follow=follow)
    check_frames(ob, own)
    select(ob if which == "surface" else own)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert not own.modifiers
    assert stack(ob) == before
    path = str(tmp_path / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    ob = next(ob for ob in bpy.data.objects if ob.override_library and ob.name.startswith("Holes"))
    assert stack(ob) == before
    assert polygon_count(ob) == polygons


def test_limit_capture_of_the_file_itself_is_removed_from_an_override(tmp_path):
    ob, hair = override(save_collection(tmp_path, follow="NONE"))
    own = scenes.add_hair(ob, follow="LIVE")
    assert stack(ob) == ["Wave", CAPTURE, "Subdivision"]
    select(own)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert stack(ob) == ["Wave", "Subdivision"]
    ob, hair = reopen(tmp_path)
    assert stack(ob) == ["Wave", "Subdivision"]
    assert not hair.modifiers


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_what_stands_on_an_override_is_bound_and_unbound_beside_overrides(follow, tmp_path):
    ob, hair = override(save_collection(tmp_path, follow=follow))
    own = scenes.add_points(ob, follow="NODES")
    select(ob)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    assert modifier_of(own)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert not own.modifiers
    ob, hair = reopen(tmp_path)
    assert stack(ob) == ["Wave", CAPTURE, "Subdivision"]
    check_frames(ob, hair)


def displaced(ob: bpy.types.Object, name: str) -> None:
    """Adds a modifier between *Limit Capture* and the subdivision."""
    ob.modifiers.new(name, "CAST").factor = 0.3
    ob.modifiers.move(len(ob.modifiers) - 1, ob.modifiers.find("Subdivision"))


def test_limit_capture_passes_modifiers_of_the_file_itself(tmp_path):
    ob, _hair = override(save_collection(tmp_path))
    displaced(ob, "Mine")
    own = scenes.add_points(ob, follow="NODES")
    expected = ["Wave", "Mine", CAPTURE, "Subdivision"]
    assert stack(ob) == expected
    ob, _hair = reopen(tmp_path)
    assert stack(ob) == expected
    assert own


def surface_with_a_modifier_between() -> None:
    ob, _hair = followed()
    displaced(ob, "Theirs")


def test_limit_capture_does_not_pass_modifiers_of_the_library(tmp_path):
    ob, _hair = override(save_collection(tmp_path, surface_with_a_modifier_between))
    before = stack(ob)
    assert before == ["Wave", CAPTURE, "Theirs", "Subdivision"]
    with pytest.raises(RuntimeError, match="in the file from which it comes, move its modifier"):
        scenes.add_points(ob, follow="NODES")
    assert stack(ob) == before


def test_the_copy_of_an_overridden_surface_stays_short(tmp_path):
    ob, _hair = override(save_collection(tmp_path))
    own = scenes.add_hair(ob, follow="NODES")
    select(own)
    assert bpy.ops.object.limit_follow(use_proxy=True) == {"FINISHED"}
    reopen(tmp_path)
    copy = bpy.data.objects["Limit Proxy of Holes"]
    assert stack(copy) == ["Wave", CAPTURE]
    assert copy.override_library is None
    ob = next(ob for ob in bpy.data.objects if ob.override_library and ob.name.startswith("Holes"))
    assert copy.data == ob.data
    own = next(
        ob
        for ob in bpy.data.objects
        if ob.type == "CURVES" and not ob.override_library and not ob.library
    )
    table = groups.get_input(modifier_of(own), TILES)
    modifier = next(groups.modifiers(table, ids.TILES_GROUP))
    assert groups.get_input(modifier, proxy.OBJECT) == copy
    check_frames(ob, own)


def test_overridden_live_children_are_left_alone(tmp_path):
    def with_children() -> None:
        _ob, hair = followed(per_side=1)
        scenes.activate(hair)
        assert bpy.ops.object.limit_children_add(mode="LIVE") == {"FINISHED"}

    ob, _hair = override(save_collection(tmp_path, with_children))
    children = next(
        o for o in bpy.data.objects if o.override_library and ids.CHILDREN_OBJECT in o.name
    )
    for operator in (bpy.ops.object.limit_unbind, bpy.ops.object.limit_rebind):
        select(children)
        with pytest.raises(RuntimeError, match=f"{children.name} is a library override"):
            operator()
    assert ob
    assert stack(children) == [ids.CHILDREN_GROUP]
    assert np.any(children.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.curves)


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_rebinding_names_the_overrides_that_it_leaves_alone(follow, tmp_path, capfd):
    ob, _hair = override(save_collection(tmp_path, follow=follow))
    scenes.add_points(ob, follow="NODES")
    select(ob)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    text = "because Blender would not save the new places of library overrides: Limit Hair"
    assert text in capfd.readouterr().out
