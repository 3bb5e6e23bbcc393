"""The curves in which bodies meet each other and polyhedra that are no conics: found along the lines that sweep
mantles and caps, or traced; and hidden like the others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import IntEnum
from functools import cached_property, partial
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.curve_tracing import Tracing
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import inverse_matrix, matmul, symmetric_eigen
from vectorplot.geometry.chord_refinement import HALVINGS, Traces, bisected, refined, straight_between
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined
from vectorplot.geometry.vectors import cross, dot
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.capped_bodies import CappedPart
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.tolerances import (
    ALONG_A_RULING,
    CHORD_OF_EXTENT,
    FAMILY_SETTLED,
    MISSED_OF_CHORD,
    NODE_OF_RULINGS,
    ON_BORDER_OF_DOMAIN,
    ONE_BREAK_OF_DOMAIN,
)
from vectorplot.visibility.polyhedra.lines import items_wanting
from vectorplot.visibility.quadrics.bodies import BOTTOM, TOP
from vectorplot.visibility.quadrics.closed_forms import ClosedForms
from vectorplot.visibility.quadrics.occlusion_volumes import Bodies, BodiesMeet
from vectorplot.visibility.smooth.curve_families import FARTHEST, ROUNDS, Along, Chords, no_longer
from vectorplot.visibility.smooth.intersections import curves_of_pairs, curves_with_mesh
from vectorplot.visibility.smooth.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.sheets import ParametricSheet
from vectorplot.visibility.smooth.traced_curves import Curves, together
from vectorplot.words import LineKind

# Where straight lines that sweep a mantle or a cap meet a quadric, and where these meetings begin, end and turn.


@dataclass(frozen=True, eq=False)
class Quadrics:
    """Mantles of bodies, by a row each: the points centre + s @ frame with x^2 + y^2 + bend z^2 + 2 slope z + constant
    = 0 and ends[:,0] < z < ends[:,1], s = (x, y, z).

    centre (k,3); frame (k,3,3); bend, slope, constant (k,); ends (k,2), infinite for balls.
    """

    centre: Floats
    frame: Floats
    bend: Floats
    slope: Floats
    constant: Floats
    ends: Floats

    @cached_property
    def inverse(self) -> Floats:
        """(k,3,3): s = (point - centre) @ inverse."""
        return np.asarray(inverse_matrix(self.frame))

    def unit(self, row: Ints, points: Floats) -> Floats:
        """(n,3) s of points."""
        return np.asarray(np.einsum("ni,nij->nj", points - self.centre[row], self.inverse[row]))

    def product(self, row: Ints, one: Floats, two: Floats) -> Floats:
        """(n,) the quadratic part for two vectors s."""
        x = one[:, 0] * two[:, 0] + one[:, 1] * two[:, 1]
        return np.asarray(x + self.bend[row] * one[:, 2] * two[:, 2])

    def values(self, row: Ints, points: Floats) -> Floats:
        """(n,) 0 on the quadric, negative inside."""
        s = self.unit(row, points)
        return self.product(row, s, s) + 2.0 * self.slope[row] * s[:, 2] + self.constant[row]

    def along(self, row: Ints, start: Floats, way: Floats) -> tuple[Floats, Floats, Floats]:
        """(n,) a, b, c: the value at start + v way is a v^2 + 2 b v + c."""
        p, d = self.unit(row, start), np.einsum("ni,nij->nj", way, self.inverse[row])
        slope = self.slope[row]
        c = self.product(row, p, p) + 2.0 * slope * p[:, 2] + self.constant[row]
        return self.product(row, d, d), self.product(row, d, p) + slope * d[:, 2], c

    def holds(self, row: Ints, points: Floats) -> Bools:
        """(n,) whether points are between the ends."""
        return self.holds_height(row, self.unit(row, points)[:, 2])

    def holds_height(self, row: Ints, z: Floats) -> Bools:
        """(n,) whether heights are between the ends; what runs along an end is not."""
        low, high = self.ends[row].T
        return np.asarray((z - low > ON_BORDER_OF_DOMAIN) & (high - z > ON_BORDER_OF_DOMAIN))

    def rims(self, row: Ints, end: int, angle: Floats) -> Floats:
        """(n,3) points of the rim at an end; NaN of one that is no circle or infinitely far."""
        z = self.ends[row, end]
        with np.errstate(invalid="ignore"):
            radius = np.sqrt(-(self.bend[row] * z * z + 2.0 * self.slope[row] * z + self.constant[row]))
            s = np.stack([radius * np.cos(angle), radius * np.sin(angle), z], axis=1)
            return np.asarray(self.centre[row] + np.einsum("ni,nij->nj", s, self.frame[row]))


class Ruled(Protocol):
    """What straight lines sweep, by a row each: the line at t runs from p(t) along d(t)."""

    @property
    def low(self) -> Floats:
        """(k,) the least t."""

    @property
    def high(self) -> Floats:
        """(k,) the largest t."""

    @property
    def goes_round(self) -> bool:
        """Whether the line at the largest t is that at the least one."""

    def lines(self, row: Ints, t: Floats) -> tuple[Floats, Floats]:
        """(n,3) p and d."""

    def holds(self, row: Ints, t: Floats, v: Floats) -> Bools:
        """(n,) whether p + v d is inside of the borders."""

    def heights(self, row: Ints, points: Floats) -> Floats:
        """(n,) 0 where points are on what is swept."""

    def parameter(self, row: Ints, points: Floats) -> Floats:
        """(n,) t of points that are on it."""

    def borders(self, row: Ints, end: int, angle: Floats) -> tuple[Floats, Floats]:
        """(n,3) points of the border circle at end 0 or 1, and (n,) their t; NaN where there is none."""


SEAM = 0.7
"""The angle at which a mantle is cut open: at none at which things usually are."""


@dataclass(frozen=True, eq=False)
class Mantles:
    """The mantles of frusta; t is the angle, v the height. base, growth (k,): radii are base + growth z."""

    quadrics: Quadrics
    base: Floats
    growth: Floats

    @property
    def low(self) -> Floats:
        """(k,) where it is cut open."""
        return np.full(len(self.base), SEAM - 2.0 * np.pi)

    @property
    def high(self) -> Floats:
        """(k,) a turn further."""
        return np.full(len(self.base), SEAM)

    @property
    def goes_round(self) -> bool:
        """Yes."""
        return True

    def lines(self, row: Ints, t: Floats) -> tuple[Floats, Floats]:
        """(n,3) points of the circle at z = 0, and the ways to those at z = 1."""
        frame = self.quadrics.frame[row]
        out = np.cos(t)[:, None] * frame[:, 0] + np.sin(t)[:, None] * frame[:, 1]
        return (
            self.quadrics.centre[row] + self.base[row, None] * out,
            self.growth[row, None] * out + frame[:, 2],
        )

    def holds(self, row: Ints, t: Floats, v: Floats) -> Bools:
        """(n,) whether between the ends."""
        return self.quadrics.holds_height(row, v)

    def heights(self, row: Ints, points: Floats) -> Floats:
        """(n,) values of the quadric."""
        return self.quadrics.values(row, points)

    def parameter(self, row: Ints, points: Floats) -> Floats:
        """(n,) the angles."""
        s = self.quadrics.unit(row, points)
        angle = arctan2(s[:, 1], s[:, 0])
        return np.where(angle > SEAM, angle - 2.0 * np.pi, angle)

    def borders(self, row: Ints, end: int, angle: Floats) -> tuple[Floats, Floats]:
        """(n,3) points of a rim."""
        return self.quadrics.rims(row, end, angle), angle


@dataclass(frozen=True, eq=False)
class Discs:
    """Caps, swept by parallel chords: the points centre + t across + v along, t^2 + v^2 < 1; all (k,3), across and
    along conjugate radii."""

    centre: Floats
    across: Floats
    along: Floats

    @property
    def low(self) -> Floats:
        """(k,) the rim."""
        return np.full(len(self.centre), -1.0)

    @property
    def high(self) -> Floats:
        """(k,) the rim."""
        return np.ones(len(self.centre))

    @property
    def goes_round(self) -> bool:
        """No."""
        return False

    @cached_property
    def normal(self) -> Floats:
        """(k,3) of unit length."""
        normal = np.cross(self.across, self.along)
        return np.asarray(normal / np.sqrt(dot(normal, normal))[:, None])

    @cached_property
    def _inverse(self) -> Floats:
        """(k,3,3): t, v and the height = (point - centre) @ inverse."""
        return np.asarray(inverse_matrix(np.stack([self.across, self.along, self.normal], axis=1)))

    def lines(self, row: Ints, t: Floats) -> tuple[Floats, Floats]:
        """(n,3) middles of chords, and half the chord through the middle."""
        return self.centre[row] + t[:, None] * self.across[row], self.along[row]

    def holds(self, row: Ints, t: Floats, v: Floats) -> Bools:
        """(n,) whether in the disc."""
        return np.asarray(t * t + v * v < 1.0 - ON_BORDER_OF_DOMAIN)

    def heights(self, row: Ints, points: Floats) -> Floats:
        """(n,) over the plane."""
        return dot(points - self.centre[row], self.normal[row])

    def plane(self, row: Ints, points: Floats) -> tuple[Floats, Floats]:
        """(n,) t and v of points of the plane."""
        t, v, _ = np.einsum("ni,nij->jn", points - self.centre[row], self._inverse[row])
        return t, v

    def parameter(self, row: Ints, points: Floats) -> Floats:
        """(n,) t."""
        return self.plane(row, points)[0]

    def borders(self, row: Ints, end: int, angle: Floats) -> tuple[Floats, Floats]:
        """(n,3) points of the rim, which is the border at end 0."""
        t = np.cos(angle) if end == 0 else np.full(len(angle), np.nan)
        points = self.centre[row] + t[:, None] * self.across[row] + np.sin(angle)[:, None] * self.along[row]
        return points, t


def chords_across(discs: Discs, quadrics: Quadrics) -> Discs:
    """The same discs with the chords along which a quadric in the same row bends most: its section is no steeper over
    the way across them than it has to be."""
    row = np.arange(len(discs.centre))
    one, two = (np.einsum("ni,nij->nj", way, quadrics.inverse) for way in (discs.across, discs.along))
    form = np.empty((len(row), 2, 2))
    form[:, 0, 0], form[:, 1, 1] = quadrics.product(row, one, one), quadrics.product(row, two, two)
    form[:, 0, 1] = form[:, 1, 0] = quadrics.product(row, one, two)
    bends, ways = symmetric_eigen(form)
    most = np.abs(bends).argmax(axis=1)
    a, b = ways[row, :, most].T
    return Discs(
        discs.centre,
        b[:, None] * discs.across - a[:, None] * discs.along,
        a[:, None] * discs.across + b[:, None] * discs.along,
    )


# The straight lines in which flat caps meet.


def cap_meetings(one: Discs, two: Discs, tolerance: float) -> tuple[Floats, Floats, Bools]:
    """Start and end (k,3) of what caps in the same rows have in common, and whether it is anything.

    Edge cases: caps in one plane, but for the tolerance, have no line in common.
    """
    n, m = one.normal, two.normal
    way = cross(n, m)
    square = dot(way, way)
    arm = two.centre - one.centre
    reach = np.sqrt(np.fmax(dot(two.across, two.across), dot(two.along, two.along)) * square)
    apart = np.abs(dot(arm, n)) + reach > tolerance
    with np.errstate(divide="ignore", invalid="ignore"):
        # The point of both planes and of the one across them through the middle of the first cap.
        base = one.centre + (dot(arm, m) / square)[:, None] * cross(way, n)
        first, last = _inside(one, base, way)
        begin, end = _inside(two, base, way)
        low, high = np.fmax(first, begin), np.fmin(last, end)
        met = apart & np.isfinite(first + begin) & (low < high)
    low, high = np.where(met, low, 0.0), np.where(met, high, 0.0)
    base = np.where(met[:, None], base, one.centre)
    return base + low[:, None] * way, base + high[:, None] * way, met


def _inside(discs: Discs, base: Floats, way: Floats) -> tuple[Floats, Floats]:
    """Between which w base + w way is in the disc; NaN where it never is."""
    row = np.arange(len(base))
    p = np.stack(discs.plane(row, base), axis=1)
    d = np.stack(discs.plane(row, base + way), axis=1) - p
    a, b, c = dot(d, d), dot(d, p), dot(p, p) - 1.0
    root = np.sqrt(b * b - a * c)
    return (-b - root) / a, (-b + root) / a


# Zeros of smooth functions of one parameter, many functions at once.

SAMPLES = 192
"""Of a function over its range. One with as few extrema as a trigonometric polynomial of fourth degree, the most that
is asked for here, has one between neighbours."""

GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)

Values = Callable[[Ints, Floats], Floats]
"""Takes numbers (n,) of functions and parameters (n,) to the values (n,)."""


@dataclass(frozen=True, eq=False)
class Zeros:
    """row (z,): the functions; t (z,): their zeros; single (z,): the function changes its sign there, else it only
    touches zero."""

    row: Ints
    t: Floats
    single: Bools


def zeros_of(values: Values, low: Floats, high: Floats, goes_round: bool, touching: float) -> Zeros:
    """The zeros of functions (k,) from low to high (k,).

    goes_round: after high follows what follows low. touching: the part of the largest absolute value below which an
    extremum counts as zero. Functions with no finite values have no zeros. Edge cases: of two zeros beyond two samples
    nearer than these, two extrema between, none is seen; a function that is zero all over has zeros anywhere.
    """
    count = len(low)
    row = np.repeat(np.arange(count), SAMPLES + 1)
    t = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, SAMPLES + 1)
    y = values(row, t.reshape(-1)).reshape(t.shape)
    size = np.abs(y).max(axis=1, initial=0.0)
    with np.errstate(invalid="ignore"):
        crossing = ((y[:, :-1] > 0.0) != (y[:, 1:] > 0.0)) & np.isfinite(y[:, :-1] + y[:, 1:])
        one, at = np.nonzero(crossing)
        before = np.concatenate([y[:, -2:-1] if goes_round else np.full((count, 1), np.inf), y[:, :-1]], axis=1)
        after = np.concatenate([y[:, 1:], y[:, 1:2] if goes_round else np.full((count, 1), np.inf)], axis=1)
        least = (np.abs(y) <= np.abs(before)) & (np.abs(y) <= np.abs(after))
        same = ((before > 0.0) == (y > 0.0)) & ((after > 0.0) == (y > 0.0))
        near = least & same & (np.abs(y) <= 0.25 * size[:, None]) & np.isfinite(y)
    if goes_round:
        near[:, -1] = False
    two, middle = np.nonzero(near)
    step = (high - low)[two] / SAMPLES
    centre = t[two, middle]
    first = centre - step if goes_round else np.maximum(centre - step, low[two])
    last = centre + step if goes_round else np.minimum(centre + step, high[two])
    sign = np.where(y[two, middle] > 0.0, 1.0, -1.0)
    place, value = _lowest(values, two, sign, first, last)
    passes, touches = value < 0.0, np.abs(value) <= touching * size[two]
    rows = np.concatenate([one, two[passes], two[passes]])
    starts = np.concatenate([t[one, at], first[passes], place[passes]])
    ends = np.concatenate([t[one, at + 1], place[passes], last[passes]])
    found = _between(values, rows, starts, ends)
    only = touches & ~passes
    return Zeros(
        np.concatenate([rows, two[only]]),
        np.concatenate([found, place[only]]),
        np.concatenate([np.ones(len(rows), dtype=np.bool_), np.zeros(int(only.sum()), dtype=np.bool_)]),
    )


def _between(values: Values, row: Ints, start: Floats, end: Floats) -> Floats:
    """(n,) where functions change their sign between start and end."""
    positive = values(row, start) > 0.0
    low, high = bisected(lambda which, t: (values(row[which], t) > 0.0) == positive[which], start, end, HALVINGS)
    return 0.5 * (low + high)


def _lowest(values: Values, row: Ints, sign: Floats, start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """(n,) where sign times a function is least between start and end, and its value there: the golden section."""
    one, two = end - GOLDEN * (end - start), start + GOLDEN * (end - start)
    low, high = sign * values(row, one), sign * values(row, two)
    for _ in range(HALVINGS):
        left = low < high
        start, end = np.where(left, start, one), np.where(left, two, end)
        new = np.where(left, end - GOLDEN * (end - start), start + GOLDEN * (end - start))
        value = sign * values(row, new)
        one, two = np.where(left, new, two), np.where(left, one, new)
        low, high = np.where(left, value, high), np.where(left, low, value)
    return np.where(low < high, one, two), np.minimum(low, high)


# The curves in which mantles and caps meet quadrics: the lines that sweep the former meet these twice.

MOST_POINTS = 1 << 21
"""Points of all curves at most: a tolerance that asks for more is not kept."""

BEGINNING = 9
"""Points of each piece of a curve before it is refined."""

LOOKED_AT = 24
"""Lines of each row that tell whether it can be decided."""

Picture = Callable[[Floats], Floats]


class Break(IntEnum):
    """What happens at a line that sweeps: a curve meets a border, or turns back, or two curves cross or nearly do."""

    BORDER = 0
    TURN = 1
    NODE = 2


@dataclass(frozen=True, eq=False)
class RuledCurves:
    """Polylines: points (n,3), those of closed ones with the first one once more at the end; offsets (m+1,);
    closed (m,); row (m,): which of the pairs of surfaces meet in them."""

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    row: Ints = field(metadata=EACH_LINE)


@dataclass(frozen=True, eq=False)
class _Breaks:
    """Lines at which something happens, row after row: row, t, kind (b,)."""

    row: Ints
    t: Floats
    kind: Ints


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Parts of curves over which nothing happens: row; start, end: of t; branch: -1 or 1, which of two meetings;
    is_round: all around; first, last: the nodes at both ends, which pieces share that go on in one another; flat (p,2):
    whether the two meetings are one at the ends."""

    row: Ints
    start: Floats
    end: Floats
    branch: Ints
    is_round: Bools
    first: Ints
    last: Ints
    flat: Bools


def ruled_meetings(
    ruled: Ruled, quadrics: Quadrics, picture: Picture | None, tolerance: float
) -> tuple[RuledCurves, Ints]:
    """The curves in which what lines sweep and quadrics in the same rows (k,) meet, and the rows left open: of those
    that have lines in common, or touch along them, or nearly do.

    Chords deviate from the curves by no more than the tolerance, measured in the picture, or in space.
    Source: Levin, Mathematical models for determining the intersections of quadric surfaces (1979).
    """
    open_ = _left_open(ruled, quadrics)
    breaks = _breaks(ruled, quadrics, open_)
    pieces = _pieces(ruled, quadrics, breaks, open_)
    return _curves(ruled, quadrics, pieces, picture, tolerance), np.flatnonzero(open_)


def _discriminant(ruled: Ruled, quadrics: Quadrics, row: Ints, t: Floats) -> Floats:
    """(n,) b^2 - a c."""
    a, b, c = quadrics.along(row, *ruled.lines(row, t))
    return b * b - a * c


def _left_open(ruled: Ruled, quadrics: Quadrics) -> Bools:
    """(k,) the rows all of whose lines, but for rounding, run along the quadric, or meet it once and infinitely far."""
    count = len(ruled.low)
    row = np.repeat(np.arange(count), LOOKED_AT)
    share = (np.arange(LOOKED_AT) + 0.5) / LOOKED_AT
    t = (ruled.low[:, None] + (ruled.high - ruled.low)[:, None] * share).reshape(-1)
    start, way = ruled.lines(row, t)
    p, d = quadrics.unit(row, start), np.einsum("ni,nij->nj", way, quadrics.inverse[row])
    size = dot(d, d) * (1.0 + dot(p, p))
    part = np.abs(_discriminant(ruled, quadrics, row, t)) / size
    return np.asarray(part.reshape(count, LOOKED_AT).max(axis=1, initial=0.0) <= ALONG_A_RULING)


def _breaks(ruled: Ruled, quadrics: Quadrics, open_: Bools) -> _Breaks:
    """All breaks, each once, and the ends of what does not go round."""
    low, high = ruled.low, ruled.high
    turn = np.full(len(low), np.pi)

    def zeros(values: Callable[[Ints, Floats], Floats], first: Floats, last: Floats, goes_round: bool) -> _Breaks:
        found = zeros_of(values, first, last, goes_round, NODE_OF_RULINGS)
        return _Breaks(found.row, found.t, np.where(found.single, Break.TURN, Break.NODE))

    parts = [zeros(lambda row, t: _discriminant(ruled, quadrics, row, t), low, high, ruled.goes_round)]
    for end in (0, 1):
        own = zeros(lambda row, w, end=end: quadrics.values(row, ruled.borders(row, end, w)[0]), -turn, turn, True)  # type: ignore[misc]
        parts.append(_Breaks(own.row, ruled.borders(own.row, end, own.t)[1], np.zeros_like(own.kind)))
        other = zeros(lambda row, w, end=end: ruled.heights(row, quadrics.rims(row, end, w)), -turn, turn, True)  # type: ignore[misc]
        at = ruled.parameter(other.row, quadrics.rims(other.row, end, other.t))
        parts.append(_Breaks(other.row, at, np.zeros_like(other.kind)))
    if not ruled.goes_round:
        every = np.arange(len(low))
        parts += [_Breaks(every, end, np.full(len(low), int(Break.BORDER))) for end in (low, high)]
    found = records.joined(parts)
    t = found.t
    if ruled.goes_round:
        t = high[found.row] - np.mod(high[found.row] - t, (high - low)[found.row])
    kept = np.flatnonzero(~open_[found.row] & (t >= low[found.row]) & (t <= high[found.row]))
    kept = kept[np.lexsort((t[kept], found.row[kept]))]
    return _once(_Breaks(found.row[kept], t[kept], found.kind[kept]), ONE_BREAK_OF_DOMAIN * (high - low))


def _once(breaks: _Breaks, near: Floats) -> _Breaks:
    """Breaks in order with those that are near each other as one; near (k,). Two turns are a node."""
    if not len(breaks.row):
        return breaks
    new = (np.diff(breaks.row, prepend=-1) > 0) | (np.diff(breaks.t, prepend=-np.inf) > near[breaks.row])
    first = np.flatnonzero(new)
    # What is known best about a place tells where it is.
    best = np.maximum.reduceat(breaks.kind, first)[np.cumsum(new) - 1] == breaks.kind
    t = np.add.reduceat(best * breaks.t, first) / np.add.reduceat(best.astype(np.float64), first)
    turns = np.add.reduceat((breaks.kind == Break.TURN).astype(np.intp), first)
    kind = np.maximum.reduceat(breaks.kind, first)
    return _Breaks(breaks.row[first], t, np.where(turns > 1, int(Break.NODE), kind))


def _pieces(ruled: Ruled, quadrics: Quadrics, breaks: _Breaks, open_: Bools) -> _Pieces:
    """The pieces between breaks, and all around without any, that are on both surfaces."""
    sizes = np.bincount(breaks.row, minlength=len(ruled.low))
    here = np.arange(len(breaks.row))
    there = ragged.following(ragged.offsets(sizes))
    wraps = there <= here
    ends = np.where(wraps, breaks.t[there] + (ruled.high - ruled.low)[breaks.row], breaks.t[there])
    if not ruled.goes_round:
        here, there, ends = here[~wraps], there[~wraps], ends[~wraps]
    whole = np.flatnonzero((sizes == 0) & ~open_ & ruled.goes_round)
    is_round = np.arange(len(here) + len(whole)) >= len(here)
    row = np.concatenate([breaks.row[here], whole])
    start = np.concatenate([breaks.t[here], ruled.low[whole]])
    end = np.concatenate([ends, ruled.high[whole]])
    none = np.full(len(whole), -1)
    at_start, at_end = np.concatenate([here, none]), np.concatenate([there, none])
    middle, no = 0.5 * (start + end), np.zeros(len(row), dtype=np.bool_)
    kind = np.append(breaks.kind, Break.BORDER)
    parts = []
    for branch in (-1, 1):
        v, real = _meeting(ruled, quadrics, row, middle, np.full(len(row), branch), no)
        p, d = ruled.lines(row, middle)
        with np.errstate(invalid="ignore"):
            on = np.flatnonzero(real & ruled.holds(row, middle, v) & quadrics.holds(row, p + v[:, None] * d))
        a, b = at_start[on], at_end[on]
        first, last = _node(kind, a, branch), _node(kind, b, branch)
        flat = np.stack([kind[a], kind[b]], axis=1) != Break.BORDER
        which = np.full(len(on), branch)
        parts.append(_Pieces(row[on], start[on], end[on], which, is_round[on], first, last, flat))
    return records.joined(parts)


def _node(kind: Ints, at: Ints, branch: int) -> Ints:
    """(n,) numbers of the ends of pieces at breaks of these kinds: both meetings have one where they are one; -1 where
    curves cross, and where there is no break, which is the last one."""
    number = 2 * at + np.where(kind[at] == Break.TURN, 0, branch > 0)
    return np.where((at < 0) | (kind[at] == Break.NODE), -1, number)


def _meeting(ruled: Ruled, quadrics: Quadrics, row: Ints, t: Floats, branch: Ints, flat: Bools) -> tuple[Floats, Bools]:
    """v (n,) of one of the two meetings of lines, and whether there is one; flat: both are one."""
    a, b, c = quadrics.along(row, *ruled.lines(row, t))
    square = b * b - a * c
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.where(flat, 0.0, np.sqrt(np.maximum(square, 0.0)))
        # Of b and the root with one sign nothing is cancelled.
        far = -(b + np.where(b >= 0.0, root, -root))
        v = np.where((b >= 0.0) == (branch < 0), far / a, c / far)
        v = np.where(flat, -b / a, v)
    return v, np.asarray((square > 0.0) & np.isfinite(v))


def _curves(
    ruled: Ruled, quadrics: Quadrics, pieces: _Pieces, picture: Picture | None, tolerance: float
) -> RuledCurves:
    """The pieces as refined polylines, joined where one goes on in another."""
    count = len(pieces.row)

    def points(rows: Floats) -> Floats:
        piece = rows[:, 0].astype(np.intp)
        row, share = pieces.row[piece], rows[:, 1]
        start, span = pieces.start[piece], pieces.end[piece] - pieces.start[piece]
        # Near a turn v runs as the root of the way to it.
        t = start + span * np.where(pieces.is_round[piece], share, 0.5 - 0.5 * np.cos(np.pi * share))
        first, last = pieces.flat[piece].T
        flat = ((share == 0.0) & first) | ((share == 1.0) & last)
        v, _ = _meeting(ruled, quadrics, row, t, pieces.branch[piece], flat)
        p, d = ruled.lines(row, t)
        return np.asarray(p + v[:, None] * d)

    share = np.tile(np.linspace(0.0, 1.0, BEGINNING), count)
    rows = np.stack([np.repeat(np.arange(count, dtype=np.float64), BEGINNING), share], axis=1)
    lines = Traces(rows, share == 1.0)

    def image(rows: Floats) -> Floats:
        return points(rows) if picture is None else picture(points(rows))

    traces = refined(lines, straight_between, image, tolerance, MOST_POINTS).lines
    piece = traces.points[:, 0].astype(np.intp)
    # Ends that pieces share are one point; every other point is by itself.
    number = np.arange(len(piece))
    starts, ends = traces.starts, traces.ends
    alone = len(piece)
    node = np.concatenate([pieces.first, pieces.last])
    at = np.concatenate([starts, ends])
    shared = np.flatnonzero(node >= 0)
    number[at[shared]] = alone + node[shared]
    loops = np.flatnonzero(pieces.is_round)
    number[ends[loops]] = starts[loops]
    segment = np.flatnonzero(~traces.last)
    edges = np.stack([number[segment], number[segment + 1]], axis=1)
    place, code = np.unique(number, return_index=True)
    branches = concat(edges)
    index = code[np.searchsorted(place, branches.points)]
    again = ragged.offsets(np.diff(branches.offsets) + branches.closed)
    first = branches.offsets[:-1]
    position = ragged.ranges(first, np.diff(again))
    position[again[1:][branches.closed] - 1] = first[branches.closed]
    index = index[position]
    return RuledCurves(points(traces.points[index]), again, branches.closed, pieces.row[piece[index[again[:-1]]]])


# The curves in which mantles and caps of bodies meet, pair by pair in whole arrays.

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
    kept = records.take(every, np.flatnonzero(near))
    return records.take(kept, np.lexsort((kept.part[:, 1], kept.part[:, 0], kept.body[:, 1], kept.body[:, 0])))


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
    return joined(found), np.sort(np.concatenate(left))


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
    return records.take(every, which)


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


# Curves in which quadrics meet, and planes do: between their points they lie on both.


@dataclass(frozen=True, eq=False)
class QuadricsMeet:
    """Curves of pairs of quadrics, forms (k,2,4,4): x form x = 0 for homogeneous points x of the view. The first
    coordinate of the places of a curve is the number of its pair."""

    forms: Floats
    sheet: int = -1
    second: int = -1

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords: in the plane across the chord to where both quadrics are, by Newton's
        method. Edge cases: where they touch, the chord."""
        start, end = chords.points
        way = end - start
        base, size = start + part[:, None] * way, np.sqrt(dot(way, way))
        forms = self.forms[chords.places[0][:, 0].astype(np.intp)]
        found, last = base.copy(), np.zeros(len(base))
        with np.errstate(all="ignore"):
            for _ in range(ROUNDS):
                values, (n, m) = _at(forms, found)
                across_n, across_m = cross(m, way), cross(way, n)
                ahead = dot(base - found, way)[:, None] * cross(n, m)
                step = (ahead - values[:, :1] * across_n - values[:, 1:] * across_m) / dot(n, across_n)[:, None]
                step = no_longer(np.where(np.isfinite(step), step, 0.0), FARTHEST * size)
                found, last = found + step, np.sqrt(dot(step, step))
                if (last <= FAMILY_SETTLED * size).all():
                    break
            _, (n, m) = _at(forms, found)
            tangent = cross(n, m)
            tangent *= (dot(way, way) / dot(tangent, way))[:, None]
        met = (last <= MISSED_OF_CHORD * size)[:, None]
        along = np.isfinite(tangent).all(axis=1, keepdims=True)
        return Along(chords.places[0], np.where(met, found, base), np.where(met & along, tangent, way))


def _at(forms: Floats, points: Floats) -> tuple[Floats, tuple[Floats, Floats]]:
    """The values (n,2) of pairs of forms (n,2,4,4) at points (n,3), and the gradients (n,3) of both."""
    x = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    half = np.einsum("nkij,nj->nki", forms, x)
    return np.einsum("nki,ni->nk", half, x), (2.0 * half[:, 0, :3], 2.0 * half[:, 1, :3])


@dataclass(frozen=True, eq=False)
class _Part:
    """A smooth part of a body: its sheet, the body's number, and the form (4,) that is negative where the part is
    turned away."""

    sheet: ParametricSheet
    body: int
    form: Floats


_Parts = dict[tuple[int, int], _Part]
"""The parts of bodies, by the number of the body and which part it is: BOTTOM, TOP or MANTLE."""


def traced_meetings(
    scene: Scene, view: View, forms: ClosedForms, kinds: frozenset[LineKind], tracing: Tracing
) -> tuple[Curves, tuple[tuple[str, str], ...]]:
    """The curves of the pairs of bodies, and of bodies and polyhedra, that meet in no circles; and doubts about them,
    each with the name of the item or items.

    A curve belongs to the item, of those that want it, that comes first in the scene.
    """
    bodies, doubts = forms.bodies, []
    wants = items_wanting(LineKind.INTERSECTION, scene, kinds)

    def owner(*items: int) -> int:
        return next(item for item in sorted(items) if wants[item])

    pairs = pairs_of_parts(bodies, forms.traced)
    lines, left = part_meetings(bodies, pairs, tracing)
    needed = {*pairs.body[left].ravel().tolist(), *forms.in_faces[:, 0].tolist()}
    parts = {key: part for body in needed for key, part in _parts(scene, view, bodies, body).items()}
    found = [_of_lines(bodies, pairs, lines, wants)]
    number = {key: k for k, key in enumerate(parts)}
    sheets = [part.sheet for part in parts.values()]
    bodies_of, parts_of = pairs.body[left].tolist(), pairs.part[left].tolist()
    keys = [((a, p), (b, q)) for (a, b), (p, q) in zip(bodies_of, parts_of, strict=True)]
    asked = [(number[one], number[two], owner(int(bodies.item[one[0]]), int(bodies.item[two[0]]))) for one, two in keys]
    for (one, two), (curves, unsure) in zip(keys, curves_of_pairs(sheets, asked, tracing), strict=True):
        names = " and ".join(scene.items[int(bodies.item[body])].name for body, _ in (one, two))
        found.append(_on_bodies(curves, (parts[one], parts[two])))
        doubts += [(names, text) for text in unsure]
    for body, other in forms.in_faces.tolist():
        shape = scene.items[other].shape
        assert isinstance(shape, Mesh)
        mesh = Mesh(view.points_of(shape.vertices).T, shape.corners, shape.offsets, shape.present)
        for part in (part for (of, _), part in parts.items() if of == body):
            curves, unsure = curves_with_mesh(part.sheet, mesh, owner(int(bodies.item[body]), other), tracing)
            found.append(_on_bodies(curves, (part,)))
            doubts += [(scene.items[int(bodies.item[body])].name, text) for text in unsure]
    return together(found), tuple(dict.fromkeys(doubts))


def _parts(scene: Scene, view: View, bodies: Bodies, body: int) -> _Parts:
    """The smooth parts of a body."""
    item = int(bodies.item[body])
    shape, count = scene.items[item].shape, len(bodies.balls)
    result = {}
    for sheet in sheets_of_parametrised(view, shape, item, scene.items[item].hides):  # type: ignore[arg-type]
        number = _part_of(sheet) if body >= count else MANTLE
        (form,) = parts_shown(bodies, np.array([body]), np.array([number]))
        result[body, number] = _Part(sheet, body, form)
    return result


def _part_of(sheet: ParametricSheet) -> int:
    surface = sheet.surface
    while isinstance(surface, PlacedSurface):
        surface = surface.surface
    assert isinstance(surface, CappedPart)
    return {"bottom": BOTTOM, "top": TOP, "mantle": MANTLE}[surface.part]


def _of_lines(bodies: Bodies, pairs: PartPairs, lines: RuledCurves, wants: Bools) -> Curves:
    """What was found along lines, with what is known of the bodies that it lies on."""
    used, family = np.unique(lines.row, return_inverse=True)
    body, part = pairs.body[used], pairs.part[used]
    shown = np.stack([parts_shown(bodies, body[:, k], part[:, k]) for k in range(2)], axis=1)
    meet = QuadricsMeet(np.stack([forms_of_parts(bodies, body[:, k], part[:, k]) for k in range(2)], axis=1))
    places = np.zeros((len(lines.points), 3))
    places[:, 0] = np.repeat(family, np.diff(lines.offsets))
    one, two = bodies.item[pairs.body[lines.row]].T
    none = np.full(len(lines.row), -1)
    return Curves(
        points=bodies.sight.points_of_view(lines.points),
        places=places,
        second_places=np.full_like(places, np.nan),
        offsets=lines.offsets,
        closed=lines.closed,
        kind=np.full(len(none), int(LineKind.INTERSECTION)),
        item=np.where(wants[one] & (~wants[two] | (one < two)), one, two),
        family=np.zeros(len(none), dtype=np.intp),
        level=family.astype(np.float64),
        families=(BodiesMeet(meet, body, shown),),
        sheet=none,
        second_sheet=none,
    )


def _on_bodies(curves: Curves, parts: tuple[_Part, ...]) -> Curves:
    """The curves with what is known of the bodies that they lie on."""
    body = np.full((1, 2), -1)
    form = np.zeros((1, 2, 4))
    for k, part in enumerate(parts):
        body[0, k], form[0, k] = part.body, part.form
    families, no_sheet = tuple(BodiesMeet(family, body, form) for family in curves.families), np.full(len(curves), -1)
    return replace(curves, families=families, sheet=no_sheet, second_sheet=no_sheet)
