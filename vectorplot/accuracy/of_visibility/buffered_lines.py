"""Hidden lines by a depth buffer, beside those by geometry."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.accuracy.truth import on_page
from vectorplot.arrays import Bools, Floats
from vectorplot.draw import draw
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry import ragged
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.scene.scene import Scene
from vectorplot.shading.depth.depth_buffer import depth_buffer
from vectorplot.shading.raster.screen import raster_system, screen_triangles
from vectorplot.testing.rays.sight import visible_by_rays
from vectorplot.testing.rays.triangles import triangulated
from vectorplot.testing.shapes import rotated_boxes
from vectorplot.textbook.screens.depth_queries import points_visible
from vectorplot.tolerances.of_extent import CLEARANCE_OF_EXTENT

BOXES, CAMERA = 60, Camera(eye=(12.0, -9.0, 8.0), fov_deg=50.0)

PIECE_MM = 0.5
"""Strokes are compared in pieces of this length on the page."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """Short pieces of the strokes of a drawing: their middles (n,3) in the world, their lengths (n,) on the page in mm,
    and whether each is visible (n,)."""

    middles: Floats
    lengths: Floats
    visible: Bools


def pieces_of(drawing: Drawing) -> Pieces:
    """The straight strokes of a drawing in pieces no longer than PIECE_MM."""
    every = [paths for layer in drawing.layers for paths in layer.strokes]
    parts = []
    for paths in every:
        inner = np.ones(len(paths.points), dtype=np.bool_)
        inner[paths.offsets[1:] - 1] = False
        first = np.flatnonzero(inner)
        start, end = paths.points3d[first], paths.points3d[first + 1]
        long = norm(paths.points[first + 1] - paths.points[first])
        count = np.maximum(np.ceil(long / PIECE_MM), 1.0).astype(np.intp)
        segment, place = ragged.owner(count), ragged.place(count)
        low, high = (((place + k) / count[segment])[:, None] for k in (0, 1))
        ends = [start[segment] * (1.0 - t) + end[segment] * t for t in (low, high)]
        size = norm(on_page(drawing.page_from_world, ends[1]) - on_page(drawing.page_from_world, ends[0]))
        hidden = paths.hidden_by[ragged.owner(np.diff(paths.offsets))[first]][segment]
        parts.append((0.5 * (ends[0] + ends[1]), size, hidden == 0))
    return Pieces(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _study() -> Study:
    scene = rotated_boxes(BOXES)

    def exact(hidden: str) -> Drawing:
        return draw(scene, CAMERA, lines="contour,crease", hidden=hidden, curves="polyline", jobs=1)  # type: ignore[arg-type]

    pieces = pieces_of(exact("solid"))
    sight = visible_by_rays(scene, CAMERA, pieces.middles)
    sure = sight.clearance > CLEARANCE_OF_EXTENT
    truth, weight = sight.hidden_by == 0, np.where(sure, pieces.lengths, 0.0)

    def error(visible: Bools | Drawing) -> float:
        said = pieces.visible if isinstance(visible, Drawing) else visible
        return 100.0 * float((weight * (said != truth)).sum() / weight.sum())

    ways = (Way("depth buffer", partial(seen_in_buffer, scene, pieces.middles), -1.0),)
    return Study(ways, error, lambda _: len(truth), exact=lambda: exact("none"))


def seen_in_buffer(scene: Scene, points: Floats, side: float) -> Bools:
    """(n,) which points (n,3) of the world a depth buffer of side x side pixels does not hide."""
    columns = rows = int(side)
    system = raster_system(CAMERA, columns, rows)
    meshes = [item.shape for item in scene.items if isinstance(item.shape, Mesh)]
    first = ragged.offsets(np.array([len(mesh.vertices) for mesh in meshes]))
    corners = [triangulated(mesh)[0] + start for mesh, start in zip(meshes, first, strict=False)]
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    buffer = depth_buffer(screen_triangles(system.homogeneous(vertices), np.concatenate(corners)), columns, rows)
    place = system.homogeneous(points)
    return points_visible(buffer, place[:, :3] / place[:, 3:])


DEPTH_BUFFER = Approximation(
    name="depth-buffer",
    title="Hidden lines by a depth buffer",
    about="The edges of 60 boxes, asked of a depth buffer in pieces of half a millimetre. The error is the length on "
    "the page that is visible where rays find it hidden, or the other way round. Exact: the verb draw.",
    knob="pixels along a side",
    values=(64, 128, 256, 512, 1024, 2048),
    limits=(16, 4096),
    unit="% of the length",
    counts="pieces",
    study=_study,
)
