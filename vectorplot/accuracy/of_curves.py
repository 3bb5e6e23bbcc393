"""Approximations of curves, measured: arcs by cubics, chords, contours, integral curves, splines, zero curves."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way, decades, farthest, on_page, page_from_world
from vectorplot.arrays import Floats
from vectorplot.curves.arcs import EllipseArc, arc_path
from vectorplot.curves.bezier import BezierPath, bezier_points, flattened
from vectorplot.curves.bezier_fit import fitted_curve
from vectorplot.curves.curve import Curve
from vectorplot.curves.families import Loxodrome
from vectorplot.curves.placed_curves import curve_of_function
from vectorplot.curves.splines import (
    AkimaSpline,
    CubicSpline,
    InterpolatingSpline,
    SplineCurve,
    SplineKind,
    spline_curve,
)
from vectorplot.drawing.drawing import CurvedStrokes, Drawing
from vectorplot.features.conditions import Isophote
from vectorplot.features.contours_and_isophotes import contour
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.grid_triangulation import triangulate_surface
from vectorplot.features.scalar_fields import cubic_parabola, zero_of_cubic_parabola
from vectorplot.features.surface_integration import USUAL, Accuracy, integral_curves
from vectorplot.features.tangent_fields import loxodromes
from vectorplot.features.zero_curves import ZeroManifold, zero_manifold_of_f_uv
from vectorplot.geometry.budget import budget_of
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.chord_refinement import Traces, refined, straight_between
from vectorplot.geometry.elementary import arctanh, tan
from vectorplot.geometry.vectors import norm
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.curves import hausdorff
from vectorplot.textbook.field_steps import euler_curves, runge_kutta_curves
from vectorplot.tolerances import (
    FINEST_ARC_MM,
    FINEST_FIT_MM,
    FINEST_OF_EXTENT,
    FINEST_STROKE_MM,
    PART_OF_FINEST,
    TRUE_CONTOUR,
    TRUE_ISOPHOTE_MM,
)

# Arcs of ellipses as cubic segments.

RADIUS_MM = 75.0
"""Of the circle: half the width of a drawing."""

SAMPLES = 1024
"""Points on each segment whose distances are taken."""


def _study() -> Study:
    circle = EllipseArc(np.zeros(2), np.array([RADIUS_MM, 0.0]), np.array([0.0, RADIUS_MM]))

    def error(path: BezierPath) -> float:
        points = bezier_points(path.control[:, None], np.linspace(0.0, 1.0, SAMPLES))
        return float(np.abs(np.hypot(points[..., 0], points[..., 1]) - RADIUS_MM).max())

    ways = (Way("cubic segments", lambda tolerance: arc_path(circle, tolerance=tolerance), 1.0),)
    return Study(ways, error, lambda path: len(path.control), exact=None)


ARC_FIT = Approximation(
    name="arc-fit",
    title="Circles as Bézier paths",
    about="A circle of 75 mm, as formats without arcs have it: cubic segments of equal angles, as few as the tolerance "
    "allows. The error is the largest distance from the circle; it falls with the sixth power of their number.",
    knob="tolerance in mm",
    values=decades(-2, -5, 4),
    limits=(FINEST_ARC_MM, 10.0),
    unit="mm",
    counts="segments",
    study=_study,
)


# Polylines through parametrised curves, their chords within a tolerance.

FIRST, MOST = 64, float(1 << 20)
"""Chords to begin with, and points there may be."""


def chords_of(curve: Curve, tolerance: float) -> Floats:
    """(n,3) points of a curve, from its start to its end, their chords within a tolerance of it."""
    t = np.linspace(curve.start, curve.end, FIRST + 1)[:, None]
    last = np.arange(FIRST + 1) == FIRST
    found = refined(Traces(t, last), straight_between, lambda at: curve.points(at[:, 0]), tolerance, MOST)
    return curve.points(found.lines.points[:, 0])


# Bézier paths for curves: a rosette on the page, as chords and as cubic segments.

CHORDS_MM = PART_OF_FINEST * FINEST_FIT_MM
"""The chords that errors are measured by are so near to their curves."""


def rosette(t: Floats) -> Floats:
    """A closed curve in the plane with five loops, some 150 mm wide."""
    return np.stack([50.0 * np.cos(t) + 25.0 * np.cos(4.0 * t), 50.0 * np.sin(t) - 25.0 * np.sin(4.0 * t), 0.0 * t], -1)


def _study_of_bezier_fit() -> Study:
    curve = curve_of_function(rosette, 0.0, 2.0 * np.pi, closed=True)
    truth = chords_of(curve, CHORDS_MM)

    def polyline(found: Floats | BezierPath) -> Floats:
        return found.flattened(CHORDS_MM) if isinstance(found, BezierPath) else found

    def error(found: Floats | BezierPath) -> float:
        return hausdorff(polyline(found), truth, accuracy=CHORDS_MM)

    def count(found: Floats | BezierPath) -> int:
        return len(found.control) if isinstance(found, BezierPath) else len(found) - 1

    ways = (
        Way("chords", lambda tolerance: chords_of(curve, tolerance), 1.0),
        Way("Béziers", lambda tolerance: fitted_curve(curve, tolerance=tolerance), 1.0),
    )
    return Study(ways, error, count)


BEZIER_FIT = Approximation(
    name="bezier-fit",
    title="Bézier paths through curves",
    about="A rosette 150 mm wide as chords, and as cubic Bézier segments. The error is the Hausdorff distance of path "
    "and curve. Halving the tolerance takes 1.4 times as many chords, but only 1.1 times as many segments.",
    knob="tolerance in mm",
    values=decades(0, -3, 4),
    limits=(FINEST_FIT_MM, 10.0),
    unit="mm",
    counts="pieces",
    study=_study_of_bezier_fit,
)


# Drawn curves: the contour of a torus as it leaves the verb draw.

TORUS, CAMERA = Torus(3.0, 1.2), Camera(eye=(7.0, -5.0, 14.0))

DRAWN_CHORDS_MM = PART_OF_FINEST * FINEST_STROKE_MM
"""The chords that errors are measured by are so near to their curves."""


def _study_of_drawn_curves() -> Study:
    scene = Scene((Item("torus", TORUS),))
    true = contour(TORUS, CAMERA.eye, tracing=Tracing(tolerance=TRUE_CONTOUR))
    lines = [true[k] for k in range(len(true))]

    def made(tolerance: float) -> Drawing:
        return draw(scene, CAMERA, lines="contour", hidden="solid", tolerance_mm=tolerance, jobs=1)

    def error(drawing: Drawing) -> float:
        truth = [on_page(drawing.page_from_world, line) for line in lines]
        return hausdorff(polylines(drawing), truth, accuracy=DRAWN_CHORDS_MM)

    def count(drawing: Drawing) -> int:
        return sum(len(mark.beziers.control) for mark in curved(drawing))

    return Study((Way("strokes", made, 1.0),), error, count)


def curved(drawing: Drawing) -> list[CurvedStrokes]:
    """The strokes of a drawing that are drawn as curves."""
    return [mark for layer in drawing.layers for mark in layer.marks if isinstance(mark, CurvedStrokes)]


def polylines(drawing: Drawing) -> list[Floats]:
    """The curved strokes of a drawing as polylines that are as good as they."""
    found = []
    for mark in curved(drawing):
        points, offsets = flattened(mark.beziers.control, mark.beziers.offsets, DRAWN_CHORDS_MM)
        found += [part for part in np.split(points, offsets[1:-1]) if len(part)]
    return found


DRAWN_CURVES = Approximation(
    name="drawn-curves",
    title="Strokes of smooth curves",
    about="The contour of a torus as draw writes it, hidden parts with it: traced, refined to chords, fitted with "
    "cubic segments. The error is the Hausdorff distance of strokes and true contour on the page.",
    knob="tolerance in mm",
    values=decades(-1, -3, 5),
    limits=(FINEST_STROKE_MM, 10.0),
    unit="mm",
    counts="segments",
    study=_study_of_drawn_curves,
)


# Integral curves: a loxodrome of the sphere by equal steps, and by steps that keep an accuracy.

SPHERE, COURSE = Sphere(RADIUS_MM), np.radians(80.0)
"""And the angle of the curve with the meridians."""

LATITUDE = np.radians(-60.0)
"""Of its end; it starts at the equator, and has been round once then."""

LENGTH_MM = RADIUS_MM * -LATITUDE / np.cos(COURSE)

START, FIELD = np.zeros((1, 2)), loxodromes(np.pi + COURSE)

CHORDS = Tracing(tolerance=RADIUS_MM)
"""Points of the curve are not asked for, but for its end."""

WORDS = "A loxodrome on a sphere of 75 mm, from the equator once round to 60 degrees of latitude. "


def loxodrome_end() -> Floats:
    """(3,) where the loxodrome ends, in closed form.

    Source: Glaeser, section 8.1, equation 5.
    """
    longitude = arctanh(np.sin(-LATITUDE)) * tan(COURSE)
    return np.asarray(Loxodrome(RADIUS_MM, COURSE, 0.0, float(longitude)).points(longitude))


def _error(truth: Floats, found: Floats) -> float:
    return float(norm(found[-1] - truth))


def adaptive(accuracy: Accuracy) -> Floats:
    """(n,3) points of the loxodrome as the package integrates it."""
    options = {"length": LENGTH_MM, "both_ways": False, "tracing": CHORDS}
    return integral_curves(SPHERE, FIELD, START, accuracy=accuracy, **options).points


def _stepped(step: float, method: Callable[..., Floats]) -> Floats:
    at = method(SPHERE, FIELD, START, LENGTH_MM, int(np.ceil(LENGTH_MM / step)))[0]
    return SPHERE.points(*at.T)


def _study_of_steps() -> Study:
    ways = (
        Way("Euler", partial(_stepped, method=euler_curves), 1.0),
        Way("Runge and Kutta", partial(_stepped, method=runge_kutta_curves), 4.0),
    )
    return Study(ways, partial(_error, loxodrome_end()), len, exact=partial(adaptive, USUAL))


def _study_of_accuracy() -> Study:
    # Errors are estimated for the step of order 4, and that of order 5 is taken: hence the power 5/4.
    way = Way("Dormand and Prince", lambda error: adaptive(Accuracy(error)), 1.25)
    return Study((way,), partial(_error, loxodrome_end()), len)


FIELD_STEPS = Approximation(
    name="field-steps",
    title="Integral curves by equal steps",
    about=WORDS + "Equal steps are what the book takes. The error is how far its end is from the true one. Exact: the "
    "package, whose steps are as long as their errors allow.",
    knob="step in mm",
    values=(30.0, 15.0, 7.5, 3.75),
    limits=(0.1, 50.0),
    unit="mm",
    counts="points",
    study=_study_of_steps,
)

INTEGRAL_CURVES = Approximation(
    name="integral-curves",
    title="Integral curves by steps of their own",
    about=WORDS + "The package takes steps as long as their estimated errors may add up to a part of the extent. The "
    "error is how far its end is from the true one.",
    knob="accuracy, as part of the extent",
    values=decades(-8, -12, 5),
    limits=(FINEST_OF_EXTENT, 0.1),
    unit="mm",
    counts="points",
    study=_study_of_accuracy,
)


# Splines through points of a curve: the rosette on the page, cut open, by every kind that runs through points.

SPLINE_START, END = 0.2, 4.9
"""Where the rosette is cut: it bends at both ends, and its two gaps differ."""

SPLINE_SAMPLES = 8192
"""Places along the curve at which the distance is taken: 32 between two of the most points."""

Kinds = Callable[[Floats], SplineKind]
"""Takes the parameters of points to a kind of spline over them."""


def _study_of_spline_fit() -> Study:
    curve = curve_of_function(rosette, SPLINE_START, END)
    places = np.linspace(SPLINE_START, END, SPLINE_SAMPLES)
    truth, ends = rosette(places), curve.tangents(np.array([SPLINE_START, END]))

    def through(count: float, kind: Kinds) -> SplineCurve:
        t = np.linspace(SPLINE_START, END, int(count))
        return spline_curve(rosette(t), kind(t))

    def error(found: SplineCurve) -> float:
        return float(np.linalg.norm(found.points(places) - truth, axis=1).max())

    def clamped(t: Floats) -> CubicSpline:
        return CubicSpline(parameters=t, tangents=tuple(ends))

    # At even steps Akima's tangents are right to the second power of the step, and a piece feels them once more.
    # The natural cubic does not bend at its ends, where curves do.
    kinds: tuple[tuple[str, Kinds, float], ...] = (
        ("natural cubic", lambda t: CubicSpline(parameters=t), -2.0),
        ("Akima", lambda t: AkimaSpline(parameters=t), -3.0),
        ("clamped cubic", clamped, -4.0),
        ("of order 4", lambda t: InterpolatingSpline(4, parameters=t), -4.0),
        ("of order 6", lambda t: InterpolatingSpline(6, parameters=t), -6.0),
    )
    ways = tuple(Way(name, partial(through, kind=kind), slope) for name, kind, slope in kinds)
    return Study(ways, error, lambda found: len(found.controls))


SPLINE_FIT = Approximation(
    name="spline-fit",
    title="Splines through points",
    about="Splines through points of a rosette 150 mm wide that is cut open, at even steps of its parameter. The error "
    "is the largest distance of places of the same parameter on spline and rosette.",
    knob="points",
    values=(16, 32, 64, 128, 256),
    limits=(6, 4096),
    unit="mm",
    counts="control points",
    study=_study_of_spline_fit,
)


# Zero manifolds: an isophote of a torus, its points found on the sides of a grid's triangles in three ways.

Slopes = Callable[[Floats, Floats], Floats]

GRID_TORUS, GRID_CAMERA = Torus(3.0, 1.2), Camera(eye=(7.0, -5.0, 14.0))

TRUTH_BUDGET, CELLS = 4.0, 64
"""The work that the true curve takes, and the grid it is looked for on."""


def _study_of_zero_crossings_on_grids() -> Study:
    isophote = Isophote(GRID_TORUS, (2.0, -1.0, 3.0), 0.45)
    matrix = page_from_world(GRID_CAMERA, np.array([(-4.2, -4.2, -1.2), (4.2, 4.2, 1.2)]))

    def places(u: Floats, v: Floats) -> Floats:
        return on_page(matrix, GRID_TORUS.points(u, v))

    def manifold(tolerance: float | None = None) -> ZeroManifold:
        return zero_manifold_of_f_uv(
            isophote.values,
            GRID_TORUS.domain,
            columns=CELLS,
            rows=CELLS,
            gradient=isophote.slopes,
            positions=places,
            tolerance=tolerance,
            budget=budget_of(TRUTH_BUDGET),
        )

    def crossings(cells: float, slopes: Slopes | None) -> Floats:
        # A cell more on every side: at borders of a grid average normals lean outwards.
        turn = 2.0 * np.pi * np.arange(-1, int(cells) + 2) / int(cells)
        grid = np.stack(np.meshgrid(turn, turn, indexing="ij"), axis=-1)
        values = isophote.values(grid[..., 0], grid[..., 1])
        return zeros_on_sides(np.concatenate([grid, values[..., None]], axis=-1), slopes)

    def true_slopes(points: Floats, normals: Floats) -> Floats:
        return np.stack(isophote.slopes(*points[:, :2].T), axis=1)

    truth = manifold(TRUE_ISOPHOTE_MM)
    lines = [places(*truth[branch].T) for branch in range(len(truth))]

    def error(found: Floats | ZeroManifold) -> float:
        points = found.points if isinstance(found, ZeroManifold) else found
        return farthest(places(*points.T), lines)

    def count(found: Floats | ZeroManifold) -> int:
        return len(found.points if isinstance(found, ZeroManifold) else found)

    ways = (
        Way("linear", partial(crossings, slopes=None), -2.0),
        Way("cubic parabola", partial(crossings, slopes=slopes_of_normals), -3.0),
        Way("with true slopes", partial(crossings, slopes=true_slopes), -4.0),
    )
    return Study(ways, error, count, exact=manifold)


def slopes_of_normals(points: Floats, normals: Floats) -> Floats:
    """(n,2) the slopes by u and v of a graph with these normals (n,3)."""
    return np.asarray(-normals[:, :2] / normals[:, 2:])


def zeros_on_sides(grid: Floats, slopes: Slopes | None) -> Floats:
    """(p,2) points u, v on the sides of the optimised triangles of a grid (n,m,3) of u, v and f at which f is zero.

    slopes: of the points of the grid and their average normals; the zeros are those of the cubic parabolas through
    values and slopes, and without them those of the chords. On the outermost cells none are looked for.
    Source: Glaeser, section 8.4, figures 11 and 12.
    """
    triangles, normals = triangulate_surface(grid)
    points, inner = grid.reshape(-1, 3), np.zeros(grid.shape[:2], dtype=np.bool_)
    inner[1:-1, 1:-1] = True
    sides = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    sides = sides[inner.ravel()[sides].all(axis=1) & ((points[sides, 2] < 0.0).sum(axis=1) == 1)]
    first, last = points[sides].transpose(1, 0, 2)
    way, share = last - first, first[:, 2] / (first[:, 2] - last[:, 2])
    if slopes is not None:
        slope = slopes(points, normals.reshape(-1, 3))
        ends = [(slope[sides[:, k]] * way[:, :2]).sum(axis=1) for k in range(2)]
        share = zero_of_cubic_parabola(cubic_parabola(first[:, 2], last[:, 2], *ends))
    return np.asarray(first[:, :2] + share[:, None] * way[:, :2])


ZERO_MANIFOLD = Approximation(
    name="zero-manifold",
    title="Zero manifolds",
    about="An isophote of a torus on a grid of its parameters. The error is how far the points found on the sides of "
    "triangles are off the true curve, on the page. Exact: every point refined on the condition itself.",
    knob="cells along a side",
    values=(12, 24, 48, 96),
    limits=(8, 512),
    unit="mm",
    counts="points",
    study=_study_of_zero_crossings_on_grids,
)
