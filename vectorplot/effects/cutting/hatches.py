"""How cut faces are hatched: each part otherwise than those it touches."""

from __future__ import annotations

from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.layers import PENS
from vectorplot.geometry.cuts.section_faces import PlaneFrame
from vectorplot.scene.cuts.cut import Cut
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.surface_lines import Section
from vectorplot.tolerances.of_angles import NO_AZIMUTH_SINE

ANGLES_DEG = (45.0, 135.0)
"""From what is level in the plane."""

SPACINGS = (1.0 / 90.0, 1.0 / 150.0, 1.0 / 60.0)
"""From stroke to stroke, as parts of the extent of the scene: about 2, 1.2 and 3 mm on a page of usual size."""

WAYS = tuple((angle, spacing) for spacing in SPACINGS for angle in ANGLES_DEG)
"""Those of ISO 128-50, in the order in which they are taken: first the direction changes, then the spacing."""

INK = 0.5
"""Of a hatch that is closer than its pen is wide, at most so much of the paper is black."""

Way = tuple[float, float]


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
    spacing = cut.spacing_mm * way[1] / SPACINGS[0]
    width = min(PENS["hatch"].width_mm, INK * spacing)
    return Hatching("even", spacing, turned(cut, way)[0], along="surface", width_mm=width)


def hatch_section(frame: PlaneFrame, points: Floats, way: Way, extent: float) -> Section:
    """The planes whose sections of a plane face with corners points (n,3) are its hatch; extent: of the scene."""
    normal = np.cross(*frame.axes)
    level = np.array([-normal[1], normal[0], 0.0])
    if float(np.linalg.norm(level)) <= NO_AZIMUTH_SINE:
        level = np.array([1.0, 0.0, 0.0])
    level -= normal * float(normal @ level)
    level /= np.linalg.norm(level)
    angle, spacing = np.radians(way[0]), way[1] * extent
    across = np.cos(angle) * np.cross(normal, level) - np.sin(angle) * level
    # Counted from the frame, so that all faces of a part in a plane have one set of strokes.
    base = float(frame.origin @ across)
    heights = (points - frame.origin) @ across
    numbers = np.arange(np.ceil(heights.min() / spacing - 0.5), np.floor(heights.max() / spacing - 0.5) + 1.0)
    x, y, z = across.tolist()
    return Section((x, y, z), tuple((base + (numbers + 0.5) * spacing).tolist()))
