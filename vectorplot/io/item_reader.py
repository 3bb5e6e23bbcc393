"""Reading an item of a scene file, word by word: what it is, where it stands, how it looks, which lines it has."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import NoReturn

import numpy as np

from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.camera import VIEWS
from vectorplot.io.named_files import NamedFiles
from vectorplot.io.scene_item import (
    CAP_WORDS,
    Draft,
    Placement,
    Subdivision,
    material_of,
    moved,
    read_hatch,
    read_matrix,
    read_rotation,
    read_scale,
    turned,
)
from vectorplot.io.scene_statements import CAMERA_WORDS
from vectorplot.io.scene_words import (
    COMMENTS,
    FORM_WORDS,
    INTEGRAL_WORDS,
    ITEM_WORDS,
    KIND_WORDS,
    SCENE_WORDS,
    SOLID_WORDS,
    TERRAIN_WORDS,
    UNSUPPORTED_COMMENTS,
    Words,
)
from vectorplot.io.surface_line_words import (
    CurveDraft,
    read_contours,
    read_detail,
    read_integral_lines,
    read_isophote_edges,
    read_isophotes,
    read_level_lines,
    read_parameter_lines,
    read_sections,
    read_slices,
    read_smooth_contours,
    read_smooth_lines,
    read_surface_curve,
    read_terrain_lines,
    read_trim,
)
from vectorplot.scene.face_looks import FaceLook
from vectorplot.scene.item import Pattern
from vectorplot.scene.material import FINISH_WORDS, Material
from vectorplot.words import (
    COLOURS,
    LINE_WORDS,
    MATERIALS,
    OWN_LINE_WORDS,
    PALETTES,
    SUBDIVISIONS,
    is_alike,
    is_colour,
    nearest,
    nearest_material,
    unknown_material,
)

# Where one is in the text of a scene file, and what all readers of items ask there.


class ItemCursor:
    """Reads words from left to right; at: the next one; places: where the items before this one stand, by name; files:
    those that the text may name, none where it stands in no file itself."""

    def __init__(self, words: Words, files: NamedFiles | None = None) -> None:
        self.source = words
        self.files = files
        self.words = words.words
        self.at = 0
        self.places: dict[str, int] = {}

    def fail(self, cause: str, draft: Draft | None = None) -> NoReturn:
        """Raise InputError for the next word; draft: the item it belongs to."""
        self.source.fail(self.at, cause if draft is None else draft.owner + cause)

    def warn(self, cause: str) -> None:
        """Warn of the next word."""
        line = self.source.line(self.at)
        warnings.warn(f"{self.source.name}:{line}: {cause}", InputWarning, stacklevel=2)

    def colour(self, owner: str) -> str:
        """The colour at the next word; an unknown one is gray."""
        word = self.words[self.at]
        if not word or word == "," or self.source.is_number(self.at):
            self.source.fail(self.at, f"{owner}: expected a colour, got {self.source.shown(self.at)}")
        name = self.source.string(self.at)
        if not is_colour(name):
            near = nearest(name.lower(), COLOURS)
            known = (
                f"did you mean '{near}'?"
                if near
                else f"known: {', '.join(PALETTES)}, black, white, red, #rrggbb in quotes"
            )
            self.warn(f"{owner}: unknown colour '{name[:40]}', gray is used ({known})")
            name = "gray"
        self.at += 1
        return name

    def kind(self, draft: Draft, kind: str) -> None:
        """Say which kind of item it is; an error where it is another one already."""
        if draft.kind is not None and draft.kind != kind:
            self.fail(
                f"is a '{draft.kind}' already, '{self.words[self.at]}' does not fit; an item begins with its name",
                draft,
            )
        draft.kind = kind
        draft.kind_index = self.at

    def once(self, draft: Draft, attribute: str) -> None:
        """Step over a word that may stand only once in an item."""
        if getattr(draft, attribute) is not None:
            self.fail(f"a second '{self.words[self.at]}'", draft)
        self.at += 1

    def none(self) -> bool:
        """Whether the word none stands here; steps over it."""
        found = self.words[self.at] == "none"
        self.at += found
        return found


# Lines on the surfaces of items: what words about them say.


def _curves(
    read: Callable[[Words, int, str, CurveDraft], tuple[CurveDraft, int]],
) -> Callable[[ItemCursor, Draft], None]:
    """How to read words about the lines of a surface."""

    def handle(reader: ItemCursor, draft: Draft) -> None:
        draft.curves, reader.at = read(reader.source, reader.at, draft.owner, draft.curves)

    return handle


def _read_trim(reader: ItemCursor, draft: Draft) -> None:
    """A curve in u and v within which the surface is left, or of a hole in it."""
    draft.trim_index, within = reader.at, reader.words[reader.at] == "trim"
    loop, reader.at = read_trim(reader.source, reader.at, draft.owner)
    if within:
        draft.trims = (*draft.trims, loop)
    else:
        draft.trim_holes = (*draft.trim_holes, loop)


def _integral_lines(reader: ItemCursor, draft: Draft) -> None:
    """Words about integral curves: what they begin with depends on the kind of the item."""
    draft.curves, reader.at = read_integral_lines(reader.source, reader.at, draft.owner, draft.curves, draft.kind)


SURFACE_LINE_WORDS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    "parameter_lines": _curves(read_parameter_lines),
    "isophotes": _curves(read_isophotes),
    "contours": _curves(read_contours),
    "sections": _curves(read_sections),
    "level_lines": _curves(read_level_lines),
    "slices": _curves(read_slices),
    "surface_curve": _curves(read_surface_curve),
    **dict.fromkeys(("trim", "trim_hole"), _read_trim),
    **dict.fromkeys(TERRAIN_WORDS, _curves(read_terrain_lines)),
    "smooth_lines": _curves(read_smooth_lines),
    "smooth_contours": _curves(read_smooth_contours),
    "isophote_edges": _curves(read_isophote_edges),
    "detail": _curves(read_detail),
    **dict.fromkeys(INTEGRAL_WORDS, _integral_lines),
}
"""What reads words about lines on an item."""


# How items look, and what is drawn of them: colours, materials, patterns, kinds of lines.

_OF_ITEMS = frozenset([*ITEM_WORDS, *FORM_WORDS, *CAP_WORDS, *COLOURS, *MATERIALS])


def _read_colour(reader: ItemCursor, draft: Draft) -> None:
    if draft.colour is not None:
        reader.fail(f"a second colour, '{reader.words[reader.at]}'", draft)
    draft.colour = reader.words[reader.at]
    reader.at += 1


def _read_named_colour(reader: ItemCursor, draft: Draft) -> None:
    reader.at += 1
    draft.colour = reader.colour(draft.name)


def _read_material(reader: ItemCursor, draft: Draft) -> None:
    if draft.material is not None:
        reader.fail(f"a second physical property, '{reader.words[reader.at]}'", draft)
    draft.material = MATERIALS[reader.words[reader.at]]
    reader.at += 1
    finish: dict[str, float] = {}
    # An item may have such a name: what follows a name is no number.
    while (word := reader.words[reader.at]) in FINISH_WORDS and reader.source.is_number(reader.at + 1):
        if word in finish:
            reader.fail(f"{draft.material}: a second {word}", draft)
        finish[word] = reader.source.number(reader.at + 1, draft.owner, word)
        try:
            Material(draft.material, **finish)
        except InputError as error:
            reader.fail(error.cause, draft)
        reader.at += 2
    draft.finish = finish


def _read_named_material(reader: ItemCursor, draft: Draft) -> None:
    reader.at += 1
    word = reader.words[reader.at]
    if word in MATERIALS:
        _read_material(reader, draft)
    elif not word or word == "," or reader.source.is_number(reader.at):
        reader.fail(f"expected a material, got {reader.source.shown(reader.at)}", draft)
    else:
        reader.fail(unknown_material(reader.source.string(reader.at)).cause, draft)


def read_face_look(reader: ItemCursor, draft: Draft) -> FaceLook | None:
    """The look of a face, in words as in items: a colour, a material and its numbers, opacity; None where none stands
    here."""
    own = Draft(draft.name, draft.index)
    own.owner = f"{draft.owner}a face: "
    begin = reader.at
    while (read := _OF_FACES.get(reader.words[reader.at])) is not None:
        is_colour = read in (_read_colour, _read_named_colour)
        if (is_colour and own.colour is not None) or (read is _read_material and own.material is not None):
            break
        read(reader, own)
    if reader.at == begin:
        return None
    plain = own.material is None and own.opacity is None
    return FaceLook(own.colour, None if plain else material_of(own))


def _read_form(reader: ItemCursor, draft: Draft) -> None:
    word = reader.words[reader.at]
    if word == "hollow":
        draft.hollow = True
    elif word in SOLID_WORDS:
        draft.solid = True
    else:
        draft.form = word
    reader.at += 1


def _read_cap(reader: ItemCursor, draft: Draft) -> None:
    draft.shown_caps |= {CAP_WORDS[reader.words[reader.at]]}
    reader.at += 1


def _read_opacity(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "opacity")
    opacity = reader.source.number(reader.at, draft.owner, "opacity")
    if not 0.0 <= opacity <= 1.0:
        reader.fail(f"opacity {opacity:g} must lie between 0 and 1", draft)
    draft.opacity = opacity
    reader.at += 1


def _read_refraction(reader: ItemCursor, draft: Draft) -> None:
    reader.at += 1
    refraction = reader.source.number(reader.at, draft.owner, "refraction")
    if refraction <= 0.0:
        reader.fail(f"refraction {refraction:g} must be positive", draft)
    draft.refraction = refraction
    reader.at += 1


def _read_patterns(reader: ItemCursor, draft: Draft) -> None:
    """Faces by number, and the coloured polygons on each."""
    source = reader.source
    reader.at += 1
    face: int | None = None
    while (word := reader.words[reader.at]) in ("face", "polygon"):
        reader.at += 1
        if word == "face":
            face = source.whole(reader.at, draft.owner, "the face of a pattern")
            reader.at += 1
            continue
        if face is None:
            reader.at -= 1
            break
        if reader.words[reader.at] in ("", ","):
            reader.fail(f"expected the name of a polygon, got {source.shown(reader.at)}", draft)
        name = source.string(reader.at)
        reader.at += 1
        colour = reader.colour(f"{draft.owner}polygon {name}")
        columns, end = source.points(reader.at, 2, draft.owner, f"a point of polygon {name}")
        if len(columns[0]) < 3:
            reader.fail(f"polygon {name} has {len(columns[0])} points, expected three or more", draft)
        reader.at = end
        draft.patterns.append(Pattern(name, colour, face - 1, np.array(columns).T.copy()))
    if face is None:
        reader.fail(f"patterns: expected 'face' and its number, got {source.shown(reader.at)}", draft)


def _read_lines(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "lines")
    kinds: list[str] = []
    if reader.none():
        draft.lines = ()
        return
    while True:
        word = reader.words[reader.at]
        if word not in OWN_LINE_WORDS:
            reader.fail(f"lines: expected one of {', '.join(LINE_WORDS)}, got {reader.source.shown(reader.at)}", draft)
        kinds.append(word)
        reader.at += 1
        if reader.words[reader.at] != ",":
            break
        reader.at += 1
    draft.lines = tuple(kinds)


def _read_occludes(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "occludes")
    word = reader.words[reader.at]
    if word not in ("yes", "no"):
        reader.fail(f"occludes: expected yes or no, got {reader.source.shown(reader.at)}", draft)
    draft.occludes = word == "yes"
    reader.at += 1


def _read_group(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "group")
    word = reader.words[reader.at]
    if word in ("", ",", *SCENE_WORDS) or word in _OF_ITEMS or reader.source.is_number(reader.at):
        reader.fail(f"group: expected the name of a group, got {reader.source.shown(reader.at)}", draft)
    draft.group = reader.source.string(reader.at)
    reader.at += 1


def _read_hatch(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "hatch")
    draft.hatch, reader.at = read_hatch(reader.source, reader.at, draft.owner)


def _read_subdivision(reader: ItemCursor, draft: Draft) -> None:
    """A scheme, the angle of creases, and creases by the numbers of the vertices at their ends."""
    reader.once(draft, "subdivision")
    source = reader.source
    scheme, found = reader.words[reader.at], Subdivision()
    if scheme not in SUBDIVISIONS:
        reader.fail(f"subdivision: expected {' or '.join(SUBDIVISIONS)}, got {source.shown(reader.at)}", draft)
    reader.at += 1
    while (word := reader.words[reader.at]) in ("crease_angle", "creases") and source.is_number(reader.at + 1):
        if word == "crease_angle":
            found = replace(found, crease_angle_deg=source.number(reader.at + 1, draft.owner, word))
            reader.at += 2
            continue
        pairs, reader.at = source.groups(reader.at + 1, draft.owner, "a vertex of a crease")
        if any(len(pair) != 2 for pair in pairs):
            reader.fail("creases: expected two vertices each, with commas between creases", draft)
        found = replace(found, creases=tuple((one - 1, two - 1) for one, two in pairs))
    draft.subdivision = replace(found, scheme=scheme)


LOOK_WORDS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    **dict.fromkeys(COLOURS, _read_colour),
    **dict.fromkeys(MATERIALS, _read_material),
    **dict.fromkeys(FORM_WORDS, _read_form),
    **dict.fromkeys(CAP_WORDS, _read_cap),
    "colour": _read_named_colour,
    "material": _read_named_material,
    "opacity": _read_opacity,
    "refraction": _read_refraction,
    "patterns": _read_patterns,
    "lines": _read_lines,
    "occludes": _read_occludes,
    "group": _read_group,
    "hatch": _read_hatch,
    "subdivision": _read_subdivision,
}
"""What reads words about the look of an item."""

_OF_FACES = {
    word: read for word, read in LOOK_WORDS.items() if word in (*COLOURS, *MATERIALS, "colour", "material", "opacity")
}
"""The same of a face."""

BEFORE_LENGTHS = frozenset([*COLOURS, *MATERIALS, *FORM_WORDS, *CAP_WORDS])
"""Words that may stand between the word box and its lengths."""


# Where items stand: words that move what stands before them, or repeat it.

MOST_COPIES = 100_000
"""So often a single item, or a group of them, may be repeated."""


def _read_ring(reader: ItemCursor, draft: Draft) -> None:
    """How many copies stand around an axis."""
    reader.at += 1
    axis = "z"
    if reader.words[reader.at] in ("x", "y", "z"):
        axis = reader.words[reader.at]
        reader.at += 1
    count = _count(reader, draft, "a ring")
    draft.places = [turned(place, axis, 360.0 * k / count) for k in range(count) for place in draft.places]


def _read_grid(reader: ItemCursor, draft: Draft) -> None:
    """How many copies stand along x, y and perhaps z, and how far apart."""
    reader.at += 1
    counts = [_count(reader, draft, "a grid")]
    while reader.words[reader.at] != "apart" and len(counts) < 3:
        counts.append(_count(reader, draft, "a grid"))
    if reader.words[reader.at] != "apart":
        reader.fail(f"grid: expected 'apart' and distances, got {reader.source.shown(reader.at)}", draft)
    steps, reader.at = reader.source.numbers(reader.at + 1, len(counts), draft.owner, "a distance of the grid")
    for axis, (count, step) in enumerate(zip(counts, steps, strict=True)):
        _check_copies(reader, draft, count)
        ways = [[step * k if axis == one else 0.0 for one in range(3)] for k in range(count)]
        draft.places = [moved(place, *way) for way in ways for place in draft.places]


def _count(reader: ItemCursor, draft: Draft, what: str) -> int:
    count = reader.source.whole(reader.at, draft.owner, f"the copies of {what}")
    if count < 1:
        reader.fail(f"{what} of {count} copies: expected 1 or more", draft)
    _check_copies(reader, draft, count)
    reader.at += 1
    return count


def _check_copies(reader: ItemCursor, draft: Draft, count: int) -> None:
    if count * len(draft.places) > MOST_COPIES:
        reader.fail(f"more than {MOST_COPIES} copies", draft)


def _modifier(
    read: Callable[[Words, int, str, Placement], tuple[Placement, int]],
) -> Callable[[ItemCursor, Draft], None]:
    """How to read words that move an item."""

    def handle(reader: ItemCursor, draft: Draft) -> None:
        found = [read(reader.source, reader.at, draft.owner, place) for place in draft.places]
        draft.places, reader.at = [place for place, _ in found], found[0][1]

    return handle


PLACE_WORDS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    "rotation": _modifier(read_rotation),
    "scale": _modifier(read_scale),
    "matrix": _modifier(read_matrix),
    "ring": _read_ring,
    "grid": _read_grid,
}
"""What reads words that move and repeat, but for the translation."""

MODIFIERS = ("translation", *PLACE_WORDS)
"""The words that move and repeat."""


# What items are: polyhedra, surfaces, curves, meshes of files.


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
    from vectorplot.io.scene_surfaces import read_surface

    reader.kind(draft, "surface")
    reader.once(draft, "surface")
    draft.surface, reader.at = read_surface(reader.source, reader.at, draft.owner)


def _read_terrain(reader: ItemCursor, draft: Draft) -> None:
    from vectorplot.io.scene_surfaces import TERRAIN_SUFFIXES, read_terrain_mesh

    reader.kind(draft, "terrain")
    reader.once(draft, "terrain")
    path = None
    if reader.words[reader.at].startswith('"'):
        if reader.files is None:
            reader.fail("a text without a file names no files", draft)
        path = reader.files.named(reader.source, reader.at, draft.owner, TERRAIN_SUFFIXES)
        reader.at += 1
    draft.terrain, reader.at = read_terrain_mesh(reader.source, reader.at, draft.owner, path)


def _read_curve(reader: ItemCursor, draft: Draft) -> None:
    from vectorplot.io.scene_surfaces import read_space_curve

    reader.kind(draft, "curve")
    reader.once(draft, "curve")
    draft.curve, reader.at = read_space_curve(reader.source, reader.at, draft.owner)


def _read_mesh(reader: ItemCursor, draft: Draft) -> None:
    from vectorplot.io.read_mesh import MESH_SUFFIXES, whole_mesh

    reader.kind(draft, "mesh")
    reader.once(draft, "mesh")
    if reader.files is None:
        reader.fail("a text without a file names no files", draft)
    path = reader.files.named(reader.source, reader.at, draft.owner, MESH_SUFFIXES)
    draft.mesh, draft.fields, draft.mesh_looks = whole_mesh(path)
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
        draft.faces = []
        while True:
            found, reader.at = reader.source.groups(reader.at, draft.owner, "a vertex of a face")
            draft.faces += found
            start, look = reader.at, read_face_look(reader, draft)
            # Behind the last face stands the look of the item, unless that has its own.
            if look is None or (reader.words[reader.at] != "," and draft.colour is None and draft.material is None):
                reader.at = start
                break
            draft.looks[len(draft.faces) - 1] = look
            if reader.words[reader.at] != ",":
                break
            reader.at += 1


def _read_removed(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "removed")
    groups, reader.at = reader.source.groups(reader.at, draft.owner, "a face")
    draft.removed = [number for group in groups for number in group]


def _read_face_looks(reader: ItemCursor, draft: Draft) -> None:
    """Faces by number, and the look of these; more after commas."""
    while True:
        reader.at += 1
        faces = list[int]()
        while reader.source.is_number(reader.at):
            faces.append(reader.source.whole(reader.at, draft.owner, "a face") - 1)
            reader.at += 1
        look = read_face_look(reader, draft) if faces else None
        if look is None:
            what = "a colour or a material" if faces else "the number of a face"
            reader.fail(f"face_looks: expected {what}, got {reader.source.shown(reader.at)}", draft)
        draft.looks |= dict.fromkeys(faces, look)
        if reader.words[reader.at] != ",":
            return


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
    "face_looks": _read_face_looks,
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


# The words of an item of a scene file, read one after the other into a draft.

_HEADER = [*KIND_WORDS, *MATERIALS, *FORM_WORDS]

HANDLERS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    **LOOK_WORDS,
    **SHAPE_WORDS,
    **PLACE_WORDS,
    **SURFACE_LINE_WORDS,
}
"""What reads the words of an item."""


_PRISM = "a prism is a 'translation' with 'base_points' and 'trans_vector'"
_BOX = "expected 'box' and its three lengths"

OTHERWISE = {
    **dict.fromkeys(("prism", "extrusion", "extrude"), _PRISM),
    **dict.fromkeys(("cube", "cuboid"), _BOX),
    "pyramid": "a pyramid is its 'vertices' and 'faces', or a 'revolution' with as large an 'order' as it has sides",
    "polyhedron": "a polyhedron is its 'vertices' and 'faces'",
    "difference": "holes are 'bore' and 'cutout', and 'cut' takes away what is before a plane",
}
"""What is said in other words than those that other programs have for it."""

LISTS = ("vertices", "revolution", "translation")
"""Kinds of items that are made of lists of points."""

PARTED = " (points are parted by commas)"

CODE = len("#rrggbb")
"""The length of a colour by its numbers."""


class ItemReader(ItemCursor):
    """Reads items, and what moves them."""

    def draft(self) -> Draft:
        """A name, and everything up to the next word that says nothing about an item."""
        words, handlers = self.words, HANDLERS
        name = words[self.at]
        if name in handlers or name == "," or self.source.is_number(self.at):
            self.fail(f"expected the name of an item, got {self.source.shown(self.at)}")
        if name.startswith(UNSUPPORTED_COMMENTS):
            self.fail(f"{COMMENTS}, not with {name[: 1 + (name[0] == '/')]!r}")
        if self.source.is_number(self.at + 1):
            self._unknown_slot(name)
        if name in CAMERA_WORDS and (words[self.at + 1] in VIEWS or self.source.is_number(self.at + 1)):
            self.fail(f"'{name}' is said of the camera: expected 'camera {name} {words[self.at + 1]}'")
        draft = Draft(self.source.string(self.at) if name[0] == '"' else name, self.at)
        self.at += 1
        while True:
            handler = handlers.get(words[self.at])
            if handler is not None:
                handler(self, draft)
            elif self._ends(draft):
                return draft

    def _unknown_slot(self, name: str) -> None:
        """An error for a word with a number behind a surface or a curve that has no such slot."""
        # Surfaces and curves are loaded to say what they have.
        from vectorplot.io.named_shapes import CURVES, SURFACES

        words = self.words
        kind = next((at for at in range(self.at - 1, -1, -1) if words[at] in KIND_WORDS), 0)
        families = {"surface": SURFACES, "curve": CURVES}.get(words[kind], {})
        family = families.get(words[kind + 1])
        if family is None:
            return
        from vectorplot.io.reserved_words import RESERVED

        what, near = words[kind + 1], nearest(name, family.slots)
        if near:
            self.fail(f"a {what} has no '{name}' (is '{name}' meant to be '{near}'?)")
        has = f"a {what} has {', '.join(family.slots)}"
        if name in RESERVED:
            self.fail(f"'{name}' is a word of the language, but none of what stands before it: {has}")
        self.fail(f"there is no '{name}': {has}")

    def _ends(self, draft: Draft) -> bool:
        """Whether the item ends before a word that is none of the language's: an unknown colour is taken as gray."""
        word, source = self.words[self.at], self.source
        missing = draft.missing()
        if draft.kind is not None and missing is None:
            if word == "," or source.is_number(self.at):
                hint = PARTED if draft.kind in LISTS and source.is_number(self.at) else ""
                self.fail(f"expected a word or the name of the next item, got {source.shown(self.at)}{hint}", draft)
            return True
        if draft.kind is not None:
            expected = f"'{missing}'" if draft.kind != "box" else "three lengths"
            hint = PARTED if draft.kind in LISTS and source.is_number(self.at) else ""
            self.fail(f"expected {expected}, got {source.shown(self.at)}{hint}", draft)
        plain = word and word not in SCENE_WORDS and word[0] not in '",' and not source.is_number(self.at)
        if plain:
            self._named_shape(draft, word)
        # A colour may look a little like a word of the language, but no number follows it.
        near = nearest(word, _HEADER) if plain and (source.is_number(self.at + 1) or is_alike(word, _HEADER)) else None
        if plain and not near and draft.colour is not None:
            near = nearest_material(word)
        if near:
            self.fail(f"unknown word '{word}', expected '{near}'", draft)
        named = not is_alike(draft.name, HANDLERS)
        if plain and draft.colour is None and named:
            draft.colour = self.colour(draft.name)
            return False
        # Surfaces and curves are loaded for scenes that name one, and to say what a word may have meant.
        from vectorplot.io.reserved_words import RESERVED

        meant = nearest(draft.name, RESERVED)
        hint = f" (or is '{draft.name}' meant to be '{meant}'?)" if meant else ""
        if draft.name in RESERVED:
            hint = f" ('{draft.name}' is a word of the language, but none of what stands before it)"
        if word.startswith('"') and is_colour(word.strip('"')):
            hint = f" (before a colour in quotes stands the word for it: colour {word})"
        code = source.comment_beside(draft.index)[:CODE]
        if is_colour(code):
            hint = f' (behind # is a comment; a colour is written so: colour "{code}")'
        self.fail(f"expected one of {', '.join(KIND_WORDS)}, got {source.shown(self.at)}{hint}", draft)

    def _named_shape(self, draft: Draft, word: str) -> None:
        """An error for a surface or a curve without the word that says which of them it is."""
        # Surfaces and curves are loaded for scenes that name one, and where a word is none that is known.
        from vectorplot.io.named_shapes import CURVES, SURFACES

        if word.lower() in OTHERWISE:
            self.fail(f"there is no '{word}': {OTHERWISE[word.lower()]}", draft)
        for kind, names in (("surface", SURFACES), ("curve", CURVES)):
            if word.lower() in names:
                name = word.lower()
                self.fail(f"'{word}' is a {kind}: expected '{kind} {name}'", draft)

    def modifiers(self, draft: Draft) -> None:
        """Words that move what stands before them, or repeat it, one after the other."""
        while (word := self.words[self.at]) in MODIFIERS:
            HANDLERS[word](self, draft)
