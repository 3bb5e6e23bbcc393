"""Curves on implicit surfaces: contours, isophotes, sections, intersections, borders; found on a mesh, then refined."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import vector
from vectorplot.errors import InputError
from vectorplot.features.conditions import (
    ImplicitCentralContour,
    ImplicitIsophote,
    ImplicitPointIsophote,
    MeetsPlane,
    SpatialCondition,
)
from vectorplot.features.contours_and_isophotes import direction_across, in_planes, levels_of
from vectorplot.features.curve_tracing import Picture
from vectorplot.features.implicit_meshes import Band, ImplicitMesh, Nodes, curve_band, implicit_mesh, sheets_apart
from vectorplot.features.implicit_singular_lines import STRAYS, SingularEquations, SingularLines, onto_lines
from vectorplot.features.mesh_lines import level_segments
from vectorplot.features.polygonization import checked_values, onto_surface, sides_of
from vectorplot.features.scalar_fields import bracketed_zeros
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul, pseudo_inverse, symmetric_eigen
from vectorplot.geometry.budget import USUAL, Budget, unresolved
from vectorplot.geometry.chord_refinement import Refined, Traces, refined
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import (
    DOUBTS,
    EACH_LINE,
    EACH_POINT,
    NumberedLines,
    Polylines,
    closed_round,
    joined,
    take,
)
from vectorplot.geometry.records import APART
from vectorplot.geometry.vectors import cross, dot, norm, normalize
from vectorplot.geometry.weld import close_points, one_each
from vectorplot.geometry.winding import edge_uses
from vectorplot.surfaces.surface import ImplicitSurface, hessians
from vectorplot.tolerances import (
    APART_OF_EXTENT,
    BESIDE_LINE,
    CHORD_OF_EXTENT,
    CRITICAL_SETTLED,
    DOT_OF_EXTENT,
    FALLS_BESIDE,
    FIRM_DIRECTION,
    FLAT_OF_VALUES,
    LAST_STEP_OF_EXTENT,
    LEAST_DIVISOR,
    NODE_IN_SPACE,
    RANK_OF_BENDING,
    RESIDUAL_OF_EXTENT,
    RESOLUTION,
    ROUNDING_OF_TERMS,
    SECOND_DIFFERENCE_IN_SPACE,
    SHALLOW_NODE,
    TOUCHING_SHEETS_SINE,
    VANISHED_GRADIENT,
    VANISHED_VALUE,
    WIDE_OF_AREA,
    ZERO_OF_EXTENT,
)

# Points brought onto a curve F = 0, g = 0 in space, and polylines on it refined where they leave it.

REFINEMENT_ROUNDS = 16
"""Steps of Newton's method until another way is tried."""


@dataclass(frozen=True, eq=False)
class CurveInSpace:
    """The curve on which F of a surface and a condition g vanish. size: how large g is where it is far from zero;
    extent: of the surface; noise: what rounding makes of coordinates."""

    surface: ImplicitSurface
    condition: SpatialCondition
    size: float
    extent: float
    noise: float

    def values(self, points: Floats) -> Floats:
        """(...,) g; NaN where it is not finite."""
        with np.errstate(all="ignore"):
            w = np.array(self.condition.values(points), dtype=np.float64)
        w[~np.isfinite(w)] = np.nan
        return w

    def slopes(self, points: Floats) -> tuple[Floats, Floats]:
        """(n,3) the unit normals N of the surface, and the gradients of g along the surface."""
        with np.errstate(all="ignore"):
            normal = self.surface.gradients(points)
            normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
            slope = self.condition.gradients(points)
            return np.asarray(normal), np.asarray(slope - dot(slope, normal)[..., None] * normal)

    def onto(self, points: Floats, reach: Floats, fixed: Bools | None = None) -> tuple[Floats, Bools]:
        """Points (n,3) moved the shortest way onto the curve, steps not longer than reach (n,), and which got there.

        fixed (n,3+k): sides that they stay on. A point that ends further off than twice its reach did not.
        """
        x, arrived = points.copy(), np.zeros(len(points), dtype=np.bool_)
        active: Ints = np.arange(len(points))
        for _ in range(REFINEMENT_ROUNDS):
            if not len(active):
                break
            held = None if fixed is None else fixed[active]
            step, there = self._step(x[active], held)
            arrived[active] = there
            length = np.linalg.norm(step, axis=1)
            usable = np.isfinite(length)
            with np.errstate(all="ignore"):
                step *= np.minimum(1.0, reach[active] / np.where(length > 0.0, length, 1.0))[:, None]
            # The last step of those that arrived costs nothing and gains digits, if it is a small one.
            goes = usable & (~there | (length <= LAST_STEP_OF_EXTENT * self.extent))
            x[active[goes]] += step[goes]
            active = active[usable & ~there]
        arrived &= np.linalg.norm(x - points, axis=1) <= 2.0 * reach
        return np.where(arrived[:, None], x, points), arrived

    def _step(self, x: Floats, fixed: Bools | None) -> tuple[Floats, Bools]:
        """(n,3) Newton's step of least length for both equations, and whether x satisfies them already."""
        with np.errstate(all="ignore"):
            f, g = checked_values(self.surface, x), self.values(x)
            slope_f, slope_g = self.surface.gradients(x), self.condition.gradients(x)
            if fixed is not None:
                sides = sides_of(self.surface)
                slope_f, slope_g = sides.along(slope_f, fixed), sides.along(slope_g, fixed)
            ff, fg, gg = dot(slope_f, slope_f), dot(slope_f, slope_g), dot(slope_g, slope_g)
            determinant = ff * gg - fg * fg
            of_f, of_g = (gg * f - fg * g) / determinant, (ff * g - fg * f) / determinant
            step = -(of_f[:, None] * slope_f + of_g[:, None] * slope_g)
            near = RESIDUAL_OF_EXTENT * self.extent + self.noise
            there = (np.abs(f) <= near * np.sqrt(ff)) & (
                np.abs(g) <= RESIDUAL_OF_EXTENT * self.size + self.noise * np.sqrt(gg)
            )
        return step, np.asarray(there)

    def between(self, a: Floats, b: Floats, fixed: Bools) -> tuple[Floats, Bools]:
        """(k,3) points of the curve between points a and b (k,3) of the surface on different sides of g = 0, and which
        are zeros of g indeed; slow and sure: by brackets on the surface."""
        reach = np.linalg.norm(b - a, axis=1)

        def place(t: Floats, which: Ints) -> Floats:
            chord = a[which] + t[:, None] * (b - a)[which]
            return onto_surface(self.surface, chord, reach=reach[which], fixed=fixed[which])[0]

        w0, w1 = self.values(a), self.values(b)
        small = np.full(len(a), RESIDUAL_OF_EXTENT * self.size)
        with np.errstate(all="ignore"):
            guess = np.clip(np.nan_to_num(w0 / (w0 - w1), nan=0.5), 0.0, 1.0)
        t, rest = bracketed_zeros(lambda t, which: self.values(place(t, which)), w0, w1, guess, small)
        exact = (w0 == 0.0) | (w1 == 0.0)
        t = np.where(w0 == 0.0, 0.0, np.where(w1 == 0.0, 1.0, t))
        falls = np.abs(rest) <= FALLS_BESIDE * np.minimum(np.abs(w0), np.abs(w1)) + small
        return place(t, np.arange(len(a))), np.asarray(exact | falls, dtype=np.bool_)


def curve_in_space(surface: ImplicitSurface, condition: SpatialCondition, size: float) -> CurveInSpace:
    """The curve on which a condition of this size holds."""
    box = np.asarray(surface.box, dtype=np.float64)
    noise = 4.0 * float(np.spacing(np.abs(box).max()))
    return CurveInSpace(surface, condition, size, float(np.ptp(box, axis=0).max()), noise)


def refined_chords(curve: CurveInSpace, lines: Traces, tolerance: float, picture: Picture | None, most: int) -> Refined:
    """Polylines (points (p,3)) with points of the curve put in until chords stay within tolerance of it, measured in
    the picture, or there are most of them."""

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        chord = end - start
        return curve.onto(start + part[:, None] * chord, np.linalg.norm(chord, axis=1))

    return refined(lines, between, picture or (lambda points: points), tolerance, most)


# Polylines on a smooth curve that run to and fro, straightened out.

BACK = -0.7
"""Cosine between two chords below which the second runs back: that of a triangle around a tiny oval is -0.5."""


def without_folds(lines: Traces, closed: Bools) -> tuple[Traces, Bools]:
    """The polylines without the points at which they turn back: where a mesh is folded, crossings of its edges are not
    in the order in which they lie on the curve, and an arc can be met twice more, or as a closed curve of its own.

    closed (m,): which polylines are. Closed ones of which no three points are left are dropped.
    """
    kept, offsets = lines.unrepeated(closed)
    points, line = lines.points[kept], ragged.owner(np.diff(offsets))
    for _ in range(len(points)):
        back = _turns_back(points, line, closed)
        # Of two that follow one another the first goes, then it is looked at again.
        back[1:] &= ~back[:-1]
        if not back.any():
            break
        points, line = points[~back], line[~back]
    counts = np.bincount(line, minlength=len(closed))
    real = counts >= np.where(closed, 3, 2)
    left = Polylines(points[real[line]], ragged.offsets(counts[real]), closed[real])
    return Traces.of(left.points, closed_round(left)), left.closed


def _turns_back(points: Floats, line: Ints, closed: Bools) -> Bools:
    """(p,) points at which polylines turn back."""
    if not len(points):
        return np.zeros(0, dtype=np.bool_)
    first = np.concatenate([[True], line[1:] != line[:-1]])
    starts = np.flatnonzero(first)
    ends = np.append(starts[1:], len(points)) - 1
    before, after = np.arange(-1, len(points) - 1), np.arange(1, len(points) + 1)
    before[starts], after[ends] = ends, starts
    come, go = points - points[before], points[after] - points
    sizes = np.linalg.norm(come, axis=1) * np.linalg.norm(go, axis=1)
    back = (come * go).sum(axis=1) < BACK * sizes
    open_ends = ~closed[line[starts]]
    back[starts[open_ends]] = back[ends[open_ends]] = False
    return np.asarray(back, dtype=np.bool_)


# Where curves on an implicit surface cross, shrink to points, or meet a singular point of the surface.

ROUND_NODE = 4.0
"""Times the finest triangles: how far from a node the curve is led into it."""

ROUND_SINGULAR = 1.5
"""Times the longest side of the mesh: how far from a singular point of the surface the curve is led into it."""

ROUNDS = 24
"""Steps of Newton's method for critical points."""

MOST_ALONE = 64
"""Nodes or isolated points that are believed at most."""


@dataclass(frozen=True, eq=False)
class SpecialPoints:
    """nodes (n,3) where branches cross, with radii (n,) around which the curve is led into them; isolated (i,3) points;
    near (float): how near to these curves are noise; unclear (k,3): places that could not be told."""

    nodes: Floats
    radii: Floats
    isolated: Floats
    near: float
    unclear: Floats


def special_points(curve: CurveInSpace, own: ImplicitMesh, band: Band) -> SpecialPoints:
    """The special points of a curve, from the triangles of its band that are still open at the finest resolution."""
    corners = own.mesh.vertices[own.mesh.corners.reshape(-1, 3)]
    longest = float(norm(corners - np.roll(corners, 1, axis=1)).max())
    singular = _met_by(curve, isolated_singular_points(curve.surface, own, longest))
    triangles = band.nodes.points[band.triangles[band.open]]
    near = np.zeros((0, 3))
    if not len(triangles):
        return SpecialPoints(singular, np.full(len(singular), ROUND_SINGULAR * longest), near, 0.0, near)
    finest = float(np.median(np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)))
    middles = triangles.mean(axis=1)
    middles = middles[_lie_apart(middles, singular, 2.0 * ROUND_SINGULAR * longest)]
    heads = one_each(middles, 3.0 * finest)
    found, settled, ratio = _critical(curve, middles[heads], 10.0 * finest)
    zero = settled & (np.abs(curve.values(found)) <= NODE_IN_SPACE * curve.size)
    crossing, point = zero & (ratio < -SHALLOW_NODE), zero & (ratio > SHALLOW_NODE)
    nodes, isolated = _distinct(found[crossing], finest), _distinct(found[point], finest)
    if len(nodes) + len(isolated) > MOST_ALONE:
        return SpecialPoints(singular, np.full(len(singular), ROUND_SINGULAR * longest), near, 0.0, found)
    radii = np.concatenate([np.full(len(singular), ROUND_SINGULAR * longest), np.full(len(nodes), ROUND_NODE * finest)])
    unclear = found[~crossing & ~point]
    return SpecialPoints(np.concatenate([singular, nodes]), radii, isolated, ROUND_NODE * finest, unclear)


def isolated_singular_points(surface: ImplicitSurface, own: ImplicitMesh, reach: float) -> Floats:
    """(k,3) singular points of the surface on none of its singular lines, and those in which these end."""
    found = singular_points(surface, own.mesh, reach)
    sides = sides_of(surface)
    for _, lines in own.lines.kinds:
        found = found[_lie_apart(found, lines.points, reach)]
        open_ = ~lines.closed
        ends = lines.points[np.concatenate([lines.offsets[:-1][open_], lines.offsets[1:][open_] - 1])]
        inside = sides.has(ends) & ~sides.on(ends).any(axis=1)
        found = _distinct(np.concatenate([found, ends[inside]]), 0.5 * reach)
    return found


def _met_by(curve: CurveInSpace, points: Floats) -> Floats:
    """Those of the points (k,3) that the curve passes, as far as the condition tells: where it is about normals it has
    no value at a singular point, and holds next to it."""
    return points[~(np.abs(curve.values(points)) > NODE_IN_SPACE * curve.size)]


def singular_points(surface: ImplicitSurface, mesh: Mesh, reach: float) -> Floats:
    """(k,3) points of the surface in which the gradient of F vanishes, such as the apex of a cone.

    They are looked for from the vertices where the gradient is small, by Newton's method.
    """
    with np.errstate(all="ignore"):
        steep = np.linalg.norm(surface.gradients(mesh.vertices), axis=1)
        usual = float(np.nanmedian(steep)) if np.isfinite(steep).any() else 0.0
        flat = mesh.vertices[~(steep > 0.2 * usual)]
        if not len(flat):
            return np.zeros((0, 3))
        start = flat[one_each(flat, 0.5 * reach)]
        x = start.copy()
        for _ in range(ROUNDS):
            bends = np.nan_to_num(hessians(surface, x))
            step = (
                matmul(pseudo_inverse(bends, rcond=RANK_OF_BENDING), np.nan_to_num(surface.gradients(x))[..., None])
            )[..., 0]
            x = x - step * np.minimum(1.0, reach / np.maximum(np.linalg.norm(step, axis=1), LEAST_DIVISOR))[:, None]
        flatness = np.nan_to_num(np.linalg.norm(surface.gradients(x), axis=1), nan=np.inf)
        on = np.abs(checked_values(surface, x)) <= VANISHED_VALUE * usual * reach
    stays = np.linalg.norm(x - start, axis=1) <= 4.0 * reach
    found = _distinct(x[on & stays & sides_of(surface).has(x) & (flatness <= VANISHED_GRADIENT * usual)], 0.5 * reach)
    return found if len(found) <= MOST_ALONE else found[:0]


def _critical(curve: CurveInSpace, start: Floats, reach: float) -> tuple[Floats, Bools, Floats]:
    """Critical points (k,3) of g on the surface near start (k,3), which were found, and the ratio (k,) of the smaller
    to the larger principal second derivative of g there: negative at saddles."""
    x, ratio = start.copy(), np.zeros(len(start))
    settled = np.zeros(len(start), dtype=np.bool_)
    step = np.zeros((len(start), 3))
    for _ in range(ROUNDS):
        if not len(x):
            break
        slope, bend, frame = _second_order(curve, x)
        with np.errstate(all="ignore"):
            values, vectors = symmetric_eigen(np.nan_to_num(bend))
            largest = np.abs(values).max(axis=1, keepdims=True)
            # Along a direction in which g hardly bends there is nothing to be found.
            firm = np.abs(values) > FIRM_DIRECTION * largest
            along = np.einsum("kij,ki->kj", vectors, slope)
            move = np.where(firm, -along / np.where(firm, values, 1.0), 0.0)
            step = np.einsum("kij,kj,kil->kl", vectors, move, frame)
            length = np.linalg.norm(step, axis=1)
            step *= np.minimum(1.0, reach / np.maximum(length, LEAST_DIVISOR))[:, None]
            ratio = (
                np.where(values[:, 0] * values[:, 1] < 0.0, -1.0, 1.0)
                * np.abs(values).min(axis=1)
                / np.maximum(largest[:, 0], LEAST_DIVISOR)
            )
        x = onto_surface(curve.surface, x + np.nan_to_num(step), reach=reach)[0]
        settled = np.isfinite(length) & (length <= CRITICAL_SETTLED * curve.extent + 10.0 * curve.noise)
    settled &= np.linalg.norm(x - start, axis=1) <= 2.0 * reach
    return x, settled, ratio


def _second_order(curve: CurveInSpace, x: Floats) -> tuple[Floats, Floats, Floats]:
    """Slopes (k,2) and second derivatives (k,2,2) of g along the surface, in frames (k,2,3) of the tangent planes."""
    normal, slope = curve.slopes(x)
    axis = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(normal, axis)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    frame = np.stack([first, np.cross(normal, first)], axis=1)
    h = SECOND_DIFFERENCE_IN_SPACE * curve.extent + 100.0 * curve.noise
    with np.errstate(all="ignore"):
        change = [
            (curve.condition.gradients(x + h * frame[:, k]) - curve.condition.gradients(x - h * frame[:, k]))
            / (2.0 * h)
            for k in (0, 1)
        ]
        own = np.einsum("kjl,ikl->kij", frame, np.stack(change))
        gradient = curve.surface.gradients(x)
        across = (curve.condition.gradients(x) * normal).sum(axis=1) / np.linalg.norm(gradient, axis=1)
        curved = np.einsum("kil,klm,kjm->kij", frame, hessians(curve.surface, x), frame)
    bend = (own + own.transpose(0, 2, 1)) / 2.0 - across[:, None, None] * curved
    return np.einsum("kil,kl->ki", frame, slope), np.asarray(bend), frame


def joined_at_nodes(lines: Traces, closed: Bools, special: SpecialPoints) -> tuple[Traces, Bools]:
    """Polylines led into the nodes near which they pass, and through them as straight as possible.

    closed (m,): which polylines are. Curves that lie near an isolated point as a whole are dropped.
    """
    points, nodes = lines.points, special.nodes
    about = np.full(len(points), -1)
    for k, (place, radius) in enumerate(zip(nodes, special.radii, strict=True)):
        about[np.linalg.norm(points - place, axis=1) < radius] = k
    for place in special.isolated:
        about[(np.linalg.norm(points - place, axis=1) < special.near) & (about < 0)] = len(nodes)
    if (about < 0).all():
        return lines, closed
    # Of a closed polyline the last point is the first one once more.
    vertex = np.arange(len(points))
    vertex[lines.ends[closed]] = lines.starts[closed]
    begin = np.flatnonzero(~lines.last)
    pairs = np.stack([vertex[begin], vertex[begin + 1]], axis=1)
    low, high = np.sort(about[pairs], axis=1).T
    leads = np.flatnonzero((low < 0) & (high >= 0) & (high < len(nodes)))
    end, node = pairs[leads, about[pairs[leads]].argmin(axis=1)], high[leads]
    # Each pair of ends has a copy of the node to itself.
    copy = len(points) + _straight_on(points[end] - nodes[node], node)
    branches = concat(np.concatenate([pairs[high < 0], np.stack([end, copy], axis=1)]))
    found = np.concatenate([points, nodes[node]])[branches.points]
    return Traces.of(found, closed_round(branches)), branches.closed


def _straight_on(ways: Floats, node: Ints) -> Ints:
    """(k,) numbers of ways (k,3) out of nodes (k,), one for two that go straight on in each other, the straightest
    pairs first; where an odd number of them leaves a node, each ends there."""
    unit = ways / np.maximum(norm(ways), LEAST_DIVISOR)[:, None]
    result, order = np.arange(len(ways)), np.argsort(node, kind="stable")
    for own in np.split(order, np.flatnonzero(np.diff(node[order])) + 1):
        if len(own) % 2:
            continue
        one, two = np.triu_indices(len(own), 1)
        free = np.ones(len(own), dtype=np.bool_)
        for k in np.argsort(dot(unit[own[one]], unit[own[two]]), kind="stable").tolist():
            if free[one[k]] and free[two[k]]:
                free[one[k]] = free[two[k]] = False
                result[own[two[k]]] = own[one[k]]
    return result


def _distinct(points: Floats, distance: float) -> Floats:
    """(k,3) the points, those within a distance of one another as one."""
    return points[np.unique(close_points(points, distance))] if len(points) else points


# Curves on implicit surfaces where a condition holds: found on a mesh, every point refined on both equations.

NEXT_TO = 4.0
"""So many times as far from a singular line as sheets are looked at a curve may end that goes on to it."""

THINNED = 0.3
"""Part of the width of triangles that crossings on their sides may follow one another in: nearer ones add nothing."""


@dataclass(frozen=True, eq=False)
class ImplicitTracing:
    """How curves on an implicit surface are traced. cells: along the longest side of the box, of the polygonising
    lattice; mesh: the surface polygonised already (see `implicit_mesh`); resolution: part of the box down to which
    unclear triangles are cut; tolerance: of chords; picture: maps points (k,3) to where the tolerance is measured,
    (k,2) or (k,3), such as mm on a page; budget: limits of work.
    """

    cells: int = 48
    mesh: ImplicitMesh | None = None
    resolution: float = RESOLUTION
    tolerance: float | None = None
    picture: Picture | None = None
    budget: Budget = USUAL


@dataclass(frozen=True, eq=False)
class ImplicitCurves(NumberedLines):
    """Polylines on an implicit surface. points (n,3): in the world; offsets (m+1,); closed (m,): the last point joins
    the first, which is not repeated; levels (m,): of a family; isolated (i,3): single points of the condition; nodes
    (k,3): where curves cross; doubts: a sentence for each undecided thing.
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    levels: Floats = field(metadata=EACH_LINE)
    isolated: Floats = field(metadata=APART)
    nodes: Floats = field(metadata=APART)
    doubts: tuple[str, ...] = field(metadata=DOUBTS)


def all_curves(families: Sequence[ImplicitCurves]) -> ImplicitCurves:
    """All the curves in one; a doubt that several of them have is said once."""
    return joined([no_curves(), *families])


def no_curves(doubts: tuple[str, ...] = ()) -> ImplicitCurves:
    """No curve at all."""
    flags, none = np.zeros(0, dtype=np.bool_), np.zeros((0, 3))
    return ImplicitCurves(none, np.zeros(1, dtype=np.intp), flags, np.zeros(0), none, none, doubts)


def mesh_of(surface: ImplicitSurface, tracing: ImplicitTracing) -> tuple[ImplicitMesh, tuple[str, ...]]:
    """The surface polygonised, and what is doubtful about that, unless it was polygonised before."""
    if tracing.mesh is not None:
        return tracing.mesh, ()
    own = implicit_mesh(surface, tracing.cells)
    return own, own.doubts


def curves_in_space(
    surface: ImplicitSurface,
    condition: SpatialCondition,
    *,
    size: float,
    tracing: ImplicitTracing,
    level: float = 0.0,
) -> ImplicitCurves:
    """The curves of an implicit surface on which a condition g is zero, each point refined on F and g to 1e-12.

    size: how large g is where it is far from zero. Where g is below FLAT_OF_VALUES of its size all over a triangle,
    values as small as that count as zero everywhere, so that an area where g is zero is not filled with lines.
    Errors: InputError for a resolution or tolerance that is not positive.
    """
    _check(tracing)
    own, doubts = mesh_of(surface, tracing)
    if not own.mesh.face_count:
        return no_curves(doubts)
    curve = curve_in_space(surface, condition, size)
    extent = curve.extent
    nodes, triangles, area = _nodes(curve, own)
    if area:
        doubts += ("the condition holds all over a part of the surface: no lines there",)
    band = curve_band(
        nodes,
        triangles,
        lambda starts, ends: _middles(curve, own.lines, starts, ends, area),
        lambda slopes, source: slopes,
        finest=tracing.resolution * extent,
        most=tracing.budget.triangles,
    )
    if not band.complete:
        doubts += (unresolved("a curve on an implicit surface is finer than its triangles"),)
    if len(band.singular):
        doubts += ("the gradient vanishes along lines: curves are known to a hundredth of the box there",)
    special = special_points(curve, own, band)
    points, pairs, spans = _crossings(curve, band)
    tolerance = CHORD_OF_EXTENT * extent if tracing.tolerance is None else tracing.tolerance
    lines, closed, dots = _polylines(points, pairs, spans, DOT_OF_EXTENT * extent)
    lines, closed = without_folds(lines, closed)
    lines, closed = joined_at_nodes(lines, closed, special)
    finer = refined_chords(curve, lines, tolerance, tracing.picture, tracing.budget.points)
    if not finer.enough.all():
        doubts += (unresolved("curves of an implicit surface are off by more than the tolerance"),)
    if finer.unsure.any():
        doubts += (f"{finer.unsure.sum()} chords of a curve on an implicit surface could not be refined",)
    if len(special.unclear):
        doubts += (f"{len(special.unclear)} places where a curve on an implicit surface is finer than the resolution",)
    isolated = np.concatenate([special.isolated, dots[_lie_apart(dots, special.isolated, APART_OF_EXTENT * extent)]])
    ended = _ended_on_lines(curve, own, finer.lines, closed)
    found = curves_of_lines(ended, closed, level=level, doubts=doubts)
    return replace(found, isolated=isolated, nodes=special.nodes)


def _check(tracing: ImplicitTracing) -> None:
    if not 0.0 < tracing.resolution < np.inf:
        raise InputError(f"tracing: resolution {tracing.resolution:g} must be positive")
    if tracing.tolerance is not None and not 0.0 < tracing.tolerance < np.inf:
        raise InputError(f"tracing: tolerance {tracing.tolerance:g} must be positive")


def _nodes(curve: CurveInSpace, own: ImplicitMesh) -> tuple[Nodes, Ints, bool]:
    """The vertices with the condition, those on singular lines once for every sheet; triangles (t,3) of them; and
    whether it holds in some area."""
    sheets = sheets_apart(own.mesh, own.on_line)
    points = own.mesh.vertices[sheets.vertex]
    on_line = own.on_line[sheets.vertex]
    fixed = sides_of(curve.surface).on(points)
    places = points.copy()
    places[on_line] = _beside(curve.surface, points[on_line], sheets.inner[on_line], fixed[on_line])
    w = curve.values(places)
    # On rims of holes the gradient may be infinite.
    rim = np.isnan(w)
    if rim.any():
        places[rim] = _beside(curve.surface, points[rim], _inner(points, sheets.triangles, ~rim)[rim], fixed[rim])
        w[rim] = curve.values(places[rim])
    small = np.asarray((np.abs(w) <= FLAT_OF_VALUES * curve.size)[sheets.triangles].all(axis=1))
    area = bool(small.any()) and _is_area(curve, own.mesh, small)
    near = np.abs(w) <= _slack(curve, area)
    values = np.where(near, 0.0, w)
    nodes = Nodes(points, places, on_line, fixed, values, *_slopes_and_gradients(curve, places))
    return nodes, sheets.triangles, area


def _inner(points: Floats, triangles: Ints, known: Bools) -> Floats:
    """(n,3) for each of the points (n,3) the mean of those known at the triangles (t,3) around it; itself for none."""
    total, count = np.zeros_like(points), np.zeros(len(points))
    for step in (1, 2):
        other = np.roll(triangles, -step, axis=1)
        good = known[other]
        np.add.at(total, triangles[good], points[other[good]])
        np.add.at(count, triangles[good], 1.0)
    return np.where(count[:, None] > 0.0, total / np.maximum(count, 1.0)[:, None], points)


def _beside(surface: ImplicitSurface, points: Floats, inner: Floats, fixed: Bools) -> Floats:
    """(n,3) places of the surface next to points (n,3) on its singular lines, on the way to inner points (n,3)."""
    way = sides_of(surface).along(BESIDE_LINE * (inner - points), fixed)
    return onto_surface(surface, points + way, reach=np.linalg.norm(way, axis=1), fixed=fixed)[0]


def _slopes_and_gradients(curve: CurveInSpace, points: Floats) -> tuple[Floats, Floats]:
    """(n,3) gradients of the condition along the surface, and those of F; zero where they are not finite."""
    with np.errstate(all="ignore"):
        gradients = np.nan_to_num(curve.surface.gradients(points), posinf=0.0, neginf=0.0)
    return curve.slopes(points)[1], gradients


def _is_area(curve: CurveInSpace, mesh: Mesh, small: Bools) -> bool:
    """Whether triangles at whose corners the condition holds are no mere slivers: it holds in their middles too."""
    triangles = mesh.corners.reshape(-1, 3)[small]
    a, b, c = (mesh.vertices[triangles[:, k]] for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    middle = (a + b + c) / 3.0
    on, arrived = onto_surface(curve.surface, middle, reach=float(np.sqrt(area.max())))
    wide = area > WIDE_OF_AREA * float(np.median(np.linalg.norm(mesh.area_vectors, axis=1)))
    return bool((wide & arrived & (np.abs(curve.values(on)) <= FLAT_OF_VALUES * curve.size)).any())


def _slack(curve: CurveInSpace, area: bool) -> float:
    """What values count as zero."""
    return FLAT_OF_VALUES * curve.size if area else ROUNDING_OF_TERMS * curve.size


def _middles(curve: CurveInSpace, lines: SingularLines, starts: Nodes, ends: Nodes, area: bool) -> Nodes:
    """New nodes between old ones, on the surface; between those on a singular line, on that."""
    reach = np.linalg.norm(ends.points - starts.points, axis=1) / 2.0
    fixed = starts.fixed & ends.fixed
    middles = (starts.points + ends.points) / 2.0
    points = onto_surface(curve.surface, middles, reach=reach, fixed=fixed)[0]
    on_line = starts.on_line & ends.on_line
    along = np.flatnonzero(on_line)
    found, on = lines.onto(middles[along], reach[along])
    on_line[along[~on]] = False
    along, found = along[on], found[on]
    inner = found + (starts.places + ends.places - starts.points - ends.points)[along] / (2.0 * BESIDE_LINE)
    points[along] = found
    places = points.copy()
    places[along] = _beside(curve.surface, found, inner, fixed[along])
    w = curve.values(places)
    values = np.where(np.abs(w) <= _slack(curve, area), 0.0, w)
    return Nodes(points, places, on_line, fixed, values, *_slopes_and_gradients(curve, places))


def _crossings(curve: CurveInSpace, band: Band) -> tuple[Floats, Ints, Floats]:
    """Points (k,3) of the curve on sides of triangles; pairs (s,2) of them that follow one another, the condition
    positive on the left; and the widths (k,) of the triangles there."""
    nodes = band.nodes
    found = level_segments(band.triangles, nodes.values)
    a, b = nodes.places[found.low], nodes.places[found.high]
    w0, w1 = nodes.values[found.low], nodes.values[found.high]
    fixed = nodes.fixed[found.low] & nodes.fixed[found.high]
    reach = np.linalg.norm(b - a, axis=1)
    start = a + (w0 / (w0 - w1))[:, None] * (b - a)
    points, on = curve.onto(start, reach, fixed)
    failed = np.flatnonzero(~on)
    if len(failed):
        slow, on[failed] = curve.between(a[failed], b[failed], fixed[failed])
        again, better = curve.onto(slow, 0.1 * reach[failed], fixed[failed])
        points[failed] = np.where(better[:, None], again, slow)
    spans = np.zeros(len(points))
    triangle = nodes.points[band.triangles[found.triangle]]
    wide = np.linalg.norm(triangle - np.roll(triangle, 1, axis=1), axis=2).max(axis=1, initial=0.0)
    for side in (0, 1):
        np.maximum.at(spans, found.pairs[:, side], wide)
    return points, found.pairs[on[found.pairs].all(axis=1)], spans


def _polylines(points: Floats, pairs: Ints, spans: Floats, dot: float) -> tuple[Traces, Bools, Floats]:
    """Polylines from segments, thinned, which of them (m,) are closed, and points (k,3) that closed curves without
    extent shrank to."""
    branches = concat(pairs)
    if not len(branches):
        return Traces(np.zeros((0, 3)), np.zeros(0, dtype=np.bool_)), branches.closed, np.zeros((0, 3))
    rounds = closed_round(branches)
    starts = rounds.offsets
    line = ragged.owner(np.diff(starts))
    lines = Traces.of(points[branches.points], rounds)
    own, width = lines.points, spans[branches.points[rounds.index]]
    gap = np.linalg.norm(np.diff(own, axis=0, prepend=own[:1]), axis=1)
    gap[starts[:-1]] = 0.0
    length = np.add.reduceat(gap, starts[:-1])
    step = np.floor(np.cumsum(gap / width) / THINNED)
    kept = np.diff(step, prepend=-1.0) > 0.0
    # The last point stays, and the one before it goes if it is too near.
    ends = starts[1:] - 1
    kept[starts[:-1]] = kept[ends] = True
    few = np.add.reduceat(kept, starts[:-1]) < 8
    kept |= few[line] & ((gap > 0.0) | (rounds.index == branches.offsets[line]))
    before = ends - 1
    kept[before] &= few | (gap[ends] > 0.5 * THINNED * width[ends])
    kept[starts[:-1]] = True
    real = length > dot
    kept &= real[line]
    return lines.take(kept), branches.closed[real], own[starts[:-1]][~real]


def _ended_on_lines(curve: CurveInSpace, own: ImplicitMesh, lines: Traces, closed: Bools) -> Traces:
    """The polylines, those that end beside singular lines of the surface with the end on it."""
    if not len(own.lines):
        return lines
    corners = own.mesh.vertices[own.mesh.corners.reshape(-1, 3)]
    longest = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())
    ends = np.concatenate([lines.starts[~closed], lines.ends[~closed]])
    points = lines.points.copy()
    points[ends] = own.lines.met(curve.condition, points[ends], NEXT_TO * BESIDE_LINE * longest)
    return Traces(points, lines.last)


def _lie_apart(points: Floats, others: Floats, distance: float) -> Ints:
    """Indices of the points (k,3) further than a distance from all others."""
    if not len(points) or not len(others):
        return np.arange(len(points))
    gaps = np.linalg.norm(points[:, None] - others[None], axis=2).min(axis=1)
    return np.flatnonzero(gaps > distance)


def curves_of_lines(
    lines: Traces, closed: Bools, *, level: float = 0.0, doubts: tuple[str, ...] = ()
) -> ImplicitCurves:
    """The curves of polylines, closed (m,) or open."""
    kept, offsets = lines.unrepeated(closed)
    none = np.zeros((0, 3))
    return ImplicitCurves(lines.points[kept], offsets, closed, np.full(len(closed), level), none, none, doubts)


# Contours, isophotes, intersections and plane sections.

DEFAULT = ImplicitTracing()


def implicit_contour(surface: ImplicitSurface, eye: ArrayLike, *, tracing: ImplicitTracing = DEFAULT) -> ImplicitCurves:
    """The points x of an implicit surface with N.(x - eye) = 0, N the unit gradient of F.

    eye: (3,) in world coordinates.
    Source: Glaeser, section 8.4, equations 25 to 27.
    """
    place = vector("contour: eye", eye)
    condition = ImplicitCentralContour(surface, place)
    return curves_in_space(surface, condition, size=condition.farthest, tracing=tracing)


def implicit_parallel_contour(
    surface: ImplicitSurface, direction: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The points of an implicit surface with N.d = 0, N the unit gradient of F: seen along d it turns away there.

    direction: (3,) d, of any length, towards the eye.
    Edge cases: as for `implicit_contour`.
    Source: Glaeser, section 8.4, equation 27 for an eye at infinity.
    """
    towards = vector("contour: direction", direction)
    return curves_in_space(surface, ImplicitIsophote(surface, towards), size=1.0, tracing=tracing)


def implicit_isophotes(
    surface: ImplicitSurface, light: ArrayLike, cosines: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves N.l = c of an implicit surface in parallel light, N the unit gradient of F, l the light.

    light: (3,) l, of any length, towards the light; cosines: (k,) c, -1 to 1.
    Edge cases: a flat part at just that angle gives no lines, and a doubt; c = 1 gives isolated points.
    Source: Glaeser, section 8.4, equation 28.
    """
    return _family(surface, lambda c: (ImplicitIsophote(surface, light, c), 1.0), levels_of(cosines), tracing)


def implicit_point_light_isophotes(
    surface: ImplicitSurface, light: ArrayLike, cosines: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves N.l = c of an implicit surface in the light of a point, l from the surface to the light.

    light: (3,) where the light stands, in world coordinates; cosines: (k,) c, -1 to 1.
    Edge cases: as for `implicit_isophotes`.
    Source: Glaeser, section 8.4, equation 28.
    """
    return _family(surface, lambda c: (ImplicitPointIsophote(surface, light, c), 1.0), levels_of(cosines), tracing)


def implicit_intersection(
    surface: ImplicitSurface, other: ImplicitSurface, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The curves in which two implicit surfaces meet, within the box of the first.

    Edge cases: surfaces that touch in a point give an isolated one; that coincide in an area, a doubt.
    Source: Glaeser, section 8.4, equation 29.
    """
    own, _ = mesh_of(surface, tracing)
    mesh, tracing = own.mesh, replace(tracing, mesh=own)
    if not mesh.face_count:
        return no_curves()
    long = np.linalg.norm(other.gradients(mesh.vertices), axis=1)
    slope = float(np.quantile(long[np.isfinite(long)], 0.95)) if np.isfinite(long).any() else 0.0
    size = slope * float(np.ptp(np.asarray(surface.box), axis=0).max())
    return curves_in_space(surface, other, size=size or 1.0, tracing=tracing)


def implicit_plane_sections(
    surface: ImplicitSurface, normal: ArrayLike, offsets: ArrayLike, *, tracing: ImplicitTracing = DEFAULT
) -> ImplicitCurves:
    """The sections of an implicit surface with the parallel planes n.x = d, n the unit normal.

    normal: (3,) of any length; offsets: (k,) d, in world units.
    Edge cases: as for `implicit_intersection`.
    Source: Glaeser, section 8.4, equation 29.
    """
    levels = np.atleast_1d(np.asarray(offsets, dtype=np.float64))
    if levels.ndim != 1 or not np.isfinite(levels).all():
        raise InputError("plane sections: offsets must be finite numbers")
    n = normalize(vector("plane sections: normal", normal))
    size = float(np.ptp(np.asarray(surface.box), axis=0).max())
    return _family(surface, lambda d: (MeetsPlane(n, d), size), levels, tracing)


def _family(
    surface: ImplicitSurface,
    condition: Callable[[float], tuple[SpatialCondition, float]],
    levels: Floats,
    tracing: ImplicitTracing,
) -> ImplicitCurves:
    """The curves of each level, on one mesh."""
    mesh, doubts = mesh_of(surface, tracing)
    tracing = replace(tracing, mesh=mesh)
    families = []
    for level in levels.tolist():
        one, size = condition(level)
        families.append(curves_in_space(surface, one, size=size, tracing=tracing, level=level))
    return all_curves([no_curves(doubts), *families])


def implicit_tangent_sections(
    surface: ImplicitSurface, normal: Floats, levels: Floats, *, tracing: ImplicitTracing
) -> ImplicitCurves:
    """The curves along which one of the planes n.x = d, n a unit normal, d of levels (k,), touches an implicit surface,
    with d as level: see tangent_sections."""
    found = implicit_parallel_contour(surface, direction_across(normal), tracing=tracing)
    alone = replace(found, isolated=found.isolated[:0], nodes=found.nodes[:0], doubts=())
    return in_planes(alone, normal, levels, ZERO_OF_EXTENT * float(np.ptp(np.asarray(surface.box), axis=0).max()))


def without_touching(surface: ImplicitSurface, normal: Floats, curves: ImplicitCurves) -> ImplicitCurves:
    """Sections by planes of a unit normal, those left out along which planes only touch the surface."""
    if not len(curves):
        return curves
    gradients = surface.gradients(curves.points)
    sines = norm(cross(gradients, normal)) > TOUCHING_SHEETS_SINE * norm(gradients)
    return take(curves, np.logical_or.reduceat(sines, curves.offsets[:-1]))


# Where implicit surfaces end: on the sides of their boxes, and at the rims of their holes.


def implicit_borders(surface: ImplicitSurface, *, tracing: ImplicitTracing) -> ImplicitCurves:
    """Where an implicit surface ends: its curves on the sides of its box and on planes that cut it, divided at the
    edges of these, and the rims of its holes. The surface is on the left, seen from where F > 0.

    Rims of holes, where F is not finite, are known to a cell of the lattice only, and a doubt says so.
    """
    own, _ = mesh_of(surface, tracing)
    mesh = own.mesh
    if not mesh.face_count:
        return no_curves()
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first[uses.count == 1]]
    a, b = mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]
    known = sides_of(surface)
    sides = known.on(mesh.vertices)
    # On singular lines sheets go on in each other, with vertices of their own.
    ends = ~(own.on_line[a] & own.on_line[b])
    a, b = a[ends], b[ends]
    common = sides[a] & sides[b]
    # A border does not run on through a singular line: there others hide it, or cease to.
    edges = np.stack([a, b], axis=1)
    on_line = own.on_line[edges]
    vertices = np.concatenate([mesh.vertices, mesh.vertices[edges[on_line]]])
    edges[on_line] = len(mesh.vertices) + np.arange(np.count_nonzero(on_line))
    a, b = edges.T
    families = [
        _border(surface, vertices, a, b, side, np.flatnonzero(common[:, side]), tracing)
        for side in range(common.shape[1])
    ]
    rims = np.flatnonzero(~common.any(axis=1))
    if len(rims):
        families.append(_rims(vertices, a[rims], b[rims]))
    return all_curves(families)


def _border(
    surface: ImplicitSurface, vertices: Floats, a: Ints, b: Ints, side: int, chosen: Ints, tracing: ImplicitTracing
) -> ImplicitCurves:
    """The borders on the two sides of the box across an axis, or on a plane that cuts, from the edges a, b (e,) that
    are chosen."""
    known = sides_of(surface)
    extent = float(np.ptp(known.box, axis=0).max())
    families = []
    for plane in known.planes(side):
        here = chosen[plane.holds(vertices[a[chosen]], known.nothing)]
        branches = concat(np.stack([a[here], b[here]], axis=1))
        if not len(branches):
            continue
        lines = Traces.of(vertices[branches.points], closed_round(branches))
        curve = curve_in_space(surface, MeetsPlane(plane.normal, plane.offset), extent)
        tolerance = CHORD_OF_EXTENT * extent if tracing.tolerance is None else tracing.tolerance
        most = tracing.budget.points
        finer = refined_chords(curve, lines, tolerance, tracing.picture, most)
        points = plane.put(finer.lines.points)
        texts = [
            (finer.unsure.any(), f"{finer.unsure.sum()} chords of a border could not be refined"),
            (not finer.enough.all(), unresolved("borders are off by more than the tolerance")),
        ]
        doubts = tuple(text for said, text in texts if said)
        families.append(curves_of_lines(Traces(points, finer.lines.last), branches.closed, doubts=doubts))
    return all_curves(families)


def _rims(vertices: Floats, a: Ints, b: Ints) -> ImplicitCurves:
    """The rims of holes, as they are in the mesh."""
    branches = concat(np.stack([a, b], axis=1))
    none, doubt = np.zeros((0, 3)), "the rim of a hole of an implicit surface is known to a cell only"
    return ImplicitCurves(
        vertices[branches.points], branches.offsets, branches.closed, np.zeros(len(branches)), none, none, (doubt,)
    )


# Singular lines of implicit surfaces as curves, as fine as is asked for.


def refined_line(equations: SingularEquations, lines: Polylines, tracing: ImplicitTracing) -> ImplicitCurves:
    """The lines on which equations hold, with points put in until chords stay within the tolerance of the tracing."""

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        way = end - start
        long = np.linalg.norm(way, axis=1)
        across = way / np.maximum(long, LEAST_DIVISOR)[:, None]
        return onto_lines(equations, start + part[:, None] * way, STRAYS * long, across=across)

    if not len(lines):
        return no_curves()
    tolerance = CHORD_OF_EXTENT * equations.extent if tracing.tolerance is None else tracing.tolerance
    start = Traces.of(lines.points, closed_round(lines))
    finer = refined(start, between, tracing.picture or (lambda points: points), tolerance, tracing.budget.points)
    short = () if finer.enough.all() else (unresolved("singular lines are off by more than the tolerance"),)
    return curves_of_lines(finer.lines, lines.closed, doubts=short)
