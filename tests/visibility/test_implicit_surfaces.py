"""Implicit surfaces in drawings: as their parametrised forms show them, and among what else there is, as rays do."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from support.effort import several
from support.smooth_scenes import lit, ring, views
from support.smooth_seen import Chords, chords_seen

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.scene.view import View, look
from vectorplot.surfaces.implicit import implicit_of_function
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.quadrics import (
    Ellipsoid,
    Hyperboloid,
    Quadric,
    Sphere,
    implicit_cone,
    implicit_cylinder,
    implicit_ellipsoid,
    implicit_sphere,
)
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus, dupin_cyclide
from vectorplot.testing import assert_drawing_is_right, hausdorff
from vectorplot.testing.shapes import box, rotation
from vectorplot.words import LineKind

# Normals may point either way: what stands here for a cosine stands for its negative too.
LINES = SurfaceLines(isophotes=(-0.6, -0.2, 0.2, 0.6), sections=(Section((0.2, 0.3, 1.0), (-0.5, 0.35)),))
FEW = SurfaceLines(isophotes=(-0.4, 0.3))

BOTH_FORMS = {
    "torus": (Torus(3.0, 1.0), ImplicitTorus(3.0, 1.0)),
    "sphere": (Sphere(2.0), implicit_sphere(2.0)),
    "ellipsoid": (Ellipsoid((3.0, 2.0, 1.0)), implicit_ellipsoid((3.0, 2.0, 1.0))),
    "hyperboloid": (
        Hyperboloid((1.0, 1.3, 1.0), -1.5, 2.0),
        Quadric([1.0, 1.0 / 1.69, -1.0, *[0.0] * 6, -1.0], np.array([[-3.0, -4.0, -1.5], [3.0, 4.0, 2.0]])),
    ),
    "cyclide": (
        dupin_cyclide(3.0, 1.0, (1.2, 0.7, 3.1), 4.0),
        ImplicitCyclide(3.0, 1.0, (1.2, 0.7, 3.1), 4.0),
    ),
}


def cube(half: float | tuple[float, float, float]) -> np.ndarray:
    return np.array([[-1.0], [1.0]]) * np.broadcast_to(half, 3)


CUT_SPHERE = Quadric([1.0, 1.0, 1.0, *[0.0] * 6, -1.0], np.array([[-1.2, -0.7, -1.2], [0.8, 1.2, 0.6]]))
SADDLE = Quadric([1.0, -1.0, *[0.0] * 6, -1.0, 0.0], cube((1.9, 1.8, 1.5)))
TURNED = rotation(np.random.default_rng(5))

SCENES = {
    "a sphere cut at the sides of its box": lit(Item("cut", CUT_SPHERE, curves=LINES)),
    "a hyperboloid cut at edges of its box": lit(
        Item("hyperboloid", Quadric([1.0, 0.6, -1.0, *[0.0] * 6, -1.0], cube((1.4, 1.6, 1.3))), curves=LINES)
    ),
    "a saddle": lit(Item("saddle", SADDLE, curves=LINES)),
    "a double cone": lit(Item("cone", implicit_cone(0.6, (0, 0, 0), (0, 0, 1), cube(1.3)), curves=FEW)),
    "two spheres": lit(
        Item("one", implicit_sphere(1.5), curves=FEW), Item("two", implicit_sphere(1.1, (1.0, 0.6, 0.4)), curves=FEW)
    ),
    "Viviani's window": lit(
        Item("ball", implicit_sphere(2.0), curves=FEW),
        Item("post", implicit_cylinder(1.0, (1.0, 0.0, 0.0), (0, 0, 1), cube((2.5, 2.5, 1.8))), curves=FEW),
    ),
    "a sphere and a box": lit(
        Item("ball", implicit_sphere(1.5), curves=FEW), Item("box", box((0.2, -0.4, -0.3), (2.0, 1.8, 0.9)))
    ),
    "a cut sphere and a torus": lit(
        Item("cut", CUT_SPHERE, curves=FEW),
        ring(0.8, 0.3, 7, 5, (0.1,)),
    ),
    "a saddle, a torus and a box": lit(
        Item("saddle", SADDLE, curves=FEW),
        Item("ring", PlacedSurface(Torus(1.2, 0.4), TURNED, (0.1, 0.0, 0.0)), curves=SurfaceLines(7, 5)),
        Item("box", box((0.2, -0.4, -0.3), (2.0, 1.8, 0.9))),
    ),
    "a gyroid": lit(
        Item(
            "gyroid",
            implicit_of_function(
                lambda x, y, z: np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x), cube(3.3)
            ),
            curves=SurfaceLines(isophotes=(0.2,)),
        )
    ),
    "in the light of a lamp": Scene(
        (Item("ring", ImplicitTorus(3.0, 1.0), curves=FEW),), lights=(Light((2.0, 3.0, 5.0)),)
    ),
}


def images(view: View, chords: Chords, which: np.ndarray) -> list[np.ndarray]:
    """Some of the chords in the image, in which half the scene is 1."""
    return list(np.stack([view.image_of(view.points_of(p[which])).T for p in (chords.start, chords.end)], axis=1))


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("name", BOTH_FORMS)
def test_both_forms_of_a_surface_give_the_same_drawing(name: str) -> None:
    one, two = (lit(Item(name, shape, curves=LINES)) for shape in BOTH_FORMS[name])
    for camera in views(one, several(1, long=2), len(name)):
        a, b = (chords_seen(scene, camera) for scene in (one, two))
        assert np.abs(a.lengths() - b.lengths()).max() < 1e-4 * a.length.sum()
        view = look(one, camera)
        for kind in (LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.ISOPHOTE, LineKind.SECTION):
            for hidden_by in range(2):
                own, other = ((c.kind == kind) & (c.hidden_by == hidden_by) for c in (a, b))
                assert own.any() == other.any()
                if own.any():
                    assert hausdorff(images(view, a, own), images(view, b, other)) < 2e-4


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", SCENES)
def test_scenes_with_implicit_surfaces_as_rays_see_them(name: str) -> None:
    scene = SCENES[name]
    cameras = list(views(scene, 2, len(name)))
    # From an eye or in parallel, one scene thus and the next one so, or both ways.
    for seed in (list(SCENES).index(name) % 2,) if several(1, long=2) == 1 else (0, 1):
        drawing = draw(scene, cameras[seed], hidden="solid")
        compared = assert_drawing_is_right(
            drawing, scene, cameras[seed], samples=several(200, long=400), seed=seed, clearance=3e-6
        )
        assert compared > several(70, long=140)


SHAPES = (ImplicitTorus(3.0, 1.0), SADDLE)


@cache
def shapes_seen(parallel: bool) -> Chords:
    """Where they stand, from an eye that other tests move with them."""
    scene = lit(*(Item("item", shape, curves=FEW) for shape in SHAPES))
    return chords_seen(scene, Camera((9.0, -11.0, 7.0), (0.1, 0.2, 0.0), parallel=parallel))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scale", "offset", "views"),
    [(1e-6, 0.0, (False,)), (1e6, 0.0, (True,)), (1.0, 1e6, (False, True)[: several(1, long=2)])],
)
def test_size_and_place_change_nothing(scale: float, offset: float, views: tuple[bool, ...]) -> None:
    place = offset * np.array([1.0, -1.0, 1.0])
    moved = [PlacedImplicit(shape, scale * np.eye(3), place) for shape in SHAPES]
    there = lit(*(Item("item", shape, curves=FEW) for shape in moved))
    for parallel in views:
        eye, target = np.array([9.0, -11.0, 7.0]), np.array([0.1, 0.2, 0.0])
        eye, target = (tuple((scale * point + place).tolist()) for point in (eye, target))
        a, b = shapes_seen(parallel), chords_seen(there, Camera(eye, target, parallel=parallel))
        assert np.abs(a.lengths() - b.lengths() / scale).max() < 1e-5 * a.length.sum()


@pytest.mark.slow
def test_what_does_not_occlude_hides_nothing() -> None:
    scene = Scene(
        tuple(Item(item.name, item.shape, curves=FEW, occludes=False) for item in SCENES["two spheres"].items)
    )
    for camera in views(scene, several(1, long=2), 8):
        assert (chords_seen(scene, camera).hidden_by == 0).all()


@pytest.mark.slow
def test_spheres_meet_in_a_circle_of_which_half_can_be_seen() -> None:
    scene = lit(
        Item("one", implicit_sphere(1.0, (-0.6, 0.0, 0.0))), Item("two", Sphere(1.0, (0.6, 0.0, 0.0)), curves=FEW)
    )
    chords = chords_seen(scene, Camera((0.0, 0.0, 9.0), up=(0.0, 1.0, 0.0), parallel=True))
    met = chords.kind == LineKind.INTERSECTION
    points = np.concatenate([chords.start[met], chords.end[met]])
    assert np.abs(points[:, 0]).max() < 1e-10
    assert np.allclose(np.hypot(points[:, 1], points[:, 2]), 0.8, atol=1e-10)
    assert np.isclose(chords.length[met & (chords.hidden_by == 0)].sum(), 0.8 * np.pi, rtol=1e-3)
    assert np.isclose(chords.length[met].sum(), 1.6 * np.pi, rtol=1e-3)


@pytest.mark.slow
def test_a_surface_that_is_empty_draws_nothing() -> None:
    nothing = Quadric([1.0, 1.0, 1.0, *[0.0] * 6, 1.0], cube(1.0))
    scene = lit(Item("nothing", nothing, curves=LINES), Item("ball", implicit_sphere(0.5), curves=FEW))
    chords = chords_seen(scene, Camera((5.0, 4.0, 3.0)))
    assert (chords.item == 1).all()
    assert len(chords.start)


def test_a_light_that_is_not_there_is_an_error() -> None:
    scene = lit(Item("ball", implicit_sphere(1.0), curves=SurfaceLines(isophotes=(0.5,), light=3)))
    with pytest.raises(InputError, match="ball: isophotes of light 3: the scene has 1 lights"):
        draw(scene)
