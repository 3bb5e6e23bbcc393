"""Closed bodies that do not cross themselves: of them only the outside can be seen."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.bounds.boxes import PAIRS_AT_ONCE, overlapping_pairs
from vectorplot.geometry.columns import cross, dot
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.circulation import unbalanced_vertices
from vectorplot.geometry.repair.winding import components, edge_uses, inside_out, signed_volumes, turned_faces
from vectorplot.scene.view import View

AXIS_SHIFT = 16.0
"""The extent of a view is less: items that are moved apart by multiples of it do not meet."""


def closed_items(view: View) -> Bools:
    """(i,) the items whose faces close, wound alike."""
    closed = np.ones(len(view.item_vertices) - 1, dtype=np.bool_)
    loose = np.flatnonzero(unbalanced_vertices(view.points.shape[1], view.corners, view.offsets))
    closed[np.searchsorted(view.item_vertices, loose, side="right") - 1] = False
    return closed


def body_sides(view: View) -> Ints:
    """(i,) 1 for items that close, do not cross themselves and are wound counter-clockwise as seen from outside, -1 for
    such that are wound the other way round, 0 for all others, both sides of whose faces can be seen.

    A body without crossings keeps its inside on one side everywhere; pieces of it that are wound against the others are
    cavities, or else it counts as crossing itself. Faces of different pieces that touch, and such of one piece that
    touch without sharing a corner, cross.
    """
    side = np.zeros(len(view.item_vertices) - 1, dtype=np.intp)
    face = np.flatnonzero(closed_items(view)[view.face_item])
    if not len(face):
        return side
    position, offsets = ragged.take(view.offsets, face)
    body = Mesh(np.ascontiguousarray(view.points.T), view.corners[position], offsets)
    item = view.face_item[face]
    sixfold = np.bincount(item, signed_volumes(body), minlength=len(side))
    side[:] = np.sign(sixfold)
    upright = turned_faces(body, sixfold[item] < 0.0)
    number, piece = components(upright, edge_uses(upright))
    volume = np.bincount(piece, signed_volumes(upright), minlength=number)
    # One at a time: cavities lie in pieces of their own item.
    for one in np.unique(item[volume[piece] < 0.0]).tolist():
        own = np.flatnonzero(item == one)
        position, ends = ragged.take(upright.offsets, own)
        alone = Mesh(upright.vertices, upright.corners[position], ends)
        which, number_of = np.unique(piece[own], return_inverse=True)
        if inside_out(alone, number_of.ravel(), len(which)).any():
            side[one] = 0
    side[crossing_items(view, face[side[item] != 0])] = 0
    return side


def crossing_items(view: View, face: Ints) -> Ints:
    """The items of which some faces (n,) meet others of the same item with which they share no corner."""
    position, offsets = ragged.take(view.offsets, face)
    fans, of = ragged.fans(offsets)
    triangles = view.corners[position[fans]]
    item = view.face_item[face[of]]
    points = view.points[:, triangles]
    shift = np.zeros((3, len(item)))
    shift[0] = AXIS_SHIFT * item
    low, high = points.min(axis=2) + shift - view.tolerance, points.max(axis=2) + shift + view.tolerance
    one, two = overlapping_pairs(low, high)
    found = np.zeros(len(view.item_vertices) - 1, dtype=np.bool_)
    for start in range(0, len(one), PAIRS_AT_ONCE):
        a, b = one[start : start + PAIRS_AT_ONCE], two[start : start + PAIRS_AT_ONCE]
        kept = ~found[item[a]] & (of[a] != of[b])
        for k in range(3):
            for m in range(3):
                kept &= triangles[a, k] != triangles[b, m]
        a, b = a[kept], b[kept]
        met = _meet(points[:, a], points[:, b], view.tolerance)
        found[item[a[met]]] = True
    return np.flatnonzero(found)


def _meet(one: Floats, two: Floats, tolerance: float) -> Ints:
    """Which pairs of triangles (3,n,3) no plane keeps apart by more than a tolerance: none that is parallel to one of
    both, nor to an edge of each.

    Source: Gottschalk, Lin, Manocha, OBBTree (1996): separating axes of convex polyhedra.
    """
    left = np.arange(one.shape[1])
    edges = [[shape[:, :, (k + 1) % 3] - shape[:, :, k] for k in range(3)] for shape in (one, two)]
    axes = [(edges[0][0], edges[0][1]), (edges[1][0], edges[1][1])]
    axes += [(along, across) for along in edges[0] for across in edges[1]]
    normals = [cross(*axes[0]), cross(*axes[1])]
    for along, across in axes:
        left = left[~_apart(one, two, left, cross(along[:, left], across[:, left]), tolerance)]
    # Of triangles in one plane: what is across their edges.
    for shape, normal in zip(edges, normals, strict=True):
        for edge in shape:
            left = left[~_apart(one, two, left, cross(edge[:, left], normal[:, left]), tolerance)]
    return left


def _apart(one: Floats, two: Floats, which: Ints, axis: Floats, tolerance: float) -> Bools:
    """(k,) whether pairs of triangles leave a gap along axes (3,k)."""
    gap = tolerance * np.sqrt(dot(axis, axis))
    first, second = (np.stack([dot(axis, shape[:, which, k]) for k in range(3)]) for shape in (one, two))
    below, above = first.max(axis=0) + gap < second.min(axis=0), second.max(axis=0) + gap < first.min(axis=0)
    return np.asarray(below | above)
