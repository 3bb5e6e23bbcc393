"""Faces that nothing is seen of: told from their sides alone, and compared with what is painted over them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot.geometry.budget import USUAL, Budget
from vectorplot.geometry.projections import projection_of
from vectorplot.pictures.fills import without_unseen_facets
from vectorplot.scene.placement import allowed_in_space
from vectorplot.scene.view import look, view_of
from vectorplot.shading.facet_resolution import faceted, picture_fineness
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.painter.unseen import unseen_faces
from vectorplot.visibility.projected_faces import project_faces

COARSE_MM = 0.6
ABOVE = vp.Camera.view("top")
EYES = [(9.0, -7.0, 5.0), (-6.0, -5.0, 12.0)]
SURFACES = {
    "waves": 'graph "sin(3*x)*cos(2*y)" x -2 2 y -2 2',
    "spring": "helical 0.4 circle 0.5 centre 3 0 0 axis 0 1 0 angle 0 800",
    "torus": "torus 3 1",
    "saddle": 'implicit "x*x-y*y-z" box -1 1 -1 1 -1 1',
    "ball": "sphere 2",
}


def square(name: str, low: float, high: float, height: float, **what) -> vp.Item:
    corners = [(low, low, height), (high, low, height), (high, high, height), (low, high, height)]
    return vp.Item(name, vp.Mesh.from_polygons(corners, [(0, 1, 2, 3)]), **what)


def unseen_in(*items: vp.Item, budget: Budget = USUAL) -> list[bool]:
    view = look(vp.Scene(items), ABOVE)
    every = np.ones(view.face_count, dtype=np.bool_)
    return unseen_faces(view, project_faces(view), every, ~every, budget.pairs).tolist()


def test_what_is_below_something_larger_is_not_seen():
    assert unseen_in(square("LOW", 1, 2, 0), square("HIGH", 0, 3, 1)) == [True, False]


def test_what_lies_in_piles_that_the_budget_does_not_do_for_is_painted_whole():
    pile = [square(f"SHEET {k}", 1 - 0.01 * k, 2 + 0.01 * k, 0.01 * k) for k in range(80)]
    assert unseen_in(*pile) == 79 * [True] + [False]
    assert not any(unseen_in(*pile, budget=Budget(pairs=1)))


def test_what_hides_nothing_covers_nothing():
    assert unseen_in(square("LOW", 1, 2, 0, occludes=False), square("HIGH", 0, 3, 1, occludes=False)) == [False, False]


def test_what_is_below_two_that_meet_is_not_seen():
    corners = [(0, 0, 1), (2, 0, 1), (2, 3, 1), (0, 3, 1), (4, 0, 1), (4, 3, 1)]
    roof = vp.Item("ROOF", vp.Mesh.from_polygons(corners, [(0, 1, 2, 3), (1, 4, 5, 2)]))
    assert unseen_in(square("LOW", 1, 2.5, 0), roof) == [True, False, False]


def test_a_gap_shows_what_is_below_it_though_none_of_its_sides_is_seen():
    """A frame around a hole that is over the middle of a face only."""
    corners = [
        (x, y, 1) for low, high in ((0, 9), (4, 5)) for x, y in ((low, low), (high, low), (high, high), (low, high))
    ]
    frame = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    assert not unseen_in(square("LOW", 1, 8, 0), vp.Item("FRAME", vp.Mesh.from_polygons(corners, frame)))[0]


def test_what_does_not_hide_covers_nothing():
    assert unseen_in(square("LOW", 1, 2, 0), square("HIGH", 0, 3, 1, occludes=False)) == [False, False]


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("eye", EYES)
@pytest.mark.parametrize("name", SURFACES)
def test_all_of_what_is_left_out_is_painted_over(name, eye, tmp_path):
    path = tmp_path / "a.scene"
    path.write_text(f"S gray surface {SURFACES[name]}\nBOX red box 1 1 1\n")
    scene = vp.read(path)
    camera = vp.Camera(eye=eye, target=(0.0, 0.0, 0.0), fov_deg=40.0)
    projection = projection_of(camera, scene.bounds)
    allowed = allowed_in_space(scene, projection, vp.Page(), True, COARSE_MM)
    coarse = faceted(scene, picture_fineness(scene, projection, False, allowed, COARSE_MM))
    view = view_of(coarse.scene, projection)
    projected = project_faces(view)
    painted = painters_order(view, projected)
    left = without_unseen_facets(coarse, view, projected, painted, USUAL)
    kept = np.isin(painted.faces.source, left.source)
    offsets = painted.faces.offsets
    rings = [painted.faces.points[:2, low:high].T for low, high in pairwise(offsets)]
    images = np.array([shapely.Polygon(ring) for ring in rings])
    below, above = shapely.STRtree(images).query(images[~kept], predicate="intersects")
    number = np.flatnonzero(~kept)
    for k, place in enumerate(number.tolist()):
        over = above[(below == k) & (above > place)]
        rest = images[place].difference(shapely.union_all(images[over]))
        assert rest.area <= 1e-9 * np.ptp(view.image, axis=1).prod()
    if name in ("waves", "spring"):
        assert len(number) > 0.1 * len(rings)
