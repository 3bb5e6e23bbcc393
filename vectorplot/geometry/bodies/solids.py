"""Solids as meshes: boxes, and polyhedra given by their faces."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import cache
from math import isfinite

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul, singular_decomposition
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import ROUNDING

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
    >>> tetrahedron.polygons(), geometry.is_closed_oriented(tetrahedron)
    ([[2, 1, 0], [0, 1, 3], [1, 2, 3], [3, 2, 0]], True)
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
    Degenerate: faces without area say nothing; a vertex nearer to a plane than about 1e-9 of the extent lies in it.

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

    Degenerate: points in one plane have a hull of two faces; planes without a direction touch it.
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
