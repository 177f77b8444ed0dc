# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/accuracy.md, OpenSubdiv's approximation beside the exact limit surface, and
its table of distances."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from figures import tables
from figures.exactness import sheet, zoo
from figures.exactness.distances import Comparison, Distance, compare
from figures.rendering import scene
from figures.rendering.sheet import light

PIXELS = (400, 340)  # of a panel
DEFAULT, BEST = 3, 10  # of the modifier's Quality


def make(folder: Path, name: str, samples: int = 16) -> None:
    scene.start()
    draw(zoo.FEATURES[name](), folder / f"exact_{name}.png", samples)


def make_table(folder: Path) -> None:
    tables.write("accuracy.md", {"distances": table()}, folder)


def table() -> str:
    lines = [
        "| | along the surface: largest (mean) | across it: largest (mean) | Quality 10: largest |",
        "|---|---|---|---|",
    ]
    for make in zoo.FEATURES.values():
        scene.start()
        feature = make()
        compared = compare(zoo.add(feature), feature.levels)
        off, best = compared.distance(DEFAULT), compared.distance(BEST)
        along, across = (f"{d.max():.1e} ({d.mean():.0e})" for d in (off.along, off.across))
        if feature.uvs is not None:
            across = ""
        lines.append(f"| {feature.title} | {along} | {across} | {best.whole.max():.0e} |")
    return "\n".join(lines)


def draw(feature: zoo.Feature, output: Path, samples: int) -> None:
    ob = zoo.add(feature)
    ob.hide_render = True
    far, near = compare(ob, feature.levels - 2), compare(ob, feature.levels)
    seen, close = whole(far, feature.overview), closeup(near, feature)
    off = near.distance(DEFAULT)
    around = np.abs((near.exact - close.middle) @ scene.axes(close.view)[:, :2])
    within = around.max(axis=1) < 0.6 * close.width
    with tempfile.TemporaryDirectory() as folder:
        parts = [Path(folder) / f"{i}.png" for i in range(3)]
        far_colours = shades(far.distance(DEFAULT).whole)
        show(far, far.shown(DEFAULT), far_colours, 4, seen, parts[0], samples, cage=True)
        for positions, distance, part in (
            (near.shown(DEFAULT), off.whole, parts[1]),
            (near.exact, 0 * off.whole, parts[2]),
        ):
            show(near, positions, shades(distance), feature.lines, close, part, samples, within)
        flat = feature.uvs is not None
        sheet.compose(
            [
                sheet.Panel(parts[0], "As Blender shows it: Quality 3", circle(close, seen)),
                sheet.Panel(parts[1], f"Close-up, {seen.width / close.width:.0f} times larger"),
                sheet.Panel(parts[2], f"The exact {'map' if flat else 'limit surface'} there"),
            ],
            notes(off, feature),
            output,
        )


def notes(off: Distance, feature: zoo.Feature) -> list[str]:
    along, across = (f"{100 * d.max():.2g} %" for d in (off.along, off.across))
    if feature.uvs is not None:
        said, blue = f"Off by up to {along} of an edge of the map.", "the map's control points"
    else:
        said = f"Off by up to {along} of an edge along the surface, {across} across it."
        blue = "the control mesh"
    return [said, f"Fine lines: u and v in steps of 1/{feature.lines}. Blue: {blue}."]


@dataclass(frozen=True)
class Frame:
    view: zoo.View
    middle: np.ndarray
    width: float


def whole(compared: Comparison, view: zoo.View) -> Frame:
    """All of the cage and the surface."""
    points = np.concatenate([compared.exact, compared.cage_edges.reshape(-1, 3)])
    axes = scene.axes(view)
    low, high = (points @ axes).min(axis=0), (points @ axes).max(axis=0)
    wide, tall, _ = high - low
    return Frame(view, axes @ ((low + high) / 2), 1.05 * max(wide, tall * PIXELS[0] / PIXELS[1]))


def closeup(compared: Comparison, feature: zoo.Feature) -> Frame:
    width = feature.extent * compared.mean_edge
    right_up = scene.axes(feature.close)[:, :2]
    focus = compared.exact[zoo.nearest(compared.exact, feature.focus)]
    return Frame(feature.close, focus - right_up @ feature.shift * width, width)


def circle(close: Frame, seen: Frame) -> tuple[float, float, float]:
    x, y = (close.middle - seen.middle) @ scene.axes(seen.view)[:, :2] / seen.width
    return 0.5 + x, PIXELS[1] / PIXELS[0] / 2 - y, close.width / seen.width / 2


def shades(distances: np.ndarray) -> np.ndarray:
    return light(sheet.shades(distances))


def show(
    compared: Comparison,
    positions: np.ndarray,
    colours: np.ndarray,
    lines: int,
    frame: Frame,
    path: Path,
    samples: int,
    within: np.ndarray | None = None,
    cage: bool = False,
) -> None:
    """Renders the surface with parameter lines; `within`: only near these vertices."""
    quads, rows = compared.quads, compared.parameter_lines(lines)
    if within is not None:
        quads = quads[within[quads].any(axis=1)]
        rows = [some[within[some].any(axis=1)] for some in rows]
    radius = scene.RADIUS * frame.width
    scene.add_surface(quads, positions, colours)
    ink = scene.GREY if cage else scene.INK
    scene.add_lines(
        "Far lines" if cage else "Lines", [positions[some] for some in rows], radius, ink
    )
    if cage:
        scene.add_lines("Cage", [compared.cage_edges], radius * 1.2, scene.CAGE_BLUE)
    scene.render(path, frame.view, frame.middle, frame.width, PIXELS, samples)
    scene.clear()
