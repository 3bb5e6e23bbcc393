"""Triangles as fine as a picture asks: outlines within the tolerance, shades within their bound, and few of them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import shapely
from support.line_distances import distances

from vectorplot.accuracy.approximation import on_page
from vectorplot.accuracy.of_surfaces import covered, outlines
from vectorplot.features.contours_and_isophotes import contour
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.edge_splitting import LOOKS, NONE, Edges, Vertices
from vectorplot.features.tessellation import Patch, facets
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.projections import projection_of
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.placement import allowed_in_space, default_camera
from vectorplot.scene.scene import Scene
from vectorplot.shading.facet_resolution import SHADE_ERROR, Nearby, picture_fineness
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.quadrics import Sphere, implicit_sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import ImplicitTorus, Torus, dupin_cyclide
from vectorplot.tolerances import TRUE_CONTOUR

WAVES = graph(lambda x, y: np.sin(3.0 * x) * np.cos(2.0 * y), Domain(-2.0, 2.0, -2.0, 2.0))
CLOSED = {
    "sphere": Sphere(2.0),
    "torus": Torus(3.0, 1.0),
    "implicit sphere": implicit_sphere(1.0),
    "implicit torus": ImplicitTorus(3.0, 1.0),
}


def made(surface, camera: Camera | None = None, tolerance_mm: float = 0.02):
    scene = Scene((Item("THING", surface),))
    camera = camera or default_camera(scene)
    projection = projection_of(camera, scene.bounds)
    allowed = allowed_in_space(scene, projection, Page(), True, tolerance_mm)
    criterion = picture_fineness(scene, projection, False, allowed, 0.02)(0)
    return facets(surface, criterion), criterion


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("name", CLOSED)
@pytest.mark.parametrize("eye", [(8.0, -16.0, 11.0), (3.0, 20.0, -4.0)])
def test_neighbours_of_different_sizes_share_their_vertices(name, eye):
    found, _ = made(CLOSED[name], Camera(eye=eye, target=(0.0, 0.0, 0.0), fov_deg=30.0))
    corners = found.mesh.corners.reshape(-1, 3)
    edges = np.stack((corners, np.roll(corners, -1, axis=1)), axis=2).reshape(-1, 2)
    assert (np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)[1] == 2).all()
    assert len(np.unique(edges, axis=0)) == len(edges), "and turn the same way"


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [0.02, 0.2])
def test_the_outline_of_a_ball_is_within_the_tolerance(tolerance):
    camera = Camera(eye=(8.0, -16.0, 11.0), target=(0.0, 0.0, 0.0), fov_deg=26.0)
    (fills,) = paint(Scene((Item("BALL", Sphere(2.0)),)), camera, tolerance_mm=tolerance).layers[0].marks
    seen = covered(fills.points, fills.offsets)
    angle = np.arcsin(2.0 / np.linalg.norm(camera.eye))
    # Seen from the eye in its middle, a ball is a disc; it fills the width of the page inside the margins.
    assert 0.0 < angle < 0.2
    ring = shapely.get_coordinates(shapely.segmentize(shapely.get_exterior_ring(seen), 0.1))
    radius = np.linalg.norm(ring - (105.0, 148.5), axis=1)
    assert radius.max() <= 95.0 + tolerance
    assert radius.min() >= 95.0 - 1.5 * tolerance


def border(surface):
    """The border of the domain of an open surface, in space."""
    domain = surface.domain
    t = np.linspace(0.0, 1.0, 2001)
    u, v = domain.u_start + t * domain.size[0], domain.v_start + t * domain.size[1]
    sides = (
        (u, 0 * v + domain.v_start),
        (u, 0 * v + domain.v_end),
        (0 * u + domain.u_start, v),
        (0 * u + domain.u_end, v),
    )
    return [np.asarray(surface.points(*side)) for side in sides]


OUTLINED = {
    "sphere": (Sphere(2.0), ()),
    "thick torus": (Torus(3.0, 1.2), ()),
    "thin torus": (Torus(3.0, 0.3), ()),
    "waves": (WAVES, border(WAVES)),
}


@cache
def true_outlines(name, eye):
    """What the outlines of a surface are in space, found once for all tolerances."""
    surface, borders = OUTLINED[name]
    true = contour(surface, eye, tracing=Tracing(tolerance=TRUE_CONTOUR))
    return [*(true[k] for k in range(len(true))), *borders]


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("tolerance", [0.01, 1.0, 0.02, 0.1])
@pytest.mark.parametrize("eye", [(7.0, -5.0, 14.0), (8.0, -16.0, 11.0), (3.0, 20.0, -8.0)])
@pytest.mark.parametrize("name", OUTLINED)
def test_outlines_are_within_the_tolerance_whatever_it_is(name, eye, tolerance):
    """Sides that run along a fold are those of the outline, whichever way narrow triangles beside it turn."""
    surface, _ = OUTLINED[name]
    drawing = paint(Scene((Item("THING", surface),)), Camera(eye=eye), shadows="none", tolerance_mm=tolerance)
    lines = [on_page(drawing.page_from_world, line) for line in true_outlines(name, eye)]
    found = shapely.segmentize(shapely.MultiLineString(outlines(drawing)), 0.25)
    off = distances(shapely.get_coordinates(found), lines)
    assert off.max() <= 1.4 * tolerance, off.max() / tolerance


@pytest.mark.slow
@pytest.mark.parametrize("surface", [Sphere(2.0), Torus(3.0, 1.0), WAVES], ids=["sphere", "torus", "waves"])
def test_shades_between_corners_are_within_their_bound(surface):
    found, criterion = made(surface)
    corners = found.mesh.corners.reshape(-1, 3)
    random = np.random.default_rng(3)
    weights = random.dirichlet((1.0, 1.0, 1.0), len(corners))

    def shades(normals, points):
        folds = criterion.folds(points, normals)
        return 0.8 * np.where(folds[1] * np.sign(folds[0]) > 0.0, np.abs(folds[1]), 0.3 * np.abs(folds[1]))

    points = found.mesh.vertices[corners]
    normals = np.nan_to_num(found.normals[corners])
    middle = np.einsum("tk,tki->ti", weights, points)
    between = np.einsum("tk,tki->ti", weights, normals)
    between /= np.linalg.norm(between, axis=1)[:, None]
    side = np.sign(criterion.folds(middle, between)[0])
    at_corners = np.stack([shades(normals[:, k] * side[:, None], points[:, k]) for k in range(3)], axis=1)
    of_side = np.stack([np.sign(criterion.folds(points[:, k], normals[:, k])[0]) == side for k in range(3)], axis=1)
    off = np.abs((weights * at_corners).sum(axis=1) - shades(between * side[:, None], middle))
    assert np.quantile(off[of_side.all(axis=1)], 0.99) < 2.0 * SHADE_ERROR


@pytest.mark.slow
def test_a_coarser_tolerance_makes_fewer_polygons():
    cyclide = dupin_cyclide(3.0, 1.0, (6.5, 0.0, 0.0), 5.0)
    counts = [made(cyclide, tolerance_mm=t)[0].mesh.face_count for t in (0.01, 0.05, 0.4)]
    assert counts[0] > 1.3 * counts[1] > 1.5 * counts[2]


@pytest.mark.slow
@pytest.mark.parametrize(("surface", "most"), [(Torus(3.0, 1.0), 3_000), (Sphere(2.0), 2_000), (WAVES, 12_000)])
def test_pictures_have_few_polygons(surface, most):
    (fills,) = paint(Scene((Item("THING", surface),))).layers[0].marks
    assert 50 < len(fills) < most


@pytest.mark.slow
def test_boxes_of_other_items_count_where_they_meet_and_once():
    """A crowd costs no box for each pair: those that lie elsewhere, and copies in one place, add nothing."""
    balls = [Sphere(1.0)] * 50 + [Sphere(1.0, (5.0 * k, 0.0, 0.0)) for k in range(1, 50)]
    scene = Scene(tuple(Item(f"BALL{number}", ball) for number, ball in enumerate(balls)))
    projection = projection_of(default_camera(scene), scene.bounds)
    criterion = picture_fineness(
        scene, projection, False, allowed_in_space(scene, projection, Page(200, 150), True, 0.02), 0.02
    )
    assert [len(criterion(number).others[0]) for number in (0, 49, 60)] == [1, 1, 0]


def test_what_is_near_is_looked_for_only_where_it_tells(monkeypatch):
    """Sides that are too coarse are so by as much as if all were compared with all other items; and few are."""
    rings = [Item("A", Torus(1.0, 0.3)), Item("B", Torus(1.0, 0.31)), Item("C", implicit_sphere(0.5))]
    scene = Scene(tuple(rings))
    projection = projection_of(default_camera(scene), scene.bounds)
    allowed = allowed_in_space(scene, projection, Page(), True, 0.02)
    criterion = picture_fineness(scene, projection, False, allowed, 0.02)(0)
    sought = []
    distances = Nearby.distances
    monkeypatch.setattr(Nearby, "distances", lambda *of: sought.append(len(of[1])) or distances(*of))
    torus, rng = Patch(rings[0].shape, ()), np.random.default_rng(3)
    for length in (0.03, 0.1, 0.4):
        start = np.column_stack([rng.uniform(0.0, 5.0, (300, 2)), np.zeros(300)])
        way = np.column_stack([rng.uniform(-length, length, (300, 2)), np.zeros(300)])
        t = np.repeat(np.array([*LOOKS, 0.4])[:, None], 300, axis=1)
        looks = torus.at((start + t[..., None] * way).reshape(-1, 3))
        at = Vertices(*(some.reshape(4, 300, -1) for some in (looks.places, looks.points, looks.normals)))
        fold = np.where(rng.uniform(size=t.shape) < 0.1, 0, NONE)
        edges = Edges(torus.at(start), torus.at(start + way), at, t, fold)
        all_, before = criterion.error_ratio(edges), sum(sought)
        some, after = criterion.too_coarse(edges), sum(sought)
        assert np.array_equal(np.maximum(some, 1.0), np.maximum(all_, 1.0))
        assert (all_ > 1.0).any() or length < 0.1
        if length < 0.1:
            assert after - before < 0.5 * before
