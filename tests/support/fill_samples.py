"""Filled polygons that several tests of the backends paint, and pictures in colour of what they paint."""

from __future__ import annotations

import io

import numpy as np
from PIL import Image

from support.backend_samples import run
from vectorplot.backends.cairo import png_bytes
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.save import save

Picture = np.ndarray


def flat(polygons, colours, **other) -> Fills:
    """Polygons, given as lists of points, of one colour each."""
    points = np.concatenate([np.array(polygon, dtype=np.float64).reshape(-1, 2) for polygon in polygons])
    offsets = np.concatenate(([0], np.cumsum([len(polygon) for polygon in polygons]))).astype(np.intp)
    return Fills.flat(points, offsets, np.array(colours, dtype=np.uint8), **other)


def shaded(polygons, colours, **other) -> Fills:
    """Polygons with a colour for each corner."""
    fills = flat(polygons, [(0, 0, 0)] * len(polygons), **other)
    corners = np.concatenate([np.array(colour, dtype=np.uint8).reshape(-1, 3) for colour in colours])
    columns = {name: getattr(fills, name) for name in ("points", "offsets", "opacity", "item", "points3d", "kind")}
    return Fills(**columns, colours=corners)


def page_of(*marks: Fills | Paths, width=60.0, height=40.0, **other) -> Drawing:
    """A page with the marks in one layer."""
    return Drawing(width, height, (Layer("faces", Pen(0.5), marks),), **other)


def rgb(data: bytes) -> Picture:
    """Red, green and blue from 0 to 255, row 0 on top."""
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB")).astype(np.int16)


FORMATS = ("png", "svg", "pdf", "ps", "eps")


def pictures(drawing: Drawing, folder, dpi=300, formats=FORMATS) -> dict[str, Picture]:
    """The drawing in every format, or in some, seen by real readers."""
    for suffix in formats:
        if suffix != "png":
            save(drawing, folder / f"a.{suffix}")
    gs = ("-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dGraphicsAlphaBits=4", "-sDEVICE=ppmraw", f"-r{dpi}")
    own = rgb(png_bytes(drawing, dpi))
    size = f"-g{own.shape[1]}x{own.shape[0]}"
    readers = {
        "svg": ("rsvg-convert", "-d", dpi, "-p", dpi, "-b", "white", folder / "a.svg"),
        "pdf": ("pdftoppm", "-r", dpi, folder / "a.pdf"),
        "ps": ("gs", *gs, size, "-dFIXEDMEDIA", "-sOutputFile=%stdout", folder / "a.ps"),
        "eps": ("gs", *gs, size, "-dFIXEDMEDIA", "-sOutputFile=%stdout", folder / "a.eps"),
    }
    return {suffix: own if suffix == "png" else rgb(run(*readers[suffix])) for suffix in formats}


def colour_at(picture: Picture, x: float, y: float, height: float, dpi=300) -> list[int]:
    """The pixel at a place on the page, in mm."""
    return picture[int((height - y) / 25.4 * dpi), int(x / 25.4 * dpi)].tolist()


def fan(middle, radius, count) -> np.ndarray:
    """(n,3,2) triangles around a point."""
    angle = np.linspace(0.0, 2.0 * np.pi, count + 1) + 0.013
    rim = np.asarray(middle) + radius * np.stack((np.cos(angle), np.sin(angle)), axis=1)
    return np.stack((np.broadcast_to(middle, (count, 2)), rim[:-1], rim[1:]), axis=1)
