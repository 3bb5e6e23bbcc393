"""Faces after the projective map that makes all sight lines parallel, and painted polygons inside a frame."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import may_stop
from vectorplot.geometry.clipping import Polygons, cut_polygons
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.polygon_cuts import clipped_by_convex
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, LineElements
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import EVERYWHERE, ProjectedFaces, body_sides

# Faces after the projective map that makes all sight lines parallel: planes stay planes, and every face is a convex
# polygon over its image.


@dataclass(frozen=True, eq=False)
class ImageFaces(LineElements):
    """Convex polygons in the image, after the projective map that makes all sight lines parallel.

    points: (3, c) x and y in the image plane, and the height above it, which grows towards the eye; offsets: (n+1,)
    polygon i has the points offsets[i] to offsets[i+1]; planes: (5, n) x, y and height of a point of each plane and its
    two slopes; source: (n,) the face of the view each polygon is (a part of); rank: (n,) the order in which faces that
    lie in one plane are drawn; bulges: (12, n) how far the surfaces in whose place they are bulge over them, as of
    with_bulges.
    """

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    planes: Floats = field(metadata=EACH_LINE | IN_COLUMNS)
    source: Ints = field(metadata=EACH_LINE)
    rank: Ints = field(metadata=EACH_LINE)
    bulges: Floats | None = field(default=None, metadata=EACH_LINE | IN_COLUMNS)

    def __len__(self) -> int:
        return len(self.source)

    @cached_property
    def box(self) -> Floats:
        """(6,n) smallest and largest x, y and height."""
        extremes = (np.minimum, np.maximum)
        return np.stack([over_corners(extreme, row, self.offsets) for row in self.points for extreme in extremes])

    def heights(self, face: Ints, x: Floats, y: Floats) -> Floats:
        """(..., p) heights of the planes of faces (p,) above the points x, y (..., p) of the image."""
        x0, y0, h0, slope_x, slope_y = self.planes[:, face]
        return np.asarray(h0 + slope_x * (x - x0) + slope_y * (y - y0), dtype=np.float64)

    @cached_property
    def steepness(self) -> Floats:
        """(n,) how many tolerances in height one tolerance in the image makes, and one more."""
        return np.asarray(1.0 + np.abs(self.planes[3]) + np.abs(self.planes[4]), dtype=np.float64)


def over_corners(reduce: np.ufunc, row: Floats, offsets: Ints) -> Floats:
    """(n,) sums, or smallest or largest values, of a row (c,) over the corners of each polygon; none is empty."""
    may_stop()
    count = len(offsets) - 1
    size = len(row) // count if count else 0
    if not count or (offsets != np.arange(0, len(row) + 1, size)[: count + 1]).any():
        return np.asarray(reduce.reduceat(row, offsets[:-1]) if count else row[:0], dtype=np.float64)
    # All of one size: corner by corner, several times as fast.
    result = row[::size].copy()
    for corner in range(1, size):
        reduce(result, row[corner::size], out=result)
    return result


def drawn_faces(view: View, faces: ProjectedFaces) -> Ints:
    """The faces that can be seen at all: not edge-on, not behind the near plane, and of closed bodies only those that
    show their outside.

    That holds for bodies that do not cross themselves, as in body_sides, and that the near plane does not cut; an eye
    in a body sees its inner walls.
    Source: Glaeser, section 5.1; erratum G5-09.
    """
    side = faces.sides.copy()
    side[view.face_item[~np.isfinite(faces.nearest) | (faces.box[1] >= EVERYWHERE)]] = 0
    kept = (faces.facing != 0) & np.isfinite(faces.nearest)
    return np.flatnonzero(kept & (side[view.face_item] * faces.facing >= 0))


def outer_sides(view: View) -> Ints:
    """(i,) 1 for items that are seen from outside only and wound that way, -1 for such wound inside out, 0 for all
    others: as in body_sides, but those that reach behind the near plane, in which the eye may be."""
    side = body_sides(view)
    if view.eye is not None:
        behind = np.flatnonzero(view.depth <= view.near)
        side[np.searchsorted(view.item_vertices, behind, side="right") - 1] = 0
    # What stands for the look of faces is wound as the item that these are of.
    side[view.shown_item] = side[view.face_item]
    return side


def image_faces(view: View, which: Ints) -> ImageFaces:
    """Some faces of the view in the image, cut off at the near plane.

    Parameters
    ----------
    view : View
        As in scene.look.
    which : (n,) array of int
        Faces of the view.

    Returns
    -------
    ImageFaces
        Without those seen edge-on.

    Notes
    -----
    The height over the image plane is f (f - d) / d for the depth d and the image plane's depth f; in a parallel
    projection it is f - d itself.

    Source: Glaeser, section 2.4 (the transformation T2).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> cube = vp.Item("cube", geometry.box((1, 1, 1)))
    >>> view = scene.look(vp.Scene((cube,)), vp.Camera((0, 0, 9), parallel=True))
    >>> len(visibility.image_faces(view, np.arange(6)))  # the four sides are seen edge-on
    2
    """
    may_stop()
    position, offsets = ragged.take(view.offsets, which)
    corner = view.corners[position]
    if view.eye is None or not (view.depth[corner] < view.near).any():
        return polygons_of(image_points(view, view.points)[:, corner], offsets, which, view.tolerance)
    points = view.points[:, corner]
    cut, _ = cut_polygons(Polygons(points.T, offsets), view.depth_of(points) - view.near)
    full = np.flatnonzero(np.diff(cut.offsets))
    offsets = np.append(cut.offsets[full], len(cut.points))
    return polygons_of(image_points(view, cut.points.T), offsets, which[full], view.tolerance)


def image_points(view: View, points: Floats) -> Floats:
    """Points of the view under the projective map that makes sight lines parallel.

    Parameters
    ----------
    view : View
        As in scene.look.
    points : (3, n) array of float
        In the view's coordinates.

    Returns
    -------
    (3, n) array of float
        x and y in the image, and heights that grow towards the eye.

    Notes
    -----
    Without meaning where points are nearer than the near plane.

    Source: Glaeser, section 2.4 (the transformation T2).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> cube = vp.Item("cube", geometry.box((2, 2, 2)))
    >>> view = scene.look(vp.Scene((cube,)), vp.Camera((1, -9, 1), target=(1, 1, 1)))
    >>> one, two = visibility.image_points(view, view.points_of(np.array([(1.0, 0.0, 1.0), (1.0, 2.0, 1.0)]))).T
    >>> bool(np.allclose(one[:2], two[:2])), bool(one[2] > two[2])  # one sight line; the first is nearer
    (True, True)
    """
    if view.eye is None:
        height = points[2]
    else:
        depth = np.maximum(view.depth_of(points), view.near)
        # This is focus - depth, without the distance of the eye: of a scene far from it no digits would be left.
        beyond = np.minimum(points[2] + (view.focus - view.eye[2]), view.focus - view.near)
        height = view.focus * beyond / depth
    return np.concatenate([view.image_of(points), height[None]])


def view_points(view: View, points: Floats) -> Floats:
    """(3,n) the points of the view of which points (3,n) are the images and heights: the inverse of image_points.

    Source: Glaeser, section 2.4 (the transformation T2).
    """
    if view.eye is None:
        return np.concatenate([points[:2] + view.target[:2, None], points[2:]])
    share = view.focus / (points[2] + view.focus)
    z = points[2:] * share + (view.eye[2] - view.focus)
    return np.concatenate([points[:2] * share + view.eye[:2, None], z])


def polygons_of(points: Floats, offsets: Ints, source: Ints, tolerance: float) -> ImageFaces:
    """Polygons of corners (3,c) as in image_points, all turned counter-clockwise; those narrower than the tolerance
    left out.

    Where faces lie in one plane the larger one is drawn first; of equal ones the lower, the left one, the one nearer
    to the lower border of the image, and at last the one listed first.
    """
    may_stop()
    if not len(source):
        return ImageFaces(points[:, :0], np.zeros(1, dtype=np.intp), np.zeros((5, 0)), source, source)
    normal, middle = _area_vectors(points, offsets)
    sizes = np.diff(offsets)
    spread = np.maximum(
        *(over_corners(np.maximum, row, offsets) - over_corners(np.minimum, row, offsets) for row in points[:2])
    )
    wide = np.flatnonzero(np.abs(normal[2]) > tolerance * spread)
    position, ends = ragged.take(offsets, wide)
    backwards = np.repeat(normal[2, wide] < 0.0, sizes[wide])
    mirrored = np.repeat(offsets[wide] + offsets[wide + 1] - 1, sizes[wide]) - position
    corners = points[:, np.where(backwards, mirrored, position)]
    normal, middle = normal[:, wide], middle[:, wide]
    slopes = -normal[:2] / normal[2]
    planes = np.concatenate([middle, slopes])
    return ImageFaces(corners, ends, planes, source[wide], _ranks(-np.abs(normal[2]), middle))


def _ranks(key: Floats, middle: Floats) -> Ints:
    """(n,) ranks by a key; of equal ones by height, x and y of their middles."""
    order = np.argsort(key, kind="stable")
    new = np.append(True, key[order][1:] != key[order][:-1])[: len(order)]
    tied = np.flatnonzero(~(new & np.append(new[1:], True)))
    if len(tied):
        some = order[tied]
        order[tied] = some[np.lexsort((middle[1, some], middle[0, some], middle[2, some], np.cumsum(new)[tied]))]
    rank = np.empty(len(order), dtype=np.intp)
    rank[order] = np.arange(len(order))
    return rank


def _area_vectors(points: Floats, offsets: Ints) -> tuple[Floats, Floats]:
    """(3,n) Newell's area vectors about the first corners, and the means of the corners."""
    may_stop()
    starts, sizes = offsets[:-1], np.diff(offsets)
    arm = points - np.repeat(points[:, starts], sizes, axis=1)
    after = arm[:, next_positions(offsets, np.arange(points.shape[1]))]
    normal = np.stack(
        [
            over_corners(np.add, arm[(k + 1) % 3] * after[(k + 2) % 3] - arm[(k + 2) % 3] * after[(k + 1) % 3], offsets)
            for k in range(3)
        ]
    )
    return normal, points[:, starts] + np.stack([over_corners(np.add, row, offsets) for row in arm]) / sizes


# Painted polygons inside a frame.


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
