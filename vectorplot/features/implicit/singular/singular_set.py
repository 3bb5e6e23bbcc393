"""Meshes of implicit surfaces led into the lines and points in which the gradient vanishes."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.implicit_sides import BOXED, Plane, sides_of
from vectorplot.features.implicit.polygonize import checked_values
from vectorplot.features.implicit.singular.implicit_singular_lines import SLOW, SingularLines, usual_gradient
from vectorplot.features.implicit.singular.singular_equations import SingularEquations, onto_lines
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul, pseudo_inverse, symmetric_eigen
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import Polylines, closed_round
from vectorplot.geometry.repair.weld import distinct_points
from vectorplot.surfaces.surface import ImplicitSurface, hessians
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_values import VANISHED_GRADIENT

REACH = 1.5
"""Longest sides of triangles from which vertices are led there: polygonised sheets that cross keep clear of each other
by up to so much."""

TIPS = 4.0
"""The same for the outermost vertices of the wings of a cuspidal edge, between which polygons go across."""

ACROSS = 0.0
"""Cosine between the true normals at the ends of a side below which it goes across from one wing to the other."""

TWICE = 3
"""How often outermost vertices are looked for: behind those that are led away stand others."""

FINER = 4
"""Points on every chord of a line that vertices are led to at first."""

APART = 0.15
"""Part of the way from a line to the nearest other one from which vertices are led to it at most: nearer to where lines
meet the sheets between them are narrower than triangles, and would be led into the lines altogether."""

FIRM = 0.03
"""Part of the largest principal second derivative below which one belongs to a direction along a singular line."""

ROUNDS = 8
"""Steps of Newton's method for where the gradient vanishes."""


def led_into_singular_set(surface: ImplicitSurface, mesh: Mesh, lines: SingularLines) -> Mesh:
    """The mesh, its vertices near the singular lines of the surface, and near isolated singular points, moved there."""
    points, triangles = _into_points(surface, mesh.vertices, REACH * _longest(mesh)), mesh.corners.reshape(-1, 3)
    led = Mesh.from_triangles(points, triangles[~_flat(points[triangles])])
    return led_into_lines(surface, led, lines)[0]


def led_into_lines(surface: ImplicitSurface, mesh: Mesh, lines: SingularLines) -> tuple[Mesh, Bools]:
    """The mesh, its vertices near the singular lines of the surface moved there, without the triangles that are then no
    more than a part of a line; and which vertices (v,) are on such a line.

    Where two sheets cross, polygonised ones turn away from each other and leave a gap; the wings of a cuspidal edge end
    before it, and polygons go across from one to the other. Now all end on the line. Vertices on the sides of the box
    stay on them.
    """
    there = np.zeros(len(mesh.vertices), dtype=np.bool_)
    if not mesh.face_count or not len(lines):
        return mesh, there
    points, triangles, longest = mesh.vertices, mesh.corners.reshape(-1, 3), _longest(mesh)
    rooms = _rooms([some for _, some in lines.kinds])
    for (equations, some), room in zip(lines.kinds, rooms, strict=True):
        near = _Near(equations, some, room)
        points = near.led(points, ~there, REACH * longest, there)
        for _ in range(TWICE if some is lines.edges else 0):
            points = near.led(points, _tips(surface, points, triangles, there), TIPS * longest, there)
    # Vertices that were led to the end of a line are one.
    first, number = distinct_points(points)
    points, there, triangles = points[first], there[first], number[triangles]
    kept = ~there[triangles].all(axis=1) & ~_flat(points[triangles])
    return Mesh.from_triangles(points, triangles[kept]), there


def _longest(mesh: Mesh) -> float:
    """The longest side of the triangles."""
    corners = mesh.vertices[mesh.corners.reshape(-1, 3)]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(initial=0.0))


def _flat(corners: Floats) -> Bools:
    """(t,) triangles (t,3,3) two corners of which are in one place."""
    return np.asarray((corners == np.roll(corners, 1, axis=1)).all(axis=2).any(axis=1), dtype=np.bool_)


class _Near:
    """Lines of one kind, and a tree of places (k,3) along them; room (k,): how far the nearest other line is."""

    def __init__(self, equations: SingularEquations, lines: Polylines, room: Floats) -> None:
        from scipy.spatial import cKDTree

        self.equations, self.places, self.room = equations, _along(lines)[0], room
        self.tree = cKDTree(self.places)
        self.points = lines.points[closed_round(lines).index]
        self.corners = cKDTree(self.points)

    def led(self, points: Floats, which: Bools, reach: float, there: Bools) -> Floats:
        """The points (n,3), those of which that lie nearer to a line than reach moved onto it, and marked as there."""
        sides = sides_of(self.equations.surface)
        chosen = np.flatnonzero(which)
        far, place = self.tree.query(points[chosen], distance_upper_bound=reach)
        # Points without a line within reach have a place behind the last one.
        near = far <= APART * np.append(self.room, 0.0)[place]
        chosen, place = chosen[near], place[near]
        step = np.full(len(chosen), reach)
        found, on = onto_lines(self.equations, self.places[place], step)
        # Where lines end their equations have no rank: what is known is the last point.
        found[~on] = self.points[self.corners.query(self.places[place[~on]])[1]]
        start = points[chosen]
        for row in sides.box:
            held = start == row
            leaves = (held & (found != row)).any(axis=1)
            found[leaves] = self._in_side(start[leaves], held[leaves], reach)
        for side in range(BOXED, len(sides.normals)):
            plane = sides.planes(side)[0]
            leaves = sides.on(start)[:, side] & ~plane.holds(found, sides.nothing)
            found[leaves] = self._in_plane(start[leaves], plane, sides.nothing, reach)
        inside = np.isfinite(found).all(axis=1) & sides.has(found)
        result = points.copy()
        result[chosen[inside]] = found[inside]
        there[chosen[inside]] = True
        return result

    def _in_plane(self, start: Floats, plane: Plane, nothing: float, reach: float) -> Floats:
        """(k,3) the nearest points of the lines in a plane next to points (k,3); NaN where none is within reach."""
        some = self.points[plane.holds(self.points, nothing)]
        gap = np.linalg.norm(some - start[:, None], axis=2)
        near = (gap <= reach).any(axis=1)
        found = np.full_like(start, np.nan)
        found[near] = some[np.argmin(gap[near], axis=1)] if len(some) else np.nan
        return found

    def _in_side(self, start: Floats, held: Bools, reach: float) -> Floats:
        """(k,3) the nearest points of the lines in the sides of the box that points (k,3) lie in, by their coordinates
        that are held (k,3); NaN where there are none within reach."""
        gap = np.linalg.norm(self.points - start[:, None], axis=2)
        gap[~((self.points == start[:, None]) | ~held[:, None]).all(axis=2)] = np.inf
        best = np.argmin(gap, axis=1) if len(start) else np.zeros(0, dtype=np.intp)
        near = gap[np.arange(len(start)), best] <= reach
        return np.where(near[:, None], self.points[best], np.nan)


def _along(lines: Polylines) -> tuple[Floats, Ints]:
    """(k,3) places along lines, FINER on every chord; and (k,) the line of each."""
    rounds = closed_round(lines)
    points, line = lines.points[rounds.index], ragged.owner(np.diff(rounds.offsets))
    last = rounds.offsets[1:] - 1
    begin = np.delete(np.arange(len(points)), last)
    share = np.arange(FINER)[:, None, None] / FINER
    along = points[begin] + share * (points[begin + 1] - points[begin])
    places = np.concatenate([along.reshape(-1, 3), points[last]])
    return places, np.concatenate([np.tile(line[begin], FINER), line[last]])


def _rooms(kinds: list[Polylines]) -> list[Floats]:
    """For places along the lines of each kind (k,): how far they are from the nearest other line of any kind; infinite
    where there is no other."""
    from scipy.spatial import cKDTree

    first = ragged.offsets([len(lines) for lines in kinds])
    found = [_along(lines) for lines in kinds]
    places = np.concatenate([place for place, _ in found])
    line = np.concatenate([own + start for (_, own), start in zip(found, first[:-1], strict=True)])
    room = np.full(len(places), np.inf)
    for one in range(first[-1]):
        room[line == one] = cKDTree(places[line != one]).query(places[line == one])[0]
    return np.split(room, ragged.offsets([len(place) for place, _ in found])[1:-1])


def _tips(surface: ImplicitSurface, points: Floats, triangles: Ints, there: Bools) -> Bools:
    """(n,) vertices of triangles (t,3) that are not there, at ends of sides that go across from one wing to another."""
    with np.errstate(all="ignore"):
        slopes = surface.gradients(points)
        normals = slopes / np.linalg.norm(slopes, axis=1, keepdims=True)
    a, b = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    over = ((normals[a] * normals[b]).sum(axis=1) < ACROSS) & ~there[a] & ~there[b]
    tips = np.zeros(len(points), dtype=np.bool_)
    tips[a[over]] = tips[b[over]] = True
    return tips


def _into_points(surface: ImplicitSurface, points: Floats, reach: float) -> Floats:
    """The points (n,3), those near isolated singular points, such as the apex of a cone, moved into them."""
    low, high = np.asarray(surface.box, dtype=np.float64)
    sides = sides_of(surface)
    with np.errstate(all="ignore"):
        usual = usual_gradient(surface, points)
        steep = np.linalg.norm(surface.gradients(points), axis=1)
        near = np.flatnonzero(~(steep > SLOW * usual))
        start = points[near]
        held = (start == low) | (start == high)
        x = start.copy()
        for _ in range(ROUNDS):
            slope = np.where(held, 0.0, np.nan_to_num(surface.gradients(x)))
            bend = np.where(held[:, None] | held[:, :, None], 0.0, np.nan_to_num(hessians(surface, x)))
            step = (matmul(pseudo_inverse(bend, rcond=FIRM), slope[..., None]))[..., 0]
            x = x - step * np.minimum(1.0, reach / np.maximum(np.linalg.norm(step, axis=1), LEAST_DIVISOR))[:, None]
        sizes = np.abs(symmetric_eigen(np.nan_to_num(hessians(surface, x)))[0])
        flat = np.linalg.norm(np.nan_to_num(surface.gradients(x), nan=np.inf), axis=1) <= VANISHED_GRADIENT * usual
        on = np.abs(checked_values(surface, x)) <= VANISHED_GRADIENT * usual * reach
    good = flat & on & (np.linalg.norm(x - start, axis=1) <= reach) & sides.has(x)
    good &= ~(sides.on(start) & ~sides.on(x)).any(axis=1)
    good &= sizes.min(axis=1) > FIRM * sizes.max(axis=1)
    result = points.copy()
    result[near[good]] = x[good]
    return result
