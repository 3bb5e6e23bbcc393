"""What is seen all round from a place: where it is on the page, and that it is what rays see."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from click.testing import CliRunner

import vectorplot as vp
from vectorplot.cli.commands.draw import draw
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.geometry import box
from vectorplot.pictures.panorama import bearings_and_elevations, with_chords
from vectorplot.scene import terrain_mesh
from vectorplot.surfaces import terrain


def hills(scale=1.0, move=(0.0, 0.0, 0.0)):
    x, y = np.meshgrid(np.linspace(0, 6, 26), np.linspace(0, 6, 26), indexing="ij")
    land = terrain(np.sin(1.7 * x) * np.cos(1.3 * y + 0.4 * x) + 0.05 * (x - 3) ** 2, x=(0, 6), y=(0, 6))
    mesh = terrain_mesh(land)
    return vp.Mesh(scale * mesh.vertices + np.array(move), mesh.corners, mesh.offsets)


def seen(drawing):
    return [paths for layer in drawing.layers if layer.name != "bearings" for paths in layer.strokes if len(paths)]


def first_hits(mesh, eye, ways):
    """(k,) how many times a way (k,3) the nearest triangle is off, infinite where there is none; plain Cramer."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.corners].reshape(-1, 3, 3), 1, 0)
    one, two, back = b - a, c - a, eye - a
    normal = np.cross(one, two)
    det = -(ways @ normal.T)
    u = ways @ np.cross(back, two).T * -1.0
    v = ways @ np.cross(one, back).T * -1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v, t = u / det, v / det, (back * normal).sum(axis=1) / det
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)
    return np.where(hit, t, np.inf).min(axis=1)


@pytest.mark.parametrize(("scale", "move"), [(1.0, (0, 0, 0)), (1e-5, (0, 0, 0)), (1e3, (4e6, -2e6, 500))])
def test_every_line_of_a_panorama_is_where_it_is_and_nothing_stands_before_it(scale, move):
    mesh = hills(scale, move)
    eye = scale * np.array((3.05, 2.9, 1.2)) + np.array(move)
    item = vp.Item("LAND", mesh, lines=("contour", "boundary"))
    drawing = vp.panorama(item, vp.Panorama(tuple(eye), strips=1, lowest_deg=-60), page="400x200")
    paths = concatenated(tuple(seen(drawing)))
    ways = paths.points3d - eye
    radius = 380.0 / (2.0 * np.pi)
    bearing = np.mod(np.arctan2(ways[:, 0], ways[:, 1]), 2.0 * np.pi)
    off = np.abs(paths.points[:, 0] - 10.0 - radius * bearing)
    assert np.minimum(off, 380.0 - off).max() < 2e-3
    level = paths.points[:, 1] - radius * np.arctan2(ways[:, 2], np.hypot(ways[:, 0], ways[:, 1]))
    assert np.ptp(level) < 2e-3, "elevations are measured from one horizon"
    last = np.zeros(len(ways), dtype=bool)
    last[paths.offsets[1:] - 1] = True
    first = np.flatnonzero(~last)
    middles = 0.5 * (ways[first] + ways[first + 1])
    assert (first_hits(mesh, eye, middles) > 1.0 - 1e-6).all(), "nothing stands before it"
    assert len(paths) > 10


def test_contours_of_a_panorama_are_all_that_rays_see_of_the_horizon():
    mesh, eye = hills(), np.array((3.05, 2.9, 0.9))
    drawing = vp.panorama(vp.Item("LAND", mesh), vp.Panorama(tuple(eye), strips=1, lowest_deg=-70), page="400x200")
    radius = 380.0 / (2.0 * np.pi)
    points = np.concatenate([paths.points for paths in seen(drawing)])
    solid = np.concatenate([paths.points3d for paths in seen(drawing)]) - eye
    horizon = np.median(points[:, 1] - radius * np.arctan2(solid[:, 2], np.hypot(*solid[:, :2].T)))
    for bearing in np.linspace(0.05, 6.2, 40):
        x = 10.0 + radius * bearing
        highest = -np.inf
        for paths in seen(drawing):
            for k in range(len(paths)):
                line = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
                if line[:, 0].min() <= x <= line[:, 0].max():
                    order = np.argsort(line[:, 0])
                    highest = max(highest, np.interp(x, *line[order].T))
        up = (highest - horizon) / radius
        ways = [np.array([np.sin(bearing), np.cos(bearing), np.tan(up + nudge)]) for nudge in (-2e-3, 2e-3)]
        below, above = first_hits(mesh, eye, np.array(ways))
        assert np.isfinite(below)
        assert np.isinf(above)


def length(drawing):
    total = 0.0
    for paths in seen(drawing):
        inner = np.ones(len(paths.points), dtype=bool)
        inner[paths.offsets[1:] - 1] = False
        way = np.diff(paths.points, axis=0, append=np.zeros((1, 2)))
        total += np.linalg.norm(way[inner], axis=1).sum()
    return total


def test_strips_go_on_where_they_are_cut_and_a_part_of_the_round_is_that_part():
    scene = vp.Item("LAND", hills(), lines=("contour",))
    whole, cut = (
        vp.panorama(scene, vp.Panorama((3.0, 3.0, 1.0), strips=n), page=page)
        for n, page in ((1, vp.Page(380, 900, 0)), (4, vp.Page(95, 900, 0)))
    )
    assert length(cut) == pytest.approx(length(whole), rel=1e-4)
    half = vp.panorama(scene, vp.Panorama((3.0, 3.0, 1.0), strips=1, middle_deg=90, width_deg=60), page="400x200")
    for paths in seen(half):
        bearing = np.degrees(np.arctan2(paths.points3d[:, 0] - 3.0, paths.points3d[:, 1] - 3.0))
        assert bearing.min() >= 60 - 1e-6
        assert bearing.max() <= 120 + 1e-6


def test_towers_stand_at_their_bearings():
    tower = box((1, 1, 2))
    places = {"E": (9.5, -0.5, -1), "N": (-0.5, 9.5, -1)}
    towers = [vp.Item(name, replace(tower, vertices=tower.vertices + place)) for name, place in places.items()]
    drawing = vp.panorama(towers, vp.Panorama((0.0, 0.0, 0.0), strips=1), page="400x200")
    radius = 380.0 / (2.0 * np.pi)
    for number, bearing in enumerate((90.0, 0.0)):
        x = np.concatenate(
            [paths.points[np.repeat(paths.item == number, np.diff(paths.offsets)), 0] for paths in seen(drawing)]
        )
        turned = np.mod((x - 10.0) / radius - np.radians(bearing) + np.pi, 2.0 * np.pi) - np.pi
        assert np.abs(turned).max() == pytest.approx(np.arctan2(0.5, 9.5), abs=1e-9)


def test_chords_are_as_near_as_they_are_asked_to_be():
    eye = np.array([10.0, -4.0, 2.0])
    ends = eye + np.array([(1.0, 1.0, 0.2), (1.0, -1.0, 0.9)])
    ahead = np.array([1.0, 0.0, 0.0])
    flat = bearings_and_elevations(ends - eye, ahead, 0.5 * np.pi)
    drawing = vp.draw(vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    one = next(paths for layer in drawing.layers for paths in layer.strokes if len(paths))
    two = replace(
        chosen(one, np.array([0])),
        points=flat,
        points3d=ends,
        offsets=np.array([0, 2]),
        directions=np.full((2, 2), np.nan),
        handles=np.full((2, 2), np.nan),
        closed=np.array([False]),
    )
    counts = []
    for apart in (1e-2, 1e-3, 1e-4):
        parts = with_chords(two, eye, apart)
        counts.append(len(parts))
        solid = parts.points3d.reshape(-1, 2, 3)
        inner = bearings_and_elevations(solid.mean(axis=1) - eye, ahead, 0.5 * np.pi)
        chord = parts.points.reshape(-1, 2, 2)
        way = chord[:, 1] - chord[:, 0]
        aside = way[:, 0] * (inner - chord[:, 0])[:, 1] - way[:, 1] * (inner - chord[:, 0])[:, 0]
        assert np.abs(aside / np.linalg.norm(way, axis=1)).max() < apart
    assert counts[0] < counts[1] < counts[2]


def _ground(mesh):
    below = np.array([3.0, 3.0, -50.0])
    return float(first_hits(mesh, below, np.array([(0.0, 0.0, 1.0)]))[0]) - 50.0


def test_a_place_on_a_terrain_is_above_it():
    mesh = hills()
    item = vp.Item("LAND", mesh)
    above, given = (
        vp.Panorama(place, height) for place, height in (((3.0, 3.0), 2.0), ((3.0, 3.0, 2.0 + _ground(mesh)), None))
    )
    first, second = (seen(vp.panorama(item, one)) for one in (above, given))
    assert all(np.allclose(a.points, b.points, atol=1e-9) for a, b in zip(first, second, strict=True))
    with pytest.raises(vp.InputError, match="9 9 is not on the terrain"):
        vp.panorama(item, (9.0, 9.0))
    with pytest.raises(vp.InputError, match="give the place a height"):
        vp.panorama(vp.Item("BALL", box((1, 1, 1))), (9.0, 9.0))


@pytest.mark.parametrize(
    ("given", "cause"),
    [
        ({"place": (1,)}, "two or three"),
        ({"place": (1, 2, 3), "above": 1.0}, "above nothing"),
        ({"place": (1, 2), "above": np.inf}, "finite height"),
        ({"place": (1, 2), "width_deg": 361}, "at most 360"),
        ({"place": (1, 2), "strips": 0}, "1 to 36"),
        ({"place": (1, 2), "lowest_deg": 10, "highest_deg": 5}, "rise"),
        ({"place": (1, 2), "middle_deg": np.nan}, "finite bearing"),
    ],
)
def test_bad_panoramas_are_told(given, cause):
    with pytest.raises(vp.InputError, match=cause):
        vp.Panorama(**given)


def test_wireframes_are_no_panoramas():
    with pytest.raises(vp.InputError, match="shows all lines"):
        vp.panorama(vp.Item("LAND", hills()), (3.0, 3.0), style="wireframe")


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        (["--panorama", "1,1", "--eye", "1,2,3"], "--eye does not go with --panorama"),
        (["--panorama", "1,1", "--hidden", "dashed"], "--hidden does not go with --panorama"),
        (["--panorama", "1,1", "--hatch", "tone"], "--hatch does not go with --panorama"),
        (["--panorama", "1,1", "--no-fit"], "--no-fit does not go with --panorama"),
        (["--panorama", "1"], "not X,Y or X,Y,Z"),
        (["--strips", "2"], "--strips goes with --panorama"),
    ],
)
def test_what_does_not_go_with_a_panorama_is_bad_usage(tmp_path, words, cause):
    heights = tmp_path / "hill.asc"
    heights.write_text("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n2 3 2\n3 1 3\n2 3 2\n")
    out = tmp_path / "round.svg"
    result = CliRunner().invoke(draw, [str(heights), "-o", str(out), *words])
    assert (result.exit_code, out.exists()) == (2, False)
    assert cause in result.output


@pytest.mark.slow
def test_the_command_draws_what_the_function_draws(tmp_path):
    heights = tmp_path / "hill.asc"
    heights.write_text("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n2 3 2\n3 1 3\n2 3 2\n")
    out, own = tmp_path / "round.svg", tmp_path / "own.svg"
    words = ["--panorama", "1.5,1.4", "--strips", "2", "--title", "Round", "--frame"]
    assert CliRunner().invoke(draw, [str(heights), "-o", str(out), *words]).exit_code == 0
    vp.save(vp.panorama(vp.read(heights), vp.Panorama((1.5, 1.4), strips=2), title="Round", frame=True), own)
    assert out.read_bytes() == own.read_bytes()


def test_names_of_what_is_seen_stand_above_their_strip_in_order_and_what_is_hidden_has_none():
    """Walls to the north and the east; one summit is behind a wall, one is below the panorama."""
    walls = [vp.Item("NORTH", box((4, 1, 3)).moved(-2, 5, -1)), vp.Item("EAST", box((1, 4, 2)).moved(5, -2, -1))]
    places = {"A": (-1, 5, 2), "BB": (1, 5, 2), "C": (5, 0, 1), "HIDDEN": (0, 9, 1), "DEEP": (1, 0, -5)}
    labels = tuple(vp.Label(name, at, size_mm=3) for name, at in places.items())
    round_about = vp.Panorama((0, 0, 0), strips=1, middle_deg=45, width_deg=180, lowest_deg=-30)
    plain, named = (
        vp.panorama(vp.Scene(tuple(walls), labels=some), round_about, page="300x120") for some in ((), labels)
    )
    assert not any(layer.name == "label" for layer in plain.layers)
    (layer,) = (layer for layer in named.layers if layer.name == "label")
    (paths,) = layer.strokes
    parts = [paths.points[a:b] for a, b in pairwise(paths.offsets.tolist())]
    # Three lines of names, and the strokes of A, B, B and C: 3, 4, 4 and 1 (or fewer where they are joined).
    others = [part.points[:, 1] for layer in named.layers if layer.name != "label" for part in layer.strokes]
    skyline = float(np.concatenate(others).max())
    lines = sorted(
        (one for one in parts if len(one) == 2 and one[:, 1].min() <= skyline + 1.0), key=lambda one: one[:, 0].max()
    )
    feet = [float(one[np.argmin(one[:, 1]), 0]) for one in lines]
    assert len(lines) == 3
    radius = (feet[1] - feet[0]) / (2 * np.arctan(1 / 5))
    assert (feet[2] - feet[1]) / radius == pytest.approx(np.pi / 2 - np.arctan(1 / 5), abs=1e-3)
    assert min(one[:, 1].max() for one in lines) > skyline
