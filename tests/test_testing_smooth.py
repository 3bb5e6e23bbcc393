"""Rays against smooth surfaces: they agree with closed forms, with each other, and the assertion can fail."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.analytic_sight import sheets_in_front
from support.torus_runs import contour_of, isophotes_of, parameter_lines, runs_of

from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Paths
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    Paraboloid,
    Sphere,
    implicit_ellipsoid,
)
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus, dupin_cyclide
from vectorplot.surfaces.trimmed import CutSurface
from vectorplot.testing import assert_drawing_is_right, visible_by_rays
from vectorplot.testing.drawings import _where_strokes_meet

SURE = 2e-5

SURFACES = {
    "torus": Torus(3.0, 1.0),
    "fat torus": Torus(3.0, 2.5, (1.0, 2.0, 3.0)),
    "sphere": Sphere(2.0),
    "ellipsoid": Ellipsoid((1.0, 2.0, 3.0)),
    "cylinder": Cylinder(1.0, -1.0, 1.0),
    "double cone": Cone(1.0, -1.0, 1.0),
    "hyperboloid": Hyperboloid((1.0, 1.5, 1.0), -1.0, 2.0),
    "paraboloid": Paraboloid(1.0, 1.2, 2.0),
    "saddle": HyperbolicParaboloid(1.0, 1.0, 1.5, 1.0),
}

IMPLICIT = {"torus": ImplicitTorus(3.0, 1.0), "ellipsoid": implicit_ellipsoid((1.0, 2.0, 3.0))}


def one(shape: object, **options) -> Scene:
    return Scene((Item("shape", shape, **options),))


def camera_of(scene: Scene, random: np.random.Generator, parallel: bool) -> Camera:
    low, high = scene.bounds
    direction = random.normal(size=3)
    eye = (low + high) / 2.0 + direction * 1.3 * np.linalg.norm(high - low) / np.linalg.norm(direction)
    return Camera(tuple(eye.tolist()), tuple(((low + high) / 2.0).tolist()), parallel=parallel)


def some_points(shape, scene: Scene, random: np.random.Generator) -> np.ndarray:
    """On the surface, and anywhere in its box."""
    domain = shape.domain
    u, v = random.uniform((domain.u_start, domain.v_start), (domain.u_end, domain.v_end), (250, 2)).T
    return np.concatenate([shape.points(u, v), random.uniform(*scene.bounds, (80, 3))])


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", SURFACES)
def test_rays_agree_with_closed_forms(name: str, parallel: bool) -> None:
    shape, random = SURFACES[name], np.random.default_rng(len(name))
    scene = one(shape)
    camera, points = camera_of(scene, random, parallel), some_points(shape, scene, random)
    count, sure = sheets_in_front(shape, camera, points)
    shapes = [shape, IMPLICIT[name]] if name in IMPLICIT else [shape]
    for other in shapes:
        sight = visible_by_rays(one(other), camera, points)
        both = sure & (sight.clearance > SURE)
        assert both.mean() > 0.9
        assert np.array_equal(count[both] > 0, sight.hidden_by[both] > 0)


@pytest.mark.slow
@pytest.mark.parametrize("parallel", [False, True])
def test_rays_agree_with_the_runs_of_a_torus(parallel: bool) -> None:
    torus = Torus(3.0, 1.0)
    camera = Camera((7.0, -8.0, 6.0), parallel=parallel)
    curves = [*parameter_lines(3, 4), *contour_of(torus, camera), *isophotes_of(np.array([1.0, 2.0, 3.0]), (0.3,))]
    points, visible = [], []
    for curve in curves:
        runs = runs_of(torus, camera, curve)
        at = np.concatenate([np.linspace(run.start, run.end, 9)[1:-1] for run in runs])
        points.append(torus.points(*curve.parameters(at)))
        visible += [run.visible for run in runs for _ in range(7)]
    for shape in (torus, ImplicitTorus(3.0, 1.0)):
        sight = visible_by_rays(one(shape), camera, np.concatenate(points))
        sure = sight.clearance > SURE
        assert sure.mean() > 0.8
        assert np.array_equal(sight.hidden_by[sure] == 0, np.array(visible)[sure])


@pytest.mark.slow
def test_contour_points_are_told_from_others() -> None:
    sight = visible_by_rays(one(Sphere(1.0)), Camera((0.0, 0.0, 9.0), parallel=True), [(1.0, 0, 0), (0, 0.6, 0.8)])
    assert sight.on_contour.tolist() == [True, False]
    assert sight.hidden_by.tolist() == [0, 0]


@pytest.mark.slow
def test_near_its_contour_nothing_is_said_of_a_surface() -> None:
    angle = np.array([1e-3, 1e-4, -1e-4])
    points = np.stack([np.cos(angle), 0.0 * angle, np.sin(angle)], axis=1)
    sight = visible_by_rays(one(Sphere(1.0)), Camera((0.0, 0.0, 9.0), parallel=True), points)
    assert (sight.clearance < SURE).all()


def test_a_surface_hides_what_is_behind_and_nothing_beside_its_border() -> None:
    plate = one(HyperbolicParaboloid(10.0, 10.0, 1.0, 1.0))
    camera = Camera((0.0, 0.0, 9.0), parallel=True)
    sight = visible_by_rays(plate, camera, [(0.9, 0.5, -1.0), (1.1, 0.5, -1.0), (0.9, 0.5, 1.0), (0.99999, 0.5, -1.0)])
    assert sight.hidden_by[:3].tolist() == [1, 0, 0]
    assert sight.clearance[3] < SURE < sight.clearance[:3].min()


def test_a_hole_hides_nothing() -> None:
    def with_a_hole(x, y):
        return np.where(np.hypot(x, y) < 0.5, np.nan, 0.1 * x)

    scene = one(graph(with_a_hole, Domain(-1.0, 1.0, -1.0, 1.0)))
    sight = visible_by_rays(scene, Camera((0.0, 0.0, 9.0), parallel=True), [(0.1, 0.2, -1.0), (0.7, 0.2, -1.0)])
    assert sight.hidden_by.tolist() == [0, 1]


@pytest.mark.spread
@pytest.mark.parametrize("moved", [False, True])
@pytest.mark.parametrize("view", [(5.0, -4.0, 3.0), (1.2, 0.4, 2.5), (-1.0, 6.0, 0.4)])
def test_a_cut_surface_hides_up_to_its_rim(view, moved) -> None:
    taken = (HalfSpaces(((0.0, 0.0, 1.0),), (0.2,)), HalfSpaces(((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), (0.1, -0.3)))
    cut = CutSurface(Sphere(1.0), taken, HalfSpaces(((0.0, 0.6, 0.8),), (-0.9,)))
    shift = np.array([3.0, -2.0, 1.0]) * moved
    scale = 2.0 if moved else 1.0
    scene = Scene((Item("bowl", PlacedSurface(cut, scale * np.eye(3), shift) if moved else cut),))
    random = np.random.default_rng(5)
    points = random.uniform(-1.0, 1.0, size=(6000, 3))
    eye = np.array(view)
    sight = visible_by_rays(scene, Camera(tuple(scale * eye + shift)), scale * points + shift)

    way = eye - points
    a, b, c = (way * way).sum(axis=1), (way * points).sum(axis=1), (points * points).sum(axis=1) - 1.0
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    met = np.zeros(len(points), dtype=bool)
    for t in ((-b - root) / a, (-b + root) / a):
        at = points + t[:, None] * way
        left = ~np.any([region.is_inside(at) for region in taken], axis=0) & (at @ (0.0, 0.6, 0.8) >= -0.9)
        met |= (b * b > a * c) & (t > 0.0) & (t < 1.0) & left
    sure = sight.clearance > 1e-6
    assert sure.mean() > 0.98
    assert 500 < met.sum() < 5500
    assert (sight.hidden_by[sure] == met[sure]).all()


@pytest.mark.slow
def test_what_does_not_occlude_hides_nothing() -> None:
    points = [(0.0, 0.0, -1.0)]
    camera = Camera((0.3, 0.2, 9.0))
    for shape in (Sphere(0.5), implicit_ellipsoid((0.5, 0.5, 0.5))):
        assert visible_by_rays(one(shape), camera, points).hidden_by.tolist() == [1]
        assert visible_by_rays(one(shape, occludes=False), camera, points).hidden_by.tolist() == [0]
        assert visible_by_rays(one(shape), camera, np.zeros((0, 3))).hidden_by.tolist() == []


def changed(drawing: Drawing, **values) -> Drawing:
    """The drawing with other values in its polylines."""

    def with_them(mark: Paths | CurvedStrokes) -> Paths:
        paths = mark.paths if isinstance(mark, CurvedStrokes) else mark
        return replace(paths, **{name: value(getattr(paths, name)) for name, value in values.items()})

    layers = tuple(replace(layer, marks=tuple(map(with_them, layer.marks))) for layer in drawing.layers)
    return replace(drawing, layers=layers)


@pytest.mark.slow
@pytest.mark.parametrize("shape", [Torus(3.0, 1.0), ImplicitTorus(3.0, 1.0)])
def test_a_drawing_of_a_surface_is_right_and_a_wrong_one_is_found(shape) -> None:
    scene = one(shape, curves=SurfaceLines(isophotes=(0.1, 0.5)))
    camera = Camera((9.0, 5.0, 6.0))
    drawing = draw(scene, camera, hidden="solid")
    assert assert_drawing_is_right(drawing, scene, camera, samples=300, clearance=SURE) > 100
    for wrong in (lambda count: count + 1, lambda count: np.maximum(count - 1, 0), lambda count: 0 * count):
        with pytest.raises(AssertionError, match=r"is drawn as hidden by \d items, rays find"):
            assert_drawing_is_right(changed(drawing, hidden_by=wrong), scene, camera, samples=80, clearance=SURE)


@pytest.mark.slow
def test_points_that_must_be_shown_on_a_surface() -> None:
    scene = one(Torus(3.0, 1.0), curves=SurfaceLines(columns=6))
    camera = Camera((9.0, 5.0, 6.0))
    drawing = draw(scene, camera)
    column = Torus(3.0, 1.0).points(np.zeros(40), np.linspace(0.0, 6.0, 40))
    options = {"samples": 60, "clearance": SURE, "tolerance_mm": 0.02}
    assert_drawing_is_right(drawing, scene, camera, must_show=column, **options)
    other = Torus(3.0, 1.0).points(np.full(40, 0.5), np.linspace(0.0, 6.0, 40))
    with pytest.raises(AssertionError, match="visible points are not drawn"):
        assert_drawing_is_right(drawing, scene, camera, must_show=other, **options)


@pytest.mark.slow
def test_polyhedra_among_surfaces_are_judged_too() -> None:
    wall = Mesh.from_polygons(
        np.array([(2.0, -5.0, -5.0), (2.0, 5.0, -5.0), (2.0, 5.0, 5.0), (2.0, -5.0, 5.0)]), [[0, 1, 2, 3]]
    )
    scene = Scene((Item("ball", Sphere(1.0), curves=SurfaceLines(columns=5, rows=4)), Item("wall", wall)))
    camera = Camera((9.0, 1.0, 2.0))
    drawing = draw(scene, camera, hidden="solid")
    assert assert_drawing_is_right(drawing, scene, camera, samples=300, clearance=SURE) > 100
    with pytest.raises(AssertionError, match="of ball is drawn as hidden by 1 items, rays find 2"):
        assert_drawing_is_right(
            changed(drawing, hidden_by=lambda count: np.minimum(count, 1)), scene, camera, samples=300, clearance=SURE
        )


@pytest.mark.slow
def test_cells_of_very_unequal_size_leave_few_points_open() -> None:
    # A torus inverted in a sphere around a point close to it: one side of it is thirty times as large as the other.
    scene = one(dupin_cyclide(3.0, 1.0, (5.2, 0.0, 0.0), 4.0))
    camera = Camera((5.0, -19.0, 13.0))
    points = some_points(scene.items[0].shape, scene, np.random.default_rng(4))
    sight = visible_by_rays(scene, camera, points)
    assert (sight.clearance > SURE).mean() > 0.8
    # The same surface as an equation, which another walk looks at.
    other = visible_by_rays(one(ImplicitCyclide(3.0, 1.0, (5.2, 0.0, 0.0), 4.0)), camera, points)
    sure = np.minimum(sight.clearance, other.clearance) > SURE
    assert sure.mean() > 0.5
    assert np.array_equal(sight.hidden_by[sure], other.hidden_by[sure])


def test_strokes_that_end_closely_together_meet() -> None:
    """Where three sheets meet two borders bend, one before and one behind, a hundred millionth of the extent apart."""
    near = 1e-8
    before = [[(1.0, 0.0, 0.0), (near, 0.0, 0.0)], [(near, 0.0, 0.0), (0.0, 0.0, 1.0)]]
    behind = [[(-1.0, 0.0, 0.0), (0.0, 0.0, 0.0)], [(0.0, 0.0, 0.0), (0.0, 0.0, -1.0)]]
    meet = _where_strokes_meet(np.array(before + behind), np.arange(4))
    assert meet.tolist() == [[False, True], [True, False]] * 2
