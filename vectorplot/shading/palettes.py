"""Palettes: ramps of shades from dark to bright, their halves, and the colour map they share.

Source: Glaeser, sections 4.3 and 8.5.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.shading.illumination import shade_numbers

Colours = NDArray[np.uint8]
Colour = tuple[float, float, float]

PALETTE_LIMITS: dict[str, tuple[Colour, Colour]] = {
    "gray": ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)),
    "green": ((0.0, 0.30, 0.0), (0.80, 1.0, 0.80)),
    "yellow": ((0.50, 0.30, 0.0), (1.0, 1.0, 0.50)),
    "blue": ((0.0, 0.25, 0.45), (0.70, 0.70, 1.0)),
    "pink": ((0.50, 0.0, 0.25), (1.0, 0.85, 0.80)),
    "cyan": ((0.0, 0.25, 0.25), (0.50, 1.0, 1.0)),
    "magenta": ((0.10, 0.10, 0.10), (1.0, 0.20, 1.0)),
    "orange": ((0.50, 0.15, 0.0), (1.0, 0.60, 0.40)),
}
"""Darkest and brightest shade of each parent palette, red, green and blue from 0 to 1."""

PLAIN: dict[str, Colour] = {"white": (1.0, 1.0, 1.0), "black": (0.0, 0.0, 0.0), "red": (1.0, 0.0, 0.0)}
"""Colours of their own, which belong to no palette (decision D-6)."""

PALETTE_SIZE = 32
"""How many shades a palette has if nobody says otherwise: eight of them fill a colour map."""

COLOUR_MAP = 256
"""Entries of a colour map."""

DARKEST_SHARE = 0.2
"""The darkest shade of a plain colour or #rrggbb, as a part of the colour itself, which is the brightest."""

_HEX = re.compile(r"#[0-9a-fA-F]{6}")


def ramp(lower: ArrayLike, upper: ArrayLike, count: int = PALETTE_SIZE) -> Floats:
    """(count, 3) shades at equal steps from one colour to another, both among them.

    Errors: InputError for fewer than two shades. Source: Glaeser, section 4.3, equation 1; erratum G4-01.
    """
    if not 2 <= count <= COLOUR_MAP:
        raise InputError(f"a palette of {count} shades: expected 2 to {COLOUR_MAP}")
    low, high = np.asarray(lower, dtype=np.float64), np.asarray(upper, dtype=np.float64)
    return np.asarray(low + np.linspace(0.0, 1.0, count)[:, None] * (high - low))


def spectrum(lower: ArrayLike, upper: ArrayLike, count: int = PALETTE_SIZE, levels: int = 256) -> Ints:
    """The shades of a ramp for a device with some levels of red, green and blue each, no two neighbours equal.

    lower, upper: (3,) the darkest and the brightest colour, 0 to 1; result: (count, 3) 0 to levels - 1.
    Source: Glaeser, section 4.3; errata G4-01, G4-02.
    """
    limits = np.array((lower, upper), dtype=np.float64)
    if levels < 2 or limits.shape != (2, 3) or not ((limits >= 0.0) & (limits <= 1.0)).all():
        raise InputError("a spectrum needs two levels or more, and limits from 0 to 1")
    shades = np.floor(ramp(limits[0], limits[1], count) * (levels - 1) + 0.5).astype(np.intp)
    if not (shades[1:] == shades[:-1]).all(axis=1).any():
        return shades
    growth = np.argsort(limits[0] - limits[1], kind="stable")
    for before, shade in pairwise(shades):
        if (before == shade).all():
            free = growth[shade[growth] < levels - 1]
            shade[free[0] if len(free) else growth[-1]] += 1 if len(free) else -1
    return shades


def light_half(shades: Colours) -> Colours:
    """(n, ...) the bright subpalette of a palette of as many shades: number i is number (n + i) / 2 of the parent.

    Source: Glaeser, section 4.3, figure 1.
    """
    return shades[(len(shades) + np.arange(len(shades))) // 2]


def dark_half(shades: Colours) -> Colours:
    """(n, ...) the dark subpalette of a palette of as many shades: number i is number i / 2 of the parent.

    Source: Glaeser, section 4.3, figure 1.
    """
    return shades[np.arange(len(shades)) // 2]


def palette(name: str, count: int = PALETTE_SIZE) -> Colours:
    """The shades of a palette by its name, from dark to bright.

    Parameters
    ----------
    name : str
        A parent (gray, green, yellow, blue, pink, cyan, magenta, orange), or its half as light... or dark...; white,
        black, red and #rrggbb run from a fifth of that colour to it.
    count : int
        How many shades, 2 to 256.

    Returns
    -------
    (count, 3) array of uint8
        Red, green and blue.

    Raises
    ------
    InputError
        For an unknown name and a wrong count.

    Notes
    -----
    Source: Glaeser, section 4.3; erratum G4-01.

    Examples
    --------
    >>> from vectorplot import shading
    >>> shading.palette("gray", 4).tolist()
    [[0, 0, 0], [85, 85, 85], [170, 170, 170], [255, 255, 255]]
    >>> shading.palette("red", 2).tolist()
    [[51, 0, 0], [255, 0, 0]]
    """
    if name in PLAIN or _HEX.fullmatch(name):
        full = np.array(PLAIN[name]) if name in PLAIN else _of_hex(name)
        return np.rint(255.0 * ramp(DARKEST_SHARE * full, full, count)).astype(np.uint8)
    parent, half = parent_and_half(name)
    shades = spectrum(*PALETTE_LIMITS[parent], count).astype(np.uint8)
    chosen = {"": shades, "light": light_half(shades), "dark": dark_half(shades)}[half]
    return chosen


def parent_and_half(name: str) -> tuple[str, str]:
    """The parent palette a name belongs to, and which half of it: ``light``, ``dark`` or nothing.

    Errors: InputError for a name that is none.
    """
    for half in ("", "light", "dark"):
        if name.startswith(half) and name.removeprefix(half) in PALETTE_LIMITS:
            return name.removeprefix(half), half
    raise InputError(
        f"colour {name!r}: expected a palette ({', '.join(PALETTE_LIMITS)}), its light or dark half, or #rrggbb"
    )


def palette_number(name: str) -> int:
    """The number of a palette: parents 0 to 7, their light halves 8 to 15, their dark halves 16 to 23.

    Errors: InputError for a name that is none. Source: Glaeser, section 4.3.
    """
    parent, half = parent_and_half(name)
    return list(PALETTE_LIMITS).index(parent) + 8 * ("", "light", "dark").index(half)


def mixed(shades: ArrayLike, light: ArrayLike, kept: int) -> Floats:
    """(n, 3) the palette of a body under a coloured light: its brighter shades, from number kept on, run to the
    light's colour. Source: Glaeser, section 8.5, note on coloured light sources."""
    body = np.asarray(shades, dtype=np.float64)
    if not 1 <= kept < len(body):
        raise InputError(f"{kept} shades of {len(body)} cannot be kept")
    share = np.clip((np.arange(len(body)) - kept + 1) / (len(body) - kept), 0.0, 1.0)[:, None]
    return np.asarray(body + share * (np.asarray(light, dtype=np.float64) - body))


def shaded_colours(names: Sequence[str], which: Ints, shade: ArrayLike, count: int = PALETTE_SIZE) -> Colours:
    """Colours of some palettes, at shades from 0 to 1.

    Parameters
    ----------
    names : sequence of str
        Palettes.
    which : (n,) array of int
        Which of the palettes.
    shade : (n,) or (3, n) array_like of float
        0 to 1; of red, green and blue, as coloured light makes them: a component each of a shade of its own.
    count : int
        How many shades a palette has.

    Returns
    -------
    (n, 3) array of uint8
        Red, green and blue.

    Raises
    ------
    InputError
        For an unknown palette, or a wrong count.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import shading
    >>> shading.shaded_colours(["gray", "red"], np.array([0, 0, 1]), [0.0, 1.0, 1.0]).tolist()
    [[0, 0, 0], [255, 255, 255], [255, 0, 0]]
    """
    numbers = shade_numbers(shade, count).astype(np.intp)
    table = np.concatenate([np.zeros((0, 3), np.uint8), *(palette(name, count) for name in names)])
    entry = np.asarray(which, dtype=np.intp) * count + numbers
    return np.asarray(table[entry] if entry.ndim == 1 else table[entry, np.arange(3)[:, None]].T)


@dataclass(frozen=True, eq=False)
class ColourMap:
    """The entries of a device's colour table: palettes one after the other, and what belongs to others before them.

    entries (m,3): red, green and blue; parents: the palettes that are in use, in their order; size: how many shades
    each has; offset: the first entry of the first palette.
    Source: Glaeser, section 4.3.
    Errors: from entry: for a palette that is not in the map.
    """

    entries: Colours
    parents: tuple[str, ...]
    size: int
    offset: int

    def entry(self, name: str, shade: ArrayLike) -> Ints:
        """The entries for shades of a palette; halves lie in their parents.

        name: a palette of the map, or its half as light... or dark... ; shade (...): 0 to 1; result: (...) numbers in
        entries.
        Errors: for a palette that is not in the map.
        """
        parent, half = parent_and_half(name)
        if parent not in self.parents:
            raise InputError(f"colour {name!r} is not in the colour map of {', '.join(self.parents)}")
        number = shade_numbers(shade, self.size).astype(np.intp)
        within = {"": number, "light": (self.size + number) // 2, "dark": number // 2}[half]
        return np.asarray(self.offset + self.parents.index(parent) * self.size + within)

    @property
    def background(self) -> tuple[int, int, int]:
        """The colour of an empty picture: the darkest gray, also if the palette is not in use."""
        red, green, blue = palette("gray")[0].tolist()
        return red, green, blue


def colour_map(names: Sequence[str], colours: int = COLOUR_MAP, offset: int = 0) -> ColourMap:
    """The colour map for a picture with some palettes: the fewer there are, the more shades each has.

    Parameters
    ----------
    names : sequence of str
        Palettes, or halves of them, which lie in their parents.
    colours : int
        Entries of the map.
    offset : int
        So many entries at its beginning belong to others.

    Returns
    -------
    ColourMap
        Its entries (colours, 3), and which belong to a shade of a palette.

    Raises
    ------
    InputError
        For what is no palette, and where there is no room for two shades each.

    Notes
    -----
    All eight palettes have 32 shades each in a map of 256.

    Edge cases: without palettes all parents are in it.

    Source: Glaeser, section 4.3; erratum G4-02.

    Examples
    --------
    >>> from vectorplot import shading
    >>> colours = shading.colour_map(["gray", "lightblue"])
    >>> colours.parents, colours.size
    (('gray', 'blue'), 128)
    >>> colours.entry("lightblue", [0.0, 1.0]).tolist()
    [192, 255]
    """
    used = {parent_and_half(name)[0] for name in names}
    parents = tuple(name for name in PALETTE_LIMITS if name in used or not used)
    size = min((colours - offset) // len(parents), COLOUR_MAP)
    if offset < 0 or size < 2:
        raise InputError(f"a colour map of {colours} from {offset} on has no room for {len(parents)} palettes")
    entries = np.zeros((colours, 3), dtype=np.uint8)
    entries[offset : offset + size * len(parents)] = np.concatenate([palette(name, size) for name in parents])
    return ColourMap(entries, parents, size, offset)


def _of_hex(name: str) -> Floats:
    return np.array([int(name[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
