# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversions while somebody waits: Blender stays usable between the pieces, and ESC leaves nothing
behind.

Blender calls these methods of the operators where there is a window; here a stand-in of plain
Python that has them is called instead.
"""

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import numpy as np
import particle_scenes
import pytest
import scenes
from limit_surface.errors import CancelledError
from limit_surface.particles import from_hair_operator, system, to_hair_operator
from limit_surface.tasks import watched_operator
from limit_surface.tasks.watched_operator import WatchedOperator
from stand_ins import event, window_context


def stand_in(cls, **properties):
    own = {name: value for name, value in vars(cls).items() if callable(value)}
    own |= {"cancelled": cls.cancelled, "report": MagicMock()}
    made = type("StandIn", (WatchedOperator,), own)()
    made.properties = SimpleNamespace(bl_rna=SimpleNamespace(properties=[]))
    for name, value in properties.items():
        setattr(made, name, value)
    return made


def to_particles(**properties):
    cls = from_hair_operator.OBJECT_OT_limit_particles_from_hair
    return stand_in(cls, **{"keys": 0, "levels": "VIEWPORT"} | properties)


def to_hair():
    cls = to_hair_operator.OBJECT_OT_limit_hair_from_particles
    return stand_in(cls, system="", snap_roots=True, follow="NONE")


@pytest.fixture
def hair(monkeypatch):
    """Adds hair, and has every piece of the work show its progress."""
    monkeypatch.setattr(system, "_LEAST_TIME", 0)
    monkeypatch.setattr(system, "_WORK_RATIO", 0)
    monkeypatch.setattr(system, "_PIECE", 10)
    monkeypatch.setattr(watched_operator, "PATIENCE", 0)
    monkeypatch.setattr(watched_operator, "TICK", 0.001)
    ob = scenes.cross()
    scenes.add_subsurf(ob).levels = 2
    return particle_scenes.add_hair(ob, per_side=8)


def test_pieces_by_the_timer(hair):
    ob, strands = hair.parent, particle_scenes.in_world(hair)
    operator, context = to_particles(), window_context()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    parts = [operator._job.part]
    while (result := operator.modal(context, event("TIMER"))) == {"RUNNING_MODAL"}:
        parts.append(operator._job.part)
        assert operator.modal(context, event("A")) == {"RUNNING_MODAL"}
        # what Blender draws between the pieces
        bpy.context.view_layer.update()
    assert result == {"FINISHED"}
    assert len(set(parts)) > 3
    assert parts == sorted(parts)
    context.workspace.status_text_set.assert_called_with(None)
    drawn = particle_scenes.drawn(ob)
    np.testing.assert_allclose(drawn, strands, atol=particle_scenes.bound(drawn))

    scenes.activate(ob)
    operator, context = to_hair(), window_context()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    while (result := operator.modal(context, event("TIMER"))) == {"RUNNING_MODAL"}:
        pass
    assert result == {"FINISHED"}
    back = particle_scenes.in_world(bpy.context.active_object)
    np.testing.assert_allclose(back, strands, atol=particle_scenes.bound(drawn))


@pytest.mark.parametrize("levels", ["VIEWPORT", "RENDER"])
def test_esc_takes_the_particles_back(hair, levels):
    ob, before = hair.parent, scenes.file_contents()
    operator, context = to_particles(levels=levels), window_context()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    operator.modal(context, event("TIMER"))
    job = operator._job
    assert 0 < job.part < 1
    assert len(ob.particle_systems) == 1
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    with pytest.raises(CancelledError):
        job.result()
    assert scenes.file_contents() == before
    assert ob.modifiers.keys() == ["Subdivision"]
    assert ob.modifiers[0].levels == 2
    assert "no particle system" in operator.report.call_args.args[1]


def test_esc_while_particles_are_read(hair):
    ob = hair.parent
    bpy.ops.object.limit_particles_from_hair()
    settings = ob.particle_systems[0].settings
    settings.display_percentage = 50
    scenes.activate(ob)
    before = scenes.file_contents()
    operator, context = to_hair(), window_context()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    operator.modal(context, event("TIMER"))
    assert operator.modal(context, event("ESC")) == {"CANCELLED"}
    assert settings.display_percentage == 50
    assert scenes.file_contents() == before
    assert "no hair" in operator.report.call_args.args[1]


@pytest.mark.parametrize("what", ["frame", "surface", "system"])
def test_what_changes_meanwhile_ends_the_work(hair, what):
    ob = hair.parent
    operator, context = to_particles(), window_context()
    operator.invoke(context, None)
    operator.modal(context, event("TIMER"))
    if what == "frame":
        context.scene.frame_set(7)
    elif what == "surface":
        bpy.data.objects.remove(ob)
    else:
        ob.modifiers.remove(ob.modifiers[-1])
    assert operator.modal(context, event("TIMER")) == {"CANCELLED"}
    kind, text = operator.report.call_args.args
    assert kind == {"ERROR"}
    assert {"frame": "frame", "surface": "not exist", "system": "no particle system"}[what] in text
    if what != "surface":
        assert not ob.particle_systems
