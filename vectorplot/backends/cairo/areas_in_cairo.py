"""Filled polygons through cairo."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.backends.cairo.mesh_borders import border_sides, last_of_sides, outer_sides, rings, skirts
from vectorplot.backends.cairo.small_polygons import in_meshes
from vectorplot.backends.page.areas import Areas
from vectorplot.backends.page.underlaps import Underlaps, grown, underlaps
from vectorplot.geometry import ragged

if TYPE_CHECKING:
    import cairo

Corners = Any

GROUND_STEPS = 32.0
"""Shades of each colour below meshes."""


def paint(
    context: cairo.Context[Any], areas: Areas, scale: float, height: float, line_width: float, seam: float
) -> None:
    """Paint the polygons. Cairo takes one side a call, so this loops over points.

    scale: device units per micron; height: of the page's lower border in them, from the top; line_width: of polygons of
    two corners; seam: of the line around opaque ones amid a surface that have sides without a partner.
    """
    place, areas = _Place(scale, height), in_meshes(areas)
    laps = underlaps(areas)
    outlines, offsets, parts = grown(areas, laps)
    heads = areas.runs[:-1]
    colours = (areas.colours[areas.offsets[heads]] / 255.0).tolist()
    meshed, line = areas.meshed[heads].tolist(), (areas.sizes[heads] == 2).tolist()
    opacity = areas.own_opacity[heads].tolist()
    open_ = np.logical_or.reduceat(laps.open, heads).tolist() if len(heads) else []
    ends, part_ends = dict(areas.group_ends.tolist()), dict(areas.part_ends.tolist())
    end, part_end, clip = -1, -1, None
    for run, (first, last) in enumerate(pairwise(areas.runs.tolist())):
        if first in ends:
            end = ends[first]
            clip = _clip_of(areas, place, first, end)
            _begin_group(context, clip[0])
        if first in part_ends:
            part_end = part_ends[first]
            _begin_part(context, *_clip_of(areas, place, first, part_end))
        if meshed[run]:
            _paint_mesh(context, areas, place, laps, (first, last))
        else:
            starts = offsets[parts[first] : parts[last] + 1]
            _outline(context, place.of(outlines[starts[0] : starts[-1]]), (starts - starts[0]).tolist())
            red, green, blue = colours[run]
            context.set_source_rgba(red, green, blue, opacity[run])
            if line[run]:
                context.set_line_width(line_width)
                context.stroke()
            elif not open_[run]:
                context.fill()
            else:
                context.set_line_width(seam)
                context.fill_preserve()
                context.stroke()
        if last == part_end:
            context.restore()
            part_end = -1
        if clip is not None and last == end:
            _end_group(context, *clip, float(areas.opacity[first]))
            clip = None


@dataclass(frozen=True)
class _Place:
    """Where microns are on the device."""

    scale: float
    height: float

    def of(self, microns: NDArray[Any]) -> Corners:
        """Places (..., 2) on the device, as lists."""
        found: Corners = self.on_device(microns).tolist()
        return found

    def on_device(self, microns: NDArray[Any]) -> Floats:
        """Places (..., 2) on the device."""
        return np.asarray(microns * (self.scale, -self.scale) + (0.0, self.height))


def _paint_mesh(
    context: cairo.Context[Any], areas: Areas, place: _Place, laps: Underlaps, run: tuple[int, int]
) -> None:
    """Paint a run of shaded triangles as one mesh, on flat ones, and within its border: there are readers that smooth
    what is clipped, but not meshes, and others that do not smooth that either."""
    starts = areas.offsets[[run[0], run[1]]].tolist()
    corners, colours = areas.microns[starts[0] : starts[1]], areas.colours[starts[0] : starts[1]] / 255.0
    opacity = float(areas.own_opacity[run[0]])
    patches = corners.astype(np.float64).reshape(-1, 3, 2)[:, [0, 1, 2, 0]]
    at = np.arange(len(corners)).reshape(-1, 3)[:, [0, 1, 2, 0]]
    context.save()
    if opacity == 1.0:
        sides = border_sides(corners)
        seen = outer_sides(corners, sides[last_of_sides(corners, sides)])
        _ground(context, place, corners, colours.reshape(-1, 3, 3).mean(axis=1))
        patches = np.concatenate((skirts(corners, seen), patches))
        at = np.concatenate((seen[:, [0, 1, 1, 0]], at))
        path = [corners[ring] for ring in rings(corners, sides)]
        path += list(_underlaps_of(areas, laps, (starts[0], starts[1]), sides[:, 0]))
    else:
        # Meshes cover all of the pixels on their borders: where neighbours meet, things would be seen twice.
        path = list(corners.reshape(-1, 3, 2))
    sizes = [0, *(len(ring) for ring in path)]
    _outline(context, place.of(np.concatenate(path)), np.cumsum(sizes).tolist())
    context.clip()
    context.set_source(_mesh(place.on_device(patches), colours[at], opacity))
    context.paint()
    context.restore()


def _ground(context: cairo.Context[Any], place: _Place, corners: Ints, colours: Floats) -> None:
    """Fill triangles in about their colours, many at once by what encloses them together: what a reader forgets between
    the triangles of a mesh shows this."""
    steps, group = np.unique(np.rint(colours * GROUND_STEPS), axis=0, return_inverse=True)
    order = np.argsort(group.ravel(), kind="stable")
    ends = np.searchsorted(group.ravel()[order], np.arange(1, len(steps) + 1)).tolist()
    triangles, start = corners.reshape(-1, 3, 2), 0
    for (red, green, blue), end in zip((steps / GROUND_STEPS).tolist(), ends, strict=True):
        some = triangles[order[start:end]].reshape(-1, 2)
        path = [some[ring] for ring in rings(some, border_sides(some))]
        if path:
            _outline(context, place.of(np.concatenate(path)), ragged.offsets([*map(len, path)]).tolist())
        context.set_source_rgb(red, green, blue)
        context.fill()
        start = end


def _underlaps_of(areas: Areas, laps: Underlaps, corners: tuple[int, int], border: Ints) -> Floats:
    """(k,4,2) what is added to a run of triangles under polygons of other runs, counter-clockwise; border: the corners
    of the run at which its border sides begin."""
    low, high = np.searchsorted(laps.side, corners)
    side = laps.side[low:high]
    strips = laps.added[np.isin(laps.along, border + corners[0])]
    which = np.isin(side - corners[0], border)
    side, near, far = side[which], laps.near[low:high][which], laps.far[low:high][which]
    end = np.where((side - corners[0]) % 3 == 2, side - 2, side + 1)
    return np.concatenate((np.stack((areas.microns[end], areas.microns[side], near, far), axis=1), strips))


def _clip_of(areas: Areas, place: _Place, first: int, last: int) -> tuple[Corners, list[int]]:
    """Corners of the outline of polygons from first to before last on the device, and where its rings begin."""
    corners, border = areas.outline(first, last)
    return place.of(corners), border.tolist()


def _begin_part(context: cairo.Context[Any], corners: Corners, rings: list[int]) -> None:
    """Paint inside of an outline from now on."""
    import cairo

    context.save()
    _outline(context, corners, rings)
    context.set_fill_rule(cairo.FILL_RULE_EVEN_ODD)
    context.clip()
    context.set_fill_rule(cairo.FILL_RULE_WINDING)


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


def _mesh(patches: Floats, colours: Floats, opacity: float) -> cairo.MeshPattern:
    """Patches (n,4,2) of four corners, the last of which may be the first one, shaded from colours (n,4,3). Cairo takes
    one corner a call."""
    import cairo

    mesh = cairo.MeshPattern()
    begin, move_to, line_to, shade, end = (
        mesh.begin_patch,
        mesh.move_to,
        mesh.line_to,
        mesh.set_corner_color_rgba,
        mesh.end_patch,
    )
    # Numbers in columns: a list for every corner would keep the collector of garbage busy.
    columns = np.concatenate((patches.reshape(-1, 8), colours.reshape(-1, 12)), axis=1).T.tolist()
    for ax, ay, bx, by, cx, cy, dx, dy, ar, ag, ab, br, bg, bb, cr, cg, cb, dr, dg, db in zip(*columns, strict=True):
        begin()
        move_to(ax, ay)
        line_to(bx, by)
        line_to(cx, cy)
        line_to(dx, dy)
        shade(0, ar, ag, ab, opacity)
        shade(1, br, bg, bb, opacity)
        shade(2, cr, cg, cb, opacity)
        shade(3, dr, dg, db, opacity)
        end()
    return mesh
