"""Lines of curvature and asymptotic lines on meshes: near those of the smooth shape, nearer on finer meshes, and none
where there are none."""

import numpy as np
import pytest
from support.paths import MODELS

import vectorplot as vp
from vectorplot import Mesh, features, geometry
from vectorplot.errors import InputError, InputWarning
from vectorplot.features import AsymptoticDirections, PrincipalDirections
from vectorplot.features.mesh_integration import FaceFieldFlow, mesh_integral_curves, mesh_sides
from vectorplot.features.mesh_lines import face_triangles
from vectorplot.features.mesh_streamlines import evenly_spaced_mesh_curves
from vectorplot.features.nearest import nearest_on_mesh
from vectorplot.features.surface_points import FaceSites
from vectorplot.io.scene_language import parse_scene
from vectorplot.surfaces.quadrics import implicit_sphere
from vectorplot.testing import assert_integral_curve

CUBE = geometry.box((2, 2, 2))
EGG = np.array([3.0, 2.0, 1.4]) ** 2
TURN = 2.0 * np.pi


def ring(u, v):
    return np.stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1)


def revolved(radius):
    return lambda u, v: np.stack([radius(v) * np.cos(u), radius(v) * np.sin(u), v], axis=-1)


catenoid, hyperboloid = revolved(np.cosh), revolved(lambda v: np.sqrt(1.0 + v * v))
tube = revolved(lambda v: np.ones_like(v))


def triangled(points, n, m, low, high, closed):
    u, v = np.meshgrid(np.linspace(0.0, TURN, n + 1), np.linspace(low, high, m + 1), indexing="ij")
    mesh = features.mesh_of_grid(points(u, v), closed_u=True, closed_v=closed)
    return Mesh.from_polygons(mesh.vertices, face_triangles(mesh).triangles.tolist())


def ring_mesh(n):
    return triangled(ring, 2 * n, n, 0.0, TURN, True)


def sleeve(points, n):
    return triangled(points, n, n // 2, -1.0, 1.0, False)


def through(mesh, field, places, length):
    nearest = nearest_on_mesh(mesh, places)
    found = mesh_integral_curves(mesh, field, nearest.faces, nearest.points, length=length)
    assert len(found) == len(places)
    return [found[k] for k in range(len(found))]


def off_ring(mesh):
    """How far lines of curvature are off the meridians and parallels of a ring."""
    starts = [ring(u, v) for u, v in ((0.3, 0.4), (1.1, 2.0), (2.3, 4.0))]
    meridians = through(mesh, PrincipalDirections(2), starts, 3.0)
    parallels = through(mesh, PrincipalDirections(1), starts, 6.0)
    around = [np.ptp(np.unwrap(np.arctan2(line[:, 1], line[:, 0]))) for line in meridians]
    up = [np.ptp(np.unwrap(np.arctan2(line[:, 2], np.hypot(*line.T[:2]) - 3.0))) for line in parallels]
    return max(around), max(up)


def off_egg(n):
    """How much a confocal coordinate varies along lines of curvature of an ellipsoid: they are curves on which one is
    constant."""
    ball = features.polygonized(implicit_sphere(1.0), n)
    egg = Mesh(ball.vertices * np.sqrt(EGG), ball.corners, ball.offsets)
    found = []
    for family in (1, 2):
        for line in through(egg, PrincipalDirections(family), [(2.0, 1.3, 0.9), (-2.0, 1.3, 0.5)], 2.0):
            x, y, z = (line / np.sqrt((line * line / EGG).sum(axis=1))[:, None]).T ** 2
            a, b, c = EGG
            total = a + b + c - x - y - z
            product = a * b + b * c + c * a - x * (b + c) - y * (a + c) - z * (a + b)
            root = np.sqrt(total * total - 4.0 * product)
            found.append(min(np.ptp(total - root), np.ptp(total + root)) / 2.0)
    return max(found)


def off_rulings(n):
    """How far asymptotic lines of a hyperboloid are off its straight lines."""
    found = []
    for family in (1, 2):
        for angle in (0.3, 1.1, 2.3):
            (line,) = through(sleeve(hyperboloid, n), AsymptoticDirections(family), [hyperboloid(angle, 0.0)], 0.9)
            foot = np.array([np.cos(angle), np.sin(angle), 0.0])
            ways = (np.array([-s * np.sin(angle), s * np.cos(angle), 1.0]) / np.sqrt(2.0) for s in (1.0, -1.0))
            found.append(min(np.linalg.norm(np.cross(line - foot, way), axis=1).max() for way in ways))
    return max(found)


def off_half_right(n):
    """How far asymptotic lines of a catenoid are off those at 45 degrees: u - v is constant, or u + v."""
    found = []
    for angle in (0.3, 1.1, 2.3):
        (line,) = through(sleeve(catenoid, n), AsymptoticDirections(1), [catenoid(angle, 0.0)], 0.9)
        u = np.unwrap(np.arctan2(line[:, 1], line[:, 0]))
        found.append(min(np.ptp(u - line[:, 2]), np.ptp(u + line[:, 2])))
    return max(found)


@pytest.mark.slow
@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize(
    ("off", "sizes", "order"), [(off_egg, (8, 24), 1.0), (off_rulings, (24, 48), 1.8), (off_half_right, (24, 48), 1.8)]
)
def test_they_come_near_those_of_the_smooth_shape_on_finer_meshes(off, sizes, order):
    coarse, fine = (off(n) for n in sizes)
    assert fine < coarse * (sizes[0] / sizes[1]) ** order and fine < 0.1


@pytest.mark.slow
@pytest.mark.capability("G9.4-polyhedron")
def test_on_a_ring_they_run_around_it_and_around_its_tube():
    around, up = off_ring(ring_mesh(24))
    finer_around, _ = off_ring(ring_mesh(48))
    assert around < 0.025 and up < 0.07 and finer_around < 0.6 * around


@pytest.mark.capability("G9.4-polyhedron")
def test_tensors_are_known_to_the_square_of_the_edges_and_by_the_edges_at_borders():
    inner, rim = [], []
    for n in (32, 64):
        sites = features.face_sites(sleeve(catenoid, n))
        way, around = AsymptoticDirections(2).tangents(sites)[0], np.cross((0.0, 0.0, 1.0), sites.points)
        cosine = np.abs((way * around).sum(axis=1)) / np.linalg.norm(around, axis=1)
        off = np.abs(np.arccos(cosine) - np.pi / 4)
        edge = np.abs(sites.points[:, 2]) > 1.0 - 4.0 / n
        rim.append(off[edge].max())
        inner.append(off[np.abs(sites.points[:, 2]) < 0.5].max())
    assert inner[1] < 0.3 * inner[0] and rim[1] < 0.75 * rim[0] and inner[1] < 0.004


@pytest.mark.capability("G9.4-polyhedron")
def test_straight_lines_of_a_tube_are_of_both_sorts_and_its_lids_have_none():
    wall = triangled(tube, 32, 3, -1.0, 1.0, False)
    lids = [np.flatnonzero(wall.vertices[:, 2] == z) for z in (-1.0, 1.0)]
    lids = [rim[np.argsort(np.arctan2(*wall.vertices[rim, :2].T[::-1]))] for rim in lids]
    polygons = wall.corners.reshape(-1, 3).tolist()
    can = Mesh.from_polygons(wall.vertices, [*polygons, lids[0][::-1].tolist(), lids[1].tolist()])
    for field in (PrincipalDirections(1), PrincipalDirections(2), AsymptoticDirections(1)):
        known = np.isfinite(field.tangents(features.face_sites(can))[0]).all(axis=1)
        assert known[:-2].all() and not known[-2:].any()
    lines = evenly_spaced_mesh_curves(can, AsymptoticDirections(2), 0.4)
    assert len(lines) >= 14
    assert all(np.ptp(line, axis=0)[:2].max() < 0.01 for line in (lines[k] for k in range(len(lines))))


@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize("noise", [0.0, 1e-9])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_planes_balls_and_cubes_have_none_and_say_so(noise, offset):
    random = np.random.default_rng(1)
    x, y = np.meshgrid(np.linspace(-1, 1, 12), np.linspace(-1, 1, 12), indexing="ij")
    shaken = np.stack([x, y, 0.0 * x], axis=-1) + 0.03 * random.normal(size=(*x.shape, 3)) * (1.0, 1.0, 0.0)
    turned = shaken @ np.linalg.qr(random.normal(size=(3, 3)))[0] + offset + noise * random.normal(size=shaken.shape)
    ball = features.polygonized(implicit_sphere(1.0), 8)
    for mesh in (features.mesh_of_grid(turned), Mesh(ball.vertices + offset, ball.corners, ball.offsets), CUBE):
        for field in (PrincipalDirections(1), AsymptoticDirections(1)):
            known = np.isfinite(field.tangents(features.face_sites(mesh))[0]).all(axis=1)
            # Some faces of a shaken plane happen to bend as one; a ball of triangles has some hundred of its own.
            assert known.mean() <= (0.1 if noise > 0.0 or mesh.face_count > 200 else 0.0)


@pytest.mark.slow
def test_a_plate_says_that_it_has_none_in_files_and_hatched():
    with pytest.warns(InputWarning, match="PLATE: no lines of curvature: it is flat, or round as a ball") as told:
        vp.draw(parse_scene("PLATE box 3 2 0.1 curvature_lines 1\n"), "iso", lines="integral")
    assert len(told) == 1
    # Where there are none strokes follow what is level.
    combed = vp.draw(parse_scene("PLATE gray box 3 2 0.1 hatch even along curvature spacing 4\n"), "iso", lines="none")
    found = [paths.points3d for layer in combed.layers for paths in layer.strokes if len(paths)]
    assert len(found) and all(len(points) > 20 for points in found)
    for text in ("PLATE box 3 2 0.1 asymptotic_lines 1\n", "PLATE gray box 3 2 0.1 hatch even along asymptotic\n"):
        with pytest.warns(InputWarning, match="PLATE: no asymptotic lines: it is flat, or nowhere saddle-shaped"):
            vp.draw(parse_scene(text), "iso", lines="integral")


@pytest.mark.slow
@pytest.mark.capability("G9.4-polyhedron")
def test_evenly_spaced_ones_follow_their_field_and_end_after_a_round():
    mesh = ring_mesh(16)
    found = evenly_spaced_mesh_curves(mesh, PrincipalDirections(2), 0.5)
    lines = [found[k] for k in range(len(found))]
    assert_integral_curve(lines, mesh, PrincipalDirections(2), 1e-6)
    # Around the tube, and no line more than once.
    long = [np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines]
    assert 20 < len(lines) < 60 and max(long) < 2.0 * TURN and np.median(long) > 0.8 * TURN


@pytest.mark.capability("G9.4-polyhedron")
@pytest.mark.parametrize(("scale", "offset"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e4)])
def test_size_and_place_do_not_matter(scale, offset):
    mesh = sleeve(hyperboloid, 12)
    moved = Mesh(mesh.vertices * scale + offset, mesh.corners, mesh.offsets)
    starts = np.arange(0, mesh.face_count, 9)
    for field in (PrincipalDirections(1), AsymptoticDirections(2)):
        one, other = (mesh_integral_curves(m, field, starts) for m in (mesh, moved))
        assert np.array_equal(one.offsets, other.offsets) and np.array_equal(one.faces, other.faces)
        assert np.abs((other.points - offset) / scale - one.points).max() < (1e-9 if offset == 0.0 else 1e-6)


def test_the_sense_is_kept_where_directions_nearly_follow_an_edge():
    # Two faces whose directions lean to their common edge a little, from both sides: a line follows it, and never turns
    # back.
    flat = Mesh.from_polygons(
        [(0, 0, 0), (4, 0, 0), (4, 1, 0), (0, 1, 0), (4, -1, 0), (0, -1, 0)], [(0, 1, 2, 3), (5, 4, 1, 0)]
    )
    lean = 0.05
    field = UserField(np.array([[(1.0, -lean, 0.0), (-1.0, -lean, 0.0)]]) / np.hypot(1.0, lean))
    line = mesh_integral_curves(flat, field, [0], [(1.0, 0.04, 0.0)], both_ways=False)[0]
    assert (np.diff(line[:, 0]) > 0.0).all() and np.allclose(line[-1], (4.0, 0.0, 0.0), atol=1e-12)


class UserField:
    """What a user's own field gives in faces, whatever it is asked."""

    directed = False

    def __init__(self, given):
        self.given = given

    def tangents(self, sites):
        return self.given


def test_senseless_fields_are_told():
    along = np.stack([np.cross(normal, (0.3, 0.5, 0.7)) for normal in CUBE.face_normals])
    along /= np.linalg.norm(along, axis=1)[:, None]
    half, long, bent = (along[None].copy() for _ in range(3))
    half[0, 2, 1], long[0, 3], bent[0, 4] = np.nan, 2.0 * long[0, 3], CUBE.face_normals[4]
    for given, cause in (
        (along, r"directions are float64 \(6, 3\), expected real \(j, 6, 3\)"),
        (along[None, :5], r"float64 \(1, 5, 3\), expected real \(j, 6, 3\)"),
        (np.zeros((0, 6, 3)), r"expected real \(j, 6, 3\)"),
        (along[None] * 1j, "complex128"),
        (half, "direction of face 2 is not finite"),
        (np.full((1, 6, 3), np.inf), "direction of face 0 is not finite"),
        (long, "direction of face 3 is not of length one"),
        (bent, "direction of face 4 is not in its plane"),
    ):
        with pytest.raises(InputError, match=cause):
            mesh_integral_curves(CUBE, UserField(given), 0)
        with pytest.raises(InputError, match=cause):
            FaceFieldFlow(mesh_sides(CUBE), given, False)
    assert len(mesh_integral_curves(CUBE, UserField(np.full((1, 6, 3), np.nan)), 0)) == 0
    with pytest.raises(InputError, match="a crease angle of 200 degrees"):
        mesh_integral_curves(CUBE, PrincipalDirections(), 0, crease_angle_deg=200.0)
    with pytest.raises(InputError, match="planes of faces do not say how a mesh bends"):
        PrincipalDirections().tangents(FaceSites(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::vectorplot.errors.InputWarning")
@pytest.mark.parametrize("name", ["spot", "fandisk"])
def test_models_have_lines_on_what_bends_and_none_on_what_is_flat(name):
    path = MODELS / f"{name}.obj"
    if not path.is_file():
        pytest.skip("no models")
    mesh = vp.read(path).items[0].mesh
    extent = np.ptp(mesh.bounds, axis=0).max()
    lines = evenly_spaced_mesh_curves(mesh, PrincipalDirections(1), 0.05 * extent)
    assert len(lines) > 40
    # The one is round but for what its coarse faces leave open, the other is made of planes and of what is rolled.
    known = np.isfinite(PrincipalDirections(1).tangents(features.face_sites(mesh))[0]).all(axis=1)
    area = np.linalg.norm(mesh.area_vectors, axis=1)
    share = area[known].sum() / area.sum()
    assert share > 0.6 if name == "spot" else 0.05 < share < 0.6
