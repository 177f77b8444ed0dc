# SPDX-License-Identifier: GPL-3.0-or-later
"""Sees when surfaces are not those any more to which things were bound.

Drawing must not change the file, but reading a control mesh changes it for a moment. A panel
therefore gets what is known already, and a timer looks a little later; the panel is drawn again
then. A file that is loaded is looked at once.
"""

from __future__ import annotations

import bpy

from .. import ids, native
from ..placing import following, live_kept, proxy, render_faces, seals, tables
from ..placing.follow_state import State, Trouble, surfaces
from ..placing.followers import live_modifier_of
from ..reading import cage
from ..tasks.object_keys import ObjectKey

# seconds until the timer looks
PAUSE = 0.2

_signatures: dict[ObjectKey, str] = {}  # those that are known, of surfaces as they are now
_others: dict[ObjectKey, list[Trouble]] = {}  # what else an evaluation has found
_asked: set[ObjectKey] = set()


def troubles(context: bpy.types.Context, state: State) -> list[Trouble]:
    """Returns what is known to have gone wrong, and has a timer look for what is not known yet."""
    key = ObjectKey.of(state.surface)
    is_playing = context.screen and context.screen.is_animation_playing
    if key not in _signatures and native.available() and not is_playing:
        _asked.add(key)
        if not bpy.app.timers.is_registered(_look):
            bpy.app.timers.register(_look, first_interval=PAUSE)
    return _known(state)


def _known(state: State) -> list[Trouble]:
    key = ObjectKey.of(state.surface)
    found = state.troubles(_signatures.get(key))
    # The operators that put these right make a proxy anew as well.
    named = {trouble.remedy for trouble in found if trouble.remedy}
    if ids.REBIND in named:
        named.add(ids.FOLLOW)
    others = [trouble for trouble in _others.get(key, ()) if trouble.remedy not in named]
    return [*found, *others]


def _look() -> None:
    """Is called by a timer."""
    for key in list(_asked):
        _asked.discard(key)
        _others.pop(key, None)
        try:
            surface, depsgraph = key.find(), bpy.context.evaluated_depsgraph_get()
            found = cage.read(surface, depsgraph)
            _signatures[key] = following.signature(found)
            _others[key] = _other_troubles(surface, found, depsgraph)
        except native.refusals:
            _signatures[key] = ""  # it is not known, and the panel shows what else is wrong
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _other_troubles(
    surface: bpy.types.Object, found: cage.Cage, depsgraph: bpy.types.Depsgraph
) -> list[Trouble]:
    state, table = State.of(surface), tables.of_surface(surface)
    troubles = []
    if table is not None:
        text = proxy.trouble_in(found, surface, table, depsgraph)
        troubles.append(Trouble(text, ids.FOLLOW))
    if state is not None:
        troubles.append(Trouble(render_faces.why_different(surface, depsgraph), ""))
    return [trouble for trouble in troubles if trouble.text]


@bpy.app.handlers.persistent
def _notice(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if _signatures and not cage.is_busy():
        for name in {update.id.name for update in depsgraph.updates if update.is_updated_geometry}:
            for key in [key for key in _signatures if key.name == name]:
                del _signatures[key]
                _others.pop(key, None)


@bpy.app.handlers.persistent
def _forget(*_arguments: object) -> None:
    _signatures.clear()
    _others.clear()
    _asked.clear()
    seals.forget()


@bpy.app.handlers.persistent
def _look_at_file(*_arguments: object) -> None:
    """Looks at what follows in a file that was loaded, and prints what is stale."""
    _forget()
    if not native.available():
        return
    if bpy.app.background:  # no timers run there
        _report()
    else:
        bpy.app.timers.register(_report, first_interval=0)


def _report() -> None:
    here = [surface for surface in surfaces() if surface.name in bpy.context.scene.objects]
    _asked.update(ObjectKey.of(surface) for surface in here)
    _look()
    for surface in here:
        state = State.of(surface)
        if state:
            for trouble in _known(state):
                print(f"Limit Surface: {trouble.text}")
    for ob in bpy.context.scene.objects:
        if live_modifier_of(ob):
            text = live_kept.trouble(ob) or live_kept.trouble_in_file(ob)
            if text:
                print(f"Limit Surface: {text}")


_HANDLERS = (
    (bpy.app.handlers.depsgraph_update_post, _notice),
    (bpy.app.handlers.undo_post, _forget),
    (bpy.app.handlers.redo_post, _forget),
    (bpy.app.handlers.load_post, _look_at_file),
)


def attach_handlers() -> None:
    for handlers, handler in _HANDLERS:
        handlers.append(handler)


def detach_handlers() -> None:
    _forget()
    for timer in (_look, _report):
        if bpy.app.timers.is_registered(timer):
            bpy.app.timers.unregister(timer)
    for handlers, handler in _HANDLERS:
        handlers.remove(handler)
