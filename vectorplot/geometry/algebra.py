"""Products of matrices and small dense systems, many at once, by sums in a fixed order.

BLAS and LAPACK choose their kernels by the processor, so their last bits differ between machines, and between one
matrix and a batch of them. Here every sum goes through its terms one after the other, with additions, multiplications,
divisions and square roots only: the same numbers give the same bits on every machine with IEEE arithmetic, alone or in
a batch.

The matrices of this package have two to a dozen rows or columns; the other axis may be as long as a scene.
"""

from __future__ import annotations

import operator

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.tolerances import ULP

LONG_SUM = 64
"""Sums of more terms than this are left to numpy's own loop, which no processor changes either."""

SMALL_PRODUCT = 256
"""Products with no more entries than this are made with one call a term."""

SWEEPS = 30
"""Jacobi's rotations converge quadratically: five or six sweeps do, whatever the matrix; more than this is a NaN."""


def matmul(a: ArrayLike, b: ArrayLike) -> Floats:
    """The product a @ b of matrices or vectors of floats, with the shapes that `@` takes and gives.

    Entry (i, k) is a[i, 0] b[0, k] + a[i, 1] b[1, k] + ..., added from left to right.
    """
    x, y = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    if x.ndim == 0 or y.ndim == 0 or x.shape[-1] != y.shape[0 if y.ndim == 1 else -2]:
        raise ValueError(f"shapes {x.shape} and {y.shape} have no product")
    if x.ndim == 1:
        if y.ndim == 1:
            if len(x) > LONG_SUM:
                return np.asarray(np.add.reduce(x * y))
            return np.asarray(sum(map(operator.mul, x.tolist(), y.tolist())), dtype=np.float64)
        return np.asarray(_product(x[None], y)[..., 0, :])
    if y.ndim == 1:
        return np.asarray(_product(x, y[:, None])[..., 0])
    return _product(x, y)


def _product(x: Floats, y: Floats) -> Floats:
    count, rows, columns = x.shape[-1], x.shape[-2], y.shape[-1]
    if count == 0:
        return np.zeros((*np.broadcast_shapes(x.shape[:-2], y.shape[:-2]), rows, columns))
    if count > LONG_SUM:
        return np.asarray(np.einsum("...ij,...jk->...ik", x, y))
    if x.ndim > 2 and y.ndim == 2:
        return np.asarray(_product(x.reshape(-1, count), y).reshape(*x.shape[:-1], columns))
    if x.ndim == y.ndim == 2 and rows * columns > SMALL_PRODUCT:
        # Along the longer axis, so that numpy's inner loop is long.
        if rows > columns:
            return np.ascontiguousarray(_long_rows(y.T, x.T).T)
        return _long_rows(x, y)
    total = x[..., :, 0, None] * y[..., None, 0, :]
    for k in range(1, count):
        total += x[..., :, k, None] * y[..., None, k, :]
    return np.asarray(total)


def _long_rows(x: Floats, y: Floats) -> Floats:
    """The product of a low matrix (m,k) and a wide one (k,n), a row at a time."""
    result = np.empty((len(x), y.shape[1]))
    term = np.empty(y.shape[1])
    for row, weights in zip(result, x.tolist(), strict=True):
        np.multiply(y[0], weights[0], out=row)
        for weight, values in zip(weights[1:], y[1:], strict=True):
            np.multiply(values, weight, out=term)
            row += term
    return result


def determinant(matrices: ArrayLike) -> Floats:
    """The determinants (...) of square matrices (..., k, k): of two or three rows by expansion, else by elimination."""
    m = np.asarray(matrices, dtype=np.float64)
    if m.shape[-1] == 2:
        return np.asarray(m[..., 0, 0] * m[..., 1, 1] - m[..., 0, 1] * m[..., 1, 0])
    if m.shape[-1] == 3:
        a, b, c = m[..., 0, :], m[..., 1, :], m[..., 2, :]
        return np.asarray(
            a[..., 0] * (b[..., 1] * c[..., 2] - b[..., 2] * c[..., 1])
            + a[..., 1] * (b[..., 2] * c[..., 0] - b[..., 0] * c[..., 2])
            + a[..., 2] * (b[..., 0] * c[..., 1] - b[..., 1] * c[..., 0])
        )
    reduced, sign = _eliminated(m, np.empty((*m.shape[:-1], 0)))
    return np.asarray(sign * np.multiply.reduce(np.diagonal(reduced, axis1=-2, axis2=-1), axis=-1))


def linear_solution(matrices: ArrayLike, right: ArrayLike) -> Floats:
    """The solutions x of matrix x = right: matrices (..., k, k), right (..., k, n) or, with one matrix, (k,)."""
    m, b = np.asarray(matrices, dtype=np.float64), np.asarray(right, dtype=np.float64)
    if b.ndim == 1:
        return np.asarray(linear_solution(m, b[:, None])[..., 0])
    size = m.shape[-1]
    lead = np.broadcast_shapes(m.shape[:-2], b.shape[:-2])
    reduced, _ = _eliminated(np.broadcast_to(m, (*lead, size, size)), np.broadcast_to(b, (*lead, size, b.shape[-1])))
    diagonal = np.diagonal(reduced, axis1=-2, axis2=-1)
    if (diagonal == 0.0).any():
        raise np.linalg.LinAlgError("singular matrix")
    x = reduced[..., size:]
    for row in range(size - 1, -1, -1):
        for later in range(row + 1, size):
            x[..., row, :] -= reduced[..., row, later, None] * x[..., later, :]
        x[..., row, :] /= diagonal[..., row, None]
    return np.ascontiguousarray(x)


def inverse_matrix(matrices: ArrayLike) -> Floats:
    """The inverses of square matrices (..., k, k); numpy.linalg.LinAlgError where one is exactly singular."""
    m = np.asarray(matrices, dtype=np.float64)
    return linear_solution(m, np.eye(m.shape[-1]))


def banded_solution(bands: Floats, right: Floats) -> Floats:
    """The solution (n,m) of equations with bands (n, 2b+1), row i in columns i-b to i+b, and right sides (n,m); NaN or
    infinity where they are singular. Source: row pivoting, Golub and Van Loan, Matrix Computations, section 4.3.
    """
    count, width = bands.shape
    reach = width // 2
    rows = np.concatenate([bands, np.zeros((reach + 1, width))])
    sides = np.concatenate([right, np.zeros((reach + 1, right.shape[1]))])
    # The rows that have an entry in the column of the step, and all their columns from there on.
    window, beside = np.zeros((reach + 1, width)), sides[: reach + 1].copy()
    for row in range(min(reach + 1, count)):
        window[row, : reach + 1 + row] = rows[row, reach - row :]
    upper, found = np.empty((count, width)), np.zeros((count + width, right.shape[1]))
    with np.errstate(all="ignore"):
        for step in range(count):
            best = int(np.argmax(np.abs(window[:, 0])))
            if best:
                window[[0, best]], beside[[0, best]] = window[[best, 0]], beside[[best, 0]]
            upper[step], found[step] = window[0], beside[0]
            share = window[1:, :1] / window[0, 0]
            window[:-1, :-1], beside[:-1] = window[1:, 1:] - share * window[0, 1:], beside[1:] - share * beside[0]
            window[:, -1] = 0.0
            window[-1], beside[-1] = rows[step + reach + 1], sides[step + reach + 1]
        for step in range(count - 1, -1, -1):
            later = matmul(upper[step, 1:], found[step + 1 : step + width])
            found[step] = (found[step] - later) / upper[step, 0]
    return found[:count]


def _eliminated(m: Floats, right: Floats) -> tuple[Floats, Floats]:
    """(..., k, k + n) matrices and right sides after elimination with row pivoting; (...) signs of the row orders."""
    work = np.concatenate([m, right], axis=-1)
    size = m.shape[-1]
    sign = np.ones(m.shape[:-2])
    for step in range(size):
        # NaN is no pivot: argmax would choose it, and it stays in its row all the same.
        best = step + np.argmax(np.nan_to_num(np.abs(work[..., step:, step])), axis=-1)
        chosen = np.take_along_axis(work, best[..., None, None], axis=-2)[..., 0, :]
        np.put_along_axis(work, best[..., None, None], work[..., step, None, :], axis=-2)
        work[..., step, :] = chosen
        sign = np.where(best == step, sign, -sign)
        pivot = chosen[..., step]
        share = np.divide(
            work[..., step + 1 :, step],
            pivot[..., None],
            where=pivot[..., None] != 0.0,
            out=np.zeros((*m.shape[:-2], size - step - 1)),
        )
        work[..., step + 1 :, step:] -= share[..., None] * chosen[..., None, step:]
    return work, sign


def symmetric_eigen(matrices: ArrayLike) -> tuple[Floats, Floats]:
    """The eigenvalues (..., k), ascending, and orthonormal eigenvectors (..., k, k), as columns, of symmetric matrices.

    By cyclic Jacobi rotations, all matrices at once. Vectors to equal values depend on the rounding of the matrix; of a
    diagonal matrix they are the axes.
    """
    a = np.array(matrices, dtype=np.float64)
    size = a.shape[-1]
    vectors = np.broadcast_to(np.eye(size), a.shape).copy()
    for _ in range(SWEEPS):
        largest = 0.0
        for p in range(size - 1):
            for q in range(p + 1, size):
                off, low, high = a[..., p, q].copy(), a[..., p, p].copy(), a[..., q, q].copy()
                # A rotation that changes neither diagonal element is done with.
                idle = ~(np.abs(off) > 0.125 * ULP * np.minimum(np.abs(low), np.abs(high))) | (off == 0.0)
                largest = max(largest, float(np.max(np.where(idle, 0.0, 1.0), initial=0.0)))
                cosine, sine = _rotation(np.where(idle, 0.0, off), high - low)
                _turn(a, p, q, cosine, sine)
                a = np.swapaxes(a, -1, -2)
                _turn(a, p, q, cosine, sine)
                a = np.swapaxes(a, -1, -2)
                a[..., p, q] = a[..., q, p] = np.where(idle, off, 0.0)
                _turn(vectors, p, q, cosine, sine)
        if largest == 0.0:
            break
    values = np.diagonal(a, axis1=-2, axis2=-1)
    order = np.argsort(values, axis=-1, kind="stable")
    return np.take_along_axis(values, order, axis=-1), np.take_along_axis(vectors, order[..., None, :], axis=-1)


def _rotation(off: Floats, difference: Floats) -> tuple[Floats, Floats]:
    """Cosine and sine of the smaller angle that takes an off-diagonal element to zero; (1, 0) where it is zero."""
    with np.errstate(over="ignore"):
        half = difference / np.where(off == 0.0, 1.0, 2.0 * off)
        tangent = np.where(half < 0.0, -1.0, 1.0) / (np.abs(half) + np.sqrt(half * half + 1.0))
    tangent = np.where(off == 0.0, 0.0, tangent)
    cosine = 1.0 / np.sqrt(tangent * tangent + 1.0)
    return cosine, tangent * cosine


def _turn(a: Floats, p: int, q: int, cosine: Floats, sine: Floats) -> None:
    """Columns p and q of (..., m, k), turned in place."""
    x, y = a[..., p].copy(), a[..., q].copy()
    a[..., p] = cosine[..., None] * x - sine[..., None] * y
    a[..., q] = sine[..., None] * x + cosine[..., None] * y


def singular_decomposition(matrices: ArrayLike) -> tuple[Floats, Floats, Floats]:
    """The thin singular value decomposition u (..., m, r), s (..., r), descending, v (..., r, n) of (..., m, n).

    r is the smaller of m and n, and matrix = u diag(s) v, as numpy.linalg.svd gives it without full matrices; by
    one-sided Jacobi rotations (Hestenes 1958). Columns of u (rows of v where m < n) to zero values are zero vectors.
    """
    m = np.array(matrices, dtype=np.float64)
    if m.shape[-2] < m.shape[-1]:
        left, sizes, right = singular_decomposition(np.swapaxes(m, -1, -2))
        return np.swapaxes(right, -1, -2), sizes, np.swapaxes(left, -1, -2)
    count = m.shape[-1]
    turned = np.broadcast_to(np.eye(count), (*m.shape[:-2], count, count)).copy()
    for _ in range(SWEEPS):
        busy = False
        for p in range(count - 1):
            for q in range(p + 1, count):
                x, y = m[..., p], m[..., q]
                low, high, off = _summed(x * x), _summed(y * y), _summed(x * y)
                idle = ~(off * off > ULP * ULP * low * high)
                busy = busy or not bool(idle.all())
                cosine, sine = _rotation(np.where(idle, 0.0, off), high - low)
                _turn(m, p, q, cosine, sine)
                _turn(turned, p, q, cosine, sine)
        if not busy:
            break
    sizes = np.sqrt(_summed(np.swapaxes(m, -1, -2) ** 2))
    order = np.argsort(-sizes, axis=-1, kind="stable")
    sizes = np.take_along_axis(sizes, order, axis=-1)
    m, turned = (np.take_along_axis(each, order[..., None, :], axis=-1) for each in (m, turned))
    return m / np.where(sizes > 0.0, sizes, 1.0)[..., None, :], sizes, np.swapaxes(turned, -1, -2)


def _summed(values: Floats) -> Floats:
    """Sums along the last axis, in an order that only its length decides."""
    return np.asarray(np.add.reduce(np.ascontiguousarray(values), axis=-1))


def pseudo_inverse(matrices: ArrayLike, *, rcond: float) -> Floats:
    """The Moore-Penrose inverses (..., n, m) of (..., m, n); singular values below rcond of the largest are zero."""
    left, sizes, right = singular_decomposition(matrices)
    kept = sizes > rcond * sizes[..., :1]
    scaled = np.where(kept, 1.0, 0.0) / np.where(kept, sizes, 1.0)
    return matmul(np.swapaxes(right, -1, -2) * scaled[..., None, :], np.swapaxes(left, -1, -2))


def least_squares(matrix: ArrayLike, right: ArrayLike, *, rcond: float) -> tuple[Floats, int]:
    """The shortest x (n) or (n,k) with least |matrix x - right| for a matrix (m,n), and the rank of the matrix.

    Singular values below rcond of the largest count as zero.
    """
    left, sizes, turned = singular_decomposition(matrix)
    kept = sizes > rcond * sizes[:1]
    onto = matmul(left.T[kept], right)
    return matmul(turned[kept].T / sizes[kept], onto), int(np.count_nonzero(kept))
