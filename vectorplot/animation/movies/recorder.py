"""Drawings recorded as a movie: palettes for their colours, frozen frames, covered polygons left out."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from vectorplot.animation.movies.coloured_polygons import coloured_polygons
from vectorplot.animation.movies.movie import MOST_PALETTES, Movie, MovieFrame, MoviePalette
from vectorplot.animation.movies.pruning import pruned
from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.algebra import matmul
from vectorplot.shading.light.palettes import PALETTE_LIMITS

OFF_BY = 1.5
"""A colour that is off a palette by more, in red, green or blue of 255, gets one of its own."""


def movie_of(drawings: Iterable[Drawing]) -> Movie:
    """The movie that drawings make.

    Parameters
    ----------
    drawings : iterable of Drawing
        The frames; lines, curves and polygons of them.

    Returns
    -------
    Movie
        The first polygon of each frame is the paper. A drawing like the one before it is a frozen frame. Polygons that
        later ones cover are left out.

    Notes
    -----
    Coordinates are multiplied by 4095 and divided by the longer side of the page. Widths of pens, texts and opacity are
    lost: what is transparent is mixed with white.

    Source: Glaeser, section 10.1; errata G10-04 to G10-08.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import animation
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> print(animation.movie_of([drawing, drawing]))
    2 frames, 1 of them frozen; 1 palettes; 4 polygons, one shade each
    """
    recorder = Recorder()
    for drawing in drawings:
        recorder.add(drawing)
    return recorder.movie()


class Recorder:
    """Takes one drawing after the other, and knows the movie that they make."""

    def __init__(self) -> None:
        self._palettes = _Palettes()
        self._frames: list[MovieFrame | None] = []
        self._shown: MovieFrame | None = None

    def add(self, drawing: Drawing) -> None:
        """One more frame."""
        found = coloured_polygons(drawing)
        sizes = np.diff(found.offsets)
        palette, shades = self._palettes.of(found.colours, sizes)
        frame = MovieFrame(found.points.astype(np.intp), found.offsets, palette, shades)
        frame = frame.some(pruned(frame, found.item))
        self._frames.append(None if self._shown is not None and frame == self._shown else frame)
        self._shown = frame

    def movie(self) -> Movie:
        """The movie of all frames so far."""
        smooth = any(frame.smooth for frame in self._frames if frame is not None)
        return Movie(self._palettes.used(), tuple(self._frames), smooth)


class _Palettes:
    """The palettes that colours have been found in: those with names first, then ones of their own."""

    def __init__(self) -> None:
        self.low = [np.floor(np.array(low) * 255.0 + 0.5) for low, _ in PALETTE_LIMITS.values()]
        self.high = [np.floor(np.array(high) * 255.0 + 0.5) for _, high in PALETTE_LIMITS.values()]
        self.asked: set[int] = set()

    def used(self) -> tuple[MoviePalette, ...]:
        """Those that colours were found in."""
        return tuple(
            MoviePalette(index, _bytes(self.low[index]), _bytes(self.high[index])) for index in sorted(self.asked)
        )

    def of(self, colours: Floats, sizes: Ints) -> tuple[Ints, Ints]:
        """(m,) the palette of each polygon, and (p,) the shades of its corners, from their colours (p,3)."""
        first = np.cumsum(sizes) - sizes
        mean = np.add.reduceat(colours, first, axis=0) / sizes[:, None]
        kinds, which = np.unique(np.rint(mean), axis=0, return_inverse=True)
        which = which.reshape(-1)
        error, best = self._nearest(kinds)
        while len(self.low) < MOST_PALETTES and error.max() > OFF_BY:
            self._add(kinds[int(np.argmax(error))])
            new_error, _ = _off(kinds, self.low[-1], self.high[-1])
            better = new_error < error
            best[better], error[better] = len(self.low) - 1, new_error[better]
        palette = best[which]
        self.asked |= set(np.unique(palette).tolist())
        low, high = np.array(self.low)[palette], np.array(self.high)[palette]
        span = np.repeat(high - low, sizes, axis=0)
        along = ((colours - np.repeat(low, sizes, axis=0)) * span).sum(axis=1) / np.maximum((span**2).sum(axis=1), 1.0)
        shades = np.clip(np.rint(255.0 * along), 0, 255).astype(np.intp)
        line = np.repeat(sizes == 2, sizes)
        shades[line] = np.repeat(shades[first[sizes == 2]], 2)
        return palette, shades

    def _nearest(self, colours: Floats) -> tuple[Floats, Ints]:
        """(k,) how far colours (k,3) are from the palette that is nearest, and (k,) which one that is."""
        every = np.array([_off(colours, low, high)[0] for low, high in zip(self.low, self.high, strict=True)])
        best = np.argmin(every, axis=0)
        return every[best, np.arange(len(colours))], best

    def _add(self, colour: Floats) -> None:
        """A palette from black to a colour, made as bright as it can be."""
        self.low.append(np.zeros(3))
        self.high.append(np.floor(colour * (255.0 / max(float(colour.max()), 1.0)) + 0.5))


def _off(colours: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """(k,) how far colours (k,3) are from a palette, and (k,) where along it they are nearest."""
    span = high - low
    along = (
        np.clip(np.rint(matmul(255.0 * (colours - low), span) / max(float(matmul(span, span)), 1.0)), 0, 255) / 255.0
    )
    return np.abs(colours - np.floor(low + along[:, None] * span + 0.5)).max(axis=1), along


def _bytes(colour: Floats) -> tuple[int, int, int]:
    red, green, blue = (int(part) for part in colour)
    return red, green, blue
