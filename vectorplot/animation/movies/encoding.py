"""A movie as two files: bytes in the one, twelve-bit numbers in the other."""

from __future__ import annotations

import numpy as np

from vectorplot.animation.movies.movie import Movie, MovieFrame
from vectorplot.animation.movies.packing import packed
from vectorplot.arrays import Ints
from vectorplot.geometry import ragged

IDENTITY = 255
"""The first number of either file."""

NEW_FRAME, END = 254, 255
"""Where a frame begins, and where the movie ends."""

NEW, FROZEN = 1, 0
"""Whether a frame differs from the one before it."""


def encoded(movie: Movie) -> tuple[bytes, bytes]:
    """The contents of the two files of a movie.

    Parameters
    ----------
    movie : Movie
        What they hold.

    Returns
    -------
    bytes
        Of NAME.vd1: marks, palettes, numbers of corners and shades.
    bytes
        Of NAME.vd2: coordinates.

    Notes
    -----
    A quadrilateral of one shade takes 15 bytes, one with a shade for each corner 18, a line 9.

    Source: Glaeser, section 10.1; errata G10-03, G10-05, G10-10; decision D-8.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import animation
    >>> gray = animation.MoviePalette(0, (0, 0, 0), (255, 255, 255))
    >>> line = animation.MovieFrame(np.array([(0, 0), (9, 9)]), np.array([0, 2]), np.array([0]), np.array([5, 5]))
    >>> first, second = animation.encoded(animation.Movie((gray,), (line, None)))
    >>> list(first)
    [255, 0, 0, 0, 0, 0, 255, 255, 255, 254, 1, 2, 0, 5, 254, 0, 255]
    >>> second.hex()
    '0ff000000009009000000000'
    """
    head = bytes([IDENTITY, int(movie.smooth)])
    palettes = b"".join(bytes([one.index, *one.lower, *one.upper]) for one in movie.palettes)
    frames = b"".join(
        bytes([NEW_FRAME, FROZEN]) if one is None else bytes([NEW_FRAME, NEW]) + _records(one, movie.smooth)
        for one in movie.frames
    )
    places = [np.array([IDENTITY]), *(one.points.ravel() for one in movie.frames if one is not None)]
    return head + palettes + frames + bytes([END]), packed(np.concatenate(places))


def _records(frame: MovieFrame, smooth: bool) -> bytes:
    """Number of corners, palette and shades of each polygon."""
    sizes = frame.sizes
    shades = shade_counts(sizes, smooth)
    out = np.zeros(int((2 + shades).sum()), dtype=np.uint8)
    start = ragged.starts(2 + shades)
    out[start], out[start + 1] = sizes, frame.palette
    out[ragged.ranges(start + 2, shades)] = frame.shades[ragged.ranges(frame.offsets[:-1], shades)]
    return out.tobytes()


def shade_counts(sizes: Ints, smooth: bool) -> Ints:
    """(m,) how many shades polygons of so many corners have in the file."""
    return np.where((sizes == 2) | (not smooth), 1, sizes)
