"""Painted polygons on the page, and others between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.fills import Colours, Fills
from vectorplot.drawing.placement import centred, fitted
from vectorplot.scene.scene import Page
from vectorplot.scene.view import View
from vectorplot.visibility.framing import reaches_too_far
from vectorplot.visibility.painter.framing import framed_faces
from vectorplot.visibility.painter.image_faces import ImageFaces, unmapped


@dataclass(frozen=True, eq=False)
class Overlay:
    """Polygons painted after others: fills, and after (m,): the number of the polygon that each of them comes right
    after; of equal numbers in the order they have here."""

    fills: Fills
    after: Ints


def stacked(overlays: Sequence[Overlay]) -> Overlay:
    """All polygons by what they come after; of several after one polygon those of the first overlay come first."""
    place = np.concatenate([overlay.after for overlay in overlays])
    order = np.argsort(place, kind="stable")
    return Overlay(Fills.joined(*(overlay.fills for overlay in overlays)).some(order), place[order])


def overlaid(base: Overlay, overlays: Sequence[Overlay]) -> Overlay:
    """The polygons of base with those of the overlays, which come after polygons of base, between them; of several
    after one polygon those of the first overlay come first."""
    overlays = [overlay for overlay in overlays if len(overlay.fills)]
    if not overlays:
        return base
    every = stacked([Overlay(base.fills, np.arange(len(base.fills))), *overlays])
    return Overlay(every.fills, base.after[every.after])


def interleaved(base: Fills, overlays: Sequence[Overlay]) -> Fills:
    """The polygons of base with those of the overlays between them."""
    return overlaid(Overlay(base, np.arange(len(base))), overlays).fills


@dataclass(frozen=True, eq=False)
class Placed:
    """Where a picture goes: page_from_image (3,3), and whether all of it is on the page; else it shows what the camera
    sees, inside the margins."""

    page_from_image: Floats
    whole: bool

    def framed(self, faces: ImageFaces, page: Page, tolerance: float) -> ImageFaces:
        """The polygons as far as the picture shows them."""
        if self.whole:
            return faces
        scale, middle = self.page_from_image[0, 0], self.page_from_image[:2, 2]
        size = np.array([page.width_mm, page.height_mm])
        low, high = (page.margin_mm - middle) / scale, (size - page.margin_mm - middle) / scale
        return framed_faces(faces, low, high, tolerance)


def placed_faces(view: View, faces: ImageFaces, page: Page, fit: bool) -> Placed:
    """The place on the page of a picture of painted polygons."""
    used = np.zeros(view.face_count, dtype=np.bool_)
    used[faces.source] = True
    points, image = view.points[:, view.corners[np.repeat(used, view.face_sizes)]], faces.points[:2]
    if not fit:
        return Placed(centred(page, view.picture_height, page.height_mm), False)
    if reaches_too_far(view, points, points):
        return Placed(centred(page, view.picture_height, page.height_mm - 2.0 * page.margin_mm), False)
    if not image.shape[1]:
        return Placed(fitted(page, np.zeros(2), np.zeros(2)), True)
    low, high = image.min(axis=1), image.max(axis=1)
    return Placed(fitted(page, low, high if (high - low).max() > view.tolerance else low), True)


def fills_on_page(
    view: View,
    points: Floats,
    offsets: Ints,
    placed: Placed,
    *,
    colours: Colours,
    opacity: Floats,
    item: Ints,
    kind: Ints,
) -> Fills:
    """Polygons of the image on the page: points (3,c) places and heights as of ImageFaces, colours (c,3), opacity,
    item and kind (m,) as of Fills."""
    place = placed.page_from_image
    flat = (place[:2, :2] @ points[:2]).T + place[:2, 2]
    return Fills(
        np.ascontiguousarray(flat), offsets, colours, opacity, item, view.world_of(unmapped(view, points)), kind
    )
