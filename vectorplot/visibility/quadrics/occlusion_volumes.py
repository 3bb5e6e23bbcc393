"""What bodies in closed form hide, as signs of linear and quadratic forms, and which pieces of arcs they could hide."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.geometry.vectors import dot
from vectorplot.tolerances import EDGE_ON_SINE
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra.grid import Floats32, Grid
from vectorplot.visibility.quadrics.bodies import BOTTOM, TOP, Balls, CappedBodies, EyeCoordinates
from vectorplot.visibility.quadrics.conic_arcs import OwnSides, Pieces, packed_box
from vectorplot.visibility.smooth.curve_families import Along, Chords, Family
from vectorplot.visibility.smooth.traced_curves import Curves

# What hides: the region behind each ball and the ball itself, as signs of linear and quadratic forms.


@dataclass(frozen=True, eq=False)
class OcclusionVolumes:
    """Regions of space in which everything is hidden.

    Volume k hides the points X = (x,y,z,1) with linear[j,:,k].X > 0 for all j and, if there are squares, with
    squares[0,:,k].X squared larger than the sum of the squares of the others. linear (l,4,n): forms with gradients of
    length 1; squares (q,4,n): forms; slack (n,): what counts as zero of the difference, where squares[0,:,k].X is 1.
    body (n,): the ball; item (n,); box (4,n) left, right, bottom, top in the image; nearest, farthest (n,) depth.
    """

    linear: Floats = field(metadata=IN_COLUMNS)
    squares: Floats = field(metadata=IN_COLUMNS)
    slack: Floats
    body: Ints
    item: Ints
    box: Floats32 = field(metadata=IN_COLUMNS)
    nearest: Floats
    farthest: Floats

    def __len__(self) -> int:
        return len(self.body)


def ball_occlusion_volumes(balls: Balls, which: Ints) -> tuple[OcclusionVolumes, OcclusionVolumes]:
    """What balls hide: all beyond their polar planes inside their outlines, and what is inside of them.

    The inside is taken whole, for a curve that pierces the ball near its contour would slip between two halves.
    """
    contours = balls.contours(which)
    box = packed_box(*disc_boxes(balls.sight, *contours))
    return _behind(balls, which, contours, box), _inside(balls, which, box)


def _behind(balls: Balls, which: Ints, contours: tuple[Floats, Floats, Floats], box: Floats32) -> OcclusionVolumes:
    middle, first, second = contours
    return OcclusionVolumes(
        -balls.polar_planes(which).T[None],
        outlines(balls.sight, contours),
        _slack(balls, which),
        which,
        balls.item[which],
        box,
        middle[:, 2] - np.hypot(first[:, 2], second[:, 2]),
        np.full(len(which), np.inf),
    )


def outlines(sight: EyeCoordinates, discs: tuple[Floats, Floats, Floats]) -> Floats:
    """(3,4,n) forms, as the squares of volumes, of what lies in the same direction as elliptic discs with these middles
    and conjugate radii (n,3)."""
    m, p, q = (_seen(sight, part, w) for part, w in zip(discs, (1.0, 0.0, 0.0), strict=True))
    rows = np.stack([np.cross(p, q), np.cross(q, m), np.cross(m, p)], axis=1)
    size = (rows[:, 0] * m).sum(axis=1)
    squares = np.zeros((3, 4, len(m)))
    with np.errstate(divide="ignore", invalid="ignore"):
        squares[:, sight.seen] = (rows / size[:, None, None]).transpose(1, 2, 0)
    return squares


def _inside(balls: Balls, which: Ints, box: Floats32) -> OcclusionVolumes:
    squares = np.zeros((4, 4, len(which)))
    squares[0, 3] = 1.0
    inverse, centre = balls.inverse[which], balls.centre[which]
    squares[1:, :3] = inverse.transpose(2, 1, 0)
    squares[1:, 3] = -np.einsum("ni,nij->nj", centre, inverse).T
    depth, reach = centre[:, 2], balls.reach[which, 2]
    none = np.zeros((0, 4, len(which)))
    item = balls.item[which]
    return OcclusionVolumes(none, squares, _slack(balls, which), which, item, box, depth - reach, depth + reach)


def _seen(sight: EyeCoordinates, part: Floats, weight: float) -> Floats:
    """(n,3) what is seen of points or vectors (n,3)."""
    return np.concatenate([part, np.full((len(part), 1), weight)], axis=1)[:, sight.seen]


def _slack(balls: Balls, which: Ints) -> Floats:
    """A distance of the tolerance from the smallest axis of a ball, in squares of its radius."""
    return np.asarray(2.0 * balls.tolerance / balls.reach[which].min(axis=1, initial=np.inf))


def disc_boxes(sight: EyeCoordinates, middle: Floats, first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Lower left and upper right corners (2,n) of the images of elliptic discs with these middles and conjugate radii
    (n,3); NaN where a disc comes before the near plane."""
    if not sight.central:
        reach = np.hypot(first[:, :2], second[:, :2])
        return (middle[:, :2] - reach).T, (middle[:, :2] + reach).T
    depth, rise, other = middle[:, 2:], first[:, 2:], second[:, 2:]
    with np.errstate(all="ignore"):
        # Seen from the image of the middle, so that small discs keep their digits: a line through the eye that touches
        # the disc has a slope s with (p - s rise)^2 + (q - s other)^2 = (s depth)^2.
        centre = middle[:, :2] / depth
        p, q = first[:, :2] - centre * rise, second[:, :2] - centre * other
        a, b, c = depth * depth - rise * rise - other * other, p * rise + q * other, p * p + q * q
        root = np.sqrt(b * b + a * c)
        low, high = centre - (root + b) / a, centre + (root - b) / a
    hole = depth - np.hypot(rise, other) < sight.near
    return np.where(hole, np.nan, low).T, np.where(hole, np.nan, high).T


# What capped bodies hide: the regions behind their caps, behind the section with the polar plane, and themselves.

BEYOND_CAP = 2.0
"""What lies in the plane of a cap that is turned away is inside: so many tolerances before the plane does the body end
for it."""

_ALWAYS = np.array([0.0, 0.0, 0.0, 1.0])


def capped_occlusion_volumes(bodies: CappedBodies, which: Ints) -> tuple[OcclusionVolumes, ...]:
    """What bodies hide: all behind their caps, all behind their sections with their polar planes, and what is inside.

    The outline of a body consists of contours, which lie in the polar plane, and of rims: so its image is that of the
    section and of the caps together.
    """
    round_, box = bodies.is_round[which], _boxes(bodies, which)
    frusta, parts = which[~round_], which[round_]
    found = [
        records.joined([_behind_caps(bodies, which, end) for end in (BOTTOM, TOP)]),
        _behind_frusta(bodies, frusta, box[:, ~round_]),
        _inside_capped(bodies, frusta, box[:, ~round_], _of_frusta(bodies, frusta)),
        _behind_parts(bodies, parts, box[:, round_]),
        _inside_capped(bodies, parts, box[:, round_], _of_balls(len(parts))),
    ]
    return tuple(some for some in found if len(some))


def _behind_caps(bodies: CappedBodies, which: Ints, end: int) -> OcclusionVolumes:
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
    return OcclusionVolumes(
        beyond.T[None],
        squares,
        _slack_of_capped(bodies, size),
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
    of_balls = bodies.contours(which)
    round_ = bodies.is_round[which][:, None]
    return tuple(np.where(round_, one, other) for one, other in zip(of_balls, circles, strict=True))  # type: ignore[return-value]


def _behind_frusta(bodies: CappedBodies, which: Ints, box: Floats32) -> OcclusionVolumes:
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


def _behind_parts(bodies: CappedBodies, which: Ints, box: Floats32) -> OcclusionVolumes:
    """All behind the parts of discs that the polar planes cut out of parts of balls."""
    contours = bodies.contours(which)
    squares = outlines(bodies.sight, contours)
    seen = np.isfinite(squares).all(axis=(0, 1))
    which, box, squares = which[seen], box[:, seen], squares[:, :, seen]
    linear = [-bodies.polar_planes(which), *(_sides(bodies, which, end) for end in (BOTTOM, TOP))]
    slack = _slack_of_capped(bodies, _smallest(bodies, which))
    return _cover(bodies, which, box, np.stack(linear).transpose(0, 2, 1), squares, slack)


def _sides(bodies: CappedBodies, which: Ints, end: int) -> Floats:
    """(k,4) the planes through the eye and the line in which polar plane and cap meet, positive where the body is;
    positive everywhere where there is no cap."""
    polar = bodies.polar[which]
    eye = np.column_stack([bodies.eye[which], np.full(len(which), bodies.eye_weight)])
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


def _of_balls(count: int) -> Floats:
    """(4,k,4) squares in unit coordinates: one, x, y and z."""
    forms = np.zeros((4, count, 4))
    forms[0, :, 3] = forms[1, :, 0] = forms[2, :, 1] = forms[3, :, 2] = 1.0
    return forms


def _inside_capped(bodies: CappedBodies, which: Ints, box: Floats32, unit: Floats) -> OcclusionVolumes:
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
    slack = _slack_of_capped(bodies, _smallest(bodies, which))
    found = _cover(bodies, which, box, np.stack(linear).transpose(0, 2, 1), squares, slack)
    return replace(found, farthest=bodies.reach[which, 1, 2])


def _cover(
    bodies: CappedBodies, which: Ints, box: Floats32, linear: Floats, squares: Floats, slack: Floats
) -> OcclusionVolumes:
    nearest = bodies.reach[which, 0, 2]
    return OcclusionVolumes(
        linear, squares, slack, which, bodies.item[which], box, nearest, np.full(len(which), np.inf)
    )


def _smallest(bodies: CappedBodies, which: Ints) -> Floats:
    """(k,) the length of the smallest axis of a body."""
    frame = bodies.frame[which]
    return np.asarray(np.sqrt((frame * frame).sum(axis=2))[:, :2].min(axis=1, initial=np.inf))


def _slack_of_capped(bodies: CappedBodies, size: Floats) -> Floats:
    """A distance of the tolerance, in squares of these radii (k,)."""
    return np.asarray(2.0 * bodies.tolerance / size)


# All bodies of a scene that are drawn in closed form.


@dataclass(frozen=True, eq=False)
class Bodies:
    """Balls and, numbered on from them, capped bodies."""

    balls: Balls
    capped: CappedBodies

    def __len__(self) -> int:
        return len(self.balls) + len(self.capped)

    @property
    def sight(self) -> EyeCoordinates:
        """The coordinates in which they are given."""
        return self.balls.sight

    @property
    def tolerance(self) -> float:
        """What counts as distance zero."""
        return self.balls.tolerance

    @cached_property
    def item(self) -> Ints:
        """(n,) the items whose shapes they are."""
        return np.concatenate([self.balls.item, self.capped.item])

    @cached_property
    def hides(self) -> Bools:
        """(n,) whether they hide."""
        return np.concatenate([self.balls.hides, self.capped.hides])

    @cached_property
    def same(self) -> Ints:
        """(n,) the first body at the same place and of the same form: each other hides nothing of it."""
        return np.concatenate([self.balls.same, self.capped.same + len(self.balls)])

    @cached_property
    def reach(self) -> Floats:
        """(n,2,3) smallest and largest coordinates."""
        around = np.stack([self.balls.centre - self.balls.reach, self.balls.centre + self.balls.reach], axis=1)
        return np.concatenate([around, self.capped.reach])

    def hiding_alike(self, which: Ints) -> tuple[Ints, Ints]:
        """The bodies that hide and are equal to those which (k,), these included: index into which, and body (n,)."""
        hiding = np.flatnonzero(self.hides)
        hiding = hiding[np.argsort(self.same[hiding], kind="stable")]
        first, last = (np.searchsorted(self.same[hiding], self.same[which], side) for side in ("left", "right"))
        return ragged.owner(last - first), hiding[ragged.ranges(first, last - first)]

    def volumes(self, which: Ints) -> tuple[OcclusionVolumes, ...]:
        """What bodies hide, by their kinds; volumes of kinds that the scene lacks are not among them."""
        count = len(self.balls)
        capped = capped_occlusion_volumes(self.capped, which[which >= count] - count)
        every = [
            *ball_occlusion_volumes(self.balls, which[which < count]),
            *(replace(c, body=c.body + count) for c in capped),
        ]
        return tuple(some for some in every if len(some))

    def take(self, which: Bools) -> Bodies:
        """Some of the bodies, those of a mask (n,)."""
        count = len(self.balls)
        return Bodies(self.balls.take(which[:count]), self.capped.take(which[count:]))


# Which pieces of arcs could be hidden by which volumes: those whose boxes overlap in the image, front to back.

FINEST = 1024.0
"""The finest grid has at most so many cells along each side of the picture."""

TOUCHES_AT_ONCE, PAIRS_AT_ONCE = 1 << 16, 1 << 14
"""Cells of pieces looked up at once, and pairs handed over at once: these stay in the processor's cache."""


def typical_size(volumes: tuple[OcclusionVolumes, ...]) -> float:
    """The size in the image of what hides, the median; 1 where nothing has one."""
    sizes = np.concatenate([np.zeros(0), *(_sizes(some.box) for some in volumes)])
    sizes = sizes[np.isfinite(sizes) & (sizes > 0.0)]
    return float(np.median(sizes)) if len(sizes) else 1.0


def _sizes(box: Floats32) -> Floats:
    return np.asarray(np.maximum(box[1] - box[0], box[3] - box[2]), dtype=np.float64)


def grid_of(pieces: Pieces, typical: float) -> Grid:
    """A grid over the pieces, with cells about as large as what hides."""
    box = pieces.box[:, np.isfinite(pieces.box).all(axis=0)].astype(np.float64)
    if not box.shape[1]:
        return Grid.over((0.0, 1.0, 0.0, 1.0), 1.0)
    left, bottom = box[[0, 2]].min(axis=1)
    right, top = box[[1, 3]].max(axis=1)
    extent = max(right - left, top - bottom)
    return Grid.over((left, right, bottom, top), max(typical, extent / FINEST))


def close_pairs(
    grid: Grid, pieces: Pieces, alive: Bools, volumes: OcclusionVolumes, slab: Ints
) -> Iterator[tuple[Ints, Ints]]:
    """Blocks (piece, volume) of pieces that are alive and volumes of a slab whose boxes overlap, each pair once.

    alive (p,) is looked at anew for each block.
    """
    level = grid.level_of(volumes.box[:, slab])
    nearest = volumes.nearest[slab].min()
    which = np.flatnonzero(alive & (pieces.farthest > nearest))
    for one in np.unique(level).tolist():
        some = slab[level == one]
        levels = np.full(len(some), one)
        thing, column, row = grids.touched(grid, volumes.box[:, some], levels)
        entries = grids.entries(grid, thing, column, row, np.full(len(thing), one))
        first = grid.corner_cells(volumes.box[:, some], levels)[:2]
        for block in np.array_split(which, max(1, 4 * len(which) // TOUCHES_AT_ONCE)):
            block_level = np.full(len(block), one)
            own = grid.corner_cells(pieces.box[:, block], block_level)[:2]
            piece, column, row = grids.touched(grid, pieces.box[:, block], block_level)
            begin, count = entries.of(grid.numbers(column, row, one))
            touch = ragged.owner(count)
            at = entries.thing[begin[touch] + ragged.place(count)]
            # A pair is looked at where both begin in both directions.
            piece, column, row = piece[touch], column[touch], row[touch]
            once = (np.maximum(own[0][piece], first[0][at]) == column) & (
                np.maximum(own[1][piece], first[1][at]) == row
            )
            p, c = block[piece[once]], some[at[once]]
            a, b = pieces.box[:, p], volumes.box[:, c]
            near = (a[0] <= b[1]) & (b[0] <= a[1]) & (a[2] <= b[3]) & (b[2] <= a[3])
            near &= (pieces.farthest[p] >= volumes.nearest[c]) & (pieces.nearest[p] <= volumes.farthest[c])
            p, c = p[near], c[near]
            for low in range(0, len(p), PAIRS_AT_ONCE):
                kept = alive[p[low : low + PAIRS_AT_ONCE]]
                yield p[low : low + PAIRS_AT_ONCE][kept], c[low : low + PAIRS_AT_ONCE][kept]


# Curves that lie on bodies.


@dataclass(frozen=True, eq=False)
class BodiesMeet:
    """Curves on one body or two: body (k,2) their numbers, or -1; form (k,2,4) linear forms, negative where a body is
    turned away; curves: what is known of them as curves of sheets, which are no sheets of the scene.

    The row of a curve is its level; one row is that of all of them.
    """

    curves: Family
    body: Ints
    form: Floats
    sheet: int = -1
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        return self.curves.between(chords, part)


def own_bodies(bodies: Bodies, curves: Curves, curve: Ints) -> tuple[Ints, OwnSides]:
    """The bodies (n,2) that some of the curves (n,), or -1 of none, lie on, and what these hide of them."""
    known = [(k, some) for k, some in enumerate(curves.families) if isinstance(some, BodiesMeet)]
    own, which, forms = np.full((len(curve), 2), -1), [np.zeros(0, dtype=np.intp)], [np.zeros((0, 2, 4))]
    family, level = np.append(curves.family, -1)[curve], np.append(curves.level, 0.0)[curve]
    for k, some in known:
        of = np.flatnonzero(family == k)
        row = level[of].astype(np.intp) if len(some.body) > 1 else np.zeros(len(of), dtype=np.intp)
        own[of] = some.body[row]
        which.append(of)
        forms.append(some.form[row])
    row, form = np.concatenate(which), np.concatenate(forms)
    hide: Bools = np.append(np.isin(bodies.same, bodies.same[bodies.hides]), False)
    line, place = np.nonzero((own[row] >= 0) & hide[own[row]])
    return own, OwnSides(row[line], form[line, place], own[row[line], place])
