"""Lines in mirrors against rays that bounce: what is drawn is met by a ray, and what a ray meets is drawn.

Run as a script for more scenes: python -m support.mirror_rays SCENES (in the folder of the tests).
"""

from __future__ import annotations

import sys
from itertools import product

import numpy as np

import vectorplot as vp
from vectorplot.drawing.drawing import Paths
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import segments
from vectorplot.testing.shapes import box

NEAR, APART = 1e-7, 1e-5
"""What ends so near on its way, as a part of it, is met; places so far apart along an edge are seen alike."""

FAR = 1000.0
"""Rays are so long."""

ON_PAGE_MM, ON_EDGE = 1e-5, 1e-6
"""A stroke so near shows a point; a ray so near to an edge, in units of scenes about 10 wide, meets it."""


def turned_box(random: np.random.Generator, half: np.ndarray, centre: np.ndarray) -> Mesh:
    matrix, _ = np.linalg.qr(random.normal(size=(3, 3)))
    matrix[:, 0] *= np.sign(np.linalg.det(matrix))
    body = box(-half, half)
    return Mesh(body.vertices @ matrix.T + centre, body.corners, body.offsets)


def mirror_scene(seed: int) -> tuple[vp.Scene, vp.Camera]:
    """Turned boxes amid turned boards that mirror, some of which pierce each other."""
    random = np.random.default_rng(seed)
    items = []
    for k in range(random.integers(2, 6)):
        half = random.uniform(0.3, 1.0, 3)
        items.append(vp.Item(f"B{k}", turned_box(random, half, random.uniform(-2.5, 2.5, 3))))
    for k in range(random.integers(2, 4)):
        half = np.array([*random.uniform(1.5, 3.0, 2), 0.1])
        place = random.normal(size=3)
        place *= random.uniform(2.5, 4.5) / np.linalg.norm(place)
        items.append(vp.Item(f"M{k}", turned_box(random, half, place), material=vp.Material("mirror")))
    eye = random.normal(size=3)
    eye *= random.uniform(9, 16) / np.linalg.norm(eye)
    return vp.Scene(tuple(items)), vp.Camera(tuple(eye), (0.0, 0.0, 0.0), parallel=seed % 3 == 0)


class Room:
    """The triangles and edges of a scene of boxes, its mirrors' faces, and the eye."""

    def __init__(self, scene: vp.Scene, camera: vp.Camera) -> None:
        corners, item, edges, owner, self.normal, self.base, self.side, of = [], [], [], [], [], [], [], []
        for number, one in enumerate(scene.items):
            mesh = one.shape
            for begin, end in zip(mesh.offsets[:-1], mesh.offsets[1:], strict=True):
                face = mesh.vertices[mesh.corners[begin:end]]
                normal = np.cross(face[1] - face[0], face[2] - face[0])
                if one.material.is_mirror:
                    self.normal.append(normal / np.linalg.norm(normal))
                    self.base.append(face[0])
                    self.side.append(face)
                for k in range(2, len(face)):
                    corners.append(face[[0, k - 1, k]])
                    item.append(number)
                    of.append(len(self.normal) - 1 if one.material.is_mirror else -1)
                ring = np.stack([face, np.roll(face, -1, axis=0)], axis=1)
                kept = [a < b for a, b in ring.tolist()]
                edges.append(ring[kept])
                owner += [number] * sum(kept)
        self.corners, self.item, self.mirror = np.array(corners), np.array(item), np.array(of)
        self.edges, self.owner = np.concatenate(edges), np.array(owner)
        self.parallel, self.eye = camera.parallel, np.array(camera.eye)
        self.way = np.array(camera.target) - self.eye

    def first(self, start: np.ndarray, end: np.ndarray, near: float = NEAR) -> tuple[np.ndarray, np.ndarray]:
        """The triangle that segments (n,3) meet first, -1 for none, and after which part of their way, which is no
        smaller than near."""
        if not len(start):
            return np.zeros(0, dtype=int), np.zeros(0)
        a, b, c = (self.corners[:, k] for k in range(3))
        way = end - start
        normal = np.cross(b - a, c - a)
        with np.errstate(all="ignore"):
            slope = way @ normal.T
            t = (np.einsum("tk,tk->t", normal, a) - start @ normal.T) / slope
            point = start[:, None] + t[..., None] * way[:, None]
            inside = np.ones(t.shape, dtype=bool)
            for one, other in ((a, b), (b, c), (c, a)):
                inside &= np.einsum("ntk,tk->nt", np.cross(other - one, point - one), normal) >= 0.0
        t = np.where(inside & (t > near), t, np.inf)
        which = t.argmin(axis=1)
        part = t[np.arange(len(t)), which]
        return np.where(np.isfinite(part), which, -1), part

    def from_eye(self, points: np.ndarray) -> np.ndarray:
        """Where sight lines to points begin."""
        if not self.parallel:
            return np.broadcast_to(self.eye, points.shape)
        return points - 100.0 * self.way / np.linalg.norm(self.way)

    def reflected(self, mirror: int, points: np.ndarray) -> np.ndarray:
        height = (points - self.base[mirror]) @ self.normal[mirror]
        return points - 2.0 * height[:, None] * self.normal[mirror]

    def seen(self, points: np.ndarray, mirrors: tuple[int, ...]) -> np.ndarray:
        """Which points the eye sees by way of mirrors, one after the other."""
        images = [points]
        for mirror in reversed(mirrors):
            images.append(self.reflected(mirror, images[-1]))
        result, start = np.zeros(len(points), dtype=bool), self.from_eye(images[-1]).copy()
        left = np.arange(len(points))
        for mirror, image in zip(mirrors, images[:0:-1], strict=True):
            height, above = ((side - self.base[mirror]) @ self.normal[mirror] for side in (image[left], start[left]))
            left = left[(above > 0.0) & (height < -NEAR)]
            met, part = self.first(start[left], image[left])
            kept = (met >= 0) & (np.where(met >= 0, self.mirror[met], -1) == mirror)
            left, part = left[kept], part[kept]
            # What comes next is the image in the mirrors that are left.
            start[left] += part[:, None] * (image[left] - start[left])
        met, part = self.first(start[left], points[left])
        result[left] = (met < 0) | (part > 1.0 - NEAR)
        return result


def on_page(drawing: vp.Drawing, points: np.ndarray) -> np.ndarray:
    image = np.column_stack([points, np.ones(len(points))]) @ np.asarray(drawing.page_from_world).T
    return image[:, :2] / image[:, -1:]


def drawn(scene: vp.Scene, camera: vp.Camera, depth: int) -> vp.Drawing:
    lines = "contour,boundary,crease"
    return vp.draw(scene, camera, lines=lines, reflections=depth, curves="polyline", shortest_mm=0)


def reflected_strokes(drawing: vp.Drawing) -> tuple[np.ndarray, np.ndarray]:
    """The segments of the layer of reflected lines, (n,2,2), and their items."""
    return strokes_of(drawing, "reflected")


def strokes_of(drawing: vp.Drawing, name: str) -> tuple[np.ndarray, np.ndarray]:
    """The segments of a layer, (n,2,2), and their items."""
    paths = next((layer.strokes[0] for layer in drawing.layers if layer.name == name), Paths.empty())
    own = np.repeat(np.arange(len(paths)), np.diff(paths.offsets) - 1 + paths.closed)
    return paths.points[segments(paths)], paths.item[own]


def nearest(strokes: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(n,) distances of points (n,2) from the nearest of some segments."""
    result = np.full(len(points), np.inf)
    for a, b in strokes:
        way = b - a
        t = np.clip(((points - a) @ way) / max(way @ way, 1e-300), 0.0, 1.0)
        result = np.minimum(result, np.hypot(*(points - a - t[:, None] * way).T))
    return result


def missing(seed: int, depth: int, samples: int) -> tuple[int, int]:
    """How many points of edges rays see in mirrors that are not drawn, and how many are seen."""
    scene, camera = mirror_scene(seed)
    room, random = Room(scene, camera), np.random.default_rng(seed)
    drawing = drawn(scene, camera, depth)
    strokes, items = reflected_strokes(drawing)
    wrong = seen_in_all = 0
    for times in range(1, depth + 1):
        for mirrors in product(range(len(room.normal)), repeat=times):
            edge = random.integers(0, len(room.edges), samples)
            share = random.uniform(0.01, 0.99, samples)[:, None]
            a, b = room.edges[edge, 0], room.edges[edge, 1]
            points = a + share * (b - a)
            seen = room.seen(points, mirrors)
            if not seen.any():
                continue
            for step in (-APART, APART):
                seen &= room.seen(points + step * (b - a), mirrors)
            # What lies in the plane of a mirror is seen as itself.
            off = np.abs((points - room.base[mirrors[-1]]) @ room.normal[mirrors[-1]])
            which = np.flatnonzero(seen & (off > APART))
            image = points[which]
            for mirror in reversed(mirrors):
                image = room.reflected(mirror, image)
            places = on_page(drawing, image)
            for number in np.unique(room.owner[edge[which]]).tolist():
                own = room.owner[edge[which]] == number
                wrong += int((nearest(strokes[items == number], places[own]) > ON_PAGE_MM).sum())
            seen_in_all += len(which)
    return wrong, seen_in_all


def unfounded(seed: int, depth: int, samples: int) -> tuple[int, int]:
    """How many points of strokes in mirrors are no points of edges that rays see there, and how many were looked at."""
    scene, camera = mirror_scene(seed)
    room, random = Room(scene, camera), np.random.default_rng(seed)
    drawing = drawn(scene, camera, depth)
    strokes, items = reflected_strokes(drawing)
    if not len(strokes):
        return 0, 0
    which, places = places_on(strokes, samples, random)
    found = np.zeros(len(places), dtype=bool)
    start, way = sight(drawing, room, places)
    for _ in range(depth):
        met, part = room.first(start, start + FAR * way, NEAR / FAR)
        mirror = np.where(met >= 0, room.mirror[met], -1)
        towards = np.einsum("nk,nk->n", way, np.array(room.normal)[mirror]) < 0.0
        on = (mirror >= 0) & towards
        normal = np.array(room.normal)[np.where(on, mirror, 0)]
        start = np.where(on[:, None], start + FAR * np.where(np.isfinite(part), part, 0.0)[:, None] * way, np.inf)
        way = way - 2.0 * np.einsum("nk,nk->n", way, normal)[:, None] * normal
        begin = np.where(on[:, None], start, 0.0)
        _, part = room.first(begin, begin + FAR * way, NEAR / FAR)
        found |= on & met_edge(room, start, way, FAR * part, items[which])
        if not on.any():
            break
        start = np.where(on[:, None], start, 1e9)
    return int((~found).sum()), len(found)


def places_on(strokes: np.ndarray, samples: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """The strokes (n,2,2) that places evenly along all of them are on, and the places, those near ends left out."""
    length = np.hypot(*(strokes[:, 1] - strokes[:, 0]).T)
    which = random.choice(len(strokes), samples, p=length / length.sum())
    share = random.uniform(0.0, 1.0, samples)
    reach = APART * 100.0 / np.maximum(length[which], 1e-9)
    inside = (share > reach) & (share < 1.0 - reach)
    which, share = which[inside], share[inside, None]
    places = strokes[which, 0] + share * (strokes[which, 1] - strokes[which, 0])
    return which, places


def sight(drawing: vp.Drawing, room: Room, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the sight lines of places of the page begin, and their unit directions."""
    matrix = np.asarray(drawing.page_from_world)
    rows = matrix[[0, 1, -1]]
    # Two planes through the place: a point of the line is in both.
    one, two = (rows[k] - places[:, k, None] * rows[2] for k in (0, 1))
    way = np.cross(one[:, :3], two[:, :3])
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    way *= np.sign(way @ room.way)[:, None]
    if not room.parallel:
        return np.broadcast_to(room.eye, way.shape), way
    base = np.stack(
        [
            np.linalg.lstsq(np.stack([a[:3], b[:3]]), -np.array([a[3], b[3]]), rcond=None)[0]
            for a, b in zip(one, two, strict=True)
        ]
    )
    return base - 100.0 * way, way


def met_edge(room: Room, start: np.ndarray, way: np.ndarray, until: np.ndarray, item: np.ndarray) -> np.ndarray:
    """Which rays come by an edge of an item (n,) before they end."""
    result = np.zeros(len(start), dtype=bool)
    for (a, b), owner in zip(room.edges, room.owner, strict=True):
        side, arm = b - a, start - a
        across = np.cross(way, side)
        size = np.linalg.norm(across, axis=1)
        with np.errstate(all="ignore"):
            gap = np.abs(np.einsum("nk,nk->n", arm, across)) / size
            t = -np.einsum("nk,nk->n", np.cross(arm, side), across) / size**2
            place = start + t[:, None] * way
            s = (place - a) @ side / (side @ side)
            before = (t > 0) & (t < until + ON_EDGE * 100)
            result |= (owner == item) & (gap < ON_EDGE) & before & (s > -NEAR) & (s < 1 + NEAR)
    return result


if __name__ == "__main__":
    total = np.zeros(4, dtype=int)
    for seed in range(int(sys.argv[1])):
        row = (*missing(seed, 2, 1000), *unfounded(seed, 2, 3000))
        total += row
        if row[0] or row[2]:
            print("seed", seed, row)
    print(f"{total[0]} of {total[1]} seen points not drawn; {total[2]} of {total[3]} drawn points not seen")
