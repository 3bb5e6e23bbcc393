"""Triangles cut along lines on which normals turn over, as on cuspidal edges: one across shows the shade of neither."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.conforming_triangles import divided
from vectorplot.features.edge_splitting import Between, Net, Vertices
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.triangles.triangle_edges import edges_of

HALVINGS = 40
"""How often the part of a side on which the normal turns over is halved."""


def cut_where_normals_jump(net: Net, between: Between) -> tuple[Net, Bools]:
    """The net with its triangles cut where the normals at both ends of a side are more than a right angle apart, and
    (v,) which vertices are new: on the line, with the normal of one side of it.

    Sides whose normals only turn so far are cut too, in the middle of the turn.
    Degenerate: sides with an end that has no normal, and those that lead over a hole, stay whole.
    """
    count = len(net.vertices.points)
    edges, sides, uses = edges_of(net.triangles, count)
    start, end = between.ends(net.vertices.some(edges[:, 0]), net.vertices.some(edges[:, 1]))
    with np.errstate(invalid="ignore"):
        which = np.flatnonzero(component_sum(start.normals * end.normals) < 0.0)
    found = _turns(start.some(which), end.some(which), uses[which] == 1, between)
    which, found = which[found.known], found.some(found.known)
    middle = np.full(len(edges), -1, dtype=np.intp)
    middle[which] = count + np.arange(len(which))
    vertices = net.vertices.joined(found)
    triangles, _ = divided(net.triangles, middle[sides], vertices.points)
    return Net(vertices, triangles, net.stopped), np.arange(len(vertices.points)) >= count


def _turns(start: Vertices, end: Vertices, border: Bools, between: Between) -> Vertices:
    """The last vertices on sides with normals less than a right angle from those at the starts."""
    low: Floats = np.zeros(len(start.points))
    high = np.ones(len(low))
    for _ in range(HALVINGS if len(low) else 0):
        t = 0.5 * (low + high)
        with np.errstate(invalid="ignore"):
            before = (between(start, end, t, border).normals * start.normals).sum(axis=1) > 0.0
        low, high = np.where(before, t, low), np.where(before, high, t)
    return between(start, end, low, border)
