"""Integral curves of fields of directions on the faces of a mesh, and straightest geodesics."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.parameters import positive
from vectorplot.errors import InputError
from vectorplot.features.integral.bent_faces import USUAL_CREASE_DEG, BentFaces
from vectorplot.features.integral.integral_curves import USUAL_LENGTH
from vectorplot.features.integral.on_meshes.mesh_courses import MeshCourses, mesh_courses
from vectorplot.features.integral.on_meshes.mesh_flows import MeshFlow, StraightFlow, face_field_flow
from vectorplot.features.integral.on_meshes.mesh_sides import MeshSides, mesh_sides
from vectorplot.features.integral.sites import unit
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.features.meshes.mesh_curves import NO_FACE, MeshCurves, all_mesh_curves, without_inner
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import with_points_kept
from vectorplot.geometry.repair.adjacency import face_barycentres
from vectorplot.geometry.vectors import dot
from vectorplot.tolerances.of_angles import NO_NORMAL
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT


def mesh_integral_curves(
    mesh: Mesh,
    field: TangentField,
    faces: ArrayLike,
    points: ArrayLike | None = None,
    *,
    length: float | None = None,
    both_ways: bool = True,
    crease_angle_deg: float = USUAL_CREASE_DEG,
) -> MeshCurves:
    """The lines across the faces of a mesh that follow a field of directions, one through each of given points.

    Parameters
    ----------
    mesh : Mesh
        On which they run; open or closed.
    field : TangentField
        What they follow, such as `SteepestSlope`, `ConstantElevation`, `PrincipalDirections`, `AsymptoticDirections`,
        `VectorField`, `TurnedField` of one of these: asked once for every face, at its barycentre. Fields of parameters
        need a surface.
    faces : (k,) array_like of int
        In which faces they begin; or one of them.
    points : (k, 3) array_like of float, optional
        Where in these faces; at the barycentres where None.
    length : float, optional
        How far they run from the start to each side at most, in world units; ten times the extent of the mesh where
        None.
    both_ways : bool
        Whether they run against the field as well.
    crease_angle_deg : float
        At edges where faces turn by more, 0 to 180 degrees, the mesh is not smooth: for fields that go by curvatures.

    Returns
    -------
    MeshCurves
        Polylines with the number of the start as level. Every vertex but the ends lies on an edge (or the fold of a
        polygon that is not plane), and every segment in a face, along its direction.

    Raises
    ------
    InputError
        For faces that the mesh does not have, points that are not in their faces, a length that is not positive, fields
        that need parameters, or give what are no directions in faces; an angle that is not within 0 and 180.

    Notes
    -----
    All lines are led on at once, by a face each time. Where the direction beyond an edge leads back to it, the line
    follows the edge in the sense of both directions, those that push less counting more (water in a valley); where
    these cancel out it ends. At a vertex it goes into the face, or along the edge, that leads away and is nearest to
    the way it came, and ends where there is none: on a summit, in a pit. It ends at borders, at edges of more than two
    faces or of two that do not agree on their outer side, and at faces in which the field has no direction or that
    have no area. What has no sense (lines of curvature) goes on in the one nearest to the way it came. It is closed
    where it comes back to the point where it left its first face. No line runs across more than 100000 faces.

    Source: Glaeser, section 9.4, figure 8; errata G9-14. Filippov, Differential equations with discontinuous righthand
    sides, section 4, for edges.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, geometry
    >>> turn = features.VectorField(lambda points: np.cross((0.0, 0.0, 1.0), points - (1.0, 1.0, 0.0)))
    >>> ring = features.mesh_integral_curves(geometry.box((2, 2, 2)), turn, 0)
    >>> ring.closed.tolist(), ring[0][:, 2].tolist()
    ([True], [1.0, 1.0, 1.0, 1.0, 1.0])
    """
    sides = mesh_sides(mesh)
    face, own = starts_in_faces("integral curves", mesh, sides, faces, points)
    flow = face_field_flow(sides, BentFaces(mesh, crease_angle_deg), field)
    return led_curves(sides, flow, face, own, flow.candidates[0, face], length, both_ways)


def mesh_geodesics(
    mesh: Mesh,
    faces: ArrayLike,
    points: ArrayLike | None,
    directions: ArrayLike,
    *,
    length: float | None = None,
    both_ways: bool = False,
) -> MeshCurves:
    """The straightest lines of a mesh from given points in given directions.

    Parameters
    ----------
    mesh : Mesh
        On which they run; open or closed.
    faces : (k,) array_like of int
        In which faces they begin; or one of them.
    points : (k, 3) array_like of float, optional
        Where in these faces; at the barycentres where None.
    directions : (k, 3) array_like of float
        Of any length; what is at right angles to the face does not count. Or one for all.
    length : float, optional
        How long they are at most, in world units; ten times the extent of the mesh where None.
    both_ways : bool
        Whether they run backwards from the start as well.

    Returns
    -------
    MeshCurves
        Polylines with the number of the start as level: straight lines where the faces they run across are unfolded
        into a plane.

    Raises
    ------
    InputError
        As of `mesh_integral_curves`; for directions that are not finite, or without length in their face.

    Notes
    -----
    At a vertex there is as much angle between the faces to their left as to their right. They are shortest near by,
    unless they run through a vertex. Ends and closed lines as of `mesh_integral_curves`.

    Source: Polthier and Schmies, Straightest geodesics on polyhedral surfaces, 1998.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> hexagon = features.mesh_geodesics(geometry.box((2, 2, 2)), 0, (1.5, 0.0, 0.5), (1.0, 0.0, 1.0))
    >>> hexagon.closed.tolist(), sorted(hexagon.faces.tolist())
    ([True], [0, 1, 2, 3, 4, 5])
    """
    sides = mesh_sides(mesh)
    face, own = starts_in_faces("geodesics", mesh, sides, faces, points)
    given = np.asarray(directions, dtype=np.float64)
    if given.shape not in ((3,), (len(face), 3)) or not np.isfinite(given).all():
        raise InputError("geodesics: directions must be three finite numbers for each start")
    given = np.broadcast_to(given, (len(face), 3))
    given = given / np.maximum(np.abs(given).max(axis=1, initial=NO_NORMAL), NO_NORMAL)[:, None]
    normals = sides.mesh.face_normals[face]
    flat = given - dot(given, normals)[:, None] * normals
    none = np.sqrt(dot(flat, flat)) <= ZERO_OF_EXTENT
    if none.any():
        raise InputError(f"geodesics: direction {int(none.argmax()) + 1} has no length in its face")
    return led_curves(sides, StraightFlow(sides), face, own, unit(flat), length, both_ways)


def starts_in_faces(
    name: str, mesh: Mesh, sides: MeshSides, faces: ArrayLike, points: ArrayLike | None
) -> tuple[Ints, Floats]:
    """(k,) the parts of faces in which lines begin, and (k,3) where."""
    given = np.atleast_1d(np.asarray(faces))
    if given.size == 0:
        return np.zeros(0, dtype=np.intp), np.zeros((0, 3))
    if given.ndim != 1 or given.dtype.kind not in "iu":
        raise InputError(f"{name}: faces must be whole numbers")
    known = np.isin(given, sides.source)
    if not known.all():
        raise InputError(f"{name}: there is no face {int(given[~known][0])} among {mesh.face_count}")
    given = given.astype(np.intp)
    at = face_barycentres(mesh)[given] if points is None else np.atleast_2d(np.asarray(points, dtype=np.float64))
    if at.shape != (len(given), 3) or not np.isfinite(at).all():
        raise InputError(f"{name}: points must be three finite numbers for each face")
    # Of the parts of a face the one that a point is most inside of.
    order = np.argsort(sides.source, kind="stable")
    low, high = (np.searchsorted(sides.source[order], given, side) for side in ("left", "right"))
    part, start = order[ragged.ranges(low, high - low)], ragged.owner(high - low)
    corner, offsets = ragged.take(sides.mesh.offsets, part)
    arm = at[start][ragged.owner(np.diff(offsets))] - sides.starts(corner)
    inside = np.minimum.reduceat(dot(sides.inwards[corner], arm), offsets[:-1])
    height = dot(sides.mesh.face_normals[part], at[start] - sides.starts(corner[offsets[:-1]]))
    best = np.lexsort((-inside, start))[ragged.starts(high - low)]
    # The mean of the corners of a face that is not plane is not in it.
    slack = np.inf if points is None else max(ZERO_OF_EXTENT * sides.extent, sides.rounding)
    far = (inside[best] < -slack) | (np.abs(height[best]) > slack)
    if far.any():
        raise InputError(f"{name}: point {int(far.argmax()) + 1} is not in face {int(given[far.argmax()])}")
    own = at - height[best][:, None] * sides.mesh.face_normals[part[best]]
    return part[best].astype(np.intp), np.asarray(own)


def led_curves(
    sides: MeshSides,
    flow: MeshFlow,
    face: Ints,
    points: Floats,
    directions: Floats,
    length: float | None,
    both_ways: bool,
    beside: float = 0.0,
) -> MeshCurves:
    """The lines of a flow as curves, both ways joined; beside: as of mesh_courses."""
    longest = USUAL_LENGTH * sides.extent if length is None else positive("integral curves: length", length)
    count = len(face)
    if not count:
        return all_mesh_curves([])
    ways = np.repeat([1.0, -1.0][: 1 + both_ways], count)
    found = mesh_courses(
        sides,
        flow,
        np.tile(face, 1 + both_ways),
        np.tile(points, (1 + both_ways, 1)),
        np.tile(directions, (1 + both_ways, 1)) * ways[:, None],
        ways,
        longest,
        beside,
    )
    return _joined_ways(sides, found, count)


def _joined_ways(sides: MeshSides, found: MeshCourses, count: int) -> MeshCurves:
    """Curves from courses, those back (count and more) before those there; closed ones have no way back, and do without
    the way from the start to where they come back to."""
    place = ragged.place(np.bincount(found.line, minlength=len(found.closed)))
    closed = found.closed[:count]
    curve, back = found.line % count, found.line >= count
    rows = np.flatnonzero(np.where(closed[curve], ~back & (place > 0), True))
    # Segments count where they begin on the whole curve, and an open one has a last point.
    open_ = np.flatnonzero(~closed)
    points = np.concatenate([np.where(back[rows, None], found.end[rows], found.begin[rows]), found.last[open_]])
    faces = np.concatenate([sides.source[found.face[rows]], np.full(len(open_), NO_FACE)])
    rank = np.concatenate([np.where(back[rows], -1 - place[rows], place[rows]), np.full(len(open_), len(place))])
    owner = np.concatenate([curve[rows], open_])
    order = np.lexsort((rank, owner))
    number, begin = np.unique(owner[order], return_index=True)
    offsets = np.append(begin, len(order)).astype(np.intp)
    curves = MeshCurves(points[order], offsets, closed[number], faces[order], number.astype(np.float64))
    return without_inner(_without_stops(curves), sides.extent)


def _without_stops(curves: MeshCurves) -> MeshCurves:
    """The curves without segments that have no length."""
    after = ragged.following(curves.offsets)
    still = (curves.points == curves.points[after]).all(axis=1) & (curves.faces != NO_FACE)
    return with_points_kept(curves, ~still)
