"""Curves on surfaces that planes cut or curves trim: traced on the whole surfaces, and cut as these are."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.cut_curve import parts_outside
from vectorplot.features.conditions import Condition
from vectorplot.features.curve_tracing import SurfaceCurves
from vectorplot.features.holes import inside, is_known, wrapped
from vectorplot.geometry import ragged
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.polylines import closed_round, joined, take, with_points
from vectorplot.geometry.vectors import cross, dot, from_components
from vectorplot.surfaces.surface import Domain, Surface, first_jets
from vectorplot.surfaces.trimmed import CutSurface, TrimmedSurface, cuts_of, uncut
from vectorplot.tolerances import BEFORE_CUT, FAMILY_SETTLED

ROUNDS, RENEWED = 8, 4
"""Steps of Newton from a chord to its curve; the one at which slopes are computed anew."""

FARTHEST = 0.5
"""So many lengths of its chord a curve may be away from it."""

HALVINGS = 36
"""Of the way from there to the end."""


def cut_as(surface: Surface, curves: SurfaceCurves, condition: Condition) -> SurfaceCurves:
    """What is left on a surface of curves of the whole one, on which a condition has the value of their level.

    They end where they pass a plane or a trim, down to rounding, at whatever angle. Edge cases: a curve in a plane is
    left, if rounding does not put it behind.
    """
    whole = uncut(surface)
    for cut in cuts_of(surface):
        apart = {name: getattr(curves, name) for name in ("isolated", "nodes", "touching")}
        left = {name: places[is_known(cut, places)] for name, places in apart.items()}
        curves = replace(_cut(whole, cut, curves, condition) if len(curves) else curves, **left)
    return curves


def _cut(
    whole: Surface, cut: CutSurface | TrimmedSurface, curves: SurfaceCurves, condition: Condition
) -> SurfaceCurves:
    """The curves of the whole surface as one of the cuts leaves them."""
    twice = _led_round_twice(curves, whole.domain)
    along = _Along(cut, whole.domain, condition, twice)
    if isinstance(cut, CutSurface):
        parts = parts_outside(along, cut.regions, cut.within, 0.5 * np.arange(2.0 * along.end + 1.0))
    else:
        parts = _parts_within(along, cut)
    first, last = twice.offsets[:-1], twice.offsets[1:] - 1
    # Where one line ends and the next begins there is no curve.
    ends = np.union1d(parts, along.breaks)
    low, high, middle = ends[:-1], ends[1:], 0.5 * (ends[:-1] + ends[1:])
    line = np.searchsorted(first, middle, side="right") - 1
    part = np.searchsorted(parts[:, 0], middle, side="right") - 1
    left = (part >= 0) & (middle < np.append(parts[:, 1], 0.0)[part]) & (middle < last[line])
    left &= is_known(cut, along.places(middle))
    untouched = left & (low == first[line]) & (high == last[line])
    # Of the two rounds of a closed curve each piece is taken that begins in the first one.
    once = ~curves.closed[line] | ((low > first[line]) & (low <= 0.5 * (first + last)[line]))
    some = np.flatnonzero(left & ~untouched & once)
    begin, end = (along.on_surface(middle[some], outer[some]) for outer in (low, high))
    return joined([take(curves, line[untouched]), _pieces(whole, along, line[some], begin, end)])


def _parts_within(along: _Along, cut: TrimmedSurface) -> Floats:
    """(k,2) between which t the curves are within the trims of a surface and in none of its holes, as far as is looked:
    at LOOKS places of each chord, and between any two places where it passes curves that trim the surface."""
    t = np.union1d(np.arange(LOOKS * along.end + 1.0) / LOOKS, _passed(along, cut))
    t = np.unique(np.concatenate([t, 0.5 * (t[:-1] + t[1:])]))
    there = is_known(cut, along.places(t))
    change = np.flatnonzero(there[1:] != there[:-1])

    def goes_on(which: Ints, at: Floats) -> Bools:
        return np.asarray(is_known(cut, along.places(at)) == there[change[which]])

    before, _ = bisected(goes_on, t[change], t[change + 1], HALVINGS)
    ends = np.concatenate([t[:1], before, t[-1:]])
    begins = bool(there[0]) != (np.arange(len(ends) - 1) % 2 == 1)
    return np.stack([ends[:-1][begins], ends[1:][begins]], axis=1)


def _passed(along: _Along, cut: TrimmedSurface) -> Floats:
    """(k,) the t at which chords of curves pass those of the borders of trims, about."""
    import shapely

    assert cut.region is not None
    nodes, domain = from_components(along.curves.u, along.curves.v), along.domain
    chord = np.setdiff1d(np.arange(len(nodes) - 1), along.curves.offsets[1:] - 1)
    start, way = nodes[chord], nodes[chord + 1] - nodes[chord]
    own = cut.region.control[cut.region.side != 0][:, [0, 3]]
    tree, found = shapely.STRtree(shapely.linestrings(own)), [np.zeros(0)]
    home = from_components(*wrapped(domain, *start.T))
    turns = [np.array([i, j]) * domain.size for i in _ROUNDS[domain.closed_u] for j in _ROUNDS[domain.closed_v]]
    for turn in turns:
        base = home + turn
        one, two = tree.query(shapely.linestrings(np.stack([base, base + way], axis=1)))
        across, off = own[two, 1] - own[two, 0], own[two, 0] - base[one]
        with np.errstate(all="ignore"):
            part = cross(off, across) / cross(way[one], across)
        found.append((chord[one] + part)[(part > 0.0) & (part < 1.0)])
    return np.concatenate(found)


_ROUNDS = {False: (0,), True: (-1, 0, 1)}
"""Rounds of a domain, open or closed, in which a chord may pass a border."""

LOOKS = 4
"""Places of a chord of a curve at which is looked whether it is within trims."""


def _led_round_twice(curves: SurfaceCurves, domain: Domain) -> SurfaceCurves:
    """The curves as open ones, parameters running on, closed ones led round twice."""
    rounds = closed_round(curves)
    sizes = np.diff(rounds.offsets)
    more = np.where(curves.closed, sizes - 1, 0)
    where = np.repeat(rounds.offsets[1:], more)
    index = np.insert(rounds.index, where, rounds.index[ragged.ranges(rounds.offsets[:-1] + 1, more)])
    line = ragged.owner(sizes + more)
    # Which round of its curve a point is in.
    place = ragged.place(sizes + more)
    turns = np.where(curves.closed[line], place // np.maximum(sizes - 1, 1)[line], 0)[:, None] * curves.turns[line]
    again = with_points(curves, index, np.arange(len(curves)), ragged.offsets(sizes + more))
    u, v = from_components(again.u, again.v).T + (turns * domain.size).T
    return replace(again, u=u, v=v, closed=np.zeros(len(curves), dtype=np.bool_), turns=np.zeros_like(curves.turns))


def _pieces(whole: Surface, along: _Along, line: Ints, begin: Floats, end: Floats) -> SurfaceCurves:
    """Parts (k,) of lines, from begin to end."""
    inner = np.floor(begin).astype(np.intp) + 1
    sizes = np.maximum(np.ceil(end).astype(np.intp) - inner, 0)
    offsets = ragged.offsets(sizes + 2)
    t = np.empty(int(offsets[-1]))
    own = np.ones(len(t), dtype=np.bool_)
    own[offsets[:-1]], own[offsets[1:] - 1] = False, False
    t[own], t[offsets[:-1]], t[offsets[1:] - 1] = ragged.ranges(inner, sizes), begin, end
    found = with_points(along.curves, t.astype(np.intp), line, offsets)
    places = np.where(own[:, None], from_components(found.u, found.v), along.places(t))
    return replace(
        found,
        u=np.ascontiguousarray(places[:, 0]),
        v=np.ascontiguousarray(places[:, 1]),
        points=whole.points(*inside(along.domain, places)),
        directions=np.full((len(t), 2), np.nan),
    )


@dataclass(frozen=True, eq=False)
class _Along:
    """Open curves one after the other as a single one in space, along which t counts their points."""

    cut: CutSurface | TrimmedSurface
    domain: Domain
    condition: Condition
    curves: SurfaceCurves

    @property
    def start(self) -> float:
        """The first point."""
        return 0.0

    @property
    def end(self) -> float:
        """The last point."""
        return float(len(self.curves.u) - 1)

    @property
    def closed(self) -> bool:
        """False: closed curves are led round."""
        return False

    @property
    def breaks(self) -> Floats:
        """(2 m,) the ends of all curves."""
        offsets = self.curves.offsets
        return np.sort(np.concatenate([offsets[:-1], offsets[1:] - 1])).astype(np.float64)

    def points(self, t: Floats) -> Floats:
        """(...,3) points of the surface that is cut, where it was then."""
        return self.cut.surface.points(*inside(self.domain, self.places(t)))

    def tangents(self, t: Floats) -> Floats:
        """(...,3) vectors along the curves, of no particular length."""
        places, (_, way, _) = self.places(t), self._chords(t)
        u, v = inside(self.domain, places)
        by_u, by_v = self.condition.slopes(u, v)
        size = np.array(self.domain.size)
        ahead = np.sign(by_u * way[:, 1] * size[1] - by_v * way[:, 0] * size[0])
        _, along_u, along_v = first_jets(self.cut.surface, u, v)
        return np.asarray(-(ahead * by_v)[:, None] * along_u + (ahead * by_u)[:, None] * along_v)

    def places(self, t: Floats) -> Floats:
        """(k,2) parameters: from the chord straight across to where the condition has the value of its level."""
        base, way, level = self._chords(t)
        size = np.array(self.domain.size)
        across = from_components(-way[:, 1], way[:, 0])
        off = np.zeros(len(t))
        active = np.flatnonzero(t != np.floor(t))
        slopes = np.empty_like(base)
        for again in range(ROUNDS):
            at = (base[active] + off[active, None] * across[active]) * size
            u, v = inside(self.domain, at)
            if again in (0, RENEWED):
                slopes[active] = from_components(*self.condition.slopes(u, v)) * size
            with np.errstate(all="ignore"):
                step = (self.condition.values(u, v) - level[active]) / dot(slopes[active], across[active])
            step = np.where(np.isfinite(step), step, 0.0)
            off[active] = (off[active] - step).clip(-FARTHEST, FARTHEST)
            active = active[np.abs(step) > FAMILY_SETTLED]
            if not len(active):
                break
        return np.asarray((base + off[:, None] * across) * size)

    def on_surface(self, middle: Floats, ends: Floats) -> Floats:
        """(k,) the last t on the cut surface on the way from the middle to the end of a piece."""
        before = ends + np.clip(middle - ends, -BEFORE_CUT, BEFORE_CUT)
        before = np.where(is_known(self.cut, self.places(before)), before, middle)

        def goes_on(which: Ints, part: Floats) -> np.ndarray:
            return is_known(self.cut, self.places(before[which] + part * (ends - before)[which]))

        at_end = is_known(self.cut, self.places(ends))
        low, _ = bisected(goes_on, np.zeros(len(ends)), np.ones(len(ends)), HALVINGS)
        return np.where(at_end, ends, before + low * (ends - before))

    def _chords(self, t: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,2) places on chords and the ways of these, in parts of the domain, and their levels (k,)."""
        index = np.floor(t).astype(np.intp)
        # The last point of a line ends its last chord.
        index -= np.isin(t, self.curves.offsets[1:] - 1)
        nodes = from_components(self.curves.u, self.curves.v) / np.array(self.domain.size)
        way = nodes[index + 1] - nodes[index]
        level = np.repeat(self.curves.levels, np.diff(self.curves.offsets))[index]
        return nodes[index] + (t - index)[:, None] * way, way, level
