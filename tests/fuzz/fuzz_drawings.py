"""Drawings in JSON that are nearly right."""

from __future__ import annotations

import json
from random import Random
from typing import Any

from fuzz.fuzz_meshes import damage
from fuzz.fuzz_words import HOSTILE, NAMES, changed_bytes, one

from vectorplot.words import LINE_WORDS

_PARTS = (b"[", b"{", b'"', b'{"a":', b"[0,", b"\\u0000", b"1e9,", b" ")


def drawing_bytes(rng: Random) -> bytes:
    """A drawing as JSON: right, with something replaced in its tree, damaged, or one part of it again and again."""
    way = rng.random()
    if way < 0.02:
        return one(rng, _PARTS) * rng.randrange(1, 20_000)
    tree = _drawing(rng)
    if way < 0.6:
        damage(rng, tree)
    data = json.dumps(tree).encode()
    if way < 0.65:
        data = data.replace(b"0.5", one(rng, HOSTILE).encode(), 1)
    return changed_bytes(rng, data) if way > 0.85 else data


def _drawing(rng: Random) -> dict[str, Any]:
    return {
        "format": "vectorplot-drawing",
        "version": 1,
        "page_mm": [rng.randint(1, 300), 0.5 + rng.randint(1, 300)],
        "page_from_world": [[float(i == j) for j in range(4)] for i in range(4)],
        "strokes": [_stroke(rng) for _ in range(rng.randrange(4))],
        "fills": [_fill(rng) for _ in range(rng.randrange(4))],
    }


def _points(rng: Random, count: int, columns: int) -> list[list[float]]:
    return [[rng.choice((0.5, 1.0, rng.uniform(0.0, 200.0))) for _ in range(columns)] for _ in range(count)]


def _stroke(rng: Random) -> dict[str, Any]:
    count = rng.randint(2, 5)
    stroke: dict[str, Any] = {
        "kind": one(rng, LINE_WORDS),
        "item": one(rng, NAMES),
        "hidden_by": rng.randrange(3),
        "points": _points(rng, count, 2),
        "points3d": _points(rng, count, 3),
        "closed": rng.random() < 0.3,
    }
    if rng.random() < 0.4:
        stroke |= {"smooth": True, "curve": rng.randrange(3), "directions": _points(rng, count, 2)}
    return stroke


def _fill(rng: Random) -> dict[str, Any]:
    count = rng.randint(2, 5)
    colour = "#12abef"
    return {
        "kind": one(rng, ("face", "glass", "background", "pattern", "line", "shadow")),
        "item": one(rng, NAMES),
        "colour": [colour] * count if rng.random() < 0.4 else colour,
        "opacity": rng.choice((1, 0.5, 0)),
        "points": _points(rng, count, 2),
        "points3d": _points(rng, count, 3),
    }
