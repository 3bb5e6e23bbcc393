"""Faces above and below planes, and cut by them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.clipping.clipped_polygons import Polygons, cut_polygons
from vectorplot.visibility.painter.image_faces import ImageFaces


def heights_above(faces: ImageFaces, planes: Floats) -> Floats:
    """(c,) heights of the corners of faces above planes (5,n), one for each face."""
    x0, y0, h0, slope_x, slope_y = np.repeat(planes, np.diff(faces.offsets), axis=1)
    x, y, height = faces.points
    return np.asarray(height - h0 - slope_x * (x - x0) - slope_y * (y - y0), dtype=np.float64)


def height_span(faces: ImageFaces, which: Ints, planes: Floats) -> tuple[Floats, Floats]:
    """Least and largest height of the corners of some faces above planes (5,n)."""
    some = faces.some(which)
    height = heights_above(some, planes)
    if not len(which):
        return np.zeros(0), np.zeros(0)
    return np.minimum.reduceat(height, some.offsets[:-1]), np.maximum.reduceat(height, some.offsets[:-1])


def in_two(faces: ImageFaces, which: Ints, planes: Floats, steepness: Floats, tolerance: float) -> Bools:
    """(n,) whether planes (5,n) cut faces (n,) in two: both parts reach farther than what counts as on the plane."""
    low, high = height_span(faces, which, planes)
    limit = tolerance * np.maximum(faces.steepness[which], steepness)
    return np.asarray((low < -limit) & (high > limit), dtype=np.bool_)


def halves(faces: ImageFaces, planes: Floats, steepness: Floats, tolerance: float) -> tuple[ImageFaces, ImageFaces]:
    """The parts of faces below and above planes (5,n), one for each face; every face has both."""
    if not len(faces):
        return faces, faces
    limit = np.repeat(tolerance * np.maximum(faces.steepness, steepness), np.diff(faces.offsets))
    height = heights_above(faces, planes)
    height[np.abs(height) <= limit] = 0.0
    polygons = Polygons(faces.points.T, faces.offsets)
    parts = [cut_polygons(polygons, side * height)[0] for side in (-1.0, 1.0)]
    below, above = (
        ImageFaces(
            np.ascontiguousarray(part.points.T), part.offsets, faces.planes, faces.source, faces.rank, faces.bulges
        )
        for part in parts
    )
    return below, above


def dense(*keys: Ints) -> Ints:
    """(n,) ranks from 0 by several keys, the first one counting most; equal keys have equal ranks."""
    order = np.lexsort(keys[::-1])
    new = np.zeros(len(order), dtype=np.bool_)
    for key in keys:
        new[1:] |= key[order][1:] != key[order][:-1]
    rank = np.empty(len(order), dtype=np.intp)
    rank[order] = np.cumsum(new)
    return rank
