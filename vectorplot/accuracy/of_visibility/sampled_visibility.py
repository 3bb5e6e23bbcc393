"""Hidden parts of curves on a smooth surface by samples, beside those by events."""

from __future__ import annotations

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.accuracy.truth import on_page
from vectorplot.arrays import Bools, Floats
from vectorplot.draw import draw
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.surfaces.families.torus import Torus
from vectorplot.testing.curve_distance import Segments, Tree
from vectorplot.tolerances.of_measuring import ON_STROKE_MM, OWN_MEETING

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


def _study() -> Study:
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
    study=_study,
)
