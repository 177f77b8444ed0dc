# SPDX-License-Identifier: GPL-3.0-or-later
"""What follows live is written alone, in the pose that renders show, whatever has to be evaluated
for that while Blender's exporter is at work.
"""

import bpy
import live_scenes
import pytest
import scenes
from bakes import bake, contents, geometry_tree
from limit_surface import ids
from limit_surface.bake_frames import command

FORMS = ["abc", "usd"]


def bystander():
    return scenes.add_mesh("Bystander", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])


@pytest.fixture
def hair():
    surface = live_scenes.deforming("cross")
    bystander()
    hair = scenes.add_hair(surface, per_side=2, follow="NONE")
    live_scenes.follow(hair)
    return hair


def first(ob, modifier):
    ob.modifiers.move(ob.modifiers.find(modifier.name), 0)
    return modifier


def raised(ob):
    """Adds a modifier that moves a surface upwards."""
    modifier = ob.modifiers.new("Raised", "DISPLACE")
    modifier.direction, modifier.strength, modifier.mid_level = "Z", 1.0, 0.0
    return first(ob, modifier)


def written(folder, form, *objects):
    assert bake(folder, *objects, frames="5-6", options=("--format", form)) == 0
    return contents(folder)


@pytest.mark.parametrize("form", FORMS)
def test_a_surface_that_has_lost_limit_capture(hair, tmp_path, form):
    expected = written(tmp_path / "whole", form, hair.name)
    surface = hair.data.surface
    surface.modifiers.remove(surface.modifiers[ids.CAPTURE_GROUP])
    for folder in ("first", "again"):
        assert written(tmp_path / folder, form, hair.name) == expected


@pytest.fixture
def chain():
    """A body, a garment that follows it and is smoothed before its limit, and hair on both."""
    body = live_scenes.deforming("cross")
    bystander()
    on_body = scenes.add_hair(body, per_side=2, follow="NONE")
    on_body.name = "Fur"
    scenes.activate(body)
    assert bpy.ops.object.limit_mesh(levels=1, follow="NONE", store_locations=True) == {"FINISHED"}
    garment = bpy.context.object
    on_garment = scenes.add_hair(garment, per_side=1, follow="NONE")
    on_garment.name = "Fringe"
    live_scenes.follow(garment, on_body, on_garment)
    first(garment, garment.modifiers.new("Smooth", "SMOOTH"))
    return body, garment


@pytest.mark.parametrize("form", FORMS)
def test_hair_on_a_garment_on_a_body_that_renders_raise(chain, tmp_path, form):
    modifier = raised(chain[0])
    expected = written(tmp_path / "both", form, "Fringe", "Fur")
    modifier.show_viewport = False
    assert written(tmp_path / "renders", form, "Fringe", "Fur") == expected
    modifier.show_render = False
    assert written(tmp_path / "neither", form, "Fringe", "Fur") != expected


def test_a_garment_that_must_be_evaluated_on_its_own(chain, tmp_path, capfd):
    body, garment = chain
    raised(body).show_viewport = False
    garment.modifiers.remove(garment.modifiers[ids.CAPTURE_GROUP])
    assert bake(tmp_path, "Fringe", frames="5") == command.FRAMES_FAILED
    assert "Fringe cannot be posed as renders show it" in capfd.readouterr().out
    assert bake(tmp_path, "Fringe", frames="5", options=("--format", "npz")) == 0


def test_what_renders_raise_and_nothing_hands_on(hair, tmp_path, capfd):
    surface = hair.data.surface
    surface.modifiers.remove(surface.modifiers[ids.CAPTURE_GROUP])
    raised(surface).show_viewport = False
    assert bake(tmp_path, hair.name, frames="5") == command.FRAMES_FAILED
    assert "Cross has no modifier Limit Capture" in capfd.readouterr().out
    assert bake(tmp_path, hair.name, frames="5", options=("--format", "npz")) == 0


@pytest.mark.parametrize("form", FORMS)
def test_nodes_that_make_other_faces_in_renders(hair, tmp_path, capfd, form):
    modifier = hair.data.surface.modifiers.new("Triangles", "NODES")
    modifier.node_group = triangles_in_renders()
    first(hair.data.surface, modifier)
    assert bake(tmp_path, hair.name, frames="5", options=("--format", form)) == 1
    assert "The modifiers of Cross give another control mesh in renders" in capfd.readouterr().out
    assert bake(tmp_path, hair.name, frames="5", options=("--format", "npz")) == 0


def triangles_in_renders():
    tree, begin, end = geometry_tree("Triangles")
    triangles = tree.nodes.new("GeometryNodeTriangulate")
    tree.links.new(begin.outputs[0], triangles.inputs[0])
    switch = tree.nodes.new("GeometryNodeSwitch")
    is_viewport = tree.nodes.new("GeometryNodeIsViewport")
    switch.input_type = "GEOMETRY"
    condition, no, yes = (s for s in switch.inputs if s.enabled)
    tree.links.new(is_viewport.outputs[0], condition)
    tree.links.new(triangles.outputs[0], no)
    tree.links.new(begin.outputs[0], yes)
    tree.links.new(next(s for s in switch.outputs if s.enabled), end.inputs[0])
    return tree


def test_a_script_that_adds_data_during_the_export(hair, tmp_path, capfd):
    def add(scene, depsgraph):
        if depsgraph.mode != "RENDER":
            return
        passing = bpy.data.objects.new("Passing", None)
        scene.collection.objects.link(passing)
        bpy.data.objects.remove(passing)

    bpy.app.handlers.depsgraph_update_post.append(add)
    try:
        assert bake(tmp_path, hair.name, frames="5") == command.FRAMES_FAILED
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(add)
    assert "other objects into the file, too, because a script" in capfd.readouterr().out
    assert contents(tmp_path).keys() == {"bake.json"}
