"""Polygons in JSON: every number with its shortest digits, colours one by one where they differ."""

from __future__ import annotations

import json

import numpy as np

from vectorplot.backends.json import fills_text, point_texts
from vectorplot.drawing.fills import Fills


def test_points_are_written_with_all_their_digits_and_no_minus_before_zero() -> None:
    random = np.random.default_rng(8)
    for width in (2, 3):
        points = np.concatenate([random.normal(size=(40, width)), [[0.0] * width, [-0.0] * width], [[1e-300] * width]])
        points = points[random.integers(0, len(points), 200)]
        assert [json.loads(text) for text in point_texts(points)] == points.tolist()
        assert not any("-0.0," in text or "-0.0]" in text for text in point_texts(points))
        assert len(point_texts(points[:0])) == 0


def test_shaded_flat_and_empty_polygons_stand_side_by_side() -> None:
    counts = np.array([3, 0, 4, 2])
    colours = np.zeros((9, 3), dtype=np.uint8)
    colours[3:7], colours[5] = 17, 255
    points = np.arange(18.0).reshape(-1, 2) / 3.0
    none = np.full(4, -1)
    fills = Fills(
        points, np.cumsum([0, *counts]), colours, np.ones(4), none, np.column_stack((points, points[:, 0])), 0 * none
    )
    found = json.loads(f"[{fills_text(fills, ())}]")
    shaded = ["#111111", "#111111", "#ffffff", "#111111"]
    assert [fill["colour"] for fill in found] == ["#000000", [], shaded, "#000000"]
    assert [point for fill in found for point in fill["points"]] == points.tolist()
    assert [len(fill["points3d"]) for fill in found] == counts.tolist()
