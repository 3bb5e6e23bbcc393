"""Sharp edges between the sheets of a body, cut where one of them turns away."""

from __future__ import annotations

import numpy as np

import vectorplot as vp
from vectorplot.scene.view import look
from vectorplot.surfaces import Capped, Cylinder
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.words import DRAWN, LineKind, line_kinds


def test_pieces_of_rims_keep_all_that_is_said_of_their_curves():
    scene = vp.Scene(tuple(vp.Item(f"B{k}", Capped(Cylinder(1.0, 3.0 * k, 3.0 * k + 2.0))) for k in range(2)))
    view = look(scene, vp.Camera((7.0, -5.0, 4.0)))
    found = traced_scene(scene, view, scene_sheets(scene, view), line_kinds(DRAWN), 1e-4).curves
    rims = found.take(np.isin(found.kind, [LineKind.CONTOUR, LineKind.CREASE]))
    assert set(np.unique(rims.item)) == {0, 1} and LineKind.CREASE in rims.kind
    for name in ("sheet", "second_sheet", "side", "behind", "family", "level"):
        assert getattr(rims, name).shape == (len(rims),)
    assert np.array_equal(rims.take(np.arange(len(rims))).sheet, rims.sheet)
