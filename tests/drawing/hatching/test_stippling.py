"""Stippling: as many dots as asked, as dense as it is dark, apart from each other, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

import vectorplot as vp
from vectorplot.drawing import Fills, hatched_fills
from vectorplot.drawing.hatching import nearest_dots

FLAT = np.eye(4)
RING = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) * 20.0


def squares(*shades: float) -> Fills:
    points = np.concatenate([RING + np.array([25.0 * k, 0.0]) for k in range(len(shades))])
    colours = np.rint(255.0 * np.repeat(np.array(shades)[:, None], 3, axis=1)).astype(np.uint8)
    return Fills.flat(points, 4 * np.arange(len(shades) + 1), colours, item=0)


def dots_of(paths: vp.Paths) -> np.ndarray:
    return paths.points.reshape(-1, 2, 2).mean(axis=1)


@pytest.mark.slow
def test_squares_have_dots_by_their_darkness_and_white_ones_none() -> None:
    dots = dots_of(hatched_fills(squares(0.0, 0.5, 0.75, 1.0), [vp.Stippling(2000)], FLAT))
    square, x = np.divmod(dots[:, 0], 25.0)
    assert len(dots) == 2000 and x.max() < 20.0 and dots[:, 1].min() > 0.0 and dots[:, 1].max() < 20.0
    share = np.bincount(square.astype(int), minlength=4) / len(dots)
    dark = np.array([1.0, 1.0 - 128 / 255, 1.0 - 191 / 255, 0.0])
    assert share == pytest.approx(dark / dark.sum(), abs=0.01)


def test_dots_keep_apart_as_evenly_as_a_draughtsman_sets_them() -> None:
    dots = dots_of(hatched_fills(squares(0.2), [vp.Stippling(1000, "even")], FLAT))
    inner = dots[(np.abs(dots - 10.0) < 8.0).all(axis=1)]
    apart = cKDTree(dots).query(inner, k=2)[0][:, 1]
    # Of a hexagonal lattice this is 1.07, of random places 0.5.
    even = np.sqrt(400.0 / 1000.0)
    assert apart.mean() > 0.85 * even and apart.min() > 0.5 * even


@pytest.mark.slow
def test_dots_are_the_same_in_every_run_and_none_is_made_of_nothing() -> None:
    one, other = (hatched_fills(squares(0.3, 0.9), [vp.Stippling(300)], FLAT).points for _ in range(2))
    assert np.array_equal(one, other)
    for fills in (Fills.empty(), squares(1.0)):
        assert len(hatched_fills(fills, [vp.Stippling(100)], FLAT)) == 0


@pytest.mark.parametrize(
    "wrong", [{"dots": 0}, {"dots": 2_000_000}, {"dots": 5, "by": "none"}, {"dots": 5, "width_mm": 0}]
)
def test_impossible_stipplings_are_refused(wrong: dict) -> None:
    with pytest.raises(vp.InputError, match="stippling"):
        vp.Stippling(**wrong)


@pytest.mark.parametrize("count", [1, 2, 5, 40, 300])
def test_the_nearest_dots_are_the_nearest_whatever_was_guessed(count: int) -> None:
    """Dots in heaps, some in one place, and places next to any of them: distances are the smallest ones of all."""
    random = np.random.default_rng(count)
    dots = random.normal(size=(count, 2)) ** 3
    dots[: count // 4] = dots[0]
    places = random.normal(size=(400, 2)) ** 3
    far = np.hypot(*(places[:, None] - dots).transpose(2, 0, 1))
    for guess in (random.integers(0, count, len(places)), far.argmin(axis=1)):
        near = nearest_dots(places, dots, guess)
        assert np.allclose(far[np.arange(len(places)), near], far.min(axis=1), rtol=1e-12, atol=0.0)
