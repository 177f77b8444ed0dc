# SPDX-License-Identifier: Apache-2.0
"""Input that means harm, or somebody else's mistake: an error each time, never wrong numbers."""

import textwrap

import ctrl_c
import limitsurf as ls
import numpy as np
import pytest

SQUARE = [[0.0, 0, 0], [1.0, 0, 0], [1.0, 1, 0], [0.0, 1, 0]]


def square() -> ls.LimitSurface:
    return ls.LimitSurface(ls.ControlMesh.from_faces(SQUARE, [[0, 1, 2, 3]]))


@pytest.mark.parametrize("dtype", [">f8", ">f4"])
def test_results_in_another_byte_order_are_refused(dtype):
    with pytest.raises(TypeError, match="byte order"):
        square().evaluate([0], [[0.5, 0.5]], dtype=dtype)


def test_objects_without_init_are_errors():
    surface = ls.LimitSurface.__new__(ls.LimitSurface)
    with pytest.raises(TypeError, match="never initialised"):
        _ = surface.face_count
    with pytest.raises(TypeError, match="never initialised"):
        surface.evaluate(0, [[0.0, 0.0]])
    with pytest.raises(TypeError, match="never initialised"):
        _ = ls.ControlMesh.__new__(ls.ControlMesh).positions


@pytest.mark.parametrize("face", [2**80, -(2**80), 2**63, np.uint64(2**63)])
def test_faces_beyond_64_bits_are_quoted(face):
    with pytest.raises(ls.LocationError, match=str(int(face)).lstrip("-")):
        square().evaluate(np.array([face]), [[0.5, 0.5]])


@pytest.mark.parametrize("face", [1.5, None, "0", True])
def test_objects_that_are_no_integers_are_type_errors(face):
    with pytest.raises(TypeError, match="face"):
        square().evaluate(np.array([face], object), [[0.5, 0.5]])


def test_coordinates_may_be_objects():
    got = square().evaluate([0], np.array([[0.5, 0.5]], object))
    np.testing.assert_allclose(got.position, [[0.5, 0.5, 0]], atol=1e-15)


def test_empty_lists_are_empty_batches():
    assert square().evaluate([], []).position.shape == (0, 3)


def test_counts_that_overflow_are_errors():
    with pytest.raises(ValueError, match="per_side is 2147483647"):
        square().scatter_jittered(2**31 - 1)
    many = np.arange(200)
    faces = np.stack([many, many + 201, many + 202, many + 1], axis=1)
    strip = np.zeros((402, 3))
    strip[:, 0] = np.arange(402) % 201
    strip[201:, 1] = 1
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(strip, faces))
    with pytest.raises(ValueError, match="levels is 12 on 200 faces"):
        surface.tessellate(12)


@pytest.mark.parametrize("sides", [65536, 40000])
def test_too_many_edges_name_the_vertex(sides, capfd):
    """A fan of `sides` - 1 triangles, or two of 40,000 edges that meet in a vertex."""
    fans = 1 if sides > 65535 else 2
    faces = []
    for fan in range(fans):
        rim = 1 + fan * sides + np.arange(sides - 1)
        faces.append(np.stack([0 * rim, rim, rim + 1], axis=1))
    faces = np.concatenate(faces)
    with pytest.raises(ls.MeshError, match=f"vertex 0 has {sides * fans} edges"):
        ls.ControlMesh.from_faces(np.random.default_rng(0).random((faces.max() + 1, 3)), faces)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("call", ["tessellate(5)", "area()", "scatter_jittered(60)"])
def test_ctrl_c_ends_long_calls(call):
    program = textwrap.dedent(f"""
        import numpy as np, limitsurf as ls, shapes
        positions, faces = shapes.grid(120, 120)
        positions[:, 2] = np.sin(7 * positions[:, 0] * positions[:, 1])
        surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
        print("ready", flush=True)
        while True:
            surface.{call}
    """)
    assert "KeyboardInterrupt" in ctrl_c.errors_of(program)
