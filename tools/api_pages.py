#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders the docstrings of the Python module and the comments of the C++ headers as web pages:
OUTPUT/python by pdoc, OUTPUT/cpp by Doxygen. A warning of either is an error.

Signatures come from the module's type stub, because pybind11's own know no types.
"""

import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "native/python/limitsurf"
#: What the stub imports from numpy; as they are they would be written out as long unions.
SHORT_TYPES = """
class ArrayLike:
    __module__ = "numpy.typing"
class DTypeLike:
    __module__ = "numpy.typing"
class NDArray:
    __module__ = "numpy.typing"
    def __class_getitem__(cls, item):
        return cls
"""
DOXYFILE = """
PROJECT_NAME = limitsurf
PROJECT_NUMBER = {version}
INPUT = {headers}
STRIP_FROM_PATH = {root}/native
STRIP_FROM_INC_PATH = {root}/native
OUTPUT_DIRECTORY = {output}
HTML_OUTPUT = .
GENERATE_LATEX = NO
JAVADOC_AUTOBRIEF = YES
EXTRACT_ALL = YES
HAVE_DOT = NO
CLASS_GRAPH = NO
QUIET = YES
WARN_AS_ERROR = FAIL_ON_WARNINGS
"""


class PagesError(Exception):
    """The pages cannot be rendered, or not without a warning."""


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--output", type=Path, default=ROOT / "build/api", help="folder to write to"
    )
    output = parser.parse_args().output.resolve()
    try:
        render_python(output / "python")
        render_cpp(output / "cpp")
    except PagesError as error:
        sys.exit(f"api_pages: {error}")
    print(f"{output}/python/limitsurf.html\n{output}/cpp/index.html")


def render_python(output: Path) -> None:
    import limitsurf
    import pdoc
    import pdoc.doc
    import pdoc.doc_pyi
    import pdoc.render

    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        pdoc.render.configure(
            docformat="numpy", show_source=False, footer_text=f"limitsurf {limitsurf.__version__}"
        )
        module = pdoc.doc.Module(limitsurf)
        stub = Path(folder) / "stub.pyi"
        stub.write_text(stub_text())
        try:
            add_types(module, stub)
            pages = pdoc.render.html_module(module, {"limitsurf": module})
        except Warning as warning:
            raise PagesError(f"pdoc warns: {warning}") from warning
    output.mkdir(parents=True, exist_ok=True)
    (output / "limitsurf.html").write_text(pages.replace(">Ellipsis<", ">...<"))


def stub_text() -> str:
    """Returns the module's stub as code that can run: its annotations name what comes later."""
    text = (PACKAGE / "_limitsurf.pyi").read_text()
    text, count = re.subn(r"^from numpy.typing import .*$", SHORT_TYPES, text, flags=re.MULTILINE)
    if count != 1:
        raise PagesError("the stub no longer imports its types from numpy.typing in one line")
    return f"from __future__ import annotations\n{text.replace('from ._', 'from limitsurf._')}"


def add_types(module: Any, stub: Path) -> None:
    """Gives the functions of a pdoc module the signatures of the stub, and takes those of pybind11
    out of the docstrings.
    """
    import pdoc.doc
    import pdoc.doc_pyi

    find, pdoc.doc_pyi.find_stub_file = pdoc.doc_pyi.find_stub_file, lambda name: stub
    try:
        pdoc.doc_pyi.include_typeinfo_from_stub_files(module)
    finally:
        pdoc.doc_pyi.find_stub_file = find
    places = [module, *(member for member in module.members.values() if member.kind == "class")]
    for place in places:
        for function in place.members.values():
            if isinstance(function, pdoc.doc.Function):
                own = rf"\A{re.escape(function.name)}\(.*\) -> .*\n*"
                function.docstring = re.sub(own, "", function.docstring)


def render_cpp(output: Path) -> None:
    doxygen = shutil.which("doxygen")
    if doxygen is None:
        raise PagesError("Doxygen is missing. On Debian: apt-get install doxygen")
    output.mkdir(parents=True, exist_ok=True)
    cmake = (ROOT / "CMakeLists.txt").read_text()
    found = re.search(r"project\(limitsurf VERSION ([0-9.]+)", cmake)
    assert found
    settings = DOXYFILE.format(
        version=found[1], headers=" ".join(public_headers()), root=ROOT, output=output
    )
    done = subprocess.run(
        [doxygen, "-"], input=settings, cwd=ROOT / "native", capture_output=True, text=True
    )
    if done.returncode:
        raise PagesError(f"Doxygen ended with {done.returncode}:\n{done.stdout}{done.stderr}")


def public_headers() -> list[str]:
    """Returns the headers that the library installs, relative to native/."""
    cmake = (ROOT / "native/CMakeLists.txt").read_text()
    (listed,) = re.findall(r"FILE_SET HEADERS BASE_DIRS \. FILES([^)]*)\)", cmake)
    return listed.split()


if __name__ == "__main__":
    main()
