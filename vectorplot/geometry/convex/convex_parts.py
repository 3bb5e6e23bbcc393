"""Prisms and bodies of revolution that are not convex, and faces, as unions of convex parts."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.geometry.bodies.bodies_of_revolution import FULL_TURN, HALF_TURN, revolution
from vectorplot.geometry.bodies.prisms import prism
from vectorplot.geometry.bodies.solids import checked_points, polyhedron
from vectorplot.geometry.convex.convex_polygons import convex_polygon_parts, flattened, signed_area
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT


def convex_prism_parts(base_points: ArrayLike, vector: ArrayLike) -> list[Mesh]:
    """Convex prisms that together fill the prism over a planar base.

    Parameters
    ----------
    base_points : (b, 3) array_like of float
        A planar polygon.
    vector : (3,) array_like of float
        Along which it is moved.

    Returns
    -------
    list of Mesh
        One where the base is convex.

    Raises
    ------
    InputError
        For what prism refuses, and a base that crosses itself.

    Notes
    -----
    Source: Glaeser, section 3.5.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> angle = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]
    >>> parts = geometry.convex_prism_parts(angle, (0, 0, 1))
    >>> round(sum(geometry.body_record(part).volume for part in parts), 9)
    3.0
    """
    whole = prism(base_points, vector)
    count = len(whole.vertices) // 2
    base, step = whole.vertices[:count], whole.vertices[count] - whole.vertices[0]
    normal = whole.area_vectors[-1]
    flat, turned = flattened(base, normal)
    parts = convex_polygon_parts(flat)
    return [prism(base[turned[part]], step) for part in parts]


def convex_revolution_parts(meridian: ArrayLike, order: int, *, angle_deg: float = FULL_TURN) -> list[Mesh]:
    """Convex polyhedra that together fill a body of revolution.

    Parameters
    ----------
    meridian : (s, 3) array_like of float
        In a half-plane through the z-axis.
    order : int
        As of revolution.
    angle_deg : float
        As of revolution.

    Returns
    -------
    list of Mesh
        Where every horizontal plane meets the meridian once, slices between horizontal planes, in parts of at most half
        a turn; else the convex parts of the profile, swept step by step.

    Raises
    ------
    InputError
        For what revolution refuses.

    Notes
    -----
    Source: Glaeser, section 3.4, figure 4.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> spool = [(2, 0, 0), (1, 0, 1), (2, 0, 2)]
    >>> [part.face_count for part in geometry.convex_revolution_parts(spool, order=6)]
    [8, 8]
    """
    revolution(meridian, order, angle_deg=angle_deg)  # refuses what makes no body
    points = checked_points(meridian, "meridian")
    profile = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)
    if profile[-1, 1] < profile[0, 1]:
        profile = profile[::-1]
    extent = float(np.abs(profile - [0.0, profile[0, 1]]).max())
    azimuth = points[int(np.argmax(np.hypot(points[:, 0], points[:, 1]))), :2]
    azimuth = azimuth / norm(azimuth)
    if (np.diff(profile[:, 1]) > ZERO_OF_EXTENT * extent).all() and (angle_deg == FULL_TURN or angle_deg <= HALF_TURN):
        slices = [_in_space(profile[a : b + 1], azimuth) for a, b in _arches(profile)]
        return [revolution(piece, order, angle_deg=angle_deg) for piece in slices]
    return _sectors(profile, azimuth, order, angle_deg)


def _in_space(profile: Floats, azimuth: Floats) -> Floats:
    return np.column_stack([profile[:, :1] * azimuth, profile[:, 1]])


def _arches(profile: Floats) -> Iterable[tuple[int, int]]:
    """First and last point of the pieces of a rising profile that bulge outwards."""
    sides = np.diff(profile, axis=0)
    turn = sides[:-1, 0] * sides[1:, 1] - sides[:-1, 1] * sides[1:, 0]
    zero = ZERO_OF_EXTENT * float(np.abs(sides).max()) ** 2
    cuts = [0, *(np.flatnonzero(turn < -zero) + 1).tolist(), len(profile) - 1]
    return pairwise(cuts)


def _sectors(profile: Floats, azimuth: Floats, order: int, angle_deg: float) -> list[Mesh]:
    """The convex parts of the profile, closed along the axis, between every two neighbouring meridians."""
    closed = bool((profile[0] == profile[-1]).all())
    outline = profile[:-1] if closed else profile
    if not closed:
        feet = [[[0.0, z]] if r > 0.0 else np.zeros((0, 2)) for r, z in (profile[0], profile[-1])]
        outline = np.concatenate([feet[0], outline, feet[1]])
    if signed_area(outline) < 0.0:
        outline = outline[::-1]
    steps = order if angle_deg == FULL_TURN else order - 1
    angle = np.radians(angle_deg * np.arange(steps + 1) / steps) + arctan2(azimuth[1], azimuth[0])
    parts = [outline[part] for part in convex_polygon_parts(outline)]
    return [_wedge(part, a, b) for part in parts for a, b in pairwise(angle.tolist())]


def _wedge(profile: Floats, first: float, second: float) -> Mesh:
    """The convex polyhedron between a convex profile in two half-planes through the axis."""
    r, z = profile[:, 0], profile[:, 1]
    count = len(r)
    rings = [np.column_stack([r * np.cos(a), r * np.sin(a), z]) for a in (first, second)]
    here = np.arange(count)
    there = np.roll(here, -1)
    on_axis = r <= 0.0
    twin = np.where(on_axis, here, here + count)
    sides = np.stack([here, twin, twin[there], there], axis=1)
    faces = [_without_repeats(side) for side in sides.tolist()]
    faces = [face for face in faces if len(face) > 2]
    used = np.unique(np.concatenate([here, twin]))
    place = dict(zip(used.tolist(), range(len(used)), strict=True))
    lists = [[place[v] for v in face] for face in [*faces, here.tolist(), twin[::-1].tolist()]]
    return polyhedron(np.concatenate(rings)[used], lists)


def _without_repeats(face: list[int]) -> list[int]:
    return [v for k, v in enumerate(face) if v != face[k - 1]]


def split_faces(mesh: Mesh, chosen: Bools) -> Mesh:
    """The mesh with some faces cut into convex parts.

    Parameters
    ----------
    mesh : Mesh
        With f faces.
    chosen : (f,) array of bool
        The faces to be cut, which are planar.

    Returns
    -------
    Mesh
        With the same vertices; the other faces first, in their order.

    Raises
    ------
    InputError
        For a face that crosses itself.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> corners = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]
    >>> angle = vp.Mesh.from_polygons(corners, [range(6)])
    >>> geometry.split_faces(angle, np.array([True])).face_sizes.tolist()
    [4, 4]
    """
    polygons = mesh.polygons()
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present
    numbers = np.flatnonzero(~chosen).tolist()
    faces = [polygons[k] for k in numbers]
    for k in np.flatnonzero(chosen).tolist():
        polygon = np.array(polygons[k])
        flat, order = flattened(mesh.vertices[polygon], mesh.area_vectors[k])
        parts = convex_polygon_parts(flat)
        faces.extend(polygon[order[part]].tolist() for part in parts)
        numbers.extend([k] * len(parts))
    return Mesh.from_polygons(mesh.vertices, faces, present=present[numbers])
