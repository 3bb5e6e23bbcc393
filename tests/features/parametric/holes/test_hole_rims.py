"""Rims of holes: where a surface ends inside its domain."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import surfaces
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.edge_splitting import Within
from vectorplot.features.hole_rims import cut_at_holes, hole_rims
from vectorplot.features.holes import beside_rim_chords, into_surface, is_known
from vectorplot.features.parameter_curves import borders, domain_borders, u_lines, v_lines
from vectorplot.features.tessellation import facets
from vectorplot.testing.curves import curves_in_space


def dome(size: float = 1.0, away: float = 0.0):
    """Half a ball as a graph, in the middle of a square."""
    return surfaces.graph(
        lambda x, y: np.sqrt(size * size - (x - away) ** 2 - y * y),
        surfaces.Domain(away - 1.5 * size, away + 1.5 * size, -1.4 * size, 1.5 * size),
    )


@pytest.mark.hard(69)
@pytest.mark.parametrize(("size", "away"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e3)])
def test_a_dome_ends_in_a_circle(size, away):
    rims = hole_rims(dome(size, away), Tracing(tolerance=1e-3 * size))
    assert rims.closed.tolist() == [True] and not rims.doubts
    radius = np.hypot(rims.u - away, rims.v) / size
    assert radius.min() > 1.0 - 1e-8 and radius.max() <= 1.0 + 1e-9
    corners = np.stack([rims.u, rims.v], axis=1)
    middle = np.hypot(*(0.5 * (corners + np.roll(corners, 1, axis=0)) - (away, 0.0)).T) / size
    assert (1.0 - middle).max() < 1.1e-3
    # The hole is to the right: the rim runs round the dome as it is seen from above.
    turn = np.unwrap(np.arctan2(rims.v, rims.u - away))
    assert turn[-1] > turn[0] + 6.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("function", "rims"),
    [
        (lambda x, y: 1.0 / (x * x + y * y), [True]),
        (lambda x, y: np.log(x) + y * y, [False]),
        (lambda x, y: np.sqrt(x) + y, [False]),
        (lambda x, y: np.tan(2.0 * x) + y, [False, False, False, False]),
        (lambda x, y: np.sqrt(x * x + y * y - 0.5), [True]),
        (lambda x, y: x + y, []),
        (lambda x, y: np.sqrt(-x * x), []),
    ],
)
def test_every_hole_has_a_rim_on_the_border_of_what_is_known(function, rims):
    surface = surfaces.graph(function, surfaces.Domain(-1.5, 1.5, -1.0, 1.0))
    found = hole_rims(surface, Tracing())
    assert found.closed.tolist() == rims
    places = np.stack([found.u, found.v], axis=1)
    assert np.isfinite(found.points).all() and is_known(surface, places).all()
    inwards = into_surface(surface, places)
    inside = (np.abs(places) < (1.499, 0.999)).all(axis=1)
    assert inwards[inside].any(axis=1).all()
    assert not is_known(surface, places[inside] - 1e-2 * inwards[inside] / 1e-6).all() if rims else True
    assert len(borders(surface)) >= len(rims)


def test_triangles_are_cut_where_the_hole_begins():
    surface = surfaces.graph(lambda x, y: np.where(x < 0.25, x, np.nan), surfaces.Domain(0.0, 1.0, 0.0, 1.0))
    places = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    cut = cut_at_holes(surface, places, triangles, is_known(surface, places))
    a, b, c = cut.places[cut.triangles].transpose(1, 0, 2)
    area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert (area > 0.0).all() and np.isclose(area.sum(), 0.25)
    assert len(cut.rims) == 2 and np.allclose(cut.places[cut.rims][..., 0], 0.25) and cut.of.tolist() == [0, 1, 1]


@pytest.mark.slow
def test_the_facets_of_a_dome_follow_its_rim():
    found = facets(dome(), Within(lambda points: np.full(points.shape[:-1], 5e-3)))
    points, triangles = found.mesh.vertices, found.mesh.corners.reshape(-1, 3)
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    border = points[
        [side for side, uses in zip(*np.unique(sides, axis=0, return_counts=True), strict=True) if uses == 1]
    ]
    assert found.complete and border[..., 2].max() < 1e-3
    assert np.hypot(*border.mean(axis=1)[:, :2].T).min() > 1.0 - 5e-3


@pytest.mark.slow
def test_a_dome_hides_the_half_of_its_rim_behind_it():
    eye = (7.0, -4.0, 3.0)
    item = vp.Item("DOME", dome())
    drawing = vp.draw(vp.Scene((item,)), vp.Camera(eye, (0.0, 0.0, 0.0)), lines=("contour", "boundary"))
    towards = np.array(eye[:2]) / np.hypot(*eye[:2])
    seen = np.concatenate([curve[:, :2] @ towards for curve in curves_in_space(drawing, kind="boundary")])
    edge = 1.0 / np.hypot(*eye[:2])
    assert seen.min() > edge - 0.02 and seen.max() > 0.999
    around = np.concatenate(list(curves_in_space(drawing, kind="boundary")))
    assert np.ptp(np.arctan2(around[:, :2] @ (-towards[1], towards[0]), around[:, :2] @ towards)) > 2.8


@pytest.mark.parametrize("count", [1, 40, 2000])
def test_rims_are_found_in_few_steps_whatever_the_number_of_chords(count):
    asked = []

    def height(x, y):
        asked.append(np.size(x))
        return np.sqrt(1.0 - x * x - y * y)

    surface = surfaces.graph(height, surfaces.Domain(-1.2, 1.2, -1.3, 1.2))
    angle = np.linspace(0.0, 6.0, count)
    start, end = (np.stack([np.cos(a), np.sin(a)], axis=1) for a in (angle, angle + 0.2))
    asked.clear()
    places, on = beside_rim_chords(surface, start, end, np.linspace(0.1, 0.9, count))
    off = 1.0 - np.hypot(*places.T)
    assert on.all() and off.min() > 0.0 and off.max() < 1e-8
    few = count < 100
    assert len(asked) < (20 if few else 50) and sum(asked) < 400 * max(count, 10)


def power(x, y):
    with np.errstate(all="ignore"):
        return x**y


@pytest.mark.parametrize(
    "height", [power, lambda x, y: power(y, x), lambda x, y: power(x + 0.1, y)], ids=["x^y", "y^x", "(x+0.1)^y"]
)
def test_lines_with_no_surface_on_either_side_are_no_borders(height):
    surface = surfaces.graph(height, surfaces.Domain(-2, 2, -2, 2))
    tracing = Tracing(columns=12, rows=12, tolerance=1e-2)
    lines = [domain_borders(surface, tracing), u_lines(surface, [1.0]), v_lines(surface, [-1.0, 0.0, 1.0])]
    angle = 2.0 * np.pi * (np.arange(64) + 0.5) / 64
    for curves in (hole_rims(surface, tracing), *lines):
        u, v = curves.u[:, None] + 1e-5 * np.cos(angle), curves.v[:, None] + 1e-5 * np.sin(angle)
        inside = (np.abs(u) <= 2.0) & (np.abs(v) <= 2.0)
        assert (np.isfinite(surface.points(u, v)).all(axis=2) & inside).any(axis=1).all()
