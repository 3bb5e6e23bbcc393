"""Balls, rods, cones and frusta in pixels, in closed form: as fine triangles show them, wherever the eye is."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import surfaces
from vectorplot.geometry.projections import projection_of
from vectorplot.pictures import render as verb
from vectorplot.scene.page import Page
from vectorplot.scene.view import look
from vectorplot.shading.depth_buffers import DepthCode
from vectorplot.shading.quadric_pixels import bodies_in_pixels, front_bodies, pixel_bodies, quadric_points, with_extents
from vectorplot.shading.screen import picture_placement, pixel_system
from vectorplot.visibility.quadrics.visible_parts import image_boxes

SIZE = (160, 120)
EYES = {
    "from outside": vp.Camera((9.0, -7.0, 6.0)),
    "parallel": vp.Camera((9.0, -7.0, 6.0), parallel=True),
    "along the axes": vp.Camera((0.0, 0.0, 9.0), up=(0.0, 1.0, 0.0), parallel=True),
    "within the other half of a cone": vp.Camera((0.3, 0.2, 8.0), up=(0.0, 1.0, 0.0)),
    "from amid them": vp.Camera((1.9, -1.6, 1.2), target=(0.0, 0.0, 0.0)),
}


def some_shapes(random: np.random.Generator):
    """One of each kind, upright and near the origin, and the same turned, stretched and moved."""
    ellipsoid = surfaces.Ellipsoid((0.5, 0.9, 0.7))
    upright = [
        surfaces.Sphere(0.8, centre=(2.0, 0.4, 0.0)),
        ellipsoid,
        surfaces.Capped(surfaces.Cylinder(0.4, -1.0, 2.0)),
        surfaces.Capped(surfaces.Cone.standing(0.8, 1.5)),
        surfaces.Capped(surfaces.Frustum(0.9, 0.3, 1.2)),
        surfaces.Capped(surfaces.Sphere(0.9), v=(-0.4, 0.9)),
        surfaces.Capped(ellipsoid, v=(-1.2, 0.2)),
    ]
    placed = []
    for shape in upright:
        turned = np.linalg.qr(random.normal(size=(3, 3)))[0] * random.uniform(0.7, 1.3, 3)
        placed.append(surfaces.PlacedSurface(shape, turned, random.uniform(-2.0, 2.0, 3)))
    return upright[:4] + placed


def scene_of(shapes, with_box: bool = True) -> vp.Scene:
    colours = ("red", "green", "blue", "yellow", "gray", "white")
    items = [vp.Item(f"item {k}", shape, colours[k % 6]) for k, shape in enumerate(shapes)]
    if with_box:
        items.append(vp.Item("box", vp.geometry.box((3.0, 3.0, 0.3)), "orange"))
    return vp.Scene(tuple(items))


def beside_edges(pixels: np.ndarray) -> np.ndarray:
    """Which pixels differ much from one beside them, or are beside such ones."""
    found = np.zeros(pixels.shape[:2], dtype=bool)
    for axis in (0, 1):
        step = np.moveaxis(np.abs(np.diff(pixels.astype(int), axis=axis)).max(axis=2) > 6, axis, 0)
        moved = np.moveaxis(found, axis, 0)
        moved[1:] |= step
        moved[:-1] |= step
    return found


@pytest.mark.capability("G7.3-zbuffer")
@pytest.mark.spread
@pytest.mark.parametrize("name", EYES)
@pytest.mark.parametrize("seed", [0, 1])
def test_pictures_are_those_of_fine_triangles(name, seed, monkeypatch) -> None:
    scene = scene_of(some_shapes(np.random.default_rng(seed)))
    made = vp.render(scene, EYES[name], size=SIZE, samples=1).pixels.astype(int)
    monkeypatch.setattr(verb, "bodies_in_pixels", lambda items, projection: None)
    of_triangles = vp.render(scene, EYES[name], size=SIZE, samples=1).pixels.astype(int)
    off = np.abs(made - of_triangles).max(axis=2) > 4
    assert off.mean() < 0.01
    assert (off & ~beside_edges(of_triangles)).mean() < 3e-4


@pytest.mark.parametrize("name", EYES)
def test_what_a_pixel_shows_is_on_the_body_and_on_its_sight_line(name) -> None:
    scene, camera = scene_of(some_shapes(np.random.default_rng(2)), with_box=False), EYES[name]
    view = look(scene, camera)
    bodies = bodies_in_pixels(scene.items, view)
    system = pixel_system(picture_placement(view, Page(*map(float, SIZE), 0.0), True))
    screen = pixel_bodies(bodies, view, system, *SIZE)
    _, number = front_bodies(screen, DepthCode.fine(*screen.depths, 40), SIZE[0], 0, SIZE[1])
    found = quadric_points(screen, number, 0)
    assert len(found.pixel) > 500
    there = system.homogeneous(found.places)
    row, column = np.divmod(found.pixel, SIZE[0])
    assert np.abs(there[:, :2] / there[:, 3:] - np.stack([column, row], axis=1)).max() < 1e-6
    of = number.ravel()[found.pixel]
    x, y, z = np.einsum("ijn,in->jn", bodies.inverse[..., of], found.places.T - bodies.centre[:, of])
    ball = bodies.is_ball[of]
    width = np.where(ball, 1.0, bodies.radii[0, of] + bodies.growth[of] * z)
    mantle = np.abs(x * x + y * y + ball * z * z - width * width)
    ends = np.where(ball, np.inf, np.minimum(np.abs(z), np.abs(z - 1.0)))
    assert np.minimum(mantle, ends).max() < 1e-9
    to_eye = np.array([0.0, 0.0, 1.0]) if view.eye is None else view.eye - found.places
    assert (np.sum(found.normals * to_eye, axis=1) > -1e-9).all()
    assert np.abs(np.linalg.norm(found.normals, axis=1) - 1.0).max() < 1e-12


@pytest.mark.parametrize("scale", [1e-6, 1e6])
@pytest.mark.parametrize("parallel", [False, True])
def test_size_and_place_change_no_pixel(scale, parallel) -> None:
    shapes = some_shapes(np.random.default_rng(3))
    moved = [surfaces.PlacedSurface(shape, scale * np.eye(3), 1e6 * scale * np.ones(3)) for shape in shapes]
    eye, middle = np.array((9.0, -7.0, 6.0)), 1e6 * scale * np.ones(3)
    camera = vp.Camera(tuple(scale * eye + middle), target=tuple(middle), parallel=parallel)
    here = vp.render(scene_of(shapes, False), vp.Camera(tuple(eye), parallel=parallel), size=SIZE, samples=1).pixels
    there = vp.render(scene_of(moved, False), camera, size=SIZE, samples=1).pixels
    assert (np.abs(here.astype(int) - there.astype(int)).max(axis=2) > 1).mean() < 1e-3


def test_boxes_of_images_and_octahedra_reach_as_far_as_the_bodies() -> None:
    scene = scene_of(some_shapes(np.random.default_rng(4)), with_box=False)
    for name, camera in EYES.items():
        projection = projection_of(camera, scene.bounds)
        bodies = bodies_in_pixels(scene.items, projection)
        octahedra = with_extents(scene, bodies, projection)
        boxes = image_boxes(bodies, projection)
        for number, box in zip(bodies.item.tolist(), boxes.T, strict=True):
            shape = scene.items[number].shape
            grid = np.meshgrid(*shape.domain.grid(300, 300), indexing="ij")
            points = projection.points_of(np.asarray(shape.points(*grid)).reshape(-1, 3))
            reach = projection.points_of(octahedra.items[number].mesh.vertices)
            assert np.abs(points.min(axis=1) - reach.min(axis=1)).max() < 1e-3, name
            assert np.abs(points.max(axis=1) - reach.max(axis=1)).max() < 1e-3, name
            image = projection.image_of(points)
            size = np.ptp(image, axis=1).max()
            assert np.abs(image.min(axis=1) - box[::2]).max() < 2e-3 * size, name
            assert np.abs(image.max(axis=1) - box[1::2]).max() < 2e-3 * size, name


def test_bodies_that_reach_behind_the_eye_are_left_to_triangles() -> None:
    scene = scene_of([surfaces.Sphere(1.0), surfaces.Capped(surfaces.Cylinder(0.2, -9.0, 9.0))], with_box=False)
    camera = vp.Camera((0.0, -1.5, 6.0), target=(0.0, 0.0, 0.0))
    assert bodies_in_pixels(scene.items, projection_of(camera, scene.bounds)).item.tolist() == [0]
    assert vp.render(scene, camera, size=SIZE).pixels.shape == (SIZE[1], SIZE[0], 3)


def test_clear_bodies_mirrors_and_other_surfaces_are_none() -> None:
    ball = surfaces.Sphere(1.0)
    items = (
        vp.Item("glass", ball, material=vp.Material("matte", opacity=0.5)),
        vp.Item("mirror", ball, material=vp.Material("mirror")),
        vp.Item("torus", surfaces.Torus(2.0, 0.5)),
        vp.Item("open", surfaces.Cylinder(1.0, 0.0, 1.0)),
        vp.Item("dome", surfaces.Capped(ball, v=(0.0, 1.0))),
        vp.Item("mesh", vp.geometry.box((1.0, 1.0, 1.0))),
        vp.Item("ball", ball),
    )
    scene = vp.Scene(items)
    projection = projection_of(vp.Camera((5.0, 4.0, 3.0)), scene.bounds)
    assert bodies_in_pixels(items, projection).item.tolist() == [6]
    assert bodies_in_pixels(items[:6], projection) is None
