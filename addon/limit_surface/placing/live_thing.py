# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair or points that the extension itself moves with a surface.

`position` holds the points where they are now, which is what artists see and comb; `limit_rest`
holds them at rest, `limit_fingerprint` a number for each strand that tells whether somebody has
changed its points since they were written, and the custom property `limit_written` the frame and
the matrix of that moment. All of it belongs to the data: it survives saving, undo, deleted strands
and linking. What is shown in a frame depends on the shape at rest and on the frame alone.

Strands whose fingerprint is 0 are new: they were added or joined later, or have just got another
place. They stay where they are, whatever their other attributes say, until they are admitted.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from .. import ids
from ..reading import attributes, linked_attributes
from .places import NOWHERE, ROOT_KINDS, domain_of, lacking, root_attributes, without_frame

if TYPE_CHECKING:
    import limitsurf

#: Attributes that hold points, of which the position is the first; vectors; and rotations
_POINTS = (ids.POSITION, ids.HANDLE_LEFT, ids.HANDLE_RIGHT)
_VECTORS = (ids.NORMAL, ids.TANGENT)
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
    kinds = dict.fromkeys(_POINTS, ("FLOAT_VECTOR", "POINT"))
    if not isinstance(data, bpy.types.Curves):
        kinds |= dict.fromkeys(_VECTORS, ("FLOAT_VECTOR", "POINT"))
        kinds |= {ids.ROTATION: ("QUATERNION", "POINT")}
    if isinstance(data, bpy.types.Mesh):
        kinds |= {ids.CUSTOM_NORMAL: ("FLOAT_VECTOR", "CORNER")}
    stored = data.attributes
    return [
        name
        for name, kind in kinds.items()
        if name in stored and (stored[name].data_type, stored[name].domain) == kind
    ]


def start(data: bpy.types.ID, limit: limitsurf.LimitSurface) -> None:
    """Takes the data's points for those at rest."""
    for name in moved_names(data):
        attribute = data.attributes[name]
        values = attributes.read(data, name)
        attributes.write(data, rest_name(name), attribute.data_type, attribute.domain, values)
    if ids.LIVE_WRITTEN in data:
        del data[ids.LIVE_WRITTEN]
    LiveThing().mark(data, limit)


def check(data: bpy.types.ID, limit: limitsurf.LimitSurface) -> None:
    """Raises LocationError, MeshError or ValueError where the data is not bound to the surface."""
    LiveThing().check(data, limit)


def stop(data: bpy.types.ID) -> None:
    """Puts the data's points where they are at rest. Edits must have been taken up before."""
    is_new = added(data)
    for name in moved_names(data):
        if rest_name(name) in data.attributes:
            values = attributes.read(data, rest_name(name))
            resting = _rows(data, name, is_new)
            values[resting] = attributes.read(data, name)[resting]
            _write(data, name, values)
    leave(data)


def added(data: bpy.types.ID) -> np.ndarray:
    """Tells which strands are new."""
    is_new: np.ndarray = attributes.read(data, ids.LIVE_FINGERPRINT) == 0
    return is_new


def lost_frames(data: bpy.types.ID) -> int:
    """Returns the number of strands that stay still because an earlier version of the extension has
    deleted their frames at rest.
    """
    if missing(data):
        return 0
    has_none = without_frame(attributes.read(data, ids.REST_ROTATION))
    has_face = attributes.read(data, ids.FACE) != NOWHERE
    return int((has_none & has_face & ~added(data)).sum())


def begin_anew(data: bpy.types.ID, strands: np.ndarray) -> None:
    """Makes strands new ones that have got another place: they are at rest where they are now."""
    if not missing(data):
        prints = attributes.read(data, ids.LIVE_FINGERPRINT)
        prints[strands] = 0
        _write(data, ids.LIVE_FINGERPRINT, prints)


def leave(data: bpy.types.ID) -> None:
    """Leaves the data's points where they are, and forgets those at rest."""
    followed = (*_POINTS, *_VECTORS, ids.ROTATION, ids.CUSTOM_NORMAL)
    for name in (ids.LIVE_FINGERPRINT, *(rest_name(name) for name in followed)):
        if name in data.attributes:
            data.attributes.remove(data.attributes[name])
    if ids.LIVE_WRITTEN in data:
        del data[ids.LIVE_WRITTEN]
    _tag(data)


def missing(data: bpy.types.ID) -> str:
    """Returns the name of an attribute without which the data cannot follow: it does not exist, or
    is of another type or domain. Returns nothing where all are there.
    """
    needed = {
        ids.LIVE_REST: ("FLOAT_VECTOR", "POINT"),
        ids.LIVE_FINGERPRINT: ("INT", domain_of(data)),
    }
    return lacking(data, needed | root_attributes(data))


def written(data: bpy.types.ID) -> Written | None:
    stored = data.get(ids.LIVE_WRITTEN)
    if stored is None or len(stored) != 17:
        return None
    numbers = np.array(stored, np.float64)
    return Written(float(numbers[0]), numbers[1:].reshape(4, 4))


class LiveThing:
    """What is prepared for one data-block, and kept from frame to frame.

    Blender copies an attribute when it is looked up for the first time in a frame, even if it is
    only read. So what is bound, and the shape at rest, are read again only when Blender says that
    the data-block has changed (`read_anew`), or when its attributes, the number of its elements or
    the stored fingerprints are not those of before. Points are read in each frame.
    """

    def __init__(self) -> None:
        self.version = -1  # the surface's version for which the points were written
        self._limit: limitsurf.LimitSurface | None = None
        self._binding: dict[str, np.ndarray] = {}
        self._poser: limitsurf.StrandPoser | None = None
        self._corners: _Corners | None = None
        self._buffers: dict[str, np.ndarray] = {}
        self._is_current = False  # points were read since the last pose
        self._source: tuple[object, ...] | None = None  # what the binding was read from
        self._rests: set[str] = set()  # attributes at rest that the buffers hold
        self._prints = np.empty(0, np.int32)  # the fingerprints that were written last
        self._known = np.empty(0, np.int32)  # the same, but not 0 for new strands
        self.lost_frames = 0  # the number of strands that stay still because they have none

    def read_anew(self) -> None:
        """Is called when somebody may have changed the data-block."""
        self._source = None

    def check(self, data: bpy.types.ID, limit: limitsurf.LimitSurface) -> None:
        self._poser_on(data, limit)

    def edits(self, data: bpy.types.ID, limit: limitsurf.LimitSurface) -> np.ndarray | None:
        """Returns which strands somebody has changed since they were written; None for none."""
        prints = self._read(data, ids.LIVE_FINGERPRINT)
        if not _same_bits(prints, self._prints):
            self.read_anew()
            self._prints, self._known = prints.copy(), prints.copy()
        edited: np.ndarray = self._fingerprints(data, self._poser_on(data, limit)) != self._known
        self._is_current = True
        return edited if edited.any() else None

    def take_up(
        self,
        data: bpy.types.ID,
        edited: np.ndarray,
        limit: limitsurf.LimitSurface,
        matrix: np.ndarray,
    ) -> None:
        """Changes the shape at rest of edited strands, so that they are posed to where they are
        now, on the surface in the pose for which they were written. New ones are at rest there.
        """
        poser = self._poser_on(data, limit)
        for name in _points_of(data):
            rest = self._at_rest(data, name)
            poser.unpose(self._read(data, name), matrix, rest, only=edited)
            _write(data, rest_name(name), rest)
        is_new = edited & (self._prints == 0)
        if is_new.any():
            self._take_up_vectors(data, is_new)
        self._write_prints(data, self._fingerprints(data, poser))

    def _take_up_vectors(self, data: bpy.types.ID, is_new: np.ndarray) -> None:
        for name in moved_names(data):
            if name not in _POINTS and rest_name(name) in data.attributes:
                rest, rows = self._at_rest(data, name), _rows(data, name, is_new)
                rest[rows] = attributes.read(data, name)[rows]
                _write(data, rest_name(name), rest)

    def mark(self, data: bpy.types.ID, limit: limitsurf.LimitSurface) -> None:
        """Takes the points for those that were written. All strands follow from now on."""
        prints = self._fingerprints(data, self._poser_on(data, limit))
        if ids.LIVE_FINGERPRINT not in data.attributes:
            data.attributes.new(ids.LIVE_FINGERPRINT, "INT", _domain(data))
        _write(data, ids.LIVE_FINGERPRINT, prints)

    def admit(self, data: bpy.types.ID, limit: limitsurf.LimitSurface) -> None:
        """Has new strands follow from now on. Their edits must have been taken up before."""
        prints = self._read(data, ids.LIVE_FINGERPRINT)
        own = self._fingerprints(data, self._poser_on(data, limit))
        _write(data, ids.LIVE_FINGERPRINT, np.where(prints == 0, own, prints))

    def _write_prints(self, data: bpy.types.ID, prints: np.ndarray) -> None:
        """Writes the fingerprints of all but new strands."""
        self._known = prints
        self._prints = np.where(self._prints == 0, np.int32(0), prints)
        _write(data, ids.LIVE_FINGERPRINT, self._prints)

    def pose(
        self, data: bpy.types.ID, limit: limitsurf.LimitSurface, matrix: np.ndarray, frame: float
    ) -> bool:
        """Moves everything to where it is on the surface in its pose, and returns whether anything
        changed.
        """
        is_current = self._is_current and limit is self._limit
        if not is_current:
            self._poser_on(data, limit)
        self._is_current = False
        poser = self._poser
        assert poser is not None
        has_moved = self._pose_vectors(data, poser, matrix)
        prints = np.zeros(len(poser), np.int32)
        for name in _points_of(data):
            points = self._buffers[name] if is_current else self._read(data, name)
            rest = self._at_rest(data, name)
            has_changed, own = poser.repose(rest, points, matrix)
            prints ^= own
            if has_changed:
                _write(data, name, points)
                has_moved = True
        if has_moved:
            _tag(data)
            self._write_prints(data, _without_zero(prints))
        now = np.array([frame, *matrix.ravel()])
        if not np.array_equal(data.get(ids.LIVE_WRITTEN, ()), now):
            data[ids.LIVE_WRITTEN] = now.tolist()
        return has_moved

    def _pose_vectors(
        self, data: bpy.types.ID, poser: limitsurf.StrandPoser, matrix: np.ndarray
    ) -> bool:
        """Turns normals, tangents and rotations, and returns whether anything changed."""
        how: dict[str, Callable[..., np.ndarray]] = {ids.ROTATION: poser.pose_rotations}
        how |= dict.fromkeys(_VECTORS, poser.pose_vectors)
        if ids.CUSTOM_NORMAL in data.attributes and isinstance(data, bpy.types.Mesh):
            how[ids.CUSTOM_NORMAL] = self._corners_of(data).pose_vectors
        has_moved = False
        there = data.attributes.keys()
        for name in moved_names(data):
            if name not in how or rest_name(name) not in there:
                continue  # it was added later
            rest = self._at_rest(data, name)
            posed = how[name](rest, matrix, self._buffer(f"new {name}", rest.shape))
            if not _same_bits(posed, self._read(data, name)):
                _write(data, name, posed)
                has_moved = True
        return has_moved

    def _fingerprints(self, data: bpy.types.ID, poser: limitsurf.StrandPoser) -> np.ndarray:
        """Returns numbers that change with every bit of a strand's points and handles."""
        total: np.ndarray = np.zeros(len(poser), np.int32)
        for name in _points_of(data):
            total = total ^ poser.fingerprints(self._read(data, name))
        return _without_zero(total)

    def _poser_on(self, data: bpy.types.ID, limit: limitsurf.LimitSurface) -> limitsurf.StrandPoser:
        """Returns what poses the strands as they are bound now."""
        if self._poser and limit is self._limit and self._source == _source(data):
            return self._poser
        self._rests.clear()
        binding = {name: attributes.read(data, name) for name in ROOT_KINDS}
        self.lost_frames = lost_frames(data)
        binding[ids.REST_ROTATION][binding[ids.FACE] == NOWHERE] = 0
        if ids.LIVE_FINGERPRINT in data.attributes:
            binding[ids.REST_ROTATION][added(data)] = 0
        if isinstance(data, bpy.types.Curves):
            binding["offsets"] = attributes.curve_offsets(data)
        if (
            self._poser is None
            or limit is not self._limit
            or binding.keys() != self._binding.keys()
            or not all(_same_bits(binding[key], kept) for key, kept in self._binding.items())
        ):
            self._poser = _poser(limit, binding, binding.get("offsets"))
            self._limit, self._binding, self._corners = limit, binding, None
        self._source = _source(data)
        return self._poser

    def _corners_of(self, mesh: bpy.types.Mesh) -> _Corners:
        """Returns what turns vectors at the corners of polygons, on the surface of the poser."""
        vertex = attributes.read(mesh, ids.CORNER_VERTEX)
        if self._corners is None or not np.array_equal(self._corners.vertex, vertex):
            assert self._limit is not None
            self._corners = _Corners(vertex, self._binding, self._limit)
        return self._corners

    def _at_rest(self, data: bpy.types.ID, name: str) -> np.ndarray:
        """Returns the attribute's values at rest, for the binding that was read last."""
        at_rest = rest_name(name)
        if at_rest not in self._rests:
            self._read(data, at_rest)
            self._rests.add(at_rest)
        return self._buffers[at_rest]

    def _read(self, data: bpy.types.ID, name: str) -> np.ndarray:
        """Returns the attribute's values, in memory that is used again for the next frame."""
        attribute = data.attributes[name]
        layout = attributes.LAYOUTS[attribute.data_type]
        count = len(attribute.data)
        shape = (count,) if layout.width == 1 else (count, layout.width)
        values = self._buffer(name, shape, layout.dtype)
        attribute.data.foreach_get(layout.key, values.reshape(-1))
        return values

    def _buffer(self, name: str, shape: tuple[int, ...], kind: type = np.float32) -> np.ndarray:
        buffer = self._buffers.get(name)
        if buffer is None or buffer.shape != shape or buffer.dtype != kind:
            buffer = self._buffers[name] = np.empty(shape, kind)
        return buffer


class _Corners:
    """Turns vectors at the corners of polygons as their vertices turn. To the poser the corners of
    a vertex are the points of a strand.
    """

    def __init__(
        self, vertex: np.ndarray, binding: dict[str, np.ndarray], limit: limitsurf.LimitSurface
    ) -> None:
        self.vertex = vertex
        self._order = np.argsort(vertex, kind="stable")
        count = np.bincount(vertex, minlength=len(binding[ids.FACE]))
        self._poser = _poser(limit, binding, np.concatenate([[0], np.cumsum(count)]))

    def pose_vectors(self, rest: np.ndarray, matrix: np.ndarray, out: np.ndarray) -> np.ndarray:
        out[self._order] = self._poser.pose_vectors(rest[self._order], matrix)
        return out


def _poser(
    limit: limitsurf.LimitSurface, binding: dict[str, np.ndarray], offsets: np.ndarray | None
) -> limitsurf.StrandPoser:
    return limit.strand_poser(
        binding[ids.FACE],
        binding[ids.UV].astype(np.float64),
        binding[ids.REST_ROOT],
        binding[ids.REST_ROTATION],
        offsets,
    )


def _without_zero(prints: np.ndarray) -> np.ndarray:
    """Returns the fingerprints of strands; 0 is that of a strand that was never written."""
    return np.where(prints == 0, np.int32(1), prints)


def _points_of(data: bpy.types.ID) -> list[str]:
    there = data.attributes.keys()
    return [name for name in _POINTS if name in there and rest_name(name) in there]


def _source(data: bpy.types.ID) -> tuple[object, ...]:
    """Returns what tells a data-block from another one that takes its place."""
    kinds = {bpy.types.Curves: "curves", bpy.types.Mesh: "vertices"}
    elements = getattr(data, kinds.get(type(data), "points"))
    return data.as_pointer(), len(elements), *data.attributes.keys()


def _rows(data: bpy.types.ID, name: str, strands: np.ndarray) -> np.ndarray:
    """Tells which elements of an attribute belong to these strands (a mask)."""
    if isinstance(data, bpy.types.Curves):
        return np.repeat(strands, np.diff(attributes.curve_offsets(data)))
    if data.attributes[name].domain == "CORNER":
        return strands[attributes.read(data, ids.CORNER_VERTEX)]
    return strands


def _domain(data: bpy.types.ID) -> str:
    return data.attributes[ids.FACE].domain


def _same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    return a.shape == b.shape and np.array_equal(a.view(np.int32), b.view(np.int32))


def _write(data: bpy.types.ID, name: str, values: np.ndarray) -> None:
    if data.library or data.override_library:
        linked_attributes.write(data, name, values)
    elif isinstance(data, bpy.types.Mesh) and name == ids.POSITION:
        # unlike the attribute, it has Blender calculate the bounding box anew
        data.vertices.foreach_set("co", values.reshape(-1))
    else:
        attribute = data.attributes[name]
        attributes.write(data, name, attribute.data_type, attribute.domain, values)


def _tag(data: bpy.types.ID) -> None:
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
