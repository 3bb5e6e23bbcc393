"""Regions stippled: dots that lie closer where it is darker, and nowhere else than they have to."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.fills_without_overlaps import in_space
from vectorplot.drawing.hatching.hatching_frames import PageFrame
from vectorplot.drawing.hatching.scan import scanned
from vectorplot.drawing.hatching.toned_regions import TonedRegions
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.chunks import workers
from vectorplot.scene.hatching import Stippling
from vectorplot.words import LineKind

PLACES = 12
"""So many places of the page belong to a dot where it is darkest, and more elsewhere."""

WHITE = 0.02
"""What is no darker has no dots: one alone would be a speck, and no shade."""

ROUNDS = 12
"""So often dots move to the middles of their cells: from then on they move by hundredths of their distances."""

DOT_MM = 0.02
"""Dots are strokes of this length: a pen makes a round dot of one, and programs that drop empty strokes keep it."""

FINEST_MM = 0.02
"""Places are no closer: dots are not, either."""

BITS = 16
"""Digits of places along the curve that goes through all of them."""


def stippled(regions: TonedRegions, stippling: Stippling, page_from_world: Floats) -> Paths:
    """As many dots as a stippling asks for, in regions, so dense as these are dark.

    Dots begin at equal shares of the darkness along a curve that fills the page, and move to the middles of the
    darkness that is nearer to each than to the others, again and again.
    Degenerate: where all is white there are none; and no more than there are places FINEST_MM apart.
    Source: Lloyd, Least squares quantization in PCM (1982); Secord, Weighted Voronoi stippling (2002).
    """
    from scipy.spatial import cKDTree

    if not len(regions):
        return Paths.empty()
    pitch = _pitch(regions, stippling)
    places, region, weight = _places(regions, stippling, pitch)
    if not len(places):
        return Paths.empty()
    order = np.argsort(_along_curve(places), kind="stable")
    places, region, weight = places[order], region[order], weight[order]
    total = np.cumsum(weight)
    count = min(stippling.dots, len(places))
    start = np.searchsorted(total, (np.arange(count) + 0.5) / count * total[-1])
    dots = places[np.unique(np.minimum(start, len(places) - 1))]
    for _ in range(ROUNDS):
        nearest = cKDTree(dots).query(places, workers=workers(len(places)))[1]
        mass = np.bincount(nearest, weight, len(dots))
        middle = np.stack([np.bincount(nearest, weight * places[:, k], len(dots)) for k in (0, 1)], axis=1)
        dots = np.where(mass[:, None] > 0.0, middle / np.where(mass > 0.0, mass, 1.0)[:, None], dots)
    # The middle of a cell may lie beside a region that is not convex: then the nearest place of it does.
    distance, near = cKDTree(places).query(dots, workers=workers(len(dots)))
    dots = np.where((distance <= pitch)[:, None], dots, places[near])
    return _dots(regions, dots, region[near], page_from_world)


def _pitch(regions: TonedRegions, stippling: Stippling) -> float:
    """How far places have to be apart, so that PLACES of them in the darkest regions belong to a dot."""
    after = ragged.following(regions.offsets)
    x, y = regions.points
    signed = np.add.reduceat(x * y[after] - x[after] * y, regions.offsets[:-1]) / 2.0
    # Of the rings of a region the first one is around it, and the others are its holes.
    outer = np.append(True, regions.of[1:] != regions.of[:-1])
    area = np.where(outer, np.abs(signed), -np.abs(signed))
    dark = (regions.lowest + regions.highest) / 2.0
    ink = float(area.sum() if stippling.by == "even" else matmul(area, dark[regions.of]))
    return max(float(np.sqrt(max(ink, 0.0) / (PLACES * stippling.dots))), FINEST_MM)


def _places(regions: TonedRegions, stippling: Stippling, pitch: float) -> tuple[Floats, Ints, Floats]:
    """(n,2) places of a grid on the page that lie in regions (n,) and are not white, and (n,) how dark it is there."""
    page = PageFrame(0.0)
    parts = scanned(*page.coordinates(regions), regions.offsets, regions.of, np.full(len(regions), pitch))
    first = np.ceil(parts.low / pitch - 0.5).astype(np.intp)
    sizes = np.maximum(np.ceil(parts.high / pitch - 0.5).astype(np.intp) - first, 0)
    of = ragged.owner(sizes)
    places = np.asarray((np.stack([ragged.ranges(first, sizes), parts.line[of]], axis=1) + 0.5) * pitch)
    region = parts.region[of]
    weight = np.ones(len(places)) if stippling.by == "even" else regions.darkness_at(places, region)
    dark = np.flatnonzero(weight >= WHITE)
    return places[dark], region[dark], weight[dark]


def _along_curve(places: Floats) -> Ints:
    """(n,) how far along Hilbert's curve places (n,2) are.

    Source: Hilbert, Ueber die stetige Abbildung einer Linie auf ein Flaechenstueck (1891).
    """
    low, high = places.min(axis=0), places.max(axis=0)
    size = max(float((high - low).max()), FINEST_MM)
    x, y = np.minimum((places - low) / size * (1 << BITS), (1 << BITS) - 1).astype(np.int64).T
    result = np.zeros(len(places), dtype=np.int64)
    for bit in range(BITS - 1, -1, -1):
        right, top = (x >> bit) & 1, (y >> bit) & 1
        result = 4 * result + (3 * right ^ top)
        turned = (top == 0) & (right == 1)
        x, y = np.where(turned, (1 << BITS) - 1 - x, x), np.where(turned, (1 << BITS) - 1 - y, y)
        x, y = np.where(top == 0, y, x), np.where(top == 0, x, y)
    return result


def _dots(regions: TonedRegions, dots: Floats, region: Ints, page_from_world: Floats) -> Paths:
    """Dots as short strokes."""
    count = len(dots)
    ends = np.repeat(dots, 2, axis=0)
    ends[0::2, 0] -= DOT_MM / 2.0
    ends[1::2, 0] += DOT_MM / 2.0
    none = np.zeros(count, dtype=np.intp)
    space = in_space(regions.fills, ends, np.repeat(regions.source[region], 2), page_from_world)
    kind = np.full(count, int(LineKind.HATCH))
    open_ = np.zeros(count, dtype=np.bool_)
    return Paths(ends, 2 * np.arange(count + 1), open_, kind, regions.item[region], none, space)
