# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the sidebar tab about what follows the active surface."""

import bpy

from .. import ids, native
from ..counting import by_count, counted
from ..placing import capture_place, live, live_kept
from ..placing.follow_state import State, Trouble
from ..placing.followers import (
    anything_follows,
    astray_from,
    is_astray,
    is_placed,
    live_followers_of,
    live_modifier_of,
    surface_of,
)
from ..tasks import wrapped_text
from . import stale


class VIEW3D_PT_limit_follow(bpy.types.Panel):
    bl_idname = ids.FOLLOW_PANEL
    bl_label = "Follow"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = ids.TAB
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        """Draws in the header, which is seen while the panel is closed, whether something is
        wrong.
        """
        if not anything_follows():
            return
        state, things = State.of(context.active_object), _live_things(context.active_object)
        wrong = len(stale.troubles(context, state)) if state else 0
        wrong += len(_live_troubles(things))
        if wrong:
            row = self.layout.row()
            row.alert = True
            row.label(text=counted(wrong, "problems"), icon="ERROR")

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        state = State.of(context.active_object)
        is_live = _draw_live(layout, context)
        if state is None and not is_live:
            wrapped_text.draw(layout, _rest(context.active_object), "INFO")
        elif state is not None:
            _draw_state(layout, state)
            for trouble in stale.troubles(context, state):
                _draw_trouble(layout, trouble)
        column = layout.column()
        column.enabled = native.available()
        for operator in (ids.FOLLOW, ids.REBIND, ids.UNBIND):
            column.operator(operator)


def _draw_live(layout: bpy.types.UILayout, context: bpy.types.Context) -> bool:
    """Draws what concerns live following, and returns whether the active object follows live, or
    something follows it live.
    """
    ob = context.active_object
    things = _live_things(ob)
    if not things:
        return False
    column = layout.column(align=True)
    surface = live.surface_of(ob) if things == [ob] else None
    if surface is not None:
        column.label(text=f"It follows {surface.name} live", icon="OBJECT_DATA")
    else:
        count = sum(not is_astray(thing) for thing in things)
        follow = counted(count, "objects", "follows", "follow")
        column.label(text=f"{follow} it live", icon="OBJECT_DATA")
    column.prop(context.scene, ids.LIVE)
    if waiting := next(filter(None, map(_edited_surface, things)), None):
        text = f"While {waiting.name} is in Edit Mode, what follows it live stays still"
        wrapped_text.draw(layout, text, "EDITMODE_HLT")
    for trouble in _live_troubles(things):
        _draw_trouble(layout, trouble)
    return True


def _live_things(ob: bpy.types.Object | None) -> list[bpy.types.Object]:
    """Returns the object itself if it follows a surface live, or what follows it live, or
    should.
    """
    if ob is None:
        return []
    if live.surface_of(ob) is not None:
        return [ob]
    return [*live_followers_of(ob), *filter(live_modifier_of, astray_from(ob))]


def _rest(ob: bpy.types.Object | None) -> str:
    """Returns what is said where nothing follows."""
    if ob is not None and is_placed(ob) and (surface := surface_of(ob)) is not None:
        return f"{ob.name} stands on {surface.name} and does not follow it"
    return "Nothing follows the active object"


def _edited_surface(thing: bpy.types.Object) -> bpy.types.Object | None:
    """Returns the surface that an object follows live, if the surface is in Edit Mode."""
    surface = live.surface_of(thing)
    return surface if surface is not None and surface.data.is_editmode else None


def _live_troubles(things: list[bpy.types.Object]) -> list[Trouble]:
    """Returns why things do not follow live, other than that their surface is in Edit Mode, and
    what makes them follow slowly.
    """
    still = [ob for ob in things if _edited_surface(ob) is None]
    found = [Trouble(live_kept.trouble(ob), live_kept.remedy(ob)) for ob in still]
    has_changed = {live.surface_of(ob) for ob in still if live_kept.remedy(ob) == ids.REBIND}
    for surface in dict.fromkeys(map(live.surface_of, still)):
        # with a state, it is named among the troubles of that
        if surface is not None and State.of(surface) is None:
            # where faces have changed, Follow refuses, and Rebind also does what it would do
            remedy = ids.REBIND if surface in has_changed else ids.FOLLOW
            found.append(Trouble(capture_place.obstacle(surface), remedy))
    return [trouble for trouble in found if trouble.text]


def _draw_state(layout: bpy.types.UILayout, state: State) -> None:
    column = layout.column(align=True)
    column.label(text=state.surface.name, icon="OBJECT_DATA")
    if state.followers or state.strays:
        objects = len(state.followers)
        column.label(text=f"{counted(objects, 'objects', 'follows', 'follow')} it by nodes")
        places = by_count(state.places, "strand or point", "strands and points")
        column.label(text=f"{state.places:,} {places}")
        column.label(text=f"Tables: {_size(state.table_bytes)}")
    if state.children:
        objects = len(state.children)
        grow = counted(objects, "objects", "grows", "grow")
        column.label(text=f"{grow} live children: {state.child_count:,}")
    if state.samples is not None:
        column.label(text=f"Tables for sampling: {_size(state.sample_bytes)}")


def _draw_trouble(layout: bpy.types.UILayout, trouble: Trouble) -> None:
    box = layout.box()
    wrapped_text.draw_alert(box, trouble.text)
    if not trouble.remedy:
        return
    row = box.row()
    row.enabled = native.available()
    row.operator(trouble.remedy)


def _size(count: int) -> str:
    power = min(max(len(str(count)) - 1, 0) // 3, 3)
    return f"{count / 1000**power:.3g} {('bytes', 'kB', 'MB', 'GB')[power]}"
