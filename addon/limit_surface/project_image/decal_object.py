# SPDX-License-Identifier: GPL-3.0-or-later
"""A decal as an object of Blender."""

import bpy
import numpy as np

from .. import ids
from ..placing import new_objects, roots
from ..placing.binding import Binding
from ..reading import attributes, ragged_rows
from ..tasks.job import Progress
from .decal import Decal
from .world import WorldSurface


class PlacedDecal:
    """Arrays of a mesh in the space of the surface's object."""

    def __init__(
        self, world: WorldSurface, decal: Decal, offset: float, progress: Progress
    ) -> None:
        """Places the vertices. `offset` is a distance along the normals, in world units."""
        hits = decal.hits
        self.st, self.sizes, self.vertices = hits.st, decal.sizes, decal.vertices
        self.locations = locations = roots.Locations(
            hits.face.astype(np.int32), hits.uv.astype(np.float32)
        )
        self.binding = Binding(locations)
        self.position, self.normal = (np.empty((len(hits), 3)) for _ in range(2))

        for part in roots.evaluate(roots.on_surface(world.local), locations, progress):
            self.binding.fill(part)
            side = hits.facing[part.rows][:, None]
            outward = side * world.axes.frames(part.frame)[:, :, 2]
            self.position[part.rows] = part.position + offset * world.axes.to_local(outward)
            self.normal[part.rows] = side * part.frame[:, :, 2]
        # Corners run counter-clockwise in the image. From outside that is clockwise where either
        # the surface or the projector is mirrored.
        self.is_turned = self._faces_inwards()

    def _faces_inwards(self) -> bool:
        """Tells whether the polygons face against the normals."""
        corners = self.position[self.vertices]
        first = np.repeat(ragged_rows.starts(self.sizes), self.sizes)
        fans = corners - corners[first]
        areas = np.cross(fans, fans[ragged_rows.following(self.sizes)])
        return bool(np.nansum(areas * self.normal[self.vertices]) < 0)


def add(
    context: bpy.types.Context, name: str, placed: PlacedDecal, surface: bpy.types.Object
) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(name)
    try:
        _fill(mesh, placed)
        ob = new_objects.add_on_surface(context, name, mesh, surface)
    except BaseException:
        bpy.data.meshes.remove(mesh)
        raise
    context.view_layer.update()
    return ob


def _fill(mesh: bpy.types.Mesh, placed: PlacedDecal) -> None:
    sizes, vertices = placed.sizes, placed.vertices
    if placed.is_turned:
        sizes, vertices = sizes[::-1], vertices[::-1]
    new_objects.add_polygons(mesh, placed.position, sizes, vertices)
    layer = mesh.uv_layers.new(name=ids.DECAL_UV)
    attributes.write(mesh, layer.name, "FLOAT2", "CORNER", placed.st[vertices])
    placed.binding.write(mesh, "POINT")
    new_objects.set_corner_normals(mesh, placed.normal.astype(np.float32)[vertices])
