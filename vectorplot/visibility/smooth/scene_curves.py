"""The curves of a scene's smooth surfaces, its sharp edges and curves in space as a view shows them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.cut_curve import breaks_of, degree_of, is_weighted, weights_of
from vectorplot.features.curve_tracing import Tracing
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import USUAL, Budget, unheard
from vectorplot.geometry.chord_refinement import Traces, bisected, refined, straight_between, with_standstills
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.brep import Brep
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.tolerances import SETTLED_ON_SHEET, ZERO_OF_EXTENT
from vectorplot.visibility.polyhedra.lines import items_wanting, kinds_of
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.curve_families import Along, Chords, ParameterCurves, inner_part
from vectorplot.visibility.smooth.implicit_items import curves_of_implicit
from vectorplot.visibility.smooth.intersections import SmoothSheet, beyond_near_plane, meetings
from vectorplot.visibility.smooth.lines_on_several_sheets import Stretches, no_stretches, with_other_sheets
from vectorplot.visibility.smooth.parametric_items import (
    contours_of_parametrised,
    curves_of_parametrised,
    parameter_lines_of_parametrised,
    sheets_of_items,
)
from vectorplot.visibility.smooth.sheets import ParametricSheet, Sheets, implicit_sheet
from vectorplot.visibility.smooth.traced_curves import Curves, together, with_merged_families
from vectorplot.words import LineKind

# The sharp edges at which the sheets of an item meet, as lines of their own.

HALVINGS = 60
"""Steps of halving from a chord to the place where a sheet turns away: what is left is rounding."""


@dataclass(frozen=True, eq=False)
class Rims:
    """Curves on the common border of two sheets, on which both have the same places."""

    surface: ParametricSheet
    sheet: int
    second: int

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curves at a part of their chords."""
        found = ParameterCurves(self.surface, self.sheet).between(chords, part)
        return replace(found, second_places=found.places)


def with_rims(
    view: View, sheets: tuple[SmoothSheet, ...], number: int, parts: Sequence[Curves], wanted: Collection[LineKind]
) -> list[Curves]:
    """The curves of a sheet, its borders at sharp edges cut into what is outline, a contour, and what is a crease; all
    of them creases where no contours are among the kinds that are wanted.

    An edge belongs to the first of the two sheets that meet there; that of the second one is left out.
    """
    sheet = sheets[number]
    if not isinstance(sheet, ParametricSheet) or not sheet.creases:
        return list(parts)
    result = []
    for part in parts:
        v = part.places[part.offsets[:-1], 1] if len(part) else np.zeros(0)
        along = part.places[part.offsets[1:] - 1, 1] if len(part) else v
        rim = (part.kind == LineKind.BOUNDARY) & (v == along) & np.isin(v, sheet.creases)
        result.append(part.take(np.flatnonzero(~rim)))
        own = rim & (v == sheet.surface.domain.v_end)
        if own.any():
            other = sheets[number + 1]
            assert isinstance(other, ParametricSheet)
            curves = part.take(np.flatnonzero(own))
            if LineKind.CONTOUR in wanted:
                curves = _cut(view, sheet, other, curves)
            else:
                curves = replace(curves, kind=np.full(len(curves), int(LineKind.CREASE)))
            families = tuple(Rims(sheet, family.sheet, number + 1) for family in curves.families)
            second = np.full(len(curves), number + 1)
            result.append(replace(curves, families=families, second_places=curves.places, second_sheet=second))
    return result


def _cut(view: View, one: ParametricSheet, other: ParametricSheet, curves: Curves) -> Curves:
    """Edges between two sheets, cut where one of the sheets turns away: contours where one faces the eye and the other
    does not, else creases."""

    def outline(places: Floats) -> Bools:
        return np.asarray(_faces(view, one, places) != _faces(view, other, places))

    there = outline(curves.places)
    chord = curves.chords
    chord = chord[there[chord] != there[chord + 1]]
    start, way = curves.places[chord], curves.places[chord + 1] - curves.places[chord]

    def goes_on(which: Ints, part: Floats) -> Bools:
        return np.asarray(outline(start[which] + part[:, None] * way[which]) == there[chord[which]])

    last, _ = bisected(goes_on, np.zeros(len(chord)), np.ones(len(chord)), HALVINGS)
    places = start + last[:, None] * way
    points = one.points(places)
    return _pieces(curves, chord, places, points, there)


def _faces(view: View, sheet: ParametricSheet, places: Floats) -> Bools:
    """(k,) whether a sheet shows its front at places."""
    return np.asarray(dot(sheet.normals(places), sight_lines.sight(view, sheet.points(places))) > 0.0)


def _pieces(curves: Curves, chord: Ints, places: Floats, points: Floats, outline: Bools) -> Curves:
    """The curves, cut at points of the chords that begin at chord (k,); outline (n,): where old points lie on one.

    Each cut ends a piece and begins the next one.
    """
    after = np.repeat(chord + 1, 2)
    bounds = ragged.offsets(np.diff(curves.offsets) + 2 * np.bincount(curves.owner[chord], minlength=len(curves)))
    begin = np.concatenate([bounds[:-1], chord + 2 + 2 * np.arange(len(chord))])
    turned = np.concatenate([outline[curves.offsets[:-1]], outline[chord + 1]])
    of = np.concatenate([np.arange(len(curves)), curves.owner[chord]])
    order = np.argsort(begin, kind="stable")
    of, turned = of[order], turned[order]
    whole = np.bincount(of, minlength=len(curves))[of] == 1

    def put(values: Floats, new: Floats) -> Floats:
        return np.insert(values, after, np.repeat(new, 2, axis=0), axis=0)

    return replace(
        curves.take(of),
        points=put(curves.points, points),
        places=put(curves.places, places),
        second_places=put(curves.second_places, np.full_like(places, np.nan)),
        offsets=np.append(begin[order], bounds[-1]),
        closed=curves.closed[of] & whole,
        kind=np.where(turned, int(LineKind.CONTOUR), int(LineKind.CREASE)),
    )


# Curves in space as items: sampled finely enough, and placed on the sheet on which they lie.

FIRST_CHORDS = 64

MOST_POINTS = 1 << 18
"""A curve that is not within tolerance with so many points is drawn with these."""

MOST_HALVINGS, UNEVEN = 24, 4.0
"""A chord is halved so often at most where a curve with weights is so many times faster or slower at one of its ends
than it runs on the whole."""

ROUNDS = 12


@dataclass(frozen=True, eq=False)
class SpaceCurve:
    """A curve in the view's coordinates; its places are (u, v, t): on the parametrised sheet that it lies on, if it
    does, and its own parameter."""

    view: View
    curve: Curve
    surface: SmoothSheet | None
    sheet: int
    second: int = -1

    @property
    def rational(self) -> bool:
        """Whether its pieces are quotients of polynomials."""
        return is_weighted(self.curve)

    def degrees(self, chords: Chords) -> Ints:
        """(k,) of which degree the polynomials are; 0 where it is none."""
        return np.full(len(chords.level), degree_of(self.curve), dtype=np.intp)

    def weights(self, chords: Chords, part: Floats) -> Floats:
        """(k,) what the polynomials are divided by at a part (k,) of chords."""
        start, end = (places[:, 2] for places in chords.places)
        return weights_of(self.curve, np.clip(start + part * (end - start), self.curve.start, self.curve.end))

    def between(self, chords: Chords, part: Floats) -> Along:
        """The curve at a part of its chords."""
        start, end = chords.places
        at = start + part[:, None] * (end - start)
        t = np.clip(at[:, 2], self.curve.start, self.curve.end)
        here = self.view.points_of(self.curve.points(t)).T
        slopes = matmul(self.curve.tangents(self._inside(chords, part, t)), (self.view.axes / self.view.scale).T)
        if self.surface is not None:
            at[:, :2] = onto_sheet(self.surface, here, at)[0][:, :2]
        return Along(at, here, slopes * (end - start)[:, 2:])

    def _inside(self, chords: Chords, part: Floats, t: Floats) -> Floats:
        """(k,) parameters at which derivatives are those of the piece of the curve that the chord belongs to: at breaks
        they may jump."""
        if not len(breaks_of(self.curve)):
            return t
        start, end = (places[:, 2] for places in chords.places)
        return np.asarray(start + inner_part(part) * (end - start))


def space_curve(
    view: View,
    curve: Curve,
    item: int,
    sheets: tuple[SmoothSheet, ...],
    tracing: Tracing,
    kind: LineKind = LineKind.CURVE,
) -> Curves:
    """A curve in space as one polyline of some kind; where it is not finite it is interrupted.

    A curve that lies on a parametrised sheet, all of it, is one of its curves: the sheet does not hide it from near.
    """
    t = _sampled(view, curve, tracing)
    points = view.points_of(curve.points(t)).T
    places = np.stack([np.zeros_like(t), np.zeros_like(t), t], axis=1)
    good: Bools = np.asarray(np.isfinite(points).all(axis=1))
    number, surface = -1, None
    for other, sheet in enumerate(sheets):
        if isinstance(sheet, ParametricSheet) and good.all():
            found, off = _placed(sheet, points)
            if off <= ZERO_OF_EXTENT:
                number, surface = other, sheet
                places[:, :2] = found
                break
    start = good & ~np.concatenate([[False], good[:-1]])
    first, counts = np.flatnonzero(start), np.bincount(np.cumsum(start)[good] - 1, minlength=int(start.sum()))
    long = counts > 1
    kept = good & np.repeat(True, len(good))
    kept[first[~long]] = False
    many = int(long.sum())
    return Curves(
        points[kept],
        places[kept],
        np.full((int(kept.sum()), 3), np.nan),
        ragged.offsets(counts[long]),
        np.full(many, curve.closed and bool(good.all())),
        np.full(many, int(kind)),
        np.full(many, item, dtype=np.intp),
        np.zeros(many, dtype=np.intp),
        np.zeros(many),
        (SpaceCurve(view, curve, surface, number),),
    )


def _sampled(view: View, curve: Curve, tracing: Tracing) -> Floats:
    """(k,) parameters between which chords are within tolerance, those of cusps among them."""

    def image(t: Floats) -> Floats:
        points = view.points_of(curve.points(t[:, 0])).T
        return points if tracing.picture is None else tracing.picture(points)

    # A chord across a break would cut off a corner.
    t = np.union1d(np.linspace(curve.start, curve.end, FIRST_CHORDS + 1), breaks_of(curve))
    if is_weighted(curve):
        t = _run_evenly(curve, t)
    whole = Traces(t[:, None], np.arange(len(t)) == len(t) - 1)
    finer = refined(whole, straight_between, image, tracing.tolerance or np.inf, MOST_POINTS)
    return with_standstills(finer.lines, lambda t: curve.tangents(t[:, 0])).points[:, 0]


def _run_evenly(curve: Curve, t: Floats) -> Floats:
    """(k,) the parameters, and more, between which a curve runs about as far as its speed at both ends says: where
    weights change by thousands all that is to be seen may lie in a thousandth of the parameters."""
    for _ in range(MOST_HALVINGS):
        span = np.diff(t)
        both = t[:-1] + inner_part(np.array([[0.0], [1.0]])) * span
        said = np.linalg.norm(curve.tangents(both), axis=2) * span
        way = np.linalg.norm(np.diff(curve.points(t), axis=0), axis=1)
        uneven = np.flatnonzero((said.max(axis=0) > UNEVEN * way) | (UNEVEN * said.min(axis=0) < way))
        if not len(uneven) or len(t) > MOST_POINTS:
            break
        t = np.insert(t, uneven + 1, t[uneven] + 0.5 * span[uneven])
    return t


def _placed(sheet: ParametricSheet, points: Floats) -> tuple[Floats, float]:
    """(k,2) parameters of the nearest points of a sheet, running on over seams, and the largest distance from it."""
    from scipy.spatial import cKDTree

    finite = np.flatnonzero(np.isfinite(sheet.vertices).all(axis=1))
    if not len(finite):
        return np.zeros((len(points), 2)), np.inf
    distance, nearest = cKDTree(sheet.vertices[finite]).query(points)
    side = norm(np.ptp(sheet.vertices[finite], axis=0)) / 8.0
    if float(distance.max()) > side:
        return np.zeros((len(points), 2)), np.inf
    places, off = onto_sheet(sheet, points, sheet.vertex_places[finite[nearest]])
    domain, found = sheet.surface.domain, places[:, :2].copy()
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        if closed:
            step = np.diff(found[:, axis], prepend=found[:1, axis])
            found[:, axis] += np.cumsum(-np.round(step / domain.size[axis])) * domain.size[axis]
    return found, float(off.max())


def onto_sheet(sheet: SmoothSheet, points: Floats, places: Floats) -> tuple[Floats, Floats]:
    """Places (k,3) of the points of a sheet nearest to points, from places near them, and the distances (k,)."""
    away = points - sheet.points(places)
    for _ in range(ROUNDS):
        moved = sheet.moved(places, away)
        better = np.isfinite(moved).all(axis=1) & sheet.on_sheet(moved)
        places = np.where(better[:, None], moved, places)
        away = points - sheet.points(places)
        if not (dot(away, away) > (SETTLED_ON_SHEET) ** 2).any():
            break
    return places, np.asarray(np.sqrt(dot(away, away)))


# The curves of a scene's smooth surfaces as a view shows them: those that are drawn, and the edges that hide.

WIDEST_IMAGE = 4.0
"""Images further than so many focal lengths from the principal point are not looked at closely."""

EYE_BESIDE = 8.0
"""An eye farther from the points of a sheet than this part of its size is not on it."""

HIDING = (LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.CREASE)
"""Kinds of curves behind which sheets begin."""


@dataclass(frozen=True, eq=False)
class TracedScene:
    """The sheets of all smooth items, and for each (s,) whether it may meet itself; the curves that are drawn; edges:
    the folds, borders and cuspidal edges of the sheets that hide; doubts: of what item or items,
    by name, what could not be decided; stretches: of the curves that are drawn, on further sheets."""

    sheets: Sheets
    meets_itself: Bools
    curves: Curves
    edges: Curves
    doubts: tuple[tuple[str, str], ...]
    stretches: Stretches = field(default_factory=no_stretches)

    def __len__(self) -> int:
        return len(self.curves)

    def joined(self, curves: Curves) -> TracedScene:
        """The same with more curves to draw."""
        return replace(self, curves=together([self.curves, curves]))


def scene_sheets(scene: Scene, view: View, without: Collection[int] = ()) -> tuple[SmoothSheet, ...]:
    """The sheets of all smooth items without some, given by their numbers."""
    items = [(number, item) for number, item in enumerate(scene.items) if number not in without]
    parametrised = [(item.shape, number, item.hides) for number, item in items if is_parametrised(item.shape)]
    sheets: list[SmoothSheet] = list(sheets_of_items(view, parametrised))
    if breps := breps_of(scene, without):
        from vectorplot.visibility.smooth.brep_items import sheets_of_breps

        sheets += sheets_of_breps(view, [(brep, number, scene.items[number].hides) for number, brep in breps.items()])
    sheets += [implicit_sheet(view, item.shape, n, item.hides) for n, item in items if is_implicit(item.shape)]
    return tuple(sorted(sheets, key=lambda sheet: sheet.item))


def breps_of(scene: Scene, without: Collection[int] = ()) -> dict[int, Brep]:
    """The bodies of a scene that are known by their faces, by the numbers of their items, without some."""
    bodies = {k: item.shape for k, item in enumerate(scene.items) if isinstance(item.shape, Brep)}
    return {number: body for number, body in bodies.items() if number not in without}


def traced_scene(
    scene: Scene,
    view: View,
    sheets: tuple[SmoothSheet, ...],
    kinds: frozenset[LineKind],
    tolerance: float,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
) -> TracedScene:
    """All curves of smooth items, and those that are items themselves, every point exact, chords within a tolerance in
    the image.

    budget: of the work on every item; done: is told the part of the work that is done.
    """
    tracing = tracing_of(view, tolerance, budget)
    drawn, edges, doubts = [], [], []
    breps = breps_of(scene)
    own = {
        number: sheet
        for number, sheet in enumerate(sheets)
        if isinstance(sheet, ParametricSheet) and sheet.item not in breps
    }
    contours = contours_of_parametrised(view, own, tracing, lambda part: done(part / 2.0))
    lines_of = parameter_lines_of_parametrised(scene, own, kinds, tracing)
    for number, sheet in enumerate(sheets):
        item = scene.items[sheet.item]
        if sheet.item in breps:
            continue
        wanted = kinds_of(item, kinds)
        if isinstance(sheet, ParametricSheet):
            ready = contours[number], lines_of.get(number)
            parts, unsure = curves_of_parametrised(scene, view, sheet, number, *ready, wanted, tracing)
        else:
            parts, unsure = curves_of_implicit(scene, view, sheet, number, wanted, tracing)
        doubts += [(item.name, text) for text in unsure]
        if _holds_eye(view, sheet):
            doubts.append((item.name, "the eye is on the surface: what this hides cannot be told"))
        done((1.0 + (number + 1) / (len(sheets) + 1)) / 2.0)
        lines = with_rims(view, sheets, number, parts, wanted)
        drawn += _of_kinds(lines, wanted)
        if item.hides:
            edges += _of_kinds(parts, HIDING)
    all_sheets = Sheets(sheets)
    if breps:
        from vectorplot.visibility.smooth.brep_items import curves_of_breps

        found = curves_of_breps(scene, view, breps, all_sheets, kinds, tracing)
        drawn += found[0]
        edges += found[1]
        doubts += found[2]
    wants = items_wanting(LineKind.INTERSECTION, scene, kinds)
    met = meetings(scene, view, sheets, wants, tracing)
    doubts += met.doubts
    for number, item in enumerate(scene.items):
        wanted = kinds_of(item, kinds) & {LineKind.CURVE, LineKind.LABEL, LineKind.CENTRE, LineKind.TRACE}
        if is_curve(item.shape) and wanted:
            drawn.append(space_curve(view, item.shape, number, sheets, tracing, min(wanted)))
    seen = [_with_images(view, beyond_near_plane(view, together(parts))) for parts in ([*drawn, met.curves], edges)]
    curves, hiding = with_merged_families(seen, all_sheets)
    curves, stretches = with_other_sheets(curves, hiding, all_sheets)
    return TracedScene(all_sheets, met.meets_itself, curves, hiding, tuple(dict.fromkeys(doubts)), stretches)


def _holds_eye(view: View, sheet: SmoothSheet) -> bool:
    """Whether the eye lies on a parametrised sheet."""
    if view.eye is None or not isinstance(sheet, ParametricSheet) or not len(sheet.vertices):
        return False
    away = norm(sheet.vertices - view.eye)
    nearest = int(np.nan_to_num(away, nan=np.inf).argmin())
    if not away[nearest] <= norm(np.nanmax(sheet.vertices, axis=0) - np.nanmin(sheet.vertices, axis=0)) / EYE_BESIDE:
        return False
    _, off = onto_sheet(sheet, np.asarray(view.eye)[None], sheet.vertex_places[[nearest]])
    return bool(off[0] <= ZERO_OF_EXTENT)


def _of_kinds(parts: Sequence[Curves], kinds: Collection[LineKind]) -> list[Curves]:
    """What there is of some kinds in each of the parts that have any."""
    among = np.zeros(len(LineKind), dtype=np.bool_)
    among[list(kinds)] = True
    chosen = [(part, among[part.kind]) for part in parts if len(part)]
    return [part if wanted.all() else part.take(np.flatnonzero(wanted)) for part, wanted in chosen if wanted.any()]


def tracing_of(view: View, tolerance: float, budget: Budget = USUAL) -> Tracing:
    """How curves are traced whose chords are to be within a tolerance in the image."""
    return Tracing(tolerance=tolerance, picture=lambda points: _picture(view, points), budget=budget)


def _with_images(view: View, curves: Curves) -> Curves:
    """The curves but for those that run along sight rays, such as rulings seen end-on: their images are points."""
    if not len(curves):
        return curves
    image, first = _picture(view, curves.points), curves.offsets[:-1]
    extent = np.maximum.reduceat(image, first) - np.minimum.reduceat(image, first)
    return curves.take(np.flatnonzero((extent > view.tolerance).any(axis=1)))


def _picture(view: View, points: Floats) -> Floats:
    """(k,2) images, those far out of every picture drawn in."""
    limit = WIDEST_IMAGE * view.focus
    return np.clip(sight_lines.image(view, points), -limit, limit)
