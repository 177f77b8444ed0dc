# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair particle systems as Blender evaluates them: their keys, in the surface's own space.

Blender stores keys relative to the polygon of the displayed mesh on which their particle stands.
"""

from __future__ import annotations

import time
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ..errors import RefusalError
from ..tasks.object_keys import ObjectKey

_PIECE = 256  # particles between two looks at the clock
_LEAST_TIME = 0.1  # seconds between two reports of progress
# Each report costs an evaluation of all particles. This is the ratio of the time between reports to
# the time of an evaluation.
_WORK_RATIO = 4

#: The number of particles whose keys are looked at once they are written, and how far they may be
#: from their strands, as a share of the largest coordinate. Blender computes in single precision.
_CHECKED = 1000
_TOLERANCE = 1e-4


@dataclass(frozen=True)
class Shown:
    """A particle system and what Blender has evaluated of it, as long as nothing is evaluated
    anew.
    """

    original: bpy.types.ParticleSystem
    ob: bpy.types.Object
    system: bpy.types.ParticleSystem
    modifier: bpy.types.ParticleSystemModifier

    @classmethod
    def of(cls, context: bpy.types.Context, surface: bpy.types.Object, name: str) -> Shown:
        """Raises RefusalError for a system that is not evaluated, or does not exist any more."""
        original = surface.particle_systems.get(name)
        if original is None:
            raise RefusalError(f"{surface.name} has no particle system {name!r}")
        ob = surface.evaluated_get(context.evaluated_depsgraph_get())
        system = ob.particle_systems.get(name)
        modifier = _modifier(ob, name)
        if system is None or modifier is None or not modifier.show_viewport:
            raise RefusalError(
                f"Blender does not evaluate the particle system {name}: make sure that "
                f"{surface.name} and its particles are shown in the viewport"
            )
        return cls(original, ob, system, modifier)


def _modifier(ob: bpy.types.Object, name: str) -> bpy.types.ParticleSystemModifier | None:
    """Returns the modifier of a particle system."""
    for modifier in ob.modifiers:
        if modifier.type == "PARTICLE_SYSTEM" and modifier.particle_system.name == name:
            return modifier
    return None


def check_shown(surface: bpy.types.Object, context: bpy.types.Context) -> None:
    """Raises RefusalError for a surface whose particles Blender does not evaluate."""
    if surface.name not in context.view_layer.objects:
        raise RefusalError(f"{surface.name} is not in the view layer {context.view_layer.name}")
    if surface.mode == "EDIT":
        raise RefusalError(f"{surface.name} is in Edit Mode: leave it first")
    if not surface.visible_get():
        raise RefusalError(
            f"{surface.name} is hidden, so that Blender does not evaluate its particles: show it "
            "first"
        )


def remove(surface: bpy.types.Object, name: str) -> None:
    """Removes a particle system and its settings."""
    modifier = _modifier(surface, name)
    if modifier is not None:
        settings = modifier.particle_system.settings
        surface.modifiers.remove(modifier)
        if not settings.users:
            bpy.data.particles.remove(settings)


def write_keys(
    context: bpy.types.Context, surface: ObjectKey, name: str, strands: np.ndarray
) -> Generator[float, None, None]:
    """Moves the keys to strands (n, keys, 3). Yields the part that is done."""
    count, frame, done = len(strands), context.scene.frame_current, 0
    while done < count:
        if context.scene.frame_current != frame:
            raise RefusalError("The frame was changed while the keys were written")
        begin = time.monotonic()
        shown = Shown.of(context, surface.find(), name)
        if len(shown.original.particles) != count or len(shown.system.particles) != count:
            raise RefusalError(
                f"The particle system {name} was changed meanwhile: run the operator again"
            )
        evaluated = time.monotonic()
        deadline = evaluated + max(_LEAST_TIME, _WORK_RATIO * (evaluated - begin))
        while True:
            piece = strands[done : done + _PIECE].tolist()
            for i, points in enumerate(piece, done):
                place = shown.system.particles[i]
                for key, point in zip(shown.original.particles[i].hair_keys, points, strict=True):
                    key.co_object_set(shown.ob, shown.modifier, place, point)
            done += len(piece)
            if done == count or time.monotonic() >= deadline:
                break
        yield done / count
    surface.find().update_tag(refresh={"DATA"})


def check_keys(
    context: bpy.types.Context, surface: ObjectKey, name: str, strands: np.ndarray
) -> None:
    """Raises RefusalError if keys are not on their strands, of which it looks at some. Blender then
    cannot tell on which polygon of the displayed mesh a particle stands.
    """
    shown = Shown.of(context, surface.find(), name)
    rows = np.unique(np.linspace(0, len(strands) - 1, _CHECKED).astype(int))
    found = [
        key.co_object(shown.ob, shown.modifier, shown.system.particles[i])
        for i in rows.tolist()
        for key in shown.system.particles[i].hair_keys
    ]
    error = np.abs(np.reshape(found, strands[rows].shape) - strands[rows]).max()
    if not error <= _TOLERANCE * np.abs(strands).max():
        raise RefusalError(
            f"Blender cannot hold particles on the polygons that the modifiers of {shown.ob.name} "
            f"make: keys would be up to {error:.3g} away from the strands. Apply or disable "
            "modifiers that make new geometry"
        )


@dataclass(frozen=True)
class Keys:
    """The keys of particles, one particle after the other."""

    sizes: np.ndarray  # (n,) numbers of keys, at least 2
    position: np.ndarray  # (keys of all particles, 3) in the surface's own space
    time: np.ndarray  # (keys of all particles,) from 0 at the root to 1 at the tip

    @property
    def offsets(self) -> np.ndarray:
        return np.concatenate([[0], np.cumsum(self.sizes)])


def read_keys(
    context: bpy.types.Context, surface: ObjectKey, name: str
) -> Generator[float, None, Keys]:
    """Reads the keys of all particles that exist and have 2 keys or more, and returns them. Yields
    the part that is done.
    """
    sizes: list[int] = []
    position: list[float] = []
    begin, count = 0, 1
    while begin < count:
        shown = Shown.of(context, surface.find(), name)
        count = len(shown.system.particles)
        for i in range(begin, min(begin + _PIECE, count)):
            particle = shown.system.particles[i]
            keys = particle.hair_keys
            if len(keys) < 2 or not particle.is_exist:
                continue
            sizes.append(len(keys))
            for key in keys:
                position.extend(key.co_object(shown.ob, shown.modifier, particle))
        begin += _PIECE
        yield min(begin, count) / max(count, 1)
    found = np.array(sizes, np.int32)
    steps = [np.linspace(0, 1, size) for size in sizes]
    times = np.concatenate(steps) if steps else np.empty(0)
    return Keys(found, np.array(position, np.float64).reshape(-1, 3), times)


@contextmanager
def all_shown(settings: bpy.types.ParticleSettings) -> Iterator[None]:
    """Has Blender grow all hair: it makes none for the particles that the viewport leaves out."""
    was = settings.display_percentage
    if was < 100:
        settings.display_percentage = 100
    try:
        yield
    finally:
        if was < 100:
            settings.display_percentage = was
