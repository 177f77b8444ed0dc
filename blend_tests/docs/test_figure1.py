# SPDX-License-Identifier: GPL-3.0-or-later
"""The program that draws figure 1 runs, for a very small picture."""

import subprocess
import sys

import bpy
import numpy as np
import pytest
from processes import ROOT


@pytest.mark.slow
def test_figure_and_scene_are_written(tmp_path):
    program = (sys.executable, str(ROOT / "docs/figures/make.py"), "figure1", "--keep-scene")
    options = ("--width", "300", "--samples", "1", "--output", str(tmp_path))
    done = subprocess.run([*program, *options], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    for said in ("12 vertices, 5 faces", "2000 strands", "24500 strands", "rendered in"):
        assert said in done.stdout

    image = bpy.data.images.load(str(tmp_path / "figure1.png"))
    pixels = np.array(image.pixels).reshape(112, 300, 4)[:, :, :3]
    for panel in np.split(pixels, 3, axis=1):
        assert (panel.min(axis=2) > 0.95).mean() > 0.2  # the white background
        assert (panel.max(axis=2) < 0.9).mean() > 0.1  # the picture is not empty

    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "figure1.blend"))
    counts = sorted(len(curves.curves) for curves in bpy.data.hair_curves)
    assert counts == [5 * 20 * 20, 5 * 70 * 70]
