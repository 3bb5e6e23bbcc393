"""The hard cases 29, 48, 49, 72 and 80 as drawings: cusps of contours, pinch points, cuspidal edges, lines through
them, balls that touch or coincide."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.curves.families import Line
from vectorplot.drawing.drawing import CurvedStrokes, Drawing
from vectorplot.surfaces.capped_bodies import Capped
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.quadrics import Cone, Cylinder, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus
from vectorplot.testing import assert_drawing_is_right, curves_in_space
from vectorplot.words import LineKind

pytestmark = pytest.mark.filterwarnings("ignore:SURFACE. f :vectorplot.errors.InputWarning")
"""Where a surface has no normal its contour may be in doubt; the drawing says so."""

SQUARE = Domain(-1.0, 1.0, -1.0, 1.0)
OUTLINES = "contour,boundary"


def drawn(
    surface: object, camera: vp.Camera, hidden: str = "solid", lines: str | None = None
) -> tuple[vp.Scene, Drawing]:
    scene = vp.Scene((vp.Item("SURFACE", surface, curves=vp.SurfaceLines(7, 7)),))
    return scene, vp.draw(scene, camera, page=vp.Page(100, 100, 5), hidden=hidden, lines=lines)


def ends_of(curves: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([curve[[0, -1]] for curve in curves])


def knots(drawing: Drawing) -> np.ndarray:
    """(n,2) where Bézier segments begin and end."""
    marks = [mark for layer in drawing.layers for mark in layer.marks if isinstance(mark, CurvedStrokes)]
    return np.concatenate([mark.beziers.control[:, k] for mark in marks for k in (0, 3)])


def distance(points: np.ndarray, aim: np.ndarray) -> float:
    return float(np.linalg.norm(points - aim, axis=1).min())


def on_page(drawing: Drawing, point: np.ndarray) -> np.ndarray:
    x, y, _, w = drawing.page_from_world @ [*point, 1.0]
    return np.array([x, y]) / w


def torus_cusps(slant: float) -> np.ndarray:
    """(4,3) the cusps of the contour of a torus of radii 3 and 1, seen along (0, sin slant, cos slant): where the
    ellipse that its circle of middles has for an image has the radius of curvature 1."""
    c = np.cos(slant)
    sine = np.sqrt(((c / 3.0) ** (2.0 / 3.0) - c * c) / (1.0 - c * c))
    t = np.array([1.0, -1.0, 1.0, -1.0]) * np.arcsin(sine) + np.array([0.0, 0.0, np.pi, np.pi])
    middle = np.stack([np.cos(t), np.sin(t), 0.0 * t], axis=1)
    arm = np.stack([-c * np.cos(t), -c * np.sin(t), np.sin(slant) * np.sin(t)], axis=1)
    return 3.0 * middle + arm / np.linalg.norm(arm, axis=1, keepdims=True)


@pytest.mark.slow
@pytest.mark.hard(29)
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("slant", [1.1, 1.3, 1.5])
def test_the_visible_contour_of_a_torus_ends_in_its_cusps(slant: float) -> None:
    camera = vp.Camera((0.0, 20.0 * np.sin(slant), 20.0 * np.cos(slant)), (0.0, 0.0, 0.0), parallel=True)
    scene, drawing = drawn(Torus(3.0, 1.0), camera)
    cusps = torus_cusps(slant)
    # The pen may leave out the tip of a hidden one: on the page it is no further than this from the next point.
    assert all(distance(knots(drawing), on_page(drawing, cusp)) < 1e-4 for cusp in cusps)
    # Those on this side of the axis are seen: there the contour ends, and nothing of it is seen beyond.
    seen = drawn(Torus(3.0, 1.0), camera, "none", "contour")[1]
    visible = curves_in_space(seen, kind="contour")
    ends = ends_of([curve for curve in visible if np.linalg.norm(curve[0] - curve[-1]) > 1e-6])
    images = np.array([on_page(seen, end) for end in ends])
    found = [distance(images, on_page(seen, cusp)) < 1e-4 for cusp in cusps]
    assert sum(found) == 2
    assert_drawing_is_right(drawing, scene, camera, samples=300, clearance=1e-5)


@pytest.mark.slow
@pytest.mark.hard(48)
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("eye", [(6.0, -5.0, 4.0), (5.0, 6.5, 2.0), (-4.0, -6.0, 7.0)])
def test_the_double_line_of_an_umbrella_is_drawn_up_to_its_pinch_point(eye: tuple[float, float, float]) -> None:
    # x^2 = y^2 z: both halves meet in the z axis, from the pinch point in the origin upwards. None of these eyes is in
    # the plane of the axis and a ruling that is drawn: such a one is drawn over what is hidden behind it.
    umbrella = surface_of_function(lambda u, v: (u * v, u, v * v), SQUARE)
    _, drawing = drawn(umbrella, vp.Camera(eye, (0.0, 0.0, 0.5)), lines=f"{OUTLINES},intersection")
    lines = curves_in_space(drawing, kind="intersection")
    points = np.concatenate(lines)
    assert np.abs(points[:, :2]).max() < 1e-9
    assert abs(points[:, 2].min()) < 1e-9 and abs(points[:, 2].max() - 1.0) < 1e-9
    assert distance(ends_of(lines), np.zeros(3)) < 1e-9
    assert np.isclose(sum(abs(np.diff(line[:, 2])).sum() for line in lines), 1.0, atol=1e-6), "once, without gaps"


@pytest.mark.slow
@pytest.mark.hard(49)
def test_the_cuspidal_edge_of_a_swallowtail_keeps_its_cusp() -> None:
    tail = surface_of_function(lambda u, v: ((3.0 * v * v + u) * v * v, (4.0 * v * v + 2.0 * u) * v, u), SQUARE)
    _, drawing = drawn(tail, vp.Camera((6.0, -5.0, 4.0)), lines=f"{OUTLINES},crease")
    edge = curves_in_space(drawing, kind="crease")
    points = np.concatenate(edge)
    # The edge is (-3 v^4, -8 v^3, -6 v^2), down to the border at u = -1.
    v = np.cbrt(-points[:, 1] / 8.0)
    assert np.abs(points - np.stack([-3.0 * v**4, -8.0 * v**3, -6.0 * v**2], axis=1)).max() < 1e-6
    assert np.abs(points[:, 2].min() + 1.0) < 1e-8
    assert distance(points, np.zeros(3)) < 1e-9
    assert distance(knots(drawing), on_page(drawing, np.zeros(3))) < 1e-6, "no curve is bent round the cusp"


@pytest.mark.slow
@pytest.mark.hard(49)
@pytest.mark.parametrize("eye", [(-6.0, -4.0, 2.0), (4.0, -6.0, 3.0), (-5.0, -6.0, 5.0)])
def test_the_cuspidal_edge_of_a_swallowtail_is_not_hidden_by_its_own_wings(eye) -> None:
    """From these eyes nothing is in front of the edge: sight lines through nine million triangles tell. The wings have
    no second order there, so it must not tell where a sight line meets them again."""
    tail = surface_of_function(lambda u, v: (u, (4.0 * v * v + 2.0 * u) * v, -(3.0 * v * v + u) * v * v), SQUARE)
    # With the borders: the picture of the edge alone is so much larger that all is traced once more for it.
    drawing = vp.draw(
        vp.Scene((vp.Item("tail", tail),)), vp.Camera(eye, (0.0, 0.0, 0.0)), lines="crease,boundary", hidden="solid"
    )
    hidden = np.concatenate(
        [paths.hidden_by[paths.kind == LineKind.CREASE] for layer in drawing.layers for paths in layer.strokes]
    )
    assert len(hidden) and not hidden.any()


@pytest.mark.slow
@pytest.mark.hard(49)
def test_the_edge_of_the_tangents_of_a_helix_is_drawn_whole() -> None:
    def points(u, v):
        return np.cos(v) - u * np.sin(v), np.sin(v) + u * np.cos(v), v + u

    camera = vp.Camera((9.0, -14.0, 8.0), (0.0, 0.0, 3.0))
    scene, drawing = drawn(surface_of_function(points, Domain(-1.0, 1.0, 0.0, 6.0)), camera)
    edge = curves_in_space(drawing, kind="crease")
    x, y, z = np.concatenate(edge).T
    assert np.abs(np.hypot(x - np.cos(z), y - np.sin(z))).max() < 1e-9
    assert np.isclose(sum(abs(np.diff(line[:, 2])).sum() for line in edge), 6.0, atol=1e-6), "once, without gaps"
    assert_drawing_is_right(drawing, scene, camera, samples=200, clearance=1e-4)


@pytest.mark.slow
@pytest.mark.hard(72)
@pytest.mark.parametrize("parallel", [True, False])
def test_a_line_through_an_apex_is_hidden_to_the_apex_and_no_further(parallel: bool) -> None:
    axis = vp.Item("AXIS", Line.through((0.0, 0.0, 0.0), (0.0, 0.0, 5.0)))
    scene = vp.Scene((vp.Item("CONE", Cone.standing(2.0, 4.0)), axis))
    drawing = vp.draw(scene, vp.Camera((9.0, -14.0, 7.0), parallel=parallel), lines=("curve",))
    heights = np.concatenate([paths.points3d[:, 2] for layer in drawing.layers for paths in layer.strokes])
    assert np.isclose(heights.min(), 4.0, atol=1e-6) and np.isclose(heights.max(), 5.0)


TOGETHER = {
    "touching": [Sphere(1.0), Sphere(0.5, (1.5, 0.0, 0.0))],
    "touching from inside": [Sphere(1.0), Sphere(0.5, (0.5, 0.0, 0.0))],
    "concentric": [Sphere(1.0), Sphere(0.6)],
    "coincident": [Sphere(1.0), Sphere(1.0)],
    "along the axis": [Cylinder(1.0, -2.0, 2.0), Sphere(0.5, (0.0, 0.0, -3.0))],
}


@pytest.mark.slow
@pytest.mark.hard(80)
@pytest.mark.filterwarnings("ignore:S0. f is zero:vectorplot.errors.InputWarning")
@pytest.mark.parametrize(
    ("name", "eye", "parallel"),
    [
        ("touching", (5.0, -9.0, 4.0), False),
        ("touching", (9.0, 0.0, 0.0), True),
        ("touching from inside", (0.0, 0.0, 9.0), True),
        ("concentric", (5.0, -9.0, 4.0), True),
        ("coincident", (9.0, 0.0, 0.0), False),
        ("along the axis", (0.0, 0.0, 9.0), True),
        ("along the axis", (0.0, 0.0, 9.0), False),
    ],
)
def test_balls_that_touch_or_coincide_and_a_cylinder_along_its_axis(name: str, eye: tuple, parallel: bool) -> None:
    lines = vp.SurfaceLines(4, 3)
    scene = vp.Scene(tuple(vp.Item(f"S{k}", shape, curves=lines) for k, shape in enumerate(TOGETHER[name])))
    camera = vp.Camera(eye, parallel=parallel)
    drawing = vp.draw(scene, camera, hidden="solid")
    assert assert_drawing_is_right(drawing, scene, camera, samples=150, clearance=1e-4) > 50


@pytest.mark.slow
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("view", ["top", "front"])
def test_a_cylinder_with_parts_seen_edge_on_is_drawn_without_a_word(view: str) -> None:
    axis = vp.Item("AXIS", Line((0.0, 0.0, -1.0), (0.0, 0.0, 2.0)))
    for shape in (Cylinder(), Capped(Cylinder())):
        assert vp.draw(vp.Scene((axis, vp.Item("CYLINDER", shape))), view).layers
