"""What every verb shows of a scene in three colours, against what rays meet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import vectorplot as vp
from support.effort import several
from support.picture_rays import compared
from support.pixel_rays import first_triangles, pixel_rays
from support.shaded_scenes import triangles_of
from vectorplot.arrays import Bools, Ints
from vectorplot.backends.raster import painted
from vectorplot.geometry.mesh import Mesh
from vectorplot.testing import assert_drawing_is_right
from vectorplot.testing.shapes import (
    rotation,
)

COLOURS = ("#ff0000", "#00ff00", "#0000ff")
COLUMNS, ROWS = 96, 72
EYES = [(5.0, -7.0, 6.0), (-6.0, -5.0, -4.0), (0.3, 0.4, 9.0), (1.0, 8.5, 2.0), (-9.0, 0.2, 0.1)]


def cameras(scene: vp.Scene) -> list[vp.Camera]:
    """All around a scene, central and parallel, at its own size."""
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    places = [tuple(middle + 0.3 * size * np.array(eye)) for eye in EYES]
    found = [vp.Camera(place, tuple(middle), fov_deg=35.0) for place in places]
    return [*found, *(replace(camera, parallel=True, height=1.2 * size) for camera in found[:3])]


def in_three_colours(scene: vp.Scene) -> vp.Scene:
    """Without light of its own; the items red, green and blue by turns."""
    return vp.Scene(tuple(vp.Item(i.name, present(i.mesh), COLOURS[k % 3]) for k, i in enumerate(scene.items)))


def present(mesh: Mesh) -> Mesh:
    """The faces that are there, and nothing of the others."""
    if mesh.present is None:
        return mesh
    kept = [polygon for polygon, there in zip(mesh.polygons(), mesh.present.tolist(), strict=True) if there]
    return Mesh.from_polygons(mesh.vertices, kept)


def draws_right(scene: vp.Scene, camera: vp.Camera) -> None:
    kinds = ("contour", "boundary", "crease", "edges", "intersection")
    drawing = vp.draw(scene, camera, hidden="solid", lines=kinds)
    assert assert_drawing_is_right(drawing, scene, camera, samples=300) > 0


def paints_right(scene: vp.Scene, camera: vp.Camera) -> None:
    wrong, _, sure = compared(scene, camera)
    assert wrong == 0 and sure > 0


def shown_in_pixels(verb: str, scene: vp.Scene, camera: vp.Camera) -> Ints:
    """(rows, columns) which of the three colours a picture shows, 3 for none."""
    if verb == "render":
        pixels = vp.render(scene, camera, size=(COLUMNS, ROWS), fit=False, background="black", samples=1).pixels
    else:
        drawing = vp.paint(scene, camera, page=vp.Page(COLUMNS, ROWS, 0), fit=False)
        pixels = painted(np.zeros((ROWS, COLUMNS, 3), dtype=np.uint8), drawing)
    return np.where(pixels.any(axis=2), pixels.argmax(axis=2), 3)


def met_by_rays(scene: vp.Scene, camera: vp.Camera) -> tuple[Ints, Bools]:
    """(rows, columns) the colours that rays meet, 3 for none, and where all around a pixel it is the same."""
    vertices, triangles = triangles_of(*(item.mesh for item in scene.items))
    counts = [len(triangles_of(item.mesh)[1]) for item in scene.items]
    colour = np.repeat(np.arange(len(counts)) % 3, counts)
    found = first_triangles(vertices, triangles, *pixel_rays(camera, COLUMNS, ROWS))
    expected = np.where(found >= 0, np.append(colour, 3)[found], 3).reshape(ROWS, COLUMNS)
    padded = np.pad(expected, 1, mode="edge")
    around = np.array([padded[i : i + ROWS, j : j + COLUMNS] for i in range(3) for j in range(3)])
    return expected, (around == expected).all(axis=0)


def renders_right(scene: vp.Scene, camera: vp.Camera) -> None:
    expected, inner = met_by_rays(scene, camera)
    assert inner.mean() > 0.5
    assert (shown_in_pixels("render", scene, camera) == expected)[inner].all()


VERBS = {"draw": draws_right, "paint": paints_right, "render": renders_right}


def some_of(views: list[vp.Camera], verb: str) -> list[vp.Camera]:
    """Those of the views that a verb tries: others than the other verbs; by hand all."""
    return views[several(list(VERBS).index(verb), long=0) :: several(len(VERBS), long=1)]


def turned(scene: vp.Scene, seed: int) -> vp.Scene:
    """The scene turned as a whole, at random."""
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(np.random.default_rng(seed))
    return vp.Scene(tuple(replace(item, shape=item.mesh.transformed(matrix)) for item in scene.items))
