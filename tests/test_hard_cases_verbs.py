"""Hard cases that all verbs have to get right: what a drawing, a painting and pixels show is what rays meet."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
import pytest
from support.effort import several
from support.verbs_by_rays import VERBS, cameras, in_three_colours, met_by_rays, shown_in_pixels, some_of, turned

import vectorplot as vp
from vectorplot.arrays import Floats
from vectorplot.geometry.mesh import Mesh
from vectorplot.testing.shapes import (
    box,
    box_on_table,
    cyclic_bars,
    edge_on_plate,
    hollow_tube,
    interpenetrating_boxes,
    moebius_strip,
    non_manifold_edge,
    open_mesh,
    rotation,
    t_junction,
    torus_mesh,
    without,
)


def plates(gap: float) -> vp.Scene:
    """A large and a small plate above each other."""
    large = Mesh.from_polygons([(-1, -1, gap), (1, -1, gap), (1, 1, gap), (-1, 1, gap)], [[0, 1, 2, 3]])
    small = Mesh.from_polygons([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)], [[0, 1, 2, 3]])
    return vp.Scene((vp.Item("LARGE", large), vp.Item("SMALL", small)))


def ring_of_bars(count: int) -> vp.Scene:
    """Bars around a ring: each lies on the next with one end, and under the one before with the other."""
    items = []
    for k in range(count):
        angle = 2.0 * np.pi * k / count
        reach = 1.9 * np.tan(np.pi / count)
        along, across = np.array([-np.sin(angle), np.cos(angle), 0]), np.array([np.cos(angle), np.sin(angle), 0])
        corners = [
            2.0 * across + x * reach * 1.25 * along + y * 0.12 * across + (0.25 * x + 0.06 * z) * np.array([0, 0, 1.0])
            for z in (-1, 1)
            for y in (-1, 1)
            for x in (-1, 1)
        ]
        faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
        mesh = Mesh.from_polygons(corners, faces)
        items.append(vp.Item(f"BAR{k}", mesh))
    return vp.Scene(tuple(items))


def pierced(seed: int) -> vp.Scene:
    """Three boxes through each other, turned at random."""
    random = np.random.default_rng(seed)
    items = []
    for k in range(3):
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = rotation(random), random.uniform(-0.3, 0.3, 3)
        size = random.uniform(0.4, 1.6, 3)
        items.append(vp.Item(f"B{k}", box(-size, size).transformed(matrix)))
    return vp.Scene(tuple(items))


OPEN: dict[str, Callable[[], vp.Scene]] = {
    "a tray": open_mesh,
    "a tube": hollow_tube,
    "a box without its front": lambda: vp.Scene((vp.Item("A", without(box((-1, -1, -1), (1, 1, 1)), 2)),)),
    "two walls": lambda: vp.Scene((vp.Item("A", without(box((-1, -1, -1), (1, 1, 1)), 0, 1, 3, 4)),)),
    "a sheet between boxes": lambda: vp.Scene(
        (
            vp.Item("ABOVE", box((-0.2, -0.2, 0.5), (0.2, 0.2, 0.9))),
            plates(0.0).items[0],
            vp.Item("BELOW", box((-0.2, -0.2, -1), (0.2, 0.2, -0.6))),
        )
    ),
}


CUBE_AND_OTHERS = vp.Scene(
    (
        vp.Item("CUBE", box((-1, -1, -1), (1, 1, 1))),
        vp.Item("OTHER", box((3, 2, 1), (4, 3, 2))),
        vp.Item("LOW", box((-1, -6, -1), (4, -3, 0.5))),
    )
)
PLACES: dict[str, tuple[vp.Scene, tuple[float, ...], list[tuple[float, ...]]]] = {
    "in the hole of a ring": (
        vp.Scene((vp.Item("RING", torus_mesh()), vp.Item("FAR", box((4.5, -0.5, -0.5), (5, 0.5, 0.5))))),
        (0.1, -0.2, 0.05),
        [(3, 0.1, 0.2), (-0.5, 2, -0.1), (2, 1, 0.9)],
    ),
    "in a solid": (CUBE_AND_OTHERS, (0.3, -0.2, 0.1), [(1, -0.2, 0.1), (0.1, -3, 0.2)]),
    "above a floor that reaches behind the eye": (
        vp.Scene(
            (
                vp.Item("FLOOR", box((-1, -50, -1), (1, 10, 0))),
                vp.Item("POST", box((-0.4, 4, 0), (0.4, 5, 3))),
                vp.Item("BEHIND", box((-1, -9, 0), (1, -5, 2))),
            )
        ),
        (0.0, 0.0, 1.0),
        [(0, 10, 1), (0.2, 3, 0.4), (0.1, -2, 0.9)],
    ),
}


@pytest.mark.hard(2, 3, 5)
@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("place", PLACES)
def test_from_amid_the_scene_every_verb_shows_what_rays_meet(verb: str, place: str) -> None:
    scene, eye, targets = PLACES[place]
    for target in targets:
        VERBS[verb](in_three_colours(scene), vp.Camera(eye, target, fov_deg=100))


@pytest.mark.hard(4)
@pytest.mark.parametrize("verb", ["paint", "render"])
@pytest.mark.parametrize("eye", [(1.0, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 0.2, 0.1)], ids=["vertex", "edge", "face"])
def test_on_a_vertex_an_edge_or_a_face_pictures_are_those_from_just_outside(verb: str, eye: tuple[float, ...]) -> None:
    scene = in_three_colours(CUBE_AND_OTHERS)
    out = 1e-4 * np.array([np.sign(x) if abs(x) == 1.0 else 0.0 for x in eye])
    for target in ((0, 0, 0.1), (5, 4, 3), (1, -3, 1), (1, 3, -2), (1, -4, 0)):
        beside = vp.Camera(tuple(eye + out), tuple(target + out), fov_deg=100)
        expected, inner = met_by_rays(scene, beside)
        shown = shown_in_pixels(verb, scene, vp.Camera(eye, target, fov_deg=100))
        assert inner.mean() > 0.8 and (shown == expected)[inner].all(), target


@pytest.mark.parametrize("verb", ["paint", "render"])
@pytest.mark.parametrize(
    "make",
    [
        pytest.param(box_on_table, marks=pytest.mark.hard(7)),
        pytest.param(t_junction, marks=pytest.mark.hard(11)),
        pytest.param(non_manifold_edge, marks=pytest.mark.hard(12)),
        pytest.param(lambda: vp.Scene((vp.Item("STRIP", moebius_strip()),)), marks=pytest.mark.hard(14)),
        pytest.param(edge_on_plate, marks=pytest.mark.hard(1)),
    ],
)
def test_awkward_shapes_are_shown_in_pictures_as_rays_meet_them(verb: str, make: Callable[[], vp.Scene]) -> None:
    for seed in range(2):
        scene = in_three_colours(turned(make(), seed) if seed else make())
        for camera in cameras(scene)[seed::3]:
            VERBS[verb](scene, camera)


@pytest.mark.hard(16)
@pytest.mark.parametrize("verb", ["paint", "render"])
@pytest.mark.parametrize("points", [[(0, 0, 0), (1, 1, 1), (2, 2, 2)], [(1, 2, 3)] * 3])
def test_triangles_without_area_leave_no_trace_in_pictures(verb: str, points: list[tuple[int, ...]]) -> None:
    cube = vp.Item("CUBE", box((-1, -1, -1), (1, 1, 1)))
    speck = vp.Item("SPECK", Mesh.from_triangles(points, [[0, 1, 2]]))
    for camera in (vp.Camera((5, -7, 4)), vp.Camera((7, 7, 7), (1, 1, 1)), vp.Camera.view("top", (0, 0, 0), 6)):
        with_it, alone = (
            shown_in_pixels(verb, in_three_colours(vp.Scene(items)), camera) for items in ((cube, speck), (cube,))
        )
        assert np.array_equal(with_it, alone)
        assert (shown_in_pixels(verb, in_three_colours(vp.Scene((speck,))), camera) == 3).all()


@pytest.mark.slow
@pytest.mark.hard(13)
@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("name", OPEN)
def test_open_meshes_hide_and_are_seen_from_both_sides(verb: str, name: str) -> None:
    scene = in_three_colours(OPEN[name]())
    for camera in some_of(cameras(scene), verb):
        VERBS[verb](scene, camera)


@pytest.mark.slow
@pytest.mark.hard(20)
@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("count", [3, 4, 5, 7])
def test_bars_that_overlap_in_a_ring_of_any_number(verb: str, count: int) -> None:
    for seed in range(2):
        scene = in_three_colours(turned(ring_of_bars(count) if seed or count > 3 else cyclic_bars(), seed))
        for camera in some_of(cameras(scene)[seed::2], verb):
            VERBS[verb](scene, camera)


@pytest.mark.slow
@pytest.mark.hard(21)
@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("seed", range(4))
def test_boxes_through_each_other_change_places_where_they_meet(verb: str, seed: int) -> None:
    scene = in_three_colours(pierced(seed) if seed else interpenetrating_boxes())
    for camera in some_of(cameras(scene)[seed % 2 :: 2], verb):
        VERBS[verb](scene, camera)


@pytest.mark.hard(24)
@pytest.mark.spread
@pytest.mark.parametrize(
    ("verb", "gap"),
    [(verb, gap) for verb in VERBS for gap in (2.5e-9, 1e-8, 1e-6, 1e-3)],
)
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_the_nearer_of_two_plates_wins_in_every_verb(verb: str, gap: float, size: float) -> None:
    for order in (1, -1):
        items = plates(gap).items[::order]
        meshes = [Mesh(size * item.mesh.vertices, item.mesh.corners, item.mesh.offsets) for item in items]
        scene = in_three_colours(vp.Scene(tuple(vp.Item(i.name, m) for i, m in zip(items, meshes, strict=True))))
        small = [item.name for item in items].index("SMALL")
        for height in (6.0, -6.0):
            camera = vp.Camera((0.1 * size, 0.2 * size, height * size), (0.0, 0.0, 0.0), fov_deg=30.0)
            if verb == "draw":
                drawing = vp.draw(scene, camera)
                seen = {int(k) for layer in drawing.layers for paths in layer.strokes for k in paths.item}
                assert (small in seen) == (height < 0)
            elif verb == "paint":
                fills = vp.paint(scene, camera).layers[0].fills[0]
                last = [int(k) for k in fills.item if k >= 0][-1]
                assert last == (1 - small if height > 0 else small)
            else:
                pixels = vp.render(scene, camera, size=(60, 60), background="black").pixels
                assert pixels[28:32, 28:32].argmax(axis=2).tolist() == [[1 - small if height > 0 else small] * 4] * 4


def faceted_sphere(rings: int, sectors: int, seed: int) -> Mesh:
    """A ball of triangles and quadrilaterals, turned at random."""
    from vectorplot.geometry.solids import revolution

    angle = np.linspace(-np.pi / 2, np.pi / 2, rings + 1)
    meridian = [(float(np.cos(a)) if 0 < k < rings else 0.0, 0.0, float(np.sin(a))) for k, a in enumerate(angle)]
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(np.random.default_rng(seed))
    return revolution(meridian, sectors).transformed(matrix)


def loops(points: list[Floats]) -> list[Floats]:
    """Closed ways of the pieces (k,2) of strokes, end to end."""
    ways, left = [], [p for p in points if len(p) > 1]
    while left:
        way = left.pop()
        while not np.allclose(way[0], way[-1], atol=2e-4):
            after = next((k for k, p in enumerate(left) if min(abs(p[[0, -1]] - way[-1]).max(axis=1)) < 2e-4), None)
            assert after is not None, "a contour ends"
            piece = left.pop(after)
            piece = piece if np.allclose(piece[0], way[-1], atol=2e-4) else piece[::-1]
            way = np.concatenate([way, piece[1:]])
        ways.append(way)
    return ways


@pytest.mark.slow
@pytest.mark.hard(28)
@pytest.mark.parametrize("verb", ["draw", "paint"])
@pytest.mark.parametrize(("rings", "sectors"), [(4, 5), (9, 12), (24, 40), (60, 90)])
def test_the_contour_of_a_ball_of_faces_is_one_convex_loop_from_everywhere(verb: str, rings: int, sectors: int) -> None:
    # Each seed is another ball; of those with many faces one has places enough to go wrong.
    for seed in range(several(1, long=3) if rings < 60 else 1):
        scene = vp.Scene((vp.Item("BALL", faceted_sphere(rings, sectors, seed)),))
        for camera in cameras(scene)[:: several(2, long=1)]:
            made = getattr(vp, verb)(scene, camera, lines=("contour",))
            pieces = []
            for paths in (paths for layer in made.layers for paths in layer.strokes):
                for k in range(len(paths)):
                    line = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
                    pieces.append(np.vstack([line, line[:1]]) if paths.closed[k] else line)
            (loop,) = loops(pieces)
            step = np.diff(loop, axis=0)
            after = np.roll(step, -1, axis=0)
            turn = np.arctan2(step[:, 0] * after[:, 1] - step[:, 1] * after[:, 0], (step * after).sum(axis=1))
            # All to one side, and once round: neither to and fro, nor twice.
            assert abs(abs(turn.sum()) - 2 * np.pi) < 1e-6
            assert (turn * np.sign(turn.sum())).min() > -1e-3


@pytest.mark.hard(58)
@pytest.mark.spread
@pytest.mark.parametrize("verb", ["draw", "paint", "visible fills"])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("quarter", range(4))
def test_lines_on_the_border_of_what_hides_are_kept(verb: str, size: float, quarter: int) -> None:
    """A wall of bricks seen from the front: every joint is the border of a nearer brick, and is drawn."""
    angle = quarter * np.pi / 2
    turn = np.array([(np.cos(angle), -np.sin(angle), 0), (np.sin(angle), np.cos(angle), 0), (0, 0, 1)]).round()
    items, lengths = [], 0.0
    for row in range(3):
        for column in range(4):
            depth = (row + column) % 3
            mesh = box((column, depth, row), (column + 1, 5, row + 1))
            items.append(vp.Item(f"B{row}{column}", Mesh(size * mesh.vertices @ turn.T, mesh.corners, mesh.offsets)))
    lengths = 4 * 4 + 5 * 3
    eye, middle = np.array([2.0, -20.0, 1.5]), np.array([2.0, 0.0, 1.5])
    camera = vp.Camera(tuple(size * turn @ eye), tuple(size * turn @ middle), parallel=True, height=6 * size)
    options = {"page": vp.Page(120, 120, 0), "fit": False, "lines": ("contour", "crease")}
    scene = vp.Scene(tuple(items))
    if verb == "draw":
        made = vp.draw(scene, camera, **options)
    else:
        made = vp.paint(scene, camera, **options, fills="visible" if verb == "visible fills" else "painted")
    scale = 120 / 6
    drawn = 0.0
    for paths in (paths for layer in made.layers for paths in layer.strokes):
        for k in range(len(paths)):
            line = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
            line = np.vstack([line, line[:1]]) if paths.closed[k] else line
            drawn += np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    assert drawn / scale == pytest.approx(lengths, rel=1e-6)


BOW_TIES = {
    "upright": [(0, 0, 0), (2, 0, 0), (0, 0, 2), (2, 0, 2)],
    "slanted": [(0, 0, 0), (2, 1, 0), (0, 0, 2), (2, 1, 2)],
    "a star": [(float(np.cos(k * 4 * np.pi / 5)), 0.0, float(np.sin(k * 4 * np.pi / 5))) for k in range(5)],
    "with a double corner": [(0, 0, 0), (2, 0, 0), (1, 0, 1), (2, 0, 2), (0, 0, 2), (1, 0, 1)],
}


@pytest.mark.hard(59)
@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
@pytest.mark.parametrize("name", BOW_TIES)
def test_faces_that_cross_themselves_are_reported_or_right(verb: str, name: str, tmp_path, capsys) -> None:
    from vectorplot.cli.main import run

    corners = BOW_TIES[name]
    points = ", ".join(" ".join(map(repr, map(float, point))) for point in corners)
    numbers = " ".join(str(k + 1) for k in range(len(corners)))
    path, out = tmp_path / "tie.scene", tmp_path / ("tie.png" if verb == "render" else "tie.svg")
    path.write_text(
        f"camera eye 3 -9 4 target 1 0 1\nTIE red general vertices {points} faces {numbers}\n"
        "BEHIND blue box 1 0.2 1 translation 0.5 2 0.5\n",
        encoding="utf-8",
    )
    assert run([verb, str(path), "-o", str(out), *(["--size", "40x30"] if verb == "render" else [])]) == 0
    told = capsys.readouterr().err
    assert out.exists() and told.count("\n") <= 1
    crosses = name != "with a double corner"
    assert not crosses or "cross" in told


@pytest.mark.hard(59)
@pytest.mark.parametrize("verb", ["draw", "paint"])
def test_patterns_that_cross_themselves_stay_within_their_face(verb: str) -> None:
    tie = np.array([(-0.4, -0.4), (0.4, 0.4), (0.4, -0.4), (-0.4, 0.4)])
    item = vp.Item("CUBE", box((0, 0, 0), (1, 1, 1)), "orange", patterns=(vp.Pattern("TIE", "blue", 5, tie),))
    camera = vp.Camera((3, -4, 6), (0.5, 0.5, 0.5))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", vp.InputWarning)
        made = getattr(vp, verb)(vp.Scene((item,)), camera)
    marks = [mark for layer in made.layers for mark in (*layer.fills, *layer.strokes)]
    on_top = np.concatenate([mark.points3d for mark in marks if len(mark)])
    assert (on_top >= -1e-9).all() and (on_top <= 1 + 1e-9).all()


def raising(*_: Floats) -> Floats:
    raise ZeroDivisionError("my own mistake")


def complex_valued(*at: Floats) -> Floats:
    return 1j * at[0]


def wrongly_shaped(*at: Floats) -> Floats:
    return np.zeros(7)


def wordy(*at: Floats) -> str:
    return "three"


@pytest.mark.hard(69)
@pytest.mark.parametrize("verb", [vp.draw, vp.paint, vp.render])
@pytest.mark.parametrize("wrong", [raising, complex_valued, wrongly_shaped, wordy])
@pytest.mark.parametrize("kind", ["surface", "graph", "implicit", "curve"])
def test_functions_that_fail_are_named_in_every_verb(verb, wrong, kind: str) -> None:
    from vectorplot.curves.placed_curves import curve_of_function
    from vectorplot.surfaces.function_surface import surface_of_function
    from vectorplot.surfaces.graphs import graph
    from vectorplot.surfaces.implicit import implicit_of_function
    from vectorplot.surfaces.surface import Domain

    made = {
        "surface": lambda: surface_of_function(wrong, Domain(0.0, 1.0, 0.0, 1.0)),
        "graph": lambda: graph(wrong, Domain(0.0, 1.0, 0.0, 1.0)),
        "implicit": lambda: implicit_of_function(wrong, [(-1, -1, -1), (1, 1, 1)]),
        "curve": lambda: curve_of_function(wrong, 0.0, 1.0),
    }[kind]
    with pytest.raises(vp.InputError, match=wrong.__name__) as told:
        verb(vp.Scene((vp.Item("MINE", made()),)))
    assert "\n" not in str(told.value)


@pytest.mark.slow
@pytest.mark.hard(69)
@pytest.mark.parametrize("verb", ["paint", "render", "draw"])
def test_where_a_function_is_not_finite_one_looks_through(verb: str) -> None:
    from vectorplot.surfaces.graphs import graph
    from vectorplot.surfaces.surface import Domain

    def with_hole(x: Floats, y: Floats) -> Floats:
        return np.where(np.hypot(x, y) < 0.5, np.nan, 0.1 * x)

    sheet = vp.Item("SHEET", graph(with_hole, Domain(-1.0, 1.0, -1.0, 1.0)), "#ff0000")
    below = vp.Item("BELOW", box((-0.2, -0.2, -0.6), (0.2, 0.2, -0.4)), "#0000ff")
    scene, camera = vp.Scene((sheet, below)), vp.Camera((0.1, -0.2, 9), (0, 0, 0), fov_deg=20)
    if verb == "draw":
        drawing = vp.draw(scene, camera)
        assert 1 in {int(k) for layer in drawing.layers for paths in layer.strokes for k in paths.item}
    elif verb == "render":
        pixels = vp.render(scene, camera, size=(61, 61)).pixels
        assert pixels[30, 30].argmax() == 2 and pixels[30, 12].argmax() == 0
    else:
        fills = vp.paint(scene, camera, tolerance_mm=0.5).layers[0].fills[0]
        assert {0, 1} <= set(fills.item.tolist())
        own = fills.points3d[np.repeat(fills.item, np.diff(fills.offsets)) == 0]
        assert np.hypot(own[:, 0], own[:, 1]).min() > 0.45
