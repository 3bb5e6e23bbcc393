"""Implicit surfaces without points are told by name, whatever shows them."""

from __future__ import annotations

import warnings
from functools import partial

import pytest

import vectorplot as vp
from vectorplot.surfaces import implicit_of_function

BOX = [(-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)]


@pytest.mark.parametrize(
    "verb", [vp.draw, vp.paint, partial(vp.render, size=(40, 30))], ids=["draw", "paint", "render"]
)
def test_a_surface_without_points_is_told(verb):
    nothing = vp.Item("NIX", implicit_of_function(lambda x, y, z: x**2 + y**2 + z**2 + 1.0, BOX))
    with pytest.warns(vp.InputWarning, match="NIX: the surface has no points in its box: nothing of it is shown"):
        verb(nothing, "iso")


@pytest.mark.slow
@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
def test_a_surface_that_is_cut_away_is_not(verb):
    ball = vp.Item("BALL", implicit_of_function(lambda x, y, z: x**2 + y**2 + z**2 - 0.5, BOX))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        verb(vp.cut(vp.Scene((ball,)), "x = 5"), "iso")
