"""Bodies of revolution: whole and cut, with caps, with points on the axis."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.solids import MAX_ORDER, has_convex_outline, revolution
from vectorplot.geometry.winding import is_closed_oriented
from vectorplot.textbook.polyhedra import body_record, face_constants, neighbour_faces

CONE = [[4, 0, 0], [0, 0, 7]]
CYLINDER = [[2.5, 0, -5], [2.5, 0, 5]]
ROTSWEEP = [[2, 0, -5], [3, 0, -2], [3, 0, 3], [0, 0, 5]]


def counts(mesh):
    record = body_record(mesh)
    return record.vertex_count, record.edge_count, record.face_count


def euler(mesh):
    v, e, f = counts(mesh)
    return v - e + f


def is_planar(mesh):
    heights = np.einsum("ij,ij->i", mesh.face_normals[mesh.corner_face], mesh.vertices[mesh.corners])
    return np.allclose(heights, face_constants(mesh)[mesh.corner_face], atol=1e-12)


@pytest.mark.capability("G3.4-revolution")
@given(st.integers(3, 60), st.integers(2, 9))
def test_counts_of_a_body_whose_meridian_keeps_off_the_axis(order, size):
    meridian = [[1 + (k % 3), 0, k] for k in range(size)]
    body = revolution(meridian, order)
    assert counts(body) == (order * size, order * (2 * size - 1), order * (size - 1) + 2)
    assert is_closed_oriented(body) and is_planar(body)


@pytest.mark.capability("G3.4-revolution")
def test_tv18_cylinder():
    body = revolution(CYLINDER, 40)
    assert counts(body) == (80, 120, 42)
    assert body_record(body).volume == pytest.approx(195.543081300289, rel=1e-14)


@pytest.mark.capability("G3.4-revolution")
def test_tv19_cone_without_zero_length_edges_at_its_tip():
    body = revolution(CONE, 30)
    assert counts(body) == (31, 60, 31)
    assert body_record(body).volume == pytest.approx(116.430546857945, rel=1e-14)
    assert has_convex_outline(body)


@pytest.mark.capability("G3.4-revolution")
def test_a_first_or_inner_point_on_the_axis_is_one_vertex():
    first = revolution([[0, 0, 0], [4, 0, 7]], 30)
    assert counts(first) == (31, 60, 31)
    hourglass = revolution([[1, 0, 0], [0, 0, 1], [1, 0, 2]], 12)
    assert counts(hourglass) == (25, 48, 26)
    spindle = revolution([[0, 0, 0], [1, 0, 1], [0, 0, 2]], 12)
    assert euler(spindle) == 2 and is_closed_oriented(spindle)


@pytest.mark.capability("G3.4-partial")
def test_tv20_rotsweep():
    body = revolution(ROTSWEEP, 20, angle_deg=180)
    assert np.allclose(body.vertices[20 + 7], [1.20508627395891, 2.74731997996517, -2], atol=1e-13)
    assert euler(body) == 2
    assert is_closed_oriented(body) and has_convex_outline(body) and is_planar(body)
    # One flat face holds the first and the last meridian.
    flat = np.isclose(np.abs(body.face_normals[:, 1]), 1.0) & np.isclose(face_constants(body), 0.0)
    assert flat.sum() == 1


@pytest.mark.capability("G3.4-partial")
@given(st.floats(5, 355), st.integers(5, 40))
def test_a_cut_body_is_closed_by_planar_end_faces(angle, order):
    body = revolution(ROTSWEEP, order, angle_deg=angle)
    assert is_closed_oriented(body) and euler(body) == 2 and is_planar(body)
    step = np.radians(angle) / (order - 1)
    r, z = np.array(ROTSWEEP)[:, 0], np.array(ROTSWEEP)[:, 2]
    frusta = (np.diff(z) * (r[:-1] ** 2 + r[:-1] * r[1:] + r[1:] ** 2)).sum() / 3
    assert body_record(body).volume == pytest.approx((order - 1) * np.sin(step) / 2 * frusta, rel=1e-9)


@pytest.mark.capability("G3.4-revolution")
@pytest.mark.parametrize("angle", [360, 180, 100])
def test_a_meridian_that_runs_downwards_gives_the_same_body(angle):
    for meridian in (CYLINDER, CONE, ROTSWEEP):
        up, down = (revolution(m, 12, angle_deg=angle) for m in (meridian, meridian[::-1]))
        assert is_closed_oriented(down) and counts(down) == counts(up)
        assert (
            body_record(down).volume == pytest.approx(body_record(up).volume, rel=1e-12) and body_record(up).volume > 0
        )
        assert np.allclose(np.sort(down.vertices, axis=0), np.sort(up.vertices, axis=0), atol=1e-12)


@pytest.mark.capability("G3.4-caps")
def test_caps_of_a_hollow_body_are_stored_but_not_present():
    body = revolution(CYLINDER, 40, caps=("bottom",))
    assert body.present.tolist() == [True] * 41 + [False]
    assert np.allclose(body.face_normals[-2:], [[0, 0, -1], [0, 0, 1]])
    assert (neighbour_faces(body) >= 0).all()
    # The cone has no top to remove, so its bottom is the last face.
    assert revolution(CONE, 30, caps=("top",)).present.tolist() == [True] * 30 + [False]


def test_a_meridian_that_runs_downwards_is_turned_outwards():
    body = revolution(CYLINDER[::-1], 40)
    assert body_record(body).volume == pytest.approx(195.543081300289, rel=1e-14)


def test_a_closed_meridian_sweeps_a_ring():
    square = [[2, 0, 0], [3, 0, 0], [3, 0, 1], [2, 0, 1], [2, 0, 0]]
    ring = revolution(square, 24)
    assert euler(ring) == 0 and is_closed_oriented(ring)
    assert body_record(ring).volume == pytest.approx(24 * np.sin(2 * np.pi / 24) / 2 * (9 - 4))
    half = revolution(square, 24, angle_deg=180)
    assert euler(half) == 2 and is_closed_oriented(half)


def test_patches_of_a_twisted_meridian_are_triangles():
    body = revolution([[2, 0, 0], [0, 2, 3]], 16)
    assert is_closed_oriented(body) and is_planar(body)
    assert np.count_nonzero(body.face_sizes == 3) == 32


@pytest.mark.hard(68)
@pytest.mark.parametrize("order", [10**9, MAX_ORDER + 1, 2, 0, -5])
def test_hard_68_order_is_bounded_before_anything_is_allocated(order):
    with pytest.raises(InputError, match="order"):
        revolution(CONE, order)


@pytest.mark.hard(68)
def test_hard_68_the_number_of_vertices_is_bounded():
    meridian = np.column_stack([np.ones(1000), np.zeros(1000), np.arange(1000)])
    with pytest.raises(InputError, match="vertices"):
        revolution(meridian, MAX_ORDER)


@pytest.mark.parametrize(
    ("meridian", "angle"),
    [
        ([[0, 0, 0], [0, 0, 1]], 360),
        ([[1, 0, 0]], 360),
        ([[1, 0, 0], [1, 0, 0]], 360),
        ([[1, 0, np.inf], [1, 0, 0]], 360),
        (CONE, 0),
        (CONE, -90),
        (CONE, 361),
        (CONE, float("nan")),
        ([[2, 0, 0], [0, 2, 3]], 90),
    ],
)
def test_what_sweeps_no_body_is_refused(meridian, angle):
    with pytest.raises(InputError):
        revolution(meridian, 12, angle_deg=angle)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_the_axis_is_found_at_every_scale(scale):
    meridian = np.array([[4, 0, 0], [1e-12, 0, 7]]) * scale
    assert counts(revolution(meridian, 30)) == (31, 60, 31)
