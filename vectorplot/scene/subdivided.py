"""Scenes whose meshes stand for smooth shapes, with the limit surfaces of their subdivision in place of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import chosen_faces
from vectorplot.geometry.vectors import norm
from vectorplot.scene.colour_scales import Fields
from vectorplot.scene.face_looks import FaceLooks
from vectorplot.scene.item import Item, SurfaceNormals
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.subdivision import LimitPlaces, SubdivisionSurface
from vectorplot.tolerances import SAG_OF_LIMIT
from vectorplot.words import DRAWN, LineKind

MOST_OF_ALL = 0.9
"""Which part of the patches is fine enough: some bend far more sharply than the others."""

LIMIT_LINES = tuple(word for word in DRAWN if word != LineKind.TANGENT.word)
"""What is drawn of limit surfaces where nothing is said."""

MOST_CELLS, MOST_TRIANGLES = 64, 1 << 19
"""A patch has at most so many cells along a side, a mesh about so many triangles, at least one or two a patch."""


def subdivided(scene: Scene, scheme: str = "catmull-clark", *, crease_angle_deg: float | None = None) -> Scene:
    """The scene with the limit surfaces of subdivision in place of its meshes.

    Parameters
    ----------
    scene : Scene
        Its polyhedra are the cages; smooth surfaces, curves, and meshes that know the normals of a smooth shape already
        stay as they are.
    scheme : {"catmull-clark", "loop"}
        Catmull and Clark's scheme for polygons, Loop's for triangles.
    crease_angle_deg : float, optional
        Edges at which a cage turns by more stay sharp (None: none but those with a single face).

    Returns
    -------
    Scene
        With items of the same names, see subdivided_item.

    Raises
    ------
    InputError
        See subdivided_item.
    TypeError
        For what is no scene.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> ball = vp.subdivided(vp.Scene((vp.Item("ball", geometry.box((1, 1, 1))),)))
    >>> ball.items[0].mesh.bounds[1].round(2).tolist()
    [0.92, 0.92, 0.92]
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"subdivided takes a Scene, such as vectorplot.io.scene_of(parts), not {type(scene).__name__}")
    items = [
        subdivided_item(item, scheme, crease_angle_deg=crease_angle_deg) if _is_cage(item) else item
        for item in scene.items
    ]
    return replace(scene, items=tuple(items))


def _is_cage(item: Item) -> bool:
    return item.mesh.face_count > 0 and item.normals is None and not item.is_cut_face


def subdivided_item(
    item: Item, scheme: str = "catmull-clark", *, creases: ArrayLike = (), crease_angle_deg: float | None = None
) -> Item:
    """An item with the limit surface of subdivision in place of its polyhedron.

    Parameters
    ----------
    item : Item
        Its mesh is the cage; faces that are not present are not there.
    scheme : {"catmull-clark", "loop"}
        Catmull and Clark's scheme for polygons, Loop's for triangles.
    creases : (e, 2) array_like of int
        Edges that stay sharp, by the vertices at their ends, from 0.
    crease_angle_deg : float, optional
        Edges at which the cage turns by more stay sharp too.

    Returns
    -------
    Item
        A mesh of triangles with vertices and normals on the limit surface, fine enough for a page. Its contours are
        those of the limit surface, point by point; borders and creases are its edges, and the curves to which the other
        edges of the cage come its tangent edges (`lines tangent`). Looks of faces, and fields, are carried along.

    Raises
    ------
    InputError
        With the item's name, for what is no polyhedron, for patterns on faces, and as in SubdivisionSurface.

    Notes
    -----
    The vertices of the cage come first, if faces have them all: labels at vertices name their limits.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> from vectorplot.scene import subdivided_item
    >>> ball = subdivided_item(vp.Item("ball", geometry.box((1, 1, 1))))
    >>> len(ball.drawn_edges), ball.mesh.is_closed
    (0, True)
    """
    if not isinstance(item.shape, Mesh):
        raise InputError(f"{item.name}: subdivision is for polyhedra only")
    if item.patterns:
        raise InputError(f"{item.name}: patterns on faces do not go with subdivision")
    cage = item.shape
    present = np.arange(cage.face_count) if cage.present is None else np.flatnonzero(cage.present)
    try:
        faces = cage if cage.present is None else chosen_faces(cage, cage.present)
        surface = SubdivisionSurface(faces, scheme, creases, crease_angle_deg)
        cells = _cells(surface)
        found = surface.mesh(cells)
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None
    mesh = Mesh.from_triangles(found.places, found.vertex[found.triangles])
    apart = Mesh.from_triangles(found.places[found.vertex], found.triangles)
    several = np.bincount(found.vertex, minlength=len(found.places)) > 1
    places = LimitPlaces(surface, found.patch, found.parameters, np.eye(4))
    looks, source = item.face_looks, present[found.source]
    if looks is not None:
        looks = FaceLooks(mesh, looks.looks, looks.at(cage)[source], looks.first)
    fields = item.fields
    if fields is not None:
        used, values = np.unique(surface.cage.corners), fields.at_vertices
        points = cage.vertices
        numbers = np.full((len(points), len(values)), np.nan)
        for column, name in enumerate(values):
            numbers[used, column] = fields.at(name, points[used])
        carried = surface.numbers(numbers, cells)
        own = {name: carried[:, column] for column, name in enumerate(values)}
        fields = Fields(mesh, own, {name: given[source] for name, given in fields.on_faces.items()})
    return replace(
        item,
        shape=mesh,
        curves=replace(item.curves, smooth_contours=True),
        normals=SurfaceNormals(apart, found.normals, several[found.vertex], places),
        default_lines=LIMIT_LINES if item.default_lines is None else item.default_lines,
        drawn_edges=found.places[found.sharp],
        tangent_edges=found.places[found.net],
        face_looks=looks,
        fields=fields,
    )


def _cells(surface: SubdivisionSurface) -> int:
    """Cells along the sides of patches."""
    off, size = surface.deviations(), float(norm(np.ptp(surface.cage.bounds, axis=0)))
    worst = float(np.quantile(off, MOST_OF_ALL)) if len(off) else 0.0
    cells = 1
    while (
        worst > SAG_OF_LIMIT * size * cells * cells
        and cells < MOST_CELLS
        and 8 * cells * cells * len(off) < MOST_TRIANGLES
    ):
        cells *= 2
    return cells
