# SPDX-License-Identifier: GPL-3.0-or-later
"""Live following of surfaces whose animated values were changed without a key, and surfaces that
cannot be read.
"""

import bpy
import contents
import live_scenes
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live, live_kept
from limit_surface.placing.live_surface import LiveSurface
from limit_surface.reading import attributes
from live_scenes import check_hair, follow

SHIFT = 3.0
TWEAKED = 0.9  # frame 2 shows 0.5


@pytest.fixture
def surface(capfd):
    """A grid that a shape key shifts. Nothing may be printed about errors in handlers."""
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Shifted")
    shifted = attributes.read(ob.data, ids.POSITION) + np.float32([SHIFT, 0, 0])
    key.data.foreach_set("co", shifted.ravel())
    for frame, value in ((1, 0.0), (3, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    bpy.context.scene.frame_set(2)
    yield ob
    assert "Traceback" not in capfd.readouterr().err


def tweak(ob: bpy.types.Object, value: float = TWEAKED) -> None:
    ob.data.shape_keys.key_blocks["Shifted"].value = value
    bpy.context.view_layer.update()


def shown_value(ob: bpy.types.Object) -> float:
    """Returns what Blender shows: when it opens a file, it may keep the value or animate it."""
    keys = ob.data.shape_keys.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return keys.key_blocks["Shifted"].value


def check(ob: bpy.types.Object, hair: bpy.types.Object, value: float = TWEAKED) -> None:
    """The surface is made of the mesh at rest, so that checking evaluates nothing again."""
    positions = np.empty(3 * len(ob.data.vertices), np.float32)
    ob.data.shape_keys.reference_key.data.foreach_get("co", positions)
    limit = live_scenes.limit_of(hair)
    limit.set_positions(positions.reshape(-1, 3).astype(np.float64) + [SHIFT * value, 0, 0])
    check_hair(ob, hair, limit)
    assert np.isclose(ob.data.shape_keys.key_blocks["Shifted"].value, value)
    assert live_kept.trouble(hair) == ""


def test_new_hair_follows_where_it_is_shown(surface):
    tweak(surface)
    hair = scenes.add_hair(surface, follow="LIVE")
    check(surface, hair)
    points = scenes.add_points(surface, follow="LIVE")
    tweak(surface, 0.2)
    check(surface, hair, 0.2)
    assert live_kept.trouble(points) == ""
    bpy.context.scene.frame_set(3)
    check(surface, hair, 1.0)


def test_hair_is_bound_again_where_it_is_shown(surface):
    hair = scenes.add_hair(surface, follow="LIVE")
    tweak(surface)
    scenes.activate(surface)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(surface, hair)
    follow(hair)
    check(surface, hair)


def test_a_file_is_opened(surface, tmp_path):
    scenes.add_hair(surface, follow="LIVE")
    tweak(surface)
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    hair = next(ob for ob in bpy.data.objects if ob.type == "CURVES")
    check(hair.data.surface, hair, shown_value(hair.data.surface))


def test_overrides_are_opened(surface, tmp_path):
    hair = scenes.add_hair(surface, follow="LIVE")
    scenes.overridden(tmp_path, surface, hair)
    bpy.context.scene.frame_set(3)  # the library file holds the values of frame 2
    path = str(tmp_path / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    ob, hair = (bpy.context.scene.objects[name] for name in ("Holes", "Limit Hair"))
    check(ob, hair, shown_value(ob))


def test_a_surface_is_in_two_scenes_at_different_frames(surface):
    hair = scenes.add_hair(surface, follow="LIVE")
    other = bpy.data.scenes.new("Other")
    for ob in (surface, hair):
        other.collection.objects.link(ob)
    other.frame_set(3)
    bpy.context.window.scene = other
    scenes.add_hair(surface, follow="AUTO")
    scenes.activate(surface)
    assert bpy.ops.object.limit_rebind() == {"FINISHED"}
    check(surface, hair, 1.0)


def failing_on(surface: bpy.types.Object, monkeypatch: pytest.MonkeyPatch) -> None:
    read = LiveSurface.read

    def fail(self, ob, depsgraph):
        if ob == surface:
            raise RuntimeError("out of order")
        read(self, ob, depsgraph)

    monkeypatch.setattr(LiveSurface, "read", fail)


def test_a_surface_that_fails_does_not_stop_others(monkeypatch):
    surfaces = [live_scenes.deforming(name) for name in ("cross", "monkey", "mixed polygons")]
    hairs = [scenes.add_hair(ob, follow="LIVE", per_side=2) for ob in surfaces]
    with monkeypatch.context() as patched:
        failing_on(surfaces[1], patched)
        bpy.context.scene.frame_set(20)
        for k in (0, 2):
            check_hair(surfaces[k], hairs[k])
        assert live_kept.trouble(hairs[1]) == "RuntimeError: out of order"
    bpy.context.scene.frame_set(21)
    check_hair(surfaces[1], hairs[1])
    assert live_kept.trouble(hairs[1]) == ""


@pytest.mark.parametrize("add", [scenes.add_hair, scenes.add_points])
def test_an_operator_that_fails_leaves_nothing(monkeypatch, add):
    ob = live_scenes.deforming("cross")
    scenes.activate(ob)
    ob.select_set(True)
    before, names = contents.digest(), scenes.file_contents()

    def fail(_depsgraph):
        raise RuntimeError("out of order")

    monkeypatch.setattr(live, "pose_all", fail)
    with pytest.raises(RuntimeError, match="out of order"):
        add(ob, follow="LIVE")
    assert contents.digest() == before
    assert scenes.file_contents() == names
    assert bpy.context.active_object == ob
    assert ob.select_get()
