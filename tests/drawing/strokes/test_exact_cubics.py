"""Splines leave as the Bézier curves that they are, or as few that are near enough."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot.curves import AkimaSpline, BSpline, CubicSpline, PlacedCurve, nurbs_curve, spline_curve
from vectorplot.curves.splines import SplineCurve
from vectorplot.drawing import curved_strokes
from vectorplot.drawing.drawing import CurvedStrokes, Paths
from vectorplot.drawing.finishing import without_collinear_points
from vectorplot.surfaces import PlacedSurface, Sphere, nurbs_surface, spline_surface
from vectorplot.surfaces.splines import line_pieces
from vectorplot.testing.shapes import box

POINTS = np.array([(0, 0, 0), (2, 1, 0), (3, 0, 1), (2, -2, 2), (0, -1, 1), (1, 1, 3)], dtype=float)
SOUTH = vp.Camera((5, -8, 6), target=(1.5, 0, 1), parallel=True)


def drawn(*items: vp.Item, camera: vp.Camera = SOUTH) -> tuple[vp.Drawing, CurvedStrokes]:
    drawing = vp.draw(vp.Scene(items), camera)
    (paths,) = (mark for layer in drawing.layers for mark in layer.strokes if (mark.kind == vp.LineKind.CURVE).any())
    return drawing, curved_strokes(paths, 0.01)


PART = np.linspace(0, 1, 9)
BERNSTEIN = np.stack([(1 - PART) ** 3, 3 * PART * (1 - PART) ** 2, 3 * PART**2 * (1 - PART), PART**3], axis=1)


def homogeneous(drawing: vp.Drawing, points: np.ndarray) -> np.ndarray:
    """(n,1) what the rows of a page of points are divided by."""
    rows = points @ drawing.page_from_world[:, :3].T + drawing.page_from_world[:, 3]
    return rows[:, 3:] if rows.shape[1] == 4 else np.ones((len(rows), 1))


def on_page(drawing: vp.Drawing, points: np.ndarray) -> np.ndarray:
    return (points @ drawing.page_from_world[:, :3].T + drawing.page_from_world[:, 3])[..., :2]


@pytest.mark.capability("G9.1-span")
@pytest.mark.parametrize("placed", [False, True])
@pytest.mark.parametrize("kind", [AkimaSpline(), CubicSpline(), BSpline(4)])
def test_every_piece_is_one_bezier_curve_with_the_images_of_its_control_points(kind, placed):
    curve = spline_curve(POINTS, kind)
    pieces, _ = curve.bezier_pieces()
    matrix, shift = np.array([[0, 2, 0], [-1, 0, 0], [0, 0.5, 1.0]]), np.array([0.5, 1, 0])
    if placed:
        pieces = pieces @ matrix + shift
    drawing, strokes = drawn(vp.Item("A", PlacedCurve(curve, matrix, shift) if placed else curve))
    truth, found = on_page(drawing, pieces), strokes.beziers.control
    if np.abs(found[0, 0] - truth[0, 0]).max() > 1e-3:
        found = found[::-1, ::-1]
    np.testing.assert_allclose(found, truth, atol=1e-5)
    assert strokes.beziers.error.tolist() == [0.0]


@pytest.mark.parametrize(
    "curve",
    [
        spline_curve(POINTS, CubicSpline(closed=True)),
        spline_curve(POINTS, BSpline(3, closed=True)),
        spline_curve(np.repeat(POINTS, [1, 1, 3, 1, 1, 1], axis=0), BSpline(4)),
    ],
)
def test_loops_quadratic_pieces_and_corners_are_exact_too(curve: SplineCurve):
    drawing, strokes = drawn(vp.Item("A", curve))
    pieces = len(curve.breaks) - 1
    assert pieces <= len(strokes.beziers.control) <= pieces + 1  # the pen may begin inside of a piece
    part = np.linspace(0, 1, 9)
    bernstein = np.stack([(1 - part) ** 3, 3 * part * (1 - part) ** 2, 3 * part**2 * (1 - part), part**3], axis=1)
    found = (bernstein @ strokes.beziers.control).reshape(-1, 2)
    dense = on_page(drawing, curve.points(np.linspace(curve.start, curve.end, 20_001)))
    assert shapely.distance(shapely.points(found), shapely.linestrings(dense)).max() < 2e-3


def test_what_is_cut_by_what_hides_it_is_exact():
    """The visible parts of the pieces, split at the very parameters at which they vanish behind a box."""
    curve = spline_curve(POINTS, AkimaSpline())
    post = vp.Item("BOX", box((0.5, -1.5, -1), (1.0, -1.0, 3)))
    _, strokes = drawn(vp.Item("A", curve), post)
    own = strokes.paths.kind == vp.LineKind.CURVE
    assert own.sum() > 1 and (strokes.beziers.error[own] == 0.0).all()
    assert (np.diff(strokes.beziers.offsets)[own] > 0).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("curve", "camera"),
    [
        (spline_curve(POINTS, AkimaSpline()), vp.Camera((5, -8, 6))),
        (spline_curve(POINTS, BSpline(5)), SOUTH),
        (nurbs_curve(POINTS, [1, 2, 1, 1, 3, 1]), SOUTH),
    ],
)
def test_what_is_no_cubic_in_the_image_is_cut_into_cubics_and_served_by_few(curve, camera):
    """Every chord is a cubic but for 0.0001 mm; few serve them all, with true directions where they meet."""
    from scipy.spatial import cKDTree

    drawing, strokes = drawn(vp.Item("A", curve), camera=camera)
    assert np.isfinite(strokes.paths.handles[1:-1]).all() and 0.0 < strokes.beziers.error.max() < 0.01
    t = np.linspace(curve.start, curve.end, 200_001)
    dense = on_page(drawing, curve.points(t))
    dense /= homogeneous(drawing, curve.points(t))
    assert cKDTree(dense).query(BERNSTEIN @ strokes.beziers.control)[0].max() < 0.01
    joints = strokes.beziers.control[1:]
    nearest = cKDTree(dense[1:-1]).query(joints[:, 0])[1] + 1
    way, true = joints[:, 1] - joints[:, 0], dense[nearest + 1] - dense[nearest - 1]
    sine = (
        (way[:, 0] * true[:, 1] - way[:, 1] * true[:, 0]) / np.linalg.norm(way, axis=1) / np.linalg.norm(true, axis=1)
    )
    assert np.abs(sine).max() < 1e-3
    # Chords as of a stroke of which nothing but its directions is known.
    blind = replace(strokes.paths, handles=np.full_like(strokes.paths.handles, np.nan))
    assert len(strokes.beziers.control) <= len(curved_strokes(blind, 0.01).beziers.control)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_where_weights_change_fast_chords_are_cut_more_than_once(seed):
    """Polygons stay exact whatever the weights; others are cubics throughout, though speeds differ by thousands."""
    random = np.random.default_rng(seed)
    points, weights = random.normal(size=(14, 3)), 10 ** random.uniform(-3, 3, 14)
    _, polygon = drawn(vp.Item("A", nurbs_curve(points, weights, order=2)))
    assert polygon.beziers.error.max() < 1e-4 and len(polygon.beziers.control) == 13
    _, curve = drawn(vp.Item("A", nurbs_curve(points, weights, order=4)))
    assert np.isfinite(curve.paths.handles[1:-1]).all()


@pytest.mark.slow
@pytest.mark.capability("G9.2-surface")
@pytest.mark.parametrize("count", [12, 40])
def test_pieces_between_many_knots_are_joined_where_fewer_serve(count):
    x, y = np.meshgrid(np.linspace(-3, 3, count), np.linspace(-3, 3, count), indexing="ij")
    grid = np.stack([x, y, 0.6 * np.sin(1.3 * x) * np.cos(1.1 * y)], axis=-1)
    surface = spline_surface(grid, CubicSpline(), CubicSpline())
    item = vp.Item("A", surface, curves=vp.SurfaceLines(4, 4), lines=("parameter",))
    drawing = vp.draw(vp.Scene((item,)), SOUTH, page=vp.Page(180, 180, 5))
    (paths,) = (mark for layer in drawing.layers for mark in layer.strokes if len(mark))
    few, exact = curved_strokes(paths, 0.02).beziers, curved_strokes(paths, 1e-6).beziers
    assert 0.0 < few.error.max() < 0.0181 and not exact.error.any()
    assert len(few.control) < 0.5 * len(exact.control) and len(few.control) < 6 * len(paths)
    part = np.linspace(0, 1, 400)
    bernstein = np.stack([(1 - part) ** 3, 3 * part * (1 - part) ** 2, 3 * part**2 * (1 - part), part**3], axis=1)
    from scipy.spatial import cKDTree

    dense = (bernstein @ exact.control).reshape(-1, 2)
    assert cKDTree(dense).query((BERNSTEIN @ few.control).reshape(-1, 2))[0].max() < 0.02


@pytest.mark.slow
@pytest.mark.capability("G9.2-surface")
def test_parameter_lines_and_borders_of_spline_surfaces_are_exact_where_they_are_visible():
    """Lines that pass behind their own surface: all that is visible is on the true lines."""
    from scipy.spatial import cKDTree

    turn, height = np.meshgrid(np.arange(6) * np.pi / 3, np.array([0.0, 1, 2, 3, 4]), indexing="ij")
    out = 1 + 0.5 * np.sin(2 * height + turn)
    grid = np.stack([out * np.cos(turn), out * np.sin(turn), height], axis=-1)
    surface = spline_surface(grid, CubicSpline(closed=True), BSpline(4))
    drawing = vp.draw(vp.Scene((vp.Item("A", surface, curves=vp.SurfaceLines(5, 4)),)), SOUTH, page=vp.Page(90, 90, 5))
    part = np.linspace(0, 1, 9)
    bernstein = np.stack([(1 - part) ** 3, 3 * part * (1 - part) ** 2, 3 * part**2 * (1 - part), part**3], axis=1)
    found = []
    for paths in (mark for layer in drawing.layers for mark in layer.strokes):
        own = np.isin(paths.kind, (vp.LineKind.PARAMETER, vp.LineKind.BOUNDARY))
        if own.any():
            # So near that no others serve.
            curves = curved_strokes(paths, 1e-6)
            assert (curves.beziers.error[own] == 0.0).all()
            control = curves.beziers.control[np.repeat(own, np.diff(curves.beziers.offsets))]
            found.append((bernstein @ control).reshape(-1, 2))
    assert len(found) > 1
    d, many = surface.domain, np.linspace(0.0, 1.0, 20_001)
    u = d.u_start + d.size[0] * np.concatenate([np.repeat(np.arange(6) / 5, len(many)), np.tile(many, 5)])
    v = d.v_start + d.size[1] * np.concatenate([np.tile(many, 6), np.repeat(np.arange(5) / 4, len(many))])
    dense = on_page(drawing, surface.points(u, v))
    nearest = cKDTree(dense).query(np.concatenate(found))[0]
    # Half the distance of dense points, a tenth of what fitted lines are off.
    steps = np.linalg.norm(np.diff(dense.reshape(11, -1, 2), axis=1), axis=2)
    assert nearest.max() < 0.5 * steps.max() + 1e-5


def test_lines_along_which_weights_change_are_fitted():
    grid = [[(x, y, x * y - x * x) for y in range(4)] for x in range(4)]
    weights = np.repeat([[1.0], [2.0], [1.0], [3.0]], 4, axis=1)
    pieces = line_pieces(PlacedSurface(nurbs_surface(grid, weights), np.eye(3), np.zeros(3)))
    assert pieces.degrees == (3, 3) and pieces.weighted is not None and pieces.breaks[0].tolist() == [0.0, 1.0]
    assert line_pieces(Sphere()).degrees == (0, 0)


def test_points_of_known_cubics_stay_though_they_lie_on_a_straight_line():
    """The handles beside a point belong to the chords that end there; a straight stroke needs none."""
    points = np.array([(0, 0), (1, 0), (2, 0), (2, 5)], dtype=float)
    numbers, solid = np.zeros(2, dtype=np.intp), np.pad(np.concatenate([points, points[:3]]), ((0, 0), (0, 1)))
    paths = Paths(solid[:, :2], np.array([0, 4, 7]), np.zeros(2, dtype=np.bool_), numbers, numbers, numbers, solid)
    known = replace(paths, handles=np.ones((7, 2)), directions=np.zeros((7, 2)))
    assert np.diff(without_collinear_points(paths, 0.01).offsets).tolist() == [3, 2]
    assert np.diff(without_collinear_points(known, 0.01).offsets).tolist() == [4, 2]
