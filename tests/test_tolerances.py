"""Every number that decides what counts as zero stands in one table, with a name and a reason."""

from __future__ import annotations

import ast
import importlib.util
import re
import sys
from collections import Counter
from pathlib import Path

import pytest
from support.paths import DOCS
from support.sources import nodes_of, numbers_in, text_of, tree_of

import vectorplot
from vectorplot.tolerances import ROUNDING, ZERO_OF_EXTENT

PACKAGE = Path(vectorplot.__file__).parent
TABLE = PACKAGE / "tolerances.py"
SMALL = 1e-3
"""A number no larger is no size of anything and no coefficient: it decides what counts as nothing."""

OTHERWISE = re.compile(r"\*\*[\s(]*-|\b(?:eps|epsneg|tiny|smallest_normal)\b")
"""How a small number is written that is no literal."""

BINDING = re.compile(r"^\w.*=|^[\[(][^=]*=", re.MULTILINE)
"""What stands left of a sign of equality in no function or class: names that a module may give a meaning."""

CHECKER = {
    f"testing/{name}.py" for name in ("check_certificate", "certified_drawing", "certified_image", "certified_surfaces")
}
SHAPES = {"testing/shapes.py", *CHECKER}
"""Shapes that tests are made with may be as thin as they like; the checker of certificates imports nothing of ours."""


@pytest.fixture(scope="module")
def table():
    spec = importlib.util.spec_from_file_location("docs_tolerances", DOCS / "tolerances.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def small_numbers(tree):
    """The lines on which a small number is written: as a literal, as a power, or as what numpy knows of floats."""
    for node in nodes_of(tree):
        literal = isinstance(node, ast.Constant) and isinstance(node.value, float) and 0.0 < abs(node.value) <= SMALL
        power = (
            isinstance(node, ast.BinOp)
            and isinstance(node.op, ast.Pow)
            and isinstance(node.left, ast.Constant)
            and isinstance(node.right, ast.UnaryOp)
            and isinstance(node.right.op, ast.USub)
            and isinstance(node.right.operand, ast.Constant)
            and node.left.value ** float(-node.right.operand.value) <= SMALL
        )
        known = isinstance(node, ast.Attribute) and node.attr in {"eps", "epsneg", "tiny", "smallest_normal"}
        if literal or power or known:
            yield node.lineno


def may_have_small_numbers(text):
    """Whether a file has what only numbers that are small are written with: most need not be parsed."""
    return any(0.0 < value <= SMALL for value in numbers_in(text)) or OTHERWISE.search(text) is not None


@pytest.mark.parametrize(
    "code", ["x < 1e-9", "FLAT = 1e-3", "f(zero=1e-12)", "2.0**-40", "1 - 1e-8", "info.eps", "-1e-7"]
)
def test_a_small_number_is_seen_however_it_is_written(code):
    assert may_have_small_numbers(code)
    assert list(small_numbers(ast.parse(code))) == [1]


@pytest.mark.parametrize("code", ["x < 0.01", "x**-2", "2.0**-3", "0.0", "1e3", "5e-3", "steps = 0"])
def test_sizes_and_coefficients_are_no_tolerances(code):
    assert not list(small_numbers(ast.parse(code)))


@pytest.mark.slow
@pytest.mark.capability("G1.1-convention")
def test_no_small_number_stands_outside_the_table():
    bare = []
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE).as_posix()
        if path != TABLE and name not in SHAPES:
            if may_have_small_numbers(text_of(path)):
                bare += [f"vectorplot/{name}:{line}" for line in small_numbers(tree_of(path))]
    assert not bare, "give it a name and a reason in vectorplot/tolerances.py: " + ", ".join(bare)


@pytest.mark.capability("G1.1-convention")
def test_every_tolerance_has_a_reason_and_one_home(table):
    entries = list(table.tolerances(text_of(TABLE)))
    assert not [entry.name for entry in entries if len(entry.reason) < 30 or not entry.name.isupper()]
    assert not [name for name, count in Counter(entry.name for entry in entries).items() if count > 1]


@pytest.mark.slow
@pytest.mark.capability("G1.1-convention")
def test_nobody_gives_a_name_of_the_table_another_meaning(table):
    names = {entry.name for entry in table.tolerances(text_of(TABLE))}
    again = []
    for path in sorted(set(PACKAGE.rglob("*.py")) - {TABLE}):
        bindings = " ".join(BINDING.findall(text_of(path)))
        if names.isdisjoint(re.findall(r"\w+", bindings)):
            continue
        for node in tree_of(path).body:
            if isinstance(node, ast.Assign):
                bound = {part.id for target in node.targets for part in ast.walk(target) if isinstance(part, ast.Name)}
                again += [f"{path.relative_to(PACKAGE).as_posix()}: {name}" for name in bound & names]
    assert not again


@pytest.mark.slow
def test_every_tolerance_is_used(table):
    used = table.uses()
    assert not [
        entry.name
        for entry in table.tolerances(text_of(TABLE))
        if not used.get(entry.name) and text_of(TABLE).count(entry.name) < 2
    ]


@pytest.mark.slow
def test_the_page_of_tolerances_is_fresh(table):
    assert (DOCS / "tolerances.md").read_text(encoding="utf-8") == table.page(), "run python docs/tolerances.py"


@pytest.mark.capability("G1.1-convention")
def test_zero_is_far_below_what_it_is_added_to_and_not_absorbed_by_it():
    """In double precision (erratum G1-06)."""
    assert 2.0 + ZERO_OF_EXTENT > 2.0 and 2.0 + ROUNDING > 2.0
