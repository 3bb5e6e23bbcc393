"""Solids as meshes: boxes, polyhedra, bodies of revolution, and prisms with holes through them."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul, singular_decomposition
from vectorplot.geometry.convex_polygons import convex_polygon_parts, plane_axes
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import FLAT_OF_EXTENT, HALF_TURN_ROUNDING, LEAST_DIVISOR, ROUNDING, ZERO_OF_EXTENT

# Solids as meshes: boxes, and polyhedra given by their faces.

BOTTOM, TOP = "bottom", "top"
BOTH_CAPS = (BOTTOM, TOP)

IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
"""A placement: the three rows of a 3x4 matrix (rotation and translation) acting on columns, one after the other."""

DISTANCES_AT_ONCE = 1 << 20
"""So many distances of vertices from planes are held at a time; where there are more, a convex hull comes first."""

_BOX = ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (3, 2, 1, 0), (4, 5, 6, 7))


def box(lengths: Sequence[float], *, caps: Collection[str] = BOTH_CAPS, placement: Sequence[float] = IDENTITY) -> Mesh:
    """The box with one corner in the origin and edges of three lengths along the axes, then placed.

    Parameters
    ----------
    lengths : (3,) sequence of float
        Along x, y and z; a negative length points the other way.
    caps : collection of {"bottom", "top"}
        Which of them are present; a hollow box has none.
    placement : (12,) sequence of float
        The three rows of a 3x4 matrix (rotation and translation) acting on columns, one after the other.

    Returns
    -------
    Mesh
        Faces: the four sides, beginning at y = 0, then bottom and top. A placement that mirrors turns the faces round.

    Raises
    ------
    InputError
        For a length that is zero or not finite, and for a placement that is not finite.

    Notes
    -----
    Source: Glaeser, section 3.5.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> raised = geometry.box((2, 3, 4), placement=(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5))
    >>> raised.face_count, raised.bounds.tolist()
    (6, [[0.0, 0.0, 5.0], [2.0, 3.0, 9.0]])
    >>> geometry.box((2, 3, 4), caps=()).present.tolist()
    [True, True, True, True, False, False]
    """
    x, y, z = lengths
    a, b, c, t, d, e, f, u, g, h, i, v = placement
    if not isfinite(abs(x) + abs(y) + abs(z)) or x == 0.0 or y == 0.0 or z == 0.0:
        raise InputError(f"box {x:g} {y:g} {z:g}: three finite lengths other than zero are needed")
    # The corners written out: a scene may hold thousands of boxes, and matrix products cost several times as much.
    ax, dx, gx = a * x + t, d * x + u, g * x + v
    by, ey, hy = b * y, e * y, h * y
    cz, fz, iz = c * z, f * z, i * z
    ty, uy, vy = t + by, u + ey, v + hy
    axy, dxy, gxy = ax + by, dx + ey, gx + hy
    low = [t, u, v, ax, dx, gx, axy, dxy, gxy, ty, uy, vy]
    high = [t + cz, u + fz, v + iz, ax + cz, dx + fz, gx + iz, axy + cz, dxy + fz, gxy + iz, ty + cz, uy + fz, vy + iz]
    if not all(map(isfinite, low + high)):
        raise InputError(f"box {x:g} {y:g} {z:g}: its placement is not finite, or too large")
    vertices = np.array(low + high, dtype=np.float64).reshape(8, 3)
    mirrored = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0.0
    turned = (x < 0.0) ^ (y < 0.0) ^ (z < 0.0) ^ mirrored
    corners, offsets, present = _box_faces(turned, BOTTOM in caps, TOP in caps)
    return Mesh._trusted(vertices, corners, offsets, present)


@cache
def _box_faces(turned: bool, bottom: bool, top: bool) -> tuple[Ints, Ints, Bools | None]:
    """Corners, offsets and presence of the faces of a box: one set of arrays that all alike boxes share."""
    corners = np.array([face[::-1] if turned else face for face in _BOX], dtype=np.intp).reshape(-1)
    offsets = np.arange(0, 25, 4, dtype=np.intp)
    present = None if bottom and top else np.array([True, True, True, True, bottom, top])
    for array in (corners, offsets, present):
        if array is not None:
            array.flags.writeable = False
    return corners, offsets, present


def placed(mesh: Mesh, placement: Sequence[float]) -> Mesh:
    """The mesh under a placement.

    Parameters
    ----------
    mesh : Mesh
        Where it was made.
    placement : (12,) sequence of float
        The three rows of a 3x4 matrix (rotation and translation) acting on columns, one after the other.

    Returns
    -------
    Mesh
        With the same faces; a placement that mirrors turns them round.

    Raises
    ------
    InputError
        For a placement that is not finite.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.placed(geometry.box((1, 1, 1)), (1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0)).bounds.tolist()
    [[5.0, 0.0, 0.0], [6.0, 1.0, 1.0]]
    """
    if tuple(placement) == IDENTITY:
        return mesh
    return mesh.transformed(np.array([*placement, 0.0, 0.0, 0.0, 1.0]).reshape(4, 4))


def checked_points(points: ArrayLike, word: str) -> Floats:
    """(n,3) the points. Errors: InputError for anything but points of three finite numbers; word: what they go by."""
    array = np.asarray(points, dtype=np.float64)
    if array.ndim != 2 or array.shape[1:] != (3,) or not np.isfinite(array).all():
        raise InputError(f"{word} must be points of three finite numbers")
    return array


def presence(count: int, shown: Collection[str], stored: Sequence[str]) -> Bools:
    """(count,) flags: all True but for the stored caps, which come last, that are not shown."""
    present = np.ones(count, dtype=np.bool_)
    present[count - len(stored) :] = [cap in shown for cap in stored]
    return present


def polyhedron(vertices: ArrayLike, faces: Sequence[Sequence[int]]) -> Mesh:
    """The polyhedron with some faces, turned outwards if its outline is convex.

    Parameters
    ----------
    vertices : (n, 3) array_like of float
        In world units.
    faces : sequence of sequences of int
        Vertex indices from 0.

    Returns
    -------
    Mesh
        A convex body may list its faces either way round; others are left as they are listed.

    Raises
    ------
    InputError
        For what Mesh refuses.

    Notes
    -----
    Source: Glaeser, sections 3.2 and 3.3; erratum G3-18.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> corners, faces = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)]
    >>> tetrahedron = geometry.polyhedron(corners, faces)
    >>> tetrahedron.polygons()
    [[2, 1, 0], [0, 1, 3], [1, 2, 3], [3, 2, 0]]
    """
    mesh = Mesh.from_polygons(vertices, faces)
    turned = turned_outwards(mesh)
    return turned if has_convex_outline(turned) else mesh


def turned_outwards(mesh: Mesh) -> Mesh:
    """The mesh with every face turned so that its normal leads away from the barycentre of the vertices.

    Right for convex bodies and parts of their surfaces, whichever way their faces are listed.
    Source: Glaeser, section 3.2.
    """
    used = np.unique(mesh.corners)
    if not len(used):
        return mesh
    centre = mesh.vertices[used].mean(axis=0)
    inward = np.einsum("ij,ij->i", mesh.area_vectors, mesh.vertices[mesh.corners[mesh.offsets[:-1]]] - centre) < 0.0
    if not inward.any():
        return mesh
    turned = mesh.reversed()
    corners = np.where(inward[mesh.corner_face], turned.corners, mesh.corners)
    return Mesh(mesh.vertices, corners, mesh.offsets, mesh.present)


def zero_distance(points: Floats) -> float:
    """The distance up to which points (n,3) like these lie in one plane: by their extent, and by what rounding does."""
    return max(ZERO_OF_EXTENT * float(np.ptp(points, axis=0).max()), ROUNDING * float(np.abs(points).max()))


def has_convex_outline(mesh: Mesh) -> bool:
    """Whether no vertex lies outside the plane of any face.

    Parameters
    ----------
    mesh : Mesh
        Its faces turned outwards.

    Returns
    -------
    bool
        True for convex bodies and for parts of their surfaces.

    Notes
    -----
    Edge cases: faces without area say nothing; a vertex nearer to a plane than about 1e-9 of the extent lies in it.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> spool = geometry.revolution([(2, 0, 0), (1, 0, 1), (2, 0, 2)], order=6)
    >>> geometry.has_convex_outline(geometry.box((1, 1, 1))), geometry.has_convex_outline(spool)
    (True, False)
    """
    used = np.unique(mesh.corners)
    if not len(used):
        return True
    points = mesh.vertices[used]
    zero = zero_distance(points)
    first = mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
    centre = points.mean(axis=0)
    arms, normals = points - centre, mesh.face_normals
    constants = np.einsum("ij,ij->i", normals, first - centre)
    if mesh.face_count * len(points) > DISTANCES_AT_ONCE:
        doubtful = ~_touch_hull(arms, normals, constants, zero)
        normals, constants = normals[doubtful], constants[doubtful]
    # In pieces of planes, so that the table of distances never gets large; most non-convex bodies fail in the first.
    piece = max(1, DISTANCES_AT_ONCE // len(points))
    for start in range(0, len(normals), piece):
        if (matmul(arms, normals[start : start + piece].T) - constants[start : start + piece]).max() > zero:
            return False
    return True


def _touch_hull(points: Floats, normals: Floats, constants: Floats, zero: float) -> Bools:
    """(f,) which planes normal . p = constant are, up to zero, faces' planes of the convex hull of points (n,3) around
    the origin: no point lies outside them. Of a plane with another place or direction nothing is said.

    Edge cases: points in one plane have a hull of two faces; planes without a direction touch it.
    """
    from scipy.spatial import ConvexHull, QhullError, cKDTree

    reach = float(np.linalg.norm(points, axis=1).max())
    try:
        hull = ConvexHull(points / reach).equations
        sides, ends = hull[:, :3], -reach * hull[:, 3]
    except QhullError:
        sides = singular_decomposition(points)[2][2] * np.array([[1.0], [-1.0]])
        ends = (matmul(points, sides.T)).max(axis=0)
    _, nearest = cKDTree(sides).query(normals)
    turned = np.linalg.norm(normals - sides[nearest], axis=1)
    return np.asarray((ends[nearest] + turned * reach <= constants + zero) | ~normals.any(axis=1))


# Polyhedra that stand for surfaces of revolution about the z-axis.

MAX_ORDER = 100_000
"""The largest number of sides."""

MAX_VERTICES = 20_000_000
"""The largest number of vertices: points of the meridian times order."""

FULL_TURN = 360.0
"""Degrees of a body that closes on itself."""

HALF_TURN = 180.0
"""Degrees between opposite half-planes through the axis."""


def revolution(
    meridian: ArrayLike, order: int, *, angle_deg: float = FULL_TURN, caps: Collection[str] = BOTH_CAPS
) -> Mesh:
    """The polyhedron that a meridian polygon sweeps in equal steps about the z-axis.

    Parameters
    ----------
    meridian : (s, 3) array_like of float
        Runs upwards in a half-plane through the axis.
    order : int
        The points of every ring.
    angle_deg : float
        360 for a full turn. Less: a closed body; order - 1 steps, and planar end faces through the first and the last
        meridian that reach to the axis (after half a turn the two are one face).
    caps : collection of {"bottom", "top"}
        Which of bottom (at the meridian's first end) and top are present, where that end lies off the axis; the others
        are stored, but not present.

    Returns
    -------
    Mesh
        Vertices ring by ring; faces band by band from the first end, then end faces, bottom, top.

    Raises
    ------
    InputError
        For an order or an angle out of bounds, fewer than two different points, a meridian that lies on the axis, and,
        with an angle, one that does not lie in a half-plane through it.

    Notes
    -----
    A meridian that ends where it begins sweeps a ring without caps. Of a meridian outside a half-plane the patches are
    cut into triangles.

    Edge cases: points on the axis stay single vertices; a meridian that runs downwards has its faces turned outwards.

    Source: Glaeser, section 3.4; errata G3-11, D-4.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> cone = geometry.revolution([(1, 0, 0), (0, 0, 2)], order=12)
    >>> len(cone.vertices), cone.face_sizes.tolist()
    (13, [3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 12])
    >>> geometry.revolution([(1, 0, 0), (0, 0, 2)], order=5, angle_deg=90).face_count
    7
    """
    profile = _profile(meridian, order, angle_deg)
    quads, keep = _bands(profile)
    corners = quads[keep]
    sizes = keep.sum(axis=-1).reshape(-1)
    rings = profile.rings()
    polygons: list[Ints] = []
    stored: list[str] = []
    feet: list[Floats] = []
    if not profile.is_full:
        rings, polygons, feet = _end_faces(profile, rings)
    if not profile.closed:
        for cap, end in ((BOTTOM, 0), (TOP, -1)):
            if not profile.on_axis[end]:
                polygons.append(_cap(rings, cap))
                stored.append(cap)
    vertices = np.concatenate([profile.vertices(), *feet])
    all_sizes = np.concatenate([sizes[sizes > 0], [len(polygon) for polygon in polygons]]).astype(np.intp)
    offsets = ragged.offsets(all_sizes)
    mesh = Mesh(vertices, np.concatenate([corners, *polygons]), offsets, presence(len(all_sizes), caps, stored))
    return mesh.reversed() if profile.runs_down else mesh


@dataclass(frozen=True, eq=False)
class _Profile:
    """A checked meridian: points (s,3), on_axis (s,); closed: the last point joins the first."""

    points: Floats
    on_axis: Bools
    closed: bool
    order: int
    angle_deg: float

    @property
    def is_full(self) -> bool:
        return self.angle_deg == FULL_TURN

    @property
    def is_half(self) -> bool:
        return abs(self.angle_deg - HALF_TURN) <= HALF_TURN_ROUNDING * HALF_TURN

    @property
    def runs_down(self) -> bool:
        """Whether the swept body has a negative volume: the rings' frusta, summed up with the sign of their height."""
        r, z = np.hypot(self.points[:, 0], self.points[:, 1]), self.points[:, 2]
        above, r_above = np.roll(z, -1), np.roll(r, -1)
        frusta = (above - z) * (r * r + r * r_above + r_above * r_above)
        return bool((frusta if self.closed else frusta[:-1]).sum() < 0.0)

    def rings(self) -> Ints:
        """(s, order) vertex number of every point of the meridian at every step."""
        sizes = np.where(self.on_axis, 1, self.order)
        first = ragged.starts(sizes)
        return np.asarray(first[:, None] + np.where(self.on_axis[:, None], 0, np.arange(self.order)))

    def vertices(self) -> Floats:
        """(n,3) the vertices ring by ring."""
        steps = self.order if self.is_full else self.order - 1
        angle = np.radians(self.angle_deg * np.arange(self.order) / steps)
        cos, sin = np.cos(angle), np.sin(angle)
        x, y, z = (self.points[:, k, None] for k in range(3))
        everything = np.stack([x * cos - y * sin, x * sin + y * cos, np.broadcast_to(z, (len(z), self.order))], axis=-1)
        chosen = ~self.on_axis[:, None] | (np.arange(self.order) == 0)
        return np.asarray(everything[chosen])


def _profile(meridian: ArrayLike, order: int, angle_deg: float) -> _Profile:
    points = checked_points(meridian, "meridian")
    if not 0.0 < angle_deg <= FULL_TURN:
        raise InputError(f"rot_angle {angle_deg:g}: expected degrees between 0 and 360")
    least = 3 if angle_deg >= HALF_TURN else 2
    if not least <= order <= MAX_ORDER:
        raise InputError(f"order {order}: expected a number from {least} to {MAX_ORDER}")
    if angle_deg < FULL_TURN and angle_deg >= HALF_TURN * (order - 1):
        raise InputError(f"order {order} is too small for rot_angle {angle_deg:g}")
    if len(points) * order > MAX_VERTICES:
        raise InputError(f"{len(points)} points of the meridian times order {order}: more than {MAX_VERTICES} vertices")
    changes = np.ones(len(points), dtype=np.bool_)
    changes[1:] = (points[1:] != points[:-1]).any(axis=1)
    points = points[changes]
    if len(points) < 2:
        raise InputError("a meridian needs at least two different points")
    closed = len(points) > 3 and bool(norm(points[0] - points[-1]) <= zero_distance(points))
    points = points[:-1].copy() if closed else points
    extent = max(float(np.abs(points[:, :2]).max()), float(np.ptp(points[:, 2])))
    on_axis = np.hypot(points[:, 0], points[:, 1]) <= ZERO_OF_EXTENT * extent
    points[on_axis, :2] = 0.0
    if on_axis.all():
        raise InputError("the meridian lies on the axis")
    profile = _Profile(points, on_axis, closed, order, angle_deg)
    if not profile.is_full and _twisted(profile).any():
        raise InputError("a meridian with rot_angle must lie in one half-plane through the axis")
    return profile


def _twisted(profile: _Profile) -> Bools:
    """(s,) whether a point and the next one lie off the axis and in different half-planes through it."""
    here, there = profile.points, np.roll(profile.points, -1, axis=0)
    across = here[:, 0] * there[:, 1] - here[:, 1] * there[:, 0]
    along = here[:, 0] * there[:, 0] + here[:, 1] * there[:, 1]
    off_axis = ~profile.on_axis & ~np.roll(profile.on_axis, -1)
    return off_axis & ((np.abs(across) > ZERO_OF_EXTENT * np.abs(along)) | (along < 0.0))


def _bands(profile: _Profile) -> tuple[Ints, Bools]:
    """Patches (bands, steps, 2, 4) of vertex numbers, and which of them are corners of a face.

    A planar patch is one quadrilateral, one at the axis loses a corner, a twisted one is two triangles.
    """
    rings = profile.rings()
    last = len(rings) if profile.closed else len(rings) - 1
    upper, above = np.roll(rings, -1, axis=0)[:last], np.roll(profile.on_axis, -1)[:last]
    lower, below = rings[:last], profile.on_axis[:last]
    steps = profile.order if profile.is_full else profile.order - 1
    after = (np.arange(steps) + 1) % profile.order
    patch = np.stack([lower[:, :steps], lower[:, after], upper[:, after], upper[:, :steps]], axis=-1)
    keep = np.ones((last, 2, 4), dtype=np.bool_)
    twisted = _twisted(profile)[:last]
    keep[:, 0, 1] = ~below
    keep[:, 0, 3] = ~above & ~twisted
    keep[:, 1] = twisted[:, None] & np.array([True, False, True, True])
    keep[below & above] = False
    shape = (last, steps, 2, 4)
    return np.broadcast_to(patch[:, :, None, :], shape), np.broadcast_to(keep[:, None], shape)


def _end_faces(profile: _Profile, rings: Ints) -> tuple[Ints, list[Ints], list[Floats]]:
    """Rings with one more column, the axis next to an end of the meridian (-1: none); the end faces; the new vertices.

    Between two points on the axis the meridian bounds a face with it; after half a turn the faces of both ends are one.
    """
    rings = np.concatenate([rings, np.full((len(rings), 1), -1)], axis=1)
    if profile.closed:
        return rings, [rings[:, 0].copy(), rings[::-1, -2].copy()], []
    feet: list[Floats] = []
    count = int(rings.max()) + 1
    for end in (0, len(rings) - 1):
        if not profile.on_axis[end] and not profile.is_half:
            rings[end, -1] = count + len(feet)
            feet.append(np.array([[0.0, 0.0, profile.points[end, 2]]]))
    stops = [-1, *np.flatnonzero(profile.on_axis).tolist(), len(rings)]
    polygons: list[Ints] = []
    for a, b in pairwise(stops):
        if b - a < 2:
            continue
        inner = rings[a + 1 : b]
        low = rings[a, :1] if a >= 0 else inner[:1, -1]
        high = rings[b, :1] if b < len(rings) else inner[-1:, -1]
        low, high = low[low >= 0], high[high >= 0]
        if profile.is_half:
            polygons.append(np.concatenate([low, inner[:, 0], high, inner[::-1, -2]]))
        else:
            polygons.append(np.concatenate([low, inner[:, 0], high]))
            polygons.append(np.concatenate([low, high, inner[::-1, -2]]))
    return rings, polygons, feet


def _cap(rings: Ints, cap: str) -> Ints:
    """Corners of the bottom or the top: the ring, and the axis if the body is cut open."""
    ring = rings[0] if cap == BOTTOM else rings[-1]
    polygon = ring[ring >= 0]
    return np.asarray(polygon[::-1].copy() if cap == BOTTOM else polygon)


# Prisms as meshes, with holes through them.

MOST_HOLES = 5000
"""Round ones of 48 sides take ten seconds, and more than twice as long where they are twice as many."""


def prism(
    base_points: ArrayLike, vector: ArrayLike, *, caps: Collection[str] = BOTH_CAPS, holes: Sequence[ArrayLike] = ()
) -> Mesh:
    """The body that a planar polygon sweeps when it is moved along a vector.

    Parameters
    ----------
    base_points : (b, 3) array_like of float
        The base; one that runs clockwise about the vector is turned round.
    vector : (3,) array_like of float
        From the base to the top.
    caps : collection of {"bottom", "top"}
        Which of them are present.
    holes : sequence of (h, 3) array_like of float
        Polygons in the plane of the base, inside of it and apart from each other, either way round, at most 5000; holes
        go through the body. regular_polygon makes round ones.

    Returns
    -------
    Mesh
        2b vertices (the base, then the top), 3b edges; faces: the b sides in the order of the edges of the base, then
        bottom and top. With holes their corners follow those of the base, and their sides those of the base; bottom and
        top are several convex polygons each, between the same corners.

    Raises
    ------
    InputError
        For fewer than three points, points that are not finite, a vector in the plane of the base; for a hole that is
        not in the plane of the base, reaches beyond it or into another one; for too many of them.

    Warns
    -----
    InputWarning
        For a base that is not planar; it is used all the same.

    Notes
    -----
    Source: Glaeser, section 3.5.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.prism([(0, 0, 0), (1, 0, 0), (0, 1, 0)], (0, 0, 2)).polygons()
    [[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5], [2, 1, 0], [3, 4, 5]]
    >>> hole = geometry.regular_polygon(48, 1, centre=(2, 2, 0))
    >>> plate = geometry.prism([(0, 0, 0), (9, 0, 0), (9, 4, 0), (0, 4, 0)], (0, 0, 1), holes=[hole])
    >>> len(plate.vertices)
    104
    """
    body = swept_polygon(base_points, vector, caps=caps, holes=holes)
    if not is_planar(base_points):
        warnings.warn(NOT_PLANAR, InputWarning, stacklevel=2)
    return body


NOT_PLANAR = "base_points do not lie in one plane"
"""What is said of a base that is not planar."""


def is_planar(points: ArrayLike) -> bool:
    """Whether the corners of a polygon, points (b,3), lie in one plane, but for a millionth of its extent."""
    corners = np.asarray(points, dtype=np.float64)
    arm, extent = corners - corners[0], float(np.ptp(corners, axis=0).max())
    area = area_vector(corners)
    return not np.abs(matmul(arm, area)).max() > FLAT_OF_EXTENT * extent * float(norm(area))


def swept_polygon(
    base_points: ArrayLike, vector: ArrayLike, *, caps: Collection[str] = BOTH_CAPS, holes: Sequence[ArrayLike] = ()
) -> Mesh:
    """The body that prism makes, whether its base is planar or not, without a word about it. Errors: see prism."""
    base = checked_points(base_points, "base_points")
    if len(base) < 3:
        raise InputError(f"a base needs at least three points, not {len(base)}")
    step = _vector(vector, "trans_vector")
    extent = max(float(np.ptp(base, axis=0).max()), LEAST_DIVISOR)
    area = area_vector(base)
    size = float(norm(area))
    height = float(matmul(area, step))
    if not abs(height) > ZERO_OF_EXTENT * size * float(norm(step)) or not size > ZERO_OF_EXTENT * extent * extent:
        raise InputError("trans_vector lies in the plane of the base, or the base has no area")
    normal = area / size
    rings = [base, *_checked_holes(base, normal, holes)]
    bottom, shown = _bottom(rings, normal), [cap in caps for cap in BOTH_CAPS]
    points = np.concatenate(rings)
    count, sizes = len(points), np.array([len(ring) for ring in rings])
    here, there = np.arange(count), ragged.following(ragged.offsets(sizes))
    sides = np.stack([here, there, there + count, here + count], axis=1)
    corners = np.concatenate([sides.reshape(-1), *(part[::-1] for part in bottom), *(part + count for part in bottom)])
    faces = np.concatenate([np.full(count, 4), np.tile([len(part) for part in bottom], 2)])
    present = np.repeat([True, *shown], [count, len(bottom), len(bottom)])
    body = Mesh(np.concatenate([points, points + step]), corners, ragged.offsets(faces), present)
    return body if height > 0.0 else body.reversed()


def area_vector(points: ArrayLike) -> Floats:
    """(3,) twice the area of a polygon with corners (b,3), along its normal."""
    corners = np.asarray(points, dtype=np.float64)
    arm = corners - corners[0]
    return np.asarray(np.cross(arm, np.roll(arm, -1, axis=0)).sum(axis=0))


def check_hole_count(count: int) -> None:
    """Errors: InputError for more holes than a prism has."""
    if count > MOST_HOLES:
        raise InputError(f"{count} holes, expected at most {MOST_HOLES}")


def _checked_holes(base: Floats, normal: Floats, holes: Sequence[ArrayLike]) -> list[Floats]:
    """The holes (h,3), clockwise about the normal of the base."""
    check_hole_count(len(holes))
    found = []
    for number, points in enumerate(holes, 1):
        hole = checked_points(points, f"hole {number}: its corners")
        if len(hole) < 3:
            raise InputError(f"hole {number} needs at least three points, not {len(hole)}")
        both = np.concatenate([base, hole])
        if np.abs(matmul(both - base[0], normal)).max() > FLAT_OF_EXTENT * float(np.ptp(both, axis=0).max()):
            raise InputError(f"hole {number} and the base do not lie in one plane")
        found.append(hole[::-1] if matmul(area_vector(hole), normal) > 0.0 else hole)
    return found


def _bottom(rings: list[Floats], normal: Floats) -> list[Ints]:
    """The polygons of a base, by the numbers of the corners of all rings: itself, or convex ones around holes."""
    if len(rings) == 1:
        return [np.arange(len(rings[0]))]
    import shapely

    axes = np.stack(plane_axes(normal), axis=1)
    outline, *holes = (matmul(ring - rings[0][0], axes) for ring in rings)
    whole, cut = shapely.Polygon(outline), [shapely.Polygon(hole) for hole in holes]
    for number, hole in enumerate(cut, 1):
        if not hole.is_valid or not hole.area > 0.0:
            raise InputError(f"hole {number} crosses itself, or has no area")
        if not whole.is_valid or not whole.contains_properly(hole):
            raise InputError(f"hole {number} reaches to the outline of the base, or beyond it")
    tree = shapely.STRtree(cut)
    one, other = tree.query(cut, predicate="intersects")
    met = np.flatnonzero(one < other)
    if len(met):
        raise InputError(f"holes {one[met[0]] + 1} and {other[met[0]] + 1} meet")
    return convex_polygon_parts(outline, holes)


def regular_polygon(
    count: int, radius: float, *, centre: ArrayLike = (0.0, 0.0, 0.0), normal: ArrayLike = (0.0, 0.0, 1.0)
) -> Floats:
    """The corners of a regular polygon, as many as a circle needs to look round.

    Parameters
    ----------
    count : int
        Of the corners, 3 or more.
    radius : float
        From the centre to the corners.
    centre : (3,) array_like of float
        In world units.
    normal : (3,) array_like of float
        Of the plane that it lies in; the corners run counter-clockwise about it.

    Returns
    -------
    (count, 3) array of float
        In space. The first corner of one in a horizontal plane is in the direction of x.

    Raises
    ------
    InputError
        For fewer than three corners, a radius that is not positive, a centre or a normal that is not three finite
        numbers, a normal of no length.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.regular_polygon(4, 2, centre=(5, 0, 1)).round(9).tolist()
    [[7.0, 0.0, 1.0], [5.0, 2.0, 1.0], [3.0, 0.0, 1.0], [5.0, -2.0, 1.0]]
    """
    if count < 3:
        raise InputError(f"a regular polygon needs at least three corners, not {count}")
    if not (isfinite(radius) and radius > 0.0):
        raise InputError(f"a regular polygon of radius {radius:g}: expected more than 0")
    middle = _vector(centre, "the centre of a regular polygon")
    up = _vector(normal, "the normal of a regular polygon")
    length = float(norm(up))
    if not length > 0.0:
        raise InputError("the normal of a regular polygon has no length")
    angle = 2.0 * np.pi / count * np.arange(count)
    around = np.column_stack([np.cos(angle), np.sin(angle)])
    first, second = plane_axes(up / length)
    return np.asarray(middle + matmul(radius * around, np.stack([-second, first])))


def _vector(numbers: ArrayLike, what: str) -> Floats:
    vector = np.asarray(numbers, dtype=np.float64)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise InputError(f"{what} must be three finite numbers")
    return vector
