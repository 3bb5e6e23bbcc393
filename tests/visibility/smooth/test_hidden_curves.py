"""What smooth surfaces hide in scenes of many other things."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.budget import USUAL, unheard
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.solids import box
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.scene.view import look
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus
from vectorplot.testing import assert_drawing_is_right
from vectorplot.visibility.polyhedra.lines import joined_lines
from vectorplot.visibility.smooth.hidden_curves import cut_lines_and_chords, hidden_curves
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.words import DRAWN, LineKind


@pytest.mark.slow
def test_only_items_that_hide_are_counted() -> None:
    """Work and memory follow the pieces and the sheets that hide, not the items of the scene; the counts stay."""
    crate = Item("crate", box((0.1, 0.1, 0.1)))
    rings = [Item("ring", Torus(1.0, 0.4)), Item("other ring", Torus(1.0, 0.3, (0.0, 0.0, -2.0)))]
    glass = Item("glass", Torus(1.0, 0.3, (0.0, 0.0, 2.0)), occludes=False)
    camera = Camera((0.6, -0.4, 9.0), (0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0))
    kinds = frozenset(map(LineKind.from_word, DRAWN))
    counts = []
    for before in (0, 40):
        scene = Scene((*[crate] * before, glass, *rings))
        view = look(scene, camera)
        traced = traced_scene(scene, view, scene_sheets(scene, view), kinds, 1e-3)
        found = hidden_curves(view, traced, traced.curves, 1e-3, USUAL, unheard)
        assert set(found.pieces.change.item.tolist()) <= {0, 1}
        counts.append(found.hidden_by)
        lines, doubts = cut_lines_and_chords(view, traced, joined_lines([]), 1e-3)
        assert not doubts and lines.behind.any()
    assert np.array_equal(*counts)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [True, False])
@pytest.mark.parametrize("offset", [-1e-4, -1e-6])
def test_a_section_past_a_cusp_is_hidden_by_what_rays_meet(offset: float, parallel: bool) -> None:
    """Seen along x the fold of z = x^3 + x y has its cusp in the middle: close to it one branch lies right behind the
    other."""
    sections = SurfaceLines(sections=(Section((0.5, 1.0, -0.5), (offset,)),))
    fold = graph(lambda x, y: x**3 + x * y, Domain(-1.0, 1.0, -1.0, 1.0))
    scene = Scene((Item("FOLD", fold, curves=sections, lines=("section",)),))
    camera = Camera((6.0, 0.0, 0.0), (0.0, 0.0, 0.0), up=(0.0, 0.0, 1.0), parallel=parallel, height=3.0)
    assert assert_drawing_is_right(draw(scene, camera, hidden="solid"), scene, camera, samples=300) > 200


@pytest.mark.slow
def test_a_section_through_a_place_that_is_seen_edge_on_is_hidden_by_nothing() -> None:
    """Seen along x the surface z = x^3 + x y^2 turns its edge to the eye in the middle, and hides nothing anywhere."""
    sections = SurfaceLines(sections=(Section((-0.746, -0.622, 0.239), (1e-5,)),))
    sheet = graph(lambda x, y: x**3 + x * y**2, Domain(-1.0, 1.0, -1.0, 1.0))
    scene = Scene((Item("SHEET", sheet, curves=sections, lines=("section",)),))
    camera = Camera((6.0, 0.0, 0.0), (0.0, 0.0, 0.0), up=(0.0, 0.0, 1.0), parallel=True, height=3.0)
    (marks,) = [marks for layer in draw(scene, camera, hidden="solid").layers for marks in layer.strokes if len(marks)]
    assert (marks.hidden_by == 0).all()
