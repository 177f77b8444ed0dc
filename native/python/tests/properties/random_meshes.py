# SPDX-License-Identifier: Apache-2.0
"""Control meshes of all kinds for the tests of properties, and places on their surfaces."""

from dataclasses import dataclass, field, replace

import hypothesis
import limitsurf as ls
import numpy as np
import pytest
import shapes
from hypothesis import strategies as st

FEW, MANY = 12, 400


def holds_for(**strategies):
    """Makes a test of a property: a few examples by default, many in a slow test. The examples are
    the same in every run; what a longer search finds becomes an explicit test.
    """

    def decorate(check):
        @pytest.mark.parametrize(
            "examples", [FEW, pytest.param(MANY, marks=pytest.mark.slow)], ids=["few", "many"]
        )
        def test(examples):
            given = hypothesis.settings(
                max_examples=examples,
                deadline=None,
                database=None,
                derandomize=True,
                suppress_health_check=list(hypothesis.HealthCheck),
            )(hypothesis.given(**strategies)(check))
            given()

        test.__name__, test.__doc__ = check.__name__, check.__doc__
        test.__module__ = check.__module__
        return test

    return decorate


def whole(low, high):
    """Whole numbers from low to high, made of bits. For numbers Hypothesis also tries the constants
    that it finds in the modules that happen to be loaded, so that the examples of st.integers and
    st.sampled_from would depend on which tests run beside this one.
    """
    count = (high - low).bit_length() + 8
    bits = st.lists(st.booleans(), min_size=count, max_size=count)
    return bits.map(lambda each: low + sum(b << i for i, b in enumerate(each)) % (high - low + 1))


def one_of(options):
    return whole(0, len(options) - 1).map(lambda i: options[i])


@dataclass(frozen=True)
class Cage:
    """A control mesh as lists, so that it can be put into another order."""

    positions: np.ndarray
    faces: list[list[int]]
    edges: list[tuple[int, int]] = field(default_factory=list)
    edge_sharpness: list[float] = field(default_factory=list)
    vertex_sharpness: dict[int, float] = field(default_factory=dict)
    rules: dict[str, str] = field(default_factory=dict)

    def mesh(self):
        return ls.ControlMesh.from_faces(
            self.positions,
            self.faces,
            edge_sharpness=(self.edges, self.edge_sharpness) if self.edges else None,
            vertex_sharpness=(list(self.vertex_sharpness), list(self.vertex_sharpness.values())),
            **self.rules,
        )

    def surface(self):
        return ls.LimitSurface(self.mesh())

    def diagonal(self):
        return float(np.linalg.norm(np.ptp(self.positions, axis=0)))

    def moved(self, matrix, offset):
        return replace(self, positions=self.positions @ np.transpose(matrix) + offset)


def all_edges(faces):
    pairs = ((face[i - 1], face[i]) for face in faces for i in range(len(face)))
    return sorted({(min(pair), max(pair)) for pair in pairs})


def without_unused_vertices(positions, faces):
    used = sorted({vertex for face in faces for vertex in face})
    number = {vertex: i for i, vertex in enumerate(used)}
    return positions[used], [[number[vertex] for vertex in face] for face in faces]


@st.composite
def topologies(draw):
    """Grids, fans, cubes and houses."""
    kind = draw(one_of(["grid", "fan", "cube", "house", "pole"]))
    if kind == "grid":
        return shapes.grid(draw(whole(1, 4)), draw(whole(1, 3)))
    if kind == "fan":
        closed = draw(st.booleans())
        return shapes.fan(draw(whole(3 if closed else 1, 7)), closed)
    if kind == "pole":
        return shapes.pole(draw(whole(3, 9)))
    return shapes.cube() if kind == "cube" else shapes.house()


def merged(one, other):
    """The face that two faces with one common edge make; None if they have another contact."""
    common = set(one) & set(other)
    if len(common) != 2:
        return None
    for i in range(len(one)):
        a, b = one[i], one[(i + 1) % len(one)]
        if {a, b} == common:
            j = other.index(b)
            if other[(j + 1) % len(other)] != a:
                return None
            begin = one[(i + 1) % len(one) :] + one[: (i + 1) % len(one)]  # from b to a
            rest = [other[(j + 2 + k) % len(other)] for k in range(len(other) - 2)]
            return begin + rest
    return None


@st.composite
def cages(draw, sharp=True):
    """Quads, triangles and larger faces, boundaries, creases that end, sharp vertices."""
    positions, faces = draw(topologies())
    faces = [[int(vertex) for vertex in face] for face in faces]
    for _ in range(draw(whole(0, 3))):
        edit, index = draw(one_of(["remove", "cut", "merge"])), draw(whole(0, 30))
        face = faces[index % len(faces)]
        if edit == "remove" and len(faces) > 1:
            faces.remove(face)
        elif edit == "cut" and len(face) == 4:
            faces.remove(face)
            faces += [[face[0], face[1], face[2]], [face[0], face[2], face[3]]]
        elif edit == "merge":
            for other in faces:
                union = merged(face, other) if other is not face else None
                if union:
                    faces.remove(face)
                    faces.remove(other)
                    faces.append(union)
                    break
    positions, faces = without_unused_vertices(np.asarray(positions), faces)
    rng = np.random.default_rng(draw(whole(0, 2**32 - 1)))
    positions = positions + rng.normal(0, draw(one_of([0.05, 0.2])), positions.shape)
    rules = {
        "boundary": draw(one_of(["smooth", "corners"])),
        "creasing": draw(one_of(["uniform", "chaikin"])),
        "triangles": draw(one_of(["catmark", "smooth"])),
    }
    cage = Cage(positions, faces, rules=rules)
    if not sharp or not draw(st.booleans()):
        return cage
    edges = all_edges(faces)
    chosen = [edge for edge in edges if rng.random() < 0.3]
    values = rng.uniform(0, 4.5, len(chosen))
    values[rng.random(len(chosen)) < 0.3] = np.inf
    values[rng.random(len(chosen)) < 0.3] = 2
    tips = {
        int(v): float(rng.choice([0.5, 2.5, np.inf])) for v in rng.integers(0, len(positions), 2)
    }
    return replace(
        cage, edges=chosen, edge_sharpness=[float(value) for value in values], vertex_sharpness=tips
    )


def kept_faces(surface):
    """The Ptex faces that have a surface."""
    return np.flatnonzero(~np.isin(surface.base_face, list(surface.refused)))


def places(surface, count, seed, inside=False):
    """Random locations: some are near or at vertices and edges unless they are to be inside."""
    rng = np.random.default_rng(seed)
    faces = kept_faces(surface)
    hypothesis.assume(len(faces) > 0)
    uv = rng.random((count, 2))
    if inside:
        return rng.choice(faces, count), 0.05 + 0.9 * uv
    uv[::5] *= 2.0 ** -rng.integers(0, 40, (len(uv[::5]), 1))
    uv[::7, 0] = np.round(uv[::7, 0])
    uv[::11] = np.round(uv[::11])
    uv[1::3] = 1 - uv[1::3]
    return rng.choice(faces, count), uv


def same_bits(one, other):
    """Whether results of the same call agree in all their arrays."""
    names = getattr(type(one), "__dataclass_fields__", None)
    if names is None:
        return np.asarray(one).tobytes() == np.asarray(other).tobytes()
    return all(
        same_bits(getattr(one, name), getattr(other, name))
        for name in names
        if getattr(one, name) is not None
    )


seeds = whole(0, 2**32 - 1)
