"""Painted pictures looked at in single points of the page."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import Fills


def fills_of(drawing: Drawing) -> Fills:
    """All fills of a drawing, back to front."""
    return Fills.joined(*(mark for layer in drawing.layers for mark in layer.marks if isinstance(mark, Fills)))


def pixel_places(drawing: Drawing, columns: int, rows: int) -> Floats:
    """(rows * columns, 2) the middles of the pixels of the page in mm, row by row from the top."""
    row, column = np.divmod(np.arange(rows * columns), columns)
    x, y = (column + 0.5) * drawing.width_mm / columns, drawing.height_mm - (row + 0.5) * drawing.height_mm / rows
    return np.stack([x, y], axis=1)


def covering(fills: Fills, places: Floats) -> tuple[Ints, Ints]:
    """All pairs of a place (n,2) and a polygon that covers it: (k,) and (k,), back to front at each place."""
    import shapely

    sizes = np.diff(fills.offsets)
    kept = np.flatnonzero(sizes >= 3)
    some = fills.take(kept)
    rings = shapely.linearrings(some.points, indices=np.repeat(np.arange(len(kept)), np.diff(some.offsets)))
    place, polygon = shapely.STRtree(shapely.polygons(rings)).query(shapely.points(places), predicate="within")
    order = np.lexsort((polygon, place))
    return place[order], kept[polygon[order]]


def last_at(place: Ints, polygon: Ints, count: int, wanted: Bools | None = None) -> Ints:
    """(count,) the last polygon (of the wanted ones) that covers each place, -1 for none."""
    chosen = slice(None) if wanted is None else wanted[polygon]
    found = np.full(count, -1, dtype=np.intp)
    np.maximum.at(found, place[chosen], polygon[chosen])
    return found


def top_at(fills: Fills, places: Floats, wanted: Bools | None = None) -> Ints:
    """(n,) the last polygon (of the wanted ones) that covers each place (n,2), -1 for none."""
    return last_at(*covering(fills, places), len(places), wanted)


def colours_at(fills: Fills, polygon: Ints, places: Floats) -> Floats:
    """(n,3) the colours of polygons (n,) at places (n,2) in them: linear over each triangle of the fan."""
    first, sizes = fills.offsets[polygon], np.diff(fills.offsets)[polygon]
    best, colours = np.full(len(polygon), -np.inf), np.zeros((len(polygon), 3))
    for k in range(1, int(sizes.max(initial=2)) - 1):
        corner = np.stack([first, *(first + np.minimum(j, sizes - 1) for j in (k, k + 1))])
        a, b, c = (fills.points[row] for row in corner)
        area = _turn(b - a, c - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            weights = np.stack([_turn(b - places, c - places), _turn(c - places, a - places)]) / area
            weights = np.concatenate([weights, 1.0 - weights.sum(axis=0, keepdims=True)])
        inside = np.where(np.isfinite(weights).all(axis=0), weights.min(axis=0), -np.inf)
        better = inside > best
        best = np.where(better, inside, best)
        mixed = np.einsum(
            "kn,knc->nc", np.where(np.isfinite(weights), weights, 0.0), fills.colours[corner].astype(np.float64)
        )
        colours = np.where(better[:, None], mixed, colours)
    return colours


def blended(fills: Fills, places: Floats, paper: float = 255.0) -> Floats:
    """(n,3) what is seen at places of the page: all that covers them, one over the other."""
    place, polygon = covering(fills, places)
    colours = colours_at(fills, polygon, places[place])
    turn = np.arange(len(place)) - np.searchsorted(place, place)
    seen = np.full((len(places), 3), paper)
    for k in range(int(turn.max(initial=-1)) + 1):
        here = turn == k
        share = fills.opacity[polygon[here]][:, None]
        seen[place[here]] += share * (colours[here] - seen[place[here]])
    return seen


def _turn(one: Floats, two: Floats) -> Floats:
    return np.asarray(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])


def assert_same_picture(one: Drawing, two: Drawing, levels: float = 1.5, apart: int = 2) -> None:
    """Nothing, where two pages show the same in random places but for a few beside edges, which rounding moves."""
    assert (one.width_mm, one.height_mm) == (two.width_mm, two.height_mm)
    places = np.random.default_rng(0).random((4000, 2)) * (one.width_mm, one.height_mm)
    seen = [blended(fills_of(drawing), places) for drawing in (one, two)]
    different = np.abs(seen[0] - seen[1]).max(axis=1) > levels
    assert different.sum() <= apart, f"{different.sum()} places of {len(places)} differ, as {places[different][:3]}"
    assert (seen[0] < 250.0).any(axis=1).mean() > 0.02, "the pages show something"
