"""A section in the plane of a border is drawn: of meshes and of smooth surfaces, at both ends."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.features.mesh_lines import mesh_plane_sections
from vectorplot.io import parse_scene

SHAPES = {
    "graph": 'surface graph "x*y" x -1 1 y -1 1',
    "cylinder": "surface cylinder 1 -1 1",
}


def grid(n: int) -> vp.Mesh:
    """A saddle over a square of n by n cells, in triangles."""
    t = np.linspace(-1.0, 1.0, n + 1)
    x, y = (part.ravel() for part in np.meshgrid(t, t))
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    b, c, d = a + 1, a + n + 2, a + n + 1
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return vp.Mesh.from_triangles(np.stack([x, y, 0.3 * x * y], axis=1), triangles)


def length(drawing: vp.Drawing) -> float:
    found = 0.0
    for paths in (paths for layer in drawing.layers for paths in layer.strokes):
        for begin, end in zip(paths.offsets[:-1], paths.offsets[1:], strict=True):
            found += float(np.hypot(*np.diff(paths.points[begin:end], axis=0).T).sum())
    return found


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("at", [-1.0, 1.0])
def test_the_lowest_and_the_highest_border_of_a_mesh_are_sections(axis: int, at: float) -> None:
    mesh = grid(5)
    normal = np.eye(3)[axis]
    for turned in (mesh, mesh.reversed()):
        curves = mesh_plane_sections(turned, normal, [at])
        assert len(curves) == 1
        assert (curves[0][:, axis] == at).all()
        assert len(curves[0]) == 6
        assert np.ptp(curves[0][:, 1 - axis]) == 2.0


def test_a_closed_mesh_has_no_section_below_itself() -> None:
    box = vp.geometry.box((1, 1, 1))
    assert len(mesh_plane_sections(box, (0, 0, 1), [0.0])) == 0
    assert len(mesh_plane_sections(box, (0, 0, 1), [1.0])) == 1


@pytest.mark.parametrize("shape", ["graph", "cylinder"])
@pytest.mark.parametrize("at", [-1.0, 1.0])
def test_borders_of_smooth_surfaces_are_sections(shape: str, at: float) -> None:
    axis = "x" if shape == "graph" else "z"
    start = f"camera eye 5 4 3 parallel S {SHAPES[shape]} sections {axis} at"
    inside = vp.draw(parse_scene(f"{start} {0.999 * at}"), lines=("section",))
    border = vp.draw(parse_scene(f"{start} {at}"), lines=("section",))
    beyond = vp.draw(parse_scene(f"{start} {1.001 * at}"), lines=("section",))
    assert length(border) > 20.0
    assert length(border) == pytest.approx(length(inside), rel=0.02)
    assert length(beyond) == 0.0


BALL = 'surface implicit "x^2 + y^2 + z^2 - 2" box -5 5 -5 5 -1 1'
PIPE = 'surface implicit "x^2 + y^2 - 1" box -5 5 -5 5 -1 1'
WAVE = 'surface implicit "sin(x)/2 - z" box -5 5 -1 1 -2 2'
RING = 'surface implicit "(x^2 + y^2 + z^2 + 8)^2 - 36*(x^2 + y^2)" box -5 5 -5 5 -2 2'
TOUCHED = [
    ("surface torus 3 1", "z at 1", 6.0 * np.pi),
    ("surface torus 3 1", "z at -1, 1", 12.0 * np.pi),
    ('surface graph "(x^2 + y^2 - 1)^2" x -1.2 1.2 y -1.2 1.2', "z at 0", 2.0 * np.pi),
    ('surface graph "sin(x)/2" x -5 5 y -2 2', "z at 0.5", 8.0),
    ("surface cylinder 1 -1 1", "x at 1", 2.0),
    (RING, "z at 1", 6.0 * np.pi),
    (WAVE, "z at 0.5", 4.0),
    (PIPE, "x at 1", 2.0),
]


def world_length(scene: vp.Scene) -> float:
    """How long the sections are in space, hidden or not."""
    found = 0.0
    for layer in vp.draw(scene, lines=("section",), hidden="solid", curves="polyline", tolerance_mm=0.005).layers:
        for paths in layer.strokes:
            long = np.linalg.norm(np.diff(paths.points3d, axis=0), axis=1)
            long[paths.offsets[1:-1] - 1] = 0.0
            found += float(long.sum())
            for begin, end in zip(paths.offsets[:-1][paths.closed], paths.offsets[1:][paths.closed], strict=True):
                found += float(np.linalg.norm(paths.points3d[begin] - paths.points3d[end - 1]))
    return found


@pytest.mark.parametrize(("shape", "planes", "expected"), TOUCHED)
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.spread
@pytest.mark.filterwarnings("error")
def test_a_plane_that_touches_a_surface_along_a_line_has_that_line_as_section(
    shape: str, planes: str, expected: float, turned: bool
) -> None:
    scene = parse_scene(f"S {shape} sections {planes}")
    # A surface that its box cuts off is another one in a turned box.
    if turned and shape not in (WAVE, PIPE):
        scene = scene.turned((1.0, 2.0, 0.5), 33.0).moved(40.0, -70.0, 20.0)
    assert world_length(scene) == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize(("shape", "expected"), [(BALL, 2.0 * np.pi), (PIPE, 2.0 * np.pi)])
@pytest.mark.parametrize("at", [-1.0, 1.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_border_of_an_implicit_surface_in_the_plane_of_a_section_is_one(
    shape: str, expected: float, at: float, side: float
) -> None:
    scene = parse_scene(f"camera eye 9 6 7 parallel S {shape} sections normal 0 0 {side} at {side * at}")
    assert world_length(scene) == pytest.approx(expected, rel=2e-3)
