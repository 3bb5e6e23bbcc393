import numpy as np
import pytest
import shapely

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, joined_decals, no_decals
from vectorplot.effects.patterns import pattern_decals, patterns_in_shadows
from vectorplot.errors import InputError
from vectorplot.features.mesh_lines import face_frames
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import box
from vectorplot.scene.item import Item, Pattern
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look

SQUARE = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
# An L whose first corners would make a clockwise frame of any careless sort.
ELL = Mesh.from_polygons(
    [(0, 0, 0), (4, 0, 0), (4, 1, 0), (1, 1, 0), (1, 4, 0), (0, 4, 0), (9, 9, 1), (10, 9, 1), (9, 10, 1)],
    [[6, 7, 8], [0, 1, 2, 3, 4, 5]],
)


def seen(items: list[Item]) -> tuple[Scene, View]:
    scene = Scene(tuple(items))
    size = float(np.ptp(scene.bounds, axis=0).max())
    middle = scene.bounds.mean(axis=0)
    eye = middle + np.array([2.0, -3.0, 2.5]) * size
    return scene, look(scene, Camera(eye=tuple(eye), target=tuple(middle)))


def cube(patterns: list[Pattern]) -> Item:
    return Item("CUBE", box((10.0, 10.0, 10.0)), patterns=tuple(patterns))


def polygons(decals: Decals) -> list[np.ndarray]:
    return [decals.points[:, a:b] for a, b in zip(decals.offsets[:-1], decals.offsets[1:], strict=True)]


def in_plane(view: View, decals: Decals) -> float:
    """The largest distance of a corner from the plane of its face."""
    worst = 0.0
    for polygon, face in zip(polygons(decals), decals.face, strict=True):
        corners = view.points[:, view.corners[view.offsets[face] : view.offsets[face + 1]]]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.linalg.norm(normal)
        worst = max(worst, float(np.abs(normal @ (polygon - corners[:, :1])).max()))
        turn = np.cross((polygon - polygon[:, :1])[:, :-1], (polygon - polygon[:, :1])[:, 1:], axis=0).sum(axis=1)
        assert turn @ normal > 0.0
    return worst


@pytest.mark.capability("G6.5-patterns")
@pytest.mark.parametrize(("scale", "shift"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_patterns_lie_in_their_faces_and_end_at_their_borders(scale: float, shift: float) -> None:
    wide = [Pattern(f"P{k}", "white", k, scale * np.array([(0, 0), (40, 5), (-5, 30)])) for k in range(6)]
    mesh = box((10.0, 10.0, 10.0))
    item = Item("CUBE", Mesh(scale * mesh.vertices + shift, mesh.corners, mesh.offsets), patterns=tuple(wide))
    scene, view = seen([item])
    decals = pattern_decals(scene, view)
    assert len(decals) == 6 and (decals.kind == FillKind.PATTERN).all()
    assert in_plane(view, decals) < (1e-8 if shift else 1e-14)
    assert (np.abs(view.world_of(decals.points) - shift) <= 10.0 * scale * (1 + 1e-8)).all()
    areas = [
        np.linalg.norm(np.cross(p[:, 1:-1] - p[:, :1], p[:, 2:] - p[:, :1], axis=0).sum(axis=1)) / 2
        for p in polygons(decals)
    ]
    clipped = shapely.area(shapely.intersection(shapely.box(-5, -5, 5, 5), shapely.polygons(wide[0].points / scale)))
    assert np.allclose(np.array(areas) * (view.scale / scale) ** 2, clipped, rtol=1e-7)


def test_patterns_wholly_beside_their_face_or_without_area_are_left_out() -> None:
    beside = Pattern("FAR", "white", 0, SQUARE + 20.0)
    flat = Pattern("FLAT", "white", 0, np.array([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]))
    scene, view = seen([cube([beside, flat])])
    assert len(pattern_decals(scene, view)) == 0
    assert len(pattern_decals(*seen([cube([])]))) == 0


def test_patterns_on_faces_that_are_cut_into_pieces_or_not_present() -> None:
    item = Item("ELL", ELL, patterns=(Pattern("ALL", "cyan", 1, 10.0 * SQUARE), Pattern("T", "red", 0, SQUARE)))
    scene, view = seen([item])
    decals = pattern_decals(scene, view)
    world = [view.world_of(p) for p in polygons(decals)]
    area = sum(abs(shapely.polygons(p[:, :2]).area) for p in world if np.allclose(p[:, 2], 0.0))
    assert np.isclose(area, 7.0) and np.isclose(sum(shapely.polygons(p[:, :2]).area for p in world), 7.5)
    assert in_plane(view, decals) < 1e-14
    hollow = Mesh(ELL.vertices, ELL.corners, ELL.offsets, np.array([True, False]))
    scene, view = seen([Item("HOLLOW", hollow, patterns=item.patterns)])
    assert {decals.colours[k] for k in pattern_decals(scene, view).colour} == {"red"}


def test_patterns_that_are_not_convex_and_turn_the_wrong_way() -> None:
    star = np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)], dtype=float)[::-1]
    scene, view = seen([cube([Pattern("STAR", "black", 5, star)])])
    decals = pattern_decals(scene, view)
    in_plane(view, decals)
    flat = [shapely.polygons(view.world_of(p)[:, :2]) for p in polygons(decals)]
    assert np.isclose(shapely.union_all(flat).area, 5.0) and np.isclose(sum(p.area for p in flat), 5.0)


@pytest.mark.capability("G6.5-patterns")
def test_later_patterns_of_a_face_lie_above_earlier_ones() -> None:
    patterns = [Pattern("A", "cyan", 5, 2 * SQUARE), Pattern("B", "black", 5, SQUARE), Pattern("C", "cyan", 0, SQUARE)]
    decals = pattern_decals(*seen([cube(patterns), cube([])]))
    assert decals.colours == ("cyan", "black")
    assert [(decals.colours[c], level) for c, level in zip(decals.colour, decals.level, strict=True)] == [
        ("cyan", 0),
        ("black", 1),
        ("cyan", 2),
    ]


def shadow(view: View, item: Item, face: int, of_view: int, points: np.ndarray, grade: int) -> Decals:
    origin, along, left = (row[0] for row in face_frames(item.mesh, np.array([face])))
    corners = view.points_of(origin + points[:, :1] * along + points[:, 1:] * left)
    one = np.array([1])
    return Decals(
        corners,
        np.array([0, len(points)]),
        np.array([of_view]),
        one * FillKind.SHADOW,
        one * grade,
        np.array([grade - 1]),
        -one,
        one * grade,
    )


@pytest.mark.capability("G6.5-patterns")
def test_every_point_of_a_face_gets_the_colour_on_top_and_the_grade_of_its_shadow() -> None:
    random = np.random.default_rng(5)
    for _ in range(12):
        patterns = [
            Pattern(f"P{k}", f"#0000{k:02x}", 5, random.uniform(-6, 6, 2) + random.uniform(1, 3) * SQUARE)
            for k in range(4)
        ]
        item = cube(patterns)
        scene, view = seen([item])
        angles = np.sort(random.uniform(0, 2 * np.pi, (6, 5)), axis=1)
        outlines = [
            np.clip(random.uniform(-4, 4, 2) + random.uniform(1, 4) * np.column_stack([np.cos(a), np.sin(a)]), -5, 5)
            for a in angles
        ]
        outlines = [shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(o)))[::-1][1:] for o in outlines]
        grades = random.integers(1, 4, len(outlines))
        shadows = joined_decals(*(shadow(view, item, 5, 5, o, int(g)) for o, g in zip(outlines, grades, strict=True)))
        both = joined_decals(
            shadows, patterns_in_shadows(view, pattern_decals(scene, view), shadows, np.zeros(6, dtype=bool), 3)
        )
        origin, along, left = (row[0] for row in face_frames(item.mesh, np.array([5])))
        shapes = []
        for k in range(len(both)):
            arm = view.world_of(both.points[:, both.offsets[k] : both.offsets[k + 1]]) - origin
            shapes.append(shapely.polygons(np.column_stack([arm @ along, arm @ left])))
        samples = random.uniform(-5, 5, (400, 2))
        spots = shapely.points(samples)
        found = np.full((2, 400), -1)
        for k in both.painting_order:
            inside = shapely.contains(shapes[k], spots)
            found[0, inside] = both.colour[k]
            found[1, inside] = both.grade[k]
        wanted = np.full((2, 400), -1)
        near = np.zeros(400, dtype=bool)
        for outline, grade in zip(outlines, grades, strict=True):
            polygon = shapely.polygons(outline)
            inside = shapely.contains(polygon, spots)
            wanted[1, inside] = np.maximum(wanted[1, inside], grade)
            near |= shapely.distance(polygon.exterior, spots) < 1e-6
        for pattern in patterns:
            polygon = shapely.polygons(pattern.points)
            inside = shapely.contains(polygon, spots)
            wanted[0, inside] = both.colours.index(pattern.colour)
            wanted[1, inside] = np.maximum(wanted[1, inside], 0)
            near |= shapely.distance(polygon.exterior, spots) < 1e-6
        assert (found == wanted)[:, ~near].all()
        assert in_plane(view, both) < 1e-13


@pytest.mark.capability("G6.5-patterns")
def test_patterns_on_dark_faces_lack_all_lights() -> None:
    item = cube([Pattern("A", "cyan", 5, SQUARE), Pattern("B", "cyan", 0, SQUARE)])
    scene, view = seen([item])
    dark = np.arange(6) == 5
    both = patterns_in_shadows(view, pattern_decals(scene, view), no_decals(), dark, 3)
    assert dict(zip(both.face.tolist(), both.grade.tolist(), strict=True)) == {5: 3, 0: 0}


def test_patterns_need_a_face() -> None:
    for wrong in (-1, 6):
        with pytest.raises(InputError, match=f"face {wrong + 1}: there are 6 faces"):
            face_frames(box((1.0, 1.0, 1.0)), np.array([0, wrong]))
    sliver = Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0)], [[0, 1, 2], [0, 1, 3]])
    for faces in ([0], [1, 0]):
        with pytest.raises(InputError, match="no area"):
            face_frames(sliver, np.array(faces))
