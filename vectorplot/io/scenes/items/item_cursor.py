"""Where one is in the text of a scene file, and what all readers of items ask there."""

from __future__ import annotations

import warnings
from typing import NoReturn

from vectorplot.errors import InputWarning
from vectorplot.io.named_files import NamedFiles
from vectorplot.io.scenes.items.scene_item import Draft
from vectorplot.io.scenes.scene_words import Words
from vectorplot.words import COLOURS, PALETTES, is_colour, nearest


class ItemCursor:
    """Reads words from left to right; at: the next one; places: where the items before this one stand, by name; files:
    those that the text may name, none where it stands in no file itself."""

    def __init__(self, words: Words, files: NamedFiles | None = None) -> None:
        self.source = words
        self.files = files
        self.words = words.words
        self.at = 0
        self.places: dict[str, int] = {}

    def fail(self, cause: str, draft: Draft | None = None) -> NoReturn:
        """Raise InputError for the next word; draft: the item it belongs to."""
        self.source.fail(self.at, cause if draft is None else draft.owner + cause)

    def warn(self, cause: str) -> None:
        """Warn of the next word."""
        line = self.source.line(self.at)
        warnings.warn(f"{self.source.name}:{line}: {cause}", InputWarning, stacklevel=2)

    def colour(self, owner: str) -> str:
        """The colour at the next word; an unknown one is gray."""
        word = self.words[self.at]
        if not word or word == "," or self.source.is_number(self.at):
            self.source.fail(self.at, f"{owner}: expected a colour, got {self.source.shown(self.at)}")
        name = self.source.string(self.at)
        if not is_colour(name):
            near = nearest(name.lower(), COLOURS)
            known = (
                f"did you mean '{near}'?"
                if near
                else f"known: {', '.join(PALETTES)}, black, white, red, #rrggbb in quotes"
            )
            self.warn(f"{owner}: unknown colour '{name[:40]}', gray is used ({known})")
            name = "gray"
        self.at += 1
        return name

    def kind(self, draft: Draft, kind: str) -> None:
        """Say which kind of item it is; an error where it is another one already."""
        if draft.kind is not None and draft.kind != kind:
            self.fail(
                f"is a '{draft.kind}' already, '{self.words[self.at]}' does not fit; an item begins with its name",
                draft,
            )
        draft.kind = kind
        draft.kind_index = self.at

    def once(self, draft: Draft, attribute: str) -> None:
        """Step over a word that may stand only once in an item."""
        if getattr(draft, attribute) is not None:
            self.fail(f"a second '{self.words[self.at]}'", draft)
        self.at += 1

    def none(self) -> bool:
        """Whether the word none stands here; steps over it."""
        found = self.words[self.at] == "none"
        self.at += found
        return found
