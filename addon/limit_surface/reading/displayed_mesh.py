# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh that Blender shows of an object, and places of the limit surface on it.

It is Blender's own mesh right behind the Subdivision Surface modifier whose rules the limit surface
follows, as the viewport shows it, as a render does, or at any other level: evaluated in a private
scene with everything that the user has set. Modifiers behind it are ignored, as they are for the
cage.

    shown = displayed_mesh.read(ob, depsgraph, cage.read(ob, depsgraph), "VIEWPORT")
    shown.positions(face, uv)  # (n, 3), on the triangles that are drawn, in the object's space
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal, Protocol

import bpy
import numpy as np

from .. import ids
from ..counting import counted
from ..errors import DisplayedError
from . import attributes, cage, copied_object, rules, subdivided_mesh
from .triangulation import TriangulatedQuads

Kind = Literal["VIEWPORT", "RENDER"] | int


class ModifierSetup(Protocol):
    """Settings of the Subdivision Surface modifier that an object does not have yet."""

    def apply(self, ob: bpy.types.Object) -> bpy.types.SubsurfModifier: ...
    def holds(self, subsurf: bpy.types.SubsurfModifier) -> bool: ...


_CALLED = {"VIEWPORT": "the mesh that the viewport shows", "RENDER": "the mesh that a render shows"}


class DisplayedMesh:
    """A mesh that Blender shows. Locations are those of the limit surface: Ptex faces (n,), and uv
    (n, 2) in [0, 1].
    """

    def __init__(self, level: int, face_sizes: np.ndarray, quads: TriangulatedQuads) -> None:
        self.level = level  # 0: the cage itself
        self.quads = quads
        self._finder = subdivided_mesh.PolygonFinder(face_sizes, level) if level else None

    def positions(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Returns positions (n, 3) on the triangles that renderers draw."""
        return self.quads.positions(*self._find(face, uv))

    def frames(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Returns rotations (n, 3, 3) of the triangles with the columns tangent (along u), normal x
        tangent and flat normal. They are always finite.
        """
        return self.quads.frames(*self._find(face, uv))

    def vertices(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Returns the vertices (n,) at locations where there is one."""
        return self.quads.vertices_at(*self._find(face, uv))

    def are_flipped(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Tells for each location (n,) whether the polygons there are cut from their second corner
        to the last.
        """
        return self.quads.flipped[self._find(face, uv)[0]]

    def _find(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        face, uv = np.asarray(face), np.asarray(uv, np.float64)
        return self._finder.find(face, uv) if self._finder else (face, uv)


def read(
    ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, found: cage.Cage, kind: Kind
) -> DisplayedMesh:
    """Reads the mesh at the depsgraph's frame, for a cage that was read there. Raises RefusalError
    where its polygons are not those of the subdivided cage.
    """
    with opened(ob, depsgraph, kind) as (mesh, level, whose):
        return _read_mesh(whose, mesh, found, level)


def read_as_set_up(
    ob: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    found: cage.Cage,
    setup: ModifierSetup,
) -> DisplayedMesh:
    """Reads the mesh that the viewport will show once the modifier is set up, for a cage that was
    read before. The object itself is left as it is.
    """
    subsurf = rules.find_subsurf(ob)
    cut = ob.modifiers.find(subsurf.name) + 1 if subsurf else len(ob.modifiers)

    def adjust(copy: bpy.types.Object, scene: bpy.types.Scene) -> None:
        _carry_simplify(depsgraph.scene, scene, "VIEWPORT")
        setup.apply(copy)

    settled = rules.place_of_subsurf(ob)
    with cage.evaluated_copy(ob, cut, depsgraph, adjust, settled=settled) as evaluated:
        modifier = evaluated.modifiers[-1]
        if not setup.holds(modifier):
            raise DisplayedError(
                f"{ob.name}: the settings of {modifier.name} are animated or driven, so that they "
                "cannot be changed"
            )
        level = _level(modifier, depsgraph.scene, "VIEWPORT")
        return _read_mesh(f"{ob.name}: {_CALLED['VIEWPORT']}", evaluated.data, found, level)


def warning_of_renders(ob: bpy.types.Object) -> str:
    """Returns a warning where modifiers before the subdivision are enabled in renders only, or in
    the viewport only, or nothing. The limit surface is always that of the viewport.
    """
    before = ob.modifiers[: rules.place_of_subsurf(ob)]
    names = [m.name for m in before if m.show_viewport != m.show_render]
    if not names:
        return ""
    return (
        f"Renders do not show the same control mesh as the viewport, to which the limit surface "
        f"belongs: enable these modifiers of {ob.name} in both, or in neither: {', '.join(names)}"
    )


@contextmanager
def opened(
    ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph, kind: Kind
) -> Iterator[tuple[bpy.types.Mesh, int, str]]:
    """Yields Blender's own mesh, which lasts as long as the context, its level, and its name for
    messages.
    """
    subsurf = _subsurf(ob, kind)
    cut = ob.modifiers.find(subsurf.name) + 1 if subsurf else len(ob.modifiers)
    if kind == "RENDER":
        _check_dicing(ob, subsurf, depsgraph.scene)
        cage.check_modifiers(ob, cut - 1 if subsurf else cut, "show_render")

    def adjust(copy: bpy.types.Object, scene: bpy.types.Scene) -> None:
        _carry_simplify(depsgraph.scene, scene, kind)
        _show(copy, subsurf.name if subsurf else "", kind)

    settled = rules.place_of_subsurf(ob)
    with cage.evaluated_copy(ob, cut, depsgraph, adjust, settled=settled) as evaluated:
        whose = f"{ob.name}: {_called(kind)}"
        modifier = evaluated.modifiers[subsurf.name] if subsurf else None
        _check_settings(whose, evaluated, modifier, kind)
        yield evaluated.data, _level(modifier, depsgraph.scene, kind), whose


def _subsurf(ob: bpy.types.Object, kind: Kind) -> bpy.types.SubsurfModifier | None:
    """Returns the modifier whose rules the limit surface follows. It may be disabled in the
    viewport and enabled in renders.
    """
    subsurf = rules.find_subsurf(ob)
    if subsurf is None and kind == "RENDER":
        return next((m for m in ob.modifiers if m.type == "SUBSURF" and m.show_render), None)
    if subsurf is None and not isinstance(kind, str):
        raise DisplayedError(
            f"{ob.name} has no Subdivision Surface modifier whose level could be set"
        )
    return subsurf


def _check_dicing(
    ob: bpy.types.Object, subsurf: bpy.types.SubsurfModifier | None, scene: bpy.types.Scene
) -> None:
    """Raises RefusalError where Cycles would ignore the modifier and subdivide by itself, depending
    on the camera.
    """
    if subsurf is None or scene.render.engine != "CYCLES" or ob.modifiers[-1] != subsurf:
        return
    if hasattr(subsurf, "use_adaptive_subdivision"):  # from Blender 5.0 on
        dices = subsurf.use_adaptive_subdivision
    else:
        dices = (
            getattr(getattr(scene, "cycles", None), "feature_set", "") == "EXPERIMENTAL"
            and ob.cycles.use_adaptive_subdivision
        )
    if dices and subsurf.show_render:
        raise DisplayedError(
            f"{ob.name} is rendered with adaptive subdivision, so only Cycles knows the "
            "polygons: turn it off, or measure the mesh of the viewport"
        )


def _carry_simplify(scene: bpy.types.Scene, private: bpy.types.Scene, kind: Kind) -> None:
    private.render.use_simplify = scene.render.use_simplify and isinstance(kind, str)
    private.render.simplify_subdivision = _simplify(scene, kind)


def _simplify(scene: bpy.types.Scene, kind: Kind) -> int:
    if kind == "RENDER":
        return scene.render.simplify_subdivision_render
    return scene.render.simplify_subdivision


def _show(copy: bpy.types.Object, subsurf: str, kind: Kind) -> None:
    """Sets the modifier up so that the viewport shows what is asked for."""
    if kind == "RENDER":
        copied_object.show_as_rendered(copy)
        if subsurf:
            copy.modifiers[subsurf].levels = copy.modifiers[subsurf].render_levels
    elif kind != "VIEWPORT":
        copy.modifiers[subsurf].levels = kind


def _check_settings(
    whose: str,
    evaluated: bpy.types.Object,
    subsurf: bpy.types.SubsurfModifier | None,
    kind: Kind,
) -> None:
    """Raises RefusalError where animation or drivers have overridden these settings."""
    animated = [
        m.name for m in evaluated.modifiers if kind == "RENDER" and m.show_viewport != m.show_render
    ]
    if subsurf and kind != "VIEWPORT" and subsurf.levels != _wanted_levels(subsurf, kind):
        animated.append(subsurf.name)
    if animated:
        raise DisplayedError(
            f"{whose} cannot be measured, because levels or visibility of "
            f"{', '.join(animated)} are animated or driven: remove the animation, or measure "
            "the mesh of the viewport"
        )


def _wanted_levels(subsurf: bpy.types.SubsurfModifier, kind: Kind) -> int:
    if kind == "VIEWPORT":
        return subsurf.levels
    return subsurf.render_levels if kind == "RENDER" else kind


def _level(subsurf: bpy.types.SubsurfModifier | None, scene: bpy.types.Scene, kind: Kind) -> int:
    if subsurf is None or not subsurf.show_viewport:
        return 0
    simplified = scene.render.use_simplify and isinstance(kind, str)
    levels = _wanted_levels(subsurf, kind)
    return min(levels, _simplify(scene, kind)) if simplified else levels


def _read_mesh(whose: str, mesh: bpy.types.Mesh, found: cage.Cage, level: int) -> DisplayedMesh:
    sizes = attributes.face_sizes(mesh)
    corner_vertex = attributes.read(mesh, ids.CORNER_VERTEX)
    triangles = _triangles(mesh)
    vertices = attributes.read(mesh, ids.POSITION).astype(np.float64)
    if level:
        expected = np.full(subdivided_mesh.polygon_counts(found.face_sizes, level).sum(), 4)
    else:
        expected = found.face_sizes
    if not np.array_equal(sizes, expected):
        raise DisplayedError(
            f"{whose} has {counted(len(sizes), 'polygons')}, which are not those of the control "
            f"mesh's {counted(len(found.face_sizes), 'faces')} at level {level}"
        )
    if level:
        quads = TriangulatedQuads.from_triangles(vertices, corner_vertex.reshape(-1, 4), triangles)
    else:
        quads = TriangulatedQuads.from_polygons(vertices, corner_vertex, sizes, triangles)
    shown = DisplayedMesh(level, found.face_sizes, quads)
    _check_corners(whose, shown, found)
    return shown


def _triangles(mesh: bpy.types.Mesh) -> np.ndarray:
    """Returns corners (n, 3) of the triangles, polygon by polygon."""
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    return corners.reshape(-1, 3)


def _check_corners(whose: str, shown: DisplayedMesh, found: cage.Cage) -> None:
    """Checks that the faces' corners have the cage's vertices. Blender keeps these in order, and
    before all other vertices.
    """
    at = subdivided_mesh.cage_corners(found.face_sizes)
    if not np.array_equal(shown.vertices(*at), found.mesh.face_vertices):
        raise DisplayedError(
            f"{whose} does not have the control mesh's vertices at the corners of its faces"
        )


def _called(kind: Kind) -> str:
    return _CALLED[kind] if isinstance(kind, str) else f"the mesh of level {kind}"
