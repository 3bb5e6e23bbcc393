"""The two files of a movie, read back: whatever they hold, within bounds and with one line for what is wrong."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NoReturn

import numpy as np

from vectorplot.animation.animation import MOST_FRAMES
from vectorplot.animation.movies.encoding import END, FROZEN, IDENTITY, NEW, NEW_FRAME, shade_counts
from vectorplot.animation.movies.movie import Movie, MovieFrame, MoviePalette
from vectorplot.animation.movies.packing import unpacked
from vectorplot.arrays import Ints
from vectorplot.errors import InputError, printable
from vectorplot.geometry import ragged

LARGEST_FILE_BYTES = 256 << 20
"""The largest file of a movie that is read."""


def read_movie(path: str | os.PathLike[str]) -> Movie:
    """The movie in two files.

    Parameters
    ----------
    path : str or path
        Their name, with or without .vd1 or .vd2.

    Returns
    -------
    Movie
        What was encoded.

    Raises
    ------
    InputError
        With the file and the byte, for what is no movie, or not all of it; for files of more than 256 MiB, and more
        than 100,000 frames.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from vectorplot import animation
    >>> movie = animation.Movie((), (None,))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     for suffix, content in zip((".vd1", ".vd2"), animation.encoded(movie), strict=True):
    ...         _ = pathlib.Path(folder, "still" + suffix).write_bytes(content)
    ...     animation.read_movie(pathlib.Path(folder, "still")) == movie
    True
    """
    whole = Path(path)
    bare = whole.with_suffix("") if whole.suffix.lower() in (".vd1", ".vd2") else whole
    first, second = (bare.with_name(bare.name + suffix) for suffix in (".vd1", ".vd2"))
    return decoded(_content(first), _content(second), printable(str(first)), printable(str(second)))


def _content(path: Path) -> bytes:
    name = printable(str(path))
    try:
        if path.stat().st_size > LARGEST_FILE_BYTES:
            raise InputError(f"larger than {LARGEST_FILE_BYTES >> 20} MiB: this is no movie", file=name)
        return path.read_bytes()
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(getattr(error, "strerror", None) or "cannot be read", file=name) from None


def decoded(first: bytes, second: bytes, first_name: str = "<vd1>", second_name: str = "<vd2>") -> Movie:
    """The movie that the contents of two files are.

    Parameters
    ----------
    first, second : bytes
        The contents of NAME.vd1 and NAME.vd2.
    first_name, second_name : str
        What messages call them.

    Returns
    -------
    Movie
        What was encoded.

    Raises
    ------
    InputError
        As of read_movie.

    Notes
    -----
    What follows the end is not read. A frame ends at the next one, or at the end of the movie (erratum G10-09).

    Source: Glaeser, section 10.2.

    Examples
    --------
    >>> from vectorplot import animation
    >>> movie = animation.Movie((animation.MoviePalette(3, (0, 0, 0), (9, 9, 9)),), (None, None))
    >>> animation.decoded(*animation.encoded(movie)) == movie
    True
    """
    places = _places(second, second_name)
    return _Reader(first, first_name, places, second_name).movie()


def _places(second: bytes, name: str) -> Ints:
    """The coordinates, without the number that stands before them."""
    try:
        numbers = unpacked(second)
    except InputError as error:
        raise InputError(error.cause, file=name) from None
    if not len(numbers) or numbers[0] != IDENTITY:
        raise InputError(f"it does not begin with {IDENTITY}: this is no movie", file=name)
    return numbers[1:]


class _Reader:
    """Reads the bytes of a movie; at: which comes next, used: how many coordinates frames have taken."""

    def __init__(self, content: bytes, name: str, places: Ints, places_name: str) -> None:
        self.content, self.name, self.places, self.places_name = content, name, places, places_name
        self.at = self.used = 0

    def fail(self, cause: str) -> NoReturn:
        """An InputError about the byte that comes next."""
        raise InputError(f"byte {self.at}: {cause}", file=self.name)

    def movie(self) -> Movie:
        """All of it."""
        try:
            return self._movie()
        except IndexError:
            self.at = len(self.content)
            self.fail("the movie breaks off here")

    def _movie(self) -> Movie:
        content = self.content
        if content[0] != IDENTITY:
            self.fail(f"expected {IDENTITY}, got {content[0]}: this is no movie")
        self.at = 1
        if content[1] > 1:
            self.fail(f"expected 0 or 1 for shades, got {content[1]}")
        smooth = content[1] == 1
        self.at = 2
        palettes = self._palettes()
        known = np.zeros(256, dtype=np.bool_)
        known[[one.index for one in palettes]] = True
        steps = [0, 0, *(2 + shade_counts(np.arange(2, NEW_FRAME), smooth)).tolist()]
        frames: list[MovieFrame | None] = []
        while content[self.at] != END:
            if len(frames) == MOST_FRAMES:
                self.fail(f"more than {MOST_FRAMES} frames")
            flag = content[self.at + 1]
            self.at += 1
            if flag not in (NEW, FROZEN):
                self.fail(f"expected 0 or 1 for a frame that is frozen or new, got {flag}")
            self.at += 1
            begin = self._polygons(steps)
            if flag == FROZEN and len(begin):
                self.at = int(begin[0])
                self.fail(f"a frozen frame has no polygons, got {content[self.at]}")
            frames.append(self._frame(begin, smooth, known) if flag == NEW else None)
        return Movie(tuple(palettes), tuple(frames), smooth)

    def _palettes(self) -> list[MoviePalette]:
        content, found = self.content, {}
        while (index := content[self.at]) < NEW_FRAME:
            if index in found:
                self.fail(f"a second palette {index}")
            if self.at + 7 > len(content):
                raise IndexError
            lower, upper = tuple(content[self.at + 1 : self.at + 4]), tuple(content[self.at + 4 : self.at + 7])
            found[index] = MoviePalette(index, (lower[0], lower[1], lower[2]), (upper[0], upper[1], upper[2]))
            self.at += 7
        return list(found.values())

    def _polygons(self, steps: list[int]) -> Ints:
        """Where the polygons of a frame begin, up to the next mark: each says how far it is to the next one."""
        content, at, begin = self.content, self.at, []
        while (count := content[at]) < NEW_FRAME:
            begin.append(at)
            if count < 2:
                self.at = at
                self.fail(f"a polygon of {count} corners")
            at += steps[count]
        self.at = at
        return np.array(begin, dtype=np.intp)

    def _frame(self, begin: Ints, smooth: bool, known: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> MovieFrame:
        every = np.frombuffer(self.content, dtype=np.uint8)
        sizes, palette = every[begin].astype(np.intp), every[begin + 1].astype(np.intp)
        if not known[palette].all():
            self.at = int(begin[np.flatnonzero(~known[palette])[0]]) + 1
            self.fail(f"there is no palette {self.content[self.at]}")
        corners = int(sizes.sum())
        if self.used + 2 * corners > len(self.places):
            raise InputError(f"it ends before the frame at byte {self.at} of {self.name}", file=self.places_name)
        points = self.places[self.used : self.used + 2 * corners].reshape(-1, 2)
        self.used += 2 * corners
        place = np.minimum(ragged.place(sizes), np.repeat(shade_counts(sizes, smooth), sizes) - 1)
        shades = every[np.repeat(begin + 2, sizes) + place].astype(np.intp)
        return MovieFrame(points, ragged.offsets(sizes), palette, shades)
