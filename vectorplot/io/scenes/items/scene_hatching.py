"""How the faces of an item are hatched, as scene files say it."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from vectorplot.errors import InputError
from vectorplot.io.scenes.scene_words import Words
from vectorplot.scene.hatching import HATCHED_ALONG, HATCHED_BY, Hatching

_NUMBERS = {"spacing": "spacing_mm", "angle": "angle_deg", "width": "width_mm"}
"""Words before a number, and the fields that it fills."""


def read_hatch(words: Words, at: int, owner: str) -> tuple[Hatching, int]:
    """The hatching that a word from HATCHED_BY, and what follows it, asks for; and the word behind.

    Errors: InputError with file and line for another word, a number that is out of range, a word that comes twice.
    """
    start, by = at, words.words[at]
    if by not in HATCHED_BY:
        words.fail(at, f"{owner}hatch: expected one of {', '.join(HATCHED_BY)}, got {words.shown(at)}")
    given: dict[str, Any] = {"by": by}
    at += 1
    while by != "none" and (word := words.words[at]) in (*_NUMBERS, "cross", "along"):
        field = _NUMBERS.get(word, word)
        if field in given:
            words.fail(at, f"{owner}hatch: '{word}' comes twice")
        at += 1
        if word in _NUMBERS:
            given[field] = words.number(at, owner, word)
            at += 1
        elif word == "along":
            given[field] = words.words[at]
            if given[field] not in HATCHED_ALONG:
                cause = f"hatch along: expected one of {', '.join(HATCHED_ALONG)}, got {words.shown(at)}"
                words.fail(at, owner + cause)
            at += 1
        else:
            given[field] = True
    try:
        return Hatching(**given), at
    except InputError as error:
        words.fail(start, owner + error.cause)


def hatch_text(hatching: Hatching) -> str:
    """The words for a hatching: what is not as usual."""
    usual = Hatching(hatching.by)
    own = {field.name: getattr(hatching, field.name) for field in fields(Hatching)}
    said = [f"{word} {own[field]!r}" for word, field in _NUMBERS.items() if own[field] != getattr(usual, field)]
    if hatching.cross:
        said.append("cross")
    if hatching.along != usual.along:
        said.append(f"along {hatching.along}")
    return " ".join(["hatch", hatching.by, *said])
