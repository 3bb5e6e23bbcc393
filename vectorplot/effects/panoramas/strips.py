"""A panorama on its page: strips of it, one below the other, each with its bearings."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.lettering.scene_labels import NO_ITEM
from vectorplot.drawing.lettering.text import lettered
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated
from vectorplot.effects.panoramas.sectors import Trace, lines_all_round, with_chords
from vectorplot.geometry import ragged
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.panoramic_view import MOST_STRIPS, Panorama
from vectorplot.geometry.cameras.unit_projection import projection_of
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement, fitted_picture
from vectorplot.words import LineKind

LETTERS_MM = 2.5
"""The height of the capitals of bearings."""

SCALE_MM = 7.0
"""What the bearings below a strip take of the page, and the gap to the next one."""

TICKS_MM = (1.0, 1.6, 2.2)
"""Of every fifth degree, of every fifteenth, and of those with a name."""

LARGER = 1.25
"""A panorama is traced again where it comes out so many times larger than it was taken for."""

PART_OF_TOLERANCE = 0.4
"""Chords take so much of the tolerance, or a half where the panorama comes out larger by a quarter."""

LEAST_RADIANS = 1.0 / 500.0
"""What is seen is taken for as high as this at least: of a plain one sees a line."""

USUAL_RADIANS = 0.2
"""How high what is seen is taken for before it is known."""

WINDS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")
"""Every eighth of the round."""


@dataclass(frozen=True, eq=False)
class Strips:
    """Where a panorama is on the page: each strip begins at left_mm, and its horizon is at horizons_mm (n,); a radian
    is radius_mm long; low, high: the elevations at the lower and the upper side of strips."""

    page: Page
    radius_mm: float
    left_mm: float
    horizons_mm: Floats
    low: float
    high: float


def panorama_on_page(
    given: Panorama,
    eye: Floats,
    sheet: Page,
    tolerance_mm: float,
    trace: Trace,
    done: Callable[[float], None] | None = None,
) -> tuple[Paths, Paths, Placement]:
    """The lines that are seen from a place all round as strokes on the page, the marks of its bearings, and the place
    of the flat picture that they are.

    sheet: that the panorama is fitted to, as pictures of cameras are; trace: what a camera sees on a page.
    """
    width = float(np.radians(given.width_deg))
    low, high = np.radians(given.lowest_deg), np.radians(given.highest_deg)
    radius = _strips(given, sheet, width, 0.0, USUAL_RADIANS).radius_mm
    while True:
        seen = lines_all_round(given, eye, radius, trace, done)
        lines = _within(with_chords(seen, eye, PART_OF_TOLERANCE * tolerance_mm / radius), 1, low, high)
        found = _strips(given, sheet, width, *_extent(lines))
        if found.radius_mm <= LARGER * radius:
            break
        radius = found.radius_mm
    first, part = float(np.radians(given.bearings_deg[0])), width / len(found.horizons_mm)
    strokes = [Paths.empty()]
    for number, horizon in enumerate(found.horizons_mm):
        start = first + number * part
        own = _within(lines, 0, start, start + part)
        points = found.radius_mm * (own.points - (start, 0.0)) + (found.left_mm, horizon)
        strokes.append(replace(own, points=points))
    return concatenated(tuple(strokes)), _scales(given, found), _flat(found.page)


def _flat(page: Page) -> Placement:
    """The place of a picture whose world is the page itself."""
    corner = np.array([page.width_mm, page.height_mm, 0.0])
    above = projection_of(Camera.view("top", target=tuple((0.5 * corner).tolist())), np.stack([0.0 * corner, corner]))
    image = above.image_of(above.points_of(np.stack([0.0 * corner, corner])))
    whole = fitted_picture(above, Page(page.width_mm, page.height_mm, 0.0), image)
    return replace(whole, page=page)


def _extent(lines: Paths) -> tuple[float, float]:
    """The lowest and the highest elevation of lines, the horizon where there are none."""
    if not len(lines):
        return 0.0, LEAST_RADIANS
    low, high = float(lines.points[:, 1].min()), float(lines.points[:, 1].max())
    return low, max(high, low + LEAST_RADIANS)


def _radius(strips: int, sheet: Page, width: float, height: float) -> float:
    """How long a radian may be on a sheet."""
    across, up = sheet.room
    return min(strips * across / width, max(up / strips - SCALE_MM, 0.0) / height)


def _strips(given: Panorama, sheet: Page, width: float, low: float, high: float) -> Strips:
    """The strips, as many as are asked for, or as many as make the picture largest."""
    counts = (given.strips,) if given.strips else range(1, MOST_STRIPS + 1)
    radius, fewest = max((_radius(count, sheet, width, high - low), -count) for count in counts)
    count = -fewest
    if not radius > 0.0 or not math.isfinite(radius):
        radius, count = sheet.room[0] / width, given.strips or 1
    each = radius * (high - low) + SCALE_MM
    page = sheet.around(radius * width / count, count * each)
    left = 0.5 * (page.width_mm - radius * width / count)
    top = 0.5 * (page.height_mm + count * each)
    horizons = np.asarray(top - each * np.arange(count) - radius * high, dtype=np.float64)
    return Strips(page, radius, left, horizons, low, high)


def _within(lines: Paths, axis: int, low: float, high: float) -> Paths:
    """What straight parts of two points have between two values of a coordinate; what lies on the higher one only
    stays out where it runs along it."""
    ends = lines.points.reshape(-1, 2, 2)
    values = ends[:, :, axis]
    start, rise = values[:, 0], values[:, 1] - values[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = np.stack([(low - start) / rise, (high - start) / rise], axis=1)
    level = rise == 0.0
    inside: Bools = (start >= low) & (start < high)
    at[level] = np.where(inside[level, None], (0.0, 1.0), (2.0, 2.0))
    begin = np.clip(at.min(axis=1), 0.0, 1.0)
    end = np.clip(at.max(axis=1), 0.0, 1.0)
    kept = np.flatnonzero((end > begin) & (at.min(axis=1) < 1.0) & (at.max(axis=1) > 0.0))
    share = np.stack([begin, end], axis=1)[kept][:, :, None]
    parts = chosen(lines, kept)
    ends, solid = parts.points.reshape(-1, 2, 2), parts.points3d.reshape(-1, 2, 3)
    points, space = (each[:, :1] + share * (each[:, 1:] - each[:, :1]) for each in (ends, solid))
    return replace(parts, points=points.reshape(-1, 2), points3d=space.reshape(-1, 3))


def _scales(given: Panorama, strips: Strips) -> Paths:
    """Below each strip a line with a tick every five degrees, and the names of the winds."""
    first, last = given.bearings_deg
    count = len(strips.horizons_mm)
    part = (last - first) / count
    lines: list[Floats] = []
    for number, horizon in enumerate(strips.horizons_mm):
        start = first + number * part
        foot = horizon + strips.radius_mm * strips.low - 0.5
        right = strips.left_mm + strips.radius_mm * math.radians(part)
        lines.append(np.array([(strips.left_mm, foot), (right, foot)]))
        for degree in range(5 * math.ceil(round(start / 5.0, 6)), math.floor(round(start + part, 6)) + 1, 5):
            x = strips.left_mm + strips.radius_mm * math.radians(degree - start)
            named = degree % 45 == 0
            long = TICKS_MM[2 if named else 1 if degree % 15 == 0 else 0]
            lines.append(np.array([(x, foot), (x, foot - long)]))
            if named:
                name = WINDS[degree // 45 % 8]
                text = lettered(name, (x, foot - TICKS_MM[2] - 0.8), size_mm=LETTERS_MM, align="centre", level="top")
                lines += [text.strokes[k] for k in range(len(text.strokes))]
    total = len(lines)
    points = np.concatenate([np.zeros((0, 2)), *lines])
    none = np.zeros(total, dtype=np.intp)
    return Paths(
        points,
        ragged.offsets([len(line) for line in lines]),
        np.zeros(total, dtype=np.bool_),
        np.full(total, int(LineKind.LABEL)),
        none + NO_ITEM,
        none,
        np.column_stack([points, np.zeros(len(points))]),
    )
