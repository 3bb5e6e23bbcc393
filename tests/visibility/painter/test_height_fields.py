"""Meshes over grids: their order is right wherever the eye is, and other meshes are none."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.scene import Item, Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box
from vectorplot.textbook.graph_orders import graph_order, graph_triangles
from vectorplot.visibility.painter.height_fields import field_order, known_orders
from vectorplot.visibility.painter.image_faces import image_faces
from vectorplot.visibility.painter.order import painters_order
from vectorplot.visibility.painter.pairs.candidates import box_pairs
from vectorplot.visibility.painter.pairs.face_pairs import drawn_before, face_relations


def field(seed: int, rows: int = 9, columns: int = 6, holes: bool = True) -> Mesh:
    """A rough field over lines at uneven distances; cells cut either way, with holes."""
    random = np.random.default_rng(seed)
    x, y = (np.cumsum(random.uniform(0.2, 1.0, n + 1)) for n in (rows, columns))
    vertices = np.stack([*np.meshgrid(x, y, indexing="ij"), random.uniform(0, 1.5, (rows + 1, columns + 1))], axis=-1)
    number = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    up = random.uniform(size=(rows, columns)) < 0.5
    one = np.where(up[..., None], np.stack([a, b, c], -1), np.stack([a, b, d], -1)).reshape(-1, 3)
    two = np.where(up[..., None], np.stack([a, c, d], -1), np.stack([b, c, d], -1)).reshape(-1, 3)
    triangles = random.permutation(np.concatenate([one, two]))
    kept = triangles[random.uniform(size=len(triangles)) < 0.9] if holes else triangles
    return Mesh.from_triangles(vertices.reshape(-1, 3), kept.ravel())


@pytest.mark.slow
@pytest.mark.capability("G5.4-graph")
@given(st.integers(0, 10**6), st.booleans())
def test_what_is_in_front_comes_later(seed: int, parallel: bool) -> None:
    random = np.random.default_rng(seed)
    mesh = field(seed)
    scene = Scene((Item("F", mesh),))
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    eye = low + random.uniform(-1.0, 2.0, 3) * (high - low) + (0.0, 0.0, 4.0 * random.choice([-1.0, 1.0]))
    view = look(scene, Camera(eye=tuple(eye), target=tuple(0.5 * (low + high)), parallel=parallel))
    order = known_orders(scene, view)[0]
    assert sorted(order.tolist()) == list(range(mesh.face_count))
    place = np.empty(len(order), dtype=np.intp)
    place[order] = np.arange(len(order))
    faces = image_faces(view, np.arange(view.face_count))
    for first, second in box_pairs(faces.box, view.tolerance):
        codes = face_relations(faces, first, second, view.tolerance)
        before, after = drawn_before(faces, first[codes > 0], second[codes > 0], codes[codes > 0])
        assert (place[faces.source[before]] < place[faces.source[after]]).all()
    assert len(painters_order(view, known={0: order})) == len(painters_order(view))


def test_a_graph_has_the_order_of_graphs() -> None:
    x, y = np.linspace(-1, 1, 6), np.linspace(-2, 2, 9)
    grid = np.stack([*np.meshgrid(x, y, indexing="ij"), np.zeros((6, 9))], axis=-1).reshape(-1, 3)
    triangles = graph_triangles(5, 8)
    for eye in ((0.3, -3.0, 2.0), (0.1, 0.2, 3.0), (-1.0, 2.0, 0.5, 0.0)):
        found = field_order(grid, triangles.ravel(), np.full(len(triangles), 3), np.array(eye))
        assert found is not None and found.tolist() == graph_order(x, y, eye).tolist()


@pytest.mark.parametrize("defect", ["turned", "twice", "crossed", "wall", "wide"])
def test_other_meshes_have_no_known_order(defect: str) -> None:
    mesh = field(3, holes=False)
    vertices, triangles = mesh.vertices, mesh.corners.reshape(-1, 3)
    if defect == "turned":
        c, s = np.cos(0.3), np.sin(0.3)
        vertices = vertices @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    elif defect == "twice":
        triangles = np.concatenate([triangles, triangles[:1]])
    elif defect == "crossed":
        corners = np.unique(triangles[:1])
        full = {frozenset(t.tolist()) for t in triangles}
        cell = next(
            set(t) | set(u) for t in full for u in full if t != u and set(corners) == set(t) and len(t & u) == 2
        )
        other = next(
            t
            for t in ([a, b, c] for a in cell for b in cell for c in cell)
            if len(set(t)) == 3 and frozenset(t) not in full
        )
        triangles = np.concatenate([triangles, [other]])
    elif defect == "wall":
        triangles = np.concatenate([triangles, [[0, 1, 1]]])
    else:
        triangles = np.concatenate([triangles, [[0, 2, 15]]])
    assert field_order(vertices, triangles.ravel(), np.full(len(triangles), 3), np.array([1.0, -9.0, 4.0])) is None


def test_solids_and_faces_of_several_sizes_have_no_known_order() -> None:
    scene = Scene(
        (Item("A", box((0, 0, 0), (1, 1, 1))), Item("E", Mesh.from_triangles(np.zeros((0, 3)), np.zeros(0, int))))
    )
    assert known_orders(scene, look(scene, Camera(eye=(3.0, 4.0, 5.0)))) == {}
