"""The stages of a picture: what they hand on, and the files they stand in.

All verbs begin alike: a file becomes a scene, and the scene a view in the camera's axes. draw finds the visible parts
of lines, paint the order of faces, render the pixels in front; all end with something that is saved.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import BLUE, CREAM, GREEN, GREY, INK, MINT, RED, ROSE, SAND, SKY, heads, layer, polygons, strokes

import vectorplot as vp
from vectorplot.drawing import lettered

BOX = np.array([38.0, 16.0])
"""Width and height of a box, in mm."""

SHARED = ("read", "io/read_file.py", "Scene"), ("prepare", "pictures/prepared_scene.py", "Scene, Camera")
DRAW = """lines, pictures/lines.py, Lines; hidden lines, visibility/, Visibility; place, drawing/strokes.py, Paths;
          layers and pens, drawing/layers.py, Drawing"""
PAINT = """polygons, shading/facet_resolution.py, View; order, visibility/painter/, Painted;
           shadows and glass, effects/, Decals; colours, pictures/fills.py, Drawing"""
RENDER = """triangles, shading/screen.py, ScreenTriangles; depth buffer, shading/depth_buffers.py, DepthBuffer;
            shadow maps, shading/shadow_maps.py, ShadowBuffer; light, shading/lighting.py, Image"""
VERBS = {"draw": (BLUE, SKY, DRAW), "paint": (RED, ROSE, PAINT), "render": (GREEN, MINT, RENDER)}
"""Pens, tints and stages: what a stage does, where it stands, and what it hands on."""


def box(corner) -> np.ndarray:
    """The corners of a box whose lower left one is given."""
    return np.asarray(corner) + BOX * np.array([(0, 0), (1, 0), (1, 1), (0, 1)])


ORIGIN, STEP, ROW, UP = np.array([4.0, 4.0]), np.array([48.0, 0.0]), 27.0, np.array([0.0, 1.0])
"""The lower left corner of the lowest left box, and from a box to the next one and from a row to the next, in mm."""


def texts(words, size_mm: float, colour: str) -> vp.Layer:
    """Texts (text, place) in the middle of their places, in letters of a pen."""
    written = [lettered(text, at, size_mm=size_mm, align="centre", level="middle").strokes for text, at in words]
    return layer("texts", strokes([lines[k] for lines in written for k in range(len(lines))]), colour, 0.2)


def main(folder: Path) -> None:
    boxes: list[np.ndarray] = []
    tints: list[str] = []
    titles, files, values = [], [], []
    arrows: dict[str, list[np.ndarray]] = {INK: []}

    def stand(corner, tint: str, what: tuple[str, str, str]) -> None:
        middle = corner + BOX / 2
        boxes.append(box(corner))
        tints.append(tint)
        titles.append((what[0], middle + UP * 4.6))
        files.append((what[1], middle - UP * 0.3))
        values.append((what[2], middle - UP * 4.9))

    shared = [ORIGIN + UP * ROW, ORIGIN + UP * ROW + STEP]
    for corner, what in zip(shared, SHARED, strict=True):
        stand(corner, CREAM, what)
    arrows[INK].append(np.array([shared[0] + BOX * (1, 0.5), shared[1] + BOX * (0, 0.5)]))
    last = ORIGIN + UP * ROW + 6 * STEP
    stand(last, SAND, ("save", "save.py, backends/", "SVG, PDF, PNG, ..."))
    for row, (verb, (ink, tint, text)) in enumerate(VERBS.items()):
        stages = [tuple(map(str.strip, stage.split(","))) for stage in text.split(";")]
        corners = [ORIGIN + UP * (2 - row) * ROW + (2 + k) * STEP for k in range(len(stages))]
        for corner, what in zip(corners, stages, strict=True):
            stand(corner, tint, what)
        ends = [shared[1] + BOX * (1, 0.5), *(c + BOX * (0, 0.5) for c in corners), last + BOX * (0, 0.5)]
        starts = [ends[0], *(c + BOX * (1, 0.5) for c in corners)]
        arrows[ink] = [np.array(pair) for pair in zip(starts, ends[1:], strict=True)]
        titles.append((verb, corners[0] + BOX * (0.5, 1.0) + UP * 3.2))
    layers = [layer("boxes", polygons(boxes, tints)), layer("frames", strokes(boxes, closed=True), INK)]
    for ink, ways in arrows.items():
        tails, tips = np.array([way[0] for way in ways]), np.array([way[-1] for way in ways])
        layers += [layer("arrows", strokes(ways), ink, 0.4), layer("heads", heads(tails, tips, ink))]
    layers += [texts(titles, 3.0, INK), texts(files, 1.7, GREY), texts(values, 2.2, INK)]
    size = last + BOX + np.array([4.0, ROW + 8.0])
    vp.save(vp.Drawing(*size.tolist(), tuple(layers)), folder / "walk_of_a_picture.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
