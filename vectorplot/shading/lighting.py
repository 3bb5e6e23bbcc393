"""The visible points of a picture of pixels, and their colours by lights, materials and shadows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import any_component, component_sum
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.shading.depth_buffers import DepthBuffer
from vectorplot.shading.illumination import (
    DIRECT_SHARE,
    SHADOW_SHARE,
    Finish,
    brightness,
    depth_cue,
    fading_factors,
    finish_of,
    homogeneous_light,
    lambert,
    lamp_reach,
    towards,
)
from vectorplot.shading.palettes import COLOUR_MAP, Colours, palette
from vectorplot.shading.quadric_pixels import QuadricPoints
from vectorplot.shading.screen import SceneTriangles
from vectorplot.shading.shaded_faces import depth_limits, light_colours, unit, view_eye
from vectorplot.shading.shaded_faces import mesh_face_normals as face_normals

# Where in its triangle every visible point lies, so that each pixel is shaded once, after visibility is known.


@dataclass(frozen=True, eq=False)
class VisiblePoints:
    """One point of space for every pixel that is not empty.

    pixel (m,): row * columns + column; triangle (m,): before clipping; weights (m, 3): of its corners, each 0 to 1,
    together 1; corners (m, 3): the indices of its points.
    """

    pixel: Ints
    triangle: Ints
    weights: Floats
    corners: Ints

    def __len__(self) -> int:
        return len(self.pixel)

    def interpolated(self, values: ArrayLike) -> Floats:
        """(m, ...) values (n, ...) given at the points of the triangles, such as points of space or normals."""
        v = np.asarray(values, dtype=np.float64)
        tail = (1,) * (v.ndim - 1)
        total = np.take(v, self.corners[:, 0], axis=0) * self.weights[:, 0].reshape(-1, *tail)
        for k in (1, 2):
            total += np.take(v, self.corners[:, k], axis=0) * self.weights[:, k].reshape(-1, *tail)
        return np.asarray(total)


def visible_points(buffer: DepthBuffer, points: ArrayLike, corners: ArrayLike) -> VisiblePoints:
    """The visible points of the triangles (t, 3) of homogeneous points (n, 4) that a depth buffer was made of.

    Pixels count from the buffer's own first row.
    """
    pixel = np.flatnonzero(buffer.triangle >= 0)
    return points_in_pixels(buffer, pixel, buffer.triangle.take(pixel).astype(np.intp), points, corners)


def points_in_pixels(
    buffer: DepthBuffer, pixel: Ints, triangle: Ints, points: ArrayLike, corners: ArrayLike
) -> VisiblePoints:
    """The points in which the rays through pixels (m,) of a buffer meet triangles (m,), numbers in buffer.triangles.

    The weights are those of space, not of the image, and hold for triangles that reach behind the eye too. The centre
    of a pixel may lie outside its triangle by the snapping of its corners; such weights are moved to its border.
    """
    p, t = np.asarray(points, dtype=np.float64).reshape(-1, 4), np.asarray(corners, dtype=np.intp).reshape(-1, 3)
    source = buffer.triangles.source[triangle]
    if len(source) and source.max() >= len(t):
        raise InputError("the depth buffer was made of other triangles")
    row, column = np.divmod(pixel, buffer.code.shape[1])
    row = row + buffer.top
    chosen = np.take(t, source, axis=0)
    # Homogeneous coordinates of the corners about the pixel's centre: their sum with the weights wanted is (0, 0).
    u, v = [], []
    for k in range(3):
        corner = np.take(p, chosen[:, k], axis=0)
        u.append(corner[:, 0] - column * corner[:, 3])
        v.append(corner[:, 1] - row * corner[:, 3])
    parts = [u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3] for k in range(3)]
    return VisiblePoints(pixel, source, _normalized(np.stack(parts, axis=1)), chosen)


def _normalized(parts: Floats) -> Floats:
    """(m, 3) weights in proportion to parts; where these have no sum, as for a triangle seen edge-on, equal ones."""
    total = component_sum(parts)
    known = total != 0.0
    weights = parts / np.where(known, total, 1.0)[:, None]
    np.clip(weights, 0.0, 1.0, out=weights)
    weights[~known] = 1.0 / 3.0
    return np.asarray(weights / component_sum(weights)[:, None])


# The colours of visible points: every light's share by the material, shadows, and what is near a little brighter.
#
# Source: Glaeser, sections 4.5, 8.5 and 8.6.

_Value = TypeVar("_Value")

Blocked = Callable[[Floats, Floats, Ints], Bools]
"""Which of points (m, 3) on faces with normals (m, 3), parts of triangles (m,), a light does not reach."""


@dataclass(frozen=True, eq=False)
class ClearCasters:
    """Things of one palette and opacity that light comes through, dimmed and coloured.

    palette: a number in those of the lighting; blocked: for each light which points they stand before.
    """

    palette: int
    opacity: float
    blocked: tuple[Blocked, ...]


@dataclass(frozen=True, eq=False)
class Lighting:
    """What colours depend on besides the points.

    lights, and for each which points it does not reach (none: it reaches all); eye: (x, y, z, 1), or (x, y, z, 0) for
    parallel rays to there; reach: of each light, how far it goes before it fades; palette (i,), finish (i,) of every
    item, in palettes (k, 256, 3) and finishes; depths: the limits of what is brighter because it is near; receives
    (i,): items that shadows fall on; clear: what casts coloured ones.
    """

    lights: tuple[Light, ...]
    blocked: tuple[Blocked, ...]
    eye: tuple[float, float, float, float]
    reach: tuple[float, ...]
    palette: Ints
    palettes: Colours
    finish: Ints
    finishes: tuple[Finish, ...]
    depths: tuple[float, float]
    receives: Bools
    clear: tuple[ClearCasters, ...] = ()


@dataclass(frozen=True, eq=False)
class ShadedPoints:
    """Visible points with what shading them made known: places (m, 3); faces (m, 3): unit normals of their faces, on
    the eye's side; colours (m, 3): red, green and blue."""

    places: Floats
    faces: Floats
    colours: Colours


def lighting_of(
    view: View,
    items: Sequence[Item],
    lights: tuple[Light, ...],
    blocked: tuple[Blocked, ...],
    clear: Sequence[tuple[str, float, tuple[Blocked, ...]]] = (),
) -> Lighting:
    """The lighting of a view of some items; lights, in its coordinates, and what each of them does not reach; clear:
    colours, opacities and shadows of what light comes through.

    Errors: InputError for a colour that is none.
    """
    finishes, finish = _numbered([finish_of(item.material) for item in items])
    names, number = _numbered([(item.colour, item.material.is_unlit) for item in items])
    palettes = np.array([palette(name, COLOUR_MAP) for name, _ in names], dtype=np.uint8).reshape(-1, COLOUR_MAP, 3)
    unlit = np.array([unlit for _, unlit in names], dtype=np.bool_)
    palettes[unlit] = palettes[unlit, -1:]
    reach = tuple(lamp_reach(view, light) for light in lights)
    receives = np.array([item.material.opacity >= 1.0 for item in items], dtype=np.bool_)
    casters = tuple(
        ClearCasters([name for name, _ in names].index(colour), opacity, dark) for colour, opacity, dark in clear
    )
    eye, depths = view_eye(view), depth_limits(view)
    return Lighting(lights, blocked, eye, reach, number, palettes, finish, tuple(finishes), depths, receives, casters)


def _numbered(values: Sequence[_Value]) -> tuple[list[_Value], Ints]:
    """The different values, and (n,) which of them each is."""
    places = {value: number for number, value in enumerate(dict.fromkeys(values))}
    return list(places), np.array([places[value] for value in values], dtype=np.intp)


@dataclass(frozen=True, eq=False)
class _Lit:
    """What m points get of l lights: places (m, 3), faces (m, 3) their normals, triangle (m,), -1 for points of bodies,
    item (m,); given (l, m):
    shares of what they would send of each; gone (l, m): whether they are in its shadow, and facing (l, m) turned to it;
    cue (m,): of being near."""

    places: Floats
    faces: Floats
    triangle: Ints
    item: Ints
    given: Floats
    gone: Bools
    facing: Bools
    cue: Floats


def shaded_points(triangles: SceneTriangles, found: VisiblePoints, lighting: Lighting) -> ShadedPoints:
    """The colours of visible points of a scene.

    Of what a light would give without a highlight, half is left where it does not get. What it reaches through clear
    things takes on their colour in its shadow, as far as they are opaque. On clear things no shadows fall.
    Source: Glaeser, sections 4.5, equations 2 to 7, 6.3, 6.6, 8.5, equations 30 to 33, and 8.6.
    """
    places = found.interpolated(triangles.points)
    to_eye = towards(places, lighting.eye)
    faces, normals = _normals(triangles, found, to_eye)
    lit = _lit(places, to_eye, faces, normals, found.triangle, triangles.item[found.triangle], lighting)
    return ShadedPoints(places, faces, _shown(lit, lighting))


def shaded_bodies(found: QuadricPoints, lighting: Lighting) -> Colours:
    """(m, 3) the colours of points of quadric bodies."""
    to_eye = towards(found.places, lighting.eye)
    none = np.full(len(found.item), -1)
    return _shown(_lit(found.places, to_eye, found.normals, found.normals, none, found.item, lighting), lighting)


def _shown(lit: _Lit, lighting: Lighting) -> Colours:
    """(m, 3) the colours of points."""
    kept = np.where(lit.gone, SHADOW_SHARE, 1.0)
    colours = _colours(lighting, lighting.palette[lit.item], lit, kept, np.arange(len(lit.item)))
    for casters in lighting.clear:
        for number in range(len(lighting.lights)):
            reached = np.flatnonzero(lit.facing[number] & ~lit.gone[number] & lighting.receives[lit.item])
            dark = casters.blocked[number](lit.places[reached], lit.faces[reached], lit.triangle[reached])
            which = reached[dark]
            less = kept[:, which]
            less[number] = SHADOW_SHARE
            own = np.full(len(which), casters.palette, dtype=np.intp)
            tint = _colours(lighting, own, lit, less, which)
            colours[which] += casters.opacity * (tint - colours[which])
    return np.rint(colours).astype(np.uint8)


def _lit(
    places: Floats, to_eye: Floats, faces: Floats, normals: Floats, triangle: Ints, item: Ints, lighting: Lighting
) -> _Lit:
    """What points get of all lights: on faces, and on the surface they stand for, with such normals."""
    receives = lighting.receives[item]
    shape = (len(lighting.lights), len(places))
    given, gone, facing = np.zeros(shape), np.zeros(shape, dtype=np.bool_), np.zeros(shape, dtype=np.bool_)
    for number, light in enumerate(lighting.lights):
        to_light = towards(places, homogeneous_light(light))
        alpha = np.einsum("ij,ij->i", normals, to_light)
        share = _shares(lighting, item, alpha, normals, to_light, to_eye)
        facing[number] = alpha > 0.0
        if lighting.blocked:
            asked = np.flatnonzero(facing[number] & receives)
            dark = asked[lighting.blocked[number](places[asked], faces[asked], triangle[asked])]
            share[dark] = _matt_shares(lighting, item[dark], alpha[dark])
            gone[number, dark] = True
        given[number] = share * fading_factors(light, lighting.reach[number], places.T)
    low, high = lighting.depths
    cue = depth_cue(places[:, 2], low, high - low)
    return _Lit(places, faces, triangle, item, given, gone, facing, cue)


def _colours(lighting: Lighting, own: Ints, lit: _Lit, kept: Floats, which: Ints) -> Floats:
    """(k, 3) red, green and blue of some points (k,) in palettes own (k,), of which lights leave parts kept (l, k)."""
    strength = light_colours(lighting.lights).reshape(len(lighting.lights), -1)
    result = np.empty((len(which), 3))
    for channel in range(3):
        # White light needs one number, coloured light one for red, green and blue each.
        if channel < strength.shape[1]:
            given = strength[:, channel, None] * lit.given[:, which]
            total, left = given.sum(axis=0), (given * kept).sum(axis=0)
            bright = np.minimum(total, 1.0) * left / np.where(total > 0.0, total, 1.0)
            shade = np.clip(DIRECT_SHARE * bright + lit.cue[which], 0.0, 1.0)
            level = np.rint(shade * (COLOUR_MAP - 1)).astype(np.intp)
        result[:, channel] = lighting.palettes[own, level, channel]
    return result


def _normals(triangles: SceneTriangles, found: VisiblePoints, to_eye: Floats) -> tuple[Floats, Floats]:
    """(m, 3) unit normals of faces and of the surface they stand for, both on the eye's side."""
    faces = unit(face_normals(triangles.points, found.corners))
    away = np.einsum("ij,ij->i", faces, to_eye) < 0.0
    faces[away] *= -1.0
    smooth = replace(found, corners=np.take(triangles.normals.index, found.triangle, axis=0)).interpolated(
        triangles.normals.normals
    )
    smooth = unit(smooth)
    smooth[np.einsum("ij,ij->i", smooth, faces) < 0.0] *= -1.0
    lost = ~any_component(smooth)
    smooth[lost] = faces[lost]
    return faces, smooth


def _shares(lighting: Lighting, item: Ints, alpha: Floats, normals: Floats, to_light: Floats, to_eye: Floats) -> Floats:
    """(m,) what points make of a light of intensity 1, each by the material of its item."""
    share = np.zeros(len(item))
    finish = lighting.finish[item]
    for number, made in enumerate(lighting.finishes):
        own = np.flatnonzero(finish == number)
        if not len(own):
            continue
        a = alpha[own]
        beta = np.zeros(len(own))
        if made.highlight:
            # The reflected ray against the direction to the eye, without the ray itself.
            eye = to_eye[own]
            beta = 2.0 * a * np.einsum("ij,ij->i", normals[own], eye) - np.einsum("ij,ij->i", to_light[own], eye)
        share[own] = brightness(a, beta, made)
    return share


def _matt_shares(lighting: Lighting, item: Ints, alpha: Floats) -> Floats:
    """(m,) what points make of a light of intensity 1 without a highlight."""
    share = np.zeros(len(item))
    finish = lighting.finish[item]
    for number, made in enumerate(lighting.finishes):
        own = finish == number
        share[own] = made.diffuse * lambert(alpha[own], made.exponent)
    return share
