# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair snapped by its roots: the motion of strands, and what is stored of their new places."""

import bpy
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.reading import attributes, ragged_rows
from snap_scenes import SIZES, add_hair, roots, world_strands
from snap_truth import Truth, mirrored, snap, stretched

EXACT = 1e-6


def check_stored(hair, target, chosen=slice(None)):
    """The locations lead to the stored roots and frames, as for new hair."""
    truth = Truth(target)
    face, uv = scenes.locations(hair.data)
    face, uv = face[chosen], uv[chosen]
    to_hair = np.linalg.solve(np.array(hair.matrix_world), np.array(target.matrix_world))
    expected = scenes.transformed(to_hair, truth.surface.evaluate(face, uv).position)
    np.testing.assert_allclose(
        attributes.read(hair.data, ids.REST_ROOT)[chosen], expected, atol=1e-6
    )
    w, x, y, z = attributes.read(hair.data, ids.REST_ROTATION)[chosen].astype(float).T
    normal = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)
    tangent = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=1)
    frames = truth.surface.frames(face, uv)
    outward = np.linalg.solve(to_hair[:3, :3].T, frames[:, :, 2].T).T
    along = frames[:, :, 0] @ to_hair[:3, :3].T
    for stored, vector in ((normal, outward), (tangent, along)):
        unit = vector / np.linalg.norm(vector, axis=1, keepdims=True)
        np.testing.assert_allclose(stored, unit, atol=1e-5)


@pytest.mark.parametrize("placed", [stretched, mirrored])
def test_whole_strands(placed):
    target = placed(scenes.grid_with_holes())
    hair, truth = add_hair(target), Truth(target)
    before = world_strands(hair)
    snap(target)
    after = world_strands(hair)
    np.testing.assert_allclose(truth.distances(roots(after)), 0, atol=EXACT)
    moved = np.linalg.norm(roots(after) - roots(before), axis=1)
    np.testing.assert_allclose(moved, truth.distances(roots(before)), atol=EXACT)
    for old, new in zip(before, after, strict=True):
        np.testing.assert_allclose(new - new[0], old - old[0], atol=EXACT)
    check_stored(hair, target)
    assert hair.data.surface == target


def test_root_alone():
    target = stretched(scenes.cross())
    hair, truth = add_hair(target), Truth(target)
    before, stored = world_strands(hair), attributes.read(hair.data, "position")
    snap(target, hair="ROOT")
    after = world_strands(hair)
    np.testing.assert_allclose(truth.distances(roots(after)), 0, atol=EXACT)
    root_rows = ragged_rows.starts(SIZES)
    rest = np.setdiff1d(np.arange(sum(SIZES)), root_rows)
    np.testing.assert_array_equal(attributes.read(hair.data, "position")[rest], stored[rest])
    assert len(before) == len(after)


def test_blended_along_the_strand():
    target = stretched(scenes.cross())
    hair, truth = add_hair(target), Truth(target)
    before = world_strands(hair)
    snap(target, hair="BLEND")
    after = world_strands(hair)
    np.testing.assert_allclose(truth.distances(roots(after)), 0, atol=EXACT)
    for old, new in zip(before, after, strict=True):
        lengths = np.linalg.norm(np.diff(old, axis=0), axis=1)
        along = np.concatenate([[0], np.cumsum(lengths)])
        weight = 1 - along / along[-1] if along[-1] else np.ones(1)
        expected = old + weight[:, None] * (new[0] - old[0])
        np.testing.assert_allclose(new, expected, atol=EXACT)


@pytest.mark.parametrize("mode", ["ROOT", "STRAND", "BLEND"])
def test_lengths_are_kept(mode):
    target = stretched(scenes.cross())
    hair, truth = add_hair(target), Truth(target)
    before = world_strands(hair)
    snap(target, hair=mode, keep_length=True)
    after = world_strands(hair)
    np.testing.assert_allclose(truth.distances(roots(after)), 0, atol=EXACT)
    for old, new in zip(before, after, strict=True):
        lengths = [np.linalg.norm(np.diff(s, axis=0), axis=1) for s in (old, new)]
        np.testing.assert_allclose(*lengths, atol=EXACT)


@pytest.mark.parametrize("placed", [stretched, mirrored])
def test_aligned_to_the_normal(placed):
    target = placed(scenes.cross())
    hair, truth = add_hair(target), Truth(target)
    before = world_strands(hair)
    snap(target, align="NORMAL")
    after = world_strands(hair)
    normals = truth.normals_at(roots(after))
    for old, new, normal in zip(before, after, normals, strict=True):
        lengths = [np.linalg.norm(s[:, None] - s, axis=2) for s in (old, new)]
        np.testing.assert_allclose(*lengths, atol=EXACT)  # turned, not bent
        if len(new) > 1:
            direction = (new[1] - new[0]) / np.linalg.norm(new[1] - new[0])
            np.testing.assert_allclose(direction, normal, atol=1e-5)


def frames_in_world(truth, data):
    frames = truth.surface.frames(*scenes.locations(data))
    tangent = frames[:, :, 0] @ truth.matrix[:3, :3].T
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    normal = truth.normals(*scenes.locations(data))
    return np.stack([tangent, np.cross(normal, tangent), normal], axis=2)


def test_strands_turn_with_the_frames_that_they_were_bound_to():
    """The mesh is bent after the hair was combed: strands keep their angles to the surface."""
    target = scenes.cross()
    hair = scenes.add_hair(target, per_side=2, tilt=(0.5, 0.3))
    before, old = world_strands(hair), frames_in_world(Truth(target), hair.data)
    for vertex in target.data.vertices:
        vertex.co.z += 0.5 * vertex.co.x - 0.3 * vertex.co.x * vertex.co.y
    hair.select_set(True)
    snap(target, align="NORMAL_DU")
    after, new = world_strands(hair), frames_in_world(Truth(target), hair.data)
    for was, now, frame, to in zip(before, after, old, new, strict=True):
        np.testing.assert_allclose((now - now[0]) @ to, (was - was[0]) @ frame, atol=2e-5)


def test_hair_on_its_surface_stays_and_stores_the_same():
    target = stretched(scenes.cross())
    scenes.add_uv_map(target, lambda p: p[:, :2] * 0.2 + 0.5)
    hair = scenes.add_hair(target, per_side=3)
    names = (ids.FACE, ids.UV, ids.REST_ROOT, ids.REST_ROTATION, ids.SURFACE_UV)
    before = {name: attributes.read(hair.data, name) for name in names}
    strands = world_strands(hair)
    for properties in ({}, {"hair": "BLEND", "keep_length": True}, {"align": "NORMAL_DU"}):
        snap(target, **properties)
        np.testing.assert_allclose(world_strands(hair), strands, atol=EXACT)
    same = attributes.read(hair.data, ids.FACE) == before[ids.FACE]
    assert same.all()
    for name in names:
        np.testing.assert_allclose(attributes.read(hair.data, name), before[name], atol=2e-6)


def test_roots_lie_where_their_stored_locations_say_to_the_bit():
    target = stretched(scenes.mixed_polygons())
    hair = scenes.add_hair(target, per_side=3)
    moved = attributes.read(hair.data, "position") + np.float32(0.01)
    hair.data.points.foreach_set("position", moved.ravel())
    hair.select_set(True)
    snap(target)
    surface = scenes.surface_without_addon(target)
    root = surface.evaluate(*scenes.locations(hair.data)).position.astype(np.float32)
    np.testing.assert_array_equal(scenes.strands(hair)[:, 0], root)
    np.testing.assert_array_equal(attributes.read(hair.data, ids.REST_ROOT), root)


def test_offset_leaves_what_is_stored_on_the_surface():
    target = stretched(scenes.cross())
    hair, truth = add_hair(target), Truth(target)
    snap(target)
    flush = roots(world_strands(hair))
    snap(target, offset=0.1)
    raised = roots(world_strands(hair))
    np.testing.assert_allclose(raised - flush, 0.1 * truth.normals_at(flush), atol=1e-5)
    check_stored(hair, target)


def test_surface_uv():
    target = stretched(scenes.cross())
    scenes.add_uv_map(target, lambda p: p[:, :2] * 0.2 + 0.5)
    hair = add_hair(target)
    snap(target)
    assert hair.data.surface_uv_map == "Flat"
    corners = attributes.read(target.data, "Flat")
    face, uv = scenes.locations(hair.data)
    expected = scenes.bilinear(scenes.ptex_corners(target, corners), face, uv)
    np.testing.assert_allclose(attributes.read(hair.data, ids.SURFACE_UV), expected, atol=1e-6)


def test_without_uv_map(capfd):
    target = scenes.cross()
    hair = add_hair(target)
    snap(target)
    assert ids.SURFACE_UV not in hair.data.attributes
    assert "UVs were not stored: Cross has no UV map" in capfd.readouterr().out


def in_mode(hair, target, mode, selection=None, domain="CURVE"):
    bpy.context.scene.limit_surface.target = target
    target.select_set(False)
    scenes.activate(hair)
    hair.data.selection_domain = domain
    bpy.ops.object.mode_set(mode=mode)
    if selection is not None:
        hair.data.attributes.new(".selection", "BOOLEAN", domain)
        hair.data.attributes[".selection"].data.foreach_set("value", selection)


@pytest.mark.parametrize("mode", ["EDIT", "SCULPT_CURVES"])
@pytest.mark.parametrize("domain", ["CURVE", "POINT"])
def test_selected_strands(mode, domain):
    target = stretched(scenes.cross())
    hair, truth = add_hair(target), Truth(target)
    chosen = np.array([True, False, True, False, False, True])
    selection = chosen
    if domain == "POINT":  # the last point of each selected strand
        selection = np.zeros(sum(SIZES), bool)
        selection[np.cumsum(SIZES)[chosen] - 1] = True
    in_mode(hair, target, mode, selection, domain)
    before = world_strands(hair)
    assert bpy.ops.object.limit_snap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    after = world_strands(hair)
    np.testing.assert_allclose(truth.distances(roots(after)[chosen]), 0, atol=EXACT)
    for i in np.flatnonzero(~chosen):
        np.testing.assert_array_equal(after[i], before[i])
    check_stored(hair, target, chosen)
    np.testing.assert_array_equal(attributes.read(hair.data, ids.FACE)[~chosen], -1)


@pytest.mark.parametrize("mode", ["EDIT", "SCULPT_CURVES"])
def test_without_a_selection_all_are_selected(mode):
    target = scenes.cross()
    hair, truth = add_hair(target), Truth(target)
    in_mode(hair, target, mode)
    assert bpy.ops.object.limit_snap() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_allclose(truth.distances(roots(world_strands(hair))), 0, atol=EXACT)


def test_part_of_another_surfaces_hair_is_refused():
    other = scenes.flat_grid(2)
    target = scenes.cross()
    hair = add_hair(target)
    hair.data.surface = other
    before = attributes.read(hair.data, "position")
    in_mode(hair, target, "EDIT", np.arange(6) < 3)
    with pytest.raises(RuntimeError, match="is hair of Flat"):
        bpy.ops.object.limit_snap()
    bpy.ops.object.mode_set(mode="OBJECT")
    np.testing.assert_array_equal(attributes.read(hair.data, "position"), before)
    hair.select_set(True)
    snap(target)  # if all its strands are snapped, hair changes to the other surface
    assert hair.data.surface == target


def test_an_attribute_of_that_name_in_the_way():
    target = scenes.cross()
    hair = add_hair(target)
    hair.data.attributes.new(ids.FACE, "FLOAT", "POINT")
    before = attributes.read(hair.data, "position")
    scenes.activate(target)
    with pytest.raises(
        RuntimeError, match="the attribute limit_face exists with another type or domain"
    ):
        bpy.ops.object.limit_snap()
    np.testing.assert_array_equal(attributes.read(hair.data, "position"), before)


def test_hair_without_strands():
    target = scenes.cross()
    data = bpy.data.hair_curves.new("Bald")
    ob = bpy.data.objects.new("Bald", data)
    bpy.context.collection.objects.link(ob)
    ob.select_set(True)
    scenes.activate(target)
    with pytest.raises(RuntimeError, match="Nothing that can be snapped is selected"):
        bpy.ops.object.limit_snap()


def test_bezier_handles_come_along():
    target = stretched(scenes.cross())
    hair = add_hair(target)
    rng = np.random.default_rng(5)
    position = attributes.read(hair.data, "position")
    offsets = {}
    for name in ("handle_left", "handle_right"):
        offsets[name] = rng.normal(size=position.shape).astype(np.float32)
        attributes.write(hair.data, name, "FLOAT_VECTOR", "POINT", position + offsets[name])
    snap(target, hair="BLEND", keep_length=True)
    position = attributes.read(hair.data, "position")
    for name, offset in offsets.items():
        np.testing.assert_allclose(attributes.read(hair.data, name) - position, offset, atol=1e-5)


def test_hair_and_objects_together(capfd):
    target = stretched(scenes.cross())
    hair, truth = add_hair(target), Truth(target)
    thing = bpy.data.objects.new("Thing", None)
    bpy.context.collection.objects.link(thing)
    thing.select_set(True)
    matrix = hair.matrix_world.copy()
    snap(target)
    assert hair.matrix_world == matrix
    places = [*roots(world_strands(hair)), thing.location]
    np.testing.assert_allclose(truth.distances(np.array(places)), 0, atol=EXACT)
    said = capfd.readouterr().out
    assert "1 of 1 object snapped" in said
    assert "6 of 6 strands snapped" in said


@pytest.mark.parametrize("align", ["NONE", "NORMAL"])
def test_hair_and_what_it_hangs_from(align, capfd):
    target = stretched(scenes.cross())
    hair, truth = add_hair(target), Truth(target)
    carrier = bpy.data.objects.new("Carrier", None)
    carrier.location, carrier.rotation_euler = (4, 1, -2), (0.3, 0.2, 0.1)
    bpy.context.collection.objects.link(carrier)
    carrier.select_set(True)
    hair.parent = carrier
    before = roots(world_strands(hair))
    snap(target, align=align)
    after = roots(world_strands(hair))
    np.testing.assert_allclose(truth.distances(after), 0, atol=EXACT)
    np.testing.assert_allclose(truth.distances([carrier.matrix_world.translation]), 0, atol=EXACT)
    expected = truth.distances(before)
    np.testing.assert_allclose(np.linalg.norm(after - before, axis=1), expected, atol=2e-6)
    check_stored(hair, target)
    assert f"moved by {expected.mean():.4g} on average" in capfd.readouterr().out


def test_two_objects_with_the_same_curves(capfd):
    target = scenes.cross()
    hair = add_hair(target)
    twin = bpy.data.objects.new("Twin", hair.data)
    bpy.context.collection.objects.link(twin)
    twin.select_set(True)
    snap(target)
    said = capfd.readouterr().out
    assert "1 object could not be snapped: another selected object has the same curves (1)" in said


@pytest.mark.parametrize("kind", ["VIEWPORT", "RENDER"])
def test_on_the_polygons_that_are_shown(kind):
    target = stretched(scenes.cross())
    subsurf = scenes.add_subsurf(target)
    subsurf.levels, subsurf.render_levels = 1, 2
    hair = add_hair(target)
    bpy.ops.object.select_all(action="SELECT")
    scenes.activate(target)
    assert bpy.ops.object.limit_snap(target=kind) == {"FINISHED"}
    subsurf.levels = 1 if kind == "VIEWPORT" else 2
    bpy.context.view_layer.update()
    shown = target.evaluated_get(bpy.context.evaluated_depsgraph_get())
    for root in roots(world_strands(hair)):
        local = np.linalg.inv(np.array(shown.matrix_world)) @ [*root, 1]
        _, close, _, _ = shown.closest_point_on_mesh(local[:3])
        np.testing.assert_allclose(close, local[:3], atol=1e-5)
    stored = attributes.read(hair.data, ids.REST_ROOT)
    first = ragged_rows.starts(SIZES)
    np.testing.assert_allclose(stored, attributes.read(hair.data, "position")[first], atol=1e-6)


def test_library_overrides_are_refused(tmp_path):
    """Blender does not save points that are written to them."""
    target = scenes.cross()
    hair = add_hair(target)
    hair, target = scenes.overridden(tmp_path, hair, target)
    before = attributes.read(hair.data, "position")
    hair.select_set(True)
    with pytest.raises(RuntimeError, match="is a library override: Blender does not save"):
        snap(target)
    np.testing.assert_array_equal(attributes.read(hair.data, "position"), before)
