"""Shadow polygons: run with ``pytest tests/bench/bench_shadows.py -s``."""

from __future__ import annotations

import time

import numpy as np
import pytest

from vectorplot.effects.decals import Decals
from vectorplot.effects.shadows import shadow_decals
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box, bumpy_icosphere, numbered, rotated_boxes, rotation, torus_mesh

pytestmark = pytest.mark.bench

SUN = Light((1.0, -0.4, 2.0), parallel=True)


def view_of(scene: Scene) -> View:
    size = float(np.ptp(scene.bounds, axis=0).max())
    middle = scene.bounds.mean(axis=0)
    return look(scene, Camera(tuple(middle + size * np.array([3.0, 2.0, 1.5])), tuple(middle)))


def best(view: View, *lights: Light, times: int = 3) -> tuple[float, Decals]:
    """Seconds of the fastest of several runs, and the shadows."""
    seconds = []
    for _ in range(times):
        start = time.process_time()
        decals = shadow_decals(view, lights)
        seconds.append(time.process_time() - start)
    return min(seconds), decals


def crowd(count: int) -> Scene:
    """Boxes at random places of a room of one size, so that many overlap for the light."""
    random = np.random.default_rng(0)
    boxes = []
    for _ in range(count):
        half, place = random.uniform(0.15, 0.6, 3), np.eye(4)
        place[:3, :3], place[:3, 3] = rotation(random), random.uniform(-8.0, 8.0, 3)
        boxes.append(box(-half, half).transformed(place))
    return numbered(boxes)


def test_solids_under_one_light() -> None:
    print("\n                       solids   shadows  seconds")
    times, shadows = {}, {}
    for count in (1250, 5000, 20000):
        times[count], decals = best(view_of(rotated_boxes(count, 1)), SUN)
        shadows[count] = len(decals)
        print(f"apart, parallel light  {count:6d} {len(decals):9d}  {times[count]:7.2f}")
    view = view_of(rotated_boxes(5000, 1))
    for name, light in (("lamp outside", Light((60.0, 25.0, 90.0))), ("lamp in the midst", Light((0.0, 0.0, 0.0)))):
        seconds, decals = best(view, light)
        print(f"{name:21s}  {5000:6d} {len(decals):9d}  {seconds:7.2f}")
    crowded, decals = best(view_of(crowd(5000)), SUN)
    print(f"crowded                {5000:6d} {len(decals):9d}  {crowded:7.2f}")
    # The deeper the crowd, the more shadows fall on each solid: their number grows faster than that of the solids.
    exponent = np.log(times[20000] / times[1250]) / np.log(shadows[20000] / shadows[1250])
    print(f"exponent over the number of shadows {exponent:.2f}")
    assert times[5000] < 1.5 and exponent < 1.3


def test_several_lights() -> None:
    view = view_of(rotated_boxes(5000, 1))
    lights = (SUN, Light((60.0, 25.0, 90.0)), Light((0.0, 0.5, 1.0), parallel=True))
    print("\nlights  shadows of grade 1, 2, 3   seconds")
    for count in (1, 2, 3):
        seconds, decals = best(view, *lights[:count], times=1)
        print(f"{count:6d}  {np.bincount(decals.grade)[1:].tolist()}  {seconds:.2f}")


def test_meshes_that_shadow_themselves() -> None:
    print("\n                 faces   shadows  seconds")
    times = []
    for level in (5, 6, 7):
        ball: Mesh = bumpy_icosphere(level)
        view = view_of(numbered([ball, box((-4, -4, -3), (4, 4, -2.5))]))
        seconds, decals = best(view, SUN, times=2)
        times.append(seconds)
        print(f"bumpy sphere  {view.face_count:8d} {len(decals):9d}  {seconds:7.2f}")
    exponent = np.log(times[-1] / times[0]) / np.log(16.0)
    print(f"exponent {exponent:.2f}")
    assert exponent < 1.3


def lattice(side: int, mesh: Mesh) -> Scene:
    """Meshes in rows, columns and layers, so that they hide each other from the light and from the eye."""
    places = np.stack(np.meshgrid(*(np.arange(side),) * 3), axis=-1).reshape(-1, 3)
    return numbered([Mesh(mesh.vertices + 3.0 * place, mesh.corners, mesh.offsets) for place in places])


def test_bodies_of_many_faces_in_a_heap() -> None:
    print("\n                 faces   shadows  seconds   times the bare cost")
    for name, mesh in (("balls", bumpy_icosphere(4, 0.0)), ("rings", torus_mesh(96, 32, 0.9, 0.4))):
        ratios = []
        for side in (3, 5):
            scene = lattice(side, mesh)
            view = view_of(scene)
            start = time.process_time()
            np.argsort(view_of(scene).depth)
            bare = time.process_time() - start
            seconds, decals = best(view, SUN, times=2)
            ratios.append(seconds / bare)
            print(f"{name:13s} {view.face_count:8d} {len(decals):9d}  {seconds:7.2f} {ratios[-1]:9.1f}")
        assert ratios[1] < 4.0 * ratios[0]
