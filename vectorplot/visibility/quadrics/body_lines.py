"""The lines on round bodies that items ask for: contours, rims, parameter lines, isophotes, plane sections."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import determinant, matmul
from vectorplot.geometry.elementary import arccos, arcsin, arctan, arctan2, tan
from vectorplot.geometry.vectors import cross, dot, snapped
from vectorplot.scene.added_lines import curve_light
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.tolerances import HOMOTHETIC, NARROW_CONIC
from vectorplot.visibility.quadrics.bodies import BOTTOM, TOP, Balls, CappedBodies, EyeCoordinates, sphere_sections
from vectorplot.visibility.quadrics.conic_arcs import Arcs, OwnSides, arcs_on, lines_on, parts_inside
from vectorplot.words import LineKind

# What items ask for of the lines on their bodies: which of them, planes of sections, and lights.

Wants = Callable[[Item, LineKind], bool]
"""Whether an item wants lines of a kind."""


def wanting(items: Sequence[Item], wants: Wants, kind: LineKind) -> Ints:
    """(k,) which of the items want lines of a kind."""
    return np.array([k for k, item in enumerate(items) if wants(item, kind)], dtype=np.intp)


def section_planes(
    view: View, sight: EyeCoordinates, items: Sequence[Item], which: Ints, kind: LineKind
) -> tuple[Ints, Floats, Floats]:
    """The planes of a kind of sections: for which of the items (n,), and unit normals and points (n,3) of them in the
    coordinates of sight."""
    of: list[int] = []
    normals: list[tuple[float, float, float]] = []
    offsets: list[float] = []
    for k in which.tolist():
        for section in (s for s in items[k].curves.sections if s.kind == kind):
            of += [k] * len(section.offsets)
            normals += [section.normal] * len(section.offsets)
            offsets += section.offsets
    normal = np.array(normals).reshape(-1, 3)
    height = (np.array(offsets) - matmul(normal, view.centre)) / view.scale
    in_view = matmul(normal, view.axes.T)
    point = sight.points(in_view * height[:, None])
    return np.array(of, dtype=np.intp), sight.vectors(in_view), point


def lamps(
    scene: Scene, view: View, sight: EyeCoordinates, items: Sequence[Item], which: Ints
) -> tuple[Floats, Floats, Bools]:
    """Of the lights of isophotes the directions to those that are infinitely far, and the places of the others, (n,3)
    in the coordinates of sight; and (n,) whether they are infinitely far."""
    lights = [curve_light(scene, view, items[k]) for k in which.tolist()]
    position = np.array([light.position for light in lights]).reshape(-1, 3)
    parallel = np.array([light.parallel for light in lights], dtype=np.bool_)
    return sight.vectors(matmul(position, view.axes.T)), sight.points(view.points_of(position).T), parallel


def cosines(items: Sequence[Item], which: Ints) -> tuple[Ints, Floats]:
    """How many isophotes (n,) items ask for, and their cosines, one after the other."""
    counts = np.array([len(items[k].curves.isophotes) for k in which.tolist()], dtype=np.intp)
    return counts, np.concatenate([np.zeros(0), *(items[k].curves.isophotes for k in which.tolist())])


# The lines on spheres and ellipsoids: contours, parameter lines, isophotes and plane sections, all of them conics.

Found = tuple[Arcs, OwnSides]


def ball_arcs(scene: Scene, view: View, balls: Balls, wants: Wants) -> list[Found]:
    """The lines that items with balls ask for; wants(item, kind) tells."""
    items = [scene.items[k] for k in balls.item.tolist()]
    return [
        _contours(balls, wanting(items, wants, LineKind.CONTOUR)),
        *_parameter_lines(balls, items, wanting(items, wants, LineKind.PARAMETER)),
        _isophotes(scene, view, balls, items, wanting(items, wants, LineKind.ISOPHOTE)),
        *(
            _sections(view, balls, items, wanting(items, wants, kind), kind)
            for kind in (LineKind.SECTION, LineKind.INDEX)
        ),
    ]


def on_balls(
    balls: Balls,
    circles: tuple[Floats, Floats, Floats],
    kind: LineKind,
    ball: Ints,
    span: tuple[float, float] = (0.0, 2.0 * np.pi),
) -> Found:
    """Circles of balls (n,), in the picture where the ball shows."""
    own = np.stack([ball, np.full_like(ball, -1)], axis=1)
    low, high = np.full(len(ball), span[0]), np.full(len(ball), span[1])
    arcs = arcs_on(circles, (low, high), kind, balls.item[ball], own)
    return arcs, own_sides(balls, ball)


def own_sides(balls: Balls, ball: Ints) -> OwnSides:
    """What balls (n,), or others that are equal to them, hide of arcs (n,) on them."""
    hiding = np.flatnonzero(np.isin(balls.same, balls.same[balls.hides])[ball])
    return OwnSides(hiding, balls.polar_planes(ball[hiding]), ball[hiding])


def _contours(balls: Balls, which: Ints) -> Found:
    """The contours, which no part of their own ball hides; of equal balls that of the first one."""
    which = which[np.sort(np.unique(balls.same[which], return_index=True)[1])]
    middle, first, second = balls.contours(which)
    # Where it runs counter-clockwise in the picture its ball is on the left.
    outward = cross(first, second)
    sight = middle if balls.sight.central else np.broadcast_to([0.0, 0.0, 1.0], middle.shape)
    side = np.where(dot(outward, sight) > 0.0, 1, -1)
    own = np.stack([which, np.full_like(which, -1)], axis=1)
    low, high = np.zeros(len(which)), np.full(len(which), 2.0 * np.pi)
    arcs = arcs_on((middle, first, second), (low, high), LineKind.CONTOUR, balls.item[which], own, side)
    none = np.zeros(0, dtype=np.intp)
    return arcs, OwnSides(none, np.zeros((0, 4)), none)


def _parameter_lines(balls: Balls, items: Sequence[Item], which: Ints) -> list[Found]:
    """Meridians, from pole to pole, and circles of latitude."""
    columns = np.array([items[k].curves.columns for k in which.tolist()], dtype=np.intp)
    ball, angle = np.repeat(which, columns), 2.0 * np.pi * ragged.place(columns) / np.repeat(columns, columns)
    frame = balls.frame[ball]
    equator = np.cos(angle)[:, None] * frame[:, 0] + np.sin(angle)[:, None] * frame[:, 1]
    quarter = 0.5 * np.pi
    circles = (balls.centre[ball], equator, frame[:, 2])
    meridians = on_balls(balls, circles, LineKind.PARAMETER, ball, (-quarter, quarter))
    rows = np.array([items[k].curves.rows for k in which.tolist()], dtype=np.intp)
    inner = np.maximum(rows - 1, 0)
    ball = np.repeat(which, inner)
    latitude = np.pi * (ragged.place(inner) + 1) / np.repeat(rows, inner) - quarter
    frame = balls.frame[ball]
    radius = np.cos(latitude)[:, None]
    middle = balls.centre[ball] + np.sin(latitude)[:, None] * frame[:, 2]
    circles = (middle, radius * frame[:, 0], radius * frame[:, 1])
    return [meridians, on_balls(balls, circles, LineKind.PARAMETER, ball)]


def _isophotes(scene: Scene, view: View, balls: Balls, items: Sequence[Item], which: Ints) -> Found:
    """The isophotes of spheres: circles about the direction of the light."""
    counts, cosine = cosines(items, which)
    which, counts = which[counts > 0], counts[counts > 0]
    direction, place, far_away = lamps(scene, view, balls.sight, items, which)
    away = far_away[:, None]
    towards = np.where(away, direction, place - balls.centre[which])
    distance = np.sqrt(dot(towards, towards)) / balls.reach[which, 0]
    # In the frame of the unit sphere, which a mirrored one turns inside out.
    s = np.einsum("ni,nij->nj", towards, balls.inverse[which])
    s /= np.sqrt(dot(s, s))[:, None]
    turned = np.sign(determinant(balls.frame[which])) * (-1.0)
    owner = ragged.owner(counts)
    cosine = cosine * turned[owner]
    far, near_by = away[owner, 0], distance[owner]
    with np.errstate(all="ignore"):
        root = np.sqrt(np.maximum(near_by * near_by - 1.0 + cosine * cosine, 0.0))
        height = np.where(far, cosine, (1.0 - cosine * cosine + cosine * root) / near_by)
        # Inside a ball a lamp lights nothing outside of it.
        there = far | (near_by * near_by - 1.0 + cosine * cosine >= 0.0)
    kept = np.flatnonzero(there & (np.abs(height) < 1.0))
    ball = which[owner[kept]]
    return on_balls(balls, balls.circles(ball, s[owner[kept]], height[kept]), LineKind.ISOPHOTE, ball)


def _sections(view: View, balls: Balls, items: Sequence[Item], which: Ints, kind: LineKind) -> Found:
    """The sections of a kind with planes."""
    ball, normal, point = section_planes(view, balls.sight, items, which, kind)
    return plane_circles(balls, ball, normal, point, kind)


def plane_circles(balls: Balls, ball: Ints, normal: Floats, point: Floats, kind: LineKind) -> Found:
    """The circles in which planes through points (n,3), with normals (n,3), meet balls (n,); none where they do not, or
    touch."""
    kept, s, height = unit_planes(balls, ball, normal, point)
    return on_balls(balls, balls.circles(ball[kept], s, height), kind, ball[kept])


def unit_planes(balls: Balls, ball: Ints, normal: Floats, point: Floats) -> tuple[Ints, Floats, Floats]:
    """Which planes meet the balls, and as planes s.unit = height of the unit sphere: unit (k,3), height (k,)."""
    s = np.einsum("nij,nj->ni", balls.frame[ball], normal)
    size = np.sqrt(dot(s, s))
    height = dot(point - balls.centre[ball], normal)
    touching = balls.tolerance * np.sqrt(dot(normal, normal))
    kept = np.flatnonzero(np.abs(height) < size - touching)
    return kept, s[kept] / size[kept, None], height[kept] / size[kept]


# The lines on frusta and parts of balls between flat ends: contours, rims and parameter lines.

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
        *_parameter_lines_of_capped(bodies, before, items, np.flatnonzero(parameter)),
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
    circles = bodies.contours(which)
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
    """The rims at one end: contours where one of mantle and cap faces the eye and the other does not and contours are
    wanted, else creases; where neither does the body hides them."""
    which = np.flatnonzero(bodies.has_cap[:, end] & once & (contour | crease))
    turn, reach = bodies.turn[0][which], bodies.turn[1][which, end]
    shown = np.tile([True, False], (len(which), 1)).T
    low = np.stack([turn - reach, turn + reach])
    high = np.stack([turn + reach, turn + 2.0 * np.pi - reach])
    body, mantle = np.tile(which, 2), shown.ravel()
    low, high = low.ravel(), high.ravel()
    cap = bodies.faces_eye[body, end]
    outline = mantle != cap
    wanted = crease[body] | (outline & contour[body])
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
    arcs.kind[outline & contour[body]] = int(LineKind.CONTOUR)
    return arcs, _turned_away(bodies, before, body, away)


def _parameter_lines_of_capped(bodies: CappedBodies, before: int, items: Sequence[Item], which: Ints) -> list[Found]:
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


# Plane sections and isophotes of frusta and of parts of balls between flat ends: conics, and straight lines.

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

    Edge cases: planes that touch a body, or in which a cap lies, have no line in common with it.
    """
    found = []
    for kind in (LineKind.SECTION, LineKind.INDEX):
        body, normal, point = section_planes(view, bodies.sight, items, wanting(items, wants, kind), kind)
        unit = np.einsum("nij,nj->ni", bodies.frame[body], normal)
        planes = _Planes(body, unit, dot(point - bodies.centre[body], normal))
        is_round = bodies.is_round[body]
        found += _of_frusta(bodies, before, records.take(planes, np.flatnonzero(~is_round)), kind)
        found.append(_of_balls(bodies, before, records.take(planes, np.flatnonzero(is_round)), kind))
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
    steep = snapped(np.hypot(planes.normal[:, 0], planes.normal[:, 1]), bodies.tolerance)
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
            height = snapped(planes.at(bodies.ends[planes.body, end]), bodies.tolerance)
            ends.append(height / (bodies.radii[planes.body, end] * steep))
    # A plane through an apex meets rulings; one that meets neither circle lies in a cap.
    ends = [np.where(np.isnan(one), other, one) for one, other in (ends, ends[::-1])]
    return np.asarray(np.nan_to_num(np.stack(ends), nan=2.0, posinf=2.0, neginf=-2.0))


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
    some = records.take(planes, np.flatnonzero(bodies.has_cap[planes.body, end]))
    steep = snapped(np.hypot(some.normal[:, 0], some.normal[:, 1]), bodies.tolerance)
    reach = bodies.radii[some.body, end] * steep
    distance = some.at(bodies.ends[some.body, end])
    kept = np.flatnonzero(np.abs(distance) < reach - bodies.tolerance)
    body, half = some.body[kept], arccos(distance[kept] / reach[kept])
    turn = arctan2(some.normal[kept, 1], some.normal[kept, 0])
    start, stop = (on_rims(bodies, body, end, turn + sign * half) for sign in (-1.0, 1.0))
    return lines_on_caps(bodies, before, body, end, (start, stop), kind)
