"""What parametrised sheets know at their borders."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.features.holes import just_inside
from vectorplot.surfaces.function_surface import FunctionSurface, surface_of_function
from vectorplot.surfaces.surface import Domain
from vectorplot.visibility.smooth.sheets import ParametricSheet, parametric_sheets

SQUARE = Domain(-1.0, 1.0, -1.0, 1.0)
SHARE = np.array([-0.7, 0.1, 0.6])


def sheared(radius: float = 0.0) -> FunctionSurface:
    """A surface on which parameter lines are far from crossing at right angles, with a round hole in its domain."""

    def points(u, v):
        hole = np.where(np.hypot(u - 0.1, v + 0.2) < radius, np.nan, 0.0)
        return u + 0.8 * v, v + hole, 1.5 * u * u + u - 2.0 * v

    return surface_of_function(points, SQUARE)


def sheet_of(surface: FunctionSurface) -> ParametricSheet:
    with np.errstate(invalid="ignore"):
        return parametric_sheets([surface], [0], [True])[0]


def at(u: object, v: object) -> np.ndarray:
    return np.stack(np.broadcast_arrays(u, v, 0.0), axis=1)


def assert_at_right_angles(inner: np.ndarray, border: np.ndarray, digits: float) -> None:
    size = np.linalg.norm(inner, axis=1) * np.linalg.norm(border, axis=1)
    assert (np.abs((inner * border).sum(axis=1)) < digits * size).all()


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("end", [-1.0, 1.0])
def test_the_way_in_is_at_right_angles_to_the_border(axis: int, end: float) -> None:
    """So that it tells on which side of the border any direction on the sheet leads."""
    sheet = sheet_of(sheared())
    places = at(end, SHARE) if axis == 0 else at(SHARE, end)
    inner, along = sheet.inwards(places), sheet.partials(places)
    assert_at_right_angles(inner, along[1 - axis], 1e-12)
    assert_at_right_angles(inner, sheet.normals(places), 1e-12)
    assert ((inner * along[axis]).sum(axis=1) * end < 0.0).all()


def test_between_both_borders_in_a_corner_and_nowhere_inside() -> None:
    sheet = sheet_of(sheared())
    corner = at([1.0], [-1.0])
    along_u, along_v = sheet.partials(corner)
    assert np.allclose(sheet.inwards(corner), along_v - along_u)
    assert not sheet.inwards(at(SHARE, 0.3)).any()


def test_at_right_angles_to_the_rim_of_a_hole() -> None:
    surface = sheared(0.5)
    sheet = sheet_of(surface)
    angle = np.linspace(0.0, 6.0, 40)
    out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    places = at(*just_inside(surface, (0.1, -0.2) + 0.5 * (1.0 + 1e-12) * out, out).T)
    inner, (along_u, along_v) = sheet.inwards(places), sheet.partials(places)
    rim = -out[:, 1:] * along_u + out[:, :1] * along_v
    assert_at_right_angles(inner, rim, 1e-3)
    assert ((inner * (out[:, :1] * along_u + out[:, 1:] * along_v)).sum(axis=1) > 0.0).all()


@pytest.mark.slow
def test_a_rim_with_a_vertical_tangent_is_left_straight_up() -> None:
    surface = surface_of_function(lambda u, v: (u, v, np.sqrt(0.6 - u * u - 2.0 * v * v)), SQUARE)
    sheet = sheet_of(surface)
    angle = np.linspace(0.0, 6.0, 40)
    out = np.sqrt(0.6) * np.stack([np.cos(angle), np.sin(angle) / np.sqrt(2.0)], axis=1)
    with np.errstate(invalid="ignore"):
        inner = sheet.inwards(at(*just_inside(surface, out * (1.0 - 1e-12), -out).T))
    assert (inner[:, 2] > 0.99 * np.linalg.norm(inner, axis=1)).all()
