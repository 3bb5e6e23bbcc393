"""Depth buffering: any polygons, in any order, also such that pierce each other; and the depths themselves.

Every pixel remembers the largest depth that any polygon had there, and whose it was. In the second picture all of one
depth have one colour, from yellow near the eye to blue far away, with a black line at every twelfth part.
Source: Glaeser, section 7.3, figure 7.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, ragged
from vectorplot.shading import DepthCode, depth_buffer, raster_system, screen_triangles
from vectorplot.surfaces import Torus

SMALL = (160, 128)
TURNS = [np.eye(3), np.eye(3)[[0, 2, 1]], np.eye(3)[[2, 1, 0]]]
NAMES, COLOURS = ("FLAT", "UPRIGHT", "ACROSS"), ("cyan", "orange", "pink")
CAMERA = vp.Camera(eye=(6, -11, 7), fov_deg=22)


def scene(order: list[int]) -> vp.Scene:
    """Three rings that pierce a box, in some order."""
    rings = [vp.Item(name, ring(turn), colour) for name, turn, colour in zip(NAMES, TURNS, COLOURS, strict=True)]
    move = np.eye(4)
    move[:3, 3] = -1.3
    items = [*rings, vp.Item("BOX", box((2.6, 2.6, 2.6)).transformed(move), "yellow")]
    return vp.Scene(tuple(items[k] for k in order), (vp.Light((-2, -3, 5), parallel=True),), title="Depth buffering")


def ring(turn: np.ndarray) -> vp.Mesh:
    """A torus of triangles."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 150, endpoint=False), np.linspace(0, 2 * np.pi, 60, endpoint=False))
    points = Torus(2.0, 0.55).points(u, v).reshape(-1, 3) @ turn
    at = np.arange(u.size).reshape(u.shape)
    right, up = np.roll(at, -1, axis=1), np.roll(at, -1, axis=0)
    both = np.roll(right, -1, axis=0)
    cells = [np.stack([at, right, both], -1).reshape(-1, 3), np.stack([at, both, up], -1).reshape(-1, 3)]
    return vp.Mesh.from_triangles(points, np.concatenate(cells))


def depths_of(size: tuple[int, int]) -> np.ndarray:
    """(rows, columns) the depths as a buffer of sixteen bits has them, 0 where nothing is."""
    system = raster_system(CAMERA, *size)
    meshes = [item.mesh for item in scene([0, 1, 2, 3]).items]
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    corners = [mesh.corners[ragged.fans(mesh.offsets)[0]] + k for mesh, k in zip(meshes, first[:-1], strict=True)]
    points = system.homogeneous(np.concatenate([mesh.vertices for mesh in meshes]))
    flat = screen_triangles(points, np.concatenate(corners))
    depths = flat.points[:, 2]
    code = DepthCode.ushort(float(depths.min()), float(depths.max()))
    return depth_buffer(flat, *size, depth_code=code).code


def main(folder: Path, width: int = 1600) -> None:
    size = (width, width * 4 // 5)
    options = {"fit": False, "samples": 3, "shadows": "none"}
    vp.save(vp.render(scene([0, 1, 2, 3]), CAMERA, size=size, **options), folder / "depth_buffering.png")
    one, other = (
        vp.render(scene(order), CAMERA, size=SMALL, samples=2, shadows="none").pixels.astype(int)
        for order in ([0, 1, 2, 3], [3, 1, 0, 2])
    )
    assert np.abs(one - other).max(axis=2).mean() < 0.1, "whatever the order"

    code = depths_of((2 * size[0], 2 * size[1]))
    covered = code > 0
    low, high = code[covered].min(), code.max()
    part = (code.astype(float) - low) / (int(high) - int(low))
    stops = np.array([(24, 46, 110), (38, 120, 142), (120, 196, 120), (252, 226, 110)], dtype=float)
    colours = np.stack([np.interp(part, np.linspace(0, 1, 4), stops[:, k]) for k in range(3)], axis=-1)
    band = np.floor(12 * part) * covered
    edge = (band != np.roll(band, 1, axis=0)) | (band != np.roll(band, 1, axis=1))
    colours[~covered], colours[edge] = 255, colours[edge] * 0.35
    small = colours.reshape(size[1], 2, size[0], 2, 3).mean(axis=(1, 3))
    vp.save(vp.Image(small.round().astype(np.uint8), "Depths"), folder / "depth_buffering_depths.png")
    assert high <= 65000, "sixteen bits"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
