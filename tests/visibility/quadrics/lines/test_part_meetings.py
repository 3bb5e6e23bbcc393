"""The curves of pairs of bodies along the lines that sweep them: whole, once, and nothing where nothing is met."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.special import ellipe

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.capped_bodies import Capped, Frustum, rod
from vectorplot.surfaces.quadrics import Cone, Cylinder, Sphere

SEEN_FROM = Camera((8, -9, 6), (0, 0, 0), parallel=True)


def curves_of(*shapes):
    """The points (n,3) of all curves in which shapes meet, hidden or not, at a fine tolerance."""
    scene = Scene(tuple(Item(str(k), shape) for k, shape in enumerate(shapes)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drawing = draw(scene, SEEN_FROM, lines=("intersection",), hidden="solid", curves="polyline", tolerance_mm=0.005)
    parts = [paths for layer in drawing.layers for paths in layer.strokes]
    return [
        paths.points3d[[*range(a, b), *[a] * bool(closed)]]
        for paths in parts
        for a, b, closed in zip(paths.offsets[:-1], paths.offsets[1:], paths.closed, strict=True)
    ]


def length(curves):
    return sum(float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) for points in curves)


def length_where(curves, off):
    """Of the chords with both ends on something."""
    on = [np.abs(off(points)) < 1e-7 for points in curves]
    return sum(
        float(np.linalg.norm(np.diff(points, axis=0), axis=1)[here[1:] & here[:-1]].sum())
        for points, here in zip(curves, on, strict=True)
    )


def ellipse(a, b):
    """The circumference."""
    return 4.0 * max(a, b) * ellipe(1.0 - (min(a, b) / max(a, b)) ** 2)


@pytest.mark.slow
@pytest.mark.parametrize(("angle", "scale"), [(10.0, 1.0), (40.0, 1e-6), (90.0, 1.0), (90.0, 1e6)])
def test_equal_cylinders_meet_in_two_ellipses_that_cross(angle, scale):
    half = np.radians(angle) / 2.0
    way = scale * 20.0 * np.array([[np.cos(half), np.sin(half), 0.0], [np.cos(half), -np.sin(half), 0.0]])
    curves = curves_of(*(rod(-w, w, scale) for w in way))
    truth = ellipse(1.0, 1.0 / np.sin(half)) + ellipse(1.0, 1.0 / np.cos(half))
    assert length(curves) / scale == pytest.approx(truth, rel=1e-4)


@pytest.mark.slow
def test_rods_of_a_chain_meet_in_their_mitre_and_their_ends_in_a_line():
    joint = np.zeros(3)
    bent = curves_of(rod((-3, 0, 0), joint, 0.5), rod(joint, (0, -3, 0), 0.5))
    assert length_where(bent, lambda p: np.abs(p[:, 0] - p[:, 1])) == pytest.approx(length(bent))
    assert length(bent) == pytest.approx(0.5 * ellipse(0.5, 0.5 * np.sqrt(2.0)) + 1.0, rel=1e-4)


@pytest.mark.slow
def test_a_cap_in_a_rod_that_it_stands_across_is_met_in_straight_lines():
    inside = curves_of(rod((-2, 0, 0), (2, 0, 0), 0.5), rod((0, 0, 0.3), (0, 0, 3), 0.2))
    across = curves_of(rod((-2, 0, 0), (2, 0, 0), 0.5), rod((0, 0, 0.45), (0, 0, 3), 0.3))
    # The end of the one is wholly inside; that of the other comes out on both sides, along rulings.
    assert length_where(inside, lambda p: p[:, 2] - 0.3) == 0.0
    y = np.sqrt(0.25 - 0.45**2)
    along = [length_where(across, lambda p, y=y: np.hypot(p[:, 1] - y, p[:, 2] - 0.45)) for y in (-y, y)]
    assert along == pytest.approx([2.0 * np.sqrt(0.09 - y * y)] * 2, rel=1e-6)


@pytest.mark.parametrize(
    "shapes",
    [
        (Capped(Cone.standing(1.0, 2.0)), Capped(Cone.standing(0.8, 1.5))),
        (rod((0, 0, 0), (0, 0, 2), 0.5), rod((0, 0, 0), (0, 0, 1), 0.3)),
        (Capped(Frustum(1.0, 0.6, 2.0)), rod((0, 0, 0.5), (0, 0, 1.5), 0.3)),
        (rod((-2, 0, 0), (2, 0, 0), 0.5), rod((-1, 0.1, 0), (1, 0.1, 0), 0.2)),
        (Capped(Sphere(1.0), (-0.5, 0.5)), rod((0, 0, -0.2), (0, 0, 0.3), 0.4)),
    ],
)
def test_a_body_inside_of_another_one_even_on_its_floor_meets_it_nowhere(shapes):
    assert not curves_of(*shapes)


@pytest.mark.slow
def test_coaxial_cones_meet_in_a_circle():
    curves = curves_of(Capped(Cone.standing(1.0, 2.0)), Capped(Cone.standing(0.8, 3.0)))
    # The radii 1 - z/2 and .8 (1 - z/3) are equal where z = 6/7.
    assert length(curves) == pytest.approx(2.0 * np.pi * (1.0 - 3.0 / 7.0), rel=1e-4)
    assert np.abs(np.concatenate(curves)[:, 2] - 6.0 / 7.0).max() < 1e-9


@pytest.mark.slow
def test_caps_that_cross_meet_in_the_line_they_share():
    tilted, flat = rod((0.3, 0, 0), (0.3 + 3, 0, 3), 0.5), Capped(Cylinder(2.0, -1.0, 0.0))
    assert length_where(curves_of(tilted, flat), lambda p: np.hypot(p[:, 0] - 0.3, p[:, 2])) == pytest.approx(1.0)


@pytest.mark.slow
def test_a_cut_that_only_just_is_one_is_found():
    # A plane that leaves a thousandth of a cylinder, and a ball that comes as little out of it.
    thin = curves_of(rod((-2, 0, 0), (2, 0, 0), 0.5), rod((0, 0, 0.4995), (0, 0, 3), 1.0))
    y = np.sqrt(0.25 - 0.4995**2)
    assert length_where(thin, lambda p: p[:, 2] - 0.4995) == pytest.approx(4.0 * np.sqrt(1.0 - y * y), rel=1e-6)
    ball = curves_of(rod((-2, 0, 0), (2, 0, 0), 0.5), Sphere(0.3, (0.2, 0.0, 0.2 + 1e-3)))
    radius = np.sqrt(2.0 * 1e-3 / (1.0 / 0.3 - 1.0 / 0.5))
    assert 0.5 < length(ball) / (2.0 * np.pi * radius) < 2.0
