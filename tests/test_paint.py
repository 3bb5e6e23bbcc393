"""The verb paint: from a scene to filled polygons on a page."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.hard_shapes import HARD_SHAPES
from support.paint_scenes import CAMERAS, CUBE, LAMP, SQUARE, SUN, TABLE, kinds, top_view
from support.strewn import STREWN
from support.top_fills import assert_same_picture, blended, colours_at, fills_of, top_at

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item, Pattern
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.shading.palettes import palette
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import (
    box,
    numbered,
    rotated_boxes,
)


def at(drawing: Drawing, *places: tuple[float, float]) -> Floats:
    """(n,3) the colours of places of the page."""
    return blended(fills_of(drawing), np.array(places, dtype=np.float64))


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


@pytest.mark.slow
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
def test_smooth_surfaces_in_groups_are_shaded_from_corner_to_corner_unless_told_otherwise() -> None:
    ring = Scene((Item("RING", Torus(1.0, 0.5), group="G"),), (SUN,))
    smooth, flat = (fills_of(paint(ring, CAMERAS[0], smooth=on, tolerance_mm=0.5)) for on in (True, False))
    assert _varies(smooth).mean() > 0.8 and not _varies(flat).any()
    finer = fills_of(paint(ring, CAMERAS[0], tolerance_mm=0.05))
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
    fills = fills_of(paint(scene, below, page=SQUARE, fit=False, smooth=False))
    spots = fills.take(np.flatnonzero(fills.kind == FillKind.PATTERN))
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
