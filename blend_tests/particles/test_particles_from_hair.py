# SPDX-License-Identifier: GPL-3.0-or-later
"""A particle system that is made from hair draws the same strands, and keeps them."""

import bpy
import numpy as np
import particle_scenes
import pytest
import scenes
from limit_surface import ids
from limit_surface.errors import CancelledError, RefusalError
from limit_surface.particles import system
from limit_surface.placing.places import ROOT_KINDS
from limit_surface.reading import attributes
from limit_surface.tasks.piecewise_job import PiecewiseJob
from particle_scenes import KEYS, add_hair, bend, drawn, in_world

convert = bpy.ops.object.limit_particles_from_hair
PLACED = {"plain": {}, "stretched": scenes.STRETCHED, "mirrored": scenes.MIRRORED}


def check_drawn(ob, strands, number=0):
    found = drawn(ob, number)
    np.testing.assert_allclose(found, strands, rtol=0, atol=particle_scenes.bound(found))


@pytest.mark.parametrize("transform", PLACED)
@pytest.mark.parametrize("scene", ["cross", "grid with holes", "mixed polygons"])
@pytest.mark.parametrize("levels", [None, 2])
def test_strands_are_the_same(scene, transform, levels):
    ob = scenes.SCENES[scene]()
    if levels:
        scenes.add_subsurf(ob).levels = levels
    scenes.place(ob, PLACED[transform])
    hair = add_hair(ob)
    bend(hair)
    before = in_world(hair)
    assert convert() == {"FINISHED"}
    check_drawn(ob, before)
    np.testing.assert_array_equal(in_world(hair), before)
    assert bpy.context.active_object == hair


def test_many_strands_on_a_head():
    ob = scenes.monkey()
    scenes.add_subsurf(ob).levels = 2
    hair = add_hair(ob)
    convert()
    check_drawn(ob, in_world(hair))


def test_saved_strands_stay(tmp_path):
    ob = scenes.cross()
    scenes.add_subsurf(ob).levels = 2
    hair = add_hair(ob)
    bend(hair)
    strands, name = in_world(hair), ob.name
    convert()
    path = str(tmp_path / "particles.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    for _ in range(2):
        bpy.ops.wm.open_mainfile(filepath=path)
        ob = bpy.data.objects[name]
        check_drawn(ob, strands)
        bpy.context.scene.frame_set(7)
        ob.data.update_tag()
        check_drawn(ob, strands)
        bpy.ops.wm.save_as_mainfile(filepath=path)


def test_particle_edit_mode_keeps_the_strands():
    ob = scenes.cross()
    scenes.add_subsurf(ob).levels = 2
    strands = in_world(add_hair(ob))
    convert()
    scenes.activate(ob)
    for _ in range(2):
        bpy.ops.particle.particle_edit_toggle()
    check_drawn(ob, strands)


def test_settings():
    ob = scenes.cross()
    ob.scale = (2, 2, 2)
    bpy.context.view_layer.update()
    hair = add_hair(ob, radius=0.02)
    hair.name = "Fringe"
    radius = attributes.read(hair.data, "radius").reshape(-1, KEYS)
    attributes.write(hair.data, "radius", "FLOAT", "POINT", radius * np.linspace(1, 0.5, KEYS))
    hair.data.update_tag()
    convert()
    (system,) = ob.particle_systems
    settings = system.settings
    assert (system.name, settings.name, ob.modifiers[-1].name) == ("Fringe",) * 3
    assert (settings.type, settings.render_type) == ("HAIR", "PATH")
    assert (settings.count, settings.hair_step) == (len(hair.data.curves), KEYS - 1)
    assert settings.hair_length == pytest.approx(0.2, rel=1e-5)  # in the object's space
    # diameters in the world
    assert settings.radius_scale * settings.root_radius == pytest.approx(0.04, rel=1e-5)
    assert settings.radius_scale * settings.tip_radius == pytest.approx(0.02, rel=1e-5)
    assert not settings.use_close_tip


def test_the_material_of_the_hair(capfd):
    ob = scenes.cross()
    hair = add_hair(ob)
    skin, brown = (bpy.data.materials.new(name) for name in ("Skin", "Brown"))
    hair.data.materials.append(brown)
    ob.data.materials.append(skin)
    convert()
    assert "Cross has no material slot with Brown" in capfd.readouterr().out
    ob.data.materials.append(brown)
    convert()
    assert "Brown" not in capfd.readouterr().out
    assert [system.settings.material for system in ob.particle_systems] == [1, 2]


def test_particles_stand_on_the_right_polygon():
    """Many roots of the upper sheet are nearer to the lower one's polygons than to their own."""
    x, y = np.mgrid[:4, :4].reshape(2, -1)
    faces = [(i, i + 4, i + 5, i + 1) for i in range(12) if i % 4 < 3]
    # ridges, whose limit surfaces lie below their control meshes
    height = np.where((x == 1) | (x == 2), 2.0, 0.0)
    upper, lower = (np.stack([x, y, z], axis=1) for z in (height, height - 0.25))
    both = [*faces, *(tuple(16 + v for v in face) for face in faces)]
    ob = scenes.add_mesh("Sheets", np.concatenate([upper, lower]), both)
    uv = ob.data.uv_layers.new(name="Sheet")
    sheet = attributes.read(ob.data, ids.CORNER_VERTEX) >= 16
    uv.data.foreach_set("uv", np.repeat(sheet.astype(np.float32), 2))
    scenes.add_subsurf(ob).levels = 2
    hair = add_hair(ob)
    convert()
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    (system,), modifier = shown.particle_systems, shown.modifiers[-1]
    on = [
        system.uv_on_emitter(modifier, particle=p, particle_no=i, uv_no=0)[0]
        for i, p in enumerate(system.particles)
    ]
    np.testing.assert_allclose(on, scenes.locations(hair.data)[0] >= 9, atol=1e-6)


def test_other_systems_are_left_alone():
    ob = scenes.cross()
    particle_scenes.add_system(ob, "Limit Hair", 50)
    before, own = drawn(ob), ob.particle_systems[0].settings
    strands = in_world(add_hair(ob))
    for number in (1, 2):
        convert()
        check_drawn(ob, strands, number)
        np.testing.assert_array_equal(drawn(ob), before)
    assert ob.particle_systems[0].settings == own
    assert len({system.name for system in ob.particle_systems}) == 3


def test_strands_with_different_numbers_of_points():
    ob = scenes.cross()
    scenes.add_subsurf(ob).levels = 2
    short, long = add_hair(ob, points=3), add_hair(ob)
    straight = in_world(short)
    whole = in_world(long)
    bpy.context.view_layer.objects.active = short
    assert convert(keys=KEYS) == {"FINISHED"}
    resampled = straight[:, :1] + np.linspace(0, 1, KEYS)[:, None] * (
        straight[:, -1:] - straight[:, :1]
    )
    check_drawn(ob, resampled)

    mixed = bpy.data.hair_curves.new("Mixed")
    count = len(whole)
    mixed.add_curves([3, KEYS] * count)
    pairs = zip(scenes.strands(short), scenes.strands(long), strict=True)
    points = [np.concatenate(pair) for pair in pairs]
    mixed.points.foreach_set("position", np.concatenate(points).ravel())
    for name, kind in ROOT_KINDS.items():
        values = attributes.read(long.data, name).repeat(2, axis=0)
        attributes.write(mixed, name, kind, "CURVE", values)
    mixed.surface = ob
    both = bpy.data.objects.new("Mixed", mixed)
    both.parent = ob
    bpy.context.collection.objects.link(both)
    scenes.activate(both)
    bpy.context.view_layer.update()
    convert()
    check_drawn(ob, np.stack([resampled, whole], axis=1).reshape(-1, KEYS, 3), number=1)


@pytest.mark.parametrize("is_hidden", [False, True])
def test_hair_that_follows_is_taken_as_it_is_shown(is_hidden):
    ob = scenes.cross()
    scenes.add_subsurf(ob).levels = 2
    key = particle_scenes.add_shape_key(ob)
    hair = add_hair(ob, follow="NODES")
    rest = in_world(hair)
    key.value = 1
    bpy.context.view_layer.update()
    shown = hair.evaluated_get(bpy.context.evaluated_depsgraph_get())
    bent = attributes.read(shown.data, ids.POSITION).reshape(rest.shape)
    hair.hide_viewport = is_hidden
    bpy.context.view_layer.update()
    convert()
    assert np.abs(bent - rest).max() > 0.1
    check_drawn(ob, bent)


def test_hair_that_was_moved_away():
    ob = scenes.cross()
    scenes.add_subsurf(ob).levels = 2
    scenes.place(ob, scenes.STRETCHED)
    hair = add_hair(ob)
    hair.location, hair.rotation_euler = (0.5, -0.2, 1), (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    convert()
    check_drawn(ob, in_world(hair))


def test_modifiers_before_the_subdivision_that_add_faces():
    ob = scenes.cross()
    ob.modifiers.new("Mirror", "MIRROR").use_axis = (False, False, True)
    scenes.add_subsurf(ob).levels = 2
    hair = add_hair(ob)
    assert in_world(hair)[:, 0, 2].min() < -0.5
    convert()
    check_drawn(ob, in_world(hair))


def test_unbound_strands_stand_at_the_closest_place():
    ob = scenes.cross()
    scenes.add_subsurf(ob).levels = 2
    hair = add_hair(ob)
    face = attributes.read(hair.data, ids.FACE)
    face[::2] = -1
    attributes.write(hair.data, ids.FACE, "INT", "CURVE", face)
    convert()
    check_drawn(ob, in_world(hair))


def test_a_warning_where_renders_differ(capfd):
    ob = scenes.cross()
    subsurf = scenes.add_subsurf(ob)
    add_hair(ob)
    for levels, viewport, text in (
        ("VIEWPORT", 1, "in the viewport (level 1), but not in renders (level 2)"),
        ("RENDER", 1, "in renders (level 2), but not in the viewport (level 1)"),
        ("VIEWPORT", 2, ""),
    ):
        subsurf.levels, subsurf.render_levels = viewport, 2
        convert(levels=levels)
        said = capfd.readouterr().out
        assert ("Warning" in said) == bool(text)
        assert text in said


@pytest.mark.parametrize("is_shown", [True, False])
def test_levels_of_renders(is_shown):
    ob = scenes.cross()
    subsurf = scenes.add_subsurf(ob)
    subsurf.levels, subsurf.render_levels, subsurf.show_viewport = 1, 3, is_shown
    strands = in_world(add_hair(ob))
    assert convert(levels="RENDER") == {"FINISHED"}
    assert (subsurf.levels, subsurf.show_viewport) == (1, is_shown)
    assert np.abs(drawn(ob) - strands).max() > 0.01
    subsurf.levels, subsurf.show_viewport = 3, True
    check_drawn(ob, strands)


@pytest.mark.parametrize("is_shown", [True, False])
def test_levels_of_renders_where_simplify_lowers_those_of_the_viewport(is_shown, capfd):
    ob = scenes.cross()
    subsurf = scenes.add_subsurf(ob)
    subsurf.levels, subsurf.render_levels, subsurf.show_viewport = 2, 2, is_shown
    strands = in_world(add_hair(ob))
    render = bpy.context.scene.render
    render.use_simplify, render.simplify_subdivision = True, 1
    assert convert(levels="RENDER") == {"FINISHED"}
    at = 1 if is_shown else 0
    assert f"but not in the viewport (level {at})" in capfd.readouterr().out
    assert render.simplify_subdivision == 1
    render.use_simplify, subsurf.show_viewport = False, True
    check_drawn(ob, strands)


def test_levels_that_a_driver_sets_are_refused():
    ob = scenes.cross()
    subsurf = scenes.add_subsurf(ob)
    subsurf.render_levels = 3
    subsurf.driver_add("levels").driver.expression = "1"
    add_hair(ob)
    with pytest.raises(RuntimeError, match="Drivers set the viewport levels of Subdivision"):
        convert(levels="RENDER")
    assert not ob.particle_systems
    assert convert() == {"FINISHED"}


@pytest.mark.parametrize("is_first", [True, False])
def test_modifiers_on_whose_polygons_blender_cannot_hold_particles(is_first):
    ob = scenes.grid_with_holes()
    scenes.add_subsurf(ob)
    ob.modifiers.new("Spun", "SCREW")
    if is_first:
        ob.modifiers.move(1, 0)
    hair = add_hair(ob, follow="NONE")
    with pytest.raises(RuntimeError, match="cannot hold particles on the polygons that the mod"):
        convert()
    assert not ob.particle_systems
    assert bpy.context.object == hair


def test_escape_takes_the_particles_back(monkeypatch):
    ob = scenes.cross()
    subsurf = scenes.add_subsurf(ob)
    subsurf.levels = 1
    add_hair(ob, per_side=20)
    before = scenes.file_contents()
    monkeypatch.setattr(system, "_LEAST_TIME", 0)
    monkeypatch.setattr(system, "_WORK_RATIO", 0)
    monkeypatch.setattr(system, "_PIECE", 10)
    jobs = []
    monkeypatch.setattr(PiecewiseJob, "run", lambda job, _show: jobs.append(job) or 1 / 0)
    with pytest.raises(RuntimeError, match="ZeroDivisionError"):
        convert(levels="RENDER")
    (job,) = jobs
    job.wait(0.05)
    assert 0 < job.part < 1
    assert len(ob.particle_systems) == 1
    job.cancel()
    assert job.is_done
    with pytest.raises(CancelledError):
        job.result()
    assert not ob.particle_systems
    assert ob.modifiers.keys() == [subsurf.name]
    assert subsurf.levels == 1
    assert scenes.file_contents() == before


def test_undo_and_redo():
    ob = scenes.cross()
    name = ob.name
    strands = in_world(add_hair(ob))
    bpy.ops.ed.undo_push(message="before")
    convert()
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    ob = bpy.data.objects[name]
    assert not ob.particle_systems
    assert not ob.modifiers
    assert not bpy.data.particles
    bpy.ops.ed.redo()
    check_drawn(bpy.data.objects[name], strands)


def check_refused(match, ob, **properties):
    before, active = scenes.file_contents(), bpy.context.active_object
    modifiers = ob.modifiers.keys()
    with pytest.raises(RuntimeError, match=match):
        convert(**properties)
    assert scenes.file_contents() == before
    assert bpy.context.active_object == active
    assert ob.modifiers.keys() == modifiers
    assert not ob.particle_systems


def test_refusals():
    ob = scenes.cross()
    hair = add_hair(ob)
    check_refused("at least 2 keys", ob, keys=1)
    ob.hide_viewport = True
    bpy.context.view_layer.update()
    check_refused("Cross is hidden", ob)
    ob.hide_viewport = False
    ob.hide_set(True)
    check_refused("Cross is hidden", ob)
    ob.hide_set(False)
    bpy.context.collection.objects.unlink(ob)
    bpy.context.view_layer.update()
    check_refused("not in the view layer", ob)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode="EDIT")
    scenes.activate(hair)
    check_refused("Cross is in Edit Mode", ob)
    scenes.activate(ob)
    bpy.ops.object.mode_set(mode="OBJECT")
    scenes.activate(hair)
    ob.data.clear_geometry()
    check_refused("no faces", ob)


def test_nothing_is_left_of_a_system_that_blender_does_not_evaluate(monkeypatch):
    ob = scenes.cross()
    add_hair(ob)

    def refuse(_context, _surface, name):
        assert name in ob.particle_systems
        raise RefusalError("not evaluated")

    monkeypatch.setattr(system.Shown, "of", refuse)
    check_refused("not evaluated", ob)


def test_refuses_hair_that_is_nowhere():
    ob = scenes.cross()
    hair = add_hair(ob)
    curve = hair.data.curves[3]
    curve.points[1].position = (0, float("nan"), 0)
    check_refused(f"Strand 3 of {hair.name} has coordinates that are not finite", ob)


def test_refuses_hair_that_is_not_bound():
    ob = scenes.cross()
    hair = add_hair(ob)
    hair.data.attributes.remove(hair.data.attributes[ids.FACE])
    check_refused("stores no places", ob)


def test_refuses_a_surface_whose_faces_have_changed():
    ob = scenes.cross()
    add_hair(ob, follow="NODES")
    bpy.context.view_layer.objects.active.data[ids.SIGNATURE] = "other faces"
    check_refused("Cross", ob)


def test_refuses_hair_whose_modifiers_make_other_strands():
    ob = scenes.cross()
    hair = add_hair(ob)
    group = bpy.data.node_groups.new("Nothing", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    group.nodes.new("NodeGroupOutput")
    hair.modifiers.new("Nothing", "NODES").node_group = group
    check_refused("change its number of strands", ob)


def test_refuses_a_linked_surface(tmp_path):
    ob = scenes.cross()
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {ob})
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (_there, here):
        here.objects = ["Cross"]
    (ob,) = here.objects
    bpy.context.collection.objects.link(ob)
    scenes.add_hair(ob)
    check_refused("linked from another file", ob)


def test_needs_hair():
    scenes.cross()
    with pytest.raises(RuntimeError, match="Make hair on a limit surface active first"):
        convert()
