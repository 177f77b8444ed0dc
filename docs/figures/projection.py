# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/project_image.md that Python makes: a projected checker, and filters."""

from pathlib import Path

import limitsurf as ls
import matplotlib.image
import numpy as np

from figures.meshes.grids import grid_faces

PANEL, GAP, TEXTURE = 300, 8, 384
CLAY, PAPER = np.array([0.80, 0.78, 0.74]), np.full(3, 0.94)
DARK, LIGHT = np.array([0.11, 0.31, 0.56]), np.array([0.97, 0.93, 0.84])
LAMP = np.array([-0.35, -0.45, 0.82])
PARTS = 6  # samples along each side of a pixel for the reference


def view_from(eye, at) -> np.ndarray:
    """The matrix from the world, with z up, to a camera that looks along its own -z."""
    eye, back = np.asarray(eye, float), np.asarray(eye, float) - at
    back /= np.linalg.norm(back)
    right = np.cross([0, 0, 1], back)
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[:3, :3] = [right, np.cross(back, right), back]
    view[:3, 3] = -view[:3, :3] @ eye
    return view


def lens(half_width: float, near: float = 0.1, far: float = 50.0) -> np.ndarray:
    depth = [-(far + near) / (far - near), -2 * far * near / (far - near)]
    return np.array(
        [[1 / half_width, 0, 0, 0], [0, 1 / half_width, 0, 0], [0, 0, *depth], [0, 0, -1, 0]]
    )


def hill() -> tuple[ls.LimitSurface, ls.SurfaceData]:
    """A sheet over a square, open on all sides, with a hump, and (x, y) for its UV map."""
    side = np.linspace(0, 1, 13)
    x, y = np.meshgrid(side, side)
    hump = 0.34 * np.exp(-40 * ((x - 0.6) ** 2 + (y - 0.55) ** 2))
    z = hump + 0.05 * np.sin(6 * x) * np.cos(5 * y)
    positions = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    faces = grid_faces(12, 12)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces, boundary="corners"))
    return surface, surface.face_varying(positions[:, :2], faces.ravel(), "corners_only")


def checker(squares: int, pixels: int) -> np.ndarray:
    y, x = np.mgrid[0:pixels, 0:pixels] * squares // pixels
    return np.where(((x + y) % 2 == 0)[..., None], DARK, LIGHT).astype(np.float32)


def painted(surface, uv_map, camera: np.ndarray, image: ls.FilteredImage) -> np.ndarray:
    """A texture of clay with the image on it where the camera sees the surface."""
    texture = np.concatenate([np.tile(CLAY, (TEXTURE**2, 1)), np.ones((TEXTURE**2, 1))], axis=1)
    at = uv_map.rasterize(TEXTURE, TEXTURE)
    seen = surface.project(
        uv_map, at.face, at.uv, camera, (1 / TEXTURE, 1 / TEXTURE), samples=4, soft_edge=0.02
    )
    colors = image.sample(seen.st, seen.footprint)
    above = np.concatenate([colors, np.ones((len(colors), 1))], axis=1)
    rows = at.y * TEXTURE + at.x
    texture[rows] = ls.blend_over(texture[rows], above, seen.weight)
    return texture.reshape(TEXTURE, TEXTURE, 4)


def rays(camera: np.ndarray, side: int) -> tuple[np.ndarray, np.ndarray]:
    """Rays through the centres of a square picture's pixels, from the top row down."""
    middles = (np.arange(side) + 0.5) / side * 2 - 1
    x, y = np.meshgrid(middles, -middles)
    ends = np.stack([x.ravel(), y.ravel()])
    back = np.linalg.inv(camera)
    near, far = (
        np.vstack([ends, np.full((1, ends.shape[1]), z), np.ones((1, ends.shape[1]))])
        for z in (-1, 1)
    )
    near, far = ((back @ p)[:3] / (back @ p)[3] for p in (near, far))
    return near.T, (far - near).T


def rendered(surface, uv_map, camera: np.ndarray, texture: np.ndarray) -> np.ndarray:
    hits = surface.ray_cast(*rays(camera, PANEL))
    found = hits.face >= 0
    places = uv_map.evaluate(hits.face[found], hits.uv[found]).value
    colors = ls.FilteredImage(texture, "extend").sample(places, np.zeros((len(places), 2, 2)))
    light = np.abs(hits.normal[found] @ LAMP) / np.linalg.norm(LAMP)
    picture = np.tile(PAPER, (PANEL**2, 1))
    picture[found] = colors[:, :3] * (0.35 + 0.65 * light[:, None])
    return picture.reshape(PANEL, PANEL, 3)


def ground(part: int) -> tuple[np.ndarray, np.ndarray]:
    """Where the rays of a picture's pixels, or of their parts, meet a plane; their footprints."""
    camera = lens(0.7) @ view_from((0.5, -0.3, 0.13), (0.5, 0.0, 0.0))
    start, along = rays(camera, PANEL * part)
    places = (start - along * (start[:, 2:] / along[:, 2:]))[:, :2].reshape(PANEL * part, -1, 2)
    steps = np.stack(np.gradient(places, axis=(1, 0)), axis=-1)
    below = (along[:, 2] < -1e-3).reshape(PANEL * part, -1)
    return np.where(below[..., None], places, np.nan), np.where(below[..., None, None], steps, 0)


def looked_up(image: ls.FilteredImage, places: np.ndarray, steps: np.ndarray) -> np.ndarray:
    shape = places.shape[:2]
    colors = image.sample(places.reshape(-1, 2), steps.reshape(-1, 2, 2)).reshape(*shape, 3)
    return np.where(np.isnan(places[..., :1]), PAPER, colors)


def top_row() -> list[np.ndarray]:
    surface, uv_map = hill()
    camera = lens(0.33) @ view_from((-0.6, -0.6, 1.1), (0.48, 0.46, 0.06))
    texture = painted(surface, uv_map, camera, ls.FilteredImage(checker(8, 512), "extend"))
    aside = lens(0.37) @ view_from((1.35, -0.75, 1.05), (0.5, 0.5, 0.06))
    steps = (np.arange(PANEL) + 0.5) / PANEL
    s, t = np.meshgrid(steps, steps[::-1])
    flat = ls.FilteredImage(texture, "extend").sample(
        np.stack([s, t], axis=-1).reshape(-1, 2),
        np.broadcast_to(np.eye(2) / PANEL, (PANEL**2, 2, 2)),
    )
    return [
        rendered(surface, uv_map, camera, texture),
        rendered(surface, uv_map, aside, texture),
        flat[:, :3].reshape(PANEL, PANEL, 3),
    ]


def bottom_row() -> list[np.ndarray]:
    image = ls.FilteredImage(checker(16, 256), "repeat")
    places, steps = ground(1)
    fine, fine_steps = ground(PARTS)
    many = looked_up(image, fine, 0 * fine_steps)
    truth = many.reshape(PANEL, PARTS, PANEL, PARTS, 3).mean(axis=(1, 3))
    return [looked_up(image, places, 0 * steps), looked_up(image, places, steps), truth]


def side_by_side(panels: list[np.ndarray]) -> np.ndarray:
    gap = np.ones((PANEL, GAP, 3))
    return np.clip(np.concatenate([panels[0], gap, panels[1], gap, panels[2]], axis=1), 0, 1)


def picture() -> np.ndarray:
    """The picture's colors from 0 to 1, from the top row down."""
    top, bottom = side_by_side(top_row()), side_by_side(bottom_row())
    return np.concatenate([top, np.ones((GAP, top.shape[1], 3)), bottom])


def make(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    matplotlib.image.imsave(folder / "projection.png", picture())
