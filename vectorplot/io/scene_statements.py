"""What a scene file says about the scene as a whole: camera, lights, page, labels, annotations, cuts, style, pens."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from json import dumps
from typing import Any, Literal, NoReturn

from vectorplot.errors import InputError
from vectorplot.geometry.camera import VIEWS, Camera
from vectorplot.io.named_files import NamedFiles
from vectorplot.io.scene_words import SCENE_WORDS, Words
from vectorplot.scene.annotations import (
    angle,
    arrow,
    axes,
    baseline_dimension,
    centre_line,
    centre_mark,
    chain_dimension,
    chamfer,
    diameter,
    dimension,
    leader,
    ordinate_dimension,
    radius,
    thread,
    threaded_hole,
)
from vectorplot.scene.colour_scales import BoxAxes, Colouring, ScaleBar
from vectorplot.scene.cuts import AWAY, AXES, Cut, Explosion
from vectorplot.scene.labels import (
    DEFAULT_SIZE_MM,
    HIDDEN,
    MARKS,
    PLACES,
    Along,
    AtVertex,
    Label,
    Measures,
    OnCurve,
    OnPage,
    capital_height,
)
from vectorplot.scene.light import Exposure, Light, check_exposure
from vectorplot.scene.page import FIT, LENGTH, SCALE, Page, SheetSettings, length_mm, scale_ratio, sheet_size
from vectorplot.scene.pens import CUES, FINEST_MM, LONGEST_MM, PEN_KINDS, WIDEST_MM, DepthCue, PenOverrides
from vectorplot.scene.placement import fitted_page, page_at_scale, page_of_width
from vectorplot.scene.scene import Scene
from vectorplot.words import COLOURS, STYLE_WORDS, is_colour, nearest

# What a scene file says about the scene as a whole: camera, lights, page, labels, cuts, colours by numbers, a box.

_CAMERA_POINTS = ("eye", "target", "up")
_CAMERA_NUMBERS = {"twist": "twist_deg", "field_of_vision": "fov_deg", "height": "height", "near": "near", "far": "far"}
CAMERA_WORDS = (*_CAMERA_POINTS, *_CAMERA_NUMBERS, "parallel", "view")


def read_camera(words: Words, at: int) -> tuple[Camera, int]:
    """The camera that the words from ``camera`` on describe, and the word behind them."""
    start = at
    at += 1
    given: dict[str, Any] = {}
    view: str | None = None
    if words.words[at] in VIEWS:
        view, at = words.words[at], at + 1
    while (word := words.words[at]) in CAMERA_WORDS:
        if word in _CAMERA_POINTS:
            point, at = words.numbers(at + 1, 3, "camera: ", word)
            given[word] = tuple(point)
        elif word in _CAMERA_NUMBERS:
            given[_CAMERA_NUMBERS[word]] = words.number(at + 1, "camera: ", word)
            at += 2
        elif word == "parallel":
            given["parallel"] = True
            at += 1
        elif view is not None:
            words.fail(at, "camera: a second view")
        else:
            view = words.words[at + 1]
            if view not in VIEWS:
                words.fail(at + 1, f"camera: expected a view ({', '.join(VIEWS)}), got {words.shown(at + 1)}")
            at += 2
    _check_spelling(words, start, at, CAMERA_WORDS)
    if "eye" not in given and view is None:
        words.fail(at, f"camera: expected 'eye' (words: {', '.join(CAMERA_WORDS)}), got {words.shown(at)}")
    if "eye" in given and view is not None:
        words.fail(start, "camera: 'eye' and 'view' exclude each other")
    try:
        if view is None:
            return Camera(**given), at
        upright = {name: given.pop(name) for name in ("target", "up") if name in given}
        main = Camera.view(view, **upright)
        return replace(main, **given), at
    except InputError as error:
        words.fail(start, error.cause)


_LIGHT_WORDS = ("position", "direction", "intensity", "colour", "fading")


def read_light(words: Words, at: int) -> tuple[Light, int]:
    """The light that the words from ``light`` on describe, and the word behind them."""
    start = at
    at += 1
    name, owner = "", "light: "
    if words.words[at] not in (*_LIGHT_WORDS, ""):
        name = words.string(at)
        owner = f"light {name}: "
        at += 1
    place: tuple[float, float, float] | None = None
    parallel = False
    intensity: float | None = None
    colour, fading = "white", False
    while (word := words.words[at]) in _LIGHT_WORDS:
        if word == "colour":
            colour, at = _known_colour(words, at + 1, owner)
            continue
        if word == "fading":
            fading, at = True, at + 1
            continue
        if word == "intensity":
            intensity = words.number(at + 1, owner, word)
            if not 0.0 <= intensity <= 1.0:
                words.fail(at + 1, f"{owner}intensity {intensity:g} must lie between 0 and 1")
            at += 2
            continue
        if place is not None:
            words.fail(at, f"{owner}a second '{word}'")
        (x, y, z), at = words.numbers(at + 1, 3, owner, word)
        place, parallel = (x, y, z), word == "direction"
        if parallel and not any(place):
            words.fail(start, f"{owner}the direction is zero")
    _check_spelling(words, start, at, _LIGHT_WORDS)
    if place is None:
        words.fail(at, f"{owner}expected 'position' or 'direction', got {words.shown(at)}")
    if fading and parallel:
        words.fail(start, f"{owner}parallel light does not fade")
    return Light(place, parallel, intensity, name, colour, fading), at


def _known_colour(words: Words, at: int, owner: str) -> tuple[str, int]:
    """The colour at a word, a known one or one in quotes, and the word behind it."""
    word = words.string(at)
    if not is_colour(word):
        near = nearest(word.lower(), COLOURS)
        words.fail(at, f"{owner}expected a colour{f' (did you mean {near!r}?)' if near else ''}, got {words.shown(at)}")
    return word, at + 1


_PAGE_WORDS = ("landscape", "portrait", "margin", FIT)


def read_page(words: Words, at: int) -> tuple[Page, int]:
    """The page that the words from ``page`` on describe, and the word behind them."""
    start = at
    if not words.words[at + 1]:
        words.fail(at + 1, "page: expected a size, got the end of the file")
    try:
        first, wide, ratio = words.words[at + 1].lower(), None, ""
        # The margin may come yet: it is checked with the size.
        size = (Page().width_mm, Page().height_mm) if first in (FIT, SCALE, "width") else sheet_size(first)
        if first == "width":
            wide = length_mm(words.words[at + 2])
        if first == SCALE:
            ratio = words.words[at + 2]
            scale_ratio(ratio)
        at += 1 if first == FIT else 3 if first in ("width", SCALE) else 2
        margin: float | None = None
        way, fitted = "", False
        while (word := words.words[at]) in _PAGE_WORDS:
            way = word if word in ("landscape", "portrait") else way
            fitted |= word == FIT
            at += 1
            if word == "margin":
                margin = words.number(at, "page: ", word)
                at += 1
        _check_spelling(words, start, at, _PAGE_WORDS)
        page = Page(*size) if margin is None else Page(*size, margin)
        page = page.landscape if way == "landscape" else page.portrait if way == "portrait" else page
        if fitted and (wide is not None or ratio):
            words.fail(start, f"page: a {first} and fit exclude each other")
        if wide is not None:
            return page_of_width(page, wide), at
        if ratio:
            return page_at_scale(page, ratio), at
        return (fitted_page(page) if fitted else page), at
    except InputError as error:
        if error.file is not None:
            raise
        words.fail(start, error.cause)


Anchor = tuple[float, float, float] | AtVertex | OnCurve | Along | OnPage
"""What a label may name."""

_LABEL_CHOICES = {"place": PLACES, "hidden": HIDDEN, "mark": MARKS}
_LABEL_ANCHORS = ("at", "vertex", "on", "along", "page")
_LABEL_WORDS = (*_LABEL_ANCHORS, "size", "measured", *_LABEL_CHOICES)


def read_label(words: Words, at: int) -> tuple[Label, int]:
    """The label that the words from ``label`` on describe, and the word behind them; items are known by their names."""
    start = at
    at += 1
    name = ""
    if not words.words[at].startswith('"') or words.words[at + 1].startswith('"'):
        name = words.string(at) if words.words[at] else ""
        at += 1
    if not words.words[at].startswith('"'):
        words.fail(at, f"label {name}: expected a text in quotes, got {words.shown(at)}")
    text = words.string(at)
    owner = f"label {name or text}: "
    at += 1
    anchor: Anchor | None = None
    given: dict[str, Any] = {}
    while (word := words.words[at]) in _LABEL_WORDS:
        at += 1
        if word in _LABEL_ANCHORS:
            if anchor is not None:
                words.fail(at - 1, f"{owner}a second place, {words.shown(at - 1)}")
            anchor, at = _label_anchor(words, at, owner, word)
        elif word == "size":
            try:
                given["size_mm"] = capital_height(words.string(at))
            except InputError as error:
                words.fail(at, owner + error.cause)
            at += 1
        elif word == "measured":
            given[word], at = words.string(at), at + 1
        else:
            if words.words[at] not in _LABEL_CHOICES[word]:
                known = ", ".join(_LABEL_CHOICES[word])
                words.fail(at, f"{owner}{word}: expected one of {known}, got {words.shown(at)}")
            given[word] = words.words[at]
            at += 1
    _check_spelling(words, start, at, _LABEL_WORDS)
    if anchor is None:
        words.fail(at, f"{owner}expected {', '.join(_LABEL_ANCHORS)}, got {words.shown(at)}")
    try:
        return Label(text, anchor, name, **given), at
    except InputError as error:
        words.fail(start, error.cause)


_MEASURE_FLAGS = ("zeros", "comma")


def read_measures(words: Words, at: int) -> tuple[Measures, int]:
    """How the words from ``measures`` on write measures, and the word behind them."""
    start, at, given = at, at + 1, dict[str, Any]()
    while (word := words.words[at]) in (*_MEASURE_FLAGS, "decimals"):
        if word in given:
            words.fail(at, f"measures: a second '{word}'")
        given[word] = words.whole(at + 1, "measures: ", word) if word == "decimals" else True
        at += 2 if word == "decimals" else 1
    _check_spelling(words, start, at, ("decimals", *_MEASURE_FLAGS))
    if not given:
        words.fail(at, f"measures: expected decimals, zeros or comma, got {words.shown(at)}")
    try:
        return Measures(**given), at
    except InputError as error:
        words.fail(start, error.cause)


SHEET_FLAGS = ("dimensions", "centre_lines", "frame", "balloons", "parts_list", "no_block")
"""What a sheet has."""

SHEET_TEXTS = ("section", "uncut", "detail_view", "breakout", "interrupted")
"""What it may have several of, each a text in quotes."""

_SHEET_LINES = ("author", "date")
_SHEET_CHOICES = {
    "standard": ("iso", "asme"),
    "projection": ("first", "third"),
    "unit": ("mm", "cm", "m", "in"),
    "measured_in": ("mm", "cm", "m", "in"),
    "hidden": ("none", "dashed", "solid"),
}
_SHEET_PAIRS = {"field": "fields", "made_of": "made_of"}
_SHEET_OTHERS = ("views", "scale", "page", *_SHEET_PAIRS, "block_template")
_SHEET_WORDS = (*SHEET_FLAGS, *SHEET_TEXTS, *_SHEET_LINES, *_SHEET_CHOICES, *_SHEET_OTHERS)


def read_sheet(words: Words, at: int, files: NamedFiles | None) -> tuple[SheetSettings, int]:
    """What the words from ``sheet`` on say about the technical sheet of a scene, and the word behind them."""
    start, owner = at, "sheet: "
    at += 1
    given: dict[str, Any] = {}
    while (word := words.words[at]) in _SHEET_WORDS:
        at += 1
        if word in given or (word == "no_block" and "block" in given):
            if word not in (*SHEET_TEXTS, *_SHEET_PAIRS):
                words.fail(at - 1, f"{owner}a second '{word}'")
        if word in SHEET_FLAGS:
            given["block" if word == "no_block" else word] = word != "no_block"
        elif word in SHEET_TEXTS:
            given[word], at = (*given.get(word, ()), _sheet_text(words, at, word)), at + 1
        elif word in _SHEET_LINES:
            given[word], at = _sheet_text(words, at, word), at + 1
        elif word in _SHEET_CHOICES:
            given[word], at = _one_of(words, at, owner + word, _SHEET_CHOICES[word]), at + 1
        elif word in _SHEET_PAIRS:
            key, pair = _SHEET_PAIRS[word], (_sheet_text(words, at, word), _sheet_text(words, at + 1, word))
            given[key], at = (*given.get(key, ()), pair), at + 2
        elif word == "block_template":
            if files is None:
                words.fail(at, f"{owner}a text without a file names no files")
            given[word], at = str(files.named(words, at, f"{owner}{word}: ", (STYLE_FILE,))), at + 1
        elif word == "views":
            views = [_one_of(words, at, f"{owner}{word}", tuple(VIEWS))]
            while words.words[at + 1] == ",":
                at += 2
                views.append(_one_of(words, at, f"{owner}{word}", tuple(VIEWS)))
            given[word], at = tuple(views), at + 1
        else:
            given[word], at = _sheet_size(words, at, word)
    _check_spelling(words, start, at, _SHEET_WORDS)
    if not given:
        words.fail(at, f"{owner}expected one of {', '.join(_SHEET_WORDS)}, got {words.shown(at)}")
    return SheetSettings(**given), at


def _sheet_text(words: Words, at: int, what: str) -> str:
    if not words.words[at].startswith('"'):
        words.fail(at, f"sheet: {what}: expected a text in quotes, got {words.shown(at)}")
    return words.string(at)


def _one_of(words: Words, at: int, what: str, known: tuple[str, ...]) -> str:
    if words.words[at] not in known:
        words.fail(at, f"{what}: expected one of {', '.join(known)}, got {words.shown(at)}")
    return words.words[at]


def _sheet_size(words: Words, at: int, word: str) -> tuple[str, int]:
    """The scale or the page of a sheet, and the word behind it."""
    said = words.words[at]
    try:
        if word == "scale":
            if said != "fit":
                scale_ratio(said)
            return said, at + 1
        sheet_size(said)
    except InputError as error:
        words.fail(at, f"sheet: {error.cause}")
    if words.words[at + 1] in ("landscape", "portrait"):
        return f"{said} {words.words[at + 1]}", at + 2
    return said, at + 1


def sheet_text(sheet: SheetSettings) -> str:
    """The statement that says it, as read_sheet reads it."""
    parts = []
    for name, value in sheet.said.items():
        if name in SHEET_TEXTS:
            parts += [f"{name} {dumps(text)}" for text in value]
        elif name in _SHEET_PAIRS.values():
            word = next(word for word, key in _SHEET_PAIRS.items() if key == name)
            parts += [f"{word} {dumps(one)} {dumps(text)}" for one, text in value]
        elif name == "views":
            parts.append(f"views {', '.join(value)}")
        elif name == "block":
            parts += [] if value else ["no_block"]
        elif isinstance(value, bool):
            parts += [name] if value else []
        else:
            parts.append(f"{name} {value if name in ('scale', 'page', *_SHEET_CHOICES) else dumps(value)}")
    return f"sheet {' '.join(parts)}" if parts else ""


_CUT_NUMBERS = {"spacing": "spacing_mm", "angle": "angle_deg"}
_CUT_WORDS = (*AWAY, "colour", "of", *_CUT_NUMBERS)


def read_cut(words: Words, at: int) -> tuple[Cut, int]:
    """The cut that the words from ``cut`` on describe, and the word behind them."""
    start = at
    at += 1
    if not words.words[at].startswith('"'):
        words.fail(at, f'cut: expected conditions in quotes, such as "y = 0", got {words.shown(at)}')
    text = words.string(at)
    at += 1
    away, colour, items = "gone", None, None
    hatch: dict[str, float] = {}
    while (word := words.words[at]) in _CUT_WORDS:
        if word == "colour":
            colour, at = _known_colour(words, at + 1, "cut: ")
        elif word in _CUT_NUMBERS:
            hatch[_CUT_NUMBERS[word]], at = words.number(at + 1, "cut: ", word), at + 2
        elif word == "of":
            items, at = _names_of_cut(words, at + 1)
        else:
            away, at = word, at + 1
    _check_spelling(words, start, at, _CUT_WORDS)
    try:
        return replace(Cut.of(text, away, colour, **hatch), items=items), at
    except InputError as error:
        words.fail(start, error.cause)


def _names_of_cut(words: Words, at: int) -> tuple[tuple[str, ...], int]:
    """The names, in quotes, of the items that a cut is for, and the word behind them."""
    first = at
    while words.words[at].startswith('"'):
        at += 1
    if at == first:
        words.fail(at, f"cut: expected names of items in quotes behind 'of', got {words.shown(at)}")
    return tuple(words.string(k) for k in range(first, at)), at


def _label_anchor(words: Words, at: int, owner: str, word: str) -> tuple[Anchor, int]:
    """What a label names, and the word behind it."""
    if word == "at":
        (x, y, z), at = words.numbers(at, 3, owner, word)
        return (x, y, z), at
    if word == "page":
        (x, y), at = words.numbers(at, 2, owner, word)
        return OnPage(x, y), at
    item = words.string(at)
    if item in ("", ","):
        words.fail(at, f"{owner}expected the name of an item, got {words.shown(at)}")
    if word == "vertex":
        number = words.whole(at + 1, owner, word)
        if number < 1:
            words.fail(at + 1, f"{owner}vertices count from 1, got {number}")
        return AtVertex(item, number - 1), at + 2
    kind = Along if word == "along" else OnCurve
    if not words.is_number(at + 1):
        return kind(item), at + 1
    part = words.number(at + 1, owner, word)
    if not 0.0 <= part <= 1.0:
        words.fail(at + 1, f"{owner}a part of {part:g} of a curve must lie between 0 and 1")
    return kind(item, part), at + 2


def _check_spelling(words: Words, start: int, at: int, known: tuple[str, ...]) -> None:
    """An error where the word behind a statement seems to be one of its known words."""
    meant = words.misspelled(start, at, known)
    if meant is not None:
        words.fail(at, f"{words.words[start]}: unknown word {words.shown(at)} (did you mean '{meant}'?)")


COLOUR_BY_WORDS = (
    *("map", "steps", "called", "low", "high", "classes", "logarithmic", "under", "over", "unlit", "size"),
)
"""What may stand behind what colours are by."""


def read_colouring(words: Words, at: int) -> tuple[Colouring, int]:
    """The colours that the words from ``colour_by`` on describe, and the word behind them."""
    start, owner = at, "colour_by: "
    if words.words[at + 1] in ("", ",") or words.is_number(at + 1):
        words.fail(at + 1, f"{owner}expected a word or a formula, got {words.shown(at + 1)}")
    by, at = words.string(at + 1), at + 2
    given: dict[str, Any] = {}
    while (word := words.words[at]) in COLOUR_BY_WORDS:
        if word in ("logarithmic", "unlit"):
            given["logarithmic" if word == "logarithmic" else "is_lit"] = word == "logarithmic"
            at += 1
            continue
        if word == "classes":
            limits, at = [words.number(at + 1, owner, word)], at + 2
            while words.words[at] == ",":
                limits.append(words.number(at + 1, owner, word))
                at += 2
            given["at"] = tuple(limits)
            continue
        if word == "steps":
            given["steps"] = words.whole(at + 1, owner, word)
        elif word in ("low", "high"):
            given[word] = words.number(at + 1, owner, word)
        elif word in ("under", "over"):
            given[word], _ = _known_colour(words, at + 1, f"{owner}{word}: ")
        elif word == "size":
            given["size_mm"] = words.string(at + 1)
        elif words.words[at + 1] in ("", ","):
            words.fail(at + 1, f"{owner}expected what '{word}' is, got {words.shown(at + 1)}")
        elif word == "map":
            given["colour_map"] = words.string(at + 1)
        elif words.words[at + 1].startswith('"'):
            given["label"] = words.string(at + 1)
        else:
            words.fail(at + 1, f"{owner}expected a text in quotes, got {words.shown(at + 1)}")
        at += 2
    try:
        return Colouring(by, **given), at
    except InputError as error:
        words.fail(start, error.cause)


def read_scale_bar(words: Words, at: int) -> tuple[ScaleBar, int]:
    """The bar that the words from ``scale_bar`` on describe, and the word behind them."""
    start, at = at, at + 1
    given: dict[str, Any] = {}
    if words.words[at].startswith('"'):
        given["unit"], at = words.string(at), at + 1
    while (word := words.words[at]) in ("length", "size"):
        if word == "length":
            given["length"] = words.number(at + 1, "scale_bar: ", word)
        else:
            given["size_mm"] = words.string(at + 1)
        at += 2
    _check_spelling(words, start, at, ("length", "size"))
    try:
        return ScaleBar(**given), at
    except InputError as error:
        words.fail(start, error.cause)


def read_box_axes(words: Words, at: int) -> tuple[BoxAxes, int]:
    """The box that the words from ``box_axes`` on describe, and the word behind them."""
    size: float | str = DEFAULT_SIZE_MM
    names, after = ("x", "y", "z"), at + 1
    while (word := words.words[after]) in ("names", "size"):
        if word == "size":
            size, after = words.string(after + 1), after + 2
            continue
        for place in range(after + 1, after + 4):
            if not words.words[place].startswith('"'):
                words.fail(place, f"box_axes: expected three names in quotes, got {words.shown(place)}")
        names, after = (words.string(after + 1), words.string(after + 2), words.string(after + 3)), after + 4
    try:
        return BoxAxes(names, size), after
    except InputError as error:
        words.fail(at, error.cause)


def read_depth_cue(words: Words, at: int) -> tuple[DepthCue, int]:
    """The depth cue that the words from ``depth_cue`` on describe, and the word behind them."""
    after = at + 1
    while words.words[after] in CUES:
        after += 1
    by = tuple(dict.fromkeys(words.words[at + 1 : after]))
    if not by:
        words.fail(after, f"depth_cue: expected {' or '.join(map(repr, CUES))}, got {words.shown(after)}")
    if not words.is_number(after):
        return DepthCue(by), after
    steps = words.whole(after, "", "depth_cue")
    try:
        return DepthCue(by, steps), after + 1
    except InputError as error:
        words.fail(after, error.cause)


def read_exposure(words: Words, at: int) -> tuple[Exposure, int]:
    """The exposure that the words from ``exposure`` on describe, and the word behind them."""
    fitted = words.words[at + 1] == "fitted"
    if not fitted and not words.is_number(at + 1):
        words.fail(at + 1, f"exposure: expected 'fitted' or a factor, got {words.shown(at + 1)}")
    exposure: Exposure = "fitted" if fitted else words.number(at + 1, "", "exposure")
    try:
        check_exposure(exposure)
    except InputError as error:
        words.fail(at + 1, error.cause)
    return exposure, at + 2


# Axes, arrows, dimensions, angles, radii, leaders and centre lines in a scene file.


@dataclass(frozen=True)
class _Field:
    """What stands behind a word: three numbers, points with commas between them, one number, three strings or a size;
    key: the keyword it becomes."""

    kind: Literal["point", "points", "number", "names", "size"]
    key: str
    needed: bool = True


@dataclass(frozen=True)
class _Annotation:
    """A statement: its fields by their words, whether it has a text, and what makes it."""

    make: Callable[..., Scene]
    fields: Mapping[str, _Field]
    text: Literal["none", "may", "must"] = "may"


def _point(key: str, needed: bool = True) -> _Field:
    return _Field("point", key, needed)


_SIZE = {"size": _Field("size", "size_mm", False)}
_LINES = {"gap": _Field("number", "gap", False), "beyond": _Field("number", "beyond", False), **_SIZE}
_ROW = {"at": _Field("points", "points"), "offset": _point("offset"), **_LINES}
_THREAD = {"from": _point("start"), "to": _point("end"), "radius": _Field("number", "radius")}
_ROUND = {"at": _point("centre"), "to": _point("point"), **_SIZE}

ANNOTATIONS: Mapping[str, _Annotation] = {
    "axes": _Annotation(
        axes,
        {
            "origin": _point("origin", False),
            "names": _Field("names", "names", False),
            "ticks": _Field("number", "ticks", False),
            **_SIZE,
        },
        "none",
    ),
    "arrow": _Annotation(arrow, {"from": _point("start"), "to": _point("end"), **_SIZE}),
    "dimension": _Annotation(
        dimension,
        {
            "from": _point("start"),
            "to": _point("end"),
            "offset": _point("offset"),
            **_LINES,
        },
    ),
    "chain_dimension": _Annotation(chain_dimension, _ROW, "none"),
    "baseline_dimension": _Annotation(baseline_dimension, {**_ROW, "step": _Field("number", "step", False)}, "none"),
    "ordinate_dimension": _Annotation(ordinate_dimension, {**_ROW, "apart": _Field("number", "apart", False)}, "none"),
    "chamfer": _Annotation(chamfer, {"from": _point("start"), "to": _point("end"), "at": _point("elbow"), **_SIZE}),
    "thread": _Annotation(thread, _THREAD, "none"),
    "threaded_hole": _Annotation(threaded_hole, _THREAD, "none"),
    "radius": _Annotation(radius, _ROUND),
    "diameter": _Annotation(diameter, _ROUND),
    "angle": _Annotation(
        angle,
        {
            "at": _point("vertex"),
            "from": _point("one"),
            "to": _point("other"),
            "radius": _Field("number", "radius"),
            **_SIZE,
        },
    ),
    "leader": _Annotation(leader, {"at": _point("point"), "to": _point("elbow"), **_SIZE}, "must"),
    "centre_line": _Annotation(centre_line, {"from": _point("start"), "to": _point("end")}, "none"),
    "centre_mark": _Annotation(
        centre_mark,
        {"at": _point("centre"), "radius": _Field("number", "radius"), "axis": _point("axis", False)},
        "none",
    ),
}
"""The statements by their words."""

FIELD_WORDS = tuple(dict.fromkeys(word for statement in ANNOTATIONS.values() for word in statement.fields))
"""The words that may stand in them."""


def read_annotation(words: Words, at: int) -> tuple[Scene, int]:
    """The lines and labels that the words from one of ANNOTATIONS on describe, and the word behind them."""
    start, what = at, words.words[at]
    statement, owner = ANNOTATIONS[what], f"{what}: "
    given: dict[str, Any] = {}
    at += 1
    if statement.text != "none" and words.words[at].startswith('"'):
        given["text"] = words.string(at)
        at += 1
    elif statement.text == "must":
        words.fail(at, f"{owner}expected a text in quotes, got {words.shown(at)}")
    if what == "axes":
        given["length"], at = _lengths(words, at, owner)
    while (field := statement.fields.get(words.words[at])) is not None:
        word = words.words[at]
        if field.key in given:
            words.fail(at, f"{owner}a second '{word}'")
        given[field.key], at = _value(words, at + 1, owner, word, field)
    meant = words.misspelled(start, at, tuple(statement.fields))
    if meant is not None:
        words.fail(at, f"{owner}unknown word {words.shown(at)} (did you mean '{meant}'?)")
    missing = [word for word, field in statement.fields.items() if field.needed and field.key not in given]
    if missing:
        words.fail(at, f"{owner}expected '{missing[0]}', got {words.shown(at)}")
    try:
        return statement.make(**given), at
    except InputError as error:
        words.fail(start, error.cause if error.cause.startswith(what) else owner + error.cause)


def begins_annotation(words: Words, at: int) -> bool:
    """Whether a word that may also be one of a surface begins a statement: a text or a place comes next."""
    if words.words[at] not in ANNOTATIONS:
        return False
    first = at + 2 if words.words[at + 1].startswith('"') else at + 1
    return words.words[first] in FIELD_WORDS


def _lengths(words: Words, at: int, owner: str) -> tuple[tuple[float, ...], int]:
    """One length for all axes, or three."""
    one = words.number(at, owner, "lengths")
    if words.words[at + 1] != "," and not words.is_number(at + 1):
        return (one,) * 3, at + 1
    (x, y, z), at = words.numbers(at, 3, owner, "lengths")
    return (x, y, z), at


def _value(words: Words, at: int, owner: str, word: str, field: _Field) -> tuple[Any, int]:
    """What stands behind a word, and the word behind it."""
    if field.kind == "point":
        return words.numbers(at, 3, owner, word)
    if field.kind == "points":
        points = []
        while True:
            point, at = words.numbers(at, 3, owner, word)
            points.append(point)
            if words.words[at] != ",":
                return points, at
            at += 1
    if field.kind == "number":
        return words.number(at, owner, word), at + 1
    if field.kind == "size":
        try:
            return capital_height(words.string(at)), at + 1
        except InputError as error:
            words.fail(at, owner + error.cause)
    names = [words.string(at + number) for number in range(3)]
    return names, at + 3


# What a scene file says of how it is drawn: its style, pens and dashes; and how its parts are moved apart.

INK_WORDS = ("style", "pen", "dash")
"""The statements."""

STYLE_FILE = ".toml"
"""What the names of files with styles end in."""


def read_ink(words: Words, at: int, now: PenOverrides | None, files: NamedFiles | None) -> tuple[PenOverrides, int]:
    """The inks with what the words from style, pen or dash on say, and the word behind them."""
    inks = PenOverrides() if now is None else now
    word = words.words[at]
    if word == "style":
        if inks.style is not None:
            words.fail(at, "a second 'style'")
        style, at = _style(words, at + 1, files)
        return replace(inks, style=style), at
    start, (target, at) = at, _target(words, at + 1, word)
    own = inks.pens if word == "pen" else inks.dashes
    if target in own:
        words.fail(start, f"a second '{word}' for {target or 'all lines'}")
    said, at = (_pen if word == "pen" else _dash)(words, at)
    told = {**own, target: said}
    return replace(inks, pens=told) if word == "pen" else replace(inks, dashes=told), at


def pen_target(words: Words, at: int) -> str:
    """What the pen or the dash at a word is for; nothing for all lines, and for a style."""
    return "" if words.words[at] == "style" else _target(words, at + 1, words.words[at])[0]


def read_explosion(words: Words, at: int, now: Explosion | None) -> tuple[Explosion, int]:
    """How the words from ``explode`` on move parts apart, and the word behind them; now: what was said of it before."""
    start, axis = at, words.words[at + 1]
    moves = () if now is None else now.moves
    if axis.startswith('"'):
        name = words.string(at + 1)
        if now is not None and (not moves or name in dict(moves)):
            words.fail(at, f"a second 'explode'{f' of {name}' if moves else ''}")
        step, at = words.numbers(at + 2, 3, "explode: ", "the move")
        return Explosion(moves=(*moves, (name, (step[0], step[1], step[2])))), at
    if now is not None:
        words.fail(at, "a second 'explode'")
    way: str | tuple[float, float, float] = axis
    if words.is_number(at + 1):
        (x, y, z), at = words.numbers(at + 1, 3, "explode: ", "the axis")
        way = (x, y, z)
    elif axis in AXES:
        at += 2
    else:
        words.fail(at + 1, f"explode: expected x, y, z or a direction, got {words.shown(at + 1)}")
    try:
        if words.is_number(at):
            return Explosion(way, words.number(at, "explode: ", "the factor")), at + 1
        return Explosion(way), at
    except InputError as error:
        words.fail(start, error.cause)


def ink_texts(inks: PenOverrides) -> list[str]:
    """The statements that say it, as read_ink reads them."""
    found = [] if inks.style is None else [f"style {_quoted(inks.style, inks.style in STYLE_WORDS)}"]
    for target, said in inks.pens.items():
        width, colour = _halves(said)
        found.append(_statement("pen", target, width, colour and _quoted(colour, colour in COLOURS)))
    for target, said in inks.dashes.items():
        found.append(_statement("dash", target, *(part.replace(" ", "") for part in said.split(","))))
    return found


def _statement(word: str, target: str, *values: str) -> str:
    owner = target and _quoted(target, target in PEN_KINDS)
    return " ".join(part for part in (word, owner, *values) if part)


def _style(words: Words, at: int, files: NamedFiles | None) -> tuple[str, int]:
    """The name of a style, or the path of its file."""
    if words.words[at].startswith('"') and words.string(at).lower().endswith(STYLE_FILE):
        if files is None:
            words.fail(at, "style: a text without a file names no files")
        return str(files.named(words, at, "style: ", (STYLE_FILE,))), at + 1
    word = words.string(at)
    if word not in STYLE_WORDS:
        near = nearest(word.lower(), STYLE_WORDS) if word else None
        hint = f" (did you mean {near!r}?)" if near else ""
        known = f"one of {', '.join(STYLE_WORDS)}, or a file that ends in {STYLE_FILE}, in quotes"
        words.fail(at, f"style: expected {known}, got {words.shown(at)}{hint}")
    return word, at + 1


def _target(words: Words, at: int, owner: str) -> tuple[str, int]:
    """What a pen or a dash is for, nothing for all lines; and the word behind it."""
    said = _is_length(words, at) or (owner == "dash" and words.words[at] == "none")
    if said or (owner == "pen" and _is_colour(words, at) and not _is_length(words, at + 1)):
        return "", at
    if words.words[at] in ("", ",") or words.words[at] in SCENE_WORDS:
        _fail_value(words, at, owner)
    return words.string(at), at + 1


def _pen(words: Words, at: int) -> tuple[str, int]:
    """WIDTH, COLOUR or WIDTH:COLOUR of a pen, and the word behind it."""
    said, start = [], at
    if _is_length(words, at):
        _check_length(words, at, "pen")
        said.append(words.words[at])
        at += 1
    if _is_colour(words, at):
        said.append(words.string(at))
        at += 1
    elif at == start or words.words[at].startswith('"#') or words.misspelled(start, at, COLOURS):
        _fail_value(words, at, "pen")
    return ":".join(said), at


def _dash(words: Words, at: int) -> tuple[str, int]:
    """DASH,GAP or none, and the word behind it."""
    if words.words[at] == "none":
        return "none", at + 1
    _check_length(words, at, "dash")
    gap = at + 2 if words.words[at + 1] == "," else at + 1
    _check_length(words, gap, "dash")
    return f"{words.words[at]},{words.words[gap]}", gap + 1


def _is_length(words: Words, at: int) -> bool:
    return words.is_number(at) and LENGTH.fullmatch(words.words[at]) is not None


def _is_colour(words: Words, at: int) -> bool:
    word = words.words[at]
    return is_colour(words.string(at)) if word.startswith('"#') else word in COLOURS


def _check_length(words: Words, at: int, owner: str) -> None:
    if not _is_length(words, at):
        _fail_value(words, at, owner)
    try:
        length = length_mm(words.words[at])
    except InputError as error:
        words.fail(at, f"{owner}: {error.cause}")
    most = WIDEST_MM if owner == "pen" else LONGEST_MM
    if not FINEST_MM <= length <= most:
        words.fail(at, f"{owner}: expected {FINEST_MM:g} to {most:g} mm, got {words.shown(at)}")


def _fail_value(words: Words, at: int, owner: str) -> NoReturn:
    what = "a width in mm or a colour" if owner == "pen" else "DASH GAP in mm such as 3 1, or none"
    word = words.words[at].lower().strip('"')
    near = nearest(word, COLOURS) if owner == "pen" and word and not words.is_number(at) else None
    hint = f" (did you mean {near!r}?)" if near else ""
    words.fail(at, f"{owner}: expected {what}, got {words.shown(at)}{hint}")


def _halves(said: str) -> tuple[str, str]:
    """Width and colour of a pen, nothing for what is not said."""
    width, colon, colour = said.partition(":")
    if not colon and not LENGTH.fullmatch(width):
        width, colour = "", width
    return width.replace(" ", ""), colour.strip().lower()


def _quoted(text: str, bare: bool) -> str:
    return text if bare else dumps(text)
