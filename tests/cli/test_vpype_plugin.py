"""Drawings enter pipelines of vpype by a command of ours among its own."""

from __future__ import annotations

import re
import shlex
import tomllib
from importlib import import_module

import click
import pytest
from support.paths import ROOT

import vectorplot as vp

vpype_cli = pytest.importorskip("vpype_cli")
MM = 96.0 / 25.4
HOUSE = ROOT / "data" / "house.scene"


@pytest.fixture(scope="module")
def execute():
    """What runs a pipeline, with the command that the entry point names."""
    told = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["entry-points"]["vpype.plugins"]
    ((name, place),) = told.items()
    module, _, function = place.partition(":")
    command = getattr(import_module(module), function)
    assert command.name == name
    vpype_cli.cli.add_command(command)
    yield vpype_cli.execute
    del vpype_cli.cli.commands[name]


def test_layers_pens_and_page_are_those_of_the_drawing(execute):
    document = execute(f"vectorplot --layers pen --style plotter --frame --page A5 {HOUSE}")
    drawing = vp.draw(HOUSE, page="A5", layers="pen", style="plotter", frame=True)
    assert document.page_size == pytest.approx((148.0 * MM, 210.0 * MM))
    assert len(document.layers) == len(drawing.layers)
    for lines, layer in zip(document.layers.values(), drawing.layers, strict=True):
        assert len(lines) == sum(map(len, layer.strokes))
        assert str(lines.property("vp_color")) == layer.pen.colour
        assert lines.property("vp_pen_width") / MM == pytest.approx(layer.pen.width_mm)
        assert lines.property("vp_name").endswith(layer.name)


def test_several_drawings_and_commands_of_vpype_make_one_pipeline(execute):
    one, two = (execute(f"vectorplot --layers pen --pen 0.3 {HOUSE}") for _ in range(2))
    both = execute(
        f"vectorplot --layers pen --pen 0.3 {HOUSE} translate 10mm 0 vectorplot --layers pen --pen 0.3 {HOUSE}"
    )
    assert len(both.layers[1]) == len(one.layers[1]) + len(two.layers[1])


def test_what_is_wrong_is_one_line(execute):
    with pytest.raises(click.ClickException, match="no such file"):
        execute(f"vectorplot {ROOT / 'data' / 'nothing.scene'}")
    with pytest.raises(click.ClickException, match="expected one of kind, object, colour, pen"):
        execute(f"vectorplot --layers pens {HOUSE}")


# vpype leaves its file open.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning", "ignore::ResourceWarning")
def test_commands_of_the_page_work(execute, tmp_path):
    page = (ROOT / "docs" / "for_plotters.md").read_text("utf-8")
    (command,) = re.findall(r"^    vpype (vectorplot .* write) (.*\.svg)$", page, re.MULTILINE)
    words = [str(ROOT / word) if word.startswith("data/") else word for word in shlex.split(command[0])]
    execute(shlex.join([*words, str(tmp_path / command[1])]))
    assert (tmp_path / command[1]).read_text("utf-8").startswith("<?xml")
