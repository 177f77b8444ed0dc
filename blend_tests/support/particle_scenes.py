# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair particle systems for tests, and the strands that Blender draws for them."""

import bpy
import numpy as np
import scenes

KEYS = 9  # with 8 drawn segments, every key is drawn


def add_hair(ob: bpy.types.Object, **properties: object) -> bpy.types.Object:
    """Adds hair with as many points as there are keys drawn."""
    shape = {"points": KEYS, "tilt": (0.5, 0.2), "length": 0.4}
    return scenes.add_hair(ob, **shape | properties)


def bend(hair: bpy.types.Object) -> None:
    """Bends the strands differently, as combing does."""
    strands = scenes.strands(hair)
    along = np.linspace(0, 1, strands.shape[1])[None, :, None]
    amount = np.random.default_rng(4).normal(size=(len(strands), 1, 3))
    strands = strands + 0.1 * along**2 * amount
    hair.data.points.foreach_set("position", strands.astype(np.float32).ravel())
    hair.data.update_tag()


def add_system(ob: bpy.types.Object, name: str = "Fur", count: int = 100) -> None:
    """Adds hair that Blender grows."""
    ob.modifiers.new(name, "PARTICLE_SYSTEM")
    settings = ob.particle_systems[-1].settings
    settings.type = "HAIR"
    settings.count, settings.hair_step = count, KEYS - 1
    settings.hair_length, settings.brownian_factor = 0.3, 0.1
    settings.render_type = "PATH"
    settings.display_step = 3
    bpy.context.view_layer.update()


def drawn(ob: bpy.types.Object, number: int = 0) -> np.ndarray:
    """Returns the drawn strands (n, KEYS, 3) in the world."""
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get()).particle_systems[number]
    assert 2**shown.settings.display_step == KEYS - 1
    rows = range(len(shown.particles))
    return np.array([[shown.co_hair(ob, particle_no=i, step=j) for j in range(KEYS)] for i in rows])


def in_world(hair: bpy.types.Object) -> np.ndarray:
    """Returns the strands of hair as they are stored."""
    return scenes.transformed(hair.matrix_world, scenes.strands(hair).astype(np.float64))


def bound(*points: np.ndarray) -> float:
    """Returns how far points of this size may be moved by single precision."""
    return 1e-6 * max(np.abs(p).max() for p in points)


def add_shape_key(ob: bpy.types.Object) -> bpy.types.ShapeKey:
    """Adds a shape key that bends the mesh, with the value 0."""
    for name in ("Basis", "Bent"):
        key = ob.shape_key_add(name=name)
    for point in key.data:
        point.co.z += 0.5 * point.co.x**2
    key.value = 0
    return key
