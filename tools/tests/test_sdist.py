# SPDX-License-Identifier: Apache-2.0
"""The source package holds what builds the Python module, and nothing that was built."""

import email
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEXTS = ("CHANGELOG.md", "CMakeLists.txt", "LICENSE", "PKG-INFO", "README.md", "pyproject.toml")
FOLDERS = ("LICENSES/", "native/cmake/", "native/fuzz/", "native/limitsurf/", "native/python/")
#: Ends of the names of the files that the folders hold
ENDS = (".cmake", ".cpp", ".h", ".hex", ".in", ".map", ".md", ".py", ".pyi", ".txt", "py.typed")


@pytest.fixture(scope="module")
def package(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("sdist")
    command = (sys.executable, "-m", "build", "--sdist", "--no-isolation", "-o", folder, ROOT)
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    (package,) = folder.glob("limitsurf-*.tar.gz")
    return package


@pytest.fixture(scope="module")
def names(package) -> set[str]:
    with tarfile.open(package) as archive:
        return {name.partition("/")[2] for name in archive.getnames()}


def test_nothing_that_was_built(names):
    for name in names:
        if name not in (*TEXTS, "native/CMakeLists.txt"):
            assert name.startswith(FOLDERS), name
            assert name.endswith(ENDS), name


def test_all_that_is_compiled(names):
    """The files that CMake and pyproject.toml name, as patterns or one by one."""
    wanted = {
        path.relative_to(ROOT).as_posix()
        for folder in ("limitsurf", "python", "cmake")
        for path in (ROOT / "native" / folder).rglob("*")
        if path.suffix in (".cpp", ".h", ".py", ".pyi", ".cmake", ".in", ".txt", ".typed")
    }
    assert len(wanted) > 300
    assert wanted | set(TEXTS) <= names


def test_long_description_has_no_relative_links(package):
    """A relative link leads nowhere on PyPI."""
    with tarfile.open(package) as archive:
        (member,) = [item for item in archive if item.name.endswith("/PKG-INFO")]
        content = archive.extractfile(member)
        assert content is not None
        metadata = email.message_from_bytes(content.read())
    text = metadata.get_payload()
    assert isinstance(text, str)
    assert text.startswith("# Limit Surface")
    links = [part.partition(")")[0] for part in text.split("](")[1:]]
    assert len(links) > 20
    assert [link for link in links if not link.startswith("https://")] == []
    urls = dict(url.split(", ") for url in metadata.get_all("Project-URL"))
    assert {"Homepage", "Documentation", "Changelog", "Source", "Issues"} <= set(urls)
    assert all(any(link.startswith(urls[name]) for link in links) for name in ("Source",))
