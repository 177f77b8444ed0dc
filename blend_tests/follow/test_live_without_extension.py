# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that change while the extension is not there: what follows them live is in its place
again as soon as it is.
"""

import bpy
import pytest
import scenes
from limit_surface.follow import handlers
from live_scenes import check_hair, deforming


@pytest.fixture
def changed():
    """Returns a surface that was changed without the extension, and hair that follows it live."""
    ob = deforming("cross")
    hair = scenes.add_hair(ob, follow="LIVE")
    check_hair(ob, hair)
    handlers.detach_handlers()
    ob.shape_key_clear()
    for vertex in ob.data.vertices:
        vertex.co *= 1.5
    ob.data.update()
    bpy.context.view_layer.update()
    with pytest.raises(AssertionError):
        check_hair(ob, hair)
    yield ob, hair
    if handlers._pose_file not in bpy.app.handlers.load_post:
        handlers.attach_handlers()


def test_a_file_is_posed_when_it_is_opened(changed, tmp_path):
    ob, hair = changed
    path, names = str(tmp_path / "a.blend"), (ob.name, hair.name)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    handlers.attach_handlers()
    bpy.ops.wm.open_mainfile(filepath=path)
    check_hair(*(bpy.data.objects[name] for name in names))


def test_an_open_file_is_posed_when_the_extension_comes(changed, monkeypatch):
    timers = []
    monkeypatch.setattr(handlers.bpy.app.timers, "register", lambda *a, **k: timers.append(a[0]))
    monkeypatch.setattr(handlers, "_in_background", lambda: False)
    handlers.attach_handlers()
    for timer in timers:
        assert timer() is None
    check_hair(*changed)
