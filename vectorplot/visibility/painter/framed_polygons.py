"""Painted polygons inside a frame."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry import ragged
from vectorplot.geometry.convex.polygon_clipping import clipped_by_convex
from vectorplot.visibility.painter.image_faces import ImageFaces


def framed_faces(faces: ImageFaces, low: Floats, high: Floats, tolerance: float) -> ImageFaces:
    """The polygons inside the rectangle of the image from low to high (2,), in their order.

    Those wholly inside stay as they are. Source: Glaeser, section 2.5 (Hodgman and Sutherland).
    """
    left, right, bottom, top = faces.box[:4]
    outside = (left >= high[0]) | (right <= low[0]) | (bottom >= high[1]) | (top <= low[1])
    inside = (left >= low[0]) & (right <= high[0]) & (bottom >= low[1]) & (top <= high[1])
    if inside.all():
        return faces
    cut = np.flatnonzero(~outside & ~inside)
    corner, offsets = ragged.take(faces.offsets, cut)
    frame = np.array([[low[0], high[0], high[0], low[0]], [low[1], low[1], high[1], high[1]]])
    points, ends, kept = clipped_by_convex(
        faces.points[:, corner],
        offsets,
        np.tile(frame, (1, len(cut))),
        np.arange(0, 4 * len(cut) + 1, 4),
        tolerance=tolerance,
    )
    whole = np.flatnonzero(inside)
    corner, whole_ends = ragged.take(faces.offsets, whole)
    number = np.concatenate([whole, cut[kept]])
    every = np.concatenate([faces.points[:, corner], points], axis=1)
    offsets = np.concatenate([whole_ends, ends[1:] + whole_ends[-1]])
    order = np.argsort(number, kind="stable")
    corner, offsets = ragged.take(offsets, order)
    number = number[order]
    return ImageFaces(every[:, corner], offsets, faces.planes[:, number], faces.source[number], faces.rank[number])
