"""Surfaces painted as ribbons: what is on top is what rays meet first, and ribbons are what the book says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.painted import wrong_points
from support.strewn import placed

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.scene.view import look
from vectorplot.testing.shapes import box, numbered, torus_mesh
from vectorplot.textbook.orders import graph_triangles
from vectorplot.visibility.painter.face_splitting import in_slices, ribbon_order, ribbons
from vectorplot.visibility.painter.image_faces import drawn_faces, image_faces, view_points
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import LineKind


def grid_mesh(x, y, z):
    rows, columns = x.shape[0] - 1, x.shape[1] - 1
    return Mesh.from_triangles(np.stack([x, y, z], axis=-1).reshape(-1, 3), graph_triangles(rows, columns))


def knot(columns=60, rows=9):
    """A tube along a trefoil knot."""
    u, v = np.meshgrid(2 * np.pi * np.arange(columns) / columns, 2 * np.pi * np.arange(rows) / rows, indexing="ij")
    middle = np.stack(
        [(2 + np.cos(3 * u)) * np.cos(2 * u), (2 + np.cos(3 * u)) * np.sin(2 * u), 0.7 * np.sin(3 * u)], axis=2
    )
    along = np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0)
    side = np.cross(along, (0.0, 0.0, 1.0))
    up = np.cross(side, along)
    side, up = (part / np.linalg.norm(part, axis=2, keepdims=True) for part in (side, up))
    points = middle + 0.4 * (np.cos(v)[..., None] * side + np.sin(v)[..., None] * up)
    here = np.arange(columns * rows).reshape(columns, rows)
    right, above = np.roll(here, -1, axis=0), np.roll(here, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    halves = [np.stack(t, axis=2).reshape(-1, 3) for t in ((here, right, both), (here, both, above))]
    return Mesh.from_triangles(points.reshape(-1, 3), np.concatenate(halves))


def spiral_stair():
    """A ramp of two and a half turns: a ribbon that goes round the axis more than once."""
    turn, out = np.meshgrid(np.linspace(0, 5 * np.pi, 61), np.linspace(0.3, 1.0, 4), indexing="ij")
    return grid_mesh(out * np.cos(turn), out * np.sin(turn), 0.25 * turn - 2.0)


def moebius():
    t, w = np.meshgrid(np.linspace(0, 2 * np.pi, 49), np.linspace(-0.5, 0.5, 5), indexing="ij")
    out = 1.3 + w * np.cos(t / 2)
    return grid_mesh(out * np.cos(t), out * np.sin(t), w * np.sin(t / 2))


def crossed():
    """Two sheets that pierce one another."""
    x, y = np.meshgrid(np.linspace(-1, 1, 11), np.linspace(-1, 1, 11), indexing="ij")
    one, two = grid_mesh(x, y, 0.5 * x), grid_mesh(x, y, 0.3 * np.sin(4 * y))
    return Mesh.from_triangles(
        np.concatenate([one.vertices, two.vertices]),
        np.concatenate([one.corners, two.corners + len(one.vertices)]).reshape(-1, 3),
    )


SHAPES = {
    "knot": knot(),
    "torus": torus_mesh(24, 12),
    "stair": spiral_stair(),
    "moebius": moebius(),
    "crossed": crossed(),
    "box": box((-1, -1, -1), (1, 1, 1)),
}


def sight(shape, seed, parallel=False):
    """A view from anywhere, and planes anywhere, in some views from within the surface's box."""
    random = np.random.default_rng(seed)
    normal = np.array([0.0, 0.0, 1.0]) if seed % 3 == 0 else random.normal(size=3)
    height = shape.vertices @ (normal / np.linalg.norm(normal))
    offsets = np.linspace(height.min(), height.max(), random.integers(3, 12))[1:-1]
    way = random.normal(size=3)
    reach = float(np.abs(shape.vertices).max()) * (random.uniform(1.6, 4.0) if seed % 4 else 0.9)
    camera = Camera(tuple(way * reach / np.linalg.norm(way)), (0.01, 0.02, 0.0), fov_deg=50, parallel=parallel)
    return look(numbered([shape]), camera), Section(tuple(normal), tuple(offsets.tolist()), slices=True)


@pytest.mark.slow
@pytest.mark.capability("G5.3-sliced")
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", SHAPES)
def test_surfaces_painted_ribbon_by_ribbon_show_what_is_nearest(name, parallel):
    for seed in range(6):
        view, planes = sight(SHAPES[name], seed, parallel)
        painted = painters_order(view, sliced={0: planes})
        assert painted.ribbons[0] > 0
        assert wrong_points(view, painted.faces, 400) == 0
        if name in ("knot", "torus"):
            assert len(painted) == painted.uncut, "ribbons have an order of their own"


@pytest.mark.capability("G5.3-sliced")
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_ribbons_are_runs_of_one_face_type_within_their_sectors_and_the_farther_one_goes_first(seed, parallel):
    view, planes = sight(placed(torus_mesh(24, 12), np.random.default_rng(seed)), 3 * seed + 1, parallel)
    projected = project_faces(view)
    slices = in_slices(view, image_faces(view, drawn_faces(view, projected)), planes)
    found = ribbons(view, projected.facing, slices)
    faces, of = slices.faces, found.of_piece

    height = slices.frame[2] @ view_points(view, faces.points)
    ends = np.concatenate([[-np.inf], slices.levels, [np.inf]])
    piece = np.repeat(np.arange(len(faces)), np.diff(faces.offsets))
    near = 1e-8
    assert (height >= ends[slices.slice_[piece]] - near).all()
    assert (height <= ends[slices.slice_[piece] + 1] + near).all()
    for value in (projected.facing[faces.source], slices.slice_):
        assert len(np.unique(np.stack([of, value]), axis=1).T) == len(found), "one slice and one side each"

    level = slices.frame[:2] @ view_points(view, faces.points)
    if parallel:
        ahead = slices.frame[:2, 2] / np.linalg.norm(slices.frame[:2, 2])
        angle, distance = ahead[0] * level[1] - ahead[1] * level[0], -(ahead @ level)
    else:
        level = level - (slices.frame[:2] @ view.eye)[:, None]
        angle, distance = np.arctan2(level[1], level[0]), np.hypot(*level)
        angle = np.mod(angle - found.low[of[piece]] + near, 2 * np.pi) + found.low[of[piece]] - near
    assert (angle >= found.low[of[piece]] - near).all()
    assert (angle <= found.high[of[piece]] + near).all()
    assert (distance >= found.nearest[of[piece]] - near).all()
    assert (distance <= found.farthest[of[piece]] + near).all()

    painted = ribbon_order(view, slices, found)
    key = faces.source * (len(slices.levels) + 1) + slices.slice_
    assert len(painted) == len(faces)
    middle = slices.frame[2] @ view_points(view, painted.points)
    slice_ = np.searchsorted(slices.levels, np.add.reduceat(middle, painted.offsets[:-1]) / np.diff(painted.offsets))
    order = of[np.argsort(key)[np.searchsorted(np.sort(key), painted.source * (len(slices.levels) + 1) + slice_)]]
    place = np.argsort(np.unique(order, return_index=True)[1])
    first = np.empty(len(found), dtype=int)
    first[place] = np.arange(len(found))
    assert (np.diff(found.place[order]) >= 0).all(), "slice by slice"
    if not parallel:
        both = np.argwhere(found.place[:, None] == found.place)
        for one, two in both:
            low, high = max(found.low[one], found.low[two]), min(found.high[one], found.high[two])
            if low < high and found.nearest[one] > found.farthest[two]:
                assert first[one] < first[two], "of ribbons in one sector the farther one goes first"


def test_what_else_is_in_front_of_a_sliced_surface_or_behind_it_undoes_the_slices():
    planes = Section((0, 0, 1), (-0.2, 0.2), slices=True)
    ring, plate = torus_mesh(24, 12), box((-3, -3, -2), (3, 3, -1.9))
    items = (Item("RING", ring, curves=SurfaceLines(sections=(planes,))), Item("PLATE", plate))
    camera = Camera((5, -6, 5), (0, 0, 0))
    told = {}
    for count in (1, 2):
        reports = []
        vp.paint(Scene(items[:count]), camera, explain=reports.append)
        told[count] = [(report.name, report.why) for report in reports if report.name.startswith("ribbons")]
    assert told[1] == [("ribbons", "RING: in 3 slices, ribbon by ribbon")]
    assert told[2] == [("ribbons undone", "RING: something else is in front of it or behind it")]


def test_scale_and_place_change_no_ribbon():
    shape = torus_mesh(24, 12)
    found = []
    for scale, shift in ((1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)):
        moved = Mesh(shape.vertices * scale + shift, shape.corners, shape.offsets)
        camera = Camera(tuple(np.array([3.0, -4.0, 2.5]) * scale + shift), (shift,) * 3)
        planes = Section((0, 0, 1), tuple((np.array([-0.31, 0.02, 0.27]) * scale + shift).tolist()), slices=True)
        painted = painters_order(look(numbered([moved]), camera), sliced={0: planes})
        found.append((painted.ribbons[0], len(painted)))
    assert len(set(found)) == 1


SLICED = """
RING cyan surface torus 1.5 0.65 slices normal 0 0 2 5
BOX blue box solid 2 2 2 translation 5 0 0 slices x at 5.5
"""


@pytest.mark.slow
@pytest.mark.capability("G5.3-sliced")
def test_slices_in_scene_files_are_read_written_painted_and_drawn():
    scene = parse_scene(SLICED)
    ring, cube = (item.curves.slices for item in scene.items)
    assert ring is not None and cube is not None
    assert np.allclose(ring.offsets, 0.65 * np.array([-0.6, -0.2, 0.2, 0.6]))
    assert (cube.normal, cube.offsets) == ((1.0, 0.0, 0.0), (5.5,))
    again = parse_scene(write_scene(scene))
    assert [item.curves for item in again.items] == [item.curves for item in scene.items]
    camera = Camera((4, -14, 9), (2, 0, 0))
    reports = []
    painted = vp.paint(scene, camera, lines="section", explain=reports.append)
    assert [report.why.split(",")[0] for report in reports if report.name == "ribbons"] == [
        "RING: in 5 slices",
        "BOX: in 2 slices",
    ]
    drawn = vp.draw(scene, camera, lines="section")
    for picture in (painted, drawn):
        kinds = {kind for layer in picture.layers for paths in layer.strokes for kind in np.unique(paths.kind).tolist()}
        assert kinds == {LineKind.SECTION}


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("A box 1 1 1 slices z 1\n", "slices: 1 of them, expected 2 to 10000"),
        ("A box 1 1 1 slices q 3\n", "slices: expected x, y, z or 'normal', got 'q'"),
        ("A box 1 1 1 slices z 3 slices x 2\n", "slices: an item is cut into slices in one direction only"),
        ("A box 1 1 1 slices normal 0 0 0 2\n", "normal"),
    ],
)
def test_slices_that_make_no_sense_are_told_with_file_and_line(text, cause):
    with pytest.raises(InputError, match=r":1: A: .*" + cause.replace("(", "[(]")):
        parse_scene(text, "s.scene")


def test_an_item_is_sliced_in_one_direction():
    planes = Section((0, 0, 1), (0.0,), slices=True)
    with pytest.raises(InputError, match="one direction"):
        SurfaceLines(sections=(planes, replace(planes, normal=(1, 0, 0))))
    assert SurfaceLines(sections=(replace(planes, slices=False),)).slices is None
