"""Lines through a sphere."""

from __future__ import annotations

import numpy as np
import pytest
from support.smooth_parts import ball_from_above, polylines
from support.smooth_seen import ALL

import vectorplot as vp
from vectorplot.geometry.budget import USUAL
from vectorplot.scene.view import View, look
from vectorplot.surfaces import Domain, surface_of_function
from vectorplot.visibility.smooth.lines_on_several_sheets import no_stretches
from vectorplot.visibility.smooth.piercings import piercings
from vectorplot.visibility.smooth.rays import targets_of
from vectorplot.visibility.smooth.scene_curves import TracedScene, scene_sheets, traced_scene
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.visibility.smooth.traced_curves import Curves


def test_a_line_through_a_sphere_goes_in_behind_one_sheet_and_out_behind_none() -> None:
    view, sheet, radius = ball_from_above()
    sheets = Sheets((sheet,))
    above, beside = [(-2.0, 0.1, 0.6), (2.0, 0.1, 0.6)], [(-2.0, 1.1, 0.0), (2.0, 1.1, 0.0)]
    lines = polylines(*(radius * np.array(line) for line in (above, beside)))
    found = piercings(
        view, sheets, targets_of(view, sheets), lines, no_stretches(), np.zeros(1, dtype=np.bool_), USUAL.pairs
    )[0]
    order = np.argsort(found.part)
    half = np.sqrt(1.0 - 0.1**2 - 0.6**2)
    assert np.allclose(found.part[order], [0.5 - half / 4.0, 0.5 + half / 4.0], atol=1e-12)
    assert found.chord.tolist() == [0, 0] and found.change[order].tolist() == [1, -1]


def test_a_line_that_touches_does_not_pierce() -> None:
    view, sheet, radius = ball_from_above()
    sheets = Sheets((sheet,))
    line = polylines(radius * np.array([(-2.0, 0.0, 1.0), (2.0, 0.0, 1.0)]))
    assert not piercings(
        view, sheets, targets_of(view, sheets), line, no_stretches(), np.zeros(1, dtype=np.bool_), USUAL.pairs
    )[0].change.any()


def covered_twice() -> tuple[View, TracedScene]:
    """A view of an ellipsoid that covers itself, and its curves."""

    def wound(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
        # No way along u leads from every point to the same one again.
        turn = 4.0 * np.pi * (u + 0.02 * np.sin(2.0 * np.pi * u))
        return np.cos(v) * np.cos(turn), np.cos(v) * np.sin(turn), 1.5 * np.sin(v)

    scene = vp.Scene((vp.Item("S", surface_of_function(wound, Domain(0.0, 1.0, -1.0, 1.0))),))
    view = look(scene, vp.Camera((5.0, -7.0, 4.0)))
    return view, traced_scene(scene, view, scene_sheets(scene, view), ALL, 5e-5)


@pytest.mark.slow
def test_lines_that_run_along_other_covers_of_their_surface_are_not_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    # Every chord is close to several triangles of each of the covers, and meets them everywhere.
    view, two = covered_twice()
    asked: list[int] = []
    at = Curves.at
    monkeypatch.setattr(Curves, "at", lambda self, chord, part: asked.append(len(chord)) or at(self, chord, part))
    piercings(view, two.sheets, targets_of(view, two.sheets), two.curves, two.stretches, two.meets_itself, USUAL.pairs)
    assert two.meets_itself.any() and sum(asked) < len(two.curves.points)
