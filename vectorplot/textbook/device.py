"""A screen that understands the handful of calls every graphics device has; each call gives the device after it.

Source: Glaeser, section 4.2 and appendix B.1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.clipping import Polygons
from vectorplot.shading.pixel_coverage import line_pixels
from vectorplot.textbook import framebuffer
from vectorplot.textbook import framebuffer as drawn_pixels
from vectorplot.textbook.framebuffer import Framebuffer


@dataclass(frozen=True)
class DepthCueing:
    """How a device shades lines by their depths, which grow towards the eye.

    Parameters
    ----------
    farthest, nearest : float
        The range of depths; beyond its ends nothing changes any more.
    first, last : int
        The colour numbers there, 0 to 255.

    Raises
    ------
    InputError
        For a range that is none, and for what is no colour number.

    Notes
    -----
    Source: Glaeser, section 4.4 (devices with depth cueing of their own).

    Examples
    --------
    >>> from vectorplot.textbook import DepthCueing
    >>> DepthCueing(-1.0, 1.0, 10, 20).numbers([-5.0, 0.0, 1.0]).tolist()
    [10, 15, 20]
    """

    farthest: float
    nearest: float
    first: int
    last: int

    def __post_init__(self) -> None:
        if not -np.inf < self.farthest < self.nearest < np.inf:
            raise InputError(f"depths from {self.farthest:g} to {self.nearest:g}: expected a range of finite numbers")
        for number in (self.first, self.last):
            _check_number(number)

    def numbers(self, depth: ArrayLike) -> Ints:
        """The colour numbers of depths, linear between the limits.

        depth (...): they grow towards the eye; result: (...) of the nearest whole numbers.
        """
        near = np.interp(np.asarray(depth, dtype=np.float64), (self.farthest, self.nearest), (0.0, 1.0))
        return np.rint(self.first + near * (self.last - self.first)).astype(np.intp)


@dataclass(frozen=True, eq=False)
class Device:
    """A device with two pages of colour numbers.

    Parameters
    ----------
    window : Framebuffer, optional
        None while it is closed.
    colour : int
        The number that is drawn with, 0 to 255.
    position : (2,) or (3,) array of float, optional
        Where the next line starts, in pixels, and its depth.
    area : tuple of (2,) array of float
        The corners of the polygon that is being described, in pixels.
    keys : str
        Characters typed and not yet asked for.
    bells : int
        How often it has beeped.
    cueing : DepthCueing, optional
        Shades lines by their depths, in place of colour; None while that is off.

    Raises
    ------
    InputError
        For drawing while the window is closed, for drawing on before a first move; while lines are shaded by depth for
        ends of lines without one.

    Notes
    -----
    Each of its functions gives the device after that.

    Examples
    --------
    >>> from vectorplot.textbook import Device
    >>> device = Device().opened(8, 4).with_colour(7).moved((0, 0)).drawn((3, 0))
    >>> [device.pixel(column, 0) for column in range(5)]
    [7, 7, 7, 7, 0]
    >>> device.swapped().frame.picture()[0, 0].tolist()
    [7, 7, 7]
    """

    window: Framebuffer | None = None
    colour: int = 0
    position: Floats | None = None
    area: tuple[Floats, ...] = ()
    keys: str = ""
    bells: int = 0
    cueing: DepthCueing | None = None

    @property
    def frame(self) -> Framebuffer:
        """The open window's framebuffer."""
        if self.window is None:
            raise InputError("no window is open")
        return self.window

    def opened(self, columns: int, rows: int) -> Device:
        """The device with an open window, all of the colour number 0.

        columns, rows: the size in pixels; result: after that.
        Errors: for a raster too large or without pixels.
        """
        return replace(self, window=Framebuffer.of_numbers(columns, rows))

    def closed(self) -> Device:
        """Without a window."""
        return replace(self, window=None, position=None, area=())

    def cleared(self, number: int) -> Device:
        """The device with the drawn page in one colour.

        number: of the colour, 0 to 255; result: after that.
        Errors: for another number, and without a window.
        """
        return replace(self, window=framebuffer.cleared(self.frame, number))

    def swapped(self) -> Device:
        """With the drawn page shown (double buffering)."""
        return replace(self, window=framebuffer.swapped_buffers(self.frame))

    def with_rgb(self, number: int, red: int, green: int, blue: int) -> Device:
        """The device with a new colour under a number.

        number: 0 to 255; red, green, blue: 0 to 255; result: after that.
        Errors: for other numbers, and without a window.
        """
        return replace(self, window=framebuffer.with_colour(self.frame, number, red, green, blue))

    def with_colour(self, number: int) -> Device:
        """The device drawing with a colour number from here on.

        number: 0 to 255; result: after that.
        Errors: for another number.
        """
        _check_number(number)
        return replace(self, colour=int(number))

    def with_depth_cueing(self, cueing: DepthCueing | None) -> Device:
        """The device shading lines by their depths from here on.

        cueing: the depths and their colour numbers; None: no longer; result: after that.
        """
        return replace(self, cueing=cueing)

    def pixel(self, column: int, row: int) -> int:
        """The colour number of a pixel on the drawn page.

        column, row: within the window; result: 0 to 255.
        Errors: for a pixel outside the window, and without one.
        """
        return int(framebuffer.pixel_colours(self.frame, [(column, row)])[0, 0])

    def with_pixel(self, column: int, row: int) -> Device:
        """The device with a pixel in the current colour.

        column, row: one outside the window is left out; result: after that.
        Errors: without a window.
        """
        return replace(self, window=framebuffer.with_pixels(self.frame, [(column, row)], self.colour))

    def moved(self, point: ArrayLike) -> Device:
        """The device with the start of a polyline at a point.

        point (2 or more,): column and row, whole or not; result: after that.
        """
        return replace(self, position=_place(point))

    def drawn(self, point: ArrayLike) -> Device:
        """The device with a line from the current position to a point, which is the next position.

        point (2 or more,): column and row, whole or not, and a depth; result: after that.
        Errors: without a window, and before a first move; for ends without a depth while lines are shaded by it.
        """
        start, end = self._start(), _place(point)
        if self.cueing is not None:
            return replace(self, window=_with_shaded_line(self.frame, start, end, self.cueing), position=end)
        return replace(self, window=drawn_pixels.with_lines(self.frame, [start], [end], self.colour), position=end)

    def rubber_band(self, point: ArrayLike) -> Device:
        """As drawn, but by exclusive or: the same again erases it.

        point (2 or more,): column and row, whole or not; result: after that.
        Errors: without a window, and before a first move.
        """
        start, end = self._start(), _place(point)
        return replace(
            self, window=drawn_pixels.with_rubber_bands(self.frame, [start], [end], self.colour), position=end
        )

    def moved_area(self, point: ArrayLike) -> Device:
        """The device with the first corner of a polygon.

        point (2 or more,): column and row, whole or not; result: after that.
        """
        return replace(self, area=(_plane(point),))

    def drawn_area(self, point: ArrayLike) -> Device:
        """The device with the next corner of the polygon.

        point (2 or more,): column and row, whole or not; result: after that.
        Errors: before a first corner.
        """
        if not self.area:
            raise InputError("an area needs a first corner")
        return replace(self, area=(*self.area, _plane(point)))

    def closed_area(self) -> Device:
        """With the polygon filled in the current colour."""
        if not self.area:
            raise InputError("an area needs a first corner")
        polygon = Polygons.of(np.stack(self.area))
        return replace(self, window=drawn_pixels.with_polygons(self.frame, polygon, self.colour), area=())

    def key_pressed(self) -> tuple[int, Device]:
        """The code of the next character typed, 0 if there is none, and the device without it."""
        return (ord(self.keys[0]) if self.keys else 0), replace(self, keys=self.keys[1:])

    def beeped(self) -> Device:
        """After an acoustic signal."""
        return replace(self, bells=self.bells + 1)

    def _start(self) -> Floats:
        if self.position is None:
            raise InputError("a line needs a start: move there first")
        return self.position


def _check_number(number: int) -> None:
    if not 0 <= number <= 255:
        raise InputError(f"colour number {number}: expected 0 to 255")


def _place(point: ArrayLike) -> Floats:
    """(2,) or (3,) the first two components of a point, and its depth if it has one."""
    p = np.asarray(point, dtype=np.float64)
    if p.ndim != 1 or len(p) < 2 or not np.isfinite(p).all():
        raise InputError("a point needs two finite numbers")
    return np.asarray(p[:3])


def _plane(point: ArrayLike) -> Floats:
    """(2,) the first two components of a point."""
    return _place(point)[:2]


def _with_shaded_line(frame: Framebuffer, start: Floats, end: Floats, cueing: DepthCueing) -> Framebuffer:
    """With a line whose colour number follows its depth, pixel by pixel."""
    if len(start) < 3 or len(end) < 3:
        raise InputError("a line that is shaded by its depth needs a depth at both ends")
    _, rows, columns, _ = frame.pages.shape
    for pixels in line_pixels([start], [end], columns, rows):
        numbers = cueing.numbers(start[2] + pixels.share * (end[2] - start[2]))
        frame = framebuffer.with_pixels(frame, np.column_stack([pixels.column, pixels.row]), numbers[:, None])
    return frame
