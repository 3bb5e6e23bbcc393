"""Surfaces that are known to meet themselves nowhere: the search for double curves agrees."""

from __future__ import annotations

from unittest import mock

import numpy as np
import pytest

from vectorplot.features import intersections as self_intersection
from vectorplot.features.intersections import self_intersections
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Sphere,
)
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.surfaces.tori import Torus
from vectorplot.surfaces.trimmed import TrimmedSurface, is_embedded

FAR = np.array([[0.0, 2.0, 0.1], [-1.0, 0.3, 0.0], [0.2, 0.0, 1.5]])

EMBEDDED: tuple[Surface, ...] = (
    *(Torus(3.0, 1.0), Cylinder(), Cone(), Sphere(), Ellipsoid((1.0, 2.0, 0.5)), Hyperboloid(), HyperboloidSheet()),
    *(Paraboloid(), HyperbolicParaboloid(), PlacedSurface(Torus(3.0, 1.0), FAR, (5.0, 0.0, 1.0))),
    *(TrimmedSurface(Torus(3.0, 1.0), u=(0.0, 5.0)), InvertedSurface(Torus(3.0, 1.0), (0.0, 0.0, 0.0), 2.0)),
)


@pytest.mark.parametrize("surface", EMBEDDED, ids=lambda s: type(s).__name__)
def test_what_is_known_to_be_embedded_has_no_double_curve(surface: Surface) -> None:
    assert is_embedded(surface)
    found = self_intersections(surface)
    assert len(found) == 0
    assert not found.doubts


@pytest.mark.parametrize("surface", [Torus(1.0, 1.0), Torus(1.0, 2.0), Cone(bottom=-1.0, top=1.0)], ids=repr)
def test_what_meets_itself_is_not_embedded(surface: Surface) -> None:
    assert not is_embedded(surface)
    assert not is_embedded(PlacedSurface(surface, np.eye(3)))


def test_a_sheet_over_a_plane_is_not_searched_and_a_rolled_one_is() -> None:
    """A wave seen askew stands over a plane; a sheet rolled up twice faces all ways and meets itself."""
    wave = surface_of_function(lambda u, v: (u, v + 0.2 * u, 0.3 * np.sin(3.0 * u)), Domain(-1.0, 1.0, -1.0, 1.0))
    rolled = surface_of_function(
        lambda u, v: ((2.0 + np.cos(2.0 * u)) * np.cos(u), (2.0 + np.cos(2.0 * u)) * np.sin(u), v),
        Domain(0.3, 9.5, -1.0, 1.0),
    )
    nothing = mock.Mock(side_effect=AssertionError("searched"))
    with mock.patch.object(self_intersection, "overlapping_within", nothing):
        assert len(self_intersections(PlacedSurface(wave, FAR))) == 0
        with pytest.raises(AssertionError, match="searched"):
            self_intersections(rolled)


def test_a_spiral_ramp_all_of_which_faces_upwards_is_searched() -> None:
    """Two turns of a flat spiral: the normals all point upwards, and the border crosses itself from above."""
    ramp = surface_of_function(lambda u, v: (u * np.cos(v), u * np.sin(v), 0.02 * v), Domain(1.0, 2.0, 0.0, 12.0))
    nothing = mock.Mock(side_effect=AssertionError("searched"))
    with mock.patch.object(self_intersection, "overlapping_within", nothing):
        with pytest.raises(AssertionError, match="searched"):
            self_intersections(ramp)
