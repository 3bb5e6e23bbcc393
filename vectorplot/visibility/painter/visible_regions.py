"""What is seen of every face, as polygons that do not overlap: for pens, which cannot paint over anything."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.geometry.convex_clipping import clipped
from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.painter.bodies import convex_bodies, outlined_items
from vectorplot.visibility.painter.candidates import boxes_over
from vectorplot.visibility.painter.image_faces import ImageFaces, corner_positions
from vectorplot.visibility.painter.order import Painted
from vectorplot.visibility.painter.outlines import Outlines, overlapping
from vectorplot.visibility.projected_faces import project_faces

WIDTH_KEPT = 4.0
"""Parts and holes of regions that are narrower than so many tolerances are left out, and filled."""


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
    regions = _polygons(faces.points, faces.offsets)
    cut = np.unique(behind)
    if len(cut):
        regions[cut] = _uncovered(outlines, covers, behind, front, view.tolerance)
    seen = np.flatnonzero(~hidden)
    regions, first = _whole_faces(regions[seen], faces.source[seen], seen, view.tolerance)
    parts, of = _clean_parts(regions, view.tolerance)
    parts, of = _without_holes(parts, of)
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
    whole = _polygons(*_some(faces, cut))
    above = _polygons(covers.points, covers.offsets)[front]
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

    unions = shapely.union_all(shapely.geometrycollections(above, indices=of)[:, None], axis=1, grid_size=grid)
    return shapely.difference(whole, unions, grid_size=grid)


def _faulty(faces: _Covers, covers: _Covers, behind: Ints, front: Ints, of: Ints, left: Any, tolerance: float) -> Bools:
    """(k,) which parts left contain the middle of what a cover covers, or are smaller than all covers could leave."""
    import shapely

    subject, starts = _some(faces, behind)
    points, offsets, pair = clipped(subject, starts, *_some(covers, front), tolerance=tolerance)
    overlaps = _polygons(points, offsets)
    width = WIDTH_KEPT * tolerance
    wide = shapely.area(overlaps) > width * shapely.length(overlaps)
    middle = np.add.reduceat(points[:2], offsets[:-1], axis=1)[:, wide] / np.diff(offsets)[wide]
    wrong = np.zeros(len(left), dtype=np.bool_)
    place = of[pair[wide]]
    wrong[place[shapely.contains_xy(left[place], middle[0], middle[1])]] = True
    covered = np.bincount(of[pair], shapely.area(overlaps), minlength=len(left))
    whole = _polygons(*_some(faces, np.unique(behind)))
    too_small = shapely.area(left) < shapely.area(whole) - covered - width * shapely.length(whole)
    return np.asarray(wrong | too_small, dtype=np.bool_)


def _some(outlines: _Covers, which: Ints) -> tuple[Floats, Ints]:
    """Points and offsets of some outlines."""
    position, offsets = corner_positions(outlines.offsets, which)
    return outlines.points[:2, position], offsets


def _within(outlines: Outlines, inner: Ints, outer: Ints, tolerance: float) -> Bools:
    """(p,) which pairs have the first outline inside the second."""
    result = np.ones(len(inner), dtype=np.bool_)
    for one, row, two, other, part in outlines.groups(inner, outer):
        x, y = one.x[:, row], one.y[:, row]
        for side in range(len(two)):
            result[part] &= (two.distances(side, other, x, y) >= -tolerance).all(axis=0)
    return result


def _polygons(points: Floats, offsets: Ints) -> Any:
    """(n,) polygons of shapely."""
    import shapely

    position = np.insert(np.arange(points.shape[1]), offsets[1:], offsets[:-1])
    of = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets) + 1)
    return shapely.polygons(shapely.linearrings(points[:2, position].T, indices=of))


def _whole_faces(regions: Any, source: Ints, place: Ints, tolerance: float) -> tuple[Any, Ints]:
    """One region for each face, joined from those of its pieces, in the order of the last pieces; and their places."""
    import shapely

    order = np.lexsort((place, source))
    last = np.flatnonzero(np.append(source[order][1:] != source[order][:-1], True))
    counts = np.diff(np.concatenate([[-1], last]))
    joined = np.flatnonzero(counts > 1)
    result = regions[order[last]]
    if len(joined):
        pieces = np.repeat(counts > 1, counts)
        of = np.repeat(np.arange(len(joined)), counts[joined])
        several = shapely.geometrycollections(regions[order[pieces]], indices=of)
        result[joined] = shapely.union_all(several[:, None], axis=1, grid_size=tolerance)
    places = place[order[last]]
    by_place = np.argsort(places, kind="stable")
    return result[by_place], places[by_place]


def _clean_parts(regions: Any, tolerance: float) -> tuple[Any, Ints]:
    """The polygons that regions consist of, but for splinters, and the region of each."""
    import shapely

    parts, of = shapely.get_parts(regions, return_index=True)
    kept = (shapely.get_type_id(parts) == 3) & (shapely.area(parts) > WIDTH_KEPT * tolerance * shapely.length(parts))
    parts, of = parts[kept], of[kept]
    pierced = np.flatnonzero(shapely.get_num_interior_rings(parts))
    if len(pierced):
        rings, owner = shapely.get_rings(parts[pierced], return_index=True)
        outer = np.concatenate([[True], owner[1:] != owner[:-1]])
        wide = shapely.area(shapely.polygons(rings)) > WIDTH_KEPT * tolerance * shapely.length(rings)
        rings, owner = rings[outer | wide], owner[outer | wide]
        parts[pierced] = _ringed(rings, owner)
    return parts, of


def _ringed(rings: Any, owner: Ints) -> Any:
    """Polygons of rings, the outer one first for each owner."""
    import shapely

    outer = np.concatenate([[True], owner[1:] != owner[:-1]])
    holes = np.flatnonzero(~outer)
    result = shapely.polygons(rings[outer])
    pierced = np.unique(owner[holes])
    if len(pierced):
        # A polygon less its holes, all at once for each polygon.
        covers = shapely.multipolygons(shapely.polygons(rings[holes]), indices=np.searchsorted(pierced, owner[holes]))
        result[pierced] = shapely.difference(result[pierced], covers)
    return result


def _without_holes(parts: Any, of: Ints) -> tuple[Any, Ints]:
    """Polygons with holes cut in two through the middle of a hole, again and again."""
    import shapely

    done: list[tuple[Any, Ints]] = []
    while True:
        pierced = shapely.get_num_interior_rings(parts) > 0
        done.append((parts[~pierced], of[~pierced]))
        parts, of = parts[pierced], of[pierced]
        if not len(parts):
            break
        middle = shapely.get_num_interior_rings(parts) // 2
        hole = shapely.bounds(shapely.get_interior_ring(parts, middle))
        x = (hole[:, 0] + hole[:, 2]) / 2.0
        left, bottom, right, top = shapely.bounds(parts).T
        sides = shapely.box(left, bottom, x, top), shapely.box(x, bottom, right, top)
        halves, number = shapely.get_parts(
            np.concatenate([shapely.intersection(parts, side) for side in sides]), return_index=True
        )
        of = np.concatenate([of, of])[number]
        polygon = shapely.get_type_id(halves) == 3
        parts, of = halves[polygon], of[polygon]
    parts, of = np.concatenate([d[0] for d in done]), np.concatenate([d[1] for d in done])
    order = np.argsort(of, kind="stable")
    return parts[order], of[order]


def _listed(faces: ImageFaces, parts: Any, place: Ints) -> VisibleRegions:
    """Polygons of shapely, without holes, as regions, counter-clockwise; place: of the image face each belongs to."""
    import shapely

    rings = shapely.get_exterior_ring(shapely.orient_polygons(parts))
    xy, of = shapely.get_coordinates(rings, return_index=True)
    last = np.append(of[1:] != of[:-1], True)[: len(of)]
    xy, of = xy[~last], of[~last]
    x, y = np.ascontiguousarray(xy.T)
    height = faces.heights(place[of], x, y)
    offsets = np.searchsorted(of, np.arange(len(parts) + 1))
    return VisibleRegions(np.stack([x, y, height]), offsets, faces.source[place])
