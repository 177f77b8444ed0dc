# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module, the add-on registered from this checkout, an empty file for each test."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "addon"), str(ROOT / "tools")]

import bpy  # noqa: E402
import limit_surface  # noqa: E402


@pytest.fixture(scope="session", autouse=True)
def addon():
    limit_surface.register()
    yield
    limit_surface.unregister()


@pytest.fixture(autouse=True)
def _empty_file(addon):
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
