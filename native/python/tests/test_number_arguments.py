# SPDX-License-Identifier: Apache-2.0
"""Arguments that are one number: nothing is cut off, no mask is lost, no error of a number's own
methods is dropped, and the error says what was expected.
"""

import ast
from decimal import Decimal
from fractions import Fraction
from typing import Any

import limitsurf as ls
import numpy as np
import pytest
from test_arguments import CASES, CURVES, ON, POINTS, SURFACE, UP, UV_MAP, VIEW, names_of
from test_signatures import FUNCTIONS

# mypy would see what is wrong.
ANY_SURFACE: Any = SURFACE


@pytest.mark.parametrize("name", [n for n in CASES if "threads" in names_of(n)])
@pytest.mark.parametrize("wrong", [None, "a", 1.5, 2**31])
def test_threads_of_a_wrong_type(name, wrong):
    call, given = CASES[name]
    with pytest.raises(TypeError, match=rf"^threads is {wrong!r}; expected an integer"):
        call(**given, threads=wrong)


#: Right arguments for functions whose cases above do not take their integers, or that have none
INTEGER_CASES = {
    **CASES,
    "resample_strands": (ls.resample_strands, {"points": POINTS, "offsets": [0, 3], "count": 2}),
    "straight_strands": (ls.straight_strands, {"roots": POINTS, "along": UP, "points": 2}),
    "PtexLayout.__init__": (ls.PtexLayout, {"face_count": 2, "resolution": 4}),
    "SurfaceData.bounds": (UV_MAP.bounds, {}),
    "SurfaceData.rasterize": (UV_MAP.rasterize, {"width": 3, "height": 3}),
    "LimitSurface.scatter_along": (SURFACE.scatter_along, {"curves": CURVES, "count": 3}),
    "LimitSurface.tile_quadtree": (SURFACE.tile_quadtree, {}),
    "LimitSurface.even_path": (SURFACE.even_path, {**ON, "count": 3}),
    "LimitSurface.project": (
        SURFACE.project,
        {"uv_map": UV_MAP, **ON, "matrix": VIEW, "texel": (0.1, 0.1)},
    ),
    "LimitSurface.scatter_jittered": (SURFACE.scatter_jittered, {"per_side": 2}),
    "LimitSurface.scatter_uniform": (SURFACE.scatter_uniform, {"count": 3}),
    "LimitSurface.scatter_blue_noise": (SURFACE.scatter_blue_noise, {"count": 3}),
    "LimitSurface.levels_within": (SURFACE.levels_within, {"tolerance": 0.5}),
    "LimitSurface.levels_of_length": (SURFACE.levels_of_length, {"length": 0.5}),
}


def integer_parameters():
    """(function, parameter) for every parameter that is one integer; of some functions that have
    no other one, `threads` is left out.
    """
    for name, definition in FUNCTIONS.items():
        at = definition.args
        for a in (*at.args, *at.kwonlyargs):
            is_integer = a.annotation and ast.unparse(a.annotation) in ("int", "int | None")
            if is_integer and (name in INTEGER_CASES or a.arg != "threads"):
                yield name, a.arg


#: Where 2**31 and more are right
HAVE_64_BITS = {
    *((f"LimitSurface.scatter_{way}", "count") for way in ("along", "uniform", "blue_noise")),
    *((f"LimitSurface.scatter_{way}", "seed") for way in ("along", "uniform", "blue_noise")),
    ("LimitSurface.scatter_jittered", "seed"),
}


@pytest.mark.parametrize(("name", "argument"), list(integer_parameters()))
@pytest.mark.parametrize("wrong", [1.5, "a", [], 2**64, 2**63, 2**31, -(2**31) - 1, -(2**63) - 1])
def test_integers_of_wrong_types_and_sizes(name, argument, wrong):
    bits = 64 if (name, argument) in HAVE_64_BITS else 32
    least = 0 if argument == "seed" else -(2 ** (bits - 1))
    most = 2**bits if argument == "seed" else 2 ** (bits - 1)
    if isinstance(wrong, int) and least <= wrong < most:
        return
    if not isinstance(wrong, int):
        expected = ""
    elif wrong < 0:
        expected = f" of at least {least}"
    else:
        expected = f" below {most}"
    call, given = INTEGER_CASES[name]
    with pytest.raises(TypeError) as error:
        call(**{**given, argument: wrong})
    assert str(error.value) == f"{argument} is {wrong!r}; expected an integer{expected}"


#: What is no integer, though most of it has __int__()
NO_INTEGERS = (
    True,
    np.bool_(True),
    np.array(True),
    2.7,
    np.float32(2.7),
    np.longdouble(2.7),
    Decimal("2.7"),
    Fraction(5, 2),
    np.array(2.7),
    np.array([2]),
    np.timedelta64(2, "s"),
    None,
)
MASKED = (np.ma.array(2), np.ma.array(2, mask=True))


@pytest.mark.parametrize(("name", "argument"), list(integer_parameters()))
@pytest.mark.parametrize("wrong", NO_INTEGERS, ids=lambda value: type(value).__name__)
def test_fractions_are_not_cut_off(name, argument, wrong):
    call, given = INTEGER_CASES[name]
    if wrong is None and _may_be_none(name, argument):
        return
    with pytest.raises(TypeError, match=rf"^{argument} is .*; expected an integer$"):
        call(**{**given, argument: wrong})


def _may_be_none(name, argument):
    at = FUNCTIONS[name].args
    (found,) = (a for a in (*at.args, *at.kwonlyargs) if a.arg == argument)
    return ast.unparse(found.annotation) == "int | None"


@pytest.mark.parametrize(("name", "argument"), list(integer_parameters()))
@pytest.mark.parametrize("wrong", MASKED, ids=repr)
def test_masks_of_integers_are_not_lost(name, argument, wrong):
    call, given = INTEGER_CASES[name]
    with pytest.raises(TypeError, match=rf"^{argument} is .*; expected an integer, not a masked"):
        call(**{**given, argument: wrong})


@pytest.mark.parametrize("count", [2, np.int8(2), np.uint64(2), np.array(2)])
def test_integers_of_every_kind_are_taken(count):
    assert len(ANY_SURFACE.scatter_uniform(count)) == 2


@pytest.mark.parametrize(
    "distance", [1, np.float32(0.5), np.array(0.5), Decimal("0.5"), np.int8(1)]
)
def test_numbers_of_every_kind_are_taken(distance):
    found = ANY_SURFACE.closest(POINTS, max_distance=distance)
    np.testing.assert_array_equal(found.face, SURFACE.closest(POINTS, float(distance)).face)


@pytest.mark.parametrize(
    "wrong",
    [
        *("1.5", None, 1j, True, np.False_, np.array(True), np.array([1.5]), POINTS),
        *(np.timedelta64(2, "s"), np.datetime64("2020")),
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_is_no_number(wrong):
    with pytest.raises(TypeError, match="^max_distance is .*; expected a number$"):
        ANY_SURFACE.closest(POINTS, wrong)


@pytest.mark.parametrize("wrong", [np.ma.array(1.5), np.ma.masked], ids=repr)
def test_masks_of_numbers_are_not_lost(wrong):
    with pytest.raises(TypeError, match="^max_distance is .*; expected a number, not a masked"):
        ANY_SURFACE.closest(POINTS, wrong)


def test_a_number_that_fits_no_double():
    with pytest.raises(
        TypeError, match=r"^max_distance is 10+\.\.\.0+; expected a number below 1.8e308"
    ):
        ANY_SURFACE.closest(POINTS, 10**400)


class Raising:
    """A number whose methods raise."""

    def __init__(self, error):
        self.error = error

    def __index__(self):
        raise self.error

    def __float__(self):
        raise self.error


@pytest.mark.parametrize("error", [KeyboardInterrupt(), KeyError("no number"), RuntimeError("no")])
def test_errors_of_numbers_end_the_call(error):
    for call in (
        lambda: ANY_SURFACE.evaluate(0, [[0, 0]], threads=Raising(error)),
        lambda: ANY_SURFACE.closest(POINTS, Raising(error)),
        lambda: ANY_SURFACE.tessellate(Raising(error)),
    ):
        with pytest.raises(type(error)) as raised:
            call()
        assert raised.value is error


@pytest.mark.parametrize(
    "wrong", [2.7, np.float32(2.7), np.array(2.7), np.ma.array(2), np.ma.masked]
)
def test_levels_are_integers(wrong):
    with pytest.raises(TypeError, match="^levels (is|has dtype) "):
        ANY_SURFACE.tessellate(wrong)


def test_faces_may_be_any_array():
    positions, faces = SURFACE.mesh.positions, SURFACE.mesh.face_vertices.reshape(-1, 4)

    class Interface:
        __array_interface__ = faces.__array_interface__

    class Converted:
        def __array__(self, dtype=None, copy=None):
            return faces

    for given in (memoryview(faces), Interface(), Converted()):
        mesh = ls.ControlMesh.from_faces(positions, given)
        np.testing.assert_array_equal(mesh.face_vertices, faces.ravel())


def boolean_parameters():
    """(function, parameter) for every parameter that is True or False"""
    for name, definition in FUNCTIONS.items():
        at = definition.args
        for a in (*at.args, *at.kwonlyargs):
            if a.annotation and ast.unparse(a.annotation) == "bool":
                yield name, a.arg


FLAG_CASES = {**INTEGER_CASES, "LimitSurface.area": (SURFACE.area, {})}


@pytest.mark.parametrize(("name", "argument"), list(boolean_parameters()))
def test_only_booleans_are_flags(name, argument):
    call, given = FLAG_CASES[name]
    for right in (True, False, np.True_):
        call(**{**given, argument: right})
    for wrong in (1, 0, None, float("nan"), "no", [], np.array([True]), np.array(2), bool):
        with pytest.raises(TypeError, match=rf"^{argument} is .*; expected True or False$"):
            call(**{**given, argument: wrong})


def test_closed_is_a_flag_or_an_array_of_flags():
    for right in (True, np.True_, [True], np.array([True])):
        assert ANY_SURFACE.lay_path(POINTS, 0.1, closed=right).closed[0]
    with pytest.raises(TypeError, match="^closed has dtype int64; expected booleans"):
        ANY_SURFACE.lay_path(POINTS, 0.1, closed=1)
