# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangent-space normal maps on the meshes for which they are made, as Cycles shades them; and
Blender's own tangents on ever finer meshes, which converge to the limit's frames.
"""

import bpy
import limitsurf
import numpy as np
import pytest
from limit_surface import ids
from limit_surface.images import image_pixels
from limit_surface.reading import attributes, cage, subdivided_mesh
from shaded_maps import angles, shaded, with_subsurf

SIZE = 128


def suzanne(smooth: bool) -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    ob = bpy.context.active_object
    if smooth:
        ob.data.shade_smooth()
    return with_subsurf(ob)


def drum(smooth: bool) -> bpy.types.Object:
    """Adds a mesh with two polygons of seven corners."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=7)
    ob = bpy.context.active_object
    if smooth:
        ob.data.shade_smooth()
    return with_subsurf(ob)


@pytest.mark.every(5)
@pytest.mark.parametrize("smooth", [True, False])
@pytest.mark.parametrize("target", ["CAGE", "VIEWPORT", "RENDER"])
@pytest.mark.parametrize("make", [suzanne, drum])
def test_polygons_are_shaded_as_the_limit_surface(make, target, smooth):
    ob = make(smooth)
    bpy.ops.object.limit_bake_maps(
        maps={"NORMAL_TANGENT", "NORMAL_OBJECT"},
        width=SIZE, height=SIZE, target=target, overlap="ALLOW",
    )  # fmt: skip
    if target == "CAGE":
        ob.modifiers.clear()
    elif target == "VIEWPORT":
        ob.modifiers[0].render_levels = 1  # bakes use the render's levels
    exact = image_pixels.read(bpy.data.images[f"{ob.name} Normal"])[..., :3]
    found = shaded(ob, bpy.data.images[f"{ob.name} Tangent Normal"])
    there = found.any(axis=-1) & exact.any(axis=-1)
    assert there.sum() > 0.5 * SIZE**2
    apart = angles(found[there], exact[there])
    # Cycles turns shading normals round where the polygon's smooth normal faces away from it.
    turned = apart > 179
    assert turned.mean() < 0.02
    assert np.median(apart) < 0.02
    assert np.percentile(apart[~turned], 99) < 0.1


def test_modifiers_that_renders_alone_show_are_named(capfd):
    ob = suzanne(smooth=True)
    ob.modifiers.new("Bent", "SIMPLE_DEFORM").show_viewport = False
    ob.modifiers.move(1, 0)
    for target, is_told in (("VIEWPORT", False), ("RENDER", True)):
        bpy.ops.object.limit_bake_maps(width=SIZE, height=SIZE, target=target, overlap="ALLOW")
        said = capfd.readouterr().out
        assert ("of Suzanne in both, or in neither: Bent" in said) == is_told


def flat_map(ob: bpy.types.Object) -> float:
    """Returns the median error of shading without the map."""
    bpy.ops.object.limit_bake_maps(maps={"NORMAL_OBJECT"}, width=SIZE, height=SIZE, overlap="ALLOW")
    ob.modifiers.clear()
    plain = image_pixels.new("plain", SIZE, SIZE, is_float=True, is_data=True)
    plain.pixels.foreach_set(np.tile(np.float32([0, 0, 1, 1]), SIZE**2))
    exact = image_pixels.read(bpy.data.images[f"{ob.name} Normal"])[..., :3]
    found = shaded(ob, plain)
    there = found.any(axis=-1) & exact.any(axis=-1)
    return float(np.median(angles(found[there], exact[there])))


def test_without_the_map_shading_is_another():
    assert flat_map(suzanne(smooth=True)) > 2


def replaced(size: int) -> np.ndarray:
    """Moves the corners of a subdivided mesh to where a position map of so many texels places their
    UVs, and returns their distance from the limit surface.
    """
    ob = suzanne(smooth=True)
    ob.modifiers[0].levels = 2
    bpy.ops.object.limit_bake_maps(maps={"POSITION"}, width=size, height=size, overlap="ALLOW")
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = cage.read(ob, depsgraph)
    shown = ob.evaluated_get(depsgraph).data
    uv = attributes.read(shown, shown.uv_layers.active.name)
    values = image_pixels.read(bpy.data.images["Suzanne Position"])[..., :3]
    place = uv * size - 0.5
    low = np.floor(place).astype(int).clip(0, size - 2)
    (x, y), (s, t) = low.T, (place - low).T[:, :, None]
    at = (1 - t) * ((1 - s) * values[y, x] + s * values[y, x + 1])
    at += t * ((1 - s) * values[y + 1, x] + s * values[y + 1, x + 1])
    places = subdivided_mesh.corner_locations(found.face_sizes, 2)
    limit = limitsurf.LimitSurface(found.mesh).evaluate(places.face, places.uv).position
    bpy.data.objects.remove(ob)
    bpy.data.images.remove(bpy.data.images["Suzanne Position"])
    return np.linalg.norm(at - limit, axis=1)


def test_a_position_map_gives_the_surface_back():
    coarse, fine = replaced(128), replaced(256)
    assert np.median(fine) < 2e-4
    assert np.median(coarse) > 2.5 * np.median(fine)
    assert np.percentile(fine, 99) < 0.01


def bent_sheet() -> tuple[limitsurf.LimitSurface, limitsurf.SurfaceData]:
    """Adds a sheet with a pole of five quads, and a map that is not a projection."""
    angle = 2 * np.pi * np.arange(5) / 5
    spokes = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    between = 1.3 * np.stack([np.cos(angle + 0.6), np.sin(angle + 0.6)], axis=1)
    plan = np.concatenate([[[0, 0]], spokes, between])
    height = 0.4 * plan[:, 0] ** 2 - 0.3 * plan[:, 0] * plan[:, 1]
    faces = np.array([[0, 1 + i, 6 + i, 1 + (i + 1) % 5] for i in range(5)])
    mesh = limitsurf.ControlMesh.from_faces(np.column_stack([plan, height]), faces)
    surface = limitsurf.LimitSurface(mesh)
    uv = plan @ [[-0.3, 0.1], [0.05, 0.35]] + 0.02 * np.sin(5 * plan) + 0.5
    return surface, surface.face_varying(uv, faces.ravel(), "none")


def tangents(surface, uv_map, levels):
    """Returns Blender's tangents of a mesh on the limit surface and the tangents of the limit
    surface, corner by corner.
    """
    fine = surface.tessellate(levels)
    mesh = bpy.data.meshes.new("fine")
    mesh.from_pydata(fine.positions, [], fine.faces, shade_flat=False)
    mesh.update()
    places = fine.corner_locations
    value = uv_map.evaluate(places.face, places.uv).value
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", value.astype(np.float32).ravel())
    normals = surface.frames(places.face, places.uv)[:, :, 2]
    mesh.normals_split_custom_set(normals)
    mesh.calc_tangents(uvmap="UVMap")
    assert np.array_equal(attributes.read(mesh, ids.CORNER_VERTEX), fine.faces.ravel())
    tangent, sign = np.empty(3 * len(mesh.loops), np.float32), np.empty(len(mesh.loops), np.float32)
    mesh.loops.foreach_get("tangent", tangent)
    mesh.loops.foreach_get("bitangent_sign", sign)
    return tangent.reshape(-1, 3), sign, surface.tangent_frames(uv_map, places.face, places.uv)


def test_tangents_of_fine_meshes_become_the_limits():
    surface, uv_map = bent_sheet()
    errors = []
    for levels in (2, 3, 4):
        tangent, sign, frames = tangents(surface, uv_map, levels)
        assert (np.linalg.det(frames) < 0).all()  # the map is mirrored
        assert (sign == -1).all()
        errors.append(np.linalg.norm(tangent - frames[:, :, 0], axis=1).mean())
    ratios = np.array(errors[:-1]) / errors[1:]
    assert (ratios > 2).all()
    assert errors[-1] < 3e-4  # Blender stores its own normals with 16 bits for each component
