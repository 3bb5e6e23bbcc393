"""Assertions on curves: that they lie where they are said to lie, how far apart two are, how fine chords are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import vector
from vectorplot.drawing.drawing import Drawing, Paths
from vectorplot.drawing.stroke_curves import CORNER_ANGLE
from vectorplot.errors import InputError
from vectorplot.features.surface_points import Sites, unit
from vectorplot.features.tangent_fields import TangentField
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import Polylines, Strokes, closed_round, indices_along
from vectorplot.geometry.vectors import cross, dot, length, norm, normalize
from vectorplot.scene.light import Light
from vectorplot.surfaces.stacked import unit_normals
from vectorplot.surfaces.surface import ImplicitSurface, Surface
from vectorplot.testing.rays import nearest_places
from vectorplot.tolerances import ACCURACY_OF_TOLERANCE, DISTANCE_ACCURACY, LEAST_DIVISOR, ZERO_OF_EXTENT
from vectorplot.words import LineKind

# What counts as a curve in the assertions: arrays, lists of arrays, strokes, paths, drawings.

Curves = Drawing | Paths | Strokes | ArrayLike | Sequence[ArrayLike]
"""A polyline (n, 2 or 3), several of them, or what holds polylines. A closed one repeats its first point."""


def curves_in_space(drawing: Drawing, *, kind: str | None = None, item: str | None = None) -> list[Floats]:
    """The strokes of a drawing, visible and hidden ones, as polylines in the world.

    Parameters
    ----------
    drawing : Drawing
        With its strokes.
    kind : str, optional
        Only those of a LineKind, by its word.
    item : str, optional
        Only those of an item, by its name.

    Returns
    -------
    list of (n, 3) array of float
        In world units, in drawing order; closed ones repeat their first point. A smooth stroke that turns a corner is
        one for each of its sides: there the pen goes on with another curve, or the curve has no tangent.

    Raises
    ------
    InputError
        For a kind or an item that does not exist.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.testing import curves_in_space
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> [border.shape for border in curves_in_space(drawing, kind="boundary")]
    [(4, 3)]
    """
    wanted_kind = None if kind is None else int(LineKind.from_word(kind))
    if item is not None and item not in drawing.items:
        raise InputError(f"item {item!r}: the drawing has {', '.join(drawing.items) or 'none'}")
    found: list[Floats] = []
    for layer in drawing.layers:
        for paths in layer.strokes:
            kept = np.ones(len(paths), dtype=np.bool_)
            if wanted_kind is not None:
                kept &= paths.kind == wanted_kind
            if item is not None:
                kept &= np.isin(paths.item, [k for k, name in enumerate(drawing.items) if name == item])
            found += _curves_of(paths, kept)
    return found


def _curves_of(paths: Paths, kept: Bools) -> list[Floats]:
    """The curves of the paths that are kept, parted at corners."""
    lines = Polylines(paths.points3d, paths.offsets, paths.closed)
    turns = np.repeat(paths.smooth, np.diff(paths.offsets)) & _corners(paths.directions)
    if not turns.any():
        return cut(lines, kept)
    found: list[Floats] = []
    for path in np.flatnonzero(kept & (np.diff(paths.offsets) > 0)).tolist():
        index = indices_along(lines, path)
        at = np.flatnonzero(turns[index[1:-1]]) + 1
        sides = [paths.points3d[index[low : high + 1]] for low, high in pairwise([0, *at.tolist(), len(index) - 1])]
        if len(sides) > 1 and paths.closed[path] and not turns[index[0]]:
            sides[0] = np.concatenate([sides.pop(), sides[0][1:]])
        found += sides or [paths.points3d[index]]
    return found


def _corners(directions: Floats) -> Bools:
    """(p,) where curves arrive and leave in directions (p,2) that are known and differ, other than in a cusp."""
    turn = np.abs(np.remainder(directions[:, 1] - directions[:, 0] + np.pi, 2.0 * np.pi) - np.pi)
    return np.asarray((turn > CORNER_ANGLE) & (turn < np.pi - CORNER_ANGLE))


def cut(lines: Polylines, kept: Bools) -> list[Floats]:
    """The polylines that are kept, each an array; closed ones with their first point once more; those without points
    are left out."""
    rounds = closed_round(lines)
    parts = np.split(lines.points[rounds.index], rounds.offsets[1:-1])
    return [part for part, wanted in zip(parts, kept, strict=False) if wanted and len(part)]


def polylines_of(curves: Curves) -> list[Floats]:
    """The polylines (n, 2 or 3) of curves in any form; those of drawings are in the world.

    Errors: InputError for other shapes.
    """
    if isinstance(curves, Drawing):
        return curves_in_space(curves)
    if isinstance(curves, Paths):
        return _curves_of(curves, np.ones(len(curves), dtype=np.bool_))
    if isinstance(curves, Strokes):
        every = np.ones(len(curves), dtype=np.bool_)
        return cut(Polylines(curves.points, curves.offsets, ~every), every)
    if isinstance(curves, (list, tuple)) and any(np.ndim(part) == 2 for part in curves):
        return [one_polyline(part) for part in curves if len(part)]
    try:
        array = np.asarray(curves, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("curves must be arrays (n,2) or (n,3), lists of such, or a drawing") from None
    if array.ndim == 3:
        return [one_polyline(part) for part in array if len(part)]
    return [one_polyline(array)] if array.size else []


def one_polyline(points: ArrayLike) -> Floats:
    """(n, 2 or 3) a polyline; a single point is one too. Errors: InputError for other shapes."""
    array = np.atleast_2d(np.asarray(points, dtype=np.float64))
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise InputError(f"a curve is an array (n,2) or (n,3), not one of shape {np.shape(points)}")
    return array


class CurvePoints(NamedTuple):
    """points (p, 2 or 3) of curves; curve (p,) and place (p,): which curve each lies on, and its place there."""

    points: Floats
    curve: Ints
    place: Ints

    def name(self, k: int) -> str:
        """Which point that is, in words."""
        coordinates = ", ".join(f"{x:.10g}" for x in self.points[k])
        which = f" of curve {self.curve[k]}" if self.curve[-1] > 0 else ""
        return f"point {self.place[k]}{which}, ({coordinates})"


def points_of(curves: Curves) -> CurvePoints:
    """All points of curves. Errors: AssertionError if there are none, or one is not finite."""
    parts = polylines_of(curves)
    assert parts, "there are no points: nothing to verify"
    if len({part.shape[1] for part in parts}) > 1:
        raise InputError("curves must be all in the plane, or all in space")
    size = [len(part) for part in parts]
    found = CurvePoints(
        np.concatenate(parts),
        ragged.owner(size),
        np.concatenate([np.arange(count) for count in size]),
    )
    bad = np.flatnonzero(~np.isfinite(found.points).all(axis=1))
    assert not len(bad), (
        f"{len(bad)} of {len(found.points)} points are not finite, the first: {found.name(int(bad[0]))}"
    )
    return found


# How far two curves are apart, as sets of points: the Hausdorff distance of polylines in the plane or in space.

PAIRS = 1 << 20

NEAR = 0.75
"""Part of a distance that is not looked into within which a segment is taken that is near but not the nearest: the rest
is for the lengths of pieces, which are halved until they are as short."""


class Worst(NamedTuple):
    """The point of one curve that is furthest from the other one: its distance, the point, the polyline and the
    parameter it has there (index of a segment and share of it), and which of the two it lies on."""

    distance: float
    point: Floats
    curve: int
    parameter: float
    which: str


def hausdorff(a: Curves, b: Curves, *, closed: bool = False, accuracy: float | None = None) -> float:
    """The Hausdorff distance of two curves: how far the points of either can be from the other one.

    Parameters
    ----------
    a, b : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 2 or 3), or several of them, as sets of segments; of a drawing those in the world.
    closed : bool
        Both close even where the last point does not repeat the first.
    accuracy : float, optional
        By how much the result may be too small; 1e-9 of the extent of both where None.

    Returns
    -------
    float
        The same for both orders, directions and any splitting.

    Raises
    ------
    AssertionError
        For curves without points or with points that are not finite.
    InputError
        For what is no curve, and for one in the plane and one in space.

    Notes
    -----
    Error: the true distance is larger by no more than the accuracy, and not smaller but for rounding.

    Edge cases: a single point is a curve too.

    Examples
    --------
    >>> from vectorplot.testing import hausdorff
    >>> hausdorff([(0, 0), (4, 0)], [(0, 0), (2, 1), (4, 0)])
    1.0
    """
    return worst_of_both(a, b, closed=closed, accuracy=accuracy).distance


def worst_of_both(
    a: Curves, b: Curves, *, closed: bool = False, accuracy: float | None = None, enough: float = 0.0
) -> Worst:
    """The point of two curves that is furthest from the other one, see hausdorff; of distances that are not larger
    than enough, any."""
    first, second = Segments.of(a, closed), Segments.of(b, closed)
    if first.ends.shape[2] != second.ends.shape[2]:
        raise InputError("one curve lies in the plane, the other in space")
    corners = np.concatenate([first.ends, second.ends]).reshape(-1, first.ends.shape[2])
    middle, extent = corners.mean(axis=0), float(norm(np.ptp(corners, axis=0)))
    # Below the rounding of the coordinates nothing can be told.
    rounding = 16.0 * float(np.spacing(np.abs(corners).max()))
    fine = max(DISTANCE_ACCURACY * extent if accuracy is None else accuracy, rounding)
    first, second = first.moved(-middle), second.moved(-middle)
    there = furthest(first, second, fine, enough, "first")
    back = furthest(second, first, fine, max(enough, there.distance), "second")
    worst = max(there, back, key=lambda found: found.distance)
    return worst._replace(point=worst.point + middle)


@dataclass(frozen=True, eq=False)
class Segments:
    """ends (n,2,d) of segments; curve (n,) and index (n,) of each: its polyline, and its place there."""

    ends: Floats
    curve: Ints
    index: Ints

    @classmethod
    def of(cls, curves: Curves, closed: bool) -> Segments:
        """The segments of curves; a polyline of one point is a segment without length."""
        parts = polylines_of(curves)
        if closed:
            parts = [np.concatenate([part, part[:1]]) for part in parts]
        parts = [np.repeat(part, 2, axis=0) if len(part) == 1 else part for part in parts]
        found = points_of(parts)
        start = np.flatnonzero(found.curve[:-1] == found.curve[1:])
        return cls(np.stack([found.points[start], found.points[start + 1]], axis=1), found.curve[start], start)._own()

    def _own(self) -> Segments:
        """The same, the index counted from the start of each polyline."""
        first = np.searchsorted(self.curve, self.curve)
        return Segments(self.ends, self.curve, self.index - self.index[first])

    def moved(self, by: Floats) -> Segments:
        """The same segments, moved."""
        return Segments(self.ends + by, self.curve, self.index)


class Tree:
    """Segments in short pieces, for the nearest segment to a point."""

    def __init__(self, ends: Floats) -> None:
        from scipy.spatial import cKDTree

        long = norm(ends[:, 1] - ends[:, 0])
        piece = float(long.sum()) / max(len(ends), 64)
        count = np.maximum(np.ceil(long / piece), 1.0).astype(np.intp) if piece > 0.0 else np.ones(len(ends), np.intp)
        self.owner = ragged.owner(count)
        place = np.arange(len(self.owner)) - ragged.starts(count)[self.owner]
        share = ((place + 0.5) / count[self.owner])[:, None]
        self.ends = ends
        self.half = 0.5 * float((long / count).max())
        self.tree: Any = cKDTree(ends[self.owner, 0] * (1.0 - share) + ends[self.owner, 1] * share)

    def nearest(self, points: Floats, floor: float, tried: Sequence[Ints] = ()) -> tuple[Floats, Ints]:
        """(n,) distance of points from the nearest segment, and its index; where the distance from some segment is no
        larger than floor, that one may do. tried: segments (n,) that are looked at first and may do where they are
        nearer still."""
        distance, segment = np.full(len(points), np.inf), np.zeros(len(points), dtype=np.intp)
        for by in tried:
            far = to_segments(points, self.ends[by])
            segment, distance = np.where(far < distance, by, segment), np.minimum(far, distance)
        left, count = np.flatnonzero(distance > NEAR * floor), 2
        while len(left):
            count = min(count, len(self.owner))
            sure = np.zeros(len(left), dtype=np.bool_)
            chunk = max(PAIRS // count, 1)
            for first in range(0, len(left), chunk):
                rows = left[first : first + chunk]
                middles, piece = self.tree.query(points[rows], k=np.arange(1, count + 1))
                candidates = self.owner[piece]
                far = to_segments(points[rows][:, None], self.ends[candidates])
                best = np.argmin(far, axis=1)
                each = np.arange(len(rows))
                distance[rows], segment[rows] = far[each, best], candidates[each, best]
                # Any segment not asked for has its nearest piece's middle at least as far away as the last one's.
                reached = distance[rows] <= np.maximum(middles[:, -1] - self.half, floor)
                sure[first : first + chunk] = reached
            if count == len(self.owner):
                break
            left, count = left[~sure], 4 * count
        return distance, segment


def to_segments(points: Floats, ends: Floats) -> Floats:
    """(...,) distances of points (..., d) from segments (..., 2, d)."""
    start, way = ends[..., 0, :], ends[..., 1, :] - ends[..., 0, :]
    arm = points - start
    square = dot(way, way)
    share = np.clip(dot(arm, way) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    return np.asarray(norm(arm - share[..., None] * way))


def furthest(segments: Segments, others: Segments, accuracy: float, enough: float, which: str) -> Worst:
    """The point of segments that is furthest from others, its distance right to accuracy; or any within enough.

    Pieces are halved while the distance might exceed the largest found so far. It cannot exceed what is reached from
    the ends at the piece's own length; nor, since the distance from one segment is convex along another, the larger of
    the two ends' distances from any one segment.
    """
    tree = Tree(others.ends)
    best = Worst(0.0, segments.ends[0, 0], int(segments.curve[0]), 0.0, which)

    def looked(owner: Ints, share: Floats, seen: Worst, tried: Sequence[Ints] = ()) -> tuple[Seen, Worst]:
        points = _along(segments.ends[owner], share)
        # Half the accuracy is for distances that are not looked into, half for pieces that are not halved.
        floor = max(seen.distance + 0.5 * accuracy, enough)
        distance, by = tree.nearest(points, floor, tried)
        k = int(np.argmax(distance))
        if distance[k] > floor:
            s = owner[k]
            parameter = float(segments.index[s] + share[k])
            seen = Worst(float(distance[k]), points[k], int(segments.curve[s]), parameter, which)
        return Seen(share, points, distance, by), seen

    owner = np.arange(len(segments.ends))
    # A few true distances first spare the others: those that are smaller need not be known exactly.
    few = owner[:: max(len(owner) // 64, 1)]
    best = looked(few, np.zeros(len(few)), best)[1]
    low, best = looked(owner, np.zeros(len(owner)), best)
    # Most segments end where the next one begins.
    follows = (segments.ends[:-1, 1] == segments.ends[1:, 0]).all(axis=1)
    last = np.append(np.flatnonzero(~follows), len(owner) - 1)
    ends, best = looked(last, np.ones(len(last)), best)
    high = low.rows(np.minimum(owner + 1, len(owner) - 1))
    for all_, own in zip(high[1:], ends[1:], strict=True):
        all_[last] = own
    high = high._replace(share=np.ones(len(owner)))
    while len(owner):
        middle, best = looked(owner, 0.5 * (low.share + high.share), best, (low.by, high.by))
        open_ = _beyond(max(best.distance + accuracy, enough), others.ends, low, middle, high)
        low, middle, high = low.rows(open_), middle.rows(open_), high.rows(open_)
        owner = np.tile(owner[open_], 2)
        low, high = low.and_(middle), middle.and_(high)
    return best


class Seen(NamedTuple):
    """Points (n,d) at shares of segments, their distances from other segments, and the index of one of these that is
    as near."""

    share: Floats
    points: Floats
    distance: Floats
    by: Ints

    def rows(self, kept: Ints) -> Seen:
        """Some of them."""
        return Seen(self.share[kept], self.points[kept], self.distance[kept], self.by[kept])

    def and_(self, more: Seen) -> Seen:
        """These, and more."""
        return Seen(*(np.concatenate(pair) for pair in zip(self, more, strict=True)))


def _beyond(limit: float, others: Floats, low: Seen, middle: Seen, high: Seen) -> Ints:
    """Which pieces from low to high may be farther away than the limit, by all that is known of them."""
    found = np.flatnonzero(0.5 * (low.distance + high.distance + norm(high.points - low.points)) > limit)
    for by in (low.by, middle.by, high.by):
        one = others[by[found]]
        far = np.maximum(to_segments(low.points[found], one), to_segments(high.points[found], one))
        found = found[far > limit]
    return found


def _along(ends: Floats, share: Floats) -> Floats:
    return np.asarray(ends[:, 0] * (1.0 - share[:, None]) + ends[:, 1] * share[:, None])


AnySurface = Surface | ImplicitSurface


class Places(NamedTuple):
    """What a surface is at some points (n,3): distance (n,k) from k places on it near each, unit normals (n,k,3) and
    parameters (n,k,2) there (None: the surface has none), and the extent of the surface."""

    distance: Floats
    normals: Floats
    parameters: Floats | None
    extent: float

    def name(self, k: int, j: int) -> str:
        """The parameters of a place, in words."""
        if self.parameters is None:
            return ""
        u, v = self.parameters[k, j]
        return f" at u = {u:.10g}, v = {v:.10g}"


def assert_on_surface(points: Curves, surface: AnySurface, tolerance: float) -> None:
    """Nothing, where all points of curves lie within a distance of tolerance from a surface.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 3); of a drawing those in the world.
    surface : Surface or ImplicitSurface
        Where they shall lie.
    tolerance : float
        In world units.

    Raises
    ------
    AssertionError
        With the worst point, its parameters and its distance; for no points at all and points that are not finite.
    InputError
        For a tolerance that is not positive and finite, and for what is no surface or no curve in space.

    Notes
    -----
    The distance from an implicit surface is taken as abs(F) / abs(gradient of F), right to first order; from a
    parametrised one it is that of the nearest point found from a grid of parameters.

    Edge cases: where F is 0 the distance is 0, whatever the gradient.

    Examples
    --------
    >>> from vectorplot.surfaces import implicit_sphere
    >>> from vectorplot.testing import assert_on_surface
    >>> assert_on_surface([(1, 0, 0), (0, 1, 0), (0.6, 0, 0.8)], implicit_sphere(radius=1.0), tolerance=1e-9)
    """
    _check_tolerance(tolerance)
    found = _points_in_space(points)
    places = places_near(surface, found.points)
    _assert_near(found, places, tolerance, "the surface")


def assert_on_both(points: Curves, a: AnySurface, b: AnySurface, tolerance: float) -> None:
    """Nothing, where all points of curves lie within a distance of tolerance from two surfaces: their intersection.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 3); of a drawing those in the world.
    a, b : Surface or ImplicitSurface
        Where they shall lie.
    tolerance : float
        In world units.

    Raises
    ------
    AssertionError
        With the surface, the worst point, its parameters and its distance; see assert_on_surface.
    InputError
        For what assert_on_surface refuses.

    Examples
    --------
    >>> from vectorplot.surfaces import implicit_sphere
    >>> from vectorplot.surfaces.quadrics import implicit_plane
    >>> from vectorplot.testing import assert_on_both
    >>> equator = [(1, 0, 0), (0.6, 0.8, 0), (0, 1, 0)]
    >>> plane = implicit_plane((0, 0, 0), (0, 0, 1), box=[(-1, -1, -1), (1, 1, 1)])
    >>> assert_on_both(equator, implicit_sphere(radius=1.0), plane, tolerance=1e-9)
    """
    _check_tolerance(tolerance)
    found = _points_in_space(points)
    for surface, name in ((a, "the first surface"), (b, "the second surface")):
        _assert_near(found, places_near(surface, found.points), tolerance, name)


def assert_contour(points: Curves, surface: AnySurface, eye: Camera | ArrayLike, tolerance: float) -> None:
    """Nothing, where all points of curves are points of the contour of a surface: n . (x - eye) = 0.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 3); of a drawing those in the world.
    surface : Surface or ImplicitSurface
        Whose contour it is.
    eye : Camera or (3,) array_like of float
        A camera, which may be parallel, or the place of the eye.
    tolerance : float
        The angle in radians that the sight ray may make with the tangent plane; and, times the extent of the surface,
        the distance that points may have from it.

    Raises
    ------
    AssertionError
        With the worst point, its parameters and its angle; for points without a normal; for what assert_on_surface
        finds.
    InputError
        For a tolerance that is not positive and finite, and for what is no surface or no curve in space.

    Notes
    -----
    Edge cases: of several sheets that meet in a point, one that fits is enough.

    Source: Glaeser, section 8.4, equation 27.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.surfaces import Sphere
    >>> from vectorplot.testing import assert_contour
    >>> t = np.linspace(0.0, 2.0 * np.pi, 25)
    >>> equator = np.column_stack([np.cos(t), np.sin(t), 0.0 * t])
    >>> assert_contour(equator, Sphere(radius=1.0), vp.Camera.view("top"), tolerance=1e-9)
    """

    def error(rays: Floats, normals: Floats) -> Floats:
        across = length(np.cross(normals, rays))
        return np.asarray(np.abs(arctan2((normals * rays).sum(axis=-1), across)))

    found, places = _on(points, surface, tolerance)
    text = "not on the contour: the angle between sight ray and tangent plane"
    _assert_angle(found, places, error(_sight_rays(found.points, eye)[:, None], places.normals), tolerance, text)


def assert_isophote(
    points: Curves, surface: AnySurface, light: Light | ArrayLike, angle: float, tolerance: float
) -> None:
    """Nothing, where all points of curves are points of an isophote: normal and direction to the light make an angle.

    Parameters
    ----------
    points : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 3); of a drawing those in the world.
    surface : Surface or ImplicitSurface
        Whose isophote it is.
    light : Light or (3,) array_like of float
        A light, which may be a point, or the direction to it.
    angle : float
        In radians, 0 to pi, with the surface's own normals: x_u cross x_v, or the gradient; on the other side it is pi
        less that.
    tolerance : float
        The difference of angles that is allowed, in radians; and, times the extent of the surface, the distance of
        points from it.

    Raises
    ------
    AssertionError
        With the worst point, its parameters and its angle; for points without a normal; for what assert_on_surface
        finds.
    InputError
        For an angle that is not between 0 and pi, a tolerance that is not positive and finite, and for what is no
        surface or no curve in space.

    Notes
    -----
    Edge cases: of several sheets that meet in a point, one that fits is enough.

    Source: Glaeser, section 8.4, equation 28.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Sphere
    >>> from vectorplot.testing import assert_isophote
    >>> t = np.linspace(0.0, 2.0 * np.pi, 25)
    >>> circle = np.column_stack([0.8 * np.cos(t), 0.8 * np.sin(t), 0.6 + 0.0 * t])
    >>> assert_isophote(circle, Sphere(radius=1.0), (0, 0, 1), np.arccos(0.6), tolerance=1e-9)
    """
    if not 0.0 <= angle <= np.pi:
        raise InputError(f"isophote: an angle of {angle:g} is not between 0 and pi")
    found, places = _on(points, surface, tolerance)
    rays, normals = _light_rays(found.points, light)[:, None], places.normals
    error = np.abs(arctan2(length(np.cross(normals, rays)), (normals * rays).sum(axis=-1)) - angle)
    text = f"not on the isophote of {angle:.10g}: the difference of the angle between normal and light"
    _assert_angle(found, places, error, tolerance, text)


def assert_same_curve(a: Curves, b: Curves, tolerance: float, *, closed: bool = False) -> None:
    """Nothing, where two curves are within tolerance of each other everywhere, between their points too.

    Parameters
    ----------
    a, b : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 2 or 3); of a drawing those in the world.
    tolerance : float
        The Hausdorff distance that is allowed.
    closed : bool
        Both close even where the last point does not repeat the first.

    Raises
    ------
    AssertionError
        With the worst point, where it is on its curve, and its distance from the other one.
    InputError
        For a tolerance that is not positive and finite, for what is no curve, and for one in the plane and one in
        space.

    Notes
    -----
    Direction, start, sampling and splitting do not matter: curves are compared as sets of points.

    Examples
    --------
    >>> from vectorplot.testing import assert_same_curve
    >>> assert_same_curve([(0, 0), (2, 0)], [[(2, 0), (1, 0)], [(1, 0), (0, 0)]], tolerance=1e-9)
    """
    _check_tolerance(tolerance)
    worst = worst_of_both(a, b, closed=closed, accuracy=ACCURACY_OF_TOLERANCE * tolerance, enough=tolerance)
    assert worst.distance <= tolerance, _difference(worst, tolerance)


def assert_closed(curve: Curves, tolerance: float | None = None) -> None:
    """Nothing, where every curve ends where it starts.

    Parameters
    ----------
    curve : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 2 or 3).
    tolerance : float, optional
        The gap that is allowed; 1e-9 of the extent of each curve where None.

    Raises
    ------
    AssertionError
        With the curve, its two ends and the gap between them; for curves of one place only, no points at all and points
        that are not finite.
    InputError
        For what is no curve.

    Examples
    --------
    >>> from vectorplot.testing import assert_closed
    >>> assert_closed([(0, 0), (1, 0), (1, 1), (0, 0)])
    >>> assert_closed([(0, 0), (1, 0), (1, 1)])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    AssertionError: 1 of 1 curves are open: from point 0, (0, 0), to point 2, (1, 1), there is a gap of 1.414, ...
    """
    found = points_of(curve)
    first = np.flatnonzero(found.place == 0)
    last = np.append(first[1:], len(found.points)) - 1
    extent = length(np.maximum.reduceat(found.points, first) - np.minimum.reduceat(found.points, first))
    gap = length(found.points[last] - found.points[first])
    assert (extent > 0.0).all(), f"curve {int(np.argmin(extent))} is a single place"
    allowed = ZERO_OF_EXTENT * extent if tolerance is None else np.full(len(first), tolerance)
    worst = int(np.argmax(gap / np.maximum(allowed, LEAST_DIVISOR)))
    assert gap[worst] <= allowed[worst], (
        f"{int((gap > allowed).sum())} of {len(first)} curves are open: from {found.name(int(first[worst]))}, to "
        f"{found.name(int(last[worst]))}, there is a gap of {gap[worst]:.4g}, tolerance {allowed[worst]:.4g}"
    )


class BranchCount(NamedTuple):
    """How many connected pieces curves have.

    closed: pieces without a loose end; open: pieces with one or more; nodes: at how many places more than two ends
    meet.
    """

    closed: int
    open: int
    nodes: int


def branch_count(curves: Curves, tolerance: float | None = None) -> BranchCount:
    """How many branches there are when polylines are joined whose ends meet.

    Parameters
    ----------
    curves : array_like, list of them, Strokes, Paths or Drawing
        Polylines (n, 2 or 3); of a drawing those in the world. A closed one repeats its first point.
    tolerance : float, optional
        How far ends that meet may be apart; 1e-9 of the extent where None.

    Returns
    -------
    BranchCount
        Of closed ones, of open ones, and of nodes: the cutting of a curve into strokes does not count.

    Raises
    ------
    InputError
        For what is no curve.
    AssertionError
        For points that are not finite.

    Notes
    -----
    Edge cases: polylines of one place do not count at all; curves that cross between their ends are not joined.

    Examples
    --------
    >>> from vectorplot.testing import branch_count
    >>> halves = [[(0, 0), (1, 0), (1, 1)], [(1, 1), (0, 1), (0, 0)]]
    >>> branch_count(halves)
    BranchCount(closed=1, open=0, nodes=0)
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    parts = [part for part in polylines_of(curves) if np.ptp(part, axis=0).any()]
    if not parts:
        return BranchCount(0, 0, 0)
    ends = points_of([end for part in parts for end in (part[:1], part[-1:])]).points
    extent = float(norm(np.ptp(np.concatenate(parts), axis=0)))
    pairs = cKDTree(ends).query_pairs(
        ZERO_OF_EXTENT * extent if tolerance is None else tolerance, output_type="ndarray"
    )

    def groups(links: ArrayLike, count: int) -> tuple[int, Floats]:
        i, j = np.asarray(links).reshape(-1, 2).T
        return connected_components(coo_array((np.ones(len(i)), (i, j)), shape=(count, count)), directed=False)  # type: ignore[no-any-return]

    count, node = groups(pairs, len(ends))
    degree = np.bincount(node, minlength=count)
    branches, branch = groups(node.reshape(-1, 2), count)
    loose = np.bincount(branch[degree == 1], minlength=branches) > 0
    return BranchCount(int((~loose).sum()), int(loose.sum()), int((degree > 2).sum()))


def places_near(surface: AnySurface, points: Floats) -> Places:
    """The places of a surface near points (n,3); of an implicit surface the point itself stands for its place."""
    implicit = callable(getattr(surface, "gradients", None))
    if not implicit and not callable(getattr(surface, "partials", None)):
        raise InputError(f"{type(surface).__name__} is no surface: it has neither partials nor gradients")
    return _implicit_places(surface, points) if implicit else _parametrised_places(surface, points)  # type: ignore[arg-type]


def _implicit_places(surface: ImplicitSurface, points: Floats) -> Places:
    value, gradient = np.abs(surface.values(points)), surface.gradients(points)
    slope = length(gradient)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.where(value == 0.0, 0.0, value / slope)
        normals = gradient / slope[:, None]
    distance = np.where(np.isnan(distance), np.inf, distance)
    extent = float(norm(np.ptp(np.asarray(surface.box), axis=0)))
    return Places(distance[:, None], normals[:, None], None, extent)


def _parametrised_places(surface: Surface, points: Floats) -> Places:
    feet = nearest_places(surface, points)
    normals = unit_normals(surface, feet.u, feet.v)
    return Places(feet.distance, normals, np.stack([feet.u, feet.v], axis=-1), feet.extent)


def _points_in_space(points: Curves) -> CurvePoints:
    found = points_of(points)
    if found.points.shape[1] != 3:
        raise InputError("points on surfaces have three coordinates")
    return found


def _check_tolerance(tolerance: float) -> None:
    if not 0.0 < tolerance < np.inf:
        raise InputError(f"tolerance {tolerance:g} must be positive and finite")


def _on(points: Curves, surface: AnySurface, tolerance: float) -> tuple[CurvePoints, Places]:
    """Points and their places on a surface. Errors: AssertionError where they are not on it."""
    _check_tolerance(tolerance)
    found = _points_in_space(points)
    places = places_near(surface, found.points)
    _assert_near(found, places, tolerance * places.extent, "the surface")
    return found, places


def _assert_near(found: CurvePoints, places: Places, tolerance: float, name: str) -> None:
    """Nothing where the nearest place of each point is within tolerance."""
    nearest = np.argmin(places.distance, axis=1)
    distance = places.distance[np.arange(len(nearest)), nearest]
    k = int(np.argmax(distance))
    assert distance[k] <= tolerance, (
        f"{int((distance > tolerance).sum())} of {len(distance)} points are not on {name}: the worst, "
        f"{found.name(k)}{places.name(k, int(nearest[k]))}, is {distance[k]:.4g} away, tolerance {tolerance:.4g}"
    )


def _assert_angle(found: CurvePoints, places: Places, error: Floats, tolerance: float, text: str) -> None:
    """Nothing where the angle is right on one sheet at least through each point."""
    sheet = places.distance <= tolerance * places.extent
    known = np.isfinite(error) & sheet
    lost = np.flatnonzero(~known.any(axis=1))
    assert not len(lost), f"{len(lost)} points have no normal, the first: {found.name(int(lost[0]))}"
    error = np.where(known, error, np.inf)
    best = np.argmin(error, axis=1)
    least = error[np.arange(len(best)), best]
    k = int(np.argmax(least))
    assert least[k] <= tolerance, (
        f"{int((least > tolerance).sum())} of {len(least)} points are {text} is {least[k]:.4g} at the worst, "
        f"{found.name(k)}{places.name(k, int(best[k]))}, tolerance {tolerance:.4g}"
    )


def _unit_arms(points: Floats, place: Floats) -> Floats:
    """(n,3) unit vectors from points to a place; NaN where they coincide."""
    arm = place - points
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(arm / length(arm)[:, None])


def _sight_rays(points: Floats, eye: Camera | ArrayLike) -> Floats:
    """(n,3) unit vectors to the eye."""
    if isinstance(eye, Camera) and eye.parallel:
        return np.broadcast_to(eye.direction, points.shape)
    return _unit_arms(points, vector("eye", eye.eye if isinstance(eye, Camera) else eye))


def _light_rays(points: Floats, light: Light | ArrayLike) -> Floats:
    """(n,3) unit vectors to the light."""
    if isinstance(light, Light) and not light.parallel:
        return _unit_arms(points, vector("light", light.position))
    direction = vector("light", light.position if isinstance(light, Light) else light)
    return np.broadcast_to(normalize(direction), points.shape)


def _difference(worst: Worst, tolerance: float) -> str:
    """One line on where a curve leaves the other one."""
    place = ", ".join(f"{x:.10g}" for x in worst.point)
    return (
        f"the curves differ: ({place}), at {worst.parameter:.6g} (index and share of the segment) of the "
        f"{worst.which} one's curve {worst.curve}, is {worst.distance:.4g} away from the other, "
        f"tolerance {tolerance:.4g}"
    )


# Assertion about the chords of curves that follow a field of directions.


class _Ends(NamedTuple):
    """The angles (k,) of chords with the field at one of their ends, NaN where it has no direction there, and the
    direction (k,3) of it that is meant."""

    angle: Floats
    direction: Floats


def assert_chords(lines: list[Floats], surface: Surface, field: TangentField, tolerance: float) -> None:
    """That every chord of polylines (n,3) on a surface follows the field: off it by no more than the field turns along
    the chord, and an angle. A chord is a mean of the directions of its curve: where they turn one way it is nearer
    to both ends' than these are to each other; where they turn back, nearer than the middle's. Points may be off the
    surface by tolerance times its extent, chords by as much of their length.
    Edge cases: ends without a direction are ignored.
    """
    begin = np.concatenate([line[:-1] for line in lines])
    chords = np.concatenate([np.diff(line, axis=0) for line in lines])
    length = norm(chords)
    begin, chords, length = begin[length > 0.0], chords[length > 0.0], length[length > 0.0]
    extent, first = _directions(begin, chords, surface, field)
    _, last = _directions(begin + chords, chords, surface, field)
    error = np.fmax(first.angle, last.angle) - _angles(first.direction, last.direction)
    noise = tolerance * extent / length
    doubtful = np.flatnonzero(error > tolerance + noise)
    if len(doubtful):
        _, middle = _directions(begin[doubtful] + 0.5 * chords[doubtful], chords[doubtful], surface, field)
        turns = [_angles(end.direction[doubtful], middle.direction) for end in (first, last)]
        farthest = np.fmax(first.angle, last.angle)[doubtful]
        error[doubtful] = np.fmin(error[doubtful], farthest - np.fmax(*turns))
    over = np.nan_to_num(error - noise, nan=-np.inf)
    k = int(np.argmax(over))
    where = ", ".join(f"{x:.10g}" for x in begin[k])
    assert over[k] <= tolerance, (
        f"{int((over > tolerance).sum())} of {len(over)} chords are not on a curve of the field: the angle is "
        f"{error[k]:.4g} more than it turns at the worst, behind ({where}), tolerance {tolerance:.4g}"
    )


def _directions(points: Floats, chords: Floats, surface: Surface, field: TangentField) -> tuple[float, _Ends]:
    """The extent of a surface; which of a field's directions at points (k,3) is nearest to chords (k,3), and by which
    angle."""
    places = places_near(surface, points)
    assert places.parameters is not None
    row = np.arange(len(points))
    u, v = places.parameters[row, np.argmin(places.distance, axis=1)].T
    candidates = field.tangents(Sites(surface, np.ascontiguousarray(u), np.ascontiguousarray(v)))
    angles = _angles(candidates, np.broadcast_to(unit(chords), candidates.shape))
    best = np.argmin(np.where(np.isfinite(angles), angles, np.inf), axis=0)
    return places.extent, _Ends(angles[best, row], candidates[best, row])


def _angles(a: Floats, b: Floats) -> Floats:
    """(...) between straight lines with unit directions (...,3)."""
    return np.asarray(arctan2(norm(cross(a, b)), np.abs(dot(a, b))))
