# SPDX-License-Identifier: Apache-2.0
"""Filtered images, blending and the projectors of a box, called from Python."""

from typing import Any

import limitsurf as ls
import numpy as np
import pytest

UNKNOWN: Any = "wrap"  # an extension that there is not


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def test_rows_run_from_the_bottom_and_channels_stay(rng):
    pixels = rng.random((3, 5, 3), dtype=np.float32)
    image = ls.FilteredImage(pixels, "extend")
    assert image.shape == (3, 5, 3)
    y, x = np.mgrid[0:3, 0:5]
    centres = np.stack([(x + 0.5) / 5, (y + 0.5) / 3], axis=-1).reshape(-1, 2)
    found = image.sample(centres, np.zeros((15, 2, 2)))
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, pixels.reshape(15, 3), atol=1e-6)


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_footprints_run_across_the_image(rng, channels):
    """A footprint along s averages columns, and one along t averages rows."""
    pixels = np.zeros((64, 64, channels), np.float32)
    pixels[:, ::2] = 1
    image = ls.FilteredImage(pixels, "mirror")
    along_s, along_t = np.zeros((2, 1, 2, 2))
    along_s[0, 0, 1] = 8 / 64
    along_t[0, 1, 0] = 8 / 64
    st = [[0.5 + 0.5 / 64, 0.5]]
    np.testing.assert_allclose(image.sample(st, along_s)[0, -1], 0.5, atol=0.02)
    np.testing.assert_allclose(image.sample(st, along_t)[0, -1], 1, atol=0.1)


def test_any_numbers_will_do(rng):
    pixels = rng.integers(0, 2, (4, 4, 1))
    st, footprint = rng.random((9, 2)), np.zeros((9, 2, 2))
    expected = ls.FilteredImage(pixels.astype(np.float32)).sample(st, footprint)
    for other in (pixels, pixels.astype(np.float64), pixels.astype(np.float16), pixels > 0):
        found = ls.FilteredImage(other).sample(st.tolist(), footprint)
        np.testing.assert_array_equal(found, expected)
    strided = np.zeros((4, 8, 1), np.float32)[:, ::2]
    strided[:] = pixels
    np.testing.assert_array_equal(ls.FilteredImage(strided).sample(st, footprint), expected)


@pytest.mark.parametrize(
    ("error", "message", "call"),
    [
        (ValueError, "pixels has shape", lambda: ls.FilteredImage(np.zeros((4, 4)))),
        (ValueError, "pixels has shape", lambda: ls.FilteredImage(np.zeros((4, 4, 5)))),
        (ValueError, "pixels has shape", lambda: ls.FilteredImage(np.zeros((0, 4, 4)))),
        (ValueError, "pixel .0, 0.: channel 0 is nan", lambda: ls.FilteredImage([[[np.nan]]])),
        (ValueError, "extension is 'wrap'", lambda: ls.FilteredImage([[[1]]], UNKNOWN)),
        (TypeError, "pixels has dtype", lambda: ls.FilteredImage([[["x"]]])),
        (TypeError, "never initialised", lambda: ls.FilteredImage.__new__(ls.FilteredImage).shape),
    ],
)
def test_no_image(error, message, call):
    with pytest.raises(error, match=message):
        call()


def test_rows_that_do_not_fit():
    image = ls.FilteredImage(np.ones((2, 2, 4)))
    assert image.sample(np.zeros((0, 2)), np.zeros((0, 2, 2))).shape == (0, 4)
    with pytest.raises(ValueError, match="st has shape"):
        image.sample(np.zeros((3, 3)), np.zeros((3, 2, 2)))
    with pytest.raises(ValueError, match="footprint has shape"):
        image.sample(np.zeros((3, 2)), np.zeros((2, 2, 2)))
    st = np.zeros((300_001, 2))
    st[-1] = np.inf
    with pytest.raises(ValueError, match="row 300000"):
        image.sample(st, np.zeros((300_001, 2, 2)))


def test_looking_up_tells_progress_and_can_be_stopped():
    image = ls.FilteredImage(np.ones((2, 2, 4)))
    st, footprint = np.zeros((600_000, 2)), np.zeros((600_000, 2, 2))
    parts = []
    image.sample(st, footprint, progress=parts.append)
    assert len(parts) == 3
    assert parts[-1] == 1

    def stop(part):
        raise KeyError

    with pytest.raises(KeyError):
        image.sample(st, footprint, progress=stop)


def over(below, above, weight, mode):
    """The expected blend by the definitions, in double precision, with straight alpha."""
    below, above = below.astype(float), above.astype(float)
    under, alpha = below[:, 3:], above[:, 3:] * weight[:, None]
    cb, cs = below[:, :3], above[:, :3]
    blended = {"mix": cs, "add": cb + cs, "multiply": cb * cs}[mode]
    cs = (1 - under) * cs + under * blended
    out = alpha + under * (1 - alpha)
    with np.errstate(invalid="ignore"):
        colour = (alpha * cs + (1 - alpha) * under * cb) / out
    return np.column_stack([np.where(out > 0, colour, cb), out])


@pytest.mark.parametrize("mode", ["mix", "add", "multiply"])
def test_blending(rng, mode):
    below, above = rng.random((2, 1000, 4), dtype=np.float32)
    below[::3, 3], above[::5, 3] = 1, 1
    below[::7, 3], above[::11, 3] = 0, 0
    weight = rng.random(1000)
    weight[::2], weight[1::4] = 0, 1
    out = ls.blend_over(below, above, weight, mode)
    assert out.dtype == np.float32
    np.testing.assert_allclose(out, over(below, above, weight, mode), atol=2e-6)
    untouched = (weight == 0) | (above[:, 3] == 0)
    assert out[untouched].tobytes() == below[untouched].tobytes()

    multiplied = below * np.where([True, True, True, False], below[:, 3:], 1)
    out = ls.blend_over(multiplied, above, weight, mode, premultiplied=True)
    expected = over(below, above, weight, mode)
    expected[:, :3] *= expected[:, 3:]
    np.testing.assert_allclose(out, expected, atol=2e-6)
    assert out[untouched].tobytes() == multiplied[untouched].tobytes()


def test_opaque_pixels_replace_what_is_below(rng):
    below, above = rng.random((2, 100, 4), dtype=np.float32)
    above[:, 3] = 1
    np.testing.assert_array_equal(ls.blend_over(below, above, np.ones(100)), above)


def test_pixels_that_do_not_fit():
    one = np.ones((3, 4))
    for call, message in (
        (lambda: ls.blend_over(one, one[:2], np.ones(3)), "above has 2 rows"),
        (lambda: ls.blend_over(one[:, :3], one, np.ones(3)), "below has shape"),
        (lambda: ls.blend_over(one, one, [0, 1, 1.5]), "row 2: the weight 1.5"),
        (lambda: ls.blend_over(one, one, [0, np.nan, 1]), "row 1: the weight nan"),
        (lambda: ls.blend_over(one, one, np.ones(3), "screen"), "mode is 'screen'"),
    ):
        with pytest.raises(ValueError, match=message):
            call()
    assert ls.blend_over(one[:0], one[:0], []).shape == (0, 4)


def test_sides_of_a_box_face_outwards():
    box = np.array([[2, 0, 0, 1], [0, 0, -3, 0], [0, 1, 0, 5], [0, 0, 0, 1.0]])
    sides = ls.box_sides(box)
    assert sides.shape == (6, 4, 4)
    for side, outward in zip(sides, np.repeat(np.eye(3), 2, axis=0), strict=True):
        in_box = side @ np.linalg.inv(box)
        right, up, deeper = in_box[:3, :3]
        np.testing.assert_allclose(np.abs(deeper), outward)
        np.testing.assert_allclose(np.cross(right, up), -deeper)  # not mirrored, seen from there
        np.testing.assert_allclose(up, [0, 1, 0] if outward[2] else [0, 0, 1])
    np.testing.assert_allclose(sides[0::2, 2] + sides[1::2, 2], 0, atol=1e-15)


def test_weights_of_a_boxs_sides(rng):
    normals = rng.normal(size=(500, 3))
    for blend in (0, 0.3, 1):
        weights = ls.box_weights(normals, blend)
        np.testing.assert_allclose(weights.sum(axis=1), 1)
        assert np.all(weights >= 0)
        away = np.repeat(normals, 2, axis=1) * [1, -1, 1, -1, 1, -1] <= 0
        assert not weights[away].any()
        most = np.argmax(np.repeat(normals, 2, axis=1) * [1, -1, 1, -1, 1, -1], axis=1)
        np.testing.assert_array_equal(np.argmax(weights, axis=1), most)
        assert np.all((weights > 0).sum(axis=1) == 1) == (blend == 0)
    share = np.abs(normals) / np.abs(normals).sum(axis=1, keepdims=True)
    np.testing.assert_allclose(ls.box_weights(normals, 1).reshape(-1, 3, 2).sum(axis=2), share)

    # The planes of the surface, in a stretched box.
    box = np.array([[1, 0.5, 0, 0], [0, 3, 0, 0], [0, 0, 0.2, 0], [0, 0, 0, 1]])
    across = np.linalg.inv(box[:3, :3]).T @ normals.T
    np.testing.assert_allclose(ls.box_weights(normals, 0.3, box), ls.box_weights(across.T, 0.3))

    for options, message in (
        ({"blend": 1.5}, "blend is 1.5"),
        ({"blend": np.nan}, "blend is nan"),
        ({"matrix": np.zeros((4, 4))}, "matrix is not affine"),
        ({"matrix": np.diag([1, 0, 1, 1])}, "matrix is singular"),
    ):
        with pytest.raises(ValueError, match=message):
            ls.box_weights(normals, **options)
    with pytest.raises(ValueError, match="row 1"):
        ls.box_weights([[1, 0, 0], [0, 0, 0]])


@pytest.mark.parametrize("extension", ["clip", "extend", "repeat", "mirror"])
def test_bounds_hold_in_their_boxes(rng, extension):
    pixels = rng.random((6, 9, 2), dtype=np.float32) - 0.5
    image = ls.FilteredImage(pixels, extension)
    low = rng.uniform(-2, 2, (50, 2))
    boxes = np.stack([low, low + rng.uniform(0, 0.6, (50, 2))], axis=1)
    bounds = image.bounds(boxes)
    assert bounds.shape == (50, 2, 2)
    assert bounds.dtype == np.float32
    part = rng.random((30, 50, 2))
    inside = boxes[:, 0] + part * (boxes[:, 1] - boxes[:, 0])
    found = image.sample(inside.reshape(-1, 2), np.zeros((1500, 2, 2))).reshape(30, 50, 2)
    assert (found >= bounds[:, 0]).all()
    assert (found <= bounds[:, 1]).all()
    assert np.isnan(image.bounds([[[np.nan, 0], [1, 1]]])).all()
    assert image.bounds([]).shape == (0, 2, 2)


def test_boxes_that_have_no_bounds():
    image = ls.FilteredImage(np.ones((2, 2, 1)), "clip")
    with pytest.raises(ValueError, match=r"boxes has shape \(1, 4\); expected \(n, 2, 2\)"):
        image.bounds([[0, 0, 1, 1]])
    with pytest.raises(ValueError, match=r"row 1: boxes is from \(0, 1\) to \(1, 0\)"):
        image.bounds([[[0, 0], [1, 1]], [[0, 1], [1, 0]]])
    with pytest.raises(ValueError, match="4 channels"):
        ls.FilteredImage(np.ones((2, 2, 4)), "clip").bounds([[[0, 0], [1, 1]]])
