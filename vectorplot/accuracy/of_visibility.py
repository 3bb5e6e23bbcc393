"""Approximations of visibility, measured: depth buffers, samples along curves, tolerances for tessellated bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way, decades, on_page
from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import unheard
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import dot, norm
from vectorplot.geometry.winding import edge_uses
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.scene.view import View, look
from vectorplot.shading.depth_buffers import depth_buffer
from vectorplot.shading.screen import raster_system, screen_triangles
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.curves import Segments, Tree
from vectorplot.testing.rays import visible_by_rays
from vectorplot.testing.shapes import rotated_boxes
from vectorplot.testing.sight_rays import triangulated
from vectorplot.textbook.framebuffer import points_visible
from vectorplot.tolerances import CLEARANCE_OF_EXTENT, ON_STROKE_MM, OWN_MEETING, SMALLEST_ZERO, VERTEX_NOISE_OF_EXTENT
from vectorplot.visibility.polyhedra.hidden_lines import Segments as Segments_of_hidden_lines
from vectorplot.visibility.polyhedra.hidden_lines import visible_parts
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import project_faces

# Hidden lines by a depth buffer, beside those by geometry.

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


# Hidden parts of curves on a smooth surface by samples, beside those by events.

TORUS, EYE, LINES = Torus(3.0, 1.2), np.array([9.0, -7.0, 5.0]), 16

FINE = 4096
"""So many pieces of every line the samples are compared in."""


def parameters(pieces: int) -> tuple[Floats, Floats]:
    """u and v (LINES, pieces) at the middles of the pieces of the lines u = constant."""
    u = 2.0 * np.pi * np.arange(LINES) / LINES
    v = 2.0 * np.pi * (np.arange(pieces) + 0.5) / pieces
    return tuple(np.meshgrid(u, v, indexing="ij"))  # type: ignore[return-value]


def visible(points: Floats) -> Bools:
    """(...) which points (...,3) of the torus are seen: those whose sight line meets it nowhere else.

    Along x = p + t d the equation of the torus has the root t = 0; without it a cubic is left.
    """
    a, b = TORUS.major, TORUS.minor
    d = EYE - points
    long = norm(d)
    d = d / long[..., None]
    # (|x|^2 + k)^2 = 4 a^2 (x^2 + y^2), with |x|^2 + k = t^2 + m t + n.
    m, n = 2.0 * dot(points, d), dot(points, points) + a * a - b * b
    flat, way = points[..., :2], d[..., :2]
    c1 = m * m + 2.0 * n - 4.0 * a * a * dot(way, way)
    c0 = 2.0 * m * n - 8.0 * a * a * dot(flat, way)
    companion = np.zeros((*points.shape[:-1], 3, 3))
    companion[..., 1, 0] = companion[..., 2, 1] = 1.0
    companion[..., :, 2] = -np.stack([c0, c1, 2.0 * m], axis=-1)
    roots = np.linalg.eigvals(companion)
    real = np.abs(roots.imag) <= OWN_MEETING * np.maximum(np.abs(roots), 1.0)
    meets = real & (roots.real > OWN_MEETING) & (roots.real < long[..., None])
    return np.asarray(~meets.any(axis=-1))


def _study_of_sampled_visibility() -> Study:
    scene = Scene((Item("torus", TORUS, curves=SurfaceLines(columns=LINES)),))
    camera = Camera(eye=tuple(EYE))

    def exact() -> Drawing:
        return draw(scene, camera, lines="parameter", curves="polyline", tolerance_mm=ON_STROKE_MM / 2.0, jobs=1)

    points = TORUS.points(*parameters(FINE))
    truth = visible(points)
    matrix = exact().page_from_world
    page = on_page(matrix, points)
    weight = norm(np.roll(page, -1, axis=1) - np.roll(page, 1, axis=1))

    def sampled(samples: float) -> Bools:
        seen = visible(TORUS.points(*parameters(int(samples))))
        return seen[:, (np.arange(FINE) * int(samples)) // FINE]

    def shown(drawing: Drawing) -> Bools:
        strokes = [paths for layer in drawing.layers for paths in layer.strokes if len(paths)]
        lines = [part for paths in strokes for part in np.split(paths.points, paths.offsets[1:-1])]
        near = Tree(Segments.of(lines, False).ends).nearest(page.reshape(-1, 2), 0.0)[0] <= ON_STROKE_MM
        return near.reshape(truth.shape)

    def error(found: Bools | Drawing) -> float:
        said = shown(found) if isinstance(found, Drawing) else found
        return 100.0 * float((weight * (said != truth)).sum() / weight.sum())

    def count(found: Bools | Drawing) -> int:
        if isinstance(found, Drawing):
            return sum(len(paths) for layer in found.layers for paths in layer.strokes)
        return int((np.diff(found.astype(np.intp), axis=1) != 0).sum())

    return Study((Way("samples", sampled, -1.0),), error, count, exact=exact)


SAMPLED_VISIBILITY = Approximation(
    name="sampled-visibility",
    title="Hidden curves by samples",
    about="Parameter lines of a torus, each decided in some samples by rays in closed form, and as its nearest sample "
    "between them. The error is the length on the page that is wrong. Exact: the verb draw, which solves "
    "for the events; what is left is that lines are compared in 4096 pieces.",
    knob="samples along a line",
    values=(16, 32, 64, 128, 256, 512),
    limits=(4, FINE),
    unit="% of the length",
    counts="changes",
    study=_study_of_sampled_visibility,
)


# What counts as zero: hidden lines of tessellated bodies whose vertices are a little off.

SEED = 1
"""Of the noise."""

SHARES = (0.21, 0.47, 0.83)
"""Edges are asked at these places, none of which is on the border of what touches them."""

CELLS = 6
"""Cells along every edge of a box."""

SNAPPED_CAMERA = Camera(eye=(9.0, -12.0, 7.0), target=(1.0, 1.0, 1.0))

SNAPPED_BOXES = (
    ((0, 0, 0), (2, 2, 2)),
    ((2, 0, 0), (3, 2, 1)),
    ((0.5, 0.5, 2), (1.5, 1.5, 2.01)),
    ((2.2, -2, 0), (2.8, -1, 2)),
)
"""A box, one beside it and a thin one on it that touch it, and one before them."""


def tessellated(low: tuple[float, ...], high: tuple[float, ...]) -> Mesh:
    """A box whose sides are CELLS x CELLS cells of two triangles each, their vertices shared."""
    n = CELLS
    corners: list[Floats] = []
    square = np.stack(np.meshgrid(np.arange(n), np.arange(n), indexing="ij"), axis=-1).reshape(-1, 2)
    cell = np.array([(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)])
    plane = (square[:, None] + cell).reshape(-1, 3, 2)
    for axis in range(3):
        for level, turn in ((0, -1), (n, 1)):
            place = np.insert(plane, axis, level, axis=2) if axis != 1 else np.insert(plane, 1, level, axis=2)[:, ::-1]
            corners.append(place[:, ::turn])
    every = np.concatenate(corners).reshape(-1, 3)
    lattice, index = np.unique(every, axis=0, return_inverse=True)
    start, size = np.asarray(low, dtype=np.float64), np.subtract(high, low)
    return Mesh.from_triangles(start + lattice / n * size, index.reshape(-1, 3))


def bodies(noise: float) -> list[Mesh]:
    """The boxes, their vertices off by so much at most."""
    random = np.random.default_rng(SEED)
    found = []
    for low, high in SNAPPED_BOXES:
        mesh = tessellated(low, high)
        off = noise * random.uniform(-1.0, 1.0, mesh.vertices.shape)
        found.append(Mesh(mesh.vertices + off, mesh.corners, mesh.offsets))
    return found


def scene_of(meshes: Sequence[Mesh]) -> Scene:
    """The meshes as items."""
    return Scene(tuple(Item(f"box {number + 1}", mesh) for number, mesh in enumerate(meshes)))


def edges_of(meshes: Sequence[Mesh]) -> Ints:
    """(e,2) the vertices of all edges, those of the meshes one after the other."""
    found, first = [], 0
    for mesh in meshes:
        corner = edge_uses(mesh).corner[edge_uses(mesh).first]
        found.append(first + np.stack([mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]], axis=1))
        first += len(mesh.vertices)
    return np.concatenate(found)


def seen(view: View, edges: Ints) -> Bools:
    """(e,s) which edges are visible at their SHARES."""
    faces = project_faces(view)
    segments = Segments_of_hidden_lines(view.points[:, edges[:, 0]], view.points[:, edges[:, 1]])
    parts = visible_parts(view, faces, solid_items(view, faces), segments, unheard)
    found = np.zeros((len(edges), len(SHARES)), dtype=np.bool_)
    for k, share in enumerate(SHARES):
        found[parts.segment[(parts.low <= share) & (share <= parts.high)], k] = True
    return found


def _study_of_snapping() -> Study:
    meshes = bodies(0.0)
    clean = scene_of(meshes)
    extent = float(np.ptp(clean.bounds, axis=0).max())
    view, edges = look(scene_of(bodies(VERTEX_NOISE_OF_EXTENT * extent)), SNAPPED_CAMERA), edges_of(meshes)
    ends = clean.vertices[edges]
    share = np.array(SHARES)[:, None]
    points = (ends[:, None, 0] * (1.0 - share) + ends[:, None, 1] * share).reshape(-1, 3)
    sight = visible_by_rays(clean, SNAPPED_CAMERA, points)
    truth, sure = (x.reshape(len(edges), -1) for x in (sight.hidden_by == 0, sight.clearance > CLEARANCE_OF_EXTENT))

    def error(found: Bools) -> float:
        return 100.0 * float((found != truth)[sure].mean())

    ways = (Way("snapped", lambda tolerance: seen(replace(view, tolerance=tolerance), edges)),)
    return Study(ways, error, lambda found: int(found.sum()))


SNAPPING = Approximation(
    name="snapping",
    title="What counts as zero",
    about="Four boxes, tessellated, three of them touching, with vertices off by 1e-10 of the extent. The error is "
    "how many places on edges are visible where rays on the true boxes find them hidden, or the other way round. What "
    "counts as zero must exceed the noise and be smaller than what is to be seen; the package takes 1e-9.",
    knob="zero, as part of half the extent",
    values=decades(-2, -14, 13),
    limits=(SMALLEST_ZERO, 0.1),
    unit="% of the places",
    counts="visible places",
    study=_study_of_snapping,
)
