# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangent-space normal maps of meshes with sharp edges, flat polygons and custom normals, as Cycles
shades them.
"""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from limit_surface import ids
from limit_surface.images import image_pixels
from limit_surface.placing import new_objects
from limit_surface.reading import attributes
from shaded_maps import angles, shaded, with_subsurf

SIZE = 256  # Cycles bakes 0.002 texels beside their centres, where the frames are others

Change = Callable[[bpy.types.Mesh, np.random.Generator], None]


def smooth(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    """Leaves the mesh as it is."""


def sharp_by_angle(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    mesh.set_sharp_from_angle(angle=np.radians(30))


def sharp_anywhere(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    """Makes half of the edges sharp, so that some sharp lines end inside the mesh."""
    set_sharp(mesh, chance.random(len(mesh.edges)) < 0.5)


def sharp_everywhere(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    set_sharp(mesh, np.ones(len(mesh.edges), bool))


def partly_flat(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    mesh.polygons.foreach_set("use_smooth", chance.random(len(mesh.polygons)) < 0.6)
    mesh.update()


def partly_flat_and_sharp(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    partly_flat(mesh, chance)
    set_sharp(mesh, chance.random(len(mesh.edges)) < 0.2)


def custom(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    mesh.normals_split_custom_set(other_normals(mesh, chance))


def custom_and_partly_flat(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    partly_flat(mesh, chance)
    custom(mesh, chance)


def custom_without_sharp_edges(mesh: bpy.types.Mesh, chance: np.random.Generator) -> None:
    """Stores normals as vectors where this Blender can. No edge is marked sharp then."""
    new_objects.set_corner_normals(mesh, other_normals(mesh, chance))


def set_sharp(mesh: bpy.types.Mesh, which: np.ndarray) -> None:
    attributes.write(mesh, ids.SHARP_EDGE, "BOOLEAN", "EDGE", which)
    mesh.update()


def other_normals(mesh: bpy.types.Mesh, chance: np.random.Generator) -> np.ndarray:
    """Returns normals that differ at each corner."""
    normals = np.empty(3 * len(mesh.loops), np.float32)
    mesh.corner_normals.foreach_get("vector", normals)
    normals = normals.reshape(-1, 3) + 0.2 * chance.standard_normal((len(mesh.loops), 3))
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def suzanne(change: Change) -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    ob = bpy.context.active_object
    ob.data.shade_smooth()
    change(ob.data, np.random.default_rng(1))
    return with_subsurf(ob)


def apart(ob: bpy.types.Object, target: str) -> np.ndarray:
    """Returns the angles in degrees, texel by texel, between the limit surface's normals and those
    that Cycles shades on the target with its map.
    """
    bpy.ops.object.limit_bake_maps(
        maps={"NORMAL_TANGENT", "NORMAL_OBJECT"},
        width=SIZE, height=SIZE, target=target, overlap="ALLOW",
    )  # fmt: skip
    if target == "CAGE":
        ob.modifiers.clear()
    else:
        ob.modifiers[0].render_levels = ob.modifiers[0].levels  # bakes use the render's levels
    exact = image_pixels.read(bpy.data.images[f"{ob.name} Normal"])[..., :3]
    found = shaded(ob, bpy.data.images[f"{ob.name} Tangent Normal"])
    there = found.any(axis=-1) & exact.any(axis=-1)
    assert there.sum() > 0.5 * SIZE**2
    return angles(found[there], exact[there])


@pytest.mark.parametrize("target", ["CAGE", "VIEWPORT"])
@pytest.mark.parametrize(
    "change",
    [
        smooth,
        sharp_by_angle,
        sharp_anywhere,
        sharp_everywhere,
        partly_flat,
        partly_flat_and_sharp,
        custom,
        custom_and_partly_flat,
        custom_without_sharp_edges,
    ],
)
def test_as_cycles_shades(change, target):
    found = apart(suzanne(change), target)
    # Cycles turns shading normals round where the interpolated normal faces away from the polygon.
    turned = found > 179
    assert turned.mean() < 0.01
    assert np.median(found) < 0.01
    assert np.percentile(found[~turned], 99) < 0.05


@pytest.mark.parametrize("change", [sharp_anywhere, partly_flat, custom])
def test_a_map_for_another_shading_is_seen(change):
    """Shades one mesh by the map of another one, whose polygons differ in their shading alone."""
    other = suzanne(change)
    bpy.ops.object.limit_bake_maps(
        maps={"NORMAL_TANGENT", "NORMAL_OBJECT"}, width=SIZE, height=SIZE, overlap="ALLOW"
    )
    exact = image_pixels.read(bpy.data.images["Suzanne Normal"])[..., :3]
    wrong = bpy.data.images["Suzanne Tangent Normal"]
    bpy.data.objects.remove(other)
    ob = suzanne(smooth)
    ob.modifiers.clear()
    found = shaded(ob, wrong)
    there = found.any(axis=-1) & exact.any(axis=-1)
    assert np.percentile(angles(found[there], exact[there]), 90) > 1


def test_the_mesh_is_left_as_it_was():
    ob = suzanne(partly_flat_and_sharp)
    names, meshes = set(ob.data.attributes.keys()), set(bpy.data.meshes)
    vertices = len(ob.data.vertices)
    bpy.ops.object.limit_bake_maps(maps={"NORMAL_TANGENT"}, width=64, height=64, overlap="ALLOW")
    assert set(bpy.data.meshes) == meshes
    assert (set(ob.data.attributes.keys()), len(ob.data.vertices)) == (names, vertices)
