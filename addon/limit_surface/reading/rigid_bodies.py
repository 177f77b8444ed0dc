# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies, which a private scene cannot simulate: all scenes share the state of a body, so a
second simulation would destroy the user's. There the bodies are where they would be without one.
"""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np

from ..errors import NotNowError

_NEAR = 1e-5  # by how much two matrices may differ, as a share of their largest value


def are_simulated(scene: bpy.types.Scene) -> bool:
    return next(_bodies(scene), None) is not None


def moved(
    alone: bpy.types.Depsgraph,
    shown: bpy.types.Depsgraph,
    copy: bpy.types.Object,
    ob: bpy.types.Object,
) -> list[bpy.types.Object]:
    """Returns the bodies that are not where the user's depsgraph shows them, although a private
    one has evaluated them. There the copy stands for the object.
    """
    return [
        body
        for body in _bodies(shown.scene)
        if body == ob or body.evaluated_get(alone).is_evaluated  # most are not
        for here in _evaluated(body, alone, copy, ob)
        if here.matrix_world != body.evaluated_get(shown).matrix_world
    ]


def moving(
    alone: bpy.types.Depsgraph, shown: bpy.types.Depsgraph, ob: bpy.types.Object
) -> list[bpy.types.Object]:
    """Returns the bodies other than the object that a simulation may move in another frame, and
    that a private depsgraph has evaluated.
    """
    return [
        body
        for body in _bodies(shown.scene)
        if body != ob
        and body.evaluated_get(alone).is_evaluated
        and (settings := body.rigid_body)
        and settings.type == "ACTIVE"
        and not settings.kinematic
    ]


def move_alike(
    bodies: list[bpy.types.Object],
    alone: bpy.types.Depsgraph,
    shown: bpy.types.Depsgraph,
    copy: bpy.types.Object,
    ob: bpy.types.Object,
) -> bool:
    """Tells whether all bodies are where they are shown, as seen from the object. Then its shape is
    the same as without a simulation.
    """
    there = _matrix(ob, shown)
    here = _matrix(copy, alone)
    if not (np.linalg.det(there) and np.linalg.det(here)):
        return False
    for body in bodies:
        for evaluated in _evaluated(body, alone, copy, ob):
            seen = np.linalg.solve(here, np.array(evaluated.matrix_world, np.float64))
            wanted = np.linalg.solve(there, _matrix(body, shown))
            if not np.allclose(seen, wanted, rtol=0, atol=_NEAR * max(1, np.abs(wanted).max())):
                return False
    return True


def refusal(
    ob: bpy.types.Object, bodies: list[bpy.types.Object], why: str, remedy: str
) -> NotNowError:
    names = ", ".join(dict.fromkeys(body.name for body in bodies))
    return NotNowError(
        f"{ob.name} depends on rigid bodies that a simulation moves ({names}), and {why}: "
        f"{remedy}, or turn the simulation into keyframes (Object > Rigid Body > Bake to Keyframes)"
    )


def _bodies(scene: bpy.types.Scene) -> Iterator[bpy.types.Object]:
    world = scene.rigidbody_world
    if world and world.enabled and world.collection:
        yield from world.collection.all_objects


def _evaluated(
    body: bpy.types.Object,
    alone: bpy.types.Depsgraph,
    copy: bpy.types.Object,
    ob: bpy.types.Object,
) -> Iterator[bpy.types.Object]:
    for original in (copy, body) if body == ob else (body,):
        evaluated = original.evaluated_get(alone)
        if evaluated.is_evaluated:
            yield evaluated


def _matrix(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray:
    return np.array(ob.evaluated_get(depsgraph).matrix_world, np.float64)
