# SPDX-License-Identifier: Apache-2.0
"""The runner of the programs that draw the documentation's figures."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest
from figures import make

ROOT = Path(__file__).parents[2]
#: Screenshots of the tests in a window
SCREENSHOTS = {"first_minute", "snap_modal"}
#: Plots of tools/bench_report.py; some are drawn only when it runs on a quiet machine
PLOTS = {"benchmark_batch", "benchmark_depth", "benchmark_opening", "benchmark_threads"}


def run(*options: str) -> subprocess.CompletedProcess[str]:
    program = [sys.executable, str(ROOT / "docs/figures/make.py"), *options]
    return subprocess.run(program, capture_output=True, text=True, timeout=120)


def test_list_names_every_figure():
    listed = [line.split()[0] for line in run("--list").stdout.splitlines()]
    assert listed == list(make.FIGURES)


def test_every_picture_of_the_documentation_has_its_figure():
    pictures = {path.stem for path in (ROOT / "docs/images").iterdir()}
    drawn = {name for name, figure in make.FIGURES.items() if figure.folder.name == "images"}
    assert pictures - PLOTS == drawn | SCREENSHOTS


@pytest.mark.parametrize("name", make.FIGURES)
def test_every_figure_has_its_function(name):
    figure = make.FIGURES[name]
    module = ROOT / "docs/figures" / (figure.module.replace(".", "/") + ".py")
    functions = {
        node.name: [argument.arg for argument in node.args.args]
        for node in ast.parse(module.read_text()).body
        if isinstance(node, ast.FunctionDef)
    }
    arguments = functions[figure.function]
    assert arguments[0] == "folder"
    assert ("samples" in arguments) == figure.rendered


def test_unknown_names_are_refused():
    done = run("report", "nosuch")
    assert done.returncode == 2
    assert "no figure is called nosuch" in done.stderr


def test_options_of_one_figure_are_refused_for_others():
    done = run("report", "--keep-scene")
    assert done.returncode == 2
    assert "figure1 alone" in done.stderr


def test_a_missing_measurement_is_told(tmp_path):
    if (ROOT / "out/eigenbasis_boundary.csv").exists():
        pytest.skip("it has been measured here")
    done = run("eigenbasis_error", "--output", str(tmp_path))
    assert done.returncode == 1
    assert "tools/verify_eigenbasis" in done.stderr
