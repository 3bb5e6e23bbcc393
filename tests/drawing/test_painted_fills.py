"""Painted polygons on the page, and others between them; pictures made of them as a whole."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from support.paths import DATA

import vectorplot as vp
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, interleaved, overlaid
from vectorplot.geometry.regions import polygons_of
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box
from vectorplot.visibility.painter.image_faces import framed_faces
from vectorplot.visibility.painter.painters_order import painters_order


def triangles(count: int, item: int) -> Fills:
    points = np.tile([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], (count, 1))
    return Fills.flat(points, np.arange(0, 3 * count + 1, 3), np.zeros((count, 3), np.uint8), item=item)


def test_overlays_come_after_their_polygons_in_turn() -> None:
    one = Overlay(triangles(3, 1), np.array([0, 2, 2]))
    two = Overlay(triangles(2, 2), np.array([2, 0]))
    assert interleaved(triangles(3, 0), [one, two]).item.tolist() == [0, 1, 2, 0, 0, 1, 1, 2]
    inner = overlaid(Overlay(triangles(2, 0), np.array([5, 7])), [Overlay(triangles(1, 1), np.array([1]))])
    assert inner.fills.item.tolist() == [0, 0, 1] and inner.after.tolist() == [5, 7, 7]
    base = triangles(2, 0)
    assert interleaved(base, [Overlay(Fills.empty(), np.zeros(0, dtype=np.intp))]) is base


def test_faces_are_cut_at_the_frame_and_keep_their_order() -> None:
    scene = vp.Scene((vp.Item("A", box((-1, -1, 0), (1, 1, 1))), vp.Item("B", box((2, 2, 0), (3, 3, 1)))))
    view = look(scene, vp.Camera((0, 0, 1), (0, 0, 0), parallel=True))
    faces = painters_order(view).faces
    low, high = np.array([0.0, 0.0]), np.array([0.7, 0.7])
    cut = framed_faces(faces, low, high, view.tolerance)
    assert (cut.box[0] >= low[0] - 1e-12).all() and (cut.box[1] <= high[0] + 1e-12).all()
    places = [int(np.flatnonzero(faces.source == source)[0]) for source in cut.source]
    assert places == sorted(places) and 0 < len(cut) <= len(faces)
    assert framed_faces(faces, low - 100.0, high + 100.0, view.tolerance) is faces


def test_a_picture_fills_the_page_but_for_its_margin() -> None:
    page = vp.Page(100, 80, 7)
    drawing = vp.paint(vp.read(DATA / "cubes.scene"), page=page)
    points = drawing.layers[0].fills[0].points
    low, high = points.min(axis=0), points.max(axis=0)
    assert low.min() == pytest.approx(7.0) and (low >= 7.0 - 1e-9).all()
    assert (high <= np.array([93.0, 73.0]) + 1e-9).all()


def test_without_fit_the_target_is_in_the_middle_and_nothing_leaves_the_margins() -> None:
    scene = vp.read(DATA / "cubes.scene")
    page = vp.Page(60, 40, 5)
    drawing = vp.paint(scene, page=page, fit=False)
    fills = drawing.layers[0].fills[0]
    assert (fills.points >= 5.0 - 1e-9).all() and (fills.points <= np.array([55.0, 35.0]) + 1e-9).all()
    target = drawing.page_from_world @ [*scene.camera.target, 1.0]
    assert target[:2] / target[3] == pytest.approx([30.0, 20.0])


@pytest.mark.slow
@pytest.mark.parametrize("parallel", [False, True])
def test_points_in_space_have_their_places_on_the_page(parallel: bool) -> None:
    scene = vp.read(DATA / "mixed.scene")
    camera = replace(scene.camera, parallel=parallel)
    drawing = vp.paint(scene, camera, page=vp.Page(60, 40, 2), tolerance_mm=2.0)
    fills = drawing.layers[0].fills[0]
    image = np.c_[fills.points3d, np.ones(len(fills.points3d))] @ drawing.page_from_world.T
    assert np.abs(image[:, :2] / image[:, 3:] - fills.points).max() < 1e-9


@pytest.mark.parametrize("parallel", [False, True])
def test_lines_on_top_lie_on_the_borders_of_the_polygons(parallel: bool) -> None:
    import shapely

    scene = vp.read(DATA / "cubes.scene")
    camera = replace(scene.camera, parallel=parallel)
    drawing = vp.paint(scene, camera, lines=("contour", "crease"))
    assert drawing.layers[0].name == "fills" and len(drawing.layers) > 1
    rings = shapely.get_exterior_ring(
        polygons_of(drawing.layers[0].fills[0].points.T, drawing.layers[0].fills[0].offsets)
    )
    ends = np.concatenate([paths.points for layer in drawing.layers[1:] for paths in layer.strokes])
    away = shapely.STRtree(rings).query_nearest(shapely.points(ends), return_distance=True, all_matches=False)[1]
    assert away.max() < 1e-6


@pytest.mark.capability("G7.1-screen-hl")
def test_erasing_leaves_blank_faces_and_their_edges() -> None:
    scene = vp.read(DATA / "patterns.scene")
    drawing = vp.paint(scene, fills="erasing")
    fills = drawing.layers[0].fills[0]
    lines = np.diff(fills.offsets) == 2
    assert (fills.kind[lines] == FillKind.EDGE).all() and (fills.kind[~lines] == FillKind.BACKGROUND).all()
    first = fills.colours[fills.offsets[:-1]]
    assert (first[~lines] == 255).all() and (first[lines] < 255).any(axis=1).all()
    assert lines.sum() >= 9 and not lines[0]
    colours = {pattern.colour for item in scene.items for pattern in item.patterns}
    assert len(np.unique(first[lines], axis=0)) >= len(colours)


@pytest.mark.slow
def test_smooth_surfaces_are_shaded_from_corner_to_corner_or_flat() -> None:
    scene = vp.read(DATA / "torus.scene")
    for smooth in (True, False):
        fills = vp.paint(scene, smooth=smooth, tolerance_mm=0.5).layers[0].fills[0]
        first = np.repeat(fills.colours[fills.offsets[:-1]], np.diff(fills.offsets), axis=0)
        assert (fills.colours == first).all() != smooth


@pytest.mark.slow
def test_the_tolerance_decides_how_many_facets_there_are() -> None:
    scene = vp.read(DATA / "torus.scene")
    counts = [len(vp.paint(scene, tolerance_mm=tolerance).layers[0].fills[0]) for tolerance in (0.5, 0.05)]
    assert 1.3 < counts[1] / counts[0] < 20


@pytest.mark.slow
def test_erasing_draws_the_outlines_of_smooth_surfaces_and_none_of_their_facets() -> None:
    scene = vp.read(DATA / "torus.scene")
    fills = vp.paint(scene, fills="erasing", lines=("contour",), tolerance_mm=0.1).layers[0].fills[0]
    lines = np.flatnonzero(np.diff(fills.offsets) == 2)
    points = fills.points3d[fills.offsets[lines]]
    ring = points * [1.0, 1.0, 0.0]
    normal = points - 3.0 * ring / np.linalg.norm(ring, axis=1, keepdims=True)
    sight = np.asarray(scene.camera.eye) - points
    cosine = (normal * sight).sum(axis=1) / np.linalg.norm(sight, axis=1)
    assert 50 < len(lines) < 1000 and np.abs(cosine).max() < 1e-3


def test_erasing_puts_lines_after_all_polygons_that_touch_them() -> None:
    scene = vp.read(DATA / "interpenetrating.scene")
    fills = vp.paint(scene, fills="erasing").layers[0].fills[0]
    shapes = [shapely.Polygon(p) for p in np.split(fills.points, fills.offsets[1:-1]) if len(p) > 2]
    places = np.flatnonzero(np.diff(fills.offsets) > 2)
    lines = np.flatnonzero(np.diff(fills.offsets) == 2)
    for line in lines.tolist():
        near = shapely.distance(shapely.LineString(fills.points[fills.offsets[line] : fills.offsets[line + 1]]), shapes)
        assert (places[near < 0.149] < line).all()
    assert (np.diff(lines) > 1).any()
