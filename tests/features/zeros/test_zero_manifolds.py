"""Many functions traced at once: what each gives alone."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.zero_curves import zero_manifold_of_f_uv, zero_manifolds
from vectorplot.geometry.budget import Budget
from vectorplot.surfaces.surface import Domain

TURN = 2 * np.pi
SQUARE = Domain(-1, 1, -1, 1)
RING = Domain(1.0, 1.0 + TURN, -1.0, TURN - 1.0, closed_u=True, closed_v=True)


def waves(u, v):
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sin(1.0 / np.hypot(u - 0.3, v + 0.4))


def ball(u, v):
    return 1.5 * np.cos(u) * np.cos(v) ** 2 + np.sin(u) * np.cos(v) ** 2 + 2 * np.sin(v) * np.cos(v) - np.cos(v)


OPEN = {
    "circle": (lambda u, v: u * u + v * v - 0.5, SQUARE),
    "tiny": (lambda u, v: 1e9 * ((u * 1e6) ** 2 + 2 * (v * 1e6) ** 2 - 0.4), Domain(-1e-6, 1e-6, -1e-6, 1e-6)),
    "far off": (lambda u, v: (u - 1e6) ** 2 + 2 * v * v - 0.4, Domain(1e6 - 1, 1e6 + 1, -1, 1)),
    "waves": (waves, SQUARE),
    "saddle": (lambda u, v: u * u - v * v, SQUARE),
    "three lines": (lambda u, v: u**3 - 3 * u * v * v, SQUARE),
    "pole": (lambda u, v: 1 / (u - 0.3 * v - 0.01), SQUARE),
    "touches": (lambda u, v: (u - 0.3 * v - 0.1) ** 2, SQUARE),
    "hole": (lambda u, v: np.where(u * u + v * v < 0.3, np.nan, v - 0.1 * u), SQUARE),
    "flat": (lambda u, v: np.maximum(u * u + v * v - 0.5, 0.0), SQUARE),
    "two lines as one": (lambda u, v: (u - 0.3 * v - 0.1) ** 2 - 1e-12, SQUARE),
    "a dot": (lambda u, v: (u - 0.123) ** 2 + (v - 0.2) ** 2 - 1e-8, SQUARE),
    "large values": (lambda u, v: 1e80 * (u * u + v * v - 0.5), SQUARE),
    "one": (lambda u, v: 1.0 + 0.0 * u, SQUARE),
    "zero": (lambda u, v: 0.0 * u, SQUARE),
    "nowhere": (lambda u, v: np.nan * u, SQUARE),
}
ROUND = {
    "nodes": (lambda u, v: np.sin(u) * np.sin(v), RING),
    "point": (lambda u, v: 2 - np.cos(u) - np.cos(v), RING),
    "loops": (lambda u, v: np.sin(u) - 0.3 + 0.2 * np.cos(3 * v), RING),
    "shorter": (lambda u, v: np.sin(2 * u) - 0.3 * np.cos(2 * v), Domain(0, np.pi, 0, np.pi, True, True)),
}
BALLS = {
    "pole in v": (ball, Domain(0, TURN, -TURN / 4, TURN / 4, closed_u=True)),
    "no pole": (lambda u, v: np.sin(u) + v, Domain(0, TURN, -TURN / 4, TURN / 4, closed_u=True)),
}


def at_once(members, tolerances, **options):
    functions = [f for f, _ in members.values()]

    def f(u, v, of):
        w = np.zeros_like(u)
        for number in np.unique(of):
            own = of == number
            w[own] = functions[number](u[own], v[own])
        return w

    domains = [domain for _, domain in members.values()]
    return zero_manifolds(f, domains, columns=20, rows=21, tolerances=tolerances, **options)


def assert_same(one, other):
    for name in ("offsets", "closed", "turns", "grid"):
        assert np.array_equal(getattr(one, name), getattr(other, name), equal_nan=True), name
    # First guesses go on until all have settled: so points are the same to the residual that is asked for only.
    for name in ("points", "nodes", "isolated", "touching"):
        a, b = getattr(one, name), getattr(other, name)
        assert a.shape == b.shape and (np.abs(a - b) <= 1e-10 * np.array(one.domain.size)).all(), name
    assert one.doubts == other.doubts


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("chords", [False, True])
@pytest.mark.parametrize("members", [OPEN, ROUND, BALLS], ids=["open", "round", "balls"])
def test_each_is_traced_as_if_it_were_alone(members, chords):
    tolerances = [1e-3 * domain.size[0] for _, domain in members.values()] if chords else None
    found = at_once(members, tolerances)
    for number, (f, domain) in enumerate(members.values()):
        tolerance = tolerances[number] if tolerances else None
        assert_same(found[number], zero_manifold_of_f_uv(f, domain, columns=20, rows=21, tolerance=tolerance))


def test_a_budget_is_that_of_each():
    few = Budget(cells=64, points=300)
    members = {"circle": OPEN["circle"], "wild": (lambda u, v: np.sin(60 * u) * np.sin(60 * v) - 0.3, SQUARE)}
    alone = [zero_manifold_of_f_uv(f, d, columns=20, rows=21, tolerance=1e-3, budget=few) for f, d in members.values()]
    assert alone[1].doubts and not alone[0].doubts
    for one, other in zip(at_once(members, [1e-3] * 2, budget=few), alone, strict=True):
        assert_same(one, other)


def test_gradients_and_positions_are_asked_by_number():
    shifts = np.array([0.0, 0.25])

    def gradient(u, v, of):
        return v - shifts[of], u

    found = zero_manifolds(
        lambda u, v, of: u * (v - shifts[of]),
        [SQUARE] * 2,
        columns=11,
        rows=11,
        gradient=gradient,
        positions=lambda u, v, of: np.stack([u, v, u * v * of], axis=-1),
        tolerances=[1e-3] * 2,
    )
    assert np.abs(found[0].nodes).max() < 1e-12 and np.abs(found[1].nodes - (0.0, 0.25)).max() < 1e-12


def test_wrong_grids_are_refused_for_every_domain():
    with pytest.raises(InputError, match="3 or more"):
        zero_manifolds(lambda u, v, of: u, [RING, RING], columns=2, rows=9)
