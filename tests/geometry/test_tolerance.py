"""Conventions that hold in the whole package."""

from __future__ import annotations

import ast
import logging
import warnings
from pathlib import Path

import pytest

import vectorplot
from vectorplot.errors import InputWarning
from vectorplot.geometry import tolerance

PACKAGE = Path(vectorplot.__file__).parent
CONSTANTS = {"ZERO_OF_EXTENT", "PARALLEL_SINE", "ROUNDING", "INFINITE"}


def trees():
    for path in PACKAGE.rglob("*.py"):
        yield path.relative_to(PACKAGE), ast.parse(path.read_text(encoding="utf-8"))


@pytest.mark.capability("G1.1-convention")
def test_central_constants_live_in_one_place():
    homes = {}
    for path, tree in trees():
        for node in tree.body:
            if isinstance(node, ast.Assign):
                for name in CONSTANTS & {t.id for t in node.targets if isinstance(t, ast.Name)}:
                    homes.setdefault(name, []).append(path.as_posix())
    assert homes == {name: ["geometry/tolerance.py"] for name in CONSTANTS}
    # Double precision: far below the size of what it is added to, and not absorbed by it (erratum G1-06).
    assert 2.0 + tolerance.ZERO_OF_EXTENT > 2.0 and 2.0 + tolerance.ROUNDING > 2.0


@pytest.mark.capability("G1.1-convention")
def test_only_the_command_prints():
    for path, tree in trees():
        if path.parts[0] == "cli":
            continue
        calls = [n for n in ast.walk(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)]
        assert "print" not in {n.func.id for n in calls}, path


@pytest.mark.capability("G1.1-convention")
def test_messages_can_be_sent_elsewhere(caplog):
    logging.captureWarnings(True)
    try:
        with warnings.catch_warnings(), caplog.at_level(logging.WARNING, logger="py.warnings"):
            warnings.simplefilter("always")
            warnings.warn("three faces dropped", InputWarning, stacklevel=1)
    finally:
        logging.captureWarnings(False)
    assert "three faces dropped" in caplog.text
