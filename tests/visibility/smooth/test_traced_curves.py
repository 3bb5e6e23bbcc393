"""Curves between the points at which they are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from support.smooth_parts import polylines

from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.surface import Domain
from vectorplot.visibility.smooth.curve_families import ParameterCurves
from vectorplot.visibility.smooth.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.traced_curves import at_once


def test_over_a_hole_between_two_of_its_points_a_curve_is_its_chord() -> None:
    torn = graph(lambda x, y: np.sqrt(x * x - 0.3) + 0.2 * y * y, Domain(-2.0, 2.0, -2.0, 2.0))
    view = look(Scene((Item("torn", torn),)), Camera((5.0, -7.0, 9.0)))
    with np.errstate(invalid="ignore"):
        (sheet, *_) = sheets_of_parametrised(view, torn, 0, True)
        places = np.array([[-1.0, 0.5, 0.0], [1.0, 0.5, 0.0]])
        line = replace(polylines(sheet.points(places)), places=places, families=(ParameterCurves(sheet, 0),))
        part = np.array([0.0, 0.1, 0.5, 0.6, 1.0])
        found = line.at(np.zeros(5, dtype=np.intp), part)
    start, end = line.points
    over = np.array([False, False, True, True, False])
    assert np.allclose(found.points[over], start + part[over, None] * (end - start), atol=1e-15)
    assert (found.slopes[over] == end - start).all()
    assert np.allclose(found.points[~over], sheet.points(found.places[~over]), atol=1e-15)
    assert np.linalg.norm(found.points[1] - start - part[1] * (end - start)) > 1e-2


def test_curves_asked_at_once_say_what_each_says_alone() -> None:
    hill = graph(lambda x, y: np.sin(x) * y, Domain(-2.0, 2.0, -2.0, 2.0))
    view = look(Scene((Item("hill", hill),)), Camera((5.0, -7.0, 9.0)))
    (sheet, *_) = sheets_of_parametrised(view, hill, 0, True)
    places = np.array([[-1.0, 0.5, 0.0], [0.0, 0.7, 0.0], [1.0, 0.5, 0.0]])
    straight = polylines(sheet.points(places))
    bent = replace(straight, places=places, families=(ParameterCurves(sheet, 0),))
    asked = [
        (straight, np.array([1, 0]), np.array([0.3, 0.8])),
        (bent, np.array([0]), np.array([0.4])),
        (bent, np.zeros(0, dtype=np.intp), np.zeros(0)),
        (straight, np.array([1]), np.array([1.2])),
    ]
    for (curves, chord, part), found in zip(asked, at_once(asked), strict=True):
        alone = curves.at(chord, part)
        assert np.array_equal(found.points, alone.points) and np.array_equal(found.slopes, alone.slopes)
