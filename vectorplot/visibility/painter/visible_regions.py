"""What is seen of every face, as polygons that do not overlap: for pens, which cannot paint over anything."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.convex.polygon_clipping import clipped_by_convex
from vectorplot.geometry.regions import (
    WIDTH_KEPT,
    corners_of,
    polygons_of,
    unions,
    without_holes,
    without_splinters,
)
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.order import Painted
from vectorplot.visibility.painter.pairs.bodies import convex_bodies, outlined_items
from vectorplot.visibility.painter.pairs.candidates import boxes_over
from vectorplot.visibility.painter.pairs.outlines import Outlines, overlapping
from vectorplot.visibility.projected_faces import project_faces


@dataclass(frozen=True, eq=False)
class VisibleRegions:
    """Simple polygons without common inner points: points (3,c), places in the image and heights above it; offsets
    (m+1,); source (m,): the face of the view each one is a part of. A face may have several, or none."""

    points: Floats
    offsets: Ints
    source: Ints

    def __len__(self) -> int:
        return len(self.source)


def visible_regions(view: View, painted: Painted) -> VisibleRegions:
    """The visible region of every face: the face without the union of all that is painted over it.

    Regions with holes are cut into polygons without. What was cut to be painted is whole again. Items that do not
    occlude take nothing from what lies behind them. The regions of the faces stand in the order of painting.
    Degenerate: regions narrower than a few tolerances are left out.
    Source: Weiler and Atherton, Hidden surface removal using polygon area sorting (1977).
    """
    faces = painted.faces
    if not len(faces):
        return VisibleRegions(faces.points[:, :0], np.zeros(1, dtype=np.intp), faces.source)
    covers = _covers(view, painted)
    outlines = _Covers(faces.points, faces.offsets, np.arange(len(faces)))
    behind, front, hidden = _overlaps(outlines, covers, view.tolerance)
    regions = polygons_of(faces.points, faces.offsets)
    cut = np.unique(behind)
    if len(cut):
        regions[cut] = _uncovered(outlines, covers, behind, front, view.tolerance)
    seen = np.flatnonzero(~hidden)
    regions, first = _whole_faces(regions[seen], faces.source[seen], seen, view.tolerance)
    parts, of = without_splinters(regions, view.tolerance)
    parts, of = without_holes(parts, of)
    return _listed(faces, parts, first[of])


@dataclass(frozen=True, eq=False)
class _Covers:
    """Convex outlines. points (2 or more, c), offsets (k+1,); place (k,): where in the order of painting they begin to
    be painted."""

    points: Floats
    offsets: Ints
    place: Ints

    @property
    def box(self) -> Floats:
        """(4,k) smallest and largest x and y."""
        if not len(self.place):
            return np.zeros((4, 0))
        extremes = (np.minimum, np.maximum)
        return np.stack([e.reduceat(row, self.offsets[:-1]) for row in self.points[:2] for e in extremes])


def _covers(view: View, painted: Painted) -> _Covers:
    """The outlines of convex bodies that are painted as wholes, and all other faces that hide.

    An outline is one polygon where the faces would be several, with common sides that leave splinters.
    """
    faces = painted.faces
    solid = outlined_items(view, project_faces(view))
    solid[painted.knots] = False
    bodies = convex_bodies(view, faces, np.flatnonzero(solid))
    alone = view.occludes[view.face_item[faces.source]]
    alone[bodies.shown] = False
    single = faces.some(np.flatnonzero(alone))
    place = np.minimum.reduceat(bodies.shown, bodies.first[:-1]) if len(bodies) else bodies.item
    points = np.concatenate([bodies.corners, single.points[:2]], axis=1)
    offsets = np.concatenate([bodies.offsets, bodies.offsets[-1] + single.offsets[1:]])
    place = np.concatenate([place, np.flatnonzero(alone)])
    covers = _Covers(points, offsets, place)
    _, _, hidden = _overlaps(covers, covers, view.tolerance)
    # What hides a hidden cover hides whatever that one would.
    return _Covers(*_some(covers, np.flatnonzero(~hidden)), place[~hidden])


def _overlaps(seen: _Covers, covers: _Covers, tolerance: float) -> tuple[Ints, Ints, Bools]:
    """The outlines that are seen in parts, each with the covers painted over it; and (n,) which are wholly hidden by
    one cover."""
    count = len(seen.place)
    points = np.concatenate([seen.points[:2], covers.points[:2]], axis=1)
    outlines = Outlines.of(points, np.concatenate([seen.offsets, seen.offsets[-1] + covers.offsets[1:]]), tolerance)
    hidden = np.zeros(count, dtype=np.bool_)
    lots = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    for below, above in boxes_over(seen.box, covers.box, tolerance):
        later = np.flatnonzero(covers.place[above] > seen.place[below])
        below, above = below[later], above[later]
        common = overlapping(outlines, below, above + count, tolerance)
        below, above = below[common], above[common]
        hidden[below[_within(outlines, below, above + count, tolerance)]] = True
        lots.append((below, above))
    below, above = np.concatenate([lot[0] for lot in lots]), np.concatenate([lot[1] for lot in lots])
    needed = ~hidden[below]
    return below[needed], above[needed], hidden


def _uncovered(faces: _Covers, covers: _Covers, behind: Ints, front: Ints, tolerance: float) -> Any:
    """The parts of faces, in ascending order, that the covers over them leave."""
    import shapely

    cut, of = np.unique(behind, return_inverse=True)
    whole = polygons_of(*_some(faces, cut))
    above = polygons_of(covers.points, covers.offsets)[front]
    # Without a grid this is three times faster, but where sides nearly coincide it fails, or loses a cover.
    try:
        left = shapely.set_precision(_difference(whole, above, of, None), tolerance)
        wrong = _faulty(faces, covers, behind, front, of, left, tolerance)
    except shapely.GEOSException:
        left, wrong = whole.copy(), np.ones(len(cut), dtype=np.bool_)
    if wrong.any():
        again, number = np.flatnonzero(wrong[of]), np.cumsum(wrong) - 1
        left[wrong] = _difference(whole[wrong], above[again], number[of[again]], tolerance)
    return left


def _difference(whole: Any, above: Any, of: Ints, grid: float | None) -> Any:
    """Polygons less the union of what lies above each of them."""
    import shapely

    return shapely.difference(whole, unions(above, of, grid), grid_size=grid)


def _faulty(faces: _Covers, covers: _Covers, behind: Ints, front: Ints, of: Ints, left: Any, tolerance: float) -> Bools:
    """(k,) which parts left contain some of what a cover covers, or are smaller than all covers could leave."""
    import shapely

    subject, starts = _some(faces, behind)
    points, offsets, pair = clipped_by_convex(subject, starts, *_some(covers, front), tolerance=tolerance)
    overlaps = polygons_of(points, offsets)
    width = WIDTH_KEPT * tolerance
    wide = shapely.area(overlaps) > width * shapely.length(overlaps)
    wrong = np.zeros(len(left), dtype=np.bool_)
    place = of[pair[wide]]
    kept = shapely.intersection(left[place], overlaps[wide], grid_size=tolerance)
    wrong[place[shapely.area(kept) > width * shapely.length(kept)]] = True
    covered = np.bincount(of[pair], shapely.area(overlaps), minlength=len(left))
    whole = polygons_of(*_some(faces, np.unique(behind)))
    too_small = shapely.area(left) < shapely.area(whole) - covered - width * shapely.length(whole)
    return np.asarray(wrong | too_small, dtype=np.bool_)


def _some(outlines: _Covers, which: Ints) -> tuple[Floats, Ints]:
    """Points and offsets of some outlines."""
    position, offsets = ragged.take(outlines.offsets, which)
    return outlines.points[:2, position], offsets


def _within(outlines: Outlines, inner: Ints, outer: Ints, tolerance: float) -> Bools:
    """(p,) which pairs have the first outline inside the second."""
    result = np.ones(len(inner), dtype=np.bool_)
    for one, row, two, other, part in outlines.groups(inner, outer):
        x, y = one.x[:, row], one.y[:, row]
        for side in range(len(two)):
            result[part] &= (two.distances(side, other, x, y) >= -tolerance).all(axis=0)
    return result


def _whole_faces(regions: Any, source: Ints, place: Ints, tolerance: float) -> tuple[Any, Ints]:
    """One region for each face, joined from those of its pieces, in the order of the last pieces; and their places."""

    order = np.lexsort((place, source))
    last = np.flatnonzero(np.append(source[order][1:] != source[order][:-1], True))
    counts = np.diff(np.concatenate([[-1], last]))
    joined = np.flatnonzero(counts > 1)
    result = regions[order[last]]
    if len(joined):
        pieces = np.repeat(counts > 1, counts)
        of = ragged.owner(counts[joined])
        result[joined] = unions(regions[order[pieces]], of, tolerance)
    places = place[order[last]]
    by_place = np.argsort(places, kind="stable")
    return result[by_place], places[by_place]


def _listed(faces: ImageFaces, parts: Any, place: Ints) -> VisibleRegions:
    """Polygons of shapely, without holes, as regions, counter-clockwise; place: of the image face each belongs to."""
    (x, y), offsets = corners_of(parts)
    height = faces.heights(np.repeat(place, np.diff(offsets)), x, y)
    return VisibleRegions(np.stack([x, y, height]), offsets, faces.source[place])
