"""Segments of curves f = 0 joined to branches, through double points and up to borders and holes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.scalar_field import ScalarFields, number
from vectorplot.features.zeros.sizes_of_values import sizes_of_zeros
from vectorplot.features.zeros.zero_cells import Subdivision
from vectorplot.features.zeros.zero_nodes import double_points, in_crowds, joined_at_nodes, within, without_points_near
from vectorplot.features.zeros.zero_refinement import of_lines, up_to_holes, without_repeats
from vectorplot.features.zeros.zero_segments import Segments
from vectorplot.geometry import ragged
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.components import all_components
from vectorplot.geometry.outline import concat
from vectorplot.geometry.polylines import closed_round
from vectorplot.tolerances.of_parameters import ON_BORDER_OF_DOMAIN, ROUNDING_OF_DOMAIN
from vectorplot.tolerances.of_values import GRID_NOISE, NODE_OF_VALUES

FAR_APART = 32.0
"""Smallest cells beyond which what looks like a part of one line belongs to another."""


@dataclass(frozen=True, eq=False)
class FoundBranches:
    """The curves before their chords are looked at: polylines, those of one function after those of another; the double
    points of ZeroManifold; and as points (k,3), the changes of sign that are no zeros, closed branches that are smaller
    than a cell, and the places that touch where two branches cannot be told apart."""

    lines: Traces
    nodes: Floats
    isolated: Floats
    touching: Floats
    poles: Ints
    missed: Floats
    beads: Floats

    def counts(self, count: int) -> Ints:
        """(count, 4) of each function: the changes of sign, the small branches, these places, and all that touch."""
        sorts = (self.missed, self.beads, self.touching)
        each = (np.bincount(number(points), minlength=count) for points in sorts)
        return np.stack([self.poles, *each], axis=1)


def found_branches(subdivision: Subdivision, traced: Segments, scale: Floats) -> FoundBranches:
    """The segments joined to polylines, through the double points among the odd cells."""
    lattice, odd = subdivision.lattice, subdivision.odd
    field, cell = lattice.field, lattice.cell()
    u, v = (field.start[odd.of, axis] + (at + 0.5) * cell[odd.of, axis] for axis, at in enumerate((odd.i, odd.j)))
    zero = np.maximum(NODE_OF_VALUES * scale, sizes_of_zeros(field, scale))
    doubles = double_points(field, np.stack([u, v, odd.of], axis=1), cell, zero, GRID_NOISE * scale)
    line = doubles.flat & in_crowds(number(doubles.points), doubles.flat)
    single, touching = doubles.points[~line], doubles.points[line]
    own = cell[number(single)]
    joined = joined_at_nodes(field, traced.points, traced.pairs, single, doubles.radii[~line, None] * own)
    lines, dots = without_repeats(_polylines(field, joined.points, joined.segments), field.size)
    lines, beads = _without_beads(field, lines, cell, touching)
    # A point beside a curve, or one of a line that goes over into a curve, is not alone; what went round it and shrank
    # to it does not count.
    apart = np.where(doubles.flat[~line], FAR_APART, 3.0)[:, None] * own
    near, point = within(field, traced.points, single, apart)
    alone = joined.meets == 0
    alone[near[joined.around[point] != near]] = False

    def free(centres: Floats, points: Floats, cells: float) -> Floats:
        return centres[without_points_near(field, centres, points, cells * cell[number(centres)])]

    dots = field.wrapped(free(dots, doubles.points, 2.0))
    dotted = in_crowds(number(dots), np.ones(len(dots), dtype=np.bool_))
    return FoundBranches(
        lines,
        single[joined.meets > 0],
        np.concatenate([single[alone], dots[~dotted]]),
        np.concatenate([free(touching, lines.points, 1.5), dots[dotted], beads]),
        traced.poles,
        free(doubles.ovals, traced.points, 2.0),
        beads,
    )


def _without_beads(field: ScalarFields, lines: Traces, cell: Floats, touching: Floats) -> tuple[Traces, Floats]:
    """The polylines without the closed ones that are thinner than a cell (s,2) and stand in a row, or have no area
    where many are that thin or f touches zero in many places touching (t,3); and the middles (k,3) of these: they are
    what lattice points between two branches that cannot be told apart make of them."""
    first, last = lines.starts, lines.ends
    p, whose = lines.points, of_lines(lines)
    counted = np.concatenate([whose, number(touching)])
    many = in_crowds(counted, np.ones(len(counted), dtype=np.bool_))[: len(whose)]
    if not many.any():
        return lines, p[:0]
    path = ragged.owner(last - first + 1)
    q = (p - p[first[path]])[:, :2] / cell[whose[path]]
    step = np.diff(q, axis=0)
    inner = ~lines.last[:-1]
    turn = q[:-1, 0] * q[1:, 1] - q[1:, 0] * q[:-1, 1]
    area, length = (
        np.abs(np.bincount(path[:-1][inner], weights=x[inner], minlength=len(first)))
        for x in (0.5 * turn, np.sqrt((step * step).sum(axis=1)))
    )
    back = np.abs(p[last] - p[first])[:, :2] / field.size[whose]
    is_thin = (back <= ROUNDING_OF_DOMAIN).all(axis=1) & (2.0 * area < length) & (last - first > 1)
    thin = np.flatnonzero(is_thin & many)
    sums = [np.bincount(path, weights=x, minlength=len(first))[thin] for x in p.T[:2]]
    middles = np.stack([*(total / (last - first + 1)[thin] for total in sums), whose[thin]], axis=1)
    middles = field.wrapped(middles)
    near = within(field, middles, middles, FAR_APART * cell[whose[thin]])[0]
    crowded = (np.bincount(near, minlength=len(thin)) > 1) | (area[thin] < 1.0)
    counted = np.concatenate([whose[thin], number(touching)])
    marked = np.concatenate([crowded, np.ones(len(touching), dtype=np.bool_)])
    crowded &= in_crowds(counted, marked)[: len(thin)]
    gone = np.zeros(len(first), dtype=np.bool_)
    gone[thin[crowded]] = True
    return lines.some(~gone[path]), middles[crowded]


def _polylines(field: ScalarFields, points: Floats, segments: Ints) -> Traces:
    """The segments joined to polylines whose parameters run on over seams, those of one function after those of
    another; closed ones repeat their first point."""
    branches = concat(segments)
    rounds = closed_round(branches)
    along = points[branches.points[rounds.index]]
    order, offsets = ragged.take(rounds.offsets, np.argsort(number(along[rounds.offsets[:-1]]), kind="stable"))
    run_on = along[order]
    path = ragged.owner(np.diff(offsets))
    for axis in (0, 1):
        if field.closed[axis] and len(run_on):
            x, size = run_on[:, axis], field.size[number(run_on), axis]
            jump = np.concatenate([[0.0], -np.round(np.diff(x) / size[1:])])
            jump[offsets[:-1]] = 0.0
            turned = np.cumsum(jump)
            run_on[:, axis] = x + (turned - turned[offsets[path]]) * size
    last = np.zeros(len(run_on), dtype=np.bool_)
    last[offsets[1:] - 1] = True
    return Traces(run_on, last)


def led_to_holes(field: ScalarFields, lines: Traces, holes: Bools, cell: Floats, zero: Floats) -> Traces:
    """The polylines with open ends inside the domain led on to the border of the hole there; holes (s,): which
    functions have any."""
    p, starts, lasts = lines.points, lines.starts, lines.ends
    # The last point of a polyline before the first one of the next: so they are put in.
    end, before = np.concatenate([lasts, starts]), np.concatenate([lasts - 1, starts + 1])
    free = np.tile(~ends_meet(field, p[starts], p[lasts]) & holes[of_lines(lines)], 2) & ~_on_border(field, p[end])
    after = np.repeat([1, 0], len(starts))[free]
    end, before = end[free], before[free]
    more, goes = up_to_holes(field, p[end], p[before], cell[number(p[end])], zero)
    at = end[goes]
    return Traces(np.insert(p, at + after[goes], more[goes], axis=0), np.insert(lines.last, at, False))


def _on_border(field: ScalarFields, points: Floats) -> Bools:
    """(k,) points on an open border of the domain."""
    of = number(points)
    part = (points[:, :2] - field.start[of]) / field.size[of]
    return np.asarray(
        ((np.abs(part - 0.5) >= 0.5 - ON_BORDER_OF_DOMAIN) & ~np.array(field.closed)).any(axis=1), dtype=np.bool_
    )


def ends_meet(field: ScalarFields, first: Floats, last: Floats) -> Bools:
    """(b,) polylines that end where they start, whole periods aside."""
    turned = (last - first)[:, :2] / field.size[number(first)]
    return np.asarray(
        all_components(np.abs(turned - np.where(field.closed, np.round(turned), 0.0)) <= ROUNDING_OF_DOMAIN)
    )
