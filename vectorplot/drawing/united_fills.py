"""Polygons that follow each other in one colour as one region."""

from __future__ import annotations

from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.fills_without_overlaps import listed, visible_parts
from vectorplot.drawing.painted_fills import Overlay
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import TRIANGLE
from vectorplot.geometry.regions import (
    corners_of,
    insides_of,
    polygons_of,
    unions,
    without_holes,
    without_splinters,
)
from vectorplot.tolerances.of_the_page import GRID_MM, STEP_BORDER_MM


def united(overlay: Overlay, sheet: Ints) -> Overlay:
    """The same picture with one region, cut open to its holes, in place of polygons of one colour, item and kind that
    are painted right after each other on the same polygon, and of the same sheet (m,), a number of each, -1 for none.

    Shaded polygons stay as they are, and so do those that one can see through and that are of no sheet: they may
    overlap. Corners in space are
    those of the polygons, or what is between the two next ones.
    Error: new corners, where sides cross, are off by GRID_MM at most; parts narrower than a few of these are left out.
    """
    import shapely

    fills = overlay.fills
    run = _runs(overlay, sheet)
    several = np.bincount(run, minlength=1)[run] > 1
    mine = np.flatnonzero(several)
    if not len(mine):
        return overlay
    _, first, of = np.unique(run[mine], return_index=True, return_inverse=True)
    some = fills.some(mine)
    regions = insides_of(polygons_of(some.points.T, some.offsets))
    region = unions(regions, of, GRID_MM)
    leader, kept = mine[first], np.flatnonzero(~several)
    parts, which = without_splinters(region, GRID_MM)
    parts, which = without_holes(shapely.simplify(parts, GRID_MM), which)
    source = leader[which]
    made = _listed(some, parts, first[which])
    order = np.argsort(np.concatenate([kept, source]), kind="stable")
    after = np.concatenate([overlay.after[kept], overlay.after[source]])
    return Overlay(Fills.joined(fills.some(kept), made).some(order), after[order])


def visible_shades(painted: Overlay, smooth: Bools, page_from_world: Floats) -> Fills:
    """What is seen of polygons, as of visible_fills, with one region, cut open to its holes, in place of those of one
    colour of an item, among the items that are smooth (i,). What one can see through stays in its parts.

    painted: the polygons; those that come after one number are parts of one, as of visible_parts, those of -1 of none.
    Corners in space, errors as of united; borders of regions are off by less than STEP_BORDER_MM, on both sides alike.
    """
    import shapely

    fills = painted.fills
    whole = np.where(painted.after < 0, -1 - np.arange(len(fills)), painted.after)

    sizes = np.diff(fills.offsets)
    solid, lines = fills.some(np.flatnonzero(sizes >= TRIANGLE)), fills.some(np.flatnonzero(sizes < TRIANGLE))
    if not len(solid):
        return fills
    seen = visible_parts(solid, whole[sizes >= TRIANGLE])
    of_item = np.append(smooth, False)[solid.item] & (solid.opacity >= 1.0) & ~_shaded(solid)
    mine = of_item[seen.source]
    rest = listed(solid, *without_holes(seen.parts[~mine], seen.source[~mine]), page_from_world)
    parts, source, uncut = seen.parts[mine], seen.source[mine], seen.uncut[mine]
    rows = np.column_stack([solid.item, solid.kind, solid.colours[solid.offsets[:-1]]])[source]
    _, first, of = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    of = of.reshape(-1)
    # Those that nothing was taken from have whole sides in common, which is told fast.
    some, group = np.unique(of[uncut], return_inverse=True)
    every = np.concatenate([unions(parts[uncut], group.reshape(-1), None), parts[~uncut]])
    group = np.concatenate([some, of[~uncut]])
    regions, which = without_splinters(unions(every, group, GRID_MM), GRID_MM)
    regions, which = without_holes(shapely.coverage_simplify(regions, STEP_BORDER_MM), which)
    return Fills.joined(rest, _listed(solid, regions, source[first][which]), lines)


def _runs(overlay: Overlay, sheet: Ints) -> Ints:
    """(m,) the number of the run of each polygon."""
    fills = overlay.fills
    colour = fills.colours[fills.offsets[:-1]]
    rows = np.column_stack([sheet, overlay.after, fills.item, fills.kind, fills.opacity, colour])
    alone = _shaded(fills) | (np.diff(fills.offsets) < 3) | ((fills.opacity < 1.0) & (sheet < 0))
    new = np.ones(len(fills), dtype=np.bool_)
    new[1:] = (rows[1:] != rows[:-1]).any(axis=1) | alone[1:] | alone[:-1]
    return np.cumsum(new) - 1


def _shaded(fills: Fills) -> Bools:
    """(m,) whether the corners of polygons differ in colour."""
    first = np.repeat(fills.colours[fills.offsets[:-1]], np.diff(fills.offsets), axis=0)
    differs = ragged.offsets((fills.colours != first).any(axis=1))[fills.offsets]
    return np.asarray(differs[1:] > differs[:-1])


def _listed(fills: Fills, parts: Any, source: Ints) -> Fills:
    """Polygons of shapely, without holes, that are unions of fills, each in the colours of the fill source (n,)."""
    flat, offsets = corners_of(parts)
    points, in_space = _as_they_were(fills, flat.T)
    colours = fills.colours[fills.offsets[np.repeat(source, np.diff(offsets))]]
    return Fills(points, offsets, colours, fills.opacity[source], fills.item[source], in_space, fills.kind[source])


def _as_they_were(fills: Fills, points: Floats) -> tuple[Floats, Floats]:
    """(c,2) points of the page near corners of polygons, moved to these where the grid has moved them off, and (c,3)
    where they are in space: by the two nearest corners."""
    from scipy.spatial import cKDTree

    distance, near = cKDTree(fills.points).query(points, k=2)
    weight = 1.0 / np.maximum(distance, GRID_MM * GRID_MM)
    weight /= weight.sum(axis=1, keepdims=True)
    space = np.einsum("ck,ckd->cd", weight, fills.points3d[near])
    same = distance[:, 0] <= 2.0 * GRID_MM
    space[same] = fills.points3d[near[same, 0]]
    return np.where(same[:, None], fills.points[near[:, 0]], points), space
