#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the Blender extension dist/limit_surface-VERSION.zip, the native module's wheels inside.

Takes every limitsurf wheel it finds in a folder, so that one zip serves several versions of
Python: Blender 4.2 to 5.0 need a wheel for cp311, later ones need one for cp313. The wheels must
carry their own libraries (`auditwheel repair`). Wheels for several platforms give one zip for each
of them.

Run it by the Python of an environment that has `bpy`, whose extension tool does the packing and the
checks. No Blender executable is needed.
"""

import argparse
import importlib.util
import shutil
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path

import wheel_names
import wheels

ROOT = Path(__file__).resolve().parents[1]
ADDON = ROOT / "addon/limit_surface"
LICENCE = ROOT / "LICENSES/GPL-3.0-or-later.txt"
MANIFEST = "blender_manifest.toml"
NO_WHEELS = "wheels = []\n"
OWN_PLATFORM = 'platforms = ["linux-x64"]\n'


def main() -> None:
    arguments = parse_arguments()
    version = tomllib.loads((ADDON / MANIFEST).read_text())["version"]
    if arguments.build_wheel:
        library = wheels.Library.of_the_system()
        if arguments.bundled:
            library = wheels.Library.bundled(arguments.sources, arguments.glibc)
        wheels.build(arguments.wheels, arguments.python_headers, library)
    found = find_wheels(arguments.wheels, version)
    platforms = platforms_of(found)
    arguments.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        source, packed = Path(folder) / "limit_surface", Path(folder) / "packed"
        lay_out(source, found, list(platforms))
        packed.mkdir()
        if len(platforms) > 1:
            blender_extension(
                "build", "--source-dir", source, "--split-platforms", "--output-dir", packed
            )
        else:
            package = packed / f"limit_surface-{version}.zip"
            blender_extension("build", "--source-dir", source, "--output-filepath", package)
        for package in sorted(packed.iterdir()):
            blender_extension("validate", package)
            report(Path(shutil.move(package, arguments.output / package.name)))
    for platform, pythons in platforms.items():
        print(f"{platform}: {', '.join(pythons)}")


def report(package: Path) -> None:
    with zipfile.ZipFile(package) as contents:
        inside = [Path(name) for name in contents.namelist() if name.endswith(".whl")]
    print(f"{package}: {package.stat().st_size / 2**20:.1f} MiB with")
    for wheel in inside:
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
    parser.add_argument(
        "--bundled",
        action="store_true",
        help="with --build-wheel: compile OpenSubdiv and oneTBB from source into the module, "
        "instead of packing the system's libraries beside it",
    )
    parser.add_argument(
        "--sources",
        type=Path,
        metavar="FOLDER",
        help="with --bundled: take these sources from the folders opensubdiv and tbb in FOLDER, "
        "instead of fetching them",
    )
    parser.add_argument(
        "--glibc",
        metavar="VERSION",
        help="with --bundled: wheels for Linux systems with this version of glibc (2.28, say) or a "
        "later one, compiled by Zig (pip install ziglang)",
    )
    arguments = parser.parse_args()
    if arguments.bundled and not arguments.build_wheel:
        parser.error("--bundled needs --build-wheel")
    if arguments.sources and not arguments.bundled:
        parser.error("--sources needs --bundled")
    if arguments.glibc and not arguments.bundled:
        parser.error("--glibc needs --bundled")
    return arguments


def find_wheels(folder: Path, version: str) -> list[Path]:
    found = sorted(folder.glob("limitsurf-*.whl"))
    if not found:
        fail(f"no limitsurf wheel in {folder}: make one with --build-wheel")
    for wheel in found:
        if wheel_names.version(wheel) != version:
            fail(f"{wheel} is not version {version}, the extension's: rebuild or delete it")
        if any(tag.startswith("linux_") for tag in wheel_names.platform_tags(wheel)):
            fail(
                f"{wheel} relies on libraries of the system that built it: run `auditwheel repair` "
                "on it, and keep only what that writes"
            )
    return found


def platforms_of(found: list[Path]) -> dict[str, list[str]]:
    """Returns the Pythons of the wheels for each platform, by Blender's names of the platforms."""
    pythons: dict[str, list[str]] = {}
    for wheel in found:
        try:
            names = wheel_names.blender_platforms(wheel)
        except ValueError as error:
            fail(str(error))
        for name in names:
            pythons.setdefault(name, []).append(wheel_names.python(wheel))
    for name, there in pythons.items():
        doubled = sorted({python for python in there if there.count(python) > 1})
        if doubled:
            fail(f"several wheels are for {', '.join(doubled)} on {name}: keep one")
    return dict(sorted(pythons.items()))


def lay_out(source: Path, packed: list[Path], platforms: list[str]) -> None:
    """Lays out a copy of the add-on with its licence, and with the wheels, which its manifest names
    with their platforms.
    """
    shutil.copytree(ADDON, source, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(LICENCE, source / "LICENSE")
    (source / "wheels").mkdir()
    for wheel in packed:
        shutil.copy(wheel, source / "wheels")
    manifest = source / MANIFEST
    text = manifest.read_text()
    for line in (NO_WHEELS, OWN_PLATFORM):
        if line not in text:
            fail(f"{ADDON / MANIFEST} has no line `{line.strip()}` to fill in")
    lines = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in packed)
    names = ", ".join(f'"{name}"' for name in platforms)
    text = text.replace(NO_WHEELS, f"wheels = [\n{lines}]\n")
    manifest.write_text(text.replace(OWN_PLATFORM, f"platforms = [{names}]\n"))


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
