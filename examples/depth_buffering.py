"""Depth buffering: any polygons, in any order, also such that pierce each other; and the depths themselves.

Every pixel remembers the largest depth that any polygon had there, and whose it was. Source: Glaeser, section 7.3,
figure 7.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, ragged
from vectorplot.shading import DepthCode, depth_buffer, raster_system, screen_triangles
from vectorplot.surfaces import Torus

SIZE = (360, 300)


def scene(order: list[int]) -> vp.Scene:
    """Three rings that pierce a box, in some order."""
    turn = [np.eye(4), np.eye(4)[[0, 2, 1, 3]], np.eye(4)[[2, 1, 0, 3]]]
    names, colours = ("FLAT", "UPRIGHT", "ACROSS"), ("cyan", "orange", "pink")
    rings = [vp.Item(name, ring(place), colour) for name, place, colour in zip(names, turn, colours, strict=True)]
    move = np.eye(4)
    move[:3, 3] = -1.3
    items = [*rings, vp.Item("BOX", box((2.6, 2.6, 2.6)).transformed(move), "yellow")]
    return vp.Scene(tuple(items[k] for k in order), (vp.Light((-2, -3, 5), parallel=True),), title="Depth buffering")


def ring(place: np.ndarray) -> vp.Mesh:
    """A torus of triangles."""
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 120, endpoint=False), np.linspace(0, 2 * np.pi, 50, endpoint=False))
    points = Torus(2.0, 0.55).points(u, v).reshape(-1, 3) @ place[:3, :3]
    at = np.arange(6000).reshape(50, 120)
    right, up = np.roll(at, -1, axis=1), np.roll(at, -1, axis=0)
    both = np.roll(right, -1, axis=0)
    cells = np.concatenate(
        [np.stack([at, right, both], -1).reshape(-1, 3), np.stack([at, both, up], -1).reshape(-1, 3)]
    )
    return vp.Mesh.from_triangles(points, cells)


def main(folder: Path) -> None:
    camera = vp.Camera(eye=(6, -11, 7), fov_deg=30)
    image = vp.render(scene([0, 1, 2, 3]), camera, size=SIZE, samples=2, shadows="none")
    vp.save(image, folder / "depth_buffering.png")
    other = vp.render(scene([3, 1, 0, 2]), camera, size=SIZE, samples=2, shadows="none")
    assert np.abs(image.pixels.astype(int) - other.pixels).max(axis=2).mean() < 0.1, "whatever the order"

    system = raster_system(camera, *SIZE)
    meshes = [item.mesh for item in scene([0, 1, 2, 3]).items]
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    corners = [mesh.corners[ragged.fans(mesh.offsets)[0]] + k for mesh, k in zip(meshes, first[:-1], strict=True)]
    points = system.homogeneous(np.concatenate([mesh.vertices for mesh in meshes]))
    flat = screen_triangles(points, np.concatenate(corners))
    depths = flat.points[:, 2]
    buffer = depth_buffer(flat, *SIZE, depth_code=DepthCode.ushort(float(depths.min()), float(depths.max())))
    gray = np.where(buffer.code > 0, 40 + (buffer.code - 1000) // 320, 255).astype(np.uint8)
    vp.save(vp.Image(np.repeat(gray[..., None], 3, axis=2), "Depths"), folder / "depth_buffering_depths.png")
    assert buffer.code.max() <= 65000, "sixteen bits"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
