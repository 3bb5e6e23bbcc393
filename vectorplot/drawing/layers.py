"""Strokes sorted into layers with one pen each, pens over painted faces, and the paper under the lines."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.pens import (
    BLACK,
    FRAME_PEN,
    KIND_LAYER,
    PENS,
    PenRule,
    Pens,
    RulesByTarget,
    Style,
    check_targets,
    frame_pen,
    ink,
    pen_of,
    pen_rules,
    rules_by_target,
    scaled_pen,
    style_of_scene,
)
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.errors import InputError
from vectorplot.geometry.polylines import split
from vectorplot.scene.page import Page
from vectorplot.scene.pens import PenOverrides
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import FLAT_OF_EXTENT
from vectorplot.words import LIGHT_KINDS, LineKind, check_word, unknown

MIDDLE_TONE = 128.0
"""Darker sheets have white letters."""


def letter_pen(layers: Sequence[Layer]) -> Pen:
    """The pen of letters on some layers: black, or white on a sheet that is dark, as behind wireframes."""
    sheet = layers[0].fills if layers and layers[0].name == "background" else ()
    dark = any(len(fills) and fills.colours[0].mean() < MIDDLE_TONE for fills in sheet)
    return Pen(PENS["label"].width_mm, "#ffffff") if dark else PENS["label"]


def layers_by_kind(paths: Paths) -> tuple[Layer, ...]:
    """Layers visible, contour, intersection, hidden, pattern, isophote, section and curve, without the
    empty ones at the end: so each kind keeps its number from drawing to drawing. Lines at which the light of a second
    lamp ends, or of further ones, come last, with its number in their names."""
    names = tuple(PENS)
    of_kind = np.array([names.index(KIND_LAYER[kind]) for kind in LineKind])
    which = np.where(paths.hidden_by > 0, names.index("hidden"), of_kind[paths.kind] + len(names) * paths.lamp)
    lamps = 1 + int(paths.lamp.max(initial=0))
    more = [(f"{kind.word} {lamp + 1}", PENS[kind.word], True) for lamp in range(1, lamps) for kind in LIGHT_KINDS]
    ends = np.array([names.index(kind.word) for kind in LIGHT_KINDS])
    further = np.flatnonzero(which >= len(names))
    lamp, kind_layer = np.divmod(which[further], len(names))
    which[further] = len(names) + (lamp - 1) * len(ends) + np.searchsorted(ends, kind_layer)
    named = [*((name, PENS[name], True) for name in names), *more]
    return layers_of(paths, which, named)


def layers_by_object(paths: Paths, items: Sequence[str]) -> tuple[Layer, ...]:
    """A layer for every item in the order of the scene, and one for hidden lines, without the empty ones at the end."""
    which = np.where(paths.hidden_by > 0, len(items), paths.item)
    pens = [(name, PENS["visible"], True) for name in items]
    return layers_of(paths, which, [*pens, ("hidden", PENS["hidden"], True)])


def layers_by_colour(paths: Paths, colours: Sequence[str], shown_item: Ints) -> tuple[Layer, ...]:
    """A layer for every colour of items, drawn in its ink, and one for hidden lines.

    colours: the colour of every item; shown_item (m,): the one whose colour each stroke has.
    """
    names = list(dict.fromkeys(colours))
    of_item = np.array([names.index(colour) for colour in colours], dtype=np.intp)
    which = np.where(paths.hidden_by > 0, len(names), of_item[shown_item])
    pens = [(name, Pen(PENS["visible"].width_mm, ink(name)), True) for name in names]
    return layers_of(paths, which, [*pens, ("hidden", PENS["hidden"], True)])


def shown_items(scene: Scene, strokes: Paths, eye: Floats) -> Ints:
    """(m,) the item whose colour each stroke has: the look of the face that it lies on, if that has one of its own.

    eye: see FaceLooks.seen_at. Error: a stroke is looked up in the middle of its first segment.
    """
    found = strokes.item.copy()
    distance = FLAT_OF_EXTENT * float(np.ptp(scene.bounds, axis=0).max())
    for number, item in enumerate(scene.items):
        looks, own = item.face_looks, np.flatnonzero(strokes.item == number)
        if looks is None or looks.first < 0 or not len(own):
            continue
        first, last = strokes.offsets[own], strokes.offsets[own + 1] - 1
        middle = 0.5 * (strokes.points3d[first] + strokes.points3d[np.minimum(first + 1, last)])
        look = looks.seen_at(item.mesh, middle, eye, distance)
        found[own] = np.where(look >= 0, looks.first + look, number)
    return found


def layers_of(paths: Paths, which: Ints, named: Sequence[tuple[str, Pen, bool]]) -> tuple[Layer, ...]:
    """The named layers, each with its pen and whether it is plotted, without the empty ones at the end; which (m,): the
    layer of every stroke."""
    order = np.argsort(which, kind="stable")
    bounds = np.searchsorted(which[order], np.arange(len(named) + 1))
    parts = zip(named, split(chosen(paths, order), bounds), bounds.tolist(), strict=False)
    return tuple(Layer(name, pen, (part,), plotted) for (name, pen, plotted), part, low in parts if low < len(order))


# Strokes sorted into layers, each drawn with one pen.

_HATCH = KIND_LAYER[LineKind.HATCH]

CUT_HATCH = "cut hatch"
"""The layer of hatches of cuts where other faces are hatched too."""

LAYER_WORDS = ("kind", "object", "colour", "pen")
"""What strokes that share a layer may have in common."""


def layer_words(layers: str) -> tuple[str, ...]:
    """What strokes of a layer have in common: one of LAYER_WORDS, or several with commas between them, each once.

    Errors: InputError for other words.
    """
    words = tuple(dict.fromkeys(word.strip() for word in layers.split(",")))
    for word in words:
        check_word("layers", word, LAYER_WORDS)
    return words


def words_of_pens(words: Sequence[str]) -> tuple[str, ...]:
    """By which words lines get their pens: all but pen, which gathers the layers afterwards; by kind, if no other."""
    return tuple(word for word in words if word != "pen") or ("kind",)


def layers_asked(layers: str | None, style: Style) -> str:
    """What shares a layer: what was asked for, else what the style says; of pen alone the pens of the style's layers.

    Errors: InputError as in layer_words.
    """
    if layers is None:
        return style.layers
    return f"{style.layers},pen" if layer_words(layers) == ("pen",) else layers


def line_list(words: str | Iterable[str]) -> tuple[str, ...]:
    """The words, or those of one text with commas between them."""
    given = words.split(",") if isinstance(words, str) else words
    return tuple(word.strip() for word in given if word.strip())


def sorted_layers(
    paths: Paths,
    items: Sequence[str],
    colours: Sequence[str],
    layers: str = "kind",
    rules: Sequence[PenRule] = (),
    hatches: Sequence[Layer] = (),
    shown_item: Ints | None = None,
) -> tuple[Layer, ...]:
    """The layers of strokes, hidden ones on their own. items, colours: of every item; layers: see layer_words; hatches:
    layers of hatching, last, or among the kinds; shown_item (m,): whose colour each stroke has, None for its own. A
    layer whose strokes get different pens by the rules is divided, see in_pens; by pen: see one_for_each_pen, which
    comes when all have theirs.
    Errors: InputError for rules for items that do not exist.
    """
    check_targets(rules, items)
    words = words_of_pens(layer_words(layers))
    shown_item = paths.item if shown_item is None else shown_item
    if words == ("kind",):
        return in_pens(_by_kind(paths, hatches), items, rules)
    if words == ("object",):
        found = layers_by_object(paths, items)
    elif words == ("colour",):
        found = layers_by_colour(paths, colours, shown_item)
    else:
        found = _by_several(paths, items, colours, words, shown_item)
    return in_pens((*found, *hatches), items, rules)


def _by_kind(paths: Paths, hatches: Sequence[Layer]) -> Sequence[Layer]:
    """Layers by kind. The first one that hatches has its number among them, whatever else is drawn."""
    if not hatches:
        return layers_by_kind(paths)
    found = layers_by_kind(concatenated((paths, *(strokes for layer in hatches for strokes in layer.strokes))))
    place = list(PENS).index(_HATCH)
    own = [one for one in layers_by_kind(paths) if one.name == _HATCH and len(one.strokes[0])]
    cuts = [replace(one, name=CUT_HATCH) for one in own]
    return (*found[:place], hatches[0], *found[place + 1 :], *hatches[1:], *cuts)


def not_plotted(layers: Sequence[Layer], unplotted: Sequence[str], others: Sequence[str]) -> tuple[Layer, ...]:
    """The layers, those of these names there to be looked at only, with all their steps of depth.

    others: names that layers may have where there are such lines, beside kinds. Errors: InputError for a name that no
    layer has or may have.
    """
    known = (*(layer.name for layer in layers), *PENS, "frame", "background", *others)
    for name in unplotted:
        if name not in known:
            raise unknown("unplotted", name, tuple(dict.fromkeys(known)))
    return looked_at_only(layers, unplotted)


def looked_at_only(layers: Sequence[Layer], unplotted: Sequence[str]) -> tuple[Layer, ...]:
    """The layers, of which those of these names, with all their steps of depth, are not plotted."""
    named = {layer.name for layer in layers if layer.name.rpartition(" depth ")[0] in unplotted}.union(unplotted)
    return tuple(replace(layer, plotted=False) if layer.name in named else layer for layer in layers)


def _by_several(
    paths: Paths, items: Sequence[str], colours: Sequence[str], words: Sequence[str], shown_item: Ints
) -> tuple[Layer, ...]:
    """A layer for everything that strokes have in common, in the order of the words, and one for hidden strokes."""
    hues = list(dict.fromkeys(colours))
    kinds = list(PENS)
    of_item = np.array([hues.index(colour) for colour in colours], dtype=np.intp)
    of_kind = np.array([kinds.index(KIND_LAYER[kind]) for kind in LineKind])
    named = {"kind": kinds, "object": list(items), "colour": hues}
    numbers = {"kind": of_kind[paths.kind], "object": paths.item, "colour": of_item[shown_item]}
    key = np.zeros(len(paths), dtype=np.intp)
    for word in words:
        key = key * len(named[word]) + numbers[word]
    shown = paths.hidden_by == 0
    used, which = np.unique(key[shown], return_inverse=True)
    layers = []
    for number in used.tolist():
        parts = {}
        for word in reversed(words):
            number, own = divmod(number, len(named[word]))
            parts[word] = named[word][own]
        width = PENS[parts.get("kind", "visible")].width_mm
        colour = ink(parts["colour"]) if "colour" in parts else BLACK
        layers.append((" ".join(parts[word] for word in words), Pen(width, colour), True))
    layer = np.full(len(paths), len(layers))
    layer[shown] = which
    return layers_of(paths, layer, [*layers, ("hidden", PENS["hidden"], True)])


def in_pens(layers: Sequence[Layer], items: Sequence[str], rules: Sequence[PenRule]) -> tuple[Layer, ...]:
    """The layers with the pens that rules give their strokes.

    A layer whose strokes have several pens becomes one for each of them: one keeps its name and its number, the others,
    with what their pens are added to it, come after all layers, in the order of their first strokes.
    """
    if not rules:
        return tuple(layers)
    said = rules_by_target(rules)
    parts = [_parted(layer, items, said) for layer in layers]
    return (*(own for own, _ in parts), *(one for _, others in parts for one in others))


def _parted(layer: Layer, items: Sequence[str], rules: RulesByTarget) -> tuple[Layer, list[Layer]]:
    """The layer, with the strokes of one pen, and those of the other pens of its strokes."""
    (paths,) = layer.strokes
    hidden = paths.hidden_by > 0
    several = max(len(items), 1) * 2
    key = (paths.kind * 2 + hidden) * several + paths.item
    used, first, which = np.unique(key, return_index=True, return_inverse=True)
    pens: dict[Pen, int] = {}
    number = np.zeros(len(used), dtype=np.intp)
    for k in np.argsort(first, kind="stable").tolist():
        at = first[k]
        pen = pen_of(rules, layer.pen, int(paths.kind[at]), bool(hidden[at]), items[paths.item[at]])
        number[k] = pens.setdefault(pen, len(pens))
    if len(pens) < 2:
        return replace(layer, pen=next(iter(pens), layer.pen)), []
    main = pens.get(layer.pen, 0)
    named = [(layer.name if k == main else f"{layer.name} {_told(pen)}", pen, True) for pen, k in pens.items()]
    found = list(layers_of(paths, number[which.ravel()], named))
    return found.pop(main), found


def _told(pen: Pen) -> str:
    dashed = " dashed" if pen.dash_mm else ""
    return f"{pen.width_mm:.3g} {pen.colour}{dashed}"


def one_for_each_pen(layers: Sequence[Layer]) -> tuple[Layer, ...]:
    """A layer for each pen, named after its width and colour, with all that it draws in these layers, texts behind the
    strokes; in the order in which pens are first needed.

    Edge cases: layers that are not plotted stay as they are, and so do filled polygons, in layers of their own; empty
    ones are left out; pens of other dashes are other pens, and those that agree in three digits of their widths one.
    """
    parts: dict[str, list[Layer]] = {}
    for number, layer in enumerate(layers):
        if not layer.plotted:
            parts[f"{number}"] = [layer]
            continue
        if layer.fills:
            parts[f"{number}"] = [replace(layer, marks=layer.fills)]
            layer = replace(layer, marks=(*layer.strokes, *layer.texts))
        if any(map(len, layer.marks)):
            parts.setdefault(_told(layer.pen) + str(layer.pen.dash_mm or ""), []).append(layer)
    return tuple(same[0] if same[0].fills or not same[0].plotted else _together(same) for same in parts.values())


def _together(layers: Sequence[Layer]) -> Layer:
    """One layer with the marks of all, which have strokes and texts of one pen."""
    strokes = concatenated(tuple(paths for layer in layers for paths in layer.strokes))
    texts = (text for layer in layers for text in layer.texts)
    return Layer(_told(layers[0].pen), layers[0].pen, (strokes, *texts))


# The pens of lines that lie over painted or shaded faces.


@dataclass(frozen=True)
class OverlaidPens:
    """Rules of pens, the last one that fits counts, and the colour of the paper that goes with them, if one does."""

    rules: tuple[PenRule, ...]
    background: str | None

    def layers(self, paths: Paths, items: Sequence[str], width: float | None = None, mm: float = 1.0) -> list[Layer]:
        """Strokes in layers by kind, with their pens.

        items: the name of every item; width: of all pens where no rule says otherwise, those of the kinds where None;
        mm: how long a millimetre is in units of the page, in which width is said. Rules for items that are not there
        have no effect.
        """
        found: Sequence[Layer] = layers_by_kind(paths)
        if width is not None:
            found = [replace(layer, pen=replace(layer.pen, width_mm=width / mm)) for layer in found]
        return [replace(layer, pen=scaled_pen(layer.pen, mm)) for layer in in_pens(found, items, self.rules)]

    def letters(self, pen: Pen) -> Pen:
        """The pen of letters, where rules say nothing the one given."""
        return pen_of(rules_by_target(self.rules), pen, int(LineKind.LABEL), False, "")

    def border(self, letters: Pen) -> Pen:
        """The pen of a frame and a title, where that of letters is known."""
        return frame_pen(self.rules, replace(FRAME_PEN, colour=letters.colour))


def overlaid_pens(
    inks: PenOverrides | None,
    style: Style | str | None,
    pens: Pens | None,
    dashes: str | Mapping[str, str] | Iterable[str] | None,
) -> OverlaidPens:
    """The pens that a scene asks for and those that are asked for beside it, which come first.

    A scene's own wireframe has nothing to say where faces are filled.
    Errors: InputError for unknown styles, what is no pen or dash, and a wireframe that is asked for.
    """
    asked = pen_rules(pens, dashes)
    chosen, own = style_of_scene(inks, style)
    if chosen.look != "plain":
        if style is not None:
            raise InputError(f"the style {chosen.look} shows lines alone: it is for draw")
        return OverlaidPens(asked, None)
    return OverlaidPens((*chosen.rules, *own, *asked), chosen.background)


# The paper under the lines, and what pens are on a larger one.


def sheet_layer(colour: str, page: Page) -> Layer:
    """A layer, not to be plotted, that is the whole sheet in a colour: of a palette its brightest shade."""
    from vectorplot.shading.palettes import palette

    sheet = Fills.whole_page(page.width_mm, page.height_mm, palette(colour)[-1])
    return Layer("background", Pen(), (sheet,), plotted=False)


def pen_scale(page: Page) -> float:
    """How many times larger than A4 a page is, in length."""
    a4 = Page()
    return math.hypot(page.width_mm, page.height_mm) / math.hypot(a4.width_mm, a4.height_mm)
