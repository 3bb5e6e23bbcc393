"""How near rays from points to a lamp come to the outlines of what is between them: plain geometry, shape by shape."""

from __future__ import annotations

import numpy as np

import vectorplot as vp
from support.light_by_rays import towards
from vectorplot.surfaces import Torus

NEAR = 1e-4
"""What is met nearer to the point than this is what the point lies on."""

SAMPLES = 2001
"""On a ray, among which the places nearest to a ring are sought."""

AT_ONCE = 400


def grazing_gaps(scene: vp.Scene, lamp: vp.Light, points: np.ndarray) -> np.ndarray:
    """(n,) how far rays from points (n,3) to a lamp miss touching anything: an edge of a mesh, a ball or a ring about
    the z axis; infinite where there is nothing between."""
    ways = towards(lamp, points)
    far = np.full(len(points), np.inf)
    if not lamp.parallel:
        far = np.linalg.norm(np.asarray(lamp.position) - points, axis=1)
    gaps = np.full(len(points), np.inf)
    for item in scene.items:
        if isinstance(item.shape, vp.Mesh):
            own = _to_edges(points, ways, far, item.shape)
        elif isinstance(item.shape, Torus):
            own = _to_ring(points, ways, far, item.shape)
        else:
            low, high = vp.Scene((item,)).bounds
            own = _to_ball(points, ways, far, 0.5 * (low + high), 0.5 * float((high - low)[0]))
        gaps = np.minimum(gaps, own)
    return gaps


def _to_edges(points: np.ndarray, ways: np.ndarray, far: np.ndarray, mesh: vp.Mesh) -> np.ndarray:
    """Distances of lines from the edges of a mesh, each edge by itself."""
    best = np.full(len(points), np.inf)
    for begin, end in zip(mesh.vertices[mesh.corners], mesh.vertices[mesh.corners[mesh.next_corner]], strict=True):
        edge, arm = end - begin, points - begin
        normal = np.cross(ways, edge)
        with np.errstate(all="ignore"):
            part = np.clip((np.cross(ways, arm) * normal).sum(axis=1) / (normal * normal).sum(axis=1), 0.0, 1.0)
        place = begin + np.nan_to_num(part)[:, None] * edge
        along = ((place - points) * ways).sum(axis=1)
        gap = np.linalg.norm(points + along[:, None] * ways - place, axis=1)
        best = np.where((along > NEAR) & (along < far), np.minimum(best, gap), best)
    return best


def _to_ball(points: np.ndarray, ways: np.ndarray, far: np.ndarray, centre: np.ndarray, radius: float) -> np.ndarray:
    along = ((centre - points) * ways).sum(axis=1)
    gap = np.abs(np.linalg.norm(points + along[:, None] * ways - centre, axis=1) - radius)
    return np.where((along > NEAR) & (along < far), gap, np.inf)


def _to_ring(points: np.ndarray, ways: np.ndarray, far: np.ndarray, ring: Torus) -> np.ndarray:
    """Distances from the tube at the places of rays where they are least, found by thirds."""

    def off(along: np.ndarray, which: np.ndarray) -> np.ndarray:
        place = points[which][:, None] + along[..., None] * ways[which][:, None]
        return np.hypot(np.hypot(place[..., 0], place[..., 1]) - ring.major, place[..., 2]) - ring.minor

    best = np.full(len(points), np.inf)
    reach = np.minimum(far, 6.0 * (ring.major + ring.minor))
    for first in range(0, len(points), AT_ONCE):
        own = np.arange(first, min(first + AT_ONCE, len(points)))
        along = np.linspace(0.0, 1.0, SAMPLES) * reach[own, None]
        found = off(along, own)
        row, column = np.nonzero((found[:, 1:-1] <= found[:, :-2]) & (found[:, 1:-1] <= found[:, 2:]))
        low, high = along[row, column], along[row, column + 2]
        for _ in range(90):
            one, two = (2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0
            before = off(one[:, None], own[row])[:, 0] < off(two[:, None], own[row])[:, 0]
            low, high = np.where(before, low, one), np.where(before, two, high)
        middle = 0.5 * (low + high)
        gap = np.abs(off(middle[:, None], own[row])[:, 0])
        np.minimum.at(best, own[row], np.where(middle > NEAR, gap, np.inf))
    return best


def shadow_points(drawing: vp.Drawing) -> tuple[np.ndarray, np.ndarray]:
    """(n,3) the points of all strokes that are edges of shadows, and (n,) which are ends of strokes."""
    points, ends = [np.zeros((0, 3))], [np.zeros(0, dtype=bool)]
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in np.flatnonzero(paths.kind == vp.LineKind.SHADOW):
                own = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
                end = np.zeros(len(own), dtype=bool)
                end[[0, -1]] = not paths.closed[k]
                points.append(own)
                ends.append(end)
    return np.concatenate(points), np.concatenate(ends)
