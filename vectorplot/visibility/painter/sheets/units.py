"""What is blended as one: parts of transparent items that hang together, or do not lie on one another."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.repair.pieces import pieces_of_faces
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.mikado import component_ranks


def connected_parts(view: View, faces: ImageFaces, item: Ints) -> Ints:
    """(n,) numbers of the parts that transparent items (n,) consist of, -1 for the polygons of others: faces of one
    item hang together where they have corners in common, or in the same place."""
    part = np.full(len(faces), -1, dtype=np.intp)
    clear = np.flatnonzero(item >= 0)
    if not len(clear):
        return part
    face = np.flatnonzero(np.isin(view.face_item, view.face_item[faces.source[clear]]))
    position, offsets = ragged.take(view.offsets, face)
    used, corner = np.unique(view.corners[position], return_inverse=True)
    count, piece = pieces_of_faces(len(used), corner, offsets)
    if count > len(np.unique(view.face_item[face])):
        _, place = np.unique(view.points[:, used], axis=1, return_inverse=True)
        count, piece = pieces_of_faces(len(used), place.ravel()[corner], offsets)
    _, number = np.unique(item[clear] * count + piece[np.searchsorted(face, faces.source[clear])], return_inverse=True)
    part[clear] = number
    return part


def units_of(item: Ints, part: Ints, before: Ints, after: Ints) -> Ints:
    """(n,) what is blended as one of polygons of items (n,) and parts (n,), -1 for opaque ones; before (k,) lie behind
    after (k,).

    Parts of one item on which as many others of it lie, one on the other, make one unit, for they do not overlap; so
    do parts that lie on one another in circles.
    """
    own = (item[before] == item[after]) & (part[before] != part[after]) & (item[before] >= 0)
    count = int(part.max(initial=-1)) + 1
    pair = np.unique(part[before[own]] * count + part[after[own]])
    below, above = pair // max(count, 1), pair % max(count, 1)
    circle = component_ranks(count, below, above)
    below, above = circle[below], circle[above]
    below, above = below[below != above], above[below != above]
    level = np.zeros(count, dtype=np.intp)
    while True:
        higher = level.copy()
        np.maximum.at(higher, above, level[below] + 1)
        if np.array_equal(higher, level):
            break
        level = higher
    unit = np.full(len(item), -1, dtype=np.intp)
    clear = np.flatnonzero(item >= 0)
    key = item[clear] * np.int64(count) + level[circle[part[clear]]]
    unit[clear] = np.unique(key, return_inverse=True)[1]
    return unit
