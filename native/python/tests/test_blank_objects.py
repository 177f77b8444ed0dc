# SPDX-License-Identifier: Apache-2.0
"""Objects that Python makes without initialising them, `cls.__new__(cls)`: an error in every call.

Everything is found by looking into the native module, so that a new class is tested as well.
"""

import ast
import inspect

import limitsurf as ls
import numpy as np
import pytest
from limitsurf import _limitsurf

CLASSES = {
    name: member
    for name, member in vars(_limitsurf).items()
    if inspect.isclass(member) and not issubclass(member, Exception)
}
SQUARE = [[0.0, 0, 0], [1.0, 0, 0], [1.0, 1, 0], [0.0, 1, 0]]


def example(name):
    """An object of a class that is as it should be."""
    mesh = ls.ControlMesh.from_faces(SQUARE, [[0, 1, 2, 3]])
    surface = ls.LimitSurface(mesh)
    made = {
        "ControlMesh": lambda: mesh,
        "LimitSurface": lambda: surface,
        "SurfaceData": lambda: surface.vertex_data(np.array(SQUARE)[:, :2]),
        "EdgeCurves": lambda: surface.edge_curves(),
    }
    return made[name]()


def class_in(annotation):
    """The name of the bound class in an annotation of pybind11, or None."""
    text = "" if annotation is None else ast.unparse(annotation)
    return next((n for n in CLASSES if text.endswith((f"limitsurf.{n}", f"'{n}'"))), None)


def parameters(function):
    """(annotation, whether it is needed) of each parameter, by pybind11's own signature."""
    (definition,) = ast.parse(f"def {function.__doc__.splitlines()[0]}: ...").body
    at = definition.args
    needed = len(at.args) - len(at.defaults)
    return [(a.annotation, i < needed) for i, a in enumerate(at.args)]


def functions():
    """(name, function) of all functions, methods and constructors of the module."""
    for owner_name, owner in (("", _limitsurf), *CLASSES.items()):
        for name, member in vars(owner).items():
            member = getattr(member, "__func__", member)
            if callable(member) and not inspect.isclass(member) and "(" in (member.__doc__ or ""):
                yield f"{owner_name}.{name}".lstrip("."), member


def takers():
    """(name, function, place of the argument, class) for each argument of a bound class."""
    for name, function in functions():
        try:
            known = parameters(function)
        except SyntaxError:  # inherited from object
            continue
        for place, (annotation, _) in enumerate(known):
            own = class_in(annotation)
            if own and not (name.endswith(("__init__", "__setstate__")) and place == 0):
                yield pytest.param(function, known, place, own, id=f"{name}-{place}")


TAKERS = list(takers())


def stand_in(annotation):
    """Something that a parameter takes, or that is looked at later than the blank object."""
    own = class_in(annotation)
    if own:
        return example(own)
    text = ast.unparse(annotation)
    for part, value in (("tuple", (1.0, 1.0)), ("Float", 1.0), ("Int", 1), ("str", "x")):
        if part in text:
            return value
    return None


@pytest.mark.parametrize(("function", "known", "place", "own"), TAKERS)
def test_arguments_that_were_never_initialised(function, known, place, own):
    blank = CLASSES[own].__new__(CLASSES[own])
    values = []
    for i, (annotation, is_needed) in enumerate(known):
        if i == place:
            values.append(blank)
        elif is_needed or i < place:
            constructs = i == 0 and function.__name__ == "__init__"
            cls = CLASSES.get(class_in(annotation))
            values.append(cls.__new__(cls) if constructs else stand_in(annotation))
    with pytest.raises(TypeError, match=f"this {own} was never initialised"):
        function(*values)


@pytest.mark.parametrize("name", CLASSES)
def test_properties_of_what_was_never_initialised(name):
    blank = CLASSES[name].__new__(CLASSES[name])
    for attribute, member in vars(CLASSES[name]).items():
        if isinstance(member, property):
            with pytest.raises(TypeError, match=f"this {name} was never initialised"):
                getattr(blank, attribute)
    special = len if hasattr(CLASSES[name], "__len__") else repr
    with pytest.raises(TypeError, match=f"this {name} was never initialised"):
        special(blank)


def test_the_tests_see_all():
    assert {"ControlMesh", "LimitSurface", "SurfaceData", "StrandPoser"} <= set(CLASSES)
    assert {p.values[3] for p in TAKERS} == set(CLASSES)
    seen = {p.id for p in TAKERS}
    assert {"SubdividedFaces.__init__-1", "SubdividedFaces.__init__-2"} <= seen
    assert {"LimitSurface.project_along_normals-4", "LimitSurface.scatter_along-1"} <= seen
