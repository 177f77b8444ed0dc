# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension as it is released: it is built with a wheel for each Python of which headers are
here, checked, installed into a clean folder and used there. tools/release.sh names a zip that is
built already, by the environment variable LIMIT_SURFACE_ZIP.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest
from processes import ROOT, run_python

BUILDER = ROOT / "tools/build_extension.py"


def build(*options):
    return subprocess.run(
        [sys.executable, BUILDER, *options], capture_output=True, text=True, timeout=900
    )


@pytest.fixture(scope="module")
def other_headers() -> list[Path]:
    """Finds the headers of the other Python that Blender 4.2 to 5.2 runs on."""
    other = "python3.11" if sys.version_info >= (3, 13) else "python3.13"
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    kept = sorted(pyenv.glob(f"versions/*/bin/{other}"))
    for python in (shutil.which(other), shutil.which(f"/usr/bin/{other}"), *kept):
        if python is None:
            continue
        asked = subprocess.run(
            [python, "-c", "import sysconfig; print(sysconfig.get_paths()['include'])"],
            capture_output=True,
            text=True,
        )
        folder = Path(asked.stdout.strip())
        if asked.returncode == 0 and (folder / "patchlevel.h").exists():
            return [folder]
    return []


@pytest.fixture(scope="module")
def package(tmp_path_factory, other_headers) -> Path:
    if "LIMIT_SURFACE_ZIP" in os.environ:
        return Path(os.environ["LIMIT_SURFACE_ZIP"])
    folder = tmp_path_factory.mktemp("dist")
    options = [word for headers in other_headers for word in ("--python-headers", headers)]
    done = build("--build-wheel", *options, "--wheels", folder / "wheels", "--output", folder)
    assert done.returncode == 0, done.stdout + done.stderr
    (zip_file,) = folder.glob("limit_surface-*.zip")
    return zip_file


@pytest.fixture(scope="module")
def packages_without_limitsurf(tmp_path_factory) -> Path:
    """Makes a folder with links to this environment's packages, except for the module that the zip
    has to bring.
    """
    folder = tmp_path_factory.mktemp("packages")
    for entry in Path(sysconfig.get_paths()["platlib"]).iterdir():
        if not entry.name.lower().startswith(("limitsurf", "_limitsurf", "__pycache__")):
            (folder / entry.name).symlink_to(entry)
    return folder


def test_contents(package, other_headers):
    with zipfile.ZipFile(package) as contents:
        names = contents.namelist()
        manifest = contents.read("blender_manifest.toml").decode()
    wheels = [name for name in names if name.endswith(".whl")]
    assert len({wheel.split("-")[2] for wheel in wheels}) == len(wheels) == 1 + len(other_headers)
    for wheel in wheels:
        assert "manylinux" in wheel
        assert f'"./{wheel}"' in manifest
    assert "LICENSE" in names
    assert not [name for name in names if "__pycache__" in name]


INSTALL_AND_USE = """
import bpy, addon_utils, os
try:
    import limitsurf
except ModuleNotFoundError:
    pass
else:
    raise AssertionError("limitsurf is here before the extension brings it")

addon_utils.enable("bl_pkg")
installed = bpy.ops.extensions.package_install_files(
    filepath={package!r}, repo="user_default", enable_on_install=True
)
assert installed == {{"FINISHED"}}, installed

import limitsurf
import bl_ext.user_default.limit_surface as addon
user = os.path.realpath(os.environ["BLENDER_USER_RESOURCES"])
for module in (limitsurf, limitsurf._limitsurf, addon):
    assert os.path.realpath(module.__file__).startswith(user + os.sep), module.__file__
assert "bl_ext.user_default.limit_surface" in bpy.context.preferences.addons

mesh = bpy.data.meshes.new("Cross")
mesh.from_pydata(
    [(-1, -3, 0), (1, -3, 0), (1, -1, 2), (-1, -1, 2), (-3, -1, 0), (-1, 1, 2)], [],
    [(0, 1, 2, 3), (4, 3, 5)],
)
cross = bpy.data.objects.new("Cross", mesh)
bpy.context.scene.collection.objects.link(cross)
bpy.context.view_layer.objects.active = cross
assert bpy.ops.object.limit_hair_add(per_side=5) == {{"FINISHED"}}
hair = bpy.context.active_object
assert len(hair.data.curves) == 4 * 25
bpy.context.view_layer.objects.active = cross
assert bpy.ops.object.limit_points_add(per_side=5) == {{"FINISHED"}}
points = bpy.context.active_object

positions = [v.co[:] for v in mesh.vertices]
faces = [p.vertices[:] for p in mesh.polygons]
surface = limitsurf.LimitSurface(limitsurf.ControlMesh.from_faces(positions, faces))
for i, vertex in enumerate(points.data.vertices):
    face = points.data.attributes["limit_face"].data[i].value
    uv = points.data.attributes["limit_uv"].data[i].vector[:]
    root = surface.evaluate(face, [uv]).position[0]
    for place in (vertex.co, hair.data.curves[i].points[0].position):
        assert max(abs(a - b) for a, b in zip(place, root)) < 1e-6, (i, place[:], root)
print("used from", user)
"""


def test_installed_into_a_clean_folder_and_used(package, packages_without_limitsurf, tmp_path):
    done = run_python(
        INSTALL_AND_USE.format(package=str(package)),
        "-S",  # no site-packages except those named here
        PYTHONPATH=str(packages_without_limitsurf),
        BLENDER_USER_RESOURCES=str(tmp_path),
        PYTHONNOUSERSITE="1",
    )
    assert f"used from {os.path.realpath(tmp_path)}" in done.stdout


def test_no_wheel(tmp_path):
    done = build("--wheels", tmp_path, "--output", tmp_path)
    assert done.returncode != 0
    assert f"no limitsurf wheel in {tmp_path}" in done.stderr
    assert "--build-wheel" in done.stderr


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("limitsurf-{version}-cp311-cp311-linux_x86_64.whl", "auditwheel repair"),
        ("limitsurf-0.0.1-cp311-cp311-manylinux_2_34_x86_64.whl", "is not version"),
    ],
)
def test_wheels_that_must_not_be_shipped(tmp_path, package, name, reason):
    version = package.stem.split("-")[1]
    (tmp_path / name.format(version=version)).touch()
    done = build("--wheels", tmp_path, "--output", tmp_path)
    assert done.returncode != 0
    assert reason in done.stderr
    assert not list(tmp_path.glob("*.zip"))
