"""Functions that users write: called with arrays or number by number, their results checked."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError, InputWarning
from vectorplot.tolerances.of_values import VALUES_AGREE

# Real or complex.
Numbers = NDArray[Any]


@dataclass(frozen=True, eq=False)
class UserFunction:
    """A function of one or more parameters to one number or to vectors of so many components.

    name: how messages call it; one_at_a_time: it takes single numbers; components_first: it returns (k, n), not (n, k).
    Errors: InputError, naming the function, when it raises, returns complex numbers for real ones, or the wrong shape.
    """

    function: Callable[..., Any]
    name: str
    components: int
    one_at_a_time: bool = False
    components_first: bool = False

    def __call__(self, *parameters: Numbers) -> Numbers:
        """(n, components) values at parameters (n,) each, NaN included."""
        count = len(parameters[0])
        if not count:
            return np.zeros((0, self.components))
        with np.errstate(all="ignore"):
            if self.one_at_a_time:
                rows = [self._call(*point) for point in zip(*(p.tolist() for p in parameters), strict=True)]
                result = self._numbers(rows)
                if result.size != count * self.components:
                    raise self._wrong_shape(result.shape[1:], 1)
                result = result.reshape(count, self.components)
            else:
                result = self._rows(self._call(*parameters), count)
        if result.dtype.kind == "c" and not any(p.dtype.kind == "c" for p in parameters):
            raise InputError(f"{self.name} returns complex numbers")
        return result

    def _call(self, *parameters: Any) -> Any:
        try:
            return self.function(*parameters)
        except Exception as error:  # whatever a user's function may raise
            at = ", ".join(f"{np.ravel(p)[0]:g}" for p in parameters)
            raise InputError(f"{self.name} fails at ({at}): {type(error).__name__}: {error}") from error

    def _rows(self, result: Any, count: int) -> Numbers:
        """The result of one call with arrays as (count, components)."""
        k = self.components
        if isinstance(result, tuple | list) and len(result) == k > 1:
            columns = [self._numbers(part) for part in result]
            if any(column.shape not in ((), (1,), (count,)) for column in columns):
                raise self._wrong_shape(tuple(column.shape for column in columns), count)
            # Of small arrays np.stack and np.broadcast_to spend most of their time on checks.
            rows = np.empty((count, k), dtype=np.result_type(*columns))
            for axis, column in enumerate(columns):
                rows[:, axis] = column
            return rows
        values = self._numbers(result)
        if k == 1 and values.shape in ((), (1,), (count,), (count, 1)):
            # Most functions return as many; to be broadcast takes longer than small arrays take to be computed.
            return values.reshape(-1, 1) if values.size == count else np.broadcast_to(values.reshape(-1, 1), (count, 1))
        if k > 1 and values.shape == (k, count) and (k != count or self.components_first):
            return values.T
        if k > 1 and values.shape in ((count, k), (k,)):
            return np.broadcast_to(values, (count, k))
        raise self._wrong_shape(values.shape, count)

    def _numbers(self, result: Any) -> Numbers:
        try:
            values = np.asarray(result)
            if values.dtype.kind not in "biufc":
                values = values.astype(np.float64)
        except (TypeError, ValueError):
            raise InputError(f"{self.name} returns something that is no array of numbers") from None
        return values.astype(np.complex128 if values.dtype.kind == "c" else np.float64, copy=False)

    def _wrong_shape(self, shape: tuple[Any, ...], count: int) -> InputError:
        wanted = "one number" if self.components == 1 else f"{self.components} numbers"
        return InputError(f"{self.name} must return {wanted} for each parameter; for {count} it returns shape {shape}")


def user_function(
    function: Callable[..., Any], components: int, probes: Sequence[Floats], *, name: str | None = None
) -> UserFunction:
    """The user's function, tried out at probes (n,) for each parameter: with arrays, else number by number.

    A function that takes single numbers only works too, slower, with one InputWarning. n must not be the number of
    components. Errors: InputError when the function fails both ways.
    """
    if not callable(function):
        raise InputError(f"{name or 'a function'} must be callable, not {function!r}")
    plain = getattr(function, "__name__", type(function).__name__)
    label = name or f"function {'lambda' if plain == '<lambda>' else plain}"
    vectorised = UserFunction(function, label, components)
    single = replace(vectorised, one_at_a_time=True)
    try:
        values = vectorised(*probes)
    except InputError as refused:
        if refused.__cause__ is None:
            raise  # of what it returns
        single(*(p[:1] for p in probes))
        return _hinted(single)
    if not _agree(values, single, probes):
        return _hinted(single)
    with np.errstate(all="ignore"):
        result = function(*probes)
    first = isinstance(result, np.ndarray) and result.shape == (components, len(probes[0]))
    return replace(vectorised, components_first=first) if first else vectorised


def _agree(values: Numbers, single: UserFunction, probes: Sequence[Floats]) -> bool:
    """Whether calls with arrays mean what calls with numbers mean; such as a dot product does not."""
    some = slice(None, None, max(1, len(values) // 4))
    try:
        alone = single(*(p[some] for p in probes))
    except InputError:
        return True  # a function that wants arrays
    largest = float(np.max(np.abs(alone[np.isfinite(alone)]), initial=0.0))
    return bool(np.allclose(values[some], alone, rtol=VALUES_AGREE, atol=VALUES_AGREE * largest, equal_nan=True))


def _hinted(single: UserFunction) -> UserFunction:
    warnings.warn(
        f"{single.name} takes one number at a time: it works, but slowly; numpy's functions take arrays",
        InputWarning,
        stacklevel=5,
    )
    return single
