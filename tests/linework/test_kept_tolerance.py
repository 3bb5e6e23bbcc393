"""Strokes as they are written keep the tolerance: they lie near those of a hundredth of it."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
import shapely
from support.svg_strokes import strokes_by_layer

import vectorplot as vp
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus

TURN, TOLERANCE_MM = 2 * np.pi, 0.02


def shell(u, v):
    grown = np.exp(0.2 * u)
    return grown * (1 + np.cos(v) / 2) * np.cos(u), grown * (1 + np.cos(v) / 2) * np.sin(u), grown * (np.sin(v) / 2 - 1)


SHAPES = {
    "torus": Torus(2.0, 1.0),
    "wave": surface_of_function(lambda u, v: (u, v, np.sin(3 * u) * np.cos(2 * v) / 2), Domain(-2, 2, -2, 2)),
    "saddle": surface_of_function(lambda u, v: (u, v, u**3 - 3 * u * v**2), Domain(-1, 1, -1, 1)),
    "shell": surface_of_function(shell, Domain(-6, 6, 0, TURN, closed_v=True)),
}


def strokes(path, shape, tolerance_mm, curves):
    scene = vp.Scene((vp.Item("IT", shape, curves=SurfaceLines(columns=6, rows=6)),))
    drawing = vp.draw(scene, vp.Camera(eye=(9, -14, 8)), tolerance_mm=tolerance_mm, curves=curves)
    vp.save(drawing, path)
    return [line for own in strokes_by_layer(ElementTree.parse(path).getroot()).values() for line in own]


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("name", list(SHAPES))
def test_strokes_are_within_the_tolerance_of_their_curves(name, tmp_path):
    true = strokes(tmp_path / "true.svg", SHAPES[name], TOLERANCE_MM / 100, "bezier")
    chords = shapely.STRtree(shapely.linestrings(np.concatenate([np.stack([p[:-1], p[1:]], axis=1) for p in true])))
    for curves in ("bezier", "polyline"):
        for line in strokes(tmp_path / "found.svg", SHAPES[name], TOLERANCE_MM, curves):
            points = np.concatenate([line[:-1], (line[:-1] + line[1:]) / 2])
            _, off = chords.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
            assert off.max() <= TOLERANCE_MM
