# SPDX-License-Identifier: GPL-3.0-or-later
"""Live children that cannot grow are refused: their files would be empty, or hold wrong shapes."""

import bpy
import children_truth
import numpy as np
import pytest
import scenes
from bakes import bake, contents, geometry_tree
from follow_scenes import deforming
from limit_surface import ids
from limit_surface.bake_frames import command
from limit_surface.nodes import children as nodes
from limit_surface.nodes import groups
from limit_surface.placing import live_children

NAME = ids.CHILDREN_OBJECT


@pytest.fixture
def live():
    ob = deforming("cross")
    switch = ob.modifiers.new("Triangulate", "TRIANGULATE")
    ob.modifiers.move(ob.modifiers.find(switch.name), 0)
    switch.show_viewport = switch.show_render = False
    guides = scenes.add_hair(ob, distribution="UNIFORM", count=12, follow="NODES")
    scenes.activate(guides)
    bpy.ops.object.limit_children_add(
        mode="LIVE", distribution="UNIFORM", count=50, viewport_share=1.0
    )
    return bpy.context.active_object


def tiles_of(live):
    return groups.get_input(live_children.modifier_of(live), nodes.TILES)


def test_children_that_grow(live, tmp_path):
    assert bake(tmp_path, NAME, frames="5", options=("--format", "npz")) == 0
    bpy.context.scene.frame_set(5)
    assert len(children_truth.shown_strands(live)) == 50
    assert contents(tmp_path).keys() == {f"{NAME}.0005.npz", "bake.json"}


def remove_a_guide(live):
    if bpy.app.version < (4, 3):
        pytest.skip("Python cannot do that before Blender 4.3")
    live_children.guides_of(live).data.remove_curves(indices=[0])


def remove_the_guides(live):
    bpy.data.objects.remove(live_children.guides_of(live))


def remove_the_table(live):
    bpy.data.objects.remove(children_truth.table_of(live))


def remove_the_tiles(live):
    bpy.data.objects.remove(tiles_of(live))


def change_the_faces(live):
    live.data.surface.modifiers["Triangulate"].show_viewport = True


def crease_an_edge(live):
    live.data.surface.data.edge_creases_ensure().data[3].value = 0.5


def switch_off(live):
    live_children.modifier_of(live).show_render = False


def switch_the_guides_off(live):
    live_children.guides_of(live).modifiers[0].show_viewport = False


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (remove_a_guide, "The number of guides of Limit Children has changed from 12 to 11"),
        (remove_the_guides, "The guides of Limit Children were deleted"),
        (remove_the_table, "A hidden table that Limit Children reads was deleted"),
        (remove_the_tiles, "A hidden table that Limit Children reads was deleted"),
        (change_the_faces, "The faces of Cross have changed since Limit Children was made"),
        (crease_an_edge, "creases or subdivision settings of Cross have changed since"),
        (switch_off, "Limit Children does not grow: its modifier Limit Children is disabled"),
        (switch_the_guides_off, "Limit Hair does not follow: its modifier"),
    ],
)
def test_children_that_cannot_grow(live, tmp_path, capfd, change, reason):
    change(live)
    assert bake(tmp_path, NAME, options=("--format", "npz")) == command.STALE_BINDING
    assert reason in capfd.readouterr().err
    assert not list(tmp_path.iterdir())


def test_frames_in_which_children_cannot_grow(live, tmp_path, capfd):
    """The faces change in frame 2, and the number of guides in frame 3."""
    surface, guides = live.data.surface, live_children.guides_of(live)
    key(surface.modifiers["Triangulate"], (False, True, False))
    duplicate = guides.modifiers.new("Duplicate", "NODES")
    duplicate.node_group = all_twice()
    key(duplicate, (False, False, True))
    assert bake(tmp_path, NAME, options=("--format", "npz")) == command.FRAMES_FAILED
    out = capfd.readouterr().out
    assert "Limit Children does not grow in frame 2: the control mesh of its surface has" in out
    assert "does not grow in frame 3: it has 24 guides there, and had 12 when it was made" in out
    assert contents(tmp_path).keys() == {f"{NAME}.0001.npz", "bake.json"}


def key(modifier, shown):
    for frame, is_on in enumerate(shown, 1):
        modifier.show_viewport = is_on
        modifier.keyframe_insert("show_viewport", frame=frame)


def all_twice():
    tree, begin, end = geometry_tree("Twice")
    join = tree.nodes.new("GeometryNodeJoinGeometry")
    tree.links.new(begin.outputs[0], join.inputs[0])
    moved = tree.nodes.new("GeometryNodeTransform")
    tree.links.new(begin.outputs[0], moved.inputs[0])
    tree.links.new(moved.outputs[0], join.inputs[0])
    tree.links.new(join.outputs[0], end.inputs[0])
    return tree


def test_the_share_of_the_viewport_is_that_of_arrays(live, tmp_path):
    children_truth.set_input(live, nodes.SHARE, 0.2)
    assert bake(tmp_path, NAME, frames="1", options=("--format", "npz")) == 0
    with np.load(tmp_path / f"{NAME}.0001.npz") as arrays:
        assert len(arrays["curve_offsets"]) - 1 == len(children_truth.shown_strands(live)) < 30


def remove_the_surface(live):
    bpy.data.objects.remove(live.data.surface)


def remove_the_group(live):
    bpy.data.node_groups.remove(live_children.modifier_of(live).node_group)


@pytest.mark.parametrize("form", ["npz", "abc"])
@pytest.mark.parametrize("is_linked", [False, True])
@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (remove_the_surface, "does not grow: its surface was deleted"),
        (remove_the_group, "does not grow: the node group of its modifier Limit Children was"),
    ],
)
def test_what_children_cannot_grow_without(live, tmp_path, capfd, change, reason, form, is_linked):
    change(live)
    if is_linked:
        link_from(tmp_path / "library.blend")
    assert bake(tmp_path / "out", NAME, options=("--format", form)) == command.STALE_BINDING
    assert reason in capfd.readouterr().err
    assert not (tmp_path / "out").exists()


def link_from(library):
    """Saves the file and links its children in an empty one."""
    bpy.ops.wm.save_as_mainfile(filepath=str(library))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(library), link=True) as (_, here):
        here.objects = [NAME]
    bpy.context.scene.collection.objects.link(here.objects[0])


def test_a_group_that_its_library_does_not_hold_any_more(live, tmp_path, capfd):
    """The group was linked from a library, as those of an asset library are."""
    group = live_children.modifier_of(live).node_group
    library, shot = tmp_path / "library.blend", tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(library), copy=True)
    with bpy.data.libraries.load(str(library), link=True) as (_, here):
        here.node_groups = [group.name]
    live_children.modifier_of(live).node_group = here.node_groups[0]
    bpy.ops.wm.save_as_mainfile(filepath=str(shot))
    assert bake(tmp_path / "whole", NAME, frames="1", options=("--format", "npz")) == 0
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(library))
    bpy.ops.wm.open_mainfile(filepath=str(shot))
    assert bake(tmp_path / "broken", NAME, options=("--format", "npz")) == command.BAD_ARGUMENTS
    assert "Limit Children is missing: it cannot be read from" in capfd.readouterr().err
