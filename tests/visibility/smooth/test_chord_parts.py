"""Lines that know which parts of curves they are: the directions of these at their ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.effort import several
from support.smooth_parts import around, polylines
from support.smooth_scenes import implicit_surfaces, mixed_scenes, single_surfaces, views

from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.visibility.polyhedra.lines import joined_lines
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.hidden_curves import cut_lines_and_chords, whole_lines_and_chords
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.visibility.smooth.traced_curves import ChordParts
from vectorplot.words import FEATURE_KINDS, LineKind

SCENES = single_surfaces() | implicit_surfaces() | mixed_scenes()
STEP = 1e-3

KINDS = frozenset(LineKind) - set(FEATURE_KINDS)
"""Chords of feature lines may be too short to tell a direction by differences."""


def apart(one, two):
    """How far angles are from each other."""
    return np.abs((one - two + np.pi) % (2.0 * np.pi) - np.pi)


def by_differences(view, parts):
    """(n,2) directions at the ends of lines by differences along the curves, and where these say something."""
    span, result, sure = parts.end - parts.begin, [], []
    for start, step in ((parts.begin, STEP * span), (parts.end, -STEP * span)):
        at = [sight_lines.image(view, parts.curves.at(parts.chord, start + k * step).points) for k in range(4)]
        way = np.sign(step)[:, None] * (-11.0 * at[0] + 18.0 * at[1] - 9.0 * at[2] + 2.0 * at[3])
        result.append(np.arctan2(way[:, 1], way[:, 0]))
        size = np.linalg.norm(way, axis=1) / (6.0 * STEP)
        sure.append((size > 1e-5) & (size > 0.2 * np.linalg.norm(at[3] - at[0], axis=1) / (3.0 * STEP)))
    return np.stack(result, axis=1), np.stack(sure, axis=1)


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", SCENES)
def test_directions_are_those_of_the_curves(name):
    scene = SCENES[name]
    # Central and parallel views in turn: curves of every sort come in several scenes.
    turn = list(SCENES).index(name) % 2
    for number, camera in enumerate(list(views(scene, 2, seed=len(name)))[turn :: several(2, long=1)]):
        view = look(scene, camera)
        traced = traced_scene(scene, view, scene_sheets(scene, view), KINDS, 1e-4)
        chords = whole_lines_and_chords(traced, joined_lines([])).chords
        random = np.random.default_rng(number)
        begin, end = np.sort(random.uniform(0.0, 1.0, (2, len(chords.chord))), axis=0)
        some = random.permutation(len(begin))[:400]
        whole = chords.take(some)
        cut = replace(whole, begin=0.4 * begin[some], end=1.0 - 0.4 * end[some])
        for parts in (whole, cut):
            found = parts.directions(view)
            expected, sure = by_differences(view, parts)
            assert sure.mean() > 0.95
            assert np.isfinite(found).all()
            off = apart(found, expected)[sure]
            assert np.quantile(off, 0.99) < 1e-5
            assert off.max() < 1e-3


@pytest.mark.slow
@pytest.mark.hard(29)
@pytest.mark.spread
@pytest.mark.parametrize("shape", [Torus(3.0, 1.0), ImplicitTorus(3.0, 1.0)], ids=["parametrised", "implicit"])
@pytest.mark.parametrize("parallel", [True, False])
def test_at_a_cusp_a_contour_arrives_and_turns_back(shape, parallel):
    scene = Scene((Item("ring", shape),))
    view = look(scene, Camera((0.0, -12.0, 5.0), (0.0, 0.0, 0.0), parallel=parallel))
    traced = traced_scene(scene, view, scene_sheets(scene, view), frozenset({LineKind.CONTOUR}), 1e-4)
    lines = cut_lines_and_chords(view, traced, joined_lines([]), 1e-4)[0]
    chords = lines.chords
    direction, image = chords.directions(view), view.image_of(lines.end).T
    gap = np.abs(lines.start[:, 1:] - lines.end[:, :-1]).max(axis=0)
    after = np.flatnonzero((gap < 1e-12) & (np.diff(chords.curve) == 0))
    turn = apart(direction[after, 1], direction[after + 1, 0])
    cusps = np.flatnonzero(turn > 1.0)
    assert len(cusps) == 4
    assert np.abs(turn[cusps] - np.pi).max() < 1e-3, "it leaves a cusp the way it came"
    assert np.delete(turn, cusps).max() < 1e-6
    # The limit is where the lines beside the cusp come from.
    way = image[after[cusps]] - view.image_of(lines.start[:, after[cusps]]).T
    assert apart(np.arctan2(way[:, 1], way[:, 0]), direction[after[cusps], 1]).max() < 0.2


def test_lines_of_no_curve_have_no_directions():
    view = look(Scene((Item("ball", Torus(3.0, 1.0)),)), Camera((0.0, 0.0, 9.0), parallel=True))
    chords = ChordParts(Sheets(()), polylines(around(8)), np.array([3, -1]), np.zeros(2), np.ones(2))
    found = chords.directions(view)
    assert np.isfinite(found[0]).all() and np.isnan(found[1]).all()
    assert chords.curve.tolist() == [0, -1]
    assert chords.sides(view).tolist() == [0, 0]


def test_a_ring_lies_inside_of_its_outer_outline_and_outside_of_its_inner_one():
    scene = Scene((Item("ring", Torus(3.0, 1.0)),))
    view = look(scene, Camera((0.0, 0.0, 9.0), up=(0.0, 1.0, 0.0), parallel=True))
    traced = traced_scene(scene, view, scene_sheets(scene, view), frozenset((LineKind.CONTOUR,)), 1e-4)
    lines, _ = cut_lines_and_chords(view, traced, joined_lines([]), 1e-4)
    start, end = view.image_of(lines.start), view.image_of(lines.end)
    turns_left = start[0] * end[1] - start[1] * end[0] > 0.0
    far = np.linalg.norm(view.world_of(lines.start)[:, :2], axis=1) > 3.0
    assert (lines.side == 0).all() and far.any() and not far.all()
    assert np.array_equal(lines.sides(view), np.where(turns_left == far, 1, -1))
