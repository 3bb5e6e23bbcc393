"""Whether a drawing shows what can be seen: its strokes, and what it leaves out, against rays."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.scene.scene import Scene
from vectorplot.testing.compare import path_segments
from vectorplot.testing.rays.mesh_rays import edges_of_faces
from vectorplot.testing.rays.sight import visible_by_rays
from vectorplot.testing.stroke_points import some_of, stroke_points
from vectorplot.tolerances.of_extent import CLEARANCE_OF_EXTENT
from vectorplot.words import LineKind


def assert_drawing_is_right(
    drawing: Drawing,
    scene: Scene,
    camera: Camera,
    *,
    samples: int = 2000,
    seed: int = 0,
    clearance: float = CLEARANCE_OF_EXTENT,
    must_show: ArrayLike | None = None,
    tolerance_mm: float = 0.01,
    margin_mm: float = 10.0,
) -> int:
    """How many points were compared, where all agree with rays; otherwise an AssertionError that names the worst fault.

    Parameters
    ----------
    drawing : Drawing
        What is checked.
    scene : Scene
        What it shows.
    camera : Camera
        How it was drawn.
    samples : int
        How many random points on the strokes are compared.
    seed : int
        Of the random numbers.
    clearance : float
        Points nearer to a transition than this part of the extent (see visible_by_rays) are left out.
    must_show : (n, 3) array_like of float, optional
        Points in the world (edge_points gives some) that must be within tolerance_mm of a visible stroke if rays find
        them visible and they lie on the page, margin_mm inside its border.
    tolerance_mm : float
        In mm on the page.
    margin_mm : float
        In mm on the page.

    Returns
    -------
    int
        Of samples and points to show, those that were not left out.

    Raises
    ------
    AssertionError
        With the number of wrong points and the worst of them, in the world.

    Notes
    -----
    Random points on the strokes must be hidden by as many items as the drawing says; on strokes of smooth curves these
    are their vertices, and points of their chords that have been moved to the surface.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> camera = vp.Camera((7, 5, 4))
    >>> drawing = vp.draw(cube, camera, hidden="dashed")
    >>> testing.assert_drawing_is_right(drawing, cube, camera, samples=50) > 0
    True
    """
    found = stroke_points(drawing, scene, camera, samples, seed)
    compared = 0
    if len(found.points):
        sight = visible_by_rays(scene, camera, found.points)
        size = float(np.ptp(scene.bounds, axis=0).max()) or 1.0
        sure = sight.clearance > np.maximum(clearance, found.aside / size)
        sure &= ~sight.on_contour | (found.kind == LineKind.CONTOUR)
        wrong = np.flatnonzero(sure & (sight.hidden_by != found.hidden_by))
        compared = int(sure.sum())
        if len(wrong):
            k = wrong[np.argmax(sight.clearance[wrong])]
            what = f"a {LineKind(found.kind[k]).word} of {drawing.items[found.item[k]]}"
            raise AssertionError(
                f"{len(wrong)} of {compared} points on strokes are wrong; at {found.points[k].tolist()} {what} is "
                f"drawn as hidden by {found.hidden_by[k]} items, rays find {sight.hidden_by[k]} "
                f"(clearance {sight.clearance[k]:.2g})"
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
    place = matmul(np.c_[wanted, np.ones(len(wanted))], drawing.page_from_world.T)
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
        for marks in layer.strokes:
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


def edge_points(scene: Scene, samples: int, *, seed: int = 0) -> tuple[Floats, Ints]:
    """Random points on the edges of the faces of all items.

    Parameters
    ----------
    scene : Scene
        With its polyhedra.
    samples : int
        How many, in all.
    seed : int
        Of the random numbers.

    Returns
    -------
    (n, 3) array of float
        In the world.
    (n,) array of int
        The index of the item each lies on.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> points, item = testing.edge_points(cube, 10)
    >>> points.shape, item.any().item()
    ((10, 3), False)
    >>> bool((((points == 0.0) | (points == 2.0)).sum(axis=1) >= 2).all())
    True
    """
    lines, owner = [np.zeros((0, 2, 3))], [np.zeros(0, dtype=np.intp)]
    for index, item in enumerate(scene.items):
        lines.append(item.mesh.vertices[edges_of_faces(item.mesh)])
        owner.append(np.full(len(lines[-1]), index, dtype=np.intp))
    edges, items = np.concatenate(lines), np.concatenate(owner)
    which, share = some_of(edges, samples, np.random.default_rng(seed))
    part = share[: len(which), None]
    return edges[which, 0] * (1.0 - part) + edges[which, 1] * part, items[which]
