"""Roads with hairpin bends on terrains."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features
from vectorplot.errors import InputError
from vectorplot.features.terrain_serpentines import draped
from vectorplot.features.terrain_water import Ground, places_on_terrain
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import Serpentine
from vectorplot.scene.terrains import terrain_mesh
from vectorplot.surfaces.terrains import terrain
from vectorplot.testing import curves_in_space

SLOPE, RADIUS = np.radians(12.0), 0.2


def land(function, count, scale=1.0, shift=0.0):
    places = np.linspace(-4, 4, count)
    x, y = np.meshgrid(places, places, indexing="ij")
    ends = (shift - 4 * scale, shift + 4 * scale)
    return terrain_mesh(terrain(scale * function(x, y), ends, ends))


def plane(x, y):
    return 0.5 * y


def cone(x, y):
    return 4.0 - np.hypot(x, y)


def gaussian(x, y):
    return 3.0 * np.exp(-(x**2 + y**2) / 6.0)


CASES = {
    "plane": (plane, 5, (0.3, -3.1), (-0.2, 3.2), 1.5),
    "cone": (cone, 21, (3.1, 0.2), (0.7, 0.15), 1.2),
    "gaussian": (gaussian, 21, (-3.3, -1.1), (-0.8, -0.5), 1.0),
}


@cache
def case(name):
    """The terrain, the road, which of its segments keep to its slope, and the offsets of runs of such and others."""
    function, count, start, end, width = CASES[name]
    mesh = land(function, count)
    road = features.serpentine(mesh, start, end, SLOPE, radius=RADIUS, width=width)
    way = np.diff(road[0], axis=0)
    keeps = np.abs(way[:, 2] / np.linalg.norm(way, axis=1) - np.sin(road.levels[0])) < 1e-7
    runs = np.flatnonzero(np.diff(keeps, prepend=~keeps[0], append=~keeps[-1]))
    return mesh, road, keeps, runs


def bends_of(name):
    """The points of each bend of a road in the plan, without its ends."""
    _, road, keeps, _ = case(name)
    # A bend may cross the slope of the road: its parts are one where only a few segments lie between.
    marks = np.flatnonzero(~keeps)
    return [road[0][part[0] : part[-1] + 2, :2] for part in np.split(marks, np.flatnonzero(np.diff(marks) > 4) + 1)]


@pytest.mark.slow
@pytest.mark.capability("G9.5-landscape")
@pytest.mark.parametrize("name", CASES)
def test_roads_lie_on_the_terrain_keep_their_slope_between_bends_and_come_to_their_end(name):
    mesh, road, keeps, _ = case(name)
    _, _, start, end, _ = CASES[name]
    assert 0.8 * SLOPE <= road.levels[0] <= SLOPE
    assert np.allclose(road[0][[0, -1], :2], [start, end], rtol=0, atol=1e-12)
    on = places_on_terrain(mesh, road[0][:, :2])[1]
    assert np.abs(on - road[0]).max() < 1e-9
    lengths = np.linalg.norm(np.diff(road[0], axis=0), axis=1)
    assert lengths[keeps].sum() > 0.6 * lengths.sum()
    middles = 0.5 * (road[0][:-1] + road[0][1:])
    corners = mesh.vertices[mesh.corners].reshape(-1, 3, 3)[road.faces[:-1]]
    inside = np.linalg.solve(
        np.insert(corners[:, :, :2], 2, 1.0, axis=2).transpose(0, 2, 1),
        np.insert(middles[:, :2], 2, 1.0, axis=1)[..., None],
    )
    assert inside.min() > -1e-9


@pytest.mark.parametrize("name", CASES)
def test_bends_are_arcs_of_the_radius_that_begin_at_one_distance_and_touch_both_legs(name):
    _, road, _, _ = case(name)
    _, _, start, end, width = CASES[name]
    bends = bends_of(name)
    assert len(bends) >= 2
    straight = np.subtract(end, start) / np.linalg.norm(np.subtract(end, start))
    aside = []
    for bend in bends:
        # The circle with the least squares of powers.
        x, y, c = np.linalg.lstsq(np.insert(2 * bend, 2, 1.0, axis=1), (bend**2).sum(axis=1), rcond=None)[0]
        assert np.sqrt(c + x * x + y * y) == pytest.approx(RADIUS, rel=2e-3)
        assert np.allclose(np.hypot(*(bend - (x, y)).T), RADIUS, rtol=2e-3)
        aside.append(abs(straight[0] * (bend[0] - start)[1] - straight[1] * (bend[0] - start)[0]))
    assert np.ptp(aside) < 1e-9
    assert max(aside) <= width
    # No corner anywhere but where the ground has an edge: on the plane, nowhere.
    if name == "plane":
        way = np.diff(road[0][:, :2], axis=0)
        turn = np.abs(np.diff(np.unwrap(np.arctan2(way[:, 1], way[:, 0]))))
        assert turn.max() < np.radians(270 / 72)


def test_legs_on_a_plane_bear_off_the_steepest_way_by_one_angle():
    _, road, keeps, _ = case("plane")
    way = np.diff(road[0], axis=0)[keeps]
    off = np.arctan2(way[:, 0], way[:, 1])
    assert np.allclose(np.cos(off), np.tan(road.levels[0]) / 0.5, rtol=0, atol=1e-7)
    assert (off > 0).any() and (off < 0).any()
    for bend in bends_of("plane"):
        ways = np.diff(bend, axis=0)[[0, -1]]
        turn = np.diff(np.arctan2(ways[:, 0], ways[:, 1]))
        assert abs(turn[0]) == pytest.approx(2 * np.arccos(np.tan(road.levels[0]) / 0.5), abs=0.1)


def test_legs_on_a_cone_are_logarithmic_spirals():
    _, road, keeps, runs = case("cone")
    tested = 0
    for begin, end in pairwise(runs):
        if keeps[begin] and end - begin > 6:
            r = np.hypot(*road[0][[begin, end], :2].T)
            turn = np.ptp(np.unwrap(np.arctan2(*road[0][begin : end + 1, 1::-1].T)))
            exact = np.log(r[0] / r[1]) * np.sqrt(1.0 / np.tan(road.levels[0]) ** 2 - 1.0)
            assert turn == pytest.approx(exact, rel=5e-2)
            tested += 1
    assert tested >= 2


@pytest.mark.slow
def test_the_less_wide_a_road_is_the_more_bends_it_has():
    mesh, wide, _, _ = case("plane")
    narrow = features.serpentine(mesh, (0.3, -3.1), (-0.2, 3.2), SLOPE, radius=RADIUS, width=0.6)
    sides = [np.sign(np.diff(road[0][:, 0])) for road in (narrow, wide)]
    counts = [np.count_nonzero(np.diff(side[side != 0])) for side in sides]
    assert counts[0] > counts[1] >= 2


@pytest.mark.slow
@pytest.mark.parametrize(("scale", "shift"), [(1e-5, 0.0), (1e4, 3e6)])
def test_scale_and_place_do_not_matter(scale, shift):
    function, count, start, end, width = CASES["plane"]
    mesh = land(function, count, scale, shift)
    sizes = {"radius": scale * RADIUS, "width": scale * width}
    road = features.serpentine(mesh, scale * np.array(start) + shift, scale * np.array(end) + shift, SLOPE, **sizes)
    same = case("plane")[1]
    assert road.levels[0] == same.levels[0]
    length = [np.linalg.norm(np.diff(r[0], axis=0), axis=1).sum() for r in (road, same)]
    assert length[0] == pytest.approx(scale * length[1], rel=1e-6)


@pytest.mark.slow
def test_roads_down_are_those_up_and_there_may_be_none():
    mesh, road, _, _ = case("plane")
    _, _, start, end, width = CASES["plane"]
    down = features.serpentine(mesh, end, start, SLOPE, radius=RADIUS, width=width)
    assert np.array_equal(down[0], road[0][::-1])
    assert down.levels[0] == -road.levels[0]
    straight = features.serpentine(mesh, start, end, np.radians(30), radius=RADIUS)
    assert np.array_equal(np.sign(np.diff(straight[0][:, 1])), np.ones(len(straight[0]) - 1))
    for start, end, slope, sizes, said in (
        ((3, 1), (3, 1), SLOPE, {}, "both ends are in one place"),
        ((3, 1), (-3, 1), SLOPE, {}, "of one height"),
        ((3, 1), (9, 1), SLOPE, {}, "9 1 is not on the terrain"),
        ((0, -3), (0, 3), 0.0, {}, "slope 0, expected an angle between 0 and 90 degrees"),
        ((0, -3), (0, 3), SLOPE, {"radius": 0.0}, "radius"),
        ((0, -3), (0, 3), SLOPE, {"width": -1.0}, "width"),
        ((0, -3), (0, 3), SLOPE, {"radius": 9.0}, "no road of at most 12 degrees found from 0 -3 to 0 3 with bends of"),
    ):
        with pytest.raises(InputError, match=said) as caught:
            features.serpentine(mesh, start, end, slope, **sizes)
        assert "\n" not in str(caught.value)


def test_lines_of_the_plan_are_laid_on_every_triangle_they_cross():
    mesh = land(gaussian, 9)
    plan = np.array([[-3.2, -2.9], [0.3, 1.4], [3.1, -0.7]])
    points, faces = draped(Ground(mesh), plan)
    on = places_on_terrain(mesh, points[:, :2])[1]
    assert np.allclose(on, points, rtol=0, atol=1e-12)
    # Between two points the terrain is straight.
    middles = 0.5 * (points[:-1] + points[1:])
    assert np.allclose(places_on_terrain(mesh, middles[:, :2])[1], middles, rtol=0, atol=1e-12)
    assert (np.diff(faces) != 0).sum() >= len(points) - 3
    assert Ground(mesh).below(np.array([[9.0, 0.0]]))[0].tolist() == [-1]


TEXT = """SLOPE terrain 0 0, 6 6 x 0 12 y 0 12 serpentine 2 1, 3 11 slope 10 radius 0.4 width 3
"""


@pytest.mark.slow
def test_words_of_scene_files_and_every_verb():
    scene = parse_scene(TEXT)
    assert scene.items[0].curves.terrain == (Serpentine((2, 1), (3, 11), 10.0, 0.4, 3.0),)
    assert parse_scene(write_scene(scene)).items[0].curves == scene.items[0].curves
    camera = vp.Camera((6, 6, 40), (6, 6, 0), up=(0, 1, 0))
    (drawn,) = curves_in_space(vp.draw(scene, camera), kind="integral")
    (painted,) = curves_in_space(vp.paint(scene, camera, lines="integral"), kind="integral")
    assert np.allclose(drawn[[0, -1]], [[2, 1, 0.5], [3, 11, 5.5]], atol=1e-9)
    assert np.allclose(painted, drawn)
    plain, image = (vp.render(scene, camera, size=(40, 40), lines=words).pixels for words in ((), "integral"))
    assert (plain != image).any()
    for text, said in (
        ("T terrain 0 1, 1 0 serpentine 0 0, 1 1", "expected 'slope' and an angle in degrees behind its places"),
        ("T terrain 0 1, 1 0 serpentine 0 0, 1 1, 2 2 slope 3", "serpentine: 3 places, expected 2"),
        ("T terrain 0 1, 1 0 serpentine 0 0, 1 1 slope 90", "serpentine: slope 90, expected an angle between"),
        ("T terrain 0 1, 1 0 serpentine 0 0, 1 1 slope 9 radius 0", "serpentine: radius"),
        ("T surface sphere 1 serpentine 0 0, 1 1 slope 9", "are for terrains only"),
    ):
        with pytest.raises(InputError, match=said):
            parse_scene(text)


def test_serpentines_move_with_their_terrain():
    turn = np.array([[0.0, -2, 0, 5], [2, 0, 0, 1], [0, 0, 2, 0], [0, 0, 0, 1]])
    asked = Serpentine((1, 2), (3, 4), 7.0, radius=0.5)
    assert asked.transformed(turn) == Serpentine((1, 3), (-3, 7), 7.0, radius=1.0)
