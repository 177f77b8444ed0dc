# SPDX-License-Identifier: GPL-3.0-or-later
"""The texts about faces that have no limit surface."""

from limit_surface.tasks.refused_faces import left_out, reasons


def test_the_warning():
    assert left_out(3, 1200) == "3 of 1,200 faces have no limit surface and were left out"
    assert left_out(3, 1200, "why").endswith("were left out: why")


def test_the_commonest_reasons_come_first_each_with_its_first_face():
    refused = {2: "rare", 5: "common", 7: "common", 8: "third", 9: "fourth"}
    assert reasons(refused) == (
        "common (face 5; 2 in all); rare (face 2; 1 in all); third (face 8; 1 in all); "
        "1 more reason"
    )
