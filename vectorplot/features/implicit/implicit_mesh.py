"""Implicit surfaces polygonised up to their singular lines, sheet by sheet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.polygonize import polygonized, settled_from
from vectorplot.features.implicit.singular.implicit_singular_lines import SingularLines, singular_lines
from vectorplot.features.implicit.singular.singular_set import led_into_lines
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.weld import chained
from vectorplot.surfaces.surface import ImplicitSurface


@dataclass(frozen=True, eq=False)
class ImplicitMesh:
    """An implicit surface as triangles that end on its singular lines.

    Parameters
    ----------
    mesh : Mesh
        The triangles.
    on_line : (v,) array of bool
        Which vertices are on a singular line.
    lines : SingularLines
        Where sheets of the surface cross or end.
    doubts : tuple of str
        A sentence where it could not be settled how the surface hangs together.

    Notes
    -----
    Made by implicit_mesh.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> found = features.implicit_mesh(surfaces.implicit_sphere(1.0), cells=12)
    >>> isinstance(found, features.ImplicitMesh), bool(found.on_line.any()), found.doubts
    (True, False, ())
    """

    mesh: Mesh
    on_line: Bools
    lines: SingularLines
    doubts: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class SheetsApart:
    """Triangles (t,3) of nodes; vertex (n,): that of the mesh which a node stands for. One on a singular line has a
    node in every sheet that ends there; inner (n,3): the middle of its neighbours in this sheet; itself for others."""

    triangles: Ints
    vertex: Ints
    inner: Floats


def implicit_mesh(surface: ImplicitSurface, cells: int) -> ImplicitMesh:
    """An implicit surface polygonised up to its singular lines, for several families of curves on it.

    Parameters
    ----------
    surface : ImplicitSurface
        F and its box.
    cells : int
        Along the longest side of the box; more are taken until it is settled how the surface hangs together.

    Returns
    -------
    ImplicitMesh
        What ImplicitTracing takes as mesh.

    Raises
    ------
    InputError
        For what `polygonized` refuses.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> ball = surfaces.implicit_sphere(1.0)
    >>> tracing = features.ImplicitTracing(mesh=features.implicit_mesh(ball, cells=12))
    >>> levels = features.implicit_level_lines(ball, [0.0, 0.5], tracing=tracing)
    >>> outline = features.implicit_contour(ball, (4, 0, 0), tracing=tracing)
    >>> len(levels), len(outline)
    (2, 1)
    """
    mesh = polygonized(surface, cells)
    return mesh_with_lines(surface, mesh, singular_lines(surface, mesh), cells)


def mesh_with_lines(surface: ImplicitSurface, mesh: Mesh, lines: SingularLines, cells: int) -> ImplicitMesh:
    """The surface polygonised as a mesh, of so many cells, up to its singular lines. Where it has none the mesh is made
    finer until it is settled how it hangs together: with lines it never is, for sheets that cross are joined by chance.
    """
    doubts: tuple[str, ...] = ()
    if not len(lines):
        mesh, doubts = settled_from(surface, mesh, cells)
    led, on_line = led_into_lines(surface, mesh, lines)
    return ImplicitMesh(led, on_line, lines, doubts)


def sheets_apart(mesh: Mesh, on_line: Bools) -> SheetsApart:
    """The triangles of a mesh cut apart along singular lines; on_line (v,): the vertices on them."""
    triangles = mesh.corners.reshape(-1, 3).copy()
    count = len(mesh.vertices)
    row, place = np.nonzero(on_line[triangles])
    vertex = triangles[row, place]
    others = np.stack([triangles[row, (place + k) % 3] for k in (1, 2)], axis=1)
    inside = ~on_line[others]
    # Triangles are in one sheet that share a side from the line into it.
    corner, which = np.nonzero(inside)
    key = vertex[corner] * count + others[corner, which]
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(key[order][1:] == key[order][:-1])
    label = chained(len(row), corner[order[same]], corner[order[same + 1]])
    heads, number = np.unique(label, return_inverse=True)
    triangles[row, place] = count + number
    total, many = np.zeros((len(heads), 3)), np.zeros(len(heads))
    np.add.at(total, number[corner], mesh.vertices[others[corner, which]])
    np.add.at(many, number[corner], 1.0)
    inner = np.concatenate([mesh.vertices, total / np.maximum(many, 1.0)[:, None]])
    return SheetsApart(triangles, np.concatenate([np.arange(count), vertex[heads]]), inner)
