"""Normals at corners: shared up to the crease angle, true ones where surfaces have them."""

from __future__ import annotations

import numpy as np
import pytest
from support.shaded_scenes import triangles_of

from vectorplot.shading.shaded_faces import corner_normals, unit
from vectorplot.shading.shaded_faces import mesh_face_normals as face_normals
from vectorplot.testing.shapes import box, bumpy_icosphere


def normals_of(points, corners, angle):
    none = np.zeros(len(points), dtype=bool)
    found = corner_normals(points, corners, angle, np.zeros_like(points), none)
    return found.normals[found.index]


def test_a_box_stays_flat():
    points, corners = triangles_of(box((0, 0, 0), (1, 2, 3)))
    own = unit(face_normals(points, corners))
    assert np.allclose(normals_of(points, corners, 25.0), own[:, None])
    assert not np.allclose(normals_of(points, corners, 180.0), own[:, None])


def test_a_fine_sphere_is_round():
    points, corners = triangles_of(bumpy_icosphere(4))
    smooth = normals_of(points, corners, 60.0)
    # One normal a vertex, and that near the faces around it.
    first = smooth[corners == corners[0, 0]]
    assert np.allclose(first, first[0])
    own = unit(face_normals(points, corners))
    assert (np.einsum("ikj,ij->ik", smooth, own) > 0.9).mean() > 0.99
    assert np.allclose(np.linalg.norm(smooth, axis=2), 1.0)


@pytest.mark.parametrize("order", [12, 45])
def test_a_can_is_round_with_sharp_rims(order):
    angle = 2.0 * np.pi * np.arange(order) / order
    rim = np.stack([np.cos(angle), np.sin(angle), np.zeros(order)], axis=1)
    points = np.concatenate([rim, rim + np.array((0, 0, 2)), [(0, 0, 0), (0, 0, 2)]])
    k, after = np.arange(order), (np.arange(order) + 1) % order
    sides = np.concatenate([np.stack([k, after, after + order], 1), np.stack([k, after + order, k + order], 1)])
    lids = np.concatenate(
        [np.stack([after, k, np.full(order, 2 * order)], 1), np.stack([k, after, np.full(order, 1)], 1) + order]
    )
    lids[order:, 2] = 2 * order + 1
    corners = np.concatenate([sides, lids])
    smooth = normals_of(points, corners, 40.0)
    true = points[sides] * (1, 1, 0)
    assert np.einsum("ikj,ikj->ik", smooth[: len(sides)], true).min() > np.cos(1.1 * np.pi / order)
    assert np.allclose(np.abs(smooth[len(sides) :]), (0, 0, 1)), "lids are flat up to the rim"


def test_true_normals_are_kept():
    points, corners = triangles_of(box((0, 0, 0), (1, 1, 1)))
    known = np.arange(8) < 4
    given = np.tile((0.0, 0.6, 0.8), (8, 1))
    found = corner_normals(points, corners, 25.0, given, known)
    assert np.allclose(found.normals[found.index][known[corners]], (0.0, 0.6, 0.8))


def test_triangles_without_area_have_no_say():
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0)], dtype=float)
    smooth = normals_of(points, np.array([(0, 1, 2), (0, 1, 3)]), 25.0)
    assert np.allclose(smooth[0], (0, 0, 1))
    assert np.isfinite(smooth).all()
