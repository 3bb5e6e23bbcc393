from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from vectorplot.backends.svg import SHADE_ERROR, stops_of, strips_of


def worst_error(corners, colours) -> tuple[float, int]:
    """How far the colours of strips are from the linear ones, at their corners and between them, and their number."""
    found = strips_of(corners, colours)
    part, stops, gradient = stops_of(found.colours)
    owner = np.repeat(np.arange(len(found.triangle)), np.diff(found.offsets))
    worst = 0.0
    middles = np.add.reduceat(found.microns, found.offsets[:-1]) / np.diff(found.offsets)[:, None]
    for places, strip in ((found.microns, owner), (middles, np.arange(len(found.triangle)))):
        triangle = found.triangle[strip]
        slopes = np.linalg.solve(np.diff(corners, axis=1), np.diff(colours, axis=1))
        exact = colours[triangle, 0] + np.einsum("pi,pij->pj", places - corners[triangle, 0], slopes[triangle])
        start, way = found.ends[strip, 0], found.ends[strip, 1] - found.ends[strip, 0]
        share = np.clip(((places - start) * way).sum(axis=1) / (way * way).sum(axis=1), 0, 1)[:, None]
        # What readers show between stops, of all gradients one after the other.
        shown = np.stack(
            [np.interp(2 * strip + share[:, 0], 2 * gradient + part, column) for column in stops.T], axis=1
        )
        worst = max(worst, float(np.abs(shown - exact).max()))
    return worst, len(found.triangle)


def areas(microns, offsets):
    x, y = microns.T.astype(float)
    start = np.repeat(offsets[:-1], np.diff(offsets))
    after = np.arange(1, len(x) + 1)
    after[offsets[1:] - 1] = offsets[:-1]
    x, y = x - x[start], y - y[start]
    return np.add.reduceat(x * y[after] - y * x[after], offsets[:-1]) / 2


@pytest.mark.slow
@example(685)
@given(st.integers(0, 10_000))
def test_strips_cover_their_triangle_in_its_colours(seed):
    rng = np.random.default_rng(seed)
    corners = np.rint(rng.uniform(0, 200_000, (6, 3, 2)))
    colours = rng.integers(0, 256, (6, 3, 3)).astype(float)
    worst, count = worst_error(corners, colours)
    assert worst <= SHADE_ERROR + 1.0  # and the rounding of colours and corners
    assert count <= 6 * 120
    found = strips_of(corners, colours)
    covered = np.bincount(found.triangle, areas(found.microns, found.offsets), minlength=6)
    whole = areas(corners.reshape(-1, 2), np.arange(0, 19, 3))
    assert np.allclose(covered, np.abs(whole), rtol=1e-3, atol=2e6)


def test_shades_of_one_palette_need_one_strip():
    rng = np.random.default_rng(2)
    corners = np.rint(rng.uniform(0, 200_000, (50, 3, 2)))
    lower, upper = np.array((0.0, 63, 115)), np.array((178.0, 178, 255))
    colours = np.rint(lower + rng.uniform(0, 1, (50, 3, 1)) * (upper - lower))
    worst, count = worst_error(corners, colours)
    # One may need two where its colours are so near one another that their rounding counts.
    assert count <= 52 and worst <= SHADE_ERROR + 1.0


@pytest.mark.parametrize("thin", [1, 3, 50])
def test_slivers_have_few_strips(thin):
    corners = np.array([[(0, 0), (150_000, thin), (70_000, 0)]], dtype=float)
    colours = np.array([[(255, 0, 0), (0, 255, 0), (0, 0, 255)]], dtype=float)
    assert len(strips_of(corners, colours).triangle) <= 150


@pytest.mark.parametrize("far", [1e7, 1e8, 1e9])
def test_slivers_too_thin_for_a_slope_across_keep_their_ends(far):
    corners = np.array([[(0, 0), (far, far - 1), (far / 2, far / 2)], [(0, 0), (far, 0), (far, 1)]])
    colours = np.array([[(200, 0, 0), (0, 0, 100), (100, 0, 50)], [(200, 0, 0), (0, 0, 100), (0, 9, 100)]], dtype=float)
    found = strips_of(corners, colours)
    assert set(found.triangle.tolist()) <= {0, 1} and len(found.triangle) < 20
    for ends, shown in zip(found.ends, found.colours, strict=True):
        # Which end comes first is open.
        first, last = shown if ends[0].sum() < ends[1].sum() else shown[::-1]
        if np.abs(ends[1] - ends[0]).max() > far / 2:
            assert (
                np.abs(first - np.array((200.0, 0, 0))).max() <= 12
                and np.abs(last - np.array((0.0, 0, 100))).max() <= 12
            )


def test_gradients_that_lead_beyond_the_colours_there_are_bend_where_they_end():
    colours = np.array(
        [[(-50, 100, 305), (150, 100, 205)], [(10, 20, 30), (40, 50, 60)], [(0.4, 0, -0.4), (255, 1, 2)]]
    )
    part, stops, gradient = stops_of(colours)
    assert gradient.tolist() == [0] * 4 + [1, 1, 2, 2] and part.tolist() == [0.0, 0.25, 0.5, 1.0] + [0.0, 1.0] * 2
    assert stops[:4].tolist() == [[0, 100, 255], [0, 100, 255], [50, 100, 255], [150, 100, 205]]
    assert stops[4:].tolist() == [[10, 20, 30], [40, 50, 60], [0, 0, 0], [255, 1, 2]]
    assert len(stops_of(np.zeros((0, 2, 3)))[0]) == 0


def test_nothing_is_no_strips():
    found = strips_of(np.zeros((0, 3, 2)), np.zeros((0, 3, 3)))
    assert len(found.triangle) == 0 and found.offsets.tolist() == [0] and found.ends.shape == (0, 2, 2)
