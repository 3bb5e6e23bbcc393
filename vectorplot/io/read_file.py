"""A file -> a scene."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.mesh_repair import Mending, is_closed_oriented, mended
from vectorplot.geometry.repair.sound_parts import sound_parts
from vectorplot.io.foreign import foreign_kind
from vectorplot.io.meshes.mesh_file import MeshFile, check_file, shown
from vectorplot.scene.extent import check_range
from vectorplot.scene.scene import Item, Scene

MESH_SUFFIXES = (".obj", ".off", ".ply", ".stl", ".glb")
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
    reader = _mesh_reader(path.suffix.lower())
    if reader is None:
        _check_text(path)
        return _scene_text(path)
    try:
        return _mesh_scene(path, reader(path))
    except InputError as error:
        raise (error if error.file else InputError(error.cause, file=shown(path))) from None
    except MemoryError:
        raise InputError("too large for the memory", file=shown(path)) from None
    except OSError as error:
        raise InputError(error.strerror or "cannot be read", file=shown(path)) from None


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


def _mesh_reader(suffix: str) -> Callable[[Path], MeshFile] | None:
    """The reader of a mesh format; None for what must be text in the scene language. Imported when called for."""
    if suffix == ".obj":
        from vectorplot.io.meshes.obj import read_obj

        return read_obj
    if suffix == ".off":
        from vectorplot.io.meshes.off import read_off

        return read_off
    if suffix == ".ply":
        from vectorplot.io.meshes.ply import read_ply

        return read_ply
    if suffix == ".stl":
        from vectorplot.io.meshes.stl import read_stl

        return read_stl
    if suffix == ".glb":
        from vectorplot.io.meshes.glb import read_glb

        return read_glb
    return None


def _check_text(path: Path) -> None:
    """An InputError, which names its kind, for a file that cannot be a scene text."""
    with path.open("rb") as file:
        kind = foreign_kind(path, file.read(4096))
    if kind:
        raise InputError(kind, file=shown(path))


def _mesh_scene(path: Path, content: MeshFile) -> Scene:
    check_range(content.mesh.bounds)
    parts, mending = _mended_parts(path.stem, content)
    items = tuple(Item(name, mesh) for name, mesh in parts if mesh.face_count)
    if not items:
        raise InputError(f"no face with an area ({mending})", file=shown(path))
    if str(mending):
        warnings.warn(f"{shown(path)}: {mending}", InputWarning, stacklevel=3)
    return Scene(items)


def _mended_parts(stem: str, content: MeshFile) -> tuple[list[tuple[str, Mesh]], Mending]:
    """The parts by name, mended, and the sum of what was done to them."""
    if len(content.names) == 1 or _share_vertices(content.mesh, content.first_faces):
        # Objects that share vertices are one body: taken apart, their seams would be borders.
        name = content.names[0] if len(content.names) == 1 else stem
        mesh, mending = mended(content.mesh, content.precision)
        return [(name, mesh)], mending
    if is_closed_oriented(content.mesh):
        mesh, mending = mended(content.mesh, content.precision)
        if mending == Mending():
            return list(zip(content.names, _split(mesh, content.first_faces), strict=True)), mending
    sound, boundary = sound_parts(
        content.mesh, _face_parts(content.mesh, content.first_faces), len(content.names), content.precision
    )
    total = Mending(boundary_edges=int(boundary[sound].sum()))
    parts = list(zip(content.names, _split(content.mesh, content.first_faces), strict=True))
    for number in np.flatnonzero(~sound).tolist():
        name, part = parts[number]
        mesh, mending = mended(part, content.precision)
        parts[number] = (name, mesh)
        total = total + mending
    return parts, total


def _face_parts(mesh: Mesh, first_faces: tuple[int, ...]) -> Ints:
    return ragged.owner(np.diff([*first_faces, mesh.face_count]))


def _share_vertices(mesh: Mesh, first_faces: tuple[int, ...]) -> bool:
    part = np.repeat(_face_parts(mesh, first_faces), mesh.face_sizes)
    owner = np.zeros(len(mesh.vertices), dtype=np.intp)
    owner[mesh.corners] = part
    return bool((owner[mesh.corners] != part).any())


def _split(mesh: Mesh, first_faces: tuple[int, ...]) -> list[Mesh]:
    """The parts as meshes of their own."""
    order = np.zeros(len(mesh.vertices), dtype=np.intp)
    owner = np.full(len(mesh.vertices), -1)
    owner[mesh.corners] = np.repeat(_face_parts(mesh, first_faces), mesh.face_sizes)
    sorted_vertices = np.argsort(owner, kind="stable")
    first_vertices = np.searchsorted(owner[sorted_vertices], np.arange(len(first_faces) + 1))
    order[sorted_vertices] = np.arange(len(order))
    vertices, corners = mesh.vertices[sorted_vertices], order[mesh.corners]
    ends = [*first_faces[1:], mesh.face_count]
    parts = []
    for k, (begin, end) in enumerate(zip(first_faces, ends, strict=True)):
        offsets = mesh.offsets[begin : end + 1]
        low, high = first_vertices[k], first_vertices[k + 1]
        own = corners[offsets[0] : offsets[-1]] - low
        parts.append(Mesh(vertices[low:high], own, offsets - offsets[0]))
    return parts
