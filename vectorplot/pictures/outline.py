"""The outline of what is seen: closed paths around all that items cover of the page, and around the holes in it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import Budget
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.regions import insides_of, mosaics, without_splinters
from vectorplot.pictures.lines import LineSources, PlacedLines, traceable
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_draw
from vectorplot.scene.annotations import is_annotation
from vectorplot.scene.item import Item
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import GRID_MM
from vectorplot.visibility.hidden_points import items_before
from vectorplot.visibility.polyhedra.lines import items_wanting
from vectorplot.words import LineKind

BORDERS = frozenset({LineKind.CONTOUR, LineKind.BOUNDARY})
"""The lines in which the image of a thing can end."""

SPLINTER = 0.25
"""Parts and holes are splinters where they are narrower than two tolerances, eight times this part of one: between two
chords, each of which may be off by half of the tolerance, some come to be."""

FEWEST_CORNERS = 3
"""Of a polygon."""

ENDS_ON_GRID = 2.0
"""Points that are moved to the grid are no more of its steps away."""

BEYOND = 4.0
"""The depth at which nothing is left of the scene behind its farthest point, which is 2 wide."""


def outlined_items(scene: Scene, kinds: frozenset[LineKind]) -> Scene:
    """The scene for the outlines of the items that ask for them: these hide and have all their edges, others nothing
    of both."""
    asking = items_wanting(LineKind.OUTLINE, scene, kinds)
    return replace(scene, items=tuple(map(_outlined, scene.items, asking.tolist())))


def _outlined(item: Item, asking: bool) -> Item:
    if not asking or is_annotation(item):
        return replace(item, lines=(), occludes=False)
    curves = replace(item.curves, smooth_contours=False)
    return replace(item, lines=None, occludes=True, curves=curves, drawn_edges=None, added_edges=None)


def outline_sources(shapes: LineSources, budget: Budget) -> LineSources:
    """What the outlines of items that ask for them are traced on: all their contours and borders, hidden ones too."""
    alone = outlined_items(shapes.scene, shapes.kinds)
    view = replace(shapes.view, occludes=np.array([item.hides for item in alone.items], dtype=np.bool_))
    pipeline = Pipeline(plan_draw(alone, BORDERS, "none", 0.0, "wireframe"), None, None)
    return traceable(pipeline, alone, view, shapes.faces, BORDERS, 180.0, budget)


def outline_ends(shapes: LineSources, tolerance: float, budget: Budget) -> Floats:
    """(3,n) points that a picture has to fit which shows the outlines of a scene, curves as chords within a tolerance
    in the unit box."""
    sources = outline_sources(shapes, budget)
    framed = sources.framed(sources.lines(tolerance, budget), None)
    return np.concatenate([framed.start, framed.end], axis=1)


def outline(shapes: LineSources, placement: Placement, tolerance_mm: float, budget: Budget) -> Paths:
    """One closed path around each connected region of the page that is covered, and one around each hole in it.

    Parameters
    ----------
    shapes : LineSources
        The scene in its view, and the kinds of lines that are asked for; items may have their own.
    placement : Placement
        Of the picture.
    tolerance_mm : float
        As of draw: chords of smooth contours are no farther off than half of it.
    budget : Budget
        Of work on smooth surfaces.

    Returns
    -------
    Paths
        Outer ones counter-clockwise, holes clockwise; each of the item that its first part belongs to. Smooth where all
        parts are.

    Raises
    ------
    InputError
        Where the scene reaches behind the eye, or too far to the side of it.

    Notes
    -----
    Contours and borders cut the page into cells, each of which is covered as a whole or not at all: what a ray through
    one of its points meets says which.

    Error: corners where different lines cross lie within GRID_MM, and where these are smooth within the tolerance.
    Parts and holes that are narrower than two tolerances are left out. Meshes have the outlines of their faces, also
    where their contours are those of smooth shapes.

    Source: Edelsbrunner, Algorithms in Combinatorial Geometry, section 7 (arrangements).
    """
    import shapely

    sources = outline_sources(shapes, budget)
    every = sources.lines(0.5 * tolerance_mm / placement.scale, budget)
    view = sources.view
    if view.reaches_too_far(every.start, every.end):
        raise InputError("outline: the scene reaches behind the eye, or too far to the side of it; step back")
    framed = sources.framed(every, None)
    strokes = PlacedLines(sources, framed, sources.seen(framed), placement).strokes()
    if not len(strokes):
        return strokes
    ends = segments(strokes)
    chords = shapely.linestrings(strokes.points[ends])
    network = shapely.union_all(chords, grid_size=GRID_MM)
    cells = shapely.get_parts(shapely.polygonize(shapely.get_parts(network)))
    cells = cells[_covered(sources, placement, cells)]
    if not len(cells):
        return Paths.empty()
    regions = mosaics(cells, np.zeros(len(cells), dtype=np.intp))
    parts, _ = without_splinters(insides_of(regions), SPLINTER * tolerance_mm)
    return _around(parts, strokes, ends, placement.page_from_world) if len(parts) else Paths.empty()


def _covered(sources: LineSources, placement: Placement, cells: Any) -> Bools:
    """(n,) the cells of the page that something covers."""
    import shapely

    view = sources.view
    inner = shapely.get_coordinates(shapely.point_on_surface(cells))
    image = (inner.T - placement.page_from_image[:2, 2:]) / placement.scale
    flat = view.in_image_plane(image)
    if view.eye is None:
        flat[2] = -BEYOND
    else:
        way = flat - view.eye[:, None]
        flat = view.eye[:, None] + way * ((BEYOND + np.abs(view.eye).max()) / view.focus)
    return np.asarray(items_before(sources.scene, view, sources.faces, flat).any(axis=1))


def _around(parts: Any, strokes: Paths, ends: Ints, page_from_world: Floats) -> Paths:
    """The borders of polygons as closed paths along the segments of strokes, between points ends (k,2), that they
    follow: through these points where they pass them, with their directions and handles."""
    xy, offsets, segment = _corners(parts, strokes.points[ends])
    ahead, back = ragged.following(offsets), ragged.preceding(offsets)
    a, b = strokes.points[ends[segment]].transpose(1, 0, 2)
    from_a, to_a = (((at - a) * (b - a)).sum(axis=1) for at in (xy, xy[ahead]))
    turned = (from_a > to_a).astype(np.intp)
    every = np.arange(len(xy))
    first, last = ends[segment][every, turned], ends[segment][every, 1 - turned]
    leaves = np.hypot(*(xy - strokes.points[first]).T) <= ENDS_ON_GRID * GRID_MM
    arrives = np.hypot(*(xy[ahead] - strokes.points[last]).T) <= ENDS_ON_GRID * GRID_MM
    points = np.where(leaves[:, None], strokes.points[first], xy)
    points = np.where((arrives & ~leaves[ahead])[back, None], strokes.points[last][back], points)
    directions, handles = np.full((2, len(xy), 2), np.nan)
    directions[:, 1] = np.where(leaves, strokes.directions[first, 1 - turned] + np.pi * turned, np.nan)
    directions[ahead, 0] = np.where(arrives, strokes.directions[last, turned] + np.pi * turned, np.nan)
    handles[:, 1] = np.where(leaves & arrives, strokes.handles[first, 1 - turned], np.nan)
    handles[ahead, 0] = np.where(leaves & arrives, strokes.handles[last, turned], np.nan)
    stroke = ragged.owner(np.diff(strokes.offsets))[first]
    closed = np.ones(len(offsets) - 1, dtype=np.bool_)
    none = np.zeros(len(closed), dtype=np.intp)
    return Paths(
        points,
        offsets,
        closed,
        none + int(LineKind.OUTLINE),
        strokes.item[stroke[offsets[:-1]]],
        none,
        _in_space(points, strokes, first, last, page_from_world),
        np.logical_and.reduceat(strokes.smooth[stroke], offsets[:-1]),
        directions,
        handles=handles,
    )


def _corners(parts: Any, chords: Floats) -> tuple[Floats, Ints, Ints]:
    """Corners (n,2) of the borders of polygons, their offsets, and which of the chords (k,2,2) each border follows from
    there to its next corner: where it stays on one, other lines only touch it, and there is no corner."""
    import shapely

    rings = shapely.get_rings(shapely.orient_polygons(parts))
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    # A ring of shapely repeats its first point at its end.
    once = np.append(ring[1:] == ring[:-1], False)
    xy, ring = xy[once], ring[once]
    offsets = ragged.offsets(np.bincount(ring))
    middle = 0.5 * (xy + xy[ragged.following(offsets)])
    chord = shapely.STRtree(shapely.linestrings(chords)).nearest(shapely.points(middle))
    new = chord != chord[ragged.preceding(offsets)]
    new |= (np.bincount(ring, new) < FEWEST_CORNERS)[ring]
    return xy[new], ragged.offsets(np.bincount(ring[new])), chord[new]


def _in_space(points: Floats, strokes: Paths, first: Ints, last: Ints, page_from_world: Floats) -> Floats:
    """(n,3) the points of the world that are seen at points (n,2) of segments of strokes, from point first (n,) to
    last."""
    a, b = strokes.points[first], strokes.points[last]
    part = ((points - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1)
    a, b = strokes.points3d[first], strokes.points3d[last]
    near, far = (matmul(some, page_from_world[3, :3]) + page_from_world[3, 3] for some in (a, b))
    part = np.clip(part * near / (part * near + (1.0 - part) * far), 0.0, 1.0)[:, None]
    return np.asarray(a + part * (b - a))
