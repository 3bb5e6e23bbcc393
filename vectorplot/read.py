"""A file -> what it holds: a scene, or a drawing that was saved as JSON."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from vectorplot.scene.scene import Scene


def read(path: str | os.PathLike[str]) -> Scene | Any:
    """The scene in a file: a mesh (obj, stl, ply, off, glb) or a text in the scene language (any other suffix); or the
    Drawing in a JSON file (suffix .json) that `save` wrote.

    What becomes of meshes says `vectorplot.io.read.read`; of layers and pens `vectorplot.backends.read_drawing`.
    Errors: InputError, one line with the file, the line where there is one, and the cause; OSError for a drawing that
    cannot be opened.
    """
    if Path(path).suffix.lower() == ".json":
        from vectorplot.backends.json.document import read_drawing

        return read_drawing(path)
    from vectorplot.io.read import read as read_file

    return read_file(path)
