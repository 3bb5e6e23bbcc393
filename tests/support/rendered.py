"""Scenes to be rendered, and what is read off their pictures."""

from __future__ import annotations

import numpy as np

import vectorplot as vp
from vectorplot.geometry.mesh import Mesh
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.testing.shapes import box

SUN = vp.Light((-1.0, -2.0, 2.5), parallel=True, intensity=1.0)
SIZE = (160, 120)
FINE = (240, 180)
"""For borders of shadows."""


def sphere(colour="gray", word="normal", radius=1.0):
    return vp.Item("BALL", Sphere(radius), colour, vp.Material(word))


def levels(image):
    """(rows, columns) the level of gray."""
    return image.pixels[..., 0].astype(np.float64)


def inside_out(mesh):
    return Mesh.from_polygons(mesh.vertices, [polygon[::-1] for polygon in mesh.polygons()])


def grown(mask):
    padded = np.pad(mask, 1)
    rows, columns = mask.shape
    return np.logical_or.reduce([padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)])


def coloured_boxes():
    """Boxes in plain colours before, beside and behind a mirror in the plane x = 0, which faces +x."""
    mirror = vp.Item("GLASS", box((-0.1, -3, -3), (0, 3, 3)), "gray", vp.Material("mirror"))
    boxes = [
        vp.Item("RED", box((1, -1, -1), (2, 0, 0)), "#ff0000"),
        vp.Item("GREEN", box((2.5, 0.5, -1), (3.5, 1.5, 1)), "#00ff00"),
        vp.Item("BLUE", box((-3, -1, -1), (-2, 1, 1)), "#0000ff"),
    ]
    return vp.Scene((mirror, *boxes))


GLASS = vp.Item("PANE", box((-1, -1, -1), (1, 1, 1)), material=vp.Material(opacity=0.5))
