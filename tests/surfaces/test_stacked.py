"""Many surfaces asked at once say what each of them says alone."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Sphere,
)
from vectorplot.surfaces.stacked import StackedSurfaces, normal_partials, unit_normals
from vectorplot.surfaces.surface import Domain, Surface, first_jets, second_jets
from vectorplot.surfaces.tori import Torus

WAVE = surface_of_function(lambda u, v: (u, v, np.sin(3.0 * u) * v), Domain(-1.0, 1.0, 0.0, 2.0))
SHELL = surface_of_function(lambda u, v: (u * u, u * v, v**3), Domain(-1.0, 1.0, 0.0, 2.0))

ROUND = (
    *(Cylinder(1.0), Cylinder(2.0, -1.0, 3.0), Cylinder(1.0, depth=2.0), Cone(1.0, -1.0, 2.0), Cone(2.0, 0.0, 2.0)),
    *(Sphere(2.0), Sphere(1.0), Ellipsoid((1.0, 2.0, 3.0)), Ellipsoid((3.0, 2.0, 3.0)), Hyperboloid((1.0, 2.0, 3.0))),
    *(Hyperboloid(), HyperboloidSheet((1.0, 1.0, 0.5)), HyperboloidSheet(), Paraboloid(), Paraboloid(2.0, 3.0, 4.0)),
)
RINGS = (Torus(3.0, 1.0), Torus(2.0, 0.5), Torus(3.0, 2.0), Torus(1.0, 2.0))
OPEN = (WAVE, SHELL, WAVE, HyperbolicParaboloid(1.0, 2.0), HyperbolicParaboloid(3.0, 2.0, 0.5))


@pytest.mark.parametrize("shapes", [ROUND, RINGS, OPEN], ids=["round", "rings", "open"])
def test_surfaces_at_once_say_what_each_says_alone(shapes: tuple[Surface, ...]) -> None:
    """Points, derivatives and normals, in the middle of the domains, on their borders and at poles."""
    rng = np.random.default_rng(4)
    placed = [PlacedSurface(shape, rng.normal(size=(3, 3)), rng.normal(size=3)) for shape in shapes]
    row = rng.permutation(np.repeat(np.arange(len(shapes)), 40))
    together = StackedSurfaces(tuple(placed)).at(row)
    (width, height), domain = together.domain.size, together.domain
    u = domain.u_start + rng.choice([0.0, 0.3, 0.5, 0.81, 1.0], len(row)) * width
    v = domain.v_start + rng.choice([0.0, 0.3, 0.5, 0.81, 1.0], len(row)) * height
    at_once = _said(together, u, v)
    for number, surface in enumerate(placed):
        own = row == number
        for one, all_ in zip(_said(surface, u[own], v[own]), at_once, strict=True):
            assert np.allclose(all_[own], one, rtol=1e-9, atol=1e-9, equal_nan=True)


@pytest.mark.parametrize("shapes", [ROUND, RINGS, OPEN], ids=["round", "rings", "open"])
def test_all_surfaces_on_grids_say_what_each_says_alone(shapes: tuple[Surface, ...]) -> None:
    """Whether their domains are one or not."""
    rng = np.random.default_rng(5)
    placed = tuple(PlacedSurface(shape, rng.normal(size=(3, 3)), rng.normal(size=3)) for shape in shapes)
    stack = StackedSurfaces(placed)
    lines = stack.grid_lines(4, 3)
    assert len(lines[0]) == (1 if stack.common_domain else len(stack))
    u, v = (t.reshape(len(t), -1) for t in np.broadcast_arrays(lines[0][:, :, None], lines[1][:, None, :]))
    for surface, found in zip(placed, stack.points_of_all(u, v), strict=True):
        own = np.meshgrid(*surface.domain.grid(4, 3), indexing="ij")
        assert np.allclose(found, surface.points(*own).reshape(-1, 3), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("shapes", [ROUND, RINGS, OPEN], ids=["round", "rings", "open"])
def test_points_and_derivatives_at_once_are_those_asked_for_each(shapes: tuple[Surface, ...]) -> None:
    """To the last bit, of surfaces that know them at once and of users' functions, placed and stacked."""
    rng = np.random.default_rng(6)
    placed = tuple(PlacedSurface(shape, rng.normal(size=(3, 3)), rng.normal(size=3)) for shape in shapes)
    many = StackedSurfaces(placed).at(rng.integers(0, len(shapes), 50))
    for surface in (*shapes, *placed, many):
        (width, height), domain = surface.domain.size, surface.domain
        u = domain.u_start + rng.uniform(0.0, 1.0, 50) * width
        v = domain.v_start + rng.uniform(0.0, 1.0, 50) * height
        each = (surface.points(u, v), *surface.partials(u, v), *surface.second_partials(u, v))
        for asked, found in zip(each, second_jets(surface, u, v), strict=True):
            assert np.array_equal(asked, found)
        for asked, found in zip(each[:3], first_jets(surface, u, v), strict=True):
            assert np.array_equal(asked, found)


def test_sines_of_a_torus_are_taken_once(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    profile = Torus._profile
    monkeypatch.setattr(Torus, "_profile", lambda self, v: asked.append(len(v)) or profile(self, v))
    t = np.linspace(0.0, 6.0, 7)
    second_jets(StackedSurfaces.of(RINGS).at(np.arange(7) % 4), t, t)
    unit_normals(Torus(), t, t)
    assert asked == [7, 7]


def test_one_surface_is_asked_itself() -> None:
    placed = PlacedSurface(Torus(), np.eye(3))
    assert StackedSurfaces((placed,)).at(np.zeros(5, dtype=np.intp)) is placed


def _said(surface: Surface, u: np.ndarray, v: np.ndarray) -> list[np.ndarray]:
    return [
        surface.points(u, v),
        *surface.partials(u, v),
        *surface.second_partials(u, v),
        unit_normals(surface, u, v),
        *normal_partials(surface, u, v),
    ]
