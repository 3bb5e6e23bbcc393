"""Shapes cut by parallel planes: of two slices the one on the far side of a plane between them is drawn first."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.clipping.clipped_polygons import Polygons, cut_polygons
from vectorplot.geometry.polylines import joined, some
from vectorplot.visibility.painter.cuts.cutting import Pairs, cut_into_order
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.pairs.box_pairs import box_pairs
from vectorplot.visibility.painter.pairs.face_pairs import APART, face_relations


def slice_order(levels: ArrayLike, eye: float) -> Ints:
    """The slices between parallel planes, back to front.

    Parameters
    ----------
    levels : (k+1,) array_like of float
        Ascending: slice i lies between levels i and i+1.
    eye : float
        Of the same coordinate; infinite where the rays are parallel.

    Returns
    -------
    (k,) array of int
        The slices below the eye come first, upwards, then those above it, downwards, and last the one the eye is in.

    Raises
    ------
    InputError
        Where levels do not ascend, or are fewer than two.

    Notes
    -----
    Source: Glaeser, sections 5.2 to 5.4 (the plane through the eye).

    Examples
    --------
    >>> from vectorplot import visibility
    >>> visibility.slice_order([0.0, 1.0, 2.0, 3.0], eye=1.5).tolist()
    [0, 2, 1]
    """
    level = np.asarray(levels, dtype=np.float64)
    if level.ndim != 1 or len(level) < 2 or not (np.diff(level) > 0.0).all():
        raise InputError("the planes between slices must ascend, and be two at least")
    own = int(np.searchsorted(level, eye, side="right")) - 1
    count = len(level) - 1
    middle = np.arange(own, min(own + 1, count)) if own >= 0 else np.arange(0)
    return np.concatenate([np.arange(min(own, count)), np.arange(count - 1, own, -1), middle]).astype(np.intp)


def eye_coordinate(eye: ArrayLike, axis: int) -> float:
    """A coordinate of the eye (3,); of a direction towards the eye (x, y, z, 0) plus or minus infinity."""
    place = np.asarray(eye, dtype=np.float64)
    if place.shape not in ((3,), (4,)) or not np.isfinite(place).all() or (len(place) == 4 and place[3] != 0.0):
        raise InputError("an eye has three coordinates, a direction towards it is (x, y, z, 0)")
    if len(place) == 3:
        return float(place[axis])
    # Where the rays run along the planes the slices do not cover one another, whatever their order.
    return float("-inf") if place[axis] < 0.0 else float("inf")


def cut_into_slices(points: ArrayLike, offsets: Ints, axis: int, levels: ArrayLike) -> tuple[Polygons, Ints, Ints]:
    """Convex polygons cut by the planes where a coordinate has one of some levels.

    Parameters
    ----------
    points : (c, 3) array_like of float
        The corners of all polygons, one after the other.
    offsets : (n+1,) array of int
        Polygon i has the corners offsets[i] to offsets[i+1].
    axis : int
        Which coordinate: 0, 1 or 2.
    levels : (k,) array_like of float
        Ascending.

    Returns
    -------
    pieces : Polygons
        What the polygons fall into; new corners lie on the planes to the last digit.
    source : (p,) array of int
        The polygon each piece comes from.
    slices : (p,) array of int
        The slice each piece lies in, 0 below the first level, k above the last.

    Notes
    -----
    All polygons are halved at once, so that the price grows with the pieces and the logarithm of the levels.
    Degenerate: a polygon in one of the planes lies in the slice above it.

    Source: Glaeser, section 5.4, figure 6 (horizontal slices).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> corners = [(0, 0, 0), (1, 0, 0), (1, 0, 4), (0, 0, 4)]
    >>> pieces, source, slices = visibility.cut_into_slices(corners, np.array([0, 4]), axis=2, levels=[1.0, 3.0])
    >>> len(pieces), source.tolist(), slices.tolist()
    (3, [0, 0, 0], [0, 1, 2])
    """
    level = np.asarray(levels, dtype=np.float64)
    pieces, source = Polygons(np.array(points, dtype=np.float64), offsets), np.arange(len(offsets) - 1)
    if not len(source):
        return pieces, source, source
    coordinate = pieces.points[:, axis]
    first = np.searchsorted(level, np.minimum.reduceat(coordinate, offsets[:-1]), side="right")
    last = np.searchsorted(level, np.maximum.reduceat(coordinate, offsets[:-1]), side="left")
    while (across := last > first).any():
        whole, cut = np.flatnonzero(~across), np.flatnonzero(across)
        middle = (first[cut] + last[cut] + 1) // 2
        split = some(pieces, cut)
        limit = np.repeat(level[middle - 1], np.diff(split.offsets))
        height = split.points[:, axis] - limit
        below, above = (_cut_at(split, side * height, axis, level[middle - 1]) for side in (-1.0, 1.0))
        pieces = joined((some(pieces, whole), below, above))
        source = np.concatenate([source[whole], source[cut], source[cut]])
        first, last = (
            np.concatenate([first[whole], first[cut], middle]),
            np.concatenate([last[whole], middle - 1, last[cut]]),
        )
    return pieces, source, first


def _cut_at(polygons: Polygons, height: Floats, axis: int, level: Floats) -> Polygons:
    part, is_new = cut_polygons(polygons, height)
    part.points[is_new, axis] = np.repeat(level, np.diff(part.offsets))[is_new]
    return part


def sliced_order(faces: ImageFaces, place: Ints, tolerance: float) -> ImageFaces:
    """Faces back to front, where it is known of each in which slice it lies.

    Parameters
    ----------
    faces : ImageFaces
        As of image_faces.
    place : (n,) array of int
        The rank of each one's slice in the order of drawing, as of slice_order.
    tolerance : float
        What counts as distance zero, that of the view.

    Returns
    -------
    ImageFaces
        Only faces of one slice are compared, and cut where they must be.

    Notes
    -----
    The price grows with the faces, however many slices overlap in the image.

    Source: Glaeser, section 5.3 (ribbons of a slice by priority).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> cubes = tuple(vp.Item(name, geometry.box((1, 1, 1))) for name in ("one", "two"))
    >>> view = scene.look(vp.Scene(cubes), vp.Camera((5, 4, 3)))
    >>> faces = visibility.image_faces(view, np.array([1, 2, 7, 8]))  # two of each cube
    >>> ordered = visibility.sliced_order(faces, np.array([1, 1, 0, 0]), view.tolerance)
    >>> view.face_item[ordered.source].tolist()
    [1, 1, 0, 0]
    """
    found = related(faces, pairs_in_slices(faces, place, tolerance), tolerance)
    pieces, places, _ = cut_into_order(faces, place, found, tolerance)
    return pieces.some(np.lexsort((pieces.rank, places)))


def pairs_in_slices(faces: ImageFaces, place: Ints, tolerance: float) -> Pairs:
    """Pairs of pieces of one slice whose boxes in the image overlap, not compared yet."""
    box = faces.box[:4].copy()
    # Side by side, so that only pieces of one slice meet.
    box[:2] += (float(np.ptp(box[:2])) + 1.0 if len(faces) else 1.0) * place
    lots = [np.zeros((2, 0), dtype=np.intp), *(np.stack(pair) for pair in box_pairs(box, tolerance))]
    first, second = np.concatenate(lots, axis=1)
    return Pairs(first, second, np.full(len(first), APART, dtype=np.int8))


def related(faces: ImageFaces, pairs: Pairs, tolerance: float) -> Pairs:
    """Those of some pairs whose images overlap, compared."""
    found = Pairs(pairs.first, pairs.second, face_relations(faces, pairs.first, pairs.second, tolerance))
    return found.some(found.codes != APART)
