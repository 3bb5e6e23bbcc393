"""Functions that users write, checked and cut off where they run to infinity, and their derivatives by numbers."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import accumulate, pairwise
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.vectors import all_components, all_finite
from vectorplot.tolerances import COMPLEX_STEP, DERIVATIVES_AGREE, VALUES_AGREE

# Functions that run to infinity: found by climbing, and cut off where nearly all of their values are left behind.

LOOKS = 61
"""Places along each side at which a function is looked at first: an odd number, but none in the very middle."""

FENCE = 1.5
"""Interquartile ranges beyond the quartiles at which a function that runs to infinity is cut off (Tukey's inner
fences)."""

CLIMBERS, CLIMBS = 8, 40
"""From how many of its extreme values a function is climbed, and how often the way is halved."""

FIRST_CLIMBS = 8
"""The climb after which a function that is not over its fence is left alone."""

HUGE = 1e100
"""Times the fence: who is there has met the largest numbers there are."""

AROUND = 5
"""Places along each side of the square around a climber."""

GROWS = 1.2
"""A function that has grown by this factor over the second half of the climb, which is finer than a millionth, has no
end."""

Limits = tuple[Floats, Floats]
"""Smallest and largest values (k,) of the components of a function; infinite where there are none."""


def limits_of(values: Callable[..., Floats], low: Floats, high: Floats, *, looks: int = LOOKS) -> Limits | None:
    """Where a function of two parameters between low and high (2,) is cut off because it runs to infinity; None if it
    does not. values(u, v) -> (n,k), NaN where undefined. A component that grows without end about an extreme value
    is cut at its inner fences.
    Edge cases: poles that all samples miss are not found; an almost constant function has no fences. Source: Tukey,
    Exploratory Data Analysis, 1977, chapter 2 (inner fences).
    """
    step = (high - low) / looks
    # Off the lines of symmetry, on which poles lie: they are beside some of the places.
    line = np.arange(looks) + 0.4871
    places = low + np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2) * step
    found = values(*places.T)
    floor, ceiling = np.full(found.shape[1], -np.inf), np.full(found.shape[1], np.inf)
    for k in range(found.shape[1]):
        own = found[:, k]
        known = np.flatnonzero(np.isfinite(own))
        if len(known) < CLIMBERS:
            continue
        first, middle, third = np.quantile(own[known], (0.25, 0.5, 0.75))
        fence = FENCE * (third - first)
        for sign, edge in ((1.0, third + fence), (-1.0, first - fence)):
            start = places[known[np.argsort(-sign * own[known], kind="stable")[:CLIMBERS]]]

            def height(u: Floats, v: Floats, k: int = k, sign: float = sign, middle: float = middle) -> Floats:
                return np.asarray(sign * (values(u, v)[:, k] - middle))

            if fence > 0.0 and _has_no_end(height, start, step, low, high, sign * (edge - middle)):
                floor[k], ceiling[k] = first - fence, third + fence
    return (floor, ceiling) if np.isfinite(floor).any() or np.isfinite(ceiling).any() else None


def _has_no_end(
    height: Callable[..., Floats], start: Floats, step: Floats, low: Floats, high: Floats, fence: float
) -> bool:
    """Whether a function grows on and on, over the fence, from one of the places (s,2), within squares about the best
    place so far that are halved each time."""
    at, best = start.copy(), height(*start.T)
    line = np.linspace(-1.0, 1.0, AROUND)
    square = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    half = best
    for climb in range(CLIMBS):
        tried = np.clip(at[:, None] + square * step * 0.5**climb, low, high)
        found = height(*tried.reshape(-1, 2).T).reshape(len(at), -1)
        found = np.where(np.isfinite(found), found, -np.inf)
        highest = np.argmax(found, axis=1)
        row = np.arange(len(at))
        better = found[row, highest] > best
        at[better], best = tried[row, highest][better], np.maximum(best, found[row, highest])
        if climb == FIRST_CLIMBS and not (best > fence).any():
            return False
        if climb == CLIMBS // 2:
            half = best
    return bool(((best / GROWS > half) | (best / HUGE > fence)).any())


# Functions that users write: called with arrays or number by number, their results checked.

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


# Derivatives at s of the five Lagrange polynomials through -2, ..., 2, as coefficients of s^3, s^2, s, 1.
_SLOPES = np.array([[2, -3, -1, 1], [-8, 6, 16, -8], [12, 0, -30, 0], [-8, -6, 16, 8], [2, 3, -1, -1]]) / 12.0
_NODES = np.arange(-2.0, 3.0)

FEW_PLACES = 2048
"""At no more places than that a function takes longer to call than to compute; at more, one parameter is complex at a
time: the others stay real numbers, which are quicker."""

FEW_LOOKS = 15
"""Places along each side at which a function is looked at where every place is a call."""
_FILTERS = Lock()


@dataclass(frozen=True)
class Range:
    """The values a parameter takes; closed: the function repeats, so that parameters may run on."""

    start: float
    end: float
    closed: bool = False

    @property
    def length(self) -> float:
        """End minus start."""
        return self.end - self.start

    def wrapped(self, t: Numbers) -> Numbers:
        """The parameters within the range, where it is closed; unchanged where they are inside already."""
        if not self.closed:
            return t
        outside = np.isfinite(t) & ((t.real < self.start) | (t.real > self.end))
        if not outside.any():
            return t
        return t - self.length * np.floor((np.where(outside, t.real, self.start) - self.start) / self.length)

    def centres(self, t: Floats, step: float) -> Floats:
        """Middles of five nodes around t that stay inside the range."""
        if self.closed:
            return t
        return np.clip(t, np.minimum(self.start, t) + 2.0 * step, np.maximum(self.end, t) - 2.0 * step)


@dataclass(frozen=True, eq=False)
class NumericFunction:
    """A user's function with its derivatives; vectors stand on the last axis. inside: where it is evaluated at all, NaN
    elsewhere; limits: smallest and largest values (k,), beyond which it counts as not finite; vectors: how many
    vectors the k components make up, each finite or NaN by itself. Beside holes derivatives are one-sided.
    Error: first derivatives by complex step to rounding where the function is analytic (probed), else fourth-order
    differences, about 1e-12 of the largest; second derivatives are differences of first ones, about 1e-12 and 1e-9.
    """

    function: UserFunction
    ranges: tuple[Range, ...]
    inside: Callable[..., Bools] | None = None
    limits: Limits | None = None
    vectors: int = 1

    def values(self, *parameters: Floats) -> Floats:
        """(..., k) values, NaN in holes."""
        return self._shaped(self._values, parameters)

    def is_finite(self, *parameters: Floats) -> Bools:
        """(...,) whether the function has a value."""
        return np.asarray(np.isfinite(self.values(*parameters)).all(axis=-1), dtype=np.bool_)

    def derivatives(self, axis: int, *parameters: Floats) -> Floats:
        """(..., k) derivatives by one parameter."""
        return self._shaped(lambda flat: self._slopes(axis, flat), parameters)

    def gradient(self, *parameters: Floats) -> tuple[Floats, ...]:
        """(..., k) derivatives by each parameter: the function is called as seldom as can be."""
        if np.size(parameters[0]) > FEW_PLACES and not self.by_complex_step:
            return tuple(self.derivatives(axis, *parameters) for axis in range(len(self.ranges)))

        def evaluate(flat: list[Floats]) -> Floats:
            asked = [(axis, flat) for axis in range(len(self.ranges))]
            if self.by_complex_step:
                return np.concatenate(self._by_complex_step(asked)[0], axis=-1)
            found = self._by_stencils(asked, self.steps)
            for axis, slopes in enumerate(found):
                lost = ~all_finite(slopes)
                if lost.any():
                    slopes[lost] = self._differences(self._values, axis, [p[lost] for p in flat])
            return np.concatenate(found, axis=-1)

        return self._each(evaluate, parameters, len(self.ranges))

    def values_and_gradient(self, *parameters: Floats) -> tuple[Floats, ...]:
        """(..., k) values, and derivatives by each parameter: to the last bit what is said when asked for each."""
        if not self.by_complex_step:
            return self.values(*parameters), *self.gradient(*parameters)

        def evaluate(flat: list[Floats]) -> Floats:
            slopes, values = self._by_complex_step([(axis, flat) for axis in range(len(self.ranges))])
            return np.concatenate([values, *slopes], axis=-1)

        return self._each(evaluate, parameters, 1 + len(self.ranges))

    def hessian(self, *parameters: Floats) -> tuple[Floats, ...]:
        """(..., k) second derivatives by each pair of parameters, (0, 0), (0, 1), ..., (1, 1), ...: the function is
        called as seldom as can be."""
        count = len(self.ranges)
        pairs = [(axis, other) for axis in range(count) for other in range(axis, count)]
        if len(_NODES) * np.size(parameters[0]) > FEW_PLACES:
            return tuple(self.second_derivatives(*pair, *parameters) for pair in pairs)

        def evaluate(flat: list[Floats]) -> Floats:
            steps = self._outer_steps
            along = [
                _Stencil.around(other, flat, self.ranges[other].centres(flat[other], step), step)
                for other, step in enumerate(steps)
            ]
            stencils = [along[other] for _, other in pairs]
            asked = [(axis, at.nodes) for (axis, _), at in zip(pairs, stencils, strict=True)]
            slopes = self._by_complex_step(asked)[0] if self.by_complex_step else self._by_stencils(asked, steps)
            found = [at.slopes(values) for at, values in zip(stencils, slopes, strict=True)]
            for (axis, other), one in zip(pairs, found, strict=True):
                lost = ~np.isfinite(one).all(axis=-1)
                if lost.any():
                    one[lost] = self._second_differences(axis, other, [p[lost] for p in flat])
            return np.concatenate(found, axis=-1)

        return self._each(evaluate, parameters, len(pairs))

    def second_derivatives(self, axis: int, other: int, *parameters: Floats) -> Floats:
        """(..., k) derivatives by one parameter and by the same or another."""
        return self._shaped(lambda flat: self._second_differences(axis, other, flat), parameters)

    @cached_property
    def by_complex_step(self) -> bool:
        """Whether the function takes complex numbers and its complex derivatives are the real ones."""
        try:
            # The filters of warnings belong to the whole process: one thread at a time may change them, and no more of
            # them than it must.
            with _FILTERS, warnings.catch_warnings():
                warnings.simplefilter("error", np.exceptions.ComplexWarning)
                return all(self._complex_is_right(axis) for axis in range(len(self.ranges)))
        except (InputError, Warning):
            return False

    @cached_property
    def steps(self) -> tuple[float, ...]:
        """For each parameter the step of differences at which halving it changes the derivatives least."""
        of = self._complex if self.by_complex_step else self._plain
        return tuple(self._best_step(of(axis), axis)[0] for axis in range(len(self.ranges)))

    @property
    def _outer_steps(self) -> tuple[float, ...]:
        """The steps of differences of derivatives. Those of differences want longer ones: the rounding is divided
        twice."""
        return self.steps if self.by_complex_step else tuple(4.0 * step for step in self.steps)

    def _each(
        self, evaluate: Callable[[list[Floats]], Floats], parameters: Sequence[Floats], count: int
    ) -> tuple[Floats, ...]:
        """So many arrays (..., k), which evaluate gives side by side."""
        whole = self._shaped(evaluate, parameters, count)
        k = self.function.components
        return tuple(np.ascontiguousarray(whole[..., k * number : k * (number + 1)]) for number in range(count))

    def _shaped(
        self, evaluate: Callable[[list[Floats]], Floats], parameters: Sequence[Floats], count: int = 1
    ) -> Floats:
        arrays = [np.asarray(p, dtype=np.float64) for p in parameters]
        if any(a.shape != arrays[0].shape for a in arrays):
            arrays = list(np.broadcast_arrays(*arrays))
        # Infinite parameters are as good as none, and no arithmetic warns of them.
        flat = [_or_nan(a.ravel()) for a in arrays]
        return evaluate(flat).reshape(*arrays[0].shape, count * self.function.components)

    def _asked(self, parameters: Sequence[Numbers]) -> Numbers:
        """(n, k) what the function says at finite parameters inside, NaN elsewhere."""
        wrapped = [r.wrapped(p) for r, p in zip(self.ranges, parameters, strict=True)]
        ask = reduce(np.logical_and, [np.isfinite(p) for p in wrapped])
        if self.inside is not None:
            ask &= self.inside(*(p.real for p in wrapped))
        if _all(ask):
            return self.function(*wrapped)
        answers = self.function(*(p[ask] for p in wrapped))
        result = np.full((len(ask), self.function.components), np.nan, dtype=answers.dtype)
        result[ask] = answers
        return result

    def _values(self, parameters: Sequence[Floats]) -> Floats:
        result = np.asarray(self._asked(parameters).real, dtype=np.float64)
        known = np.isfinite(result)
        if self.limits is not None:
            with np.errstate(invalid="ignore"):
                known &= (result >= self.limits[0]) & (result <= self.limits[1])
        if _all(known):
            return result
        each = (len(result), self.vectors, -1)
        return np.where(all_components(known.reshape(each))[..., None], result.reshape(each), np.nan).reshape(
            result.shape
        )

    def _slopes(self, axis: int, parameters: list[Floats]) -> Floats:
        of = self._complex(axis) if self.by_complex_step else self._by_differences(axis, self.steps[axis])
        return of(parameters)

    def _plain(self, axis: int) -> Callable[[list[Floats]], Floats]:
        return self._values

    def _complex(self, axis: int) -> Callable[[list[Floats]], Floats]:
        """The derivative Im f(t + ih) / h, which no subtraction spoils."""
        return lambda parameters: self._by_complex_step([(axis, parameters)])[0][0]

    def _by_complex_step(self, asked: Sequence[tuple[int, list[Floats]]]) -> tuple[list[Floats], Floats]:
        """(n, k) derivatives by axes at parameters, (axis, parameters) each, and the values at all these, equal lists
        once: of few places in one call, and one for where the function has values at all."""
        heights = [COMPLEX_STEP * self.ranges[axis].length for axis, _ in asked]
        lifted: list[list[Numbers]] = []
        for (axis, parameters), height in zip(asked, heights, strict=True):
            lifted.append(list(parameters))
            lifted[-1][axis] = parameters[axis] + 1j * height
        places = {id(parameters): parameters for _, parameters in asked}
        if any(len(each[0]) > FEW_PLACES for each in lifted):
            answers: Iterable[Numbers] = map(self._asked, lifted)
        else:
            answers = _split(self._asked(_in_a_row(lifted)), [parameters for _, parameters in asked])
        values = self._values(_in_a_row(list(places.values())))
        # A root of a negative number is imaginary there, and a hole here.
        known = dict(zip(places, _split(np.isfinite(values), list(places.values())), strict=True))
        found: list[Floats] = []
        for (_, parameters), height, answer in zip(asked, heights, answers, strict=True):
            real, slopes = known[id(parameters)] & np.isfinite(answer), answer.imag / height
            found.append(slopes if _all(real) else np.where(all_components(real)[..., None], slopes, np.nan))
        return found, values

    def _by_differences(self, axis: int, step: float) -> Callable[[list[Floats]], Floats]:
        return lambda parameters: self._differences(self._values, axis, parameters, step)

    def _by_stencils(self, asked: Sequence[tuple[int, list[Floats]]], steps: Sequence[float]) -> list[Floats]:
        """(n, k) derivatives by axes at parameters, (axis, parameters) each, by differences with steps for each axis:
        in one call. Beside holes they are NaN."""
        stencils = [
            _Stencil.around(axis, at, self.ranges[axis].centres(at[axis], steps[axis]), steps[axis])
            for axis, at in asked
        ]
        every = [stencil.nodes for stencil in stencils]
        values = _split(self._values([np.concatenate(column) for column in zip(*every, strict=True)]), every)
        return [stencil.slopes(own) for stencil, own in zip(stencils, values, strict=True)]

    def _second_differences(self, axis: int, other: int, parameters: list[Floats]) -> Floats:
        """(n, k) derivatives by one parameter and by the same or another."""
        steps = self._outer_steps
        inner = self._complex(axis) if self.by_complex_step else self._by_differences(axis, steps[axis])
        return self._differences(inner, other, parameters, steps[other])

    def _differences(
        self,
        function: Callable[[list[Floats]], Floats],
        axis: int,
        parameters: list[Floats],
        step: float | None = None,
    ) -> Floats:
        """(n, k) derivatives by five-point differences that stay in the range, and on one side of a hole."""
        h = self.steps[axis] if step is None else step
        t = parameters[axis]
        result = _five_points(function, axis, parameters, self.ranges[axis].centres(t, h), h)
        for side in (2.0, -2.0):
            lost = ~all_finite(result)
            if not lost.any():
                break
            lost &= all_finite(self._values(parameters))
            rest = [p[lost] for p in parameters]
            result[lost] = _five_points(function, axis, rest, rest[axis] + side * h, h)
        return result

    def _probes(self) -> list[Floats]:
        """Points spread over the ranges, on no line of symmetry; fewer where every point is a call."""
        count = 16 if self.function.one_at_a_time else 96
        return [
            r.start + r.length * np.mod(0.37 + (np.arange(count) + 0.5) * ratio, 1.0)
            for r, ratio in zip(self.ranges, (0.7548776662, 0.5698402909, 0.4301597090), strict=False)
        ]

    def _best_step(self, function: Callable[[list[Floats]], Floats], axis: int) -> tuple[float, Floats]:
        probes = self._probes()
        factor = 4.0 if self.function.one_at_a_time else 2.0
        # Powers of two, so that the nodes are exact.
        longest = 2.0 ** (math.frexp(self.ranges[axis].length / 64.0)[1] - 1)
        steps = longest * np.ldexp(1.0, -np.arange(0, 18, round(math.log2(factor))))
        centred = [self.ranges[axis].centres(probes[axis], h) for h in steps]
        slopes = [_five_points(function, axis, probes, c, h) for c, h in zip(centred, steps, strict=True)]
        changes = [_most(np.abs(a - b)) for a, b in pairwise(slopes)]
        best = int(np.argmin(changes)) + 1
        return float(steps[best]), slopes[best]

    def _complex_is_right(self, axis: int) -> bool:
        difference = self._best_step(self._values, axis)[1]
        exact = self._complex(axis)(self._probes())
        known = np.isfinite(difference).all(axis=-1)
        if not known.any():
            return False
        error = np.abs(exact - difference)[known]
        return bool((error <= DERIVATIVES_AGREE * np.abs(difference[known]).max()).all())


def _or_nan(values: Floats) -> Floats:
    """The values, NaN where they are infinite."""
    finite = np.isfinite(values)
    return values if _all(finite) else np.where(finite, values, np.nan)


def _all(flags: Bools) -> bool:
    """Whether all are true: of few flags in a quarter of the time that numpy's own takes."""
    return int(np.count_nonzero(flags)) == flags.size


def _in_a_row(parameters: Sequence[Sequence[Numbers]]) -> Sequence[Numbers]:
    """The places of several lists, one list after the other."""
    if len(parameters) == 1:
        return parameters[0]
    return [np.concatenate(column) for column in zip(*parameters, strict=True)]


def _split(values: Numbers, parameters: Sequence[list[Floats]]) -> list[Numbers]:
    """The values at each of several lists of places, of those that stand in a row. (np.split takes longer than small
    arrays take to be computed.)"""
    ends = list(accumulate((len(each[0]) for each in parameters), initial=0))
    return [values[begin:end] for begin, end in pairwise(ends)]


def _most(changes: Floats) -> float:
    """What nine in ten changes stay below: kinks and holes beside a probe do not count."""
    finite = changes[np.isfinite(changes)]
    return float(np.quantile(finite, 0.9)) if finite.size else np.inf


def _five_points(
    function: Callable[[list[Floats]], Floats], axis: int, parameters: list[Floats], centres: Floats, step: float
) -> Floats:
    """(n, k) derivatives of the quartics through the values at five nodes around the centres (n,)."""
    stencil = _Stencil.around(axis, parameters, centres, step)
    return stencil.slopes(function(stencil.nodes))


@dataclass(frozen=True, eq=False)
class _Stencil:
    """Five nodes (5n,) for each of n places, node after node, what each node's value counts (5, n), and the step."""

    nodes: list[Floats]
    weights: Floats
    step: float

    @classmethod
    def around(cls, axis: int, parameters: list[Floats], centres: Floats, step: float) -> _Stencil:
        """The nodes along an axis around centres (n,), for derivatives at the parameters."""
        s = (parameters[axis] - centres) / step
        third, second, first, constant = _SLOPES.T[:, :, None]
        nodes = [np.concatenate([p] * len(_NODES)) for p in parameters]
        nodes[axis] = (centres + step * _NODES[:, None]).ravel()
        return cls(nodes, ((third * s + second) * s + first) * s + constant, step)

    def slopes(self, values: Floats) -> Floats:
        """(n, k) derivatives of the quartics through values (5n, k) at the nodes."""
        at = values.reshape(5, self.weights.shape[1], values.shape[-1])
        # From the middle value, so that a large constant costs no digits.
        return np.asarray(np.einsum("jn,jnk->nk", self.weights, at - at[2]) / self.step)


def numeric_function(
    function: Callable[..., Any],
    components: int,
    ranges: Sequence[Range],
    *,
    name: str | None = None,
    inside: Callable[..., Bools] | None = None,
) -> NumericFunction:
    """The user's function on ranges, tried out at a few points. Errors: InputError when it fails there."""
    spread = np.array([0.137, 0.31, 0.45, 0.62, 0.83])
    probes = [r.start + r.length * np.roll(spread, k) for k, r in enumerate(ranges)]
    if inside is not None:
        probes = _probes_inside(ranges, inside)
    return NumericFunction(user_function(function, components, probes, name=name), tuple(ranges), inside)


def at_once(function: NumericFunction, whole: Callable[..., Any], vectors: int) -> NumericFunction:
    """A function that gives so many vectors, each of as many components as those of another: asked where that is, and
    as sure to take arrays. It is not tried out."""
    user = replace(function.function, function=whole, components=vectors * function.function.components)
    return replace(function, function=user, vectors=vectors)


def cut_off(function: NumericFunction) -> NumericFunction:
    """A function of two parameters, cut off beyond its limits (see `limits_of`) if it runs to infinity."""
    low, high = (np.array([getattr(r, name) for r in function.ranges]) for name in ("start", "end"))
    looks = FEW_LOOKS if function.function.one_at_a_time else LOOKS
    return replace(function, limits=limits_of(function.values, low, high, looks=looks))


def _probes_inside(ranges: Sequence[Range], inside: Callable[..., Bools]) -> list[Floats]:
    lattice = np.meshgrid(*(r.start + r.length * (np.arange(31) + 0.437) / 31 for r in ranges), indexing="ij")
    flat = [a.ravel() for a in lattice]
    found = np.flatnonzero(inside(*flat))
    if not len(found):
        raise InputError("the region has no point in the domain")
    chosen = found[np.linspace(0, len(found) - 1, 7).astype(int)]
    return [a[chosen] for a in flat]
