# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair that is made from a particle system has the strands that Blender draws, and is bound to the
limit surface as all hair is.
"""

import bpy
import numpy as np
import particle_scenes
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from particle_scenes import KEYS, add_hair, add_system, bend, drawn, in_world

convert = bpy.ops.object.limit_hair_from_particles
to_particles = bpy.ops.object.limit_particles_from_hair


def made(ob, **properties):
    scenes.activate(ob)
    assert convert(**properties) == {"FINISHED"}
    return bpy.context.active_object


def furry(transform=None, **properties):
    """Adds a mesh with hair that Blender has grown."""
    ob = scenes.cross()
    scenes.add_subsurf(ob).levels = 2
    scenes.place(ob, transform or {})
    add_system(ob, **properties)
    return ob


@pytest.mark.parametrize("transform", [{}, scenes.STRETCHED, scenes.MIRRORED])
def test_strands_are_those_that_are_drawn(transform):
    ob = furry(transform)
    strands = drawn(ob)
    assert len(strands) == 100
    assert np.linalg.norm(strands[:, -1] - strands[:, 0], axis=1).min() > 0.01
    hair = made(ob, snap_roots=False)
    np.testing.assert_allclose(in_world(hair), strands, rtol=0, atol=particle_scenes.bound(strands))


def test_snapped_roots_lie_where_their_attributes_say():
    ob = furry(scenes.STRETCHED)
    strands = drawn(ob)
    hair = made(ob)
    surface = scenes.surface_without_addon(ob)
    face, uv = scenes.locations(hair.data)
    roots = surface.evaluate(face, uv).position
    np.testing.assert_array_equal(scenes.strands(hair)[:, 0], roots.astype(np.float32))
    moved = in_world(hair) - strands
    assert np.abs(moved[:, 0]).max() > 1e-3
    # each strand is moved as a whole
    np.testing.assert_allclose(moved, moved[:, :1].repeat(KEYS, axis=1), atol=3e-6)
    # to the closest place in the world
    surface.set_positions(scenes.transformed(ob.matrix_world, surface.positions))
    hits = surface.closest(strands[:, 0])
    np.testing.assert_allclose(np.linalg.norm(moved[:, 0], axis=1), hits.distance, atol=3e-6)


def test_stored_as_new_hair_is():
    ob = scenes.mixed_polygons()
    scenes.add_uv_map(ob, lambda p: 0.1 * p[:, :2])
    scenes.add_subsurf(ob).levels = 2
    new = add_hair(ob)
    strands = scenes.strands(new)
    to_particles()
    back = made(ob)
    kinds = [
        {a.name: (a.data_type, a.domain) for a in hair.data.attributes} for hair in (new, back)
    ]
    assert kinds[0] == kinds[1]
    assert (back.data.surface, back.data.surface_uv_map) == (ob, new.data.surface_uv_map)
    assert (back.parent, back.matrix_world) == (ob, ob.matrix_world)
    size = np.abs(strands).max()
    np.testing.assert_allclose(scenes.strands(back), strands, rtol=0, atol=2e-6 * size)
    for name in (ids.REST_ROOT, ids.REST_ROTATION, ids.SURFACE_UV, "radius"):
        np.testing.assert_allclose(
            attributes.read(back.data, name), attributes.read(new.data, name), atol=5e-6
        )


@pytest.mark.parametrize("transform", [{}, scenes.STRETCHED, scenes.MIRRORED])
@pytest.mark.parametrize("scene", ["cross", "grid with holes"])
def test_there_and_back(scene, transform):
    """The round trip moves combed strands by no more than single precision."""
    ob = scenes.SCENES[scene]()
    scenes.add_subsurf(ob).levels = 2
    scenes.place(ob, transform)
    hair = add_hair(ob, points=6)
    bend(hair)
    before = in_world(hair)
    for _ in range(2):
        to_particles()
        hair = made(ob, system=ob.particle_systems[-1].name)
        after = in_world(hair)
        np.testing.assert_allclose(after, before, rtol=0, atol=particle_scenes.bound(before))


@pytest.mark.parametrize("follow", ["NODES", "LIVE"])
def test_hair_follows(follow):
    ob = furry()
    key = particle_scenes.add_shape_key(ob)
    hair = made(ob, follow=follow)
    key.value = 1
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown = attributes.read(hair.evaluated_get(depsgraph).data, ids.POSITION)
    roots = shown.reshape(-1, KEYS, 3)[:, 0]
    exact = scenes.surface_without_addon(ob).evaluate(*scenes.locations(hair.data)).position
    assert np.abs(exact - attributes.read(hair.data, ids.REST_ROOT)).max() > 0.1
    np.testing.assert_allclose(roots, exact, atol=2e-6)


def test_the_report_says_why_hair_does_not_follow(capfd):
    ob = furry()
    particle_scenes.add_shape_key(ob)
    ob.modifiers["Subdivision"].show_render = False
    scenes.add_subsurf(ob)
    hair = made(ob)
    assert not hair.modifiers
    assert "they do not follow the surface: " in capfd.readouterr().out


def test_roots_off_the_surface_keep_their_distance():
    """The floating roots of hair that follows keep their place beside the surface."""
    ob = furry()
    for name in ("Basis", "Moved"):
        ob.shape_key_add(name=name)
    key = ob.data.shape_keys.key_blocks["Moved"]
    for point in key.data:
        point.co.z += 2
    key.value = 0
    hair = made(ob, follow="NODES", snap_roots=False)
    before = in_world(hair)
    key.value = 1
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown = attributes.read(hair.evaluated_get(depsgraph).data, ids.POSITION)
    np.testing.assert_allclose(shown.reshape(before.shape), before + [0, 0, 2], atol=3e-6)


def test_hair_that_the_viewport_leaves_out():
    ob = furry()
    strands = drawn(ob)
    settings = ob.particle_systems[0].settings
    settings.display_percentage = 10
    hair = made(ob, snap_roots=False)
    np.testing.assert_allclose(in_world(hair), strands, atol=particle_scenes.bound(strands))
    assert settings.display_percentage == 10


def test_children_are_left_out():
    ob = furry()
    strands = drawn(ob)
    ob.particle_systems[0].settings.child_type = "INTERPOLATED"
    hair = made(ob, snap_roots=False)
    np.testing.assert_allclose(in_world(hair), strands, atol=particle_scenes.bound(strands))


def test_thickness_and_material():
    ob = furry({"scale": (2, 2, 2)})
    brown = bpy.data.materials.new("Brown")
    for material in (bpy.data.materials.new("Skin"), brown):
        ob.data.materials.append(material)
    settings = ob.particle_systems[0].settings
    settings.material = 2
    settings.radius_scale, settings.root_radius, settings.tip_radius = 0.1, 1.0, 0.2
    settings.use_close_tip = False
    hair = made(ob)
    assert list(hair.data.materials) == [brown]
    radius = attributes.read(hair.data, "radius").reshape(-1, KEYS)
    # half of the diameter, in the space of an object that is twice as large in the world
    np.testing.assert_allclose(radius, np.tile(np.linspace(0.025, 0.005, KEYS), (100, 1)), 1e-5)
    settings.shape, settings.use_close_tip = 0.5, True
    radius = attributes.read(made(ob).data, "radius").reshape(-1, KEYS)[0]
    assert radius[KEYS // 2] == pytest.approx(0.005 + 0.02 * 0.5**2, rel=1e-5)
    assert radius[-1] == 0
    settings.shape = -0.5
    radius = attributes.read(made(ob).data, "radius").reshape(-1, KEYS)[0]
    assert radius[KEYS // 2] == pytest.approx(0.005 + 0.02 * 0.5**0.5, rel=1e-5)


def test_particles_on_the_mesh_before_its_subdivision():
    ob = scenes.cross()
    add_system(ob)
    scenes.add_subsurf(ob).levels = 2
    strands = drawn(ob)
    hair = made(ob, snap_roots=False)
    np.testing.assert_allclose(in_world(hair), strands, atol=particle_scenes.bound(strands))
    assert not hair.modifiers  # particles do not deform the mesh


def test_strands_of_different_numbers_of_keys():
    ob = scenes.cross()
    add_system(ob)
    curves = bpy.data.hair_curves.new("Uneven")
    curves.add_curves([2, 5, 9])
    points = np.random.default_rng(1).normal(size=(16, 3)).astype(np.float32)
    curves.points.foreach_set("position", points.ravel())
    curves.surface = ob
    uneven = bpy.data.objects.new("Uneven", curves)
    bpy.context.collection.objects.link(uneven)
    bpy.context.view_layer.update()
    scenes.activate(uneven)
    for other in bpy.context.selected_objects:
        other.select_set(other == uneven)
    uneven.select_set(True)
    bpy.ops.curves.convert_to_particle_system()
    hair = made(ob, system="Uneven", snap_roots=False)
    sizes = [curve.points_length for curve in hair.data.curves]
    assert sizes == [2, 5, 9]
    strands = drawn(ob, number=1)
    expected = [strands[0, ::8], strands[1, ::2], strands[2]]
    np.testing.assert_allclose(
        attributes.read(hair.data, "position"), np.concatenate(expected), atol=3e-6
    )


def test_the_named_system_is_taken():
    ob = furry(name="First", count=10)
    add_system(ob, "Second", 20)
    ob.particle_systems.active_index = 0
    assert len(made(ob).data.curves) == 10
    assert len(made(ob, system="Second").data.curves) == 20


def test_undo():
    ob = furry()
    name, before = ob.name, scenes.file_contents()
    bpy.ops.ed.undo_push(message="before")
    made(ob)
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert scenes.file_contents() == before
    assert len(bpy.data.objects[name].particle_systems) == 1


def check_refused(match, ob, **properties):
    before, active = scenes.file_contents(), bpy.context.active_object
    with pytest.raises(RuntimeError, match=match):
        convert(**properties)
    assert scenes.file_contents() == before
    assert bpy.context.active_object == active
    assert len(ob.particle_systems) == 1


def test_refusals():
    ob = furry()
    check_refused("no particle system 'Furr'", ob, system="Furr")
    ob.modifiers["Fur"].show_viewport = False
    check_refused("does not evaluate the particle system Fur", ob)
    ob.modifiers["Fur"].show_viewport = True
    ob.hide_set(True)
    check_refused("Cross is hidden", ob)
    ob.hide_set(False)
    settings = ob.particle_systems[0].settings
    settings.count = 0
    check_refused("Fur has no hair", ob)
    settings.count = 10
    settings.type = "EMITTER"
    check_refused("emits particles: only hair", ob)


def test_needs_particles():
    scenes.cross()
    with pytest.raises(RuntimeError, match="Make a mesh with a hair particle system active first"):
        convert()
