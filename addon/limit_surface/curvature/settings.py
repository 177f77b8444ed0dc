# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of the operator, as plain data."""

from typing import NamedTuple


class Settings(NamedTuple):
    in_world: bool
    radius: float  # around irregular vertices, as a share of an edge
    levels: int  # number of subdivisions of a tessellation
    allow_large: bool
