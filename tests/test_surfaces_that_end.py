"""Textbook surfaces with poles, jumps and singular lines: drawn in seconds, right against rays, or with one line."""

from __future__ import annotations

import resource
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from support.drawn import drawn as measured
from support.effort import several
from support.pace import cpu_seconds

import vectorplot as vp
from vectorplot.curves import Circle, Loxodrome
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.expressions import parse_expression
from vectorplot.io.shape_arguments import Formulas, formula_graph, formula_implicit
from vectorplot.surfaces import Domain, minimal_spiral_surface
from vectorplot.surfaces.swept import Rotoid, Swept
from vectorplot.testing import assert_drawing_is_right
from vectorplot.testing.drawings import stroke_points

PAGE = vp.Page(100, 100, 5)
SECONDS, MEGABYTES = 25.0, 1500.0
"""Of the processor, and beyond what the process had before; without limits none of these ended in either."""


def graph_of(text: str) -> object:
    return formula_graph(Formulas((parse_expression(text, ("x", "y")),)), Domain(-2.0, 2.0, -2.0, 2.0))


def implicit_of(text: str, size: float) -> object:
    box = [[-size] * 3, [size] * 3]
    return formula_implicit(Formulas((parse_expression(text, ("x", "y", "z")),)), box)


@contextmanager
def no_more_memory_than(megabytes: float) -> Iterator[None]:
    """A MemoryError for whoever asks for more than so much on top of what the process already has.

    The peak of the process would tell of other tests, too, that ran in it before.
    """
    size_in_pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    limit = size_in_pages * resource.getpagesize() + int(megabytes * 2**20)
    resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def drawn(
    shape: object, lines: int = 5, budget: float = 0.25, **options: object
) -> tuple[vp.Scene, vp.Camera, vp.Drawing, list[str]]:
    """The surface drawn, with a part of the usual budget: limits are met sooner."""
    scene = vp.Scene((vp.Item("S", shape, curves=vp.SurfaceLines(lines, lines)),))
    low, high = scene.bounds
    target = (low + high) / 2.0
    eye = target + np.array([3.0, -5.0, 3.5]) * (high - low).max()
    camera = vp.Camera(tuple(eye.tolist()), tuple(target.tolist()))
    with cpu_seconds(SECONDS), no_more_memory_than(MEGABYTES), warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", InputWarning)
        drawing = vp.draw(scene, camera, page=PAGE, hidden="solid", budget=budget, **options)
    lines = [str(warning.message) for warning in said]
    # Whatever is in doubt about a surface is one line.
    assert len({line.split(": ")[0] for line in lines if "runs to infinity" not in line}) == len(
        [line for line in lines if "runs to infinity" not in line]
    )
    return scene, camera, drawing, lines


@pytest.mark.slow
def test_graphs_with_poles_are_cut_off_and_right() -> None:
    scene, camera, drawing, said = drawn(graph_of("0.3/hypot(x,y)"), lines=3, budget=0.125)
    assert any(line.startswith("S: runs to infinity: shown is z from ") for line in said)
    assert assert_drawing_is_right(drawing, scene, camera, samples=200) > 40


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("text", ["1/(x^2+y^2)", "1/(x*y)"])
def test_graphs_with_poles_of_higher_order_end(text: str) -> None:
    _, _, drawing, said = drawn(graph_of(text), lines=2)
    assert any(line.startswith("S: runs to infinity: shown is z from ") for line in said)
    assert any(len(mark) for layer in drawing.layers for mark in layer.marks)


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("text", ["x^y", "1/sin(x*y)"])
def test_curves_beside_poles_and_holes_end_where_the_surface_does(text: str) -> None:
    scene = vp.Scene((vp.Item("S", graph_of(text)),))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        with cpu_seconds(SECONDS):
            drawing = vp.draw(scene, vp.Camera((5.0, -7.0, 4.0)), page=PAGE)
    strokes = [paths.points for layer in drawing.layers for paths in layer.strokes]
    assert strokes and all(np.isfinite(points).all() for points in strokes)


def stroke_ends(drawing: vp.Drawing) -> np.ndarray:
    """(n,3) the first and the last point in space of every stroke."""
    found = [
        paths.points3d[[*paths.offsets[:-1], *(paths.offsets[1:] - 1)]]
        for layer in drawing.layers
        for paths in layer.strokes
        if len(paths)
    ]
    return np.concatenate(found)


@pytest.mark.slow
def test_a_graph_with_a_jump_has_no_wall() -> None:
    scene, camera, drawing, _ = drawn(graph_of("atan2(y,x)"))
    found = stroke_points(drawing, scene, camera, 4000, 0).points
    # On the graph, and so nowhere between the heights on both sides of the negative x-axis.
    beside = found[(np.abs(found[:, 1]) < 0.05) & (found[:, 0] < -0.3)]
    assert len(beside) and (np.abs(beside[:, 2]) > 2.9).all()
    # Three lines come from both sides all the way up to it.
    ends = stroke_ends(drawing)
    ends = ends[(np.abs(ends[:, 1]) < 1e-4) & (ends[:, 0] < -0.3)]
    assert min(np.count_nonzero(ends[:, 2] > 0.0), np.count_nonzero(ends[:, 2] < 0.0)) >= 3


@pytest.mark.slow
def test_waves_finer_than_any_resolution_end_and_say_what_is_left_out() -> None:
    _, _, drawing, said = drawn(graph_of("sin(1/hypot(x,y))"), lines=0)
    assert any("wind more finely than the resolution" in line for line in said)
    assert any(len(mark) for layer in drawing.layers for mark in layer.marks)


@pytest.mark.slow
@pytest.mark.parametrize("text", ["x*y", "y^2-x^3"])
def test_implicit_surfaces_with_singular_lines_end_and_are_drawn_whole(text: str) -> None:
    _, _, drawing, said = drawn(implicit_of(text, 1.0))
    kinds = {vp.LineKind(kind).word for kind in measured(drawing).kind.tolist()}
    strokes = sum(len(mark) for layer in drawing.layers for mark in layer.marks)
    # Two rectangles and the line in which they cross; nothing is in doubt.
    assert not said and (strokes == 3 or text != "x*y")
    assert kinds >= ({"boundary", "intersection"} if text == "x*y" else {"boundary", "crease"})


@pytest.mark.slow
def test_a_budget_that_does_not_do_is_one_line_and_a_larger_one_does() -> None:
    waves = graph_of("0.3*sin(5*x)*cos(4*y)")
    *_, poor = drawn(waves, budget=0.01)
    *_, rich = drawn(waves, budget=1.0)
    told = [line for line in poor if line.endswith("a larger budget may do (--budget)")]
    assert told and all(line.startswith("S: ") for line in told)
    assert not rich
    for verb in (vp.draw, vp.paint, vp.render):
        with pytest.raises(InputError, match="a budget of"):
            verb(vp.Scene((vp.Item("S", waves),)), budget=-1.0)


def test_the_bar_moves_while_smooth_surfaces_are_drawn() -> None:
    told: list[tuple[str, float]] = []
    drawn(graph_of("x*y"), progress=lambda stage, part: told.append((stage, part)))
    parts = [part for stage, part in told if stage in ("curves", "smooth surfaces")]
    assert len(set(parts)) >= 7 and parts == sorted(parts)


@pytest.mark.slow
def test_waves_finer_than_any_resolution_are_painted_too() -> None:
    scene = vp.Scene((vp.Item("S", graph_of("sin(1/hypot(x,y))")),))
    with cpu_seconds(0.25 * SECONDS), no_more_memory_than(MEGABYTES), warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        drawing = vp.paint(scene, vp.Camera((5.0, -7.0, 5.0), (0.0, 0.0, 0.0)), page=PAGE, budget=0.0625)
    (fills,) = drawing.layers[0].marks
    # As many triangles as the budget has, and as many more for their shades at most.
    assert 1 << 12 < len(fills) <= 1 << 15


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("text", ["1/(x*y)", "1/x", "1/(x^2-y^2)", "1/(x^2-1)"])
def test_graphs_with_holes_at_their_borders_are_painted(text: str) -> None:
    scene = vp.Scene((vp.Item("S", graph_of(text)),))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        drawing = vp.paint(
            scene, vp.Camera((1.0, -2.0, 30.0), (0.0, 0.0, 0.0), parallel=True), tolerance_mm=0.5, budget=0.02
        )
    (fills,) = drawing.layers[0].marks
    # Its square is shown, less what is cut off.
    assert len(fills) > 50 and (np.ptp(fills.points, axis=0) > 50.0).all()


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("lamps", [1, 4])
def test_waves_without_an_end_are_painted_in_the_light_of_lamps(lamps: int) -> None:
    places = [(3.0, -2.0, 5.0), (-4.0, -3.0, 4.0), (1.0, -3.0, 4.0), (0.0, 4.0, 3.0)][:lamps]
    lights = tuple(vp.Light(place, name=f"L{k}") for k, place in enumerate(places))
    scene = vp.Scene((vp.Item("WAVES", graph_of("sin(1/hypot(x,y))")),), lights=lights)
    with cpu_seconds(0.25 * SECONDS), no_more_memory_than(MEGABYTES), warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", InputWarning)
        drawing = vp.paint(scene, vp.Camera((5.0, -7.0, 5.0), (0.0, 0.0, 0.0)), page=PAGE, budget=0.1)
    (line,) = [str(entry.message) for entry in caught if "shadows" in str(entry.message)]
    assert line.startswith("WAVES: ") and ", ".join(light.name for light in lights) in line
    (fills,) = drawing.layers[0].marks
    assert len(fills) > 1 << 13


@pytest.mark.slow
@pytest.mark.parametrize(
    "surface",
    [
        minimal_spiral_surface(5.0),
        Swept(Circle(radius=1.7), Rotoid(3.1, -1.0), 0.0, 2.0 * np.pi),
        Swept(Loxodrome(3.2, np.pi / 2.0), Rotoid(3.9, -0.7), 0.0, 2.0 * np.pi),
    ][: several(1, long=3)],
)
def test_surfaces_that_cover_themselves_and_wind_into_points_end(surface: object) -> None:
    _, _, drawing, _ = drawn(surface, lines=0, budget=0.0625)
    # No chord leads across the picture from one round of the surface to another.
    for points in (
        mark.points[a:b] for layer in drawing.layers for mark in layer.strokes for a, b in pairwise(mark.offsets)
    ):
        assert np.linalg.norm(np.diff(points, axis=0), axis=1).max(initial=0.0) < 25.0


@pytest.mark.slow
@pytest.mark.parametrize("text", ["floor(x)", "floor(2*x+y)", "sign(x)*(1-y^2/4)", "sign(x+0.3)+sign(y-0.2)"])
def test_lines_are_interrupted_where_a_graph_jumps(text: str) -> None:
    scene, camera, drawing, _ = drawn(graph_of(text))
    found = stroke_points(drawing, scene, camera, 4000, 0).points
    formula = parse_expression(text, ("x", "y"))

    def off(points: np.ndarray, dx: float, dy: float) -> np.ndarray:
        """How far points are from the heights a little beside them."""
        return np.abs(points[:, 2] - formula(x=points[:, 0] + dx, y=points[:, 1] + dy))

    beside = [(1e-3, 0.0), (-1e-3, 0.0), (0.0, 1e-3), (0.0, -1e-3)]
    assert len(found) > 1000 and np.minimum.reduce([off(found, *way) for way in [(0.0, 0.0), *beside]]).max() < 0.02
    # Lines come up to the jump: just beside their ends there is another height.
    assert np.count_nonzero(np.maximum.reduce([off(stroke_ends(drawing), *way) for way in beside]) > 0.02) >= 8
