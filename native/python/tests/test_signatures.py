# SPDX-License-Identifier: Apache-2.0
"""The stub _limitsurf.pyi names the parameters that the native module has.

`stubtest` (tools/types.sh) checks which classes and functions there are. It cannot see the
parameters of native functions, which stand in the first line of their docstrings.
"""

import ast
from pathlib import Path

import limitsurf
import pytest
from limitsurf import _limitsurf

STUB = ast.parse(Path(limitsurf.__file__).with_name("_limitsurf.pyi").read_text())


def functions():
    """(name with its class, the stub's definition)"""
    for node in STUB.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, node
        elif isinstance(node, ast.ClassDef):
            for member in node.body:
                if isinstance(member, ast.FunctionDef) and not is_property(member):
                    yield f"{node.name}.{member.name}", member


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


UNCALLABLE = (
    "EdgeCurves.__init__",
    "FixedSamples.__init__",
    "StrandPoser.__init__",
    "SurfaceData.__init__",
)
FUNCTIONS = {name: node for name, node in functions() if name not in UNCALLABLE}


def native(name):
    """The definition that the docstring of the native function begins with."""
    found = _limitsurf
    for part in name.split("."):
        found = getattr(found, part)
    line = found.__doc__.split("\n", 1)[0]
    (definition,) = ast.parse(f"def {line}: ...").body
    return definition


def parameters(definition):
    """(name, whether it is given by name alone, default or None) of each but self."""
    at = definition.args
    assert at.vararg is None
    assert at.kwarg is None
    by_place = [*at.posonlyargs, *at.args]
    defaults = [None] * (len(by_place) - len(at.defaults)) + at.defaults
    found = [(a.arg, False, d) for a, d in zip(by_place, defaults, strict=True)]
    found += [(a.arg, True, d) for a, d in zip(at.kwonlyargs, at.kw_defaults, strict=True)]
    return [parameter for parameter in found if parameter[0] != "self"]


def is_known(default):
    """Neither `...`, which stands for any, nor something that is not a literal."""
    try:
        return default is not None and ast.literal_eval(default) is not ...
    except ValueError:
        return False


@pytest.mark.parametrize("name", FUNCTIONS)
def test_parameters(name):
    stub, own = parameters(FUNCTIONS[name]), parameters(native(name))
    assert [p[:2] for p in stub] == [p[:2] for p in own]
    for (parameter, _, told), (_, _, default) in zip(stub, own, strict=True):
        assert (told is None) == (default is None), parameter
        if is_known(told) and is_known(default):
            assert ast.literal_eval(told) == ast.literal_eval(default), parameter


def test_there_are_many():
    assert len(FUNCTIONS) > 40
