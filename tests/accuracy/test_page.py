"""docs/accuracy.md shows every approximation, as docs/accuracy.py writes it."""

from __future__ import annotations

import importlib.util
import re

import pytest
from support.paths import DOCS

import vectorplot as vp
from vectorplot.accuracy.verb import APPROXIMATIONS

PAGE = (DOCS / "accuracy.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def writer():
    spec = importlib.util.spec_from_file_location("accuracy_page", DOCS / "accuracy.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("one", APPROXIMATIONS, ids=lambda one: one.name)
def test_every_approximation_has_its_words_and_its_plot(one):
    assert f"## {one.title}\n\n`{one.name}`: {one.about}\n\n![{one.title}](accuracy/{one.name}.svg)" in PAGE
    assert f"| {one.knob} | " in PAGE
    assert (DOCS / "accuracy" / f"{one.name}.svg").read_text(encoding="utf-8").startswith("<?xml")


def without_times(text: str) -> str:
    return re.sub(r"\([\d.e+-]+ ms\)", "", text)


def test_the_page_is_fresh_but_for_its_times(writer):
    assert PAGE.startswith(writer.INTRO)
    found = vp.accuracy("refraction", "arc-fit")
    for one in found:
        assert without_times(writer.section(one)) in without_times(PAGE)
    assert without_times(writer.page(found, PAGE)) == without_times(PAGE), "what is not measured stays"


def test_notes_are_about_approximations(writer):
    assert set(writer.NOTES) <= {one.name for one in APPROXIMATIONS}
