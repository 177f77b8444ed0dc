# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether all that follows a surface is shown where it has to be: where its shape at rest goes when
its root goes to its location on the limit surface, as it is now.
"""

from collections.abc import Iterator

import bpy
import children_truth
import follow_truth
import limitsurf
import numpy as np
from limit_surface import ids, native
from limit_surface.errors import CageError
from limit_surface.placing import (
    followers,
    following,
    live,
    live_attributes,
    live_children,
    live_kept,
)
from limit_surface.placing.follow_state import State
from limit_surface.placing.places import NOWHERE, lacking, root_attributes
from limit_surface.reading import attributes, cage, splines
from limitsurf import MeshError

#: As a share of the thing's extent and distance from the origin: the nodes' frames in single
#: precision have errors of up to 0.02 at rounded corners, and what an edit has moved away from its
#: root is turned by them. A frame or an edit moves things farther.
BOUND = 2e-2
#: Places at vertices are stored a little inside the face; at those of high valence positions change
#: quickly there.
ROOT_BOUND = 1e-4


def misplaced() -> list[str]:
    """Returns what is shown elsewhere although the extension does not say that anything is wrong.
    Of strands only the first points are looked at, but of live children all.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    wrong = [f"{ob.name}, {error:.2g} of its size" for ob, error in _grown() if error > BOUND]
    for surface, things, rest in [*_live(depsgraph), *_by_nodes()]:
        for ob in things:
            shown = _shown_alone(ob, depsgraph)
            holder = followers.holder_of(ob)
            if shown is None or holder is None or lacking(holder, root_attributes(holder)):
                continue
            try:
                limit = cage.read(surface, depsgraph).surface()
            except (CageError, MeshError):
                continue
            error = _error(ob, surface, limit, rest, shown)
            if error > BOUND:
                wrong.append(f"{ob.name} on {surface.name}, {error:.2g} of its size")
    return wrong


def are_elsewhere(ob: bpy.types.Object) -> bool:
    """Tells whether new things are not at the places on their surface that are stored for them."""
    surface = followers.surface_of(ob)
    if surface is None:  # a limit mesh that does not follow
        return False
    depsgraph = bpy.context.evaluated_depsgraph_get()
    limit = cage.read(surface, depsgraph).surface()
    face, uv = (attributes.read(ob.data, name) for name in (ids.FACE, ids.UV))
    matrix = follow_truth.relation(surface, ob)
    now = follow_truth.frames_at(limit, face, uv.astype(np.float64), matrix)
    root = attributes.read(ob.data, ids.REST_ROOT)
    point = _firsts(ob.data, attributes.read(ob.data, ids.POSITION))
    size = np.ptp(now.position, axis=0).max() + np.abs(now.position).max()
    error = max(np.abs(now.position - root).max(), np.abs(now.position - point).max())
    return bool(error > ROOT_BOUND * size)


def _live(
    depsgraph: bpy.types.Depsgraph,
) -> Iterator[tuple[bpy.types.Object, list[bpy.types.Object], str]]:
    for surface, things in live.followers_in(depsgraph).items():
        rest = live_attributes.rest_name(ids.POSITION)
        yield surface, [ob for ob in things if not live_kept.trouble(ob)], rest


def _by_nodes() -> Iterator[tuple[bpy.types.Object, list[bpy.types.Object], str]]:
    for surface in bpy.context.view_layer.objects:
        state = State.of(surface) if surface.type == "MESH" else None
        if not state or state.surface != surface:
            continue
        try:
            found = cage.read(surface, bpy.context.evaluated_depsgraph_get())
        except (CageError, *native.refusals):
            continue
        if not state.troubles(following.signature(found)):
            yield surface, list(state.followers), ids.POSITION


def _grown() -> Iterator[tuple[bpy.types.Object, float]]:
    """Yields live children that should grow, and how far any point is from where it has to be, as a
    share of their extent and distance from the origin.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for ob in bpy.context.view_layer.objects:
        surface = live_children.surface_of(ob)
        if surface is None or not ob.visible_get() or ob.library or _children_may_stop(ob, surface):
            continue
        limit = cage.read(surface, depsgraph).surface()
        guides = live_children.guides_of(ob)
        assert guides is not None
        expected = children_truth.expected(ob, guides, surface, limit)
        shown = children_truth.shown_strands(ob)
        if shown.shape != expected.shape:
            yield ob, np.inf
        elif len(shown):
            size = np.ptp(expected, axis=(0, 1)).max() + np.abs(expected).max()
            yield ob, float(np.abs(shown - expected).max() / size)


def _children_may_stop(ob: bpy.types.Object, surface: bpy.types.Object) -> bool:
    """Tells whether the extension says that the children do not grow, or nothing is to be grown."""
    state = State.of(surface)
    try:
        found = cage.read(surface, bpy.context.evaluated_depsgraph_get())
    except (CageError, *native.refusals):
        return True
    guides = live_children.guides_of(ob)
    return (
        state is None
        or any(state.troubles(following.signature(found)))
        or guides is None
        or not guides.visible_get()
        or bool(lacking(guides.data, root_attributes(guides.data)))
        or len(ob.modifiers) != 1
    )


def _shown_alone(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray | None:
    """Returns the points that are shown, if no other modifier moves them."""
    enabled = [modifier for modifier in ob.modifiers if modifier.show_viewport]
    evaluated = ob.evaluated_get(depsgraph)
    if not evaluated.is_evaluated or len(enabled) != 1:
        return None
    if ob.type == "CURVE":
        shown = attributes.read(evaluated.to_mesh(), ids.POSITION)
        evaluated.to_mesh_clear()
    else:
        shown = attributes.read(evaluated.data, ids.POSITION)
    return shown if len(shown) == len(_points(ob, ids.POSITION)) else None


def _points(ob: bpy.types.Object, name: str) -> np.ndarray:
    """Returns the points of the object itself; of Curve objects the control points."""
    if ob.type == "CURVE":
        return splines.positions(ob.data)
    return attributes.read(ob.data, name)


def _error(
    ob: bpy.types.Object,
    surface: bpy.types.Object,
    limit: limitsurf.LimitSurface,
    rest_name: str,
    shown: np.ndarray,
) -> float:
    data = followers.holder_of(ob)
    face, rotation = attributes.read(data, ids.FACE), attributes.read(data, ids.REST_ROTATION)
    bound = (face != NOWHERE) & rotation.any(axis=1)
    # strands that were added or joined later stay still until they are bound
    bound &= (
        attributes.read(data, ids.TILE if rest_name == ids.POSITION else ids.LIVE_FINGERPRINT) != 0
    )
    if not bound.any():
        return 0.0
    uv = attributes.read(data, ids.UV)[bound].astype(np.float64)
    now = follow_truth.frames_at(limit, face[bound], uv, follow_truth.relation(surface, ob))
    rest = _firsts(data, _points(ob, rest_name))[bound].astype(np.float64)
    before = follow_truth.Frames(
        attributes.read(data, ids.REST_ROOT)[bound].astype(np.float64),
        follow_truth.matrices(rotation[bound]),
    )
    expected = follow_truth.carried(rest[:, None], before, now)[:, 0]
    size = np.ptp(expected, axis=0).max() + np.abs(expected).max()
    error = np.abs(_firsts(data, shown)[bound] - expected).max()
    return float(error / size) if size else float(error)


def _firsts(data: bpy.types.ID, values: np.ndarray) -> np.ndarray:
    if isinstance(data, bpy.types.Curves):
        return values[attributes.curve_offsets(data)[:-1]]
    return values
