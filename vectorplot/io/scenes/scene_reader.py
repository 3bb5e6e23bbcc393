"""The words of an item of a scene file, read one after the other into a draft."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import NoReturn

import numpy as np

from vectorplot.errors import InputWarning
from vectorplot.io.named_files import NamedFiles
from vectorplot.io.scenes.scene_curves import (
    CurveDraft,
    read_detail,
    read_integral_lines,
    read_isophote_edges,
    read_isophotes,
    read_level_lines,
    read_parameter_lines,
    read_sections,
    read_slices,
    read_smooth_lines,
    read_surface_curve,
    read_terrain_lines,
)
from vectorplot.io.scenes.scene_hatching import read_hatch
from vectorplot.io.scenes.scene_item import CAP_WORDS, Draft
from vectorplot.io.scenes.scene_placement import Placement, moved, read_matrix, read_rotation, read_scale, turned
from vectorplot.io.scenes.scene_words import (
    FORM_WORDS,
    INTEGRAL_WORDS,
    KIND_WORDS,
    SCENE_WORDS,
    SOLID_WORDS,
    TERRAIN_WORDS,
    Words,
)
from vectorplot.scene.scene import Pattern
from vectorplot.words import (
    COLOURS,
    LINE_WORDS,
    MATERIALS,
    OWN_LINE_WORDS,
    PALETTES,
    is_alike,
    is_colour,
    nearest,
    nearest_material,
    unknown_material,
)

MOST_COPIES = 100_000
"""So often a single item, or a group of them, may be repeated."""

_HEADER = [*KIND_WORDS, *MATERIALS, *FORM_WORDS]


class ItemReader:
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

    def colour(self, owner: str) -> str:
        """The colour at the next word; an unknown one is gray."""
        word = self.words[self.at]
        if not word or word == "," or self.source.is_number(self.at):
            self.source.fail(self.at, f"{owner}: expected a colour, got {self.source.shown(self.at)}")
        name = self.source.string(self.at)
        if not is_colour(name):
            near = nearest(name.lower(), COLOURS)
            known = f"did you mean '{near}'?" if near else f"known: {', '.join(PALETTES)}, #rrggbb in quotes"
            self.warn(f"{owner}: unknown colour '{name[:40]}', gray is used ({known})")
            name = "gray"
        self.at += 1
        return name

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
            self.fail(f"expected {expected}, got {source.shown(self.at)}", draft)
        plain = word and word not in SCENE_WORDS and word[0] not in '",' and not source.is_number(self.at)
        if plain:
            self._named_shape(draft, word)
        # A colour may look a little like a word of the language, but no number follows it.
        near = nearest(word, _HEADER) if plain and (source.is_number(self.at + 1) or is_alike(word, _HEADER)) else None
        if plain and not near and draft.colour is not None:
            near = nearest_material(word)
        if near:
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
        self.fail(f"expected one of {', '.join(KIND_WORDS)}, got {source.shown(self.at)}{hint}", draft)

    def _named_shape(self, draft: Draft, word: str) -> None:
        """An error for a surface or a curve without the word that says which of them it is."""
        # Surfaces and curves are loaded for scenes that name one, and where a word is none that is known.
        from vectorplot.io.scenes.scene_families import CURVES, SURFACES

        for kind, names in (("surface", SURFACES), ("curve", CURVES)):
            if word.lower() in names:
                name = word.lower()
                self.fail(f"'{word}' is a {kind}: expected '{kind} {name}'", draft)

    def _kind(self, draft: Draft, kind: str) -> None:
        if draft.kind is not None and draft.kind != kind:
            self.fail(
                f"is a '{draft.kind}' already, '{self.words[self.at]}' does not fit; an item begins with its name",
                draft,
            )
        draft.kind = kind
        draft.kind_index = self.at

    def _once(self, draft: Draft, attribute: str) -> None:
        """Step over a word that may stand only once in an item."""
        if getattr(draft, attribute) is not None:
            self.fail(f"a second '{self.words[self.at]}'", draft)
        self.at += 1

    def _read_colour(self, draft: Draft) -> None:
        if draft.colour is not None:
            self.fail(f"a second colour, '{self.words[self.at]}'", draft)
        draft.colour = self.words[self.at]
        self.at += 1

    def _read_named_colour(self, draft: Draft) -> None:
        self.at += 1
        draft.colour = self.colour(draft.name)

    def _read_material(self, draft: Draft) -> None:
        if draft.material is not None:
            self.fail(f"a second physical property, '{self.words[self.at]}'", draft)
        draft.material = MATERIALS[self.words[self.at]]
        self.at += 1

    def _read_named_material(self, draft: Draft) -> None:
        self.at += 1
        word = self.words[self.at]
        if word in MATERIALS:
            self._read_material(draft)
        elif not word or word == "," or self.source.is_number(self.at):
            self.fail(f"expected a material, got {self.source.shown(self.at)}", draft)
        else:
            self.fail(unknown_material(self.source.string(self.at)).cause, draft)

    def _read_form(self, draft: Draft) -> None:
        word = self.words[self.at]
        if word == "hollow":
            draft.hollow = True
        elif word not in SOLID_WORDS:
            draft.form = word
        self.at += 1

    def _read_cap(self, draft: Draft) -> None:
        draft.shown_caps |= {CAP_WORDS[self.words[self.at]]}
        self.at += 1

    def _read_box(self, draft: Draft) -> None:
        self._kind(draft, "box")
        self._once(draft, "lengths")
        while self.words[self.at] in _BEFORE_LENGTHS:
            HANDLERS[self.words[self.at]](self, draft)
        draft.lengths, self.at = self.source.numbers(self.at, 3, draft.owner, "a length of the box")

    def _read_revolution(self, draft: Draft) -> None:
        self._kind(draft, "revolution")
        self.at += 1

    def _read_angle(self, draft: Draft) -> None:
        self._kind(draft, "revolution")
        self.at += 1
        draft.angle_deg = self.source.number(self.at, draft.owner, "rot_angle")
        self.at += 1

    def _read_order(self, draft: Draft) -> None:
        self._kind(draft, "revolution")
        self._once(draft, "order")
        draft.order = self.source.whole(self.at, draft.owner, "order")
        self.at += 1

    def _read_meridian(self, draft: Draft) -> None:
        self._kind(draft, "revolution")
        self._once(draft, "meridian")
        draft.meridian, self.at = self.source.points(self.at, 3, draft.owner, "a point of the meridian")

    def _read_translation(self, draft: Draft) -> None:
        """The kind where a word follows, the modifier where a number does."""
        if not self.source.is_number(self.at + 1):
            if draft.missing() is None:
                self.at += 1
                self.source.number(self.at, draft.owner, "translation")
            self._kind(draft, "translation")
            self.at += 1
            return
        (x, y, z), self.at = self.source.numbers(self.at + 1, 3, draft.owner, "translation")
        draft.places = [moved(place, x, y, z) for place in draft.places]

    def _read_base(self, draft: Draft) -> None:
        self._kind(draft, "translation")
        self._once(draft, "base_points")
        draft.base_points, self.at = self.source.points(self.at, 3, draft.owner, "a point of the base")

    def _read_vector(self, draft: Draft) -> None:
        self._kind(draft, "translation")
        self._once(draft, "trans_vector")
        draft.trans_vector, self.at = self.source.numbers(self.at, 3, draft.owner, "trans_vector")

    def _read_surface(self, draft: Draft) -> None:
        from vectorplot.io.scenes.scene_surface import read_surface

        self._kind(draft, "surface")
        self._once(draft, "surface")
        draft.surface, self.at = read_surface(self.source, self.at, draft.owner)

    def _read_terrain(self, draft: Draft) -> None:
        from vectorplot.io.terrains.terrain_words import read_terrain_mesh

        self._kind(draft, "terrain")
        self._once(draft, "terrain")
        draft.terrain, self.at = read_terrain_mesh(self.source, self.at, draft.owner)

    def _read_curve(self, draft: Draft) -> None:
        from vectorplot.io.scenes.scene_space_curve import read_space_curve

        self._kind(draft, "curve")
        self._once(draft, "curve")
        draft.curve, self.at = read_space_curve(self.source, self.at, draft.owner)

    def _read_mesh(self, draft: Draft) -> None:
        from vectorplot.io.meshes.read_mesh import MESH_SUFFIXES, whole_mesh

        self._kind(draft, "mesh")
        self._once(draft, "mesh")
        if self.files is None:
            self.fail("a text without a file names no files", draft)
        path = self.files.named(self.source, self.at, draft.owner, MESH_SUFFIXES)
        draft.mesh = whole_mesh(path)
        self.at += 1

    def _read_ring(self, draft: Draft) -> None:
        """How many copies stand around an axis."""
        self.at += 1
        axis = "z"
        if self.words[self.at] in ("x", "y", "z"):
            axis = self.words[self.at]
            self.at += 1
        count = self._count(draft, "a ring")
        draft.places = [turned(place, axis, 360.0 * k / count) for k in range(count) for place in draft.places]

    def _read_grid(self, draft: Draft) -> None:
        """How many copies stand along x, y and perhaps z, and how far apart."""
        self.at += 1
        counts = [self._count(draft, "a grid")]
        while self.words[self.at] != "apart" and len(counts) < 3:
            counts.append(self._count(draft, "a grid"))
        if self.words[self.at] != "apart":
            self.fail(f"grid: expected 'apart' and distances, got {self.source.shown(self.at)}", draft)
        steps, self.at = self.source.numbers(self.at + 1, len(counts), draft.owner, "a distance of the grid")
        for axis, (count, step) in enumerate(zip(counts, steps, strict=True)):
            self._check_copies(draft, count)
            ways = [[step * k if axis == one else 0.0 for one in range(3)] for k in range(count)]
            draft.places = [moved(place, *way) for way in ways for place in draft.places]

    def _count(self, draft: Draft, what: str) -> int:
        count = self.source.whole(self.at, draft.owner, f"the copies of {what}")
        if count < 1:
            self.fail(f"{what} of {count} copies: expected 1 or more", draft)
        self._check_copies(draft, count)
        self.at += 1
        return count

    def _check_copies(self, draft: Draft, count: int) -> None:
        if count * len(draft.places) > MOST_COPIES:
            self.fail(f"more than {MOST_COPIES} copies", draft)

    def modifiers(self, draft: Draft) -> None:
        """Words that move what stands before them, or repeat it, one after the other."""
        while (word := self.words[self.at]) in MODIFIERS:
            HANDLERS[word](self, draft)

    def _read_vertices(self, draft: Draft) -> None:
        self._kind(draft, "vertices")
        self._once(draft, "vertices")
        if self._none():
            draft.vertices = [[], [], []]
        else:
            draft.vertices, self.at = self.source.points(self.at, 3, draft.owner, "a vertex")

    def _read_edges(self, draft: Draft) -> None:
        self._kind(draft, "vertices")
        self._once(draft, "edges")
        draft.edges, self.at = self.source.groups(self.at, draft.owner, "a vertex of an edge")

    def _read_faces(self, draft: Draft) -> None:
        self._kind(draft, "vertices")
        self._once(draft, "faces")
        if self._none():
            draft.faces = []
        else:
            draft.faces, self.at = self.source.groups(self.at, draft.owner, "a vertex of a face")

    def _none(self) -> bool:
        found = self.words[self.at] == "none"
        self.at += found
        return found

    def _read_removed(self, draft: Draft) -> None:
        self._once(draft, "removed")
        groups, self.at = self.source.groups(self.at, draft.owner, "a face")
        draft.removed = [number for group in groups for number in group]

    def _read_intersection(self, draft: Draft) -> None:
        """Two names, the comma between them may be left out, and more with commas before them."""
        self._kind(draft, "intersection")
        self._once(draft, "parts")
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

    def _read_lines(self, draft: Draft) -> None:
        self._once(draft, "lines")
        kinds: list[str] = []
        if self._none():
            draft.lines = ()
            return
        while True:
            word = self.words[self.at]
            if word not in OWN_LINE_WORDS:
                self.fail(f"lines: expected one of {', '.join(LINE_WORDS)}, got {self.source.shown(self.at)}", draft)
            kinds.append(word)
            self.at += 1
            if self.words[self.at] != ",":
                break
            self.at += 1
        draft.lines = tuple(kinds)

    def _read_occludes(self, draft: Draft) -> None:
        self._once(draft, "occludes")
        word = self.words[self.at]
        if word not in ("yes", "no"):
            self.fail(f"occludes: expected yes or no, got {self.source.shown(self.at)}", draft)
        draft.occludes = word == "yes"
        self.at += 1

    def _read_group(self, draft: Draft) -> None:
        self._once(draft, "group")
        word = self.words[self.at]
        if word in ("", ",", *SCENE_WORDS) or word in HANDLERS or self.source.is_number(self.at):
            self.fail(f"group: expected the name of a group, got {self.source.shown(self.at)}", draft)
        draft.group = self.source.string(self.at)
        self.at += 1

    def _read_hatch(self, draft: Draft) -> None:
        self._once(draft, "hatch")
        draft.hatch, self.at = read_hatch(self.source, self.at, draft.owner)

    def _read_opacity(self, draft: Draft) -> None:
        self._once(draft, "opacity")
        opacity = self.source.number(self.at, draft.owner, "opacity")
        if not 0.0 <= opacity <= 1.0:
            self.fail(f"opacity {opacity:g} must lie between 0 and 1", draft)
        draft.opacity = opacity
        self.at += 1

    def _read_refraction(self, draft: Draft) -> None:
        self.at += 1
        refraction = self.source.number(self.at, draft.owner, "refraction")
        if refraction <= 0.0:
            self.fail(f"refraction {refraction:g} must be positive", draft)
        draft.refraction = refraction
        self.at += 1

    def _read_patterns(self, draft: Draft) -> None:
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
            draft.patterns.append(Pattern(name, colour, face - 1, np.array(columns).T.copy()))
        if face is None:
            self.fail(f"patterns: expected 'face' and its number, got {source.shown(self.at)}", draft)


def _curves(
    read: Callable[[Words, int, str, CurveDraft], tuple[CurveDraft, int]],
) -> Callable[[ItemReader, Draft], None]:
    """How to read words about the lines of a surface."""

    def handle(reader: ItemReader, draft: Draft) -> None:
        draft.curves, reader.at = read(reader.source, reader.at, draft.owner, draft.curves)

    return handle


def _integral_lines(reader: ItemReader, draft: Draft) -> None:
    """Words about integral curves: what they begin with depends on the kind of the item."""
    draft.curves, reader.at = read_integral_lines(reader.source, reader.at, draft.owner, draft.curves, draft.kind)


def _modifier(
    read: Callable[[Words, int, str, Placement], tuple[Placement, int]],
) -> Callable[[ItemReader, Draft], None]:
    """How to read words that move an item."""

    def handle(reader: ItemReader, draft: Draft) -> None:
        found = [read(reader.source, reader.at, draft.owner, place) for place in draft.places]
        draft.places, reader.at = [place for place, _ in found], found[0][1]

    return handle


HANDLERS: dict[str, Callable[[ItemReader, Draft], None]] = {
    **dict.fromkeys(COLOURS, ItemReader._read_colour),
    **dict.fromkeys(MATERIALS, ItemReader._read_material),
    **dict.fromkeys(FORM_WORDS, ItemReader._read_form),
    **dict.fromkeys(CAP_WORDS, ItemReader._read_cap),
    "colour": ItemReader._read_named_colour,
    "material": ItemReader._read_named_material,
    "opacity": ItemReader._read_opacity,
    "refraction": ItemReader._read_refraction,
    "vertices": ItemReader._read_vertices,
    "edges": ItemReader._read_edges,
    "faces": ItemReader._read_faces,
    "removed_faces": ItemReader._read_removed,
    "revolution": ItemReader._read_revolution,
    "rot_angle": ItemReader._read_angle,
    "meridian": ItemReader._read_meridian,
    "order": ItemReader._read_order,
    "translation": ItemReader._read_translation,
    "base_points": ItemReader._read_base,
    "trans_vector": ItemReader._read_vector,
    "box": ItemReader._read_box,
    "intersection": ItemReader._read_intersection,
    "rotation": _modifier(read_rotation),
    "patterns": ItemReader._read_patterns,
    "lines": ItemReader._read_lines,
    "occludes": ItemReader._read_occludes,
    "group": ItemReader._read_group,
    "hatch": ItemReader._read_hatch,
    "scale": _modifier(read_scale),
    "matrix": _modifier(read_matrix),
    "surface": ItemReader._read_surface,
    "curve": ItemReader._read_curve,
    "mesh": ItemReader._read_mesh,
    "ring": ItemReader._read_ring,
    "grid": ItemReader._read_grid,
    "parameter_lines": _curves(read_parameter_lines),
    "isophotes": _curves(read_isophotes),
    "sections": _curves(read_sections),
    "level_lines": _curves(read_level_lines),
    "slices": _curves(read_slices),
    "surface_curve": _curves(read_surface_curve),
    "terrain": ItemReader._read_terrain,
    **dict.fromkeys(TERRAIN_WORDS, _curves(read_terrain_lines)),
    "smooth_lines": _curves(read_smooth_lines),
    "isophote_edges": _curves(read_isophote_edges),
    "detail": _curves(read_detail),
    **dict.fromkeys(INTEGRAL_WORDS, _integral_lines),
}
"""What reads the words of an item."""

MODIFIERS = ("translation", "rotation", "scale", "matrix", "ring", "grid")
"""The words that move and repeat."""

_BEFORE_LENGTHS = frozenset([*COLOURS, *MATERIALS, *FORM_WORDS, *CAP_WORDS])
