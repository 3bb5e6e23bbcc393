"""Shortest ways on polyhedra: the spider and the fly, and round a hill.

In a room of 30, 12 and 12 feet a spider sits on an end wall, a foot below the ceiling, and a fly on the other one, a
foot above the floor, both half way between the sides. The shortest way is not the straight one, of 42 feet, but one of
40 over five of the six walls (Dudeney, 1903). On a hill the shortest ways from one point go round its top, to either
side.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import mesh_shortest_paths
from vectorplot.geometry import box
from vectorplot.scene import ShortestPaths, terrain_scene

SPIDER, FLY = (0.0, 6.0, 11.0), (30.0, 6.0, 1.0)
START = (1.5, 12.5)
ENDS = tuple((23.5, float(y)) for y in np.arange(1.5, 24.0, 2.0))


def lengths(paths) -> np.ndarray:
    steps = (np.diff(paths[k], axis=0) for k in range(len(paths)))
    return np.array([np.linalg.norm(step, axis=1).sum() for step in steps])


def room() -> vp.Drawing:
    """The room from outside with the way over its walls, what is hidden dashed."""
    walls = box((30, 12, 12))
    assert abs(lengths(mesh_shortest_paths(walls, [SPIDER], [FLY]))[0] - 40.0) < 1e-12
    lines = vp.SurfaceLines(integral=(ShortestPaths(((*SPIDER, *FLY),)),))
    ends = (("spider", SPIDER, "left"), ("fly", FLY, "right"))
    labels = tuple(vp.Label(text, at, place=side, mark="dot", hidden="solid") for text, at, side in ends)
    scene = vp.Scene((vp.Item("ROOM", walls, curves=lines),), labels=labels, title="The spider and the fly")
    camera = vp.Camera(eye=(-26, -50, 34), target=(15, 6, 5), fov_deg=30)
    return vp.draw(scene, camera, page=vp.Page(130, 80, 4), hidden="dashed", pens="integral=0.6:red,contour=0.3")


def hill() -> vp.Drawing:
    """A hill with level lines, and the shortest ways across it."""
    x, y = np.meshgrid(np.arange(26.0), np.arange(26.0))
    scene = terrain_scene(9.0 * np.exp(-((x - 12.5) ** 2 + (y - 12.5) ** 2) / 30.0), levels=12)
    (item,) = scene.items
    foot = np.array([(*START, 0.0), *((*end, 0.0) for end in ENDS)])
    paths = mesh_shortest_paths(item.mesh, np.repeat(foot[:1], len(ENDS), axis=0), foot[1:])
    over = max(paths[k][:, 2].max() for k in range(len(paths)))
    assert over < 0.6 * item.mesh.vertices[:, 2].max(), "none leads over the top"
    ways = tuple((*foot[0], *end) for end in foot[1:])
    curves = vp.SurfaceLines(sections=item.curves.sections, integral=(ShortestPaths(ways),))
    shown = vp.Item(item.name, item.mesh, item.colour, curves=curves, lines=("section", "index", "integral", "contour"))
    camera = vp.Camera(eye=(-10, -24, 52), target=(12.5, 12.5, 1), fov_deg=30)
    return vp.draw(
        vp.Scene((shown,), title="Round a hill"),
        camera,
        page=vp.Page(130, 100, 4),
        pens="integral=0.4:red,section=0.13",
    )


def main(folder: Path) -> None:
    vp.save(room(), folder / "shortest_paths_room.svg")
    vp.save(hill(), folder / "shortest_paths_hill.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
