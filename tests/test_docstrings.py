"""The docstrings of what `import vectorplot as vp` offers: sections, every parameter named, examples that run."""

from __future__ import annotations

import doctest
import enum
import inspect
import re

import pytest

import vectorplot as vp

ORDER = ["Parameters", "Returns", "Raises", "Warns", "Notes", "Examples"]
FUNCTIONS = [name for name in vp.__all__ if inspect.isfunction(getattr(vp, name))]
CLASSES = [name for name in vp.__all__ if inspect.isclass(getattr(vp, name))]


def sections(thing) -> dict[str, str]:
    """The text below each heading, in the order of the docstring; the summary's heading is empty."""
    first, *rest = re.split(r"^([A-Z]\w+)\n(-+)$", inspect.getdoc(thing) or "", flags=re.MULTILINE)
    for heading, rule in zip(rest[::3], rest[1::3], strict=True):
        assert len(rule) == len(heading), f"{heading}: underlined with {rule}"
    return {"": first, **dict(zip(rest[::3], rest[2::3], strict=True))}


def named(text: str) -> list[str]:
    """The names that a section explains: at the beginning of a line, before a colon."""
    lines = re.findall(r"^(\w+(?:, \w+)*) : ", text, flags=re.MULTILINE)
    return [name for line in lines for name in line.split(", ")]


def test_every_public_name_is_a_function_or_a_class():
    assert sorted([*FUNCTIONS, *CLASSES]) == sorted(vp.__all__)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_verb_explains_every_parameter_what_it_returns_and_what_it_refuses(name):
    verb = getattr(vp, name)
    found = sections(verb)
    assert named(found["Parameters"]) == list(inspect.signature(verb).parameters)
    assert ("Returns" in found) == (inspect.signature(verb).return_annotation != "None")
    assert "InputError" in found["Raises"]


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_explains_every_field(name):
    shown = getattr(vp, name)
    # What a kind is stands below each of its members.
    fields = [] if issubclass(shown, enum.Enum) else list(inspect.signature(shown).parameters)
    assert named(sections(shown).get("Parameters", "")) == fields


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_that_checks_its_fields_says_what_it_refuses(name):
    code = inspect.getsource(getattr(vp, name))
    refuses = "raise InputError" in code or "check_colour(" in code
    assert ("Raises" in sections(getattr(vp, name))) == refuses


@pytest.mark.parametrize("name", vp.__all__)
def test_docstrings_begin_with_one_sentence_and_keep_the_order_of_sections(name):
    found = sections(getattr(vp, name))
    summary = found.pop("").strip()
    assert summary.endswith(".") and "\n" not in summary
    assert list(found) == [heading for heading in ORDER if heading in found]


@pytest.mark.parametrize("name", vp.__all__)
def test_the_examples_run(name):
    thing = getattr(vp, name)
    (test,) = doctest.DocTestFinder(recurse=False).find(thing, name, module=inspect.getmodule(thing), globs={})
    assert test.examples
    assert doctest.DocTestRunner().run(test).failed == 0
