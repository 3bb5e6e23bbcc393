"""The beams of sight rays that enter a transparent convex solid by one face and leave it by another."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.glass.refracted_polygons import Soup, joined_soups
from vectorplot.effects.glass.sight_rays import Rays, SightWays, traced, virtual_points
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.convex.plane_cuts import PlaneBundles, cut_by_planes, planes_of
from vectorplot.geometry.elementary import arccos, tan
from vectorplot.geometry.mesh import next_positions
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import newell

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
    of all the rest; in lots."""
    found = []
    first, back = _meeting(view, solid, front)
    for some in _lots(np.diff(solid.offsets)[back] ** 2 * RAYS):
        beams = _beams(view, solid, front, windows, first[some], back[some])
        soup = joined_soups([_cut(rest, beams.bundles, lot, view.tolerance) for lot in _lots(_of(len(beams), rest))])
        if len(soup):
            found.append((beams, soup))
    return found


def totally_reflecting(view: View, solid: Solid, front: Ints, windows: Floats) -> tuple[Ints, Ints]:
    """Pairs of faces, the first a number in front (n,), of which no ray that enters by the one, seen in its window
    (4,n), leaves by the other, though some get there."""
    found = []
    first, back = _meeting(view, solid, front)
    for some in _lots(np.diff(solid.offsets)[back] ** 2 * RAYS):
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


def _cut(soup: Soup, bundles: PlaneBundles, lot: slice, tolerance: float) -> Soup:
    """What is above all planes of some bundles, on the ways of their numbers."""
    way, polygon = (grid.ravel() for grid in np.mgrid[lot, : len(soup)])
    parts = cut_by_planes(soup.points, soup.offsets, bundles, polygon, way, tolerance)
    return Soup(parts.points, parts.offsets, soup.source[polygon[parts.pair]], way[parts.pair])


def _lots(sizes: Ints) -> list[slice]:
    """Consecutive runs whose sizes add up to about PAIRS_AT_ONCE."""
    if not len(sizes):
        return []
    ends = np.unique(np.cumsum(sizes) // PAIRS_AT_ONCE, return_index=True)[1].tolist()
    return [slice(low, high) for low, high in zip(ends, [*ends[1:], len(sizes)], strict=True)]


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
    for lot in _lots(np.full(len(front), len(sizes))):
        own = front[lot]
        across = middle[:, None, :] - middle[:, own, None]
        along = (across * axis[:, lot, None]).sum(axis=0)
        aside = np.sqrt(np.maximum((across * across).sum(axis=0) - along * along, 0.0))
        reach = radius[own, None] + radius
        meets = aside <= MORE * reach + spread[lot, None] * (np.maximum(along, 0.0) + reach)
        meets &= along >= -reach
        meets |= np.isinf(spread[lot])[:, None]
        meets[np.arange(len(own)), own] = False
        meets &= solid.exits
        first, back = np.nonzero(meets)
        found.append((first + lot.start, back))
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
