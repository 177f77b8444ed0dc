# SPDX-License-Identifier: Apache-2.0
"""Every function gives the same bits for any number of threads, and for arrays of all types and
layouts that hold the same numbers.
"""

from dataclasses import fields, is_dataclass

import numpy as np
import pytest
from test_arguments import CASES, array_parameters, names_of

#: Their calls take long, whatever the surface is
SLOW = ("LimitSurface.curve_directions", "LimitSurface.guide_weights")


def cases(names):
    return [pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name for name in names]


def in_other_layout(values, order):
    """The same array with gaps, backwards, or in another order of its memory."""
    if order == "gaps":
        spaced = np.full((*values.shape, 2), 77, values.dtype)
        spaced[..., 0] = values
        return spaced[..., 0]
    if order == "backwards":
        return values[::-1].copy()[::-1]
    if order == "unaligned":
        moved = np.frombuffer(bytearray(values.nbytes + 1), values.dtype, values.size, 1)
        moved = moved.reshape(values.shape)
        moved[...] = values
        return moved
    return np.asfortranarray(values)


def read_only(values):
    values = values.copy()
    values.flags.writeable = False
    return values


FORMS = {
    "gaps": lambda values: in_other_layout(values, "gaps"),
    "backwards": lambda values: in_other_layout(values, "backwards"),
    "unaligned": lambda values: in_other_layout(values, "unaligned"),
    "columns first": lambda values: in_other_layout(values, "columns first"),
    "read-only": read_only,
    "big-endian": lambda values: values.astype(values.dtype.newbyteorder(">")),
    "narrow": lambda values: values.astype({"f": np.float32, "i": np.int32}[values.dtype.kind]),
    "lists": np.ndarray.tolist,
}


def as_array(value):
    """An array of booleans, integers, or floats that single precision holds exactly."""
    values = np.array(value)
    return values.astype(np.float32).astype(np.float64) if values.dtype.kind == "f" else values


def given_as(name, form):
    call, given = CASES[name]
    arrays = set(array_parameters(name))

    def formed(value):
        values = as_array(value)
        return values if values.dtype.kind == "b" or not values.ndim else form(values)

    return call, {
        argument: tuple(map(formed, value))
        if isinstance(value, tuple)
        else formed(value)
        if argument in arrays
        else value
        for argument, value in given.items()
    }


def bits(result):
    """All numbers in a result, as bytes."""
    if isinstance(result, np.ndarray | np.generic):
        return [(result.dtype.str, result.shape, result.tobytes())]
    if isinstance(result, tuple):
        return [part for value in result for part in bits(value)]
    if is_dataclass(result):
        return [part for field in fields(result) for part in bits(getattr(result, field.name))]
    if isinstance(result, bool | float | int | type(None)):
        return [repr(result)]
    public = [name for name in dir(type(result)) if not name.startswith("_")]
    values = [getattr(result, name) for name in public]
    return [part for value in values if isinstance(value, np.ndarray) for part in bits(value)]


@pytest.mark.parametrize("name", cases(CASES))
def test_the_form_of_arrays_does_not_matter(name):
    call, given = given_as(name, np.copy)
    expected = bits(call(**given))
    for form_name, form in FORMS.items():
        call, given = given_as(name, form)
        assert bits(call(**given)) == expected, form_name


@pytest.mark.parametrize("name", cases(name for name in CASES if "threads" in names_of(name)))
def test_the_number_of_threads_does_not_matter(name):
    call, given = given_as(name, np.copy)
    expected = bits(call(**given, threads=1))
    for threads in (0, 2, 3):
        assert bits(call(**given, threads=threads)) == expected
