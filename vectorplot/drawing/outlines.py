"""Outlines: closed paths around the covered cells of a page that lines divide."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.regions import insides_of, mosaics, without_splinters
from vectorplot.tolerances import GRID_MM
from vectorplot.words import LineKind

SPLINTER = 0.25
"""Parts and holes are splinters where they are narrower than two tolerances, eight times this part of one: between two
chords, each of which may be off by half of the tolerance, some come to be."""

FEWEST_CORNERS = 3
"""Of a polygon."""

ENDS_ON_GRID = 2.0
"""Points that are moved to the grid are no more of its steps away."""


def outlines(borders: Paths, covered: Callable[[Floats], Bools], tolerance_mm: float, page_from_world: Floats) -> Paths:
    """One closed path around each connected region of the page that is covered, and one around each hole in it.

    Parameters
    ----------
    borders : Paths
        Lines that divide the page into cells, each of which is covered as a whole or not at all; hidden ones too.
    covered : callable
        Which points (n, 2) in mm are covered, (n,) bool.
    tolerance_mm : float
        Chords of smooth lines are no farther off than half of it.
    page_from_world : (4, 4) array of float
        As of Drawing.

    Returns
    -------
    Paths
        Outer ones counter-clockwise, holes clockwise; each of the item that its first part belongs to. Smooth where all
        parts are.

    Notes
    -----
    Error: corners where different lines cross lie within GRID_MM, and where these are smooth within the tolerance.
    Parts and holes that are narrower than two tolerances are left out.

    Edge cases: lines that enclose nothing have no outline.

    Source: de Berg and others, Computational Geometry, section 2.3 (the overlay of two subdivisions).
    """
    import shapely

    if not len(borders):
        return borders
    ends = segments(borders)
    cells = shapely.get_parts(shapely.polygonize(_network(shapely.linestrings(borders.points[ends]), tolerance_mm)))
    if len(cells):
        cells = cells[covered(shapely.get_coordinates(shapely.point_on_surface(cells)))]
    regions = mosaics(cells, np.zeros(len(cells), dtype=np.intp))
    parts, _ = without_splinters(insides_of(regions), SPLINTER * tolerance_mm)
    return _around(parts, borders, ends, page_from_world) if len(parts) else Paths.empty()


def _network(chords: Any, tolerance_mm: float) -> Any:
    """Lines between the nodes at which chords meet or cross, loose ends tied to all lines within the tolerance: a
    contour that ends on a border may do so beside its chord."""
    import shapely

    lines = shapely.get_parts(shapely.union_all(chords, grid_size=GRID_MM))
    ends = np.concatenate([shapely.get_point(lines, place) for place in (0, -1)])
    steps = np.rint(shapely.get_coordinates(ends) / GRID_MM)
    _, first, count = np.unique(steps, axis=0, return_index=True, return_counts=True)
    loose = ends[first[count == 1]]
    end, line = shapely.STRtree(lines).query(loose, predicate="dwithin", distance=tolerance_mm)
    ties = shapely.shortest_line(loose[end], lines[line])
    ties = ties[shapely.length(ties) > 0.0]
    if not len(ties):
        return lines
    return shapely.get_parts(shapely.union_all(np.concatenate([lines, ties]), grid_size=GRID_MM))


def _around(parts: Any, strokes: Paths, ends: Ints, page_from_world: Floats) -> Paths:
    """The borders of polygons as closed paths along the segments of strokes, between points ends (k,2), that they
    follow: through these points where they pass them, with their directions and handles."""
    xy, offsets, segment = _corners(parts, strokes.points[ends])
    ahead, back = ragged.following(offsets), ragged.preceding(offsets)
    a, b = strokes.points[ends[segment]].transpose(1, 0, 2)
    from_a, to_a = (((at - a) * (b - a)).sum(axis=1) for at in (xy, xy[ahead]))
    turned = (from_a > to_a).astype(np.intp)
    every = np.arange(len(xy))
    first, last = ends[segment][every, turned], ends[segment][every, 1 - turned]
    leaves = np.hypot(*(xy - strokes.points[first]).T) <= ENDS_ON_GRID * GRID_MM
    arrives = np.hypot(*(xy[ahead] - strokes.points[last]).T) <= ENDS_ON_GRID * GRID_MM
    points = np.where(leaves[:, None], strokes.points[first], xy)
    points = np.where((arrives & ~leaves[ahead])[back, None], strokes.points[last][back], points)
    directions, handles = np.full((2, len(xy), 2), np.nan)
    directions[:, 1] = np.where(leaves, strokes.directions[first, 1 - turned] + np.pi * turned, np.nan)
    directions[ahead, 0] = np.where(arrives, strokes.directions[last, turned] + np.pi * turned, np.nan)
    handles[:, 1] = np.where(leaves & arrives, strokes.handles[first, 1 - turned], np.nan)
    handles[ahead, 0] = np.where(leaves & arrives, strokes.handles[last, turned], np.nan)
    stroke = ragged.owner(np.diff(strokes.offsets))[first]
    closed = np.ones(len(offsets) - 1, dtype=np.bool_)
    none = np.zeros(len(closed), dtype=np.intp)
    return Paths(
        points,
        offsets,
        closed,
        none + int(LineKind.OUTLINE),
        strokes.item[stroke[offsets[:-1]]],
        none,
        _in_space(points, strokes, first, last, page_from_world),
        np.logical_and.reduceat(strokes.smooth[stroke], offsets[:-1]),
        directions,
        handles=handles,
    )


def _corners(parts: Any, chords: Floats) -> tuple[Floats, Ints, Ints]:
    """Corners (n,2) of the borders of polygons, their offsets, and which of the chords (k,2,2) each border follows from
    there to its next corner: where it stays on one, other lines only touch it, and there is no corner."""
    import shapely

    rings = shapely.get_rings(shapely.orient_polygons(parts))
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    # A ring of shapely repeats its first point at its end.
    once = np.append(ring[1:] == ring[:-1], False)
    xy, ring = xy[once], ring[once]
    offsets = ragged.offsets(np.bincount(ring))
    middle = 0.5 * (xy + xy[ragged.following(offsets)])
    chord = shapely.STRtree(shapely.linestrings(chords)).nearest(shapely.points(middle))
    new = chord != chord[ragged.preceding(offsets)]
    new |= (np.bincount(ring, new) < FEWEST_CORNERS)[ring]
    return xy[new], ragged.offsets(np.bincount(ring[new])), chord[new]


def _in_space(points: Floats, strokes: Paths, first: Ints, last: Ints, page_from_world: Floats) -> Floats:
    """(n,3) the points of the world that are seen at points (n,2) of segments of strokes, from point first (n,) to
    last."""
    a, b = strokes.points[first], strokes.points[last]
    part = ((points - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1)
    a, b = strokes.points3d[first], strokes.points3d[last]
    near, far = (matmul(some, page_from_world[3, :3]) + page_from_world[3, 3] for some in (a, b))
    part = np.clip(part * near / (part * near + (1.0 - part) * far), 0.0, 1.0)[:, None]
    return np.asarray(a + part * (b - a))
