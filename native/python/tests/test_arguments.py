# SPDX-License-Identifier: Apache-2.0
"""What every function that takes arrays does with those that it cannot use: the error names the
argument, and quotes the value and its place as the caller wrote them. An empty list is an empty
array.
"""

import ast
import re
from typing import Any

import catmull_clark
import limitsurf as ls
import numpy as np
import pytest
import shapes
from test_signatures import FUNCTIONS

#: Characters that a message may have, whatever it quotes
LONGEST = 500

SQUARES, FACES = shapes.grid(3, 3)
SQUARES = SQUARES * 1.0
SURFACE = ls.LimitSurface(ls.ControlMesh.from_faces(SQUARES, FACES))
TWICE = ls.LimitSurface(
    ls.ControlMesh.from_faces(*catmull_clark.subdivided(SQUARES, FACES.tolist(), 1))
)
POSED = ls.LimitSurface(SURFACE.mesh)  # anew by each test of set_positions()
UV_MAP = SURFACE.vertex_data(SQUARES[:, :2] / 3)
CURVES = SURFACE.edge_curves()
FACE, UV = [0, 1, 4], [[0.5, 0.5], [0.25, 0.5], [0.75, 0.5]]
POINTS = [[0.5, 0.5, 1.0], [1.0, 2.0, 1.0], [2.0, 2.0, 1.0]]
UP = [[0.0, 0.0, 1.0]] * 3
TURNS = [np.eye(3).tolist()] * 3
PIXELS = np.ones((4, 4, 4)).tolist()
COLOURS = [[0.5, 0.5, 0.5, 1.0]] * 3
MATRIX = np.eye(4).tolist()
POSE = {"matrix": MATRIX, "positions": SQUARES.tolist()}
VIEW = np.diag([0.3, 0.3, -0.1, 1.0]).tolist()
SAMPLES = SURFACE.fixed_samples(FACE, UV)
POSER = SURFACE.strand_poser(FACE, UV, [[0.0, 0, 0]] * 3, TURNS)
IMAGE = ls.FilteredImage(np.ones((4, 4, 4)))
GREY = ls.FilteredImage(np.ones((4, 4, 1)))
ON = {"face": FACE, "uv": UV}
SHADING = {"vectors": UP, "normals": UP, "tangents": [[1.0, 0, 0]] * 3, "signs": [1.0] * 3}


def scatter_twice(scatter, density, density_limits, **common):
    """Weights of vertices have no limits, and so there are two calls."""
    by_weights = scatter(count=3, density=density, **common)
    even = scatter(
        count=3,
        density=lambda face, _uv: np.ones(len(face)),
        density_limits=density_limits,
        **common,
    )
    return by_weights, even


#: For each function: itself, and arguments that are right. Each array is a nested list.
CASES = {
    "ControlMesh.__init__": (
        ls.ControlMesh,
        {
            "positions": SQUARES.tolist(),
            "face_sizes": [4] * 9,
            "face_vertices": FACES.ravel().tolist(),
            "edge_sharpness": ([FACES[0, :2].tolist()], [1.0]),
            "vertex_sharpness": ([0], [1.0]),
            "holes": [8],
        },
    ),
    "ControlMesh.from_faces": (
        ls.ControlMesh.from_faces,
        {
            "positions": SQUARES.tolist(),
            "faces": FACES.tolist(),
            "edge_sharpness": ([FACES[0, :2].tolist()], [1.0]),
            "vertex_sharpness": ([0], [1.0]),
            "holes": [8],
        },
    ),
    "SurfaceData.set_values": (UV_MAP.set_values, {"values": (SQUARES[:, :2] / 3).tolist()}),
    "SurfaceData.evaluate": (UV_MAP.evaluate, ON),
    "SurfaceData.locate": (UV_MAP.locate, {"points": UV}),
    "FilteredImage.__init__": (ls.FilteredImage, {"pixels": PIXELS}),
    "FilteredImage.sample": (
        IMAGE.sample,
        {"st": UV, "footprint": [[[0.1, 0.0], [0.0, 0.1]]] * 3},
    ),
    "FilteredImage.bounds": (GREY.bounds, {"boxes": [[[0.1, 0.2], [0.3, 0.4]]] * 3}),
    "blend_over": (ls.blend_over, {"below": COLOURS, "above": COLOURS, "weight": [1.0] * 3}),
    "box_sides": (ls.box_sides, {"matrix": MATRIX}),
    "box_weights": (ls.box_weights, {"normals": UP, "matrix": MATRIX}),
    "SubdividedFaces.locate": (ls.SubdividedFaces(SURFACE.mesh, TWICE.mesh).locate, ON),
    "EdgeCurves.at": (CURVES.at, {"curve": [0, 0, 0], "arc": [0.1, 0.2, 0.3]}),
    "FixedSamples.evaluate": (
        SAMPLES.evaluate,
        {"positions": SQUARES.tolist()},
    ),
    "StrandPoser.pose": (POSER.pose, {"rest_points": POINTS, **POSE}),
    "StrandPoser.repose": (
        lambda **given: POSER.repose(points=np.zeros((3, 3), np.float32), **given),
        {"rest_points": POINTS, **POSE},
    ),
    "StrandPoser.unpose": (
        lambda **given: POSER.unpose(out=np.zeros((3, 3), np.float32), **given),
        {"points": POINTS, **POSE, "only": [True, False, True]},
    ),
    "StrandPoser.pose_vectors": (
        POSER.pose_vectors,
        {"rest_vectors": POINTS, **POSE},
    ),
    "StrandPoser.pose_rotations": (
        POSER.pose_rotations,
        {"rest_rotations": [[1.0, 0, 0, 0]] * 3, **POSE},
    ),
    "StrandPoser.fingerprints": (POSER.fingerprints, {"points": POINTS}),
    "PtexLayout.map_coordinates": (ls.PtexLayout(9, 4).map_coordinates, ON),
    "resample_strands": (
        lambda **given: ls.resample_strands(count=2, **given),
        {"points": POINTS, "offsets": [0, 3]},
    ),
    "child_strands": (
        ls.child_strands,
        {
            "guide_points": [POINTS],
            "guide_normals": UP[:1],
            "guide": [[0], [0]],
            "weight": [[1.0], [1.0]],
            "roots": POINTS[:2],
            "normals": UP[:2],
        },
    ),
    "bilinear": (ls.bilinear, {"pixels": PIXELS, "st": UV}),
    "LimitSurface.set_positions": (POSED.set_positions, {"positions": SQUARES.tolist()}),
    "LimitSurface.evaluate": (SURFACE.evaluate, ON),
    "LimitSurface.frames": (SURFACE.frames, ON),
    "LimitSurface.placed_frames": (SURFACE.placed_frames, ON),
    "LimitSurface.tangent_frames": (
        lambda **given: SURFACE.tangent_frames(UV_MAP, **given),
        ON,
    ),
    "LimitSurface.map_distortion": (
        lambda **given: SURFACE.map_distortion(UV_MAP, **given),
        ON,
    ),
    "LimitSurface.curvature": (SURFACE.curvature, ON),
    "LimitSurface.stencils": (SURFACE.stencils, ON),
    "LimitSurface.tiles": (SURFACE.tiles, ON),
    "LimitSurface.fixed_samples": (SURFACE.fixed_samples, ON),
    "LimitSurface.edge_curves": (SURFACE.edge_curves, {"edges": FACES[:2, :2].tolist()}),
    "LimitSurface.strand_poser": (
        SURFACE.strand_poser,
        {**ON, "rest_roots": POINTS, "rest_rotations": TURNS, "offsets": [0, 1, 2, 3]},
    ),
    "LimitSurface.face_varying": (
        lambda **given: SURFACE.face_varying(interpolation="all", **given),
        {"values": SQUARES.tolist(), "indices": FACES.ravel().tolist()},
    ),
    "LimitSurface.vertex_data": (SURFACE.vertex_data, {"values": SQUARES.tolist()}),
    "LimitSurface.varying": (SURFACE.varying, {"values": SQUARES.tolist()}),
    "LimitSurface.closest": (SURFACE.closest, {"points": POINTS, "facing": UP}),
    "LimitSurface.ray_cast": (SURFACE.ray_cast, {"origins": POINTS, "directions": UP}),
    "LimitSurface.ray_cast_all": (SURFACE.ray_cast_all, {"origins": POINTS, "directions": UP}),
    "LimitSurface.curve_directions": (
        SURFACE.curve_directions,
        {"points": POINTS, "offsets": [0, 3], **ON},
    ),
    "LimitSurface.lay_path": (
        lambda **given: SURFACE.lay_path(tolerance=0.1, **given),
        {
            "points": POINTS,
            "handle_left": POINTS,
            "handle_right": POINTS,
            "offsets": [0, 3],
            "closed": [False],
        },
    ),
    "LimitSurface.fit_path": (
        lambda **given: SURFACE.fit_path(tolerance=0.1, value_tolerance=1.0, **given),
        {**ON, "values": [1.0, 2.0, 3.0]},
    ),
    "LimitSurface.smooth_path": (SURFACE.smooth_path, {**ON, "weights": [1.0] * 3}),
    "LimitSurface.even_path": (lambda **given: SURFACE.even_path(count=3, **given), ON),
    "LimitSurface.project": (
        lambda **given: SURFACE.project(UV_MAP, texel=(0.1, 0.1), **given),
        {**ON, "matrix": VIEW, "world": MATRIX},
    ),
    "LimitSurface.project_along_normals": (
        lambda **given: SURFACE.project_along_normals(
            UV_MAP, source=SURFACE, source_map=UV_MAP, texel=(0.1, 0.1), **given
        ),
        {**ON, "transform": MATRIX, "world": MATRIX},
    ),
    "LimitSurface.eye_is_inside": (SURFACE.eye_is_inside, {"matrix": VIEW}),
    "LimitSurface.vector_displacement": (
        lambda **given: SURFACE.vector_displacement(SURFACE, **given),
        {**ON, "frames": TURNS},
    ),
    "LimitSurface.scalar_displacement": (
        lambda **given: SURFACE.scalar_displacement(SURFACE, **given),
        ON,
    ),
    "LimitSurface.displaced": (SURFACE.displaced, {**ON, "values": POINTS, "frames": TURNS}),
    "LimitSurface.scatter_jittered": (
        lambda **given: SURFACE.scatter_jittered(2, **given),
        {"faces": FACE},
    ),
    "LimitSurface.scatter_uniform": (
        lambda **given: scatter_twice(SURFACE.scatter_uniform, **given),
        {"density": [1.0] * 16, "density_limits": [2.0] * 9},
    ),
    "LimitSurface.scatter_blue_noise": (
        lambda **given: scatter_twice(SURFACE.scatter_blue_noise, **given),
        {"density": [1.0] * 16, "density_limits": [2.0] * 9},
    ),
    "LimitSurface.guide_weights": (
        SURFACE.guide_weights,
        {
            "guide_face": FACE,
            "guide_uv": UV,
            **ON,
            "cuts": FACES[:1, :2].tolist(),
            "cut_points": POINTS,
            "cut_offsets": [0, 3],
        },
    ),
    "LimitSurface.tessellate": (SURFACE.tessellate, {"levels": [1] * 9}),
    "LimitSurface.levels_of_length": (
        lambda **given: SURFACE.levels_of_length(length=0.5, **given),
        {"matrix": VIEW},
    ),
    "shortest_turns": (ls.shortest_turns, {"source": UP, "target": UP}),
    "quaternions": (ls.quaternions, {"rotations": TURNS}),
    "frames_in_world": (ls.frames_in_world, {"frames": TURNS, "matrix": np.eye(3).tolist()}),
    "leaning": (ls.leaning, {"frames": TURNS, "angles": UV}),
    "straight_strands": (
        lambda **given: ls.straight_strands(points=2, **given),
        {"roots": POINTS, "along": UP},
    ),
    "rotation_matrices": (ls.rotation_matrices, {"quaternions": [[1.0, 0, 0, 0]]}),
    "move_strands": (
        ls.move_strands,
        {
            "points": POINTS,
            "offsets": [0, 3],
            "roots": POINTS[:1],
            "new_roots": POINTS[:1],
            "turns": TURNS[:1],
        },
    ),
    "into_shading_frames": (ls.into_shading_frames, SHADING),
    "out_of_shading_frames": (ls.out_of_shading_frames, SHADING),
}


def is_array(annotation):
    return "ArrayLike" in ast.unparse(annotation)


def array_parameters(name):
    at = FUNCTIONS[name].args
    return [a.arg for a in (*at.args, *at.kwonlyargs) if a.annotation and is_array(a.annotation)]


def names_of(name):
    at = FUNCTIONS[name].args
    return [a.arg for a in (*at.args, *at.kwonlyargs)]


def test_all_functions_are_here():
    wanted = {name for name in FUNCTIONS if array_parameters(name)}
    assert wanted == set(CASES)


@pytest.mark.parametrize("name", CASES)
def test_right_arguments_are_right(name):
    call, given = CASES[name]
    arrays = set(array_parameters(name))
    assert arrays <= {*given, "faces", "matrix", "transform", "world"}
    call(**given)


def arrays():
    """(name of the function, name of the array, how it is given, the array that is right)"""
    for name, (_, given) in CASES.items():
        for argument in given:
            if argument in array_parameters(name):
                value = given[argument]
                for part in range(len(value)) if isinstance(value, tuple) else [None]:
                    yield name, argument, part


ARRAYS = list(arrays())
NAMES = [f"{name}-{argument}" + (f"-{part}" if part else "") for name, argument, part in ARRAYS]
every_array = pytest.mark.parametrize(("name", "argument", "part"), ARRAYS, ids=NAMES)

#: What messages call the values of arrays for whose name they have another word
WORDS = {
    "positions": "position",
    "edge_sharpness": "sharpness",
    "vertex_sharpness": "sharpness",
    "pixels": "pixel",
    "arc": "arc length",
}


def right(name, argument, part):
    value = CASES[name][1][argument]
    return value if part is None else value[part]


def outcome(name, argument, part, value):
    """What comes of a call with this array: None, or the error and its message."""
    call, given = CASES[name]
    if part is not None:
        value = tuple(value if i == part else v for i, v in enumerate(given[argument]))
    try:
        call(**{**given, argument: value})
    except (TypeError, ValueError) as error:
        found = type(error), str(error)
    else:
        return None
    assert len(found[1]) <= LONGEST
    return found


def with_last(value, last):
    changed = np.array(value, object)
    changed.reshape(-1)[-1] = last
    return changed.tolist()


def has_integers(value):
    return np.array(value).dtype.kind == "i"


@every_array
def test_masked_arrays_are_refused(name, argument, part):
    value = np.array(right(name, argument, part))
    masked = np.ma.masked_array(value, mask=np.zeros(value.shape, bool))
    error, message = outcome(name, argument, part, masked)
    assert error is TypeError
    assert message.startswith(argument)
    assert "masked array" in message
    if masked.ndim > 1:
        error, message = outcome(name, argument, part, list(masked))
        assert message.startswith(argument)
        assert "masked array" in message


@every_array
def test_empty_lists_are_empty_arrays(name, argument, part):
    value = np.array(right(name, argument, part))
    empty = np.zeros((0, *value.shape[1:]), value.dtype)
    if argument == "guide_points":
        empty = empty[:, :2]

    def without_shapes(found):
        return found and (found[0], re.sub(r"\(0,[ 0-9,]*\)", "(0, ...)", found[1]))

    of_list, of_array = (outcome(name, argument, part, v) for v in ([], empty))
    assert without_shapes(of_list) == without_shapes(of_array)


#: Arrays whose lengths go with each other's. Those of the others are those of a mesh or a matrix.
ROWS = {"face", "uv", "points", "normals", "facing", "origins", "directions", "st", "footprint"}
ROWS |= {"below", "above", "weight", "curve", "arc", "source", "target", "vectors", "tangents"}
ROWS |= {"signs", "frames", "roots", "new_roots", "turns", "guide", "handle_left", "handle_right"}
ROWS |= {"quaternions", "rotations", "angles", "along", "closed", "values"}
ROWS |= {"rest_roots", "rest_rotations"}
#: Functions that need one row at least, or that need as many as something has
NEED_ROWS = {"face_varying", "vertex_data", "varying", "set_values", "smooth_path", "even_path"}
NEED_ROWS |= {"fit_path", "curve_directions", "pose_rotations", "unpose", "fingerprints"}


@pytest.mark.parametrize("name", CASES)
def test_nothing_is_made_of_empty_lists(name):
    call, given = CASES[name]
    if name.split(".")[-1] in NEED_ROWS or not ROWS & set(given):
        return
    empty = {key: [] for key in given if key in ROWS}
    offsets = {key: [0] for key in given if key.endswith("offsets")}
    cuts = {"cut_points": []} if "cut_points" in given else {}
    call(**{**given, **empty, **offsets, **cuts})


@every_array
def test_text_is_not_quoted_at_length(name, argument, part):
    value = right(name, argument, part)
    for text in ("x" * 1_300_000, with_last(value, "x" * 1_300_000)):
        error, message = outcome(name, argument, part, text)
        assert issubclass(error, (TypeError, ls.MeshError))
        assert message.startswith(argument)
    error, message = outcome(name, argument, part, with_last([*np.array(value).ravel()], None))
    assert message.startswith(argument)


@every_array
def test_integers_that_are_too_large_are_quoted(name, argument, part):
    value = right(name, argument, part)
    if not has_integers(value):
        return
    last = ", ".join(str(n - 1) for n in np.shape(value))
    if (name, argument) == ("ControlMesh.from_faces", "faces"):
        last = last.replace(", ", "][")
    for large in (2**64, 2**63, -(2**63) - 1):
        error, message = outcome(name, argument, part, with_last(value, large))
        assert issubclass(error, ValueError)
        assert message.startswith(argument)
        assert f"[{last}] is {large}," in message
    error, message = outcome(name, argument, part, with_last(value, 10**10_000))
    assert message.startswith(argument)
    assert "33220 bits" in message
    found = outcome(name, argument, part, with_last(value, 2**40))
    assert found is None or str(2**40) in found[1] or "offsets must" in found[1]


#: Arrays that may hold what is not finite: only the same row of the result depends on a row.
MAY_BE_NAN = {
    *((f"StrandPoser.{name}", argument)
      for name, argument in (("pose", "rest_points"), ("repose", "rest_points"),
                             ("unpose", "points"), ("pose_vectors", "rest_vectors"),
                             ("pose_rotations", "rest_rotations"), ("fingerprints", "points"))),
    *(("child_strands", a) for a in ("guide_points", "guide_normals", "weight")),
    *(("child_strands", a) for a in ("roots", "normals")),
    *((f"{way}_shading_frames", a) for way in ("into", "out_of") for a in SHADING),
    *(("move_strands", a) for a in ("points", "roots", "new_roots", "turns")),
    ("resample_strands", "points"),
    ("FilteredImage.sample", "st"),
    ("FilteredImage.bounds", "boxes"),
    ("blend_over", "below"),
    ("blend_over", "above"),
    ("bilinear", "pixels"),
    ("shortest_turns", "source"),
    ("shortest_turns", "target"),
    ("rotation_matrices", "quaternions"),
    ("quaternions", "rotations"),
    *(("frames_in_world", a) for a in ("frames", "matrix")),
    *(("leaning", a) for a in ("frames", "angles")),
    *(("straight_strands", a) for a in ("roots", "along")),
    ("LimitSurface.displaced", "values"),
    ("LimitSurface.displaced", "frames"),
    ("LimitSurface.vector_displacement", "frames"),
}  # fmt: skip


@every_array
def test_nan_is_quoted(name, argument, part):
    found = outcome(name, argument, part, with_last(right(name, argument, part), float("nan")))
    if (name, argument) in MAY_BE_NAN:
        assert found is None
        return
    error, message = found
    if np.array(right(name, argument, part)).dtype.kind in "ib":
        assert error is TypeError
        assert message.startswith(argument)
        assert "nan" in message or "float64; expected booleans" in message
    else:
        assert issubclass(error, ValueError)
        assert re.search(WORDS.get(argument, rf"\b{argument}\b"), message), message
        assert "nan" in message


@every_array
def test_small_numbers_are_not_rounded(name, argument, part):
    value = right(name, argument, part)
    if np.array(value).dtype.kind in "ib":
        return
    found = outcome(name, argument, part, with_last(value, -1e-9))
    if found is not None and "last row" not in found[1]:
        assert re.search(r"-1e-09(?!\d)", found[1]), found


@pytest.mark.parametrize(
    ("call", "wrong"),
    [
        (lambda: SURFACE.tessellate(2**64), "levels is 18446744073709551616"),
        (lambda: SURFACE.tessellate(-(2**40)), "levels is -1099511627776"),
        (lambda: SURFACE.tessellate([1] * 8 + [2**40]), r"levels\[8\] is 1099511627776"),
        (lambda: SURFACE.closest(POINTS, -1e-9), "max_distance is -1e-09;"),
        (lambda: SURFACE.lay_path(POINTS, -1e-9), "tolerance is -1e-09;"),
        (lambda: ls.box_weights(UP, -1e-9), "blend is -1e-09;"),
    ],
)
def test_numbers_are_quoted_as_they_were_written(call, wrong):
    with pytest.raises(ValueError, match=f"^{wrong}"):
        call()


@pytest.mark.parametrize(
    ("call", "wrong"),
    [
        (lambda: SURFACE.fit_path(FACE, UV, 0.1, offset=float("nan")), "offset is nan"),
        (lambda: SURFACE.fit_path(FACE, UV, 0.1, corner_angle=float("nan")), "corner_angle is nan"),
        (lambda: SURFACE.fit_path(FACE, UV, 0.1, corner_angle=-5.0), "corner_angle is -5;"),
        (
            lambda: SURFACE.fit_path(FACE, UV, 0.1, values=[1] * 3, value_tolerance=float("nan")),
            "value_tolerance is nan",
        ),
        (lambda: UV_MAP.rasterize(4, 4, margin=2**64), r"margin is 1\.8446744073709552e\+19;"),
        (
            lambda: SURFACE.scatter_blue_noise(radius=-(2**63) - 1),
            r"radius is -9\.223372036854775808e\+18;|radius is -9\.223372036854776e\+18;",
        ),
        (
            lambda: POSER.unpose([]),
            "points has 0 rows; expected 3",
        ),
        (
            lambda: SURFACE.strand_poser(FACE, UV, UP, [np.full((3, 3), np.inf)] * 3),
            "row 0: rest_rotations has inf, which is not finite",
        ),
        (
            lambda: SURFACE.guide_weights(FACE, [[2, 2]] * 3, FACE, UV),
            r"row 0: guide_uv is \(2, 2\), which is outside \[0, 1\]",
        ),
        (
            lambda: SURFACE.guide_weights(FACE, UV, FACE, [[2, 2]] * 3),
            r"row 0: uv is \(2, 2\), which is outside \[0, 1\]",
        ),
        (lambda: SURFACE.guide_weights([9], UV[:1], FACE, UV), "row 0: guide_face 9 is not among"),
        (
            lambda: SURFACE.guide_weights([2**40], UV[:1], FACE, UV),
            "row 0: guide_face 1099511627776 is not among",
        ),
        (lambda: SURFACE.guide_weights(FACE, UV, [9], UV[:1]), "row 0: face 9 is not among"),
        (
            lambda: SURFACE.guide_weights(FACE, UV, FACE, UV, cut_points=UP, cut_offsets=[0]),
            "cut_offsets must .* the number of rows of cut_points, 3$",
        ),
        (
            lambda: SURFACE.closest(POINTS[:2], facing=UP),
            "facing has 3 rows; expected 2, as many as points has$",
        ),
        (
            lambda: SURFACE.ray_cast(UP[:1], UP[:2]),
            "directions has 2 rows; expected 1, as many as origins has$",
        ),
        (
            lambda: SURFACE.strand_poser(FACE, UV, UP[:1], [np.eye(3)] * 3),
            "rest_roots has 1 row; expected 3, as many as face has$",
        ),
        (
            lambda: SURFACE.smooth_path(FACE[:2], UV[:2], [1, 0, 1]),
            "weights has 3 rows; expected 2, as many as face has$",
        ),
        (
            lambda: SURFACE.fit_path(FACE[:2], UV[:2], 0.1, values=[1, 0, 1]),
            "values has 3 rows; expected 2, as many as face has$",
        ),
        (
            lambda: SURFACE.fit_path(FACE[:2], UV[:2], 0.1, values=[]),
            "values has 0 rows; expected 2, as many as face has$",
        ),
        (
            lambda: ls.straight_strands(UP, UP, -1, np.zeros((3, 3, 3), np.float32)),
            "points is -1; expected 1 or more$",
        ),
        (
            lambda: SURFACE.tessellate(-(2**63)),
            "levels is -9223372036854775808",
        ),
        (
            lambda: SURFACE.closest(POINTS, facing=[0, 0, 0]),
            r"row 0: facing is \(0, 0, 0\), which has no length",
        ),
        (
            lambda: SURFACE.ray_cast([[1e160, 0, 0]], UP[:1]),
            r"row 0: origins is \(1e\+160, 0, 0\), which is too far away",
        ),
        (
            lambda: ls.into_shading_frames(UP, UP[:1], UP, [1] * 3),
            "normals has 1 row; expected 3, as many as vectors has$",
        ),
    ],
)
def test_the_argument_and_its_value_are_quoted(call, wrong):
    with pytest.raises(ValueError, match=f"^(?:{wrong})"):
        call()


@pytest.mark.parametrize(
    "dtype", ["x" * 10**6, "3", "", 10**400, "f8,,", {"a": 1}, "x", object(), "int32", complex]
)
def test_dtypes_are_named(dtype):
    for call in (SURFACE.evaluate, SURFACE.frames, SURFACE.curvature):
        with pytest.raises(TypeError, match=r"^dtype is .*; expected float64 or float32") as raised:
            call(FACE, UV, dtype=dtype)
        assert len(str(raised.value)) < 200


class Unprintable:
    def __repr__(self):
        raise ZeroDivisionError


@every_array
def test_values_whose_repr_raises(name, argument, part):
    for value in (Unprintable(), with_last(right(name, argument, part), Unprintable())):
        error, message = outcome(name, argument, part, value)
        assert issubclass(error, (TypeError, ls.MeshError))
        assert message.startswith(argument)


@pytest.mark.parametrize("argument", ["derivatives", "threads", "dtype"])
def test_single_values_whose_repr_raises(argument):
    with pytest.raises(TypeError, match=f"^{argument} is "):
        ANY_SURFACE.evaluate(FACE, UV, **{argument: Unprintable()})


def test_children_of_no_guides():
    assert ls.child_strands([], [], [], [], [], []).shape == (0, 2, 3)
    with pytest.raises(ValueError, match="^guide_points has 1 points for each guide; expected 2"):
        ls.child_strands([[[0, 0, 0]]], UP[:1], [], [], [], [])
    with pytest.raises(
        ValueError, match="^guide_normals has 0 rows; expected 1, as many as guide_points has$"
    ):
        ls.child_strands([POINTS], [], [], [], [], [])


@pytest.mark.parametrize(
    "call",
    [
        lambda text: ls.ControlMesh.from_faces(SQUARES, FACES, boundary=text),
        lambda text: SURFACE.edge_curves(text),
        lambda text: SURFACE.curvature(FACE, UV, irregular=text),
        lambda text: SURFACE.fit_path(FACE, UV, 0.1, kind=text),
        lambda text: CURVES.at([0], [0.1], text),
        lambda text: ls.FilteredImage(PIXELS, text),
        lambda text: SURFACE.evaluate(FACE, UV, text),
        lambda text: SURFACE.evaluate([0] * 300_000, UV, threads=text),
        lambda text: ls.LimitSurface(text),
        lambda text: SURFACE.closest([0] * 300_000, text),
    ],
)
def test_words_are_not_quoted_at_length(call):
    with pytest.raises((TypeError, ValueError)) as raised:
        call("x" * 1_300_000)
    assert len(str(raised.value)) < 2500  # pybind11 lists the parameters, and all that are allowed


def test_faces_of_another_type_are_named():
    faces = [np.array(face) for face in FACES]
    faces[5] = faces[5] * 1.0
    with pytest.raises(TypeError, match=r"^faces\[5\] has dtype float64; expected integers$"):
        ls.ControlMesh.from_faces(SQUARES, faces)
    faces[5] = FACES[5].reshape(2, 2)
    with pytest.raises(ls.MeshError, match=r"^faces\[5\] has shape \(2, 2\)"):
        ls.ControlMesh.from_faces(SQUARES, faces)


def creased(edges, values):
    return ls.ControlMesh.from_faces(SQUARES, FACES, edge_sharpness=(edges, values))


def test_edges_that_are_named_again():
    a, b = FACES[4, :2].tolist()
    other = FACES[0, :2].tolist()
    again = creased([[a, b], other, [b, a]], [2.5, 1.0, 2.5])
    once = creased([[a, b], other], [2.5, 1.0])
    at = np.arange(9).repeat(2), np.random.default_rng(0).random((18, 2))
    np.testing.assert_array_equal(
        ls.LimitSurface(again).evaluate(*at).position, ls.LimitSurface(once).evaluate(*at).position
    )
    with pytest.raises(
        ls.MeshError,
        match=rf"^edge_sharpness row 2, edge \({b}, {a}\) has sharpness 0.1, but row 0 gives it "
        "2.5$",
    ):
        creased([[a, b], other, [b, a]], [2.5, 1.0, 0.1])


def test_vertices_that_are_named_again():
    def corners(values):
        return ls.ControlMesh.from_faces(SQUARES, FACES, vertex_sharpness=([5, 3, 5], values))

    corners([1.0, 2.0, 1.0])
    with pytest.raises(
        ls.MeshError,
        match="^vertex_sharpness row 2, vertex 5 has sharpness inf, but row 0 gives it 1$",
    ):
        corners([1.0, 2.0, float("inf")])


def test_errors_name_the_argument_of_a_wrong_type():
    positions, faces = shapes.grid(2, 2)
    surface = ls.LimitSurface(ls.ControlMesh.from_faces(positions, faces))
    calls = {
        "threads is 1.5; expected an integer": lambda: surface.evaluate(0, [[0, 0]], threads=1.5),
        "derivatives is 'x'; expected an integer": lambda: surface.evaluate(0, [[0, 0]], "x"),
        "max_angle is 'x'; expected a number": lambda: surface.closest([[0, 0, 0]], max_angle="x"),
        "interpolation is 3; expected a string": lambda: surface.face_varying([[0, 0]], [0], 3),
    }
    for message, call in calls.items():
        with pytest.raises(TypeError) as error:
            call()
        assert str(error.value) == message


@every_array
def test_numbers_that_float32_cannot_hold(name, argument, part, recwarn):
    value = right(name, argument, part)
    if np.array(value).dtype.kind != "f":
        return
    found = outcome(name, argument, part, with_last(value, 1e59))
    assert not recwarn
    assert found is None or "inf" not in found[1]
    if argument in ("rest_roots", "rest_rotations") and name.startswith("LimitSurface"):
        assert found == (ValueError, f"row 2: {argument} has 1e+59, which float32 cannot hold")


EYE = np.eye(4)
ANY_MAP: Any = SURFACE.vertex_data(SQUARES[:, :2])
# mypy would see what is wrong.
ANY_SURFACE: Any = SURFACE
LS: Any = ls


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: ANY_SURFACE.scatter_uniform(1, 2**64),
            f"seed is {2**64}; expected an integer below {2**64}",
        ),
        (
            lambda: ANY_SURFACE.scatter_uniform(1, 10**5000),
            f"seed is an integer of 16610 bits; expected an integer below {2**64}",
        ),
        (
            lambda: ANY_SURFACE.closest([[0, 0, 0]], threads=-(10**5000)),
            f"threads is an integer of 16610 bits; expected an integer of at least {-(2**31)}",
        ),
        (
            lambda: ANY_SURFACE.closest([[0, 0, 0]], max_distance=10**5000),
            "max_distance is an integer of 16610 bits; expected a number below 1.8e308",
        ),
        (
            lambda: ANY_SURFACE.scatter_uniform(1, -1),
            "seed is -1; expected an integer of at least 0",
        ),
        (
            lambda: ANY_SURFACE.scatter_uniform(2**63),
            f"count is {2**63}; expected an integer below {2**63}",
        ),
        (
            lambda: LS.ControlMesh(SQUARES, [4], FACES[0], boundary=None),
            "boundary is None; expected a string",
        ),
        (lambda: LS.LimitSurface(None), "mesh is None; expected a ControlMesh"),
        (lambda: LS.FilteredImage(PIXELS, 3), "extension is 3; expected a string"),
        (
            lambda: LS.PtexLayout(2**40, 1),
            f"face_count is {2**40}; expected an integer below {2**31}",
        ),
        (lambda: LS.PtexLayout(1, "a"), "resolution is 'a'; expected an integer"),
        (lambda: LS.PtexLayout(-1, 2), "face_count is -1; expected 1 or more"),
        (
            lambda: ANY_SURFACE.tiles(FACE, UV, max_depth=1.5),
            "max_depth is 1.5; expected an integer",
        ),
        (
            lambda: ANY_SURFACE.scatter_along(CURVES, spacing="a"),
            "spacing is 'a'; expected a number",
        ),
        (lambda: ANY_SURFACE.scatter_along(None, 3), "curves is None; expected an EdgeCurves"),
        (
            lambda: ANY_SURFACE.tangent_frames(None, FACE, UV),
            "uv_map is None; expected a SurfaceData",
        ),
        (
            lambda: LS.LimitSurface.strand_poser(1, [0], UV, UV, UV),
            "self is 1; expected a LimitSurface",
        ),
        (
            lambda: LS.ControlMesh.from_faces(SQUARES, None),
            "faces is None; expected lists of vertex indices",
        ),
        (
            lambda: LS.ControlMesh.from_faces(SQUARES, FACES, 3),
            "edge_sharpness is 3; expected two arrays",
        ),
        (lambda: ANY_MAP.rasterize(3, 3, np.array(2)), "tile is array(2); expected two integers"),
        *(
            (
                lambda texel=texel: ANY_SURFACE.project(ANY_MAP, FACE, UV, EYE, texel),
                f"texel is {texel!r}; expected two numbers",
            )
            for texel in (3, None, "ab", (1,), {1: 2, 3: 4}, np.array(2))
        ),
        (
            lambda: ANY_SURFACE.project(ANY_MAP, FACE, UV, EYE, (1, 1), facing=3),
            "facing is 3; expected two numbers",
        ),
        (
            lambda: ANY_SURFACE.project(ANY_MAP, FACE, UV, EYE, (1, 1), depth=()),
            "depth is (); expected two numbers",
        ),
        (
            lambda: ANY_SURFACE.evaluate(0, UV, threads=int),
            "threads is <class 'int'>; expected an integer",
        ),
        (
            lambda: ANY_SURFACE.closest(POINTS, float),
            "max_distance is <class 'float'>; expected a number",
        ),
        (
            lambda: ANY_SURFACE.area(error=bool),
            "error is <class 'bool'>; expected True or False",
        ),
        (lambda: ANY_SURFACE.evaluate(0), "evaluate() lacks the argument uv"),
        (lambda: ANY_SURFACE.evaluate(0, UV, uvs=3), "evaluate() has no argument 'uvs'"),
        (lambda: ANY_SURFACE.evaluate(0, UV, uv=UV), "evaluate() is given the argument uv twice"),
        (lambda: ANY_SURFACE.bounds(3), "bounds() takes at most 0 arguments by position; 1 given"),
        (
            lambda: LS.PtexLayout(1, 2, 3),
            "PtexLayout() takes at most 2 arguments by position; 3 given",
        ),
        (lambda: LS.PtexLayout(1), "PtexLayout() lacks the argument resolution"),
    ],
)
def test_the_argument_is_named_in_a_line(call, message):
    with pytest.raises((TypeError, ValueError)) as error:
        call()
    assert str(error.value) == message
