"""Developable surfaces unrolled: closed forms of cylinders and cones, and lengths of curves on others."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vectorplot as vp
from vectorplot.io import parse_scene
from vectorplot.pictures.development import Unrolled
from vectorplot.surfaces import Cone, Cylinder, Frustum, PlacedSurface, Torus
from vectorplot.surfaces.surface import Domain, Transposed


def surface_of(text):
    """The surface of an item of a scene file."""
    return parse_scene(f"S surface {text}").items[0].shape


TANGENTS = 'function "cos(u) - v*sin(u)" "sin(u) + v*cos(u)" "u/2 + v/2" u 0 4 v 0.5 2'
"""Points on the tangents of a helix."""


def places(surface, seed, count=50):
    domain, random = surface.domain, np.random.default_rng(seed)
    return random.uniform(domain.u_start, domain.u_end, count), random.uniform(domain.v_start, domain.v_end, count)


def length_of_curve(points):
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def test_a_cylinder_becomes_a_rectangle():
    u, v = places(Cylinder(1.3, -1.0, 2.0), 1)
    flat = Unrolled.of(Cylinder(1.3, -1.0, 2.0)).placed(u, v)
    assert flat == pytest.approx(np.stack([1.3 * u, v + 1.0], axis=1), abs=1e-9)


def test_a_cone_becomes_a_sector():
    cone = Frustum(2.0, 1.0, 3.0)
    apex, side = 6.0, np.hypot(3.0, 1.0)
    u, v = places(cone, 2)
    flat = Unrolled.of(cone).placed(u, v)
    corner = Unrolled.of(cone).placed(np.array([0.0, 0.0]), np.array([0.0, 3.0]))
    middle = corner[0] + (corner[1] - corner[0]) / side * np.hypot(2.0, apex)
    assert np.linalg.norm(flat - middle, axis=1) == pytest.approx((apex - v) * side / 3.0, abs=1e-9)
    ends = Unrolled.of(cone).placed(np.array([0.0, 2 * np.pi]), np.zeros(2)) - middle
    angle = np.arccos(ends[0] @ ends[1] / np.linalg.norm(ends[0]) / np.linalg.norm(ends[1]))
    assert min(angle, 2 * np.pi - angle) == pytest.approx(2 * np.pi * 2.0 / np.hypot(2.0, apex), abs=1e-9)


@pytest.mark.parametrize(
    "surface",
    [
        Cylinder(2.0, 0.0, 2.0, depth=0.7),
        Cone(1.0, 0.2, 1.0, depth_slope=0.4),
        Transposed(Cylinder(1.0, 0.0, 3.0), Domain(0.0, 3.0, 0.0, 2.0 * np.pi, closed_v=True)),
        surface_of(TANGENTS),
        PlacedSurface(Frustum(1.0, 0.3, 2.0), np.diag([2.0, 2.0, 2.0]), (5, 6, 7)),
    ],
)
@given(st.integers(0, 1000))
@pytest.mark.slow
def test_lengths_of_straight_ways_in_the_parameters_are_kept(surface, seed):
    unrolled = Unrolled.of(surface)
    domain = surface.domain
    (u0, u1), (v0, v1) = places(surface, seed, 2)
    way = np.linspace(0.0, 1.0, 2001)
    u, v = u0 + way * (u1 - u0), v0 + way * (v1 - v0)
    flat = unrolled.placed(v, u) if isinstance(unrolled.surface, Transposed) else unrolled.placed(u, v)
    # Both are polygons of the same chords, whose sums differ by the cube of a step.
    assert length_of_curve(flat) == pytest.approx(length_of_curve(surface.points(u, v)), rel=3e-6)
    assert domain.size[0] > 0.0


def test_rulings_and_angles_are_kept():
    surface = Cone(1.0, 0.2, 1.0, depth_slope=0.4)
    unrolled = Unrolled.of(surface)
    u, v = places(surface, 5)
    other = np.full_like(v, 0.5)
    straight = np.linalg.norm(unrolled.placed(u, v) - unrolled.placed(u, other), axis=1)
    space = np.linalg.norm(surface.points(u, v) - surface.points(u, other), axis=1)
    assert straight == pytest.approx(space, abs=1e-9)


def test_what_is_no_developable_surface_is_told():
    with pytest.raises(vp.InputError, match="no straight lines along its parameters"):
        Unrolled.of(Torus(3.0, 1.0))
    with pytest.raises(vp.InputError, match=r"tangent plane turns by \d+(\.\d+)? degrees along a ruling"):
        Unrolled.of(surface_of("helicoid 1.5"))
