"""Double curves of meshes in one piece that pierce themselves, and of those that do not."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.features import mesh_intersections
from vectorplot.features.mesh_edge_lines import Faces
from vectorplot.features.mesh_intersections import self_intersections_of_parts
from vectorplot.geometry import box
from vectorplot.geometry.mesh import Mesh

TURN = 2.0 * np.pi


def net(points, columns, rows, *, first=0.0, closed_v=True, quads=False):
    """A net of triangles, or of rectangles, over u and v in 0 to TURN, u closed, from some first u on."""
    u = first + np.linspace(0.0, TURN, columns, endpoint=False)
    v = np.linspace(0.0, TURN, rows, endpoint=not closed_v)
    places = np.stack(np.broadcast_arrays(*points(*np.meshgrid(u, v, indexing="ij"))), axis=-1).reshape(-1, 3)
    at = np.arange(columns * rows).reshape(columns, rows)
    a, b = at, np.roll(at, -1, axis=0)
    c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
    ways = [(a, b, c, d)] if quads else [(a, b, c), (a, c, d)]
    rows_used = slice(None) if closed_v else slice(None, -1)
    faces = np.concatenate([np.stack([w[:, rows_used].ravel() for w in way], axis=1) for way in ways])
    return Mesh(places, faces.ravel(), np.arange(0, faces.size + 1, faces.shape[1]))


def met(mesh, *, tolerance=1e-9):
    faces = Faces(
        mesh.vertices.T,
        mesh.corners,
        mesh.offsets,
        np.zeros(len(mesh.corners), bool),
        np.ones(mesh.face_count, np.int8),
    )
    return self_intersections_of_parts(faces, np.zeros(mesh.face_count, dtype=np.intp), tolerance)


def length(found):
    return np.linalg.norm(found.end - found.start, axis=0).sum()


def welded(mesh):
    places, number = np.unique(
        np.round(mesh.vertices, 9) @ [[1, 0, 0], [0, 1, 0], [0, 0, 1]] + 0.0, axis=0, return_inverse=True
    )
    return Mesh(places, number.ravel()[mesh.corners], mesh.offsets)


def eight(u, v):
    return (3 + np.sin(u)) * np.cos(v), (3 + np.sin(u)) * np.sin(v), np.sin(2 * u) / 2


def eight_along_a_line(u, v):
    return np.sin(u), np.sin(2 * u) / 2, v


def klein_bottle(u, v):
    arm = 2 + np.cos(v / 2) * np.sin(u) - np.sin(v / 2) * np.sin(2 * u)
    return arm * np.cos(v), arm * np.sin(v), np.sin(v / 2) * np.sin(u) + np.cos(v / 2) * np.sin(2 * u)


@pytest.mark.capability("G8.4-selfint")
@pytest.mark.parametrize("columns", [30, 31, 80, 81])
@pytest.mark.parametrize("first", [0.0, 0.0137])
@pytest.mark.parametrize("weld", [False, True])
def test_figure_eight_turned_about_an_axis_meets_itself_in_a_ring(columns, first, weld):
    """Its double curve goes through faces, along edges of one of the two surfaces, or of both, of the same vertices."""
    mesh = net(eight, columns, 60, first=first)
    found = met(welded(mesh) if weld else mesh)
    step = TURN / columns
    assert length(found) == pytest.approx(3 * TURN, rel=0.01)
    assert np.abs(np.hypot(*found.start[:2]) - 3.0).max() < step**2 + 0.01 and np.abs(found.start[2]).max() < step**2


@pytest.mark.capability("G8.4-selfint")
@pytest.mark.parametrize("columns", [12, 13])
def test_figure_eight_of_rectangles_meets_itself_in_a_line(columns):
    found = met(net(eight_along_a_line, columns, 5, closed_v=False, quads=True))
    assert length(found) == pytest.approx(TURN, rel=1e-9) and np.abs(found.start[:2]).max() < 1e-9


@pytest.mark.capability("G8.4-selfint")
def test_a_surface_that_crosses_itself_at_a_right_angle_draws_where():
    """Figure 8 (Klein) bottle, cut open along a circle: the double curve is the circle of radius 2."""
    found = met(net(klein_bottle, 41, 60, closed_v=False))
    assert length(found) == pytest.approx(2 * TURN, rel=0.01)
    assert np.abs(np.hypot(*found.start[:2]) - 2.0).max() < 0.02


@pytest.mark.capability("G8.4-selfint")
def test_patches_leave_out_no_pair_that_pierces(monkeypatch):
    def knot(u, v):
        """A tube about a trefoil, too thick for it."""
        x, y, z = np.sin(v) + 2 * np.sin(2 * v), np.cos(v) - 2 * np.cos(2 * v), -np.sin(3 * v)
        way = np.stack([np.cos(v) + 4 * np.cos(2 * v), -np.sin(v) + 4 * np.sin(2 * v), -3 * np.cos(3 * v)])
        side = np.stack([-way[1], way[0], 0 * x]) / np.hypot(way[0], way[1])
        over = np.cross(way, side, axis=0)
        over /= np.linalg.norm(over, axis=0)
        return tuple(np.stack([x, y, z]) + 1.1 * (np.cos(u) * side + np.sin(u) * over))

    mesh = net(knot, 25, 160)
    large = met(mesh)
    assert mesh.face_count > 10 * mesh_intersections.FEW_FACES
    monkeypatch.setattr(mesh_intersections, "FEW_FACES", mesh.face_count)
    small = met(mesh)
    assert len(large.one) == len(small.one) > 100 and length(large) == pytest.approx(length(small), rel=1e-12)


def tetrahedron_and_twin():
    """Every triangle twice, once with each side outside, as in files for programs that show one side only."""
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    both = np.array(faces + [face[::-1] for face in faces])
    return Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]), both.ravel(), np.arange(0, 25, 3))


def roof_with_a_middle_vertex():
    """The ridge of a roof is one edge on one side, two on the other."""
    points = [[0, 0, 1], [2, 0, 1], [1, 0, 1], [0, -1, 0], [2, -1, 0], [0, 1, 0], [2, 1, 0], [1, 1, 0.0]]
    faces = [[0, 3, 4, 1], [0, 2, 7, 5], [2, 1, 6, 7]]
    return Mesh(np.array(points), np.concatenate(faces), np.array([0, 4, 8, 12]))


@pytest.mark.parametrize(
    "mesh",
    [
        box((1, 2, 3)),
        net(lambda u, v: ((3 + np.cos(u)) * np.cos(v), (3 + np.cos(u)) * np.sin(v), np.sin(u)), 20, 90),
        net(lambda u, v: ((3 + np.cos(u)) * np.cos(v), (3 + np.cos(u)) * np.sin(v), np.sin(u)), 9, 13, quads=True),
        net(lambda u, v: (np.cos(u) * (1 - v / TURN), np.sin(u) * (1 - v / TURN), v), 12, 8, closed_v=False),
        tetrahedron_and_twin(),
        roof_with_a_middle_vertex(),
    ],
    ids=["box", "ring", "ring of rectangles", "cone to its apex", "two-sided", "middle vertex"],
)
def test_meshes_that_do_not_pierce_themselves_have_no_double_curve(mesh):
    assert not len(met(mesh).one)


@pytest.mark.capability("G8.4-selfint")
def test_the_double_curve_of_a_mesh_is_drawn_where_it_is_seen():
    item = vp.Item("A", net(eight_along_a_line, 41, 7, closed_v=False), lines=("intersection",))
    drawing = vp.draw(vp.Scene((item,)), vp.Camera((2, 9, 25), (0, 0, 3), parallel=True), page=vp.Page(100, 100, 5))
    (layer,) = [layer for layer in drawing.layers if "intersection" in layer.name]
    assert len(layer.strokes) == 1
    closed = vp.draw(vp.Scene((vp.Item("A", box((1, 1, 1)), lines=("intersection",)),)))
    assert not any(len(layer.strokes) for layer in closed.layers)
