# SPDX-License-Identifier: GPL-3.0-or-later
"""New hair particle systems, whose particles stand on given places of the mesh.

Blender's own conversion of curves makes the system, as if somebody had combed it: such a system
keeps its keys over evaluation, saving and loading. It gives each particle the polygon of the
control mesh that is nearest to the strand's root, so it gets strands that begin there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from . import system, thickness

_LEAST_STEPS, _MOST_STEPS = 3, 10  # powers of 2
_LEAST_SEGMENTS = 2  # of Blender's property


@dataclass(frozen=True)
class Particles:
    """What a system is made of, in the surface's own space."""

    name: str
    place: np.ndarray  # (n, 3) on the control mesh
    strands: np.ndarray  # (n, keys, 3)
    radius: tuple[float, float]  # at the root and at the tip, in the world
    slot: int  # the surface's material slot, counted from 1


def add(context: bpy.types.Context, surface: bpy.types.Object, made: Particles) -> str:
    """Adds a system with as many keys, which do not lie on the strands yet, and returns its
    name. Raises RefusalError where Blender makes none; nothing has changed then.
    """
    before = set(surface.modifiers.keys())
    try:
        _convert(context, surface, made)
        new = [modifier for modifier in surface.modifiers if modifier.name not in before]
        if not new:
            raise RefusalError(f"Blender cannot make a particle system on {surface.name}")
        try:
            return _set_up(context, surface, new[0], made)
        except BaseException:
            system.remove(surface, new[0].particle_system.name)
            raise
    finally:
        context.view_layer.update()


def _convert(context: bpy.types.Context, surface: bpy.types.Object, made: Particles) -> None:
    count, keys = made.strands.shape[:2]
    curves = bpy.data.hair_curves.new(ids.TEMPORARY_HAIR)
    ob = bpy.data.objects.new(ids.TEMPORARY_HAIR, curves)
    try:
        curves.add_curves([keys] * count)
        moved = made.strands + (made.place - made.strands[:, 0])[:, None]
        curves.points.foreach_set("position", moved.astype(np.float32).ravel())
        curves.surface = surface
        ob.matrix_world = surface.matrix_world
        chosen = {"object": ob, "active_object": ob}
        with context.temp_override(**chosen, selected_objects=[ob], selected_editable_objects=[ob]):
            bpy.ops.curves.convert_to_particle_system()
    finally:
        bpy.data.hair_curves.remove(curves)


def _set_up(
    context: bpy.types.Context,
    surface: bpy.types.Object,
    modifier: bpy.types.ParticleSystemModifier,
    made: Particles,
) -> str:
    """Gives a new system its names and settings. Returns its name."""
    found = modifier.particle_system
    if len(found.particles) != len(made.strands):
        raise RefusalError(f"Blender cannot make a particle system on {surface.name}")
    found.name = modifier.name = found.settings.name = made.name
    count, keys = made.strands.shape[:2]
    settings = found.settings
    settings.count = count
    settings.hair_step = max(keys - 1, _LEAST_SEGMENTS)
    lengths = np.linalg.norm(np.diff(made.strands, axis=1), axis=2).sum(axis=1)
    settings.hair_length = float(lengths.mean())
    steps = math.ceil(math.log2(keys - 1))
    settings.display_step = settings.render_step = min(max(steps, _LEAST_STEPS), _MOST_STEPS)
    settings.render_type, settings.material = "PATH", made.slot
    thickness.set_profile(settings, *made.radius)
    context.view_layer.update()
    system.Shown.of(context, surface, found.name)  # refuses one that is not evaluated
    return found.name
