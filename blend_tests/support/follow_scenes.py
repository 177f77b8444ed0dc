# SPDX-License-Identifier: GPL-3.0-or-later
"""Deforming surfaces with things that follow them, and where these have to be."""

import bpy
import follow_truth
import numpy as np
import scenes
from limit_surface.follow import stale
from limit_surface.placing.follow_state import State
from mathutils import Euler, Matrix

FRAMES = ((1, 0.0), (13, 0.5), (30, 0.0))


def deforming(scene: str, mirrored: bool = False) -> bpy.types.Object:
    ob = scenes.SCENES[scene]()
    follow_truth.animate(ob)
    scenes.add_subsurf(ob)
    turned = Matrix.Translation((0.3, -0.2, 0.5)) @ Euler((0.3, 0.5, -0.7)).to_matrix().to_4x4()
    ob.matrix_world = turned @ Matrix.Diagonal((-1.2 if mirrored else 1.2, 1.2, 0.8, 1))
    return ob


def follow(*things: bpy.types.Object) -> None:
    for thing in things:
        scenes.activate(thing)
        assert bpy.ops.object.limit_follow(mode="NODES") == {"FINISHED"}


def check_hair(ob: bpy.types.Object, hair: bpy.types.Object) -> None:
    now = follow_truth.on_surface(ob, hair.data, follow_truth.relation(ob, hair))
    expected = follow_truth.moved(scenes.strands(hair), hair.data, now)
    error = np.abs(follow_truth.shown_strands(hair) - expected).max()
    assert error < follow_truth.POSITION_BOUND * follow_truth.diagonal(ob)


def look(ob: bpy.types.Object) -> list[tuple[str, str]]:
    """Returns the troubles that the panel shows once the timer has looked."""
    state = State.of(ob)
    assert state is not None
    stale.troubles(bpy.context, state)
    assert bpy.app.timers.is_registered(stale._look) or stale._signatures
    stale._look()
    return [(trouble.text, trouble.remedy) for trouble in stale.troubles(bpy.context, state)]
