"""Suggestive contours, ridges, valleys and apparent ridges against closed forms, and at any size and place."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features, surfaces
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.feature_lines import Detail, Sight, implicit_bending, surface_bending, surface_feature_lines
from vectorplot.features.mesh_feature_lines import implicit_feature_lines, mesh_bending, mesh_feature_lines
from vectorplot.features.mesh_lines import face_triangles
from vectorplot.surfaces.quadrics import implicit_ellipsoid
from vectorplot.words import DRAWN, FEATURE_KINDS, WIRES, LineKind

EYE = np.array([20.0, 3.0, 8.0])
SIGHTS = {
    "central": Sight(EYE, np.array([0.0, 0.0, 1.0])),
    "parallel": Sight(None, EYE / np.linalg.norm(EYE)),
}
TORUS = surfaces.Torus(3.0, 1.0)
EGG = surfaces.Ellipsoid((3.0, 2.0, 1.0))
COARSE = Tracing(columns=30, rows=30)


def torus_mesh(rows):
    u, v = np.meshgrid(*TORUS.domain.grid(2 * rows, rows), indexing="ij")
    return features.mesh_of_grid(TORUS.points(u, v), closed_u=True, closed_v=True)


def on_torus(points):
    """The turn about the axis, the turn of the tube, and the outward normals at points of the torus."""
    about = np.hypot(points[:, 0], points[:, 1])
    way = points[:, :2] / about[:, None]
    normals = np.column_stack([(about - 3.0)[:, None] * way, points[:, 2]])
    return about, way, normals


def radial_curvature(points, sight):
    """Of the torus, times the square of the tangential part of the way to the eye: its principal curvatures are known,
    as are their directions."""
    about, way, normals = on_torus(points)
    along = np.column_stack([-way[:, 1], way[:, 0], np.zeros(len(points))])
    across = np.cross(normals, along)
    ways = sight.ways(points)[0]
    return (about - 3.0) / about * (ways * along).sum(axis=1) ** 2 + (ways * across).sum(axis=1) ** 2


@pytest.mark.parametrize("sight", SIGHTS.values(), ids=SIGHTS)
def test_suggestive_contours_of_a_torus_have_no_radial_curvature(sight):
    found = surface_feature_lines(TORUS, sight, [LineKind.SUGGESTIVE], Detail(), COARSE)[LineKind.SUGGESTIVE]
    assert len(found) >= 2
    assert np.abs(radial_curvature(found.points, sight)).max() < 1e-9


def test_on_the_side_of_a_suggestive_contour_the_normal_turns_to_the_eye_soonest():
    sight = SIGHTS["central"]
    found = surface_feature_lines(TORUS, sight, [LineKind.SUGGESTIVE], Detail(), COARSE)[LineKind.SUGGESTIVE]
    seen = (sight.ways(found.points)[0] * on_torus(found.points)[2]).sum(axis=1) > 0.1
    points = found.points[seen]
    _, _, normals = on_torus(points)
    way = sight.eye - points
    way -= (way * normals).sum(axis=1, keepdims=True) * normals
    step = 0.02 * way / np.linalg.norm(way, axis=1, keepdims=True)

    def height_of_eye(near):
        """Over the tangent plane of the torus beside a point."""
        _, way, _ = on_torus(near)
        middle = 3.0 * np.column_stack([way, np.zeros(len(near))])
        out = (near - middle) / np.linalg.norm(near - middle, axis=1, keepdims=True)
        return (out * (sight.eye - middle - out)).sum(axis=1)

    values = [height_of_eye(points + part * step) for part in (-1.0, 0.0, 1.0)]
    assert len(points) and (values[1] < values[0]).all() and (values[1] < values[2]).all()


@pytest.mark.slow
def test_suggestive_contours_of_meshes_come_nearer_to_those_of_the_torus():
    sight = SIGHTS["central"]
    off = []
    for rows in (24, 48, 96):
        found = mesh_feature_lines(torus_mesh(rows), sight, [LineKind.SUGGESTIVE], Detail())[LineKind.SUGGESTIVE]
        assert len(found) >= 2
        off.append(np.abs(radial_curvature(found.points, sight)).mean())
    assert off[1] < 0.45 * off[0] and off[2] < 0.45 * off[1]


@pytest.mark.slow
def test_ridges_of_an_ellipsoid_lie_in_its_planes_of_symmetry():
    lines = surface_feature_lines(EGG, SIGHTS["central"], FEATURE_KINDS, Detail(), COARSE)
    ridge = lines[LineKind.RIDGE]
    assert ridge.closed.tolist() == [True]
    assert np.abs(ridge.points[:, 2]).max() < 1e-9
    assert not len(lines[LineKind.VALLEY]) and not len(lines[LineKind.SUGGESTIVE])


def test_ridges_of_an_implicit_ellipsoid_and_of_a_mesh_of_it_are_the_same():
    implicit = implicit_ellipsoid((3.0, 2.0, 1.0))
    mesh = features.polygonized(implicit, 40)
    for lines in (
        implicit_feature_lines(implicit, mesh, SIGHTS["central"], [LineKind.RIDGE], Detail()),
        mesh_feature_lines(mesh, SIGHTS["central"], [LineKind.RIDGE], Detail()),
    ):
        (ridge,) = lines.values()
        assert len(ridge)
        bound = 1e-5 if hasattr(ridge, "isolated") else 0.1
        assert np.abs(ridge.points[:, 2]).max() < bound


@pytest.mark.slow
@pytest.mark.parametrize("kind", FEATURE_KINDS, ids=lambda kind: kind.word)
def test_spheres_and_cylinders_have_no_feature_lines(kind):
    for surface in (surfaces.Sphere(2.0), surfaces.Cylinder(1.0)):
        found = surface_feature_lines(surface, SIGHTS["central"], [kind], Detail(), COARSE)[kind]
        assert not len(found), kind


def test_curvatures_and_their_derivatives_are_those_of_a_surface_of_third_order():
    p, m, q, d, e, f, g = 0.3, -0.2, 0.5, 0.4, -0.6, 0.2, 0.7

    def height(x, y):
        return (
            0.5 * (p * x * x + 2 * m * x * y + q * y * y)
            + (d * x**3 + 3 * e * x * x * y + 3 * f * x * y * y + g * y**3) / 6
        )

    domain = surfaces.Domain(-0.5, 0.5, -0.5, 0.5)
    flat = surfaces.graph(height, domain)
    own = surface_bending(flat, np.zeros(1), np.zeros(1))
    np.testing.assert_allclose(own.second[0], (p, m, q), atol=1e-6)
    np.testing.assert_allclose(own.third[0], (d, e, f, g), atol=1e-4)
    implicit = surfaces.implicit_of_function(
        lambda x, y, z: z - height(x, y), np.array([(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)])
    )
    there = implicit_bending(implicit, np.zeros((1, 3)), 1.0)
    turn = np.stack([there.in_plane(np.eye(3)[None, 0])[0], there.in_plane(np.eye(3)[None, 1])[0]])
    np.testing.assert_allclose(there.cubed(turn[:1]), d, atol=1e-3)
    np.testing.assert_allclose(there.cubed(turn[1:]), g, atol=1e-3)
    u, v = np.meshgrid(*domain.grid(40, 40), indexing="ij")
    mesh = features.mesh_of_grid(flat.points(u, v))
    fitted = mesh_bending(face_triangles(mesh))
    middle = int(np.linalg.norm(mesh.vertices, axis=1).argmin())
    x, y = (fitted.in_plane(np.tile(axis, (len(mesh.vertices), 1)))[middle : middle + 1] for axis in np.eye(3)[:2])
    one = fitted.take(np.array([middle]))
    np.testing.assert_allclose([one.bent(a)[0] @ b[0] for a, b in ((x, x), (x, y), (y, y))], (p, m, q), atol=0.02)
    np.testing.assert_allclose([one.cubed(x)[0], one.cubed(y)[0]], (d, g), atol=0.05)


@pytest.mark.parametrize(("scale", "away"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_feature_lines_are_the_same_at_any_size_and_place(scale, away):
    mesh, shift = torus_mesh(24), np.array([away, -away, 0.5 * away])
    moved = vp.Mesh.from_triangles(scale * mesh.vertices + shift, face_triangles(mesh).triangles)
    whole = vp.Mesh.from_triangles(mesh.vertices, face_triangles(mesh).triangles)
    own = mesh_feature_lines(whole, SIGHTS["central"], FEATURE_KINDS, Detail())
    far = mesh_feature_lines(moved, Sight(scale * EYE + shift, np.eye(3)[2]), FEATURE_KINDS, Detail())
    for kind in FEATURE_KINDS:
        one, other = own[kind].points, (far[kind].points - shift) / scale
        assert abs(len(one) - len(other)) <= 0.1 * len(one) + 2
        if len(one):
            gap = np.linalg.norm(one[:, None] - other[None], axis=2).min(axis=1)
            assert np.quantile(gap, 0.9) < 1e-6


@pytest.mark.slow
def test_more_detail_has_longer_lines_and_weak_ones_end():
    lengths = []
    for factor in (0.25, 1.0, 8.0):
        found = surface_feature_lines(TORUS, SIGHTS["central"], [LineKind.SUGGESTIVE], Detail(factor), COARSE)
        lines = found[LineKind.SUGGESTIVE]
        lengths.append(sum(np.linalg.norm(np.diff(lines[k], axis=0), axis=1).sum() for k in range(len(lines))))
    assert lengths[0] <= lengths[1] <= lengths[2] and lengths[0] < lengths[2]


def test_feature_lines_are_drawn_only_where_they_are_asked_for():
    assert not set(kind.word for kind in FEATURE_KINDS) & (set(DRAWN) | set(WIRES))


@pytest.mark.slow
@pytest.mark.parametrize("shape", [TORUS, torus_mesh(24)], ids=["surface", "mesh"])
def test_suggestive_contours_are_hidden_as_other_lines_are(shape):
    camera = vp.Camera(tuple(EYE), (0.0, 0.0, 0.0))
    counted = vp.draw(shape, camera, lines="contour,suggestive", hidden="solid")
    strokes = [paths for layer in counted.layers for paths in layer.strokes]
    kinds = np.concatenate([paths.kind for paths in strokes])
    behind = np.concatenate([paths.hidden_by for paths in strokes])
    own = behind[kinds == LineKind.SUGGESTIVE]
    assert (own == 0).any() and (own > 0).any()
