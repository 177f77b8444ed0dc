# SPDX-License-Identifier: Apache-2.0
"""One SHA-256 for each mesh and subject: what the module `limitsurf` computes, to the last bit.

    python tools/checksums.py >before.txt           # with the module as it was
    python tools/checksums.py --check before.txt   # with the changed one, on the same machine

A change that must not alter any result, such as one of structure or of speed, gives the same list
before and after. `--check` names the rows that differ and then ends with 1. The meshes are those of
native/tests/data/golden, and some that have a UV map; names given on the command line choose among
them. The program uses the public API alone, so it runs on any version of the module that has it.

No list is committed: the last bits depend on the C library's `sin`, `cos` and `exp`, on the
compiler and on what its vector instructions contract, so a list holds for one machine only.
"""

import argparse
import dataclasses
import hashlib
import sys
from collections.abc import Callable, Iterator
from functools import cached_property
from pathlib import Path
from typing import Any

import limitsurf as ls
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "native/python/tests"))

import catmull_clark  # noqa: E402
import golden  # noqa: E402
import projectors  # noqa: E402
import shapes  # noqa: E402

INTERPOLATIONS = ("none", "corners_only", "corners_plus1", "corners_plus2", "boundaries", "all")
#: The largest number of a golden mesh's own locations that are used
OWN_LOCATIONS = 1000
RANDOM_LOCATIONS = 300
#: Powers of 1/2: the distances in u and v of locations from a corner of a face
NEAR_CORNERS = (0, 1, 3, 7, 20, 45)
QUERIES = 150
TEXEL = (1 / 96, 1 / 64)


class Subject:
    """A surface, its UV map, the locations at which it is asked, and the number of threads."""

    def __init__(
        self,
        surface: ls.LimitSurface,
        uv_map: ls.SurfaceData,
        own: tuple[np.ndarray, np.ndarray] | None,
        threads: int,
    ) -> None:
        self.surface, self.uv_map, self.mesh = surface, uv_map, surface.mesh
        self.threads = {"threads": threads}
        self.face, self.uv = _locations(surface, own)

    @cached_property
    def inner(self) -> tuple[np.ndarray, np.ndarray]:
        """The first of the locations that lie off the corners and sides of their faces."""
        rows = np.nonzero(((self.uv > 0.01) & (self.uv < 0.99)).all(axis=1))[0][:QUERIES]
        return self.face[rows], self.uv[rows]

    @cached_property
    def diagonal(self) -> float:
        return float(np.linalg.norm(np.ptp(self.surface.positions, axis=0)))

    @cached_property
    def points(self) -> np.ndarray:
        """Points on both sides of the surface, some far from it."""
        rng = np.random.default_rng(11)
        at = self.surface.evaluate(*self.inner).position
        return at + 0.2 * self.diagonal * rng.standard_normal(at.shape) ** 3

    @cached_property
    def directions(self) -> np.ndarray:
        rng = np.random.default_rng(12)
        targets = self.surface.evaluate(*self.inner).position
        return targets + 0.02 * self.diagonal * rng.standard_normal(targets.shape) - self.points

    @cached_property
    def camera(self) -> np.ndarray:
        middle = self.surface.positions.mean(axis=0)
        eye = middle + self.diagonal * np.array([0.8, -1.1, 1.3])
        near, far = 0.01 * self.diagonal, 10 * self.diagonal
        return projectors.perspective(near=near, far=far) @ projectors.looking(eye, middle)

    @cached_property
    def weights(self) -> np.ndarray:
        """A density for each vertex, 0 at some of them."""
        return np.maximum(np.random.default_rng(13).uniform(-0.3, 1, len(self.mesh.positions)), 0)


def _locations(
    surface: ls.LimitSurface, own: tuple[np.ndarray, np.ndarray] | None
) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(10)
    faces = np.setdiff1d(np.arange(surface.face_count), list(surface.refused))
    away = 0.5 ** np.array(NEAR_CORNERS)
    toward = np.concatenate([np.stack([away, away / 3], 1), np.stack([0 * away, away], 1)])
    chosen = rng.choice(faces, min(len(faces), 40), replace=False)
    near = np.concatenate([np.abs(corner - toward) for corner in np.ndindex(2, 2)])
    parts = [
        (rng.choice(faces, RANDOM_LOCATIONS), rng.random((RANDOM_LOCATIONS, 2))),
        (np.repeat(chosen, len(near)), np.tile(near, (len(chosen), 1))),
    ]
    if own is not None:
        keep = np.isin(own[0], faces)
        rows = rng.permutation(np.nonzero(keep)[0])[:OWN_LOCATIONS]
        parts.append((own[0][rows], own[1][rows]))
    face, uv = zip(*parts, strict=True)
    return np.concatenate(face).astype(np.int32), np.concatenate(uv)


def evaluation(s: Subject) -> Iterator[Any]:
    for order in (0, 1, 2):
        yield s.surface.evaluate(s.face, s.uv, order, **s.threads)
    yield s.surface.evaluate(s.face, s.uv, 1, dtype=np.float32, **s.threads)
    yield s.surface.vertex_locations()
    yield s.surface.bounds(**s.threads)
    yield s.surface.area(**s.threads)


def frames(s: Subject) -> Iterator[Any]:
    yield s.surface.frames(s.face, s.uv, **s.threads)


def curvature(s: Subject) -> Iterator[Any]:
    for irregular in ("none", "average"):
        yield s.surface.curvature(s.face, s.uv, irregular=irregular, **s.threads)


def stencils(s: Subject) -> Iterator[Any]:
    for order in (0, 1):
        yield s.surface.stencils(s.face[:500], s.uv[:500], order, **s.threads)


def closest(s: Subject) -> Iterator[Any]:
    yield s.surface.closest(s.points, **s.threads)
    yield s.surface.closest(s.points, 0.1 * s.diagonal, **s.threads)
    yield s.surface.closest(s.points, facing=(0.3, -0.2, 1.0), max_angle=1.0, **s.threads)


def rays(s: Subject) -> Iterator[Any]:
    yield s.surface.ray_cast(s.points, s.directions, **s.threads)
    yield s.surface.ray_cast_all(s.points, s.directions, **s.threads)


def uniform(s: Subject) -> Iterator[Any]:
    yield s.surface.scatter_jittered(2, 3, **s.threads)
    yield s.surface.scatter_uniform(200, 4, **s.threads)
    yield s.surface.scatter_uniform(200, 5, s.weights, **s.threads)
    yield s.surface.scatter_uniform(200, 6, lambda face, uv: uv[:, 0] + 0.1, **s.threads)
    limits = np.full(s.surface.face_count, 1.1)
    limits[:2] = 2
    yield s.surface.scatter_uniform(
        200, 6, lambda face, uv: uv[:, 0] + 0.1, density_limits=limits, **s.threads
    )


def blue_noise(s: Subject) -> Iterator[Any]:
    radius = 0.1 * float(np.sqrt(s.surface.area()))
    yield s.surface.scatter_blue_noise(count=50, seed=7, **s.threads)
    yield s.surface.scatter_blue_noise(radius=radius, seed=8, **s.threads)
    yield s.surface.scatter_blue_noise(radius=radius, seed=9, density=s.weights, **s.threads)


def tessellation(s: Subject) -> Iterator[Any]:
    rng = np.random.default_rng(14)
    yield s.surface.tessellate(1, **s.threads)
    levels = rng.integers(1, 4, len(s.mesh.face_sizes))
    yield s.surface.tessellate(levels, corner_normals=True, **s.threads)
    yield s.surface.levels_within(0.002 * s.diagonal, 5, **s.threads)
    yield s.surface.levels_of_length(0.05 * s.diagonal, most=5, **s.threads)
    yield s.surface.levels_of_length(0.05, s.camera, most=5, **s.threads)


def surface_data(s: Subject) -> Iterator[Any]:
    rng = np.random.default_rng(15)
    face, uv = s.face[:800], s.uv[:800]
    values = rng.standard_normal((len(s.mesh.positions), 4))
    yield s.surface.vertex_data(values, **s.threads).evaluate(face, uv, 2, **s.threads)
    yield s.surface.varying(values, **s.threads).evaluate(face, uv, 1, **s.threads)
    corners = s.mesh.face_vertices
    seams = corners + len(values) * (np.arange(len(corners)) % 3 == 0)
    twice = np.concatenate([values, values + 1])
    for interpolation in INTERPOLATIONS:
        for indices in (corners, seams):
            data = s.surface.face_varying(twice, indices, interpolation, **s.threads)
            yield from or_refused(lambda d=data: d.evaluate(face, uv, 2, **s.threads))


def uv_places(s: Subject) -> Iterator[Any]:
    rng = np.random.default_rng(16)
    yield s.uv_map.bounds(2, **s.threads)
    yield s.uv_map.rasterize(96, 64, margin=2.5, **s.threads)
    yield s.uv_map.rasterize(31, 47, (0, -1), **s.threads)
    yield s.uv_map.locate(rng.uniform(-0.1, 1.1, (500, 2)), **s.threads)
    folded = s.surface.vertex_data(s.mesh.positions[:, :2] / s.diagonal, **s.threads)
    yield folded.rasterize(64, 64, **s.threads)


def tangents(s: Subject) -> Iterator[Any]:
    face, uv = s.face[:800], s.uv[:800]
    yield s.surface.tangent_frames(s.uv_map, face, uv, **s.threads)
    yield s.surface.map_distortion(s.uv_map, face, uv, **s.threads)


def projection(s: Subject) -> Iterator[Any]:
    face, uv = s.face[:400], s.uv[:400]
    for options in (
        {},
        {"samples": 4, "two_sided": True, "soft_edge": 0.1, "depth": None},
        {"frame": False, "occlusion": False, "world": np.diag([1.0, 2.0, 0.5, 1.0])},
    ):
        yield s.surface.project(s.uv_map, face, uv, s.camera, TEXEL, **options, **s.threads)
    for box in ls.box_sides(np.diag([*[2 / s.diagonal] * 3, 1.0]))[:2]:
        yield s.surface.project(s.uv_map, face, uv, box, TEXEL, **s.threads)
    other = ls.LimitSurface(s.mesh)
    other.set_positions(s.mesh.positions * [1.1, 0.9, 1.0] + 0.05 * s.diagonal)
    other_map = other.vertex_data(s.mesh.positions[:, :2])
    yield s.surface.project_along_normals(s.uv_map, *s.inner, other, other_map, TEXEL, **s.threads)
    yield s.surface.eye_is_inside(s.camera, **s.threads)


def displacement(s: Subject) -> Iterator[Any]:
    target = ls.LimitSurface(s.mesh)
    target.set_positions(_sculpted(s.mesh.positions, 0.05 * s.diagonal))
    rotations = s.surface.frames(*s.inner)
    yield s.surface.vector_displacement(target, *s.inner, **s.threads)
    vectors = s.surface.vector_displacement(target, *s.inner, frames=rotations, **s.threads)
    yield vectors
    yield s.surface.displaced(*s.inner, vectors, frames=rotations, **s.threads)
    yield s.surface.scalar_displacement(target, *s.inner, 0.2 * s.diagonal, **s.threads)


def subdivided_displacement(s: Subject) -> Iterator[Any]:
    faces = np.split(s.mesh.face_vertices, np.cumsum(s.mesh.face_sizes)[:-1])
    positions, fine = catmull_clark.subdivided(s.mesh.positions, faces)
    sculpted = _sculpted(positions, 0.05 * s.diagonal)
    target = ls.LimitSurface(ls.ControlMesh.from_faces(sculpted, fine))
    pairs = ls.SubdividedFaces(s.mesh, target.mesh)
    yield pairs.levels
    yield pairs.locate(*s.inner, **s.threads)
    yield s.surface.vector_displacement(target, *s.inner, **s.threads)
    yield s.surface.scalar_displacement(target, *s.inner, 0.2 * s.diagonal, **s.threads)


def ptex_layout(s: Subject) -> Iterator[Any]:
    layout = ls.PtexLayout(s.surface.face_count, 4)
    texels = layout.texels()
    yield texels
    allowed = ~np.isin(texels.face, list(s.surface.refused))
    pixels = np.zeros((layout.height, layout.width, 3))
    at = s.surface.evaluate(texels.face[allowed], texels.uv[allowed], **s.threads).position
    pixels[texels.y[allowed], texels.x[allowed]] = at
    st = layout.map_coordinates(s.face, s.uv)
    yield st
    yield ls.bilinear(pixels, st, **s.threads)


def re_posed(s: Subject) -> Iterator[Any]:
    surface = ls.LimitSurface(s.mesh)
    surface.set_positions(_sculpted(s.mesh.positions, 0.1 * s.diagonal), **s.threads)
    yield surface.evaluate(s.face, s.uv, 2, **s.threads)
    yield surface.closest(s.points, **s.threads)


def images(threads: int) -> Iterator[Any]:
    """Yields the rows that need no surface."""
    rng = np.random.default_rng(17)
    pixels = rng.random((37, 53, 4), np.float32)
    st = rng.uniform(-0.5, 1.5, (600, 2))
    footprint = rng.standard_normal((600, 2, 2)) * 0.5 ** rng.uniform(0, 10, (600, 1, 1))
    for extension in ("clip", "extend", "repeat", "mirror"):
        for premultiplied in (False, True):
            image = ls.FilteredImage(
                pixels, extension, premultiplied=premultiplied, threads=threads
            )
            yield image.sample(st, footprint, threads=threads)
    grey = ls.FilteredImage(pixels[:, :, :1])
    yield grey.sample(st, footprint, threads=threads)
    yield grey.bounds(np.stack([st, st + 0.1], axis=1), threads=threads)
    yield ls.bilinear(pixels, st, threads=threads)
    below, above = rng.random((2, 500, 4), np.float32)
    weight = rng.random(500, np.float32)
    for mode in ("mix", "add", "multiply"):
        for premultiplied in (False, True):
            yield ls.blend_over(below, above, weight, mode, premultiplied=premultiplied)
    vectors, normals, tangents = rng.standard_normal((3, 300, 3))
    matrix = np.eye(4)
    matrix[:3] += 0.1 * rng.standard_normal((3, 4))
    yield ls.box_sides(matrix)
    yield ls.box_weights(normals, 0.4, matrix)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    tangents -= normals * np.sum(normals * tangents, axis=1, keepdims=True)
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    signs = np.where(rng.random(300) < 0.5, -1.0, 1.0)
    yield ls.into_shading_frames(vectors, normals, tangents, signs)
    yield ls.out_of_shading_frames(vectors, normals, tangents, signs)


SUBJECTS: tuple[Callable[[Subject], Iterator[Any]], ...] = (
    evaluation,
    frames,
    curvature,
    stencils,
    closest,
    rays,
    uniform,
    blue_noise,
    tessellation,
    surface_data,
    uv_places,
    tangents,
    projection,
    displacement,
    ptex_layout,
    re_posed,
)


def _sculpted(positions: np.ndarray, amount: float) -> np.ndarray:
    x, y, z = positions.T
    return positions + amount * np.stack([np.sin(3 * y), np.cos(2 * x + z), np.sin(2 * x)], axis=1)


def or_refused(call: Callable[[], Any]) -> Iterator[Any]:
    try:
        yield call()
    except ls.MeshError:
        yield "refused"


def _golden_subject(name: str, threads: int) -> Subject:
    truth = golden.read_golden(golden.path_of(name))
    surface, uv_map = projectors.mapped(
        truth.positions,
        truth.faces,
        edge_sharpness=(truth.sharp_edges, truth.edge_values),
        vertex_sharpness=(truth.sharp_vertices, truth.vertex_values),
        boundary=truth.boundary,
        creasing=truth.creasing,
        triangles=truth.triangles,
    )
    return Subject(surface, uv_map, (truth.face, truth.uv), threads)


#: Each entry makes a surface and its UV map
MAPPED: dict[str, Callable[[], tuple[ls.LimitSurface, ls.SurfaceData]]] = {
    **{
        f"mapped_sheet_{rule}": lambda rule=rule: projectors.sheet(interpolation=rule)
        for rule in INTERPOLATIONS
    },
    "mapped_plane": projectors.plane,
    **{
        f"mapped_{name}".replace(" ", "_"): lambda name=name: projectors.mapped(*shapes.ALL[name])
        for name in shapes.ALL
    },
}


def digest(results: Iterator[Any]) -> str:
    found = hashlib.sha256()
    for result in results:
        _add(found, result)
    return found.hexdigest()


def _add(found: "hashlib._Hash", result: Any) -> None:
    """Adds type, shape and bits; all NaN count as the same."""
    if dataclasses.is_dataclass(result):
        for field in dataclasses.fields(result):
            found.update(field.name.encode())
            _add(found, getattr(result, field.name))
    elif isinstance(result, np.ndarray):
        if result.dtype.kind == "f":
            result = np.where(np.isnan(result), result.dtype.type("nan"), result)
        found.update(f"{result.dtype.str}{result.shape}".encode())
        found.update(np.ascontiguousarray(result).tobytes())
    else:
        found.update(f"{type(result).__name__} {result!r}".encode())


def rows(names: list[str], threads: int) -> Iterator[tuple[str, str]]:
    """Yields the names of mesh and subject, and the checksum."""

    def wanted(name: str) -> bool:
        return not names or name in names

    if wanted("images"):
        yield "images", digest(images(threads))
    for name in (*golden.names(), *MAPPED):
        if not wanted(name):
            continue
        if name in MAPPED:
            subject = Subject(*MAPPED[name](), None, threads)
        else:
            subject = _golden_subject(name, threads)
        for compute in SUBJECTS:
            yield f"{name} {compute.__name__}", digest(compute(subject))
        if name in MAPPED:
            yield f"{name} subdivided_displacement", digest(subdivided_displacement(subject))


def differences(expected: dict[str, str], found: dict[str, str]) -> list[str]:
    """Returns a line for each row that is not in both lists with the same checksum."""
    said = []
    for row in dict.fromkeys([*expected, *found]):
        if row not in found:
            said.append(f"missing: {row}")
        elif row not in expected:
            said.append(f"new: {row}")
        elif expected[row] != found[row]:
            said.append(f"differs: {row}")
    return said


def read_list(path: Path) -> dict[str, str]:
    """Returns the checksum of each row, the first word of its line."""
    lines = (line.split(" ", 1) for line in path.read_text().splitlines())
    return {row: checksum for checksum, row in lines}


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("meshes", nargs="*", help="names of meshes (default: all)")
    parser.add_argument("--check", type=Path, metavar="FILE", help="compare with this list")
    parser.add_argument(
        "--threads", type=int, default=1, help="number of threads, 0 for one per core (default: 1)"
    )
    arguments = parser.parse_args()
    unknown = set(arguments.meshes) - {"images", *golden.names(), *MAPPED}
    if unknown:
        parser.error(f"there are no meshes of these names: {', '.join(sorted(unknown))}")

    found = {}
    for row, checksum in rows(arguments.meshes, arguments.threads):
        found[row] = checksum
        if arguments.check is None:
            print(checksum, row, flush=True)
    if arguments.check is None:
        return 0
    expected = read_list(arguments.check)
    if arguments.meshes:
        expected = {
            row: checksum
            for row, checksum in expected.items()
            if row.split(" ")[0] in arguments.meshes
        }
    said = differences(expected, found)
    print(*said, sep="\n", end="\n" if said else "")
    print(f"{len(found)} rows, {len(said)} differences")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
