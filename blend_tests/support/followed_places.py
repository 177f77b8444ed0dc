# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether all that follows a surface is shown where it has to be: where its shape at rest goes when
its root goes to its location on the limit surface, as it is now.
"""

from collections.abc import Iterator

import bpy
import follow_truth
import limitsurf
import numpy as np
from limit_surface import ids, native
from limit_surface.errors import CageError
from limit_surface.placing import followers, following, live, live_attributes, live_kept
from limit_surface.placing.follow_state import State
from limit_surface.placing.places import NOWHERE, lacking, root_attributes
from limit_surface.reading import attributes, cage
from limitsurf import MeshError

#: As a share of the thing's extent and distance from the origin: the nodes' frames in single
#: precision have errors of up to 0.02 at rounded corners, and what an edit has moved away from its
#: root is turned by them. A frame or an edit moves things farther.
BOUND = 1e-2
#: Places at vertices are stored a little inside the face; at those of high valence positions change
#: quickly there.
ROOT_BOUND = 1e-4


def misplaced() -> list[str]:
    """Returns what is shown elsewhere although the extension does not say that anything is wrong.
    Of strands only the first points are looked at.
    """
    depsgraph = bpy.context.evaluated_depsgraph_get()
    wrong = []
    for surface, things, rest in [*_live(depsgraph), *_by_nodes()]:
        for ob in things:
            shown = _shown_alone(ob, depsgraph)
            if shown is None or lacking(ob.data, root_attributes(ob.data)):
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
            yield surface, [ob for ob in state.followers if ob.type != "CURVE"], ids.POSITION


def _shown_alone(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> np.ndarray | None:
    """Returns the points that are shown, if no other modifier moves them."""
    enabled = [modifier for modifier in ob.modifiers if modifier.show_viewport]
    evaluated = ob.evaluated_get(depsgraph)
    if not evaluated.is_evaluated or len(enabled) != 1:
        return None
    shown = attributes.read(evaluated.data, ids.POSITION)
    return shown if len(shown) == len(attributes.read(ob.data, ids.POSITION)) else None


def _error(
    ob: bpy.types.Object,
    surface: bpy.types.Object,
    limit: limitsurf.LimitSurface,
    rest_name: str,
    shown: np.ndarray,
) -> float:
    data = ob.data
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
    rest = _firsts(data, attributes.read(data, rest_name))[bound].astype(np.float64)
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
