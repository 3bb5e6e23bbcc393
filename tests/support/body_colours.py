"""What is seen of balls, capped frusta and meshes at places of a page, by rays: items, and their colours."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import vectorplot as vp
from support.top_fills import colours_at, fills_of, top_at
from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry import ragged
from vectorplot.geometry.projections import Projection, projection_of
from vectorplot.scene.view import View, view_of
from vectorplot.shading.illumination import shadow_shades
from vectorplot.shading.palettes import COLOUR_MAP
from vectorplot.shading.shaded_faces import exposed_scene, item_colours, point_shades
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies, quadric_bodies


@dataclass(frozen=True)
class Sight:
    """What rays meet: items (n,), -1 for none, points and outer normals (3,n)."""

    item: Ints
    points: Floats
    normals: Floats


def first_hits(bodies: QuadricBodies, view: View, start: Floats, way: Floats, least: float = 0.0) -> Sight:
    """The first bodies, and faces of the view, on rays (3,n) behind a part of their ways."""
    best, found = np.full(start.shape[1], np.inf), np.full(start.shape[1], -1)
    points, normals = np.zeros((2, 3, start.shape[1]))
    for k in range(len(bodies)):
        inverse = bodies.inverse[..., k]
        p = np.einsum("in,ij->jn", start - bodies.centre[:, k, None], inverse)
        d = np.einsum("in,ij->jn", way, inverse)
        for t, normal in _hits(bodies, k, p, d):
            near = (t > least) & (t < best)
            best = np.where(near, t, best)
            found = np.where(near, bodies.item[k], found)
            there = np.einsum("jn,ij->in", normal, inverse)
            points[:, near] = (start + np.where(np.isfinite(t), t, 0.0) * way)[:, near]
            normals[:, near] = (there / np.sqrt((there * there).sum(axis=0)))[:, near]
    fans, of = ragged.fans(view.offsets)
    for triangle, face in zip(view.corners[fans], of, strict=True):
        a, b, c = view.points[:, triangle].T
        normal = np.cross(b - a, c - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            t = (normal @ (a[:, None] - start)) / (normal @ way)
            there = start + t * way
        sides = [np.cross(q - p, (there.T - p)) @ normal for p, q in ((a, b), (b, c), (c, a))]
        near = (np.stack(sides) >= 0.0).all(axis=0) & (t > least) & (t < best)
        best = np.where(near, t, best)
        found = np.where(near, view.face_item[face], found)
        points[:, near] = there[:, near]
        unit = (normal / np.sqrt(normal @ normal))[:, None]
        normals[:, near] = (unit * -np.sign(unit.T @ way))[:, near]
    return Sight(found, points, normals)


def _hits(bodies: QuadricBodies, k: int, p: Floats, d: Floats) -> list[tuple[Floats, Floats]]:
    growth = bodies.growth[k]
    if bodies.is_ball[k]:
        a, b, c = (d * d).sum(axis=0), (p * d).sum(axis=0), (p * p).sum(axis=0) - 1.0
    else:
        wide = bodies.radii[0, k] + growth * p[2]
        slope = growth * d[2]
        a = d[0] ** 2 + d[1] ** 2 - slope**2
        b, c = d[0] * p[0] + d[1] * p[1] - wide * slope, p[0] ** 2 + p[1] ** 2 - wide**2
    found = []
    with np.errstate(all="ignore"):
        root = np.sqrt(b * b - a * c)
        for t in ((-b - root) / a, (-b + root) / a):
            s = p + t * d
            if bodies.is_ball[k]:
                found.append((np.where(np.isfinite(t), t, np.inf), s))
                continue
            inside = (s[2] >= 0.0) & (s[2] <= 1.0) & (bodies.radii[0, k] + growth * s[2] >= 0.0)
            normal = np.stack([s[0], s[1], -growth * (bodies.radii[0, k] + growth * s[2])])
            found.append((np.where(inside, t, np.inf), normal))
        for end in () if bodies.is_ball[k] else (0, 1):
            t = (end - p[2]) / d[2]
            s = p + t * d
            inside = s[0] ** 2 + s[1] ** 2 <= bodies.radii[end, k] ** 2
            normal = np.zeros_like(s)
            normal[2] = 2.0 * end - 1.0
            found.append((np.where(inside & np.isfinite(t), t, np.inf), normal))
    return found


def rays_of(drawing: Drawing, projection: Projection, places: Floats) -> tuple[Floats, Floats]:
    """Starts and ways (3,n) in the view of the sight lines through places (n,2) of the page."""
    rows = np.linalg.inv(drawing.page_from_world[[0, 1, 3]][:, :3])
    shift = drawing.page_from_world[[0, 1, 3], 3]
    far = rows @ (np.concatenate([places.T, np.ones((1, len(places)))]) - shift[:, None])
    world = far.T
    there = projection.points_of(world)
    way = there - projection.eye[:, None]
    return np.repeat(projection.eye[:, None], len(places), axis=1), way * np.sign(-way[2])


@dataclass(frozen=True)
class Seen:
    """Colours (n,3) and items (n,) at places, as they are and as they are painted, -1 for paper."""

    true: Floats
    item: Ints
    painted: Floats
    painted_item: Ints


def seen_at(scene: vp.Scene, camera: vp.Camera, drawing: Drawing, places: Floats) -> Seen:
    """What is seen and what is painted at places (n,2) of the page."""
    projection = projection_of(camera, scene.bounds)
    some = [k for k, item in enumerate(scene.items) if not isinstance(item.shape, vp.Mesh)]
    bodies = quadric_bodies(projection, [scene.items[k].shape for k in some], some)
    meshes = view_of(scene, projection)
    if projection.eye is None:
        rows = np.vstack([drawing.page_from_world[:2, :3], projection.axes[2]])
        flat = places.T - drawing.page_from_world[:2, 3:]
        # The depth of what is drawn is about one.
        start = projection.points_of(np.linalg.solve(rows, np.vstack([flat, np.zeros(len(places))])).T)
        start[2] = 10.0
        way = np.repeat([[0.0], [0.0], [-1.0]], len(places), axis=1)
    else:
        start, way = rays_of(drawing, projection, places)
    sight = first_hits(bodies, meshes, start, way)
    hit = np.flatnonzero(sight.item >= 0)
    every = np.arange(len(bodies))
    up = np.repeat([[0.0], [0.0], [1.0]], len(bodies), axis=1)
    ends = np.concatenate([bodies.support(up, every), bodies.support(-up, every)], axis=1)
    view = replace(meshes, points=np.concatenate([meshes.points, ends], axis=1))
    lit, lights = exposed_scene(view, scene)
    item, points, normals = sight.item[hit], sight.points[:, hit], sight.normals[:, hit]
    shade = point_shades(view, lit.items, lights, points.T, normals.T, item)
    lacking = np.zeros(len(hit), dtype=np.intp)
    if scene.lights:
        for number, light in enumerate(lights):
            position = np.array(light.position)[:, None]
            to_light = np.broadcast_to(position, points.shape) if light.parallel else position - points
            facing = (normals * to_light).sum(axis=0) > 0.0
            block = first_hits(bodies, meshes, points + 1e-9 * normals, to_light, 1e-9)
            arm = block.points - points
            far = (to_light * to_light).sum(axis=0)
            before = light.parallel | ((arm * to_light).sum(axis=0) < far)
            lacking |= np.where((block.item >= 0) & before & facing, 1 << number, 0)
    dark = ((lacking[None] >> np.arange(len(shade.shares))[:, None]) & 1) == 1
    shares = np.where(dark, shade.matt, shade.shares)
    total = np.where(lacking > 0, shadow_shades(shares, shade.intensity, lacking, shade.cue), shade.total)
    true = np.full((len(places), 3), 255.0)
    true[hit] = item_colours(scene.items, item, total, COLOUR_MAP)
    fills = fills_of(drawing)
    top = top_at(fills, places)
    painted = np.full((len(places), 3), 255.0)
    covered = top >= 0
    painted[covered] = colours_at(fills, top[covered], places[covered])
    item = np.where(covered, fills.item[np.maximum(top, 0)], -1)
    return Seen(true, sight.item, painted, item)


def assert_shown(
    scene: vp.Scene,
    camera: vp.Camera,
    drawing: Drawing,
    places: Floats,
    *,
    beside_mm: float,
    shaded: Bools,
    share: float,
    steps: float,
    rarely: float,
) -> None:
    """The right item at places (n,2) of the page, but nearer than beside_mm to outlines, in the right shade: a share of
    the places on items that are shaded (i,) within so many of 255 steps, and all but what lies beside the borders of
    shadows within others."""
    seen = seen_at(scene, camera, drawing, places)
    turns = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    around = beside_mm * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    for k in np.flatnonzero(seen.item != seen.painted_item):
        assert seen.painted_item[k] in seen_at(scene, camera, drawing, places[k] + around).item
    both = np.flatnonzero((seen.item == seen.painted_item) & (seen.item >= 0))
    off = np.abs(seen.true - seen.painted).max(axis=1)[both]
    assert np.quantile(off[shaded[seen.item[both]]], share) <= steps
    for k in both[off > rarely]:
        near = seen_at(scene, camera, drawing, places[k] + around).true
        assert np.abs(near - seen.painted[k]).max(axis=1).min() <= rarely
