from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry import rotations as r

angle = st.floats(-7, 7)
axis = st.tuples(*[st.floats(-5, 5)] * 3).map(np.array).filter(lambda v: np.abs(v).max() > 1e-2)
EX, EY, EZ = np.eye(3)


def rodrigues(points, direction, phi):
    g = direction / np.linalg.norm(direction)
    return points * np.cos(phi) + np.cross(g, points) * np.sin(phi) + np.outer(points @ g, g) * (1 - np.cos(phi))


@pytest.mark.capability("G1.6-rot-xyz")
def test_tv01_three_rotations_in_row_convention():
    point = np.array([1.0, 2.0, 3.0]) @ r.rotation_z(0.3) @ r.rotation_x(-0.5) @ r.rotation_y(1.1)
    assert np.allclose(point, (1.568932603698, 3.37439328305325, 0.389769747849338), rtol=0, atol=1e-12)


@pytest.mark.capability("G1.6-rot-xyz")
def test_quarter_turns_carry_axes_to_axes():
    quarter = np.pi / 2
    assert np.allclose(EX @ r.rotation_z(quarter), EY, atol=1e-15)
    assert np.allclose(EY @ r.rotation_x(quarter), EZ, atol=1e-15)
    assert np.allclose(EZ @ r.rotation_y(quarter), EX, atol=1e-15)


@pytest.mark.capability("G1.5-matmul")
@given(angle, angle, angle)
def test_products_are_associative(a, b, c):
    x, y, z = r.rotation_x(a), r.rotation_y(b), r.rotation_z(c)
    v = np.array([3.0, -1.0, 4.0])
    assert np.allclose((x @ y) @ z, x @ (y @ z), atol=1e-15)
    assert np.allclose((v @ x) @ y, v @ (x @ y), atol=1e-14)
    pool = np.stack([v, 2 * v, -v])
    assert np.allclose(pool @ (x @ y), [p @ x @ y for p in pool], atol=1e-14)
    # Rows times columns, as the source writes them: a row vector is multiplied from the left.
    found, first, second = x @ y, x.tolist(), y.tolist()
    for i in range(3):
        for j in range(3):
            assert found[i, j] == pytest.approx(sum(first[i][k] * second[k][j] for k in range(3)), abs=1e-15)
        assert (v @ x)[i] == pytest.approx(sum(v.tolist()[k] * first[k][i] for k in range(3)), abs=1e-14)
    # All pairs of two batches of matrices at once.
    batches = r.rotation_x([a, b])[:, None] @ r.rotation_y([b, c])
    assert np.allclose(batches[1, 0], r.rotation_x(b) @ r.rotation_y(b), atol=1e-15)


@pytest.mark.capability("G1.5-inverse-rot")
@given(axis, angle)
def test_the_transposed_matrix_turns_back(g, phi):
    matrix = r.rotation_about(g, phi)
    assert np.allclose(matrix @ r.inverse_rotation(matrix), np.eye(3), atol=1e-14)
    many = r.rotation_z(np.linspace(0, 3, 7))
    assert np.allclose(many @ r.inverse_rotation(many), np.eye(3), atol=1e-15)


@pytest.mark.capability("G1.6-rot-axis")
def test_tv02_about_an_axis_through_the_origin():
    point = np.array([3.0, -1.0, 4.0]) @ r.rotation_about((1, 2, 2), 0.7)
    assert np.allclose(point, (4.67707666536128, 0.134951896304995, 2.02650977101436), rtol=0, atol=1e-12)


@pytest.mark.capability("G1.6-rot-axis")
@given(axis, angle)
def test_about_any_axis_as_rodrigues_says(g, phi):
    points = np.array([[3.0, -1.0, 4.0], [0.5, 2.0, -7.0]])
    for direction in (g, EZ, -EZ):
        assert np.allclose(points @ r.rotation_about(direction, phi), rodrigues(points, direction, phi), atol=1e-13)
        # Into the frame e, f, g, about z there, and back.
        frame = r.axis_frame(direction)
        assert np.allclose(frame @ frame.T, np.eye(3), atol=1e-14) and np.linalg.det(frame) > 0
        assert (
            np.allclose(frame[2], np.asarray(direction) / np.linalg.norm(direction), atol=1e-14) and frame[0, 2] == 0.0
        )
        to_frame = frame.T
        about = to_frame @ r.rotation_z(phi) @ np.linalg.inv(to_frame)
        assert np.allclose(r.rotation_about(direction, phi), about, atol=1e-13)


@pytest.mark.capability("G1.6-rot-axis")
@pytest.mark.parametrize("up", [3.0, -0.2, 1e-200])
def test_an_upright_axis_has_a_frame_of_its_own(up):
    frame = r.axis_frame((0.0, 0.0, up))
    assert np.abs(frame).tolist() == np.eye(3).tolist() and frame[0].tolist() == [1.0, 0.0, 0.0]
    assert frame[2, 2] == np.sign(up) and np.linalg.det(frame) == 1.0
    assert np.allclose(EX @ r.rotation_about((0.0, 0.0, up), 0.3), (np.cos(0.3), np.sign(up) * np.sin(0.3), 0.0))


@pytest.mark.capability("G1.6-rot-offset")
def test_tv03_about_an_axis_beside_the_origin():
    point = r.rotated_about_line((3, -1, 4), (1, 1, 0), (1, 2, 2), 0.7)
    assert np.allclose(point, (5.26332699866342, -0.216140624281628, 2.08447712494992), rtol=0, atol=1e-12)
    on_axis = np.array([1.0, 1.0, 0.0]) + np.outer([-2.0, 0.0, 5.0], [1.0, 2.0, 2.0])
    assert np.allclose(r.rotated_about_line(on_axis, (1, 1, 0), (1, 2, 2), 1.9), on_axis, atol=1e-13)


@pytest.mark.capability("G2.4-rot-all")
def test_rotations_of_the_screen_and_all_lights_at_once():
    centres = np.array([[9.0, 3.0, 8.0], [3.0, -8.0, 10.0], [0.0, 0.0, 4.0], [0.0, 0.0, -4.0], [-2.0, 0.0, 0.0]])
    twists = np.array([0.3, 0.0, 0.0, 0.0, 0.0])
    matrices = r.look_rotation(centres, twists)
    assert np.allclose(matrices @ r.inverse_rotation(matrices), np.eye(3), atol=1e-15)
    there = np.einsum("ni,nij->nj", centres, matrices)
    assert np.allclose(there[:, :2], 0.0, atol=1e-14)
    assert np.allclose(there[:, 2], np.linalg.norm(centres, axis=1), rtol=1e-15)
    with pytest.raises(InputError):
        r.look_rotation((0.0, 0.0, 0.0))


@pytest.mark.capability("G2.1-euler")
@given(angle, angle, angle)
def test_euler_angles_give_the_same_frame_again(alpha, beta, gamma):
    frame = r.rotation_z(alpha) @ r.rotation_x(beta) @ r.rotation_z(gamma)
    a, b, c = r.euler_angles(frame)
    assert -np.pi < a <= np.pi and 0 <= b <= np.pi and -np.pi / 2 < c <= 3 * np.pi / 2
    assert np.allclose(r.rotation_z(a) @ r.rotation_x(b) @ r.rotation_z(c), frame, atol=1e-11)
