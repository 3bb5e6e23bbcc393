"""Pictures that workers in other processes make: functions of a module, so that they can be pickled."""

import os
import time
import warnings
from functools import partial
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.batch import Task, fingerprint
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.save import write


def frame(number: int) -> bytes:
    """A line, in one place after another: workers are soon ready for it."""
    none = np.zeros(1, dtype=np.intp)
    ends = np.array([(1.0, 1.0 + 0.25 * number), (50.0, 30.0)])
    line = Paths(ends, np.array([0, 2]), none > 0, none, none, none, np.zeros((2, 3)))
    return write(Drawing(60.0, 60.0, (Layer("visible", Pen(), (line,)),)), "svg")


def slow_frame(number: int, seconds: float) -> bytes:
    """The same, some time later."""
    time.sleep(seconds)
    return frame(number)


def frames(folder: Path, count: int, content=frame, *rest) -> list[Task]:
    """Tasks for so many frames."""
    return [
        Task(str(folder / f"{number:04d}.svg"), partial(content, number, *rest), fingerprint("frame", str(number)))
        for number in range(count)
    ]


def deadly(number: int, marker: str, times: int) -> bytes:
    """The third frame kills its worker, so many times: the marker is a file that grows."""
    if number == 3:
        with Path(marker).open("ab") as file:
            file.write(b".")
        if Path(marker).stat().st_size <= times:
            os.kill(os.getpid(), 9)
    return frame(number)


def bad(number: int) -> bytes:
    """Every third one has bad input, and one more warns."""
    if number % 3 == 1:
        raise vp.InputError("no such colour", file="parts.scene", line=number)
    if number == 2:
        warnings.warn("two faces dropped", vp.InputWarning, stacklevel=1)
    return bytes([number])


def contents(folder: Path) -> dict[str, bytes]:
    """The pictures in a folder and below, by name."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.suffix == ".svg"
    }
