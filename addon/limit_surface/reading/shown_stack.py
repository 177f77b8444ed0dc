# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes after the first modifiers of their objects, as the user's own depsgraph evaluates them.

Everything on which the modifiers depend is then as it is shown, simulations included. But only an
object that the depsgraph has evaluated can be read, and only in its frame.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import bpy

from .. import ids
from . import copied_object

_MODES = ("show_viewport", "show_render")


@contextmanager
def standing(
    ob: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    first: int,
    runs: Mapping[str, bool],
) -> Iterator[bpy.types.Object]:
    """Yields a new object with the mesh after the first modifiers, with the other modifiers, and
    with the transform that is shown. It depends on nothing that moves. `runs` tells which of the
    first modifiers are enabled.
    """
    evaluated = ob.evaluated_get(depsgraph)
    mesh = _mesh_after(evaluated, depsgraph, runs)
    copy, stand = copied_object.of(ob), bpy.data.objects.new(ids.TEMPORARY_MESH, None)
    try:
        copy.animation_data_clear()
        copy.constraints.clear()
        for modifier in copy.modifiers[:first]:
            copy.modifiers.remove(modifier)
        copy.data = mesh
        _place(copy, stand, evaluated)
        yield copy
    finally:
        bpy.data.objects.remove(copy)
        bpy.data.objects.remove(stand)
        bpy.data.meshes.remove(mesh)


def _mesh_after(
    evaluated: bpy.types.Object, depsgraph: bpy.types.Depsgraph, runs: Mapping[str, bool]
) -> bpy.types.Mesh:
    """Runs modifiers of an evaluated object once more. Only the evaluated object is changed, by a
    call that does not tag it for an update.
    """
    modifiers = evaluated.modifiers
    wanted = [runs.get(modifier.name, False) for modifier in modifiers]
    was = {mode: [getattr(modifier, mode) for modifier in modifiers] for mode in _MODES}
    try:
        for mode in _MODES:
            modifiers.foreach_set(mode, wanted)
        return bpy.data.meshes.new_from_object(
            evaluated, preserve_all_data_layers=True, depsgraph=depsgraph
        )
    finally:
        for mode in _MODES:
            modifiers.foreach_set(mode, was[mode])


def _place(copy: bpy.types.Object, stand: bpy.types.Object, shown: bpy.types.Object) -> None:
    """Gives an object the matrix of another one. The inverse of a parent may be any matrix, while
    location, rotation and scale cannot shear.
    """
    copy.rotation_mode = "XYZ"
    copy.location = copy.rotation_euler = (0, 0, 0)
    copy.delta_location = copy.delta_rotation_euler = (0, 0, 0)
    copy.scale = copy.delta_scale = (1, 1, 1)
    copy.parent_type, copy.parent = "OBJECT", stand
    copy.matrix_parent_inverse = shown.matrix_world
