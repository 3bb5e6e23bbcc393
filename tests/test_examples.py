"""The examples run and keep their promises; the gallery is complete and fresh."""

from __future__ import annotations

import importlib.util
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
from support.data_scenes import scenes_to_try
from support.paths import ROOT
from support.svg_fills import area, painted_by_layer
from support.svg_strokes import SVG, strokes_by_layer

import vectorplot as vp
from vectorplot.drawing.fills import FillKind
from vectorplot.pictures.plan import plan_draw, plan_paint
from vectorplot.testing import assert_drawing_is_right, edge_points
from vectorplot.testing.drawings import worst_uncovered
from vectorplot.words import DRAWN


def gallery_module():
    spec = importlib.util.spec_from_file_location("gallery_page", ROOT / "docs" / "gallery.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


GALLERY = gallery_module()
SCENES, EXAMPLES = GALLERY.scenes(), GALLERY.examples()
SAME_MM = 0.04
"""How far lines of pictures may be from those that are stored: twice what each may be off its true curve."""

SAME_HATCHES_MM = 0.2
"""And hatches, which end where a shade passes their own: a third of the usual distance between two of them."""


SMALL = 320
"""The width at which pictures of pixels are made anew that are stored large: a part of it without remainder."""

LENGTHS_AGREE = 2e-3
"""Part of all lines of a layer by which their lengths may differ: no line that counts is drawn twice, or lost."""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The files that each scene and script makes, each drawn once."""
    folder, files = tmp_path_factory.mktemp("gallery"), {}

    def draw(path):
        if path not in files:
            scene = path.suffix == ".scene"
            files[path] = GALLERY.draw_scene(path, folder) if scene else GALLERY.run_example(path, folder, SMALL)
        return files[path]

    return draw


def assert_is_whole(path: Path) -> None:
    """The picture is XML with strokes and polygons that lie on its page, or pixels of several colours."""
    if path.suffix == ".png":
        assert len(np.unique(pixels_of(path).astype(int) @ (1 << 16, 1 << 8, 1))) > 5, path.name
        return
    root = ElementTree.fromstring(path.read_bytes())
    width, height = (float(root.get(side).removesuffix("mm")) for side in ("width", "height"))
    marks = [points for layer in strokes_by_layer(root).values() for points in layer]
    marks += [points for layer in painted_by_layer(root).values() for points, _ in layer]
    assert root.tag == SVG + "svg" and marks
    points = np.concatenate(marks)
    off = (points < -0.01).any(axis=1) | (points > np.array([width, height]) + 0.01).any(axis=1)
    assert not off.any(), f"{path.name}: {points[off][0]}"


def pixels_of(path: Path) -> np.ndarray:
    """(rows, columns, 3) red, green and blue of a picture."""
    image = pytest.importorskip("PIL.Image")
    return np.asarray(image.open(path).convert("RGB")).astype(np.int16)


def means_over_squares(pixels: np.ndarray, side: int) -> np.ndarray:
    """(rows / side, columns / side, 3) the means of squares of so many pixels."""
    rows, columns = (count // side for count in pixels.shape[:2])
    return pixels[: rows * side, : columns * side].reshape(rows, side, columns, side, 3).mean(axis=(1, 3))


@pytest.mark.slow
@pytest.mark.parametrize("path", [*SCENES, *EXAMPLES], ids=lambda path: path.stem)
def test_every_scene_and_example_draws_whole_pictures(path, made):
    files = made(path)
    assert files
    for file in files:
        assert_is_whole(file)


@pytest.mark.slow
@pytest.mark.parametrize("path", [*SCENES, *EXAMPLES], ids=lambda path: path.stem)
def test_the_stored_pictures_are_the_ones_that_are_drawn_now(path, made):
    for file in made(path):
        stored = GALLERY.GALLERY / file.name
        assert stored.is_file(), "run: python docs/gallery.py"
        if stored.read_bytes() == file.read_bytes():
            continue
        if file.suffix == ".png":
            old, new = pixels_of(stored), pixels_of(file)
            # A pixel beside an edge may fall to the other side on another processor.
            most = 0.2 if old.shape == new.shape else 6.0
            old = means_over_squares(old, len(old[0]) // len(new[0]))
            assert old.shape == new.shape and np.abs(old - new).mean() < most, f"{file.name} is old"
            continue
        # Not the bytes: where two orders of the pen are equally good, another processor may round to the other one.
        assert sheet_of(stored) == sheet_of(file), f"{file.name} is old"
        assert_same_lines(stored, file)
        old, new = paint_by_layer(stored), paint_by_layer(file)
        assert old.keys() == new.keys(), f"{file.name} is old"
        for label, paint in old.items():
            assert paint == pytest.approx(new[label], rel=1e-2), f"{file.name} is old"


def test_stored_pictures_are_small():
    assert not [path.name for path in GALLERY.GALLERY.iterdir() if path.stat().st_size >= 650_000]


def paint_by_layer(path: Path) -> dict[str, np.ndarray]:
    """For each layer with filled polygons: how many there are, their area in mm², and that area times the mean of their
    red, green and blue."""
    layers = painted_by_layer(ElementTree.fromstring(path.read_bytes()))
    return {
        label: np.array([len(polygons), *sum(area(p) * np.append(1.0, colour / 255.0) for p, colour in polygons)])
        for label, polygons in layers.items()
    }


def sheet_of(path: Path) -> list[tuple[str, dict[str, str]]]:
    """All that a picture says of its page, its layers in their order, and the pens and colours of these."""
    # The names of what clips groups hold a sum over the bytes, which differ from processor to processor.
    root = ElementTree.fromstring(re.sub(rb"url\(#\w+\)", b"url()", path.read_bytes()))
    groups = [root, *root.iter(SVG + "g")]
    return [(group.tag, {name: value for name, value in group.items() if name != "id"}) for group in groups]


def assert_same_lines(old: Path, new: Path) -> None:
    """Every line of every layer of one picture is there in the other, and as often."""
    first, second = segments_by_layer(old), segments_by_layer(new)
    assert first.keys() == second.keys(), f"{new.name} is old"
    for label, lines in first.items():
        drawn, wanted = (np.linalg.norm(np.diff(part, axis=1), axis=2).sum() for part in (lines, second[label]))
        assert drawn == pytest.approx(wanted, rel=LENGTHS_AGREE, abs=1.0), f"{new.name} is old: {label} in length"
        for here, there in ((lines, second[label]), (second[label], lines)):
            found = worst_uncovered(here, there, SAME_HATCHES_MM if "hatch" in label else SAME_MM)
            assert found is None, f"{new.name} is old: {label} at {found}"


def segments_by_layer(path: Path) -> dict[str, np.ndarray]:
    """(n,2,2) what is drawn in each layer, under its label, as straight pieces in mm."""
    layers = strokes_by_layer(ElementTree.fromstring(path.read_bytes()))
    return {
        label: np.concatenate([np.zeros((0, 2, 2)), *(np.stack([p[:-1], p[1:]], axis=1) for p in strokes)])
        for label, strokes in layers.items()
    }


@pytest.mark.slow
def test_the_gallery_shows_nothing_else_and_its_page_is_fresh(made):
    names = {path: [file.name for file in made(path)] for path in (*SCENES, *EXAMPLES)}
    drawn = [name for pictures in names.values() for name in pictures]
    assert len(drawn) == len(set(drawn)), "two sources write one picture"
    stored = [path.name for path in GALLERY.GALLERY.iterdir() if path.suffix in (".svg", ".png")]
    assert sorted([*drawn, "pencil.png"]) == sorted(stored)
    page = GALLERY.GALLERY / "README.md"
    assert page.read_text(encoding="utf-8") == GALLERY.page(names), "run: python docs/gallery.py"


@pytest.mark.slow
@pytest.mark.capability("G2.3-fig7")
def test_the_roller_and_its_two_doubles_have_one_image(made):
    assert [file.stem for file in made(ROOT / "examples" / "roller.py")] == ["roller", "roller_t1", "roller_t2"]


@pytest.mark.slow
@pytest.mark.capability("G2.5-fig11")
def test_the_frustum_in_the_world_is_a_box_after_t2(made):
    assert len(made(ROOT / "examples" / "viewing_frustum.py")) == 2


@pytest.mark.slow
@pytest.mark.capability("G3.4-split")
def test_a_chess_pawn_falls_into_convex_parts_that_fill_it(made):
    assert len(made(ROOT / "examples" / "convex_parts.py")) == 2


PAINTED = {
    "1.1 and 1.2": "coordinates",
    "2.1, 2.4 and 2.5": "viewing_pyramid",
    "2.9": "nine_regions",
    "4.1": "subpalettes",
    "4.2 and 4.6": "depth_cueing",
    "4.3": "shading_angle",
    "4.4": "finishes",
    "4.5": "near_light",
    "4.7": "scan_lines",
    "5.1": "separating_plane",
    "5.2": "hollow_bodies",
    "5.3": "revolution_rings",
    "5.4 to 5.6": "sliced_surface",
    "5.4 and 5.6": "slices_apart",
    "5.7": "graph_cases",
    "5.8": "bounding_rectangles",
    "5.9": "soap_bubbles",
    "5.10": "outline_cases",
    "5.11": "mikado_order",
    "5.12": "object_groups",
    "5.13": "own_box",
    "6.1": "convex_hull",
    "6.2": "point_in_polygon",
    "6.3": "convex_clipping",
    "6.4": "shadow_clipping",
    "6.5": "convex_shadows",
    "6.6": "several_lights",
    "6.7": "mirror_doubles",
    "6.8": "two_mirrors",
    "6.9": "patterned_objects",
    "6.11": "parallel_planes",
    "6.12": "swimming_pool",
    "7.1": "erasing",
    "8.13": "surface_normal",
    "10.1": "packed_coordinates",
    "the trapezoid in the lamp's plane": "trapezoid_steps",
}
"""The figures of coordinates, of shading, of the painter's order, of shadows, mirrors, patterns and glass."""


@pytest.mark.slow
@pytest.mark.parametrize("figure", PAINTED)
def test_figures_of_painted_pictures_are_made_and_asserted(figure, made):
    path = ROOT / "examples" / f"{PAINTED[figure]}.py"
    assert made(path)
    assert "assert" in path.read_text(encoding="utf-8").partition("def main")[2]


@pytest.mark.slow
@pytest.mark.capability("G5.0-painter")
@pytest.mark.parametrize("name", sorted(GALLERY.PAINTED))
def test_scenes_are_painted_as_well(name, made):
    drawn, painted = made(ROOT / "data" / f"{name}.scene")
    assert not painted_by_layer(ElementTree.fromstring(drawn.read_bytes()))
    assert list(painted_by_layer(ElementTree.fromstring(painted.read_bytes()))) == ["1 fills"]


@pytest.mark.capability("G6.5-patterns")
def test_the_cube_with_patterns_shows_those_of_its_visible_faces():
    scene = vp.read(ROOT / "data" / "patterns.scene")
    (fills,) = vp.paint(scene).layers[0].fills
    patterns = fills.take(np.flatnonzero(fills.kind == FillKind.PATTERN))
    assert len(patterns) == 4
    on_top = np.abs(patterns.points3d[:, 2] - 10.0) < 1e-9
    assert on_top.sum() == 8, "the two polygons on the top are two of them"


def covered(fills, chosen):
    """The region that some polygons cover together."""
    rings = np.split(fills.points, fills.offsets[1:-1])
    return shapely.union_all([shapely.Polygon(rings[k]).buffer(0) for k in np.flatnonzero(chosen)], grid_size=1e-9)


@pytest.mark.slow
def test_the_town_has_two_lights_which_cast_shadows():
    town = vp.read(ROOT / "data" / "town.scene")
    assert len(town.lights) == 2
    (fills,) = vp.paint(town).layers[0].fills
    assert (fills.kind == FillKind.SHADOW).sum() > 100
    (bare,) = vp.paint(town, shadows="none").layers[0].fills
    assert (bare.kind == FillKind.FACE).all()
    # Shadows are cut out of the faces they lie on: what is painted of every item is the same, in other pieces.
    for item in np.unique(np.concatenate([bare.item, fills.item])).tolist():
        one, other = (covered(painted, painted.item == item) for painted in (bare, fills))
        assert one.symmetric_difference(other).area < 1e-4 * one.area


RENDERED = {
    "7.7": "depth_buffering",
    "8.18": "four_materials",
    "8.19": "shadow_buffering",
    "8.20": "nautilus_and_snail",
    "trapezoidal shadow maps": "shadow_maps",
}
"""The figures of pixels, and the scripts that render them and assert what they show."""


@pytest.mark.slow
@pytest.mark.capability("G8.6-nautilus", "R-demos")
@pytest.mark.parametrize("figure", RENDERED)
def test_figures_of_pixels_are_rendered_and_asserted(figure, made):
    path = ROOT / "examples" / f"{RENDERED[figure]}.py"
    assert all(file.suffix == ".png" for file in made(path))
    assert "assert" in path.read_text(encoding="utf-8").partition("def main")[2]


FIGURES = {
    "8.1": "loxodrome",
    "8.2": "cylinder_intersections",
    "8.3": "translation_surface",
    "8.4": "surfaces_of_revolution",
    "8.5": "helical_surfaces",
    "8.6": "rotoidal_surfaces",
    "8.7": "spiral_surfaces",
    "8.8": "minimal_surfaces",
    "8.8, its caption": "helicoid_to_catenoid",
    "8.9": "torus_parameters",
    "8.10": "dupin_cyclide",
    "8.11 and 8.12": "curve_tracing",
    "8.13 and 8.14": "contours",
    "8.15": "isophotes",
    "8.16": "torus_and_hyperboloid",
    "9.1 and 9.2": "akima_and_cubic",
    "9.3 and 9.6": "spline_surfaces",
    "9.4 and 9.5": "b_splines",
    "9.7": "function_graph",
    "9.8": "slope_lines",
    "9.9": "potential_surface",
}
"""The figures of mathematical curves and surfaces, and the scripts that draw them and assert what they show."""


@pytest.mark.slow
@pytest.mark.parametrize("figure", FIGURES)
def test_figures_of_curves_and_surfaces_are_drawn_and_asserted(figure, made):
    path = ROOT / "examples" / f"{FIGURES[figure]}.py"
    assert made(path)
    assert "assert" in path.read_text(encoding="utf-8").partition("def main")[2]


@pytest.mark.slow
@pytest.mark.capability("G9.3-contour")
def test_the_contour_polygon_converges_to_the_true_contour(made):
    assert made(ROOT / "examples" / "function_graph.py")


@pytest.mark.slow
@pytest.mark.capability("G3.6-demo")
def test_sample_intersections_have_their_pictures(made):
    sources = [ROOT / "data" / name for name in ("cubes.scene", "pencil.scene", "intersections.scene")]
    assert all(made(path) for path in [*sources, ROOT / "examples" / "sharpening.py"])


def test_what_the_book_and_the_examples_are_known_for_is_there():
    scenes = {path.stem for path in SCENES}
    assert scenes >= {
        *("pyramid", "cone", "cylinder", "rotsweep", "translational_sweep", "box", "cubes", "pencil", "town"),
        *("interpenetrating", "three_bars", "table", "tube"),
    }
    assert len(vp.read(ROOT / "data" / "town.scene").items) == 30 + 1, "thirty blocks on a plate"


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("path", scenes_to_try(), ids=lambda path: path.stem)
def test_rays_confirm_every_scene(path):
    read = vp.read(path)
    # Rays here are straight: what water bends is looked at in linework/test_refracted_lines.py.
    clear = [replace(item, lines=None, material=replace(item.material, refraction=1.0)) for item in read.items]
    scene = replace(read, items=tuple(clear))
    edges, _ = edge_points(scene, 300)
    drawing = vp.draw(scene, lines=(*DRAWN, "edges"), hidden="solid")
    # Where there are only smooth surfaces no edges must show, and rays that graze a surface decide nothing.
    samples, least = (400, 400) if len(edges) else (450, 180)
    assert assert_drawing_is_right(drawing, scene, scene.camera, samples=samples, must_show=edges) > least


def test_the_pencil_calls_for_no_effect():
    scene = vp.read(ROOT / "data" / "pencil.scene")
    assert scene.lights == ()
    assert [stage.name for stage in plan_paint(scene, "auto", "painted", frozenset())] == [
        "look",
        "faces",
        "order",
        "shades",
        "fills",
    ]
    stages = plan_draw(scene, frozenset(map(vp.LineKind.from_word, DRAWN)), "none", 0.0)
    assert {stage.name for stage in stages}.isdisjoint({"halo", "patterns", "counted lines", "shadows"})


def test_examples_are_short():
    lines = {
        path.stem: len(path.read_text(encoding="utf-8").splitlines()) for path in (*EXAMPLES, ROOT / "docs/gallery.py")
    }
    assert not [name for name, count in lines.items() if count > (170 if name == "gallery" else 90)]
