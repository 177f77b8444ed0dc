# SPDX-License-Identifier: GPL-3.0-or-later
"""Alembic files that are rewritten: the same bytes each time, and nothing else has changed."""

import random

import bpy
import numpy as np
import pytest
import scenes
from bakes import read_back
from limit_surface.bake_frames import alembic_file
from limit_surface.errors import RefusalError
from limit_surface.reading import attributes

FLAG = bytes.fromhex("011c00000108") + b"meshtype"
FALSE = bytes.fromhex("b55cff6ee5ab10468335f878aa2d6251") + b"\x00"
FLAG_SIZE = 8 + len(FALSE)  # what a value takes that is not stored already
RUNS = 12


def export(path, ob):
    collection = bpy.data.collections.new("Export")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(ob)
    bpy.ops.wm.alembic_export(
        filepath=str(path), collection="Export", start=1, end=1, as_background_job=False
    )
    bpy.data.collections.remove(collection)
    return path.read_bytes()


def suzanne():
    ob = scenes.monkey()
    ob.parent = scenes.cross()
    ob["note"] = "a property of the user"
    ob.data["number"] = 3.5
    scenes.add_uv_map(ob, lambda p: p[:, :2])
    ob.data.materials.append(bpy.data.materials.new("Skin"))
    return ob


def hair():
    return scenes.add_hair(scenes.grid_with_holes(), per_side=3)


def points():
    return scenes.add_points(scenes.cross(), per_side=3)


@pytest.mark.parametrize("make", [suzanne, hair, points])
def test_the_same_object_gives_the_same_bytes(tmp_path, make):
    ob = make()
    path = tmp_path / "a.abc"
    noise = random.Random(1)
    kept, originals, found = [], set(), set()
    for _ in range(RUNS):
        # what lies in memory changes
        kept = [bytearray(noise.randrange(10, 500)) for _ in range(3000)] + kept[::2]
        originals.add(len(export(path, ob)))
        alembic_file.normalize(path)
        found.add(path.read_bytes())
    assert len(found) == 1
    (contents,) = found
    assert b"_ai_DateWritten=Thu Jan  1 00:00:00 1970;" in contents
    assert FALSE not in contents
    assert (FLAG in contents) == (ob.type == "MESH")
    assert {abs(len(contents) - size) for size in originals} <= {0, FLAG_SIZE}
    assert [file.name for file in tmp_path.iterdir()] == ["a.abc"]


@pytest.mark.parametrize(("make", "kind"), [(suzanne, "MESH"), (hair, "CURVES"), (points, "MESH")])
def test_the_contents_are_those_that_blender_wrote(tmp_path, make, kind):
    path = tmp_path / "a.abc"
    export(path, make())
    before = read_back(path, kind)
    alembic_file.normalize(path)
    np.testing.assert_array_equal(read_back(path, kind), before)


def test_maps_and_normals_are_kept(tmp_path):
    path = tmp_path / "a.abc"
    export(path, suzanne())

    def imported():
        bpy.ops.wm.alembic_import(filepath=str(path), as_background_job=False)
        (mesh,) = (ob.data for ob in bpy.context.selected_objects if ob.type == "MESH")
        corners = np.empty(len(mesh.loops) * 3, np.float32)
        mesh.corner_normals.foreach_get("vector", corners)
        maps = {layer.name: attributes.read(mesh, layer.name) for layer in mesh.uv_layers}
        return maps, corners

    maps, normals = imported()
    alembic_file.normalize(path)
    maps_after, normals_after = imported()
    assert len(maps) == 2
    assert maps.keys() == maps_after.keys()
    for name, values in maps.items():
        np.testing.assert_array_equal(maps_after[name], values)
    np.testing.assert_array_equal(normals_after, normals)


def test_objects_that_differ_have_other_digests(tmp_path):
    """Readers may take objects with the same digests for copies of each other."""
    path = tmp_path / "a.abc"
    ob = scenes.cross()
    found = []
    for height in (0, 1):
        ob.data.vertices[2].co.z = height
        export(path, ob)
        alembic_file.normalize(path)
        contents = path.read_bytes()
        end = contents.index(b"Cross", contents.index(FLAG)) + len(b"Cross")
        found.append(contents[end : end + 33])
    assert found[0] != found[1]


@pytest.mark.parametrize("size", [0, 5, 16, 300, -30])
def test_a_file_that_is_cut_off_is_refused(tmp_path, size):
    path = tmp_path / "a.abc"
    contents = export(path, scenes.cross())[:size]
    path.write_bytes(contents)
    with pytest.raises(RefusalError, match="incomplete Alembic file"):
        alembic_file.normalize(path)
    assert path.read_bytes() == contents
    assert [file.name for file in tmp_path.iterdir()] == ["a.abc"]


def test_another_format_is_refused(tmp_path):
    path = tmp_path / "a.abc"
    path.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    with pytest.raises(RefusalError, match="it is not in Ogawa format"):
        alembic_file.normalize(path)
