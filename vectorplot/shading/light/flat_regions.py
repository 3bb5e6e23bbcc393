"""Faces that lie in one plane, side by side: they have one shade, however they are cut."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.view import View
from vectorplot.shading.light.face_shades import face_middles
from vectorplot.tolerances.of_extent import FLAT_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.visibility.projected_faces import newell


def plane_numbers(view: View) -> Ints:
    """(f,) the number of the region that each face of a view is a part of: of the faces of one item that lie in one
    plane, and hang together by edges of two faces.

    A corner may be off the plane by FLAT_OF_EXTENT; where a region would be bent more than that, as on surfaces of very
    small faces, only what is flat within the tolerance of the view is taken together.
    Degenerate: faces wound against each other, and those without area, stand alone.
    """
    count = view.face_count
    number = np.arange(count)
    if not count:
        return number
    one, other = _neighbours(view)
    normal, _, first = newell(view, number)
    area = np.sqrt((normal * normal).sum(axis=0))
    unit = normal / np.where(area > 0.0, area, 1.0)
    alike = (unit[:, one] * unit[:, other]).sum(axis=0) > 0.0
    one, other = one[alike], other[alike]
    swap = area[other] > area[one]
    large, small = np.where(swap, other, one), np.where(swap, one, other)
    height = _greatest_height(view, small, unit[:, large], view.points[:, first[large]])
    bent = np.ones(count, dtype=np.bool_)
    for allowed in (max(FLAT_OF_EXTENT, view.tolerance), view.tolerance):
        near = np.flatnonzero((height <= allowed) & bent[large] & bent[small])
        found = _hanging_together(count, large[near], small[near])
        flat = bent & ~_bent(view, found, normal, allowed)
        number = np.where(flat, count + found, number)
        bent &= ~flat
    return np.unique(number, return_inverse=True)[1].ravel()


def plane_middles(view: View, plane: Ints) -> Floats:
    """(3,f) the middle of the region that each face belongs to: of several faces the mean of theirs, by area."""
    middle = face_middles(view)
    count = np.bincount(plane) if len(plane) else plane
    several = np.flatnonzero(count[plane] > 1)
    if not len(several):
        return middle
    normal, _, _ = newell(view, several)
    # A part without area still has a place.
    weight = np.sqrt((normal * normal).sum(axis=0)) + LEAST_DIVISOR
    total = np.bincount(plane[several], weight, minlength=len(count))
    result = middle.copy()
    for row, out in zip(middle, result, strict=True):
        mean = np.bincount(plane[several], weight * row[several], minlength=len(count)) / np.where(total > 0, total, 1)
        out[several] = mean[plane[several]]
    return result


def _neighbours(view: View) -> tuple[Ints, Ints]:
    """Pairs of faces with a common edge that no other face has."""
    start, end = view.corners, view.corners[view.after(np.arange(len(view.corners)))]
    key = np.minimum(start, end) * view.points.shape[1] + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    first = np.flatnonzero(np.diff(key[order], prepend=-1))
    pairs = first[np.diff(np.append(first, len(key))) == 2]
    face = ragged.owner(view.face_sizes)[order]
    return face[pairs], face[pairs + 1]


def _greatest_height(view: View, face: Ints, normal: Floats, place: Floats) -> Floats:
    """(n,) how far the corners of faces (n,) are off planes through places (3,n) with unit normals (3,n)."""
    if not len(face):
        return np.zeros(0)
    sizes = view.face_sizes[face]
    ends = ragged.offsets(sizes)
    position = ragged.ranges(view.offsets[face], sizes)
    owner = ragged.owner(sizes)
    arm = view.points[:, view.corners[position]] - place[:, owner]
    return np.asarray(np.maximum.reduceat(np.abs((arm * normal[:, owner]).sum(axis=0)), ends[:-1]))


def _hanging_together(count: int, one: Ints, other: Ints) -> Ints:
    """(f,) the number of the component of each face, in a graph of some pairs."""
    if not len(one):
        return np.arange(count)
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(one)), (one, other)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.intp)


def _bent(view: View, region: Ints, normal: Floats, allowed: float) -> Bools:
    """(f,) the faces of regions that are farther off their mean planes than is allowed."""
    size = int(region.max()) + 1
    mean: Floats = np.stack([np.bincount(region, row, minlength=size) for row in normal]).astype(np.float64)
    length = np.sqrt((mean * mean).sum(axis=0))
    mean /= np.where(length > 0.0, length, 1.0)
    face = np.arange(view.face_count)
    some = np.zeros((3, size))
    some[:, region] = view.points[:, view.corners[view.offsets[:-1]]]
    height = _greatest_height(view, face, mean[:, region], some[:, region])
    worst = np.zeros(size)
    np.maximum.at(worst, region, height)
    return np.asarray(worst[region] > 2.0 * allowed, dtype=np.bool_)
