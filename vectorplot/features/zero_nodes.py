"""Where a curve f(u, v) = 0 crosses itself, touches itself or is a point: f and its gradient are both zero."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.features.scalar_field import ScalarField
from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.geometry.weld import close_points

FLAT = 1e-4
"""A curvature of f below this part of the other one counts as zero."""

NODE_RADIUS = 2.0
"""Smallest cells around a node in which its branches are replaced by straight pieces to the node."""

MOST_ALONE = 16
"""More flat double points than this are a line of them."""


@dataclass(frozen=True, eq=False)
class DoublePoints:
    """points (k,2) where f and its gradient vanish; flat (k,): f has no curvature in some direction there, as along a
    line where f touches zero, or in a cusp. ovals (o,2): middles of closed branches smaller than a cell."""

    points: Floats
    flat: Bools
    ovals: Floats


def double_points(field: ScalarField, starts: Floats, cell: Floats, zero: float, noise: float) -> DoublePoints:
    """The double points near starts (k,2), found by Newton on the gradient.

    cell (2,) is the size of the cells that the starts are the middles of; values up to zero count as zero; points
    around which values up to noise fill a whole sector lie in or at an area where f is zero, and are none.
    """
    if not len(starts):
        return DoublePoints(starts, np.zeros(0, dtype=np.bool_), starts)
    points, curvature = _critical(field, starts, cell)
    away = np.abs((points - starts) / cell).max(axis=1, initial=0.0)
    with np.errstate(invalid="ignore"):
        w, least = field.values(points), np.abs(curvature).min(axis=1)
        good = (away <= 3.0) & (np.abs(w) <= zero) & np.isfinite(curvature).all(axis=1)
        # A hollow that dips below zero, or a hill that rises above it, within less than a cell.
        dips = (curvature * w[:, None] < 0.0).all(axis=1) & (2.0 * np.abs(w) < least)
    ovals = points[(away <= 3.0) & (np.abs(w) > zero) & dips]
    points, curvature = points[good], curvature[good]
    good = ~_in_area(field, points, cell, noise)
    points, curvature = points[good], curvature[good]
    if not len(points):
        return DoublePoints(points, np.zeros(0, dtype=np.bool_), ovals)
    first = _apart(field, points, cell, 0.05)
    points, size = points[first], np.sort(np.abs(curvature[first]), axis=1)
    flat = size[:, 0] <= FLAT * size[:, 1]
    if flat.sum() <= MOST_ALONE:
        # Newton comes to a flat point slowly and from several sides.
        kept = np.flatnonzero(flat)[_apart(field, points[flat], cell, 1.0)]
        order = np.sort(np.concatenate([np.flatnonzero(~flat), kept]))
        points, flat = points[order], flat[order]
    return DoublePoints(points, np.asarray(flat, dtype=np.bool_), ovals)


def _apart(field: ScalarField, points: Floats, cell: Floats, cells: float) -> Ints:
    """Positions of points that are further apart than a number of cells: the first of each cluster."""
    group = close_points(np.pad(_around(field, points) / cell, ((0, 0), (0, 1))), cells)
    return np.unique(group, return_index=True)[1]


def _in_area(field: ScalarField, points: Floats, cell: Floats, noise: float) -> Bools:
    """(k,) whether f is zero in three or more of eight places around points; off the axes, where nodes have zeros."""
    angle = 0.4142 + np.arange(8) * np.pi / 4.0
    ring = points[:, None] + np.stack([np.cos(angle), np.sin(angle)], axis=1) * cell
    w = field.values(ring.reshape(-1, 2)).reshape(-1, 8)
    return np.asarray((np.abs(w) <= noise).sum(axis=1) >= 3, dtype=np.bool_)


def _around(field: ScalarField, points: Floats) -> Floats:
    """Points wrapped into the domain, those at the end of a closed direction at its start."""
    at = field.wrapped(points) - field.start
    for axis in (0, 1):
        if field.closed[axis]:
            at[:, axis] = np.where(at[:, axis] > field.size[axis] * (1.0 - 1e-9), 0.0, at[:, axis])
    return at


def _critical(field: ScalarField, starts: Floats, cell: Floats) -> tuple[Floats, Floats]:
    """Points where the gradient vanishes, and the two principal curvatures of f there, all in units of cells."""
    points, curvature = starts.copy(), np.full((len(starts), 2), np.nan)
    active = np.arange(len(starts))
    for _ in range(60):
        if not len(active):
            break
        g = field.gradients(points[active]) * cell
        h = field.hessians(points[active]) * np.outer(cell, cell)
        sound = np.isfinite(g).all(axis=1) & np.isfinite(h).all(axis=(1, 2))
        active, g, h = active[sound], g[sound], h[sound]
        bend, axes = np.linalg.eigh(h)
        curvature[active] = bend
        # Along a flat direction there is nothing to solve for, and the difference quotients are noise.
        steep = np.abs(bend) > 1e-6 * np.abs(bend).max(axis=1, initial=0.0)[:, None]
        along = np.einsum("kji,kj->ki", axes, g)
        step = -np.einsum("kij,kj->ki", axes, np.where(steep, along / np.where(steep, bend, 1.0), 0.0))
        length = np.sqrt((step * step).sum(axis=1))
        step /= np.maximum(length, 1.0)[:, None]
        points[active] = np.clip(
            points[active] + step * cell,
            np.where(field.closed, -np.inf, field.low),
            np.where(field.closed, np.inf, field.high),
        )
        strayed = np.abs((points[active] - starts[active]) / cell).max(axis=1, initial=0.0) > 4.0
        active = active[(length > 1e-9) & ~strayed]
    return points, curvature


@dataclass(frozen=True, eq=False)
class Joined:
    """points (p,2) and segments (s,2) of a curve whose branches meet in nodes; meets (k,): how many branches end at
    each double point."""

    points: Floats
    segments: Ints
    meets: Ints


def joined_at_nodes(field: ScalarField, points: Floats, segments: Ints, nodes: Floats, cell: Floats) -> Joined:
    """The curve with its branches led through nodes (k,2): what lies within NODE_RADIUS of one is dropped, and the
    ends left over are joined to the node.

    Ends that are opposite in the cyclic order around a node are joined to each other, so that branches go straight on.
    """
    if not len(nodes):
        return Joined(points, segments, np.zeros(0, dtype=np.intp))
    inside = _node_around(field, points, nodes, cell)
    at_node = inside[segments]
    broken = (at_node[:, 0] < 0) != (at_node[:, 1] < 0)
    outer = np.where(at_node[broken, 0] < 0, 0, 1)
    row = np.arange(len(outer))
    end, node = segments[broken][row, outer], at_node[broken][row, 1 - outer]
    d = _difference(field, points[end], nodes[node]) / cell
    order = np.lexsort((np.arctan2(d[:, 1], d[:, 0]), node))
    end, node, outer = end[order], node[order], outer[order]
    meets = np.bincount(node, minlength=len(nodes))
    rank = np.arange(len(node)) - (np.cumsum(meets) - meets)[node]
    # Each pair of opposite ends has a copy of the node to itself.
    copies = (meets + 1) // 2
    copy = len(points) + (np.cumsum(copies) - copies)[node] + rank % np.maximum(copies[node], 1)
    new = np.where((outer == 0)[:, None], np.stack([end, copy], axis=1), np.stack([copy, end], axis=1))
    kept = segments[(at_node < 0).all(axis=1)]
    return Joined(
        np.concatenate([points, np.repeat(nodes, copies, axis=0)]), np.concatenate([kept, new]), np.asarray(meets)
    )


def _node_around(field: ScalarField, points: Floats, nodes: Floats, cell: Floats) -> Ints:
    """(p,) the node within whose radius a point lies, or -1."""
    inside = np.full(len(points), -1)
    # Nodes are few; each pass compares one of them with all points.
    for k, node in enumerate(nodes):
        d = _difference(field, points, node) / cell
        inside[(d * d).sum(axis=1) <= NODE_RADIUS**2] = k
    return inside


def _difference(field: ScalarField, points: Floats, origin: Floats) -> Floats:
    """Points minus origin, the short way round in closed directions."""
    d = points - origin
    return np.asarray(d - np.where(field.closed, np.round(d / field.size), 0.0) * field.size)
