"""Drawings of surfaces that curves in u and v trim: lines end on the trims, and hide and are hidden as rays say."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import curves, features, surfaces
from vectorplot.curves.bezier import bezier_points
from vectorplot.features.edge_splitting import Within
from vectorplot.features.parameter_curves import borders, v_lines
from vectorplot.features.tessellation import facets
from vectorplot.surfaces import Domain, TrimmedSurface
from vectorplot.surfaces.trimmed import trims_of
from vectorplot.testing import assert_drawing_is_right, visible_by_rays

STAR = [(r * np.cos(a), r * np.sin(a)) for a, r in zip(np.arange(10) * np.pi / 5, [0.6, 0.25] * 5, strict=True)]
SHEET = surfaces.graph(lambda x, y: 0.3 * np.sin(2 * x) * np.cos(2 * y), Domain(-2.0, 2.0, -2.0, 2.0))
WAVE = curves.curve_of_function(lambda t: (t, 1.0 + 0.3 * np.sin(3.0 * t), 0.0 * t), 0.0, 2.0 * np.pi)
SHAPES = {
    "tube": TrimmedSurface(surfaces.Cylinder(1.0, -1.0, 2.0), trims=[WAVE]),
    "ring": TrimmedSurface(
        surfaces.Torus(), trims=[curves.Circle((-1, 0, 0), 1.8)], holes=[curves.Circle((-1, 0, 0), 1.0)]
    ),
    "star": TrimmedSurface(SHEET, trims=[3.0 * np.array(STAR)], holes=[STAR]),
}
CAMERAS = {
    "central": vp.Camera(eye=(4, -9, 5), target=(0, 0, 0)),
    "parallel": vp.Camera(eye=(-3, 6, 9), target=(0, 0, 0), parallel=True),
}


def on_borders(shape: TrimmedSurface, count: int = 60) -> np.ndarray:
    """Points on the curves that trim a surface."""
    region, rng = trims_of(shape), np.random.default_rng(count)
    control = region.borders.control
    places = bezier_points(control[rng.integers(0, len(control), count)], rng.uniform(0.0, 1.0, count))
    return shape.surface.points(*places.T)


@pytest.mark.parametrize(("shape", "camera"), [("tube", "parallel"), ("ring", "parallel"), ("star", "central")])
def test_rays_see_what_is_drawn(shape, camera):
    scene = vp.Scene([vp.Item("A", SHAPES[shape], curves=vp.SurfaceLines(5, 4, isophotes=(0.4,)))])
    drawing = vp.draw(scene, CAMERAS[camera], hidden="dashed")
    found = assert_drawing_is_right(drawing, scene, CAMERAS[camera], samples=60, must_show=on_borders(SHAPES[shape]))
    assert found > 60


def test_through_a_window_one_sees_what_is_within():
    wall = TrimmedSurface(surfaces.Sphere(), holes=[curves.Circle((-np.pi / 2, 0.0, 0.0), 0.5)])
    scene = vp.Scene([vp.Item("WALL", wall), vp.Item("BALL", surfaces.Sphere(0.3))])
    camera = vp.Camera(eye=(0, -9, 0), target=(0, 0, 0))
    drawing = vp.draw(scene, camera)
    inner = [stroke for layer in drawing.layers for stroke in layer.strokes if (stroke.item == 1).any()]
    assert inner
    assert visible_by_rays(scene, camera, [(0.0, -0.3, 0.0)]).hidden_by.tolist() == [0]
    closed = vp.Scene([vp.Item("WALL", surfaces.Sphere()), scene.items[1]])
    assert visible_by_rays(closed, camera, [(0.0, -0.3, 0.0)]).hidden_by.tolist() == [1]


def test_lines_in_which_they_meet_others_end_on_the_trims():
    ball = TrimmedSurface(surfaces.Sphere(), holes=[curves.Circle((-np.pi / 2, 0.0, 0.0), 0.5)])
    plate = surfaces.graph(lambda x, y: 0.0 * x, Domain(-2.0, 2.0, -2.0, 2.0))
    scene = vp.Scene([vp.Item("BALL", ball), vp.Item("PLATE", plate)])
    drawing = vp.draw(scene, vp.Camera(eye=(1, -8, 4), target=(0, 0, 0)), hidden="solid")
    met = np.concatenate(
        [one.points3d for layer in drawing.layers if layer.name == "intersection" for one in layer.strokes]
    )
    assert np.allclose(np.hypot(met[:, 0], met[:, 1]), 1.0, atol=1e-6)
    away = np.abs((np.arctan2(met[:, 1], met[:, 0]) + np.pi / 2 + np.pi) % (2.0 * np.pi) - np.pi)
    assert away.min() == pytest.approx(0.5, abs=1e-6)


def test_contours_sections_and_parameter_lines_end_on_the_trims():
    shape = SHAPES["ring"]
    for found in (
        features.contour(shape, (4.0, -9.0, 5.0)),
        features.plane_sections(shape, (1.0, 0.0, 0.2), [1.1, 1.7]),
        v_lines(shape, [0.3]),
    ):
        assert len(found)
        off = np.hypot(found.u + 1.0, found.v)
        off = np.minimum(off, np.hypot(found.u - 2.0 * np.pi + 1.0, found.v))
        assert ((off >= 1.0 - 1e-7) & (off <= 1.8 + 1e-7)).all()
        ends = off[np.concatenate([found.offsets[:-1], found.offsets[1:] - 1])]
        assert np.minimum(np.abs(ends - 1.0), np.abs(ends - 1.8)).max() < 1e-7


def test_a_hole_far_smaller_than_a_cell_has_its_border():
    shape = TrimmedSurface(surfaces.Sphere(), holes=[curves.Circle((-1.5, 0.0, 0.0), 1e-3)])
    border = borders(shape)
    assert len(border) == 1 and border.closed.all()
    assert np.allclose(np.hypot(border.u + 1.5 - 2.0 * np.pi, border.v), 1e-3, rtol=1e-6)


def test_their_facets_have_the_area_that_is_left_and_no_gaps():
    plate = surfaces.graph(lambda x, y: 0.0 * x, Domain(-2.0, 2.0, -2.0, 2.0))
    shape = TrimmedSurface(plate, trims=[curves.Circle((0, 0, 0), 1.5)], holes=[curves.Circle((0.4, 0.2, 0), 0.6)])
    found = facets(shape, Within(lambda points: np.full(points.shape[:-1], 1e-3)))
    corner_numbers = found.mesh.corners.reshape(-1, 3)
    corners = found.mesh.vertices[corner_numbers]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    assert area == pytest.approx(np.pi * (1.5**2 - 0.6**2), rel=2e-3)
    sides = np.sort(np.stack([corner_numbers, np.roll(corner_numbers, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, uses = np.unique(sides, axis=0, return_counts=True)
    ends = found.mesh.vertices[edges[uses == 1].ravel(), :2]
    off = np.abs(np.hypot(*ends.T) - 1.5), np.abs(np.hypot(*(ends - (0.4, 0.2)).T) - 0.6)
    assert np.minimum(*off).max() < 1e-6 and uses.max() == 2
