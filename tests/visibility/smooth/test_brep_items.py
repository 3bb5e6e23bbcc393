"""Bodies that are drawn from the surfaces of their faces."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from support.breps import HEIGHT, RADIUS, rod, rod_item
from support.drawn import drawn

import vectorplot as vp
from vectorplot.errors import InputWarning
from vectorplot.scene.exact_bodies import exact_bodies
from vectorplot.surfaces import rod as round_rod
from vectorplot.words import DRAWN, LineKind, line_kinds

EYE = np.array([3.0, -7.0, 9.0])


def strokes(drawing: vp.Drawing, kind: LineKind, hidden: bool = False) -> list[np.ndarray]:
    """The points in space of the strokes of a kind."""
    return [
        paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
        for layer in drawing.layers
        for paths in layer.strokes
        for k in range(len(paths))
        if paths.kind[k] == kind and (paths.hidden_by[k] > 0) == hidden
    ]


@pytest.mark.slow
def test_the_outline_of_a_rod_is_two_rulings_and_its_rims():
    camera = vp.Camera(tuple(EYE), (0.0, 0.0, 1.0))
    drawing = vp.draw(rod_item(), camera, hidden="solid")
    points = np.concatenate(strokes(drawing, LineKind.CONTOUR))
    # Rulings turn away from the eye where x e_x + y e_y = r^2; all else of the outline is on the rims.
    off = np.abs(points[:, :2] @ EYE[:2] - RADIUS**2)
    on_rim = np.minimum(np.abs(points[:, 2]), np.abs(points[:, 2] - HEIGHT)) < 1e-9
    assert np.minimum(off, np.where(on_rim, 0.0, np.inf)).max() < 1e-9
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - RADIUS).max() < 1e-7
    # From above the far half of the lower rim is hidden, and nothing else.
    (lower,) = strokes(drawing, LineKind.CREASE, hidden=True)
    assert np.abs(lower[:, 2]).max() < 1e-12
    assert (lower[:, :2] @ EYE[:2]).max() < RADIUS**2 + 1e-6
    assert not strokes(drawing, LineKind.CONTOUR, hidden=True)


@pytest.mark.slow
def test_rims_leave_as_arcs_and_circles(tmp_path):
    scene = vp.Scene((rod_item(),))
    for view, words in (("top", {"CIRCLE": 1}), ("front", {"LWPOLYLINE": 1})):
        vp.save(vp.draw(scene, view), tmp_path / "rod.dxf")
        lines = (tmp_path / "rod.dxf").read_text().split("\n")
        found = {word: lines.count(word) for word in ("CIRCLE", "ELLIPSE", "SPLINE", "LWPOLYLINE", "ARC")}
        assert {word: count for word, count in found.items() if count} == words


@pytest.mark.slow
def test_a_rod_along_the_line_of_sight_is_a_circle():
    for height in (9.0, -9.0):
        drawing = vp.draw(rod_item(), vp.Camera((0.0, 0.0, height), up=(0, 1, 0), parallel=True), hidden="solid")
        (outline,) = strokes(drawing, LineKind.CONTOUR)
        assert np.abs(np.hypot(outline[:, 0], outline[:, 1]) - RADIUS).max() < 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("size", [1e-6, 1e6])
def test_size_and_place_do_not_matter(size: float):
    camera = vp.Camera(tuple(EYE), (0.0, 0.0, 1.0))
    usual = vp.draw(rod_item(), camera, hidden="solid")
    far = np.array([4e5, -3e5, 2e5]) * size
    item = rod_item().scaled(size).moved(*far)
    moved = vp.Camera(tuple(size * EYE + far), tuple(np.array([0.0, 0.0, size]) + far))
    drawing = vp.draw(item, moved, hidden="solid")
    for kind in (LineKind.CONTOUR, LineKind.CREASE):
        for hidden in (False, True):
            assert len(strokes(drawing, kind, hidden)) == len(strokes(usual, kind, hidden))
    lengths = [
        sum(float(np.hypot(*np.diff(p.points, axis=0).T).sum()) for layer in d.layers for p in layer.strokes)
        for d in (usual, drawing)
    ]
    assert lengths[1] == pytest.approx(lengths[0], rel=1e-6)


def _bar() -> vp.Mesh:
    """A bar across the rod, in front of it."""
    return vp.Mesh.from_triangles([(-3, -2, 1), (3, -2, 1), (3, -2, 1.2), (-3, -2, 1.2)], [(0, 1, 2), (0, 2, 3)])


def test_a_body_hides_others_and_is_hidden():
    wall = vp.Item("wall", vp.Mesh.from_triangles([(-3, 2, -1), (3, 2, -1), (0, 2, 5)], [(0, 1, 2)]))
    pole = vp.Item(
        "pole", vp.Mesh.from_triangles([(-3, -2, 1), (3, -2, 1), (3, -2, 1.2), (-3, -2, 1.2)], [(0, 1, 2), (0, 2, 3)])
    )
    scene = vp.Scene((wall, rod_item(), pole))
    drawing = vp.draw(scene, vp.Camera((0.0, -30.0, 1.0), (0.0, 0.0, 1.0), parallel=True), hidden="solid")
    hidden = {
        (drawing.items[int(paths.item[k])], int(paths.hidden_by[k]))
        for layer in drawing.layers
        for paths in layer.strokes
        for k in range(len(paths))
    }
    assert {("wall", 0), ("rod", 0), ("rod", 1), ("pole", 0)} <= hidden
    assert ("pole", 1) not in hidden
    visible = [
        paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
        for layer in drawing.layers
        for paths in layer.strokes
        for k in range(len(paths))
        if drawing.items[int(paths.item[k])] == "rod" and paths.hidden_by[k] == 0
    ]
    assert not any(((p[:, 2] > 1.01) & (p[:, 2] < 1.19)).any() for p in visible)


@pytest.mark.slow
def test_bodies_that_pierce_each_other_meet_where_one_asks_for_it():
    across = rod_item("across").turned("x", 90.0).scaled(0.5).moved(0.0, -0.2, 1.0)
    scene = vp.Scene((rod_item(), across))
    camera = vp.Camera((4.0, -9.0, 7.0), (0.0, 0.0, 1.0))
    assert not strokes(vp.draw(scene, camera), LineKind.INTERSECTION)
    met = strokes(vp.draw(scene, camera, lines=DRAWN), LineKind.INTERSECTION)
    points = np.concatenate(met)
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - 1.0).max() < 1e-6
    assert np.abs(np.hypot(points[:, 0], points[:, 2] - 1.0) - 0.5).max() < 1e-6


def test_only_kinds_of_lines_that_are_asked_for_keep_a_body_from_its_surfaces():
    item = replace(rod_item(), curves=vp.SurfaceLines(isophotes=(0.5,)))
    with pytest.warns(InputWarning, match="not exactly, for lines of kind isophote$"):
        (left,) = exact_bodies(vp.Scene((item,)), line_kinds((*DRAWN, "isophote", "section", "parameter")), None).items
    assert left.shape is rod().mesh
    (made,) = exact_bodies(vp.Scene((item,)), line_kinds("contour,section"), None).items
    assert made.shape is rod()


@pytest.mark.slow
def test_what_only_triangles_have_is_drawn_from_them_and_said():
    scene = vp.Scene((rod_item(),))
    kinds = line_kinds(DRAWN)
    (item,) = exact_bodies(scene, kinds, None).items
    assert item.shape is rod()
    with pytest.warns(InputWarning, match="rod: drawn from triangles, not exactly, for it is hatched"):
        (item,) = exact_bodies(scene, kinds, vp.Hatching(by="tone")).items
    assert item.shape is rod().mesh
    with pytest.warns(InputWarning, match="it is cut"):
        drawing = vp.draw(vp.cut(scene, "x>0"), vp.Camera(tuple(EYE), (0.0, 0.0, 1.0)))
    assert max(p.points3d[:, 0].max() for layer in drawing.layers for p in layer.strokes if len(p)) < 1e-9
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        vp.paint(scene, vp.Camera(tuple(EYE), (0.0, 0.0, 1.0)))
    assert math.isclose(rod().bounds[1, 2], HEIGHT)


@pytest.mark.slow
@pytest.mark.parametrize("lines", ["crease", "crease,shadow"])
@pytest.mark.parametrize("body", [rod_item(), vp.Item("round", round_rod((0, 0, 0), (0, 0, HEIGHT), RADIUS))])
def test_rims_are_whole_where_creases_are_asked_for_and_contours_are_not(body, lines):
    drawing = vp.draw(vp.Scene((body,)), vp.Camera((50, 40, 30)), lines=lines, hidden="solid", curves="polyline")
    assert drawn(drawing).of_kind("crease").length == pytest.approx(4.0 * np.pi * RADIUS, rel=1e-3)
