"""Arguments of shapes in scene files: numbers, ranges, boxes, and formulas with their exact derivatives."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import isfinite, radians
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import NumericFunction, at_once
from vectorplot.curves.placed_curves import FunctionCurve, curve_of_function
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.expressions import Expression, Nodes, Program, parse_expression
from vectorplot.io.scene_statements import begins_annotation
from vectorplot.io.scene_words import Words
from vectorplot.surfaces.function_surface import FunctionSurface, surface_of_function
from vectorplot.surfaces.graphs import Disc, Graph, PolarGraph, graph, graph_over_disc
from vectorplot.surfaces.implicit import ImplicitFunction, implicit_of_function
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances import LARGEST

# Surfaces and curves given by formulas in a scene file, with the exact derivatives of the formulas.


@dataclass(frozen=True)
class Formulas:
    """One formula, or several that are the components of a vector, all in the same variables, as one function."""

    expressions: tuple[Expression, ...]

    def __call__(self, *parameters: Any) -> Any:
        """The values at arrays of parameters, in the order of the variables; a single one where none of these counts.
        Real parameters stay real beside complex ones."""
        results = self._program(dict(zip(self.expressions[0].variables, parameters, strict=True)))
        return tuple(results) if len(results) > 1 else results[0]

    @cached_property
    def _program(self) -> Program:
        # What the components have in common is computed a single time.
        nodes = Nodes()
        results = [nodes.joined(expression.nodes) for expression in self.expressions]
        return Program.of(nodes.nodes, results)

    def derivative(self, variable: str) -> Formulas:
        """The derivatives of all components."""
        return Formulas(tuple(expression.derivative(variable) for expression in self.expressions))

    def degrees_in(self, ranges: Mapping[str, tuple[float, float]]) -> list[str]:
        """What to say of variables that run over quarters of turns in degrees, and stand in sines as they are."""
        return [
            f"{name} runs from {low:g} to {high:g}, but angles in formulas are in radians: "
            f'did you mean {name} "{low:g}*pi/180" "{high:g}*pi/180"?'
            for name, (low, high) in ranges.items()
            if high - low >= 90.0 and low % 45.0 == (high - low) % 90.0 == 0.0 and self._turns_with(name)
        ]

    def _turns_with(self, variable: str) -> bool:
        """Whether a variable, or a whole multiple of it, is the angle of a sine, a cosine or a tangent."""
        for expression in self.expressions:
            nodes = expression.nodes
            for angle in (nodes[node.operands[0]] for node in nodes if node.operation in ("sin", "cos", "tan")):
                parts = [nodes[k] for k in angle.operands] if angle.operation in ("multiply", "negative") else [angle]
                numbers = [part.number for part in parts if part.operation == "number"]
                if sum(part.name == variable for part in parts) == 1 == len(parts) - len(numbers):
                    return all(number == round(number) for number in numbers)
        return False

    def gradient(self) -> Formulas:
        """The derivatives of a single formula by all its variables."""
        (expression,) = self.expressions
        return Formulas(tuple(expression.derivative(variable) for variable in expression.variables))


def formula_curve(formulas: Formulas, start: float, end: float, *, closed: bool) -> FunctionCurve:
    """The curve of three formulas in t."""
    return curve_of_function(formulas, start, end, closed=closed, derivative=formulas.derivative("t"))


def formula_surface(formulas: Formulas, domain: Domain) -> FunctionSurface:
    """The surface of three formulas in u and v."""
    by_u, by_v = formulas.derivative("u"), formulas.derivative("v")
    second = (by_u.derivative("u"), by_u.derivative("v"), by_v.derivative("v"))
    surface = surface_of_function(formulas, domain, partials=(by_u, by_v), second_partials=second)
    return replace(surface, jets=_jets(surface.function, formulas, (by_u, by_v), second))


def formula_graph(formulas: Formulas, domain: Domain) -> Graph:
    """The graph of a formula in x and y above a rectangle."""
    slopes = formulas.derivative("x"), formulas.derivative("y")
    return _with_jets(graph(formulas, domain, slopes=slopes), formulas, slopes)


def formula_graph_over_disc(formulas: Formulas, disc: Disc, *, hole: float) -> PolarGraph:
    """The graph of a formula in x and y above a disc."""
    slopes = formulas.derivative("x"), formulas.derivative("y")
    polar = graph_over_disc(formulas, disc, hole=hole, slopes=slopes)
    return replace(polar, plane=_with_jets(polar.plane, formulas, slopes))


def formula_implicit(formulas: Formulas, box: Floats) -> ImplicitFunction:
    """The surface on which a formula in x, y and z is zero, within a box (2,3)."""
    gradient = formulas.gradient()
    by_x, by_y, by_z = (Formulas((slope,)) for slope in gradient.expressions)
    bends = (
        [by_x.derivative(name) for name in "xyz"] + [by_y.derivative(name) for name in "yz"] + [by_z.derivative("z")]
    )
    surface = implicit_of_function(formulas, box, gradient=gradient)
    return replace(surface, bends=at_once(surface.function, _joined(bends), len(bends)))


def _with_jets(surface: Graph, height: Formulas, slopes: tuple[Formulas, Formulas]) -> Graph:
    """A graph with the exact derivatives of its formula, all at once."""
    by_x, by_y = slopes
    second = (by_x.derivative("x"), by_x.derivative("y"), by_y.derivative("y"))
    return replace(surface, jets=_jets(surface.heights, height, slopes, second))


def _jets(
    function: NumericFunction, formulas: Formulas, first: Sequence[Formulas], second: Sequence[Formulas]
) -> tuple[NumericFunction, ...]:
    """Values and first derivatives at once, and these with the second ones; none where the function is cut off."""
    if function.limits is not None:
        return ()
    kinds = ((formulas, *first), (formulas, *first, *second))
    return tuple(at_once(function, _joined(parts), len(parts)) for parts in kinds)


def _joined(parts: Sequence[Formulas]) -> Formulas:
    return Formulas(tuple(expression for part in parts for expression in part.expressions))


# What stands behind the name of a surface or a curve in a scene file: slots, each with a word of its own.

Reader = Callable[[Words, int, str, str], tuple[Any, int]]
"""Reads what stands at a word: (words, at, owner, what it is for) -> (value, the word behind it)."""


@dataclass(frozen=True)
class Slot:
    """How a value is read, and what it is where the file is silent; needed: the file must not be. into: the name under
    which it is handed on, where that is not its word; quoted: formulas."""

    read: Reader
    default: Any = None
    needed: bool = False
    into: str | None = None
    quoted: bool = False


@dataclass(frozen=True)
class Family:
    """The slots of a surface or a curve by their words; bare: those whose values may stand, in this order and without
    their words, right behind its name; build: makes it of the values."""

    slots: Mapping[str, Slot]
    bare: tuple[str, ...]
    build: Callable[..., Any]


def read_family(words: Words, at: int, owner: str, name: str, families: Mapping[str, Family]) -> tuple[Any, int]:
    """What a name and the slots behind it describe, and the word behind them; at: the first word of the slots.

    Errors: InputError with file, line and owner for missing and double slots and values that make nothing.
    """
    family, start = families[name], at - 1
    given: dict[str, Any] = {}
    for word in family.bare:
        slot = family.slots[word]
        if words.words[at] in family.slots or not (slot.quoted or words.is_number(at)):
            break
        given[slot.into or word], at = slot.read(words, at, owner, word)
    while (slot_found := family.slots.get(words.words[at])) is not None and not begins_annotation(words, at):
        word = words.words[at]
        key = slot_found.into or word
        if key in given:
            words.fail(at, f"{owner}a second '{word}'" if key == word else f"{owner}a second {key}, '{word}'")
        given[key], at = slot_found.read(words, at + 1, owner, word)
    for word, slot in family.slots.items():
        key = slot.into or word
        if key not in given and slot.needed:
            expected = [f"'{other}'" for other, one in family.slots.items() if (one.into or other) == key]
            words.fail(at, f"{owner}{name}: expected {' or '.join(expected)}, got {words.shown(at)}")
        given.setdefault(key, slot.default)
    for formulas in (value for value in given.values() if isinstance(value, Formulas)):
        ranges = {name: given.get(name) for name in formulas.expressions[0].variables}
        for told in formulas.degrees_in({name: ends for name, ends in ranges.items() if isinstance(ends, tuple)}):
            where = f"{words.name}:{words.line(start)}: {owner}"
            warnings.warn(f"{where}{told}", InputWarning, stacklevel=2)
    try:
        return family.build(**given), at
    except InputError as error:
        if error.file is not None:
            raise
        words.fail(start, owner + error.cause)


def read_number(words: Words, at: int, owner: str, what: str) -> tuple[float, int]:
    """A finite number, or a formula without variables in quotes, such as "2*pi"."""
    if not words.words[at].startswith('"'):
        return words.number(at, owner, what), at + 1
    value = float(_expression(words, at, owner, what, ())())
    if not isfinite(value):
        words.fail(at, f"{owner}{what}: {words.shown(at)} is not a finite number")
    if abs(value) > LARGEST:
        words.fail(at, f"{owner}{what}: {words.shown(at)} is out of range, at most {LARGEST:g}")
    return value, at + 1


def read_whole(words: Words, at: int, owner: str, what: str) -> tuple[int, int]:
    """A whole number."""
    return words.whole(at, owner, what), at + 1


def read_numbers(count: int) -> Reader:
    """How to read several numbers, commas between them allowed."""

    def read(words: Words, at: int, owner: str, what: str) -> tuple[tuple[float, ...], int]:
        values = []
        for place in range(count):
            if place and words.words[at] == ",":
                at += 1
            value, at = read_number(words, at, owner, what)
            values.append(value)
        return tuple(values), at

    return read


def read_angles(words: Words, at: int, owner: str, what: str) -> tuple[tuple[float, float], int]:
    """First and last angle, in degrees in the file, in radians as a value."""
    (first, last), at = read_numbers(2)(words, at, owner, what)
    return (radians(first), radians(last)), at


def read_angle(words: Words, at: int, owner: str, what: str) -> tuple[float, int]:
    """An angle, in degrees in the file, in radians as a value."""
    value, at = read_number(words, at, owner, what)
    return radians(value), at


def read_box(words: Words, at: int, owner: str, what: str) -> tuple[Any, int]:
    """The array (2,3) of a box that is given by X0 X1 Y0 Y1 Z0 Z1."""
    numbers, at = read_numbers(6)(words, at, owner, what)
    return np.array(numbers).reshape(3, 2).T.copy(), at


def read_flag(words: Words, at: int, owner: str, what: str) -> tuple[bool, int]:
    """True: the word itself is all there is."""
    return True, at


def read_formulas(count: int, *variables: str) -> Reader:
    """How to read formulas in some variables, each in quotes; a number may stand without."""

    def read(words: Words, at: int, owner: str, what: str) -> tuple[Formulas, int]:
        expressions = []
        for place in range(count):
            if place and words.words[at] == ",":
                at += 1
            expressions.append(_expression(words, at, owner, f"a formula in {' and '.join(variables)}", variables))
            at += 1
        return Formulas(tuple(expressions)), at

    return read


def _expression(words: Words, at: int, owner: str, what: str, variables: tuple[str, ...]) -> Expression:
    if not words.words[at].startswith('"') and not words.is_number(at):
        words.fail(at, f"{owner}expected {what} in quotes, got {words.shown(at)}")
    try:
        return parse_expression(words.string(at), variables)
    except InputError as error:
        if error.file is not None:
            raise
        words.fail(at, owner + error.cause)
