# SPDX-License-Identifier: GPL-3.0-or-later
"""What sources steer at the places of strands and points."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ..reading.cage import Cage
from . import flow_properties, value_properties
from .flow import Directions
from .source_mesh import Choice
from .value_properties import SourceNames
from .values import Values

if TYPE_CHECKING:
    import limitsurf

FLOW = "flow"


def choices(
    properties: bpy.types.OperatorProperties,
    context: bpy.types.Context,
    steered: Mapping[str, SourceNames],
) -> dict[str, Choice]:
    """Returns the choices of sources by what they steer, and that of the flow."""
    values = {name: source.choice(properties) for name, source in steered.items()}
    return {**values, FLOW: flow_properties.choice(properties, context)}


def draw_image_place(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
    steered: Mapping[str, SourceNames],
    drawn_already: str,
) -> None:
    """Draws how images are placed, unless they are drawn with another source already."""
    if getattr(properties, drawn_already) != "IMAGE":
        sources = [flow_properties.SOURCE, *(source.source for source in steered.values())]
        value_properties.draw_image_place(layout, properties, ob, sources)


class Steering:
    """The factors of what is steered at places of a surface: 1 where there is no source."""

    def __init__(
        self,
        sources: Mapping[str, Any],
        found: Cage,
        surface: limitsurf.LimitSurface,
        steered: Collection[str],
        signed: Collection[str],
    ) -> None:
        """`sources` has what the choices have read; `signed` names what negative factors steer to
        the other side. All other factors are at least 0.
        """
        self._signed = signed
        self._values: dict[str, Values | None] = {
            name: sources[name].on(surface) if sources.get(name) is not None else None
            for name in steered
        }
        flow = sources.get(FLOW)
        self._flow: Directions | None = flow and flow.on(found)

    def factors(self, face: np.ndarray, uv: np.ndarray) -> dict[str, np.ndarray]:
        """Returns factors (n, 1) by what they steer."""
        found = {}
        for name, values in self._values.items():
            factor = np.ones((len(face), 1)) if values is None else values(face, uv)[:, None]
            found[name] = factor if name in self._signed else np.maximum(factor, 0)
        return found

    def flow(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray | None:
        """Returns the flow (n, 3) in the world, or None where there is none."""
        return self._flow(face, uv) if self._flow else None
