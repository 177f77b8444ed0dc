# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that a falling rigid body moves, by the way in which they depend on it."""

from collections.abc import Callable

import bpy
import scenes

HEIGHT = 5.0


def falling(name: str = "Falling") -> bpy.types.Object:
    """Adds a rigid body that begins to fall in frame 1."""
    bpy.ops.mesh.primitive_cube_add(location=(0, 0, HEIGHT))
    body = bpy.context.active_object
    body.name = name
    assert bpy.ops.rigidbody.object_add() == {"FINISHED"}
    body.select_set(False)
    return body


def itself(ob: bpy.types.Object) -> None:
    ob.location.z = HEIGHT
    scenes.activate(ob)
    assert bpy.ops.rigidbody.object_add() == {"FINISHED"}


def child(ob: bpy.types.Object) -> None:
    ob.parent = falling()


def hooked(ob: bpy.types.Object) -> None:
    hook_to(ob, falling())


def hooked_to_child(ob: bpy.types.Object) -> None:
    """A hidden empty is between the surface and the body."""
    empty = bpy.data.objects.new("Handle", None)
    bpy.context.collection.objects.link(empty)
    empty.parent = falling()
    empty.hide_viewport = True
    hook_to(ob, empty)


def sheared_child(ob: bpy.types.Object) -> None:
    body = falling()
    body.scale = (1, 3, 0.5)
    body.rotation_euler = (0.3, 0.2, 0.1)
    ob.parent = body
    ob.rotation_euler = (0.5, 0.4, 0.3)


def hook_to(ob: bpy.types.Object, target: bpy.types.Object) -> None:
    """Hooks a part of the mesh, before all modifiers that there are."""
    hook = ob.modifiers.new("Hook", "HOOK")
    hook.object = target
    hook.vertex_indices_set(range(6))
    ob.modifiers.move(len(ob.modifiers) - 1, 0)


RELATIONS: dict[str, Callable[[bpy.types.Object], None]] = {
    "itself": itself,
    "child": child,
    "sheared child": sheared_child,
    "hooked": hooked,
    "hooked to a child": hooked_to_child,
}


def play(last: int = 20) -> None:
    for frame in range(1, last + 1):
        bpy.context.scene.frame_set(frame)
