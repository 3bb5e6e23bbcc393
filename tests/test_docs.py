"""The pages of docs/ say what the package does: their Python runs, their commands work, their links lead somewhere."""

from __future__ import annotations

import importlib.util
import io
import os
import re
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest
from support.cad_parts import bearing
from support.paths import ROOT

import vectorplot as vp
from vectorplot.cli.commands.accuracy import accuracy
from vectorplot.cli.commands.anamorphosis import anamorphosis
from vectorplot.cli.commands.animate import animate
from vectorplot.cli.commands.contact_sheet import contact_sheet
from vectorplot.cli.commands.develop import develop
from vectorplot.cli.commands.draw import draw
from vectorplot.cli.commands.info import info
from vectorplot.cli.commands.paint import paint
from vectorplot.cli.commands.render import render
from vectorplot.cli.commands.replay import replay
from vectorplot.cli.commands.sheet import sheet
from vectorplot.cli.commands.speed import speed
from vectorplot.cli.commands.try_ import try_
from vectorplot.cli.main import run
from vectorplot.geometry.component_arrays import dot

DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.glob("*.md")), *sorted(DOCS.glob("*/*.md"))]


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL)


def code_of(page: Path) -> list[str]:
    """What a page shows as code within its sentences and tables."""
    prose = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    return re.findall(r"`([^`\n]+)`", prose)


COMMANDS = [
    line
    for page in PAGES
    for block in blocks(page, "sh")
    for line in block.splitlines()
    if line.startswith("vectorplot ") and "INPUT" not in line and "NAME" not in line
]

VERBS = [accuracy, anamorphosis, animate, contact_sheet, develop, draw, info, paint, render, replay, sheet, speed, try_]

FOREIGN = {"--help", "--no-deps", "--hypothesis-profile", "--nthreads"}
"""Options of other programs that pages name, and of all commands."""

FILES = {
    name: text
    for page in PAGES
    for name, text in re.findall(
        r"into a file `([^`]+)`[^`]*```text\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL
    )
}
"""What readers are asked to write."""


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    """The data, copied once for all commands."""
    return shutil.copytree(ROOT / "data", tmp_path_factory.mktemp("checkout") / "data")


@pytest.fixture
def checkout(data, tmp_path, monkeypatch):
    """A folder with the data, which one may write into."""
    shutil.copytree(data, tmp_path / "data", copy_function=os.link)
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.slow
@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "python")], ids=lambda page: page.name)
def test_the_python_of_the_pages_runs(page, checkout, capsys):
    code = "\n".join(blocks(page, "python"))
    if "build123d" in code:
        pytest.importorskip("build123d")
    exec(compile(code, page.name, "exec"), {})
    for name in re.findall(r'vp\.save\(\w+, "([^"]+)"\)', code):
        assert (checkout / name).stat().st_size > 100, name
    # The painted town says how many it has.
    assert page.name != "paint.md" or "polygons" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize("command", sorted(set(COMMANDS)))
def test_the_commands_of_the_pages_work(command, checkout, capfdbinary):
    words = shlex.split(command)
    if "bearing.step" in words:
        pytest.importorskip("OCP")
        bearing(checkout / "bearing.step")
    assert run(words[1:]) == 0
    out, _ = capfdbinary.readouterr()
    if "-o" in words and words[words.index("-o") + 1] != "-":
        assert (checkout / words[words.index("-o") + 1]).stat().st_size > 0
    else:
        assert out


@pytest.mark.parametrize(
    "command",
    VERBS,
    ids=lambda command: command.name,
)
def test_every_option_is_on_the_page_of_the_command(command):
    page = (DOCS / "command.md").read_text(encoding="utf-8")
    for parameter in command.params:
        for option in (*parameter.opts, *parameter.secondary_opts):
            if option.startswith("-"):
                assert f"`{option}" in page, option


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_options_in_the_sentences_of_a_page_exist(page):
    named = {option for code in code_of(page) for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", code)}
    known = {
        option for verb in VERBS for parameter in verb.params for option in (*parameter.opts, *parameter.secondary_opts)
    }
    assert named <= known | FOREIGN


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_pictures_lead_somewhere(page):
    text = page.read_text(encoding="utf-8")
    targets = re.findall(r"\]\(([^)#]+)\)", text) + re.findall(r'src="([^"]+)"', text)
    for target in targets:
        if "://" not in target:
            assert (page.parent / target).exists(), target


def test_every_page_is_listed_on_the_first_one():
    index = (DOCS / "index.md").read_text(encoding="utf-8")
    for page in PAGES:
        if page.is_relative_to(DOCS) and page.name != "index.md":
            assert f"]({page.relative_to(DOCS).as_posix()})" in index


def test_the_names_that_pages_and_examples_use_are_public():
    texts = [page.read_text(encoding="utf-8") for page in (*PAGES, *(ROOT / "examples").glob("*.py"))]
    names = {name for text in texts for name in re.findall(r"\bvp\.([A-Za-z_]\w*)", text)}
    assert names and names <= set(vp.__all__)
    for name in vp.__all__:
        assert getattr(vp, name) is not None


ROOMS = sorted(stub.parent.name for stub in (ROOT / "vectorplot").glob("*/__init__.pyi"))
"""Those with a list of what they export."""


def is_name(path: str) -> bool:
    """Whether something in a room has a dotted name; what follows a class is not looked at."""
    room, *parts = path.split(".")
    # Python has a room of this name, too.
    if room == "io" and parts[0] in io.__all__:
        return True
    found, place = importlib.import_module(f"vectorplot.{room}"), f"vectorplot.{room}"
    for part in parts:
        place += f".{part}"
        if isinstance(found, type) or part == "py":
            return True
        if not hasattr(found, part) and importlib.util.find_spec(place) is None:
            return False
        found = getattr(found, part, None) or importlib.import_module(place)
    return True


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_names_in_the_sentences_of_a_page_exist(page):
    public = {name for room in ROOMS for name in importlib.import_module(f"vectorplot.{room}").__all__} | set(
        vp.__all__
    )
    for code in code_of(page):
        dotted = re.fullmatch(rf"(?:vectorplot\.)?((?:{'|'.join(ROOMS)}|io|save)(?:\.\w+)+)(?:\(.*)?", code)
        # A drawing, painted polygons and the like have fields.
        if dotted and not re.match(r"drawing\.[a-z]", code):
            assert is_name(dotted[1]), code
        for made in re.findall(r"(?<![\w./\"-])([A-Z][a-z]+[A-Z]\w*|[A-Z][a-z]+)\(", code):
            assert made in public, code
        if re.fullmatch(r"(?:vectorplot|docs|examples|data|tests)/[\w./-]+\.\w+", code):
            assert (ROOT / code).exists(), code


def test_the_page_of_the_textbook_names_every_file_of_it():
    from vectorplot import textbook

    page = (DOCS / "textbook.md").read_text(encoding="utf-8")
    named = {name for name in textbook.__all__ if f"`{name}`" in page}
    files = {path.stem for path in (ROOT / "vectorplot" / "textbook").rglob("[a-z]*.py")}
    assert {getattr(textbook, name).__module__.rpartition(".")[2] for name in named} == files


@pytest.mark.capability("GB.2/3-notes")
def test_the_page_of_the_textbook_says_what_became_of_the_remarks_on_languages():
    page = (DOCS / "textbook.md").read_text(encoding="utf-8")
    said = page.partition("## What the book says of languages")[2]
    assert "(B.2)" in said and "(B.3)" in said
    # What is said there is true of the kit it names: a call for a whole array, on views of the same memory.
    points = np.arange(12.0).reshape(4, 3)
    assert np.shares_memory(points, points.T)
    assert dot(points.T, points.T).tolist() == [sum(x * x for x in point) for point in points.tolist()]
