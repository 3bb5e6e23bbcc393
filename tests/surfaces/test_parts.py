"""Parts of surfaces: what covers a surface once."""

from __future__ import annotations

import warnings
from itertools import pairwise

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.curves import Circle, Loxodrome
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.surfaces import Domain, PlacedSurface, Torus, surface_of_function
from vectorplot.surfaces.placed_surface import placed_once
from vectorplot.surfaces.surface import Surface
from vectorplot.surfaces.swept import Rotoid, Screw, Swept
from vectorplot.surfaces.trimmed import CutSurface, covered_once, uncut

RIGHT_ANGLE, TURN = np.pi / 2.0, 2.0 * np.pi


def tube(turns_u: float, turns_v: float, start: float = 0.0) -> Surface:
    """A torus run through so many times along u and along v."""
    return surface_of_function(
        lambda u, v: ((3.0 + np.cos(v)) * np.cos(u), (3.0 + np.cos(v)) * np.sin(u), np.sin(v)),
        Domain(start, start + turns_u * TURN, start, start + turns_v * TURN),
    )


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize(
    ("surface", "rounds"),
    [
        (tube(3.0, 2.0), (3.0, 2.0)),
        (tube(2.5, 1.0, -1.0), (2.5, 1.0)),
        (Swept(Loxodrome(3.2, RIGHT_ANGLE), Rotoid(3.9, -0.7), 0.0, TURN), (4.0, 1.0)),
        (Swept(Circle(radius=0.5, end=2.0 * TURN), Screw(1.0), 0.0, TURN), (2.0, 1.0)),
    ],
)
def test_a_surface_that_runs_along_itself_again_is_covered_once_and_closed(
    surface: Surface, rounds: tuple[float, float], scale: float
) -> None:
    placed = PlacedSurface(surface, scale * np.eye(3), (0.0, 0.0, 3.0 * scale))
    once = covered_once(placed)
    assert np.allclose(np.array(surface.domain.size) / once.domain.size, rounds, rtol=1e-12)
    assert (once.domain.closed_u, once.domain.closed_v) >= tuple(times > 1.0 for times in rounds)
    u, v = (x.ravel() for x in np.meshgrid(*surface.domain.grid(9, 7)))
    domain, there = once.domain, placed.points(u, v)
    if domain.closed_u:
        u = domain.u_start + (u - domain.u_start) % domain.size[0]
    if domain.closed_v:
        v = domain.v_start + (v - domain.v_start) % domain.size[1]
    assert np.allclose(once.points(u, v), there, rtol=0.0, atol=1e-9 * scale)


@pytest.mark.parametrize(
    "surface",
    [
        Torus(3.0, 1.0),
        tube(0.9, 0.5),
        Swept(Circle(radius=0.5), Screw(1.0), 0.0, 3.0 * TURN),
        # A Möbius strip run along twice comes back mirrored after the first time.
        surface_of_function(
            lambda u, v: (
                (3.0 + v * np.cos(u / 2.0)) * np.cos(u),
                (3.0 + v * np.cos(u / 2.0)) * np.sin(u),
                v * np.sin(u / 2.0),
            ),
            Domain(0.0, 2.0 * TURN, -1.0, 1.0),
        ),
        # Symmetric, but nowhere in the same place again.
        surface_of_function(lambda u, v: (u, v, np.sin(u) * np.sin(v)), Domain(0.0, 4.0 * TURN, 0.0, 4.0 * TURN)),
        # Nothing but holes, and nothing but one point.
        surface_of_function(lambda u, v: (u * np.nan, v, u), Domain(0.0, 1.0, 0.0, 1.0)),
        surface_of_function(lambda u, v: (0.0 * u, 0.0 * v, 0.0 * u), Domain(0.0, 1.0, 0.0, 1.0)),
    ],
)
def test_other_surfaces_stay_as_they_are(surface: Surface) -> None:
    once = covered_once(surface)
    assert once is surface


@pytest.mark.slow
@pytest.mark.parametrize("rounds", [(3.0, 2.0), (2.5, 2.0)])
def test_what_covers_itself_is_drawn_as_what_does_not(rounds: tuple[float, float]) -> None:
    # Before, each of its lines met all the other covers all along.
    camera = vp.Camera((9.0, -7.0, 6.0), (0.0, 0.0, 0.0))
    lengths = []
    for surface in (Torus(3.0, 1.0), tube(*rounds)):
        scene = vp.Scene((vp.Item("S", surface, curves=vp.SurfaceLines(6, 4)),))
        with warnings.catch_warnings():
            warnings.simplefilter("error", vp.InputWarning)
            drawing = vp.draw(scene, camera)
        marks = [mark for layer in drawing.layers for mark in layer.strokes]
        strokes = [mark.points[a:b] for mark in marks for a, b in pairwise(mark.offsets)]
        lengths.append(sum(np.linalg.norm(np.diff(points, axis=0), axis=1).sum() for points in strokes))
    assert abs(lengths[0] - lengths[1]) < 0.002 * lengths[0]


def test_domains_may_end_at_whole_numbers() -> None:
    hill = surface_of_function(lambda u, v: (u, v, np.exp(-u * u - v * v)), Domain(-2, 2, -2, 2))
    assert covered_once(hill) is hill


@pytest.mark.parametrize("turn", [np.eye(3), np.array([[0.0, 2.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 0.0, 2.0]])])
def test_what_is_cut_far_from_the_origin_keeps_all_digits_where_it_is_looked_at(turn):
    far, normal = np.array([1e6, -1e6, 1e6]), (0.6, 0.0, 0.8)
    u, v = np.linspace(0.1, 6.1, 40), np.linspace(0.2, 6.0, 40)
    points = []
    for shift in (np.zeros(3), far):
        gone = HalfSpaces((normal,), (float(np.dot(normal, shift)) + 0.5,))
        cut = CutSurface(PlacedSurface(Torus(2.0, 0.7), turn, shift), (gone,))
        placed = placed_once(cut, np.eye(3), np.zeros(3), shift)
        points.append((placed.points(u, v), uncut(placed).points(u, v)))
    (near, whole), (there, all_of_it) = points
    assert 5 < np.isnan(near[:, 0]).sum() < 35
    assert (np.isnan(there) == np.isnan(near)).all()
    assert np.abs(all_of_it - whole).max() < 1e-14
    assert np.nanmax(np.abs(there - near)) < 1e-14
