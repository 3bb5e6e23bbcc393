"""Curves on surfaces that end inside their domains come to the rims there, in one piece."""

import numpy as np
import pytest

from vectorplot.features.contours_and_isophotes import isophotes, parallel_contour, plane_sections
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.surface import Domain

DOME = graph(lambda x, y: np.sqrt(1.0 - x * x - y * y), Domain(-1.2, 1.2, -1.2, 1.2))
"""Half a sphere, with a vertical tangent at its rim."""


@pytest.mark.parametrize(
    ("curves", "count"),
    [
        (lambda: parallel_contour(DOME, (1.0, 0.3, 0.2)), 1),
        (lambda: isophotes(DOME, (1.0, 0.0, 0.5), [0.2, 0.6]), 2),
        (lambda: plane_sections(DOME, (1.0, 0.2, 0.0), [0.0, 0.3, 0.9]), 3),
    ],
    ids=["contour", "isophotes", "sections"],
)
def test_curves_of_a_dome_end_at_its_rim(curves, count):
    found = curves()
    ends = np.concatenate([found.offsets[:-1], found.offsets[1:] - 1])
    assert len(found) == count and not found.closed.any()
    assert np.abs(found.points[ends, 2]).max() < 1e-3
