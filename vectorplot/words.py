"""The words of vectorplot, which mean the same in Python, in scene files and on the command line: kinds of lines,
colours and materials; and which known word an unknown one may have meant."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from difflib import SequenceMatcher
from enum import IntEnum

from vectorplot.errors import InputError

# How far a word is from another one as people misspell words, and which of some words it was meant for.

SHORT = 4
"""Letters of words in which two slips leave too little of the word."""

ALIKE = 0.72
"""Words that are more than two slips apart and share fewer of their letters, as a part of both words' letters, are not
taken for each other."""

FAR = 3
"""Slips between words that are no more than alike."""

LONGEST = 40
"""Letters of a word that are looked at."""


def slips(word: str, other: str) -> int:
    """By how many slips two words differ: letters that are missing, too many or wrong, and neighbours that are swapped.

    Source: Damerau, A technique for computer detection and correction of spelling errors, 1964 (optimal string
    alignment: no letter is touched twice).
    """
    before: list[int] = []
    row = list(range(len(other) + 1))
    for i, letter in enumerate(word, 1):
        earlier, before, row = before, row, [i]
        for j, against in enumerate(other, 1):
            least = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (letter != against))
            if i > 1 and j > 1 and letter == other[j - 2] and word[i - 2] == against:
                least = min(least, earlier[j - 2] + 1)
            row.append(least)
    return row[-1]


def one_slip(word: str, other: str) -> bool:
    """Whether two words are the same but for one slip at most; - and _ are the same."""
    return _apart(word, other, 1) < FAR


def share(word: str, other: str) -> float:
    """The letters that two words share in their order, as a part of all of their letters; 0 for less than ALIKE."""
    letters, of_other = _plain(word), _plain(other)
    total = len(letters) + len(of_other)
    # In whatever order, they share no fewer.
    shared = sum(min(letters.count(one), of_other.count(one)) for one in set(letters))
    if total and 2.0 * shared / total < ALIKE:
        return 0.0
    found = SequenceMatcher(None, of_other, letters).ratio()
    return found if found >= ALIKE else 0.0


def most_alike(word: str, known: Sequence[str]) -> str | None:
    """The known word that another one was most likely meant for, or None; the first one of several.

    Words one or two slips away come first, the nearest before all, with one slip at most where either word has no more
    than SHORT letters; then those that share most of their letters.
    """
    apart = [_apart(word, other, 2) for other in known]
    least = min(apart, default=FAR)
    # How much they share decides between those that are as near.
    near = [(-share(word, other), place) for place, other in enumerate(known) if apart[place] == least]
    found = min((one for one in near if least < FAR or one[0]), default=None)
    return None if found is None else known[found[1]]


def _apart(word: str, other: str, most: int) -> int:
    """The slips between two words, or FAR where they are more than so many, or more than leave enough of them."""
    letters, of_other = _plain(word), _plain(other)
    most = _most_slips(letters, of_other, most)
    # Each slip changes at most two of the letters that words have.
    possible = abs(len(letters) - len(of_other)) <= most and len(set(letters) ^ set(of_other)) <= 2 * most
    found = slips(letters, of_other) if possible else FAR
    return found if found <= most else FAR


def _most_slips(word: str, other: str, most: int) -> int:
    """The slips that two words for the same may be apart: less than all of their letters."""
    return min(most, 2 if min(len(word), len(other)) > SHORT else 1, max(len(word), len(other)) - 1)


def _plain(word: str) -> str:
    return word[:LONGEST].replace("_", "-")


class LineKind(IntEnum):
    """What a line is; the smaller value wins where one line is several things, but a terminator over a crease.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.LineKind.from_word("crease") > vp.LineKind.CONTOUR
    True
    >>> vp.LineKind.ISOPHOTE.word
    'isophote'
    """

    CONTOUR = 0
    """One neighbouring face looks at the eye, the other away from it."""
    BOUNDARY = 1
    """An edge of a single face."""
    CREASE = 2
    """Two faces meet at an angle sharper than the crease angle."""
    INTERSECTION = 3
    """Two shapes, or two parts of one, pierce each other."""
    EDGES = 4
    """Any other edge of a face."""
    PATTERN = 5
    """The outline of a pattern on a face."""
    PARAMETER = 6
    """A line of a parametrised surface along which u or v is constant."""
    ISOPHOTE = 7
    """A line of a smooth surface along which it takes the same light."""
    SECTION = 8
    """A line in which a plane meets a smooth surface."""
    CURVE = 9
    """A curve in space that is an item of its own."""
    INTEGRAL = 10
    """A line of a smooth surface that follows a field of directions, or a geodesic."""
    HATCH = 11
    """A stroke of a hatching, which is asked for by its own words."""
    INDEX = 12
    """One of the sections that are drawn heavier, as every fifth level line of a map."""
    LABEL = 13
    """A stroke of a letter, or a leader from a label to what it names."""
    CENTRE = 14
    """A centre line, dashed with dots, which nothing hides: it belongs to the inside of things."""
    SUGGESTIVE = 15
    """A line that would be a contour if one looked from a little elsewhere: a suggestive contour."""
    RIDGE = 16
    """A line along which a shape bends outwards more than to both of its sides."""
    VALLEY = 17
    """A line along which a shape bends inwards more than to both of its sides."""
    APPARENT = 18
    """A line along which normals turn faster, as seen, than to both of its sides: an apparent ridge."""
    CUT = 19
    """An edge of what is left at a cut."""
    GHOST = 20
    """An outline of what was cut away."""
    TRACE = 21
    """A line along which parts were moved apart."""
    OUTLINE = 22
    """A closed path around all that things cover of the page together, or around a hole in it."""
    TANGENT = 23
    """An edge at which two faces of a part from a CAD system meet without a crease."""
    TERMINATOR = 24
    """A line along which a shape turns away from a lamp that shines on it up to there."""
    SHADOW = 25
    """The edge of a shadow that something throws."""
    REFLECTED = 26
    """A line that one sees in a mirror."""
    REFRACTED = 27
    """A line that one sees bent, in water or glass or behind it."""

    @property
    def word(self) -> str:
        """The kind as the command line and the JSON file spell it."""
        return self.name.lower()

    @classmethod
    def from_word(cls, word: str) -> LineKind:
        """The kind spelled that way.

        Parameters
        ----------
        word : str
            As the command line and the JSON file spell it, in letters of any case; one of those that items can have.

        Returns
        -------
        LineKind
            The member with that name.

        Raises
        ------
        InputError
            For another word.

        Examples
        --------
        >>> import vectorplot as vp
        >>> vp.LineKind.from_word("crease").name
        'CREASE'
        """
        if word.lower() not in OWN_LINE_WORDS:
            raise unknown("line kind", word, LINE_WORDS)
        return cls[word.upper()]


_OWN_ONLY = (LineKind.LABEL, LineKind.CENTRE, LineKind.GHOST, LineKind.TRACE)

_BY_WAY = (LineKind.REFLECTED, LineKind.REFRACTED)
"""Lines of other kinds, as they are seen by way of things."""

LINE_WORDS = tuple(kind.word for kind in LineKind if kind not in (LineKind.HATCH, *_BY_WAY, *_OWN_ONLY))
"""The kinds of lines that one can ask for, as they are spelled."""


FEATURE_KINDS = (LineKind.SUGGESTIVE, LineKind.RIDGE, LineKind.VALLEY, LineKind.APPARENT)
"""The kinds of lines that curvature makes, which are drawn only where they are asked for."""

LIGHT_KINDS = (LineKind.TERMINATOR, LineKind.SHADOW)
"""The kinds of lines between light and dark, which are drawn only where they are asked for."""

_ASKED_FOR = [kind.word for kind in (LineKind.OUTLINE, *FEATURE_KINDS, *LIGHT_KINDS)]

ON_THINGS = tuple(word for word in LINE_WORDS if word not in _ASKED_FOR)
"""The kinds of lines that lie on one thing each and need not be asked for: all lines of hidden lines by erasing."""

DRAWN = tuple(word for word in ON_THINGS if word != LineKind.EDGES.word)
"""The kinds of lines that are drawn where nothing else is said."""

SUBDIVISIONS = ("catmull-clark", "loop")
"""The schemes of subdivision."""

WIRES = tuple(word for word in ON_THINGS if word != LineKind.INTERSECTION.word)
"""Those of a wireframe: every edge, and no line in which things pierce each other."""


OWN_LINE_WORDS = (*LINE_WORDS, *(kind.word for kind in _OWN_ONLY))
"""The kinds of lines that an item may have of its own: a curve may be drawn as a leader is, as a centre line, or as the
trace of what was moved, and all of a thing as the ghost of what was cut away."""


def line_words(words: str | Iterable[str] | None, known: tuple[str, ...] = LINE_WORDS) -> tuple[str, ...]:
    """The kinds of lines that are named, each once: words, or one text with commas between them; ``none`` is no kind.

    Errors: InputError for words that are none of those known.
    """
    if words is None:
        raise InputError("lines: expected words or 'none', got None")
    given = words.split(",") if isinstance(words, str) else list(words)
    if len(given) == 1 and given[0].strip().lower() == "none":
        return ()
    asked = [word.strip().lower() for word in given]
    for word in asked:
        if word not in known:
            raise unknown("line kind", word, known)
    return tuple(dict.fromkeys(asked))


def line_kinds(words: str | Iterable[str] | None) -> frozenset[LineKind]:
    """The kinds of lines that are named, see line_words."""
    return frozenset(map(LineKind.from_word, line_words(words)))


PALETTES = ("gray", "green", "yellow", "blue", "pink", "cyan", "magenta", "orange")
"""The parent palettes; each has a ``light`` and a ``dark`` half too."""

PLAIN_COLOURS = ("white", "black", "red")
"""Colours without shades."""

COLOURS = frozenset([*PALETTES, *("light" + p for p in PALETTES), *("dark" + p for p in PALETTES), *PLAIN_COLOURS])
"""All colours that have a name."""

_HEX = re.compile(r"#[0-9a-fA-F]{6}")


def is_colour(word: str) -> bool:
    """Whether a word is the name of a colour, or #rrggbb."""
    return word in COLOURS or _HEX.fullmatch(word) is not None


def check_colour(word: str, owner: str = "") -> None:
    """An InputError, which begins with its owner, for what is no colour."""
    if not isinstance(word, str) or not is_colour(word):
        raise unknown(f"{owner}colour", word, (*PALETTES, *PLAIN_COLOURS), "their light and dark halves, or #rrggbb")


MATERIALS = {
    "normal": "normal",
    "metallic": "metallic",
    "shiny": "shiny",
    "reflecting": "shiny",
    "mat": "mat",
    "matte": "mat",
    "wood": "wood",
    "plastic": "plastic",
    "transparent": "transparent",
    "mirror": "mirror",
    "unlit": "unlit",
}
"""Words for physical properties, and the material each one names."""

_MEANT = {
    "antialiasing": ("samples",),
    "ball": ("sphere",),
    "border": ("boundary",),
    "camera": ("eye",),
    "cube": ("box",),
    "dashed": ("hidden",),
    "dashes": ("dash",),
    "extrude": ("translation",),
    "extrusion": ("translation",),
    "falloff": ("fading",),
    "field-of-view": ("fov", "field_of_vision"),
    "field-of-vision": ("fov",),
    "focal-length": ("fov",),
    "fov": ("field_of_vision",),
    "hidden-lines": ("hidden",),
    "isoline": ("section",),
    "lamp": ("light",),
    "lamps": ("lights",),
    "lathe": ("revolution",),
    "line-width": ("pen",),
    "linewidth": ("pen",),
    "look-at": ("target",),
    "move": ("translation",),
    "orthographic": ("parallel",),
    "outline": ("contour",),
    "output": ("out",),
    "paper": ("page",),
    "pen-colour": ("pen",),
    "pen-width": ("pen",),
    "penumbra": ("aura",),
    "precision": ("tolerance",),
    "processes": ("jobs",),
    "resolution": ("size",),
    "roll": ("twist",),
    "rotate": ("rotation",),
    "sharp": ("crease",),
    "silent": ("quiet",),
    "silhouette": ("contour",),
    "size": ("page",),
    "soft-shadows": ("aura",),
    "stroke": ("pen",),
    "stroke-width": ("pen",),
    "supersampling": ("samples",),
    "threads": ("jobs",),
    "translate": ("translation",),
    "transparency": ("opacity",),
    "verbose": ("explain",),
    "viewpoint": ("eye",),
    "width": ("size", "page"),
    "workers": ("jobs",),
}
"""Words of other programs, and ours for the same: the first one that is known where it stands."""

_MATERIALS_MEANT = {
    "chrome": "metallic",
    "diffuse": "matte",
    "dull": "matte",
    "glass": "transparent",
    "gloss": "shiny",
    "glossy": "shiny",
    "metal": "metallic",
    "polished": "shiny",
    "reflective": "reflecting",
    "specular": "shiny",
    "steel": "metallic",
}
"""Words of other programs for materials, and ours for the like."""


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The known word that another one resembles, or that means what it, or a word one slip away from it, means to other
    programs; None where there is none, and for what is known."""
    words = sorted(known)
    if word in words:
        return None
    meant = {word: word for word in words}
    for other, ours in _MEANT.items():
        own = next((one for one in ours if one in words), None)
        if own is not None and one_slip(word, other):
            meant.setdefault(other, own)
    found = most_alike(word, list(meant))
    return found if found is None else meant[found]


def is_alike(word: str, known: Iterable[str]) -> bool:
    """Whether a word is hardly anything but one of those known: most of the letters are shared, or other programs have
    it for one of them."""
    words = list(known)
    return any(one in words for one in _MEANT.get(word, ())) or any(share(word, other) >= ALIKE for other in words)


def nearest_material(word: str) -> str | None:
    """The word for a material that another one resembles or is another program's word for, or None."""
    found = word if word in _MATERIALS_MEANT else nearest(word, [*MATERIALS, *_MATERIALS_MEANT])
    return found if found is None else _MATERIALS_MEANT.get(found, found)


def unknown_material(word: object) -> InputError:
    """The error for a word that names no material, with the one that may be meant."""
    near = nearest_material(word.lower()) if isinstance(word, str) else None
    return _unknown("material", word, MATERIALS, near)


def unknown(what: str, word: object, known: Iterable[str], more: str = "") -> InputError:
    """The error for an unknown word: what it should have been, and which known one may be meant.

    more: what else would have been right.
    """
    words = list(known)
    # Names of items and fields have capitals.
    names = {one.lower(): one for one in words}
    asked = word.lower() if isinstance(word, str) else ""
    near = names.get(asked) or names.get(nearest(asked, names) or "")
    return _unknown(what, word, words, near, more)


def _unknown(what: str, word: object, words: Iterable[str], near: str | None, more: str = "") -> InputError:
    hint = f" (did you mean {near!r}?)" if near else ""
    shown = repr(word) if len(repr(word)) <= 60 else repr(word)[:57] + "..."
    return InputError(f"{what} {shown}: expected one of {', '.join(words)}{', ' + more if more else ''}{hint}")


WIRE_STYLES = ("wireframe", "depth-cue")
"""The styles of drawings in which nothing hides anything."""

STYLE_WORDS = ("plain", *WIRE_STYLES, "plotter", "book", "draft", "blueprint")
"""The styles of drawings that have a name."""

TEXT_WORDS = ("strokes", "real")
"""What letters may be: strokes of a pen, or those of the fonts of whatever reads the file."""


def check_word(what: str, word: object, known: Iterable[str]) -> None:
    """An InputError for a word that is none of those known."""
    words = tuple(known)
    if word not in words:
        raise unknown(what, word, words)


OF_MESHES = ("stl", "obj", "ply", "off")
"""Suffixes of meshes, which are no pictures."""

OF_PLOTTERS = ("hpgl", "hpg", "plt", "gcode", "nc", "ngc", "tap")
"""Suffixes of the languages of plotters, which other programs write."""


def format_hint(suffix: str) -> str:
    """What is said behind a message that a suffix, without its point, is no format."""
    if suffix.lower() in OF_MESHES:
        return "; vectorplot convert writes shapes as meshes"
    return "; vpype writes it from an .svg" if suffix.lower() in OF_PLOTTERS else ""
