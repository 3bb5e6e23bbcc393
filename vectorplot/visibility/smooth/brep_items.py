"""Boundary representations as the engine sees them: a sheet for each face, edges as given curves on two sheets."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.zero_curves import EVERYWHERE
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import inverse_matrix, matmul
from vectorplot.geometry.chord_refinement import Traces, bisected, refined, straight_between
from vectorplot.geometry.elementary import arccos, arctan2
from vectorplot.geometry.vectors import dot, from_components, norm
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.brep import Brep, BrepEdges, TurnedLine
from vectorplot.surfaces.placed_surface import PlacedSurface, placed_once
from vectorplot.surfaces.stacked import StackedSurfaces
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances import EDGE_ON_SINE, ON_TRIM
from vectorplot.visibility.polyhedra.lines import kinds_of
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.curve_families import Along, Chords, ConditionCurves, ParameterCurves
from vectorplot.visibility.smooth.intersections import within_trims
from vectorplot.visibility.smooth.parametric_items import contour_condition, contours_of_parametrised
from vectorplot.visibility.smooth.sheets import ParametricSheet, Sheets, parametric_sheets
from vectorplot.visibility.smooth.traced_curves import Curves, as_curves, no_curves, together, with_merged_families
from vectorplot.words import LineKind

FEWEST = 8
"""Cells of the tessellations of faces in each direction, at least."""

ROWS_APART = 8
"""Edges are chords between every so many of their rows before they are refined."""

HALVINGS = 50
"""Steps of halving from a chord to the place where a face turns away: what is left is rounding."""

NONE = -1

DRAWN_KINDS = (LineKind.CREASE, LineKind.TANGENT, None)
"""What edges are drawn as that two faces have in common, by their kinds."""


def sheets_of_breps(view: View, breps: Sequence[tuple[Brep, int, bool]]) -> list[ParametricSheet]:
    """The sheets of the faces of bodies, given with their items and whether these hide, one after the other."""
    faces = [(face, item, hides) for brep, item, hides in breps for face in brep.trimmed_faces]
    placed = [placed_once(face.surface, view.axes.T / view.scale, np.zeros(3), view.centre) for face, _, _ in faces]
    sheets = parametric_sheets(
        placed,
        [item for _, item, _ in faces],
        [hides for _, _, hides in faces],
        [face.region for face, _, _ in faces],
        FEWEST,
    )
    return [replace(sheet, of_body=True) for sheet in sheets]


def curves_of_breps(
    scene: Scene,
    view: View,
    breps: Mapping[int, Brep],
    sheets: Sheets,
    kinds: frozenset[LineKind],
    tracing: Tracing,
) -> tuple[list[Curves], list[Curves], list[tuple[str, str]]]:
    """The contours and edges of bodies, by the numbers of their items, that are drawn; those that hide; and doubts
    about items, by name."""
    first = {item: int(np.argmax(sheets.item == item)) for item in breps}
    wanted = {item: kinds_of(scene.items[item], kinds) for item in breps}
    own = {
        first[item] + number: face.surface
        for item, brep in breps.items()
        for number, face in enumerate(brep.trimmed_faces)
        if not face.flat
    }
    curved = {number: sheet for number in own if isinstance(sheet := sheets[number], ParametricSheet)}
    ruled = {number: sheet for number, sheet in curved.items() if isinstance(_inner(sheet), TurnedLine)}
    parts, doubts = [_rulings(view, ruled)], list[tuple[str, str]]()
    others = {number: sheet for number, sheet in curved.items() if number not in ruled}
    for number, found in contours_of_parametrised(view, others, tracing).items():
        family = ConditionCurves(others[number], number, contour_condition(view, others[number].surface))
        item = others[number].item
        # Of a face that is all seen edge-on the edges are the whole picture.
        doubts += [(scene.items[item].name, text) for text in found.doubts if text != EVERYWHERE]
        if len(found):
            parts.append(as_curves(found, LineKind.CONTOUR, item, family))
    (contours,) = with_merged_families([together(parts)], sheets)
    contours = _ends_of_lines(within_trims(contours, curved), ruled)
    shown = [item for item, words in wanted.items() if LineKind.CONTOUR in words]
    hiding = [item for item in breps if scene.items[item].hides]
    borders, drawn = _edges(view, breps, first, sheets, wanted, tracing)
    return (
        [contours.take(np.flatnonzero(np.isin(contours.item, shown))), drawn],
        [one.take(np.flatnonzero(np.isin(one.item, hiding))) for one in (contours, borders)],
        doubts,
    )


RULING_CHORDS = 32
"""Chords of a ruling between which is looked for its ends."""


def _inner(sheet: ParametricSheet) -> Surface:
    """The surface of a sheet where it was not placed yet."""
    return sheet.surface.surface if isinstance(sheet.surface, PlacedSurface) else sheet.surface


def _rulings(view: View, sheets: Mapping[int, ParametricSheet]) -> Curves:
    """The contours of cylinders and cones, by their numbers: rulings, from end to end of the domain.

    The tangent plane along a ruling u contains the eye e where rise (e_x cos u + e_y sin u) = rise radius + growth e_z
    in the axes of the surface; the direction to it, of a parallel view, where radius counts for nothing.
    """
    numbers = np.array(list(sheets), dtype=np.intp)
    if not len(numbers):
        return no_curves()
    placed = [sheet.surface for sheet in sheets.values() if isinstance(sheet.surface, PlacedSurface)]
    inner = [surface.surface for surface in placed if isinstance(surface.surface, TurnedLine)]
    radius, growth, rise = np.array([(one.radius, one.growth, one.rise) for one in inner]).T
    inverse = np.array([inverse_matrix(np.asarray(one.matrix)) for one in placed])
    shift = np.array([np.asarray(one.shift) for one in placed])
    towards = np.broadcast_to((0.0, 0.0, 1.0), shift.shape) if view.eye is None else np.asarray(view.eye) - shift
    x, y, z = matmul(towards[:, None], inverse)[:, 0].T
    size = np.hypot(x, y)
    with np.errstate(all="ignore"):
        cosine = (growth * z + (0.0 if view.eye is None else rise * radius)) / (rise * size)
    on = np.flatnonzero(np.abs(cosine) < 1.0)
    middle, half = arctan2(y, x)[on], arccos(cosine[on])
    u, own = np.concatenate([middle - half, middle + half]), np.tile(on, 2)
    ends = np.array([(d.u_start, d.u_end, d.v_start, d.v_end) for d in (one.domain for one in inner)])[own]
    u = u - 2.0 * np.pi * np.floor((u - ends[:, 0]) / (2.0 * np.pi) + ON_TRIM)
    inside = np.flatnonzero(u <= ends[:, 1] + 2.0 * np.pi * ON_TRIM)
    u, own, ends = u[inside], own[inside], ends[inside]
    along = np.linspace(0.0, 1.0, RULING_CHORDS + 1)
    v = ends[:, 2:3] + along * (ends[:, 3:] - ends[:, 2:3])
    places = from_components(np.repeat(u, len(along)), v.ravel(), 0.0)
    items = np.array([sheet.item for sheet in sheets.values()], dtype=np.intp)
    families = tuple(ParameterCurves(sheet, number, degrees_along=(0, 1)) for number, sheet in sheets.items())
    stack = StackedSurfaces(tuple(placed))
    points = stack.at(np.repeat(own, len(along))).points(places[:, 0], places[:, 1])
    count = len(own)
    return Curves(
        points,
        places,
        np.full_like(places, np.nan),
        np.arange(0, len(places) + 1, len(along)),
        np.zeros(count, dtype=np.bool_),
        np.full(count, int(LineKind.CONTOUR)),
        items[own],
        own,
        np.zeros(count),
        families,
    )


def _ends_of_lines(curves: Curves, ruled: Collection[int]) -> Curves:
    """The curves, of those on some sheets, by their numbers, only the ends: they are straight."""
    kept = ~np.isin(curves.sheet, list(ruled))[curves.owner]
    kept[curves.offsets[:-1]], kept[curves.offsets[1:] - 1] = True, True
    return replace(
        curves,
        points=curves.points[kept],
        places=curves.places[kept],
        second_places=curves.second_places[kept],
        offsets=ragged.offsets(np.bincount(curves.owner[kept], minlength=len(curves))),
    )


@dataclass(frozen=True, eq=False)
class EdgeCurves:
    """The edges of bodies in the view's coordinates, use after use. Levels of curves are first rows of uses, third
    parameters of places count rows from there. sizes (n,): the rows of the use that begins there; other (n,): the first
    row of the use that is the second one of the edge, or -1."""

    points: Floats
    slopes: Floats
    places: Floats
    turns: Floats
    sizes: Ints
    other: Ints
    straight: Bools
    sheet: int = NONE
    second: int = NONE
    rational: bool = False

    def degrees(self, chords: Chords) -> Ints:
        """(k,) 1 for straight ones; else 0."""
        return self.straight[chords.level.astype(np.intp)].astype(np.intp)

    def weights(self, chords: Chords, part: Floats) -> Floats:
        """(k,) 1."""
        return np.ones(len(part))

    def between(self, chords: Chords, part: Floats) -> Along:
        """The edges at a part of their chords."""
        first = chords.level.astype(np.intp)
        start, end = (places[:, 2] for places in chords.places)
        row = start + part * (end - start)
        points, slopes = self.at(first, row)
        places = self.places_at(first, row)
        other = self.other[first]
        there = self.places_at(np.maximum(other, 0), row)
        there[other < 0] = np.nan
        return Along(places, points, slopes * (end - start)[:, None], there)

    def at(self, first: Ints, row: Floats) -> tuple[Floats, Floats]:
        """Points (k,3) at rows (k,) of uses, and their derivatives by the row."""
        return _hermite(self.points, self.slopes, *self._piece(first, row))

    def places_at(self, first: Ints, row: Floats) -> Floats:
        """(k,3) the places there: u, v and the row."""
        found, _ = _hermite(self.places, self.turns, *self._piece(first, row))
        return np.column_stack([found, row])

    def _piece(self, first: Ints, row: Floats) -> tuple[Ints, Floats]:
        """The rows (k,) at which pieces begin, and how far (k,) along these it is."""
        begin = np.clip(np.floor(row), 0, self.sizes[first] - 2)
        return first + begin.astype(np.intp), row - begin


def _hermite(values: Floats, slopes: Floats, row: Ints, x: Floats) -> tuple[Floats, Floats]:
    """The cubics with the values and slopes (n,c) of rows (k,) and the next ones, at parts x (k,); and their
    derivatives.

    Source: Hermite's interpolation; Glaeser, section 9.1, equations 1 to 3.
    """
    x = x[:, None]
    start, end, leaving, arriving = values[row], values[row + 1], slopes[row], slopes[row + 1]
    way = end - start
    bent, turned = 3.0 * way - 2.0 * leaving - arriving, leaving + arriving - 2.0 * way
    back = x - 1.0
    # From the nearer end: so both ends are met to the last bit.
    late = end + back * (arriving + back * ((arriving + arriving + leaving - 3.0 * way) + back * turned))
    early = start + x * (leaving + x * (bent + x * turned))
    return np.where(x > 0.5, late, early), leaving + x * (2.0 * bent + 3.0 * x * turned)


@dataclass(frozen=True, eq=False)
class _Uses:
    """All uses (s,) of bodies: edges and faces are counted over all of them."""

    family: EdgeCurves
    first: Ints
    edge: Ints
    sheet: Ints
    item: Ints
    kind: Ints
    turned: Bools

    @cached_property
    def of_edge(self) -> Ints:
        """(e,) how many uses each edge has."""
        return np.bincount(self.edge, minlength=len(self.kind))


def _uses(view: View, breps: Mapping[int, Brep], first_sheet: Mapping[int, int]) -> _Uses:
    """Those of bodies by the numbers of their items; first_sheet: that of the first face of each."""
    edges: list[BrepEdges] = [brep.edges for brep in breps.values()]
    items = list(breps)
    rows = ragged.starts([len(one.points) for one in edges])
    numbers = ragged.starts([len(one.kind) for one in edges])
    first = np.concatenate([one.offsets[:-1] + at for one, at in zip(edges, rows, strict=True)])
    sizes = np.concatenate([np.diff(one.offsets) for one in edges])
    edge = np.concatenate([one.edge + at for one, at in zip(edges, numbers, strict=True)])
    sheet = np.concatenate([one.face + first_sheet[item] for one, item in zip(edges, items, strict=True)])
    turned = np.concatenate(
        [np.array([f.turned for f in b.trimmed_faces], dtype=np.bool_)[b.edges.face] for b in breps.values()]
    )
    kind = np.concatenate([one.kind for one in edges])
    straight = np.concatenate([one.straight for one in edges])
    total = int(sum(len(one.points) for one in edges))
    size_at, other, straight_at = np.zeros(total, dtype=np.intp), np.full(total, NONE), np.zeros(total, dtype=np.bool_)
    size_at[first], straight_at[first] = sizes, straight[edge]
    order = np.argsort(edge, kind="stable")
    pair = np.flatnonzero((np.diff(edge[order]) == 0) & (np.bincount(edge)[edge[order][:-1]] == 2))
    one, two = first[order[pair]], first[order[pair + 1]]
    other[one], other[two] = two, one
    family = EdgeCurves(
        view.points_of(np.concatenate([e.points for e in edges])).T,
        matmul(np.concatenate([e.slopes for e in edges]), view.axes.T / view.scale),
        np.concatenate([e.places for e in edges]),
        np.concatenate([e.turns for e in edges]),
        size_at,
        other,
        straight_at,
    )
    item = np.repeat(np.array(items, dtype=np.intp), [len(one.edge) for one in edges])
    return _Uses(family, first, edge, sheet, item, kind, turned)


def _edges(
    view: View,
    breps: Mapping[int, Brep],
    first_sheet: Mapping[int, int],
    sheets: Sheets,
    wanted: Mapping[int, Collection[LineKind]],
    tracing: Tracing,
) -> tuple[Curves, Curves]:
    """The edges of bodies by the numbers of their items, each use as a border of its sheet; and those that are drawn.
    first_sheet: that of the first face of each; wanted: the kinds of lines of each that are drawn.

    An edge at which one of two faces turns away is a contour there, where contours are wanted. Seams are not drawn, but
    end the image of a sheet.
    """
    uses = _uses(view, breps, first_sheet)
    if not len(uses.first):
        return no_curves(), no_curves()
    family = uses.family
    # One use of each edge says where its points are, so that all of them have the same.
    _, leader = np.unique(uses.edge, return_index=True)
    lines = _refined(family, uses.first[leader], tracing)
    outline = _Outlines(view, sheets, uses, leader)
    rows, offsets, turned = outline.with_changes(lines)
    borders = _curves(uses, np.arange(len(uses.first)), uses.edge, rows, offsets, alone=True)
    borders = replace(borders, kind=np.full(len(borders), int(LineKind.BOUNDARY)))
    drawn = _curves(uses, leader, np.arange(len(leader)), rows, offsets, alone=False)
    kinds = _kinds(uses)
    among = np.zeros((max(breps, default=-1) + 1, len(LineKind) + 1), dtype=np.bool_)
    for item, words in wanted.items():
        among[item, [int(word) for word in words]] = True
    may_turn = (kinds == LineKind.CREASE) & among[drawn.item, int(LineKind.CONTOUR)]
    pieces = _pieces(drawn, turned & may_turn[drawn.owner])
    kind = np.where(pieces.outline, int(LineKind.CONTOUR), kinds[pieces.of])
    drawn = replace(pieces.curves, kind=kind)
    return borders, drawn.take(np.flatnonzero(among[drawn.item, kind]))


def _kinds(uses: _Uses) -> Ints:
    """(e,) what edges are drawn as; the number of kinds for those that are not."""
    nothing = len(LineKind)
    of_kind = np.array([nothing if kind is None else int(kind) for kind in DRAWN_KINDS])
    kinds = of_kind[uses.kind]
    return np.where(uses.of_edge == 1, int(LineKind.BOUNDARY), kinds)


def _refined(family: EdgeCurves, first: Ints, tracing: Tracing) -> Traces:
    """The rows at which the edges whose uses begin at rows first (e,) are divided into chords within a tolerance; along
    them stands the first row beside each."""
    sizes = family.sizes[first]
    count = np.maximum(1, -(-(sizes - 1) // ROWS_APART))
    step = ragged.place(count + 1)
    owner = ragged.owner(count + 1)
    row = step * ((sizes - 1) / count)[owner]
    last = step == count[owner]

    def image(at: Floats) -> Floats:
        points, _ = family.at(at[:, 1].astype(np.intp), at[:, 0])
        return points if tracing.picture is None else tracing.picture(points)

    whole = Traces(np.column_stack([row, first[owner].astype(np.float64)]), last)
    if tracing.tolerance is None:
        return whole
    return refined(whole, straight_between, image, tracing.tolerance, MOST_POINTS).lines


MOST_POINTS = 1 << 16
"""An edge that is not within tolerance with so many points is drawn with these."""


@dataclass(frozen=True, eq=False)
class _Outlines:
    """Where one of the two faces at an edge shows its front and the other does not; leader (e,): the use that is asked
    for each edge."""

    view: View
    sheets: Sheets
    uses: _Uses
    leader: Ints

    def there(self, edge: Ints, row: Floats) -> Bools:
        """(k,) whether edges (k,) at rows (k,) are outlines; those that have not two faces are none."""
        family, first = self.uses.family, self.uses.first[self.leader[edge]]
        points, _ = family.at(first, row)
        fronts = []
        for start in (first, np.maximum(family.other[first], 0)):
            use = np.searchsorted(self.uses.first, start)
            normals = self.sheets.normals(self.uses.sheet[use], family.places_at(start, row))
            way = sight_lines.sight(self.view, points)
            cosine = np.where(self.uses.turned[use], -1.0, 1.0) * dot(normals, way)
            fronts.append(cosine > EDGE_ON_SINE * norm(way))
        return np.asarray((fronts[0] != fronts[1]) & (family.other[first] >= 0))

    def with_changes(self, lines: Traces) -> tuple[Floats, Ints, Bools]:
        """The rows (n,) of the edges, with those at which they begin or end to be outlines; the offsets (e+1,); and
        whether (n,) chords that begin there are outlines."""
        row, last = lines.points[:, 0], lines.last
        edge = np.cumsum(np.concatenate([[0], last[:-1]])).astype(np.intp)
        at = self.there(edge, row)
        chord = np.flatnonzero(~last[:-1] & (at[1:] != at[:-1]))

        def goes_on(which: Ints, part: Floats) -> Bools:
            begin = chord[which]
            there = self.there(edge[begin], row[begin] + part * (row[begin + 1] - row[begin]))
            return np.asarray(there == at[begin])

        part, _ = bisected(goes_on, np.zeros(len(chord)), np.ones(len(chord)), HALVINGS)
        inner = (part > 0.0) & (part < 1.0)
        chord, part = chord[inner], part[inner]
        new = np.insert(row, chord + 1, row[chord] + part * (row[chord + 1] - row[chord]))
        sizes = np.bincount(edge, minlength=len(self.leader)) + np.bincount(edge[chord], minlength=len(self.leader))
        offsets = ragged.offsets(sizes)
        owner = ragged.owner(sizes)
        # In the middle of each chord: at corners faces may be seen edge-on.
        middle = 0.5 * (new + np.append(new[1:], 0.0))
        middle[offsets[1:] - 1] = new[offsets[1:] - 1]
        return new, offsets, self.there(owner, middle)


def _curves(uses: _Uses, which: Ints, edge: Ints, rows: Floats, offsets: Ints, *, alone: bool) -> Curves:
    """Uses (s,) of edges (s,) as curves; rows, offsets: of the points of each edge; alone: on their own sheet only."""
    family, first = uses.family, uses.first[which]
    index, ends = ragged.take(offsets, edge)
    row, start = rows[index], np.repeat(first, np.diff(ends))
    points, _ = family.at(start, row)
    other = np.full(len(which), NONE) if alone else family.other[first]
    there = np.full((len(row), 3), np.nan)
    second_sheet = np.full(len(which), NONE)
    if not alone:
        second = np.repeat(other, np.diff(ends))
        own = np.flatnonzero(second >= 0)
        there[own] = family.places_at(second[own], row[own])
        both = np.flatnonzero(other >= 0)
        second_sheet[both] = uses.sheet[np.searchsorted(uses.first, other[both])]
    begin, end = ends[:-1], ends[1:] - 1
    return Curves(
        points,
        family.places_at(start, row),
        there,
        ends,
        (points[begin] == points[end]).all(axis=1),
        np.zeros(len(which), dtype=np.intp),
        uses.item[which],
        np.zeros(len(which), dtype=np.intp),
        first.astype(np.float64),
        (replace(family, other=np.full(len(family.other), NONE)) if alone else family,),
        sheet=uses.sheet[which],
        second_sheet=second_sheet,
    )


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Pieces (p,) of curves, and which (p,) of these they are of; outline (p,)."""

    curves: Curves
    of: Ints
    outline: Bools


def _pieces(curves: Curves, outline: Bools) -> _Pieces:
    """The curves in pieces all of whose chords are outlines, or none; outline (n,): chords that begin at points."""
    chord = curves.chords
    owner = curves.owner[chord]
    new = np.ones(len(chord), dtype=np.bool_)
    new[1:] = (owner[1:] != owner[:-1]) | (outline[chord[1:]] != outline[chord[:-1]])
    begin = np.flatnonzero(new)
    sizes = np.diff(np.append(begin, len(chord)))
    of = owner[begin]
    index = ragged.ranges(chord[begin], sizes + 1)
    whole = np.bincount(of, minlength=len(curves))[of] == 1
    pieces = replace(
        curves.take(of),
        points=curves.points[index],
        places=curves.places[index],
        second_places=curves.second_places[index],
        offsets=ragged.offsets(sizes + 1),
        closed=curves.closed[of] & whole,
    )
    return _Pieces(pieces, of, outline[chord[begin]])
