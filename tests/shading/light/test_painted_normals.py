"""One plane has one shade, meshes look round as in pictures of pixels, and floors below lamps have gradients."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.paint import paint
from vectorplot.pictures.render import render
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.shading.screen import scene_triangles
from vectorplot.shading.shaded_faces import at_corners, plane_middles, plane_numbers, view_normals
from vectorplot.testing.shapes import box

SUN = Light((1.0, -2.0, 3.0), parallel=True, intensity=1.0)
CAMERA = Camera((9.0, -12.0, 8.0))


def sheet(count: int, height: float = 0.0, noise: float = 0.0) -> Mesh:
    """A plane, or a bent sheet, of triangles that are anything but alike."""
    random = np.random.default_rng(count)
    x, y = np.meshgrid(np.linspace(-3.0, 3.0, count + 1), np.linspace(-3.0, 3.0, count + 1))
    inner = (np.abs(x) < 3.0) & (np.abs(y) < 3.0)
    x, y = (row + np.where(inner, random.uniform(-0.3, 0.3, x.shape) * 6.0 / count, 0.0) for row in (x, y))
    z = height * x * x + noise * random.uniform(-1.0, 1.0, x.shape)
    first = np.arange(count * (count + 1)).reshape(count, count + 1)[:, :-1].ravel()
    low, high = [first, first + 1, first + count + 2], [first, first + count + 2, first + count + 1]
    triangles = np.concatenate([np.stack(low, 1), np.stack(high, 1)])
    return Mesh.from_triangles(np.stack([x, y, z], axis=-1).reshape(-1, 3), triangles)


SPECK = Item("SPECK", box((-27.0, 36.0, -24.0), (-26.99, 36.01, -23.99)))
"""Far behind: beside it other things have no depth of which their shades could tell."""


def colours_of_item(scene: Scene, item: int = 0, **options: object) -> np.ndarray:
    fills = paint(replace(scene, items=(*scene.items, SPECK)), CAMERA, **options).layers[0].fills[0]  # type: ignore[arg-type]
    own = np.repeat(fills.item == item, np.diff(fills.offsets))
    return np.unique(fills.colours[own], axis=0)


@pytest.mark.hard(74)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("smooth", [True, False])
def test_one_plane_of_many_triangles_has_one_shade(scale: float, smooth: bool) -> None:
    tilt = np.array([[1.0, 0, 0, 0], [0, 0.8, -0.6, 0], [0, 0.6, 0.8, 0], [0, 0, 0, 1.0]])
    mesh = sheet(9).transformed(tilt)
    # As in files of single precision.
    single = replace(mesh, vertices=mesh.vertices.astype(np.float32).astype(np.float64) * scale)
    eye = tuple((scale * np.array(CAMERA.eye)).tolist())
    speck = replace(SPECK, shape=SPECK.shape.transformed(np.diag([scale, scale, scale, 1.0])))
    scene = Scene((Item("A", single), speck), (SUN,))
    fills = paint(scene, Camera(eye), smooth=smooth).layers[0].fills[0]  # type: ignore[arg-type]
    own = np.repeat(fills.item == 0, np.diff(fills.offsets))
    assert len(np.unique(fills.colours[own], axis=0)) == 1


def test_planes_are_told_from_what_is_bent() -> None:
    cube = look(Scene((Item("A", box((0, 0, 0), (1, 1, 1))), Item("B", box((2, 0, 0), (3, 1, 1))))), CAMERA)
    assert len(np.unique(plane_numbers(cube))) == 12, "planes of two items, and planes beside others"
    flat = look(Scene((Item("A", sheet(12)), Item("B", sheet(12, noise=1e-3)))), CAMERA)
    number = plane_numbers(flat)
    assert len(np.unique(number[flat.face_item == 0])) == 1
    assert len(np.unique(number[flat.face_item == 1])) > 250
    # Each step is flat within a hundred thousandth, all of them together are not.
    fine = look(Scene((Item("A", sheet(60, height=1e-4)),)), CAMERA)
    number = plane_numbers(fine)
    middles = plane_middles(fine, number)
    assert np.bincount(number).max() < 60 or np.abs(np.diff(middles[2])).max() < 1e-3


def test_the_middle_of_a_plane_does_not_depend_on_its_triangles() -> None:
    middles = []
    for count in (2, 9, 16):
        view = look(Scene((Item("A", sheet(count)),)), CAMERA)
        middle = plane_middles(view, plane_numbers(view))
        assert np.ptp(middle, axis=1).max() == 0.0
        middles.append(view.world_of(middle[:, :1])[0])
    assert np.abs(middles).max() < 1e-9


def prism(count: int) -> Mesh:
    """An upright prism of many sides."""
    angle = 2.0 * np.pi * np.arange(count) / count
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([np.column_stack([ring, np.full(count, z)]) for z in (0.0, 2.0)])
    after = (np.arange(count) + 1) % count
    sides = np.stack([np.arange(count), after, after + count, np.arange(count) + count], axis=1)
    faces = [*sides.tolist(), list(range(count))[::-1], list(range(count, 2 * count))]
    return Mesh.from_polygons(vertices, faces)


def test_meshes_look_round_where_faces_meet_at_less_than_the_crease_angle() -> None:
    scene = Scene((Item("A", prism(20)),), (SUN,))
    assert len(colours_of_item(scene, smooth=False)) <= 21
    assert len(colours_of_item(scene, crease_angle_deg=10.0)) <= 21
    assert len(colours_of_item(scene)) > 25
    assert len(colours_of_item(Scene((Item("A", prism(10)),), (SUN,)))) <= 11, "36 degrees"


def test_both_verbs_have_the_same_normals() -> None:
    for angle in (0.0, 25.0, 60.0):
        view = look(Scene((Item("A", prism(20)), Item("B", sheet(6, height=0.05)))), CAMERA)
        triangles = scene_triangles(view, (None, None), angle)
        at = at_corners(view, view_normals(view, (None, None), angle))
        of_render = triangles.normals.normals[triangles.normals.index]
        for face in range(view.face_count):
            corner = slice(view.offsets[face], view.offsets[face + 1])
            own = of_render[triangles.face == face].reshape(-1, 3)
            assert all(np.abs(own - normal).sum(axis=1).min() < 1e-9 for normal in at[:, corner].T)


@pytest.mark.parametrize("kind", ["prism", "floor"])
def test_paint_and_render_agree_on_round_meshes_and_floors_near_a_lamp(kind: str) -> None:
    from support.backend_samples import grey_of_png

    from vectorplot.backends.cairo import png_bytes

    if kind == "prism":
        scene = Scene((Item("A", prism(20)),), (SUN,))
    else:
        scene = Scene((Item("A", sheet(3)),), (Light((0.5, 0.3, 1.5), intensity=1.0),))
    camera = Camera((9.0, -12.0, 8.0), fov_deg=30.0)
    page = Page(101.6, 76.2, 0.0)
    painted = 255.0 * grey_of_png(png_bytes(paint(scene, camera, page=page, fit=False), dpi=100))
    pixels = render(scene, camera, size=(400, 300), fit=False).pixels.astype(np.float64).mean(axis=2)
    # But for outlines, and for the depth cue, which paint gives the prism's top as a whole.
    difference = np.abs(painted[:300, :400] - pixels)
    inside = (pixels < 250.0) & (painted[:300, :400] < 250.0)
    assert inside.sum() > 2000
    assert np.quantile(difference[inside], 0.7) < 5.0


def test_floors_below_lamps_have_gradients_and_small_ones_in_the_sun_do_not() -> None:
    lamp = Light((0.5, 0.3, 1.5), intensity=1.0)
    assert len(colours_of_item(Scene((Item("A", sheet(1)),), (lamp,)))) > 40
    assert len(colours_of_item(Scene((Item("A", sheet(1)),), (lamp,)), smooth=False)) == 1
    assert len(colours_of_item(Scene((Item("A", sheet(1)),), (SUN,)))) == 1


FLOOR = Item("FLOOR", box((-9, -2, -0.001), (9, 40, 0)), "gray")
POSTS = tuple(Item(f"POST{k}", box((4 * k - 6, 9 * k, 0), (4 * k - 5, 9 * k + 1, 3)), "red") for k in range(4))


@pytest.mark.slow
@pytest.mark.capability("G4.6-depth-shade")
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("lights", [(), (SUN,), (Light((3.0, 4.0, 30.0), intensity=1.0),)], ids=["none", "sun", "lamp"])
def test_shades_along_a_floor_are_the_same_in_paint_and_render(lights: tuple[Light, ...], parallel: bool) -> None:
    from support.backend_samples import grey_of_png

    from vectorplot.backends.cairo import png_bytes

    scene = Scene((FLOOR, *POSTS), lights)
    camera = Camera((5.0, -30.0, 24.0), (0.0, 12.0, 0.0), fov_deg=40.0, parallel=parallel, height=30.0)
    drawing = paint(scene, camera, page=Page(101.6, 76.2, 0.0), fit=False, shadows="none")
    painted = 255.0 * grey_of_png(png_bytes(drawing, dpi=100))[:300, :400]
    pixels = render(scene, camera, size=(400, 300), fit=False, shadows="none").pixels.astype(np.float64)
    floor = (np.ptp(pixels, axis=2) < 1.0) & (pixels[..., 0] < 250.0)
    inner = floor & (np.abs(painted - pixels[..., 0]) < 60.0)
    off = np.abs(painted - pixels[..., 0])[inner]
    # Without steps in neither: as many shades as bytes have.
    assert inner.sum() > 0.95 * floor.sum() > 10_000 and np.quantile(off, 0.97) <= 3.0
    assert np.ptp(np.quantile(pixels[..., 0][inner], (0.05, 0.95))) > 15.0


def notched_bar(corners: int) -> Mesh:
    """A bar along x whose front has corners inside of its lower and of its upper side, from where its fans begin."""
    x = np.linspace(0.0, 3.0, corners)
    # What files and cuts do to corners on one line.
    z = 0.1 + 1e-16 * np.random.default_rng(3).standard_normal(corners)
    front = np.concatenate([np.column_stack([x, np.zeros(corners), some]) for some in (z, z + 0.7)])
    front[corners:] = front[corners:][::-1]
    ring = np.arange(2 * corners)
    back = 2 * corners + ring
    sides = [[a, a + 2 * corners, b + 2 * corners, b] for a, b in zip(ring, np.roll(ring, -1), strict=True)]
    return Mesh.from_polygons(
        np.concatenate([front, front + np.array((0.0, 1.0, 0.0))]), [ring.tolist(), back[::-1].tolist(), *sides]
    )


@pytest.mark.hard(74)
@pytest.mark.spread
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("crease_angle_deg", [0.0, 5.0, 25.0, 60.0])
def test_plane_faces_with_corners_on_their_sides_have_one_shade(scale: float, crease_angle_deg: float) -> None:
    bar = notched_bar(40)
    turned = np.array([[0.8, -0.6, 0.0, 0.0], [0.36, 0.48, 0.8, 0.0], [-0.48, -0.64, 0.6, 0.0], [0.0, 0.0, 0.0, 1.0]])
    turned[:3, :3] *= scale
    speck = replace(SPECK, shape=SPECK.shape.transformed(np.diag([scale, scale, scale, 1.0])))
    scene = Scene((Item("A", bar.transformed(turned)), speck), (SUN,))
    camera = Camera(tuple((scale * np.array(CAMERA.eye)).tolist()))
    fills = [
        paint(scene, camera, smooth=smooth, crease_angle_deg=crease_angle_deg).layers[0].fills[0]
        for smooth in (True, False)
    ]
    assert np.array_equal(fills[0].points, fills[1].points)
    assert np.array_equal(fills[0].colours, fills[1].colours)
