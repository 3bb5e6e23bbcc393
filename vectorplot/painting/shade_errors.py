"""How far the colours of painted polygons are from those of the surfaces they show."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.columns import dot
from vectorplot.painting.seen import Seen
from vectorplot.shading.light.painted_colours import Lighting, corner_shades_of, smooth_faces
from vectorplot.visibility.painter.image_faces import view_points

MOST = 4096
"""So many polygons are measured at most, evenly among all."""

FARTHEST = 0.5
"""What is seen over the middle of a side is no farther away than this part of it."""

STEPS = 255.0
"""Of a colour, from its darkest to its brightest shade."""


def shade_error_steps(seen: Seen, lighting: Lighting) -> float | None:
    """By how many of 255 steps the linear shading of polygons is off the light that the surface has where it is seen,
    in the middles of their sides, at most; None where all polygons have one shade each.

    Over triangles that are off a surface one sees other places of it than those that they were made for: how far these
    are apart is told by the tangent planes at the corners of a triangle, and what that makes by the shades there.
    """
    faces = seen.faces
    smooth = np.flatnonzero(smooth_faces(seen.view, lighting.normals)[faces.source])
    smooth = smooth[:: 1 + len(smooth) // MOST]
    if not len(smooth):
        return None
    position, offsets = ragged.take(faces.offsets, smooth)
    points = faces.points[:, position]
    after = ragged.following(offsets)
    both = np.concatenate([points, 0.5 * (points + points[:, after])], axis=1)
    ends = np.concatenate([offsets, offsets[-1] + offsets[1:]])
    source = np.tile(faces.source[smooth], 2)
    shade = np.atleast_2d(corner_shades_of(seen.view, lighting, view_points(seen.view, both), ends, source).total)
    corner, middle = np.split(shade, 2, axis=-1)
    off = np.abs(middle - 0.5 * (corner + corner[..., after])).max(axis=0)
    return float(STEPS * max(off.max(), _moved(seen, lighting, np.unique(faces.source[smooth])).max(initial=0.0)))


def _moved(seen: Seen, lighting: Lighting, source: Ints) -> Floats:
    """How far shades in the middles of sides of faces (n,) of smooth surfaces are off those that are seen there,
    because the faces are off the surfaces."""
    view = seen.view
    source = source[seen.smooth[view.face_item[source]]]
    if not len(source):
        return np.zeros(0)
    position, offsets = ragged.take(view.offsets, source)
    after = ragged.following(offsets)
    points, normals = view.points[:, view.corners[position]], lighting.normals[:, position]
    shade = np.atleast_2d(corner_shades_of(view, lighting, points, offsets, source).total)
    side, half = points[:, after] - points, 0.5 * (normals + normals[:, after])
    # The height of a cubic in both tangent planes over the middle of its chord.
    height = (dot(normals[:, after], side) - dot(normals, side)) / 8.0
    ray = np.array([0.0, 0.0, 1.0])[:, None] if view.eye is None else view.eye[:, None] - points - 0.5 * side
    with np.errstate(divide="ignore", invalid="ignore"):
        along = height * dot(half, half) / dot(half, ray) * dot(ray, side) / dot(side, side)
    part = np.minimum(np.abs(np.nan_to_num(along)), FARTHEST)
    return np.asarray(part * np.abs(shade[..., after] - shade).max(axis=0))
