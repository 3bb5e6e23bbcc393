"""Transparent convex solids: what is in them and behind them, displaced by refraction."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.decals.decal_polygons import Decals, no_decals
from vectorplot.effects.glass.beams import TOUCHING, Beams, Solid, soup_above, soup_in_beams, totally_reflecting
from vectorplot.effects.glass.refracted_order import refracted_order
from vectorplot.effects.glass.refracted_polygons import Soup, bent
from vectorplot.effects.windows.window_polygons import (
    SeenThrough,
    clipped_pairs,
    joined_seen,
    nothing_seen,
    one_after_another,
    sorted_by_window,
)
from vectorplot.geometry import ragged, regions
from vectorplot.geometry.convex.plane_cuts import cut_by_planes
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.light.painted_colours import opacities
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points, polygons_of
from vectorplot.visibility.painter.pairs.box_pairs import boxes_over
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces

MOST_FACES = 32
"""Solids with more faces show nothing where they reflect all light: each face may be a mirror of its own."""


@dataclass(frozen=True, eq=False)
class Panes:
    """What is looked through: faces, convex polygons of the image, parts of faces of the view; way (n,) of the light
    that comes through each; window (n,) the painted polygon that each is or is a part of."""

    faces: ImageFaces
    way: Ints
    window: Ints


def refracting_items(scene: Scene, view: View, projected: ProjectedFaces) -> Bools:
    """(i,) the items that refract light: transparent materials with a constant other than 1, closed and convex.

    Others are transparent without refraction. Source: Glaeser, section 6.6.
    """
    bends = np.array([item.material.refraction != 1.0 and not item.hides for item in scene.items], dtype=np.bool_)
    if not bends.any():
        return bends
    return bends & solid_items(replace(view, occludes=bends), projected)


def seen_in_glass(
    scene: Scene,
    view: View,
    projected: ProjectedFaces,
    painted: ImageFaces,
    tolerance: float,
    decals: Decals | None = None,
) -> SeenThrough:
    """What is seen in and behind transparent solids, refracted, to be painted after what is painted of the solids'
    front faces has been filled with the colour of the paper; then comes the tint of these faces.

    painted: the polygons of the picture, back to front. tolerance: how far, in units of the image, straight sides of
    polygons may be off the curves that refraction makes of them in a perspective; their corners are exact. decals:
    convex ones on faces, in the order in which they are painted, seen as their faces are.
    Other transparent solids are seen without refraction. A face that reflects all light that gets there from within, by
    a front face, shows what is seen by way of it; further reflections, and those at parts of faces, show nothing.
    Degenerate: of material thinner than its surroundings (constants below 1), which a perspective can see through up to
    the angle of total reflection only, parts near that angle may be missing.
    Source: Glaeser, section 6.6 (transparent solid polyhedra; the swimming pool, figure 12).
    """
    parts = []
    for item in np.flatnonzero(refracting_items(scene, view, projected)).tolist():
        solid = Solid.of(view, item, scene.items[item].material.refraction)
        shown = (view.face_item[painted.source] == item) & (projected.facing[painted.source] > 0)
        window = np.flatnonzero(shown)
        if len(window):
            front, way = np.unique(painted.source[window], return_inverse=True)
            panes = Panes(painted.some(window), way, window)
            number = np.searchsorted(solid.face, front)
            glass = _glass(view, solid, number, panes, tolerance, no_decals() if decals is None else decals)
            inside = _seen_inside(glass)
            glass = replace(glass, cover=_cover(glass, inside, scene))
            parts += [*_seen_behind(glass), *_bounced(glass), inside]
    return joined_seen(parts)


@dataclass(frozen=True, eq=False)
class _Cover:
    """What hides things behind a solid, in it: windows (w,), ascending, and the region of each that is covered."""

    window: Ints
    region: Any

    def hides(self, faces: ImageFaces, window: Ints) -> Bools:
        """(n,) which polygons of the image are wholly covered, seen in windows (n,)."""
        import shapely

        result = np.zeros(len(window), dtype=np.bool_)
        if len(self.window):
            at = np.minimum(np.searchsorted(self.window, window), len(self.window) - 1)
            here = np.flatnonzero(self.window[at] == window)
            some = faces.some(here)
            shapely.prepare(self.region)
            result[here] = shapely.covers(self.region[at[here]], regions.polygons_of(some.points, some.offsets))
        return result


def _cover(glass: _Glass, inside: SeenThrough, scene: Scene) -> _Cover:
    """What opaque things in a solid hide, to the tolerance of bent sides."""
    hides = opacities(scene.items)[glass.view.face_item[inside.source]] >= 1.0
    some = inside.some(np.flatnonzero(hides & (inside.decal < 0)))
    window, of = np.unique(some.window, return_inverse=True)
    polygons = regions.polygons_of(some.points, some.offsets)
    joined = regions.unions(polygons, of, glass.view.tolerance)
    return _Cover(window, regions.grown(joined, max(glass.tolerance, glass.view.tolerance)))


@dataclass(frozen=True, eq=False)
class _Glass:
    """A solid in a view: front (w,) those of its faces that one looks through, by panes whose ways are the numbers of
    these faces; tolerance and decals as of seen_in_glass; rest: all things but the solid, and inside what of them is in
    it, and lying what of decals is; cover: what of the panes is hidden by opaque things in it."""

    view: View
    solid: Solid
    front: Ints
    panes: Panes
    tolerance: float
    decals: Decals
    rest: Soup
    inside: Soup
    lying: Soup
    cover: _Cover

    @property
    def boxes(self) -> Floats:
        """(4,w) smallest and largest x, smallest and largest y of the panes of each front face."""
        box = np.tile(np.array([[np.inf], [-np.inf], [np.inf], [-np.inf]]), len(self.front))
        for row in range(4):
            (np.maximum if row % 2 else np.minimum).at(box[row], self.panes.way, self.panes.faces.box[row])
        return box


def _glass(view: View, solid: Solid, front: Ints, panes: Panes, tolerance: float, decals: Decals) -> _Glass:
    others = np.flatnonzero(view.face_item != view.face_item[solid.face[0]])
    position, offsets = ragged.take(view.offsets, others)
    rest = Soup(view.points[:, view.corners[position]], offsets, others, np.zeros_like(others))
    walls = -solid.planes
    walls[3] -= TOUCHING * view.tolerance
    inside, lying = (soup_above(some, walls, view.tolerance) for some in (rest, _as_soup(decals)))
    none = _Cover(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=object))
    return _Glass(view, solid, front, panes, tolerance, decals, rest, inside, lying, none)


def _seen_behind(glass: _Glass) -> list[SeenThrough]:
    """What is seen through the faces that rays leave by."""
    beams = soup_in_beams(glass.view, glass.solid, glass.front, glass.boxes, glass.rest)
    return [_behind(glass, *some) for some in beams]


def _seen_inside(glass: _Glass) -> SeenThrough:
    """What is seen in a solid."""
    return _shown(glass, _bent_inside(glass, glass.inside), _bent_inside(glass, glass.lying), glass.panes)


def _bounced(glass: _Glass) -> list[SeenThrough]:
    """What is seen by way of faces that reflect all light that gets there from within, once: what is seen behind the
    mirror image of the solid, and in it."""
    view, solid = glass.view, glass.solid
    if len(solid.face) > MOST_FACES:
        return []
    first, back = totally_reflecting(view, solid, glass.front, glass.boxes)
    parts = []
    for mirror in np.unique(back).tolist():
        front = np.unique(first[back == mirror])
        panes = _panes_of(glass, front, mirror)
        if len(panes.way):
            there = _mirrored(glass, front, mirror, panes)
            parts += [*_seen_behind(there), _seen_inside(there)]
    return parts


def _mirrored(glass: _Glass, front: Ints, mirror: int, panes: Panes) -> _Glass:
    """The mirror image of what is seen through some (w,) of the front faces by way of another face."""
    solid, decals = glass.solid, glass.decals
    rest, inside, lying = (
        replace(soup, points=solid.reflected(soup.points, mirror)) for soup in (glass.rest, glass.inside, glass.lying)
    )
    return replace(
        glass,
        solid=solid.behind_mirror(glass.front[front], mirror),
        front=np.arange(len(front)),
        panes=panes,
        decals=replace(decals, points=solid.reflected(decals.points, mirror)),
        rest=rest,
        inside=inside,
        lying=lying,
    )


def _panes_of(glass: _Glass, front: Ints, back: int) -> Panes:
    """What is seen of a back face through some (w,) of the front faces, whose numbers there are the ways."""
    view = glass.view
    every = np.arange(len(front))
    outlines = replace(glass.solid.outlines(np.full(len(front), back)), source=every, way=front)
    backs = bent(view, glass.solid.sight_ways(glass.front), outlines, glass.boxes, glass.tolerance)
    faces = polygons_of(image_points(view, backs.points), backs.offsets, np.arange(len(backs)), view.tolerance)
    points, ends, face, pane = _in_panes(view, faces, backs.way, glass.panes)
    parts = ImageFaces(points, ends, faces.planes[:, face], glass.panes.faces.source[pane], faces.rank[face])
    return _open(glass, Panes(parts, backs.source[faces.source[face]], glass.panes.window[pane]))


def _open(glass: _Glass, panes: Panes) -> Panes:
    """Those of some panes behind which things are seen."""
    left = np.flatnonzero(~glass.cover.hides(panes.faces, panes.window))
    return Panes(panes.faces.some(left), panes.way[left], panes.window[left])


def _bent_inside(glass: _Glass, soup: Soup) -> Soup:
    """What is in a solid as it is seen through each of its front faces."""
    way, polygon = (grid.ravel() for grid in np.mgrid[: len(glass.front), : len(soup)])
    sight_ways = glass.solid.sight_ways(glass.front)
    return bent(glass.view, sight_ways, soup.on_ways(polygon, way), glass.boxes, glass.tolerance)


def _as_soup(decals: Decals) -> Soup:
    """Decals as polygons of their own."""
    every = np.arange(len(decals))
    return Soup(decals.points, decals.offsets, every, np.zeros_like(every))


def _behind(glass: _Glass, beams: Beams, soup: Soup) -> SeenThrough:
    """What beams show of polygons, each on the way of a beam: all that is seen through the face that the beam leaves
    the solid by."""
    view, solid = glass.view, glass.solid
    found = bent(view, beams.leaves, soup, beams.box, glass.tolerance)
    lying = bent(view, beams.leaves, _decals_in(glass, beams, soup), beams.box, glass.tolerance)
    used = np.unique(found.way)
    outlines = replace(solid.outlines(beams.back[used]), source=used, way=beams.front[used])
    backs = bent(view, solid.sight_ways(glass.front), outlines, glass.boxes, glass.tolerance)
    faces = polygons_of(image_points(view, backs.points), backs.offsets, np.arange(len(backs)), view.tolerance)
    points, ends, face, pane = _in_panes(view, faces, backs.way, glass.panes)
    source = glass.panes.faces.source[pane]
    parts = ImageFaces(points, ends, faces.planes[:, face], source, faces.rank[face])
    panes = _open(glass, Panes(parts, backs.source[faces.source[face]], glass.panes.window[pane]))
    return _shown(glass, found, lying, panes)


def _decals_in(glass: _Glass, beams: Beams, soup: Soup) -> Soup:
    """The decals on the faces of polygons in beams, cut off as these are, each on the way of its beam."""
    decals = glass.decals
    face, way = np.unique(np.stack([soup.source, soup.way]), axis=1)
    order = np.argsort(decals.face, kind="stable")
    first, last = (np.searchsorted(decals.face[order], face, side=side) for side in ("left", "right"))
    counts = last - first
    step = ragged.place(counts)
    decal, beam = order[np.repeat(first, counts) + step], np.repeat(way, counts)
    parts = cut_by_planes(decals.points, decals.offsets, beams.bundles, decal, beam, glass.view.tolerance)
    return Soup(parts.points, parts.offsets, decal[parts.pair], beam[parts.pair])


def _in_panes(view: View, faces: ImageFaces, way: Ints, panes: Panes) -> tuple[Floats, Ints, Ints, Ints]:
    """Faces, with the ways (n,) of their sources, clipped with the panes of their ways: points (3,c), offsets (m+1,),
    and which face and which pane each part is of."""
    pairs = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    for face, pane in boxes_over(faces.box, panes.faces.box, view.tolerance):
        same = way[faces.source[face]] == panes.way[pane]
        pairs.append((face[same], pane[same]))
    face, pane = (np.concatenate([pair[k] for pair in pairs]) for k in (0, 1))
    points, offsets, pair = clipped_pairs(faces, panes.faces, face, pane, view.tolerance)
    return points, offsets, face[pair], pane[pair]


def _shown(glass: _Glass, soup: Soup, lying: Soup, panes: Panes) -> SeenThrough:
    """Bent polygons as far as they are seen in the panes of their ways, back to front, each followed by the bent decals
    (lying, whose sources are their numbers) on its face."""
    view = glass.view
    faces = polygons_of(image_points(view, soup.points), soup.offsets, np.arange(len(soup)), view.tolerance)
    points, offsets, face, pane = _in_panes(view, faces, soup.way, panes)
    if not len(pane):
        return nothing_seen()
    parts = polygons_of(points, offsets, np.arange(len(pane)), view.tolerance)
    piece = faces.source[face]
    _, bent_face = np.unique(np.stack([soup.way[piece], soup.source[piece]]), axis=1, return_inverse=True)
    off = view.tolerance if view.eye is None else max(glass.tolerance, view.tolerance)
    order = refracted_order(view, parts, bent_face[parts.source], off)
    through, piece = pane[order.source], piece[order.source]
    source, window = soup.source[piece], panes.window[through]
    bare = SeenThrough(
        order.points, order.offsets, source, window, panes.faces.source[through], np.full(len(order), -1, dtype=np.intp)
    )
    if not len(lying):
        return sorted_by_window(bare)
    part, laid = _laid_on(glass, order, source, soup.way[piece], lying)
    both = one_after_another([bare, replace(laid, window=window[part], pane=bare.pane[part])])
    # After all parts of a face that follow each other: a part would cover the border of what lies on its neighbour.
    new = np.append(True, (np.diff(source) != 0) | (np.diff(soup.way[piece]) != 0))
    run = np.cumsum(new)
    return sorted_by_window(both.some(np.lexsort((both.decal, np.concatenate([run, run[part]])))))


def _laid_on(glass: _Glass, parts: ImageFaces, face: Ints, way: Ints, lying: Soup) -> tuple[Ints, SeenThrough]:
    """Bent decals clipped with the parts (n,) of their faces on their ways: which part each lies on."""
    view = glass.view
    marks = polygons_of(image_points(view, lying.points), lying.offsets, np.arange(len(lying)), view.tolerance)
    own_face, own_way = glass.decals.face[lying.source[marks.source]], lying.way[marks.source]
    pairs = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    for mark, part in boxes_over(marks.box, parts.box, view.tolerance):
        same = (own_face[mark] == face[part]) & (own_way[mark] == way[part])
        pairs.append((mark[same], part[same]))
    mark, part = (np.concatenate([pair[k] for pair in pairs]) for k in (0, 1))
    points, offsets, pair = clipped_pairs(marks, parts, mark, part, view.tolerance)
    mark, part = mark[pair], part[pair]
    return part, SeenThrough(points, offsets, own_face[mark], part, part, lying.source[marks.source[mark]])
