"""Sight lines against a sphere."""

from __future__ import annotations

import numpy as np
from support.smooth_parts import ball_from_above

from vectorplot.geometry.budget import USUAL
from vectorplot.visibility.smooth.rays import Samples, counts_in_front
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.targets import targets_of


def test_points_behind_inside_in_front_and_beside() -> None:
    view, sheet, radius = ball_from_above()
    sheets = Sheets((sheet,))
    points = radius * np.array([[0.3, 0.2, -2.0], [0.3, 0.2, 0.0], [0.3, 0.2, 2.0], [1.2, 0.0, -2.0]])
    none, nowhere = np.full(4, -1), np.full((4, 3), np.nan)
    no = np.zeros(4, dtype=np.bool_)
    samples = Samples(points, none, nowhere, none, nowhere, no, no)
    assert counts_in_front(view, sheets, targets_of(view, sheets), samples, USUAL.pairs)[0].table(len(samples), 1)[
        :, 0
    ].tolist() == [
        2,
        1,
        0,
        0,
    ]


def test_a_sphere_hides_its_own_lower_half() -> None:
    view, sheet, _ = ball_from_above()
    sheets = Sheets((sheet,))
    latitude = np.radians([-80.0, -30.0, -2.0, 2.0, 30.0, 80.0])
    places = np.stack([np.full(6, 0.7), latitude, np.zeros(6)], axis=1)
    points, none, no = sheet.points(places), np.full(6, -1), np.zeros(6, dtype=np.bool_)
    samples = Samples(points, np.zeros(6, np.intp), places, none, np.full((6, 3), np.nan), no, no)
    found = counts_in_front(view, sheets, targets_of(view, sheets), samples, USUAL.pairs)[0].table(len(samples), 1)[
        :, 0
    ]
    assert np.array_equal(found > 0, points[:, 2] < 0.0)
