# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about drawing: its examples run, and its tables match the operators."""

import bpy
import draw_scenes as drawn
import numpy as np
import pages

PAGE = pages.text("draw")


def section(title):
    return PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]


def test_tables_list_the_properties_and_their_defaults():
    pages.check_properties(section("What is made"), "limit_draw", category="view3d")
    pages.check_properties(section("Laying curves that exist"), "limit_curve_lay")


def test_example_from_scripts_draws_on_the_surface():
    (example,) = pages.examples(section("From scripts"))
    known = {}
    exec(example, known)
    drawing = known["drawing"]
    assert drawing.type == "CURVE"
    shown = drawn.world_points(drawing, 0)
    assert drawn.distance_from(drawing.parent, shown).max() < 0.001 + 1e-6


def test_example_in_python_states_what_it_keeps():
    (example,) = pages.examples(section("In Python"))
    known = {}
    exec(example, known)
    surface, path, fit = (known[name] for name in ("surface", "path", "fit"))
    assert path.deviation.max() <= 1e-4
    assert fit.deviation <= 4e-4
    assert fit.error <= 4e-4
    strand = known["strand"]
    steps = np.diff(surface.evaluate(strand.face, strand.uv).position, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    assert len(lengths) == 7
    assert lengths.max() < 1.05 * np.median(lengths)
    assert not np.array_equal(known["straighter"].uv, path.uv)
    assert not bpy.data.objects
