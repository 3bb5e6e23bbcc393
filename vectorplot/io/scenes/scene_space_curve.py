"""Curves in space as items of scene files: which one, and where it stands; loaded where a file has one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.curves.curve import Curve
from vectorplot.curves.placed_curve import PlacedCurve
from vectorplot.geometry.bodies.solids import IDENTITY
from vectorplot.io.scenes.scene_families import CURVES
from vectorplot.io.scenes.scene_slots import read_family
from vectorplot.io.scenes.scene_words import Words
from vectorplot.scene.extent import smooth_bounds
from vectorplot.words import nearest

_FORMULAS = "curve"
"""The family whose word may be left out: formulas stand right behind the kind."""


def read_space_curve(words: Words, at: int, owner: str) -> tuple[Curve, int]:
    """The curve whose name, or whose formulas, stand at a word, and the word behind its slots."""
    name = words.words[at]
    if name in CURVES:
        return read_family(words, at + 1, owner, name, CURVES)
    if name.startswith('"') or words.is_number(at) or name in CURVES[_FORMULAS].slots:
        return read_family(words, at, owner, _FORMULAS, CURVES)
    known = ", ".join(word for word in CURVES if word != _FORMULAS)
    near = nearest(name, list(CURVES)) if name else None
    expected = f"'{near}'" if near else f"three formulas in quotes or one of {known}"
    words.fail(at, f"{owner}curve: expected {expected}, got {words.shown(at)}")


def placed_curve(curve: Curve, placement: Sequence[float]) -> Curve:
    """The curve under a placement (twelve numbers, rows of a matrix and a shift).

    Errors: InputError for a curve without a finite point.
    """
    if tuple(placement) != IDENTITY:
        rows = np.array(placement).reshape(3, 4)
        curve = PlacedCurve(curve, rows[:, :3].T, rows[:, 3])
    smooth_bounds(curve)
    return curve
