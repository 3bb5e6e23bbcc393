"""Polygons on faces: some of them, several joined, and their order."""

from __future__ import annotations

import numpy as np

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, joined_decals, no_decals


def _decals(face: list[int], level: list[int], colour: list[int], colours: tuple[str, ...]) -> Decals:
    count = len(face)
    sizes = 3 + np.arange(count) % 2
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    points = np.arange(3.0 * offsets[-1]).reshape(3, -1)
    kind = np.full(count, int(FillKind.PATTERN))
    none = np.zeros(count, dtype=np.intp)
    return Decals(points, offsets, np.array(face), kind, none, none - 1, np.array(colour), np.array(level), colours)


def test_some_decals_keep_their_polygons() -> None:
    decals = _decals([4, 2, 4, 2], [1, 0, 0, 1], [0, 1, -1, 0], ("red", "blue"))
    some = decals.of(np.array([3, 1]))
    assert some.face.tolist() == [2, 2] and some.colour.tolist() == [0, 1]
    assert np.array_equal(some.points[:, :4], decals.points[:, decals.offsets[3] : decals.offsets[4]])
    assert np.array_equal(some.points[:, 4:], decals.points[:, decals.offsets[1] : decals.offsets[2]])


def test_painting_order_is_by_face_then_level() -> None:
    decals = _decals([4, 2, 4, 2], [1, 0, 0, 1], [0, 0, 0, 0], ("red",))
    assert decals.painting_order.tolist() == [1, 3, 2, 0]


def test_joined_decals_share_their_colours() -> None:
    first = _decals([0, 1], [0, 0], [0, -1], ("red",))
    second = _decals([2, 3, 4], [0, 0, 0], [0, 1, -1], ("blue", "red"))
    both = joined_decals(first, no_decals(), second)
    assert both.colours == ("red", "blue")
    assert both.colour.tolist() == [0, -1, 1, 0, -1]
    assert both.face.tolist() == [0, 1, 2, 3, 4]
    assert np.array_equal(both.points[:, both.offsets[2] : both.offsets[3]], second.points[:, :3])


def test_nothing_joined_is_nothing() -> None:
    assert len(joined_decals()) == 0 and len(joined_decals(no_decals())) == 0


def test_lights_and_opacities_are_those_told_or_the_plain_ones() -> None:
    plain = _decals([0, 1], [0, 0], [-1, -1], ())
    shadow = Decals(**{**plain.__dict__, "light": np.array([2, -1])})
    clear = Decals(**{**plain.__dict__, "lacking": np.array([5, 3]), "opacity": np.array([0.5, 0.25])})
    both = joined_decals(plain, shadow, clear)
    assert both.lights_lacking.tolist() == [0, 0, 4, 0, 5, 3]
    assert both.opacities.tolist() == [1, 1, 1, 1, 0.5, 0.25]
    assert both.of(np.array([5, 2])).lights_lacking.tolist() == [3, 4]
