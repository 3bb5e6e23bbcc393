"""Shades of the faces of a view and of their corners, the normals at corners, faces in one plane, and exposure.

Everything is in the view's coordinates, which keep angles: lights are brought there first. Points may be barycentres of
faces, corners of smooth surfaces with true normals, or corners of polygons that lie on faces.

Source: Glaeser, sections 4.5 and 8.5.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import PAIRS_AT_ONCE
from vectorplot.geometry.budget import in_turn, may_stop
from vectorplot.geometry.component_arrays import cross
from vectorplot.scene.added_lines import UPPER_LEFT
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.illumination import (
    backlit,
    brightness,
    depth_cue,
    facing,
    fading_factors,
    finish_of,
    fitting_factor,
    intensities,
    lamp_reach,
    light_cosines,
    shades,
    towards,
)
from vectorplot.shading.palettes import COLOUR_MAP, PALETTE_SIZE, Colours, palette, shaded_colours
from vectorplot.tolerances import FLAT_OF_EXTENT, LEAST_DIVISOR, ROUNDING
from vectorplot.visibility.painter.image_faces import outer_sides
from vectorplot.visibility.projected_faces import newell

# Shades of the faces of a view, and of their corners: what each light gives, and all of them together.

HEADLIGHT = Light(UPPER_LEFT, parallel=True, intensity=1.0)
"""The light of a view of a scene without lights, in the view's coordinates; it casts no shadows."""


@dataclass(frozen=True, eq=False)
class Shades:
    """How bright n points are in the light of l lights. shares (l,n): of a light of intensity 1; matt (l,n): without
    highlights; backlit (l,n): light on the far side; intensity (l,) or of red, green and blue; cue (n,): of being
    near the eye. Source: Glaeser, sections 4.5 and 8.5.
    """

    shares: Floats
    matt: Floats
    backlit: Bools
    intensity: Floats
    cue: Floats

    def __len__(self) -> int:
        return len(self.cue)

    @property
    def total(self) -> Floats:
        """(n,) shades from 0 to 1, of all lights together, in coloured light (3,n) of red, green and blue.

        Source: Glaeser, section 4.5, equations 3, 5 and 7."""
        return shades(self.shares, self.intensity, self.cue)

    def of_light(self, number: int) -> Floats:
        """Shades if only one of the lights were on.

        result: (n,) 0 to 1.
        """
        return shades(self.shares[number : number + 1], self.intensity[number : number + 1], self.cue)

    @property
    def fitted(self) -> Shades:
        """The same with intensities such that the brightest point just reaches the end of the lights' part of the
        palette. In a movie keep the intensities of the first picture. Source: Glaeser, section 4.5."""
        return replace(self, intensity=fitting_factor(self.shares, self.intensity) * self.intensity)


def view_lights(view: View, lights: Sequence[Light]) -> tuple[Light, ...]:
    """The lights in the view's coordinates; where there are none, one from the eye's upper left.

    Parameters
    ----------
    view : View
        Whose coordinates they are.
    lights : sequence of Light
        In the world.

    Returns
    -------
    tuple of Light
        At least one; all else of them is as it was.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, shading
    >>> from vectorplot.scene import look
    >>> view = look(vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),)), vp.Camera.view("front"))
    >>> (sun,) = shading.view_lights(view, [vp.Light((0, 0, 1), parallel=True)])
    >>> sun.position
    (0.0, 1.0, 0.0)
    """
    if not lights:
        return (HEADLIGHT,)
    return tuple(replace(light, position=_in_view(view, light)) for light in lights)


def light_colours(lights: Sequence[Light]) -> Floats:
    """(l,3) how much red, green and blue the lights send, their intensities included; (l,) where all are white.

    Errors: InputError for a colour that is none. Source: Glaeser, sections 4.5 and 8.5, note on coloured light sources.
    """
    strength = intensities(lights)
    if all(light.colour == "white" for light in lights):
        return strength
    sent = np.array([palette(light.colour, COLOUR_MAP)[-1] for light in lights]) / 255.0
    return np.asarray(strength[:, None] * sent)


def view_eye(view: View) -> tuple[float, float, float, float]:
    """The eye in homogeneous coordinates of the view."""
    if view.eye is None:
        return (0.0, 0.0, 1.0, 0.0)
    x, y, z = view.eye.tolist()
    return (x, y, z, 1.0)


def face_shades(view: View, items: Sequence[Item], lights: Sequence[Light]) -> Shades:
    """The shades of all faces of a view, at their barycentres, on the sides that the eye sees.

    Parameters
    ----------
    view : View
        With f faces.
    items : sequence of Item
        Of the view's scene.
    lights : sequence of Light
        In the view's coordinates, see view_lights.

    Returns
    -------
    Shades
        What each light gives to each face, and all of them together.

    Raises
    ------
    InputError
        For an intensity that is negative or not finite, and a position that is not finite.

    Notes
    -----
    Edge cases: faces without area have no normal; to them all lights come in flat.

    Source: Glaeser, section 4.5; errata G4-06 to G4-08.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, shading
    >>> from vectorplot.scene import look
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> view = look(cube, vp.Camera((6, 5, 4)))
    >>> lights = shading.view_lights(view, [vp.Light((0, 0, 1), parallel=True)])
    >>> shades = shading.face_shades(view, cube.items, lights)
    >>> shades.total.shape, shades.total.argmax().item()
    ((6,), 5)
    """
    return decal_shades(view, items, lights, face_middles(view), np.arange(view.face_count))


def decal_shades(view: View, items: Sequence[Item], lights: Sequence[Light], points: Floats, face: Ints) -> Shades:
    """The shades of points (3,n) that lie on some faces (n,) of a view; arguments as in face_shades."""
    normals = face_normals(view)[:, face]
    outer = facing(normals.T, towards(points.T, view_eye(view)))
    return point_shades(view, items, lights, points.T, outer, view.shown_item[face])


def point_shades(
    view: View, items: Sequence[Item], lights: Sequence[Light], points: Floats, normals: Floats, item: Ints
) -> Shades:
    """The shades of points (n,3) with unit normals (n,3), of surfaces of items (n,); the others as in face_shades."""
    eye = view_eye(view)
    own_finish = [finish_of(some.material) for some in items]
    finishes = list(dict.fromkeys(own_finish))
    of_item = np.array([finishes.index(finish) for finish in own_finish], dtype=np.intp)[item]
    shining = any(finish.highlight for finish in finishes)
    alpha, beta = light_cosines(points, normals, eye if shining else None, lights)
    shares, matt = np.zeros((2, *alpha.shape))
    for number, finish in enumerate(finishes):
        own = of_item == number if len(finishes) > 1 else slice(None)
        cosines = alpha[:, own], beta[:, own]
        shares[:, own] = brightness(*cosines, finish)
        matt[:, own] = brightness(*cosines, replace(finish, highlight=0.0)) if finish.highlight else shares[:, own]
    low, high = depth_limits(view)
    found = Shades(shares, matt, backlit(alpha), light_colours(lights), depth_cue(points[:, 2], low, high - low))
    return faded(view, found, lights, points.T) if any(light.fading for light in lights) else found


def faded(view: View, found: Shades, lights: Sequence[Light], points: Floats) -> Shades:
    """The shades of points (3,n), the light of fading lamps weaker with the square of the distance beyond their reach.

    Parallel light does not fade. Source: Glaeser, section 4.5, equation 4, figure 5.
    """
    factors = np.ones_like(found.shares)
    for row, light in zip(factors, lights, strict=True):
        row[:] = fading_factors(light, lamp_reach(view, light), points)
    return replace(found, shares=factors * found.shares, matt=factors * found.matt)


def depth_limits(view: View) -> tuple[float, float]:
    """Smallest and largest z of the scene in the view, no farther than five times the eye's distance from its target,
    and no nearer than a fifth of it. Edge cases: zeros without points.

    Source: Glaeser, section 4.4; erratum G4-04.
    """
    return limited_depths(view, view.points[2])


def limited_depths(view: View, depths: Floats) -> tuple[float, float]:
    """Smallest and largest of depths (n,) z in the view, within the same limits. Edge cases: zeros without any."""
    if not len(depths):
        return 0.0, 0.0
    low, high = float(depths.min()), float(depths.max())
    if view.eye is None:
        return low, high
    target, distance = float(view.target[2]), float(view.eye[2] - view.target[2])
    low = max(low, target - 4.0 * distance)
    return low, max(min(high, target + 0.8 * distance), low)


def face_middles(view: View) -> Floats:
    """The barycentres of the corners of every face.

    Parameters
    ----------
    view : View
        With f faces.

    Returns
    -------
    (3, f) array of float
        In the view's coordinates.

    Notes
    -----
    Edge cases: no columns for a view without faces.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, shading
    >>> from vectorplot.scene import look
    >>> view = look(vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),)), vp.Camera.view("top"))
    >>> shading.face_middles(view).T[-1].tolist()
    [0.0, 0.0, 1.0]
    """
    if not view.face_count:
        return np.zeros((3, 0))
    if view.is_triangular:
        a, b, c = (view.points[:, view.corners[k::3]] for k in range(3))
        return np.asarray((a + b + c) / 3.0)
    sums = np.add.reduceat(view.points[:, view.corners], view.offsets[:-1], axis=1)
    return np.asarray(sums / view.face_sizes)


def face_normals(view: View) -> Floats:
    """(3,f) unit outer normals of every face; zeros for one without area."""
    if not view.face_count:
        return np.zeros((3, 0))
    points = view.points
    if view.is_triangular:
        a, b, c = (points[:, view.corners[k::3]] for k in range(3))
        normals = cross(b - a, c - a)
    else:
        first = np.repeat(view.corners[view.offsets[:-1]], view.face_sizes)
        arm = points[:, view.corners] - points[:, first]
        after = arm[:, view.after(np.arange(len(view.corners)))]
        normals = np.add.reduceat(cross(arm, after), view.offsets[:-1], axis=1)
    length = np.sqrt(np.einsum("ij,ij->j", normals, normals))
    return np.asarray(normals / np.where(length > 0.0, length, 1.0))


def shows_inside(view: View) -> Bools:
    """(f,) whether the eye sees the inner side of a face."""
    to_eye = towards(view.points[:, view.corners[view.offsets[:-1]]].T, view_eye(view))
    return np.asarray(np.einsum("ij,ji->j", face_normals(view), to_eye) < 0.0)


def face_colours(view: View, items: Sequence[Item], shade: Floats, count: int = PALETTE_SIZE) -> Colours:
    """The colours of all faces of a view at some shades.

    Parameters
    ----------
    view : View
        With f faces.
    items : sequence of Item
        Of the view's scene, with their palettes.
    shade : (f,) or (3, f) array of float
        0 to 1; of red, green and blue in coloured light.
    count : int
        How many shades a palette has.

    Returns
    -------
    (f, 3) array of uint8
        Red, green and blue.

    Raises
    ------
    InputError
        For an unknown palette, or a wrong count.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, shading
    >>> from vectorplot.scene import look
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2)), "gray"),))
    >>> view = look(cube, vp.Camera((6, 5, 4)))
    >>> shading.face_colours(view, cube.items, np.array([0, 0, 0, 0, 0, 1.0]))[4:].tolist()
    [[0, 0, 0], [255, 255, 255]]
    """
    return item_colours(items, view.shown_item, shade, count)


def item_colours(items: Sequence[Item], item: Ints, shade: Floats, count: int = PALETTE_SIZE) -> Colours:
    """(n,3) the colours of items (n,) at shades (n,) or (3,n) from 0 to 1, of palettes of so many shades.

    Errors: InputError that names the colour, where there is none of that name.
    """
    number = {name: k for k, name in enumerate(dict.fromkeys(some.colour for some in items))}
    which = np.array([number[some.colour] for some in items], dtype=np.intp)
    unlit = np.array([some.material.is_unlit for some in items], dtype=np.bool_)
    return shaded_colours(list(number), which[item], np.where(unlit[item], 1.0, shade), count)


def _in_view(view: View, light: Light) -> tuple[float, float, float]:
    """Where a light is in the view, or the direction it comes from there."""
    given = np.array(light.position, dtype=np.float64)
    x, y, z = (matmul(view.axes, given) if light.parallel else view.points_of(given[None])[:, 0]).tolist()
    return (x, y, z)


# Normals at the corners of triangles: faces that meet at a small angle share them, and so look round.
#
# Source: Glaeser, section 8.4, figure 12 (average normals).

BEYOND_EDGE = float(np.cos(np.radians(20.0)))
"""Triangles of a smooth surface do not turn so far from its true normals at their corners as the cosine of this."""


@dataclass(frozen=True, eq=False)
class TrueNormals:
    """What a surface tells of the vertices of a mesh in its place: at_vertices (v,3) unit normals of the world, zero
    where it has none; on_edge (v,): those on sharp edges, with the normal of one side of them; at_corners (c,3): those
    of a mesh of triangles at their corners, if they are known on all sides of its edges."""

    at_vertices: Floats
    on_edge: Bools
    at_corners: Floats | None = None


@dataclass(frozen=True, eq=False)
class CornerNormals:
    """normals (m, 3) unit vectors; index (t, 3): which of them each corner of each triangle has."""

    normals: Floats
    index: Ints


def view_normals(view: View, normals: Sequence[TrueNormals | None], crease_angle_deg: float) -> CornerNormals:
    """The normals at the corners of the triangles (t, 3) that the faces of a view make, see ragged.fans.

    normals: for every item those of its true surface, None where its faces are flat or, where they meet at less than
    the crease angle, look round.
    """
    may_stop()
    place, face = ragged.fans(view.offsets)
    triangles = view.corners[place]
    # Of a triangle between corners on one side of its face only the face can tell where it looks.
    of_faces = None if view.is_triangular else face_normals(view)[:, face].T
    points = np.ascontiguousarray(view.points.T)
    known, given = np.zeros(len(points), dtype=np.bool_), np.zeros((len(points), 3))
    on_edge = np.zeros(len(points), dtype=np.bool_)
    for item, own in enumerate(normals):
        if own is not None:
            part = slice(view.item_vertices[item], view.item_vertices[item + 1])
            given[part] = matmul(own.at_vertices, view.axes.T)
            known[part] = True
            on_edge[part] = own.on_edge
    found = corner_normals(points, triangles, crease_angle_deg, given, known, on_edge, of_faces)
    true = [(np.flatnonzero(view.face_item[face] == item), own) for item, own in own_corners(view, normals)]
    if not true:
        return found
    which, every = np.concatenate([rows for rows, _ in true]), np.concatenate([own for _, own in true])
    every, apex = matmul(every, view.axes.T), ~every.any(axis=1)
    # Where the surface has no normal its triangles tell.
    every[apex] = np.repeat(unit(mesh_face_normals(points, triangles[which])), 3, axis=0)[apex]
    index = found.index.copy()
    index[which] = len(found.normals) + np.arange(3 * len(which)).reshape(-1, 3)
    return CornerNormals(np.concatenate([found.normals, every]), index)


def own_corners(view: View, normals: Sequence[TrueNormals | None]) -> Iterator[tuple[int, Floats]]:
    """The items with true normals at the corners of all of their faces in a view, and these (c,3)."""
    count = np.bincount(view.face_item, minlength=len(normals))
    for item, own in enumerate(normals):
        if own is not None and own.at_corners is not None and len(own.at_corners) == 3 * count[item]:
            yield item, own.at_corners


def at_corners(view: View, normals: CornerNormals) -> Floats:
    """(3, c) the normals, see view_normals, at the corners of the faces of a view."""
    place, _ = ragged.fans(view.offsets)
    found = np.zeros((3, len(view.corners)))
    found[:, place.ravel()] = normals.normals[normals.index.ravel()].T
    return found


def mesh_face_normals(points: Floats, triangles: Ints) -> Floats:
    """(t, 3) normals of triangles (t, 3) of points (n, 3), as long as twice their area."""
    may_stop()
    a, b, c = (np.take(points, triangles[:, k], axis=0) for k in in_turn(range(3)))
    return product(b - a, c - a)


def product(u: Floats, v: Floats) -> Floats:
    """(n, 3) the cross products of vectors (n, 3)."""
    result = np.empty(u.shape)
    for k in in_turn(range(3)):
        i, j = (k + 1) % 3, (k + 2) % 3
        np.multiply(u[:, i], v[:, j], out=result[:, k])
        result[:, k] -= u[:, j] * v[:, i]
    return result


def unit(vectors: Floats) -> Floats:
    """(n, 3) vectors of length 1; zeros stay zeros."""
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0)[:, None])


def corner_normals(
    points: Floats,
    triangles: Ints,
    crease_angle_deg: float,
    given: Floats,
    known: Bools,
    on_edge: Bools | None = None,
    own: Floats | None = None,
) -> CornerNormals:
    """The normals at the corners of triangles (t,3) of points (n,3): the area-weighted mean of those around the vertex
    within the crease angle of its own. given (n,3), known (n,): true normals of true surfaces; on_edge (n,): on a
    sharp edge, where the true normal is for one side; own (t,3): unit normals of the faces that triangles are parts
    of.
    Edge cases: triangles without area do not count; alone they get their faces' normals, or zeros.
    """
    may_stop()
    faces = mesh_face_normals(points, triangles)
    if own is None:
        own = unit(faces)
    else:
        faces = own * np.abs(np.einsum("ij,ij->i", faces, own))[:, None]
    mean = np.stack([_sum_at(triangles, faces[:, k], len(points)) for k in range(3)], axis=1)
    mean = unit(mean)
    mean[known] = given[known]
    # Where all triangles lie within half of the angle from the mean, they lie within the angle from each other.
    least = np.cos(np.radians(min(crease_angle_deg, 180.0)) / 2.0)
    sharp = np.zeros(len(points), dtype=np.bool_)
    beyond = np.zeros(triangles.shape, dtype=np.bool_)
    for k in in_turn(range(3)):
        vertex = triangles[:, k]
        cosine = np.einsum("ij,ij->i", own, np.take(mean, vertex, axis=0))
        sharp[vertex[cosine < least]] = True
        if on_edge is not None:
            beyond[:, k] = on_edge[vertex] & (cosine < BEYOND_EDGE)
    sharp &= ~known
    apart = sharp[triangles] | beyond
    if not apart.any():
        return CornerNormals(mean, triangles)
    return _with_creases(faces, own, triangles, apart, mean, crease_angle_deg)


def _sum_at(triangles: Ints, values: Floats, count: int) -> Floats:
    """(count,) for each vertex the sum of values (t,) of the triangles around it."""
    total = np.zeros(count)
    for k in in_turn(range(3)):
        total += np.bincount(triangles[:, k], weights=values, minlength=count)
    return total


def _with_creases(
    faces: Floats, own: Floats, triangles: Ints, apart: Bools, mean: Floats, angle_deg: float
) -> CornerNormals:
    """The corners, some (t,3) of them apart from the others, with normals of their own."""
    may_stop()
    corner = np.flatnonzero(apart)
    vertex, triangle = triangles.ravel()[corner], corner // 3
    order = np.argsort(vertex, kind="stable")
    vertex, triangle, corner = vertex[order], triangle[order], corner[order]
    starts = np.flatnonzero(np.diff(vertex, prepend=-1))
    count = np.diff(np.append(starts, len(vertex)))
    ends = np.append(starts, len(vertex))
    cosine = np.cos(np.radians(angle_deg)) - ROUNDING
    sums = np.zeros((len(corner), 3))
    # Every corner beside every other one at its vertex.
    for first, last in ragged.batches(count * count, PAIRS_AT_ONCE):
        here = slice(int(ends[first]), int(ends[last]))
        sizes = np.repeat(count[first:last], count[first:last])
        one, other = ragged.owner(sizes), ragged.ranges(np.repeat(starts[first:last], count[first:last]), sizes)
        there = triangle[other]
        alike = np.einsum("ij,ij->i", own[triangle[here][one]], own[there]) >= cosine
        one, there = one[alike], there[alike]
        for k in range(3):
            sums[here, k] = np.bincount(one, weights=faces[there, k], minlength=here.stop - here.start)
    index = triangles.copy()
    index.ravel()[corner] = len(mean) + np.arange(len(corner))
    normals = np.where((sums != 0.0).any(axis=1)[:, None], unit(sums), own[triangle])
    return CornerNormals(np.concatenate([mean, normals]), index)


# Faces that lie in one plane, side by side: they have one shade, however they are cut.


def plane_numbers(view: View) -> Ints:
    """(f,) the number of the region of each face: faces of one item in one plane, connected by edges of two faces. A
    corner may be off by FLAT_OF_EXTENT; where that would bend a region more, only what is flat within the view's
    tolerance is taken together. Edge cases: faces wound against each other, or without area, stand alone.
    """
    may_stop()
    count = view.face_count
    number = np.arange(count)
    if not count:
        return number
    one, other = _neighbours(view)
    normal, _, first = newell(view, number)
    area = np.sqrt((normal * normal).sum(axis=0))
    unit = normal / np.where(area > 0.0, area, 1.0)
    alike = (unit[:, one] * unit[:, other]).sum(axis=0) > 0.0
    one, other = one[alike], other[alike]
    swap = area[other] > area[one]
    large, small = np.where(swap, other, one), np.where(swap, one, other)
    height = _greatest_height(view, small, unit[:, large], view.points[:, first[large]])
    bent = np.ones(count, dtype=np.bool_)
    for allowed in (max(FLAT_OF_EXTENT, view.tolerance), view.tolerance):
        near = np.flatnonzero((height <= allowed) & bent[large] & bent[small])
        found = _hanging_together(count, large[near], small[near])
        flat = bent & ~_bent(view, found, normal, allowed)
        number = np.where(flat, count + found, number)
        bent &= ~flat
    return np.unique(number, return_inverse=True)[1].ravel()


def plane_middles(view: View, plane: Ints) -> Floats:
    """(3,f) the middle of the region that each face belongs to: of several faces the mean of theirs, by area."""
    middle = face_middles(view)
    count = np.bincount(plane) if len(plane) else plane
    several = np.flatnonzero(count[plane] > 1)
    if not len(several):
        return middle
    normal, _, _ = newell(view, several)
    # A part without area still has a place.
    weight = np.sqrt((normal * normal).sum(axis=0)) + LEAST_DIVISOR
    total = np.bincount(plane[several], weight, minlength=len(count))
    result = middle.copy()
    for row, out in zip(middle, result, strict=True):
        mean = np.bincount(plane[several], weight * row[several], minlength=len(count)) / np.where(total > 0, total, 1)
        out[several] = mean[plane[several]]
    return result


def _neighbours(view: View) -> tuple[Ints, Ints]:
    """Pairs of faces with a common edge that no other face has."""
    start, end = view.corners, view.corners[view.after(np.arange(len(view.corners)))]
    key = np.minimum(start, end) * view.points.shape[1] + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    first = np.flatnonzero(np.diff(key[order], prepend=-1))
    pairs = first[np.diff(np.append(first, len(key))) == 2]
    face = ragged.owner(view.face_sizes)[order]
    return face[pairs], face[pairs + 1]


def _greatest_height(view: View, face: Ints, normal: Floats, place: Floats) -> Floats:
    """(n,) how far the corners of faces (n,) are off planes through places (3,n) with unit normals (3,n)."""
    if not len(face):
        return np.zeros(0)
    sizes = view.face_sizes[face]
    ends = ragged.offsets(sizes)
    position = ragged.ranges(view.offsets[face], sizes)
    owner = ragged.owner(sizes)
    arm = view.points[:, view.corners[position]] - place[:, owner]
    return np.asarray(np.maximum.reduceat(np.abs((arm * normal[:, owner]).sum(axis=0)), ends[:-1]))


def _hanging_together(count: int, one: Ints, other: Ints) -> Ints:
    """(f,) the number of the component of each face, in a graph of some pairs."""
    if not len(one):
        return np.arange(count)
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(one)), (one, other)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.intp)


def _bent(view: View, region: Ints, normal: Floats, allowed: float) -> Bools:
    """(f,) the faces of regions that are farther off their mean planes than is allowed."""
    size = int(region.max()) + 1
    mean: Floats = np.stack([np.bincount(region, row, minlength=size) for row in normal]).astype(np.float64)
    length = np.sqrt((mean * mean).sum(axis=0))
    mean /= np.where(length > 0.0, length, 1.0)
    face = np.arange(view.face_count)
    some = np.zeros((3, size))
    some[:, region] = view.points[:, view.corners[view.offsets[:-1]]]
    height = _greatest_height(view, face, mean[:, region], some[:, region])
    worst = np.zeros(size)
    np.maximum.at(worst, region, height)
    return np.asarray(worst[region] > 2.0 * allowed, dtype=np.bool_)


# How bright a picture is made as a whole: the intensities of all lights, times one factor.
#
# Source: Glaeser, section 4.5, equation 7.


@dataclass(frozen=True)
class ExposedLight(Light):
    """A light of a picture, its intensity times the exposure: of any size, but not negative."""

    def __post_init__(self) -> None:
        if self.intensity is not None and not 0.0 <= self.intensity < np.inf:
            raise InputError(f"light {self.name}: an exposure to {self.intensity:g} times its light is out of range")


def exposed_scene(view: View, scene: Scene) -> tuple[Scene, tuple[Light, ...]]:
    """A scene with lights as its exposure has them, and these in the view: at least one, see view_lights.

    view: of the scene, surfaces as triangles. A fitted exposure is such that the brightest of the faces that are seen,
    wherever shadows fall, just reaches the end of the lights' part of the palette. Edge cases: in the dark it is 1.
    Source: Glaeser, section 4.5.
    """
    here = view_lights(view, scene.lights)
    if scene.exposure == 1.0:
        return scene, here
    factor = _fitted(view, scene.items, here) if scene.exposure == "fitted" else scene.exposure
    return replace(scene, lights=_exposed(scene.lights, factor)), _exposed(here, factor)


def _exposed(lights: Sequence[Light], factor: float) -> tuple[Light, ...]:
    """The lights with a factor to their intensities, of which those that say none have their share."""
    given = [{field.name: getattr(light, field.name) for field in fields(light)} for light in lights]
    strength = (factor * intensities(lights)).tolist()
    return tuple(ExposedLight(**one | {"intensity": share}) for one, share in zip(given, strength, strict=True))


def _fitted(view: View, items: Sequence[Item], lights: Sequence[Light]) -> float:
    """The factor of a fitted exposure. Of closed items the faces that turn away are not seen."""
    side = outer_sides(view)[view.face_item]
    seen = (side == 0) | (shows_inside(view) == (side < 0))
    found = face_shades(view, items, lights)
    return fitting_factor(found.shares[:, seen], found.intensity)
