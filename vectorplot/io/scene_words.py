"""The words of the scene language, and a text cut into words."""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from collections.abc import Collection
from math import isfinite
from operator import itemgetter
from typing import NoReturn

from vectorplot.errors import InputError
from vectorplot.tolerances import LARGEST
from vectorplot.words import is_alike, nearest

TERRAIN_WORDS = ("water", "watersheds", "valley_lines", "road", "serpentine")
"""The words for lines of a terrain."""

INTEGRAL_WORDS = (
    *("loxodromes", "slope_lines", "helices", "curvature_lines", "asymptotic_lines", "field_lines"),
    *("geodesics", "shortest_paths"),
)
"""The words for integral curves of a surface or a polyhedron."""

SOLID_WORDS = ("solid", "voll")
FORM_WORDS = ("convex", *SOLID_WORDS, "hollow", "general", "concave")
KIND_WORDS = ("vertices", "revolution", "translation", "box", "intersection", "surface", "curve", "mesh", "terrain")
ITEM_WORDS = (
    *(
        "colour",
        "material",
        "opacity",
        "refraction",
        "vertices",
        "edges",
        "faces",
        "removed_faces",
        "face_looks",
        "revolution",
        "rot_angle",
    ),
    *("meridian", "order", "translation", "base_points", "trans_vector", "box", "intersection", "rotation", "patterns"),
    *("cutout", "bore"),
    *("lines", "occludes", "group", "scale", "matrix", "surface", "curve", "parameter_lines", "isophotes", "sections"),
    *(
        "level_lines",
        "slices",
        "contours",
        "surface_curve",
        "trim",
        "trim_hole",
        "smooth_lines",
        "smooth_contours",
        "isophote_edges",
        "detail",
        "subdivision",
    ),
    *("hatch", "mesh", "grid", "ring"),
    *INTEGRAL_WORDS,
    "terrain",
    *TERRAIN_WORDS,
)
SLOT_TOO = ("radius", "angle")
"""Words for annotations that are also words of surfaces: what comes next tells."""

ANNOTATION_WORDS = (
    *("axes", "arrow", "dimension", "diameter", "leader", "centre_line", "centre_mark"),
    *("chain_dimension", "baseline_dimension", "ordinate_dimension", "chamfer", "thread", "threaded_hole"),
    *SLOT_TOO,
)
"""The words for lines and labels that make items of their own."""

SCENE_WORDS = (
    *(
        "camera",
        "light",
        "page",
        "background",
        "title",
        "label",
        "cut",
        "colour_by",
        "box_axes",
        "scale_bar",
        "exposure",
        "depth_cue",
    ),
    *("style", "pen", "dash", "explode", "measures", "sheet", "field_arrows"),
    *("include", "assembly", "union", "end"),
    *(word for word in ANNOTATION_WORDS if word not in SLOT_TOO),
)

FORMULA = re.compile(r"\$[^$]*\$")
"""What is between dollars: a formula of TeX, whose words begin with backslashes."""

UNSUPPORTED_COMMENTS = ("//", "/*", ";", "%")
"""What comments begin with in other languages."""

COMMENTS = "comments begin with #"

# A string that is not closed is one word too, up to the end of its line. Nothing is tried twice: what these patterns
# have taken they keep (++ and *+), so that the time grows with the text, whatever the text.
_STRING = re.compile(r'"(?:[^"\\\n]++|\\.)*+"')
_WORD = re.compile(r'"(?:[^"\\\n]++|\\.)*+"?|,|[^\s,"#]++|#[^\n]*+')
_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")
_NUMBER = re.compile(r"[-+.]*\d")

MARKED = 1000
"""Looking for the line of a word begins no more than so many words before it, or at the last word looked for."""

PADDING = 4
"""Empty words after the last one, so that looking ahead needs no test."""


class Words:
    """A text as a list of words and commas, without comments; errors find the line of a word when they need it.

    A word is a run of characters without blanks, commas, quotes and #, or a string in double quotes with the escapes of
    JSON. The list ends with PADDING empty words.
    """

    def __init__(self, text: str, name: str) -> None:
        self.name = name
        self._text = text
        bad = _CONTROL.search(text)
        if bad:
            line = text.count("\n", 0, bad.start()) + 1
            raise InputError("a control character: this is no scene file", file=name, line=line)
        words = _WORD.findall(text)
        if "#" in text:
            words = [word for word in words if word[0] != "#"]
        self.words: list[str] = words
        self._marks = [(0, 0, 1)]
        if '"' in text:
            unclosed = (k for k, word in enumerate(words) if word[0] == '"' and not _STRING.fullmatch(word))
            if (first := next(unclosed, None)) is not None:
                self.fail(first, 'a string lacks its closing "')
        words.extend([""] * PADDING)

    def line(self, index: int) -> int:
        """The line, from 1, on which a word stands; for a word behind the last one the last line."""
        word, position, line = self._marks[bisect_right(self._marks, index, key=itemgetter(0)) - 1]
        for match in _WORD.finditer(self._text, position):
            if match[0][0] == "#":
                continue
            if word == index or word >= self._marks[-1][0] + MARKED:
                line += self._text.count("\n", position, match.start())
                position = match.start()
                if word > self._marks[-1][0]:
                    self._marks.append((word, position, line))
            if word == index:
                return line
            word += 1
        return line + self._text.count("\n", position, len(self._text.rstrip()))

    def comment_beside(self, index: int) -> str:
        """The comment on the line of a word, from its # on."""
        line = self._text.split("\n")[self.line(index) - 1]
        return next((match[0] for match in _WORD.finditer(line) if match[0][0] == "#"), "")

    def fail(self, index: int, cause: str) -> NoReturn:
        """Raise InputError with file and line of a word."""
        raise InputError(cause, file=self.name, line=self.line(index))

    def shown(self, index: int) -> str:
        """A word as messages quote it, and what is wrong with it where it begins a comment elsewhere."""
        word = self.words[index]
        hint = f" ({COMMENTS})" if word.startswith(UNSUPPORTED_COMMENTS) else ""
        return "the end of the file" if not word else word[:40] if word[0] == '"' else f"'{word[:40]}'{hint}"

    def misspelled(self, start: int, index: int, known: Collection[str]) -> str | None:
        """The known word of the statement that begins at start which a word behind it seems to be meant for, or None.

        Only a word on the line of the statement that could not be the name of an item: what comes next is none of what
        stands after a name.
        """
        word = self.words[index].lower()
        near = nearest(word, known) if word[:1] not in ("", ",", '"') and is_alike(word, known) else None
        if near is None or self.line(index) != self.line(start):
            return None
        after = self.words[index + 1]
        alone = not after or after in (*SCENE_WORDS, *known) or self.is_number(index + 1)
        return near if alone or self.line(index + 1) != self.line(index) else None

    def string(self, index: int) -> str:
        """The text of a word, without its quotes if it has any."""
        word = self.words[index]
        if not word.startswith('"'):
            return word
        try:
            return str(json.loads(FORMULA.sub(_with_all_backslashes, word)))
        except ValueError:
            self.fail(index, f"{word[:40]} is not a string: escapes are those of JSON")

    def numbers(self, index: int, count: int, owner: str, what: str) -> tuple[list[float], int]:
        """count finite numbers from a word on, commas between them allowed, and the word behind them."""
        try:
            values = list(map(float, self.words[index : index + count]))
            if -LARGEST <= min(values) and max(values) <= LARGEST and isfinite(sum(values)):
                return values, index + count
        except ValueError:
            pass
        values = []
        for place in range(count):
            if place and self.words[index] == ",":
                index += 1
            values.append(self.number(index, owner, what))
            index += 1
        return values, index

    def number(self, index: int, owner: str, what: str) -> float:
        """The finite number, at most LARGEST, that a word spells."""
        try:
            value = float(self.words[index])
        except ValueError:
            self.fail(index, f"{owner}expected a number for {what}, got {self.shown(index)}")
        if not isfinite(value):
            self.fail(index, f"{owner}{what}: {self.shown(index)} is not a finite number")
        if abs(value) > LARGEST:
            self.fail(index, f"{owner}{what}: {self.shown(index)} is out of range, at most {LARGEST:g}")
        return value

    def whole(self, index: int, owner: str, what: str) -> int:
        """The whole number that a word spells."""
        try:
            return int(self.words[index])
        except ValueError:
            self.fail(index, f"{owner}expected a whole number for {what}, got {self.shown(index)}")

    def points(self, index: int, size: int, owner: str, what: str) -> tuple[list[list[float]], int]:
        """The points of a list, coordinate by coordinate: size numbers each, commas between; and the word behind."""
        words = self.words
        end = index + size
        try:
            while words[end] == ",":
                end += size + 1
            columns = [list(map(float, words[index + k : end : size + 1])) for k in range(size)]
            within = -LARGEST <= min(map(min, columns)) and max(map(max, columns)) <= LARGEST
            if within and isfinite(sum(map(sum, columns))) and len({len(column) for column in columns}) == 1:
                return columns, end
        except (ValueError, IndexError):
            pass
        columns = [[] for _ in range(size)]
        while True:
            for column in columns:
                column.append(self.number(index, owner, what))
                index += 1
            if words[index] != ",":
                return columns, index
            index += 1

    def groups(self, index: int, owner: str, what: str) -> tuple[list[list[int]], int]:
        """The groups of whole numbers of a list, a comma between groups; and the word behind."""
        words = self.words
        groups: list[list[int]] = []
        group: list[int] = []
        while True:
            try:
                while True:
                    group.append(int(words[index]))
                    index += 1
            except ValueError:
                pass
            if not group or _NUMBER.match(words[index]):
                self.whole(index, owner, what)
            groups.append(group)
            if words[index] != ",":
                return groups, index
            group = []
            index += 1

    def is_number(self, index: int) -> bool:
        """Whether a word begins like a number."""
        return _NUMBER.match(self.words[index]) is not None


def _with_all_backslashes(formula: re.Match[str]) -> str:
    """A formula in which every backslash, but those that are escaped or escape a quote, is one of TeX."""
    return re.sub(r'\\(?:\\|")|\\', lambda found: found.group() if len(found.group()) > 1 else "\\\\", formula.group())


def bare_word(text: str) -> bool:
    """Whether a text may stand as a name without quotes: ASCII, and neither a number nor more than one word."""
    return re.fullmatch(r"[A-Za-z_][A-Za-z0-9_.:/()+-]*", text) is not None
