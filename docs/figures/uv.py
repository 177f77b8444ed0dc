# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/uv.md: a UV map inverted, texel by texel."""

from pathlib import Path

import limitsurf as ls
import numpy as np
from matplotlib.collections import LineCollection

from figures.meshes.grids import fan, grid_faces
from figures.plots import plt

SIZE, MARGIN = 448, 6  # texels
NEAR = (118, 382, 26)  # the part shown enlarged: left, bottom, texels
INK, PAPER, OVERLAP, CONTROL = "#222222", (1, 1, 1), (0.86, 0.2, 0.15), "#c2571a"


def star(sectors: int, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Quads around a vertex, in the plane, within about [-1, 1]^2."""
    made = fan(sectors, side)
    return made.plan() / side, made.faces


def sheet(columns: int, rows: int, holes: tuple[int, ...] = ()) -> tuple[np.ndarray, np.ndarray]:
    """A grid of quads in [-1, 1]^2, without some of them."""
    x, y = np.meshgrid(np.linspace(-1, 1, columns + 1), np.linspace(-1, 1, rows + 1))
    faces = np.delete(grid_faces(columns, rows), holes, axis=0)
    return np.stack([x.ravel(), y.ravel()], axis=1), faces


def islands() -> tuple[ls.SurfaceData, np.ndarray, np.ndarray]:
    """A map of five islands; its values and the corners of its faces."""
    rng = np.random.default_rng(3)
    # Shape, middle, half its width and height: negative where it is mirrored.
    placed = [
        (star(5, 2), (0.26, 0.73), (0.15, 0.15)),
        (sheet(5, 5, (6, 18)), (0.74, 0.73), (0.2, 0.2)),
        (sheet(3, 3), (0.2, 0.24), (0.14, 0.14)),
        (sheet(3, 3), (0.49, 0.24), (-0.13, 0.14)),
        (sheet(4, 2), (0.77, 0.31), (0.19, 0.09)),
        (star(3, 2), (0.79, 0.2), (0.1, 0.1)),
    ]
    values, faces = [], []
    for (points, quads), middle, half in placed:
        faces.append(quads + sum(map(len, values)))
        moved = points + rng.uniform(-0.07, 0.07, points.shape)
        values.append(middle + np.array(half) * moved)
    plane, corners = np.concatenate(values), np.concatenate(faces)
    solid = np.column_stack([plane, np.zeros(len(plane))])
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(solid, corners))
    return surface.face_varying(plane, corners.ravel(), "none"), plane, corners


def texel_image(texels: ls.Texels) -> np.ndarray:
    """(u, v) as colours, borders of faces darker, the margin pale; overlaps red, mirrored islands
    striped."""
    u, v = texels.uv.T
    color = np.stack([0.25 + 0.7 * u, 0.3 + 0.6 * v, 0.95 - 0.5 * u], axis=1)
    color[np.minimum(texels.uv, 1 - texels.uv).min(axis=1) < 0.04] *= 0.55
    stripes = texels.flipped & ((texels.x + texels.y) % 8 < 2)
    color[stripes] = 0.55 * color[stripes] + 0.45
    color[texels.overlap] = 0.35 * color[texels.overlap] + 0.65 * np.array(OVERLAP)
    color[~texels.inside] = 0.45 * color[~texels.inside] + 0.55
    image = np.ones((SIZE, SIZE, 3))
    image[texels.y, texels.x] = color
    return image


def outlines(uv_map: ls.SurfaceData, faces: int) -> np.ndarray:
    """The sides of all faces on the map, in texels from the first one's centre."""
    t = np.linspace(0, 1, 25)
    sides = [(t, 0 * t), (t, 0 * t + 1), (0 * t, t), (0 * t + 1, t)]
    lines = [
        uv_map.evaluate(face, np.stack(side, axis=1)).value
        for face in range(faces)
        for side in sides
    ]
    return np.array(lines) * SIZE - 0.5


def draw_near(axis: plt.Axes, uv_map: ls.SurfaceData, texels: ls.Texels, image: np.ndarray) -> None:
    left, bottom, count = NEAR
    axis.imshow(image, origin="lower", interpolation="nearest")
    place = np.stack([texels.x, texels.y], axis=1).astype(float)
    near = ((place >= [left, bottom]) & (place < [left + count, bottom + count])).all(axis=1)
    margin = near & ~texels.inside
    border = SIZE * uv_map.evaluate(texels.face[margin], texels.uv[margin]).value - 0.5
    axis.add_collection(
        LineCollection(np.stack([place[margin], border], axis=1), colors="#777777", linewidths=0.7)
    )
    axis.plot(*place[near & texels.inside].T, ".", markersize=1.6, color=INK)
    axis.set_xlim(left - 0.5, left + count - 0.5)
    axis.set_ylim(bottom - 0.5, bottom + count - 0.5)


def figure() -> plt.Figure:
    uv_map, plane, corners = islands()
    texels = uv_map.rasterize(SIZE, SIZE, margin=MARGIN)
    image = texel_image(texels)
    result, axes = plt.subplots(1, 2, figsize=(12, 6.2), dpi=80, layout="constrained")
    axes[0].imshow(image, origin="lower", interpolation="nearest")
    left, bottom, count = NEAR
    axes[0].add_patch(
        plt.Rectangle((left, bottom), count, count, fill=False, edgecolor=INK, linewidth=1.2)
    )
    axes[0].set_title(f"{SIZE} x {SIZE} texels, a margin of {MARGIN}", fontsize=10, color=INK)
    draw_near(axes[1], uv_map, texels, image)
    axes[1].set_title(
        "the square, enlarged: borders of the limit (black), control polygon (orange)",
        fontsize=10,
        color=INK,
    )
    control = plane[corners[:, [0, 1, 2, 3, 0]]] * SIZE - 0.5
    axes[1].add_collection(LineCollection(control, colors=CONTROL, linewidths=1.1))
    axes[1].add_collection(
        LineCollection(outlines(uv_map, len(corners)), colors=INK, linewidths=1.1)
    )
    for axis in axes:
        axis.set_xticks([])
        axis.set_yticks([])
    return result


def picture() -> np.ndarray:
    """The picture's pixels from the top row down, RGB from 0 to 1."""
    drawn = figure()
    drawn.canvas.draw()
    pixels = np.asarray(drawn.canvas.buffer_rgba())[..., :3] / 255
    plt.close(drawn)
    return pixels


def make(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    plt.imsave(folder / "uv_locations.png", picture())
