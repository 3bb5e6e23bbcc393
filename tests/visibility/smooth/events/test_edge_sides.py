"""To which side of its contour a sphere lies."""

from __future__ import annotations

import numpy as np
from support.smooth_parts import ball_from_above

from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.visibility.smooth.traced_curves import covered_sides
from vectorplot.words import LineKind


def test_a_sphere_lies_inside_of_its_equator() -> None:
    view, sheet, _ = ball_from_above()
    u = np.linspace(0.0, 6.0, 5)
    places = np.stack([u, np.zeros(5), np.zeros(5)], axis=1)
    points = sheet.points(places)
    # Against the clock the inside is to the left.
    way = np.stack([-points[:, 1], points[:, 0], np.zeros(5)], axis=1)
    kind, number = np.full(5, int(LineKind.CONTOUR)), np.zeros(5, dtype=np.intp)
    assert covered_sides(view, Sheets((sheet,)), number, kind, points, places, way).tolist() == [1] * 5
    assert covered_sides(view, Sheets((sheet,)), number, kind, points, places, -way).tolist() == [-1] * 5
