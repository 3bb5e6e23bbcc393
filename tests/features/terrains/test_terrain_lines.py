"""Water, watersheds, roads and places of labels on terrains."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features
from vectorplot.errors import InputError
from vectorplot.features.mesh_lines import mesh_level_lines
from vectorplot.features.terrain_roads import roads
from vectorplot.features.terrain_water import places_on_terrain, valley_lines, watersheds
from vectorplot.geometry.rotations import rotation_z
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.terrains import terrain_mesh
from vectorplot.surfaces.terrains import terrain
from vectorplot.testing import curves_in_space


def land(function, half=4.0, scale=1.0, shift=0.0, count=81):
    places = np.linspace(-half, half, count)
    x, y = np.meshgrid(places, places, indexing="ij")
    ends = (shift - scale * half, shift + scale * half)
    return terrain_mesh(terrain(scale * function(x, y), ends, ends))


def cone(x, y):
    return 4.0 - np.hypot(x, y)


def hills(x, y):
    return np.sin(x) * np.cos(0.7 * y) + 0.3 * np.sin(2 * x + 1) * np.sin(1.3 * y)


def slopes(points):
    step = np.diff(points, axis=0)
    return step[:, 2] / np.linalg.norm(step, axis=1)


@pytest.mark.slow
@pytest.mark.capability("G9.5-landscape")
@pytest.mark.parametrize(("scale", "shift"), [(1.0, 0.0), (1e-5, 0.0), (1e4, 3e6)])
def test_roads_keep_their_slope_and_come_to_their_end_on_both_sides(scale, shift):
    start, end = np.array([3.0, 0.1]), np.array([0.2, 1.0])
    found = roads(land(cone, scale=scale, shift=shift, count=25), scale * start + shift, scale * end + shift)
    radii, turn = np.hypot(*np.array([start, end]).T), np.arctan2(1, 0.2) - np.arctan2(0.1, 3)
    # On a cone of 45 degrees a road is a logarithmic spiral in the plan: both come from how far it turns.
    exact = [np.arctan(1 / np.hypot(1.0, t / np.log(radii[0] / radii[1]))) for t in (2 * np.pi - turn, turn)]
    assert np.allclose(found.levels, exact, rtol=2e-2)
    for road, level in zip(found, found.levels, strict=True):
        assert np.abs(slopes(road) - np.sin(level)).max() < 1e-6
        assert np.allclose(road[[0, -1], :2], scale * np.array([start, end]) + shift, rtol=0, atol=1e-7 * scale + 1e-9)


@pytest.mark.slow
def test_roads_down_are_those_up_and_there_may_be_none():
    mesh = land(cone, count=17)
    up, down = roads(mesh, (3, 0.1), (0.2, 1)), roads(mesh, (0.2, 1), (3, 0.1))
    assert np.array_equal(up.levels, -down.levels)
    assert np.array_equal(up[0], down[0][::-1])
    for start, end, said in (
        ((3, 1), (3, 1), "both ends are in one place"),
        ((3, 1), (-3, 1), "of one height"),
        ((3, 1), (9, 1), "9 1 is not on the terrain"),
        ((3, np.nan), (1, 1), "two finite numbers"),
        ((3, 0), (-2, 0.1), "no road of constant slope"),
    ):
        with pytest.raises(InputError, match=said):
            roads(mesh, start, end, longest=6.0)


@pytest.mark.capability("G9.5-landscape")
def test_water_runs_down_to_pits_and_borders_and_is_steepest_on_its_way():
    mesh = land(hills)
    places = np.random.default_rng(1).uniform(-3.9, 3.9, (40, 2))
    found = features.water_courses(mesh, places)
    ends = np.array([course[-1] for course in found])
    low = mesh.vertices[:, 2]
    for k, course in zip(found.levels.astype(int), found, strict=True):
        assert np.allclose(course[0, :2], places[k], atol=1e-12)
        assert (np.diff(course[:, 2]) <= 1e-12).all()
    border = np.abs(ends[:, :2]).max(axis=1) > 4 - 1e-9
    for end in ends[~border]:
        near = np.hypot(*(mesh.vertices[:, :2] - end[:2]).T) < 0.25
        assert end[2] <= low[near].min() + 1e-9
    faces = mesh.corners.reshape(-1, 3)[found.faces[found.faces >= 0]]
    assert (mesh.vertices[faces].min(axis=1)[:, 2] <= found.points[found.faces >= 0, 2] + 1e-12).all()


@pytest.mark.slow
def test_watersheds_lead_from_saddles_to_summits_and_valleys_to_pits():
    # Two summits, a saddle between them, and the ground falls everywhere else.
    mesh = land(lambda x, y: -((x**2 - 4) ** 2) / 8 - y**2)
    for turn in (0.0, 0.5):
        turned = vp.Mesh(mesh.vertices @ rotation_z(turn), mesh.corners, mesh.offsets)
        up, down = watersheds(turned), valley_lines(turned)
        assert len(up) == len(down) == 2
        top = np.array([line[-1] for line in up]) @ rotation_z(-turn)
        assert np.allclose(top[np.argsort(top[:, 0])], [[-2, 0, 0], [2, 0, 0]], atol=1e-9)
        for line in up:
            assert np.allclose(line[0], [0, 0, -2], atol=1e-9)
            assert (np.diff(line[:, 2]) >= -1e-12).all()
        assert np.allclose(np.abs((np.array([line[-1] for line in down]) @ rotation_z(-turn))[:, :2]), [[0, 4]] * 2)
    assert len(watersheds(land(cone))) == 0
    assert len(watersheds(land(lambda x, y: 0 * x))) == 0


def test_every_place_has_a_basin_and_its_pit_is_in_it():
    heights = hills(*np.meshgrid(np.linspace(-4, 4, 60), np.linspace(-4, 4, 50), indexing="ij"))
    heights[20:24, 20:24] = np.nan
    basin = features.basins(heights)
    assert ((basin == -1) == np.isnan(heights)).all()
    pits = np.unique(basin[basin >= 0])
    assert np.array_equal(basin.ravel()[pits], pits)
    for pit in pits:
        assert heights.ravel()[pit] == np.nanmin(heights[basin == pit])
    assert len(np.unique(features.basins(np.zeros((7, 9))))) == 1


@pytest.mark.slow
def test_labels_stand_on_straight_parts_and_apart():
    mesh = land(hills, count=41)
    lines = mesh_level_lines(mesh, np.linspace(-1, 1, 9))
    found = features.label_places(lines, length=0.5, apart=1.0)
    assert len(found.heights) > 20
    assert np.allclose(found.points[:, 2], found.heights, atol=1e-9)
    assert (found.straightness >= 0.9).all()
    apart = np.linalg.norm(found.points[:, None] - found.points, axis=2) + 9 * np.eye(len(found.heights))
    assert apart.min() >= 1.0
    left = np.cross([0, 0, 1], found.directions)
    for point, way, height in zip(found.points, left, found.heights, strict=True):
        inside = np.abs(point[:2] + 0.1 * way[:2]).max() < 4
        assert not inside or places_on_terrain(mesh, point[:2] + 0.1 * way[:2])[1][0, 2] > height
    ring = mesh_level_lines(land(cone), [3.9])
    assert len(features.label_places(ring, length=0.5, apart=1.0).heights) == 0


TEXT = """HILLS terrain 0 1 0 0, 1 4 2 1, 0 2 6 1, 0 1 2 0 x 0 30 y 0 30 densified 4 exaggeration 0.5
  level_lines 6 index 3 watersheds valley_lines water 8 9, 21 12 road 3 11, 9 10.5
"""


def test_level_lines_of_exaggerated_terrains_have_round_heights_and_their_numbers():
    land = parse_scene("T terrain 0 33, 0 33 x 0 60 y 0 60 exaggeration 3 level_lines 6 numbered")
    written = [one for layer in vp.draw(land, "top", text="real").layers for one in layer.texts]
    assert {text for one in written for text in one.strings} == {"5", "10", "15", "20", "25", "30"}


@pytest.mark.slow
def test_words_of_scene_files():
    scene = parse_scene(TEXT)
    assert scene.bounds[1].tolist() == [30, 30, pytest.approx(3, abs=0.1)]
    drawing = vp.draw(scene, vp.Camera((10, -40, 40), (15, 15, 0)), hidden="solid")
    assert len(curves_in_space(drawing, kind="integral")) >= 4
    assert parse_scene(write_scene(scene)).items[0].curves == scene.items[0].curves
    moved = parse_scene(TEXT + "translation 100 0 0")
    with pytest.raises(InputError, match="HILLS: water: 8 9 is not on the terrain"):
        vp.draw(moved)
    points = parse_scene("DUNE terrain points 0 0 1, 4 0 2, 0 4 3, 4 4 2, 1 2 3 cells 8 8")
    assert points.items[0].shape.face_count == 128
    for text, said in (
        ("T terrain x 0 1 y 0 1", "expected 'heights' or 'points'"),
        ("T terrain 0 1, 1 0 cells 3 3", "'cells' are for points"),
        ("T terrain 0 1, 1", "row 2 of heights has 1, row 1 of heights has 2"),
        ("T terrain 0 1, 1 0 road 0 0, 1 1, 2 2", "road: 3 places, expected 2"),
        ("T surface sphere 1 watersheds", "are for terrains only"),
    ):
        with pytest.raises(InputError, match=said):
            parse_scene(text)
