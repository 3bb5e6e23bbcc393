"""Movies: polygons and lines on a grid of 4096 in the colours of palettes, written as two files and read back."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.animation.animation import MOST_FRAMES
from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import CurvedStrokes, Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.strokes import chosen
from vectorplot.errors import InputError, printable
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping import Polygons, Window, clip_lines_2d, clip_polygons_2d
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, Polylines, joined, segments, take
from vectorplot.geometry.regions import corners_of, polygons_of, triangles_of, unions
from vectorplot.geometry.vectors import cross
from vectorplot.shading.palettes import PALETTE_LIMITS

# Twelve-bit numbers in bytes, eight of them in a block of twelve.

LARGEST_12_BIT = 4095
"""The largest number that twelve bits hold."""

BLOCK = 8
"""Numbers of one block, which are twelve bytes."""


def packed(numbers: ArrayLike) -> bytes:
    """Numbers (n,) from 0 to 4095 as twelve bits each, most significant bit first: twelve bytes for eight numbers, the
    last block padded with zeros; the same on every machine.
    Source: Glaeser, section 10.1, figure 1; errata G10-01 to G10-03, G10-11; decision D-8. Errors: InputError for
    numbers out of range.
    """
    values = np.asarray(numbers, dtype=np.int64)
    if len(values) and not (values.min() >= 0 and values.max() <= LARGEST_12_BIT):
        raise InputError(f"a number of twelve bits is one from 0 to {LARGEST_12_BIT}")
    filled = np.zeros(-(-len(values) // BLOCK) * BLOCK, dtype=np.int64)
    filled[: len(values)] = values
    one, other = filled[::2], filled[1::2]
    triples = np.stack([one >> 4, (one & 15) << 4 | other >> 8, other & 255], axis=1)
    return triples.astype(np.uint8).tobytes()


def unpacked(content: bytes) -> Ints:
    """The numbers of twelve bits that bytes hold.

    result: (n,) eight for each block, with the zeros that fill the last one.
    Source: Glaeser, section 10.1; erratum G10-02.
    """
    if len(content) % 12:
        raise InputError(f"{len(content)} bytes: expected blocks of 12")
    triples = np.frombuffer(content, dtype=np.uint8).reshape(-1, 3).astype(np.intp)
    first, middle, last = triples.T
    return np.stack([first << 4 | middle >> 4, (middle & 15) << 8 | last], axis=1).ravel()


# The value Movie: frames as polygons in the colours of palettes.

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

    index: 0 to 253; lower, upper: (int, int, int) red, green and blue of the darkest and of the brightest shade, 0 to
    255.
    Source: Glaeser, sections 4.3 and 10.1.
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

    points: (p, 2) 0 to 4095, y upwards; offsets: (m+1,) polygon k has the corners offsets[k] to offsets[k+1], 2 to 253;
    palette: (m,) the index of the palette of each; shades: (p,) 0 to 255 for every corner.
    Source: Glaeser, section 10.1; errata G10-04, G10-06.
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

    def take(self, which: Ints | NDArray[np.bool_]) -> MovieFrame:
        """The polygons with these numbers, or those where a mask is true.

        which: (k,) numbers from 0, or a mask (m,).
        """
        return take(self, which)


@dataclass(frozen=True)
class Movie:
    """A movie: palettes, and frames.

    palettes: each index once; frames: none is a frozen frame: the one before it, once more; smooth: whether files have
    a shade for every corner.
    Source: Glaeser, chapter 10.
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


# A drawing as polygons and lines of a movie: clipped, on its grid of 4096, each corner in its colour.

TINY = 4.0
"""Polygons of no more than so many units of the grid in area are left out."""

PAPER = 255.0
"""White, which shines through what is transparent."""


@dataclass(frozen=True, eq=False)
class ColouredPolygons:
    """Polygons (three corners and more) and lines (two): points (p,2), offsets (m+1,), colours (p,3), item (m,) numbers
    of items or NO_ITEM."""

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    colours: Floats = field(metadata=EACH_POINT)
    item: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.offsets) - 1


def coloured_polygons(drawing: Drawing) -> ColouredPolygons:
    """The polygons and lines of a drawing in drawing order, on the grid; the paper before them where the first polygon
    is not the whole page.

    What is transparent is mixed with white. Texts are left out. Polygons of more corners than a movie has are cut to
    triangles, of one colour each.
    """
    window = Window(0.0, drawing.width_mm, 0.0, drawing.height_mm)
    scale = LARGEST_12_BIT / max(drawing.width_mm, drawing.height_mm)
    parts = []
    for layer in drawing.layers:
        colour = np.array([int(layer.pen.colour[i : i + 2], 16) for i in (1, 3, 5)], dtype=np.float64)
        for mark in layer.marks:
            if isinstance(mark, Fills):
                parts += _filled(mark, window)
            elif isinstance(mark, Paths | CurvedStrokes):
                parts.append(_stroked(mark, colour, window, 1.0 / scale))
    white = Fills.whole_page(drawing.width_mm, drawing.height_mm, np.full(3, 255, dtype=np.uint8))
    (paper,) = _filled(white, window)
    found = _on_grid(joined([*parts, paper]) if parts else paper, scale)
    sheet, rest = take(found, np.array([len(found) - 1])), take(found, np.arange(len(found) - 1))
    rest = take(rest, _areas(rest) > TINY)
    if len(rest) and _corners(rest) == _corners(sheet):
        return rest
    return joined([sheet, rest])


def _corners(polygons: ColouredPolygons) -> set[tuple[float, float]]:
    """The corners of the first polygon."""
    return {(x, y) for x, y in polygons.points[: polygons.offsets[1]].tolist()}


def _on_grid(polygons: ColouredPolygons, scale: float) -> ColouredPolygons:
    return replace(polygons, points=np.clip(np.rint(polygons.points * scale), 0.0, LARGEST_12_BIT))


def _areas(polygons: ColouredPolygons) -> Floats:
    """(m,) the areas of polygons; of lines without end."""
    first, sizes = polygons.offsets[:-1], np.diff(polygons.offsets)
    if not len(sizes):
        return np.zeros(0)
    arm = polygons.points - np.repeat(polygons.points[first], sizes, axis=0)
    after = arm[ragged.following(polygons.offsets)]
    area = np.abs(np.add.reduceat(cross(arm, after), first)) / 2.0
    return np.where(sizes == 2, np.inf, area)


def _filled(fills: Fills, window: Window) -> list[ColouredPolygons]:
    """Filled polygons, and lines among them, as far as they lie on the page, in their order."""
    sizes = np.diff(fills.offsets)
    share = np.repeat(fills.opacity, sizes)[:, None]
    colours = share * fills.colours + (1.0 - share) * PAPER
    table = np.column_stack([fills.points, colours])
    of = np.flatnonzero(sizes >= 3)
    at, offsets = ragged.take(fills.offsets, of)
    inside = clip_polygons_2d(Polygons(table[at], offsets), window)
    faces = ColouredPolygons(inside.points[:, :2], inside.offsets, inside.points[:, 2:], fills.item[of])
    left = np.flatnonzero(np.diff(inside.offsets) > 0)
    faces, owner = _few_corners(take(faces, left), of[left])
    pairs = np.flatnonzero(sizes == 2)
    lines, line = _clipped(table[fills.offsets[pairs]], table[fills.offsets[pairs] + 1], fills.item[pairs], window)
    found = joined([faces, lines])
    return [take(found, np.argsort(np.concatenate([owner, pairs[line]]), kind="stable"))]


def _few_corners(faces: ColouredPolygons, owner: Ints) -> tuple[ColouredPolygons, Ints]:
    """Triangles in place of polygons with too many corners, and the owner of each; owner (m,): of the polygons."""
    many = np.diff(faces.offsets) > MOST_CORNERS
    if not many.any():
        return faces, owner
    large, small = take(faces, many), take(faces, ~many)
    triangles, of = triangles_of(polygons_of(large.points.T, large.offsets))
    points, offsets = corners_of(triangles)
    colours = np.repeat(large.colours[large.offsets[:-1]][of], np.diff(offsets), axis=0)
    cut = ColouredPolygons(points.T, offsets, colours, large.item[of])
    return joined([small, cut]), np.concatenate([owner[~many], owner[many][of]])


def _stroked(mark: Paths | CurvedStrokes, colour: Floats, window: Window, tolerance: float) -> ColouredPolygons:
    """The segments of strokes, those of curves within the tolerance, as far as they lie on the page."""
    if isinstance(mark, Paths):
        lines, item = Polylines(mark.points, mark.offsets, mark.closed), mark.item
    else:
        straight = np.flatnonzero(np.diff(mark.beziers.offsets) == 0)
        plain = chosen(mark.paths, straight)
        points, offsets = mark.beziers.flattened(tolerance)
        curved = np.flatnonzero(np.diff(mark.beziers.offsets) > 0)
        at, ends = ragged.take(offsets, curved)
        bent = Polylines(points[at], ends, np.zeros(len(curved), dtype=np.bool_))
        lines = joined([Polylines(plain.points, plain.offsets, plain.closed), bent])
        item = mark.paths.item[np.concatenate([straight, curved])]
    pairs = segments(lines)
    table = np.column_stack([lines.points, np.broadcast_to(colour, (len(lines.points), 3))])
    owner = ragged.owner(np.diff(lines.offsets))
    return _clipped(table[pairs[:, 0]], table[pairs[:, 1]], item[owner[pairs[:, 0]]], window)[0]


def _clipped(start: Floats, end: Floats, item: Ints, window: Window) -> tuple[ColouredPolygons, Ints]:
    """Lines between rows x, y, red, green and blue, each in the mean of its colours, and which ones are left."""
    found = clip_lines_2d(start, end, window)
    left = np.flatnonzero(found.exists)
    ends = np.stack([found.start[left], found.end[left]], axis=1)
    colours = np.repeat(ends[:, :, 2:].mean(axis=1), 2, axis=0)
    offsets = np.arange(0, 2 * len(left) + 1, 2)
    return ColouredPolygons(ends[:, :, :2].reshape(-1, 2), offsets, colours, item[left]), left


# A movie as two files: bytes in the one, twelve-bit numbers in the other.

IDENTITY = 255
"""The first number of either file."""

NEW_FRAME, END = 254, 255
"""Where a frame begins, and where the movie ends."""

NEW, FROZEN = 1, 0
"""Whether a frame differs from the one before it."""


def encoded(movie: Movie) -> tuple[bytes, bytes]:
    """The contents of the two files of a movie.

    Source: Glaeser, section 10.1; errata G10-03, G10-05, G10-10; decision D-8.
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


# Polygons that nobody sees in the end: left out of a movie.

INSIDE = 8.0
"""What is left out lies inside what covers it by so many units of the grid: so that no pixel of a picture of a thousand
pixels a side shows both, be it blended."""


def pruned(frame: MovieFrame, item: Ints) -> Bools:
    """(m,) the polygons of a frame that are needed; item (m,): negative for none. Not needed is a polygon inside a
    later one, inside the outline of an item painted wholly later, or inside an earlier one of its palette and shade,
    unless something between reaches it. Lines, the paper, and polygons that cross themselves stay.
    Source: Glaeser, section 10.1 (necessary_to_plot); errata G10-07, G10-08.
    """
    import shapely

    needed = np.ones(len(frame), dtype=np.bool_)
    sizes = frame.sizes
    faces = np.flatnonzero(sizes > 2)
    if len(faces) < 2:
        return needed
    whole = frame.take(faces)
    shapes = polygons_of(whole.points.T.astype(np.float64), whole.offsets)
    sound = shapely.is_valid(shapes)
    faces, shapes = faces[sound], shapes[sound]
    inner = shapely.buffer(shapes, -INSIDE, join_style="mitre")
    tree = shapely.STRtree(inner)
    within, around = tree.query(shapes, predicate="covered_by")
    needed[faces[within[around > within]]] = False
    needed[faces[_behind_items(shapes, item[faces])]] = False
    earlier = around < within
    needed[faces[_repeated(frame, faces, shapes, within[earlier], around[earlier])]] = False
    needed[0] = True
    return needed


def _behind_items(shapes: Any, item: Ints) -> Ints:
    """The polygons inside the outline of an item that is painted after them; item (n,): of each polygon."""
    import shapely

    owned = np.flatnonzero(item >= 0)
    if not len(owned):
        return owned
    _, first, group = np.unique(item[owned], return_index=True, return_inverse=True)
    outlines = shapely.buffer(unions(shapes[owned], group, None), -INSIDE, join_style="mitre")
    within, around = shapely.STRtree(outlines).query(shapes, predicate="covered_by")
    return np.unique(within[owned[first][around] > within])


def _repeated(frame: MovieFrame, faces: Ints, shapes: Any, within: Ints, around: Ints) -> Ints:
    """Of pairs of polygons, of which the one is within the other, which is painted before it: those within in the same
    colour, that nothing else comes between."""
    import shapely

    first, last = frame.offsets[:-1], frame.offsets[1:]
    low, high = np.minimum.reduceat(frame.shades, first), np.maximum.reduceat(frame.shades, first)
    flat = low == high
    one, other = faces[within], faces[around]
    alike = flat[one] & flat[other] & (low[one] == low[other]) & (frame.palette[one] == frame.palette[other])
    within, one, other = within[alike], one[alike], other[alike]
    if not len(within):
        return within
    asked, place = np.unique(within, return_inverse=True)
    every = shapely.convex_hull(
        shapely.multipoints(frame.points.astype(np.float64), indices=np.repeat(np.arange(len(frame)), last - first))
    )
    near, reached = shapely.STRtree(every).query(shapes[asked], predicate="dwithin", distance=INSIDE)
    mine = faces[asked[near]]
    different = ~flat[reached] | (low[reached] != low[mine]) | (frame.palette[reached] != frame.palette[mine])
    before = different & (reached < mine)
    latest = np.full(len(asked), -1, dtype=np.intp)
    np.maximum.at(latest, near[before], reached[before])
    return np.unique(within[other > latest[place]])


# The two files of a movie, read back: whatever they hold, within bounds and with one line for what is wrong.

LARGEST_FILE_BYTES = 256 << 20
"""The largest file of a movie that is read."""


def read_movie(path: str | os.PathLike[str]) -> Movie:
    """The movie in two files."""
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

    Source: Glaeser, section 10.2.
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


# Drawings recorded as a movie: palettes for their colours, frozen frames, covered polygons left out.

OFF_BY = 1.5
"""A colour that is off a palette by more, in red, green or blue of 255, gets one of its own."""


def movie_of(drawings: Iterable[Drawing]) -> Movie:
    """The movie that drawings make.

    Source: Glaeser, section 10.1; errata G10-04 to G10-08.
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
        frame = frame.take(pruned(frame, found.item))
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


# What a movie shows: its frames as drawings.

LINE = Pen(0.3)
"""What lines are drawn with: a movie does not say it."""


def frame_drawings(movie: Movie, width_mm: float = 160.0) -> Iterator[Drawing]:
    """The frames of a movie as drawings.

    Source: Glaeser, section 10.2; erratum G10-09.
    """
    first = next((frame for frame in movie.frames if frame is not None), None)
    right, top = _sheet(first)
    scale = width_mm / right
    page = (float(width_mm), top * scale)
    shown = Drawing(*page, (Layer("polygons", LINE, (Fills.empty(),)),))
    for frame in movie.frames:
        if frame is not None:
            corners = np.asarray(frame.points * scale, dtype=np.float64)
            fills = Fills.flat(corners, frame.offsets, np.zeros((len(frame), 3), dtype=np.uint8))
            painted = replace(fills, colours=corner_colours(movie, frame))
            shown = Drawing(*page, (Layer("polygons", LINE, (painted,)),))
        yield shown


def _sheet(frame: MovieFrame | None) -> tuple[float, float]:
    """Width and height of the page in units of the grid."""
    whole = (float(LARGEST_12_BIT), float(LARGEST_12_BIT))
    if frame is None or not len(frame):
        return whole
    corners = frame.points[: frame.offsets[1]]
    x, y = corners.max(axis=0).tolist()
    rectangle = {(a, b) for a, b in corners.tolist()} == {(0, 0), (x, 0), (x, y), (0, y)} and min(x, y) > 0
    return (float(x), float(y)) if rectangle and max(x, y) == LARGEST_12_BIT else whole
