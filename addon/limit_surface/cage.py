# SPDX-License-Identifier: GPL-3.0-or-later
"""From an object to the control mesh of its limit surface.

The cage is the mesh after all modifiers that stand before the first enabled Subdivision Surface
modifier; that modifier states the rules. No state of Blender's own evaluation shows the cage, so a
private scene evaluates a copy of the object whose modifiers end there, at the frame of the caller's
depsgraph and without calling frame-change handlers. Both are removed before anybody else sees them.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from . import attributes, ids, native
from .errors import CageError

if TYPE_CHECKING:
    import limitsurf

BOUNDARIES = {"ALL": "smooth", "PRESERVE_CORNERS": "corners"}

# These carry a state from frame to frame, which a copy does not have.
SIMULATIONS = {"CLOTH", "SOFT_BODY", "FLUID", "DYNAMIC_PAINT", "EXPLODE"}

_busy = False


def is_busy() -> bool:
    """Whether handlers are being called for the private scene: they have nothing to do there."""
    return _busy


@dataclass(frozen=True)
class CornerMap:
    """A UV map: one row per face corner, in the cage's order of corners."""

    name: str
    values: np.ndarray


@dataclass(frozen=True)
class Cage:
    mesh: limitsurf.ControlMesh
    face_sizes: np.ndarray
    matrix: np.ndarray  # object to world, 4x4
    uv_map: CornerMap | None  # the active one, as it is on the cage
    boundary: str
    subsurf: str  # the modifier's name; empty where the object has none
    ignored: tuple[str, ...]  # enabled modifiers behind it

    @property
    def ptex_face_count(self) -> int:
        return int(np.where(self.face_sizes == 4, 1, self.face_sizes).sum())


def find_subsurf(ob: bpy.types.Object) -> bpy.types.SubsurfModifier | None:
    """The modifier whose rules the limit surface follows: the first enabled in the viewport."""
    return next((m for m in ob.modifiers if m.type == "SUBSURF" and m.show_viewport), None)


def read(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Cage:
    """The object's cage at the depsgraph's frame. CageError where it has none."""
    subsurf = find_subsurf(ob)
    cut = ob.modifiers.find(subsurf.name) if subsurf else len(ob.modifiers)
    _check_modifiers(ob, cut, subsurf)
    with _evaluated_copy(ob, cut, depsgraph.scene) as evaluated:
        mesh = evaluated.data
        if not mesh.polygons:
            raise CageError(f"{ob.name} has no faces")
        _check_sharpness(ob, mesh, use_creases=subsurf is None or subsurf.use_creases)
        boundary = BOUNDARIES[subsurf.boundary_smooth] if subsurf else "smooth"
        face_sizes = attributes.column(mesh.polygons, "loop_total", np.int32)
        return Cage(
            mesh=native.limitsurf.ControlMesh(
                attributes.read(mesh, "position").astype(np.float64),
                face_sizes,
                attributes.column(mesh.loops, "vertex_index", np.int32),
                boundary=boundary,
            ),
            face_sizes=face_sizes,
            matrix=np.array(evaluated.matrix_world, np.float64),
            uv_map=_read_uv_map(ob, mesh),
            boundary=boundary,
            subsurf=subsurf.name if subsurf else "",
            ignored=tuple(m.name for m in ob.modifiers[cut + 1 :] if m.show_viewport),
        )


@contextmanager
def _evaluated_copy(
    ob: bpy.types.Object, cut: int, user_scene: bpy.types.Scene
) -> Iterator[bpy.types.Object]:
    """The object as it evaluates with its first `cut` modifiers."""
    global _busy
    copy = None
    scene = bpy.data.scenes.new(ids.CAGE_SCENE)
    was_busy, _busy = _busy, True
    try:
        # Assigned, not frame_set: that would call everybody's frame-change handlers.
        scene.render.frame_map_old = user_scene.render.frame_map_old
        scene.render.frame_map_new = user_scene.render.frame_map_new
        scene.frame_float = user_scene.frame_float
        copy = ob.copy()
        copy.hide_viewport = False
        for modifier in copy.modifiers[cut:]:
            copy.modifiers.remove(modifier)
        scene.collection.objects.link(copy)
        layer = scene.view_layers[0]
        layer.update()
        evaluated = copy.evaluated_get(layer.depsgraph)
        if evaluated.hide_viewport:  # animated or driven: such an object is not evaluated
            raise CageError(f"{ob.name} is hidden in the viewport at this frame")
        yield evaluated
    finally:
        if copy is not None:
            bpy.data.objects.remove(copy)
        bpy.data.scenes.remove(scene)
        _busy = was_busy


def _check_modifiers(
    ob: bpy.types.Object, cut: int, subsurf: bpy.types.SubsurfModifier | None
) -> None:
    for modifier in ob.modifiers[:cut]:
        if not modifier.show_viewport:
            continue
        if modifier.type == "MULTIRES":
            raise CageError(f"{ob.name}: Multiresolution ({modifier.name}) is not supported")
        if modifier.type in SIMULATIONS or (
            modifier.type == "NODES" and _has_simulation(modifier.node_group)
        ):
            raise CageError(
                f"{ob.name}: the simulation {modifier.name} stands before the subdivision, which "
                "is not supported: apply it, or bake it to a mesh cache"
            )
    if subsurf and subsurf.subdivision_type != "CATMULL_CLARK":
        raise CageError(
            f"{ob.name}: {subsurf.name} is set to Simple: only Catmull-Clark has a limit surface"
        )


def _has_simulation(group: bpy.types.NodeTree | None) -> bool:
    nodes = group.nodes if group else ()
    return any(
        node.bl_idname == "GeometryNodeSimulationOutput"
        or (node.bl_idname == "GeometryNodeGroup" and _has_simulation(node.node_tree))
        for node in nodes
    )


def _check_sharpness(ob: bpy.types.Object, mesh: bpy.types.Mesh, use_creases: bool) -> None:
    """Refuses what makes edges or vertices sharp: creases, and loose edges, in Blender's rules."""
    for name, what in (
        (ids.EDGE_CREASE, "edge creases"),
        (ids.VERTEX_CREASE, "vertex creases"),
    ):
        if use_creases and name in mesh.attributes:
            count = np.count_nonzero(attributes.read(mesh, name) > 0)
            if count:
                raise CageError(
                    f"{ob.name} has {what} ({count}), which are not supported yet: remove them, "
                    "or switch Use Creases off in the Subdivision Surface modifier"
                )

    loose = np.ones(len(mesh.edges), bool)
    loose[attributes.column(mesh.loops, "edge_index", np.int32)] = False
    if not loose.any():
        return
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    in_faces = np.zeros(len(mesh.vertices), bool)
    in_faces[attributes.column(mesh.loops, "vertex_index", np.int32)] = True
    touching = np.unique(ends.reshape(-1, 2)[loose])
    touching = touching[in_faces[touching]]
    if touching.size:
        raise CageError(
            f"{ob.name} has loose edges at vertices of faces ({touching.size}, the first is "
            f"{touching[0]}), which makes them sharp: not supported yet, delete the loose edges"
        )


def _read_uv_map(ob: bpy.types.Object, mesh: bpy.types.Mesh) -> CornerMap | None:
    active = ob.data.uv_layers.active
    if active is None or active.name not in mesh.uv_layers:
        return None
    return CornerMap(active.name, attributes.read(mesh, active.name).astype(np.float64))
