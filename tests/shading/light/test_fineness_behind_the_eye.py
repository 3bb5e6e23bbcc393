"""What is behind the eye, or far beside the picture, asks for few triangles."""

from __future__ import annotations

import pytest

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.surfaces import Sphere, Torus


@pytest.mark.parametrize("verb", [vp.paint, vp.render])
@pytest.mark.parametrize(
    ("shape", "place"),
    [(Torus(3.0, 1.0), (0.0, -8.0, 0.0)), (Torus(3.0, 1.0), (0.0, 0.0, 0.0)), (Sphere(2.0), (9.0, 0.0, 0.0))],
)
def test_smooth_items_that_are_not_seen_cost_little(verb, shape, place):
    seen, counts = vp.Item("BOX", box((1, 1, 1)), "red").moved(-0.5, 8.0, -0.5), []
    scene = vp.Scene((seen, vp.Item("RING", shape, "blue").moved(*place)))
    small = {"size": (60, 40), "samples": 1} if verb is vp.render else {}
    verb(
        scene, vp.Camera((0, 0, 0), (0, 10, 0)), explain=lambda stage: counts.append((stage.name, stage.count)), **small
    )
    assert 0 < max(count for name, count in counts if name in ("look", "faces", "triangles")) < 60_000
