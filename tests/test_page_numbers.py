"""The numbers that pages of docs/ state are those of the code: each text below stands on its page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from support.paths import ROOT

import vectorplot as vp
from vectorplot.backends import shaded_triangles, svg
from vectorplot.curves.derivatives import FENCE
from vectorplot.drawing.drawing import Pen
from vectorplot.drawing.fill_visibility import MOST_CLEAR, MOST_LAYERS
from vectorplot.drawing.fills import SEAM_MM, FillKind
from vectorplot.drawing.pens import PENS
from vectorplot.effects import glass, soft_shadows
from vectorplot.effects.shadow_casters import EACH, SAMPLE
from vectorplot.effects.shadows import MANY_CELLS, MOST_CELLS, MOST_LIGHTS
from vectorplot.features import geodesic_curves, parameter_curves, surface_integration
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.hole_rims import FINER
from vectorplot.features.intersection_tracing import LARGEST_LOOP
from vectorplot.features.surface_singularities import COLUMNS, ROWS
from vectorplot.geometry.budget import PAIRS_OF_EACH, USUAL
from vectorplot.geometry.projections import FARTHEST_OFF_AXIS_DEG, ULPS
from vectorplot.io import molecules
from vectorplot.pictures import pixels, plan
from vectorplot.pictures.plan import plan_bodies, plan_paint, plan_surface_bands
from vectorplot.save import write
from vectorplot.scene import pens
from vectorplot.shading import (
    facet_resolution,
    illumination,
    image,
    palettes,
    scene_pixels,
    screen,
    shade_bands,
    shadow_maps,
)
from vectorplot.shading.painted_colours import VARIED
from vectorplot.shading.pixel_coverage import SUBPIXELS
from vectorplot.surfaces import Sphere
from vectorplot.testing.rays import CELLS
from vectorplot.tolerances import (
    ARC_OF_TOLERANCE,
    COINCIDENT_MM,
    COLLINEAR_MM,
    EXACT_MM,
    INTEGRATED_AS_DRAWN,
    NEAR_OF_DISTANCE,
    RESOLUTION,
    RIM_SEEN_FROM,
    TOUCHING_OF_EXTENT,
    ZERO_OF_EXTENT,
)
from vectorplot.visibility.painter.face_splitting import PIECES_OF_EACH, PIECES_OF_TREES
from vectorplot.visibility.painter.height_fields import MOST_BORDER, SHARE_LEFT_OUT
from vectorplot.visibility.painter.painters_order import OF_EACH, pairs_allowed
from vectorplot.visibility.polyhedra.occluders import MAX_SOLID_FACES
from vectorplot.words import LineKind


def percent(part: float) -> str:
    return f"{100.0 * part:g} %"


def mm(microns: float) -> str:
    return f"{microns / 1000.0:g} mm"


NUMBERS = {
    "accuracy-and-limits": (
        f"{ZERO_OF_EXTENT:.0e} of the extent of the scene, and never less than {ULPS:g} rounding steps",
        f"strokes on the page that are drawn once | {COINCIDENT_MM:.4f} mm",
        f"the straight line it is left out of | {COLLINEAR_MM:.4f} mm",
        f"of {pixels.PLACES:,} places on faces",
        f"{NEAR_OF_DISTANCE:.0e} of the smaller",
        f"more than {FARTHEST_OFF_AXIS_DEG:g} degrees off the principal ray",
        f"up to {MAX_SOLID_FACES} faces",
        f"a grid of {FINER * Tracing.columns} by {FINER * Tracing.rows} cells",
        f"a loop smaller than three cells of a grid of {COLUMNS} by {ROWS}",
        f"decided by distances of {TOUCHING_OF_EXTENT:.0e} of the extent",
        f"around the curves of one kind | {USUAL.cells:,} |",
        f"is cut into around them | {USUAL.triangles:,} |",
        f"of more than {parameter_curves.LINES_A_BUDGET} parameter lines, each a sixteenth of it | {USUAL.points:,} |",
        f"or {USUAL.pairs // PAIRS_OF_EACH} for each chord or sight line | {USUAL.pairs:,} |",
        f"is painted or rendered by | {USUAL.facets:,} |",
        f"to find their order; or {OF_EACH} for each face | {pairs_allowed(USUAL.pairs, 0):,} |",
        f"or {PIECES_OF_EACH} for each face | {USUAL.pieces:,} |",
        f"to blend those of one item as one | {USUAL.pairs:,} |",
        f"are looked for | {USUAL.windows:,} |",
        f"or {EACH} for each face | {USUAL.pairs:,} |",
        f"more than {shaded_triangles.MOST_NEAR} boxes around each side",
        f"a grid of 1/{SUBPIXELS} pixel",
        f"how many they are is told by {SAMPLE} faces of the item",
        f"no more than {shaded_triangles.ALIKE:g} of 255, may one go {mm(shaded_triangles.BEYOND_MICRONS)} beyond",
        f"has no more than {MOST_BORDER:,} sides on its border",
        f"add up to {INTEGRATED_AS_DRAWN:.0e} of the surface's extent",
        f"those of {geodesic_curves.DIRECTIONS} all round",
    ),
    "drawing": (
        f"{', '.join(f'{pen.width_mm:g}' for pen in PENS.values())} mm, black",
        f"{pens.FINEST_MM:g} to {pens.WIDEST_MM:g}, or have a unit",
        f"2 to {pens.MOST_STEPS}), each over an equal part",
        f"{EXACT_MM:.4f} mm, which is proven from the polynomials",
        f"{image.DPI:g} dots per inch, white paper",
        f"(around corners {mm(shaded_triangles.AROUND_MICRONS)})",
        f"{mm(shaded_triangles.APART_MICRONS)} apart at most",
        f"that are not convex it is {mm(shaded_triangles.HOLLOW_MICRONS)}",
        f"thinner than {mm(shaded_triangles.THIN_MICRONS)}, are also stroked, {SEAM_MM:g} mm wide",
        f"no colour is more than {svg.SHADE_ERROR:g} of 255 steps off",
        f"shorter than {mm(svg.SMALLEST_MICRONS)} or narrower than {mm(svg.NARROWEST_MICRONS)}",
    ),
    "paint": (
        f"by more than two of {palettes.PALETTE_SIZE} shades",
        f"Faces with more than {MOST_LAYERS} polygons on them, or more than {MOST_CLEAR} that one can see through",
        f"off by {facet_resolution.DEEP:g} times that, but by no more than {facet_resolution.DEEPEST_MM:g} mm",
        f"more than {USUAL.pieces:,} cuts",
        f"A palette has {palettes.PALETTE_SIZE} shades; `--palette N` gives it 2 to 256",
        f"At most {MOST_LIGHTS} lights cast shadows; from {MANY_CELLS:,} cells",
        f"more than {MOST_CELLS:,} are refused",
        f"in bodies of at most {glass.MOST_FACES} faces",
        f"have more than {MAX_SOLID_FACES} faces are transparent",
    ),
    "render": (
        f"`--margin-pixels`, {percent(pixels.MARGIN)} of the shorter side",
        f"against steps along edges; {pixels.SAMPLES} without it",
        f"{image.DPI:g} dots per inch",
        f"the next power of two, {pixels.FEWEST_TEXELS} to {pixels.MOST_TEXELS}",
        f"up to {shadow_maps.LONGEST:g} to 1, at the same number of texels",
        f"at most {screen.LARGEST_SIDE_PIXELS} pixels along a side",
        f"At most {scene_pixels.MOST_MIRRORS} mirroring faces are looked into",
    ),
    "molecules": (
        f"and {molecules.BOND_SLACK:g} angstrom, and {molecules.LEAST_BOND:g} or more",
        f"in one place, to {molecules.SAME_PLACE:g} angstrom",
    ),
    "python": (f"a grid of {CELLS[0]} x {CELLS[0]} parameters, then {CELLS[1]} x {CELLS[1]}",),
}


@pytest.mark.parametrize("page", NUMBERS)
def test_the_numbers_of_a_page_are_those_of_the_code(page: str) -> None:
    text = re.sub(r"\s+", " ", (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8"))
    assert [said for said in NUMBERS[page] if said.replace("e-0", "e-") not in text] == []


def test_numbers_that_pages_say_in_words_are_those_of_the_code() -> None:
    """A thousandth, a sixteenth, a fifth, ..."""
    assert ARC_OF_TOLERANCE == RESOLUTION == 1e-3
    assert LARGEST_LOOP == 3.0
    assert RIM_SEEN_FROM == 1e-9 and FENCE == 1.5
    assert PIECES_OF_TREES == 16 and SHARE_LEFT_OUT == 1.0 / 16.0
    assert surface_integration.CLOSED_OF_ERROR == 10.0
    assert 300.0 < shaded_triangles.REACH_MICRONS < 1000.0 / 3.0
    assert illumination.DIRECT_SHARE == 0.8 and illumination.DARK_SIDE == 0.3 and illumination.SHADOW_SHARE == 0.5
    assert illumination.LEAST_REACH == 0.25
    assert VARIED == 2.0 / palettes.PALETTE_SIZE
    assert facet_resolution.SHADE_ERROR == 2.0 / 255.0 and facet_resolution.SHADE_LIMITS == (0.5, 4.0)
    assert (facet_resolution.DEEP_IN_LIGHT, facet_resolution.LEAST_DEEP) == (3.0, 5.0)
    assert (shade_bands.MIDDLING_MM, shade_bands.NARROWEST, shade_bands.WIDEST) == (10.0, 0.5, 2.0)
    assert plan.DEEP == 2.0 and soft_shadows.LEVELS == 9
    assert molecules.BALL_OF_RADIUS == 0.25
    assert Pen().width_mm == 0.3
    assert screen.LARGEST_RASTER_PIXELS == 1 << 27 and shadow_maps.MOST_TEXELS == 1 << 28


def test_kinds_layers_and_fills_of_a_drawing_stand_on_its_page() -> None:
    text = (ROOT / "docs" / "drawing.md").read_text(encoding="utf-8")
    rows = text.partition("## Kinds of lines")[2].partition("A line that is several things")[0]
    assert re.findall(r"`(\w+)`", "".join(re.findall(r"^\|([^|]*)\|", rows, re.M))) == [kind.word for kind in LineKind]
    assert ", ".join(f"`{number} {name}`" for number, name in enumerate(PENS, 1)) in re.sub(r" \([^)]*\)", "", text)
    assert {kind.name.lower() for kind in FillKind} <= set(re.findall(r"\w+", text.partition("`kind` is")[2][:200]))


def test_the_table_of_materials_is_that_of_the_code() -> None:
    text = (ROOT / "docs" / "render.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \| ([\d.]+) \| ([\d.]+) \| ?([\d.]*)", text, re.MULTILINE)
    said = {word: (float(exponent), float(diffuse), float(sharp or 0)) for word, exponent, diffuse, sharp in rows}
    finishes = illumination.FINISHES.items()
    assert said == {word: (f.exponent, f.diffuse, f.sharpness if f.highlight else 0.0) for word, f in finishes}


def test_the_stages_of_paint_stand_on_its_page() -> None:
    text = (ROOT / "docs" / "paint.md").read_text(encoding="utf-8")
    table = text.partition("| stage | when |")[2].partition("\n\n")[0]
    stages = {name for row in re.findall(r"^\| ([^|]+) \|", table, re.MULTILINE) for name in row.split(", ")}
    lamp, mesh = vp.Light((1.0, 2.0, 3.0)), vp.geometry.box((1.0, 1.0, 1.0))
    glass_of, flag = vp.Material("transparent", refraction=1.5), vp.Pattern("", "red", 0, ((0, 0), (1, 0), (0, 1)))
    items = (
        vp.Item("mirror", mesh, material=vp.Material("mirror")),
        vp.Item("glass", mesh, material=glass_of, patterns=(flag,)),
        vp.Item("ball", Sphere(1.0)),
    )
    scenes = [vp.Scene(items, (lamp,)), vp.Scene(items[2:])]
    planned = {
        stage.name
        for scene in scenes
        for fills in ("painted", "visible", "erasing")
        for stage in plan_bodies(plan_paint(scene, "auto", fills, frozenset({LineKind.CONTOUR})))
    }
    planned |= {stage.name for stage in plan_surface_bands(plan_paint(scenes[0], "auto", "painted", frozenset()))}
    assert planned == stages - {"---"}


@pytest.mark.parametrize(
    ("row", "shape"),
    [
        ("sphere, in bands", "sphere 1"),
        ("torus", "torus 3 1"),
        ("Dupin's cyclide", "cyclide 3 1 centre 6.5 0 0 radius 5"),
    ],
)
def test_files_are_as_large_as_the_page_says(row: str, shape: str, tmp_path: Path) -> None:
    """Those in SVG at a tolerance of 0.2 mm, to five of a hundred."""
    text = (ROOT / "docs" / "paint.md").read_text(encoding="utf-8")
    said = re.search(rf"^\| {row} \|" + r" (?:\d+) \|" * 6 + r" (\d+) \|", text, re.MULTILINE)
    (tmp_path / "one.scene").write_text(f"S gray surface {shape}\n", encoding="utf-8")
    size = len(write(vp.paint(tmp_path / "one.scene", tolerance_mm=0.2), "svg")) / 1000.0
    assert said is not None and size == pytest.approx(float(said[1]), rel=0.05)
