"""Sample drawings, and the programs that read what the backends write."""

from __future__ import annotations

import io
import os
import shutil
import subprocess
import sys
from pathlib import Path

import cairo
import numpy as np
import pytest

from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen


def paths_of(*polylines, closed=False, kind=0, item=0, hidden_by=0) -> Paths:
    """Paths from lists of points; points3d are the page points at height 0."""
    points = [np.array(line, dtype=np.float64).reshape(-1, 2) for line in polylines]
    flat = np.concatenate([np.zeros((0, 2)), *points])
    same = [np.full(len(points), value) for value in (closed, kind, item, hidden_by)]
    offsets = np.concatenate(([0], np.cumsum([len(line) for line in points]))).astype(np.intp)
    types = (np.bool_, np.intp, np.intp, np.intp)
    columns = [column.astype(dtype) for column, dtype in zip(same, types, strict=True)]
    return Paths(flat, offsets, *columns, np.column_stack((flat, np.zeros(len(flat)))))


def drawing_of(*marks: Paths, width=120.0, height=80.0, pen=None, names=("visible", "crease"), **other) -> Drawing:
    """A drawing with a layer for each of the marks."""
    pens = [pen] * 9 if pen else [Pen(0.5), Pen(0.3, "#c02010"), *[Pen(0.2, "#1040a0")] * 7]
    layers = [
        Layer(names[i] if i < len(names) else f"layer{i}", pens[i], (paths,), plotted=i < 2)
        for i, paths in enumerate(marks)
    ]
    return Drawing(width, height, tuple(layers), **{"items": ("box",), **other})


def program(name: str) -> str:
    """The path of a reader; its absence is a failure in CI and a skip elsewhere."""
    path = shutil.which(name) or shutil.which(name, path=str(Path(sys.executable).parent))
    return path or missing(name)


def missing(name: str) -> str:
    reason = f"{name} is not installed: it reads back what the backends write"
    if os.environ.get("CI") == "true":
        pytest.fail(reason)
    pytest.skip(reason)


def run(name: str, *arguments: object) -> bytes:
    """What the program prints; anything on stderr or another exit status than 0 fails the test."""
    result = subprocess.run([program(name), *map(str, arguments)], capture_output=True, timeout=600)
    assert result.returncode == 0, (result.stdout[-500:], result.stderr[-500:])
    assert not result.stderr, result.stderr[-500:]
    return result.stdout


DPI = 300
BLOCK = 4


def grey_of_png(png: bytes) -> np.ndarray:
    """Grey values from 0 to 1, row 0 on top."""
    picture = cairo.ImageSurface.create_from_png(io.BytesIO(png))
    rows = np.frombuffer(picture.get_data(), np.uint8).reshape(picture.get_height(), picture.get_stride() // 4, 4)
    return rows[:, : picture.get_width(), :3].mean(axis=2) / 255.0


def grey_of_pgm(pgm: bytes) -> np.ndarray:
    """Grey values from 0 to 1 of a binary PPM or PGM."""
    fields, data = [], pgm
    while len(fields) < 4:
        word, _, data = data.partition(b"\n" if data[:1] == b"#" else data[len(data.split(None, 1)[0]) :][:1])
        fields += [] if word[:1] == b"#" else [word]
    width, height = int(fields[1]), int(fields[2])
    channels = 3 if fields[0] == b"P6" else 1
    return np.frombuffer(data, np.uint8)[: width * height * channels].reshape(height, width, channels).mean(2) / 255.0


def downsampled(grey: np.ndarray) -> np.ndarray:
    rows, columns = (side // BLOCK for side in grey.shape)
    return grey[: rows * BLOCK, : columns * BLOCK].reshape(rows, BLOCK, columns, BLOCK).mean(axis=(1, 3))


def assert_same_picture(ours: np.ndarray, theirs: np.ndarray) -> None:
    """The pictures agree within antialiasing.

    After averaging blocks of 4 x 4 pixels at 300 dpi (a third of a millimetre): no block differs by more than a fifth
    of the way from white to black, and on average they differ by less than 0.006 (Ghostscript
    blackens every pixel it touches). A line moved by two pixels, left out or
    of another width fails.
    """
    assert max(abs(a - b) for a, b in zip(ours.shape, theirs.shape, strict=True)) <= 1
    rows, columns = (min(sides) for sides in zip(ours.shape, theirs.shape, strict=True))
    ours, theirs = downsampled(ours[:rows, :columns]), downsampled(theirs[:rows, :columns])
    assert ours.min() < 0.7, "the drawing shows nothing"
    difference = np.abs(ours - theirs)
    print(f"largest {difference.max():.3f}, mean {difference.mean():.5f}")
    assert difference.max() < 0.2
    assert difference.mean() < 0.006
