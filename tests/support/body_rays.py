"""Whether balls, capped bodies and boxes hide points, by sight rays in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.geometry.camera import Camera
from vectorplot.surfaces.capped_bodies import CappedQuadric, ball_of, capped_quadric_of

ON, THIN, BESIDE = 1e-7, 1e-4, 1e-5
"""Points so near to a surface lie on it; rays so short in a body touch it; bodies so much larger or smaller are the
same; all as parts of bodies."""


@dataclass(frozen=True, eq=False)
class BodySight:
    """By how many of the bodies each point (k,) is hidden, and whether that is sure."""

    hidden_by: np.ndarray
    sure: np.ndarray


def unit_body(shape) -> CappedQuadric:
    """A ball or a capped body."""
    if ball := ball_of(shape):
        return CappedQuadric(ball.centre, ball.frame, -1.0, 1.0, (0.0, 0.0), True)
    found = capped_quadric_of(shape)
    assert found
    return found


def inside(body: CappedQuadric, s, d, grown):
    """From where to where s + t d is in a unit body that is grown by so much."""
    low, high = body.low - grown, body.high + grown
    if body.is_round:
        base, slope = 1.0 + grown, 0.0
        a, b, c = (d * d).sum(1), (s * d).sum(1), (s * s).sum(1) - base * base
    else:
        slope = body.radii[1] - body.radii[0]
        base = body.radii[0] + grown + slope * s[:, 2]
        rise = slope * d[:, 2]
        a = d[:, 0] ** 2 + d[:, 1] ** 2 - rise**2
        b = s[:, 0] * d[:, 0] + s[:, 1] * d[:, 1] - base * rise
        c = s[:, 0] ** 2 + s[:, 1] ** 2 - base * base
    with np.errstate(all="ignore"):
        one, two = (low - s[:, 2]) / d[:, 2], (high - s[:, 2]) / d[:, 2]
        level = np.abs(d[:, 2]) < 1e-14
        between = (s[:, 2] > low) & (s[:, 2] < high)
        enter = np.where(level, np.where(between, -np.inf, np.inf), np.minimum(one, two))
        leave = np.where(level, np.where(between, np.inf, -np.inf), np.maximum(one, two))
        square = b * b - a * c
        root = np.sqrt(square)
        q = -(b + np.where(b >= 0, 1.0, -1.0) * root)
        first, last = np.minimum(q / a, c / q), np.maximum(q / a, c / q)
    met = square > 0.0
    # An ordinary body: between the roots; a cone that rises faster than the ray: one of the parts beside them.
    round_ = a > 0.0
    below = met & ~round_ & (np.minimum(leave, first) > enter)
    start = np.where(round_, np.where(met, np.maximum(enter, first), np.inf), np.where(met & ~below, last, -np.inf))
    end = np.where(round_, np.where(met, np.minimum(leave, last), -np.inf), np.where(below, first, np.inf))
    return np.maximum(start, enter), np.minimum(end, leave)


def off_surface(body: CappedQuadric, s):
    """How far points are off the surface of a unit body, about."""
    across, z = np.hypot(s[:, 0], s[:, 1]), s[:, 2]
    if body.is_round:
        radius = np.sqrt(np.maximum(1.0 - np.clip(z, -1, 1) ** 2, 0.0))
        mantle = np.sqrt(across**2 + z**2) - 1.0
    else:
        radius = body.radii[0] + (body.radii[1] - body.radii[0]) * z
        mantle = across - radius
    return np.abs(np.maximum(np.maximum(body.low - z, z - body.high), mantle))


def body_sight(camera: Camera, points: np.ndarray, bodies, boxes=()) -> BodySight:
    """Rays from points to the eye among unit_body bodies and boxes (low, high)."""
    target, eye = np.asarray(camera.target), np.asarray(camera.eye)
    towards = np.broadcast_to(eye - target, points.shape) if camera.parallel else eye - points
    longest = np.inf if camera.parallel else 1.0
    count, sure = np.zeros(len(points), dtype=int), np.ones(len(points), dtype=bool)
    for body in bodies:
        inverse = np.linalg.inv(body.frame)
        s, d = (points - body.centre) @ inverse, towards @ inverse
        # Lengths along rays as parts of the body.
        unit = np.sqrt((d * d).sum(1))
        on = off_surface(body, s) < ON
        lengths = []
        for grown in (BESIDE, -BESIDE):
            start, end = inside(body, s, d, grown)
            lengths.append((np.minimum(end, longest) - np.maximum(start, 0.0)) * unit)
        start, end = inside(body, s, d, 0.0)
        own = (np.minimum(end, longest) - np.maximum(start, 0.0)) * unit
        hidden = np.where(on, own > THIN, lengths[1] > 0.0)
        known = np.where(on, (own > 100 * THIN) | (own < 0.01 * THIN), (lengths[0] > 0.0) == (lengths[1] > 0.0))
        count += hidden
        sure &= known
    for low, high in boxes:
        with np.errstate(divide="ignore", invalid="ignore"):
            one, two = (low - points) / towards, (high - points) / towards
        enter, leave = np.nanmax(np.minimum(one, two), axis=1), np.nanmin(np.maximum(one, two), axis=1)
        within = np.minimum(leave, longest) - np.maximum(enter, 0.0)
        count += within > 0.0
        sure &= np.abs(within) > 1e-6
    return BodySight(count, sure)
