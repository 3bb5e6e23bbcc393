"""Where the texts of dimensions have room: above their lines, or else below them or beyond an arrowhead (ISO 129-1)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.lettering.interrupted import grown, inside_box, near_boxes
from vectorplot.drawing.lettering.labels.label_letters import (
    GAP,
    HALO_MM,
    Letters,
    course_on_page,
    length_of,
    set_along,
)
from vectorplot.drawing.lettering.labels.label_marks import ARROW_MM, direction_at, marked
from vectorplot.drawing.lettering.labels.seen_labels import SeenLabels
from vectorplot.drawing.lettering.text import Lettering
from vectorplot.drawing.lettering.text_along import reads_backwards
from vectorplot.drawing.strokes.stroke_paths import chosen
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polylines import segments
from vectorplot.scene.naming.labels import Along, OnCurve
from vectorplot.scene.placement import Placement
from vectorplot.words import LineKind

ROOM_FOR_HEAD = 1.25
"""A line that is shorter than so many arrowheads, for each of its own, has them outside, pointing at it."""

TAIL = 2.0
"""The line goes on so far outside, in arrowheads."""


@dataclass(frozen=True, eq=False)
class Measure:
    """A text of a dimension, and the strokes (n,2,2) on which its line goes on under it."""

    text: Lettering
    tails: Floats


def arrowheads(seen: SeenLabels) -> dict[str, tuple[float, ...]]:
    """At what parts of its length each curve has arrowheads, by the name of its item."""
    found: dict[str, tuple[float, ...]] = {}
    for label in seen.anchors.labels:
        if label.mark == "arrow" and isinstance(label.at, OnCurve):
            found[label.at.item] = (*found.get(label.at.item, ()), label.at.part)
    return found


def heads_outside(length: float, heads: Sequence[float], mm: float) -> bool:
    """Whether a line of a length on the page has no room for its arrowheads, several; mm: how long a millimetre is
    there."""
    return len(heads) > 1 and length < ROOM_FOR_HEAD * ARROW_MM * mm * len(heads)


def tail(point: Floats, way: Floats, mm: float) -> Floats:
    """(2,2) the line behind an arrowhead that points at its end along way (2,) from outside."""
    return np.stack([point, point - TAIL * ARROW_MM * mm * way])


def measures_tried(
    path: Floats,
    heads: Sequence[float],
    usual: Lettering,
    set_at: Callable[[str, float], Lettering],
    gap: float,
    mm: float,
) -> list[Measure]:
    """Where the text of a dimension may stand along its line (n,2), the best first; usual: the text above it.

    heads: as of arrowheads; set_at: the text above or below, at a part of the length of the line, outside of 0 to 1
    beyond its ends; gap: from the end of the line to a text beyond it.
    """
    whole = float(np.hypot(*np.diff(path, axis=0).T).sum())
    none = np.zeros((0, 2, 2))
    found = [Measure(usual, none), Measure(set_at("below", 0.5), none)]
    begins = TAIL * ARROW_MM * mm if heads_outside(whole, heads, mm) else 0.0
    backwards = reads_backwards(*(path[-1] - path[0]).tolist())
    for at in sorted(set(heads), reverse=not backwards):
        end, before = (path[0], path[1]) if at == 0.0 else (path[-1], path[-2])
        step = end - before
        if not step.any():
            continue
        way = step / np.hypot(*step)
        wide = float(np.ptp(matmul(usual.boxes.reshape(-1, 2), way)))
        beyond = (begins + gap + 0.5 * wide) / whole
        text = set_at("above", -beyond if at == 0.0 else 1.0 + beyond)
        found.append(Measure(text, end + np.array([[[begins], [begins + gap + wide]]]) * way))
    return found


def with_room(
    tried: Mapping[int, Sequence[Measure]], strokes: Paths, page: Floats, margin: float
) -> dict[int, Measure]:
    """Of each label the text on the page (2,2) that interrupts least of the strokes, of several the first one.

    margin: what keeps letters and strokes apart; the thin lines of other annotations, such as extension lines, may end
    at the letters without one.
    """
    every = [(label, measure) for label, some in tried.items() for measure in some]
    boxes = [measure.text.boxes for _, measure in every]
    owner = np.repeat(np.arange(len(every)), [len(own) for own in boxes])
    corners = np.concatenate([np.zeros((0, 4, 2)), *boxes])
    thin = strokes.kind == int(LineKind.LABEL)
    long = np.zeros(len(every))
    for some, around in ((~thin, grown(corners, margin)), (thin, corners)):
        lines = chosen(strokes, some)
        start, end = lines.points[segments(lines)].transpose(1, 0, 2)
        segment, box = near_boxes(start, end, around)
        low, high = inside_box(start[segment], end[segment], around[box])
        inside = np.maximum(high - low, 0.0) * np.hypot(*(end - start)[segment].T)
        long += np.bincount(owner[box], inside, minlength=len(every))
    leaves = [bool(((own < page[0]) | (own > page[1])).any()) for own in boxes]
    cost: dict[int, list[tuple[bool, float, int]]] = {}
    for number, (label, _) in enumerate(every):
        cost.setdefault(label, []).append((leaves[number], float(long[number]), number))
    return {label: every[min(some)[2]][1] for label, some in cost.items()}


def measures_on_page(
    letters: Letters,
    seen: SeenLabels,
    paths: Mapping[int, Floats],
    usual: Mapping[int, Lettering],
    heads: Mapping[str, tuple[float, ...]],
    strokes: Paths,
    page: Floats,
    mm: float,
) -> dict[int, Measure]:
    """The texts above lines with arrowheads, each where it interrupts least of the strokes, without hatches.

    paths: the courses of lines by the numbers of labels along them; usual: these labels above them; heads: as of
    arrowheads; page (2,2): its corners.
    """
    tried = {}
    for k, path in paths.items():
        label = seen.anchors.labels[k]
        if isinstance(label.at, Along) and label.place == "above" and label.at.item in heads:

            def set_at(place: str, part: float, k: int = k, path: Floats = path) -> Lettering:
                return set_along(letters, seen, k, path, mm, place, part)

            gap = GAP * label.size_mm * mm
            tried[k] = measures_tried(path, heads[label.at.item], usual[k], set_at, gap, mm)
    if not tried:
        return {}
    return with_room(tried, chosen(strokes, strokes.kind != int(LineKind.HATCH)), page, HALO_MM * mm)


def mark_with_room(
    seen: SeenLabels, number: int, heads: Mapping[str, tuple[float, ...]], placement: Placement, mm: float
) -> list[Floats]:
    """The strokes of the mark of a label; arrowheads that have no room in their line point at it from outside."""
    label, point = seen.anchors.labels[number], seen.points[number]
    if label.mark not in ("arrow", "tick") or not isinstance(label.at, OnCurve):
        return marked(label, point, np.zeros(2), mm)
    way = direction_at(seen, number, placement)
    own = heads.get(label.at.item, ())
    if label.mark != "arrow" or not way.any():
        return marked(label, point, way, mm)
    if heads_outside(length_of(course_on_page(seen, number, placement)), own, mm):
        return [*marked(label, point, -way, mm), tail(point, -way, mm)]
    return marked(label, point, way, mm)
