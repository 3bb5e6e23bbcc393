"""Integral curves of one field that cover a surface evenly, as if it were combed."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.parameters import positive
from vectorplot.errors import InputError
from vectorplot.features.integral.charts import charts
from vectorplot.features.integral.integral_curves import DEFAULT, integral_curves
from vectorplot.features.integral.integration import Accuracy
from vectorplot.features.integral.sites import Sites
from vectorplot.features.integral.tangent_fields import TangentField, TurnedField
from vectorplot.features.parametric.curve_tracing import Tracing, extent
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves, together
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import closed_round, some
from vectorplot.geometry.vectors import norm
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_extent import INTEGRATED_AS_DRAWN

DRAWN = Accuracy(INTEGRATED_AS_DRAWN)
"""How well curves are integrated that are only to be drawn."""

ACROSS = Accuracy(100.0 * INTEGRATED_AS_DRAWN)
"""How well those are that only say where others begin."""

LONGEST = 3.0
"""Times the extent of the surface that a curve runs to each side, at most."""

NEAREST = 0.5
"""Part of the distance of curves at which one ends beside another."""

WIDEST = 0.9
"""Part of the distance of curves from which on a place is away from all of them."""

SHORTEST = 1.5
"""Times their distance that curves are long, at least."""

SAMPLES = 4
"""Places along a curve for each distance, at which it is compared with others."""

MOST_SAMPLES = 16
"""And so many at most, however near each other its points are."""

MOST_LINES = 500
"""Times the distance of curves that a surface may be large, at most."""

GRID = 160
"""Places along u, and along v, at which gaps are looked for, at most."""

GAPS = 24
"""Gaps that are filled at a time."""

ROUNDS = 4
"""How often gaps are filled."""


@dataclass(frozen=True, eq=False)
class _Placed:
    """Curves, u and v (n,2) of their points, closed ones led round, with offsets (m+1,); and the places (p,) along them
    at which they are compared: curve (p,); along (p,), lengths from the start of the curve; node (p,), which point, and
    after the point what part of the way to the next; where (p,6), in space, with the normals, so that the two sides of
    a thin shape are far apart. seed (m,): the place nearest to where each curve began; long (m,): how long it is."""

    curves: SurfaceCurves
    nodes: Floats
    offsets: Ints
    curve: Ints
    along: Floats
    node: Floats
    where: Floats
    seed: Ints
    long: Floats


def evenly_spaced_curves(
    surface: Surface,
    field: TangentField,
    apart: float,
    *,
    accuracy: Accuracy = DRAWN,
    tracing: Tracing = DEFAULT,
) -> SurfaceCurves:
    """Integral curves of a field that cover a surface evenly.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    field : TangentField
        What they follow.
    apart : float
        About how far neighbours are from each other, in world units: half of it at least, where they run together; and
        mostly less than twice, where they run apart, as gaps are filled a few times only.
    accuracy : Accuracy
        How well they are integrated.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        Polylines. A curve ends where it comes too near to another one, or to itself.

    Raises
    ------
    InputError
        For a distance that is not positive, or less than a five-hundredth of the extent of the surface.

    Notes
    -----
    The first curves begin along one at right angles to them, so that they are evenly apart there; then gaps are filled
    in the same way, the widest ones first. Distances are measured in space; those of the
    two sides of a thin shape count as large.

    Source: Jobard and Lefer, Creating evenly-spaced streamlines of arbitrary density (1997), for what even means;
    Mebarki, Alliez and Devillers, Farthest point seeding for efficient placement of streamlines (2005), for gaps.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> curves = features.evenly_spaced_curves(surfaces.Cylinder(bottom=0, top=3), features.loxodromes(0.5), 0.5)
    >>> len(curves) > 5
    True
    """
    positive("evenly spaced curves: distance", apart)
    size = extent(surface)[0]
    if size == 0.0:
        return no_curves()
    if size > MOST_LINES * apart:
        raise InputError(
            f"evenly spaced curves {apart:g} apart on a surface of {size:g}: expected {size / MOST_LINES:g} or more"
        )
    places, where = _over(surface, field, apart)
    taken = np.zeros((0, 6))
    found: list[SurfaceCurves] = []
    for _ in range(ROUNDS):
        gaps = _gaps(where, taken, apart)
        if not len(gaps):
            break
        seeds, spots = _seeds(surface, field, places[gaps], apart, size, taken)
        new = _compared(
            surface, integral_curves(surface, field, seeds, accuracy=accuracy, tracing=tracing), spots, apart
        )
        kept, own = _without_crowds(surface, new, taken, apart)
        # A gap that nothing fits into is one no more.
        taken = np.concatenate([taken, own, where[gaps]])
        found.append(kept)
    result = together([no_curves(), *found])
    return replace(result, levels=np.zeros(len(result)))


def _sixfold(surface: Surface, places: Floats, apart: float) -> Floats:
    """(k,6) points, and normals of the length of the distance."""
    sites = Sites(surface, *charts(surface).inside(places).T)
    return np.concatenate([sites.points, apart * np.nan_to_num(sites.normals)], axis=1)


def _over(surface: Surface, field: TangentField, apart: float) -> tuple[Floats, Floats]:
    """Places (k,2) all over a surface where the field has a direction, and where (k,6) they are."""
    domain = surface.domain
    u, v = domain.grid(16, 16)
    points = surface.points(*np.meshgrid(u, v, indexing="ij"))
    with np.errstate(invalid="ignore"):
        across = np.nanmax(np.nan_to_num(norm(np.diff(points, axis=0)).sum(axis=0)))
        along = np.nanmax(np.nan_to_num(norm(np.diff(points, axis=1)).sum(axis=1)))
    columns, rows = (int(np.clip(2.0 * long / apart, 8, GRID)) for long in (across, along))
    u, v = domain.grid(columns, rows)
    places = np.stack(np.meshgrid(0.5 * (u[1:] + u[:-1]), 0.5 * (v[1:] + v[:-1]), indexing="ij"), axis=-1).reshape(
        -1, 2
    )
    known = np.isfinite(field.tangents(Sites(surface, *places.T))[0]).all(axis=1)
    return places[known], _sixfold(surface, places[known], apart)


def _gaps(where: Floats, taken: Floats, apart: float) -> Ints:
    """Which of the places are away from all that is taken, and from one another, the farthest ones first."""
    from scipy.spatial import cKDTree

    if not len(where):
        return np.zeros(0, dtype=np.intp)
    if not len(taken):
        middle = np.median(where, axis=0)
        return np.array([np.argmin(norm(where[:, :3] - middle[:3]))])
    away = cKDTree(taken).query(where)[0]
    left = np.flatnonzero(away > WIDEST * apart)
    left = left[np.argsort(-away[left], kind="stable")]
    chosen: list[int] = []
    while len(left) and len(chosen) < GAPS:
        chosen.append(int(left[0]))
        left = left[norm(where[left] - where[left[0]]) > 4.0 * apart]
    return np.array(chosen, dtype=np.intp)


def _seeds(
    surface: Surface, field: TangentField, gaps: Floats, apart: float, size: float, taken: Floats
) -> tuple[Floats, Floats]:
    """u and v (k,2) of places in the gaps, the distance apart across the field, and where (k,6) they are."""
    from scipy.spatial import cKDTree

    across = TurnedField(field, 0.5 * np.pi)
    lines = integral_curves(
        surface, across, gaps, length=size, accuracy=ACROSS, tracing=Tracing(tolerance=0.05 * apart)
    )
    if not len(lines):
        return gaps, _sixfold(surface, gaps, apart)
    own = gaps[lines.levels.astype(np.intp)]
    found = _compared(surface, lines, _sixfold(surface, own, apart), apart)
    signed = found.along - found.along[found.seed][found.curve]
    rounds = np.abs(np.rint(signed / apart))
    near = np.abs(np.abs(signed) - rounds * apart) <= 0.5 * apart / SAMPLES
    if len(taken):
        # Only in the gap itself: from its middle to the first place that is taken.
        free = cKDTree(taken).query(found.where)[0] > WIDEST * apart
        first, last = _reached(found, free)
        at = np.arange(len(free))
        near &= (at >= first[found.curve]) & (at <= last[found.curve])
    keys = np.stack([found.curve, np.rint(signed / apart)], axis=1)[near]
    _, first = np.unique(keys, axis=0, return_index=True)
    at = np.flatnonzero(near)[np.sort(first)]
    order = np.argsort(rounds[at], kind="stable")
    at = at[order]
    return _at(found.nodes, found.node[at]), found.where[at]


def _compared(surface: Surface, curves: SurfaceCurves, spots: Floats, apart: float) -> _Placed:
    """The curves with places along them; spots: where (k,6) the starts are that their levels number."""
    rounds = closed_round(curves)
    nodes = np.stack([curves.u, curves.v], axis=1)[rounds.index]
    nodes[rounds.again] += curves.turns[curves.closed] * np.array(surface.domain.size)
    points = curves.points[rounds.index]
    if not len(points):
        none = np.zeros(0)
        empty = np.zeros(0, dtype=np.intp)
        return _Placed(curves, nodes, rounds.offsets, empty, none, none, np.zeros((0, 6)), empty, none)
    ends = rounds.offsets[1:] - 1
    begins = np.delete(np.arange(len(points)), ends)
    steps = norm(points[begins + 1] - points[begins])
    rise = np.zeros(len(points))
    rise[begins + 1] = steps
    total = np.cumsum(rise)
    counts = np.diff(rounds.offsets)
    total -= np.repeat(total[rounds.offsets[:-1]], counts)
    # Between two points of a curve as many places as its chord is long; and the ends of open curves.
    cell = np.floor(total * MOST_SAMPLES / apart)
    fresh = cell[begins + 1] != cell[begins]
    fresh[np.searchsorted(begins, rounds.offsets[:-1])] = True
    count = np.maximum(np.ceil(steps * SAMPLES / apart), fresh).astype(np.intp)
    node = np.concatenate(
        [np.repeat(begins, count) + ragged.place(count) / np.repeat(count, count), ends[~curves.closed]]
    )
    node.sort()
    along = np.interp(node, np.arange(len(points)), total)
    owner = ragged.owner(counts)[np.floor(node).astype(np.intp)]
    where = _sixfold(surface, _at(nodes, node), apart)
    away = norm(where - spots[curves.levels.astype(np.intp)][owner])
    nearest = np.lexsort((away, owner))
    seed = nearest[np.searchsorted(owner, np.arange(len(curves)))]
    return _Placed(curves, nodes, rounds.offsets, owner, along, node, where, seed, total[ends])


def _at(nodes: Floats, node: Floats) -> Floats:
    """(k,2) u and v on the way from one of the points (n,2) of curves to the next one."""
    low = np.floor(node).astype(np.intp)
    high = np.minimum(low + 1, len(nodes) - 1)
    part = (node - low)[:, None]
    return np.where(part > 0.0, nodes[low] + part * (nodes[high] - nodes[low]), nodes[low])


def _reached(found: _Placed, free: Bools) -> tuple[Ints, Ints]:
    """The first and the last (m,) of the places of each curve that are reached from its seed over free ones only: of a
    closed curve, which begins at its seed, up to the end, and from the end on; none where the seed is not free."""
    count = len(found.seed)
    bounds = np.searchsorted(found.curve, np.arange(count + 1))
    taken = np.concatenate([[-1], np.flatnonzero(~free), [len(free)]])
    after = np.searchsorted(taken, found.seed, side="left")
    last = np.minimum(taken[after] - 1, bounds[1:] - 1)
    first = np.maximum(taken[after - 1] + 1, bounds[:-1])
    return first, np.where(free[found.seed], last, first - 1)


def _without_crowds(surface: Surface, found: _Placed, taken: Floats, apart: float) -> tuple[SurfaceCurves, Floats]:
    """The curves, one after the other, as far as they are not too near what is taken, to those before, and to
    themselves; and where (k,6) they are."""
    from scipy.spatial import cKDTree

    if not len(found.curve):
        return found.curves, np.zeros((0, 6))
    free = np.ones(len(found.curve), dtype=np.bool_)
    fresh = np.ones(len(found.seed), dtype=np.bool_)
    if len(taken):
        away = cKDTree(taken).query(found.where)[0]
        free = away > NEAREST * apart
    pairs = cKDTree(found.where).query_pairs(WIDEST * apart, output_type="ndarray")
    one, two = np.concatenate([pairs, pairs[:, ::-1]]).T
    near = norm(found.where[one] - found.where[two])
    free &= ~_beside_itself(found, one, two, near, apart)
    by_curve = np.argsort(found.curve[one], kind="stable")
    one, two, near = one[by_curve], two[by_curve], near[by_curve]
    begin = np.searchsorted(found.curve[one], np.arange(len(found.seed) + 1))
    spans = []
    for line in range(len(found.seed)):
        first, last = (int(x[line]) for x in _reached(found, free)) if fresh[line] else (0, -1)
        if last < first or found.along[last] - found.along[first] < SHORTEST * apart:
            continue
        spans.append((line, first, last))
        own = slice(begin[line], begin[line + 1])
        inside = (one[own] >= first) & (one[own] <= last) & (found.curve[two[own]] != line)
        others, far = two[own][inside], near[own][inside]
        free[others[far <= NEAREST * apart]] = False
        seeds = np.zeros(len(free), dtype=np.bool_)
        seeds[found.seed] = True
        fresh[found.curve[others[seeds[others]]]] = False
    if not spans:
        return no_curves(), np.zeros((0, 6))
    parts = np.array(spans)
    return _cut(surface, found, *parts.T), found.where[ragged.ranges(parts[:, 1], parts[:, 2] - parts[:, 1] + 1)]


def _beside_itself(found: _Placed, one: Ints, two: Ints, near: Floats, apart: float) -> Bools:
    """(p,) the places where a curve is too near to what it has been through before."""
    same = (found.curve[one] == found.curve[two]) & (near <= NEAREST * apart)
    one, two = one[same], two[same]
    way = np.abs(found.along[one] - found.along[two])
    closed = found.curves.closed[found.curve[one]]
    way = np.where(closed, np.minimum(way, found.long[found.curve[one]] - way), way)
    from_seed = np.abs(found.along - found.along[found.seed][found.curve])
    later = (way > 2.0 * apart) & (from_seed[one] >= from_seed[two])
    result = np.zeros(len(found.curve), dtype=np.bool_)
    result[one[later]] = True
    return result


def _cut(surface: Surface, found: _Placed, line: Ints, first: Ints, last: Ints) -> SurfaceCurves:
    """Parts of curves, from one place to another; whole curves as they are."""
    curves = found.curves
    bounds = np.searchsorted(found.curve, np.arange(len(found.seed) + 1))
    whole = (first == bounds[line]) & (last == bounds[line + 1] - 1)
    kept = some(curves, line[whole])
    line, first, last = line[~whole], first[~whole], last[~whole]
    if not len(line):
        return kept
    low, high = found.node[first], found.node[last]
    inner = np.floor(low).astype(np.intp) + 1
    sizes = np.maximum(np.ceil(high).astype(np.intp) - inner, 0)
    node = np.concatenate([low, ragged.ranges(inner, sizes).astype(np.float64), high])
    owner = np.concatenate([np.arange(len(line)), ragged.owner(sizes), np.arange(len(line))])
    order = np.lexsort((node, owner))
    places = _at(found.nodes, node[order])
    points = surface.points(*np.ascontiguousarray(charts(surface).within(places).T))
    u, v = np.ascontiguousarray(places.T)
    none = np.zeros((0, 2))
    open_ = np.zeros(len(line), dtype=np.bool_)
    turns = np.zeros((len(line), 2), dtype=np.intp)
    cut = SurfaceCurves(
        u, v, points, ragged.offsets(sizes + 2), open_, turns, curves.levels[line], none, none, none, ()
    )
    return together([kept, cut])
