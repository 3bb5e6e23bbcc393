"""How cut faces are hatched: each part otherwise than those it touches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.layers import PENS
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cuts.section_faces import PlaneFrame
from vectorplot.geometry.vectors import dot, norm, normalize
from vectorplot.scene.cuts.cut import Cut
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section
from vectorplot.tolerances.of_angles import NO_AZIMUTH_SINE

ANGLES_DEG = (45.0, 135.0)
"""From what is level in the plane."""

FACTORS = (1.0, 0.6, 1.5)
"""How far apart strokes are, as multiples of what is usual. None is another one halved, however often."""

WAYS = tuple((angle, factor) for factor in FACTORS for angle in ANGLES_DEG)
"""Those of ISO 128-50, in the order in which they are taken: first the direction changes, then the spacing."""

USUAL_MM = 2.4
"""From stroke to stroke on the page, where nothing is asked for; half as much on narrow faces."""

NARROW_MM = 8.0
"""A square on the page with narrower sides, or a strip half as wide, is narrow."""

FINEST_MM = 0.7
"""No strokes are closer on the page (ISO 128-50), unless it is asked for."""

FLATTEST = 0.1
"""Planes that seem to be more foreshortened are hatched like those that are as much so: they are slivers."""

USUAL_PAGE_MM = 216.0
"""How large a scene is on its page, where nobody knows: an A4 sheet within its margins."""

INK = 0.5
"""Of a hatch that is closer than its pen is wide, at most so much of the paper is black."""

Way = tuple[float, float]
"""An angle in degrees, and a factor."""

InSpace = Callable[[Floats], Floats]
"""How long a millimetre of the page is at points (n,3) in space, across the sight: (n,)."""


def ways_of_parts(faces: list[list[Any]], tolerance: float) -> tuple[Way, ...]:
    """The angle and the spacing for each part: no two parts that touch have the same, as long as there are enough.

    faces: for each plane the areas (of shapely) of the parts in it, one each.
    Neighbours in the list of parts begin with different directions.
    """
    import shapely

    count = len(faces[0]) if faces else 0
    if not count:
        return ()
    touching: list[set[int]] = [set() for _ in range(count)]
    for areas in faces:
        tree = shapely.STRtree(areas)
        for one, other in tree.query(areas, predicate="dwithin", distance=tolerance).T.tolist():
            if one != other:
                touching[one].add(other)
    chosen: list[int] = []
    for part in range(count):
        taken = {chosen[other] for other in touching[part] if other < part}
        order = np.roll(np.arange(len(WAYS)).reshape(-1, 2), part % 2, axis=1).ravel().tolist()
        chosen.append(next((way for way in order if way not in taken), order[0]))
    return tuple(WAYS[way] for way in chosen)


def without_overlaps(areas: list[Any]) -> list[Any]:
    """The areas of shapely of several parts in a plane; where some overlap the smallest is left as it is."""
    import shapely

    every = np.array(areas, dtype=object)
    if not len(every):
        return []
    sizes = shapely.area(every)
    one, other = shapely.STRtree(every).query(every, predicate="intersects")
    smaller = (sizes[other] < sizes[one]) | ((sizes[other] == sizes[one]) & (other > one))
    for part in np.unique(one[smaller]).tolist():
        inner = [areas[k] for k in other[smaller & (one == part)].tolist()]
        every[part] = shapely.difference(areas[part], shapely.union_all(inner))
    return list(every)


def turned(cut: Cut, way: Way) -> Way:
    """A way of a part, turned to the angle that a cut asks for."""
    return cut.angle_deg + way[0] - ANGLES_DEG[0], way[1]


def page_hatch(cut: Cut, way: Way) -> Hatching:
    """The hatch of the faces of a part, if a cut asks for a spacing on the page; else none."""
    if cut.spacing_mm is None:
        return Hatching("none")
    spacing = cut.spacing_mm * way[1]
    width = min(PENS["hatch"].width_mm, INK * spacing)
    return Hatching("even", spacing, turned(cut, way)[0], along="surface", width_mm=width)


def usual_page(scene: Scene) -> InSpace:
    """What a millimetre is where a scene fills a page of usual size."""
    extent = float(np.ptp(scene.bounds, axis=0).max())
    return lambda points: np.full(len(points), extent / USUAL_PAGE_MM)


def spacings_in_space(
    frames: Sequence[PlaneFrame], faces: list[list[Any]], ways: list[list[Way]], in_space: InSpace, camera: Camera
) -> Floats:
    """(n,k) how far apart the strokes of each of k parts are in each of n planes.

    faces: for each plane the areas (of shapely) of the parts in it; ways: of these, as their cuts have turned them.
    A part has one spacing in all planes, but for planes that are seen so flat that some part of them would be hatched
    too closely: there all are wider apart.
    """
    import shapely

    areas = np.array(faces, dtype=object)
    shown = ~shapely.is_empty(areas)
    middle = np.zeros((*shown.shape, 2))
    middle[shown] = np.nan_to_num(shapely.get_coordinates(shapely.centroid(areas[shown])))
    points = np.stack([frame.points(places) for frame, places in zip(frames, middle, strict=True)])
    mm = in_space(points.reshape(-1, 3)).reshape(shown.shape)
    length = np.where(shown, shapely.length(areas), 1.0)
    wide = np.where(shown, 4.0 * shapely.area(areas) / (length * mm), 0.0).max(axis=0)
    angles, factors = np.moveaxis(np.array(ways, dtype=np.float64), -1, 0)
    usual = np.where(wide < NARROW_MM, 0.5, 1.0) * USUAL_MM * factors[0]
    apart = usual * np.where(shown, mm, 0.0).max(axis=0)
    flat = np.stack([_foreshortened(*one, camera) for one in zip(frames, points, angles, strict=True)])
    closest = np.where(shown, apart * flat / mm, np.inf).min(axis=1)
    return np.asarray(apart * np.maximum(FINEST_MM / closest, 1.0)[:, None])


def _foreshortened(frame: PlaneFrame, points: Floats, angles_deg: Floats, camera: Camera) -> Floats:
    """(k,) what share of their distance strokes at angles through points (k,3) of a plane seem to have."""
    sight = np.broadcast_to(camera.axes[2], points.shape) if camera.parallel else normalize(camera.eye - points)
    along = np.stack([stroke_axes(frame, angle)[0] for angle in angles_deg.tolist()])
    seen = np.sqrt(np.maximum(1.0 - dot(along, sight) ** 2, FLATTEST**2))
    return np.asarray(np.maximum(np.abs(matmul(sight, np.cross(*frame.axes))) / seen, FLATTEST))


def stroke_axes(frame: PlaneFrame, angle_deg: float) -> Floats:
    """(2,3) the unit vectors along strokes and across them, at an angle from what is level in a plane."""
    normal = np.cross(*frame.axes)
    level = np.array([-normal[1], normal[0], 0.0])
    if float(norm(level)) <= NO_AZIMUTH_SINE:
        level = np.array([1.0, 0.0, 0.0])
    level -= normal * float(matmul(normal, level))
    level /= norm(level)
    upward, angle = np.cross(normal, level), np.radians(angle_deg)
    return np.asarray(np.cos(angle) * np.stack([level, upward]) + np.sin(angle) * np.stack([upward, -level]))


def hatch_section(frame: PlaneFrame, points: Floats, angle_deg: float, spacing: float) -> Section:
    """The planes, so far apart, whose sections of a plane face with corners points (n,3) are its hatch."""
    _, across = stroke_axes(frame, angle_deg)
    # Counted from the frame, so that all faces of a part in a plane have one set of strokes.
    base = float(matmul(frame.origin, across))
    heights = matmul(points - frame.origin, across)
    numbers = np.arange(np.ceil(heights.min() / spacing - 0.5), np.floor(heights.max() / spacing - 0.5) + 1.0)
    x, y, z = across.tolist()
    return Section((x, y, z), tuple((base + (numbers + 0.5) * spacing).tolist()))
