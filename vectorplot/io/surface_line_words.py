"""The lines that a scene file asks for on a smooth surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from vectorplot.errors import InputError
from vectorplot.io.scene_words import Words
from vectorplot.scene.surface_lines import (
    MAX_LINES,
    NO_LINES,
    ON_MESHES,
    ON_SURFACES,
    FieldContours,
    Roads,
    Section,
    Serpentine,
    SurfaceLines,
    TerrainLines,
    Vector,
    WaterCourses,
    Watersheds,
    even_cosines,
    path_on_surface,
)

AXES: dict[str, Vector] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}

ROADS, SIZES = ("road", "serpentine"), ("slope", "radius", "width")

POLYHEDRON_WORDS = ("vertices", "revolution", "base_points", "box", "intersection")
"""Words that only polyhedra have."""


@dataclass(frozen=True)
class Planes:
    """Parallel planes as the file asks for them: so many, evenly spread over the item, or at given distances; slices:
    whether they cut it into slices; every: which of them are index lines, 0 for none; numbered: whether these, or else
    all, have their numbers on them."""

    normal: Vector
    count: int
    offsets: tuple[float, ...]
    slices: bool = False
    every: int = 0
    numbered: bool = False


@dataclass(frozen=True)
class CurveDraft:
    """What has been read about the lines of an item so far. index: the first word about them; lit_index: the one that
    names the light of the isophotes; 0: there is none. section_count: the sections of all planes together."""

    index: int = 0
    lines: SurfaceLines = NO_LINES
    planes: tuple[Planes, ...] = ()
    section_count: int = 0
    lit_index: int = 0

    def __bool__(self) -> bool:
        return self.index > 0


def read_parameter_lines(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """Columns u = const. and rows v = const."""
    columns = words.whole(at + 1, owner, "the columns of parameter_lines")
    rows = words.whole(at + 2, owner, "the rows of parameter_lines")
    try:
        return _with_lines(draft, at, replace(draft.lines, columns=columns, rows=rows)), at + 3
    except InputError as error:
        words.fail(at, owner + error.cause)


def read_contours(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """The name of a field, and a number of its contours or their values."""
    start = at
    if words.words[at + 1] in ("", ",") or words.is_number(at + 1):
        words.fail(at + 1, f"{owner}contours: expected the name of a field, got {words.shown(at + 1)}")
    name = words.string(at + 1)
    count, values, at = _count_or_list(words, at + 2, owner, "contours")
    try:
        asked = FieldContours(name, count or values)
    except InputError as error:
        words.fail(start, owner + error.cause)
    return _with_lines(draft, start, replace(draft.lines, contours=(*draft.lines.contours, asked))), at


def read_isophotes(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """A number of isophotes, or their cosines, and the light they are of."""
    start = at
    count, cosines, at = _count_or_list(words, at + 1, owner, "isophotes")
    try:
        lines = replace(draft.lines, isophotes=even_cosines(count) if count else cosines)
    except InputError as error:
        words.fail(start, owner + error.cause)
    draft = _with_lines(draft, start, lines)
    if words.words[at] == "lit_by":
        if words.words[at + 1] in ("", ","):
            words.fail(at + 1, f"{owner}expected the name or the number of a light, got {words.shown(at + 1)}")
        draft = replace(draft, lit_index=at + 1)
        at += 2
    return draft, at


def read_sections(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """An axis or a normal, and a number of sections or the distances of their planes from the origin."""
    normal, after = _direction(words, at, owner)
    planes, after = _with_index(words, *_planes(words, at, after, owner, normal), owner)
    return _with_planes(words, at, owner, draft, planes), after


def read_slices(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """An axis or a normal, and a number of slices or the distances from the origin of the planes between them."""
    normal, after = _direction(words, at, owner)
    planes, end = _planes(words, at, after, owner, normal)
    if any(other.slices for other in draft.planes):
        words.fail(at, f"{owner}slices: an item is cut into slices in one direction only")
    if planes.count == 1:
        words.fail(after, f"{owner}slices: 1 of them, expected 2 to {MAX_LINES}")
    planes = replace(planes, count=max(planes.count - 1, 0), slices=True)
    return _with_planes(words, at, owner, draft, planes), end


def read_level_lines(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """A number of horizontal sections, or their heights."""
    planes, after = _with_index(words, *_planes(words, at, at + 1, owner, AXES["z"]), owner)
    return _with_planes(words, at, owner, draft, planes), after


def read_surface_curve(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """Two formulas in t, u and v of a curve on the surface, and the range of t."""
    from vectorplot.io.shape_arguments import read_formulas, read_numbers

    start = at
    formulas, at = read_formulas(2, "t")(words, at + 1, owner, "surface_curve")
    if words.words[at] != "t":
        words.fail(at, f"{owner}surface_curve: expected 't' and its range, got {words.shown(at)}")
    (first, last), at = read_numbers(2)(words, at + 1, owner, "t of surface_curve")
    try:
        path = path_on_surface(formulas, first, last)
        return _with_lines(draft, start, replace(draft.lines, paths=(*draft.lines.paths, path))), at
    except InputError as error:
        words.fail(start, f"{owner}surface_curve: {error.cause}")


def read_trim(words: Words, at: int, owner: str) -> tuple[Any, int]:
    """A closed curve in u and v that trims a surface: two formulas in t and its range, or the corners of a polygon."""
    from vectorplot.io.expressions import parse_expression
    from vectorplot.io.shape_arguments import Formulas, formula_curve, read_formulas, read_numbers

    what, start = words.words[at], at + 1
    formulas, after = read_formulas(2, "t")(words, start, owner, what)
    if words.words[after] == "t":
        (first, last), after = read_numbers(2)(words, after + 1, owner, f"t of {what}")
        plane = Formulas((*formulas.expressions, parse_expression("0", ("t",))))
        try:
            return formula_curve(plane, first, last, closed=False), after
        except InputError as error:
            words.fail(start - 1, f"{owner}{what}: {error.cause}")
    if words.words[after] != ",":
        words.fail(after, f"{owner}{what}: expected 't' and its range, or ',' and corners, got {words.shown(after)}")
    corners, at = list[tuple[float, ...]](), start
    while not corners or words.words[at] == ",":
        corner, at = read_numbers(2)(words, at + bool(corners), owner, f"u and v of a corner of {what}")
        corners.append(corner)
    return corners, at


def read_integral_lines(
    words: Words, at: int, owner: str, draft: CurveDraft, kind: str | None
) -> tuple[CurveDraft, int]:
    """Integral curves: of a field of directions, or geodesics; kind: of the item, where that was said already."""
    from vectorplot.io.integral_line_words import read_integral

    smooth = (kind or _kind_ahead(words, at)) in ("surface", "curve")
    lines, after = read_integral(words, at, owner, draft.lines.integral, ON_SURFACES if smooth else ON_MESHES)
    return _with_lines(draft, at, replace(draft.lines, integral=lines)), after


def _kind_ahead(words: Words, at: int) -> str:
    """The first word behind a place that says what kind of item this is, "" where there is none."""
    telling = {"surface", "curve", *POLYHEDRON_WORDS}
    return next((word for word in words.words[at:] if word in telling), "")


def read_terrain_lines(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """Lines of a terrain: water from places, watersheds, valley lines, roads between two places, with bends or
    without."""
    start, word = at, words.words[at]
    at += 1
    if word not in ("water", *ROADS):
        return _with_terrain(draft, start, Watersheds(valleys=word == "valley_lines")), at
    places: list[tuple[float, float]] = []
    while not places or words.words[at] == "," or (word in ROADS and len(places) == 1):
        at += words.words[at] == ","
        (x, y), at = words.numbers(at, 2, owner, f"a place of {word}")
        places.append((x, y))
    if word in ROADS and len(places) != 2:
        words.fail(start, f"{owner}{word}: {len(places)} places, expected 2")
    sizes: dict[str, float] = {}
    while word == "serpentine" and words.words[at] in SIZES:
        sizes[words.words[at]] = words.number(at + 1, owner, words.words[at])
        at += 2
    if word == "serpentine" and "slope" not in sizes:
        words.fail(start, f"{owner}serpentine: expected 'slope' and an angle in degrees behind its places")
    try:
        if word == "serpentine":
            slope = sizes.pop("slope")
            return _with_terrain(draft, start, Serpentine(places[0], places[1], slope, **sizes)), at
        return _with_terrain(draft, start, Roads(*places) if word == "road" else WaterCourses(tuple(places))), at
    except InputError as error:
        words.fail(start, owner + error.cause)


def _with_terrain(draft: CurveDraft, at: int, lines: TerrainLines) -> CurveDraft:
    return _with_lines(draft, at, replace(draft.lines, terrain=(*draft.lines.terrain, lines)))


def read_smooth_lines(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """Lines of a polyhedron as smooth curves."""
    return _with_lines(draft, at, replace(draft.lines, smooth=True)), at + 1


def read_smooth_contours(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """Contours across the faces of a polyhedron."""
    return _with_lines(draft, at, replace(draft.lines, smooth_contours=True)), at + 1


def read_detail(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """How much there is of feature lines."""
    value = words.number(at + 1, owner, "detail")
    try:
        return _with_lines(draft, at, replace(draft.lines, detail=value)), at + 2
    except InputError as error:
        words.fail(at, owner + error.cause)


def read_isophote_edges(words: Words, at: int, owner: str, draft: CurveDraft) -> tuple[CurveDraft, int]:
    """Isophotes of a polyhedron along its edges."""
    return _with_lines(draft, at, replace(draft.lines, along_edges=True)), at + 1


def _direction(words: Words, at: int, owner: str) -> tuple[Vector, int]:
    """An axis, or a normal of any length."""
    what, word = words.words[at], words.words[at + 1]
    if word in AXES:
        return AXES[word], at + 2
    if word != "normal":
        words.fail(at + 1, f"{owner}{what}: expected x, y, z or 'normal', got {words.shown(at + 1)}")
    (x, y, z), at = words.numbers(at + 2, 3, owner, f"the normal of {what}")
    return (x, y, z), at


def _planes(words: Words, start: int, at: int, owner: str, normal: Vector) -> tuple[Planes, int]:
    """How many planes, or where."""
    count, offsets, at = _count_or_list(words, at, owner, words.words[start])
    try:
        return Planes(Section(normal, offsets).normal, count, offsets), at
    except InputError as error:
        words.fail(start, owner + error.cause)


def _with_index(words: Words, planes: Planes, at: int, owner: str) -> tuple[Planes, int]:
    """The planes with every k-th of them an index line, where 'index' stands behind them, and numbered where that word
    does."""
    if words.words[at] == "index":
        every = words.whole(at + 1, owner, "index")
        if every < 1:
            words.fail(at + 1, f"{owner}index: every {every}, expected 1 or more")
        planes, at = replace(planes, every=every), at + 2
    return (replace(planes, numbered=True), at + 1) if words.words[at] == "numbered" else (planes, at)


def _with_planes(words: Words, start: int, owner: str, draft: CurveDraft, planes: Planes) -> CurveDraft:
    total = draft.section_count + max(planes.count, len(planes.offsets))
    if total > MAX_LINES:
        words.fail(start, f"{owner}sections: {total} of them, expected at most {MAX_LINES}")
    return _with_lines(replace(draft, planes=(*draft.planes, planes), section_count=total), start, draft.lines)


def _count_or_list(words: Words, at: int, owner: str, what: str) -> tuple[int, tuple[float, ...], int]:
    """A whole number from 1 to MAX_LINES, or 'at' and numbers with commas between them."""
    if words.words[at] != "at":
        count = words.whole(at, owner, f"{what} ('at' begins a list)")
        if not 1 <= count <= MAX_LINES:
            words.fail(at, f"{owner}{what}: {count} of them, expected 1 to {MAX_LINES}")
        return count, (), at + 1
    values: list[float] = []
    at += 1
    while not values or words.words[at] == ",":
        at += bool(values)
        values.append(words.number(at, owner, what))
        at += 1
    return 0, tuple(values), at


def _with_lines(draft: CurveDraft, at: int, lines: SurfaceLines) -> CurveDraft:
    return replace(draft, index=draft.index or at, lines=lines)
