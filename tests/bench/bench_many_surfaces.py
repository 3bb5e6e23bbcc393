"""Many smooth surfaces in one scene: run with ``pytest tests/bench/bench_many_surfaces.py -s``."""

from __future__ import annotations

import cProfile
import pstats
import time
from collections.abc import Callable

import numpy as np
import pytest

from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import NO_LINES, SurfaceLines
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Hyperboloid
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.surfaces.tori import Torus

pytestmark = pytest.mark.bench

Make = Callable[[np.random.Generator], Surface]


def ring(rng: np.random.Generator) -> Surface:
    """A torus, whatever its tube."""
    return Torus(1.0, rng.uniform(0.2, 0.4))


def waist(rng: np.random.Generator) -> Surface:
    """A hyperboloid of one sheet."""
    return Hyperboloid((rng.uniform(0.3, 0.5), rng.uniform(0.3, 0.5), 0.6), -0.8, 0.8)


def wave(rng: np.random.Generator) -> Surface:
    """A function that is another one each time."""
    height = rng.uniform(0.2, 0.5)
    return surface_of_function(
        lambda u, v: (u, v, height * np.sin(3.0 * u) * np.cos(2.0 * v)), Domain(-1.0, 1.0, -1.0, 1.0)
    )


def heap(count: int, make: Make, lines: SurfaceLines = NO_LINES) -> tuple[Scene, Camera]:
    """Surfaces at random places, as close together however many there are, and a camera that sees them all."""
    rng = np.random.default_rng(0)
    side = 1.1 * (6.0 * count) ** (1.0 / 3.0)
    items = []
    for number in range(count):
        turned = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        placed = PlacedSurface(make(rng), turned * np.linalg.det(turned), rng.uniform(-side, side, 3))
        items.append(Item(str(number), placed, curves=lines))
    return Scene(tuple(items)), Camera((5.3 * side, -9.6 * side, 5.3 * side), (0.0, 0.0, 0.0))


def lattice(count: int) -> tuple[Scene, Camera]:
    """Tori turned at random that do not meet, and a camera that sees them all."""
    rng = np.random.default_rng(0)
    side = np.arange(int(np.ceil(count ** (1.0 / 3.0))))
    places = 3.0 * np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3)[:count]
    turned = [np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(count)]
    items = (PlacedSurface(ring(rng), turn, place) for turn, place in zip(turned, places, strict=True))
    far = 3.0 * len(side)
    return Scene(tuple(Item(str(k), item) for k, item in enumerate(items))), Camera((1.5 * far, -3.0 * far, 1.5 * far))


def seconds(scene: Scene, camera: Camera) -> float:
    """The shorter of two times, of the processor."""
    times = []
    for _ in range(2):
        start = time.process_time()
        draw(scene, camera)
        times.append(time.process_time() - start)
    return min(times)


def calls(scene: Scene, camera: Camera, verb: Callable[[Scene, Camera], Drawing] = draw) -> int:
    """How many functions are called."""
    profile = cProfile.Profile()
    profile.runcall(verb, scene, camera)
    return int(pstats.Stats(profile).total_calls)  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("name", "make", "lines", "counts", "most_calls"),
    [
        ("tori", ring, NO_LINES, (10, 30, 100), 60_000),
        ("tori, 24x12 lines", ring, SurfaceLines(24, 12), (10, 30), 75_000),
        ("hyperboloids", waist, NO_LINES, (10, 30, 100), 45_000),
        ("users' functions", wave, NO_LINES, (5, 15, 50), 320_000),
    ],
    ids=["tori", "lines", "hyperboloids", "functions"],
)
def test_cost_grows_with_the_number_of_surfaces(
    name: str, make: Make, lines: SurfaceLines, counts: tuple[int, ...], most_calls: int
) -> None:
    """In proportion, pairs that meet included; and each surface costs so many calls at most."""
    print(f"\n{name}")
    times = []
    draw(*heap(1, make, lines))
    for count in counts:
        scene, camera = heap(count, make, lines)
        times.append(seconds(scene, camera))
        print(f"  {count:>5}: {times[-1]:6.2f} s, {1e3 * times[-1] / count:5.1f} ms each")
    each = calls(*heap(counts[0], make, lines)) / counts[0]
    exponent = float(np.log(times[-1] / times[0]) / np.log(counts[-1] / counts[0]))
    print(f"  exponent {exponent:.2f}, {each:,.0f} calls a surface")
    assert exponent < 1.15
    assert each < most_calls


def test_surfaces_that_do_not_meet_are_traced_as_one() -> None:
    """Each more of them costs next to no calls: contours, cusps and sight lines are those of all at once."""
    few, many = (calls(*lattice(count)) for count in (8, 64))
    times = [seconds(*lattice(count)) for count in (8, 64)]
    exponent = float(np.log(times[1] / times[0]) / np.log(8.0))
    print(f"\ntori apart\n  8: {times[0]:.2f} s, 64: {times[1]:.2f} s, exponent {exponent:.2f}")
    print(f"  {(many - few) / 56:,.0f} calls for one more")
    assert exponent < 1.15
    assert (many - few) / 56 < 6_000


def test_surfaces_that_meet_are_intersected_as_one() -> None:
    """Each more of a heap costs few calls: the pairs are looked at together, whatever the number."""
    few, many = (calls(*heap(count, ring)) for count in (10, 60))
    print(f"\ntori in a heap\n  {(many - few) / 50:,.0f} calls for one more")
    assert (many - few) / 50 < 20_000


def test_surfaces_are_faceted_as_one() -> None:
    """Each more of a painted heap costs few calls: the triangles of all of them are divided together."""
    # What is loaded once does not count.
    few, many = [calls(*heap(count, ring), paint) for count in (8, 8, 24)][1:]
    print(f"\npainted tori in a heap\n  {(many - few) / 16:,.0f} calls for one more")
    assert (many - few) / 16 < 30_000
