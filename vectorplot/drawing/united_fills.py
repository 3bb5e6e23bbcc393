"""Polygons that follow each other in one colour as one region."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.painted_fills import Overlay
from vectorplot.geometry import ragged
from vectorplot.geometry.regions import corners_of, insides_of, polygons_of, unions, without_holes, without_splinters
from vectorplot.tolerances.of_the_page import GRID_MM


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
    flat, offsets = corners_of(parts)
    points, in_space = _as_they_were(some, flat.T)
    source = leader[which]
    corner = np.repeat(source, np.diff(offsets))
    made = Fills(
        points,
        offsets,
        fills.colours[fills.offsets[corner]],
        fills.opacity[source],
        fills.item[source],
        in_space,
        fills.kind[source],
    )
    order = np.argsort(np.concatenate([kept, source]), kind="stable")
    after = np.concatenate([overlay.after[kept], overlay.after[source]])
    return Overlay(Fills.joined(fills.some(kept), made).some(order), after[order])


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
