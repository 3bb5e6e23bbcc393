"""The triangles around a curve on a mesh, cut finer where their corners leave open what the curve does inside."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.features.level_segments import split_at_middles
from vectorplot.geometry.mesh import Bools, Floats, Ints

REACH = 2.0
"""How often further than a triangle is wide the curve may be for the triangle to be looked at."""

ALIGNED = 0.2
"""Cosine between the slopes at the corners of a triangle and their sum above which the curve is a single arc there."""

LEVELS = 16
"""How often triangles are cut at most."""

MOST_TRIANGLES = 1 << 20
"""Triangles to which a band is cut at most."""


@dataclass(frozen=True, eq=False)
class Nodes:
    """Points with a condition: points (n,3); fixed (n,3): coordinates that stay as they are; values (n,) and slopes
    (n,3) of the condition."""

    points: Floats
    fixed: Bools
    values: Floats
    slopes: Floats

    def joined(self, more: Nodes) -> Nodes:
        """These and more, numbered on."""
        return Nodes(
            np.concatenate([self.points, more.points]),
            np.concatenate([self.fixed, more.fixed]),
            np.concatenate([self.values, more.values]),
            np.concatenate([self.slopes, more.slopes]),
        )

    def chosen(self, which: Ints) -> Nodes:
        """Some of them."""
        return Nodes(self.points[which], self.fixed[which], self.values[which], self.slopes[which])


@dataclass(frozen=True, eq=False)
class Band:
    """Triangles (t,3) of nodes around a curve; source (t,): the one of the mesh each belongs to; open (k,): those that
    leave several arcs possible still, at the finest resolution."""

    nodes: Nodes
    triangles: Ints
    source: Ints
    open: Ints


def curve_band(
    nodes: Nodes,
    triangles: Ints,
    middles: Callable[[Floats, Floats, Bools], Nodes],
    tangential: Callable[[Floats, Ints], Floats],
    *,
    finest: float,
) -> Band:
    """The band of triangles (t,3) that the curve on which values vanish can reach.

    Where slopes at the corners of a triangle point different ways, and values are small enough that they could vanish
    inside, it is cut until its sides are shorter than finest. middles(starts, ends, fixed) makes nodes between the ends
    of sides; tangential(slopes (k,3,3) at corners, source (k,)) are the parts of slopes in the surface.
    """
    source = np.arange(len(triangles))
    reached = _reached(nodes, triangles, tangential(nodes.slopes[triangles], source), REACH)
    triangles, source = triangles[reached], source[reached]
    used, corners = np.unique(triangles, return_inverse=True)
    nodes, triangles = nodes.chosen(used), corners.reshape(-1, 3)
    for level in range(LEVELS + 1):
        slopes = tangential(nodes.slopes[triangles], source)
        unclear = ~_aligned(slopes) | _grazes_border(nodes, triangles, slopes)
        odd = _reached(nodes, triangles, slopes, 1.0) & unclear
        wide = _widths(nodes, triangles) > finest
        if not (odd & wide).any() or len(triangles) > MOST_TRIANGLES or level == LEVELS:
            break
        split = split_at_middles(triangles, odd & wide, len(nodes.points))
        ends = nodes.points[split.low], nodes.points[split.high]
        fixed = nodes.fixed[split.low] & nodes.fixed[split.high]
        nodes = nodes.joined(middles(*ends, fixed))
        triangles, source = split.triangles, source[split.parent]
    return Band(nodes, triangles, source, np.flatnonzero(odd))


def _reached(nodes: Nodes, triangles: Ints, slopes: Floats, factor: float) -> Bools:
    """(t,) triangles in which the values could vanish, by their slopes at the corners; not where they are zero at all
    corners: that is an area."""
    w = nodes.values[triangles]
    steepest = np.sqrt(np.nanmax(np.nan_to_num((slopes * slopes).sum(axis=2)), axis=1))
    near = np.abs(w).min(axis=1) <= factor * steepest * _widths(nodes, triangles)
    changes = (w < 0.0).any(axis=1) & ~(w < 0.0).all(axis=1)
    return np.asarray((near | changes) & ~np.isnan(w).any(axis=1) & (w != 0.0).any(axis=1))


def _aligned(slopes: Floats) -> Bools:
    """(t,) triangles at whose corners the slopes (t,3,3) point much the same way; those without slopes too."""
    total = slopes.sum(axis=1)
    along = np.einsum("tij,tj->ti", slopes, total)
    sizes = np.sqrt((slopes * slopes).sum(axis=2) * (total * total).sum(axis=1)[:, None])
    return np.asarray(((along > ALIGNED * sizes) | np.isnan(along)).all(axis=1))


def _grazes_border(nodes: Nodes, triangles: Ints, slopes: Floats) -> Bools:
    """(t,) triangles with a side on the border along which the values first fall towards zero and then rise: between
    corners of one sign the curve could cross it twice."""
    result = np.zeros(len(triangles), dtype=np.bool_)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        i, j = triangles[:, a], triangles[:, b]
        w0, w1 = nodes.values[i], nodes.values[j]
        along = nodes.points[j] - nodes.points[i]
        from_a, from_b = (slopes[:, a] * along).sum(axis=1) * w0, -(slopes[:, b] * along).sum(axis=1) * w1
        falls = (from_a < 0.0) & (from_b < 0.0) & (w0 * w1 > 0.0)
        # Where both fall less than they are high, the curve through both line elements stays above zero.
        low = (-from_a > w0 * w0) | (-from_b > w1 * w1)
        result |= falls & low & (nodes.fixed[i] & nodes.fixed[j]).any(axis=1)
    return result


def _widths(nodes: Nodes, triangles: Ints) -> Floats:
    """(t,) longest sides."""
    a, b, c = (nodes.points[triangles[:, k]] for k in range(3))
    squares = [((p - q) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))]
    return np.asarray(np.sqrt(np.maximum.reduce(squares)))
