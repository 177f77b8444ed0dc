# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties by which vertex groups, images and attributes steer strands."""

from __future__ import annotations

from collections.abc import Mapping

import bpy
import numpy as np
from bpy.props import FloatProperty

from ..placing.region import Region
from ..placing.roots import Locations
from ..sources import flow_properties, value_properties
from ..sources.flow import Directions
from ..sources.source_mesh import Choice
from ..sources.value_properties import SourceNames
from ..sources.values import Values

LENGTH = SourceNames.of("length", "Length")
RADIUS = SourceNames.of("radius", "Radius")
TILT = SourceNames.of("tilt", "Tilt")
RANDOM = SourceNames.of("random", "Random")
STEERED = {"length": LENGTH, "radius": RADIUS, "tilt": TILT, "random": RANDOM}
_LAID_OUT = (
    (("length",), LENGTH),
    (("points",), None),
    (("tilt",), TILT),
    (("random", "random_length"), RANDOM),
    (("radius",), RADIUS),
)


FLOW = "flow"


class SteeringProperties(flow_properties.FlowProperties):
    """Mixin with a source and a range for each property of strands that can be steered."""

    __annotations__ = {  # noqa: RUF012
        **LENGTH.properties("the length", "Factor of the length"),
        **RADIUS.properties("the radius", "Factor of the radius"),
        **TILT.properties("the tilt", "Factor of both angles of the tilt"),
        **RANDOM.properties("the random part", "Factor of Random and Random Length"),
        "random_length": FloatProperty(
            name="Random Length",
            description="Largest part of its length by which a strand is shorter, at random",
            default=0.0,
            min=0.0,
            max=1.0,
            subtype="FACTOR",
        ),
    }


class Steering:
    """The factors of what is steered at places of a surface: 1 where there is no source."""

    def __init__(self, region: Region) -> None:
        self._values: dict[str, Values] = {
            name: region.sources[name].on(region.surface)
            for name in STEERED
            if region.sources.get(name) is not None
        }
        flow = region.sources.get(FLOW)
        self._flow: Directions | None = flow and flow.on(region.cage)

    def factors(self, locations: Locations, rows: slice) -> dict[str, np.ndarray]:
        """Returns factors (n, 1) by what they steer. All but those of the tilt are at least 0."""
        face, uv = locations.face[rows], locations.uv[rows].astype(np.float64)
        found = dict.fromkeys(STEERED, np.ones((len(face), 1)))
        for name, values in self._values.items():
            found[name] = values(face, uv)[:, None]
            if name != "tilt":
                found[name] = np.maximum(found[name], 0)
        return found

    def flow(self, locations: Locations) -> np.ndarray | None:
        """Returns the flow (n, 3) in the world, or None where there is none."""
        if self._flow is None:
            return None
        return self._flow(locations.face, locations.uv.astype(np.float64))


def choices(
    properties: bpy.types.OperatorProperties, context: bpy.types.Context
) -> Mapping[str, Choice]:
    values = {name: source.choice(properties) for name, source in STEERED.items()}
    return {**values, FLOW: flow_properties.choice(properties, context)}


def draw(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
) -> None:
    """Draws the properties of the strands' shape, each with its source below it."""
    for names, source in _LAID_OUT:
        for name in names:
            layout.prop(properties, name)
        if source:
            source.draw(layout, properties, ob)
    flow_properties.draw(layout, properties, ob)


def draw_image_place(
    layout: bpy.types.UILayout,
    properties: bpy.types.OperatorProperties,
    ob: bpy.types.Object | None,
    drawn_already: str,
) -> None:
    if getattr(properties, drawn_already) != "IMAGE":
        sources = [flow_properties.SOURCE, *(source.source for source in STEERED.values())]
        value_properties.draw_image_place(layout, properties, ob, sources)
