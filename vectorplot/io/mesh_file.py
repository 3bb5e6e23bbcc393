"""What the readers of mesh files share: bytes, lines and numbers in bulk, the resulting mesh, and which way is up."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import NoReturn, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, printable
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import upright_turn
from vectorplot.geometry.vectors import norm
from vectorplot.scene.colour_scales import Fields
from vectorplot.scene.face_looks import FaceLooks
from vectorplot.scene.scene import Scene

# Numbers written in text, converted in bulk: eight characters at a time, in integer arithmetic.

Bytes = NDArray[np.uint8]
Words = NDArray[np.uint64]

# A text has this many blanks in front, so that the window of any character stays inside, and is as long as whole words.
PAD = 24
_ZEROS = np.uint64(0x3030303030303030)
_HIGH = np.uint64(0x8080808080808080)
_POWERS = 10.0 ** np.arange(23)
_TENS = np.array([10**k for k in range(20)], dtype=np.uint64)
_ALLOWED = np.isin(np.arange(256), np.frombuffer(b"0123456789+-.eE", dtype=np.uint8))


class NumeralError(ValueError):
    """A word that is not the number wanted: its place among the words, and the cause."""

    def __init__(self, index: int, cause: str) -> None:
        self.index = index
        self.cause = cause
        super().__init__(cause)


def padded(data: bytes) -> Bytes:
    """The text with blanks before and after it, as the functions of this file want it."""
    text = np.full((PAD + len(data) + PAD + 7) // 8 * 8, 32, dtype=np.uint8)
    text[PAD : PAD + len(data)] = np.frombuffer(data, dtype=np.uint8)
    return text


def decimals(text: Bytes, starts: Ints, ends: Ints) -> Floats:
    """(n,) the numbers in text[starts:ends], correctly rounded: up to 8 digits before and 19 after the point, below
    2^53 together, as a quotient of two exact doubles; below 2^63 of long doubles; others by Python. Errors:
    NumeralError for a word that is no finite decimal number.
    Source: Clinger, How to read floating point numbers accurately, section 4 (the fast case).
    """
    words = text.view(np.uint64)
    lead = text[starts]
    negative = lead == ord("-")
    begin = starts + (negative | (lead == ord("+")))
    point = _points(text, starts, ends)
    before = point - begin
    after = np.maximum(ends - point - 1, 0)
    whole, good = _digits(words, point, np.minimum(before, 8))
    low, fine = _digits(words, ends, np.minimum(after, 8))
    good &= fine & (before <= 8) & (after <= 19) & (before + after > 0)
    if len(after) and after.max() > 8:
        high, fine = _digits(words, ends - 8, np.clip(after - 8, 0, 8))
        low += high * _TENS[8]
        good &= fine
    if len(after) and after.max() > 16:
        high, fine = _digits(words, ends - 16, np.clip(after - 16, 0, 3))
        low += high * _TENS[16]
        good &= fine
    mantissa = whole * _TENS[np.minimum(after, 19)] + low
    # More digits than these may not fit into 63 bits.
    good &= ((before + after <= 18) | (whole == 0)) & (mantissa < np.uint64(1 << 63))
    values = mantissa.astype(np.float64) / _POWERS[np.minimum(after, 22)]
    large = np.flatnonzero(good & (mantissa >= np.uint64(1 << 53)))
    if len(large):
        values[large], good[large] = _long_quotients(mantissa[large], after[large])
    np.negative(values, out=values, where=negative)
    if not good.all():
        odd = np.flatnonzero(~good)
        values[odd] = _one_by_one(text, starts, ends, odd)
    return np.asarray(values)


def integers(text: Bytes, starts: Ints, ends: Ints) -> Ints:
    """(n,) the integers written in text[starts:ends]. Errors: NumeralError for a word that is no integer."""
    lead = text[starts]
    negative = lead == ord("-")
    begin = starts + (negative | (lead == ord("+")))
    length = ends - begin
    digits, good = _digits(text.view(np.uint64), ends, np.minimum(length, 8))
    good &= (length >= 1) & (length <= 8)
    values = digits.astype(np.intp)
    np.negative(values, out=values, where=negative)
    for index in np.flatnonzero(~good).tolist():
        word = text[starts[index] : ends[index]].tobytes()
        if not word[word[:1] in (b"+", b"-") :].isdigit() or len(word) > 18:
            raise NumeralError(index, f"expected an integer, got {_quoted(word)}")
        values[index] = int(word)
    return values


def _points(text: Bytes, starts: Ints, ends: Ints) -> Ints:
    """(n,) where the first decimal point of every word stands; its end if there is none."""
    if len(starts) == 0:
        return ends
    points = np.flatnonzero(text[: ends[-1]] == ord("."))
    if len(points) == 0:
        return ends
    if len(points) != len(starts) or (points < starts).any() or (points >= ends).any():
        points = points[np.minimum(np.searchsorted(points, starts), len(points) - 1)]
    return np.where((points >= starts) & (points < ends), points, ends)


def _digits(words: Words, ends: Ints, length: Ints) -> tuple[Words, Bools]:
    """(n,) the integers of the 0 to 8 digits before ends, and whether they are digits.

    Source: Lemire and others, the well-known parallel conversion of eight digits: pairs, fours, eights.
    """
    place = ends - 8
    bits = ((place & 7) << 3).astype(np.uint64)
    place >>= 3
    window = words[place] >> bits
    # For a window that starts with a word the shift is by 64, which numpy defines to give 0.
    window |= words[place + 1] << (np.uint64(64) - bits)
    window ^= _ZEROS
    blank = ((8 - length) << 3).astype(np.uint64)
    window >>= blank
    window <<= blank
    good = ((window | (window + np.uint64(0x7676767676767676))) & _HIGH) == 0
    window = window * np.uint64(10) + (window >> np.uint64(8))
    mask = np.uint64(0x000000FF000000FF)
    fours = (window & mask) * np.uint64(0x000F424000000064)
    fours += ((window >> np.uint64(16)) & mask) * np.uint64(0x0000271000000001)
    return fours >> np.uint64(32), good


def _long_quotients(mantissa: Words, places: Ints) -> tuple[Floats, Bools]:
    """(n,) integers below 2^63 over powers of ten, and whether they are rounded correctly for sure.

    The quotient in 64 bits is rounded once, and again to 53: that is wrong only where the first rounding made it a tie,
    half a unit (below a power of two a quarter) from the result. Nothing is sure without a long double of 64 bits.
    """
    if np.finfo(np.longdouble).nmant != 63:
        return np.zeros(len(places)), np.zeros(len(places), dtype=np.bool_)
    long = mantissa.astype(np.longdouble) / _POWERS.astype(np.longdouble)[places]
    values = long.astype(np.float64)
    rest = np.abs(long - values).astype(np.float64) / np.spacing(values)
    return values, (rest != 0.5) & (rest != 0.25)


def _one_by_one(text: Bytes, starts: Ints, ends: Ints, odd: Ints) -> Floats:
    """Numbers of any length and with exponents, by Python's conversion."""
    lengths = (ends - starts)[odd]
    width = int(lengths.max())
    if width > 64:
        index = int(odd[int(lengths.argmax())])
        word = text[starts[index] : ends[index]].tobytes()
        raise NumeralError(index, f"expected a number, got {_quoted(word)}")
    columns = np.arange(width)
    inside = columns < lengths[:, None]
    characters = np.where(inside, text[np.minimum(starts[odd][:, None] + columns, len(text) - 1)], 0).astype(np.uint8)
    strange = np.asarray(~(_ALLOWED[characters] | ~inside).all(axis=1), dtype=np.bool_)
    words = characters.view(f"S{width}").ravel()
    # As Mathematica writes exponents: 2.7*^-4.
    for k in np.flatnonzero(strange).tolist():
        number = words[k].replace(b"*^", b"e", 1)
        if number != words[k] and _ALLOWED[np.frombuffer(number, dtype=np.uint8)].all():
            words[k], strange[k] = number, False
    values = np.full(len(odd), np.nan)
    if not strange.any():
        try:
            values = words.astype(np.float64)
        except ValueError:
            values = np.array([_float_or_nan(word) for word in words.tolist()])
    bad = np.flatnonzero(strange | ~np.isfinite(values)) if strange.any() else np.flatnonzero(~np.isfinite(values))
    if len(bad):
        k = int(np.flatnonzero(strange)[0]) if strange.any() else int(bad[0])
        raise NumeralError(int(odd[k]), f"expected a finite number, got {_quoted(words[k])}")
    return np.asarray(values)


def _float_or_nan(word: bytes) -> float:
    try:
        return float(word)
    except ValueError:
        return float("nan")


def _quoted(word: bytes) -> str:
    """The word in quotes, shortened."""
    return f"'{word[:40].decode('utf-8', 'replace')}{'...' if len(word) > 40 else ''}'"


# What the readers of mesh files share: the file's bytes, its lines in bulk, and the result.

# A blank that stands for the end of a line joined to the next one.
JOINT = b"\v"

# Work in pieces that stay in the processor's cache.
_PIECE = 1 << 19

Value = TypeVar("Value")


@dataclass(frozen=True, eq=False)
class MeshFile:
    """The content of a mesh file: one mesh; its parts by name and the first face (k,) of each; the relative spacing of
    its coordinates; and numbers at its vertices and on its faces, and looks of faces, if it has any."""

    mesh: Mesh
    names: tuple[str, ...]
    first_faces: tuple[int, ...]
    precision: float
    fields: Fields | None = None
    looks: FaceLooks | None = None


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
        raise InputError(cause, file=self.name, line=self.line(position))

    def line(self, position: int) -> int:
        """The line of a position, from 1."""
        return 1 + self.data.count(b"\n", 0, position) + self.data.count(JOINT, 0, position)

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


# Which way is up in a file of meshes: a hint where it seems to be y.

EITHER_WAY = (".obj",)
"""Formats in which programs with y upwards write as often as those with z upwards."""

SLENDER = 1.25
"""What is so many times longer along y than along x and z stands on its end, if z is up, seldom on purpose."""


def up_axis_hint(path: str, scene: Scene) -> str | None:
    """A line that says how to stand a file up that seems to have y upwards; None for others, and where the scene has a
    camera of its own. The reader of glb files, in which y is up, stands them up."""
    suffix = Path(path).suffix.lower()
    if scene.camera is not None or not len(scene):
        return None
    x, y, z = np.ptp(scene.bounds, axis=0).tolist()
    if suffix in EITHER_WAY and y > SLENDER * max(x, z):
        return f"{shown(Path(path))}: longest along y: if y is up in it, --up y stands it up"
    return None


def stood_up(scene: Scene, up: ArrayLike) -> Scene:
    """The scene turned on the shortest way so that a direction points upwards, along z. Errors: InputError for none."""
    way = np.asarray(up, dtype=np.float64)
    length = float(norm(way))
    if not 0.0 < length < np.inf:
        raise InputError("up: expected a direction")
    matrix = np.eye(4)
    # Columns: the way back of points as rows.
    matrix[:3, :3] = upright_turn(way)
    return scene.transformed(matrix)
