# SPDX-License-Identifier: Apache-2.0
"""Says which argument of a call has a wrong type; the module asks when pybind11 refuses one."""

import re
import reprlib
from collections.abc import Iterable, Mapping, Sequence

INTEGER = "typing.SupportsInt | typing.SupportsIndex"
REAL = "typing.SupportsFloat | typing.SupportsIndex"
TWO_INTEGERS = f'typing.Annotated[collections.abc.Sequence[{INTEGER}], "FixedSize(2)"]'

# pybind11's signature of the only form of a function, and where a parameter begins in it.
SIGNATURE = re.compile(r"supported:\n    1\. \((.*)\) -> [^\n]*\n(?!    2\.)")
PARAMETER = re.compile(r"(?:^|, )(\w+): ")


def explanation(text: str, positional: Sequence[object], named: Mapping[str, object]) -> str | None:
    """The message for the first argument of a wrong type, or None if none is known to be."""
    signature = SIGNATURE.search(text)
    if signature is None:
        return None
    types = _parameter_types(signature[1])
    given = dict(zip(types, positional, strict=False)) | dict(named)
    for name, value in given.items():
        expected = _complaint(types.get(name, ""), value)
        if expected:
            return f"{name} is {reprlib.repr(value)}; expected {expected}"
    return None


def _parameter_types(signature: str) -> dict[str, str]:
    starts = list(PARAMETER.finditer(signature))
    ends = [start.start() for start in starts[1:]] + [len(signature)]
    return {
        start[1]: signature[start.end() : end].removesuffix(", *").split(" = ")[0]
        for start, end in zip(starts, ends, strict=True)
    }


def _complaint(kind: str, value: object) -> str | None:
    """What was expected instead of the value; None if its type is right, or not one of these."""
    if kind == INTEGER:
        if not hasattr(value, "__index__"):
            return "an integer"
        if not -(2**31) <= value.__index__() < 2**31:
            return "an integer below 2147483648"
    if kind == REAL and not (hasattr(value, "__float__") or hasattr(value, "__index__")):
        return "a number"
    if kind == TWO_INTEGERS:
        parts = list(value) if isinstance(value, Iterable) else []
        if len(parts) != 2 or any(_complaint(INTEGER, part) for part in parts):
            return "two integers"
    if kind == "str" and not isinstance(value, str | bytes):
        return "a string"
    if kind == "bool" and not hasattr(value, "__bool__"):
        return "True or False"
    return None
