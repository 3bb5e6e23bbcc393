"""Transparent polygons as sparse lines."""

from __future__ import annotations

import numpy as np

from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.effects.windows import screened

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])


def squares(*opacity: float) -> Fills:
    points = np.concatenate([SQUARE + np.array([20.0 * k, 0.0]) for k in range(len(opacity))])
    colours = np.array([[10 + k, 0, 0] for k in range(len(opacity))], dtype=np.uint8)
    return Fills.flat(points, np.arange(0, len(points) + 1, 4), colours, opacity=list(opacity))


def test_opaque_polygons_stay_and_clear_ones_become_lines() -> None:
    found = screened(squares(1.0, 0.5, 0.25, 0.0), 0.5, np.eye(4))
    sizes = np.diff(found.offsets)
    assert sizes[0] == 4 and (sizes[1:] == 2).all()
    assert (found.opacity == 1.0).all() and (found.kind[1:] == FillKind.GLASS).all()
    colour = found.colours[found.offsets[:-1], 0]
    half, quarter, none = ((colour == 10 + k).sum() for k in (1, 2, 3))
    assert none == 0 and 1.7 < half / quarter < 2.3
    length = np.hypot(*(found.points[found.offsets[1:] - 1] - found.points[found.offsets[:-1]]).T)
    # Lines of the pen's width cover as much as the opacity says.
    assert abs(0.5 * length[colour == 11].sum() - 50.0) < 5.0
    assert np.allclose(found.points3d[:, :2], found.points)


def test_without_glass_nothing_changes() -> None:
    fills = squares(1.0, 1.0)
    assert len(screened(fills, 0.3, np.eye(4))) == 2
