"""Lines through a sphere."""

from __future__ import annotations

import numpy as np
from support.smooth_parts import ball_from_above, polylines

from vectorplot.geometry.budget import USUAL
from vectorplot.visibility.smooth.events.piercings import piercings
from vectorplot.visibility.smooth.sheets.sheets import Sheets
from vectorplot.visibility.smooth.targets import targets_of


def test_a_line_through_a_sphere_goes_in_behind_one_sheet_and_out_behind_none() -> None:
    view, sheet, radius = ball_from_above()
    sheets = Sheets((sheet,))
    above, beside = [(-2.0, 0.1, 0.6), (2.0, 0.1, 0.6)], [(-2.0, 1.1, 0.0), (2.0, 1.1, 0.0)]
    lines = polylines(*(radius * np.array(line) for line in (above, beside)))
    found = piercings(view, sheets, targets_of(view, sheets), lines, np.zeros(1, dtype=np.bool_), USUAL.pairs)[0]
    order = np.argsort(found.part)
    half = np.sqrt(1.0 - 0.1**2 - 0.6**2)
    assert np.allclose(found.part[order], [0.5 - half / 4.0, 0.5 + half / 4.0], atol=1e-12)
    assert found.chord.tolist() == [0, 0] and found.change[order].tolist() == [1, -1]


def test_a_line_that_touches_does_not_pierce() -> None:
    view, sheet, radius = ball_from_above()
    sheets = Sheets((sheet,))
    line = polylines(radius * np.array([(-2.0, 0.0, 1.0), (2.0, 0.0, 1.0)]))
    assert not piercings(view, sheets, targets_of(view, sheets), line, np.zeros(1, dtype=np.bool_), USUAL.pairs)[
        0
    ].change.any()
