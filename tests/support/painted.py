"""Painted pictures looked at in single points, and what rays through these points meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.camera import Camera
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.painters_order import Painted, painters_order

NEAR_EDGE = 1e-6
"""Points nearer to the image of an edge than this part of the extent are not compared."""

EDGE_ON = 1e-9
"""Faces at a smaller angle to a ray, or in a plane nearer to the eye, are not met."""

SAME_DEPTH = 1e-6
"""Depths that differ by less than this part of the extent are the same: so faces in one place are, either way up."""


@dataclass(frozen=True)
class Compared:
    view: View
    painted: Painted
    wrong: int
    sure: int


def sample_points(view: View, count: int, seed: int = 0) -> tuple[Floats, Floats]:
    """Points of the image, strewn over all that the scene fills of it."""
    random = np.random.default_rng(seed)
    seen = np.clip(view.image[:, view.depth > view.near], -2.0, 2.0)
    low, high = seen.min(axis=1, initial=2.0), seen.max(axis=1, initial=-2.0)
    if (low > high).any():
        low, high = -np.ones(2), np.ones(2)
    return tuple(low[:, None] + (high - low)[:, None] * random.random((2, count)))


def nearest(view: View, x: Floats, y: Floats) -> tuple[Floats, Bools]:
    """(s,) inverse depths of what rays through points of the image meet first, 0 for nothing (in a parallel view the
    height, -inf for nothing), and whether they are clear of all edges. Every face, seen from either side, counts."""
    parallel = view.eye is None
    if parallel:
        start = np.stack([x + view.target[0], y + view.target[1], np.zeros_like(x)])
        along = np.tile(np.array([[0.0], [0.0], [1.0]]), len(x))
    else:
        start = np.tile(view.eye[:, None], len(x))
        along = np.stack([x / view.focus, y / view.focus, np.full_like(x, -1.0)])
    best = np.full(len(x), -np.inf if parallel else 0.0)
    sure = np.ones(len(x), dtype=np.bool_)
    for size in np.unique(view.face_sizes):
        faces = np.flatnonzero(view.face_sizes == size)
        for low in range(0, len(faces), 256):
            some = faces[low : low + 256]
            corner = view.points[:, view.corners[view.offsets[some][:, None] + np.arange(size)]]
            height, inside, near_edge = _met(corner, start, along, parallel)
            if not parallel:
                inside &= (height > 0.0) & (height < 1.0 / view.near)
            best = np.maximum(best, np.where(inside, height, best[None]).max(axis=0))
            sure &= ~near_edge.any(axis=0)
    return best, sure


def _met(corner: Floats, start: Floats, along: Floats, parallel: bool) -> tuple[Floats, Bools, Bools]:
    """(f,s) inverse depths (or heights) of rays on planes of faces, whether within the face, and whether near a
    side."""
    after = np.roll(corner, -1, axis=2)
    normal = np.cross(corner - corner[:, :, :1], after - corner[:, :, :1], axis=0).sum(axis=2)
    normal /= np.maximum(np.linalg.norm(normal, axis=0), 1e-300)
    slope = np.einsum("kf,ks->fs", normal, along)
    drop = (normal * corner[:, :, 0]).sum(axis=0)[:, None] - np.einsum("kf,ks->fs", normal, start)
    with np.errstate(divide="ignore", invalid="ignore"):
        height = drop / slope if parallel else slope / drop
    # A ray passes a side on its inner side where it turns about it as the normal says.
    across = np.abs(slope) > EDGE_ON * np.linalg.norm(along, axis=0)
    if not parallel:
        across &= np.abs(drop) > EDGE_ON
    inside, near_edge = across.copy(), np.zeros(slope.shape, dtype=np.bool_)
    turn = np.where(slope < 0.0, -1.0, 1.0)
    for k in range(corner.shape[2]):
        side = after[:, :, k] - corner[:, :, k]
        scale = np.maximum(np.linalg.norm(side, axis=0)[:, None] * np.linalg.norm(along, axis=0), 1e-300)
        if parallel:
            # All rays run along the third axis.
            (to_x, to_y), (from_x, from_y) = side[:2, :, None], corner[:2, :, k, None]
            moment = to_x * (start[1] - from_y) - to_y * (start[0] - from_x)
        else:
            # All of them start in the eye.
            arm = start[:, :1] - corner[:, :, k]
            moment = np.cross(side, arm, axis=0).T @ along
            scale = scale * np.maximum(np.linalg.norm(arm, axis=0), 1e-3)[:, None]
        distance = turn * moment / scale
        near_edge |= np.abs(distance) < NEAR_EDGE
        inside &= distance > 0.0
    return np.where(across, height, -np.inf), inside, near_edge & across


def top_polygon(faces: ImageFaces, x: Floats, y: Floats) -> Ints:
    """(s,) the last polygon painted over each point, or -1."""
    top = np.full(len(x), -1)
    for low in range(0, len(faces), 256):
        which = np.arange(low, min(low + 256, len(faces)))
        covered = np.ones((len(which), len(x)), dtype=np.bool_)
        sizes = np.diff(faces.offsets)[which]
        for k in range(int(sizes.max())):
            a = faces.offsets[which] + np.minimum(k, sizes - 1)
            b = faces.offsets[which] + np.where(k + 1 < sizes, k + 1, 0)
            (ax, ay), (bx, by) = faces.points[:2, a], faces.points[:2, b]
            turn = (bx - ax)[:, None] * (y - ay[:, None]) - (by - ay)[:, None] * (x - ax[:, None])
            covered &= (turn >= 0.0) | (k >= sizes)[:, None]
        last = np.where(covered, which[:, None], -1).max(axis=0)
        top = np.maximum(top, last)
    return top


def buried(view: View, faces: ImageFaces, samples: int, seed: int = 0) -> tuple[int, int]:
    """At how many points of the image a polygon is on top that lies below another one there, clear of all sides; and
    how many points were sure. Of as many polygons as one likes."""
    import shapely

    sizes = np.diff(faces.offsets)
    rings = shapely.linearrings(faces.points[:2].T, indices=np.repeat(np.arange(len(faces)), sizes))
    random = np.random.default_rng(seed)
    # In the middles of polygons: where these are small, points strewn over the image would miss them.
    middle = np.stack([np.add.reduceat(row, faces.offsets[:-1]) / sizes for row in faces.points[:2]])
    places = middle[:, random.choice(len(faces), min(samples, len(faces)), replace=False)]
    tree = shapely.STRtree(shapely.polygons(rings))
    place, polygon = tree.query(shapely.points(places.T), predicate="within")
    away = shapely.distance(shapely.points(places.T)[place], rings[polygon])
    height = faces.heights(polygon, *places[:, place])
    highest, top = np.full(places.shape[1], -np.inf), np.full(places.shape[1], -1)
    np.maximum.at(highest, place, height)
    np.maximum.at(top, place, polygon)
    on_top = polygon == top[place]
    allowed = SAME_DEPTH * faces.steepness[polygon]
    wrong = on_top & (height < highest[place] - allowed)
    # A polygon whose side is near may be the higher one by rounding.
    near = np.zeros(places.shape[1], dtype=np.bool_)
    near[place[away <= 10.0 * view.tolerance]] = True
    return int((wrong & ~near[place]).sum()), int((~near & (top >= 0)).sum())


def heights_on(view: View, source: Ints, x: Floats, y: Floats) -> Floats:
    """(s,) inverse depths, or heights, of faces of the view above points of the image; 0, or -inf, for face -1."""
    parallel = view.eye is None
    result = np.full(len(x), -np.inf if parallel else 0.0)
    for face in np.unique(source[source >= 0]):
        k = np.flatnonzero(source == face)
        corner = view.points[:, view.corners[view.offsets[face] : view.offsets[face + 1]]]
        after = np.roll(corner, -1, axis=1)
        normal = np.cross(corner - corner[:, :1], after - corner[:, :1], axis=0).sum(axis=1)
        still = np.zeros(len(k))
        if parallel:
            start, along = np.stack([x[k] + view.target[0], y[k] + view.target[1], still]), np.array([0.0, 0.0, 1.0])
        else:
            start, along = view.eye[:, None], np.stack([x[k] / view.focus, y[k] / view.focus, still - 1.0])
        drop, slope = normal @ (corner[:, :1] - start), normal @ along
        result[k] = drop / slope if parallel else slope / drop
    return result


def compared(scene: Scene, camera: Camera, samples: int = 1500, seed: int = 0) -> Compared:
    """The scene painted, and in how many of how many points something else than the nearest face is on top."""
    view = look(scene, camera)
    painted = painters_order(view)
    x, y = sample_points(view, samples, seed)
    truth, sure = nearest(view, x, y)
    top = top_polygon(painted.faces, x, y)
    source = np.append(painted.faces.source, -1)[top]
    mine = heights_on(view, source, x, y)
    same = mine == truth
    both = np.isfinite(mine) & np.isfinite(truth)
    scale = 1.0 if view.eye is None else np.maximum(np.abs(truth), 0.1)
    apart = np.abs(np.where(both, mine, 0.0) - np.where(both, truth, 0.0))
    same |= both & (apart <= SAME_DEPTH * scale)
    return Compared(view, painted, int((sure & ~same).sum()), int(sure.sum()))


def wrong_points(view: View, faces: ImageFaces, samples: int = 800) -> int:
    """In how many of the points something else than the nearest face is on top."""
    x, y = sample_points(view, samples)
    truth, sure = nearest(view, x, y)
    top = top_polygon(faces, x, y)
    mine = heights_on(view, np.append(faces.source, -1)[top], x, y)
    shown = np.isfinite(truth) & (truth != 0.0)
    assert sure.sum() > 0.5 * samples
    assert ((top >= 0) == shown)[sure].all()
    apart = np.abs(mine[shown] - truth[shown]) > SAME_DEPTH * np.maximum(np.abs(truth[shown]), 0.1)
    return int((apart & sure[shown]).sum())
