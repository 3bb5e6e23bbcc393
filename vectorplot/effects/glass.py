"""Transparent convex solids: what is in them and behind them, displaced by refraction."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.effects.passages import Passage, traced, virtual_points
from vectorplot.effects.windows import SeenThrough, joined_seen, near_windows, nothing_seen, seen_through
from vectorplot.geometry.convex_clipping import clipped
from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.geometry.plane_cuts import PlaneBundles, cut_by_planes, planes_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.occluders import solid_items
from vectorplot.visibility.painter.image_faces import ImageFaces, corner_positions, mapped, polygons_of
from vectorplot.visibility.painter.order import painters_order
from vectorplot.visibility.projected_faces import ProjectedFaces, newell

TOUCHING = 1.25
"""What is so many tolerances outside of a solid is still in it: the floor of a pool is the bottom of its water."""

LOOSE = 0.1
"""Behind a face things are looked at that are so much further aside than its rays go, per unit of distance."""

GRID = 8
"""Steps of a grid of rays over a face, in each direction."""

BLIND_ROUNDS = 2
"""Polygons of which no corner is seen are halved that often: there may be something in their midst."""

MOST_ROUNDS = 7
"""Bent polygons are halved at most so many times in each direction; what then still reaches beyond the border of total
reflection is left out."""

MOST_TRIANGLES = 1 << 17
"""No bent polygons are halved any more when there are so many pieces."""


@dataclass(frozen=True, eq=False)
class Soup:
    """Convex polygons: points (3,c) in the view, offsets (n+1,), source (n,) the faces of the view that they are of."""

    points: Floats
    offsets: Ints
    source: Ints

    def __len__(self) -> int:
        return len(self.source)


@dataclass(frozen=True, eq=False)
class Solid:
    """A transparent solid: face (k,) of the view, planes (4,k) outer unit normals and constants, constant: of the rays
    that enter it."""

    face: Ints
    planes: Floats
    constant: float


def refracting_items(scene: Scene, view: View, projected: ProjectedFaces) -> Bools:
    """(i,) the items that refract light: transparent materials with a constant other than 1, closed and convex.

    Others are transparent without refraction. Source: Glaeser, section 6.6.
    """
    bends = np.array([item.material.refraction != 1.0 and not item.occludes for item in scene.items], dtype=np.bool_)
    if not bends.any():
        return bends
    return bends & solid_items(replace(view, occludes=bends), projected)


def seen_in_glass(
    scene: Scene, view: View, projected: ProjectedFaces, painted: ImageFaces, tolerance: float
) -> SeenThrough:
    """What is seen in and behind transparent solids, refracted, to be painted after what is painted of the solids'
    front faces has been filled with the colour of the paper; then comes the tint of these faces.

    painted: the polygons of the picture, back to front. tolerance: how far, in units of the image, straight sides of
    polygons may be off the curves that refraction makes of them in a perspective; their corners are exact.
    Other transparent solids are seen without refraction, and total reflection within a solid shows nothing.
    Degenerate: of material thinner than its surroundings (constants below 1), which a perspective can see through up to
    the angle of total reflection only, parts near that angle may be missing.
    Source: Glaeser, section 6.6 (transparent solid polyhedra; the swimming pool, figure 12).
    """
    parts = []
    for item in np.flatnonzero(refracting_items(scene, view, projected)).tolist():
        solid = _solid(view, item, scene.items[item].material.refraction)
        others = np.flatnonzero(view.face_item != item)
        position, offsets = corner_positions(view.offsets, others)
        rest = Soup(view.points[:, view.corners[position]], offsets, others)
        inside = _cut(rest, _with(solid.planes, -1.0, TOUCHING * view.tolerance), view.tolerance)
        for front in np.flatnonzero(projected.facing[solid.face] > 0).tolist():
            windows = np.flatnonzero(painted.source == solid.face[front])
            if len(windows):
                parts += _behind_faces(view, solid, front, rest, painted, windows, tolerance)
                enters = _passage(solid, [front])
                parts.append(_ordered(view, enters, inside, painted, windows, tolerance))
    return joined_seen(parts)


def _solid(view: View, item: int, constant: float) -> Solid:
    face = np.flatnonzero(view.face_item == item)
    normal, _, first = newell(view, face)
    planes = planes_of(normal, view.points[:, first])
    inwards = (planes[:3] * view.points[:, view.item_vertices[item], None]).sum(axis=0) - planes[3] > view.tolerance
    planes[:, inwards] *= -1.0
    return Solid(face, planes, constant)


def _passage(solid: Solid, faces: list[int]) -> Passage:
    """The way of sight rays into a solid by one of its faces and, if there are two, out by the other."""
    normal = solid.planes[:3, faces] * np.array([-1.0, 1.0])[: len(faces)]
    constant = np.array([solid.constant, 1.0 / solid.constant])[: len(faces)]
    return Passage(normal, solid.planes[:3, faces] * solid.planes[3, faces], constant)


def _with(planes: Floats, side: float, margin: float) -> Floats:
    """The planes turned to one of their sides and moved so that the half-spaces grow by a margin."""
    turned = side * planes
    turned[3] -= margin
    return turned


def _cut(soup: Soup, planes: Floats, tolerance: float) -> Soup:
    """What is above all of some planes (4,k)."""
    every = np.arange(len(soup))
    bundle = PlaneBundles(planes, np.array([0, planes.shape[1]]))
    parts = cut_by_planes(soup.points, soup.offsets, bundle, every, np.zeros_like(every), tolerance)
    return Soup(parts.points, parts.offsets, soup.source[parts.pair])


def _behind_faces(
    view: View, solid: Solid, front: int, rest: Soup, painted: ImageFaces, windows: Ints, tolerance: float
) -> list[SeenThrough]:
    """What rays see that enter by one face and leave by any other."""
    parts = []
    for back in range(len(solid.face)):
        if back == front:
            continue
        here = np.array([0, view.face_sizes[solid.face[back]]], dtype=np.intp)
        position, _ = corner_positions(view.offsets, solid.face[[back]])
        outline = Soup(view.points[:, view.corners[position]], here, solid.face[[back]])
        planes, leaves = _beam(view, solid, front, back, outline.points)
        beam = _cut(rest, planes, view.tolerance)
        if len(beam):
            panes, window = _panes(view, _passage(solid, [front]), outline, painted, windows, tolerance)
            seen = _ordered(view, leaves, beam, panes, np.arange(len(panes)), tolerance)
            which = window[seen.window]
            parts.append(replace(seen, window=which, pane=painted.source[which]))
    return parts


def _beam(view: View, solid: Solid, front: int, back: int, outline: Floats) -> tuple[Floats, Passage]:
    """(4,k) planes about all that rays may meet that leave by the face with some outline (3,k), and their way there.

    Towards total reflection rays leave along the face: they are followed up to the last one of a grid of rays that
    leaves at all.
    """
    points = _grid(outline)
    virtual, seen = virtual_points(view, _passage(solid, [front]), points)
    leaves, image = _passage(solid, [front, back]), view.image_of(virtual)
    rays = traced(view, leaves, image)
    good = seen & rays.passes
    if not good.any():
        return np.array([[0.0], [0.0], [0.0], [1.0]]), leaves
    normal, constant = solid.planes[:3, back], solid.planes[3, back]
    beyond = np.append(normal, constant + TOUCHING * view.tolerance)[:, None]
    along = np.roll(outline, -1, axis=1) - outline
    outwards = np.cross(along, normal, axis=0)
    centre = outline.mean(axis=1, keepdims=True)
    outwards *= np.sign((outwards * (outline - centre)).sum(axis=0))
    outwards /= np.sqrt((outwards * outwards).sum(axis=0))
    direction = rays.direction[:, good]
    lean = (outwards.T @ direction / (normal @ direction)).max(axis=1)
    lean += LOOSE * (1.0 + np.abs(lean))
    sides = planes_of(lean * normal[:, None] - outwards, outline)
    sides[3] -= TOUCHING * view.tolerance
    return np.concatenate([beyond, sides], axis=1), replace(leaves, guides=image[:, good])


def _grid(outline: Floats) -> Floats:
    """(3,n) points all over a convex polygon (3,k): on the sides, and between these and the centre."""
    steps = np.linspace(0.0, 1.0, GRID + 1)
    sides = outline[..., None] + steps[:-1] * (np.roll(outline, -1, axis=1) - outline)[..., None]
    centre = outline.mean(axis=1)[:, None, None]
    return np.asarray(centre + steps * (sides.reshape(3, -1, 1) - centre)).reshape(3, -1)


def _panes(
    view: View, enters: Passage, outline: Soup, painted: ImageFaces, windows: Ints, tolerance: float
) -> tuple[ImageFaces, Ints]:
    """The parts of windows through which a face is seen, and the painted polygon that each is a part of."""
    soup = _bent(view, enters, outline, painted.box[:4, windows], tolerance)
    faces = polygons_of(mapped(view, soup.points), soup.offsets, soup.source, view.tolerance)
    pane, window = (grid.ravel() for grid in np.meshgrid(np.arange(len(faces)), windows, indexing="ij"))
    corner, starts = corner_positions(faces.offsets, pane)
    border, borders = corner_positions(painted.offsets, window)
    cut, ends, pair = clipped(
        faces.points[:, corner], starts, painted.points[:2, border], borders, tolerance=view.tolerance
    )
    pane = pane[pair]
    return ImageFaces(cut, ends, faces.planes[:, pane], faces.source[pane], faces.rank[pane]), window[pair]


def _ordered(
    view: View, passage: Passage, soup: Soup, painted: ImageFaces, windows: Ints, tolerance: float
) -> SeenThrough:
    """Polygons as they are seen through a passage, back to front, clipped with windows."""
    bent = _bent(view, passage, soup, painted.box[:4, windows], tolerance)
    if not len(bent):
        return nothing_seen()
    corners = np.arange(bent.points.shape[1])
    double = replace(
        view,
        points=bent.points,
        corners=corners,
        offsets=bent.offsets,
        inner=np.zeros(len(corners), dtype=np.bool_),
        face_item=np.zeros(len(bent), dtype=np.intp),
        item_vertices=np.array([0, len(corners)]),
        occludes=np.ones(1, dtype=np.bool_),
    )
    faces = painters_order(double).faces
    return seen_through(replace(faces, source=bent.source[faces.source]), painted, windows, view.tolerance)


def _bent(view: View, passage: Passage, soup: Soup, windows: Floats, tolerance: float) -> Soup:
    """Polygons with virtual corners; in a perspective cut into triangles until their sides are straight enough.

    Left out are polygons with corners that are not seen, and triangles beside all windows (4,w).
    """
    if not len(soup) or not windows.shape[1]:
        return Soup(np.zeros((3, 0)), np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.intp))
    if view.eye is None:
        points, seen = virtual_points(view, passage, soup.points)
        kept = np.flatnonzero(np.logical_and.reduceat(seen, soup.offsets[:-1]))
        position, offsets = corner_positions(soup.offsets, kept)
        return Soup(points[:, position], offsets, soup.source[kept])
    triangles, source = _fans(soup)
    done: list[tuple[Floats, Ints]] = []
    for number in range(MOST_ROUNDS + 1):
        sides = 0.5 * (triangles + np.roll(triangles, -1, axis=1))
        points, seen = virtual_points(view, passage, np.concatenate([triangles, sides], axis=1).reshape(3, -1))
        points, seen = points.reshape(3, 6, -1), seen.reshape(6, -1)
        off, near = _bends(view, points, seen, windows)
        partly = ~seen.all(axis=0)
        hopeful = seen.any(axis=0) | (number < BLIND_ROUNDS)
        halved = near & ((partly & hopeful) | (~partly & (off > tolerance)))
        halved &= (number < MOST_ROUNDS) & (4 * len(source) <= MOST_TRIANGLES)
        fine = ~halved & seen[:3].all(axis=0) & near
        done.append((points[:, :3, fine], source[fine]))
        triangles, source = _quartered(triangles[:, :, halved], sides[:, :, halved]), np.tile(source[halved], 4)
        if not len(source):
            break
    corners = np.concatenate([part[0] for part in done], axis=2)
    count = corners.shape[2]
    sources = np.concatenate([part[1] for part in done])
    return Soup(corners.transpose(0, 2, 1).reshape(3, -1), np.arange(0, 3 * count + 1, 3), sources)


def _bends(view: View, points: Floats, seen: Bools, windows: Floats) -> tuple[Floats, Bools]:
    """How far the middles of the sides of triangles (3,6,n), corners and then middles, are off the straight lines in
    the image, and whether the triangles may be seen in windows (4,w).

    Of triangles that are seen (6,n) only partly, what is not is taken to be no farther off than they are wide.
    """
    image = view.image_of(points.reshape(3, -1)).reshape(2, 6, -1)
    off = image[:, 3:] - 0.5 * (image[:, :3] + np.roll(image[:, :3], -1, axis=1))
    bend = np.sqrt((off * off).sum(axis=0)).max(axis=0)
    low = np.where(seen, image, np.inf).min(axis=1)
    high = np.where(seen, image, -np.inf).max(axis=1)
    margin = np.where(seen.all(axis=0), bend, (high - low).max(axis=0))
    box = np.stack([low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin])
    return bend, near_windows(box, windows) | ~seen.any(axis=0)


def _fans(soup: Soup) -> tuple[Floats, Ints]:
    """Triangles from the first corners of polygons, (3,3,t): coordinate, corner, triangle; and their sources."""
    counts = np.diff(soup.offsets) - 2
    owner = np.repeat(np.arange(len(soup)), counts)
    first = soup.offsets[:-1][owner]
    step = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    corner = np.stack([first, first + step + 1, first + step + 2])
    return soup.points[:, corner], soup.source[owner]


def _quartered(corners: Floats, sides: Floats) -> Floats:
    """The four triangles (3,3,4t) that the middles of the sides make of triangles (3,3,t)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, bc, ca = sides[:, 0], sides[:, 1], sides[:, 2]
    return np.stack(
        [np.concatenate(rows, axis=1) for rows in ([a, b, c, ab], [ab, bc, ca, bc], [ca, ab, bc, ca])], axis=1
    )
