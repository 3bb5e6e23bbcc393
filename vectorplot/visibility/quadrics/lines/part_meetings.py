"""The curves in which mantles and caps of bodies meet, pair by pair in whole arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import matmul
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT
from vectorplot.visibility.quadrics.bodies.seen_bodies import Bodies
from vectorplot.visibility.quadrics.bodies.seen_capped import BOTTOM, TOP
from vectorplot.visibility.quadrics.lines.cap_meetings import cap_meetings
from vectorplot.visibility.quadrics.lines.ruled_meetings import RuledCurves, ruled_meetings
from vectorplot.visibility.quadrics.lines.ruled_quadrics import Discs, Mantles, Quadrics, Ruled, chords_across

MANTLE = 2
"""The part of a body that is neither BOTTOM nor TOP: of a ball all of it."""


@dataclass(frozen=True, eq=False)
class PartPairs:
    """Pairs of parts of bodies: body (k,2), part (k,2): BOTTOM, TOP or MANTLE."""

    body: Ints
    part: Ints


def pairs_of_parts(bodies: Bodies, pairs: Ints) -> PartPairs:
    """All parts of the one with all parts of the other of pairs (p,2) of bodies; boxes that are apart are left out."""
    count = len(bodies.balls)
    there = np.ones((len(bodies), 3), dtype=np.bool_)
    there[:count, :MANTLE], there[count:, :MANTLE] = False, bodies.capped.has_cap
    found = []
    for one in (BOTTOM, TOP, MANTLE):
        for two in (BOTTOM, TOP, MANTLE):
            some = pairs[there[pairs[:, 0], one] & there[pairs[:, 1], two]]
            found.append(PartPairs(some, np.tile(np.array([one, two]), (len(some), 1))))
    every = records.joined(found)
    (low, high), (below, above) = (_box(bodies, every.body[:, k], every.part[:, k]) for k in range(2))
    slack = bodies.tolerance
    near = ((low <= above + slack) & (below <= high + slack)).all(axis=1)
    kept = records.some(every, np.flatnonzero(near))
    return records.some(kept, np.lexsort((kept.part[:, 1], kept.part[:, 0], kept.body[:, 1], kept.body[:, 0])))


def _box(bodies: Bodies, body: Ints, part: Ints) -> tuple[Floats, Floats]:
    """(k,3) smallest and largest coordinates of parts: of a mantle those of its body."""
    reach = bodies.reach[body]
    low, high = reach[:, 0].copy(), reach[:, 1].copy()
    cap = np.flatnonzero(part != MANTLE)
    which = body[cap] - len(bodies.balls)
    for end in (BOTTOM, TOP):
        at = part[cap] == end
        middle, a, b = bodies.capped.rims(which[at], end)
        size = np.hypot(a, b)
        low[cap[at]], high[cap[at]] = middle - size, middle + size
    return low, high


def part_meetings(bodies: Bodies, pairs: PartPairs, tracing: Tracing) -> tuple[RuledCurves, Ints]:
    """The curves in which pairs (k,2) of parts meet, in the coordinates of the bodies, and the pairs left open: two
    parts of balls, and what ruled_meetings leaves."""
    count = len(bodies.balls)
    flat = np.concatenate([np.zeros(count, dtype=np.bool_), ~bodies.capped.is_round])
    is_cap, is_flat = pairs.part != MANTLE, flat[pairs.body]
    tolerance = tracing.tolerance
    if tolerance is None:
        tolerance = CHORD_OF_EXTENT * float(np.ptp(bodies.reach, axis=(0, 1)).max())
    picture = tracing.picture

    def image(points: Floats) -> Floats:
        seen = bodies.sight.points_of_view(points)
        return seen if picture is None else picture(seen)

    mantles = ~is_cap.any(axis=1)
    found, left = [], [np.flatnonzero(mantles & ~is_flat.any(axis=1))]

    def find(which: Bools, side: int, swept: Callable[[Ints, Ints, Quadrics], Ruled]) -> None:
        row = np.flatnonzero(which)
        quadrics = _quadrics(bodies, pairs.body[row, 1 - side])
        ruled = swept(pairs.body[row, side], pairs.part[row, side], quadrics)
        lines, open_ = ruled_meetings(ruled, quadrics, image, tolerance)
        found.append(replace(lines, row=row[lines.row]))
        left.append(row[open_])

    for side in (0, 1):
        find(is_cap[:, side] & ~is_cap[:, 1 - side], side, partial(_caps, bodies))
    find(mantles & is_flat[:, 0], 0, partial(_mantles, bodies))
    find(mantles & ~is_flat[:, 0] & is_flat[:, 1], 1, partial(_mantles, bodies))
    row = np.flatnonzero(is_cap.all(axis=1))
    one, two = (_discs(bodies, pairs.body[row, k], pairs.part[row, k]) for k in range(2))
    start, end, met = cap_meetings(one, two, bodies.tolerance)
    many = int(met.sum())
    points = np.stack([start[met], end[met]], axis=1).reshape(-1, 3)
    found.append(RuledCurves(points, 2 * np.arange(many + 1), np.zeros(many, dtype=np.bool_), row[met]))
    return _together(found), np.sort(np.concatenate(left))


def parts_shown(bodies: Bodies, body: Ints, part: Ints) -> Floats:
    """(k,4) linear forms that are negative where parts of bodies are turned away."""
    count = len(bodies.balls)
    forms = np.zeros((len(body), 4))
    for kind in (BOTTOM, TOP):
        at = np.flatnonzero(part == kind)
        forms[at, 3] = np.where(bodies.capped.faces_eye[body[at] - count, kind], 1.0, -1.0)
    of_ball = np.flatnonzero((part == MANTLE) & (body < count))
    forms[of_ball] = bodies.balls.polar_planes(body[of_ball])
    of_capped = np.flatnonzero((part == MANTLE) & (body >= count))
    forms[of_capped] = bodies.capped.polar_planes(body[of_capped] - count)
    return forms


def forms_of_parts(bodies: Bodies, body: Ints, part: Ints) -> Floats:
    """(k,4,4) the quadrics, or planes, of parts of bodies: x form x = 0 for homogeneous points x of the view."""
    sight = bodies.sight
    quadrics = _quadrics(bodies, body)
    in_unit = np.zeros((len(body), 4, 4))
    in_unit[:, 0, 0] = in_unit[:, 1, 1] = 1.0
    in_unit[:, 2, 2], in_unit[:, 3, 3] = quadrics.bend, quadrics.constant
    in_unit[:, 2, 3] = in_unit[:, 3, 2] = quadrics.slope
    cap = np.flatnonzero(part != MANTLE)
    in_unit[cap] = 0.0
    in_unit[cap, 2, 3] = in_unit[cap, 3, 2] = 0.5
    in_unit[cap, 3, 3] = -quadrics.ends[cap, part[cap]]
    to_unit = np.zeros((len(body), 4, 4))
    to_unit[:, :3, :3] = np.einsum("ij,njk->nik", sight.vectors(np.eye(3)), quadrics.inverse)
    to_unit[:, 3, :3] = quadrics.unit(np.arange(len(body)), np.broadcast_to(sight.points(np.zeros(3)), (len(body), 3)))
    to_unit[:, 3, 3] = 1.0
    return np.asarray(matmul(matmul(to_unit, in_unit), to_unit.transpose(0, 2, 1)))


def _quadrics(bodies: Bodies, which: Ints) -> Quadrics:
    """The mantles of bodies."""
    balls, capped, count = bodies.balls, bodies.capped, len(bodies.balls)
    growth, base = capped.growth, capped.radii[:, BOTTOM]
    one, infinite = np.ones(count), np.tile([-np.inf, np.inf], (count, 1))
    every = Quadrics(
        np.concatenate([balls.centre, capped.centre]),
        np.concatenate([balls.frame, capped.frame]),
        np.concatenate([one, np.where(capped.is_round, 1.0, -growth * growth)]),
        np.concatenate([0.0 * one, np.where(capped.is_round, 0.0, -growth * base)]),
        np.concatenate([-one, np.where(capped.is_round, -1.0, -base * base)]),
        np.concatenate([infinite, capped.ends]),
    )
    return records.some(every, which)


def _caps(bodies: Bodies, which: Ints, end: Ints, met: Quadrics) -> Discs:
    """Caps at ends of capped bodies, as chords sweep them."""
    return chords_across(_discs(bodies, which, end), met)


def _mantles(bodies: Bodies, which: Ints, part: Ints, met: Quadrics) -> Mantles:
    """The mantles of frusta, as lines sweep them."""
    capped = which - len(bodies.balls)
    return Mantles(_quadrics(bodies, which), bodies.capped.radii[capped, BOTTOM], bodies.capped.growth[capped])


def _discs(bodies: Bodies, which: Ints, end: Ints) -> Discs:
    """Caps at ends of capped bodies."""
    capped = which - len(bodies.balls)
    centre, across, along = np.empty((3, len(which), 3))
    for number in (BOTTOM, TOP):
        at = end == number
        centre[at], across[at], along[at] = bodies.capped.rims(capped[at], number)
    return Discs(centre, across, along)


def _together(parts: list[RuledCurves]) -> RuledCurves:
    """All curves."""
    return RuledCurves(
        np.concatenate([part.points for part in parts]),
        ragged.offsets(np.concatenate([np.diff(part.offsets) for part in parts])),
        np.concatenate([part.closed for part in parts]),
        np.concatenate([part.row for part in parts]),
    )
