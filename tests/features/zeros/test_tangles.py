"""Curves that wind more finely than any cell: what is resolved is kept, the rest is told, and nodes are no tangles."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.features.zero_curves import zero_manifold_of_f_uv
from vectorplot.surfaces.surface import Domain

SQUARE = Domain(-2.0, 2.0, -2.0, 2.0)


def test_waves_ever_finer_are_kept_where_cells_tell_them_apart() -> None:
    def waves(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.sin(1.0 / np.hypot(u - 0.3, v + 0.4))

    found = zero_manifold_of_f_uv(waves, SQUARE, columns=64, rows=64)
    told = [text for text in found.doubts if text.startswith("curves that wind more finely than the resolution")]
    assert len(told) == 1 and told[0].endswith("% of the domain")
    radius = np.hypot(found.points[:, 0] - 0.3, found.points[:, 1] + 0.4)
    # Circles of radius 1 / (k pi), each all round; and none of those in the middle of the tangle.
    k = 1.0 / (np.pi * radius)
    assert np.abs(k - np.round(k)).max() < 1e-6
    assert {1, 2, 3, 4, 5} <= set(np.round(k).astype(int).tolist())
    assert radius.min() > 0.01


@pytest.mark.parametrize("order", [2, 3, 5, 7])
@pytest.mark.parametrize("place", [(0.0, 0.0), (0.123, -0.456)])
def test_saddles_of_any_order_are_no_tangles(order: int, place: tuple[float, float]) -> None:
    def saddle(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        return np.asarray(((u - place[0] + 1j * (v - place[1])) ** order).imag)

    found = zero_manifold_of_f_uv(saddle, SQUARE, columns=32, rows=32)
    assert not any("more finely" in text for text in found.doubts)


@pytest.mark.slow
@pytest.mark.parametrize("power", [2, 4, 6])
def test_lines_that_are_only_touched_are_no_tangles(power: int) -> None:
    found = zero_manifold_of_f_uv(lambda u, v: (u - 0.3 * v - 0.1) ** power, SQUARE, columns=32, rows=32)
    assert not any("more finely" in text for text in found.doubts)
