"""Filled polygons through cairo."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from vectorplot.backends.areas import Areas
from vectorplot.geometry.mesh import Ints

if TYPE_CHECKING:
    import cairo

Corners = list[list[float]]
Colours = list[tuple[float, float, float]]


def paint(
    context: cairo.Context[Any], areas: Areas, scale: float, height: float, line_width: float, seam: float
) -> None:
    """Paint the polygons. Cairo takes one side a call, so this loops over points.

    scale: device units per micron; height: of the page's lower border in them, from the top; line_width: of polygons of
    two corners; seam: of the line around opaque ones.
    """
    points = (areas.microns * (scale, -scale) + (0.0, height)).tolist()
    colours = [(r, g, b) for r, g, b in (areas.colours / 255.0).tolist()]
    starts, shaded, line = areas.offsets.tolist(), areas.shaded.tolist(), (areas.sizes == 2).tolist()
    opacity, bare, group = areas.own_opacity.tolist(), areas.bare.tolist(), areas.group.tolist()
    ends = dict(areas.group_ends.tolist())
    end, clip = -1, None
    for first, last in pairwise(areas.runs.tolist()):
        if first in ends:
            corners, rings = areas.group_outline(group[first])
            end, clip = ends[first], ((corners * (scale, -scale) + (0.0, height)).tolist(), rings.tolist())
            _begin_group(context, clip[0])
        if shaded[first]:
            _paint_shaded(context, areas, points, colours, (first, last), seam)
        else:
            _outline(context, points, starts[first : last + 1])
            red, green, blue = colours[starts[first]]
            context.set_source_rgba(red, green, blue, opacity[first])
            if line[first]:
                context.set_line_width(line_width)
                context.stroke()
            elif bare[first]:
                context.fill()
            else:
                _filled(context, seam)
        if clip is not None and last == end:
            _end_group(context, *clip, areas.opacity[first])
            clip = None


def _paint_shaded(
    context: cairo.Context[Any], areas: Areas, points: Corners, colours: Colours, run: tuple[int, int], seam: float
) -> None:
    """Paint a run of shaded triangles."""
    starts = areas.offsets[run[0] : run[1] + 1].tolist()
    opacity = float(areas.own_opacity[run[0]])
    corners = range(starts[0], starts[-1], 3)
    if opacity == 1.0:
        sides = _outer_sides(areas.microns[corners.start : corners.stop])
        _seams(context, points, colours, sides, corners.start, seam)
    context.set_source(_mesh(points, colours, corners, opacity))
    if opacity == 1.0:
        context.paint()
    else:
        # Meshes cover all of the pixels on their borders: where neighbours meet, things would be seen twice.
        _outline(context, points, starts)
        context.fill()


def _begin_group(context: cairo.Context[Any], corners: Corners) -> None:
    """Paint to a transparency group from now on, as large as the whole pixels or points around its outline."""
    places = np.array(corners).reshape(-1, 2)
    low, high = np.floor(places.min(axis=0)), np.ceil(places.max(axis=0))
    context.save()
    context.rectangle(*low.tolist(), *(high - low).tolist())
    context.clip()
    context.push_group()


def _end_group(context: cairo.Context[Any], corners: Corners, rings: list[int], opacity: float) -> None:
    """Blend the group inside its outline: a clip set before would cover the pixels on its border twice."""
    import cairo

    context.pop_group_to_source()
    _outline(context, corners, rings)
    context.set_fill_rule(cairo.FILL_RULE_EVEN_ODD)
    context.clip()
    context.paint_with_alpha(opacity)
    context.restore()


def _outline(context: cairo.Context[Any], points: Corners, starts: list[int]) -> None:
    """Add polygons to the path."""
    move_to, line_to, close_path = context.move_to, context.line_to, context.close_path
    for start, end in pairwise(starts):
        move_to(*points[start])
        for x, y in points[start + 1 : end]:
            line_to(x, y)
        if end - start > 2:
            close_path()


def _filled(context: cairo.Context[Any], seam: float) -> None:
    """Paint the path, and stroke it in the same colour."""
    context.set_line_width(seam)
    context.fill_preserve()
    context.stroke()


def _outer_sides(corners: Ints) -> list[list[int]]:
    """The sides that only one of some triangles has, by the numbers of their ends. corners (3 t, 2): places."""
    place = np.unique(corners[:, 0] << 32 | corners[:, 1] & 0xFFFFFFFF, return_inverse=True)[1].ravel()
    start = np.arange(len(corners))
    end = start.reshape(-1, 3)[:, [1, 2, 0]].ravel()
    low, high = np.sort(np.stack((place[start], place[end])), axis=0)
    _, first, count = np.unique(low * len(corners) + high, return_index=True, return_counts=True)
    outer = np.sort(first[count == 1])
    sides: list[list[int]] = np.stack((start[outer], end[outer]), axis=1).tolist()
    return sides


def _seams(
    context: cairo.Context[Any], points: Corners, colours: Colours, sides: list[list[int]], first: int, seam: float
) -> None:
    """Stroke sides, given by their ends from the first corner on, in their own colours."""
    import cairo

    context.set_line_width(seam)
    for side in sides:
        ends = [points[first + k] for k in side]
        along = cairo.LinearGradient(*ends[0], *ends[1])
        for place, k in enumerate(side):
            red, green, blue = colours[first + k]
            along.add_color_stop_rgb(place, red, green, blue)
        context.set_source(along)
        context.move_to(*ends[0])
        context.line_to(*ends[1])
        context.stroke()


def _mesh(points: Corners, colours: Colours, corners: range, opacity: float) -> cairo.MeshPattern:
    """Triangles that begin at the given corners, shaded. The last corner of a patch of four is the first one."""
    import cairo

    mesh = cairo.MeshPattern()
    for k in corners:
        mesh.begin_patch()
        mesh.move_to(*points[k])
        mesh.line_to(*points[k + 1])
        mesh.line_to(*points[k + 2])
        mesh.line_to(*points[k])
        for side, corner in enumerate((k, k + 1, k + 2, k)):
            red, green, blue = colours[corner]
            mesh.set_corner_color_rgba(side, red, green, blue, opacity)
        mesh.end_patch()
    return mesh
