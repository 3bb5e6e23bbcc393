"""Polyhedra that stand for surfaces of revolution about the z-axis."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.bodies.solids import BOTH_CAPS, BOTTOM, TOP, checked_points, presence
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances.of_angles import HALF_TURN_ROUNDING
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

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

    Degenerate: points on the axis stay single vertices; a meridian that runs downwards has its faces turned outwards.

    Source: Glaeser, section 3.4; errata G3-11, D-4.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> cone = geometry.revolution([(1, 0, 0), (0, 0, 2)], order=12)
    >>> len(cone.vertices), cone.face_sizes.tolist()
    (13, [3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 12])
    >>> geometry.mesh_report(geometry.revolution([(1, 0, 0), (0, 0, 2)], order=5, angle_deg=90)).closed
    True
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
    closed = len(points) > 3 and bool((points[0] == points[-1]).all())
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
