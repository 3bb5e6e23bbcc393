"""Objects with a shape, of Python and of other libraries -> scenes: what the verbs take."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NoReturn, TypeGuard

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh, whole_numbers
from vectorplot.geometry.mesh_repair import repaired
from vectorplot.io.read_file import read
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene, renamed_cuts, renamed_labels, together
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.tolerances import SINGLE_ULP, ULP

TAKEN = (
    "a path, Scene, Item, Mesh, surface, curve, (vertices, faces), heights, a mesh of trimesh or meshio, "
    "a shape of build123d or CadQuery, or a list of these"
)
"""What the verbs take, in words."""

CURVE_HINT = "; vectorplot.curves.spline_curve(points, AkimaSpline()) is the curve through points"
"""What is said of points."""


def scene_of(shown: object, *, parts: str | None = None) -> Scene:
    """The scene of anything with a shape.

    Parameters
    ----------
    shown : path, Scene, Item, Mesh, surface, curve, or several of these
        A path is read as by `vp.read`; shapes become gray items named after what they are; so do a shape of build123d,
        CadQuery or OpenCASCADE, a mesh of another library, known by vertices and faces or by points and cells, whose
        volumes show their outer faces, arrays of vertices (n, 3) and faces (f, k), and a Terrain or heights (m, n),
        with level lines, extreme heights of arrays scaled as in files; a list of these, or a mapping that names them.
    parts : {"triangles", "exact"}, optional
        How parts of CAD systems among it are drawn, as in `vp.read`.

    Returns
    -------
    Scene
        Camera, page, background and title are the first that any has.

    Raises
    ------
    TypeError
        For anything else.
    InputError
        As in `vp.read`; for meshes that make no sense, and for a drawing.

    Warns
    -----
    InputWarning
        What was repaired of other meshes and of arrays; how heights were scaled.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, io
    >>> io.scene_of({"box": geometry.box((1, 1, 1)), "other": geometry.box((2, 1, 1))})
    <Scene '': 2 items, 0 lights>
    """
    return _scene_of(shown, (), parts)


def _scene_of(shown: Any, around: tuple[object, ...], parts: str | None) -> Scene:
    """The same, of a part of what is around it."""
    if any(shown is one for one in around):
        raise TypeError(f"a {type(shown).__name__} that holds itself has no end")
    if isinstance(shown, Scene):
        return shown
    if isinstance(shown, str | os.PathLike):
        return _read(shown, parts)
    from vectorplot.surfaces.terrains import Terrain

    if isinstance(shown, Terrain):
        from vectorplot.scene.terrains import terrain_scene

        return terrain_scene(shown)
    if _is_heights(shown):
        from vectorplot.io.terrain_files import scene_of_array

        return scene_of_array(shown)
    # Only where a shape of OpenCASCADE can be, it is looked for.
    if sys.modules.get("OCP") is not None:
        from vectorplot.io.cad_files import PARTS, cad_object_scene

        if (found := cad_object_scene(shown, PARTS[0] if parts is None else parts)) is not None:
            return found
    item = _item(shown)
    if item is not None:
        return Scene((item,))
    if isinstance(shown, Mapping):
        return together([_named(str(name), _scene_of(one, (*around, shown), parts)) for name, one in shown.items()])
    dump = getattr(shown, "dump", None)
    if callable(dump) and hasattr(shown, "geometry"):
        return together([scene_of(one, parts=parts) for one in dump()])
    if isinstance(shown, Iterable) and not isinstance(shown, np.ndarray | bytes):
        return together([_scene_of(one, (*around, shown), parts) for one in shown])
    _refuse(shown)


def _is_heights(shown: object) -> TypeGuard[Floats]:
    """Whether something is an array of heights; one of two or three columns may be points."""
    return (
        isinstance(shown, np.ndarray)
        and shown.ndim == 2
        and shown.dtype.kind in "fiu"
        and min(shown.shape) > len("xyz")
    )


def _refuse(shown: object) -> NoReturn:
    shape = f" of shape {shown.shape}" if isinstance(shown, np.ndarray) else ""
    points = isinstance(shown, np.ndarray) and shown.ndim == 2 and shown.shape[1] == len("xyz")
    raise TypeError(f"expected {TAKEN}, not {type(shown).__name__}{shape}{CURVE_HINT if points else ''}")


def _read(path: str | os.PathLike[str], parts: str | None) -> Scene:
    if Path(path).suffix.lower() == ".json":
        raise InputError("a drawing that was saved: it has no shapes to draw again", file=os.fspath(path))
    return read(path, parts=parts)


def _item(shown: Any) -> Item | None:
    """The item that something is; None for what is none, or several."""
    if isinstance(shown, Item):
        return shown
    if isinstance(shown, Mesh):
        return Item("mesh", shown)
    if isinstance(shown, tuple | list) and len(shown) == 2 and _is_pair(*shown):
        return Item("mesh", _from_arrays(shown[0], shown[1]))
    if is_curve(shown) or is_parametrised(shown) or is_implicit(shown):
        return Item(type(shown).__name__.lower(), shown)
    if hasattr(shown, "points") and hasattr(shown, "cells"):
        from vectorplot.io.cells import CELL_FIELDS, mesh_of_cells

        points = np.asarray(shown.points)
        whole, fields = mesh_of_cells(points, shown.cells, *(getattr(shown, name, {}) for name in CELL_FIELDS))
        return Item("mesh", _repaired(points, whole.corners, whole.offsets), fields=fields)
    if hasattr(shown, "vertices") and hasattr(shown, "faces"):
        mesh = _from_arrays(shown.vertices, shown.faces)
        named = getattr(shown, "vertex_attributes", None), getattr(shown, "face_attributes", None)
        if not any(isinstance(one, Mapping) and one for one in named):
            return Item("mesh", mesh)
        from vectorplot.io.cells import fields_of

        faces = whole_numbers(np.asarray(shown.faces))
        offsets = np.arange(0, faces.size + 1, faces.shape[1])
        return Item("mesh", mesh, fields=fields_of(np.asarray(shown.vertices), faces.ravel(), offsets, *named))
    return None


def _is_pair(vertices: object, faces: object) -> bool:
    """Whether two things are arrays of vertices and of faces."""
    if not isinstance(vertices, np.ndarray) or vertices.ndim != 2 or vertices.shape[1] != 3:
        return False
    if isinstance(faces, np.ndarray):
        return faces.ndim == 2 and faces.dtype.kind in "iuf"
    return isinstance(faces, Sequence) and all(isinstance(face, Sequence | np.ndarray) for face in faces)


def _from_arrays(vertices: Any, faces: Any) -> Mesh:
    """The mesh of vertices (n,3) and of faces, an array (f,k) or lists of indices."""
    places = np.asarray(vertices)
    if isinstance(faces, np.ndarray) and faces.ndim == 2:
        return _repaired(places, whole_numbers(faces).ravel(), np.arange(0, faces.size + 1, max(faces.shape[1], 1)))
    lists = [np.asarray(face).ravel() for face in faces]
    corners = np.concatenate([np.zeros(0, dtype=np.intp), *lists])
    return _repaired(places, whole_numbers(corners), ragged.offsets([len(face) for face in lists]))


def _repaired(vertices: np.ndarray[Any, Any], corners: Ints, offsets: Ints) -> Mesh:
    """The mesh, welded where it is open and turned outwards; an InputWarning says what was repaired."""
    if vertices.ndim == 2 and vertices.shape[1] == 2:
        vertices = np.column_stack([vertices, np.zeros(len(vertices))])
    mesh = Mesh(np.asarray(vertices, dtype=np.float64), np.asarray(corners, dtype=np.intp), offsets)
    mesh, done = repaired(mesh, SINGLE_ULP if vertices.dtype == np.float32 else ULP)
    # An open mesh is no mistake of a program.
    told = str(replace(done, boundary_edges=0))
    if told:
        warnings.warn(f"mesh: {told}", InputWarning, stacklevel=4)
    return mesh


def _named(name: str, scene: Scene) -> Scene:
    """The scene with this name for its only item, or in front of those of its items."""
    alone = len(scene.items) == 1
    items = tuple(replace(item, name=name if alone else f"{name} {item.name}") for item in scene.items)
    return replace(scene, items=items, labels=renamed_labels(scene, items), cuts=renamed_cuts(scene, items))
