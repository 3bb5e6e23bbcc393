"""Whether a drawing shows what can be seen: its strokes, and what it leaves out, against rays."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Floats, Ints
from vectorplot.geometry.strokes import LineKind
from vectorplot.scene.scene import Scene
from vectorplot.testing.compare import path_segments
from vectorplot.testing.rays import edges_of_faces
from vectorplot.testing.sight import visible_by_rays


def assert_drawing_is_right(
    drawing: Drawing,
    scene: Scene,
    camera: Camera,
    *,
    samples: int = 2000,
    seed: int = 0,
    clearance: float = 1e-6,
    must_show: ArrayLike | None = None,
    tolerance_mm: float = 0.01,
    margin_mm: float = 10.0,
) -> int:
    """How many points were compared, where all agree with rays; otherwise an AssertionError that names the worst fault.

    Random points on the strokes must be hidden by as many items as the drawing says. must_show (n,3): points in the
    world (edge_points gives some) that must be within tolerance_mm of a visible stroke if rays find them visible and
    they lie on the page, margin_mm inside its border. Points nearer to a transition than clearance (see
    visible_by_rays) are left out.
    Errors: AssertionError.
    """
    points, paths = stroke_points(drawing, samples, seed)
    compared = 0
    if len(points):
        kind, item, said = paths.T
        sight = visible_by_rays(scene, camera, points)
        sure = sight.clearance > clearance
        wrong = np.flatnonzero(sure & (sight.hidden_by != said))
        compared = int(sure.sum())
        if len(wrong):
            k = wrong[np.argmax(sight.clearance[wrong])]
            what = f"a {LineKind(kind[k]).word} of {drawing.items[item[k]]}"
            raise AssertionError(
                f"{len(wrong)} of {compared} points on strokes are wrong; at {points[k].tolist()} {what} is drawn as "
                f"hidden by {said[k]} items, rays find {sight.hidden_by[k]} (clearance {sight.clearance[k]:.2g})"
            )
    if must_show is None:
        return compared
    return compared + assert_shown(drawing, scene, camera, must_show, clearance, tolerance_mm, margin_mm)


def assert_shown(
    drawing: Drawing,
    scene: Scene,
    camera: Camera,
    must_show: ArrayLike,
    clearance: float,
    tolerance_mm: float,
    margin_mm: float,
) -> int:
    """How many of some points are visible and on the page, where all of them are on visible strokes."""
    from shapely import STRtree, linestrings
    from shapely import points as as_points

    wanted = np.asarray(must_show, dtype=np.float64).reshape(-1, 3)
    sight = visible_by_rays(scene, camera, wanted)
    place = np.c_[wanted, np.ones(len(wanted))] @ drawing.page_from_world.T
    front = place[:, 3] > 0.0
    page = place[:, :2] / np.where(front, place[:, 3], 1.0)[:, None]
    border = np.array([drawing.width_mm, drawing.height_mm]) - margin_mm
    on_page = ((page >= margin_mm) & (page <= border)).all(axis=1) & front
    kept = (sight.hidden_by == 0) & (sight.clearance > clearance) & on_page
    wanted, page = wanted[kept], page[kept]
    if len(page) == 0:
        return 0
    lines = [np.zeros((0, 2, 2))]
    for layer in drawing.layers:
        for marks in layer.marks:
            start, end, path = path_segments(marks.offsets, marks.closed)
            lines.append(np.stack([marks.points[start], marks.points[end]], axis=1)[marks.hidden_by[path] == 0])
    tree = STRtree(linestrings(np.concatenate(lines)))
    assert len(tree), f"nothing is drawn, yet {wanted[0].tolist()} is visible"
    (index, _), distance = tree.query_nearest(as_points(page), return_distance=True, all_matches=False)
    worst = int(np.argmax(distance))
    assert distance[worst] <= tolerance_mm, (
        f"{int((distance > tolerance_mm).sum())} of {len(page)} visible points are not drawn; "
        f"{wanted[index[worst]].tolist()}, at {page[index[worst]].tolist()} mm, is {distance[worst]:.4g} mm away"
    )
    return len(page)


def stroke_points(drawing: Drawing, samples: int, seed: int) -> tuple[Floats, Ints]:
    """Random points (n,3) on the strokes in the world, and (n,3) kind, item and hidden_by; half of them by length."""
    segments, owners = [np.zeros((0, 2, 3))], [np.zeros((0, 3), dtype=np.intp)]
    for layer in drawing.layers:
        for marks in layer.marks:
            start, end, path = path_segments(marks.offsets, marks.closed)
            segments.append(np.stack([marks.points3d[start], marks.points3d[end]], axis=1))
            owners.append(np.stack([marks.kind, marks.item, marks.hidden_by], axis=1)[path])
    lines, owner = np.concatenate(segments), np.concatenate(owners)
    return on_segments(lines, owner, samples, np.random.default_rng(seed))


def on_segments(lines: Floats, owner: Ints, samples: int, random: np.random.Generator) -> tuple[Floats, Ints]:
    """Random points on segments with their owners: half of them by length, half with one chance for each segment."""
    length = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)
    if not length.sum() > 0.0:
        return np.zeros((0, 3)), owner[:0]
    by_length = np.searchsorted(np.cumsum(length), random.random(samples // 2) * length.sum(), side="right")
    index = np.concatenate(
        [by_length.clip(max=len(lines) - 1), random.integers(len(lines), size=samples - samples // 2)]
    )
    share = random.random(samples)[:, None]
    return lines[index, 0] * (1.0 - share) + lines[index, 1] * share, owner[index]


def edge_points(scene: Scene, samples: int, *, seed: int = 0) -> tuple[Floats, Ints]:
    """Random points (n,3) on the edges of the faces of all items, and (n,) the index of the item each lies on."""
    lines, owner = [np.zeros((0, 2, 3))], [np.zeros(0, dtype=np.intp)]
    for index, item in enumerate(scene.items):
        lines.append(item.mesh.vertices[edges_of_faces(item.mesh)])
        owner.append(np.full(len(lines[-1]), index, dtype=np.intp))
    return on_segments(np.concatenate(lines), np.concatenate(owner), samples, np.random.default_rng(seed))
