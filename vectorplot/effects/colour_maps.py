"""Colours by numbers and boxes with axes: round numbers, colour bars, and bodies cut into bands of one colour."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from typing import Any, Literal

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.curves.families import Line
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.labels import LETTERS
from vectorplot.drawing.letters import Lettering, typeset
from vectorplot.drawing.pens import PenRule
from vectorplot.drawing.strokes import split_long
from vectorplot.drawing.texts import Texts
from vectorplot.effects.cuts import InSpace, cut_scene, default_page
from vectorplot.errors import InputError
from vectorplot.features.edge_splitting import Within, divided
from vectorplot.features.mesh_feature_lines import mesh_bending, smooth_normals
from vectorplot.features.mesh_lines import face_triangles
from vectorplot.features.tessellation import Facets, facets_of_all
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import USUAL as DEFAULT_BUDGET
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.connectivity import edges_of
from vectorplot.geometry.elementary import arctan2, log, power
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.mesh_cuts import level_bands
from vectorplot.geometry.mesh_repair import welded
from vectorplot.geometry.projections import Projection, projection_of
from vectorplot.geometry.vectors import norm
from vectorplot.io.expressions import parse_expression
from vectorplot.scene.annotations import thin_line
from vectorplot.scene.colour_scales import BAR_LETTERS_MM, BoxAxes, Colouring, Fields
from vectorplot.scene.item import Item, SurfaceNormals
from vectorplot.scene.labels import BesidePoint, Label
from vectorplot.scene.material import Material
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, camera_of, fitted_with_room
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import NO_LINES, SurfaceLines, round_heights
from vectorplot.scene.view import View
from vectorplot.shading.palettes import palette
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.tolerances import COLOURED_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.words import LineKind, unknown

# The numbers along an axis: round ones, with what is common to them said once.

TICKS = 5
"""About so many on every axis."""

MOST_DIGITS = 4
"""Numbers that need more digits to be told apart are counted from a round one."""

LONGEST = 6
"""Numbers with more letters are told as parts of a power of ten."""

_HIGH = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


@dataclass(frozen=True)
class AxisNumbers:
    """Where an axis is marked: values, ascending, what stands at each, and what these are to be taken times and added
    to, if that is not 1 and 0."""

    values: tuple[float, ...]
    texts: tuple[str, ...]
    common: str = ""

    def drawn(self, times: float) -> AxisNumbers:
        """The same numbers where they are drawn times as far from the origin."""
        return replace(self, values=tuple(times * value for value in self.values))


def axis_numbers(low: float, high: float) -> AxisNumbers:
    """Round numbers from one end of an axis to the other, both included where they are round.

    Edge cases: where both ends are the same that one.
    """
    return _numbers_of_steps(_round(low, high))


def _numbers_of_steps(values: tuple[float, ...]) -> AxisNumbers:
    """What stands at values that are evenly apart."""
    if len(values) < 2:
        return AxisNumbers(values, tuple(f"{value:.6g}" for value in values))
    step = values[1] - values[0]
    offset = _offset(values, step)
    counted = np.rint((np.array(values) - offset) / step) * step
    texts = _texts(counted.tolist(), step, 0)
    power = _power(float(np.abs(counted).max())) if max(map(len, texts)) > LONGEST else 0
    common = [*([_times(power)] if power else []), *([_added(offset)] if offset else [])]
    return AxisNumbers(values, _texts(counted.tolist(), step, power), " ".join(common))


def _numbers_of_limits(values: tuple[float, ...]) -> AxisNumbers:
    """What stands at values that are anywhere."""
    texts = tuple(f"{value:.6g}" for value in values)
    if max(map(len, texts)) <= LONGEST and "e" not in "".join(texts):
        return AxisNumbers(values, texts)
    power = _power(max(map(abs, values)))
    shorter = tuple(f"{value / 10.0**power:.6g}" for value in values)
    better = max(map(len, shorter)) < max(map(len, texts))
    return AxisNumbers(values, shorter, _times(power)) if better else AxisNumbers(values, texts)


def _times(power: int) -> str:
    return f"× 10{str(power).translate(_HIGH)}"


def single_number(low: float, high: float) -> AxisNumbers:
    """One number between the ends of an axis that are too near each other for more: zero, or a round one."""
    if low <= 0.0 <= high:
        return AxisNumbers((0.0,), ("0",))
    value = min(_round(low, high) or (low,), key=lambda one: len(f"{one:.6g}"))
    return AxisNumbers((value,), (f"{value:.6g}",))


def _round(low: float, high: float) -> tuple[float, ...]:
    inner = round_heights(low, high, TICKS)
    if not low < high:
        return (low,)
    if len(inner) < 2:
        return inner
    step, slack = inner[1] - inner[0], ZERO_OF_EXTENT * (high - low)
    before, after = inner[0] - step, inner[-1] + step
    return (*((before,) if before >= low - slack else ()), *inner, *((after,) if after <= high + slack else ()))


def _offset(values: tuple[float, ...], step: float) -> float:
    """What numbers are counted from: 0 where few digits tell them apart, else the roundest one beside them."""
    low, high = values[0], values[-1]
    if _power(max(abs(low), abs(high))) - _power(step) < MOST_DIGITS:
        return 0.0
    unit = 10.0 ** np.ceil(math.log10(high - low))
    nearest = float(np.rint(0.5 * (low + high) / unit) * unit)
    return nearest if low <= nearest <= high else float(np.floor(low / unit) * unit)


def _power(value: float) -> int:
    """The power of ten of the first digit of a number that is positive, for 9.9999999 of the next one."""
    return int(np.floor(math.log10(value) + ZERO_OF_EXTENT))


def _texts(values: list[float], step: float, power: int) -> tuple[str, ...]:
    digits = max(power - _power(step), 0)
    found = (f"{round(value / 10.0**power, digits) + 0.0:.{digits}f}" for value in values)
    return tuple(text.rstrip("0").rstrip(".") if "." in text else text for text in found)


def _added(value: float) -> str:
    return f"{'+' if value > 0.0 else '−'} {abs(value):.12g}"


# A box around a scene, with grids on its far sides and numbers along its outer edges.

FLAT = 0.05
"""What is flat has a box so thick to both sides, as a part of its longest side."""

THIN = 0.01
"""A side that is a smaller part of the longest one has a single number: more would stand in one place."""

GAP_MM, NAME_GAP_MM = 1.2, 1.4
"""From the edges of the box to the numbers beside them, and from these to the names: lines end 0.6 mm before letters,
and edges do not."""

SMALLER = 0.75
"""Numbers as a part of the names."""

SLANTED = 0.5
"""Numbers stand in line with the grid beside an edge, unless the cosine of its angle to what is upright to the edge is
smaller."""

SHORT = 0.02
"""Edges of which the image is a smaller part of that of the longest one are seen end-on: they are not numbered."""


def with_box(scene: Scene, camera: Camera) -> tuple[Scene, Floats]:
    """The scene with the box that it asks for: thin lines, hidden by the scene like any others, and labels; and the
    points (k,3) that a picture of it has to hold besides these: the corners.

    Edge cases: a side along which the scene has no extent is as long as a tenth of the longest one.
    """
    box = scene.box
    if box is None or not len(scene.items):
        return replace(scene, box=None), np.zeros((0, 3))
    bounds = scene.bounds
    low, high = _sides(bounds)
    towards = camera.direction if camera.parallel else np.asarray(camera.eye) - 0.5 * (low + high)
    # Square to a side the lower and the left edge are numbered.
    near_high = np.append(towards[:2] > 0.0, towards[2] >= 0.0)
    far, near = np.where(near_high, low, high), np.where(near_high, high, low)
    thin = THIN * float((high - low).max())
    numbers = [
        _numbers(a / times, b / times, thin / times).drawn(times)
        for (a, b), times in zip(bounds.T.tolist(), (1.0, 1.0, scene.exaggeration), strict=True)
    ]
    labels = _labels(box, projection_of(camera, np.stack([low, high])), (low, high), far, near, numbers)
    items = _grids(far, low, high, [list(one.values) for one in numbers])
    corners = np.where(np.array(list(np.ndindex(2, 2, 2)), dtype=np.bool_), high, low)
    return replace(scene, items=(*scene.items, *items), labels=(*scene.labels, *labels), box=None), corners


def _sides(bounds: Floats) -> tuple[Floats, Floats]:
    """The lowest and the highest corner of the box."""
    size = np.ptp(bounds, axis=0)
    longest = float(size.max()) or 1.0
    grown = np.where(size > ZERO_OF_EXTENT * longest, 0.0, FLAT * longest)
    return bounds[0] - grown, bounds[1] + grown


def _numbers(low: float, high: float, thin: float) -> AxisNumbers:
    return axis_numbers(low, high) if high - low > thin else single_number(low, high)


def _grids(far: Floats, low: Floats, high: Floats, ticks: list[list[float]]) -> list[Item]:
    """The lines on the three far sides; the edges between two of them once."""
    ends: list[tuple[Floats, Floats]] = []
    for side in range(3):
        for across in range(3):
            if across == side:
                continue
            along = 3 - side - across
            ends_of_side = float(low[across]), float(high[across])
            slack = ZERO_OF_EXTENT * (ends_of_side[1] - ends_of_side[0])
            inner = [at for at in ticks[across] if ends_of_side[0] + slack < at < ends_of_side[1] - slack]
            for at in [*inner, *ends_of_side]:
                if at == far[across] and across < side:
                    continue
                start, end = far.copy(), far.copy()
                start[across] = end[across] = at
                start[along], end[along] = low[along], high[along]
                ends.append((start, end))
    return [thin_line(f"box {k + 1}", Line.through(a, b), "box") for k, (a, b) in enumerate(ends)]


def _labels(
    box: BoxAxes,
    projection: Projection,
    sides: tuple[Floats, Floats],
    far: Floats,
    near: Floats,
    numbers: Sequence[AxisNumbers],
) -> list[Label]:
    """Names and numbers along the edges where a far side meets a near one: upright ones on the left.

    Names come first, then numbers that are alone on their axis: where there is no room for all, later ones are left
    out.
    """
    middle = 0.5 * (sides[0] + sides[1])
    names, alone, found = list[Label](), list[Label](), list[Label]()
    edges = [_edge(axis, projection, sides, far, near) for axis in range(3)]
    longest = max(edge.length for edge in edges)
    for axis, (edge, along) in enumerate(zip(edges, numbers, strict=True)):
        if not edge.length > SHORT * longest:
            continue
        deep, size = 0.0, SMALLER * box.capitals_mm
        for value, text in zip(along.values, along.texts, strict=True):
            place = edge.corner.copy()
            place[axis] = value
            away = edge.away(projection, place)
            room, reach = _beside(text, place, size, edge.upright, away, GAP_MM)
            (found if len(along.values) > 1 else alone).append(
                Label(text, room, f"box {axis} {text}", size, "centre", "solid")
            )
            deep = max(deep, reach)
        text = "\n".join(filter(None, (box.names[axis], along.common)))
        if text:
            place = edge.corner.copy()
            place[axis] = middle[axis]
            off = deep + NAME_GAP_MM
            room, _ = _beside(text, place, box.capitals_mm, edge.upright, edge.upright, off)
            room = replace(room, is_dispensable=False)
            names.append(Label(text, room, f"box {axis}", box.capitals_mm, "centre", "solid"))
    return [*names, *alone, *found]


@dataclass(frozen=True, eq=False)
class _Edge:
    """An edge that is numbered: a point of it but for the coordinate along it, the direction (3,) of the grid beside it
    out of the box; and on the page the unit normal (2,) that points out, and its length."""

    corner: Floats
    out: Floats
    upright: Floats
    length: float

    def away(self, projection: Projection, place: Floats) -> Floats:
        """(2,) the unit direction on the page in which a number is beside a place of the edge: on with the grid."""
        ends = _image(projection, np.stack([place - self.out, place]))
        way = ends[1] - ends[0]
        long = float(np.hypot(*way))
        return way / long if matmul(way, self.upright) > SLANTED * long else self.upright


def _edge(axis: int, projection: Projection, sides: tuple[Floats, Floats], far: Floats, near: Floats) -> _Edge:
    """The edge along which an axis is numbered: on the floor or the ceiling, and for the upright axis the left one."""
    low, high = sides
    middle = 0.5 * (low + high)
    one, two = (k for k in range(3) if k != axis)
    choices = []
    for ahead, behind in [(one, two)] if two == 2 else [(one, two), (two, one)]:
        corner, out = middle.copy(), np.zeros(3)
        corner[ahead], corner[behind] = near[ahead], far[behind]
        out[ahead] = near[ahead] - middle[ahead]
        choices.append((float(_image(projection, corner[None])[0, 0]), corner, out))
    _, corner, out = min(choices, key=lambda choice: choice[0])
    ends = np.stack([corner, corner])
    ends[:, axis] = low[axis], high[axis]
    start, end = _image(projection, ends)
    (across, up), long = end - start, float(np.hypot(*(end - start)))
    upright = np.array([-up, across]) / long if long > 0.0 else np.array([0.0, 1.0])
    inward = float(matmul(upright, _image(projection, middle[None])[0] - start))
    return _Edge(corner, out, -upright if inward > 0.0 else upright, long)


def _image(projection: Projection, world: Floats) -> Floats:
    """(n,2) the images of points of the world (n,3)."""
    return projection.image_of(projection.points_of(world)).T


def _beside(
    text: str, at: Floats, size_mm: float, upright: Floats, away: Floats, gap: float
) -> tuple[BesidePoint, float]:
    """The room of a text in a direction away from a point of an edge, a gap off the edge; and how far from the edge
    that ends. upright (2,): unit normal of the edge."""
    half = 0.5 * np.ptp(typeset(text, size_mm=size_mm).bounds, axis=0)
    deep = float(matmul(np.abs(upright), half))
    middle = (gap + deep) / float(matmul(away, upright)) * away
    (left, bottom), (right, top) = (middle - half).tolist(), (middle + half).tolist()
    x, y, z = at.tolist()
    return BesidePoint((x, y, z), (left, bottom), (right, top)), gap + 2.0 * deep


# Colours for numbers from low to high.

COLOUR_MAPS: dict[str, tuple[str, ...]] = {
    "viridis": (
        *("#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b"),
        "#fde725",
    ),
    "heat": ("#1b0a24", "#5b1648", "#a32748", "#dd4f2f", "#f28c28", "#f9c74f", "#fff3c4"),
    "diverging": ("#2c5aa0", "#7fa8d1", "#dfe6ea", "#f0c3a2", "#d9744f", "#a32020"),
    "land": ("#6f9f6a", "#a5c183", "#e2dda6", "#d8b67c", "#b88a5a", "#99745a", "#c8c1ba", "#ffffff"),
    "gray": ("#202020", "#f4f4f4"),
}
"""Colours from low to high, with what is between them mixed. viridis: control points of the map of matplotlib by
Smith and van der Walt, which is in the public domain (CC0)."""


def map_colours(name: str, count: int) -> list[str]:
    """So many colours #rrggbb of a map, from its low end to its high end.

    Errors: InputError for a name that is neither of ours nor of matplotlib's, where that is installed.
    """
    if name in COLOUR_MAPS:
        given = np.array(
            [[int(word[k : k + 2], 16) for k in (1, 3, 5)] for word in COLOUR_MAPS[name]], dtype=np.float64
        )
        place = np.linspace(0.0, len(given) - 1.0, count)
        return _words(np.stack([np.interp(place, np.arange(len(given)), given[:, k]) for k in range(3)], axis=1))
    try:
        colormaps = import_module("matplotlib").colormaps
    except ImportError:
        raise unknown("colour map", name, COLOUR_MAPS, "or one of matplotlib, which is not installed") from None
    if name not in colormaps:
        raise unknown("colour map", name, COLOUR_MAPS, "or one of matplotlib")
    try:
        return _words(255.0 * np.asarray(colormaps[name](np.linspace(0.0, 1.0, count)), dtype=np.float64)[:, :3])
    except (TypeError, ValueError):
        raise InputError(f"colour map {name!r}: matplotlib gives no colours") from None


def _words(colours: Floats) -> list[str]:
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in np.floor(colours + 0.5).astype(int).tolist()]


# Triangles divided until a number is linear in each of them, nearly.

LOOKS = (0.21, 0.5, 0.79)
"""Where on sides the number is compared with its ends; uneven, so that waves are not met in step."""

ROUNDS = 12
"""Times that a side is halved at most."""

MOST = 60_000
"""Triangles of a body: what jumps is never linear."""


def linear_triangles(
    points: Floats, triangles: Ints, numbers: Callable[[Floats], Floats], far: float
) -> tuple[Floats, Ints]:
    """Points (n,3) and triangles (t,3) with sides halved where a number, at points (m,3), is farther than that from
    linear along them; neighbours share all points, and the first points are those given.

    Edge cases: what is not finite is left as it is; sides are halved until there are MOST triangles; none where far is
    0.
    """
    if far <= 0.0:
        return points, triangles
    for _ in range(ROUNDS):
        edges, sides, _ = edges_of(triangles, len(points))
        split = np.flatnonzero(_is_bent(points[edges], numbers, far))
        middle = np.full(len(edges), -1, dtype=np.intp)
        middle[split] = len(points) + np.arange(len(split))
        if not len(split) or len(triangles) + int((middle[sides] >= 0).sum()) > MOST:
            break
        points = np.concatenate([points, points[edges[split]].mean(axis=1)])
        triangles, _ = divided(triangles, middle[sides], points)
    return points, triangles


def reached(points: Floats, triangles: Ints, numbers: Callable[[Floats], Floats]) -> float:
    """How far the numbers at points of the sides of triangles are apart; 0 where they differ by rounding alone."""
    edges, _, _ = edges_of(triangles, len(points))
    ends = points[edges]
    parts = np.array([0.0, *LOOKS, 1.0])[:, None, None]
    values = numbers((ends[:, 0] + parts * (ends[:, 1] - ends[:, 0])).reshape(-1, 3))
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0
    low, high = float(values.min()), float(values.max())
    apart = high / 2.0 - low / 2.0
    return 2.0 * apart if apart > ZERO_OF_EXTENT * max(abs(low), abs(high)) else 0.0


def _is_bent(ends: Floats, numbers: Callable[[Floats], Floats], far: float) -> Bools:
    """(e,) along which sides (e,2,3) the number is not linear."""
    first, last = numbers(ends[:, 0]), numbers(ends[:, 1])
    found = np.zeros(len(ends), dtype=np.bool_)
    with np.errstate(invalid="ignore", over="ignore"):
        for part in LOOKS:
            on = numbers(ends[:, 0] + part * (ends[:, 1] - ends[:, 0]))
            found |= np.abs(on - (first + part * (last - first))) > far
    return found


# Scenes in the colours of a map: bodies cut into bands, each of a colour.

LINE_MM = 0.25
"""The width of lines between bands."""

OWN_INK = (LineKind.SECTION, LineKind.INDEX, LineKind.ISOPHOTE)
"""Lines that run across bands, and have nothing of their colours."""

IN_COLOURS = tuple(kind.word for kind in LineKind if kind not in OWN_INK)
"""The kinds of lines that have the colours of bands."""

WORDS = ("x", "y", "z", "height", "slope", "curvature")
"""Numbers that every shape has at its points; all else is a formula."""


BAR_TICKS = 6
"""Numbers at a bar, about."""

PART_OF_STEP = 0.25
"""Of the difference of two colours: how far numbers may be from linear in a triangle."""


@dataclass(frozen=True, eq=False)
class _Valued:
    """Triangles (t,3) of points (n,3), with a number (n,) at each; and the mesh of those without a number, if there are
    any. is_stepped: numbers are of faces, which share no points. normals: of the surface they stand for."""

    points: Floats
    values: Floats
    triangles: Ints
    without: Mesh | None = None
    is_stepped: bool = False
    normals: SurfaceNormals | None = None


@dataclass(frozen=True)
class ColourBar:
    """Which number is which colour: limits, ascending, of the colours #rrggbb between them; colouring: what asked for
    them; pens: of the lines between the bands, by the names of these; bands: the names of those of every item."""

    limits: tuple[float, ...]
    colours: tuple[str, ...]
    colouring: Colouring
    pens: tuple[PenRule, ...]
    bands: tuple[tuple[str, tuple[str, ...]], ...]

    @property
    def low(self) -> float:
        """The number at the lower end."""
        return self.limits[0]

    @property
    def high(self) -> float:
        """The number at the upper end."""
        return self.limits[-1]

    def numbers(self, most: int = BAR_TICKS) -> AxisNumbers:
        """What stands along the bar, and where, 0 to 1: about so many numbers."""
        low, high = self.low, self.high
        if self.colouring.at:
            every = max(1, math.ceil(len(self.limits) / (2.0 * most)))
            places = tuple(k / len(self.colours) for k in range(len(self.limits)))
            return replace(_numbers_of_limits(self.limits[::every]), values=places[::every])
        if not low < high:
            return AxisNumbers((0.5,), (f"{low:.6g}",))
        if not self.colouring.logarithmic:
            values = round_heights(low, high, most)
            return replace(_numbers_of_steps(values), values=tuple((value - low) / (high - low) for value in values))
        values = logarithmic_numbers(low, high, most)
        along = log(np.array(values) / low) / log(high / low)
        return AxisNumbers(tuple(along.tolist()), tuple(map(_power_text, values)))

    def with_pens(self, rules: Sequence[PenRule]) -> tuple[PenRule, ...]:
        """The pens of the bands, and after them rules for the scene before it was coloured: what is for an item is for
        all of its bands."""
        bands = dict(self.bands)
        names = [(rule.item,) if rule.item is None else bands.get(rule.item, (rule.item,)) for rule in rules]
        of_bands = [replace(rule, item=name) for rule, own in zip(rules, names, strict=True) for name in own]
        whole = [rule for rule in of_bands if rule.kind is None and rule.item is not None]
        # Pens of a kind would come before those of an item that name none.
        return (*self.pens, *(replace(rule, kind=kind) for rule in whole for kind in IN_COLOURS), *of_bands)


def coloured(scene: Scene, colouring: Colouring) -> tuple[Scene, ColourBar]:
    """The scene with a band of every body for each colour, and the colour bar. Smooth surfaces become triangles within
    COLOURED_OF_EXTENT of the scene's extent, without their parameter lines, paths and integral curves; triangles are
    divided until formulas are linear in them within PART_OF_STEP of a colour, or there are too many. Cut faces keep
    colour and hatches.
    Errors: InputError for an unknown map, word or formula, a scene without bodies, numbers finite nowhere.
    """
    size = float(norm(np.ptp(scene.bounds, axis=0)))
    field = isinstance(colouring.by, str) and any(_has_field(item, colouring.by) for item in scene.items)
    plain = (
        is_curve(item.shape) or item.is_cut_face or (field and not _has_field(item, str(colouring.by)))
        for item in scene.items
    )
    if not field:
        _check_word(colouring.by, scene)
    numbered = [k for k, left in enumerate(plain) if not left]
    smooth = _faceted(scene, numbered, COLOURED_OF_EXTENT * size)
    given: list[_Valued | None] = [None] * len(scene.items)
    for k in numbered:
        given[k] = _valued(scene.items[k], colouring, smooth.get(k), scene.exaggeration)
    values = np.concatenate([np.zeros(0), *(one.values for one in given if one is not None)])
    values = values[np.isfinite(values)]
    if not len(values):
        raise InputError(f"colouring by {colouring.title or 'a function'}: nothing in the scene has a finite number")
    limits = class_limits(colouring, values)
    classes = map_colours(colouring.colour_map, len(limits) - 1)
    below, above = (() if name is None else (shade_of(name),) for name in (colouring.under, colouring.over))
    colours = [*below, *classes, *above]
    levels = limits[0 if below else 1 : len(limits) if above else -1]
    levels = levels if limits[-1] > limits[0] else np.zeros(0)
    unlit = None if colouring.is_lit else Material("unlit")
    items: list[Item] = []
    pens: list[PenRule] = []
    names = []
    for item, whole in zip(scene.items, given, strict=True):
        if whole is None:
            items.append(item)
            continue
        lines = _kept_lines(item)
        fields = item.fields if lines.contours else None
        own = []
        numbers = _scaled(colouring, whole.values, limits[0])
        parts = level_bands(whole.points, numbers, whole.triangles, _scaled(colouring, levels, limits[0]))
        if whole.without is not None:
            bare = replace(item, name=f"{item.name} 0", shape=whole.without, patterns=(), curves=lines)
            items.append(replace(bare, group=item.group or item.name, fields=fields))
            own.append(bare.name)
        for k in range(len(colours)):
            mesh = welded(parts.mesh(k))[0] if whole.is_stepped else parts.mesh(k)
            if mesh.face_count:
                name = f"{item.name} {k + 1}"
                group = item.group or item.name
                band = replace(item, name=name, shape=mesh, colour=colours[k], patterns=(), curves=lines, group=group)
                band = band if unlit is None else replace(band, material=unlit)
                items.append(replace(band, fields=fields, face_looks=None, normals=whole.normals))
                own.append(name)
                pens.extend(PenRule(kind, name, colour=colours[k]) for kind in IN_COLOURS)
                pens.append(PenRule("boundary", name, width_mm=LINE_MM))
        names.append((item.name, tuple(own)))
    bar = ColourBar(tuple(limits.tolist()), tuple(classes), colouring, tuple(pens), tuple(names))
    return replace(scene, items=tuple(items), colouring=None), bar


def _kept_lines(item: Item) -> SurfaceLines:
    """Those lines that bands of an item have too; contours of fields at the values that they have on the whole."""
    lines = item.curves
    if not lines:
        return NO_LINES
    numbers = {} if item.fields is None else item.fields.at_vertices
    levels = [(one, one.levels(numbers[one.name]) if one.name in numbers else one.values) for one in lines.contours]
    contours = tuple(replace(one, values=values) for one, values in levels if values)
    return replace(
        lines, columns=0, rows=0, paths=(), integral=(), terrain=(), smooth_contours=False, contours=contours
    )


def _faceted(scene: Scene, numbers: Sequence[int], allowed: float) -> dict[int, Facets]:
    """The facets of those of some items that are smooth surfaces, off these by no more than is allowed."""
    smooth = [k for k in numbers if is_parametrised(scene.items[k].shape) or is_implicit(scene.items[k].shape)]
    within = Within(lambda points: np.full(points.shape[:-1], allowed))
    found = facets_of_all([scene.items[k].shape for k in smooth], lambda _: within, DEFAULT_BUDGET.facets)
    return dict(zip(smooth, found, strict=True))


def _valued(item: Item, colouring: Colouring, found: Facets | None, exaggeration: float) -> _Valued:
    """The triangles of an item and the numbers at their corners; what has none has the lowest there is. found: the
    facets of a smooth surface; exaggeration: what heights were multiplied with."""
    mesh, normals, of_surface = item.mesh, None, None
    if found is not None:
        mesh, normals = found.mesh, found.normals
        of_surface = SurfaceNormals(mesh, np.nan_to_num(normals), found.sharp)
    if not mesh.face_count:
        return _Valued(mesh.vertices, np.zeros(len(mesh.vertices)), np.zeros((0, TRIANGLE), dtype=np.intp))
    if isinstance(colouring.by, str) and _has_field(item, colouring.by):
        assert item.fields is not None
        return _of_field(item.fields, colouring.by, mesh)
    points, triangles = mesh.vertices, face_triangles(mesh).triangles
    try:
        if (numbers := _of_places(colouring.by)) is None:
            values = _of_shape(str(colouring.by), mesh, triangles, normals)
            values = values / exaggeration if colouring.by in ("z", "height") else values
        else:
            points, triangles = linear_triangles(points, triangles, *_finest(colouring, numbers, points, triangles))
            values = numbers(points)
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None
    known = np.isfinite(values)
    least = float(values[known].min()) if known.any() else np.nan
    return _Valued(points, np.where(known, values, least), triangles, normals=of_surface)


def class_limits(colouring: Colouring, values: Floats) -> Floats:
    """(n+1,) the limits of n colours for finite numbers. Errors: InputError where there is no range for them."""
    if colouring.at:
        return np.array(colouring.at)
    if colouring.logarithmic:
        values = values[values > 0.0]
        if not len(values):
            raise InputError(f"colouring by {colouring.title or 'a function'}: no number is positive")
    low = float(values.min()) if colouring.low is None else colouring.low
    high = float(values.max()) if colouring.high is None else colouring.high
    if low > high:
        raise InputError(f"colouring by {colouring.title or 'a function'}: all numbers are beyond {min(low, high):g}")
    if not colouring.logarithmic:
        return np.linspace(low, high, colouring.steps + 1)
    limits = low * power(high / low, np.linspace(0.0, 1.0, colouring.steps + 1))
    limits[-1] = high
    return limits


def logarithmic_numbers(low: float, high: float, most: int) -> tuple[float, ...]:
    """Powers of ten from one positive number to another; where these are few, twice and five times them too."""
    first, last = _power(low) - 1, _power(high) + 1
    for digits in ((1.0,), (1.0, 2.0, 5.0), tuple(float(digit) for digit in range(1, 10))):
        values = (digit * 10.0**exponent for exponent in range(first, last + 1) for digit in digits)
        slack = 1.0 + ZERO_OF_EXTENT
        found = tuple(value for value in values if low <= value * slack and value <= high * slack)
        if len(found) > 2:
            break
    return found[:: max(1, math.ceil(len(found) / (2.0 * most)))]


def _power_text(value: float) -> str:
    """A number, or a power of ten where that has many figures."""
    exponent = _power(value)
    digit = round(value / 10.0**exponent)
    if abs(exponent) < MOST_DIGITS:
        return f"{value:.6g}"
    return f"{'' if digit == 1 else f'{digit}·'}10{str(exponent).translate(_HIGH)}"


def shade_of(name: str) -> str:
    """#rrggbb of a colour in full light."""
    return "#{:02x}{:02x}{:02x}".format(*palette(name)[-1].tolist())


def _scaled(colouring: Colouring, values: Floats, low: float | None) -> Floats:
    """Numbers as they are linear along the bar: on logarithmic scales logarithms, of what is far below the lowest
    colour one that is below it; NaN where that is not known."""
    if not colouring.logarithmic:
        return values
    least = np.nan if low is None else low / BELOW
    return log(np.where(values > 0.0, np.fmax(values, least), least))


BELOW = 4.0
"""Times that numbers are smaller than those of the lowest colour at least where they count as that small."""


def _finest(
    colouring: Colouring, numbers: Callable[[Floats], Floats], points: Floats, triangles: Ints
) -> tuple[Callable[[Floats], Floats], float]:
    """Numbers that are to be linear in triangles, and how far from it they may be: of logarithmic scales logarithms."""

    given = colouring.at[0] if colouring.at else colouring.low

    def scaled_numbers(places: Floats) -> Floats:
        return _scaled(colouring, numbers(places), given)

    if colouring.at or (colouring.low is not None and colouring.high is not None):
        ends = np.array(colouring.at or (colouring.low, colouring.high), dtype=np.float64)
        widths = np.diff(log(ends) if colouring.logarithmic else ends)
        step = float(widths.min()) / (1 if colouring.at else colouring.steps)
    else:
        step = reached(points, triangles, scaled_numbers) / colouring.steps
    return scaled_numbers, PART_OF_STEP * step


def _has_field(item: Item, name: str) -> bool:
    return item.fields is not None and name in item.fields.names


def _check_word(by: object, scene: Scene) -> None:
    """An InputError, which names the fields of the scene, for a word that is none of them and no formula."""
    names = dict.fromkeys(name for item in scene.items if item.fields is not None for name in item.fields.names)
    if not isinstance(by, str) or by in WORDS or not names:
        return
    try:
        parse_expression(by, ("x", "y", "z"))
    except InputError:
        raise unknown("colouring by", by, [*WORDS, *names], "or a formula") from None


def _of_field(fields: Fields, name: str, mesh: Mesh) -> _Valued:
    """The triangles of a mesh with the numbers of a field, and those that have none."""
    points, triangles = mesh.vertices, face_triangles(mesh).triangles
    posterized = fields.is_on_faces(name)
    if posterized:
        middles = points[triangles].mean(axis=1)
        values = np.repeat(fields.at(name, middles), TRIANGLE)
        points, triangles = points[triangles].reshape(-1, 3), np.arange(len(values)).reshape(-1, TRIANGLE)
    else:
        values = fields.at(name, points)
    known = np.isfinite(values)
    told = known[triangles].all(axis=1)
    without = None if told.all() else welded(Mesh.from_triangles(points, triangles[~told]))[0]
    least = float(values[known].min()) if known.any() else np.nan
    return _Valued(points, np.where(known, values, least), triangles[told], without, posterized)


def _of_shape(by: str, mesh: Mesh, triangles: Ints, normals: Floats | None) -> Floats:
    """(v,) the numbers of WORDS at the vertices of a mesh; normals (v,3): of the surface it stands for, if they are
    known."""
    points = mesh.vertices
    if by == "slope":
        x, y, z = (smooth_normals(points, triangles) if normals is None else normals).T
        return np.asarray(np.degrees(arctan2(np.hypot(x, y), np.abs(z))))
    if by == "curvature":
        second = mesh_bending(face_triangles(mesh)).second
        return np.asarray(-0.5 * (second[:, 0] + second[:, 2]))
    return np.asarray(points[:, 2 if by == "height" else "xyz".index(by)])


def _of_places(by: str | Callable[[Floats], Floats]) -> Callable[[Floats], Floats] | None:
    """The numbers (n,) at points (n,3) that a formula or a function says; None for WORDS."""
    if by in WORDS:
        return None
    if isinstance(by, str):
        try:
            formula = parse_expression(by, ("x", "y", "z"))
        except InputError as error:
            raise InputError(f"colouring by {by!r}: expected {', '.join(WORDS)} or a formula; {error.cause}") from None

        def of_formula(points: Floats) -> Floats:
            with np.errstate(all="ignore"):
                found = np.asarray(formula(x=points[:, 0], y=points[:, 1], z=points[:, 2]), dtype=np.float64)
            return np.asarray(np.broadcast_to(found, (len(points),)))

        return of_formula
    function = by

    def of_function(points: Floats) -> Floats:
        values = np.asarray(function(points), dtype=np.float64)
        if values.shape != (len(points),):
            raise InputError(f"colouring: the function gives numbers of shape {values.shape} for {len(points)} points")
        return values

    return of_function


# The bar beside a picture that says which number is which colour.

WIDTH_MM = 5.0
"""Of the bar."""

BESIDE_MM = 22.0
"""Of the strip beside the picture in which it stands with its numbers, where these have letters of the usual size."""

TITLE_TIMES = 1.2
"""The letters of the title as a multiple of those of numbers."""

TITLE_BEHIND = 1.0
"""From the numbers to a title that runs along the bar, in heights of their capitals."""

END = 0.8
"""The height of the tips that show colours of what is beyond, as a part of the width of the bar."""

TALL = 0.6
"""Part of the height of the page that it has."""

TICK_MM = 1.2
"""The length of ticks."""

LONGEST_PART = 0.4
"""Part of the page's width that the strip has at most: on small pages all is smaller."""

BAR_GAP_MM = 3.0
"""From the picture to the bar at least, its margin among it."""

TICKS_APART = 1.8
"""From number to number at least, in heights of their capitals."""

PEN = Pen(0.18)


def strip_mm(width_mm: float, colouring: Colouring, margin_mm: float = BAR_GAP_MM) -> float:
    """How wide the strip is on a page of this width, beside a picture with such a margin."""
    return min(_natural_mm(colouring, margin_mm), LONGEST_PART * width_mm)


def _natural_mm(colouring: Colouring, margin_mm: float) -> float:
    """How wide the strip is where there is room for it."""
    unit = colouring.capitals_mm / BAR_LETTERS_MM
    gap = max(BAR_GAP_MM - margin_mm, 0.0)
    return unit * (gap + BESIDE_MM + (0.0 if _stands_above(colouring) else 2.0 * TITLE_TIMES * BAR_LETTERS_MM))


def _stands_above(colouring: Colouring) -> bool:
    """Whether the title has room above the bar; otherwise it runs along it, behind the numbers."""
    size = TITLE_TIMES * colouring.capitals_mm
    # Not up to the edge of the page.
    room = (BESIDE_MM - BAR_GAP_MM) * size / (TITLE_TIMES * BAR_LETTERS_MM)
    return float(np.ptp(typeset(colouring.title, size_mm=size).bounds, axis=0)[0]) < room


def narrower(page: Page, colouring: Colouring) -> Page:
    """The part of a page that is left of the strip."""
    return replace(page, width_mm=page.width_mm - strip_mm(page.width_mm, colouring, page.margin_mm))


def with_colour_bar(
    drawing: Drawing,
    bar: ColourBar,
    width_mm: float,
    paper: str | None = None,
    longest_mm: float | None = None,
    text: str = "strokes",
    margin_mm: float = BAR_GAP_MM,
) -> Drawing:
    """The drawing on a page so wide, with the bar in the strip beside it, which its margin is beside. Fills of bands
    become those of their bodies.

    paper: the colour of the strip, where the drawing has some behind it; longest_mm: longer strokes leave in parts;
    text: a word of LETTERS.
    """
    drawing = _with_fills_of_bodies(drawing, bar.bands)
    begin, own = drawing.width_mm, bar.colouring
    unit = (width_mm - begin) / _natural_mm(own, margin_mm) * own.capitals_mm / BAR_LETTERS_MM
    left = begin + unit * max(BAR_GAP_MM - margin_mm, 0.0)
    size = unit * BAR_LETTERS_MM
    low, high = 0.5 * (1.0 - TALL) * drawing.height_mm, 0.5 * (1.0 + TALL) * drawing.height_mm
    marks: list[Fills | Paths | Texts] = []
    if paper is not None:
        marks.append(_rectangles(begin, width_mm, np.array([0.0, drawing.height_mm]), [paper]))
    right, tip = left + unit * WIDTH_MM, unit * END * WIDTH_MM
    marks.append(_rectangles(left, right, np.linspace(low, high, len(bar.colours) + 1), bar.colours))
    bottom, top = [(left, low), (right, low)], [(right, high), (left, high)]
    for colour, ends, beyond in ((own.under, bottom, low - tip), (own.over, top, high + tip)):
        if colour is not None:
            ends.insert(1, (0.5 * (left + right), beyond))
            marks.append(_polygon(ends, shade_of(colour)))
    lines = [np.array([*bottom, *top, bottom[0]])]
    texts = []
    numbers = bar.numbers(max(2, min(BAR_TICKS, int((high - low) / (TICKS_APART * size)))))
    for place, number in zip(numbers.values, numbers.texts, strict=True):
        at = low + (high - low) * place
        lines.append(np.array([(right, at), (right + unit * TICK_MM, at)]))
        texts.append(_letters(text, number, (right + unit * (TICK_MM + 1.0), at), size, "left", "middle"))
    behind = max((float(one.bounds[1, 0]) for one in texts), default=right + unit * TICK_MM)
    above = high + size + (0.0 if own.over is None else tip)
    if numbers.common:
        texts.append(_letters(text, numbers.common, (left, above), size, "left", "base"))
        above += TICKS_APART * size
    if own.title and _stands_above(own):
        texts.append(_letters(text, own.title, (left, above), TITLE_TIMES * size, "left", "base"))
    elif own.title:
        middle = behind + (TITLE_BEHIND + 0.5 * TITLE_TIMES) * size, 0.5 * (low + high)
        texts.append(_letters(text, own.title, middle, TITLE_TIMES * size, "centre", "middle", 90.0))
    lines += [one.strokes[k] for one in texts for k in range(len(one.strokes))]
    marks.append(_strokes(lines, drawing.page_from_world, longest_mm))
    set_ = Texts.joined([one.texts for one in texts])
    layer = Layer("colour bar", PEN, (*marks, *([set_] if len(set_) else [])))
    return replace(drawing, width_mm=width_mm, layers=(*drawing.layers, layer))


def _with_fills_of_bodies(drawing: Drawing, bands: Sequence[tuple[str, tuple[str, ...]]]) -> Drawing:
    """The drawing with the bodies of bands among its items, and bands filled as parts of them: of one item, they reach
    under each other."""
    body_of = {band: number for number, (_, own) in enumerate(bands, len(drawing.items)) for band in own}
    item = np.array([body_of.get(name, number) for number, name in enumerate(drawing.items)], dtype=np.intp)
    if not any(isinstance(mark, Fills) and len(mark) for layer in drawing.layers for mark in layer.marks):
        return drawing

    def of_bodies(mark: Any) -> Any:
        return (
            replace(mark, item=np.where(mark.item < 0, mark.item, item[mark.item])) if isinstance(mark, Fills) else mark
        )

    layers = tuple(replace(layer, marks=tuple(map(of_bodies, layer.marks))) for layer in drawing.layers)
    return replace(drawing, layers=layers, items=(*drawing.items, *(name for name, _ in bands)))


def _letters(
    text: str,
    words: str,
    at: tuple[float, float],
    size: float,
    align: Literal["left", "centre"],
    level: Literal["middle", "base"],
    turn: float = 0.0,
) -> Lettering:
    """Letters of a sort, a word of LETTERS. Errors: InputError for a character without strokes."""
    try:
        return LETTERS[text].plain(words, at, size_mm=size, align=align, level=level, rotation_deg=turn)
    except InputError as error:
        raise InputError(f"colour bar: {error.cause}") from None


def _polygon(corners: Sequence[tuple[float, float]], colour: str) -> Fills:
    rgb = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)]], dtype=np.uint8)
    return Fills.flat(np.array(corners), np.array([0, len(corners)]), rgb)


def _rectangles(left: float, right: float, heights: Floats, colours: Sequence[str]) -> Fills:
    """One above the other between heights (k+1,)."""
    low, high = heights[:-1], heights[1:]
    x = np.array([left, right, right, left])
    points = np.stack([np.broadcast_to(x, (len(low), 4)), np.stack([low, low, high, high], axis=1)], axis=2)
    rgb = np.array([[int(word[k : k + 2], 16) for k in (1, 3, 5)] for word in colours], dtype=np.uint8)
    return Fills.flat(points.reshape(-1, 2), np.arange(len(low) + 1) * 4, rgb)


def _strokes(lines: Sequence[Floats], world: Floats | None, longest_mm: float | None) -> Paths:
    points, count = np.concatenate(lines), len(lines)
    none = np.full(count, -1)
    paths = Paths(
        points,
        ragged.offsets([len(line) for line in lines]),
        np.zeros(count, dtype=np.bool_),
        np.full(count, int(LineKind.LABEL)),
        none,
        np.zeros(count, dtype=np.intp),
        np.zeros((len(points), 3)),
    )
    return paths if longest_mm is None or world is None else split_long(paths, longest_mm, world)


# Scenes with the colours and the box that they ask for.


@dataclass(frozen=True, eq=False)
class Scaled:
    """A scene as a chart: the scene with what its colouring and its box ask for, the camera that looks at it, the bar
    that explains its colours, if it has a colouring, and reach (k,3): the corners of its box, if it has one."""

    scene: Scene
    camera: Camera
    bar: ColourBar | None
    reach: Floats

    def around(self, placement: Placement, view: View, page: Page, mm: float = 1.0) -> Placement:
        """The place of a picture that fills a page, with room for the box, its numbers and names; page: as it
        had it; mm: how long a millimetre is in units of the page."""
        beside = [label.at for label in self.scene.labels if isinstance(label.at, BesidePoint)]
        world = np.concatenate([self.reach, np.array([at.point for at in beside]).reshape(-1, 3)])
        points, corners = view.points_of(world), np.zeros((len(self.reach), 2))
        if not len(self.reach) or not placement.whole or view.reaches_too_far(points):
            return placement
        low, high = (
            mm * np.concatenate([corners, np.array(rooms).reshape(-1, 2)]).T
            for rooms in ([at.low_mm for at in beside], [at.high_mm for at in beside])
        )
        return fitted_with_room(view, page, view.image_of(points), low, high)


def scaled(scene: Scene, camera: Camera | str | None, page: Callable[[Scene], InSpace] = default_page) -> Scaled:
    """The scene as a chart, after its cuts; page: see cut_scene. Errors: InputError as in coloured."""
    seen_from, bar = camera_of(camera, scene), None
    if scene.colouring is not None or scene.box is not None:
        # Bands of closed bodies are open, and no cut goes through a box with ticks.
        scene = cut_scene(scene, seen_from, page)
    if scene.colouring is not None:
        scene, bar = coloured(scene, scene.colouring)
    boxed, reach = with_box(scene, seen_from)
    return Scaled(boxed, seen_from, bar, reach)
