"""Painter's orders that shapes give: of graphs, solids of revolution, solids, and of whole objects and their groups."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.convex_polygons import convex_hulls
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polygon_cuts import inside_convex
from vectorplot.geometry.vectors import cross
from vectorplot.scene.view import View
from vectorplot.textbook.separating_planes import Surroundings, separations, spheres_power
from vectorplot.visibility.painter.face_splitting import eye_coordinate, slice_order
from vectorplot.visibility.painter.image_faces import ImageFaces, drawn_faces, image_faces
from vectorplot.visibility.painter.painters_order import group_ranks
from vectorplot.visibility.painter.priority_tests import (
    APART,
    BEHIND,
    IN_FRONT,
    STRADDLING,
    Bodies,
    Codes,
    body_relations,
    box_pairs,
    face_relations,
    outlined_items,
    spheres_apart,
)
from vectorplot.visibility.painter.topological_order import component_ranks, topological_order
from vectorplot.visibility.projected_faces import project_faces

# The painter's order of function graphs over a grid, from any eye position, without a single comparison.


def graph_triangles(rows: int, columns: int) -> Ints:
    """The triangles over a grid of rows x columns patches.

    Parameters
    ----------
    rows, columns : int
        How many patches there are each way.

    Returns
    -------
    (2 rows columns, 3) array of int
        Corner (i, j) is the vertex i (columns + 1) + j. Patch k = i columns + j has the triangles 2 k, on the right of
        the diagonal from its corner (i, j) to (i + 1, j + 1), and 2 k + 1, on its left; counter-clockwise where x grows
        with i and y with j.

    Notes
    -----
    Source: Glaeser, section 5.4.

    Examples
    --------
    >>> from vectorplot.textbook import graph_triangles
    >>> graph_triangles(1, 2).tolist()
    [[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]]
    """
    corner = np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)
    triangles = np.empty((rows, columns, 2, 3), dtype=np.intp)
    triangles[..., 0] = corner[..., None]
    triangles[..., 0, 1] = corner + columns + 1
    triangles[..., 0, 2] = triangles[..., 1, 1] = corner + columns + 2
    triangles[..., 1, 2] = corner + 1
    return triangles.reshape(-1, 3)


def graph_order(x: ArrayLike, y: ArrayLike, eye: ArrayLike) -> Ints:
    """The triangles of graph_triangles over some grid lines, back to front.

    Parameters
    ----------
    x : (m+1,) array_like of float
        Ascending.
    y : (n+1,) array_like of float
        Ascending.
    eye : (3,) or (4,) array_like of float
        In the coordinates of the grid, or (x, y, z, 0) for a direction towards it; its height does not matter.

    Returns
    -------
    (2 m n,) array of int
        Numbers of triangles.

    Raises
    ------
    InputError
        Where the lines do not ascend, or the eye is not finite.

    Notes
    -----
    On each axis the slices on one side of the eye come first, towards it, then those on the other side, and last the
    eye's own; of a patch the triangle beyond the vertical plane through the diagonal goes before the other one.

    Source: Glaeser, section 5.4, figure 7.

    Examples
    --------
    >>> from vectorplot.textbook import graph_order
    >>> graph_order([0, 1], [0, 1, 2], eye=(0.5, 9, 3)).tolist()
    [0, 1, 2, 3]
    >>> graph_order([0, 1], [0, 1, 2], eye=(0.5, -9, 3)).tolist()
    [3, 2, 1, 0]
    """
    lines = [np.asarray(line, dtype=np.float64) for line in (x, y)]
    place = np.asarray(eye, dtype=np.float64)
    row, column = (slice_order(line, eye_coordinate(place, axis)) for axis, line in enumerate(lines))
    cell = (row[:, None] * (len(lines[1]) - 1) + column).ravel()
    width, depth = (np.diff(line)[order] for line, order in zip(lines, (row, column), strict=True))
    if len(place) == 3:
        ahead, beside = (place[axis] - lines[axis][:-1][order] for axis, order in ((0, row), (1, column)))
    else:
        ahead, beside = place[0], place[1]
    # Where the eye is on the left of the diagonal the right triangle goes first.
    left = np.outer(width, np.broadcast_to(beside, depth.shape)) > np.outer(np.broadcast_to(ahead, width.shape), depth)
    nearer = left.ravel().astype(np.intp)
    return np.stack([2 * cell + 1 - nearer, 2 * cell + nearer], axis=1).ravel()


# How two convex outlines lie on each other in the image, and which is nearer where they meet.
#
# Depths are those after the projective map T2, which is linear along lines: both ends are mapped first, then
# interpolated (erratum G6-05). The larger depth is nearer to the eye.


class Position(Enum):
    """How one convex outline lies on another.

    Examples
    --------
    >>> from vectorplot.textbook import Position
    >>> Position.CROSSING.value
    'the borders cross'
    >>> len(Position)
    4
    """

    DISJOINT = "no common inner points"
    CROSSING = "the borders cross"
    FIRST_IN_SECOND = "the first lies inside the second"
    SECOND_IN_FIRST = "the second lies inside the first"


@dataclass(frozen=True)
class RelativePosition:
    """The position of two outlines, and which of them is nearer.

    position: how the first lies on the second; first_depth, second_depth: the depths of the first and of the second at
    one common point of the image, where they differ most of all points looked at.
    """

    position: Position
    first_depth: float
    second_depth: float


def in_convex_polygon(points: ArrayLike, polygon: ArrayLike) -> tuple[Bools, Floats]:
    """Which points lie inside a convex polygon or on its border, and the polygon's depth there.

    Parameters
    ----------
    points : (p, 2 or more) array_like of float
        x and y; further columns do not matter.
    polygon : (n, 3) array_like of float
        Corners of x, y and depth, wound either way.

    Returns
    -------
    (p,) array of bool
        Which points lie inside, or on the border.
    (p,) array of float
        The polygon's depth there, NaN outside.

    Raises
    ------
    InputError
        For fewer than three corners, or numbers that are not finite.

    Notes
    -----
    The chord from the first corner through a point leaves the polygon at a side; what lies on the chord is inside, and
    the depth on it is linear.

    Edge cases: a polygon without area contains nothing.

    Source: Glaeser, section 6.2, equations 1 and 2, figure 2; errata G6-05, G6-06.

    Examples
    --------
    >>> from vectorplot.textbook import in_convex_polygon
    >>> ramp = [(0, 0, 0), (4, 0, 4), (4, 4, 4), (0, 4, 0)]
    >>> inside, depth = in_convex_polygon([(1, 2), (5, 2)], ramp)
    >>> inside.tolist(), depth.tolist()
    ([True, False], [1.0, nan])
    """
    corner, p = _checked(polygon), np.atleast_2d(np.asarray(points, dtype=np.float64))[:, :2]
    arm, out = corner[1:, :2] - corner[0, :2], p - corner[0, :2]
    side = arm[1:] - arm[:-1]
    turn = cross(arm[:-1], side)
    # A sector of the fan holds the point where it is between its two arms: half-open, so that none is missed.
    sign = 1.0 if turn.sum() > 0.0 else -1.0
    from_first, from_second = (sign * cross(a[None], out[:, None]) for a in (arm[:-1], arm[1:]))
    within = (from_first >= 0.0) & (from_second <= 0.0) & (sign * turn > 0.0)
    length = cross(out[:, None], side[None])
    # The side is met at out / share.
    share = np.where(within, length / np.where(turn != 0.0, turn, 1.0), np.inf)
    sector = share.argmin(axis=1)
    pick = np.arange(len(p))
    inside = share[pick, sector] <= 1.0
    along = cross(arm[:-1][sector], out) / np.where(length[pick, sector] != 0.0, length[pick, sector], 1.0)
    leaving = corner[1:-1, 2][sector] + along * (corner[2:, 2] - corner[1:-1, 2])[sector]
    depth = corner[0, 2] + np.where(inside, share[pick, sector], 0.0) * (leaving - corner[0, 2])
    return inside, np.where(inside, depth, np.nan)


def relative_position(first: ArrayLike, second: ArrayLike) -> RelativePosition:
    """How two convex outlines lie on each other.

    Parameters
    ----------
    first : (n, 3) array_like of float
        Corners of x, y and depth, wound either way.
    second : (m, 3) array_like of float
        The same.

    Returns
    -------
    RelativePosition
        With the depths of both where they differ most.

    Raises
    ------
    InputError
        For fewer than three corners, or numbers that are not finite.

    Notes
    -----
    The depths are compared where the borders cross and at corners of one inside the other; of these points that one
    counts where they differ most, so that a difference that rounding could make is told by another.

    Edge cases: outlines that only touch are disjoint; of two in the same place the first lies inside the second.

    Source: Glaeser, section 6.2; errata G5-02, G6-05, G6-06.

    Examples
    --------
    >>> from vectorplot.textbook import relative_position
    >>> large = [(0, 0, 1), (4, 0, 1), (4, 4, 1), (0, 4, 1)]
    >>> small = [(1, 1, 3), (2, 1, 3), (2, 2, 3)]
    >>> found = relative_position(large, small)
    >>> found.position.name, found.first_depth, found.second_depth
    ('SECOND_IN_FIRST', 1.0, 3.0)
    """
    one, two = _checked(first), _checked(second)
    if _kept_apart(one, two) or _kept_apart(two, one):
        return RelativePosition(Position.DISJOINT, np.nan, np.nan)
    first_inside, second_depth = in_convex_polygon(one, two)
    second_inside, first_depth = in_convex_polygon(two, one)
    depths = np.concatenate(
        [
            _crossings(one, two),
            np.stack([one[:, 2], second_depth], axis=1)[first_inside],
            np.stack([first_depth, two[:, 2]], axis=1)[second_inside],
        ]
    )
    if first_inside.all():
        return _widest(Position.FIRST_IN_SECOND, depths)
    return _widest(Position.SECOND_IN_FIRST if second_inside.all() else Position.CROSSING, depths)


def _checked(polygon: ArrayLike) -> Floats:
    corner = np.asarray(polygon, dtype=np.float64)
    if corner.ndim != 2 or corner.shape[1:] != (3,) or len(corner) < 3 or not np.isfinite(corner).all():
        raise InputError("an outline needs three corners at least, each of finite x, y and depth")
    return corner


def _kept_apart(one: Floats, two: Floats) -> bool:
    """Whether a side of one has all of two on its outer side, or on it."""
    along = np.roll(one, -1, axis=0)[:, :2] - one[:, :2]
    sign = 1.0 if cross(one[:, :2] - one[0, :2], along).sum() > 0.0 else -1.0
    height = sign * cross(along[:, None], two[None, :, :2] - one[:, None, :2])
    return bool((height.max(axis=1) <= 0.0)[(along != 0.0).any(axis=1)].any())


def _crossings(one: Floats, two: Floats) -> Floats:
    """(k,2) depths of both outlines where their sides cross; a side owns its start, not its end."""
    after_one, after_two = np.roll(one, -1, axis=0), np.roll(two, -1, axis=0)
    along, other = (after_one - one)[:, None, :2], (after_two - two)[None, :, :2]
    arm = two[None, :, :2] - one[:, None, :2]
    turn = cross(along, other)
    safe = np.where(turn != 0.0, turn, 1.0)
    t, u = cross(arm, other) / safe, cross(arm, along) / safe
    met = (turn != 0.0) & (t >= 0.0) & (t < 1.0) & (u >= 0.0) & (u < 1.0)
    i, j = np.nonzero(met)
    return np.stack(
        [one[i, 2] + t[met] * (after_one - one)[i, 2], two[j, 2] + u[met] * (after_two - two)[j, 2]], axis=1
    )


def _widest(position: Position, depths: Floats) -> RelativePosition:
    widest = depths[np.abs(depths[:, 0] - depths[:, 1]).argmax()] if len(depths) else np.full(2, np.nan)
    return RelativePosition(position, float(widest[0]), float(widest[1]))


# The painter's order of polyhedral surfaces of revolution by rings, without a single comparison.


def sliced_meridian(meridian: ArrayLike) -> Floats:
    """The meridian with more points where it passes the height of one of its points.

    Parameters
    ----------
    meridian : (k, 2) array_like of float
        Radius, not negative, and height.

    Returns
    -------
    (n, 2) array of float
        Every side lies between two neighbouring heights.

    Raises
    ------
    InputError
        For fewer than two points, negative radii, and numbers that are not finite.

    Notes
    -----
    Source: Glaeser, section 5.2, figure 3.

    Examples
    --------
    >>> from vectorplot.textbook import sliced_meridian
    >>> sliced_meridian([(0, 2), (2, 0), (1, 1)]).tolist()
    [[0.0, 2.0], [1.0, 1.0], [2.0, 0.0], [1.0, 1.0]]
    """
    line = _checked_rings(meridian)
    level = np.unique(line[:, 1])
    pieces = []
    for start, end in pairwise(line):
        low, high = sorted((start[1], end[1]))
        between = level[(level > low) & (level < high)]
        between = between if end[1] > start[1] else between[::-1]
        share = (between - start[1]) / (end[1] - start[1] or 1.0)
        pieces.append(
            np.concatenate([start[None], np.stack([start[0] + share * (end[0] - start[0]), between], axis=1)])
        )
    return np.concatenate([*pieces, line[-1:]])


def ring_order(meridian: ArrayLike, order: int, eye: ArrayLike) -> Ints:
    """The faces of a surface of revolution about the z-axis, back to front.

    Parameters
    ----------
    meridian : (k, 2) array_like of float
        Radius and height, sliced as by sliced_meridian and not crossing itself.
    order : int
        How many faces go round.
    eye : (3,) or (4,) array_like of float
        In coordinates in which z is the axis, or (x, y, z, 0) for a direction towards it.

    Returns
    -------
    ((k-1) order,) array of int
        Face i order + j is swept by the side from point i to i+1 between the azimuths j and j+1 times 2 pi / order.

    Raises
    ------
    InputError
        Where a side of the meridian passes the height of a point, and for what sliced_meridian refuses.

    Notes
    -----
    Slices are drawn in the order of slice_order; within a slice first what the rays leave its rings through, outer
    rings before inner ones, then what they enter them through, inner rings before outer ones. Right wherever the eye
    is: above, below, inside.

    Source: Glaeser, section 5.2, figure 3; erratum G5-09.

    Examples
    --------
    >>> from vectorplot.textbook import ring_order
    >>> ring_order([(1, 0), (1, 1)], order=4, eye=(9, 1, 0.5)).tolist()
    [1, 2, 0, 3]
    """
    line = _checked_rings(meridian)
    place = np.asarray(eye, dtype=np.float64)
    radius, height = line[:-1], line[1:]
    low, high = np.minimum(radius[:, 1], height[:, 1]), np.maximum(radius[:, 1], height[:, 1])
    level = np.unique(line[:, 1])
    bottom, top = np.searchsorted(level, low), np.searchsorted(level, high)
    if (top - bottom > 1).any():
        raise InputError("a side of the meridian passes the height of another point: cut it there first")
    leading = _places(level, bottom, top, eye_coordinate(place, 2))
    entered = _entered(line, order, place)
    middle = (radius[:, 0] + height[:, 0]) / 2.0
    rank = np.argsort(np.argsort(middle, kind="stable"), kind="stable")[:, None]
    within = np.where(entered, rank, -1 - rank)
    return np.lexsort((within.ravel(), np.repeat(leading, order)))


def _checked_rings(meridian: ArrayLike) -> Floats:
    line = np.asarray(meridian, dtype=np.float64)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all() or (line[:, 0] < 0.0).any():
        raise InputError("a meridian has two points at least, each a radius, not negative, and a height")
    return line


def _places(level: Floats, bottom: Ints, top: Ints, eye: float) -> Ints:
    """(k,) the place in the order of drawing of sides between levels and, where bottom and top are the same, in one."""
    between = np.zeros(len(level), dtype=np.intp)
    if len(level) > 1:
        between[slice_order(level, eye)] = 2 * np.arange(len(level) - 1) + 1
    # A plane below the eye is drawn just after the slice below it, one above the eye after the slice above it.
    within = np.where(level < eye, np.append(0, between[: len(level) - 1] + 1), between + 1)
    within[-1:] = np.where(level[-1] < eye, within[-1], 0)
    return np.where(top > bottom, between[bottom], within[bottom])


def _entered(line: Floats, order: int, eye: Floats) -> Bools:
    """(k-1, order) whether rays to the eye come out of faces on the side away from the axis."""
    azimuth = 2.0 * np.pi * (np.arange(order) + 0.5) / order
    (radius, height), (rise_out, rise_up) = line[:-1].T, np.diff(line, axis=0).T
    # Upwards along the meridian the outside is on the right.
    sign = np.where(rise_up < 0.0, -1.0, 1.0)
    flatter = np.cos(np.pi / order)
    out = np.cos(azimuth) * eye[0] + np.sin(azimuth) * eye[1]
    finite = 1.0 if len(eye) == 3 else 0.0
    above = np.outer(sign * rise_up, out) - (sign * rise_out * flatter * eye[2])[:, None]
    return np.asarray(above - finite * (sign * flatter * (rise_up * radius - rise_out * height))[:, None] > 0.0)


# The order of solids by the power of the spheres around them, checked.


def sphere_order(view: View, faces: ImageFaces, bodies: Bodies) -> Ints | None:
    """(b,) numbers of convex bodies (see convex_bodies) back to front, by falling power of the eye to their spheres;
    None where that is wrong. Right for disjoint spheres; other pairs whose image boxes overlap are compared
    directly.
    Source: Glaeser, section 5.5, figure 9; erratum G5-03.
    """
    eye = np.array([0.0, 0.0, 1.0, 0.0]) if view.eye is None else view.eye
    power = spheres_power(bodies.sphere.T, eye)
    if not len(bodies):
        return bodies.item
    rows = [e.reduceat(row, bodies.offsets[:-1]) for row in bodies.corners for e in (np.minimum, np.maximum)]
    for first, second in box_pairs(np.stack(rows), view.tolerance):
        close = ~spheres_apart(bodies, first, second)
        a, b = first[close], second[close]
        codes = body_relations(view, faces, bodies, a, b)
        told = np.where(power[a] <= power[b], IN_FRONT, BEHIND)
        if ((codes != APART) & (codes != told)).any():
            return None
    return np.argsort(-power, kind="stable")


# The order of whole objects and of groups of objects, by priorities and cyclic overlaps.


@dataclass(frozen=True, eq=False)
class Objects:
    """Items, or groups of them, as an eye or a lamp sees them.

    view: see scene.look; faces: those drawn; owner: (n,) the object of each face, -1 for none; box: (6, k) smallest
    and largest x, y and height of each object in the image; around: boxes and spheres in the view.
    """

    view: View
    faces: ImageFaces
    owner: Ints
    box: Floats
    around: Surroundings

    def __len__(self) -> int:
        return int(self.box.shape[1])


def view_objects(view: View, object_of: ArrayLike | None = None) -> Objects:
    """The objects of a view.

    Parameters
    ----------
    view : View
        See scene.look; the view of a lamp makes the system of a lamp: there in front means nearer to the lamp.
    object_of : (i,) array_like of int, optional
        The object that each item belongs to, from 0 on, or -1 for none; every item is an object where None.

    Returns
    -------
    Objects
        What priorities and wholly_hidden ask.

    Raises
    ------
    InputError
        For a table of another length, or an object without points.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, textbook
    >>> cubes = tuple(vp.Item(name, geometry.box((1, 1, 1))) for name in ("one", "two", "three"))
    >>> view = scene.look(vp.Scene(cubes), vp.Camera((5, 4, 3)))
    >>> len(textbook.view_objects(view)), len(textbook.view_objects(view, [0, 0, 1]))
    (3, 2)
    """
    items = len(view.item_vertices) - 1
    of = np.arange(items) if object_of is None else np.asarray(object_of, dtype=np.intp)
    if of.shape != (items,) or (of < -1).any():
        raise InputError(f"{items} items need as many numbers of objects, from -1 on")
    faces = image_faces(view, drawn_faces(view, project_faces(view)))
    owner = of[view.face_item[faces.source]]
    count = int(of.max(initial=-1)) + 1
    box = np.tile(np.array([[np.inf], [-np.inf]] * 3), count)
    drawn = owner >= 0
    for row in range(6):
        (np.maximum if row % 2 else np.minimum).at(box[row], owner[drawn], faces.box[row, drawn])
    return Objects(
        view, faces, owner, box, Surroundings.of([_mesh(view, np.flatnonzero(of == k)) for k in range(count)])
    )


def _mesh(view: View, items: Ints) -> Mesh:
    """Some items of the view as one mesh, in its coordinates."""
    vertex, _ = ragged.take(view.item_vertices, items)
    number = np.full(view.points.shape[1], -1, dtype=np.intp)
    number[vertex] = np.arange(len(vertex))
    position, offsets = ragged.take(view.offsets, np.flatnonzero(np.isin(view.face_item, items)))
    return Mesh(view.points[:, vertex].T, number[view.corners[position]], offsets)


def which_first(objects: Objects, first: Ints, second: Ints, *, critical: bool = False) -> Codes:
    """(p,) codes of pairs of objects, see face_relations: APART where neither hides the other, IN_FRONT where the first
    is drawn later, BEHIND where the second is, STRADDLING where both would have to. Decided by boxes in the image,
    depths, spheres and separating planes, then by outlines of faces; critical: by outlines only, so that nothing
    without overlap has a priority.
    Source: Glaeser, section 5.5; errata G5-02, G5-03, G5-05.
    """
    box = objects.box
    codes = np.full(len(first), APART, dtype=np.int8)
    left = np.flatnonzero(_overlap(box[0:2], first, second) & _overlap(box[2:4], first, second))
    if not critical:
        a, b = first[left], second[left]
        apart = ~_overlap(box[4:6], a, b)
        told = np.where(apart, np.where(box[4, a] >= box[5, b], IN_FRONT, BEHIND), APART)
        eye = (0.0, 0.0, 1.0, 0.0) if objects.view.eye is None else objects.view.eye
        nearer = separations(objects.around, a, b).nearer(eye)
        told = np.where(apart | (nearer == 0), told, np.where(nearer > 0, IN_FRONT, BEHIND))
        codes[left] = told
        left = left[told == APART]
    codes[left] = _by_outlines(objects, first[left], second[left])
    return codes


def _overlap(span: Floats, first: Ints, second: Ints) -> Bools:
    return np.asarray(np.minimum(span[1, first], span[1, second]) > np.maximum(span[0, first], span[0, second]))


def _by_outlines(objects: Objects, first: Ints, second: Ints) -> Codes:
    """(p,) codes of pairs from those of all their faces."""
    count = len(objects)
    key = np.minimum(first, second) * count + np.maximum(first, second)
    asked, pair = np.unique(key, return_inverse=True)
    # For every pair asked: whether the smaller number is in front somewhere, and behind somewhere.
    front, behind = np.zeros((2, len(asked)), dtype=np.bool_)
    wanted = np.zeros(count + 1, dtype=np.bool_)
    wanted[np.concatenate([first, second])] = True
    faces = np.flatnonzero(wanted[objects.owner])
    some, owner = objects.faces.take(faces), objects.owner[faces]
    for a, b in box_pairs(some.box, objects.view.tolerance):
        keys = np.minimum(owner[a], owner[b]) * count + np.maximum(owner[a], owner[b])
        place = np.minimum(np.searchsorted(asked, keys), max(len(asked) - 1, 0))
        use = np.flatnonzero((asked[place] == keys) & (owner[a] != owner[b])) if len(asked) else place[:0]
        codes = face_relations(some, a[use], b[use], objects.view.tolerance)
        turned = owner[a[use]] > owner[b[use]]
        for code, here, there in ((IN_FRONT, front, behind), (BEHIND, behind, front)):
            met = (codes == code) | (codes == STRADDLING)
            here[place[use[met & ~turned]]] = True
            there[place[use[met & turned]]] = True
    swapped = first > second
    hides = np.where(swapped, behind[pair], front[pair])
    hidden = np.where(swapped, front[pair], behind[pair])
    return np.select([hides & hidden, hides, hidden], [STRADDLING, IN_FRONT, BEHIND], APART).astype(np.int8)


def priorities(objects: Objects, subset: ArrayLike | None = None, *, critical: bool = False) -> Codes:
    """What objects do to one another: a table of all pairs.

    Parameters
    ----------
    objects : Objects
        See view_objects.
    subset : (k,) array_like of int, optional
        Some of the objects; all of them where None.
    critical : bool
        The outlines of the faces always decide, so that no priority is given where nothing overlaps.

    Returns
    -------
    (k, k) array of int8
        Row against column: APART where neither hides anything of the other, IN_FRONT where the first has to be drawn
        later, BEHIND where the second has, STRADDLING where both would have to. Opposite places say the same of each
        other.

    Notes
    -----
    Boxes in the image that do not overlap decide nothing; then depths that do not, spheres and planes that keep apart;
    what is left open the outlines of the faces decide. The table has as many places as there are pairs: for thousands
    of objects painters_order, which compares only what overlaps, is the way.

    Source: Glaeser, sections 5.5 and 5.6; errata G5-02, G5-03, G5-05.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, textbook, visibility
    >>> above = geometry.box((1, 1, 1), placement=(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2))
    >>> boxes = (vp.Item("high", above), vp.Item("low", geometry.box((1, 1, 1))))
    >>> table = textbook.priorities(textbook.view_objects(scene.look(vp.Scene(boxes), vp.Camera((2, 3, 9)))))
    >>> bool(table[0, 1] == visibility.IN_FRONT), bool(table[1, 0] == visibility.BEHIND)
    (True, True)
    """
    chosen = np.arange(len(objects)) if subset is None else np.asarray(subset, dtype=np.intp)
    row, column = np.triu_indices(len(chosen), 1)
    table = np.full((len(chosen), len(chosen)), APART, dtype=np.int8)
    codes = which_first(objects, chosen[row], chosen[column], critical=critical)
    table[row, column] = codes
    table[column, row] = np.select([codes == IN_FRONT, codes == BEHIND], [BEHIND, IN_FRONT], codes)
    return table


def demands(table: Codes) -> tuple[Ints, Ints]:
    """A table of priorities as demands.

    Parameters
    ----------
    table : (k, k) array of int8
        See priorities.

    Returns
    -------
    before, after : (d,) arrays of int
        The objects before[k] have to be drawn before the objects after[k].

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import textbook
    >>> from vectorplot.visibility import APART
    >>> from vectorplot.visibility.painter.priority_tests import BEHIND, IN_FRONT
    >>> before, after = textbook.demands(np.array([[APART, IN_FRONT], [BEHIND, APART]]))
    >>> before.tolist(), after.tolist()
    ([1], [0])
    """
    before, after = np.nonzero((table == BEHIND) | (table == STRADDLING))
    return before, after


def wholly_hidden(objects: Objects) -> Bools:
    """The objects of which nothing is seen, since one convex body in front of them covers them: they need not be drawn.

    result: (k,) true where the outline of the object lies inside that of one closed convex item in front of it.
    Source: Glaeser, section 5.5, case 3; errata G5-02, G6-05.
    """
    view, faces, count = objects.view, objects.faces, len(objects)
    corner_owner = np.repeat(objects.owner, np.diff(faces.offsets))
    order = np.argsort(corner_owner, kind="stable")
    order = order[np.searchsorted(corner_owner[order], 0) :]
    first = np.searchsorted(corner_owner[order], np.arange(count + 1))
    points = faces.points[:, order]
    corner, starts = convex_hulls(points[:2].T, first)
    outlines = points[:, corner]
    hidden = np.diff(starts) == 0
    convex = _convex(objects)
    for one, two in box_pairs(objects.box, view.tolerance):
        behind, front = np.concatenate([one, two]), np.concatenate([two, one])
        use = convex[front]
        behind, front = behind[use], front[use]
        (inner, outer), ends = zip(*(_some(outlines, starts, which) for which in (behind, front)), strict=True)
        within = np.flatnonzero(inside_convex(inner, ends[0], outer, ends[1], tolerance=view.tolerance))
        codes = which_first(objects, behind[within], front[within], critical=True)
        hidden[behind[within[codes == BEHIND]]] = True
    return np.asarray(hidden, dtype=np.bool_)


def _convex(objects: Objects) -> Bools:
    """(k,) the objects that are one closed convex item each, and hide."""
    item = objects.view.face_item[objects.faces.source]
    solid = outlined_items(objects.view, project_faces(objects.view))
    least, most = np.full(len(objects), len(solid)), np.full(len(objects), -1)
    owned = objects.owner >= 0
    np.minimum.at(least, objects.owner[owned], item[owned])
    np.maximum.at(most, objects.owner[owned], item[owned])
    return np.asarray((least == most) & np.append(solid, False)[least])


def _some(points: Floats, offsets: Ints, which: Ints) -> tuple[Floats, Ints]:
    position, ends = ragged.take(offsets, which)
    return points[:2, position], ends


@dataclass(frozen=True, eq=False)
class ObjectOrder:
    """An order of whole objects, and the cycles that have none.

    order: (n,) objects back to front; cycles: the objects that overlap cyclically, cycle by cycle;
    critical: whether the second, slower pass was needed; undone: groups that had to be taken apart.
    """

    order: Ints
    cycles: tuple[Ints, ...]
    critical: bool = False
    undone: tuple[int, ...] = ()


def cyclic_overlaps(count: int, before: Ints, after: Ints) -> tuple[Ints, ...]:
    """The sets of objects, of two or more, that overlap cyclically.

    Parameters
    ----------
    count : int
        How many objects there are: 0 to count - 1.
    before, after : (d,) array of int
        before[k] has to be drawn before after[k].

    Returns
    -------
    tuple of arrays of int
        Each in ascending order, by their first objects.

    Notes
    -----
    Source: Glaeser, section 5.6, figure 11; Tarjan (1972).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import textbook
    >>> cycles = textbook.cyclic_overlaps(4, before=np.array([0, 2, 3, 1]), after=np.array([2, 3, 0, 0]))
    >>> [cycle.tolist() for cycle in cycles]
    [[0, 2, 3]]
    """
    rank = component_ranks(count, before, after)
    order = np.argsort(rank, kind="stable")
    circles = np.split(order, np.flatnonzero(np.diff(rank[order])) + 1)
    return tuple(sorted((c for c in circles if len(c) > 1), key=lambda c: int(c[0])))


def cyclic_overlap_report(cycles: Sequence[Ints], names: Sequence[str]) -> tuple[str, ...]:
    """One sentence for each cycle, with the names of its objects.

    Parameters
    ----------
    cycles : sequence of arrays of int
        See cyclic_overlaps.
    names : sequence of str
        Of all objects.

    Returns
    -------
    tuple of str
        As long as cycles.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import textbook
    >>> textbook.cyclic_overlap_report((np.array([0, 2, 3]),), ["oak", "elm", "ash", "fir"])
    ('oak, ash and fir lie on one another in a circle, or pierce each other',)
    """
    sentences = []
    for cycle in cycles:
        *most, last = [names[k] for k in cycle.tolist()]
        sentences.append(f"{', '.join(most)} and {last} lie on one another in a circle, or pierce each other")
    return tuple(sentences)


def object_order(view: View, names: Sequence[str]) -> ObjectOrder:
    """The items of a view as whole objects, back to front: by quick decisions, by outlines of all pairs where these
    make a cycle; a cycle that stays is left, and an InputWarning names its objects (names: of the items).
    painters_order cuts such cycles instead.
    Source: Glaeser, section 5.6 (two passes); erratum G5-04.
    """
    objects = view_objects(view)
    for critical in (False, True):
        before, after = demands(priorities(objects, critical=critical))
        result = topological_order(len(objects), before, after)
        if not len(result.cycle):
            return ObjectOrder(result.order, (), critical)
    cycles = cyclic_overlaps(len(objects), before, after)
    for sentence in cyclic_overlap_report(cycles, names):
        warnings.warn(f"{sentence}: no order is right everywhere", InputWarning, stacklevel=2)
    return ObjectOrder(result.order, cycles, True)


def grouped_order(count: int, before: Ints, after: Ints, group: Ints) -> ObjectOrder:
    """The order of objects, of which those of one group stay together.

    Parameters
    ----------
    count : int
        How many objects there are: 0 to count - 1.
    before, after : (d,) array of int
        before[k] has to be drawn before after[k].
    group : (count,) array of int
        The group of each object, -1 for none.

    Returns
    -------
    ObjectOrder
        Groups are ordered as wholes, then the objects in each. What overlaps cyclically is reported as cycles.

    Raises
    ------
    InputError
        Unless there is one group for each object.

    Notes
    -----
    A group that lies on other groups or objects in a circle is undone: its objects count one by one.

    Source: Glaeser, section 5.7, figure 12.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import textbook
    >>> found = textbook.grouped_order(3, before=np.array([2]), after=np.array([0]), group=np.array([0, -1, 0]))
    >>> found.order.tolist()
    [2, 0, 1]
    >>> between = textbook.grouped_order(3, np.array([2, 1]), np.array([1, 0]), group=np.array([0, -1, 0]))
    >>> between.order.tolist(), between.undone  # 1 lies between the two of group 0
    ([2, 1, 0], (0,))
    """
    owner = np.asarray(group, dtype=np.intp)
    if owner.shape != (count,):
        raise InputError(f"{count} objects need as many groups")
    within = np.empty(count, dtype=np.intp)
    within[topological_order(count, before, after).order] = np.arange(count)
    rank, undone = group_ranks(count, before, after, owner)
    return ObjectOrder(np.lexsort((within, rank)), cyclic_overlaps(count, before, after), undone=undone)
