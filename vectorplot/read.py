"""A file -> what it holds: a scene, or a drawing that was saved as JSON."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from vectorplot.scene.scene import Scene


def read(
    path: str | os.PathLike[str],
    *,
    exaggeration: float | None = None,
    tolerance: float | None = None,
    molecules: str | None = None,
    parts: str | None = None,
) -> Scene | Any:
    """The scene in a file, or the drawing that `save` wrote into one.

    Parameters
    ----------
    path : str or path
        A mesh (obj, stl, ply, off, glb, vtk, vtu), parts of a CAD system (step, iges, brep), a molecule (xyz, pdb,
        cif), a terrain (asc, xyz), a drawing (json), or a text in the scene language (any other suffix). What is not
        found is looked for in data/, then among the files that come with the package, as "data/house.scene" or "house".
    exaggeration : float, optional
        What heights of a terrain are multiplied with. Where None they are left as they are, unless they would be seen
        as a plain or a needle: then they are made 1, 2 or 5 times a power of ten higher, and a warning says so.
    tolerance : float, optional
        How far the edges of parts of a CAD system may be off, as a part of the diagonal of the box around all of them
        (None: 0.00005, as much as 0.02 mm on a page A4).
    molecules : str, optional
        How a molecule is shown: ball-and-stick (where None), space-filling, tube or ribbon; see `io.molecule_scene`.
    parts : {"triangles", "exact"}, optional
        What the lines of parts of a CAD system are taken from: fine triangles (where None), or the surfaces of their
        faces, on which lines are exact in every view; it takes a few times as long. What is painted, hatched, cut and
        rendered is triangles either way.

    Returns
    -------
    Scene or Drawing
        The Drawing in a JSON file, else the Scene.

    Raises
    ------
    InputError
        One line with the file, the line where there is one, and the cause; for an exaggeration of what is no terrain,
        a tolerance that is not positive, and a style of molecules or a way of drawing parts for what is none.
    OSError
        For a drawing that cannot be opened.

    Notes
    -----
    What becomes of meshes says `vectorplot.io.read_file.read`; of layers and pens `vectorplot.backends.read_drawing`.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import vectorplot as vp
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "box.scene")
    ...     _ = path.write_text('title "Box"  BOX red box 1 2 3')
    ...     vp.read(path)
    <Scene 'Box': 1 items, 0 lights>
    """
    if Path(path).suffix.lower() == ".json" and exaggeration is None and molecules is None and parts is None:
        from vectorplot.backends.json import read_drawing

        return read_drawing(path)
    from vectorplot.io.read_file import read as read_file

    return read_file(path, exaggeration=exaggeration, tolerance=tolerance, molecules=molecules, parts=parts)
