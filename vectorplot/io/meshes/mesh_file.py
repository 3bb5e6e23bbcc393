"""What the readers of mesh files share: the file's bytes, its lines in bulk, and the result."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import NoReturn, TypeVar

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError, printable
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.meshes.numerals import PAD, Bytes, NumeralError, decimals, integers, padded
from vectorplot.scene.fields import Fields

# A blank that stands for the end of a line joined to the next one.
JOINT = b"\v"

# Work in pieces that stay in the processor's cache.
_PIECE = 1 << 19

Value = TypeVar("Value")


@dataclass(frozen=True, eq=False)
class MeshFile:
    """The content of a mesh file: one mesh; its parts by name and the first face (k,) of each; the relative spacing of
    its coordinates; and numbers at its vertices and on its faces, if it has any."""

    mesh: Mesh
    names: tuple[str, ...]
    first_faces: tuple[int, ...]
    precision: float
    fields: Fields | None = None


def shown(path: Path) -> str:
    """The path as one line of a message."""
    return printable(str(path))


def file_bytes(path: Path) -> bytes:
    """The bytes of a file. Errors: InputError for what cannot be opened, a directory, an empty file."""
    check_file(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(error.strerror or "cannot be read", file=shown(path)) from None
    return data


def check_file(path: Path) -> int:
    """The size of a file in bytes. Errors: InputError for what is no regular readable file, or empty."""
    try:
        if path.is_dir():
            raise InputError("is a directory", file=shown(path))
        if not path.exists():
            raise InputError("no such file", file=shown(path))
        if not path.is_file():
            raise InputError("is not a regular file", file=shown(path))
        with path.open("rb"):
            size = path.stat().st_size
    except InputError:
        raise
    except OSError as error:
        raise InputError(error.strerror or "cannot be read", file=shown(path)) from None
    except ValueError:
        raise InputError("is not a file name", file=shown(path)) from None
    if size == 0:
        raise InputError("the file is empty", file=shown(path))
    return size


@dataclass(frozen=True, eq=False)
class TextLines:
    """Some lines of a text that hold words, in the order of the file.

    text: the padded piece of the file; starts, ends (w,) of its words; first (l,) the first word of every line, count
    (l,) how many it has; offset: what to add to a position in text for the position in the file.
    """

    source: TextFile
    text: Bytes
    starts: Ints
    ends: Ints
    first: Ints
    count: Ints
    offset: int

    def part(self, begin: int, end: int) -> TextLines:
        """The lines from begin to before end."""
        first, count = self.first[begin:end], self.count[begin:end]
        return TextLines(self.source, self.text, self.starts, self.ends, first, count, self.offset)

    def word(self, index: int) -> str:
        """A word by its number."""
        return self.text[self.starts[index] : self.ends[index]].tobytes().decode("utf-8", "replace")

    def decimals(self, words: Ints) -> Floats:
        """The numbers at the given words, in the same shape. Errors: InputError with the line of the first bad one."""
        return self._convert(decimals, words)

    def integers(self, words: Ints) -> Ints:
        """The integers at the given words, in the same shape. Errors: InputError with the line of the first bad one."""
        return self._convert(integers, words)

    def fail(self, word: int, cause: str) -> NoReturn:
        """An InputError that names the line of the word."""
        self.source.fail(int(self.starts[word]) + self.offset, cause)

    def _convert(self, convert: Callable[[Bytes, Ints, Ints], Value], words: Ints) -> Value:
        flat = words.ravel()
        try:
            values = convert(self.text, self.starts[flat], self.ends[flat])
        except NumeralError as error:
            self.fail(int(flat[error.index]), error.cause)
        return values.reshape(words.shape)  # type: ignore[attr-defined, no-any-return]


@dataclass(frozen=True, eq=False)
class TextFile:
    """A text file in memory: its name for messages, and its bytes, from begin on."""

    name: str
    data: bytes
    begin: int = 0

    def fail(self, position: int, cause: str) -> NoReturn:
        """An InputError that names the line of the position."""
        line = 1 + self.data.count(b"\n", 0, position) + self.data.count(JOINT, 0, position)
        raise InputError(cause, file=self.name, line=line)

    def fail_at_end(self, cause: str) -> NoReturn:
        """An InputError that names the last line."""
        self.fail(len(self.data.rstrip()), cause)

    def lines(self, *, comment: bytes = b"#", slashed: bool = False) -> Iterator[TextLines]:
        """The lines in pieces of half a megabyte; slashed: of a word like 7/3/2 the part before the first slash."""
        begin = self.begin
        while begin < len(self.data):
            end = self.data.find(b"\n", min(begin + _PIECE, len(self.data)))
            end = len(self.data) if end < 0 else end + 1
            yield self._piece(begin, end, comment, slashed)
            begin = end

    def sections(
        self, counts: list[int], names: list[str], *, comment: bytes = b"#"
    ) -> Iterator[tuple[int, TextLines]]:
        """The lines of consecutive sections with the given counts of lines, each piece with the number of its section.

        Errors: InputError if the file ends before.
        """
        section, missing = 0, next(iter(counts), 0)
        for lines in self.lines(comment=comment):
            at = 0
            while at < len(lines.first) and section < len(counts):
                take = min(missing, len(lines.first) - at)
                if take:
                    yield section, lines.part(at, at + take)
                at, missing = at + take, missing - take
                while missing == 0 and section < len(counts):
                    section += 1
                    missing = counts[section] if section < len(counts) else 0
        if section < len(counts) and any(counts[section + 1 :]) | (missing > 0):
            total = counts[section]
            self.fail_at_end(f"the file ends after {total - missing} of {total} {names[section]}")

    def _piece(self, begin: int, end: int, comment: bytes, slashed: bool) -> TextLines:
        text = padded(self.data[begin:end])
        breaks = np.flatnonzero(text == ord("\n"))
        if comment and self.data.find(comment, begin, end) >= 0:
            _blank_comments(text, breaks, ord(comment))
        # Blanks are the space and the characters 9 to 13 (below 9 the difference wraps round).
        inked = (text != 32) & (text - np.uint8(9) > 4)
        cut = slashed and self.data.find(b"/", begin, end) >= 0
        if cut:
            inked &= text != ord("/")
        changes = np.flatnonzero(inked[1:] != inked[:-1]) + 1
        starts, ends = changes[0::2], changes[1::2]
        if cut:
            keep = text[starts - 1] != ord("/")
            starts, ends = starts[keep], ends[keep]
        first = np.concatenate([[0], np.searchsorted(starts, breaks)])
        count = np.diff(first, append=len(starts))
        first, count = first[count > 0], count[count > 0]
        return TextLines(self, text, starts, ends, first, count, begin - PAD)


def _blank_comments(text: Bytes, breaks: Ints, mark: int) -> None:
    """Overwrites everything from a comment mark to the end of its line with blanks."""
    marks = np.flatnonzero(text == mark)
    stops = np.append(breaks, len(text))[np.searchsorted(breaks, marks)]
    # Of several marks in a line the first one counts.
    first = np.concatenate([[True], stops[1:] != stops[:-1]])
    depth = np.zeros(len(text) + 1, dtype=np.int8)
    depth[marks[first]] += 1
    depth[stops[first]] -= 1
    text[np.cumsum(depth[:-1], dtype=np.int8) > 0] = 32


def text_file(path: Path) -> TextFile:
    """The file as text, its line ends as newlines, without a byte order mark. Errors: InputError as file_bytes."""
    data = file_bytes(path).removeprefix(b"\xef\xbb\xbf")
    if b"\r" in data and b"\n" not in data:
        data = data.replace(b"\r", b"\n")
    return TextFile(shown(path), data)


def check_announced(name: str, announced: dict[str, int], least_bytes: int, size: int) -> None:
    """An InputError if a file of size bytes cannot hold what it announces, which takes least_bytes or more."""
    if least_bytes > size:
        what = " and ".join(f"{count} {kind}" for kind, count in islice(announced.items(), 10))
        raise InputError(f"announces {what}, but has only {size} bytes (truncated, or a wrong count)", file=name)


def joined(pieces: list[Floats], columns: int) -> Floats:
    """The pieces (k,columns) one below the other; empty if there are none."""
    return np.concatenate([np.zeros((0, columns)), *pieces])


def polygon_mesh(vertices: Floats, corners: list[Ints], sizes: list[Ints]) -> Mesh:
    """The mesh of faces given by pieces of their corners and of their sizes."""
    none = np.zeros(0, dtype=np.intp)
    offsets = np.cumsum(np.concatenate([[0], *sizes]), dtype=np.intp)
    return Mesh(vertices, np.concatenate([none, *corners]), offsets)
