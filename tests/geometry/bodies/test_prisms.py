"""Prisms, and holes through them."""

from __future__ import annotations

import numpy as np
import pytest
from support.drawn import drawn

import vectorplot as vp
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.solids import prism, regular_polygon
from vectorplot.geometry.winding import is_closed_oriented
from vectorplot.testing import assert_drawing_is_right
from vectorplot.textbook.polyhedra import body_record

SWEEP = [[0, 2, 0], [0, -1.4, 0], [0, -2, 0.6], [0, -2, 1.2], [0, -1.4, 1.6], [0, 2, 1.6]]

PLATE = np.array([(0, 0, 0), (60, 0, 0), (60, 40, 0), (0, 40, 0)], dtype=float)
UP = np.array([0.0, 0.0, 6.0])


@pytest.mark.capability("G3.5-translation")
def test_tv17_translational_sweep():
    body = prism(SWEEP, [-4.5, 0, 0])
    record = body_record(body)
    assert (record.vertex_count, record.edge_count, record.face_count) == (12, 18, 8)
    assert np.linalg.norm(body.area_vectors[-1]) / 2 == pytest.approx(6.1, rel=1e-14)
    assert record.volume == pytest.approx(27.45, rel=1e-14)
    assert record.area == pytest.approx(59.7633727663249, rel=1e-14)


@pytest.mark.capability("G3.5-translation")
def test_a_base_listed_the_other_way_round_gives_the_same_body():
    forward, backward = prism(SWEEP, [-4.5, 0, 0]), prism(SWEEP[::-1], [-4.5, 0, 0])
    for body in (forward, backward):
        assert is_closed_oriented(body)
        assert body_record(body).volume == pytest.approx(27.45, rel=1e-14)
        assert np.allclose(body.face_normals[-1], [-1, 0, 0])
        assert np.allclose(body.face_normals[-2], [1, 0, 0])


@pytest.mark.parametrize(
    ("base", "vector"),
    [
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [1, 2, 0]),
        ([[0, 0, 0], [1, 0, 0]], [0, 0, 1]),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [0, 0, 1]),
        ([[0, 0, 0], [1, 0, 0], [1, 1, np.nan]], [0, 0, 1]),
        ([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [0, 0, 0]),
    ],
)
def test_a_prism_without_volume_is_refused(base, vector):
    with pytest.raises(InputError):
        prism(base, vector)


def test_a_base_out_of_its_plane_is_said():
    with pytest.warns(InputWarning, match="one plane"):
        prism([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], [0, 0, 1])


def area(radius: float, count: int = 48) -> float:
    return 0.5 * count * radius**2 * np.sin(2 * np.pi / count)


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("downwards", [False, True])
@pytest.mark.parametrize("turned", [False, True])
def test_holes_go_through_whichever_way_round_they_and_the_base_are(clockwise, downwards, turned):
    holes = [regular_polygon(48, 3, centre=(8, 8, 0)), regular_polygon(48, 9, centre=(30, 20, 0)), PLATE / 20 + 50 / 3]
    holes[2][:, 2] = 0.0
    holes = [hole[::-1] for hole in holes] if clockwise else holes
    body = prism(PLATE[::-1] if turned else PLATE, -UP if downwards else UP, holes=holes)
    record, corners = body_record(body), 4 + 48 + 48 + 4
    assert is_closed_oriented(body) and len(body.vertices) == 2 * corners
    assert record.volume == pytest.approx(6 * (60 * 40 - area(3) - area(9) - 6), rel=1e-12)
    sides = 6 * (2 * (60 + 40) + 2 * 48 * (3 + 9) * np.sin(np.pi / 48) + 10)
    assert record.area == pytest.approx(2 * record.volume / 6 + sides, rel=1e-12)
    # The sides come first, those of the base before those of the holes.
    assert (body.face_sizes[:corners] == 4).all()
    assert np.abs(body.face_normals[:corners, 2]).max() < 1e-12
    assert np.abs(body.face_normals[corners:, 2]).min() == pytest.approx(1.0)


def test_a_plate_with_holes_stands_anywhere_at_any_size():
    axes = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    hole = regular_polygon(12, 4, centre=(20, 20, 0))
    for size, far in ((1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)):
        base, through = (size * points @ axes + far for points in (PLATE, hole))
        body = prism(base, size * UP @ axes, holes=[through])
        assert is_closed_oriented(body)
        assert body_record(body).volume == pytest.approx(size**3 * 6 * (2400 - area(4, 12)), rel=1e-6)


@pytest.mark.parametrize(
    ("holes", "said"),
    [
        ([PLATE], "hole 1 reaches to the outline of the base"),
        ([PLATE / 4], "hole 1 reaches to the outline of the base"),
        ([PLATE / 4 + (80, 5, 0)], "hole 1 reaches to the outline of the base"),
        ([PLATE / 4 + (5, 5, 0), PLATE / 4 + (15, 5, 0)], "holes 1 and 2 meet"),
        ([PLATE / 2 + (5, 5, 0), PLATE / 8 + (15, 15, 0)], "holes 1 and 2 meet"),
        ([PLATE / 4 + (5, 5, 1)], "hole 1 and the base do not lie in one plane"),
        ([PLATE[[0, 2, 1, 3]] / 4 + (5, 5, 0)], "hole 1 crosses itself"),
        ([PLATE[:2] / 4 + (5, 5, 0)], "hole 1 needs at least three points, not 2"),
        ([np.full((3, 3), 5.0) * (1, 1, 0)], "hole 1 crosses itself, or has no area"),
        ([PLATE[:, :2]], "hole 1: its corners must be points of three finite numbers"),
    ],
)
def test_holes_that_are_none_are_refused(holes, said):
    with pytest.raises(InputError, match=said):
        prism(PLATE, UP, holes=holes)


@pytest.mark.slow
def test_a_grating_has_a_thousand_holes_and_none_has_too_many():
    corners = np.array([(0, 0, 0), (32, 0, 0), (32, 32, 0), (0, 32, 0)])
    holes = [regular_polygon(6, 0.4, centre=(x + 0.5, y + 0.5, 0)) for x in range(32) for y in range(32)]
    body = prism(corners, UP / 6, holes=holes)
    assert is_closed_oriented(body)
    assert body_record(body).volume == pytest.approx(32 * 32 * (1 - area(0.4, 6)), rel=1e-9)
    with pytest.raises(InputError, match="5120 holes, expected at most 5000"):
        prism(corners, UP, holes=holes * 5)


def test_hollow_plates_have_all_of_a_cap_or_nothing_of_it():
    hole = regular_polygon(6, 5, centre=(20, 20, 0))
    body = prism(PLATE, UP, caps=("top",), holes=[hole])
    caps = body.face_normals[:, 2].round() != 0
    assert body.present[~caps].all() and (body.present[caps] == (body.face_normals[caps, 2] > 0)).all()


@pytest.mark.slow
def test_lines_of_a_plate_are_its_outline_and_rims_and_hidden_as_rays_see_them():
    holes = [regular_polygon(48, 9, centre=(30, 20, 0)), PLATE / 10 + (8, 8, 0)]
    scene = vp.Scene((vp.Item("PLATE", prism(PLATE, UP, holes=holes)),))
    camera = vp.Camera(eye=(90, -160, 140), target=(30, 20, 3))
    assert_drawing_is_right(vp.draw(scene, camera, hidden="solid"), scene, camera, samples=400)
    # From above: the outline and the rims, each once.
    seen = drawn(vp.draw(scene, "top")).visible
    assert seen.length == pytest.approx(200.0 + 2 * 48 * 9 * np.sin(np.pi / 48) + 20.0, rel=1e-9)


def test_regular_polygons_lie_across_their_normals():
    points = regular_polygon(7, 2.0, centre=(1, 2, 3), normal=(1, 1, 1))
    assert np.allclose(np.linalg.norm(points - (1, 2, 3), axis=1), 2.0)
    assert np.allclose((points - (1, 2, 3)) @ (1, 1, 1), 0.0)
    assert np.cross(points[0] - (1, 2, 3), points[1] - (1, 2, 3)) @ (1, 1, 1) > 0.0
    assert np.allclose(regular_polygon(4, 1.0, normal=(0, 0, -1))[0], (1, 0, 0))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"count": 2, "radius": 1.0}, "at least three corners"),
        ({"count": 5, "radius": 0.0}, "radius 0"),
        ({"count": 5, "radius": float("nan")}, "radius nan"),
        ({"count": 5, "radius": 1.0, "normal": (0, 0, 0)}, "no length"),
        ({"count": 5, "radius": 1.0, "centre": (0, 0)}, "three finite numbers"),
    ],
)
def test_regular_polygons_that_are_none_are_refused(arguments, said):
    with pytest.raises(InputError, match=said):
        regular_polygon(**arguments)
