"""Bodies of a scene that touch or overlap, as one: drawn without lines where they meet, without what lies inside."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError
from vectorplot.features.surface_points import USUAL_CREASE_DEG
from vectorplot.geometry.boxes import overlapping_pairs
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import zero_distance
from vectorplot.geometry.unions import polyhedron_union
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.geometry.weld import chained
from vectorplot.geometry.winding import edge_uses
from vectorplot.scene.item import Item
from vectorplot.scene.labels import AtVertex, Label, renamed
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import SAME_PLANE_SINE


def united(scene: Scene) -> Scene:
    """The scene with bodies that touch or overlap, and look alike, made one.

    Parameters
    ----------
    scene : Scene
        Its closed polyhedra are the bodies. Those with patterns, looks of single faces, lines of their own or numbers
        at their vertices stay as they are, and so does all else.

    Returns
    -------
    Scene
        In the place of the first of the bodies that are one, under its name, is the united one; labels, pens and cuts
        of the others are for that.

    Raises
    ------
    InputError
        See `geometry.polyhedron_union`.
    TypeError
        For what is no scene.

    Notes
    -----
    Bodies look alike that have the same colour, material, lines, group and hatching. Those whose boxes touch are united
    together, also where they do not touch themselves.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> cube = vp.Item("a", geometry.box((1, 1, 1)))
    >>> beside, away = (vp.Item(name, cube.shape.moved(x, 0, 0)) for name, x in (("b", 1), ("c", 5)))
    >>> scene = vp.united(vp.Scene((cube, beside, away)))
    >>> [item.name for item in scene.items], scene.items[0].shape.bounds[1].tolist()
    (['a', 'c'], [2.0, 1.0, 1.0])
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"united takes a Scene, such as vectorplot.io.scene_of(parts), not {type(scene).__name__}")
    looks: dict[Hashable, int] = {}
    bodies = [n for n, item in enumerate(scene.items) if _is_plain(item)]
    if len(bodies) < 2:
        return scene
    look = np.array([looks.setdefault(_look(scene.items[n]), len(looks)) for n in bodies])
    boxes = np.array([scene.items[n].mesh.bounds for n in bodies])
    zero = zero_distance(boxes.reshape(-1, 3))
    one, other = overlapping_pairs(boxes[:, 0].T - zero, boxes[:, 1].T + zero)
    alike = look[one] == look[other]
    label = chained(len(bodies), one[alike], other[alike])
    order = np.argsort(label, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(label[order])) + 1)
    items: dict[int, Item] = dict(enumerate(scene.items))
    names: dict[str, str] = {}
    for group in groups:
        if len(group) < 2:
            continue
        numbers = [bodies[k] for k in group.tolist()]
        parts = [scene.items[n] for n in numbers]
        items[numbers[0]] = union_item(parts, parts[0].name)
        names |= {part.name: parts[0].name for part in parts}
        for number in numbers[1:]:
            del items[number]
    known = {item.name: item for item in reversed(scene.items)}
    return replace(
        scene,
        items=tuple(items[n] for n in sorted(items)),
        labels=tuple(_relabelled(label, known, names) for label in scene.labels),
        cuts=tuple(
            cut if cut.items is None else replace(cut, items=tuple(dict.fromkeys(names.get(n, n) for n in cut.items)))
            for cut in scene.cuts
        ),
        inks=None if scene.inks is None else scene.inks.renamed(names),
    )


def union_item(items: Sequence[Item], name: str) -> Item:
    """The body that items are together, under a name, with the look of the first of them.

    Errors: InputError for what is no closed polyhedron, and for patterns and looks of single faces; see
    polyhedron_union."""
    for item in items:
        if not isinstance(item.shape, Mesh):
            what = "curve" if is_curve(item.shape) else "surface"
            raise InputError(f"{item.name} is a {what}: only solids are united")
        if item.patterns or item.face_looks is not None:
            raise InputError(f"{item.name} has patterns or looks of single faces: they do not go with a union")
        if not item.mesh.is_closed or item.mesh.present is not None:
            raise InputError(f"{item.name} is not closed: only solids are united")
    body = polyhedron_union([item.mesh for item in items])
    plain: dict[str, Any] = {"fields": None, "normals": None, "added_edges": None, "cut_by": ()}
    return replace(items[0], name=name, shape=body, drawn_edges=_edges_between_planes(body), **plain)


def _is_plain(item: Item) -> bool:
    """Whether an item is a solid with nothing that a union has not."""
    mesh = item.mesh
    if not mesh.face_count or mesh.present is not None or item.patterns or item.curves or item.cut_by:
        return False
    listed = item.face_looks, item.fields, item.drawn_edges, item.added_edges
    return all(one is None for one in listed) and mesh.is_closed


def _look(item: Item) -> Hashable:
    """What bodies have in common that look alike."""
    own = item.lines, item.default_lines, item.occludes, item.group, item.hatch
    return item.colour, item.material, *own


def _edges_between_planes(mesh: Mesh) -> Floats | None:
    """(e,2,3) the ends of the edges at which faces turn; none, for all, where some are sides of facets, as of bores:
    edges that are listed are creases."""
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first]
    next_one = uses.corner[np.minimum(uses.first + 1, max(len(uses.corner) - 1, 0))]
    normals = mesh.face_normals
    one, two = normals[mesh.corner_face[corner]], normals[mesh.corner_face[next_one]]
    turns = (uses.count != 2) | (norm(cross(one, two)) > SAME_PLANE_SINE)
    if (turns & (dot(one, two) > math.cos(math.radians(USUAL_CREASE_DEG)))).any():
        return None
    ends = np.stack([mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]], axis=1)
    return np.asarray(mesh.vertices[ends[turns]])


def _relabelled(label: Label, items: Mapping[str, Item], names: Mapping[str, str]) -> Label:
    """A label where items have become one: at the place of the vertex that it names."""
    at = label.at
    if not isinstance(at, AtVertex) or at.item not in names:
        return renamed(label, names)
    vertices = items[at.item].mesh.vertices
    if not 0 <= at.vertex < len(vertices):
        return label
    x, y, z = vertices[at.vertex].tolist()
    return replace(label, at=(x, y, z))
