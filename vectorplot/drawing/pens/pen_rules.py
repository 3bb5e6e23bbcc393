"""Which pen draws what: rules by kind of line, by item and by both, as people write them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from numbers import Real

from vectorplot.drawing.drawing import Pen
from vectorplot.drawing.layers import ink
from vectorplot.errors import InputError
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.pages.inks import FINEST_MM, FRAME, HIDDEN, LONGEST_MM, WIDEST_MM, target_of, unknown_item
from vectorplot.scene.pages.paper import LENGTH, length_mm
from vectorplot.words import COLOURS, LineKind, is_colour, nearest

_NEXT = re.compile(r",(?=[^,=]*=)")
"""The commas between rules, where a rule has commas of its own."""

USUAL_HATCHING_MM = (Hatching.width_mm, Stippling.width_mm)
"""The widths of the pens that hatch, or make dots, where nothing else is said."""


@dataclass(frozen=True)
class PenRule:
    """What some lines are drawn with, as far as it is said.

    kind: a word of PEN_KINDS, or None for all; item: the name of an item, or None for all; colour: #rrggbb; dash_mm:
    dash and gap, of length 0 for a line without.
    """

    kind: str | None = None
    item: str | None = None
    width_mm: float | None = None
    colour: str | None = None
    dash_mm: tuple[float, float] | None = None

    def applied(self, pen: Pen) -> Pen:
        """The pen with what the rule says."""
        width = pen.width_mm if self.width_mm is None else self.width_mm
        colour = pen.colour if self.colour is None else self.colour
        return Pen(width, colour, pen.dash_mm if self.dash_mm is None else self.dash_mm)


def scaled_pen(pen: Pen, factor: float) -> Pen:
    """The pen for a page that is so many times larger."""
    dash = None if pen.dash_mm is None else (factor * pen.dash_mm[0], factor * pen.dash_mm[1])
    return Pen(factor * pen.width_mm, pen.colour, dash)


RulesByTarget = Mapping[tuple[str | None, str | None], Sequence[PenRule]]
"""What is said of each kind and item."""

Pens = str | Pen | Mapping[str, "str | float | Pen"] | Iterable[str]
"""What pens may be said in: one text or several such as ``contour=0.5:black,house=red``, a mapping, or a single pen."""


def pen_rules(pens: Pens | None, dashes: str | Mapping[str, str] | Iterable[str] | None = None) -> tuple[PenRule, ...]:
    """The rules that pens and dashes say, in their order.

    Errors: InputError for what is no pen, or no dash.
    """
    rules = [_pen_rule(target, value) for target, value in _pen_pairs(pens)]
    return (*rules, *(_dash_rule(target, value) for target, value in _dash_pairs(dashes)))


def _pen_pairs(pens: Pens | None) -> list[tuple[str, str | float | Pen]]:
    if pens is None:
        return []
    if isinstance(pens, Pen):
        return [("", pens)]
    if isinstance(pens, Mapping):
        return list(pens.items())
    texts = [pens] if isinstance(pens, str) else list(pens)
    return [_halves(one) for text in texts for one in text.split(",")]


def _dash_pairs(dashes: str | Mapping[str, str] | Iterable[str] | None) -> list[tuple[str, str]]:
    if dashes is None:
        return []
    if isinstance(dashes, Mapping):
        return list(dashes.items())
    texts = [dashes] if isinstance(dashes, str) else list(dashes)
    return [_halves(one) for text in texts for one in _NEXT.split(text)]


def _halves(text: str) -> tuple[str, str]:
    """What a rule is for, and what it says; the former is nothing where there is no sign of equality."""
    target, equal, value = text.rpartition("=")
    if equal and not target.strip():
        raise InputError(f"pen {text!r}: expected a kind of line or an item before '='")
    return target.strip(), value.strip()


def _pen_rule(target: str, value: str | float | Pen) -> PenRule:
    kind, item = target_of(target)
    if isinstance(value, Pen):
        return PenRule(kind, item, value.width_mm, value.colour, value.dash_mm)
    if not isinstance(value, str):
        if not isinstance(value, Real) or isinstance(value, bool):
            raise InputError(f"pen {target}={value!r}: expected WIDTH, COLOUR or WIDTH:COLOUR, a number or a Pen")
        value = f"{float(value):.17g}"
    width, _, colour = value.partition(":")
    if not colour and not LENGTH.fullmatch(width):
        width, colour = "", width
    if not width.strip() and not colour.strip():
        raise InputError(f"pen {target}={value}: expected WIDTH, COLOUR or WIDTH:COLOUR")
    if not target and colour and width.strip() and not LENGTH.fullmatch(width):
        raise InputError(f"pen {value}: expected WIDTH, COLOUR, WIDTH:COLOUR, or KIND=WIDTH such as contour=0.5")
    found = _length(width, f"pen {target}={value}", WIDEST_MM) if width.strip() else None
    return PenRule(kind, item, found, pen_colour(colour, f"pen {target}={value}: ") if colour.strip() else None)


def _dash_rule(target: str, value: str) -> PenRule:
    kind, item = target_of(target)
    if not isinstance(value, str):
        raise InputError(f"dash {target}={value!r}: expected a text such as '3,1'")
    if value.strip().lower() == "none":
        return PenRule(kind, item, dash_mm=(0.0, 0.0))
    parts = value.split(",")
    if len(parts) != 2:
        raise InputError(f"dash {target}={value}: expected DASH,GAP such as 3,1 or 8pt,3pt; or none")
    dash, gap = (_length(part, f"dash {target}={value}", LONGEST_MM) for part in parts)
    return PenRule(kind, item, dash_mm=(dash, gap))


def _length(text: str, owner: str, most: float) -> float:
    """A length on paper in mm, from the finest pen to the most that there is."""
    try:
        size = length_mm(text)
    except InputError:
        raise InputError(f"{owner}: {text.strip()!r} is no length in mm or pt") from None
    if size < FINEST_MM:
        raise InputError(f"{owner}: expected {FINEST_MM:g} mm or more")
    if size > most:
        raise InputError(f"{owner}: expected {most:g} mm or less")
    return size


def pen_colour(word: str, owner: str = "") -> str:
    """The ink, #rrggbb, of a colour by its name; white is white. Errors: InputError for another word."""
    word = word.strip().lower()
    if word == "white":
        return "#ffffff"
    if not is_colour(word):
        near = nearest(word, COLOURS)
        hint = f" (did you mean {near!r}?)" if near else ""
        raise InputError(f"{owner}unknown colour {word!r}: expected a palette, black, white, red or #rrggbb{hint}")
    return ink(word)


def check_targets(rules: Sequence[PenRule], items: Sequence[str]) -> None:
    """An InputError for a rule for an item that is not there, with the word that may be meant."""
    known = set(items)
    for rule in rules:
        if rule.item is not None and rule.item not in known:
            raise unknown_item(rule.item, items)


def frame_pen(rules: Sequence[PenRule], pen: Pen) -> Pen:
    """The pen of a frame and a title with what the rules for all lines say, and then those for these."""
    for kind in (None, FRAME):
        for rule in rules:
            if rule.kind == kind and rule.item is None:
                pen = rule.applied(pen)
    return pen


def rules_by_target(rules: Sequence[PenRule]) -> RulesByTarget:
    """The rules for each kind and item, in their order."""
    found: dict[tuple[str | None, str | None], list[PenRule]] = {}
    for rule in rules:
        found.setdefault((rule.kind, rule.item), []).append(rule)
    return found


def pen_of(rules: RulesByTarget, pen: Pen, kind: int, hidden: bool, item: str) -> Pen:
    """The pen of lines of one kind and item, that of their layer with what the rules say: those for all lines first,
    then those for the kind, for the item, and for both, the later ones before the earlier ones.

    Lines that something hides are of the kind hidden only; rules for their item that name no kind leave them alone. Of
    hatchings these change the colour only, and those for all lines the width too, where it is the usual one: their
    spacing goes by one that is their own.
    """
    word = HIDDEN if hidden else LineKind(kind).word
    hatching = kind == LineKind.HATCH
    usual = pen.width_mm in USUAL_HATCHING_MM
    for target in [(None, None), (word, None), *(() if hidden else ((None, item),)), (word, item)]:
        for rule in rules.get(target, ()):
            if hatching and rule.kind is None:
                width = rule.width_mm if usual and rule.item is None else None
                rule = replace(rule, width_mm=width, dash_mm=None)
            pen = rule.applied(pen)
    return pen
