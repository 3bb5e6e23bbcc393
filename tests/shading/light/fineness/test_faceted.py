"""Scenes without smooth surfaces: meshes and true normals in their place."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.families import Circle
from vectorplot.features.edge_splitting import Within
from vectorplot.scene.item import Item
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.shading.facet_resolution import faceted
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import box


def within(tolerance: float):
    return lambda number: Within(lambda points: np.full(points.shape[:-1], tolerance))


def test_smooth_items_become_meshes_with_their_true_normals():
    items = (Item("BOX", box((0, 0, 0), (1, 1, 1))), Item("RING", Torus(3.0, 1.0), "blue"))
    made = faceted(Scene(items, title="Both"), within(0.01))
    assert made.scene.title == "Both"
    assert made.scene.items[0].shape is items[0].shape
    assert made.normals[0] is None
    mesh = made.scene.items[1].mesh
    assert made.scene.items[1].colour == "blue"
    middle = mesh.vertices[mesh.corners.reshape(-1, 3)].mean(axis=1)
    off = np.hypot(np.hypot(middle[:, 0], middle[:, 1]) - 3.0, middle[:, 2]) - 1.0
    assert 1e-4 < np.abs(off).max() < 0.02
    ring = mesh.vertices * (1, 1, 0)
    true = mesh.vertices - 3.0 * ring / np.linalg.norm(ring, axis=1)[:, None]
    assert np.abs(np.abs((true * made.normals[1].at_vertices).sum(axis=1)) - 1.0).max() < 1e-9


def test_a_curve_has_no_faces():
    made = faceted(Scene((Item("CIRCLE", Circle()),)), within(1.0))
    assert made.scene.items[0].mesh.face_count == 0
    assert made.normals == (None,)


def test_the_triangles_of_a_curved_mirror_are_no_plane_mirrors():
    items = (
        Item("RING", Torus(3.0, 1.0), material=Material("mirror")),
        Item("PANE", box((0, 0, 0), (1, 1, 1)), material=Material("mirror")),
    )
    made = faceted(Scene(items), within(0.1))
    assert [item.material.word for item in made.scene.items] == ["shiny", "mirror"]
