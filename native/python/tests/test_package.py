# SPDX-License-Identifier: Apache-2.0
import ast
import importlib.metadata
import subprocess
import sys
from pathlib import Path

import limitsurf as ls
import pytest

PACKAGE = Path(ls.__file__).parent
CLASSES = (
    ls.ControlMesh,
    ls.FilteredImage,
    ls.LimitSurface,
    ls.PtexLayout,
    ls.SubdividedFaces,
    ls.SurfaceData,
)


def test_version_is_the_distributions():
    assert ls.__version__ == importlib.metadata.version("limitsurf")


def test_errors_are_value_errors():
    assert issubclass(ls.MeshError, ValueError)
    assert issubclass(ls.LocationError, ValueError)
    assert not issubclass(ls.MeshError, ls.LocationError)


def test_all_names_exist_and_say_where_they_are_from():
    for name in ls.__all__:
        assert hasattr(ls, name)
    for public in (
        ls.ControlMesh,
        ls.FilteredImage,
        ls.LimitSurface,
        ls.MeshError,
        ls.LocationError,
        ls.PtexLayout,
        ls.SubdividedFaces,
        ls.SurfaceData,
    ):
        assert public.__module__ == "limitsurf"


def test_types_are_there_for_checkers():
    assert (PACKAGE / "py.typed").exists()
    stubs = ast.parse((PACKAGE / "_limitsurf.pyi").read_text())
    classes = {node.name: node for node in stubs.body if isinstance(node, ast.ClassDef)}
    for cls in CLASSES:
        name = cls.__name__
        stubbed = {n.name for n in classes[name].body if isinstance(n, ast.FunctionDef)}
        real = {n for n in vars(getattr(ls, name)) if not n.startswith("_")}
        assert stubbed - {"__init__"} == real
    stubbed = {node.name for node in stubs.body if isinstance(node, ast.FunctionDef)}
    assert {"bilinear", "blend_over", "box_sides", "box_weights"} <= stubbed


@pytest.mark.parametrize("cls", CLASSES)
def test_everything_public_has_a_docstring(cls):
    assert cls.__doc__
    for name, member in vars(cls).items():
        if not name.startswith("_"):
            assert member.__doc__, f"{cls.__name__}.{name}"


def test_importing_brings_numpy_alone():
    code = (
        "import sys, numpy.typing; before = set(sys.modules); import limitsurf;"
        "new = {m.split('.')[0] for m in set(sys.modules) - before};"
        "print(sorted(m for m in new if m not in sys.stdlib_module_names))"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "['limitsurf']"
