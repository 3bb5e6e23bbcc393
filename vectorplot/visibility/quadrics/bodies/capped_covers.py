"""What capped bodies hide: the regions behind their caps, behind the section with the polar plane, and themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import records
from vectorplot.geometry.vectors import dot
from vectorplot.tolerances.of_angles import EDGE_ON_SINE
from vectorplot.visibility.polyhedra.grid import Floats32
from vectorplot.visibility.quadrics.arc_pieces import packed_box
from vectorplot.visibility.quadrics.bodies.covers import Covers, disc_boxes, outlines
from vectorplot.visibility.quadrics.bodies.seen_balls import across
from vectorplot.visibility.quadrics.bodies.seen_capped import BOTTOM, TOP, CappedBodies

BEYOND_CAP = 2.0
"""What lies in the plane of a cap that is turned away is inside: so many tolerances before the plane does the body end
for it."""

_ALWAYS = np.array([0.0, 0.0, 0.0, 1.0])


def capped_covers(bodies: CappedBodies, which: Ints) -> tuple[Covers, ...]:
    """What bodies hide: all behind their caps, all behind their sections with their polar planes, and what is inside.

    The outline of a body consists of contours, which lie in the polar plane, and of rims: so its image is that of the
    section and of the caps together.
    """
    round_, box = bodies.is_round[which], _boxes(bodies, which)
    frusta, parts = which[~round_], which[round_]
    found = [
        records.joined([_behind_caps(bodies, which, end) for end in (BOTTOM, TOP)]),
        _behind_frusta(bodies, frusta, box[:, ~round_]),
        _inside(bodies, frusta, box[:, ~round_], _of_frusta(bodies, frusta)),
        _behind_parts(bodies, parts, box[:, round_]),
        _inside(bodies, parts, box[:, round_], _of_balls(bodies, parts)),
    ]
    return tuple(some for some in found if len(some))


def _behind_caps(bodies: CappedBodies, which: Ints, end: int) -> Covers:
    """All that is beyond a cap, seen through it; one that is seen edge-on hides nothing."""
    which = which[bodies.has_cap[which, end]]
    rims = bodies.rims(which, end)
    squares = outlines(bodies.sight, rims)
    broad = np.isfinite(squares).all(axis=(0, 1)) & ~_edge_on(bodies, which, end)
    which, rims, squares = which[broad], tuple(part[broad] for part in rims), squares[:, :, broad]  # type: ignore[assignment]
    middle, first, second = rims
    out = bodies.outside_of_cap(which, end)
    beyond = np.where(bodies.faces_eye[which, end][:, None], -out, out)
    size = np.minimum(np.sqrt(dot(first, first)), np.sqrt(dot(second, second)))
    return Covers(
        beyond.T[None],
        squares,
        _slack(bodies, size),
        which,
        bodies.item[which],
        packed_box(*disc_boxes(bodies.sight, *rims)),
        middle[:, 2] - np.hypot(first[:, 2], second[:, 2]),
        np.full(len(which), np.inf),
    )


def _edge_on(bodies: CappedBodies, which: Ints, end: int) -> Bools:
    """(k,) whether the plane of a cap runs through the eye."""
    out = bodies.outside_of_cap(which, end)
    if not bodies.sight.central:
        return np.asarray(np.abs(out[:, 2]) <= EDGE_ON_SINE)
    centre = bodies.centre[which]
    return np.asarray(np.abs(out[:, 3]) <= EDGE_ON_SINE * np.sqrt(dot(centre, centre)))


def _boxes(bodies: CappedBodies, which: Ints) -> Floats32:
    """(4,k) the boxes in the image around bodies: around both rims, and around the contours of balls."""
    low, high = disc_boxes(bodies.sight, *bodies.rims(which, BOTTOM))
    for other in (bodies.rims(which, TOP), _contours(bodies, which)):
        other_low, other_high = disc_boxes(bodies.sight, *other)
        low, high = np.minimum(low, other_low), np.maximum(high, other_high)
    return packed_box(low, high)


def _contours(bodies: CappedBodies, which: Ints) -> tuple[Floats, Floats, Floats]:
    """The contours of the whole balls, of frusta a rim once more."""
    circles = bodies.rims(which, TOP)
    of_balls = ball_contours(bodies, which)
    round_ = bodies.is_round[which][:, None]
    return tuple(np.where(round_, one, other) for one, other in zip(of_balls, circles, strict=True))  # type: ignore[return-value]


def ball_contours(bodies: CappedBodies, which: Ints) -> tuple[Floats, Floats, Floats]:
    """Centres and two conjugate radii (k,3) of the contours that the balls of parts of balls have as wholes; NaN where
    the eye is inside of them."""
    eye = bodies.eye[which]
    distance = np.sqrt(dot(eye[:, :3], eye[:, :3]))[:, None]
    normal = eye[:, :3] / distance
    first, second = across(normal)
    height = eye[:, 3:] / distance
    with np.errstate(invalid="ignore"):
        radius = np.sqrt(1.0 - height * height)
    frame = bodies.frame[which]
    middle, p, q = (np.einsum("ni,nij->nj", part, frame) for part in (height * normal, radius * first, radius * second))
    return bodies.centre[which] + middle, p, q


def _behind_frusta(bodies: CappedBodies, which: Ints, box: Floats32) -> Covers:
    """All behind the quadrilaterals between the two rulings that are the contour."""
    turn, reach = bodies.turn[0][which], bodies.turn[1][which, BOTTOM]
    seen = (reach > 0.0) & (reach < np.pi)
    which, box, turn, reach = which[seen], box[:, seen], turn[seen], reach[seen]
    linear = [-bodies.polar_planes(which)]
    for angle in (turn - reach, turn + reach):
        # The tangent plane along a ruling of the contour runs through the eye.
        unit = [-np.cos(angle), -np.sin(angle), bodies.growth[which], bodies.radii[which, BOTTOM]]
        linear.append(bodies.forms(which, np.stack(unit, axis=1)))
    linear += [_sides(bodies, which, end) for end in (BOTTOM, TOP)]
    none = np.zeros((0, 4, len(which)))
    return _cover(bodies, which, box, np.stack(linear).transpose(0, 2, 1), none, np.zeros(len(which)))


def _behind_parts(bodies: CappedBodies, which: Ints, box: Floats32) -> Covers:
    """All behind the parts of discs that the polar planes cut out of parts of balls."""
    contours = ball_contours(bodies, which)
    squares = outlines(bodies.sight, contours)
    seen = np.isfinite(squares).all(axis=(0, 1))
    which, box, squares = which[seen], box[:, seen], squares[:, :, seen]
    linear = [-bodies.polar_planes(which), *(_sides(bodies, which, end) for end in (BOTTOM, TOP))]
    slack = _slack(bodies, _smallest(bodies, which))
    return _cover(bodies, which, box, np.stack(linear).transpose(0, 2, 1), squares, slack)


def _sides(bodies: CappedBodies, which: Ints, end: int) -> Floats:
    """(k,4) the planes through the eye and the line in which polar plane and cap meet, positive where the body is;
    positive everywhere where there is no cap."""
    polar, eye = bodies.polar[which], bodies.eye[which]
    sign = 1.0 if end == BOTTOM else -1.0
    inside = np.zeros_like(polar)
    inside[:, 2], inside[:, 3] = sign, -sign * bodies.ends[which, end]
    product = dot(polar, eye)[:, None] * inside - dot(inside, eye)[:, None] * polar
    return np.where(bodies.has_cap[which, end][:, None], bodies.forms(which, product), _ALWAYS)


def _of_frusta(bodies: CappedBodies, which: Ints) -> Floats:
    """(3,k,4) squares in unit coordinates: the radius, x and y."""
    forms = np.zeros((3, len(which), 4))
    forms[0, :, 2], forms[0, :, 3] = bodies.growth[which], bodies.radii[which, BOTTOM]
    forms[1, :, 0] = forms[2, :, 1] = 1.0
    return forms


def _of_balls(bodies: CappedBodies, which: Ints) -> Floats:
    """(4,k,4) squares in unit coordinates: one, x, y and z."""
    forms = np.zeros((4, len(which), 4))
    forms[0, :, 3] = forms[1, :, 0] = forms[2, :, 1] = forms[3, :, 2] = 1.0
    return forms


def _inside(bodies: CappedBodies, which: Ints, box: Floats32, unit: Floats) -> Covers:
    """What is inside of bodies, and what lies in a cap that is turned away."""
    linear = []
    for end in (BOTTOM, TOP):
        inwards = -bodies.outside_of_cap(which, end)
        inwards[:, 3] += np.where(bodies.faces_eye[which, end], 0.0, BEYOND_CAP * bodies.tolerance)
        # Beyond its apex the squares of a cone are those of its other half; a whole ball ends by itself.
        ends = bodies.has_cap[which, end] | ~bodies.is_round[which]
        linear.append(np.where(ends[:, None], inwards, _ALWAYS))
    inverse, centre = bodies.inverse[which], bodies.centre[which]
    gradient = np.einsum("nij,qnj->qni", inverse, unit[:, :, :3])
    constant = unit[:, :, 3] - np.einsum("qni,ni->qn", gradient, centre)
    squares = np.concatenate([gradient, constant[:, :, None]], axis=2).transpose(0, 2, 1)
    slack = _slack(bodies, _smallest(bodies, which))
    found = _cover(bodies, which, box, np.stack(linear).transpose(0, 2, 1), squares, slack)
    return replace(found, farthest=bodies.reach[which, 1, 2])


def _cover(bodies: CappedBodies, which: Ints, box: Floats32, linear: Floats, squares: Floats, slack: Floats) -> Covers:
    nearest = bodies.reach[which, 0, 2]
    return Covers(linear, squares, slack, which, bodies.item[which], box, nearest, np.full(len(which), np.inf))


def _smallest(bodies: CappedBodies, which: Ints) -> Floats:
    """(k,) the length of the smallest axis of a body."""
    frame = bodies.frame[which]
    return np.asarray(np.sqrt((frame * frame).sum(axis=2))[:, :2].min(axis=1, initial=np.inf))


def _slack(bodies: CappedBodies, size: Floats) -> Floats:
    """A distance of the tolerance, in squares of these radii (k,)."""
    return np.asarray(2.0 * bodies.tolerance / size)
