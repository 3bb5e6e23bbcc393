"""Decals that overlap, united: for what cannot be painted over, as on plotters and in transparent layers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from vectorplot.effects.decals import Decals
from vectorplot.geometry.mesh import Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import newell

POLYGON = 3
"""The number of shapely's type."""

WIDTH_KEPT = 4.0
"""Parts and holes that are narrower than so many tolerances are left out, and filled."""


def united_decals(view: View, decals: Decals) -> Decals:
    """The decals with those of each face that are alike (kind, lights, colour, level) as one region, cut into simple
    polygons where it has holes.

    Regions move by less than a few tolerances. Degenerate: regions narrower than a few tolerances are left out.
    """
    if not len(decals):
        return decals
    frame = _frames(view, decals)
    region, leader = _regions(decals, frame, view.tolerance)
    return _listed(decals, frame, region, leader, view.tolerance)


def disjoint_decals(view: View, decals: Decals) -> Decals:
    """The same, each without what decals of higher levels on its face cover."""
    import shapely

    if not len(decals):
        return decals
    frame = _frames(view, decals)
    region, leader = _regions(decals, frame, view.tolerance)
    faces, face = np.unique(decals.face[leader], return_inverse=True)
    level = decals.level[leader]
    above: Any = np.full(len(faces), shapely.Polygon(), dtype=object)
    for height in np.unique(level)[::-1].tolist():
        here = np.flatnonzero(level == height)
        own = region[here]
        region[here] = shapely.difference(own, above[face[here]], grid_size=view.tolerance)
        covered, of = np.unique(face[here], return_inverse=True)
        number = np.concatenate([of, np.arange(len(covered))])
        above[covered] = _unions(np.concatenate([own, above[covered]]), number, view.tolerance)
    return _listed(decals, frame, region, leader, view.tolerance)


def _frames(view: View, decals: Decals) -> Floats:
    """(3,3,m) a corner of the face of each decal, and two unit vectors across its normal."""
    normal, _, first = newell(view, decals.face)
    normal /= np.sqrt((normal * normal).sum(axis=0))
    axis = np.eye(3)[:, np.argmin(np.abs(normal), axis=0)]
    along = np.cross(axis, normal, axis=0)
    along /= np.sqrt((along * along).sum(axis=0))
    return np.stack([view.points[:, first], along, np.cross(normal, along, axis=0)])


def _regions(decals: Decals, frame: Floats, tolerance: float) -> tuple[Any, Ints]:
    """The union of the decals that are alike, in the frames of their faces, and for each the first of its decals."""
    import shapely

    sizes = np.diff(decals.offsets)
    origin, along, left = np.repeat(frame, sizes, axis=2)
    arm = decals.points - origin
    flat = np.stack([(arm * along).sum(axis=0), (arm * left).sum(axis=0)], axis=1)
    rings = shapely.linearrings(flat, indices=np.repeat(np.arange(len(sizes)), sizes))
    columns = (decals.face, decals.kind, decals.level, decals.lights_lacking, decals.light, decals.colour)
    _, leader, group = np.unique(
        np.stack([*columns, decals.opacities], axis=1), axis=0, return_index=True, return_inverse=True
    )
    return _unions(shapely.polygons(rings), group, tolerance), leader


def _unions(polygons: Any, group: Ints, tolerance: float) -> Any:
    """The unions of groups of polygons on a grid of the tolerance: sides that nearly coincide leave no splinters."""
    import shapely

    order = np.argsort(group, kind="stable")
    several = shapely.geometrycollections(polygons[order], indices=group[order])
    return shapely.union_all(several[:, None], axis=1, grid_size=tolerance)


def _listed(decals: Decals, frame: Floats, region: Any, leader: Ints, tolerance: float) -> Decals:
    """Regions, in the frames of the decals that lead them, as decals without holes."""
    import shapely

    parts, of = shapely.get_parts(region, return_index=True)
    width = WIDTH_KEPT * tolerance
    kept = (shapely.get_type_id(parts) == POLYGON) & (shapely.area(parts) > width * shapely.length(parts))
    parts, of = _without_holes(parts[kept], leader[of[kept]])
    rings = shapely.get_exterior_ring(shapely.orient_polygons(parts))
    flat, ring = shapely.get_coordinates(rings, return_index=True)
    # A ring of shapely repeats its first point at its end.
    kept = np.append(ring[1:] == ring[:-1], False) if len(ring) else np.zeros(0, dtype=np.bool_)
    flat, ring = flat[kept], ring[kept]
    origin, along, left = frame[:, :, of[ring]]
    result = decals.of(of)
    offsets = np.concatenate([[0], np.cumsum(np.bincount(ring, minlength=len(parts)))])
    return replace(result, points=origin + flat[:, 0] * along + flat[:, 1] * left, offsets=offsets)


def _without_holes(parts: Any, of: Ints) -> tuple[Any, Ints]:
    """Polygons with holes halved through the middle of one of them until there are none."""
    import shapely

    whole, owner = [], []
    while len(parts):
        holes = shapely.get_num_interior_rings(parts)
        whole.append(parts[holes == 0])
        owner.append(of[holes == 0])
        parts, of, holes = parts[holes > 0], of[holes > 0], holes[holes > 0]
        west, _, east, _ = shapely.bounds(shapely.get_interior_ring(parts, holes // 2)).T
        left, bottom, right, top = shapely.bounds(parts).T
        middle = (west + east) / 2.0
        halves = shapely.box(left, bottom, middle, top), shapely.box(middle, bottom, right, top)
        parts, number = shapely.get_parts(
            shapely.intersection(np.tile(parts, 2), np.concatenate(halves)), return_index=True
        )
        of = np.tile(of, 2)[number]
        polygon = shapely.get_type_id(parts) == POLYGON
        parts, of = parts[polygon], of[polygon]
    if not whole:
        return parts, of
    order = np.argsort(np.concatenate(owner), kind="stable")
    return np.concatenate(whole)[order], np.concatenate(owner)[order]
