"""Curves f(u, v) = 0 on a rectangle of parameters, traced whole: branches, nodes, double points."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.zeros.grid_triangulation import triangulate_surface
from vectorplot.features.zeros.scalar_field import (
    Function,
    Gradient,
    ScalarField,
    grid_points,
    grid_values,
    in_units,
    scalar_field,
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
from vectorplot.features.zeros.zero_nodes import MOST_ALONE, double_points, joined_at_nodes, within, without_points_near
from vectorplot.features.zeros.zero_refinement import (
    Positions,
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
    positions: Positions | None = None,
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
    check_grid(domain, columns, rows, resolution)
    field, w = grid_values(scalar_field(f, domain, gradient), columns, rows)
    scale = _scale(field, w)
    unit = _unit(scale)
    field, w, scale = in_units(field, unit), w / unit, scale / unit
    zero = _zero(field, scale)
    w[np.abs(w) <= GRID_NOISE * scale] = 0.0
    near, odd = near_cells(w, field.closed)
    lattice = Lattice(field, columns, rows, _levels(columns, rows, resolution))
    flat = flat_cells(lattice, w, GRID_NOISE * scale)
    # Along the border of an area where f is zero slopes say nothing.
    subdivision = subdivided(lattice, odd & ~beside(flat, field.closed), GRID_NOISE * scale, budget.cells)
    traced = crossing_segments(lattice, triangles_near(subdivision, w, near), scale, zero)
    subdivision, traced, tangled = without_tangles(subdivision, traced)
    found = _found(subdivision, traced, scale)
    lines, unsure, enough = found.lines, 0, True
    if np.isnan(w).any():
        lines = _to_holes(field, lines, _smallest_cell(lattice), zero)
    if tolerance is not None:
        measure = positions or (lambda u, v: np.stack([u, v], axis=-1))
        finer = refined_on_curve(field, lines, measure, tolerance, zero, budget.points)
        lines, unsure, enough = finer.lines, finer.unsure, finer.enough
    doubts = _doubts(int(flat.sum()), found, subdivision.complete, unsure, enough, tangled)
    return _result(
        field, lines, found, doubts, np.concatenate([grid_points(field, columns, rows), unit * w[..., None]], axis=2)
    )


@dataclass(frozen=True, eq=False)
class _Found:
    """The curve before its chords are looked at: polylines, the double points of ZeroManifold, and how many changes of
    sign are no zeros, how many closed branches are smaller than a cell, and at how many of the places that touch two
    branches cannot be told apart."""

    lines: Traces
    nodes: Floats
    isolated: Floats
    touching: Floats
    poles: int
    missed: int
    beads: int


def _found(subdivision: Subdivision, traced: Segments, scale: float) -> _Found:
    """The segments joined to polylines, through the double points among the odd cells."""
    lattice, odd = subdivision.lattice, subdivision.odd
    field, cell = lattice.field, _smallest_cell(subdivision.lattice)
    middles = field.start + (np.stack([odd.i, odd.j], axis=1) + 0.5) * cell
    doubles = double_points(field, middles, cell, max(NODE_OF_VALUES * scale, _zero(field, scale)), GRID_NOISE * scale)
    line = doubles.flat & (doubles.flat.sum() > MOST_ALONE)
    single, reach = doubles.points[~line], doubles.radii[~line, None] * cell
    joined = joined_at_nodes(field, traced.points, traced.pairs, single, reach)
    lines, dots = without_repeats(_polylines(field, joined.points, joined.segments), field.size)
    lines, beads = _without_beads(field, lines, cell)
    # A point beside a curve, or one of a line that goes over into a curve, is not alone; what went round it and shrank
    # to it does not count.
    apart = np.where(doubles.flat[~line], FAR_APART, 3.0)[:, None] * cell
    near, point = within(field, traced.points, single, apart)
    alone = joined.meets == 0
    alone[near[joined.around[point] != near]] = False
    touching = doubles.points[line]
    touching = touching[without_points_near(field, touching, traced.points, 1.5 * cell)]
    return _Found(
        lines,
        single[joined.meets > 0],
        np.concatenate([single[alone], field.wrapped(dots[without_points_near(field, dots, single, 2.0 * cell)])]),
        np.concatenate([touching, beads]),
        traced.poles,
        int(without_points_near(field, doubles.ovals, traced.points, 2.0 * cell).sum()),
        len(beads),
    )


def _without_beads(field: ScalarField, lines: Traces, cell: Floats) -> tuple[Traces, Floats]:
    """The polylines without the closed ones that are thinner than a cell and stand in a row, and the middles (k,2) of
    these: they are what lattice points between two branches that cannot be told apart make of them."""
    first, last = lines.starts, lines.ends
    p = lines.points
    if len(first) <= MOST_ALONE:
        return lines, p[:0]
    path = ragged.owner(last - first + 1)
    q = (p - p[first[path]]) / cell
    step = np.diff(q, axis=0)
    inner = ~lines.last[:-1]
    turn = q[:-1, 0] * q[1:, 1] - q[1:, 0] * q[:-1, 1]
    area, length = (
        np.bincount(path[:-1][inner], weights=x[inner], minlength=len(first))
        for x in (0.5 * turn, np.sqrt((step * step).sum(axis=1)))
    )
    back = np.abs(p[last] - p[first]) / field.size
    thin = np.flatnonzero((back <= ROUNDING_OF_DOMAIN).all(axis=1) & (2.0 * np.abs(area) < length) & (last - first > 1))
    sums = [np.bincount(path, weights=x, minlength=len(first))[thin] for x in p.T]
    middles = field.wrapped(np.stack(sums, axis=1) / (last - first + 1)[thin, None])
    reach = np.broadcast_to(FAR_APART * cell, middles.shape)
    crowded = np.bincount(within(field, middles, middles, reach)[0], minlength=len(thin)) > 1
    if crowded.sum() <= MOST_ALONE:
        return lines, middles[:0]
    gone = np.zeros(len(first), dtype=np.bool_)
    gone[thin[crowded]] = True
    kept = ~gone[path]
    return lines.some(kept), middles[crowded]


def _smallest_cell(lattice: Lattice) -> Floats:
    """(2,) the size of the cells of the last level."""
    return np.asarray(lattice.field.size / (lattice.columns << lattice.levels, lattice.rows << lattice.levels))


def check_grid(domain: Domain, columns: int, rows: int, resolution: float) -> None:
    """An InputError for fewer than two columns or rows, three in a closed direction, and a resolution not positive."""
    for count, closed, word in ((columns, domain.closed_u, "columns"), (rows, domain.closed_v, "rows")):
        if count < 2 + closed:
            raise InputError(f"{count} {word} of cells: expected {2 + closed} or more")
    if not 0.0 < resolution:
        raise InputError(f"resolution {resolution:g}: expected a positive part of the domain")


def _scale(field: ScalarField, w: Floats) -> float:
    """The size that nineteen in twenty of the values do not exceed, or if that is zero the largest; and no less than
    half of some values beside the grid, all of whose points may be zeros of f.

    Poles hardly raise it, and large areas where f is zero do not make it the size of their rounding.
    """
    places = np.stack([np.arange(1, PLACES + 1) * share % 1.0 for share in (0.7548776662, 0.5698402910)], axis=1)
    other = np.abs(field.values(field.start + places * field.size))
    other = other[np.isfinite(other)]
    least = float(np.sort(other)[len(other) // 2]) if len(other) else 0.0
    size = np.abs(w[np.isfinite(w)])
    if not len(size):
        return least
    place = int(0.95 * (len(size) - 1))
    return max(float(np.partition(size, place)[place]), least) or float(size.max())


def _unit(scale: float) -> float:
    """The power of two to measure f in, so that squares of values neither overflow nor vanish; mostly one."""
    return (
        1.0
        if scale == 0.0 or 1.0 / LARGEST < scale < LARGEST
        else float(2.0 ** np.clip(np.round(np.log2(scale)), -1000, 1000))
    )


def _zero(field: ScalarField, scale: float) -> float:
    """The |f| that points are brought down to; more than ZERO_RESIDUAL where parameters are large and rounded."""
    rounding = np.spacing(np.abs(field.start) + field.size) / field.size
    return scale * max(ZERO_RESIDUAL, 64.0 * float(rounding.max()))


def _levels(columns: int, rows: int, resolution: float) -> int:
    """How often a cell is halved until it is no larger than resolution."""
    return int(np.clip(np.ceil(np.log2(1.0 / (min(columns, rows) * resolution)) - ABOVE_WHOLE), 0, 20))


def _polylines(field: ScalarField, points: Floats, segments: Ints) -> Traces:
    """The segments joined to polylines whose parameters run on over seams; closed ones repeat their first point."""
    branches = concat(segments)
    rounds = closed_round(branches)
    offsets = rounds.offsets
    path = ragged.owner(np.diff(offsets))
    lines = Traces.of(points[branches.points], rounds)
    run_on = lines.points.copy()
    for axis in (0, 1):
        if field.closed[axis] and len(run_on):
            x = run_on[:, axis]
            jump = np.concatenate([[0.0], -np.round(np.diff(x) / field.size[axis])])
            jump[offsets[:-1]] = 0.0
            turned = np.cumsum(jump)
            run_on[:, axis] = x + (turned - turned[offsets[path]]) * field.size[axis]
    return Traces(run_on, lines.last)


def _to_holes(field: ScalarField, lines: Traces, cell: Floats, zero: float) -> Traces:
    """The polylines with open ends inside the domain led on to the border of the hole there."""
    p = lines.points
    for side in (0, 1):
        starts, lasts = lines.starts, lines.ends
        closed = _is_closed(field, p[starts], p[lasts])
        end, before = (starts, starts + 1) if side == 0 else (lasts, lasts - 1)
        free = ~closed & ~_on_border(field, p[end])
        end, before = end[free], before[free]
        more, goes = up_to_holes(field, p[end], p[before], cell, zero)
        at, more = end[goes], more[goes]
        if side == 0:
            p, last = np.insert(p, at, more, axis=0), np.insert(lines.last, at, False)
        else:
            p, last = np.insert(p, at + 1, more, axis=0), np.insert(lines.last, at, False)
        lines = Traces(p, last)
    return lines


def _on_border(field: ScalarField, points: Floats) -> Bools:
    """(k,) points on an open border of the domain."""
    part = (points - field.start) / field.size
    return np.asarray(
        ((np.abs(part - 0.5) >= 0.5 - ON_BORDER_OF_DOMAIN) & ~np.array(field.closed)).any(axis=1), dtype=np.bool_
    )


def _is_closed(field: ScalarField, first: Floats, last: Floats) -> Bools:
    """(b,) polylines that end where they start, whole periods aside."""
    turned = (last - first) / field.size
    return np.asarray(
        (np.abs(turned - np.where(field.closed, np.round(turned), 0.0)) <= ROUNDING_OF_DOMAIN).all(axis=1)
    )


def _result(field: ScalarField, lines: Traces, found: _Found, doubts: tuple[str, ...], grid: Floats) -> ZeroManifold:
    """The manifold of these polylines; of closed ones the repeated point is dropped."""
    first, last = lines.starts, lines.ends
    ends = lines.points[first], lines.points[last]
    closed = _is_closed(field, *ends) & (last - first > 1)
    turns = np.where(closed[:, None], np.round((ends[1] - ends[0]) / field.size), 0.0).astype(np.intp)
    kept, offsets = lines.unrepeated(closed)
    return ZeroManifold(
        field.domain,
        lines.points[kept],
        offsets,
        closed,
        turns,
        found.nodes,
        found.isolated,
        found.touching,
        doubts,
        grid,
    )


def _doubts(flat: int, found: _Found, complete: bool, unsure: int, enough: bool, tangled: float) -> tuple[str, ...]:
    """What could not be decided, a sentence each."""
    poles, line = found.poles, len(found.touching) - found.beads
    texts = [
        (flat > 0, f"f is zero all over {flat} cells: only the border towards negative values is a curve"),
        (poles > 0, f"{JUMPS} at {poles} places: poles or jumps, not part of the curve"),
        (
            tangled > 0.0,
            f"curves that wind more finely than the resolution are left out in {100.0 * tangled:.1g} % of the domain",
        ),
        (not complete, unresolved("branches of a curve are too small or too many")),
        (not enough, unresolved("curves are off by more than the tolerance")),
        (unsure > 0, f"{unsure} segments could not be refined: the curve was not found beside their chords"),
        (found.missed > 0, "closed branches smaller than the resolution are missing: ask for a finer one"),
        (
            found.beads > 0,
            f"branches nearer to each other than the resolution: {found.beads} places are given; ask for a finer one",
        ),
        (line > 0, f"f touches zero along a line without changing its sign: {line} places of it are given"),
    ]
    return tuple(text for said, text in texts if said)
