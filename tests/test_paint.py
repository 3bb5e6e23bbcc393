"""The verb paint: from a scene to filled polygons on a page."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.hard_shapes import HARD_SHAPES
from support.strewn import STREWN
from support.top_fills import assert_same_picture, blended, colours_at, covering, fills_of, top_at

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.paint import paint
from vectorplot.scene.scene import Item, Light, Material, Page, Pattern, Scene
from vectorplot.shading.light.palettes import palette
from vectorplot.surfaces.families.ellipsoid import Sphere
from vectorplot.testing.shapes import (
    box,
    cyclic_bars,
    hollow_bodies,
    interpenetrating_boxes,
    numbered,
    random_convex_solids,
    rotated_boxes,
)

CUBE = Scene((Item("CUBE", box((-1, -1, -1), (1, 1, 1)), colour="blue"),))
SUN = Light((2.0, -3.0, 5.0), parallel=True, intensity=0.8)
LAMP = Light((-4.0, -5.0, 6.0), intensity=0.5)
TABLE = Scene(
    (
        Item("TABLE", box((-3, -3, -0.3), (3, 3, 0)), "lightgray"),
        Item("BOX", box((-1, -1, 0), (0.5, 0.5, 1)), "orange"),
        Item("POST", box((1.2, 0.2, 0), (1.5, 0.5, 2)), "green"),
    ),
    (SUN, LAMP),
)
CAMERAS = [
    Camera((6.0, -8.0, 5.0)),
    Camera((6.0, -8.0, 5.0), (0.5, 0.2, -0.1), twist_deg=15.0, fov_deg=50.0),
    Camera((6.0, -8.0, 5.0), parallel=True, height=7.0),
]
SQUARE = Page(100.0, 100.0, 0.0)


def top_view(height: float = 4.0) -> Camera:
    """Looks down on the origin; the page is a map of so many units."""
    return Camera((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0), parallel=True, height=height)


def at(drawing: Drawing, *places: tuple[float, float]) -> Floats:
    """(n,3) the colours of places of the page."""
    return blended(fills_of(drawing), np.array(places, dtype=np.float64))


def kinds(drawing: Drawing) -> set[str]:
    return {FillKind(kind).word for kind in np.unique(fills_of(drawing).kind).tolist()}


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("fit", [True, False])
def test_points_are_the_images_of_their_points_in_the_world(camera: Camera, fit: bool) -> None:
    drawing = paint(replace(rotated_boxes(8), lights=(SUN,)), camera, fit=fit)
    fills = fills_of(drawing)
    projected = np.column_stack([fills.points3d, np.ones(len(fills.points3d))]) @ drawing.page_from_world.T
    assert np.allclose(projected[:, :2] / projected[:, 3:], fills.points, atol=1e-7)


@pytest.mark.capability("G2.1-parallel")
@pytest.mark.parametrize("camera", CAMERAS)
def test_without_fit_the_page_is_the_camera_s_picture(camera: Camera) -> None:
    drawing = paint(CUBE, camera, page=Page(200.0, 150.0, 0.0), fit=False)
    fills = fills_of(drawing)
    x, y, z = camera.axes @ (fills.points3d - np.asarray(camera.target)).T
    factor = 1.0 if camera.parallel else camera.distance / (camera.distance - z)
    height = camera.height if camera.parallel else 2.0 * camera.distance * np.tan(np.radians(camera.fov_deg) / 2.0)
    expected = np.array([100.0, 75.0]) + np.stack([x * factor, y * factor], axis=1) * 150.0 / height
    assert np.allclose(fills.points, expected, atol=1e-9)


@pytest.mark.parametrize("camera", CAMERAS)
def test_a_fitted_picture_touches_its_margins_and_is_otherwise_the_same(camera: Camera) -> None:
    page = Page(120.0, 90.0, 7.0)
    scene = replace(rotated_boxes(8), lights=(SUN,))
    fitted, free = (fills_of(paint(scene, camera, page=page, fit=fit)) for fit in (True, False))
    low, high = fitted.points.min(axis=0), fitted.points.max(axis=0)
    touches = np.isclose(low, 7.0) & np.isclose(high, (113.0, 83.0))
    assert touches.any() and (low > 7.0 - 1e-9).all() and (high < np.array([113.0, 83.0]) + 1e-9).all()
    assert np.allclose((low + high) / 2.0, (60.0, 45.0))
    # One similarity takes the other picture, as far as it is on the page, to this one.
    places = {point.round(9).tobytes(): place for point, place in zip(free.points3d, free.points, strict=True)}
    both = [k for k, point in enumerate(fitted.points3d) if point.round(9).tobytes() in places]
    here, there = fitted.points[both], np.array([places[fitted.points3d[k].round(9).tobytes()] for k in both])
    scale = np.linalg.norm(np.ptp(here, axis=0)) / np.linalg.norm(np.ptp(there, axis=0))
    assert len(both) > 10
    assert np.allclose(here - here[0], scale * (there - there[0]), atol=1e-6)


@pytest.mark.slow
@pytest.mark.hard(18, 19)
@pytest.mark.spread
@pytest.mark.parametrize("kind", ["piercing boxes", "table", "mirror and glass"])
@pytest.mark.parametrize("offset, scale", [(1e6, 1.0), (0.0, 1e-6), (0.0, 1e6)])
def test_far_tiny_and_huge_scenes_give_the_same_picture(kind: str, offset: float, scale: float) -> None:
    extra = (
        Item("MIRROR", box((-2, 2, 0), (2, 2.2, 2)), "cyan", Material("mirror")),
        Item("GLASS", box((-2.5, -2.5, 0), (-1.5, -1.5, 1.5)), "blue", Material("transparent", 0.4), occludes=False),
    )
    scene = {
        "piercing boxes": replace(STREWN["piercing_boxes"](np.random.default_rng(2)), lights=(SUN, LAMP)),
        "table": TABLE,
        "mirror and glass": replace(TABLE, items=(*TABLE.items, *extra)),
    }[kind]
    moved = np.diag([scale, scale, scale, 1.0])
    moved[:3, 3] = offset * np.array([1.0, -0.7, 0.4])
    items = tuple(replace(item, shape=item.mesh.transformed(moved)) for item in scene.items)

    def place(point: tuple[float, float, float]) -> tuple[float, float, float]:
        x, y, z = (moved[:3, :3] @ np.asarray(point) + moved[:3, 3]).tolist()
        return (x, y, z)

    lamps = tuple(replace(light, position=place(light.position)) for light in scene.lights)
    lights = tuple(old if old.parallel else new for old, new in zip(scene.lights, lamps, strict=True))
    there = replace(scene, items=items, lights=lights)
    cameras = [Camera((6.0, -8.0, 5.0)), Camera(place((6.0, -8.0, 5.0)), place((0.0, 0.0, 0.0)))]
    page = Page(120.0, 90.0, 5.0)
    assert_same_picture(paint(scene, cameras[0], page=page), paint(there, cameras[1], page=page))


@pytest.mark.slow
@pytest.mark.hard(32)
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("kind", ["tori", "piercing_boxes", "on_a_floor"])
def test_the_order_of_the_items_does_not_show(kind: str) -> None:
    random = np.random.default_rng(4)
    scene = replace(STREWN[kind](random), lights=(SUN, LAMP))
    order = random.permutation(len(scene.items)).tolist()
    there = replace(scene, items=tuple(scene.items[k] for k in order))
    camera = Camera((7.0, -9.0, 8.0))
    assert_same_picture(paint(scene, camera), paint(there, camera))


@pytest.mark.slow
@pytest.mark.hard(57)
def test_the_same_scene_gives_the_same_polygons() -> None:
    first, second = (fills_of(paint(TABLE, CAMERAS[0], aura_mm=1.0)) for _ in range(2))
    for name in ("points", "offsets", "colours", "opacity", "item", "kind"):
        assert np.array_equal(getattr(first, name), getattr(second, name))


@pytest.mark.hard(55)
@pytest.mark.parametrize("scene", [Scene(()), Scene((), (SUN,)), Scene((), (SUN,), background="cyan")])
def test_an_empty_scene_is_an_empty_page(scene: Scene) -> None:
    drawing = paint(scene, page=SQUARE)
    assert kinds(drawing) == ({"background"} if scene.background else set())
    assert (drawing.width_mm, drawing.height_mm) == (100.0, 100.0)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("name", sorted(HARD_SHAPES))
@pytest.mark.parametrize("lights", [(), (SUN, LAMP)], ids=["dark", "lit"])
def test_hard_shapes_are_painted_with_finite_numbers(name: str, lights: tuple[Light, ...]) -> None:
    scene = replace(HARD_SHAPES[name], lights=lights)
    for camera in (None, Camera.view("top", (0.0, 0.0, 0.0), 9.0), Camera((0.1, 0.2, 0.3), (3.0, 1.0, 0.5))):
        fills = fills_of(paint(scene, camera, fit=camera is None))
        assert np.isfinite(fills.points).all() and np.isfinite(fills.points3d).all()
        assert len(fills) or camera is not None


def test_one_polygon_that_cannot_be_seen_leaves_an_empty_page() -> None:
    plate = numbered([Mesh.from_polygons([(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], [[0, 1, 2, 3]])])
    assert len(fills_of(paint(plate, top_view()))) == 0
    assert len(fills_of(paint(CUBE, Camera((0, -5, 0), (0, -9, 0)), fit=False))) == 0, "all of it is behind the eye"


def test_the_background_is_a_sheet_below_everything() -> None:
    fills = fills_of(paint(replace(CUBE, background="yellow"), CAMERAS[0], page=SQUARE))
    assert fills.kind[0] == FillKind.BACKGROUND and (fills.kind[1:] != FillKind.BACKGROUND).all()
    corners = fills.points[: fills.offsets[1]]
    assert (corners.min(axis=0) == 0.0).all() and (corners.max(axis=0) == 100.0).all()
    assert (fills.colours[0] == palette("yellow")[-1]).all()


@pytest.mark.parametrize("number", [2, 5, 32, 256])
def test_faces_have_colours_of_palettes_of_so_many_shades(number: int) -> None:
    scene = replace(rotated_boxes(20), lights=(SUN,))
    fills = fills_of(paint(scene, palette=number))
    shades = {tuple(shade) for shade in palette("gray", number).tolist()}
    used = {tuple(colour) for colour in fills.colours.tolist()}
    assert used <= shades and len(used) > 1


def test_opacity_is_written_and_shows_what_is_behind() -> None:
    ground = Item("GROUND", box((-2, -2, -1), (2, 2, 0)), "orange")
    pane = Item("PANE", box((-1, -1, 1), (1, 1, 1.1)), "blue", Material("transparent", 0.25), occludes=False)
    drawing = paint(Scene((ground, pane), (SUN,)), top_view(), page=SQUARE, fit=False, shadows="none")
    fills = fills_of(drawing)
    assert [set(fills.opacity[fills.item == k].tolist()) for k in (0, 1)] == [{1.0}, {0.25}]
    assert (fills.kind[fills.item == 1] == FillKind.GLASS).all()
    beside, through = at(drawing, (10.0, 10.0), (50.0, 50.0))
    blue = fills.colours[fills.offsets[:-1][fills.item == 1]][0]
    assert through == pytest.approx(0.75 * beside + 0.25 * blue)


def test_lights_of_the_caller_replace_those_of_the_scene() -> None:
    other = (Light((-2.0, 1.0, 4.0), parallel=True, intensity=0.9),)
    given = paint(TABLE, CAMERAS[0], lights=other)
    own = paint(replace(TABLE, lights=other), CAMERAS[0])
    assert_same_picture(given, own, levels=0.0)
    with pytest.raises(AssertionError):
        assert_same_picture(given, paint(TABLE, CAMERAS[0]))


def test_no_lights_or_none_that_cast_make_no_shadows() -> None:
    assert kinds(paint(TABLE, CAMERAS[0])) == {"face", "shadow"}
    assert kinds(paint(TABLE, CAMERAS[0], shadows="none")) == {"face"}
    assert kinds(paint(TABLE, CAMERAS[0], lights=())) == {"face"}
    assert kinds(paint(TABLE, CAMERAS[0], aura_mm=1.0)) == {"face", "shadow", "shadow_border"}


@pytest.mark.capability("G6.3-aura")
@pytest.mark.parametrize("fit", [True, False])
def test_the_aura_of_a_shadow_is_as_wide_on_the_page_as_it_is_told(fit: bool) -> None:
    ground = Item("GROUND", box((-2, -2, -1), (2, 2, 0)))
    plate = Item("PLATE", box((-0.5, -0.5, 1.0), (0.5, 0.5, 1.1)))
    scene = Scene((ground, plate), (Light((-1.0, 0.0, 1.0), parallel=True),))
    drawing = paint(scene, top_view(), page=SQUARE, fit=fit, aura_mm=3.0)
    fills = fills_of(drawing)
    # The right end of the shadow is that of the upper side: x = 0.5 + 1.1, in the middle of the page's height.
    edge = 50.0 + 25.0 * 1.6
    border = [
        colours_at(fills, top_at(fills, place), place)[0, 0]
        for place in (np.array([[edge + d, 50.0]]) for d in (-0.1, *np.linspace(0.1, 2.9, 29), 3.1))
    ]
    assert border[0] < border[1] and border[-2] < border[-1]
    # Soft: it becomes brighter in steps that hardly show.
    steps = np.diff(np.rint(border))
    assert (steps >= 0.0).all() and steps.max() < 0.2 * (border[-1] - border[0]) and len(set(np.rint(border))) > 8


@pytest.mark.slow
def test_smooth_surfaces_are_shaded_from_corner_to_corner_unless_told_otherwise() -> None:
    ball = Scene((Item("BALL", Sphere(1.0)),), (SUN,))
    smooth, flat = (fills_of(paint(ball, CAMERAS[0], smooth=on, tolerance_mm=0.5)) for on in (True, False))
    assert _varies(smooth).mean() > 0.8 and not _varies(flat).any()
    finer = fills_of(paint(ball, CAMERAS[0], tolerance_mm=0.05))
    assert len(finer) > 2 * len(smooth)


def _varies(fills: Fills) -> Floats:
    """(m,) whether polygons have several colours."""
    first = np.repeat(fills.colours[fills.offsets[:-1]], np.diff(fills.offsets), axis=0)
    return np.logical_or.reduceat((fills.colours != first).any(axis=1), fills.offsets[:-1])


def test_patterns_lie_on_their_faces_also_in_mirrors_and_shadows() -> None:
    spot = Pattern("SPOT", "red", 1, np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]))
    cube = Item("CUBE", box((-1, -1, -2), (1, 1, 0)), "blue", patterns=(spot,))
    roof = Item("ROOF", box((-0.2, -2, 1), (2, 2, 1.1)))
    scene = Scene((cube, roof), (Light((0.0, 0.0, 1.0), parallel=True, intensity=0.9),))
    drawing = paint(Scene(scene.items[:1], scene.lights), top_view(), page=SQUARE, fit=False)
    inside, outside = at(drawing, (55.0, 50.0), (70.0, 50.0))
    assert inside[0] > 100 and inside[2] < 20 and outside[2] > 100
    below = Camera((0.0, -0.5, 0.6), (0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0), fov_deg=100.0)
    fills = fills_of(paint(scene, below, page=SQUARE, fit=False))
    spots = fills.some(np.flatnonzero(fills.kind == FillKind.PATTERN))
    reds = np.unique(spots.colours[:, 0])
    assert len(reds) == 2 and reds[0] < 0.7 * reds[1], "one part in the light, one in the shadow"
    mirror = Item("MIRROR", box((-3, 2, -3), (3, 2.1, 3)), "cyan", Material("mirror"))
    seen = fills_of(paint(Scene((cube, mirror), scene.lights), Camera((0, -6, 5), (0, 1, 0)), page=SQUARE))
    doubles = (seen.kind == FillKind.REFLECTION) & (seen.item == 0)
    assert any((seen.colours[a][0] > 50) and (seen.colours[a][2] < 20) for a in seen.offsets[:-1][doubles].tolist())


ERRORS = [
    ({"shadows": "maybe"}, "shadows 'maybe'"),
    ({"aura_mm": -1.0}, "aura of -1 mm"),
    ({"aura_mm": np.nan}, "aura of nan mm"),
    ({"aura_mm": np.inf}, "aura of inf mm"),
    ({"palette": 1}, "palette of 1 shades"),
    ({"palette": 257}, "palette of 257 shades"),
    ({"palette": 3.5}, "palette of 3.5 shades"),
    ({"crease_angle_deg": float("nan")}, "crease angle of nan"),
    ({"tolerance_mm": 0.0}, "tolerance of 0 mm"),
    ({"tolerance_mm": np.nan}, "tolerance of nan mm"),
    ({"lights": (Light((np.nan, 0.0, 1.0)),)}, "light"),
    ({"lights": (Light((0.0, np.inf, 1.0), parallel=True),)}, "light"),
    ({"lights": (Light((0.0, 0.0, 0.0), parallel=True),)}, "light"),
    ({"lights": (Light((1.0, 2.0, 3.0)),) * 53}, "53 lights"),
]


@pytest.mark.hard(53)
@pytest.mark.parametrize("options, cause", ERRORS)
def test_options_out_of_range_are_named(options: dict, cause: str) -> None:
    with pytest.raises(InputError, match=cause) as caught:
        paint(CUBE, **options)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("size", [1e-200, 1e-120, 1e120, 1e200])
def test_sizes_whose_products_leave_the_range_of_numbers_are_an_error(size: float) -> None:
    scene = Scene((Item("A", box((-size, -size, -size), (size, size, size))),), (SUN,))
    for camera in (None, Camera((5 * size, -7 * size, 4 * size)), Camera((5.0, -7.0, 4.0))):
        with pytest.raises(InputError, match="out of range"):
            paint(scene, camera)


def test_unknown_colours_are_named() -> None:
    with pytest.raises(InputError, match="rubber"):
        paint(Scene((Item("A", box((0, 0, 0), (1, 1, 1)), "rubber"),)))
    with pytest.raises(InputError, match="sky"):
        paint(replace(CUBE, background="sky"))


def test_two_mirrors_show_each_other_as_plain_faces() -> None:
    walls = (
        Item("LEFT", box((-3, -3, 0), (-2.9, 3, 3)), "cyan", Material("mirror")),
        Item("BACK", box((-3, 3, 0), (3, 3.1, 3)), "green", Material("mirror")),
        Item("POST", box((-0.5, 0, 0), (0.5, 1, 1.5)), "orange"),
    )
    fills = fills_of(paint(Scene(walls, (SUN,)), Camera((4, -9, 4), (0, 0, 1))))
    doubles = fills.some(np.flatnonzero(fills.kind == FillKind.REFLECTION))
    assert set(doubles.item.tolist()) == {0, 1, 2}
    # What is painted after the double of the one mirror in the other are things before it, none of them its doubles.
    seen = fills.points3d[fills.offsets[:-1][fills.kind == FillKind.REFLECTION]]
    assert np.isfinite(seen).all()


def test_a_mirror_seen_edge_on_or_from_behind_shows_nothing() -> None:
    mirror = Item("MIRROR", box((-2, -1, 0.99), (2, 1, 1.0)), "cyan", Material("mirror"))
    post = Item("POST", box((-0.5, -0.5, 2), (0.5, 0.5, 3)), "orange")
    side = Camera((0.0, -9.0, 0.995), (0.0, 0.0, 0.995), parallel=True, height=6.0)
    plate = Mesh.from_polygons([(-2, -1, 1), (2, -1, 1), (2, 1, 1), (-2, 1, 1)], [[0, 1, 2, 3]])
    assert "reflection" not in kinds(paint(Scene((mirror, post), (SUN,)), side))
    single = Item("MIRROR", plate, "cyan", Material("mirror"))
    assert "reflection" in kinds(paint(Scene((single, post), (SUN,)), Camera((3, -6, 7))))
    assert "reflection" not in kinds(paint(Scene((single, post), (SUN,)), Camera((3, -6, -7))))


@pytest.mark.hard(20)
@pytest.mark.capability("G5.6-mikado")
def test_three_bars_in_a_ring_look_the_same_when_turned() -> None:
    drawing = paint(cyclic_bars(), top_view(5.0), page=SQUARE, fit=False)
    fills = fills_of(drawing)
    places = np.random.default_rng(0).random((4000, 2)) * 100.0
    c, s = np.cos(2.0 * np.pi / 3.0), np.sin(2.0 * np.pi / 3.0)
    turned = (places - 50.0) @ np.array([[c, s], [-s, c]]) + 50.0
    item, after = (np.append(fills.item, -1)[top_at(fills, some)] for some in (places, turned))
    assert (np.where(item >= 0, (item + 1) % 3, -1) == after).mean() > 0.999
    seen = np.bincount(item[item >= 0], minlength=3)
    assert seen.min() > 0.75 * seen.max() > 100
    assert len(fills) <= 3 * 3 + 4, "three faces of each bar at most, and a few cuts"


@pytest.mark.hard(21)
def test_boxes_that_pierce_each_other_change_places_at_their_intersection() -> None:
    scene = Scene(
        (
            Item("BLOCK", box((-1, -1, -1), (1, 1, 1)), "orange"),
            Item("ROD", box((-0.5, -0.5, -2), (0.5, 0.5, 2)), "green"),
        )
    )
    camera = Camera((4.0, -6.0, 5.0))
    fills = fills_of(paint(scene, camera))
    places = np.random.default_rng(1).random((3000, 2)) * (210.0, 297.0)
    top = top_at(fills, places)
    rod = top[(top >= 0) & (fills.item[top] == 1)]
    points = np.concatenate([fills.points3d[fills.offsets[k] : fills.offsets[k + 1]] for k in np.unique(rod).tolist()])
    # Of the rod one sees what is above the block, and the lower end of nothing that is seen is within it.
    assert len(rod) > 30 and points[:, 2].max() == pytest.approx(2.0)
    turned = interpenetrating_boxes()
    items = fills_of(paint(turned, camera)).item
    assert set(items.tolist()) == {0, 1}


@pytest.mark.hard(22)
def test_a_thing_wholly_hidden_is_painted_below_what_hides_it() -> None:
    hidden = Item("HIDDEN", box((-1, 1, -1), (1, 3, 1)), "red")
    wall = Item("WALL", box((-3, 0, -3), (3, 0.1, 3)), "blue")
    camera = Camera((0.5, -8.0, 0.25), (0.0, 0.0, 0.0))
    drawing = paint(Scene((hidden, wall)), camera)
    fills = fills_of(drawing)
    assert 0 in fills.item.tolist() and drawing.items == ("HIDDEN", "WALL")
    assert_same_picture(drawing, paint(Scene((wall,)), camera), levels=60.0)
    top = top_at(fills, np.random.default_rng(0).random((2000, 2)) * (210.0, 297.0))
    assert set(np.append(fills.item, -1)[top].tolist()) == {-1, 1}


@pytest.mark.hard(33)
def test_a_lamp_amid_the_scene_that_faces_the_camera_throws_no_shadow_towards_itself() -> None:
    ground = Item("GROUND", box((-6, -6, -1), (6, 6, 0)))
    posts = [
        Item(f"POST{x}{y}", box((x - 0.2, y - 0.2, 0), (x + 0.2, y + 0.2, 2))) for x, y in ((3, 0), (-3, 0), (0, 3))
    ]
    scene = Scene((ground, *posts), (Light((0.0, 0.0, 1.0), intensity=1.0),))
    drawing = paint(scene, top_view(12.0), page=Page(120.0, 120.0, 0.0), fit=False)
    fills = fills_of(drawing)

    def lit(x: float, y: float) -> bool:
        return bool(fills.kind[top_at(fills, np.array([[60.0 + 10.0 * x, 60.0 + 10.0 * y]]))[0]] == FillKind.FACE)

    assert [lit(5, 0.03), lit(-5, 0.03), lit(0.03, 5)] == [False] * 3, "behind the posts"
    assert [lit(2, 0.03), lit(-2, 0.03), lit(0.03, 2), lit(0.03, -5), lit(0.1, 0.13)] == [True] * 5, (
        "before them, and elsewhere"
    )


@pytest.mark.hard(35)
def test_equal_keys_paint_the_same_picture_each_time() -> None:
    cubes = [box((x, y, 0), (x + 1, y + 1, 1)) for x in range(3) for y in range(3)]
    scene = numbered([*cubes, *cubes])
    items = tuple(replace(item, colour=("orange", "blue")[k // 9]) for k, item in enumerate(scene.items))
    drawings = [paint(Scene(items, (SUN,)), Camera((7, -9, 8), (1, 1, 0))) for _ in range(2)]
    assert np.array_equal(fills_of(drawings[0]).points, fills_of(drawings[1]).points)
    assert np.array_equal(fills_of(drawings[0]).item, fills_of(drawings[1]).item)


def test_knots_of_many_bars_are_painted_right_and_stay_few_polygons() -> None:
    bars = []
    for k in range(12):
        turn = 2.0 * np.pi * k / 12
        c, s = np.cos(turn), np.sin(turn)
        a, b = np.cos(0.3), np.sin(0.3)
        about_z = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        tilt = np.array([[a, 0, b, 0], [0, 1, 0, -1.0], [-b, 0, a, 0], [0, 0, 0, 1]])
        bars.append(box((-3.0, -0.1, -0.05), (3.0, 0.1, 0.05)).transformed(about_z @ tilt))
    fills = fills_of(paint(replace(numbered(bars), lights=(SUN,)), top_view(7.0), shadows="none"))
    assert len(fills) < 12 * 3 * 4


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("kind", ["tori", "piercing_boxes", "on_a_floor", "mirror"])
def test_visible_fills_show_the_same_picture_without_painting_anything_over(kind: str) -> None:
    mirror = Item("MIRROR", box((-3, 2, 0), (3, 2.1, 3)), "cyan", Material("mirror"))
    strewn = TABLE if kind == "mirror" else STREWN[kind](np.random.default_rng(3))
    scene = replace(strewn, items=(*strewn.items, mirror) if kind == "mirror" else strewn.items, lights=(SUN, LAMP))
    camera = Camera((7.0, -9.0, 8.0))
    painted, visible = (paint(scene, camera, page=SQUARE, fills=how, smooth=False) for how in ("painted", "visible"))
    assert_same_picture(painted, visible, levels=3.0, apart=4)
    places = np.random.default_rng(1).random((4000, 2)) * 100.0
    place, _ = covering(fills_of(visible), places)
    assert (np.bincount(place, minlength=len(places)) > 1).sum() <= 2, "beside edges at most"


@pytest.mark.capability("G5.1-hollow")
def test_open_bodies_show_their_inner_sides() -> None:
    fills = fills_of(paint(replace(hollow_bodies(), lights=(SUN,)), Camera((5, -7, 8), (1.5, 1.5, 0))))
    assert {0, 1, 2, 3, 4} == set(fills.item.tolist())


def test_a_solid_of_many_faces_stays_as_it_is() -> None:
    scene = replace(random_convex_solids(6), lights=(SUN, LAMP))
    fills = fills_of(paint(scene, CAMERAS[0]))
    assert np.isfinite(fills.points).all() and len(fills) > 30


@pytest.mark.hard(31)
@pytest.mark.parametrize("distance", [1e3, 1e6, 1e9, 1e12])
def test_the_picture_from_afar_becomes_that_of_a_parallel_projection(distance: float) -> None:
    scene = replace(STREWN["plates"](np.random.default_rng(28)), lights=(SUN,))
    way = np.array([-0.35, -0.05, 0.65])
    far = Camera(tuple(distance * way), fov_deg=float(np.degrees(6.0 / distance)))
    parallel = Camera(tuple(9.0 * way), parallel=True, height=6.0)
    drawings = [paint(scene, camera, page=SQUARE) for camera in (far, parallel)]
    assert len(fills_of(drawings[0])) < 2 * len(fills_of(drawings[1])) < 200
    assert_same_picture(*drawings, levels=2.0, apart=40 if distance < 1e4 else 4)


def test_an_eye_in_the_planes_of_faces_sees_what_there_is() -> None:
    random = np.random.default_rng(154)
    random.integers(0, 3)
    scene = STREWN["on_a_floor"](random)
    fills = fills_of(paint(scene, Camera((0.0, 0.0, 1.0), (0.01, 0.01, 1.01)), page=SQUARE))
    assert len(fills) > 1 and np.isfinite(fills.points).all()


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("seed", [1, 2, 4, 6])
def test_shadows_seen_edge_on_have_no_aura(seed: int) -> None:
    random = np.random.default_rng(seed)
    scene = STREWN["on_a_floor"](random)
    lamp = Light(tuple(scene.vertices[int(random.integers(len(scene.vertices)))].tolist()))
    for eye in ((0.0, 0.0, 0.7), (-12.0, 3.0, 1.0), (0.3, -15.0, 1e-4)):
        fills = fills_of(paint(replace(scene, lights=(lamp, SUN)), Camera(eye, (0.1, 0.2, 0.3)), aura_mm=2.0))
        assert np.isfinite(fills.points).all()


@pytest.mark.slow
def test_what_one_sees_through_lets_light_through_whatever_it_says_about_lines() -> None:
    floor = Item("FLOOR", box((-5, -5, -1), (5, 5, 0)), "lightgray")
    pane = Item("PANE", box((-1, -1, 1), (1, 1, 1.2)), "cyan", Material("transparent", 0.4, 1.4))
    light = Light((0.3, 0.2, 5.0))
    drawings = []
    for occludes in (True, False):
        scene = Scene((floor, replace(pane, occludes=occludes)), (light,))
        drawings.append(paint(scene, Camera((9, -12, 9))).layers[0].fills[0])
    one, two = drawings
    assert np.array_equal(one.points, two.points) and np.array_equal(one.colours, two.colours)
    assert (one.kind == FillKind.CLEAR_SHADOW).any() and not (one.kind == FillKind.SHADOW).any()
