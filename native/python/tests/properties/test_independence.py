# SPDX-License-Identifier: Apache-2.0
"""Results depend neither on the number of threads, nor on what else is in a batch, nor on the order
in which vertices, faces and corners are numbered.
"""

from dataclasses import replace

import numpy as np
from random_meshes import cages, holds_for, places, same_bits, seeds

PLACES = 60


def arrays_of(result):
    names = getattr(type(result), "__dataclass_fields__", None)
    if names is None:
        return {"": np.asarray(result)}
    return {name: getattr(result, name) for name in names if getattr(result, name) is not None}


def by_location(surface):
    """The calls that have a row for each location."""
    data = surface.vertex_data(np.sin(surface.positions[:, :2] * 3))
    return {
        "evaluate": lambda at, **k: surface.evaluate(*at, 2, **k),
        "frames": lambda at, **k: surface.frames(*at, **k),
        "placed_frames": lambda at, **k: surface.placed_frames(*at, **k),
        "curvature": lambda at, **k: surface.curvature(*at, irregular="average", **k),
        "data": lambda at, **k: data.evaluate(*at, 2, **k),
        "varying": lambda at, **k: surface.varying(surface.positions).evaluate(*at, 1, **k),
        "tangent_frames": lambda at, **k: surface.tangent_frames(data, *at, **k),
        "map_distortion": lambda at, **k: surface.map_distortion(data, *at, **k),
    }


@holds_for(cage=cages(), seed=seeds)
def test_a_row_does_not_depend_on_the_batch(cage, seed):
    surface = cage.surface()
    face, uv = places(surface, PLACES, seed)
    some = np.random.default_rng(seed).permutation(PLACES)[: PLACES // 3]
    for name, call in by_location(surface).items():
        whole, part = call((face, uv)), call((face[some], uv[some]))
        for field, rows in arrays_of(part).items():
            assert same_bits(arrays_of(whole)[field][some], rows), (name, field)


@holds_for(cage=cages(), seed=seeds)
def test_nothing_depends_on_the_number_of_threads(cage, seed):
    surface = cage.surface()
    at = places(surface, PLACES, seed)
    rng = np.random.default_rng(seed)
    points, directions = rng.normal(size=(2, PLACES, 3)) * cage.diagonal()
    data = surface.vertex_data(surface.positions[:, :2])
    calls = by_location(surface) | {
        "stencils": lambda _, **k: surface.stencils(*at, 1, **k),
        "closest": lambda _, **k: surface.closest(points, **k),
        "rays": lambda _, **k: surface.ray_cast_all(points, directions, **k),
        "uniform": lambda _, **k: surface.scatter_uniform(50, seed=1, **k),
        "blue noise": lambda _, **k: surface.scatter_blue_noise(count=30, seed=1, **k),
        "tessellate": lambda _, **k: surface.tessellate(3, **k),
        "area": lambda _, **k: surface.area(**k),
        "bounds": lambda _, **k: surface.bounds(**k),
        "locate": lambda _, **k: data.locate(points[:, :2], **k),
        "rasterize": lambda _, **k: data.rasterize(16, 16, margin=1.5, **k),
        "lengths": lambda _, **k: surface.edge_curves(**k).lengths,
    }
    for name, call in calls.items():
        assert same_bits(call(at, threads=1), call(at, threads=3)), name


def reordered(cage, rng):
    """The cage in another order, the faces' new numbers, and how far each was turned."""
    old = rng.permutation(len(cage.positions))  # of each new vertex
    new = np.argsort(old)
    order = rng.permutation(len(cage.faces))
    turns = [int(rng.integers(len(face))) for face in cage.faces]
    faces = [
        [int(new[v]) for v in face[turn:] + face[:turn]]
        for face, turn in zip(cage.faces, turns, strict=True)
    ]
    edges = [tuple(int(v) for v in rng.permutation(new[list(edge)])) for edge in cage.edges]
    shuffled = rng.permutation(len(edges))
    made = replace(
        cage,
        positions=cage.positions[old],
        faces=[faces[i] for i in order],
        edges=[edges[i] for i in shuffled],
        edge_sharpness=[cage.edge_sharpness[i] for i in shuffled],
        vertex_sharpness={int(new[v]): s for v, s in cage.vertex_sharpness.items()},
    )
    return made, np.argsort(order), turns


@holds_for(cage=cages(), seed=seeds)
def test_positions_do_not_depend_on_the_order(cage, seed):
    rng = np.random.default_rng(seed)
    other, number, turns = reordered(cage, rng)
    before, after = cage.surface(), other.surface()
    assert {int(number[face]) for face in before.refused} == set(after.refused)
    face, uv = places(before, PLACES, seed)
    uv = np.round(uv * 2.0**52) / 2.0**52  # so that 1 - u is exact: near a cone's tip it matters
    first = {int(base): i for i, base in reversed(list(enumerate(after.base_face)))}
    there, there_uv = np.empty_like(face), uv.copy()
    for row, ptex in enumerate(face):
        base = int(before.base_face[ptex])
        there[row], turn = first[int(number[base])], turns[base]
        if len(cage.faces[base]) == 4:
            for _ in range(turn):
                there_uv[row] = there_uv[row, 1], 1 - there_uv[row, 0]
        else:
            there[row] += (before.corner[ptex] - turn) % len(cage.faces[base])
    moved = after.evaluate(there, there_uv).position - before.evaluate(face, uv).position
    assert np.abs(moved).max() <= 1e-13 * cage.diagonal()
