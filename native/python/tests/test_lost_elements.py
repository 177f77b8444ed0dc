# SPDX-License-Identifier: Apache-2.0
"""What numpy would silently make something else of: True and False among numbers, masks, imaginary
parts, texts. All of it is refused, in lists at any depth and in arrays of objects, and the message
names the place and the value.
"""

import array
import ast
import itertools
from collections import deque
from typing import Any

import limitsurf as ls
import numpy as np
import pytest
from test_arguments import FACES, SQUARES, SURFACE, every_array, outcome, right, with_last
from test_number_arguments import FUNCTIONS, INTEGER_CASES

# mypy would see what is wrong.
ANY_SURFACE: Any = SURFACE
ONE = [[0.5, 0.5, 1.0]]


def last_place(name, argument, value):
    place = ", ".join(str(n - 1) for n in np.shape(value))
    return place.replace(", ", "][") if argument == "faces" and "from_faces" in name else place


def of_objects(nested):
    """An array of objects that holds those of a nested list."""
    return np.array(nested, object)


def holding(value):
    """An array without dimensions that holds an object as it is."""
    found = np.empty((), object)
    found[()] = value
    return found


def is_boolean(value):
    return np.array(value).dtype.kind == "b"


@every_array
@pytest.mark.parametrize("wrong", [True, np.False_], ids=["True", "np.False_"])
def test_booleans_are_no_numbers(name, argument, part, wrong):
    value = right(name, argument, part)
    if is_boolean(value):
        return
    nested = with_last(value, wrong)
    for given in (nested, of_objects(nested), deque(nested), tuple(nested)):
        error, message = outcome(name, argument, part, given)
        assert error is TypeError
        assert message.startswith(argument)
        found = f"[{last_place(name, argument, value)}] is {wrong}; expected "
        if given is not nested and argument == "faces":
            found = found.replace("][", ", ") if isinstance(given, np.ndarray) else found
        assert found in message, message


#: Numbers that may be a mask
MASKS = {
    *(("FilteredImage.__init__", "pixels"), ("bilinear", "pixels"), ("blend_over", "weight")),
    ("LimitSurface.smooth_path", "weights"),
    *((f"LimitSurface.scatter_{way}", "density") for way in ("uniform", "blue_noise")),
}


@every_array
def test_arrays_of_booleans_are_no_numbers(name, argument, part):
    value = right(name, argument, part)
    if is_boolean(value):
        return
    if (name, argument) in MASKS:
        assert outcome(name, argument, part, np.array(value).astype(bool)) is None
        return
    booleans = np.array(value).astype(bool)
    error, message = outcome(name, argument, part, booleans)
    assert error is TypeError
    assert message.startswith(argument)
    assert "has dtype bool; expected " in message
    if booleans.ndim > 1:  # a row of them among others
        rows = [*np.array(value)]
        for row in (booleans[-1], memoryview(booleans[-1])):
            rows[-1] = row
            error, message = outcome(name, argument, part, rows)
            assert error is TypeError
            assert message.startswith(argument)
            assert f"[{len(rows) - 1}] has dtype bool; expected " in message


@every_array
def test_masked_elements_are_refused_at_any_depth(name, argument, part):
    value = right(name, argument, part)
    nested = with_last(value, np.ma.masked)
    for given in (nested, deque(nested), of_objects(nested)):
        if is_boolean(value) and isinstance(given, np.ndarray):
            continue
        error, message = outcome(name, argument, part, given)
        assert error is TypeError
        assert message.startswith(argument)
        assert " is masked" in message, message
    rows = np.array(value)
    if rows.ndim > 1:
        rows = list(rows)
        rows[-1] = np.ma.array(rows[-1])  # nothing of it is masked
        for given in (rows, deque(rows), tuple(rows), [rows]):
            error, message = outcome(name, argument, part, given)
            assert message.startswith(argument)
            assert "masked array" in message, message


@every_array
@pytest.mark.parametrize("wrong", [np.complex128(1 + 5j), np.complex64(1j), 1j, np.str_("1")])
def test_imaginary_parts_are_not_dropped(name, argument, part, wrong, recwarn):
    nested = with_last(right(name, argument, part), wrong)
    for given in (nested, of_objects(nested)):
        error, message = outcome(name, argument, part, given)
        assert error is TypeError
        assert message.startswith(argument)
    assert not recwarn  # numpy warns of what it drops


class Converted:
    """An object of which numpy asks an array."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        return self.values


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.ma.array(ONE), "points is a masked array; give its values"),
        (Converted(np.ma.array(ONE)), "points is a masked array; give its values"),
        ([Converted(np.ma.array(ONE[0]))], r"points\[0\] is a masked array; give its values"),
        ([Converted(np.array([True] * 3))], r"points\[0\] has dtype bool; expected real numbers$"),
        ([[0.5, [1.0, True], 2.0]], r"points\[0, 1, 1\] is True; expected real numbers$"),
        ([[0.5, np.array(True), 2.0]], r"points\[0, 1\] has dtype bool; expected real numbers$"),
        ([[0.5, np.ma.masked, 2.0]], r"points\[0, 1\] is masked: it has no value$"),
        (
            [[0.5, np.array(1j, object), 1]],
            r"points\[0, 1\] is array\(1j, .*; expected real",
        ),
        (
            [[0.5, np.array("1", object), 1]],
            r"points\[0, 1\] is array\('1', .*; expected real",
        ),
        (np.array([ONE, None], object)[:1], "points.0. is .*; expected real numbers$"),
        (True, "points is True; expected real numbers$"),
        (np.array(ONE) * 1j, "points has dtype complex128; expected real numbers$"),
    ],
)
def test_the_place_is_named(points, message):
    with pytest.raises(TypeError, match=f"^{message}"):
        ANY_SURFACE.closest(points)


def nested_in_itself():
    nested: list = []
    nested.append(nested)
    return nested


class Failing:
    """A sequence whose elements cannot be read."""

    def __init__(self, error):
        self.error = error

    def __len__(self):
        return 3

    def __getitem__(self, place):
        raise self.error


@pytest.mark.parametrize(
    "points", [nested_in_itself(), [[[Failing(ValueError("no"))]]], Failing(KeyError(0)), [{1: 2}]]
)
def test_strange_sequences_are_refused(points):
    with pytest.raises((TypeError, ValueError), match="^points"):
        ANY_SURFACE.closest(points)


@pytest.mark.parametrize("error", [KeyboardInterrupt(), RuntimeError("no")])
def test_errors_of_sequences_end_the_call(error):
    with pytest.raises(type(error)) as raised:
        ANY_SURFACE.closest([Failing(error)])
    assert raised.value is error


def test_numbers_of_all_kinds_are_taken():
    expected = SURFACE.closest([[1.0, 2.0, 1.0]]).distance
    for row in (
        (1, 2.0, np.float32(1)),
        deque([1, np.int8(2), np.array(1.0)]),
        array.array("d", [1, 2, 1]),
        memoryview(np.array([1.0, 2, 1])),
        np.array([1, 2.0, np.uint8(1)], object),
        Converted(np.array([1, 2, 1])),
    ):
        for points in ([row], deque([row]), (row,)):
            assert ANY_SURFACE.closest(points).distance == expected
    np.testing.assert_array_equal(
        ANY_SURFACE.evaluate([np.int64(1), 1], [[0, 0]] * 2).position,
        ANY_SURFACE.evaluate(np.array([np.int64(1), 1], object), [[0, 0]] * 2).position,
    )


def real_parameters():
    """(function, parameter) for every parameter that is one real number"""
    for name, definition in FUNCTIONS.items():
        at = definition.args
        for a in (*at.args, *at.kwonlyargs):
            if a.annotation and ast.unparse(a.annotation) in ("float", "float | None"):
                yield name, a.arg


COMMON = {
    **INTEGER_CASES,
    "LimitSurface.lay_path": (SURFACE.lay_path, {"points": [[0.5, 0.5, 1]] * 2, "tolerance": 0.1}),
    "LimitSurface.fit_path": (
        SURFACE.fit_path,
        {"face": [0, 1], "uv": [[0.5, 0.5]] * 2, "tolerance": 0.1},
    ),
    "LimitSurface.levels_of_length": (SURFACE.levels_of_length, {"length": 0.5}),
}
WRONG_REALS = (
    *(np.complex128(10 + 5j), np.complex64(1), np.array(1j), np.array(1 + 0j, object)),
    holding(np.ma.masked),
    *(np.array("10"), np.array(b"1"), np.array("1", object), np.str_("1"), np.bytes_(b"1")),
    *(np.array(True), np.array(True, object), np.array(1, "m8[s]"), np.array(1, "M8[s]")),
    *(np.zeros((), "f8, f8"), np.zeros((), "V8")),
)


@pytest.mark.parametrize(("name", "argument"), list(real_parameters()))
def test_what_is_no_real_number(name, argument, recwarn):
    call, given = COMMON[name]
    for wrong in WRONG_REALS:
        with pytest.raises(TypeError, match=rf"^{argument} is .*; expected a number$"):
            call(**{**given, argument: wrong})
    for masked in (np.ma.array(1.5), np.ma.masked):
        with pytest.raises(TypeError, match=rf"^{argument} is .*; expected a number, not a masked"):
            call(**{**given, argument: masked})
    assert not recwarn


def test_pairs_have_no_masks():
    uv_map: Any = ANY_SURFACE.vertex_data(SQUARES[:, :2])
    eye = np.eye(4)
    calls = {
        "texel": lambda v: ANY_SURFACE.project(uv_map, [0], [[0.5, 0.5]], eye, v),
        "facing": lambda v: ANY_SURFACE.project(uv_map, [0], [[0, 0]], eye, (1, 1), facing=v),
        "depth": lambda v: ANY_SURFACE.project(uv_map, [0], [[0, 0]], eye, (1, 1), depth=v),
        "tile": lambda v: uv_map.rasterize(3, 3, v),
    }
    for name, call in calls.items():
        kind = int if name == "tile" else float
        for mask in itertools.product((False, True), repeat=2):
            with pytest.raises(TypeError, match=f"^{name} is a masked array; give its values"):
                call(np.ma.array([1, 2], kind, mask=mask))
        with pytest.raises(TypeError, match=rf"^{name}\[1\] is masked: it has no value$"):
            call([1, np.ma.masked])
        for wrong in ([True, 2], np.array([1, 2j]), np.array(["1", "2"]), [1, np.complex64(2)]):
            with pytest.raises(TypeError, match=f"^{name} is .*; expected two "):
                call(wrong)
        call(np.array([1, 2], kind))


def test_faces_have_no_booleans():
    for faces in ([[False, True, 5, 4]], [(0, np.True_, 5, 4)], deque([deque([0, True, 5, 4])])):
        with pytest.raises(TypeError, match=r"^faces\[0\]\[[01]\] is (True|False); expected int"):
            ls.ControlMesh.from_faces(SQUARES, faces)
    with pytest.raises(TypeError, match=r"^faces\[8\]\[3\] is masked: it has no value$"):
        ls.ControlMesh.from_faces(SQUARES, with_last(FACES, np.ma.masked))
