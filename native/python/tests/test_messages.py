# SPDX-License-Identifier: Apache-2.0
"""Messages of errors: one line, which names the arguments as the caller wrote them."""

from typing import Any

import limitsurf as ls
import numpy as np
import pytest
from test_arguments import (
    CURVES,
    FACE,
    FACES,
    POINTS,
    SQUARES,
    SURFACE,
    UV,
    UV_MAP,
    every_array,
    outcome,
    right,
    with_last,
)

# mypy would see what is wrong.
LS: Any = ls
ANY_SURFACE: Any = SURFACE
SIZES, VERTICES = [4] * len(FACES), FACES.ravel()
FAR = SQUARES.copy()
FAR[15, 2] = 1e300
BLANK_MESH: Any = ls.ControlMesh.__new__(ls.ControlMesh)
BLANK_SURFACE: Any = ls.LimitSurface.__new__(ls.LimitSurface)


class ManyLines:
    """What no argument may be, and whose repr has every kind of line break."""

    def __repr__(self):
        return "one\n   two\r\nthree\x0bfour\x0cfive\x85six\u2028seven\u2029eight"


ONE_LINE = "one two three four five six seven eight"


@every_array
def test_values_of_several_lines(name, argument, part):
    for value in (ManyLines(), with_last(right(name, argument, part), ManyLines())):
        _, message = outcome(name, argument, part, value)
        assert len(message.splitlines()) == 1
        assert message.startswith(argument)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda v: ANY_SURFACE.evaluate(FACE, UV, dtype=v), "dtype"),
        (lambda v: ANY_SURFACE.evaluate(FACE, UV, threads=v), "threads"),
        (lambda v: ANY_SURFACE.closest(POINTS, max_distance=v), "max_distance"),
        (lambda v: ANY_SURFACE.project(UV_MAP, FACE, UV, np.eye(4), v), "texel"),
        (lambda v: ANY_SURFACE.tessellate(v), "levels"),
        (lambda v: LS.ControlMesh.from_faces(SQUARES, v), "faces"),
        (lambda v: LS.LimitSurface(v), "mesh"),
    ],
)
def test_single_values_of_several_lines(call, name):
    for wrong in (ManyLines(), np.zeros((3, 3)), np.zeros(3, "datetime64[s]")):
        with pytest.raises((TypeError, ValueError), match=f"^{name} ") as raised:
            call(wrong)
        assert len(str(raised.value).splitlines()) == 1
    with pytest.raises((TypeError, ValueError)) as raised:
        call(ManyLines())
    assert ONE_LINE[:7] in str(raised.value)


def test_line_breaks_become_spaces():
    with pytest.raises(TypeError) as raised:
        ANY_SURFACE.evaluate(FACE, UV, dtype=ManyLines())
    assert str(raised.value) == f"dtype is {ONE_LINE}; expected float64 or float32"


def test_long_lines_end_in_whole_characters():
    for indent in range(4):
        text = "\n".join(" " * indent + "ä" * 7 for _ in range(1000))
        with pytest.raises(ls.MeshError, match="^edges is ' *ä") as raised:
            ANY_SURFACE.edge_curves(text)
        assert len(str(raised.value).splitlines()) == 1
        assert "...'; expected 'boundary'" in str(raised.value)


#: Not even UTF-8 can hold it.
SURROGATE = "\ud800"


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda text: ls.ControlMesh(SQUARES, SIZES, VERTICES, boundary=text), "boundary"),
        (lambda text: ls.ControlMesh.from_faces(SQUARES, FACES, creasing=text), "creasing"),
        (lambda text: ls.ControlMesh.from_faces(SQUARES, FACES, triangles=text), "triangles"),
        (lambda text: ls.ControlMesh.from_faces(SQUARES, FACES, scheme=text), "scheme"),
        (lambda text: SURFACE.edge_curves(text), "edges"),
        (lambda text: CURVES.at([0], [0.0], side=text), "side"),
        (lambda text: SURFACE.scatter_along(CURVES, 3, side=text), "side"),
        (lambda text: SURFACE.face_varying(SQUARES, VERTICES, text), "interpolation"),
        (lambda text: SURFACE.curvature(0, [[0.5, 0.5]], irregular=text), "irregular"),
        (lambda text: SURFACE.fit_path([0, 0], [[0.1, 0.5], [0.9, 0.5]], 0.1, kind=text), "kind"),
        (lambda text: ls.FilteredImage(np.zeros((2, 2, 3)), extension=text), "extension"),
        (lambda text: ls.blend_over([[0] * 4], [[0] * 4], [1], mode=text), "mode"),
    ],
)
def test_texts_that_are_no_choice(call, name):
    with pytest.raises(ValueError, match=rf"^{name} is '\\ud800'; expected '"):
        call(SURROGATE)
    for value, written in ((b"none", "b'none'"), (3, "3"), (None, "None")):
        if name != "edges":  # which may be an array instead
            with pytest.raises(TypeError) as raised:
                call(value)
            assert str(raised.value) == f"{name} is {written}; expected a string"


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: SURFACE.scatter_along(CURVES, count=2**62),
            f"count is {2**62}; the limit is {2**31} locations",
        ),
        (
            lambda: SURFACE.scatter_along(CURVES, 100, rows=2**31 - 1, row_distance=1),
            f"count is 100 and rows is {2**31 - 1}; the limit is {2**31} locations",
        ),
        (
            lambda: SURFACE.scatter_along(CURVES, spacing=1e-300),
            f"spacing is 1e-300 on curves of the length {CURVES.lengths[0]}; "
            f"the limit is {2**31} locations",
        ),
        (
            lambda: ls.ControlMesh(FAR, SIZES, VERTICES),
            "positions: vertex 15 has position (3, 3, 1e+300); coordinates may be at most "
            "2.5822498780869086e+120",
        ),
        (
            lambda: ls.LimitSurface(SURFACE.mesh).set_positions(FAR),
            "positions: vertex 15 has position (3, 3, 1e+300); coordinates may be at most "
            "2.5822498780869086e+120",
        ),
        (
            lambda: ls.ControlMesh.from_faces(SQUARES * np.nan, FACES),
            "positions: vertex 0 has position (nan, nan, nan); positions must be finite",
        ),
        (
            lambda: ls.ControlMesh.from_faces(
                np.full_like(SQUARES, np.copysign(np.nan, -1)), FACES
            ),
            "positions: vertex 0 has position (nan, nan, nan); positions must be finite",
        ),
        (
            lambda: ls.ControlMesh(SQUARES[:15], SIZES, VERTICES),
            "face_vertices: face 8 names vertex 15, but positions has 15 rows",
        ),
        (
            lambda: ls.ControlMesh.from_faces(SQUARES[:15], FACES),
            "faces: face 8 names vertex 15, but positions has 15 rows",
        ),
        (
            lambda: ls.ControlMesh(SQUARES, [2], [0, 1]),
            "face_sizes: face 0 has 2 vertices; a face needs at least 3",
        ),
        (
            lambda: ls.ControlMesh.from_faces(SQUARES, [[0, 1]]),
            "faces: face 0 has 2 vertices; a face needs at least 3",
        ),
        (
            lambda: SURFACE.lay_path(POINTS[:2], 0.1, handle_left=POINTS, handle_right=POINTS),
            "handle_left has 3 rows; expected 2, as many as points has",
        ),
        (
            lambda: SURFACE.lay_path(POINTS, 0.1, handle_left=POINTS, handle_right=POINTS[:1]),
            "handle_right has 1 row; expected 3, as many as points has",
        ),
        (
            lambda: SURFACE.lay_path(POINTS, 0.1, handle_left=[], handle_right=[]),
            "handle_left has 0 rows; expected 3, as many as points has",
        ),
        (lambda: BLANK_MESH.__setstate__({}), "no state of a ControlMesh: {} is no tuple"),
        (lambda: BLANK_SURFACE.__setstate__(3), "no state of a LimitSurface: 3 is no tuple"),
        (
            lambda: BLANK_SURFACE.__setstate__((3,)),
            "no state of a LimitSurface: it is no pair of a mesh and positions",
        ),
    ],
)
def test_messages_name_the_arguments(call, message):
    with pytest.raises((TypeError, ValueError)) as raised:
        call()
    assert str(raised.value) == message
