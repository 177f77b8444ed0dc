# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file contains, in a form that can be compared with what it contains later."""

import hashlib

import bpy
import numpy as np

#: The size and the type of what an attribute stores at each place, and the property's name
STORED = {
    "FLOAT": (1, np.float32, "value"),
    "INT": (1, np.int32, "value"),
    "INT8": (1, np.int32, "value"),
    "BOOLEAN": (1, bool, "value"),
    "FLOAT_VECTOR": (3, np.float32, "vector"),
    "FLOAT2": (2, np.float32, "vector"),
    "FLOAT_COLOR": (4, np.float32, "color"),
    "BYTE_COLOR": (4, np.float32, "color"),
    "QUATERNION": (4, np.float32, "value"),
}


def digest(saved_only: bool = False) -> dict[str, object]:
    """Returns what objects, meshes, hair, points and images contain, by their names. With
    `saved_only`, only what the file itself saves: nothing that is linked or that nobody uses, and
    no pixels. What is linked and that nobody uses is left out always: undo may drop it.
    """
    found: dict[str, object] = {}
    for ob in _of("objects", saved_only):
        found[f"object {ob.name_full}"] = (
            ob.type,
            ob.data.name_full if ob.data else "",
            ob.parent.name_full if ob.parent else "",
            tuple(map(tuple, ob.matrix_basis)),
            tuple((modifier.name, modifier.type) for modifier in ob.modifiers),
            tuple(constraint.type for constraint in ob.constraints),
            tuple(group.name for group in ob.vertex_groups),
            len(ob.particle_systems),
        )
    for kind in ("meshes", "hair_curves", "pointclouds"):
        for data in _of(kind, saved_only):
            found[f"{kind} {data.name_full}"] = tuple(
                (name, *stored(data.attributes[name])) for name in sorted(data.attributes.keys())
            )
    for kind in ("materials", "node_groups", "particles", "curves"):
        for data in _of(kind, saved_only):
            found[f"{kind} {data.name_full}"] = True
    for image in [] if saved_only else bpy.data.images:
        found[f"image {image.name_full}"] = (*image.size, pixels(image))
    return found


def _of(kind: str, saved_only: bool) -> list[bpy.types.ID]:
    blocks = [
        each for each in getattr(bpy.data, kind, ()) if each.library is None or _is_used(each)
    ]
    return [each for each in blocks if not saved_only or (each.users and each.library is None)]


def _is_used(linked: bpy.types.ID) -> bool:
    if isinstance(linked, bpy.types.Object) or not linked.users:
        return bool(linked.users)
    users = [ob for ob in bpy.data.objects if ob.data == linked]
    return not users or any(ob.users for ob in users)


def stored(attribute: bpy.types.Attribute) -> tuple[str, str, str]:
    if attribute.data_type not in STORED:
        return attribute.domain, attribute.data_type, str(len(attribute.data))
    size, dtype, name = STORED[attribute.data_type]
    values = np.zeros(size * len(attribute.data), dtype)
    attribute.data.foreach_get(name, values)
    return attribute.domain, attribute.data_type, hashed(values)


def pixels(image: bpy.types.Image) -> str:
    values = np.zeros(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return hashed(values)


def hashed(values: np.ndarray) -> str:
    return hashlib.sha256(values.tobytes()).hexdigest()[:16]
