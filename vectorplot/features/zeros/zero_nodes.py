"""Where a curve f(u, v) = 0 crosses itself, touches itself or is a point: f and its gradient are both zero."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.scalar_field import ScalarFields, moved, number
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import symmetric_eigen
from vectorplot.geometry.components import all_finite, component_sum
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.repair.weld import close_points
from vectorplot.tolerances.of_lengths import NODE_SETTLED_OF_CELL
from vectorplot.tolerances.of_parameters import ON_BORDER_OF_DOMAIN
from vectorplot.tolerances.of_values import FLAT_NODE, STEEP_DIRECTION

NODE_RADIUS = 2.0
"""Smallest cells around a node in which its branches are replaced by straight pieces to the node."""

WIDEST = 12.0
"""Smallest cells that the radius of a node grows to where its branches enclose a small angle: between them, nearer to
the node, there are too few lattice points to tell them apart."""

BENT = 0.1
"""Part of the curvature at the start of a search below which that at its end shows a node of more than two branches."""

MOST_ALONE = 16
"""More flat double points of one function than this are a line of them."""


MANY_IN_STRIPS = 8
"""So many points in each strip along one direction, and it is seen whether there are fewer along the other."""


@dataclass(frozen=True, eq=False)
class DoublePoints:
    """points (k,3) where f and its gradient vanish; flat (k,): f has no curvature in some direction there, as along a
    line where f touches zero, or in a cusp. radii (k,): smallest cells within which branches are not told apart.
    ovals (o,3): middles of closed branches smaller than a cell."""

    points: Floats
    flat: Bools
    radii: Floats
    ovals: Floats


def double_points(field: ScalarFields, starts: Floats, cell: Floats, zero: Floats, noise: Floats) -> DoublePoints:
    """The double points near starts (k,3), found by Newton on the gradient.

    cell (s,2) is the size of the cells of each domain that the starts are the middles of; values up to zero (s,) count
    as zero; points around which values up to noise (s,) fill a whole sector lie in or at an area where f is zero, and
    are none.
    """
    if not len(starts):
        none = np.zeros(0)
        return DoublePoints(starts, none > 0.0, none, starts)
    points, curvature, bent = _critical(field, starts, cell)
    of = number(starts)
    zero = zero[of]
    away = np.abs((points - starts)[:, :2] / cell[of]).max(axis=1, initial=0.0)
    with np.errstate(invalid="ignore"):
        w, least = field.values(points), np.abs(curvature).min(axis=1)
        good = (away <= 3.0) & (np.abs(w) <= zero) & np.isfinite(curvature).all(axis=1)
        # A hollow that dips below zero, or a hill that rises above it, within less than a cell.
        dips = (curvature * w[:, None] < 0.0).all(axis=1) & (2.0 * np.abs(w) < least)
    ovals = points[(away <= 3.0) & (np.abs(w) > zero) & dips]
    good &= ~_in_area(field, points, cell, noise)
    points, curvature, bent = points[good], curvature[good], bent[good]
    size = np.sort(np.abs(curvature), axis=1)
    flat = size[:, 0] <= FLAT_NODE * size[:, 1]
    many = (size[:, 1] <= BENT * bent) & ~flat
    in_line = in_crowds(number(points), flat)
    kept = _singled(field, points, cell, flat | many, in_line)
    return DoublePoints(points[kept], np.asarray(flat[kept], dtype=np.bool_), _radii(curvature[kept]), ovals)


def in_crowds(of: Ints, some: Bools) -> Bools:
    """(k,) whether the function with this number has more than MOST_ALONE of what is marked among them (k,)."""
    return np.asarray((np.bincount(of[some], minlength=int(of.max(initial=0)) + 1) > MOST_ALONE)[of], dtype=np.bool_)


def _singled(field: ScalarFields, points: Floats, cell: Floats, slow: Bools, line: Bools) -> Ints:
    """Positions of points (k,3), one of each; along a line of flat ones many."""
    first = _apart(field, points, cell, 0.05)
    # Newton comes to a flat point, and to one of many branches, slowly and from several sides.
    slow = (slow & ~line)[first]
    kept = first[slow][_apart(field, points[first[slow]], cell, 1.0)]
    return np.sort(np.concatenate([first[~slow], kept]))


def _radii(curvature: Floats) -> Floats:
    """(k,) cells around nodes of principal curvatures (k,2) within which two branches are not told apart."""
    size = np.sort(np.abs(curvature), axis=1)
    crossing = (curvature[:, 0] * curvature[:, 1] < 0.0) & (size[:, 0] > FLAT_NODE * size[:, 1])
    # Half the angle between the branches has the tangent sqrt(size0 / size1) or its inverse.
    with np.errstate(invalid="ignore", divide="ignore"):
        sine = np.sqrt(size[:, 0] / (size[:, 0] + size[:, 1]))
        radii = np.clip(1.0 / sine, NODE_RADIUS, WIDEST)
    return np.where(crossing, radii, NODE_RADIUS)


def _apart(field: ScalarFields, points: Floats, cell: Floats, cells: float) -> Ints:
    """Positions of points that are further apart than a number of cells: the first of each cluster."""
    of = number(points)
    # Those of different functions are farther apart than any number of cells that is asked for.
    at = np.concatenate([_around(field, points) / cell[of], 4.0 * of[:, None]], axis=1)
    return np.unique(close_points(at, cells), return_index=True)[1]


def _in_area(field: ScalarFields, points: Floats, cell: Floats, noise: Floats) -> Bools:
    """(k,) whether f is zero in three or more of eight places around points; off the axes, where nodes have zeros."""
    angle, of = 0.4142 + np.arange(8) * np.pi / 4.0, number(points)
    steps = np.stack([np.cos(angle), np.sin(angle)], axis=1) * cell[of, None]
    ring = moved(np.repeat(points[:, None], 8, axis=1), steps)
    w = field.values(ring.reshape(-1, 3)).reshape(-1, 8)
    return np.asarray((np.abs(w) <= noise[of, None]).sum(axis=1) >= 3, dtype=np.bool_)


def _around(field: ScalarFields, points: Floats) -> Floats:
    """(k,2) the parameters of points from the start of their domains, those at the end of a closed direction at its
    start."""
    of = number(points)
    at, size = field.wrapped(points)[:, :2] - field.start[of], field.size[of]
    for axis in (0, 1):
        if field.closed[axis]:
            at[:, axis] = np.where(at[:, axis] > size[:, axis] * (1.0 - ON_BORDER_OF_DOMAIN), 0.0, at[:, axis])
    return at


def _critical(field: ScalarFields, starts: Floats, cell: Floats) -> tuple[Floats, Floats, Floats]:
    """Points where the gradient vanishes, the two principal curvatures of f there, and the larger one at the starts,
    all in units of cells."""
    points, curvature = starts.copy(), np.full((len(starts), 2), np.nan)
    bent, of = np.full(len(starts), np.nan), number(starts)
    low, high = np.where(field.closed, -np.inf, field.low), np.where(field.closed, np.inf, field.high)
    active = np.arange(len(starts))
    for _ in range(60):
        if not len(active):
            break
        own = cell[of[active]]
        g = field.gradients(points[active]) * own
        h = field.hessians(points[active]) * (own[:, :, None] * own[:, None, :])
        sound = all_finite(g) & np.isfinite(h).all(axis=(1, 2))
        active, g, h = active[sound], g[sound], h[sound]
        bend, axes = symmetric_eigen(h)
        curvature[active] = bend
        bent[active] = np.where(np.isnan(bent[active]), np.abs(bend).max(axis=1, initial=0.0), bent[active])
        # Along a flat direction there is nothing to solve for, and the difference quotients are noise.
        steep = np.abs(bend) > STEEP_DIRECTION * np.abs(bend).max(axis=1, initial=0.0)[:, None]
        along = np.einsum("kji,kj->ki", axes, g)
        step = -np.einsum("kij,kj->ki", axes, np.where(steep, along / np.where(steep, bend, 1.0), 0.0))
        length = np.sqrt((step * step).sum(axis=1))
        step /= np.maximum(length, 1.0)[:, None]
        own, whose = cell[of[active]], of[active]
        points[active, :2] = np.clip(points[active, :2] + step * own, low[whose], high[whose])
        strayed = np.abs((points[active] - starts[active])[:, :2] / own).max(axis=1, initial=0.0) > 4.0
        active = active[(length > NODE_SETTLED_OF_CELL) & ~strayed]
    return points, curvature, bent


@dataclass(frozen=True, eq=False)
class Joined:
    """points (p,3) and segments (q,2) of a curve whose branches meet in nodes; meets (k,): how many branches end at
    each double point; around (r,): the double point within whose reach each of the points before lay, or -1."""

    points: Floats
    segments: Ints
    meets: Ints
    around: Ints


def joined_at_nodes(field: ScalarFields, points: Floats, segments: Ints, nodes: Floats, reach: Floats) -> Joined:
    """The curve with its branches led through nodes (k,3): what lies within reach (k,2) of one is dropped, and the
    ends left over are joined to the node.

    Ends that are opposite in the cyclic order around a node are joined to each other, so that branches go straight on.
    """
    if not len(nodes):
        return Joined(points, segments, np.zeros(0, dtype=np.intp), np.full(len(points), -1))
    inside = _node_around(field, points, nodes, reach)
    at_node = inside[segments]
    broken = (at_node[:, 0] < 0) != (at_node[:, 1] < 0)
    outer = np.where(at_node[broken, 0] < 0, 0, 1)
    row = np.arange(len(outer))
    end, node = segments[broken][row, outer], at_node[broken][row, 1 - outer]
    d = _difference(field, points[end], nodes[node]) / reach[node]
    order = np.lexsort((arctan2(d[:, 1], d[:, 0]), node))
    end, node, outer = end[order], node[order], outer[order]
    meets = np.bincount(node, minlength=len(nodes))
    rank = np.arange(len(node)) - ragged.starts(meets)[node]
    # Each pair of opposite ends has a copy of the node to itself.
    copies = (meets + 1) // 2
    copy = len(points) + ragged.starts(copies)[node] + rank % np.maximum(copies[node], 1)
    new = np.where((outer == 0)[:, None], np.stack([end, copy], axis=1), np.stack([copy, end], axis=1))
    kept = segments[(at_node < 0).all(axis=1)]
    return Joined(
        np.concatenate([points, np.repeat(nodes, copies, axis=0)]),
        np.concatenate([kept, new]),
        np.asarray(meets),
        inside,
    )


def _node_around(field: ScalarFields, points: Floats, nodes: Floats, reach: Floats) -> Ints:
    """(p,) the node within whose reach a point lies, the last of several, or -1."""
    inside = np.full(len(points), -1)
    node, point = within(field, points, nodes, reach)
    np.maximum.at(inside, point, node)
    return inside


def within(field: ScalarFields, points: Floats, centres: Floats, reach: Floats) -> tuple[Ints, Ints]:
    """Pairs of a centre (k,3) and a point (p,3) in the ellipse about it with the half axes reach (k,2), seams or
    not."""
    if not len(centres) or not len(points):
        return np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp)
    strips = _strips(field, points, centres, reach, 0)
    if strips.pairs > MANY_IN_STRIPS * (len(points) + len(centres)):
        # Points of a line along which u stays are all in each other's strips.
        strips = min(strips, _strips(field, points, centres, reach, 1), key=lambda each: each.pairs)
    centre, point = strips.found()
    d = _difference(field, points[point], centres[centre]) / reach[centre]
    near = component_sum(d * d) <= 1.0
    return centre[near], point[near]


@dataclass(frozen=True, eq=False)
class _Strips:
    """Strips about centres, and, in a closed direction, about these a turn further: in order (p,), from first to last
    (t,k), the points that are in them."""

    order: Ints
    first: Ints
    last: Ints

    @property
    def pairs(self) -> int:
        """How many pairs of a centre and a point there are."""
        return int((self.last - self.first).sum())

    def found(self) -> tuple[Ints, Ints]:
        """The pairs."""
        count = (self.last - self.first).ravel()
        strip = ragged.owner(count)
        return strip % self.first.shape[1], self.order[ragged.place(count) + self.first.ravel()[strip]]


def _strips(field: ScalarFields, points: Floats, centres: Floats, reach: Floats, axis: int) -> _Strips:
    """The strips in which parameters of an axis are within reach (k,2) of those of centres."""
    of, at = number(centres), _sort_keys(number(points), field.wrapped(points)[:, axis])
    order = np.argsort(at, kind="stable")
    at = at[order]
    ends = np.searchsorted(at.real, of, side="right")
    turns = np.array([-1.0, 0.0, 1.0] if field.closed[axis] else [0.0])[:, None] * field.size[of, axis]
    first, last = (
        np.stack([np.searchsorted(at, _sort_keys(of, x)) for x in field.wrapped(centres)[:, axis] + side + turns])
        for side in (-reach[:, axis], reach[:, axis])
    )
    # One place more: the bounds are rounded.
    return _Strips(order, first, np.maximum(np.minimum(last + 1, ends), first))


def _sort_keys(of: Ints, x: Floats) -> NDArray[np.complex128]:
    """(k,) keys that sort by the numbers of (k,), and those of one number by x (k,)."""
    keys = np.zeros(len(x), dtype=np.complex128)
    keys.real, keys.imag = of, x
    return keys


def without_points_near(field: ScalarFields, centres: Floats, points: Floats, reach: Floats) -> Bools:
    """(k,) centres (k,3) with none of the points (p,3) in the ellipse with the half axes reach (k,2)."""
    free = np.ones(len(centres), dtype=np.bool_)
    free[within(field, points, centres, reach)[0]] = False
    return free


def _difference(field: ScalarFields, points: Floats, origin: Floats) -> Floats:
    """(k,2) points minus origin, the short way round in closed directions."""
    d, size = (points - origin)[:, :2], field.size[number(origin)]
    return np.asarray(d - np.where(field.closed, np.round(d / size), 0.0) * size)
