"""The package's own files, parsed once for all tests that read them."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

NUMBER = re.compile(r"(?<![\w.])(?:0[xXoObB]\w+|(?:\d[\d_]*\.?[\d_]*|\.\d[\d_]*)(?:[eE][-+]?[\d_]+)?)")
"""A number as it may be written in a file."""

OF_STATEMENTS = ("body", "orelse", "finalbody", "handlers", "cases")
"""The fields of nodes that hold statements, or what holds some."""


@cache
def text_of(path: Path) -> str:
    """A file as it is written."""
    return path.read_text(encoding="utf-8")


@cache
def tree_of(path: Path) -> ast.Module:
    """What a file says; not to be changed."""
    return ast.parse(text_of(path))


@cache
def statements_of(tree: ast.Module) -> tuple[ast.AST, ...]:
    """All statements of a file, those inside others too, in no order: a tenth of what there is to look at."""
    found: list[ast.AST] = [tree]
    for node in found:
        for field in OF_STATEMENTS:
            found += getattr(node, field, ())
    return tuple(found)


@cache
def nodes_of(tree: ast.AST) -> tuple[ast.AST, ...]:
    """All that a file says, in no order: as ast.walk has it, in half its time."""
    found = [tree]
    for node in found:
        for value in vars(node).values():
            if isinstance(value, ast.AST):
                found.append(value)
            elif isinstance(value, list):
                found += [part for part in value if isinstance(part, ast.AST)]
    return tuple(found)


def numbers_in(text: str) -> set[int | float]:
    """The numbers that a file has, in its strings and comments too: what is none of them no node of it is."""
    return {value for word in set(NUMBER.findall(text)) if (value := _value(word)) is not None}


@cache
def _value(word: str) -> int | float | None:
    """What Python takes a word for; None if for no number."""
    try:
        return ast.literal_eval(word)
    except SyntaxError:
        return None
