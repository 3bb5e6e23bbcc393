"""The scenes whose drawing is timed, and the measuring of them and of bare operations."""

from __future__ import annotations

import math
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import threads_of, unheard
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.io.molecules import Molecule, molecule_scene
from vectorplot.pictures.draw import draw
from vectorplot.pictures.paint import paint
from vectorplot.pictures.pipeline import StageReport
from vectorplot.pictures.render import render
from vectorplot.save import write
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.shading.image import Image
from vectorplot.speed.results import (
    Log,
    Measured,
    Threads,
    array_operations,
    call_operations,
    cpu_seconds,
    peak_of,
    point_cost,
    wall_seconds,
)
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import box, bumpy_icosphere, grid_graph, rotated_boxes

# The scenes that are timed: fixed ones, each in a few sizes.

LAMP = Light((9.0, -7.0, 12.0))


@dataclass(frozen=True)
class Series:
    """Pictures of one kind in growing sizes: name; verb, draw, paint or render, with its options; scene (k): the scene
    of size k, and sizes; thing: what a size counts."""

    name: str
    verb: str
    options: dict[str, Any]
    scene: Callable[[int], Scene]
    sizes: tuple[int, ...]
    thing: str


def bars(count: int) -> Scene:
    """Long thin bars at random, each of them near as many others whatever their number."""
    rng = np.random.default_rng(1)
    size = (1000.0 / count) ** (1.0 / 3.0)
    bar = box((-0.01 * size, -0.01 * size, -2.0 * size), (0.01 * size, 0.01 * size, 2.0 * size))
    centres, axes = rng.uniform(0.0, 10.0, (count, 3)), rng.normal(size=(count, 3))
    places = enumerate(zip(centres, axes, strict=True))
    shapes = (
        (k, Mesh(matmul(bar.vertices, axis_frame(axis)) + c, bar.corners, bar.offsets)) for k, (c, axis) in places
    )
    return Scene(tuple(Item(f"bar {k}", shape) for k, shape in shapes))


def weave(crossings: int) -> Scene:
    """Bars along and across that pierce each other at so many crossings."""
    side = round(crossings**0.5)
    items = []
    for k in range(side):
        height = 0.3 * (k % 2)
        items.append(Item(f"along {k}", box((0.0, k, height), (side, k + 0.6, height + 0.2))))
        items.append(Item(f"across {k}", box((k, 0.0, height + 0.15), (k + 0.6, side, height + 0.35))))
    return Scene(tuple(items))


def spheres(count: int) -> Scene:
    """Spheres at random, one in two of which pierces another."""
    rng = np.random.default_rng(3)
    centres, radii = rng.uniform(0.0, 10.0, (count, 3)), rng.uniform(0.1, 0.35, count)
    pairs = zip(centres.tolist(), (radii * (1000.0 / count) ** (1.0 / 3.0)).tolist(), strict=True)
    return Scene(tuple(Item(f"sphere {k}", Sphere(r, c)) for k, (c, r) in enumerate(pairs)))


def tori(count: int) -> Scene:
    """Tori in a row, each behind a part of the next one."""
    return Scene(tuple(Item(f"torus {k}", Torus(2.0, 0.7, (3.5 * k, 0.8 * k, 0.0))) for k in range(count)))


def boxes(count: int) -> Scene:
    """Turned boxes at random under a lamp."""
    return Scene(rotated_boxes(count).items, lights=(LAMP,))


def lump(level: int) -> Scene:
    """A bumpy sphere of 20 * 4^level triangles."""
    return Scene((Item("lump", bumpy_icosphere(level)),), lights=(LAMP,))


def _halvings(triangles: int) -> int:
    return round(math.log2(triangles / 20.0) / 2.0)


def _lump_of(triangles: int) -> Scene:
    return lump(_halvings(triangles))


def balls(count: int) -> Scene:
    """Balls side by side on a floor under a lamp."""
    rng = np.random.default_rng(3)
    side = 1.2 * count**0.5
    radii = rng.uniform(0.2, 0.5, count).tolist()
    places = zip(rng.uniform(0.0, side, (count, 2)).tolist(), radii, strict=True)
    items = (Item(f"ball {k}", Sphere(r, (x, y, r))) for k, ((x, y), r) in enumerate(places))
    floor = Item("floor", box((-1.0, -1.0, -0.1), (side + 1.0, side + 1.0, 0.0)))
    return Scene((floor, *items), lights=(Light((0.6 * side, -0.8 * side, 1.5 * side)),))


def lattice(count: int) -> Scene:
    """So many atoms of two kinds in a cube, each bonded to its neighbours."""
    side = round(count ** (1.0 / 3.0))
    number = np.arange(side**3).reshape(side, side, side)
    ways = (np.moveaxis(number, axis, 0) for axis in range(3))
    bonds = np.concatenate([np.stack([way[:-1].ravel(), way[1:].ravel()], axis=1) for way in ways])
    places = np.stack(np.unravel_index(number.ravel(), number.shape), axis=1)
    symbols = tuple(np.where(places.sum(axis=1) % 2, "Cl", "Na").tolist())
    return molecule_scene(Molecule("lattice", symbols, 2.8 * places.astype(np.float64), bonds))


def rough(triangles: int) -> Scene:
    """A ball of so many triangles, each turned its own way, under a lamp."""
    mesh = bumpy_icosphere(_halvings(triangles))
    noise = np.random.default_rng(0).normal(1.0, 0.5 / triangles**0.5, (len(mesh.vertices), 1))
    return Scene((Item("lump", Mesh(noise * mesh.vertices, mesh.corners, mesh.offsets)),), lights=(LAMP,))


def terrain(triangles: int) -> Scene:
    """The graph of a function under a lamp."""
    return Scene((Item("terrain", grid_graph(round((triangles / 2.0) ** 0.5))),), lights=(LAMP,))


def heap(count: int) -> Scene:
    """Tori in a heap under a lamp, some of which meet."""
    centres = np.random.default_rng(5).uniform(0.0, 2.6 * count ** (1.0 / 3.0), (count, 3)).tolist()
    return Scene(tuple(Item(f"torus {k}", Torus(1.0, 0.35, place)) for k, place in enumerate(centres)), lights=(LAMP,))


_TRIANGLES = tuple(20 * 4**level for level in (5, 6, 7, 8))

_HATCHED = {"lines": "contour", "hatch": Hatching("tone")}

_FROM_AFAR = {"camera": Camera(eye=(30.0, -20.0, 18.0), target=(5.0, 5.0, 5.0))}

SERIES = (
    Series("boxes", "draw", {}, boxes, (1000, 5000, 20000), "box"),
    Series("boxes, a layer each", "draw", {"layers": "object"}, boxes, (100, 300, 900), "box"),
    Series("bars", "draw", {}, bars, (300, 1000, 3000), "bar"),
    Series("weave", "draw", {}, weave, (2500, 14400, 90000), "crossing"),
    Series("one mesh", "draw", {"lines": "contour,crease"}, _lump_of, _TRIANGLES, "triangle"),
    Series("hatched mesh", "draw", _HATCHED, _lump_of, _TRIANGLES[:3], "triangle"),
    Series("spheres", "draw", _FROM_AFAR, spheres, (500, 1500, 4500), "sphere"),
    Series("tori", "draw", {}, tori, (1, 2, 4), "torus"),
    Series("boxes in colour", "paint", {"shadows": "none"}, boxes, (200, 400, 800), "box"),
    Series("pixels of one mesh", "render", {"size": (400, 300)}, _lump_of, _TRIANGLES[:3], "triangle"),
    Series("balls in colour", "paint", {}, balls, (10, 100, 1000), "ball"),
    Series("molecule in colour", "paint", {}, lattice, (27, 125, 1000), "atom"),
    Series("tori in colour", "paint", {}, heap, (1, 5, 25), "torus"),
    Series("rough mesh in colour", "paint", {}, rough, _TRIANGLES[:2], "triangle"),
    Series("terrain in colour", "paint", {}, terrain, (5000, 20000, 80000), "triangle"),
    Series("pixels of spheres", "render", {"size": (400, 300)} | _FROM_AFAR, spheres, (20, 320, 5120), "sphere"),
    Series("pixels of a molecule", "render", {"size": (400, 300)}, lattice, (27, 125, 1000), "atom"),
)


VERBS: dict[str, Callable[..., Drawing | Image]] = {"draw": draw, "paint": paint, "render": render}

LONG = 0.5
"""What takes so many seconds is timed once, after it was made once untimed; what is shorter a few times."""

THREADED = ("boxes", "weave", "one mesh")
"""The pictures that are made on one thread and on several."""


def measured(series: Series, repeat: int = 2, largest: int | None = None) -> Measured:
    """What the pictures of a series cost on one thread, the shortest of some times each; largest: of its sizes no
    larger one is tried."""
    verb, times = VERBS[series.verb], []
    sizes = tuple(size for size in series.sizes if largest is None or size <= largest)
    stages: list[StageReport] = []
    memory = 0.0
    for size in sizes:
        made = partial(verb, series.scene(size), jobs=1, **series.options)
        memory = peak_of(made)
        stages = []
        once = cpu_seconds(partial(made, explain=stages.append), 1)
        once -= sum(stage.seconds for stage in stages if stage.error is not None)
        stages = [stage for stage in stages if stage.error is None]
        times.append(once if once > LONG else min(once, cpu_seconds(made, repeat)))
    whole = sum(stage.seconds for stage in stages) or 1.0
    parts = tuple((stage.name, stage.seconds / whole) for stage in stages)
    picture = made()
    contents = picture.png() if isinstance(picture, Image) else write(picture, "svg")
    return Measured(series.name, series.verb, series.thing, sizes, tuple(times), parts, memory, len(contents) / 1e6)


def on_threads(series: Series, count: int) -> Threads:
    """The largest picture of a series on one thread and on so many."""
    made = partial(VERBS[series.verb], series.scene(series.sizes[-1]), **series.options)
    one, several = (wall_seconds(partial(made, jobs=jobs), 1) for jobs in (1, count))
    return Threads(series.name, series.sizes[-1], count, one, several)


def measure(only: Sequence[str] = (), progress: Callable[[str, float], None] | None = None) -> Log:
    """All that is measured; only: the names of the series, all where it is empty; progress(name, part) is called while
    it works."""
    told = progress or (lambda name, part: unheard(part))
    chosen = [series for series in SERIES if not only or series.name in only]
    count = threads_of(None)
    threaded = [series for series in chosen if series.name in THREADED] if count > 1 else []
    steps = len(chosen) + len(threaded) + 1
    told("operations", 0.0)
    arrays, calls, point = array_operations(), call_operations(), point_cost()
    pictures, threads = [], []
    for number, series in enumerate(chosen):
        told(series.name, (number + 1) / steps)
        pictures.append(measured(series))
    for number, series in enumerate(threaded):
        told(f"{series.name} on {count} threads", (len(chosen) + number + 1) / steps)
        threads.append(on_threads(series, count))
    return Log(_machine(count), arrays, calls, point, tuple(pictures), tuple(threads))


def _machine(threads: int) -> str:
    python = f"Python {platform.python_version()}, numpy {np.__version__}"
    return f"{platform.system()} {platform.machine()}, {threads} processors, {python}"
