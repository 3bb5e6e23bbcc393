"""The docstrings of what `import vectorplot as vp` and its rooms offer: sections, every parameter named, examples."""

from __future__ import annotations

import dataclasses
import doctest
import enum
import functools
import importlib
import inspect
import re
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any

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


@pytest.mark.parametrize("name", [*FUNCTIONS, *METHODS])
def test_a_function_explains_every_parameter_what_it_returns_and_what_it_refuses(name):
    signature, found = inspect.signature(thing(name)), sections(thing(name))
    assert named(found["Parameters"]) == [parameter for parameter in signature.parameters if parameter != "self"]
    assert ("Returns" in found) == (signature.return_annotation != "None")
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


@pytest.mark.parametrize("name", [*vp.__all__, *METHODS])
def test_docstrings_begin_with_one_sentence_and_keep_the_order_of_sections(name):
    found = sections(thing(name))
    summary = found.pop("").strip()
    assert summary.endswith(".") and "\n" not in summary
    assert list(found) == [heading for heading in ORDER if heading in found]


@pytest.mark.parametrize("name", [*vp.__all__, *METHODS])
def test_the_examples_run(name):
    shown = thing(name)
    (test,) = doctest.DocTestFinder(recurse=False).find(shown, name, module=inspect.getmodule(shown), globs={})
    assert test.examples
    assert doctest.DocTestRunner().run(test).failed == 0


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


@pytest.mark.parametrize("name", IN_ROOMS)
def test_what_a_room_offers_explains_every_parameter_and_what_it_returns(name):
    shown, found = in_room(name), sections(in_room(name))
    summary = found.pop("").strip()
    assert summary.endswith(".") and "\n" not in summary
    assert list(found) == [heading for heading in ORDER if heading in found]
    if inspect.isfunction(shown):
        signature = inspect.signature(shown)
        assert named(found.get("Parameters", "")) == list(signature.parameters)
        assert ("Returns" in found) == (signature.return_annotation != "None")
    elif dataclasses.is_dataclass(shown):
        assert named(found.get("Parameters", "")) == list(inspect.signature(shown).parameters)
    if "raise InputError" in inspect.getsource(shown):
        assert "InputError" in found["Raises"]


def with_sections(name: str) -> list[str]:
    """The public functions of a class of a room that explain what they are given."""
    own = {key: getattr(in_room(name), key) for key in vars(in_room(name)) if not key.startswith("_")}
    functions = {key: value for key, value in own.items() if callable(value) and not inspect.isclass(value)}
    return [f"{name}.{key}" for key, value in functions.items() if "Parameters" in sections(value)]


@pytest.mark.parametrize("name", [method for name in IN_ROOMS for method in with_sections(name)])
def test_functions_of_classes_that_explain_what_they_are_given_explain_all_of_it(name):
    *owner, key = name.split(".")
    shown = getattr(in_room(".".join(owner)), key)
    signature, found = inspect.signature(shown), sections(shown)
    summary = found.pop("").strip()
    assert summary.endswith(".") and "\n" not in summary
    assert list(found) == [heading for heading in ORDER if heading in found]
    assert named(found["Parameters"]) == [parameter for parameter in signature.parameters if parameter != "self"]
    assert ("Returns" in found) == (signature.return_annotation != "None")
    if "raise InputError" in inspect.getsource(shown):
        assert "InputError" in found["Raises"]


@pytest.mark.parametrize("name", IN_ROOMS)
def test_the_examples_of_what_a_room_offers_run(name):
    shown = in_room(name)
    (test,) = doctest.DocTestFinder(recurse=False).find(shown, name, module=inspect.getmodule(shown), globs={})
    assert test.examples
    assert doctest.DocTestRunner().run(test).failed == 0


def own_types(hint: Any) -> Iterator[type]:
    """The classes of this package that an annotation names, however deep."""
    if inspect.isclass(hint) and hint.__module__.startswith("vectorplot."):
        yield hint
    for part in hint if isinstance(hint, list) else typing.get_args(hint):
        yield from own_types(part)


def test_what_the_functions_of_rooms_take_and_give_is_offered_too():
    offered = {*(getattr(vp, name) for name in CLASSES), *(in_room(name) for name in IN_ROOMS)}
    missing = {}
    for name in IN_ROOMS:
        if inspect.isfunction(in_room(name)):
            hints = typing.get_type_hints(in_room(name)).values()
            missing |= {found.__name__: name for hint in hints for found in own_types(hint) if found not in offered}
    assert not missing
