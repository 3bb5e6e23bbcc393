"""Regions of the plane, many at once: unions without splinters, and simple polygons without holes made of them.

Regions are shapely's geometries, in arrays; shapely is loaded when one of these functions is called.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import in_pieces, may_stop
from vectorplot.tolerances import UNITED_OF_EXTENT

POLYGON, MULTIPOLYGON = 3, 6
"""The numbers of shapely's types."""

WIDTH_KEPT = 4.0
"""Parts and holes of regions that are narrower than so many tolerances are splinters."""


def polygons_of(points: Floats, offsets: Ints) -> Any:
    """Polygons of shapely from corners and offsets.

    Parameters
    ----------
    points : (2 or more, c) array of float
        Columns are corners; x and y count.
    offsets : (n+1,) array of int
        Polygon i has the corners offsets[i] to offsets[i+1], three or more.

    Returns
    -------
    (n,) array of shapely.Polygon
        Simple where the polygons are.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> (square,) = geometry.polygons_of(np.array([(0.0, 4.0, 4.0, 0.0), (0.0, 0.0, 3.0, 3.0)]), np.array([0, 4]))
    >>> square.area
    12.0
    """
    import shapely

    position = np.insert(np.arange(points.shape[1]), offsets[1:], offsets[:-1])
    of = ragged.owner(np.diff(offsets) + 1)
    return shapely.polygons(shapely.linearrings(points[:2, position].T, indices=of))


POLYGONS_AT_ONCE = 1 << 11
"""So many polygons are united before work may stop."""

REGIONS_AT_ONCE = 1 << 11
"""So many regions are compared with others, or cut, before work may stop."""


def unions(polygons: Any, group: Ints, grid: float | None) -> Any:
    """(g,) the unions of groups 0, 1, ... of polygons, which may cross themselves, on a grid: sides that nearly
    coincide leave no splinters. None: in floating numbers, where these lead to a union."""
    import shapely

    order = np.argsort(group, kind="stable")
    several = shapely.geometrycollections(insides_of(polygons[order]), indices=group[order])
    parts = [_united(several[low:high]) for low, high in ragged.batches(np.bincount(group), POLYGONS_AT_ONCE)]
    united, found = (np.concatenate(column) for column in zip(*parts, strict=True)) if parts else _united(several)
    if grid is not None:
        # A grid makes each side dear: those between polygons are gone by now.
        return in_pieces(lambda some: shapely.union_all(some[:, None], axis=1, grid_size=grid), REGIONS_AT_ONCE, united)
    for number in np.flatnonzero(~found).tolist():
        united[number] = shapely.union_all(several[number], grid_size=_finest_grid(several[number]))
    return united


def _united(several: Any) -> tuple[Any, Bools]:
    """(g,) the unions of collections (g,), and (g,) which of them floating numbers led to: the others, rare ones of
    which sides pass each other within the last digits, stay as they are."""
    import shapely

    try:
        return shapely.union_all(several[:, None], axis=1), np.ones(len(several), dtype=np.bool_)
    except shapely.errors.GEOSException:
        if len(several) == 1:
            return several.copy(), np.zeros(1, dtype=np.bool_)
    half = len(several) // 2
    parts = (_united(several[:half]), _united(several[half:]))
    united, found = (np.concatenate(column) for column in zip(*parts, strict=True))
    return united, found


def _finest_grid(region: Any) -> float:
    """The finest grid on which the union of a region is found for certain."""
    import shapely

    return UNITED_OF_EXTENT * float(np.abs(shapely.bounds(region)).max())


def mosaics(polygons: Any, group: Ints) -> Any:
    """(g,) the unions of groups 0, 1, ... of polygons that do not overlap, and have in common whole sides only: what is
    between two of a group goes, in a tenth of the time of `unions`."""
    import shapely

    may_stop()
    order = np.argsort(group, kind="stable")
    if not len(order):
        return polygons
    several = shapely.geometrycollections(polygons[order], indices=group[order])
    return shapely.coverage_union_all(several[:, None], axis=1)


def cells_of(regions: Any, group: Ints, tolerance: float) -> tuple[Any, Ints]:
    """The cells that the borders of the regions (n,) of each of the groups 0, 1, ... cut the plane into, those without
    bounds left out: polygons (k,), and the group of each; no two of a group overlap by more than a few tolerances.

    Borders move by less than that. Edge cases: narrower cells are left out; corners where nothing turns, too.
    """
    import shapely

    order = np.argsort(group, kind="stable")
    borders = shapely.geometrycollections(shapely.boundary(regions[order]), indices=group[order])
    lines = shapely.union_all(borders[:, None], axis=1, grid_size=tolerance)
    cells, of = without_splinters(shapely.polygonize(lines[:, None]), tolerance)
    return shapely.simplify(cells, WIDTH_KEPT * tolerance), of


def areas_of(regions: Any) -> Any:
    """(n,) the areas among what regions (n,) consist of: intersections may have points and lines too."""
    import shapely

    mixed = ~_are_areas(regions)
    if not mixed.any():
        return regions
    result = regions.copy()
    result[mixed] = shapely.Polygon()
    parts, of = shapely.get_parts(regions, return_index=True)
    kept = mixed[of] & (shapely.get_type_id(parts) == POLYGON)
    which = np.unique(of[kept])
    result[which] = shapely.multipolygons(parts[kept], indices=np.searchsorted(which, of[kept]))
    return result


def _are_areas(regions: Any) -> Bools:
    """(n,) which regions consist of areas alone."""
    import shapely

    kind = shapely.get_type_id(regions)
    return np.asarray((kind == POLYGON) | (kind == MULTIPOLYGON))


def grown(regions: Any, distance: float) -> Any:
    """(n,) regions and what is within a distance of them, with sharp corners; shrunk where it is negative.

    Edge cases: the mitre of two sides that run back on each other is cut off; what floating point says of it is not
    said on.
    """
    import shapely

    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return in_pieces(partial(shapely.buffer, distance=distance, join_style="mitre"), REGIONS_AT_ONCE, regions)


def insides_of(regions: Any) -> Any:
    """(n,) valid regions with the insides of others, which may touch or cross themselves."""
    import shapely

    may_stop()
    found = regions
    # Most are valid, which is told in a tenth of the time that mending takes.
    broken = ~shapely.is_valid(found)
    if broken.any():
        found = found.copy()
        mended = partial(shapely.make_valid, method="structure", keep_collapsed=False)
        found[broken] = in_pieces(mended, REGIONS_AT_ONCE, found[broken])
    changed = np.flatnonzero(broken | ~_are_areas(found))
    if not len(changed):
        return found
    found = areas_of(found)
    # Where sides touch within the last digits the result may cross itself.
    crossed = changed[~shapely.is_valid(found[changed])]
    if len(crossed):
        found = found.copy()
        found[crossed] = shapely.buffer(found[crossed], 0.0)
    return found


def triangles_of(regions: Any) -> tuple[Any, Ints]:
    """Triangles that regions (n,) consist of, with no other corners than theirs, and the region of each."""
    import shapely

    may_stop()
    parts, of = shapely.get_parts(insides_of(regions), return_index=True)
    full = np.flatnonzero(shapely.area(parts) > 0.0)
    triangles, part = shapely.get_parts(shapely.constrained_delaunay_triangles(parts[full]), return_index=True)
    return triangles, of[full[part]]


def without_splinters(regions: Any, tolerance: float) -> tuple[Any, Ints]:
    """The polygons that regions (n,) consist of, and the region of each; parts narrower than a few tolerances are left
    out, and holes that narrow filled."""
    import shapely

    may_stop()
    parts, of = shapely.get_parts(regions, return_index=True)
    kept = (shapely.get_type_id(parts) == POLYGON) & _wide(parts, tolerance)
    parts, of = parts[kept], of[kept]
    pierced = np.flatnonzero(shapely.get_num_interior_rings(parts))
    if len(pierced):
        rings, owner = shapely.get_rings(parts[pierced], return_index=True)
        outer = np.concatenate([[True], owner[1:] != owner[:-1]])
        wide = outer | _wide(shapely.polygons(rings), tolerance)
        parts[pierced] = _ringed(rings[wide], owner[wide])
    return parts, of


def without_holes(parts: Any, of: Ints) -> tuple[Any, Ints]:
    """Polygons without holes in place of polygons (n,) with numbers of (n,): those with holes are cut in two through
    the middle of one, again and again."""
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
        halves = np.concatenate([shapely.intersection(parts, side) for side in sides])
        halves, number = shapely.get_parts(halves, return_index=True)
        of = np.concatenate([of, of])[number]
        polygon = shapely.get_type_id(halves) == POLYGON
        parts, of = halves[polygon], of[polygon]
    parts, of = (np.concatenate([some[k] for some in done]) for k in (0, 1))
    order = np.argsort(of, kind="stable")
    return parts[order], of[order]


def corners_of(parts: Any) -> tuple[Floats, Ints]:
    """Corners (2,c) and offsets (n+1,) of polygons (n,) without holes, counter-clockwise."""
    import shapely

    may_stop()
    rings = shapely.get_exterior_ring(shapely.orient_polygons(parts))
    xy, of = shapely.get_coordinates(rings, return_index=True)
    # A ring of shapely repeats its first point at its end.
    last = np.append(of[1:] != of[:-1], True)[: len(of)]
    xy, of = xy[~last], of[~last]
    return np.ascontiguousarray(xy.T), np.searchsorted(of, np.arange(len(parts) + 1)).astype(np.intp)


def _wide(polygons: Any, tolerance: float) -> Any:
    """(n,) which polygons are wider than a splinter."""
    import shapely

    may_stop()
    return shapely.area(polygons) > WIDTH_KEPT * tolerance * shapely.length(polygons)


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
