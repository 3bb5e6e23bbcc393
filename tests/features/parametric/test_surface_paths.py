"""Curves u(t), v(t) on surfaces: on the surface, whole over seams, and hidden as rays say."""

import numpy as np
import pytest
from support.effort import several

import vectorplot as vp
from vectorplot.drawing.drawing import CurvedStrokes
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.parameter_curves import surface_path
from vectorplot.geometry.budget import Budget
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.surface_lines import SurfaceLines, path_on_surface
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing import assert_drawing_is_right
from vectorplot.testing.curves import Tree
from vectorplot.words import LineKind

TORUS = Torus(3.0, 1.0)
KNOTS = [(1, 1), (2, 3), (5, 2), (1, 0), (0, 1), (-3, 7)]


def knot(p: int, q: int):
    return lambda t: np.stack([p * t + 0.3, q * t - 0.1], axis=1)


@pytest.mark.slow
@pytest.mark.capability("G8.2-surface")
@pytest.mark.spread
@pytest.mark.parametrize(("p", "q"), KNOTS)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_knots_on_a_torus_are_one_closed_curve_over_all_seams(p: int, q: int, tolerance: float) -> None:
    found = surface_path(TORUS, knot(p, q), 0.0, 2 * np.pi, tracing=Tracing(tolerance=tolerance))
    assert len(found) == 1 and found.closed.all() and found.turns.tolist() == [[p, q]]
    assert np.array_equal(found.points, TORUS.points(found.u, found.v)) or np.allclose(
        found.points, TORUS.points(found.u, found.v), atol=1e-12
    )
    t = np.linspace(0, 2 * np.pi, 4001)
    true = TORUS.points(*knot(p, q)(t).T)
    chords = Tree(np.stack([found[0][:-1], found[0][1:]], axis=1))
    assert chords.nearest(true, 0.0)[0].max() < 1.01 * tolerance


@pytest.mark.capability("G8.2-surface")
def test_lines_of_constant_u_and_v_are_the_parameter_lines() -> None:
    for value in (0.3, 1.7, 4.0):
        u_line = surface_path(TORUS, lambda t, u=value: np.stack([np.full_like(t, u), t], axis=1), 0.0, 2 * np.pi)
        v_line = surface_path(TORUS, lambda t, v=value: np.stack([t, np.full_like(t, v)], axis=1), 0.0, 2 * np.pi)
        assert u_line.closed.all() and v_line.closed.all()
        assert np.ptp(np.arctan2(u_line.points[:, 1], u_line.points[:, 0])) < 1e-12
        assert np.ptp(v_line.points[:, 2]) < 1e-12


@pytest.mark.capability("G8.2-surface")
def test_a_path_ends_where_it_leaves_the_surface_and_goes_on_where_it_comes_back() -> None:
    ball = Sphere(1.0)
    found = surface_path(ball, lambda t: np.stack([t, 2.0 * np.sin(t)], axis=1), 0.0, 2 * np.pi)
    assert len(found) == 3 and not found.closed.any()
    ends = np.concatenate([found.v[found.offsets[:-1]], found.v[found.offsets[1:] - 1]])
    assert np.sort(np.abs(ends)) == pytest.approx([0, 0, *[np.pi / 2] * 4], abs=1e-6)
    assert len(surface_path(ball, lambda t: np.stack([t, 0 * t + 9], axis=1), 0.0, 1.0)) == 0
    assert len(surface_path(ball, lambda t: np.stack([0 * t, 0 * t], axis=1), 0.0, 1.0)) == 0


@pytest.mark.capability("G8.2-surface")
@pytest.mark.parametrize("size", [1e-6, 1e6])
def test_a_path_on_a_surface_of_any_size_has_the_same_points(size: float) -> None:
    small, large = (surface_path(Torus(3.0 * k, k), knot(2, 3), 0.0, 2 * np.pi) for k in (1.0, size))
    assert large.closed.all() and len(large.points) == len(small.points)
    assert np.allclose(large.points / size, small.points, atol=1e-9)


@pytest.mark.capability("G8.2-surface")
def test_a_path_that_comes_back_to_its_place_from_elsewhere_is_not_closed() -> None:
    # From the pole down, and up to it again on another meridian; and a quarter of a turn about the torus.
    petal = surface_path(Sphere(1.0), lambda t: np.stack([1.3 * t, np.pi / 2 - np.sin(np.pi * t)], axis=1), 0.0, 1.0)
    assert len(petal) == 1 and not petal.closed.any() and petal.turns.tolist() == [[0, 0]]
    assert np.allclose(petal.points[[0, -1]], (0.0, 0.0, 1.0), atol=1e-12)
    arc = surface_path(TORUS, lambda t: np.stack([t, 0 * t], axis=1), 0.0, np.pi / 2)
    assert len(arc) == 1 and not arc.closed.any()


def on_curve(drawing: vp.Drawing) -> tuple[float, float]:
    """Lengths of what is seen and what is hidden of lines of the kind curve."""
    lengths = [0.0, 0.0]
    for layer in drawing.layers:
        for mark in layer.marks:
            paths = mark.paths if isinstance(mark, CurvedStrokes) else mark
            for k in np.flatnonzero(paths.kind == int(LineKind.CURVE)):
                line = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
                line = np.vstack([line, line[:1]]) if paths.closed[k] else line
                lengths[int(paths.hidden_by[k] > 0)] += np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    return lengths[0], lengths[1]


@pytest.mark.slow
@pytest.mark.capability("G8.2-surface", "G3.0-language")
@pytest.mark.spread
@pytest.mark.parametrize(
    "camera", [vp.Camera((9, -14, 10)), vp.Camera((3, 2, 12)), vp.Camera((8, 1, 3), parallel=True)]
)
@pytest.mark.parametrize("where", ["", "rotation x 40 translation 1 2 3"])
def test_files_say_it_and_rays_see_it(camera: vp.Camera, where: str) -> None:
    text = f'RING blue surface torus 3 1 surface_curve "2*t" "5*t" t 0 "2*pi" surface_curve "t" "1" t 0 2 {where}'
    scene = parse_scene(text)
    again = parse_scene(write_scene(scene))
    camera = vp.Camera(camera.eye, (0, 0, 0) if not where else (1, 2, 3), parallel=camera.parallel)
    first, second = (vp.draw(one, camera, hidden="solid") for one in (scene, again))
    seen, hidden = on_curve(first)
    assert on_curve(second) == pytest.approx((seen, hidden), rel=1e-3)
    t = np.linspace(0, 2 * np.pi, 20001)
    whole = np.linalg.norm(np.diff(TORUS.points(2 * t, 5 * t), axis=0), axis=1).sum()
    arc = np.linspace(0, 2, 2001)
    whole += np.linalg.norm(np.diff(TORUS.points(arc, np.ones_like(arc)), axis=0), axis=1).sum()
    assert seen + hidden == pytest.approx(whole, rel=2e-3) and min(seen, hidden) > 5
    assert_drawing_is_right(first, scene, camera, samples=several(70, long=200))
    assert on_curve(vp.draw(scene, camera, lines=("contour",))) == (0.0, 0.0)


@pytest.mark.slow
@pytest.mark.capability("G8.2-surface")
def test_python_functions_do_too_and_name_themselves_when_they_fail() -> None:
    def spiral(t):
        return 6 * t, t

    item = vp.Item("BALL", Sphere(1.5), curves=SurfaceLines(paths=(path_on_surface(spiral, -1.5, 1.5),)))
    seen, hidden = on_curve(vp.draw(vp.Scene((item,)), vp.Camera((3, -7, 2)), hidden="solid"))
    assert min(seen, hidden) > 5

    def failing(t):
        raise ValueError("no")

    with pytest.raises(vp.InputError, match="failing"):
        path_on_surface(failing, 0.0, 1.0)


@pytest.mark.capability("G3.0-language")
@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ('A box 1 1 1 surface_curve "t" "t" t 0 1', "'surface_curve' is for surfaces only"),
        ('A surface implicit_torus 3 1 surface_curve "t" "t" t 0 1', "with parameters u and v only"),
        ('A surface torus 3 1 surface_curve "t" t 0 1', "formula"),
        ('A surface torus 3 1 surface_curve "t" "t" 0 1', "expected 't' and its range"),
        ('A surface torus 3 1 surface_curve "t" "x" t 0 1', "x"),
        ('A surface torus 3 1 surface_curve "t" "t" t 1 1', "surface_curve: "),
    ],
)
def test_mistakes_about_them_are_told(text: str, cause: str) -> None:
    with pytest.raises(vp.InputError, match=cause) as told:
        parse_scene(text)
    assert ":1: A: " in str(told.value)


@pytest.mark.parametrize("tolerance", [1e-9, 1e-12])
def test_a_path_obeys_the_budget_and_says_so(tolerance: float) -> None:
    few = Tracing(tolerance=tolerance, budget=Budget(points=500))
    found = surface_path(TORUS, knot(2, 3), 0.0, 2 * np.pi, tracing=few)
    assert 500 < len(found.points) <= 3 * 500
    assert found.doubts and "a path is off by more than the tolerance" in found.doubts[0]
    enough = surface_path(TORUS, knot(2, 3), 0.0, 2 * np.pi, tracing=Tracing(tolerance=1e-2, budget=Budget(points=500)))
    assert not enough.doubts
