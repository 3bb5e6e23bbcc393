"""Hidden lines by painting: every face erases what is behind it, and then its edges are drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import next_positions
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points


@dataclass(frozen=True, eq=False)
class Erased:
    """A sequence of fills in the colour of the paper and of edges, which leaves the lines that one sees.

    Parameters
    ----------
    start, end : (3, e) array of float
        The edges in the image, as of ImageFaces.
    first : (n+1,) array of int
        After the polygon k of the painted faces is filled, the edges first[k] to first[k+1] are drawn.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> from vectorplot.textbook import erasing_edges
    >>> from vectorplot.visibility import painters_order
    >>> view = look(vp.Scene((vp.Item("cube", box((1, 1, 1))),)), vp.Camera((5, 4, 3)))
    >>> erased = erasing_edges(view, painters_order(view).faces)
    >>> len(erased), erased.first.tolist()
    (12, [0, 4, 8, 12])
    """

    start: Floats
    end: Floats
    first: Ints

    def __len__(self) -> int:
        return int(self.start.shape[1])


def erasing_edges(view: View, painted: ImageFaces, drawn: Bools | None = None) -> Erased:
    """The edges to be drawn after each face has been erased, in the painter's order.

    Parameters
    ----------
    view : View
        What is drawn.
    painted : ImageFaces
        The polygons, back to front.
    drawn : (c,) array of bool, optional
        Which sides of the faces of the view, from each corner to the next, are drawn at all; all but the diagonals of
        cut faces where None.

    Returns
    -------
    Erased
        Sides along which the painter cut a face are no edges.

    Notes
    -----
    Source: Glaeser, section 7.1, figure 1.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> from vectorplot.textbook import erasing_edges
    >>> from vectorplot.visibility import painters_order
    >>> view = look(vp.Scene((vp.Item("cube", box((1, 1, 1))),)), vp.Camera((5, 4, 3)))
    >>> faces = painters_order(view).faces
    >>> len(faces), len(erasing_edges(view, faces)), len(erasing_edges(view, faces, np.zeros(24, dtype=bool)))
    (3, 12, 0)
    """
    drawn = ~view.inner if drawn is None else drawn
    edge = np.flatnonzero(drawn)
    face = ragged.owner(view.face_sizes)[edge]
    start, end, known = _images(view, view.corners[edge], view.corners[view.after(edge)])
    edge_of = np.searchsorted(face[known], np.arange(view.face_count + 1))
    start, end = start[:, known], end[:, known]
    owner = ragged.owner(np.diff(painted.offsets))
    side_end = next_positions(painted.offsets, np.arange(len(owner))) if len(owner) else owner
    source = painted.source[owner]
    counts = np.diff(edge_of)[source]
    side = ragged.owner(counts)
    which = edge_of[:-1][source[side]] + np.arange(len(side)) - np.repeat(ragged.starts(counts), counts)
    on = _on(painted.points[:2, side], start[:2, which], end[:2, which], view.tolerance)
    on &= _on(painted.points[:2, side_end[side]], start[:2, which], end[:2, which], view.tolerance)
    kept = np.unique(side[on])
    counts = np.bincount(owner[kept], minlength=len(painted))
    return Erased(painted.points[:, kept], painted.points[:, side_end[kept]], ragged.offsets(counts))


def _images(view: View, first: Ints, second: Ints) -> tuple[Floats, Floats, Ints]:
    """The images of edges between vertices, cut off at the near plane, and which edges have one."""
    start, end = view.points[:, first], view.points[:, second]
    if view.eye is None:
        return image_points(view, start), image_points(view, end), np.arange(len(first))
    near, far = view.depth[first] - view.near, view.depth[second] - view.near
    gap = np.where((near < 0.0) != (far < 0.0), near - far, 1.0)
    crossing = start + (near / gap) * (end - start)
    begin = np.where(near < 0.0, crossing, start)
    finish = np.where(far < 0.0, crossing, end)
    known = np.flatnonzero((near >= 0.0) | (far >= 0.0))
    image = [np.zeros((3, len(first))), np.zeros((3, len(first)))]
    image[0][:, known], image[1][:, known] = image_points(view, begin[:, known]), image_points(view, finish[:, known])
    return image[0], image[1], known


def _on(points: Floats, start: Floats, end: Floats, tolerance: float) -> Bools:
    """(n,) which points (2,n) lie on segments; near means within a few tolerances."""
    along = end - start
    length = np.sqrt((along * along).sum(axis=0))
    unit = along / np.where(length > 0.0, length, 1.0)
    arm = points - start
    off = np.abs(unit[0] * arm[1] - unit[1] * arm[0])
    at = (unit * arm).sum(axis=0)
    # Places of cuts are rounded in the image, where edges may be long.
    limit = 4.0 * tolerance * (1.0 + length)
    return np.asarray((off <= limit) & (at >= -limit) & (at <= length + limit), dtype=np.bool_)


def interleaved(painted: ImageFaces, erased: Erased) -> list[tuple[Floats, Floats, Floats]]:
    """The sequence for a format that is written one mark after the other.

    Parameters
    ----------
    painted : ImageFaces
        The polygons, back to front.
    erased : Erased
        As of erasing_edges.

    Returns
    -------
    list of ((3, k) array, (3, e) array, (3, e) array)
        The corners of a polygon, then the starts and the ends of the edges to be drawn on it.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> from vectorplot.textbook import erasing_edges, interleaved
    >>> from vectorplot.visibility import painters_order
    >>> view = look(vp.Scene((vp.Item("cube", box((1, 1, 1))),)), vp.Camera((5, 4, 3)))
    >>> faces = painters_order(view).faces
    >>> marks = interleaved(faces, erasing_edges(view, faces))
    >>> [(corners.shape[1], starts.shape[1]) for corners, starts, ends in marks]
    [(4, 4), (4, 4), (4, 4)]
    """
    result = []
    for number in range(len(painted)):
        position, _ = ragged.take(painted.offsets, np.array([number]))
        edges = slice(int(erased.first[number]), int(erased.first[number + 1]))
        result.append((painted.points[:, position], erased.start[:, edges], erased.end[:, edges]))
    return result
