# SPDX-License-Identifier: Apache-2.0
"""Wheels of the native module that carry the libraries they need.

For the Python that runs this, and for others of which there are only the headers: a module needs
no more to be compiled, and is tried where that Python is. All of them link one library, which is
compiled once, in the build tree of the preset `release`.
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

ROOT = Path(__file__).resolve().parents[1]
LIBRARY_TREE = ROOT / "build/cpp"
MULTIARCH = "x86_64-linux-gnu"


class BuildError(Exception):
    """A program that the build runs has failed."""


def build(folder: Path, other_headers: list[Path]) -> None:
    """Repaired wheels into `folder`: for this Python, and for each of the other ones' headers.

    Builds without isolation: with what this environment holds, and no network.
    """
    with alone(), tempfile.TemporaryDirectory() as raw:
        library = compiled_library()
        pip = (sys.executable, "-m", "pip", "--disable-pip-version-check")
        prebuilt = f"cmake.define.LIMITSURF_PREBUILT={library}"
        options = ("-q", "--no-deps", "--no-build-isolation", "-C", prebuilt)
        run(*pip, "wheel", *options, "-w", raw, ROOT)
        (own,) = Path(raw).glob("limitsurf-*.whl")
        wheels = [own]
        for headers in other_headers:
            wheels.append(with_module(own, compiled_module(headers, library), interpreter(headers)))
        for wheel in wheels:
            run(sys.executable, "-m", "auditwheel", "repair", "-w", folder, wheel)


def interpreter(headers: Path) -> str:
    """Such as cp313."""
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


def compiled_library() -> Path:
    """The folder of the library's CMake package, after it has been brought up to date."""
    if not (LIBRARY_TREE / "build.ninja").exists():
        run("cmake", "-S", ROOT, "--preset", "release")
    compile_in(LIBRARY_TREE, "--target", "limitsurf")
    return LIBRARY_TREE / "native"


def compile_in(build_tree: Path, *options: str) -> None:
    jobs = os.environ.get("LIMITSURF_JOBS") or str(os.cpu_count())
    run("cmake", "--build", build_tree, "--parallel", jobs, *options)


def compiled_module(headers: Path, library: Path) -> Path:
    """The native module for the Python whose headers lie in a folder such as include/python3.13."""
    name = interpreter(headers)
    build_folder = ROOT / "build" / f"{name}-headers"
    include = build_folder / "include"
    for source in (headers, headers.parent / MULTIARCH / headers.name):
        if source.exists():  # Debian keeps pyconfig.h apart
            target = include / source.relative_to(headers.parent)
            shutil.copytree(source, target, dirs_exist_ok=True)
    suffix = f".cpython-{name.removeprefix('cp')}-{MULTIARCH}.so"
    definitions = {
        "CMAKE_BUILD_TYPE": "Release",
        "CMAKE_SYSTEM_NAME": "Linux",  # set, this is a build for elsewhere: no interpreter is asked
        "CMAKE_SYSTEM_PROCESSOR": "x86_64",
        "CMAKE_CXX_FLAGS": f"-isystem {include}",
        "LIMITSURF_PREBUILT": library,
        "Python_INCLUDE_DIR": include / headers.name,
        "PYTHON_IS_DEBUG": "OFF",
        "PYTHON_MODULE_EXTENSION": suffix,
        "PYTHON_MODULE_DEBUG_POSTFIX": "",
        "pybind11_DIR": run(sys.executable, "-m", "pybind11", "--cmakedir").strip(),
    }
    options = [f"-D{key}={value}" for key, value in definitions.items()]
    run("cmake", "-S", ROOT, "-B", build_folder, "-G", "Ninja", *options)
    compile_in(build_folder)
    return build_folder / f"native/python/_limitsurf{suffix}"


def with_module(wheel: Path, module: Path, name: str) -> Path:
    """A copy of a wheel that is not yet repaired, with another Python's module in it."""
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
    """What the program says; it is shown only where it fails."""
    programs = Path(sys.executable).parent  # not resolved: the environment's, not the system's
    environment = {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:
        print(done.stdout + done.stderr, file=sys.stderr, end="")
        raise BuildError(f"{' '.join(map(str, command))} ended with {done.returncode}")
    return done.stdout
