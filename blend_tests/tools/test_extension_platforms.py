# SPDX-License-Identifier: GPL-3.0-or-later
"""The zips that are built from wheels of several platforms and Pythons. The wheels here are empty
files: only their names count.
"""

import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest
import wheel_names
from processes import ROOT

VERSION = tomllib.loads((ROOT / "addon/limit_surface/blender_manifest.toml").read_text())["version"]
LINUX = "manylinux_2_17_x86_64.manylinux2014_x86_64"


def build(folder: Path, *wheels: str) -> subprocess.CompletedProcess[str]:
    """Builds zips in the folder of wheels with such tags."""
    (folder / "wheels").mkdir()
    for tags in wheels:
        (folder / "wheels" / f"limitsurf-{VERSION}-{tags}.whl").touch()
    return subprocess.run(
        [sys.executable, ROOT / "tools/build_extension.py",
         "--wheels", folder / "wheels", "--output", folder],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip


def manifest_of(package: Path) -> dict:
    with zipfile.ZipFile(package) as contents:
        return tomllib.loads(contents.read("blender_manifest.toml").decode())


def wheels_in(package: Path) -> set[str]:
    with zipfile.ZipFile(package) as contents:
        names = {Path(name).stem for name in contents.namelist() if name.endswith(".whl")}
    return {name.removeprefix(f"limitsurf-{VERSION}-") for name in names}


def test_one_zip_holds_the_wheels_of_both_pythons(tmp_path):
    tags = {f"cp311-cp311-{LINUX}", f"cp313-cp313-{LINUX}"}
    done = build(tmp_path, *tags)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "linux-x64: cp311, cp313" in done.stdout
    (package,) = tmp_path.glob("*.zip")
    assert package.name == f"limit_surface-{VERSION}.zip"
    assert wheels_in(package) == tags
    manifest = manifest_of(package)
    assert manifest["platforms"] == ["linux-x64"]
    assert len(manifest["wheels"]) == 2
    assert manifest["blender_version_min"] == "4.2.13"
    assert set(manifest["permissions"]) == {"files"}


def test_each_platform_has_a_zip_with_its_own_wheels(tmp_path):
    tags = [
        f"{python}-{python}-{platform}"
        for python in ("cp311", "cp313")
        for platform in (LINUX, "win_amd64", "macosx_11_0_arm64")
    ]
    done = build(tmp_path, *tags)
    assert done.returncode == 0, done.stdout + done.stderr
    found = {package.stem: package for package in tmp_path.glob("*.zip")}
    assert len(found) == 3
    for platform, tag in (
        ("linux_x64", LINUX), ("windows_x64", "win_amd64"), ("macos_arm64", "macosx_11_0_arm64")
    ):  # fmt: skip
        package = found[f"limit_surface-{VERSION}-{platform}"]
        assert wheels_in(package) == {f"cp311-cp311-{tag}", f"cp313-cp313-{tag}"}
        generated = manifest_of(package)["build"]["generated"]  # it overrides the whole manifest's
        assert generated["platforms"] == [platform.replace("_", "-")]


@pytest.mark.parametrize(
    ("tags", "reason"),
    [
        (["cp311-cp311-musllinux_1_2_x86_64"], "is for musllinux_1_2_x86_64"),
        (
            [f"cp311-cp311-{LINUX}", "cp311-cp311-manylinux_2_28_x86_64"],
            "several wheels are for cp311 on linux-x64",
        ),
    ],
)
def test_wheels_that_do_not_fit_are_refused(tmp_path, tags, reason):
    done = build(tmp_path, *tags)
    assert done.returncode == 1
    assert reason in done.stderr
    assert not list(tmp_path.glob("*.zip"))


@pytest.mark.parametrize(
    ("tag", "platforms"),
    [
        (LINUX, ["linux-x64"]),
        ("manylinux_2_28_aarch64", ["linux-arm64"]),
        ("win_amd64", ["windows-x64"]),
        ("win_arm64", ["windows-arm64"]),
        ("macosx_10_15_x86_64", ["macos-x64"]),
        ("macosx_11_0_universal2", ["macos-arm64", "macos-x64"]),
    ],
)
def test_platforms_by_blenders_names(tag, platforms):
    wheel = Path(f"limitsurf-{VERSION}-cp313-cp313-{tag}.whl")
    assert wheel_names.blender_platforms(wheel) == platforms
