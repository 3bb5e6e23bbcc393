"""Decals that overlap, united: for what cannot be painted over, as on plotters and in transparent layers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from vectorplot.effects.decals import Decals
from vectorplot.geometry.mesh import Floats, Ints
from vectorplot.geometry.regions import corners_of, unions, without_holes, without_splinters
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import newell


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
        above[covered] = unions(np.concatenate([own, above[covered]]), number, view.tolerance)
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
    return unions(shapely.polygons(rings), group, tolerance), leader


def _listed(decals: Decals, frame: Floats, region: Any, leader: Ints, tolerance: float) -> Decals:
    """Regions, in the frames of the decals that lead them, as decals without holes."""
    parts, of = without_splinters(region, tolerance)
    parts, of = without_holes(parts, leader[of])
    (x, y), offsets = corners_of(parts)
    origin, along, left = np.repeat(frame[:, :, of], np.diff(offsets), axis=2)
    return replace(decals.of(of), points=origin + x * along + y * left, offsets=offsets)
