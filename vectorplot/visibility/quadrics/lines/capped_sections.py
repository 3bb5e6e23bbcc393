"""Plane sections and isophotes of frusta and of parts of balls between flat ends: conics, and straight lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import determinant
from vectorplot.geometry.elementary import arccos, arctan, arctan2, tan
from vectorplot.geometry.vectors import dot
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import NARROW_CONIC
from vectorplot.tolerances.of_values import HOMOTHETIC
from vectorplot.visibility.quadrics.bodies.seen_balls import sphere_sections
from vectorplot.visibility.quadrics.bodies.seen_capped import BOTTOM, TOP, CappedBodies
from vectorplot.visibility.quadrics.lines.asked_lines import Wants, cosines, lamps, section_planes, wanting
from vectorplot.visibility.quadrics.lines.ball_arcs import Found
from vectorplot.visibility.quadrics.lines.capped_arcs import (
    lines_on_caps,
    on_mantles,
    on_rims,
    rulings,
    straight_on_mantles,
)
from vectorplot.visibility.quadrics.lines.parts_of_circles import parts_inside
from vectorplot.words import LineKind

PLAIN_ELLIPSE = 4.0
"""An ellipse is run through by its own angles, however little of it there is, where the square of the factor by which
tangents of half of these differ from those of the mantle is no larger."""


@dataclass(frozen=True, eq=False)
class _Planes:
    """Planes unit . normal = height of unit bodies which (n,): normal (n,3), height (n,); values are distances in the
    coordinates of sight."""

    body: Ints
    normal: Floats
    height: Floats

    def at(self, z: Floats) -> Floats:
        """(n,) the distance from the point of the axis at height z (n,) to the plane."""
        return np.asarray(self.height - self.normal[:, 2] * z)


def capped_sections(view: View, bodies: CappedBodies, before: int, items: Sequence[Item], wants: Wants) -> list[Found]:
    """The sections and index lines that items with capped bodies ask for.

    Degenerate: planes that touch a body, or in which a cap lies, have no line in common with it.
    """
    found = []
    for kind in (LineKind.SECTION, LineKind.INDEX):
        body, normal, point = section_planes(view, bodies.sight, items, wanting(items, wants, kind), kind)
        unit = np.einsum("nij,nj->ni", bodies.frame[body], normal)
        planes = _Planes(body, unit, dot(point - bodies.centre[body], normal))
        is_round = bodies.is_round[body]
        found += _of_frusta(bodies, before, records.some(planes, np.flatnonzero(~is_round)), kind)
        found.append(_of_balls(bodies, before, records.some(planes, np.flatnonzero(is_round)), kind))
        found += [_of_caps(bodies, before, planes, end, kind) for end in (BOTTOM, TOP)]
    return found


def capped_isophotes(
    scene: Scene, view: View, bodies: CappedBodies, before: int, items: Sequence[Item], wants: Wants
) -> list[Found]:
    """The isophotes of round bodies in parallel light: rulings, and circles about the direction of the light."""
    which = wanting(items, wants, LineKind.ISOPHOTE)
    counts, cosine = cosines(items, which)
    direction, _, _ = lamps(scene, view, bodies.sight, items, which)
    owner = ragged.owner(counts)
    body, light = which[owner], (direction / np.sqrt(dot(direction, direction))[:, None])[owner]
    # Of a mirrored body the normals point inwards.
    cosine = cosine * -np.sign(determinant(bodies.frame[body]))
    is_round = bodies.is_round[body]
    flat, bent = np.flatnonzero(~is_round), np.flatnonzero(is_round)
    # Normals of mantles are (cos u, sin u, -growth) in the unit body, and so, as covectors, @ inverse in the picture.
    towards = np.einsum("nji,nj->ni", bodies.inverse[body[flat]], light[flat])
    across = bodies.inverse[body[flat]][:, :, 0]
    along = bodies.inverse[body[flat]][:, :, 2] * bodies.growth[body[flat], None]
    least = cosine[flat] * np.sqrt(dot(across, across) + dot(along, along))
    least = least + bodies.growth[body[flat]] * towards[:, 2]
    reach, turn = np.hypot(towards[:, 0], towards[:, 1]), arctan2(towards[:, 1], towards[:, 0])
    kept = np.flatnonzero(np.abs(least) < reach)
    half = arccos(least[kept] / reach[kept])
    angle = np.concatenate([turn[kept] - half, turn[kept] + half])
    found = [rulings(bodies, before, np.tile(body[flat[kept]], 2), angle, LineKind.ISOPHOTE)]
    normal = np.einsum("nij,nj->ni", bodies.frame[body[bent]], light[bent])
    planes = _Planes(body[bent], normal, cosine[bent] * np.sqrt(dot(normal, normal)))
    return [*found, _of_balls(bodies, before, planes, LineKind.ISOPHOTE)]


def are_round(bodies: CappedBodies) -> Bools:
    """(n,) which bodies are what their unit bodies are but for size, and for height where they are frusta."""
    product = np.einsum("nik,njk->nij", bodies.frame, bodies.frame)
    size = product[:, 0, 0]
    off = np.abs(product[:, 0, 0] - product[:, 1, 1]) + np.abs(product[:, [0, 0, 1], [1, 2, 2]]).sum(axis=1)
    off += np.where(bodies.is_round, np.abs(product[:, 2, 2] - size), 0.0)
    return np.asarray(off <= HOMOTHETIC * np.minimum(size, product[:, 2, 2]))


def _of_frusta(bodies: CappedBodies, before: int, planes: _Planes, kind: LineKind) -> list[Found]:
    """Sections of mantles of frusta, run through by the angle of the mantle.

    With the radius r + g z, and the plane a x + c z = h where x is turned towards the gradient of the plane, the point
    at the angle t is ((rc + gh) cos t, (rc + gh) sin t, h - ra cos t) / (c + ga cos t): a conic in the form of Arcs,
    but for a projective change of the parameter that makes its weights even. Source: this package's own.
    """
    body = planes.body
    steep = _snapped(np.hypot(planes.normal[:, 0], planes.normal[:, 1]), bodies.tolerance)
    bottom, top = bodies.radii[body].T
    growth = top - bottom
    # Normals such that the divisor is positive, and angles from where it is largest.
    signed = bottom * planes.normal[:, 2] + growth * planes.height
    flip, way = np.where(signed < 0.0, -1.0, 1.0), np.where(growth < 0.0, -1.0, 1.0)
    turn = arctan2(planes.normal[:, 1], planes.normal[:, 0]) + np.where(flip * way < 0.0, np.pi, 0.0)
    ends = _cosines_on_rims(planes, steep, bodies)
    ends = flip * way * ends
    least, most = (arccos(np.clip(pick(ends, axis=0), -1.0, 1.0)) for pick in (np.max, np.min))
    met = (ends.min(axis=0) < 1.0) & (ends.max(axis=0) > -1.0)
    narrow = (most - least < NARROW_CONIC) & (least > 0.0) & (most < np.pi)
    some = np.flatnonzero(met & narrow)
    found = []
    for side in (-1.0, 1.0):
        angles = turn[some] + side * arccos(np.clip(ends[:, some], -1.0, 1.0))
        start, end = (on_rims(bodies, body[some], k, angles[k]) for k in (BOTTOM, TOP))
        found.append(straight_on_mantles(bodies, before, body[some], start, end, kind))
    some = np.flatnonzero(met & ~narrow)
    conics = _Conics(
        turn[some],
        np.abs(signed)[some],
        (flip * planes.height)[some],
        (flip * planes.normal[:, 2])[some],
        (way * bottom * steep)[some],
        (np.abs(growth) * steep)[some],
        least[some],
        most[some],
    )
    return [*found, *_arcs_of(conics, bodies, before, body[some], kind)]


def _cosines_on_rims(planes: _Planes, steep: Floats, bodies: CappedBodies) -> Floats:
    """(2,n) the cosines of angles, from the gradients of planes, at which these meet the circles at the bottom and at
    the top; beyond 1 where they do not, to one side or the other."""
    ends = []
    with np.errstate(divide="ignore", invalid="ignore"):
        for end in (BOTTOM, TOP):
            height = _snapped(planes.at(bodies.ends[planes.body, end]), bodies.tolerance)
            ends.append(height / (bodies.radii[planes.body, end] * steep))
    # A plane through an apex meets rulings; one that meets neither circle lies in a cap.
    ends = [np.where(np.isnan(one), other, one) for one, other in (ends, ends[::-1])]
    return np.asarray(np.nan_to_num(np.stack(ends), nan=2.0, posinf=2.0, neginf=-2.0))


def _snapped(values: Floats, tolerance: float) -> Floats:
    return np.where(np.abs(values) <= tolerance, 0.0, values)


@dataclass(frozen=True, eq=False)
class _Conics:
    """Sections of mantles in their unit bodies: at the angle t, least <= |t| <= most, (x, y, z) = (size cos t,
    size sin t, height - fall cos t) / (divisor + growth cos t), x at the angle turn. All (n,), growth >= 0."""

    turn: Floats
    size: Floats
    height: Floats
    divisor: Floats
    fall: Floats
    growth: Floats
    least: Floats
    most: Floats


def _arcs_of(conics: _Conics, bodies: CappedBodies, before: int, body: Ints, kind: LineKind) -> list[Found]:
    """The arcs of sections of the mantles of bodies (n,)."""
    c, none = conics, np.zeros_like(conics.size)
    largest, smallest = c.divisor + c.growth, c.divisor - c.growth
    end = tan(0.5 * c.most) ** 2
    with np.errstate(divide="ignore"):
        even = np.where(smallest > 0.0, largest / smallest, np.inf)
    # The tangents of half the angles are divided by the root of this: weights are even, or 1 at the end of the arc.
    plain = even <= np.maximum(end, PLAIN_ELLIPSE)
    square = np.where(plain, even, end)
    factor = np.sqrt(square)
    # Homogeneous points of the unit body: the sum and the difference of what has no angle, and of what its cosine has.
    middle = np.stack([none, none, c.height, c.divisor], axis=1)
    first = np.stack([c.size, none, -c.fall, c.growth], axis=1)
    ahead, behind = middle + first, square[:, None] * (middle - first)
    middle, first = 0.5 * (ahead + behind), 0.5 * (ahead - behind)
    first[plain, 3] = 0.0
    weight = middle[:, 3]
    frame, centre = bodies.frame[body], bodies.centre[body]
    out = np.cos(c.turn)[:, None] * frame[:, 0] + np.sin(c.turn)[:, None] * frame[:, 1]
    side = np.cos(c.turn)[:, None] * frame[:, 1] - np.sin(c.turn)[:, None] * frame[:, 0]

    def placed(unit: Floats) -> Floats:
        unit = unit / weight[:, None]
        return np.asarray(unit[:, :1] * out + unit[:, 2:3] * frame[:, 2] + unit[:, 3:] * centre)

    circles = placed(middle), placed(first), (factor * c.size / weight)[:, None] * side
    low = 2.0 * arctan(tan(0.5 * c.least) / factor)
    high = np.where(c.most >= np.pi, np.pi, 2.0 * arctan(np.sqrt(end) / factor))
    begins, closes = low <= 0.0, high >= np.pi
    both, before_it, behind_it = ~begins & ~closes, begins & ~closes, closes
    spans = (
        (both, low, high),
        (both, -high, -low),
        (before_it, -high, high),
        (behind_it, low, 2.0 * np.pi - low),
    )
    found = []
    for chosen, start, stop in spans:
        some = np.flatnonzero(chosen)
        some_circles = circles[0][some], circles[1][some], circles[2][some]
        span = start[some], stop[some]
        shares = (first[:, 3] / weight)[some]
        found.append(on_mantles(bodies, before, some_circles, span, body[some], kind, shares))
    return found


def _of_balls(bodies: CappedBodies, before: int, planes: _Planes, kind: LineKind) -> Found:
    """Sections of balls, the parts of circles between their caps."""
    size = np.sqrt(dot(planes.normal, planes.normal))
    kept = np.flatnonzero(np.abs(planes.height) < size - bodies.tolerance)
    body, size = planes.body[kept], size[kept]
    circles = sphere_sections(
        bodies.centre[body], bodies.frame[body], planes.normal[kept] / size[:, None], planes.height[kept] / size
    )
    capped = [bodies.has_cap[body, end] for end in (BOTTOM, TOP)]
    index = np.concatenate([np.flatnonzero(some) for some in capped])
    forms = np.concatenate([-bodies.outside_of_cap(body[capped[end]], end) for end in (BOTTOM, TOP)])
    of, low, high = parts_inside(circles, index, forms, bodies.tolerance)
    some = circles[0][of], circles[1][of], circles[2][of]
    return on_mantles(bodies, before, some, (low, high), body[of], kind)


def _of_caps(bodies: CappedBodies, before: int, planes: _Planes, end: int, kind: LineKind) -> Found:
    """The straight sections of the caps at one end."""
    some = records.some(planes, np.flatnonzero(bodies.has_cap[planes.body, end]))
    steep = _snapped(np.hypot(some.normal[:, 0], some.normal[:, 1]), bodies.tolerance)
    reach = bodies.radii[some.body, end] * steep
    distance = some.at(bodies.ends[some.body, end])
    kept = np.flatnonzero(np.abs(distance) < reach - bodies.tolerance)
    body, half = some.body[kept], arccos(distance[kept] / reach[kept])
    turn = arctan2(some.normal[kept, 1], some.normal[kept, 0])
    start, stop = (on_rims(bodies, body, end, turn + sign * half) for sign in (-1.0, 1.0))
    return lines_on_caps(bodies, before, body, end, (start, stop), kind)
