"""Hidden lines by painting, as pixels, against the exact lines of draw on all scenes of data/, from several sides."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import grey_dilation
from support.data_scenes import SCENES, scenes_to_try
from support.effort import several

import vectorplot as vp
from vectorplot.arrays import Floats
from vectorplot.backends.cairo import png_bytes
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry.camera import Camera
from vectorplot.scene.placement import default_camera
from vectorplot.scene.scene import Scene
from vectorplot.words import ON_THINGS

PAGE, PEN, DPI = vp.Page(120.0, 90.0, 5.0), Pen(0.3), 100.0
ROUGH = 0.1
"""Tolerance in mm: lines and facets are off by a fifth of a pixel."""
STEP = 80
"""Ink may be missing by so many of 255: lines are cut into parts, whose ends are round."""

MORE = 255.0 * (1.0 - PEN.width_mm / 25.4 * DPI / 2.0)
"""There may be more ink by so many of 255 than a line leaves in two rows of pixels, each half of its width: parts that
lie over one another, as those of sections seen from the side, darken both."""

MOST = 60
"""Items of a scene that are enough to hide one another: of a town some of the houses."""


def ink(drawing: Drawing) -> Floats:
    """(rows,columns) how dark pixels are, 0 to 255."""
    return 255.0 - np.asarray(Image.open(io.BytesIO(png_bytes(drawing, DPI))).convert("L"))


def erased(scene: Scene, camera: Camera) -> Floats:
    """The picture of hidden lines by painting with black lines."""
    drawing = vp.paint(
        replace(scene, background=None), camera, page=PAGE, fit=False, fills="erasing", tolerance_mm=ROUGH
    )
    (layer,) = drawing.layers
    (fills,) = layer.fills
    lines = np.repeat(fills.kind == FillKind.EDGE, np.diff(fills.offsets))
    black = replace(fills, colours=np.where(lines[:, None], 0, np.full(3, 255)).astype(np.uint8))
    return ink(replace(drawing, layers=(replace(layer, pen=PEN, marks=(black,)),)))


def exact(scene: Scene, camera: Camera) -> Floats:
    """The picture of all lines with exact hidden lines, drawn with one pen."""
    drawing = vp.draw(scene, camera, page=PAGE, fit=False, lines=ON_THINGS, curves="polyline", tolerance_mm=ROUGH)
    return ink(replace(drawing, layers=tuple(Layer(layer.name, PEN, layer.marks) for layer in drawing.layers)))


def cameras(scene: Scene) -> list[Camera]:
    low, high = scene.bounds
    middle, size = tuple((low + high) / 2.0), float(np.linalg.norm(high - low))
    return [
        scene.camera or default_camera(scene),
        Camera.view("iso", middle, size),
        Camera.view("front", middle, size),
        Camera(tuple(np.asarray(middle) + size * np.array([-0.9, 0.7, 0.4])), middle, fov_deg=40.0),
    ]


@pytest.mark.slow
@pytest.mark.capability("G7.1-screen-hl")
@pytest.mark.hard(20, 21)
@pytest.mark.filterwarnings("ignore::vectorplot.errors.InputWarning")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("path", scenes_to_try(), ids=lambda path: path.stem)
def test_what_painting_leaves_of_the_lines_are_the_exact_lines(path: Path) -> None:
    scene = vp.read(path)
    # Letters, the lines that go with them, and hatches are strokes that lie on top.
    every = several(1 + len(scene.items) // MOST, long=1)
    bare = tuple(
        replace(item, hatch=None, lines=None if item.lines == ("label",) else item.lines)
        for item in scene.items[::every]
    )
    scene = replace(scene, items=bare, labels=())
    views = cameras(scene)
    # Each scene from a side of its own.
    own = several(SCENES.index(path) % len(views), long=0)
    for number, camera in enumerate(views[own : own + several(1, long=len(views))]):
        left, wanted = erased(scene, camera), exact(scene, camera)
        missing = wanted - grey_dilation(left, 3)
        extra = left - grey_dilation(wanted, 3)
        assert wanted.any()
        assert missing.max() <= STEP and extra.max() <= MORE, number
