# SPDX-License-Identifier: Apache-2.0
"""The pages that pdoc and Doxygen make of docstrings and headers, without a warning."""

import re
import shutil
import sys
from pathlib import Path

import limitsurf
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import api_pages  # noqa: E402

pytestmark = pytest.mark.slow


def section(page: str, name: str) -> str:
    """Returns what the page says of a name, up to the next one."""
    begin = page.index(f'id="{name}"')
    return page[begin : page.index("</section>", begin)]


def test_python_pages_say_what_the_docstrings_say(tmp_path):
    api_pages.render_python(tmp_path)
    page = (tmp_path / "limitsurf.html").read_text()
    for name in limitsurf.__all__:
        assert section(page, name).count('class="docstring"') >= (name != "__version__"), name
    shown = re.sub(r"<[^>]+>", "", section(page, "LimitSurface.evaluate"))
    assert "derivatives: Literal[0, 1, 2] = 0" in re.sub(r"\s+", " ", shown)
    assert "SupportsInt" not in page, "a signature of pybind11 is shown"
    assert "Ellipsis" not in page


def test_a_warning_ends_the_rendering(tmp_path, monkeypatch):
    monkeypatch.setattr(api_pages, "stub_text", lambda: "this is no stub")
    with pytest.raises(api_pages.PagesError, match="Error parsing type stubs"):
        api_pages.render_python(tmp_path)


def test_cpp_pages_contain_every_installed_header(tmp_path):
    if shutil.which("doxygen") is None:
        pytest.skip("Doxygen is missing. On Debian: apt-get install doxygen")
    api_pages.render_cpp(tmp_path)
    pages = {path.name for path in tmp_path.glob("*.html")}
    assert {"classlimitsurf_1_1LimitSurface.html", "structlimitsurf_1_1Evaluation.html"} <= pages
    files = (tmp_path / "files.html").read_text()
    for header in api_pages.public_headers():
        assert f">{Path(header).name}<" in files, header


def test_a_wrong_comment_ends_the_rendering(tmp_path, monkeypatch):
    if shutil.which("doxygen") is None:
        pytest.skip("Doxygen is missing. On Debian: apt-get install doxygen")
    header = tmp_path / "wrong.h"
    header.write_text(
        "/** \\file */\n/** Does it. \\param there No such one. */\nvoid f(int here);\n"
    )
    monkeypatch.setattr(api_pages, "public_headers", lambda: [str(header)])
    with pytest.raises(api_pages.PagesError, match="there"):
        api_pages.render_cpp(tmp_path / "pages")
