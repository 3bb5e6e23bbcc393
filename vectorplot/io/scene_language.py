"""Scene files: the data-file language of docs/scene-language.md, read into a Scene."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import NoReturn

import numpy as np

from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.scene_item import CAP_WORDS, Draft, finished, moved, turned
from vectorplot.io.scene_statements import read_camera, read_light, read_page
from vectorplot.io.scene_words import (
    COLOURS,
    FORM_WORDS,
    KIND_WORDS,
    LINE_WORDS,
    MATERIALS,
    PALETTES,
    SCENE_WORDS,
    SOLID_WORDS,
    Words,
    close_to,
)
from vectorplot.scene.scene import Item, Pattern, Scene

MAX_FILE_BYTES = 64 << 20
"""The largest scene file that is read."""

MAX_ITEMS = 1_000_000
"""The largest number of items in a scene file."""

_HEADER = ["box", "revolution", "translation", "vertices", "intersection", *MATERIALS, *FORM_WORDS]


def read_scene(path: str | os.PathLike[str]) -> Scene:
    """The scene that a file in the scene language describes.

    Errors: InputError with file, line, item and the word expected. Source: Glaeser, chapter 3 and section 6.5.
    """
    name = " ".join("".join(c if c.isprintable() else "?" for c in str(path)).split())
    file = Path(path)
    try:
        if file.stat().st_size > MAX_FILE_BYTES:
            raise InputError(f"larger than {MAX_FILE_BYTES >> 20} MiB: this is no scene file", file=name)
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        raise InputError("not UTF-8: this is no scene file", file=name, line=line) from None
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(getattr(error, "strerror", None) or "cannot be read", file=name) from None
    return parse_scene(text, name)


def parse_scene(text: str, name: str = "<text>") -> Scene:
    """The scene that a text in the scene language describes; name: what messages call the text.

    Errors: InputError with name, line, item and the word expected; an unknown colour is gray, with an InputWarning.
    Degenerate: an empty text is an empty scene.
    """
    return _Reader(Words(text, name)).scene()


class _Reader:
    """Reads words from left to right; ``at`` is the next one."""

    def __init__(self, words: Words) -> None:
        self.source = words
        self.words = words.words
        self.at = 0
        self.items: list[Item] = []
        self.places: dict[str, int] = {}
        self.parts: set[int] = set()
        self.settings = Scene(items=())
        self.set: set[str] = set()

    def scene(self) -> Scene:
        """All statements and items up to the end of the text."""
        while word := self.words[self.at]:
            if word in SCENE_WORDS:
                self.statement(word)
            else:
                self.item()
        shown = [item for place, item in enumerate(self.items) if place not in self.parts] if self.parts else self.items
        return replace(self.settings, items=tuple(shown))

    def fail(self, cause: str, draft: Draft | None = None) -> NoReturn:
        self.source.fail(self.at, cause if draft is None else draft.owner + cause)

    def warn(self, cause: str) -> None:
        line = self.source.line(self.at)
        warnings.warn(f"{self.source.name}:{line}: {cause}", InputWarning, stacklevel=2)

    # --- what is said about the whole scene ---

    def statement(self, word: str) -> None:
        """camera, light, page, background or title, and what follows it."""
        if word in self.set and word != "light":
            self.fail(f"a second '{word}'")
        self.set.add(word)
        source, now = self.source, self.settings
        if word == "camera":
            camera, self.at = read_camera(source, self.at)
            self.settings = replace(now, camera=camera)
        elif word == "light":
            light, self.at = read_light(source, self.at)
            self.settings = replace(now, lights=(*now.lights, light))
        elif word == "page":
            page, self.at = read_page(source, self.at)
            self.settings = replace(now, page=page)
        else:
            self.at += 1
            if word == "title":
                if not self.words[self.at].startswith('"'):
                    self.fail(f"expected a string in quotes after 'title', got {source.shown(self.at)}")
                self.settings = replace(now, title=source.string(self.at))
                self.at += 1
            else:
                self.settings = replace(now, background=self.colour("background"))

    def colour(self, owner: str) -> str:
        """The colour at the next word; an unknown one is gray."""
        word = self.words[self.at]
        if word.startswith('"'):
            name = self.source.string(self.at)
        elif word in COLOURS:
            name = word
        elif not word or word == "," or self.source.is_number(self.at):
            self.source.fail(self.at, f"{owner}: expected a colour, got {self.source.shown(self.at)}")
        else:
            near = close_to(word, sorted(COLOURS))
            known = f"did you mean '{near}'?" if near else f"known: {', '.join(PALETTES)}"
            self.warn(f"{owner}: unknown colour '{word}', gray is used ({known})")
            name = "gray"
        self.at += 1
        return name

    # --- items ---

    def item(self) -> None:
        """A name, and everything up to the next word that says nothing about an item."""
        words, handlers = self.words, _HANDLERS
        name = words[self.at]
        if name in handlers or name == "," or self.source.is_number(self.at):
            self.fail(f"expected the name of an item, got {self.source.shown(self.at)}")
        draft = Draft(self.source.string(self.at) if name[0] == '"' else name, self.at)
        self.at += 1
        while True:
            handler = handlers.get(words[self.at])
            if handler is not None:
                handler(self, draft)
            elif self.ends(draft):
                break
        parts: tuple[Mesh, ...] = ()
        if draft.parts is not None:
            places = [self.places[part] for part in draft.parts]
            parts = tuple(self.items[place].shape for place in places)
            self.parts.update(places)
        self.places[draft.name] = len(self.items)
        self.items.append(finished(draft, self.source, parts))
        if len(self.items) > MAX_ITEMS:
            self.source.fail(draft.index, f"{draft.owner}more than {MAX_ITEMS} items")

    def ends(self, draft: Draft) -> bool:
        """Whether the item ends before a word that is none of the language's: an unknown colour is taken as gray."""
        word, source = self.words[self.at], self.source
        missing = draft.missing()
        if draft.kind is not None and missing is None:
            if word == "," or source.is_number(self.at):
                self.fail(f"expected a word or the name of the next item, got {source.shown(self.at)}", draft)
            return True
        if draft.kind is not None:
            expected = f"'{missing}'" if draft.kind != "box" else "three lengths"
            self.fail(f"expected {expected}, got {source.shown(self.at)}", draft)
        plain = word and word not in SCENE_WORDS and word[0] not in '",' and not source.is_number(self.at)
        near = close_to(word, _HEADER) if plain else None
        if near:
            self.fail(f"unknown word '{word}', expected '{near}'", draft)
        if plain and draft.colour is None and close_to(draft.name, list(_HANDLERS)) is None:
            draft.colour = self.colour(draft.name)
            return False
        meant = close_to(draft.name, list(_HANDLERS))
        hint = f" (or is '{draft.name}' meant to be '{meant}'?)" if meant else ""
        self.fail(f"expected one of {', '.join(KIND_WORDS)}, got {source.shown(self.at)}{hint}", draft)

    def kind(self, draft: Draft, kind: str) -> None:
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

    def read_colour(self, draft: Draft) -> None:
        if draft.colour is not None:
            self.fail(f"a second colour, '{self.words[self.at]}'", draft)
        draft.colour = self.words[self.at]
        self.at += 1

    def read_named_colour(self, draft: Draft) -> None:
        self.at += 1
        draft.colour = self.colour(draft.name)

    def read_material(self, draft: Draft) -> None:
        if draft.material is not None:
            self.fail(f"a second physical property, '{self.words[self.at]}'", draft)
        draft.material = MATERIALS[self.words[self.at]]
        self.at += 1

    def read_form(self, draft: Draft) -> None:
        word = self.words[self.at]
        if word == "hollow":
            draft.hollow = True
        elif word not in SOLID_WORDS:
            draft.form = word
        self.at += 1

    def read_cap(self, draft: Draft) -> None:
        draft.shown_caps = (*draft.shown_caps, CAP_WORDS[self.words[self.at]])
        self.at += 1

    def read_box(self, draft: Draft) -> None:
        self.kind(draft, "box")
        self.once(draft, "lengths")
        while self.words[self.at] in _BEFORE_LENGTHS:
            _HANDLERS[self.words[self.at]](self, draft)
        draft.lengths, self.at = self.source.numbers(self.at, 3, draft.owner, "a length of the box")

    def read_revolution(self, draft: Draft) -> None:
        self.kind(draft, "revolution")
        self.at += 1

    def read_angle(self, draft: Draft) -> None:
        self.kind(draft, "revolution")
        self.at += 1
        draft.angle_deg = self.source.number(self.at, draft.owner, "rot_angle")
        self.at += 1

    def read_order(self, draft: Draft) -> None:
        self.kind(draft, "revolution")
        self.once(draft, "order")
        draft.order = self.source.whole(self.at, draft.owner, "order")
        self.at += 1

    def read_meridian(self, draft: Draft) -> None:
        self.kind(draft, "revolution")
        self.once(draft, "meridian")
        draft.meridian, self.at = self.source.points(self.at, 3, draft.owner, "a point of the meridian")

    def read_translation(self, draft: Draft) -> None:
        """The kind where a word follows, the modifier where a number does."""
        if not self.source.is_number(self.at + 1):
            if draft.missing() is None:
                self.at += 1
                self.source.number(self.at, draft.owner, "translation")
            self.kind(draft, "translation")
            self.at += 1
            return
        (x, y, z), self.at = self.source.numbers(self.at + 1, 3, draft.owner, "translation")
        draft.placement = moved(draft.placement, x, y, z)

    def read_base(self, draft: Draft) -> None:
        self.kind(draft, "translation")
        self.once(draft, "base_points")
        draft.base_points, self.at = self.source.points(self.at, 3, draft.owner, "a point of the base")

    def read_vector(self, draft: Draft) -> None:
        self.kind(draft, "translation")
        self.once(draft, "trans_vector")
        draft.trans_vector, self.at = self.source.numbers(self.at, 3, draft.owner, "trans_vector")

    def read_rotation(self, draft: Draft) -> None:
        axis = self.words[self.at + 1]
        if axis not in ("x", "y", "z"):
            self.at += 1
            self.fail(f"expected an axis x, y or z after 'rotation', got {self.source.shown(self.at)}", draft)
        angle = self.source.number(self.at + 2, draft.owner, "the angle of a rotation")
        draft.placement = turned(draft.placement, axis, angle)
        self.at += 3

    def read_vertices(self, draft: Draft) -> None:
        self.kind(draft, "vertices")
        self.once(draft, "vertices")
        if self.none():
            draft.vertices = [[], [], []]
        else:
            draft.vertices, self.at = self.source.points(self.at, 3, draft.owner, "a vertex")

    def read_edges(self, draft: Draft) -> None:
        self.kind(draft, "vertices")
        self.once(draft, "edges")
        draft.edges, self.at = self.source.groups(self.at, draft.owner, "a vertex of an edge")

    def read_faces(self, draft: Draft) -> None:
        self.kind(draft, "vertices")
        self.once(draft, "faces")
        if self.none():
            draft.faces = []
        else:
            draft.faces, self.at = self.source.groups(self.at, draft.owner, "a vertex of a face")

    def none(self) -> bool:
        found = self.words[self.at] == "none"
        self.at += found
        return found

    def read_removed(self, draft: Draft) -> None:
        self.once(draft, "removed")
        groups, self.at = self.source.groups(self.at, draft.owner, "a face")
        draft.removed = [number for group in groups for number in group]

    def read_intersection(self, draft: Draft) -> None:
        """Two names, the comma between them may be left out, and more with commas before them."""
        self.kind(draft, "intersection")
        self.once(draft, "parts")
        names: list[str] = []
        while len(names) < 2 or self.words[self.at] == ",":
            self.at += bool(names) and self.words[self.at] == ","
            if self.words[self.at] in ("", ",") or self.source.is_number(self.at):
                self.fail(f"expected the name of an item to intersect, got {self.source.shown(self.at)}", draft)
            name = self.source.string(self.at)
            if name not in self.places:
                self.fail(f"expected the name of an item before it, got {self.source.shown(self.at)}", draft)
            names.append(name)
            self.at += 1
        draft.parts = tuple(names)

    def read_lines(self, draft: Draft) -> None:
        self.once(draft, "lines")
        kinds: list[str] = []
        if self.none():
            draft.lines = ()
            return
        while True:
            word = self.words[self.at]
            if word not in LINE_WORDS:
                self.fail(f"lines: expected one of {', '.join(LINE_WORDS)}, got {self.source.shown(self.at)}", draft)
            kinds.append(word)
            self.at += 1
            if self.words[self.at] != ",":
                break
            self.at += 1
        draft.lines = tuple(kinds)

    def read_occludes(self, draft: Draft) -> None:
        self.once(draft, "occludes")
        word = self.words[self.at]
        if word not in ("yes", "no"):
            self.fail(f"occludes: expected yes or no, got {self.source.shown(self.at)}", draft)
        draft.occludes = word == "yes"
        self.at += 1

    def read_opacity(self, draft: Draft) -> None:
        self.once(draft, "opacity")
        opacity = self.source.number(self.at, draft.owner, "opacity")
        if not 0.0 <= opacity <= 1.0:
            self.fail(f"opacity {opacity:g} must lie between 0 and 1", draft)
        draft.opacity = opacity
        self.at += 1

    def read_refraction(self, draft: Draft) -> None:
        self.at += 1
        refraction = self.source.number(self.at, draft.owner, "refraction")
        if refraction <= 0.0:
            self.fail(f"refraction {refraction:g} must be positive", draft)
        draft.refraction = refraction
        self.at += 1

    def read_patterns(self, draft: Draft) -> None:
        """Faces by number, and the coloured polygons on each."""
        source = self.source
        self.at += 1
        face: int | None = None
        while (word := self.words[self.at]) in ("face", "polygon"):
            self.at += 1
            if word == "face":
                face = source.whole(self.at, draft.owner, "the face of a pattern")
                self.at += 1
                continue
            if face is None:
                self.at -= 1
                break
            if self.words[self.at] in ("", ","):
                self.fail(f"expected the name of a polygon, got {source.shown(self.at)}", draft)
            name = source.string(self.at)
            self.at += 1
            colour = self.colour(f"{draft.owner}polygon {name}")
            columns, end = source.points(self.at, 2, draft.owner, f"a point of polygon {name}")
            if len(columns[0]) < 3:
                self.fail(f"polygon {name} has {len(columns[0])} points, expected three or more", draft)
            self.at = end
            draft.patterns = (*draft.patterns, Pattern(name, colour, face - 1, np.array(columns).T.copy()))
        if face is None:
            self.fail(f"patterns: expected 'face' and its number, got {source.shown(self.at)}", draft)


_HANDLERS: dict[str, Callable[[_Reader, Draft], None]] = {
    **dict.fromkeys(COLOURS, _Reader.read_colour),
    **dict.fromkeys(MATERIALS, _Reader.read_material),
    **dict.fromkeys(FORM_WORDS, _Reader.read_form),
    **dict.fromkeys(CAP_WORDS, _Reader.read_cap),
    "colour": _Reader.read_named_colour,
    "opacity": _Reader.read_opacity,
    "refraction": _Reader.read_refraction,
    "vertices": _Reader.read_vertices,
    "edges": _Reader.read_edges,
    "faces": _Reader.read_faces,
    "removed_faces": _Reader.read_removed,
    "revolution": _Reader.read_revolution,
    "rot_angle": _Reader.read_angle,
    "meridian": _Reader.read_meridian,
    "order": _Reader.read_order,
    "translation": _Reader.read_translation,
    "base_points": _Reader.read_base,
    "trans_vector": _Reader.read_vector,
    "box": _Reader.read_box,
    "intersection": _Reader.read_intersection,
    "rotation": _Reader.read_rotation,
    "patterns": _Reader.read_patterns,
    "lines": _Reader.read_lines,
    "occludes": _Reader.read_occludes,
}

_BEFORE_LENGTHS = frozenset([*COLOURS, *MATERIALS, *FORM_WORDS, *CAP_WORDS])

RESERVED = frozenset([*_HANDLERS, *SCENE_WORDS, "position", "direction", "intensity", "none", "face", "polygon"])
"""Words that are no names unless they are quoted."""
