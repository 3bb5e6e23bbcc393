"""Formulas in scene files and on the command line: read by a parser of our own, never run as code."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.errors import InputError
from vectorplot.io.expressions.expression_derivatives import derivative_nodes
from vectorplot.io.expressions.expression_nodes import Node, Program
from vectorplot.io.expressions.expression_parser import CONSTANTS, FUNCTIONS, Parser


@dataclass(frozen=True)
class Expression:
    """A formula in named variables: a function of whole arrays, and of its derivatives the source.

    Parameters
    ----------
    text : str
        The formula as it was written.
    variables : tuple of str
        The names it may use.
    nodes : tuple of Node
        Its operations in the order of evaluation, the result last.

    Raises
    ------
    InputError
        When it is called with names or shapes that do not fit, and for a derivative by what is no variable.

    Notes
    -----
    Made by parse_expression and by derivative: nothing of a text is ever run as code.

    Examples
    --------
    >>> from vectorplot import io
    >>> saddle = io.parse_expression("u^2 - v^2", ("u", "v"))
    >>> float(saddle(u=3, v=2))
    5.0
    >>> saddle.derivative("v")(u=[0, 1], v=2).tolist()
    [-4.0, -4.0]
    """

    text: str
    variables: tuple[str, ...]
    nodes: tuple[Node, ...]

    def __call__(self, **arrays: ArrayLike) -> NDArray[Any]:
        """The values of the formula.

        Parameters
        ----------
        **arrays : array_like of float or complex
            One for each variable that the formula uses; they are broadcast.

        Returns
        -------
        array of float64 or complex128
            Of the common shape of all arrays given; complex if one of them is.

        Raises
        ------
        InputError
            For a variable that the formula uses and that is missing, for a name it does not know, and for shapes that
            do not broadcast.

        Notes
        -----
        Complex arguments continue the real function from the real axis: abs, sign, min, max, floor, ceil and mod go by
        real parts, so that a complex step gives the derivative; log, sqrt and powers take their principal values.

        Degenerate: outside the domain of a function the value is NaN, at a pole infinite; no warnings.
        """
        if not self.used <= arrays.keys() or not arrays.keys() <= set(self.variables):
            raise self._misnamed(arrays)
        values = {name: np.asarray(array) for name, array in arrays.items()}
        kind = np.complex128 if any(np.iscomplexobj(array) for array in values.values()) else np.float64
        try:
            shape = np.broadcast_shapes(*(array.shape for array in values.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in values.items())
            raise InputError(f"the formula '{self._shown}' got arrays of shapes that do not fit: {shapes}") from None
        (result,) = self._program({name: array.astype(kind, copy=False) for name, array in values.items()})
        return np.array(np.broadcast_to(result, shape), dtype=kind)

    @cached_property
    def _program(self) -> Program:
        return Program.of(self.nodes, (len(self.nodes) - 1,))

    def _misnamed(self, arrays: Mapping[str, ArrayLike]) -> InputError:
        unknown = sorted(set(arrays) - set(self.variables))
        if unknown:
            return InputError(f"the formula '{self._shown}' has no variable {unknown[0]}")
        missing = sorted(self.used - set(arrays))
        return InputError(f"the formula '{self._shown}' needs a value of {missing[0]}")

    @property
    def _shown(self) -> str:
        return self.text if len(self.text) <= 60 else self.text[:57] + "..."

    @cached_property
    def used(self) -> frozenset[str]:
        """The variables that occur in the formula."""
        return frozenset(node.name for node in self.nodes if node.operation == "variable")

    def derivative(self, variable: str) -> Expression:
        """The exact partial derivative by a variable.

        Parameters
        ----------
        variable : str
            One of the formula's variables.

        Returns
        -------
        Expression
            In the same variables.

        Raises
        ------
        InputError
            For a variable the formula does not know, or a derivative of absurd length.

        Notes
        -----
        Degenerate: at a kink (abs at 0, min and max of equal values) the slope of one side, or 0; at steps 0; where the
        formula has no value the derivative may have one.
        """
        if variable not in self.variables:
            raise InputError(f"the formula '{self._shown}' has no variable {variable}")
        return Expression(f"d({self.text})/d{variable}", self.variables, derivative_nodes(self.nodes, variable))


def parse_expression(
    text: str, variables: Sequence[str], *, file: str | None = None, line: int | None = None
) -> Expression:
    """The expression that a text spells, such as ``sin(u)*cosh(v/2) - 3^-u``.

    Parameters
    ----------
    text : str
        The formula.
    variables : sequence of str
        The names it may use.
    file : str, optional
        What messages call the file.
    line : int, optional
        The line they name, from 1.

    Returns
    -------
    Expression
        A function of its variables.

    Raises
    ------
    InputError
        That names file, line, position (from 1), and what was expected; also for formulas longer than MAX_LENGTH
        (10,000 characters), deeper than MAX_DEPTH (50) or of more operations than MAX_NODES (2,000), and for variables
        that are no names or are taken by a function or a constant.

    Notes
    -----
    Understood are numbers, the variables, the constants pi, e and tau; + - * / with ^ or ** for powers, which group
    from the right and bind stronger than a sign; parentheses; sin cos tan asin acos atan sinh cosh tanh exp log log2
    log10 sqrt cbrt abs sign floor ceil of one argument, atan2(y, x) and mod(x, y) of two, min max hypot of two or more.
    Angles in radians; log is the natural logarithm; mod has the sign of its second argument.

    Examples
    --------
    >>> from vectorplot import io
    >>> wave = io.parse_expression("2*cos(pi*x)", ("x",))
    >>> wave(x=[0, 1, 2]).tolist()
    [2.0, -2.0, 2.0]
    >>> io.parse_expression("2*cos(y)", ("x",), file="waves.scene", line=3)
    Traceback (most recent call last):
    vectorplot.errors.InputError: waves.scene:3: position 7 of '2*cos(y)': unknown name (known are x pi e tau), got 'y'
    """
    names = tuple(variables)
    for name in names:
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name):
            raise InputError(f"{name[:40]!a} is no name for a variable", file=file, line=line)
        if name in FUNCTIONS or name in CONSTANTS:
            kind = "function" if name in FUNCTIONS else "constant"
            raise InputError(f"{name} is a {kind} and cannot name a variable", file=file, line=line)
    parser = Parser(text, names, file, line)
    place = parser.formula()
    return Expression(text, names, parser.tape.needed_for(place))
