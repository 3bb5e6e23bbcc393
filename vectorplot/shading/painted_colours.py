"""The colours of painted polygons, corner by corner."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.scene.scene import Item, Light
from vectorplot.scene.view import View
from vectorplot.shading.face_shades import (
    Shades,
    decal_shades,
    face_middles,
    face_normals,
    item_colours,
    point_shades,
    shows_inside,
)
from vectorplot.shading.palettes import COLOUR_MAP, SIZE, Colours


@dataclass(frozen=True, eq=False)
class Lighting:
    """What colours are made of: items and lights of the view, the latter as of view_lights; normals (3,v) of smooth
    surfaces at the vertices of the view, NaN at those of polyhedra; size: shades of each palette; doubles: of lights in
    mirrors, where such light falls."""

    items: Sequence[Item]
    lights: Sequence[Light]
    normals: Floats
    size: int = SIZE
    doubles: tuple[Light, ...] = ()


def smooth_faces(view: View, normals: Floats) -> Bools:
    """(f,) faces all corners of which have a normal of their own; normals (3,v)."""
    if not view.face_count:
        return np.zeros(0, dtype=np.bool_)
    known: Bools = np.asarray(np.isfinite(normals).all(axis=0), dtype=np.bool_)
    return np.asarray(np.logical_and.reduceat(known[view.corners], view.offsets[:-1]), dtype=np.bool_)


def corner_shades_of(view: View, lighting: Lighting, points: Floats, offsets: Ints, source: Ints) -> Shades:
    """The shades at the corners (3,c), in the view, of polygons offsets (n+1,) that lie on faces source (n,).

    A polygon on a flat face has one shade, that of the face's barycentre; on a smooth surface each corner has its own.
    Source: Glaeser, sections 4.5 and 8.5.
    """
    face = np.repeat(source, np.diff(offsets))
    smooth = smooth_faces(view, lighting.normals)
    flat = decal_shades(view, lighting.items, lighting.lights, face_middles(view), np.arange(view.face_count))
    found = _some(flat, face)
    at = np.flatnonzero(smooth[face])
    if not len(at):
        return found
    normals = _normals_on(view, lighting.normals, points[:, at], face[at])
    inside = shows_inside(view)[face[at]]
    turned = np.where(inside, -normals, normals)
    own = point_shades(view, lighting.items, lighting.lights, points[:, at].T, turned.T, view.face_item[face[at]])
    found.shares[:, at], found.backlit[:, at], found.cue[at] = own.shares, own.backlit, own.cue
    return found


def colours_of(view: View, lighting: Lighting, source: Ints, shade: Floats) -> Colours:
    """(n,3) the colours of points on faces (n,) at shades (n,) or (3,n): on smooth surfaces without steps."""
    item = view.face_item[source]
    found = item_colours(lighting.items, item, shade, lighting.size)
    at = np.flatnonzero(smooth_faces(view, lighting.normals)[source])
    if len(at):
        found[at] = item_colours(lighting.items, item[at], shade[..., at], COLOUR_MAP)
    return found


def opacities(items: Sequence[Item]) -> Floats:
    """(i,) how opaque items are, from 0 to 1."""
    return np.array([item.material.opacity for item in items], dtype=np.float64)


def _some(found: Shades, which: Ints) -> Shades:
    return Shades(found.shares[:, which], found.backlit[:, which], found.intensity, found.cue[which])


def _normals_on(view: View, normals: Floats, points: Floats, face: Ints) -> Floats:
    """(3,n) unit normals at points (3,n) of triangles (n,), between those at their corners."""
    corner = view.offsets[face]
    a, b, c = (view.points[:, view.corners[corner + k]] for k in range(3))
    flat = face_normals(view)[:, face]
    area = (np.cross(b - a, c - a, axis=0) * flat).sum(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        one = (np.cross(c - b, points - b, axis=0) * flat).sum(axis=0) / area
        two = (np.cross(a - c, points - c, axis=0) * flat).sum(axis=0) / area
    one, two = (np.clip(np.nan_to_num(weight, nan=1.0 / 3.0), 0.0, 1.0) for weight in (one, two))
    weights = (one, two, np.maximum(1.0 - one - two, 0.0))
    found = sum(weight * normals[:, view.corners[corner + k]] for k, weight in enumerate(weights))
    length = np.sqrt((found * found).sum(axis=0))
    return np.asarray(np.where(length > 0.0, found / np.where(length > 0.0, length, 1.0), flat))
