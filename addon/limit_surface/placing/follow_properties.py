# SPDX-License-Identifier: GPL-3.0-or-later
"""The property by which operators make what they place follow the surface."""

import bpy
from bpy.props import EnumProperty

from .. import ids
from ..nodes import groups
from ..reading import rules
from ..reading.modifier_kinds import DEFORMING_PARENTS
from . import render_faces

# Modifiers that leave the mesh as it is
_WITHOUT_EFFECT = {"PARTICLE_SYSTEM"}


_AUTO = (
    "AUTO",
    "Automatic",
    "Follow by nodes if shape keys, modifiers before the subdivision, an armature or animation can "
    "deform the mesh. Otherwise do not follow",
    0,
)
_NODES = (
    "NODES",
    "Nodes",
    "Follow by Geometry Nodes. This also works where this extension is not installed",
    1,
)
_NONE = ("NONE", "None", "Do not follow: stay in place when the mesh deforms", 2)
_LIVE = (
    "LIVE",
    "Live",
    "Let this extension move the object in each frame. This is faster for very many strands, but "
    "slower in scenes with very many objects. Creases may be animated",
    3,
)
_DESCRIPTION = "How the new object follows the surface when its mesh deforms"


class FollowProperties:
    """Mixin with the property `follow`, for objects that cannot follow live."""

    follow: EnumProperty(
        name="Follow", description=_DESCRIPTION, items=(_AUTO, _NODES, _NONE), default="AUTO"
    )


class FollowOrLiveProperties:
    """Mixin with the property `follow`, for hair and points."""

    follow: EnumProperty(
        name="Follow", description=_DESCRIPTION, items=(_AUTO, _NODES, _LIVE, _NONE), default="AUTO"
    )


class FollowSnappedProperties:
    """Mixin with the property `follow`, for things that are there already."""

    follow: EnumProperty(
        name="Follow",
        description="How snapped hair follows the surface when its mesh deforms. Hair that "
        "already follows continues to follow in the same way",
        items=(_AUTO, _NODES, _LIVE, _NONE),
        default="AUTO",
    )


def follows(follow: str, surface: bpy.types.Object) -> bool:
    """Tells whether things on a surface are to follow it by nodes, by the property's value."""
    if follow == "AUTO":
        return can_deform(surface) and not why_not_automatic(surface)
    return follow == "NODES"


def why_it_stays(follow: str, surface: bpy.types.Object) -> str:
    """Returns why things that were to follow by themselves where that is needed do not, or None."""
    is_needed = follow == "AUTO" and can_deform(surface)
    return why_not_automatic(surface) if is_needed else ""


def why_not_automatic(surface: bpy.types.Object) -> str:
    """Returns why things do not follow by themselves although the surface can deform, or None."""
    if not surface.is_editable:
        return f"{surface.name} is linked from another file"
    return rules.why_ambiguous(surface) or render_faces.why_different(
        surface, bpy.context.evaluated_depsgraph_get()
    )


def can_deform(surface: bpy.types.Object) -> bool:
    """Tells whether anything in the file can deform the surface's control mesh."""
    mesh, subsurf = surface.data, rules.find_subsurf(surface)
    before = surface.modifiers.find(subsurf.name) if subsurf else len(surface.modifiers)
    captures = list(groups.modifiers(surface, ids.CAPTURE_GROUP))
    return bool(
        mesh.shape_keys
        or mesh.animation_data
        or (surface.parent and surface.parent_type in DEFORMING_PARENTS)
        or any(
            (modifier.show_viewport or modifier.show_render)
            and modifier.type not in _WITHOUT_EFFECT
            and modifier not in captures
            for modifier in surface.modifiers[:before]
        )
    )
