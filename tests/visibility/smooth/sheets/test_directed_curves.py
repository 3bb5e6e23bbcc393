"""Curves that are known by points and by their directions there."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.surfaces import Domain, Sphere, surface_of_function
from vectorplot.visibility.smooth.curve_families import Chords, DirectedCurves
from vectorplot.visibility.smooth.sheets import parametric_sheets


def chords(places: Floats, directions: Floats) -> Chords:
    """The chords of a polyline."""
    at, to = (np.insert(each, 2, 0.0, axis=1) for each in (places, directions))
    return Chords((at[:-1], at[1:]), (at[:-1], at[1:]), (to[:-1], to[1:]), np.zeros(len(at) - 1))


def test_circles_in_the_plane_are_followed_to_the_fourth_power_of_their_chords() -> None:
    plane = surface_of_function(lambda u, v: (u, v, 0.0 * u), Domain(-2.0, 2.0, -2.0, 2.0))
    family = DirectedCurves(parametric_sheets([plane], [0], [False])[0], 0)
    off = []
    for count in (12, 24):
        t = np.linspace(0.0, 2.0 * np.pi, count + 1)
        turn = np.column_stack([-np.sin(t), np.cos(t)])
        found = family.between(chords(np.column_stack([np.cos(t), np.sin(t)]), turn), np.full(count, 0.5))
        off.append(np.abs(np.linalg.norm(found.points, axis=1) - 1.0).max())
        # What is known in the middle leads on in the same way.
        assert np.allclose(np.cross(found.slopes, found.second_places), 0.0, atol=1e-12)
    assert off[0] < 1e-3 and off[1] < off[0] / 14.0


def test_directions_at_the_ends_are_those_known_and_chords_without_them_straight_in_the_parameters() -> None:
    family = DirectedCurves(parametric_sheets([Sphere()], [0], [False])[0], 0)
    places = np.array([[0.0, 0.0], [0.2, 0.1], [0.3, 0.3], [0.4, 0.4], [0.5, 0.4]])
    known = np.array([[2.0, 1.4], [1.0, 1.0], [np.nan, np.nan], [-1.0, 0.0], [1.0, 0.0]])
    own = chords(places, known)
    for part in (0.0, 1.0):
        found = family.between(own, np.full(4, part))
        wanted = known[0] if part == 0.0 else known[1]
        along_u, along_v = Sphere().partials(*places[int(part)][:, None])
        aim = wanted[0] * along_u[0] + wanted[1] * along_v[0]
        assert np.allclose(np.cross(found.slopes[0], aim), 0.0, atol=1e-12)
        assert np.allclose(found.places[:, :2], places[int(part) :][:4])
    middle = family.between(own, np.full(4, 0.5))
    assert np.allclose(middle.places[1:, :2], 0.5 * (places[1:-1] + places[2:]))
    assert not np.isfinite(middle.second_places[1:, :2]).any() and np.isfinite(middle.second_places[0]).all()
