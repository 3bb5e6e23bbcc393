"""Four shadow maps of one size for one view: the scene, the box about what is seen, a trapezoid, after the perspective.

The trapezoid around what is seen, and what the light sees of it after the camera's perspective, give most of the map to
what is near the eye. Above the pictures with the first and the last two, below the maps; the light falls in from the
left. Sources: Martin and Tan, Trapezoidal shadow maps, recipe; Ressler, Notes on implementation; Stamminger and
Drettakis, Perspective shadow maps, 2002.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, ragged
from vectorplot.shading import raster_system, region_in_picture, shadow_buffer
from vectorplot.textbook import texels_per_unit

SIZE, MAP = (300, 200), 200
LIGHT = vp.Light((-2.0, -0.6, 1.6), parallel=True, intensity=1.0)
CAMERA = vp.Camera(eye=(0, -62, 5), target=(0, -40, 1.5), fov_deg=38)


def field() -> list[vp.Mesh]:
    """A plate with blocks, some of them close to the eye."""
    rng = np.random.default_rng(5)
    meshes = [box((120, 120, 1))]
    moves = [(-60.0, -60.0, -1.0)]
    for number in range(130):
        x, y = rng.uniform(-55, 55, 2) if number % 3 else (rng.uniform(-6, 6), rng.uniform(-54, -38))
        meshes.append(box((*rng.uniform(0.4, 1.2, 2), rng.uniform(0.8, 4))))
        moves.append((float(x), float(y), 0.0))
    places = np.tile(np.eye(4), (len(moves), 1, 1))
    places[:, :3, 3] = moves
    return [mesh.transformed(place) for mesh, place in zip(meshes, places, strict=True)]


def coloured(code: np.ndarray) -> np.ndarray:
    """(n, n, 3) depths as colours: the nearer to the lamp, the brighter, by their ranks."""
    rank = np.searchsorted(np.unique(code[code > 0]), code) / max(1, len(np.unique(code[code > 0])))
    stops = np.array([(20, 30, 74), (32, 104, 136), (112, 190, 130), (254, 236, 150)], dtype=float)
    colours = np.stack([np.interp(rank, np.linspace(0, 1, 4), stops[:, k]) for k in range(3)], axis=-1)
    colours[code == 0] = 232
    return colours.astype(np.uint8)


def main(folder: Path, width: int = 1600) -> None:
    meshes = field()
    colours = ["#efe9dc", *["orange", "cyan", "yellow"] * 50]
    items = tuple(vp.Item(f"B{k}", mesh, colours[k]) for k, mesh in enumerate(meshes))
    scene = vp.Scene(items, (LIGHT,), title="Shadow maps")
    unit = width // 320
    size, side, gap = (106 * unit, 66 * unit), 78 * unit, 2 * unit
    options = {"size": size, "fit": False, "samples": 3, "shadow_size": MAP}
    pictures = [
        vp.render(scene, CAMERA, shadows=how, **options).pixels for how in ("buffer", "trapezoid", "perspective")
    ]

    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    points = np.concatenate([mesh.vertices for mesh in meshes])
    corners = np.concatenate([m.corners[ragged.fans(m.offsets)[0]] + k for m, k in zip(meshes, first, strict=False)])
    region = region_in_picture(raster_system(CAMERA, *SIZE), *SIZE, points, corners)

    def map_of(frame, side):
        return shadow_buffer(LIGHT, points, corners, size=side, rows=side, frame=frame, region=region).maps[0]

    maps = {frame: map_of(frame, MAP) for frame in ("standard", "box", "trapezoid", "perspective")}
    page = np.full((size[1] + gap + side, width, 3), 255, dtype=np.uint8)
    for k, picture in enumerate(pictures):
        left = k * (width - size[0]) // 2
        page[: size[1], left : left + size[0] - gap] = picture[:, gap:]
    for k, frame in enumerate(maps):
        left = k * (width - side) // 3
        page[-side:, left : left + side] = coloured(map_of(frame, side).code)
    vp.save(vp.Image(page, "Maps"), folder / "shadow_maps.png")

    near = np.array([(x, y, 0.0) for x in (-2, 0, 2) for y in (-55, -52, -49)])
    texels = {frame: texels_per_unit(found, near).mean() for frame, found in maps.items()}
    assert texels["trapezoid"] > 8 * texels["standard"], "texels for the same ground before the eye"
    assert texels["trapezoid"] > 5 * texels["box"] > 5 * texels["standard"]
    assert texels["perspective"] > 4 * texels["trapezoid"]


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
