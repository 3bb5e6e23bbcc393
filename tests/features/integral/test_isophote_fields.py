"""Directions of isophotes: the angle to the light does not change along them, and grows less to their left."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features import face_sites, integral_curves
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.surface_integration import Accuracy
from vectorplot.features.surface_points import Sites
from vectorplot.features.tangent_fields import IsophoteDirections
from vectorplot.geometry import box
from vectorplot.surfaces import Domain, Sphere, Torus, graph
from vectorplot.testing import assert_integral_curve

RING = Torus(3.0, 1.2)
LIGHT = (2.0, -3.0, 4.0)


def cosines(points, normals, parallel):
    way = np.array(LIGHT) - (0.0 if parallel else points)
    return (normals * way).sum(axis=-1) / np.linalg.norm(way, axis=-1)


@pytest.mark.parametrize("parallel", [True, False], ids=["parallel", "lamp"])
def test_the_angle_is_constant_along_them_and_the_brighter_side_is_the_left_one(parallel):
    rng = np.random.default_rng(1)
    sites = Sites(RING, *rng.uniform(0.0, 2.0 * np.pi, (2, 200)))
    (tangents,) = IsophoteDirections(LIGHT, parallel).tangents(sites)
    assert np.abs(np.linalg.norm(tangents, axis=1) - 1.0).max() < 1e-12
    assert np.abs((tangents * sites.normals).sum(axis=1)).max() < 1e-12

    def change(ways, step=1e-5):
        there, back = (
            Sites(RING, sites.u + side * step * du, sites.v + side * step * dv)
            for du, dv in [sites.steps(ways)]
            for side in (1.0, -1.0)
        )
        rise = cosines(there.points, there.normals, parallel) - cosines(back.points, back.normals, parallel)
        return rise / (2.0 * step)

    assert np.abs(change(tangents)).max() < 1e-8
    assert (change(sites.turned(tangents, 0.5 * np.pi)) > 0.0).all()


def test_their_curves_close_where_isophotes_do():
    field = IsophoteDirections((0.0, 0.0, 1.0))
    found = integral_curves(RING, field, (0.0, 0.7))
    assert found.closed.tolist() == [True] and np.ptp(found.points[:, 2]) < 1e-8
    field = IsophoteDirections(LIGHT)
    found = integral_curves(RING, field, (0.3, 0.7), length=4.0)
    assert np.ptp(cosines(found.points, Sites(RING, found.u, found.v).normals, True)) < 1e-7
    assert_integral_curve(found[0], RING, field, 0.02)


@pytest.mark.parametrize(("part", "round_"), [(1.002, 1), (0.998, 0)])
def test_circles_that_pass_close_by_a_pole_go_round_it_or_do_not(part, round_):
    # In one step near the pole u runs through more than a half of its period, or through less.
    field = IsophoteDirections((np.sin(0.7), 0.0, np.cos(0.7)))
    start = (0.0, 0.5 * np.pi - 0.7 - 0.7 * part)
    found = integral_curves(Sphere(), field, start, accuracy=Accuracy(1e-4), tracing=Tracing(tolerance=1e-3))
    assert found.closed.tolist() == [True] and not found.doubts
    assert np.abs(found.turns).tolist() == [[round_, 0]]


def test_what_has_no_isophotes_has_no_directions():
    flat = graph(lambda x, y: 0.3 * x + 0.1 * y, Domain(-1, 1, -1, 1))
    sites = Sites(flat, np.array([0.1, 0.7]), np.array([0.2, -0.9]))
    assert np.isnan(IsophoteDirections(LIGHT).tangents(sites)).all()
    assert np.isfinite(IsophoteDirections(LIGHT, False).tangents(sites)).all()
    with pytest.raises(InputError, match="only surfaces with parameters"):
        IsophoteDirections(LIGHT).tangents(face_sites(box((1, 1, 1))))


@pytest.mark.parametrize(("light", "parallel"), [((0, 0, 0), True), ((np.nan, 0, 0), False), ((1, 2), True)])
def test_what_is_no_light_is_told(light, parallel):
    with pytest.raises(InputError, match="isophotes: light"):
        IsophoteDirections(light, parallel)
