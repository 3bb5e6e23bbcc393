"""What items are: polyhedra, surfaces, curves, meshes of files."""

from __future__ import annotations

from collections.abc import Callable

from vectorplot.io.scenes.items.item_cursor import ItemCursor
from vectorplot.io.scenes.items.look_words import BEFORE_LENGTHS, LOOK_WORDS
from vectorplot.io.scenes.items.scene_item import Draft
from vectorplot.io.scenes.items.scene_placement import moved


def _read_box(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "box")
    reader.once(draft, "lengths")
    while reader.words[reader.at] in BEFORE_LENGTHS:
        LOOK_WORDS[reader.words[reader.at]](reader, draft)
    draft.lengths, reader.at = reader.source.numbers(reader.at, 3, draft.owner, "a length of the box")


def _read_revolution(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "revolution")
    reader.at += 1


def _read_angle(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "revolution")
    reader.at += 1
    draft.angle_deg = reader.source.number(reader.at, draft.owner, "rot_angle")
    reader.at += 1


def _read_order(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "revolution")
    reader.once(draft, "order")
    draft.order = reader.source.whole(reader.at, draft.owner, "order")
    reader.at += 1


def _read_meridian(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "revolution")
    reader.once(draft, "meridian")
    draft.meridian, reader.at = reader.source.points(reader.at, 3, draft.owner, "a point of the meridian")


def _read_translation(reader: ItemCursor, draft: Draft) -> None:
    """The kind where a word follows, the modifier where a number does."""
    if not reader.source.is_number(reader.at + 1):
        if draft.missing() is None:
            reader.at += 1
            reader.source.number(reader.at, draft.owner, "translation")
        reader.kind(draft, "translation")
        reader.at += 1
        return
    (x, y, z), reader.at = reader.source.numbers(reader.at + 1, 3, draft.owner, "translation")
    draft.places = [moved(place, x, y, z) for place in draft.places]


def _read_base(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "translation")
    reader.once(draft, "base_points")
    draft.base_points, reader.at = reader.source.points(reader.at, 3, draft.owner, "a point of the base")


def _read_vector(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "translation")
    reader.once(draft, "trans_vector")
    draft.trans_vector, reader.at = reader.source.numbers(reader.at, 3, draft.owner, "trans_vector")


def _read_cutout(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "translation")
    cutout, reader.at = reader.source.points(reader.at + 1, 3, draft.owner, "a point of the cutout")
    draft.cutouts = (*draft.cutouts, cutout)


def _read_bores(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "translation")
    columns, reader.at = reader.source.points(reader.at + 1, 4, draft.owner, "a centre and a radius of the bore")
    draft.bores = (*draft.bores, *zip(*columns, strict=True))


def _read_surface(reader: ItemCursor, draft: Draft) -> None:
    from vectorplot.io.scenes.scene_surface import read_surface

    reader.kind(draft, "surface")
    reader.once(draft, "surface")
    draft.surface, reader.at = read_surface(reader.source, reader.at, draft.owner)


def _read_terrain(reader: ItemCursor, draft: Draft) -> None:
    from vectorplot.io.terrains.terrain_words import read_terrain_mesh

    reader.kind(draft, "terrain")
    reader.once(draft, "terrain")
    draft.terrain, reader.at = read_terrain_mesh(reader.source, reader.at, draft.owner)


def _read_curve(reader: ItemCursor, draft: Draft) -> None:
    from vectorplot.io.scenes.scene_space_curve import read_space_curve

    reader.kind(draft, "curve")
    reader.once(draft, "curve")
    draft.curve, reader.at = read_space_curve(reader.source, reader.at, draft.owner)


def _read_mesh(reader: ItemCursor, draft: Draft) -> None:
    from vectorplot.io.meshes.read_mesh import MESH_SUFFIXES, whole_mesh

    reader.kind(draft, "mesh")
    reader.once(draft, "mesh")
    if reader.files is None:
        reader.fail("a text without a file names no files", draft)
    path = reader.files.named(reader.source, reader.at, draft.owner, MESH_SUFFIXES)
    draft.mesh, draft.fields = whole_mesh(path)
    reader.at += 1


def _read_vertices(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "vertices")
    reader.once(draft, "vertices")
    if reader.none():
        draft.vertices = [[], [], []]
    else:
        draft.vertices, reader.at = reader.source.points(reader.at, 3, draft.owner, "a vertex")


def _read_edges(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "vertices")
    reader.once(draft, "edges")
    if reader.none():
        draft.edges = []
    else:
        draft.edges, reader.at = reader.source.groups(reader.at, draft.owner, "a vertex of an edge")


def _read_faces(reader: ItemCursor, draft: Draft) -> None:
    reader.kind(draft, "vertices")
    reader.once(draft, "faces")
    if reader.none():
        draft.faces = []
    else:
        draft.faces, reader.at = reader.source.groups(reader.at, draft.owner, "a vertex of a face")


def _read_removed(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "removed")
    groups, reader.at = reader.source.groups(reader.at, draft.owner, "a face")
    draft.removed = [number for group in groups for number in group]


def _read_intersection(reader: ItemCursor, draft: Draft) -> None:
    """Two names, the comma between them may be left out, and more with commas before them."""
    reader.kind(draft, "intersection")
    reader.once(draft, "parts")
    names: list[str] = []
    while len(names) < 2 or reader.words[reader.at] == ",":
        reader.at += bool(names) and reader.words[reader.at] == ","
        if reader.words[reader.at] in ("", ",") or reader.source.is_number(reader.at):
            reader.fail(f"expected the name of an item to intersect, got {reader.source.shown(reader.at)}", draft)
        name = reader.source.string(reader.at)
        if name not in reader.places:
            reader.fail(f"expected the name of an item before it, got {reader.source.shown(reader.at)}", draft)
        names.append(name)
        reader.at += 1
    draft.parts = tuple(names)


SHAPE_WORDS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    "vertices": _read_vertices,
    "edges": _read_edges,
    "faces": _read_faces,
    "removed_faces": _read_removed,
    "revolution": _read_revolution,
    "rot_angle": _read_angle,
    "meridian": _read_meridian,
    "order": _read_order,
    "translation": _read_translation,
    "base_points": _read_base,
    "trans_vector": _read_vector,
    "cutout": _read_cutout,
    "bore": _read_bores,
    "box": _read_box,
    "intersection": _read_intersection,
    "surface": _read_surface,
    "curve": _read_curve,
    "mesh": _read_mesh,
    "terrain": _read_terrain,
}
"""What reads words about the shape of an item. The translation is a kind, or moves what stands before it."""
