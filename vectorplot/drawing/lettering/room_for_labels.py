"""Sheets that are cut to their picture, its labels among it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Layer
from vectorplot.drawing.sheets.sheet import moved_mark
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement


def with_room(layers: tuple[Layer, ...], placement: Placement, boxes: Floats) -> tuple[tuple[Layer, ...], Placement]:
    """The layers of a drawing on a sheet that has its margin around boxes (b,4,2) too, and their place there.

    A sheet that has that already stays.
    """
    page = placement.page
    corners = np.concatenate([boxes.reshape(-1, 2), np.zeros((0, 2))])
    margin, size = page.margin_mm, np.array([page.width_mm, page.height_mm])
    low = np.minimum(corners.min(axis=0, initial=np.inf) - margin, 0.0)
    high = np.maximum(corners.max(axis=0, initial=-np.inf) + margin, size)
    if (low == 0.0).all() and (high == size).all():
        return layers, placement
    width, height = (high - low).tolist()
    moved = tuple(replace(layer, marks=tuple(moved_mark(mark, 1.0, -low) for mark in layer.marks)) for layer in layers)
    matrix = placement.page_from_image.copy()
    matrix[:2] -= low[:, None] * matrix[2]
    return moved, replace(placement, page=Page(width, height, margin), page_from_image=matrix)
