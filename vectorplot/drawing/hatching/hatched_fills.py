"""Filled polygons hatched: strokes of a pen in what is seen of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.fills_without_overlaps import planes_of_fills
from vectorplot.drawing.hatching.densities import even_spacings, thresholds
from vectorplot.drawing.hatching.followed_lines import FollowedLines, dark_parts
from vectorplot.drawing.hatching.hatching_frames import PageFrame, PlaneFrame, plane_frame
from vectorplot.drawing.hatching.scan import Scanned, scanned
from vectorplot.drawing.hatching.stippling import stippled
from vectorplot.drawing.hatching.toned_regions import TonedRegions, toned_regions
from vectorplot.drawing.strokes.stroke_paths import concatenated
from vectorplot.geometry.vectors import cross
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.tolerances.of_angles import SAME_PLANE_SINE
from vectorplot.tolerances.of_the_page import HATCH_GAP_MM
from vectorplot.words import LineKind

CRUMB = 4.0
"""Regions of one shade that are smaller, in squares of the distance between lines, have no strokes of their own."""


def hatched_fills(fills: Fills, hatching: Sequence[Hatching | Stippling | None], page_from_world: Floats) -> Paths:
    """Strokes, as they come, that hatch the visible regions of polygons as dark as their colours.

    Parameters
    ----------
    fills : Fills
        Each painted over those before it.
    hatching : sequence of Hatching or None
        Of every item that has polygons.
    page_from_world : (4, 4) array of float
        As of Drawing.

    Returns
    -------
    Paths
        Strokes of two points, of the kind HATCH.

    Raises
    ------
    InputError
        Where there are more strokes than any paper takes.

    Notes
    -----
    A plain region, and neighbours of it that are as dark, has strokes at equal distances; where the darkness varies,
    strokes begin where it is dark enough for them. All regions of an item share their lines.

    Error: regions are known to a few GRID_MM; gaps in a stroke below HATCH_GAP_MM, as between the facets of what is
    round, are closed.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.drawing import Fills, hatched_fills
    >>> square = np.array([(10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0)])
    >>> black = Fills.flat(square, np.array([0, 4]), np.zeros((1, 3), dtype=np.uint8), item=0)
    >>> strokes = hatched_fills(black, [vp.Hatching(spacing_mm=1.0, angle_deg=0.0)], np.eye(4))
    >>> len(strokes), strokes.points[:2].tolist()
    (10, [[10.0, 10.5], [20.0, 10.5]])
    """
    return hatched_regions(toned_regions(fills), hatching, page_from_world)


def hatched_regions(
    regions: TonedRegions,
    hatching: Sequence[Hatching | Stippling | None],
    page_from_world: Floats,
    followed: Sequence[FollowedLines] = (),
) -> Paths:
    """Strokes, as they come, that hatch regions. followed: the lines of items that are hatched along such; the others
    as of hatched_fills."""
    given = [Hatching("none") if one is None else one for one in hatching]
    scan = _without_lines(regions, followed)
    found = []
    for lines in followed:
        along = given[lines.item]
        assert isinstance(along, Hatching)
        found.append(dark_parts(lines, along, regions))
    for one in dict.fromkeys(given):
        if one.by == "none":
            continue
        mine = np.array([other == one for other in given], dtype=np.bool_)
        some = regions.some(mine[regions.item] & (regions.item >= 0) & scan)
        if isinstance(one, Stippling):
            found.append(stippled(some, one, page_from_world))
            continue
        for family in (0, 1) if one.cross else (0,):
            found += _family(some, one, family, page_from_world)
    return concatenated((Paths.empty(), *found))


def _without_lines(regions: TonedRegions, followed: Sequence[FollowedLines]) -> Bools:
    """(n,) the regions that no followed lines lie on: of items that have such the flat ends."""
    found = np.ones(len(regions), dtype=np.bool_)
    if not followed or not len(regions):
        return found
    normal = planes_of_fills(regions.fills)[0][regions.source]
    for lines in followed:
        tilted = np.linalg.norm(cross(normal, lines.ends), axis=1) > SAME_PLANE_SINE
        found &= (regions.item != lines.item) | (lines.ends.any() & ~tilted)
    return found


def _family(regions: TonedRegions, hatching: Hatching, family: int, page_from_world: Floats) -> list[Paths]:
    """The strokes of one direction: of plain regions, and of those where darkness varies."""
    angle = float(np.radians(hatching.angle_deg)) + family * np.pi / 2.0
    page = PageFrame(angle)
    plain = regions.plain & ~_crumbs(regions, hatching.spacing_mm) | (hatching.by == "even")
    even, varied = regions.some(plain), regions.some(~plain)
    found = []
    spacing = even_spacings(hatching, np.ones(len(even)) if hatching.by == "even" else even.lowest)[family]
    even, spacing = even.some(np.isfinite(spacing)), spacing[np.isfinite(spacing)]
    if len(even):
        frame = page if hatching.along != "surface" else plane_frame(even, angle, page_from_world)
        parts = scanned(*frame.coordinates(even), even.offsets, even.of, spacing)
        tone = np.unique(spacing, return_inverse=True)[1].ravel()
        found.append(_strokes(even, frame, parts, spacing, tone, page_from_world))
    if len(varied):
        spacing = np.full(len(varied), hatching.spacing_mm)
        parts = scanned(*page.coordinates(varied), varied.offsets, varied.of, spacing)
        parts = _dark_enough(varied, page, parts, thresholds(hatching, family, parts.line), hatching.spacing_mm)
        found.append(_strokes(varied, page, parts, spacing, np.zeros(len(varied), dtype=np.intp), page_from_world))
    return found


def _crumbs(regions: TonedRegions, spacing_mm: float) -> Bools:
    """(n,) the regions of items with varying darkness in planes of less than CRUMB squares between lines: triangles of
    round bodies that happen to have one shade. Their strokes are those of the regions around them."""
    round_ = np.unique(regions.item[~regions.plain])
    normal = planes_of_fills(regions.fills)[0][regions.source]
    rows = np.column_stack([regions.item, np.rint(normal / SAME_PLANE_SINE)])
    group = np.unique(rows, axis=0, return_inverse=True)[1].ravel()
    area = np.bincount(group, regions.areas, minlength=len(rows))[group]
    return np.isin(regions.item, round_) & (area < CRUMB * spacing_mm * spacing_mm)


def _dark_enough(
    regions: TonedRegions, frame: PageFrame, parts: Scanned, threshold: Floats, spacing_mm: float
) -> Scanned:
    """The parts of lines, each as far as it is darker than a threshold (k,)."""
    of, v = parts.region, np.asarray((parts.line + 0.5) * spacing_mm)
    first, last = (regions.darkness_at(frame.on_page(u, v), of) for u in (parts.low, parts.high))
    dark, dark_end = first > threshold, last > threshold
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.clip((threshold - first) / (last - first), 0.0, 1.0)
    cut = parts.low + share * (parts.high - parts.low)
    low, high = np.where(dark, parts.low, cut), np.where(dark_end, parts.high, cut)
    kept = np.flatnonzero((dark | dark_end) & (high > low))
    return Scanned(parts.region[kept], parts.line[kept], low[kept], high[kept])


def _strokes(
    regions: TonedRegions,
    frame: PageFrame | PlaneFrame,
    parts: Scanned,
    spacing: Floats,
    tone: Ints,
    page_from_world: Floats,
) -> Paths:
    """The parts as strokes, those that follow each other on a line of one item and tone (n,) as one."""
    item = regions.item
    order = np.lexsort(
        (parts.low, parts.line, tone[parts.region], frame.sheet(regions)[parts.region], item[parts.region])
    )
    region, line, low, high = (column[order] for column in (parts.region, parts.line, parts.low, parts.high))
    rows = np.stack([line, tone[region], frame.sheet(regions)[region], item[region]])
    new = np.ones(len(line), dtype=np.bool_)
    new[1:] = (rows[:, 1:] != rows[:, :-1]).any(axis=0) | (low[1:] > high[:-1] + HATCH_GAP_MM)
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(new))[: len(first)] - 1
    ends = np.stack([first, last], axis=1).ravel()
    u = np.stack([low[first], high[last]], axis=1).ravel()
    v = (line[ends] + 0.5) * spacing[region[ends]]
    points, in_space = frame.points(regions, region[ends], u, v, page_from_world)
    count = len(first)
    none = np.zeros(count, dtype=np.intp)
    kind = np.full(count, int(LineKind.HATCH))
    open_ = np.zeros(count, dtype=np.bool_)
    return Paths(points, 2 * np.arange(count + 1), open_, kind, item[region[first]], none, in_space)
