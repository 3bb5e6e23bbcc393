"""The lines on frusta and parts of balls between flat ends: contours, rims and parameter lines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arcsin
from vectorplot.geometry.vectors import cross, dot
from vectorplot.scene.item import Item
from vectorplot.visibility.quadrics.bodies.capped_covers import ball_contours
from vectorplot.visibility.quadrics.bodies.seen_capped import BOTTOM, TOP, CappedBodies
from vectorplot.visibility.quadrics.conic_arcs import OwnSides, arcs_on, lines_on
from vectorplot.visibility.quadrics.lines.asked_lines import Wants
from vectorplot.visibility.quadrics.lines.ball_arcs import Found
from vectorplot.visibility.quadrics.lines.parts_of_circles import parts_inside
from vectorplot.words import LineKind

ALWAYS_TURNED_AWAY = np.array([0.0, 0.0, 0.0, -1.0])
"""The form of what lies on the far side as a whole."""

NO_SIDES = OwnSides(np.zeros(0, dtype=np.intp), np.zeros((0, 4)), np.zeros(0, dtype=np.intp))


def capped_arcs(bodies: CappedBodies, before: int, items: Sequence[Item], wants: Wants) -> list[Found]:
    """Contours, rims and parameter lines that items, one for each capped body, ask for; wants(item, kind) tells;
    before: how many bodies are numbered before these."""
    once = np.zeros(len(bodies), dtype=np.bool_)
    once[np.unique(bodies.same, return_index=True)[1]] = True
    contour, crease, parameter = (
        np.array([wants(item, kind) for item in items], dtype=np.bool_)
        for kind in (LineKind.CONTOUR, LineKind.CREASE, LineKind.PARAMETER)
    )
    return [
        _rulings(bodies, before, np.flatnonzero(contour & once & ~bodies.is_round)),
        _outlines_of_balls(bodies, before, np.flatnonzero(contour & once & bodies.is_round)),
        *(_rims(bodies, before, once, contour, crease, end) for end in (BOTTOM, TOP)),
        *_parameter_lines(bodies, before, items, np.flatnonzero(parameter)),
    ]


def _rulings(bodies: CappedBodies, before: int, which: Ints) -> Found:
    """The two rulings of frusta that are contours."""
    turn, reach = bodies.turn[0][which], bodies.turn[1][which, BOTTOM]
    seen = (reach > 0.0) & (reach < np.pi)
    which, turn, reach = which[seen], turn[seen], reach[seen]
    parts = []
    for sign in (-1.0, 1.0):
        start, end = (on_rims(bodies, which, k, turn + sign * reach) for k in (BOTTOM, TOP))
        # The next to the eye is between the two.
        middle = 0.5 * (on_rims(bodies, which, BOTTOM, turn) + on_rims(bodies, which, TOP, turn))
        side = _side(bodies, start, end - start, middle)
        parts.append((start, end - start, side))
    start, way, side = (np.concatenate(column) for column in zip(*parts, strict=True))
    body = np.tile(which, 2)
    return lines_on(start, way, LineKind.CONTOUR, bodies.item[body], _own(before, body), side), NO_SIDES


def on_rims(bodies: CappedBodies, which: Ints, end: int, angle: Floats) -> Floats:
    """(k,3) points on the rims at one end of bodies which (k,)."""
    middle, first, second = bodies.rims(which, end)
    return np.asarray(middle + np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second)


def _side(bodies: CappedBodies, start: Floats, way: Floats, inside: Floats) -> Ints:
    """(k,) 1 where points inside (k,3) of a body lie to the left of outlines that run a way (k,3) from start (k,3)."""
    arm = inside - start
    towards = start if bodies.sight.central else np.broadcast_to([0.0, 0.0, 1.0], start.shape)
    return np.where(dot(cross(way, arm), towards) > 0.0, 1, -1)


def _outlines_of_balls(bodies: CappedBodies, before: int, which: Ints) -> Found:
    """The contours of parts of balls: those of the balls between the caps."""
    circles = ball_contours(bodies, which)
    there = np.isfinite(circles[1]).all(axis=1)
    which, circles = which[there], tuple(part[there] for part in circles)  # type: ignore[assignment]
    inwards = [-bodies.outside_of_cap(which, end) for end in (BOTTOM, TOP)]
    capped = [bodies.has_cap[which, end] for end in (BOTTOM, TOP)]
    index = np.concatenate([np.flatnonzero(some) for some in capped])
    forms = np.concatenate([form[some] for form, some in zip(inwards, capped, strict=True)])
    of, low, high = parts_inside(circles, index, forms, bodies.tolerance)
    circles = tuple(part[of] for part in circles)  # type: ignore[assignment]
    body = which[of]
    middle, first, second = circles
    start = middle + np.cos(low)[:, None] * first + np.sin(low)[:, None] * second
    way = np.cos(low)[:, None] * second - np.sin(low)[:, None] * first
    side = _side(bodies, start, way, middle)
    arcs = arcs_on(circles, (low, high), LineKind.CONTOUR, bodies.item[body], _own(before, body), side)
    return arcs, NO_SIDES


def _rims(bodies: CappedBodies, before: int, once: Bools, contour: Bools, crease: Bools, end: int) -> Found:
    """The rims at one end: contours where one of mantle and cap faces the eye and the other does not, else creases;
    where neither does the body hides them."""
    which = np.flatnonzero(bodies.has_cap[:, end] & once & (contour | crease))
    turn, reach = bodies.turn[0][which], bodies.turn[1][which, end]
    shown = np.tile([True, False], (len(which), 1)).T
    low = np.stack([turn - reach, turn + reach])
    high = np.stack([turn + reach, turn + 2.0 * np.pi - reach])
    body, mantle = np.tile(which, 2), shown.ravel()
    low, high = low.ravel(), high.ravel()
    cap = bodies.faces_eye[body, end]
    outline = mantle != cap
    wanted = np.where(outline, contour[body], crease[body])
    # A rim without a part of its own that is turned the other way is a single arc.
    kept = np.flatnonzero(wanted & (high > low))
    body, low, high, outline = body[kept], low[kept], high[kept], outline[kept]
    away = ~mantle[kept] & ~cap[kept]
    circles = bodies.rims(body, end)
    middle, first, second = circles
    start = middle + np.cos(low)[:, None] * first + np.sin(low)[:, None] * second
    way = np.cos(low)[:, None] * second - np.sin(low)[:, None] * first
    inside = bodies.centre[body] + bodies.ends[body].mean(axis=1)[:, None] * bodies.frame[body, 2]
    side = np.where(outline, _side(bodies, start, way, inside), 0)
    arcs = arcs_on(circles, (low, high), LineKind.CREASE, bodies.item[body], _own(before, body), side)
    arcs.kind[outline] = int(LineKind.CONTOUR)
    return arcs, _turned_away(bodies, before, body, away)


def _parameter_lines(bodies: CappedBodies, before: int, items: Sequence[Item], which: Ints) -> list[Found]:
    """Rulings or meridians from end to end, and circles across them."""
    columns = np.array([items[k].curves.columns for k in which.tolist()], dtype=np.intp)
    body, angle = np.repeat(which, columns), 2.0 * np.pi * ragged.place(columns) / np.repeat(columns, columns)
    flat = np.flatnonzero(~bodies.is_round[body])
    found = [rulings(bodies, before, body[flat], angle[flat], LineKind.PARAMETER)]
    bent = np.flatnonzero(bodies.is_round[body])
    body, angle = body[bent], angle[bent]
    frame = bodies.frame[body]
    equator = np.cos(angle)[:, None] * frame[:, 0] + np.sin(angle)[:, None] * frame[:, 1]
    low, high = arcsin(np.clip(bodies.ends[body], -1.0, 1.0)).T
    circles = (bodies.centre[body], equator, frame[:, 2])
    found.append(on_mantles(bodies, before, circles, (low, high), body, LineKind.PARAMETER))
    rows = np.array([items[k].curves.rows for k in which.tolist()], dtype=np.intp)
    inner = np.maximum(rows - 1, 0)
    body, part = np.repeat(which, inner), (ragged.place(inner) + 1) / np.repeat(rows, inner)
    low, high = bodies.ends[body].T
    latitude = (1.0 - part) * arcsin(np.clip(low, -1.0, 1.0)) + part * arcsin(np.clip(high, -1.0, 1.0))
    round_ = bodies.is_round[body]
    height = np.where(round_, np.sin(latitude), part)
    radius = np.where(round_, np.cos(latitude), (1.0 - part) * bodies.radii[body, 0] + part * bodies.radii[body, 1])
    span = np.zeros(len(body)), np.full(len(body), 2.0 * np.pi)
    circles = bodies.circles(body, height, radius)
    found.append(on_mantles(bodies, before, circles, span, body, LineKind.PARAMETER))
    return found


def rulings(bodies: CappedBodies, before: int, body: Ints, angle: Floats, kind: LineKind) -> Found:
    """Rulings of frusta (n,) at angles (n,) from the bottom to the top, in the picture where the mantle shows."""
    start, end = (on_rims(bodies, body, k, angle) for k in (BOTTOM, TOP))
    arcs = lines_on(start, end - start, kind, bodies.item[body], _own(before, body))
    # Along a ruling the mantle turns nowhere.
    turn, reach = bodies.turn[0][body], bodies.turn[1][body, BOTTOM]
    away = np.cos(angle - turn) < np.cos(reach)
    return arcs, _turned_away(bodies, before, body, away)


def straight_on_mantles(
    bodies: CappedBodies, before: int, body: Ints, start: Floats, end: Floats, kind: LineKind
) -> Found:
    """Straight lines from start to end (n,3) along mantles of bodies (n,), in the picture where these show."""
    arcs = lines_on(start, end - start, kind, bodies.item[body], _own(before, body))
    return arcs, _shown_sides(bodies, before, body)


def lines_on_caps(
    bodies: CappedBodies, before: int, body: Ints, end: int, ends: tuple[Floats, Floats], kind: LineKind
) -> Found:
    """Straight lines between two points (n,3) on the caps at one end of bodies (n,), in the picture where these
    show."""
    start, way = ends[0], ends[1] - ends[0]
    arcs = lines_on(start, way, kind, bodies.item[body], _own(before, body))
    return arcs, _turned_away(bodies, before, body, ~bodies.faces_eye[body, end])


def _turned_away(bodies: CappedBodies, before: int, body: Ints, away: Bools) -> OwnSides:
    """What bodies (n,) hide of lines on them of which those that are away (n,) are so as a whole."""
    turned = np.flatnonzero(away & _hide(bodies)[body])
    return OwnSides(turned, np.tile(ALWAYS_TURNED_AWAY, (len(turned), 1)), before + body[turned])


def on_mantles(
    bodies: CappedBodies,
    before: int,
    circles: tuple[Floats, Floats, Floats],
    span: tuple[Floats, Floats],
    body: Ints,
    kind: LineKind,
    weight: Floats | None = None,
) -> Found:
    """Arcs on the mantles of bodies (n,), in the picture where these show."""
    arcs = arcs_on(circles, span, kind, bodies.item[body], _own(before, body), None, weight)
    return arcs, _shown_sides(bodies, before, body)


def _shown_sides(bodies: CappedBodies, before: int, body: Ints) -> OwnSides:
    """What bodies (n,) hide of curves on their mantles."""
    hiding = np.flatnonzero(_hide(bodies)[body])
    return OwnSides(hiding, bodies.polar_planes(body[hiding]), before + body[hiding])


def _hide(bodies: CappedBodies) -> Bools:
    """(n,) which bodies hide, or others that are equal to them."""
    return np.isin(bodies.same, bodies.same[bodies.hides])


def _own(before: int, body: Ints) -> Ints:
    return np.stack([before + body, np.full_like(body, -1)], axis=1)
