"""Clipping by convex polygons against shapely and by hand."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely

from vectorplot.geometry.polygon_cuts import clipped_by_convex, inside_convex

SQUARE = np.array([[0.0, 2.0, 2.0, 0.0], [0.0, 0.0, 2.0, 2.0]])


def one(subject, clip, **options):
    points, offsets, _ = clipped_by_convex(
        subject, np.array([0, subject.shape[1]]), clip, np.array([0, clip.shape[1]]), **options
    )
    return points if len(offsets) > 1 else points[:, :0]


def area(points):
    x, y = points[:2] - points[:2, :1]
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2.0)


def wreath(rng, size, *, middle=(0.0, 0.0), radius=1.0, star=False):
    """A convex polygon on a circle, or a star-shaped one."""
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, size))
    reach = radius * (rng.uniform(0.2, 1.0, size) if star else 1.0)
    return np.stack([middle[0] + reach * np.cos(angle), middle[1] + reach * np.sin(angle)])


def batch(polygons):
    return np.concatenate(polygons, axis=1), np.cumsum([0, *(p.shape[1] for p in polygons)])


@pytest.mark.capability("G6.2-clip-convex")
@pytest.mark.parametrize("star", [False, True])
def test_areas_are_those_of_shapely_for_many_pairs_at_once(star):
    rng = np.random.default_rng(3)
    subjects = [wreath(rng, int(rng.integers(3, 9)), star=star) for _ in range(400)]
    clips = [
        wreath(rng, int(rng.integers(3, 12)), middle=rng.uniform(-1, 1, 2), radius=rng.uniform(0.1, 1.5))
        for _ in range(400)
    ]
    clips = [c[:, ::-1] if k % 2 else c for k, c in enumerate(clips)]
    points, offsets, pair = clipped_by_convex(*batch(subjects), *batch(clips))
    assert (np.diff(pair) > 0).all()
    assert np.isfinite(points).all()
    found = np.zeros(400)
    found[pair] = [area(points[:, a:b]) for a, b in pairwise(offsets)]
    polygons = [shapely.Polygon(p.T).buffer(0) for p in subjects], [shapely.Polygon(p.T) for p in clips]
    expected = shapely.area(shapely.intersection(*(np.array(p) for p in polygons)))
    whole = np.array([abs(shapely.Polygon(p.T).area - shapely.Polygon(p.T).buffer(0).area) < 1e-12 for p in subjects])
    assert whole.mean() > 0.5
    assert np.abs(np.abs(found) - expected)[whole].max() < 1e-12
    assert ((expected > 1e-12) == np.isin(np.arange(400), pair))[whole & ((expected == 0) | (expected > 1e-12))].all()


@pytest.mark.capability("G6.2-clip-convex")
def test_a_side_through_corners_cuts_the_square_in_half():
    half = one(SQUARE, np.array([[0.0, 2.0, -1.0], [0.0, 2.0, 3.0]]))
    assert area(half) == pytest.approx(2.0, abs=1e-15)
    half = one(SQUARE, np.array([[-1.0, 3.0, -1.0], [-1.0, 3.0, 3.0]]))
    assert area(half) == pytest.approx(2.0, abs=1e-15)


@pytest.mark.capability("G6.2-clip-convex")
def test_further_rows_are_interpolated_linearly():
    subject = np.concatenate([SQUARE, [3.0 + 2.0 * SQUARE[0] - 5.0 * SQUARE[1]]])
    part = one(subject, np.array([[1.0, 4.0, 0.7], [0.3, 1.0, 5.0]]))
    assert part.shape[1] >= 4
    assert np.abs(part[2] - (3.0 + 2.0 * part[0] - 5.0 * part[1])).max() < 1e-14


@pytest.mark.capability("G6.2-clip-convex")
def test_a_polygon_inside_keeps_every_digit_and_its_first_corner():
    inner = np.array([[0.1, 1.9, 1.0 / 3.0], [0.1, 0.2, 1.7]])
    assert one(inner, SQUARE).tolist() == inner.tolist()
    assert one(SQUARE, SQUARE).tolist() == SQUARE.tolist()


def test_outside_touching_and_empty_polygons_leave_nothing():
    assert one(SQUARE + 5.0, SQUARE).shape == (2, 0)
    assert one(SQUARE + np.array([[2.0], [0.0]]), SQUARE).shape == (2, 0)
    assert one(SQUARE + 2.0, SQUARE).shape == (2, 0)
    assert one(SQUARE, np.array([[0.0, 1.0, 2.0], [0.0, 1.0, 2.0]])).shape == (2, 0)
    assert one(np.zeros((2, 0)), SQUARE).shape == (2, 0)
    points, offsets, pair = clipped_by_convex(np.zeros((3, 0)), np.zeros(1, int), np.zeros((2, 0)), np.zeros(1, int))
    assert (points.shape, offsets.tolist(), pair.tolist()) == ((3, 0), [0], [])


def test_sizes_that_average_to_triangles_are_no_triangles():
    subject, starts = batch([SQUARE[:, :2], SQUARE])
    points, offsets, pair = clipped_by_convex(subject, starts, *batch([SQUARE, SQUARE]))
    assert pair.tolist() == [1]
    assert (offsets.tolist(), points.tolist()) == ([0, 4], SQUARE.tolist())


def test_within_the_tolerance_corners_stay():
    wide = SQUARE * (1.0 + 1e-12) - 0.5e-12
    assert one(wide, SQUARE, tolerance=1e-9).tolist() == wide.tolist()
    assert one(wide, SQUARE).tolist() != wide.tolist()
    assert one(SQUARE + np.array([[2.0 - 1e-12], [0.0]]), SQUARE, tolerance=1e-9).shape == (2, 0)


@pytest.mark.parametrize("tolerance", [0.0, 1e-9])
def test_corners_that_rounding_takes_apart_are_one(tolerance):
    rng = np.random.default_rng(2)
    subjects, clips = [wreath(rng, 6) for _ in range(200)], [wreath(rng, 5, radius=0.9) for _ in range(200)]
    several = [np.repeat(clip, 3, axis=1) + rng.uniform(-2e-16, 2e-16, (2, 15)) for clip in clips]
    several = [clip[:, ::-1] if k % 2 else clip for k, clip in enumerate(several)]
    areas = []
    for some in (clips, several):
        points, offsets, pair = clipped_by_convex(*batch(subjects), *batch(some), tolerance=tolerance)
        areas.append(np.zeros(200))
        areas[-1][pair] = [area(points[:, a:b]) for a, b in pairwise(offsets)]
    assert np.abs(areas[0] - areas[1]).max() < 1e-8
    middles = [clip.mean(axis=1, keepdims=True) for clip in clips]
    small, outside = (
        [middle + part * (clip - middle) for middle, clip in zip(middles, clips, strict=True)] for part in (0.5, 1.01)
    )
    assert inside_convex(*batch(small), *batch(several), tolerance=tolerance).all()
    assert not inside_convex(*batch(outside), *batch(several), tolerance=tolerance).any()


def test_scale_and_offset_change_nothing():
    rng = np.random.default_rng(8)
    subject, clip = wreath(rng, 7), wreath(rng, 6, middle=(0.4, 0.3))
    part = one(subject, clip)
    for scale in (2.0**-20, 2.0**20):
        assert (one(subject * scale, clip * scale) == part * scale).all()
    moved = one(subject + 1e6, clip + 1e6) - 1e6
    assert moved.shape == part.shape
    assert np.abs(moved - part).max() < 1e-8


@pytest.mark.capability("G6.2-clip-convex")
def test_contained_tells_whether_the_whole_polygon_survived():
    rng = np.random.default_rng(5)
    subjects = [wreath(rng, 5, radius=0.3, middle=rng.uniform(-0.8, 0.8, 2), star=True) for _ in range(300)]
    clips = [wreath(rng, 9) for _ in range(300)]
    inside = inside_convex(*batch(subjects), *batch(clips))
    assert 20 < inside.sum() < 280
    polygons = np.array([shapely.Polygon(p.T) for p in clips]), [shapely.MultiPoint(p.T) for p in subjects]
    assert (inside == shapely.covers(*(np.array(p) for p in polygons))).all()
    assert inside_convex(*batch([SQUARE, SQUARE + 1e-6]), *batch([SQUARE, SQUARE])).tolist() == [True, False]
