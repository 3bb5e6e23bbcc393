"""Limit surfaces of subdivision: B-splines on regular cages, limit masks elsewhere, the same from finer cages."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

import vectorplot as vp
from vectorplot import geometry
from vectorplot.surfaces import SplineSurface, SubdivisionSurface
from vectorplot.surfaces.subdivision import SCHEMES, _catmull_clark, _loop, _net

BOTH = ("catmull-clark", "loop")
RNG = np.random.default_rng(7)


def grid(columns, rows, triangles=False, noise=0.6):
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0), indexing="ij")
    points = np.stack([x, y, noise * np.random.default_rng(3).random(x.shape)], axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(columns + 1, rows + 1)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    if not triangles:
        return vp.Mesh.from_polygons(points, quads)
    return vp.Mesh.from_triangles(points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))


def fan(scheme, valence):
    """A closed cage in which one vertex, the first, has so many faces; all points shaken."""
    turn = 2.0 * np.pi * np.arange(valence) / valence
    low, middle = (
        np.stack([r * np.cos(turn), r * np.sin(turn), z + 0.0 * turn], axis=1) for r, z in ((1, -1), (1.6, 0))
    )
    points = np.concatenate([[(0.0, 0.0, 1.0)], middle, low, [(0.0, 0.0, -2.0)]])
    points += 0.1 * np.random.default_rng(valence).random(points.shape)
    a, b = 1 + np.arange(valence), 1 + (np.arange(valence) + 1) % valence
    faces = [(0, i, j) for i, j in zip(a, b, strict=True)]
    sides = [(j, i, i + valence, j + valence) for i, j in zip(a, b, strict=True)]
    faces += sides if scheme == "catmull-clark" else [t for w, x, y, z in sides for t in ((w, x, y), (w, y, z))]
    last = len(points) - 1
    return vp.Mesh.from_polygons(points, faces + [(last, j + valence, i + valence) for i, j in zip(a, b, strict=True)])


def finer(cage, scheme, creases=()):
    """The cage after a step of its scheme, and its creases after it."""
    creases = np.asarray(creases, dtype=np.intp).reshape(-1, 2)
    net = (_catmull_clark if scheme == "catmull-clark" else _loop)(_net(cage, creases, cage.vertices))
    points = np.zeros((net.vertices, 3))
    points[net.vertex] = net.points
    size = SCHEMES[scheme]
    ends = np.sort(np.stack([net.vertex[net.corner], net.vertex[net.end]], axis=1)[net.is_cut], axis=1)
    edges, uses = np.unique(ends, axis=0, return_counts=True)
    return vp.Mesh(points, net.vertex[net.corner], np.arange(0, len(net.corner) + 1, size)), edges[uses > 1]


def test_catmull_clark_on_a_grid_is_the_bicubic_b_spline():
    cage = grid(5, 6)
    found = SubdivisionSurface(cage)
    spline = SplineSurface(cage.vertices.reshape(6, 7, 3), np.arange(10.0), np.arange(11.0), 4, 4)
    column, row = (RNG.integers(1, n, 200) for n in (4, 5))
    u, v = RNG.random((2, 200))
    # A face of the grid has its first corner, and u along the first index, where none of its corners is irregular.
    points = found.points(column * 6 + row, u, v)
    assert np.abs(points - spline.points(column + u + 2.0, row + v + 2.0)).max() < 1e-13
    jets = found.jets(column * 6 + row, u, v, 6)
    own = (*spline.partials(column + u + 2.0, row + v + 2.0), *spline.second_partials(column + u + 2.0, row + v + 2.0))
    assert np.abs(jets[:, 1:] - np.stack(own, axis=1)).max() < 1e-12


def test_loop_on_a_grid_is_the_quartic_box_spline():
    cage = grid(5, 5, triangles=True)
    found = SubdivisionSurface(cage, "loop")
    # The box spline by its mask on a lattice, step by step, and at last by the mask of its limit.
    fine = cage.vertices.reshape(6, 6, 3)
    steps = 4
    for _ in range(steps):
        size = 2 * (len(fine) - 1) + 1
        spread = np.zeros((size, size, 3))
        spread[::2, ::2] = fine
        padded = np.pad(spread, ((2, 2), (2, 2), (0, 0)))
        mask_of = {(0, 0): 10 / 16} | {k: 6 / 16 for k in ((1, 0), (0, 1), (1, 1), (-1, 0), (0, -1), (-1, -1))}
        mask_of |= {k: 2 / 16 for k in ((1, 2), (2, 1), (1, -1), (-1, -2), (-2, -1), (-1, 1))}
        mask_of |= {k: 1 / 16 for k in ((2, 0), (0, 2), (2, 2), (-2, 0), (0, -2), (-2, -2))}
        fine = sum(w * padded[2 - a : 2 - a + size, 2 - b : 2 - b + size] for (a, b), w in mask_of.items())
    around = ((1, 0), (0, 1), (1, 1), (-1, 0), (0, -1), (-1, -1))
    limit = 0.5 * fine + sum(np.roll(fine, shift, axis=(0, 1)) for shift in around) / 12.0
    many = 2**steps
    i, j = np.meshgrid(np.arange(2 * many, 3 * many), np.arange(2 * many, 3 * many), indexing="ij")
    a, b = (i - 2 * many).ravel() / many, (j - 2 * many).ravel() / many
    # The lower triangle of the face in column 2, row 2 has the corners (2,2), (3,2), (3,3).
    own = a >= b
    points = found.points(np.full(own.sum(), 2 * 5 + 2), (a - b)[own], b[own])
    assert np.abs(points - limit[i, j].reshape(-1, 3)[own]).max() < 1e-12


@pytest.mark.parametrize("valence", [3, 4, 5, 6, 7, 12, 40])
@pytest.mark.parametrize("scheme", BOTH)
def test_irregular_vertices_lie_where_limit_masks_say(scheme, valence):
    cage, creases = finer(fan(scheme, valence), scheme)
    cage, _ = finer(cage, scheme)
    found = SubdivisionSurface(cage, scheme).mesh(1)
    point, normal = found.places[0], found.normals[np.flatnonzero(found.vertex == 0)[0]]
    assert not len(creases)
    ring = vertex_ring(cage, 0)
    edges, across = cage.vertices[ring[0]], cage.vertices[ring[1]]
    n, turn = len(edges), 2.0 * np.pi * np.arange(len(edges)) / len(edges)
    assert n == valence
    centre = cage.vertices[0]
    if scheme == "catmull-clark":
        mask = (n * n * centre + 4.0 * edges.sum(axis=0) + across.sum(axis=0)) / (n * (n + 5.0))
        a = 1.0 + np.cos(2 * np.pi / n) + np.cos(np.pi / n) * np.sqrt(2.0 * (9.0 + np.cos(2 * np.pi / n)))
        waves = [
            (a * f(turn)) @ edges + (f(turn) + f(turn + 2.0 * np.pi / n)) @ across
            for f in (np.cos, lambda t: np.cos(t - np.pi / 2.0))
        ]
    else:
        beta = (0.625 - (0.375 + 0.25 * np.cos(2 * np.pi / n)) ** 2) / n
        omega = 3.0 / (8.0 * beta)
        mask = (omega * centre + edges.sum(axis=0)) / (omega + n)
        waves = [np.cos(turn) @ edges, np.sin(turn) @ edges]
    assert np.abs(point - mask).max() < 1e-13
    expected = np.cross(*waves)
    assert np.abs(normal - expected / np.linalg.norm(expected)).max() < 1e-11


def vertex_ring(mesh, vertex):
    """The ends of the edges of a vertex of a closed mesh, counter-clockwise, and the corners across from it."""
    after, across = {}, {}
    for face in mesh.polygons():
        if vertex in face:
            k = face.index(vertex)
            turned = face[k:] + face[:k]
            after[turned[1]], across[turned[1]] = turned[-1], turned[2]
    ring = [next(iter(after))]
    while after[ring[-1]] != ring[0]:
        ring.append(after[ring[-1]])
    return ring, [across[k] for k in ring]


CAGES = {
    "box": (geometry.box((2, 1, 1)), ("catmull-clark",), ()),
    "pyramid": (fan("catmull-clark", 5), ("catmull-clark",), ()),
    "triangles": (fan("loop", 7), BOTH, ()),
    "open": (grid(3, 2), ("catmull-clark",), ()),
    "open triangles": (grid(3, 2, triangles=True), BOTH, ()),
    "one face": (grid(1, 1), ("catmull-clark",), ()),
    "strip": (grid(1, 3), ("catmull-clark",), ()),
    "crease through": (grid(4, 4), ("catmull-clark",), [(10, 11), (11, 12), (12, 13), (13, 14)]),
    "crease that ends": (grid(4, 4), ("catmull-clark",), [(11, 12), (12, 13)]),
    "crease of triangles": (grid(4, 4, triangles=True), BOTH, [(11, 12), (12, 13)]),
    "three creases": (grid(4, 4), ("catmull-clark",), [(12, 13), (12, 7), (12, 11)]),
    "round crease": (geometry.box((1, 1, 1)), ("catmull-clark",), [(4, 5), (5, 6), (6, 7), (7, 4)]),
}


@pytest.mark.parametrize("scheme", BOTH)
@pytest.mark.parametrize("name", CAGES)
def test_a_finer_cage_has_the_same_limit(name, scheme):
    cage, schemes, creases = CAGES[name]
    if scheme not in schemes:
        return
    surface = SubdivisionSurface(cage, scheme, creases)
    step, sharp = finer(cage, scheme, creases)
    other = SubdivisionSurface(step, scheme, sharp)
    cells = 4 if other.patch_count == surface.patch_count else 2
    one, two = surface.mesh(4), other.mesh(cells)
    assert len(one.places) == len(two.places) and len(one.sharp) == len(two.sharp)
    assert cKDTree(two.places).query(one.places)[0].max() < 1e-14 * 10.0
    by_both = [np.concatenate([mesh.places[mesh.vertex], mesh.normals], axis=1) for mesh in (one, two)]
    assert cKDTree(by_both[1]).query(by_both[0])[0].max() < 1e-4
    inner = np.quantile(cKDTree(by_both[1]).query(by_both[0])[0], 0.9)
    assert inner < 1e-12


@pytest.mark.parametrize("scheme", BOTH)
def test_derivatives_are_those_of_points_at_every_level(scheme):
    surface = SubdivisionSurface(fan(scheme, 7), scheme)
    count = 400
    patch = RNG.integers(0, surface.patch_count, count)
    u, v = RNG.random((2, count)) * 0.45 + 0.02
    small = 2.0 ** -RNG.integers(0, 12, count)
    u, v, step = u * small, v * small, 1e-4 * small
    jets = surface.jets(patch, u, v, 6)
    for axis, (du, dv) in enumerate(((step, 0.0), (0.0, step))):
        ahead, back = surface.jets(patch, u + du, v + dv), surface.jets(patch, u - du, v - dv)
        slope = (ahead - back) / (2.0 * step)[:, None, None]
        # Where a step leads over a border between parts third derivatives jump.
        assert np.quantile(np.abs(slope[:, 0] - jets[:, 1 + axis]).max(axis=1), 0.9) < 1e-6
        second = small[:, None] * np.abs(slope[:, 1] - jets[:, 3 + axis])
        assert np.quantile(second.max(axis=1), 0.9) < 1e-5
    assert np.abs(surface.jets(patch, u, v, 1)[:, 0] - jets[:, 0]).max() == 0.0


@pytest.mark.parametrize("scheme", BOTH)
def test_patches_meet_without_a_gap_and_with_one_normal(scheme):
    surface = SubdivisionSurface(fan(scheme, 5), scheme)
    mesh = surface.mesh(4)
    points = surface.points(np.repeat(mesh.patch, 3), *mesh.parameters.reshape(-1, 2).T)
    normals = surface.normals(np.repeat(mesh.patch, 3), *mesh.parameters.reshape(-1, 2).T)
    corners = mesh.triangles.ravel()
    assert np.abs(points - mesh.places[mesh.vertex[corners]]).max() < 1e-14 * 10.0
    assert np.abs(normals - mesh.normals[corners]).max() < 1e-11
    assert vp.Mesh.from_triangles(mesh.places, mesh.vertex[mesh.triangles]).is_closed and not len(mesh.sharp)


def test_borders_and_creases_are_cubic_b_splines():
    cage, line = grid(4, 4), [10, 11, 12, 13, 14]
    creased = SubdivisionSurface(cage, creases=list(pairwise(line))).mesh(8)
    rows = np.unique(creased.sharp)
    for vertices in (line, [0, 1, 2, 3, 4]):
        ends = cage.vertices[vertices]
        controls = np.concatenate([[2.0 * ends[0] - ends[1]], ends, [2.0 * ends[-1] - ends[-2]]])
        t = np.linspace(0.0, 4.0, 33)
        k = np.minimum(t.astype(int), 3)
        r = (t - k)[:, None]
        terms = [(1 - r) ** 3, 3 * r**3 - 6 * r**2 + 4, -3 * r**3 + 3 * r**2 + 3 * r + 1, r**3]
        curve = sum(w * controls[k + i] for i, w in enumerate(terms)) / 6.0
        assert cKDTree(creased.places[rows]).query(curve)[0].max() < 1e-13


def test_pieces_stay_together_where_they_touch():
    cube = geometry.box((1, 1, 1))
    for shift, common in (((1, 1, 1), 1), ((1, 1, 0), 2)):
        points = np.concatenate([cube.vertices, cube.vertices + shift])
        own, number = np.unique(points, axis=0, return_inverse=True)
        faces = [[int(number.ravel()[k + 8 * n]) for k in face] for n in (0, 1) for face in cube.polygons()]
        cage = vp.Mesh.from_polygons(own, faces)
        found = SubdivisionSurface(cage).mesh(4)
        assert len(own) == 16 - common
        whole = vp.Mesh.from_triangles(found.places, found.vertex[found.triangles])
        assert whole.pieces[0] == 1 and whole.is_closed
        touching = np.intersect1d(*number.reshape(2, 8))
        assert len(touching) == common
        assert np.abs(found.places[touching] - own[touching]).max() < 1e-12, "such vertices stay"


def test_isolated_vertices_are_left_out_and_an_empty_cage_is_empty():
    cage = geometry.box((1, 1, 1))
    more = vp.Mesh(np.concatenate([[(50.0, 0.0, 0.0)], cage.vertices]), cage.corners + 1, cage.offsets)
    one, two = SubdivisionSurface(cage).mesh(2), SubdivisionSurface(more).mesh(2)
    assert np.abs(one.places - two.places).max() < 1e-12
    none = SubdivisionSurface(vp.Mesh.from_polygons(np.zeros((0, 3)), [])).mesh(3)
    assert not len(none.triangles)


@pytest.mark.parametrize("far", [(1e6, -1e6, 1e6), (0.0, 0.0, 0.0)])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_large_small_and_far_cages_have_the_same_limit(size, far):
    cage = fan("catmull-clark", 5)
    own = SubdivisionSurface(cage).mesh(4)
    moved = SubdivisionSurface(cage.scaled(size).moved(*(size * np.array(far)))).mesh(4)
    rounding = 1e-12 if not any(far) else 1e-9
    assert np.abs(moved.places / size - far - own.places).max() < rounding
    assert np.abs(moved.normals - own.normals).max() < 1e6 * rounding


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({"scheme": "lop"}, "subdivision.*'lop'.*loop"),
        ({"scheme": "loop"}, "face 1 has 4 corners, loop takes triangles"),
        ({"creases": [(0, 6)]}, "a crease from vertex 1 to 7, where the cage has no edge"),
        ({"creases": [(0, 99)]}, "a crease from vertex 1 to 100"),
        ({"creases": [0.5, 1.0]}, "pairs of vertices"),
        ({"crease_angle_deg": float("nan")}, "crease angle of nan"),
    ],
)
def test_wrong_input_is_said_in_one_line(change, cause):
    with pytest.raises(vp.InputError, match=cause):
        SubdivisionSurface(geometry.box((1, 1, 1)), **change).mesh(1)


def test_a_face_that_comes_back_to_a_vertex_and_a_vertex_of_thousands_are_refused():
    points = np.zeros((4, 3))
    points[1:] = np.eye(3)
    with pytest.raises(vp.InputError, match="face 1 comes to a vertex twice"):
        SubdivisionSurface(vp.Mesh.from_polygons(points, [(0, 1, 0, 2)])).mesh(1)
    turn = np.linspace(0.0, 2.0 * np.pi, 2001)[:-1]
    rim = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    faces = np.stack([np.full(2000, 2000), np.arange(2000), (np.arange(2000) + 1) % 2000], axis=1)
    cone = vp.Mesh.from_triangles(np.concatenate([rim, [(0, 0, 1)]]), faces)
    with pytest.raises(vp.InputError, match="a vertex with 2000 faces, expected at most 1024"):
        SubdivisionSurface(cone, "loop").mesh(1)
