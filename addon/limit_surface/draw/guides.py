# SPDX-License-Identifier: GPL-3.0-or-later
"""Guide strands along strokes: hair curves whose roots are bound to the surface."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from .. import ids
from ..placing import following
from ..placing.binding import Binding
from ..placing.new_objects import add_on_surface
from ..placing.roots import Locations
from ..placing.rotations import WorldSpace
from ..reading import attributes
from .ground import Ground
from .stroke import Stroke


def add_new(
    context: bpy.types.Context,
    ground: Ground,
    strokes: Sequence[Stroke],
    points: int,
    offset: float,
    radius: float,
    follow: str,
) -> bpy.types.Object:
    """Adds a strand for each stroke, rooted where the stroke begins, whose points lie on the
    surface at equal distances along the stroke. They rise to the offset at the tip.
    """
    paths = [ground.surface.even_path(stroke.face, stroke.uv, points) for stroke in strokes]
    face = np.concatenate([path.face for path in paths]).astype(np.int32)
    uv = np.concatenate([path.uv for path in paths]).astype(np.float32)
    space = WorldSpace(ground.matrix)
    places = ground.posed.places(face, uv.astype(np.float64), ground.matrix)
    rise = np.tile(np.linspace(0, offset, points), len(paths))
    lift = space.to_local(rise[:, None] * space.frames(places.frame)[:, :, 2])
    position = (places.position + lift).astype(np.float32)
    roots = Locations(face[::points], uv[::points])
    binding = Binding.at(ground.posed, roots, ground.matrix)
    request = following.request_for(follow, ground.ob, context.evaluated_depsgraph_get())
    bindings = request.compute(roots) if request else None
    data = bpy.data.hair_curves.new(ids.GUIDES_OBJECT)
    try:
        data.add_curves([points] * len(paths))
        data.points.foreach_set("position", position.ravel())
        share = np.concatenate([_radius(stroke, points) for stroke in strokes])
        attributes.write(data, "radius", "FLOAT", "POINT", share * (radius / space.mean_scale))
        binding.write(data, "CURVE")
        data.surface = ground.ob
        _write_surface_uv(data, ground, roots)
        ob = add_on_surface(context, ids.GUIDES_OBJECT, data, ground.ob)
    except BaseException:
        bpy.data.hair_curves.remove(data)
        raise
    if bindings:
        bindings.write(ob)
    context.view_layer.update()
    return ob


def _radius(stroke: Stroke, points: int) -> np.ndarray:
    length = np.linalg.norm(np.diff(stroke.position, axis=0), axis=1)
    along = np.concatenate([[0], np.cumsum(length)])
    return np.interp(np.linspace(0, along[-1], points), along, stroke.radius)


def _write_surface_uv(data: bpy.types.ID, ground: Ground, roots: Locations) -> None:
    """Stores Blender's own coordinates of the roots, where the mesh has a UV map."""
    found = ground.posed.cage.uv_map
    if found is None:
        return
    shown = ground.posed.in_object.face_varying(
        found.values, found.indices, ground.posed.cage.shown_uv_interpolation
    )
    values = shown.evaluate(roots.face, roots.uv.astype(np.float64)).value
    data.surface_uv_map = found.name
    attributes.write(data, ids.SURFACE_UV, "FLOAT2", "CURVE", values)
