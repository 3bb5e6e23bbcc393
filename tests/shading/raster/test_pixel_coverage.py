"""Triangles with a common edge fill every pixel once; the exact rule against plain integer arithmetic."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.shading import pixel_coverage
from vectorplot.shading.pixel_coverage import SUBPIXELS

SIDE = 64


def times_covered(points, corners, columns, rows):
    """(rows, columns) how many triangles cover each pixel, small ones by boxes and the others by tiles."""
    grid = pixel_coverage.snap(np.asarray(points, dtype=np.float64))
    x, y = pixel_coverage.corner_grid(grid, np.asarray(corners))
    box, triangles = pixel_coverage.boxes(x, y, columns, rows), pixel_coverage.turned_right(x, y)
    stride, padded = (-(-side // SIDE) * SIDE for side in (columns, rows))
    pixels = [np.zeros(0, dtype=np.intp)]
    kept = (box.left < box.right) & (box.top < box.bottom) & (triangles.area > 0)
    for found in pixel_coverage.small_fragments(triangles, box, np.flatnonzero(kept & box.small), stride):
        pixels.append(found.pixel)
    large = np.flatnonzero(kept & ~box.small)
    index, column, row = pixel_coverage.tile_pairs(box, large, SIDE)
    met = pixel_coverage.may_cover(triangles, index, column * SIDE, row * SIDE, SIDE)
    index, left, top = index[met], column[met] * SIDE, row[met] * SIDE
    for begin in range(0, len(index), 50):
        part = slice(begin, begin + 50)
        found = pixel_coverage.covered(triangles, index[part], left[part], top[part], (SIDE, SIDE), stride, np.int64)
        pixels.append(found.pixel)
    count = np.bincount(np.concatenate(pixels), minlength=stride * padded)
    return count.reshape(padded, stride)[:rows, :columns]


def jittered_net(across, down, width, height, seed):
    """Points and triangles that cover a rectangle of pixels, with a random diagonal in every cell."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(-3.0, width + 3.0, across + 1), np.linspace(-3.0, height + 3.0, down + 1))
    step = np.array([(width + 6.0) / across, (height + 6.0) / down])
    move = rng.uniform(-0.15, 0.15, (down + 1, across + 1, 2)) * step
    move[[0, -1]] = 0.0
    move[:, [0, -1]] = 0.0
    points = (np.stack([x, y], axis=-1) + move).reshape(-1, 2)
    # Cells stay convex. Every third point lies on a pixel centre: the tie-breaking rule has to decide.
    points[::3] = np.rint(points[::3])
    at = np.arange((down + 1) * (across + 1)).reshape(down + 1, across + 1)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]))
    flip = rng.random(len(a)) < 0.5
    one = np.where(flip[:, None], np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    two = np.where(flip[:, None], np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    turned = rng.random(2 * len(a)) < 0.5
    corners = np.concatenate([one, two])
    corners[turned] = corners[turned][:, ::-1]
    return points, corners


@pytest.mark.slow
@pytest.mark.capability("G4.6-fill")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize(("across", "down"), [(300, 225), (60, 40), (7, 5), (2, 1)])
def test_triangles_with_common_edges_fill_every_pixel_once(across, down):
    for seed in range(2):
        points, corners = jittered_net(across, down, 1600, 1200, seed)
        count = times_covered(points, corners, 1600, 1200)
        assert (count == 1).all(), f"{(count == 0).sum()} missed, {(count > 1).sum()} doubled"


def test_a_fan_around_a_pixel_centre_gives_it_to_one_triangle():
    for sides in range(3, 30):
        angle = 2.0 * np.pi * np.arange(sides) / sides
        points = np.concatenate([[(20.0, 20.0)], 20.0 + 15.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)])
        rim = np.arange(1, sides + 1)
        corners = np.stack([np.zeros(sides, dtype=np.intp), rim, np.roll(rim, -1)], axis=1)
        count = times_covered(points, corners, 41, 41)
        assert count.max() == 1
        assert count[20, 20] == 1


def plainly_covered(triangle, columns, rows):
    """(rows, columns) by Python's integers: inside, or on a left or a top edge."""
    (ax, ay), (bx, by), (cx, cy) = (tuple(round(v * SUBPIXELS) for v in corner) for corner in triangle)
    if (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) < 0:
        (bx, by), (cx, cy) = (cx, cy), (bx, by)
    found = np.zeros((rows, columns), dtype=bool)
    for row in range(rows):
        for column in range(columns):
            x, y, inside = column * SUBPIXELS, row * SUBPIXELS, True
            for px, py, qx, qy in ((ax, ay, bx, by), (bx, by, cx, cy), (cx, cy, ax, ay)):
                side = (qx - px) * (y - py) - (qy - py) * (x - px)
                # Corners run clockwise on the screen: a left edge runs up, a top edge to the right.
                owns = qy < py or (qy == py and qx > px)
                inside = inside and (side > 0 or (side == 0 and owns))
            found[row, column] = inside
    return found


def test_coverage_is_that_of_plain_integer_arithmetic():
    rng = np.random.default_rng(3)
    for number in range(120):
        triangle = rng.uniform(-4.0, 20.0, (3, 2))
        if number % 2:
            triangle = np.rint(triangle * 2.0) / 2.0
        count = times_covered(triangle, [[0, 1, 2]], 16, 16)
        assert (count == plainly_covered(triangle, 16, 16)).all(), triangle


def test_triangles_far_larger_than_the_raster_cover_all_of_it_once():
    far = pixel_coverage.GUARD_BAND
    points = [(-far, -far), (far, -far), (far, far), (-far, far)]
    assert (times_covered(points, [[0, 1, 2], [0, 2, 3]], 200, 100) == 1).all()


def test_a_triangle_without_area_covers_nothing():
    assert not times_covered([(1.0, 1.0), (5.0, 5.0), (9.0, 9.0)], [[0, 1, 2]], 10, 10).any()
