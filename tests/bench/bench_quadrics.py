"""Many spheres and capped bodies from a scene to a drawing: run with ``pytest tests/bench/bench_quadrics.py -s``."""

from __future__ import annotations

import cProfile
import pstats

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.pictures.pipeline import StageReport
from vectorplot.scene.added_lines import even_sections, with_lines
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import NO_LINES, SurfaceLines, even_cosines
from vectorplot.speed.results import cpu_seconds
from vectorplot.surfaces.capped_bodies import Capped, rod
from vectorplot.surfaces.quadrics import Cone, Cylinder, Sphere
from vectorplot.testing.shapes import box

pytestmark = pytest.mark.bench

CAMERA = Camera(eye=(30.0, -20.0, 18.0), target=(5.0, 5.0, 5.0))


def heap(count: int, lines: SurfaceLines = NO_LINES) -> Scene:
    """Spheres at random, one in two of which pierces another."""
    rng = np.random.default_rng(3)
    centres = rng.uniform(0.0, 10.0, (count, 3))
    radii = rng.uniform(0.1, 0.35, count) * (1000.0 / count) ** (1.0 / 3.0)
    pairs = zip(centres.tolist(), radii.tolist(), strict=True)
    return Scene(tuple(Item(str(k), Sphere(r, c), curves=lines) for k, (c, r) in enumerate(pairs)))


def protein(count: int) -> Scene:
    """Atoms packed as in a protein: each meets about ten others."""
    rng = np.random.default_rng(3)
    side = np.arange(int(np.ceil((2.0 * count) ** (1.0 / 3.0))))
    places = np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3) * 2.65
    places = places - places.mean(axis=0) + rng.normal(size=places.shape) * 0.5
    places = places[np.argsort((places**2).sum(axis=1))[:count]] * (10.0 / 60.0) + 5.0
    radii = rng.choice([1.52, 1.55, 1.7, 1.7, 1.8], count) * (10.0 / 60.0)
    pairs = zip(places.tolist(), radii.tolist(), strict=True)
    return Scene(tuple(Item(str(k), Sphere(r, c)) for k, (c, r) in enumerate(pairs)))


def forest(count: int) -> Scene:
    """Cylinders and cones that stand on a ground."""
    rng = np.random.default_rng(3)
    side = int(np.ceil(np.sqrt(count)))
    step = 10.0 / side
    items = [Item("ground", box((-1.0, -1.0, -0.1), (11.0, 11.0, 0.0)))]
    for number in range(count):
        place = (*(step * (np.array(divmod(number, side)) + rng.uniform(-0.2, 0.2, 2))).tolist(), 0.0)
        height, radius = step * rng.uniform(0.3, 1.5), step * rng.uniform(0.1, 0.27)
        round_ = Cylinder(radius, 0.0, height, place) if number % 2 else Cone.standing(radius, height, place)
        items.append(Item(str(number), Capped(round_)))
    return Scene(tuple(items))


def molecule(count: int) -> Scene:
    """Atoms as balls, and bonds from the middle of one to that of the next, five for every four atoms."""
    rng = np.random.default_rng(5)
    side = int(np.ceil(count ** (1.0 / 3.0)))
    cells = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)[:count]
    number = np.full((side + 1,) * 3, -1)
    number[tuple(cells.T)] = np.arange(count)
    places = (cells + rng.uniform(-0.07, 0.07, (count, 3))) * (10.0 / side)
    radii = rng.uniform(0.2, 0.3, count) * (10.0 / side)
    ways = [np.stack([np.arange(count), number[tuple((cells + way).T)]]) for way in np.eye(3, dtype=int)]
    pairs = np.concatenate(ways, axis=1)
    bonds = rng.permutation(pairs[:, pairs[1] >= 0], axis=1)[:, : 5 * count // 4]
    items = [Item(f"atom {k}", Sphere(float(r), p)) for k, (p, r) in enumerate(zip(places, radii, strict=True))]
    for one, two in bonds.T.tolist():
        items.append(Item(f"bond {one} {two}", rod(places[one], places[two], 0.6 / side)))
    return Scene(tuple(items))


def bare(scene: Scene) -> float:
    """What projecting 32 points of each sphere and sorting them by depth takes."""
    centres = np.array([0.5 * smooth_bounds(item.shape).sum(axis=0) for item in scene.items if item.name != "ground"])
    around = np.random.default_rng(1).normal(size=(32, 1, 3))

    def project() -> None:
        points = (centres + around).reshape(-1, 3) - np.array(CAMERA.eye)
        image = points[:, :2] / points[:, 2:]
        np.argsort(points[:, 2] + 0.0 * image[:, 0], kind="stable")

    return cpu_seconds(project, 5)


def measured(name: str, scenes: dict[int, Scene]) -> float:
    """The growth exponent at the end of a row of scenes."""
    print(f"\n{name}")
    times = []
    for count, scene in scenes.items():
        draw(scene, CAMERA)
        times.append(cpu_seconds(lambda s=scene: draw(s, CAMERA)))
        print(f"  {count:>7,}: {times[-1]:6.3f} s, {times[-1] / bare(scene):5.0f} times projecting 32 points each")
    sizes = list(scenes)
    return float(np.log(times[-1] / times[-2]) / np.log(sizes[-1] / sizes[-2]))


def test_contours_and_circles_of_many_spheres() -> None:
    exponent = measured("spheres", {count: heap(count) for count in (100, 1000, 10000)})
    print(f"  growth exponent {exponent:.2f}")
    stages: list[StageReport] = []
    draw(heap(10000), CAMERA, explain=stages.append)
    print("  " + ", ".join(f"{stage.name} {stage.seconds:.3f}" for stage in stages))
    assert exponent < 1.2


def test_twelve_meridians_each() -> None:
    lines = SurfaceLines(columns=12)
    exponent = measured("spheres with 12 meridians", {count: heap(count, lines) for count in (100, 1000, 4000)})
    print(f"  growth exponent {exponent:.2f}")
    assert exponent < 1.2


def test_a_protein() -> None:
    exponent = measured("atoms that pierce each other", {count: protein(count) for count in (500, 5000)})
    print(f"  growth exponent {exponent:.2f}")
    assert exponent < 1.2


def test_a_forest_on_a_ground() -> None:
    exponent = measured("cones and cylinders on a ground", {count: forest(count) for count in (250, 1000, 4000)})
    print(f"  growth exponent {exponent:.2f}")
    assert exponent < 1.2


def test_balls_on_sticks() -> None:
    exponent = measured("atoms with bonds from middle to middle", {count: molecule(count) for count in (500, 2000)})
    print(f"  growth exponent {exponent:.2f}")
    assert exponent < 1.2


def topological_order(count: int) -> Scene:
    """Rods that lie across each other, as dense whatever their number."""
    rng = np.random.default_rng(1)
    middles = rng.uniform(0.0, 1.6 * count ** (1.0 / 3.0), (count, 3))
    ways = rng.normal(size=(count, 3))
    ways *= 2.0 / np.linalg.norm(ways, axis=1, keepdims=True)
    rods = [rod(middle - way, middle + way, 0.15) for middle, way in zip(middles, ways, strict=True)]
    return Scene(tuple(Item(str(k), shape) for k, shape in enumerate(rods)))


def calls(scene: Scene) -> int:
    """How many functions are called, on one thread."""
    draw(scene, CAMERA)
    profile = cProfile.Profile()
    profile.runcall(draw, scene, CAMERA, jobs=1)
    return int(pstats.Stats(profile).total_calls)  # type: ignore[attr-defined]


def test_rods_across_each_other() -> None:
    """Every pair has its curve, found with those of the others in whole arrays."""
    exponent = measured("rods across each other", {count: topological_order(count) for count in (400, 1600)})
    more = calls(topological_order(400)) - calls(topological_order(100))
    print(f"  growth exponent {exponent:.2f}, {more / 300:,.0f} calls for each more")
    assert exponent < 1.2
    assert more < 300 * 600


def test_sections_and_isophotes_of_balls_on_sticks() -> None:
    """Each line costs little beside the bodies: they stay what they are."""
    plain = molecule(200)
    lit = with_lines(plain, isophotes=even_cosines(9))
    lined = with_lines(plain, sections=(even_sections(plain, (0.3, 0.2, 1.0), 20),))
    times = [cpu_seconds(lambda s=scene: draw(s, CAMERA)) for scene in (plain, lined, lit)]
    print("\n200 atoms with bonds: plain, 20 sections, 9 isophotes\n  " + ", ".join(f"{t:.3f} s" for t in times))
    assert max(times) < 5.0 * times[0]
    exponent = measured(
        "atoms with bonds, 9 isophotes", {k: with_lines(molecule(k), isophotes=even_cosines(9)) for k in (250, 1000)}
    )
    assert exponent < 1.2
