# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/sampling.md: the node of the group Sample Limit Surface, drawn from the
group's own interface as Blender's node editor shows it.
"""

from pathlib import Path

import bpy
from limit_surface.nodes.sample_surface import SAMPLE_SURFACE
from matplotlib.patches import FancyBboxPatch, Rectangle

from figures.plots import plt, save

WIDTH, ROW, MARGIN = 6.4, 0.62, 0.5
# Blender's own colours of sockets, by their type; fields are diamonds
COLOURS = {
    "NodeSocketObject": "#ed9e5c",
    "NodeSocketInt": "#598c5c",
    "NodeSocketVector": "#6363c7",
    "NodeSocketBool": "#cca6d6",
    "NodeSocketRotation": "#a663c7",
}
FIELDS = {"NodeSocketInt", "NodeSocketVector", "NodeSocketRotation", "NodeSocketBool"}
BODY, HEADER, TEXT, BACK, FIELD = "#303030", "#246330", "#e6e6e6", "#1d1d1d", "#545454"


def make(folder: Path) -> None:
    group = SAMPLE_SURFACE.group()
    sockets = [item for item in group.interface.items_tree if item.item_type == "SOCKET"]
    outputs = [item for item in sockets if item.in_out == "OUTPUT"]
    inputs = [item for item in sockets if item.in_out == "INPUT"]
    rows = [*outputs, *inputs]
    height = ROW * (len(rows) + 1)
    figure, axes = plt.subplots(figsize=((WIDTH + 2 * MARGIN) * 0.6, (height + 2 * MARGIN) * 0.6))
    figure.subplots_adjust(0, 0, 1, 1)
    figure.set_facecolor(BACK)
    axes.set(xlim=(-MARGIN, WIDTH + MARGIN), ylim=(-height - MARGIN, MARGIN), aspect="equal")
    axes.axis("off")
    rounded = {"boxstyle": "round,pad=0,rounding_size=0.14", "edgecolor": "#101010"}
    axes.add_patch(FancyBboxPatch((0, -height), WIDTH, height, facecolor=BODY, **rounded))
    axes.add_patch(FancyBboxPatch((0, -ROW), WIDTH, ROW, facecolor=HEADER, **rounded))
    axes.text(0.3, -ROW / 2, group.name, color=TEXT, va="center", size=11)
    for i, item in enumerate(rows):
        _draw_socket(axes, item, -ROW * (i + 1.5))
    save(figure, folder / "sample_node.png", dpi=110)


def _draw_socket(axes: plt.Axes, item: bpy.types.NodeTreeInterfaceSocket, y: float) -> None:
    is_input = item.in_out == "INPUT"
    x = 0 if is_input else WIDTH
    marker = "D" if item.socket_type in FIELDS else "o"
    axes.plot([x], [y], marker, ms=8, color=COLOURS[item.socket_type], mec="#101010", clip_on=False)
    label = {"color": TEXT, "va": "center", "size": 10}
    if not is_input:
        axes.text(WIDTH - 0.3, y, item.name, ha="right", **label)
        return
    if item.socket_type != "NodeSocketBool":
        field = (0.3, y - 0.42 * ROW), WIDTH - 0.6, 0.84 * ROW
        axes.add_patch(Rectangle(*field, facecolor=FIELD, lw=0))
        axes.text(0.5, y, item.name, **label)
        return
    axes.add_patch(Rectangle((0.3, y - 0.2), 0.4, 0.4, facecolor=FIELD, lw=0))
    axes.text(0.9, y, item.name, **label)
