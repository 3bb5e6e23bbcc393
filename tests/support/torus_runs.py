"""The curves of a torus in closed form, and the runs of each that one sees, from the discriminants of sight rays.

Along a curve the roots of the ray's cubic (the root 0 taken out) change their signs or number only at zeros of its
constant and of its discriminant: these are the events, and between two of them one decision holds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from support.analytic_sight import sight, torus_polynomial
from vectorplot.geometry.camera import Camera
from vectorplot.surfaces.tori import Torus
from vectorplot.words import LineKind

SAMPLES = 2048
BISECTIONS = 34
TURN = 2.0 * np.pi


class Run(NamedTuple):
    """From start to end of a curve's parameter, which goes from 0 to 1 and around; length of its image, any unit."""

    start: float
    end: float
    visible: bool
    length: float


@dataclass(frozen=True)
class TorusCurve:
    """A closed curve: parameters(s) -> u, v with the period 1; place(u, v) -> s, and how far from the curve that is."""

    name: str
    kind: LineKind
    parameters: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    place: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def turns(x: np.ndarray) -> np.ndarray:
    """Differences of angles, between -pi and pi."""
    return (np.asarray(x) + np.pi) % TURN - np.pi


def parameter_lines(columns: int, rows: int) -> list[TorusCurve]:
    found = []
    for k in range(columns):
        u0 = TURN * k / columns
        found.append(
            TorusCurve(
                f"column {k}",
                LineKind.PARAMETER,
                lambda s, u0=u0: (np.full_like(s, u0), TURN * s),
                lambda u, v, u0=u0: (v / TURN % 1.0, np.abs(turns(u - u0))),
            )
        )
    for k in range(rows):
        v0 = TURN * k / rows
        found.append(
            TorusCurve(
                f"row {k}",
                LineKind.PARAMETER,
                lambda s, v0=v0: (TURN * s, np.full_like(s, v0)),
                lambda u, v, v0=v0: (u / TURN % 1.0, np.abs(turns(v - v0))),
            )
        )
    return found


def outward(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """(..., 3) unit normals out of the tube; the torus' own are opposite."""
    return np.stack([-np.cos(v) * np.cos(u), -np.cos(v) * np.sin(u), np.sin(v) + 0.0 * u], axis=-1)


def gauss_circle(name: str, kind: LineKind, direction: np.ndarray, cosine: float) -> list[TorusCurve]:
    """The curves on which the outward normal makes an angle with a direction: circles of normals, each on the inner and
    on the outer half of the torus."""
    axis = direction / np.linalg.norm(direction)
    a = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    a /= np.linalg.norm(a)
    b = np.cross(axis, a)
    found = []
    for half, sign in (("inner", 1.0), ("outer", -1.0)):

        def parameters(s, sign=sign):
            angle = (TURN * s)[..., None]
            m = cosine * axis + np.sqrt(1.0 - cosine**2) * (np.cos(angle) * a + np.sin(angle) * b)
            return np.arctan2(-sign * m[..., 1], -sign * m[..., 0]), np.arctan2(
                m[..., 2], sign * np.hypot(m[..., 0], m[..., 1])
            )

        def place(u, v, sign=sign):
            m = outward(u, v)
            off = np.abs(m @ axis - cosine) + np.where(np.cos(v) * sign > -1e-9, 0.0, 9.0)
            return np.arctan2(m @ b, m @ a) / TURN % 1.0, off

        found.append(TorusCurve(f"{name}, {half} half", kind, parameters, place))
    return found


def central_contour(torus: Torus, eye: np.ndarray) -> list[TorusCurve]:
    """The contour from an eye outside the slab of the torus, |z| > b: the normal is perpendicular to the ray where
    R cos(v - phi) = b."""
    e = eye - np.asarray(torus.centre)

    def swing(u):
        across = e[0] * np.cos(u) + e[1] * np.sin(u) - torus.major
        return np.arctan2(e[2], -across), np.arccos(np.clip(torus.minor / np.hypot(across, e[2]), -1.0, 1.0))

    found = []
    for sign in (1.0, -1.0):

        def parameters(s, sign=sign):
            phi, half = swing(TURN * s)
            return TURN * s, phi + sign * half

        def place(u, v, sign=sign):
            phi, half = swing(u)
            return u / TURN % 1.0, np.abs(turns(v - phi - sign * half))

        found.append(TorusCurve(f"contour {sign:+g}", LineKind.CONTOUR, parameters, place))
    return found


def contour_of(torus: Torus, camera: Camera) -> list[TorusCurve]:
    if camera.parallel:
        return gauss_circle("contour", LineKind.CONTOUR, camera.direction, 0.0)
    return central_contour(torus, np.asarray(camera.eye))


def isophotes_of(light: np.ndarray, cosines: tuple[float, ...]) -> list[TorusCurve]:
    """In parallel light; the cosines are those of the torus' own, inward normal."""
    return [c for cosine in cosines for c in gauss_circle(f"isophote {cosine:g}", LineKind.ISOPHOTE, light, -cosine)]


def runs_of(torus: Torus, camera: Camera, curve: TorusCurve) -> list[Run]:
    """The visible and the hidden runs of a curve, in order; neighbours differ."""
    is_contour = curve.kind == LineKind.CONTOUR

    def look(s):
        """Constant, discriminant and whether one sees it, at parameters (n,)."""
        u, v = curve.parameters(s)
        points = torus.points(u, v)
        direction, _ = sight(camera, points)
        size = torus.major + torus.minor
        _, p, q, r, _ = (torus_polynomial(torus, points, direction) / size ** np.arange(5)).T
        if is_contour:
            discriminant = p * p - 4.0 * q
            hidden = (discriminant > 0.0) & ((q < 0.0) | (p < 0.0))
            return q, discriminant, ~hidden
        discriminant = 18 * p * q * r - 4 * p**3 * r + (p * q) ** 2 - 4 * q**3 - 27 * r * r
        changes = sum((x * y < 0.0).astype(int) for x, y in ((1.0 + 0 * p, p), (p, q), (q, r)))
        # With a zero between them signs change once over it: zeros are events, no samples.
        return r, discriminant, np.where(discriminant < 0.0, r > 0.0, changes == 0)

    s = (np.arange(SAMPLES) + 0.4637) / SAMPLES
    ends = np.append(s, s[0] + 1.0)
    values = np.stack(look(ends)[:2])
    which, k = np.nonzero(values[:, :-1] * values[:, 1:] < 0.0)
    low, high, start = ends[k], ends[k + 1], values[which, k]
    each = np.arange(len(k))
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        same = np.stack(look(middle)[:2])[which, each] * start > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    events = [0.5 * (low + high)]
    events += [_near_misses(lambda x, w=w: look(x)[w], ends, values[w]) for w in (0, 1)]
    cuts = np.unique(np.concatenate(events) % 1.0)
    if not len(cuts):
        return [Run(0.0, 1.0, bool(look(np.array([0.123]))[2][0]), np.inf)]
    after = np.append(cuts[1:], cuts[0] + 1.0)
    seen = look(0.5 * (cuts + after))[2]
    changes = np.flatnonzero(seen != np.roll(seen, 1))
    if not len(changes):
        return [Run(0.0, 1.0, bool(seen[0]), np.inf)]
    starts = cuts[changes]
    stops = np.append(starts[1:], starts[0] + 1.0)
    return [
        Run(float(a), float(b), bool(seen[k]), _length(torus, camera, curve, a, b))
        for a, b, k in zip(starts, stops, changes, strict=True)
    ]


def _length(torus: Torus, camera: Camera, curve: TorusCurve, a: float, b: float) -> float:
    """Length of the image in the plane through the target that faces the eye."""
    points = torus.points(*curve.parameters(np.linspace(a, b, 65))) - np.asarray(camera.target)
    at = points @ camera.axes.T
    if not camera.parallel:
        at = at * (camera.distance / (camera.distance - at[:, 2:]))
    return float(np.linalg.norm(np.diff(at[:, :2], axis=0), axis=1).sum())


def _zeros(function, s, value) -> np.ndarray:
    k = np.flatnonzero(value[:-1] * value[1:] < 0.0)
    low, high, start = s[k], s[k + 1], value[k]
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        same = function(middle) * start > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high)


def _near_misses(function, s, value) -> np.ndarray:
    """Pairs of zeros between samples that all have one sign."""
    size = np.abs(value)
    k = 1 + np.flatnonzero((size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]))
    k = k[(value[k - 1] * value[k] > 0.0) & (value[k] * value[k + 1] > 0.0)]
    # Only where the parabola through three samples comes near to zero at all.
    slope, bend = (size[k + 1] - size[k - 1]) / 2.0, size[k + 1] - 2.0 * size[k] + size[k - 1]
    k = k[size[k] - slope**2 / (2.0 * np.maximum(bend, 1e-300)) < 0.5 * size[k]]
    if not len(k):
        return np.zeros(0)
    low, high, sign = s[k - 1], s[k + 1], np.sign(value[k])
    golden = 0.5 * (np.sqrt(5.0) - 1.0)
    for _ in range(40):
        x, y = high - golden * (high - low), low + golden * (high - low)
        less = function(x) * sign < function(y) * sign
        low, high = np.where(less, low, x), np.where(less, y, high)
    middle = 0.5 * (low + high)
    crossed = function(middle) * sign < 0.0
    found = []
    for j, m in zip(k[crossed], middle[crossed], strict=True):
        for a, b in ((s[j - 1], m), (m, s[j + 1])):
            ends = np.array([a, b])
            found.append(_zeros(function, ends, function(ends)))
    return np.concatenate([np.zeros(0), *found])


class Drawn(NamedTuple):
    """What chords show of a curve: visible and hidden intervals of its parameter, joined; length of all of them."""

    visible: list[tuple[float, float]]
    hidden: list[tuple[float, float]]
    whole: float


def drawn_runs(torus: Torus, curves: list[TorusCurve], start, end, kind, hidden) -> tuple[list[Drawn], int]:
    """The runs of each curve as chords (n,3) show them, and how many chords lie on none of the curves."""
    nearest, which = np.full(len(start), np.inf), np.full(len(start), -1)
    low, high = np.zeros(len(start)), np.zeros(len(start))
    places = []
    for points in (start, end):
        p = points - np.asarray(torus.centre)
        v = np.arctan2(p[:, 2], torus.major - np.hypot(p[:, 0], p[:, 1]))
        places.append((np.arctan2(p[:, 1], p[:, 0]), v))
    for c, curve in enumerate(curves):
        k = np.flatnonzero(kind == curve.kind)
        (s, off), (t, end_off) = (curve.place(u[k], v[k]) for u, v in places)
        step = (t - s + 0.5) % 1.0 - 0.5
        away = np.where(np.abs(step) > 0.3, 9.0, np.maximum(off, end_off))
        won = away < nearest[k]
        k, s, step = k[won], s[won], step[won]
        nearest[k], which[k] = away[won], c
        low[k], high[k] = np.minimum(s, s + step), np.maximum(s, s + step)
    found, lost = [], nearest > 2e-6
    for c in range(len(curves)):
        own = (which == c) & ~lost
        parts = [joined_intervals(low[own & there], high[own & there]) for there in (~hidden, hidden)]
        found.append(Drawn(parts[0], parts[1], float((high - low)[own].sum())))
    return found, int((lost & np.isin(kind, [int(curve.kind) for curve in curves])).sum())


def joined_intervals(low: np.ndarray, high: np.ndarray, gap: float = 1e-9) -> list[tuple[float, float]]:
    """Intervals on the circle of length 1 that touch each other, as one."""
    found: list[list[float]] = []
    order = np.argsort(low % 1.0)
    for a, b in zip((low % 1.0)[order], (low % 1.0 + high - low)[order], strict=True):
        if found and a <= found[-1][1] + gap:
            found[-1][1] = max(found[-1][1], b)
        else:
            found.append([a, b])
    while len(found) > 1 and found[-1][1] >= found[0][0] + 1.0 - gap:
        last = found.pop()
        found[0] = [last[0] - 1.0, max(found[0][1], last[1] - 1.0)]
    return [(float(a), float(b)) for a, b in found]
