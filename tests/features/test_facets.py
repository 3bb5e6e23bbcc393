"""Smooth surfaces as fine meshes."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from vectorplot.errors import InputError
from vectorplot.features.edge_splitting import Within
from vectorplot.features.tessellation import facets
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.surfaces.capped_bodies import rod
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.minimal import helicoid_to_catenoid
from vectorplot.surfaces.quadrics import Cone, Hyperboloid, Sphere, implicit_sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.surfaces.trimmed import CutSurface


def within(tolerance: float) -> Within:
    return Within(lambda points: np.full(points.shape[:-1], tolerance))


def edges_of(mesh: Mesh) -> np.ndarray:
    return np.stack([mesh.corners, mesh.corners[mesh.next_corner]], axis=1)


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [0.1, 1e-2, 1e-3])
def test_a_torus_within_the_tolerance_closed_and_with_its_normals(tolerance: float) -> None:
    torus = Torus(3.0, 1.0)
    found = facets(torus, within(tolerance))
    corners = found.mesh.vertices[found.mesh.corners.reshape(-1, 3)]
    middles = np.concatenate([corners.mean(axis=1), *(0.5 * (corners[:, k] + corners[:, k - 1]) for k in range(3))])
    ring = np.hypot(middles[:, 0], middles[:, 1]) - 3.0
    off = np.abs(np.hypot(ring, middles[:, 2]) - 1.0)
    assert off.max() <= 1.02 * tolerance
    assert len(found.mesh.vertices) * 2 == found.mesh.face_count  # Euler: a torus without seams
    around = found.mesh.vertices * [1.0, 1.0, 0.0]
    expected = found.mesh.vertices - 3.0 * around / np.linalg.norm(around, axis=1, keepdims=True)
    assert np.abs(np.abs((expected * found.normals).sum(axis=1)) - 1.0).max() < 1e-12
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    true = found.normals[found.mesh.corners.reshape(-1, 3)[:, 0]]
    assert ((normal * true).sum(axis=1) > 0.0).all()


def test_surfaces_of_straight_lines_are_within_the_tolerance_though_their_chords_lie_in_them() -> None:
    saddle = graph(lambda x, y: x * y, Domain(-1.0, 1.0, -1.0, 1.0))
    for tolerance in (1e-2, 1e-3):
        corners = (mesh := facets(saddle, within(tolerance)).mesh).vertices[mesh.corners.reshape(-1, 3)]
        middles = 0.5 * (corners + np.roll(corners, 1, axis=1)).reshape(-1, 3)
        off = np.abs(middles[:, 2] - middles[:, 0] * middles[:, 1])
        assert off.max() <= 1.02 * tolerance
        assert off.max() > 0.2 * tolerance, "and not finer than that"


@pytest.mark.slow
def test_cost_grows_as_the_tolerance_asks() -> None:
    counts = [facets(Sphere(1.0), within(tolerance)).mesh.face_count for tolerance in (1e-2, 1e-3)]
    assert np.all(np.diff(np.log10(counts)) < 1.2)
    assert np.all(np.diff(np.log10(counts)) > 0.6)


@pytest.mark.parametrize("most", [3000, 20_000])
def test_waves_finer_than_the_budget_are_shown_by_not_many_more_triangles_than_it_has(most: int) -> None:
    """Cuts where normals seem to jump, as they do between triangles that are too coarse, make some more."""
    waves = graph(lambda x, y: np.sin(100.0 * x) * np.cos(100.0 * y), Domain(-1.0, 1.0, -1.0, 1.0))
    found = facets(waves, within(1e-6), most)
    assert not found.complete and 0.3 * most < found.mesh.face_count <= 3 * most


@pytest.mark.slow
def test_poles_and_apices_are_one_vertex_with_a_normal() -> None:
    ball = facets(Sphere(2.0), within(0.01))
    at_pole = np.abs(ball.mesh.vertices[:, 2]) > 2.0 - 1e-9
    assert at_pole.sum() == 2
    assert np.allclose(np.abs(ball.normals[at_pole]), [0.0, 0.0, 1.0], atol=1e-9)
    assert ball.mesh.face_count == 2 * len(ball.mesh.vertices) - 4
    assert np.isfinite(facets(Cone(0.7, 0.0, 1.0), within(0.01)).mesh.vertices).all()


@pytest.mark.slow
def test_the_rim_of_a_cap_is_as_fine_as_the_mantle_asks_and_ends_there() -> None:
    found = facets(rod((0.0, 0.0, 0.0), (1.0, 2.0, 2.0), 1.0), Within(lambda points: np.full(points.shape[:-1], 0.1)))
    on_rim = np.flatnonzero(found.sharp)
    # Its normals turn by 8.5 degrees at most from vertex to vertex, which is more than 42 on each circle.
    assert 2 * 42 < len(on_rim) <= 2 * 64
    assert found.complete and found.mesh.face_count < 1000


@pytest.mark.slow
def test_holes_stay_open() -> None:
    roof = graph(lambda x, y: np.sqrt(1.0 - x * x - y * y), Domain(-1.5, 1.5, -1.5, 1.5))
    found = facets(roof, within(0.01))
    assert found.mesh.face_count > 100
    assert np.isfinite(found.mesh.vertices).all()


@pytest.mark.slow
@pytest.mark.parametrize("surface", [implicit_sphere(1.0), ImplicitTorus(3.0, 1.0)], ids=["sphere", "torus"])
def test_implicit_surfaces_are_closed_and_on_the_surface(surface) -> None:
    found = facets(surface, within(5e-3))
    assert np.all(np.unique(np.sort(edges_of(found.mesh), axis=1), axis=0, return_counts=True)[1] == 2)
    assert np.abs(surface.values(found.mesh.vertices)).max() < 1e-9
    assert np.allclose(np.linalg.norm(found.normals, axis=1), 1.0)


def test_what_is_no_surface_is_an_error() -> None:
    with pytest.raises(InputError, match="no smooth surface"):
        facets(3, within(0.1))  # type: ignore[arg-type]


def test_what_is_far_from_the_eye_may_be_coarse() -> None:
    long = graph(lambda x, y: np.sin(3.0 * x), Domain(0.0, 10.0, 0.0, 1.0))
    near = facets(long, within(1e-4)).mesh.face_count
    far = facets(long, Within(lambda points: 1e-4 * np.maximum(1.0, 10.0 * points[..., 0]))).mesh.face_count
    assert far < 0.7 * near


def test_normals_turn_little_from_vertex_to_vertex_on_ruled_surfaces_too() -> None:
    for surface in (Hyperboloid((1.0, 1.0, 1.0), -2.0, 2.0), helicoid_to_catenoid(0.0, width=1.5)):
        found = facets(surface, within(1.0))
        corners = found.mesh.corners.reshape(-1, 3)
        cosine = (found.normals[corners] * found.normals[np.roll(corners, 1, axis=1)]).sum(axis=2)
        assert np.degrees(np.arccos(cosine.min())) < 10.0


@pytest.mark.slow
@pytest.mark.hard(69)
@pytest.mark.parametrize(
    ("height", "covered", "most"),
    [
        (lambda x, y: np.sqrt(1.0 - x * x - y * y), np.pi, 4000),
        (lambda x, y: np.sqrt(x * x + y * y - 1.0), 16.0 - np.pi, 4000),
        (lambda x, y: np.sqrt(x), 8.0, 1000),
        (lambda x, y: np.sqrt(np.sin(3.0 * x)), 8.0, 4000),
        (lambda x, y: np.sqrt((x - 0.1) * (y + 0.3)), 1.9 * 2.3 + 2.1 * 1.7, 20000),
    ],
    ids=["dome", "around a hole", "root", "strips", "crossing rims"],
)
def test_no_triangle_of_a_graph_with_holes_is_turned_over_and_they_end_at_the_rims(height, covered, most) -> None:
    found = facets(graph(height, Domain(-2.0, 2.0, -2.0, 2.0)), within(1e-2))
    assert found.complete and found.mesh.face_count < most
    a, b, c = found.mesh.vertices[found.mesh.corners.reshape(-1, 3), :2].swapaxes(0, 1)
    area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert area.min() > -1e-7
    assert abs(area.sum() - covered) < 5e-3 * covered


@pytest.mark.slow
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("tolerance", [0.05, 0.02, 2e-3])
def test_caps_beside_cuts_are_covered_and_nothing_of_them_is_folded_over(scale: float, tolerance: float) -> None:
    can = rod((0.0, 0.0, 0.0), (0.0, 0.0, 2.0 * scale), scale)
    gone = HalfSpaces(((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), (0.0, -0.8 * scale))
    found = facets(CutSurface(can, (gone,)), within(tolerance * scale))
    triangles = found.mesh.corners.reshape(-1, 3)
    corners = found.mesh.vertices[triangles] / scale
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # Of vertices on the rims the normal is that of one side only: those of the others have to be those of the cap.
    inner, level = ~found.sharp[triangles], np.abs(area[:, 2]) > 0.9 * np.linalg.norm(area, axis=1)
    true = np.einsum("tx,tkx->tk", area, found.normals[triangles])
    wide = np.linalg.norm(area, axis=1) > 1e-12
    assert (true > 0.99 * np.linalg.norm(area, axis=1)[:, None])[level & wide][inner[level & wide]].all()
    # Half of the disc, and of what is beyond y = 0.8.
    left = 0.5 * np.pi + 0.5 * (np.arccos(0.8) - 0.8 * 0.6)
    for height, sign in ((0.0, -1.0), (2.0, 1.0)):
        own = wide & level & (np.abs(corners[:, :, 2] - height) < 1e-6).all(axis=1)
        assert (sign * area[own, 2] > 0.0).all()
        covered = shapely.union_all(shapely.polygons(corners[own, :, :2]), grid_size=1e-9)
        assert abs(shapely.area(covered) - left) < 2.0 * np.pi * tolerance


@pytest.mark.slow
def test_a_cut_through_the_axis_makes_no_narrow_triangles_whatever_the_size() -> None:
    counts = []
    for scale in (1e-6, 1.0, 1e6):
        can = rod((0.0, 0.0, 0.0), (0.0, 0.0, 2.0 * scale), scale)
        half = CutSurface(can, (HalfSpaces(((1.0, 0.0, 0.0),), (0.0,)),))
        counts.append(facets(half, within(0.02 * scale)).mesh.face_count)
    assert max(counts) <= 1.01 * min(counts)
    assert max(counts) < 1800
