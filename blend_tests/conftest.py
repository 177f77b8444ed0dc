# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a module, with the add-on registered from this checkout and an empty file for each
test.
"""

import os
import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SUPPORT = Path(__file__).resolve().parent / "support"
sys.path[:0] = [str(SUPPORT), str(ROOT / "addon"), str(ROOT / "docs"), str(ROOT / "tools")]

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


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Of the cases of a test that is marked with every(n), all but each n-th one become slow."""
    seen = Counter[tuple[str, str]]()
    for item in items:
        if isinstance(item, pytest.Function) and (mark := item.get_closest_marker("every")):
            test = str(item.path), item.originalname
            if seen[test] % mark.args[0]:
                item.add_marker(pytest.mark.slow)
            seen[test] += 1


_exit_status = pytest.StashKey[int]()


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash[_exit_status] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Ends the process at once, when everything has been reported: Blender's own exit handlers
    sometimes block each other.
    """
    config.get_terminal_writer().flush()
    sys.stdout.flush()
    sys.stderr.flush()
    if _exit_status in config.stash:
        os._exit(config.stash[_exit_status])
