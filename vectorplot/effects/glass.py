"""Transparent convex solids: what is in them and behind them, displaced by refraction, as painted polygons."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fill_visibility import united
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay
from vectorplot.effects.decals import Decals, Laid, joined_decals, no_decals
from vectorplot.effects.refraction import Rays, SightWays, Soup, bent, joined_soups, refracted, traced, virtual_points
from vectorplot.effects.scene_decals import laid_fills, shown_decals
from vectorplot.effects.windows import (
    SeenThrough,
    clipped_pairs,
    joined_seen,
    mixed,
    nothing_seen,
    one_after_another,
    seen_fills,
    sorted_by_window,
)
from vectorplot.geometry import ragged, regions
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.elementary import arccos, tan
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.polygon_cuts import PlaneBundles, cut_by_planes, planes_of, polygon_areas
from vectorplot.geometry.polylines import joined
from vectorplot.geometry.projections import Projection
from vectorplot.geometry.vectors import cross, norm
from vectorplot.scene.placement import Placement, box_corners
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.facet_resolution import box_of_item, triangles_of_items
from vectorplot.shading.illumination import towards
from vectorplot.shading.painted_colours import Lighting, opacities
from vectorplot.shading.palettes import Colours
from vectorplot.tolerances import ROUNDING
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points, polygons_of, view_points
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.painter.priority_tests import (
    Outlines,
    box_pairs,
    boxes_over,
    drawn_before,
    face_relations,
    overlapping,
)
from vectorplot.visibility.painter.topological_order import component_ranks
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import ProjectedFaces, newell

# The beams of sight rays that enter a transparent convex solid by one face and leave it by another.

TOUCHING = 1.25
"""What is so many tolerances outside of a solid is still in it: the floor of a pool is the bottom of its water."""

LOOSE = 0.1
"""Behind a face things are looked at that are so much further aside than its rays go, per unit of distance."""

GRID = 8
"""Steps of a grid of rays over a face, in each direction."""

RAYS = GRID * (GRID + 1)
"""So many of them belong to each side of the face."""

GUIDES = 96
"""So many of them, or all, show others the way."""

MARGIN = 1.0 / GRID
"""The image of a face reaches no farther beyond that of the grid, as a part of its size."""

WIDEST = 1.0
"""Beams whose rays lean farther from their middle one, in radians, may meet every face."""

MORE = 1.25
"""No ray leans more times as far as those at the corners do."""

PAIRS_AT_ONCE = 1 << 20
"""Pairs of faces, or of sides and rays, or of faces and beams handled at once."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A transparent solid: face (k,) of the view, their corners: points (3,c), offsets (k+1,); planes (4,k) outer unit
    normals and constants; constant: of the rays that enter it; exits (k,): by which faces rays may leave it."""

    face: Ints
    points: Floats
    offsets: Ints
    planes: Floats
    constant: float
    exits: Bools

    @classmethod
    def of(cls, view: View, item: int, constant: float) -> Solid:
        """An item of the view that is closed and convex."""
        face = np.flatnonzero(view.face_item == item)
        normal, _, first = newell(view, face)
        planes = planes_of(normal, view.points[:, first])
        corner, offsets = ragged.take(view.offsets, face)
        middle = view.points[:, view.item_vertices[item] : view.item_vertices[item + 1]].mean(axis=1)
        planes[:, matmul(middle, planes[:3]) > planes[3]] *= -1.0
        exits = np.ones(len(face), dtype=np.bool_)
        return cls(face, view.points[:, view.corners[corner]], offsets, planes, constant, exits)

    def sight_ways(self, front: Ints, *back: Ints) -> SightWays:
        """The ways of sight rays into a solid by some of its faces (w,) and, if given, out by others (w,)."""
        face = np.stack([front, *back])
        planes = self.planes[:, face]
        side = np.array([-1.0, 1.0])[: len(face), None]
        constant = np.array([self.constant, 1.0 / self.constant])[: len(face)]
        return SightWays(side * planes[:3], planes[:3] * planes[3], constant)

    def reflected(self, points: Floats, face: int) -> Floats:
        """(3,n) the mirror images of points (3,n) in the plane of one of the faces."""
        normal, constant = self.planes[:3, face, None], self.planes[3, face]
        return np.asarray(points - 2.0 * ((normal * points).sum(axis=0) - constant) * normal)

    def behind_mirror(self, front: Ints, mirror: int) -> Solid:
        """What rays pass that enter by some faces (w,) and are reflected at another one, thought straight: these faces,
        and then the mirror images of all but that one, by which they leave."""
        others = np.flatnonzero(np.arange(len(self.face)) != mirror)
        one, two = self.outlines(front), self.outlines(others)
        normal, constant = self.planes[:3, mirror, None], self.planes[3, mirror]
        planes = self.planes[:, others].copy()
        along = (normal * planes[:3]).sum(axis=0)
        planes[:3] -= 2.0 * along * normal
        planes[3] -= 2.0 * along * constant
        return Solid(
            np.concatenate([self.face[front], self.face[others]]),
            np.concatenate([one.points, self.reflected(two.points, mirror)], axis=1),
            np.concatenate([one.offsets, two.offsets[1:] + one.offsets[-1]]),
            np.concatenate([self.planes[:, front], planes], axis=1),
            self.constant,
            np.arange(len(front) + len(others)) >= len(front),
        )

    def outlines(self, face: Ints) -> Soup:
        """Some of the faces, each on a way of its own."""
        corner, offsets = ragged.take(self.offsets, face)
        every = np.arange(len(face))
        return Soup(self.points[:, corner], offsets, every, every)


@dataclass(frozen=True, eq=False)
class Beams:
    """Beams: front (b,) as given; back (b,) the face of the solid that they leave by; leaves: their ways; box (4,b)
    what is seen of them: smallest and largest x, smallest and largest y; bundles: planes about what they may meet."""

    front: Ints
    back: Ints
    leaves: SightWays
    box: Floats
    bundles: PlaneBundles

    def __len__(self) -> int:
        return len(self.front)


def soup_in_beams(view: View, solid: Solid, front: Ints, windows: Floats, rest: Soup) -> list[tuple[Beams, Soup]]:
    """The beams that enter by faces front (n,), seen in windows (4,n), rectangles of the image, and what they may meet
    of all the rest; in batches."""
    found = []
    for beams in beams_of(view, solid, front, windows):
        soup = joined_soups(
            [_cut(rest, beams.bundles, batch, view.tolerance) for batch in _batches(_of(len(beams), rest))]
        )
        if len(soup):
            found.append((beams, soup))
    return found


def beams_of(view: View, solid: Solid, front: Ints, windows: Floats) -> Iterator[Beams]:
    """The beams that enter by faces front (n,), seen in windows (4,n), in batches."""
    first, back = _meeting(view, solid, front)
    for some in _batches(np.diff(solid.offsets)[back] ** 2 * RAYS):
        yield _beams(view, solid, front, windows, first[some], back[some])


def totally_reflecting(view: View, solid: Solid, front: Ints, windows: Floats) -> tuple[Ints, Ints]:
    """Pairs of faces, the first a number in front (n,), of which no ray that enters by the one, seen in its window
    (4,n), leaves by the other, though some get there."""
    found = []
    first, back = _meeting(view, solid, front)
    for some in _batches(np.diff(solid.offsets)[back] ** 2 * RAYS):
        grid = _Grid.of(view, solid, front, first[some], back[some])
        _, full = grid.seen_in(windows[:, first[some]])
        none = ~np.logical_or.reduceat(grid.good, grid.offsets[:-1]) & full
        found.append((first[some][none], back[some][none]))
    if not found:
        return first, back
    return np.concatenate([pair[0] for pair in found]), np.concatenate([pair[1] for pair in found])


def soup_above(soup: Soup, planes: Floats, tolerance: float) -> Soup:
    """What is above all of some planes (4,k)."""
    return _cut(soup, PlaneBundles(planes, np.array([0, planes.shape[1]])), slice(0, 1), tolerance)


def _of(count: int, rest: Soup) -> Ints:
    return np.full(count, max(len(rest), 1))


def _cut(soup: Soup, bundles: PlaneBundles, batch: slice, tolerance: float) -> Soup:
    """What is above all planes of some bundles, on the ways of their numbers."""
    way, polygon = (grid.ravel() for grid in np.mgrid[batch, : len(soup)])
    parts = cut_by_planes(soup.points, soup.offsets, bundles, polygon, way, tolerance)
    return Soup(parts.points, parts.offsets, soup.source[polygon[parts.pair]], way[parts.pair])


def _batches(sizes: Ints) -> Iterator[slice]:
    """Consecutive runs whose sizes add up to about PAIRS_AT_ONCE; before each of them the work may stop."""
    if not len(sizes):
        return
    ends = np.unique(np.cumsum(sizes) // PAIRS_AT_ONCE, return_index=True)[1].tolist()
    yield from in_turn(slice(low, high) for low, high in zip(ends, [*ends[1:], len(sizes)], strict=True))


def _meeting(view: View, solid: Solid, front: Ints) -> tuple[Ints, Ints]:
    """Pairs of faces of which some ray may enter by one, a number in front (n,), and leave by the other: the ball about
    this one meets the cone of rays about the ball about that one."""
    sizes = np.diff(solid.offsets)
    owner = ragged.owner(sizes)
    middle = np.add.reduceat(solid.points, solid.offsets[:-1], axis=1) / sizes
    arm = solid.points - middle[:, owner]
    radius = np.sqrt(np.maximum.reduceat((arm * arm).sum(axis=0), solid.offsets[:-1]))
    axis, spread = _cones(view, solid, front)
    found = []
    for batch in _batches(np.full(len(front), len(sizes))):
        own = front[batch]
        across = middle[:, None, :] - middle[:, own, None]
        along = (across * axis[:, batch, None]).sum(axis=0)
        aside = np.sqrt(np.maximum((across * across).sum(axis=0) - along * along, 0.0))
        reach = radius[own, None] + radius
        meets = aside <= MORE * reach + spread[batch, None] * (np.maximum(along, 0.0) + reach)
        meets &= along >= -reach
        meets |= np.isinf(spread[batch])[:, None]
        meets[np.arange(len(own)), own] = False
        meets &= solid.exits
        first, back = np.nonzero(meets)
        found.append((first + batch.start, back))
    return np.concatenate([pair[0] for pair in found]), np.concatenate([pair[1] for pair in found])


def _cones(view: View, solid: Solid, front: Ints) -> tuple[Floats, Floats]:
    """(3,n) the middle rays behind some faces, and (n,) by how much others go aside, per unit of length; infinite where
    that is not known."""
    outline = solid.outlines(front)
    owner = np.repeat(outline.way, np.diff(outline.offsets))
    rays = traced(view, solid.sight_ways(front).of(owner), view.image_of(outline.points))
    known = np.logical_and.reduceat(rays.passes & (view.depth_of(outline.points) > view.near), outline.offsets[:-1])
    axis = np.add.reduceat(rays.direction, outline.offsets[:-1], axis=1)
    axis /= np.sqrt((axis * axis).sum(axis=0))
    cosine = np.minimum.reduceat((rays.direction * axis[:, owner]).sum(axis=0), outline.offsets[:-1])
    angle = MORE * arccos(np.clip(cosine, -1.0, 1.0))
    return axis, np.where(known & (angle < WIDEST), tan(angle), np.inf)


def _beams(view: View, solid: Solid, front: Ints, windows: Floats, first: Ints, back: Ints) -> Beams:
    """The beams of pairs of faces that show anything in the windows of the front faces.

    Towards total reflection rays leave along the face: they are followed up to the last one of a grid of rays that
    leaves at all.
    """
    grid = _Grid.of(view, solid, front, first, back)
    image, rays, good, offsets = grid.image, grid.rays, grid.good, grid.offsets
    common, full = grid.seen_in(windows[:, first])
    kept = np.flatnonzero(np.logical_or.reduceat(good, offsets[:-1]) & full)
    position, offsets = ragged.take(offsets, kept)
    first, back = first[kept], back[kept]
    direction, good = rays.direction[:, position], good[position]
    leaves = replace(solid.sight_ways(front[first], back), guides=_guides(image[:, position], good, offsets))
    return Beams(first, back, leaves, common[:, kept], _bundles(view, solid, back, direction, good, offsets))


@dataclass(frozen=True, eq=False)
class _Grid:
    """Rays to points all over back faces: image (2,n), offsets (b+1,), rays behind these faces, and which are seen, and
    good: leave too."""

    image: Floats
    offsets: Ints
    rays: Rays
    seen: Bools
    good: Bools

    @classmethod
    def of(cls, view: View, solid: Solid, front: Ints, first: Ints, back: Ints) -> _Grid:
        """Those of pairs of faces, the first a number in front."""
        points, offsets = _grids(solid.outlines(back))
        owner = ragged.owner(np.diff(offsets))
        virtual, seen = virtual_points(view, solid.sight_ways(front), points, first[owner])
        image = view.image_of(virtual)
        rays = traced(view, solid.sight_ways(front[first], back).of(owner), image)
        return cls(image, offsets, rays, seen, seen & rays.passes)

    def seen_in(self, windows: Floats) -> tuple[Floats, Bools]:
        """(4,b) what windows (4,b) have in common with the rectangles of the rays that are seen, and (b,) whether that
        is anything."""
        common = _common(_boxes(self.image, self.seen, self.offsets), windows)
        return common, np.asarray((common[0] <= common[1]) & (common[2] <= common[3]), dtype=np.bool_)


def _grids(outlines: Soup) -> tuple[Floats, Ints]:
    """Points (3,n) all over convex polygons: on the sides, and between these and the centres; and their offsets."""
    offsets = outlines.offsets
    if not len(outlines):
        return np.zeros((3, 0)), offsets
    steps = np.linspace(0.0, 1.0, GRID + 1)
    corner, sizes = outlines.points, np.diff(offsets)
    after = corner[:, next_positions(offsets, np.arange(corner.shape[1]))]
    centre = np.repeat(_centres(outlines), sizes, axis=1)
    sides = corner[..., None] + steps[:-1] * (after - corner)[..., None]
    grid = centre[..., None, None] + steps * (sides - centre[..., None])[..., None]
    return grid.reshape(3, -1), offsets * RAYS


def _centres(outlines: Soup) -> Floats:
    """(3,n) the means of the corners of polygons."""
    return np.asarray(np.add.reduceat(outlines.points, outlines.offsets[:-1], axis=1) / np.diff(outlines.offsets))


def _boxes(image: Floats, seen: Bools, offsets: Ints) -> Floats:
    """(4,n) smallest and largest x, smallest and largest y of all that is seen of grids, with a margin."""
    if len(offsets) == 1:
        return np.zeros((4, 0))
    low = np.minimum.reduceat(np.where(seen, image, np.inf), offsets[:-1], axis=1)
    high = np.maximum.reduceat(np.where(seen, image, -np.inf), offsets[:-1], axis=1)
    margin = MARGIN * np.where(low <= high, high - low, 0.0).max(axis=0)
    return np.stack([low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin])


def _common(box: Floats, others: Floats) -> Floats:
    """(4,n) what rectangles (4,n), smallest and largest x, smallest and largest y, have in common with others (4,n)."""
    low, high = np.maximum(box[::2], others[::2]), np.minimum(box[1::2], others[1::2])
    return np.stack([low[0], high[0], low[1], high[1]])


def _guides(image: Floats, good: Bools, offsets: Ints) -> Floats:
    """(2,b,g) rays of grids that pass."""
    sizes = np.diff(offsets)
    position = offsets[:-1, None] + np.arange(GUIDES) * sizes[:, None] // GUIDES
    return np.where(good[position], image[:, position], np.nan)


def _bundles(view: View, solid: Solid, back: Ints, direction: Floats, good: Bools, offsets: Ints) -> PlaneBundles:
    """Planes about all that rays may meet that leave by faces back (b,), in directions (3,n) where they are good."""
    outlines = solid.outlines(back)
    if not len(back):
        return PlaneBundles(np.zeros((4, 0)), outlines.offsets)
    corner, owner = outlines.points, np.repeat(outlines.way, np.diff(outlines.offsets))
    normal = solid.planes[:3, back[owner]]
    along = corner[:, next_positions(outlines.offsets, np.arange(len(owner)))] - corner
    outwards = np.cross(along, normal, axis=0)
    outwards *= np.sign((outwards * (corner - _centres(outlines)[:, owner])).sum(axis=0))
    outwards /= np.sqrt((outwards * outwards).sum(axis=0))
    ray, starts = ragged.take(offsets, owner)
    side = ragged.owner(np.diff(starts))
    passing = np.flatnonzero(good[ray])
    slope = np.full(len(ray), -np.inf)
    way, side = direction[:, ray[passing]], side[passing]
    slope[passing] = (way * outwards[:, side]).sum(axis=0) / (way * normal[:, side]).sum(axis=0)
    lean = np.maximum.reduceat(slope, starts[:-1])
    lean += LOOSE * (1.0 + np.abs(lean))
    sides = planes_of(lean * normal - outwards, corner)
    sides[3] -= TOUCHING * view.tolerance
    beyond = solid.planes[:, back] + [[0.0], [0.0], [0.0], [TOUCHING * view.tolerance]]
    planes = np.insert(sides, outlines.offsets[:-1], beyond, axis=1)
    return PlaneBundles(planes, outlines.offsets + np.arange(len(back) + 1))


# The order of painting of polygons that are parts of bent faces.


def refracted_order(view: View, parts: ImageFaces, face: Ints, tolerance: float) -> ImageFaces:
    """Parts of bent faces (n,), numbers from 0, back to front; parts of one face stand together, and are not compared.

    tolerance: how far, in units of the image, the sides of parts are off the curves they stand for: those that overlap
    by no more may stand in any order. Where whole faces pierce one another or overlap cyclically their parts
    are put in order, and cut where there is no other way.
    """
    count = int(face.max(initial=-1)) + 1
    parts = replace(parts, rank=_larger_first(parts, face, count)[face])
    demands = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    outlines = Outlines.of(parts.points, parts.offsets, tolerance)
    for first, second in box_pairs(parts.box, tolerance):
        several = face[first] != face[second]
        first, second = first[several], second[several]
        common = overlapping(outlines, first, second, tolerance)
        first, second = first[common], second[common]
        before, after = drawn_before(parts, first, second, face_relations(parts, first, second, view.tolerance))
        demands.append((face[before], face[after]))
    before, after = (np.concatenate([some[k] for some in demands]) for k in (0, 1))
    rank = component_ranks(count, before, after)
    circled = (np.bincount(rank, minlength=1)[rank] > 1)[face]
    pieces = _pieces(view, parts.take(np.flatnonzero(circled)))
    whole = joined((parts.take(np.flatnonzero(~circled)), replace(pieces, rank=np.arange(len(pieces)))))
    number = np.empty(int(parts.source.max(initial=-1)) + 1, dtype=np.intp)
    number[parts.source] = rank[face]
    return whole.take(np.lexsort((whole.rank, number[whole.source])))


def _larger_first(parts: ImageFaces, face: Ints, count: int) -> Ints:
    """(count,) the ranks of faces by the areas of their images."""
    normal, _ = polygon_areas(parts.points * [[1.0], [1.0], [0.0]], parts.offsets)
    area = np.bincount(face, np.abs(normal[2]), minlength=count)
    return np.argsort(np.argsort(-area, kind="stable"), kind="stable")


def _pieces(view: View, parts: ImageFaces) -> ImageFaces:
    """Polygons back to front, each compared with each."""
    points: Floats = view_points(view, parts.points)
    corners = np.arange(points.shape[1])
    double = replace(
        view,
        points=points,
        corners=corners,
        offsets=parts.offsets,
        inner=np.zeros(len(corners), dtype=np.bool_),
        face_item=np.zeros(len(parts), dtype=np.intp),
        item_vertices=np.array([0, len(corners)]),
        occludes=np.ones(1, dtype=np.bool_),
        face_look=None,
    )
    found = painters_order(double).faces
    return replace(found, source=parts.source[found.source])


# Transparent convex solids: what is in them and behind them, displaced by refraction.

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
    """What is seen in and behind transparent solids, refracted: painted after their front faces are filled with the
    paper's colour, before these faces' tint. painted: polygons of the picture, back to front; tolerance: in units of
    the image, how far straight sides may be off the curves that refraction makes of them (corners are exact);
    decals: convex ones on faces, in painting order.
    Other transparent solids are seen without refraction. A face of total reflection, seen through a front face, shows
    what it reflects; further reflections show nothing. Edge cases: of material thinner than its surroundings (constants
    below 1) parts near the angle of total reflection may be missing. Source: Glaeser, section 6.6, figure 12.
    """
    parts = []
    for item in in_turn(np.flatnonzero(refracting_items(scene, view, projected)).tolist()):
        solid = Solid.of(view, item, scene.items[item].material.refraction)
        shown = (view.face_item[painted.source] == item) & (projected.facing[painted.source] > 0)
        window = np.flatnonzero(shown)
        if len(window):
            front, way = np.unique(painted.source[window], return_inverse=True)
            panes = Panes(painted.take(window), way, window)
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
            some = faces.take(here)
            shapely.prepare(self.region)
            result[here] = shapely.covers(self.region[at[here]], regions.polygons_of(some.points, some.offsets))
        return result


def _cover(glass: _Glass, inside: SeenThrough, scene: Scene) -> _Cover:
    """What opaque things in a solid hide, to the tolerance of bent sides."""
    hides = opacities(scene.items)[glass.view.shown_item[inside.source]] >= 1.0
    some = inside.take(np.flatnonzero(hides & (inside.decal < 0)))
    window, of = np.unique(some.window, return_inverse=True)
    polygons = regions.polygons_of(some.points, some.offsets)
    joined = regions.unions(polygons, of, glass.view.tolerance)
    return _Cover(window, regions.grown(joined, max(glass.tolerance, glass.view.tolerance)))


@dataclass(frozen=True, eq=False)
class _Glass:
    """A solid in a view: front (w,) those of its faces that one looks through, by panes whose ways are the numbers of
    these faces; tolerance and decals as in seen_in_glass; rest: all things but the solid, and inside what of them is in
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
    return Panes(panes.faces.take(left), panes.way[left], panes.window[left])


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
    return sorted_by_window(both.take(np.lexsort((both.decal, np.concatenate([run, run[part]])))))


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


# Which items are seen in or behind transparent solids: by some of the sight rays.

SIGHT_RAYS = 1 << 11
"""About so many rays enter a solid."""

WIDE = 0.25
"""Between two rays others go aside by so much more, per unit of distance, also such that enter by the next facet."""

BOUNCES = 2
"""So often a ray that is reflected from within is followed to another face."""


def items_in_glass(scene: Scene, projection: Projection) -> Bools:
    """(i,) the items that are seen in or behind transparent solids that refract light, and these, by their boxes; all
    where a solid reaches behind the eye."""
    boxes = [box_of_item(item) for item in scene.items]
    there = np.array([len(box) > 0 for box in boxes], dtype=np.bool_)
    found = np.array([item.material.refraction != 1.0 and not item.hides for item in scene.items]) & there
    every = np.array([box if len(box) else np.full((2, 3), np.nan) for box in boxes])
    corners = np.moveaxis(projection.points_of(np.concatenate([box_corners(box) for box in every])), 0, 1)
    corners = corners.reshape(-1, 8, 3)
    centres = corners.mean(axis=1)
    radii = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    glass = np.flatnonzero(found).tolist()
    made = triangles_of_items([scene.items[k] for k in glass], [boxes[k] for k in glass])
    for number, (triangles, _) in zip(glass, made, strict=True):
        found |= ((every[:, 0] <= every[number, 1]) & (every[:, 1] >= every[number, 0])).all(axis=1)
        points = projection.points_of(triangles.reshape(-1, 3))
        if (projection.depth_of(points) <= projection.near).any():
            return there
        starts, ways, apart = _leaving(projection, points.T.reshape(-1, 3, 3), scene.items[number].material.refraction)
        for batch in _batches(np.full(len(centres), max(len(starts), 1))):
            across = centres[batch, None] - starts
            along = (across * ways).sum(axis=2)
            aside = np.sqrt(np.maximum((across * across).sum(axis=2) - along * along, 0.0))
            reach = radii[batch, None] + apart
            found[batch] |= ((along >= -reach) & (aside <= reach + WIDE * np.maximum(along, 0.0))).any(axis=1)
    return found


def _leaving(projection: Projection, triangles: Floats, constant: float) -> tuple[Floats, Floats, float]:
    """Where rays leave a convex solid of triangles (t,3,3) that enter it all over its front, and their directions
    (n,3); and how far others are from one of them at most, where they enter."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    normals = cross(b - a, c - a)
    length = norm(normals)
    full = length > 0.0
    triangles, normals = triangles[full], normals[full] / length[full, None]
    middle = triangles.reshape(-1, 3).mean(axis=0)
    normals *= np.where(((triangles[:, 0] - middle) * normals).sum(axis=1) < 0.0, -1.0, 1.0)[:, None]
    steps = max(1, math.isqrt(SIGHT_RAYS // max(len(triangles), 1)))
    # The middles of the parts of triangles whose sides are cut into so many.
    i, j = (grid.ravel() for grid in np.mgrid[:steps, :steps])
    both = np.concatenate([np.stack([3 * i + up, 3 * j + up], axis=1) for up in (1, 2)]) / (3.0 * steps)
    both = both[both.sum(axis=1) < 1.0]
    shares = np.column_stack([both, 1.0 - both.sum(axis=1)])
    starts = np.einsum("sk,tkx->tsx", shares, triangles).reshape(-1, 3)
    entered = np.repeat(normals, len(shares), axis=0)
    eye = (0.0, 0.0, 1.0, 0.0) if projection.eye is None else (*projection.eye.tolist(), 1.0)
    rays = -towards(starts, eye)
    front = np.flatnonzero((rays * entered).sum(axis=1) < 0.0)
    front = front[:: 1 + len(front) // (2 * SIGHT_RAYS)]
    apart = float(norm(np.roll(triangles, 1, axis=1) - triangles).max(initial=0.0)) / steps
    starts, (rays, _) = starts[front], refracted(rays[front], entered[front], constant)
    left = [(np.zeros((0, 3)), np.zeros((0, 3)))]
    height = (normals * triangles[:, 0]).sum(axis=1)
    for _ in range(BOUNCES):
        last = [np.zeros(0, dtype=np.intp)]
        ahead = np.zeros(len(starts))
        for batch in _batches(np.full(len(starts), len(normals))):
            slope = np.einsum("nx,tx->nt", rays[batch], normals)
            with np.errstate(divide="ignore", invalid="ignore"):
                way = (height - np.einsum("nx,tx->nt", starts[batch], normals)) / slope
            way = np.where(slope > ROUNDING, way, np.inf)
            last.append(way.argmin(axis=1))
            ahead[batch] = way.min(axis=1, initial=np.inf)
        starts = starts + ahead[:, None] * rays
        rays, total = refracted(rays, normals[np.concatenate(last)], 1.0 / constant)
        left.append((starts[~total], rays[~total]))
        starts, rays = starts[total], rays[total]
    return np.concatenate([s for s, _ in left]), np.concatenate([r for _, r in left]), apart


# What is seen in and behind transparent solids, as filled polygons on the page.


def glass_fills(
    scene: Scene,
    view: View,
    projected: ProjectedFaces,
    lighting: Lighting,
    faces: ImageFaces,
    placement: Placement,
    tolerance_mm: float,
    decals: Sequence[Decals] = (),
) -> Overlay:
    """What refracting solids show, after the painted polygons of their front faces.

    tolerance_mm: how far sides of refracted polygons may be off the curves that they stand for; decals: what lies on
    faces, in the order in which it is painted.
    Source: Glaeser, section 6.6, figure 12.
    """
    shown = [shown_decals(view, lighting, some) for some in decals]
    lying = joined_decals(*(some.of(some.painting_order) for some in shown))
    seen = seen_in_glass(scene, view, projected, faces, tolerance_mm / placement.scale, lying)
    bare, marked = np.flatnonzero(seen.decal < 0), np.flatnonzero(seen.decal >= 0)
    base = seen_fills(view, lighting, seen.take(bare), placement, FillKind.GLASS).fills
    marks = seen.take(marked)
    laid = laid_fills(view, lighting, lying, Laid(marks.points, marks.offsets, marks.decal, marks.window), placement)
    laid = replace(laid, kind=np.full(len(laid), int(FillKind.GLASS)))
    order = np.argsort(np.concatenate([bare, marked]), kind="stable")
    return united(Overlay(Fills.joined(base, laid).take(order), seen.window), seen.decal)


def tinted(
    fills: Fills, clear: Bools, opacity: Floats, paper: Colours, overlays: Sequence[Overlay]
) -> tuple[Fills, tuple[Overlay, ...]]:
    """Painted polygons, those of refracting solids (m,) in the colour of the paper as it is seen through them, and
    overlays, those after such polygons as they are seen through them.

    Colours are mixed here once for all: transparent polygons that meet would leave a line between them.
    """
    tint, amount = fills.colours[fills.offsets[:-1]], np.where(clear, opacity, 0.0)
    corner = np.repeat(clear, np.diff(fills.offsets))
    sheet = replace(fills, colours=np.where(corner[:, None], paper, fills.colours).astype(np.uint8))
    blank = np.where(clear, int(FillKind.BACKGROUND), fills.kind)
    base = replace(mixed(sheet, tint, amount), opacity=np.where(clear, 1.0, fills.opacity), kind=blank)
    seen = (Overlay(mixed(o.fills, tint[o.after], amount[o.after]), o.after) for o in overlays)
    return base, tuple(seen)
