# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps: their names, their values, and how values become colors.

Float files hold the values themselves. Files of 8 and 16 bits hold 0 to 1, so each map defines the
range of values that is mapped to 0 to 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .bodies import Body, Places

#: A range that is chosen automatically contains this percentage of the values.
FITTING = 95

#: Ratios of area and of length are clamped to 2^-16 and 2^16.
MOST_OCTAVES = 16.0

#: At irregular vertices curvature is averaged at this distance from them, as a share of an edge.
IRREGULAR_RADIUS = 1 / 64

#: Values that become colors at a time, so that their double precision takes little memory
ENCODED = 1 << 16

# the value that becomes 0, and the one that becomes 1
Range = tuple[np.ndarray | float, np.ndarray | float]


@dataclass(frozen=True)
class Settings:
    curvature: float  # the value that becomes 1 in 8 and 16 bits; 0: chosen automatically
    cavity: float  # the radius of a hollow that is black; 0: chosen automatically
    octaves: float  # the octaves of area or length that become 1
    radius: float  # see `irregular` of limitsurf's curvature()


@dataclass(frozen=True)
class MapKind:
    name: str
    description: str
    values: Callable[[Places, Settings], np.ndarray]  # (n, 3), or (n,) for grey
    range: Callable[[Body, Settings, np.ndarray], Range]


def _of_unit_vectors(_body: Body, _settings: Settings, _values: np.ndarray) -> Range:
    return -1.0, 1.0


def _of_positions(body: Body, _settings: Settings, _values: np.ndarray) -> Range:
    low, high = body.bounds
    flat = high <= low
    return low, np.where(flat, np.maximum(low + 1, np.nextafter(low, np.inf)), high)


def _of_curvature(_body: Body, settings: Settings, values: np.ndarray) -> Range:
    return _around_zero(settings.curvature, values)


def _of_gaussian(_body: Body, settings: Settings, values: np.ndarray) -> Range:
    return _around_zero(settings.curvature**2, values)


def _around_zero(wanted: float, values: np.ndarray) -> Range:
    largest = wanted or float(np.percentile(np.abs(values), FITTING)) or 1.0
    return -largest, largest


def _of_octaves(_body: Body, settings: Settings, _values: np.ndarray) -> Range:
    return -settings.octaves, settings.octaves


def _as_it_is(_body: Body, _settings: Settings, _values: np.ndarray) -> Range:
    return 0.0, 1.0


def cavity_radius(body: Body, settings: Settings) -> float:
    """The given radius, or 1 / 20 of the surface's size where none is given."""
    return settings.cavity or body.size / 20


def _cavity(places: Places, settings: Settings) -> np.ndarray:
    """Returns 1 where nothing is hollow, and 0 where mean curvature is that of a hollow of the
    radius.
    """
    return 1 - (places.mean * cavity_radius(places.body, settings)).clip(0, 1)


def _distortion(places: Places, _settings: Settings) -> np.ndarray:
    """Returns octaves of area, of the largest and of the smallest length. They are compared with
    the whole map afterwards.
    """
    d = places.distortion
    columns = np.stack([d.area, d.stretch_high, d.stretch_low], axis=1)
    with np.errstate(divide="ignore"):
        octaves = np.log2(columns)
    lost = np.isnan(octaves)
    octaves[lost] = -MOST_OCTAVES
    return octaves.clip(-MOST_OCTAVES, MOST_OCTAVES)


def mean_octave(octaves: np.ndarray) -> float:
    """Returns the octave of the whole map's area, if the rows are those of its texels."""
    found = octaves[np.abs(octaves[:, 0]) < MOST_OCTAVES, 0]
    return float(np.log2(np.exp2(found.astype(np.float64)).mean())) if found.size else 0.0


def compared(octaves: np.ndarray, mean: float) -> np.ndarray:
    """Returns the octaves relative to the whole map, so that a map without distortion has 0
    everywhere.
    """
    return (octaves - mean * np.array([1, 0.5, 0.5])).clip(-MOST_OCTAVES, MOST_OCTAVES)


def encoded(values: np.ndarray, range_: Range) -> np.ndarray:
    """Returns float32 numbers from 0 to 1. In between, double precision holds every range: the
    square of a large curvature overflows single precision, and a flat box far from the origin
    vanishes there.
    """
    low, high = (np.asarray(end, np.float64) for end in range_)
    out = np.empty(values.shape, np.float32)
    for begin in range(0, len(values), ENCODED):
        part = values[begin : begin + ENCODED].astype(np.float64)
        out[begin : begin + ENCODED] = ((part - low) / (high - low)).clip(0, 1)
    return out


NORMAL_TANGENT = "NORMAL_TANGENT"
AREA_DISTORTION = "AREA_DISTORTION"

#: The maps in the order of the menu. The values of tangent-space normals are made by shading.py.
KINDS = {
    "POSITION": MapKind(
        "Position",
        "Position of each texel on the limit surface",
        lambda p, _s: p.position,
        _of_positions,
    ),
    "NORMAL_OBJECT": MapKind(
        "Normal",
        "Exact normal in the chosen space",
        lambda p, _s: p.normal,
        _of_unit_vectors,
    ),
    NORMAL_TANGENT: MapKind(
        "Tangent Normal",
        "Exact normal in the form that a Normal Map node needs on polygons (MikkTSpace, OpenGL, "
        "+Y)",
        lambda p, _s: p.normal,
        _of_unit_vectors,
    ),
    "CURVATURE_MEAN": MapKind(
        "Mean Curvature",
        "Mean curvature (k1 + k2) / 2, negative where the surface bulges outward",
        lambda p, _s: p.mean,
        _of_curvature,
    ),
    "CURVATURE_GAUSSIAN": MapKind(
        "Gaussian Curvature",
        "Gaussian curvature k1 k2, negative on saddles",
        lambda p, _s: p.curvature.gaussian,
        _of_gaussian,
    ),
    "CURVATURE_PRINCIPAL": MapKind(
        "Principal Curvature",
        "The larger principal curvature k1 in red, the smaller one k2 in green, and half their "
        "difference in blue",
        lambda p, _s: np.stack([*p.principal, (p.principal[0] - p.principal[1]) / 2], axis=1),
        _of_curvature,
    ),
    "DIRECTION_1": MapKind(
        "Direction 1",
        "Direction along which the surface bends by the larger principal curvature k1, as a unit "
        "vector in the chosen space. Of the two opposite directions, it is the one towards which "
        "the map's U grows",
        lambda p, _s: p.directions[0],
        _of_unit_vectors,
    ),
    "DIRECTION_2": MapKind(
        "Direction 2",
        "Direction along which the surface bends by the smaller principal curvature k2, as a unit "
        "vector in the chosen space. Of the two opposite directions, it is the one towards which "
        "the map's U grows",
        lambda p, _s: p.directions[1],
        _of_unit_vectors,
    ),
    "CAVITY": MapKind(
        "Cavity",
        "White where the surface is flat or bulges, darker where it is hollow: 1 minus mean "
        "curvature times Cavity Radius",
        _cavity,
        _as_it_is,
    ),
    AREA_DISTORTION: MapKind(
        "Distortion",
        "How much the UV map stretches the surface, relative to the whole map: area in red, the "
        "largest and the smallest length in green and blue. Each doubling counts 1, each halving "
        "-1",
        _distortion,
        _of_octaves,
    ),
}
