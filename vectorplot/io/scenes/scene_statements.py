"""What a scene file says about the scene as a whole: camera, lights, page, labels, cuts, colours by numbers, a box."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import VIEWS, Camera
from vectorplot.io.scenes.scene_words import Words
from vectorplot.scene.cuts.cut import AWAY, Cut
from vectorplot.scene.depth_cue import CUES, DepthCue
from vectorplot.scene.light import Exposure, Light, check_exposure
from vectorplot.scene.naming.labels import (
    HIDDEN,
    MARKS,
    PLACES,
    Along,
    AtVertex,
    Label,
    OnCurve,
    OnPage,
    capital_height,
)
from vectorplot.scene.naming.scales import BoxAxes, Colouring
from vectorplot.scene.pages.fitted_pages import fitted_page, page_of_width
from vectorplot.scene.pages.page import Page
from vectorplot.scene.pages.paper import FIT, length_mm, sheet_size
from vectorplot.words import COLOURS, is_colour, nearest

_CAMERA_POINTS = ("eye", "target", "up")
_CAMERA_NUMBERS = {"twist": "twist_deg", "field_of_vision": "fov_deg", "height": "height", "near": "near", "far": "far"}
_CAMERA_WORDS = (*_CAMERA_POINTS, *_CAMERA_NUMBERS, "parallel", "view")


def read_camera(words: Words, at: int) -> tuple[Camera, int]:
    """The camera that the words from ``camera`` on describe, and the word behind them."""
    start = at
    at += 1
    given: dict[str, Any] = {}
    view: str | None = None
    if words.words[at] in VIEWS:
        view, at = words.words[at], at + 1
    while (word := words.words[at]) in _CAMERA_WORDS:
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
    _check_spelling(words, start, at, _CAMERA_WORDS)
    if "eye" not in given and view is None:
        words.fail(at, f"camera: expected 'eye' (words: {', '.join(_CAMERA_WORDS)}), got {words.shown(at)}")
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
        first, wide = words.words[at + 1].lower(), None
        # The margin may come yet: it is checked with the size.
        size = (Page().width_mm, Page().height_mm) if first in (FIT, "width") else sheet_size(first)
        if first == "width":
            wide = length_mm(words.words[at + 2])
        at += 1 if first == FIT else 3 if first == "width" else 2
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
        if wide is not None:
            if fitted:
                words.fail(start, "page: a width and fit exclude each other")
            return page_of_width(page, wide), at
        return (fitted_page(page) if fitted else page), at
    except InputError as error:
        if error.file is not None:
            raise
        words.fail(start, error.cause)


Anchor = tuple[float, float, float] | AtVertex | OnCurve | Along | OnPage
"""What a label may name."""

_LABEL_CHOICES = {"place": PLACES, "hidden": HIDDEN, "mark": MARKS}
_LABEL_ANCHORS = ("at", "vertex", "on", "along", "page")
_LABEL_WORDS = (*_LABEL_ANCHORS, "size", *_LABEL_CHOICES)


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


def read_colouring(words: Words, at: int) -> tuple[Colouring, int]:
    """The colours that the words from ``colour_by`` on describe, and the word behind them."""
    start, owner = at, "colour_by: "
    if words.words[at + 1] in ("", ",") or words.is_number(at + 1):
        words.fail(at + 1, f"{owner}expected a word or a formula, got {words.shown(at + 1)}")
    by, at = words.string(at + 1), at + 2
    colour_map, steps, label = "viridis", 24, None
    while (word := words.words[at]) in ("map", "steps", "called"):
        if word == "steps":
            steps = words.whole(at + 1, owner, word)
        elif words.words[at + 1] in ("", ","):
            words.fail(at + 1, f"{owner}expected what '{word}' is, got {words.shown(at + 1)}")
        elif word == "map":
            colour_map = words.string(at + 1)
        elif words.words[at + 1].startswith('"'):
            label = words.string(at + 1)
        else:
            words.fail(at + 1, f"{owner}expected a text in quotes, got {words.shown(at + 1)}")
        at += 2
    try:
        return Colouring(by, colour_map, steps, label), at
    except InputError as error:
        words.fail(start, error.cause)


def read_box_axes(words: Words, at: int) -> tuple[BoxAxes, int]:
    """The box that the words from ``box_axes`` on describe, and the word behind them."""
    names, size, after = ("x", "y", "z"), 3.5, at + 1
    while (word := words.words[after]) in ("names", "size"):
        if word == "size":
            size, after = words.number(after + 1, "box_axes: ", word), after + 2
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
