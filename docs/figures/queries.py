# SPDX-License-Identifier: Apache-2.0
"""The pictures of docs/queries.md: closest points, and rays."""

from pathlib import Path

import limitsurf as ls
import numpy as np
from matplotlib.collections import LineCollection

from figures.meshes.grids import fan, grid_faces
from figures.plots import plt, save

INK, FAINT, POINT, OTHER = "#222222", "#c9c5ba", "#1b4f8f", "#c2571a"
SIZE = np.array([960, 640])  # pixels of the picture made by rays
ZOOM = 250
PEER_LEVEL = 4


def extruded(profile: np.ndarray) -> ls.LimitSurface:
    """A sheet whose every section across y is the same curve."""
    count, rows = len(profile), 4
    positions = np.zeros((rows, count, 3))
    positions[..., [0, 2]] = profile
    positions[..., 1] = np.arange(rows)[:, None]
    faces = grid_faces(count - 1, rows - 1)
    return ls.LimitSurface(ls.ControlMesh.from_faces(positions.reshape(-1, 3), faces))


def in_plane(xz: np.ndarray) -> np.ndarray:
    return np.stack([xz[:, 0], np.full(len(xz), 1.5), xz[:, 1]], axis=1)


def draw_section(axis: plt.Axes, surface: ls.LimitSurface, title: str) -> None:
    columns = surface.face_count // 3
    u = np.linspace(0, 1, 40)
    for face in range(columns, 2 * columns):
        line = surface.evaluate(face, np.stack([u, np.full_like(u, 0.5)], axis=1)).position
        axis.plot(line[:, 0], line[:, 2], color=INK, linewidth=2, solid_capstyle="round", zorder=2)
    axis.set_title(title, fontsize=10, color=INK)
    axis.set_aspect("equal")
    axis.axis("off")


def draw_segments(
    axis: plt.Axes, start: np.ndarray, end: np.ndarray, color: str, style: str = "-"
) -> None:
    segments = np.stack([start[:, [0, 2]], end[:, [0, 2]]], axis=1)
    axis.add_collection(
        LineCollection(segments, colors=color, linewidths=0.8, linestyles=style, zorder=1)
    )


def draw_dots(axis: plt.Axes, points: np.ndarray, **style: object) -> None:
    axis.scatter(points[:, 0], points[:, 2], zorder=3, **style)


def draw_closest(axis: plt.Axes) -> None:
    profile = [[0, 0], [1, 1.4], [2, 1.2], [3, -0.6], [4, -0.2], [5, 1.5], [6, 0.8]]
    surface = extruded(np.array(profile, float))
    draw_section(axis, surface, "closest(points)")
    points = in_plane(np.random.default_rng(4).uniform([-0.6, -1], [6.6, 2], (90, 2)))
    hits = surface.closest(points)
    draw_segments(axis, points, hits.position, FAINT)
    draw_dots(axis, points, s=7, color=POINT, linewidths=0)
    draw_dots(axis, hits.position, s=7, color=OTHER, linewidths=0)


def draw_facing(axis: plt.Axes) -> None:
    """A thin fold; points that belong to its upper side have sunk through it."""
    x = np.linspace(0, 5.4, 7)
    bend = 0.5 * np.sin(0.9 * x)
    fold = np.stack([np.r_[x, 6.2, x[::-1]], np.r_[bend, -0.75, bend[::-1] - 0.4]], axis=1)
    surface = extruded(fold)
    draw_section(axis, surface, "closest(points), and with facing=[0, 0, 1] (blue)")
    place = np.linspace(0.5, 5.1, 12)
    points = in_plane(np.stack([place, 0.5 * np.sin(0.9 * place) - 0.29], axis=1))
    nearest = surface.closest(points)
    facing = surface.closest(points, facing=[0, 0, 1])
    draw_segments(axis, points, nearest.position, FAINT)
    draw_segments(axis, points, facing.position, POINT)
    draw_dots(axis, points, s=9, color=POINT, linewidths=0)
    draw_dots(axis, nearest.position, s=16, facecolors="white", edgecolors=OTHER, linewidths=0.8)
    draw_dots(axis, facing.position, s=9, color=OTHER, linewidths=0)


def draw_ray_hits(axis: plt.Axes) -> None:
    profile = [[0, 0], [1, 1.4], [2, 1.2], [3, -0.6], [4, -0.2], [5, 1.5], [6, 0.8]]
    surface = extruded(np.array(profile, float))
    draw_section(axis, surface, "ray_cast(...): filled; ray_cast_all(...): all")
    top = surface.bounds()[1, 2]
    origins = in_plane(np.array([[-1, top], [-1, 0.9], [-1, 0.1], [-0.3, 2], [6.7, -0.9]]))
    directions = np.array([[1, 0, 0], [1, 0, -0.08], [1, 0, 0.1], [0.75, 0, -1], [-1, 0, 0.42]])
    first = surface.ray_cast(origins, directions)
    every = surface.ray_cast_all(origins, directions)
    lengths = np.linalg.norm(directions, axis=1, keepdims=True)
    draw_segments(axis, origins, origins + 8.2 * directions / lengths, FAINT, "--")
    draw_segments(axis, origins, first.position, POINT)
    draw_dots(axis, origins, s=9, color=POINT, linewidths=0)
    draw_dots(axis, every.position, s=22, facecolors="white", edgecolors=OTHER, linewidths=0.9)
    draw_dots(axis, first.position, s=11, color=OTHER, linewidths=0)
    axis.set_xlim(-1.2, 7)
    axis.set_ylim(-1.2, 2.2)


def shell() -> ls.LimitSurface:
    """An open bowl over a grid with a hole and a pole of valence 7."""
    side = 4
    made = fan(7, side)
    faces = np.delete(made.faces, 69, axis=0)
    plan = made.plan() / side
    radius = np.hypot(*plan.T)
    angle = np.arctan2(plan[:, 1], plan[:, 0])
    height = 0.2 * radius**2 * np.cos(3 * angle) - 0.15 * radius**2 + 0.6 * np.exp(-3 * radius**2)
    return ls.LimitSurface(ls.ControlMesh.from_faces(np.column_stack([plan, height]), faces))


class Camera:
    """Parallel rays, one for each pixel. All lengths are in the units of the surface."""

    def __init__(self, middle: np.ndarray, width: float) -> None:
        self.towards = np.array([0.25, 0.9, -0.42])
        self.towards /= np.linalg.norm(self.towards)
        self.right = np.cross(self.towards, [0, 0, 1])
        self.right /= np.linalg.norm(self.right)
        self.up = np.cross(self.right, self.towards)
        self.middle, self.width = middle, width

    def rays(self) -> tuple[np.ndarray, np.ndarray]:
        step = self.width / SIZE[0]
        x = (np.arange(SIZE[0]) - SIZE[0] / 2 + 0.5) * step
        y = (SIZE[1] / 2 - 0.5 - np.arange(SIZE[1])) * step
        on_plane = x[None, :, None] * self.right + y[:, None, None] * self.up
        origins = (self.middle - 5 * self.towards + on_plane).reshape(-1, 3)
        return origins, np.broadcast_to(self.towards, origins.shape)

    def seen(self, points: np.ndarray) -> np.ndarray:
        """Where points are in the picture, in pixels."""
        step = self.width / SIZE[0]
        offset = points - self.middle
        return np.stack([offset @ self.right, -(offset @ self.up)], axis=-1) / step + SIZE / 2


def picture(surface: ls.LimitSurface, camera: Camera, line: float) -> np.ndarray:
    """`line`: how wide the borders of faces are drawn, in (u, v)."""
    hits = surface.ray_cast(*camera.rays())
    seen = hits.face >= 0
    normal, uv = hits.normal[seen], hits.uv[seen]
    normal *= -np.sign(normal @ camera.towards)[:, None]  # both sides look alike
    light = np.clip(normal @ np.array([-0.5, -0.45, 0.74]), 0, 1)
    color = (0.25 + 0.75 * light[:, None]) * np.array([0.55, 0.68, 0.86])
    color[np.minimum(uv, 1 - uv).min(axis=1) < line] *= 0.72
    image = np.ones((len(seen), 3))
    image[seen] = np.clip(color, 0, 1)
    return image.reshape(SIZE[1], SIZE[0], 3)


def make_rays(folder: Path) -> None:
    surface = shell()
    whole = Camera(np.array([0.0, 0, -0.1]), 4.2)
    polygons = surface.tessellate(PEER_LEVEL)
    place = whole.seen(polygons.positions)
    # The leftmost point of the outline.
    edge = polygons.positions[np.argmin(place[:, 0])]
    near = Camera(edge, whole.width / ZOOM)
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.2), layout="constrained")
    axes[0].imshow(picture(surface, whole, 0.02))
    x, y = whole.seen(edge)
    axes[0].plot(x, y, "s", markersize=9, markerfacecolor="none", color=OTHER)
    axes[0].set_title(f"{SIZE[0]} x {SIZE[1]} rays", fontsize=10, color=INK)
    axes[1].imshow(picture(surface, near, 0))
    quads = near.seen(polygons.positions)[polygons.faces]
    around = (np.abs(quads - SIZE / 2) < 6 * SIZE).all(axis=(1, 2))
    axes[1].add_collection(
        LineCollection(quads[around][:, [0, 1, 2, 3, 0]], colors=OTHER, linewidths=0.8)
    )
    axes[1].set_xlim(0, SIZE[0])
    axes[1].set_ylim(SIZE[1], 0)
    axes[1].set_title(
        f"its outline, {ZOOM} times larger; polygons of level {PEER_LEVEL}", fontsize=10, color=INK
    )
    for axis in axes:
        axis.axis("off")
    save(figure, folder / "query_rays.png")


def make_sections(folder: Path) -> None:
    figure, axes = plt.subplots(1, 3, figsize=(13.5, 2.5), layout="constrained")
    draw_closest(axes[0])
    draw_facing(axes[1])
    draw_ray_hits(axes[2])
    save(figure, folder / "query_section.png")
