"""Curves of one field that cover a surface: even, without crowds and gaps, the same in every picture, in bounded
memory."""

import tracemalloc

import numpy as np
import pytest
from scipy.spatial import cKDTree

import vectorplot as vp
from vectorplot import features, scene, surfaces
from vectorplot.errors import InputError
from vectorplot.features import streamlines
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.streamlines import (
    Ground,
    PlacesAlong,
    SeparationTest,
    evenly_spaced_curves,
    is_near_itself,
    thinned,
    widest_first,
)
from vectorplot.features.surface_integration import Accuracy, FieldFlow, Until, traces_from
from vectorplot.features.surface_points import charts
from vectorplot.surfaces import Cylinder, Domain, Sphere, Torus
from vectorplot.testing import curves_in_space

MEGABYTES = 1 << 20


def dense(points):
    t = np.linspace(0.0, 1.0, 30, endpoint=False)[:, None, None]
    return (points[:-1] + t * (points[1:] - points[:-1])).reshape(-1, 3)


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
def test_they_cover_a_surface_and_keep_apart():
    surface, apart = Cylinder(1.0, 0.0, 3.0), 0.25
    found = evenly_spaced_curves(surface, features.loxodromes(0.6), apart, tracing=Tracing(tolerance=1e-3))
    u, v = np.meshgrid(np.linspace(0, 6.2, 60), np.linspace(0.1, 2.9, 30))
    places = surface.points(u.ravel(), v.ravel())
    own = np.concatenate([dense(found[k]) for k in range(len(found))])
    assert cKDTree(own).query(places)[0].max() < 1.2 * apart
    for k in range(len(found)):
        others = np.concatenate([dense(found[j]) for j in range(len(found)) if j != k])
        assert cKDTree(others).query(dense(found[k]))[0].min() > 0.4 * apart
    with pytest.raises(InputError, match="expected"):
        evenly_spaced_curves(surface, features.loxodromes(0.6), 1e-4)


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_those_across_a_closed_line_are_as_far_from_the_last_one_as_from_each_other(size):
    found = evenly_spaced_curves(Cylinder(size, 0.0, 2.0 * size), features.ParameterDirection(), 0.4 * size)
    turns = np.diff(np.sort(np.mod([found.u[found.offsets[k]] for k in range(len(found))], 2.0 * np.pi)))
    assert len(found) == round(2.0 * np.pi / 0.4)
    assert np.allclose(turns, 2.0 * np.pi / len(found), rtol=1e-6)


SINKS = {
    # Gaps all round what a line across them runs round: each line across begins as many curves.
    "both halves of a torus": (Torus(3.0, 1.0), features.SteepestSlope(), 0.4),
    "two poles": (Sphere(), features.SteepestSlope(), 0.1),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SINKS)
def test_memory_is_bounded_where_curves_run_together(name):
    surface, field, apart = SINKS[name]
    evenly_spaced_curves(Sphere(), features.SteepestSlope(), 1.0)
    tracemalloc.start()
    found = evenly_spaced_curves(surface, field, apart, tracing=Tracing(tolerance=0.5))
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(found) > 2
    assert most < 60 * MEGABYTES


class _Plane:
    """The plane z = 0, of which nothing has to be found out."""

    domain = Domain(-1, 1, -1, 1)

    def points(self, u, v):
        return np.stack([u, v, 0.0 * u], axis=-1)

    def partials(self, u, v):
        return np.broadcast_to((1.0, 0.0, 0.0), (*np.shape(u), 3)), np.broadcast_to((0.0, 1.0, 0.0), (*np.shape(u), 3))

    def second_partials(self, u, v):
        return (np.zeros((*np.shape(u), 3)),) * 3


@pytest.mark.slow
def test_what_winds_round_a_focus_is_not_followed_all_the_way():
    def inwards(points):
        x, y = points[:, 0], points[:, 1]
        return np.stack([-y - 0.01 * x, x - 0.01 * y, 0.0 * x], axis=1)

    plane, tight = _Plane(), 0.1
    flow = FieldFlow(plane, charts(plane), features.VectorField(inwards))
    first = np.array([[0.0, 1.0, 0.0]])
    found = [
        traces_from(flow, np.array([[0.15, 0.0]]), first, 20.0, 1, (2.8, 1.0), Accuracy(1e-4), until).lengths[0]
        for until in (Until(), Until(None, tight))
    ]
    # Until a turn is as wide as that, and eight times as far on.
    assert found[0] > 14.0 and abs(found[1] - 10.8) < 0.5


def _rolled(u, v):
    radius = 1.0 + 0.1 * u / (2.0 * np.pi)
    return np.stack([radius * np.cos(u), radius * np.sin(u), v], axis=-1)


@pytest.mark.slow
@pytest.mark.hard(50)
def test_the_turns_of_a_rolled_sheet_do_not_keep_each_others_curves_away():
    sheet = surfaces.surface_of_function(_rolled, Domain(0.0, 6.0 * np.pi, 0.0, 2.0))
    found = evenly_spaced_curves(sheet, features.ParameterDirection(), 0.5)
    # A tenth between turns, half between curves: all along the sheet there are as many as if it were flat.
    at = np.sort([found.u[found.offsets[k]] for k in range(len(found))])
    assert np.diff(at).max() * 1.3 < 0.95 and at[0] < 0.9 and at[-1] > 6.0 * np.pi - 0.9


@pytest.mark.slow
def test_the_same_curves_for_every_tolerance_and_in_every_picture():
    asked = (Sphere(), features.loxodromes(1.0), 0.6)
    one = evenly_spaced_curves(*asked, tracing=Tracing(tolerance=0.1))
    two = evenly_spaced_curves(*asked, tracing=Tracing(tolerance=0.5, picture=lambda points: 100.0 * points[:, :2]))
    assert len(one) == len(two) and not one.levels.any()
    assert all(np.array_equal(*ends) for ends in zip(_ends(one), _ends(two), strict=True))


def _ends(curves):
    return curves.points[curves.offsets[:-1]], curves.points[curves.offsets[1:] - 1]


@pytest.mark.slow
def test_every_verb_shows_the_same_lines(monkeypatch):
    from vectorplot.visibility.smooth import parametric_items as integral_items

    found = []

    def kept(*args, **words):
        found.append(evenly_spaced_curves(*args, **words))
        return found[-1]

    monkeypatch.setattr(integral_items, "evenly_spaced_curves", kept)
    lines = vp.SurfaceLines(integral=(scene.FieldLines(features.SteepestSlope(), 0.8),))
    ball = vp.Scene((vp.Item("BALL", Sphere(), "red", curves=lines),))
    camera = vp.Camera(eye=(9.0, 5.0, 6.0), target=(0, 0, 0))
    drawing = vp.draw(ball, camera, lines="integral", hidden="solid")
    painting = vp.paint(ball, camera, lines="integral")
    plain, image = (vp.render(ball, camera, size=(80, 60), lines=words) for words in ((), "integral"))
    drawn, painted, rendered = found
    for other in (painted, rendered):
        assert len(other) == len(drawn)
        assert max(np.abs(one - two).max() for one, two in zip(_ends(drawn), _ends(other), strict=True)) < 1e-9
    assert len(curves_in_space(drawing, kind="integral")) >= len(drawn)
    assert any(layer.name == "integral" and layer.marks for layer in painting.layers)
    assert (plain.pixels != image.pixels).any(axis=-1).sum() > 100


@pytest.mark.slow
def test_what_is_near_is_so_on_the_same_sheet_and_for_a_line_not_a_little_before():
    flat = surfaces.graph(lambda x, y: 0.0 * x, Domain(-10, 10, -10, 10))
    ground = Ground(flat, charts(flat), 1.0)
    # There and back, half the distance beside; and far more places than are compared at a time.
    x = np.concatenate([np.linspace(-8, 8, 3000), np.linspace(8, -8, 3000)])
    places = np.stack([x, np.repeat([0.0, 0.4], 3000)], axis=1)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    line = PlacesAlong(np.array([0, 6000]), along, np.array([np.inf]), places)
    where = ground.where(places)
    beside = is_near_itself(ground, line, where, np.arange(6000), 0.5)
    first = int(np.argmax(beside))
    # The way back is beside the way there as soon as it is twice the distance long.
    assert first > 3000 and abs(along[first] - along[2999] - 1.4) < 0.7 and not beside[:3000].any()
    separation = SeparationTest(ground).with_places(places[:10], where[:10]).with_places(places[10:20], where[10:20])
    assert separation.near(places[3000:], where[3000:], 0.5).sum() > 0 and len(separation.groups) == 1
    # What is in a hole is no place for a line, whatever is taken.
    lost = np.where(np.arange(6000)[:, None] % 7 == 3, np.nan, where)
    near = separation.near(places, lost, 0.5)
    assert near[3::7].all()
    assert np.array_equal(*(np.delete(some, np.s_[3::7]) for some in (near, separation.near(places, where, 0.5))))
    assert not separation.away(lost)[3::7].any() and SeparationTest(ground).near(places[3:4], lost[3:4], 0.5).all()
    chosen = thinned(ground, places, 0.5)
    assert cKDTree(where[chosen]).query(where[chosen], 2)[0][:, 1].min() > 0.5
    assert cKDTree(where[chosen]).query(where)[0].max() <= 0.5


def test_lines_are_taken_one_after_the_other_however_many_are_compared_at_a_time(monkeypatch):
    plane, count = _Plane(), 80
    ground = Ground(plane, charts(plane), 0.1)
    random = np.random.default_rng(3)
    along = np.tile(0.025 * np.arange(-16, 17), count)
    angles = np.repeat(random.uniform(0.0, np.pi, count), 33)
    seeds = np.repeat(random.uniform(-0.8, 0.8, (count, 2)), 33, axis=0)
    places = seeds + along[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    lines = PlacesAlong(33 * np.arange(count + 1), along, np.full(count, np.inf), places)
    found = []
    for group in (50, 400, 1 << 14):
        monkeypatch.setattr(streamlines, "GROUP", group)
        spans, separation = streamlines.well_separated(lines, SeparationTest(ground))
        found.append(spans)
    assert len(found[0]) > 10 and all(np.array_equal(spans, found[0]) for spans in found)
    line, low, high = found[0].T
    assert (high - low > 0.15 - 1e-12).all() and (np.diff(line) > 0).all()
    kept = [places[33 * int(k) : 33 * int(k) + 33][(a <= along[:33]) & (along[:33] <= b)] for k, a, b in found[0]]
    for number, own in enumerate(kept[1:], start=1):
        away = cKDTree(np.concatenate(kept[:number])).query(own)[0]
        assert away.min() > 0.05, "no two are nearer than half the distance"
    assert sum(map(len, kept)) == sum(len(taken.places) for taken in separation.groups)


@pytest.mark.parametrize("most", [1, 7, 1000])
@pytest.mark.parametrize("far", [0.0, 30.0])
def test_the_widest_gaps_are_filled_first_and_none_about_them(far, most):
    rng = np.random.default_rng(5)
    where, apart = rng.uniform(0.0, 60.0, (700, 6)) * (1.0, 1.0, 0.1, 0.01, 0.01, 0.01), 1.0
    away = rng.uniform(0.9, 3.0, 700) + far * (where[:, 0] > 50.0)
    expected: list[int] = []
    for place in np.argsort(-away, kind="stable"):
        before = np.array(expected, dtype=int)
        empty = np.maximum(4.0 * apart, 2.0 * away[before])
        if len(expected) < most and (np.linalg.norm(where[before] - where[place], axis=1) > empty).all():
            expected.append(int(place))
    assert widest_first(where, away, apart, most).tolist() == expected
