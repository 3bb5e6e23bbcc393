"""Polygons of the image that are seen through windows: mirrors, or faces of transparent bodies."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.convex.plane_cuts import polygon_areas
from vectorplot.geometry.convex.polygon_clipping import clipped_by_convex, inside_convex
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, some
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.projected_faces import Floats32


@dataclass(frozen=True, eq=False)
class SeenThrough:
    """Polygons to be painted right after the windows they are seen through, in this order.

    points (3,c) in the image, as of ImageFaces: heights are those of the doubles; offsets (m+1,); source (m,): the face
    of the view that is seen; window (m,), ascending: the painted polygon each one is painted after; pane (m,): the face
    of the view that this window is, or is a part of: the mirror; decal (m,): the decal on that face that is seen, -1
    for the face itself.
    """

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    source: Ints = field(metadata=EACH_LINE)
    window: Ints = field(metadata=EACH_LINE)
    pane: Ints = field(metadata=EACH_LINE)
    decal: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.source)

    def some(self, which: Ints) -> SeenThrough:
        """Some of the polygons, in the order asked for."""
        return some(self, which)


def nothing_seen() -> SeenThrough:
    """No polygons at all."""
    none = np.zeros(0, dtype=np.intp)
    return SeenThrough(np.zeros((3, 0)), np.zeros(1, dtype=np.intp), none, none, none, none)


def seen_through(faces: ImageFaces, painted: ImageFaces, windows: Ints, tolerance: float) -> SeenThrough:
    """Faces (of what is behind windows, back to front), clipped with the windows (n,), numbers of painted polygons.

    Faces whose rectangles do not meet a window's are not looked at, and those wholly inside are not clipped.
    Source: Glaeser, section 6.4.
    """
    if not len(faces) or not len(windows):
        return nothing_seen()
    import shapely

    left, right, bottom, top = faces.box[:4]
    tree = shapely.STRtree(shapely.box(left, bottom, right, top), node_capacity=16)
    left, right, bottom, top = painted.box[:4, windows]
    window, face = tree.query(shapely.box(left, bottom, right, top))
    order = np.lexsort((face, window))
    window, face = windows[window[order]], face[order]
    points, offsets, pair = clipped_pairs(faces, painted, face, window, tolerance)
    window, source = window[pair], faces.source[face[pair]]
    faces_only = np.full(len(window), -1, dtype=np.intp)
    return sorted_by_window(SeenThrough(points, offsets, source, window, painted.source[window], faces_only))


def _wide(points: Floats, offsets: Ints, pair: Ints, tolerance: float) -> tuple[Floats, Ints, Ints]:
    """The polygons that are not narrower than a tolerance in the image."""
    if not len(pair):
        return points, offsets, pair
    normal, spread = polygon_areas(points * [[1.0], [1.0], [0.0]], offsets)
    kept = np.flatnonzero(np.abs(normal[2]) > tolerance * spread)
    position, offsets = ragged.take(offsets, kept)
    return points[:, position], offsets, pair[kept]


def sorted_by_window(seen: SeenThrough) -> SeenThrough:
    """The same polygons by windows; those of one window in the order they have."""
    return seen.some(np.argsort(seen.window, kind="stable"))


def joined_seen(parts: list[SeenThrough]) -> SeenThrough:
    """Polygons of different windows together, by windows."""
    return sorted_by_window(one_after_another(parts))


def one_after_another(parts: list[SeenThrough]) -> SeenThrough:
    """The polygons of all parts as they come."""
    return joined((nothing_seen(), *parts))


def clipped_pairs(
    faces: ImageFaces, windows: ImageFaces, face: Ints, window: Ints, tolerance: float
) -> tuple[Floats, Ints, Ints]:
    """Faces (n,) clipped with windows (n,): points (3,c), offsets (m+1,), and the pair each part is of, ascending.

    Faces wholly inside are not clipped, and parts narrower than the tolerance left out.
    """
    return _wide(*_parts(faces, windows, face, window, tolerance), tolerance)


def _parts(
    faces: ImageFaces, painted: ImageFaces, face: Ints, window: Ints, tolerance: float
) -> tuple[Floats, Ints, Ints]:
    corner, starts = ragged.take(faces.offsets, face)
    border, borders = ragged.take(painted.offsets, window)
    points, sides = faces.points[:, corner], painted.points[:2, border]
    whole = inside_convex(points, starts, sides, borders, tolerance=tolerance)
    if whole.all():
        return points, starts, np.arange(len(face))
    partly = np.flatnonzero(~whole)
    corner, some = ragged.take(starts, partly)
    border, some_borders = ragged.take(borders, partly)
    cut, ends, kept = clipped_by_convex(points[:, corner], some, sides[:, border], some_borders, tolerance=tolerance)
    kept_whole = np.flatnonzero(whole)
    corner, whole_ends = ragged.take(starts, kept_whole)
    pair = np.concatenate([kept_whole, partly[kept]])
    order = np.argsort(pair, kind="stable")
    every = np.concatenate([points[:, corner], cut], axis=1)
    offsets = np.concatenate([whole_ends, ends[1:] + whole_ends[-1]])
    position, offsets = ragged.take(offsets, order)
    return every[:, position], offsets, pair[order]


def near_windows(box: Floats | Floats32, windows: Floats) -> Bools:
    """(n,) which rectangles (4,n), smallest and largest x, smallest and largest y, meet the common one of windows
    (4,w)."""
    left, right, bottom, top = windows
    across = (box[1] >= left.min(initial=np.inf)) & (box[0] <= right.max(initial=-np.inf))
    along = (box[3] >= bottom.min(initial=np.inf)) & (box[2] <= top.max(initial=-np.inf))
    return np.asarray(across & along, dtype=np.bool_)
