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
    in_units,
    number,
    scalar_fields,
    without_poles,
)
from vectorplot.features.zeros.sizes_of_values import sizes_of_zeros, units_of_values, usual_sizes
from vectorplot.features.zeros.tangles import without_tangles
from vectorplot.features.zeros.zero_branches import FoundBranches, ends_meet, found_branches, led_to_holes
from vectorplot.features.zeros.zero_cells import Lattice, beside, flat_cells, near_cells, subdivided
from vectorplot.features.zeros.zero_doubts import doubts_of_one
from vectorplot.features.zeros.zero_refinement import Positions, of_lines, refined_on_curve
from vectorplot.features.zeros.zero_segments import crossing_segments
from vectorplot.features.zeros.zero_triangles import triangles_near
from vectorplot.geometry.budget import USUAL, Budget
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.polylines import APART, DOUBTS, EACH_LINE, EACH_POINT
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances.of_parameters import ABOVE_WHOLE, RESOLUTION
from vectorplot.tolerances.of_values import GRID_NOISE


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
    values: Floats | None = None,
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
    values : (s, columns+1, rows+1) array of float, optional
        Those of f on the grids, where they are known already.
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
    field = scalar_fields(f, domains, gradient)
    field, w = without_poles(field, field.on_grid(columns, rows) if values is None else values)
    scale = usual_sizes(field, w)
    unit = units_of_values(scale)
    field, w, scale = in_units(field, unit), w / unit[:, None, None], scale / unit
    zero = sizes_of_zeros(field, scale)
    w[np.abs(w) <= GRID_NOISE * scale[:, None, None]] = 0.0
    near, odd = near_cells(w, field.closed)
    lattice = Lattice(field, columns, rows, _levels(columns, rows, resolution))
    flat = flat_cells(lattice, w, GRID_NOISE * scale)
    # Along the border of an area where f is zero slopes say nothing.
    subdivision = subdivided(lattice, odd & ~beside(flat, field.closed), GRID_NOISE * scale, budget.cells)
    traced = crossing_segments(lattice, triangles_near(subdivision, w, near), scale, zero)
    subdivision, traced, tangled = without_tangles(subdivision, traced)
    found = found_branches(subdivision, traced, scale)
    holes: Bools = np.asarray(np.isnan(w).any(axis=(1, 2)))
    lines = found.lines if not holes.any() else led_to_holes(field, found.lines, holes, lattice.cell(), zero)
    unsure, enough = np.zeros(len(field), dtype=np.intp), np.ones(len(field), dtype=np.bool_)
    if tolerances is not None:
        measure = positions or (lambda u, v, of: np.stack([u, v], axis=-1))
        limits = np.array(tolerances, dtype=np.float64)
        lines, unsure, enough = refined_on_curve(field, lines, measure, limits, zero, budget.points)
    doubts = [
        doubts_of_one(*faults)
        for faults in zip(
            flat.sum(axis=(1, 2)).tolist(),
            [flat[0].size] * len(field),
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


def check_grid(domain: Domain, columns: int, rows: int, resolution: float) -> None:
    """An InputError for fewer than two columns or rows, three in a closed direction, and a resolution not positive."""
    for count, closed, word in ((columns, domain.closed_u, "columns"), (rows, domain.closed_v, "rows")):
        if count < 2 + closed:
            raise InputError(f"{count} {word} of cells: expected {2 + closed} or more")
    if not 0.0 < resolution:
        raise InputError(f"resolution {resolution:g}: expected a positive part of the domain")


def _levels(columns: int, rows: int, resolution: float) -> int:
    """How often a cell is halved until it is no larger than resolution."""
    return int(np.clip(np.ceil(np.log2(1.0 / (min(columns, rows) * resolution)) - ABOVE_WHOLE), 0, 20))


def _results(
    field: ScalarFields,
    domains: Sequence[Domain],
    lines: Traces,
    found: FoundBranches,
    doubts: Sequence[tuple[str, ...]],
    grid: Floats,
) -> list[ZeroManifold]:
    """The manifolds of these polylines; of closed ones the repeated point is dropped."""
    first, last = lines.starts, lines.ends
    ends, of = (lines.points[first], lines.points[last]), of_lines(lines)
    closed = ends_meet(field, *ends) & (last - first > 1)
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
