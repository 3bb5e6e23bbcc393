"""The labels of a scene on the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.layers import PENS
from vectorplot.drawing.lettering.interrupted import grown, outside_boxes, outside_others
from vectorplot.drawing.lettering.labels.label_letters import (
    GAP,
    HALO_MM,
    LETTERS,
    course_on_page,
    length_of,
    set_along,
    set_label,
)
from vectorplot.drawing.lettering.labels.label_marks import ARROW_MM, ARROW_SLOPE, MARK_MM, TICK
from vectorplot.drawing.lettering.labels.labels_with_room import labels_with_room, ticks_with_room
from vectorplot.drawing.lettering.labels.measures import arrowheads, mark_with_room, measures_on_page
from vectorplot.drawing.lettering.labels.seen_labels import SeenLabels
from vectorplot.drawing.lettering.placing import places
from vectorplot.drawing.lettering.text import Lettering
from vectorplot.drawing.strokes.long_strokes import split_long
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated
from vectorplot.drawing.texts import Texts
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import segments
from vectorplot.scene.naming.labels import Along, BesidePoint, Label, OnPage
from vectorplot.scene.placement import Placement
from vectorplot.words import LineKind

NO_ITEM = -1
"""Strokes of labels belong to no item."""

BESIDE = 0.4
"""A box whose middle lies farther from a point across, as a part of its width, stands beside it."""


@dataclass(frozen=True, eq=False)
class SceneLabels:
    """Labels on the page: letters, leaders and marks as strokes, those of what is hidden apart as faint; letters of a
    font as texts; boxes (b,4,2) before which the lines of the drawing end, faint_boxes (c,4,2) before which only
    hidden ones do; off_page: the names of those whose letters leave the page."""

    strokes: Paths
    faint: Paths
    texts: Texts
    boxes: Floats
    faint_boxes: Floats
    off_page: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.boxes) + len(self.faint_boxes)

    @property
    def every_box(self) -> Floats:
        """(b+c,4,2) all boxes."""
        return np.concatenate([self.boxes, self.faint_boxes])

    def interrupted(self, strokes: Paths, page_from_world: Floats) -> Paths:
        """The strokes of a drawing without what lies behind the letters."""
        whole = outside_boxes(strokes, self.boxes, page_from_world)
        if not len(self.faint_boxes):
            return whole
        hidden = outside_boxes(chosen(whole, whole.hidden_by > 0), self.faint_boxes, page_from_world)
        return concatenated((chosen(whole, whole.hidden_by == 0), hidden))

    def blanks(self, colour: Colours) -> Fills:
        """Polygons in the colour (1,3) of the paper under the letters: fills end before these, as lines do."""
        corners, count = self.boxes.reshape(-1, 2), len(self.boxes)
        return Fills.flat(corners, 4 * np.arange(count + 1), np.repeat(colour, count, axis=0), kind=FillKind.BACKGROUND)

    def on_top(
        self,
        layers: tuple[Layer, ...],
        by_kind: bool,
        longest_mm: float | None,
        page_from_world: Floats,
        pen: Pen = PENS["label"],
    ) -> tuple[Layer, ...]:
        """The layers of a drawing, and one of the labels; by_kind: it has its number among the layers by kind. Faint
        letters are on the layer of hidden lines.

        longest_mm: longer strokes leave in parts; pen: of the letters.
        """
        strokes, faint = (
            some if longest_mm is None else split_long(some, longest_mm, page_from_world)
            for some in (self.strokes, self.faint)
        )
        marks = (strokes, self.texts) if len(self.texts) else (strokes,)
        names = [layer.name for layer in layers]
        if "label" not in names:
            layers = _with_label_layer(layers, Layer("label", pen, ()), by_kind)
        if len(faint) and "hidden" not in names:
            at = [layer.name for layer in layers].index("label")
            hidden = Layer("hidden", replace(PENS["hidden"], colour=pen.colour), ())
            layers = (*layers[:at], hidden, *layers[at:])
        more = {"label": marks, "hidden": (faint,) if len(faint) else ()}
        return tuple(replace(layer, marks=(*layer.marks, *more.get(layer.name, ()))) for layer in layers)


def _with_label_layer(layers: tuple[Layer, ...], label: Layer, by_kind: bool) -> tuple[Layer, ...]:
    """The layers and that of the labels: with its number among the kinds, or behind the others."""
    if not by_kind:
        return (*layers, label)
    before = (*PENS,)[: (*PENS,).index("label")]
    alike = takewhile(lambda pair: pair[0].name.startswith(pair[1]), zip(layers, before, strict=False))
    kinds = len(list(alike))
    empty = (Layer(name, PENS[name], (Paths.empty(),)) for name in before[kinds:])
    return (*layers[:kinds], *empty, label, *layers[kinds:])


def labels_on_page(
    seen: SeenLabels, placement: Placement, strokes: Paths, hidden: str, text: str = "strokes", mm: float = 1.0
) -> SceneLabels:
    """The letters of labels, apart from strokes and from each other. Along a curve whose image is shorter than a letter
    is high, seen end-on, they stand beside its point.

    strokes: of the drawing; hidden: what becomes of hidden lines; text: a word of LETTERS; mm: how long a millimetre is
    in units of the page.
    Errors: InputError, with the label's name, for a character without strokes.
    """
    letters, seen = LETTERS[text], ticks_with_room(seen, placement, mm)
    ways = [label.hidden or hidden for label in seen.anchors.labels]
    some = [k for k, way in enumerate(ways) if not seen.hidden_by[k] or way != "none"]
    some = labels_with_room(seen, some, mm)
    labels = [seen.anchors.labels[k] for k in some]
    paths = {k: course_on_page(seen, k, placement) for k in some if isinstance(seen.anchors.labels[k].at, Along)}
    along = [k for k, path in paths.items() if length_of(path) > seen.anchors.labels[k].size_mm * mm]
    set_: dict[int, Lettering] = {k: set_along(letters, seen, k, paths[k], mm) for k in along}
    beside = [k for k in some if k not in set_]
    gap = np.array([_gap(seen.anchors.labels[k], mm) for k in beside])
    rooms = (placement.page.width_mm - 2.0 * gap).tolist()
    texts = [set_label(letters, seen.anchors.labels[k], room, mm) for k, room in zip(beside, rooms, strict=True)]
    shown = strokes if hidden != "none" else chosen(strokes, strokes.hidden_by == 0)
    begin, end = shown.points[segments(shown)].transpose(1, 0, 2)
    page = np.array([[0.0, 0.0], [placement.page.width_mm, placement.page.height_mm]])
    heads = arrowheads(seen)
    measures = measures_on_page(letters, seen, {k: paths[k] for k in along}, set_, heads, shown, page, mm)
    set_ |= {k: measure.text for k, measure in measures.items()}
    sizes = np.array([np.ptp(text.bounds, axis=0) for text in texts]).reshape(-1, 2)
    height = np.array([seen.anchors.labels[k].size_mm * mm for k in beside])
    taken = np.array([set_[k].bounds for k in along]).reshape(-1, 2, 2)
    asked = [_asked(seen.anchors.labels[k]) for k in beside]
    points = np.array([_named(seen, k, mm) for k in beside]).reshape(-1, 2)
    found = places(points, sizes, height, gap, asked, begin, end, page, taken)
    for number, k in enumerate(beside):
        middle = found.middles[number] - 0.5 * texts[number].bounds.sum(axis=0)
        text_ = texts[number].moved(middle)
        # In whatever font, letters keep their distance from what they stand beside.
        set_[k] = replace(
            text_, texts=text_.texts.anchored(_side(found.middles[number], sizes[number], seen.points[k]))
        )
    told = [*zip((beside[of] for of in found.label), found.leaders, strict=True)]
    told += [(k, line) for k, measure in measures.items() for line in measure.tails]
    lines_of = _outside_letters(told, set_, HALO_MM * mm)
    faint = [bool(seen.hidden_by[k]) and ways[k] == "dashed" for k in some]
    parts = []
    for k in some:
        lines = [*_lines(set_[k]), *mark_with_room(seen, k, heads, placement, mm)]
        parts.append(label_paths([*lines, *lines_of.get(k, [])], int(seen.hidden_by[k]), placement))
    both = []
    for wanted in (False, True):
        own = [n for n, is_faint in enumerate(faint) if is_faint is wanted]
        boxes = np.concatenate([np.zeros((0, 4, 2)), *(set_[some[n]].boxes for n in own)])
        both.append((concatenated((Paths.empty(), *(parts[n] for n in own))), grown(boxes, HALO_MM * mm)))
    (shown, boxes), (hidden_, faint_boxes) = both
    by = [int(seen.hidden_by[k]) if is_faint else 0 for k, is_faint in zip(some, faint, strict=True)]
    written = Texts.joined([set_[k].texts.hidden(count) for k, count in zip(some, by, strict=True)])
    off_page = tuple(label.name for k, label in zip(some, labels, strict=True) if _leaves(page, set_[k].boxes))
    return SceneLabels(shown, hidden_, written, boxes, faint_boxes, off_page)


def _outside_letters(
    lines: Sequence[tuple[int, Floats]], letters: Mapping[int, Lettering], margin: float
) -> dict[int, list[Floats]]:
    """Of the straight lines (2,2) of labels, by their numbers, what is outside of the letters of others."""
    if not lines:
        return {}
    own = np.array([k for k, _ in lines])
    owner = np.repeat([*letters], [len(text.boxes) for text in letters.values()])
    boxes = grown(np.concatenate([text.boxes for text in letters.values()]), margin)
    parts, line = outside_others(np.array([line for _, line in lines]), own, boxes, owner)
    found: dict[int, list[Floats]] = {}
    for k, part in zip(own[line].tolist(), parts, strict=True):
        found.setdefault(k, []).append(part)
    return found


def with_letters(labels: SceneLabels, letters: Sequence[Lettering], placement: Placement, mm: float) -> SceneLabels:
    """Labels, and more letters that stand on lines, those that would stand in a label left out."""
    free = [text for text in letters if not _overlap(text.boxes, labels.every_box)]
    if not free:
        return labels
    strokes = label_paths([line for text in free for line in _lines(text)], 0, placement)
    boxes = grown(np.concatenate([text.boxes for text in free]), HALO_MM * mm)
    return replace(
        labels,
        strokes=concatenated((labels.strokes, strokes)),
        texts=Texts.joined([labels.texts, *(text.texts for text in free)]),
        boxes=np.concatenate([labels.boxes, boxes]),
    )


def _overlap(boxes: Floats, others: Floats) -> bool:
    """Whether bounds of any of boxes (b,4,2) overlap those of others (c,4,2)."""
    low, high = boxes.min(axis=1)[:, None], boxes.max(axis=1)[:, None]
    return bool(((low < others.max(axis=1)) & (high > others.min(axis=1))).all(axis=2).any())


def _leaves(page: Floats, boxes: Floats) -> bool:
    """Whether corners of boxes (b,4,2) are off the page, given by its corners (2,2)."""
    return bool(((boxes < page[0]) | (boxes > page[1])).any())


def _asked(label: Label) -> str:
    if not label.text.strip():
        return "centre"
    return "above_right" if isinstance(label.at, OnPage) and label.place == "auto" else label.place


def _gap(label: Label, mm: float) -> float:
    """From a point to the letters beside it: a mark there, and a little more than lines keep away."""
    mark = {"none": 0.0, "tick": TICK * MARK_MM, "arrow": ARROW_SLOPE * ARROW_MM}.get(label.mark, 0.7 * MARK_MM)
    return max(GAP * label.size_mm, 1.5 * HALO_MM) * mm + mark * mm


def _side(middle: Floats, size: Floats, point: Floats) -> float:
    """What part of the lines of a text lies before the side of its box that is next to a point: 0 on the right of it, 1
    on its left, 0.5 above and below."""
    across = float(middle[0] - point[0])
    beside = abs(across) >= BESIDE * float(size[0])
    return 0.5 - 0.5 * float(np.sign(across)) if beside else 0.5


def _named(seen: SeenLabels, number: int, mm: float) -> Floats:
    """(2,) the point on the page that a label stands at or beside."""
    at = seen.anchors.labels[number].at
    beside = at.middle_mm if isinstance(at, BesidePoint) else (0.0, 0.0)
    return np.asarray(seen.points[number] + mm * np.array(beside))


def _lines(text: Lettering) -> list[Floats]:
    return [text.strokes[k] for k in range(len(text.strokes))]


def label_paths(lines: Sequence[Floats], hidden_by: int, placement: Placement) -> Paths:
    """Polylines on the page as strokes of labels."""
    points = np.concatenate([np.zeros((0, 2)), *lines])
    count = len(lines)
    return Paths(
        points,
        ragged.offsets([len(line) for line in lines]),
        np.zeros(count, dtype=np.bool_),
        np.full(count, int(LineKind.LABEL)),
        np.full(count, NO_ITEM),
        np.full(count, hidden_by),
        _in_the_image_plane(points, placement),
    )


def _in_the_image_plane(points: Floats, placement: Placement) -> Floats:
    """(p,3) the points of the world whose images points on the page are, in the plane of the image."""
    projection = placement.projection
    image = (points - placement.page_from_image[:2, 2]).T / placement.scale
    foot = projection.target[:2] if projection.eye is None else projection.eye[:2]
    depth = 0.0 if projection.eye is None else projection.eye[2] - projection.focus
    return projection.world_of(np.vstack([image + foot[:, None], np.full(len(points), depth)]))
