# SPDX-License-Identifier: GPL-3.0-or-later
"""The thing that is dragged in the current mode, and the surface over which it is dragged."""

from dataclasses import dataclass

import bpy
import numpy as np

from .. import ids
from ..errors import RefusalError
from ..placing.followers import has_own_places
from ..placing.posed_surface import transformed
from ..placing.present_shape import PresentShape
from ..reading.edited_mesh import as_edited
from ..snap.selection import OWN_PLACES, ancestors
from ..snap.surface import TargetSurface
from ..tasks.editable import check_data_editable
from ..tasks.object_keys import ObjectKey
from ..tasks.unchanged import Unchanged
from .dragged_strand import DraggedStrand
from .dragged_vertex import DraggedVertex
from .handles import DraggedObject, Handle

HAIR_MODES = ("OBJECT", "EDIT_CURVES", "SCULPT_CURVES")


@dataclass(frozen=True)
class Subject:
    """It finds both objects anew each time, because they may be removed meanwhile, also by undo."""

    kind: str  # OBJECT, VERTEX, STRAND
    dragged: ObjectKey
    surface: ObjectKey

    @property
    def ob(self) -> bpy.types.Object:
        """Raises RefusalError if it has been removed."""
        return self.dragged.find()

    @property
    def target(self) -> bpy.types.Object:
        """Raises RefusalError if it has been removed."""
        return self.surface.find()

    @property
    def is_picked(self) -> bool:
        """Tells whether the user first picks one of several elements with the mouse."""
        return self.kind != "OBJECT"

    def candidates(self) -> np.ndarray:
        """Returns the world positions (n, 3) of the elements; NaN for those that cannot be
        picked.
        """
        matrix = np.array(self.ob.matrix_world, np.float64)
        if self.kind == "VERTEX":
            return transformed(matrix, _vertices(self.ob.data))
        data = self.ob.data
        first = np.empty(len(data.curves), np.int32)
        data.curves.foreach_get("first_point_index", first)
        shape = PresentShape(self.ob, bpy.context.evaluated_depsgraph_get())
        return transformed(matrix, shape.read(ids.POSITION)[first].astype(np.float64))

    def unchanged(self) -> Unchanged:
        """Returns what tells later whether the elements are still those that are there now."""
        return Unchanged(self.ob, data=self.is_picked)

    def handle(self, element: int, surface: TargetSurface) -> Handle:
        if self.kind == "OBJECT":
            return DraggedObject(self.ob)
        if self.kind == "VERTEX":
            return DraggedVertex(self.ob, element)
        return DraggedStrand(self.ob, element, surface)


def find_subject(context: bpy.types.Context) -> Subject:
    """Raises RefusalError where there is nothing to drag."""
    active, mode = context.active_object, context.mode
    if mode == "OBJECT" and active is not None and active.type == "MESH":
        return _object(context, active)
    target = context.scene.limit_surface.target
    if mode in HAIR_MODES and active is not None and active.type == "CURVES":
        target = target or active.data.surface
        kind = "STRAND"
    elif mode == "EDIT_MESH":
        kind = "VERTEX"
    elif mode == "OBJECT":
        raise RefusalError("Select the object to drag, then the mesh; or make hair curves active")
    else:
        raise RefusalError("Not available in this mode")
    if target is None:
        raise RefusalError("Choose a target in the sidebar tab Limit")
    if target.type != "MESH":
        raise RefusalError(f"The target {target.name} is not a mesh")
    if target.data == active.data:
        raise RefusalError(f"{active.name} cannot be dragged over itself: choose another target")
    check_data_editable(active.data)
    return Subject(kind, ObjectKey.of(active), ObjectKey.of(target))


def _object(context: bpy.types.Context, target: bpy.types.Object) -> Subject:
    others = [ob for ob in context.selected_objects if ob != target]
    if len(others) != 1:
        raise RefusalError("Select one object to drag, then the mesh to drag it over")
    (ob,) = others
    if not ob.is_editable:
        raise RefusalError(f"{ob.name} is linked from another file")
    if ob in ancestors(target):
        raise RefusalError(f"{ob.name} would move {target.name} with it")
    if ob.type != "CURVES" and has_own_places(ob):
        raise RefusalError(f"{ob.name} cannot be dragged: {OWN_PLACES}")
    return Subject("OBJECT", ObjectKey.of(ob), ObjectKey.of(target))


def _vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    with as_edited(mesh) as copy:
        points = np.empty((len(copy.vertices), 3), np.float32)
        hidden = np.empty(len(copy.vertices), bool)
        copy.vertices.foreach_get("co", points.ravel())
        copy.vertices.foreach_get("hide", hidden)
    points = points.astype(np.float64)
    points[hidden] = np.nan
    return points
