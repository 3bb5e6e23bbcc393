"""The visible lines of a scene on the page, from tracing to pens: of polyhedra, smooth surfaces, balls and labels."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Layer, Paths, Pen
from vectorplot.drawing.duplicates import without_duplicates, without_smooth_duplicates
from vectorplot.drawing.finishing import (
    by_dashes,
    by_line,
    inked,
    put_in_order,
    stroke_count,
    without_short,
    without_specks,
)
from vectorplot.drawing.layers import (
    layer_words,
    layers_of,
    letter_pen,
    looked_at_only,
    not_plotted,
    one_for_each_pen,
    pen_scale,
    sheet_layer,
    shown_items,
    sorted_layers,
)
from vectorplot.drawing.pens import BLACK, FRAME_PEN, PenRule, frame_pen, ink, pen_of, rules_by_target, scaled_pen
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import Budget, budget_of
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import segments
from vectorplot.pictures.line_sources import BORDERS, LineSources, outlined, traceable
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_draw
from vectorplot.pictures.prepared_scene import room_for_labels, titled
from vectorplot.scene.annotations import LabelAnchors, annotation_points, is_annotation, only_annotations
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.page import Page
from vectorplot.scene.pens import DepthCue
from vectorplot.scene.placement import Placement, box_corners, fitted_picture, mm_per_image
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, view_of
from vectorplot.tolerances import COINCIDENT_MM, EXACT_MM, FINEST_CHORD_OF_EXTENT, LONE_STROKE_MM
from vectorplot.visibility.polyhedra.hidden_lines import (
    Visibility,
)
from vectorplot.visibility.polyhedra.lines import (
    Lines,
    frame_of,
    items_wanting,
)
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces
from vectorplot.words import LineKind, check_colour

if TYPE_CHECKING:
    from vectorplot.drawing.labels import SceneLabels
    from vectorplot.pictures.reflected_lines import Depth


# Lines as strokes on the page.

MOST_DIVISIONS = 8
"""A line is cut into so many parts at most in one go, to be Bézier curves; all together into so many times
their number."""

MOST_ROUNDS = 6
"""So often what is still no Bézier curve is cut again: where weights change fast the fourth power comes late."""


def strokes_on_page(view: View, lines: Lines, seen: Visibility, placement: Placement) -> Paths:
    """The parts of lines as strokes on the page, each line once where several lie on each other.

    Of coincident strokes the visible one stays, then the one whose kind comes first, then the one nearer the eye.
    """
    seen, parts, handles = _as_cubics(view, lines, seen, placement.scale)
    ends = np.stack([parts.start, parts.end], axis=2).reshape(3, -1)
    points = placement.on_page(view.image_of(ends))
    count, kind, item = len(parts), parts.kind, parts.item
    offsets = np.arange(0, 2 * count + 1, 2)
    open_ = np.zeros(count, dtype=np.bool_)
    # Lines at the same depth but for rounding go by their items: so neither size nor place decides which one stays.
    depth = np.round(view.depth_of(ends).reshape(-1, 2).sum(axis=1), 8)
    rank = np.stack([np.arange(count), item, depth, _precedence(kind), seen.hidden_by > 0])
    paths = Paths(
        points, offsets, open_, kind, item, seen.hidden_by, view.world_of(ends), parts.smooth, lamp=parts.lamp
    )
    if parts.chords:
        # A page shows the image larger, not turned.
        directions = _at_ends(parts.chords.directions(view))
        paths = replace(paths, directions=directions, curve=parts.chords.curve, handles=_at_ends(handles))
    world = placement.page_from_world
    if not paths.smooth.any():
        return without_duplicates(paths, rank, COINCIDENT_MM, world, seen.segment)
    straight, smooth = np.flatnonzero(~paths.smooth), chosen(paths, paths.smooth)
    given, line = chosen(paths, straight), seen.segment.take(straight)
    once = without_duplicates(given, rank.take(straight, axis=1), COINCIDENT_MM, world, line)
    importance = (smooth.hidden_by > 0) * 2 * len(LineKind) + _precedence(smooth.kind)
    importance = importance * len(view.item_vertices) + smooth.item
    run = _runs(smooth)
    curve_rank = importance * (run.max(initial=0) + 1) + run
    return concatenated((once, without_smooth_duplicates(smooth, curve_rank, COINCIDENT_MM)))


def _precedence(kind: Ints) -> Ints:
    """(n,) numbers of which the smallest wins where one line is of several kinds: those of the kinds, but light ends at
    a crease that is a terminator, which says more."""
    return np.where(kind == LineKind.TERMINATOR, 2 * LineKind.CREASE - 1, 2 * kind)


def _runs(chords: Paths) -> Ints:
    """(n,) numbers of the parts of curves that chords (n,) belong to: one ends where its curve does, or turns back, as
    a border does that lies on itself."""
    along = chords.points[1::2] - chords.points[::2]
    back = (along[1:] * along[:-1]).sum(axis=1) < 0.0
    new = (chords.curve[1:] != chords.curve[:-1]) | (back & (chords.curve[1:] >= 0))
    return np.concatenate([[0], np.cumsum(new)])[: len(along)]


def _as_cubics(view: View, lines: Lines, seen: Visibility, scale: float) -> tuple[Visibility, Lines, Floats]:
    """Visible parts, cut so finely that they are cubics, as lines, and (n,2) how long the handles of these are in mm:
    NaN where a part is none."""
    parts, most = lines.cut(view, seen.segment, seen.low, seen.high), MOST_DIVISIONS * len(seen.segment)
    if parts.chords is None:
        return seen, parts, np.zeros((0, 2))
    handles, off = parts.chords.handles(view)
    for _ in range(MOST_ROUNDS):
        cuts = _divisions(scale * off)
        if (cuts == 1).all() or cuts.sum() > most:
            break
        seen = _divided(seen, cuts)
        parts = lines.cut(view, seen.segment, seen.low, seen.high)
        assert parts.chords is not None
        handles, off = parts.chords.handles(view)
    return seen, parts, np.where((scale * off <= EXACT_MM)[:, None], scale * handles, np.nan)


def _divisions(off_mm: Floats) -> Ints:
    """(n,) into how many parts lines have to be cut for each to be a cubic, 1 where nothing helps; off_mm (n,): how far
    cubics are off them.

    Source: Farin, Curves and Surfaces for CAGD, section 6.5: the difference falls with the fourth power of the length.
    """
    ratio = np.where(np.isfinite(off_mm), off_mm / EXACT_MM, 1.0)
    return np.clip(np.ceil(np.sqrt(np.sqrt(ratio))), 1, MOST_DIVISIONS).astype(np.intp)


def _divided(seen: Visibility, count: Ints) -> Visibility:
    """The parts cut into so many equal ones each (k,)."""
    own, share = ragged.owner(count), ragged.place(count) / count[ragged.owner(count)]
    step = (seen.high - seen.low)[own]
    low, high = seen.low[own] + share * step, seen.low[own] + (share + 1.0 / count[own]) * step
    ends = ragged.offsets(count)[1:] - 1
    high[ends] = seen.high
    return Visibility(seen.segment[own], low, high, seen.hidden_by[own])


def _at_ends(directions: Floats) -> Floats:
    """(2n,2) the directions, or the lengths of handles, at the ends of strokes of two points; (n,2): how each leaves
    its first, arrives at its last one."""
    result = np.full((2 * len(directions), 2), np.nan)
    result[::2, 1], result[1::2, 0] = directions.T
    return result


# What pens hatch with: layers of hatching strokes.

NAME = "hatch"
"""What layers of hatching are called, together with what tells them apart."""


def hatch_layers(
    strokes: Paths,
    hatching: Sequence[Hatching | Stippling | None],
    colours: Sequence[str] | None = None,
    shown_item: Ints | None = None,
) -> tuple[Layer, ...]:
    """A layer for every width of pen that hatches items, and every colour; the first one may be empty.

    strokes of hatchings only; hatching: of every item; colours: of every item, black where None; shown_item (m,): the
    item whose pen each stroke has, where None its own.
    """
    shown_item = strokes.item if shown_item is None else shown_item
    if not len(strokes):
        return ()
    widths = [0.0 if one is None else one.width_mm for one in hatching]
    inks = [BLACK] * len(widths) if colours is None else [ink(colour) for colour in colours]
    words = [""] * len(widths) if colours is None else [f" {colour}" for colour in colours]
    used = set(shown_item.tolist())
    pens = list(dict.fromkeys(pen for k, pen in enumerate(zip(words, widths, inks, strict=True)) if k in used))
    several = len({width for _, width, _ in pens}) > 1
    number = {pen: k for k, pen in enumerate(pens)}
    of_item = np.array([number.get(pen, 0) for pen in zip(words, widths, inks, strict=True)], dtype=np.intp)
    named = [(f"{NAME}{word}{f' {w:g}' if several else ''}", Pen(w, colour), True) for word, w, colour in pens]
    return layers_of(strokes, of_item[shown_item], named)


# From strokes to a drawing: their pens and layers, the paper, and what stands around the picture.

PAPER = "white"
"""What strokes fade to where nobody names the colour of the paper."""


@dataclass(frozen=True)
class OutputStyle:
    """What draw is told of pens and paper, by its keywords; look: plain, or that of a wireframe; rules: of pens, the
    last one that fits counts; curved_mm: how far fitted curves may be off strokes, None for polylines.

    Errors: InputError for a colour of the paper that is none.
    """

    look: Literal["plain", "wireframe", "depth-cue"]
    hidden: str
    layers: str
    rules: tuple[PenRule, ...]
    background: str | None
    curved_mm: float | None
    longest_mm: float | None
    title: str
    frame: bool
    unplotted: tuple[str, ...]
    text: str = "strokes"
    thin_ends: bool = False
    scale_pens: bool = False
    shortest_mm: float | None = None

    def __post_init__(self) -> None:
        if self.background is not None:
            check_colour(self.background, "background: ")

    @property
    def plain(self) -> bool:
        """Whether hidden lines are hidden, and pens have the colours that rules give them."""
        return self.look == "plain"

    def layered(
        self,
        pipeline: Pipeline,
        scene: Scene,
        view: View,
        strokes: Paths,
        hatches: Paths,
        hatch: Hatching | Stippling | None,
        page: Page,
    ) -> tuple[Layer, ...]:
        """Strokes of a scene, and those that hatch its faces, in layers with their pens; hatch: see draw."""
        if self.look == "plain":
            found = pipeline.run("layers", _line_layers, scene, view, strokes, hatches, hatch, self.layers, self.rules)
        else:
            from vectorplot.effects.depth_cues import wire_layers

            scene = scene if self.background is None else replace(scene, background=self.background)
            found = pipeline.run("layers", wire_layers, scene, view, strokes, page, self.look)
        if not self.scale_pens:
            return found
        return tuple(replace(layer, pen=scaled_pen(layer.pen, pen_scale(page))) for layer in found)

    def cued(
        self, pipeline: Pipeline, layers: tuple[Layer, ...], view: View, cue: DepthCue, placement: Placement
    ) -> tuple[Layer, ...]:
        """The layers with their strokes by depth."""
        from vectorplot.effects.depth_cues import depth_cued
        from vectorplot.shading.palettes import palette

        paper = palette(self.background or PAPER)[-1].tolist()
        return pipeline.run("depth cue", depth_cued, layers, view, cue, paper, placement.page_from_world)

    def inked(self, pipeline: Pipeline, layers: tuple[Layer, ...], placement: Placement) -> tuple[Layer, ...]:
        """The layers with strokes that are joined, fitted with curves, and in the order of a pen; of layers by pen
        those of each pen in one, as polylines, for other strokes come to them yet: see of_pens."""
        world = placement.page_from_world
        layers = self._long_enough(pipeline, layers)
        if self.by_pen:
            return pipeline.run("pen", inked, layers, self.hidden, world, None, None, self.thin_ends, by_dashes)
        return pipeline.run("pen", inked, layers, self.hidden, world, self.curved_mm, self.longest_mm, self.thin_ends)

    def _long_enough(self, pipeline: Pipeline, layers: tuple[Layer, ...]) -> tuple[Layer, ...]:
        """The layers, of each pen one where that is asked for, without specks and strokes that are too short."""
        kept = without_specks(layers) if self.shortest_mm is None else layers
        if specks := stroke_count(layers) - stroke_count(kept):
            pipeline.tell("specks", f"alone and shorter than {LONE_STROKE_MM:g} mm: left out", specks)
        if self.by_pen:
            kept = one_for_each_pen(looked_at_only(kept, self.unplotted))
        if not self.shortest_mm:
            return kept
        kept, short = without_short(kept, self.shortest_mm, by_dashes if self.by_pen else by_line)
        pipeline.tell("short strokes", f"shorter than {self.shortest_mm:g} mm: left out", short)
        return kept

    def letters(self, layers: Sequence[Layer]) -> Pen:
        """The pen of letters on a drawing with such layers."""
        return pen_of(rules_by_target(self._pen_rules), letter_pen(layers), int(LineKind.LABEL), False, "")

    def labelled(
        self, layers: tuple[Layer, ...], placement: Placement, labels: SceneLabels, letters: Pen, sheet: Page
    ) -> tuple[tuple[Layer, ...], Placement]:
        """The layers with labels on top, and their place; a sheet that is cut to size has room for them."""
        by_kind = self.layers == "kind" and self.plain
        layers = labels.on_top(layers, by_kind, self.longest_mm, placement.page_from_world, letters)
        return room_for_labels(layers, placement, labels, sheet)

    def drawing(self, layers: tuple[Layer, ...], placement: Placement, scene: Scene, letters: Pen) -> Drawing:
        """The drawing: layers with a title and a frame, on their paper. letters: the pen of labels."""
        page = placement.page
        names = tuple(item.name for item in scene.items)
        border = frame_pen(self._pen_rules, replace(FRAME_PEN, colour=letters.colour))
        layers = titled(layers, placement, self.title, self.frame, border, self.longest_mm, self.text)
        if self.background is not None and self.plain:
            layers = (sheet_layer(self.background, page), *layers)
        layers = not_plotted(layers, self.unplotted, (*names, *(item.colour for item in scene.items)))
        return Drawing(page.width_mm, page.height_mm, layers, names, scene.title, placement.page_from_world)

    @property
    def by_pen(self) -> bool:
        """Whether each pen has one layer."""
        return "pen" in layer_words(self.layers)

    def of_pens(self, pipeline: Pipeline, drawing: Drawing) -> Drawing:
        """The drawing, of layers by pen with those of each pen in one, all that it draws in its order."""
        if not self.by_pen:
            return drawing
        # Dashes are strokes by now: the same pen draws what is drawn through.
        plain = [replace(layer, pen=replace(layer.pen, dash_mm=None)) for layer in drawing.layers]
        layers, world = one_for_each_pen(plain), drawing.page_from_world
        return replace(
            drawing, layers=pipeline.run("pen", put_in_order, layers, world, self.curved_mm, self.longest_mm)
        )

    @property
    def _pen_rules(self) -> tuple[PenRule, ...]:
        return self.rules if self.plain else ()


def _line_layers(
    scene: Scene,
    view: View,
    strokes: Paths,
    hatches: Paths,
    hatch: Hatching | Stippling | None,
    layers: str,
    rules: Sequence[PenRule],
) -> tuple[Layer, ...]:
    """The layers of lines, and those of strokes that hatch faces."""
    how = [hatch if item.hatch is None else item.hatch for item in scene.items]
    names, colours = [item.name for item in scene.items], [item.colour for item in scene.items]
    if "colour" not in layer_words(layers):
        return sorted_layers(strokes, names, colours, layers, rules, hatch_layers(hatches, how))
    eye = view.world_eye
    behind = hatch_layers(hatches, how, colours, shown_items(scene, hatches, eye))
    return sorted_layers(strokes, names, colours, layers, rules, behind, shown_items(scene, strokes, eye))


# The labels of a scene on a picture of it.


def labels_in_place(
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    placement: Placement,
    anchors: LabelAnchors,
    strokes: Paths,
    hidden: str = "none",
    style: str = "plain",
    text: str = "strokes",
    *,
    mm: float = 1.0,
) -> SceneLabels:
    """The labels of a scene where a picture of it has its place on the page, and the numbers of its level lines.

    anchors: what they name in the scene as it was given; strokes: of the picture; hidden, style, text: see draw; mm:
    how long a millimetre is in units of the page.
    """
    from vectorplot.drawing.labels import labels_on_page, level_numbers, seen_labels, with_letters

    seen = seen_labels(scene, view, faces, placement, anchors, style != "plain", mm)
    named = labels_on_page(seen, placement, strokes, hidden, text, mm)
    return with_letters(named, level_numbers(scene, strokes, text, mm), placement, mm)


# How far the strokes of a drawing are from the curves they show, measured on the page.


def chord_error_mm(strokes: Paths) -> float | None:
    """How far the chords of smooth strokes are from their curves, at most: in their middles, from the cubics that leave
    and arrive in the directions that the curves were traced with; None without such strokes.

    Error: of the fourth power of a chord's length, where what is measured is of the second.
    Source: Farin, Curves and Surfaces for CAGD, section 6.5 (cubic Hermite interpolation).
    """
    ends = segments(strokes)[np.repeat(strokes.smooth, np.diff(strokes.offsets) - ~strokes.closed)]
    chord = strokes.points[ends[:, 1]] - strokes.points[ends[:, 0]]
    length = np.hypot(*chord.T)
    leaving, arriving = strokes.directions[ends[:, 0], 1], strokes.directions[ends[:, 1], 0]
    along = arctan2(chord[:, 1], chord[:, 0])
    off = length / 8.0 * np.abs(np.sin(leaving - along) - np.sin(arriving - along))
    # Over a cusp the directions are those of two branches.
    turns = np.minimum(np.cos(leaving - along), np.cos(arriving - along))
    off = off[np.isfinite(off) & (turns > 0.0)]
    return float(off.max()) if len(off) else None


def fit_error_mm(layers: Iterable[Layer]) -> float | None:
    """How far fitted curves pass the points they were fitted to, at most, all of which lie on the true curves; None
    without fitted curves."""
    marks = (mark for layer in layers for mark in layer.marks if isinstance(mark, CurvedStrokes))
    found = [mark.beziers.error[np.diff(mark.beziers.offsets) > 0] for mark in marks]
    fitted = np.concatenate([np.zeros(0), *found])
    return float(fitted.max()) if len(fitted) else None


# Lines by whatever way they are seen.


def seen_by_any_way(
    shapes: LineSources,
    lines: Lines,
    place: Placement | None,
    reflections: int,
    hidden: str,
    tolerance: float,
    budget: Budget,
) -> tuple[Lines, Visibility]:
    """Framed lines with what is seen of them, and those that mirrors and refracting solids show, where the plan has
    these, in the place of what such solids stand before.

    reflections: from mirror to mirror, so many; hidden: see draw.
    """
    mirrors, glass = map(shapes.pipeline.calls_for, ("reflected lines", "refracted lines"))
    if not mirrors and not glass:
        return lines, shapes.seen(lines)
    from vectorplot.pictures.reflected_lines import Depth, corners_of

    boxes, angle = corners_of(shapes.scene), shapes.crease_angle_deg
    how = Depth(shapes.scene, boxes, reflections, budget.mirrors, hidden, angle, tolerance, budget)
    window = None if place is None else place.window
    if not glass:
        return shapes.pipeline.run("reflected lines", _with_mirrors, shapes, lines, shapes.seen(lines), window, how)
    from vectorplot.pictures.refracted_lines import beside_glass, with_refractions

    lines = beside_glass(shapes, lines)
    seen = shapes.seen(lines)
    if mirrors:
        lines, seen = shapes.pipeline.run("reflected lines", _with_mirrors, shapes, lines, seen, window, how)
    return shapes.pipeline.run("refracted lines", with_refractions, shapes, lines, seen, window, how)


def _with_mirrors(
    shapes: LineSources, lines: Lines, seen: Visibility, window: tuple[Floats, Floats] | None, how: Depth
) -> tuple[Lines, Visibility]:
    """Lines, with what is seen of them, and those that plane and curved mirrors show."""
    from vectorplot.pictures.reflected_lines import with_more, with_reflections

    more = None
    if any(item.material.is_mirror and not isinstance(item.shape, Mesh) for item in shapes.scene.items):
        from vectorplot.pictures.round_mirror_lines import round_reflections

        more = round_reflections(shapes, window, how)
    lines, seen = with_reflections(shapes, lines, seen, window, how)
    return (lines, seen) if more is None else with_more(lines, seen, more)


# The lines of a scene where its picture has found its place on the page.

LARGER = 1.25
"""Curves are traced anew where they come out so many times larger on the page than they were taken for."""


@dataclass(frozen=True, eq=False)
class PlacedLines:
    """Lines before the eye, what is seen of them, and where that stands on the page."""

    shapes: LineSources
    lines: Lines
    seen: Visibility
    placement: Placement

    def with_halo(self, halo_mm: float) -> PlacedLines:
        """The same, lines ending so far beside what is in front of them where the plan has it."""
        pipeline = self.shapes.pipeline
        if not pipeline.calls_for("halo"):
            return self
        from vectorplot.effects.halos import halo

        width = halo_mm / self.placement.scale
        return replace(self, seen=pipeline.run("halo", halo, self.shapes.view, self.lines, self.seen, width))

    def strokes(self) -> Paths:
        """The seen parts as strokes on the page, as they come."""
        shapes = self.shapes
        return shapes.pipeline.run("strokes", strokes_on_page, shapes.view, self.lines, self.seen, self.placement)


BEHIND = 4.0
"""A depth behind all of a scene, which is 2 wide, from its middle."""


def placed_lines(
    shapes: LineSources,
    sheet: Page,
    fit: bool,
    tolerance_mm: float,
    budget: Budget,
    reflections: int = 0,
    hidden: str = "none",
) -> PlacedLines:
    """The lines of a scene, and their place on a sheet that they fill; without fit that of the field of vision.
    reflections, hidden: see draw."""
    pipeline, view, reached = shapes.pipeline, shapes.view, shapes.reached
    scale = mm_per_image(view, reached, sheet, fit)
    while True:
        # Chords take one half of the tolerance, Béziers through their ends the other.
        tolerance = 0.5 * tolerance_mm / scale
        every = shapes.lines(tolerance, budget)
        bounded = frame_of(view, every, sheet, fit)
        framed = shapes.framed(every, bounded)
        framed, seen = seen_by_any_way(shapes, framed, bounded, reflections, hidden, tolerance, budget)
        ends = _ends_to_fit(shapes, framed, seen, tolerance, budget)
        placement = bounded or fitted_picture(view, sheet, view.image_of(ends))
        if bounded is None and not ends.shape[1] and pipeline.calls_for("hatching"):
            # Without lines the picture is that of the faces.
            placement = fitted_picture(view, sheet, view.image_of(reached))
        if (
            every is shapes.straight
            or not len(seen)
            or placement.scale <= LARGER * scale
            or tolerance < FINEST_CHORD_OF_EXTENT
        ):
            return PlacedLines(shapes, framed, seen, placement)
        # Little of the scene is drawn, and that larger than thought.
        scale = placement.scale


# The outline of what is seen, all items together.


def _border_sources(shapes: LineSources, budget: Budget) -> LineSources:
    """What the borders are traced on of the items that ask for an outline: hidden ones too, and of meshes those of
    their faces, also where their contours are those of smooth shapes."""
    asking = items_wanting(LineKind.OUTLINE, shapes.scene, shapes.kinds).tolist()
    alone = replace(shapes.scene, items=tuple(map(outlined, shapes.scene.items, asking)))
    view = replace(shapes.view, occludes=np.array([item.hides for item in alone.items], dtype=np.bool_))
    pipeline = Pipeline(plan_draw(alone, BORDERS, "none", 0.0, "wireframe"), None, None)
    return traceable(pipeline, alone, view, shapes.faces, BORDERS, 180.0, budget)


def _ends_to_fit(shapes: LineSources, lines: Lines, seen: Visibility, tolerance: float, budget: Budget) -> Floats:
    """(3,n) the ends of what is drawn: of parts of lines, and of outlines where the plan has them."""
    ends = np.concatenate(lines.ends(shapes.view, seen.segment, seen.low, seen.high), axis=1)
    if not shapes.pipeline.calls_for("outline"):
        return ends
    sources = _border_sources(shapes, budget)
    borders = sources.framed(sources.lines(tolerance, budget), None)
    return np.concatenate([ends, borders.start, borders.end], axis=1)


def with_outline(
    strokes: Paths, shapes: LineSources, placement: Placement, tolerance_mm: float, budget: Budget
) -> Paths:
    """The strokes of a picture, and its outline where the plan has it; see drawing.outlines.

    Errors: InputError for an outline of what reaches behind the eye, or too far to the side of it.
    """
    if not shapes.pipeline.calls_for("outline"):
        return strokes
    return concatenated((strokes, shapes.pipeline.run("outline", _outline, shapes, placement, tolerance_mm, budget)))


def _outline(shapes: LineSources, placement: Placement, tolerance_mm: float, budget: Budget) -> Paths:
    from vectorplot.drawing.outlines import outlines
    from vectorplot.visibility.hidden_points import items_before

    sources = _border_sources(shapes, budget)
    view, every = sources.view, sources.lines(0.5 * tolerance_mm / placement.scale, budget)
    if view.reaches_too_far(every.start, every.end, view.points):
        raise InputError("outline: the scene reaches behind the eye, or too far to the side of it; step back")

    def covered(places: Floats) -> Bools:
        points = view.in_image_plane((places.T - placement.page_from_image[:2, 2:]) / placement.scale)
        if view.eye is None:
            points[2] = -BEHIND
        else:
            eye = view.eye[:, None]
            points = eye + (points - eye) * ((BEHIND + np.abs(view.eye).max()) / view.focus)
        return np.asarray(items_before(sources.scene, view, sources.faces, points).any(axis=1))

    framed = sources.framed(every, None)
    borders = PlacedLines(sources, framed, sources.seen(framed), placement).strokes()
    return outlines(borders, covered, tolerance_mm, placement.page_from_world)


# The visible lines of a scene on a picture that has its place already, for paintings, pixels and panoramas.


def with_smooth_surfaces(scene: Scene, view: View, faces: ProjectedFaces | None) -> tuple[View, ProjectedFaces]:
    """The view of a scene, and its faces in the image, in the projection of a view of it that has triangles in place of
    smooth surfaces: the same where there are none. faces: of that view, where they are known."""
    if not all(isinstance(item.shape, Mesh) for item in scene.items):
        view, faces = view_of(scene, view), None
    view = replace(view, occludes=np.array([item.hides for item in scene.items], dtype=np.bool_))
    return view, project_faces(view) if faces is None else faces


def places_beside_faces(
    scene: Scene,
    view: View,
    faces: ProjectedFaces | None,
    page: Page,
    fit: bool,
    kinds: frozenset[LineKind],
    tolerance_mm: float,
    budget: float,
) -> Floats:
    """(n,3) places in the world that a picture of faces has to fit besides these: those of annotations, and of what is
    seen of the other curves of a scene where lines of some kinds are drawn on top.

    view: of the scene, surfaces as triangles; faces: its faces in the image, where they are known; page, fit: of the
    picture; tolerance_mm: see draw. Curves that reach too far to be fitted are there as a whole.
    """
    notes = annotation_points(scene)
    curves = [is_curve(item.shape) and not is_annotation(item) for item in scene.items]
    if not fit or not kinds or not any(curves):
        return notes
    items = (item if one else replace(item, lines=()) for item, one in zip(scene.items, curves, strict=True))
    alone = replace(scene, items=tuple(items))
    view, faces = with_smooth_surfaces(alone, view, faces)
    scale = mm_per_image(view, view.points_of(np.concatenate([scene.vertices, box_corners(scene.bounds)])), page, fit)
    allowed = budget_of(budget)
    with warnings.catch_warnings():
        # They are told when the lines are drawn.
        warnings.simplefilter("ignore", InputWarning)
        shapes = traceable(
            Pipeline(plan_draw(alone, kinds, "none", 0.0), None, None), alone, view, faces, kinds, 180.0, allowed
        )
        every = shapes.lines(0.5 * tolerance_mm / scale, allowed)
    if view.reaches_too_far(every.start, every.end):
        return np.concatenate([notes, view.world_of(np.concatenate([every.start, every.end], axis=1))])
    framed = shapes.framed(every, None)
    seen = shapes.seen(framed)
    ends = np.concatenate(framed.ends(view, seen.segment, seen.low, seen.high), axis=1)
    return np.concatenate([notes, view.world_of(ends)])


def lines_in_place(
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    placement: Placement,
    kinds: frozenset[LineKind],
    *,
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: float,
    reflections: int = 0,
    bends: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Paths:
    """The visible parts of the lines of a scene, as they come, where a picture of it already has its place on the page.

    view: of the scene, in the projection of the picture; reflections: see draw; bends: whether the picture shows things
    bent in glass; progress(fraction) is called while it works. All else as of
    draw.
    """
    told = None if progress is None else lambda stage, fraction: progress(fraction)
    stages = plan_draw(scene, kinds, "none", 0.0, reflections=reflections, bends=bends)
    pipeline = Pipeline(stages, None, told)
    allowed, tolerance = budget_of(budget), 0.5 * tolerance_mm / placement.scale
    shapes = traceable(pipeline, scene, view, faces, kinds, crease_angle_deg, allowed)
    every = shapes.lines(tolerance, allowed)
    # Lines may reach too far where what the picture was fitted to does not.
    cut = not placement.whole or view.reaches_too_far(every.start, every.end)
    place = placement if cut else None
    framed = shapes.framed(every, place)
    framed, seen = seen_by_any_way(shapes, framed, place, reflections, "none", tolerance, allowed)
    strokes = PlacedLines(shapes, framed, seen, placement).strokes()
    return with_outline(strokes, shapes, placement, tolerance_mm, allowed)


# The exact visible lines of a scene, and its labels, in their places on a picture of its faces.

PEN = Pen()
"""What draws lines among fills."""

OUTLINES = frozenset({LineKind.CONTOUR, LineKind.BOUNDARY})
"""What labels keep off where no lines are drawn."""


@dataclass(frozen=True, eq=False)
class LineOverlay:
    """How the lines of a scene come to be on a picture of its faces. view: of the latter, surfaces as triangles; faces:
    its faces in the image, where they are known; shortest: shorter lines are left out; bends: whether glass bends its
    faces; all else as in draw, in the units of the placement's page."""

    scene: Scene
    view: View
    faces: ProjectedFaces | None
    placement: Placement
    crease_angle_deg: float
    tolerance_mm: float
    budget: float
    shortest: float | None = None
    reflections: int = 0
    bends: bool = False

    def found(self, kinds: frozenset[LineKind], progress: Callable[[float], None]) -> Paths:
        """The visible lines, as they come; of no kinds those of annotations."""
        return self._long(self._found(self.scene if kinds else only_annotations(self.scene), kinds, progress))

    def labels(
        self, anchors: LabelAnchors, strokes: Paths | None, text: str = "strokes", mm: float = 1.0
    ) -> SceneLabels:
        """The labels of the scene, apart from strokes, or where there are none from its contours; text: a word of
        LETTERS; mm: how long a millimetre is in units of the page."""
        strokes = self._found(self.scene, OUTLINES, None) if strokes is None else strokes
        return labels_in_place(self.scene, *self._view, self.placement, anchors, strokes, text=text, mm=mm)

    def layers(
        self, layers: Sequence[Layer], pipeline: Pipeline, cue: DepthCue | None, paper: Sequence[int]
    ) -> tuple[Layer, ...]:
        """Layers of visible lines as a pen draws them, by depth too where there is a cue; paper: its colour."""
        world = self.placement.page_from_world
        return inked(self.cued(layers, pipeline, cue, paper), "none", world, self.tolerance_mm)

    def cued(
        self, layers: Sequence[Layer], pipeline: Pipeline, cue: DepthCue | None, paper: Sequence[int]
    ) -> tuple[Layer, ...]:
        """Layers of lines, their strokes by depth where there is a cue."""
        if cue is None or not pipeline.calls_for("depth cue"):
            return tuple(layers)
        from vectorplot.effects.depth_cues import depth_cued

        return pipeline.run(
            "depth cue", depth_cued, tuple(layers), self.view, cue, paper, self.placement.page_from_world
        )

    def strokes(self, scene: Scene, kinds: frozenset[LineKind]) -> Paths:
        """The visible lines as polylines. scene: this one, whatever patterns it has."""
        found = self._long(self._found(scene, kinds, None))
        (layer,) = inked((Layer("", PEN, (found,)),), "none", self.placement.page_from_world)
        return layer.strokes[0]

    def _long(self, found: Paths) -> Paths:
        """The lines that are not too short when they are joined."""
        if not self.shortest:
            return found
        (layer,), _ = without_short((Layer("", PEN, (found,)),), self.shortest)
        return layer.strokes[0]

    def _found(self, scene: Scene, kinds: frozenset[LineKind], progress: Callable[[float], None] | None) -> Paths:
        return lines_in_place(
            scene,
            *self._view,
            self.placement,
            kinds,
            crease_angle_deg=self.crease_angle_deg,
            tolerance_mm=self.tolerance_mm,
            budget=self.budget,
            reflections=self.reflections,
            bends=self.bends,
            progress=progress,
        )

    @cached_property
    def _view(self) -> tuple[View, ProjectedFaces]:
        return with_smooth_surfaces(self.scene, self.view, self.faces)
