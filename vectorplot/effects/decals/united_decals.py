"""Decals that overlap, united: for what cannot be painted over, as on plotters and in transparent layers."""

from __future__ import annotations

from typing import Any

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.effects.decals.decal_polygons import Decals
from vectorplot.effects.decals.face_frames import FaceFrames
from vectorplot.geometry import ragged
from vectorplot.geometry.regions import corners_of, unions, without_holes, without_splinters
from vectorplot.scene.view import View


def united_decals(view: View, decals: Decals) -> Decals:
    """The decals with those of each face that are alike (kind, lights, colour, level) as one region, cut into simple
    polygons where it has holes.

    Regions move by less than a few tolerances. Degenerate: regions narrower than a few tolerances are left out.
    """
    if not len(decals):
        return decals
    frames = FaceFrames.of(view, decals.face)
    region, leader = _regions(decals, frames, view.tolerance)
    return _listed(decals, frames, region, leader, view.tolerance)


def disjoint_decals(view: View, decals: Decals) -> Decals:
    """The same, each without what decals of higher levels on its face cover."""
    import shapely

    if not len(decals):
        return decals
    frames = FaceFrames.of(view, decals.face)
    region, leader = _regions(decals, frames, view.tolerance)
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
    return _listed(decals, frames, region, leader, view.tolerance)


def _regions(decals: Decals, frames: FaceFrames, tolerance: float) -> tuple[Any, Ints]:
    """The union of the decals that are alike, in the frames of their faces, and for each the first of its decals."""
    import shapely

    sizes = np.diff(decals.offsets)
    owner = ragged.owner(sizes)
    rings = shapely.linearrings(frames.flat(decals.points, owner).T, indices=owner)
    columns = (decals.face, decals.kind, decals.level, decals.lights_lacking, decals.light, decals.colour)
    _, leader, group = np.unique(
        np.stack([*columns, decals.opacities], axis=1), axis=0, return_index=True, return_inverse=True
    )
    return unions(shapely.polygons(rings), group, tolerance), leader


def _listed(decals: Decals, frames: FaceFrames, region: Any, leader: Ints, tolerance: float) -> Decals:
    """Regions, in the frames of the decals that lead them, as decals without holes."""
    parts, of = without_splinters(region, tolerance)
    parts, of = without_holes(parts, leader[of])
    flat, offsets = corners_of(parts)
    return decals.parts(of, frames.lifted(flat, np.repeat(of, np.diff(offsets))), offsets)
