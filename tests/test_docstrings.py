"""The docstrings of what `import vectorplot as vp` and its rooms offer: sections, every parameter named, examples."""

from __future__ import annotations

import dataclasses
import doctest
import enum
import functools
import importlib
import inspect
import re
from pathlib import Path

import pytest

import vectorplot as vp

ORDER = ["Parameters", "Returns", "Raises", "Warns", "Notes", "Examples"]
PACKAGE = Path(vp.__file__).parent
FUNCTIONS = [name for name in vp.__all__ if inspect.isfunction(getattr(vp, name))]
CLASSES = [name for name in vp.__all__ if inspect.isclass(getattr(vp, name))]


def with_parameters(name: str) -> list[str]:
    """The public functions of a class that are given something."""
    shown = getattr(vp, name)
    own = {f"{name}.{key}": getattr(shown, key) for key in vars(shown) if not key.startswith("_")}
    functions = {key: value for key, value in own.items() if callable(value)}
    return [key for key, value in functions.items() if {*inspect.signature(value).parameters} - {"self"}]


METHODS = [method for name in CLASSES for method in with_parameters(name)]


def thing(name: str):
    """What a name stands for, with a dot that of a class."""
    return functools.reduce(getattr, name.split("."), vp)


def sections(shown) -> dict[str, str]:
    """The text below each heading, in the order of the docstring; the summary's heading is empty."""
    first, *rest = re.split(r"^([A-Z]\w+)\n(-+)$", inspect.getdoc(shown) or "", flags=re.MULTILINE)
    for heading, rule in zip(rest[::3], rest[1::3], strict=True):
        assert len(rule) == len(heading), f"{heading}: underlined with {rule}"
    return {"": first, **dict(zip(rest[::3], rest[2::3], strict=True))}


def named(text: str) -> list[str]:
    """The names that a section explains: at the beginning of a line, before a colon."""
    lines = re.findall(r"^(\w+(?:, \w+)*) : ", text, flags=re.MULTILINE)
    return [name for line in lines for name in line.split(", ")]


def test_every_public_name_is_a_function_or_a_class():
    assert sorted([*FUNCTIONS, *CLASSES]) == sorted(vp.__all__)


# One test for all names: pytest takes longer to hold a test than it takes to read a docstring.
def test_functions_explain_every_parameter_what_they_return_and_what_they_refuse():
    for name in (*FUNCTIONS, *METHODS):
        signature, found = inspect.signature(thing(name)), sections(thing(name))
        assert named(found["Parameters"]) == [key for key in signature.parameters if key != "self"], name
        assert ("Returns" in found) == (signature.return_annotation != "None"), name
        assert "InputError" in found["Raises"], name


def test_classes_explain_every_field():
    for name in CLASSES:
        shown = getattr(vp, name)
        # What a kind is stands below each of its members.
        fields = [] if issubclass(shown, enum.Enum) else list(inspect.signature(shown).parameters)
        assert named(sections(shown).get("Parameters", "")) == fields, name


def test_classes_that_check_their_fields_say_what_they_refuse():
    for name in CLASSES:
        code = inspect.getsource(getattr(vp, name))
        refuses = "raise InputError" in code or "check_colour(" in code
        assert ("Raises" in sections(getattr(vp, name))) == refuses, name


def assert_sections_are_in_order(name: str, shown) -> dict[str, str]:
    """The sections of a docstring that begins with one sentence, without it."""
    found = sections(shown)
    summary = found.pop("").strip()
    assert summary.endswith(".") and "\n" not in summary, name
    assert list(found) == [heading for heading in ORDER if heading in found], name
    return found


def test_docstrings_begin_with_one_sentence_and_keep_the_order_of_sections():
    for name in (*vp.__all__, *METHODS):
        assert_sections_are_in_order(name, thing(name))


def assert_its_examples_run(name: str, shown) -> None:
    (test,) = doctest.DocTestFinder(recurse=False).find(shown, name, module=inspect.getmodule(shown), globs={})
    assert test.examples, name
    assert doctest.DocTestRunner().run(test).failed == 0, name


@pytest.mark.slow
@pytest.mark.parametrize("name", vp.__all__)
def test_the_examples_run(name):
    for each in (name, *(method for method in METHODS if method.startswith(f"{name}."))):
        assert_its_examples_run(each, thing(each))


ROOMS = sorted(stub.parent.name for stub in PACKAGE.glob("*/__init__.pyi"))


def names_of(room: str) -> list[str]:
    """The functions and classes that a room offers beside those of vp, as room.name."""
    offered = importlib.import_module(f"vectorplot.{room}")
    things = {name: getattr(offered, name) for name in offered.__all__ if not hasattr(vp, name)}
    return [f"{room}.{name}" for name, shown in things.items() if inspect.isfunction(shown) or inspect.isclass(shown)]


IN_ROOMS = [name for room in ROOMS for name in names_of(room)]


def in_room(name: str):
    room, shown = name.split(".")
    return getattr(importlib.import_module(f"vectorplot.{room}"), shown)


@pytest.mark.parametrize("room", ROOMS)
def test_what_a_room_offers_explains_every_parameter_and_what_it_returns(room):
    for name in names_of(room):
        shown = in_room(name)
        found = assert_sections_are_in_order(name, shown)
        if inspect.isfunction(shown):
            signature = inspect.signature(shown)
            assert named(found.get("Parameters", "")) == list(signature.parameters), name
            assert ("Returns" in found) == (signature.return_annotation != "None"), name
        elif dataclasses.is_dataclass(shown):
            assert named(found.get("Parameters", "")) == list(inspect.signature(shown).parameters), name
        if "raise InputError" in inspect.getsource(shown):
            assert "InputError" in found["Raises"], name


def with_sections(name: str) -> list[str]:
    """The public functions of a class of a room that explain what they are given."""
    own = {key: getattr(in_room(name), key) for key in vars(in_room(name)) if not key.startswith("_")}
    functions = {key: value for key, value in own.items() if callable(value) and not inspect.isclass(value)}
    return [key for key, value in functions.items() if "Parameters" in sections(value)]


@pytest.mark.parametrize("room", ROOMS)
def test_functions_of_classes_that_explain_what_they_are_given_explain_all_of_it(room):
    for name in names_of(room):
        for key in with_sections(name):
            shown = getattr(in_room(name), key)
            signature, found = inspect.signature(shown), assert_sections_are_in_order(f"{name}.{key}", shown)
            assert named(found["Parameters"]) == [part for part in signature.parameters if part != "self"], (name, key)
            assert ("Returns" in found) == (signature.return_annotation != "None"), (name, key)
            if "raise InputError" in inspect.getsource(shown):
                assert "InputError" in found["Raises"], (name, key)


@pytest.mark.slow
@pytest.mark.parametrize("room", ROOMS)
def test_the_examples_of_what_a_room_offers_run(room):
    for name in names_of(room):
        assert_its_examples_run(name, in_room(name))
