# SPDX-License-Identifier: GPL-3.0-or-later
"""The page about particles: its example runs, and its tables match the operators."""

import bpy
import pages
import particle_scenes
import pytest
import scenes
from figures import comparison, particles
from processes import ROOT

PAGE = pages.text("particles")


def test_example_runs():
    ob = scenes.cross()
    scenes.add_subsurf(ob)
    particle_scenes.add_hair(ob)
    for example in pages.examples(PAGE):
        exec(example, {})
    assert len(ob.particle_systems) == 1
    assert bpy.context.active_object.name == "Limit Hair.001"


def test_tables_list_the_properties_and_their_defaults():
    for heading, operator in (
        ("Particles from hair", "limit_particles_from_hair"),
        ("Hair from particles", "limit_hair_from_particles"),
    ):
        section = PAGE.split(f"## {heading}")[1].split("\n## ")[0]
        pages.check_properties(section, operator)


@pytest.mark.slow
def test_picture_is_what_the_operator_makes(tmp_path):
    particles.make(tmp_path, samples=4)
    mean, worst = comparison.of_renders(
        tmp_path / "particles.png", ROOT / "docs/images/particles.png"
    )
    assert mean < 0.8
    assert worst < 16
