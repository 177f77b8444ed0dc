# SPDX-License-Identifier: GPL-3.0-or-later
"""What is stored with hair or points that follow live: their points now and at rest, and whether
somebody has changed them (`live_thing.py` says how these belong together).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from .. import ids
from ..reading import attributes, linked_attributes
from .places import NOWHERE, ROOT_KINDS, domain_of, lacking, root_attributes, without_frame

#: Attributes that hold points, of which the position is the first; vectors; and rotations
POINTS = (ids.POSITION, ids.HANDLE_LEFT, ids.HANDLE_RIGHT)
VECTORS = (ids.NORMAL, ids.TANGENT)
_CURVE_TYPES = ("CATMULL_ROM", "POLY", "BEZIER", "NURBS")  # by Blender's number


class Written(NamedTuple):
    """When and where the points were written."""

    frame: float
    matrix: np.ndarray  # (4, 4) from the surface's space to that of the thing


def rest_name(name: str) -> str:
    """Returns the name of the attribute that holds another one at rest."""
    return ids.LIVE_REST if name == ids.POSITION else f"{ids.LIVE_REST}_{name}"


def moved_names(data: bpy.types.ID) -> list[str]:
    """Returns the names of the attributes that follow the surface."""
    kinds = dict.fromkeys(POINTS, ("FLOAT_VECTOR", "POINT"))
    if not isinstance(data, bpy.types.Curves):
        kinds |= dict.fromkeys(VECTORS, ("FLOAT_VECTOR", "POINT"))
        kinds |= {ids.ROTATION: ("QUATERNION", "POINT")}
    if isinstance(data, bpy.types.Mesh):
        kinds |= {ids.CUSTOM_NORMAL: ("FLOAT_VECTOR", "CORNER")}
    stored = data.attributes
    return [
        name
        for name, kind in kinds.items()
        if name in stored and (stored[name].data_type, stored[name].domain) == kind
    ]


def points_of(data: bpy.types.ID) -> list[str]:
    """Returns the names of those attributes of points that are stored at rest, too."""
    there = data.attributes.keys()
    return [name for name in POINTS if name in there and rest_name(name) in there]


def stop(data: bpy.types.ID) -> None:
    """Puts the data's points where they are at rest. Edits must have been taken up before."""
    is_new = added(data)
    for name in moved_names(data):
        if rest_name(name) in data.attributes:
            values = attributes.read(data, rest_name(name))
            resting = rows_of(data, name, is_new)
            values[resting] = attributes.read(data, name)[resting]
            write(data, name, values)
    leave(data)


def added(data: bpy.types.ID) -> np.ndarray:
    """Tells which strands are new."""
    is_new: np.ndarray = attributes.read(data, ids.LIVE_FINGERPRINT) == 0
    return is_new


def lost_frames(data: bpy.types.ID) -> int:
    """Returns the number of strands that stay still because the file was made before version 0.2.0,
    and lacks their rest orientation.
    """
    if missing(data):
        return 0
    binding = {name: attributes.read(data, name) for name in ROOT_KINDS}
    return lost_frames_of(binding, added(data))


def lost_frames_of(binding: Mapping[str, np.ndarray], is_new: np.ndarray) -> int:
    has_none, has_face = without_frame(binding[ids.REST_ROTATION]), binding[ids.FACE] != NOWHERE
    return int((has_none & has_face & ~is_new).sum())


def begin_anew(data: bpy.types.ID, strands: np.ndarray) -> None:
    """Makes strands new ones that have got another place: they are at rest where they are now."""
    if not missing(data):
        prints = attributes.read(data, ids.LIVE_FINGERPRINT)
        prints[strands] = 0
        write(data, ids.LIVE_FINGERPRINT, prints)


def leave(data: bpy.types.ID) -> None:
    """Leaves the data's points where they are, and forgets those at rest."""
    followed = (*POINTS, *VECTORS, ids.ROTATION, ids.CUSTOM_NORMAL)
    for name in (ids.LIVE_FINGERPRINT, *(rest_name(name) for name in followed)):
        if name in data.attributes:
            data.attributes.remove(data.attributes[name])
    for name in (ids.LIVE_WRITTEN, ids.LIVE_SOURCE):
        if name in data:
            del data[name]
    tag(data)


def missing(data: bpy.types.ID) -> str:
    """Returns the name of an attribute without which the data cannot follow: it does not exist, or
    is of another type or domain. Returns nothing where all are there.
    """
    needed = {
        ids.LIVE_REST: ("FLOAT_VECTOR", "POINT"),
        ids.LIVE_FINGERPRINT: ("INT", domain_of(data)),
    }
    return lacking(data, needed | root_attributes(data))


def note_written(data: bpy.types.ID, frame: float, matrix: np.ndarray) -> None:
    """Stores when and where the points were written: as a text, because Blender prints a warning in
    each frame when it exports a property of so many numbers to USD.
    """
    now = " ".join(map(repr, [float(frame), *matrix.ravel().tolist()]))
    if data.get(ids.LIVE_WRITTEN) != now:
        data[ids.LIVE_WRITTEN] = now


def written(data: bpy.types.ID) -> Written | None:
    stored = data.get(ids.LIVE_WRITTEN)
    if stored is None:
        return None
    # files that were made before version 0.2.0 have numbers
    each = stored.split() if isinstance(stored, str) else stored
    try:
        numbers = np.array(each, np.float64)
    except (TypeError, ValueError):  # somebody has changed the property
        return None
    if numbers.shape != (17,):
        return None
    return Written(float(numbers[0]), numbers[1:].reshape(4, 4))


def rows_of(data: bpy.types.ID, name: str, strands: np.ndarray) -> np.ndarray:
    """Tells which elements of an attribute belong to these strands (a mask)."""
    if isinstance(data, bpy.types.Curves):
        return np.repeat(strands, np.diff(attributes.curve_offsets(data)))
    if data.attributes[name].domain == "CORNER":
        return strands[attributes.read(data, ids.CORNER_VERTEX)]
    return strands


def place_domain(data: bpy.types.ID) -> str:
    """Returns the domain on which the places are stored."""
    return data.attributes[ids.FACE].domain


def write(data: bpy.types.ID, name: str, values: np.ndarray) -> None:
    """Writes an attribute that is there, even of linked data."""
    if data.library or data.override_library:
        linked_attributes.write(data, name, values)
    elif isinstance(data, bpy.types.Mesh) and name == ids.POSITION:
        # unlike the attribute, it has Blender calculate the bounding box anew
        data.vertices.foreach_set("co", values.reshape(-1))
    else:
        attribute = data.attributes[name]
        attributes.write(data, name, attribute.data_type, attribute.domain, values)


def tag(data: bpy.types.ID) -> None:
    """Has Blender evaluate the data again, with its bounding box."""
    if isinstance(data, bpy.types.Mesh):
        if data.library or data.override_library:
            data.transform(Matrix())
        data.update()
    elif not isinstance(data, bpy.types.Curves) or not len(data.curves):
        pass
    elif not hasattr(data, "set_types"):  # before Blender 4.3
        data.add_curves([])
    else:
        stored = data.attributes.get(ids.CURVE_TYPE)
        data.set_types(type=_CURVE_TYPES[stored.data[0].value if stored else 0], indices=[0])
    data.update_tag()
