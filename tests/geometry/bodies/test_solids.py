"""Boxes, polyhedra by their faces."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import BOTTOM, TOP, box, has_convex_outline, placed, polyhedron, prism, turned_outwards
from vectorplot.geometry.winding import is_closed_oriented, mesh_edges
from vectorplot.textbook.polyhedra import body_record

lengths = st.floats(0.01, 100).flatmap(lambda x: st.sampled_from([x, -x]))


@pytest.mark.capability("G3.5-box")
def test_box_has_a_corner_in_the_origin_and_its_faces_in_the_order_of_the_book():
    body = box((3, 2, 1))
    record = body_record(body)
    assert (record.vertex_count, record.edge_count, record.face_count) == (8, 12, 6)
    assert np.array_equal(body.bounds, [[0, 0, 0], [3, 2, 1]])
    expected = [[0, -1, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, -1], [0, 0, 1]]
    assert np.allclose(body.face_normals, expected, atol=0)
    assert np.array_equal(body.vertices[0], [0, 0, 0])


@pytest.mark.capability("G3.5-box")
def test_a_hollow_box_stores_bottom_and_top_as_absent():
    assert box((1, 1, 1), caps=()).present.tolist() == [True] * 4 + [False, False]
    assert box((1, 1, 1), caps=(BOTTOM,)).present.tolist() == [True] * 5 + [False]
    assert box((1, 1, 1), caps=(TOP,)).present.tolist() == [True] * 4 + [False, True]
    assert is_closed_oriented(box((1, 1, 1), caps=()))


@pytest.mark.capability("G3.5-box")
@pytest.mark.parametrize("seed", range(6))
def test_a_box_placed_anyhow_is_the_box_after_the_map(seed):
    matrix = np.vstack([np.random.default_rng(seed).normal(size=(3, 4)), [0.0, 0.0, 0.0, 1.0]])
    made, moved = box((1, -2, 3), placement=matrix[:3].ravel().tolist()), box((1, -2, 3)).transformed(matrix)
    assert np.allclose(made.vertices, moved.vertices, atol=1e-14) and is_closed_oriented(made)
    assert body_record(made).volume == pytest.approx(6.0 * abs(np.linalg.det(matrix)))


@given(lengths, lengths, lengths)
def test_every_box_is_closed_and_turned_outwards(x, y, z):
    body = box((x, y, z))
    assert body_record(body).volume == pytest.approx(abs(x * y * z), rel=1e-12)
    assert is_closed_oriented(body) and has_convex_outline(body)


@pytest.mark.parametrize("lengths", [(2, 3, 4), (2.0, 3.0, 4.0), (2, 3.0, 4), (10**10, 3, 4)])
@pytest.mark.parametrize("number", [int, float])
def test_whole_numbers_make_the_same_box(lengths, number):
    placement = [number(x) for x in (0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7)]
    made, same = box(lengths, placement=placement), box([*map(float, lengths)], placement=[*map(float, placement)])
    assert made.vertices.dtype == np.float64
    assert (made.vertices == same.vertices).all()
    assert body_record(made).volume == body_record(same).volume


def test_the_unchecked_box_would_pass_the_checks():
    body = box((1, -2, 3), caps=(TOP,))
    checked = Mesh(body.vertices, body.corners, body.offsets, body.present)
    assert checked.vertices is body.vertices and checked.corners is body.corners and checked.offsets is body.offsets
    assert np.array_equal(checked.present, body.present)


@pytest.mark.parametrize("bad", [(0, 1, 1), (1, float("nan"), 1), (1, 1, float("inf")), (1e308, 1e308, 1)])
def test_a_box_without_volume_is_refused(bad):
    with pytest.raises(InputError, match="finite lengths"):
        box(bad)


@pytest.mark.parametrize("which", range(12))
@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf"), 1e308])
def test_a_placement_that_is_not_finite_is_refused_by_boxes_and_meshes_alike(which, bad):
    placement = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    placement[which] = bad
    if bad == 1e308 and which % 4 == 3:
        assert np.isfinite(box((8, 8, 8), placement=placement).vertices).all()
        return
    with pytest.raises(InputError, match="finite"):
        box((8, 8, 8), placement=placement)
    with pytest.raises(InputError, match="finite"), np.errstate(over="ignore", invalid="ignore"):
        placed(box((8, 8, 8)), placement)


@pytest.mark.capability("G3.2-orient")
@given(st.lists(st.booleans(), min_size=6, max_size=6))
def test_faces_of_a_convex_body_may_be_listed_either_way_round(flips):
    body = box((1, 2, 3), placement=(1, 0, 0, 1e6, 0, 1, 0, -1e6, 0, 0, 1, 1e6))
    faces = [face[::-1] if flip else face for face, flip in zip(body.polygons(), flips, strict=True)]
    assert np.allclose(polyhedron(body.vertices, faces).face_normals, body.face_normals, atol=1e-9)


def test_a_body_that_is_not_convex_is_left_as_it_is_listed():
    corner = prism([[0, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0]], [0, 0, 1])
    assert not has_convex_outline(corner)
    assert polyhedron(corner.vertices, corner.polygons()).polygons() == corner.polygons()


def test_nothing_is_turned_in_an_empty_mesh():
    empty = Mesh.from_polygons(np.zeros((0, 3)), [])
    assert turned_outwards(empty).face_count == 0 and has_convex_outline(empty)
    assert len(mesh_edges(empty)) == 0
