# SPDX-License-Identifier: GPL-3.0-or-later
"""The texts that report curvature."""

import numpy as np

from ..counting import by_count, counted
from .values import Values

QUANTITIES = {"MEAN": "mean", "GAUSSIAN": "Gaussian", "K1": "k1", "K2": "k2"}


def together(parts: list[Values], name: str) -> np.ndarray:
    return np.concatenate([getattr(part, name) for part in parts])


def lines(parts: list[Values], noun: str, radius: float, full: float, color: str) -> list[str]:
    found = together(parts, "exist")
    said = []
    for key, name in QUANTITIES.items():
        values = together(parts, key.lower())[found]
        if len(values):
            said.append(f"{name} {values.min():.4g} to {values.max():.4g}")
    averaged = np.count_nonzero(together(parts, "irregular") & found)
    return [
        f"Curvature at {counted(np.count_nonzero(found), noun)}: {', '.join(said)}",
        f"{averaged:,} at irregular vertices, averaged at a distance of {radius:.4g} edges",
        f"Full color: {QUANTITIES[color]} {full:.4g}",
    ]


def without(parts: list[Values], noun: str) -> str:
    """Returns a warning about places that have no curvature, or None."""
    found = together(parts, "exist")
    missing = np.count_nonzero(~found)
    if not missing:
        return ""
    have = by_count(missing, "has", "have")
    belong = by_count(missing, "it belongs", "they belong")
    return (
        f"{missing:,} of {counted(len(found), noun)} {have} no curvature: {belong} to no face with "
        "a limit surface, or the surface has no area there"
    )
