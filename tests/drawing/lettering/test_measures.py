"""Texts and arrowheads of dimensions where there is little room for them."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.geometry import box, prism, regular_polygon

PAGE = vp.Page(120, 100, 0)
TOP = vp.Camera((20, 15, 9), target=(20, 15, 0), parallel=True, height=100, up=(0, 1, 0))


def _drawn(*notes: vp.Scene, bores: tuple[float, ...] = ()) -> vp.Drawing:
    """A plate of 40 x 30 from above, a millimetre for each unit, with bores of these radii in its middle."""
    holes = [regular_polygon(48, radius, centre=(20, 15, 0)) for radius in bores]
    plate = prism([(0, 0, 0), (40, 0, 0), (40, 30, 0), (0, 30, 0)], (0, 0, 1), holes=holes)
    return vp.draw([vp.Item("plate", plate), *notes], TOP, page=PAGE, fit=False)


def _length(drawing: vp.Drawing) -> float:
    """Of the lines of the plate on the page."""
    strokes = (paths for layer in drawing.layers for paths in layer.strokes if layer.name != "label")
    found = 0.0
    for paths in strokes:
        for k in range(len(paths)):
            points = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
            points = np.concatenate([points, points[:1]]) if paths.closed[k] else points
            found += float(np.hypot(*np.diff(points, axis=0).T).sum())
    return found


def _heads(drawing: vp.Drawing) -> dict[tuple[float, float], tuple[float, float]]:
    """The tips of arrowheads, from the middle of the page, and where they point."""
    found = {}
    for paths in (paths for layer in drawing.layers if layer.name == "label" for paths in layer.strokes):
        for begin, end in zip(paths.offsets[:-1], paths.offsets[1:], strict=True):
            points = paths.points[begin:end]
            if len(points) == 5 and np.array_equal(points[0], points[3]):
                tip, back = points[[0, 4]]
                way = (tip - back) / np.hypot(*(tip - back))
                found[tuple((tip - (60, 50)).round(6).tolist())] = tuple((way.round(6) + 0.0).tolist())
    return found


@pytest.mark.parametrize("radius", [2.0, 4.0])
def test_the_measure_of_a_small_bore_does_not_interrupt_it(radius: float) -> None:
    whole = _length(_drawn(bores=(radius,)))
    note = vp.diameter((20, 15, 1), (20 + radius, 15, 1))
    assert _length(_drawn(note, bores=(radius,))) == pytest.approx(whole)


def test_texts_stand_on_the_other_side_of_their_line_where_the_part_is_in_their_way() -> None:
    near, far = (vp.dimension((0, 0, 1), (40, 0, 1), (0, -off, 0), gap=1, beyond=2) for off in (4, 10))
    assert _length(_drawn(near)) == pytest.approx(_length(_drawn()))
    below = {name: _letters(_drawn(note))[:, 1] < 35.0 - off for name, note, off in (("n", near, 4), ("f", far, 10))}
    assert below["n"].all() and not below["f"].any()


def _letters(drawing: vp.Drawing) -> np.ndarray:
    """(n,2) the middles of curved strokes of letters."""
    found = []
    for paths in (paths for layer in drawing.layers if layer.name == "label" for paths in layer.strokes):
        for begin, end in zip(paths.offsets[:-1], paths.offsets[1:], strict=True):
            found += [paths.points[begin:end].mean(axis=0)] if end - begin > 5 else []
    return np.array(found)


@pytest.mark.parametrize(("long", "outside"), [(6.0, True), (8.0, False)])
def test_arrowheads_without_room_between_the_ends_point_at_them_from_outside(long: float, outside: bool) -> None:
    heads = _heads(_drawn(vp.dimension((20, 0, 1), (20 + long, 0, 1), (0, -10, 0))))
    sign = -1.0 if outside else 1.0
    assert heads == {(0.0, -25.0): (-sign, 0.0), (long, -25.0): (sign, 0.0)}


def test_a_text_wider_than_its_line_stands_beyond_the_end_that_is_read_last() -> None:
    for ends in (((20, 0, 1), (24, 0, 1)), ((24, 0, 1), (20, 0, 1))):
        letters = _letters(_drawn(vp.dimension(*ends, (0, -10, 0), "66.66")))
        assert (letters[:, 0] > 60 + 4).all() and (letters[:, 1] > 25).all()


def test_axes_keep_their_arrowheads_however_short_they_are() -> None:
    heads = _heads(vp.draw([vp.Item("cube", box((1, 1, 1))), vp.axes(2)], TOP, page=PAGE, fit=False))
    assert heads == {(-18.0, -15.0): (1.0, 0.0), (-20.0, -13.0): (0.0, 1.0)}
