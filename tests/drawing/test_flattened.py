"""Polygons and what lies on them: the same picture, and no place at a border painted twice."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.effort import several

from vectorplot.backends.cairo import drawing_pixels
from vectorplot.drawing.fill_visibility import MARGIN_MM, flattened
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, stacked
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.regions import polygons_of
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.testing.shapes import box
from vectorplot.tolerances import CLEARANCE_MM

WORLD = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 1.0, 0], [0, 0, 0, 1.0]])
"""The page is the world."""


def rectangle(left: float, bottom: float, right: float, top: float, **more: object) -> Fills:
    points = np.array([[left, bottom], [right, bottom], [right, top], [left, top]])
    colour = np.array([more.pop("colour", (200, 100, 50))], dtype=np.uint8)
    return Fills.flat(points, np.array([0, 4]), colour, **more)  # type: ignore[arg-type]


def random_stacks(random: np.random.Generator, clear: bool) -> tuple[Fills, list[Overlay]]:
    """Squares side by side, and on each some rectangles, up to its border or not."""
    base = Fills.joined(*(rectangle(10 * k, 0, 10 * k + 10, 10, colour=(250, 240, 230)) for k in range(6)))
    overlays = []
    for turn in range(3):
        parts, after = [], []
        for k in range(6):
            for _ in range(random.integers(3)):
                (left, bottom), size = random.choice([0.0, 2.0, 5.0], 2), random.choice([3.0, 5.0, 10.0], 2)
                right, top = np.minimum(np.array([left, bottom]) + size, 10.0)
                opacity = 0.5 if clear and turn == 2 else 1.0
                colour = tuple(random.integers(0, 200, 3).tolist())
                parts.append(
                    rectangle(10 * k + left, bottom, 10 * k + right, top, colour=colour, opacity=opacity, kind=turn + 1)
                )
                after.append(k)
        overlays.append(Overlay(Fills.joined(*parts), np.array(after, dtype=np.intp)))
    return base, overlays


def seen(fills: Fills, samples: np.ndarray) -> np.ndarray:
    """(n,3) the colours at points."""
    shown = np.full((len(samples), 3), 255.0)
    for k, polygon in enumerate(polygons_of(fills.points.T, fills.offsets)):
        inside = shapely.contains_xy(polygon, *samples.T)
        colour = fills.colours[fills.offsets[k]].astype(float)
        shown[inside] += fills.opacity[k] * (colour - shown[inside])
    return shown


@pytest.mark.slow
@pytest.mark.parametrize("clear", [False, True])
def test_the_picture_stays_and_nothing_at_a_border_is_covered_twice(clear: bool) -> None:
    for seed in range(several(4, long=60)):
        random = np.random.default_rng(seed)
        base, overlays = random_stacks(random, clear)
        before, after = stacked([Overlay(base, np.arange(len(base))), *overlays]), flattened(base, overlays, WORLD)
        samples = random.uniform((0.0, 0.0), (60.0, 10.0), (2000, 2))
        sides = shapely.union_all(shapely.boundary(polygons_of(before.fills.points.T, before.fills.offsets)))
        samples = samples[shapely.distance(shapely.points(samples), sides) > 2.0 * CLEARANCE_MM]
        assert np.abs(seen(before.fills, samples) - seen(after.fills, samples)).max() <= 2.0, seed
        # The same points moved to the borders of the squares.
        rims = [(0.1, 9.9)[int(k) % 2] for k in samples[:, 1]]
        near = np.column_stack([samples[:, 0], rims])
        near = near[shapely.distance(shapely.points(near), sides) > 2.0 * CLEARANCE_MM]
        polygons = polygons_of(after.fills.points.T, after.fills.offsets)
        number = shapely.STRtree(polygons).query(shapely.points(near), predicate="within")[0]
        assert (np.bincount(number, minlength=len(near)) == 1).all(), seed
        assert (after.fills.opacity == 1.0).all()


def test_what_does_not_reach_the_border_lies_on_the_whole_polygon() -> None:
    base = rectangle(0, 0, 10, 10)
    inner = Overlay(rectangle(2, 2, 2 + MARGIN_MM, 8, kind=FillKind.SHADOW), np.array([0]))
    found = flattened(base, [inner], WORLD)
    assert len(found.fills) == 2 and np.array_equal(found.fills.points[:4], base.points)


def test_what_is_covered_by_several_is_left_out() -> None:
    base = rectangle(0, 0, 10, 10)
    halves = Fills.joined(rectangle(0, 0, 6, 10, colour=(9, 9, 9)), rectangle(4, 0, 10, 10, colour=(9, 9, 9)))
    found = flattened(base, [Overlay(halves, np.array([0, 0]))], WORLD)
    assert len(found.fills) == 1 and (found.fills.colours == 9).all()


def test_what_lies_on_transparent_polygons_stays() -> None:
    base = rectangle(0, 0, 10, 10, opacity=0.5)
    on = Overlay(rectangle(0, 0, 10, 10, colour=(9, 9, 9)), np.array([0]))
    assert flattened(base, [on], WORLD).fills.opacity.tolist() == [0.5, 1.0]


def test_shaded_polygons_keep_their_colours_where_they_are_cut() -> None:
    base = rectangle(0, 0, 10, 10)
    colours = np.array([[0, 0, 0], [200, 0, 0], [200, 200, 0], [0, 200, 0]], dtype=np.uint8)
    base = Fills(base.points, base.offsets, colours, base.opacity, base.item, base.points3d, base.kind)
    for corner in ((3.0, 0.0, 6.0, 4.0), (0.0, 0.0, 10.0, 4.0)):
        on = Overlay(rectangle(*corner, colour=(9, 9, 9), kind=FillKind.SHADOW), np.array([0]))
        found = flattened(base, [on], WORLD).fills
        part = found.take(np.flatnonzero(found.kind == FillKind.FACE))
        expected = np.column_stack([20.0 * part.points, np.zeros(len(part.points))])
        assert np.abs(part.colours - expected).max() <= 0.5


def floor(height: float, count: int = 10) -> Mesh:
    """Triangles on a plane, or on a wavy surface."""
    x, y = np.meshgrid(np.linspace(-4.0, 4.0, count + 1), np.linspace(-4.0, 4.0, count + 1))
    vertices = np.stack([x, y, height * np.sin(1.3 * x) * np.cos(y)], axis=-1).reshape(-1, 3)
    first = np.arange(count * (count + 1)).reshape(count, count + 1)[:, :-1].ravel()
    low, high = [first, first + 1, first + count + 2], [first, first + count + 2, first + count + 1]
    return Mesh.from_triangles(vertices, np.concatenate([np.stack(low, 1), np.stack(high, 1)]))


FINER = 4
"""So many times as many pixels each way show what a picture is, apart from a hair of light."""


@pytest.mark.slow
@pytest.mark.hard(75)
@pytest.mark.spread
@pytest.mark.parametrize("opacity", [1.0, 0.5])
@pytest.mark.parametrize("height", [0.0, 0.4])
def test_no_light_between_faces_in_the_shadow(height: float, opacity: float) -> None:
    from scipy.ndimage import maximum_filter, minimum_filter

    material = Material("transparent", opacity) if opacity < 1.0 else Material()
    roof = Item("ROOF", box((-2.2, -2.2, 3.0), (2.2, 2.2, 3.3)), material=material)
    scene = Scene((Item("FLOOR", floor(height)), roof), (Light((0.3, 0.2, 1.0), parallel=True, intensity=1.0),))
    drawing = paint(scene, Camera((9, -14, 11), (0, 0, 0.5), fov_deg=30.0), page=Page(60.0, 47.0, 3.0))
    for dpi in (110, 170):
        # Borders of shaded triangles are drawn in more than one way. On even ones floor, shadow and roof are each
        # rounded by half a level.
        limit = 8.0 if height > 0.0 else 1.5
        found = drawing_pixels(drawing, dpi=dpi).mean(axis=2)
        fine = drawing_pixels(drawing, dpi=FINER * dpi).mean(axis=2)
        rows, columns = np.minimum(found.shape, np.array(fine.shape) // FINER)
        truth = fine[: FINER * rows, : FINER * columns].reshape(rows, FINER, columns, FINER).mean(axis=(1, 3))
        even = (maximum_filter(truth, 3) - minimum_filter(truth, 3) <= 8.0) & (truth < 200.0)
        assert even.sum() > 1000
        assert (found[:rows, :columns] - truth)[even].max() <= limit
