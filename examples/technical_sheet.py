"""A technical sheet of a flange from an STL file: views in line, a section, dimensions, centre lines, a title block.

The flange is made here too, of prisms above areas with holes, and written as other programs write theirs.
"""

import itertools
import sys
import tempfile
from pathlib import Path

import numpy as np
import shapely

import vectorplot as vp

BOLTS = [(30.0 * np.cos(turn), 30.0 * np.sin(turn)) for turn in np.radians([45, 135, 225, 315])]


def disk(radius: float, x: float = 0.0, y: float = 0.0) -> shapely.Polygon:
    """A disk with a fine outline, as of a CAD program."""
    turn = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
    return shapely.Polygon(np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn)]))


def cap(area: shapely.Polygon, height: float, upwards: bool) -> list[np.ndarray]:
    """The triangles of a level area."""
    flat = [
        shapely.get_coordinates(part.normalize())[:3] for part in shapely.constrained_delaunay_triangles(area).geoms
    ]
    # Normalised rings run clockwise.
    return [np.column_stack([ring[::-1] if upwards else ring, np.full(3, height)]) for ring in flat]


def wall(ring: shapely.LinearRing, low: float, high: float) -> list[np.ndarray]:
    """The triangles between two heights along a ring, with the inside of the body at its left."""
    points = shapely.get_coordinates(ring)
    found = []
    for a, b in itertools.pairwise(points):
        found += [np.array([(*a, low), (*b, low), (*b, high)]), np.array([(*a, low), (*b, high), (*a, high)])]
    return found


def flange() -> np.ndarray:
    """(n,3,3) triangles: a plate with four bolt holes and a hub, and a bore through both."""
    bore = disk(10)
    plate = shapely.difference(disk(40), shapely.union_all([bore, *(disk(4, x, y) for x, y in BOLTS)]))
    plate, hub = (shapely.orient_polygons(area) for area in (plate, shapely.difference(disk(20), bore)))
    triangles = [*cap(plate, 0, False), *cap(shapely.difference(plate, disk(20)), 10, True), *cap(hub, 30, True)]
    triangles += [*wall(plate.exterior, 0, 10), *wall(hub.exterior, 10, 30)]
    for ring in plate.interiors:
        triangles += wall(ring, 0, 30 if ring.contains(shapely.Point(10, 0)) or ring.length > 40 else 10)
    return np.array(triangles)


def write_stl(triangles: np.ndarray, path: Path) -> None:
    """A binary STL file."""
    rows = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("unused", "<u2")])
    rows["corners"] = triangles
    path.write_bytes(bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes())


def main(folder: Path) -> None:
    with tempfile.TemporaryDirectory() as place:
        write_stl(flange(), Path(place) / "flange.stl")
        part = vp.read(Path(place) / "flange.stl")
    sizes = [
        vp.dimension((-10, 0, 30), (10, 0, 30), (0, 0, 8), "ø20 H7", gap=1, beyond=2),
        vp.dimension((40, 0, 0), (40, 0, 10), (8, 0, 0), gap=1, beyond=2),
        vp.leader((BOLTS[0][0] + 2.83, BOLTS[0][1] + 2.83, 10), (44, 36, 10), "4 x ø8"),
    ]
    sheet = vp.technical_sheet(
        [part, *sizes],
        **{"section": "y=0", "scale": "1:1", "page": "A3", "dimensions": True, "centre_lines": True, "frame": True},
        **{"title": "Flange", "author": "vectorplot", "date": "2026-11-22", "sheet": "1/1"},
    )
    vp.save(sheet, folder / "technical_sheet.svg")
    assert (sheet.width_mm, sheet.height_mm, sheet.title) == (420, 297, "Flange, 1:1")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
