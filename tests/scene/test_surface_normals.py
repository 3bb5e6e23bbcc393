"""Normals of surfaces on meshes made of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.effects.colour_maps import coloured
from vectorplot.scene.colour_scales import Colouring
from vectorplot.scene.item import SurfaceNormals
from vectorplot.shading.facet_resolution import FacetedScene
from vectorplot.surfaces import Sphere


@pytest.mark.slow
def test_bands_of_colours_have_the_normals_of_their_ball():
    ball = vp.Item("BALL", Sphere(2.0), material=vp.Material("matte"))
    bands, _ = coloured(vp.Scene((ball,)), Colouring("z", steps=5))
    moved = replace(bands, items=tuple(item.moved(3.0, 0.0, 0.0) for item in bands.items))
    found = FacetedScene.of_meshes(moved).normals
    assert len(found) == 5
    for item, normals in zip(moved.items, found, strict=True):
        points = item.mesh.vertices - [3.0, 0.0, 0.0]
        true = points / np.linalg.norm(points, axis=1)[:, None]
        assert (np.einsum("ij,ij->i", true, normals.at_vertices) > 1.0 - 1e-4).all() and not normals.on_edge.any()


def test_normals_stay_upright_on_what_is_stretched_and_mirrored():
    triangle = vp.Mesh.from_triangles([(1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2)])
    normals = SurfaceNormals(triangle, np.tile(triangle.face_normals, (3, 1)), np.zeros(3, dtype=bool))
    moved = normals.transformed(np.diag([-3.0, 1.0, 0.5, 1.0]))
    sides = np.diff(moved.mesh.vertices, axis=0)
    assert np.allclose(moved.at_vertices @ sides.T, 0.0, atol=1e-15)
    assert np.allclose(np.linalg.norm(moved.at_vertices, axis=1), 1.0)


def test_how_far_a_surface_reaches_is_known_while_axes_stay_axes():
    triangle = vp.Mesh.from_triangles([(1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2)])
    ball = SurfaceNormals(
        triangle, triangle.vertices, np.zeros(3, dtype=bool), bounds=np.array([[-1.0] * 3, [1.0] * 3])
    )
    scene = vp.Scene((vp.Item("ball", triangle, normals=ball),))
    assert scene.bounds.tolist() == [[-1.0] * 3, [1.0] * 3]
    moved = scene.turned("x", 90).scaled(2.0).moved(0.0, 0.0, 5.0)
    assert moved.bounds.tolist() == [[-2.0, -2.0, 3.0], [2.0, 2.0, 7.0]]
    # Of what is turned by less, or cut, the triangles tell.
    assert (np.abs(scene.turned("x", 30).bounds) <= 1.0).all() and scene.turned("x", 30).bounds[0, 0] == 0.0
    other = replace(scene.items[0], shape=triangle.moved(9.0, 0.0, 0.0))
    assert vp.Scene((other,)).bounds[:, 0].tolist() == [9.0, 10.0]
