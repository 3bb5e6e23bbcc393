"""Surfaces of a certificate: formulas evaluated with their derivatives on whole cells, nets, and where contours are.

It belongs to `check_certificate.py`, and imports nothing but the standard library and numpy either. A surface is three
formulas of u and v, and the lines of a net. Formulas are parsed, never run as code, and evaluated with their two orders
of derivatives on whole cells (Moore's interval arithmetic): so it is proved how far the net is off the surface, and in
which cells contours are, the zeros of the Jacobian x_u y_v - x_v y_u of the image: nowhere else.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

LEAST, OUTWARD, CHUNK = 1e-300, 1e-15, 1 << 13
"""The least divisor; by so much results of rounding are widened; cells that are held at once."""
MOST_CELLS, LONGEST, DEEPEST = 1 << 18, 4000, 24
"""Cells of a net and of its contours, each, at most; characters of a formula; rounds in which cells are refined."""


class Range:
    """All numbers from low to high, arrays; what rounding may do is added, and what has no bound is all numbers."""

    __slots__ = ("high", "low")

    def __init__(self, low: Any, high: Any) -> None:
        low, high = low - OUTWARD * np.abs(low) - LEAST, high + OUTWARD * np.abs(high) + LEAST
        self.low, self.high = np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)

    def __add__(self, other: Range) -> Range:
        return Range(self.low + other.low, self.high + other.high)

    def __mul__(self, other: Any) -> Range:
        other = other if isinstance(other, Range) else Range(other, other)
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return Range(np.minimum.reduce(np.broadcast_arrays(*ends)), np.maximum.reduce(np.broadcast_arrays(*ends)))

    def power(self, n: int) -> Range:
        """Itself n times, or one over that."""
        if n < 0:
            found = self.power(-n)
            whole = (found.low <= 0.0) & (found.high >= 0.0)
            return Range(np.where(whole, -np.inf, 1.0 / found.high), np.where(whole, np.inf, 1.0 / found.low))
        low, high = self.low**n, self.high**n
        if n % 2:
            return Range(low, high)
        zero = (self.low <= 0.0) & (self.high >= 0.0) & (n > 0)
        return Range(np.where(zero, 0.0, np.minimum(low, high)), np.maximum(low, high))

    def through(self, function: Callable[[Any], Any]) -> Range:
        """The values of a function that rises; all numbers where it has none."""
        with np.errstate(invalid="ignore", divide="ignore"):
            low, high = function(self.low), function(self.high)
        none = np.isnan(low) | np.isnan(high)
        return Range(np.where(none, np.nan, low), np.where(none, np.nan, high))

    def wave(self, quarters: int) -> Range:
        """The sines of what is so many quarters of a turn farther."""
        ends = [(np.sin, np.cos)[quarters % 2](end) * (1.0, 1.0, -1.0, -1.0)[quarters] for end in (self.low, self.high)]
        turns = [(end + 0.5 * np.pi * quarters) / (2.0 * np.pi) for end in (self.low - 1e-9, self.high + 1e-9)]
        least, most = (np.floor(turns[1] - part) >= np.ceil(turns[0] - part) for part in (0.75, 0.25))
        low, high = np.minimum(*ends) - OUTWARD, np.maximum(*ends) + OUTWARD
        return Range(np.where(least, -1.0, low), np.where(most, 1.0, high))

    @property
    def size(self) -> Floats:
        """The largest absolute value."""
        return np.asarray(np.maximum(np.abs(self.low), np.abs(self.high)))


def plus(a: Range | None, b: Range | None) -> Range | None:
    """The sum; None is zero."""
    return b if a is None else a if b is None else a + b


def by(a: Range | None, b: Range | None) -> Range | None:
    """The product; None is zero."""
    return None if a is None or b is None else a * b


class Jet:
    """The values of a function on cells, its derivatives by u, v, and by u twice, u and v, v twice; None is zero."""

    def __init__(self, value: Range, slopes: tuple[Range | None, ...], bends: tuple[Range | None, ...]) -> None:
        self.value, self.slopes, self.bends = value, slopes, bends

    def __add__(self, other: Any) -> Jet:
        other = jet(other)
        slopes, bends = (tuple(map(plus, *pair)) for pair in zip(self[1:], other[1:], strict=True))
        return Jet(self.value + other.value, slopes, bends)

    def __getitem__(self, part: slice) -> Any:
        return (self.value, self.slopes, self.bends)[part]

    def __mul__(self, other: Any) -> Jet:
        (a, (au, av), (auu, auv, avv)), (b, (bu, bv), (buu, buv, bvv)) = self[:], jet(other)[:]
        slopes = tuple(plus(by(da, b), by(a, db)) for da, db in ((au, bu), (av, bv)))
        mixed = (by(au, bu), by(au, bv), by(av, bv)), (by(au, bu), by(av, bu), by(av, bv))
        bends = (plus(by(da, b), by(a, db)) for da, db in ((auu, buu), (auv, buv), (avv, bvv)))
        return Jet(a * b, slopes, tuple(plus(one, plus(*two)) for one, *two in zip(bends, *mixed, strict=True)))

    def through(self, value: Range, slope: Range, bend: Range) -> Jet:
        """The jet of a function of it, whose value, derivative and second derivative are given."""
        u, v = self.slopes
        squares = (u and u.power(2), by(u, v), v and v.power(2))
        bends = (plus(by(bend, two), by(slope, one)) for two, one in zip(squares, self.bends, strict=True))
        return Jet(value, (by(slope, u), by(slope, v)), tuple(bends))

    def __pow__(self, other: Any) -> Jet:
        n, x = other, self.value
        if isinstance(n, Jet) or n != int(n):
            return exponential(jet(other) * FUNCTIONS["log"](self))
        m = int(n)
        return self.through(x.power(m), x.power(m - 1) * n, x.power(m - 2) * (n * (n - 1.0)))

    def __neg__(self) -> Jet:
        return self * -1.0

    def __sub__(self, other: Any) -> Jet:
        return self + jet(other) * -1.0

    def __rsub__(self, other: float) -> Jet:
        return jet(other) + self * -1.0

    def __truediv__(self, other: Any) -> Jet:
        return self * jet(other) ** -1.0

    def __rtruediv__(self, other: float) -> Jet:
        return jet(other) * self**-1.0

    def __rpow__(self, other: float) -> Jet:
        return exponential(self * float(np.log(other)))

    __radd__, __rmul__ = __add__, __mul__


def jet(value: Any) -> Jet:
    """A number as a jet; jets remain."""
    number = None if isinstance(value, Jet) else np.array([value])
    return value if number is None else Jet(Range(number, number), (None, None), (None, None, None))


def exponential(x: Jet) -> Jet:
    """e to the power of it."""
    return x.through(*3 * [x.value.through(np.exp)])


def root(x: Jet) -> Jet:
    """The square root."""
    found = x.value.through(np.sqrt)
    return x.through(found, found.power(-1) * 0.5, found.power(-3) * -0.25)


def arc(x: Jet) -> Jet:
    """The angle with this tangent."""
    slope = (x.value.power(2) + Range(1.0, 1.0)).power(-1)
    return x.through(x.value.through(np.arctan), slope, x.value * slope.power(2) * -2.0)


FUNCTIONS: dict[str, Callable[[Jet], Jet]] = {
    "sin": lambda x: x.through(*(x.value.wave(k) for k in range(3))),
    "cos": lambda x: x.through(*(x.value.wave(k) for k in range(1, 4))),
    "tan": lambda x: FUNCTIONS["sin"](x) / FUNCTIONS["cos"](x),
    "exp": exponential,
    "log": lambda x: x.through(x.value.through(np.log), x.value.power(-1), x.value.power(-2) * -1.0),
    "sqrt": root,
    "atan": arc,
    "sinh": lambda x: (exponential(x) - exponential(-x)) * 0.5,
    "cosh": lambda x: (exponential(x) + exponential(-x)) * 0.5,
    "tanh": lambda x: 1.0 - 2.0 / (exponential(x * 2.0) + 1.0),
}
NUMBERS: dict[str, Any] = {name: getattr(np, name.replace("at", "arct")) for name in FUNCTIONS}
OPERATORS: dict[type, Any] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}


def value_of(node: Any, names: dict[str, Any], functions: dict[str, Any]) -> Any:
    """The value of a formula, as a tree. Errors: ValueError for what is none."""
    match node:
        case ast.Expression(body=body):
            return value_of(body, names, functions)
        case ast.Constant(value=int() | float() as number):
            return float(number)
        case ast.Name(id=name) if name in names:
            return names[name]
        case ast.UnaryOp(op=sign, operand=one) if type(sign) in OPERATORS:
            return OPERATORS[type(sign)](value_of(one, names, functions))
        case ast.BinOp(left=one, op=sign, right=two) if type(sign) in OPERATORS:
            return OPERATORS[type(sign)](*(value_of(part, names, functions) for part in (one, two)))
        case ast.Call(func=ast.Name(id=name), args=[one], keywords=[]) if name in functions:
            found = value_of(one, names, functions)
            return float(NUMBERS[name](found)) if isinstance(found, float) else functions[name](found)
    raise ValueError("a formula has something else than numbers, u, v, pi, + - * / ** and known functions")


class Patch(NamedTuple):
    """A surface: its formulas x, y, z as trees, where it is placed (3,4), and the lines u, v of its net, rising."""

    formulas: list[Any]
    place: Floats
    u: Floats
    v: Floats

    def points(self, u: Any, v: Any) -> Floats:
        """(...,3) points in the world."""
        with np.errstate(all="ignore"):
            found = [value_of(one, {"u": u, "v": v, "pi": np.pi}, NUMBERS) + 0.0 * u for one in self.formulas]
        local = np.stack(found, axis=-1)
        return np.asarray((local[..., None, :] * self.place[:, :3]).sum(axis=-1) + self.place[:, 3])

    def jets(self, rows: Floats, cells: Floats) -> list[Jet]:
        """x, y, z in the image on cells (n,4), from u to u and from v to v, by the rows (4,4) of the image."""
        one, none = Range(np.ones(1), np.ones(1)), (None, None, None)
        names = {"u": Jet(Range(*cells[:, :2].T), (one, None), none), "pi": np.pi}
        names["v"] = Jet(Range(*cells[:, 2:].T), (None, one), none)
        with np.errstate(all="ignore"):
            local = [jet(value_of(formula, names, FUNCTIONS)) for formula in self.formulas]
            whole = (rows[:, :3, None] * self.place).sum(axis=1)
            whole[:, 3] += rows[:, 3]
            *image, w = (sum((a * b for a, b in zip(local, row[:3], strict=True)), jet(row[3])) for row in whole)
            return image if not whole[3, :3].any() else [one * w**-1.0 for one in image]

    def grid(self) -> Floats:
        """(m,4) the cells of its net, those of one u after another."""
        low, high = (np.stack(np.meshgrid(self.u[k], self.v[k], indexing="ij")) for k in (np.s_[:-1], np.s_[1:]))
        return np.stack([low[0], high[0], low[1], high[1]], axis=-1).reshape(-1, 4)


def patch_of(row: Any) -> Patch:
    """A surface of a certificate. Errors: ValueError for what is none."""
    if any(len(text) > LONGEST for text in row["formulas"]) or len(row["formulas"]) != 3:
        raise ValueError("a surface has not three formulas, or very long ones")
    u, v, place = (np.array(row[key], dtype=np.float64) for key in ("u", "v", "placement"))
    finite = all(np.isfinite(part).all() for part in (u, v, place))
    if not finite or place.shape != (3, 4) or any(len(k) < 2 or (np.diff(k) <= 0.0).any() for k in (u, v)):
        raise ValueError("the net of a surface does not rise, or is placed nowhere")
    if (len(u) - 1) * (len(v) - 1) > MOST_CELLS:
        raise ValueError("a net has too many cells")
    return Patch([ast.parse(text.strip(), mode="eval") for text in row["formulas"]], place, u, v)


def in_chunks(function: Callable[[Floats], Floats], cells: Floats) -> Floats:
    """The rows of a function of cells, some of them at once."""
    return np.concatenate([function(cells[k : k + CHUNK]) for k in range(0, max(len(cells), 1), CHUNK)])


def sizes(ranges: Any, count: int) -> Floats:
    """(count,k) the largest absolute values of k ranges, of which None is zero."""
    return np.stack([np.zeros(count) if one is None else np.broadcast_to(one.size, count) for one in ranges], axis=1)


def numbers(ranges: Any, count: int) -> Floats:
    """(count,k) the middles of k ranges, of which None is zero."""
    return np.stack(
        [np.zeros(count) if one is None else np.broadcast_to(0.5 * (one.low + one.high), count) for one in ranges],
        axis=1,
    )


def deviations(patch: Patch, rows: Floats, cells: Floats) -> Floats:
    """(n,3) how far the two triangles of each cell are off the surface at most, in mm: for bends by u, u and v, v.

    For triangles with legs a, b along u and v it is (a^2 f_uu + 2 a b f_uv + b^2 f_vv) / 8 at most.
    """

    def some(cells: Floats) -> Floats:
        a, b = cells[:, 1] - cells[:, 0], cells[:, 3] - cells[:, 2]
        bends = np.stack([sizes(one.bends, len(cells)) for one in patch.jets(rows, cells)])
        return np.asarray(np.sqrt((bends**2).sum(axis=0)) * np.stack([a * a, 2.0 * a * b, b * b], axis=1) / 8.0)

    return in_chunks(some, cells)


MINUS = Range(-np.ones(1), -np.ones(1))


def jacobian(x: Jet, y: Jet) -> Range | None:
    """x_u y_v - x_v y_u: zero on contours."""
    (xu, xv), (yu, yv) = x.slopes, y.slopes
    return plus(by(xu, yv), by(by(xv, yu), MINUS))


def mean_jacobian(patch: Patch, rows: Floats, cells: Floats) -> tuple[Range | None, Floats, list[Jet]]:
    """The Jacobian on cells, how much it may differ from that in their middles (n,), and the jets on them."""
    x, y, _ = jets = patch.jets(rows, cells)
    (xu, xv), (yu, yv), (xuu, xuv, xvv), (yuu, yuv, yvv) = x.slopes, y.slopes, x.bends, y.bends
    by_u = plus(plus(by(xuu, yv), by(xu, yuv)), by(plus(by(xuv, yu), by(xv, yuu)), MINUS))
    by_v = plus(plus(by(xuv, yv), by(xu, yvv)), by(plus(by(xvv, yu), by(xv, yuv)), MINUS))
    steps = 0.5 * np.diff(cells.reshape(-1, 2, 2))[..., 0]
    return jacobian(x, y), (sizes([by_u, by_v], len(cells)) * steps).sum(axis=1), jets


def steps(patch: Patch, rows: Floats, cells: Floats) -> tuple[Floats, Floats]:
    """(n,2) each: mm that images of points move at most by u and by v, on the page, and with their heights."""
    x, y, z = (sizes(one.slopes, len(cells)) for one in patch.jets(rows, cells))
    return np.hypot(x, y), np.sqrt(x * x + y * y + z * z)


def contour_cells(patch: Patch, rows: Floats, size: float) -> tuple[Floats, bool]:
    """(n,9) the middles x, y, z of small cells that have all contours, half their sizes, a direction across the contour
    to where the surface does not reach (2), and whether a contour runs through for sure; and whether that is all, or
    there were too many. size: their sizes on the page, in mm."""

    def doubtful(cells: Floats) -> Floats:
        whole, change, (x, y, _) = mean_jacobian(patch, rows, cells)
        at = jacobian(*patch.jets(rows, np.repeat(cells.reshape(-1, 2, 2).mean(axis=2), 2, axis=1))[:2])
        reach = sizes([one for ends in zip(x.slopes, y.slopes, strict=True) for one in ends], len(cells))
        steps = np.diff(cells.reshape(-1, 2, 2))[..., 0]
        none = np.zeros(len(cells))
        zero = [none <= 0.0] if whole is None else [whole.low <= 0.0, whole.high >= 0.0]
        zero += [] if at is None else [at.low - change <= 0.0, at.high + change >= 0.0]
        extent = np.hypot(reach[:, ::2], reach[:, 1::2]) * steps
        return np.column_stack([np.logical_and.reduce(np.broadcast_arrays(none <= 0.0, *zero)), extent])

    cells, small = patch.grid(), [np.zeros((0, 4))]
    for _ in range(DEEPEST):
        found = in_chunks(doubtful, cells)
        cells, extent = cells[found[:, 0] > 0.0], found[found[:, 0] > 0.0, 1:]
        fine = extent.sum(axis=1) <= size
        small.append(cells[fine])
        for axis in range(2):
            halve = extent[:, axis] > 0.5 * size
            cells = np.concatenate([cells[~fine & ~halve], *([cells[~fine & halve]] * 2)])
            extent = np.concatenate([extent[~fine & ~halve], *([extent[~fine & halve]] * 2)])
            low = np.arange(len(cells)) - int((~fine & ~halve).sum())
            half = int((~fine & halve).sum())
            middle = 0.5 * (cells[:, 2 * axis] + cells[:, 2 * axis + 1])
            first, second = (low >= 0) & (low < half), low >= half
            cells[first, 2 * axis + 1], cells[second, 2 * axis] = middle[first], middle[second]
            fine = np.zeros(len(cells), dtype=np.bool_)
        if not len(cells) or len(cells) + sum(map(len, small)) > MOST_CELLS:
            break

    def described(cells: Floats) -> Floats:
        middle, steps = cells.reshape(-1, 2, 2).mean(axis=2), 0.5 * np.diff(cells.reshape(-1, 2, 2))[..., 0]
        half = np.stack(
            [(sizes(one.slopes, len(cells)) * steps).sum(axis=1) for one in patch.jets(rows, cells)], axis=1
        )
        jets = patch.jets(rows, np.repeat(middle, 2, axis=1))
        place = np.stack([np.broadcast_to(one.value.low, len(cells)) for one in jets], axis=1)
        columns = [one.slopes for one in jets], [one.bends for one in jets]
        slopes, bends = (np.stack([numbers(of, len(cells)) for of in parts], axis=2) for parts in columns)
        normal = np.cross(slopes[:, 0], slopes[:, 1])[:, :2]
        normal /= np.maximum(np.hypot(*normal.T), LEAST)[:, None]
        # The way on the surface along the sight line, on which the image turns back: it bends away from its outside.
        along = np.where(np.abs(slopes[:, :, :1]).sum(axis=1) > np.abs(slopes[:, :, 1:2]).sum(axis=1), 0, 1)
        v, u = (np.take_along_axis(slopes[:, k, :2], along, axis=1) * (1.0, -1.0)[1 - k] for k in (0, 1))
        bend = (np.hstack([u * u, 2.0 * u * v, v * v])[:, :, None] * bends[:, :, :2]).sum(axis=1)
        across = -np.sign((bend * normal).sum(axis=1))[:, None] * normal
        signs = [jacobian(*patch.jets(rows, cells[:, [a, a, b, b]])[:2]) for a in (0, 1) for b in (2, 3)]
        none = np.zeros(len(cells), dtype=np.bool_)
        rises = np.logical_or.reduce([none | (one is not None and one.low > 0.0) for one in signs])
        falls = np.logical_or.reduce([none | (one is not None and one.high < 0.0) for one in signs])
        return np.column_stack([place, half, across, rises & falls])

    return in_chunks(described, np.concatenate(small)), not len(cells)


def net_of(patch: Patch) -> tuple[Floats, Ints]:
    """The points (n,3) of a net in the world, and its triangles (t,3), two for each cell, one after the other."""
    u, v = np.meshgrid(patch.u, patch.v, indexing="ij")
    place = np.arange(u.size).reshape(u.shape)
    a, b, c, d = place[:-1, :-1], place[1:, :-1], place[1:, 1:], place[:-1, 1:]
    return patch.points(u, v).reshape(-1, 3), np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
