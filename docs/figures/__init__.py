# SPDX-License-Identifier: Apache-2.0
"""The programs that draw the figures of the documentation and fill in its tables of measurements.

`make.py` runs them. A figure is a function that takes the folder to write to; one that Blender
renders also takes the number of samples for each pixel.
"""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class NotDrawnError(Exception):
    """A figure could not be drawn, or its measurements break a bound. The message says why."""
