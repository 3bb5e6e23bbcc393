import numpy as np
import pytest

import vectorplot as vp
from vectorplot.effects.round_mirrors import RoundMirror, inside_outline, met_by_sight, shown_points
from vectorplot.scene import look
from vectorplot.surfaces import Capped, Cone, Ellipsoid, Sphere, Torus, rod

SHAPES = {
    "ball": Sphere(1.0),
    "ellipsoid": Ellipsoid((2.0, 1.0, 0.4)),
    "rod": rod((0, 0, -1), (0.5, 0.2, 1), 0.6),
    "cone": Capped(Cone(0.4, 0.5, 4.0)),
}


def mirror_and_view(shape, parallel):
    view = look(vp.Scene((vp.Item("M", shape),)), vp.Camera((4, -5, 3), (0, 0, 0), parallel=parallel))
    mirror = RoundMirror.of(view, shape)
    assert mirror is not None
    return mirror, view


def unit(vectors):
    return vectors / np.sqrt((vectors * vectors).sum(axis=0))


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", list(SHAPES))
def test_light_is_mirrored_where_points_are_shown(name, parallel):
    mirror, view = mirror_and_view(SHAPES[name], parallel)
    points = np.random.default_rng(1).uniform(-4.0, 4.0, (3, 5000))
    found, seen = shown_points(mirror, view, points)
    place, there = found[:, seen], points[:, seen]
    assert 3000 < seen.sum() < 5000
    to_eye = np.tile([[0.0], [0.0], [1.0]], place.shape[1]) if parallel else unit(view.eye[:, None] - place)
    x, y, z = mirror.local(place)
    a, b, c = mirror.form
    assert np.abs(x * x + y * y + a * z * z + b * z + c).max() < 1e-12
    normal = unit(mirror.inverse @ np.stack([x, y, a * z + 0.5 * b]))
    both = to_eye + unit(there - place)
    off = both - (both * normal).sum(axis=0) * normal
    assert np.sqrt((off * off).sum(axis=0)).max() < 1e-9
    assert (to_eye * normal).sum(axis=0).min() > 0.0 and (unit(there - place) * normal).sum(axis=0).min() > 0.0


@pytest.mark.parametrize("height", [1e-2, 1e-5, 1e-8])
def test_points_next_to_a_mirror_are_shown_where_they_are(height):
    mirror, view = mirror_and_view(SHAPES["ball"], False)
    way = unit(np.random.default_rng(2).normal(size=(3, 500)))
    way = way[:, (way * unit(view.eye[:, None])).sum(axis=0) > 0.4]
    points = view.points_of(((1.0 + height) * (view.axes.T @ way)).T)
    found, seen = shown_points(mirror, view, points)
    assert seen.all() and np.abs(found - points).max() < 10.0 * height


def test_what_the_mirror_hides_or_holds_is_not_shown():
    mirror, view = mirror_and_view(SHAPES["ball"], False)
    behind = -np.outer(unit(view.eye[:, None])[:, 0], [0.5, 1.5, 5.0])
    assert not shown_points(mirror, view, behind)[1].any()


def test_a_line_is_seen_but_for_what_is_in_the_shadow():
    mirror, view = mirror_and_view(SHAPES["ball"], True)
    start, end = np.array([[-3.0], [0.0], [-2.0]]), np.array([[3.0], [0.0], [-2.0]])
    which, begin, stop = mirror.seen_parts(view, start, end)
    assert which.tolist() == [0, 0]
    assert np.allclose([stop[0, 0], begin[0, 1]], [-1.0, 1.0], atol=1e-5)


def test_points_seem_to_be_on_the_ray_that_shows_them():
    mirror, view = mirror_and_view(SHAPES["rod"], False)
    points = np.random.default_rng(3).uniform(-3.0, 3.0, (3, 300))
    none = np.zeros(300, dtype=np.intp)
    seeming, seen = mirror.virtual(view, points, none)
    found, _ = shown_points(mirror, view, points)
    assert np.abs(met_by_sight(mirror, view, seeming[:, seen]) - found[:, seen]).max() < 1e-7


@pytest.mark.parametrize("axes", [(1.0, 1.0, 1.0), (2.0, 1.0, 0.4), (2.0, 0.02, 2.0), (0.02, 0.02, 2.0)])
def test_how_far_inside_of_the_outline_places_are(axes):
    mirror, view = mirror_and_view(Ellipsoid(axes), True)
    # The image of an ellipsoid under parallel rays is an ellipse.
    squares, axis = np.linalg.eigh(mirror.frame[:, :2].T @ mirror.frame[:, :2])
    angle = np.linspace(0.0, 2.0 * np.pi, 500)
    circle, radii = np.stack([np.cos(angle), np.sin(angle)]), np.sqrt(squares)[:, None]
    distance = np.geomspace(1e-4, 1e-3, len(angle)) * (radii.min() ** 2 / radii.max())
    image = mirror.centre[:2, None] + axis @ (radii * circle - distance * unit(circle / radii))
    place = met_by_sight(mirror, view, np.concatenate([image, np.full((1, len(angle)), -9.0)]))
    np.testing.assert_allclose(inside_outline(mirror, view, place), distance, rtol=0.01)


def test_other_shapes_are_no_round_mirrors():
    view = look(vp.Scene((vp.Item("M", Torus(1.0, 0.3)),)), vp.Camera((4, -5, 3)))
    assert RoundMirror.of(view, Torus(1.0, 0.3)) is None
