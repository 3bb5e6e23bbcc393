"""What runs when a scene is painted, and what is loaded for it: that which the scene calls for, and nothing else."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.paths import DATA

from vectorplot.geometry.camera import Camera
from vectorplot.io.read_file import read
from vectorplot.pictures.draw import draw
from vectorplot.pictures.paint import paint
from vectorplot.pictures.pipeline import Pipeline, Stage, StageReport
from vectorplot.pictures.render import render
from vectorplot.scene.item import Item, Pattern, SurfaceNormals
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import box

PLAIN = ["look", "faces", "order", "shades", "fills"]
CUBE = Item("CUBE", box((-1, -1, -1), (1, 1, 1)), "blue")
SUN = Light((2.0, -3.0, 4.0), parallel=True)
PANE = Item("PANE", box((-3, -3, -2), (3, 3, -1.9)), "cyan")
MIRROR = replace(PANE, material=Material("mirror"))
CLEAR = replace(PANE, material=Material("transparent", 0.5), occludes=False)
GLASS = replace(PANE, material=Material("transparent", 0.5, 1.4), occludes=False)
SPOT = replace(CUBE, patterns=(Pattern("SPOT", "red", 1, np.array([(0.0, 0.0), (0.5, 0.0), (0.0, 0.5)])),))
BALL = Item("BALL", Sphere(0.5))
RING = Item("RING", Torus(0.5, 0.1))
CORNERS = CUBE.mesh.vertices
BAND = replace(CUBE, normals=SurfaceNormals(CUBE.mesh, CORNERS / np.sqrt(3.0), np.zeros(len(CORNERS), dtype=bool)))
CAMERA = Camera((4.0, -6.0, 5.0))


def with_stages(*stages: str) -> list[str]:
    """The stages of a plain scene, and others between the shades and the polygons on the page."""
    return [*PLAIN[:-1], *stages, PLAIN[-1]]


def with_sheets(*stages: str) -> list[str]:
    """The same of a scene with transparent items."""
    return [*PLAIN[:3], "transparent sheets", *with_stages(*stages)[3:]]


def reports_of(scene: Scene, **options: object) -> list[StageReport]:
    reports: list[StageReport] = []
    paint(scene, CAMERA, explain=reports.append, **options)
    return reports


def ran(scene: Scene, **options: object) -> list[str]:
    return [report.name for report in reports_of(scene, **options) if report.error is None]


CALLS = [
    (Scene(()), {}, PLAIN),
    (Scene((CUBE,)), {}, PLAIN),
    (Scene((CUBE,), (SUN,)), {}, with_stages("shadows")),
    (Scene((CUBE,), (SUN,)), {"shadows": "none"}, PLAIN),
    (Scene((CUBE,), (SUN,)), {"lights": ()}, PLAIN),
    (Scene((CUBE,)), {"lights": (SUN,)}, with_stages("shadows")),
    (Scene((SPOT,)), {}, with_stages("patterns")),
    (Scene((SPOT,), (SUN,)), {}, with_stages("shadows", "patterns")),
    (Scene((CUBE, MIRROR)), {}, with_stages("reflections")),
    (Scene((CUBE, MIRROR), (SUN,)), {}, with_stages("shadows", "mirror light", "reflections")),
    (Scene((CUBE, MIRROR), (SUN,)), {"shadows": "none"}, with_stages("reflections")),
    (Scene((CUBE, CLEAR)), {}, with_sheets()),
    (Scene((CUBE, CLEAR), (SUN,)), {}, with_sheets("shadows", "transparent shadows")),
    (Scene((CUBE, GLASS)), {}, with_sheets("refraction")),
    (Scene((CUBE, GLASS), (SUN,)), {"shadows": "none"}, with_sheets("refraction")),
    (Scene((CUBE, BALL)), {}, ["bodies", *PLAIN, "bands"]),
    (Scene((CUBE, RING)), {}, ["facets", *PLAIN[:3], "unseen facets", "layers", *PLAIN[3:]]),
    (Scene((RING,)), {}, ["facets", *PLAIN[:3], "unseen facets", "layers", *PLAIN[3:]]),
    (Scene((BAND,)), {}, [*PLAIN[:3], "unseen facets", *PLAIN[3:]]),
    (Scene((CUBE,)), {"fills": "visible"}, [*PLAIN, "visible fills"]),
    (Scene((CUBE,)), {"lines": ("crease",)}, [*PLAIN, "lines"]),
]


@pytest.mark.slow
@pytest.mark.parametrize("scene, options, stages", CALLS)
def test_each_scene_runs_the_stages_that_it_calls_for(scene: Scene, options: dict, stages: list[str]) -> None:
    assert ran(scene, **options) == stages


@pytest.mark.slow
def test_each_stage_tells_why_it_ran_and_what_it_took() -> None:
    for report in reports_of(Scene((SPOT, MIRROR, GLASS, BALL), (SUN,)), tolerance_mm=1.0):
        assert report.why and report.seconds >= 0.0 and report.count >= 0 and report.peak_mb > 1.0


@pytest.mark.slow
def test_stages_that_approximate_say_how_far_off_they_may_be() -> None:
    def said(verb: Callable[..., object], scene: Scene, **options: object) -> dict[str, str]:
        reports: list[StageReport] = []
        verb(scene, CAMERA, explain=reports.append, **options)
        return {report.name: report.why for report in reports}

    ring, small = Scene((Item("RING", Torus(2.0, 0.5)),), (SUN,)), {"size": (60, 40), "samples": 1}
    drawn = said(draw, ring, lines="contour", tolerance_mm=0.2)
    assert "chords within 0.1 mm" in drawn["curves"] and "curves within 0.1 mm" in drawn["pen"]
    assert "exact: below 1e-09 of the extent" in drawn["visible lines"]
    assert "curves" not in said(draw, ring, lines="contour", curves="polyline")["pen"]
    assert "--tolerance" not in " ".join(said(draw, Scene((CUBE,))).values())
    assert "within 0.5 mm" in said(paint, ring, tolerance_mm=0.5, shadows="none")["facets"]
    rendered = said(render, ring, shadows="buffer", shadow_size=64, **small)
    assert "a texel of 64 x 64" in rendered["shadows"] and "of a sample" in rendered["facets"]
    assert "texel" not in said(render, ring, shadows="exact", **small)["shadows"]
    block = Scene((CUBE,), (SUN,))
    for size, texels in (((60, 40), 256), ((300, 257), 512), ((4, 512), 512)):
        usual = said(render, block, shadows="buffer", size=size, samples=1)["shadows"]
        assert f"a texel of {texels} x {texels}" in usual, "as fine as the picture"


def errors_of(verb: Callable[..., object], scene: Scene, **options: object) -> dict[str, tuple[float, str]]:
    """What each stage of a picture was measured to be off by, and in what."""
    reports: list[StageReport] = []
    verb(scene, CAMERA, explain=reports.append, **options)
    return {report.name: (report.error, report.unit) for report in reports if report.error is not None}


@pytest.mark.slow
def test_stages_measure_how_far_off_they_are() -> None:
    ring = Scene((Item("RING", Torus(2.0, 0.5), "blue"),), (SUN,))
    drawn = errors_of(draw, ring, lines="contour", tolerance_mm=0.2)
    assert 0.01 < drawn["curves"][0] <= 0.1 and 0.0 < drawn["pen"][0] <= 0.1
    assert 0.0 < drawn["visible lines"][0] < 1e-6 and drawn["pen"][1] == "mm"
    painted = errors_of(paint, ring, tolerance_mm=0.5, shadows="none")
    assert 0.1 < painted["facets"][0] <= 0.6 and painted["facets"][1] == "mm"
    # On a ring of so coarse facets what is measured is what shades are off, not what they were aimed at.
    assert 1.0 < painted["shades"][0] < 40.0 and painted["shades"][1] == "of 255"
    assert set(errors_of(paint, Scene((CUBE,)))) == {"order", "shades"}


@pytest.mark.slow
def test_triangles_and_shadow_maps_measure_how_far_off_they_are() -> None:
    scene = Scene((replace(RING, shape=Torus(1.2, 0.5)), replace(PANE, material=Material())), (SUN,))
    small = {"size": (60, 40), "samples": 1}
    fine, coarse = (errors_of(render, scene, shadows="buffer", shadow_size=n, **small) for n in (256, 16))
    assert 0.02 < fine["facets"][0] <= 0.2 and fine["facets"][1] == "samples"
    assert 0.0 < 2.0 * fine["shadows"][0] < coarse["shadows"][0] < 40.0
    assert "shadows" not in errors_of(render, scene, shadows="exact", **small)


@pytest.mark.parametrize("name", ["pencil", "town"])
def test_the_scenes_that_come_with_the_package(name: str) -> None:
    scene = read(DATA / f"{name}.scene")
    stages: list[StageReport] = []
    paint(scene, explain=stages.append)
    assert [stage.name for stage in stages if stage.error is None] == (
        PLAIN if name == "pencil" else with_stages("shadows")
    )
    assert bool(scene.lights) == (name == "town")


LOADED = """
import os, sys
import numpy as np
import vectorplot as vp
from vectorplot.pictures.paint import paint
for scene_code in {codes}:
    sys.stdout.flush()
    if not os.fork():
        exec(scene_code)
        paint(scene)
        kept = ("vectorplot.", "scipy", "shapely", "cairo", "svgwrite")
        print(*(name for name in sys.modules if name.startswith(kept)), flush=True)
        os._exit(0)
    assert os.wait()[1] == 0
"""
"""Each scene is painted by a process of its own, a copy of one that has loaded what all of them begin with."""

CUBE_TEXT = "from vectorplot.testing.shapes import box\nitem = vp.Item('A', box((0, 0, 0), (1, 1, 1)){more})\n"


def cube_text(more: str = "", lights: str = "()") -> str:
    """A scene of a cube, as Python."""
    return CUBE_TEXT.format(more=more) + f"scene = vp.Scene((item,), {lights})"


@cache
def every_loaded() -> dict[str, set[str]]:
    """The modules that painting each scene in a new process loads."""
    code = LOADED.format(codes=list(SCENES.values()))
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=600)
    return dict(zip(SCENES, map(set, map(str.split, found.stdout.splitlines())), strict=True))


def effects_of(modules: set[str]) -> set[str]:
    return {name.removeprefix("vectorplot.effects.") for name in modules if name.startswith("vectorplot.effects.")}


@pytest.mark.slow
def test_a_scene_without_lights_mirrors_patterns_and_clear_things_loads_no_effect() -> None:
    modules = every_loaded()["pencil"]
    assert not {name for name in modules if name.startswith("vectorplot.effects")}
    assert not {name.split(".")[0] for name in modules} & {"cairo", "svgwrite"}
    assert not {name for name in modules if name.startswith("vectorplot.backends")}


@pytest.mark.slow
def test_a_single_body_needs_nothing_heavy() -> None:
    modules = every_loaded()["cube"]
    assert not {name.split(".")[0] for name in modules} & {"cairo", "svgwrite", "scipy"}
    assert not effects_of(modules)


EFFECTS = {
    "shadows": ("", "(vp.Light((1, -2, 3)),)", "shadows"),
    "patterns": (
        ", patterns=(vp.Pattern('P', 'red', 1, np.array([(0, 0), (1, 0), (0, 1)])),)",
        "()",
        "patterns",
    ),
    "mirrors": (", material=vp.Material('mirror')", "()", "reflection_fills"),
    "glass": (", material=vp.Material('transparent', 0.5, 1.4), occludes=False", "()", "glass"),
}
SCENES = {
    "pencil": f"from vectorplot.io.read_file import read\nscene = read({str(DATA / 'pencil.scene')!r})",
    "cube": cube_text(),
    "clear": cube_text(", material=vp.Material('transparent', 0.5), occludes=False"),
    **{effect: cube_text(more, lights) for effect, (more, lights, _) in EFFECTS.items()},
}


@pytest.mark.slow
@pytest.mark.parametrize("effect", EFFECTS)
def test_an_effect_loads_its_own_code_and_not_that_of_the_others(effect: str) -> None:
    own, found = EFFECTS[effect][2], effects_of(every_loaded()[effect])
    assert own in found
    others = {module for name, (_, _, module) in EFFECTS.items() if name != effect}
    assert not found & (others - {own}), found


@pytest.mark.slow
def test_transparency_without_refraction_loads_no_effect() -> None:
    assert not effects_of(every_loaded()["clear"])


def test_what_overflows_in_a_stage_is_infinite_without_a_warning() -> None:
    walk = Pipeline((Stage("look", "always"),), None, None)
    assert walk.run("look", lambda: np.float64(1e200) * np.array([1e200]))[0] == np.inf
    with pytest.warns(RuntimeWarning, match="invalid"):
        walk.run("look", lambda: np.array([np.inf]) - np.inf)
