# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface that things follow live: its limit surface in the pose of the present frame.

The modifier *Limit Capture* hands on the control mesh's positions, and checksums of all else that
the limit surface depends on. While these stay the same, a new frame costs only the reading of one
attribute. Otherwise the control mesh is read anew.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from .. import ids, native
from ..errors import CageError
from ..nodes import groups
from ..nodes.capture import CHECKSUMS
from ..reading import attributes, cage, copied_object, private_scene, rules
from ..tasks.unchanged import faces_of
from . import capture_place, following, live_source

if TYPE_CHECKING:
    import limitsurf

_WITHOUT_EFFECT = (ids.FOLLOW_LIVE_GROUP, ids.CAPTURE_GROUP)


class _Captured(NamedTuple):
    """What *Limit Capture* hands on."""

    positions: np.ndarray  # (vertices of the control mesh, 3) float64
    checksums: tuple[object, ...]


class SurfacePose(NamedTuple):
    """The shape of a surface at some time."""

    frame: float
    positions: np.ndarray  # (vertices of the control mesh, 3) float64
    checksums: tuple[object, ...] | None  # without them it cannot be told what it belongs to


class PosedSurface(NamedTuple):
    """A limit surface, and the control points of the pose that is meant. That of the surface itself
    may be another one: to set it takes long on meshes with many irregular faces.
    """

    limit: limitsurf.LimitSurface
    positions: np.ndarray  # (vertices of the control mesh, 3) float64

    def set_pose(self) -> None:
        """Gives the surface itself this pose."""
        if not np.array_equal(self.limit.positions, self.positions):
            self.limit.set_positions(self.positions)


class LiveSurface:
    """`version` counts the poses. Raises CageError and MeshError where there is no surface."""

    limit: limitsurf.LimitSurface  # there is one once it has been read; its pose may be another one
    pose: SurfacePose  # the one that was read last
    signature: str  # of the faces and rules of the limit surface
    source: str  # what these faces come from

    def __init__(self) -> None:
        self.version = 0
        self._is_behind = True  # something has moved since the pose was read, or there is none yet
        self._checksums: tuple[object, ...] | None = None
        self._faces: tuple[int, int, int] | None = None  # what tells the mesh's faces from others
        self._mesh = 0  # the number of the mesh that has these faces

    def look_at_faces(self) -> None:
        """Is called when somebody may have changed the mesh. The checksums of *Limit Capture* do
        not see faces that were deleted or turned while their edges stayed.
        """
        self._faces = None

    def read(self, ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
        """Takes the pose of the depsgraph's frame."""
        self._take(ob, depsgraph, _evaluated(ob, depsgraph))

    def read_again(self, ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
        """Takes the pose that the surface has in the depsgraph's frame after something was moved
        on which it depends, and which the depsgraph has not evaluated again.
        """
        self._is_behind = True
        captured = _evaluated(ob, depsgraph)
        if captured is not None and _is_bare(ob, depsgraph):
            positions = attributes.read(ob.data, ids.POSITION).astype(np.float64)
            captured = captured._replace(positions=positions)
        elif captured is not None:
            captured = _evaluated_anew(ob, depsgraph)
        self._take(ob, depsgraph, captured)

    def had(self, pose: SurfacePose | None) -> bool:
        """Tells whether the surface had this pose, and has the same faces and creases now."""
        if pose is None or pose.checksums is None:
            return False
        return pose.checksums == self._checksums

    def posed(self, pose: SurfacePose | None = None) -> PosedSurface:
        """Returns the surface in its present pose, or in an earlier one."""
        return PosedSurface(self.limit, (pose or self.pose).positions)

    def _take(
        self,
        ob: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        captured: _Captured | None,
    ) -> None:
        frame = depsgraph.scene.frame_float
        if self._mesh != ob.data.session_uid:
            self._faces, self._mesh = None, ob.data.session_uid
        if self._faces is None and not ob.data.is_editmode:
            self._faces = faces_of(ob.data)
        if captured is not None:
            captured = captured._replace(checksums=(*captured.checksums, self._faces))
        is_other = captured is None or captured.checksums != self._checksums
        if is_other and private_scene.is_barred() and self.version:
            if captured is not None:
                raise CageError(_other_in_renders(ob))
            if not self._is_behind and self.pose.frame == frame:
                return  # it was read for this frame before the exporter began
        self.version += 1
        if is_other:
            self._checksums = None
            # without the modifier the surface is read after each update
            found = cage.read(ob, depsgraph, puts_back=captured is not None)
            self.limit, self.signature = found.surface(), following.signature(found)
        self.source = live_source.source_of(ob, self._faces)
        self._is_behind = False
        if captured is None:
            self.pose = SurfacePose(frame, self.limit.positions.copy(), None)
            return
        if len(captured.positions) != len(self.limit.positions):
            raise CageError(_other_in_renders(ob))
        self._checksums = captured.checksums
        self.pose = SurfacePose(frame, captured.positions, captured.checksums)


def _other_in_renders(ob: bpy.types.Object) -> str:
    return (
        f"The modifiers of {ob.name} give another control mesh in renders than in the viewport: "
        "enable each of them in both, or in neither"
    )


def surface_at(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, frame: float) -> PosedSurface:
    """Returns the limit surface of another frame."""
    with cage.opened(ob, depsgraph, _at(frame)) as (found, _):
        limit = found.surface()
        return PosedSurface(limit, limit.positions)


def _at(frame: float) -> Callable[[bpy.types.Object, bpy.types.Scene], None]:
    def go(_copy: bpy.types.Object, scene: bpy.types.Scene) -> None:
        scene.frame_float = frame

    return go


def _evaluated(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> _Captured | None:
    """Returns what the depsgraph has evaluated last, if it is the control mesh."""
    evaluated = ob.evaluated_get(depsgraph)
    if not evaluated.is_evaluated or evaluated.type != "MESH":
        return None
    if capture_place.hands_on_another_mesh(ob):
        return None
    geometry, mesh = least_subdivided(evaluated)  # the mesh lives as long as the geometry
    return None if mesh is None else _captured(ob, evaluated, mesh, depsgraph.mode)


def least_subdivided(
    evaluated: bpy.types.Object,
) -> tuple[object, bpy.types.Mesh | None]:
    """Returns an evaluated object's mesh, and what holds it. Blender leaves a last Subdivision
    Surface modifier to the graphics card, or to whoever reads `evaluated.data`: that would take the
    processor several times as long as all that is done here. Such a modifier is not applied to this
    mesh.
    """
    if bpy.app.version < (4, 5):
        return evaluated, evaluated.data
    try:
        geometry = evaluated.evaluated_geometry()
    except TypeError:
        # Blender refuses what is to be evaluated again, as after values were changed that have
        # keys. The mesh that it has evaluated last, and shows, is still there.
        return evaluated, evaluated.data
    return geometry, geometry.mesh_base


def _is_bare(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    """Tells whether the control mesh is the object's own mesh: no modifier changes it."""
    shown = capture_place.shown_in(depsgraph.mode)
    before = [m for m in ob.modifiers[: rules.place_of_subsurf(ob)] if getattr(m, shown)]
    return ob.data.shape_keys is None and all(
        m.type == "NODES" and groups.name_of(m.node_group) in _WITHOUT_EFFECT for m in before
    )


def _evaluated_anew(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> _Captured | None:
    """Returns what *Limit Capture* hands on by what the file contains now."""

    def enable(copy: bpy.types.Object, _scene: bpy.types.Scene) -> None:
        if depsgraph.mode == "RENDER":
            copied_object.show_as_rendered(copy)

    cut = rules.place_of_subsurf(ob)
    with cage.evaluated_copy(ob, cut, depsgraph, enable, settled=cut) as evaluated:
        return _captured(ob, evaluated, evaluated.data, "VIEWPORT")


def _captured(
    ob: bpy.types.Object, evaluated: bpy.types.Object, mesh: bpy.types.Mesh, mode: str
) -> _Captured | None:
    """Returns what *Limit Capture* has stored in the evaluated object's mesh, if it was run."""
    stored = mesh.attributes
    if not capture_place.was_run(ob, evaluated, mode) or ids.CAGE_POSITION not in stored:
        return None
    found = [stored[name].data for name in CHECKSUMS if name in stored]
    if len(found) < len(CHECKSUMS) or not all(map(len, found)):
        return None
    sums = tuple(values[0].value for values in found)
    positions = attributes.read(mesh, ids.CAGE_POSITION)
    if len(positions) < sums[0]:
        return None
    rule = rules.read(rules.find_subsurf(ob))
    return _Captured(positions[: sums[0]].astype(np.float64), (*sums, rule))


#: What may be raised where a surface cannot be read
errors: tuple[type[Exception], ...] = (CageError, *native.errors)
#: These, and what is raised where it can be read, but has other faces than things are bound to
unfit: tuple[type[Exception], ...] = (live_source.StaleFacesError, *errors)
