"""Bands of equal shade on quadric bodies and on nets of facets: regions between isophotes, as polygons on the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import PAIRS_AT_ONCE, overlapping_boxes
from vectorplot.geometry.budget import mapped, slices
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, take
from vectorplot.geometry.records import APART, IN_COLUMNS
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.placement import Placement
from vectorplot.scene.view import View
from vectorplot.shading.facet_resolution import PARTS, SHADE_ERROR, shade_error
from vectorplot.shading.illumination import finish_of, homogeneous_light, shadow_shades, towards
from vectorplot.shading.palettes import COLOUR_MAP
from vectorplot.shading.shaded_faces import Shades, item_colours, point_shades, view_eye
from vectorplot.tolerances import FACET_CORNER_MM, LEAST_DIVISOR, ROUNDING
from vectorplot.visibility.quadrics.visible_parts import CAP, MANTLE, Charts

# How bright places on charts are, and where what is seen of these, or is in the light, ends.

POINTS_AT_ONCE = 1 << 15
"""Places looked at at once: few enough for the processor's cache."""

Margin = Callable[[Ints, Floats], Floats]
"""(m,) how far points (3,m) of charts (m,) are inside of something, negative outside: no farther than they are."""


class Places(Protocol):
    """Places on some charts, given by numbers that are linear along the sides of meshes on them."""

    def at(self, chart: Ints, *place: Floats) -> tuple[Floats, Floats]:
        """Points of the view and unit normals (3,m) at places (d,m) of charts (m,)."""


@dataclass(frozen=True, eq=False)
class FacetPlaces:
    """Places on facets of surfaces: a point of the view, and the normal of the surface there, of any length."""

    def at(self, chart: Ints, *place: Floats) -> tuple[Floats, Floats]:
        """As of Places."""
        normals = np.stack(place[3:])
        return np.stack(place[:3]), normals / np.maximum(np.sqrt(dot(normals, normals)), LEAST_DIVISOR)


ROUNDED_MM = 0.01
"""Corners are written in these units: less than half of it is not seen, and more would double the files."""


@dataclass(frozen=True, eq=False)
class ShadedPlaces:
    """Places on charts, the items (n,) that these show, and how bright they are: view, items and lights as in
    point_shades; steps (n,): how many bands a palette has on each chart; loose_mm (n,): how far isophotes may be off on
    the page."""

    charts: Places
    item: Ints
    view: View
    items: Sequence[Item]
    lights: Sequence[Light]
    placement: Placement
    steps: Floats
    loose_mm: Floats
    rounded_mm: ClassVar[float] = FACET_CORNER_MM

    def __len__(self) -> int:
        return len(self.item)

    def on_page(self, points: Floats) -> Floats:
        """(2,m) in mm."""
        return np.asarray(self.placement.on_page(self.view.image_of(points)).T)

    def shares(self, chart: Ints, points: Floats, normals: Floats) -> Shades:
        """What the lights give to points of charts."""
        return point_shades(self.view, self.items, self.lights, points.T, normals.T, self.item[chart])

    def levels(self, chart: Ints, place: Floats, lacking: Ints) -> Floats:
        """(m,) the shades of places (d,m) that lack lights (m,), as of shadow_shades, in bands."""

        def shade(some: slice) -> Floats:
            found = self.shares(chart[some], *self.charts.at(chart[some], *place[:, some]))
            if not lacking[some].any():
                return found.total
            dark = ((lacking[some][None] >> np.arange(len(found.shares))[:, None]) & 1).astype(np.bool_)
            shares = np.where(dark, found.matt, found.shares)
            return shadow_shades(shares, found.intensity, lacking[some], found.cue)

        return _in_slices(shade, len(chart)) * self.steps[chart]

    def cosines(self, number: int) -> Callable[[Ints, Floats], Floats]:
        """(m,) at places those of the angles between the normals and the way to a light."""
        source = homogeneous_light(self.lights[number])

        def cosine(chart: Ints, place: Floats) -> Floats:
            points, normals = self.charts.at(chart, *place)
            return dot(normals, towards(points.T, source).T)

        return cosine

    def margins(self, margin: Margin) -> Callable[[Ints, Floats], Floats]:
        """(m,) at places what a margin is there."""
        return lambda chart, place: margin(chart, self.charts.at(chart, *place)[0])


@dataclass(frozen=True, eq=False)
class ShadedCharts(ShadedPlaces):
    """The same of visible parts of quadric bodies.

    grain (n,): parts that cuts and shadows take are no smaller than this in the view; cuts: margins one after the
    other, beside which nothing is seen; shadows: margins for some of the lights, by their numbers, outside of which the
    light does not get; cover: by what convex thing points (3,m) of charts (m,) are well hidden, -1 where by none.
    """

    rounded_mm: ClassVar[float] = ROUNDED_MM
    charts: Charts
    grain: Floats
    cuts: Sequence[Margin] = ()
    shadows: Sequence[tuple[int, Margin]] = ()
    cover: Callable[[Ints, Floats], Ints] | None = None

    def part(self, some: slice) -> ShadedCharts:
        """Some of the charts."""

        def own(margin: Margin) -> Margin:
            return lambda chart, points: margin(chart + some.start, points)

        cover = self.cover
        return replace(
            self,
            charts=self.charts.take(np.arange(some.start, some.stop)),
            item=self.item[some],
            steps=self.steps[some],
            loose_mm=self.loose_mm[some],
            grain=self.grain[some],
            cuts=[own(cut) for cut in self.cuts],
            shadows=[(number, own(margin)) for number, margin in self.shadows],
            cover=None if cover is None else lambda chart, points: cover(chart + some.start, points),
        )

    @cached_property
    def sharpness(self) -> Floats:
        """(n,) of highlights on charts; 0 where there are none."""
        finishes = [finish_of(item.material) for item in self.items]
        own = np.array([f.sharpness if f.highlight > 0.0 else 0.0 for f in finishes], dtype=np.float64)
        return np.asarray(own[self.item])


def _in_slices(function: Callable[[slice], Floats], count: int) -> Floats:
    """What a function makes of slices of so many columns, on as many threads as are allowed."""
    found = list(mapped(function, slices(count, POINTS_AT_ONCE)))
    return np.concatenate(found, axis=-1) if found else function(slice(0, 0))


# How many bands there are.

MIDDLING_MM = 10.0
"""Bodies of this radius on the page have bands that are off by as much as shades of triangles; the width of the bands
of larger and smaller ones goes with the root of the radius."""

WIDEST, NARROWEST = 2.0, 0.5
"""Times the width of the bands of middling bodies that bands of small and of large ones have."""

FEWEST, MOST_PER_MM = 6, 20.0
"""Bands of a palette; no more than so many for each mm of a radius, since narrower ones are not seen."""

LOOSE, LOOSE_OF_BAND = 2.5, 0.5
"""Isophotes may be off by so many tolerances, and by such a part of the radius less the number of bands: where a band
ends is seen far less than where a body does."""


def palette_reaches(items: Sequence[Item], item: Ints) -> Floats:
    """(n,) how far the palettes of items reach from dark to bright, as a part of all that there is."""
    dark, bright = (item_colours(items, item, np.full(len(item), shade), COLOUR_MAP) for shade in (0.0, 1.0))
    return np.asarray(np.abs(bright.astype(np.float64) - dark).max(axis=1) / 255.0)


def band_widths(reach: Floats, radius_mm: Floats, tolerance_mm: float) -> tuple[Floats, Floats]:
    """(n,) how many bands palettes that reach so far (n,) have on charts with bodies of such radii on the page (n,): so
    many that shades are off by no more than half of the width of one, and fewer where a palette has fewer colours; and
    (n,) how far isophotes may be off on the page."""
    wide = np.clip(np.sqrt(MIDDLING_MM / np.maximum(radius_mm, MIDDLING_MM / 16.0)), NARROWEST, WIDEST)
    # Wider ones are seen, whatever the tolerance is.
    allowed = min(shade_error(tolerance_mm), SHADE_ERROR)
    steps = np.minimum(reach / (2.0 * wide * allowed), MOST_PER_MM * radius_mm)
    steps = np.maximum(np.ceil(steps), FEWEST)
    return steps, np.minimum(LOOSE * tolerance_mm, LOOSE_OF_BAND * radius_mm / steps)


def half_band_steps(reach: Floats, steps: Floats) -> float:
    """By how many of 255 steps colours within bands are off those of the bands, at most: reach, steps (n,) as in
    band_widths."""
    return float((127.5 * reach / steps).max(initial=0.0))


# Meshes on charts, so fine that everything on them is nearly linear from corner to corner.

START = {CAP: (6, 6), MANTLE: (6, 2)}
"""Cells of the first mesh along x and y; of flat ends as many as BEGIN."""

BEGIN = 4

ROUNDS = 10
"""Triangles are halved so many times at most."""

SHORTEST_MM = 0.1
"""Sides that are no longer on the page are not halved any more, but for those along outlines."""

BENDS = 0.5
"""By so many bands shades are off in the middle of a side, at most."""

CHORD = 0.7
"""Such a part of the tolerance sides along outlines may be off these."""

SAG = 3.0
"""Times what isophotes may be off that sides within outlines may be off: bands beside each other bend alike."""

HIGHLIGHT = 1.2
"""Times the width of a highlight that reflected rays may turn along a side beside it."""


@dataclass(frozen=True, eq=False)
class ChartMesh:
    """Triangles (t,3) of nodes on charts: chart (n,), place (d,n) as of `Places`, and covered (n,): whether sides
    between nodes, where they are borders, are covered by what is painted later."""

    chart: Ints
    place: Floats
    covered: Bools
    triangles: Ints

    def __len__(self) -> int:
        return len(self.chart)

    def between(self, one: Ints, other: Ints, share: Floats) -> Floats:
        """(d,m) places between two nodes each."""
        start = self.place[:, one]
        return np.asarray(start + share * (self.place[:, other] - start))

    def with_nodes(self, one: Ints, other: Ints, share: Floats, triangles: Ints) -> ChartMesh:
        """The same with nodes between those that there are, and other triangles."""
        place = np.concatenate([self.place, self.between(one, other, share)], axis=1)
        covered = np.concatenate([self.covered, self.covered[one] & self.covered[other]])
        return ChartMesh(np.concatenate([self.chart, self.chart[one]]), place, covered, triangles)

    def sides(self, triangles: Ints) -> tuple[Ints, Ints, Ints]:
        """The two nodes of every side of some triangles (k,3), each side once, and (k,3) the numbers of theirs, by the
        corners at which they begin."""
        ends = np.stack([triangles, triangles[:, [1, 2, 0]]])
        key = ends.min(axis=0) * len(self) + ends.max(axis=0)
        found, number = np.unique(key, return_inverse=True)
        return *np.divmod(found, max(len(self), 1)), number.reshape(-1, 3)


def _first_mesh(charts: Charts) -> ChartMesh:
    parts = []
    for kind in np.unique(charts.kind).tolist():
        columns, rows = START.get(kind, (BEGIN, BEGIN))
        own = np.flatnonzero(charts.kind == kind)
        x, y = np.meshgrid(np.linspace(-1.0, 1.0, columns + 1), np.linspace(-1.0, 1.0, rows + 1))
        corner = np.arange(rows * (columns + 1)).reshape(rows, -1)[:, :-1]
        a, b, c, d = ((corner + shift).ravel() for shift in (0, 1, columns + 2, columns + 1))
        # Diagonals in turn, so that the corners of the square have both sides in one triangle nowhere.
        turn = ((corner % (columns + 1) + corner // (columns + 1)) % 2 == 0).ravel()
        one = np.where(turn, [a, b, c], [a, b, d]).T
        two = np.where(turn, [a, c, d], [b, c, d]).T
        cells = np.concatenate([one, two])
        nodes = x.size
        triangles = (cells + nodes * np.arange(len(own))[:, None, None]).reshape(-1, 3)
        parts.append((np.repeat(own, nodes), np.tile(np.stack([x.ravel(), y.ravel()]), len(own)), triangles))
    first = ragged.starts([len(part[0]) for part in parts])
    triangles = np.concatenate([part[2] + start for part, start in zip(parts, first, strict=True)])
    chart, place = (np.concatenate([part[k] for part in parts], axis=-1) for k in range(2))
    return ChartMesh(chart, place, np.zeros(len(chart), dtype=np.bool_), triangles)


@dataclass(frozen=True, eq=False)
class _Samples:
    """What is known of places: page (2,m); points (3,m); alpha (l,m) cosines; level (m,); highlight (l,3,m) reflected
    rays less the ways to the eye; margin (k,m) of cuts and shadows."""

    page: Floats
    points: Floats
    alpha: Floats
    level: Floats
    highlight: Floats
    margin: Floats

    def take(self, which: Ints) -> _Samples:
        return _Samples(*(np.take(row, which, axis=-1) for row in vars(self).values()))

    def joined(self, other: _Samples) -> _Samples:
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return _Samples(*(np.concatenate(pair, axis=-1) for pair in pairs))


def _samples(shaded: ShadedCharts, chart: Ints, place: Floats) -> _Samples:
    shiny = bool(shaded.sharpness.any())
    margins = [*shaded.cuts, *(margin for _, margin in shaded.shadows)]
    count = len(shaded.lights)

    def rows(some: slice) -> Floats:
        own = chart[some]
        points, normals = shaded.charts.at(own, *place[:, some])
        level = shaded.shares(own, points, normals).total * shaded.steps[own]
        to_eye = towards(points.T, view_eye(shaded.view)).T if shiny else points
        alpha, highlight = [], []
        for light in shaded.lights:
            way = towards(points.T, homogeneous_light(light)).T
            cosine = dot(normals, way)
            alpha.append(cosine)
            if shiny:
                highlight += list(2.0 * cosine * normals - way - to_eye)
        inside = [margin(own, points) for margin in margins]
        return np.stack([*shaded.on_page(points), *points, *alpha, level, *highlight, *inside])

    found = _in_slices(rows, len(chart))
    page, points, alpha, level, rest = np.split(found, np.cumsum([2, 3, count, 1]))
    lines = 3 * count if shiny else 0
    return _Samples(page, points, alpha, level[0], rest[:lines].reshape(-1, 3, len(chart)), rest[lines:])


def _refined(shaded: ShadedCharts, mesh: ChartMesh, tolerance_mm: float) -> tuple[ChartMesh, float]:
    """The mesh with triangles halved until everything is nearly linear along their sides; and how far sides along
    outlines are off these on the page, at most, in their middles."""
    off_mm = 0.0
    known = _samples(shaded, mesh.chart, mesh.place)
    active, done = mesh.triangles, []
    for _ in range(ROUNDS):
        one, other, number = mesh.sides(active)
        chart = mesh.chart[one]
        middle = mesh.between(one, other, np.full(len(one), 0.5))
        between = _samples(shaded, chart, middle)
        border = ((np.abs(middle) == 1.0) & (mesh.place[:, one] == mesh.place[:, other])).any(axis=0)
        ends = known.take(one), known.take(other)
        bad = _bent(shaded, chart, border, ends, between, tolerance_mm)
        off_mm = max(off_mm, float(_beside(*ends, between)[border & ~bad].max(initial=0.0)))
        if not bad.any():
            break
        cut = np.flatnonzero(bad)
        fresh = np.full(len(bad), -1, dtype=np.intp)
        fresh[cut] = len(mesh) + np.arange(len(cut))
        split = bad[number].any(axis=1)
        done.append(active[~split])
        active = _halved(active[split], bad[number[split]], fresh[number[split]])
        mesh = mesh.with_nodes(one[cut], other[cut], np.full(len(cut), 0.5), active)
        known = known.joined(between.take(cut))
    return replace(mesh, triangles=np.concatenate([*done, active])), off_mm


def _halved(triangles: Ints, bad: Bools, middles: Ints) -> Ints:
    """What triangles (t,3) become whose sides (t,3) are halved, one or more of each, at nodes (t,3)."""
    count = bad.sum(axis=1)
    # Turned so that one halved side comes first, and of two the second one second.
    turn = np.where(count == 2, (bad.argmin(axis=1) + 1) % 3, bad.argmax(axis=1))
    order = (turn[:, None] + np.arange(3)) % 3
    nodes = np.concatenate([np.take_along_axis(rows, order, axis=1) for rows in (triangles, middles)], axis=1)
    found = [nodes[count == number][:, np.array(parts)].reshape(-1, 3) for number, parts in PARTS.items()]
    return np.concatenate(found)


def _beside(one: _Samples, other: _Samples, middle: _Samples) -> Floats:
    """(s,) how far the middles of curves between places are from their chords, in mm on the page."""
    way = other.page - one.page
    off = middle.page - 0.5 * (one.page + other.page)
    return np.asarray(np.abs(way[0] * off[1] - way[1] * off[0]) / np.maximum(np.hypot(*way), LEAST_DIVISOR))


def _bent(
    shaded: ShadedCharts,
    chart: Ints,
    border: Bools,
    ends: tuple[_Samples, _Samples],
    middle: _Samples,
    tolerance_mm: float,
) -> Bools:
    """(s,) the sides along which something is not nearly linear."""
    one, other = ends
    way = other.page - one.page
    length = np.hypot(*way)
    off = middle.page - 0.5 * (one.page + other.page)
    beside = _beside(one, other, middle)
    outline = border & (np.maximum(beside, np.where(length > 0.0, 0.0, np.hypot(*off))) > CHORD * tolerance_mm)
    bad = beside > SAG * shaded.loose_mm[chart]
    allowed = BENDS / shaded.steps[chart]
    alphas = np.stack([one.alpha, middle.alpha, other.alpha])
    bad |= (np.abs(alphas[1] - 0.5 * (alphas[0] + alphas[2])) > allowed).any(axis=0)
    # Shades bend where a side crosses a terminator: there the mesh is cut.
    along = ((alphas >= -ROUNDING).all(axis=0) | (alphas <= ROUNDING).all(axis=0)).all(axis=0)
    bad |= along & (np.abs(middle.level - 0.5 * (one.level + other.level)) > BENDS)
    if len(middle.highlight):
        sharpness = shaded.sharpness[chart]
        wide = HIGHLIGHT / np.sqrt(np.where(sharpness > 0.0, sharpness, 1.0))
        nearest = np.min([np.sqrt((s.highlight**2).sum(axis=1)) for s in (one, middle, other)], axis=0)
        step = other.highlight - one.highlight
        turned = np.sqrt((step * step).sum(axis=1))
        bad |= (sharpness > 0.0) & ((turned > np.maximum(nearest, wide)) & (alphas.max(axis=0) > -wide)).any(axis=0)
    step = other.points - one.points
    far, lit = np.sqrt(dot(step, step)), alphas.max(axis=0) > 0.0
    shines = [np.ones(len(far), dtype=np.bool_) for _ in shaded.cuts] + [lit[number] for number, _ in shaded.shadows]
    for on, a, m, b in zip(shines, one.margin, middle.margin, other.margin, strict=True):
        crosses = (np.minimum(a, np.minimum(m, b)) < 0.0) & (np.maximum(a, np.maximum(m, b)) > 0.0)
        bends = np.abs(m - 0.5 * (a + b))
        bad |= on & crosses & (bends * length > tolerance_mm * np.maximum(np.abs(b - a), bends))
        # What is no larger than the grain could lie beside the side.
        bad |= on & (np.abs(m) < 0.5 * far) & (far > shaded.grain[chart])
    long = np.maximum(length, 2.0 * np.hypot(*(middle.page - one.page))) > SHORTEST_MM
    return np.asarray(outline | (bad & long), dtype=np.bool_)


# Meshes cut where a function of places is zero.

ROOT_ROUNDS = 12
"""Steps to a place on a side where a function has some value, at most."""

EXACT_LEVEL = 1.0 / 64.0
"""Corners of isophotes are no farther off them than so many bands."""


def _root(function: Callable[[Ints, Floats], Floats], start: Floats, end: Floats, allowed: float) -> Floats:
    """(s,) the parts of sides at which functions, of some of the sides at parts of these, are zero within what is
    allowed, that have other signs at their starts and ends, values (s,).

    Source: Dowell and Jarratt (1971): the Illinois method, a false position that never leaves its bracket.
    """
    low, high, found = np.zeros(len(start)), np.ones(len(start)), np.zeros(len(start))
    left = np.arange(len(start))
    for _ in range(ROOT_ROUNDS):
        slope = np.where(start != end, start - end, 1.0)
        part = np.clip(low + start / slope * (high - low), low, high)
        found[left] = part
        value = function(left, part)
        same = (value < 0.0) == (start < 0.0)
        start, end = np.where(same, value, 0.5 * start), np.where(same, 0.5 * end, value)
        low, high = np.where(same, part, low), np.where(same, high, part)
        going = np.abs(value) > allowed
        left = left[going]
        start, end, low, high = (row[going] for row in (start, end, low, high))
        if not len(left):
            break
    return found


def _cut(mesh: ChartMesh, function: Callable[[Ints, Floats], Floats]) -> tuple[ChartMesh, Floats]:
    """The mesh with triangles cut where a function of places is zero, and (t,) its sign on each of them."""
    value = _in_slices(lambda some: function(mesh.chart[some], mesh.place[:, some]), len(mesh))
    value = np.where(np.abs(value) <= ROUNDING, 0.0, value)
    sign = np.sign(value).astype(np.intp)
    corner = sign[mesh.triangles]
    which = (corner.min(axis=1) < 0) & (corner.max(axis=1) > 0)
    kept, cut = mesh.triangles[~which], mesh.triangles[which]
    one, other, number = mesh.sides(cut)
    crossed = sign[one] * sign[other] < 0
    start, end = one[crossed], other[crossed]

    def along(which: Ints, part: Floats) -> Floats:
        a = start[which]
        place = mesh.between(a, end[which], part)
        return _in_slices(lambda some: function(mesh.chart[a[some]], place[:, some]), len(a))

    share = _root(along, value[start], value[end], ROUNDING)
    fresh = np.full(len(one), -1, dtype=np.intp)
    fresh[crossed] = len(mesh) + np.arange(len(start))
    middles = fresh[number]
    several = (middles >= 0).sum(axis=1) == 2
    # Turned so that the first corner lies alone on its side, or on the cut.
    alone = np.where(several, (middles[:, [0, 1, 2]] < 0).argmax(axis=1) + 2, (sign[cut] == 0).argmax(axis=1)) % 3
    order = (alone[:, None] + np.arange(3)) % 3
    p, q, r = np.take_along_axis(cut, order, axis=1).T
    pq, qr, rp = np.take_along_axis(middles, order, axis=1).T
    two = several
    pieces = [
        np.stack([p, pq, rp], axis=1)[two],
        np.stack([pq, q, r], axis=1)[two],
        np.stack([pq, r, rp], axis=1)[two],
        np.stack([p, q, qr], axis=1)[~two],
        np.stack([p, qr, r], axis=1)[~two],
    ]
    found = mesh.with_nodes(start, end, share, np.concatenate([kept, *pieces]))
    sign = np.concatenate([sign, np.zeros(len(start), dtype=np.intp)])
    return found, np.sign(sign[found.triangles].sum(axis=1)).astype(np.float64)


# Bands between isophotes, marched on the mesh: each reaches to the end of the next one, which is painted on it.

OVER = 2
"""So many bands each polygon covers: its own, and the next one, which covers that."""

COAT = 1
"""So many bands below the lowest one its coat is."""

THINNED, THINNED_UNDER = 0.3, 0.45
"""Corners of isophotes that are no farther off the line between their neighbours than this part of the width of the
band are left out, where bands begin, and where they end under the next ones."""

SPECK_MM = 0.04
"""Polygons that are no larger than the square of this are left out: there one sees the band before."""

UNSEEN_MM = 0.15
"""So far corners may be off that are covered."""

CHARTS_AT_ONCE, TRIANGLES_AT_ONCE = 64, 1 << 14
"""So many charts, or about so many triangles of facets, are marched at once: few enough to bound what they take of
memory."""


@dataclass(frozen=True, eq=False)
class ShadeBands:
    """Polygons in the order in which they are painted: points (3,p) of the view, page (2,p) in mm, offsets (m+1,);
    chart, lacking and level (m,): the lights that do not get there, and the band of the palette."""

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    page: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    chart: Ints = field(metadata=EACH_LINE)
    lacking: Ints = field(metadata=EACH_LINE)
    level: Ints = field(metadata=EACH_LINE)
    steps: Floats = field(metadata=APART)

    def __len__(self) -> int:
        return len(self.chart)

    @property
    def shade(self) -> Floats:
        """(m,) in the middle of each band."""
        return np.asarray(np.clip((self.level + 0.5) / self.steps[self.chart], 0.0, 1.0))


def shade_bands(shaded: ShadedCharts, tolerance_mm: float) -> tuple[ShadeBands, float]:
    """The bands of equal shade of charts, each chart by itself: those in full light, then those in shadows; and how far
    outlines are off on the page, at most, in mm.

    Shades are those of the surfaces themselves. Bands are off by half of their width, by what BENDS allows between the
    corners of isophotes, and by what outlines are off on the page, no more than tolerance_mm.
    Regions between isophotes are marched on triangles; the painter's algorithm makes each end at the next one.
    """

    def of_part(some: slice) -> tuple[ShadeBands, float]:
        found, off_mm = _bands_of(shaded.part(some), tolerance_mm)
        return replace(found, chart=found.chart + some.start, steps=shaded.steps), off_mm

    parts, off_mm = zip(*mapped(of_part, slices(len(shaded.charts), CHARTS_AT_ONCE)), strict=True)
    return joined(parts), max(off_mm)


def _bands_of(shaded: ShadedCharts, tolerance_mm: float) -> tuple[ShadeBands, float]:
    """The same of some charts."""
    mesh, off_mm = _refined(shaded, _first_mesh(shaded.charts), tolerance_mm)
    if shaded.cover is not None:
        cover = shaded.cover(mesh.chart, shaded.charts.at(mesh.chart, *mesh.place)[0])[mesh.triangles]
        # What a convex thing hides is convex.
        seen = (cover[:, 0] < 0) | (cover != cover[:, :1]).any(axis=1)
        covered = np.zeros(len(mesh), dtype=np.bool_)
        covered[mesh.triangles[~seen]] = True
        mesh = replace(mesh, covered=covered, triangles=mesh.triangles[seen])
    for cut in shaded.cuts:
        mesh, side = _cut(mesh, shaded.margins(cut))
        mesh = replace(mesh, triangles=mesh.triangles[side > 0.0])
    for number in range(len(shaded.lights)):
        mesh = _cut(mesh, shaded.cosines(number))[0]
    for _, margin in shaded.shadows:
        mesh = _cut(mesh, shaded.margins(margin))[0]
    return _marched(shaded, mesh, _lacking(shaded, mesh)), off_mm


def mesh_bands(shaded: ShadedPlaces, mesh: ChartMesh, lacking: Ints, coated: Bools) -> ShadeBands:
    """The bands of equal shade on a mesh every node of which lacks some lights (n,), bit k for light k: chart by chart,
    as its triangles are, on each of them as in `shade_bands`; coated (t,): whether the darkest shade goes on under
    triangles.

    Sides that two triangles of a chart have in common run opposite ways on them, and no side is there twice one way.
    """
    first = ragged.offsets(np.bincount(mesh.chart[mesh.triangles[:, 0]], minlength=len(shaded)))

    def of_part(span: tuple[int, int]) -> ShadeBands:
        begin, end = first[list(span)]
        node, place = np.unique(mesh.triangles[begin:end], return_inverse=True)
        part = ChartMesh(mesh.chart[node], mesh.place[:, node], mesh.covered[node], place.reshape(-1, 3))
        part, source = _without_pinches(part)
        return _Marching(shaded, part, lacking[node[source]], coated[begin:end]).bands()

    return joined(list(mapped(of_part, ragged.batches(np.diff(first), TRIANGLES_AT_ONCE))))


def _lacking(shaded: ShadedCharts, mesh: ChartMesh) -> Ints:
    """(t,) the lights that do not get to triangles which they shine on: bit k for light k."""
    found = np.zeros(len(mesh.triangles), dtype=np.intp)
    chart = mesh.chart[mesh.triangles[:, 0]]
    place = mesh.place[:, mesh.triangles].mean(axis=2)
    for number, margin in shaded.shadows:
        sides = (shaded.margins(margin), shaded.cosines(number))
        in_shadow, lit = (
            _in_slices(lambda some, side=side: side(chart[some], place[:, some]), len(chart))  # type: ignore[misc]
            for side in sides
        )
        found |= np.where((in_shadow < 0.0) & (lit > 0.0), 1 << number, 0)
    return found


def _marched(shaded: ShadedCharts, mesh: ChartMesh, lacking: Ints) -> ShadeBands:
    combinations = np.unique(np.append(lacking, 0))
    combinations = combinations[np.argsort(np.bitwise_count(combinations), kind="stable")]
    jobs, nodes, lacks, covered = [], [], [], []
    within = (np.abs(mesh.place) < 1.0).all(axis=0)
    count = 0
    for some in combinations.tolist():
        # Those in more shadows lie on these: of them only what is next is needed.
        beside = np.zeros(len(mesh), dtype=np.bool_)
        beside[mesh.triangles[lacking == some]] = True
        triangles = mesh.triangles[((lacking & some) == some) & beside[mesh.triangles].any(axis=1)]
        own, place = np.unique(triangles, return_inverse=True)
        jobs.append(place.reshape(-1, 3) + count)
        nodes.append(own)
        covered.append(mesh.covered[own] | (within & ~beside)[own])
        lacks.append(np.full(len(own), some, dtype=np.intp))
        count += len(own)
    node, lack = np.concatenate(nodes), np.concatenate(lacks)
    job_mesh = ChartMesh(mesh.chart[node], mesh.place[:, node], np.concatenate(covered), np.concatenate(jobs))
    job_mesh, source = _without_pinches(job_mesh)
    return _Marching(shaded, job_mesh, lack[source], np.ones(len(job_mesh.triangles), dtype=np.bool_)).bands()


def _without_pinches(mesh: ChartMesh) -> tuple[ChartMesh, Ints]:
    """The mesh with a node of its own for each fan of triangles that meet in one, and (n,) the old number of each node:
    every node then has one side of the border before it, and one behind it, or none."""
    triangles, count = mesh.triangles, len(mesh)
    _, _, number = mesh.sides(triangles)
    once = np.bincount(number.ravel())[number] == 1
    pinched = np.bincount(triangles[once], minlength=count) > 1
    if not pinched.any():
        return mesh, np.arange(count)
    # Pairs of corners (t,3) of triangles beside each other, at both ends of their common sides.
    order = np.argsort(number.ravel(), kind="stable")
    first = np.flatnonzero(np.diff(number.ravel()[order]) == 0)
    one, other = order[first], order[first + 1]
    after = np.arange(triangles.size).reshape(-1, 3)[:, [1, 2, 0]].ravel()
    links = np.concatenate([np.stack([one, after[other]]), np.stack([after[one], other])], axis=1)
    node = triangles.ravel()
    links = links[:, pinched[node[links[0]]]]
    label = np.arange(triangles.size)
    while True:
        least = label[links].min(axis=0)
        fresh = label.copy()
        for row in links:
            np.minimum.at(fresh, row, least)
        if (fresh == label).all():
            break
        label = fresh
    corner = np.flatnonzero(pinched[node])
    fans, of = np.unique(label[corner], return_inverse=True)
    node = node.copy()
    node[corner] = count + of.reshape(-1)
    source = np.concatenate([np.arange(count), triangles.ravel()[fans]])
    return ChartMesh(mesh.chart[source], mesh.place[:, source], mesh.covered[source], node.reshape(-1, 3)), source


@dataclass(frozen=True, eq=False)
class _Marching:
    """A mesh every node of which lacks some lights (n,), marched. What of it is coated (t,) has the darkest shade below
    all bands, so that nothing behind is seen where these are narrower than a pixel."""

    shaded: ShadedPlaces
    mesh: ChartMesh
    lacking: Ints
    coated: Bools

    @cached_property
    def level(self) -> Floats:
        """(n,) the shades of nodes in bands."""
        return self.shaded.levels(self.mesh.chart, self.mesh.place, self.lacking)

    @cached_property
    def sides(self) -> tuple[Ints, Ints, Ints]:
        """As in ChartMesh, of all triangles."""
        return self.mesh.sides(self.mesh.triangles)

    @cached_property
    def part(self) -> Ints:
        """(n,) the number of the part each node is of: of one chart, for want of the same lights."""
        key = self.lacking * (len(self.shaded) + 1) + self.mesh.chart
        return np.asarray(np.unique(key, return_inverse=True)[1].reshape(-1))

    @cached_property
    def crossings(self) -> tuple[Ints, Ints, Ints, Ints]:
        """Sides and levels (c,) of the places where isophotes cross sides, side by side; the first one of every side,
        and its lowest level."""
        one, other, _ = self.sides
        low, high = np.sort(self.level[np.stack([one, other])], axis=0)
        first, last = np.floor(low).astype(np.intp) + 1, np.floor(high).astype(np.intp)
        count = np.maximum(last - first + 1, 0)
        return ragged.owner(count), ragged.ranges(first, count), ragged.offsets(count), first

    def crossing(self, side: Ints, level: Ints) -> Ints:
        """Points where the isophotes of some levels cross sides, numbered on from the nodes."""
        _, _, begin, first = self.crossings
        return np.asarray(len(self.level) + begin[side] + level - first[side])

    def bands(self) -> ShadeBands:
        """The bands as polygons."""
        key, start, end, kind = self._segments()
        order, offsets, ring_key, upper = _gathered(*_rings(key, start, end, kind))
        points, position = self._points(), start[order]
        of_coat = position >= points.shape[1]
        position[of_coat] = self._coat[1][position[of_coat] - points.shape[1]]
        page = np.rint(self.shaded.on_page(points) / self.shaded.rounded_mm) * self.shaded.rounded_mm
        under = (kind[order] == 2) & (kind[order][ragged.preceding(offsets)] == 2)
        strict, loose = self._allowed(page)
        keep = _thinned(page[:, position], offsets, np.where(under, loose[position], strict[position]))
        position, offsets = position[keep], ragged.offsets(keep)[offsets]
        return self._polygons(points, page, position, offsets, ring_key, upper)

    @cached_property
    def _span(self) -> int:
        return int(np.ceil(self.level.max(initial=0.0))) + OVER + COAT + 1

    def _segments(self) -> tuple[Ints, Ints, Ints, Ints]:
        """Pieces of borders of bands, these on their left: keys, which tell part and band, start and end (s,); kind 0
        along borders of parts, 1 along their lower isophotes, 2 along their upper ones and along covered borders."""
        mesh, level, (_, _, number) = self.mesh, self.level, self.sides
        corners = level[mesh.triangles]
        first = np.floor(corners.min(axis=1)).astype(np.intp) + 1
        count = np.floor(corners.max(axis=1)).astype(np.intp) - first + 1
        of, lines = ragged.owner(count), ragged.ranges(first, count)
        inside = corners[of] >= lines[:, None]
        after = inside[:, [1, 2, 0]]
        leaving, coming = (inside & ~after).argmax(axis=1), (~inside & after).argmax(axis=1)
        start = self.crossing(number[of, leaving], lines)
        end = self.crossing(number[of, coming], lines)
        part = self.part[mesh.triangles[of, 0]]
        lowest = np.full(int(self.part.max(initial=-1)) + 1, self._span, dtype=np.intp)
        np.minimum.at(lowest, self.part, np.floor(level).astype(np.intp))
        span = self._span
        parts = [
            (part * span + COAT + lines, start, end, np.ones(len(of), dtype=np.intp)),
            (part * span + COAT + lines - OVER, end, start, np.full(len(of), 2, dtype=np.intp)),
        ]
        kept = [lines > lowest[part], lines - OVER >= lowest[part]]
        parts = [tuple(row[some] for row in rows) for rows, some in zip(parts, kept, strict=True)]
        parts += [self._along_borders(lowest), self._coats(lowest)]
        return tuple(np.concatenate([rows[k] for rows in parts]) for k in range(4))  # type: ignore[return-value]

    def _along_borders(self, lowest: Ints) -> tuple[Ints, Ints, Ints, Ints]:
        """The pieces of the borders of parts."""
        mesh, (_, _, number) = self.mesh, self.sides
        once = np.bincount(number.ravel())[number] == 1
        triangle, corner = np.nonzero(once)
        a, b = mesh.triangles[triangle, corner], mesh.triangles[triangle, (corner + 1) % 3]
        side = number[triangle, corner]
        at_a, at_b = np.floor(self.level[a]).astype(np.intp), np.floor(self.level[b]).astype(np.intp)
        # From each crossing to the next: so all bands have the same corners there.
        count = np.abs(at_b - at_a) + 1
        of, step = ragged.owner(count), ragged.place(count)
        sign = np.where(at_b >= at_a, 1, -1)[of]
        band = at_a[of] + sign * step
        before, behind = np.where(sign > 0, band, band + 1), np.where(sign > 0, band + 1, band)
        last = step == count[of] - 1
        start = np.where(step == 0, a[of], self.crossing(side[of], np.where(step == 0, 0, before)))
        end = np.where(last, b[of], self.crossing(side[of], np.where(last, 0, behind)))
        kind = np.where(mesh.covered[a] & mesh.covered[b], 2, 0).astype(np.intp)[of]
        part = self.part[a][of]
        bands = np.stack([band - under for under in range(OVER)])
        row, piece = np.nonzero(bands >= lowest[part])
        key = np.asarray(part[piece] * self._span + COAT + bands[row, piece], dtype=np.intp)
        return key, start[piece], end[piece], kind[piece]

    @cached_property
    def _coat(self) -> tuple[Ints, Ints]:
        """What is coated: triangles (t,3) of nodes that are numbered on from all points, and the nodes they stand
        for."""
        coat, source = _without_pinches(replace(self.mesh, triangles=self.mesh.triangles[self.coated]))
        return coat.triangles + len(self.level) + len(self.crossings[0]), source

    def _coats(self, lowest: Ints) -> tuple[Ints, Ints, Ints, Ints]:
        """The borders of what is coated, below the lowest bands of parts."""
        own, number = self._coat[0], self.sides[2][self.coated]
        once = np.bincount(number.ravel(), minlength=1)[number] == 1
        triangle, corner = np.nonzero(once)
        part = self.part[self.mesh.triangles[self.coated][triangle, 0]]
        key = part * self._span + COAT + lowest[part] - COAT
        return key, own[triangle, corner], own[triangle, (corner + 1) % 3], np.zeros(len(key), dtype=np.intp)

    def _allowed(self, page: Floats) -> tuple[Floats, Floats]:
        """(k,) how far corners (2,k) may be beside the lines that are drawn without them where bands begin, and where
        they end under the next ones. On borders all bands have the same corners, and keep them."""
        one, other, number = self.sides
        side = self.crossings[0]
        inner = np.bincount(number.ravel(), minlength=len(one))[side] > 1
        loose = self.shaded.loose_mm[self.mesh.chart[one[side]]]
        covered = self.mesh.covered
        hidden = covered[one[side]] & covered[other[side]]
        wide = self._band_widths(page)[side]
        nodes, ends = np.where(covered, UNSEEN_MM, 0.0), (np.minimum(loose, THINNED * wide), THINNED_UNDER * wide)
        begin, end = (np.where(hidden, UNSEEN_MM, np.where(inner, one, 0.0)) for one in ends)
        return np.concatenate([nodes, begin]), np.concatenate([nodes, end])

    def _band_widths(self, page: Floats) -> Floats:
        """(s,) how wide bands are on the page in the two triangles at sides, by their areas; page (2,k): the places of
        nodes, and others."""
        triangles, (one, _, number) = self.mesh.triangles, self.sides
        a, b, c = page[:, triangles.T].transpose(1, 0, 2)
        rise = self.level[triangles]
        p, q = rise[:, 1] - rise[:, 0], rise[:, 2] - rise[:, 0]
        u, v = b - a, c - a
        # Slope times area, and area.
        rows = np.hypot(*(p * v - q * u)), np.abs(u[0] * v[1] - u[1] * v[0])
        slope, area = (np.bincount(number.ravel(), np.repeat(row, 3), minlength=len(one)) for row in rows)
        return np.asarray(area / np.maximum(slope, LEAST_DIVISOR))

    def _points(self) -> Floats:
        """(3,k) the nodes, and the places where isophotes cross sides, in the view."""
        mesh, (one, other, _), (side, level, _, _) = self.mesh, self.sides, self.crossings
        start, end = one[side], other[side]

        def along(which: Ints, part: Floats) -> Floats:
            a = start[which]
            place = mesh.between(a, end[which], part)
            return self.shaded.levels(mesh.chart[a], place, self.lacking[a]) - level[which]

        share = _root(along, self.level[start] - level, self.level[end] - level, EXACT_LEVEL)
        every = mesh.with_nodes(start, end, share, mesh.triangles)
        return _in_slices(lambda some: self.shaded.charts.at(every.chart[some], *every.place[:, some])[0], len(every))

    def _polygons(
        self, points: Floats, page: Floats, position: Ints, offsets: Ints, key: Ints, upper: Bools
    ) -> ShadeBands:
        """Rings as polygons: holes in which all is brighter are left out, for that is painted later; what has others is
        cut open to them."""
        flat = page[:, position]
        doubled = _doubled_areas(flat, offsets)
        hole = doubled < 0.0
        large = (np.diff(offsets) >= 3) & (np.abs(doubled) > 2.0 * SPECK_MM**2)
        brighter, open_ = np.flatnonzero(large & hole & upper), np.flatnonzero(large & hole & ~upper)
        part = key // self._span
        around, _ = _rings_within(flat, offsets, part, brighter, open_)
        holes = np.union1d(open_, around)
        outer, inner = _rings_within(flat, offsets, key, np.flatnonzero(large & ~hole), holes)
        # Of those around a hole the smallest one.
        order = np.lexsort((doubled[outer], inner))
        first = np.diff(inner[order], prepend=-1) != 0
        outer, inner = outer[order][first], inner[order][first]
        rings = np.concatenate([np.flatnonzero(large & ~hole), inner])
        owner = np.concatenate([np.flatnonzero(large & ~hole), outer])
        rings = rings[np.argsort(owner, kind="stable")]
        corner, ends, of = _opened(offsets, rings, np.sort(owner))
        return self._bands(points[:, position[corner]], flat[:, corner], ends, key[of])

    def _bands(self, points: Floats, page: Floats, offsets: Ints, key: Ints) -> ShadeBands:
        part, band = np.divmod(key, self._span)
        band = np.maximum(band - COAT, 0)
        first = np.zeros(int(self.part.max(initial=-1)) + 1, dtype=np.intp)
        first[self.part] = np.arange(len(self.part))
        node = first[part]
        found = ShadeBands(points, page, offsets, self.mesh.chart[node], self.lacking[node], band, self.shaded.steps)
        return take(found, _painting_order(found))


def _painting_order(bands: ShadeBands) -> Ints:
    """Charts one after the other, on each what lacks more lights later, and of that what is brighter."""
    return np.lexsort((bands.level, bands.lacking, np.bitwise_count(bands.lacking), bands.chart))


VOTES = 3
"""Corners of a ring that tell whether it is within another one: any of them may be on that."""


def _doubled_areas(page: Floats, offsets: Ints) -> Floats:
    """(n,) twice the signed areas of rings (2,p)."""
    if not page.shape[1]:
        return np.zeros(0)
    (x, y), (u, v) = page, page[:, ragged.following(offsets)]
    return np.asarray(np.add.reduceat(x * v - y * u, offsets[:-1]))


def _rings_within(page: Floats, offsets: Ints, group: Ints, one: Ints, other: Ints) -> tuple[Ints, Ints]:
    """Pairs of rings (2,p) of one group (n,), those of the one kind and those of the other within them, which they do
    not cross, but may touch: by most of three corners."""
    if not len(one) or not len(other):
        return one[:0], other[:0]
    low, high = (extreme.reduceat(page, offsets[:-1], axis=1) for extreme in (np.minimum, np.maximum))
    below, above = (np.vstack([group, edge]) for edge in (low, high))
    pair, inner = overlapping_boxes(below[:, one], above[:, one], below[:, other], above[:, other])
    around, within = one[pair], other[inner]
    wide = (low[:, around] <= low[:, within]).all(axis=0) & (high[:, around] >= high[:, within]).all(axis=0)
    around, within = around[wide & (around != within)], within[wide & (around != within)]
    votes = np.zeros(len(around), dtype=np.intp)
    sizes = np.diff(offsets)
    for begin, end in ragged.batches(sizes[around], PAIRS_AT_ONCE):
        of = slice(begin, end)
        corner, ends = ragged.take(offsets, around[of])
        (x, y), (u, v) = page[:, corner], page[:, corner[ragged.following(ends)]]
        for part in range(VOTES):
            place = page[:, offsets[within[of]] + part * sizes[within[of]] // VOTES]
            a, b = np.repeat(place, np.diff(ends), axis=1)
            across = (y <= b) != (v <= b)
            with np.errstate(divide="ignore", invalid="ignore"):
                across &= x + (u - x) * (b - y) / (v - y) > a
            votes[of] += np.add.reduceat(across, ends[:-1], dtype=np.intp) % 2
    found = 2 * votes > VOTES
    return around[found], within[found]


def _opened(offsets: Ints, rings: Ints, owner: Ints) -> tuple[Ints, Ints, Ints]:
    """Rings, each followed by its holes, whose owner it is, as polygons that are cut open to these from the first
    corner: corners (c,), offsets (m+1,), and the ring of each polygon."""
    sizes = np.diff(offsets)[rings]
    first = np.append(True, owner[1:] != owner[:-1])[: len(owner)]
    holes = np.bincount(np.cumsum(first) - 1)[np.cumsum(first) - 1] > 1
    # A ring with holes comes back to its first corner; so does each hole, and then goes to that of the ring.
    more = np.where(holes, np.where(first, 1, 2), 0)
    ring, step = ragged.owner(sizes + more), ragged.place(sizes + more)
    at = np.where(step <= sizes[ring], offsets[rings[ring]] + step % sizes[ring], offsets[owner[ring]])
    ends = np.append(ragged.offsets(sizes + more)[:-1][first], len(at))
    return at, ends, rings[first]


def _rings(key: Ints, start: Ints, end: Ints, kind: Ints) -> tuple[Ints, Ints, Ints, Bools]:
    """Pieces with keys that join start and end, as rings: (s,) the number of the ring of each, its place on it, the
    key, and whether all pieces of its ring are of kind 2."""
    size = int(max(start.max(initial=0), end.max(initial=0))) + 1
    come, go = key * size + start, key * size + end
    order = np.argsort(come, kind="stable")
    following = order[np.searchsorted(come[order], go)]
    # Pointer doubling: the least number on the ring, and how far it is to it.
    count = len(key)
    least, jump = np.arange(count), following.copy()
    for _ in range(max(int(count).bit_length(), 1)):
        other = np.minimum(least, least[jump])
        if (other == least).all():
            break
        least, jump = other, jump[jump]
    far = np.where(following == least, 0, 1)
    jump = np.where(following == least, np.arange(count), following)
    for _ in range(max(int(count).bit_length(), 1)):
        step = far[jump]
        if not step.any():
            break
        far, jump = far + step, jump[jump]
    plain = np.zeros(count, dtype=np.bool_)
    plain[least[kind != 2]] = True
    return least, -far, key, ~plain[least]


def _gathered(ring: Ints, place: Ints, key: Ints, upper: Bools) -> tuple[Ints, Ints, Ints, Bools]:
    """Pieces (s,) in the order of their rings by keys, the offsets of these, and of each ring its key and what is said
    of it."""
    order = np.lexsort((place, ring, key))
    first = np.flatnonzero(np.diff(ring[order], prepend=-1))
    return order, np.append(first, len(order)), key[order[first]], upper[order[first]]


def _thinned(page: Floats, offsets: Ints, allowed: Floats) -> Bools:
    """(p,) which corners of rings (2,p) are kept, of those that may be beside lines by what is allowed (p,): of every
    two neighbours one may go, four times."""
    kept = np.ones(page.shape[1], dtype=np.bool_)
    for parity in (1, 0, 1, 0):
        position = np.flatnonzero(kept)
        ends = ragged.offsets(kept)[offsets]
        sizes = np.diff(ends)
        before, after = ragged.preceding(ends), ragged.following(ends)
        p, a, b = page[:, position], page[:, position[before]], page[:, position[after]]
        way, arm = b - a, p - a
        length = np.hypot(*way)
        off = np.abs(way[0] * arm[1] - way[1] * arm[0]) / np.maximum(length, LEAST_DIVISOR)
        along = way[0] * arm[0] + way[1] * arm[1]
        straight = (off <= allowed[position]) & (along >= 0.0) & (along <= length * length)
        turn = ragged.place(sizes)
        # The last of an odd number has a neighbour of its own parity.
        mine = (turn % 2 == parity) & (turn + 1 < np.repeat(sizes - sizes % 2 + 1, sizes))
        kept[position[straight & mine & np.repeat(sizes > 4, sizes)]] = False
    return kept
