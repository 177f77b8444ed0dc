# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator on damaged scenes: it either works, or says in a sentence why it cannot, and
leaves the file as it was.
"""

import re
import warnings
from pathlib import Path

import bpy
import damage
import pytest
import scenes
import stages
from contents import digest
from damage_kinds import Damage, DoesNotApplyError

DAMAGES: list[tuple[str, str, Damage]] = list(damage.all_cases())
#: Of a stage's damages one in so many is tried in each run, and all of them in slow ones.
FEW = 24
LONGEST = 500
#: What messages of programs look like
NOT_PLAIN = re.compile(
    r"Traceback|bpy\.ops|bpy_|NoneType|ndarray|numpy|dtype|\w+Error\b|object at 0x|\barray\("
    r"|\b[Rr]ow \d+:|^[A-Z][a-z]+_[a-z]+ (is|has)\b"
)
FIRST = re.compile(r"[A-Z0-9_']")

#: What ended in a traceback, or changed the file, once
FOUND = {
    ("lay", "thing nothing in it"),
    ("lay", "surface all points at one"),
    ("attach", "thing at NaN"),
    ("follow strange hair", "thing scale 0"),
    ("hair", "surface scale NaN"),
    ("hair border", "surface scale 0"),
    ("show", "surface scale 0"),
    ("project camera", "surface at 1e30"),
    ("project planar", "thing at 1e30"),
    ("limit mesh", "surface groups with taken names"),
    ("follow points", "thing multires"),
    ("follow curve", "thing a point at NaN"),
    ("unbind", "file groups emptied"),
    ("unbind", "thing attributes of another type"),
    ("unbind live", "thing attributes of another type"),
    ("unbind live", "surface edit mode"),
    ("unbind children", "thing names taken"),
    ("rebind", "thing attributes NaN"),
    ("rebind uv", "thing attributes NaN"),
    ("rebind uv", "thing nothing in it"),
    ("rebind children", "surface removed"),
    ("particles", "surface all points huge"),
    # ended after minutes
    ("children", "surface a point at 1e30"),
    ("children parted", "surface a point at 1e30"),
    ("rebind children", "surface all points at 1e30"),
}
#: What takes minutes: closest points where nothing has an extent beside rounding
TOO_SLOW = {
    ("report", "surface all points at 1e30"),
    ("show", "surface all points at 1e30"),
}


def cases():
    for number, stage in enumerate(stages.STAGES):
        every = [each for each in DAMAGES if (stage, f"{each[0]} {each[1]}") not in TOO_SLOW]
        sample = every[number % FEW :: FEW]
        sample += [each for each in every if (stage, f"{each[0]} {each[1]}") in FOUND]
        yield pytest.param(stage, sample, id=stage)
        yield pytest.param(stage, every, id=f"{stage}, all", marks=pytest.mark.slow)


@pytest.mark.parametrize("name", stages.STAGES)
def test_every_stage_works_undamaged(name):
    stages.STAGES[name].build()
    assert stages.STAGES[name].run() == {"FINISHED"}


@pytest.mark.parametrize(("name", "damages"), list(cases()))
def test_nothing_but_a_sentence(name, damages, tmp_path, capfd):
    wrong = []
    for i, (what, how, harm) in enumerate(damages):
        said = tried(stages.STAGES[name], what, harm, tmp_path / str(i))
        printed = capfd.readouterr().err  # by handlers, whose errors nothing else shows
        if said or "Traceback" in printed:
            wrong.append(f"{what} {how}: {said or printed[-LONGEST:]}")
    assert not wrong, "\n".join(wrong)


def tried(stage: stages.Stage, what: str, harm: Damage, folder: Path) -> str:
    """Returns what is wrong with what the operator did on one damaged scene, or nothing."""
    folder.mkdir()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = stage.build()
    damaged = scene.thing if what == "thing" else scene.surface
    if damaged is None:
        return ""
    try:
        harm(damaged, folder)
    except DoesNotApplyError:
        return ""
    bpy.context.view_layer.update()
    before = state()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # numpy's, of numbers that are not finite
            result = stage.run()
    except RuntimeError as error:
        after = state()
        changed = [key for key in {**before, **after} if before.get(key) != after.get(key)]
        return why_not_plain(str(error)) or (f"{error} changed {changed}" if changed else "")
    except Exception as error:  # what is wrong is shown with the scene
        return repr(error)
    return "" if result == {"FINISHED"} else f"returned {result}"


def why_not_plain(message: str) -> str:
    """Returns a message that no user would understand, or nothing."""
    sentence = re.sub(r"^(Error: |Operator bpy\.ops\.[\w.]+\(\) )", "", message.strip())
    is_plain = len(sentence) <= LONGEST and FIRST.match(sentence) and not NOT_PLAIN.search(sentence)
    return "" if is_plain else message[-LONGEST:]


def state() -> dict[str, str]:
    """Returns what the file contains, what is selected, and in which mode Blender is."""
    layer = bpy.context.view_layer
    active = layer.objects.active
    found = digest() | {
        "names": scenes.file_contents(),
        "active": active.name_full if active else "",
        "selected": sorted(ob.name_full for ob in layer.objects if ob.select_get()),
        "mode": bpy.context.mode,
        "frame": bpy.context.scene.frame_current_final,
    }
    return {key: repr(value) for key, value in found.items()}  # NaN does not equal itself
