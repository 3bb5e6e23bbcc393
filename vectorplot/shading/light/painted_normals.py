"""The normals that painted faces are shaded with: those of smooth surfaces, of meshes that stand for such, and of
planes on which light varies; everything else has one shade."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.shading.light.corner_normals import TrueNormals, at_corners, view_normals
from vectorplot.shading.light.face_shades import decal_shades, face_middles, face_normals
from vectorplot.shading.light.illumination import AMBIENT, DIRECT_SHARE, shades
from vectorplot.shading.light.palettes import PALETTE_SIZE
from vectorplot.tolerances.of_angles import FLAT_COSINE
from vectorplot.visibility.projected_faces import newell

VARIED = 2.0 / PALETTE_SIZE
"""By so much of a palette shades vary on planes that are not shown in one: by two shades of a usual one."""

LARGE = 0.5
"""Planes that reach through more than this part of the depth of the picture have shades that vary with it."""


def painted_normals(
    view: View,
    items: Sequence[Item],
    lights: Sequence[Light],
    given: Sequence[TrueNormals | None],
    plane: Ints,
    crease_angle_deg: float,
) -> Floats:
    """(3,c) unit normals at the corners of the faces of a view, outwards; NaN at those of faces that have one shade.

    lights: in the view's coordinates, none where every plane shall have one shade; given and crease angle as of
    view_normals: the same normals as in pictures of pixels; plane (f,) as of plane_numbers: the faces of a region are
    shaded alike. Regions of one normal have one shade unless the light on them varies by more than VARIED, as on a
    floor below a lamp, or they are LARGE, as a floor under all of a scene, whatever the light.
    Source: Glaeser, section 4.6.
    """
    found = at_corners(view, view_normals(view, given, crease_angle_deg))
    own = face_normals(view)
    of_corner = ragged.owner(view.face_sizes)
    turned = (found * own[:, of_corner]).sum(axis=0) < FLAT_COSINE
    turned &= _wide(view)[of_corner]
    count = int(plane.max(initial=-1)) + 1
    round_ = np.zeros(count, dtype=np.bool_)
    round_[plane[of_corner[turned]]] = True
    true = np.array([normals is not None for normals in given], dtype=np.bool_)[view.face_item]
    varied = _varied(view, items, lights, plane)[plane] if lights else np.zeros(view.face_count, dtype=np.bool_)
    flat: Bools = np.asarray(~(round_[plane] | true), dtype=np.bool_)
    found[:, (flat & ~varied)[of_corner]] = np.nan
    plain = (flat & varied)[of_corner]
    found[:, plain] = own[:, of_corner[plain]]
    return found


def _wide(view: View) -> Bools:
    """(f,) the faces that are wide enough to tell where they look, and not only long."""
    area, longest, _ = newell(view, np.arange(view.face_count))
    return np.asarray(np.sqrt((area * area).sum(axis=0)) > view.tolerance * longest)


def _varied(view: View, items: Sequence[Item], lights: Sequence[Light], plane: Ints) -> Bools:
    """(p,) the regions on which light varies, or depth much: from corner to corner, middle to middle, along sides."""
    corner = np.arange(len(view.corners))
    of_corner = ragged.owner(view.face_sizes)
    start, end = view.points[:, view.corners], view.points[:, view.corners[view.after(corner)]]
    points = np.concatenate([start, (start + end) / 2.0, face_middles(view)], axis=1)
    face = np.concatenate([of_corner, of_corner, np.arange(view.face_count)])
    at = decal_shades(view, items, lights, points, face)
    light = np.atleast_2d(shades(at.shares, at.intensity)) / DIRECT_SHARE
    count = int(plane.max(initial=-1)) + 1
    varied = np.zeros(count, dtype=np.bool_)
    for row, most in [*((row, VARIED) for row in light), (at.cue, LARGE * AMBIENT)]:
        low, high = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(low, plane[face], row)
        np.maximum.at(high, plane[face], row)
        varied |= high - low > most
    return varied
