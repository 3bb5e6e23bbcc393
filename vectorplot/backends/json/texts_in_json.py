"""Texts in JSON."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from vectorplot.backends.json.number_arrays import numbers_of, plain
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError


def texts_text(texts: Texts) -> str:
    """The texts, one a line: ``{"text", "at", "size_mm", "turn_deg", "anchor", "room_mm", "hidden_by"}``."""
    rows = zip(
        texts.strings,
        plain(texts.points),
        plain(texts.size_mm),
        plain(texts.turn_deg),
        plain(texts.anchor),
        plain(texts.room_mm),
        texts.hidden_by.tolist(),
        strict=True,
    )
    names = ("text", "at", "size_mm", "turn_deg", "anchor", "room_mm", "hidden_by")
    return ",".join("\n" + json.dumps(dict(zip(names, row, strict=True))) for row in rows)


def texts_of(value: Any) -> Texts:
    """The texts of such a list. Errors: InputError."""
    if not isinstance(value, list) or not all(isinstance(text, dict) for text in value):
        raise InputError("texts: expected a list of objects")
    wrong = next((i for i, text in enumerate(value) if not isinstance(text.get("text"), str)), None)
    if wrong is not None:
        raise InputError(f"text {wrong}: text: expected str, got {value[wrong].get('text')!r}"[:200])

    def numbers(name: str, *shape: int) -> Any:
        return numbers_of([text.get(name) for text in value], (-1, *shape), name)

    anchor = numbers("anchor")
    if not np.isin(anchor, (0.0, 0.5, 1.0)).all():
        raise InputError("anchor: expected 0, 0.5 or 1")
    return Texts(
        tuple(text["text"] for text in value),
        numbers("at", 2),
        numbers("size_mm"),
        numbers("turn_deg"),
        anchor,
        numbers("room_mm"),
        numbers("hidden_by").astype(np.intp),
    )
