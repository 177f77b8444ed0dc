# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/distribution.md: points of the three distributions, and their spectra."""

from pathlib import Path

import limitsurf as ls
import numpy as np
from matplotlib.collections import LineCollection

from figures.meshes.grids import grid_faces
from figures.plots import plt, save

INK, FAINT, POINT = "#222222", "#c9c5ba", "#1b4f8f"
SPECTRUM_SIDE = 16  # faces along the flat square whose spectrum is taken
SPECTRUM_PER_FACE = 4  # points along each
SEEDS = 12


def sheet() -> ls.LimitSurface:
    """An open, curved sheet of uneven quads, with a hole and two triangles."""
    side = 6
    x, y = np.meshgrid(np.linspace(0, 1, side + 1), np.linspace(0, 1, side + 1))
    x, y = 0.35 * x + 0.65 * x**2, 0.6 * y + 0.4 * y**2
    x += 0.25 * y * (1 - y)
    z = 0.25 * np.sin(3 * x) * np.cos(2.5 * y)
    quads = grid_faces(side, side)
    faces = [q.tolist() for i, q in enumerate(quads) if i not in (9, 22, 23, 35)]
    a, b, c, d = quads[22]
    faces += [[a, b, c], [a, c, d]]  # triangles, which make irregular vertices
    positions = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    return ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))


def borders(surface: ls.LimitSurface) -> list[np.ndarray]:
    """The borders of all Ptex faces as lines on the surface, seen from above."""
    t = np.linspace(0, 1, 25)
    square = [(t, 0 * t), (t, 0 * t + 1), (0 * t, t), (0 * t + 1, t)]
    return [
        surface.evaluate(face, np.stack(side, axis=1)).position[:, :2]
        for face in range(surface.face_count)
        for side in square
    ]


def make_points(folder: Path) -> None:
    surface = sheet()
    jittered = surface.scatter_jittered(8)
    count = len(jittered)
    noise = surface.scatter_blue_noise(count=count)
    weights = np.clip(1.2 - np.linalg.norm(surface.positions[:, :2] - [0.3, 0.3], axis=1), 0.02, 1)
    dense = surface.scatter_blue_noise(count=count, density=weights**4)
    panels = (
        ("scatter_jittered(8)", jittered),
        (f"scatter_uniform({count})", surface.scatter_uniform(count)),
        (f"scatter_blue_noise(count={count})", noise),
        (f"scatter_blue_noise(count={count}, density=weights)", dense),
    )
    lines = borders(surface)
    figure, axes = plt.subplots(2, 2, figsize=(10, 10.4), layout="constrained")
    for axis, (title, at) in zip(axes.flat, panels, strict=True):
        axis.add_collection(LineCollection(lines, colors=FAINT, linewidths=0.8))
        place = surface.evaluate(at.face, at.uv).position
        axis.scatter(place[:, 0], place[:, 1], s=2.2, color=POINT, linewidths=0)
        axis.set_title(title, fontsize=10, color=INK)
        axis.set_aspect("equal")
        axis.axis("off")
    save(figure, folder / "scatter_points.png")


def unit_square() -> ls.LimitSurface:
    """A flat square with pinned corners, because spectra are defined in the plane."""
    side = np.linspace(0, 1, SPECTRUM_SIDE + 1)
    x, y = np.meshgrid(side, side)
    faces = grid_faces(SPECTRUM_SIDE, SPECTRUM_SIDE)
    positions = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    return ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, boundary="corners"))


def periodogram(points: np.ndarray, highest: int) -> np.ndarray:
    """|sum of exp(-2 pi i k x)|^2 / n for the frequencies -highest to highest along each axis."""
    k = np.arange(-highest, highest + 1)
    along_x = np.exp(-2j * np.pi * np.outer(k, points[:, 0]))
    along_y = np.exp(-2j * np.pi * np.outer(k, points[:, 1]))
    return np.abs(along_y @ along_x.T) ** 2 / len(points)


def nearest(points: np.ndarray) -> np.ndarray:
    """Distances to the nearest other point."""
    squared = ((points[:, None] - points[None]) ** 2).sum(axis=2)
    np.fill_diagonal(squared, np.inf)
    return np.sqrt(squared.min(axis=1))


def make_spectra(folder: Path) -> None:
    surface = unit_square()
    count = (SPECTRUM_SIDE * SPECTRUM_PER_FACE) ** 2
    kinds = (
        ("jittered", lambda seed: surface.scatter_jittered(SPECTRUM_PER_FACE, seed)),
        ("uniform", lambda seed: surface.scatter_uniform(count, seed)),
        ("blue noise", lambda seed: surface.scatter_blue_noise(count=count, seed=seed)),
    )
    highest = int(2.2 * np.sqrt(count))
    k = np.arange(-highest, highest + 1)
    rings = np.hypot(k[:, None], k).astype(int).ravel()
    figure, axes = plt.subplots(3, 3, figsize=(10.5, 9.6), layout="constrained")
    for row, (name, scatter) in zip(axes, kinds, strict=True):
        power = np.zeros((k.size, k.size))
        gaps = []
        for seed in range(SEEDS):
            at = scatter(seed)
            points = surface.evaluate(at.face, at.uv).position[:, :2]
            power += periodogram(points, highest) / SEEDS
            if seed < 3:
                gaps.append(nearest(points))
        power[highest, :] = power[:, highest] = np.nan  # they show the square, not the points
        row[0].imshow(power, cmap="gray", vmin=0, vmax=2.5, extent=[-2.2, 2.2, -2.2, 2.2])
        row[0].set_ylabel(name, fontsize=12)
        known = ~np.isnan(power.ravel())
        total = np.bincount(rings[known], power.ravel()[known])
        mean = total / np.maximum(np.bincount(rings[known]), 1)
        frequency = np.arange(mean.size) / np.sqrt(count)
        row[1].plot(frequency[2:highest], mean[2:highest], color=POINT, linewidth=1)
        row[1].axhline(1, color=FAINT, linewidth=0.8, zorder=0)
        row[1].set(ylim=(0, 2.5), xlim=(0, 2.2))
        row[2].hist(
            np.concatenate(gaps) * np.sqrt(count), bins=np.linspace(0, 1.5, 76), color=POINT
        )
        row[2].set_yticks([])
    titles = ("periodogram", "its mean over directions", "distance to the nearest point")
    for axis, title in zip(axes[0], titles, strict=True):
        axis.set_title(title, fontsize=11)
    for axis, label in zip(
        axes[2],
        ("frequency / √(points per area)",) * 2 + ("distance · √(points per area)",),
        strict=True,
    ):
        axis.set_xlabel(label)
    save(figure, folder / "scatter_spectra.png")
