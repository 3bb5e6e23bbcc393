"""The scenes that are timed: fixed ones, each in a few sizes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.families.ellipsoid import Sphere
from vectorplot.surfaces.families.torus import Torus
from vectorplot.testing.curved_meshes import bumpy_icosphere
from vectorplot.testing.shapes import box, rotated_boxes

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


def _lump_of(triangles: int) -> Scene:
    return lump(round(np.log2(triangles / 20.0) / 2.0))


_TRIANGLES = tuple(20 * 4**level for level in (5, 6, 7, 8))

_FROM_AFAR = {"camera": Camera(eye=(30.0, -20.0, 18.0), target=(5.0, 5.0, 5.0))}

SERIES = (
    Series("boxes", "draw", {}, boxes, (1000, 5000, 20000), "box"),
    Series("boxes, a layer each", "draw", {"layers": "object"}, boxes, (100, 300, 900), "box"),
    Series("bars", "draw", {}, bars, (300, 1000, 3000), "bar"),
    Series("weave", "draw", {}, weave, (2500, 14400, 90000), "crossing"),
    Series("one mesh", "draw", {"lines": "contour,crease"}, _lump_of, _TRIANGLES, "triangle"),
    Series("spheres", "draw", _FROM_AFAR, spheres, (500, 1500, 4500), "sphere"),
    Series("tori", "draw", {}, tori, (1, 2, 4), "torus"),
    Series("boxes in colour", "paint", {"shadows": "none"}, boxes, (200, 400, 800), "box"),
    Series("pixels of one mesh", "render", {"size": (400, 300)}, _lump_of, _TRIANGLES[:3], "triangle"),
)
