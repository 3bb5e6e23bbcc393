"""Hatched scenes against rays: no stroke beside its faces, none missing on them; and every way to ask for it."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.paths import DATA
from support.scene_rays import faces_of, lacking, page_rays

import vectorplot as vp
from vectorplot import surfaces
from vectorplot.drawing.hatching import LEAST_MM
from vectorplot.geometry import box
from vectorplot.geometry.polylines import segments
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.pictures.hatching import BEHIND
from vectorplot.scene.page import Page

PAGE = Page(200.0, 140.0, 0.0)
NEAR = 0.03


def strokes_of(drawing: vp.Drawing) -> vp.Paths:
    (paths,) = [paths for layer in drawing.layers if layer.name.startswith("hatch") for paths in layer.strokes]
    return paths


def seen_items(scene: vp.Scene, places: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The item and the face at places of the page, and where that is."""
    faces = faces_of(scene)
    origin, way = page_rays(scene.camera, PAGE, places, float(np.ptp(scene.vertices, axis=0).sum()))
    face, point = faces.first(origin, way)
    return np.where(face >= 0, faces.item[face], -1), face, point


@pytest.mark.slow
@pytest.mark.parametrize("along", ["page", "surface"])
def test_strokes_are_where_rays_meet_their_items_and_end_where_these_do(along: str) -> None:
    town = vp.read(DATA / "town.scene")
    even = vp.Hatching("even", spacing_mm=2.0, angle_deg=31.0, along=along)
    strokes = strokes_of(vp.draw(town, page=PAGE, fit=False, lines="none", hatch=even))
    lines = strokes.points.reshape(-1, 2, 2)
    length = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)
    way = (lines[:, 1] - lines[:, 0]) / length[:, None]
    long = length > 4.0 * NEAR
    lines, way, item = lines[long], way[long], strokes.item[long]
    inside = [lines[:, 0] + NEAR * way, lines.mean(axis=1), lines[:, 1] - NEAR * way]
    wrong = sum((seen_items(town, places)[0] != item).sum() for places in inside)
    assert len(item) > 400 and wrong == 0
    if along == "page":
        far = NEAR + BEHIND * even.width_mm
        within = [((p > far) & (p < (200.0 - far, 140.0 - far))).all(axis=1) for p in lines.transpose(1, 0, 2)]
        for end, sign, ok in ((lines[:, 0], -1.0, within[0]), (lines[:, 1], 1.0, within[1])):
            same = [seen_items(town, (end + sign * step * way)[ok])[0] == item[ok] for step in (NEAR, far)]
            # A corner that sticks out by less may come back at once, and so may what is behind a narrow thing.
            assert (same[0] & same[1]).sum() <= 8
            assert 20 < same[0].sum() < 0.5 * ok.sum(), "before what is in front of them strokes end"


@pytest.mark.slow
def test_no_stroke_is_missing_where_rays_meet_an_item() -> None:
    town = vp.read(DATA / "town.scene")
    spacing = 2.0
    even = vp.Hatching("even", spacing_mm=spacing, angle_deg=0.0)
    strokes = strokes_of(vp.draw(town, page=PAGE, fit=False, lines="none", hatch=even))
    random = np.random.default_rng(5)
    rows = random.integers(0, int(140.0 / spacing), 1500)
    places = np.stack([random.uniform(1.0, 199.0, 1500), (rows + 0.5) * spacing], axis=1)
    item = seen_items(town, places)[0]
    sure = item >= 0
    # Strokes end before what is in front, and none is as short as a speck.
    along = BEHIND * even.width_mm + LEAST_MM
    for shift in ((NEAR, 0.0), (-NEAR, 0.0), (0.0, NEAR), (0.0, -NEAR), (along, 0.0), (-along, 0.0)):
        sure &= seen_items(town, places + shift)[0] == item
    tree = shapely.STRtree(shapely.linestrings(strokes.points.reshape(-1, 2, 2)))
    point, stroke = tree.query(shapely.points(places[sure]), predicate="dwithin", distance=1e-6)
    found = strokes.item[stroke] == item[sure][point]
    assert sure.sum() > 400 and np.unique(point[found]).size == sure.sum()


@pytest.mark.slow
def test_strokes_lie_closer_in_shadows() -> None:
    """The largest distances to a stroke on the ground, in the light of both lamps and in the shadow of the sun."""
    town = vp.read(DATA / "town.scene")
    strokes = strokes_of(vp.draw(town, page=PAGE, fit=False, lines="none", hatch=vp.Hatching("tone")))
    random = np.random.default_rng(6)
    places = random.uniform((30.0, 20.0), (170.0, 110.0), (2500, 2))
    item, face, point = seen_items(town, places)
    eye, faces = np.asarray(town.camera.eye), faces_of(town)
    dark, sure = lacking(faces, town, face, point, point - eye)
    sure &= (item == 0) & (faces.normal[face][:, 2] > 0.9)
    for shift in np.array([(1, 0), (-1, 0), (0, 1), (0, -1)]) * 0.7:
        _, there, other = seen_items(town, places + shift)
        sure &= (there == face) & (lacking(faces, town, there, other, other - eye)[0] == dark)
    parts = segments(strokes)
    tree = shapely.STRtree(shapely.linestrings(strokes.points[parts]))

    def farthest(some: np.ndarray) -> float:
        spots = shapely.points(places[some])
        assert len(spots) > 20
        return float(shapely.distance(spots, tree.geometries[tree.nearest(spots)]).max())

    assert farthest(sure & (dark == 1)) < 0.8 * farthest(sure & (dark == 0))


@pytest.mark.slow
def test_items_may_be_hatched_in_ways_of_their_own() -> None:
    text = "A red box 1 1 1 hatch even spacing 1 cross angle -30 along surface width 0.25\n"
    text += "B blue box 1 1 1 translation 2 0 0 hatch none\n"
    text += "C green box 1 1 1 translation 4 0 0\n"
    scene = parse_scene(text)
    assert [item.hatch for item in parse_scene(write_scene(scene)).items] == [item.hatch for item in scene.items]
    assert [item.hatch for item in scene.items] == [
        vp.Hatching("even", 1.0, -30.0, True, "surface", 0.25),
        vp.Hatching("none"),
        None,
    ]
    assert set(strokes_of(vp.draw(scene)).item.tolist()) == {0}
    drawing = vp.draw(scene, hatch=vp.Hatching("colour"), layers="colour")
    named = {layer.name: layer.pen for layer in drawing.layers if layer.name.startswith("hatch")}
    assert {name: pen.width_mm for name, pen in named.items()} == {"hatch red 0.25": 0.25, "hatch green 0.18": 0.18}


@pytest.mark.slow
def test_all_strokes_of_a_round_body_in_a_shadow_are_on_its_lines() -> None:
    balls = (surfaces.Sphere(1.2, (0, 0, 0)), surfaces.Sphere(1.2, (0, 0, 3)), surfaces.Sphere(1.2, (3, 0, 0)))
    items = tuple(vp.Item(f"ball{k}", ball) for k, ball in enumerate(balls))
    scene = vp.Scene(items, lights=(vp.Light((30, -20, 60)),))
    hatching = vp.Hatching(spacing_mm=0.8, angle_deg=0.0)
    strokes = strokes_of(vp.draw(scene, vp.Camera((40, -50, 35), (1, 0, 1)), page="A6", lines="none", hatch=hatching))
    line = strokes.points[:, 1] / 0.8 - 0.5
    assert len(strokes) > 100 and np.abs(line - np.rint(line)).max() < 1e-6


def test_clear_things_that_hide_lines_hide_tones():
    def strokes(material):
        jar = vp.Item("jar", box((2, 2, 3)), "cyan", material, occludes=True)
        scene = vp.Scene((jar, vp.Item("inside", box((1, 1, 1)).moved(0.5, 0.5, 0.5), "black")))
        drawing = vp.draw(scene, "iso", page="40x40", hatch=vp.Hatching("colour"))
        return [layer.strokes for layer in drawing.layers if layer.name == "hatch"]

    glass, solid = strokes(vp.Material("normal", 0.3)), strokes(vp.Material("normal"))
    np.testing.assert_array_equal(glass[0][0].points, solid[0][0].points)
