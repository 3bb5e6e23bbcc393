"""What is told of the shades of smooth surfaces is what they are off wherever one looks, not along sides alone."""

from functools import cache

import numpy as np
import pytest
from support.top_fills import colours_at, fills_of, top_at

import vectorplot as vp
from vectorplot.surfaces import Ellipsoid, Torus

SURFACES = {"torus": Torus(3.0, 1.0), "ellipsoid": Ellipsoid((1.0, 1.5, 2.5)), "thick torus": Torus(2.0, 1.3)}
STEP = 3.0
"""Palettes of both pictures round, and the finer one is off itself."""


@cache
def _painted(name, tolerance_mm):
    """The polygons of a surface, and what is told of how much their shades are off."""
    told = []
    scene = vp.Scene((vp.Item("body", SURFACES[name], "gray"),))
    drawing = vp.paint(
        scene,
        vp.Camera((12.0, -9.0, 8.0), (0.0, 0.0, 0.0)),
        page="120x120",
        tolerance_mm=tolerance_mm,
        explain=lambda one: told.append(one.error) if one.unit == "of 255" else None,
    )
    return fills_of(drawing), told[-1]


def _colours(name, tolerance_mm, places):
    fills, told = _painted(name, tolerance_mm)
    top = top_at(fills, places)
    found = np.full((len(places), 3), np.nan)
    found[top >= 0] = colours_at(fills, top[top >= 0], places[top >= 0])
    return found, told


@pytest.mark.parametrize("tolerance_mm", [0.02, 0.05])
@pytest.mark.parametrize("name", list(SURFACES))
def test_shades_are_off_by_no_more_than_told(name, tolerance_mm):
    places = np.random.default_rng(0).random((6000, 2)) * 120.0
    seen, told = _colours(name, tolerance_mm, places)
    truth, _ = _colours(name, 0.001, places)
    off = np.abs(seen - truth).max(axis=1)
    assert np.nanquantile(off, 0.998) <= told + STEP


def test_shades_are_near_the_true_ones_where_sight_rays_come_in_flat():
    places = np.random.default_rng(1).random((20000, 2)) * 120.0
    seen, _ = _colours("torus", 0.02, places)
    truth, _ = _colours("torus", 0.001, places)
    off = np.abs(seen - truth).max(axis=1)
    assert np.nanquantile(off, 0.998) <= 16.0
    assert np.nanquantile(off, 0.99) <= 12.0
