# SPDX-License-Identifier: Apache-2.0
import copy
import dataclasses
import multiprocessing
import pickle
import subprocess
import sys

import limitsurf as ls
import numpy as np
import pytest
import shapes


def same_surface(a, b):
    rng = np.random.default_rng(0)
    face, uv = rng.integers(0, a.face_count, 20), rng.random((20, 2))
    return a.evaluate(face, uv).position.tobytes() == b.evaluate(face, uv).position.tobytes()


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_meshes(mesh, protocol):
    again = pickle.loads(pickle.dumps(mesh, protocol))
    np.testing.assert_array_equal(again.positions, mesh.positions)
    np.testing.assert_array_equal(again.face_vertices, mesh.face_vertices)
    assert same_surface(ls.LimitSurface(mesh), ls.LimitSurface(again))


def test_options_survive():
    positions, faces = shapes.house()
    mesh = ls.ControlMesh.from_faces(
        positions,
        faces,
        boundary="corners",
        triangles="smooth",
        creasing="chaikin",
        holes=[3],
        edge_sharpness=([[0, 1]], [0]),
    )
    again = pickle.loads(pickle.dumps(mesh))
    assert (again.boundary, again.triangles) == ("corners", "smooth")
    assert ls.LimitSurface(again).refused == ls.LimitSurface(mesh).refused
    assert set(ls.LimitSurface(again).refused) == {3}


def test_surfaces_keep_their_pose(surface):
    surface.set_positions(surface.positions + [1, 2, 3])
    for again in (pickle.loads(pickle.dumps(surface)), copy.deepcopy(surface)):
        assert same_surface(surface, again)
        np.testing.assert_array_equal(again.mesh.positions, surface.mesh.positions)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_surfaces_of_any_protocol_and_what_does_not_pickle(protocol):
    # In a process of its own: a crash must not take the other tests along.
    code = f"""
import pickle
import limitsurf as ls
square = [[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
surface = ls.LimitSurface(ls.ControlMesh.from_faces(square, [[0, 1, 2, 3]]))
again = pickle.loads(pickle.dumps(surface, {protocol}))
at = [[0.3, 0.6]]
print((again.evaluate(0, at).position == surface.evaluate(0, at).position).all())
for thing in (surface.edge_curves(), surface.vertex_data(surface.positions)):
    for reduced in (
        lambda: pickle.dumps(thing, {protocol}),
        lambda: thing.__reduce__(),
        lambda: object.__reduce_ex__(thing, {protocol}),
    ):
        try:
            reduced()
        except TypeError as error:
            print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    is_same, *refused = done.stdout.splitlines()
    assert is_same == "True"
    assert [line.partition(" '")[0] for line in refused] == ["cannot pickle"] * 6


class Mine(ls.LimitSurface):
    def __reduce__(self):
        return super().__reduce__()


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_classes_made_of_a_surface(cube, protocol):
    mine = Mine(cube.mesh)
    for again in (
        pickle.loads(pickle.dumps(mine, protocol)),
        copy.copy(mine),
        copy.deepcopy(mine),
    ):
        assert type(again) is Mine
        assert same_surface(mine, again)
    assert cube.__reduce__()[1] == object.__reduce_ex__(cube, protocol)[1] == (ls.LimitSurface,)


@pytest.mark.parametrize("cls", ["ControlMesh", "LimitSurface"])
@pytest.mark.parametrize("state", ["()", "(1, 2)", "('a',) * 10", "(None,) * 10"])
def test_broken_pickles_are_errors(cls, state):
    # In a process of its own: a crash must not take the other tests along.
    code = (
        f"import limitsurf as ls\nblank = ls.{cls}.__new__(ls.{cls})\n"
        f"try:\n    blank.__setstate__({state})\n"
        "except Exception as error:\n    print(type(error).__name__)"
    )
    child = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert child.returncode == 0, child.stderr
    assert child.stdout.strip() in {
        "TypeError", "ValueError", "RuntimeError", "IndexError", "MeshError"
    }  # fmt: skip


def middle_of(surface):
    return surface.evaluate(0, [[0.5, 0.5]]).position


def test_other_processes(cube):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there = pool.apply(middle_of, (cube,))
    np.testing.assert_array_equal(there, middle_of(cube))


def test_objects_are_made_once(cube):
    other = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.house()))
    before = middle_of(cube)
    with pytest.raises(TypeError, match=r"^this LimitSurface has been made already"):
        cube.__init__(other.mesh)
    for state in (other.__getstate__(), (), "garbage"):
        with pytest.raises(TypeError, match="has been made already"):
            cube.__setstate__(state)
    np.testing.assert_array_equal(middle_of(cube), before)
    layout = ls.PtexLayout(3, 4)
    with pytest.raises(TypeError, match="has been made already"):
        layout.__init__(5, 4)


def test_results_do_not_change(cube):
    here = cube.evaluate(0, [[0.5, 0.5]])
    for name in ("position", "foo"):
        with pytest.raises(dataclasses.FrozenInstanceError, match=name):
            setattr(here, name, 1)
        with pytest.raises(dataclasses.FrozenInstanceError, match=name):
            delattr(here, name)


def test_results():
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(*shapes.cube()))
    here = surface.evaluate(0, [[0.5, 0.5]], 1)
    again = pickle.loads(pickle.dumps(here))
    np.testing.assert_array_equal(again.du, here.du)
