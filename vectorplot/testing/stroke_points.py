"""Points on the strokes of a drawing at which rays can say whether they are drawn as they should be."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing, Paths
from vectorplot.features.parametric.conditions import CentralContour, ParallelContour
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.vectors import norm
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.surface import ImplicitSurface, Surface, hessians, is_implicit, is_parametrised
from vectorplot.testing.rays.nearest import inside, nearest_places
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.words import LineKind

STEPS = 8

ASIDE = 10.0
"""A point found from a chord may be beside the true curve, and is compared only where the clearance is larger than so
many times the distance of the chord from it."""

ONE_SHEET = [int(kind) for kind in (LineKind.CONTOUR, LineKind.PARAMETER, LineKind.ISOPHOTE, LineKind.SECTION)]


class StrokePoints(NamedTuple):
    """points (n,3) in the world; kind, item and hidden_by (n,) of their strokes; aside (n,): how far they may be from
    the true curve, in the world."""

    points: Floats
    kind: Ints
    item: Ints
    hidden_by: Ints
    aside: Floats

    def rows(self, kept: Ints | Bools) -> StrokePoints:
        """Some of them."""
        return StrokePoints(self.points[kept], self.kind[kept], self.item[kept], self.hidden_by[kept], self.aside[kept])


def stroke_points(drawing: Drawing, scene: Scene, camera: Camera, samples: int, seed: int) -> StrokePoints:
    """Random points on the strokes, half of them by length, half with one chance for each segment.

    Of straight strokes they lie anywhere. Of smooth strokes, whose chords are beside the curve, they are inner vertices
    (at the ends visibility changes, and so it may where strokes meet), or points of chords moved to the surface, those
    of a contour to the contour.
    """
    parts = [_segments(paths) for layer in drawing.layers for paths in layer.strokes if len(paths)]
    if not parts:
        return _none()
    lines, owner, smooth, sag, at_end = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    random = np.random.default_rng(seed)
    index, share = some_of(lines, samples, random)
    if not len(index):
        return _none()
    at_end = at_end[index] | _where_strokes_meet(lines, index)
    one_sheet = _on_one_sheet(scene, owner[index])
    vertex = smooth[index] & ((random.random(samples) < 0.5) | ~one_sheet)
    ends = vertex & at_end[np.arange(len(index)), np.round(share).astype(np.intp)]
    vertex &= ~(ends & one_sheet)
    useful = ~ends | one_sheet
    share = np.where(vertex, np.round(share), share)[:, None]
    points = lines[index, 0] * (1.0 - share) + lines[index, 1] * share
    aside = np.where(smooth[index] & ~vertex, ASIDE * sag[index], 0.0)
    kind, item, hidden_by = owner[index].T
    found = StrokePoints(points, kind, item, hidden_by, aside)
    moving = np.flatnonzero(smooth[index] & ~vertex)
    return _moved(found, moving, useful, lines[index, 1] - lines[index, 0], scene, camera)


def _where_strokes_meet(lines: Floats, some: Ints) -> Bools:
    """(n,2) whether more than two ends of segments (m,2,3) are where an end of some of them is, (n,) their indices."""
    from scipy.spatial import cKDTree

    ends = lines.reshape(-1, 3)
    near = ZERO_OF_EXTENT * float(np.ptp(ends, axis=0).max())
    tree = cKDTree(ends, balanced_tree=False, compact_nodes=False)
    return np.asarray(tree.query_ball_point(lines[some].reshape(-1, 3), near, return_length=True).reshape(-1, 2) > 2)


def some_of(lines: Floats, samples: int, random: np.random.Generator) -> tuple[Ints, Floats]:
    """Indices and shares of random points on segments, half of them by length, half with one chance for each."""
    length = norm(lines[:, 1] - lines[:, 0])
    if not length.sum() > 0.0:
        return np.zeros(0, dtype=np.intp), np.zeros(0)
    by_length = np.searchsorted(np.cumsum(length), random.random(samples // 2) * length.sum(), side="right")
    by_number = random.integers(len(lines), size=samples - samples // 2)
    return np.concatenate([by_length.clip(max=len(lines) - 1), by_number]), random.random(samples)


def _none() -> StrokePoints:
    none = np.zeros(0, dtype=np.intp)
    return StrokePoints(np.zeros((0, 3)), none, none, none, np.zeros(0))


def _segments(paths: Paths) -> tuple[Floats, Ints, Bools, Floats, Bools]:
    """Segments (n,2,3) of strokes in the world; kind, item and hidden_by (n,3); smooth (n,); and how far from the curve
    that smooth strokes sample each can be (n,), by the angle it makes with its neighbours; and whether a stroke begins
    or ends at the segment's ends (n,2)."""
    from vectorplot.testing.compare import path_segments

    start, end, path = path_segments(paths.offsets, paths.closed)
    lines = np.stack([paths.points3d[start], paths.points3d[end]], axis=1)
    way = lines[:, 1] - lines[:, 0]
    length = norm(way)
    unit = way / np.where(length > 0.0, length, 1.0)[:, None]
    turn = np.zeros(len(lines))
    # Segments of a path follow each other, and the first of a closed one follows the last.
    by_start = np.full(len(paths.points3d), -1)
    by_start[start] = np.arange(len(start))
    after = by_start[end]
    has = after >= 0
    angle = norm(unit[has] - unit[after[has]])
    np.maximum.at(turn, np.flatnonzero(has), angle)
    np.maximum.at(turn, after[has], angle)
    sag = turn * length / 4.0
    smooth = paths.smooth[path]
    largest = float(sag[smooth & (turn < 0.5)].max(initial=0.0))
    sag = np.where(has | (turn > 0.0), sag, largest)
    at_end = np.stack([~np.isin(start, end), ~has], axis=1)
    return lines, np.stack([paths.kind, paths.item, paths.hidden_by], axis=1)[path], smooth, sag, at_end


def _on_one_sheet(scene: Scene, owner: Ints) -> Bools:
    """(n,) whether strokes lie on one sheet of a smooth surface, away from its borders."""
    curved = np.array([is_parametrised(item.shape) or is_implicit(item.shape) for item in scene.items], dtype=np.bool_)
    return np.asarray(np.isin(owner[:, 0], ONE_SHEET) & curved[owner[:, 1]])


def _moved(found: StrokePoints, which: Ints, useful: Bools, way: Floats, scene: Scene, camera: Camera) -> StrokePoints:
    """The useful points, some of them moved from the chord to its curve; without those that cannot be."""
    points, good = found.points.copy(), useful.copy()
    for index, item in enumerate(scene.items):
        shape = item.shape
        for contour in (False, True):
            some = which[(found.item[which] == index) & ((found.kind[which] == LineKind.CONTOUR) == contour)]
            if not len(some):
                continue
            if is_parametrised(shape):
                points[some] = _to_surface(
                    shape, points[some], way[some], camera if contour else None, found.aside[some]
                )
            elif is_implicit(shape):
                points[some] = _to_implicit(shape, points[some], way[some], camera if contour else None)
            # A point that went far did not find its curve.
            went = norm(points[some] - found.points[some])
            good[some] &= went <= found.aside[some]
    return found._replace(points=points).rows(good)


def _to_surface(surface: Surface, points: Floats, way: Floats, camera: Camera | None, near: Floats) -> Floats:
    """The nearest points of a surface; with a camera, of its contour in the plane across the way."""
    places = nearest_places(surface, points, near).first(1)
    at = np.stack([places.u[:, 0], places.v[:, 0]], axis=1)
    if camera is None:
        return surface.points(at[:, 0], at[:, 1])
    condition = ParallelContour(surface, camera.direction) if camera.parallel else CentralContour(surface, camera.eye)
    for _ in range(STEPS):
        u, v = at.T
        f, g = condition.values(u, v), ((surface.points(u, v) - points) * way).sum(axis=1)
        f_u, f_v = condition.slopes(u, v)
        g_u, g_v = ((by * way).sum(axis=1) for by in surface.partials(u, v))
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.stack([g * f_v - f * g_v, f * g_u - g * f_u], axis=1) / (f_u * g_v - f_v * g_u)[:, None]
        at = inside(surface.domain, at + np.nan_to_num(step, nan=0.0, posinf=0.0, neginf=0.0))
    return surface.points(at[:, 0], at[:, 1])


def _to_implicit(surface: ImplicitSurface, points: Floats, way: Floats, camera: Camera | None) -> Floats:
    """The same on an implicit surface."""
    at = points.copy()
    for _ in range(STEPS):
        value, slope = surface.values(at), surface.gradients(at)
        square = (slope * slope).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            if camera is None:
                step = -(value / square)[:, None] * slope
            else:
                step = _contour_step(surface, at, points, way, camera, value, slope)
        at = at + np.nan_to_num(step, nan=0.0, posinf=0.0, neginf=0.0)
    return at


def _contour_step(
    surface: ImplicitSurface, at: Floats, points: Floats, way: Floats, camera: Camera, value: Floats, slope: Floats
) -> Floats:
    """Newton's step (n,3) to F = 0, grad F . (eye - x) = 0, in the plane across the way."""
    ray = np.broadcast_to(camera.direction, at.shape) if camera.parallel else np.asarray(camera.eye) - at
    turned = np.einsum("nij,nj->ni", hessians(surface, at), ray) - (0.0 if camera.parallel else 1.0) * slope
    third = np.cross(slope, turned)
    volume = (third * way).sum(axis=1)[:, None]
    f, g, h = value[:, None], (slope * ray).sum(axis=1)[:, None], ((at - points) * way).sum(axis=1)[:, None]
    return np.asarray(-(f * np.cross(turned, way) + g * np.cross(way, slope) + h * third) / volume)
