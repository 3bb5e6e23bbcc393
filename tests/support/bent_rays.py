"""Lines in glass in perspectives, and in curved mirrors, against rays: what is drawn is met, and the other way.

Places that show points are found by minimising the length of the way of light, by a method of scipy's, and rays are
followed by Snell's law and mirrored at normals, all by itself. Run as a script for more scenes: python -m
support.bent_rays SCENES (in the folder of the tests).
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.optimize import minimize

import vectorplot as vp
from support.glass_rays import KINDS, Block, free, glass_scene, legs, opaque, snell
from support.mirror_rays import Room, nearest, on_page, places_on, sight, strokes_of, turned_box
from vectorplot.surfaces import Ellipsoid, Sphere, rod
from vectorplot.testing.shapes import box

TOLERANCE_MM = 0.03
"""How far drawn curves may be off."""

OFF_MM = 3.0 * TOLERANCE_MM
"""A stroke so near shows a point: chords are off by the tolerance, and hidden up to twice of that beside the border."""

OFF = 5e-3
"""A ray so near to an edge, in units of scenes about 10 wide, meets it."""

GRAZING = 0.3
"""The cosine of the angle at which light is said to graze a mirror."""

BESIDE = 4e-3
"""Points so far apart along an edge, as a part of it, are seen alike."""


def drawn(scene: vp.Scene, camera: vp.Camera) -> vp.Drawing:
    return vp.draw(scene, camera, lines=KINDS, curves="polyline", shortest_mm=0, tolerance_mm=TOLERANCE_MM)


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
            s = (start + t[:, None] * way - a) @ side / (side @ side)
            result |= (owner == item) & (gap < OFF) & (t > -OFF) & (t < until + 20 * OFF) & (np.abs(s - 0.5) < 0.51)
    return result


def around(places: np.ndarray) -> list[np.ndarray]:
    """Places, and others beside them by as much as strokes may be off."""
    return [places + 2.0 * TOLERANCE_MM * np.array([x, y]) for x in (0, -1, 1) for y in (0, -1, 1)]


def way_of_light(
    places: Callable[[np.ndarray], list[np.ndarray]], weights: list[float], start: np.ndarray
) -> np.ndarray:
    """The parameters for which the way over places is shortest."""

    def length(x: np.ndarray) -> float:
        path = places(x)
        return sum(w * float(np.linalg.norm(b - a)) for w, (a, b) in zip(weights, pairwise(path), strict=True))

    found = minimize(length, start, method="BFGS", options={"gtol": 1e-9}).x
    simplex = {"xatol": 1e-10, "fatol": 1e-14, "maxiter": 2000}
    return minimize(length, found, method="Nelder-Mead", options=simplex).x


def unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


# Glass in perspectives.


def glass_in_perspective(seed: int) -> tuple[vp.Scene, vp.Camera]:
    """Turned blocks of glass with boxes about them; every third scene boxes that stand on the floor of a pool."""
    random = np.random.default_rng(seed)
    if seed % 3:
        scene, camera = glass_scene(seed)
        eye = np.array(camera.eye) * random.uniform(0.5, 1.0)
        return scene, replace(camera, eye=tuple(eye), parallel=False)
    water = vp.Material("transparent", refraction=1.333)
    items = [vp.Item("WATER", box((-3, -2, 0), (3, 2, 1.8)), material=water)]
    items.append(vp.Item("FLOOR", box((-3, -2, -0.2), (3, 2, 0))))
    for k in range(3):
        (x, y), (a, b) = random.uniform((-2.3, -1.3), (2.3, 1.3)), random.uniform(0.2, 0.5, 2)
        items.append(vp.Item(f"B{k}", box((x - a, y - b, 0), (x + a, y + b, random.uniform(0.3, 2.5)))))
    turn, rise = random.uniform(0.0, 2.0 * np.pi), random.uniform(0.5, 1.2)
    eye = 9.0 * np.array([np.cos(turn) * np.cos(rise), np.sin(turn) * np.cos(rise), np.sin(rise)])
    return vp.Scene(tuple(items)), vp.Camera(tuple(eye.tolist()), (0, 0, 0.5))


def unfounded_in_glass(seed: int, samples: int) -> tuple[int, int]:
    """How many points of strokes in glass are no points of edges that bent rays see, and how many were looked at."""
    scene, camera = glass_in_perspective(seed)
    room, block, random = opaque(scene, camera), Block(scene.items[0]), np.random.default_rng(seed)
    drawing = drawn(scene, camera)
    strokes, items = strokes_of(drawing, "refracted")
    strokes, items = strokes[items > 0], items[items > 0]
    if not len(strokes):
        return 0, 0
    which, places = places_on(strokes, samples, random)
    found = np.zeros(len(places), dtype=bool)
    for beside in around(places):
        start, way = sight(drawing, room, beside)
        face, at = block.enters(start, way)
        open_ = face >= 0
        open_ &= free(room, start, start + np.where(open_, at, 0.0)[:, None] * way)
        for begin, along, most, has in legs(block, start, way):
            _, part = room.first(begin, begin + most[:, None] * along)
            found |= open_ & has & met_edge(room, begin, along, np.minimum(part, 1.0) * most, items[which] - 1)
            open_ &= has & (part > 1.0)
    return int((~found).sum()), len(found)


def missing_in_glass(seed: int, samples: int) -> tuple[int, int]:
    """How many points of edges bent rays see in glass or behind it that are not drawn, and how many are seen."""
    scene, camera = glass_in_perspective(seed)
    room, block, random = opaque(scene, camera), Block(scene.items[0]), np.random.default_rng(seed)
    drawing = drawn(scene, camera)
    strokes, items = strokes_of(drawing, "refracted")
    own = np.flatnonzero([scene.items[1 + k].name != "FLOOR" for k in room.owner])
    wrong = count = 0
    for edge, share in zip(random.choice(own, samples), random.uniform(0.01, 0.99, samples), strict=True):
        (a, b), faces = room.edges[edge], range(len(block.level))
        ends = [a + (share + step) * (b - a) for step in (0.0, -BESIDE, BESIDE)]
        height = block.normal @ ends[0] - block.level
        for front in (k for k in faces if block.normal[k] @ room.eye > block.level[k]):
            for back in [None] if height.max() < 1e-9 else [k for k in faces if k != front and height[k] > OFF]:
                shown = [by_glass(room, block, end, front, back) for end in ends]
                if any(place is None for place in shown):
                    continue
                count += 1
                near = nearest(strokes[items == room.owner[edge] + 1], on_page(drawing, shown[0][None]))
                wrong += int(near[0] > OFF_MM)
    return wrong, count


def by_glass(room: Room, block: Block, point: np.ndarray, front: int, back: int | None) -> np.ndarray | None:
    """Where a face shows a point by which light leaves a block, having entered it by another one or being in it."""
    planes = [front] if back is None else [front, back]
    frames = []
    for k in planes:
        one = unit(np.cross(block.normal[k], np.eye(3)[np.abs(block.normal[k]).argmin()]))
        frames.append((block.normal[k] * block.level[k], one, np.cross(block.normal[k], one)))

    def path(x: np.ndarray) -> list[np.ndarray]:
        on = [base + x[2 * k] * u + x[2 * k + 1] * v for k, (base, u, v) in enumerate(frames)]
        return [room.eye, *on, point]

    middle = [0.5 * (room.eye + point)] * len(planes)
    start = [(m - base) @ axis for m, (base, u, v) in zip(middle, frames, strict=True) for axis in (u, v)]
    found = path(way_of_light(path, [1.0, block.index, 1.0][: len(planes) + 1], np.array(start)))
    for k, place in zip(planes, found[1:-1], strict=True):
        others = np.delete(np.arange(len(block.level)), k)
        if (block.normal[others] @ place > block.level[others] - OFF).any():
            return None
    constants = (block.index, 1.0 / block.index)
    for k, constant, one, two, three in zip(planes, constants, found, found[1:], found[2:], strict=False):
        bent, through = snell(unit(two - one)[None], block.normal[k][None], constant)
        if not through[0] or np.linalg.norm(bent[0] - unit(three - two)) > 1e-4:
            return None
    for one, two in pairwise(found):
        if not free(room, one[None], (one + (1.0 - 1e-5) * (two - one))[None])[0]:
            return None
    return found[1]


# Curved mirrors.

SHAPES = (
    (Sphere(1.3), lambda p: (p @ p) / 1.69 - 1.0, lambda p: p),
    (
        Ellipsoid((1.6, 1.0, 0.8)),
        lambda p: p[0] ** 2 / 2.56 + p[1] ** 2 + p[2] ** 2 / 0.64 - 1.0,
        lambda p: p / np.array([2.56, 1.0, 0.64]),
    ),
    (rod((0, 0, -1.5), (0, 0, 1.5), 0.9), lambda p: p[0] ** 2 + p[1] ** 2 - 0.81, lambda p: p * np.array([1, 1, 0])),
)
"""Mirrors about the origin, what is 0 on them, and ways along their normals."""


def mirror_scene(seed: int) -> tuple[vp.Scene, vp.Camera]:
    """Turned boxes about a ball, an ellipsoid or a rod that mirrors, in a perspective or a parallel picture."""
    random = np.random.default_rng(seed)
    items = [vp.Item("MIRROR", SHAPES[seed % 3][0], material=vp.Material("mirror"))]
    for k in range(4):
        place = random.normal(size=3)
        place *= random.uniform(2.6, 4.5) / np.linalg.norm(place)
        items.append(vp.Item(f"B{k}", turned_box(random, random.uniform(0.2, 0.6, 3), place)))
    eye = random.normal(size=3) + np.array([0.0, -1.5, 0.0])
    return vp.Scene(tuple(items)), vp.Camera(tuple((11.0 * unit(eye)).tolist()), (0, 0, 0), parallel=seed % 4 == 3)


def meeting(seed: int, start: np.ndarray, way: np.ndarray) -> np.ndarray:
    """(n,) after which part of their way rays meet the mirror first; infinite where they do not."""
    value = SHAPES[seed % 3][1]
    result = np.full(len(start), np.inf)
    for k, (p, d) in enumerate(zip(start, way, strict=True)):
        # Of a quadratic function three values tell all.
        c, one, two = value(p), value(p + d), value(p - d)
        a, b = 0.5 * (one + two) - c, 0.5 * (one - two)
        roots = np.roots([a, b, c])
        real = [float(t.real) for t in roots if abs(t.imag) < 1e-9 and t.real > 1e-6]
        if seed % 3 == 2:
            real = [t for t in real if abs((p + t * d)[2]) <= 1.5]
        result[k] = min(real, default=np.inf)
    return result


def unfounded_in_mirror(seed: int, samples: int) -> tuple[int, int]:
    """How many points of strokes in a mirror are no points of edges that it shows, and how many were looked at: those
    where light does not graze it, and shows far more than it is wide on the page."""
    scene, camera = mirror_scene(seed)
    room, random = Room(vp.Scene(scene.items[1:]), camera), np.random.default_rng(seed)
    drawing = drawn(scene, camera)
    strokes, items = strokes_of(drawing, "reflected")
    if not len(strokes):
        return 0, 0
    which, places = places_on(strokes, samples, random)
    start, way = sight(drawing, room, places)
    met = start + meeting(seed, start, way)[:, None] * way
    normal = np.array([unit(SHAPES[seed % 3][2](p)) for p in np.nan_to_num(met, posinf=1.0, neginf=1.0)])
    which, places = (x[(way * normal).sum(axis=1) < -GRAZING] for x in (which, places))
    found = np.zeros(len(places), dtype=bool)
    for beside in around(places):
        start, way = sight(drawing, room, beside)
        part = meeting(seed, start, way)
        on = np.isfinite(part)
        met = start + np.where(on, part, 1.0)[:, None] * way
        open_ = on & free(room, np.array(start), met)
        normal = np.array([unit(SHAPES[seed % 3][2](p)) for p in met])
        back = way - 2.0 * (way * normal).sum(axis=1)[:, None] * normal
        _, until = room.first(met, met + 100.0 * back)
        found |= open_ & met_edge(room, met, back, np.minimum(100.0 * until, 100.0), items[which] - 1)
    return int((~found).sum()), len(found)


def missing_in_mirror(seed: int, samples: int) -> tuple[int, int]:
    """How many points of edges that a mirror shows are not drawn, and how many it shows."""
    scene, camera = mirror_scene(seed)
    room, random = Room(vp.Scene(scene.items[1:]), camera), np.random.default_rng(seed)
    drawing = drawn(scene, camera)
    strokes, items = strokes_of(drawing, "reflected")
    wrong = count = 0
    edges, shares = random.integers(0, len(room.edges), samples), random.uniform(0.01, 0.99, samples)
    for edge, share in zip(edges, shares, strict=True):
        a, b = room.edges[edge]
        shown = [by_mirror(seed, room, a + (share + step) * (b - a)) for step in (0.0, -BESIDE, BESIDE)]
        if any(place is None for place in shown):
            continue
        count += 1
        near = nearest(strokes[items == room.owner[edge] + 1], on_page(drawing, shown[0][None]))
        wrong += int(near[0] > OFF_MM)
    return wrong, count


def by_mirror(seed: int, room: Room, point: np.ndarray) -> np.ndarray | None:
    """Where the mirror shows a point, None where it does not."""
    eye = room.eye if not room.parallel else -1e4 * unit(room.way)
    to_eye = (eye if not room.parallel else point + eye) - point
    if np.isfinite(meeting(seed, point[None], to_eye[None])[0]):
        return None

    def on(x: np.ndarray) -> np.ndarray:
        if seed % 3 == 2:
            return np.array([0.9 * np.cos(x[0]), 0.9 * np.sin(x[0]), x[1]])
        radii = (1.3, 1.3, 1.3) if seed % 3 == 0 else (1.6, 1.0, 0.8)
        return np.array(radii) * np.array([np.cos(x[0]) * np.cos(x[1]), np.sin(x[0]) * np.cos(x[1]), np.sin(x[1])])

    middle = unit(unit(eye) + unit(point))
    start = np.array([np.arctan2(middle[1], middle[0]), middle[2] if seed % 3 == 2 else np.arcsin(middle[2])])
    place = on(way_of_light(lambda x: [eye, on(x), point], [1.0, 1.0], start))
    normal, one, two = unit(SHAPES[seed % 3][2](place)), unit(eye - place), unit(point - place)
    # Next to the outline of the mirror lines would be in it.
    if min(normal @ one, normal @ two) <= GRAZING / 2.0 or np.linalg.norm(np.cross(one + two, normal)) > 1e-4:
        return None
    if seed % 3 == 2 and abs(place[2]) > 1.49:
        return None
    ends = np.stack([eye if not room.parallel else place + 30.0 * one, point])
    clear = free(room, np.stack([place, place]), place + (1.0 - 1e-5) * (ends - place))
    return place if clear.all() else None


if __name__ == "__main__":
    for name in ("glass", "mirror"):
        missing, unfounded = (globals()[f"{which}_in_{name}"] for which in ("missing", "unfounded"))
        total = np.zeros(4, dtype=int)
        for seed in range(int(sys.argv[1])):
            row = (*missing(seed, 100), *unfounded(seed, 500))
            total += row
            if row[0] or row[2]:
                print(name, "seed", seed, row)
        print(f"{name}: {total[0]} of {total[1]} seen points not drawn; {total[2]} of {total[3]} drawn points not seen")
