"""A surface cut into horizontal slices, painted slice by slice: ribbons that only their own slice is compared with.

The bands below the eye come first, upwards, then those above it, downwards. Bands have two colours, so that one sees
them. Source: Glaeser, sections 5.3 and 5.4, figures 4 to 6.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import layer, on_page, polygons

import vectorplot as vp
from vectorplot.scene import look
from vectorplot.surfaces import Domain, surface_of_function
from vectorplot.visibility import cut_into_slices, image_faces, slice_order, sliced_order

LEVELS = np.linspace(-0.9, 0.9, 10)
CAMERA = vp.Camera(eye=(3, -9, 11), target=(0, 0, 0), fov_deg=34)
COLUMNS, ROWS = 112, 16


def knot(u, v):
    """A point of a tube along a trefoil knot."""
    far = 2 + np.cos(3 * u)
    middle = np.stack([far * np.cos(2 * u), far * np.sin(2 * u), 0.7 * np.sin(3 * u)], axis=-1)
    grows = -3 * np.sin(3 * u)
    along = np.stack(
        [
            grows * np.cos(2 * u) - 2 * far * np.sin(2 * u),
            grows * np.sin(2 * u) + 2 * far * np.cos(2 * u),
            2.1 * np.cos(3 * u),
        ],
        axis=-1,
    )
    side = np.cross(along, (0.0, 0.0, 1.0))
    up = np.cross(side, along)
    side, up = (part / np.sqrt((part**2).sum(axis=-1))[..., None] for part in (side, up))
    normal = np.cos(v)[..., None] * side + np.sin(v)[..., None] * up
    return middle + 0.4 * normal


def main(folder: Path) -> None:
    turn = [2 * np.pi * np.arange(count) / count for count in (COLUMNS, ROWS)]
    points = knot(*np.meshgrid(*turn, indexing="ij")).reshape(-1, 3)
    here = np.arange(COLUMNS * ROWS).reshape(COLUMNS, ROWS)
    right, above = np.roll(here, -1, axis=0), np.roll(here, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    halves = [np.stack(cell, axis=2).reshape(-1, 3) for cell in ((here, right, both), (here, both, above))]
    triangles = np.concatenate(halves)
    pieces, _, band = cut_into_slices(points[triangles].reshape(-1, 3), 3 * np.arange(len(triangles) + 1), 2, LEVELS)
    limits = np.concatenate([[-np.inf], LEVELS, [np.inf]])
    height = pieces.points[:, 2]
    low, high = (reduce.reduceat(height, pieces.offsets[:-1]) for reduce in (np.minimum, np.maximum))
    assert (low >= limits[band]).all() and (high <= limits[band + 1]).all(), "no piece leaves its slice"

    corners = np.split(np.arange(len(pieces.points)), pieces.offsets[1:-1])
    mesh = vp.Mesh.from_polygons(pieces.points, [c.tolist() for c in corners])
    view = look(vp.Scene((vp.Item("KNOT", mesh),)), CAMERA)
    faces = image_faces(view, np.arange(view.face_count))
    rank = np.empty(len(limits) - 1, dtype=np.intp)
    rank[slice_order(np.concatenate([[-9.0], LEVELS, [9.0]]), CAMERA.eye[2])] = np.arange(len(rank))
    painted = sliced_order(faces, rank[band[faces.source]], view.tolerance)
    assert (np.diff(rank[band[painted.source]]) >= 0).all(), "slice by slice"

    smooth = surface_of_function(knot, Domain(0, 2 * np.pi, 0, 2 * np.pi))
    scene = vp.Scene((vp.Item("KNOT", smooth, lines=("contour",)),), title="Slices")
    drawing = vp.draw(scene, CAMERA, page=vp.Page(150, 128, 4))
    # Both are images for the same camera.
    page, image = on_page(drawing, pieces.points), view.image.T
    scale = np.ptp(page, axis=0) / np.ptp(image, axis=0)
    spots = page.min(axis=0) + scale * (painted.points[:2].T - image.min(axis=0))
    tints = np.array(["#eeb48c", "#b5d9df"])[band[painted.source] % 2]
    fills = layer("slices", polygons(np.split(spots, painted.offsets[1:-1]), tints.tolist()))
    vp.save(replace(drawing, layers=(fills, *drawing.layers)), folder / "sliced_surface.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
