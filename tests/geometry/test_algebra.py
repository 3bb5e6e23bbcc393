"""Products and small systems: what numpy says within rounding, and the same bits alone and in a batch."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.algebra import (
    banded_solution,
    determinant,
    inverse_matrix,
    least_squares,
    linear_solution,
    matmul,
    pseudo_inverse,
    singular_decomposition,
    symmetric_eigen,
)

SHAPES = [
    ((3,), (3,)),
    ((3,), (3, 5)),
    ((5, 3), (3,)),
    ((3, 3), (3, 3)),
    ((3, 3), (3, 900)),
    ((900, 3), (3, 3)),
    ((7, 3, 3), (7, 3, 2)),
    ((7, 5, 3), (3, 2)),
    ((3, 3), (9, 3, 4)),
    ((2, 100), (100, 4)),
    ((100,), (100,)),
    ((0, 3), (3, 3)),
    ((4, 0), (0, 2)),
]


@pytest.mark.parametrize(("left", "right"), SHAPES)
def test_products_have_the_shapes_and_values_of_numpy(left, right):
    random = np.random.default_rng(1)
    a, b = random.normal(size=left), random.normal(size=right)
    assert matmul(a, b).shape == (a @ b).shape
    assert np.allclose(matmul(a, b), a @ b, rtol=0.0, atol=1e-13)


def test_products_that_have_no_value_say_so():
    with pytest.raises(ValueError, match="no product"):
        matmul(np.zeros((3, 2)), np.zeros((3, 2)))


@pytest.mark.parametrize("count", [1, 3, 90, 3000])
def test_a_row_is_to_the_last_bit_what_it_is_alone(count):
    random = np.random.default_rng(2)
    points, frames, frame = (
        random.normal(size=(count, 3)),
        random.normal(size=(count, 3, 3)),
        random.normal(size=(3, 3)),
    )
    for one in sorted({0, count // 2, count - 1}):
        assert np.array_equal(matmul(points, frame)[one], matmul(points[one], frame))
        assert np.array_equal(matmul(frame, points.T)[:, one], matmul(frame, points[one]))
        assert np.array_equal(matmul(frames, frame)[one], matmul(frames[one], frame))
        assert np.array_equal(inverse_matrix(frames)[one], inverse_matrix(frames[one]))
        assert determinant(frames)[one] == determinant(frames[one])
        for whole, alone in zip(symmetric_eigen(frames), symmetric_eigen(frames[one]), strict=True):
            assert np.array_equal(whole[one], alone)


@pytest.mark.parametrize("size", [1, 2, 3, 4, 6])
def test_systems_are_solved_to_rounding(size):
    m = np.random.default_rng(size).normal(size=(200, size, size))
    m[0] = np.eye(size)[::-1]  # every pivot is zero at first
    condition = np.linalg.cond(m)[:, None, None]
    assert np.allclose(determinant(m), np.linalg.det(m), rtol=1e-12)
    assert (np.abs(matmul(inverse_matrix(m), m) - np.eye(size)) < 1e-15 * size * condition + 1e-14).all()
    assert np.allclose(linear_solution(m[1], m[1, 0]), np.linalg.solve(m[1], m[1, 0]))
    both = m + np.swapaxes(m, 1, 2)
    values, vectors = symmetric_eigen(both)
    assert np.allclose(values, np.linalg.eigvalsh(both), atol=1e-13)
    assert np.allclose(both @ vectors, values[:, None, :] * vectors, atol=1e-13)
    assert np.allclose(np.swapaxes(vectors, 1, 2) @ vectors, np.eye(size), atol=1e-14)


def test_a_singular_system_is_an_error():
    with pytest.raises(np.linalg.LinAlgError):
        linear_solution([[1.0, 2.0], [2.0, 4.0]], [1.0, 1.0])
    assert determinant([[1.0, 2.0], [2.0, 4.0]]) == 0.0


@pytest.mark.parametrize("shape", [(3, 3), (2, 5), (5, 2), (40, 3), (1, 4)])
def test_singular_values_are_those_of_numpy(shape):
    m = np.random.default_rng(3).normal(size=(20, *shape))
    m[0] = 0.0
    m[1] = np.outer(m[1, :, 0], m[1, 0])  # of rank one
    left, sizes, right = singular_decomposition(m)
    assert np.allclose(sizes, np.linalg.svd(m)[1], atol=1e-13)
    assert np.allclose(left * sizes[:, None] @ right, m, atol=1e-13)
    assert np.allclose(pseudo_inverse(m, rcond=1e-9), np.linalg.pinv(m, rcond=1e-9), atol=1e-10)


def test_least_squares_know_the_rank():
    random = np.random.default_rng(4)
    m, b = random.normal(size=(50, 3)), random.normal(size=(50, 2))
    found, rank = least_squares(m, b, rcond=1e-12)
    assert rank == 3
    assert np.allclose(found, np.linalg.lstsq(m, b, rcond=None)[0])
    m[:, 2] = m[:, 0] + m[:, 1]
    found, rank = least_squares(m, b, rcond=1e-12)
    assert rank == 2
    assert np.allclose(found, np.linalg.lstsq(m, b, rcond=1e-12)[0])


@pytest.mark.parametrize(("count", "reach"), [(1, 0), (1, 2), (5, 1), (40, 3), (7, 6)])
def test_bands_are_solved_as_whole_matrices(count, reach):
    random = np.random.default_rng(count)
    bands = random.normal(size=(count, 2 * reach + 1))
    whole = np.zeros((count, count + 2 * reach))
    for row in range(count):
        whole[row, row : row + 2 * reach + 1] = bands[row]
    whole = whole[:, reach : reach + count]
    right = random.normal(size=(count, 2))
    assert np.allclose(banded_solution(bands, right), np.linalg.solve(whole, right), rtol=1e-8)
    assert not np.isfinite(banded_solution(0.0 * bands, right)).any()
