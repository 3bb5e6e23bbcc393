"""What rendering runs, loads, tells and refuses."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from support.rendered import SIZE, SUN, coloured_boxes, sphere

import vectorplot as vp
from vectorplot.errors import InputError, InputWarning
from vectorplot.pictures.plan import plan_render
from vectorplot.pictures.render import render
from vectorplot.testing.shapes import box


def test_what_is_not_rendered_is_said_in_one_line():
    rug = vp.Pattern("RUG", "red", 1, np.array([(0, 0), (0.5, 0), (0.5, 0.5)]))
    decorated = vp.Item("A", box((-1, -1, -1), (1, 1, 1)), patterns=(rug,))
    lens = vp.Item("B", box((2, -1, -1), (3, 1, 1)), material=vp.Material("transparent", refraction=1.5))
    for items, words in (
        ((decorated,), "patterns"),
        ((lens,), "refraction"),
        ((decorated, lens), "patterns.*refraction"),
    ):
        with pytest.warns(InputWarning, match=f"^not rendered: {words}") as told:
            render(vp.Scene(items), size=(20, 20))
        assert len(told) == 1
    render(vp.Scene((decorated,)), size=(20, 20), lines=("pattern",))
    reports = []
    render(replace(coloured_boxes(), lights=(SUN,)), size=(20, 20), explain=reports.append)
    assert any(report.name == "left out" and "mirrors" in report.why for report in reports)


@pytest.mark.parametrize("shadows", ["none", "auto", "buffer", "trapezoid", "exact"])
@pytest.mark.parametrize(
    ("light", "message"),
    [
        (vp.Light((np.nan, 0, 1)), "range"),
        (vp.Light((np.inf, 0, 1), parallel=True), "range"),
        (vp.Light((1e300, 0, 1)), "range"),
        (vp.Light((0, 0, 0), parallel=True, name="SUN"), "SUN"),
    ],
)
def test_impossible_lights_are_refused(light, message, shadows):
    with pytest.raises(InputError, match=message):
        render(vp.Scene((sphere(),)), size=(20, 20), lights=[light], shadows=shadows)


@pytest.mark.parametrize("intensity", [np.nan, -1.0])
def test_impossible_intensities_are_refused(intensity):
    with pytest.raises(InputError, match="intensity"):
        vp.Light((0, 0, 9), intensity=intensity)


@pytest.mark.parametrize(
    "options",
    [
        {"size": (2.5, 5)},
        {"size": (float("nan"), 5)},
        {"samples": 1.5},
        {"shadow_size": 100.5},
        {"shadow_size": float("nan")},
        {"size": (0, 5)},
        {"size": (40_000, 5)},
        {"samples": 0},
        {"samples": 99},
        {"shadows": "soft"},
        {"lines": ("wobble",)},
        {"crease_angle_deg": -1.0},
        {"shadows": "buffer", "shadow_bits": 7},
        {"shadows": "buffer", "shadow_size": 10**6},
        {"shadow_casters": "front"},
        {"transparency": "thin"},
        {"shadow_focus": 0.0},
        {"shadow_focus": 1.5},
        {"shadow_focus": float("nan")},
        {"size": (20_000, 20_000)},
    ],
)
def test_what_makes_no_picture_is_refused(options):
    with pytest.raises(InputError):
        render(vp.Scene((sphere(),), (SUN,)), **({"size": (20, 20)} | options))


def stage_names(scene, *, shadows="none", lines=False):
    return [stage.name for stage in plan_render(scene, shadows, lines)]


@pytest.mark.slow
def test_progress_never_goes_back(monkeypatch):
    monkeypatch.setattr(sys.modules["vectorplot.pictures.pixels"], "BAND_PIXELS", 240 * 20)
    told = []
    scene = replace(coloured_boxes(), lights=(SUN,))
    render(scene, size=SIZE, progress=lambda stage, part: told.append((part, stage)))
    parts = [part for part, _ in told]
    assert parts[0] == 0.0
    assert parts[-1] == pytest.approx(1.0)
    assert len(parts) > 60
    assert (np.diff(parts) > -1e-12).all(), told
    assert max(np.diff(parts)) < 0.2


def test_only_the_stages_that_the_scene_calls_for_run():
    plain = vp.Scene((vp.Item("A", box((-1, -1, -1), (1, 1, 1))),))
    assert stage_names(plain) == ["look", "triangles", "coplanar", "depth", "shading", "average"]
    assert "shadows" not in stage_names(plain, shadows="exact"), "no light that casts"
    assert "facets" in stage_names(vp.Scene((sphere(),)))
    assert "mirrors" in stage_names(coloured_boxes())
    reports = []
    render(replace(plain, lights=(SUN,)), size=(20, 20), shadows="buffer", lines=("crease",), explain=reports.append)
    assert [report.name for report in reports if report.error is None] == [
        *("look", "triangles", "shadows", "coplanar", "depth", "shading", "lines", "average")
    ]


@pytest.mark.slow
def test_a_plain_picture_loads_no_effect_and_nothing_heavy():
    script = """
import sys
import vectorplot as vp
from vectorplot.testing.shapes import box
vp.render(vp.Scene((vp.Item("A", box((0, 0, 0), (1, 1, 1))),), (vp.Light((1, -2, 3)),)), size=(20, 20), shadows="none")
print(*(name for name in sys.modules if name.split(".")[0] in ("cairo", "scipy", "shapely", "svgwrite", "skimage")
        or name.startswith(("vectorplot.effects", "vectorplot.backends", "vectorplot.shading.shadow",
                            "vectorplot.shading.trapezoids", "vectorplot.shading.seen_region"))))
"""
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert result.stdout.split() == []
