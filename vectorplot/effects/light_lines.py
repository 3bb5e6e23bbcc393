"""Lines between light and dark: terminators, along which shapes turn away from lamps, and the edges of shadows.

A lamp sees what it lights. So its outlines, as hidden lines of a picture with the lamp for an eye leave them, are all
that is needed: a contour of this picture is a terminator, and each piece of an outline, thrown on along the rays of
light to what they meet first behind it, is the edge of a shadow. On faces it is thrown by planes through the lamp,
exactly; on smooth surfaces ray by ray, and what lies between two rays is looked for until it is flat on the page.
Source: Glaeser, sections 5.2 and 6.3; the decisions are this package's own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.shadow_casters import (
    FacePlanes,
    LightSystem,
    LightView,
    light_boxes,
    light_system,
    light_views,
)
from vectorplot.features.conditions import CentralContour, ImplicitCentralContour, ImplicitIsophote, Isophote
from vectorplot.features.surface_singularities import through_pinch_points
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.budget import USUAL, Budget, in_turn, unheard
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.component_arrays import cross
from vectorplot.geometry.component_arrays import dot as column_dot
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import all_finite, dot, norm
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.tolerances import (
    AWAY_FROM_LIT_ENDS,
    BEHIND_OUTLINE,
    BEHIND_SMOOTH_OUTLINE,
    BESIDE_OUTLINE,
    BESIDE_SMOOTH_OUTLINE,
    FINEST_RAY_STEP,
    LEAST_DIVISOR,
    LEAST_RAY_STEP,
    MET_OF_EXTENT,
    TOUCHING_OF_EXTENT,
)
from vectorplot.visibility.polyhedra.hidden_lines import Segments, visible_parts
from vectorplot.visibility.polyhedra.lines import Lines, items_wanting, joined_lines, straight_lines
from vectorplot.visibility.projected_faces import ProjectedFaces
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.curve_families import (
    ConditionCurves,
    Family,
    NearChords,
    ParameterCurves,
    SpatialCurves,
)
from vectorplot.visibility.smooth.rays import Balls, Targets, meetings_along, targets_of
from vectorplot.visibility.smooth.scene_curves import Rims, tracing_of
from vectorplot.visibility.smooth.sheets import ImplicitSheet, ParametricSheet, Sheets
from vectorplot.visibility.smooth.traced_curves import Curves, no_curves, together, with_merged_families
from vectorplot.words import LineKind

OUTLINES = (LineKind.CONTOUR, LineKind.BOUNDARY)
"""The lines in which the image of a thing ends."""


@dataclass(frozen=True, eq=False)
class LampPicture:
    """What a lamp sees of a scene: the visible parts of the outlines of all items; the faces in its image, which items
    (i,) are solid, and the smooth surfaces, in the order of the scene."""

    parts: Lines
    faces: ProjectedFaces
    solid: Bools
    sheets: Sheets


SeenFrom = Callable[[View, Floats, bool], LampPicture]
"""What is seen in a view on the positive side of planes (p,4); with contours of polyhedra that stand for smooth shapes
across their faces, or all along edges."""


@dataclass(frozen=True, eq=False)
class LightLines:
    """Lines between light and dark in the view's coordinates: those on polyhedra, and those on smooth surfaces."""

    straight: Lines
    curves: Curves

    def __len__(self) -> int:
        return len(self.straight) + len(self.curves)


def light_lines(
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    sheets: Sheets,
    lamps: Sequence[Light],
    kinds: frozenset[LineKind],
    seen_from: SeenFrom,
    tolerance: float,
    budget: Budget = USUAL,
) -> LightLines:
    """The terminators of the items that want them, and the edges of shadows on those that want these.

    view: of the eye; faces, sheets: of the scene in it; kinds: unless an item has its own; tolerance: how far chords
    may be off their curves, in the image.
    """
    straight, curves = [], [no_curves()]
    wanted = {kind: items_wanting(kind, scene, kinds) for kind in (LineKind.TERMINATOR, LineKind.SHADOW)}
    opaque = np.array([item.material.opacity >= 1.0 for item in scene.items], dtype=np.bool_)
    across = np.array([item.curves.smooth_contours for item in scene.items], dtype=np.bool_)
    casts = np.array([item.casts_shadow for item in scene.items], dtype=np.bool_)
    eye = _Eye(view, faces, sheets, tolerance, budget)
    for place, lamp in in_turn(enumerate(lamps)):
        system = light_system(replace(view, points=eye.reached), _as_sun(view, lamp))
        for number, light_view in enumerate(light_views(view, system)):
            planes = light_view.planes.copy()
            # All but the near plane are sides of a window: what runs along one is in both images that share it.
            planes[1:, 3] -= BESIDE_OUTLINE
            seen = replace(light_view.view, occludes=casts)
            rays = _Rays(light_view, system, number, seen_from(seen, planes, False))
            outlines = rays.outlines
            turning = wanted[LineKind.TERMINATOR] & ~across
            found = [_terminators(eye, rays, rays.ending(outlines.take(_contours_of(outlines, turning))))]
            if (wanted[LineKind.TERMINATOR] & across).any():
                smooth_ones = seen_from(seen, planes, True).parts
                smooth_ones = smooth_ones.take(_contours_of(smooth_ones, wanted[LineKind.TERMINATOR] & across))
                found.append(_terminators(eye, rays, smooth_ones))
            casting, on = outlines.take(casts[outlines.item]), wanted[LineKind.SHADOW] & opaque
            if len(casting) and on.any():
                found.append((_on_faces(eye, rays, casting, on), _on_sheets(eye, rays, casting, on)))
            for plain, smooth in found:
                straight.append(replace(plain, lamp=np.full(len(plain), place)))
                curves.append(replace(smooth, lamp=np.full(len(smooth), place)))
    # Shadows of all lamps on sheets that are asked as one are asked as one.
    return LightLines(joined_lines(straight), *with_merged_families([together(curves)], sheets))


FAR_LAMP = 1e7
"""A lamp so many times as far away as the scene is large has parallel rays: they turn by less than a line is wide, and
the digits that its distance takes from places are missed more."""


def _as_sun(view: View, lamp: Light) -> Light:
    """The lamp, with parallel rays where it is very far away."""
    away = (np.asarray(lamp.position, dtype=np.float64) - view.centre) / view.scale
    if lamp.parallel or not np.isfinite(away).all() or np.abs(away).max() < FAR_LAMP:
        return lamp
    x, y, z = (away / np.abs(away).max()).tolist()
    return replace(lamp, position=(x, y, z), parallel=True)


def _contours_of(lines: Lines, items: Bools) -> Bools:
    """(n,) which lines are contours of some items (i,)."""
    return np.asarray((lines.kind == LineKind.CONTOUR) & items[lines.item])


@dataclass(frozen=True, eq=False)
class _Eye:
    """Who looks: the view, its faces and sheets, the tolerance in the image, and the budget."""

    view: View
    faces: ProjectedFaces
    sheets: Sheets
    tolerance: float
    budget: Budget

    @cached_property
    def picture(self) -> Callable[[Floats], Floats]:
        """Images (k,2) of points (k,3)."""
        found = tracing_of(self.view, self.tolerance, self.budget).picture
        assert found is not None
        return found

    @cached_property
    def reached(self) -> Floats:
        """(3,n) points of the view all around which the scene is."""
        vertices = np.concatenate([self.view.points, *(sheet.vertices.T for sheet in self.sheets)], axis=1)
        return np.asarray(vertices[:, np.isfinite(vertices).all(axis=0)])

    @cached_property
    def implicit(self) -> Bools:
        """(s+1,) which sheets have points for places; the last one is none."""
        return np.array([*(not isinstance(sheet, ParametricSheet) for sheet in self.sheets), False], dtype=np.bool_)

    @cached_property
    def periods(self) -> Floats:
        """(s,3) after how much of their parameters sheets come back to themselves, infinite where they do not."""
        result = np.full((len(self.sheets), 3), np.inf)
        for number, sheet in enumerate(self.sheets):
            if isinstance(sheet, ParametricSheet):
                domain = sheet.surface.domain
                closed = np.array([domain.closed_u, domain.closed_v])
                result[number, :2] = np.where(closed, domain.size, np.inf)
        return result


# Rays of light, and the outlines that they graze.


@dataclass(frozen=True, eq=False)
class _Rays:
    """The rays of a lamp in one of its images, the one with this number, and what it sees there."""

    light_view: LightView
    system: LightSystem
    number: int
    picture: LampPicture

    @property
    def view(self) -> View:
        """The lamp's."""
        return self.picture.faces.view

    def to_eye(self, points: Floats) -> Floats:
        """(k,3) points of the lamp's view in that of the eye."""
        return matmul(points, self.light_view.turn)

    def towards(self, points: Floats) -> Floats:
        """(k,3) unit vectors from points (k,3) to the lamp."""
        way = sight_lines.sight(self.view, points)
        return np.asarray(way / np.maximum(norm(way), LEAST_DIVISOR)[:, None])

    @cached_property
    def targets(self) -> Targets:
        """The smooth surfaces that light may meet."""
        return targets_of(self.view, self.picture.sheets)

    @cached_property
    def balls(self) -> Balls:
        """Those of them that are met in closed form, and all others."""
        return Balls.of(self.picture.sheets, self.targets)

    @cached_property
    def open_items(self) -> Ints:
        """The items of which smooth surfaces have borders: both of their sides may be lit, and be seen."""
        chords = self.picture.parts.chords
        if chords is None:
            return np.zeros(0, dtype=np.intp)
        return np.unique(chords.curves.item[chords.curves.kind == LineKind.BOUNDARY])

    def outwards(self, lines: Lines) -> Floats:
        """(k,3) unit vectors across lines and rays, to the side of outlines where nothing of their surface is; zero for
        lines that are no outline, or run along a ray."""
        middle = 0.5 * (lines.start + lines.end).T
        towards = self.towards(middle)
        across = np.cross((lines.end - lines.start).T, towards)
        long = norm(across)
        ends_on = long <= TOUCHING_OF_EXTENT * norm((lines.end - lines.start).T)
        side = np.where(ends_on, 0, lines.sides(self.view))
        return np.asarray(side[:, None] * across / np.maximum(long, LEAST_DIVISOR)[:, None])

    @cached_property
    def outlines(self) -> Lines:
        """The lines to one side of which there is nothing of their surface."""
        lines = self.picture.parts
        return lines.take((norm(self.outwards(lines)) > 0.0) & np.isin(lines.kind, OUTLINES))

    def ending(self, lines: Lines) -> Lines:
        """The parts of outlines at which light ends: what they belong to is lit beside them, and behind them nothing
        is."""
        return self._free(self._free(lines, 1.0), -1.0)

    def _free(self, lines: Lines, side: float) -> Lines:
        """The parts of outlines that no face hides from the lamp a little within them and before them, or with side -1
        beyond and behind."""
        if not len(lines) or not len(self.picture.faces):
            return lines
        towards = self.towards(0.5 * (lines.start + lines.end).T)
        off = side * (BEHIND_OUTLINE * towards - BESIDE_OUTLINE * self.outwards(lines)).T
        segments = Segments(lines.start + off, lines.end + off)
        seen = visible_parts(self.view, self.picture.faces, self.picture.solid, segments, unheard)
        # What a line ends at hides its last bit.
        bit = ENDS_OF_OUTLINES * BEHIND_OUTLINE / np.maximum(norm((lines.end - lines.start).T), LEAST_DIVISOR)
        bit = bit[seen.segment]
        low, high = np.where(seen.low < bit, 0.0, seen.low), np.where(seen.high > 1.0 - bit, 1.0, seen.high)
        return lines.cut(self.view, seen.segment, low, high)


ENDS_OF_OUTLINES = 4.0
"""So many times as long as the way behind outlines a bit of a line at its end is no bit of its own."""


def _at(lines: Lines, which: Ints, part: Floats) -> Floats:
    """(k,3) the points at parts (k,) of lines which (k,), on the curves that these are chords of."""
    start, end = lines.start.T[which], lines.end.T[which]
    points = start + part[:, None] * (end - start)
    if lines.chords is None:
        return points
    chord = lines.chords.chord[which]
    own = np.flatnonzero(chord >= 0)
    begin, stop = lines.chords.begin[which[own]], lines.chords.end[which[own]]
    points[own] = lines.chords.curves.at(chord[own], begin + part[own] * (stop - begin)).points
    return points


# Terminators: the contours that a lamp sees.


def _terminators(eye: _Eye, rays: _Rays, lines: Lines) -> tuple[Lines, Curves]:
    """Contours at which light ends, those of polyhedra and those of smooth surfaces."""
    smooth = np.zeros(len(lines), dtype=np.bool_) if lines.chords is None else lines.chords.chord >= 0
    plain = lines.take(~smooth)
    kind = np.full(len(plain), int(LineKind.TERMINATOR))
    start, end = (rays.to_eye(side.T).T for side in (plain.start, plain.end))
    straight = replace(straight_lines(start, end, kind, plain.item, np.zeros_like(kind)), smooth=plain.smooth)
    chords = lines.take(smooth).chords
    if chords is None:
        return straight, no_curves()
    curves = _parts_of(chords.curves, chords.chord, chords.begin, chords.end)
    return straight, _finer(eye, _in_eye(eye, rays, curves, LineKind.TERMINATOR, _turning))


def _turning(eye: _Eye, rays: _Rays, number: int, second: int) -> Family:
    """The curves of a sheet along which it turns away from a lamp; its rim where there is a second sheet."""
    sheet, system = eye.sheets[number], rays.system
    if not isinstance(sheet, ParametricSheet):
        assert isinstance(sheet, ImplicitSheet)
        of_implicit = ImplicitIsophote if system.parallel else ImplicitCentralContour
        return SpatialCurves(sheet, number, of_implicit(sheet.surface, system.position))
    if second >= 0:
        return Rims(sheet, number, second)
    of_surface = Isophote if system.parallel else CentralContour
    turn = through_pinch_points(of_surface(sheet.whole.surface, system.position))
    return ConditionCurves(sheet.whole, number, turn)


MOST_ROUNDS = 12
"""Chords are halved so often at most."""


def _finer(eye: _Eye, curves: Curves) -> Curves:
    """The curves with more points where their chords are off them by more than the tolerance in the image."""
    doubtful = curves.chords
    for _ in range(MOST_ROUNDS):
        middle = curves.at(doubtful, np.full(len(doubtful), 0.5))
        straight = 0.5 * (curves.points[doubtful] + curves.points[doubtful + 1])
        off = norm(eye.picture(middle.points) - eye.picture(straight))
        some = np.flatnonzero(off > eye.tolerance)
        if not len(some):
            break
        after, new = doubtful[some] + 1, middle.take(some)
        offsets = curves.offsets + np.concatenate(
            [[0], np.cumsum(np.bincount(curves.owner[after], minlength=len(curves)))]
        )
        put = [
            np.insert(old, after, values, axis=0)
            for old, values in (
                (curves.points, new.points),
                (curves.places, new.places),
                (curves.second_places, new.second_places),
            )
        ]
        curves = replace(curves, points=put[0], places=put[1], second_places=put[2], offsets=offsets)
        begin = doubtful[some] + np.arange(len(some))
        doubtful = np.sort(np.concatenate([begin, begin + 1]))
    return curves


# The edges of shadows on faces: planes through the lamp and an edge meet them in segments.

PIECES = 16
"""Lines are looked at in pieces no longer than this part of a unit, of which the scene is two wide: their boxes hold
little else."""

PAIRS_AT_ONCE = 1 << 18


@dataclass(frozen=True, eq=False)
class _Thrown(Elements):
    """Parts of lines thrown on faces: which line and face (k,), from where to where, low and high (k,)."""

    line: Ints
    face: Ints
    low: Floats
    high: Floats


def _on_faces(eye: _Eye, rays: _Rays, lines: Lines, items: Bools) -> Lines:
    """The edges of shadows that outlines throw on the faces of some items (i,)."""
    faces = rays.picture.faces
    view = faces.view
    sides = eye.faces.sides[view.face_item]
    # Of what is closed its outside is lit, and seen; of all else what the lamp and the eye look at from one side.
    turned = faces.facing * np.where(sides != 0, sides, eye.faces.facing) > 0
    which = np.flatnonzero(turned & items[view.face_item])
    if not len(which):
        return joined_lines(())
    thrown = _thrown(eye, rays, lines, which)
    thrown = records.take(thrown, thrown.low < thrown.high)
    thrown = _before_sheets(rays, lines, _before_faces(rays, lines, thrown))
    start, end = _ends(rays, lines, thrown)
    item = view.face_item[thrown.face]
    none = np.zeros(len(item), dtype=np.intp)
    return straight_lines(rays.to_eye(start).T, rays.to_eye(end).T, none + int(LineKind.SHADOW), item, none)


def _ends(rays: _Rays, lines: Lines, thrown: _Thrown, beside: float = 0.0) -> tuple[Floats, Floats]:
    """(k,3) where what is thrown on faces begins and ends, of lines so far outwards."""
    planes = FacePlanes.of(rays.view).planes[:, thrown.face]
    off = beside * rays.outwards(lines)[thrown.line]
    start, end = (
        _cast(rays, _straight_at(lines, thrown.line, part) + off, planes) for part in (thrown.low, thrown.high)
    )
    return start, end


def _before_faces(rays: _Rays, lines: Lines, thrown: _Thrown) -> _Thrown:
    """The parts of what is thrown on faces that no other face keeps from the light."""
    start, end = _ends(rays, lines, thrown, BESIDE_OUTLINE)
    good = np.flatnonzero(np.isfinite(np.concatenate([start, end], axis=1)).all(axis=1))
    thrown, start, end = records.take(thrown, good), start[good], end[good]
    segments = Segments(np.ascontiguousarray(start.T), np.ascontiguousarray(end.T))
    seen = visible_parts(rays.view, rays.picture.faces, rays.picture.solid, segments, unheard)
    larger = np.ones(len(thrown.line))
    if rays.view.eye is not None:
        begin, stop = (_straight_at(lines, thrown.line, part) for part in (thrown.low, thrown.high))
        larger = _times_as_far(rays, end, stop) / _times_as_far(rays, start, begin)
    of = records.take(thrown, seen.segment)
    larger, span = larger[seen.segment], of.high - of.low
    # Thrown from near by, equal parts of a line are no equal parts of its shadow.
    low, high = (_on_line(part, larger) for part in (seen.low, seen.high))
    return replace(of, low=of.low + low * span, high=np.where(seen.high < 1.0, of.low + high * span, of.high))


def _on_line(part: Floats, larger: Floats) -> Floats:
    """(k,) which parts of lines throw parts of their shadows, whose ends are so many times as far from the lamp.
    Source: central projection keeps cross ratios."""
    return np.asarray(part * larger / (1.0 - part + part * larger))


def _times_as_far(rays: _Rays, there: Floats, here: Floats) -> Floats:
    """(k,) how many times as far places are from the lamp as others on their rays."""
    assert rays.view.eye is not None
    return np.asarray(norm(there - rays.view.eye) / np.maximum(norm(here - rays.view.eye), LEAST_DIVISOR))


def _straight_at(lines: Lines, which: Ints, part: Floats) -> Floats:
    start, end = lines.start.T[which], lines.end.T[which]
    return np.asarray(start + part[:, None] * (end - start))


def _cast(rays: _Rays, points: Floats, planes: Floats) -> Floats:
    """(k,3) where the rays through points (k,3) meet planes (4,k)."""
    normal, constant, eye = planes[:3].T, planes[3], rays.view.eye
    with np.errstate(all="ignore"):
        if eye is None:
            towards = rays.towards(points)
            height = dot(normal, points) - constant
            return np.asarray(points - towards * (height / dot(normal, towards))[:, None])
        way = points - eye
        return np.asarray(eye + way * ((constant - matmul(normal, eye)) / dot(normal, way))[:, None])


def _thrown(eye: _Eye, rays: _Rays, lines: Lines, faces: Ints) -> _Thrown:
    """The parts of lines that the lamp sees before some faces."""
    system, tolerance = rays.system, rays.view.tolerance
    boxes = light_boxes(eye.view, system, faces)[rays.number]
    count = np.clip(np.ceil(PIECES * norm((lines.end - lines.start).T)), 1, PIECES * PIECES).astype(np.intp)
    line, step = ragged.owner(count), 1.0 / np.repeat(count, count)
    seen = [_in_box(rays, _straight_at(lines, line, (ragged.place(count) + k) * step)) for k in (0, 1)]
    low, high = np.minimum(*seen) - 2.0 * BESIDE_OUTLINE, np.maximum(*seen) + 2.0 * BESIDE_OUTLINE
    nearest, farthest = boxes.box[4], boxes.box[5]
    high[2] = max(float(farthest.max(initial=0.0)), float(high[2].max(initial=0.0)))
    other_low = np.stack([*boxes.box[[0, 2]], nearest]) - tolerance
    other_high = np.stack([*boxes.box[[1, 3]], farthest]) + tolerance
    piece, box = overlapping_boxes(low, high, other_low, other_high)
    pair = np.unique(line[piece] * (len(faces) + 1) + boxes.which[box])
    of, number = np.divmod(pair, len(faces) + 1)
    return _clipped(rays, lines, of, faces[number])


def _in_box(rays: _Rays, points: Floats) -> Floats:
    """(3,k) points (k,3) of the lamp's view as boxes of faces in its image have them."""
    system = rays.system
    x, y, depth = matmul(
        system.axes[rays.number], rays.to_eye(points).T - (0.0 if system.parallel else system.position[:, None])
    )
    return np.stack([x, y, depth] if system.parallel else [x / depth, y / depth, depth])


def _clipped(rays: _Rays, lines: Lines, line: Ints, face: Ints) -> _Thrown:
    """The parts of lines (k,) in the cones of rays through faces (k,), on the lamp's side of these."""
    view = rays.view
    facing = rays.picture.faces.facing[face].astype(np.float64)
    planes = FacePlanes.of(view).planes[:, face]
    start, end = lines.start[:, line], lines.end[:, line]
    heights = [facing * (column_dot(planes[:3], point) - planes[3]) - TOUCHING_OF_EXTENT for point in (start, end)]
    low, high = _kept(*heights)
    position, offsets = ragged.take(view.offsets, face)
    for first, last in ragged.batches(np.diff(offsets), PAIRS_AT_ONCE):
        corner = position[offsets[first] : offsets[last]]
        own = first + ragged.owner(np.diff(offsets[first : last + 1]))
        here = view.points[:, view.corners[corner]]
        along = view.points[:, view.corners[view.after(corner)]] - here
        normal = -cross(along, sight_lines.sight(view, here.T).T) * facing[own]
        one, two = (column_dot(normal, side[:, own] - here) for side in (start, end))
        enter, leave = _kept(one, two)
        begins = offsets[first:last] - offsets[first]
        low[first:last] = np.maximum(low[first:last], np.maximum.reduceat(enter, begins))
        high[first:last] = np.minimum(high[first:last], np.minimum.reduceat(leave, begins))
    return _Thrown(line, face, low, high)


def _kept(one: Floats, two: Floats) -> tuple[Floats, Floats]:
    """Where heights that grow evenly from one to two (k,) are not negative, from 0 to 1; low > high: nowhere."""
    crossing = (one < 0.0) != (two < 0.0)
    where = one / np.where(crossing, one - two, 1.0)
    low, high = np.where(crossing & (one < 0.0), where, 0.0), np.where(crossing & (two < 0.0), where, 1.0)
    return low, np.where((one < 0.0) & (two < 0.0), -1.0, high)


# What smooth surfaces get of the rays that graze outlines, and what they keep from faces behind them.

FAR_BEHIND = 8.0
"""A way that leads out of every scene, which is 2 wide in a view."""

RAYS = 64
"""So many rays on a unit are met with smooth surfaces, of which the scene is two wide, before it is looked closer."""

MOST_PLACES = 1 << 18
"""So many places are looked at for one lamp, about; with so many, shadows have the places that are found."""

FEW, PARTS_OF_FEW = 128, 16
"""So few parts of lines are cut into so many at a time, where more are halved."""

STEPS = 4
"""Steps of Newton from a ray beside an outline to the one that grazes it."""

HALVINGS = 40
"""A part of a line is halved so often where what its rays meet changes."""


def _before_sheets(rays: _Rays, lines: Lines, thrown: _Thrown) -> _Thrown:
    """The parts of what is thrown on faces that no smooth surface keeps from the light."""
    if not len(rays.targets) or not len(thrown.line):
        return thrown
    planes = FacePlanes.of(rays.view).planes[:, thrown.face]
    out = rays.outwards(lines)[thrown.line]
    span = thrown.high - thrown.low

    def lit(which: Ints, part: Floats) -> Bools:
        points = _at(lines, thrown.line[which], thrown.low[which] + part * span[which])
        points = _cast(rays, points + BESIDE_SMOOTH_OUTLINE * out[which], planes[:, which])
        met = meetings_along(rays.view, rays.picture.sheets, points, rays.balls)
        long = norm(sight_lines.sight(rays.view, points))
        free = np.ones(len(which), dtype=np.bool_)
        free[met.sample[met.t * long[met.sample] > BEHIND_SMOOTH_OUTLINE]] = False
        return free

    start, end = _ends(rays, lines, thrown)
    count = np.clip(np.ceil(2.0 * PIECES * norm(end - start)), 2, PIECES * PIECES).astype(np.intp)
    own = ragged.owner(count + 1)
    part = np.clip(ragged.place(count + 1) / count[own], AWAY_FROM_LIT_ENDS, 1.0 - AWAY_FROM_LIT_ENDS)
    free = lit(own, part)
    changes = np.flatnonzero((own[1:] == own[:-1]) & (free[1:] != free[:-1]))
    begun = free[changes]
    last, _ = bisected(
        lambda which, at: lit(own[changes[which]], at) == begun[which], part[changes], part[changes + 1], HALVINGS
    )
    # A lit part begins with its line or where dark ends, and ends where light does or with its line.
    first, final = np.flatnonzero(ragged.place(count + 1) == 0), np.cumsum(count + 1) - 1
    begins = [first[free[first]], changes[~begun]]
    stops = [final[free[final]], changes[begun]]
    low = np.concatenate([np.zeros(len(begins[0])), last[~begun]])
    high = np.concatenate([np.ones(len(stops[0])), last[begun]])
    order, other = (np.argsort(np.concatenate(each), kind="stable") for each in (begins, stops))
    of = own[np.concatenate(begins)[order]]
    low, high = thrown.low[of] + low[order] * span[of], thrown.low[of] + high[other] * span[of]
    return _Thrown(thrown.line[of], thrown.face[of], low, high)


@dataclass(frozen=True, eq=False)
class _Met(Elements):
    """Where rays that graze outlines, through parts of lines (k,), meet the nearest smooth surface behind these: line,
    part (k,); sheet (k,), -1 where there is none, and drawn (k,), whether light ends there on a side that is seen;
    places and points (k,3) there, in the lamp's view."""

    line: Ints
    part: Floats
    sheet: Ints
    drawn: Bools
    places: Floats
    points: Floats

    def __len__(self) -> int:
        return len(self.line)


def _met(eye: _Eye, rays: _Rays, lines: Lines, out: Floats, items: Bools, line: Ints, part: Floats) -> _Met:
    """What the rays through parts (k,) of lines (k,) meet; out (n,3): outwards of all lines; items (i,): on which edges
    of shadows are drawn."""
    view, sheets = rays.view, rays.picture.sheets
    grazed = _at(lines, line, part)
    # A little beside the outline the ray does not touch what throws the shadow, and meets the same behind it.
    beside = grazed + BESIDE_SMOOTH_OUTLINE * out[line]
    towards = rays.towards(beside)
    found = meetings_along(view, sheets, beside - FAR_BEHIND * towards, rays.balls)
    behind = dot(beside[found.sample] - sheets.points(found.number, found.places), towards[found.sample])
    # Where something touches another item light ends there, and goes on to nothing within that.
    other = sheets.item[found.number] != lines.item[line[found.sample]]
    touching = found.sample[other & (np.abs(behind) <= BEHIND_SMOOTH_OUTLINE)]
    kept = np.flatnonzero((behind > BEHIND_SMOOTH_OUTLINE) & ~np.isin(found.sample, touching))
    order = kept[np.lexsort((behind[kept], found.sample[kept]))]
    sample, first = np.unique(found.sample[order], return_index=True)
    number, at = found.number[order[first]], found.places[order[first]]
    points, towards = grazed[sample], rays.towards(grazed[sample])
    for _ in range(STEPS):
        _, moved, _ = sheets.missed(number, points, towards, at)
        at = np.where(all_finite(moved)[:, None], moved, at)
    on = sheets.points(number, at)
    # Beyond the fold of a sheet only the ray beside the outline meets it.
    hit = np.flatnonzero(norm(np.cross(on - points, towards)) <= MET_OF_EXTENT * (1.0 + norm(on - points)))
    sample, number, at, on, towards = sample[hit], number[hit], at[hit], on[hit], towards[hit]
    item = sheets.item[number]
    normals = sheets.normals(number, at)
    sight = matmul(sight_lines.sight(eye.view, rays.to_eye(on)), rays.light_view.turn.T)
    same = (dot(normals, towards) > 0.0) == (dot(normals, sight) > 0.0)
    result = _Met(
        line,
        part,
        np.full(len(line), -1),
        np.zeros(len(line), dtype=np.bool_),
        np.zeros((len(line), 3)),
        np.full((len(line), 3), np.nan),
    )
    result.sheet[sample], result.places[sample], result.points[sample] = number, at, on
    result.drawn[sample] = items[item] & (same | ~np.isin(item, rays.open_items))
    return result


def _on_sheets(eye: _Eye, rays: _Rays, lines: Lines, items: Bools) -> Curves:
    """The edges of shadows that outlines throw on the smooth surfaces of some items (i,)."""
    if not len(rays.targets) or not items[rays.picture.sheets.item].any():
        return no_curves()
    chord = np.full(len(lines), -1) if lines.chords is None else lines.chords.chord
    lines = lines.take(
        np.argsort(chord, kind="stable") if lines.chords is None else np.lexsort((lines.chords.begin, chord))
    )
    count = np.clip(np.ceil(RAYS * norm((lines.end - lines.start).T)), 1, RAYS * RAYS).astype(np.intp)
    line, out = ragged.owner(count + 1), rays.outwards(lines)
    met = _met(eye, rays, lines, out, items, line, ragged.place(count + 1) / count[line])
    todo = _worth(met, np.arange(len(line) - 1))
    while len(left := np.flatnonzero(todo)) and len(todo) < MOST_PLACES:
        # Few rays take as long as many.
        parts = PARTS_OF_FEW if len(left) <= FEW else 2
        step, of = (met.part[left + 1] - met.part[left]) / parts, np.repeat(np.arange(len(left)), parts - 1)
        at = met.part[left[of]] + (1 + np.arange(len(of)) % (parts - 1)) * step[of]
        inner = _met(eye, rays, lines, out, items, met.line[left[of]], at)
        middle = inner.take(np.arange(parts // 2 - 1, len(of), parts - 1))
        split = ~_flat(eye, rays, met, left, middle)
        before = left[of][split[of]] + 1
        todo[left] = split
        todo = np.insert(todo, before, True)
        met = _inserted(met, before, inner.take(split[of]))
        todo &= _worth(met, np.arange(len(todo)))
    return _in_eye(eye, rays, _runs(eye, rays, lines, out, met), LineKind.SHADOW, _thrown_in_eye)


def _worth(met: _Met, left: Ints) -> Bools:
    """(k,) whether something is drawn, or changes, between places left (k,) and those after them on their line, and
    these are no place on one ray."""
    one, two = met.take(left), met.take(left + 1)
    some = one.drawn | two.drawn | (one.sheet != two.sheet)
    return np.asarray(some & (one.line == two.line) & (two.part - one.part > FINEST_RAY_STEP))


def _inserted(met: _Met, before: Ints, new: _Met) -> _Met:
    """The same with others before some of them."""
    rows = {f.name: np.insert(getattr(met, f.name), before, getattr(new, f.name), axis=0) for f in fields(met)}
    return replace(met, **rows)


def _flat(eye: _Eye, rays: _Rays, met: _Met, left: Ints, middle: _Met) -> Bools:
    """(k,) whether between places left (k,) and those after them, with places in the middle, nothing changes, and what
    is drawn is straight on the page and in the parameters of its sheet."""
    one, two = met.take(left), met.take(left + 1)
    same = (one.sheet == two.sheet) & (one.sheet == middle.sheet)
    same &= (one.drawn == two.drawn) & (one.drawn == middle.drawn)
    shown = np.flatnonzero(same & one.drawn)
    sheets, number = rays.picture.sheets, one.sheet[shown]
    images = [eye.picture(rays.to_eye(each.points[shown])) for each in (one, middle, two)]
    implicit = eye.implicit[number]
    between = sheets.points(
        number, 0.5 * (one.places[shown] + _nearest_turn(eye, number, two.places[shown], one.places[shown]))
    )
    between = np.where(implicit[:, None], middle.points[shown], between)
    off = np.maximum(
        norm(images[1] - 0.5 * (images[0] + images[2])), norm(images[1] - eye.picture(rays.to_eye(between)))
    )
    # What has no image, as beside the eye, is looked at no closer.
    same[shown] = ~(off > eye.tolerance)
    return np.asarray(same)


def _nearest_turn(eye: _Eye, number: Ints, places: Floats, other: Floats) -> Floats:
    """(k,3) places on sheets (k,), whole periods away from what they are, nearest to others."""
    periods = eye.periods[number]
    with np.errstate(invalid="ignore"):
        turns = np.where(np.isfinite(periods), np.round((places - other) / periods), 0.0)
    return np.asarray(places - np.where(turns != 0.0, turns * np.where(turns != 0.0, periods, 0.0), 0.0))


def _runs(eye: _Eye, rays: _Rays, lines: Lines, out: Floats, met: _Met) -> Curves:
    """What is drawn of the places that are met, in a row where they follow each other, as curves of the lamp's view,
    without what faces keep from the light."""
    sheets = rays.picture.sheets
    step = norm(met.points[1:] - met.points[:-1])
    goes_on = met.drawn[1:] & met.drawn[:-1] & (met.sheet[1:] == met.sheet[:-1])
    within = goes_on & (met.line[1:] == met.line[:-1])
    # From one place to the next one on the same ray it leaps over a fold.
    within &= ~((met.part[1:] - met.part[:-1] < LEAST_RAY_STEP) & (step > BEHIND_SMOOTH_OUTLINE))
    across = (
        goes_on & _follow(lines)[met.line[:-1]] & (met.line[1:] == met.line[:-1] + 1) & (step <= TOUCHING_OF_EXTENT)
    )
    linked = np.concatenate([[False], within | across, [False]])
    shown = linked[1:] | linked[:-1]
    kept = np.flatnonzero(shown & ~np.concatenate([[False], across]))
    starts = np.flatnonzero((shown & ~linked[:-1])[kept])
    if not len(kept):
        return no_curves()
    offsets = np.append(starts, len(kept))
    points, sheet = met.points[kept], met.sheet[kept]
    places = _turned_on(eye, sheet, met.places[kept], offsets)
    own = sheet[starts]
    used, family = np.unique(own, return_inverse=True)
    kind = np.full(len(own), int(LineKind.SHADOW))
    curves = Curves(
        points,
        places,
        np.full_like(points, np.nan),
        offsets,
        np.zeros(len(own), dtype=np.bool_),
        kind,
        sheets.item[own],
        family.ravel(),
        np.zeros(len(own)),
        tuple(_thrown_family(rays.picture.sheets, number) for number in used.tolist()),
    )
    chord = curves.chords
    if not len(rays.picture.faces):
        return curves
    # Each chord is of the line that its second end is of.
    off = BESIDE_OUTLINE * out[met.line[kept]][chord + 1]
    ends = (np.ascontiguousarray((curves.points[end] + off).T) for end in (chord, chord + 1))
    seen = visible_parts(rays.view, rays.picture.faces, rays.picture.solid, Segments(*ends), unheard)
    return _parts_of(curves, chord[seen.segment], seen.low, seen.high)


def _turned_on(eye: _Eye, sheet: Ints, places: Floats, offsets: Ints) -> Floats:
    """(n,3) places on sheets (n,) that run on over seams along each curve."""
    moved = places.copy()
    moved[1:] = _nearest_turn(eye, sheet[1:], places[1:], places[:-1]) - places[1:]
    moved[offsets[:-1]] = 0.0
    total = np.cumsum(np.nan_to_num(moved), axis=0)
    return np.asarray(places + total - np.repeat(total[offsets[:-1]], np.diff(offsets), axis=0))


def _follow(lines: Lines) -> Bools:
    """(n,) whether each line ends on its curve where the next one begins."""
    result = np.zeros(len(lines), dtype=np.bool_)
    if lines.chords is not None and len(lines):
        curve, chord = lines.chords.curve, lines.chords.chord
        ends = chord + lines.chords.end
        result[:-1] = (curve[1:] >= 0) & (curve[1:] == curve[:-1]) & (ends[:-1] == chord[1:] + lines.chords.begin[1:])
    return result


def _thrown_family(sheets: Sheets, number: int) -> Family:
    """Curves on a sheet known by points."""
    sheet = sheets[number]
    if isinstance(sheet, ParametricSheet):
        return ParameterCurves(sheet, number)
    assert isinstance(sheet, ImplicitSheet)
    return NearChords(sheet, number)


def _thrown_in_eye(eye: _Eye, rays: _Rays, number: int, second: int) -> Family:
    return _thrown_family(eye.sheets, number)


# Parts of curves, and curves of a lamp's view in that of the eye.


def _parts_of(curves: Curves, chord: Ints, begin: Floats, end: Floats) -> Curves:
    """Parts of curves, from begin to end (k,) of the chords that begin at points chord (k,): in a row where they follow
    each other."""
    if not len(chord):
        return no_curves()
    order = np.lexsort((begin, chord))
    chord, begin, end = chord[order], begin[order], end[order]
    one, two = curves.at(chord, begin), curves.at(chord, end)
    for found, part in ((one, begin), (two, end)):
        # At the ends of chords nothing is looked for.
        for at, values in ((0.0, 0), (1.0, 1)):
            same = np.flatnonzero(part == at)
            found.points[same] = curves.points[chord[same] + values]
            found.places[same] = curves.places[chord[same] + values]
            found.second_places[same] = curves.second_places[chord[same] + values]
    curve = curves.owner[chord]
    new = np.ones(len(chord), dtype=np.bool_)
    new[1:] = (curve[1:] != curve[:-1]) | (chord[1:] + begin[1:] != chord[:-1] + end[:-1])
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(chord)) - 1
    own = curves.take(curve[first])

    def row(begins: Floats, ends: Floats) -> Floats:
        return np.insert(begins, last + 1, ends[last], axis=0)

    return replace(
        own,
        points=row(one.points, two.points),
        places=row(one.places, two.places),
        second_places=row(one.second_places, two.second_places),
        offsets=ragged.offsets(last - first + 2),
        closed=np.zeros(len(first), dtype=np.bool_),
    )


FamilyOf = Callable[[_Eye, _Rays, int, int], Family]


def _in_eye(eye: _Eye, rays: _Rays, curves: Curves, kind: LineKind, family_of: FamilyOf) -> Curves:
    """Curves on sheets of a lamp's view as those of some kind in the eye's; family_of: of a sheet and a second."""
    if not len(curves):
        return no_curves()
    points, owner = rays.to_eye(curves.points), curves.owner

    def places_of(sheet: Ints, places: Floats) -> Floats:
        number = sheet[owner]
        found = np.where(eye.implicit[number][:, None], points, places * [1.0, 1.0, 0.0])
        return np.where((number >= 0)[:, None], found, np.nan)

    pair, family = np.unique(np.stack([curves.sheet, curves.second_sheet]), axis=1, return_inverse=True)
    found = replace(
        curves,
        points=points,
        places=places_of(curves.sheet, curves.places),
        second_places=places_of(curves.second_sheet, curves.second_places),
        kind=np.full(len(curves), int(kind)),
        family=family.ravel(),
        level=np.zeros(len(curves)),
        families=tuple(family_of(eye, rays, *each) for each in pair.T.tolist()),
        side=np.zeros(len(curves), dtype=np.intp),
    )
    return with_merged_families([found], eye.sheets)[0]
