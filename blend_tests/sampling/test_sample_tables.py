# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables for Sample Limit Surface: they are seen when they are stale, made anew and removed."""

import threading
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import numpy as np
import pytest
import scenes
from follow_scenes import check_hair, deforming, look
from limit_surface import ids
from limit_surface.errors import CancelledError
from limit_surface.follow import stale
from limit_surface.placing import all_tiles, tables
from limit_surface.placing.follow_state import State, surfaces
from limit_surface.reading import attributes
from limit_surface.sampling import tables_operator
from limit_surface.tasks import watched_operator
from stand_ins import event, window_context
from waiting import wait_for

STALE = (
    "The faces, creases or subdivision settings of Holes have changed since its tables for Sample "
    "Limit Surface were made"
)


def sampled(**properties: int) -> bpy.types.Object:
    ob = deforming("grid with holes")
    scenes.activate(ob)
    assert bpy.ops.object.limit_sample_tables(**properties) == {"FINISHED"}
    return ob


def remove(ob: bpy.types.Object) -> None:
    scenes.activate(ob)
    assert bpy.ops.object.limit_sample_remove() == {"FINISHED"}


def change_faces(ob: bpy.types.Object) -> None:
    mirror = ob.modifiers.new("Mirror", "MIRROR")
    ob.modifiers.move(ob.modifiers.find(mirror.name), 0)


def change_creases(ob: bpy.types.Object) -> None:
    values = np.full(len(ob.data.edges), 0.5, np.float32)
    attributes.write(ob.data, ids.EDGE_CREASE, "FLOAT", "EDGE", values)
    ob.data.update_tag()


def change_rules(ob: bpy.types.Object) -> None:
    ob.modifiers["Subdivision"].boundary_smooth = "PRESERVE_CORNERS"


@pytest.mark.parametrize("change", [change_faces, change_creases, change_rules])
def test_stale_tables_are_named_and_made_anew(change):
    ob = sampled(depth=4)
    assert look(ob) == []
    change(ob)
    bpy.context.view_layer.update()
    assert look(ob) == [(STALE, ids.SAMPLE_TABLES)]
    bpy.ops.object.limit_sample_tables()
    assert look(ob) == []


def test_broken_tables_are_named_and_mended():
    ob = sampled(depth=4)
    table = all_tiles.of_surface(ob)
    bpy.data.objects.remove(bpy.data.objects[f"{ids.ALL_POINTS_TABLE} of Holes"])
    told = f"The hidden table of points that {table.name} reads was deleted"
    assert look(ob) == [(told, ids.SAMPLE_TABLES)]
    bpy.ops.object.limit_sample_tables()
    assert look(ob) == []
    bpy.data.node_groups.remove(bpy.data.node_groups[ids.TILES_GROUP])
    assert State.of(ob) is None  # nothing tells whose table it is any more
    bpy.ops.object.limit_sample_tables()
    ob.modifiers.remove(ob.modifiers[ids.CAPTURE_GROUP])
    ((told, remedy),) = look(ob)
    assert told.startswith("Holes: the modifier Limit Capture was deleted.")
    assert remedy == ids.SAMPLE_TABLES
    bpy.ops.object.limit_sample_tables()
    assert look(ob) == []


def test_tables_of_followers_and_of_all_tiles_are_told_apart():
    ob = sampled(depth=4)
    hair = scenes.add_hair(ob, follow="NODES")
    change_rules(ob)
    bpy.context.view_layer.update()
    texts = [text for text, _remedy in look(ob)]
    assert texts[-1] == STALE
    assert len(texts) == 2
    assert [text for text, _remedy in look(hair)] == texts[:1]
    scenes.activate(ob)
    bpy.ops.object.limit_sample_tables()
    assert [text for text, _remedy in look(ob)] == texts[:1]


def test_stale_tables_are_seen_when_a_file_is_loaded(tmp_path, capfd):
    ob = sampled(depth=4)
    change_rules(ob)
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    capfd.readouterr()
    bpy.ops.wm.open_mainfile(filepath=path)
    lines = capfd.readouterr().out.splitlines()
    assert [x for x in lines if x.startswith("Limit Surface:")] == [f"Limit Surface: {STALE}"]
    assert surfaces() == [bpy.data.objects["Holes"]]
    stale._forget()


def test_settings_stay_unless_they_are_given():
    ob = sampled(depth=5, levels=1)
    assert all_tiles.settings_of(ob) == (5, 1)
    bpy.ops.object.limit_sample_tables()
    assert all_tiles.settings_of(ob) == (5, 1)
    bpy.ops.object.limit_sample_tables("INVOKE_DEFAULT")
    assert all_tiles.settings_of(ob) == (5, 1)
    bpy.ops.object.limit_sample_tables(depth=6, levels=0)
    assert all_tiles.settings_of(ob) == (6, 0)
    all_tiles.faces_of(ob)[ids.FACES_MARK] = True  # a file of the first version
    assert all_tiles.settings_of(ob) == (6, None)


@pytest.fixture
def waiting(monkeypatch):
    """The operator as a user starts it; the tables are not found until the event is set."""
    go_on, compute = threading.Event(), all_tiles.AllTiles.compute

    def wait(self, progress):
        wait_for(go_on)
        compute(self, progress)

    monkeypatch.setattr(all_tiles.AllTiles, "compute", wait)
    monkeypatch.setattr(watched_operator, "PATIENCE", 0.01)
    made = SimpleNamespace(depth=3, levels=1, report=MagicMock())
    rna = SimpleNamespace(properties=[])
    made.properties = SimpleNamespace(is_property_set=lambda name: True, bl_rna=rna)
    operator = tables_operator.OBJECT_OT_limit_sample_tables
    for name in ("start", "finish", "too_large", "cancelled"):
        setattr(_Tables, name, operator.__dict__[name])
    yield _Tables(**vars(made)), go_on
    go_on.set()


class _Tables(watched_operator.WatchedOperator):
    def __init__(self, **members):
        vars(self).update(members)


def test_finding_many_tiles_is_waited_for(waiting):
    operator, go_on = waiting
    ob = deforming("grid with holes")
    scenes.activate(ob)
    context, before = window_context(), scenes.file_contents()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    assert operator.modal(context, event("TIMER")) == {"RUNNING_MODAL"}
    assert scenes.file_contents() == before
    go_on.set()
    wait_for(operator._job)
    assert operator.modal(context, event("TIMER")) == {"FINISHED"}
    assert all_tiles.settings_of(ob) == (3, 1)


def test_escape_ends_finding_tiles(waiting):
    operator, go_on = waiting
    scenes.activate(deforming("grid with holes"))
    context, before = window_context(), scenes.file_contents()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    job = operator._job
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    operator.report.assert_called_with({"INFO"}, "Cancelled: no tables were made")
    assert scenes.file_contents() == before
    go_on.set()
    wait_for(job)
    with pytest.raises(CancelledError):  # the work itself has ended early
        job.result()


@pytest.mark.parametrize("seed", range(5))
def test_the_largest_of_each_row(seed):
    rng = np.random.default_rng(seed)
    sizes = rng.integers(0, 4, 50 * seed)
    values = rng.integers(0, 3, sizes.sum()).astype(float)
    ends = np.cumsum(sizes)
    rows = [(end - size, end) for size, end in zip(sizes, ends, strict=True) if size]
    # the last one of the largest
    expected = [end - 1 - np.argmax(values[begin:end][::-1]) for begin, end in rows]
    np.testing.assert_array_equal(tables._largest(values, sizes), expected)


def test_tables_are_removed():
    ob = deforming("grid with holes")
    before = scenes.file_contents()
    scenes.activate(ob)
    bpy.ops.object.limit_sample_tables(depth=4)
    remove(ob)
    now = scenes.file_contents()
    assert {kind for kind in now if now[kind] != before[kind]} == {"node_groups"}
    assert [m.type for m in ob.modifiers] == ["WAVE", "SUBSURF"]
    assert State.of(ob) is None


def test_what_follows_keeps_its_tables():
    ob = sampled(depth=4)
    hair = scenes.add_hair(ob, follow="NODES")
    remove(ob)
    bpy.context.scene.frame_set(30)
    check_hair(ob, hair)


def test_tables_that_users_made_outlive_those_of_followers():
    ob = sampled(depth=4)
    hair = scenes.add_hair(ob, follow="NODES")
    bpy.data.objects.remove(hair)
    bpy.ops.object.select_all(action="DESELECT")
    scenes.activate(ob)
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}
    assert all_tiles.of_surface(ob) is not None
    assert f"{ids.TILES_TABLE} of Holes" not in bpy.data.objects


def test_readers_are_named(capfd):
    ob = sampled(depth=4)
    tree = bpy.data.node_groups.new("Pebbles", "GeometryNodeTree")
    node = tree.nodes.new("GeometryNodeObjectInfo")
    node.inputs["Object"].default_value = all_tiles.of_surface(ob)
    remove(ob)
    assert "The removed tables were used by: Pebbles" in capfd.readouterr().out


def test_a_mesh_without_tables_is_refused():
    scenes.activate(scenes.cross())
    with pytest.raises(RuntimeError, match="Cross has no tables for Sample Limit Surface"):
        bpy.ops.object.limit_sample_remove()


def made_for(ob: bpy.types.Object) -> list[bpy.types.Object | None]:
    table = all_tiles.of_surface(ob)
    return [table, tables.points_of(table), all_tiles.faces_of(ob)]


def names_of(ob: bpy.types.Object) -> list[str]:
    kinds = (ids.ALL_TILES_TABLE, ids.ALL_POINTS_TABLE, ids.FACES_TABLE)
    return [f"{kind} of {ob.name}" for kind in kinds]


def test_tables_are_renamed_with_their_surface():
    ob = sampled(depth=4)
    made = made_for(ob)
    ob.name = "Renamed"
    bpy.ops.object.limit_sample_tables()
    assert made_for(ob) == made
    assert [each.name for each in made] == names_of(ob)
    assert [each.data.name for each in made] == names_of(ob)
    made[0].name = "My Tiles"
    bpy.ops.object.limit_sample_tables()
    assert made[0].name == "My Tiles"


def test_tables_of_surfaces_that_have_changed_names():
    first = sampled(depth=4)
    second = scenes.cross()
    scenes.activate(second)
    bpy.ops.object.limit_sample_tables(depth=4)
    names, made = (first.name, second.name), (made_for(first), made_for(second))
    first.name = "Other"
    second.name, first.name = names
    for ob, theirs in zip((first, second), made, strict=True):
        scenes.activate(ob)
        bpy.ops.object.limit_sample_tables()
        assert made_for(ob) == theirs
    for ob, theirs in zip((first, second), made, strict=True):
        assert [each.name for each in theirs] == names_of(ob)


def remove_by_script(ob: bpy.types.Object) -> None:
    bpy.data.objects.remove(ob)


def delete(ob: bpy.types.Object) -> None:
    """As users do; what has users stays in the file."""
    bpy.ops.object.select_all(action="DESELECT")
    scenes.activate(ob)
    ob.select_set(True)
    bpy.ops.object.delete()


DELETIONS = pytest.mark.parametrize("end", [remove_by_script, delete])


def hidden_tables() -> list[bpy.types.Object]:
    return [ob for ob in bpy.data.objects if ob.name.startswith("Limit ")]


def test_tables_that_nodes_read_are_removed_with_a_warning(capfd):
    ob = sampled(depth=4)
    tree = bpy.data.node_groups.new("Pebbles", "GeometryNodeTree")
    node = tree.nodes.new("GeometryNodeObjectInfo")
    node.inputs["Object"].default_value = all_tiles.of_surface(ob)
    remove_by_script(ob)
    assert bpy.ops.object.limit_sample_remove() == {"FINISHED"}
    said = capfd.readouterr().out
    assert "Removed 3 hidden objects of meshes that were deleted" in said
    assert "The removed tables were used by: Pebbles" in said


@DELETIONS
def test_tables_of_a_mesh_that_was_deleted_are_removed(end):
    end(sampled(depth=4))
    assert len(hidden_tables()) == 3
    assert bpy.ops.object.limit_sample_remove() == {"FINISHED"}
    assert not hidden_tables()
    assert not bpy.ops.object.limit_sample_remove.poll()


def test_tables_stay_where_nodes_still_sample_a_mesh_that_was_deleted():
    ob = sampled(depth=4)
    table = all_tiles.of_surface(ob)
    tree = bpy.data.node_groups.new("Pebbles", "GeometryNodeTree")
    tree.nodes.new("GeometryNodeObjectInfo").inputs["Object"].default_value = table
    delete(ob)
    other = scenes.cross()
    scenes.activate(other)
    assert bpy.ops.object.limit_sample_tables(depth=4) == {"FINISHED"}
    assert tables.surface_of(table) == ob
    bpy.data.node_groups.remove(tree)
    remove(other)
    assert not hidden_tables()


@DELETIONS
def test_tables_of_deleted_meshes_are_removed_with_those_of_the_next_one(end, capfd):
    end(sampled(depth=4))
    other = scenes.cross()
    scenes.activate(other)
    assert bpy.ops.object.limit_sample_tables(depth=4) == {"FINISHED"}
    assert "Removed 3 hidden objects of meshes that were deleted" in capfd.readouterr().out
    assert set(hidden_tables()) == set(made_for(other))
    end(other)
    third = scenes.cross()
    remove(third)
    assert not hidden_tables()
    with pytest.raises(RuntimeError, match="has no tables for Sample Limit Surface"):
        bpy.ops.object.limit_sample_remove()


def test_tables_that_have_lost_their_modifier_are_no_leftovers():
    """Nothing tells whose they are."""
    ob = sampled(depth=4)
    table = all_tiles.of_surface(ob)
    table.modifiers.clear()
    scenes.activate(scenes.cross())
    bpy.ops.object.limit_sample_tables(depth=4)
    assert table.name == f"{ids.ALL_TILES_TABLE} of Holes"


def test_tables_that_would_be_too_large_are_refused():
    around = np.linspace(0, 2 * np.pi, 700, endpoint=False)
    ob = scenes.add_mesh("Disc", [(np.cos(a), np.sin(a), 0) for a in around], [range(700)])
    scenes.activate(ob)
    before = set(bpy.data.objects)
    with pytest.raises(
        RuntimeError, match="The tables of Disc would take more than 3 GB, .* sides"
    ):
        bpy.ops.object.limit_sample_tables(depth=24)
    assert set(bpy.data.objects) == before


def test_faces_of_a_deleted_mesh_can_be_a_surface():
    ob = sampled(levels=1, depth=2)
    faces = all_tiles.faces_of(ob)
    bpy.data.objects.remove(ob)
    scenes.activate(faces)
    assert bpy.ops.object.limit_sample_tables(depth=2) == {"FINISHED"}
    assert all_tiles.of_surface(faces) is not None
    scenes.activate(deforming("cross"))
    assert bpy.ops.object.limit_sample_tables(depth=2) == {"FINISHED"}
    assert all_tiles.of_surface(faces) is not None
