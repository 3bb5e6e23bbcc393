"""Sheets asked at once say what each of them says alone; curves of one sort are of one family."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.rotations import rotation_x
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.scene.view import View, look
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cylinder, Paraboloid
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.visibility.smooth.sheets import Sheet, Sheets
from vectorplot.words import DRAWN, LineKind

SHAPES = (
    *(Torus(1.0, 0.3), Cylinder(0.4, 0.0, 1.0, (2.0, 0.0, 0.0)), Torus(0.8, 0.2, (0.9, 0.0, 0.1))),
    *(Paraboloid(1.0, 0.5, 1.0, (0.0, 2.0, 0.0)), ImplicitTorus(0.7, 0.2, (0.0, -2.0, 0.0)), Cylinder(0.2, -1.0, 1.0)),
)


def scene() -> tuple[Scene, View]:
    turned = PlacedSurface(Torus(0.5, 0.2), rotation_x(40.0), (-1.5, 0.5, 0.0))
    items = [Item(str(k), shape, curves=SurfaceLines(3, 2)) for k, shape in enumerate((*SHAPES, turned))]
    made = Scene(tuple(items))
    return made, look(made, Camera((6.0, -7.0, 5.0)))


def test_sheets_at_once_say_what_each_says_alone() -> None:
    _, view = scene()
    sheets = Sheets(scene_sheets(scene()[0], view))
    rng = np.random.default_rng(2)
    number = rng.permutation(np.repeat(np.arange(-1, len(sheets)), 12))
    places = np.zeros((len(number), 3))
    for one, sheet in enumerate(sheets):
        own = number == one
        places[own] = sheet.vertex_places[rng.integers(0, len(sheet.vertex_places), own.sum())]
    other, ways = places + rng.normal(size=places.shape) * 0.01, rng.normal(size=places.shape)
    points = rng.normal(size=places.shape)
    said = {
        "points": sheets.points(number, places),
        "normals": sheets.normals(number, places),
        "bends": sheets.bends(number, places, ways),
        "inwards": sheets.inwards(number, places),
        "apart": sheets.apart(number, places, other),
        "on_sheet": sheets.on_sheet(number, other),
        "missed": sheets.missed(number, points, ways, places)[0],
    }
    for one, sheet in enumerate(sheets):
        own = number == one
        alone = {
            "points": sheet.points(places[own]),
            "normals": sheet.normals(places[own]),
            "bends": sheet.bends(places[own], ways[own]),
            "inwards": sheet.inwards(places[own]),
            "apart": sheet.apart(places[own], other[own]),
            "on_sheet": sheet.on_sheet(other[own]),
            "missed": sheet.missed(points[own], ways[own], places[own])[0],
        }
        for name, values in alone.items():
            assert np.allclose(said[name][own], values, rtol=1e-9, atol=1e-9, equal_nan=True), name
    assert np.isnan(said["points"][number < 0]).all() and not said["on_sheet"][number < 0].any()


def test_steps_on_sheets_at_once_are_those_on_each_alone() -> None:
    made, view = scene()
    sheets = Sheets(scene_sheets(made, view))
    places = np.stack([sheet.vertex_places[137] for sheet in sheets])
    steps = np.full((len(sheets), 3), 0.01)
    moved = sheets.moved(np.arange(len(sheets)), places, steps)
    for number, sheet in enumerate(sheets):
        alone = _moved(sheet, places[number], steps[number])
        assert np.allclose(moved[number, :2], alone[:2], rtol=1e-9)


def _moved(sheet: Sheet, place: np.ndarray, step: np.ndarray) -> np.ndarray:
    return sheet.moved(place[None], step[None])[0]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["curves", "edges"])
def test_curves_of_merged_families_run_through_their_points(kind: str) -> None:
    made, view = scene()
    traced = traced_scene(made, view, scene_sheets(made, view), frozenset(map(LineKind.from_word, DRAWN)), 1e-4)
    curves = getattr(traced, kind)
    assert len(curves.families) < len(curves)
    chord = curves.chords
    for part, point in ((0.0, chord), (1.0, chord + 1)):
        found = curves.at(chord, np.full(len(chord), part))
        assert np.abs(found.points - curves.points[point]).max() < 1e-9
    own = curves.sheet[curves.owner]
    on = np.flatnonzero(own >= 0)
    assert np.abs(traced.sheets.points(own[on], curves.places[on]) - curves.points[on]).max() < 1e-9
