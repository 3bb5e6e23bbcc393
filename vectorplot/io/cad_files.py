"""Files and objects of CAD systems (STEP, IGES, BREP; build123d, CadQuery) -> scenes: OpenCASCADE reads them and makes
fine triangles of their faces; which edges are sharp, tangent or seams, the normals on both sides tell."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from enum import IntEnum
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, InputWarning, not_installed
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import may_stop
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm, summed_by
from vectorplot.geometry.weld import distinct_points
from vectorplot.io.cad_faces import TANGENT_COSINE, NotMapped, body_faces, mean_curvatures
from vectorplot.io.material_library import looks_of_colours
from vectorplot.io.mesh_file import shown
from vectorplot.io.opencascade import Numbers, explored, occ
from vectorplot.io.read_mesh import with_looks
from vectorplot.scene.extent import check_range
from vectorplot.scene.face_looks import FaceLooks
from vectorplot.scene.item import Item, SurfaceNormals
from vectorplot.scene.material import Material
from vectorplot.scene.page import SheetSettings
from vectorplot.scene.scene import Scene, together
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.surfaces.brep import Brep
from vectorplot.tolerances import (
    LEAST_DIVISOR,
    LEAST_PART_TOLERANCE,
    NO_CAD_NORMAL,
    SAME_REACH_OF_EXTENT,
    SEWN_OF_EXTENT,
    USUAL_PART_TOLERANCE,
)
from vectorplot.words import DRAWN, LineKind, unknown

INSIDE_FACES = 4.0
"""Triangles may be so many times as far off their faces: contours lie on cubics, not on these."""

WIDEST_TURN = 0.2
"""Neighbouring triangles of one face turn by no more than about this angle, in radians: 32 sides make a circle."""

BENT_ALIKE = 0.01
"""Mean curvatures that differ by no more than this part of the larger one, or of that of a ball as large as the body,
are those of one shape: nobody sees a line there."""

MOST_TRIANGLES = 10_000_000
"""A scene with more triangles is refused."""

MOST_DEPTH = 100
"""Assemblies in assemblies are followed so deep."""

CAD_LINES = tuple(word for word in DRAWN if word != LineKind.INTERSECTION.word)
"""What is drawn of parts where nothing is said: where parts touch, as a pin in its bore, their triangles pierce."""


# Bodies, and what is drawn of them.


class EdgeKind(IntEnum):
    """What an edge of a part is."""

    SHARP = 0
    """Its faces meet at an angle; or it has one face only, or more than two."""
    TANGENT = 1
    """Two faces meet without a crease, but bend otherwise on both sides."""
    SEAM = 2
    """A face goes on in itself or in another one, as halves of a cylinder do: nothing shows there."""


@dataclass(frozen=True, eq=False)
class CadBody:
    """A body as a CAD system tells it, each face with points of its own.

    points (n,3); normals (n,3): of the surfaces there, outwards, zero where there is none; bending (n,): their mean
    curvatures, positive where they bend towards the normal, NaN where there is none; triangles (t,3): of points,
    counter-clockwise from outside; face (t,): of which face each is a part; flat (f,): the faces in planes; shares
    (f,4): red, green, blue and opacity of each face, NaN where it has none of its own. Uses of edges by faces: nodes
    (k,): the points along each, offsets (u+1,), edge (u,): the number of the edge, and user (u,): the face; two uses of
    an edge list their points in the same direction.
    """

    points: Floats
    normals: Floats
    bending: Floats
    triangles: Ints
    face: Ints
    flat: Bools
    shares: Floats
    nodes: Ints
    offsets: Ints
    edge: Ints
    user: Ints


def edge_kinds(body: CadBody) -> Ints:
    """(e,) the kind of each edge, see EdgeKind."""
    count = int(body.edge.max(initial=-1)) + 1
    kinds = np.full(count, int(EdgeKind.SHARP))
    edge, one, two = _pairs_of_uses(body, np.bincount(body.edge, minlength=count) == 2)
    if not len(edge):
        return kinds
    size = np.diff(body.offsets)[one]
    along = [body.nodes[ragged.ranges(body.offsets[use], size)] for use in (one, two)]
    first, second = (body.normals[points] for points in along)
    place, owner = ragged.place(size), ragged.owner(size)
    # At the ends of an edge other faces may make corners.
    known = first.any(axis=1) & second.any(axis=1)
    inner = (place > 0) & (place < size[owner] - 1) | (size[owner] == 2)
    cosine = np.where(known & inner, dot(first, second), 1.0)
    smooth = np.minimum.reduceat(cosine, ragged.starts(size)) >= TANGENT_COSINE
    smooth &= np.logical_or.reduceat(known & inner, ragged.starts(size))
    bent, bent_too = (body.bending[points] for points in along)
    # With one tangent plane along all of an edge, surfaces bend alike there where their mean curvatures are alike.
    straight = 1.0 / max(float(norm(np.ptp(body.points, axis=0))), LEAST_DIVISOR)
    most = np.maximum(np.maximum(np.abs(bent), np.abs(bent_too)), straight)
    off = known & inner & (np.abs(bent - bent_too) > BENT_ALIKE * most)
    alike = (body.user[one] == body.user[two]) | ~np.logical_or.reduceat(off, ragged.starts(size))
    kinds[edge] = np.where(smooth, np.where(alike, int(EdgeKind.SEAM), int(EdgeKind.TANGENT)), int(EdgeKind.SHARP))
    return kinds


def _pairs_of_uses(body: CadBody, among: Bools) -> tuple[Ints, Ints, Ints]:
    """The edges (p,) among some (e,) with the first use and another use of each, of as many points; an edge with more
    uses comes with every other one."""
    order = np.argsort(body.edge, kind="stable")
    order = order[among[body.edge[order]]]
    edge = body.edge[order]
    begin = np.searchsorted(edge, edge)
    first, later = order[begin], np.flatnonzero(np.arange(len(edge)) > begin)
    one, two = first[later], order[later]
    size = np.diff(body.offsets)
    alike = size[one] == size[two]
    return edge[later][alike], one[alike], two[alike]


def body_item(name: str, body: CadBody) -> Item:
    """The item of a body: a mesh without gaps along its edges, of which the sharp and the tangent edges are drawn, and
    contours where the normals of its surfaces say.

    Errors: InputError for a body without a face that has an area.
    """
    kinds = edge_kinds(body)
    vertex = _united(body, np.ones(len(kinds), dtype=np.bool_), distinct_points(body.points)[1])
    place = np.unique(vertex, return_index=True)[1]
    corners = vertex[body.triangles]
    kept = np.flatnonzero(_all_differ(corners))
    if not len(kept):
        raise InputError(f"{name}: no face with an area")
    positions = body.points[place]
    mesh = Mesh.from_triangles(positions, corners[kept])
    ends = [positions[vertex[own]] for own in (_segments(body, kinds == kind) for kind in EdgeKind)]
    item = Item(name, mesh, default_lines=CAD_LINES, drawn_edges=ends[EdgeKind.SHARP])
    item = _with_one_colour(with_looks(item, looks_of_colours(mesh, body.shares[body.face[kept]])))
    if body.flat.all():
        return item
    normals = _true_normals(body, kinds, vertex, positions, kept)
    return replace(
        item, tangent_edges=ends[EdgeKind.TANGENT], normals=normals, curves=SurfaceLines(smooth_contours=True)
    )


def _with_one_colour(item: Item) -> Item:
    """An item all of whose faces have looks of their own in the look of most of them, which the others have not."""
    looks = item.face_looks
    if looks is None or (looks.of_face < 0).any():
        return item
    most = int(np.bincount(looks.of_face).argmax())
    rest, own = np.where(looks.of_face == most, -1, looks.of_face), looks.looks[most]
    material = item.material if own.material is None else own.material
    # Opaque faces of a clear body say so.
    kept = tuple(replace(one, material=one.material or Material()) for one in looks.looks)
    return replace(
        item, colour=own.colour or item.colour, material=material, face_looks=FaceLooks(looks.mesh, kept, rest)
    )


def _united(body: CadBody, edges: Bools, same: Ints) -> Ints:
    """(n,) numbers of points that all points have in common which lie on each other along some edges (e,), or have a
    number (n,) in common."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    _, one, two = _pairs_of_uses(body, edges)
    size = np.diff(body.offsets)[one]
    a, b = (body.nodes[ragged.ranges(body.offsets[use], size)] for use in (one, two))
    count, numbers = len(body.points), np.arange(len(body.points))
    a, b = np.concatenate([a, numbers]), np.concatenate([b, count + same])
    whole = count + int(same.max(initial=-1)) + 1
    links = coo_array((np.ones(len(a), dtype=np.bool_), (a, b)), shape=(whole, whole))
    number = connected_components(links, directed=False)[1][:count]
    return np.asarray(np.unique(number, return_inverse=True)[1].ravel(), dtype=np.intp)


def _all_differ(corners: Ints) -> Bools:
    a, b, c = corners.T
    return np.asarray((a != b) & (b != c) & (c != a))


def _segments(body: CadBody, edges: Bools) -> Ints:
    """(s,2) the points at both ends of each segment of some edges (e,), by the first use of each."""
    used, first = np.unique(body.edge, return_index=True)
    use = first[edges[used]]
    size = np.diff(body.offsets)[use]
    along, begin = ragged.ranges(body.offsets[use], size), ragged.place(size)
    start = np.flatnonzero(begin < np.repeat(size, size) - 1)
    return np.stack([body.nodes[along[start]], body.nodes[along[start + 1]]], axis=1)


def _true_normals(body: CadBody, kinds: Ints, vertex: Ints, positions: Floats, kept: Ints) -> SurfaceNormals:
    """The normals at the vertices of the mesh of triangles kept (t,), taken apart along sharp edges."""
    number = _united(body, kinds != EdgeKind.SHARP, np.arange(len(body.points)))
    first = np.unique(number, return_index=True)[1]
    corners, whole = number[body.triangles[kept]], vertex[first]
    normals = summed_by(number, body.normals, len(first))
    none = ~normals.any(axis=1)
    if none.any():
        # At the pole of a ball the triangles around it tell; at the tip of a cone there is none.
        areas = Mesh.from_triangles(positions[whole], corners).area_vectors
        around, size = summed_by(corners.ravel(), np.repeat(areas, 3, axis=0), len(first)), norm(areas)
        evenly = norm(around) >= np.cos(WIDEST_TURN) * np.bincount(corners.ravel(), np.repeat(size, 3), len(first))
        normals[none & evenly] = around[none & evenly]
    normals /= np.maximum(norm(normals), LEAST_DIVISOR)[:, None]
    several = np.bincount(whole, minlength=len(positions)) > 1
    return SurfaceNormals(Mesh.from_triangles(positions[whole], corners), normals, several[whole])


# What OpenCASCADE reads. Its binding differs from version to version: 7.9 and 8.0 are known.

BINDING = "OpenCASCADE (cadquery-ocp-novtk)"
"""What files of CAD systems are read by."""

_SHAPE_SUFFIXES = (".brep",)
_IGES_SUFFIXES = (".iges", ".igs")
_BREP_BEGINS, _BEGINNING = (b"DBRep_DrawableShape", b"CASCADE Topology"), 256
_NO_NAMES = ("=>[", "Open CASCADE STEP translator")
_KINDS_ALONE = ("COMPOUND", "COMPSOLID", "SOLID", "SHELL", "FACE", "ASSEMBLY")


PARTS = ("triangles", "exact")
"""How bodies of parts are drawn: from fine triangles, or from the surfaces of their faces."""


def cad_scene(path: Path, tolerance: float = USUAL_PART_TOLERANCE, parts: str = PARTS[0]) -> Scene:
    """The bodies in a STEP, IGES or BREP file, in millimetres, each an item with the names and colours of the file;
    those of one part, or of one assembly in the whole, are a group. tolerance: how far chords of edges may be off, as
    part of the diagonal of all that is read; no less than LEAST_PART_TOLERANCE counts. parts: one of PARTS.

    Errors: InputError where OpenCASCADE is not installed, for a file that it cannot read or that holds no faces, and
    for a tolerance that is not positive. Warns InputWarning: which bodies are drawn from triangles although others are
    not, and why.
    """
    if not 0.0 < tolerance < np.inf:
        raise InputError(f"a tolerance of {tolerance:g}: expected a positive part of the extent")
    name = shown(path)
    try:
        occ("TopoDS")
    except ImportError:
        raise not_installed(f"{name}: a file of a CAD system", BINDING, "step") from None
    suffix = path.suffix.lower()
    try:
        with _quietly(), _errors_told("read"):
            if suffix in _SHAPE_SUFFIXES:
                found = [_Part(_read_shape(path), _nowhere(), path.stem)]
            else:
                found = _read_document(path, suffix in _IGES_SUFFIXES)
            return _scene(found, max(tolerance, LEAST_PART_TOLERANCE), parts)
    except InputError as error:
        raise (error if error.file else InputError(error.cause, file=name)) from None


@contextmanager
def _errors_told(what: str) -> Iterator[None]:
    """Errors of OpenCASCADE, all of which are of classes of its own, as InputError; what: what it cannot do then."""
    try:
        yield
    except MemoryError:
        raise InputError("too large for the memory") from None
    except Exception as error:
        if not type(error).__module__.startswith("OCP"):
            raise
        raise InputError(f"OpenCASCADE cannot {what} it: {type(error).__name__} {error}") from None


@contextmanager
def _quietly() -> Iterator[None]:
    """Nothing of what OpenCASCADE says about its work goes to standard output, where a picture may go."""
    messenger = occ("Message").Message.DefaultMessenger_s()
    printers = _listed(messenger.Printers())
    for printer in printers:
        messenger.RemovePrinter(printer)
    try:
        yield
    finally:
        for printer in printers:
            messenger.AddPrinter(printer)


def _listed(sequence: Any) -> list[Any]:
    return [sequence.Value(number) for number in range(1, sequence.Length() + 1)]


_Look = tuple[str, Floats | None]
"""A name, which may be empty, and red, green, blue and opacity (4,), if they are known."""


@dataclass(frozen=True, eq=False)
class _Part:
    """A shape as it stands alone, where it stands, its name and colour (4,), the assembly in the whole that it belongs
    to, the names and colours of faces and solids in it, and what it is made of."""

    shape: Any
    location: Any
    name: str
    colour: Floats | None = None
    group: str = ""
    within: Callable[[Any], _Look] = lambda _: ("", None)
    made_of: str = ""


def _read_shape(path: Path) -> Any:
    """The shape in a BREP file."""
    with path.open("rb") as file:
        if not file.read(_BEGINNING).lstrip().startswith(_BREP_BEGINS):
            raise InputError("not a BREP file: it does not begin as one")
    shape = occ("TopoDS").TopoDS_Shape()
    if not occ("BRepTools").BRepTools.Read_s(shape, str(path), occ("BRep").BRep_Builder()) or shape.IsNull():
        raise InputError("not a BREP file that OpenCASCADE can read")
    return shape


def _read_document(path: Path, iges: bool) -> list[_Part]:
    """The parts in a STEP or IGES file."""
    document = occ("TDocStd").TDocStd_Document(occ("TCollection").TCollection_ExtendedString("vectorplot"))
    if iges:
        reader = occ("IGESCAFControl").IGESCAFControl_Reader()
    else:
        reader = occ("STEPCAFControl").STEPCAFControl_Reader()
    kind = "an IGES" if iges else "a STEP"
    if reader.ReadFile(str(path)) != occ("IFSelect").IFSelect_ReturnStatus.IFSelect_RetDone:
        raise InputError(f"not {kind} file that OpenCASCADE can read: it is damaged, or something else")
    if not reader.Transfer(document):
        raise InputError("it holds no shapes that OpenCASCADE can make")
    if iges and not _ends_as_iges(path):
        warnings.warn(f"{shown(path)}: it ends amid its data: faces may be missing", InputWarning, stacklevel=2)
    return _parts_of_document(document, path.stem)


def _ends_as_iges(path: Path) -> bool:
    """Whether the last line of a file is that of the last section of IGES files, with a T in its column 73."""
    with path.open("rb") as file:
        file.seek(max(path.stat().st_size - _BEGINNING, 0))
        lines = [line for line in file.read().splitlines() if line.strip()]
    return bool(lines) and lines[-1][72:73] == b"T"


def _labels(fill: Callable[[Any], object]) -> list[Any]:
    """The labels that a function fills a sequence with."""
    try:
        labels = occ("TDF").TDF_LabelSequence()
    except AttributeError:
        labels = occ("collections").Sequence_TDF_Label()
    fill(labels)
    return _listed(labels)


def _parts_of_document(document: Any, stem: str) -> list[_Part]:
    """The parts of a document in the order of its assemblies, each time that they are used."""
    xcaf = occ("XCAFDoc")
    tools, shapes = xcaf.XCAFDoc_DocumentTool, xcaf.XCAFDoc_ShapeTool
    tool, colours = tools.ShapeTool_s(document.Main()), tools.ColorTool_s(document.Main())
    found, taken = list[_Part](), Counter[str]()
    waiting: list[tuple[Any, Any, Floats | None, int, str]] = []
    waiting += [(label, _nowhere(), None, 0, "") for label in reversed(_labels(tool.GetFreeShapes))]
    while waiting:
        label, location, colour, depth, group = waiting.pop()
        if depth > MOST_DEPTH:
            raise InputError(f"assemblies are more than {MOST_DEPTH} deep")
        own, product = _colour_of(colours, label), label
        if shapes.IsReference_s(label):
            location = location.Multiplied(shapes.GetLocation_s(label))
            product = occ("TDF").TDF_Label()
            shapes.GetReferredShape_s(label, product)
        colour = next((one for one in (own, _colour_of(colours, product), colour) if one is not None), None)
        name = _name_of(product) or _name_of(label) or stem
        if shapes.IsAssembly_s(product):
            # What moves as one is an assembly in the whole, with all that is in it.
            group = group or (_told_apart(name, taken) if depth else "")
            inside = _labels(partial(shapes.GetComponents_s, product))
            waiting += [(one, location, colour, depth + 1, group) for one in reversed(inside)]
            continue
        within = _looks_within(colours, product)
        found.append(_Part(shapes.GetShape_s(product), location, name, colour, group, within, _material_of(product)))
    return found


def _nowhere() -> Any:
    """The location of what stays where it is."""
    return occ("TopLoc").TopLoc_Location()


def _told_apart(name: str, taken: Counter[str]) -> str:
    """A name, with a number behind it where it was taken before."""
    taken[name] += 1
    return name if taken[name] == 1 else f"{name} {taken[name]}"


def _name_of(label: Any) -> str:
    """What a label is called; nothing for names that only number it."""
    names = occ("TDataStd").TDataStd_Name
    # The binding does not survive asking for an attribute that is not there.
    if not label.IsAttribute(names.GetID_s()):
        return ""
    attribute = names()
    label.FindAttribute(names.GetID_s(), attribute)
    name = str(attribute.Get().ToExtString()).strip()
    return "" if name.startswith(_NO_NAMES) or name in _KINDS_ALONE else name


def _material_of(label: Any) -> str:
    """The name of the material of a label; nothing where it has none."""
    xcaf, nodes = occ("XCAFDoc"), occ("TDataStd").TDataStd_TreeNode
    material, guid = xcaf.XCAFDoc_Material, xcaf.XCAFDoc.MaterialRefGUID_s()
    if not label.IsAttribute(guid):
        return ""
    node, found = nodes(), material()
    label.FindAttribute(guid, node)
    if not node.HasFather() or not node.Father().Label().IsAttribute(material.GetID_s()):
        return ""
    node.Father().Label().FindAttribute(material.GetID_s(), found)
    return "" if found.GetName() is None else str(found.GetName().ToCString()).strip()


def _looks_within(colours: Any, label: Any) -> Callable[[Any], _Look]:
    """What solids and faces of a part are called, and their colours."""
    shapes = occ("XCAFDoc").XCAFDoc_ShapeTool
    inside, numbers = _labels(partial(shapes.GetSubShapes_s, label)), Numbers()
    looks = {numbers.of(shapes.GetShape_s(one)): (_name_of(one), _colour_of(colours, one)) for one in inside}
    return lambda shape: looks.get(numbers.of(shape), ("", None)) if looks else ("", None)


def _colour_of(colours: Any, label: Any) -> Floats | None:
    """(4,) red, green, blue and opacity of a label; None where it has none."""
    kinds, rgba = occ("XCAFDoc").XCAFDoc_ColorType, occ("Quantity").Quantity_ColorRGBA()
    for kind in (kinds.XCAFDoc_ColorSurf, kinds.XCAFDoc_ColorGen):
        if colours.GetColor_s(label, kind, rgba):
            return _shares(rgba)
    return None


def _shares(rgba: Any) -> Floats:
    srgb = rgba.GetRGB().Values(occ("Quantity").Quantity_TypeOfColor.Quantity_TOC_sRGB)
    return np.array([*srgb, rgba.Alpha()])


# Objects of libraries that OpenCASCADE is below of: build123d, CadQuery.


def cad_object_scene(shown: Any, parts: str = PARTS[0]) -> Scene | None:
    """The scene of a shape of OpenCASCADE, or of an object of build123d or CadQuery, known by what it has: a shape that
    is wrapped, the values of a workplane, the shapes of an assembly, the part of a builder. None for anything else; the
    object stays as it was.

    parts: one of PARTS.

    Errors: InputError for one without faces, and for one that OpenCASCADE cannot divide into triangles.
    """
    name = type(shown).__name__
    found = _parts_of_object(shown, name.lower())
    if not found:
        return None
    try:
        with _quietly(), _errors_told("divide"):
            return _scene(found, USUAL_PART_TOLERANCE, parts)
    except InputError as error:
        raise InputError(f"{name}: {error.cause}") from None


def _parts_of_object(shown: Any, name: str) -> list[_Part]:
    shape, taken, found = _wrapped(shown), Counter[str](), list[_Part]()
    if callable(getattr(shown, "vals", None)):
        return [part for value in shown.vals() for part in _parts_of_object(value, name)]
    if callable(getattr(shown, "toCompound", None)) and hasattr(shown, "children"):
        groups = dict[str, str]()
        for inner, path, location, colour in shown:
            # Of an assembly a/b/c, which need have no b, b is what moves as one.
            _, *inside, own = ["", *path.split("/")] if "/" not in path else path.split("/")
            key = inside[0] if inside else ""
            if key not in groups:
                groups[key] = _told_apart(key, taken) if key else ""
            shares = None if colour is None else _shares(colour.wrapped)
            found.append(_Part(_copied(inner.wrapped), location.wrapped, own, shares, groups[key]))
        return found
    if shape is None:
        inner = next((one for word in ("part", "sketch") if (one := getattr(shown, word, None)) is not None), None)
        return [] if inner is None or _wrapped(inner) is None else _parts_of_object(inner, name)
    waiting: list[tuple[Any, Any, Floats | None, int, str]] = [(shown, _nowhere(), None, 0, "")]
    while waiting:
        one, location, colour, depth, group = waiting.pop()
        own = getattr(getattr(one, "color", None), "wrapped", None)
        colour = colour if own is None else _shares(own)
        label, children = getattr(one, "label", "") or name, getattr(one, "children", ())
        if not children:
            found.append(_Part(_copied(_wrapped(one)), location, str(label), colour, group))
            continue
        group = group or (_told_apart(str(label), taken) if depth else "")
        location = location.Multiplied(_wrapped(one).Location())
        waiting += [(child, location, colour, depth + 1, group) for child in reversed(children)]
    return found


def _wrapped(shown: Any) -> Any:
    """The shape of OpenCASCADE that something is or wraps; None for what is none."""
    kind = occ("TopoDS").TopoDS_Shape
    return next((one for one in (shown, getattr(shown, "wrapped", None)) if isinstance(one, kind)), None)


def _copied(shape: Any) -> Any:
    """A shape that can be divided into triangles without a change of the given one."""
    return occ("BRepBuilderAPI").BRepBuilderAPI_Copy(shape, False, False).Shape()


# Parts -> bodies -> items.


def _scene(parts: Sequence[_Part], tolerance: float, drawn: str) -> Scene:
    """The items of parts, those that are used several times triangulated once; drawn: one of PARTS."""
    if drawn not in PARTS:
        raise unknown("way of drawing parts", drawn, PARTS)
    unmapped = dict[str, str]()
    shapes, boxes, made = Numbers(), dict[int, Floats](), dict[tuple[int, bytes], list[tuple[Item, Any]]]()
    numbers = [shapes.of(part.shape) for part in parts]
    for number, part in zip(numbers, parts, strict=True):
        boxes.setdefault(number, _corners(part.shape))
    matrices = [_matrix(part.location) for part in parts]
    around = [_moved(boxes[number], matrix) for number, matrix in zip(numbers, matrices, strict=True)]
    every = np.concatenate([np.zeros((0, 3)), *around])
    if not len(every):
        raise InputError("it holds no faces")
    check_range(np.array([every.min(axis=0), every.max(axis=0)]))
    extent = float(norm(np.ptp(every, axis=0)))
    items, triangles, taken = list[Item](), 0, Counter(part.group for part in parts)
    for number, part, matrix in zip(numbers, parts, matrices, strict=True):
        may_stop()
        key = number, b"" if part.colour is None else part.colour.tobytes()
        if key not in made:
            made[key] = _items_of_part(part, tolerance * extent, extent, unmapped if drawn == "exact" else None)
        several = len(made[key]) > 1 and not part.group
        group = _told_apart(part.name, taken) if several else part.group
        for item, shape in made[key]:
            own = replace(item, group=group)
            own = own if (matrix == np.eye(4)).all() else own.transformed(matrix)
            items.append(_with_reach(own, shape.Moved(part.location), tolerance * extent))
            triangles += item.mesh.face_count
        if triangles > MOST_TRIANGLES:
            raise InputError(f"its parts take more than {MOST_TRIANGLES} triangles: allow a coarser tolerance")
    if not items:
        raise InputError("it holds no faces")
    if unmapped:
        told = "; ".join(f"{name}: {why}" for name, why in unmapped.items())
        warnings.warn(f"drawn from triangles, not exactly: {told}", InputWarning, stacklevel=4)
    scene = together([Scene((item,)) for item in items])
    made_of = _materials(parts)
    return replace(scene, sheet=SheetSettings(made_of=made_of)) if made_of else scene


def _materials(parts: Sequence[_Part]) -> tuple[tuple[str, str], ...]:
    """Names of parts, or of the assemblies that they belong to, and what these are made of, where all of it is one
    material."""
    found = dict[str, set[str]]()
    for part in parts:
        found.setdefault(part.group or part.name, set()).add(part.made_of)
    return tuple((name, next(iter(said))) for name, said in found.items() if len(said) == 1 and "" not in said)


def _corners(shape: Any) -> Floats:
    """(8,3) the corners of the box around the faces of a shape; (0,3) where it has none."""
    if not any(True for _ in explored(shape, "FACE")):
        return np.zeros((0, 3))
    box = occ("Bnd").Bnd_Box()
    occ("BRepBndLib").BRepBndLib.Add_s(shape, box, False)
    low, high = (np.array(corner.Coord()) for corner in (box.CornerMin(), box.CornerMax()))
    return np.where(np.array(list(np.ndindex(2, 2, 2))) == 1, high, low)


def _matrix(location: Any) -> Floats:
    """(4,4) the matrix of a location."""
    moved, matrix = location.Transformation(), np.eye(4)
    matrix[:3] = [[moved.Value(row, column) for column in range(1, 5)] for row in range(1, 4)]
    return matrix


def _moved(points: Floats, matrix: Floats) -> Floats:
    return matmul(points, matrix[:3, :3].T) + matrix[:3, 3]


def _with_reach(item: Item, shape: Any, distance: float) -> Item:
    """The item with how far its shape reaches, which its triangles may fall short of; distance: how far chords of edges
    may be off."""
    if item.normals is None or item.normals.bounds is not None:
        return item
    box, reached = occ("Bnd").Bnd_Box(), item.mesh.bounds
    occ("BRepBndLib").BRepBndLib.AddOptimal_s(shape, box, False, False)
    found = np.array([corner.Coord() for corner in (box.CornerMin(), box.CornerMax())])
    # No surface is farther off its triangles: what OpenCASCADE tells then is the box of more than the face.
    off, same = np.abs(found - reached), SAME_REACH_OF_EXTENT * float(norm(np.ptp(reached, axis=0)))
    found = np.where((off > same) & (off <= 2.0 * INSIDE_FACES * distance), found, reached)
    return replace(item, normals=replace(item.normals, bounds=found))


def _items_of_part(
    part: _Part, distance: float, extent: float, unmapped: dict[str, str] | None
) -> list[tuple[Item, Any]]:
    """The items of a part where it stands alone, each with its shape; distance: how far chords of edges may be off;
    extent: of all that is read; unmapped: takes which of them have no surfaces, by name, and why; None where none are
    asked for."""
    solids = list(explored(part.shape, "SOLID"))
    free = list(explored(part.shape, "FACE", outside="SOLID"))
    sewn, open_ = _sewn(free, SEWN_OF_EXTENT * extent) if free else ([], [])
    items = list[tuple[Item, Any]]()
    for shape, closes in [*((one, True) for one in (*solids, *sewn)), *((one, False) for one in open_)]:
        called, own = part.within(shape)
        name, colour = called or part.name, part.colour if own is None else own
        ways = occ("IMeshTools").IMeshTools_MeshAlgoType
        found = list[tuple[int, bool, list[Item]]]()
        # The first way takes a tenth of the time on plates with hundreds of bores, and fails on some faces.
        for way in (ways.IMeshTools_MeshAlgoType_Delabella, ways.IMeshTools_MeshAlgoType_Watson):
            may_stop()
            _divide(shape, distance, way)
            body, left = _body(shape, colour, part.within)
            made = [body_item(name, body)] if len(body.triangles) else []
            gaps = closes and not all(item.mesh.is_closed for item in made)
            found.append((left, gaps, made))
            if not left and not gaps:
                break
        # Of two ways that fail the one that leaves out less.
        left, _, made = min(found, key=lambda one: one[:2])
        if left:
            text = f"{name}: {left} faces could not be divided into triangles: they are left out"
            warnings.warn(text, InputWarning, stacklevel=2)
        made = made if unmapped is None else [_with_surfaces(item, shape, unmapped) for item in made]
        items += [(_with_reach(item, shape, distance), shape) for item in made]
    return items


def _with_surfaces(item: Item, shape: Any, unmapped: dict[str, str]) -> Item:
    """The item with the surfaces of the faces of its shape; else unmapped is told why it has none."""
    try:
        with _errors_told("tell the surfaces of"):
            found = body_faces(shape)
    except (NotMapped, InputError) as error:
        unmapped[item.name] = str(error)
        return item
    edges, none = found.edges, np.zeros((0, 3), dtype=np.intp)
    body = CadBody(
        edges.points,
        found.normals,
        found.bending,
        none,
        none[:, 0],
        np.array([face.flat for face in found.faces]),
        np.zeros((len(found.faces), 4)),
        np.arange(len(edges.points)),
        edges.offsets,
        edges.edge,
        edges.face,
    )
    return replace(item, exact=Brep(found.faces, replace(edges, kind=edge_kinds(body)), item.mesh))


def _divide(shape: Any, distance: float, way: Any) -> None:
    """Divides the faces of a shape into triangles in one of the ways that OpenCASCADE has."""
    occ("BRepTools").BRepTools.Clean_s(shape)
    fineness = occ("IMeshTools").IMeshTools_Parameters()
    fineness.Deflection, fineness.DeflectionInterior = distance, INSIDE_FACES * distance
    fineness.Angle = fineness.AngleInterior = WIDEST_TURN
    fineness.MeshAlgo = way
    occ("BRepMesh").BRepMesh_IncrementalMesh(shape, fineness)


def _sewn(faces: Sequence[Any], near: float) -> tuple[list[Any], list[Any]]:
    """Solids, and open shapes, that faces of no solid make, which are joined along edges that are near each other."""
    sewing = occ("BRepBuilderAPI").BRepBuilderAPI_Sewing(near)
    for face in faces:
        sewing.Add(face)
    sewing.Perform()
    whole = sewing.SewedShape()
    shells = list(explored(whole, "SHELL"))
    closed = [shell for shell in shells if occ("BRep").BRep_Tool.IsClosed_s(shell)]
    made = [occ("ShapeFix").ShapeFix_Solid().SolidFromShell(shell) for shell in closed]
    rest = [shell for shell in shells if shell not in closed]
    alone = list(explored(whole, "FACE", outside="SHELL"))
    if alone:
        builder, compound = occ("BRep").BRep_Builder(), occ("TopoDS").TopoDS_Compound()
        builder.MakeCompound(compound)
        for face in alone:
            builder.Add(compound, face)
        rest.append(compound)
    return made, rest


def _body(shape: Any, colour: Floats | None, within: Callable[[Any], _Look]) -> tuple[CadBody, int]:
    """What the triangulated faces of a shape are, and how many of them have no triangles. colour: of faces that have
    none of their own."""
    edges, missing, start = Numbers(), 0, 0
    points, normals, triangles = [np.zeros((0, 3))], [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.intp)]
    bending, flat, shares, counts = [np.zeros(0)], list[bool](), list[Floats](), list[int]()
    nodes, sizes, edge, user = [np.zeros(0, dtype=np.intp)], list[int](), list[int](), list[int]()
    tool = occ("BRep").BRep_Tool
    for face in explored(shape, "FACE"):
        may_stop()
        location = occ("TopLoc").TopLoc_Location()
        triangulation = tool.Triangulation_s(face, location)
        if triangulation is None or not triangulation.NbTriangles():
            missing += 1
            continue
        number, turned = len(flat), face.Orientation() == occ("TopAbs").TopAbs_Orientation.TopAbs_REVERSED
        matrix = _matrix(location)
        own = _moved(np.array([node.Coord() for node in triangulation.MapNodeArray()]), matrix)
        corners = np.array([one.Get() for one in triangulation.MapTriangleArray()], dtype=np.intp) - 1
        is_flat, up, bent = _surface(face, triangulation)
        points.append(own)
        normals.append(-up if turned else up)
        bending.append(-bent if turned else bent)
        triangles.append(start + (corners[:, ::-1] if turned else corners))
        counts.append(len(corners))
        flat.append(is_flat)
        given = within(face)[1]
        given = colour if given is None else given
        shares.append(np.full(4, np.nan) if given is None else given)
        for one in explored(face, "EDGE"):
            along = None if tool.Degenerated_s(one) else tool.PolygonOnTriangulation_s(one, triangulation, location)
            if along is not None:
                nodes.append(start - 1 + np.array(list(along.Nodes()), dtype=np.intp))
                sizes.append(len(nodes[-1]))
                edge.append(edges.of(one))
                user.append(number)
        start += len(own)
    body = CadBody(
        np.concatenate(points),
        np.concatenate(normals),
        np.concatenate(bending),
        np.concatenate(triangles),
        ragged.owner(counts),
        np.array(flat, dtype=np.bool_),
        np.array(shares).reshape(-1, 4),
        np.concatenate(nodes),
        ragged.offsets(sizes),
        np.array(edge, dtype=np.intp),
        np.array(user, dtype=np.intp),
    )
    return body, missing


def _surface(face: Any, triangulation: Any) -> tuple[bool, Floats, Floats]:
    """Whether a face is flat, and at the points (n,) of its triangles the unit normals (n,3), to the left of v and
    before u, and the mean curvatures of its surface."""
    gp, adaptor = occ("gp"), occ("BRepAdaptor").BRepAdaptor_Surface(face, False)
    is_flat = str(adaptor.GetType()).endswith("_Plane")
    places = [place.Coord() for place in triangulation.MapUVNodeArray()]
    point, derivatives = gp.gp_Pnt(), [gp.gp_Vec() for _ in ("u", "v", "uu", "vv", "uv")]
    found = np.empty((len(places), 5, 3))
    for row, (u, v) in enumerate(places[:1] if is_flat else places):
        adaptor.D2(u, v, point, *derivatives)
        found[row] = [one.Coord() for one in derivatives]
    if is_flat:
        found[1:] = found[0]
    along_u, along_v = found[:, 0], found[:, 1]
    normals, sizes = cross(along_u, along_v), norm(found[:, :2])
    # Where parameter lines meet in a point, or run along each other, there is no normal.
    none = norm(normals) <= NO_CAD_NORMAL * sizes.max(axis=0, initial=0.0).prod()
    normals = np.where(none[:, None], 0.0, normals / np.where(none, 1.0, norm(normals))[:, None])
    bent = mean_curvatures((along_u, along_v), (found[:, 2], found[:, 4], found[:, 3]), normals)
    return is_flat, normals, np.where(none, np.nan, bent)
