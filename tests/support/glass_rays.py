"""Lines in glass, in parallel pictures, against rays that are bent: what is drawn is met by a ray, and the other way.

Run as a script for more scenes: python -m support.glass_rays SCENES (in the folder of the tests).
"""

from __future__ import annotations

import sys

import numpy as np

import vectorplot as vp
from support.mirror_rays import (
    APART,
    NEAR,
    ON_PAGE_MM,
    Room,
    met_edge,
    nearest,
    on_page,
    places_on,
    sight,
    strokes_of,
    turned_box,
)

KINDS = "contour,boundary,crease"


def glass_scene(seed: int) -> tuple[vp.Scene, vp.Camera]:
    """A turned block of glass, and turned boxes in it, through its faces, behind it and before it."""
    random = np.random.default_rng(seed)
    constant = (1.333, 1.5, 1.1, 0.8)[seed % 4]
    block = turned_box(random, random.uniform(1.2, 2.0, 3), np.zeros(3))
    items = [vp.Item("GLASS", block, material=vp.Material("transparent", refraction=constant))]
    for k in range(random.integers(3, 7)):
        place = random.normal(size=3)
        place *= random.uniform(0.0, 4.5) / np.linalg.norm(place)
        items.append(vp.Item(f"B{k}", turned_box(random, random.uniform(0.15, 0.6, 3), place)))
    eye = random.normal(size=3)
    return vp.Scene(tuple(items)), vp.Camera(tuple(12.0 * eye / np.linalg.norm(eye)), (0.0, 0.0, 0.0), parallel=True)


class Block:
    """The faces of a convex block: unit normals outwards, and their constants."""

    def __init__(self, item: vp.Item) -> None:
        mesh = item.shape
        self.index = item.material.refraction
        self.normal = np.asarray(mesh.face_normals) / np.linalg.norm(mesh.face_normals, axis=1)[:, None]
        self.level = (self.normal * mesh.vertices[mesh.corners[mesh.offsets[:-1]]]).sum(axis=1)

    def leaves(self, points: np.ndarray, way: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """By which face lines from points along ways leave all half spaces first, and after which way."""
        slope = way @ self.normal.T
        with np.errstate(all="ignore"):
            t = (self.level - points @ self.normal.T) / slope
        t = np.where(slope > 0.0, t, np.inf)
        face = t.argmin(axis=1)
        return face, t[np.arange(len(t)), face]

    def enters(self, points: np.ndarray, way: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """By which face lines come in, -1 where they do not, and after which way."""
        slope = way @ self.normal.T
        with np.errstate(all="ignore"):
            t = (self.level - points @ self.normal.T) / slope
        first = np.where(slope < 0.0, t, -np.inf)
        last = np.where(slope > 0.0, t, np.inf).min(axis=1)
        face = first.argmax(axis=1)
        at = first[np.arange(len(t)), face]
        return np.where(at < last, face, -1), at


def snell(way: np.ndarray, normal: np.ndarray, constant: float) -> tuple[np.ndarray, np.ndarray]:
    """Unit ways behind a surface, sin(alpha) = constant sin(beta); and which rays get through."""
    along = way - (way * normal).sum(axis=1)[:, None] * normal
    bent = along / constant
    left = 1.0 - (bent * bent).sum(axis=1)
    sign = np.sign((way * normal).sum(axis=1))
    return bent + (sign * np.sqrt(np.maximum(left, 0.0)))[:, None] * normal, left > 0.0


def legs(
    block: Block, start: np.ndarray, way: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]:
    """The parts of rays: in the block and behind it: starts, ways, lengths, and which rays have them."""
    face, at = block.enters(start, way)
    inside = face >= 0
    entry = start + np.where(inside, at, 0.0)[:, None] * way
    bent, through = snell(way, block.normal[face], block.index)
    last, length = block.leaves(entry + NEAR * bent, bent)
    leaving = entry + (length + NEAR)[:, None] * bent
    out, passes = snell(bent, block.normal[last], 1.0 / block.index)
    return [
        (entry, bent, length + NEAR, inside & through),
        (leaving, out, np.full(len(start), 100.0), inside & through & passes),
    ]


def free(room: Room, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Which segments meet nothing opaque before their ends."""
    met, part = room.first(start, end)
    return (met < 0) | (part > 1.0 - NEAR)


def opaque(scene: vp.Scene, camera: vp.Camera) -> Room:
    return Room(vp.Scene(scene.items[1:]), camera)


def missing(seed: int, samples: int) -> tuple[int, int]:
    """How many points of edges bent rays see in glass or behind it that are not drawn, and how many are seen."""
    scene, camera = glass_scene(seed)
    room, block, random = opaque(scene, camera), Block(scene.items[0]), np.random.default_rng(seed)
    drawing = vp.draw(scene, camera, lines=KINDS, curves="polyline", shortest_mm=0)
    strokes, items = strokes_of(drawing, "refracted")
    sight_way = room.way / np.linalg.norm(room.way)
    edge = random.integers(0, len(room.edges), samples)
    share = random.uniform(0.01, 0.99, samples)[:, None]
    a, b = room.edges[edge, 0], room.edges[edge, 1]
    wrong = count = 0
    faces = range(len(block.level))
    for front in faces:
        way, enters = snell(sight_way[None], block.normal[front][None], block.index)
        if block.normal[front] @ sight_way >= 0.0 or not enters[0]:
            continue
        for back in (None, *faces):
            if back == front:
                continue
            seen = np.ones(samples, dtype=bool)
            for step in (0.0, -APART, APART):
                points = a + (share + step) * (b - a)
                seen &= by(room, block, points, front, back, sight_way, way[0])[0]
            points = a + share * (b - a)
            which = np.flatnonzero(seen)
            if not len(which):
                continue
            _, entry = by(room, block, points[which], front, back, sight_way, way[0])
            places = on_page(drawing, entry)
            for number in np.unique(room.owner[edge[which]]).tolist():
                own = room.owner[edge[which]] == number
                wrong += int((nearest(strokes[items == number + 1], places[own]) > ON_PAGE_MM).sum())
            count += len(which)
    return wrong, count


def by(
    room: Room, block: Block, points: np.ndarray, front: int, back: int | None, outside: np.ndarray, inside: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Which points rays see that enter a block by one face, and leave it by another one; and where they enter."""
    ends, seen = points, np.ones(len(points), dtype=bool)
    if back is not None:
        normal = block.normal[back][None]
        behind, passes = snell(inside[None], normal, 1.0 / block.index)
        if inside @ normal[0] <= 0.0 or not passes[0]:
            return np.zeros(len(points), dtype=bool), points
        height = points @ normal[0] - block.level[back]
        ends = points - (height / (behind[0] @ normal[0]))[:, None] * behind[0]
        others = np.delete(np.arange(len(block.level)), back)
        seen &= (height > NEAR) & (ends @ block.normal[others].T < block.level[others] - NEAR).all(axis=1)
        seen[seen] &= free(room, ends[seen], points[seen])
    else:
        seen &= (points @ block.normal.T < block.level - NEAR).all(axis=1)
    normal = block.normal[front]
    height = ends @ normal - block.level[front]
    entry = ends - (height / (inside @ normal))[:, None] * inside
    others = np.delete(np.arange(len(block.level)), front)
    seen &= (entry @ block.normal[others].T < block.level[others] - NEAR).all(axis=1)
    seen[seen] &= free(room, entry[seen], ends[seen])
    seen[seen] &= free(room, entry[seen] - 50.0 * outside, entry[seen])
    return seen, entry


def unfounded(seed: int, samples: int) -> tuple[int, int]:
    """How many points of strokes in glass are no points of edges that bent rays see, and how many were looked at."""
    scene, camera = glass_scene(seed)
    room, block, random = opaque(scene, camera), Block(scene.items[0]), np.random.default_rng(seed)
    drawing = vp.draw(scene, camera, lines=KINDS, curves="polyline", shortest_mm=0)
    strokes, items = strokes_of(drawing, "refracted")
    strokes, items = strokes[items > 0], items[items > 0]
    if not len(strokes):
        return 0, 0
    which, places = places_on(strokes, samples, random)
    start, way = sight(drawing, room, places)
    face, at = block.enters(start, way)
    found, open_ = np.zeros(len(places), dtype=bool), face >= 0
    open_ &= free(room, start, start + np.where(open_, at, 0.0)[:, None] * way)
    for begin, along, most, has in legs(block, start, way):
        _, part = room.first(begin, begin + most[:, None] * along)
        until = np.minimum(part, 1.0) * most
        found |= open_ & has & met_edge(room, begin, along, until, items[which] - 1)
        open_ &= has & (part > 1.0)
    return int((~found).sum()), len(found)


if __name__ == "__main__":
    total = np.zeros(4, dtype=int)
    for seed in range(int(sys.argv[1])):
        row = (*missing(seed, 20000), *unfounded(seed, 3000))
        total += row
        if row[0] or row[2]:
            print("seed", seed, row)
    print(f"{total[0]} of {total[1]} seen points not drawn; {total[2]} of {total[3]} drawn points not seen")
