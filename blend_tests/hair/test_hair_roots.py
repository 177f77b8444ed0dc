# SPDX-License-Identifier: GPL-3.0-or-later
"""Each root lies exactly where its stored location says, whatever modifiers stand before the
subdivision.
"""

import bpy
import limitsurf
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes
from scenes import add_hair, add_points, add_subsurf, locations, strands, surface_without_addon


def mirror(ob):
    modifier = ob.modifiers.new("Mirror", "MIRROR")
    modifier.use_axis[:] = (False, False, True)
    modifier.merge_threshold = 1e-4


def displace(ob):
    modifier = ob.modifiers.new("Displace", "DISPLACE")
    modifier.strength = 0.4


def twist(ob):
    modifier = ob.modifiers.new("Twist", "SIMPLE_DEFORM")
    modifier.deform_method, modifier.angle = "TWIST", 0.7


def array(ob):
    modifier = ob.modifiers.new("Array", "ARRAY")
    modifier.relative_offset_displace = (1.4, 0.1, 0)


def shape_keys(ob):
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="Up")
    for i, point in enumerate(key.data):
        point.co.z += 0.3 * np.sin(i)
    key.value = 0.6


def solidify_turned_off(ob):
    ob.modifiers.new("Solidify", "SOLIDIFY").show_viewport = False


BEFORE = (mirror, displace, twist, array, shape_keys, solidify_turned_off)


def check_roots(hair, surface):
    """Compares to the last bit of single precision: both are the same doubles, rounded once."""
    expected = surface.evaluate(*locations(hair.data)).position.astype(np.float32)
    np.testing.assert_array_equal(strands(hair)[:, 0], expected)
    np.testing.assert_array_equal(attributes.read(hair.data, ids.REST_ROOT), expected)


@pytest.mark.parametrize("boundary", scenes.BOUNDARIES)
@pytest.mark.parametrize("scene", scenes.SCENES)
def test_on_meshes(scene, boundary):
    ob = scenes.SCENES[scene]()
    add_subsurf(ob, boundary)
    hair = add_hair(ob)
    surface = surface_without_addon(ob, boundary)
    check_roots(hair, surface)
    counts = np.bincount(locations(hair.data)[0], minlength=surface.face_count)
    np.testing.assert_array_equal(counts, 16)


@pytest.mark.parametrize("before", BEFORE, ids=lambda f: f.__name__)
def test_modifiers_before_subdivision_are_applied(before):
    ob = scenes.grid_with_holes()
    before(ob)
    add_subsurf(ob)
    check_roots(add_hair(ob), surface_without_addon(ob))


def creased_sheet():
    """Adds a sheet with an edge of sharpness 3.6, an infinitely sharp one, and a vertex of 0.9."""
    ob = scenes.grid_with_holes()
    index = {frozenset(edge.vertices): edge.index for edge in ob.data.edges}
    edges = ob.data.edge_creases_ensure().data
    edges[index[frozenset((8, 9))]].value, edges[index[frozenset((1, 7))]].value = 0.6, 1
    ob.data.vertex_creases_ensure().data[4].value = 0.3
    ten = np.float32(10)
    sharpness = [np.float32(c) * np.float32(c) * ten for c in (0.6, 1, 0.3)]
    faces = [polygon.vertices[:] for polygon in ob.data.polygons]
    cage = limitsurf.ControlMesh.from_faces(
        attributes.read(ob.data, "position").astype(np.float64),
        faces,
        edge_sharpness=([(8, 9), (1, 7)], sharpness[:2]),
        vertex_sharpness=([4], sharpness[2:]),
    )
    return ob, limitsurf.LimitSurface(cage)


def test_creases():
    ob, surface = creased_sheet()
    subsurf = add_subsurf(ob)
    hair = add_hair(ob)
    check_roots(hair, surface)
    for domain, data in (("CURVE", hair.data), ("POINT", add_points(ob).data)):
        stored = data.attributes[ids.REST_ROOT]
        assert stored.domain == domain
        np.testing.assert_array_equal(
            attributes.read(data, ids.REST_ROOT), strands(hair)[:, 0], err_msg=domain
        )
    subsurf.use_creases = False
    smooth = add_hair(ob)
    assert np.abs(strands(smooth) - strands(hair)).max() > 0.05
    check_roots(smooth, surface_without_addon(ob))


@pytest.mark.parametrize("scene", scenes.SCENES)
def test_simple_subdivision_is_bilinear(scene):
    ob = scenes.SCENES[scene]()
    add_subsurf(ob).subdivision_type = "SIMPLE"
    hair = add_hair(ob)
    place = scenes.on_base_mesh(ob, *locations(hair.data))
    np.testing.assert_allclose(strands(hair)[:, 0], place, atol=1e-6)


def test_armature_at_the_current_frame():
    ob = scenes.grid_with_holes()
    bones = bpy.data.objects.new("Bones", bpy.data.armatures.new("Bones"))
    bpy.context.collection.objects.link(bones)
    scenes.activate(bones)
    bpy.ops.object.mode_set(mode="EDIT")
    bone = bones.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 0), (5, 0, 0)
    bpy.ops.object.mode_set(mode="OBJECT")
    ob.vertex_groups.new(name="Bone").add(range(10, 20), 0.7, "REPLACE")
    ob.modifiers.new("Armature", "ARMATURE").object = bones
    pose = bones.pose.bones["Bone"]
    pose.rotation_mode = "XYZ"
    for frame, angle in ((1, 0.0), (21, 1.5)):
        pose.rotation_euler.y = angle
        pose.keyframe_insert("rotation_euler", frame=frame)
    add_subsurf(ob)
    roots = {}
    for frame, subframe in ((1, 0.0), (11, 0.5)):
        bpy.context.scene.frame_set(frame, subframe=subframe)
        hair = add_hair(ob)
        check_roots(hair, surface_without_addon(ob))
        roots[frame] = strands(hair)[:, 0]
    assert np.abs(roots[1] - roots[11]).max() > 0.1


def test_no_subdivision_counts_as_one_with_default_settings():
    ob = scenes.cross()
    displace(ob)
    hair = add_hair(ob)
    add_subsurf(ob)
    check_roots(hair, surface_without_addon(ob))


def test_the_first_enabled_subdivision_counts(capfd):
    ob = scenes.cross()
    first = add_subsurf(ob, "ALL")
    first.show_viewport = False
    displace(ob)
    second = add_subsurf(ob, "PRESERVE_CORNERS")
    ob.modifiers.new("Wave", "WAVE")
    ob.modifiers.new("Solidify", "SOLIDIFY").show_viewport = False
    hair = add_hair(ob)
    reported = capfd.readouterr().out
    assert f"ignored after {second.name}: Wave" in reported
    assert "Solidify" not in reported
    ob.modifiers.remove(first)
    check_roots(hair, surface_without_addon(ob, "PRESERVE_CORNERS"))


def test_single_precision_parameters_stay_inside():
    """Rounding must not make (u, v) larger than 1."""
    ob = scenes.cross()
    hair = add_hair(ob, per_side=100)
    uv = attributes.read(hair.data, ids.UV)
    assert uv.min() >= 0
    assert uv.max() <= 1


@pytest.mark.parametrize("scene", ["cross", "mixed polygons"])
def test_rest_rotation_is_the_surface_frame(scene):
    ob = scenes.SCENES[scene]()
    hair = add_hair(ob)
    frames = surface_without_addon(ob).frames(*locations(hair.data))
    for stored, frame in zip(attributes.read(hair.data, ids.REST_ROTATION), frames, strict=True):
        w, x, y, z = (float(part) for part in stored)
        assert stored @ stored == pytest.approx(1, abs=1e-6)
        rotation = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        np.testing.assert_allclose(rotation, frame, atol=1e-6)


def test_save_and_load(tmp_path):
    ob = scenes.grid_with_holes()
    mirror(ob)
    add_subsurf(ob, "PRESERVE_CORNERS")
    name = add_hair(ob, tilt=(0.3, 0.1), random=0.2).name
    before = strands(bpy.data.objects[name])
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "hair.blend"))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "hair.blend"))
    hair, ob = bpy.data.objects[name], bpy.data.objects["Holes"]
    assert hair.data.surface == hair.parent == ob
    np.testing.assert_array_equal(strands(hair), before)
    check_roots(hair, surface_without_addon(ob, "PRESERVE_CORNERS"))
    assert "limit_cage" not in " ".join(scene.name for scene in bpy.data.scenes)
