# SPDX-License-Identifier: GPL-3.0-or-later
"""The texts of the report."""

from collections.abc import Iterator, Mapping

from .distances import Distances

MESHES = {"VIEWPORT": "Viewport", "RENDER": "Render", "LEVEL": "Mesh"}


def numbers(found: Distances) -> dict[str, float]:
    """Returns the numbers that are stored, in world units."""
    return {
        "level": found.level,
        "max": found.apart.largest,
        "mean": found.apart.mean,
        "slide_max": found.slide.largest,
        "slide_mean": found.slide.mean,
    }


def sentence(mesh: str, kept: Mapping[str, float]) -> str:
    return (
        f"{MESHES[mesh]}, level {kept['level']}: {spread(kept, '')} from the surface; "
        f"{spread(kept, 'slide_')} from the same place on it"
    )


def short_sentence(mesh: str, kept: Mapping[str, float]) -> str:
    """Returns what fits the status bar beside the same of another mesh."""
    largest, slide = kept["max"], kept["slide_max"]
    return (
        f"{MESHES[mesh]}, level {kept['level']}: at most {largest:.3g} from the surface, "
        f"{slide:.3g} from the same place"
    )


def rows(kept: Mapping[str, float]) -> Iterator[tuple[str, str, str]]:
    """Yields the rows of a table that fits a sidebar of the usual width."""
    yield "Distance from", "Largest", "Mean"
    for title, of in (("the surface", ""), ("the same place", "slide_")):
        yield title, f"{kept[f'{of}max']:.3g}", f"{kept[f'{of}mean']:.3g}"


def spread(kept: Mapping[str, float], of: str) -> str:
    return f"at most {kept[f'{of}max']:.4g}, {kept[f'{of}mean']:.4g} on average"
