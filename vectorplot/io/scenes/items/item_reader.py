"""The words of an item of a scene file, read one after the other into a draft."""

from __future__ import annotations

from collections.abc import Callable

from vectorplot.io.scenes.items.item_cursor import ItemCursor
from vectorplot.io.scenes.items.line_words import SURFACE_LINE_WORDS
from vectorplot.io.scenes.items.look_words import LOOK_WORDS
from vectorplot.io.scenes.items.place_words import MODIFIERS, PLACE_WORDS
from vectorplot.io.scenes.items.scene_item import Draft
from vectorplot.io.scenes.items.shape_words import SHAPE_WORDS
from vectorplot.io.scenes.scene_words import FORM_WORDS, KIND_WORDS, SCENE_WORDS
from vectorplot.words import MATERIALS, is_alike, is_colour, nearest, nearest_material

_HEADER = [*KIND_WORDS, *MATERIALS, *FORM_WORDS]

HANDLERS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    **LOOK_WORDS,
    **SHAPE_WORDS,
    **PLACE_WORDS,
    **SURFACE_LINE_WORDS,
}
"""What reads the words of an item."""


_PRISM = "a prism is a 'translation' with 'base_points' and 'trans_vector'"
_BOX = "expected 'box' and its three lengths"

OTHERWISE = {
    **dict.fromkeys(("prism", "extrusion", "extrude"), _PRISM),
    **dict.fromkeys(("cube", "cuboid"), _BOX),
    "pyramid": "a pyramid is its 'vertices' and 'faces', or a 'revolution' with as large an 'order' as it has sides",
    "polyhedron": "a polyhedron is its 'vertices' and 'faces'",
    "union": "bodies that pierce each other are drawn with the lines in which they do",
    "difference": "holes are 'bore' and 'cutout', and 'cut' takes away what is before a plane",
}
"""What is said in other words than those that other programs have for it."""

CODE = len("#rrggbb")
"""The length of a colour by its numbers."""


class ItemReader(ItemCursor):
    """Reads items, and what moves them."""

    def draft(self) -> Draft:
        """A name, and everything up to the next word that says nothing about an item."""
        words, handlers = self.words, HANDLERS
        name = words[self.at]
        if name in handlers or name == "," or self.source.is_number(self.at):
            self.fail(f"expected the name of an item, got {self.source.shown(self.at)}")
        draft = Draft(self.source.string(self.at) if name[0] == '"' else name, self.at)
        self.at += 1
        while True:
            handler = handlers.get(words[self.at])
            if handler is not None:
                handler(self, draft)
            elif self._ends(draft):
                return draft

    def _ends(self, draft: Draft) -> bool:
        """Whether the item ends before a word that is none of the language's: an unknown colour is taken as gray."""
        word, source = self.words[self.at], self.source
        missing = draft.missing()
        if draft.kind is not None and missing is None:
            if word == "," or source.is_number(self.at):
                self.fail(f"expected a word or the name of the next item, got {source.shown(self.at)}", draft)
            return True
        if draft.kind is not None:
            expected = f"'{missing}'" if draft.kind != "box" else "three lengths"
            hint = " (points are parted by commas)" if draft.kind != "box" and source.is_number(self.at) else ""
            self.fail(f"expected {expected}, got {source.shown(self.at)}{hint}", draft)
        plain = word and word not in SCENE_WORDS and word[0] not in '",' and not source.is_number(self.at)
        if plain:
            self._named_shape(draft, word)
        # A colour may look a little like a word of the language, but no number follows it.
        near = nearest(word, _HEADER) if plain and (source.is_number(self.at + 1) or is_alike(word, _HEADER)) else None
        if plain and not near and draft.colour is not None:
            near = nearest_material(word)
        if near:
            if draft.name.startswith("//"):
                self.fail("comments begin with #", draft)
            self.fail(f"unknown word '{word}', expected '{near}'", draft)
        named = not is_alike(draft.name, HANDLERS)
        if plain and draft.colour is None and named:
            draft.colour = self.colour(draft.name)
            return False
        # Surfaces and curves are loaded for scenes that name one, and to say what a word may have meant.
        from vectorplot.io.scenes.reserved_words import RESERVED

        meant = nearest(draft.name, RESERVED)
        hint = f" (or is '{draft.name}' meant to be '{meant}'?)" if meant else ""
        if draft.name in RESERVED:
            hint = f" ('{draft.name}' is a word of the language, but none of what stands before it)"
        if word.startswith('"') and is_colour(word.strip('"')):
            hint = f" (before a colour in quotes stands the word for it: colour {word})"
        code = source.comment_beside(draft.index)[:CODE]
        if is_colour(code):
            hint = f' (behind # is a comment; a colour is written so: colour "{code}")'
        self.fail(f"expected one of {', '.join(KIND_WORDS)}, got {source.shown(self.at)}{hint}", draft)

    def _named_shape(self, draft: Draft, word: str) -> None:
        """An error for a surface or a curve without the word that says which of them it is."""
        # Surfaces and curves are loaded for scenes that name one, and where a word is none that is known.
        from vectorplot.io.scenes.scene_families import CURVES, SURFACES

        if word.lower() in OTHERWISE:
            self.fail(f"there is no '{word}': {OTHERWISE[word.lower()]}", draft)
        for kind, names in (("surface", SURFACES), ("curve", CURVES)):
            if word.lower() in names:
                name = word.lower()
                self.fail(f"'{word}' is a {kind}: expected '{kind} {name}'", draft)

    def modifiers(self, draft: Draft) -> None:
        """Words that move what stands before them, or repeat it, one after the other."""
        while (word := self.words[self.at]) in MODIFIERS:
            HANDLERS[word](self, draft)
