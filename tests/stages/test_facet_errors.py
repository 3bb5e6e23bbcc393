"""Errors of triangles in place of smooth surfaces that are measured while they are painted."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.facet_errors import facet_error, outline_error
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.placement import fitted_picture
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.shading.facet_resolution import FacetedScene
from vectorplot.shading.shaded_faces import TrueNormals

CAMERA = Camera.view("front")
PAGE = Page(100.0, 100.0, 5.0)


def tube(count: int) -> FacetedScene:
    """A cylinder of radius 1 along y, seen end-on, as a ring of triangles."""
    t = np.arange(count) * 2.0 * np.pi / count
    ring = np.column_stack([np.cos(t), 0.0 * t, np.sin(t)])
    k = np.arange(count)
    points = np.concatenate([ring, ring]) + np.repeat([(0, -1, 0), (0, 1, 0)], count, axis=0)
    after = (k + 1) % count
    faces = np.concatenate([np.column_stack([k, after, k + count]), np.column_stack([after, after + count, k + count])])
    mesh = Mesh.from_triangles(points, faces)
    normals = TrueNormals(np.concatenate([ring, ring]), np.zeros(2 * count, dtype=np.bool_))
    return FacetedScene(Scene((Item("tube", mesh),)), (normals,))


@pytest.mark.parametrize("count", [24, 96])
def test_sides_around_a_cylinder_are_off_by_their_sagitta(count: int) -> None:
    facets = tube(count)
    view = look(facets.scene, CAMERA)
    placement = fitted_picture(view, PAGE, view.image_of(view.points))
    matrix, near = placement.page_from_world, facets.scene.items[0].shape.vertices[[0, count // 2]]
    on = np.column_stack([near, [1.0, 1.0]]) @ matrix.T
    radius = 0.5 * np.hypot(*np.diff(on[:, :2] / on[:, 3:], axis=0)[0])
    off, angle = facet_error(facets, view, placement), np.pi / count
    assert off == pytest.approx(radius * (1.0 - np.cos(angle)), rel=angle**2)
    assert outline_error(facets, view, placement) == pytest.approx(off)


def test_polyhedra_are_not_off() -> None:
    facets = tube(24)
    view = look(facets.scene, CAMERA)
    plain = FacetedScene(facets.scene, (None,))
    assert facet_error(plain, view, fitted_picture(view, PAGE, view.image_of(view.points))) is None
    assert outline_error(plain, view, fitted_picture(view, PAGE, view.image_of(view.points))) is None
