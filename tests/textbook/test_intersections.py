from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.rotations import rotation_about
from vectorplot.textbook.intersections import Plane, line_and_line, line_and_plane, polygons_common_segment, segments

small = st.integers(-20, 20).map(lambda k: k / 4)
vector3 = st.tuples(small, small, small).map(np.array)
SQUARE = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])


@pytest.mark.capability("G1.3-line-plane")
def test_tv13_line_and_plane():
    plane = Plane.through((1, 0, 2), (3, 1, -1), (0, 4, 1))
    cut = line_and_plane((5, 5, 5), (-1, -2, 0.5), plane)
    assert cut.parameter == pytest.approx(5.81818181818182, abs=1e-12)
    assert plane.normal @ cut.point == pytest.approx(29.0, abs=1e-12)
    assert not cut.parallel


@pytest.mark.capability("G1.3-line-plane")
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_lines_parallel_to_a_plane_or_in_it(scale):
    plane = Plane.through((0, 0, 0), (scale, 0, 0), (0, scale, 0))
    starts = scale * np.array([(1.0, 2.0, 0.0), (1.0, 2.0, 3.0), (1.0, 2.0, -3.0)])
    cut = line_and_plane(starts, scale * np.array([(1.0, 1.0, 0.0), (1.0, -1.0, 0.0), (0.0, 0.0, 1.0)]), plane)
    assert cut.parallel.tolist() == [True, True, False]
    assert cut.parameter.tolist() == [0.0, np.inf, 3.0]
    assert cut.point.tolist() == [
        [scale, 2 * scale, 0.0],
        [np.inf, -np.inf, 3 * scale],
        [scale, 2 * scale, 0.0],
    ]


@pytest.mark.capability("G1.3-line-line")
def test_lines_in_an_upright_plane():
    cut = line_and_line((0, 0, 0), (1, 0, 1), (0, 0, 1), (1, 0, -1))
    assert cut.parameter == 0.5 and cut.point.tolist() == [0.5, 0.0, 0.5] and not cut.parallel


@pytest.mark.capability("G1.3-line-line")
@given(vector3, vector3, vector3, st.floats(-5, 5), st.floats(-5, 5))
def test_coplanar_lines_in_any_orientation_meet_where_they_were_made_to(meeting, d, e, s, t):
    if np.linalg.norm(np.cross(d, e)) < 0.3:
        return
    a, b = meeting - s * d, meeting - t * e
    size = 1.0 + np.abs(np.stack([a, b, d, e])).max()
    cut = line_and_line(a, d, b, e)
    tolerance = 1e-11 * size**3
    assert np.allclose(cut.point, meeting, atol=tolerance)
    assert cut.parameter == pytest.approx(s, abs=tolerance)
    assert np.linalg.norm(np.cross(cut.point - b, e)) <= tolerance * size


@pytest.mark.capability("G1.3-line-line")
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_lines_parallel_to_an_axis_and_identical_lines(offset):
    o = np.full(3, offset)
    axes = np.eye(3)
    for d in axes:
        for e in axes:
            cut = line_and_line(o + 2 * e, d, o - 3 * d, e)
            if (d == e).all():
                assert cut.parallel and cut.parameter == 0.0 and np.array_equal(cut.point, o + 2 * e)
            else:
                assert np.allclose(cut.point, o + 2 * e - 3 * d, rtol=0, atol=1e-9) and abs(cut.parameter + 3) < 1e-9
        beside = line_and_line(o, d, o + np.roll(d, 1), -2 * d)
        assert beside.parallel and beside.parameter == np.inf
    assert line_and_line((0.0, 0.0), (1.0, 1.0), (0.0, 2.0), (1.0, -1.0)).point.tolist() == [1.0, 1.0]
    assert line_and_line((0.0, 0.0), (1.0, 1.0), (0.0, 2.0), (3.0, 3.0)).parameter == np.inf
    assert line_and_line((0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)).parameter == 0.0


@pytest.mark.hard(23)
def test_lines_that_cross_at_a_billionth_of_a_radian_are_not_parallel():
    t1, t2, crossing = segments((-1, 0, 0), (1, 0, 0), (-1, -1e-9, 0), (1, 1e-9, 0))
    assert crossing
    assert abs(t1 - 0.5) < 1e-6 and abs(t2 - 0.5) < 1e-6


@pytest.mark.capability("G1.3-segments")
def test_tv14_parameters_of_two_segments():
    t1, t2, crossing = segments((0, 0), (4, 2), (1, 3), (3.5, -1))
    assert crossing
    assert t1 == pytest.approx(0.547619047619048, abs=1e-12)
    assert t2 == pytest.approx(0.476190476190476, abs=1e-12)


@pytest.mark.capability("G1.3-segments")
def test_many_segments_at_once_and_parallel_ones_say_so():
    starts = np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 0.0]])
    ends = np.array([[2.0, 0.0], [2.0, 0.0], [2.0, 0.0]])
    other_starts, other_ends = np.array([[1, -1], [0, 1], [1, 0]]), np.array([[1, 3], [2, 1], [5, 0]])
    t1, t2, crossing = segments(starts, ends, other_starts, other_ends)
    assert crossing.tolist() == [True, False, False]
    assert t1.tolist() == [0.5, np.inf, np.inf] and t2.tolist() == [0.25, np.inf, np.inf]


def inside(polygon, points, tolerance):
    """How far points may be outside: plane distance and distances to the sides."""
    normal = np.cross(polygon[1] - polygon[0], polygon[2] - polygon[0])
    normal = normal / np.linalg.norm(normal)
    assert np.abs((points - polygon[0]) @ normal).max() <= tolerance
    for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        side = np.cross(normal, b - a) / np.linalg.norm(b - a)
        assert ((points - a) @ side).min() >= -tolerance


@pytest.mark.capability("G1.3-polygon-polygon")
@pytest.mark.parametrize(("scale", "offset"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_common_segment_of_polygons_in_all_orientations(scale, offset):
    upright = SQUARE[:, [0, 2, 1]] + (0.5, 0.2, 0.3)
    rng = np.random.default_rng(5)
    turns = [np.eye(3), *(rotation_about(rng.normal(size=3), rng.uniform(0, 6)) for _ in range(30))]
    for turn in turns:
        for first, second in ((SQUARE, upright), (upright, SQUARE), (SQUARE[::-1], upright)):
            p, q = (scale * (x @ turn) + offset for x in (first, second))
            ends, exists = polygons_common_segment(p, q)
            assert exists
            tolerance = 1e-12 * scale + 1e-9 * (offset > 0)
            inside(p, ends, tolerance)
            inside(q, ends, tolerance)
            expected = scale * (np.array([[-0.5, 0.2, 0.0], [1.0, 0.2, 0.0]]) @ turn) + offset
            gap = min(np.abs(ends - expected).max(), np.abs(ends[::-1] - expected).max())
            assert gap <= tolerance


@pytest.mark.capability("G1.3-polygon-polygon")
def test_polygons_that_have_no_common_segment():
    upright = SQUARE[:, [0, 2, 1]]
    above, beside, behind, touching = (3 * np.array([0, 0, 1]), (3, 0, 0), (0, 5, 0), (2, 0, 0))
    apart = [np.add(upright, move) for move in (above, beside, behind, touching)]
    apart += [np.add(SQUARE, (0, 0, 1)), np.add(SQUARE, (0.5, 0, 0))]  # parallel, coplanar
    ends, exists = polygons_common_segment(SQUARE, np.array(apart))
    assert exists.tolist() == [False] * 6
    assert np.isfinite(ends).all()
    with pytest.raises(InputError):
        polygons_common_segment(SQUARE[:2], SQUARE)


@pytest.mark.capability("G1.3-polygon-polygon")
def test_an_edge_that_lies_in_the_other_polygon_is_the_common_segment():
    ends, exists = polygons_common_segment(SQUARE, SQUARE[:, [0, 2, 1]] / 2 + (0.0, 0.0, 0.5))
    assert exists
    assert sorted(ends.tolist()) == [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]]
    corner = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 1.0], [-0.5, 0.0, 1.0]])
    assert not polygons_common_segment(SQUARE, corner)[1]


@pytest.mark.slow
@pytest.mark.capability("G1.3-polygon-polygon")
def test_random_triangles_agree_with_sampling_along_the_planes():
    rng = np.random.default_rng(6)
    first, second = rng.uniform(-1, 1, (2, 300, 3, 3))
    ends, exists = polygons_common_segment(first, second)
    assert 40 < exists.sum() < 260
    for p, q, segment in zip(first[exists], second[exists], ends[exists], strict=True):
        inside(p, segment, 1e-10)
        inside(q, segment, 1e-10)
    # Where there is none, no edge of one triangle may pierce the other.
    for p, q in zip(first[~exists], second[~exists], strict=True):
        for one, other in ((p, q), (q, p)):
            normal = np.cross(other[1] - other[0], other[2] - other[0])
            for a, b in zip(one, np.roll(one, -1, axis=0), strict=True):
                t = (other[0] - a) @ normal / ((b - a) @ normal)
                x = a + t * (b - a)
                sides = [
                    np.cross(w - u, x - u) @ normal for u, w in zip(other, np.roll(other, -1, axis=0), strict=True)
                ]
                assert not (0 <= t <= 1 and min(sides) > 1e-9)


@pytest.mark.capability("G1.3-polygon-polygon")
@pytest.mark.hard(19)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_what_counts_as_a_segment_or_as_parallel_does_not_depend_on_the_scale(scale):
    upright = SQUARE[:, [0, 2, 1]]
    overlaps = np.array([1e-3, 1e-6, 1e-11, 0.0, -1e-6])
    others = np.array([np.add(upright, (2.0 - overlap, 0.0, 0.0)) for overlap in overlaps])
    _, exists = polygons_common_segment(scale * SQUARE, scale * others)
    assert exists.tolist() == [True, True, False, False, False]
    tilts = np.array([1e-3, 5e-13, 0.0])
    tilted = np.array([SQUARE @ rotation_about((1, 0, 0), tilt) for tilt in tilts])
    _, exists = polygons_common_segment(scale * SQUARE, scale * tilted)
    assert exists.tolist() == [True, False, False]


@pytest.mark.capability("G1.3-line-line")
@pytest.mark.hard(19)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_what_counts_as_the_same_line_does_not_depend_on_the_scale(scale):
    rng = np.random.default_rng(16)
    a, d = scale * rng.normal(size=(2, 100, 3))
    t = rng.uniform(-5, 5, (100, 1))
    same = line_and_line(a, d, a + t * d, -0.7 * d)
    assert same.parallel.all() and (same.parameter == 0.0).all()
    across = np.cross(d, rng.normal(size=(100, 3)))
    across *= np.linalg.norm(d, axis=1, keepdims=True) / np.linalg.norm(across, axis=1, keepdims=True)
    beside = line_and_line(a, d, a + t * d + 1e-4 * across, d)
    assert beside.parallel.all() and np.isinf(beside.parameter).all()
