"""Approximations of smooth surfaces by triangles, measured: contours of meshes, painted polygons, implicit surfaces."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way, on_page, page_from_world
from vectorplot.accuracy.of_light import pixels_of, wrong_share
from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import Fills
from vectorplot.features.contours_and_isophotes import contour
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.grid_triangulation import mesh_of_grid
from vectorplot.features.mesh_lines import mesh_contour_across_faces
from vectorplot.features.polygonization import polygonized
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.regions import polygons_of
from vectorplot.geometry.vectors import cross, dot
from vectorplot.geometry.winding import edge_uses
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.shading.shade_bands import ROUNDED_MM
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.testing.curves import hausdorff
from vectorplot.tolerances import CONTOUR_ACCURACY_MM, OUTLINE_ACCURACY_MM, TRUE_CONTOUR

# Contours of meshes that stand for a smooth surface.

TORUS, EYE = Torus(3.0, 1.2), np.array([7.0, -5.0, 14.0])


def _study() -> Study:
    matrix = page_from_world(Camera(eye=tuple(EYE)), np.array([(-4.2, -4.2, -1.2), (4.2, 4.2, 1.2)]))

    def smooth(tolerance: float | None = None) -> list[Floats]:
        found = contour(TORUS, EYE, tracing=Tracing(tolerance=tolerance))
        return [found[k] for k in range(len(found))]

    truth = [on_page(matrix, line) for line in smooth(TRUE_CONTOUR)]

    def error(lines: list[Floats]) -> float:
        return hausdorff([on_page(matrix, line) for line in lines], truth, accuracy=CONTOUR_ACCURACY_MM)

    def count(lines: list[Floats]) -> int:
        return sum(len(line) - 1 for line in lines)

    ways = (Way("along edges", edge_contour, -2.0), Way("across faces", contour_across_faces, -2.0))
    return Study(ways, error, count, exact=partial(smooth, CONTOUR_ACCURACY_MM))


def torus_of(cells: float) -> Mesh:
    """The torus as triangles with so many cells around its tube, and twice as many along it."""
    u, v = (2.0 * np.pi * np.arange(n + 1) / n for n in (2 * int(cells), int(cells)))
    return mesh_of_grid(TORUS.points(*np.meshgrid(u, v, indexing="ij")), closed_u=True, closed_v=True)


def edge_contour(cells: float) -> list[Floats]:
    """The edges of the mesh between a face that looks at the eye and one that looks away, (2,3) each."""
    mesh = torus_of(cells)
    front = dot(mesh.face_normals, EYE - mesh.vertices[mesh.corners[mesh.offsets[:-1]]]) > 0.0
    uses = edge_uses(mesh)
    one, two = uses.corner[uses.first], uses.corner[uses.first + 1]
    turns = one[front[mesh.corner_face[one]] != front[mesh.corner_face[two]]]
    ends = np.stack([mesh.corners[turns], mesh.corners[mesh.next_corner[turns]]], axis=1)
    return list(mesh.vertices[ends])


def contour_across_faces(cells: float) -> list[Floats]:
    """The curves across the faces of the mesh on which normals averaged at the vertices turn away, (n,3) each."""
    found = mesh_contour_across_faces(torus_of(cells), EYE)
    parts = np.split(found.points, found.offsets[1:-1])
    return [
        np.concatenate([part, part[:1]]) if closed else part for part, closed in zip(parts, found.closed, strict=True)
    ]


MESH_CONTOUR = Approximation(
    name="mesh-contour",
    title="Contours of meshes",
    about="The contour of a torus from meshes of it: the edges where faces turn away, or curves across the faces by "
    "averaged normals. The error is the Hausdorff distance from the contour of the true torus on the page.",
    knob="cells around the tube",
    values=(16, 32, 64, 128, 256),
    limits=(8, 512),
    unit="mm",
    counts="chords",
    study=_study,
)


# Smooth surfaces as painted polygons: their outline, and their colours.

PAINTED_TORUS, CAMERA = Torus(3.0, 1.2), Camera(eye=(7.0, -5.0, 14.0))

SPECK_MM2 = 1.0
"""Holes, and parts in them, of a smaller area lie between polygons that rounding has set apart."""

COLUMNS, ROWS, LEVELS = 420, 594, 3
"""The pixels that colours are compared in, and by how many of 255 steps they may differ."""

FINEST_MM = 0.01
"""The tolerance of the picture that colours are compared with."""


def painted(tolerance: float) -> Drawing:
    """The torus painted within a tolerance, in mm."""
    return paint(Scene((Item("torus", PAINTED_TORUS, "blue"),)), CAMERA, shadows="none", tolerance_mm=tolerance, jobs=1)


def polygons(drawing: Drawing) -> int:
    """How many polygons a drawing has."""
    return sum(len(mark) for layer in drawing.layers for mark in layer.fills)


HALF_SLIT_MM = ROUNDED_MM / 2.0


def covered(points: Floats, offsets: Ints) -> Any:
    """What polygons (n,2) cover where they are painted, wherever their rings wind around: an area of shapely. Rings may
    lead to holes and back, and lie on themselves."""
    import shapely

    parts = polygons_of(points.T, offsets)
    wound = np.flatnonzero(~shapely.is_valid(parts))
    loops = shapely.node(shapely.get_exterior_ring(parts[wound]))
    faces, of = shapely.get_parts(shapely.polygonize(loops[:, None]), return_index=True)
    middles = shapely.get_coordinates(shapely.point_on_surface(faces))
    rings = (points[offsets[k] : offsets[k + 1]] for k in wound.tolist())
    around = [_winding(ring, middles[of == k]) for k, ring in enumerate(rings)]
    full = np.concatenate([np.zeros(0), *around]) != 0.0
    return shapely.union_all(np.concatenate([np.delete(parts, wound), faces[full]]))


def _winding(ring: Floats, places: Floats) -> Floats:
    """(m,) how often a ring (n,2) winds around places (m,2)."""
    way = ring[None] - places[:, None]
    after = np.roll(way, -1, axis=1)
    turn = arctan2(cross(way, after), (way * after).sum(axis=2))
    return np.asarray(np.rint(turn.sum(axis=1) / (2.0 * np.pi)))


def outlines(drawing: Drawing) -> list[Floats]:
    """The borders (n,2) of all that polygons cover. Slits no wider than corners of bands are rounded are no borders."""
    from shapely import get_parts, polygons

    fills = Fills.joined(*(mark for layer in drawing.layers for mark in layer.fills))
    fills = fills.take(np.flatnonzero(np.diff(fills.offsets) > 2))
    whole = covered(fills.points, fills.offsets).buffer(HALF_SLIT_MM, join_style="mitre")
    parts = [part for part in get_parts(whole.buffer(-HALF_SLIT_MM, join_style="mitre")) if part.area > SPECK_MM2]
    holes = [hole.coords for part in parts for hole in part.interiors if polygons(hole).area > SPECK_MM2]
    return [np.asarray(line) for line in (*(part.exterior.coords for part in parts), *holes)]


def _outline() -> Study:
    true = contour(PAINTED_TORUS, CAMERA.eye, tracing=Tracing(tolerance=TRUE_CONTOUR))

    def error(drawing: Drawing) -> float:
        truth = [on_page(drawing.page_from_world, true[k]) for k in range(len(true))]
        return hausdorff(outlines(drawing), truth, accuracy=OUTLINE_ACCURACY_MM)

    return Study((Way("painted polygons", painted, 1.0),), error, polygons)


def _colours() -> Study:
    truth = pixels_of(painted(FINEST_MM), COLUMNS, ROWS)

    def error(drawing: Drawing) -> float:
        return wrong_share(pixels_of(drawing, COLUMNS, ROWS), truth, LEVELS)

    return Study((Way("painted polygons", painted),), error, polygons, exact=lambda: painted(FINEST_MM))


PAINTED_OUTLINE = Approximation(
    name="painted-outline",
    title="Outlines of painted surfaces",
    about="A torus as painted polygons. The error is the Hausdorff distance of their outline from the true contour on "
    "the page.",
    knob="tolerance in mm",
    values=(1.0, 0.5, 0.2, 0.1, 0.05),
    limits=(FINEST_MM, 10.0),
    unit="mm",
    counts="polygons",
    study=_outline,
)

PAINTED_COLOURS = Approximation(
    name="painted-colours",
    title="Colours of painted surfaces",
    about="The same torus in pixels of half a millimetre. The error is how many of them have another colour, by more "
    "than 3 of 255 steps, than in the picture of the finest tolerance, 0.01 mm.",
    knob="tolerance in mm",
    values=(1.0, 0.5, 0.2, 0.1, 0.05),
    limits=(FINEST_MM, 10.0),
    unit="% of the pixels",
    counts="polygons",
    study=_colours,
)


# Implicit surfaces as triangles.

IMPLICIT_TORUS = ImplicitTorus(3.0, 1.2)

LOOKS = 6
"""The surface is compared in so many points along each side of a triangle, and between the sides."""


def _study_of_polygonised() -> Study:
    extent = float(np.ptp(np.asarray(IMPLICIT_TORUS.box), axis=0).max())
    a, b = np.array([(i, j) for i in range(LOOKS + 1) for j in range(LOOKS + 1 - i)]).T / LOOKS
    weights = np.stack([a, b, 1.0 - a - b], axis=1)

    def error(mesh: Mesh) -> float:
        points = np.einsum("kc,tcd->tkd", weights, mesh.vertices[mesh.corners.reshape(-1, 3)])
        ring = np.hypot(points[..., 0], points[..., 1]) - IMPLICIT_TORUS.major
        return 100.0 * float(np.abs(np.hypot(ring, points[..., 2]) - IMPLICIT_TORUS.minor).max()) / extent

    ways = (Way("triangles", lambda cells: polygonized(IMPLICIT_TORUS, int(cells)), -2.0),)
    return Study(ways, error, lambda mesh: mesh.face_count)


POLYGONISED = Approximation(
    name="polygonised",
    title="Implicit surfaces as triangles",
    about="A torus by its equation alone, polygonised. Vertices are exact; the error is the largest distance of points "
    "of triangles from the torus, in per cent of the side of its box.",
    knob="cells along the box",
    values=(16, 32, 64, 128),
    limits=(8, 256),
    unit="% of the box",
    counts="triangles",
    study=_study_of_polygonised,
)
