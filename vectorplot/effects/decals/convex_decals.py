"""Decals in convex parts: what is shaded from corner to corner has to be convex."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.decals.decal_polygons import Decals, joined_decals
from vectorplot.effects.decals.face_frames import FaceFrames
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.regions import corners_of, polygons_of, triangles_of
from vectorplot.scene.view import View


def convex_decals(view: View, decals: Decals, chosen: Bools) -> Decals:
    """The decals, those on chosen faces (f,) that are not convex cut into triangles."""
    which = np.flatnonzero(chosen[decals.face] & (np.diff(decals.offsets) > 3))
    if not len(which):
        return decals
    some = decals.of(which)
    frames = FaceFrames.of(view, some.face)
    owner = ragged.owner(np.diff(some.offsets))
    flat = frames.flat(some.points, owner)
    bent = np.flatnonzero(_bent(flat, some.offsets, view.tolerance))
    if not len(bent):
        return decals
    polygons = polygons_of(flat, some.offsets)[bent]
    parts, of = triangles_of(polygons)
    corners, offsets = corners_of(parts)
    of = bent[of]
    cut = some.parts(of, frames.lifted(corners, np.repeat(of, np.diff(offsets))), offsets)
    rest = np.ones(len(decals), dtype=np.bool_)
    rest[which[bent]] = False
    return joined_decals(decals.of(np.flatnonzero(rest)), cut)


def _bent(flat: Floats, offsets: Ints, tolerance: float) -> Bools:
    """(m,) polygons (2,c) that turn both ways."""
    along = flat[:, next_positions(offsets, np.arange(flat.shape[1]))] - flat
    after = along[:, next_positions(offsets, np.arange(flat.shape[1]))]
    turn = along[0] * after[1] - along[1] * after[0]
    slack = tolerance * (np.hypot(*along) + np.hypot(*after))
    left, right = (np.logical_or.reduceat(way, offsets[:-1]) for way in (turn > slack, turn < -slack))
    return np.asarray(left & right, dtype=np.bool_)
