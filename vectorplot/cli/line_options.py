"""Options for all that is shown: plane sections, level lines, isophotes, colours, materials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import click

from vectorplot.cli.options import AXES, at_least, direction, number
from vectorplot.errors import InputError

if TYPE_CHECKING:
    from vectorplot.geometry.cameras.camera import Point
    from vectorplot.scene.material import Material
    from vectorplot.scene.scene import Scene
    from vectorplot.scene.surface_lines import Section, SurfaceLines


@dataclass(frozen=True)
class Planes:
    """Parallel planes: so many of them, or (count: 0) at these distances from the origin."""

    normal: Point
    count: int
    offsets: tuple[float, ...] = ()

    @classmethod
    def read(cls, text: str) -> Planes:
        """AXIS,N or AXIS=D,...; an axis is x, y, z, or a normal X,Y,Z."""
        if "=" in text:
            axis, _, distances = text.partition("=")
            found = cls(_axis(axis), 0, tuple(number(part.strip()) for part in distances.split(",")))
        else:
            axis, comma, last = text.rpartition(",")
            if not comma:
                raise click.BadParameter(f"{text!r} is not AXIS,N or AXIS=D,...")
            found = cls(_axis(axis), count(last))
        _check(found)
        return found

    @classmethod
    def read_levels(cls, text: str) -> Planes:
        """The same, or N alone, of heights along z."""
        return cls.read(text) if set(text) & set(",=") else cls(AXES["z"], count(text))


def _axis(text: str) -> Point:
    """The direction that a text spells, for words that say what planes are."""
    if "," not in text and text.strip().lower().lstrip("+-") not in AXES:
        raise click.BadParameter(f"{text!r} is no axis, expected x, y, z or a normal X,Y,Z")
    return direction(text)


def _check(planes: Planes) -> None:
    """Bad usage for planes that make no sense."""
    from vectorplot.scene.surface_lines import Section

    try:
        Section(planes.normal, planes.offsets)
    except InputError as error:
        raise click.BadParameter(str(error)) from None


def count(text: str) -> int:
    """How many lines: a whole number from 1 to the largest one of scene files."""
    from vectorplot.scene.surface_lines import MAX_LINES

    try:
        value = int(text)
    except ValueError:
        raise click.BadParameter(f"{text!r} is not a whole number") from None
    if not 1 <= value <= MAX_LINES:
        raise click.BadParameter(f"{value} of them, expected 1 to {MAX_LINES}")
    return value


@dataclass(frozen=True)
class ItemMaterial:
    """The material of an item, or (item: None) of all."""

    item: str | None
    material: Material

    @classmethod
    def read(cls, text: str) -> ItemMaterial:
        """[ITEM=]WORD[,WHAT=N...]."""
        from vectorplot.scene.material import FINISH_WORDS, Material

        first, *rest = (part.strip() for part in text.split(","))
        item, named, word = first.rpartition("=")
        numbers: dict[str, float] = {}
        for part in rest:
            name, _, value = part.partition("=")
            if name not in (words := (*FINISH_WORDS, "opacity", "refraction")):
                raise click.BadParameter(f"{part!r} is none of {', '.join(words)} with = and a number")
            if name in numbers:
                raise click.BadParameter(f"{text!r} says twice what its {name} is")
            numbers[name] = number(value)
        try:
            return cls(item if named else None, Material(word, **numbers))
        except InputError as error:
            raise click.BadParameter(error.cause) from None


LINE_OPTIONS = (
    click.option(
        "--sections",
        type=Planes.read,
        multiple=True,
        metavar="AXIS,N",
        help="N plane sections of the whole at right angles to x, y, z or X,Y,Z; or at AXIS=D,...; repeat it for more.",
        show_default=False,
    ),
    click.option(
        "--levels",
        type=Planes.read_levels,
        metavar="[AXIS,]N",
        help="About N level lines at round heights, every fifth of the kind index; or at AXIS=D,...",
    ),
    click.option(
        "--label-levels", is_flag=True, help="Heights stand on their index lines, or where there are none, on all."
    ),
    click.option("--isophotes", type=count, metavar="N", help="N lines of the same light on all that is shown."),
    click.option(
        "--detail",
        type=at_least(0.01),
        default=1.0,
        metavar="FACTOR",
        help="How much there is of suggestive, ridge, valley and apparent lines.",
    ),
    click.option(
        "--smooth-contours",
        is_flag=True,
        help="Contours of meshes run across faces, as those of the smooth shapes they stand for.",
    ),
    click.option(
        "--colour-by",
        metavar="WORD|FORMULA",
        help="Colours by x, y, z, height, slope, curvature, a formula such as x*y or a field of a file, and their bar.",
    ),
    click.option(
        "--colour-map",
        metavar="NAME",
        help="viridis, heat, diverging, land, gray, or one of matplotlib.",
    ),
    click.option("--colour-steps", type=click.IntRange(2, 100), metavar="N", help="How many colours (24)."),
    click.option(
        "--material",
        "materials",
        type=ItemMaterial.read,
        multiple=True,
        metavar="[ITEM=]WORD[,WHAT=N...]",
        help="metallic, wood, ..., of all or one item; after it exponent=N, diffuse=N, highlight=N, sharpness=N, "
        "opacity=N or refraction=N; repeat it for more.",
    ),
    click.option("--box", is_flag=True, help="A box with ticks around all that is shown."),
)


@dataclass(frozen=True)
class LineOptions:
    """The lines that the user asked for on all that is shown, beside what a scene file asks for."""

    sections: tuple[Planes, ...] = ()
    levels: Planes | None = None
    label_levels: bool = False
    isophotes: int | None = None
    detail: float = 1.0
    smooth_contours: bool = False
    colour_by: str | None = None
    colour_map: str | None = None
    colour_steps: int | None = None
    box: bool = False
    materials: tuple[ItemMaterial, ...] = ()

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> LineOptions:
        """What a command with LINE_OPTIONS was told."""
        return cls(**{field.name: options[field.name] for field in fields(cls)})

    def in_scene(self, scene: Scene) -> tuple[Scene, tuple[str, ...]]:
        """A scene with these lines, colours and box, and the kinds of the lines."""
        from vectorplot.scene.lines.added_lines import line_kinds, with_lines, without_level_lines

        charted, added = self.with_chart(scene), self.of_scene(scene)
        if self.levels is not None:
            charted = without_level_lines(charted, self.levels.normal)
        lined = with_lines(
            charted,
            sections=added.sections,
            isophotes=added.isophotes,
            detail=added.detail,
            smooth_contours=added.smooth_contours,
        )
        return self.with_numbers(lined), line_kinds(added)

    def with_materials(self, scene: Scene) -> Scene:
        """A scene with the materials that the user asked for; the last one counts. Bad usage for names of no item."""
        names = {item.name for item in scene.items}
        for told in self.materials:
            if told.item is not None and told.item not in names:
                raise click.UsageError(f"--material: no item is named {told.item!r}")
        items = scene.items
        for told in self.materials:
            items = tuple(
                replace(item, material=told.material) if told.item in (None, item.name) else item for item in items
            )
        return replace(scene, items=items) if self.materials else scene

    def with_chart(self, scene: Scene) -> Scene:
        """A scene with the colours and the box that the user asked for. Bad usage for a map of no colours."""
        from vectorplot.scene.naming.scales import BoxAxes, Colouring

        if self.colour_by is None and self.colour_map is None and self.colour_steps is None and not self.box:
            return scene
        own = scene.colouring
        if self.colour_by is not None:
            own = Colouring(self.colour_by)
        if own is None and (self.colour_map is not None or self.colour_steps is not None):
            raise click.UsageError("--colour-map and --colour-steps go with --colour-by")
        if own is not None:
            named = own if self.colour_map is None else replace(own, colour_map=self.colour_map)
            own = named if self.colour_steps is None else replace(named, steps=self.colour_steps)
        return replace(scene, colouring=own, box=BoxAxes() if self.box else scene.box)

    def with_numbers(self, scene: Scene) -> Scene:
        """A scene with numbers on its level lines where the user asked for them. Bad usage where there are none."""
        from vectorplot.scene.lines.added_lines import with_numbers

        if not self.label_levels:
            return scene
        if not any(not section.slices for item in scene.items for section in item.curves.sections):
            raise click.UsageError("--label-levels: there are no level lines, expected --levels too")
        return with_numbers(scene)

    def of_scene(self, scene: Scene) -> SurfaceLines:
        """The lines that these are in a scene. Errors: InputError as of even_sections and round_sections."""
        from vectorplot.scene.surface_lines import SurfaceLines, even_cosines

        cosines = even_cosines(self.isophotes) if self.isophotes else ()
        planes = tuple(_sections(one, scene) for one in self.sections) + _levels(self.levels, scene)
        return SurfaceLines(
            sections=planes, isophotes=cosines, detail=self.detail, smooth_contours=self.smooth_contours
        )


def _sections(planes: Planes, scene: Scene) -> Section:
    from vectorplot.scene.lines.added_lines import even_sections
    from vectorplot.scene.surface_lines import Section

    return even_sections(scene, planes.normal, planes.count) if planes.count else Section(planes.normal, planes.offsets)


def _levels(planes: Planes | None, scene: Scene) -> tuple[Section, ...]:
    from vectorplot.scene.lines.added_lines import heights_times, round_sections
    from vectorplot.scene.surface_lines import Section
    from vectorplot.scene.terrains.level_lines import USUAL_EVERY, with_index_lines

    if planes is None:
        return ()
    if planes.count:
        return round_sections(scene, planes.normal, planes.count)
    given = Section(planes.normal, planes.offsets)
    times = heights_times(scene, given)
    return with_index_lines(replace(given, offsets=tuple(times * height for height in given.offsets)), USUAL_EVERY)
