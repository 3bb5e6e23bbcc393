"""Exercises of chapter 5, a contour.

Fill in the functions; ``python docs/course/check.py 5`` says which are right.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from vectorplot.features import Sites, contour
from vectorplot.surfaces import Ellipsoid, Sphere, Torus


def facing(surface: Any, u: np.ndarray, v: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """(k,) the cosine of the angle between the normal of a surface and the direction to the eye, at parameters (k,).

    surface.points(u, v) are (k, 3), surface.partials(u, v) the derivatives by u and by v. It is zero along the contour.
    """
    raise NotImplementedError


def contour_of_sphere(centre: np.ndarray, radius: float, eye: np.ndarray) -> tuple[np.ndarray, float]:
    """The centre (3,) and the radius of the circle that is the contour of a sphere.

    Hint: lines from the eye touch the sphere; draw the right triangle of eye, centre and a point of contact.
    """
    raise NotImplementedError


def bend_towards_eye(surface: Any, u: np.ndarray, v: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """(k,) normal curvatures along the lines of sight, at parameters (k,) of points of the contour.

    With the line of sight s = a X_u + b X_v, a unit vector, it is L a^2 + 2 M a b + N b^2, where L = n.X_uu,
    M = n.X_uv, N = n.X_vv with the unit normal n. surface.second_partials(u, v) are X_uu, X_uv, X_vv. Its zeros are
    the cusps.
    """
    raise NotImplementedError


# The checks: read them when a verdict is a riddle.


def check_facing(answer: Callable[..., np.ndarray]) -> None:
    """Against normals in closed form."""
    rng = np.random.default_rng(1)
    u, v = rng.uniform(0, 6, 40), rng.uniform(-1.4, 1.4, 40)
    for radius in (1.0, 2.5):
        eye, ball = rng.normal(size=3) * 6, Sphere(radius)
        points = ball.points(u, v)
        sight = eye - points
        expected = (points / radius * sight).sum(axis=1) / np.linalg.norm(sight, axis=1)
        found = np.asarray(answer(ball, u, v, eye))
        assert found.shape == (40,), f"expected an array (40,), found {found.shape}"
        assert not np.allclose(found, -expected), "the sign: the direction runs from the surface to the eye"
        assert np.allclose(found, expected), (
            f"a sphere of radius {radius}: expected {expected[0]:.4f}, found {found[0]:.4f}"
        )
    ring, eye = Torus(3.0, 1.0), np.array([8.0, -6.0, 5.0])
    curve = contour(ring, eye)
    assert np.abs(answer(ring, curve.u, curve.v, eye)).max() < 1e-9, "not zero along the contour of a torus"


def check_contour_of_sphere(answer: Callable[..., tuple[np.ndarray, float]]) -> None:
    """All points of the circle lie on the sphere, and the lines of sight touch it there."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        centre, radius, way = rng.normal(size=3), float(rng.uniform(0.5, 2.0)), rng.normal(size=3)
        eye = centre + way / np.linalg.norm(way) * radius * rng.uniform(1.1, 9.0)
        middle, found = answer(centre, radius, eye)
        axis = (eye - centre) / np.linalg.norm(eye - centre)
        side = np.cross(axis, (0.3, 0.5, -0.7))
        side /= np.linalg.norm(side)
        point = np.asarray(middle) + found * side
        assert np.isclose(np.linalg.norm(point - centre), radius), "the circle does not lie on the sphere"
        assert abs(((point - centre) * (eye - point)).sum()) < 1e-9 * radius, "lines of sight do not touch the sphere"


def check_bend_towards_eye(answer: Callable[..., np.ndarray]) -> None:
    """Against the package, on a ring and on an ellipsoid, which has no cusps."""
    eye = np.array([8.0, -6.0, 5.0])
    for surface, changes in ((Torus(3.0, 1.0), 4), (Ellipsoid((3.0, 2.0, 1.0)), 0)):
        curve = contour(surface, eye)
        sites = Sites(surface, curve.u, curve.v)
        sight = eye - sites.points
        expected = sites.bends(sight / np.linalg.norm(sight, axis=1, keepdims=True))
        found = np.asarray(answer(surface, curve.u, curve.v, eye))
        assert found.shape == expected.shape, f"expected an array {expected.shape}, found {found.shape}"
        name = type(surface).__name__
        assert np.allclose(found, expected, atol=1e-7), f"{name}: expected {expected[:2]}, found {found[:2]}"
        sign = [found[a:b] > 0 for a, b in zip(curve.offsets[:-1], curve.offsets[1:], strict=True)]
        cusps = sum(int((part != np.roll(part, 1)).sum()) for part in sign)
        assert cusps == changes, f"{name}: expected {changes} cusps, found {cusps}"
