"""Parametrised surfaces of equations."""

from types import SimpleNamespace

import numpy as np
import pytest
from support.effort import several

from vectorplot.errors import InputError
from vectorplot.io import parse_scene
from vectorplot.surfaces import (
    Ellipsoid,
    ImplicitCyclide,
    ImplicitTorus,
    Quadric,
    Torus,
    implicitized,
    parametrised,
)

BOX = np.array([(-3.0, -3.0, -3.0), (3.0, 3.0, 3.0)])
# Eigenvalues, linear terms, the constant.
KINDS = {
    "ellipsoid": ((1, 2, 0.5), (0, 0, 0), -2, 1),
    "hyperboloid of one sheet": ((1, -2, 0.5), (0, 0, 0), -1, 1),
    "hyperboloid of two sheets": ((1, -2, 0.5), (0, 0, 0), 1, 2),
    "cone": ((1, -2, 0.5), (0, 0, 0), 0, 1),
    "elliptic paraboloid": ((1, 0, 0.5), (0, 2, 0), 0.3, 1),
    "hyperbolic paraboloid": ((1, 0, -0.5), (0, 2, 0), 0.3, 1),
    "elliptic cylinder": ((1, 0, 0.5), (0, 0, 0), -1, 1),
    "hyperbolic cylinder": ((1, 0, -0.5), (0, 0, 0), 1, 2),
    "parabolic cylinder": ((0, 2, 0), (1, 0, 1), -0.4, 1),
    "two crossing planes": ((1, 0, -0.5), (0, 0, 0), 0, 2),
    "two parallel planes": ((0, 2, 0), (0, 0, 0), -1, 2),
    "double plane": ((0, 2, 0), (0, 0, 0), 0, 1),
    "plane": ((0, 0, 0), (1, 2, -2), 0.5, 1),
}
NONE = {
    "a point": ((1, 2, 0.5), 0),
    "no point": ((1, 2, 0.5), 1),
    "a line": ((1, 2, 0), 0),
}


def grid_points(part, columns, rows):
    return part.points(*np.meshgrid(*part.domain.grid(columns, rows)))


def turned_quadric(squares, linear, constant, seed, sign=1.0, *, far=0.0):
    random = np.random.default_rng(seed)
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    middle = random.uniform(-0.5, 0.5, 3) + far
    form, slope = turn @ np.diag(squares) @ turn.T, turn @ np.array(linear, dtype=float)
    a = sign * form
    products = [a[0, 0], a[1, 1], a[2, 2], 2 * a[0, 1], 2 * a[1, 2], 2 * a[2, 0]]
    return Quadric([*products, *sign * slope, sign * constant], BOX + middle + 0.2, middle)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("far", [0.0, 100.0])
def test_parametrised_quadrics_fulfil_their_equation(kind, sign, far):
    *equation, count = KINDS[kind]
    for seed in range(4):
        quadric = turned_quadric(*equation, seed, sign, far=far)
        found = parametrised(quadric)
        assert (found.kind, len(found.parts)) == (kind, count)
        for part in found.parts:
            points = grid_points(part, 17, 13)
            size = 1.0 + (np.linalg.norm(points - quadric.origin, axis=-1) ** 2).max()
            assert np.abs(quadric.values(points)).max() < (1e-12 if far == 0.0 else 1e-11) * size


@pytest.mark.parametrize("kind", KINDS)
def test_the_parts_cover_the_box(kind):
    *equation, _ = KINDS[kind]
    quadric = turned_quadric(*equation, 5)
    ends = np.random.default_rng(3).uniform(*quadric.box, (2, 300, 3))
    t = np.linspace(0.0, 1.0, 201)
    values = quadric.values(ends[0][:, None] + t[:, None] * (ends[1] - ends[0])[:, None])
    rows, columns = np.nonzero(values[:, :-1] * values[:, 1:] < 0.0)
    assert kind == "double plane" or len(rows) > 50
    spots = ends[0][rows] + t[columns][:, None] * (ends[1] - ends[0])[rows]
    grids = [grid_points(part, 200, 200).reshape(-1, 3) for part in parametrised(quadric).parts]
    cloud = np.concatenate(grids)
    for spot in spots[:40]:
        assert np.linalg.norm(cloud - spot, axis=1).min() < 0.4


@pytest.mark.parametrize("kind", NONE)
def test_equations_of_no_surface_are_told(kind):
    squares, constant = NONE[kind]
    with pytest.raises(InputError, match=kind):
        parametrised(turned_quadric(squares, (0, 0, 0), constant, 1))


def test_round_trips():
    egg = Ellipsoid((3.0, 2.0, 1.0))
    found = parametrised(implicitized(egg))
    points = grid_points(found.parts[0], 9, 9)
    assert found.kind == "ellipsoid"
    assert np.abs((points**2 / [9.0, 4.0, 1.0]).sum(axis=-1) - 1.0).max() < 1e-9
    ring = ImplicitTorus(3.0, 1.0, (1.0, 2.0, 3.0))
    torus = parametrised(ring).parts[0]
    assert np.abs(ring.values(grid_points(torus, 9, 9))).max() < 1e-12 * 64
    cyclide = ImplicitCyclide(3.0, 1.0, centre=(8.0, 0.0, 0.0), radius=4.0)
    kind, (inverted,) = vars(parametrised(cyclide)).values()
    assert kind == "cyclide" and np.abs(cyclide.values(grid_points(inverted, 9, 9))).max() < 1e-9


def quartic(a, c, d):
    """The equation of a cyclide in its own place, as a function of points."""
    square, power = a * a - c * c, d * d

    def values(points):
        x, y, _ = np.moveaxis(points, -1, 0)
        n = (points * points).sum(axis=-1)
        return (n + square - power) ** 2 - 4.0 * (a * x - c * d) ** 2 - 4.0 * square * y * y

    return values


def moved_equation(values, seed, half, size=1.0, factor=-0.7):
    """An implicit surface with these values, turned, moved and enlarged; and how to bring points back."""
    random = np.random.default_rng(seed)
    turn, middle = np.linalg.qr(random.normal(size=(3, 3)))[0], size * random.uniform(-2.0, 2.0, 3)

    def back(points):
        return (points - middle) @ turn / size

    box = np.stack([middle - size * half, middle + 1.1 * size * half])
    return SimpleNamespace(values=lambda points: factor * values(back(points)), box=box), back


CYCLIDES = {
    "ring": (2.0, 0.7, 1.2),
    "horn": (2.0, 1.5, 0.4),
    "spindle": (1.0, 0.3, 1.6),
    "all its circles through a point": (2.0, 1.1, 1.1),
    "its circles through two points": (1.0, 0.5, 1.0),
    "two horns alike": (2.0, 1.0, 0.0),
    "nearly a torus": (2.0, 1e-6, 0.7),
    "torus": (2.0, 0.0, 0.7),
    "spindle torus": (1.0, 0.0, 1.7),
    "horn torus": (1.0, 0.0, 1.0),
}


@pytest.mark.capability("G8.3-implicitize")
@pytest.mark.parametrize("name", CYCLIDES)
@pytest.mark.parametrize("size", [1.0, 1e4])
def test_tori_and_cyclides_are_recognised_in_any_place(name, size):
    values = quartic(*CYCLIDES[name])
    for seed in range(several(1, long=3)):
        surface, back = moved_equation(values, seed, 4.0, size)
        found = parametrised(surface)
        assert found.kind == ("torus" if CYCLIDES[name][1] == 0.0 else "cyclide")
        points = back(grid_points(found.parts[0], 23, 17))
        assert np.abs(values(points)).max() < 1e-9 * (np.abs(points).max() ** 4)


@pytest.mark.parametrize(
    "values",
    [
        lambda p: (p**4).sum(axis=-1) - 1.0,
        lambda p: ((p * p).sum(axis=-1) - 1.0) * (((p - 0.3) ** 2).sum(axis=-1) - 2.0),
        lambda p: quartic(2.0, 0.7, 1.2)(p) + 1e-5 * p[..., 2] ** 3,
        lambda p: quartic(2.0, 0.7, 1.2)(p) + 1e-5 * p[..., 2],
        lambda p: ((p * p).sum(axis=-1) + 4.0) ** 2 - 16.0 * (p[..., :2] ** 2).sum(axis=-1),
        lambda p: np.sin(p).sum(axis=-1),
        lambda p: (p**6).sum(axis=-1) - 1.0,
        lambda p: (2.0 - np.hypot(p[..., 0], p[..., 1])) ** 2 + p[..., 2] ** 2 - 0.5,
        lambda p: p[..., 0] / 0.0,
    ],
)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_other_equations_are_no_cyclides(values):
    surface, _ = moved_equation(values, 1, 3.0)
    with pytest.raises(InputError, match="torus or a cyclide"):
        parametrised(surface)


def test_formulas_and_turned_surfaces_are_recognised():
    text = 'S surface implicit "(x^2+y^2+z^2+8)^2 - 36*(x^2+z^2)" box -4 4 -1 1 -4 4'
    found = parametrised(parse_scene(text).items[0].shape)
    assert found.kind == "torus"
    points = grid_points(found.parts[0], 9, 9)
    assert np.abs((np.hypot(points[..., 0], points[..., 2]) - 3.0) ** 2 + points[..., 1] ** 2 - 1.0).max() < 1e-12
    egg = parametrised(parse_scene('S surface implicit "x^2 + 2*y^2 + z^2 - 1" box -1 1 -1 1 -1 1').items[0].shape)
    assert egg.kind == "ellipsoid"
    turned = ImplicitTorus(3.0, 1.0).turned((1.0, 2.0, 3.0), 40.0)
    assert parametrised(turned).kind == "torus"
    assert parametrised(implicitized(Torus(3.0, 1.0, (5.0, 1.0, 2.0)))).kind == "torus"
