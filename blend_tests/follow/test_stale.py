# SPDX-License-Identifier: GPL-3.0-or-later
"""Bindings that are stale or broken: they are seen, named in the sidebar, and mended."""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import follow_truth
import live_scenes
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming, follow, look
from limit_surface import ids
from limit_surface.follow import stale
from limit_surface.follow.panel import VIEW3D_PT_limit_follow
from limit_surface.placing import live_kept
from limit_surface.placing.follow_state import State


def followed() -> tuple[bpy.types.Object, bpy.types.Object]:
    ob = deforming("grid with holes")
    return ob, scenes.add_hair(ob, follow="NODES")


def table(kind: str) -> bpy.types.Object:
    return bpy.data.objects[f"{kind} of Holes"]


def remove_capture(ob: bpy.types.Object) -> None:
    ob.modifiers.remove(ob.modifiers[ids.CAPTURE_GROUP])


def move_capture(ob: bpy.types.Object) -> None:
    ob.modifiers.move(ob.modifiers.find(ids.CAPTURE_GROUP), 0)


def disable_capture(ob: bpy.types.Object) -> None:
    ob.modifiers[ids.CAPTURE_GROUP].show_viewport = False


def subdivide_first(ob: bpy.types.Object) -> None:
    scenes.add_subsurf(ob)
    ob.modifiers.move(len(ob.modifiers) - 1, 0)


LOST = (
    "Limit Hair has lost the modifier by which it followed: the modifier was deleted or applied, "
    "or its node group was deleted. If it was applied, first go to the frame in which that was done"
)
WITHOUT = (
    "Without it, what follows Holes by nodes does not move, and what follows it live is slower"
)
BREAKS = {
    "tiles": (
        lambda _ob, _hair: bpy.data.objects.remove(table(ids.TILES_TABLE)),
        "The hidden tables that Limit Hair reads were deleted",
    ),
    "points": (
        lambda _ob, _hair: bpy.data.objects.remove(table(ids.POINTS_TABLE)),
        "The hidden tables that Limit Hair reads were deleted",
    ),
    "modifier": (
        lambda _ob, hair: hair.modifiers.clear(),
        LOST,
    ),
    "group": (
        lambda _ob, _hair: bpy.data.node_groups.remove(bpy.data.node_groups[ids.FOLLOW_HAIR_GROUP]),
        LOST,
    ),
    "group within": (
        lambda _ob, _hair: bpy.data.node_groups.remove(bpy.data.node_groups[ids.SAMPLE_TILE_GROUP]),
        "A node group that Limit Hair needs was deleted",
    ),
    "group of tables": (
        lambda _ob, _hair: bpy.data.node_groups.remove(bpy.data.node_groups[ids.TILES_GROUP]),
        "A node group that Limit Tiles of Holes needs was deleted",
    ),
    "group of the surface": (
        lambda _ob, _hair: bpy.data.node_groups.remove(bpy.data.node_groups[ids.CAPTURE_GROUP]),
        "A node group that Holes needs was deleted",
    ),
    "capture": (
        lambda ob, _hair: remove_capture(ob),
        f"Holes: the modifier Limit Capture was deleted. {WITHOUT}",
    ),
    "place of capture": (
        lambda ob, _hair: move_capture(ob),
        "Holes: the modifier Limit Capture is not directly before the Subdivision Surface modifier",
    ),
    "disabled capture": (
        lambda ob, _hair: disable_capture(ob),
        f"Holes: the modifier Limit Capture is disabled. {WITHOUT}",
    ),
}


@pytest.mark.parametrize("by", ["surface", *scenes.slow("hair")])
@pytest.mark.parametrize("what", BREAKS)
def test_what_was_deleted_by_hand_is_restored_by_one_button(what, by):
    ob, hair = followed()
    spoil, told = BREAKS[what]
    assert look(ob) == []
    contents = {kind: len(names) for kind, names in scenes.file_contents().items()}
    rest = scenes.strands(hair)
    spoil(ob, hair)
    bpy.context.scene.frame_set(30)
    if what != "place of capture":
        np.testing.assert_allclose(follow_truth.shown_strands(hair), rest, atol=1e-6)
    assert (told, ids.FOLLOW) in look(ob)
    bpy.ops.object.select_all(action="DESELECT")
    follow(ob if by == "surface" else hair)
    assert look(ob) == []
    bpy.context.scene.frame_set(17)
    check_hair(ob, hair)
    now = {kind: len(names) for kind, names in scenes.file_contents().items()}
    more = {kind: n - contents[kind] for kind, n in now.items() if n > contents[kind]}
    # what lost its use is not saved: the mesh of a deleted table, a group that lost another one
    assert more == {"tiles": {"meshes": 1}, "points": {"meshes": 1}}.get(what, {}) or (
        more == {"node_groups": 1} and what == "group within"
    )


def test_a_duplicate_of_surface_and_hair_reads_tables_of_its_own_once_it_is_bound():
    ob, hair = followed()
    bpy.ops.object.select_all(action="DESELECT")
    for thing in (ob, hair):
        thing.select_set(True)
    scenes.activate(ob)
    bpy.ops.object.duplicate()
    twin_hair = next(o for o in bpy.context.selected_objects if o.type == "CURVES")
    twin = next(o for o in bpy.context.selected_objects if o.type == "MESH")
    text = f"{twin_hair.name} follows {twin.name}, but reads the tables of Holes"
    assert look(twin) == [(text, ids.FOLLOW)]
    bpy.ops.object.select_all(action="DESELECT")
    follow(twin)
    assert look(twin) == look(ob) == []
    twin.data.shape_keys.animation_data_clear()
    twin.data.shape_keys.key_blocks["Bent"].value = 0.5
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)
    check_hair(twin, twin_hair)


def test_a_duplicate_whose_original_was_deleted_is_named():
    ob, hair = followed()
    for thing in (ob, hair):
        thing.select_set(True)
    scenes.activate(ob)
    bpy.ops.object.duplicate()
    twin = next(o for o in bpy.context.selected_objects if o.type == "MESH")
    for thing in (hair, ob):
        bpy.data.objects.remove(thing)
    text = f"Limit Hair.001 follows {twin.name}, but reads the tables of a surface that was deleted"
    assert look(twin) == [(text, ids.FOLLOW)]
    follow(twin)
    assert look(twin) == []


def test_changed_faces_and_rules_are_named():
    ob, _hair = followed()
    ob.modifiers["Subdivision"].boundary_smooth = "PRESERVE_CORNERS"
    bpy.context.view_layer.update()
    rules = "The creases or subdivision settings of Holes have changed since its tables were made"
    assert look(ob) == [(rules, ids.REBIND)]
    scenes.activate(ob)
    bpy.ops.object.limit_rebind(method="FACE")
    assert look(ob) == []
    mirror = ob.modifiers.new("Mirror", "MIRROR")
    ob.modifiers.move(ob.modifiers.find(mirror.name), 0)
    bpy.context.view_layer.update()
    faces = "The faces of Holes have changed since Limit Hair was bound"
    assert look(ob) == [(faces, ids.REBIND)]
    bpy.ops.object.limit_rebind()
    assert look(ob) == []


def test_stale_bindings_are_seen_when_a_file_is_loaded(tmp_path, capfd):
    ob, _hair = followed()
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert "Limit Surface:" not in capfd.readouterr().out
    ob = bpy.data.objects["Holes"]
    ob.modifiers["Subdivision"].boundary_smooth = "PRESERVE_CORNERS"
    bpy.data.objects.remove(table(ids.POINTS_TABLE))
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    lines = capfd.readouterr().out.splitlines()
    assert [line for line in lines if line.startswith("Limit Surface:")] == [
        "Limit Surface: The hidden tables that Limit Hair reads were deleted",
        "Limit Surface: The creases or subdivision settings of Holes have changed since its tables "
        "were made",
    ]


def test_nothing_is_read_while_the_panel_is_drawn(monkeypatch):
    ob, _hair = followed()
    state = State.of(ob)
    stale._forget()

    def fail(*_arguments):
        pytest.fail("The control mesh was read")

    monkeypatch.setattr(stale.cage, "read", fail)
    assert stale.troubles(bpy.context, state) == []
    assert bpy.app.timers.is_registered(stale._look)
    bpy.app.timers.unregister(stale._look)


def test_the_state_counts():
    ob, hair = followed()
    points = scenes.add_points(ob, follow="NODES")
    for thing in (ob, hair, points):
        state = State.of(thing)
        assert state.surface == ob
        assert set(state.followers) == {hair, points}
        assert state.places == len(hair.data.curves) + len(points.data.vertices)
        rows = len(table(ids.POINTS_TABLE).data.vertices)
        tiles = len(table(ids.TILES_TABLE).data.vertices)
        assert state.table_bytes >= rows * 28 + tiles * 44
        assert state.table_bytes < rows * 40 + tiles * 80
    assert State.of(scenes.cross()) is None
    assert State.of(None) is None


def panel(ob: bpy.types.Object) -> tuple[str, list[str]]:
    """Returns the text of the panel, and the operators that it offers."""
    scenes.activate(ob)
    layout = MagicMock()
    for maker in (layout.column, layout.row, layout.box):
        maker.return_value = layout
    VIEW3D_PT_limit_follow.draw(SimpleNamespace(layout=layout), bpy.context)
    lines = [call.kwargs["text"] for call in layout.label.call_args_list]
    return " ".join(lines), [call.args[0] for call in layout.operator.call_args_list]


@pytest.mark.parametrize("breaks", [remove_capture, disable_capture, move_capture, subdivide_first])
def test_live_hair_follows_wherever_limit_capture_is(breaks):
    ob = deforming("grid with holes")
    hair = scenes.add_hair(ob, follow="LIVE")
    breaks(ob)
    for frame in (1, 20):
        bpy.context.scene.frame_set(frame)
        live_scenes.check_hair(ob, hair)
        assert live_kept.trouble(hair) == ""
    text, offered = panel(ob)
    assert f"Holes: the modifier {ids.CAPTURE_GROUP} " in text
    if breaks in (move_capture, subdivide_first):
        assert text.endswith("is not directly before the Subdivision Surface modifier")
    assert offered[0] == ids.FOLLOW
    bpy.ops.object.select_all(action="DESELECT")
    ob.select_set(True)
    scenes.activate(ob)
    assert bpy.ops.object.limit_follow() == {"FINISHED"}
    text, offered = panel(ob)
    assert ids.CAPTURE_GROUP not in text
    assert len(offered) == 3
    bpy.context.scene.frame_set(9)
    live_scenes.check_hair(ob, hair)


def test_the_panel_names_what_follows_and_what_is_wrong():
    buttons = [ids.FOLLOW, ids.REBIND, ids.UNBIND]
    assert panel(scenes.cross()) == ("Nothing follows the active object", buttons)
    ob, hair = followed()
    look(ob)
    text, offered = panel(hair)
    assert text.startswith("Holes 1 object follows it by nodes 288 strands and points Tables: ")
    assert text.endswith(" kB")
    assert offered == buttons
    ob.modifiers["Subdivision"].boundary_smooth = "PRESERVE_CORNERS"
    bpy.context.view_layer.update()
    look(ob)
    text, offered = panel(ob)
    assert text.endswith(
        "The creases or subdivision settings of Holes have changed since its tables were made"
    )
    assert offered == [ids.REBIND, *buttons]
