"""What is done to a scene and must not show, or must show as the same thing done to the picture: in every verb.

The lines of drawings are compared in mm, painted and rendered pictures by their pixels.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from support.backend_samples import grey_of_png
from support.drawn import drawn, plate

import vectorplot as vp
from vectorplot.arrays import Floats
from vectorplot.backends.cairo import png_bytes
from vectorplot.geometry.rotations import rotation_about
from vectorplot.surfaces.capped_bodies import Capped
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cylinder, Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing import hausdorff
from vectorplot.testing.shapes import box

SIDE = 120
PAGE = vp.Page(float(SIDE), float(SIDE), 6.0)
STEPS = 6
"""Of 255: so much may a pixel change by rounding."""


@dataclass(frozen=True)
class Seen:
    """A scene, and the camera that looks at it."""

    scene: vp.Scene
    camera: vp.Camera


@cache
def blocks() -> Seen:
    """Boxes on a floor, one of them through another one, with a sun."""
    items = (
        vp.Item("FLOOR", plate((-2, -2), (2, 2), 0.0), "gray"),
        vp.Item("LOW", box((-1.4, -1.2, 0.0), (0.2, 0.3, 0.7)), "red"),
        vp.Item("HIGH", box((-0.3, -0.2, 0.0), (0.6, 1.1, 1.6)), "blue"),
        vp.Item("SMALL", box((0.9, -1.3, 0.0), (1.4, -0.7, 0.5)), "yellow"),
    )
    lights = (vp.Light((2.0, -1.0, 3.0), parallel=True, intensity=0.8),)
    return Seen(vp.Scene(items, lights), vp.Camera((5.0, -7.0, 5.0), (0.0, 0.0, 0.3)))


@cache
def bodies() -> Seen:
    """A ball, a can and a torus on a floor, with a sun."""
    items = (
        vp.Item("FLOOR", plate((-2, -2), (2, 2), 0.0), "gray"),
        vp.Item("BALL", Sphere(0.6, (-0.9, -0.8, 0.6)), "red"),
        vp.Item("CAN", Capped(Cylinder(0.4, 0.0, 1.2, (0.9, 0.7, 0.0))), "blue"),
        vp.Item("RING", Torus(0.6, 0.25, (0.9, -0.9, 0.3)), "yellow"),
    )
    lights = (vp.Light((2.0, -1.0, 3.0), parallel=True, intensity=0.8),)
    return Seen(vp.Scene(items, lights), vp.Camera((5.0, -7.0, 5.0), (0.0, 0.0, 0.3)))


def moved(seen: Seen, turn: Floats, shift: Floats, scale: float = 1.0) -> Seen:
    """All of it turned, or mirrored, scaled and shifted, eye and lights too."""
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * turn, shift

    def place(point: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y, z = (scale * turn @ np.asarray(point) + shift).tolist()
        return (x, y, z)

    def shape(of: object) -> object:
        return of.transformed(matrix) if isinstance(of, vp.Mesh) else PlacedSurface(of, scale * turn.T, shift)

    items = tuple(replace(item, shape=shape(item.shape)) for item in seen.scene.items)
    lights = tuple(replace(light, position=tuple((turn @ light.position).tolist())) for light in seen.scene.lights)
    camera = seen.camera
    up = tuple((turn @ np.array([0.0, 0.0, 1.0])).tolist())
    return Seen(vp.Scene(items, lights), replace(camera, eye=place(camera.eye), target=place(camera.target), up=up))


def with_item(seen: Seen, *items: vp.Item) -> Seen:
    """The scene with more items, at the end."""
    return Seen(replace(seen.scene, items=(*seen.scene.items, *items)), seen.camera)


def turned(seen: Seen) -> Seen:
    return moved(seen, rotation_about((1.0, 2.0, 3.0), 0.7), np.array([3.0, -2.0, 1.0]))


def enlarged(seen: Seen) -> Seen:
    return moved(seen, np.eye(3), np.zeros(3), 1e6)


def far_away(seen: Seen) -> Seen:
    return moved(seen, np.eye(3), np.array([1e5, -2e5, 3e5]))


def mirrored(seen: Seen) -> Seen:
    return moved(seen, np.diag([-1.0, 1.0, 1.0]), np.zeros(3))


def in_another_order(seen: Seen) -> Seen:
    return Seen(replace(seen.scene, items=seen.scene.items[::-1]), seen.camera)


def with_something_inside(seen: Seen) -> Seen:
    return with_item(seen, vp.Item("INSIDE", box((0.95, -1.25, 0.05), (1.35, -0.75, 0.45)), "green"))


def with_something_under_the_floor(seen: Seen) -> Seen:
    return with_item(seen, vp.Item("BELOW", box((-0.4, -0.4, -0.4), (0.4, 0.4, -0.2)), "green"))


def twice(seen: Seen) -> Seen:
    return with_item(seen, replace(seen.scene.items[1], name="AGAIN"))


def with_a_floor_in_parts(seen: Seen) -> Seen:
    corners = [(x, y, 0.0) for x in (-2.0, -0.37, 2.0) for y in (-2.0, 0.81, 2.0)]
    faces = [[3 * i + j, 3 * i + j + 3, 3 * i + j + 4, 3 * i + j + 1] for i in range(2) for j in range(2)]
    floor = replace(seen.scene.items[0], shape=vp.Mesh.from_polygons(corners, faces))
    return Seen(replace(seen.scene, items=(floor, *seen.scene.items[1:])), seen.camera)


SAME = (turned, enlarged, far_away, in_another_order, with_something_under_the_floor, twice, with_a_floor_in_parts)
"""What must not show."""

SCENES = {"blocks": blocks, "bodies": bodies}


def lines(seen: Seen) -> Floats:
    """The visible lines on the page, as straight pieces (n,2,2)."""
    return drawn(vp.draw(seen.scene, seen.camera, page=PAGE, curves="polyline", tolerance_mm=0.005)).visible.page


def painted(seen: Seen) -> Floats:
    """The pixels of a painted picture."""
    picture = vp.paint(seen.scene, seen.camera, page=PAGE, tolerance_mm=0.1)
    return 255.0 * grey_of_png(png_bytes(picture, 25.4))[..., None]


def rendered(seen: Seen) -> Floats:
    """The pixels of a rendered picture."""
    picture = vp.render(seen.scene, seen.camera, size=(SIDE, SIDE), samples=2, shadows="exact")
    return picture.pixels.astype(np.float64)


def different(one: Floats, two: Floats) -> float:
    """The share of pixels that differ by more than rounding."""
    return float((np.abs(one - two).max(axis=2) > STEPS).mean())


DIFFERENT = {"paint": 0.015, "render": 0.002}
"""The largest share of pixels that differ: facets of smooth surfaces, whose borders are seen through antialiasing, may
be other ones."""

VERBS: dict[str, Callable[[Seen], Floats]] = {"paint": painted, "render": rendered}


@cache
def lines_of(scene: str) -> Floats:
    return lines(SCENES[scene]())


@cache
def pixels_before(scene: str, verb: str) -> Floats:
    return VERBS[verb](SCENES[scene]())


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("change", [*SAME, with_something_inside], ids=lambda change: change.__name__)
def test_lines_are_drawn_as_before(scene: str, change: Callable[[Seen], Seen]) -> None:
    if change is with_something_inside and scene == "bodies":
        change = with_something_under_the_floor
    assert hausdorff(list(lines_of(scene)), list(lines(change(SCENES[scene]())))) < 0.005


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES)
def test_lines_of_the_mirrored_scene_are_mirrored(scene: str) -> None:
    there = lines(mirrored(SCENES[scene]())) * (-1.0, 1.0) + (SIDE, 0.0)
    assert hausdorff(list(lines_of(scene)), list(there)) < 0.005


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("change", SAME, ids=lambda change: change.__name__)
def test_pictures_are_as_before(scene: str, verb: str, change: Callable[[Seen], Seen]) -> None:
    assert different(pixels_before(scene, verb), VERBS[verb](change(SCENES[scene]()))) < DIFFERENT[verb]


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("verb", VERBS)
def test_pictures_of_the_mirrored_scene_are_mirrored(scene: str, verb: str) -> None:
    there = VERBS[verb](mirrored(SCENES[scene]()))[:, ::-1]
    assert different(pixels_before(scene, verb), there) < 2.0 * DIFFERENT[verb]
