# SPDX-License-Identifier: Apache-2.0
"""The version is the same in every place that states it; it is changed in CMakeLists.txt."""

import re
import tomllib
from importlib.metadata import version
from pathlib import Path

import limitsurf
import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def project_version() -> str:
    cmake = (ROOT / "CMakeLists.txt").read_text()
    return re.search(r"project\(limitsurf VERSION ([0-9.]+)", cmake).group(1)


def test_python_module(project_version):
    assert version("limitsurf") == project_version
    assert limitsurf.__version__ == project_version


def test_extension_manifest(project_version):
    manifest = tomllib.loads((ROOT / "addon/limit_surface/blender_manifest.toml").read_text())
    assert manifest["version"] == project_version


def test_changelog_has_an_entry(project_version):
    headings = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), flags=re.MULTILINE)
    assert headings[0] == project_version


def test_consumer_asks_for_this_version(project_version):
    consumer = (ROOT / "native/tests/consumer/CMakeLists.txt").read_text()
    asked = re.search(r"find_package\(limitsurf ([0-9.]+)", consumer).group(1)
    assert project_version.startswith(f"{asked}.")
