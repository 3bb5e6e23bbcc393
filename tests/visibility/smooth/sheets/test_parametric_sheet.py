"""Tessellations of parametrised surfaces."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.minimal import minimal_spiral_surface
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus
from vectorplot.visibility.smooth.sheets import parametric_sheets


@pytest.mark.parametrize("growth", [0.5, 2.0, 4.0])
def test_no_triangle_is_farther_off_its_surface_than_it_and_its_neighbours_are_large(growth: float) -> None:
    """Else each of the small ones is near everything."""
    surface = minimal_spiral_surface(growth)
    u, v = np.meshgrid(*surface.domain.grid(32, 32))
    size = np.abs(surface.points(u, v)).max()
    sheet = parametric_sheets([PlacedSurface(surface, np.eye(3) / size, np.zeros(3))], [0], [True])[0]
    corners = sheet.vertices[sheet.corners]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    assert (sheet.deviations <= 100.0 * sides).all()
    assert sheet.deviations.max() > 1e-4


@pytest.mark.slow
def test_sheets_made_together_are_those_made_alone() -> None:
    """Tori of which some take finer grids, surfaces of functions, one with a hole and one that jumps."""
    rng = np.random.default_rng(3)
    square = Domain(-1.0, 1.0, -1.0, 1.0)
    with np.errstate(all="ignore"):
        shapes = [Torus(1.0, rng.uniform(0.1, 0.5)) for _ in range(6)]
        shapes += [surface_of_function(lambda u, v: (u, v, np.sin(9.0 * u) * v), square)]
        shapes += [surface_of_function(lambda u, v: (u, v, np.sqrt(1.2 - u * u - v * v)), square)]
        shapes += [surface_of_function(lambda u, v: (u, v, np.where(u > 0.3, 1.0, 0.0) + 0.1 * v), square)]
        sizes = [0.02, 0.5, 0.02, 0.5, 0.02, 0.02, 1.0, 1.0, 1.0]
        placed = [PlacedSurface(s, k * np.eye(3), rng.normal(size=3)) for s, k in zip(shapes, sizes, strict=True)]
        made = parametric_sheets(placed, range(9), [True] * 9)
        for number, (surface, sheet) in enumerate(zip(placed, made, strict=True)):
            alone = parametric_sheets([surface], [number], [True])[0]
            assert sheet.item == number
            assert (sheet.holed, sheet.jumps) == (alone.holed, alone.jumps) == (number == 7, number == 8)
            assert np.array_equal(sheet.corners, alone.corners)
            for own, other in ((sheet.vertices, alone.vertices), (sheet.vertex_places, alone.vertex_places)):
                assert np.allclose(own, other, rtol=0.0, atol=1e-12, equal_nan=True)
            assert np.allclose(sheet.deviations, alone.deviations, rtol=1e-9)
    assert len(made[1].corners) > len(made[0].corners)
    # What is the same for all of them is in memory once.
    assert made[0].corners is made[2].corners and np.shares_memory(made[0].vertex_places, made[2].vertex_places)
