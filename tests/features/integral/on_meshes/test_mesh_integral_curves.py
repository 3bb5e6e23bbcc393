"""Integral curves and geodesics on meshes: from edge to edge, along their field, closed where they close."""

import numpy as np
import pytest

from vectorplot import Mesh, features
from vectorplot.errors import InputError
from vectorplot.features.mesh_integration import mesh_geodesics, mesh_integral_curves
from vectorplot.testing.shapes import box

CUBE = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
AROUND = features.VectorField(lambda points: np.cross((0.0, 0.0, 1.0), points))


def height_grid(function, n, low=-1.0, high=1.0):
    x, y = np.meshgrid(np.linspace(low, high, n), np.linspace(low, high, n), indexing="ij")
    return features.mesh_of_grid(np.stack([x, y, function(x, y)], axis=-1))


def hill(x, y):
    return np.exp(-(x**2) - 2.0 * y**2) + 0.2 * x


def prism(sides):
    angle = 2.0 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    corners = np.concatenate([np.column_stack([ring, np.full(sides, z)]) for z in (-1.0, 1.0)])
    k = np.arange(sides)
    after = (k + 1) % sides
    walls = np.stack([k, after, after + sides, k + sides], axis=1).tolist()
    return Mesh.from_polygons(corners, [*walls, k[::-1].tolist(), (k + sides).tolist()])


def off_edges(mesh, points):
    """(k,) how far points are from the nearest edge."""
    corners = mesh.vertices[mesh.corners]
    step = mesh.vertices[mesh.corners[mesh.next_corner]] - corners
    arm = points[:, None] - corners
    t = np.clip((arm * step).sum(-1) / (step * step).sum(-1), 0.0, 1.0)
    return np.linalg.norm(arm - t[..., None] * step, axis=-1).min(axis=1)


def segments_of(curves):
    """Segments (s,3) of curves and their faces (s,)."""
    begin = np.flatnonzero(curves.faces >= 0)
    last = np.isin(begin + 1, curves.offsets[1:])
    end = np.where(last, curves.offsets[np.searchsorted(curves.offsets, begin, side="right") - 1], begin + 1)
    return curves.points[end] - curves.points[begin], curves.faces[begin]


FIELDS = {
    "slope": features.SteepestSlope(),
    "helix": features.ConstantElevation(0.2),
    "turned": features.TurnedField(features.SteepestSlope(), 0.7),
    "own": AROUND,
}


@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize("name", FIELDS)
def test_vertices_are_on_edges_and_every_segment_has_the_direction_of_its_face(name):
    field, mesh = FIELDS[name], height_grid(hill, 9)
    starts = np.arange(0, mesh.face_count, 7)
    found = mesh_integral_curves(mesh, field, starts)
    assert len(found) > 10 and off_edges(mesh, found.points).max() < 1e-12
    step, face = segments_of(found)
    expected = field.tangents(features.face_sites(mesh))[0][face]
    long = np.linalg.norm(step, axis=1)
    across = np.linalg.norm(np.cross(step, expected), axis=1)
    # What does not follow the field follows an edge.
    along = np.zeros(len(step), dtype=bool)
    for k in np.flatnonzero(across > 1e-12):
        own = mesh.vertices[mesh.corners[mesh.offsets[face[k]] : mesh.offsets[face[k] + 1]]]
        sides = np.roll(own, -1, axis=0) - own
        sides /= np.linalg.norm(sides, axis=1)[:, None]
        along[k] = np.linalg.norm(np.cross(step[k], sides), axis=1).min() < 1e-12
    assert (along | (across <= 1e-12)).all() and along.mean() < 0.5
    assert ((step * expected).sum(axis=1)[~along] > (1.0 - 1e-9) * long[~along]).all()


@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize("sides", [3, 4, 7])
def test_orbits_close_exactly_and_run_around_once(sides):
    band = prism(sides)
    level = features.TurnedField(features.SteepestSlope(), np.pi / 2)
    at = features.face_sites(band).points[:sides] + np.array([0.0, 0.0, 0.3])
    for found in (
        mesh_integral_curves(band, level, np.arange(sides), at),
        mesh_integral_curves(band, AROUND, np.arange(sides), at),
        mesh_geodesics(band, np.arange(sides), at, np.cross((0.0, 0.0, 1.0), at), length=100.0),
    ):
        assert found.closed.all() and (np.diff(found.offsets) == sides).all()
        assert np.allclose(found.points[:, 2], 0.3, atol=1e-12)
        assert all(sorted(found.faces[k * sides : (k + 1) * sides]) == list(range(sides)) for k in range(sides))


@pytest.mark.capability("G9.4-polyhedron")
def test_a_geodesic_is_straight_on_the_unfolded_cube():
    # The walls of the cube side by side: x grows along the band.
    start, direction = np.array([0.1, -1.0, -0.9]), np.array([1.0, 0.0, 0.21])
    wall = int(np.argmin(features.face_sites(CUBE).normals @ (0.0, 1.0, 0.0)))
    found = mesh_geodesics(CUBE, wall, start, direction, length=7.0)
    line = found[0]
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line[:, :2], axis=0), axis=1))])
    assert len(line) == 5 and np.abs(line[:, 2] - (-0.9 + 0.21 * run)).max() < 1e-13
    assert np.allclose(run[1:4], [0.9, 2.9, 4.9], atol=1e-13)
    assert np.isclose(np.linalg.norm(np.diff(line, axis=0), axis=1).sum(), 7.0, rtol=1e-14)
    # Through a corner, of three right angles: as much to the left as to the right.
    corner = mesh_geodesics(CUBE, wall, (0.0, -1.0, 0.0), (1.0, 0.0, 1.0), length=4.0)[0]
    assert np.allclose(corner[1:3], [(1.0, -1.0, 1.0), (1.0, 1.0, 1.0)], atol=1e-13)


@pytest.mark.capability("G9.4-polyhedron")
def test_water_follows_valleys_climbers_ridges_and_all_end_where_nothing_leads_on():
    # A valley along x that falls, and the same as a ridge.
    x, y = np.array([0.0, 0.0, 0.0, 2.0, 2.0, 2.0]), np.array([-1.0, 0.0, 1.0, -1.0, 0.0, 1.0])
    valley = Mesh.from_polygons(np.stack([x, y, np.abs(y) - 0.25 * x], axis=1), [(0, 3, 4, 1), (1, 4, 5, 2)])
    down = features.SteepestSlope(up=(0.0, 0.0, -1.0))
    found = mesh_integral_curves(valley, down, [0, 1], both_ways=False)
    for line in (found[0], found[1]):
        assert np.abs(line[1:, 1]).max() < 1e-15 and np.allclose(line[-1], (2.0, 0.0, -0.5), atol=1e-15)
    level = Mesh.from_polygons(np.stack([x, y, np.abs(y)], axis=1), [(0, 3, 4, 1), (1, 4, 5, 2)])
    for line in mesh_integral_curves(level, down, [0, 1], both_ways=False):
        assert np.allclose(line[-1, 1:], 0.0, atol=1e-15) and len(line) == 2
    # To the top of a pyramid, over its ridges where the way leads there; and down to its border.
    corners = np.array([(-1.0, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0.2, 0.3, 1.5)])
    roof = Mesh.from_polygons(corners, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    up = mesh_integral_curves(roof, features.SteepestSlope(), [0, 1, 2, 3])
    assert all(np.array_equal(line[-1], corners[4]) and line[0, 2] == 0.0 for line in up)


@pytest.mark.capability("G9.4-polyhedron")
def test_steepest_slope_on_a_height_grid_comes_near_that_of_the_smooth_graph():
    errors = []
    for n in (17, 33, 65):
        mesh = height_grid(lambda x, y: x**2 + 2.0 * y, n)
        at = features.face_sites(mesh).points
        start = int(np.argmin(np.linalg.norm(at[:, :2] - (0.31, -0.62), axis=1)))
        line = mesh_integral_curves(mesh, features.SteepestSlope(), start, both_ways=False)[0]
        # dx : dy = 2x : 2, so x = c exp(y).
        errors.append(np.abs(line[:, 0] - line[0, 0] * np.exp(line[:, 1] - line[0, 1])).max())
    assert errors[1] < 0.7 * errors[0] and errors[2] < 0.7 * errors[1] and errors[2] < 0.02


@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize(("scale", "offset"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_size_and_place_do_not_matter(scale, offset):
    mesh = height_grid(hill, 9)
    moved = Mesh(mesh.vertices * scale + offset, mesh.corners, mesh.offsets)
    starts = np.arange(0, mesh.face_count, 5)
    for trace in (
        lambda m: mesh_integral_curves(m, features.ConstantElevation(0.2), starts),
        lambda m: mesh_geodesics(m, starts, None, (1.0, 0.3, 0.0)),
    ):
        one, other = trace(mesh), trace(moved)
        assert np.array_equal(one.offsets, other.offsets) and np.array_equal(one.faces, other.faces)
        assert np.abs((other.points - offset) / scale - one.points).max() < (1e-11 if offset == 0.0 else 1e-6)


@pytest.mark.capability("G9.4-polyhedron")
def test_mistakes_about_them_are_told():
    slope = features.SteepestSlope()
    for call, cause in (
        (lambda: mesh_integral_curves(CUBE, features.loxodromes(1.0), 0), "only surfaces with parameters"),
        (lambda: mesh_integral_curves(CUBE, slope, 6), "there is no face 6 among 6"),
        (lambda: mesh_integral_curves(CUBE, slope, 0, (5.0, 5.0, 5.0)), "point 1 is not in face 0"),
        (lambda: mesh_integral_curves(CUBE, slope, 0, length=0.0), "length"),
        (lambda: mesh_geodesics(CUBE, 0, None, (np.nan, 0.0, 0.0)), "directions must be"),
        (lambda: mesh_geodesics(CUBE, 0, None, features.face_sites(CUBE).normals[0]), "direction 1 has no length"),
    ):
        with pytest.raises(InputError, match=cause):
            call()
    assert len(mesh_integral_curves(CUBE, slope, [])) == 0
    # No way up on the roof.
    assert len(mesh_integral_curves(CUBE, slope, int(np.argmax(features.face_sites(CUBE).normals[:, 2])))) == 0
