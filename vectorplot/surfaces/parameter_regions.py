"""Parts of the domains of surfaces that closed curves in u and v bound: trims of surfaces, with holes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier import bezier_points, bezier_tangents, flattened, split
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.cut_curve import breaks_of
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import any_component, dot, from_components, norm
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances import (
    BESIDE_TRIM,
    JUST_BEFORE,
    LEAST_DIVISOR,
    ON_TRIM,
    ROUNDING_OF_DOMAIN,
    STRAIGHT_TRIM,
    TRIM_CURVE_OFF,
    TRIMS_APART,
)

# Closed curves in u and v as cubic pieces.

FIRST_PIECES, MOST_PIECES = 16, 1 << 14
"""A curve is first divided into so many pieces between its breaks, and into no more than that in all."""

MOST_LOOPS = 100_000
"""Curves that trim one surface, at most."""

LOOKS = (0.25, 0.5, 0.75)
"""Where a cubic piece is compared with the curve."""

Loop = Any
"""A closed curve in u and v: corners (n,2) of a polygon, or a curve with z = 0."""


def loop_pieces(name: str, loop: Loop) -> Floats:
    """(k,4,2) the control points of the cubic pieces of a curve in u and v; name: what errors call it.

    Polygons are as they are; of curves pieces are within TRIM_CURVE_OFF of their size.
    Errors: InputError for what is none, for fewer than three corners, coordinates that are not finite, curves that
    leave the plane z = 0 or need more than MOST_PIECES pieces.
    """
    if is_curve(loop):
        return _pieces_of_curve(name, loop)
    try:
        corners = np.array(loop, dtype=np.float64)
    except (TypeError, ValueError):
        corners = np.zeros(0)
    if corners.ndim != 2 or corners.shape[1] != 2 or not np.isfinite(corners).all():
        raise InputError(f"{name}: expected corners (n, 2) of finite u and v, or a curve in the plane")
    corners = corners[np.append(True, (np.diff(corners, axis=0) != 0.0).any(axis=1))]
    if len(corners) > 1 and (corners[0] == corners[-1]).all():
        corners = corners[:-1]
    if len(corners) < 3:
        raise InputError(f"{name}: a polygon has at least three corners that differ")
    return _straight(corners, np.roll(corners, -1, axis=0))


def _straight(start: Floats, end: Floats) -> Floats:
    """(k,4,2) straight pieces."""
    way = end - start
    return np.stack([start, start + way / 3.0, end - way / 3.0, end], axis=1)


def _pieces_of_curve(name: str, curve: Curve) -> Floats:
    """(k,4,2) cubic pieces with the points and the tangents of a curve, divided until they are near it."""
    t = np.union1d(np.linspace(curve.start, curve.end, FIRST_PIECES + 1), breaks_of(curve))
    looks = np.array(LOOKS)[:, None]
    while True:
        start, span = t[:-1], np.diff(t)
        with np.errstate(all="ignore"):
            inner = start + np.array([[JUST_BEFORE], [1.0 - JUST_BEFORE]]) * span
            ends = np.asarray(curve.points(t), dtype=np.float64)
            slopes = np.asarray(curve.tangents(inner), dtype=np.float64) * span[:, None] / 3.0
            between = np.asarray(curve.points(start + looks * span), dtype=np.float64)
        if not all(np.isfinite(some).all() for some in (ends, slopes, between)):
            raise InputError(f"{name}: the curve is not finite everywhere")
        size = float(np.ptp(ends[:, :2], axis=0).max(initial=0.0))
        if ends.shape[1] > 2 and np.abs(ends[:, 2:]).max(initial=0.0) > ON_TRIM * size:
            raise InputError(f"{name}: the curve leaves the plane z = 0, in which x is u and y is v")
        before, after = ends[:-1, :2], ends[1:, :2]
        pieces = np.stack([before, before + slopes[0, :, :2], after - slopes[1, :, :2], after], axis=1)
        off = norm(bezier_points(pieces, np.broadcast_to(looks, (len(LOOKS), len(span)))) - between[..., :2])
        coarse = np.flatnonzero(off.max(axis=0) > TRIM_CURVE_OFF * size)
        if not len(coarse):
            return pieces
        if len(t) + len(coarse) > MOST_PIECES:
            raise InputError(f"{name}: the curve needs more than {MOST_PIECES} cubic pieces")
        t = np.insert(t, coarse + 1, start[coarse] + 0.5 * span[coarse])


def bounds_of_loops(loops: Sequence[Floats]) -> Floats:
    """(2,2) smallest and largest u and v of the pieces of curves."""
    return np.asarray(bounds_of_many([loops])[0])


def bounds_of_many(many: Sequence[Sequence[Floats]]) -> Floats:
    """(m,2,2) smallest and largest u and v of the pieces of curves, one or more in each of (m,)."""
    control = np.concatenate([one for loops in many for one in loops])
    first = ragged.starts([sum(map(len, loops)) for loops in many])
    points = bezier_points(control, np.broadcast_to(np.linspace(0.0, 1.0, 9)[:, None], (9, len(control))))
    low, high = points.min(axis=0), points.max(axis=0)
    parts, of = monotone(control)
    np.minimum.at(low, of, parts[:, 0])
    np.maximum.at(high, of, parts[:, 0])
    return np.stack([np.minimum.reduceat(low, first), np.maximum.reduceat(high, first)], axis=1)


def monotone(control: Floats) -> tuple[Floats, Ints]:
    """(p,4,2) pieces (k,4,2) divided where u or v turns back along them, and (p,) which one each is a part of."""
    of = np.arange(len(control))
    for axis in (0, 1, 0, 1):
        step = np.diff(control[:, :, axis], axis=1)
        a, b, c = step[:, 0] - 2.0 * step[:, 1] + step[:, 2], 2.0 * (step[:, 1] - step[:, 0]), step[:, 0]
        with np.errstate(all="ignore"):
            q = -0.5 * (b + np.where(b < 0.0, -1.0, 1.0) * np.sqrt(b * b - 4.0 * a * c))
            roots = np.stack([q / a, c / q], axis=1)
        size = np.abs(step).max(axis=1, initial=0.0)
        # A piece that stands still in one direction has no turn there.
        inner = (roots > JUST_BEFORE) & (roots < 1.0 - JUST_BEFORE) & (size > 0.0)[:, None]
        control, of = _divided(control, of, np.where(inner, roots, np.inf).min(axis=1, initial=np.inf))
    return control, of


def _divided(control: Floats, of: Ints, t: Floats) -> tuple[Floats, Ints]:
    """Pieces divided at parameters (k,), those at which they are infinite not at all."""
    cut = np.flatnonzero(np.isfinite(t))
    if not len(cut):
        return control, of
    before, after = split(control[cut], t[cut])
    result = control.copy()
    result[cut] = before
    return np.insert(result, cut + 1, after, axis=0), np.insert(of, cut + 1, of[cut])


def _at_value(control: Floats, axis: int, value: Floats) -> Floats:
    """(k,) where one coordinate of monotone pieces (k,4,2), which begin and end on different sides of values (k,), has
    these: by Newton's method, halving where it leads out of what is left."""
    own = control[:, :, axis]
    low, high = np.zeros(len(own)), np.ones(len(own))
    rising = own[:, 3] > own[:, 0]
    with np.errstate(all="ignore"):
        t = np.clip(np.nan_to_num((value - own[:, 0]) / (own[:, 3] - own[:, 0]), nan=0.5), 0.0, 1.0)
        for _ in range(SETTLING):
            off = bezier_points(own[..., None], t)[:, 0] - value
            below = (off < 0.0) == rising
            low, high = np.where(below, t, low), np.where(below, high, t)
            moved = t - off / bezier_tangents(own[..., None], t)[:, 0]
            t = np.where((moved >= low) & (moved <= high), moved, 0.5 * (low + high))
    return t


SETTLING = 12
"""Rounds of Newton's method on a piece."""


# Regions: which places are inside, where their borders run, and to which side of these they lie.

MOST_ROWS = 512
"""Strips across v in which pieces are looked for, at most."""

AT_ONCE = 1 << 19
"""Pairs of a place and a piece that are looked at together, about."""


@dataclass(frozen=True, eq=False)
class ParameterRegions:
    """Regions (r,) of domains, each bounded by closed curves that do not cross; many are asked as one.

    start, size (r,2): of the domains; closed (r,2): in which directions they close; filled (r,): what lies within no
    curve is inside, as where there are holes only. Pieces of all curves, after each other as they run: control (p,4,2),
    along none of which u or v turns back; loop (p,) the curve, and of (p,) the region of each; side (p,): 1 where the
    region lies to the left of a piece, -1 where to the right, 0 where the piece is no border of it: along seams, along
    ends of the domain, and beyond these.

    A place no farther from a border than ON_TRIM of the domain is inside.
    """

    start: Floats
    size: Floats
    closed: Bools
    filled: Bools
    control: Floats
    loop: Ints
    of: Ints
    side: Ints

    def __len__(self) -> int:
        return len(self.filled)

    @classmethod
    def together(cls, regions: Sequence[ParameterRegions]) -> ParameterRegions:
        """The regions of all."""
        loops = ragged.starts([int(one.loop.max(initial=-1)) + 1 for one in regions])
        first = ragged.starts([len(one) for one in regions])
        return cls(
            np.concatenate([one.start for one in regions]),
            np.concatenate([one.size for one in regions]),
            np.concatenate([one.closed for one in regions]),
            np.concatenate([one.filled for one in regions]),
            np.concatenate([one.control for one in regions]),
            np.concatenate([one.loop + at for one, at in zip(regions, loops, strict=True)]),
            np.concatenate([one.of + at for one, at in zip(regions, first, strict=True)]),
            np.concatenate([one.side for one in regions]),
        )

    def apart(self) -> list[ParameterRegions]:
        """Each region by itself."""
        first = np.searchsorted(self.of, np.arange(len(self) + 1)).tolist()
        result = []
        for number, (a, b) in enumerate(pairwise(first)):
            loop, one = self.loop[a:b], slice(number, number + 1)
            begin = int(loop[0]) if b > a else 0
            of = np.zeros(b - a, dtype=np.intp)
            own = (self.start[one], self.size[one], self.closed[one], self.filled[one])
            result.append(ParameterRegions(*own, self.control[a:b], loop - begin, of, self.side[a:b]))
        return result

    @property
    def leaves_anything(self) -> bool:
        """Whether anything of a region is inside: one that has no border is all of its domain or nothing."""
        if (self.side != 0).any():
            return True
        u, v = (self.start + 0.5 * self.size).T
        return bool(self.contains(u, v, np.arange(len(self))).any())

    def contains(self, u: Floats, v: Floats, which: Ints | int = 0) -> Bools:
        """(...) whether places u, v (...) are inside of regions, given by their numbers (...) or as one."""
        u, v, number = np.broadcast_arrays(u, v, which)
        places, of = from_components(u.ravel(), v.ravel()), number.ravel()
        inside, on = self._located(places, of)
        return (inside | on).reshape(u.shape)

    def inwards(self, places: Floats, which: Ints) -> tuple[Floats, Floats]:
        """The ways (k,2) in u and v from places (k,2) on borders of regions (k,) into these, and along the borders
        (k,2); 0 elsewhere. In a corner the one leads between both sides, and there is no way along."""
        into, along, count = np.zeros_like(places), np.zeros_like(places), np.zeros(len(places))
        for pairs in self._pairs(places, which):
            row, piece, t = self._close(pairs)
            border = self.side[piece] != 0
            row, piece, t = row[border], piece[border], t[border]
            way = _unit(bezier_tangents(self._scaled[piece], np.clip(t, BESIDE_TRIM, 1.0 - BESIDE_TRIM)))
            left = self.side[piece, None] * from_components(-way[:, 1], way[:, 0])
            np.add.at(into, row, left)
            np.add.at(along, row, self.side[piece, None] * way)
            np.add.at(count, row, 1.0)
        # Where one piece goes on as the next both say nearly the same.
        straight = norm(along) >= (1.0 - STRAIGHT_TRIM) * count
        size = self.size[which]
        return _unit(into) * size, np.where(straight[:, None], _unit(along), 0.0) * size

    def borders_within(self, low: Floats, high: Floats) -> Bools:
        """(k,) whether a border may come into boxes of u and v from low to high (k,2), of one region."""
        import shapely

        # In every round to which a part of a box may belong.
        one, two = self._boxes
        boxes = shapely.box(*(one[self.side != 0] - ON_TRIM).T, *(two[self.side != 0] + ON_TRIM).T)
        tree, result = shapely.STRtree(boxes), np.zeros(len(low), dtype=np.bool_)
        low, high = ((ends - self.start[0]) / self.size[0] for ends in (low, high))
        first, last = (rounds[0] for rounds in self._rounds)
        for i in range(int(first[0]) - 1, int(last[0]) + 2) if self.closed[0, 0] else (0,):
            for j in range(int(first[1]) - 1, int(last[1]) + 2) if self.closed[0, 1] else (0,):
                turn = np.array([i, j], dtype=np.float64)
                result[tree.query(shapely.box(*(low + turn).T, *(high + turn).T))[0]] = True
        return result

    def polygons(self, tolerance: float) -> Any:
        """A polygon of shapely, or several, about within a tolerance of what is inside of the only region, in parts of
        its domain and no farther than that; corners lie on the curves."""
        import shapely

        points, offsets = flattened(self._scaled, ragged.offsets(np.diff(self._loop_ends, axis=1)[:, 0]), tolerance)
        rings = shapely.make_valid(
            shapely.polygons(shapely.linearrings(points, indices=ragged.owner(np.diff(offsets))))
        )
        domain, (first, last) = shapely.box(0.0, 0.0, 1.0, 1.0), (rounds[0].tolist() for rounds in self._rounds)
        if self.closed[0].any():
            turns = [(-i, -j) for i in range(first[0], last[0] + 1) for j in range(first[1], last[1] + 1)]
            copies = [shapely.transform(rings, lambda at, turn=turn: at + turn) for turn in turns]
            rings = shapely.union_all(np.stack(copies), axis=0)
        while len(rings) > 1:
            pairs = len(rings) // 2
            both = shapely.symmetric_difference(rings[:pairs], rings[pairs : 2 * pairs])
            rings = np.concatenate([both, rings[2 * pairs :]])
        odd = rings[0]
        inside = shapely.difference(domain, odd) if self.filled[0] else shapely.intersection(domain, odd)
        # What touches a seam leaves lines and points of it behind.
        parts = shapely.get_parts(shapely.simplify(inside, tolerance, preserve_topology=True))
        return shapely.multipolygons(parts[shapely.get_dimensions(parts) == 2])

    def onto_borders(self, places: Floats) -> Floats:
        """(k,2) the places of borders of the only region that are nearest to places (k,2) close to them, as far from
        seams as these are."""
        import shapely

        scaled, own = self._scaled, np.flatnonzero(self.side != 0)
        tree = shapely.STRtree(shapely.linestrings(scaled[own][:, [0, 3]]))
        part = (places - self.start[0]) / self.size[0]
        best, result = np.full(len(part), np.inf), places.copy()
        first, last = (rounds[0].tolist() for rounds in self._rounds)
        for i in range(first[0], last[0] + 1):
            for j in range(first[1], last[1] + 1):
                q = part + np.array([i, j])
                (_, near), far = tree.query_nearest(shapely.points(q), return_distance=True, all_matches=False)
                t, _ = _nearest(scaled[own[near]], q)
                closer = far < best
                found = bezier_points(self.control[own[near]], t) - np.array([i, j]) * self.size[0]
                result[closer], best[closer] = found[closer], far[closer]
        return result

    @cached_property
    def borders(self) -> RegionBorders:
        """The pieces that are borders, in the order in which they run."""
        border = self.side != 0
        order, sizes, rounds = [np.zeros(0, dtype=np.intp)], list[int](), [np.zeros((0, 2))]
        for first, last in self._loop_ends.tolist():
            own = border[first:last]
            gap = int(np.argmin(own))
            own = np.roll(own, -gap)
            begin, end = (np.flatnonzero(np.diff(own.astype(np.int8), append=0, prepend=0) == way) for way in (1, -1))
            for a, b in zip(begin.tolist(), end.tolist(), strict=True):
                pieces = first + (np.arange(a, b) + gap) % (last - first)
                order.append(pieces)
                sizes.append(b - a)
                rounds.append((self.control[pieces[-1:], 3] - self.control[pieces[:1], 0]) / self.size[self.of[first]])
        pieces, gone = np.concatenate(order), np.concatenate(rounds)
        turns = np.round(gone).astype(np.intp)
        region = self.of[pieces[ragged.starts(sizes)]] if sizes else np.zeros(0, dtype=np.intp)
        back = (np.abs(gone - turns) <= ON_TRIM).all(axis=1) & ((turns == 0) | self.closed[region]).all(axis=1)
        return RegionBorders(self.control[pieces], ragged.offsets(sizes), back, turns)

    @cached_property
    def _loop_ends(self) -> Ints:
        """(l,2) the first piece of each curve, and the one behind its last."""
        first = np.flatnonzero(np.diff(self.loop, prepend=-1))
        return np.stack([first, np.append(first[1:], len(self.loop))], axis=1)

    @cached_property
    def _scaled(self) -> Floats:
        """(p,4,2) the pieces in parts of the domains."""
        return (self.control - self.start[self.of, None]) / self.size[self.of, None]

    @cached_property
    def _boxes(self) -> tuple[Floats, Floats]:
        """(p,2) lowest and highest corners of the boxes around pieces, which bend within the boxes of their ends."""
        ends = self._scaled[:, [0, 3]]
        return ends.min(axis=1), ends.max(axis=1)

    @cached_property
    def _rounds(self) -> tuple[Ints, Ints]:
        """(r,2) each: the first and the last whole round further on to which a place within the domain may belong."""
        low, high = np.zeros((len(self), 2)), np.zeros((len(self), 2))
        np.minimum.at(low, self.of, self._boxes[0])
        np.maximum.at(high, self.of, self._boxes[1])
        first, last = np.floor(low - ON_TRIM), np.maximum(np.ceil(high + ON_TRIM) - 1.0, 0.0)
        begin, end = (np.where(self.closed, ends, 0.0).astype(np.intp) for ends in (first, last))
        return begin, end

    @cached_property
    def _strips(self) -> tuple[Floats, Floats, Ints, Ints, Ints]:
        """Strips across v of each region: where the first one begins (r,), how many there are in a unit (r,), the
        number (r+1,) of the first one among all, the pieces in strips, and the offsets of these."""
        low, high = (corner[:, 1] for corner in self._boxes)
        low, high = low - 2.0 * ON_TRIM, high + 2.0 * ON_TRIM
        begin, end = np.full(len(self), np.inf), np.full(len(self), -np.inf)
        np.minimum.at(begin, self.of, low)
        np.maximum.at(end, self.of, high)
        begin, end = np.where(begin > end, 0.0, begin), np.where(begin > end, 1.0, end)
        count = np.clip(np.bincount(self.of, minlength=len(self)), 1, MOST_ROWS)
        density, first = count / (end - begin), ragged.offsets(count)
        rows = [
            np.clip(((at - begin[self.of]) * density[self.of]).astype(np.intp), 0, count[self.of] - 1)
            for at in (low, high)
        ]
        sizes = rows[1] - rows[0] + 1
        strip = ragged.ranges(first[self.of] + rows[0], sizes)
        order = np.argsort(strip, kind="stable")
        pieces = np.repeat(np.arange(len(self.of)), sizes)[order]
        return begin, density, first, pieces, ragged.offsets(np.bincount(strip, minlength=int(first[-1])))

    @cached_property
    def _columns(self) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """(p,) each, for columns are taken in a third of the time of rows: where v begins and ends along pieces, and
        the smallest and the largest u and v of them."""
        (left, below), (right, above) = (np.ascontiguousarray(corners.T) for corners in self._boxes)
        begin, end = self._scaled[:, 0, 1], self._scaled[:, 3, 1]
        return np.ascontiguousarray(begin), np.ascontiguousarray(end), left, right, below, above

    def _pairs(self, places: Floats, which: Ints) -> Iterator[_Pairs]:
        """Places (k,2) of regions (k,), in each of the rounds to which they may belong, with those pieces in their
        strips that are not all to the left of them."""
        begin, density, first, pieces, offsets = self._strips
        with np.errstate(invalid="ignore"):
            part = (places - self.start[which]) / self.size[which]
            part = part - np.where(self.closed[which], np.floor(part), 0.0)
        known = np.flatnonzero(np.isfinite(part).all(axis=1))
        least, most = (rounds[which[known]] for rounds in self._rounds)
        across = (most - least + 1)[:, 0]
        many = (most - least + 1).prod(axis=1)
        row, turn = np.repeat(known, many), ragged.place(many)
        across, least = np.repeat(across, many), np.repeat(least, many, axis=0)
        q = part[row] + least + np.stack([turn % across, turn // across], axis=1)
        own = which[row]
        at = (q[:, 1] - begin[own]) * density[own]
        within = np.flatnonzero((at >= 0.0) & (at <= np.diff(first)[own]))
        row, q, own, at = row[within], q[within], own[within], at[within]
        strip = first[own] + np.minimum(at.astype(np.intp), np.diff(first)[own] - 1)
        sizes = offsets[strip + 1] - offsets[strip]
        u, v = np.ascontiguousarray(q.T)
        for a, b in ragged.batches(sizes, AT_ONCE):
            copy = np.repeat(np.arange(a, b), sizes[a:b])
            piece = pieces[ragged.ranges(offsets[strip[a:b]], sizes[a:b])]
            right = np.flatnonzero(u.take(copy) <= self._columns[3].take(piece) + ON_TRIM)
            copy, piece = copy[right], piece[right]
            yield _Pairs(row.take(copy), copy, piece, u.take(copy), v.take(copy))

    def _close(self, pairs: _Pairs) -> tuple[Ints, Ints, Floats]:
        """Rows (m,) and pieces (m,) of pairs no farther apart than ON_TRIM, and where (m,) the pieces are nearest."""
        _, _, left, _, below, above = self._columns
        near = np.flatnonzero(pairs.u >= left.take(pairs.piece) - ON_TRIM)
        v, piece = pairs.v[near], pairs.piece[near]
        near = near[(v >= below.take(piece) - ON_TRIM) & (v <= above.take(piece) + ON_TRIM)]
        piece = pairs.piece[near]
        t, off = _nearest(self._scaled[piece], from_components(pairs.u[near], pairs.v[near]))
        close = off <= ON_TRIM
        return pairs.row[near[close]], piece[close], t[close]

    def _located(self, places: Floats, which: Ints) -> tuple[Bools, Bools]:
        """(k,) whether places (k,2) lie within an odd number of curves, or an even one of filled regions, by how often
        rays to the right pass each curve; and whether they lie on a border.

        A place on a piece that is no border lies within its curve, on whichever side of a seam.
        """
        curves = max(int(self.loop.max(initial=-1)) + 1, 1)
        within, on = [np.zeros(0, dtype=np.intp)], np.zeros(len(places), dtype=np.bool_)
        begin, end, left, _, _, _ = self._columns
        for pairs in self._pairs(places, which):
            passed = np.flatnonzero((begin.take(pairs.piece) <= pairs.v) != (end.take(pairs.piece) <= pairs.v))
            piece, u = pairs.piece[passed], pairs.u[passed]
            open_ = np.flatnonzero(u >= left[piece])
            own = self._scaled[piece[open_]]
            beyond = np.ones(len(passed), dtype=np.bool_)
            beyond[open_] = bezier_points(own, _at_value(own, 1, pairs.v[passed[open_]]))[:, 0] > u[open_]
            passed, piece = passed[beyond], piece[beyond]
            # Each round that a place is in counts by itself.
            key, first, times = np.unique(
                pairs.copy[passed] * curves + self.loop[piece], return_index=True, return_counts=True
            )
            odd = times % 2 == 1
            within.append(pairs.row[passed[first[odd]]] * curves + key[odd] % curves)
            row, piece, _ = self._close(pairs)
            border = self.side[piece] != 0
            on[row[border]] = True
            within.append(row[~border] * curves + self.loop[piece[~border]])
        inside = np.unique(np.concatenate(within)) // curves
        return (np.bincount(inside, minlength=len(places)) % 2 == 1) != self.filled[which], on


@dataclass(frozen=True, eq=False)
class RegionBorders:
    """The borders (m,) of a region: pieces (b,4,2), along each as it runs, and offsets (m+1,) of borders among them;
    closed (m,), and turns (m,2): the rounds of the domain that closed ones run through.

    A place on them is a number: that of a piece, and what part of it is behind the place. The last place of a border is
    the number of its last piece and one; of closed ones numbers beyond begin anew.
    """

    control: Floats
    offsets: Ints
    closed: Bools
    turns: Ints

    @cached_property
    def _border(self) -> Ints:
        """(b,) the border of each piece."""
        return ragged.owner(np.diff(self.offsets))

    def at(self, first: Floats, along: Floats) -> tuple[Floats, Floats]:
        """Places (k,2) that lie so far along (k,) borders from places with the numbers first (k,), and derivatives
        (k,2) by the number. Closed ones run on over seams."""
        number, piece = self._numbers(first + along, first)
        control = self.control[piece]
        border = self._border[piece]
        begin, end = self.offsets[border], self.offsets[border + 1]
        round_ = self.control[end - 1, 3] - self.control[begin, 0]
        gone = np.where((number < first)[:, None], round_, 0.0)
        return bezier_points(control, number - piece) + gone, bezier_tangents(control, number - piece)

    def number(self, first: Floats, along: Floats) -> Floats:
        """(k,) the numbers of these places."""
        return self._numbers(first + along, first)[0]

    def lengths(self, first: Floats, last: Floats) -> Floats:
        """(k,) how far it is along borders from numbers first to last (k,): of closed ones on over the start."""
        border = self._border[np.floor(first).astype(np.intp)]
        return last - first + np.where(last <= first, np.diff(self.offsets)[border], 0)

    def _numbers(self, number: Floats, first: Floats) -> tuple[Floats, Ints]:
        """(k,) numbers within their borders, those of the numbers first (k,), and the pieces that they are on."""
        border = self._border[np.floor(first).astype(np.intp)]
        begin, end = self.offsets[border], self.offsets[border + 1]
        number = number - np.where(self.closed[border] & (number >= end), end - begin, 0)
        return number, np.clip(np.floor(number).astype(np.intp), begin, end - 1)

    @cached_property
    def corners(self) -> Bools:
        """(b,) the pieces at the start of which a border begins, or turns suddenly."""
        start = _unit(self.control[:, 1] - self.control[:, 0])
        end = _unit(self.control[:, 3] - self.control[:, 2])
        result = np.ones(len(self.control), dtype=np.bool_)
        result[1:] = dot(end[:-1], start[1:]) < 1.0 - STRAIGHT_TRIM**2
        result[self.offsets[:-1]] = True
        return result


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Places and pieces to be looked at together: row (m,) of the place, copy (m,) of it in one of its rounds, piece
    (m,), and u and v (m,) in parts of the domain."""

    row: Ints
    copy: Ints
    piece: Ints
    u: Floats
    v: Floats


def _nearest(control: Floats, places: Floats) -> tuple[Floats, Floats]:
    """(m,) where pieces are nearest to places (m,2), which are close to them, and how far they are from these."""
    t = np.full(len(places), 0.5)
    way = control[:, 3] - control[:, 0]
    with np.errstate(all="ignore"):
        t = np.clip(np.nan_to_num(dot(places - control[:, 0], way) / dot(way, way), nan=0.5), 0.0, 1.0)
        for _ in range(SETTLING):
            slope = bezier_tangents(control, t)
            step = dot(places - bezier_points(control, t), slope) / np.maximum(dot(slope, slope), LEAST_DIVISOR)
            t = np.clip(t + step, 0.0, 1.0)
    return t, norm(places - bezier_points(control, t))


def _unit(vectors: Floats) -> Floats:
    """(k,2) of length 1; 0 where they have none."""
    long = norm(vectors)[:, None]
    return np.where(long > 0.0, vectors / np.where(long > 0.0, long, 1.0), 0.0)


# A region of the curves that somebody gives.

ALONG_END = 4.0
"""A piece within so many times ON_TRIM of an end of the domain runs along it."""


def parameter_region(domain: Domain, loops: Sequence[Floats], *, filled: bool) -> ParameterRegions:
    """The part of a domain within an odd number of closed curves, pieces (k,4,2) each; if it is filled, within an even
    one."""
    return parameter_regions([domain], [loops], filled=filled)


def parameter_regions(domains: Sequence[Domain], many: Sequence[Sequence[Floats]], *, filled: bool) -> ParameterRegions:
    """Those of domains (r,) within an odd number of closed curves each, pieces (k,4,2), or within an even one."""
    start = np.array([(domain.u_start, domain.v_start) for domain in domains])
    size = np.array([domain.size for domain in domains])
    closed = np.array([(domain.closed_u, domain.closed_v) for domain in domains])
    every = [loop for loops in many for loop in loops]
    control, piece = monotone(np.concatenate(every))
    loop = ragged.owner([len(one) for one in every])[piece]
    of = ragged.owner([len(loops) for loops in many])[loop]
    for axis in (0, 1):
        for ends in (start, start + size):
            end = ends[of, axis]
            low, high = (some(control[:, [0, 3], axis], axis=1) for some in (np.min, np.max))
            cut = np.flatnonzero(~closed[of, axis] & (low < end) & (high > end))
            t = np.full(len(control), np.inf)
            t[cut] = _at_value(control[cut], axis, end[cut])
            t[(t <= 0.0) | (t >= 1.0)] = np.inf
            control, piece = _divided(control, np.arange(len(control)), t)
            loop, of = loop[piece], of[piece]
    none = np.zeros(len(control), dtype=np.intp)
    return _with_sides(
        ParameterRegions(start, size, closed, np.full(len(domains), filled), control, loop, of, side=none)
    )


def _with_sides(regions: ParameterRegions) -> ParameterRegions:
    """The regions with the sides of their pieces, told beside their middles.

    Curves do not cross: along one of them nothing changes but at ends of the domain, and where pieces lie along a seam
    or such an end, which are straight. So one piece tells for all others of its curve that are within the domain.
    """
    control, closed = regions._scaled, regions.closed[regions.of]
    middle = np.full(len(control), 0.5)
    at, way = bezier_points(control, middle), _unit(bezier_tangents(control, middle))
    aside = BESIDE_TRIM * from_components(-way[:, 1], way[:, 0])
    straight: Bools = any_component(np.asarray((np.abs(control - control[:, :1]) <= ROUNDING_OF_DOMAIN).all(axis=1)))
    inner = (closed | ((at > 0.0) & (at < 1.0))).all(axis=1)
    others = np.flatnonzero(inner & ~straight)
    first = others[np.unique(regions.loop[others], return_index=True)[1]]
    asked = np.concatenate([np.flatnonzero(straight), first])
    of, inside = regions.of[asked], []
    for places in (at[asked] + aside[asked], at[asked] - aside[asked]):
        within = (closed[asked] | ((places >= 0.0) & (places <= 1.0))).all(axis=1)
        inside.append(within & regions._located(regions.start[of] + places * regions.size[of], of)[0])
    told = inside[0].astype(np.intp) - inside[1]
    of_loop = np.zeros(int(regions.loop.max(initial=-1)) + 1, dtype=np.intp)
    of_loop[regions.loop[first]] = told[len(asked) - len(first) :]
    side = np.where(inner, of_loop[regions.loop], 0)
    side[straight] = told[: len(asked) - len(first)]
    ends = control[:, [0, 3]]
    for place in (0.0, 1.0):
        side[((np.abs(ends - place) <= ALONG_END * ON_TRIM).all(axis=1) & ~closed).any(axis=1)] = 0
    return replace(regions, side=side)


def led_back(name: str, pieces: Floats, domain: Domain) -> Floats:
    """The pieces of a curve, closed: one that ends a whole round of the domain from where it begins is led back along
    the end of the domain to the left of it, and a little beyond that.

    Errors: InputError for a curve that does not close, or runs round more than once or on a surface closed both ways.
    """
    start, size = np.array([domain.u_start, domain.v_start]), np.array(domain.size)
    closed = np.array([domain.closed_u, domain.closed_v])
    gap = (pieces[-1, 3] - pieces[0, 0]) / size
    rounds = np.where(closed, np.round(gap), 0.0)
    if np.abs(gap - rounds).max() > ON_TRIM:
        begins, ends = (f"{u:g} {v:g}" for u, v in (pieces[0, 0], pieces[-1, 3]))
        raise InputError(f"{name}: a curve that does not close: it begins at {begins} and ends at {ends}")
    if not rounds.any():
        result = pieces.copy()
        result[-1, 3] = result[0, 0]
        return result
    axis = int(np.argmax(np.abs(rounds)))
    if np.abs(rounds).sum() != 1.0 or closed[1 - axis]:
        raise InputError(f"{name}: a curve that runs round has to do so once, on a surface that closes only that way")
    across, values = 1 - axis, pieces[:, :, 1 - axis]
    # To the left: towards larger v where it runs along u, towards smaller u where it runs along v.
    if rounds[axis] * (1.0 if axis == 0 else -1.0) > 0.0:
        far = max(start[across] + size[across], float(values.max())) + BEYOND * size[across]
    else:
        far = min(start[across], float(values.min())) - BEYOND * size[across]
    corners = np.array([pieces[-1, 3], pieces[-1, 3], pieces[0, 0], pieces[0, 0]])
    corners[1:3, across] = far
    return np.concatenate([pieces, _straight(corners[:-1], corners[1:])])


def near_middle(pieces: Floats, domain: Domain, periods: Domain) -> Floats:
    """The pieces of a curve, moved by whole rounds of a domain, in the directions in which that is closed, so that
    their middle is near to that of another domain."""
    low, high = bounds_of_loops([pieces])
    away = 0.5 * (low + high) - (np.array([domain.u_start, domain.v_start]) + 0.5 * np.array(domain.size))
    rounds = np.where([periods.closed_u, periods.closed_v], np.round(away / periods.size), 0.0)
    return pieces - rounds * periods.size


BEYOND = 0.5
"""Part of the domain beyond its end at which curves that run round are closed."""


def check_apart(loops: Sequence[Floats], domain: Domain) -> None:
    """Errors: InputError where curves, pieces (k,4,2) each, cross or touch others, or themselves, also over the seams
    of a domain, near to the middle of which they are."""
    import shapely

    every, sizes = list(loops), np.array(domain.size)
    middle = np.array([domain.u_start, domain.v_start]) + 0.5 * sizes
    for axis in np.flatnonzero([domain.closed_u, domain.closed_v]):
        for loop in tuple(every):
            if loop[:, :, axis].max() > middle[axis] + 0.5 * sizes[axis]:
                every.append(loop - sizes * (np.arange(2) == axis))
    low, high = bounds_of_loops(every)
    scaled = (np.concatenate(every) - low) / np.where(high > low, high - low, 1.0)
    points, offsets = flattened(scaled, ragged.offsets([len(one) for one in every]), TRIMS_APART)
    lines = shapely.linestrings(points, indices=ragged.owner(np.diff(offsets)))
    if not shapely.is_simple(shapely.multilinestrings(lines)):
        raise InputError("the curves of trims and holes must not cross or touch each other or themselves")
