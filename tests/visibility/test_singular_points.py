"""Lines through singular points of surfaces against rays: from every eye, wherever the scene is, whatever its size."""

from __future__ import annotations

import warnings
from functools import cache

import numpy as np
import pytest
from support.dense_rays import DenseRays
from support.drawn import drawn
from support.effort import several
from support.singular_scenes import eyes, lines_through, singular_surfaces, turned
from support.smooth_seen import chords_seen

from vectorplot.curves.families import Line
from vectorplot.errors import InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.quadrics import Cone
from vectorplot.words import LineKind

SURFACES = singular_surfaces()


@cache
def rays_of(name: str) -> DenseRays:
    return DenseRays(SURFACES[name].surface)


def compared(rays: DenseRays, scene: Scene, camera: Camera, samples: int) -> int:
    """How many points of curves agree with rays; an AssertionError where some do not."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        chords = chords_seen(scene, camera, kinds=frozenset({LineKind.CURVE}))
    length = chords.length
    random = np.random.default_rng(samples)
    chosen, share = random.choice(len(length), samples, p=length / length.sum()), random.random((samples, 1))
    points = chords.start[chosen] + share * (chords.end[chosen] - chords.start[chosen])
    hidden, sure = rays.hidden(scene.items[0].shape, camera, points)
    wrong = np.flatnonzero(sure & (hidden != (chords.hidden_by[chosen] > 0)))
    text = ", ".join(f"{scene.items[chords.item[chosen[k]]].name} at {points[k].tolist()}" for k in wrong[:3])
    assert not len(wrong), f"{len(wrong)} of {sure.sum()} from {camera}: {text}"
    return int(sure.sum())


TRIED = (
    "cone",
    "both halves of a cone",
    "sphere",
    "spindle torus",
    "lemon",
    "drop",
    "cuspidal ring",
    "cuspidal edge",
    "tangents of a helix",
    "Whitney umbrella",
    "implicit cone",
)


@pytest.mark.slow
@pytest.mark.hard(72)
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("name", TRIED)
def test_lines_through_singular_points_as_rays_see_them(name: str) -> None:
    rays, number = rays_of(name), len(name)
    scene = lines_through(name, SURFACES[name], 8, number)
    assert compared(rays, scene, eyes(scene, 2, number)[number % 2], 800) > 600


@pytest.mark.slow
@pytest.mark.hard(72)
@pytest.mark.parametrize(("size", "seed"), [(1e-6, 1), (1e6, 2), (1.0, 3)])
def test_wherever_a_cone_stands_and_whatever_its_size(size: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    matrix = size * np.linalg.qr(random.normal(size=(3, 3)))[0]
    rays = rays_of("cone")
    scene = turned(lines_through("cone", SURFACES["cone"], 8, seed), matrix, 1e3 * size * random.normal(size=3))
    # From an eye and in parallel in turn, or both ways.
    cameras = eyes(scene, 2, seed) if several(1, long=2) == 2 else eyes(scene, 2, seed)[seed % 2 :][:1]
    assert sum(compared(rays, scene, camera, 600) for camera in cameras) > 450 * len(cameras)


@pytest.mark.slow
@pytest.mark.hard(72)
def test_the_axis_of_a_cone_is_hidden_up_to_its_apex_from_every_side() -> None:
    axis = Item("AXIS", Line.through((0.0, 0.0, 0.0), (0.0, 0.0, 5.0)), lines=("curve",))
    scene = Scene((Item("CONE", Cone.standing(2.0, 4.0)), axis))
    for eye, parallel in (((9.0, -14.0, 7.0), True), ((-5.0, 11.0, 4.0), False), ((0.0, -20.0, 9.0), True)):
        drawing = draw(scene, Camera(eye, (0.0, 0.0, 2.0), parallel=parallel), lines="contour,boundary,curve")
        height = drawn(drawing).of(1).world[..., 2]
        assert np.isclose(height.min(), 4.0, atol=1e-6) and np.isclose(height.max(), 5.0), (eye, parallel, height)


@pytest.mark.slow
@pytest.mark.hard(48)
def test_the_contour_of_an_umbrella_is_one_to_its_pinch_point() -> None:
    scene = Scene((Item("UMBRELLA", SURFACES["Whitney umbrella"].surface),))
    eye = Camera((3.0, 4.0, -6.0), (0.0, 0.0, 0.3))
    hidden = chords_seen(scene, eye, kinds=frozenset({LineKind.CONTOUR})).hidden_by
    assert np.count_nonzero(np.diff(hidden)) <= 4
