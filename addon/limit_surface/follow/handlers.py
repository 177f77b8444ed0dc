# SPDX-License-Identifier: GPL-3.0-or-later
"""The handlers by which things follow live, and the property of scenes that switches them off."""

import threading

import bpy
from bpy.props import BoolProperty

from .. import ids, native
from ..placing import live, live_kept
from ..reading import cage, private_scene

# While a render engine asks for frames in a thread of its own, artists may change the scene.
_lock = threading.RLock()


def _has_work(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> bool:
    # The viewport is posed again when the exporter has finished.
    is_behind_exporter = private_scene.is_barred() and depsgraph.mode == "VIEWPORT"
    is_free = not cage.is_busy() and not is_behind_exporter
    return native.available() and is_free and live.is_enabled(scene)


@bpy.app.handlers.persistent
def _pose_frame(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if _has_work(scene, depsgraph):
        with _lock:
            live.pose_all(depsgraph)


@bpy.app.handlers.persistent
def _pose_change(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if _has_work(scene, depsgraph) and _lock.acquire(blocking=False):
        try:
            live.pose_changed(depsgraph)
        finally:
            _lock.release()


@bpy.app.handlers.persistent
def _forget(*_arguments: object) -> None:
    with _lock:
        live_kept.forget()


@bpy.app.handlers.persistent
def _forget_after_undo(*_arguments: object) -> None:
    with _lock:
        live_kept.forget_after_undo()


@bpy.app.handlers.persistent
def _pose_file(*_arguments: object) -> None:
    """Poses what a file holds: surfaces may have changed while the extension was not there."""
    _forget()
    _pose_present()


def _pose_present() -> None:
    """Is also called by a timer."""
    if native.available() and bpy.context.scene is not None:
        _pose_frame(bpy.context.scene, bpy.context.evaluated_depsgraph_get())


def _in_background() -> bool:
    return bool(bpy.app.background)


def _switched(_scene: bpy.types.Scene, context: bpy.types.Context) -> None:
    _forget()
    if context.scene == _scene and live.is_enabled(_scene):
        _pose_frame(_scene, context.evaluated_depsgraph_get())


_HANDLERS = (
    (bpy.app.handlers.frame_change_post, _pose_frame),
    (bpy.app.handlers.depsgraph_update_post, _pose_change),
    (bpy.app.handlers.undo_post, _forget_after_undo),
    (bpy.app.handlers.redo_post, _forget_after_undo),
    (bpy.app.handlers.load_post, _pose_file),
)


def attach_handlers() -> None:
    setattr(
        bpy.types.Scene,
        ids.LIVE,
        BoolProperty(
            name="Live Following",
            description="Let this extension move the things that follow a limit surface in the "
            "mode Live. While this is off, they stay where they are",
            default=True,
            update=_switched,
        ),
    )
    for handlers, handler in _HANDLERS:
        handlers.append(handler)
    if not _in_background():  # no timers run there
        # While the extension is being enabled, Blender's data may not be read.
        bpy.app.timers.register(_pose_present, first_interval=0)


def detach_handlers() -> None:
    if bpy.app.timers.is_registered(_pose_present):
        bpy.app.timers.unregister(_pose_present)
    for handlers, handler in _HANDLERS:
        handlers.remove(handler)
    delattr(bpy.types.Scene, ids.LIVE)
    live_kept.forget()
