# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operator is asked for."""

from typing import NamedTuple


class Settings(NamedTuple):
    in_world: bool
    radius: float  # around irregular vertices, as a share of an edge
    levels: int  # of a tessellation
    allow_large: bool
