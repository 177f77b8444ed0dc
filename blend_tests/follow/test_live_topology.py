# SPDX-License-Identifier: GPL-3.0-or-later
"""Live following while somebody changes the faces of the surface."""

import bmesh
import bpy
import follow_truth
import numpy as np
import pytest
import scenes
from limit_surface import ids
from limit_surface.placing import live_kept
from limit_surface.reading import attributes
from live_scenes import check_hair, follow


def rebuilt(mesh: bpy.types.Mesh, faces: np.ndarray) -> None:
    """Gives the mesh these quads, and keeps all other edges."""
    edited = bmesh.new()
    edited.from_mesh(mesh)
    bmesh.ops.delete(edited, geom=list(edited.faces), context="FACES_ONLY")
    edited.verts.ensure_lookup_table()
    for face in faces:
        edited.faces.new([edited.verts[i] for i in face])
    edited.to_mesh(mesh)
    edited.free()
    mesh.update_tag()
    bpy.context.view_layer.update()


def bumpy_grid() -> tuple[bpy.types.Object, np.ndarray]:
    ob = scenes.flat_grid(4)
    positions = attributes.read(ob.data, ids.POSITION)
    positions[:, 2] = np.sin(positions[:, 0]) * np.cos(2 * positions[:, 1])
    attributes.write(ob.data, ids.POSITION, "FLOAT_VECTOR", "POINT", positions)
    return ob, attributes.read(ob.data, ids.CORNER_VERTEX).reshape(-1, 4)


@pytest.mark.skipif(bpy.app.version < (4, 3), reason="Python cannot delete strands before 4.3")
def test_a_face_is_deleted_whose_edges_stay():
    ob, faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    deleted = 5  # it has four neighbours; the faces before it keep their numbers
    after = attributes.read(hair.data, ids.FACE) >= deleted
    hair.data.remove_curves(indices=np.flatnonzero(after).tolist())
    bpy.context.view_layer.update()
    edges = len(ob.data.edges)
    before = follow_truth.shown_strands(hair).copy()
    rebuilt(ob.data, np.delete(faces, deleted, axis=0))
    assert len(ob.data.edges) == edges
    assert np.abs(follow_truth.shown_strands(hair) - before).max() > 1e-3  # the border is nearer
    check_hair(ob, hair)


def test_faces_are_turned_over():
    ob, faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    rebuilt(ob.data, faces[:, ::-1])
    check_hair(ob, hair)


def test_hair_follows_as_soon_as_its_faces_are_there_again():
    ob, faces = bumpy_grid()
    hair = scenes.add_hair(ob, follow="NONE", per_side=2)
    follow(hair)
    rebuilt(ob.data, faces[:8])
    assert "Ptex faces" in live_kept.trouble(hair)
    rebuilt(ob.data, faces)
    assert live_kept.trouble(hair) == ""
    check_hair(ob, hair)
