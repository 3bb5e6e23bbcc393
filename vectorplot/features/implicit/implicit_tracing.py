"""Curves on implicit surfaces where a condition holds: found on a mesh, every point refined on both equations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.implicit.curve_band import Band, Nodes, curve_band
from vectorplot.features.implicit.implicit_conditions import SpatialCondition
from vectorplot.features.implicit.implicit_folds import without_folds
from vectorplot.features.implicit.implicit_mesh import ImplicitMesh, implicit_mesh, sheets_apart
from vectorplot.features.implicit.implicit_refinement import CurveInSpace, Picture, curve_in_space, refined_chords
from vectorplot.features.implicit.implicit_sides import sides_of
from vectorplot.features.implicit.polygonize import onto_surface
from vectorplot.features.implicit.singular.implicit_nodes import joined_at_nodes, special_points
from vectorplot.features.implicit.singular.implicit_singular_lines import SingularLines
from vectorplot.features.meshes.level_segments import level_segments
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL, Budget, unresolved
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.outline import concat
from vectorplot.geometry.polylines import APART, DOUBTS, EACH_LINE, EACH_POINT, NumberedLines, closed_round, joined
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances.of_extent import APART_OF_EXTENT, CHORD_OF_EXTENT, DOT_OF_EXTENT
from vectorplot.tolerances.of_lengths import BESIDE_LINE, WIDE_OF_AREA
from vectorplot.tolerances.of_numbers import ROUNDING_OF_TERMS
from vectorplot.tolerances.of_parameters import RESOLUTION
from vectorplot.tolerances.of_values import FLAT_OF_VALUES

NEXT_TO = 4.0
"""So many times as far from a singular line as sheets are looked at a curve may end that goes on to it."""

THINNED = 0.3
"""Part of the width of triangles that crossings on their sides may follow one another in: nearer ones add nothing."""


@dataclass(frozen=True, eq=False)
class ImplicitTracing:
    """How curves on an implicit surface are traced.

    Parameters
    ----------
    cells : int
        Along the longest side of the box, of the lattice on which the surface is polygonised.
    mesh : ImplicitMesh, optional
        The surface polygonised already (see `implicit_mesh`), for several families of curves.
    resolution : float
        The part of the box down to which triangles are cut where the curve is not clear; closed curves smaller than
        that may be missed.
    tolerance : float, optional
        Points are put in until chords stay within this distance of the true curve; a thousandth of the extent of the
        surface where None.
    picture : callable, optional
        Takes points (k, 3) to where the tolerance is measured, (k, 2) or (k, 3), for example millimetres on a page;
        without it in space.
    budget : Budget
        How much work it may be.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> ball = surfaces.implicit_sphere(1.0)
    >>> rough = features.implicit_contour(ball, (4, 0, 0), tracing=features.ImplicitTracing(cells=12, tolerance=0.1))
    >>> fine = features.implicit_contour(ball, (4, 0, 0), tracing=features.ImplicitTracing(cells=12, tolerance=1e-4))
    >>> len(rough.points) < len(fine.points)
    True
    """

    cells: int = 48
    mesh: ImplicitMesh | None = None
    resolution: float = RESOLUTION
    tolerance: float | None = None
    picture: Picture | None = None
    budget: Budget = USUAL


@dataclass(frozen=True, eq=False)
class ImplicitCurves(NumberedLines):
    """Polylines on an implicit surface.

    Parameters
    ----------
    points : (n, 3) array of float
        In world coordinates.
    offsets : (m+1,) array of int
        Curve i has the points offsets[i] to offsets[i+1].
    closed : (m,) array of bool
        The last point joins the first, which is not repeated.
    levels : (m,) array of float
        The level a curve of a family belongs to; otherwise 0.
    isolated : (i, 3) array of float
        Single points that satisfy the condition.
    nodes : (k, 3) array of float
        Where curves cross.
    doubts : tuple of str
        A sentence for each thing that could not be decided.

    Notes
    -----
    Seen from where F > 0 the condition is positive on the left.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> tracing = features.ImplicitTracing(cells=12)
    >>> curves = features.implicit_level_lines(surfaces.implicit_sphere(1.0), [0.0, 0.5], tracing=tracing)
    >>> isinstance(curves, features.ImplicitCurves), len(curves), curves.doubts
    (True, 2, ())
    >>> bool((curves[1][0] == curves[1][-1]).all())  # a closed curve, led back to its first point
    True
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
    isolated = np.concatenate([special.isolated, dots[_apart(dots, special.isolated, APART_OF_EXTENT * extent)]])
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
    return lines.some(kept), branches.closed[real], own[starts[:-1]][~real]


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


def _apart(points: Floats, others: Floats, distance: float) -> Ints:
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
