"""Curves f(u, v) = 0 on a rectangle of parameters, traced whole: branches, nodes, double points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.zeros.grid_triangulation import triangulate_surface
from vectorplot.features.zeros.scalar_field import (
    Function,
    Functions,
    Gradient,
    Gradients,
    ScalarFields,
    grid_points,
    grid_values,
    in_units,
    number,
    scalar_fields,
)
from vectorplot.features.zeros.tangles import without_tangles
from vectorplot.features.zeros.zero_cells import (
    Lattice,
    Subdivision,
    beside,
    flat_cells,
    near_cells,
    subdivided,
)
from vectorplot.features.zeros.zero_nodes import (
    double_points,
    in_crowds,
    joined_at_nodes,
    within,
    without_points_near,
)
from vectorplot.features.zeros.zero_refinement import (
    Positions,
    of_lines,
    refined_on_curve,
    up_to_holes,
    without_repeats,
)
from vectorplot.features.zeros.zero_segments import Segments, crossing_segments
from vectorplot.features.zeros.zero_triangles import triangles_near
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL, Budget, unresolved
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.outline import concat
from vectorplot.geometry.polylines import APART, DOUBTS, EACH_LINE, EACH_POINT, closed_round
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances.of_numbers import LARGEST
from vectorplot.tolerances.of_parameters import ABOVE_WHOLE, ON_BORDER_OF_DOMAIN, RESOLUTION, ROUNDING_OF_DOMAIN
from vectorplot.tolerances.of_values import GRID_NOISE, NODE_OF_VALUES, ZERO_RESIDUAL

JUMPS = "f changes its sign without being zero"
"""How the doubt about poles and jumps of f begins."""

FAR_APART = 32.0
"""Smallest cells beyond which what looks like a part of one line belongs to another."""

PLACES = 40
"""Places beside the grid at which the size of f is looked at too."""


@dataclass(frozen=True, eq=False)
class ZeroManifold:
    """The curve f(u, v) = 0 over a domain, with all its branches.

    Parameters
    ----------
    domain : Domain
        Where f is defined.
    points : (p, 2) array of float
        Parameters u, v. Along a branch they run on over seams, beyond the domain.
    offsets : (b+1,) array of int
        Branch i has the points offsets[i] to offsets[i+1].
    closed : (b,) array of bool
        The last point of the branch joins the first, which is not repeated.
    turns : (b, 2) array of int
        The periods that a closed branch has run through when it is back at its start.
    nodes : (n, 2) array of float
        Where branches meet; a branch goes straight on through each.
    isolated : (i, 2) array of float
        Single points where f is zero but does not change its sign.
    touching : (t, 2) array of float
        Places of a line along which f is zero without changing sign, or between two branches nearer to each other than
        the resolution.
    doubts : tuple of str
        A sentence for each thing that could not be decided.
    grid : (columns+1, rows+1, 3) array of float
        u, v and f.

    Notes
    -----
    f is positive on the left of a branch (from node to node of it).

    Source: Glaeser, section 8.4, figures 11 and 12; errata G8-08 to G8-14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> square = surfaces.Domain(-2, 2, -2, 2)
    >>> cross = features.zero_manifold_of_f_uv(lambda u, v: u * v, square, columns=7, rows=7)
    >>> len(cross), cross.closed.tolist(), len(cross.nodes)
    (2, [False, False], 1)
    """

    domain: Domain
    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    turns: Ints = field(metadata=EACH_LINE)
    nodes: Floats = field(metadata=APART)
    isolated: Floats = field(metadata=APART)
    touching: Floats = field(metadata=APART)
    doubts: tuple[str, ...] = field(metadata=DOUBTS)
    grid: Floats

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, branch: int) -> Floats:
        """(k,2) the points of a branch; a closed one ends with its first point, moved by its turns."""
        own = self.points[self.offsets[branch] : self.offsets[branch + 1]]
        if not self.closed[branch]:
            return own
        return np.concatenate([own, own[:1] + self.turns[branch] * np.array(self.domain.size)])

    @cached_property
    def triangulation(self) -> tuple[Ints, Floats]:
        """The optimised triangles of the graph w = f(u, v) over the grid, and its average normals."""
        return triangulate_surface(self.grid, closed_u=self.domain.closed_u, closed_v=self.domain.closed_v)


def zero_manifold_of_f_uv(
    f: Function,
    domain: Domain,
    *,
    columns: int,
    rows: int,
    gradient: Gradient | None = None,
    resolution: float = RESOLUTION,
    positions: Function | None = None,
    tolerance: float | None = None,
    budget: Budget = USUAL,
) -> ZeroManifold:
    """The curve f(u, v) = 0 over a domain, all its branches, each point refined on f to 1e-12 of the scale of f.

    Parameters
    ----------
    f : callable
        Takes arrays u, v (k,) and returns (k,) values; in closed directions it is periodic.
    domain : Domain
        Where f is defined.
    columns, rows : int
        Cells of the grid on which it is looked at first.
    gradient : callable, optional
        Takes arrays u, v (k,) and returns the two derivatives (k,) by u and by v; by differences where None.
    resolution : float
        The part of the domain down to which cells are subdivided where values and slopes leave open more than a single
        arc.
    positions : callable, optional
        Takes arrays u, v (k,) to where the tolerance is measured, (k, 2) or (k, 3), for example millimetres on a page;
        without it in u and v themselves. Where positions jump from one point to the next the curve is interrupted.
    tolerance : float, optional
        Points are put in until chords stay within this distance of the curve; none where None.
    budget : Budget
        How much work it may be.

    Returns
    -------
    ZeroManifold
        Branches, nodes, isolated points, and doubts.

    Raises
    ------
    InputError
        For fewer than two columns or rows, three in a closed direction, and a resolution that is not positive.

    Notes
    -----
    The scale of f is what nineteen in twenty values on the grid do not exceed. A closed branch that is larger than the
    resolution is found if the grid feels it, that is if slopes of the size met at the corners of a cell could reach
    zero inside it.

    Degenerate: f of one sign gives no branch; a change of sign through a pole or a jump is none either; where f is not
    finite there is a hole, and branches end at its border; zeros at grid points count as positive, which gives one
    polyline for a curve along grid lines; a border all along which f is zero is a pole of the surface, not a curve.

    Source: Glaeser, section 8.4, figures 11 and 12; errata G8-08 to G8-14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> square = surfaces.Domain(-2, 2, -2, 2)
    >>> circle = features.zero_manifold_of_f_uv(lambda u, v: u**2 + v**2 - 1, square, columns=8, rows=8, tolerance=0.01)
    >>> circle.closed.tolist(), bool(np.allclose(np.linalg.norm(circle.points, axis=1), 1.0))
    ([True], True)
    """
    (found,) = zero_manifolds(
        lambda u, v, of: f(u, v),
        [domain],
        columns=columns,
        rows=rows,
        gradient=None if gradient is None else lambda u, v, of: gradient(u, v),
        resolution=resolution,
        positions=None if positions is None else lambda u, v, of: positions(u, v),
        tolerances=None if tolerance is None else [tolerance],
        budget=budget,
    )
    return found


def zero_manifolds(
    f: Functions,
    domains: Sequence[Domain],
    *,
    columns: int,
    rows: int,
    gradient: Gradients | None = None,
    resolution: float = RESOLUTION,
    positions: Positions | None = None,
    tolerances: Sequence[float] | None = None,
    budget: Budget = USUAL,
) -> list[ZeroManifold]:
    """The curves f(u, v) = 0 of many functions, each over a domain of its own, all traced at once.

    Parameters
    ----------
    f : callable
        Takes arrays u, v (k,) and the numbers (k,) of the functions that are asked for, and returns (k,) values.
    domains : sequence of Domain
        Where the functions are defined, at least one; all closed in the same directions.
    columns, rows : int
        Cells of the grid on which each is looked at first.
    gradient, positions : callable, optional
        As of `zero_manifold_of_f_uv`, with the numbers (k,) as their third argument.
    tolerances : sequence of float, optional
        As the tolerance of `zero_manifold_of_f_uv`, one for each function.
    resolution, budget
        As of `zero_manifold_of_f_uv`, for each function.

    Returns
    -------
    list of ZeroManifold
        One for each function, the same as if it were traced alone.

    Raises
    ------
    InputError
        As `zero_manifold_of_f_uv`.

    Notes
    -----
    Numpy takes as long for one point as for a hundred: tracing a hundred curves at once takes a fraction of the time
    that it takes one by one. Memory follows the number of cells of all grids together.

    Source: as of `zero_manifold_of_f_uv`.
    """
    for domain in domains:
        check_grid(domain, columns, rows, resolution)
    field, w = grid_values(scalar_fields(f, domains, gradient), columns, rows)
    scale = _scales(field, w)
    unit = _units(scale)
    field, w, scale = in_units(field, unit), w / unit[:, None, None], scale / unit
    zero = _zeros(field, scale)
    w[np.abs(w) <= GRID_NOISE * scale[:, None, None]] = 0.0
    near, odd = near_cells(w, field.closed)
    lattice = Lattice(field, columns, rows, _levels(columns, rows, resolution))
    flat = flat_cells(lattice, w, GRID_NOISE * scale)
    # Along the border of an area where f is zero slopes say nothing.
    subdivision = subdivided(lattice, odd & ~beside(flat, field.closed), GRID_NOISE * scale, budget.cells)
    traced = crossing_segments(lattice, triangles_near(subdivision, w, near), scale, zero)
    subdivision, traced, tangled = without_tangles(subdivision, traced)
    found = _found(subdivision, traced, scale)
    holes: Bools = np.asarray(np.isnan(w).any(axis=(1, 2)))
    lines = found.lines if not holes.any() else _to_holes(field, found.lines, holes, lattice.cell(), zero)
    unsure, enough = np.zeros(len(field), dtype=np.intp), np.ones(len(field), dtype=np.bool_)
    if tolerances is not None:
        measure = positions or (lambda u, v, of: np.stack([u, v], axis=-1))
        limits = np.array(tolerances, dtype=np.float64)
        lines, unsure, enough = refined_on_curve(field, lines, measure, limits, zero, budget.points)
    doubts = [
        _doubts(*faults)
        for faults in zip(
            flat.sum(axis=(1, 2)).tolist(),
            found.counts(len(field)).tolist(),
            subdivision.complete.tolist(),
            unsure.tolist(),
            enough.tolist(),
            tangled.tolist(),
            strict=True,
        )
    ]
    grid = grid_points(field, columns, rows)
    grid[..., 2] = unit[:, None, None] * w
    return _results(field, domains, lines, found, doubts, grid)


@dataclass(frozen=True, eq=False)
class _Found:
    """The curves before their chords are looked at: polylines, those of one function after those of another; the double
    points of ZeroManifold; and as points (k,3), the changes of sign that are no zeros, closed branches that are smaller
    than a cell, and the places that touch where two branches cannot be told apart."""

    lines: Traces
    nodes: Floats
    isolated: Floats
    touching: Floats
    poles: Ints
    missed: Floats
    beads: Floats

    def counts(self, count: int) -> Ints:
        """(count, 4) of each function: the changes of sign, the small branches, these places, and all that touch."""
        sorts = (self.missed, self.beads, self.touching)
        each = (np.bincount(number(points), minlength=count) for points in sorts)
        return np.stack([self.poles, *each], axis=1)


def _found(subdivision: Subdivision, traced: Segments, scale: Floats) -> _Found:
    """The segments joined to polylines, through the double points among the odd cells."""
    lattice, odd = subdivision.lattice, subdivision.odd
    field, cell = lattice.field, lattice.cell()
    u, v = (field.start[odd.of, axis] + (at + 0.5) * cell[odd.of, axis] for axis, at in enumerate((odd.i, odd.j)))
    zero = np.maximum(NODE_OF_VALUES * scale, _zeros(field, scale))
    doubles = double_points(field, np.stack([u, v, odd.of], axis=1), cell, zero, GRID_NOISE * scale)
    line = doubles.flat & in_crowds(number(doubles.points), doubles.flat)
    single, touching = doubles.points[~line], doubles.points[line]
    own = cell[number(single)]
    joined = joined_at_nodes(field, traced.points, traced.pairs, single, doubles.radii[~line, None] * own)
    lines, dots = without_repeats(_polylines(field, joined.points, joined.segments), field.size)
    lines, beads = _without_beads(field, lines, cell, touching)
    # A point beside a curve, or one of a line that goes over into a curve, is not alone; what went round it and shrank
    # to it does not count.
    apart = np.where(doubles.flat[~line], FAR_APART, 3.0)[:, None] * own
    near, point = within(field, traced.points, single, apart)
    alone = joined.meets == 0
    alone[near[joined.around[point] != near]] = False

    def free(centres: Floats, points: Floats, cells: float) -> Floats:
        return centres[without_points_near(field, centres, points, cells * cell[number(centres)])]

    dots = field.wrapped(free(dots, doubles.points, 2.0))
    dotted = in_crowds(number(dots), np.ones(len(dots), dtype=np.bool_))
    return _Found(
        lines,
        single[joined.meets > 0],
        np.concatenate([single[alone], dots[~dotted]]),
        np.concatenate([free(touching, lines.points, 1.5), dots[dotted], beads]),
        traced.poles,
        free(doubles.ovals, traced.points, 2.0),
        beads,
    )


def _without_beads(field: ScalarFields, lines: Traces, cell: Floats, touching: Floats) -> tuple[Traces, Floats]:
    """The polylines without the closed ones that are thinner than a cell (s,2) and stand in a row, or have no area
    where many are that thin or f touches zero in many places touching (t,3); and the middles (k,3) of these: they are
    what lattice points between two branches that cannot be told apart make of them."""
    first, last = lines.starts, lines.ends
    p, whose = lines.points, of_lines(lines)
    counted = np.concatenate([whose, number(touching)])
    many = in_crowds(counted, np.ones(len(counted), dtype=np.bool_))[: len(whose)]
    if not many.any():
        return lines, p[:0]
    path = ragged.owner(last - first + 1)
    q = (p - p[first[path]])[:, :2] / cell[whose[path]]
    step = np.diff(q, axis=0)
    inner = ~lines.last[:-1]
    turn = q[:-1, 0] * q[1:, 1] - q[1:, 0] * q[:-1, 1]
    area, length = (
        np.abs(np.bincount(path[:-1][inner], weights=x[inner], minlength=len(first)))
        for x in (0.5 * turn, np.sqrt((step * step).sum(axis=1)))
    )
    back = np.abs(p[last] - p[first])[:, :2] / field.size[whose]
    is_thin = (back <= ROUNDING_OF_DOMAIN).all(axis=1) & (2.0 * area < length) & (last - first > 1)
    thin = np.flatnonzero(is_thin & many)
    sums = [np.bincount(path, weights=x, minlength=len(first))[thin] for x in p.T[:2]]
    middles = np.stack([*(total / (last - first + 1)[thin] for total in sums), whose[thin]], axis=1)
    middles = field.wrapped(middles)
    near = within(field, middles, middles, FAR_APART * cell[whose[thin]])[0]
    crowded = (np.bincount(near, minlength=len(thin)) > 1) | (area[thin] < 1.0)
    counted = np.concatenate([whose[thin], number(touching)])
    marked = np.concatenate([crowded, np.ones(len(touching), dtype=np.bool_)])
    crowded &= in_crowds(counted, marked)[: len(thin)]
    gone = np.zeros(len(first), dtype=np.bool_)
    gone[thin[crowded]] = True
    return lines.some(~gone[path]), middles[crowded]


def check_grid(domain: Domain, columns: int, rows: int, resolution: float) -> None:
    """An InputError for fewer than two columns or rows, three in a closed direction, and a resolution not positive."""
    for count, closed, word in ((columns, domain.closed_u, "columns"), (rows, domain.closed_v, "rows")):
        if count < 2 + closed:
            raise InputError(f"{count} {word} of cells: expected {2 + closed} or more")
    if not 0.0 < resolution:
        raise InputError(f"resolution {resolution:g}: expected a positive part of the domain")


def _scales(field: ScalarFields, w: Floats) -> Floats:
    """(s,) the sizes that nineteen in twenty of the values do not exceed, or if that is zero the largest; and no less
    than half of some values beside the grid, all of whose points may be zeros of f.

    Poles hardly raise it, and large areas where f is zero do not make it the size of their rounding.
    """
    parts = np.stack([np.arange(1, PLACES + 1) * share % 1.0 for share in (0.7548776662, 0.5698402910)], axis=1)
    places = field.start[:, None] + parts * field.size[:, None]
    of = np.broadcast_to(np.arange(len(field))[:, None, None], (*places.shape[:2], 1))
    other = field.values(np.concatenate([places, of], axis=2).reshape(-1, 3)).reshape(len(field), -1)
    other, known = _ascending(np.abs(other))
    least = _picked(other, known // 2, known)
    size, known = _ascending(np.abs(w).reshape(len(field), -1))
    usual = np.maximum(_picked(size, (0.95 * (known - 1)).astype(np.intp), known), least)
    scale = np.where(usual > 0.0, usual, _picked(size, known - 1, known))
    return np.where(known > 0, scale, least)


def _ascending(values: Floats) -> tuple[Floats, Ints]:
    """(s,k) the values of each row in ascending order, NaN at its end, and how many of each row are numbers."""
    ordered = np.sort(values, axis=1)
    return ordered, np.asarray(np.isfinite(ordered).sum(axis=1))


def _picked(ordered: Floats, place: Ints, known: Ints) -> Floats:
    """(s,) the value at a place of each row; zero in a row without numbers."""
    found = np.take_along_axis(ordered, np.clip(place, 0, ordered.shape[1] - 1)[:, None], axis=1)[:, 0]
    return np.where(known > 0, found, 0.0)


def _units(scale: Floats) -> Floats:
    """(s,) the powers of two to measure f in, so that squares of values neither overflow nor vanish; mostly one."""
    usual = (scale == 0.0) | (1.0 / LARGEST < scale) & (scale < LARGEST)
    with np.errstate(divide="ignore"):
        power = np.clip(np.round(np.log2(scale)), -1000, 1000)
    return np.where(usual, 1.0, 2.0 ** np.where(usual, 0.0, power))


def _zeros(field: ScalarFields, scale: Floats) -> Floats:
    """(s,) the |f| that points are brought down to; more than ZERO_RESIDUAL where parameters are large and rounded."""
    rounding = np.spacing(np.abs(field.start) + field.size) / field.size
    return np.asarray(scale * np.maximum(ZERO_RESIDUAL, 64.0 * rounding.max(axis=1)))


def _levels(columns: int, rows: int, resolution: float) -> int:
    """How often a cell is halved until it is no larger than resolution."""
    return int(np.clip(np.ceil(np.log2(1.0 / (min(columns, rows) * resolution)) - ABOVE_WHOLE), 0, 20))


def _polylines(field: ScalarFields, points: Floats, segments: Ints) -> Traces:
    """The segments joined to polylines whose parameters run on over seams, those of one function after those of
    another; closed ones repeat their first point."""
    branches = concat(segments)
    rounds = closed_round(branches)
    along = points[branches.points[rounds.index]]
    order, offsets = ragged.take(rounds.offsets, np.argsort(number(along[rounds.offsets[:-1]]), kind="stable"))
    run_on = along[order]
    path = ragged.owner(np.diff(offsets))
    for axis in (0, 1):
        if field.closed[axis] and len(run_on):
            x, size = run_on[:, axis], field.size[number(run_on), axis]
            jump = np.concatenate([[0.0], -np.round(np.diff(x) / size[1:])])
            jump[offsets[:-1]] = 0.0
            turned = np.cumsum(jump)
            run_on[:, axis] = x + (turned - turned[offsets[path]]) * size
    last = np.zeros(len(run_on), dtype=np.bool_)
    last[offsets[1:] - 1] = True
    return Traces(run_on, last)


def _to_holes(field: ScalarFields, lines: Traces, holes: Bools, cell: Floats, zero: Floats) -> Traces:
    """The polylines with open ends inside the domain led on to the border of the hole there; holes (s,): which
    functions have any."""
    p = lines.points
    for side in (0, 1):
        starts, lasts = lines.starts, lines.ends
        closed = _is_closed(field, p[starts], p[lasts])
        end, before = (starts, starts + 1) if side == 0 else (lasts, lasts - 1)
        free = ~closed & ~_on_border(field, p[end]) & holes[of_lines(lines)]
        end, before = end[free], before[free]
        more, goes = up_to_holes(field, p[end], p[before], cell[number(p[end])], zero)
        at, more = end[goes], more[goes]
        if side == 0:
            p, last = np.insert(p, at, more, axis=0), np.insert(lines.last, at, False)
        else:
            p, last = np.insert(p, at + 1, more, axis=0), np.insert(lines.last, at, False)
        lines = Traces(p, last)
    return lines


def _on_border(field: ScalarFields, points: Floats) -> Bools:
    """(k,) points on an open border of the domain."""
    of = number(points)
    part = (points[:, :2] - field.start[of]) / field.size[of]
    return np.asarray(
        ((np.abs(part - 0.5) >= 0.5 - ON_BORDER_OF_DOMAIN) & ~np.array(field.closed)).any(axis=1), dtype=np.bool_
    )


def _is_closed(field: ScalarFields, first: Floats, last: Floats) -> Bools:
    """(b,) polylines that end where they start, whole periods aside."""
    turned = (last - first)[:, :2] / field.size[number(first)]
    return np.asarray(
        (np.abs(turned - np.where(field.closed, np.round(turned), 0.0)) <= ROUNDING_OF_DOMAIN).all(axis=1)
    )


def _results(
    field: ScalarFields,
    domains: Sequence[Domain],
    lines: Traces,
    found: _Found,
    doubts: Sequence[tuple[str, ...]],
    grid: Floats,
) -> list[ZeroManifold]:
    """The manifolds of these polylines; of closed ones the repeated point is dropped."""
    first, last = lines.starts, lines.ends
    ends, of = (lines.points[first], lines.points[last]), of_lines(lines)
    closed = _is_closed(field, *ends) & (last - first > 1)
    turned = np.round((ends[1] - ends[0])[:, :2] / field.size[of])
    turns = np.where(closed[:, None], turned, 0.0).astype(np.intp)
    kept, offsets = lines.unrepeated(closed)
    points = lines.points[kept, :2]
    bounds = np.searchsorted(of, np.arange(len(field) + 1))
    nodes, isolated, touching = (_of_each(sort, len(field)) for sort in (found.nodes, found.isolated, found.touching))
    return [
        ZeroManifold(
            domain,
            points[offsets[a] : offsets[b]],
            offsets[a : b + 1] - offsets[a],
            closed[a:b],
            turns[a:b],
            nodes[k],
            isolated[k],
            touching[k],
            doubts[k],
            grid[k],
        )
        for k, (domain, (a, b)) in enumerate(zip(domains, pairwise(bounds.tolist()), strict=True))
    ]


def _of_each(points: Floats, count: int) -> list[Floats]:
    """The parameters (k,2) among points (p,3) of each of so many functions."""
    of = number(points)
    order = np.argsort(of, kind="stable")
    return np.split(points[order, :2], np.searchsorted(of[order], np.arange(1, count)))


def _doubts(
    flat: int, found: Sequence[int], complete: bool, unsure: int, enough: bool, tangled: float
) -> tuple[str, ...]:
    """What could not be decided of one function, a sentence each; found: a row of the counts of what was found."""
    poles, missed, beads, touching = found
    line = touching - beads
    texts = [
        (flat > 0, f"f is zero all over {flat} cells: only the border towards negative values is a curve"),
        (poles > 0, f"{JUMPS} at {poles} places: poles or jumps, not part of the curve"),
        (
            tangled > 0.0,
            f"curves that wind more finely than the resolution are left out in {100.0 * tangled:.1g} % of the domain",
        ),
        (not complete, unresolved("branches of a curve are too small or too many")),
        (not enough, unresolved("curves are off by more than the tolerance")),
        (unsure > 0, f"{unsure} chords may be off by more than the tolerance: the curve was not found beside them"),
        (missed > 0, "closed branches smaller than the resolution are missing: ask for a finer one"),
        (
            beads > 0,
            f"branches nearer to each other than the resolution: {beads} places are given; ask for a finer one",
        ),
        (line > 0, f"f touches zero along a line without changing its sign: {line} places of it are given"),
    ]
    return tuple(text for said, text in texts if said)
