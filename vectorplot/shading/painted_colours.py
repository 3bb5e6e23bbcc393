"""The colours of painted polygons, corner by corner, and the normals that these are shaded with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import mapped, slices
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.shading.illumination import AMBIENT, DIRECT_SHARE, shades
from vectorplot.shading.palettes import COLOUR_MAP, PALETTE_SIZE, Colours
from vectorplot.shading.shaded_faces import (
    Shades,
    TrueNormals,
    at_corners,
    decal_shades,
    face_middles,
    face_normals,
    item_colours,
    own_corners,
    plane_middles,
    point_shades,
    shows_inside,
    view_normals,
)
from vectorplot.tolerances import FLAT_COSINE
from vectorplot.visibility.projected_faces import newell

# The colours of painted polygons, corner by corner.

FEW_CORNERS = 8
"""Of a face with more corners it pays to look whether they have the same normal, as those of the faces of cuts."""

POINTS_AT_ONCE = 1 << 16
"""Points shaded at once: few enough for the processor's cache."""


@dataclass(frozen=True, eq=False)
class Lighting:
    """What colours are made of: items and lights of the view, the latter as in view_lights; normals (3,c) at the
    corners of the faces of the view, see painted_normals; plane (f,) as in plane_numbers; size: shades of each
    palette; doubles: of lights in mirrors, where such light falls; ambient: what ambient light adds everywhere, where
    None more to what is nearer to the eye; smooth_size: shades on smooth surfaces, where None without steps."""

    items: Sequence[Item]
    lights: Sequence[Light]
    normals: Floats
    plane: Ints
    size: int = PALETTE_SIZE
    doubles: tuple[Light, ...] = ()
    ambient: float | None = None
    smooth_size: int | None = None


def smooth_faces(view: View, normals: Floats) -> Bools:
    """(f,) faces all corners of which have a normal of their own; normals (3,c)."""
    if not view.face_count:
        return np.zeros(0, dtype=np.bool_)
    known: Bools = np.asarray(np.isfinite(normals).all(axis=0), dtype=np.bool_)
    return np.asarray(np.logical_and.reduceat(known, view.offsets[:-1]), dtype=np.bool_)


def corner_shades_of(view: View, lighting: Lighting, points: Floats, offsets: Ints, source: Ints) -> Shades:
    """The shades at the corners (3,c), in the view, of polygons offsets (n+1,) that lie on faces source (n,).

    A polygon on a plane has one shade, that of the middle of all faces in this plane; where faces have normals at their
    corners each corner has its own.
    Source: Glaeser, sections 4.5 and 8.5.
    """
    face = np.repeat(source, np.diff(offsets))
    smooth = smooth_faces(view, lighting.normals)
    flat, of = np.unique(source[~smooth[source]], return_inverse=True)
    one = decal_shades(view, lighting.items, lighting.lights, plane_middles(view, lighting.plane)[:, flat], flat)
    count = len(face)
    found = Shades(
        np.zeros((len(one.shares), count)),
        np.zeros((len(one.shares), count)),
        np.zeros((len(one.shares), count), dtype=np.bool_),
        one.intensity,
        np.zeros(count),
    )
    on_flat = np.flatnonzero(~smooth[face])
    number = np.repeat(of.ravel(), np.diff(offsets)[~smooth[source]])
    found.shares[:, on_flat], found.matt[:, on_flat] = one.shares[:, number], one.matt[:, number]
    found.backlit[:, on_flat] = one.backlit[:, number]
    found.cue[on_flat] = one.cue[number]
    every = np.flatnonzero(smooth[face])
    if not len(every):
        return _with_ambient(found, lighting)
    turned_normals = shading_normals(view, lighting, points[:, every], face[every])

    def shade(some: slice) -> None:
        at, turned = every[some], turned_normals[:, some]
        own = point_shades(view, lighting.items, lighting.lights, points[:, at].T, turned.T, view.shown_item[face[at]])
        found.shares[:, at], found.matt[:, at] = own.shares, own.matt
        found.backlit[:, at], found.cue[at] = own.backlit, own.cue

    for _ in mapped(shade, slices(len(every), POINTS_AT_ONCE)):
        pass
    return _with_ambient(found, lighting)


def shading_normals(view: View, lighting: Lighting, points: Floats, face: Ints) -> Floats:
    """(3,n) the unit normals, on the side that the eye sees, that points (3,n) of smooth faces (n,) are shaded with."""
    flat, inside, found = face_normals(view), shows_inside(view), np.empty((3, len(face)))

    def turned(some: slice) -> None:
        own = face[some]
        normals = _normals_on(view, lighting.normals, flat[:, own], points[:, some], own)
        found[:, some] = np.where(inside[own], -normals, normals)

    for _ in mapped(turned, slices(len(face), POINTS_AT_ONCE)):
        pass
    return found


def _with_ambient(found: Shades, lighting: Lighting) -> Shades:
    """The shades, with the same ambient light everywhere if the lighting says so."""
    return found if lighting.ambient is None else replace(found, cue=np.full(len(found), lighting.ambient))


def colours_of(view: View, lighting: Lighting, source: Ints, shade: Floats) -> Colours:
    """(n,3) the colours of points on faces (n,) at shades (n,) or (3,n): on smooth surfaces without steps
    unless the lighting has such."""
    item = view.shown_item[source]
    found = item_colours(lighting.items, item, shade, lighting.size)
    at = np.flatnonzero(smooth_faces(view, lighting.normals)[source])
    if len(at):
        found[at] = item_colours(lighting.items, item[at], shade[..., at], lighting.smooth_size or COLOUR_MAP)
    return found


def opacities(items: Sequence[Item]) -> Floats:
    """(i,) how opaque items are, from 0 to 1."""
    return np.array([item.material.opacity for item in items], dtype=np.float64)


def _normals_on(view: View, normals: Floats, flat: Floats, points: Floats, face: Ints) -> Floats:
    """(3,n) unit normals at points (3,n) of faces (n,) with normals flat (3,n) as planes, between those at the corners
    of the triangle of the fan that each lies in."""
    first, size = view.offsets[face], view.face_sizes[face]
    found, best = np.zeros((3, len(face))), np.full(len(face), -np.inf)
    even = (size > FEW_CORNERS) & _with_one_normal(view, normals)[face]
    found[:, even] = normals[:, first[even]]
    size = np.where(even, 0, size)
    for step in range(1, int(size.max(initial=2)) - 1):
        here = np.flatnonzero(size > step + 1)
        corner = first[here] + np.array([[0], [step], [step + 1]])
        weights = _weights(view.points[:, view.corners[corner]], points[:, here], flat[:, here])
        inside = weights.min(axis=0)
        better = inside > best[here]
        best[here[better]] = inside[better]
        share = np.clip(weights[:, better], 0.0, 1.0)
        found[:, here[better]] = (share * normals[:, corner[:, better]]).sum(axis=1)
    length = np.sqrt((found * found).sum(axis=0))
    return np.asarray(np.where(length > 0.0, found / np.where(length > 0.0, length, 1.0), flat))


def _with_one_normal(view: View, normals: Floats) -> Bools:
    """(f,) the faces that have the same normal at all their corners."""
    if not view.face_count:
        return np.zeros(0, dtype=np.bool_)
    own = normals[:, np.repeat(view.offsets[:-1], view.face_sizes)]
    return np.asarray(np.logical_and.reduceat((normals == own).all(axis=0), view.offsets[:-1]), dtype=np.bool_)


def _weights(corners: Floats, points: Floats, normal: Floats) -> Floats:
    """(3,n) the barycentric coordinates of points (3,n) in triangles (3,3,n): coordinates by corners by triangles."""
    a, b, c = corners.transpose(1, 0, 2)
    area = dot(cross(b - a, c - a), normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        one = dot(cross(c - b, points - b), normal) / area
        two = dot(cross(a - c, points - c), normal) / area
    one, two = (np.nan_to_num(weight, nan=1.0 / 3.0, posinf=1.0 / 3.0, neginf=1.0 / 3.0) for weight in (one, two))
    return np.stack([one, two, 1.0 - one - two])


# The normals that painted faces are shaded with: those of smooth surfaces, of meshes that stand for such, and of
# planes on which light varies; everything else has one shade.

VARIED = 2.0 / PALETTE_SIZE
"""By so much of a palette shades vary on planes that are not shown in one: by two shades of a usual one."""

LARGE = 0.5
"""Planes that reach through more than this part of the depth of the picture have shades that vary with it."""


def painted_normals(
    view: View,
    items: Sequence[Item],
    lights: Sequence[Light],
    given: Sequence[TrueNormals | None],
    plane: Ints,
    crease_angle_deg: float,
) -> Floats:
    """(3,c) unit normals at the corners of faces, outwards; NaN where a face has one shade. lights: in the view's
    coordinates, none where every plane has one shade; given, crease angle: see view_normals; plane (f,): see
    plane_numbers, faces of a region are shaded alike. A region of one normal has one shade unless its light varies
    by more than VARIED, or it is LARGE.
    Source: Glaeser, section 4.6.
    """
    found = at_corners(view, view_normals(view, given, crease_angle_deg))
    own = face_normals(view)
    of_corner = ragged.owner(view.face_sizes)
    turned = (found * own[:, of_corner]).sum(axis=0) < FLAT_COSINE
    turned &= _wide(view)[of_corner]
    count = int(plane.max(initial=-1)) + 1
    round_ = np.zeros(count, dtype=np.bool_)
    round_[plane[of_corner[turned]]] = True
    true = np.array([normals is not None for normals in given], dtype=np.bool_)[view.face_item]
    varied = _varied(view, items, lights, plane)[plane] if lights else np.zeros(view.face_count, dtype=np.bool_)
    level = _level(view, found, given, plane, count)[plane]
    flat: Bools = np.asarray(~(round_[plane] | true) | level, dtype=np.bool_)
    found[:, (flat & ~varied)[of_corner]] = np.nan
    plain = (flat & varied)[of_corner]
    found[:, plain] = own[:, of_corner[plain]]
    return found


def _level(view: View, found: Floats, given: Sequence[TrueNormals | None], plane: Ints, count: int) -> Bools:
    """(p,) the regions of items with true normals at all corners that have one normal at all of these: flat faces."""
    level = np.zeros(count, dtype=np.bool_)
    items = [item for item, _ in own_corners(view, given)]
    if not items:
        return level
    own = np.isin(view.face_item, items)
    level[plane[own]] = True
    region, corner = plane[ragged.owner(view.face_sizes)], np.flatnonzero(np.repeat(own, view.face_sizes))
    first = np.zeros((3, count))
    first[:, region[corner]] = found[:, corner]
    level[region[corner][(found[:, corner] * first[:, region[corner]]).sum(axis=0) < FLAT_COSINE]] = False
    return level


def _wide(view: View) -> Bools:
    """(f,) the faces that are wide enough to tell where they look, and not only long."""
    area, longest, _ = newell(view, np.arange(view.face_count))
    return np.asarray(np.sqrt((area * area).sum(axis=0)) > view.tolerance * longest)


def _varied(view: View, items: Sequence[Item], lights: Sequence[Light], plane: Ints) -> Bools:
    """(p,) the regions on which light varies, or depth much: from corner to corner, middle to middle, along sides."""
    corner = np.arange(len(view.corners))
    of_corner = ragged.owner(view.face_sizes)
    start, end = view.points[:, view.corners], view.points[:, view.corners[view.after(corner)]]
    points = np.concatenate([start, (start + end) / 2.0, face_middles(view)], axis=1)
    face = np.concatenate([of_corner, of_corner, np.arange(view.face_count)])
    at = decal_shades(view, items, lights, points, face)
    light = np.atleast_2d(shades(at.shares, at.intensity)) / DIRECT_SHARE
    count = int(plane.max(initial=-1)) + 1
    varied = np.zeros(count, dtype=np.bool_)
    for row, most in [*((row, VARIED) for row in light), (at.cue, LARGE * AMBIENT)]:
        low, high = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(low, plane[face], row)
        np.maximum.at(high, plane[face], row)
        varied |= high - low > most
    return varied
