"""Thin transparent faces by sparse strokes and pixels, and what is seen through mirrors and transparent faces."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fill_visibility import in_space
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.hatching import scanned
from vectorplot.drawing.painted_fills import Overlay, fills_on_page
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polygon_cuts import clipped_by_convex, inside_convex, polygon_areas
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, LineElements, joined
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.scene.placement import Placement
from vectorplot.scene.view import View
from vectorplot.shading.painted_colours import Lighting, colours_of, corner_shades_of, opacities
from vectorplot.tolerances import LEAST_DIVISOR
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points
from vectorplot.visibility.projected_faces import Floats32

# Thin transparent faces: real opacity where a format has it, sparse strokes and pixels where it has not.

FEWEST, MOST = 2, 4
"""Of transparent faces every second, third or fourth line or pixel is set."""


@dataclass(frozen=True, eq=False)
class ScreenDoor:
    """Strokes that fill polygons sparsely: start, end (2,k), from left to right along the lines; polygon (k,),
    ascending."""

    start: Floats
    end: Floats
    polygon: Ints

    def __len__(self) -> int:
        return len(self.polygon)


def sparseness(opacity: ArrayLike) -> Ints:
    """(...) 1 for opaque things, else 2, 3 or 4: every how many-th line or pixel comes nearest to an opacity.

    Edge cases: what is clearer than a fifth still gets every fourth one; what is wholly clear gets 0: none at all.
    Source: Glaeser, section 6.6.
    """
    given = np.asarray(opacity, dtype=np.float64)
    nearest = np.clip(np.rint(1.0 / np.maximum(given, LEAST_DIVISOR)), FEWEST, MOST)
    return np.where(given >= 1.0, 1, np.where(given > 0.0, nearest, 0.0)).astype(np.intp)


def screen_door(points: Floats, offsets: Ints, pitch: float, every: ArrayLike, angle_deg: float = 45.0) -> ScreenDoor:
    """Polygons filled with every n-th of parallel lines, as plotters draw transparent faces. points (2 or more, c),
    offsets (m+1,): simple polygons; pitch: distance of lines that fill densely, in the units of the points; every
    (m,) or number: which lines are drawn, 0 for none; angle_deg: from the x-axis. All share one set of lines, so
    neighbours fit.
    Edge cases: a polygon between two lines gets no stroke. Errors: InputError for a pitch not positive; see
    `hatching.scanned`. Source: Glaeser, section 6.6.
    """
    if not 0.0 < pitch < np.inf:
        raise InputError(f"lines {pitch:g} apart fill nothing: expected a positive distance")
    count = len(offsets) - 1
    step = np.broadcast_to(np.asarray(every, dtype=np.intp), (count,))
    turn = np.radians(angle_deg)
    along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    # Lines that are infinitely far from each other meet nothing.
    spacing = np.where(step > 0, pitch * np.maximum(step, 1), np.inf)
    parts = scanned(matmul(along, points[:2]), matmul(across, points[:2]), offsets, np.arange(count), spacing)
    height = across[:, None] * ((parts.line + 0.5) * spacing[parts.region])
    start, end = (along[:, None] * place + height for place in (parts.low, parts.high))
    return ScreenDoor(start, end, parts.region)


# Transparent polygons for pens: sparse parallel lines in their colour.


def screened(fills: Fills, pitch_mm: float, page_from_world: Floats) -> Fills:
    """The polygons, those that one can see through as every second, third or fourth of lines so far apart.

    The lines come after all polygons. page_from_world (4,4) as in Drawing.
    Errors and degenerate cases as in screen_door.
    Source: Glaeser, section 6.6 (every second, third or fourth pixel), for pens.
    """
    clear = (fills.opacity < 1.0) & (np.diff(fills.offsets) > 2)
    glass = fills.take(np.flatnonzero(clear))
    door = screen_door(glass.points.T, glass.offsets, pitch_mm, sparseness(glass.opacity))
    count = len(door)
    flat = np.stack([door.start, door.end], axis=2).reshape(2, -1).T
    first = glass.offsets[:-1]
    lines = Fills(
        np.ascontiguousarray(flat),
        np.arange(0, 2 * count + 1, 2),
        np.repeat(glass.colours[first][door.polygon], 2, axis=0),
        np.ones(count),
        glass.item[door.polygon],
        in_space(glass, flat, np.repeat(door.polygon, 2), page_from_world),
        np.full(count, int(FillKind.GLASS)),
    )
    return Fills.joined(fills.take(np.flatnonzero(~clear)), lines)


# Polygons of the image that are seen through windows: mirrors, or faces of transparent bodies.


@dataclass(frozen=True, eq=False)
class SeenThrough(LineElements):
    """Polygons to be painted right after the windows they are seen through, in order. points (3,c): see ImageFaces,
    heights of the doubles; offsets (m+1,); source (m,): the face seen; window (m,) ascending: the painted polygon
    before; pane (m,): the face of which the window is a part; decal (m,): the decal seen on that face, -1 for the
    face itself.
    """

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    source: Ints = field(metadata=EACH_LINE)
    window: Ints = field(metadata=EACH_LINE)
    pane: Ints = field(metadata=EACH_LINE)
    decal: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.source)


def nothing_seen() -> SeenThrough:
    """No polygons at all."""
    none = np.zeros(0, dtype=np.intp)
    return SeenThrough(np.zeros((3, 0)), np.zeros(1, dtype=np.intp), none, none, none, none)


def seen_through(faces: ImageFaces, painted: ImageFaces, windows: Ints, tolerance: float) -> SeenThrough:
    """Faces (of what is behind windows, back to front), clipped with the windows (n,), numbers of painted polygons.

    Faces whose rectangles do not meet a window's are not looked at, and those wholly inside are not clipped.
    Source: Glaeser, section 6.4.
    """
    if not len(faces) or not len(windows):
        return nothing_seen()
    import shapely

    left, right, bottom, top = faces.box[:4]
    tree = shapely.STRtree(shapely.box(left, bottom, right, top), node_capacity=16)
    left, right, bottom, top = painted.box[:4, windows]
    window, face = tree.query(shapely.box(left, bottom, right, top))
    order = np.lexsort((face, window))
    window, face = windows[window[order]], face[order]
    points, offsets, pair = clipped_pairs(faces, painted, face, window, tolerance)
    window, source = window[pair], faces.source[face[pair]]
    faces_only = np.full(len(window), -1, dtype=np.intp)
    return sorted_by_window(SeenThrough(points, offsets, source, window, painted.source[window], faces_only))


def _wide(points: Floats, offsets: Ints, pair: Ints, tolerance: float) -> tuple[Floats, Ints, Ints]:
    """The polygons that are not narrower than a tolerance in the image."""
    if not len(pair):
        return points, offsets, pair
    normal, spread = polygon_areas(points * [[1.0], [1.0], [0.0]], offsets)
    kept = np.flatnonzero(np.abs(normal[2]) > tolerance * spread)
    position, offsets = ragged.take(offsets, kept)
    return points[:, position], offsets, pair[kept]


def sorted_by_window(seen: SeenThrough) -> SeenThrough:
    """The same polygons by windows; those of one window in the order they have."""
    return seen.take(np.argsort(seen.window, kind="stable"))


def joined_seen(parts: list[SeenThrough]) -> SeenThrough:
    """Polygons of different windows together, by windows."""
    return sorted_by_window(one_after_another(parts))


def one_after_another(parts: list[SeenThrough]) -> SeenThrough:
    """The polygons of all parts as they come."""
    return joined((nothing_seen(), *parts))


def clipped_pairs(
    faces: ImageFaces, windows: ImageFaces, face: Ints, window: Ints, tolerance: float
) -> tuple[Floats, Ints, Ints]:
    """Faces (n,) clipped with windows (n,): points (3,c), offsets (m+1,), and the pair each part is of, ascending.

    Faces wholly inside are not clipped, and parts narrower than the tolerance left out.
    """
    return _wide(*_parts(faces, windows, face, window, tolerance), tolerance)


def _parts(
    faces: ImageFaces, painted: ImageFaces, face: Ints, window: Ints, tolerance: float
) -> tuple[Floats, Ints, Ints]:
    corner, starts = ragged.take(faces.offsets, face)
    border, borders = ragged.take(painted.offsets, window)
    points, sides = faces.points[:, corner], painted.points[:2, border]
    whole = inside_convex(points, starts, sides, borders, tolerance=tolerance)
    if whole.all():
        return points, starts, np.arange(len(face))
    partly = np.flatnonzero(~whole)
    corner, some = ragged.take(starts, partly)
    border, some_borders = ragged.take(borders, partly)
    cut, ends, kept = clipped_by_convex(points[:, corner], some, sides[:, border], some_borders, tolerance=tolerance)
    kept_whole = np.flatnonzero(whole)
    corner, whole_ends = ragged.take(starts, kept_whole)
    pair = np.concatenate([kept_whole, partly[kept]])
    order = np.argsort(pair, kind="stable")
    every = np.concatenate([points[:, corner], cut], axis=1)
    offsets = np.concatenate([whole_ends, ends[1:] + whole_ends[-1]])
    position, offsets = ragged.take(offsets, order)
    return every[:, position], offsets, pair[order]


def near_windows(box: Floats | Floats32, windows: Floats) -> Bools:
    """(n,) which rectangles (4,n), smallest and largest x, smallest and largest y, meet the common one of windows
    (4,w)."""
    left, right, bottom, top = windows
    across = (box[1] >= left.min(initial=np.inf)) & (box[0] <= right.max(initial=-np.inf))
    along = (box[3] >= bottom.min(initial=np.inf)) & (box[2] <= top.max(initial=-np.inf))
    return np.asarray(across & along, dtype=np.bool_)


# What is seen through windows, as filled polygons on the page.


def seen_fills(view: View, lighting: Lighting, seen: SeenThrough, placement: Placement, kind: FillKind) -> Overlay:
    """Polygons seen through windows, in the shades of their faces, each to be painted after its window.

    Edge cases: nothing seen gives nothing. Source: Glaeser, sections 6.4 and 6.6.
    """
    shades = corner_shades_of(view, lighting, view_points(view, seen.points), seen.offsets, seen.source)
    source = np.repeat(seen.source, np.diff(seen.offsets))
    fills = fills_on_page(
        view,
        seen.points,
        seen.offsets,
        placement,
        colours=colours_of(view, lighting, source, shades.total),
        opacity=opacities(lighting.items)[view.shown_item[seen.source]],
        item=view.face_item[seen.source],
        kind=np.full(len(seen), int(kind)),
    )
    return Overlay(fills, seen.window)


def mixed(fills: Fills, tint: Colours, amount: Floats) -> Fills:
    """Polygons with some amount (m,) of other colours (m,3)."""
    sizes = np.diff(fills.offsets)
    share = np.repeat(amount, sizes)[:, None]
    colours = (1.0 - share) * fills.colours + share * np.repeat(tint, sizes, axis=0)
    return replace(fills, colours=np.rint(colours).astype(np.uint8))
