# SPDX-License-Identifier: Apache-2.0
"""Says what is wrong with the arguments of a call; the module asks when pybind11 refuses them."""

import operator
import re
import reprlib
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

INTEGER = "typing.SupportsInt | typing.SupportsIndex"
REAL = "typing.SupportsFloat | typing.SupportsIndex"
OR_NONE = " | None"
NATIVE = "limitsurf._limitsurf."

#: The least and the largest integer of arguments that have 64 bits; signatures do not tell. All
#: others have 32, also those of the same name.
BITS_32 = (-(2**31), 2**31 - 1)
BITS_64 = (-(2**63), 2**63 - 1)
SEEDS = (0, 2**64 - 1)
RANGES = {
    ("scatter_jittered", "seed"): SEEDS,
    ("scatter_uniform", "seed"): SEEDS,
    ("scatter_uniform", "count"): BITS_64,
    ("scatter_blue_noise", "seed"): SEEDS,
    ("scatter_blue_noise", "count"): BITS_64,
    ("scatter_along", "seed"): SEEDS,
    ("scatter_along", "count"): BITS_64,
}

# pybind11's signature of the only form of a function or a constructor, and where a parameter begins
# in it.
SIGNATURE = re.compile(
    r"(?P<function>\w+)\(\): incompatible .*supported:\n"
    r"    1\. (?P<made>[\w.]*)\((?P<parameters>.*)\)( -> [^\n]*)?\n(?!    2\.)"
)
PARAMETER = re.compile(r"(?:^|, )(\w+): ")
BY_NAME_ONLY = ", *"


class Parameter(NamedTuple):
    kind: str
    may_be_left_out: bool


def explanation(text: str, positional: Sequence[object], named: Mapping[str, object]) -> str | None:
    """The message for the first argument that is wrong, or None if none is known to be."""
    found = SIGNATURE.match(text)
    if found is None:
        return None
    parameters, places = _parameters(found["parameters"])
    if found["made"]:  # by a constructor, whose signature does not name the object
        positional = positional[1:]
    function = found["made"].removeprefix(NATIVE) or found["function"]
    given = dict(zip(parameters, positional, strict=False)) | dict(named)
    for name, value in given.items():
        allowed = RANGES.get((function, name), BITS_32)
        expected = name in parameters and _complaint(parameters[name].kind, allowed, value)
        if expected:
            return f"{name} is {_text(value)}; expected {expected}"
    if len(positional) > places:
        uncounted = "self" in parameters
        return (
            f"{function}() takes at most {places - uncounted} arguments by position; "
            f"{len(positional) - uncounted} given"
        )
    for name in named:
        if name not in parameters:
            return f"{function}() has no argument {reprlib.repr(name)}"
        if name in list(parameters)[: len(positional)]:
            return f"{function}() is given the argument {name} twice"
    for name, parameter in parameters.items():
        if name not in given and not parameter.may_be_left_out:
            return f"{function}() lacks the argument {name}"
    return None


def _text(value: object) -> str:
    """A value in a short line."""
    try:
        text = reprlib.repr(value)
    except ValueError:  # Python writes out no integer of more than some thousand digits
        if not isinstance(value, int):
            raise
        return f"an integer of {value.bit_length()} bits"
    lines = (line.strip() for line in text.splitlines())
    return " ".join(line for line in lines if line)


def _parameters(signature: str) -> tuple[dict[str, Parameter], int]:
    """The parameters, and the number of those that may be given without a name."""
    starts = list(PARAMETER.finditer(signature))
    ends = [start.start() for start in starts[1:]] + [len(signature)]
    parameters = {}
    places = len(starts)
    for start, end in zip(starts, ends, strict=True):
        kind, has_default, default = signature[start.end() : end].partition(" = ")
        parameters[start[1]] = Parameter(kind.removesuffix(BY_NAME_ONLY), bool(has_default))
        if (default or kind).endswith(BY_NAME_ONLY):
            places = len(parameters)
    return parameters, places


def _complaint(kind: str, allowed: tuple[int, int], value: object) -> str | None:
    """What was expected instead of the value; None if its type is right, or not one of these."""
    if kind.endswith(OR_NONE):
        kind = kind.removesuffix(OR_NONE)
        if value is None:
            return None
    if kind in (INTEGER, REAL) and _is_bool(value):
        return "an integer" if kind == INTEGER else "a number"
    if kind == INTEGER:
        try:
            number = operator.index(value)  # type: ignore[arg-type]
        except TypeError:
            return "an integer"
        if isinstance(value, np.ma.MaskedArray):
            return "an integer, not a masked array"
        least, most = allowed
        if number > most:
            return f"an integer below {most + 1}"
        if number < least:
            return f"an integer of at least {least}"
    if kind == REAL:
        return _complaint_of_real(value)
    if kind.startswith(NATIVE):
        wanted = kind.removeprefix(NATIVE)
        if wanted not in [base.__name__ for base in type(value).__mro__]:
            return f"{'an' if wanted[0] in 'AEIOU' else 'a'} {wanted}"
    if kind == "str" and not isinstance(value, str):
        return "a string"
    if kind == "bool" and not isinstance(value, bool | np.bool_):
        return "True or False"
    return None


def _complaint_of_real(value: object) -> str | None:
    if isinstance(value, np.ma.MaskedArray):
        return "a number, not a masked array"
    if not (_has(value, "__float__") or _has(value, "__index__")) or _is_bool(value):
        return "a number"
    if isinstance(value, np.ndarray | np.generic):
        if value.ndim == 0 and value.dtype.kind == "O":
            inside = value.item()
            return "a number" if isinstance(inside, np.ndarray) else _complaint_of_real(inside)
        # float() drops imaginary parts and reads texts.
        if value.ndim > 0 or value.dtype.kind not in "fiu":
            return "a number"
    try:
        float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return "a number"
    except OverflowError:
        return "a number below 1.8e308"
    return None


def _is_bool(value: object) -> bool:
    of_array = isinstance(value, np.ndarray) and value.ndim == 0 and value.dtype.kind == "b"
    return isinstance(value, bool | np.bool_) or of_array


def _has(value: object, method: str) -> bool:
    return hasattr(type(value), method)  # a class has the methods of its objects
