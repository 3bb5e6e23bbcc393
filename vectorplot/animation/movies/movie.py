"""The value Movie: frames as polygons in the colours of palettes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from vectorplot.animation.movies.packing import LARGEST_12_BIT
from vectorplot.arrays import Ints
from vectorplot.errors import InputError
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, some

Bytes = NDArray[np.uint8]

MOST_CORNERS = 253
"""Corners of a polygon: the two largest bytes are marks."""

MOST_PALETTES = 254
"""Palettes of a movie: one of the two largest bytes is a mark, and the other one would be taken for it."""

FPS = 30.0
"""Frames a second of a movie, which does not say it: a frozen frame is there for a thirtieth of a second more."""


@dataclass(frozen=True)
class MoviePalette:
    """A ramp of 256 shades.

    Parameters
    ----------
    index : int
        0 to 253.
    lower, upper : (int, int, int)
        Red, green and blue of the darkest and of the brightest shade, 0 to 255.

    Raises
    ------
    InputError
        For numbers out of range.

    Notes
    -----
    Source: Glaeser, sections 4.3 and 10.1.

    Examples
    --------
    >>> from vectorplot import animation
    >>> animation.MoviePalette(0, (0, 0, 0), (255, 255, 255)).shades[128].tolist()
    [128, 128, 128]
    """

    index: int
    lower: tuple[int, int, int]
    upper: tuple[int, int, int]

    def __post_init__(self) -> None:
        if not 0 <= self.index < MOST_PALETTES:
            raise InputError(f"a palette of the index {self.index}: expected 0 to {MOST_PALETTES - 1}")
        if not all(0 <= part <= 255 for part in (*self.lower, *self.upper)):
            raise InputError(f"palette {self.index}: red, green and blue are numbers from 0 to 255")

    @property
    def shades(self) -> Bytes:
        """(256, 3) red, green and blue of every shade."""
        low, high = np.array(self.lower, dtype=np.float64), np.array(self.upper, dtype=np.float64)
        share = np.linspace(0.0, 1.0, 256)[:, None]
        return np.floor(low + share * (high - low) + 0.5).astype(np.uint8)


@dataclass(frozen=True, eq=False)
class MovieFrame:
    """Polygons and lines, each painted over those before it.

    Parameters
    ----------
    points : (p, 2) array of int
        0 to 4095, y upwards; one unit for both axes.
    offsets : (m+1,) array of int
        Polygon k has the corners offsets[k] to offsets[k+1], 2 to 253; two are those of a line.
    palette : (m,) array of int
        The index of the palette of each.
    shades : (p,) array of int
        0 to 255 for every corner; those of a line are equal.

    Raises
    ------
    InputError
        Where the arrays do not fit together, and for numbers out of range.

    Notes
    -----
    Source: Glaeser, section 10.1; errata G10-04, G10-06.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import animation
    >>> points = np.array([(0, 0), (4095, 0), (0, 4095)])
    >>> frame = animation.MovieFrame(points, np.array([0, 3]), np.array([0]), np.array([9, 9, 9]))
    >>> len(frame), frame == frame
    (1, True)
    """

    points: Ints = field(metadata=EACH_POINT)
    offsets: Ints
    palette: Ints = field(metadata=EACH_LINE)
    shades: Ints = field(metadata=EACH_POINT)

    def __post_init__(self) -> None:
        p, m = len(self.points), len(self.offsets) - 1
        fits = self.points.shape == (p, 2) and self.palette.shape == (m,) and self.shades.shape == (p,)
        if not (fits and m >= 0 and self.offsets[0] == 0 and self.offsets[-1] == p):
            raise InputError(f"a frame: {p} points and {m} polygons do not fit the other columns")
        sizes = self.sizes
        if m and not (2 <= sizes.min() and sizes.max() <= MOST_CORNERS):
            raise InputError(f"a frame: polygons have 2 to {MOST_CORNERS} corners")
        limits = ((self.points, LARGEST_12_BIT), (self.palette, MOST_PALETTES - 1), (self.shades, 255))
        if any(column.size and (column.min() < 0 or column.max() > most) for column, most in limits):
            raise InputError("a frame: a number is out of range")
        if (self.shades[self.offsets[:-1]][sizes == 2] != self.shades[self.offsets[1:] - 1][sizes == 2]).any():
            raise InputError("a frame: a line has one shade")

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, MovieFrame):
            return NotImplemented
        columns = ("points", "offsets", "palette", "shades")
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in columns)

    @property
    def sizes(self) -> Ints:
        """(m,) how many corners each polygon has."""
        return np.diff(self.offsets)

    @property
    def smooth(self) -> bool:
        """Whether the shade of any polygon varies."""
        first = np.repeat(self.shades[self.offsets[:-1]], self.sizes)
        return bool((self.shades != first).any())

    def some(self, which: Ints | NDArray[np.bool_]) -> MovieFrame:
        """The polygons with these numbers, or those where a mask is true.

        Parameters
        ----------
        which : (k,) array of int or bool
            Numbers from 0, or a mask (m,).

        Returns
        -------
        MovieFrame
            In this order.

        Examples
        --------
        >>> import numpy as np
        >>> from vectorplot import animation
        >>> line = animation.MovieFrame(np.array([(0, 0), (9, 9)]), np.array([0, 2]), np.array([0]), np.array([5, 5]))
        >>> len(line.some(np.array([0, 0]))), len(line.some(np.array([False])))
        (2, 0)
        """
        return some(self, which)


@dataclass(frozen=True)
class Movie:
    """A movie: palettes, and frames.

    Parameters
    ----------
    palettes : tuple of MoviePalette
        Each index once.
    frames : tuple of MovieFrame or None
        None is a frozen frame: the one before it, once more; first of all an empty one.
    smooth : bool
        Whether files have a shade for every corner; otherwise one for every polygon.

    Raises
    ------
    InputError
        For palettes of one index, frames in palettes that there are not, and varying shades in a movie that is not
        smooth.

    Notes
    -----
    Source: Glaeser, chapter 10.

    Examples
    --------
    >>> from vectorplot import animation
    >>> print(animation.Movie((), (None, None)))
    2 frames, 2 of them frozen; 0 palettes; 0 polygons, one shade each
    """

    palettes: tuple[MoviePalette, ...]
    frames: tuple[MovieFrame | None, ...]
    smooth: bool = False

    def __post_init__(self) -> None:
        known = {palette.index for palette in self.palettes}
        if len(known) < len(self.palettes):
            raise InputError("a movie: two palettes have one index")
        for frame in self.frames:
            if frame is None:
                continue
            if not known.issuperset(np.unique(frame.palette).tolist()):
                raise InputError("a movie: a polygon has a palette that there is not")
            if not self.smooth and frame.smooth:
                raise InputError("a movie that is not smooth: a polygon has several shades")

    def __len__(self) -> int:
        return len(self.frames)

    def __str__(self) -> str:
        frozen = sum(frame is None for frame in self.frames)
        polygons = sum(len(frame) for frame in self.frames if frame is not None)
        how = "a shade for each corner" if self.smooth else "one shade each"
        palettes = f"{len(self.palettes)} palettes"
        return f"{len(self)} frames, {frozen} of them frozen; {palettes}; {polygons} polygons, {how}"

    @property
    def colours(self) -> Bytes:
        """(254, 256, 3) red, green and blue of every shade of every palette, black where there is none."""
        found = np.zeros((MOST_PALETTES, 256, 3), dtype=np.uint8)
        for palette in self.palettes:
            found[palette.index] = palette.shades
        return found


def corner_colours(movie: Movie, frame: MovieFrame) -> Bytes:
    """(p,3) red, green and blue of every corner of a frame."""
    return np.asarray(movie.colours[np.repeat(frame.palette, frame.sizes), frame.shades])
