"""Faces that a light does not reach at all: rays meet something before all their places, and nearly none is missed."""

from __future__ import annotations

import numpy as np
import pytest
from support.blocked_lights import FacePoints, scene_triangles, wrong_points
from support.rough import rough_sphere
from support.triangle_rays import blocked

from vectorplot.arrays import Bools, Ints
from vectorplot.effects.shadow_casters import FacePlanes, light_system, unlit_faces, unpierced_faces
from vectorplot.effects.shadows import cast_shadows, shadow_decals
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.projected_faces import body_sides, project_faces

LAMPS = (Light((3.0, -2.0, 4.0)), Light((0.9, -0.3, 0.4), parallel=True))
EVERY_FACE = 10
"""Places in every face, on a lattice without its corners."""


def view_of_meshes(*meshes: Mesh) -> View:
    return look(Scene(tuple(Item(f"body{k}", mesh) for k, mesh in enumerate(meshes))), Camera((8, -9, 12), (0, 0, 0)))


def unlit(view: View, light: Light) -> tuple[Bools, Ints]:
    """(f,) the faces that the light does not reach, and which way they face it."""
    system = light_system(view, light)
    unpierced = unpierced_faces(view, view.occludes, body_sides(view))
    facing = system.facing(FacePlanes.of(view), view.tolerance)
    return unlit_faces(view, system, view.occludes, unpierced, np.inf), facing


def lattice(view: View, face: Ints) -> FacePoints:
    """EVERY_FACE places inside each of some triangles."""
    steps = np.array([(a, b, 3 - a - b) for a in range(4) for b in range(4 - a)]) + 1.0 / 3.0
    corners = view.points[:, view.corners.reshape(-1, 3)[face]]
    points = np.einsum("kfc,sc->kfs", corners, steps / steps.sum(axis=1, keepdims=True))
    return FacePoints(points.reshape(3, -1), np.repeat(face, len(steps)))


def dark_all_over(view: View, light: Light, face: Ints) -> Bools:
    """(n,) the triangles (n,) no place of which on the lattice a ray leaves towards the light."""
    at, system = lattice(view, face), light_system(view, light)
    rays = 10.0 * system.towards(at.points) if system.parallel else system.towards(at.points)
    reached, _ = blocked(at.points.T, rays.T, scene_triangles(view))
    return np.asarray(reached.reshape(len(face), EVERY_FACE).all(axis=1))


@pytest.mark.slow
@pytest.mark.parametrize("light", LAMPS)
def test_of_a_rough_ball_they_are_those_that_rays_find_dark_all_over(light: Light) -> None:
    view = view_of_meshes(rough_sphere(3, 1.0))
    found, facing = unlit(view, light)
    lit = np.flatnonzero(facing > 0)
    dark = dark_all_over(view, light, lit)
    assert dark[found[lit]].all()
    # What has a place that is lit between those of the lattice is not dark all over.
    assert np.count_nonzero(found[lit]) > max(0.7 * np.count_nonzero(dark), 50)


@pytest.mark.slow
@pytest.mark.parametrize("light", LAMPS)
def test_shadows_on_a_rough_ball_are_those_of_all_its_faces(light: Light) -> None:
    """The faces that keep no light away make no difference: the same places are dark as rays say."""
    view = view_of_meshes(rough_sphere(3, 1.0), box((-3, -3, -2), (3, 3, -1.6)))
    decals = shadow_decals(view, (light,))
    wrong, answered = wrong_points(view, (light,), decals, drawn_faces(view, project_faces(view)), 1500, 4)
    assert wrong == 0 and answered > 1000


def roofs(high: float) -> View:
    """A low square, a higher one that covers it but for a slit of this width, and a small one above the slit's end."""
    low = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (4.0, 4.0, 0.0), (0.0, 4.0, 0.0)]
    left = [(-1.0, -1.0, 1.0), (2.0, -1.0, 1.0), (2.0, 5.0, 1.0), (-1.0, 5.0, 1.0)]
    right = [(2.0 + high, -1.0, 1.1), (5.0, -1.0, 1.1), (5.0, 5.0, 1.1), (2.0 + high, 5.0, 1.1)]
    over = [(1.0, 1.0, 2.0), (3.0, 1.0, 2.0), (3.0, 3.0, 2.0), (1.0, 3.0, 2.0)]
    return view_of_meshes(*(Mesh.from_polygons(corners, [(0, 1, 2, 3)]) for corners in (low, left, right, over)))


@pytest.mark.parametrize(("slit", "dark"), [(-0.5, True), (0.5, False)])
def test_a_border_above_what_is_covered_twice_lights_nothing_and_a_slit_does(slit: float, dark: bool) -> None:
    found, _ = unlit(roofs(slit), Light((0.0, 0.0, 1.0), parallel=True))
    assert found.tolist() == [dark, False, False, False]


def test_what_may_be_pierced_is_not_said_to_be_unlit() -> None:
    sheet = Mesh.from_polygons([(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)], [(0, 1, 2, 3)])
    tilted = Mesh.from_polygons([(-3, -3, -2), (3, -3, 2), (3, 3, 2), (-3, 3, -2)], [(0, 1, 2, 3)])
    found, _ = unlit(view_of_meshes(sheet, tilted), Light((0.0, 0.0, 1.0), parallel=True))
    assert not found.any()


@pytest.mark.slow
def test_the_shadow_of_many_faces_on_one_has_the_corners_of_its_outline_alone() -> None:
    """A roof of a hundred strips, as one item, keeps the light from a part of a floor that has four corners."""
    x = np.linspace(-1.0, 1.0, 101)
    vertices = np.concatenate([np.column_stack([x, np.full(101, y), np.ones(101)]) for y in (-1.0, 1.0)])
    strips = [(k, k + 1, k + 102, k + 101) for k in range(100)]
    floor = Mesh.from_polygons([(-4, -4, 0), (4, -4, 0), (4, 4, 0), (-4, 4, 0)], [(0, 1, 2, 3)])
    view = view_of_meshes(floor, Mesh.from_polygons(vertices, strips))
    light = (Light((1.0, 0.5, 2.0), parallel=True),)
    assert len(cast_shadows(view, light)) >= 100
    decals = shadow_decals(view, light)
    assert np.diff(decals.offsets).tolist() == [4]
