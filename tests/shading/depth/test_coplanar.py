"""Faces of several items in one plane: in pixels as in paint, the smaller one is seen."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.paint import paint
from vectorplot.pictures.render import render
from vectorplot.scene.item import Item
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.shading.depth_buffers import coplanar_faces
from vectorplot.testing.shapes import box, rotation

COLOURS = ("#ff0000", "#00ff00", "#0000ff")


def plate(middle, along, across, half_along, half_across) -> Mesh:
    u, v = half_along * np.asarray(along), half_across * np.asarray(across)
    return Mesh.from_polygons([middle - u - v, middle + u - v, middle + u + v, middle - u + v], [[0, 1, 2, 3]])


def nested(seed: int, scale: float, shift: float) -> tuple[Scene, Camera]:
    """Three plates in one plane, each within the one before, and an eye on either side of it."""
    random = np.random.default_rng(seed)
    u, v, n = rotation(random).T
    place = np.full(3, shift)
    turned, across = np.cos(0.4) * u + np.sin(0.4) * v, np.cos(0.4) * v - np.sin(0.4) * u
    plates = (
        plate(place, u, v, 3.0 * scale, 3.0 * scale),
        plate(place + scale * (0.3 * u - 0.2 * v), turned, across, scale, 1.3 * scale),
        plate(place + scale * (0.5 * u - 0.2 * v), u, v, 0.4 * scale, 0.4 * scale),
    )
    order = random.permutation(3)
    items = tuple(Item(f"P{k}", plates[k], COLOURS[k]) for k in order.tolist())
    distance = scale * random.choice([8.0, 100.0])
    way = n * random.choice([-1.0, 1.0]) + random.uniform(-0.6, 0.6, 3)
    return Scene(items), Camera(tuple(place + distance * way), tuple(place))


def image_areas(scene: Scene, camera: Camera) -> list[float]:
    view = look(scene, camera)
    found = {}
    for item in scene.items:
        x, y = view.image_of(view.points_of(item.mesh.vertices))
        found[item.name] = 0.5 * abs(float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()))
    return [found[f"P{k}"] for k in range(3)]


@pytest.mark.slow
@pytest.mark.hard(76, 18, 19)
@pytest.mark.spread
@pytest.mark.parametrize(("scale", "shift"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
@pytest.mark.parametrize("size", [(60, 45), (500, 380)])
def test_the_smaller_of_faces_in_one_plane_is_seen_at_every_size_distance_and_scale(scale, shift, size) -> None:
    for seed in range(5):
        scene, camera = nested(seed, scale, shift)
        pixels = render(scene, camera, size=size, samples=1).pixels
        lone = (pixels > 0).sum(axis=2) == 1
        shown = [int((lone & (pixels[..., k] > 0)).sum()) for k in range(3)]
        whole, middle, least = image_areas(scene, camera)
        wanted = np.array([whole - middle, middle - least, least]) / whole
        assert np.allclose(np.array(shown) / sum(shown), wanted, atol=0.01 + 30.0 / sum(shown))


@pytest.mark.hard(6, 76)
def test_equal_faces_in_one_place_are_seen_as_they_are_painted() -> None:
    cube = box((-1, -1, -1), (1, 1, 1))
    for names in (("#ff0000", "#0000ff"), ("#0000ff", "#ff0000")):
        scene = Scene(tuple(Item(name, cube, name) for name in names))
        camera = Camera((4, -6, 3))
        pixels = render(scene, camera, size=(120, 90), samples=1).pixels
        seen = np.unique(pixels.reshape(-1, 3), axis=0)
        fills = paint(scene, camera).layers[0].marks[0]
        last = fills.colours[-1]
        assert all((colour > 0).tolist() == (last > 0).tolist() for colour in seen if colour.min() < 255)


@pytest.mark.hard(76)
def test_veils_in_the_plane_of_what_is_behind_them_follow_the_same_rule() -> None:
    up, across, along = np.zeros(3), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    floor, rug = plate(up, across, along, 3.0, 3.0), plate(up, across, along, 1.0, 1.0)
    camera = Camera((2.0, -5.0, 7.0))
    for glass, solid, share in ((rug, floor, 1.0 / 9.0), (floor, rug, 8.0 / 9.0)):
        items = (Item("G", glass, "#000000", Material(opacity=0.5)), Item("S", solid, "#ffffff"))
        for order in (items, items[::-1]):
            scene = Scene(order, background="#ffffff")
            pixels = render(scene, camera, size=(240, 180), samples=1).pixels[..., 0].astype(int)
            dark, bright = (pixels < 150).sum(), ((pixels >= 150) & (pixels < 250)).sum()
            assert (dark / (dark + bright)) == pytest.approx(share, abs=0.04)


def test_only_faces_with_company_have_planes() -> None:
    stack = Scene((Item("A", box((0, 0, 0), (1, 1, 1))), Item("B", box((0.2, 0.2, 1), (0.8, 0.8, 2)))))
    found = coplanar_faces(look(stack, Camera((3, -5, 4))))
    _, counts = np.unique(found.plane[found.plane >= 0], return_counts=True)
    assert counts.tolist() == [2]
    assert (coplanar_faces(look(Scene(stack.items[:1]), Camera((3, -5, 4)))).plane < 0).all()
