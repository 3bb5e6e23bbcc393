"""Scenes with smooth surfaces, and what else their tests share."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vectorplot.curves.families import Circle
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.surfaces.function_surface import FunctionSurface, surface_of_function
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.minimal import helicoid_to_catenoid
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    Paraboloid,
    Sphere,
    implicit_ellipsoid,
    implicit_sphere,
)
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.swept import helical_surface
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus, dupin_cyclide
from vectorplot.testing.shapes import box, rotation

TURN = 2.0 * np.pi
LIGHT = (1.0, 2.0, 3.0)
COSINES = (-0.8, -0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6, 0.8)


def lit(*items: Item) -> Scene:
    """A scene in parallel light."""
    return Scene(items, lights=(Light(LIGHT, parallel=True),))


def ring(
    major: float = 3.0, minor: float = 1.0, columns: int = 24, rows: int = 12, isophotes=COSINES, **options
) -> Item:
    return Item("ring", Torus(major, minor, **options), curves=SurfaceLines(columns, rows, isophotes))


def bumpy_sphere() -> FunctionSurface:
    """A sphere with bumps that die out at the poles."""

    def points(u, v):
        r = 1.0 + 0.2 * np.cos(v) ** 2 * np.sin(4.0 * u) * np.cos(3.0 * v)
        return r * np.cos(v) * np.cos(u), r * np.cos(v) * np.sin(u), r * np.sin(v)

    return surface_of_function(points, Domain(0.0, TURN, -0.5 * np.pi, 0.5 * np.pi, closed_u=True))


def few(columns: int = 5, rows: int = 5) -> SurfaceLines:
    """Lines of each sort, so few that the points compared lie close together on them."""
    return SurfaceLines(columns, rows, (-0.5, 0.4))


def single_surfaces() -> dict[str, Scene]:
    """One surface each."""
    waves = graph(lambda x, y: 0.35 * np.sin(3.0 * x) * np.cos(2.5 * y), Domain(-2.0, 2.0, -2.0, 2.0))
    ripple = graph(lambda x, y: np.sinc(np.hypot(x, y) / np.pi) * 3.0, Domain(-9.0, 9.1, -9.0, 9.2))
    surfaces = {
        "torus": Torus(3.0, 1.0),
        "fat torus": Torus(3.0, 2.5),
        "sphere": Sphere(2.0),
        "ellipsoid": Ellipsoid((3.0, 2.0, 1.0)),
        "hyperbolic paraboloid": HyperbolicParaboloid(1.0, 1.0, 1.5, 1.2),
        "hyperboloid": Hyperboloid((1.0, 1.3, 1.0), -1.5, 2.0),
        "paraboloid": Paraboloid(1.0, 1.2, 2.0),
        "cylinder": Cylinder(1.0, -1.0, 1.5),
        "cone": Cone(0.7, -1.2, 1.6),
        "waves": waves,
        "ripple": ripple,
        "helical tube": helical_surface(Circle((2.0, 0.0, 0.0), 0.45, (0.0, 1.0, 0.3)), 0.25, end=2.7 * TURN),
        "bumpy sphere": bumpy_sphere(),
        "cyclide": dupin_cyclide(3.0, 1.0, (1.2, 0.7, 3.1), 4.0),
        "catenoid": helicoid_to_catenoid(0.5 * np.pi),
        "helicoid": helicoid_to_catenoid(0.4, width=1.2),
    }
    return {name: lit(Item(name, surface, curves=few())) for name, surface in surfaces.items()}


def implicit_surfaces() -> dict[str, Scene]:
    turned = rotation(np.random.default_rng(8))
    surfaces = {
        "implicit torus": ImplicitTorus(3.0, 1.0),
        "implicit ellipsoid": implicit_ellipsoid((3.0, 2.0, 1.0)),
        "implicit cyclide": ImplicitCyclide(3.0, 1.0, (1.2, 0.7, 3.1), 4.0),
        "placed implicit torus": PlacedImplicit(ImplicitTorus(3.0, 1.0), turned, (1.0, 2.0, 3.0)),
    }
    lines = SurfaceLines(isophotes=(-0.5, 0.4), sections=(Section((0.0, 0.3, 1.0), (-0.5, 0.1, 0.4)),))
    return {name: lit(Item(name, surface, curves=lines)) for name, surface in surfaces.items()}


def cage(half: float, thick: float) -> list[Item]:
    """The twelve bars along the edges of a cube."""
    items = []
    for axis in range(3):
        for bits in range(4):
            low = np.full(3, -half - thick)
            high = np.full(3, -half + thick)
            low[axis], high[axis] = -half - thick, half + thick
            for other, bit in zip([k for k in range(3) if k != axis], (bits & 1, bits >> 1), strict=True):
                low[other] += 2.0 * half * bit
                high[other] += 2.0 * half * bit
            items.append(Item(f"bar {axis}{bits}", box(low, high)))
    return items


def mixed_scenes() -> dict[str, Scene]:
    """Surfaces and polyhedra that hide and pierce each other."""
    upright = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    turned = rotation(np.random.default_rng(5))
    lines = few(6, 5)
    return {
        "linked tori": lit(
            Item("one", Torus(3.0, 0.8), curves=lines),
            Item("two", PlacedSurface(Torus(3.0, 0.7), upright, (3.0, 0.1, 0.2)), curves=lines),
        ),
        "torus and box": lit(
            Item("ring", Torus(3.0, 1.0), curves=lines), Item("box", box((1.3, -1.1, -0.45), (5.1, 0.9, 2.2)))
        ),
        "sphere in a cage": lit(Item("ball", Sphere(1.3), curves=lines), *cage(1.0, 0.12)),
        "spheres piercing": lit(
            Item("one", Sphere(1.5), curves=lines), Item("two", Sphere(1.2, (0.9, 0.7, 0.5)), curves=lines)
        ),
        "cylinders piercing": lit(
            Item("one", Cylinder(1.0, -2.0, 2.0), curves=lines),
            Item("two", PlacedSurface(Cylinder(0.7, -2.5, 2.1), upright, (0.2, 0.1, 0.1)), curves=lines),
        ),
        "sphere behind a wall": lit(
            Item("ball", Sphere(1.0), curves=lines), Item("wall", box((-2.0, -1.7, -0.3), (0.3, -1.5, 1.5)))
        ),
        "saddle through a torus": lit(
            Item("ring", PlacedSurface(Torus(2.0, 0.7), turned, (0.1, 0.2, 0.3)), curves=lines),
            Item("saddle", HyperbolicParaboloid(1.6, 1.3, 2.6, 2.4), curves=lines),
        ),
        "implicit ball in a torus": lit(
            Item("ring", Torus(2.0, 0.7), curves=lines),
            Item("ball", implicit_sphere(1.6, (0.3, 0.1, 0.2)), curves=SurfaceLines(isophotes=(0.1, 0.5))),
        ),
        "far behind": lit(
            Item("ring", Torus(2.0, 0.7), curves=lines),
            Item("plate", box((-4.0, 5.0, -3.0), (4.0, 5.2, 3.0))),
            Item("ball", Sphere(1.0, (0.5, 4.0, 0.3)), curves=lines),
            Item("glass", Sphere(0.8, (0.4, -3.0, 0.2)), curves=lines, occludes=False),
        ),
    }


def directions(count: int, seed: int = 0) -> np.ndarray:
    """(n,3) random unit vectors."""
    found = np.random.default_rng(seed).normal(size=(count, 3))
    return found / np.linalg.norm(found, axis=1)[:, None]


def views(scene: Scene, count: int, seed: int = 0) -> Iterator[Camera]:
    """Cameras from all around, central and parallel in turn, near and far."""
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    for k, direction in enumerate(directions(count, seed)):
        eye = middle + direction * size * (1.0 if k % 4 == 0 else 2.0)
        yield Camera(tuple(eye.tolist()), tuple(middle.tolist()), parallel=k % 2 == 1)


def special_views(scene: Scene) -> Iterator[Camera]:
    """Along the axes: views that are not generic for what is symmetric."""
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    for direction in (*np.eye(3), -np.eye(3)[0], (1.0, 1.0, 0.0), (0.0, 1.0, 1.0)):
        for parallel in (False, True):
            eye = middle + np.asarray(direction) * 2.0 * size
            yield Camera(tuple(eye.tolist()), tuple(middle.tolist()), parallel=parallel)
