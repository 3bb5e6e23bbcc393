"""Arrays of numbers in JSON."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.repair.weld import distinct_points


def plain(numbers: Floats) -> Any:
    """Nested lists of floats, -0 written as 0."""
    return (np.asarray(numbers, dtype=np.float64) + 0.0).tolist()


def point_texts(points: Floats) -> NDArray[np.object_]:
    """(p,) the points (p,2) or (p,3) as JSON lists. Those in one place, as corners of neighbours are, are written out
    once: to find the shortest digits of a number takes longer than all else."""
    space = np.zeros((len(points), 3))
    space[:, : points.shape[1]] = points
    first, number = distinct_points(space)
    one = f"[{', '.join(['%r'] * points.shape[1])}]"
    texts = "\n".join([one] * len(first)) % tuple(plain(points[first].ravel()))
    return np.array(texts.split("\n") if texts else [], dtype=object)[number]


def numbers_of(value: Any, shape: tuple[int, ...], name: str) -> Floats:
    """The lists as an array of the shape, in which -1 stands for any length. Errors: InputError for anything else."""
    try:
        array = np.array(value)
    except ValueError:
        array = np.zeros(0, dtype=np.str_)
    if array.size == 0 and 0 in (len(value) if isinstance(value, list) else 1, *shape):
        return np.zeros(tuple(max(side, 0) for side in shape))
    fits = array.ndim == len(shape) and all(n in (-1, side) for n, side in zip(shape, array.shape, strict=True))
    if array.dtype.kind not in "iuf" or not fits or not np.isfinite(array).all():
        raise InputError(f"{name}: expected finite numbers of shape {shape}".replace("-1", "n"))
    return array.astype(np.float64)


def numbers_or_nulls(value: Any, shape: tuple[int, ...], name: str) -> Floats:
    """The same for lists in which numbers may be null: NaN then."""
    try:
        array = np.array(value, dtype=object)
    except ValueError:
        array = np.array(value, dtype=np.str_)
    unknown = np.asarray(np.frompyfunc(lambda number: number is None, 1, 1)(array), dtype=np.bool_)
    numbers = numbers_of(np.where(unknown, 0.0, array).tolist(), shape, name)
    numbers[unknown.reshape(numbers.shape)] = np.nan
    return numbers
