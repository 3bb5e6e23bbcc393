"""How large and how exact painted surfaces are as files, beside those of matplotlib: a table of docs/paint.md.

    python docs/size_peers.py peers.npz     with matplotlib, in an environment of its own: its pictures go to the file
    python docs/size_peers.py peers.npz     with vectorplot: both, as a table

An outline is off by as many mm as any of 600 x 600 points of the surface lies outside of what is painted; all pictures
are scaled to the same width. A shade is off where matplotlib gives a quadrilateral one shade: by the angles
between the normals within it, as steps of 255 of its own range of shades.
"""

from __future__ import annotations

import io
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

FINE, COARSE = 600, 50
WIDTH_MM = 180.0
FORMATS = ("svg", "pdf", "ps")
TOLERANCES_MM = (0.02, 0.05, 0.2, 0.5)
SCENES = {
    "torus": "torus 3 1",
    "sin(3x) cos(2y)": 'graph "sin(3*x)*cos(2*y)" x -2 2 y -2 2',
    "a spring of three turns": (
        'function "(3+0.5*cos(v))*cos(u)" "(3+0.5*cos(v))*sin(u)" "0.5*sin(v)+0.4*u" u 0 "6*pi" v 0 "2*pi"'
    ),
}


def net(name: str, parts: int) -> Any:
    """(parts+1, parts+1, 3) points of a surface."""
    s, t = np.meshgrid(np.linspace(0.0, 1.0, parts + 1), np.linspace(0.0, 1.0, parts + 1), indexing="ij")
    if name.startswith("sin"):
        x, y = 4.0 * s - 2.0, 4.0 * t - 2.0
        return np.stack([x, y, np.sin(3.0 * x) * np.cos(2.0 * y)], axis=-1)
    big, small, turns, rise = (3.0, 1.0, 1.0, 0.0) if name == "torus" else (3.0, 0.5, 3.0, 0.4)
    u, v = 2.0 * np.pi * turns * s, 2.0 * np.pi * t
    reach = big + small * np.cos(v)
    return np.stack([reach * np.cos(u), reach * np.sin(u), small * np.sin(v) + rise * u], axis=-1)


def shade_steps(name: str) -> tuple[float, float]:
    """By how many steps of 255 flat shades of the coarse net are off, at most and in the mean: matplotlib's rule takes
    the cosine between normal and light from three tenths of the colour to all of it."""
    fine = net(name, FINE)
    normal = np.cross(np.gradient(fine, axis=0), np.gradient(fine, axis=1))
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    light = np.array([np.cos(np.radians(19.4712)) * np.sin(np.radians(225)), np.cos(np.radians(225)), 1.0 / 3.0])
    light /= np.linalg.norm(light)
    side = FINE // COARSE
    blocks = (normal @ light)[:-1, :-1].reshape(COARSE, side, COARSE, side)
    off = np.abs(blocks - blocks.mean(axis=(1, 3), keepdims=True)) * 255.0 * 0.7 / 2.0
    return float(off.max()), float(off.mean())


def peers(path: Path) -> None:
    """Matplotlib's files and what is on them."""
    import matplotlib
    from matplotlib import pyplot
    from mpl_toolkits.mplot3d import proj3d

    matplotlib.use("svg")
    found: dict[str, Any] = {}
    for name in SCENES:
        figure = pyplot.figure(figsize=(8.27, 11.69))
        axes = figure.add_subplot(projection="3d")
        surface = axes.plot_surface(*np.moveaxis(net(name, COARSE), -1, 0), rstride=1, cstride=1)
        axes.set_axis_off()
        axes.set_aspect("equal")
        sizes = []
        for form in FORMATS:
            file = io.BytesIO()
            figure.savefig(file, format=form)
            sizes.append(len(file.getvalue()) / 1000.0)
        figure.dpi = 72.0
        figure.canvas.draw()
        faces = np.array([path.vertices[:4] for path in surface.get_paths()])
        flat = np.stack(proj3d.proj_transform(*net(name, FINE).reshape(-1, 3).T, axes.get_proj())[:2], axis=1)
        to_mm = axes.transData.transform
        found[f"{name} sizes"] = sizes
        found[f"{name} faces"] = to_mm(faces.reshape(-1, 2)).reshape(faces.shape)
        found[f"{name} net"] = to_mm(flat).reshape(FINE + 1, FINE + 1, 2)
    np.savez_compressed(path, **found)


def outline_error(polygons: Any, fine: Any) -> float:
    """How far points (n,n,2) of a surface lie outside of the polygons that are painted for it, where it is as wide as
    WIDTH_MM."""
    import shapely

    whole = shapely.union_all(shapely.make_valid(polygons))
    shapely.prepare(whole)
    outside = fine.reshape(-1, 2)[~shapely.contains_xy(whole, *fine.reshape(-1, 2).T)]
    return float(shapely.distance(shapely.points(outside), whole).max(initial=0.0) * WIDTH_MM / np.ptp(fine[..., 0]))


def table(path: Path) -> str:
    """Both as a table of Markdown."""
    import vectorplot as vp
    from vectorplot.geometry import polygons_of
    from vectorplot.save import write

    rows = ["| | outline off by | SVG | PDF | PS |", "| --- | --- | --- | --- | --- |"]
    with np.load(path) as peer:
        import shapely

        for name, surface in SCENES.items():
            error = outline_error(shapely.polygons(peer[f"{name} faces"]), peer[f"{name} net"])
            sizes = " | ".join(f"{size:.0f}" for size in peer[f"{name} sizes"])
            most, mean = shade_steps(name)
            shades = f"shades off by {most:.0f}, {mean:.1f} in the mean"
            rows.append(f"| {name}, matplotlib ({shades}) | {error:.3f} mm | {sizes} |")
            scene = path.with_suffix(".scene")
            scene.write_text(f"S gray surface {surface}\n", encoding="utf-8")
            for tolerance in TOLERANCES_MM:
                drawing = vp.paint(vp.read(scene), tolerance_mm=tolerance)
                (fills,) = drawing.layers[0].fills
                world = np.concatenate([net(name, FINE), np.ones((FINE + 1, FINE + 1, 1))], axis=-1)
                places = world @ drawing.page_from_world.T
                error = outline_error(polygons_of(fills.points.T, fills.offsets), places[..., :2] / places[..., 3:])
                sizes = " | ".join(f"{len(write(drawing, form)) / 1000.0:.0f}" for form in FORMATS)
                rows.append(f"| {name}, tolerance {tolerance:g} mm | {error:.3f} mm | {sizes} |")
    return "\n".join(rows)


if __name__ == "__main__":
    where = Path(sys.argv[1])
    if find_spec("vectorplot"):
        print(table(where))
    else:
        peers(where)
