"""Hatching: as dark as asked, in lines that neighbours share, cut off where regions end."""

from __future__ import annotations

import io

import cairo
import numpy as np
import pytest

import vectorplot as vp
from vectorplot.backends.cairo import png_bytes
from vectorplot.drawing import Fills, hatched_fills

FLAT = np.eye(4)
SIDE = 12.0


def squares(*shades: float, side: float = SIDE) -> Fills:
    """Squares side by side, each in a shade from black, 0, to white, all of one item."""
    ring = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) * side
    points = np.concatenate([ring + np.array([k * side, 0.0]) for k in range(len(shades))])
    colours = np.rint(255.0 * np.repeat(np.array(shades)[:, None], 3, axis=1)).astype(np.uint8)
    return Fills.flat(points, 4 * np.arange(len(shades) + 1), colours, item=0)


def inked(strokes: vp.Paths, hatching: vp.Hatching, width: float, height: float) -> np.ndarray:
    """The share of ink in the pixels of a page, 20 to a mm."""
    drawing = vp.Drawing(width, height, (vp.Layer("hatch", vp.Pen(hatching.width_mm), (strokes,)),))
    surface = cairo.ImageSurface.create_from_png(io.BytesIO(png_bytes(drawing, 20.0 * 25.4)))
    pixels = np.frombuffer(surface.get_data(), dtype=np.uint8).reshape(surface.get_height(), surface.get_width(), 4)
    return 1.0 - pixels[..., 0] / 255.0


RAMP = (0.95, 0.8, 0.7, 0.6, 0.5, 0.4, 0.25, 0.1, 0.0)


@pytest.mark.parametrize("cross", [False, True])
@pytest.mark.parametrize(("spacing", "angle"), [(0.6, 45.0), (0.3, 17.0)])
def test_plain_regions_are_as_dark_as_asked(cross: bool, spacing: float, angle: float) -> None:
    hatching = vp.Hatching(spacing_mm=spacing, angle_deg=angle, cross=cross)
    strokes = hatched_fills(squares(*RAMP), [hatching], FLAT)
    ink = inked(strokes, hatching, SIDE * len(RAMP), SIDE)
    found = ink.reshape(len(ink), len(RAMP), -1).mean(axis=(0, 2))
    # Round ends reach half a width over the sides of squares, into the next one.
    assert np.abs(found - (1.0 - np.array(RAMP)) * hatching.darkest).max() < 0.03


@pytest.mark.parametrize("cross", [False, True])
def test_where_darkness_varies_the_ink_follows_it(cross: bool) -> None:
    """A square from white at the left to black at the right."""
    hatching = vp.Hatching(spacing_mm=0.3, angle_deg=30.0, cross=cross)
    ring = np.array([[0.0, 0.0], [60.0, 0.0], [60.0, 20.0], [0.0, 20.0]])
    colours = np.repeat(np.array([255, 0, 0, 255], dtype=np.uint8)[:, None], 3, axis=1)
    none = np.zeros(1, dtype=np.intp)
    shaded = Fills(ring, np.array([0, 4]), colours, np.ones(1), none, np.pad(ring, ((0, 0), (0, 1))), none)
    ink = inked(hatched_fills(shaded, [hatching], FLAT), hatching, 60.0, 20.0)
    found = ink.reshape(len(ink), 12, -1).mean(axis=(0, 2))
    asked = (np.arange(12) + 0.5) / 12.0 * hatching.darkest
    assert np.abs(found - asked).max() < 0.03


def test_strokes_run_through_neighbours_of_one_tone_and_end_at_others() -> None:
    level = vp.Hatching(spacing_mm=1.0, angle_deg=0.0)
    strokes = hatched_fills(squares(0.0, 0.0, 0.5), [level], FLAT)
    ends = strokes.points.reshape(-1, 2, 2)[:, :, 0]
    assert sorted(map(tuple, ends.tolist())) == [(0.0, 24.0)] * 12 + [(24.0, 36.0)] * 6
    assert set(strokes.kind.tolist()) == {vp.LineKind.HATCH}


def test_what_lies_on_top_is_hatched_and_what_is_below_it_is_not() -> None:
    below, above = squares(0.0), squares(0.5, side=4.0)
    above = Fills.flat(above.points + 4.0, above.offsets, above.colours[:1], item=1)
    level = vp.Hatching(spacing_mm=1.0, angle_deg=0.0)
    strokes = hatched_fills(Fills.joined(below, above), [level, vp.Hatching("none")], FLAT)
    middle = strokes.points[:, 1].reshape(-1, 2)[:, 0]
    ends = strokes.points.reshape(-1, 2, 2)[:, :, 0]
    assert ends[(middle > 4.0) & (middle < 8.0)].tolist() == [[0.0, 4.0], [8.0, 12.0]] * 4
    assert ends[(middle < 4.0) | (middle > 8.0)].tolist() == [[0.0, 12.0]] * 8


def test_white_and_paper_stay_free_and_no_fills_give_no_strokes() -> None:
    white = np.array([255, 255, 255], dtype=np.uint8)
    for fills in (Fills.empty(), squares(1.0), Fills.whole_page(20.0, 20.0, 0 * white)):
        assert len(hatched_fills(fills, [vp.Hatching(cross=True)], FLAT)) == 0


@pytest.mark.parametrize(
    "wrong",
    [
        {"by": "shade"},
        {"along": "paper"},
        {"spacing_mm": 0.0},
        {"spacing_mm": np.inf},
        {"width_mm": np.nan},
        {"width_mm": 0.7},
        {"angle_deg": np.nan},
    ],
)
def test_impossible_hatchings_are_refused(wrong: dict) -> None:
    with pytest.raises(vp.InputError, match="hatching"):
        vp.Hatching(**wrong)


def test_too_many_strokes_are_refused_before_they_are_made() -> None:
    fine = vp.Hatching(spacing_mm=0.01, width_mm=0.01)
    with pytest.raises(vp.InputError, match="too fine"):
        hatched_fills(squares(0.0, side=2e5), [fine], FLAT)
