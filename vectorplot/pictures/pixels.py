"""The stages of render: pixels in bands, the light on them, and lines and a colour bar over and beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.finishing import long_strokes
from vectorplot.errors import InputError
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.geometry.vectors import cross
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.scene.light import Light
from vectorplot.scene.page import MM_PER_INCH, Page
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.shading.image import Bytes, averaged
from vectorplot.shading.lighting import Blocked, Lighting, lighting_of
from vectorplot.shading.map_settings import MapSettings
from vectorplot.shading.quadric_pixels import boxes_around
from vectorplot.shading.scene_pixels import Picture, opaque_buffer, shaded, with_glass, with_mirrors
from vectorplot.shading.screen import LARGEST_RASTER_PIXELS, LARGEST_SIDE_PIXELS, SceneTriangles
from vectorplot.tolerances import LARGEST_VIEW
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies

if TYPE_CHECKING:
    from vectorplot.effects.colour_maps import ColourBar
    from vectorplot.shading.seen_region import SeenRegion


# Lines and blank places over a picture of pixels.


def with_blanks(pixels: Bytes, blanks: Fills) -> Bytes:
    """The picture with polygons over it."""
    return with_layers(pixels, (Layer("blank", Pen(), (blanks,)),))


def with_lines(pixels: Bytes, found: Paths, pen: Pen) -> Bytes:
    """The picture with lines of a pen, its width in pixels, over it."""
    return with_layers(pixels, (Layer("", pen, (long_strokes(found),)),))


def with_layers(pixels: Bytes, layers: tuple[Layer, ...]) -> Bytes:
    """The picture with layers over it."""
    from vectorplot.backends.raster import painted

    rows, columns = pixels.shape[:2]
    return painted(pixels, Drawing(float(columns), float(rows), layers))


# Pixels of a picture, made in bands.

BAND_PIXELS = 1 << 22
"""So many pixels are in memory at a time."""


def pixels_in_bands(pipeline: Pipeline, picture: Picture, samples: int, reflections: int = 1) -> Bytes:
    """(rows, columns, 3) the finer picture, made in bands; reflections: see with_mirrors."""
    result = np.zeros((picture.rows, picture.columns, 3), dtype=np.uint8)
    step = max(1, BAND_PIXELS // (picture.columns * samples)) * samples
    tops = range(0, picture.rows, step)
    for number, top in enumerate(tops):
        bottom = min(top + step, picture.rows)
        band = pipeline.repetition(("depth", "shading", "mirrors", "transparency"), number, len(tops))
        buffer = band.run("depth", opaque_buffer, picture, top, bottom)
        colours = band.run("shading", shaded, picture, buffer)
        if band.calls_for("mirrors"):
            colours = band.run("mirrors", with_mirrors, picture, buffer, colours, reflections)
        if band.calls_for("transparency"):
            colours = band.run("transparency", with_glass, picture, buffer, colours)
        result[top:bottom] = np.rint(colours)
    return result


# Pictures of pixels whose colours stand for numbers: beside them is the bar that explains these.

PIXELS_PER_MM = 96.0 / MM_PER_INCH
"""How large a millimetre of letters is, as on screens."""

BAR_SAMPLES = 4
"""Along each side of a pixel of a colour bar."""


def pixels_left_of_bar(size: tuple[int, int], bar: ColourBar | None) -> tuple[int, int]:
    """Columns and rows that a colour bar leaves of a picture."""
    if bar is None:
        return size
    from vectorplot.effects.colour_maps import strip_mm

    return max(1, size[0] - round(strip_mm(size[0] / PIXELS_PER_MM, bar.colouring) * PIXELS_PER_MM)), size[1]


def pixels_beside_bar(pixels: Bytes, bar: ColourBar | None, size: tuple[int, int], paper: Floats) -> Bytes:
    """The pixels of a picture with those of a colour bar to the right of them, on paper (3,); where there is none
    they stay."""
    if bar is None:
        return pixels
    from vectorplot.backends.raster import painted
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.effects.colour_maps import with_colour_bar

    rows, columns = pixels.shape[:2]
    width, height = columns / PIXELS_PER_MM, rows / PIXELS_PER_MM
    drawing = with_colour_bar(Drawing(width, height, ()), bar, size[0] / PIXELS_PER_MM)
    blank = np.broadcast_to(np.rint(paper).astype(np.uint8), (BAR_SAMPLES * rows, BAR_SAMPLES * size[0], 3))
    beside = averaged(painted(blank, drawing)[:, BAR_SAMPLES * columns :], BAR_SAMPLES)
    return np.concatenate([pixels, np.rint(beside).astype(np.uint8)], axis=1)


# What options of render may be.

MARGIN = 0.03
"""Part of the shorter side of a picture that stays free on each side where nobody says how much."""

SAMPLES = 2
"""Along each side of a pixel, unless told otherwise."""


FEWEST_TEXELS, MOST_TEXELS = 256, 4096
"""Along the side of a shadow map, unless told otherwise."""


def default_samples(size: tuple[int, int]) -> int:
    """Along each side of a pixel where nobody says how many."""
    fine = (size[0] * SAMPLES, size[1] * SAMPLES)
    return SAMPLES if max(fine) <= LARGEST_SIDE_PIXELS and fine[0] * fine[1] <= LARGEST_RASTER_PIXELS else 1


def default_shadow_size(size: tuple[int, int]) -> int:
    """Texels along the side of a shadow map where nobody says how many: the power of two no less than the longer
    side of the picture, 256 to 4096."""
    needed = 1 << (int(max(size)) - 1).bit_length()
    return min(max(needed, FEWEST_TEXELS), MOST_TEXELS)


def raster_page(size: tuple[int, int], margin: float | None, unit: float) -> Page:
    """The page that a picture of some pixels with a margin (pixels; None: MARGIN) is, a pixel being so long.

    Errors: InputError for a margin that is negative, not finite, or leaves nothing.
    """
    margin = MARGIN * min(size) if margin is None else margin
    if not 0.0 <= 2.0 * margin < min(size):
        raise InputError(f"a margin of {margin:g} pixels: expected 0 to less than half of {min(size)}")
    return Page(size[0] * unit, size[1] * unit, margin * unit)


def check_whole(**counts: int) -> None:
    """InputError for counts, by their names, that are no whole numbers."""
    for name, count in counts.items():
        if not float(count).is_integer():
            raise InputError(f"{name} {count:g}: expected a whole number")


def check_lights(lights: Sequence[Light]) -> None:
    """InputError for lights without a direction, or too far away."""
    for number, light in enumerate(lights):
        name = f"light {light.name or number}"
        # NaN is not smaller.
        if not all(abs(coordinate) < LARGEST_VIEW for coordinate in light.position):
            raise InputError(f"{name}: a place or direction of {light.position} is out of range")
        if light.parallel and not any(light.position):
            raise InputError(f"{name}: its rays have no direction")


# Light on a scene, and what keeps it off: shadow buffers, and exact shadows.


@dataclass(frozen=True, eq=False)
class ShadowMaps:
    """How shadows of some triangles and quadric bodies are found: by which way, with what maps, tapered for what is
    seen (None: not). sides (i,): of items that are closed, see outer_sides. Those of bodies are exact anyway."""

    triangles: SceneTriangles
    lights: tuple[Light, ...]
    shadows: str
    settings: MapSettings
    region: SeenRegion | None
    sides: Ints
    bodies: QuadricBodies | None

    def of_items(self, casts: Bools) -> tuple[Blocked, ...]:
        """For every light what it does not reach as items (i,) stand before it."""
        found = self._of_triangles(casts)
        return found if self.bodies is None else with_bodies(found, self.lights, self.bodies, casts)

    def _of_triangles(self, casts: Bools) -> tuple[Blocked, ...]:
        triangles = self.triangles
        shown = casts[triangles.item]
        if self.shadows == "exact":
            from vectorplot.shading.shadow_rays import exact_shadows

            # The last one is that of what is no triangle.
            number = np.append(np.where(shown, np.cumsum(shown) - 1, -1), -1)
            return exact_shadows(self.lights, triangles.points, triangles.corners[shown], number)
        from vectorplot.shading.shadow_maps import shadow_buffers

        side, corners = self.sides[triangles.item[shown]], triangles.corners[shown]
        settings = self.settings
        if settings.casting == "away":
            # Which way a face turns is known of closed bodies only.
            settings = settings if (side != 0).all() else replace(settings, casting="all")
            corners = np.where((side < 0)[:, None], corners[:, ::-1], corners)
        return shadow_buffers(self.lights, triangles.points, corners, settings, self.region)

    def of_clear_items(self, scene: Scene) -> tuple[tuple[str, float, tuple[Blocked, ...]], ...]:
        """The same for what light comes through: colours and opacities, and what is dimmed by things that have them."""
        groups: dict[tuple[str, float], Bools] = {}
        for number, item in enumerate(scene.items):
            if item.dims_light:
                same = (item.colour, item.material.opacity)
                groups.setdefault(same, np.zeros(len(scene.items), dtype=np.bool_))[number] = True
        return tuple((colour, opacity, self.of_items(casts)) for (colour, opacity), casts in groups.items())


def with_bodies(
    blocked: tuple[Blocked, ...], lights: Sequence[Light], bodies: QuadricBodies, casts: Bools
) -> tuple[Blocked, ...]:
    """For every light what it does not reach because of triangles, or of bodies of items that cast shadows (i,)."""
    from vectorplot.shading.quadric_shadows import QuadricShadows

    some = bodies.take(casts[bodies.item])
    if not len(some):
        return blocked

    def either(one: Blocked, other: Blocked) -> Blocked:
        def both(places: Floats, normals: Floats, triangle: Ints) -> Bools:
            found = one(places, normals, triangle)
            left = np.flatnonzero(~found)
            found[left] = other(places[left], normals[left], triangle[left])
            return found

        return both

    pairs = zip(blocked, lights, strict=True)
    return tuple(either(own, QuadricShadows.of(light, some)) for own, light in pairs)


def scene_lighting(pipeline: Pipeline, scene: Scene, view: View, maps: ShadowMaps) -> Lighting:
    """The lights and their shadows, as far as the plan has any."""
    blocked: tuple[Blocked, ...] = ()
    clear: tuple[tuple[str, float, tuple[Blocked, ...]], ...] = ()
    if pipeline.calls_for("shadows"):
        casts = np.array([item.casts_shadow for item in scene.items], dtype=np.bool_)
        blocked = pipeline.run("shadows", maps.of_items, casts)
    if pipeline.calls_for("transparent shadows"):
        clear = pipeline.run("transparent shadows", maps.of_clear_items, scene)
    return lighting_of(view, scene.items, maps.lights, blocked, clear)


def tapered_for(
    triangles: SceneTriangles,
    bodies: QuadricBodies | None,
    system: CoordinateSystem,
    size: tuple[int, int],
    shadows: str,
) -> SeenRegion | None:
    """What is seen, for shadow maps that are tapered for it; None for others."""
    if shadows not in ("trapezoid", "perspective"):
        return None
    from vectorplot.shading.seen_region import region_in_picture

    points, corners = triangles.points, triangles.corners
    if bodies is not None:
        boxes, sides = boxes_around(bodies)
        points, corners = np.concatenate([points, boxes]), np.concatenate([corners, len(points) + sides])
    return region_in_picture(system, *size, points, corners)


# How many places shadow maps say a wrong thing of, measured against exact shadows.

PLACES = 1024
"""So many places are asked about."""


def wrong_shadows(
    scene: Scene, triangles: SceneTriangles, bodies: QuadricBodies | None, lighting: Lighting
) -> float | None:
    """Of how many of 100 places, spread over the triangles of a scene by their area, maps say wrongly whether a light
    reaches them; None for a scene without area."""
    corners, points = triangles.corners, triangles.points
    a, b, c = (points[corners[:, k]] for k in range(3))
    area = np.linalg.norm(cross(b - a, c - a), axis=1)
    whole = np.cumsum(area)
    if not len(whole) or not whole[-1] > 0.0:
        return None
    random = np.random.default_rng(0)
    which = np.searchsorted(whole, whole[-1] * (np.arange(PLACES) + 0.5) / PLACES)
    s, t = random.random((2, PLACES, 1))
    s, t = np.where(s + t > 1.0, 1.0 - s, s), np.where(s + t > 1.0, 1.0 - t, t)
    places = a[which] + s * (b - a)[which] + t * (c - a)[which]
    normals = cross(b - a, c - a)[which] / area[which, None]
    items = np.array([item.casts_shadow for item in scene.items], dtype=np.bool_)
    casts = items[triangles.item]
    number = np.where(casts, np.cumsum(casts) - 1, -1)
    from vectorplot.shading.shadow_rays import exact_shadows

    true = exact_shadows(lighting.lights, points, corners[casts], number)
    true = true if bodies is None else with_bodies(true, lighting.lights, bodies, items)
    wrong = [
        (says(places, normals, which) != is_so(places, normals, which)).mean()
        for says, is_so in zip(lighting.blocked, true, strict=True)
    ]
    return 100.0 * float(np.mean(wrong))
