# SPDX-License-Identifier: GPL-3.0-or-later
"""Random sequences of what an artist does: nothing crashes, nothing is left behind, and undo and
redo restore everything, and what follows is in its place. A seed that fails here fails again:
`support/random_steps.py SEED STEPS FOLDER` or `support/random_following.py` repeats it.
"""

import subprocess
import sys
from pathlib import Path

import bpy
import pytest
import scenes
from limit_surface import ids
from limit_surface.nodes import groups
from processes import ROOT

FEW, MANY = 60, 250
LINES_SHOWN = 40


@pytest.mark.parametrize(
    ("seed", "steps"), [(1, FEW), *scenes.slow(*((seed, MANY) for seed in range(100, 140)))]
)
def test_random_steps(seed, steps, tmp_path):
    run("random_steps.py", seed, steps, tmp_path)


@pytest.mark.parametrize(
    ("seed", "steps"), [(1, FEW), *scenes.slow(*((seed, MANY) for seed in range(2, 22)))]
)
def test_what_follows_is_always_in_its_place(seed, steps, tmp_path):
    run("random_following.py", seed, steps, tmp_path)


def run(program: str, seed: int, steps: int, folder: Path) -> None:
    done = subprocess.run(
        [sys.executable, ROOT / "blend_tests/support" / program, str(seed), str(steps), folder],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=1200,
    )
    end = "\n".join(done.stdout.splitlines()[-LINES_SHOWN:])
    assert done.returncode == 0, end
    assert "all steps done" in end


def test_limit_mesh_of_a_mesh_with_locations_on_faces():
    """Such meshes exist: the table of all tiles of a surface is one."""
    ob = scenes.cross()
    ob.data.attributes.new(ids.FACE, "INT", "FACE")
    bpy.ops.object.limit_mesh(levels=1, store_locations=True)
    made = bpy.context.object.data
    assert made.attributes[ids.FACE].domain == "POINT"
    assert ob.data.attributes[ids.FACE].domain == "FACE"


def test_an_attribute_of_the_user_is_kept():
    ob = scenes.cross()
    ob.data.attributes.new(ids.REST_ROOT, "INT", "FACE")
    bpy.ops.object.limit_mesh(levels=1, store_locations=True)
    theirs, ours = (each.data.attributes[ids.REST_ROOT] for each in (ob, bpy.context.object))
    assert (theirs.data_type, theirs.domain) == ("INT", "FACE")
    assert (ours.data_type, ours.domain) == ("FLOAT_VECTOR", "POINT")


def test_a_curve_with_another_parent_is_refused_before_it_changes():
    parent = scenes.cross()
    bpy.ops.curve.primitive_bezier_curve_add()
    curve = bpy.context.object
    curve.parent = parent
    other = scenes.grid_with_holes()
    curve.select_set(True)
    before = scenes.file_contents()
    with pytest.raises(RuntimeError, match="belongs to Cross, its parent, and not to Holes"):
        bpy.ops.object.limit_follow()
    assert scenes.file_contents() == before
    assert not curve.modifiers
    assert not other.modifiers


def test_unbinding_after_the_modifier_of_a_hidden_table_was_removed():
    scenes.cross()
    bpy.ops.object.limit_hair_add(per_side=2, follow="NODES")
    removed = 0
    for ob in bpy.data.objects:
        for modifier in list(groups.modifiers(ob, ids.TILES_GROUP)):
            ob.modifiers.remove(modifier)
            removed += 1
    assert removed
    assert bpy.ops.object.limit_unbind() == {"FINISHED"}


def test_hair_on_a_surface_that_was_linked_for_something_else(tmp_path):
    """Blender itself does not save such a parent: nothing counts it as used."""
    scenes.cross()
    bpy.ops.object.limit_points_add(per_side=2, follow="NONE")
    points = bpy.context.object.name
    library, file = str(tmp_path / "library.blend"), str(tmp_path / "file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=library, copy=True)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(library, link=True) as (_, linked):
        linked.objects = [points]
    bpy.context.collection.objects.link(linked.objects[0])
    linked.objects[0].select_set(True)
    bpy.context.view_layer.objects.active = linked.objects[0]
    bpy.ops.ed.undo_push(message="link")
    assert bpy.ops.object.limit_hair_add("EXEC_DEFAULT", True, per_side=2, follow="NONE") == {
        "FINISHED"
    }
    hair, surface = bpy.context.object.name, bpy.context.object.parent.name
    bpy.ops.ed.undo()
    bpy.ops.ed.redo()
    assert bpy.data.objects[hair].parent == bpy.data.objects[surface]
    assert bpy.data.objects[hair].data.surface == bpy.data.objects[surface]
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    assert bpy.data.objects[hair].parent == bpy.data.objects[surface]
    assert bpy.data.objects[hair].data.surface == bpy.data.objects[surface]


def test_hair_on_a_linked_surface_that_nothing_else_uses_any_more(tmp_path):
    surface = scenes.cross().name
    library, file = str(tmp_path / "library.blend"), str(tmp_path / "file.blend")
    bpy.ops.wm.save_as_mainfile(filepath=library, copy=True)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(library, link=True) as (_, linked):
        linked.objects = [surface]
    (ob,) = linked.objects
    bpy.context.collection.objects.link(ob)
    hair = scenes.add_hair(ob, follow="NONE").name
    bpy.context.collection.objects.unlink(ob)
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    assert bpy.data.objects[hair].parent == bpy.data.objects[surface]
    assert bpy.data.objects[hair].data.surface == bpy.data.objects[surface]
