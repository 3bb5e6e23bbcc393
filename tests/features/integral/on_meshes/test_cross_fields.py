"""Combed directions: those of the curvature where there is one, smooth where there is none, in every face."""

from __future__ import annotations

import numpy as np
import pytest
from support.rough import rough_sphere

import vectorplot as vp
from vectorplot import features
from vectorplot.features.cross_fields import CombedCurvature
from vectorplot.features.surface_points import BentFaces, FaceSites
from vectorplot.geometry import box
from vectorplot.geometry.vectors import dot, norm
from vectorplot.surfaces import Sphere
from vectorplot.testing.shapes import torus_mesh


def tangents(mesh: vp.Mesh, family: int = 1, crease: float = 25.0) -> tuple[np.ndarray, FaceSites]:
    bent = BentFaces(mesh, crease)
    sites = features.face_sites(mesh, crease)
    return CombedCurvature(bent, family).tangents(sites)[0], sites


def half_pipe() -> vp.Mesh:
    """A quarter of a tube along x, and a plane that goes on from it: the tube bends at right angles to x."""
    turn = np.linspace(0.0, 0.5 * np.pi, 13)
    bent = np.stack([0.0 * turn, np.sin(turn), 1.0 - np.cos(turn)], axis=1)
    flat = np.stack([np.zeros(12), np.linspace(-2.0, -2.0 / 12, 12), np.zeros(12)], axis=1)
    profile = np.concatenate([flat, bent])
    x = np.linspace(0.0, 2.0, 15)
    return features.mesh_of_grid(profile[None] + x[:, None, None] * np.array([1.0, 0.0, 0.0]))


@pytest.mark.parametrize("family", [1, 2])
def test_where_a_mesh_bends_they_are_its_principal_directions(family: int) -> None:
    mesh = torus_mesh(96, 48, 3.0, 1.0)
    found, sites = tangents(mesh, family)
    exact = features.PrincipalDirections(family).tangents(sites)[0]
    known = np.isfinite(exact).all(axis=1)
    assert known.mean() > 0.9
    assert np.abs(dot(found, exact))[known].min() > np.cos(np.radians(3.0))


def test_from_where_it_bends_they_go_on_over_what_is_flat() -> None:
    mesh = half_pipe()
    found, sites = tangents(mesh)
    flat = sites.points[:, 1] < -0.1
    assert flat.sum() > 100
    exact = np.abs(found[:, 0])
    across, along = exact.max() < 0.05, exact.min() > 0.99
    assert across or along, "one direction all over, at right angles to the tube or along it"


@pytest.mark.parametrize("mesh", [rough_sphere(3), box((2, 2, 2)), torus_mesh(12, 6, 3.0, 1.0)])
def test_every_face_has_one_in_its_plane_of_length_one(mesh: vp.Mesh) -> None:
    one, sites = tangents(mesh)
    two, _ = tangents(mesh, 2)
    assert np.isfinite(one).all()
    for found in (one, two):
        assert np.abs(norm(found) - 1.0).max() < 1e-9
        assert np.abs(dot(found, sites.normals)).max() < 1e-9
    assert np.abs(dot(one, two)).max() < 1e-9


def test_on_a_shaken_ring_they_run_round_it_where_curvatures_say_nothing() -> None:
    even = torus_mesh(96, 48, 3.0, 1.0)
    shaken = even.vertices + 0.013 * np.random.default_rng(1).normal(size=even.vertices.shape)
    found, sites = tangents(vp.Mesh(shaken, even.corners, even.offsets))
    known = np.isfinite(features.PrincipalDirections(1).tangents(sites)[0]).all(axis=1)
    assert known.mean() < 0.5
    x, y, _ = sites.points.T
    way = np.stack([-y, x, 0.0 * x], axis=1)
    way -= dot(way, sites.normals)[:, None] * sites.normals
    off = np.degrees(np.arccos(np.clip(np.abs(dot(found, way)) / norm(way), 0.0, 1.0)))
    # Round the ring it bends least on one side of the tube, and most on the other nowhere.
    assert np.quantile(np.minimum(off, 90.0 - off), 0.95) < 6.0
    assert min((off < 45.0).mean(), (off > 45.0).mean()) < 0.01


def test_moved_and_scaled_they_are_the_same() -> None:
    mesh = rough_sphere(3)
    found, _ = tangents(mesh)
    for scale, shift in ((2.0**-20, 0.0), (2.0**20, 0.0), (1.0, 1e6)):
        other = vp.Mesh(scale * mesh.vertices + shift, mesh.corners, mesh.offsets)
        assert np.abs(dot(found, tangents(other)[0])).min() > 1.0 - 1e-6


def test_places_on_surfaces_are_refused() -> None:
    sites = features.Sites(Sphere(), np.zeros(1), np.zeros(1))
    with pytest.raises(vp.InputError, match="combed directions"):
        CombedCurvature(BentFaces(box((1, 1, 1))), 1).tangents(sites)
