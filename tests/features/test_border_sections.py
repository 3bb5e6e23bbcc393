"""A section in the plane of a border is drawn: of meshes and of smooth surfaces, at both ends."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.features import mesh_plane_sections
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
