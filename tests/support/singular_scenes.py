"""Surfaces with apexes, poles, cusps, pinch points, cuspidal edges and double lines, and lines through these places."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.curves.families import Line
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.implicit import implicit_of_function
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.quadrics import Cone, Sphere
from vectorplot.surfaces.surface import Domain, ImplicitSurface, Surface, is_implicit
from vectorplot.surfaces.tori import Torus

Points = tuple[tuple[float, float, float], ...]

ALONG_AXES: Points = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Singular:
    """A surface, some of its singular places, and directions in which lines through them are special."""

    surface: Surface | ImplicitSurface
    places: Points
    directions: Points = ALONG_AXES


def _revolved(meridian: np.ufunc, start: float, end: float) -> Surface:
    """The surface that a curve (r, z)(v) sweeps about z."""

    def points(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
        r, z = meridian(v)
        return r * np.cos(u), r * np.sin(u), z

    return surface_of_function(points, Domain(0.0, 2.0 * np.pi, start, end, closed_u=True))


def _developable(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
    """Tangents of a helix."""
    return np.cos(u) - v * np.sin(u), np.sin(u) + v * np.cos(u), 0.5 * (u + v)


def singular_surfaces() -> dict[str, Singular]:
    """The surfaces by name."""
    box = ((-1.2, -1.2, -1.2), (1.2, 1.2, 1.2))
    square = Domain(-1.0, 1.0, -1.0, 1.0)
    rim = [(float(np.cos(a)), float(np.sin(a)), 0.5 * a) for a in (-1.3, 0.4, 2.0)]
    return {
        "cone": Singular(Cone.standing(2.0, 4.0), ((0, 0, 4),)),
        "both halves of a cone": Singular(Cone(0.5, -1.0, 1.5), ((0, 0, 0),)),
        "sphere": Singular(Sphere(1.0), ((0, 0, 1), (0, 0, -1))),
        "spindle torus": Singular(Torus(0.6, 1.0), ((0, 0, 0.8), (0, 0, -0.8))),
        "double cone": Singular(_revolved(lambda v: (v, 1.3 * v), -1.0, 1.0), ((0, 0, 0),)),
        "lemon": Singular(_revolved(lambda v: (np.cos(v) - 0.3, np.sin(v)), -1.25, 1.25), ((0, 0, np.sqrt(0.91)),)),
        "drop": Singular(_revolved(lambda v: (v * v * (1.2 - v), v), 0.0, 1.2), ((0, 0, 0), (0, 0, 1.2))),
        "cuspidal ring": Singular(
            _revolved(lambda v: (1.0 + v * v, v**3), -0.8, 0.8), ((1, 0, 0), (0, -1, 0), (0.6, 0.8, 0))
        ),
        "cusp of revolution": Singular(_revolved(lambda v: (v**3, v * v), 0.0, 1.0), ((0, 0, 0),)),
        "cuspidal edge": Singular(
            surface_of_function(lambda u, v: (u, v * v, v**3), square), ((0, 0, 0), (0.37, 0, 0), (-0.6, 0, 0))
        ),
        "tangents of a helix": Singular(
            surface_of_function(_developable, Domain(-2.5, 2.5, -1.0, 1.0)), tuple(rim), ((0, 0, 1), (-0.8, 0.6, 0.5))
        ),
        "swallowtail": Singular(
            surface_of_function(lambda u, v: (u, 4 * v**3 + 2 * u * v, -3 * v**4 - u * v * v), square),
            ((0, 0, 0), (-0.5, 0, 1 / 12), (-0.6, 0, 0.12)),
        ),
        "Whitney umbrella": Singular(
            surface_of_function(lambda u, v: (u * v, u, v * v), square), ((0, 0, 0), (0, 0, 0.3), (0, 0, 0.7))
        ),
        "crossed cap": Singular(
            surface_of_function(
                lambda u, v: (
                    np.sin(u) * np.sin(2 * v) / 2,
                    np.sin(2 * u) * np.cos(v) ** 2,
                    np.cos(2 * u) * np.cos(v) ** 2,
                ),
                Domain(0.0, np.pi, -np.pi / 2, np.pi / 2),
            ),
            ((0, 0, 1), (0, 0, 0), (0, 0, -1)),
        ),
        "implicit cone": Singular(implicit_of_function(lambda x, y, z: x * x + y * y - z * z, box), ((0, 0, 0),)),
        "implicit umbrella": Singular(
            implicit_of_function(lambda x, y, z: x * x - y * y * z, box), ((0, 0, 0), (0, 0, 0.4))
        ),
        "two planes": Singular(
            implicit_of_function(lambda x, y, z: (x + 0.3 * z) * (y - 0.2 * z), box), ((0, 0, 0), (-0.15, 0.1, 0.5))
        ),
        "ding-dong": Singular(
            implicit_of_function(lambda x, y, z: x * x + y * y - (1 - z) * z * z, box), ((0, 0, 0), (0, 0, 1))
        ),
        "Cayley": Singular(
            implicit_of_function(
                lambda x, y, z: 4 * (x**2 + y**2 + z**2) + 16 * x * y * z - 1, ((-0.9,) * 3, (0.9,) * 3), degree=3
            ),
            ((-0.5, -0.5, -0.5), (-0.5, 0.5, 0.5), (0.5, -0.5, 0.5), (0.5, 0.5, -0.5)),
        ),
        "implicit cuspidal edge": Singular(
            implicit_of_function(lambda x, y, z: y**3 - z**2, box), ((0, 0, 0), (0.4, 0, 0))
        ),
    }


def lines_through(name: str, one: Singular, count: int, seed: int) -> Scene:
    """The surface, and lines through its singular places: in special directions and random ones, both ends free or one
    end in the place, not in its middle."""
    random = np.random.default_rng(seed)
    bounds = Scene((Item(name, one.surface),)).bounds
    size = 0.6 * float((bounds[1] - bounds[0]).max())
    ways = [np.array(way) for way in one.directions]
    ways += [random.normal(size=3) for _ in range(max(count - len(ways), 0))]
    items = []
    for number, way in enumerate(ways[:count]):
        place = np.array(one.places[(number + seed) % len(one.places)])
        way = way / np.linalg.norm(way) * size
        before, after = random.uniform(0.3, 1.1, 2)
        if number % 5 == 4:
            before = 0.0
        items.append(Item(f"L{number}", Line(place, way, -before, after)))
    return Scene((Item(name, one.surface), *items))


def turned(scene: Scene, matrix: np.ndarray, shift: np.ndarray) -> Scene:
    """The scene with its points x at x @ matrix + shift."""
    items = []
    for item in scene.items:
        shape = item.shape
        if isinstance(shape, Line):
            point, end = (np.asarray(p) @ matrix + shift for p in (shape.point, np.add(shape.point, shape.direction)))
            items.append(replace(item, shape=Line(point, end - point, shape.start, shape.end)))
        elif is_implicit(shape):
            items.append(replace(item, shape=PlacedImplicit(shape, matrix, shift)))
        else:
            items.append(replace(item, shape=PlacedSurface(shape, matrix, shift)))
    return Scene(tuple(items))


def eyes(scene: Scene, count: int, seed: int) -> list[Camera]:
    """Cameras around a scene, central and parallel in turn."""
    random = np.random.default_rng(1000 + seed)
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float((high - low).max())
    found = []
    for number in range(count):
        way = random.normal(size=3)
        eye = middle + way / np.linalg.norm(way) * size * random.uniform(1.2, 4.0)
        found.append(Camera(tuple(eye.tolist()), tuple(middle.tolist()), parallel=bool(number % 2)))
    return found
