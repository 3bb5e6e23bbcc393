"""How far sight lines pass from edges."""

from __future__ import annotations

import numpy as np
import pytest
from support.smooth_parts import ball_from_above, polylines

from vectorplot.tolerances import SAFE_IN_IMAGE
from vectorplot.visibility.smooth.hidden_curves import BEYOND, clearances, clearances_before
from vectorplot.words import LineKind

TOLERANCE = 1e-5
VIEW = ball_from_above()[0]
ORIGIN = np.zeros((1, 3))


def edge(y: float, z: float) -> list[tuple[float, float, float]]:
    return [(-0.3, y, z), (0.2, y, z)]


def clearance(*lines: list[tuple[float, float, float]], kind: LineKind) -> float:
    return float(clearances(VIEW, polylines(*lines, kind=kind), ORIGIN, TOLERANCE)[0])


def test_a_border_on_which_a_point_lies_is_no_edge_for_it() -> None:
    assert clearance(edge(0.0, 0.0), kind=LineKind.BOUNDARY) == pytest.approx(BEYOND * SAFE_IN_IMAGE)


@pytest.mark.parametrize("height", [0.1, -0.1])
def test_a_border_elsewhere_on_the_sight_line_is(height: float) -> None:
    assert clearance(edge(0.0, height), kind=LineKind.BOUNDARY) < TOLERANCE


def test_beside_its_own_border_a_point_has_others() -> None:
    beside = 0.5 * SAFE_IN_IMAGE
    assert clearance(edge(0.0, 0.0), edge(beside, 0.1), kind=LineKind.BOUNDARY) == pytest.approx(beside)


def test_a_fold_on_which_a_point_lies_is_an_edge() -> None:
    assert clearance(edge(0.0, 0.0), kind=LineKind.CONTOUR) < TOLERANCE
    assert clearance(edge(0.4, 0.0), kind=LineKind.CONTOUR) == pytest.approx(0.4)


def test_edges_behind_a_point_do_not_change_what_is_in_front_of_it() -> None:
    for kind in (LineKind.BOUNDARY, LineKind.CONTOUR, LineKind.CREASE):
        found = [
            float(clearances_before(VIEW, polylines(edge(0.0, height), kind=kind), ORIGIN, TOLERANCE)[0])
            for height in (0.1, -0.1)
        ]
        assert found[0] < TOLERANCE and found[1] == pytest.approx(BEYOND * SAFE_IN_IMAGE)
