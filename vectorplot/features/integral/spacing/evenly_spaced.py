"""Integral curves of one field that cover a surface evenly, as if it were combed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.parameters import positive
from vectorplot.errors import InputError
from vectorplot.features.integral.charts import charts, check_parametrised
from vectorplot.features.integral.courses import Courses
from vectorplot.features.integral.flows import FieldFlow
from vectorplot.features.integral.integral_curves import DEFAULT, USUAL_LENGTH, courses_from, drawn
from vectorplot.features.integral.integration import Accuracy, Until
from vectorplot.features.integral.sites import Sites
from vectorplot.features.integral.spacing.crowd import Crowd, Ground, thinned
from vectorplot.features.integral.spacing.gaps import WIDEST, gaps_all_over
from vectorplot.features.integral.spacing.places_along import PlacesAlong, places_along, ways_both
from vectorplot.features.integral.spacing.uncrowded_lines import NEAREST, uncrowded
from vectorplot.features.integral.tangent_fields import TangentField, TurnedField
from vectorplot.features.parametric.curve_tracing import Tracing, extent
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves, together
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import from_components
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_extent import INTEGRATED_AS_DRAWN

DRAWN = Accuracy(INTEGRATED_AS_DRAWN)
"""How well curves are integrated that are only to be drawn."""

ACROSS = Accuracy(100.0 * INTEGRATED_AS_DRAWN)
"""How well those are that only say where others begin."""

SAMPLES = 4
"""Places along a curve for each distance, at which it is compared with others."""

PORTION = 1 << 16
"""So many of these places are in memory at a time."""

MOST_LINES = 500
"""Times the distance of curves that a surface may be large, at most."""

LONGEST_ACROSS = 4.0
"""Times the extent of the surface that lines at right angles to curves run to each side at most: round it once."""

ROUNDS = 8
"""How often gaps are filled."""


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
        For a shape without parameters, a distance that is not positive, or less than a five-hundredth of the extent of
        the surface.

    Notes
    -----
    The first curves begin along one at right angles to them, so that they are evenly apart there; then gaps are filled
    in the same way, the widest ones first. Distances are measured in space, between places of one sheet: the two sides
    of a thin shape, and the turns of a spiral one, do not keep each other's curves away. Which curves there are does
    not depend on tolerances and pictures.

    Source: Jobard and Lefer, Creating evenly-spaced streamlines of arbitrary density (1997), for what even means;
    Mebarki, Alliez and Devillers, Farthest point seeding for efficient placement of streamlines (2005), for gaps.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> curves = features.evenly_spaced_curves(surfaces.Cylinder(bottom=0, top=3), features.loxodromes(0.5), 0.5)
    >>> len(curves) > 5
    True
    """
    check_parametrised(surface)
    positive("evenly spaced curves: distance", apart)
    size = extent(surface)
    if size[0] == 0.0:
        return no_curves()
    if size[0] > MOST_LINES * apart:
        raise InputError(
            f"evenly spaced curves {apart:g} apart on a surface of {size[0]:g}: expected {size[0] / MOST_LINES:g} or "
            "more"
        )
    ground = Ground(surface, charts(surface), apart)
    flow = FieldFlow(surface, ground.charts, field)
    gaps, crowd = gaps_all_over(ground, field), Crowd(ground)
    found: list[SurfaceCurves] = []
    for _ in range(ROUNDS):
        widest = gaps.widest()
        if not len(widest):
            break
        seeds = _seeds(flow, gaps.places[widest], crowd, size)
        runs = _both_ways(flow, seeds, USUAL_LENGTH * size[0], size, accuracy, crowd, NEAREST)
        kept, crowd = _without_crowds(runs, seeds, crowd)
        found.append(drawn(kept, 2, size[0], tracing))
        gaps = gaps.left_by(crowd, widest)
    result = together([no_curves(), *found])
    return replace(result, levels=np.zeros(len(result)))


def _both_ways(
    flow: FieldFlow,
    starts: Floats,
    longest: float,
    size: tuple[float, float],
    accuracy: Accuracy,
    crowd: Crowd,
    reach: float,
) -> Courses:
    """The courses from u and v (k,2) along the field and against it, until they are within a part, reach, of the
    distance from what is taken, or surely from themselves."""
    tangents = flow.field.tangents(Sites(flow.surface, *flow.charts.inside(starts)))[0]

    def beside(places: Floats) -> Bools:
        return crowd.near(places, crowd.ground.where(places), reach * crowd.ground.apart)

    until = Until(beside if crowd.groups else None, crowd.ground.apart)
    return courses_from(flow, starts, tangents, longest, 2, size, accuracy, until)


def _seeds(flow: FieldFlow, gaps: Floats, crowd: Crowd, size: tuple[float, float]) -> Floats:
    """u and v (k,2) of places where curves begin: in the gaps, evenly across the field, the distance apart."""
    ground = crowd.ground
    apart = ground.apart
    across = FieldFlow(flow.surface, flow.charts, TurnedField(flow.field, 0.5 * np.pi))
    runs = _both_ways(across, gaps, LONGEST_ACROSS * size[0], size, ACROSS, crowd, WIDEST)
    curves = _that_run(runs)
    lines = places_along(runs, curves, apart / SAMPLES)
    free = ~crowd.near(lines.places, ground.where(lines.places), WIDEST * apart)
    along, sizes = _evenly(lines, *lines.reached(free), apart)
    own = np.repeat(curves, sizes)
    row = np.where((along < 0.0) | (runs.lengths[own] == 0.0), own + len(gaps), own)
    alone = np.setdiff1d(np.arange(len(gaps)), curves)
    places = np.concatenate([runs.places(*runs.at(row, np.abs(along))), gaps[alone]])
    # Those of the widest gap are all taken, those of others where they fit in between.
    order = np.lexsort((np.abs(np.concatenate([along, np.zeros(len(alone))])), np.concatenate([own, alone])))
    places = from_components(*flow.charts.within(places[order]))
    return places[thinned(ground, places, WIDEST * apart)]


def _that_run(runs: Courses) -> Ints:
    """(c,) the curves that have a course to either side."""
    return np.flatnonzero(runs.lengths.reshape(2, -1).max(axis=0) > 0.0)


def _evenly(lines: PlacesAlong, first: Ints, last: Ints, apart: float) -> tuple[Floats, Ints]:
    """Lengths (k,) along lines at which curves cross them evenly between a first and a last place (c,), and how many
    (c,) on each: as far from curves on both sides as from each other; from one side, by the distance, or else from
    where the line began."""
    some = last >= first
    low, high = (np.where(some, lines.along[place], 0.0) for place in (np.where(some, first, last), last))
    before, after = first > lines.offsets[:-1], last < lines.offsets[1:] - 1
    whole = np.isfinite(lines.around) & ~before & ~after
    # Curves to a side are about this far from the place beside them.
    margin = WIDEST * apart
    wide = high - low + 2.0 * margin
    rounds = np.maximum(np.rint(np.where(whole, lines.around, 0.0) / apart), 1.0)
    between = np.maximum(np.rint(wide / apart), 2.0)
    step = np.where(whole, np.where(whole, lines.around, 0.0) / rounds, np.where(before & after, wide / between, apart))
    start = np.where(before, low - margin + step, np.where(after, high + margin - step, 0.0))
    down = np.where(whole, -np.floor(0.5 * (rounds - 1.0)), np.ceil((low - start) / step))
    up = np.where(whole, down + rounds - 1.0, np.floor((high - start) / step))
    down = np.where(before, 0.0, down)
    up = np.where(before & after, between - 2.0, np.where(after, 0.0, up))
    sizes = np.where(some, np.maximum(up - down + 1.0, 1.0), 0.0).astype(np.intp)
    own = ragged.owner(sizes)
    along = start[own] + step[own] * (down[own] + ragged.place(sizes))
    return np.clip(along, low[own], high[own]), sizes


def _without_crowds(runs: Courses, places: Floats, crowd: Crowd) -> tuple[Courses, Crowd]:
    """The curves from u and v (k,2), one after the other, as far as they are not too near what is taken, to those
    before, and to themselves; and what is taken with them."""
    ground = crowd.ground
    there, back = ways_both(runs)
    left = _that_run(runs)
    spans = [np.zeros((0, 3))]
    while len(left):
        # As many as have few enough places, of those that do not begin beside what is taken by now.
        seeds = places[left]
        left = left[~crowd.near(seeds, ground.where(seeds), WIDEST * ground.apart)]
        count = SAMPLES * np.cumsum((there + back)[left]) / ground.apart
        own, left = np.split(left, [max(1, int(np.searchsorted(count, PORTION)))])
        found, crowd = uncrowded(places_along(runs, own, ground.apart / SAMPLES), crowd)
        found[:, 0] = own[found[:, 0].astype(np.intp)]
        spans.append(found)
    line, first, last = np.concatenate(spans).T
    line = line.astype(np.intp)
    whole = runs.closed[line] & (last - first >= runs.lengths[line])
    lengths = np.concatenate([np.where(whole, runs.lengths[line], last), np.where(whole, 0.0, -first)])
    return runs.some(np.concatenate([line, line + len(there)])).up_to(lengths), crowd
