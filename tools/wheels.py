# SPDX-License-Identifier: Apache-2.0
"""Wheels of the native module that carry the libraries they need.

They are built for the Python that runs this program, and for others of which only the headers are
installed: headers are enough to compile a module, which can be tested only where that Python is.
"""

import base64
import csv
import fcntl
import hashlib
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
MULTIARCH = "x86_64-linux-gnu"
ZIG = ROOT / "native/cmake/toolchains/zig.cmake"


class BuildError(Exception):
    """A program that the build runs has failed."""


class Library(NamedTuple):
    """How the library is compiled that the wheels' modules link."""

    tree: Path
    modules: Path  # the folder for the modules' build trees
    compiler: dict[str, str | Path]  # CMake variables of the library and of the modules
    dependencies: dict[str, str | Path]  # CMake variables of the library

    @classmethod
    def of_the_system(cls) -> "Library":
        """With the system's OpenSubdiv and oneTBB, which the repaired wheels then contain."""
        return cls(ROOT / "build/cpp", ROOT / "build", {}, {})

    @classmethod
    def bundled(cls, sources: Path | None, glibc: str | None) -> "Library":
        """With OpenSubdiv and oneTBB compiled from source: fetched, or from the folders
        `opensubdiv` and `tbb` in `sources`. With a version of glibc, such as "2.28", Zig compiles
        them for systems that have this version or a later one.
        """
        dependencies: dict[str, str | Path] = {"LIMITSURF_BUNDLED_DEPENDENCIES": "ON"}
        if sources is not None:
            for name in ("opensubdiv", "tbb"):
                source = (sources / name).resolve()
                if not source.is_dir():
                    raise BuildError(f"{source} is not a folder; expected the sources of {name}")
                dependencies[f"FETCHCONTENT_SOURCE_DIR_{name.upper()}"] = source
        tree, compiler = ROOT / "build/bundled", {}
        if glibc is not None:
            tree = ROOT / f"build/bundled-glibc{glibc}"
            compiler = {
                "CMAKE_TOOLCHAIN_FILE": ZIG,
                "LIMITSURF_ZIG_TARGET": f"{MULTIARCH}.{glibc}",
            }
        return cls(tree, tree / "modules", compiler, dependencies)


def build(folder: Path, other_headers: list[Path], library: Library) -> None:
    """Builds repaired wheels in `folder`: for this Python, and for each Python whose headers are
    given.

    The build is not isolated: it uses the packages of this environment, and no network, unless
    the library's dependencies are fetched.
    """
    with alone(), tempfile.TemporaryDirectory() as raw:
        package = compile_library(library)
        pip = (sys.executable, "-m", "pip", "--disable-pip-version-check")
        options = ["-q", "--no-deps", "--no-build-isolation"]
        for name, value in {"LIMITSURF_PREBUILT": package, **library.compiler}.items():
            options.append(f"--config-settings=cmake.define.{name}={value}")
        options.append(f"--config-settings=build-dir={library.modules}/{{wheel_tag}}")
        run(*pip, "wheel", *options, "-w", raw, ROOT)
        (own,) = Path(raw).glob("limitsurf-*.whl")
        wheels = [own]
        for headers in other_headers:
            module = compiled_module(headers, package, library)
            wheels.append(with_module(own, module, interpreter(headers)))
        for wheel in wheels:
            run(sys.executable, "-m", "auditwheel", "repair", "-w", folder, wheel)


def interpreter(headers: Path) -> str:
    """Returns a name such as cp313."""
    levels = (headers / "patchlevel.h").read_text()
    major, minor = (
        re.search(rf"#define PY_{name}_VERSION\s+(\d+)", levels).group(1)
        for name in ("MAJOR", "MINOR")
    )
    return f"cp{major}{minor}"


@contextmanager
def alone() -> Iterator[None]:
    """Waits until no other process builds in this checkout's build trees."""
    (ROOT / "build").mkdir(exist_ok=True)
    with (ROOT / "build/wheels.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def compile_library(library: Library) -> Path:
    """Brings the library's CMake package up to date, and returns its folder."""
    definitions = {**library.compiler, **library.dependencies}
    if definitions or not (library.tree / "build.ninja").exists():
        if library.compiler:  # it finds neither GoogleTest nor Boost
            parts = ("BENCH", "TESTS", "TOOLS")
            definitions |= {f"LIMITSURF_BUILD_{part}": "OFF" for part in parts}
        options = [f"-D{key}={value}" for key, value in definitions.items()]
        run("cmake", "-S", ROOT, "--preset", "release", "-B", library.tree, *options)
    compile_in(library.tree, "--target", "limitsurf")
    return library.tree / "native"


def compile_in(build_tree: Path, *options: str) -> None:
    jobs = os.environ.get("LIMITSURF_JOBS") or str(os.cpu_count())
    run("cmake", "--build", build_tree, "--parallel", jobs, *options)


def compiled_module(headers: Path, package: Path, library: Library) -> Path:
    """Returns the module for the Python whose headers lie in a folder such as
    include/python3.13.
    """
    name = interpreter(headers)
    build_folder = library.modules / f"{name}-headers"
    include = build_folder / "include"
    for source in (headers, headers.parent / MULTIARCH / headers.name):
        if source.exists():  # Debian stores pyconfig.h in another folder
            target = include / source.relative_to(headers.parent)
            shutil.copytree(source, target, dirs_exist_ok=True)
    suffix = f".cpython-{name.removeprefix('cp')}-{MULTIARCH}.so"
    definitions = {
        "CMAKE_BUILD_TYPE": "Release",
        # setting this makes it a cross build, which asks no interpreter
        "CMAKE_SYSTEM_NAME": "Linux",
        "CMAKE_SYSTEM_PROCESSOR": "x86_64",
        "CMAKE_CXX_FLAGS": f"-isystem {include}",
        "LIMITSURF_PREBUILT": package,
        "Python_INCLUDE_DIR": include / headers.name,
        "PYTHON_IS_DEBUG": "OFF",
        "PYTHON_MODULE_EXTENSION": suffix,
        "PYTHON_MODULE_DEBUG_POSTFIX": "",
        "pybind11_DIR": run(sys.executable, "-m", "pybind11", "--cmakedir").strip(),
        **library.compiler,
    }
    options = [f"-D{key}={value}" for key, value in definitions.items()]
    run("cmake", "-S", ROOT, "-B", build_folder, "-G", "Ninja", *options)
    compile_in(build_folder)
    return build_folder / f"native/python/_limitsurf{suffix}"


def with_module(wheel: Path, module: Path, name: str) -> Path:
    """Returns a copy of a wheel that is not yet repaired, with another Python's module in it."""
    own = wheel.stem.split("-")[2]
    target = wheel.with_name(wheel.name.replace(own, name))
    record = io.StringIO()
    rows = csv.writer(record, lineterminator="\n")
    with zipfile.ZipFile(wheel) as source, zipfile.ZipFile(target, "w") as copy:
        for item in source.infolist():
            content = source.read(item)
            if item.filename.endswith(".so"):
                item.filename = f"limitsurf/{module.name}"
                content = module.read_bytes()
            elif item.filename.endswith(".dist-info/WHEEL"):
                content = content.replace(own.encode(), name.encode())
            elif item.filename.endswith(".dist-info/RECORD"):
                record_item = item
                continue
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=")
            rows.writerow([item.filename, f"sha256={digest.decode()}", len(content)])
            copy.writestr(item, content)
        rows.writerow([record_item.filename, "", ""])
        copy.writestr(record_item, record.getvalue())
    return target


def run(*command: str | Path) -> str:
    """Returns the program's output, which is shown only where the program fails."""
    # the path is not resolved, so that it is the environment's program, not the system's
    programs = Path(sys.executable).parent
    environment = {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:
        print(done.stdout + done.stderr, file=sys.stderr, end="")
        raise BuildError(f"{' '.join(map(str, command))} ended with {done.returncode}")
    return done.stdout
