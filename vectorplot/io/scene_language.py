"""Scene files: the data-file language of docs/scene-language.md, read into a Scene."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np

from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError, printable
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import IDENTITY
from vectorplot.io.item_reader import ItemReader
from vectorplot.io.mesh_file import shown
from vectorplot.io.named_files import CAD_SUFFIXES, DEEPEST, NO_PARTS, NamedFiles
from vectorplot.io.scene_item import Draft, finished
from vectorplot.io.scene_statements import (
    INK_WORDS,
    begins_annotation,
    pen_target,
    read_annotation,
    read_box_axes,
    read_camera,
    read_colouring,
    read_cut,
    read_depth_cue,
    read_explosion,
    read_exposure,
    read_ink,
    read_label,
    read_light,
    read_measures,
    read_page,
    read_scale_bar,
    read_sheet,
)
from vectorplot.io.scene_words import ANNOTATION_WORDS, SCENE_WORDS, Words
from vectorplot.scene.annotations import field_arrows, label_anchors
from vectorplot.scene.extent import check_range
from vectorplot.scene.item import Item
from vectorplot.scene.labels import Label
from vectorplot.scene.light import Light
from vectorplot.scene.page import SheetSettings
from vectorplot.scene.pens import target_of, unknown_item
from vectorplot.scene.scene import Scene, together
from vectorplot.words import WIRE_STYLES, unknown

MAX_FILE_BYTES = 64 << 20
"""The largest scene file that is read."""

MAX_ITEMS = 1_000_000
"""The largest number of items in a scene file."""


def read_scene(path: str | os.PathLike[str], tolerance: float | None = None, parts: str | None = None) -> Scene:
    """The scene that a file in the scene language describes; tolerance, parts: of CAD parts in it, see read_file.read.

    Errors: InputError where parts is given and there are none. Source: Glaeser, chapter 3 and section 6.5.
    """
    name, file = printable(str(path)), Path(path)
    files = NamedFiles.of(file, tolerance, parts)
    scene = _Reader(Words(_text(file, name), name), files).annotated()
    if parts is not None and not files.has_parts:
        raise InputError(NO_PARTS, file=name)
    return scene


def _parts(path: Path, files: NamedFiles) -> Scene:
    """The parts in a file of a CAD system. Errors as in cad_scene."""
    from vectorplot.io.cad_files import PARTS, cad_scene
    from vectorplot.tolerances import USUAL_PART_TOLERANCE

    return cad_scene(path, files.tolerance or USUAL_PART_TOLERANCE, files.parts or PARTS[0])


def _text(file: Path, name: str) -> str:
    """The text in a file that messages call so. Errors as in read_scene."""
    try:
        if file.stat().st_size > MAX_FILE_BYTES:
            raise InputError(f"larger than {MAX_FILE_BYTES >> 20} MiB: this is no scene file", file=name)
        return file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        raise InputError("not UTF-8: this is no scene file", file=name, line=line) from None
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(getattr(error, "strerror", None) or "cannot be read", file=name) from None


def parse_scene(text: str, name: str = "<text>", *, beside: str | os.PathLike[str] | None = None) -> Scene:
    """The scene that a text in the scene language describes.

    Parameters
    ----------
    text : str
        Statements and items.
    name : str
        What messages call the text.
    beside : str or path, optional
        The file that the text stands for: names of files in it are relative to its folder. Where None there are none.

    Returns
    -------
    Scene
        With the items, lights, camera and page that the text names.

    Raises
    ------
    InputError
        With name, line, item and the word expected; for more than a million items.

    Warns
    -----
    InputWarning
        Where a colour is unknown: it is gray.

    Notes
    -----
    Edge cases: an empty text is an empty scene.

    Examples
    --------
    >>> from vectorplot import io
    >>> scene = io.parse_scene("DIE red box solid 2 2 2   BALL blue surface sphere 1 translation 5 0 0")
    >>> [(item.name, item.colour) for item in scene.items]
    [('DIE', 'red'), ('BALL', 'blue')]
    >>> scene.items[0].mesh.face_count
    6
    """
    files = None if beside is None else NamedFiles.of(Path(beside))
    return _Reader(Words(text, name), files).annotated()


class _Reader(ItemReader):
    """Reads statements and items, and gathers them; parts: the places of items that an intersection is made of."""

    def __init__(self, words: Words, files: NamedFiles | None = None) -> None:
        super().__init__(words, files)
        self.items: list[Item] = []
        self.depth = 1
        self.parts: set[int] = set()
        self.lights: list[Light] = []
        self.labels: list[tuple[int, Label]] = []
        self.annotations: list[Scene] = []
        self.arrows: list[int] = []
        self.pens: list[tuple[int, str]] = []
        self.cuts: list[int] = []
        self.moves: list[int] = []
        self.settings = Scene(items=())
        self.set: set[str] = set()
        self.made_of: dict[str, str] = {}
        self.lit: list[tuple[int, Draft]] = []

    def annotated(self) -> Scene:
        """The whole file: the scene, and behind its items the lines and labels of annotations."""
        read = self.scene()
        scene = together([read, *self.annotations, *(self.field_arrows(at, read) for at in self.arrows)])
        if scene.inks is not None:
            self.check_pens(scene)
        return scene

    def field_arrows(self, at: int, scene: Scene) -> Scene:
        """The arrows that a statement asks for, on an item that may come behind it."""
        from vectorplot.io.integral_line_words import read_arrows

        name, field, lengths, _ = read_arrows(self.source, at)
        item = next((item for item in scene.items if item.name == name), None)
        if item is None:
            self.source.fail(at, unknown("field_arrows: item", name, [one.name for one in scene.items]).cause)
        try:
            return field_arrows(item, field, **lengths)
        except InputError as error:
            self.source.fail(at, f"field_arrows: {error.cause}")

    def scene(self) -> Scene:
        """All statements and items up to the end of the text."""
        while word := self.words[self.at]:
            if word in SCENE_WORDS or begins_annotation(self.source, self.at):
                self.statement(word)
            else:
                self.item()
        numbers = {light.name: k for k, light in reversed(list(enumerate(self.lights)))} if self.lit else {}
        for place, draft in self.lit:
            self.items[place] = self.lit_item(self.items[place], draft, numbers)
        self.check_range()
        self.check_cuts()
        shown = [item for place, item in enumerate(self.items) if place not in self.parts] if self.parts else self.items
        found = replace(self.settings, items=tuple(shown), lights=tuple(self.lights), sheet=self.sheet(shown))
        return self.labelled(found) if self.labels else found

    def sheet(self, shown: Sequence[Item]) -> SheetSettings | None:
        """What is said of the technical sheet, and what files of CAD systems say that parts are made of."""
        names = {item.group or item.name for item in shown}
        made_of = {name: said for name, said in self.made_of.items() if name in names}
        if not made_of:
            return self.settings.sheet
        own = self.settings.sheet or SheetSettings()
        return replace(own, made_of=tuple({**made_of, **dict(own.made_of or ())}.items()))

    def labelled(self, scene: Scene) -> Scene:
        """The scene with its labels, which may come before the items that they name."""
        for index, label in self.labels:
            try:
                label_anchors(replace(scene, labels=(label,)))
            except InputError as error:
                self.source.fail(index, error.cause)
        return replace(scene, labels=tuple(label for _, label in self.labels))

    def check_pens(self, scene: Scene) -> None:
        """An InputError for pens and dashes of items that are not there; items may come behind them."""
        names = {item.name for item in scene.items}
        said = [index for index, target in self.pens if self.words[index - 1] != "style"]
        if said and scene.inks is not None and scene.inks.style in WIRE_STYLES:
            cause = f"'{self.words[said[0] - 1]}' does not go with the style {scene.inks.style}"
            self.source.fail(said[0] - 1, f"{cause}, which shows all lines, in colours of its own")
        for index, target in self.pens:
            item = target_of(target)[1]
            if item is None or item in names:
                continue
            # Cuts and explosions make items of their own.
            if not any(item.startswith(f"{name} ") for name in names):
                self.source.fail(index, unknown_item(item, tuple(names)).cause)

    def check_cuts(self) -> None:
        """An InputError for cuts and moves of items that are not there; items may come behind them."""
        known = [item.name for item in self.items]
        for index, cut in zip(self.cuts, self.settings.cuts, strict=True):
            for name in cut.items or ():
                if name not in known:
                    self.source.fail(index, unknown("cut: item", name, known).cause)
        known += [item.group for item in self.items if item.group]
        for index in self.moves:
            name = self.source.string(index + 1)
            if name not in known:
                self.source.fail(index, unknown("explode: item", name, known).cause)

    def check_range(self) -> None:
        """An InputError for polyhedra, as they stand in the scene, whose coordinates leave the range of numbers."""
        bounds = [item.mesh.bounds for item in self.items if len(item.mesh.vertices)]
        if not bounds:
            return
        low, high = np.array(bounds).transpose(1, 0, 2)
        try:
            check_range(np.stack([low.min(axis=0), high.max(axis=0)]))
        except InputError as error:
            raise InputError(error.cause, file=self.source.name) from None

    def statement(self, word: str) -> None:
        """camera, light, page, background, title, label or cut, and what follows it."""
        if word in _MANIFOLD:
            _MANIFOLD[word](self)
            return
        if word in ANNOTATION_WORDS:
            annotation, self.at = read_annotation(self.source, self.at)
            self.annotations.append(annotation)
            return
        if word == "field_arrows":
            from vectorplot.io.integral_line_words import read_arrows

            self.arrows.append(self.at)
            _, _, _, self.at = read_arrows(self.source, self.at)
            return
        if word in self.set and word not in ("light", "label", "cut", "explode", *INK_WORDS):
            self.fail(f"a second '{word}'")
        self.set.add(word)
        source, now = self.source, self.settings
        if word == "camera":
            camera, self.at = read_camera(source, self.at)
            self.settings = replace(now, camera=camera)
        elif word == "light":
            light, self.at = read_light(source, self.at)
            self.lights.append(light)
        elif word == "label":
            start = self.at
            label, self.at = read_label(source, self.at)
            self.labels.append((start, label))
        elif word == "cut":
            self.cuts.append(self.at)
            cut, self.at = read_cut(source, self.at)
            self.settings = replace(now, cuts=(*now.cuts, cut))
        elif word in INK_WORDS:
            self.pens.append((self.at + 1, pen_target(source, self.at)))
            inks, self.at = read_ink(source, self.at, now.inks, self.files)
            self.settings = replace(now, inks=inks)
        elif word == "measures":
            measures, self.at = read_measures(source, self.at)
            self.settings = replace(now, measures=measures)
        elif word == "sheet":
            sheet, self.at = read_sheet(source, self.at, self.files)
            self.settings = replace(now, sheet=sheet)
        elif word == "explode":
            self.moves += [self.at] if self.words[self.at + 1].startswith('"') else []
            explosion, self.at = read_explosion(source, self.at, now.explosion)
            self.settings = replace(now, explosion=explosion)
        elif word == "page":
            page, self.at = read_page(source, self.at)
            self.settings = replace(now, page=page)
        elif word == "colour_by":
            colouring, self.at = read_colouring(source, self.at)
            self.settings = replace(now, colouring=colouring)
        elif word == "exposure":
            exposure, self.at = read_exposure(source, self.at)
            self.settings = replace(now, exposure=exposure)
        elif word == "depth_cue":
            cue, self.at = read_depth_cue(source, self.at)
            self.settings = replace(now, depth_cue=cue)
        elif word == "box_axes":
            box, self.at = read_box_axes(source, self.at)
            self.settings = replace(now, box=box)
        elif word == "scale_bar":
            bar, self.at = read_scale_bar(source, self.at)
            self.settings = replace(now, scale_bar=bar)
        else:
            self.at += 1
            if word == "title":
                if not self.words[self.at].startswith('"'):
                    self.fail(f"expected a string in quotes after 'title', got {source.shown(self.at)}")
                self.settings = replace(now, title=source.string(self.at))
                self.at += 1
            else:
                self.settings = replace(now, background=self.colour("background"))

    def item(self) -> None:
        """An item, made of its draft."""
        draft = self.draft()
        parts: tuple[Mesh, ...] = ()
        if draft.parts is not None:
            places = [self.places[part] for part in draft.parts]
            for place in places:
                if not isinstance(self.items[place].shape, Mesh):
                    name, what = self.items[place].name, "curve" if is_curve(self.items[place].shape) else "surface"
                    self.source.fail(draft.kind_index, f"{draft.owner}{name} is a {what}: only solids are intersected")
            parts = tuple(self.items[place].mesh for place in places)
            self.parts.update(places)
        if draft.terrain is not None:
            self.exaggerated(draft.terrain[1])
        if draft.curves.lit_index:
            self.lit.append((len(self.items), draft))
        self.places[draft.name] = len(self.items)
        for number in range(len(draft.places)):
            if number and draft.curves.lit_index:
                self.lit.append((len(self.items), draft))
            self.items.append(finished(draft.at(number), self.source, parts))
            if len(self.items) > MAX_ITEMS:
                self.source.fail(draft.index, f"{draft.owner}more than {MAX_ITEMS} items")

    def exaggerated(self, times: float) -> None:
        """What heights of the scene are multiplied with: those of its first terrain that is drawn higher or lower."""
        if self.settings.exaggeration == 1.0:
            self.settings = replace(self.settings, exaggeration=times)

    def include(self) -> None:
        """The items and lights of another scene, or the parts of a CAD system, and where they stand."""
        start = self.at
        if self.files is None:
            self.fail("include: a text without a file names no files")
        path = self.files.named(self.source, self.at + 1, "include: ")
        if path.suffix.lower() in CAD_SUFFIXES:
            scene = _parts(path, self.files)
            self.made_of.update(() if scene.sheet is None else scene.sheet.made_of or ())
        else:
            files = self.files.within(self.source, start + 1, path)
            scene = _Reader(Words(_text(path, shown(path)), shown(path)), files).scene()
        draft = Draft(path.name, start)
        self.at += 2
        self.modifiers(draft)
        self.lights += scene.lights
        self.exaggerated(scene.exaggeration)
        self.repeated(scene.items, draft)

    def assembly(self) -> None:
        """The items up to the word end, and where they stand together."""
        start = self.at
        self.at += 1
        draft = Draft("assembly", start)
        first, lit = len(self.items), len(self.lit)
        self.members("assembly", start)
        self.modifiers(draft)
        if len(self.lit) > lit and draft.places != [IDENTITY]:
            self.source.fail(start, "assembly: items with 'lit_by' cannot be moved together")
        if draft.places != [IDENTITY]:
            self.repeated(self.taken(first), draft)

    def union(self) -> None:
        """A name, the items up to the word end, which are one body, and where it stands."""
        start = self.at
        self.at += 1
        if self.words[self.at] in ("", ",", *SCENE_WORDS) or self.source.is_number(self.at):
            self.fail(f"union: expected the name of the body, got {self.source.shown(self.at)}")
        draft = Draft(self.source.string(self.at), start)
        self.at += 1
        first, lit = len(self.items), len(self.lit)
        self.members("union", start)
        self.modifiers(draft)
        if len(self.lit) > lit:
            self.source.fail(start, f"{draft.owner}items with 'lit_by' cannot be united")
        items = self.taken(first)
        if not items:
            self.source.fail(start, f"{draft.owner}a union of no items")
        from vectorplot.scene.united import union_item

        try:
            body = union_item(items, draft.name)
        except InputError as error:
            self.source.fail(start, draft.owner + error.cause)
        self.repeated([replace(body, place=(self.source.name, self.source.line(start)))], draft)

    def members(self, group: str, start: int) -> None:
        """The items of an assembly or a union, and the word end."""
        while (word := self.words[self.at]) != "end":
            if not word:
                self.source.fail(start, f"{group}: expected 'end' behind its items, got the end of the file")
            alone = word in SCENE_WORDS and word not in ("include", "assembly", "union")
            if alone or begins_annotation(self.source, self.at):
                self.fail(f"{group}: expected an item or 'end', got {self.source.shown(self.at)}")
            if word in ("assembly", "union") and self.depth >= DEEPEST:
                self.fail(f"{word}: more than {DEEPEST} in one another")
            if word in _MANIFOLD:
                self.depth += 1
                _MANIFOLD[word](self)
                self.depth -= 1
            else:
                self.item()
        self.at += 1

    def taken(self, first: int) -> list[Item]:
        """The items from a place on, but for parts of intersections, out of the list of all items."""
        gone = {place for place in self.parts if place >= first}
        items = [item for place, item in enumerate(self.items) if place >= first and place not in gone]
        self.parts -= gone
        del self.items[first:]
        for name in [name for name, place in self.places.items() if place >= first]:
            del self.places[name]
        return items

    def alone(self) -> None:
        """The word end without a beginning."""
        self.fail("'end' without 'assembly' or 'union'")

    def repeated(self, items: Sequence[Item], draft: Draft) -> None:
        """Items as often and where a draft says."""
        if len(self.items) + len(items) * len(draft.places) > MAX_ITEMS:
            self.source.fail(draft.index, f"{draft.owner}more than {MAX_ITEMS} items")
        for number, place in enumerate(draft.places, 1):
            for item in items:
                named = item if number == 1 else replace(item, name=f"{item.name} {number}")
                matrix = np.array([*place, 0.0, 0.0, 0.0, 1.0]).reshape(4, 4)
                self.places.setdefault(named.name, len(self.items))
                self.items.append(named if place == IDENTITY else named.transformed(matrix))

    def lit_item(self, item: Item, draft: Draft, numbers: Mapping[str, int]) -> Item:
        """An item with isophotes of the light that its draft names, or counts from 1; lights may come after items.

        numbers: of the lights from 0, by their names."""
        at = draft.curves.lit_index
        name, count = self.source.string(at), len(self.lights)
        if self.words[at].isdecimal() and len(name) <= len(str(count)) and 1 <= int(name) <= count:
            index = int(name) - 1
        elif name in numbers:
            index = numbers[name]
        else:
            known = ", ".join(filter(None, islice(numbers, 10))) or f"{count} without names"
            self.source.fail(at, f"{draft.owner}there is no light {self.source.shown(at)} (lights: {known})")
        return replace(item, curves=replace(item.curves, light=index))


_MANIFOLD: dict[str, Callable[[_Reader], None]] = {
    "include": _Reader.include,
    "assembly": _Reader.assembly,
    "union": _Reader.union,
    "end": _Reader.alone,
}
"""Statements about several items at once."""
