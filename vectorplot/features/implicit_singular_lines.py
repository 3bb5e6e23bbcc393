"""Lines of an implicit surface along which its gradient vanishes, and meshes led into them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conditions import SpatialCondition
from vectorplot.features.polygonization import BOXED, Plane, checked_values, sides_of
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import matmul, pseudo_inverse, singular_decomposition, symmetric_eigen
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import Polylines, closed_round
from vectorplot.geometry.weld import chained, distinct_points, one_each
from vectorplot.surfaces.surface import ImplicitSurface, hessians
from vectorplot.tolerances import (
    LEAST_DIVISOR,
    RANK_OF_BENDING,
    SAME_ON_LINE,
    SECOND_DIFFERENCE_IN_SPACE,
    SETTLED_ON_LINE,
    SHALLOW_CROSSING,
    VANISHED_GRADIENT,
    VANISHED_ON_LINE,
)

# What holds on the lines along which the gradient of F vanishes: equations of rank two, with Newton's method for them.
#
# Where two sheets cross, the second derivatives H of F have rank two, and the gradient alone leads there. Along a
# cuspidal edge H has rank one, and the gradient vanishes twice over: there H says how fast. The sum of the principal
# minors of H, which is the product of its two larger eigenvalues, vanishes there once.

ROUNDS = 10
"""Steps of Newton's method onto a singular line."""

PATIENCE, HALF = 3, 0.5
"""After so many steps each must be shorter than this part of the one before: otherwise there is nothing to be found."""


class SingularEquations(Protocol):
    """Equations of the singular lines of one kind, of a surface that is about extent large."""

    @property
    def surface(self) -> ImplicitSurface:
        """The surface."""
        ...

    @property
    def extent(self) -> float:
        """How large it is."""
        ...

    def rows(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,r) what is zero on the lines, as lengths, at points (n,3); and (n,r,3) the slopes."""
        ...

    def real(self, points: Floats) -> Bools:
        """(n,) whether sheets end or cross at singular points, as those of this kind do."""
        ...


@dataclass(frozen=True, eq=False)
class DoubleLines:
    """Lines in which two sheets of a surface cross: its gradient vanishes, and H has eigenvalues of both signs across.

    Where both are of one sign the line is no part of a sheet (the handle of Whitney's umbrella).
    """

    surface: ImplicitSurface
    extent: float

    def rows(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,3) and (n,3,3): as for SingularEquations."""
        return _gradient_rows(self.surface, points)

    def real(self, points: Floats) -> Bools:
        """(n,) where the sheets that cross are real ones."""
        with np.errstate(all="ignore"):
            return np.asarray(_flatness(hessians(self.surface, points)) < -SHALLOW_CROSSING, dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class CuspidalEdges:
    """Lines at which a surface turns back: its gradient vanishes, and of the second derivatives all but one.

    Source: Arnold, Gusein-Zade and Varchenko, Singularities of differentiable maps (1985), on fronts.
    """

    surface: ImplicitSurface
    extent: float

    def rows(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,4) and (n,4,3): as for SingularEquations."""
        away, slopes = _gradient_rows(self.surface, points)
        flat, along = self.flatness(points)
        return (
            np.concatenate([away, flat[:, None] * self.extent], axis=1),
            np.concatenate([slopes, along[:, None] * self.extent], axis=1),
        )

    def real(self, points: Floats) -> Bools:
        """(n,) everywhere: in any section across the edge F is that of a cusp."""
        return np.ones(len(points), dtype=np.bool_)

    def flatness(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,) the ratio of the second largest eigenvalue of H to the largest, about, and (n,3) its gradient."""
        h = SECOND_DIFFERENCE_IN_SPACE * self.extent
        around = points + h * np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])[:, None]
        with np.errstate(all="ignore"):
            own, *beside = _flatness(hessians(self.surface, around.reshape(-1, 3))).reshape(7, -1)
        ahead, behind = np.stack(beside[:3], axis=-1), np.stack(beside[3:], axis=-1)
        return own, (ahead - behind) / (2.0 * h)

    def turnings(self, points: Floats) -> Floats:
        """(n,3) into the sheets, from points on the edge: both wings go that way.

        Across the edge F is a z^2 + b y^3, and its sheets lie where the signs of both terms differ.
        """
        with np.errstate(all="ignore"):
            values, vectors = symmetric_eigen(np.nan_to_num(hessians(self.surface, points)))
            steepest = np.abs(values).argmax(axis=1)
            normal = np.take_along_axis(vectors, steepest[:, None, None], axis=2)[..., 0]
            # Its sign is that of b / a, whatever that of a is.
            along = self.flatness(points)[1]
        along = along - (along * normal).sum(axis=1, keepdims=True) * normal
        return np.asarray(np.nan_to_num(-along))


def onto_lines(
    equations: SingularEquations, points: Floats, reach: Floats, across: Floats | None = None
) -> tuple[Floats, Bools]:
    """Points (n,3) led onto singular lines, not further than reach (n,), and which of them got there.

    across (n,3): unit normals of the planes that points stay in; without them they take the shortest way.
    """
    x, settled = points.copy(), np.zeros(len(points), dtype=np.bool_)
    digits = 16.0 * np.spacing(np.abs(points).max(axis=1, initial=0.0)) + SETTLED_ON_LINE * equations.extent
    active: Ints = np.arange(len(points))
    before = np.full(len(points), np.inf)
    for again in range(ROUNDS):
        if not len(active):
            break
        away, slopes = equations.rows(x[active])
        if across is not None:
            level = (across[active] * (x - points)[active]).sum(axis=1)
            away = np.concatenate([away, level[:, None]], axis=1)
            slopes = np.concatenate([slopes, across[active][:, None]], axis=1)
        step = _least_step(away, slopes, 2 if across is None else 3)
        length = np.linalg.norm(step, axis=1)
        with np.errstate(over="ignore"):
            step *= np.minimum(1.0, reach[active] / np.maximum(length, LEAST_DIVISOR))[:, None]
        usable = np.isfinite(length)
        x[active[usable]] += step[usable]
        settled[active] = usable & (length <= digits[active])
        # Once it is near, every step is shorter by far than the one before.
        comes_near = (again < PATIENCE) | (length < HALF * before[active])
        before[active] = length
        active = active[usable & comes_near & ~settled[active]]
    near = np.linalg.norm(x - points, axis=1) <= reach
    found = np.flatnonzero(settled & near)
    settled[:] = False
    settled[found] = _vanishes(equations, x[found]) & equations.real(x[found])
    return np.where(settled[:, None], x, points), settled


def line_tangents(equations: SingularEquations, points: Floats) -> Floats:
    """(n,3) unit tangents, of either sense, of the lines at points on them."""
    slopes = np.nan_to_num(equations.rows(points)[1])
    return np.asarray(singular_decomposition(slopes)[2][:, 2])


def _least_step(away: Floats, slopes: Floats, rank: int) -> Floats:
    """(n,3) Newton's steps of least length for equations (n,r) with slopes (n,r,3) of a rank."""
    known: Bools = np.asarray(np.isfinite(away).all(axis=1) & np.isfinite(slopes).all(axis=(1, 2)))
    left, sizes, right = singular_decomposition(np.where(known[:, None, None], slopes, 0.0))
    sizes = np.where(sizes > RANK_OF_BENDING * sizes[:, :1], sizes, np.inf)
    sizes[:, rank:] = np.inf
    with np.errstate(all="ignore"):
        parts = np.einsum("nrk,nr->nk", left, np.where(known[:, None], away, 0.0)) / sizes
    step = -np.einsum("nk,nkc->nc", parts, right)
    return np.where(known[:, None], step, np.nan)


def _vanishes(equations: SingularEquations, points: Floats) -> Bools:
    """(n,) whether F and all that the equations speak of vanish indeed, measured by second derivatives."""
    surface, extent = equations.surface, equations.extent
    with np.errstate(all="ignore"):
        away = np.linalg.norm(equations.rows(points)[0], axis=1)
        bend = np.linalg.norm(hessians(surface, points), axis=(1, 2))
        on = np.abs(checked_values(surface, points)) <= VANISHED_ON_LINE * extent**2 * bend
    return np.asarray((away <= VANISHED_ON_LINE * extent) & on & (bend > 0.0), dtype=np.bool_)


def _gradient_rows(surface: ImplicitSurface, points: Floats) -> tuple[Floats, Floats]:
    """(n,3) the gradient and (n,3,3) its slopes, both by the size of the second derivatives."""
    with np.errstate(all="ignore"):
        bend = hessians(surface, points)
        size = np.linalg.norm(bend, axis=(1, 2))[:, None]
        return np.asarray(surface.gradients(points) / size), np.asarray(bend / size[..., None])


def _flatness(bend: Floats) -> Floats:
    """(n,) the sums of the principal minors of matrices (n,3,3), by the squares of their sizes."""
    minors = [bend[:, i, i] * bend[:, j, j] - bend[:, i, j] * bend[:, j, i] for i, j in ((0, 1), (1, 2), (2, 0))]
    return np.asarray(sum(minors) / (bend * bend).sum(axis=(1, 2)))


# The lines of an implicit surface along which its gradient vanishes: cuspidal edges, and where it crosses itself.

STEPS = 48
"""Steps along the box from one point of a line to the next, before it is made finer."""

SLOW = 0.5
"""Part of the usual gradient below which singular lines are looked for."""

REACH = 6.0
"""Steps from the mesh within which they are: polygonised wings of a cuspidal edge end so far before it."""

FARTHEST = 1.7
"""Steps from a point to the next one of its line at most."""

FORWARD = 0.5
"""Cosine with the tangent above which another point lies ahead."""

MEETING_STEPS = 3
"""Steps of Newton along a line to where a condition holds, from close by."""

STRAYS = 0.5
"""Part of a step that a line may bend aside on it."""

LINE_ROUNDS = 1000
"""Points that are put to an end of a line at most."""

PARTS, CUTS = 16, 2
"""Into so many parts the last step to the end of a line is cut, and so often the first of them that leads too far."""

LAST_STEPS = 4
"""Such last steps at most: towards a swallowtail lines bend more and more."""

NONE = -1
"""No neighbour."""

GONE = -2
"""The line ends."""


@dataclass(frozen=True, eq=False)
class SingularLines:
    """The singular lines of a surface, coarsely: cuspidal edges, and double lines, where it crosses itself; with the
    equations that hold on each kind."""

    edges: Polylines
    edge_equations: CuspidalEdges
    doubles: Polylines
    double_equations: DoubleLines

    def __len__(self) -> int:
        return len(self.edges) + len(self.doubles)

    @property
    def kinds(self) -> list[tuple[SingularEquations, Polylines]]:
        """The lines of every kind that there are, with their equations."""
        both: list[tuple[SingularEquations, Polylines]] = [
            (self.edge_equations, self.edges),
            (self.double_equations, self.doubles),
        ]
        return [(equations, lines) for equations, lines in both if len(lines)]

    def onto(self, points: Floats, reach: Floats) -> tuple[Floats, Bools]:
        """Points (n,3) led onto the lines, not further than reach (n,), and which of them got there."""
        found, on = points.copy(), np.zeros(len(points), dtype=np.bool_)
        for equations, _ in self.kinds:
            rest = np.flatnonzero(~on)
            found[rest], on[rest] = onto_lines(equations, points[rest], reach[rest])
        return found, on

    def met(self, condition: SpatialCondition, points: Floats, reach: float) -> Floats:
        """Points (n,3), those nearer to a line than reach moved to where a condition holds on it; where it has no value
        there, as one about normals, onto the line."""
        result = points.copy()
        for equations, _ in self.kinds:
            start, on = onto_lines(equations, points, np.full(len(points), reach))
            row, x = np.flatnonzero(on), start[on]
            for _ in range(MEETING_STEPS):
                with np.errstate(all="ignore"):
                    tangent = line_tangents(equations, x)
                    step = -condition.values(x) / (condition.gradients(x) * tangent).sum(axis=1)
                near = np.abs(step) <= reach
                moved, there = onto_lines(
                    equations, x[near] + step[near, None] * tangent[near], reach + 0.0 * step[near]
                )
                near[near] = there
                x[near] = moved[there]
            result[row] = x
        return result


def singular_lines(surface: ImplicitSurface, mesh: Mesh) -> SingularLines:
    """The cuspidal edges and double lines of a surface within its box, polygonised as a mesh.

    They end on the sides of the box, and at points in which the equations of their kind lose their rank, known to about
    1e-4 of the extent: pinch points, swallowtails, points in which several lines meet.
    Edge cases: lines along which second derivatives vanish altogether are not found.
    """
    extent = float(np.ptp(np.asarray(surface.box, dtype=np.float64), axis=0).max())
    edges, doubles = CuspidalEdges(surface, extent), DoubleLines(surface, extent)
    start = _slow_places(surface, mesh, extent / STEPS)
    return SingularLines(_traced(edges, start), edges, _traced(doubles, start), doubles)


def default_gradient(surface: ImplicitSurface, points: Floats) -> float:
    """How long the gradient is at most of the points (n,3); 0 without any."""
    with np.errstate(all="ignore"):
        steep = np.linalg.norm(surface.gradients(points), axis=1)
    known = steep[np.isfinite(steep)]
    return float(np.median(known)) if len(known) else 0.0


def _slow_places(surface: ImplicitSurface, mesh: Mesh, step: float) -> Floats:
    """(k,3) vertices of a mesh at which the gradient is small, one in each cube of a lattice."""
    if not mesh.face_count:
        return np.zeros((0, 3))
    with np.errstate(all="ignore"):
        steep = np.linalg.norm(surface.gradients(mesh.vertices), axis=1)
        slow = mesh.vertices[~(steep > SLOW * default_gradient(surface, mesh.vertices))]
        slow = slow[one_each(slow, step)]
        # Second derivatives tell how far away the gradient may vanish.
        bends = np.linalg.norm(hessians(surface, slow), axis=(1, 2))
        far = np.linalg.norm(surface.gradients(slow), axis=1) > REACH * step * bends
    return np.asarray(slow[~far])


@dataclass(frozen=True, eq=False)
class _Chain:
    """Points (n,3) on lines with unit tangents (n,3); next (n,2): for each the one before it and the one behind it, by
    its tangent; NONE where that is not known yet, GONE where there is none."""

    points: Floats
    tangents: Floats
    next: Ints

    def joined(self, points: Floats, tangents: Floats) -> _Chain:
        """These and more."""
        fresh = np.full((len(points), 2), NONE)
        return records.joined((self, _Chain(points, tangents, fresh)))


def _traced(equations: SingularEquations, start: Floats) -> Polylines:
    """The lines on which equations hold, from places (k,3) near them."""
    step = equations.extent / STEPS
    found, on = onto_lines(equations, start, np.full(len(start), REACH * step))
    found = found[on & sides_of(equations.surface).has(found)]
    found = found[one_each(found, step)]
    chain = _Chain(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 2), dtype=np.intp))
    chain = chain.joined(found, line_tangents(equations, found))
    for _ in range(LINE_ROUNDS):
        chain = _linked(equations, chain, step)
        row, side = np.nonzero(chain.next == NONE)
        if not len(row):
            break
        way = chain.tangents[row] * np.where(side == 1, 1.0, -1.0)[:, None]
        new, on = _ahead(equations, chain.points[row], way, np.full(len(row), step))
        chain.next[row[~on], side[~on]] = GONE
        new = new[on]
        # Ends that come towards each other make one new point.
        new = new[one_each(new, SAME_ON_LINE * equations.extent)]
        chain = chain.joined(new, line_tangents(equations, new))
    return _polylines(equations, chain, step)


def _ahead(equations: SingularEquations, points: Floats, ways: Floats, lengths: Floats) -> tuple[Floats, Bools]:
    """(k,3) the points of lines in the planes that lie ahead of points (k,3), across unit ways (k,3), by lengths (k,);
    and which there are, in the box."""
    found, on = onto_lines(equations, points + lengths[:, None] * ways, STRAYS * lengths, across=ways)
    return found, on & sides_of(equations.surface).has(found)


def _linked(equations: SingularEquations, chain: _Chain, step: float) -> _Chain:
    """The chain with those points joined that follow one another: a line that sets out from the one arrives at the
    other."""
    from scipy.spatial import cKDTree

    points, tangents = chain.points, chain.tangents
    pairs = cKDTree(points).query_pairs(FARTHEST * step, output_type="ndarray") if len(points) else np.zeros((0, 2))
    one, two = np.concatenate([pairs, pairs[:, ::-1]]).astype(np.intp).T
    way = points[two] - points[one]
    long = np.linalg.norm(way, axis=1)
    along = (way * tangents[one]).sum(axis=1)
    side = (along > 0.0).astype(np.intp)
    from_two = (tangents[two] * way).sum(axis=1)
    other = (from_two < 0.0).astype(np.intp)
    open_ = (chain.next[one, side] == NONE) & (np.abs(along) > FORWARD * long) & (np.abs(from_two) > FORWARD * long)
    one, two, side, other, along, long = (x[open_] for x in (one, two, side, other, along, long))
    sense = np.sign(along)
    found, on = _ahead(equations, points[one], tangents[one] * sense[:, None], np.abs(along))
    same = on & (np.linalg.norm(found - points[two], axis=1) <= SAME_ON_LINE * equations.extent)
    one, two, side, other, long = (x[same] for x in (one, two, side, other, long))
    # The nearest one follows.
    order = np.lexsort((long, 2 * one + side))
    first = np.concatenate([[True], np.diff((2 * one + side)[order]) != 0])[: len(order)]
    chosen = order[first]
    new = chain.next.copy()
    new[one[chosen], side[chosen]] = two[chosen]
    back = (new[two[chosen], other[chosen]] == one[chosen]) | (new[two[chosen], other[chosen]] < 0)
    new[two[chosen][back], other[chosen][back]] = one[chosen][back]
    return _Chain(points, tangents, new)


def _polylines(equations: SingularEquations, chain: _Chain, step: float) -> Polylines:
    """The points in chains, led on to where the lines end; those without neighbours that stay where they are make
    no line."""
    one, two = np.nonzero(chain.next >= 0)
    chords = [np.unique(np.sort(np.stack([one, chain.next[one, two]], axis=1), axis=1), axis=0)]
    points = [chain.points]
    row, side = np.nonzero(chain.next == GONE)
    number, last, way = row, chain.points[row], chain.tangents[row] * np.where(side == 1, 1.0, -1.0)[:, None]
    count, far = len(chain.points), np.zeros(len(chain.points))
    for _ in range(LAST_STEPS):
        new, gone = _farthest(equations, last, way, step)
        np.maximum.at(far, row, gone)
        on = gone > 0.0
        row, number, last, way, new = row[on], number[on], last[on], way[on], new[on]
        if not len(row):
            break
        after = count + np.arange(len(row))
        chords.append(np.stack([number, after], axis=1))
        points.append(new)
        tangents = line_tangents(equations, new)
        way = tangents * np.where((tangents * way).sum(axis=1) < 0.0, -1.0, 1.0)[:, None]
        number, last, count = after, new, count + len(row)
    lonely = (chain.next < 0).all(axis=1) & (far < STRAYS * step)
    pairs, string = np.concatenate(chords), np.concatenate(points)
    gone_with = np.isin(_string_of(pairs, len(string)), np.flatnonzero(lonely))
    branches = concat(pairs[~gone_with[pairs[:, 0]]])
    return Polylines(string[branches.points], branches.offsets, branches.closed)


def _string_of(pairs: Ints, count: int) -> Ints:
    """(count,) the smallest number of the points that each point is connected to by pairs."""
    return chained(count, pairs[:, 0], pairs[:, 1])


def _farthest(equations: SingularEquations, points: Floats, ways: Floats, step: float) -> tuple[Floats, Floats]:
    """(k,3) the last points of lines ahead of points (k,3) on them, no more than a step away; and how far (k,) these
    are."""
    low, width = np.zeros(len(points)), step
    each = np.repeat(np.arange(len(points)), PARTS - 1)
    for _ in range(CUTS):
        width /= PARTS
        tried = low[:, None] + width * np.arange(1, PARTS)
        on = _ahead(equations, points[each], ways[each], tried.ravel())[1].reshape(tried.shape)
        low += width * np.logical_and.accumulate(on, axis=1).sum(axis=1)
    found, on = _ahead(equations, points, ways, low)
    side, leaves = _on_side(equations, points, ways, step)
    found = np.where(leaves[:, None], side, np.where(on[:, None], found, points))
    return found, np.linalg.norm(found - points, axis=1)


def _on_side(equations: SingularEquations, points: Floats, ways: Floats, step: float) -> tuple[Floats, Bools]:
    """(k,3) where lines ahead of points (k,3) leave the box or are cut, in the plane that the unit ways (k,3) lead to
    first; and which do within a step."""
    sides = sides_of(equations.surface)
    planes = [plane for side in range(len(sides.normals)) for plane in sides.planes(side)]
    normals, offsets = np.array([plane.normal for plane in planes]), np.array([plane.offset for plane in planes])
    with np.errstate(all="ignore"):
        lengths = (offsets - matmul(points, normals.T)) / (matmul(ways, normals.T))
    ahead = np.where(lengths >= 0.0, lengths, np.inf)
    nearest = np.argmin(ahead, axis=1)
    length = ahead[np.arange(len(points)), nearest]
    start = points + np.minimum(length, step)[:, None] * ways
    found, on = onto_lines(equations, start, np.full(len(points), step), across=normals[nearest])
    for number, plane in enumerate(planes):
        found[nearest == number] = plane.put(found[nearest == number])
    on &= (length <= step) & (length > 0.0) & sides.has(found)
    return found, on


# Meshes of implicit surfaces led into the lines and points in which the gradient vanishes.

SET_REACH = 1.5
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

SET_ROUNDS = 8
"""Steps of Newton's method for where the gradient vanishes."""


def led_into_singular_set(surface: ImplicitSurface, mesh: Mesh, lines: SingularLines) -> Mesh:
    """The mesh, its vertices near the singular lines of the surface, and near isolated singular points, moved there."""
    points, triangles = _into_points(surface, mesh.vertices, SET_REACH * _longest(mesh)), mesh.corners.reshape(-1, 3)
    led = Mesh.from_triangles(points, triangles[~_flat(points[triangles])])
    return led_into_lines(surface, led, lines)[0]


def led_into_lines(surface: ImplicitSurface, mesh: Mesh, lines: SingularLines) -> tuple[Mesh, Bools]:
    """The mesh with vertices near singular lines moved onto them, without triangles that become a part of a line; and
    (v,) which vertices are on such a line. It closes the gap that polygonised sheets leave where they cross, and
    takes off polygons across the wings of a cuspidal edge. Vertices on sides of the box stay there.
    """
    there = np.zeros(len(mesh.vertices), dtype=np.bool_)
    if not mesh.face_count or not len(lines):
        return mesh, there
    points, triangles, longest = mesh.vertices, mesh.corners.reshape(-1, 3), _longest(mesh)
    rooms = _rooms([some for _, some in lines.kinds])
    for (equations, some), room in zip(lines.kinds, rooms, strict=True):
        near = _Near(equations, some, room)
        points = near.led(points, ~there, SET_REACH * longest, there)
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
        usual = default_gradient(surface, points)
        steep = np.linalg.norm(surface.gradients(points), axis=1)
        near = np.flatnonzero(~(steep > SLOW * usual))
        start = points[near]
        held = (start == low) | (start == high)
        x = start.copy()
        for _ in range(SET_ROUNDS):
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
