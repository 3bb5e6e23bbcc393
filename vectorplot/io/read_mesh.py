"""A mesh file -> a scene of its repaired parts."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import Mending, is_closed_oriented, repaired, sound_parts
from vectorplot.io.mesh_file import MeshFile, shown
from vectorplot.scene.colour_scales import Fields
from vectorplot.scene.extent import check_range
from vectorplot.scene.face_looks import FaceLook, FaceLooks
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene

MESH_SUFFIXES = (".obj", ".off", ".ply", ".stl", ".glb", ".vtk", ".vtu")


def mesh_scene(path: Path) -> Scene:
    """The items of a file with one of MESH_SUFFIXES, repaired; an InputWarning says what was repaired.

    Errors: InputError with the file.
    """
    try:
        reader = _mesh_reader(path.suffix.lower())
        assert reader is not None
        return _mesh_scene(path, reader(path))
    except InputError as error:
        raise (error if error.file else InputError(error.cause, file=shown(path))) from None
    except MemoryError:
        raise InputError("too large for the memory", file=shown(path)) from None
    except OSError as error:
        raise InputError(error.strerror or "cannot be read", file=shown(path)) from None


def whole_mesh(path: Path) -> tuple[Mesh, Fields | None, FaceLooks | None]:
    """All parts of a mesh file in one mesh, its fields, and looks of its faces. Errors, warnings: see mesh_scene."""
    items = mesh_scene(path).items
    meshes = [item.mesh for item in items]
    if len(meshes) == 1:
        return meshes[0], items[0].fields, _looks(items, meshes[0])
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    corners = np.concatenate([mesh.corners + begin for mesh, begin in zip(meshes, first, strict=False)])
    sizes = np.concatenate([mesh.face_sizes for mesh in meshes])
    whole = Mesh(np.concatenate([mesh.vertices for mesh in meshes]), corners, ragged.offsets(sizes))
    return whole, items[0].fields, _looks(items, whole)


def _looks(items: Sequence[Item], whole: Mesh) -> FaceLooks | None:
    """The looks of the faces of some items in one mesh."""
    plain, looks, of_face = Item("", whole), list[FaceLook](), []
    for item in items:
        own = item.face_looks
        number = np.full(item.mesh.face_count, -1, dtype=np.intp) if own is None else own.of_face
        of_face.append(np.where(number >= 0, number + len(looks), -1))
        looks += [] if own is None else own.looks
        if item.colour != plain.colour or item.material != plain.material:
            of_face[-1] = np.where(number >= 0, of_face[-1], len(looks))
            looks.append(FaceLook(item.colour, item.material))
    return FaceLooks(whole, tuple(looks), np.concatenate(of_face)) if looks else None


def _mesh_reader(suffix: str) -> Callable[[Path], MeshFile] | None:
    """The reader of a mesh format; None for what must be text in the scene language. Imported when called for."""
    if suffix == ".obj":
        from vectorplot.io.obj import read_obj

        return read_obj
    if suffix == ".off":
        from vectorplot.io.off import read_off

        return read_off
    if suffix == ".ply":
        from vectorplot.io.ply import read_ply

        return read_ply
    if suffix == ".stl":
        from vectorplot.io.stl import read_stl

        return read_stl
    if suffix == ".glb":
        from vectorplot.io.glb import read_glb

        return read_glb
    if suffix in (".vtk", ".vtu"):
        from vectorplot.io.cells import read_cells

        return read_cells
    return None


def _mesh_scene(path: Path, content: MeshFile) -> Scene:
    check_range(content.mesh.bounds)
    parts, mending = _repaired_parts(path.stem, content)
    filled = [Item(name, mesh, fields=content.fields) for name, mesh in parts if mesh.face_count]
    items = tuple(with_looks(item, content.looks) for item in filled)
    if not items:
        raise InputError(f"no face with an area ({mending})", file=shown(path))
    if str(mending):
        warnings.warn(f"{shown(path)}: {mending}", InputWarning, stacklevel=3)
    return Scene(items)


def with_looks(item: Item, known: FaceLooks | None) -> Item:
    """A polyhedron in its colours: those of all of its faces, if they are the same."""
    if known is None:
        return item
    mesh = item.mesh
    of_face = known.at(mesh)
    used, own = np.unique(of_face, return_inverse=True)
    looks = known.looks
    if len(used) == 1 and used[0] >= 0:
        look = looks[int(used[0])]
        colour = item.colour if look.colour is None else look.colour
        return replace(item, colour=colour, material=item.material if look.material is None else look.material)
    kept = tuple(looks[k] for k in used.tolist() if k >= 0)
    return replace(item, face_looks=FaceLooks(mesh, kept, own.ravel() - int(used[0] < 0))) if kept else item


def _repaired_parts(stem: str, content: MeshFile) -> tuple[list[tuple[str, Mesh]], Mending]:
    """The parts by name, repaired, and the sum of what was done to them."""
    if len(content.names) == 1 or _share_vertices(content.mesh, content.first_faces):
        # Objects that share vertices are one body: taken apart, their seams would be borders.
        name = content.names[0] if len(content.names) == 1 else stem
        mesh, mending = repaired(content.mesh, content.precision)
        return [(name, mesh)], mending
    if is_closed_oriented(content.mesh):
        mesh, mending = repaired(content.mesh, content.precision)
        if mending == Mending():
            return list(zip(content.names, _split(mesh, content.first_faces), strict=True)), mending
    sound, boundary = sound_parts(
        content.mesh, _face_parts(content.mesh, content.first_faces), len(content.names), content.precision
    )
    total = Mending(boundary_edges=int(boundary[sound].sum()))
    parts = list(zip(content.names, _split(content.mesh, content.first_faces), strict=True))
    for number in np.flatnonzero(~sound).tolist():
        name, part = parts[number]
        mesh, mending = repaired(part, content.precision)
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
