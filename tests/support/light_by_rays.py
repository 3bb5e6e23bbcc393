"""Light on points, by rays, as plainly as possible: what lines between light and dark are compared with."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import vectorplot as vp
from vectorplot.surfaces.surface import is_implicit
from vectorplot.testing import visible_by_rays


def lamp_camera(scene: vp.Scene, lamp: vp.Light) -> vp.Camera:
    """The lamp as an eye."""
    middle, far = scene.bounds.mean(axis=0), 10.0 * np.ptp(scene.bounds, axis=0).max()
    way = np.asarray(lamp.position, dtype=np.float64)
    eye = middle + far * way / np.linalg.norm(way) if lamp.parallel else way
    return vp.Camera(tuple(eye.tolist()), target=tuple(middle.tolist()), parallel=lamp.parallel)


def shone_on(scene: vp.Scene, lamp: vp.Light, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whether (n,) nothing keeps a lamp's light from points (n,3), and how sure (n,) that is, see visible_by_rays."""
    casting = tuple(replace(item, occludes=item.casts_shadow) for item in scene.items)
    sight = visible_by_rays(replace(scene, items=casting), lamp_camera(scene, lamp), points)
    return sight.hidden_by == 0, sight.clearance


def towards(lamp: vp.Light, points: np.ndarray) -> np.ndarray:
    """(n,3) unit vectors from points (n,3) to a lamp."""
    way = np.asarray(lamp.position, dtype=np.float64) - (0.0 if lamp.parallel else points)
    way = np.broadcast_to(way, points.shape)
    return way / np.linalg.norm(way, axis=1, keepdims=True)


def grid_on(shape: object, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points (n,3) all over a surface with parameters or over the faces of a mesh, normals (n,3) there, and pairs (m,2)
    of neighbours on one smooth part."""
    points, normals, pairs, shift = [], [], [], 0
    for own, across, rows, columns in _patches(shape, count):
        number = shift + np.arange(rows * columns).reshape(rows, columns)
        points.append(own)
        normals.append(across)
        pairs += [np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1)]
        pairs += [np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1)]
        shift += rows * columns
    return np.concatenate(points), np.concatenate(normals), np.concatenate(pairs)


def _patches(shape, count):
    if isinstance(shape, vp.Mesh):
        for polygon in shape.polygons():
            corners = shape.vertices[list(polygon)]
            if len(corners) != 4:
                continue
            u, v = (np.linspace(0.013, 0.987, count)[axis] for axis in np.mgrid[:count, :count])
            a, b, c, d = corners
            u, v = u.ravel()[:, None], v.ravel()[:, None]
            normal = np.cross(b - a, d - a)
            own = (1 - u) * (1 - v) * a + u * (1 - v) * b + u * v * c + (1 - u) * v * d
            yield own, np.broadcast_to(normal / np.linalg.norm(normal), own.shape), count, count
        return
    assert not is_implicit(shape)
    domain = shape.domain
    u = domain.u_start + domain.size[0] * np.linspace(0.0013, 0.9987, count)
    v = domain.v_start + domain.size[1] * np.linspace(0.0013, 0.9987, count)
    u, v = (axis.ravel() for axis in np.meshgrid(u, v, indexing="ij"))
    one, two = shape.partials(u, v)
    points, normal = shape.points(u, v), np.cross(one, two)
    # Of what is closed outwards: volumes are positive.
    normal = normal * np.sign(((points - points.mean(axis=0)) * normal).sum())
    yield points, normal / np.linalg.norm(normal, axis=1, keepdims=True), count, count


def uncovered(scene: vp.Scene, lamp: vp.Light, drawing: vp.Drawing, item: int, count: int) -> np.ndarray:
    """(k,3) the middles of neighbours on an item of which one is lit and the other is not, without a line between light
    and dark near by. drawing: of terminators and shadows, hidden ones too."""
    from scipy.spatial import cKDTree

    from support.drawn import drawn

    points, normals, pairs = grid_on(scene.items[item].shape, count)
    size = float(np.ptp(scene.bounds, axis=0).max())
    lit, clearance = shone_on(scene, lamp, points + 1e-5 * size * normals)
    lit &= (normals * towards(lamp, points)).sum(axis=1) > 0.0
    sure = clearance[pairs].min(axis=1) > 1e-6
    changed = pairs[sure & (lit[pairs[:, 0]] != lit[pairs[:, 1]])]
    lines = drawn(drawing).of_kind("terminator", "shadow")
    ends = lines.world
    long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    fine = np.ceil(4.0 * count * long / size).astype(np.intp) + 1
    own = np.repeat(np.arange(len(fine)), fine)
    part = (np.arange(len(own)) - (np.cumsum(fine) - fine)[own]) / np.maximum(fine - 1, 1)[own]
    line_points = ends[own, 0] + part[:, None] * (ends[own, 1] - ends[own, 0])
    middle = points[changed].mean(axis=1)
    if not len(middle):
        return middle
    reach = 0.75 * np.linalg.norm(points[changed[:, 0]] - points[changed[:, 1]], axis=1) + 1e-3 * size
    if not len(line_points):
        return middle
    return middle[cKDTree(line_points).query(middle)[0] > reach]
