"""Meshes of implicit surfaces, apart along their singular lines, and finer triangles around curves on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit_singular_lines import SingularLines, led_into_lines, singular_lines
from vectorplot.features.mesh_lines import split_at_middles
from vectorplot.features.polygonization import polygonized, settled_from
from vectorplot.geometry import records
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import (
    all_components,
    any_component,
    component_sum,
    greatest_component,
    least_component,
)
from vectorplot.geometry.weld import chained
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances import LEAST_DIVISOR

# Implicit surfaces polygonised up to their singular lines, sheet by sheet.


@dataclass(frozen=True, eq=False)
class ImplicitMesh:
    """An implicit surface as triangles that end on its singular lines.

    mesh: the triangles; on_line: (v,) which vertices are on a singular line; lines: where sheets of the surface cross
    or end; doubts: A sentence where it could not be settled how the surface is connected.
    """

    mesh: Mesh
    on_line: Bools
    lines: SingularLines
    doubts: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class SheetsApart:
    """Triangles (t,3) of nodes; vertex (n,): that of the mesh which a node stands for. One on a singular line has a
    node in every sheet that ends there; inner (n,3): the middle of its neighbours in this sheet; itself for others."""

    triangles: Ints
    vertex: Ints
    inner: Floats


def implicit_mesh(surface: ImplicitSurface, cells: int) -> ImplicitMesh:
    """An implicit surface polygonised up to its singular lines, for several families of curves on it."""
    mesh = polygonized(surface, cells)
    return mesh_with_lines(surface, mesh, singular_lines(surface, mesh), cells)


def mesh_with_lines(surface: ImplicitSurface, mesh: Mesh, lines: SingularLines, cells: int) -> ImplicitMesh:
    """The surface polygonised as a mesh, of so many cells, up to its singular lines. Where it has none the mesh is made
    finer until it is settled how it is connected: with lines it never is, for sheets that cross are joined by chance.
    """
    doubts: tuple[str, ...] = ()
    if not len(lines):
        mesh, doubts = settled_from(surface, mesh, cells)
    led, on_line = led_into_lines(surface, mesh, lines)
    return ImplicitMesh(led, on_line, lines, doubts)


def sheets_apart(mesh: Mesh, on_line: Bools) -> SheetsApart:
    """The triangles of a mesh cut apart along singular lines; on_line (v,): the vertices on them."""
    triangles = mesh.corners.reshape(-1, 3).copy()
    count = len(mesh.vertices)
    row, place = np.nonzero(on_line[triangles])
    vertex = triangles[row, place]
    others = np.stack([triangles[row, (place + k) % 3] for k in (1, 2)], axis=1)
    inside = ~on_line[others]
    # Triangles are in one sheet that share a side from the line into it.
    corner, which = np.nonzero(inside)
    key = vertex[corner] * count + others[corner, which]
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(key[order][1:] == key[order][:-1])
    label = chained(len(row), corner[order[same]], corner[order[same + 1]])
    heads, number = np.unique(label, return_inverse=True)
    triangles[row, place] = count + number
    total, many = np.zeros((len(heads), 3)), np.zeros(len(heads))
    np.add.at(total, number[corner], mesh.vertices[others[corner, which]])
    np.add.at(many, number[corner], 1.0)
    inner = np.concatenate([mesh.vertices, total / np.maximum(many, 1.0)[:, None]])
    return SheetsApart(triangles, np.concatenate([np.arange(count), vertex[heads]]), inner)


# The triangles around a curve on a mesh, cut finer where their corners leave open what the curve does inside.

REACH = 2.0
"""How often further than a triangle is wide the curve may be for the triangle to be looked at."""

ALIGNED = 0.2
"""Cosine between the slopes at the corners of a triangle and their sum above which the curve is a single arc there."""

LEVELS = 16
"""How often triangles are cut at most."""

STUBBORN = 3
"""How often a triangle at a singular point of the surface is cut: there slopes never agree."""


@dataclass(frozen=True, eq=False)
class Nodes(Elements):
    """Points with a condition: points (n,3); fixed (n,3): coordinates that stay as they are; values (n,) and slopes
    (n,3) of the condition; gradients (n,3) of the function whose zeros the surface is.

    on_line (n,): points on singular lines of the surface; what is said of them holds at places (n,3), beside them in
    the sheet that the node is of. Elsewhere these are the points.
    """

    points: Floats
    places: Floats
    on_line: Bools
    fixed: Bools
    values: Floats
    slopes: Floats
    gradients: Floats

    def joined(self, more: Nodes) -> Nodes:
        """These and more, numbered on."""
        return records.joined((self, more))


@dataclass(frozen=True, eq=False)
class Band:
    """Triangles (t,3) of nodes around a curve; source (t,): the one of the mesh each belongs to; open (k,): those that
    leave several arcs possible still, at the finest resolution; singular (s,): those at singular points of the surface,
    where no resolution tells more; complete: whether no more triangles were called for than were allowed."""

    nodes: Nodes
    triangles: Ints
    source: Ints
    open: Ints
    singular: Ints
    complete: bool


def curve_band(
    nodes: Nodes,
    triangles: Ints,
    middles: Callable[[Nodes, Nodes], Nodes],
    tangential: Callable[[Floats, Ints], Floats],
    *,
    finest: float,
    most: int,
) -> Band:
    """The band of triangles (t,3) that the curve of vanishing values can reach. Where slopes at the corners diverge and
    values could vanish inside, a triangle is cut until its sides are below finest, there are more than most, or
    STUBBORN times at a singular point. middles(starts, ends): nodes between; tangential(slopes (k,3,3), source
    (k,)): parts of slopes in the surface.
    """
    source = np.arange(len(triangles))
    reached = _reached(nodes, triangles, tangential(nodes.slopes[triangles], source), REACH)
    triangles, source = triangles[reached], source[reached]
    used, corners = np.unique(triangles, return_inverse=True)
    nodes, triangles = nodes.take(used), corners.reshape(-1, 3)
    stuck = np.zeros(len(triangles), dtype=np.intp)
    complete = True
    for level in range(LEVELS + 1):
        slopes = tangential(nodes.slopes[triangles], source)
        unclear = ~_aligned(slopes) | _grazes_border(nodes, triangles, slopes)
        odd = _reached(nodes, triangles, slopes, 1.0) & unclear
        stuck = np.where(_at_singular_points(nodes, triangles), stuck + 1, 0)
        goes_on = odd & (_widths(nodes, triangles) > finest) & (stuck <= STUBBORN)
        complete = len(triangles) + 3 * int(goes_on.sum()) <= most
        if not goes_on.any() or not complete or level == LEVELS:
            break
        split = split_at_middles(triangles, goes_on, len(nodes.points))
        nodes = nodes.joined(middles(nodes.take(split.low), nodes.take(split.high)))
        triangles, source, stuck = split.triangles, source[split.parent], stuck[split.parent]
    singular = odd & (stuck > STUBBORN)
    # On singular lines that are known curves end, however they come there.
    known = nodes.on_line[triangles].any(axis=1)
    return Band(
        nodes, triangles, source, np.flatnonzero(odd & ~singular & ~known), np.flatnonzero(singular & ~known), complete
    )


def _at_singular_points(nodes: Nodes, triangles: Ints) -> Bools:
    """(t,) triangles at whose corners gradients differ by more than the smallest of them is long: the finer a triangle
    on a regular surface is, the less do they differ; beside a singular point they do on triangles of all sizes. Next to
    a singular line they are of all lengths, and only their directions count."""
    g = nodes.gradients[triangles]
    beside = nodes.on_line[triangles].any(axis=1)
    g[beside] /= np.maximum(np.linalg.norm(g[beside], axis=2, keepdims=True), LEAST_DIVISOR)
    least = least_component(component_sum(g * g))
    apart = g - g[:, [2, 0, 1]]
    return np.asarray(least < greatest_component(component_sum(apart * apart)), dtype=np.bool_)


def _reached(nodes: Nodes, triangles: Ints, slopes: Floats, factor: float) -> Bools:
    """(t,) triangles in which the values could vanish, by their slopes at the corners; not where they are zero at all
    corners: that is an area."""
    w = nodes.values[triangles]
    steepest = np.sqrt(greatest_component(np.nan_to_num(component_sum(slopes * slopes))))
    near = least_component(np.abs(w)) <= factor * steepest * _widths(nodes, triangles)
    changes = any_component(w < 0.0) & ~all_components(w < 0.0)
    return np.asarray((near | changes) & ~any_component(np.isnan(w)) & any_component(w != 0.0))


def _aligned(slopes: Floats) -> Bools:
    """(t,) triangles at whose corners the slopes (t,3,3) point much the same way; those without slopes too."""
    total = slopes[:, 0] + slopes[:, 1] + slopes[:, 2]
    along = np.einsum("tij,tj->ti", slopes, total)
    sizes = np.sqrt(component_sum(slopes * slopes) * component_sum(total * total)[:, None])
    return all_components((along > ALIGNED * sizes) | np.isnan(along))


def _grazes_border(nodes: Nodes, triangles: Ints, slopes: Floats) -> Bools:
    """(t,) triangles with a side on the border along which the values first fall towards zero and then rise: between
    corners of one sign the curve could cross it twice."""
    result = np.zeros(len(triangles), dtype=np.bool_)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        i, j = triangles[:, a], triangles[:, b]
        w0, w1 = nodes.values[i], nodes.values[j]
        along = nodes.points[j] - nodes.points[i]
        from_a, from_b = component_sum(slopes[:, a] * along) * w0, -component_sum(slopes[:, b] * along) * w1
        falls = (from_a < 0.0) & (from_b < 0.0) & (w0 * w1 > 0.0)
        # Where both fall less than they are high, the curve through both line elements stays above zero.
        low = (-from_a > w0 * w0) | (-from_b > w1 * w1)
        result |= falls & low & any_component(nodes.fixed[i] & nodes.fixed[j])
    return result


def _widths(nodes: Nodes, triangles: Ints) -> Floats:
    """(t,) longest sides."""
    a, b, c = (nodes.points[triangles[:, k]] for k in range(3))
    squares = [component_sum((p - q) ** 2) for p, q in ((a, b), (b, c), (c, a))]
    return np.asarray(np.sqrt(np.maximum.reduce(squares)))
