# SPDX-License-Identifier: GPL-3.0-or-later
"""The control mesh of an object's limit surface.

The cage is the mesh after all modifiers that stand before the first enabled Subdivision Surface
modifier; the settings of that modifier give the rules. Blender's own evaluation never yields the
cage itself, so a copy of the object, whose modifiers end there, is evaluated in a private scene.
Both are removed before other code can see them, and no frame-change handlers are called.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from .. import ids, native
from ..errors import CageError, MultiresolutionError, NotNowError
from . import (
    animated_values,
    attributes,
    copied_object,
    private_scene,
    rigid_bodies,
    rules,
    sharpness,
    shown_stack,
    subdivided_mesh,
    transform,
    uv_map,
)
from .rules import Interpolation
from .uv_map import UvMap

if TYPE_CHECKING:
    import limitsurf

# These modifiers depend on a state from earlier frames, which a copy does not have.
SIMULATIONS = {"CLOTH", "SOFT_BODY", "FLUID", "DYNAMIC_PAINT", "EXPLODE"}

_busy = False


def is_busy() -> bool:
    """Tells whether handlers are being called for the private scene, where they have nothing to
    do.
    """
    return _busy


@dataclass(frozen=True)
class Cage:
    name: str  # of the object, for messages
    mesh: limitsurf.ControlMesh
    rules: rules.Rules
    face_sizes: np.ndarray
    matrix: np.ndarray  # the matrix from the object to the world, 4x4
    uv_map: UvMap | None  # the active UV map, as it is on the cage
    without_uv_map: str  # the reason why it is missing, if there is an active one
    shown_uv_interpolation: Interpolation  # that of the mesh that the viewport shows
    ignored: tuple[str, ...]  # the enabled modifiers after the subdivision

    @property
    def notes(self) -> list[str]:
        """Remarks for reports."""
        if not self.ignored:
            return [str(self.rules)]
        return [str(self.rules), f"ignored after {self.rules.subsurf}: {', '.join(self.ignored)}"]

    @property
    def chosen_uv_map(self) -> UvMap:
        """The UV map, for callers that have checked that there is one."""
        assert self.uv_map is not None
        return self.uv_map

    @property
    def ptex_face_count(self) -> int:
        return int(subdivided_mesh.ptex_face_counts(self.face_sizes).sum())

    def world_positions(self) -> np.ndarray:
        """Returns the vertices' positions in the world, from which the surface in world space is
        made without further rounding.
        """
        return self.to_world(self.mesh.positions)

    def to_world(self, points: np.ndarray) -> np.ndarray:
        return points @ self.matrix[:3, :3].T + self.matrix[:3, 3]

    @property
    def is_mirrored(self) -> bool:
        """Tells whether the object is mirrored in the world, so that du x dv points inwards
        there.
        """
        return bool(np.linalg.det(self.matrix[:3, :3]) < 0)

    def surface(self, *, in_world: bool = False) -> limitsurf.LimitSurface:
        """Returns a new limit surface of the cage, in the object's space or as it lies in the
        world. Subdivision gives the same surface in both; distances, angles and curvature differ.
        """
        surface = native.limitsurf.LimitSurface(self.mesh)
        if in_world:
            surface.set_positions(self.world_positions())
        return surface

    def surface_uv(
        self, surface: limitsurf.LimitSurface, face: np.ndarray, uv: np.ndarray
    ) -> np.ndarray | None:
        """Returns locations (n, 2) on the UV map of the mesh that the viewport shows, as curves
        store them; None where there is no map. Where that mesh is subdivided the map is smoothed,
        because Blender's nodes look locations up on the evaluated mesh.
        """
        if self.uv_map is None:
            return None
        smoothed = surface.face_varying(
            self.uv_map.values, self.uv_map.indices, self.shown_uv_interpolation
        )
        return smoothed.evaluate(face, uv).value

    def with_holes(self, faces: np.ndarray) -> limitsurf.ControlMesh:
        """Returns the control mesh with some faces made holes, which have no surface."""
        mesh = self.mesh
        return native.limitsurf.ControlMesh(
            mesh.positions,
            mesh.face_sizes,
            mesh.face_vertices,
            edge_sharpness=mesh.edge_sharpness,
            vertex_sharpness=mesh.vertex_sharpness,
            boundary=mesh.boundary,
            creasing=mesh.creasing,
            triangles=mesh.triangles,
            scheme=mesh.scheme,
            holes=faces,
        )


def read(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, *, puts_back: bool = True) -> Cage:
    """Reads the object's cage at the depsgraph's frame. Raises CageError where it has none. See
    `evaluated_copy` for `puts_back`.
    """
    with opened(ob, depsgraph, puts_back=puts_back) as (found, _):
        return found


def check_not_edited(ob: bpy.types.Object) -> None:
    """Raises NotNowError for a mesh whose faces Blender keeps elsewhere for a time: in Edit Mode,
    perhaps by way of another object that has the same mesh, and in Sculpt Mode with Dyntopo.
    """
    if ob.type != "MESH":
        return
    if ob.data.is_editmode:
        raise NotNowError(f"{ob.name} is in Edit Mode: leave it first")
    if ob.use_dynamic_topology_sculpting:
        raise NotNowError(f"{ob.name} is in Sculpt Mode with Dyntopo: leave it first")


def why_not_on_mesh(ob: bpy.types.Object, found: Cage) -> str:
    """Returns the reason why the mesh cannot store values of the cage's vertices, or None."""
    mesh = ob.data
    if not mesh.is_editable:
        return f"the mesh {mesh.name} is linked from another file"
    if len(mesh.vertices) != len(found.mesh.positions) or not np.array_equal(
        attributes.read(mesh, ids.CORNER_VERTEX), found.mesh.face_vertices
    ):
        return "modifiers before the subdivision change the number of vertices"
    return ""


@contextmanager
def opened(
    ob: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    adjust: Callable[[bpy.types.Object, bpy.types.Scene], None] | None = None,
    puts_back: bool = True,
) -> Iterator[tuple[Cage, bpy.types.Mesh]]:
    """Yields the cage, and the mesh that it is read from, which lasts as long as the context."""
    check_not_edited(ob)
    cut = rules.place_of_subsurf(ob)
    check_modifiers(ob, cut)
    _check_parent(ob)
    found = rules.read(rules.find_subsurf(ob))
    with evaluated_copy(ob, cut, depsgraph, adjust, puts_back, settled=cut) as evaluated:
        mesh = evaluated.data
        if not mesh.polygons:
            raise CageError(f"{ob.name} has no faces")
        matrix = np.array(evaluated.matrix_world, np.float64)
        transform.check_finite(matrix, ob.name)
        active, without = _read_uv_map(ob, mesh)
        read_cage = Cage(
            name=ob.name,
            mesh=_control_mesh(mesh, found, ob.name),
            rules=found,
            face_sizes=attributes.face_sizes(mesh),
            matrix=matrix,
            uv_map=active,
            without_uv_map=without,
            shown_uv_interpolation=rules.shown_uv_interpolation(ob, depsgraph.scene),
            ignored=tuple(m.name for m in ob.modifiers[cut + 1 :] if m.show_viewport),
        )
        yield read_cage, mesh


def _control_mesh(mesh: bpy.types.Mesh, found: rules.Rules, whose: str) -> limitsurf.ControlMesh:
    if found.scheme == "bilinear":
        sharp = sharpness.NOTHING  # all of its edges are infinitely sharp
    else:
        sharp = sharpness.read(mesh, found.use_creases, whose)
    try:
        return native.limitsurf.ControlMesh(
            attributes.read(mesh, "position").astype(np.float64),
            attributes.face_sizes(mesh),
            attributes.read(mesh, ids.CORNER_VERTEX),
            edge_sharpness=(sharp.edges, sharp.edge_values),
            vertex_sharpness=(sharp.vertices, sharp.vertex_values),
            boundary=found.boundary,
            scheme=found.scheme,
        )
    except native.limitsurf.MeshError as error:
        raise CageError(f"{whose}: {error}") from error


@contextmanager
def evaluated_copy(
    ob: bpy.types.Object,
    cut: int,
    depsgraph: bpy.types.Depsgraph,
    adjust: Callable[[bpy.types.Object, bpy.types.Scene], None] | None = None,
    puts_back: bool = True,
    settled: int | None = None,
    subject: Subject | None = None,
) -> Iterator[bpy.types.Object]:
    """Yields the object evaluated with its first `cut` modifiers; `adjust` may change the copy and
    its private scene before that. With `puts_back`, animated values that were changed without a key
    are taken as they are shown, and kept. Blender updates the user's scene afterwards if there are
    any, so whoever is called by each update must not ask for it.

    The first `settled` modifiers are those that `adjust` neither removes nor moves. Where their
    number is given, a mesh that depends on rigid bodies is read as it is shown, with its matrix.
    Otherwise only its shape is right, and NotNowError is raised where bodies change it, as seen
    from the `subject`: by default the object itself.
    """
    global _busy
    was_busy, _busy = _busy, True
    try:
        with private_scene.like(depsgraph.scene) as scene, _copied(ob) as copy:
            run = _Run(ob, depsgraph, adjust, puts_back, scene)
            try:
                evaluated = run.evaluate(copy, cut)
                # where this is animated or driven, the object is not evaluated
                if evaluated.hide_viewport:
                    raise NotNowError(f"{ob.name} is hidden in the viewport at this frame")
                with ExitStack() as stack:
                    if run.needs_simulation(copy, cut, settled, subject or Subject(copy, ob)):
                        assert settled is not None
                        runs = {m.name: m.show_viewport for m in evaluated.modifiers[:settled]}
                        scene.collection.objects.unlink(copy)
                        standing = shown_stack.standing(ob, depsgraph, settled, runs)
                        evaluated = run.evaluate(stack.enter_context(standing), cut - settled)
                    yield evaluated
            finally:
                run.go_back(copy)
    finally:
        _busy = was_busy


class Subject(NamedTuple):
    """An object in whose space a shape counts."""

    copy: bpy.types.Object  # what stands for it in the private scene
    ob: bpy.types.Object


@dataclass(frozen=True)
class _Run:
    """The evaluation of a copy of an object in a private scene."""

    ob: bpy.types.Object
    depsgraph: bpy.types.Depsgraph
    adjust: Callable[[bpy.types.Object, bpy.types.Scene], None] | None
    puts_back: bool
    scene: bpy.types.Scene

    def evaluate(self, copy: bpy.types.Object, cut: int) -> bpy.types.Object:
        copy.hide_viewport = False
        for modifier in copy.modifiers[cut:]:
            copy.modifiers.remove(modifier)
        if self.adjust:
            self.adjust(copy, self.scene)
        self.scene.collection.objects.link(copy)
        layer = self._layer()
        layer.update()
        puts_back_now = self.puts_back and not self._is_of_another_frame()
        if puts_back_now and _put_back(layer, self.depsgraph, copy, self.ob):
            layer.update()
        return copy.evaluated_get(layer.depsgraph)

    def needs_simulation(
        self, copy: bpy.types.Object, cut: int, settled: int | None, subject: Subject
    ) -> bool:
        """Tells whether rigid bodies were moved, so that the object has to be read as it is shown.
        Raises NotNowError where that is not possible.
        """
        alone = self._layer().depsgraph
        if self._is_of_another_frame():
            moving = rigid_bodies.moving(alone, self.depsgraph, self.ob)
            if moving and any(m.show_viewport for m in self.ob.modifiers[:cut]):
                frame = f"frame {self.scene.frame_float:g}"
                why = f"its shape in {frame} is needed"
                raise rigid_bodies.refusal(self.ob, moving, why, f"go to {frame}")
            return False
        moved = rigid_bodies.moved(alone, self.depsgraph, subject.copy, subject.ob)
        if not moved:
            return False
        if not subject.ob.evaluated_get(self.depsgraph).is_evaluated:
            why = "it is disabled in viewports, or is not in this view layer"
            raise rigid_bodies.refusal(subject.ob, moved, why, "enable it")
        if settled is not None and self.ob.type == "MESH":
            return True
        if rigid_bodies.move_alike(moved, alone, self.depsgraph, *subject):
            return False
        why = "they change its shape in a way that cannot be read"
        remedy = "go to the first frame of the simulation"
        raise rigid_bodies.refusal(subject.ob, moved, why, remedy)

    def go_back(self, copy: bpy.types.Object) -> None:
        """Evaluation has written animated values into the file: those of the private scene's
        frame.
        """
        if not self._is_of_another_frame():
            return
        self.scene.frame_float = self.depsgraph.scene.frame_float
        layer = self._layer()
        layer.update()
        if self.puts_back:
            _put_back(layer, self.depsgraph, copy, self.ob)

    def _is_of_another_frame(self) -> bool:
        return bool(self.scene.frame_float != self.depsgraph.scene.frame_float)

    def _layer(self) -> bpy.types.ViewLayer:
        return private_scene.layer(self.scene, self.depsgraph.view_layer)


def _put_back(
    layer: bpy.types.ViewLayer,
    shown: bpy.types.Depsgraph,
    copy: bpy.types.Object,
    ob: bpy.types.Object,
) -> bool:
    return animated_values.put_back(layer.depsgraph, shown, {copy: ob})


@contextmanager
def _copied(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    copy = copied_object.of(ob)
    try:
        yield copy
    finally:
        bpy.data.objects.remove(copy)


def check_modifiers(ob: bpy.types.Object, cut: int, shown: str = "show_viewport") -> None:
    """Raises CageError if one of the first `cut` modifiers that are enabled cannot be evaluated on
    a copy.
    """
    for modifier in ob.modifiers[:cut]:
        if not getattr(modifier, shown):
            continue
        if modifier.type == "MULTIRES":
            raise MultiresolutionError(
                f"{ob.name}: Multiresolution ({modifier.name}) is not supported: apply it or "
                "disable it"
            )
        if modifier.type in SIMULATIONS or (
            modifier.type == "NODES" and _has_simulation(modifier.node_group)
        ):
            raise CageError(
                f"{ob.name}: the simulation {modifier.name} stands before the subdivision, which "
                "is not supported: apply it, or bake it to a mesh cache"
            )


def _check_parent(ob: bpy.types.Object) -> None:
    """Raises NotNowError where the object's parent deforms it in a way that Blender does not keep
    up to date: it evaluates the object without waiting for the shape of the lattice, so that
    renders, the viewport and a file that is opened again show different shapes.
    """
    lattice = ob.parent if ob.parent_type == "LATTICE" else None
    if lattice is None:
        return
    changes = ["shape keys"] if lattice.data.shape_keys else []
    changes += [m.name for m in lattice.modifiers if m.show_viewport or m.show_render]
    if changes:
        raise NotNowError(
            f"{ob.name} is deformed by its parent, the lattice {lattice.name}, and Blender does "
            f"not keep up with what changes that lattice ({', '.join(changes)}): set Parent Type "
            f"to Object, and add a Lattice modifier to {ob.name} instead"
        )


def _has_simulation(group: bpy.types.NodeTree | None) -> bool:
    nodes = group.nodes if group else ()
    return any(
        node.bl_idname == "GeometryNodeSimulationOutput"
        or (node.bl_idname == "GeometryNodeGroup" and _has_simulation(node.node_tree))
        for node in nodes
    )


def _read_uv_map(ob: bpy.types.Object, mesh: bpy.types.Mesh) -> tuple[uv_map.UvMap | None, str]:
    """Returns the active UV map, or the reason why there is none."""
    active = ob.data.uv_layers.active
    if active is None:
        return None, ""
    reason = uv_map.obstacle(mesh, active.name)
    return (None, reason) if reason else (uv_map.read(mesh, active.name), "")
