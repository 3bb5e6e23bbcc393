"""Facets of many surfaces at once."""

import numpy as np
import pytest

from vectorplot.features import tessellation
from vectorplot.features.edge_splitting import Within, refined
from vectorplot.features.tessellation import LOT, facets, facets_of_all
from vectorplot.geometry.budget import USUAL
from vectorplot.shading.facet_resolution import Coarse
from vectorplot.surfaces.capped_bodies import Capped, rod
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Sphere, implicit_sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus


def placed(surface, number):
    rng = np.random.default_rng(number)
    return PlacedSurface(surface, np.linalg.qr(rng.normal(size=(3, 3)))[0], rng.uniform(-2.0, 2.0, 3))


def same(one, other):
    pairs = ((one.mesh.vertices, other.mesh.vertices), (one.mesh.corners, other.mesh.corners))
    pairs += ((one.normals, other.normals), (one.sharp, other.sharp))
    return one.complete == other.complete and all(np.array_equal(a, b, equal_nan=True) for a, b in pairs)


def mixed():
    """Families, one of them with poles, and what is of none."""
    rings = [placed(Torus(1.0, 0.2 + 0.05 * k), k) for k in range(4)]
    balls = [placed(Sphere(0.5 + 0.1 * k), k) for k in range(3)]
    wave = surface_of_function(lambda u, v: (u, v, np.sin(u) * v), Domain(-1.0, 1.0, -1.0, 1.0))
    rods = [rod((0.0, 0.0, 0.0), (1.0, 0.4 * k, 0.3), 0.1 + 0.02 * k) for k in range(3)]
    others = [*rods, Capped(Sphere(1.0), (0.0, 1.0)), wave, implicit_sphere(0.5), Torus(1.0, 0.3), Sphere(0.4)]
    return [shape for some in zip(rings, balls, others[:3], strict=False) for shape in some] + rings[3:] + others[3:]


@pytest.mark.slow
def test_each_is_to_the_last_bit_what_it_is_alone():
    shapes = mixed()
    demands = [Coarse((0.01 + 0.003 * k,)) for k in range(len(shapes))]
    found = facets_of_all(shapes, demands.__getitem__, USUAL.facets)
    assert all(same(f, facets(s, d)) for f, s, d in zip(found, shapes, demands, strict=True))


@pytest.mark.slow
def test_the_budget_is_that_of_each():
    shapes = [placed(Torus(1.0, 0.3), k) for k in range(3)]
    demands = [Coarse((d,)) for d in (0.05, 0.0005, 0.02)]
    found = facets_of_all(shapes, demands.__getitem__, 2000)
    assert [f.complete for f in found] == [True, False, True]
    assert all(same(f, facets(s, d, 2000)) for f, s, d in zip(found, shapes, demands, strict=True))


def times_divided(monkeypatch, shapes, criterion):
    divided = []
    monkeypatch.setattr(tessellation, "refined", lambda net, *rest: divided.append(net) or refined(net, *rest))
    return facets_of_all(shapes, criterion, USUAL.facets), len(divided)


def rods(count):
    return [rod((0.0, 0.0, 0.0), (1.0, 0.4 * k, 0.3), 0.1 + 0.02 * k) for k in range(count)]


def test_rods_of_all_sizes_are_one_family(monkeypatch):
    monkeypatch.setattr(tessellation, "_shared_net", lambda *_: None)
    found, divided = times_divided(monkeypatch, rods(5), lambda _: Coarse((0.01,)))
    assert divided == 1
    for facet, shape in zip(found, rods(5), strict=True):
        ends = facet.mesh.vertices @ (shape.matrix[2] / np.linalg.norm(shape.matrix[2]))
        assert np.allclose([ends.min(), ends.max()], shape.surface.mantle)


@pytest.mark.slow
def test_balls_and_rods_share_nets_that_are_as_fine_as_each_asks_for(monkeypatch):
    eye, mirror = np.array([0.0, 0.0, 30.0]), np.diag([1.0, 1.0, -1.0])
    criterion = Within(lambda points: 2e-4 * np.linalg.norm(points - eye, axis=-1))
    balls = [PlacedSurface(Sphere(1.0), 0.3 * (mirror if k % 2 else np.eye(3)), (k, 0.0, 0.0)) for k in range(8)]
    shapes = balls + rods(4)
    found, divided = times_divided(monkeypatch, shapes, lambda _: criterion)
    assert divided < 8
    for ball, facet in zip(balls, found, strict=False):
        arms = facet.mesh.vertices - ball.shift
        assert np.allclose(np.linalg.norm(arms, axis=1), 0.3)
        outwards = arms / 0.3 * np.sign(np.linalg.det(ball.matrix))
        assert np.allclose(facet.normals, outwards)
        middles = facet.mesh.vertices[facet.mesh.corners].reshape(-1, 3, 3).mean(axis=1)
        off = 0.3 - np.linalg.norm(middles - ball.shift, axis=1)
        assert (off <= 2e-4 * np.linalg.norm(middles - eye, axis=1)).all()
    assert all(same(f, facets(s, criterion)) for f, s in zip(found, shapes, strict=True))


def test_large_balls_near_the_eye_and_ellipsoids_share_none(monkeypatch):
    criterion = Within(lambda points: 0.01 * np.linalg.norm(points - (0.0, 0.0, 2.0), axis=-1))
    shapes = [Sphere(1.0), Sphere(1.0), PlacedSurface(Sphere(1.0), np.diag([1.0, 1.0, 0.1]))]
    shared = tessellation._shared_net
    assert [shared(shape, criterion) for shape in shapes] == [None] * 3


@pytest.mark.parametrize("count", [0, 1, LOT + 1])
def test_lots_come_back_in_order(count):
    found = facets_of_all([Sphere(1.0 + k) for k in range(count)], lambda k: Coarse((0.1 * (1.0 + k),)), USUAL.facets)
    sizes = [np.ptp(f.mesh.vertices[:, 2]) for f in found]
    assert np.allclose(sizes, 2.0 * (1.0 + np.arange(count)))


@pytest.mark.slow
def test_demands_that_cannot_be_joined_are_asked_one_by_one():
    criterion = Within(lambda points: np.full(points.shape[:-1], 0.02))
    shapes = [placed(Torus(1.0, 0.3), k) for k in range(2)]
    found = facets_of_all(shapes, lambda _: criterion, USUAL.facets)
    assert all(same(f, facets(s, criterion)) for f, s in zip(found, shapes, strict=True))
