"""Tessellations of parametrised surfaces."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.surfaces.families.minimal import minimal_spiral_surface
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.visibility.smooth.sheets.parametric_sheet import parametric_sheet


@pytest.mark.parametrize("growth", [0.5, 2.0, 4.0])
def test_no_triangle_is_farther_off_its_surface_than_it_and_its_neighbours_are_large(growth: float) -> None:
    """Else each of the small ones is near everything."""
    surface = minimal_spiral_surface(growth)
    u, v = np.meshgrid(*surface.domain.grid(32, 32))
    size = np.abs(surface.points(u, v)).max()
    sheet = parametric_sheet(PlacedSurface(surface, np.eye(3) / size, np.zeros(3)), 0, True)
    corners = sheet.vertices[sheet.corners]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    assert (sheet.sags <= 100.0 * sides).all()
    assert sheet.sags.max() > 1e-4
