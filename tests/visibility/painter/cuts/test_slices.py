"""Orders without comparisons: slices, graphs from everywhere, rings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.painted import wrong_points
from support.strewn import placed

from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box, numbered, scene_of, torus_mesh
from vectorplot.textbook.orders import graph_order, graph_triangles, ring_order, sliced_meridian
from vectorplot.visibility.painter.face_splitting import cut_into_slices, eye_coordinate, slice_order, sliced_order
from vectorplot.visibility.painter.image_faces import image_faces, image_points, polygons_of
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.painter.topological_order import Precedence


def graph_mesh(x, y, heights):
    points = np.stack([*np.meshgrid(x, y, indexing="ij"), heights], axis=-1).reshape(-1, 3)
    return Mesh.from_triangles(points, graph_triangles(len(x) - 1, len(y) - 1))


X = np.sort(np.concatenate([np.linspace(-1.0, 1.0, 12), [0.05, 0.31]]))
Y = np.linspace(-0.7, 0.9, 11)
HEIGHTS = 0.5 * np.sin(5.0 * X)[:, None] * np.cos(6.0 * Y + 1.0) + 0.2 * X[:, None]

EYES = [
    (x, y, z)
    for x in (-2.5, 0.123, 2.5)
    for y in (-2.5, 0.217, 2.6)
    for z in (1.1, 3.5, -2.8)
    if not (x == 0.123 and y == 0.217 and z == 1.1)
]


@pytest.mark.capability("G5.4-graph")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("eye", EYES)
def test_graphs_from_all_nine_sectors_overhead_and_below(eye):
    view = look(scene_of(GRAPH=graph_mesh(X, Y, HEIGHTS)), Camera(eye, (0.02, 0.03, 0.0)))
    assert wrong_points(view, image_faces(view, graph_order(X, Y, eye))) == 0


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, -1, 0.3), (0, 0, 1), (1, 2, 1), (-1, 0.4, -2), (-1, -1, 0.5)])
def test_graphs_in_parallel_projection(direction):
    view = look(
        scene_of(GRAPH=graph_mesh(X, Y, HEIGHTS)), Camera(tuple(3.0 * np.array(direction)), (0, 0, 0), parallel=True)
    )
    assert wrong_points(view, image_faces(view, graph_order(X, Y, (*direction, 0)))) == 0


def test_a_graph_from_within_its_box():
    eye = (0.1, 0.2, float(HEIGHTS.max()) - 0.05)
    view = look(scene_of(GRAPH=graph_mesh(X, Y, HEIGHTS)), Camera(eye, (1.0, 0.5, 0.0), fov_deg=90))
    assert wrong_points(view, image_faces(view, graph_order(X, Y, eye))) == 0


def test_every_triangle_of_a_graph_once_and_a_wrong_eye_shows():
    order = graph_order(X, Y, (2.0, 1.0, 1.0))
    assert sorted(order.tolist()) == list(range(2 * (len(X) - 1) * (len(Y) - 1)))
    view = look(scene_of(GRAPH=graph_mesh(X, Y, HEIGHTS)), Camera((2.5, 2.5, 1.0), (0, 0, 0)))
    assert wrong_points(view, image_faces(view, graph_order(X, Y, (-2.5, -2.5, 1.0)))) > 10


def test_slices_towards_the_eye():
    levels = [0.0, 1.0, 2.0, 3.0]
    assert slice_order(levels, -1.0).tolist() == [2, 1, 0]
    assert slice_order(levels, 1.5).tolist() == [0, 2, 1]
    assert slice_order(levels, 9.0).tolist() == [0, 1, 2]
    assert slice_order(levels, np.inf).tolist() == [0, 1, 2]
    assert slice_order(levels, -np.inf).tolist() == [2, 1, 0]
    assert sorted(slice_order(levels, 1.0).tolist()) == [0, 1, 2]
    with pytest.raises(InputError, match="ascend"):
        slice_order([0.0, 1.0, 1.0], 0.5)
    with pytest.raises(InputError, match="direction"):
        eye_coordinate((0, 0, np.nan), 2)


def test_cut_into_slices():
    mesh = torus_mesh(14, 8)
    levels = np.linspace(-0.7, 0.75, 6)
    pieces, source, number = cut_into_slices(mesh.vertices[mesh.corners], mesh.offsets, 2, levels)
    ends = np.concatenate([[-np.inf], levels, [np.inf]])
    z, of = pieces.points[:, 2], np.repeat(number, np.diff(pieces.offsets))
    assert ((z >= ends[of]) & (z <= ends[of + 1])).all()
    assert (np.diff(pieces.offsets) >= 3).all()

    def areas(points, offsets):
        starts = np.repeat(offsets[:-1], np.diff(offsets))
        after = np.arange(1, len(points) + 1)
        after[offsets[1:] - 1] = offsets[:-1]
        product = np.cross(points - points[starts], points[after] - points[starts])
        return np.linalg.norm(np.add.reduceat(product, offsets[:-1], axis=0), axis=1)

    whole = areas(mesh.vertices[mesh.corners], mesh.offsets)
    assert np.abs(np.bincount(source, areas(pieces.points, pieces.offsets)) - whole).max() < 1e-12
    flat = np.array([(0.0, 0, 1), (1, 0, 1), (0, 1, 1)])
    assert cut_into_slices(flat, np.array([0, 3]), 2, [0.0, 1.0, 2.0])[2].tolist() == [2]
    assert len(cut_into_slices(flat[:0], np.array([0]), 2, [0.0])[1]) == 0


@pytest.mark.capability("G5.4-graph-horizontal")
@pytest.mark.parametrize("seed", range(6))
def test_surfaces_in_horizontal_slices(seed):
    random = np.random.default_rng(seed)
    around, out = np.meshgrid(np.linspace(0, 2 * np.pi, 19)[:-1], np.linspace(0.1, 1.0, 8), indexing="ij")
    disc = np.stack([out * np.cos(around), out * np.sin(around), 0.4 * np.sin(4 * out + 2 * around)], axis=-1)
    corner = np.arange(18)[:, None] * 8 + np.arange(7)
    after = (np.arange(18)[:, None] + 1) % 18 * 8 + np.arange(7)
    halves = [
        np.stack(t, axis=-1).reshape(-1, 3) for t in ((corner, corner + 1, after + 1), (corner, after + 1, after))
    ]
    shape = Mesh.from_triangles(disc.reshape(-1, 3), np.concatenate(halves))
    shape = placed(torus_mesh(16, 9), random) if seed % 2 else shape
    view = look(numbered([shape]), Camera(tuple(random.uniform(-1, 1, 3) * 6.0), (0, 0, 0)))
    # The slices are horizontal in the world, the faces are those of the view.
    world = view.world_of(view.points)[view.corners]
    levels = np.linspace(world[:, 2].min(), world[:, 2].max(), 7)[1:-1]
    pieces, source, number = cut_into_slices(world, view.offsets, 2, levels)
    eye = view.world_of(view.eye[:, None])[0]
    rank = np.empty(6, dtype=np.intp)
    rank[slice_order(np.concatenate([[-99.0], levels, [99.0]]), eye[2])] = np.arange(6)
    faces = polygons_of(
        image_points(view, view.points_of(pieces.points)), pieces.offsets, np.arange(len(source)), view.tolerance
    )
    ordered = sliced_order(faces, rank[number[faces.source]], view.tolerance)
    assert wrong_points(view, replace(ordered, source=source[ordered.source])) == 0
    assert (np.diff(rank[number[ordered.source]]) >= 0).all()


DOMAINS = {
    "a half ring": lambda t, r: ((0.5 + r) * np.cos(np.pi * t), (0.5 + r) * np.sin(np.pi * t)),
    "a leaf": lambda t, r: (2 * t - 1, (r - 0.5) * np.sin(np.pi * np.clip(t, 0.02, 0.98))),
    "a slanted strip": lambda t, r: (2 * t - 1 + 0.8 * r, r + 0.3 * np.sin(5 * t)),
    "a star": lambda t, r: tuple(
        (0.05 + r * (1 + 0.3 * np.cos(10 * np.pi * t))) * f(1.9 * np.pi * t) for f in (np.cos, np.sin)
    ),
}


@pytest.mark.capability("G5.4-graph-horizontal")
@pytest.mark.spread
@pytest.mark.parametrize("domain", DOMAINS)
@pytest.mark.parametrize("height", [4.0, 0.6, 0.05, -0.4, -5.0])
def test_graphs_over_any_domain_in_horizontal_slices_from_above_below_and_amid_them(domain, height):
    t, r = np.meshgrid(np.linspace(0, 1, 15), np.linspace(0, 1, 7), indexing="ij")
    x, y = DOMAINS[domain](t, r)
    z = 0.5 * np.sin(3.1 * x + 0.4) * np.cos(2.7 * y)
    shape = Mesh.from_triangles(np.stack([x, y, z], axis=-1).reshape(-1, 3), graph_triangles(14, 6))
    view = look(numbered([shape]), Camera((3.0, -4.0, height), (0.1, 0.2, 0.0)))
    world = view.world_of(view.points)[view.corners]
    levels = np.linspace(world[:, 2].min(), world[:, 2].max(), 8)[1:-1]
    pieces, source, number = cut_into_slices(world, view.offsets, 2, levels)
    rank = np.empty(7, dtype=np.intp)
    rank[slice_order(np.concatenate([[-99.0], levels, [99.0]]), height)] = np.arange(7)
    points = image_points(view, view.points_of(pieces.points))
    faces = polygons_of(points, pieces.offsets, np.arange(len(source)), view.tolerance)
    ordered = sliced_order(faces, rank[number[faces.source]], view.tolerance)
    assert wrong_points(view, replace(ordered, source=source[ordered.source])) == 0


MERIDIANS = {
    "vase": [(0, 0), (1.0, 0), (1.3, 0.6), (0.6, 1.4), (0.9, 2.0)],
    "goblet": [(0, 0), (1.0, 0.1), (0.2, 0.4), (0.2, 1.2), (1.2, 1.6), (1.3, 2.2), (1.1, 2.2), (0.9, 1.7), (0, 1.5)],
    "bottle of bottles": [(0.3, 0), (1.5, 0), (1.5, 2.0), (1.0, 2.0), (1.0, 0.5), (0.6, 0.9), (0.6, 1.8), (0, 2.4)],
    "folds": [(1, 0), (1.4, 0.5), (0.7, 0.3), (0.8, 0.9), (1.3, 0.8), (1.2, 1.4), (0.4, 1.2), (0.3, 2.1)],
    "disc": [(0, 1), (0.5, 1), (1, 1)],
}


def revolved(meridian, order):
    angle = 2.0 * np.pi * np.arange(order) / order
    radius, height = meridian[:, :1], meridian[:, 1:]
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height + 0.0 * angle], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(len(meridian) - 1), np.arange(order), indexing="ij")
    after = (j + 1) % order
    quads = np.stack([i * order + j, i * order + after, (i + 1) * order + after, (i + 1) * order + j], axis=-1)
    # On the axis all corners are one.
    first = np.where(
        np.repeat(meridian[:, 0] == 0.0, order), np.arange(len(points)) // order * order, np.arange(len(points))
    )
    return Mesh.from_polygons(points, [list(dict.fromkeys(first[quad].tolist())) for quad in quads.reshape(-1, 4)])


@pytest.mark.capability("G5.2-revolution")
@pytest.mark.spread
@pytest.mark.parametrize("name", MERIDIANS)
@pytest.mark.parametrize(
    "eye",
    [
        (5, 3, 1),
        (4, -1, 5),
        (0.1, 0.2, 6),
        (-2, 1, -4),
        (0.05, 0.1, 1.1),
        (3, 0, 2.0),
        (1.2, 0.3, 1.3),
        (0.8, 0.1, 1.9),
    ],
)
def test_surfaces_of_revolution_by_rings(name, eye):
    meridian = sliced_meridian(MERIDIANS[name])
    shape = revolved(meridian, 14)
    view = look(scene_of(SHAPE=shape), Camera(eye, (0, 0.3, 1.0), fov_deg=60))
    assert view.face_count == shape.face_count
    assert wrong_points(view, image_faces(view, ring_order(meridian, 14, eye)), 500) == 0


@pytest.mark.parametrize("direction", [(1, 2, 1), (1, 0, 0), (0.1, 0, -1), (0, 0, 1)])
def test_surfaces_of_revolution_in_parallel_projection(direction):
    for name in ("goblet", "folds"):
        meridian = sliced_meridian(MERIDIANS[name])
        view = look(
            scene_of(SHAPE=revolved(meridian, 14)), Camera(tuple(9.0 * np.array(direction)), (0, 0, 0), parallel=True)
        )
        assert wrong_points(view, image_faces(view, ring_order(meridian, 14, (*direction, 0))), 500) == 0


def test_a_meridian_that_is_not_sliced_is_refused():
    with pytest.raises(InputError, match="passes the height"):
        ring_order(MERIDIANS["goblet"], 8, (5, 0, 0))
    with pytest.raises(InputError, match="two points"):
        sliced_meridian([(1, 0)])
    with pytest.raises(InputError, match="two points"):
        sliced_meridian([(1, 0), (np.nan, 1)])
    sliced = sliced_meridian(MERIDIANS["goblet"])
    assert sliced_meridian(sliced).tolist() == sliced.tolist()


def test_a_known_order_is_kept_where_nothing_is_between():
    graph, eye = graph_mesh(X, Y, HEIGHTS), (3.0, -4.0, 3.0)
    order = graph_order(X, Y, eye)
    beside, within = box((3, 3, 0), (3.5, 3.5, 0.5)), box((-0.2, -0.2, -0.6), (0.2, 0.2, 1.4))
    for shapes, used in (([graph, beside], True), ([graph, within], False), ([within, graph], False)):
        scene = numbered(shapes)
        view = look(scene, Camera(eye, (0.5, 0.5, 0)))
        number = next(k for k, shape in enumerate(shapes) if shape is graph)
        faces = order + int(np.flatnonzero(view.face_item == number)[0])
        painted = painters_order(view, known={number: Precedence.of_order(faces)})
        assert wrong_points(view, painted.faces) == 0
        own = painted.faces.source[view.face_item[painted.faces.source] == number]
        if used:
            assert own.tolist() == [f for f in faces.tolist() if f in set(own.tolist())]
    with pytest.raises(InputError, match="not its own"):
        painters_order(view, known={1: Precedence.of_order(order[1:])})
    for wrong in (np.append(faces, faces[0]), faces + view.face_count):
        with pytest.raises(InputError, match="names a face twice"):
            painters_order(view, known={number: Precedence.of_order(wrong)})
