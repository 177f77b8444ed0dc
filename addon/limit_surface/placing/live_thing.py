# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair or points that the extension itself moves with a surface.

`position` holds the points where they are now, which is what artists see and comb; `limit_rest`
holds them at rest, `limit_fingerprint` a number for each strand that tells whether somebody has
changed its points since they were written, and the custom property `limit_written` the frame and
the matrix of that moment. All of it belongs to the data: it survives saving, undo, deleted strands
and linking. What is shown in a frame depends on the shape at rest and on the frame alone.

Strands whose fingerprint is 0 are new: they were added or joined later, or have just got another
place. They stay where they are, whatever their other attributes say, until they are admitted.
Vertices whose seals are broken (`seals.py`) follow with the nearest vertex that has a place.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import ids
from ..reading import attributes
from . import seals
from .live_attributes import (
    POINTS,
    VECTORS,
    added,
    lost_frames_of,
    moved_names,
    note_written,
    place_domain,
    points_of,
    rest_name,
    rows_of,
    tag,
    write,
)
from .live_surface import PosedSurface, SurfacePose
from .places import NOWHERE, ROOT_KINDS, Places

if TYPE_CHECKING:
    import limitsurf

#: If more than a tenth of the roots stand on irregular faces, they are prepared after so many
#: frames of the same strands and faces. Later frames need no posed surface, and take a third of
#: the time. The preparation takes as long as 10 to 20 frames without it.
_FRAMES_UNPREPARED = 12
#: With more such roots the preparation would stop a playback for more than a second on one core.
_MOST_PREPARED = 100_000


def start(data: bpy.types.ID, limit: limitsurf.LimitSurface) -> None:
    """Takes the data's points for those at rest."""
    seals.seal(data, Places.read(data).rows)
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


class LiveThing:
    """What is prepared for one data-block, and kept from frame to frame.

    Blender copies an attribute when it is looked up for the first time in a frame, even if it is
    only read. So what is bound, and the shape at rest, are read again only when Blender says that
    the data-block has changed (`read_anew`), or when its attributes, the number of its elements or
    the stored fingerprints are not those of before. Points are read in each frame.
    """

    def __init__(self) -> None:
        self.version = -1  # the surface's version for which the points were written
        self.surface_pose: SurfacePose | None = None  # the surface's pose then
        self._limit: limitsurf.LimitSurface | None = None
        self._binding: dict[str, np.ndarray] = {}
        self._poser: limitsurf.StrandPoser | None = None
        self._is_irregular = False  # it pays to prepare the poser for control points
        self._frames = 0  # that this poser has shown
        self._corners: _Corners | None = None
        self._buffers: dict[str, np.ndarray] = {}
        self._is_current = False  # points were read since the last pose
        self._source: tuple[object, ...] | None = None  # what the binding was read from
        self._rests: set[str] = set()  # attributes at rest that the buffers hold
        self._prints = np.empty(0, np.int32)  # the fingerprints that were written last
        self._known = np.empty(0, np.int32)  # the same, but not 0 for new strands
        self.added = 0  # the number of vertices that have no places of their own
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

    def misfit(
        self,
        data: bpy.types.ID,
        edited: np.ndarray,
        posed: PosedSurface,
        matrix: np.ndarray,
    ) -> float:
        """Returns how far strands that nobody has edited are from where the surface in its pose
        carries them, in units of the largest coordinate: about 0 if it is the pose for which they
        were written. It is NaN where that cannot be told, because all were edited.
        """
        poser, positions = self._poser_on(data, posed.limit), self._positions_of(posed)
        worst, largest = np.nan, 0.0
        for name in points_of(data):
            points, rows = self._read(data, name), ~rows_of(data, name, edited)
            if rows.any():
                now = poser.pose(self._at_rest(data, name), matrix, positions=positions)
                worst = np.fmax(worst, np.abs(now[rows] - points[rows]).max())
                largest = max(largest, float(np.abs(points[rows]).max()))
        return float(worst / (largest or 1.0))

    def take_up(
        self,
        data: bpy.types.ID,
        edited: np.ndarray,
        posed: PosedSurface,
        matrix: np.ndarray,
    ) -> None:
        """Changes the shape at rest of edited strands, so that they are posed to where they are
        now, on the surface in the pose for which they were written. New ones are at rest there.
        """
        poser, positions = self._poser_on(data, posed.limit), self._positions_of(posed)
        for name in points_of(data):
            rest = self._at_rest(data, name)
            poser.unpose(self._read(data, name), matrix, rest, only=edited, positions=positions)
            write(data, rest_name(name), rest)
        is_new = edited & (self._prints == 0)
        if is_new.any():
            self._take_up_vectors(data, is_new)
        self._write_prints(data, self._fingerprints(data, poser))

    def _take_up_vectors(self, data: bpy.types.ID, is_new: np.ndarray) -> None:
        for name in moved_names(data):
            if name not in POINTS and rest_name(name) in data.attributes:
                rest, rows = self._at_rest(data, name), rows_of(data, name, is_new)
                rest[rows] = attributes.read(data, name)[rows]
                write(data, rest_name(name), rest)

    def mark(self, data: bpy.types.ID, limit: limitsurf.LimitSurface) -> None:
        """Takes the points for those that were written. All strands follow from now on."""
        prints = self._fingerprints(data, self._poser_on(data, limit))
        if ids.LIVE_FINGERPRINT not in data.attributes:
            attributes.add(data, ids.LIVE_FINGERPRINT, "INT", place_domain(data))
        write(data, ids.LIVE_FINGERPRINT, prints)

    def admit(self, data: bpy.types.ID, limit: limitsurf.LimitSurface) -> None:
        """Has new strands follow from now on. Their edits must have been taken up before."""
        prints = self._read(data, ids.LIVE_FINGERPRINT)
        own = self._fingerprints(data, self._poser_on(data, limit))
        write(data, ids.LIVE_FINGERPRINT, np.where(prints == 0, own, prints))
        seals.seal(data, Places.read(data).rows)

    def _write_prints(self, data: bpy.types.ID, prints: np.ndarray) -> None:
        """Writes the fingerprints of all but new strands."""
        self._known = prints
        self._prints = np.where(self._prints == 0, np.int32(0), prints)
        write(data, ids.LIVE_FINGERPRINT, self._prints)

    def pose(
        self, data: bpy.types.ID, posed: PosedSurface, matrix: np.ndarray, frame: float
    ) -> bool:
        """Moves everything to where it is on the surface, and returns whether anything changed."""
        is_current = self._is_current and posed.limit is self._limit
        if not is_current:
            self._poser_on(data, posed.limit)
        self._is_current = False
        poser = self._poser
        assert poser is not None
        if self.surface_pose is None or frame != self.surface_pose.frame:
            self._frames += 1
        positions = self._positions_of(posed)
        has_moved = self._pose_vectors(data, poser, matrix, positions)
        prints = np.zeros(len(poser), np.int32)
        for name in points_of(data):
            points = self._buffers[name] if is_current else self._read(data, name)
            rest = self._at_rest(data, name)
            has_changed, own = poser.repose(rest, points, matrix, positions=positions)
            prints ^= own
            if has_changed:
                write(data, name, points)
                has_moved = True
        if has_moved:
            tag(data)
            self._write_prints(data, _without_zero(prints))
        note_written(data, frame, matrix)
        return has_moved

    def _positions_of(self, posed: PosedSurface) -> np.ndarray | None:
        """Returns what the poser's calls need to know of the pose: the control points, or None if
        the surface itself has the pose.
        """
        if self._is_irregular and self._frames > _FRAMES_UNPREPARED:
            return posed.positions
        posed.set_pose()
        return None

    def _pose_vectors(
        self,
        data: bpy.types.ID,
        poser: limitsurf.StrandPoser,
        matrix: np.ndarray,
        positions: np.ndarray | None,
    ) -> bool:
        """Turns normals, tangents and rotations, and returns whether anything changed."""
        how: dict[str, Callable[..., np.ndarray]] = {ids.ROTATION: poser.pose_rotations}
        how |= dict.fromkeys(VECTORS, poser.pose_vectors)
        if ids.CUSTOM_NORMAL in data.attributes and isinstance(data, bpy.types.Mesh):
            how[ids.CUSTOM_NORMAL] = self._corners_of(data).pose_vectors
        has_moved = False
        there = data.attributes.keys()
        for name in moved_names(data):
            if name not in how or rest_name(name) not in there:
                continue  # it was added later
            rest = self._at_rest(data, name)
            out = self._buffer(f"new {name}", rest.shape)
            posed = how[name](rest, matrix, out, positions=positions)
            if not _same_bits(posed, self._read(data, name)):
                write(data, name, posed)
                has_moved = True
        return has_moved

    def _fingerprints(self, data: bpy.types.ID, poser: limitsurf.StrandPoser) -> np.ndarray:
        """Returns numbers that change with every bit of a strand's points and handles."""
        total: np.ndarray = np.zeros(len(poser), np.int32)
        for name in points_of(data):
            total = total ^ poser.fingerprints(self._read(data, name))
        return _without_zero(total)

    def _poser_on(self, data: bpy.types.ID, limit: limitsurf.LimitSurface) -> limitsurf.StrandPoser:
        """Returns what poses the strands as they are bound now."""
        if self._poser and limit is self._limit and self._source == _source(data):
            return self._poser
        self._rests.clear()
        binding = {name: attributes.read(data, name) for name in ROOT_KINDS}
        if ids.LIVE_FINGERPRINT in data.attributes:
            is_new = added(data)
            self.lost_frames = lost_frames_of(binding, is_new)
            binding[ids.FACE][is_new] = NOWHERE
            self.added = _carry_added(data, binding)
        binding[ids.REST_ROTATION][binding[ids.FACE] == NOWHERE] = 0
        if isinstance(data, bpy.types.Curves):
            binding["offsets"] = attributes.curve_offsets(data)
        if (
            self._poser is None
            or limit is not self._limit
            or binding.keys() != self._binding.keys()
            or not all(_same_bits(binding[key], kept) for key, kept in self._binding.items())
        ):
            self._poser, self._frames = _poser(limit, binding, binding.get("offsets")), 0
            irregular = self._poser.irregular_count
            self._is_irregular = len(self._poser) / 10 < irregular <= _MOST_PREPARED
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

    def pose_vectors(
        self,
        rest: np.ndarray,
        matrix: np.ndarray,
        out: np.ndarray,
        *,
        positions: np.ndarray | None,
    ) -> np.ndarray:
        in_order = rest[self._order]
        out[self._order] = self._poser.pose_vectors(in_order, matrix, positions=positions)
        return out


def _carry_added(data: bpy.types.ID, binding: dict[str, np.ndarray]) -> int:
    """Gives vertices whose seals are broken the places of those that carry them. Returns the number
    of those whose seals are broken.
    """
    broken = seals.are_broken(data)
    if broken is None or not broken.any():
        return 0
    binding[ids.FACE][broken] = NOWHERE
    by = seals.carriers(data, broken, binding[ids.FACE] != NOWHERE)
    for name in ROOT_KINDS:
        binding[name] = binding[name][by]
    return int(broken.sum())


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


def _source(data: bpy.types.ID) -> tuple[object, ...]:
    """Returns what tells a data-block from another one that takes its place."""
    kinds = {bpy.types.Curves: "curves", bpy.types.Mesh: "vertices"}
    elements = getattr(data, kinds.get(type(data), "points"))
    return data.as_pointer(), len(elements), *data.attributes.keys()


def _same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    return a.shape == b.shape and np.array_equal(a.view(np.int32), b.view(np.int32))
