"""The heights of level lines, on the lines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.lettering.stroke_lengths import StrokeLengths
from vectorplot.drawing.strokes.join import joined
from vectorplot.drawing.strokes.stroke_paths import chosen
from vectorplot.features.meshes.mesh_curves import MeshCurves
from vectorplot.features.terrains.label_places import label_places
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import segments
from vectorplot.scene.scene import Scene
from vectorplot.tolerances.of_the_page import COINCIDENT_MM
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.drawing.lettering.text import Lettering

SIZE_MM = 1.8
"""The height of figures on level lines."""

ON_A_LINE_MM = 60.0
"""From the middle of one number to that of the next one of the same height, at least."""

APART_MM = 6.0
"""From the middle of one number to that of any other one, at least."""

CROWDED = 2.5
"""Times its width that the lines are long, at most, which a number interrupts, its own one among them."""

OUTLINE = 3.0
"""Times that lines count which are no sections: contours, borders."""

FINE = 2
"""More digits that heights have than the first one of the step from one to the next."""

MOST_DIGITS = 12
"""Of a height."""

ROOM_MM = 1.2
"""Of line that is as straight as under the number before it, and behind it, together."""


def level_numbers(scene: Scene, strokes: Paths, text: str, mm: float) -> list[Lettering]:
    """The heights of numbered sections, upright on their lines where these are straight enough for them.

    strokes: of the picture; text, mm: as of labels_on_page. A line that is nowhere visible and straight over the length
    of the longest number has none.
    """
    from vectorplot.drawing.lettering.labels.label_letters import LETTERS

    which, level, heights = _levels(scene, strokes)
    if not len(which):
        return []
    lines = joined(replace(chosen(strokes, which), curve=level), level, COINCIDENT_MM * mm)
    places = np.column_stack([lines.points, np.zeros(len(lines.points))])
    faces = np.zeros(len(places), dtype=np.intp)
    words = _words(heights)
    letters, size = LETTERS[text].plain, SIZE_MM * mm
    longest = max(float(np.ptp(letters(word, size_mm=size).bounds, axis=0)[0]) for word in words)
    numbers = MeshCurves(places, lines.offsets, lines.closed, faces, lines.curve.astype(np.float64))
    found = label_places(numbers, longest + ROOM_MM * mm, APART_MM * mm)
    way, level = found.directions, found.heights.astype(np.intp)
    # Read from below, and from the right where the line goes straight up.
    angle = np.degrees(arctan2(way[:, 1], way[:, 0]))
    angle -= 180.0 * np.round(angle / 180.0)
    tried = [
        letters(words[number], at[:2], size_mm=size, align="centre", level="middle", rotation_deg=turn)
        for number, at, turn in zip(level.tolist(), found.points, angle.tolist(), strict=True)
    ]
    return [tried[k] for k in _chosen(tried, level, found.points[:, :2], strokes, mm)]


def _words(heights: Floats) -> list[str]:
    """Heights, with so many digits that one can tell each from the next one."""
    steps = np.diff(np.unique(heights)) if len(np.unique(heights)) > 1 else np.abs(heights)
    step = float(steps.min())
    digits = FINE - int(np.floor(math.log10(step))) if step > 0.0 else 0
    return [f"{round(height, digits) + 0.0:.{MOST_DIGITS}g}" for height in heights.tolist()]


def _chosen(tried: Sequence[Lettering], level: Ints, middles: Floats, strokes: Paths, mm: float) -> list[int]:
    """Which numbers to keep, those first that interrupt the shortest lines."""
    boxes = np.array([text.bounds for text in tried]).reshape(-1, 2, 2)
    shown = chosen(strokes, strokes.hidden_by == 0)
    lines = segments(shown)
    begin, end = shown.points[lines].transpose(1, 0, 2)
    outline = ~np.isin(shown.kind, (LineKind.SECTION, LineKind.INDEX))[
        ragged.owner(np.diff(shown.offsets))[lines[:, 0]]
    ]
    wide = np.array([np.hypot(*(text.boxes[0, 1] - text.boxes[0, 0])) for text in tried])
    long = np.zeros(len(tried))
    for some, weight in ((~outline, 1.0), (outline, OUTLINE)):
        long += weight * StrokeLengths.of(begin[some], end[some], SIZE_MM * mm).inside(boxes)
    crossed = long / wide
    kept: list[int] = []
    for k in np.argsort(crossed.round(1), kind="stable").tolist():
        away = np.hypot(*(middles[kept] - middles[k]).T)
        least = np.where(level[kept] == level[k], ON_A_LINE_MM, APART_MM) * mm
        if crossed[k] <= CROWDED and (away >= least).all():
            kept.append(k)
    return kept


def _levels(scene: Scene, strokes: Paths) -> tuple[Ints, Ints, Floats]:
    """Which strokes (k,) are visible lines of numbered sections, the number (k,) of the height of each, and the heights
    (h,)."""
    seen = np.flatnonzero((strokes.hidden_by == 0) & (np.diff(strokes.offsets) > 1))
    ends = np.stack([strokes.points3d[strokes.offsets[seen]], strokes.points3d[strokes.offsets[seen + 1] - 1]])
    which, level, heights = [np.zeros(0, np.intp)], [np.zeros(0, np.intp)], list[float]()
    for number, item in enumerate(scene.items):
        planes = [(section, d) for section in item.curves.sections if section.numbered for d in section.offsets]
        if not planes:
            continue
        kinds = [int(section.kind) for section, _ in planes]
        own = (strokes.item[seen] == number) & np.isin(strokes.kind[seen], kinds)
        normals, offsets = np.array([section.normal for section, _ in planes]), np.array([d for _, d in planes])
        away = np.abs(matmul(ends[:, own], normals.T) - offsets).max(axis=0)
        which.append(seen[own])
        level.append(len(heights) + away.argmin(axis=1))
        upright = np.abs(normals[:, 2]) == 1.0
        heights += np.where(upright, offsets / scene.exaggeration, offsets).tolist()
    return np.concatenate(which), np.concatenate(level), np.array(heights)
