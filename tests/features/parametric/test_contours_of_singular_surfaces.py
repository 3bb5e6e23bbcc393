"""Contours of surfaces with cusps, pinch points and double curves: none is false, whatever the parametrisation."""

from __future__ import annotations

import numpy as np
import pytest
from support.effort import several

import vectorplot as vp
from vectorplot import curves, features, surfaces
from vectorplot.features.contours_and_isophotes import parallel_contour
from vectorplot.features.holes import wrapped
from vectorplot.features.surface_singularities import pinch_points
from vectorplot.surfaces.stacked import unit_normals

ROUND = 'u 0 "2*pi" v 0 "2*pi" closed_u closed_v'
SURFACES = {
    "crossed tubes": ('"0.7*cos(u)" "0.5*cos(v)+0.7*sin(u)" "sin(v)" ' + ROUND, (-4.0, 1.3, 5.1)),
    "Roman": ('"sin(2*u)*cos(v)^2" "sin(u)*sin(2*v)" "cos(u)*sin(2*v)" u 0 "pi" v "-pi/2" "pi/2"', (3.0, -4.0, 2.0)),
    "Bohemian dome": ('"cos(u)" "sin(u)+cos(v)" "sin(v)" ' + ROUND, (3.0, -4.0, 2.3)),
    "sine surface": ('"sin(u)" "sin(v)" "sin(u+v)" ' + ROUND, (3.0, -4.0, 2.0)),
    "tranguloid": (
        '"2*sin(3*u)/(2+cos(v))" "2*(sin(u)+2*sin(2*u))/(2+cos(v+2*pi/3))" '
        '"(cos(u)-2*cos(2*u))*(2+cos(v))*(2+cos(v+2*pi/3))/4" u "-pi" "pi" v "-pi" "pi" closed_u closed_v',
        (13.0, -14.0, 9.0),
    ),
    "Whitney's umbrella": ('"u*v" "u" "v^2" u -1 1 v -1 1', (3.0, -4.0, 2.0)),
    "conoid": ('"v*cos(u)" "v*sin(u)" "sin(2*u)" u 0 "2*pi" v 0 1.5 closed_u', (3.0, -4.0, 2.0)),
    "cross-cap": (
        '"sin(u)*sin(2*v)/2" "sin(2*u)*cos(v)^2" "cos(2*u)*cos(v)^2" u 0 "pi" v "-pi/2" "pi/2"',
        (3.0, -4.0, 2.0),
    ),
}
PINCHED = {
    **{name: SURFACES[name] for name in ("crossed tubes", "Roman", "Bohemian dome", "sine surface", "conoid")},
    "Whitney's umbrella": SURFACES["Whitney's umbrella"],
    "ruled conoid": ('"u*cos(v)" "u*sin(v)" "sin(2*v)" u -1 1 v 0 "pi"', (3.0, -4.0, 2.0)),
    "Pisot triaxial": (
        '"0.655866*cos(1.03002+u)*(2+cos(v))" "0.754878*cos(1.40772-u)*(2+0.868837*cos(2.43773+v))" '
        '"0.868837*cos(2.43773+u)*(2+0.495098*cos(0.377696-v))" ' + ROUND,
        (6.0, -8.0, 5.0),
    ),
}
FACING = 0.1
"""Cosine between normal and sight above which a chord lies beside the contour; by so little chords within the tolerance
turn away where the surface nearly has a point without a normal."""
BESIDE = 0.01
"""Part of the length of a contour that may be such chords."""


def wrong_part(surface, eye, parallel):
    """The part of a contour along which the surface does not turn away; and its length."""
    found = (parallel_contour if parallel else features.contour)(surface, eye)
    wrong = total = 0.0
    share = (np.arange(8) + 0.5) / 8.0
    for start, end in zip(found.offsets[:-1], found.offsets[1:], strict=True):
        uv = np.stack([found.u, found.v])[:, start:end]
        inner = (uv[:, :-1, None] + share * np.diff(uv)[:, :, None]).reshape(2, -1)
        inner = wrapped(surface.domain, *inner)
        points, normals = surface.points(*inner), unit_normals(surface, *inner)
        sight = np.broadcast_to(eye, points.shape) - (0.0 if parallel else points)
        cosine = np.abs((normals * sight).sum(axis=-1)) / np.linalg.norm(sight, axis=-1)
        long = np.linalg.norm(np.diff(found.points[start:end], axis=0), axis=1)
        total += long.sum()
        wrong += (long * (cosine > FACING).reshape(len(long), -1).mean(axis=1)).sum()
    return wrong / max(total, 1e-300), total


def read_surface(text, tmp_path):
    (tmp_path / "x.scene").write_text(f"A gray surface function {text}\n", encoding="utf-8")
    return vp.read(tmp_path / "x.scene").items[0].shape


@pytest.mark.capability("G8.4-contour")
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", SURFACES)
def test_no_stroke_is_where_no_contour_is(name, parallel, tmp_path):
    text, eye = SURFACES[name]
    part, length = wrong_part(read_surface(text, tmp_path), np.array(eye) * (1.0 if parallel else 3.0), parallel)
    assert length > 1.0 and part < BESIDE


@pytest.mark.slow
@pytest.mark.parametrize("eye", [(4.0, -7.0, 5.0), (3.0, 2.0, 1.0), (-5.0, 1.0, 4.0)])
@pytest.mark.parametrize("parallel", [False, True])
def test_contours_end_in_poles_where_normals_vanish_in_second_order(eye, parallel, tmp_path):
    """In the poles of a cross-cap, both in the origin, the normal is (0, cos u, -sin u)."""
    found = found_contour(read_surface(SURFACES["cross-cap"][0], tmp_path), np.array(eye) / 3.0, parallel)
    ends = np.concatenate([found.offsets[:-1], found.offsets[1:] - 1])
    at_pole = ends[np.abs(np.abs(found.v[ends]) - np.pi / 2.0) < 1e-9]
    assert len(at_pole) == 2 and not found.doubts
    assert np.abs(found.u[at_pole] - np.arctan2(eye[1], eye[2]) % np.pi).max() < 1e-4


@pytest.mark.parametrize("order", [1, 2, 3])
def test_normals_at_poles_of_any_order_are_their_limits(order):
    bowl = surfaces.surface_of_function(
        lambda u, v: (v**order * np.cos(u), v**order * np.sin(u), v ** (2 * order)),
        surfaces.Domain(0.0, 2.0 * np.pi, 0.0, 1.0, closed_u=True),
    )
    up = unit_normals(bowl, np.linspace(0.0, 6.0, 7), np.array([0.0, 1e-9, 1e-7])[:, None])
    assert np.abs(np.abs(up) - (0.0, 0.0, 1.0)).max() < 1e-5


def bumpy(random, count):
    x, y = np.meshgrid(np.arange(count) * 1.5, np.arange(count) * 1.5, indexing="ij")
    return np.stack([x, y, 0.0 * x], axis=-1) + np.round(random.uniform(-1.5, 1.5, (count, count, 3)) * (1, 1, 2))


def test_no_stroke_is_where_no_contour_is_on_random_splines():
    random = np.random.default_rng(1)
    for number in range(several(12, long=200)):
        kind = curves.BSpline(order=4) if number % 4 < 2 else curves.CubicSpline()
        surface = surfaces.spline_surface(bumpy(random, 4 + number % 2), kind)
        for eye, parallel in (((20.0, -9.0, 9.0), False), ((1.0, -0.6, 0.7), True)):
            part, _ = wrong_part(surface, np.array(eye), parallel)
            assert part < BESIDE, (number, parallel, part)


@pytest.mark.parametrize("seed", range(2))
def test_contours_do_not_depend_on_the_parametrisation(seed):
    random = np.random.default_rng(seed + 40)
    points, kind, eye = bumpy(random, 4), curves.BSpline(order=4), np.array([20.0, -9.0, 9.0])
    same = (points, points.swapaxes(0, 1), points[::-1], points[:, ::-1])
    lengths = [wrong_part(surfaces.spline_surface(grid, kind), eye, False)[1] for grid in same]
    assert np.ptp(lengths) < 0.01 * max(lengths), lengths


def changed(surface, swap, u_scale, v_scale):
    """The surface over parameters that are swapped, and divided by these numbers."""
    domain = surface.domain

    def old(a, b):
        u, v = (b, a) if swap else (a, b)
        return u * u_scale, v * v_scale

    ends_u, ends_v = (
        sorted((low / scale, high / scale))
        for low, high, scale in (
            (domain.u_start, domain.u_end, u_scale),
            (domain.v_start, domain.v_end, v_scale),
        )
    )
    closed = (domain.closed_u, domain.closed_v)
    ranges = (*ends_v, *ends_u, *closed[::-1]) if swap else (*ends_u, *ends_v, *closed)
    first = [lambda a, b, k=k, scale=(u_scale, v_scale)[k]: scale * surface.partials(*old(a, b))[k] for k in (0, 1)]
    scales = (u_scale * u_scale, u_scale * v_scale, v_scale * v_scale)
    second = [lambda a, b, k=k, scale=scales[k]: scale * surface.second_partials(*old(a, b))[k] for k in (0, 1, 2)]
    return surfaces.surface_of_function(
        lambda a, b: surface.points(*old(a, b)),
        surfaces.Domain(*ranges),
        partials=first[::-1] if swap else first,
        second_partials=second[::-1] if swap else second,
    )


def found_contour(surface, eye, parallel):
    return (parallel_contour if parallel else features.contour)(surface, np.array(eye) * (1, 3)[not parallel])


def ends_inside(surface, found):
    """How many ends of curves lie inside the domain."""
    domain, open_ones = surface.domain, np.flatnonzero(~found.closed)
    ends = np.concatenate([found.offsets[open_ones], found.offsets[open_ones + 1] - 1])
    u, v = wrapped(domain, found.u[ends], found.v[ends])
    on_border = np.zeros(len(u), dtype=bool)
    for t, closed, low, high in (
        (u, domain.closed_u, domain.u_start, domain.u_end),
        (v, domain.closed_v, domain.v_start, domain.v_end),
    ):
        on_border |= (not closed) & (np.minimum(t - low, high - t) <= 1e-6 * (high - low))
    return int((~on_border).sum())


def along(line):
    """Points on the chords of a polyline."""
    return (line[:-1, None] + np.linspace(0.0, 1.0, 60)[:, None] * np.diff(line, axis=0)[:, None]).reshape(-1, 3)


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", PINCHED)
def test_a_contour_passes_every_pinch_point_as_one_stroke(name, parallel, tmp_path):
    text, eye = PINCHED[name]
    surface = read_surface(text, tmp_path)
    found = found_contour(surface, eye, parallel)
    assert ends_inside(surface, found) == 0 and not found.doubts
    pinches = pinch_points(surface).at
    assert len(pinches)
    points = surface.points(*pinches.T)
    extent = np.ptp(found.points, axis=0).max()
    apart = [np.linalg.norm(points[:, None] - along(found[k]), axis=-1).min(axis=1) for k in range(len(found))]
    assert np.min(apart, axis=0).max() < 2e-3 * extent


@pytest.mark.parametrize("swap", [False, True])
@pytest.mark.parametrize(("u_scale", "v_scale"), [(-1.0, 1.0), (3.0, -0.7)])
@pytest.mark.parametrize("name", PINCHED)
def test_contours_through_pinch_points_do_not_depend_on_the_parametrisation(name, swap, u_scale, v_scale, tmp_path):
    text, eye = PINCHED[name]
    surface = read_surface(text, tmp_path)
    before, after = (found_contour(one, eye, False) for one in (surface, changed(surface, swap, u_scale, v_scale)))
    assert sorted(before.closed) == sorted(after.closed)
    lengths = [
        sorted(np.linalg.norm(np.diff(own[k], axis=0), axis=1).sum() for k in range(len(own)))
        for own in (before, after)
    ]
    assert np.allclose(*lengths, rtol=0.0, atol=2e-3 * max(lengths[0])), lengths
