"""Polylines in space, and the kinds of lines a drawing is made of."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum

from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Floats, Ints


class LineKind(IntEnum):
    """What a line is; the smaller value wins where one line is several things at once."""

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

    @property
    def word(self) -> str:
        """The kind as the command line and the JSON file spell it."""
        return self.name.lower()

    @classmethod
    def from_word(cls, word: str) -> LineKind:
        """The kind spelled that way; InputError for another word."""
        if word.upper() not in cls.__members__:
            raise InputError(f"line kind {word!r}: expected one of {', '.join(kind.word for kind in cls)}")
        return cls[word.upper()]


def line_kinds(words: Iterable[str]) -> frozenset[LineKind]:
    """The kinds that some words spell. Errors: InputError for other words, and for one text in place of words."""
    if isinstance(words, str):
        raise InputError(f"line kinds {words!r}: expected words, such as ({words!r},)")
    return frozenset(map(LineKind.from_word, words))


@dataclass(frozen=True, eq=False)
class Strokes:
    """Polylines in space.

    points (p,3); offsets (m+1,): stroke i has the points offsets[i] to offsets[i+1]; kind (m,) LineKind values;
    item (m,) index of the item a stroke belongs to.
    Degenerate: no strokes at all is points (0,3), offsets (1,).
    """

    points: Floats
    offsets: Ints
    kind: Ints
    item: Ints

    def __len__(self) -> int:
        return len(self.offsets) - 1
