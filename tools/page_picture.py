# SPDX-License-Identifier: Apache-2.0
"""What programs that render a page's picture have in common: options, and the extension."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "addon"))

import limit_surface  # noqa: E402


def run(description: str, page: str, make: Callable[[Path, int], None]) -> None:
    """`make` gets the picture's path and the samples for each pixel."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--output", type=Path, default=ROOT / f"docs/images/{page}.png")
    parser.add_argument("--samples", type=int, default=32, help="per pixel")
    arguments = parser.parse_args()
    limit_surface.register()
    make(arguments.output, arguments.samples)
    limit_surface.unregister()
    print(f"{arguments.output}: {arguments.output.stat().st_size >> 10} KiB")
