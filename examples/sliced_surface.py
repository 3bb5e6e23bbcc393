"""A surface cut into horizontal slices, painted slice by slice: ribbons that only their own slice is compared with.

The bands below the eye come first, upwards, then those above it, downwards. Bands have two colours, so that one sees
them. Source: Glaeser, sections 5.3 and 5.4, figures 4 to 6.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import Fills
from vectorplot.scene import look
from vectorplot.shading import face_shades, shaded_colours, view_lights
from vectorplot.visibility import cut_into_slices, image_faces, slice_order, sliced_order

LEVELS = np.linspace(-0.9, 0.9, 10)
LIGHT = vp.Light((-4, -5, 6), parallel=True, intensity=1.0)


def tube(columns: int, rows: int) -> vp.Mesh:
    """A tube along a trefoil knot, all triangles."""
    u, v = np.meshgrid(2 * np.pi * np.arange(columns) / columns, 2 * np.pi * np.arange(rows) / rows, indexing="ij")
    middle = np.stack(
        [(2 + np.cos(3 * u)) * np.cos(2 * u), (2 + np.cos(3 * u)) * np.sin(2 * u), 0.7 * np.sin(3 * u)], axis=2
    )
    along = np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0)
    side = np.cross(along, (0.0, 0.0, 1.0))
    up = np.cross(side, along)
    side, up = (part / np.linalg.norm(part, axis=2, keepdims=True) for part in (side, up))
    points = middle + 0.4 * (np.cos(v)[..., None] * side + np.sin(v)[..., None] * up)
    here = np.arange(columns * rows).reshape(columns, rows)
    right, above = np.roll(here, -1, axis=0), np.roll(here, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    faces = np.concatenate([np.stack([here, right, both], axis=2), np.stack([here, both, above], axis=2)]).reshape(
        -1, 3
    )
    return vp.Mesh.from_triangles(points.reshape(-1, 3), faces)


def main(folder: Path) -> None:
    knot = tube(60, 9)
    pieces, _, band = cut_into_slices(knot.vertices[knot.corners], knot.offsets, 2, LEVELS)
    limits = np.concatenate([[-np.inf], LEVELS, [np.inf]])
    height = pieces.points[:, 2]
    low, high = (reduce.reduceat(height, pieces.offsets[:-1]) for reduce in (np.minimum, np.maximum))
    assert (low >= limits[band]).all() and (high <= limits[band + 1]).all(), "no piece leaves its slice"

    corners = np.split(np.arange(len(pieces.points)), pieces.offsets[1:-1])
    scene = vp.Scene((vp.Item("KNOT", vp.Mesh.from_polygons(pieces.points, [c.tolist() for c in corners])),), (LIGHT,))
    camera = vp.Camera(eye=(3, -9, 11), target=(0, 0, 0), fov_deg=34)
    view = look(scene, camera)
    shade = face_shades(view, scene.items, view_lights(view, scene.lights)).total
    faces = image_faces(view, np.arange(view.face_count))
    rank = np.empty(len(limits) - 1, dtype=np.intp)
    rank[slice_order(np.concatenate([[-9.0], LEVELS, [9.0]]), camera.eye[2])] = np.arange(len(rank))
    painted = sliced_order(faces, rank[band[faces.source]], view.tolerance)
    assert (np.diff(rank[band[painted.source]]) >= 0).all(), "slice by slice"

    colours = shaded_colours(["orange", "cyan"], band[painted.source] % 2, shade[painted.source])
    points = (55, 50) + 50.0 * painted.points[:2].T
    fills = Fills.flat(points, painted.offsets, colours)
    vp.save(
        vp.Drawing(110, 100, (vp.Layer("slices", vp.Pen(), (fills,)),), title="Slices"), folder / "sliced_surface.svg"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
