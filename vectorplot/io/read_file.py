"""A file -> a scene."""

from __future__ import annotations

import os
from pathlib import Path

from vectorplot.errors import InputError
from vectorplot.io.foreign import foreign_kind
from vectorplot.io.meshes.mesh_file import check_file, shown
from vectorplot.io.meshes.read_mesh import MESH_SUFFIXES, mesh_scene
from vectorplot.scene.scene import Scene

MOLECULE_SUFFIXES = (".xyz", ".pdb", ".ent", ".cif", ".mmcif")
TERRAIN_SUFFIXES = (".asc",)
SCENE_SUFFIXES = (".scene", ".txt")


def read(path: str | os.PathLike[str], *, exaggeration: float | None = None) -> Scene:
    """The scene in a file: a mesh (obj, stl, ply, off, glb), a molecule (xyz, pdb, cif), a terrain (asc, xyz) or a text
    in the scene language (any other suffix).

    exaggeration: what heights of a terrain are multiplied with; those much smaller or larger than the terrain is wide
    are made 1, 2 or 5 times a power of ten higher where None, which an InputWarning says.

    A mesh file gives one item named after the file, or one for every object (OBJ) or node (glb) if there are several.
    Meshes are mended (see mesh_repair.mended); what was mended, and what could not be, is said in one InputWarning a
    file.
    Errors: InputError, one line with the file, the line where there is one, and the cause; a file of another kind is
    named as such.
    """
    path = Path(path)
    check_file(path)
    if _is_terrain(path):
        from vectorplot.io.terrains.terrain_scene import scene_of_heights

        return scene_of_heights(path, exaggeration)
    if exaggeration is not None:
        raise InputError("heights are exaggerated of terrains only (asc, xyz)", file=shown(path))
    if path.suffix.lower() in MOLECULE_SUFFIXES:
        from vectorplot.io.molecules.molecule_scene import molecule_scene
        from vectorplot.io.molecules.read_molecule import read_molecule

        return molecule_scene(read_molecule(path))
    if path.suffix.lower() in MESH_SUFFIXES:
        return mesh_scene(path)
    _check_text(path)
    return _scene_text(path)


def _is_terrain(path: Path) -> bool:
    """Whether a file holds heights: its suffix tells, and that of molecules with what it begins with."""
    if path.suffix.lower() != ".xyz":
        return path.suffix.lower() in TERRAIN_SUFFIXES
    from vectorplot.io.terrains.read_terrain import holds_points

    return holds_points(path)


def _scene_text(path: Path) -> Scene:
    """The scene that a text describes; what is wrong with it may be that it is none."""
    from vectorplot.io.scenes.scene_language import read_scene

    try:
        return read_scene(path)
    except InputError as error:
        if path.suffix.lower() in SCENE_SUFFIXES:
            raise
        cause = f"{error.cause} (it was read as a scene: meshes end in {', '.join(MESH_SUFFIXES)})"
        raise InputError(cause, file=error.file, line=error.line) from None


def _check_text(path: Path) -> None:
    """An InputError, which names its kind, for a file that cannot be a scene text."""
    with path.open("rb") as file:
        kind = foreign_kind(path, file.read(4096))
    if kind:
        raise InputError(kind, file=shown(path))
