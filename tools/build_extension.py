#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the Blender extension dist/limit_surface-VERSION.zip, the native module's wheels inside.

Takes every limitsurf wheel it finds in a folder, so that one zip can serve several versions of
Python; they must carry their own libraries (`auditwheel repair`). Run it by the Python of an
environment that has `bpy`, whose extension tool does the packing and the checks; no Blender
executable is needed.
"""

import argparse
import importlib.util
import shutil
import sys
import tempfile
import tomllib
from pathlib import Path

import wheels

ROOT = Path(__file__).resolve().parents[1]
ADDON = ROOT / "addon/limit_surface"
LICENCE = ROOT / "LICENSES/GPL-3.0-or-later.txt"
MANIFEST = "blender_manifest.toml"
NO_WHEELS = "wheels = []\n"


def main() -> None:
    arguments = parse_arguments()
    version = tomllib.loads((ADDON / MANIFEST).read_text())["version"]
    if arguments.build_wheel:
        wheels.build(arguments.wheels, arguments.python_headers)
    found = find_wheels(arguments.wheels, version)
    arguments.output.mkdir(parents=True, exist_ok=True)
    package = arguments.output / f"limit_surface-{version}.zip"
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "limit_surface"
        lay_out(source, found)
        blender_extension("build", "--source-dir", source, "--output-filepath", package)
    blender_extension("validate", package)
    print(f"{package}: {package.stat().st_size / 2**20:.1f} MiB with")
    for wheel in found:
        print(f"  {wheel.name}")


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--wheels", type=Path, default=ROOT / "dist/wheels", help="folder of repaired wheels"
    )
    parser.add_argument(
        "--output", type=Path, default=ROOT / "dist", help="folder to write the zip to"
    )
    parser.add_argument(
        "--build-wheel",
        action="store_true",
        help="first build and repair this Python's wheel into the folder of wheels",
    )
    parser.add_argument(
        "--python-headers",
        type=Path,
        action="append",
        default=[],
        metavar="INCLUDE",
        help="with --build-wheel: another wheel, for the Python of these headers "
        "(/usr/include/python3.13, say); may be repeated",
    )
    return parser.parse_args()


def find_wheels(folder: Path, version: str) -> list[Path]:
    found = sorted(folder.glob("limitsurf-*.whl"))
    if not found:
        fail(f"no limitsurf wheel in {folder}: make one with --build-wheel")
    for wheel in found:
        wheel_version, platform = wheel.stem.split("-")[1], wheel.stem.split("-")[-1]
        if wheel_version != version:
            fail(f"{wheel} is not version {version}, the extension's: rebuild or delete it")
        if platform.startswith("linux_"):
            fail(
                f"{wheel} relies on libraries of the system that built it: run `auditwheel repair` "
                "on it, and keep only what that writes"
            )
    return found


def lay_out(source: Path, packed: list[Path]) -> None:
    """Lays out a copy of the add-on with its licence, and the wheels in it and in its manifest."""
    shutil.copytree(ADDON, source, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(LICENCE, source / "LICENSE")
    (source / "wheels").mkdir()
    for wheel in packed:
        shutil.copy(wheel, source / "wheels")
    manifest = source / MANIFEST
    text = manifest.read_text()
    if NO_WHEELS not in text:
        fail(f"{ADDON / MANIFEST} has no line `{NO_WHEELS.strip()}` to fill in")
    lines = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in packed)
    manifest.write_text(text.replace(NO_WHEELS, f"wheels = [\n{lines}]\n"))


def blender_extension(*arguments: str | Path) -> None:
    """Runs Blender's own command line for extensions; it needs no running Blender."""
    spec = importlib.util.find_spec("bpy")  # the package is found without importing it
    if spec is None:
        fail(f"{sys.executable} has no bpy: run this by the environment's Python")
    bpy = Path(spec.origin).parent
    (tool,) = bpy.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    wheels.run(sys.executable, tool, *arguments)


def fail(message: str) -> None:
    sys.exit(f"build_extension: {message}")


if __name__ == "__main__":
    try:
        main()
    except wheels.BuildError as error:
        fail(str(error))
