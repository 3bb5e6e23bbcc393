"""Conventions that hold in the whole package."""

from __future__ import annotations

import ast
import logging
import math
import re
import warnings
from pathlib import Path

import pytest
from support.sources import nodes_of, numbers_in, text_of, tree_of

import vectorplot
from vectorplot.cli.main import run
from vectorplot.io.scene_language import parse_scene

PACKAGE = Path(vectorplot.__file__).parent
FLOAT_HELD = re.compile(r"^\w[\w =]*=[\s(\\]*[\d_]*(?:\.|[eE][-+\d])", re.MULTILINE)
"""A name that a module gives to a float."""


def trees(where=lambda text: True):
    """The files of the package that may have what is looked for, each parsed: most others need not be."""
    for path in PACKAGE.rglob("*.py"):
        if where(text_of(path)):
            yield path.relative_to(PACKAGE), tree_of(path)


def is_pi_or_infinity(value):
    pi = any(abs(value - times * math.pi) < 1e-3 for times in (0.25, 0.5, 1.0, 2.0))
    return pi or value in (1e20, float("inf"))


@pytest.mark.slow
@pytest.mark.capability("G1.1-convention")
def test_nobody_writes_pi_or_infinity_down_again():
    wrong = []
    for path, tree in trees(lambda text: any(map(is_pi_or_infinity, numbers_in(text)))):
        for node in nodes_of(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, int | float) and node.value is not True:
                if is_pi_or_infinity(float(node.value)):
                    wrong.append((path.as_posix(), node.lineno, node.value))
    assert not wrong


@pytest.mark.parametrize("code", ["X = 0.5", "x = y = 1e-3", "X = (\n    .5\n)", "X = 1_0e3"])
def test_a_float_that_a_module_holds_is_seen_however_it_is_written(code):
    assert FLOAT_HELD.search(f"import math\n{code}\n")


@pytest.mark.slow
@pytest.mark.capability("G1.1-convention")
def test_constants_are_named_in_capitals_and_say_why():
    """Every number a module holds for others has a name in capitals and a line below it that says what it is."""
    silent = []
    for path, tree in trees(FLOAT_HELD.search):
        for node, after in zip(tree.body, [*tree.body[1:], None], strict=True):
            if not isinstance(node, ast.Assign) or not all(isinstance(t, ast.Name) for t in node.targets):
                continue
            if isinstance(node.value, ast.Constant) and isinstance(node.value.value, float):
                told = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
                name = node.targets[0].id
                if not name.lstrip("_").isupper() or not (told or name.startswith("_")):
                    silent.append(f"{path.as_posix()}: {name}")
    assert not silent


@pytest.mark.capability("G1.1-convention")
@pytest.mark.parametrize("verb", ["draw", "paint", "render", "info"])
def test_memory_that_cannot_be_had_is_one_line(verb, tmp_path, capsys, monkeypatch):
    def without_memory(*_, **__):
        raise MemoryError

    monkeypatch.setattr("vectorplot.io.read_file.read", without_memory)
    scene = tmp_path / "a.scene"
    scene.write_text("A box 1 1 1", encoding="utf-8")
    out = [] if verb == "info" else ["-o", str(tmp_path / "a.png")]
    assert run([verb, str(scene), *out]) == 1
    told = capsys.readouterr()
    assert told.out == "" and told.err.count("\n") == 1 and "memory" in told.err
    assert list(tmp_path.iterdir()) == [scene]


@pytest.mark.slow
@pytest.mark.capability("G1.1-convention")
@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
def test_the_command_sends_its_messages_to_stderr_and_its_result_to_stdout(verb, tmp_path, capfdbinary):
    scene = tmp_path / "a.scene"
    scene.write_text("camera eye 9 9 9 field_of_vision 70 A nocolour box 1 1 1", encoding="utf-8")
    small = {"draw": "--page=40x40", "paint": "--page=40x40", "render": "--size=120x90"}[verb]
    assert run([verb, str(scene), "-o", "-", "--format", "png", "--explain", small]) == 0
    result, messages = capfdbinary.readouterr()
    text = messages.decode("utf-8")
    assert result.startswith(b"\x89PNG")
    assert "unknown colour 'nocolour'" in text and "distorts" in text and "peak" in text


@pytest.mark.slow
@pytest.mark.capability("G1.1-convention")
def test_only_the_command_prints():
    for path, tree in trees(lambda text: "print" in text):
        if path.parts[0] == "cli":
            continue
        calls = [n for n in nodes_of(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)]
        assert "print" not in {n.func.id for n in calls}, path


@pytest.mark.capability("G1.1-convention")
def test_messages_can_be_sent_elsewhere(caplog, capsys):
    """What the package has to tell goes to the log of whoever calls it, once it asks for that, and nowhere else."""
    logging.captureWarnings(True)
    try:
        with warnings.catch_warnings(), caplog.at_level(logging.WARNING, logger="py.warnings"):
            warnings.simplefilter("always")
            scene = parse_scene("A nocolour box 1 1 1")
            vectorplot.draw(scene, vectorplot.Camera((3.0, -5.0, 4.0), fov_deg=80.0))
    finally:
        logging.captureWarnings(False)
    assert "InputWarning" in caplog.text and "A: unknown colour 'nocolour'" in caplog.text
    assert capsys.readouterr() == ("", "")
